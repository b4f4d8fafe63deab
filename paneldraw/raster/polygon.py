"""Filled polygons: the spans between the edges that cross a sub-scanline.

Points come in 256ths of a pixel, within +-2**25. A reference point on an edge is inside if the inside lies to its right
or, on a horizontal edge, below: polygons that share an edge share no point and leave none out.
"""

import cython
from cython.cimports.paneldraw.raster.coverage import FRACTION, MOST, STEEP, Edge, place
from cython.cimports.paneldraw.raster.floors import floored


def polygon(coverage, points, ends, contours, nonzero):
    """Fill the shape with these contours, by the non-zero rule or else by the even-odd one.

    Contour k is closed and has the points (x, y) from number ``ends[k - 1]`` (0 for the first) up to ``ends[k]``. It
    may cross itself and others.
    """
    i: cython.Py_ssize_t
    total: cython.Py_ssize_t = ends[contours - 1] if contours else 0
    n: cython.longlong = coverage.n
    block: cython.longlong = coverage.block
    # The sub-scanlines that the shape may touch, and the blocks that hold them.
    low: cython.longlong = coverage.end
    high: cython.longlong = coverage.first
    for i in range(total):
        h: cython.longlong = (2 * n * points[2 * i + 1] + coverage.middle + 511) >> 9
        low = min(low, h)
        high = max(high, h)
    low = max(low, coverage.first)
    high = min(high, coverage.end)
    if low >= high:
        return
    top: cython.longlong = (low - coverage.first) // block
    bottom: cython.longlong = (high - 1 - coverage.first) // block + 1
    edges: cython.pointer[Edge]
    active: cython.pointer[cython.pointer[Edge]]
    sides: cython.pointer[cython.pointer[Edge]]
    spans: cython.p_longlong
    starting: cython.p_int
    if cython.compiled:
        room: cython.Py_ssize_t = total * (cython.sizeof(Edge) + 2 * cython.sizeof(cython.p_char))
        room += (n * total + 2) * cython.sizeof(cython.longlong) + (bottom - top) * cython.sizeof(cython.int)
        edges = cython.cast(cython.pointer(Edge), coverage.scratch(room))
        spans = cython.cast(cython.p_longlong, edges + total)
        active = cython.cast(cython.pointer(cython.pointer(Edge)), spans + n * total + 2)
        sides = active + total
        starting = cython.cast(cython.p_int, sides + total)
    else:
        edges = [Edge() for _ in range(total)]
        spans = [0] * (n * total + 2)
        active, sides = [None] * total, [None] * total
        starting = [0] * (bottom - top)
    if not _collect(coverage, points, ends, contours, top, bottom, edges, starting):
        return
    if coverage.partial:
        _sweep(coverage, top, bottom, nonzero, edges, starting, active, sides, spans)
    else:
        _fill_rows(coverage, top, bottom, nonzero, edges, starting, active)


def _collect(coverage, points, ends, contours, top, bottom, edges, starting):
    """Find the edges that cross these blocks; chain those that start in the same block; count them all."""
    count: cython.int = 0
    contour: cython.Py_ssize_t
    i: cython.Py_ssize_t
    before: cython.Py_ssize_t
    start: cython.Py_ssize_t = 0
    row: cython.longlong
    n: cython.longlong = coverage.n
    block: cython.longlong = coverage.block
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
            winding: cython.int = 1
            if y2 < y1:
                x1, y1, x2, y2 = x2, y2, x1, y1
                winding = -1
            # Sub-scanline h lies at 512 h - middle on the lattice.
            first: cython.longlong = max((2 * n * y1 + coverage.middle + 511) >> 9, coverage.first + top * block)
            end: cython.longlong = min((2 * n * y2 + coverage.middle + 511) >> 9, coverage.end)
            if first >= end:
                continue
            edges[count].first = first
            edges[count].end = end
            edges[count].winding = winding
            edge: cython.pointer[Edge] = cython.address(edges[count]) if cython.compiled else edges[count]
            _place(coverage, edge, x1, y1, x2 - x1, y2 - y1)
            row = (first - coverage.first) // block - top
            edges[count].next = starting[row]
            starting[row] = count
            count += 1
        start = ends[contour]
    return count


def _place(coverage, edge, x1, y1, dx, dy):
    """Find the bound in the edge's first sub-scanline, and its step.

    A bound is a whole number or at least 1 / dy away from one. It is taken a quarter of that too large, and all errors
    of rounding are smaller, so that its whole part is exact.
    """
    scale: cython.longlong = 2 * coverage.n
    one: cython.longlong = 1
    down: cython.longlong = 512 * edge.first - coverage.middle - scale * y1
    rest: cython.longlong = dx * down + dy * (scale * x1 + coverage.middle)
    bound: cython.double = (((rest - 1) >> 9) + dy + 0.25) / dy
    step: cython.double = dx / cython.cast(cython.double, dy)
    edge.bound = floored(bound)
    edge.step = floored(step)
    edge.fraction = floored((bound - edge.bound) * (one << FRACTION))
    edge.fraction_step = floored((step - edge.step) * (one << FRACTION))


