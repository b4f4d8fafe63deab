"""Paths and polygons that reach far beyond any surface, cut to what 64-bit arithmetic holds.

Points are x and y in turn, whole numbers of any size, in 256ths of a pixel. New points on the cut are rounded to whole
256ths, so that an edge may lie up to a 512th of a pixel from where it was.
"""

from __future__ import annotations

from itertools import pairwise

# Surfaces end at 2**16 pixels; strokes may be as wide as that again.
_LIMIT = 1 << 25

_Point = tuple[int, int]


def pairs(numbers: list[int]) -> list[_Point]:
    """Return points from x and y in turn."""
    return list(zip(numbers[::2], numbers[1::2], strict=True))


def cut_path(numbers: list[int], closed: bool) -> list[list[int]]:
    """Return the pieces of a path that lie within the limits."""
    points = pairs(numbers)
    if len(points) == 1 or (closed and len(points) > 2):
        points.append(points[0])
    pieces: list[list[int]] = []
    for start, end in pairwise(points):
        part = _cut_segment(start, end)
        if part is None:
            continue
        a, b = part
        if pieces and tuple(pieces[-1][-2:]) == a == start:
            pieces[-1] += b
        else:
            pieces.append([*a, *b])
    return pieces


def _cut_segment(a: _Point, b: _Point) -> tuple[_Point, _Point] | None:
    for axis in (0, 1):
        for side in (-1, 1):
            a_out, b_out = side * a[axis] > _LIMIT, side * b[axis] > _LIMIT
            if a_out and b_out:
                return None
            if a_out:
                a = _crossing(a, b, axis, side * _LIMIT)
            elif b_out:
                b = _crossing(a, b, axis, side * _LIMIT)
    return a, b


def cut_polygon(numbers: list[int]) -> list[int]:
    """Return the polygon within the limits; it winds around every point there as often as the whole one.

    Notes
    -----
    I. E. Sutherland and G. W. Hodgman, "Reentrant polygon clipping", CACM 17 (1974), 32-42.
    """
    corners = pairs(numbers)
    for axis in (0, 1):
        for side in (-1, 1):
            kept: list[_Point] = []
            for before, corner in zip(corners[-1:] + corners[:-1], corners, strict=True):
                was_out, out = side * before[axis] > _LIMIT, side * corner[axis] > _LIMIT
                if out != was_out:
                    kept.append(_crossing(before, corner, axis, side * _LIMIT))
                if not out:
                    kept.append(corner)
            corners = kept
    return [number for corner in corners for number in corner]


def _crossing(a: _Point, b: _Point, axis: int, at: int) -> _Point:
    """Where the line from a to b crosses a limit, to the nearest point; the same in either direction."""
    a, b = sorted((a, b), key=lambda point: point[axis])
    along, across = b[axis] - a[axis], b[1 - axis] - a[1 - axis]
    other = a[1 - axis] + (2 * (at - a[axis]) * across + along) // (2 * along)
    return (at, other) if axis == 0 else (other, at)
