"""Bitmap fonts as their readers hand them over: the pictures of characters at one size."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Picture(NamedTuple):
    """The picture of one character.

    Attributes
    ----------
    ink : ndarray of uint8, shape (height, width)
        Not 0 where it is lit.
    left : int
        Columns from the pen to the first of the picture; negative where it overhangs.
    top : int
        Rows from the top of the line to the first of the picture; negative where it rises above.
    advance : int
        Columns from this pen to the next.
    """

    ink: NDArray[np.uint8]
    left: int
    top: int
    advance: int


@dataclass(frozen=True, slots=True, eq=False)
class Strike:
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
    """

    name: str
    ascent: int
    descent: int
    pictures: Mapping[int, Picture]
    gap: int = 0
    cells: bool = False
    missing: int | None = None
