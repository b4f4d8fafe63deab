"""MicroPython's ``framebuf``: drawing straight into the caller's bytes, packed as panels take them.

Every call but `text` leaves the bytes that MicroPython 1.27 leaves; `text` has its cells, its clipping and its reading
of bytes, and letters of our own. Where the shapes of a `Framebuffer` have other pixels, MicroPython's rules are here:

- A line is walked from its first end to its second: where it passes halfway between two pixels, the one further along
  is lit, so that the way back may differ. A polygon's sides run from its first corner to its last, and backwards.
- A filled polygon is a scan of its rows, in 32nds of a pixel, its lowest corners lit apart.
- An ellipse is J. Kennedy's ("A Fast Bresenham Type Algorithm for Drawing Ellipses"), two walks a quadrant.
- A size that is not positive draws nothing, and no color is wrong: formats take the bits that they have.
"""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

import cython
import numpy as np
from cython.cimports.cpython.buffer import PyBUF_WRITABLE, PyObject_GetBuffer
from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER
from cython.cimports.libc.string import memset
from cython.cimports.paneldraw.framebuffer.arguments import FAR, quick

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import SupportsIndex as Index

    from typing_extensions import Buffer

__all__ = [
    *("GS2_HMSB", "GS4_HMSB", "GS8", "MONO_HLSB", "MONO_HMSB", "MONO_VLSB", "MVLSB", "RGB565"),
    *("FrameBuffer", "FrameBuffer1"),
]

MONO_VLSB = MVLSB = 0
RGB565 = 1
GS4_HMSB = 2
MONO_HLSB = 3
MONO_HMSB = 4
GS2_HMSB = 5
GS8 = 6

#: What a pixel of a format is: how many bits, and what its place in a byte is turned over by (x-or) where the leftmost
#: pixel is not in the lowest bits. The bytes of MONO_VLSB run down, all others right.
_FORMATS = {
    MONO_VLSB: (1, 0),
    RGB565: (16, 0),
    GS4_HMSB: (4, 4),
    MONO_HLSB: (1, 7),
    MONO_HMSB: (1, 0),
    GS2_HMSB: (2, 0),
    GS8: (8, 0),
}
_LARGEST = 0xFFFF
_WHOLE = tuple("bBhHiIlLqQ")
#: Coordinates and sizes beyond are more than MicroPython's own numbers bear on a microcontroller.
_REACH = cython.declare(cython.longlong, 1 << 27)
_LONGEST_RADIUS = cython.declare(cython.longlong, 1 << 18)

font: bytes | None = None
"""The 8x8 letters of `FrameBuffer.text`: 96 characters from the blank on, each its columns from the left, the topmost
pixel in the lowest bit. None: our own."""


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Packed:
    """Pixels in somebody's memory. What is in the window is painted with the bits of `level`."""

    memory: Any
    held: Any
    data: cython.p_uchar
    size: cython.Py_ssize_t
    width: cython.longlong
    height: cython.longlong
    stride: cython.longlong
    bits: cython.longlong
    flip: cython.int
    mask: cython.uint
    down: cython.bint

    def __init__(self, memory: Any, width: Any, height: Any, form: Any, stride: Any, writable: Any) -> None:
        width, height, form = operator.index(width), operator.index(height), operator.index(form)
        stride = width if stride is None else operator.index(stride)
        if not (1 <= width <= stride <= _LARGEST and 1 <= height <= _LARGEST):
            sizes = f"{width} x {height} pixels, {stride} from row to row"
            raise ValueError(f"width, height and stride must be 1 to {_LARGEST}, stride not below width; not {sizes}")
        if form not in _FORMATS:
            raise ValueError(f"invalid format {form}: take one of framebuf's constants")
        self.bits, self.flip = _FORMATS[form]
        self.mask = (1 << self.bits) - 1
        self.down = form == MONO_VLSB
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

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def fit(self, color: cython.uint) -> cython.uint:
        """The bits of a color that the format has; of one bit, whether there is any color."""
        return color != 0 if self.mask == 1 else color & self.mask

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def get(self, x: cython.longlong, y: cython.longlong) -> cython.uint:
        """The level of a pixel that is there."""
        if self.down:
            return (self.data[(y >> 3) * self.stride + x] >> (y & 7)) & 1
        at: cython.longlong = (x + y * self.stride) * self.bits
        if self.bits == 16:
            return self.data[at >> 3] | self.data[(at >> 3) + 1] << 8
        return (self.data[at >> 3] >> ((at & 7) ^ self.flip)) & self.mask

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def put(self, x: cython.longlong, y: cython.longlong, level: cython.uint) -> cython.void:
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def block(
        self, x: cython.longlong, y: cython.longlong, w: cython.longlong, h: cython.longlong, level: cython.uint
    ) -> cython.void:
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

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def row(self, start: cython.longlong, stop: cython.longlong, level: cython.uint) -> cython.void:
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

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def head(self, bit: cython.int) -> cython.int:
        """The bits of a byte from number `bit` on, in the order of pixels."""
        return 0xFF >> bit if self.flip else 0xFF << bit & 0xFF

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def tail(self, bit: cython.int) -> cython.int:
        """The bits of a byte up to number `bit`, in the order of pixels."""
        return 0xFF << (7 - bit) & 0xFF if self.flip else 0xFF >> (7 - bit)

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def mix(
        self, at: cython.longlong, count: cython.longlong, mask: cython.int, value: cython.uint
    ) -> cython.void:
        """Give the bits of a mask those of `value`, in so many bytes."""
        i: cython.longlong
        if mask != 0xFF:
            for i in range(at, at + count):
                self.data[i] = (self.data[i] & ~mask) | (value & mask)
        elif cython.compiled:
            memset(self.data + at, value, cython.cast(cython.size_t, count))
        else:
            self.data[at : at + count] = bytes([value]) * count


