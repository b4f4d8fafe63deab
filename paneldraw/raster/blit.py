"""Rectangles: blocks of one level, copies of pictures, and the surface's own pixels moved."""

from __future__ import annotations

from typing import Any

import cython
from cython.cimports.cpython.buffer import PyBUF_RECORDS_RO, PyBuffer_Release, PyObject_CheckBuffer, PyObject_GetBuffer
from cython.cimports.cpython.pycapsule import PyCapsule_GetPointer
from cython.cimports.libc.string import memmove, memset
from cython.cimports.paneldraw.raster.paint import inverse_of, meet
from cython.cimports.paneldraw.raster.surface import ADD, CLEAR, OVER, XOR, Surface, near

if not cython.compiled:
    ArrowArray = type("ArrowArray", (), {})


@cython.final
@cython.freelist(4)
@cython.auto_pickle(False)
@cython.cclass
class Picture:
    """A rectangle of bytes to be copied, in memory of any strides, and what they stand for.

    The byte at (x, y) is ``start[y * down + x * across]``, and the memory is held as long as the picture lives. Where
    `mapped`, byte k stands for the level ``table[k]``, and where `binary`, all but 0 stand for the same level.
    """

    view: cython.Py_buffer
    held: cython.bint
    memory: Any
    start: cython.p_uchar
    width: cython.Py_ssize_t
    height: cython.Py_ssize_t
    down: cython.Py_ssize_t
    across: cython.Py_ssize_t
    truths: cython.bint
    mapped: cython.bint
    binary: cython.bint

    def __dealloc__(self) -> None:
        if self.held:
            PyBuffer_Release(cython.address(self.view))

    def read(self, source):
        """Take the bytes or truths, shape (height, width), that an object exports; return whether it does."""
        if not cython.compiled:
            return self._read_copy(source)
        if not PyObject_CheckBuffer(source):
            return False
        try:
            PyObject_GetBuffer(source, cython.address(self.view), PyBUF_RECORDS_RO)
        except (TypeError, ValueError, BufferError):
            return False
        self.held = True
        self.mapped = False
        if self.view.ndim != 2 or self.view.format[1] != 0:
            return False
        self.start = cython.cast(cython.p_uchar, self.view.buf)
        self.height = self.view.shape[0]
        self.width = self.view.shape[1]
        self.down = self.view.strides[0]
        self.across = self.view.strides[1]
        self.truths = self.view.format[0] == b"?"
        return self.truths or self.view.format[0] == b"B"

    def _read_copy(self, source):
        try:
            view: Any = memoryview(source)
        except (TypeError, ValueError, BufferError):
            return False
        if view.ndim != 2 or view.format not in ("B", "?"):
            return False
        self.mapped = False
        self.table = bytearray(256)
        self.memory = view.tobytes()
        self.start = self.memory
        self.height, self.width = view.shape
        self.down, self.across = self.width, 1
        self.truths = view.format == "?"
        return True

    def read_arrow(self, lent):
        """Take the bytes or truths that an array of Apache Arrow's holds, row by row; return whether there was one.

        `lent` is a capsule with the array, the width, the height, and whether its bytes are truths; or None.
        """
        if lent is None or not cython.compiled:
            return False
        capsule, self.width, self.height, self.truths = lent
        array: cython.pointer[ArrowArray] = cython.cast(
            cython.pointer[ArrowArray], PyCapsule_GetPointer(capsule, "arrow_array")
        )
        self.memory = capsule
        # The first buffer says which are missing: none.
        self.start = cython.cast(cython.p_uchar, array.buffers[1]) + array.offset
        self.down = self.width
        self.across = 1
        self.mapped = False
        return True

    def read_surface(self, surface):
        """Take the pixels of a surface."""
        self.mapped = False
        self.truths = False
        if not cython.compiled:
            self.table = bytearray(256)
        self.memory = surface.memory
        self.start = surface.pixels
        self.height = surface.height
        self.width = surface.width
        self.down = surface.stride
        self.across = 1

    def highest(self):
        """The highest byte, or 0 where there is none."""
        i: cython.Py_ssize_t
        start: cython.Py_ssize_t = 0
        across: cython.Py_ssize_t = self.across
        rows: cython.Py_ssize_t = self.height
        count: cython.Py_ssize_t = self.width
        source: cython.p_uchar = self.start
        found: cython.uchar = 0
        if self.down == count * across:
            count *= rows
            rows = min(rows, 1)
        for _ in range(rows):
            for i in range(count):
                found = max(found, source[start + i * across])
            start += self.down
        return found

    def scale(self, of, to):
        """Let bytes be levels 0 ... `of`, and stand for the nearest of the levels 0 ... `to`."""
        byte: cython.int
        level: cython.int = 0
        rest: cython.int = of
        self.mapped = True
        self.binary = of == 1
        # The line from (0, 0) to (of, to).
        for byte in range(of + 1):
            self.table[byte] = level
            rest += 2 * to
            while rest >= 2 * of:
                rest -= 2 * of
                level += 1
        for byte in range(of + 1, 256):
            self.table[byte] = to

    def look_up(self, levels):
        """Let byte k stand for ``levels[k]``."""
        byte: cython.Py_ssize_t
        entries: cython.p_uchar = levels
        self.mapped = True
        self.binary = len(levels) == 2
        for byte in range(min(len(levels), 256)):
            self.table[byte] = entries[byte]

    def place(self, surface, x, y):
        """Find what of the picture is in the window with its top-left pixel at (x, y); return whether anything is.

        It is `rows` rows of `count` bytes from ``start[first]`` on, and goes to ``pixels[target]``.
        """
        left: cython.longlong = max(0, surface.left - x)
        right: cython.longlong = min(self.width, surface.right - x)
        top: cython.longlong = max(0, surface.top - y)
        bottom: cython.longlong = min(self.height, surface.bottom - y)
        if left >= right or top >= bottom:
            return False
        if _overlap(self, surface):
            self._copy()
        self.first = near(top * self.down + left * self.across)
        self.target = near((y + top) * surface.stride + x + left)
        self.count = near(right - left)
        self.rows = near(bottom - top)
        return True

    def _copy(self):
        """Read from a copy from now on."""
        row: cython.Py_ssize_t
        i: cython.Py_ssize_t
        copy = bytearray(self.width * self.height)
        copied: cython.p_uchar = copy
        for row in range(self.height):
            for i in range(self.width):
                copied[row * self.width + i] = self.start[row * self.down + i * self.across]
        self.memory = copy
        self.start = copied
        self.down = self.width
        self.across = 1


