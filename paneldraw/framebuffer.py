# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""The framebuffer: the pixels, and the drawing calls that a script makes. It checks arguments; `raster` finds pixels."""

from __future__ import annotations

import contextlib
import math
import operator
from typing import TYPE_CHECKING, Any

import cython
import numpy as np

from paneldraw import pictures
from paneldraw.raster.surface import OPS

if cython.compiled:
    from cython.cimports.cpython.long import PyLong_AsLongLongAndOverflow
    from cython.cimports.paneldraw.raster.curves import circle, circle_far
    from cython.cimports.paneldraw.raster.lines import bresenham, bresenham_far
    from cython.cimports.paneldraw.raster.masks import stamp
    from cython.cimports.paneldraw.raster.supersample import Supersample
    from cython.cimports.paneldraw.raster.surface import Surface
    from cython.cimports.paneldraw.raster.thick import slab, slab_far
else:
    from paneldraw.raster.curves import circle, circle_far
    from paneldraw.raster.lines import bresenham, bresenham_far
    from paneldraw.raster.masks import stamp
    from paneldraw.raster.supersample import Supersample
    from paneldraw.raster.surface import Surface
    from paneldraw.raster.thick import slab, slab_far

if TYPE_CHECKING:
    from collections.abc import Iterator
    from os import PathLike

    from numpy.typing import ArrayLike, NDArray
    from PIL import Image

    from paneldraw.pictures import Dither
    from paneldraw.text import Font

# The names are aliases because Cython would take a plain `float` or `int` for a C type.
Real = "float | int"
Level = "int | None"

_DEPTHS = (1, 2, 4, 8)
_LARGEST = 65536
_ALIASED = Supersample(1)

# Coordinates within +-_NEAR are handled in 64-bit arithmetic, others in Python's.
_FAR = cython.declare(cython.longlong, 0x7000000000000000)
_NEAR = cython.declare(cython.longlong, 1 << 29)
_NEAR_256THS = cython.declare(cython.longlong, 1 << 26)
_WIDE_256THS = cython.declare(cython.longlong, 1 << 20)
_LARGE_RADIUS = cython.declare(cython.longlong, 1 << 14)


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _quick(value: object) -> cython.longlong:
    """`value`, if it is an int within the quick range, else _FAR."""
    if type(value) is not int:
        return _FAR
    overflow: cython.int = 0
    number: cython.longlong
    if cython.compiled:
        number = PyLong_AsLongLongAndOverflow(value, cython.address(overflow))
    else:
        number = value
    if overflow == 0 and -_NEAR <= number <= _NEAR:
        return number
    return _FAR


def _number(name: str, value: Any) -> int | float:
    """`value` as an int of any size or a finite float."""
    try:
        return operator.index(value)
    except TypeError:
        pass
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}") from None
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite, not {number}")
    return number


def _whole(name: str, value: Any) -> int:
    """The whole number nearest to `value`, halves upward."""
    number = _number(name, value)
    return number if isinstance(number, int) else math.floor(number + 0.5)


def _256ths(name: str, value: Any) -> int:
    number = _number(name, value)
    return number * 256 if isinstance(number, int) else math.floor(number * 256 + 0.5)


def _size(name: str, value: Any) -> int:
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number of pixels, not {type(value).__name__}") from None


def _not_negative(name: str, number: Any) -> Any:
    if number < 0:
        raise ValueError(f"{name} must not be negative, and is {number}")
    return number


