"""Coverage: how much of each pixel a shape covers, told by the spans of its sub-scanlines.

A pixel has n x n sub-pixels with a reference point each, and a row of pixels n sub-scanlines. A shape says for each
sub-scanline, from top to bottom, which half-open spans [a, b) of sub-pixels it holds; sub-pixel g belongs to pixel
g // n. The spans are *counted*: a sub-pixel is 1 in its own pixel, so that coverage is the share of a pixel's reference
points that are in the shape. Or they are *weighed* by a filter: a sub-pixel is the filter's volume above it, in every
pixel in whose area of influence it lies. Either way a span changes coverage only near its two ends, and a small table
says how.

Reference points lie on a lattice of 512 n steps a pixel, in which a 256th of a pixel is 2 n steps: a shape can decide
with whole numbers whether a point is inside.
"""

import numbers

import cython
from cython.cimports.paneldraw.raster.cone import BLOCK, FILTER_FULL, FILTER_SHIFT, ConeFilter
from cython.cimports.paneldraw.raster.paint import inverse_of, paint_coverage, paint_eight
from cython.cimports.paneldraw.raster.surface import Surface

from paneldraw._signatures import SignatureOfInit

# As typing has it, without an import that costs as much as the rest.
TYPE_CHECKING = False

# The fraction's bits of a place between a window's sides; places themselves are less than 2**27.
_FIXED = cython.declare(cython.int, 36)

# In a number of eight bytes: 1, 1 in each, and all bits.
_ONE = cython.declare(cython.ulonglong, 1)
_ONES = cython.declare(cython.ulonglong, 0x0101010101010101)
_ALL = cython.declare(cython.ulonglong, 0xFFFFFFFFFFFFFFFF)

if not cython.compiled:
    MOST, FRACTION, STEEP = 128, 55, 8
    Edge = type("Edge", (), {})

    def place(edge, lines):
        """The first sub-pixel at or right of an edge, so many sub-scanlines below the present one."""
        return edge.bound + lines * edge.step + ((edge.fraction + lines * edge.fraction_step) >> FRACTION)


@cython.cclass
class Supersample:
    """Anti-aliasing by counting: n x n sub-pixels a pixel, each with a reference point.

    The coverage of a pixel is the share of its reference points that are inside the shape, in n * n + 1 steps from
    nothing to the full level. Immutable and hashable.

    Parameters
    ----------
    n : int, default 4
        Sub-pixels along each side of a pixel, 1 to 16. With 1 a pixel is lit if its reference point is inside.
    reference : {"center", "corner"}, default "center"
        Where in its sub-pixel the reference point lies: the middle or the top-left corner.

    Raises
    ------
    TypeError
        If `n` is not a whole number.
    ValueError
        If `n` is not from 1 to 16 or `reference` is neither of the two.

    Notes
    -----
    F. C. Crow, "The aliasing problem in computer-generated shaded images", CACM 20 (1977), 799-805.

    Examples
    --------
    >>> from paneldraw import Framebuffer, Supersample
    >>> fb = Framebuffer(8, 3, depth=4)
    >>> fb.line(0, 0, 7, 2, antialias=Supersample(4))
    >>> print(fb)
    fb73....
    159dd951
    ....37bf
    """

    if TYPE_CHECKING:
        n: int
        reference: str

    __signature__ = SignatureOfInit()

    def __cinit__(self):
        # Also of what no `__init__` has seen, divisions by n are divisions.
        self.n = 1

    @cython.annotation_typing(False)
    def __init__(self, n: int = 4, reference: str = "center") -> None:
        if type(n) is not int and (isinstance(n, bool) or not isinstance(n, numbers.Integral)):
            raise TypeError(f"n must be a whole number of sub-pixels from 1 to 16, not {type(n).__name__}")
        if not 1 <= n <= 16:
            raise ValueError(f"n must be from 1 to 16 sub-pixels, not {n}")
        if not isinstance(reference, str) or reference not in ("center", "corner"):
            raise ValueError(f'reference must be "center" or "corner", not {reference!r}')
        self.n = int(n)
        self.reference = reference
        self.corner = reference == "corner"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Supersample):
            return NotImplemented
        return self.__reduce__() == other.__reduce__()

    def __hash__(self) -> int:
        return hash(self.__reduce__())

    def __repr__(self) -> str:
        return f"Supersample(n={self.n}, reference={self.reference!r})"

    def __reduce__(self) -> tuple[object, ...]:
        return Supersample, (self.n, self.reference)


