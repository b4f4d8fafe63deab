"""The one door for coordinates: what is far away is cut here, once, before anything else is computed.

Shapes are drawn in 64-bit arithmetic, which holds all that lies within +-`REACH` pixels. Of what reaches further,
`outline` knows the outline in Python's integers, however large; it is cut to that square here, and is a path or polygon
as any other from then on. Points are x and y in turn, in 256ths of a pixel.
"""

from __future__ import annotations

from itertools import pairwise
from math import isqrt

#: In pixels. Surfaces end at half of this.
REACH = 1 << 17

#: Strokes are as wide as this at most, in 256ths.
WIDEST = 1 << 40

#: The same in 256ths.
LIMIT = 256 * REACH

#: How far beyond a surface something can be that is seen on it, in 256ths: more than a filter's radius.
MARGIN = 1280

_Point = tuple[int, int]


def is_outside(box: tuple[int, int, int, int], margin: int = 0) -> bool:
    """Whether nothing of a box (left, top, right, bottom) and so much around it is in the square."""
    left, top, right, bottom = box
    return min(right, bottom) + margin < -LIMIT or max(left, top) - margin > LIMIT


def pairs(numbers: list[int]) -> list[_Point]:
    """Return points from x and y in turn."""
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def is_flat(numbers: list[int]) -> bool:
    """Whether all points lie on one line."""
    x, y = numbers[:2] or (0, 0)
    offsets = [(a - x, b - y) for a, b in pairs(numbers)]
    dx, dy = next((offset for offset in offsets if offset != (0, 0)), (0, 0))
    return all(a * dy == b * dx for a, b in offsets)


def is_near(numbers: list[int], beyond: int) -> bool:
    """Whether all points lie within the square or up to `beyond` out of it."""
    return max(map(abs, numbers), default=0) <= LIMIT + beyond


def cut_path(numbers: list[int], closed: bool, dashed: bool, beyond: int = 0) -> list[tuple[list[int], int, int]]:
    """Return the pieces of a path that lie within the square or up to `beyond` out of it.

    Each comes with two distances along the path from its start: its length, and its steps along the longer axis of each
    segment. A closed path is cut so that none of its corners is the end of a piece; if dashed, though, it ends where it
    starts.
    """
    limit = LIMIT + beyond
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
        for x, y in (*_crossings(before, corner, LIMIT), corner):
            cut += (min(max(x, -LIMIT), LIMIT), min(max(y, -LIMIT), LIMIT))
    return cut


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
