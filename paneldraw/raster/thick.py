# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Thick lines: the filled rectangle around the ideal line, counted at n x n reference points a pixel.

Coordinates and widths come in 256ths of a pixel. Reference points lie on a lattice of 2 * 256 * n steps a pixel, in
which every test below is an exact comparison of integers. A point on the rectangle's edge counts as inside if the
inside lies to its right, or, on a horizontal edge, below: rectangles that share an edge share no pixel.
"""

from __future__ import annotations

from math import isqrt
from typing import Any

import cython

if cython.compiled:
    from cython.cimports.libc.math import ceil, floor, sqrt
    from cython.cimports.paneldraw.raster.supersample import paint
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from math import ceil, floor, sqrt

    from paneldraw.raster.supersample import paint
    from paneldraw.raster.surface import Surface


# One sub-pixel in the fixed-point numbers of `slab`, and where their range ends.
_UNIT = cython.declare(cython.double, float(1 << 40))
_LARGEST_BOUND = cython.declare(cython.longlong, 1 << 21)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _floor_div(a: cython.longlong, b: cython.longlong) -> cython.longlong:
    """Floor of a / b for b > 0; a division in C truncates."""
    return a // b if a >= 0 else -((b - 1 - a) // b)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _root_of_product(a: cython.ulonglong, b: cython.ulonglong) -> cython.longlong:
    """Largest t with t * t <= a * a * b, for t < 2**52.

    The floating-point root is off by one at most; the difference of the squares is small enough to survive
    arithmetic modulo 2**64, in which the squares themselves are lost.
    """
    t: cython.ulonglong = cython.cast(cython.ulonglong, floor(a * sqrt(b)))
    if cython.cast(cython.longlong, a * a * b - t * t) < 0:
        t -= 1
    elif cython.cast(cython.longlong, a * a * b - (t + 1) * (t + 1)) >= 0:
        t += 1
    return t


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def block(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    n: cython.int,
    corner: cython.bint,
) -> cython.void:
    """An upright rectangle; its sides in 512ths of a sub-pixel."""
    spans: cython.Py_ssize_t[32]
    if not cython.compiled:
        spans = [0] * 32
    # Sub-pixel g of pixel row or column g // n has its reference point at 512 g - middle.
    middle: cython.longlong = 256 * (n if corner else n - 1)
    first: cython.longlong = max(_floor_div(top + middle + 511, 512), surface.top * n)
    last: cython.longlong = min(_floor_div(bottom + middle + 511, 512), surface.bottom * n)
    a: cython.Py_ssize_t = _floor_div(left + middle + 511, 512)
    b: cython.Py_ssize_t = _floor_div(right + middle + 511, 512)
    count: cython.int
    y: cython.longlong
    row: cython.longlong
    for y in range(_floor_div(first, n), _floor_div(last - 1, n) + 1):
        count = 0
        for row in range(max(first, y * n), min(last, y * n + n)):
            spans[2 * count] = a
            spans[2 * count + 1] = b
            count += 1
            if surface.weighing:
                surface.weigh(y, row - y * n, a, b)
        paint(surface, y, spans, count, n)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def slab(
    surface: Surface,
    x1: cython.longlong,
    y1: cython.longlong,
    x2: cython.longlong,
    y2: cython.longlong,
    width: cython.longlong,
    square: cython.bint,
    n: cython.int,
    corner: cython.bint,
) -> cython.bint:
    """The rectangle of `width` around the line; with `square` it reaches half a width beyond the end points.

    End points within +-2**18 pixels, width within 2**12. In the line's own frame a point's distance across is
    v / length and along it u / length, with v = dx Y - dy X and u = dx X + dy Y. Each of the four edges bounds the
    points of a sub-scanline from the left or from the right. Returns False, with nothing painted, where the bounds
    are too far away or too fine for exact arithmetic in 64 bits.
    """
    dx: cython.longlong = x2 - x1
    dy: cython.longlong = y2 - y1
    if dx == 0 or dy == 0:
        half: cython.longlong = n * width
        reach: cython.longlong = half if square else 0
        if dy == 0:
            block(
                surface,
                2 * n * min(x1, x2) - reach,
                2 * n * y1 - half,
                2 * n * max(x1, x2) + reach,
                2 * n * y1 + half,
                n,
                corner,
            )
        else:
            block(
                surface,
                2 * n * x1 - half,
                2 * n * min(y1, y2) - reach,
                2 * n * x1 + half,
                2 * n * max(y1, y2) + reach,
                n,
                corner,
            )
        return True
    if dy < 0:
        x1, y1, dx, dy = x2, y2, -dx, -dy
    squared: cython.longlong = dx * dx + dy * dy
    # Half a width, times the length; rounded down for edges that belong to the shape, up for those that do not.
    inside: cython.longlong = _root_of_product(n * width, squared)
    outside: cython.longlong = inside
    scale: cython.ulonglong = n * width
    if cython.cast(cython.ulonglong, inside) * inside != scale * scale * squared:
        outside += 1
    end_inside: cython.longlong = inside if square else 0
    end_outside: cython.longlong = outside if square else 0
    whole: cython.longlong = 2 * n * squared

    # Rows of pixels that the rectangle may touch.
    sine: cython.double = dy / sqrt(squared)
    cosine: cython.double = abs(dx) / sqrt(squared)
    over: cython.double = width * (cosine + sine if square else cosine) / 512.0
    top: cython.longlong = max(surface.top, cython.cast(cython.longlong, floor(y1 / 256.0 - over + 0.49)))
    bottom: cython.longlong = min(surface.bottom, cython.cast(cython.longlong, ceil((y1 + dy) / 256.0 + over + 0.51)))
    if top >= bottom:
        return True

    # The bounds of the first sub-scanline: left side, left end, right side, right end.
    middle: cython.longlong = 256 * (n if corner else n - 1)
    down: cython.longlong = 512 * n * top - middle - 2 * n * y1
    offset: cython.longlong = 2 * n * x1 + middle
    edge: cython.int
    bound: cython.longlong[4]
    divisor: cython.longlong[4]
    step: cython.longlong[4]
    if not cython.compiled:
        bound, divisor, step = ([0] * 4 for _ in range(3))
    divisor[0] = divisor[2] = dy
    step[0] = step[2] = dx
    bound[0] = dx * down - inside
    bound[2] = dx * down + outside
    if dx > 0:
        divisor[1] = divisor[3] = dx
        step[1] = step[3] = -dy
        bound[1] = -dy * down - end_inside
        bound[3] = -dy * down + whole + end_outside
    else:
        divisor[1] = divisor[3] = -dx
        step[1] = step[3] = dy
        bound[1] = dy * down - whole - end_inside
        bound[3] = dy * down + end_outside
    # A bound moves by a constant fraction. With 40 bits behind the point, the fractions' errors add up to less than the
    # slack; and the slack is less than the least distance of a bound from the next whole number, which is 1 / divisor.
    lines: cython.longlong = n * (bottom - top)
    slack: cython.longlong = 2 * lines + 8
    for edge in range(4):
        # The first sub-pixel at or right of the bound: a ceiling.
        rest: cython.longlong = _floor_div(bound[edge] + divisor[edge] * offset - 1, 512) + divisor[edge]
        whole_part: cython.longlong = _floor_div(rest, divisor[edge])
        whole_step: cython.longlong = _floor_div(step[edge], divisor[edge])
        if (
            (2 * slack * divisor[edge]) >> 40
            or abs(whole_part) > _LARGEST_BOUND
            or abs(whole_part + lines * whole_step) > _LARGEST_BOUND
        ):
            return False
        rest -= whole_part * divisor[edge]
        bound[edge] = (whole_part << 40) + slack + cython.cast(cython.longlong, floor(rest * _UNIT / divisor[edge]))
        rest = step[edge] - whole_step * divisor[edge]
        step[edge] = (whole_step << 40) + cython.cast(cython.longlong, floor(rest * _UNIT / divisor[edge]))

    spans: cython.Py_ssize_t[32]
    if not cython.compiled:
        spans = [0] * 32
    y: cython.longlong
    row: cython.int
    for y in range(top, bottom):
        for row in range(n):
            spans[2 * row] = max(bound[0], bound[1]) >> 40
            spans[2 * row + 1] = min(bound[2], bound[3]) >> 40
            for edge in range(4):
                bound[edge] += step[edge]
        paint(surface, y, spans, n, n)
    return True


@cython.cfunc
def slab_far(
    surface: Surface,
    x1: Any,
    y1: Any,
    x2: Any,
    y2: Any,
    width: Any,
    square: cython.bint,
    n: cython.int,
    corner: cython.bint,
) -> Any:
    """The same rectangle, whatever its size and place: the same inequalities, solved anew for each sub-scanline."""
    if y2 < y1 or (y1 == y2 and x1 < x2):
        x1, y1, x2, y2 = x2, y2, x1, y1
    dx, dy = x2 - x1, y2 - y1
    if not dx and not dy:
        dx = -1
    squared = dx * dx + dy * dy
    inside = isqrt((n * width) ** 2 * squared)
    outside = inside + (inside**2 != (n * width) ** 2 * squared)
    before, behind = (inside, outside) if square else (0, 0)
    whole = 0 if x1 == x2 and y1 == y2 else 2 * n * squared
    middle = 256 * (n if corner else n - 1)
    spans: cython.Py_ssize_t[32]
    if not cython.compiled:
        spans = [0] * 32
    row: cython.int
    for y in range(surface.top, surface.bottom):
        for row in range(n):
            down = 512 * (n * y + row) - middle - 2 * n * y1
            # Sub-pixel g is inside if slope * (512 g - offset) >= low for all of the first and < high for the second.
            a, b = surface.left * n, surface.right * n
            for slope, low, high in (
                (dy, dx * down - inside, dx * down + outside),
                (dx, -dy * down - before, whole + behind - dy * down),
            ):
                if slope < 0:
                    low, high = -whole - before + dy * down, behind + dy * down
                    slope = -slope
                if slope > 0:
                    offset = 2 * n * x1 + middle
                    a = max(a, -((-low - slope * offset) // (512 * slope)))
                    b = min(b, -((-high - slope * offset) // (512 * slope)))
                elif not low <= 0 < high:
                    b = a
            # Either may be beyond what a C integer holds; of an empty span the place does not matter.
            spans[2 * row], spans[2 * row + 1] = (a, b) if a < b else (0, 0)
        paint(surface, y, spans, n, n)
