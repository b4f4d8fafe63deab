"""Text layout: the lines of a text, and where its box lies from the point it is anchored at."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from paneldraw.errors import did_you_mean
from paneldraw.text.font import Font, check_line_spacing, font_of, split_lines

if TYPE_CHECKING:
    from typing import Literal, TypeAlias

    from numpy.typing import NDArray

    from paneldraw.text.strike import Picture

    Direction: TypeAlias = Literal["right", "down", "left", "up"]

DIRECTIONS = ("right", "down", "left", "up")
"""Where text runs, after 0, 1, 2 and 3 quarter turns clockwise."""

_ANCHORS = {h + v for h in "lmr" for v in "atmsbd"}


def render(
    text: str,
    font: Font | None = None,
    anchor: str = "la",
    *,
    line_spacing: int = 0,
    direction: Direction = "right",
    inverse: bool = False,
) -> tuple[NDArray[np.uint8], int, int]:
    """Return what a text covers, and where that lies from the point it is anchored at.

    Parameters
    ----------
    text : str
        One or more lines, separated by ``"\\n"``. Tabs reach to the next fourth character.
    font : Font, optional
        Default: the built-in one.
    anchor : str, default "la"
        Which pixel of the text is meant by (x, y), in Pillow's two letters; its lines between pixels name here the
        pixel inside the text, so ``r`` and ``m``, ``s``, ``b``, ``d`` are Pillow's one pixel further on. First ``l``
        where the pen starts, ``m`` the middle or ``r`` the last column of the advance; lines are flush with that
        side. Then ``a`` the top row of the line, ``t`` the topmost lit row, ``m`` the middle, ``s`` the row that the
        first line stands on, ``b`` the lowest lit row, or ``d`` the lowest row of the line. In the built-in fonts a
        character fills its cell, so that ``t`` is ``a`` and ``b`` is ``d``.
    line_spacing : int, default 0
        Rows between lines; negative to bring them closer.
    direction : {"right", "down", "left", "up"}, default "right"
        Where the text runs, as the whole of it is turned about the anchored pixel by quarter turns.
    inverse : bool, default False
        Whether the box of the lines is covered, a pixel more on each side, and the characters are not.

    Returns
    -------
    coverage : numpy.ndarray
        uint8 of shape (height, width), C-contiguous: 0 where there is no ink, 255 where there is, shades between where
        the font is anti-aliased. The lines with their full height and advance, and whatever ink reaches beyond.
    dx, dy : int
        From the anchored point to the top-left pixel of the coverage.

    Raises
    ------
    TypeError
        If the text is not a string or the font not a Font.
    ValueError
        If there is no such anchor or direction, or lines are closer than a row.

    Examples
    --------
    >>> from paneldraw.text import render
    >>> coverage, dx, dy = render("Hi!", anchor="rb")
    >>> coverage.shape, dx, dy
    ((8, 17), -16, -7)
    """
    font = font_of(font)
    check_anchor(anchor)
    check_line_spacing(line_spacing, font)
    if direction not in DIRECTIONS:
        hint = did_you_mean(direction, DIRECTIONS) if isinstance(direction, str) else ""
        raise ValueError(f"direction must be one of {', '.join(map(repr, DIRECTIONS))}, not {direction!r}{hint}")
    coverage, dx, dy = cover(split_lines(text), font, anchor, line_spacing)
    if inverse:
        coverage, dx, dy = 255 - np.pad(coverage, 1), dx - 1, dy - 1
    return _turned(coverage, dx, dy, DIRECTIONS.index(direction))


def _turned(coverage: NDArray[np.uint8], dx: int, dy: int, quarters: int) -> tuple[NDArray[np.uint8], int, int]:
    """Turn a picture clockwise about the pixel from which its top-left one is at (dx, dy)."""
    for _ in range(quarters):
        dx, dy = 1 - dy - coverage.shape[0], dx
        coverage = np.rot90(coverage, -1)
    return np.ascontiguousarray(coverage), dx, dy


def cover(texts: list[str], font: Font, anchor: str, line_spacing: int = 0) -> tuple[NDArray[np.uint8], int, int]:
    """Return what lines cover, one below the other, and where that lies from the point that they are anchored at."""
    step = font.height + line_spacing
    height = step * len(texts) - line_spacing
    lines = [font._face.line(text) for text in texts]
    widest = max(line.advance for line in lines)
    side = _reach(anchor[0], widest)
    lefts = [side - _reach(anchor[0], line.advance) + line.left for line in lines]
    tops = [number * step + line.top for number, line in enumerate(lines)]
    placed = list(zip(lines, lefts, tops, strict=True))
    left, top = min(0, *lefts), min(0, *tops)
    right = max(math.ceil(widest), *(x + line.ink.shape[1] for line, x, _ in placed))
    bottom = max(height, *(y + line.ink.shape[0] for line, _, y in placed))
    coverage = np.zeros((bottom - top, right - left), np.uint8)
    for line, x, y in placed:
        part = coverage[y - top :, x - left :][: line.ink.shape[0], : line.ink.shape[1]]
        np.maximum(part, line.ink, out=part)
    dy = rise(anchor, font, height, _ink(lines[0]), _ink(lines[-1]))
    return coverage, left - side, top + dy


def check_anchor(anchor: str) -> None:
    """Refuse what is no anchor, of whatever type."""
    if not isinstance(anchor, str) or anchor not in _ANCHORS:
        raise ValueError(f"anchor must be one of l, m, r and one of a, t, m, s, b, d, such as 'la', not {anchor!r}")


def offset(anchor: str, font: Font, width: float, top: int, bottom: int) -> tuple[int, int]:
    """From the point where one line of text is anchored to its pen and the top of the line.

    `width` is its advance; it is lit from row `top` on, above row `bottom`.
    """
    check_anchor(anchor)
    return -_reach(anchor[0], width), rise(anchor, font, font.height, (top, bottom), (top, bottom))


def rise(anchor: str, font: Font, height: int, first: tuple[int, int], last: tuple[int, int]) -> int:
    """From the row where lines of text are anchored to the top of the first, by the lit rows of the first and last."""
    ascent = font.baseline + 1
    vertical = anchor[1]
    if font._cells:
        first = last = (0, font.height)
    if vertical == "m":
        if font._cells:
            return -(max(height - 1, 0) // 2)
        # The middle of ascent and descent, from the baseline, halves up, as Pillow rounds it.
        return 1 - ascent + (2 * ascent - font.height + 1) // 2 - (height - font.height) // 2
    # Pillow counts the line that letters stand on as lit.
    rows = {
        "a": 0,
        "t": min(first[0], ascent),
        "s": ascent - 1,
        "b": height - font.height + max(last[1], ascent) - 1,
        "d": height - 1,
    }
    return -rows[vertical]


def _ink(line: Picture) -> tuple[int, int]:
    return line.top, line.top + line.ink.shape[0]


def _reach(side: str, width: float) -> int:
    """Columns from the first of an advance to the one that an anchor's letter names, to the nearest."""
    if side == "l":
        return 0
    return max(math.floor((width if side == "r" else width / 2) + 0.5) - 1, 0)
