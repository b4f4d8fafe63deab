# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What angles and quadrants cut out of a shape around a center, sub-scanline by sub-scanline.

Points on an edge are shared out as in `paneldraw.raster.thick`: what two adjacent angles leave of a shape has no point
in common and leaves none out.
"""

from __future__ import annotations

from math import isqrt

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.chords import chord
else:
    from paneldraw.raster.chords import chord

#: The length of the vectors that say where a wedge begins and ends.
UNIT = 1 << 30
_UNIT = cython.declare(cython.longlong, 1 << 30)


@cython.cclass
class Cut:
    """A part of the plane around a center: sub-scanline by sub-scanline ``low <= x < high``, or all but that."""

    def __init__(self) -> None:
        self.reflex = False

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def place(self, x: cython.longlong, y: cython.longlong, half: cython.longlong, n: cython.int) -> cython.void:
        """Take the lattice into account: the center on it, half a line's width, the sub-pixels of a pixel."""
        self.cx = x
        self.cy = y

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def row(self, y: cython.longlong) -> cython.void:
        """Set `low` and `high` for a sub-scanline."""

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def apply(
        self,
        spans: cython.p_Py_ssize_t,
        start: cython.Py_ssize_t,
        count: cython.Py_ssize_t,
        y: cython.longlong,
        middle: cython.longlong,
    ) -> cython.Py_ssize_t:
        """Cut the spans from number `start` on, those of one sub-scanline; return how many spans there are now."""
        k: cython.Py_ssize_t
        self.row(y - self.cy)
        low: cython.Py_ssize_t = (self.cx + self.low + middle + 511) >> 9
        high: cython.Py_ssize_t = (self.cx + self.high + middle + 511) >> 9
        end: cython.Py_ssize_t = count
        for k in range(start, end):
            if not self.reflex:
                spans[2 * k] = max(spans[2 * k], low)
                spans[2 * k + 1] = min(spans[2 * k + 1], high)
            elif low < high:
                spans[2 * count] = max(spans[2 * k], high)
                spans[2 * count + 1] = spans[2 * k + 1]
                spans[2 * k + 1] = min(spans[2 * k + 1], low)
                count += 1
        return count

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def widen(self) -> cython.void:
        """Begin with the whole sub-scanline."""
        one: cython.longlong = 1
        self.low = -(one << 60)
        self.high = one << 60

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def confine(
        self, vx: cython.longlong, vy: cython.longlong, margin: cython.longlong, y: cython.longlong
    ) -> cython.void:
        """Go no further than the line clockwise of which, seen along the vector, the inside lies.

        The cross product of the vector and a point inside is at least -margin.
        """
        cross: cython.longlong = vx * y + margin
        if vy > 0:
            self.high = min(self.high, (cross + vy - 1) // vy if cross > 0 else -(-cross // vy))
        elif vy < 0:
            self.low = max(self.low, -(cross // -vy) if cross >= 0 else (-cross - vy - 1) // -vy)
        elif cross < 0 or (cross == 0 and vx < 0):
            self.high = self.low


@cython.cclass
class Quadrants(Cut):
    """A choice of quadrants, bits counterclockwise from the top right one; with each the pixels on its axes."""

    def __init__(self, quadrants: int) -> None:
        self.reflex = False
        self.quadrants = quadrants

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def place(self, x: cython.longlong, y: cython.longlong, half: cython.longlong, n: cython.int) -> cython.void:
        self.cx = x
        self.cy = y
        self.half = 256 * n

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def row(self, y: cython.longlong) -> cython.void:
        top: cython.bint = y < self.half
        bottom: cython.bint = y >= -self.half
        right: cython.bint = (top and self.quadrants & 1) or (bottom and self.quadrants & 8)
        left: cython.bint = (top and self.quadrants & 2) or (bottom and self.quadrants & 4)
        self.widen()
        if not left:
            self.low = -self.half
        if not right:
            self.high = self.half if left else self.low


@cython.cclass
class Wedge(Cut):
    """The angle clockwise from one vector of length UNIT to another; reflex if it is more than half a turn."""

    def __init__(self, start: tuple[int, int], end: tuple[int, int], reflex: bool) -> None:
        # A reflex angle is all but the other one.
        self.reflex = reflex
        self.start_x, self.start_y = end if reflex else start
        self.end_x, self.end_y = start if reflex else end

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def row(self, y: cython.longlong) -> cython.void:
        self.widen()
        self.confine(self.start_x, self.start_y, 0, y)
        self.confine(-self.end_x, -self.end_y, 0, y)


@cython.cclass
class SectorOutline(Wedge):
    """What a wedge leaves, and two lines of the same width from the center along its sides, joined by a disc."""

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def place(self, x: cython.longlong, y: cython.longlong, half: cython.longlong, n: cython.int) -> cython.void:
        self.cx = x
        self.cy = y
        self.half = half

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def apply(
        self,
        spans: cython.p_Py_ssize_t,
        start: cython.Py_ssize_t,
        count: cython.Py_ssize_t,
        y: cython.longlong,
        middle: cython.longlong,
    ) -> cython.Py_ssize_t:
        first: cython.Py_ssize_t = spans[2 * start]
        last: cython.Py_ssize_t = spans[2 * count - 1]
        reach: cython.longlong
        count = Cut.apply(self, spans, start, count, y, middle)
        self.side(spans, count, self.start_x, self.start_y, y, middle, first, last)
        self.side(spans, count + 1, self.end_x, self.end_y, y, middle, first, last)
        count += 2
        if abs(y - self.cy) < self.half:
            reach = chord(self.half, self.half, abs(y - self.cy))
            spans[2 * count] = (self.cx - (reach >> 1) + middle + 511) >> 9
            spans[2 * count + 1] = (self.cx + ((reach + 1) >> 1) + middle + 511) >> 9
            count += 1
        return _unite(spans, start, count)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def side(
        self,
        spans: cython.p_Py_ssize_t,
        at: cython.Py_ssize_t,
        vx: cython.longlong,
        vy: cython.longlong,
        y: cython.longlong,
        middle: cython.longlong,
        first: cython.Py_ssize_t,
        last: cython.Py_ssize_t,
    ) -> cython.void:
        """Write what of first ... last is in the line along the vector as span number `at`."""
        margin: cython.longlong = self.half * _UNIT
        self.widen()
        self.confine(vx, vy, margin, y - self.cy)
        self.confine(-vx, -vy, margin, y - self.cy)
        self.confine(vy, -vx, 0, y - self.cy)
        spans[2 * at] = max(first, (self.cx + self.low + middle + 511) >> 9)
        spans[2 * at + 1] = min(last, (self.cx + self.high + middle + 511) >> 9)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _unite(spans: cython.p_Py_ssize_t, start: cython.Py_ssize_t, count: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Sort the spans from number `start` on and let none reach into the one before; return `count`."""
    k: cython.Py_ssize_t
    j: cython.Py_ssize_t
    low: cython.Py_ssize_t
    high: cython.Py_ssize_t
    for k in range(start + 1, count):
        low = spans[2 * k]
        high = spans[2 * k + 1]
        j = k
        while j > start and spans[2 * j - 2] > low:
            spans[2 * j] = spans[2 * j - 2]
            spans[2 * j + 1] = spans[2 * j - 1]
            j -= 1
        spans[2 * j] = low
        spans[2 * j + 1] = high
    high = spans[2 * start]
    for k in range(start, count):
        spans[2 * k] = max(spans[2 * k], high)
        high = max(high, spans[2 * k + 1])
    return count


# -- The same in Python's integers; spans on the lattice, seen from the center

Spans = list[tuple[int, int]]


def without(pieces: Spans, low: int, high: int) -> Spans:
    if low >= high:
        return pieces
    return [part for start, end in pieces for part in ((start, min(end, low)), (max(start, high), end))]


def _between(vectors: list[tuple[int, int, int]], y: int, low: int, high: int) -> tuple[int, int]:
    """What of ``low <= x < high`` lies clockwise of all vectors (x, y, margin)."""
    for vx, vy, margin in vectors:
        cross = vx * y + margin
        if vy > 0:
            high = min(high, -(-cross // vy))
        elif vy < 0:
            low = max(low, -(cross // -vy))
        elif cross < 0 or (cross == 0 and vx < 0):
            high = low
    return low, high


def quadrants_far(quadrants: int, pieces: Spans, half: int, n: int, y: int) -> Spans:
    """As `Quadrants`."""
    top, bottom = y < 256 * n, y >= -256 * n
    right = (top and quadrants & 1) or (bottom and quadrants & 8)
    left = (top and quadrants & 2) or (bottom and quadrants & 4)
    if left and right:
        return pieces
    return [
        (low if left else max(low, -256 * n), min(high, 256 * n) if left else high)
        for low, high in pieces
        if left or right
    ]


def wedge_far(
    start: tuple[int, int], end: tuple[int, int], reflex: bool, pieces: Spans, half: int, n: int, y: int
) -> Spans:
    """As `Wedge`."""
    if reflex:
        start, end = end, start
    low, high = _between([(*start, 0), (-end[0], -end[1], 0)], y, pieces[0][0], pieces[len(pieces) - 1][1])
    if reflex:
        return without(pieces, low, high)
    return [(max(first, low), min(last, high)) for first, last in pieces]


def sector_outline_far(
    unit: int, start: tuple[int, int], end: tuple[int, int], reflex: bool, pieces: Spans, half: int, n: int, y: int
) -> Spans:
    """As `SectorOutline`, of vectors of any length."""
    lines = wedge_far(start, end, reflex, pieces, half, n, y)
    for vx, vy in (start, end):
        line = [(vx, vy, half * unit), (-vx, -vy, half * unit), (vy, -vx, 0)]
        lines.append(_between(line, y, pieces[0][0], pieces[len(pieces) - 1][1]))
    if abs(y) < half:
        reach = isqrt(half * half - y * y)
        lines.append((-reach, reach + (reach * reach != half * half - y * y)))
    united: Spans = []
    reached = min(lines)[0]
    for low, high in sorted(lines):
        low, high = max(low, reached), max(high, reached)
        united.append((low, high))
        reached = high
    return united
