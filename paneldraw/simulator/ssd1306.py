"""A byte-level SSD1306: takes what the wire carries, keeps the datasheet's state, shows what an eye would see."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .chip import Chip
from .frames import Picture
from .glass import Glass
from .ssd1306_commands import (
    COLUMNS,
    COM_PINS,
    COMMANDS,
    HORIZONTAL,
    PAGES,
    ROWS,
    VERTICAL,
    Registers,
    pad_signals,
)


class Module(NamedTuple):
    """How a module of one size is wired: its first visible RAM column, and the DA value that suits its COM pads."""

    column_offset: int
    com_pins: int


MODULES = {
    (128, 64): Module(0, 0x12),
    (128, 32): Module(0, 0x02),
    (96, 16): Module(0, 0x02),
    (72, 40): Module(28, 0x12),
    (64, 48): Module(32, 0x12),
    (64, 32): Module(32, 0x12),
    (48, 64): Module(40, 0x12),
}


class SSD1306(Chip):
    """An SSD1306 with its glass: 128 x 64 bits of RAM behind a window of `width` x `height` pixels.

    Parameters
    ----------
    width, height : int
        Visible size in pixels: 128x64 (default), 128x32, 96x16, 72x40, 64x48, 64x32 or 48x64; any other size that the
        RAM holds needs `column_offset` and `com_pins`.
    column_offset : int, optional
        First visible RAM column under A1. Default: as modules of that size are wired (72x40: 28, 64x48 and 64x32: 32,
        48x64: 40, others 0).
    com_pins : int, optional
        The DA value that the glass is wired for: 0x02, 0x12, 0x22 or 0x32. Default: 0x02 (sequential) for 128x32 and
        96x16, 0x12 (alternative) for the others. Under another DA value the lines appear where the pads take them.
    external_vcc : bool
        The module has its own panel supply and lights up without the charge pump. Default: False.
    history : int or None
        How many frames `frames` keeps, the oldest dropped first; None keeps all. Default: 1000 (8 MB at 128x64).
    seed : int or None
        Seed of the noise that the RAM holds after power-up; None makes it differ from run to run. Default: 0.

    Attributes
    ----------
    frames : collections.deque of Frame
        One frame for every bus call (one ``i2c_rdwr`` or one SMBus call) that changed what the eye sees, unless the
        panel was dark before and after. A driver that sends a picture in several calls leaves several frames.
    violations : list of str
        What the datasheet forbids and the chip was sent, in order; each text once, at most 1000. Clear it as you like.
    registers : Registers
        All other state, by name.

    Raises
    ------
    ValueError
        For a size, offset or COM setting that the chip cannot have.

    Notes
    -----
    A command that the datasheet forbids is recorded and then acts as far as its bits reach; an unknown one is ignored.
    Hardware scrolling is state only: its commands are checked and kept, the picture stands still. Where the datasheet
    is silent: page mode runs through all 128 columns, whatever window was set; a pointer past the end of its window
    counts on to the end of the RAM; data in the middle of a command reaches the RAM and the command waits on; A5 lights
    an inverted display too; the status bits other than bit 6 are 0.

    Examples
    --------
    >>> chip = SSD1306(128, 32)
    >>> chip.write(bytes.fromhex("00 A8 1F DA 02 8D 14 20 00 A1 C8 A5 AF"))
    >>> chip.pixels.shape, int(chip.pixels.min())
    ((32, 128), 1)
    >>> chip.violations
    []
    """

    _commands = COMMANDS
    registers: Registers

    def __init__(
        self,
        width: int = 128,
        height: int = 64,
        *,
        column_offset: int | None = None,
        com_pins: int | None = None,
        external_vcc: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        module = _module(width, height, column_offset, com_pins)
        self._glass = Glass(
            width,
            height,
            columns=COLUMNS,
            column_offset=module.column_offset,
            signals=pad_signals(module.com_pins),
        )
        self.external_vcc = external_vcc
        super().__init__(width, height, np.zeros((PAGES, COLUMNS), np.uint8), history, seed)

    @property
    def ram(self) -> Picture:
        """A copy of the RAM, uint8, shape (8, 128): pages and segments. Under A1 column c is segment 127 - c."""
        return super().ram

    def _registers(self) -> Registers:
        return Registers(external_vcc=self.external_vcc)

    def _levels(self) -> Picture:
        return np.unpackbits(self._ram, axis=0, bitorder="little")

    def _store(self, data: NDArray[np.uint8]) -> None:
        registers = self.registers
        if registers.scroll.running:
            self._complain("data while a scroll is running; send 2E first")
        ram = self._ram[:, ::-1] if registers.segment_remap else self._ram
        while data.size:
            if registers.mode == VERTICAL:
                count = min(data.size, _until(registers.page, registers.page_end, PAGES))
                ram[registers.page : registers.page + count, registers.column] = data[:count]
            else:
                last = registers.column_end if registers.mode == HORIZONTAL else COLUMNS - 1
                count = min(data.size, _until(registers.column, last, COLUMNS))
                ram[registers.page, registers.column : registers.column + count] = data[:count]
            _advance(registers, count)
            data = data[count:]


def _until(position: int, last: int, size: int) -> int:
    """How many bytes fit before a pointer that counts up turns back: at the window's end, or past it at the RAM's."""
    return (last if position <= last else size - 1) - position + 1


def _advance(registers: Registers, count: int) -> None:
    """Move the pointers past `count` bytes that end no later than the next turn."""
    r = registers
    if r.mode == VERTICAL:
        r.page, turned = _step(r.page + count, r.page_start, r.page_end, PAGES)
        if turned:
            r.column, _ = _step(r.column + 1, r.column_start, r.column_end, COLUMNS)
    elif r.mode == HORIZONTAL:
        r.column, turned = _step(r.column + count, r.column_start, r.column_end, COLUMNS)
        if turned:
            r.page, _ = _step(r.page + 1, r.page_start, r.page_end, PAGES)
    else:
        r.column = (r.column + count) % COLUMNS


def _step(position: int, first: int, last: int, size: int) -> tuple[int, bool]:
    if position == last + 1:
        return first, True
    return position % size, False


def _module(width: int, height: int, column_offset: int | None, com_pins: int | None) -> Module:
    module = MODULES.get((width, height))
    offset = module.column_offset if column_offset is None and module else column_offset
    pins = module.com_pins if com_pins is None and module else com_pins
    if offset is None or pins is None:
        known = ", ".join(f"{w}x{h}" for w, h in MODULES)
        raise ValueError(
            f"width and height: {width}x{height} is no module known here ({known}); give column_offset and com_pins too"
        )
    if not 1 <= width <= COLUMNS or not 1 <= height <= ROWS:
        raise ValueError(f"width and height: {width}x{height} is not within 1x1 and {COLUMNS}x{ROWS}")
    if not 0 <= offset <= COLUMNS - width:
        raise ValueError(f"column_offset: {offset} is not 0 to {COLUMNS - width}, for {width} columns out of {COLUMNS}")
    if pins not in COM_PINS:
        raise ValueError(f"com_pins: {pins:#04x} is none of {', '.join(f'{p:#04x}' for p in COM_PINS)}")
    return Module(offset, pins)
