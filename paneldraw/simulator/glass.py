"""From display RAM to what an eye sees: how a module's glass is joined to the pads of its SSD1306."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .frames import Picture
from .ssd1306_commands import COLUMNS, ROWS, Registers


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


def _signals(com_pins: int) -> NDArray[np.intp]:
    """Which of the 64 COM signals each of the 64 pads carries under a DA setting (datasheet, table of COM pins)."""
    signals = np.arange(ROWS)
    if com_pins & 0x10:
        signals = np.concatenate((signals[0::2], signals[1::2]))
    if com_pins & 0x20:
        signals = np.roll(signals, ROWS // 2)
    return signals


class Glass:
    """The visible lines and columns of a module, joined to fixed COM and SEG pads.

    Line 0 of the glass is the one that the module's own DA setting gives to COM signal 0. With C8 that is the bottom
    line, and with A1 column 0 of the window is on the left: the common module stands upright under A1 and C8.
    """

    def __init__(self, width: int, height: int, module: Module) -> None:
        self.shape = (height, width)
        left = COLUMNS - 1 - module.column_offset
        self._segments = np.arange(left, left - width, -1)
        pads = np.argsort(_signals(module.com_pins))
        self._pads = pads[:height][::-1]

    def pixels(self, ram: Picture, registers: Registers) -> Picture:
        """The levels that an eye sees; `ram` has shape (8, 128): pages and segments."""
        if not (registers.on and (registers.pump_enabled or registers.external_vcc)):
            return np.zeros(self.shape, np.uint8)
        signals = _signals(registers.com_pins)[self._pads]
        lines = registers.multiplex - signals if registers.com_reversed else signals
        rows = (lines + registers.offset) % ROWS
        driven = rows <= registers.multiplex
        if registers.all_on:
            levels = np.ones(self.shape, np.uint8)
        else:
            bits = np.unpackbits(ram[:, self._segments], axis=0, bitorder="little")
            levels = bits[(rows + registers.start_line) % ROWS] ^ np.uint8(registers.inverted)
        return levels * driven[:, np.newaxis].astype(np.uint8)