@cython.cclass
class Framebuffer:
    """A picture in memory, one byte a pixel, and the calls that draw on it.

    x runs right and y down from (0, 0), the center of the top-left pixel. What lies outside is clipped away; no
    coordinate is too large. Whole coordinates and floats are welcome everywhere; aliased shapes take the nearest pixel.

    Parameters
    ----------
    width, height : int
        Size in pixels, 1 to 65536.
    depth : {1, 2, 4, 8}, default 1
        Bits a pixel. Levels run from 0 (dark) to ``2**depth - 1``, and a drawing call's default level is the highest.
    antialias : Supersample or None, default None
        How shapes are anti-aliased where a call does not say. With one bit a pixel, an anti-aliased shape lights the
        pixels that it covers by half or more; with more, its level is mixed with what is there.

    Attributes
    ----------
    pixels : numpy.ndarray
        The levels, a writable uint8 array of shape (height, width) over the same memory.
    width, height, depth, max_level : int
    antialias : Supersample or None

    Raises
    ------
    TypeError
        If a size is not a whole number.
    ValueError
        If a size or depth is out of range.

    Notes
    -----
    Every drawing call raises ``TypeError`` for a coordinate that is not a number, and ``ValueError`` for one that is
    not finite, for a level outside of 0 ... max_level, and for a negative size. In each call `c` is the level
    (default: the highest) and `op` says how it meets the level that is there: ``"over"`` replaces it, ``"xor"``
    combines the bits, ``"add"`` adds up to the highest level, ``"max"`` keeps the higher one and ``"clear"`` makes it 0.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> fb = Framebuffer(9, 5)
    >>> fb.line(0, 4, 8, 0)
    >>> fb.circle(4, 2, 1)
    >>> print(fb)
    .......##
    ....###..
    ...#.#...
    ..###....
    ##.......
    """

    surface: Surface
    pixels = cython.declare(object, visibility="readonly")
    depth = cython.declare(cython.int, visibility="readonly")
    _antialias: object

    def __init__(self, width: Any, height: Any, depth: Any = 1, *, antialias: Any = None) -> None:
        width, height = _size("width", width), _size("height", height)
        for name, size in (("width", width), ("height", height)):
            if not 1 <= size <= _LARGEST:
                raise ValueError(f"{name} must be from 1 to {_LARGEST} pixels, not {size}")
        if depth not in _DEPTHS:
            raise ValueError(f"depth must be 1, 2, 4 or 8 bits a pixel, not {depth!r}")
        memory = np.zeros(width * height, np.uint8)
        self.surface = Surface(memory, 0, width, width, height, (1 << depth) - 1)
        self.pixels = memory.reshape(height, width)
        self.depth = depth
        self.antialias = antialias

    @property
    def width(self) -> int:
        return self.surface.width

    @property
    def height(self) -> int:
        return self.surface.height

    @property
    def max_level(self) -> int:
        return self.surface.max_level

    @property
    def antialias(self) -> Supersample | None:
        return self._antialias

    @antialias.setter
    def antialias(self, value: Supersample | None) -> None:
        _samples(value)
        self._antialias = value

    # -- How the calls below read their arguments

    @cython.cfunc
    @cython.inline
    def _dip(self, c: object, op: object) -> object:
        """Fill the ink for level `c` and operation `op`."""
        code: cython.int = 0 if op == "over" else _operation(op)
        if c is None:
            self.surface.dip(self.surface.max_level, code)
        else:
            self.surface.dip(self._level(c), code)

    @cython.cfunc
    @cython.inline
    @cython.exceptval(-1)
    def _level(self, c: object) -> cython.int:
        level: cython.longlong = _quick(c)
        if level == _FAR:
            if isinstance(c, float):
                raise TypeError("c must be a whole number, and is a float; round it first")
            level = min(max(_size("c", c), -1), 256)
        if not 0 <= level <= self.surface.max_level:
            raise ValueError(f"c must be a level from 0 to {self.surface.max_level}, not {c}")
        return level

    @cython.cfunc
    def _samples(self, antialias: object) -> Supersample:
        """The anti-aliasing of a call, as a Supersample."""
        return _samples(self._antialias if antialias is ... else antialias)

    # -- Drawing

    def fill(self, c: Level) -> None:
        """Set every pixel to level `c`."""
        y: cython.Py_ssize_t
        self._dip(c, "over")
        for y in range(self.surface.top, self.surface.bottom):
            self.surface.span(y, self.surface.left, self.surface.right)

    def clear(self) -> None:
        """Set every pixel to level 0."""
        self.fill(0)

    def pixel(self, x: Real, y: Real, c: Level = None, *, op: str = "over") -> int | None:
        """Paint one pixel with level `c`, or, with no level given, return the level it has (0 outside)."""
        x = min(max(_whole("x", x), -1), _LARGEST)
        y = min(max(_whole("y", y), -1), _LARGEST)
        if c is None:
            inside = 0 <= x < self.surface.width and 0 <= y < self.surface.height
            return int(self.pixels[y, x]) if inside else 0
        self._dip(c, op)
        self.surface.point(x, y)
        return None

    def hline(self, x: Real, y: Real, w: Real, c: Level = None, *, op: str = "over") -> None:
        """Draw a horizontal line of `w` pixels from (x, y) to the right."""
        self._dip(c, op)
        self._block(_whole("x", x), _whole("y", y), _not_negative("w", _whole("w", w)), 1)

    def vline(self, x: Real, y: Real, h: Real, c: Level = None, *, op: str = "over") -> None:
        """Draw a vertical line of `h` pixels from (x, y) downward."""
        self._dip(c, op)
        self._block(_whole("x", x), _whole("y", y), 1, _not_negative("h", _whole("h", h)))

    def rect(
        self, x: Real, y: Real, w: Real, h: Real, c: Level = None, fill: bool = False, *, op: str = "over"
    ) -> None:
        """Draw a rectangle of `w` x `h` pixels with its top-left pixel at (x, y): its outline, or with `fill` all of it.

        A width or height of 0 draws nothing.
        """
        x, y = _whole("x", x), _whole("y", y)
        w, h = _not_negative("w", _whole("w", w)), _not_negative("h", _whole("h", h))
        self._dip(c, op)
        if fill or w <= 2 or h <= 2:
            self._block(x, y, w, h)
        else:
            self._block(x, y, w, 1)
            self._block(x, y + h - 1, w, 1)
            self._block(x, y + 1, 1, h - 2)
            self._block(x + w - 1, y + 1, 1, h - 2)

    @cython.cfunc
    def _block(self, x: object, y: object, w: object, h: object) -> object:
        """Ink the pixels ``x <= column < x + w`` of the rows ``y <= row < y + h``."""
        row: cython.Py_ssize_t
        first: cython.Py_ssize_t = min(max(x, 0), _LARGEST)
        last: cython.Py_ssize_t = min(max(x + w, 0), _LARGEST)
        for row in range(min(max(y, 0), _LARGEST), min(max(y + h, 0), _LARGEST)):
            self.surface.span(row, first, last)

    def line(
        self,
        x1: Real,
        y1: Real,
        x2: Real,
        y2: Real,
        c: Level = None,
        *,
        width: Real = 1,
        cap: str = "square",
        antialias: Any = ...,
        op: str = "over",
    ) -> None:
        """Draw the line from (x1, y1) to (x2, y2), both end points included.

        One pixel wide and aliased it is Bresenham's: the same pixels in both directions, each within half a pixel of
        the true line. Wider or anti-aliased it is the rectangle around the true line: a pixel or sub-pixel is in it
        if its reference point is. Widths and fractions of a pixel are taken to the nearest 256th.

        Parameters
        ----------
        x1, y1, x2, y2 : int or float
        c : int, optional
        width : int or float, default 1
            Thickness in pixels, above 0.
        cap : {"square", "butt"}
            Whether a rectangle reaches half a width beyond the end points or ends there.
        antialias : Supersample or None, optional
            Default: the framebuffer's.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        ValueError
            If `width` is not above 0 or `cap` or `op` is none of these.

        Notes
        -----
        J. E. Bresenham, "Algorithm for computer control of a digital plotter", IBM Systems Journal 4 (1965), 25-30.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(8, 4)
        >>> fb.line(0, 0, 7, 3)
        >>> print(fb)
        #.......
        .###....
        ....###.
        .......#
        """
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        if antialias is None and width == 1 and cap == "square":
            self._thin(x1, y1, x2, y2)
        else:
            self._thick(x1, y1, x2, y2, _line_width(width), _reaches(cap), _samples(antialias))

    @cython.cfunc
    @cython.inline
    def _thin(self, x1: object, y1: object, x2: object, y2: object) -> object:
        a: cython.longlong = _quick(x1)
        b: cython.longlong = _quick(y1)
        c: cython.longlong = _quick(x2)
        d: cython.longlong = _quick(y2)
        if a != _FAR and b != _FAR and c != _FAR and d != _FAR:
            bresenham(self.surface, a, b, c, d)
        else:
            self._thin_far(_whole("x1", x1), _whole("y1", y1), _whole("x2", x2), _whole("y2", y2))

    @cython.cfunc
    def _thin_far(self, x1: object, y1: object, x2: object, y2: object) -> object:
        if max(abs(x1), abs(y1), abs(x2), abs(y2)) <= _NEAR:
            bresenham(self.surface, x1, y1, x2, y2)
        else:
            bresenham_far(self.surface, x1, y1, x2, y2)

    @cython.cfunc
    def _thick(
        self, x1: object, y1: object, x2: object, y2: object, width: object, square: cython.bint, samples: Supersample
    ) -> object:
        x1, y1, x2, y2 = _256ths("x1", x1), _256ths("y1", y1), _256ths("x2", x2), _256ths("y2", y2)
        if max(abs(x1), abs(y1), abs(x2), abs(y2)) <= _NEAR_256THS and width <= _WIDE_256THS:
            slab(self.surface, x1, y1, x2, y2, width, square, samples.n, samples.corner)
        else:
            slab_far(self.surface, x1, y1, x2, y2, width, square, samples.n, samples.corner)

    def lines(
        self,
        segments: ArrayLike,
        c: Level = None,
        *,
        width: Real = 1,
        cap: str = "square",
        antialias: Any = ...,
        op: str = "over",
    ) -> None:
        """Draw many lines in one call: as `line` for each row (x1, y1, x2, y2) of an array of shape (n, 4)."""
        rows = _table("segments", segments, 4)
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        thin: cython.bint = antialias is None and width == 1 and cap == "square"
        square: cython.bint = _reaches(cap)
        samples: Supersample = _samples(antialias)
        wide: cython.longlong = min(_line_width(width), _WIDE_256THS + 1)
        whole = _integers(rows, 1 if thin else 256, _NEAR if thin else _NEAR_256THS)
        if whole is None or wide > _WIDE_256THS:
            for x1, y1, x2, y2 in rows.tolist():
                self.line(x1, y1, x2, y2, c, width=width, cap=cap, antialias=antialias, op=op)
            return
        row: cython.Py_ssize_t
        points: cython.p_longlong = _pointer(whole)
        for row in range(0, 4 * len(whole), 4):
            if thin:
                bresenham(self.surface, points[row], points[row + 1], points[row + 2], points[row + 3])
            else:
                slab(
                    self.surface, points[row], points[row + 1], points[row + 2], points[row + 3], wide, square,
                    samples.n, samples.corner,
                )

    def points(self, xy: ArrayLike, c: Level = None, *, op: str = "over") -> None:
        """Paint many pixels in one call: the rows (x, y) of an array of shape (n, 2)."""
        rows = _table("xy", xy, 2)
        self._dip(c, op)
        whole = _integers(rows, 1, _NEAR)
        if whole is None:
            for x, y in rows.tolist():
                self.pixel(x, y, self.surface.max_level if c is None else c, op=op)
            return
        row: cython.Py_ssize_t
        points: cython.p_longlong = _pointer(whole)
        for row in range(0, 2 * len(whole), 2):
            self.surface.point(points[row], points[row + 1])

    def circle(self, x: Real, y: Real, r: Real, c: Level = None, fill: bool = False, *, op: str = "over") -> None:
        """Draw the midpoint circle of radius `r` around (x, y): its outline, or with `fill` the disc within it.

        A radius of 0 draws one pixel. The disc ends where the outline does.

        Notes
        -----
        J. E. Bresenham, "A linear algorithm for incremental digital display of circular arcs", CACM 20 (1977), 100-106.
        """
        x, y, r = _whole("x", x), _whole("y", y), _not_negative("r", _whole("r", r))
        self._dip(c, op)
        if max(abs(x), abs(y)) <= _NEAR and r <= _LARGE_RADIUS:
            circle(self.surface, x, y, r, fill)
        else:
            circle_far(self.surface, x, y, r, fill)

    def text(
        self,
        s: str,
        x: Real,
        y: Real,
        c: Level = None,
        *,
        font: Font | None = None,
        anchor: str = "lt",
        op: str = "over",
    ) -> None:
        """Write text.

        Parameters
        ----------
        s : str
            One or more lines.
        x, y : int or float
            Where the anchor lies.
        c : int, optional
        font : Font, optional
            Default: the built-in font of 6 x 8 pixels a character.
        anchor : str, default "lt"
            Which pixel of the text's box (x, y) means: ``l``, ``m`` or ``r``, then ``t``, ``m``, ``b`` or ``s`` (the
            row that the first line stands on). See `paneldraw.text.render`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(12, 8)
        >>> fb.text("Hi", 0, 0)
        >>> int(fb.pixels.sum()) > 0
        True
        """
        from paneldraw.text import render

        coverage, dx, dy = render(s, font, anchor)
        left = min(max(_whole("x", x) + dx, -_NEAR), _NEAR)
        top = min(max(_whole("y", y) + dy, -_NEAR), _NEAR)
        self._dip(c, op)
        height, width = coverage.shape
        stamp(self.surface, _bytes(coverage), width, height, left, top)

    def image(self, picture: Image.Image | NDArray[Any], x: Real = 0, y: Real = 0, *, dither: Dither | None = None) -> None:
        """Paint a picture with its top-left pixel at (x, y).

        Parameters
        ----------
        picture : PIL.Image.Image or numpy.ndarray
            An array of greys: shape (height, width), uint8 0 ... 255 or bool; or of colors: (height, width, 3 or 4).
            Where a picture is transparent, what is there shines through.
        x, y : int or float
        dither : {None, "bayer", "floyd-steinberg"}
            How greys become levels: the nearest level, a fixed pattern, or diffusion of the error.

        Raises
        ------
        TypeError
            If the picture is neither.
        ValueError
            If the array has another shape or `dither` is none of these.
        """
        gray, alpha = pictures.to_gray(picture)
        levels = pictures.quantize(gray, self.surface.max_level, dither)
        window: Surface = self.surface
        left, top = _whole("x", x), _whole("y", y)
        height, width = levels.shape
        a, b = max(left, window.left), min(left + width, window.right)
        c, d = max(top, window.top), min(top + height, window.bottom)
        if a >= b or c >= d:
            return
        part = (slice(c - top, d - top), slice(a - left, b - left))
        below = self.pixels[c:d, a:b]
        if alpha is None:
            below[...] = levels[part]
        else:
            share = alpha[part].astype(np.int32)
            below[...] = (below * (255 - share) + levels[part] * share + 127) // 255

    # -- As a picture

    def to_image(self, scale: int = 1) -> Image.Image:
        """Return a Pillow image, mode ``1`` for one bit a pixel, else ``L``, each pixel `scale` x `scale` large."""
        return pictures.to_image(self.pixels, self.surface.max_level, scale)

    def save(self, path: str | PathLike[str], scale: int = 1) -> None:
        """Write the picture to a file; its name's ending says in which format (``.png``, ``.bmp``, ...)."""
        self.to_image(scale).save(path)

    def _repr_png_(self) -> bytes:
        """The picture for a notebook, enlarged."""
        return pictures.to_png(self.pixels, self.surface.max_level, scale=4)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        array = self.pixels if dtype is None else self.pixels.astype(dtype, copy=False)
        if copy is False and array is not self.pixels:
            raise ValueError(f"a framebuffer holds uint8 levels; as {np.dtype(dtype)} they must be copied")
        return array.copy() if copy and array is self.pixels else array

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Framebuffer):
            return NotImplemented
        return self.depth == other.depth and np.array_equal(self.pixels, other.pixels)

    def __str__(self) -> str:
        return pictures.to_text(self.pixels, self.depth)

    def __repr__(self) -> str:
        return f"Framebuffer({self.width}, {self.height}, depth={self.depth})"


