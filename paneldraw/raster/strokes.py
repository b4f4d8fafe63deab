# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Strokes: the contours of a thick polyline, its joins, caps and dashes.

A stroke is the union of simple pieces, a rectangle for each segment and a wedge for each join, all wound the same way;
the non-zero rule makes one shape of them. Corners are rounded to 256ths of a pixel, in which all lengths here are.
"""

from __future__ import annotations

from typing import Any

import cython

if cython.compiled:
    from cython.cimports.libc.math import acos, atan2, ceil, cos, floor, fmod, hypot, rint, sin, sqrt
else:
    from math import acos, atan2, ceil, cos, floor, fmod, hypot, sin, sqrt

    rint = round

#: The number by which `stroke` knows a cap or a join.
CAPS = {"butt": 0, "square": 1, "round": 2}
JOINS = {"miter": 0, "round": 1, "bevel": 2}

PI = cython.declare(cython.double, 3.141592653589793)


@cython.cclass
class Contours:
    """A list of closed contours that grows; as `polygons` takes it, or with points `fineness` times as fine.

    Arcs are chords within a quarter of a 256th. For a filter of a certain radius, in 256ths, they need be no closer
    than it tells: then they are on either side of the arc, enclose the area that it does, and are evened out.
    """

    def __init__(self) -> None:
        self.capacity = 0
        self.room_for_ends = 0
        self.kept = bytearray()
        self.kept_ends = bytearray()
        self.begin(1, 0)

    @cython.cfunc
    def begin(self, fineness: cython.int, radius: cython.double) -> Any:
        """Begin a new list, in the memory of the one before."""
        self.fineness = fineness
        self.radius = radius
        self.count = 0
        self.contours = 0
        if not cython.compiled:
            self.points: list[Any] = []
            self.ends: list[Any] = []

    @cython.cfunc
    def add(self, x: cython.double, y: cython.double) -> Any:
        """Add a point to the open contour, rounded to whole 256ths or finer.

        Halves go to the even number: two points that lie symmetrically about a whole one still do so afterwards, and
        the edge between them runs through it, where other pieces meet this one.
        """
        self.add_whole(
            cython.cast(cython.longlong, rint(x * self.fineness)), cython.cast(cython.longlong, rint(y * self.fineness))
        )

    @cython.cfunc
    def add_whole(self, x: cython.longlong, y: cython.longlong) -> Any:
        """Add a point as it will be kept."""
        if cython.compiled:
            if self.count == self.capacity:
                self.capacity = 2 * self.capacity + 64
                self.kept.extend(bytes(16 * self.capacity - len(self.kept)))
                self.points = cython.cast(cython.p_longlong, cython.cast(cython.p_char, self.kept))
            self.points[2 * self.count] = x
            self.points[2 * self.count + 1] = y
        else:
            self.points += [x, y]
        self.count += 1

    @cython.cfunc
    def close(self) -> Any:
        """Close the open contour, turned clockwise as the screen shows it."""
        k: cython.Py_ssize_t
        before: cython.Py_ssize_t = self.count - 1
        area: cython.longlong = 0
        points: cython.p_longlong = self.points
        for k in range(self.ends[self.contours - 1] if self.contours else 0, self.count):
            area += points[2 * before] * points[2 * k + 1] - points[2 * k] * points[2 * before + 1]
            before = k
        if area < 0:
            self.reverse()
        self.end()

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def reverse(self) -> cython.void:
        """Turn the open contour round."""
        points: cython.p_longlong = self.points
        i: cython.Py_ssize_t = self.ends[self.contours - 1] if self.contours else 0
        j: cython.Py_ssize_t = self.count - 1
        while i < j:
            points[2 * i], points[2 * j] = points[2 * j], points[2 * i]
            points[2 * i + 1], points[2 * j + 1] = points[2 * j + 1], points[2 * i + 1]
            i += 1
            j -= 1

    @cython.cfunc
    def cut(
        self, cx: cython.longlong, cy: cython.longlong, vx: cython.double, vy: cython.double, margin: cython.double
    ) -> Any:
        """Leave of the open contour what is clockwise of a vector from (cx, cy): Sutherland and Hodgman's algorithm.

        The cross product of the vector and what is left is -margin or more.
        """
        start: cython.Py_ssize_t = self.ends[self.contours - 1] if self.contours else 0
        end: cython.Py_ssize_t = self.count
        i: cython.Py_ssize_t
        last: cython.Py_ssize_t = end - 1
        share: cython.double
        depth: cython.double
        before: cython.double = 0
        if start < end:
            before = vx * (self.points[2 * last + 1] - cy) - vy * (self.points[2 * last] - cx) + margin
        for i in range(start, end):
            x1: cython.longlong = self.points[2 * last]
            y1: cython.longlong = self.points[2 * last + 1]
            x2: cython.longlong = self.points[2 * i]
            y2: cython.longlong = self.points[2 * i + 1]
            depth = vx * (y2 - cy) - vy * (x2 - cx) + margin
            if (before < 0) != (depth < 0):
                share = before / (before - depth)
                self.add_whole(
                    x1 + cython.cast(cython.longlong, rint((x2 - x1) * share)),
                    y1 + cython.cast(cython.longlong, rint((y2 - y1) * share)),
                )
            if depth >= 0:
                self.add_whole(x2, y2)
            before = depth
            last = i
        # What is left was added behind what there was.
        for i in range(2 * end, 2 * self.count):
            self.points[i - 2 * (end - start)] = self.points[i]
        self.count -= end - start
        if not cython.compiled:
            del self.points[2 * self.count :]

    @cython.cfunc
    def end(self) -> Any:
        """Close the open contour as it is."""
        if cython.compiled:
            if self.contours == self.room_for_ends:
                self.room_for_ends = 2 * self.room_for_ends + 16
                self.kept_ends.extend(bytes(8 * self.room_for_ends - len(self.kept_ends)))
                self.ends = cython.cast(cython.p_Py_ssize_t, cython.cast(cython.p_char, self.kept_ends))
            self.ends[self.contours] = self.count
        else:
            self.ends.append(self.count)
        self.contours += 1


@cython.cfunc
def stroke(
    contours: Contours,
    path: cython.p_double,
    count: cython.Py_ssize_t,
    closed: cython.bint,
    width: cython.double,
    cap: cython.int,
    end_cap: cython.int,
    join: cython.int,
) -> Any:
    """Add the pieces of the stroke along `count` points (x, y), no two neighbors of which are equal.

    A single point is a line of no length to the right.
    """
    half: cython.double = width / 2
    i: cython.Py_ssize_t
    last: cython.Py_ssize_t = count if closed else count - 1
    x1: cython.double
    y1: cython.double
    x2: cython.double
    y2: cython.double
    # The unit vectors along the present segment and the one before it.
    ux: cython.double = 1
    uy: cython.double = 0
    vx: cython.double
    vy: cython.double
    length: cython.double
    if count == 1:
        _end(contours, path[0], path[1], -1, 0, half, cap)
        _end(contours, path[0], path[1], 1, 0, half, end_cap)
        return
    for i in range(last + (1 if closed else 0)):
        x1 = path[2 * (i % count)]
        y1 = path[2 * (i % count) + 1]
        x2 = path[2 * ((i + 1) % count)]
        y2 = path[2 * ((i + 1) % count) + 1]
        vx = ux
        vy = uy
        length = hypot(x2 - x1, y2 - y1)
        ux = (x2 - x1) / length
        uy = (y2 - y1) / length
        if i > 0:
            _join(contours, x1, y1, vx, vy, ux, uy, half, join)
        elif not closed:
            _end(contours, x1, y1, -ux, -uy, half, cap)
        if i < last:
            contours.add(x1 - uy * half, y1 + ux * half)
            contours.add(x1 + uy * half, y1 - ux * half)
            contours.add(x2 + uy * half, y2 - ux * half)
            contours.add(x2 - uy * half, y2 + ux * half)
            contours.close()
    if not closed:
        _end(contours, x2, y2, ux, uy, half, end_cap)


@cython.cfunc
def _end(
    contours: Contours,
    x: cython.double,
    y: cython.double,
    ux: cython.double,
    uy: cython.double,
    half: cython.double,
    cap: cython.int,
) -> Any:
    """What a cap adds beyond an end point, in the direction (ux, uy)."""
    if cap == 0:
        return
    if cap == 1:
        contours.add(x - uy * half, y + ux * half)
        contours.add(x + (ux - uy) * half, y + (uy + ux) * half)
        contours.add(x + (ux + uy) * half, y + (uy - ux) * half)
        contours.add(x + uy * half, y - ux * half)
        contours.close()
    else:
        _fan(contours, x, y, uy * half, -ux * half, -uy * half, ux * half, PI)


@cython.cfunc
def _join(
    contours: Contours,
    x: cython.double,
    y: cython.double,
    vx: cython.double,
    vy: cython.double,
    ux: cython.double,
    uy: cython.double,
    half: cython.double,
    join: cython.int,
) -> Any:
    """Fill the wedge on the outer side of a corner, where direction v turns into direction u."""
    cross: cython.double = vx * uy - vy * ux
    dot: cython.double = vx * ux + vy * uy
    outer: cython.double = half if cross > 0 else -half
    if cross == 0 and dot > 0:
        return
    if join == 1:
        if cross > 0:
            _fan(contours, x, y, vy * half, -vx * half, uy * half, -ux * half, atan2(cross, dot))
        else:
            _fan(contours, x, y, -uy * half, ux * half, -vy * half, vx * half, atan2(abs(cross), dot))
        return
    contours.add(x, y)
    contours.add(x + vy * outer, y - vx * outer)
    # The miter is 1 / cos(angle / 2) half widths long; up to 4 of them it is drawn.
    if join == 0 and 8 * (1 + dot) >= 1:
        contours.add(x + (vy + uy) * outer / (1 + dot), y - (vx + ux) * outer / (1 + dot))
    contours.add(x + uy * outer, y - ux * outer)
    contours.close()


@cython.cfunc
def _fan(
    contours: Contours,
    x: cython.double,
    y: cython.double,
    dx: cython.double,
    dy: cython.double,
    ex: cython.double,
    ey: cython.double,
    angle: cython.double,
) -> Any:
    """A circular sector from (x + dx, y + dy) clockwise to (x + ex, y + ey)."""
    radius: cython.double = hypot(dx, dy)
    steps: cython.int = 1
    deviation: cython.double = max(0.25, 0.0075 * contours.radius)
    if radius > 0.5:
        steps = cython.cast(cython.int, ceil(angle / (2 * acos(max(0.5, 1 - deviation / radius)))))
    i: cython.int
    turned: cython.double
    contours.add(x, y)
    for i in range(steps):
        turned = angle * i / steps
        if i == 1 and contours.radius > 0:
            dx *= sqrt(turned / sin(turned))
            dy *= sqrt(turned / sin(turned))
        contours.add(x + dx * cos(turned) - dy * sin(turned), y + dx * sin(turned) + dy * cos(turned))
    contours.add(x + ex, y + ey)
    contours.close()


@cython.cclass
class Dashes:
    """Cuts a path into the pieces that a dash pattern shows, and strokes these.

    The pattern, alternately a length that is drawn and one that is left out, starts where the stroke does and goes on
    around corners. Dashes are cut square; a cap shapes the path's own ends. Of the path only what comes within
    `margin` of `box` (left, top, right, bottom) is followed, and of that the dashes are made that lie beside the box
    or at a corner, so that the work does not grow with what cannot be seen. A path that is itself a piece begins at
    `distance` within the pattern.
    """

    def __init__(
        self, contours: Contours, pattern: Any, distance: Any, box: Any, margin: Any, capacity: cython.Py_ssize_t
    ) -> None:
        self.contours = contours
        self.pattern = pattern
        self.left: Any
        self.top: Any
        self.right: Any
        self.bottom: Any
        self.left, self.top, self.right, self.bottom = box
        self.margin = margin
        self.period = sum(pattern)
        self.phase = 0
        self.rest = pattern[0]
        self.count = 0
        self.kept = bytearray(16 * (capacity + 2))
        if cython.compiled:
            self.piece = cython.cast(cython.p_double, cython.cast(cython.p_char, self.kept))
        else:
            self.piece = [0.0] * (2 * capacity + 4)
        self._skip(distance)

    @cython.cfunc
    def stroke(
        self, path: cython.p_double, count: cython.Py_ssize_t, width: cython.double, cap: cython.int, join: cython.int
    ) -> Any:
        """Add the pieces of the dashed stroke along an open path of two points or more."""
        i: cython.Py_ssize_t
        last: cython.Py_ssize_t = count - 2
        self.width = width
        self.join = join
        self.cap = 2 if cap == 2 else 0
        for i in range(count - 1):
            x1: cython.double = path[2 * i]
            y1: cython.double = path[2 * i + 1]
            x2: cython.double = path[2 * i + 2]
            y2: cython.double = path[2 * i + 3]
            length: cython.double = hypot(x2 - x1, y2 - y1)
            ux: cython.double = (x2 - x1) / length
            uy: cython.double = (y2 - y1) / length
            if cap == 1 and i == 0:
                x1 -= ux * width / 2
                y1 -= uy * width / 2
                length += width / 2
            if cap == 1 and i == last:
                length += width / 2
            self._segment(x1, y1, ux, uy, length)
        self._finish(2 if cap == 2 else 0)

    @cython.cfunc
    def _segment(
        self, x: cython.double, y: cython.double, ux: cython.double, uy: cython.double, length: cython.double
    ) -> Any:
        """Go on for `length` from (x, y) in the direction (ux, uy)."""
        first: cython.double = 0
        last: cython.double = length
        first, last = _clip(x, ux, self.left - self.margin, self.right + self.margin, first, last)
        first, last = _clip(y, uy, self.top - self.margin, self.bottom + self.margin, first, last)
        if first >= last:
            self._finish(0)
            self._skip(length)
            return
        if first > 0:
            self._finish(0)
            self._skip(first)
        # Between these the segment passes the box. Elsewhere whole periods are left out.
        low: cython.double = min((self.left - x) * ux, (self.right - x) * ux)
        high: cython.double = max((self.left - x) * ux, (self.right - x) * ux)
        low += min((self.top - y) * uy, (self.bottom - y) * uy)
        high += max((self.top - y) * uy, (self.bottom - y) * uy)
        at: cython.double = first
        if self.phase % 2 == 0:
            self._add(x + ux * at, y + uy * at)
        while at + self.rest <= last:
            at += self.rest
            if self.phase % 2 == 0:
                self._add(x + ux * at, y + uy * at)
                self._finish(0)
            self._next()
            if at < low:
                at += self.period * floor((min(low, last) - at) / self.period)
            elif at > high:
                at += self.period * floor((last - at) / self.period)
            if self.phase % 2 == 0:
                self._add(x + ux * at, y + uy * at)
        self.rest -= last - at
        if self.phase % 2 == 0:
            self._add(x + ux * last, y + uy * last)
        if last < length:
            self._finish(0)
            self._skip(length - last)

    @cython.cfunc
    def _add(self, x: cython.double, y: cython.double) -> Any:
        """Add a point to the piece, unless it stands there already."""
        i: cython.Py_ssize_t = 2 * self.count
        if i and abs(self.piece[i - 2] - x) + abs(self.piece[i - 1] - y) < 1e-6:
            return
        self.piece[i] = x
        self.piece[i + 1] = y
        self.count += 1

    @cython.cfunc
    def _finish(self, end_cap: cython.int) -> Any:
        """Stroke the piece, if there is one, and begin anew."""
        if self.count > 1:
            stroke(self.contours, self.piece, self.count, False, self.width, self.cap, end_cap, self.join)
        if self.count:
            self.cap = 0
        self.count = 0

    @cython.cfunc
    def _next(self) -> Any:
        self.phase = (self.phase + 1) % len(self.pattern)
        self.rest = self.pattern[self.phase]

    @cython.cfunc
    def _skip(self, length: cython.double) -> Any:
        """Advance the pattern without drawing."""
        self.cap = 0
        length = fmod(length, self.period)
        while length >= self.rest:
            length -= self.rest
            self._next()
        self.rest -= length


@cython.cfunc
def _clip(
    start: cython.double,
    direction: cython.double,
    low: cython.double,
    high: cython.double,
    first: cython.double,
    last: cython.double,
) -> tuple[cython.double, cython.double]:
    """The part of ``first <= t <= last`` in which ``low <= start + t * direction <= high``."""
    if direction == 0:
        return (first, last) if low <= start <= high else (first, first)
    a: cython.double = (low - start) / direction
    b: cython.double = (high - start) / direction
    return max(first, min(a, b)), min(last, max(a, b))
