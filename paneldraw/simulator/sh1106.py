"""A byte-level SH1106: 132 x 64 bits of RAM, and no way to address it but the page pointer."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .chip import Chip
from .commands import DISPLAY, MIRRORS, TIMING, Command, Complain, Setting, foreign, nothing, start_line, table, written
from .frames import Picture
from .glass import Glass, com_signals

COLUMNS, PAGES, ROWS = 132, 8, 64


@dataclass
class Registers:
    """The registers of an SH1106. The defaults are the values that reset gives them."""

    column: int = 0
    page: int = 0
    kept_column: int | None = None
    """Where a read-modify-write began; None while there is none."""
    start_line: int = 0
    offset: int = 0
    multiplex: int = ROWS - 1
    com_pins: int = 0x12
    segment_remap: bool = False
    com_reversed: bool = False
    contrast: int = 0x80
    all_on: bool = False
    inverted: bool = False
    on: bool = False
    converter: int = 0x8B
    pump_voltage: int = 0x32
    clock: int = 0x50
    precharge: int = 0x22
    vcomh: int = 0x35
    external_vcc: bool = False

    @property
    def lit(self) -> bool:
        """Whether the panel is on and fed."""
        return self.on and (self.converter == 0x8B or self.external_vcc)

    @property
    def signals(self) -> NDArray[np.intp]:
        """Which COM signal each pad carries."""
        return com_signals(ROWS, alternate=bool(self.com_pins & 0x10))


def _column_low(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.column = registers.column & 0xF0 | sent[0] & 0x0F


def _column_high(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.column = (sent[0] & 0x0F) << 4 | registers.column & 0x0F


def _page(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.page = sent[0] & 0x07


def _pump_voltage(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.pump_voltage = sent[0]


def _converter(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if sent[1] not in (0x8A, 0x8B):
        complain(f"{written(sent)}: the DC-DC converter takes 8A (off) or 8B (on)")
    elif registers.on and sent[1] != registers.converter:
        complain(f"{written(sent)}: the DC-DC converter is switched while the display is off")
    registers.converter = 0x8A | sent[1] & 0x01


def _modify(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.kept_column = registers.column


def _end_modify(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if registers.kept_column is None:
        complain(f"{written(sent)}: the end of a read-modify-write that was not begun (E0)")
    else:
        registers.column, registers.kept_column = registers.kept_column, None


COMMANDS = table(
    "SH1106",
    {
        **TIMING,
        0xA8: Setting("multiplex", 0x3F, range(64), "the multiplex ratio is 00 to 3F (1 to 64 lines)"),
        0xDA: Setting("com_pins", 0x12, (0x02, 0x12), "the COM pins are 02 or 12"),
        0xDB: Setting("vcomh"),
    },
    {
        **DISPLAY,
        **MIRRORS,
        **dict.fromkeys(range(0xC0, 0xC8), ("com_reversed", False)),
        **dict.fromkeys(range(0xC8, 0xD0), ("com_reversed", True)),
    },
    {
        **dict.fromkeys(range(0x10), Command(0, _column_low)),
        **dict.fromkeys(range(0x10, 0x20), Command(0, _column_high)),
        **dict.fromkeys(range(0x20, 0x23), Command(0, foreign("SH1106", "addressing of the SSD1306"))),
        **dict.fromkeys(range(0x30, 0x34), Command(0, _pump_voltage)),
        **dict.fromkeys(range(0x40, 0x80), Command(0, start_line)),
        0x8D: Command(0, foreign("SH1106", "charge pump of the SSD1306")),
        0xAD: Command(1, _converter),
        **dict.fromkeys(range(0xB0, 0xB8), Command(0, _page)),
        0xE0: Command(0, _modify),
        0xE3: Command(0, nothing),
        0xEE: Command(0, _end_modify),
    },
)


class SH1106(Chip):
    """An SH1106 with its glass: 132 x 64 bits of RAM behind a window of 128 x 64 pixels.

    Parameters
    ----------
    width, height : int
        Visible size in pixels. Default: 128x64, the only module known here.
    column_offset : int, optional
        First visible RAM column under A1. Default: 2; some modules have 0 or 4.
    external_vcc : bool
        The module has its own panel supply and lights up without the DC-DC converter. Default: False.
    history : int or None
        How many frames `frames` keeps, the oldest dropped first; None keeps all. Default: 1000.
    seed : int or None
        Seed of the noise that the RAM holds after power-up; None makes it differ from run to run. Default: 0.

    Attributes
    ----------
    frames, violations
        As of `simulator.SSD1306`.
    registers : Registers
        All other state, by name.

    Raises
    ------
    ValueError
        For a size or offset that the chip cannot have.

    Notes
    -----
    A command that the datasheet forbids is recorded and then acts as far as its bits reach; an unknown one is ignored,
    without arguments. Data past column 131 is lost and recorded, as no datasheet says where it goes.

    Examples
    --------
    >>> chip = SH1106()
    >>> chip.write(bytes.fromhex("00 20 A5 AF"))
    >>> chip.violations
    ['20: not a command of the SH1106 (addressing of the SSD1306); ignored']
    """

    _commands = COMMANDS
    registers: Registers

    def __init__(
        self,
        width: int = 128,
        height: int = 64,
        *,
        column_offset: int = 2,
        external_vcc: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        if (width, height) != (128, ROWS):
            raise ValueError(f"width and height: {width}x{height} is no module known here (128x64)")
        if not 0 <= column_offset <= COLUMNS - width:
            raise ValueError(f"column_offset: {column_offset} is not 0 to {COLUMNS - width}")
        wired = com_signals(ROWS, alternate=True)
        self._glass = Glass(width, height, columns=COLUMNS, column_offset=column_offset, signals=wired)
        self.external_vcc = external_vcc
        super().__init__(width, height, np.zeros((PAGES, COLUMNS), np.uint8), history, seed)

    @property
    def ram(self) -> Picture:
        """A copy of the RAM, uint8, shape (8, 132): pages and segments. Under A1 column c is segment 131 - c."""
        return super().ram

    def _registers(self) -> Registers:
        return Registers(external_vcc=self.external_vcc)

    def _levels(self) -> Picture:
        return np.unpackbits(self._ram, axis=0, bitorder="little")

    def _store(self, data: NDArray[np.uint8]) -> None:
        registers = self.registers
        ram = self._ram[:, ::-1] if registers.segment_remap else self._ram
        fitting = data[: max(COLUMNS - registers.column, 0)]
        if fitting.size < data.size:
            self._complain(f"data past column {COLUMNS - 1}")
        ram[registers.page, registers.column : registers.column + fitting.size] = fitting
        registers.column = min(registers.column + data.size, 255)
