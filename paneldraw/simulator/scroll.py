"""The hardware scroll of the SSD130x: its commands and their rules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from .commands import Command, Commands


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
    scroll_rows: int = 64


def _set_up(chip: Any, sent: bytes) -> None:
    scroll = chip.registers.scroll
    if chip.registers.scrolling:
        chip.complain("a scroll is set up only while none is running; send 2E first", sent)
    if sent[1]:
        chip.complain("the first argument of a scroll is 00", sent)
    if max(sent[2], sent[4]) >= chip.lines or sent[3] > 7:
        chip.complain("pages and interval of a scroll are 00 to 07", sent)
    elif sent[4] < sent[2]:
        chip.complain("the scroll's end page is before its start page", sent)
    scroll.opcode, scroll.page_start, scroll.interval, scroll.page_end = sent[0], sent[2] & 7, sent[3] & 7, sent[4] & 7
    if sent[0] in (0x26, 0x27):
        scroll.rows_per_step = 0
        if (sent[5], sent[6]) != (0x00, 0xFF):
            chip.complain("the last arguments of a horizontal scroll are 00 FF", sent)
    else:
        scroll.rows_per_step = sent[5] & 0x3F
        if not 1 <= sent[5] < min(scroll.scroll_rows, 64):
            chip.complain("the vertical scroll offset is 01 to 3F and below the scrolling rows", sent)


def _area(chip: Any, sent: bytes) -> None:
    if chip.registers.scrolling:
        chip.complain("the scroll area is set only while no scroll is running; send 2E first", sent)
    if sent[1] > 63 or sent[2] > 127 or sent[1] + sent[2] > chip.registers.multiplex + 1:
        chip.complain("the fixed and the scrolling rows together are at most the multiplex ratio", sent)
    chip.registers.scroll.top_rows, chip.registers.scroll.scroll_rows = sent[1] & 0x3F, sent[2] & 0x7F


def _start(chip: Any, sent: bytes) -> None:
    chip.registers.scrolling = True
    if not chip.registers.scroll.opcode:
        chip.complain("a scroll is started and none was set up (26, 27, 29 or 2A)", sent)


def _stop(chip: Any, sent: bytes) -> None:
    chip.registers.scrolling = False


_STATE = {"scroll": Scroll(), "scrolling": False}

SCROLL: Commands = {
    **dict.fromkeys((0x26, 0x27), Command(6, _set_up, _STATE)),
    **dict.fromkeys((0x29, 0x2A), Command(5, _set_up, _STATE)),
    0x2E: Command(0, _stop, _STATE),
    0x2F: Command(0, _start, _STATE),
    0xA3: Command(2, _area, _STATE),
}