def _bytes_of(memory: Any, writable: Any) -> Any:
    """The bytes that an object lends, which it keeps in place meanwhile."""
    lent = memoryview(memory)
    if not lent.c_contiguous or (writable and lent.readonly):
        raise TypeError(f"buffer must be {'writable' if lent.readonly else 'one run of'} bytes, not {memory!r}")
    return lent if cython.compiled else np.frombuffer(lent, np.uint8).data


# -- Arguments


@cython.cfunc
@cython.inline
@cython.exceptval(check=True)
def _number(value: Any) -> cython.longlong:
    """A coordinate or size."""
    number: cython.longlong = quick(value)
    return number if number != FAR else _large_number(value)


@cython.cfunc
@cython.exceptval(check=True)
def _large_number(value: Any) -> cython.longlong:
    number: object = operator.index(value)
    if not -_REACH <= number <= _REACH:
        raise OverflowError(f"{number} is beyond +-{_REACH}, the largest coordinates and sizes")
    return number


@cython.cfunc
@cython.inline
@cython.exceptval(check=True)
def _level(packed: Packed, c: Any) -> cython.uint:
    """What a color is in a format."""
    return packed.fit(_color(c))


@cython.cfunc
@cython.inline
@cython.exceptval(check=True)
def _color(c: Any) -> cython.uint:
    """The 32 bits of a color."""
    number: cython.longlong = quick(c)
    if number == FAR:
        number = operator.index(c) & 0xFFFFFFFF
    return cython.cast(cython.uint, number & 0xFFFFFFFF)


@cython.cfunc
def _source(thing: Any) -> Packed:
    """The pixels of a framebuffer, or of the arguments of one, whose memory need not be writable."""
    if isinstance(thing, FrameBuffer):
        source: FrameBuffer = thing
        return source._packed
    if not isinstance(thing, (tuple, list)):
        raise TypeError(f"expected a FrameBuffer or a tuple (buffer, width, height, format[, stride]), not {thing!r}")
    if len(thing) not in (4, 5):
        raise ValueError(f"expected (buffer, width, height, format[, stride]), not {len(thing)} values")
    return Packed(*thing[:4], thing[4] if len(thing) == 5 else None, False)


# -- Shapes


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _line(
    packed: Packed,
    x1: cython.longlong,
    y1: cython.longlong,
    x2: cython.longlong,
    y2: cython.longlong,
    level: cython.uint,
) -> cython.void:
    """Bresenham's line from the first end to the second: u is the longer axis, v the other one."""
    i: cython.longlong
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
    for i in range(first, last + 1):
        if steep:
            packed.put(v, u, level)
        else:
            packed.put(u, v, level)
        if p >= 0:
            v += aside
            p -= 2 * du
        u += along
        p += 2 * dv


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _flank(
    packed: Packed,
    x: cython.longlong,
    y: cython.longlong,
    a: cython.longlong,
    b: cython.longlong,
    swapped: cython.bint,
    fill: cython.bint,
    quadrants: cython.int,
    level: cython.uint,
) -> cython.void:
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


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _four(
    packed: Packed,
    x: cython.longlong,
    y: cython.longlong,
    u: cython.longlong,
    v: cython.longlong,
    fill: cython.bint,
    quadrants: cython.int,
    level: cython.uint,
) -> cython.void:
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


