# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The pixels that shapes are painted on, the window that may be painted, and how a level meets what is there."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np

#: How a level meets the level that a pixel has; `Surface.dip` takes the number.
OPS = {"over": 0, "xor": 1, "add": 2, "max": 3, "clear": 4}


@cython.final
@cython.cclass
class Surface:
    """A rectangle of pixels, one byte each, in memory that a numpy array owns.

    Shapes are clipped to the half-open window ``left <= x < right``, ``top <= y < bottom``. What paints is the ink:
    a table that says for every level what becomes of it, so that each operation costs one look-up a pixel.
    """

    mask: Surface | None

    def __init__(
        self,
        memory: Any,
        origin: cython.Py_ssize_t,
        stride: cython.Py_ssize_t,
        width: cython.Py_ssize_t,
        height: cython.Py_ssize_t,
        max_level: cython.int,
    ) -> None:
        # memory: flat, contiguous uint8 array; pixel (x, y) is memory[origin + y * stride + x].
        self.memory = memory
        self.scratch = None
        self.mask = None
        self.kept = None
        self.boundary: Any = None
        if cython.compiled:
            address: cython.size_t = memory.__array_interface__["data"][0]
            self.pixels = cython.cast(cython.p_uchar, address + origin)
        else:
            self.pixels = memoryview(memory)[origin:]
            self.ink = bytearray(256)
        self.origin = origin
        self.stride = stride
        self.width = width
        self.height = height
        self.max_level = max_level
        self.left = 0
        self.top = 0
        self.right = width
        self.bottom = height
        self.level = -1
        self.op = -1
        self.n = 0
        self.full = 0
        self.reserve()

    @cython.cfunc
    def reserve(self) -> Any:
        """Make the row of cells in which coverage is counted: one a pixel and one beyond the right end, all zero."""
        if cython.compiled:
            self.scratch = bytearray(8 * (self.width + 1))
            self.cells = cython.cast(cython.p_longlong, cython.cast(cython.p_char, self.scratch))
        else:
            self.cells = [0] * (self.width + 1)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def count_in(self, n: cython.int, full: cython.int) -> cython.void:
        """From now on count coverage in n sub-pixels a pixel of a row; a count of `full` is the whole pixel."""
        one: cython.longlong = 1
        if self.n != n or self.full != full:
            # Divisions as multiplications: by n, exact below 2**32 / n; by 2 * full, exact below 512 * full.
            self.n = n
            self.n_inverse = (one << 32) // n + 1
            self.full = full
            self.full_inverse = (one << 32) // (2 * full) + 1

    @cython.cfunc
    def make_room(self, size: cython.Py_ssize_t) -> Any:
        """Let `room` point to working memory of `size` bytes or more, kept from call to call. In compiled code only."""
        if self.kept is None or len(self.kept) < size:
            self.kept = bytearray(2 * size)
            self.room = self.kept

    @cython.cfunc
    def single_row(self) -> Surface:
        """A surface as wide as this one all of whose rows are the same row of memory, zero; made once."""
        if self.mask is None:
            self.mask = Surface(np.zeros(self.width, np.uint8), 0, 0, self.width, self.height, 1)
        return self.mask

    def set_window(
        self, left: cython.Py_ssize_t, top: cython.Py_ssize_t, right: cython.Py_ssize_t, bottom: cython.Py_ssize_t
    ) -> None:
        """Confine painting to ``left <= x < right``, ``top <= y < bottom`` and to the surface."""
        self.left = min(max(left, 0), self.width)
        self.top = min(max(top, 0), self.height)
        self.right = max(min(right, self.width), self.left)
        self.bottom = max(min(bottom, self.height), self.top)

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def dip(self, level: cython.int, op: cython.int) -> cython.void:
        """Fill the ink: what a pixel of each level becomes where `level` is painted with operation `op`."""
        old: cython.int
        new: cython.int
        if self.level == level and self.op == op:
            return
        self.level = level
        self.op = op
        for old in range(256):
            if op == 0:
                new = level
            elif op == 1:
                new = old ^ level
            elif op == 2:
                new = min(old + level, self.max_level)
            elif op == 3:
                new = max(old, level)
            else:
                new = 0
            self.ink[old] = new

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def point(self, x: cython.Py_ssize_t, y: cython.Py_ssize_t) -> cython.void:
        """Ink one pixel, if it is in the window."""
        i: cython.Py_ssize_t
        if self.left <= x < self.right and self.top <= y < self.bottom:
            i = y * self.stride + x
            self.pixels[i] = self.ink[self.pixels[i]]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def span(self, y: cython.Py_ssize_t, x1: cython.Py_ssize_t, x2: cython.Py_ssize_t) -> cython.void:
        """Ink the pixels ``x1 <= x < x2`` of row `y` that are in the window."""
        if self.top <= y < self.bottom:
            self._ink(y * self.stride, max(x1, self.left), min(x2, self.right))

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def spans(self, y: cython.Py_ssize_t, bounds: cython.p_Py_ssize_t, count: cython.Py_ssize_t) -> cython.void:
        """Ink `count` spans of a row that is in the window: ``bounds[2 k] <= x < bounds[2 k + 1]``."""
        k: cython.Py_ssize_t
        for k in range(count):
            self._ink(y * self.stride, max(bounds[2 * k], self.left), min(bounds[2 * k + 1], self.right))

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def _ink(self, row: cython.Py_ssize_t, x1: cython.Py_ssize_t, x2: cython.Py_ssize_t) -> cython.void:
        """Ink the pixels ``x1 <= x < x2`` of the row that begins at `row`."""
        i: cython.Py_ssize_t
        pixels: cython.p_uchar = self.pixels
        level: cython.uchar
        if self.op == 0 or self.op == 4:
            level = self.ink[0]
            for i in range(row + x1, row + x2):
                pixels[i] = level
        else:
            for i in range(row + x1, row + x2):
                pixels[i] = self.ink[pixels[i]]

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def blend(
        self, y: cython.Py_ssize_t, x1: cython.Py_ssize_t, x2: cython.Py_ssize_t, open_spans: cython.longlong
    ) -> cython.longlong:
        """Paint pixels ``x1 <= x < x2`` of row `y`, which are in the window, by the coverage counted in `cells`.

        `open_spans` is how many spans are open on the left; returned is how many are on the right.

        A span that begins in a pixel behind k of its n sub-pixels has added ``(k << 32) + 1`` to the pixel's cell; one
        that ends there has taken that away. So the lower half adds up to the number of spans that are open, and the
        upper half is what they leave out of this pixel. The cells are zero afterwards.
        """
        x: cython.Py_ssize_t
        cell: cython.longlong
        covered: cython.longlong
        old: cython.longlong
        lower: cython.longlong = 0xFFFFFFFF
        cells: cython.p_longlong = self.cells
        n: cython.longlong = self.n
        full: cython.longlong = self.full
        inverse: cython.longlong = self.full_inverse
        op: cython.int = self.op
        level: cython.longlong = self.level if op != 4 else 0
        top: cython.int = self.max_level
        pixels: cython.p_uchar = self.pixels
        ink: cython.p_uchar = self.ink
        base: cython.Py_ssize_t = y * self.stride
        for x in range(x1, x2):
            cell = open_spans + cells[x]
            cells[x] = 0
            open_spans = cell & lower
            covered = n * open_spans - (cell >> 32)
            old = pixels[base + x]
            pixels[base + x] = _meet(old, level, covered, full, inverse, op, top, ink)
        return open_spans

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def blend_eight(self, y: cython.Py_ssize_t, x: cython.Py_ssize_t, counts: cython.ulonglong) -> cython.void:
        """Paint up to eight pixels from (x, y) on by their coverage: the bytes of `counts`, the lowest one first."""
        covered: cython.longlong
        old: cython.longlong
        full: cython.longlong = self.full
        inverse: cython.longlong = self.full_inverse
        op: cython.int = self.op
        level: cython.longlong = self.level if op != 4 else 0
        top: cython.int = self.max_level
        pixels: cython.p_uchar = self.pixels
        ink: cython.p_uchar = self.ink
        i: cython.Py_ssize_t = y * self.stride + x
        while counts:
            covered = counts & 255
            counts >>= 8
            old = pixels[i]
            pixels[i] = _meet(old, level, covered, full, inverse, op, top, ink)
            i += 1


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _meet(
    old: cython.longlong,
    level: cython.longlong,
    covered: cython.longlong,
    full: cython.longlong,
    inverse: cython.longlong,
    op: cython.int,
    top: cython.int,
    ink: cython.p_uchar,
) -> cython.longlong:
    """What becomes of a pixel where `level` covers it `covered` times of `full`.

    Rounded to the nearest; x * inverse >> 32 is x / (2 * full). On one bit, half or more is all.
    """
    if top == 1:
        return ink[old] if 2 * covered >= full else old
    if op == 0 or op == 4:
        return ((2 * (level - old) * covered + (2 * old + 1) * full) * inverse) >> 32
    share: cython.longlong = ((2 * level * covered + full) * inverse) >> 32
    if op == 1:
        return old ^ share
    if op == 2:
        return min(old + share, top)
    return max(old, share)