def _fill_rows(coverage, top, bottom, nonzero, edges, starting, active):
    """Fill a shape whose sub-scanlines are whole rows: spans lie between its edges in the order of their crossings.

    Beside `_sweep` because a filled triangle takes a tenth fewer instructions so, a polygon of twelve points a sixth.
    """
    i: cython.int
    left: cython.longlong = 0
    crossing: cython.int = 0
    # By the even-odd rule a winding is odd or even.
    kept: cython.int = -1 if nonzero else 1
    soonest: cython.longlong = coverage.first
    row: cython.longlong = top
    while row < bottom:
        y: cython.longlong = coverage.first + row
        if soonest <= y or starting[row - top] >= 0:
            crossing = _renew(edges, active, crossing, starting[row - top], y)
            soonest = _first_end(active, crossing, coverage.end)
        if crossing == 2:
            rows: cython.int = 1
            most: cython.longlong = min(soonest - y, MOST)
            while rows < most and starting[row + rows - top] < 0:
                rows += 1
            coverage.paint_between(y, rows, active)
            _step(active[0], rows)
            _step(active[1], rows)
            row += rows
            continue
        _put_in_order(active, crossing)
        winding: cython.int = 0
        for i in range(crossing):
            edge: cython.pointer[Edge] = active[i]
            outside: cython.bint = winding == 0
            winding = (winding + edge.winding) & kept
            if outside:
                left = edge.bound
            elif winding == 0:
                coverage.surface.span(y, left, edge.bound)
            _step(edge, 1)
        row += 1


def _renew(edges, active, crossing, next, h):
    """Leave out edges that end before sub-scanline `h`, add those chained from number `next` on, and count them all."""
    i: cython.int
    count: cython.int = 0
    for i in range(crossing):
        active[count] = active[i]
        count += active[i].end > h
    while next >= 0:
        active[count] = cython.address(edges[next]) if cython.compiled else edges[next]
        next = active[count].next
        count += 1
    return count


def _first_end(active, crossing, end):
    """The first sub-scanline, up to `end`, before which one of these edges ends."""
    i: cython.int
    for i in range(crossing):
        end = min(end, active[i].end)
    return end


def _last_start(active, crossing, start):
    """The last sub-scanline, from `start` on, that is the first one of one of these edges."""
    i: cython.int
    for i in range(crossing):
        start = max(start, active[i].first)
    return start


