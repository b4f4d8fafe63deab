# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What bounds a shape: of contours that may cross, overlap and repeat, the parts with the inside on one side only.

A sweep from top to bottom keeps the edges in order from left to right. Between two heights at which edges end or begin
neighbors change places where they cross; what an edge bounds depends on the windings of those to its left.
"""

from __future__ import annotations

from typing import Any

import cython

if cython.compiled:
    from cython.cimports.libc.math import sqrt
else:
    from math import sqrt

#: An edge, pointing downward, where it stands `above` and `below`, its `place` among the active ones, the windings of
#: those to its `left`, and where, if it `waits` for that, it meets the next. From `start` on it bounds the shape with
#: `sign`: 1 with the inside to its right, -1 to its left, 0 if on neither or both. The edges `before` and `after` it
#: end where it begins and begin where it ends; `segment` is the one made of its end. Where there is none, they are -1.
Edge = cython.struct(
    top=cython.double,
    bottom=cython.double,
    x=cython.double,
    x_end=cython.double,
    slope=cython.double,
    above=cython.double,
    below=cython.double,
    start=cython.double,
    meeting=cython.double,
    winding=cython.int,
    left=cython.int,
    sign=cython.int,
    place=cython.int,
    waits=cython.bint,
    active=cython.bint,
    before=cython.int,
    after=cython.int,
    segment=cython.int,
)

# Edges closer than this, in pixels, are the same.
_SAME = cython.declare(cython.double, 1e-9)


@cython.cclass
class Boundary:
    """The segments that bound a shape within a box; memory is kept for the next shape.

    Segment k is twelve numbers from number 12 k on: where it begins, x and y; the unit vector along it, which points
    downward; its length; where it ends, x and y; its sign, 1 with the inside to its right and -1 to its left; and
    whether another one with the same sign ends where it begins, and begins where it ends; its slope; and
    room for a number.
    """

    def __init__(self) -> None:
        self.count = 0
        self.edges = 0
        self.capacity = 0
        self.left = self.top = self.right = self.bottom = 0.0
        self.kept_segments = bytearray()
        self.kept_edges = bytearray()

    @cython.cfunc
    def find(
        self,
        points: cython.p_longlong,
        ends: cython.p_Py_ssize_t,
        contours: cython.Py_ssize_t,
        nonzero: cython.bint,
        unit: cython.double,
    ) -> Any:
        """Find the boundary of closed contours, as `polygons` takes them, but in 1 / `unit` pixels.

        Of the plane, all above `top` and below `bottom` is left out, and all right of `right`; what is left of `left`
        is drawn in to there.
        """
        i: cython.Py_ssize_t
        before: cython.Py_ssize_t
        contour: cython.Py_ssize_t
        start: cython.Py_ssize_t = 0
        self.nonzero = nonzero
        self.count = 0
        self.edges = 0
        self._make_room(2 * ends[contours - 1])
        for contour in range(contours):
            before = ends[contour] - 1
            for i in range(start, ends[contour]):
                x1: cython.double = points[2 * before] / unit
                y1: cython.double = points[2 * before + 1] / unit
                x2: cython.double = points[2 * i] / unit
                y2: cython.double = points[2 * i + 1] / unit
                before = i
                if y1 < y2:
                    self._cut_edge(x1, y1, x2, y2, 1)
                elif y2 < y1:
                    self._cut_edge(x2, y2, x1, y1, -1)
            start = ends[contour]
        self._sort()
        self._sweep()

    @cython.cfunc
    def _make_room(self, edges: cython.Py_ssize_t) -> Any:
        if cython.compiled:
            size: cython.Py_ssize_t = edges * (cython.sizeof(Edge) + 3 * cython.sizeof(cython.int))
            if size > len(self.kept_edges):
                self.kept_edges = bytearray(2 * size)
            self.room = cython.cast(cython.p_char, self.kept_edges)
            self.order = cython.cast(cython.p_int, self.room + edges * cython.sizeof(Edge))
            self.active = self.order + edges
            self.crossing = self.active + edges
        else:
            self.room = [Edge() for _ in range(edges)]
            self.order = [0] * edges
            self.active = [0] * edges
            self.crossing = [0] * edges
            self.segments: list[float] = []

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _cut_edge(
        self, x1: cython.double, y1: cython.double, x2: cython.double, y2: cython.double, winding: cython.int
    ) -> cython.void:
        """Add the parts of a downward edge that matter."""
        slope: cython.double = (x2 - x1) / (y2 - y1)
        first: cython.double = max(y1, self.top)
        last: cython.double = min(y2, self.bottom)
        # In between it is in the box.
        enter: cython.double = first
        leave: cython.double = last
        if x1 < self.left and x2 < self.left:
            enter = leave
        elif x1 < self.left or x2 < self.left:
            y: cython.double = y1 + (self.left - x1) / slope
            if slope > 0:
                enter = min(max(y, first), last)
            else:
                leave = min(max(y, first), last)
        self._add_edge(self.left, first, 0, self.left, enter, winding)
        self._add_edge(self.left, leave, 0, self.left, last, winding)
        if x1 > self.right and x2 > self.right:
            return
        if x1 > self.right:
            enter = max(enter, y1 + (self.right - x1) / slope)
        elif x2 > self.right:
            leave = min(leave, y1 + (self.right - x1) / slope)
        # A point that is not cut off stays exactly where it is.
        first = x1 if enter == y1 else x1 + (enter - y1) * slope
        last = x2 if leave == y2 else x1 + (leave - y1) * slope
        self._add_edge(first, enter, slope, last, leave, winding)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _add_edge(
        self,
        x: cython.double,
        top: cython.double,
        slope: cython.double,
        x_end: cython.double,
        bottom: cython.double,
        winding: cython.int,
    ) -> cython.void:
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        if top >= bottom:
            return
        i: cython.Py_ssize_t = self.edges
        edges[i].x = x
        edges[i].x_end = x_end
        edges[i].top = top
        edges[i].slope = slope
        edges[i].bottom = bottom
        edges[i].winding = winding
        edges[i].sign = 0
        edges[i].left = 0
        edges[i].start = top
        edges[i].segment = -1
        edges[i].before = -1
        edges[i].after = -1
        edges[i].active = False
        edges[i].above = x
        # Contours that go on downward, or, being traced upward, came from there.
        if i and winding > 0 and edges[i - 1].winding > 0 and edges[i - 1].bottom == top and edges[i - 1].x_end == x:
            edges[i].before = i - 1
            edges[i - 1].after = i
        if i and winding < 0 and edges[i - 1].winding < 0 and edges[i - 1].top == bottom and edges[i - 1].x == x_end:
            edges[i - 1].before = i
            edges[i].after = i - 1
        self.order[i] = i
        self.edges += 1

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _sort(self) -> cython.void:
        """Put the edges in the order of their upper ends: Shell's sort."""
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        order: cython.p_int = self.order
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        edge: cython.int
        gap: cython.Py_ssize_t = 1
        while 9 * gap < self.edges:
            gap = 3 * gap + 1
        while gap > 0:
            for i in range(gap, self.edges):
                edge = order[i]
                j = i
                while j >= gap and edges[order[j - gap]].top > edges[edge].top:
                    order[j] = order[j - gap]
                    j -= gap
                order[j] = edge
            gap //= 3

    @cython.cfunc
    def _sweep(self) -> Any:
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        active: cython.p_int = self.active
        count: cython.Py_ssize_t = 0
        joined: cython.Py_ssize_t = 0
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        edge: cython.int
        y: cython.double = 0
        end: cython.double
        # Where the first of the active edges ends.
        nearest: cython.double = self.bottom
        while count or joined < self.edges:
            if count == 0:
                y = edges[self.order[joined]].top
            while joined < self.edges and edges[self.order[joined]].top <= y:
                edge = self.order[joined]
                joined += 1
                if not edges[edge].active:
                    self._insert(count, edge)
                    count += 1
                    nearest = min(nearest, edges[edge].bottom)
            end = min(nearest, edges[self.order[joined]].top) if joined < self.edges else nearest
            self._wind(count, y)
            self._cross(count, y, end)
            y = end
            nearest = self.bottom
            j = 0
            for i in range(count):
                edge = active[i]
                if edges[edge].bottom <= y:
                    if edges[edge].sign:
                        self._add_segment(edge, y)
                    # The one that goes on from it takes its place.
                    edge = edges[edge].after
                    if edge < 0:
                        continue
                    edges[edge].active = True
                else:
                    edges[edge].above = edges[edge].below
                active[j] = edge
                nearest = min(nearest, edges[edge].bottom)
                j += 1
            count = j

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _insert(self, count: cython.Py_ssize_t, edge: cython.int) -> cython.void:
        """Put an edge that begins here in its place among `count` active ones.

        Of edges in the same place those that go into the shape come first, so that pieces side by side make one.
        """
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        active: cython.p_int = self.active
        other: cython.int
        further: cython.double
        while count > 0:
            other = active[count - 1]
            further = edges[other].above - edges[edge].x
            if abs(further) <= _SAME:
                further = edges[other].slope - edges[edge].slope
            if further < -_SAME or (further <= _SAME and edges[other].winding >= edges[edge].winding):
                break
            active[count] = other
            count -= 1
        active[count] = edge

    @cython.cfunc
    def _cross(self, count: cython.Py_ssize_t, y: cython.double, end: cython.double) -> Any:
        """Let the active edges change places where they cross between `y` and `end`, from top to bottom.

        Neighbors do so as long as any are in the wrong order at the bottom, in which they never stand again: that comes
        to an end, however the places of the crossings are rounded.
        """
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        active: cython.p_int = self.active
        i: cython.Py_ssize_t
        edge: cython.int
        other: cython.int
        best: cython.int
        at: cython.double
        before: cython.double = self.left - 1
        ordered: cython.bint = True
        for i in range(count):
            edge = active[i]
            at = edges[edge].x + (end - edges[edge].top) * edges[edge].slope
            edges[edge].below = at
            if at < before:
                ordered = False
            before = at
        if ordered:
            return
        self.waiting = 0
        for i in range(count):
            edges[active[i]].place = i
            edges[active[i]].waits = False
        for i in range(count - 1):
            self._look(i, count, y, end)
        while self.waiting:
            # The first of the crossings; those that came to nothing leave.
            at = end + 1
            best = -1
            i = 0
            while i < self.waiting:
                edge = self.crossing[i]
                if edges[edge].meeting > end:
                    edges[edge].waits = False
                    self.waiting -= 1
                    self.crossing[i] = self.crossing[self.waiting]
                    continue
                if edges[edge].meeting < at:
                    at = edges[edge].meeting
                    best = edge
                i += 1
            if best < 0:
                return
            i = edges[best].place
            other = active[i + 1]
            active[i] = other
            active[i + 1] = best
            edges[other].place = i
            edges[best].place = i + 1
            edges[other].left = edges[best].left
            edges[best].left += edges[other].winding
            self._turn(other, at)
            self._turn(best, at)
            if i > 0:
                self._look(i - 1, count, y, end)
            self._look(i, count, y, end)
            self._look(i + 1, count, y, end)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def _look(
        self, i: cython.Py_ssize_t, count: cython.Py_ssize_t, y: cython.double, end: cython.double
    ) -> cython.void:
        """See where active edge number `i` will change places with the next, if it will."""
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        edge: cython.int = self.active[i]
        other: cython.int
        above: cython.double
        below: cython.double = 0
        if i + 1 < count:
            other = self.active[i + 1]
            below = edges[edge].below - edges[other].below
        if below <= 0:
            edges[edge].meeting = end + 1
            return
        above = max(0, edges[other].above - edges[edge].above)
        edges[edge].meeting = y + (end - y) * above / (above + below)
        if not edges[edge].waits:
            edges[edge].waits = True
            self.crossing[self.waiting] = edge
            self.waiting += 1

    @cython.cfunc
    def _wind(self, count: cython.Py_ssize_t, y: cython.double) -> Any:
        """Find which edges bound the shape from `y` on."""
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        i: cython.Py_ssize_t
        edge: cython.int
        winding: cython.int = 0
        for i in range(count):
            edge = self.active[i]
            if edges[edge].left != winding or edges[edge].top == y:
                edges[edge].left = winding
                self._turn(edge, y)
            winding += edges[edge].winding

    @cython.cfunc
    def _turn(self, edge: cython.int, y: cython.double) -> Any:
        """Give an edge the sign that it has from `y` on."""
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        left: cython.int = edges[edge].left
        right: cython.int = left + edges[edge].winding
        sign: cython.int = (right != 0) - (left != 0) if self.nonzero else (right & 1) - (left & 1)
        if sign != edges[edge].sign:
            if edges[edge].sign:
                self._add_segment(edge, y)
            edges[edge].sign = sign
            edges[edge].start = y
            edges[edge].segment = -1

    @cython.cfunc
    def _add_segment(self, edge: cython.int, end: cython.double) -> Any:
        """Add what of an edge has bounded the shape from its `start` to `end`."""
        edges: cython.pointer[Edge] = cython.cast(cython.pointer(Edge), self.room)
        at: cython.p_double
        start: cython.double = edges[edge].start
        slope: cython.double = edges[edge].slope
        stretch: cython.double = sqrt(slope * slope + 1)
        x: cython.double = edges[edge].x
        x_end: cython.double = edges[edge].x_end
        joined: cython.bint = False
        before: cython.int = edges[edge].before
        if end - start < _SAME:
            return
        if start > edges[edge].top:
            x += (start - edges[edge].top) * slope
        elif before >= 0 and edges[before].segment >= 0 and edges[before].sign == edges[edge].sign:
            joined = True
            self.segments[12 * edges[before].segment + 9] = 1
        if end < edges[edge].bottom:
            x_end = edges[edge].x + (end - edges[edge].top) * slope
        else:
            edges[edge].segment = self.count
        if cython.compiled:
            if self.count == self.capacity:
                self.kept_segments.extend(bytes(96 * (self.capacity + 64)))
                self.capacity = len(self.kept_segments) // 96
                self.segments = cython.cast(cython.p_double, cython.cast(cython.p_char, self.kept_segments))
            at = self.segments + 12 * self.count
            at[0] = x
            at[1] = start
            at[2] = slope / stretch
            at[3] = 1 / stretch
            at[4] = (end - start) * stretch
            at[5] = x_end
            at[6] = end
            at[7] = edges[edge].sign
            at[8] = joined
            at[9] = 0
            at[10] = slope
            at[11] = -1
        else:
            length = (end - start) * stretch
            self.segments += [x, start, slope / stretch, 1 / stretch, length, x_end, end]
            self.segments += [edges[edge].sign, joined, 0, slope, -1]
        self.count += 1
