"""MAX7219s in a row: a shift register through all of them, and each one's eight digits of eight segments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from .chip import Chip, written
from .frames import Picture

_DIGITS = 8
#: Control registers: their names, and their bits.
_CONTROL = {
    0x09: ("decode", 0xFF),
    0x0A: ("intensity", 0x0F),
    0x0B: ("scan_limit", 0x07),
    0x0C: ("on", 0x01),
    0x0F: ("test", 0x01),
}
#: Segments A to G, A being bit 6, that code B lights for 0 to 9, a dash, E, H, L, P and a blank.
_CODE_B = np.frombuffer(bytes.fromhex("7E 30 6D 79 33 5B 5F 70 7F 7B 01 4F 37 0E 67 00"), np.uint8)
_POINT = 0x80


class MAX7219(Chip):
    """A wall of 8x8 matrices, each with a MAX7219 of its own, whose data goes from one to the next.

    Upright, a matrix has digit 0 as its top row and the segment of the highest bit on the left.

    Parameters
    ----------
    width, height : int
        Visible size in pixels, multiples of 8. Default: 32x8.
    order : str or sequence of (int, int)
        How the modules are wired: ``"rows"`` (default), ``"columns"``, ``"serpentine"`` (rows, every second one
        backwards and its modules upside down), or the column and row of each, the one at the data line first, which
        ``"0.0,1.0"`` says too.
    first_block : str, optional
        Corner of the module at the data line: ``"top-right"`` (default), ``"top-left"``, ``"bottom-right"`` or
        ``"bottom-left"``.
    block_rotation : int, str or sequence of int
        Degrees by which modules are turned clockwise, all alike or each, the one at the data line first. Default: 0.
    mirror_blocks : bool
        Matrices whose columns run the other way. Default: False.
    mirror_x, mirror_y : bool
        Look at the wall in a mirror. Default: False.
    history, seed
        As of any chip.

    Attributes
    ----------
    digits : (chips, 8) uint8 array
        What the digit registers hold; the chip at the data line is the first.
    registers : Registers
        ``decode``, ``intensity``, ``scan_limit``, ``on`` and ``test``, each an array with an entry a chip.

    Notes
    -----
    What counts is what stands in the shift register as the chip select rises: with too few bytes a chip finds some of
    the select before. Digits keep noise through power-up, as those of many modules do; the sheet says "blanked", which
    may as well mean the shutdown.

    Examples
    --------
    >>> chip = MAX7219(8, 8)
    >>> for register, value in [(0x0B, 7), (0x0F, 0), (0x0C, 1), *((row, row) for row in range(1, 9))]:
    ...     _ = chip.transfer(bytes((register, value)), False)
    ...     chip.deselect()
    >>> chip.pixels[4]
    array([0, 0, 0, 0, 0, 1, 0, 1], dtype=uint8)
    """

    buses = ("spi",)
    has_dc, look = False, "red-led"
    sizes: ClassVar[tuple[tuple[int, int], ...]] = ((32, 8), (8, 8), (64, 8), (64, 16), (32, 32))

    def __init__(
        self,
        width: int = 32,
        height: int = 8,
        *,
        order: str | Sequence[tuple[int, int]] = "rows",
        first_block: str = "top-right",
        block_rotation: int | str | Sequence[int] = 0,
        mirror_blocks: bool = False,
        mirror_x: bool = False,
        mirror_y: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        if width < 8 or height < 8 or width % 8 or height % 8:
            raise ValueError(f"width and height: {width}x{height} is not made of matrices of 8x8")
        blocks = _blocks(width // 8, height // 8, order, first_block)
        self.count = len(blocks)
        turned = [row % 2 != blocks[0][1] % 2 if order == "serpentine" else False for _, row in blocks]
        turns = [turn + 180 * back for turn, back in zip(_rotations(block_rotation, self.count), turned, strict=True)]
        numbers = np.arange(self.count * 64).reshape(self.count, 8, 8)
        leds = np.full((height, width), -1)
        for matrix, (column, row), turn in zip(numbers, blocks, turns, strict=True):
            seen = np.rot90(matrix[:, ::-1] if mirror_blocks else matrix, -turn // 90)
            leds[8 * row : 8 * row + 8, 8 * column : 8 * column + 8] = seen
        if (leds < 0).any():
            raise ValueError(f"order: {order!r} leaves modules of {width // 8}x{height // 8} out")
        self._leds = leds[:: -1 if mirror_y else 1, :: -1 if mirror_x else 1]
        self.digits: NDArray[np.uint8] = np.zeros((self.count, 8), np.uint8)
        self._shift = bytes(2 * self.count)
        self._clocked = 0
        super().__init__(width, height, history=history, seed=seed, cells=(self.count, _DIGITS))

    # power

    def reset(self) -> None:
        """Registers as at power-up; the chip has no reset pin."""
        super().reset()
        self._shift, self._clocked = bytes(2 * self.count), 0
        self._plain: bool | None = None  # whether all chips show their digits as they are; None if it is not known
        for name, _ in _CONTROL.values():
            setattr(self.registers, name, np.zeros(self.count, np.uint8))

    def _lose_ram(self) -> None:
        self.digits[:] = np.frombuffer(self._random.randbytes(self.digits.size), np.uint8).reshape(self.digits.shape)

    # the wire

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take nothing: there is no I2C."""
        raise TypeError("a MAX7219 sits on SPI")

    def transfer(self, run: bytes | bytearray | memoryview, data: bool) -> bytes:
        """Shift bytes in, whatever the D/C line, and out at the other end."""
        passing = self._shift + bytes(run)
        self._clocked += len(run)
        self._shift = passing[len(run) :]
        return passing[: len(run)]

    def deselect(self) -> None:
        """Let every chip obey what its 16 bits of the shift register say."""
        if not self._clocked:
            return
        missing, over = 2 * self.count - self._clocked, self._clocked % 2
        if missing > 0 or over:
            self.complain(f"a select takes a register and a byte for each of {self.count} chips", self._shift[-8:])
        elif missing < 0:
            self.remark(f"a select of more than {2 * self.count} bytes: the first leave at the far end")
        self._clocked = 0
        self._picture = None
        registers, values = self._shift[-2::-2], self._shift[::-2]  # from the data line on
        if 1 <= registers[0] <= _DIGITS and registers == registers[:1] * self.count:  # as most drivers send
            self.digits[:, registers[0] - 1] = np.frombuffer(values, np.uint8)
            self._progress.draw_at((slice(None), registers[0] - 1))
            whose = f" of all {self.count} chips" if self.count > 1 else ""
            self._tell(self._shift, f"digit {registers[0] - 1}{whose}: {written(values)}")
            return
        for chip, (register, value) in enumerate(zip(registers, values, strict=True)):
            self._set(chip, register & 0x0F, value)

    def _set(self, chip: int, register: int, value: int) -> None:
        """Set a register of a chip."""
        if self.listener and not (register == 0 and self.count > 1):
            self._tell((register, value), self._meaning(chip, register, value))
        if register == 0:
            return
        if register <= _DIGITS:
            self.digits[chip, register - 1] = value
            self._progress.draw_at((chip, register - 1))
            return
        self._plain = None
        if register not in _CONTROL:
            self.remark("there is no such register; ignored", (register, value))
            return
        name, mask = _CONTROL[register]
        getattr(self.registers, name)[chip] = value & mask

    def _meaning(self, chip: int, register: int, value: int) -> str:
        """What a register and its byte are, in words."""
        if register == 0:
            return "no operation"
        if register <= _DIGITS:
            name = f"digit {register - 1}: {value:02X}"
        else:
            name = f"{_CONTROL.get(register, ('no register', 0))[0].replace('_', ' ')} {value:02X}"
        return f"chip {chip}: {name}" if self.count > 1 else name

    # what can be seen

    @property
    def contrast(self) -> int:
        """Intensity, 0 to 15, of the chip at the data line."""
        return int(self.registers.intensity[0])

    @property
    def status(self) -> int:
        """There is none to read."""
        return 0

    def _look(self) -> Picture:
        r = self.registers
        if self._plain is None:
            self._plain = bool(r.on.all() and r.scan_limit.min() == _DIGITS - 1 and not (r.decode | r.test).any())
        seen: Picture = np.unpackbits(self.digits if self._plain else self._segments())[self._leds]
        return seen

    def _segments(self) -> NDArray[np.uint8]:
        """The segments that are lit, a byte a digit."""
        r, segments = self.registers, self.digits.copy()
        decoded = np.unpackbits(r.decode[:, np.newaxis], axis=1, bitorder="little").astype(bool)
        segments[decoded] = (_CODE_B[segments & 0x0F] | segments & _POINT)[decoded]
        segments[np.arange(_DIGITS) > r.scan_limit[:, np.newaxis]] = 0
        segments[r.on == 0] = 0
        segments[r.test != 0] = 0xFF  # even in shutdown
        return segments

    def __repr__(self) -> str:
        power = "on" if all(self.registers.on) else "off"
        return f"<MAX7219 {self.width}x{self.height}, {power}, {len(self.frames)} frames>"


def _blocks(wide: int, high: int, order: str | Sequence[tuple[int, int]], first: str) -> list[tuple[int, int]]:
    """The column and row of each module, the one at the data line first."""
    top, left = first.startswith("top"), first.endswith("left")
    if not isinstance(order, str):
        return [(int(column), int(row)) for column, row in order]
    if order not in ("rows", "columns", "serpentine"):
        return [(int(column), int(row)) for column, row in (block.split(".") for block in order.split(","))]
    blocks: list[tuple[int, int]] = []
    for outer in range(wide if order == "columns" else high):
        line: Iterable[int] = range(high if order == "columns" else wide)
        if order == "serpentine" and outer % 2:
            line = reversed(range(wide))
        for inner in line:
            column, row = (outer, inner) if order == "columns" else (inner, outer)
            blocks.append((column if left else wide - 1 - column, row if top else high - 1 - row))
    return blocks


def _rotations(rotation: int | str | Sequence[int], count: int) -> list[int]:
    if isinstance(rotation, str):
        rotation = [int(turn) for turn in rotation.split(",")]
    turns = [rotation] if isinstance(rotation, int) else list(rotation)
    return turns * count if len(turns) == 1 else turns
