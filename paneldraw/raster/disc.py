"""Discs and rings, of circles, ellipses and rectangles with round or sharp corners, and parts of them.

Coordinates come in 256ths of a pixel. A ring is the curve drawn with some width; a disc has the same outer edge.
A reference point on an edge is inside if the inside lies to its right or, on a horizontal edge, below. On a curve that
is decided in floating point: for points within 1/256 of a pixel of it, the one or the other side may be taken.
"""

import cython
from cython.cimports.libc.math import sqrt
from cython.cimports.paneldraw.raster.coverage import STEEP
from cython.cimports.paneldraw.raster.floors import floored
from cython.cimports.paneldraw.raster.thick_line import half_plane

#: The length of the vectors that say where a part begins and ends.
UNIT = 1 << 27
_UNIT = cython.declare(cython.longlong, UNIT)
_ENDLESS = cython.declare(cython.longlong, 1 << 61)

_SQUARE = cython.declare(cython.int, 1)
_ROUND = cython.declare(cython.int, 2)

if not cython.compiled:
    Round, Edges = type("Round", (), {}), type("Edges", (), {})


def disc(coverage, shape, width, part):
    """All that the curve encloses, and half of `width` beyond it; of that what is in `part`, unless that is None."""
    _sweep(coverage, shape, width, False, part)


def ring(coverage, shape, width, part):
    """The curve drawn with `width`, half on either side; of that what is in `part`, unless that is None."""
    _sweep(coverage, shape, width, True, part)


def _sweep(coverage, shape, width, hollow, part):
    """Find the curve's two edges, and the spans between them."""
    edges: Edges
    outer: Round
    inner: Round
    middle: Round
    if not cython.compiled:
        edges, outer, inner, middle = Edges(), Round(), Round(), Round()
    edges.outer = cython.address(outer) if cython.compiled else outer
    edges.inner = cython.address(inner) if cython.compiled else inner
    edges.middle = cython.address(middle) if cython.compiled else middle
    n: cython.longlong = coverage.n
    edges.half = n * width
    _grow(edges.outer, shape, n, edges.half)
    _grow(edges.middle, shape, n, 0)
    edges.hollow = hollow and _grow(edges.inner, shape, n, -edges.half)
    # A square cap may reach out of the ring.
    beyond: cython.longlong = edges.half if part is not None and part.cap == _SQUARE else 0
    first: cython.longlong = (outer.top - outer.b - beyond + coverage.middle + 511) >> 9
    last: cython.longlong = (outer.bottom + outer.b + beyond + coverage.middle + 511) >> 9
    first = max(first, coverage.first)
    last = min(last, coverage.end)
    to: cython.pointer[Edges] = cython.address(edges) if cython.compiled else edges
    if coverage.filter is not None:
        _blocks(coverage, to, part, first, last)
    elif coverage.partial:
        _rows(coverage, to, part, first, last)
    else:
        _lines(coverage, to, part, first, last)


def _lines(coverage, edges, part, first, last):
    """Take one sub-scanline after the other."""
    h: cython.longlong
    ends: cython.longlong[32]
    if not cython.compiled:
        ends = [0] * 32
    for h in range(first, last):
        coverage.spans(h, ends, _spans(coverage, edges, part, h, ends))


def _rows(coverage, edges, part, first, last):
    """Take a row of pixels in one call: a third fewer instructions."""
    h: cython.longlong
    i: cython.int
    ends: cython.longlong[512]
    line: cython.longlong[32]
    if not cython.compiled:
        ends, line = [0] * 512, [0] * 32
    n: cython.longlong = coverage.n
    while first < last:
        y: cython.longlong = first // n
        end: cython.longlong = min(last, (y + 1) * n)
        count: cython.int = 0
        for h in range(first, end):
            if part is None:
                count += _between(edges, 512 * h - coverage.middle, ends, 2 * count)
                continue
            more: cython.int = _cut(coverage, edges, part, h, line)
            for i in range(2 * more):
                ends[2 * count + i] = line[i]
            count += more
        for i in range(2 * count):
            ends[i] = (ends[i] + coverage.middle + 511) >> 9
        coverage.row_of_spans(y, ends, count)
        first = end