@cython.cfunc
@cython.exceptval(check=False)
def _overlap(picture: Picture, surface: Surface) -> cython.bint:
    """Whether a picture lies in memory where the surface does."""
    if not cython.compiled:
        return picture.memory is surface.memory
    low: cython.size_t = cython.cast(cython.size_t, picture.start)
    high: cython.size_t = low
    first: cython.size_t = cython.cast(cython.size_t, surface.pixels)
    last: cython.size_t = first + cython.cast(cython.size_t, surface.height * surface.stride)
    down: cython.Py_ssize_t = picture.down * (picture.height - 1)
    across: cython.Py_ssize_t = picture.across * (picture.width - 1)
    low += cython.cast(cython.size_t, min(down, 0) + min(across, 0))
    high += cython.cast(cython.size_t, max(down, 0) + max(across, 0))
    return low < last and first <= high


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _set(pixels: cython.p_uchar, at: cython.Py_ssize_t, count: cython.Py_ssize_t, level: cython.int) -> cython.void:
    """Make `count` pixels a level."""
    if cython.compiled:
        memset(pixels + at, level, count)
    else:
        pixels[at : at + count] = bytes([level]) * count


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _move(
    pixels: cython.p_uchar,
    at: cython.Py_ssize_t,
    source: cython.p_uchar,
    start: cython.Py_ssize_t,
    count: cython.Py_ssize_t,
) -> cython.void:
    """Copy `count` bytes, which may overlap."""
    if cython.compiled:
        memmove(pixels + at, source + start, count)
    else:
        pixels[at : at + count] = source[start : start + count]


