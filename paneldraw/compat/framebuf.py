"""MicroPython's ``framebuf``: drawing straight into the caller's bytes, packed as panels take them.

Every call but `text` leaves the bytes that MicroPython 1.27 leaves; `text` has its cells, its clipping and its reading
of bytes, and letters of our own. `paneldraw.compat.packed` says by which rules shapes have other pixels than a
`paneldraw.Framebuffer` gives them.
"""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

import cython
import numpy as np
from cython.cimports.cpython.buffer import PyObject_GetBuffer
from cython.cimports.paneldraw.compat.packed import Packed, blit, fill_row, flank, line, scroll, write
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

_WHOLE = tuple("bBhHiIlLqQ")
#: Coordinates and sizes beyond are more than MicroPython's own numbers bear on a microcontroller.
_REACH = cython.declare(cython.longlong, 1 << 27)
_LONGEST_RADIUS = cython.declare(cython.longlong, 1 << 18)

font: bytes | None = None
"""The 8x8 letters of `FrameBuffer.text`: 96 characters from the blank on, each its columns from the left, the topmost
pixel in the lowest bit. None: our own."""


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
def _pixels(fb: FrameBuffer) -> Packed:
    """The pixels of a framebuffer, which a subclass has once it has called its parent."""
    if fb._packed is None:
        raise AttributeError(f"call FrameBuffer.__init__ of the {type(fb).__name__} before it draws")
    return fb._packed


@cython.cfunc
def _source(thing: Any) -> Packed:
    """The pixels of a framebuffer, or of the arguments of one, whose memory need not be writable."""
    if isinstance(thing, FrameBuffer):
        return _pixels(thing)
    if not isinstance(thing, (tuple, list)):
        raise TypeError(f"expected a FrameBuffer or a tuple (buffer, width, height, format[, stride]), not {thing!r}")
    if len(thing) not in (4, 5):
        raise ValueError(f"expected (buffer, width, height, format[, stride]), not {len(thing)} values")
    return Packed(*thing[:4], thing[4] if len(thing) == 5 else None, False)


def _corners(coords: Any) -> list[tuple[int, int]]:
    """The corners of a polygon, from an array of whole numbers; what is one too many counts for nothing."""
    view = memoryview(coords)
    if view.ndim != 1 or view.format not in _WHOLE:
        raise TypeError(f"coords must be an array of whole numbers in a row, not of typecode {view.format!r}")
    numbers = view[: len(view) & ~1].tolist()
    if numbers and (max(numbers) > _REACH or min(numbers) < -_REACH):
        raise OverflowError(f"coords reach beyond +-{_REACH}")
    return list(zip(numbers[::2], numbers[1::2], strict=True))


_own_letters: bytes | None = None


