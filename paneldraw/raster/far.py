"""Paths and polygons that reach far beyond any surface, cut to what 64-bit arithmetic holds.

Points are x and y in turn, whole numbers of any size, in 256ths of a pixel. Points where a line is cut are rounded to
whole 256ths, so that an edge may lie up to a 512th of a pixel from where it was.
"""

from __future__ import annotations

from itertools import pairwise
from math import isqrt

# Surfaces end at 2**16 pixels; strokes may be as wide as that again.
_LIMIT = 1 << 25

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


def cut_path(numbers: list[int], closed: bool, dashed: bool) -> list[tuple[list[int], int]]:
    """Return the pieces of a path that lie within the limits, each with its distance along the path from the start.

    A closed path is cut so that none of its corners is the end of a piece; if dashed, though, it ends where it starts.
    """
    points = pairs(numbers)
    if closed and len(points) > 2:
        far = 0 if dashed else next(i for i, point in enumerate(points) if not _is_near(point))
        points = [*points[far:], *points[: far + 1]]
    pieces: list[tuple[list[int], int]] = []
    passed = 0
    for start, end in pairwise(points):
        near = [point for point in (start, *_crossings(start, end), end) if _is_near(point)]
        if len(near) > 1:
            a, b = near[0], near[-1]
            if pieces and tuple(pieces[-1][0][-2:]) == a == start:
                pieces[-1][0].extend(b)
            else:
                pieces.append(([*a, *b], passed + _distance(start, a)))
        passed += _distance(start, end)
    return pieces


def cut_polygon(numbers: list[int]) -> list[int]:
    """Return the polygon with what is beyond the limits drawn in onto them.

    It winds around every point within them as often as the whole one.
    """
    corners = pairs(numbers)
    cut: list[int] = []
    for before, corner in zip(corners[-1:] + corners[:-1], corners, strict=True):
        for x, y in (*_crossings(before, corner), corner):
            cut += (min(max(x, -_LIMIT), _LIMIT), min(max(y, -_LIMIT), _LIMIT))
    return cut


def _is_near(point: _Point) -> bool:
    return max(map(abs, point)) <= _LIMIT


def _distance(a: _Point, b: _Point) -> int:
    return (isqrt(4 * ((b[0] - a[0]) ** 2 + (b[1] - a[1]) ** 2)) + 1) // 2


def _crossings(a: _Point, b: _Point) -> list[_Point]:
    """Where the line from a to b crosses the limits, in the order in which it does."""
    found = [
        _crossing(a, b, axis, at)
        for axis in (0, 1)
        for at in (-_LIMIT, _LIMIT)
        if min(a[axis], b[axis]) < at < max(a[axis], b[axis])
    ]
    return sorted(found, key=lambda point: abs(point[0] - a[0]) + abs(point[1] - a[1]))


def _crossing(a: _Point, b: _Point, axis: int, at: int) -> _Point:
    """Where the line from a to b crosses a limit, to the nearest point; the same in either direction."""
    a, b = sorted((a, b), key=lambda point: point[axis])
    along, across = b[axis] - a[axis], b[1 - axis] - a[1 - axis]
    other = a[1 - axis] + (2 * (at - a[axis]) * across + along) // (2 * along)
    return (at, other) if axis == 0 else (other, at)