def _sweep(coverage, top, bottom, nonzero, edges, starting, active, sides, spans):
    """Keep the edges of the present block in the order of their crossings, between which spans lie."""
    row: cython.longlong
    block: cython.longlong = coverage.block
    crossing: cython.int = 0
    # The first sub-scanline before which no active edge ends; the last one before which one begins.
    soonest: cython.longlong = coverage.first
    latest: cython.longlong = coverage.first
    row = top
    while row < bottom:
        begin: cython.longlong = coverage.first + row * block
        lines: cython.int = cython.cast(cython.int, block)
        if soonest <= begin or starting[row - top] >= 0:
            crossing = _renew(edges, active, crossing, starting[row - top], begin)
            soonest = _first_end(active, crossing, coverage.end)
            latest = _last_start(active, crossing, coverage.first)
        _put_in_order(active, crossing)
        rows: cython.int = 0
        if latest <= begin and begin + block <= soonest:
            # What the same edges cross in the same order is taken at once.
            most: cython.longlong = min(bottom - row, min(soonest - begin, MOST) // block)
            rows = 1
            while rows < most and coverage.filter is None and starting[row + rows - top] < 0:
                rows += 1
            rows = _rows_in_order(active, crossing, lines, rows)
        if rows > 0 and _take_block(coverage, active, crossing, begin, rows * lines, nonzero, sides):
            row += rows
            continue
        row += 1
        if coverage.filter is not None:
            _take_unsteady_block(coverage, active, crossing, begin, lines, nonzero, sides)
        else:
            _take_row(coverage, active, crossing, begin, nonzero, spans)


def _rows_in_order(active, crossing, lines, rows):
    """In how many of the next rows, of so many sub-scanlines each, edges stay in order: so many, or half of it, ..."""
    while rows * lines > 1 and not _stay_in_order(active, crossing, rows * lines):
        rows >>= 1
    return rows


def _stay_in_order(active, crossing, lines):
    """Whether edges that are in order stay so for some sub-scanlines: then they are sides of the same spans."""
    i: cython.int
    k: cython.int
    last: cython.longlong = lines - 1
    end: cython.longlong = 0
    for i in range(crossing):
        b: cython.pointer[Edge] = active[i]
        before: cython.longlong = end
        end = place(b, last)
        if i == 0:
            continue
        a: cython.pointer[Edge] = active[i - 1]
        if before > end:
            return False
        # Between two sub-scanlines with sub-pixels between the edges there are sub-pixels between them everywhere.
        above: cython.bint = a.bound < b.bound
        k = 1
        while k < lines and not (above and before < end):
            at: cython.int = lines - 1 - k if above else k
            gap: cython.longlong = place(b, at) - place(a, at)
            if gap < 0:
                return False
            if gap > 0 and (above or before < end):
                break
            k += 1
    return True


def _take_block(coverage, active, crossing, h, lines, nonzero, sides):
    """Let edges run through a block of sub-scanlines from `h` on; those at which spans begin and end are its sides.

    Returns False where that has to be done line by line.
    """
    i: cython.int
    count: cython.int = 0
    winding: cython.int = 0
    if nonzero:
        for i in range(crossing):
            outside: cython.bint = winding == 0
            winding += active[i].winding
            sides[count] = active[i]
            count += outside or winding == 0
    if not coverage.block_of_edges(h, lines, sides if nonzero else active, count if nonzero else crossing):
        return False
    for i in range(crossing):
        _step(active[i], lines)
    return True


def _take_row(coverage, active, crossing, h, nonzero, spans):
    """Take a row of pixels, the first sub-scanline of which is `h`, line by line."""
    k: cython.longlong
    count: cython.int = 0
    n: cython.longlong = coverage.n
    for k in range(n):
        if k > 0:
            _put_in_order(active, crossing)
        count = _spans(active, crossing, h + k, nonzero, spans, count)
    coverage.row_of_spans(h // n, spans, count >> 1)


def _take_unsteady_block(coverage, active, crossing, h, lines, nonzero, before):
    """Weigh a block in which some edges begin, end or cross; the others as one, whatever those do.

    So what lies beside, seen or not, changes nothing.
    """
    i: cython.int
    for i in range(crossing):
        before[i] = active[i]
        active[i].turns = 0
        active[i].kept, active[i].kept_fraction = active[i].bound, active[i].fraction
    _walk(active, crossing, h, nonzero, None, lines)
    coverage.reach_for(h, lines)
    for i in range(crossing):
        edge: cython.pointer[Edge] = before[i]
        active[i] = edge  # where edges meet, the second walk has to take them in the same order
        edge.bound, edge.fraction = edge.kept, edge.kept_fraction
        if _steady(edge, lines):
            coverage.end_span(place(edge, lines // 2), edge.turns > 0)
    _walk(active, crossing, h, nonzero, coverage, lines)


def _walk(active, crossing, h, nonzero, coverage, lines):
    """Walk through a block: without coverage, count which edges are sides of spans; with it, weigh those not steady."""
    i: cython.int
    k: cython.int
    for k in range(lines):
        winding: cython.int = 0
        if coverage is not None:
            coverage.reach_for(h + k, 1)
        for i in range(crossing):
            edge: cython.pointer[Edge] = active[i]
            if not edge.first <= h + k < edge.end:
                continue
            outside: cython.bint = winding == 0
            winding = winding + edge.winding if nonzero else 1 - winding
            if outside or winding == 0:
                if coverage is None:
                    edge.turns += 1 if outside else -1
                elif not _steady(edge, lines):
                    coverage.end_span(edge.bound, outside)
            _step(edge, 1)
        _put_in_order(active, crossing)


def _steady(edge, lines):
    """Whether a block of sub-scanlines can be weighed as one at an edge."""
    return (edge.turns == lines or edge.turns == -lines) and -STEEP <= edge.step < STEEP


def _step(edge, lines):
    """Let an edge move to a sub-scanline below."""
    one: cython.longlong = 1
    edge.fraction += lines * edge.fraction_step
    edge.bound += lines * edge.step + (edge.fraction >> FRACTION)
    edge.fraction &= (one << FRACTION) - 1


def _spans(active, crossing, h, nonzero, spans, count):
    """Write the ends of the spans of a sub-scanline behind others; return how many there are now.

    Its edges step to the next one.
    """
    i: cython.int
    winding: cython.int = 0
    for i in range(crossing):
        edge: cython.pointer[Edge] = active[i]
        if edge.first <= h < edge.end:
            outside: cython.bint = winding == 0
            winding += edge.winding
            spans[count] = edge.bound
            count += not nonzero or outside or winding == 0
            _step(edge, 1)
    return count


def _put_in_order(active, crossing):
    """Sort edges by their bounds, if they are not in order."""
    i: cython.int
    for i in range(1, crossing):
        if active[i - 1].bound > active[i].bound:
            _sort(active, crossing)
            return


def _sort(active, crossing):
    """Sort edges by their bounds; those that meet keep their order, however many others there are.

    From one sub-scanline to the next their order hardly changes: insertion sort, by way of Shell's if there are so many
    that a new one may have far to go.
    """
    gap: cython.int = 1
    i: cython.int
    j: cython.int
    while 36 * gap < crossing:
        gap = 3 * gap + 1
    for i in range(crossing):
        active[i].rank = i
    while gap > 0:
        for i in range(gap, crossing):
            edge: cython.pointer[Edge] = active[i]
            j = i
            while j >= gap and _is_behind(active[j - gap], edge):
                active[j] = active[j - gap]
                j -= gap
            active[j] = edge
        gap //= 3


def _is_behind(a, b):
    """Whether edge `a` belongs behind edge `b`."""
    return a.bound > b.bound or (a.bound == b.bound and a.rank > b.rank)