def block(surface, x1, y1, x2, y2, level, op):
    """Paint the pixels ``x1 <= x < x2``, ``y1 <= y < y2`` that are in the window."""
    y: cython.longlong
    left: cython.longlong = max(x1, surface.left)
    top: cython.longlong = max(y1, surface.top)
    right: cython.longlong = min(x2, surface.right)
    bottom: cython.longlong = min(y2, surface.bottom)
    if left >= right or top >= bottom:
        return
    if op != 0 and op != 4:
        surface.paint_with(level, op)
        for y in range(top, bottom):
            surface.span(y, left, right)
        return
    if op == 4:
        level = 0
    pixels: cython.p_uchar = surface.pixels
    stride: cython.Py_ssize_t = surface.stride
    at: cython.Py_ssize_t = near(top * stride + left)
    if right - left == 1:
        for _ in range(top, bottom):
            pixels[at] = level
            at += stride
    elif right - left == stride:
        _set(pixels, at, near((bottom - top) * stride), level)
    else:
        for _ in range(top, bottom):
            _set(pixels, at, near(right - left), level)
            at += stride


def scroll(surface, dx, dy, level):
    """Move the window's pixels by (dx, dy). What nothing moves to becomes `level`, or with -1 stays as it was."""
    left: cython.Py_ssize_t = surface.left
    top: cython.Py_ssize_t = surface.top
    right: cython.Py_ssize_t = surface.right
    bottom: cython.Py_ssize_t = surface.bottom
    width: cython.longlong = right - left - abs(dx)
    height: cython.longlong = bottom - top - abs(dy)
    if width <= 0 or height <= 0:
        if level >= 0:
            block(surface, left, top, right, bottom, level, 0)
        return
    count: cython.Py_ssize_t = near(width)
    rows: cython.Py_ssize_t = near(height)
    step: cython.Py_ssize_t = surface.stride
    source: cython.Py_ssize_t = near((top + max(-dy, 0)) * step + left + max(-dx, 0))
    target: cython.Py_ssize_t = near((top + max(dy, 0)) * step + left + max(dx, 0))
    if count == step:
        count *= rows
        rows = 1
    if target > source:
        source += (rows - 1) * step
        target += (rows - 1) * step
        step = -step
    for _ in range(rows):
        _move(surface.pixels, target, surface.pixels, source, count)
        source += step
        target += step
    if level >= 0:
        if dy > 0:
            block(surface, left, top, right, top + dy, level, 0)
        else:
            block(surface, left, bottom + dy, right, bottom, level, 0)
        if dx > 0:
            block(surface, left, top, left + dx, bottom, level, 0)
        else:
            block(surface, right + dx, top, right, bottom, level, 0)


def blit(surface, picture, x, y, key, op):
    """Copy a picture of levels, its top-left pixel to (x, y), but for the level `key`, or with -1 all of it."""
    i: cython.Py_ssize_t
    level: cython.uchar
    one: cython.uchar
    zero: cython.uchar
    if op != OVER:
        _blend(surface, picture, x, y, key, op)
        return
    if not picture.place(surface, x, y):
        return
    source: cython.p_uchar = picture.start
    across: cython.Py_ssize_t = picture.across
    table: cython.p_uchar = picture.table
    start: cython.Py_ssize_t = picture.first
    pixels: cython.p_uchar = surface.pixels
    target: cython.Py_ssize_t = picture.target
    count: cython.Py_ssize_t = picture.count
    rows: cython.Py_ssize_t = picture.rows
    if across == 1 and count == picture.down and count == surface.stride:
        count *= rows
        rows = 1
    for _ in range(rows):
        if picture.mapped and key >= 0:
            for i in range(count):
                level = table[source[start + i * across]]
                pixels[target + i] = pixels[target + i] if level == key else level
        elif key >= 0:
            for i in range(count):
                level = source[start + i * across]
                pixels[target + i] = pixels[target + i] if level == key else level
        elif picture.mapped and not cython.compiled:
            pixels[target : target + count] = bytes(source[start : start + count]).translate(table)
        elif picture.mapped and picture.binary:
            one = table[1]
            zero = table[0]
            for i in range(count):
                pixels[target + i] = one if source[start + i * across] else zero
        elif picture.mapped:
            for i in range(count):
                pixels[target + i] = table[source[start + i * across]]
        elif across != 1:
            for i in range(count):
                pixels[target + i] = source[start + i * across]
        else:
            _move(pixels, target, source, start, count)
        start += picture.down
        target += surface.stride


