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
    from cython.cimports.libc.math import sqrt
    from cython.cimports.paneldraw.raster._floors import floored
    from cython.cimports.paneldraw.raster.supersample import counts_before, paint
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from math import sqrt

    from paneldraw.raster._floors import floored
    from paneldraw.raster.supersample import counts_before, paint
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
    t: cython.ulonglong = floored(a * sqrt(b))
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
    _row: cython.longlong
    for y in range(_floor_div(first, n), _floor_div(last - 1, n) + 1):
        count = 0
        for _row in range(max(first, y * n), min(last, y * n + n)):
            spans[2 * count] = a
            spans[2 * count + 1] = b
            count += 1
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
    v / length and along it u / length, with v = dx Y - dy X and u = dx X + dy Y. Each of the two sides and the two ends
    bounds the points of a sub-scanline from the left or from the right. Returns False, with nothing painted, where the
    bounds are too far away or too fine for exact arithmetic in 64 bits.
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
    length: cython.double = sqrt(squared)
    over: cython.double = width * (abs(dx) + (dy if square else 0)) / (512.0 * length)
    top: cython.longlong = max(surface.top, floored(y1 / 256.0 - over + 0.49))
    bottom: cython.longlong = min(surface.bottom, floored((y1 + dy) / 256.0 + over + 0.51) + 1)
    if top >= bottom:
        return True

    # Where sides and ends bound the first sub-scanline from the left and from the right, and by how much they move.
    middle: cython.longlong = 256 * (n if corner else n - 1)
    down: cython.longlong = 512 * n * top - middle - 2 * n * y1
    offset: cython.longlong = 2 * n * x1 + middle
    run: cython.longlong = abs(dx)
    side_step: cython.double = dx / cython.cast(cython.double, dy)
    end_step: cython.double = -dy / cython.cast(cython.double, dx)
    lines: cython.longlong = n * (bottom - top)
    left: cython.double = _bound(dx * down - inside, dy, offset)
    right: cython.double = _bound(dx * down + outside, dy, offset)
    back: cython.double
    front: cython.double
    if dx > 0:
        back = _bound(-dy * down - end_inside, run, offset)
        front = _bound(-dy * down + whole + end_outside, run, offset)
    else:
        back = _bound(dy * down - whole - end_inside, run, offset)
        front = _bound(dy * down + end_outside, run, offset)
    # A bound is a fraction. Its distance below the next whole number is a multiple of 1 / divisor: a slack that is more
    # than all errors of rounding and less than half of that leaves its whole part exact.
    slack: cython.longlong = lines + 4096
    if (
        (2 * slack * max(dy, run)) >> 40
        or max(abs(left), abs(right), abs(left + lines * side_step), abs(right + lines * side_step)) > _LARGEST_BOUND
        or max(abs(back), abs(front), abs(back + lines * end_step), abs(front + lines * end_step)) > _LARGEST_BOUND
    ):
        return False
    _sweep(
        surface,
        top,
        bottom,
        _fixed(left) + slack,
        _fixed(right) + slack,
        _fixed(back) + slack,
        _fixed(front) + slack,
        _fixed(side_step),
        _fixed(end_step),
        n,
    )
    return True


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _bound(edge: cython.longlong, divisor: cython.longlong, offset: cython.longlong) -> cython.double:
    """A number whose floor is the first sub-pixel at or right of an edge, up to errors of rounding."""
    return (((edge + divisor * offset - 1) >> 9) + divisor) / cython.cast(cython.double, divisor)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _fixed(number: cython.double) -> cython.longlong:
    """A number of sub-pixels with 40 bits behind the point, the rest cut off."""
    return cython.cast(cython.longlong, number * _UNIT) if cython.compiled else int(number * _UNIT)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _sweep(
    surface: Surface,
    top: cython.longlong,
    bottom: cython.longlong,
    left: cython.longlong,
    right: cython.longlong,
    back: cython.longlong,
    front: cython.longlong,
    side_step: cython.longlong,
    end_step: cython.longlong,
    n: cython.int,
) -> cython.void:
    """Count and paint the rows, given the bounds of their first sub-scanline, those of the sides and of the ends."""
    spans: cython.Py_ssize_t[32]
    if not cython.compiled:
        spans = [0] * 32
    one: cython.longlong = 1
    low: cython.longlong = (surface.left * n) * (one << 40)
    high: cython.longlong = (surface.right * n + 1) * (one << 40)
    # From the first sub-scanline of a row to the last one.
    side_turn: cython.longlong = (n - 1) * side_step
    turn: cython.longlong = side_turn - (n - 1) * end_step
    before: cython.p_ulonglong = counts_before(n)
    inverse: cython.longlong = (one << 32) // n + 1
    surface.count_in(n, n * n)
    y: cython.longlong
    row: cython.int
    _: cython.int
    x: cython.longlong
    first: cython.longlong
    last: cython.longlong
    counts: cython.ulonglong
    for y in range(top, bottom):
        first = left + min(0, side_turn)
        last = right + max(0, side_turn)
        x = ((first >> 40) * inverse) >> 32
        # Most rows are cut by the sides alone, visible, and no wider than the pixels that are counted at once.
        if (
            first >= low
            and last < high
            and (last >> 40) - x * n <= 8 * n <= 120
            and left - back >= max(0, -turn)
            and front - right >= max(0, turn)
        ):
            counts = 0
            for _ in range(n):
                counts += before[(right >> 40) - x * n] - before[(left >> 40) - x * n]
                left += side_step
                right += side_step
            surface.blend_eight(y, x, counts)
            back += n * end_step
            front += n * end_step
        else:
            for row in range(n):
                spans[2 * row] = max(left, back) >> 40
                spans[2 * row + 1] = min(right, front) >> 40
                left += side_step
                right += side_step
                back += end_step
                front += end_step
            paint(surface, y, spans, n, n)


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
    # u and v of the window's corners: a window that lies all on one side of the rectangle shows nothing of it.
    columns = [512 * n * x - middle - 2 * n * x1 for x in (surface.left, surface.right)]
    heights = [512 * n * y - middle - 2 * n * y1 for y in (surface.top, surface.bottom)]
    along = [dx * column + dy * height for column in columns for height in heights]
    across = [dy * column - dx * height for column in columns for height in heights]
    if min(along) > whole + behind or max(along) < -before or min(across) > outside or max(across) < -outside:
        return
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