def _corners(coords: Any) -> list[tuple[int, int]]:
    """The corners of a polygon, from an array of whole numbers; what is one too many counts for nothing."""
    view = memoryview(coords)
    if view.ndim != 1 or view.format not in _WHOLE:
        raise TypeError(f"coords must be an array of whole numbers in a row, not of typecode {view.format!r}")
    numbers = view[: len(view) & ~1].tolist()
    if numbers and (max(numbers) > _REACH or min(numbers) < -_REACH):
        raise OverflowError(f"coords reach beyond +-{_REACH}")
    return list(zip(numbers[::2], numbers[1::2], strict=True))


@cython.cfunc
def _fill_row(
    packed: Packed, sides: list, x: cython.longlong, y: cython.longlong, row: cython.longlong, level: cython.uint
) -> None:
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


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _quotient(a: cython.longlong, b: cython.longlong) -> cython.longlong:
    """The whole part of a / b, toward zero."""
    if cython.compiled:
        return a // b
    return abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _write(
    packed: Packed,
    text: cython.p_uchar,
    count: cython.Py_ssize_t,
    letters: cython.p_uchar,
    x: cython.longlong,
    y: cython.longlong,
    level: cython.uint,
) -> cython.void:
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


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _blit(
    packed: Packed,
    source: Packed,
    x: cython.longlong,
    y: cython.longlong,
    key: cython.longlong,
    palette: Packed,
) -> cython.void:
    """Paint the pixels of a picture at (x, y) but those of a color; `palette` is the source itself for none."""
    row: cython.longlong
    column: cython.longlong
    color: cython.uint
    # MicroPython looks no further than the palette's memory XX
    colors: cython.longlong = palette.size if palette.down else 8 * palette.size // palette.bits
    for row in range(max(0, -y), min(source.height, packed.height - y)):
        for column in range(max(0, -x), min(source.width, packed.width - x)):
            color = source.get(column, row)
            if palette is not source:
                color = palette.get(color, 0) if color < colors else 0
            if color != key:
                packed.put(x + column, y + row, packed.fit(color))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _scroll(packed: Packed, dx: cython.longlong, dy: cython.longlong) -> cython.void:
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


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _rows(page: cython.longlong, top: cython.longlong, bottom: cython.longlong) -> cython.int:
    """The bits of a page that the rows ``top <= y < bottom`` have, of which there are some."""
    return (0xFF << max(top - 8 * page, 0) & 0xFF) & (0xFF >> (8 - min(bottom - 8 * page, 8)))


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _move(
    packed: Packed,
    to: cython.longlong,
    count: cython.longlong,
    source: cython.longlong,
    other: cython.longlong,
    shift: cython.int,
    head: cython.int,
    inner: cython.int,
    tail: cython.int,
    backwards: cython.bint,
) -> cython.void:
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
        if packed.flip:
            near = near << shift | far >> (8 - shift)
        else:
            near = near >> shift | far << (8 - shift)
        mask = inner
        if i == 0:
            mask &= head
        if i == count - 1:
            mask &= tail
        packed.data[to + i] = (packed.data[to + i] & ~mask) | (near & mask)


_own_letters: bytes | None = None


def _letters() -> bytes:
    """Our letters, drawn once."""
    global _own_letters
    if _own_letters is None:
        from paneldraw.text import Font

        drawn = Font.builtin()
        cells = np.zeros((96, 8, 8), np.uint8)
        for k in range(96):
            glyph = drawn.glyph(chr(32 + k))[:8, :7]
            cells[k, : glyph.shape[0], 1 : 1 + glyph.shape[1]] = glyph
        _own_letters = np.packbits(cells != 0, axis=1, bitorder="little").tobytes()
    return _own_letters