def _letters() -> bytes:
    """Our letters, in the middle of their cells; drawn once."""
    global _own_letters
    if _own_letters is None:
        from paneldraw.text import Font

        drawn = Font.builtin("8x8")
        left = (8 - drawn.advance) // 2
        cells = np.zeros((96, 8, 8), np.bool_)
        for k in range(96):
            glyph = drawn.glyph(chr(32 + k))[:, : drawn.advance]
            cells[k, :, left : left + glyph.shape[1]] = glyph
        _own_letters = np.packbits(cells, axis=1, bitorder="little").tobytes()
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

    if cython.compiled:
        _packed: Packed
    else:
        _packed = None

    def __init__(
        self, buffer: Buffer, width: Index, height: Index, format: Index, stride: Index | None = None, /
    ) -> None:
        self._packed = Packed(buffer, width, height, format, stride, True)

    if cython.compiled:

        def __getbuffer__(self, buffer: cython.pointer[cython.Py_buffer], flags: cython.int) -> None:
            PyObject_GetBuffer(_pixels(self).memory, buffer, flags)

    else:

        def __buffer__(self, flags: Index) -> memoryview:
            return memoryview(_pixels(self).memory)

    def fill(self, c: Index, /) -> None:
        """Paint all pixels."""
        packed: Packed = _pixels(self)
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
        packed: Packed = _pixels(self)
        column: cython.longlong = _number(x)
        row: cython.longlong = _number(y)
        if c is not None:
            packed.put(column, row, _level(packed, c))
        elif 0 <= column < packed.width and 0 <= row < packed.height:
            return packed.get(column, row)
        return None

    def hline(self, x: Index, y: Index, w: Index, c: Index, /) -> None:
        """Paint `w` pixels from (x, y) to the right."""
        packed: Packed = _pixels(self)
        packed.block(_number(x), _number(y), _number(w), 1, _level(packed, c))

    def vline(self, x: Index, y: Index, h: Index, c: Index, /) -> None:
        """Paint `h` pixels from (x, y) downward."""
        packed: Packed = _pixels(self)
        packed.block(_number(x), _number(y), 1, _number(h), _level(packed, c))

    def line(self, x1: Index, y1: Index, x2: Index, y2: Index, c: Index, /) -> None:
        """Paint the line from (x1, y1) to (x2, y2), both included."""
        packed: Packed = _pixels(self)
        line(packed, _number(x1), _number(y1), _number(x2), _number(y2), _level(packed, c))

    def rect(self, x: Index, y: Index, w: Index, h: Index, c: Index, f: object = False, /) -> None:
        """Paint the outline of a rectangle, or with `f` all of it."""
        packed: Packed = _pixels(self)
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
        packed: Packed = _pixels(self)
        packed.block(_number(x), _number(y), _number(w), _number(h), _level(packed, c))

    def ellipse(self, x: Index, y: Index, xr: Index, yr: Index, c: Index, f: object = False, m: Index = 15, /) -> None:
        """Paint an ellipse around (x, y), with `f` filled.

        Of the quadrants, those that `m` has the bits of: 1 for the top right one, 2 for the top left, 4 for the bottom
        left, 8 for the bottom right.

        Examples
        --------
        >>> from paneldraw.compat import framebuf
        >>> buffer = bytearray(8)
        >>> fb = framebuf.FrameBuffer(buffer, 8, 8, framebuf.MONO_HLSB)
        >>> fb.ellipse(3, 3, 3, 3, 1, True, 3)
        >>> print(*(f"{row:08b}".replace("0", ".") for row in buffer[:5]), sep="\\n")
        ..111...
        .11111..
        1111111.
        1111111.
        ........
        """
        packed: Packed = _pixels(self)
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
        flank(packed, column, row, a, b, False, filled, quadrants, level)
        flank(packed, column, row, b, a, True, filled, quadrants, level)

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
        packed: Packed = _pixels(self)
        left: cython.longlong = _number(x)
        top: cython.longlong = _number(y)
        row: cython.longlong
        corners = _corners(coords)
        level: cython.uint = _level(packed, c)
        # As MicroPython does: from the first corner to the last one, and backwards from there.
        sides = [(*one, *other) for one, other in zip(corners[:1] + corners[:0:-1], corners[::-1], strict=True)]
        if not f:
            for x1, y1, x2, y2 in sides:
                line(packed, left + x1, top + y1, left + x2, top + y2, level)
        elif sides:
            rows = [y for _, y in corners]
            for row in range(max(min(rows), -top), min(max(rows), packed.height - 1 - top) + 1):
                fill_row(packed, sides, left, top, row, level)

    def text(self, s: str | bytes, x: Index, y: Index, c: Index = 1, /) -> None:
        """Write a text in cells of 8 x 8, the first one's top-left pixel at (x, y).

        As MicroPython it writes bytes: a character that is not ASCII takes as many cells as UTF-8 does, and each is
        that of byte 127. The letters are ours, or those of `paneldraw.compat.framebuf.font`.
        """
        packed: Packed = _pixels(self)
        if not isinstance(s, (str, bytes)):
            raise TypeError(f"s must be a str or bytes, not {s!r}")
        written = s.encode("utf-8", "surrogatepass") if isinstance(s, str) else s
        letters: bytes = font or _letters()
        if len(letters) != 8 * 96:
            raise ValueError(f"font must be 768 bytes, not {len(letters)}")
        write(packed, written, len(written), letters, _number(x), _number(y), _level(packed, c))

    def scroll(self, xstep: Index, ystep: Index, /) -> None:
        """Move the picture; where nothing moves to, what was there stays."""
        scroll(_pixels(self), _number(xstep), _number(ystep))

    def blit(
        self, source: FrameBuffer | Sequence[Any], x: Index, y: Index, key: Index = -1, palette: Any = None, /
    ) -> None:
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
        blit(_pixels(self), picture, _number(x), _number(y), _color(key), colors)


def FrameBuffer1(buffer: Buffer, width: Index, height: Index, stride: Index | None = None, /) -> FrameBuffer:  # noqa: N802
    """Return a `FrameBuffer` in the format MONO_VLSB: the oldest name.

    Examples
    --------
    >>> from paneldraw.compat import framebuf
    >>> buffer = bytearray(4)
    >>> framebuf.FrameBuffer1(buffer, 4, 8).fill(1)
    >>> buffer.hex()
    'ffffffff'
    """
    return FrameBuffer(buffer, width, height, MONO_VLSB, stride)
