"""Text layout: the lines of a text, and where its box lies from the point it is anchored at."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from paneldraw.text.font import Font, font_of, split_lines

if TYPE_CHECKING:
    from numpy.typing import NDArray

_ANCHORS = {h + v for h in "lmr" for v in "atmsbd"}


def render(text: str, font: Font | None = None, anchor: str = "lt") -> tuple[NDArray[np.uint8], int, int]:
    """Return what a text covers, and where that lies from the point it is anchored at.

    Parameters
    ----------
    text : str
        One or more lines, separated by ``"\\n"``. Tabs reach to the next fourth character.
    font : Font, optional
        Default: the built-in one.
    anchor : str, default "lt"
        Which pixel of the text's box is meant by (x, y), in Pillow's two letters. First ``l`` the leftmost, ``m`` the
        middle or ``r`` the rightmost column; lines are flush with that side. Then ``t`` or ``a`` the topmost, ``m``
        the middle, ``b`` or ``d`` the lowest row, or ``s`` the row that the first line stands on.

    Returns
    -------
    coverage : numpy.ndarray
        uint8 of shape (height, width), C-contiguous: 0 where there is no ink, 255 where there is, shades between where
        the font is anti-aliased.
    dx, dy : int
        From the anchored point to the top-left pixel of the coverage.

    Raises
    ------
    TypeError
        If the text is not a string or the font not a Font.
    ValueError
        If there is no such anchor.

    Examples
    --------
    >>> from paneldraw.text import render
    >>> coverage, dx, dy = render("Hi!", anchor="rb")
    >>> coverage.shape, dx, dy
    ((8, 17), -16, -7)
    """
    font = font_of(font)
    offset(anchor, 0, 0, 0)
    lines = split_lines(text)
    if len(lines) == 1:
        coverage = np.ascontiguousarray(font._face.line(lines[0]))
    else:
        coverage = _stack([font._face.line(line) for line in lines], font.height, anchor[0])
    height, width = coverage.shape
    return coverage, *offset(anchor, width, height, font.baseline)


def offset(anchor: str, width: int, height: int, baseline: int) -> tuple[int, int]:
    """From the point where a text is anchored to the top-left pixel of its box of `width` x `height` pixels."""
    if anchor not in _ANCHORS:
        raise ValueError(f"anchor must be one of l, m, r and one of a, t, m, s, b, d, such as 'lt', not {anchor!r}")
    horizontal, vertical = anchor[0], anchor[1]
    return -_reach(horizontal, width), -baseline if vertical == "s" else -_reach(vertical, height)


def _reach(side: str, size: int) -> int:
    """Pixels from the first of a row of ``size`` pixels to the one that an anchor's letter names."""
    if side in "rbd":
        return max(size - 1, 0)
    return max(size - 1, 0) // 2 if side == "m" else 0


def _stack(covers: list[NDArray[np.uint8]], height: int, side: str) -> NDArray[np.uint8]:
    """Set lines one below the other, flush with a side."""
    width = max(cover.shape[1] for cover in covers)
    stacked = np.zeros((height * len(covers), width), np.uint8)
    for row, cover in enumerate(covers):
        left = _reach(side, width) - _reach(side, cover.shape[1])
        stacked[row * height : (row + 1) * height, left : left + cover.shape[1]] = cover
    return stacked
