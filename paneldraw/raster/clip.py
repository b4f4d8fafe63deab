"""The one door for coordinates: what is far away is cut here, once, before anything else is computed.

Shapes are drawn in 64-bit arithmetic, which holds all that lies within +-`REACH` pixels. Of what reaches further, the
outline is found here in Python's integers, however large, and cut to that square; from then on it is a path or polygon
as any other. Points are x and y in turn, in 256ths of a pixel. Where an outline is cut or a curve is followed by
chords, it may be off by half a pixel.
"""

from __future__ import annotations

from itertools import pairwise
from math import isqrt

#: In pixels. Surfaces end at half of this.
REACH = 1 << 17

#: Strokes are as wide as this at most, in 256ths.
WIDEST = 1 << 40

_LIMIT = 256 * REACH

# How far a curve may be from its chords, in 256ths.
_FLAT = 64

_Point = tuple[int, int]


def pairs(numbers: list[int]) -> list[_Point]:
    """Return points from x and y in turn."""
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def is_flat(numbers: list[int]) -> bool:
    """Whether all points lie on one line."""
    x, y = numbers[:2] or (0, 0)
    offsets = [(a - x, b - y) for a, b in pairs(numbers)]
    dx, dy = next((offset for offset in offsets if offset != (0, 0)), (0, 0))
    return all(a * dy == b * dx for a, b in offsets)


def cut_path(numbers: list[int], closed: bool, dashed: bool, beyond: int = 0) -> list[tuple[list[int], int, int]]:
    """Return the pieces of a path that lie within the square or up to `beyond` out of it.

    Each comes with two distances along the path from its start: its length, and its steps along the longer axis of each
    segment. A closed path is cut so that none of its corners is the end of a piece; if dashed, though, it ends where it
    starts.
    """
    limit = _LIMIT + beyond
    points = pairs(numbers)
    if closed and len(points) > 2:
        far = 0 if dashed else next((i for i, point in enumerate(points) if not _is_near(point, limit)), 0)
        points = [*points[far:], *points[: far + 1]]
    if len(points) == 1:
        points *= 2
    pieces: list[tuple[list[int], int, int]] = []
    passed = steps = 0
    for start, end in pairwise(points):
        near = [point for point in (start, *_crossings(start, end, limit), end) if _is_near(point, limit)]
        if len(near) > 1:
            a, b = near[0], near[-1]
            if pieces and tuple(pieces[-1][0][-2:]) == a == start:
                pieces[-1][0].extend(b)
            else:
                pieces.append(([*a, *b], passed + _distance(start, a), steps + _steps(start, a)))
        passed += _distance(start, end)
        steps += _steps(start, end)
    return pieces


def cut_polygon(numbers: list[int]) -> list[int]:
    """Return the polygon with what is beyond the square drawn in onto its sides.

    It winds around every point within the square as often as the whole one.
    """
    corners = pairs(numbers)
    cut: list[int] = []
    for before, corner in zip(corners[-1:] + corners[:-1], corners, strict=True):
        for x, y in (*_crossings(before, corner, _LIMIT), corner):
            cut += (min(max(x, -_LIMIT), _LIMIT), min(max(y, -_LIMIT), _LIMIT))
    return cut


def thick_line(x1: int, y1: int, x2: int, y2: int, width: int, square: bool) -> list[int]:
    """Return the corners of the rectangle around a line, as `paneldraw.raster.thick_line` has it."""
    dx, dy = (x2 - x1, y2 - y1) if (x1, y1) != (x2, y2) else (256, 0)
    length = isqrt((dx * dx + dy * dy) << 64)
    # Half a width in the line's direction, to the nearest whole numbers.
    ux, uy = (((2 * side * width << 31) + length) // (2 * length) for side in (dx, dy))
    if square:
        x1, y1, x2, y2 = x1 - ux, y1 - uy, x2 + ux, y2 + uy
    return [x1 - uy, y1 + ux, x1 + uy, y1 - ux, x2 + uy, y2 - ux, x2 - uy, y2 + ux]


def rounded_box(left: int, top: int, right: int, bottom: int, a: int, b: int) -> list[int]:
    """Return the outline of a box with quarters of an ellipse around its corners: a circle's box is its center."""
    turns = [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 0)]
    centers = [(right, bottom), (left, bottom), (left, top), (right, top)]
    outline: list[int] = []
    for (x, y), (start, end) in zip(centers, pairwise(turns), strict=True):
        outline += arc(x, y, a, b, start, end)
    return outline


def arc(x: int, y: int, a: int, b: int, start: _Point, end: _Point) -> list[int]:
    """Return points along an ellipse clockwise from the direction of one vector to that of another.

    The two are less than half a turn apart. An arc is halved until it is flat or cannot be seen.
    """
    unit = 1 << (max(a, b).bit_length() + 16)
    first, last = _unit_vector(start, unit), _unit_vector(end, unit)

    def place(vector: _Point) -> _Point:
        return x + a * vector[0] // unit, y + b * vector[1] // unit

    points = [*place(first)]
    open_arcs = [(first, last)]
    while open_arcs:
        u, v = open_arcs.pop()
        middle = _unit_vector((u[0] + v[0], u[1] + v[1]), unit)
        p, q, m = place(u), place(v), place(middle)
        rise = (abs(2 * m[0] - p[0] - q[0]) + abs(2 * m[1] - p[1] - q[1])) // 2
        outside = any(
            min(p[axis], q[axis]) - 2 * rise > _LIMIT or max(p[axis], q[axis]) + 2 * rise < -_LIMIT for axis in (0, 1)
        )
        if rise <= _FLAT or outside:
            points += q
        else:
            open_arcs += [(middle, v), (u, middle)]
    return points


def _unit_vector(vector: _Point, unit: int) -> _Point:
    length = isqrt((vector[0] ** 2 + vector[1] ** 2) << 64)
    return (vector[0] * unit << 32) // length, (vector[1] * unit << 32) // length


def _is_near(point: _Point, limit: int) -> bool:
    return max(map(abs, point)) <= limit


def _distance(a: _Point, b: _Point) -> int:
    return (isqrt(4 * ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2)) + 1) // 2


def _steps(a: _Point, b: _Point) -> int:
    return max(abs(b[0] - a[0]), abs(b[1] - a[1]))


def _crossings(a: _Point, b: _Point, limit: int) -> list[_Point]:
    """Where the line from a to b crosses the square's sides or what continues them, in the order in which it does."""
    found = [
        _crossing(a, b, axis, at)
        for axis in (0, 1)
        for at in (-limit, limit)
        if min(a[axis], b[axis]) < at < max(a[axis], b[axis])
    ]
    return sorted(found, key=lambda point: abs(point[0] - a[0]) + abs(point[1] - a[1]))


def _crossing(a: _Point, b: _Point, axis: int, at: int) -> _Point:
    """Where the line from a to b crosses one, to the nearest point; the same in either direction."""
    a, b = sorted((a, b), key=lambda point: point[axis])
    along, across = b[axis] - a[axis], b[1 - axis] - a[1 - axis]
    other = a[1 - axis] + (2 * (at - a[axis]) * across + along) // (2 * along)
    return (at, other) if axis == 0 else (other, at)
