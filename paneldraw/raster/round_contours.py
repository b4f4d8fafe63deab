# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The contours of discs, ellipses, rounded rectangles and what is cut out of them, to be filled through a filter.

The shapes are those of `paneldraw.raster.rounds`; holes are wound the other way. By the non-zero rule parts of a shape
may overlap, as what is cut out of a hole has been cut out of the disc around it, too.
"""

from __future__ import annotations

from math import isqrt
from typing import Any

import cython

if cython.compiled:
    from cython.cimports.libc.math import ceil, cos, rint, sin, sqrt
    from cython.cimports.paneldraw.raster.strokes import Contours
else:
    from math import ceil, cos, sin, sqrt

    from paneldraw.raster.strokes import Contours

    rint = round

_QUARTER = cython.declare(cython.double, 1.5707963267948966)

#: All points p of the plane, seen from the shape's center, for which ``x * p_y - y * p_x >= -margin``.
HalfPlane = tuple[int, int, int]

#: Left, top, right and bottom.
Box = tuple[int, int, int, int]

Ring = list[tuple[int, int]]


@cython.cfunc
def add_band(
    contours: Contours,
    corners: Any,
    radii: Any,
    half: Any,
    sharp: cython.bint,
    hollow: cython.bint,
    parts: Any,
    sides: Any,
) -> Any:
    """Add the contours of a band of twice the width `half`, or, if not `hollow`, of all within its outer edge.

    The curve goes around the corners of a box with the given radii; with `sharp` it is that box itself. Of the band are
    left the `parts`, each an intersection of half planes; and of all within its outer edge the `sides`, and where there
    are any also a disc of the band's width around the center. Lengths are in the contours' units, within +-2**28, and
    those of the half planes' vectors within 2**30.
    """
    outer = _offset(corners, radii, half, sharp)
    hole = _offset(corners, radii, -half, sharp)
    if not _is_curve(outer):
        return
    hollow = hollow and _is_curve(hole)
    for part in parts:
        _ring(contours, outer, outer)
        _finish(contours, corners, part)
        if hollow:
            _ring(contours, hole, outer)
            contours.reverse()
            _finish(contours, corners, part)
    for side in sides:
        _ring(contours, outer, outer)
        _finish(contours, corners, side)
    if sides:
        disc = (*corners, half, half)
        _ring(contours, disc, disc)
        _finish(contours, corners, [])


def _offset(corners: Box, radii: tuple[int, int], outward: int, sharp: bool) -> tuple[int, ...]:
    """The box and the radii of the curve `outward` of the given one; what cannot shrink the radii shrinks the box."""
    a, b = (0, 0) if sharp else (radii[0] + outward, radii[1] + outward)
    x, y = (outward, outward) if sharp else (min(0, a), min(0, b))
    left, top, right, bottom = corners
    return left - x, top - y, right + x, bottom + y, max(0, a), max(0, b)


def _is_curve(curve: tuple[int, ...]) -> bool:
    """Whether there is anything within, rather than less than nothing."""
    return curve[0] <= curve[2] and curve[1] <= curve[3]


@cython.cfunc
def _finish(contours: Contours, corners: Any, planes: Any) -> Any:
    for x, y, margin in planes:
        contours.cut(corners[0], corners[1], x, y, margin)
    contours.end()


@cython.cfunc
def _ring(contours: Contours, curve: Any, outer: Any) -> Any:
    """Add the points of a curve, clockwise as the screen shows it, such that its chords enclose the area that it does.

    The points are on a slightly larger curve; not so the ends of quarters between which there are straight sides.
    There are as many of them as suit the `outer` curve: between two with unlike chords a thin band would swell.
    """
    left: cython.longlong
    top: cython.longlong
    right: cython.longlong
    bottom: cython.longlong
    a: cython.double
    b: cython.double
    left, top, right, bottom, a, b = curve
    steps: cython.int = 1
    if a > 0 and b > 0:
        steps = cython.cast(cython.int, ceil(_QUARTER / _step(outer[4], outer[5], contours.radius * contours.fineness)))
    quarter: cython.int
    i: cython.int
    step: cython.double = _QUARTER / steps
    between: cython.double = sqrt(step / sin(step))
    outward: cython.double
    round: cython.bint = left == right and top == bottom
    for quarter in range(4):
        for i in range(steps + 1):
            outward = between if round or 0 < i < steps else 1
            x: cython.double = cos(i * step) * outward
            y: cython.double = sin(i * step) * outward
            if quarter & 1:
                x, y = -y, x
            if quarter & 2:
                x, y = -x, -y
            contours.add_whole(
                (right if quarter == 0 or quarter == 3 else left) + cython.cast(cython.longlong, rint(a * x)),
                (bottom if quarter < 2 else top) + cython.cast(cython.longlong, rint(b * y)),
            )


@cython.cfunc
def _step(a: cython.double, b: cython.double, radius: cython.double) -> cython.double:
    """The angle of chords such that a filter evens them out: it may be the further from the curve, the shorter it is.

    Where an ellipse is flat chords are long, and min(a, b) * step**2 / 8 from it; at its ends they are short, and
    max(a, b) * step**2 / 8.
    """
    flat: cython.double = min(a, b)
    deviation: cython.double = radius * min(max(0.25 * radius / flat, 0.0075), 0.0125)
    return min(1.0, sqrt(8 * min(deviation / flat, 0.025 * radius / max(a, b))))


# -- The same of any size and place, in Python's integers: what is in sight is followed closely, what is far out is left
# out


def add_band_far(
    contours: Contours,
    sight: Box,
    corners: Box,
    radii: tuple[int, int],
    half: int,
    sharp: bool,
    hollow: bool,
    parts: list[list[HalfPlane]],
    sides: list[list[HalfPlane]],
) -> None:
    """As `add_band`, within the box `sight`."""
    x, y = corners[:2]
    limits = [(0, -1, x - sight[0]), (0, 1, sight[2] - x), (1, 0, y - sight[1]), (-1, 0, sight[3] - y)]
    outer = _offset(corners, radii, half, sharp)
    hole = _offset(corners, radii, -half, sharp)
    if not _is_curve(outer):
        return
    ring = _ring_far(outer, sight)
    inner = _ring_far(hole, sight)[::-1] if hollow and _is_curve(hole) else []
    for part in parts:
        _add_far(contours, ring, x, y, limits + part)
        _add_far(contours, inner, x, y, limits + part)
    for side in sides:
        _add_far(contours, ring, x, y, limits + side)
    if sides:
        _add_far(contours, _ring_far((*corners, half, half), sight), x, y, limits)


def _ring_far(curve: tuple[int, ...], sight: Box) -> Ring:
    left, top, right, bottom, a, b = curve
    ring: Ring = []
    for cx, cy, sx, sy in ((right, bottom, 1, 1), (left, bottom, -1, 1), (left, top, -1, -1), (right, top, 1, -1)):
        xs = sorted((sx * (sight[0] - cx), sx * (sight[2] - cx)))
        ys = sorted((sy * (sight[1] - cy), sy * (sight[3] - cy)))
        quarter = [(cx + sx * x, cy + sy * y) for x, y in [(a, 0), *_arc(a, b, (a, 0), (0, b), xs, ys)]]
        ring += quarter if sx == sy else quarter[::-1]
    return ring


def _arc(a: int, b: int, start: tuple[int, int], end: tuple[int, int], xs: list[int], ys: list[int]) -> Ring:
    """Points of a quarter of an ellipse after `start`: all within a unit of it where it passes xs and ys."""
    (x1, y1), (x2, y2) = start, end
    dx, dy = x2 - x1, y2 - y1
    if x1 < xs[0] or x2 > xs[1] or y2 < ys[0] or y1 > ys[1] or -dx < 2 or dy < 2:
        return [end]
    if -dx > dy:
        x = (x1 + x2) // 2
        y = isqrt(b * b * (a * a - x * x) // (a * a))
    else:
        y = (y1 + y2) // 2
        x = isqrt(a * a * (b * b - y * y) // (b * b))
    if ((x - x1) * dy - (y - y1) * dx) ** 2 <= dx * dx + dy * dy:
        return [end]
    return _arc(a, b, start, (x, y), xs, ys) + _arc(a, b, (x, y), end, xs, ys)


def _add_far(contours: Contours, ring: Ring, x: int, y: int, planes: list[HalfPlane]) -> None:
    """Add what of a ring lies in all half planes."""
    seen = [(px - x, py - y) for px, py in ring]
    for plane in planes:
        seen = _cut_far(seen, plane)
    for px, py in seen:
        contours.add_whole(px + x, py + y)
    contours.end()


def _cut_far(ring: Ring, plane: HalfPlane) -> Ring:
    """As `Contours.cut`."""
    vx, vy, margin = plane
    cut: Ring = []
    depths = [vx * y - vy * x + margin for x, y in ring]
    for i in range(len(ring)):
        (x1, y1), before = (ring[i - 1], depths[i - 1]) if i else (ring[len(ring) - 1], depths[len(ring) - 1])
        (x2, y2), depth = ring[i], depths[i]
        if (before < 0) != (depth < 0):
            part, whole = 2 * abs(before), abs(before) + abs(depth)
            x, y = x2 - x1, y2 - y1
            cut.append((x1 + (x * part + whole) // (2 * whole), y1 + (y * part + whole) // (2 * whole)))
        if depth >= 0:
            cut.append((x2, y2))
    return cut
