"""What each command of the SSD1306 does to its registers, after the datasheet's command table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .commands import DISPLAY, MIRRORS, TIMING, Command, Complain, Setting, foreign, nothing, start_line, table, written
from .glass import com_signals

HORIZONTAL, VERTICAL, PAGE = 0, 1, 2
COLUMNS, PAGES, ROWS = 128, 8, 64
COM_PINS = (0x02, 0x12, 0x22, 0x32)


def pad_signals(com_pins: int) -> NDArray[np.intp]:
    """Which COM signal each pad carries under a DA setting."""
    return com_signals(ROWS, alternate=bool(com_pins & 0x10), swapped=bool(com_pins & 0x20))


@dataclass
class Scroll:
    """The hardware scroll as set up by 26, 27, 29, 2A and A3; the simulator keeps it and does not move the picture.

    ``opcode`` is 0 until a scroll is set up; ``interval`` is the datasheet's code 0 ... 7, not a number of frames.
    """

    opcode: int = 0
    page_start: int = 0
    page_end: int = 0
    interval: int = 0
    rows_per_step: int = 0
    top_rows: int = 0
    scroll_rows: int = ROWS
    running: bool = False


@dataclass
class Registers:
    """The registers of an SSD1306. The defaults are the values that reset gives them."""

    mode: int = PAGE
    column: int = 0
    page: int = 0
    column_start: int = 0
    column_end: int = COLUMNS - 1
    page_start: int = 0
    page_end: int = PAGES - 1
    start_line: int = 0
    offset: int = 0
    multiplex: int = ROWS - 1
    com_pins: int = 0x12
    segment_remap: bool = False
    com_reversed: bool = False
    contrast: int = 0x7F
    all_on: bool = False
    inverted: bool = False
    on: bool = False
    charge_pump: int = 0x10
    clock: int = 0x80
    precharge: int = 0x22
    vcomh: int = 0x20
    external_vcc: bool = False
    scroll: Scroll = field(default_factory=Scroll)

    @property
    def pump_enabled(self) -> bool:
        """Whether the charge pump is switched on."""
        return bool(self.charge_pump & 0x04)

    @property
    def lit(self) -> bool:
        """Whether the panel is on and fed."""
        return self.on and (self.pump_enabled or self.external_vcc)

    @property
    def signals(self) -> NDArray[np.intp]:
        """Which COM signal each pad carries (datasheet, table of COM pins)."""
        return pad_signals(self.com_pins)


_SETTINGS = {
    **TIMING,
    0x20: Setting("mode", 0x03, (HORIZONTAL, VERTICAL, PAGE), "the addressing mode is 00, 01 or 02"),
    0xA8: Setting("multiplex", 0x3F, range(15, 64), "the multiplex ratio is 0F to 3F (16 to 64 lines)"),
    0xDA: Setting("com_pins", 0x3F, COM_PINS, "the COM pins are 02, 12, 22 or 32"),
    0xDB: Setting("vcomh", 0x70, (0x00, 0x20, 0x30), "the VCOMH level is 00, 20 or 30"),
}

# Drivers send these to every relative of the chip; an SSD1306 lets them pass, argument and all.
_RELATIVES = {
    0x23: "fade and blink of the SSD1306B",
    0xAD: "reference current of the SSD1315",
    0xD6: "zoom of the SSD1306B",
}


def _only_in_page_mode(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if registers.mode != PAGE:
        complain(f"{written(sent)}: the page pointer commands B0-B7, 00-0F and 10-1F are for page addressing mode only")


def _column_low(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    _only_in_page_mode(registers, sent, complain)
    registers.column = registers.column & 0x70 | sent[0] & 0x0F


def _column_high(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    _only_in_page_mode(registers, sent, complain)
    if sent[0] > 0x17:
        complain(f"{written(sent)}: there is no column past 127")
    registers.column = (sent[0] & 0x07) << 4 | registers.column & 0x0F


def _page_pointer(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    _only_in_page_mode(registers, sent, complain)
    registers.page = sent[0] & 0x07


def _window(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    axis, size = ("column", COLUMNS) if sent[0] == 0x21 else ("page", PAGES)
    if registers.mode == PAGE:
        complain(f"{written(sent)}: windows are for horizontal and vertical addressing mode only")
    if max(sent[1:]) >= size:
        complain(f"{written(sent)}: there is no {axis} past {size - 1}")
    start, end = sent[1] % size, sent[2] % size
    if start > end:
        complain(f"{written(sent)}: the window starts at {axis} {start}, after its end at {end}")
    setattr(registers, f"{axis}_start", start)
    setattr(registers, f"{axis}_end", end)
    setattr(registers, axis, start)


def _charge_pump(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if sent[1] & 0x3F not in (0x10, 0x14):
        complain(f"{written(sent)}: the charge pump takes 10 (off) or 14 (on)")
    elif registers.on and bool(sent[1] & 0x04) != registers.pump_enabled:
        complain(f"{written(sent)}: the charge pump is switched while the display is off, before AF")
    registers.charge_pump = sent[1]


def _display_on(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if not (registers.pump_enabled or registers.external_vcc):
        complain(f"{written(sent)}: display on without a supply for the panel; enable the charge pump first (8D 14)")
    registers.on = True


def _scroll(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    scroll, text = registers.scroll, written(sent)
    if scroll.running:
        complain(f"{text}: a scroll is set up only while none is running; send 2E first")
    if sent[1]:
        complain(f"{text}: the first argument of a scroll is 00")
    if max(sent[2], sent[4]) >= PAGES or sent[3] > 7:
        complain(f"{text}: pages and interval of a scroll are 00 to 07")
    elif sent[4] < sent[2]:
        complain(f"{text}: the scroll's end page is before its start page")
    scroll.opcode, scroll.page_start, scroll.interval, scroll.page_end = sent[0], sent[2] & 7, sent[3] & 7, sent[4] & 7
    if sent[0] in (0x26, 0x27):
        scroll.rows_per_step = 0
        if (sent[5], sent[6]) != (0x00, 0xFF):
            complain(f"{text}: the last arguments of a horizontal scroll are 00 FF")
    else:
        scroll.rows_per_step = sent[5] & 0x3F
        if not 1 <= sent[5] < min(scroll.scroll_rows, 64):
            complain(f"{text}: the vertical scroll offset is 01 to 3F and below the scrolling rows")


def _scroll_area(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    if registers.scroll.running:
        complain(f"{written(sent)}: the scroll area is set only while no scroll is running; send 2E first")
    if sent[1] > 63 or sent[2] > 127 or sent[1] + sent[2] > registers.multiplex + 1:
        complain(f"{written(sent)}: the fixed and the scrolling rows together are at most the multiplex ratio")
    registers.scroll.top_rows, registers.scroll.scroll_rows = sent[1] & 0x3F, sent[2] & 0x7F


def _scroll_run(registers: Registers, sent: Sequence[int], complain: Complain) -> None:
    registers.scroll.running = sent[0] == 0x2F
    if registers.scroll.running and not registers.scroll.opcode:
        complain(f"{written(sent)}: a scroll is started and none was set up (26, 27, 29 or 2A)")


COMMANDS = table(
    "SSD1306",
    _SETTINGS,
    {**DISPLAY, **MIRRORS},
    {
        **dict.fromkeys(range(0x10), Command(0, _column_low)),
        **dict.fromkeys(range(0x10, 0x20), Command(0, _column_high)),
        **dict.fromkeys(range(0x40, 0x80), Command(0, start_line)),
        **dict.fromkeys(range(0xB0, 0xB8), Command(0, _page_pointer)),
        **{opcode: Command(1, foreign("SSD1306", name)) for opcode, name in _RELATIVES.items()},
        0x21: Command(2, _window),
        0x22: Command(2, _window),
        0x26: Command(6, _scroll),
        0x27: Command(6, _scroll),
        0x29: Command(5, _scroll),
        0x2A: Command(5, _scroll),
        0x2E: Command(0, _scroll_run),
        0x2F: Command(0, _scroll_run),
        0x8D: Command(1, _charge_pump),
        0xA3: Command(2, _scroll_area),
        0xAF: Command(0, _display_on),
        0xE3: Command(0, nothing),
    },
)