@cython.cfunc
def _blend(surface: Surface, picture: Picture, x: cython.longlong, y: cython.longlong, key: cython.int, op: cython.int):
    """As `blit`, for the operations that look at what is there."""
    i: cython.Py_ssize_t
    level: cython.int
    old: cython.int
    top: cython.int = surface.max_level
    if not picture.place(surface, x, y):
        return
    start: cython.Py_ssize_t = picture.first
    target: cython.Py_ssize_t = picture.target
    pixels: cython.p_uchar = surface.pixels
    for _ in range(picture.rows):
        for i in range(picture.count):
            level = picture.start[start + i * picture.across]
            if picture.mapped:
                level = picture.table[level]
            if level == key:
                continue
            old = pixels[target + i]
            if op == XOR:
                pixels[target + i] = old ^ level
            elif op == ADD:
                pixels[target + i] = min(old + level, top)
            else:
                pixels[target + i] = 0 if op == CLEAR else max(old, level)
        start += picture.down
        target += surface.stride


def paint_grays(surface, picture, x, y, op):
    """Paint a picture of grays 0 ... 255 or of truths in the nearest levels, its top-left pixel at (x, y)."""
    i: cython.Py_ssize_t
    top: cython.ushort = surface.max_level
    if picture.truths:
        picture.scale(1, top)
        blit(surface, picture, x, y, -1, op)
    elif top == 255:
        blit(surface, picture, x, y, -1, op)
    elif picture.across != 1 or op != OVER or not cython.compiled:
        picture.scale(255, top)
        blit(surface, picture, x, y, -1, op)
    elif picture.place(surface, x, y):
        # What the table of `scale` would say, found without it: so the compiler does several at once.
        source: cython.p_uchar = picture.start + picture.first
        pixels: cython.p_uchar = surface.pixels + picture.target
        for _ in range(picture.rows):
            for i in range(picture.count):
                pixels[i] = source[i] >> 7 if top == 1 else _of_255(source[i] * top + 127)
            source += picture.down
            pixels += surface.stride


def mix(surface, picture, opacity, x, y, key, op):
    """As `blit`, as opaque 0 ... 255 as another picture says that is as large."""
    i: cython.Py_ssize_t
    level: cython.int
    top: cython.int = surface.max_level
    inverse: cython.longlong = inverse_of(255)
    if not picture.place(surface, x, y) or not opacity.place(surface, x, y):
        return
    start: cython.Py_ssize_t = picture.first
    first: cython.Py_ssize_t = opacity.first
    pixels: cython.p_uchar = surface.pixels
    target: cython.Py_ssize_t = picture.target
    for _ in range(picture.rows):
        for i in range(picture.count):
            level = picture.start[start + i * picture.across]
            if picture.mapped:
                level = picture.table[level]
            if level == key:
                continue
            if op == CLEAR:
                level = 0
            pixels[target + i] = meet(
                pixels[target + i], level, opacity.start[first + i * opacity.across], 255, inverse, op, top
            )
        start += picture.down
        first += opacity.down
        target += surface.stride


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _of_255(number: cython.ushort) -> cython.ushort:
    """The whole part of number / 255, for numbers below 65535."""
    return (number + 1 + (number >> 8)) >> 8
