# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""Levels, one byte a pixel, to the bytes that a panel's RAM takes. One function a packing, none a chip."""

from __future__ import annotations

import cython
import numpy as np


def pack_pages(
    levels: cython.const[cython.uchar][:, :],  # type: ignore[valid-type]
    max_level: cython.int,
    packed: cython.uchar[:, ::1],
) -> None:
    """Pack rows of levels into pages: a byte is eight rows of a column, the topmost in the lowest bit.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
        The height a multiple of 8.
    max_level : int
        The highest level; the upper half of the levels is lit.
    packed : (height / 8, width) uint8, contiguous
        Where the pages go, from the top.
    """
    width: cython.Py_ssize_t = packed.shape[1]
    y: cython.Py_ssize_t
    for y in range(8 * packed.shape[0]):
        if cython.compiled:
            _pack_row(
                cython.cast(cython.p_uchar, cython.address(levels[y, 0])),
                levels.strides[1],
                width,
                max_level >> 1,
                y & 7,
                cython.address(packed[y >> 3, 0]),
            )
        else:
            _pack_row(levels[y], 1, width, max_level >> 1, y & 7, packed[y >> 3])


@cython.cfunc
@cython.exceptval(check=False)
def _pack_row(
    source: cython.p_uchar,
    step: cython.Py_ssize_t,
    width: cython.Py_ssize_t,
    threshold: cython.uchar,
    row: cython.int,
    target: cython.p_uchar,
) -> cython.void:
    """Put one row into its page; row 0 clears the others."""
    bit: cython.uchar = 1 << row
    x: cython.Py_ssize_t
    if row == 0:
        for x in range(width):
            target[x] = 0
    if step == 1:  # the same loop, apart: compilers make vectors of it
        for x in range(width):
            target[x] |= bit if source[x] > threshold else 0
    else:
        for x in range(width):
            target[x] |= bit if source[x * step] > threshold else 0


def pack_nibbles(
    levels: cython.const[cython.uchar][:, :],  # type: ignore[valid-type]
    max_level: cython.int,
    packed: cython.uchar[:, ::1],
) -> None:
    """Pack rows of levels two pixels a byte, the left one in the upper half.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
        The width even.
    max_level : int
        The highest level, 1, 3, 15 or 255; it becomes 15, and each below the nearest to its share.
    packed : (height, width / 2) uint8, contiguous
        Where the rows go, from the top.
    """
    nibbles: cython.const[cython.uchar][::1] = _NIBBLES[max_level]  # type: ignore[valid-type]
    y: cython.Py_ssize_t
    x: cython.Py_ssize_t
    for y in range(packed.shape[0]):
        for x in range(packed.shape[1]):
            packed[y, x] = nibbles[levels[y, 2 * x]] << 4 | nibbles[levels[y, 2 * x + 1]]


_NIBBLES = {
    highest: ((30 * np.arange(256) + highest) // (2 * highest)).clip(max=15).astype(np.uint8)
    for highest in (1, 3, 15, 255)
}
"""What a level becomes, by the highest level that there is."""

PACK = {"pages": pack_pages, "nibbles": pack_nibbles}
"""The functions by the packing that a controller names."""
