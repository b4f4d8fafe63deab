"""A byte-level SSD1327: 128 x 128 pixels of 16 levels, addressed by windows of two pixels a byte."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .chip import Chip
from .commands import DISPLAY, Command, Complain, Setting, nothing, table, written
from .frames import Picture
from .glass import Glass, com_signals

COLUMNS, ROWS, SEGMENTS = 64, 128, 128
_COLUMN_REMAP, _NIBBLE_REMAP, _DOWN, _COM_REMAP, _COM_SPLIT = 0x01, 0x02, 0x04, 0x10, 0x40
_REMAP_BITS = _COLUMN_REMAP | _NIBBLE_REMAP | _DOWN | _COM_REMAP | _COM_SPLIT


class Module(NamedTuple):
    """How a module of one size is wired: its first visible segment and its first COM signal."""

    first_segment: int
    first_com: int


MODULES = {(128, 128): Module(0, 0), (96, 96): Module(16, 32)}


@dataclass
class Registers:
    """The registers of an SSD1327. The defaults are the values that reset gives them."""

    column: int = 0
    row: int = 0
    column_start: int = 0
    column_end: int = COLUMNS - 1
    row_start: int = 0
    row_end: int = ROWS - 1
    remap: int = 0x00
    start_line: int = 0
    offset: int = 0
    multiplex: int = ROWS - 1
    display: int = 0xA4
    contrast: int = 0x7F
    on: bool = False
    locked: bool = False
    regulator: int = 0x01
    phases: int = 0x74
    clock: int = 0x00
    gpio: int = 0x02
    second_precharge: int = 0x04
    precharge_voltage: int = 0x05
    vcomh: int = 0x05
    function_b: int = 0x60
    greys: tuple[int, ...] = tuple(range(0, 30, 2))
    """Pulse widths of levels 1 to 15."""
    scroll: bytes = b""
    scrolling: bool = False

    @property
    def lit(self) -> bool:
        """Whether the panel is on, and not all off by A6."""
        return self.on and self.display != 0xA6

    @property
    def all_on(self) -> bool:
        """Whether every pixel is at the highest level."""
        return self.display == 0xA5

    @property
    def inverted(self) -> bool:
        """Whether levels are turned over."""
        return self.display == 0xA7

    @property
    def com_reversed(self) -> bool:
        """Whether COM lines are reversed."""
        return bool(self.remap & _COM_REMAP)

    @property
    def signals(self) -> NDArray[np.intp]:
        """Which COM signal each pad carries."""
        return com_signals(ROWS, alternate=bool(self.remap & _COM_SPLIT))


def _window(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    axis, size = ("column", COLUMNS) if sent[0] == 0x15 else ("row", ROWS)
    if max(sent[1:]) >= size:
        complain(f"{written(sent)}: there is no {axis} past {size - 1}")
    start, end = sent[1] % size, sent[2] % size
    if start > end:
        complain(f"{written(sent)}: the window starts at {axis} {start}, after its end at {end}")
        end = size - 1
    setattr(registers, f"{axis}_start", start)
    setattr(registers, f"{axis}_end", end)
    setattr(registers, axis, start)


def _greys(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    steps = list(sent[1:])
    if max(steps) > 0x3F or any(low >= high for low, high in itertools.pairwise(steps)):
        complain(f"{written(sent)}: a grey table rises from step to step, to 3F at most")
    registers.greys = tuple(steps)


def _linear(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.greys = Registers.greys


def _lock(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if sent[1] not in (0x12, 0x16):
        complain(f"{written(sent)}: the command lock takes 12 (open) or 16 (locked)")
    registers.locked = bool(sent[1] & 0x04)


def _scroll(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if registers.scrolling:
        complain(f"{written(sent)}: a scroll is set up only while none is running; send 2E first")
    registers.scroll = bytes(sent)


def _scroll_run(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.scrolling = sent[0] == 0x2F
    if registers.scrolling and not registers.scroll:
        complain(f"{written(sent)}: a scroll is started and none was set up (26 or 27)")


COMMANDS = table(
    "SSD1327",
    {
        0x81: Setting("contrast"),
        0xA0: Setting(
            "remap",
            _REMAP_BITS,
            [n for n in range(256) if not n & ~_REMAP_BITS],
            "bits 3, 5 and 7 of the remap are 0",
        ),
        0xA1: Setting("start_line", 0x7F, range(ROWS), "the start line is 00 to 7F"),
        0xA2: Setting("offset", 0x7F, range(ROWS), "the display offset is 00 to 7F"),
        0xA8: Setting("multiplex", 0x7F, range(15, ROWS), "the multiplex ratio is 0F to 7F (16 to 128 lines)"),
        0xAB: Setting("regulator", 0x01, (0x00, 0x01), "the regulator takes 00 (external) or 01 (internal)"),
        0xB1: Setting("phases", legal=[n for n in range(256) if n & 0x0F and n & 0xF0], rule="a phase of 0 is invalid"),
        0xB3: Setting("clock"),
        0xB5: Setting("gpio", 0x03, range(4), "the GPIO takes 00 to 03"),
        0xB6: Setting("second_precharge", 0x0F, range(1, 16), "the second precharge period is 01 to 0F"),
        0xBC: Setting("precharge_voltage", 0x1F, range(32), "the precharge voltage is 00 to 1F"),
        0xBE: Setting("vcomh", 0x07, range(8), "the VCOMH level is 00 to 07"),
        0xD5: Setting("function_b", 0x63, range(0x60, 0x64), "function selection B is 60 to 63"),
    },
    {
        **DISPLAY,
        **{opcode: ("display", opcode) for opcode in range(0xA4, 0xA8)},
    },
    {
        0x15: Command(2, _window),
        0x26: Command(7, _scroll),
        0x27: Command(7, _scroll),
        0x2E: Command(0, _scroll_run),
        0x2F: Command(0, _scroll_run),
        0x75: Command(2, _window),
        **dict.fromkeys((0x84, 0x85, 0x86, 0xB2, 0xB4, 0xBB), Command(0, nothing)),
        0xB8: Command(15, _greys),
        0xB9: Command(0, _linear),
        0xFD: Command(1, _lock),
    },
)


class SSD1327(Chip):
    """An SSD1327 with its glass: 128 x 128 pixels of four bits behind a window of `width` x `height` pixels.

    Parameters
    ----------
    width, height : int
        Visible size in pixels: 128x128 (default) or 96x96.
    history : int or None
        How many frames `frames` keeps, the oldest dropped first; None keeps all. Default: 1000 (16 MB at 128x128).
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
        For a size that is no module's.

    Notes
    -----
    A command that the datasheet forbids is recorded and then acts as far as its bits reach; an unknown one is ignored.
    The common module stands upright under A0 51. What an eye sees is given in levels, whatever the grey table makes of
    them. Hardware scrolling is state only.

    Examples
    --------
    >>> chip = SSD1327()
    >>> chip.write(bytes.fromhex("00 A0 51 15 02 02 75 05 05 AF"))
    >>> chip.write(bytes.fromhex("40 C3"))
    >>> chip.pixels[5, 4:6].tolist()
    [12, 3]
    """

    max_level = 15
    _commands = COMMANDS
    registers: Registers

    def __init__(
        self,
        width: int = 128,
        height: int = 128,
        *,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        module = MODULES.get((width, height))
        if module is None:
            known = ", ".join(f"{w}x{h}" for w, h in MODULES)
            raise ValueError(f"width and height: {width}x{height} is no module known here ({known})")
        self._glass = Glass(
            width,
            height,
            columns=SEGMENTS,
            column_offset=module.first_segment,
            signals=com_signals(ROWS, alternate=True),
            first_com=module.first_com,
        )
        super().__init__(width, height, np.zeros((ROWS, SEGMENTS), np.uint8), history, seed)

    @property
    def ram(self) -> Picture:
        """A copy of the RAM, levels, shape (128, 128): rows and segments."""
        return super().ram

    def _registers(self) -> Registers:
        return Registers()

    def _undefined(self, noise: NDArray[np.uint8]) -> NDArray[np.uint8]:
        return noise & np.uint8(0x0F)

    def _obey(self, run: bytes) -> None:
        for byte in run:
            if self.registers.locked and not self._pending and byte != 0xFD:
                self._complain(f"{byte:02X}: commands are locked; send FD 12 first")
                continue
            super()._obey(bytes((byte,)))

    def _levels(self) -> Picture:
        return self._ram

    def _store(self, data: NDArray[np.uint8]) -> None:
        r = self.registers
        if r.scrolling:
            self._complain("data while a scroll is running; send 2E first")
        wide, high = r.column_end - r.column_start + 1, r.row_end - r.row_start + 1
        x, y = r.column - r.column_start, r.row - r.row_start
        first = x * high + y if r.remap & _DOWN else y * wide + x
        places = (first + np.arange(data.size + 1)) % (wide * high)
        columns = r.column_start + (places // high if r.remap & _DOWN else places % wide)
        rows = r.row_start + (places % high if r.remap & _DOWN else places // wide)
        r.column, r.row = int(columns[-1]), int(rows[-1])
        columns, rows = columns[:-1], rows[:-1]
        pairs = 2 * (COLUMNS - 1 - columns if r.remap & _COLUMN_REMAP else columns)
        lower = 1 if r.remap & _NIBBLE_REMAP else 0
        self._ram[rows, pairs + lower] = data & 0x0F
        self._ram[rows, pairs + 1 - lower] = data >> 4