@cython.final
@cython.cclass
class Coverage:
    """Takes the spans of one shape after the other and paints its pixels, each once.

    `begin` says how coverage is found, `spans` takes those of a sub-scanline, `finish` paints what is left.
    """

    def __init__(self, surface: Surface):
        self.surface = surface
        self.memory = None
        self.scratch_memory = bytearray()
        self.filter = None
        self.room = 0
        self.n_divided = 0
        self.n_inverse = 0
        if not cython.compiled:
            self.touched_first, self.touched_end = [0] * 16, [0] * 16
            self.bases, self.tables = [0] * 16, [0] * 16

    def begin(self, antialias):
        """Begin a shape: aliased for None, counted for a Supersample, weighed for a ConeFilter."""
        surface: Surface = self.surface
        samples: Supersample
        cone: ConeFilter
        self.filter = None
        if isinstance(antialias, ConeFilter):
            cone = antialias
            self.filter = cone.kept
            self.filter.prepare()
            self.n = self.filter.n
            self.middle = 256 * (self.n - 1)
            self.lines = self.filter.lines
            self.reach = self.filter.reach
            self.block = BLOCK
            self.shift = FILTER_SHIFT
            self.full = FILTER_FULL
        else:
            samples = antialias
            self.n = 1 if antialias is None else samples.n
            self.middle = 256 * (self.n if antialias is not None and samples.corner else self.n - 1)
            self.lines = self.n
            self.reach = 1
            self.block = self.n
            self.shift = 0
            self.full = self.n * self.n
        self.partial = self.n > 1
        self.lead = (self.lines - self.n) // 2
        self.first = surface.top * self.n - self.lead
        self.end = surface.bottom * self.n + self.lead
        self.low = (surface.left - self.reach) * self.n
        self.high = (surface.right + self.reach) * self.n
        if self.n_divided != self.n or self.full_divided != self.full:
            one: cython.longlong = 1
            self.n_divided = self.n
            self.full_divided = self.full
            # x * n_inverse >> 32 is x // n, for x below 2**32 / n.
            self.n_inverse = (one << 32) // self.n + 1
            self.full_inverse = inverse_of(self.full)
        if self.partial:
            self._open_rows()

    def _open_rows(self):
        """Begin with the first row of pixels, nothing of which is touched."""
        i: cython.int
        self.row = cython.cast(cython.int, self.surface.top)
        self.limit = self.first
        self.slot = 0
        self.rows = 1 if self.filter is None else (self.lines + self.n - 1) // self.n
        self.dirty = False
        self.columns = cython.cast(cython.int, self.surface.width) + 4 * self.reach
        for i in range(self.rows):
            self.touched_first[i] = 1 << 30
            self.touched_end[i] = 0
        if self.rows * self.columns > self.room:
            self._make_room()

    def _make_room(self):
        """Make room for a row of changes for each row of pixels that may be open. Between two shapes all are zero."""
        self.room = self.rows * self.columns
        if cython.compiled:
            kept: bytearray = bytearray(self.room * cython.sizeof(cython.int))
            self.memory = kept
            self.changes = cython.cast(cython.p_int, cython.cast(cython.p_char, kept))
        else:
            self.changes = [0] * self.room

    def row_of_changes(self):
        """Room for the changes of one row of pixels, all of them zero, between two shapes."""
        self.rows = 1
        self.columns = self.surface.width
        if self.columns > self.room:
            self._make_room()
        return self.changes

    def scratch(self, size):
        """Working memory of `size` bytes or more, kept from call to call. In compiled code only."""
        kept: bytearray = self.scratch_memory
        if len(kept) < size:
            kept = self.scratch_memory = bytearray(2 * size)
        return kept

    def spans(self, h, ends, count):
        """Take the spans of sub-scanline `h`: ``ends[2 k] <= sub-pixel < ends[2 k + 1]``, which do not overlap.

        Sub-scanlines come in order, from `first` up to `end`. Spans may be empty and reach out of the window.
        """
        k: cython.int
        a: cython.longlong
        b: cython.longlong
        if not self.partial:
            for k in range(count):
                a = max(ends[2 * k], self.surface.left)
                b = min(ends[2 * k + 1], self.surface.right)
                if a < b:
                    self.surface.span(h, a, b)
            return
        if h >= self.limit:
            self._advance(h)
        if self.filter is None:
            self._count(ends, count)
        else:
            self._look_up(h, 1)
            self._weigh(ends, count)

    def row_of_spans(self, y, ends, count):
        """Take all spans of a row of pixels at once, and paint it; the spans are counted."""
        if self.partial:
            self.row = cython.cast(cython.int, y)
            self._count(ends, count)
            self._paint_row()
            self.limit = self.first
        else:
            self.spans(y, ends, count)

    def block_of_spans(self, h, ends, count):
        """Take spans of the block of sub-scanlines from `h` on, given those of its middle one; they are weighed."""
        if h >= self.limit:
            self._advance(h)
        self._look_up(h, self.block)
        self._weigh(ends, count)

    def block_of_edges(self, h, lines, edges, count):
        """Take the spans of `lines` sub-scanlines from `h` on that lie between straight edges, two by two.

        That is a whole `block`; where spans are counted, any number of blocks up to `MOST` sub-scanlines. Returns
        whether they were taken: edges may be too flat for it.
        """
        i: cython.int
        if self.filter is not None:
            if h >= self.limit:
                self._advance(h)
            self._weigh_edges(h, edges, count)
            return True
        if not self._are_steep(edges, count):
            return False
        self._set_out(edges, count)
        for i in range(lines // self.n):
            self._count_row(h // self.n + i, edges, count)
        return True

    def _set_out(self, edges, count):
        """Let edges set out on a block, in one fixed-point number: so many errors of it are less than allowed."""
        i: cython.int
        left: cython.longlong = self.surface.left * self.n
        for i in range(count):
            edge: cython.pointer[Edge] = edges[i]
            edge.at = ((edge.bound - left) << _FIXED) + (edge.fraction >> (FRACTION - _FIXED))
            edge.pace = (edge.step << _FIXED) + (edge.fraction_step >> (FRACTION - _FIXED))

    def paint_between(self, y, rows, edges):
        """Paint the pixels between two edges, whichever is left, in up to `MOST` rows from `y` on; aliased."""
        k: cython.int
        x: cython.longlong = self.surface.left
        self._set_out(edges, 2)
        a: cython.longlong = edges[0].at
        b: cython.longlong = edges[1].at
        pace: cython.longlong = edges[0].pace
        other: cython.longlong = edges[1].pace
        for k in range(rows):
            self.surface.span(y + k, x + (min(a, b) >> _FIXED), x + (max(a, b) >> _FIXED))
            a += pace
            b += other

    def _count(self, ends, count):
        """Add spans of the present row of pixels: a sub-pixel is 1 in its own pixel."""
        k: cython.int
        n: cython.int = self.n
        inverse: cython.longlong = self.n_inverse
        low: cython.longlong = self.low
        high: cython.longlong = self.high
        base: cython.int = self.slot * self.columns
        first: cython.int = self.touched_first[self.slot]
        end: cython.int = self.touched_end[self.slot]
        changes: cython.p_int = self.changes
        for k in range(count):
            start: cython.longlong = max(ends[2 * k], low) - low
            stop: cython.longlong = min(ends[2 * k + 1], high) - low
            if start >= stop:
                continue
            left: cython.int = cython.cast(cython.int, (start * inverse) >> 32)
            right: cython.int = cython.cast(cython.int, (stop * inverse) >> 32)
            first = min(first, left)
            end = max(end, right + 2)
            a: cython.int = cython.cast(cython.int, start) - left * n
            b: cython.int = cython.cast(cython.int, stop) - right * n
            left += base
            right += base
            changes[left] += n - a
            changes[left + 1] += a
            changes[right] -= n - b
            changes[right + 1] -= b
        self.touched_first[self.slot] = first
        self.touched_end[self.slot] = end
        self.dirty = self.dirty or first < end

    def _are_steep(self, edges, count):
        """Whether no edge runs through more than eight pixels of a row, which `_count_row` takes at once."""
        i: cython.int
        n: cython.int = self.n
        steep: cython.longlong = (7 * n - 1) // (n - 1)
        for i in range(count):
            if not -steep <= edges[i].step < steep:
                return False
        return n < 16

    def _count_row(self, y, edges, count):
        """Count and paint a row of pixels, in which edges move on to the next one.

        In bytes of a number, how much is covered of the eight pixels from where the present edge is first seen. What is
        left of it no edge changes any more.
        """
        i: cython.int
        bits: cython.int
        left: cython.longlong = self.surface.left
        before: cython.p_ulonglong = counts_before(self.n)
        whole: cython.ulonglong = cython.cast(cython.ulonglong, self.full) * _ONES
        # Behind all edges so far, and up to where they change something.
        behind: cython.ulonglong = 0
        covered: cython.ulonglong = 0
        until: cython.int = 0
        at: cython.int = 0
        for i in range(count):
            edge: cython.pointer[Edge] = edges[i]
            counts: cython.ulonglong = whole - self._count_edge(edge, before)
            if edge.pixel > at:
                self._paint_counted(y, at, min(until, edge.pixel), covered)
                if behind and until < edge.pixel:
                    self.surface.span(y, left + max(at, until), left + edge.pixel)
                bits = 8 * (edge.pixel - at)
                covered = behind if bits >= 64 else ((covered >> bits) | (behind << (64 - bits))) & _ALL
                at = edge.pixel
            until = max(until, edge.until)
            behind = whole - behind
            covered = covered + counts if behind else covered - counts
        self._paint_counted(y, at, until, covered)

    def _count_edge(self, edge, before):
        """Count what is left of an edge in a row of pixels, eight of them from where it is first seen."""
        _: cython.int
        n: cython.int = self.n
        x: cython.longlong = edge.at
        pace: cython.longlong = edge.pace
        last: cython.longlong = (x + (n - 1) * pace) >> _FIXED
        left: cython.longlong = min(x >> _FIXED, last)
        right: cython.longlong = max(x >> _FIXED, last)
        wide: cython.longlong = (self.surface.right - self.surface.left) * n
        cut: cython.bint = left < 0 or right > wide
        if cut:
            left = min(max(left, 0), wide)
            right = min(max(right, 0), wide)
        edge.pixel = cython.cast(cython.int, (left * self.n_inverse) >> 32)
        edge.until = cython.cast(cython.int, ((right + n - 1) * self.n_inverse) >> 32)
        edge.at = x + n * pace
        first: cython.longlong = edge.pixel * n
        counts: cython.ulonglong = 0
        if cut:
            for _ in range(n):
                counts += before[min(max(x >> _FIXED, 0), wide) - first]
                x += pace
        else:
            for _ in range(n):
                counts += before[(x >> _FIXED) - first]
                x += pace
        return counts

    def _paint_counted(self, y, first, end, counts):
        """Paint pixels number `first` up to `end` of a row in sight, eight at most, by the bytes of `counts`."""
        if first >= end:
            return
        if end - first < 8:
            counts &= (_ONE << (8 * (end - first))) - 1
        paint_eight(self.surface, y, self.surface.left + first, counts, self.full, self.full_inverse)

    def _weigh_edges(self, h, edges, count):
        """Add the spans between edges to all rows of pixels that the block reaches."""
        i: cython.int
        k: cython.int
        edge: cython.pointer[Edge]
        at: cython.longlong
        low: cython.longlong = 1 << 30
        high: cython.longlong = -1
        flat: cython.bint = False
        self._look_up(h, self.block)
        for i in range(count):
            edge = edges[i]
            if -STEEP <= edge.step < STEEP:
                at = self._weigh_end(place(edge, self.block // 2), i % 2 == 0)
                low = min(low, at)
                high = max(high, at)
            else:
                flat = True
        if flat:
            for k in range(self.block):
                self._look_up(h + k, 1)
                for i in range(count):
                    edge = edges[i]
                    if not -STEEP <= edge.step < STEEP:
                        at = self._weigh_end(place(edge, k), i % 2 == 0)
                        low = min(low, at)
                        high = max(high, at)
        self._touch(low, high)

    def _look_up(self, h, lines):
        """Find the rows of pixels that sub-scanline `h`, or a block of `lines` from it on, reaches; and its weights."""
        rows: cython.int = 0
        n: cython.int = self.n
        entries: cython.int = 2 * self.reach * n
        slot: cython.int = self.slot
        index: cython.int = cython.cast(cython.int, h - self.row * n + self.lead)
        last: cython.int = self.lines - 1
        start: cython.int = 0
        # The tables of blocks lie behind those of sub-scanlines.
        if lines > 1:
            start = self.lines // 2 * entries
            index //= lines
            n //= lines
            last = self.lines // lines - 1
        while index >= 0 and rows < self.rows and self.row + rows < self.surface.bottom:
            # The filter is the same above and below its middle.
            self.tables[rows] = start + min(index, last - index) * entries
            self.bases[rows] = slot * self.columns
            slot = slot + 1 if slot + 1 < self.rows else 0
            index -= n
            rows += 1
        self.reached = rows

    def _weigh(self, ends, count):
        """Add spans to all rows of pixels that are reached: a sub-pixel is the filter's volume above it."""
        k: cython.int
        low: cython.longlong = 1 << 30
        high: cython.longlong = -1
        for k in range(count):
            a: cython.longlong = max(ends[2 * k], self.low)
            b: cython.longlong = min(ends[2 * k + 1], self.high)
            if a < b:
                low = min(low, self._weigh_end(a, True))
                high = max(high, self._weigh_end(b, False))
        self._touch(low, high)

    def _weigh_end(self, x, opens):
        """Add what a span that begins or ends at sub-pixel `x` changes; return the first place that it does at."""
        r: cython.int
        n: cython.int = self.n
        width: cython.int = 2 * self.reach
        x = min(max(x, self.low), self.high) - self.low
        left: cython.longlong = (x * self.n_inverse) >> 32
        begin: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, (x - left * n) * width)
        at: cython.Py_ssize_t = cython.cast(cython.Py_ssize_t, left)
        changes: cython.p_int = self.changes
        weights: cython.p_int = self.filter.weights
        sign: cython.int = 0 if opens else -1
        if width == 4:
            for r in range(self.reached):
                _add_four(changes, self.bases[r] + at, weights, self.tables[r] + begin, sign)
        else:
            for r in range(self.reached):
                _add(changes, self.bases[r] + at, weights, self.tables[r] + begin, width, sign)
        return left

    def reach_for(self, h, lines):
        """Prepare for the ends of spans of `lines` sub-scanlines from `h` on, weighed as one: of one or of a block."""
        if h >= self.limit:
            self._advance(h)
        self._look_up(h, lines)

    def end_span(self, x, opens):
        """Weigh an end of a span at sub-pixel `x`, where `reach_for` prepared for it."""
        at: cython.longlong = self._weigh_end(x, opens)
        self._touch(at, at)

    def _touch(self, low, high):
        """Remember that ends changed the rows that are reached from place `low` to place `high` on."""
        slot: cython.int = self.slot
        _: cython.int
        if low > high:
            return
        first: cython.int = cython.cast(cython.int, low)
        end: cython.int = cython.cast(cython.int, high) + 2 * self.reach
        self.dirty = True
        for _ in range(self.reached):
            self.touched_first[slot] = min(self.touched_first[slot], first)
            self.touched_end[slot] = max(self.touched_end[slot], end)
            slot = slot + 1 if slot + 1 < self.rows else 0

    def _advance(self, h):
        """Paint the rows that sub-scanline `h` and those below it do not reach."""
        while self.dirty and h >= self.limit and self.row < self.surface.bottom:
            self._paint_row()
        if not self.dirty:
            further: cython.longlong = max((h - self.first - self.lines + self.n) // self.n, 0)
            self.row = cython.cast(cython.int, self.surface.top + further)
            self.limit = self.row * self.n - self.lead + self.lines

    def _paint_row(self):
        """Paint the first row that is open, and close it."""
        i: cython.int
        slot: cython.int = self.slot
        first: cython.int = self.touched_first[slot]
        count: cython.int = self.touched_end[slot] - first
        if count > 0:
            left: cython.longlong = self.surface.left - 2 * self.reach + 1 + first
            at: cython.int = slot * self.columns + first
            paint_coverage(
                self.surface, self.row, left, self.changes, at, count, self.shift, self.full, self.full_inverse
            )
            self.touched_first[slot] = 1 << 30
            self.touched_end[slot] = 0
        self.row += 1
        self.limit += self.n
        self.slot = slot + 1 if slot + 1 < self.rows else 0
        self.dirty = False
        for i in range(self.rows):
            self.dirty = self.dirty or self.touched_end[i] > 0

    def finish(self):
        """Paint the rows that are not painted yet. After that, another shape of the same kind may begin."""
        while self.partial and self.dirty:
            self._paint_row()
        self.limit = self.first


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _add(
    changes: cython.p_int,
    at: cython.Py_ssize_t,
    weights: cython.p_int,
    of: cython.Py_ssize_t,
    width: cython.int,
    sign: cython.int,
) -> cython.void:
    """Add weights to changes, or for the sign -1 take them away."""
    i: cython.int
    for i in range(width):
        changes[at + i] += (weights[of + i] ^ sign) - sign


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _add_four(
    changes: cython.p_int, at: cython.Py_ssize_t, weights: cython.p_int, of: cython.Py_ssize_t, sign: cython.int
) -> cython.void:
    """The same for four, which the processor adds in one go."""
    w: cython.int = (weights[of] ^ sign) - sign
    x: cython.int = (weights[of + 1] ^ sign) - sign
    y: cython.int = (weights[of + 2] ^ sign) - sign
    z: cython.int = (weights[of + 3] ^ sign) - sign
    w += changes[at]
    x += changes[at + 1]
    y += changes[at + 2]
    z += changes[at + 3]
    changes[at] = w
    changes[at + 1] = x
    changes[at + 2] = y
    changes[at + 3] = z


# For n from 1 to 15 and g from 0 to 8 n, one after the other: how many of the first g sub-pixels of eight pixels each
# pixel has, as the bytes of a number, the first pixel's the lowest. Counts of n sub-scanlines, added up, fit in.
_COUNTS = cython.declare(cython.ulonglong[975])
if not cython.compiled:
    _COUNTS = [0] * 975


@cython.cfunc
@cython.exceptval(check=False)
def _fill_counts() -> cython.void:
    n: cython.int
    g: cython.int
    at: cython.int = 0
    one: cython.ulonglong = 1
    for n in range(1, 16):
        counts: cython.ulonglong = 0
        for g in range(8 * n + 1):
            _COUNTS[at] = counts
            if g < 8 * n:
                counts += one << (8 * (g // n))
            at += 1


_fill_counts()


def counts_before(n):
    """The table of the counts before a sub-pixel, for n up to 15: see `_COUNTS`."""
    at: cython.int = (4 * n + 1) * (min(n, 15) - 1)
    return cython.address(_COUNTS[at]) if cython.compiled else _COUNTS[at:]
