"""Pixels packed into somebody's bytes, and what MicroPython's shapes paint there.

Where shapes of `raster` have other pixels, these are MicroPython's rules:

- A line is walked from its first end to its second. Where it passes halfway between two pixels, the one further along
  is lit: the way back may differ.
- A polygon is filled row by row. A side's crossing is found in 32nds of a pixel, rounded toward zero, and a side does
  not cross the row of its lower end: pixels that get lost so are painted apart.
- An ellipse is that of J. Kennedy, "A Fast Bresenham Type Algorithm for Drawing Ellipses": two walks a quadrant.
- A size that is not positive paints nothing.

Coordinates and sizes are within +-2**27, radii within +-2**18: 64 bits hold all decisions.
"""

from __future__ import annotations

import operator

import cython
import numpy as np
from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER
from cython.cimports.libc.string import memset

#: The format whose bytes run down.
DOWN = 0

#: Bits a pixel, and the flip, of all formats: MONO_VLSB, RGB565, GS4_HMSB, MONO_HLSB, MONO_HMSB, GS2_HMSB and GS8.
FORMATS = ((1, 0), (16, 0), (4, 4), (1, 7), (1, 0), (2, 0), (8, 0))

_LARGEST = 0xFFFF


@cython.final
@cython.cclass
class Packed:
    """Pixels in somebody's memory, and where each of them is.

    In formats of rows, pixel (x, y) has the `bits` bits from number ``(x + y * stride) * bits`` on. A byte counts its
    bits from the lowest, or from the highest where there is a `flip`, with which a pixel's place is x-ored. Where bytes
    run `down`, each is eight rows of a column, the topmost in the lowest bit.
    """

    def __init__(self, memory, width, height, form, stride, writable):
        width, height, form = operator.index(width), operator.index(height), operator.index(form)
        stride = width if stride is None else operator.index(stride)
        if not (1 <= width <= stride <= _LARGEST and 1 <= height <= _LARGEST):
            sizes = f"{width} x {height} pixels, {stride} from row to row"
            raise ValueError(f"width, height and stride must be 1 to {_LARGEST}, stride not below width; not {sizes}")
        if not 0 <= form < len(FORMATS):
            raise ValueError(f"invalid format {form}: take one of framebuf's constants")
        self.bits, self.flip = FORMATS[form]
        self.mask = (1 << self.bits) - 1
        self.down = form == DOWN
        self.memory = memory
        self.held = _bytes_of(memory, writable)
        self.size = self.held.nbytes
        self.width, self.height = width, height
        unit = 1 if self.down else max(8 // self.bits, 1)
        self.stride = -(-stride // unit) * unit
        rows = -(-height // 8) if self.down else height
        needed = (rows - 1) * self.stride + -(-width // unit) * unit
        needed = needed if self.down else needed * self.bits // 8
        if needed > self.size:
            raise ValueError(f"buffer must have {needed} bytes for {width} x {height} pixels, and has {self.size}")
        if cython.compiled:
            self.data = cython.cast(cython.p_uchar, PyMemoryView_GET_BUFFER(self.held).buf)
        else:
            self.data = self.held

    def fit(self, color):
        """The bits of a color that the format has; of one bit, whether there is any color."""
        return color != 0 if self.mask == 1 else color & self.mask

    def get(self, x, y):
        """The level of a pixel that is there."""
        if self.down:
            return (self.data[(y >> 3) * self.stride + x] >> (y & 7)) & 1
        at: cython.longlong = (x + y * self.stride) * self.bits
        if self.bits == 16:
            return self.data[at >> 3] | self.data[(at >> 3) + 1] << 8
        return (self.data[at >> 3] >> ((at & 7) ^ self.flip)) & self.mask

    def put(self, x, y, level):
        """Paint a pixel, if it is there."""
        shift: cython.int
        at: cython.longlong
        if not (0 <= x < self.width and 0 <= y < self.height):
            return
        if self.down:
            at = (y >> 3) * self.stride + x
            shift = y & 7
        else:
            at = (x + y * self.stride) * self.bits
            shift = (at & 7) ^ self.flip
            at >>= 3
        if self.bits == 16:
            self.data[at] = level & 255
            self.data[at + 1] = level >> 8
        else:
            self.data[at] = (self.data[at] & ~(self.mask << shift)) | level << shift

    def block(self, x, y, w, h, level):
        """Paint what is there of a rectangle, unless a size is not positive."""
        row: cython.longlong
        right: cython.longlong = min(x + w, self.width)
        bottom: cython.longlong = min(y + h, self.height)
        x, y = max(x, 0), max(y, 0)
        if x >= right or y >= bottom:
            return
        if not self.down:
            for row in range(y, bottom):
                self.row(row * self.stride + x, row * self.stride + right, level)
            return
        for row in range(y >> 3, (bottom + 7) >> 3):
            self.mix(row * self.stride + x, right - x, _rows(row, y, bottom), level * 0xFF)

    def row(self, start, stop, level):
        """Paint the pixels from number `start` of the memory on to `stop`, in a format whose bytes run right."""
        at: cython.longlong
        if self.bits == 16:
            for at in range(2 * start, 2 * stop, 2):
                self.data[at] = level & 255
                self.data[at + 1] = level >> 8
            return
        level *= 0xFF // self.mask
        first: cython.longlong = start * self.bits
        last: cython.longlong = stop * self.bits - 1
        head: cython.int = self.head(first & 7)
        tail: cython.int = self.tail(last & 7)
        first >>= 3
        last >>= 3
        if first == last:
            self.mix(first, 1, head & tail, level)
            return
        self.mix(first, 1, head, level)
        self.mix(first + 1, last - first - 1, 0xFF, level)
        self.mix(last, 1, tail, level)

    def head(self, bit):
        """The bits of a byte from number `bit` on, in the order of pixels."""
        return 0xFF >> bit if self.flip else 0xFF << bit & 0xFF

    def tail(self, bit):
        """The bits of a byte up to number `bit`, in the order of pixels."""
        return 0xFF << (7 - bit) & 0xFF if self.flip else 0xFF >> (7 - bit)

    def mix(self, at, count, mask, value):
        """Give the bits of a mask those of `value`, in so many bytes."""
        i: cython.longlong
        if mask != 0xFF:
            for i in range(at, at + count):
                self.data[i] = (self.data[i] & ~mask) | (value & mask)
        elif cython.compiled:
            memset(self.data + at, cython.cast(cython.uchar, value), cython.cast(cython.size_t, count))
        else:
            self.data[at : at + count] = bytes([value]) * count


def _bytes_of(memory, writable):
    """The bytes that an object lends, which it keeps in place meanwhile."""
    lent = memoryview(memory)
    if not lent.c_contiguous or (writable and lent.readonly):
        raise TypeError(f"buffer must be {'writable' if lent.readonly else 'one run of'} bytes, not {memory!r}")
    return lent if cython.compiled else np.frombuffer(lent, np.uint8).data


# -- Shapes


def line(packed, x1, y1, x2, y2, level):
    """Bresenham's line from the first end to the second: u is the longer axis, v the other one."""
    steep: cython.bint = abs(y2 - y1) > abs(x2 - x1)
    u: cython.longlong = y1 if steep else x1
    v: cython.longlong = x1 if steep else y1
    du: cython.longlong = y2 - y1 if steep else x2 - x1
    dv: cython.longlong = x2 - x1 if steep else y2 - y1
    size: cython.longlong = packed.height if steep else packed.width
    along: cython.longlong = 1 if du > 0 else -1
    aside: cython.longlong = 1 if dv > 0 else -1
    du, dv = abs(du), abs(dv)
    # The pixels between the window's sides, and how far the line has moved aside where it enters.
    first: cython.longlong = max(0, -u if along > 0 else u - size + 1)
    last: cython.longlong = min(du, size - 1 - u if along > 0 else u)
    moved: cython.longlong = (2 * first * dv + du) // (2 * du) if first > 0 and du > 0 else 0
    p: cython.longlong = 2 * (first + 1) * dv - du - 2 * du * moved
    u += along * first
    v += aside * moved
    for _ in range(first, last + 1):
        if steep:
            packed.put(v, u, level)
        else:
            packed.put(u, v, level)
        if p >= 0:
            v += aside
            p -= 2 * du
        u += along
        p += 2 * dv


def flank(packed, x, y, a, b, swapped, fill, quadrants, level):
    """Walk an ellipse from the end of its radius `a` on while it is steeper than 45 degrees, seen from there.

    The walk is at (u, v); swapped, u runs down and v right. `error` is the ellipse's equation at (u, v), and grows by
    `change_u` and `change_v` when those change by one.
    """
    u: cython.longlong = a
    v: cython.longlong = 0
    change_u: cython.longlong = b * b * (1 - 2 * a)
    change_v: cython.longlong = a * a
    error: cython.longlong = 0
    slope_u: cython.longlong = 2 * b * b * a
    slope_v: cython.longlong = 0
    while slope_u >= slope_v:
        if swapped:
            _four(packed, x, y, v, u, fill, quadrants, level)
        else:
            _four(packed, x, y, u, v, fill, quadrants, level)
        v += 1
        slope_v += 2 * a * a
        error += change_v
        change_v += 2 * a * a
        if 2 * error + change_u > 0:
            u -= 1
            slope_u -= 2 * b * b
            error += change_u
            change_u += 2 * b * b


def _four(packed, x, y, u, v, fill, quadrants, level):
    """Paint the pixels (x +- u, y +- v) in the quadrants that are wanted, or the rows from the axis to them."""
    k: cython.int
    for k in range(4):
        if quadrants >> k & 1:
            left: cython.bint = k == 1 or k == 2
            row: cython.longlong = y - v if k < 2 else y + v
            if fill:
                packed.block(x - u if left else x, row, u + 1, 1, level)
            else:
                packed.put(x - u if left else x + u, row, level)


def fill_row(packed, sides, x, y, row, level):
    """Fill a row of a polygon whose corners are seen from (x, y): from each crossing of a side to the next.

    A side does not cross the row of its lower end. What gets lost so where two sides meet is painted apart.
    """
    x1: cython.longlong
    y1: cython.longlong
    x2: cython.longlong
    y2: cython.longlong
    crossings: list = []
    for x1, y1, x2, y2 in sides:
        if y1 != y2 and min(y1, y2) <= row < max(y1, y2):
            crossings.append(_quotient(32 * x1 + _quotient(32 * (x2 - x1) * (row - y1), y2 - y1) + 16, 32))
        elif row == max(y1, y2):
            if y1 == y2:
                packed.block(x + min(x1, x2), y + row, abs(x2 - x1) + 1, 1, level)
            else:
                packed.put(x + (x2 if y1 < y2 else x1), y + row, level)
    crossings.sort()
    for k in range(0, len(crossings), 2):
        x1, x2 = crossings[k], crossings[k + 1]
        packed.block(x + x1, y + row, x2 - x1 + 1, 1, level)


def _quotient(a, b):
    """The whole part of a / b, toward zero as in C."""
    quotient: cython.longlong = a // b
    if not cython.compiled and quotient < 0 and quotient * b != a:
        quotient += 1
    return quotient


def write(packed, text, count, letters, x, y, level):
    """Paint a text, a cell of 8 x 8 a byte, from (x, y) on; a cell has no background. Byte 0 ends it."""
    i: cython.Py_ssize_t
    column: cython.int
    row: cython.int
    for i in range(count):
        letter: cython.int = text[i] - 32 if 32 <= text[i] <= 127 else 95
        if text[i] == 0:
            break
        for column in range(8):
            rows: cython.int = letters[8 * letter + column]
            for row in range(8):
                if rows >> row & 1:
                    packed.put(x + column, y + row, level)
        x += 8


# -- Pictures


def blit(packed, source, x, y, key, palette):
    """Paint the pixels of a picture at (x, y) but those of a color; `palette` is the source itself for none."""
    row: cython.longlong
    column: cython.longlong
    color: cython.uint
    # Beyond its width a palette has what its memory goes on with.
    colors: cython.longlong = palette.size if palette.down else 8 * palette.size // palette.bits
    for row in range(max(0, -y), min(source.height, packed.height - y)):
        for column in range(max(0, -x), min(source.width, packed.width - x)):
            color = source.get(column, row)
            if palette is not source:
                color = palette.get(color, 0) if color < colors else 0
            if color != key:
                packed.put(x + column, y + row, packed.fit(color))


def scroll(packed, dx, dy):
    """Move all pixels, byte by byte, those first that others move to."""
    k: cython.longlong
    line: cython.longlong
    source: cython.longlong
    left: cython.longlong = max(dx, 0)
    right: cython.longlong = packed.width + min(dx, 0)
    top: cython.longlong = max(dy, 0)
    bottom: cython.longlong = packed.height + min(dy, 0)
    if left >= right or top >= bottom:
        return
    if packed.down:
        for k in range(((bottom - 1) >> 3) - (top >> 3) + 1):
            line = (top >> 3) + k if dy < 0 else ((bottom - 1) >> 3) - k
            source = 8 * line - dy
            mask: cython.int = _rows(line, top, bottom)
            first: cython.longlong = (source >> 3) * packed.stride + left - dx
            to: cython.longlong = line * packed.stride + left
            _move(packed, to, right - left, first, packed.stride, source & 7, mask, mask, mask, dx > 0)
        return
    line_bytes: cython.longlong = packed.stride * packed.bits >> 3
    start: cython.longlong = left * packed.bits
    stop: cython.longlong = right * packed.bits - 1
    head: cython.int = packed.head(start & 7)
    tail: cython.int = packed.tail(stop & 7)
    source = (start & ~7) - dx * packed.bits
    for k in range(bottom - top):
        line = top + k if dy < 0 else bottom - 1 - k
        to = line * line_bytes + (start >> 3)
        first = (line - dy) * line_bytes + (source >> 3)
        _move(packed, to, (stop >> 3) - (start >> 3) + 1, first, 1, source & 7, head, 0xFF, tail, dx > 0)


def _rows(page, top, bottom):
    """The bits of a page that the rows ``top <= y < bottom`` have, of which there are some."""
    return (0xFF << max(top - 8 * page, 0) & 0xFF) & (0xFF >> (8 - min(bottom - 8 * page, 8)))


def _move(packed, to, count, source, other, shift, head, inner, tail, backwards):
    """Move bytes: each is what is left of one after `shift` pixels' bits, and those of the byte `other` further on.

    Of the first byte the bits of `head` arrive, of the last those of `tail`.
    """
    i: cython.longlong
    k: cython.longlong
    near: cython.int
    far: cython.int
    mask: cython.int
    for k in range(count):
        i = count - 1 - k if backwards else k
        near = packed.data[source + i] if 0 <= source + i < packed.size else 0
        far = packed.data[source + i + other] if shift and 0 <= source + i + other < packed.size else 0
        near = near << shift | far >> (8 - shift) if packed.flip else near >> shift | far << (8 - shift)
        mask = inner
        if i == 0:
            mask &= head
        if i == count - 1:
            mask &= tail
        packed.data[to + i] = (packed.data[to + i] & ~mask) | (near & mask)
