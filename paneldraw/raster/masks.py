# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Masks: pictures that say how much of each pixel is covered, as of a rendered text."""

from __future__ import annotations

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.surface import Surface


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def stamp(
    surface: Surface,
    mask: cython.p_uchar,
    width: cython.Py_ssize_t,
    height: cython.Py_ssize_t,
    x: cython.longlong,
    y: cython.longlong,
) -> cython.void:
    """Paint through a mask of coverages 0 ... 255, row by row in memory, its top-left pixel at (x, y)."""
    first: cython.Py_ssize_t = max(0, surface.left - x)
    last: cython.Py_ssize_t = min(width, surface.right - x)
    line: cython.Py_ssize_t
    column: cython.Py_ssize_t
    covered: cython.int
    before: cython.int
    cells: cython.p_longlong = surface.cells
    if first >= last:
        return
    surface.count_in(1, 255)
    for line in range(max(0, surface.top - y), min(height, surface.bottom - y)):
        before = 0
        for column in range(first, last):
            covered = mask[line * width + column]
            cells[x + column] = covered - before
            before = covered
        surface.blend(y + line, x + first, x + last, 0)
