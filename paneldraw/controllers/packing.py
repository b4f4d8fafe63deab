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
    y: cython.Py_ssize_t
    for y in range(8 * packed.shape[0]):
        if cython.compiled:
            _pack_row(
                cython.cast(cython.p_uchar, cython.address(levels[y, 0])),
                levels.strides[1],
                width,
                threshold,
                y & 7,
                cython.address(packed[y >> 3, 0]),
            )
        else:
            _pack_row(levels[y], 1, width, threshold, y & 7, packed[y >> 3])


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
