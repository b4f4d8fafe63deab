# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""Levels, one byte a pixel, to the bytes that a panel's RAM takes. One function a packing, none a chip."""

from __future__ import annotations

import cython


def pack_pages(
    levels: cython.const[cython.uchar][:, :],  # type: ignore[valid-type]
    threshold: cython.uchar,
    packed: cython.uchar[:, ::1],
) -> None:
    """Pack rows of levels into pages: a byte is eight rows of a column, the topmost in the lowest bit.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
        The height a multiple of 8.
    threshold : int
        Levels above it are lit.
    packed : (height / 8, width) uint8, contiguous
        Where the pages go, from the top.
    """
    width: cython.Py_ssize_t = packed.shape[1]
    page: cython.Py_ssize_t
    row: cython.Py_ssize_t
    x: cython.Py_ssize_t
    bit: cython.uchar
    for page in range(packed.shape[0]):
        for x in range(width):
            packed[page, x] = 0
        for row in range(8):
            bit = 1 << row
            for x in range(width):
                packed[page, x] |= bit if levels[8 * page + row, x] > threshold else 0
