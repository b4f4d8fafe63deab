"""The hardware scroll of the SSD130x: its commands, their rules, and how the picture moves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .commands import Command, Commands

FRAMES = (5, 64, 128, 256, 3, 4, 25, 2)
"""Frames from step to step, by the code that sets them, of the SSD1306."""
_LEFT = (0x27, 0x2A, 0x2D)


@dataclass
class Scroll:
    """The hardware scroll as set up by 26, 27, 29, 2A and A3.

    ``opcode`` is 0 until a scroll is set up; ``interval`` is the datasheet's code 0 ... 7, not a number of frames. It
    moves the RAM itself, as after it the sheet wants the picture sent anew; left and right are those of the columns'
    addresses, and rows move up.
    """

    opcode: int = 0
    page_start: int = 0
    page_end: int = 0
    interval: int = 0
    rows_per_step: int = 0
    column_start: int = 0
    column_end: int = 127
    across: bool = True
    top_rows: int = 0
    scroll_rows: int = 64
    frames: tuple[int, ...] = FRAMES

    def move(self, ram: NDArray[np.uint8], steps: int = 1) -> None:
        """Move pages of bytes, whose column 0 is the first, on by some steps."""
        if self.across:
            window = ram[self.page_start : self.page_end + 1, self.column_start : self.column_end + 1]
            window[...] = np.roll(window, -steps if self.opcode in _LEFT else steps, axis=1)
        if self.rows_per_step:
            rows = np.unpackbits(ram, axis=0, bitorder="little")
            area = rows[self.top_rows : self.top_rows + self.scroll_rows]
            area[...] = np.roll(area, -steps * self.rows_per_step, axis=0)
            ram[...] = np.packbits(rows, axis=0, bitorder="little")


def _set_up(chip: Any, sent: bytes, layout: str, frames: tuple[int, ...] = FRAMES) -> Scroll:
    """A scroll after the arguments of a command, whose places `layout` names; its rules are spoken."""
    given = dict(zip(layout.split(), sent[1:], strict=True))
    old = chip.registers.scroll
    scroll = Scroll(
        sent[0],
        given["p"] & 7,
        given["P"] & 7,
        given.get("i", 0) & 7,
        given.get("v", 0) & 0x3F,
        given.get("c", 0),
        given.get("C", chip.columns - 1),
        bool(given.get("h", 1)),
        old.top_rows,
        old.scroll_rows,
        frames,
    )
    if chip.registers.scrolling:
        chip.complain("a scroll is set up only while none is running; send 2E first", sent)
    if given.get("0"):
        chip.complain("the first argument of a scroll is 00", sent)
    if max(given["p"], given["P"]) >= chip.lines or given.get("i", 0) > 7:
        chip.complain("pages and interval of a scroll are 00 to 07", sent)
    elif given["P"] < given["p"]:
        chip.complain("the scroll's end page is before its start page", sent)
    if scroll.column_end < scroll.column_start:
        chip.complain("the scroll's end column is before its start column", sent)
    if (given.get("00", 0x00), given.get("FF", 0xFF)) != (0x00, 0xFF):
        chip.remark("the last arguments of a horizontal scroll are 00 FF", sent)
    if "v" in given and not 1 <= given["v"] < min(scroll.scroll_rows, 64):
        chip.complain("the vertical scroll offset is 01 to 3F and below the scrolling rows", sent)
    return scroll


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


def scroll(across: str, diagonal: str, once: str = "", frames: tuple[int, ...] = FRAMES) -> Commands:
    """The commands of a scroll: 26 and 27, 29 and 2A, 2C and 2D where there is one column at a time; A3, 2E, 2F.

    Parameters
    ----------
    across, diagonal, once : str
        What each argument is, in order: p and P the first and last page, c and C the first and last column, i the
        interval, v the rows a step, h whether columns move too, b whether what comes in is blank, which the sheets have
        as a dummy of 01 and owners of modules saw; 0, 00 and FF are that; - is any.
    frames : tuple of int
        The intervals, by their codes. Default: those of the SSD1306.
    """
    state = {"scroll": Scroll(), "scrolling": False}

    def command(layout: str) -> Command:
        def act(chip: Any, sent: bytes) -> None:
            chip.registers.scroll = _set_up(chip, sent, layout, frames)

        return Command(len(layout.split()), act, state, name="scroll set up")

    def one(chip: Any, sent: bytes) -> None:
        step = _set_up(chip, sent, once)
        step.move(chip.pages)
        if sent[1 + once.split().index("b")]:
            edge = step.column_end if sent[0] in _LEFT else step.column_start
            chip.pages[step.page_start : step.page_end + 1, edge] = 0

    return {
        **dict.fromkeys((0x26, 0x27), command(across)),
        **dict.fromkeys((0x29, 0x2A), command(diagonal)),
        **(dict.fromkeys((0x2C, 0x2D), Command(len(once.split()), one, name="scroll by one column")) if once else {}),
        0x2E: Command(0, _stop, state, name="scroll {scrolling}"),
        0x2F: Command(0, _start, state, name="scroll {scrolling}"),
        0xA3: Command(2, _area, state, name="scroll area: {1} fixed rows, {2} scrolling"),
    }
