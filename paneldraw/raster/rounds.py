# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Discs, ellipses, rounded rectangles and what is cut out of them, counted at n x n reference points a pixel.

All are rectangles with four quarters of an ellipse for corners: a circle's rectangle is its center. The outline is a
band of a given width along the curve; filled shapes have the same outer edge. Coordinates come in 256ths of a pixel;
the lattice of reference points is that of `paneldraw.raster.thick`, and every test on it is exact. A point on an edge
counts as inside if the inside lies to its right, or, on a horizontal edge, below.
"""

from __future__ import annotations

from math import isqrt
from typing import Any

import cython

from paneldraw.raster.cuts import Spans, without

if cython.compiled:
    from cython.cimports.paneldraw.raster.chords import chord
    from cython.cimports.paneldraw.raster.cuts import Cut
    from cython.cimports.paneldraw.raster.supersample import paint
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.chords import chord
    from paneldraw.raster.cuts import Cut
    from paneldraw.raster.supersample import paint
    from paneldraw.raster.surface import Surface


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def band(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    a: cython.longlong,
    b: cython.longlong,
    width: cython.longlong,
    sharp: cython.bint,
    fill: cython.bint,
    cut: Cut | None,
    n: cython.int,
    corner: cython.bint,
) -> cython.void:
    """The band along a curve, or with `fill` also what it encloses, and of these what `cut` leaves.

    The curve has the horizontal radius `a` and the vertical `b` around the corners of the rectangle from (left, top)
    to (right, bottom); with `sharp` it is that rectangle itself. Coordinates within +-2**18 pixels, radii with half
    the width less than 2**13.
    """
    # Left, top, right and bottom of the rectangle, and the two radii.
    outer: cython.longlong[6]
    hole: cython.longlong[6]
    spans: cython.Py_ssize_t[224]
    if not cython.compiled:
        outer, hole, spans = [0] * 6, [0] * 6, [0] * 224
    half: cython.longlong = n * width
    _bound(outer, n, left, top, right, bottom, a, b, half, sharp)
    hollow: cython.bint = not fill and _bound(hole, n, left, top, right, bottom, a, b, -half, sharp)
    if cut is not None:
        cut.place(2 * n * left, 2 * n * top, half, n)
    # Sub-pixel g of pixel row or column g // n has its reference point at 512 g - middle.
    middle: cython.longlong = 256 * (n if corner else n - 1)
    first: cython.longlong = max((outer[1] - outer[5] + middle + 511) >> 9, surface.top * n)
    last: cython.longlong = min((outer[3] + outer[5] + middle + 511) >> 9, surface.bottom * n)
    y: cython.longlong = first // n
    row: cython.longlong
    start: cython.Py_ssize_t
    count: cython.Py_ssize_t
    while y * n < last:
        count = 0
        for row in range(max(first, y * n), min(last, y * n + n)):
            start = count
            count += _across(outer, 512 * row - middle, middle, spans, count)
            if hollow and _across(hole, 512 * row - middle, middle, spans, count):
                count = _open(spans, count)
            if cut is not None and count > start:
                count = cut.apply(spans, start, count, 512 * row - middle, middle)
        paint(surface, y, spans, count, n)
        y += 1


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _bound(
    box: cython.p_longlong,
    n: cython.int,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    a: cython.longlong,
    b: cython.longlong,
    outward: cython.longlong,
    sharp: cython.bint,
) -> cython.bint:
    """Set `box` to the curve on the lattice, `outward` of the given one; return whether anything is inside.

    The radii grow or shrink; what they cannot shrink the rectangle does, whose corners are sharp then.
    """
    box[4] = 0 if sharp else max(0, 2 * n * a + outward)
    box[5] = 0 if sharp else max(0, 2 * n * b + outward)
    x: cython.longlong = outward if sharp else min(0, 2 * n * a + outward)
    y: cython.longlong = outward if sharp else min(0, 2 * n * b + outward)
    box[0] = 2 * n * left - x
    box[1] = 2 * n * top - y
    box[2] = 2 * n * right + x
    box[3] = 2 * n * bottom + y
    return box[0] <= box[2] and box[1] <= box[3]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _across(
    box: cython.p_longlong,
    y: cython.longlong,
    middle: cython.longlong,
    spans: cython.p_Py_ssize_t,
    at: cython.Py_ssize_t,
) -> cython.bint:
    """Write the sub-pixels of sub-scanline `y` that are inside as span number `at`; return whether it meets the box."""
    away: cython.longlong = max(box[1] - y, y - box[3], 0)
    if y >= box[3] + box[5] or away > box[5]:
        return False
    reach: cython.longlong = chord(box[4], box[5], away)
    spans[2 * at] = (box[0] - (reach >> 1) + middle + 511) >> 9
    spans[2 * at + 1] = (box[2] + ((reach + 1) >> 1) + middle + 511) >> 9
    return True


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _open(spans: cython.p_Py_ssize_t, count: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Take the span after the last one, which is a part of that, out of it; return how many spans there are now."""
    low: cython.Py_ssize_t = spans[2 * count]
    high: cython.Py_ssize_t = spans[2 * count + 1]
    spans[2 * count] = max(low, high)
    spans[2 * count + 1] = spans[2 * count - 1]
    spans[2 * count - 1] = low
    return count + 1


