"""How data finds its place in the RAM: packing, the page pointer, windows filled across or down.

The RAM is an array of cells, a cell being what one address holds, of shape (lines, columns, elements): an element is a
byte of eight rows where pixels are packed in pages, and one pixel in every other packing. A line is a page or a row.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .commands import Command, Commands
from .frames import Picture

Bytes = NDArray[np.uint8]

ACROSS, DOWN, PAGE = 0, 1, 2
"""Addressing modes: the window is filled across first or down first; or the page pointer, in one page."""


class Packing(NamedTuple):
    """How pixels share bytes: bits a pixel, rows a byte, elements a byte, and how a byte becomes elements."""

    depth: int
    rows: int
    elements: int
    spread: Callable[[Bytes], Bytes]


def _nibbles(data: Bytes) -> Bytes:
    pairs = np.empty((data.size, 2), np.uint8)
    np.right_shift(data, 4, out=pairs[:, 0])
    np.bitwise_and(data, 0x0F, out=pairs[:, 1])
    return pairs


PAGES = Packing(1, 8, 1, lambda data: data)
"""Eight rows of one bit a byte, the topmost in the lowest bit."""
NIBBLES = Packing(4, 1, 2, _nibbles)
"""Two pixels of four bits a byte, the left one in the upper half."""
ROWS = Packing(1, 1, 8, np.unpackbits)
"""Eight pixels of one row a byte, the left one in the highest bit."""
BYTES = Packing(8, 1, 1, lambda data: data)
"""A byte a pixel."""


def levels(ram: Bytes, packing: Packing) -> Picture:
    """The RAM as levels: rows and segments."""
    flat = ram.reshape(len(ram), -1)
    return np.unpackbits(flat, axis=0, bitorder="little") if packing.rows == 8 else flat


class Counter(NamedTuple):
    """A pointer along one axis of the RAM: it counts to the end of its window and starts there again.

    From a place past its window it counts on to the end of the RAM, and on from 0.
    """

    at: int
    first: int
    last: int
    size: int

    def moved(self, at: int) -> int:
        """Where the pointer stands after it counted to there, which is the next turn at the most."""
        return self.first if at == self.last + 1 else at % self.size


Place = tuple[slice | int, slice]


def way(count: int, along: Counter, lines: Counter) -> tuple[list[Place], int, int]:
    """The way of a pointer through its window: as many whole lines at once as there are.

    Returns
    -------
    list of tuple
        Where so many cells go, as indices of lines and columns.
    int, int
        Where the two pointers stand then.
    """
    places: list[Place] = []
    (at, first, last, size), (line, _, bottom, _) = along, lines
    wide = last - first + 1
    while count:
        if at == first and count > wide > 0 and line <= bottom:
            whole = min(count // wide, bottom - line + 1)
            places.append((slice(line, line + whole), slice(first, last + 1)))
            line = lines.moved(line + whole)
            count -= whole * wide
        else:
            taken = min(count, (last if at <= last else size - 1) - at + 1)
            places.append((line, slice(at, at + taken)))
            if at + taken == last + 1:
                line = lines.moved(line + 1)
            at = along.moved(at + taken)
            count -= taken
    return places, at, line


def put(ram: Bytes, places: list[Place], cells: Bytes) -> None:
    """Put cells into the RAM on their way."""
    start = 0
    for place in places:
        room = ram[place]
        end = start + room.size // room.shape[-1]
        room[...] = cells[start:end].reshape(room.shape)
        start = end


# commands of pointers and windows; `chip` is a DisplayChip


def page_pointer(pages: int = 8, *, only_in_page_mode: bool = False) -> Commands:
    """The page pointer: B0 + page, 00 + the column's lower four bits, 10 + its upper ones."""

    def check(chip: Any, sent: bytes) -> None:
        if chip.mode != PAGE:
            chip.remark("the page pointer commands B0-B7, 00-0F and 10-1F are for page addressing mode only", sent)

    def low(chip: Any, sent: bytes) -> None:
        if only_in_page_mode:
            check(chip, sent)
        chip.registers.column = chip.registers.column & 0xF0 | sent[0] & 0x0F

    def high(chip: Any, sent: bytes) -> None:
        if only_in_page_mode:
            check(chip, sent)
        column = (sent[0] & 0x0F) << 4 | chip.registers.column & 0x0F
        if column & 0xF0 >= chip.columns:
            chip.complain(f"there is no column past {chip.columns - 1}", sent)
        chip.registers.column = column & (1 << (chip.columns - 1).bit_length()) - 1

    def page(chip: Any, sent: bytes) -> None:
        if only_in_page_mode:
            check(chip, sent)
        chip.registers.page = sent[0] & 0x0F

    return {
        **dict.fromkeys(range(0x10), Command(0, low, {"column": 0}, True, "column pointer {column}")),
        **dict.fromkeys(range(0x10, 0x20), Command(0, high, {"column": 0}, True, "column pointer {column}")),
        **dict.fromkeys(range(0xB0, 0xB0 + pages), Command(0, page, {"page": 0}, True, "page pointer {page}")),
    }


def row_pointer(rows: int) -> Commands:
    """The page pointer of chips that have rows: B0 takes the row as an argument."""

    def row(chip: Any, sent: bytes) -> None:
        if sent[1] >= rows:
            chip.complain(f"there is no row past {rows - 1}", sent)
        chip.registers.row = sent[1] % rows

    return {**page_pointer(1), 0xB0: Command(1, row, {"row": 0}, True, "row pointer {row}")}


def _addressing_mode(chip: Any, sent: bytes) -> None:
    mode = sent[1] & 0x03
    if mode == 0x03:
        chip.complain("the addressing mode is 00, 01 or 02", sent)
    elif mode != sent[1]:
        chip.remark("the upper bits of the addressing mode are 0", sent)
    chip.registers.mode = mode


#: The command with an argument that chooses the addressing mode: 20 of the SSD130x.
ADDRESSING_MODE = Command(1, _addressing_mode, {"mode": PAGE}, name="addressing mode: {mode}")


def windows(
    columns: int,
    lines: int,
    column_opcode: int,
    line_opcode: int,
    line_name: str = "row",
    *,
    not_in_page_mode: bool = False,
) -> Commands:
    """The two commands of a window: first and last column, first and last line; each puts its pointer at the first."""

    def command(axis: str, size: int) -> Command:
        def act(chip: Any, sent: bytes) -> None:
            size = chip.columns if axis == "column" else chip.lines
            if not_in_page_mode and chip.mode == PAGE:
                chip.complain("windows are for horizontal and vertical addressing mode only", sent)
            start, end = sent[1] % size, sent[2] % size
            if max(sent[1:]) >= size:  # the upper bits of an end of all ones, as some drivers send it, are not missed
                harmless = sent[1] < size and end == size - 1
                (chip.remark if harmless else chip.complain)(f"there is no {axis} past {size - 1}", sent)
            if start > end:
                chip.complain(f"the window starts after its end, at the {axis}s", sent)
            registers = vars(chip.registers)
            registers[axis] = registers[f"{axis}_start"] = start
            registers[f"{axis}_end"] = end

        registers = {axis: 0, f"{axis}_start": 0, f"{axis}_end": size - 1}
        return Command(2, act, registers, True, f"{axis}s {{{axis}_start}} to {{{axis}_end}}")

    return {column_opcode: command("column", columns), line_opcode: command(line_name, lines)}
