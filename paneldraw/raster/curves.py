# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Curves by Bresenham's midpoint method: integers only, one decision a step, every pixel once."""

from __future__ import annotations

from math import isqrt
from typing import Any

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.surface import Surface


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _rows(
    surface: Surface,
    cx: cython.longlong,
    cy: cython.longlong,
    y: cython.longlong,
    inner: cython.longlong,
    outer: cython.longlong,
) -> cython.void:
    """Ink ``inner <= |x - cx| <= outer`` in the rows `y` above and below the center."""
    _row(surface, cx, cy + y, inner, outer)
    if y > 0:
        _row(surface, cx, cy - y, inner, outer)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _row(
    surface: Surface, cx: cython.longlong, y: cython.longlong, inner: cython.longlong, outer: cython.longlong
) -> cython.void:
    if inner <= 0:
        surface.span(y, cx - outer, cx + outer + 1)
    else:
        surface.span(y, cx - outer, cx - inner + 1)
        surface.span(y, cx + inner, cx + outer + 1)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def circle(
    surface: Surface, cx: cython.longlong, cy: cython.longlong, r: cython.longlong, fill: cython.bint
) -> cython.void:
    """The midpoint circle: its outline, or with `fill` the outline and all that it encloses.

    Walks the octant from the top, (0, r), to the diagonal. The decision parameter starts at 1 - r, the circle's
    equation at the midpoint between the next two candidates; while it is negative the midpoint is inside and y stays.
    Each step is the pixel of a side octant, mirrored in four rows; each run of steps on one y is a piece of the top
    octant.
    """
    x: cython.longlong = 0
    y: cython.longlong = r
    start: cython.longlong = 0
    p: cython.longlong = 1 - r
    while x <= y:
        if x < y:
            _rows(surface, cx, cy, x, 0 if fill else y, y)
        x += 1
        if p < 0:
            p += 2 * x + 1
        else:
            _rows(surface, cx, cy, y, 0 if fill else start, x - 1)
            start = x
            y -= 1
            p += 2 * (x - y) + 1
    if start < x:
        _rows(surface, cx, cy, y, 0 if fill else start, x - 1)


@cython.cfunc
def circle_far(surface: Surface, cx: Any, cy: Any, r: Any, fill: cython.bint) -> Any:
    """The same circle, whatever its size and place, found row by visible row."""
    for y in range(max(surface.top, cy - r), min(surface.bottom, cy + r + 1)):
        distance = abs(y - cy)
        outer = _half_width(r, distance)
        inner = 0 if fill else min(outer, _half_width(r, distance + 1) + 1)
        for low, high in [(-outer, outer)] if inner <= 0 else [(-outer, -inner), (inner, outer)]:
            surface.span(y, min(max(cx + low, 0), surface.right), max(min(cx + high + 1, surface.right), 0))


def _half_width(r: int, distance: int) -> int:
    """How far a midpoint circle reaches to each side, `distance` rows from its center; -1 beyond its top."""
    if distance > r:
        return -1
    square = r * r - distance * distance
    nearest = (isqrt(4 * square) + 1) // 2
    return nearest if nearest >= distance else isqrt(square + distance - 1)