# -- The same, whatever their size and place: the same inequalities in Python's integers


@cython.cfunc
def band_far(
    surface: Surface,
    centers: Any,
    a: Any,
    b: Any,
    width: Any,
    sharp: cython.bint,
    fill: cython.bint,
    cut: Any,
    n: cython.int,
    corner: cython.bint,
) -> Any:
    """The band along a curve; `cut` is a function of the spans, half a width, the pixel's sub-pixels and y, or None."""
    k: cython.Py_ssize_t
    spans: cython.Py_ssize_t[224]
    if not cython.compiled:
        spans = [0] * 224
    x, down = 2 * n * centers[0], 2 * n * centers[1]
    size = (2 * n * (centers[2] - centers[0]), 2 * n * (centers[3] - centers[1]), 2 * n * a, 2 * n * b)
    middle = 256 * (n if corner else n - 1)
    for y in range(surface.top, surface.bottom):
        count: cython.Py_ssize_t = 0
        for row in range(n * y, n * y + n):
            height = 512 * row - middle - down
            pieces = _pieces_far(size, n * width, sharp, fill, height)
            if cut is not None and pieces:
                pieces = cut(pieces, n * width, n, height)
            for k in range(len(pieces)):
                for end in (0, 1):
                    bound = -((-pieces[k][end] - x - middle) // 512)
                    spans[2 * count + end] = min(max(bound, (surface.left - 1) * n), (surface.right + 1) * n)
                count += 1
        paint(surface, y, spans, count, n)


def _pieces_far(size: tuple[int, int, int, int], half: int, sharp: bool, fill: bool, y: int) -> Spans:
    """What of the band is at height `y`, on the lattice, seen from the first center."""
    outer = _across_far(size, half, sharp, y)
    hole = [] if fill else _across_far(size, -half, sharp, y)
    return without(outer, *hole[0]) if hole else outer


def _across_far(size: tuple[int, int, int, int], outward: int, sharp: bool, y: int) -> Spans:
    right, bottom, a, b = size
    beyond_x, beyond_y = (outward, outward) if sharp else (min(0, a + outward), min(0, b + outward))
    a, b = (0, 0) if sharp else (max(0, a + outward), max(0, b + outward))
    left, top, right, bottom = -beyond_x, -beyond_y, right + beyond_x, bottom + beyond_y
    away = max(top - y, y - bottom, 0)
    if left > right or top > bottom or away > b or y >= bottom + b:
        return []
    squared = a * a * (b * b - away * away)
    reach = isqrt(squared // (b * b)) if away else a
    inexact = away and reach * reach * b * b != squared
    return [(left - reach, right + reach + (1 if inexact else 0))]
