"""A text terminal: characters in cells, with the escape sequences that programs color and place them by."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from itertools import groupby
from typing import TYPE_CHECKING

from paneldraw.text.characters import composed, is_invisible, is_mark
from paneldraw.text.font import TAB, Font, font_of

if TYPE_CHECKING:
    from paneldraw.framebuffer import Framebuffer

LARGEST = 1000
"""Columns and rows; more than any panel has."""

LONGEST = 256
"""Characters of an escape sequence; what is longer is none."""

MOST_MARKS = 8
"""Characters of a cell: a letter and its marks."""

Color = tuple[int, int, int]

# The sixteen colors by number as VGA has them: each light is off or at 2/3, and 1/3 brighter in the second eight.
_SIXTEEN: list[Color] = [
    (light + 170 * (number & 1), light + 85 * (number & 2), light + 170 * (number >> 2))
    for light in (0, 85)
    for number in range(8)
]
_CUBE = (0, 95, 135, 175, 215, 255)

# A whole sequence, or one that may go on: control sequences, strings that end with BEL or ST, and those of one letter.
_SEQUENCE = re.compile(
    r"\x1b(?:\[(?P<numbers>[0-?]*)[ -/]*(?P<final>[@-~])|[\]PX^_][^\x07\x1b]*(?:\x07|\x1b\\)|[ -/]+[0-~]"
    r"|(?P<letter>[0-OQ-WYZ\\`-~]))"
)
_UNFINISHED = re.compile(r"\x1b(?:\[[0-?]*[ -/]*|[\]PX^_][^\x07\x1b]*\x1b?|[ -/]*)\Z")


@dataclass(frozen=True, slots=True)
class Rendition:
    """How a cell looks: colors (None: the default), and whether it is bold, underlined, or the other way round."""

    ink: Color | None = None
    paper: Color | None = None
    bold: bool = False
    underline: bool = False
    inverse: bool = False

    def levels(self, max_level: int) -> tuple[int, int]:
        """The levels of the characters and of the cells they stand in."""
        ink = max_level if self.ink is None else _level(self.ink, max_level)
        paper = 0 if self.paper is None else _level(self.paper, max_level)
        if ink == paper and self.ink != self.paper:
            # Colors that differ are seen to, in however few levels.
            ink = max_level if 2 * paper < max_level else 0
        return (paper, ink) if self.inverse else (ink, paper)


PLAIN = Rendition()

Cell = tuple[str, Rendition]
"""A character with its marks, empty for the right half of a wide one, and how it looks."""


def _level(color: Color, max_level: int) -> int:
    """A color's brightness (ITU-R BT.601) as a level."""
    red, green, blue = color
    return (max_level * (299 * red + 587 * green + 114 * blue) + 127_500) // 255_000


