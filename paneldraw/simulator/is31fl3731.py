"""The IS31FL3731: eight frames of 144 LEDs of 256 brightnesses; messages are a register and what goes into it."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from .chip import Chip
from .frames import Picture

_FRAMES, _LEDS = 8, 144
_BLINK_AT, _BRIGHTNESS_AT, _FRAME_END = 0x12, 0x24, 0xB4
_FUNCTION_PAGE, _PAGE_SELECT = 0x0B, 0xFD
_MODE, _PICTURE, _OPTIONS, _SHUTDOWN, _FUNCTIONS = 0x00, 0x01, 0x05, 0x0A, 0x0D
_FUNCTION_NAMES = {
    _MODE: "mode",
    _PICTURE: "picture",
    0x02: "auto play",
    0x03: "auto play delay",
    _OPTIONS: "display options",
    0x06: "audio",
    0x08: "breath",
    0x09: "breath",
    _SHUTDOWN: "out of shutdown",
    0x0B: "gain",
    0x0C: "sampling rate",
}
_LED_OF = np.arange(_LEDS).reshape(9, 16)


def _halves(left: NDArray[np.intp], right: NDArray[np.intp]) -> NDArray[np.intp]:
    """Turn the columns of numbers of a board's halves, whose every column is 16 LEDs of the chip's row, into rows."""
    return np.vstack([left, right]).T


def _boards() -> dict[tuple[int, int], NDArray[np.intp]]:
    """The number of the LED at each pixel, by size: how Adafruit's and Pimoroni's boards are wired."""
    return {
        (16, 9): _LED_OF,
        # Columns are rows of the chip: the left half counts up in its LEDs 7 to 1, the right one back in 8 to 14.
        (15, 7): _halves(_LED_OF[:8, 7:0:-1], _LED_OF[7:0:-1, 8:15]),
        (16, 8): _halves(_LED_OF[1:9, 7::-1], _LED_OF[1:9, 15:7:-1]),
        (17, 7): _halves(_LED_OF[8::-1, 6::-1], _LED_OF[1:9, 8:15] - 16),
        (11, 7): _halves(_LED_OF[:6, 6::-1], _LED_OF[1:6, 14:7:-1] - 16),
    }


class IS31FL3731(Chip):
    """An IS31FL3731 with its LEDs.

    Parameters
    ----------
    width, height : int
        16x9 (default), 15x7 (CharliePlex FeatherWing), 16x8 (bonnet), 17x7 (Scroll pHAT HD) or 11x7.
    mirror_x, mirror_y : bool
        Look at the matrix in a mirror. Default: False.
    history, seed
        As of any chip; the RAM is no noise, reset clears it.

    Attributes
    ----------
    max_level : int
        255.
    registers : Registers
        ``page``, and ``functions``, the registers of page 0B.

    Notes
    -----
    Blinking, breathing and sound are state only; where frames play, the first is seen.

    Examples
    --------
    >>> chip = IS31FL3731()
    >>> for message in ("FD 0B", "0A 01", "FD 00", "00 FF", "24 01 80"):
    ...     chip.write(bytes.fromhex(message))
    >>> chip.pixels[0, :3]
    array([  1, 128,   0], dtype=uint8)
    """

    buses = ("i2c",)
    look = "red-led"
    max_level = 255
    sizes: ClassVar[tuple[tuple[int, int], ...]] = tuple(_boards())

    def __init__(
        self,
        width: int = 16,
        height: int = 9,
        *,
        mirror_x: bool = False,
        mirror_y: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        if (width, height) not in self.sizes:
            sizes = ", ".join(f"{w}x{h}" for w, h in self.sizes)
            raise ValueError(f"width and height: {width}x{height} is none of {sizes}")
        self._leds = _boards()[width, height][:: -1 if mirror_y else 1, :: -1 if mirror_x else 1]
        super().__init__(width, height, history=history, seed=seed, cells=(_FRAMES, _FRAME_END))

    @property
    def brightness(self) -> NDArray[np.uint8]:
        """The 144 brightnesses of each of eight frames."""
        return self._memory[:, _BRIGHTNESS_AT:].copy()

    def reset(self) -> None:
        """Pull the SDB pin, and lose what is in the registers, as without power."""
        super().reset()
        self.registers.page = 0
        self.registers.functions = bytearray(_FUNCTIONS)
        self._memory: NDArray[np.uint8] = np.zeros((_FRAMES, _FRAME_END), np.uint8)
        self._register = 0

    def _lose_ram(self) -> None:
        """Reset clears all."""

    # the wire

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one message: a register, and bytes for it and those behind."""
        if not payload:
            return
        self._picture = None
        self._register = payload[0]
        if self.registers.page < _FRAMES and self._register < _FRAME_END and len(payload) > 1:
            written = slice(self._register, min(self._register + len(payload) - 1, _FRAME_END))
            self._progress.draw_at((self.registers.page, written))
        if self.listener:
            self._tell(payload, self._meaning(payload))
        for byte in payload[1:]:
            self._set(self._register, byte)
            self._register = self._register + 1 & 0xFF

    def _meaning(self, payload: bytes | bytearray | memoryview) -> str:
        """What a message is, in words."""
        register, page, count = payload[0], self.registers.page, len(payload) - 1
        if register == _PAGE_SELECT and count:
            return f"page {payload[1]:02X}"
        if page == _FUNCTION_PAGE and register < _FUNCTIONS:
            name = _FUNCTION_NAMES.get(register, f"register {register:02X}")
            return f"{name} {payload[1]:02X}" if count else name
        if page < _FRAMES and register >= _BRIGHTNESS_AT:
            return f"{count} bytes of brightness on page {page}, from LED {register - _BRIGHTNESS_AT}"
        kind = "LEDs on and off" if register < _BLINK_AT else "blinking"
        return f"{count} bytes of {kind} on page {page:02X}, from register {register:02X}"

    def _set(self, register: int, value: int) -> None:
        page = self.registers.page
        if register == _PAGE_SELECT:
            if value not in (*range(_FRAMES), _FUNCTION_PAGE):
                self.complain("pages are 00 to 07 and 0B", (register, value))
            self.registers.page = value
        elif page == _FUNCTION_PAGE and register < _FUNCTIONS:
            self.registers.functions[register] = value
        elif page < _FRAMES and register < _FRAME_END:
            self._memory[page, register] = value
        else:
            self.complain(f"there is no such register on page {page:02X}; ignored", (register, value))

    def transfer(self, run: bytes | bytearray | memoryview, data: bool) -> None:
        """Take nothing: there is no SPI."""
        raise TypeError("an IS31FL3731 sits on I2C")

    def read(self, length: int) -> bytes:
        """Answer with what is in the register that was written last, and those behind."""
        page = self.registers.page
        if self._register == _PAGE_SELECT:
            held = bytes([page])
        else:
            memory = self.registers.functions if page == _FUNCTION_PAGE else self._memory[page % _FRAMES]
            held = bytes(memory[self._register : self._register + length])
        return self._answer(held.ljust(length, b"\0")[:length], f"register {self._register:02X}")

    # what can be seen

    @property
    def contrast(self) -> int:
        """The chip has brightness a pixel and none for all."""
        return 255

    @property
    def status(self) -> int:
        """There is none."""
        return 0

    @property
    def lit(self) -> bool:
        """Whether the chip is out of its shutdown."""
        return bool(self.registers.functions[_SHUTDOWN] & 1)

    def __repr__(self) -> str:
        power = "on" if self.lit else "off"
        return f"<IS31FL3731 {self.width}x{self.height}, {power}, {len(self.frames)} frames>"

    def _look(self) -> Picture:
        if not self.lit:
            return np.zeros((self.height, self.width), np.uint8)
        functions = self.registers.functions
        number = functions[_PICTURE] & 7 if not functions[_MODE] & 0x18 else functions[_MODE] & 7
        frame = self._memory[number]
        enabled = np.unpackbits(frame[:_BLINK_AT], bitorder="little")
        brightness = self._memory[0 if functions[_OPTIONS] & 0x20 else number, _BRIGHTNESS_AT:]
        return (brightness * enabled)[self._leds]
