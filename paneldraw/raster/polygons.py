# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Filled polygons, counted at n x n reference points a pixel, scan line by scan line.

Vertices come in 256ths of a pixel; the lattice of reference points and the rule for points on an edge are those of
`paneldraw.raster.thick`: polygons that share an edge share no pixel and leave none out.
"""

from __future__ import annotations

from typing import Any

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster._floors import floored
    from cython.cimports.paneldraw.raster.supersample import paint
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster._floors import floored
    from paneldraw.raster.supersample import paint
    from paneldraw.raster.surface import Surface

#: An edge of the sub-scanlines ``first <= h < end``, and where it stands in the present one: `bound` is the first
#: sub-pixel at or right of it. From one sub-scanline to the next it moves by a constant, whose whole part is `step`.
#: Fractions come in 62 bits. `next` is an edge that starts in the same row of pixels.
Edge = cython.struct(
    bound=cython.longlong,
    fraction=cython.longlong,
    step=cython.longlong,
    fraction_step=cython.longlong,
    first=cython.int,
    end=cython.int,
    winding=cython.int,
    next=cython.int,
)

_ONE = cython.declare(cython.double, float(1 << 62))


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
    # The rows of pixels that the shape may touch.
    i: cython.Py_ssize_t
    low: cython.longlong = 256 * surface.bottom
    high: cython.longlong = 256 * surface.top
    for i in range(total):
        low = min(low, points[2 * i + 1])
        high = max(high, points[2 * i + 1])
    top: cython.Py_ssize_t = max(surface.top, (low + 127) >> 8)
    bottom: cython.Py_ssize_t = min(surface.bottom, (high + 384) >> 8)
    rows: cython.Py_ssize_t = bottom - top
    if rows <= 0:
        return
    edges: cython.pointer[Edge]
    active: cython.pointer[cython.pointer[Edge]]
    spans: cython.p_Py_ssize_t
    starting: cython.p_int
    if cython.compiled:
        surface.make_room(
            total * (cython.sizeof(Edge) + cython.sizeof(cython.p_int))
            + n * (total + 2) * cython.sizeof(cython.Py_ssize_t)
            + rows * cython.sizeof(cython.int)
        )
        edges = cython.cast(cython.pointer(Edge), surface.room)
        active = cython.cast(cython.pointer(cython.pointer(Edge)), edges + total)
        spans = cython.cast(cython.p_Py_ssize_t, active + total)
        starting = cython.cast(cython.p_int, spans + n * (total + 2))
    else:
        edges = [Edge() for _ in range(total)]
        active = [None] * total
        spans = [0] * (n * (total + 2))
        starting = [0] * rows
    if _collect(points, ends, contours, top, bottom, n, corner, edges, starting):
        _fill(surface, top, bottom, nonzero, n, edges, starting, active, spans)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _collect(
    points: cython.p_longlong,
    ends: cython.p_Py_ssize_t,
    contours: cython.Py_ssize_t,
    top: cython.Py_ssize_t,
    bottom: cython.Py_ssize_t,
    n: cython.int,
    corner: cython.bint,
    edges: cython.pointer[Edge],
    starting: cython.p_int,
) -> cython.int:
    """Find the edges that cross sub-scanlines of these rows; chain those that start in the same row; count them all."""
    middle: cython.longlong = 256 * (n if corner else n - 1)
    count: cython.int = 0
    contour: cython.Py_ssize_t
    i: cython.Py_ssize_t
    before: cython.Py_ssize_t
    start: cython.Py_ssize_t = 0
    row: cython.longlong
    winding: cython.int
    first: cython.longlong
    end: cython.longlong
    for row in range(bottom - top):
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
            first = max((2 * n * y1 + middle + 511) >> 9, top * n)
            end = min((2 * n * y2 + middle + 511) >> 9, bottom * n)
            if first >= end:
                continue
            _place(cython.address(edges[count]), x1, y1, x2 - x1, y2 - y1, first, n, middle)
            edges[count].first = first
            edges[count].end = end
            edges[count].winding = winding
            row = (first - top * n) // n
            edges[count].next = starting[row]
            starting[row] = count
            count += 1
        start = ends[contour]
    return count


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _place(
    edge: cython.pointer[Edge],
    x1: cython.longlong,
    y1: cython.longlong,
    dx: cython.longlong,
    dy: cython.longlong,
    first: cython.longlong,
    n: cython.int,
    middle: cython.longlong,
) -> cython.void:
    """Find the bound in the first sub-scanline, and its step.

    A bound is a whole number or at least 1 / dy away from one. It is taken a quarter of that too large, and all errors
    of rounding are smaller, so that its whole part is exact.
    """
    rest: cython.longlong = dx * (512 * first - middle - 2 * n * y1) + dy * (2 * n * x1 + middle)
    bound: cython.double = (((rest - 1) >> 9) + dy + 0.25) / dy
    step: cython.double = dx / cython.cast(cython.double, dy)
    edge.bound = floored(bound)
    edge.step = floored(step)
    if cython.compiled:
        edge.fraction = cython.cast(cython.longlong, (bound - edge.bound) * _ONE)
        edge.fraction_step = cython.cast(cython.longlong, (step - edge.step) * _ONE)
    else:
        edge.fraction = int((bound - edge.bound) * _ONE)
        edge.fraction_step = int((step - edge.step) * _ONE)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _fill(
    surface: Surface,
    top: cython.Py_ssize_t,
    bottom: cython.Py_ssize_t,
    nonzero: cython.bint,
    n: cython.int,
    edges: cython.pointer[Edge],
    starting: cython.p_int,
    active: cython.pointer[cython.pointer[Edge]],
    spans: cython.p_Py_ssize_t,
) -> cython.void:
    """Keep the edges of the present row in the order of their crossings; between these lie the spans."""
    y: cython.Py_ssize_t
    row: cython.int
    crossing: cython.int = 0
    count: cython.int
    next: cython.int
    i: cython.int
    j: cython.int
    winding: cython.int
    outside: cython.bint
    bound: cython.longlong
    before: cython.longlong
    edge: cython.pointer[Edge]
    one: cython.longlong = 1
    whole: cython.longlong = (one << 62) - 1
    # The first row above which no active edge ends, and whether the edges are in order.
    soonest: cython.int = 0
    in_order: cython.bint = True
    for y in range(top, bottom):
        if soonest <= y * n:
            soonest = bottom * n + 1
            j = 0
            for i in range(crossing):
                active[j] = active[i]
                if active[i].end > y * n:
                    soonest = min(soonest, active[i].end)
                    j += 1
            crossing = j
        next = starting[y - top]
        while next >= 0:
            edge = cython.address(edges[next])
            active[crossing] = edge
            crossing += 1
            soonest = min(soonest, edge.end)
            next = edge.next
            in_order = False
        if crossing == 0:
            continue
        count = 0
        for row in range(y * n, y * n + n):
            if not in_order:
                _sort(active, crossing)
                in_order = True
            winding = 0
            before = active[0].bound
            for i in range(crossing):
                edge = active[i]
                bound = edge.bound
                if edge.first <= row < edge.end:
                    outside = winding == 0
                    winding += edge.winding
                    spans[count] = bound
                    count += not nonzero or outside or winding == 0
                    edge.fraction += edge.fraction_step
                    bound += edge.step + (edge.fraction >> 62)
                    edge.bound = bound
                    edge.fraction &= whole
                in_order &= i == 0 or before <= bound
                before = bound
        paint(surface, y, spans, count >> 1, n)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _sort(active: cython.pointer[cython.pointer[Edge]], crossing: cython.int) -> cython.void:
    """Sort edges by their bounds.

    From one sub-scanline to the next their order hardly changes: insertion sort, by way of Shell's if there are so many
    that a new one may have far to go.
    """
    gap: cython.int = 1
    i: cython.int
    j: cython.int
    bound: cython.longlong
    edge: cython.pointer[Edge]
    while 9 * gap < crossing:
        gap = 3 * gap + 1
    while gap > 0:
        for i in range(gap, crossing):
            edge = active[i]
            bound = edge.bound
            j = i
            while j >= gap and active[j - gap].bound > bound:
                active[j] = active[j - gap]
                j -= gap
            active[j] = edge
        gap //= 3
