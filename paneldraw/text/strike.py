"""Bitmap fonts as their readers hand them over: the pictures of characters at one size."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Picture(NamedTuple):
    """The picture of a character or of a line of text.

    Attributes
    ----------
    ink : ndarray of uint8, shape (height, width)
        How much of each pixel is covered; of one bit a pixel, not 0 where it is lit.
    left : int
        Columns from the pen to the first of the picture; negative where it overhangs.
    top : int
        Rows from the top of the line to the first of the picture; negative where it rises above.
    advance : float
        Columns from this pen to the next; a whole number in bitmap fonts.
    """

    ink: NDArray[np.uint8]
    left: int
    top: int
    advance: float


NOTHING = Picture(np.zeros((0, 0), np.uint8), 0, 0, 0)


class Strike(NamedTuple):
    """A bitmap font at its one size.

    Attributes
    ----------
    name : str
        What people call it.
    ascent, descent : int
        Rows of a line down to the one that letters stand on, that one included, and rows below it.
    pictures : mapping of int to Picture
        By code point; it may read a picture when asked for it.
    gap : int, default 0
        Columns of the last advance that do not belong to a line.
    cells : bool, default False
        Whether the characters fill a cell each, so that the box of a text is its cells and not its ink.
    missing : int, optional
        The code point of what stands for characters that are not there. Default: a box is drawn.
    size : int, optional
        What people call its size. Default: the rows of a line.
    """

    name: str
    ascent: int
    descent: int
    pictures: Mapping[int, Picture]
    gap: int = 0
    cells: bool = False
    missing: int | None = None
    size: int | None = None


def box(width: int, height: int, ascent: int) -> Picture:
    """The frame that stands for a character that a font does not have, on the baseline of a line."""
    ink = np.full((max(height, 1), max(width, 1)), 255, np.uint8)
    ink[1:-1, 1:-1] = 0
    return Picture(ink, 0, ascent - ink.shape[0], ink.shape[1] + 1)


def overlaid(pictures: list[Picture], advance: float) -> Picture:
    """Pictures of one line, one over the other, as one."""
    inked = [picture for picture in pictures if picture.ink.size]
    if not inked:
        return NOTHING._replace(advance=advance)
    left, top = min(picture.left for picture in inked), min(picture.top for picture in inked)
    right = max(picture.left + picture.ink.shape[1] for picture in inked)
    bottom = max(picture.top + picture.ink.shape[0] for picture in inked)
    ink = np.zeros((bottom - top, right - left), np.uint8)
    for picture in inked:
        height, width = picture.ink.shape
        part = ink[picture.top - top :, picture.left - left :][:height, :width]
        np.maximum(part, picture.ink, out=part)
    return Picture(ink, left, top, advance)
