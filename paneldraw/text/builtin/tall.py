"""The tall fonts, for numbers: plain digits, and those of a seven-segment display."""

from __future__ import annotations

import numpy as np

from paneldraw.text.builtin.cells import Regular
from paneldraw.text.builtin.drawings import Cell, drawings

#: Which pixels the seven segments light, each by its letter.
_SEGMENTS = """
.aaaaaa.
f.aaaa.b
ff....bb
ff....bb
ff....bb
ff....bb
f.gggg.b
e.gggg.c
ee....cc
ee....cc
ee....cc
ee....cc
e.dddd.c
.dddddd.
"""

#: Characters, and the segments that show them.
_SHOWN = """
0O abcdef  1 bc  2 abdeg  3 abcdg  4 bcfg  5Ss acdfg  6 acdefg  7 abc  8 abcdefg  9g abcdfg
A abcefg  a abcdeg  Bb cdefg  C adef  c deg  Dd bcdeg  E adefg  e abdefg  Ff aefg  G acdef  H bcefg  h cefg  Il ef  i e
Jj bcde  L def  Nn ceg  o cdeg  Pp abefg  q abcfg  Rr eg  Tt defg  U bcdef  u cde  Yy bcdfg
- g  _ d  =  dg  ° abfg  ' b  " bf  [ adef  ] abcd  ? abeg
"""

#: Columns of what is narrower than a digit.
_NARROW = {".": 6, ",": 6, ":": 6, "°": 8}
_NARROW_SEGMENTS = 4


class Plain:
    """Digits and signs of 12 x 16; other characters are those of 6 x 8, twice as large and smoothed."""

    def __init__(self) -> None:
        drawn = drawings("numbers", 12, 16)
        self._drawn = {char: cell[:, : _NARROW.get(char, 12)] for char, cell in drawn.items()}
        self._small = Regular()

    def __call__(self, char: str) -> Cell | None:
        """Return the cell of a character, or None if there is none."""
        found = self._drawn.get(char)
        if found is None:
            small = self._small(char)
            return None if small is None else doubled(small)
        return found


class Segments(Plain):
    """What seven segments can show, in cells of 10 x 16; other characters are those of the plain font."""

    def __init__(self) -> None:
        super().__init__()
        for char in ".,:":
            self._drawn[char] = self._drawn[char][:, 1 : 1 + _NARROW_SEGMENTS]
        self._drawn[" "] = np.zeros((16, 10), np.uint8)
        picture = np.array([list(row) for row in _SEGMENTS.split()])
        words = _SHOWN.split()
        for chars, segments in zip(words[::2], words[1::2], strict=True):
            cell = np.zeros((16, 10), np.uint8)
            cell[: picture.shape[0], : picture.shape[1]] = np.isin(picture, list(segments))
            self._drawn |= dict.fromkeys(chars, cell)


def doubled(cell: Cell) -> Cell:
    """Return a cell twice as large, its slants smoothed: a corner goes to the two like neighbors that enclose it.

    As Scale2x does it: https://www.scale2x.it/algorithm
    """
    padded = np.zeros((cell.shape[0] + 2, cell.shape[1] + 2), np.uint8)
    padded[1:-1, 1:-1] = cell
    above, below, left, right = padded[:-2, 1:-1], padded[2:, 1:-1], padded[1:-1, :-2], padded[1:-1, 2:]
    large = np.empty((2 * cell.shape[0], 2 * cell.shape[1]), np.uint8)
    for row, (near, far) in enumerate(((above, below), (below, above))):
        for column, (side, other) in enumerate(((left, right), (right, left))):
            enclosed = (near == side) & (near != far) & (side != other)
            large[row::2, column::2] = np.where(enclosed, near, cell)
    return large