def _operation(op: Any) -> int:
    try:
        return OPS[op]
    except (KeyError, TypeError):
        raise ValueError(f"op must be one of {', '.join(map(repr, OPS))}, not {op!r}") from None


def _samples(antialias: Any) -> Supersample:
    if antialias is None:
        return _ALIASED
    if not isinstance(antialias, Supersample):
        raise TypeError(f"antialias must be None or a Supersample, such as Supersample(4), not {antialias!r}")
    return antialias


def _reaches(cap: Any) -> bool:
    if cap not in ("square", "butt"):
        raise ValueError(f'cap must be "square" or "butt", not {cap!r}')
    return cap == "square"


def _line_width(width: Any) -> int:
    fixed = _256ths("width", width)
    if fixed <= 0:
        raise ValueError(f"width must be above 0 pixels, not {width}")
    return fixed


def _table(name: str, rows: Any, columns: int) -> NDArray[Any]:
    """`rows` as an array of numbers of shape (n, columns)."""
    table = np.asarray(rows)
    if table.size == 0:
        return np.zeros((0, columns), np.int64)
    if table.dtype.kind not in "biufO":
        raise TypeError(f"{name} must hold numbers, not {table.dtype}")
    if table.ndim != 2 or table.shape[1] != columns:
        raise ValueError(f"{name} must have the shape (n, {columns}), not {table.shape}")
    if table.dtype.kind == "f" and not np.isfinite(table).all():
        raise ValueError(f"{name} must be finite, and holds NaN or infinity")
    return table


def _integers(table: NDArray[Any], unit: int, limit: int) -> NDArray[np.int64] | None:
    """The numbers in 1 / unit pixels, to the nearest; None if one of them is beyond +-limit or of no C type."""
    if table.dtype.kind == "O":
        return None
    if table.dtype.kind == "f":
        table = np.floor(table * float(unit) + 0.5)
        unit = 1
    if len(table) and (table.max() > limit // unit or table.min() < -(limit // unit)):
        return None
    table = np.ascontiguousarray(table, np.int64)
    return table if unit == 1 else table * unit


@cython.cfunc
@cython.inline
def _pointer(array: object) -> cython.p_longlong:
    """The numbers of a contiguous int64 array."""
    if cython.compiled:
        address: cython.size_t = array.__array_interface__["data"][0]
        return cython.cast(cython.p_longlong, address)
    return array.ravel().tolist()


@cython.cfunc
@cython.inline
def _bytes(array: object) -> cython.p_uchar:
    """The bytes of a contiguous uint8 array."""
    if cython.compiled:
        address: cython.size_t = array.__array_interface__["data"][0]
        return cython.cast(cython.p_uchar, address)
    return array.tobytes()