@cython.cclass
class FrameBuffer:
    """A picture in the caller's memory, and MicroPython's calls that draw on it.

    It lends the same memory on, as bytes: ``bytes(fb)``, ``memoryview(fb)``, ``bus.writeto(0x3C, fb)``. All arguments
    are by position, and what is drawn outside is not there, as in MicroPython. Subclasses may have any attributes.

    Parameters
    ----------
    buffer : bytearray, memoryview, array or any other writable run of bytes
        It stays the caller's, but cannot be resized meanwhile.
    width, height : int
        Size in pixels, 1 to 65535.
    format : int
        `MONO_VLSB`, `MONO_HLSB`, `MONO_HMSB`, `GS2_HMSB`, `GS4_HMSB`, `GS8` or `RGB565`, whose low byte comes first.
    stride : int, optional
        Pixels from one row to the next. Default: `width`. Rows take whole bytes.

    Raises
    ------
    ValueError
        A size, a stride or a format that is none, or a buffer that is too short.
    TypeError
        What is no writable buffer.
    OverflowError
        Coordinates and sizes beyond +-2**27, here and in all calls, or radii beyond +-2**18: more than MicroPython's
        own numbers bear.

    Examples
    --------
    >>> from paneldraw.compat import framebuf
    >>> buffer = bytearray(2 * 16)
    >>> fb = framebuf.FrameBuffer(buffer, 16, 16, framebuf.MONO_VLSB)
    >>> fb.hline(0, 3, 8, 1)
    >>> buffer[:9].hex()
    '080808080808080800'
    """

    _packed: Packed

    def __init__(
        self, buffer: Buffer, width: Index, height: Index, format: Index, stride: Index | None = None, /  # noqa: A002
    ) -> None:
        self._packed = Packed(buffer, width, height, format, stride, True)

    if cython.compiled:

        def __getbuffer__(self, buffer: cython.pointer[cython.Py_buffer], flags: cython.int) -> None:
            PyObject_GetBuffer(self._packed.memory, buffer, flags)

    else:

        def __buffer__(self, flags: Index) -> memoryview:
            return memoryview(self._packed.memory)

    def fill(self, c: Index, /) -> None:
        """Paint all pixels."""
        packed: Packed = self._packed
        packed.block(0, 0, packed.width, packed.height, _level(packed, c))

    def pixel(self, x: Index, y: Index, c: Index | None = None, /) -> int | None:
        """Paint a pixel, or, with no color given, return the one it has; None outside.

        Examples
        --------
        >>> from paneldraw.compat import framebuf
        >>> fb = framebuf.FrameBuffer(bytearray(8), 4, 4, framebuf.GS4_HMSB)
        >>> fb.pixel(1, 2, 21)  # takes the four lower bits
        >>> fb.pixel(1, 2), fb.pixel(9, 9)
        (5, None)
        """
        packed: Packed = self._packed
        column: cython.longlong = _number(x)
        row: cython.longlong = _number(y)
        if c is not None:
            packed.put(column, row, _level(packed, c))
        elif 0 <= column < packed.width and 0 <= row < packed.height:
            return packed.get(column, row)
        return None

    def hline(self, x: Index, y: Index, w: Index, c: Index, /) -> None:
        """Paint `w` pixels from (x, y) to the right."""
        packed: Packed = self._packed
        packed.block(_number(x), _number(y), _number(w), 1, _level(packed, c))

    def vline(self, x: Index, y: Index, h: Index, c: Index, /) -> None:
        """Paint `h` pixels from (x, y) downward."""
        packed: Packed = self._packed
        packed.block(_number(x), _number(y), 1, _number(h), _level(packed, c))

    def line(self, x1: Index, y1: Index, x2: Index, y2: Index, c: Index, /) -> None:
        """Paint the line from (x1, y1) to (x2, y2), both included."""
        packed: Packed = self._packed
        _line(packed, _number(x1), _number(y1), _number(x2), _number(y2), _level(packed, c))

    def rect(self, x: Index, y: Index, w: Index, h: Index, c: Index, f: object = False, /) -> None:
        """Paint the outline of a rectangle, or with `f` all of it."""
        packed: Packed = self._packed
        left: cython.longlong = _number(x)
        top: cython.longlong = _number(y)
        width: cython.longlong = _number(w)
        height: cython.longlong = _number(h)
        level: cython.uint = _level(packed, c)
        if f:
            packed.block(left, top, width, height, level)
            return
        # Each side for itself: of a size that is not positive two are left.
        packed.block(left, top, width, 1, level)
        packed.block(left, top + height - 1, width, 1, level)
        packed.block(left, top, 1, height, level)
        packed.block(left + width - 1, top, 1, height, level)

    def fill_rect(self, x: Index, y: Index, w: Index, h: Index, c: Index, /) -> None:
        """Paint all of a rectangle, as `rect` does with `f`: the older name."""
        packed: Packed = self._packed
        packed.block(_number(x), _number(y), _number(w), _number(h), _level(packed, c))

    def ellipse(self, x: Index, y: Index, xr: Index, yr: Index, c: Index, f: object = False, m: Index = 15, /) -> None:
        """Paint an ellipse around (x, y), with `f` filled.

        Of the quadrants, those that `m` has the bits of: 1 for the top right one, 2 for the top left, 4 for the bottom
        left, 8 for the bottom right.

        Examples
        --------
        >>> from paneldraw.compat import framebuf
        >>> fb = framebuf.FrameBuffer(bytearray(8), 8, 8, framebuf.MONO_HLSB)
        >>> fb.ellipse(3, 3, 3, 3, 1, True, 3)
        >>> print(*(f"{row:08b}".replace("0", ".") for row in bytes(fb)[:5]), sep="\\n")
        ..111...
        .11111..
        1111111.
        1111111.
        ........
        """
        packed: Packed = self._packed
        column: cython.longlong = _number(x)
        row: cython.longlong = _number(y)
        a: cython.longlong = _number(xr)
        b: cython.longlong = _number(yr)
        level: cython.uint = _level(packed, c)
        quadrants: cython.int = _number(m) & 15
        if max(abs(a), abs(b)) > _LONGEST_RADIUS:
            raise OverflowError(f"a radius is beyond +-{_LONGEST_RADIUS}")
        filled: cython.bint = bool(f)
        if a == 0 and b == 0:
            if quadrants:
                packed.put(column, row, level)
            return
        _flank(packed, column, row, a, b, False, filled, quadrants, level)
        _flank(packed, column, row, b, a, True, filled, quadrants, level)

    def poly(self, x: Index, y: Index, coords: Buffer, c: Index, f: object = False, /) -> None:
        """Paint the closed polygon whose corners are in `coords`, seen from (x, y), with `f` filled.

        Parameters
        ----------
        x, y : int
        coords : array of whole numbers
            The corners' x and y in turn: ``array("h", [0, 0, 9, 4, 3, 9])``.
        c : int
        f : bool

        Raises
        ------
        TypeError
            What is no array, such as a list, or one of floats.
        """
        packed: Packed = self._packed
        left: cython.longlong = _number(x)
        top: cython.longlong = _number(y)
        row: cython.longlong
        corners = _corners(coords)
        level: cython.uint = _level(packed, c)
        # As MicroPython does: from the first corner to the last one, and backwards from there.
        sides = [(*one, *other) for one, other in zip(corners[:1] + corners[:0:-1], corners[::-1], strict=True)]
        if not f:
            for x1, y1, x2, y2 in sides:
                _line(packed, left + x1, top + y1, left + x2, top + y2, level)
        elif sides:
            rows = [y for _, y in corners]
            for row in range(max(min(rows), -top), min(max(rows), packed.height - 1 - top) + 1):
                _fill_row(packed, sides, left, top, row, level)

    def text(self, s: str | bytes, x: Index, y: Index, c: Index = 1, /) -> None:
        """Write a text in cells of 8 x 8, the first one's top-left pixel at (x, y).

        As MicroPython it writes bytes: a character that is not ASCII takes as many cells as UTF-8 does, and each is
        that of byte 127. The letters are ours, or those of `paneldraw.compat.framebuf.font`.
        """
        packed: Packed = self._packed
        if not isinstance(s, (str, bytes)):
            raise TypeError(f"s must be a str or bytes, not {s!r}")
        written = s.encode("utf-8", "surrogatepass") if isinstance(s, str) else s
        letters: bytes = font or _letters()
        if len(letters) != 8 * 96:
            raise ValueError(f"font must be 768 bytes, not {len(letters)}")
        _write(packed, written, len(written), letters, _number(x), _number(y), _level(packed, c))

    def scroll(self, xstep: Index, ystep: Index, /) -> None:
        """Move the picture; where nothing moves to, what was there stays."""
        _scroll(self._packed, _number(xstep), _number(ystep))

    def blit(self, source: FrameBuffer | Sequence[Any], x: Index, y: Index, key: Index = -1, palette: Any = None, /) -> None:
        """Paint a picture, its top-left pixel at (x, y).

        Parameters
        ----------
        source : FrameBuffer or tuple
            The picture, or the arguments of one: ``(buffer, width, height, format[, stride])``. Its buffer may be
            read-only. Its colors are taken as they are, whatever the two formats, and by the bits that ours has.
        x, y : int
        key : int, default -1
            The color, after the palette, that stays transparent.
        palette : FrameBuffer or tuple, optional
            What becomes of a color is the pixel in the first row whose x is that color.
        """
        picture: Packed = _source(source)
        colors: Packed = picture if palette is None else _source(palette)
        _blit(self._packed, picture, _number(x), _number(y), _color(key), colors)


def FrameBuffer1(buffer: Buffer, width: Index, height: Index, stride: Index | None = None, /) -> FrameBuffer:  # noqa: N802
    """Return a `FrameBuffer` in the format MONO_VLSB: the oldest name.

    Examples
    --------
    >>> from paneldraw.compat import framebuf
    >>> bytes(framebuf.FrameBuffer1(bytearray(4), 4, 8))
    b'\\x00\\x00\\x00\\x00'
    """
    return FrameBuffer(buffer, width, height, MONO_VLSB, stride)
