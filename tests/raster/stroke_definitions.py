"""What polygons and strokes are, reference point by reference point; and what the raster counted, to compare with it.

Points are pairs of numbers in pixels, whole ones or of 256ths. A figure's counts are an array of shape (height, width).
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import hypot

import definitions
import numpy as np
from definitions import nearest, reference_points

WIDTH, HEIGHT = 13, 9

# Corners of strokes are rounded to 256ths, which moves edges by 0.71 of these at most; arcs are polygons besides.
ROUNDING = 1 / 256


def counted(package, draw, n, reference="center", size=(WIDTH, HEIGHT)):
    """How many reference points of each pixel are in what ``draw(fb, level, antialias)`` draws once."""
    fb = package.Framebuffer(*size, depth=8)
    # With a level of n * n the levels are the counts; of 256 points one level is lost, that of the last.
    draw(fb, min(n * n, 255), package.Supersample(n, reference))
    return fb.pixels.astype(int)


def as_counted(counts, n):
    return (counts * 510 + 256) // 512 if n == 16 else counts


def per_pixel(inside, n):
    """Sums over the n x n sub-pixels of each pixel."""
    height, width = inside.shape
    return inside.reshape(height // n, n, width // n, n).sum(axis=(1, 3))


# -- Polygons, in whole numbers: 512 n of them are a pixel


def polygon(corners, rule, n=1, reference="center", size=(WIDTH, HEIGHT)):
    return definitions.polygon(*size, corners, rule, n, reference)


def far_polygon(corners, rule, n, reference, size=(WIDTH, HEIGHT)):
    """The least and the largest counts of a polygon whose edges may lie up to a 512th of a pixel off."""
    xs, ys = lattice(n, reference, size)
    winding = np.zeros((size[1] * n, size[0] * n), int)
    near = np.zeros_like(winding, bool)
    points = [(nearest(Fraction(x) * 256) * 2 * n, nearest(Fraction(y) * 256) * 2 * n) for x, y in corners]
    for (x1, y1), (x2, y2) in zip(points[-1:] + points[:-1], points, strict=True):
        dx, dy = x2 - x1, y2 - y1
        beside = (xs - x1) * dy - (ys - y1) * dx
        near |= beside**2 <= n * n * (dx * dx + dy * dy)
        winding += ((y1 <= ys) & (ys < y2) & (beside >= 0)).astype(int)
        winding -= ((y2 <= ys) & (ys < y1) & (beside <= 0)).astype(int)
    inside = winding != 0 if rule == "nonzero" else winding % 2 == 1
    return per_pixel(inside & ~near, n), per_pixel(inside | near, n)


def lattice(n, reference, size):
    return reference_points(size[0], n, reference)[None, :], reference_points(size[1], n, reference)[:, None]


# -- Strokes, in floating point: a union of convex pieces, each a list of half planes (a, b, c) where a x + b y <= c,
# and perhaps a disc (x, y, r)


def stroke_bounds(pieces, n, reference, size=(WIDTH, HEIGHT), tolerance=ROUNDING):
    """The least and the largest counts of a union of pieces whose boundary may lie up to `tolerance` off."""
    xs, ys = (axis.astype(float) / (512 * n) for axis in lattice(n, reference, size))
    surely = np.ones((size[1] * n, size[0] * n), bool)
    perhaps = np.zeros_like(surely)
    ring = [(np.cos(turn), np.sin(turn)) for turn in np.arange(12) * (np.pi / 6)]
    for dx, dy in [(0, 0), *ring]:
        inside = _in_union(pieces, xs + 1.05 * tolerance * dx, ys + 1.05 * tolerance * dy)
        surely &= inside
        perhaps |= inside
    return per_pixel(surely, n), per_pixel(perhaps, n)


def union(pieces):
    """The points in any of the pieces, as a function of their coordinates."""
    return lambda xs, ys: _in_union(pieces, xs, ys)


def _in_union(pieces, xs, ys):
    inside = np.zeros(np.broadcast_shapes(xs.shape, ys.shape), bool)
    for half_planes, disc in pieces:
        here = np.ones_like(inside)
        for a, b, c in half_planes:
            here &= a * xs + b * ys <= c + 1e-7
        if disc:
            x, y, r = disc
            here &= (xs - x) ** 2 + (ys - y) ** 2 <= (r + 1e-7) ** 2
        inside |= here
    return inside


def stroke(points, width, join="miter", cap="square", closed=False, end_cap=None):
    """The pieces of the stroke along points: a rectangle for each segment, a wedge for each corner, and the caps."""
    half = width / 2
    points = [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]
    if closed and points[0] == points[-1]:
        points = points[:-1] or points
    closed = closed and len(points) > 2
    if len(points) == 1:
        directions = [(1.0, 0.0)]
        pieces = []
    else:
        ends = points[1:] + (points[:1] if closed else [])
        directions = [_unit(a, b) for a, b in zip(points, ends, strict=False)]
        pieces = [_rectangle(a, b, half) for a, b in zip(points, ends, strict=False)]
        corners = list(zip(points[1:], directions, directions[1:], strict=False))
        if closed:
            corners.append((points[0], directions[-1], directions[0]))
        pieces += [piece for corner in corners for piece in _corner(*corner, half, join)]
    if not closed:
        (ux, uy), u = directions[0], directions[-1]
        pieces += _cap(points[0], (-ux, -uy), half, cap) + _cap(points[-1], u, half, end_cap or cap)
    return pieces


def _unit(a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    return dx / hypot(dx, dy), dy / hypot(dx, dy)


def _below(point, direction):
    """The half plane of what is not further in a direction than a point."""
    (x, y), (a, b) = point, direction
    return a, b, a * x + b * y


def _rectangle(a, b, half):
    u = _unit(a, b)
    return [*_band(a, u, half), _below(b, u), _below(a, (-u[0], -u[1]))], None


def _band(point, u, half):
    """What is within `half` of the line through a point."""
    (x, y), (ux, uy) = point, u
    return [_below((x - uy * half, y + ux * half), (-uy, ux)), _below((x + uy * half, y - ux * half), (uy, -ux))]


def _cap(point, u, half, cap):
    if cap == "butt":
        return []
    beyond = _below(point, (-u[0], -u[1]))
    if cap == "round":
        return [([beyond], (*point, half))]
    x, y = point
    return [([*_band(point, u, half), beyond, _below((x + u[0] * half, y + u[1] * half), u)], None)]


def _corner(point, v, u, half, join):
    """The wedge between the end of the rectangle along v and the start of the one along u."""
    cross, dot = v[0] * u[1] - v[1] * u[0], v[0] * u[0] + v[1] * u[1]
    if abs(cross) < 1e-9 and dot > 0:
        return []
    wedge = [_below(point, (-v[0], -v[1])), _below(point, u)]
    if join == "round":
        return [(wedge, (*point, half))]
    if join == "miter" and 1 / ((1 + dot) / 2 + 1e-12) <= 16:
        return [([*wedge, *_band(point, v, half), *_band(point, u, half)], None)]
    if abs(cross) < 1e-9:
        return []
    side = half if cross > 0 else -half
    a = (point[0] + v[1] * side, point[1] - v[0] * side)
    b = (point[0] + u[1] * side, point[1] - u[0] * side)
    along = _unit(a, b)
    normal = (along[1], -along[0]) if cross > 0 else (-along[1], along[0])
    return [([*wedge, _below(a, normal)], None)]


def dashed_stroke(points, width, dash, join="miter", cap="square", closed=False):
    """The strokes along those parts of a path that a pattern shows.

    A round cap ends every dash, a square one the path, beyond the pattern. A closed path has no ends: a dash that leads
    back to the start goes on into the first one. A first dash as long as the path does nothing to it.

    Returns the pieces, and how near a dash's end comes to a corner at the least.
    """
    points = [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]
    inner = "round" if cap == "round" else "butt"
    closed = closed and len(points) > 2
    if closed:
        points += points[:1] if points[0] != points[-1] else []
        cap = inner
    lengths = [hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(points)]
    stops = [sum(lengths[:i]) for i in range(len(points))]
    if dash[0] >= stops[-1]:
        return stroke(points, width, join, cap, closed), dash[0] - stops[-1]
    pattern = list(dash) if len(dash) % 2 == 0 else [*dash, *dash]
    pieces, nearest_end, start, i = [], np.inf, 0.0, 0
    if closed and _is_shown(stops[-1], pattern):
        pieces += _corner(points[0], _unit(*points[-2:]), _unit(*points[:2]), width / 2, join)
        cap = "butt"
    while start < stops[-1]:
        end = start + pattern[i % len(pattern)]
        nearest_end = min([nearest_end, *(abs(end - stop) for stop in stops)])
        if i % 2 == 0:
            last = min(end, stops[-1])
            corners = [point for point, stop in zip(points, stops, strict=True) if start < stop < last]
            part = [_at(points, stops, start), *corners, _at(points, stops, last)]
            caps = [cap if at else inner for at in (start == 0, end >= stops[-1])]
            pieces += stroke(part, width, join, caps[0], False, caps[1])
        start, i = end, i + 1
    return pieces, nearest_end


def _is_shown(length, pattern):
    """Whether a dash, not a gap, leads to this length."""
    rest = length % sum(pattern)
    return any(sum(pattern[:i]) < rest <= sum(pattern[: i + 1]) for i in range(0, len(pattern), 2))


def _at(points, stops, length):
    """The point of a path at a length from its start."""
    k = max(i for i in range(len(points) - 1) if stops[i] <= length)
    (x, y), (ux, uy) = points[k], _unit(points[k], points[k + 1])
    return x + ux * (length - stops[k]), y + uy * (length - stops[k])
