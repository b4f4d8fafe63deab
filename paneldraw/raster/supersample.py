# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Supersampling: from spans of sub-pixels to painted pixels.

A pixel has n x n sub-pixels with a reference point each; the share of the reference points inside a shape is its
coverage. Sub-pixel number g of a sub-scanline belongs to pixel g // n. A shape says for each of the n sub-scanlines of
a row of pixels which half-open spans [a, b) of sub-pixels it holds; here they are counted pixel by pixel and the row
is painted, once. With n = 1 the only reference point is the pixel's centre (or corner), and the shape is aliased.
"""

from __future__ import annotations

from numbers import Integral
from typing import Any

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.surface import Surface


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

    def __cinit__(self) -> None:
        # Also of what no `__init__` has seen, divisions by n are divisions.
        self.n = 1

    def __init__(self, n: object = 4, reference: object = "center") -> None:
        if type(n) is not int and (isinstance(n, bool) or not isinstance(n, Integral)):
            raise TypeError(f"n must be a whole number of sub-pixels from 1 to 16, not {type(n).__name__}")
        if not 1 <= int(n) <= 16:
            raise ValueError(f"n must be from 1 to 16 sub-pixels, not {n}")
        if not isinstance(reference, str) or reference not in ("center", "corner"):
            raise ValueError(f'reference must be "center" or "corner", not {reference!r}')
        self.n = int(n)
        self.reference = reference
        self.corner = reference == "corner"

    def __eq__(self, other: Any) -> bool:
        if not isinstance(other, Supersample):
            return NotImplemented
        return (self.n, self.reference) == (other.n, other.reference)

    def __hash__(self) -> int:
        return hash((Supersample, self.n, self.reference))

    def __repr__(self) -> str:
        return f"Supersample(n={self.n}, reference={self.reference!r})"

    def __reduce__(self) -> tuple[Any, ...]:
        return Supersample, (self.n, self.reference)


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
    counts: cython.ulonglong
    one: cython.ulonglong = 1
    for n in range(1, 16):
        counts = 0
        for g in range(8 * n + 1):
            _COUNTS[at] = counts
            counts += one << (8 * (g // n) & 63)
            at += 1


_fill_counts()


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def counts_before(n: cython.int) -> cython.p_ulonglong:
    """The table of the counts before a sub-pixel, for n up to 15: see `_COUNTS`."""
    at: cython.int = (4 * n + 1) * (min(n, 15) - 1)
    return cython.address(_COUNTS[at]) if cython.compiled else _COUNTS[at:]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def paint(
    surface: Surface, y: cython.Py_ssize_t, spans: cython.p_Py_ssize_t, count: cython.Py_ssize_t, n: cython.int
) -> cython.void:
    """Paint row `y`, which is in the window, from `count` spans: ``spans[2 k] <= sub-pixel < spans[2 k + 1]``.

    Spans may reach beyond the window and be empty; those of one sub-scanline do not overlap.
    """
    k: cython.Py_ssize_t
    if n == 1:
        surface.spans(y, spans, count)
        return
    a: cython.Py_ssize_t
    b: cython.Py_ssize_t
    x: cython.Py_ssize_t
    one: cython.longlong = 1
    low: cython.Py_ssize_t = surface.left * n
    high: cython.Py_ssize_t = surface.right * n
    first: cython.Py_ssize_t = high
    last: cython.Py_ssize_t = low
    surface.count_in(n, n * n)
    inverse: cython.longlong = surface.n_inverse
    cells: cython.p_longlong = surface.cells
    for k in range(count):
        a = max(spans[2 * k], low)
        b = min(spans[2 * k + 1], high)
        if a >= b:
            continue
        first = min(first, a)
        last = max(last, b)
        x = (a * inverse) >> 32
        cells[x] += ((a - x * n) << 32) + one
        x = (b * inverse) >> 32
        cells[x] -= ((b - x * n) << 32) + one
    if first < last:
        first = (first * inverse) >> 32
        last = ((last + n - 1) * inverse) >> 32
        if last - first > 64 + 2 * count * count:
            _blend_sparsely(surface, y, spans, count, n)
        else:
            surface.blend(y, first, last, 0)
            surface.cells[last] = 0


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _blend_sparsely(
    surface: Surface, y: cython.Py_ssize_t, spans: cython.p_Py_ssize_t, count: cython.Py_ssize_t, n: cython.int
) -> cython.void:
    """Paint a row whose cells are counted, and have few spans for its width, from one of their ends to the next.

    In between as many spans are open everywhere, all or none of them as a rule.
    """
    k: cython.Py_ssize_t
    j: cython.Py_ssize_t
    x: cython.Py_ssize_t
    start: cython.Py_ssize_t
    marks: cython.Py_ssize_t = 0
    inverse: cython.longlong = surface.n_inverse
    low: cython.Py_ssize_t = surface.left * n
    high: cython.Py_ssize_t = surface.right * n
    places: cython.int[512]
    if not cython.compiled:
        places = [0] * 512
    # The pixels with a cell, in order: spans of one sub-scanline come in order, those of the next lie nearby.
    for k in range(2 * count):
        if max(spans[k & ~1], low) >= min(spans[k | 1], high):
            continue
        x = (min(max(spans[k], low), high) * inverse) >> 32
        j = marks
        while j > 0 and places[j - 1] > x:
            places[j] = places[j - 1]
            j -= 1
        places[j] = x
        marks += 1
    open_spans: cython.longlong = 0
    k = 0
    while k < marks:
        # Pixels with cells that follow each other closely.
        start = places[k]
        x = start
        while k < marks and places[k] <= x + 1:
            x = places[k]
            k += 1
        x += 1
        open_spans = surface.blend(y, start, min(x, surface.right), open_spans)
        # Those open at the end are cut off by the window.
        if k == marks:
            break
        if open_spans == n:
            surface.span(y, x, places[k])
        elif open_spans:
            surface.blend(y, x, places[k], open_spans)
    surface.cells[surface.right] = 0