def _of_256(number: int) -> Color:
    if number < 16:
        return _SIXTEEN[number]
    if number < 232:
        number -= 16
        return _CUBE[number // 36], _CUBE[number // 6 % 6], _CUBE[number % 6]
    return (8 + 10 * (number - 232),) * 3


class Console:
    """A text terminal of so many columns and rows, for what a script prints.

    It understands what programs send to a terminal: colors (as levels, by their brightness), bold, underlined and
    inverse text, moving the cursor, erasing, inserting and deleting, and scrolling. Sequences that it does not know
    are left out. Nothing is drawn until `draw` is called.

    Parameters
    ----------
    columns, rows : int
        1 to 1000.
    font : Font, optional
        Default: the built-in one. Characters that are narrower than the cell stand at its left.
    cursor : bool, default False
        Whether the cursor is shown, as an inverse cell.

    Attributes
    ----------
    columns, rows : int
    font : Font
    cursor : bool
        Programs switch it with ``ESC [ ? 25 h`` and ``l``.
    width, height : int
        Pixels.

    Raises
    ------
    TypeError
        If a size is not a whole number.
    ValueError
        If a size is out of range.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.text import Console
    >>> console = Console(21, 8)
    >>> print("load", "\\x1b[7m 0.42 \\x1b[m", file=console)
    >>> console.text.rstrip()
    'load  0.42'
    >>> console.draw(Framebuffer(128, 64))
    """

    def __init__(self, columns: int, rows: int, *, font: Font | None = None, cursor: bool = False) -> None:
        for name, size in (("columns", columns), ("rows", rows)):
            if not isinstance(size, int):
                raise TypeError(f"{name} must be a whole number, not {type(size).__name__}")
            if not 1 <= size <= LARGEST:
                raise ValueError(f"{name} must be from 1 to {LARGEST}, not {size}")
        self.columns, self.rows = columns, rows
        self.font, self.cursor = font_of(font), cursor
        self._cell = self.font.advance or self.font.width
        self._begun = ""
        self.reset()

    def reset(self) -> None:
        """Empty all, with the cursor at the top left and no colors."""
        self._rendition = PLAIN
        self._cells = [self._blank_row() for _ in range(self.rows)]
        self._x = self._y = 0
        self._wraps = True
        self._kept = (0, 0, PLAIN)
        self._region = (0, self.rows)

    @property
    def width(self) -> int:
        """Columns of pixels."""
        return self.columns * self._cell

    @property
    def height(self) -> int:
        """Rows of pixels."""
        return self.rows * self.font.height

    @property
    def text(self) -> str:
        """What stands there, a line a row, without the spaces at their ends."""
        return "\n".join("".join(char for char, _ in row).rstrip() for row in self._cells)

    @property
    def position(self) -> tuple[int, int]:
        """The column and row of the cursor, from 0."""
        return min(self._x, self.columns - 1), self._y

    def write(self, s: str) -> int:
        """Write text at the cursor; ``print(..., file=console)`` does so too. Returns the number of characters.

        An end of line goes to the start of the next row; at the last, all rows move up. A row that is full goes on in
        the next. An escape sequence may come in parts.
        """
        if not isinstance(s, str):
            raise TypeError(f"s must be a string, not {type(s).__name__}")
        text = self._begun + s
        self._begun = ""
        at = 0
        while at < len(text):
            if text[at] != "\x1b":
                self._put(text[at])
                at += 1
                continue
            found = _SEQUENCE.match(text, at)
            if found:
                self._obey(found["numbers"] or "", found["final"] or "", found["letter"] or "")
                at = found.end()
            elif _UNFINISHED.match(text, at) and len(text) - at <= LONGEST:
                self._begun = text[at:]
                break
            else:
                at += 1
        return len(s)

    def flush(self) -> None:
        """Do nothing, as a file that is always written."""

    def draw(self, fb: Framebuffer, x: int = 0, y: int = 0) -> None:
        """Draw all cells, the top-left pixel of the first at (x, y).

        Parameters
        ----------
        fb : Framebuffer
            Or a view.
        x, y : int, default 0
        """
        runs = [
            (x + start * self._cell, y + number * self.font.height, chars, rendition)
            for number, row in enumerate(self._cells)
            for start, chars, rendition in _runs(self._with_cursor(row, number))
        ]
        with fb.clip(x, y, self.width, self.height):
            for left, top, chars, rendition in runs:
                paper = rendition.levels(fb.max_level)[1]
                fb.rect(left, top, len(chars) * self._cell, self.font.height, paper, fill=True)
            for left, top, chars, rendition in runs:
                self._draw_run(fb, left, top, chars, rendition)

    def _with_cursor(self, row: list[Cell], number: int) -> list[Cell]:
        column, line = self.position
        if not self.cursor or line != number:
            return row
        char, rendition = row[column]
        return [*row[:column], (char, replace(rendition, inverse=not rendition.inverse)), *row[column + 1 :]]

    def _draw_run(self, fb: Framebuffer, left: int, top: int, chars: list[str], rendition: Rendition) -> None:
        ink = rendition.levels(fb.max_level)[0]
        text = "".join(chars)
        for step in range(1 + rendition.bold):
            if self.font.advance and text.isascii() and not text.isspace():
                fb.text(text, left + step, top, ink, font=self.font)
                continue
            for column, char in enumerate(chars):
                if not char.isspace():
                    fb.text(char, left + step + column * self._cell, top, ink, font=self.font)
        if rendition.underline:
            row = min(self.font.baseline + 1, self.font.height - 1)
            fb.hline(left, top + row, len(chars) * self._cell, ink)

    # -- Characters

    def _put(self, char: str) -> None:
        if char == "\n":
            self._x = 0
            self._feed()
        elif char == "\r":
            self._x = 0
        elif char == "\b":
            self._x = max(self.position[0] - 1, 0)
        elif char == "\t":
            self._x = min(self._x // TAB * TAB + TAB, self.columns - 1)
        elif is_mark(ord(char)):
            self._mark(char)
        elif not (is_invisible(ord(char)) or unicodedata.category(char) == "Cc"):
            self._place(char)

    def _place(self, char: str) -> None:
        """Put a character into the cell, or into two if it is wide, and go on to the next."""
        cells = min(2 if unicodedata.east_asian_width(char) in "WF" else 1, self.columns)
        if self._x + cells > self.columns:
            if self._wraps:
                self._x = 0
                self._feed()
            else:
                self._x = self.columns - cells
        row = self._cells[self._y]
        if not row[self._x][0] and self._x:
            row[self._x - 1] = self._blank()
        row[self._x : self._x + cells] = [(char, self._rendition), ("", self._rendition)][:cells]
        self._x += cells
        if self._x < self.columns and not row[self._x][0]:
            row[self._x] = self._blank()

    def _mark(self, mark: str) -> None:
        """Put a mark on the character before the cursor."""
        row, column = self._cells[self._y], self._x - 1
        while column > 0 and not row[column][0]:
            column -= 1
        if column >= 0 and len(row[column][0]) < MOST_MARKS:
            row[column] = (composed(row[column][0] + mark), row[column][1])

    def _feed(self) -> None:
        """Go to the next row; at the last one, move all up."""
        top, bottom = self._region
        if self._y == bottom - 1:
            self._shift(top, bottom, 1)
        else:
            self._y = min(self._y + 1, self.rows - 1)

    def _rise(self) -> None:
        top, bottom = self._region
        if self._y == top:
            self._shift(top, bottom, -1)
        else:
            self._y = max(self._y - 1, 0)

    def _shift(self, top: int, bottom: int, rows: int) -> None:
        """Move rows up, or down if `rows` is negative; blank ones follow."""
        count = min(abs(rows), bottom - top)
        blank = [self._blank_row() for _ in range(count)]
        rest = self._cells[top:bottom]
        self._cells[top:bottom] = rest[count:] + blank if rows > 0 else blank + rest[: len(rest) - count]

    def _blank(self) -> Cell:
        return " ", Rendition(paper=self._rendition.paper)

    def _blank_row(self) -> list[Cell]:
        return [self._blank()] * self.columns

    # -- Escape sequences, by their last letter, in the terms of ECMA-48

    def _obey(self, text: str, final: str, letter: str) -> None:
        if letter:
            self._obey_letter(letter)
            return
        if not final or text.startswith(("<", "=", ">")):
            return
        numbers = [int(part[:9]) if part.isdecimal() else 0 for part in re.split("[;:]", text.lstrip("?"))[:64]]
        if text.startswith("?"):
            self._switch(numbers, final)
        elif final == "m":
            self._rendition = _selected(self._rendition, numbers)
        elif final in "Hf":
            row, column = (*numbers, 0)[:2]
            self._go(max(column, 1) - 1, max(row, 1) - 1)
        elif final in "JK":
            self._erase(numbers[0], final == "J")
        elif final == "r":
            self._set_region(numbers)
        elif final in "su":
            self._obey_letter("7" if final == "s" else "8")
        elif final in _MOVES:
            self._move(final, max(numbers[0], 1))
        elif final in "LMPX@ST":
            self._edit(final, max(numbers[0], 1))

    def _obey_letter(self, letter: str) -> None:
        if letter == "7":
            self._kept = (*self.position, self._rendition)
        elif letter == "8":
            self._x, self._y, self._rendition = self._kept
        elif letter == "c":
            self.reset()
        elif letter == "M":
            self._rise()
        elif letter in "DE":
            self._x = 0 if letter == "E" else self._x
            self._feed()

    def _switch(self, numbers: list[int], final: str) -> None:
        if final in "hl":
            if 25 in numbers:
                self.cursor = final == "h"
            if 7 in numbers:
                self._wraps = final == "h"

    def _go(self, x: int, y: int) -> None:
        self._x, self._y = min(max(x, 0), self.columns - 1), min(max(y, 0), self.rows - 1)

    def _move(self, final: str, count: int) -> None:
        x, y = self.position
        self._go(*_MOVES[final](x, y, count))

    def _erase(self, which: int, all_rows: bool) -> None:
        """Erase from the cursor on (0), up to it (1), or all (2), of the row or of all rows."""
        x, y = self.position
        row = self._cells[y]
        first, last = (x if which == 0 else 0), (x + 1 if which == 1 else self.columns)
        row[first:last] = [self._blank()] * (last - first)
        if all_rows:
            for number in range(0 if which else y + 1, y if which == 1 else self.rows):
                self._cells[number] = self._blank_row()

    def _edit(self, final: str, count: int) -> None:
        """Insert and delete rows (L, M) and characters (@, P), erase characters (X), scroll (S, T)."""
        x, y = self.position
        top, bottom = self._region
        row = self._cells[y]
        blank = [self._blank()] * min(count, self.columns - x)
        if final in "ST":
            self._shift(top, bottom, count if final == "S" else -count)
        elif final in "LM" and top <= y < bottom:
            self._shift(y, bottom, count if final == "M" else -count)
        elif final == "@":
            row[x:] = (blank + row[x:])[: self.columns - x]
        elif final == "P":
            row[x:] = row[x + len(blank) :] + blank
        elif final == "X":
            row[x : x + len(blank)] = blank

    def _set_region(self, numbers: list[int]) -> None:
        """Let only some of the rows scroll."""
        top, bottom = (*numbers, 0)[:2]
        region = (max(top, 1) - 1, min(bottom or self.rows, self.rows))
        if region[0] < region[1] - 1 or region == (0, self.rows):
            self._region = region
            self._go(0, 0)


_MOVES: dict[str, Callable[[int, int, int], tuple[int, int]]] = {
    "A": lambda x, y, count: (x, y - count),
    "B": lambda x, y, count: (x, y + count),
    "C": lambda x, y, count: (x + count, y),
    "D": lambda x, y, count: (x - count, y),
    "E": lambda x, y, count: (0, y + count),
    "F": lambda x, y, count: (0, y - count),
    "G": lambda x, y, count: (count - 1, y),
    "`": lambda x, y, count: (count - 1, y),
    "d": lambda x, y, count: (x, count - 1),
}

_SELECTED: dict[int, dict[str, object]] = {
    1: {"bold": True},
    4: {"underline": True},
    7: {"inverse": True},
    22: {"bold": False},
    24: {"underline": False},
    27: {"inverse": False},
    39: {"ink": None},
    49: {"paper": None},
}


def _selected(rendition: Rendition, numbers: list[int]) -> Rendition:
    """How cells look after a sequence that selects colors and the like."""
    left = iter(numbers)
    for number in left:
        if number == 0:
            rendition = PLAIN
        elif number in _SELECTED:
            rendition = replace(rendition, **_SELECTED[number])  # type: ignore[arg-type]
        elif number in (38, 48):
            color = _spelled(left)
            if color is not None:
                rendition = replace(rendition, ink=color) if number == 38 else replace(rendition, paper=color)
        elif number // 10 in (3, 9) and number % 10 < 8:
            rendition = replace(rendition, ink=_SIXTEEN[number % 10 + 8 * (number >= 90)])
        elif number // 10 in (4, 10) and number % 10 < 8:
            rendition = replace(rendition, paper=_SIXTEEN[number % 10 + 8 * (number >= 100)])
    return rendition


def _spelled(numbers: Iterator[int]) -> Color | None:
    """A color by number (5) or by its red, green and blue (2)."""
    kind = next(numbers, 0)
    if kind == 5:
        return _of_256(min(next(numbers, 0), 255))
    if kind == 2:
        red, green, blue = (min(next(numbers, 0), 255) for _ in range(3))
        return red, green, blue
    return None


def _runs(row: list[Cell]) -> Iterator[tuple[int, list[str], Rendition]]:
    """Yield the cells of a row that look alike: the first column, the characters, and how they look."""
    start = 0
    for rendition, cells in groupby(row, key=lambda cell: cell[1]):
        chars = [char for char, _ in cells]
        yield start, chars, rendition
        start += len(chars)
