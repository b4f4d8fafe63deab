"""Outlines of shapes of any size, in Python's integers, for what reaches further than `clip` lets through.

A contour is a list of x and y in turn, in 256ths of a pixel; a shape is one or more of them, filled by the non-zero
rule. Curves are chords that are within a sixteenth of a pixel of them, where they can be seen.
"""

from __future__ import annotations

from itertools import groupby, pairwise
from math import isqrt
from typing import NamedTuple

from paneldraw.raster.clip import is_outside, pairs

# How far a curve may be from its chords, in 256ths.
_FLAT = 16

_HALF_PIXEL = 128

# The bits of a fraction with which pieces of curves are halved.
_FINE = 16

# A quarter turn clockwise, from quadrant to quadrant, and the bit that each has in a choice of them.
_AXES = ((1, 0), (0, 1), (-1, 0), (0, -1), (1, 0))
_BITS = (8, 4, 2, 1)

Contour = list[int]
Box = tuple[int, int, int, int]
Vector = tuple[int, int]


def thick_line(x1: int, y1: int, x2: int, y2: int, width: int, square: bool) -> Contour:
    """Return the corners of the rectangle around a line, as `paneldraw.raster.thick_line` has it."""
    dx, dy = (x2 - x1, y2 - y1) if (x1, y1) != (x2, y2) else (256, 0)
    length = isqrt((dx * dx + dy * dy) << 64)
    # Half a width in the line's direction, to the nearest whole numbers.
    ux, uy = (((2 * side * width << 31) + length) // (2 * length) for side in (dx, dy))
    if square:
        x1, y1, x2, y2 = x1 - ux, y1 - uy, x2 + ux, y2 + uy
    return [x1 - uy, y1 + ux, x1 + uy, y1 - ux, x2 + uy, y2 - ux, x2 - uy, y2 + ux]


def heads(points: Contour, length: int, width: int, pointed: tuple[bool, bool]) -> tuple[list[Contour], Contour]:
    """Return heads at the start and at the end of a path, triangles as broad as long, and the path that is left.

    A head's base has its middle where the path was `length` away from the tip for the last time; of a path that never
    was, all of it is in the head. The path goes on into the head by half its `width`, or as far as that is as wide.
    """
    path = [point for point, _ in groupby(pairs(points))]
    inside = min(width // 2, max(length - width, 0))
    shapes = []
    begin, end = _Base(path[0], 0, path[0]), _Base(path[-1], len(path), path[-1])
    if pointed[0]:
        mirrored = _base(path[::-1], length, inside, 256)
        begin = mirrored._replace(left=len(path) - mirrored.left)
        shapes.append(_head(path[0], begin.middle))
    if pointed[1]:
        end = _base(path, length, inside, -256)
        shapes.append(_head(path[-1], end.middle))
    if begin.left > end.left or (begin.left == end.left and not _is_before(begin.middle, end.middle, path, begin.left)):
        return shapes, []
    rest = [begin.inner, begin.middle, *path[begin.left : end.left], end.middle, end.inner]
    return shapes, [number for point, _ in groupby(rest) for number in point]


class _Base(NamedTuple):
    """A head's base: its middle, how many points of the path lie before it, and where the path ends in the head."""

    middle: Vector
    left: int
    inner: Vector


def _base(path: list[Vector], length: int, inside: int, back: int) -> _Base:
    """The base of the head at the end of a path; of one that goes nowhere, `back` in its row."""
    x, y = path[-1]
    for i in range(len(path) - 2, -1, -1):
        (ax, ay), (bx, by) = path[i], path[i + 1]
        if (ax - x) ** 2 + (ay - y) ** 2 >= length * length:
            # From b, which is nearer, so far toward a that it is `length` from the tip.
            dx, dy, px, py = ax - bx, ay - by, bx - x, by - y
            along, whole = px * dx + py * dy, dx * dx + dy * dy
            share = isqrt((along * along + whole * (length * length - px * px - py * py)) << 64) - (along << 32)
            middle = _nearest(bx, by, dx, dy, share, whole << 32)
            return _Base(middle, i + 1, _nearest(*middle, x - middle[0], y - middle[1], inside, max(length, 1)))
    dx, dy = (path[0][0] - x, path[0][1] - y) if path[0] != path[-1] else (back, 0)
    return _Base(_nearest(x, y, dx, dy, length << 32, isqrt((dx * dx + dy * dy) << 64)), 0, (x, y))


def _nearest(x: int, y: int, dx: int, dy: int, share: int, whole: int) -> Vector:
    """The point at a share of the way (dx, dy) from (x, y)."""
    return x + (2 * dx * share + whole) // (2 * whole), y + (2 * dy * share + whole) // (2 * whole)


def _head(tip: Vector, middle: Vector) -> Contour:
    """The triangle with a tip and the middle of its base."""
    (x, y), (bx, by) = tip, middle
    return [x, y, bx - (y - by) // 2, by + (x - bx) // 2, bx + (y - by) // 2, by - (x - bx) // 2]


def _is_before(a: Vector, b: Vector, path: list[Vector], i: int) -> bool:
    """Whether a comes before b on the segment of a path that leads to point i."""
    if not 0 < i < len(path):
        return False
    dx, dy = path[i][0] - path[i - 1][0], path[i][1] - path[i - 1][1]
    return dx * (b[0] - a[0]) + dy * (b[1] - a[1]) > 0


def rounded_box(left: int, top: int, right: int, bottom: int, a: int, b: int) -> Contour:
    """Return a box with quarters of an ellipse around its corners: an ellipse's box is its center."""
    centers = [(right, bottom), (left, bottom), (left, top), (right, top)]
    outline: Contour = []
    for (x, y), (start, end) in zip(centers, pairwise(_AXES), strict=True):
        outline += _arc(x, y, a, b, start, end)
    return outline


def disc(box: Box, a: int, b: int, sharp: bool, half: int) -> list[Contour]:
    """Return what a box with round or sharp corners encloses, an ellipse for one, and `half` a width beyond it."""
    return [_grown(box, a, b, sharp, half)]


def ring(box: Box, a: int, b: int, sharp: bool, half: int) -> list[Contour]:
    """Return its outline drawn with `half` a width on either side."""
    return [_between(_grown(box, a, b, sharp, half), _grown(box, a, b, sharp, -half))]


def thin_quarters(x: int, y: int, a: int, b: int, quadrants: int, fill: bool) -> list[Contour]:
    """Return some quadrants of an ellipse, each with the center if it is to be filled."""
    chosen = [arms for bit, arms in zip(_BITS, pairwise(_AXES), strict=True) if quadrants & bit]
    return [[x, y] * fill + _arc(x, y, a, b, *arms) for arms in chosen]


def quarters(x: int, y: int, a: int, b: int, quadrants: int, fill: bool, half: int) -> list[Contour]:
    """Return some quadrants of an ellipse's disc or ring, with the pixels on its axes."""
    shape = []
    for bit, (start, end) in zip(_BITS, pairwise(_AXES), strict=True):
        if quadrants & bit:
            # Half a pixel back from the first axis, and beyond the second one.
            back = (-_HALF_PIXEL * end[0], -_HALF_PIXEL * end[1])
            beyond = (-_HALF_PIXEL * start[0], -_HALF_PIXEL * start[1])
            corner = [x + back[0] + beyond[0], y + back[1] + beyond[1]]
            outer, inner = (
                _lengthened(_arc(x, y, max(a + off, 0), max(b + off, 0), start, end), back, beyond)
                for off in (half, -half)
            )
            shape.append(_between(outer, corner if fill or min(a, b) <= half else inner))
    return shape


def arc(x: int, y: int, r: int, turns: list[Vector]) -> Contour:
    """Return points along a circle clockwise from vector to vector, each less than half a turn from the one before."""
    points: Contour = []
    for start, end in pairwise(turns):
        points += _arc(x, y, r, r, start, end)
    return points


def slice_of_disc(x: int, y: int, r: int, turns: list[Vector]) -> list[Contour]:
    """Return a sector of a disc, from the first vector to the last."""
    return [[x, y, *arc(x, y, r, turns)]]


def slice_of_ring(x: int, y: int, r: int, turns: list[Vector], half: int) -> list[Contour]:
    """Return an arc drawn with `half` a width on either side."""
    return [_between(arc(x, y, r + half, turns), arc(x, y, r - half, turns) if r > half else [x, y])]


def curve(controls: Contour) -> Contour:
    """Return points along a chain of cubic Bézier pieces, each piece's last control point the first of the next."""
    points = controls[:2]
    open_pieces = [[number << _FINE for number in controls[i : i + 8]] for i in range(0, len(controls) - 2, 6)][::-1]
    while open_pieces:
        piece = open_pieces.pop()
        rise = max(abs(piece[i] - 2 * piece[i + 2] + piece[i + 4]) for i in range(4)) >> _FINE
        xs, ys = [number >> _FINE for number in piece[::2]], [number >> _FINE for number in piece[1::2]]
        if rise <= _FLAT or is_outside((min(xs), min(ys), max(xs), max(ys))):
            points += xs[3], ys[3]
        else:
            open_pieces += _halves(piece)[::-1]
    return points


def chain(points: Contour) -> Contour:
    """Return the control points of cubic pieces: of one quadratic piece, given by three points, or of themselves."""
    if len(points) != 6:
        return points
    (x1, y1), (x2, y2), (x3, y3) = pairs(points)
    return [x1, y1, (x1 + 2 * x2) // 3, (y1 + 2 * y2) // 3, (x3 + 2 * x2) // 3, (y3 + 2 * y2) // 3, x3, y3]


def through(points: list[Vector], closed: bool) -> Contour:
    """Return the control points of the smooth curve through points, as `paneldraw.raster.bezier` has it."""
    points = [point for point, _ in groupby(points)]
    closed = closed and len(points) > 2
    if closed:
        points = points[:-1] if points[0] == points[-1] else points
        points = [points[-1], *points, *points[:2]]
    elif len(points) > 1:
        points = [_mirrored(points[1], points[0]), *points, _mirrored(points[-2], points[-1])]
    else:
        points *= 4
    # The root of each distance, in 2**-32 of one of a 256th.
    knots = [isqrt(isqrt((c - a) ** 2 + (d - b) ** 2 << 128)) for (a, b), (c, d) in pairwise(points)]
    controls = [*points[1]]
    for i in range(len(points) - 3):
        before, start, end, behind = points[i : i + 4]
        controls += _handle(before, start, end, knots[i], knots[i + 1])
        controls += _handle(behind, end, start, knots[i + 2], knots[i + 1])
        controls += end
    return controls


def _handle(before: Vector, at: Vector, to: Vector, d1: int, d2: int) -> Vector:
    """The control point next to `at` toward `to`, where the knots on either side are d1 and d2 away."""
    if d1 == 0:
        return at
    middle = 2 * d1 * d1 + 3 * d1 * d2 + d2 * d2
    weight = 3 * d1 * (d1 + d2)
    x, y = ((d1 * d1 * to[k] - d2 * d2 * before[k] + middle * at[k]) // weight for k in (0, 1))
    return x, y


def _mirrored(point: Vector, at: Vector) -> Vector:
    return 2 * at[0] - point[0], 2 * at[1] - point[1]


def _halves(piece: Contour) -> list[Contour]:
    """De Casteljau's midpoints: the control points of either half."""
    rows = [piece]
    while len(rows[-1]) > 2:
        rows.append([(a + b) // 2 for a, b in zip(rows[-1], rows[-1][2:], strict=False)])
    first = [number for row in rows for number in row[:2]]
    return [first, [number for row in reversed(rows) for number in row[-2:]]]


def arc_caps(x: int, y: int, r: int, turns: list[Vector], half: int, is_round: bool) -> list[Contour]:
    """Return half a square beyond either end of an arc, or a disc around it."""
    shape = []
    for (vx, vy), turn in ((turns[0], -1), (turns[-1], 1)):
        length = isqrt(vx * vx + vy * vy)
        ex, ey = x + r * vx // length, y + r * vy // length
        if is_round:
            shape.append(rounded_box(ex, ey, ex, ey, half, half))
        else:
            tip = ex - turn * half * vy // length, ey + turn * half * vx // length
            shape.append(thick_line(ex, ey, *tip, 2 * half, False))
    return shape


def spokes(x: int, y: int, r: int, turns: list[Vector], half: int) -> list[Contour]:
    """Return bars from a center to the ends of an arc, `half` to either side and to the outer edge, joined by a dot."""
    shape = [rounded_box(x, y, x, y, half, half)]
    outer = r + half
    for vx, vy in (turns[0], turns[-1]):
        length = isqrt(vx * vx + vy * vy)
        # Where the sides of the bar, (-vy, vx) to the right of it, meet the edge.
        along = isqrt(outer * outer - half * half)
        left, right = ((along * vx + side * vy, along * vy - side * vx) for side in (half, -half))
        aside = (half * vy // length, half * vx // length)
        bar = _arc(x, y, outer, outer, left, right) if along else []
        shape.append([x - aside[0], y + aside[1], x + aside[0], y - aside[1], *bar])
    return shape


def _grown(box: Box, a: int, b: int, sharp: bool, outward: int) -> Contour:
    """The box with its curve moved outward: the radii grow or shrink, and what they cannot shrink the box does."""
    left, top, right, bottom = box
    a, b = (outward, outward) if sharp else (a + outward, b + outward)
    x, y = (a, b) if sharp else (min(a, 0), min(b, 0))
    left, top, right, bottom = left - x, top - y, right + x, bottom + y
    if left > right or top > bottom:
        return []
    return rounded_box(left, top, right, bottom, *((0, 0) if sharp else (max(a, 0), max(b, 0))))


def _between(outer: Contour, inner: Contour) -> Contour:
    """One contour around what is in the outer one and not in the inner one, which goes the same way around.

    Of two that are open their ends are joined.
    """
    back = [number for point in reversed(pairs(inner)) for number in point]
    is_closed = outer[:2] == outer[-2:]
    return [*outer, *(inner[:2] if is_closed else []), *back]


def _lengthened(points: Contour, back: Vector, beyond: Vector) -> Contour:
    """Points with another one before the first and another one behind the last, at these distances."""
    return [points[0] + back[0], points[1] + back[1], *points, points[-2] + beyond[0], points[-1] + beyond[1]]


def _arc(x: int, y: int, a: int, b: int, start: Vector, end: Vector) -> Contour:
    """Points along an ellipse clockwise from the direction of one vector to that of another, less than half a turn on.

    An arc is halved until it is flat or out of the square.
    """
    unit = 1 << (max(a, b).bit_length() + 16)
    first, last = _unit_vector(start, unit), _unit_vector(end, unit)

    def place(vector: Vector) -> Vector:
        return x + a * vector[0] // unit, y + b * vector[1] // unit

    points = [*place(first)]
    open_arcs = [(first, last)]
    while open_arcs:
        u, v = open_arcs.pop()
        middle = _unit_vector((u[0] + v[0], u[1] + v[1]), unit)
        p, q, m = place(u), place(v), place(middle)
        rise = (abs(2 * m[0] - p[0] - q[0]) + abs(2 * m[1] - p[1] - q[1])) // 2
        box = (min(p[0], q[0]), min(p[1], q[1]), max(p[0], q[0]), max(p[1], q[1]))
        if rise <= _FLAT or is_outside(box, 2 * rise):
            points += q
        else:
            open_arcs += [(middle, v), (u, middle)]
    return points


def _unit_vector(vector: Vector, unit: int) -> Vector:
    length = isqrt((vector[0] ** 2 + vector[1] ** 2) << 64)
    return (vector[0] * unit << 32) // length, (vector[1] * unit << 32) // length