def _blocks(coverage, edges, part, first, last):
    """Take a block of sub-scanlines as one where their ends lie on straight and steep lines."""
    # The ends in the first sub-scanline of a block, of the next block, and in the middle.
    early: cython.longlong[32]
    late: cython.longlong[32]
    middle: cython.longlong[32]
    if not cython.compiled:
        early, late, middle = [0] * 32, [0] * 32, [0] * 32
    above: cython.p_longlong = early
    below: cython.p_longlong = late
    ends: cython.p_longlong = middle
    block: cython.int = coverage.block
    h: cython.longlong
    begin: cython.longlong = first - (first - coverage.first) % block
    many: cython.int = -1
    while begin < last:
        count: cython.int = -1
        if begin >= first and begin + block <= last:
            if many < 0:
                many = _spans(coverage, edges, part, begin, above)
            count = _spans(coverage, edges, part, begin + block, below)
            if count == many and (
                _spans(coverage, edges, part, begin + block // 2, ends) == count
                and _are_steep(above, ends, below, count, block)
            ):
                coverage.block_of_spans(begin, ends, count)
                above, below = below, above
                begin += block
                continue
        for h in range(max(begin, first), min(begin + block, last)):
            coverage.spans(h, ends, _spans(coverage, edges, part, h, ends))
        above, below = below, above
        many = count
        begin += block


def _are_steep(above, ends, below, count, block):
    """Whether ends move straight, and not far, from the first sub-scanline of a block by its middle to the next one."""
    i: cython.int
    for i in range(2 * count):
        if abs(below[i] - above[i]) > STEEP * block:
            return False
        # The middle is as many halves from the one as from the other, less one.
        if abs((block + 1) * above[i] + (block - 1) * below[i] - 2 * block * ends[i]) > 2 * block:
            return False
    return True


def _spans(coverage, edges, part, h, ends):
    """Write the ends of the spans of a sub-scanline, in sub-pixels; return how many spans there are."""
    i: cython.int
    count: cython.int = _cut(coverage, edges, part, h, ends)
    for i in range(2 * count):
        ends[i] = (ends[i] + coverage.middle + 511) >> 9
    return count


def _cut(coverage, edges, part, h, ends):
    """The same on the lattice."""
    y: cython.longlong = 512 * h - coverage.middle
    count: cython.int = _between(edges, y, ends, 0)
    if part is not None:
        count = part.cut(ends, count, y, edges.middle, edges.half, coverage.n)
    return count


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _between(edges: cython.pointer[Edges], y: cython.longlong, ends: cython.p_longlong, at: cython.int) -> cython.int:
    """Write the ends of what is between the edges at height `y` from place `at` on; return how many spans that is."""
    if not _across(edges.outer, y, ends, at):
        return 0
    if not edges.hollow or not _across(edges.inner, y, ends, at + 2):
        return 1
    # From the outer edge to the inner one, and from the inner to the outer.
    left: cython.longlong = ends[at + 2]
    right: cython.longlong = ends[at + 3]
    ends[at + 3] = ends[at + 1]
    ends[at + 2] = max(right, ends[at])
    ends[at + 1] = min(left, ends[at + 1])
    return 2


def _grow(grown, shape, n, outward):
    """The curve on the lattice, `outward` of the given one; return whether anything is inside.

    The radii grow or shrink; what they cannot shrink the box does, whose corners are sharp then.
    """
    a: cython.longlong = outward + (0 if shape.sharp else 2 * n * shape.a)
    b: cython.longlong = outward + (0 if shape.sharp else 2 * n * shape.b)
    x: cython.longlong = a if shape.sharp else min(a, 0)
    y: cython.longlong = b if shape.sharp else min(b, 0)
    grown.a = 0 if shape.sharp else max(a, 0)
    grown.b = 0 if shape.sharp else max(b, 0)
    grown.left = 2 * n * shape.left - x
    grown.top = 2 * n * shape.top - y
    grown.right = 2 * n * shape.right + x
    grown.bottom = 2 * n * shape.bottom + y
    return grown.left <= grown.right and grown.top <= grown.bottom


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _across(shape: cython.pointer[Round], y: cython.longlong, ends: cython.p_longlong, at: cython.int) -> cython.bint:
    """Write the ends of what is inside the curve at height `y` from place `at` on; return whether it gets there.

    Inlined, like `_between`, because a disc takes a tenth fewer instructions so.
    """
    away: cython.longlong = max(shape.top - y, y - shape.bottom, 0)
    if away > shape.b or y >= shape.bottom + shape.b:
        return False
    reach: cython.double = shape.a
    if away > 0:
        height: cython.double = shape.b
        share: cython.double = away
        root: cython.double = sqrt((height - share) * (height + share))
        reach = root if shape.a == shape.b else reach * root / height
    whole: cython.longlong = floored(reach)
    ends[at] = shape.left - whole
    ends[at + 1] = shape.right + whole + (reach > whole)
    return True


@cython.final
@cython.cclass
class Part:
    """A part of a disc or ring: a choice of quadrants, or the angle clockwise from one vector to another.

    Parameters
    ----------
    quadrants : int
        Bits counterclockwise from the top right one, with each the pixels on its axes; 0 for an angle.
    start, end : tuple of int
        Vectors of length `UNIT`.
    reflex : bool
        Whether the angle is more than half a turn.
    spokes : bool
        Whether bars as wide as the ring lead from the center to its two ends, joined by a dot: a sector's outline.
    cap : int
        What ends the ring: 0 nothing, 1 half a square, 2 half a disc.
    """

    def __init__(self, quadrants, start, end, reflex, spokes, cap):
        self.quadrants = quadrants
        self.start_x, self.start_y = start
        self.end_x, self.end_y = end
        self.reflex = reflex
        self.spokes = spokes
        self.cap = cap

    def cut(self, ends, count, y, middle, half, n):
        """Cut the spans of a sub-scanline; return how many there are now."""
        i: cython.int
        x: cython.longlong = middle.left
        there: cython.bint = count > 0
        first: cython.longlong = ends[0] if there else 0
        last: cython.longlong = ends[2 * count - 1] if there else 0
        y -= middle.top
        for i in range(2 * count):
            ends[i] -= x
        count = self._quarters(ends, count, y, 256 * n) if self.quadrants else self._wedge(ends, count, y)
        start: cython.int = count
        if self.spokes and there:
            for i in range(2):
                vx: cython.longlong = self.end_x if i else self.start_x
                vy: cython.longlong = self.end_y if i else self.start_y
                _add_bar(ends, 2 * count, 0, y, vx, vy, _ENDLESS, half)
                ends[2 * count] = max(ends[2 * count], first - x)
                ends[2 * count + 1] = min(ends[2 * count + 1], last - x)
                count += 1
            count = _add_dot(ends, count, 0, y, half)
        elif self.cap:
            for i in range(2):
                vx = self.end_x if i else self.start_x
                vy = self.end_y if i else self.start_y
                ex: cython.longlong = vx * middle.a // _UNIT if vx >= 0 else -(-vx * middle.a // _UNIT)
                ey: cython.longlong = vy * middle.a // _UNIT if vy >= 0 else -(-vy * middle.a // _UNIT)
                if self.cap == _ROUND:
                    count = _add_dot(ends, count, ex, y - ey, half)
                else:
                    # Along the tangent, away from the ring.
                    tx: cython.longlong = -vy if i else vy
                    ty: cython.longlong = vx if i else -vx
                    _add_bar(ends, 2 * count, ex, y - ey, tx, ty, half * _UNIT, half)
                    count += 1
        if count > start:
            count = _unite(ends, count)
        for i in range(2 * count):
            ends[i] += x
        return count

    def _wedge(self, ends, count, y):
        """Leave what is in the angle; a reflex one is all but the other one."""
        k: cython.int
        before: cython.int = count
        bounds: cython.longlong[2]
        if not cython.compiled:
            bounds = [0, 0]
        bounds[0] = -_ENDLESS
        bounds[1] = _ENDLESS
        if self.reflex:
            half_plane(self.end_x, self.end_y, 0, y, bounds, 0)
            half_plane(-self.start_x, -self.start_y, 0, y, bounds, 0)
            if bounds[0] >= bounds[1]:
                return count
            for k in range(before):
                ends[2 * count] = max(ends[2 * k], bounds[1])
                ends[2 * count + 1] = ends[2 * k + 1]
                ends[2 * k + 1] = min(ends[2 * k + 1], bounds[0])
                count += 1
            return count
        half_plane(self.start_x, self.start_y, 0, y, bounds, 0)
        half_plane(-self.end_x, -self.end_y, 0, y, bounds, 0)
        for k in range(count):
            ends[2 * k] = max(ends[2 * k], bounds[0])
            ends[2 * k + 1] = min(ends[2 * k + 1], bounds[1])
        return count

    def _quarters(self, ends, count, y, half_pixel):
        """Leave what is in the chosen quadrants."""
        k: cython.int
        above: cython.bint = y < half_pixel
        below: cython.bint = y >= -half_pixel
        right: cython.bint = (above and self.quadrants & 1) or (below and self.quadrants & 8)
        left: cython.bint = (above and self.quadrants & 2) or (below and self.quadrants & 4)
        for k in range(count):
            if not left:
                ends[2 * k] = max(ends[2 * k], -half_pixel)
            if not right:
                ends[2 * k + 1] = min(ends[2 * k + 1], half_pixel if left else -half_pixel)
        return count


def _add_bar(ends, at, x, y, vx, vy, length, half):
    """Write the ends of a rectangle at height `y`: from (x, 0) on in a vector's direction, `half` to either side.

    `length` comes times the vector's.
    """
    ends[at] = -_ENDLESS
    ends[at + 1] = _ENDLESS
    half_plane(vx, vy, half * _UNIT, y, ends, at)
    half_plane(-vx, -vy, half * _UNIT, y, ends, at)
    half_plane(vy, -vx, 0, y, ends, at)
    half_plane(-vy, vx, length, y, ends, at)
    ends[at] += x
    ends[at + 1] += x


def _add_dot(ends, count, x, y, half):
    """Write the ends of a disc around (x, 0) at height `y` behind the others; return how many spans there are now."""
    if abs(y) >= half:
        return count
    radius: cython.double = half
    height: cython.double = y
    reach: cython.double = sqrt((radius - height) * (radius + height))
    whole: cython.longlong = floored(reach)
    ends[2 * count] = x - whole
    ends[2 * count + 1] = x + whole + (reach > whole)
    return count + 1


def _unite(ends, count):
    """Let no point be in two spans: sort them, and begin each where the ones before it end."""
    k: cython.int
    j: cython.int
    low: cython.longlong
    high: cython.longlong
    for k in range(1, count):
        low = ends[2 * k]
        high = ends[2 * k + 1]
        j = k
        while j > 0 and ends[2 * j - 2] > low:
            ends[2 * j] = ends[2 * j - 2]
            ends[2 * j + 1] = ends[2 * j - 1]
            j -= 1
        ends[2 * j] = low
        ends[2 * j + 1] = high
    high = ends[0]
    for k in range(count):
        ends[2 * k] = max(ends[2 * k], high)
        high = max(high, ends[2 * k + 1])
    return count
