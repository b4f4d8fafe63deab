# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Filled polygons, counted at n x n reference points a pixel, scan line by scan line.

Vertices come in 256ths of a pixel; the lattice of reference points and the rule for points on an edge are those of
`paneldraw.raster.thick`: polygons that share an edge share no pixel and leave none out.
"""

from __future__ import annotations

from typing import Any

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.supersample import paint
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.supersample import paint
    from paneldraw.raster.surface import Surface

#: An edge, and where it stands in the present sub-scanline: `bound` is the first sub-pixel at or right of it. From one
#: sub-scanline to the next it moves by a constant fraction, which is kept as a quotient and a remainder.
Edge = cython.struct(
    first=cython.longlong,
    end=cython.longlong,
    bound=cython.longlong,
    rest=cython.longlong,
    step=cython.longlong,
    rest_step=cython.longlong,
    divisor=cython.longlong,
    winding=cython.int,
    next=cython.int,
)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _floor_div(a: cython.longlong, b: cython.longlong) -> cython.longlong:
    """Floor of a / b for b > 0; a division in C truncates."""
    return a // b if a >= 0 else -((b - 1 - a) // b)


@cython.cfunc
def polygons(
    surface: Surface,
    points: cython.p_longlong,
    ends: cython.p_Py_ssize_t,
    contours: cython.Py_ssize_t,
    nonzero: cython.bint,
    n: cython.int,
    corner: cython.bint,
) -> Any:
    """Fill the shape with these contours, by the non-zero rule or else by the even-odd one.

    Contour k is closed and has the points (x, y) from number ``ends[k - 1]`` (0 for the first) up to ``ends[k]``. It
    may cross itself and others. Points lie within +-2**18 pixels.
    """
    total: cython.Py_ssize_t = ends[contours - 1] if contours else 0
    rows: cython.Py_ssize_t = surface.bottom - surface.top
    edges: cython.pointer[Edge]
    starting: cython.p_int
    active: cython.p_int
    spans: cython.p_Py_ssize_t
    if cython.compiled:
        surface.make_room(
            total * cython.sizeof(Edge)
            + n * (total + 2) * cython.sizeof(cython.Py_ssize_t)
            + (rows + total) * cython.sizeof(cython.int)
        )
        edges = cython.cast(cython.pointer(Edge), surface.room)
        spans = cython.cast(cython.p_Py_ssize_t, edges + total)
        starting = cython.cast(cython.p_int, spans + n * (total + 2))
        active = starting + rows
    else:
        edges = [Edge() for _ in range(total)]
        spans = [0] * (n * (total + 2))
        starting = [0] * rows
        active = [0] * total
    if _collect(surface, points, ends, contours, n, corner, edges, starting):
        _fill(surface, nonzero, n, edges, starting, active, spans)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _collect(
    surface: Surface,
    points: cython.p_longlong,
    ends: cython.p_Py_ssize_t,
    contours: cython.Py_ssize_t,
    n: cython.int,
    corner: cython.bint,
    edges: cython.pointer[Edge],
    starting: cython.p_int,
) -> cython.int:
    """Find the edges that cross visible sub-scanlines; chain those that start in the same row. Returns their number."""
    middle: cython.longlong = 256 * (n if corner else n - 1)
    count: cython.int = 0
    contour: cython.Py_ssize_t
    i: cython.Py_ssize_t
    before: cython.Py_ssize_t
    start: cython.Py_ssize_t = 0
    winding: cython.int
    row: cython.longlong
    first: cython.longlong
    end: cython.longlong
    rest: cython.longlong
    for row in range(surface.bottom - surface.top):
        starting[row] = -1
    for contour in range(contours):
        before = ends[contour] - 1
        for i in range(start, ends[contour]):
            x1: cython.longlong = points[2 * before]
            y1: cython.longlong = points[2 * before + 1]
            x2: cython.longlong = points[2 * i]
            y2: cython.longlong = points[2 * i + 1]
            before = i
            winding = 1
            if y2 < y1:
                x1, y1, x2, y2 = x2, y2, x1, y1
                winding = -1
            # Sub-scanline h lies at 512 h - middle, in 512ths of a sub-pixel.
            first = max(_floor_div(2 * n * y1 + middle + 511, 512), surface.top * n)
            end = min(_floor_div(2 * n * y2 + middle + 511, 512), surface.bottom * n)
            if first >= end:
                continue
            dx: cython.longlong = x2 - x1
            dy: cython.longlong = y2 - y1
            rest = dx * (512 * first - middle - 2 * n * y1) + dy * (2 * n * x1 + middle)
            rest = _floor_div(rest - 1, 512) + dy
            edges[count].first = first
            edges[count].end = end
            edges[count].divisor = dy
            edges[count].winding = winding
            edges[count].bound = _floor_div(rest, dy)
            edges[count].rest = rest - edges[count].bound * dy
            edges[count].step = _floor_div(dx, dy)
            edges[count].rest_step = dx - edges[count].step * dy
            row = _floor_div(first, n) - surface.top
            edges[count].next = starting[row]
            starting[row] = count
            count += 1
        start = ends[contour]
    return count


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _fill(
    surface: Surface,
    nonzero: cython.bint,
    n: cython.int,
    edges: cython.pointer[Edge],
    starting: cython.p_int,
    active: cython.p_int,
    spans: cython.p_Py_ssize_t,
) -> cython.void:
    """Keep the edges of the present row in the order of their crossings; between these lie the spans."""
    y: cython.Py_ssize_t
    row: cython.longlong
    crossing: cython.int = 0
    count: cython.int
    start: cython.int
    edge: cython.int
    gap: cython.int
    i: cython.int
    j: cython.int
    winding: cython.int
    inside: cython.bint
    was_inside: cython.bint
    for y in range(surface.top, surface.bottom):
        # Edges that ended above leave; those that start in this row join.
        j = 0
        for i in range(crossing):
            if edges[active[i]].end > y * n:
                active[j] = active[i]
                j += 1
        crossing = j
        edge = starting[y - surface.top]
        while edge >= 0:
            active[crossing] = edge
            crossing += 1
            edge = edges[edge].next
        if crossing == 0:
            continue
        count = 0
        for row in range(y * n, y * n + n):
            # From one sub-scanline to the next the order hardly changes: insertion sort, by way of Shell's if there
            # are so many edges that a new one may have far to go.
            gap = 1
            while 9 * gap < crossing:
                gap = 3 * gap + 1
            while gap > 0:
                for i in range(gap, crossing):
                    edge = active[i]
                    j = i
                    while j >= gap and edges[active[j - gap]].bound > edges[edge].bound:
                        active[j] = active[j - gap]
                        j -= gap
                    active[j] = edge
                gap //= 3
            winding = 0
            was_inside = False
            start = count
            for i in range(crossing):
                edge = active[i]
                if row < edges[edge].first or row >= edges[edge].end:
                    continue
                winding += edges[edge].winding
                inside = winding != 0 if nonzero else winding & 1
                if inside != was_inside:
                    spans[count] = edges[edge].bound
                    count += 1
                    was_inside = inside
                edges[edge].bound += edges[edge].step
                edges[edge].rest += edges[edge].rest_step
                if edges[edge].rest >= edges[edge].divisor:
                    edges[edge].rest -= edges[edge].divisor
                    edges[edge].bound += 1
            if surface.weighing:
                for i in range(start, count, 2):
                    surface.weigh(y, row - y * n, spans[i], spans[i + 1])
        paint(surface, y, spans, count >> 1, n)
