"""The HT16K33: a RAM of 16 x 8 bits that lights LEDs; messages are a command, or an address and data."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from .chip import Chip
from .frames import Picture

_SIZE = 16
#: Which RAM bit lights each pixel: the byte, and the bit, in whole rows of bytes.
_X, _Y = np.meshgrid(np.arange(16), np.arange(8))
_BOARDS = {
    "backpack": (2 * _Y + (_X >> 3), _X & 7),
    "featherwing": ((_X & 7) * 2 + (_X >> 3), _Y),
}
#: The small 8x8 backpack: its columns are on row lines 7, 0, 1 ... 6.
_SMALL = (2 * _Y[:, :8], np.roll(_X[:, :8], 1, axis=1))


class HT16K33(Chip):
    """An HT16K33 with a matrix of LEDs.

    Parameters
    ----------
    width, height : int
        16x8 (default) or 8x8.
    board : str, optional
        How a 16x8 matrix is wired: ``"backpack"`` (default) or ``"featherwing"``, as Adafruit's boards of these names.
    mirror_x, mirror_y : bool
        Look at the matrix in a mirror. Default: False.
    history, seed
        As of any chip.

    Attributes
    ----------
    registers : Registers
        ``oscillator``, ``on``, ``blink`` (0 none, 1 to 3: 2, 1 and 0.5 Hz), ``dimming``, ``interrupt`` and ``pointer``.

    Notes
    -----
    Blinking is state only. RAM is noise after power-up, and data is taken though the oscillator is off: no sheet at
    hand says otherwise, and Adafruit's driver clears the RAM so. No keys are pressed.

    Examples
    --------
    >>> chip = HT16K33(16, 8)
    >>> for message in (b"\\x21", b"\\x81", bytes(17), b"\\x02\\x05"):
    ...     chip.write(message)
    >>> chip.pixels[1, :4]
    array([1, 0, 1, 0], dtype=uint8)
    """

    buses = ("i2c",)
    look = "red-led"
    reset_values: Mapping[str, Any] = MappingProxyType(
        {"oscillator": False, "on": False, "blink": 0, "dimming": 15, "interrupt": 0, "pointer": 0}
    )

    def __init__(
        self,
        width: int = 16,
        height: int = 8,
        *,
        board: str = "backpack",
        mirror_x: bool = False,
        mirror_y: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        if (width, height) not in ((16, 8), (8, 8)):
            raise ValueError(f"width and height: {width}x{height} is not 16x8 or 8x8")
        if board not in _BOARDS or (width == 8 and board != "backpack"):
            raise ValueError(f"board: {board!r} is none of {width}x{height}")
        where, bits = _BOARDS[board] if width == 16 else _SMALL
        self._leds = (8 * where + bits)[:: -1 if mirror_y else 1, :: -1 if mirror_x else 1]
        self._ram = bytearray(_SIZE)
        super().__init__(width, height, history=history, seed=seed, cells=(_SIZE,))

    @property
    def ram(self) -> bytes:
        """What the display RAM holds."""
        return bytes(self._ram)

    def _lose_ram(self) -> None:
        self._ram[:] = self._random.randbytes(_SIZE)

    # the wire

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one message: a command, or an address with data for it and those behind."""
        if not payload:
            return
        self._picture = None
        first, data, r = payload[0], bytes(payload[1:]), self.registers
        kind, low = first & 0xF0, first & 0x0F
        if kind == 0x00:
            r.pointer = low
            if data:
                self._progress.draw_at(np.arange(low, low + len(data)) % _SIZE)
            for byte in data:
                self._ram[r.pointer] = byte
                r.pointer = (r.pointer + 1) % _SIZE
            self._tell(payload, f"{len(data)} bytes of data from address {low}" if data else f"address pointer {low}")
            return
        if kind == 0x20:
            r.oscillator = bool(low & 1)
            self._tell(payload[:1], f"oscillator {'on' if r.oscillator else 'off'}")
        elif kind == 0x80 and not low & 8:
            r.on, r.blink = bool(low & 1), low >> 1 & 3
            self._tell(payload[:1], f"display {'on' if r.on else 'off'}, blinking {r.blink}")
        elif kind == 0xA0 and not low & 0x0C:
            r.interrupt = low
            self._tell(payload[:1], f"interrupt pin {low}")
        elif kind == 0xE0:
            r.dimming = low
            self._tell(payload[:1], f"dimming {low}")
        elif first in (0x40, 0x60):
            self._tell(payload[:1], "keys or interrupts are read next")
        else:
            self._tell(payload[:1], "unknown")
            self.complain("not a command of the HT16K33; ignored", payload[:1])
        if data:
            self.complain("a command has no data; ignored", payload)

    def transfer(self, run: bytes | bytearray | memoryview, data: bool) -> None:
        """Take nothing: there is no SPI."""
        raise TypeError("an HT16K33 sits on I2C")

    def read(self, length: int) -> bytes:
        """Answer with the RAM, from the address that was written last."""
        start = self.registers.pointer
        return self._answer(bytes(self._ram[(start + number) % _SIZE] for number in range(length)), "RAM")

    # what can be seen

    @property
    def contrast(self) -> int:
        """Brightness, 0 to 15."""
        return int(self.registers.dimming)

    def _look(self) -> Picture:
        r = self.registers
        if not (r.oscillator and r.on):
            return np.zeros((self.height, self.width), np.uint8)
        lit = np.unpackbits(np.frombuffer(self._ram, np.uint8), bitorder="little")
        if r.interrupt & 1:  # the pin of row 15 tells of keys instead
            lit[15::16] = 0
        seen: Picture = lit[self._leds]
        return seen
