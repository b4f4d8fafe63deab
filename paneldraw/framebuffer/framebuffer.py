# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The framebuffer: the pixels in memory, and pictures in and out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, SupportsIndex

import cython
import numpy as np

from paneldraw.framebuffer import pictures
from paneldraw.framebuffer.arguments import LARGEST, as_samples, not_negative, size, whole

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer.arguments import NEAR, pointer_to_bytes
    from cython.cimports.paneldraw.raster.masks import stamp
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.framebuffer.arguments import NEAR, pointer_to_bytes
    from paneldraw.framebuffer.shapes import Shapes
    from paneldraw.raster.masks import stamp
    from paneldraw.raster.surface import Surface

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray
    from PIL import Image

    from paneldraw.framebuffer.arguments import Antialias, Int, Level, Real, Str
    from paneldraw.framebuffer.pictures import Dither
    from paneldraw.text import Font

_DEPTHS = (1, 2, 4, 8)


@cython.cclass
class Framebuffer(Shapes):
    """A picture in memory, one byte a pixel, and the calls that draw on it.

    x runs right and y down from (0, 0), the center of the top-left pixel. What lies outside is clipped away; no
    coordinate is too large. Whole coordinates and floats are welcome everywhere; aliased shapes take the nearest pixel.

    Parameters
    ----------
    width, height : int
        Size in pixels, 1 to 65536.
    depth : {1, 2, 4, 8}, default 1
        Bits a pixel. Levels run from 0 (dark) to ``2**depth - 1``, and a drawing call's default level is the highest.
    antialias : Supersample, ConeFilter or None, default None
        How shapes are anti-aliased where a call does not say. With one bit a pixel, an anti-aliased shape lights the
        pixels that it covers by half or more; with more, its level is mixed with what is there.

    Attributes
    ----------
    pixels : numpy.ndarray
        The levels, a writable uint8 array of shape (height, width) over the same memory.
    width, height, depth, max_level : int
    antialias : Supersample, ConeFilter or None

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
    combines the bits, ``"add"`` adds up to the highest level, ``"max"`` keeps the higher and ``"clear"`` makes it 0.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> fb = Framebuffer(9, 5)
    >>> fb.line(0, 0, 8, 4)
    >>> fb.circle(4, 2, 1)
    >>> print(fb)
    #........
    .##.#....
    ...###...
    ....###..
    .......##
    """

    pixels: NDArray[np.uint8]
    depth: Int

    def __init__(
        self, width: SupportsIndex, height: SupportsIndex, depth: Int = 1, *, antialias: Antialias = None
    ) -> None:
        width, height = size("width", width), size("height", height)
        for name, side in (("width", width), ("height", height)):
            if not 1 <= side <= LARGEST:
                raise ValueError(f"{name} must be from 1 to {LARGEST} pixels, not {side}")
        depth = size("depth", depth)
        if depth not in _DEPTHS:
            raise ValueError(f"depth must be 1, 2, 4 or 8 bits a pixel, not {depth!r}")
        memory = np.zeros(width * height, np.uint8)
        self._contours = None
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
    def antialias(self) -> Antialias:
        return self._antialias

    @antialias.setter
    def antialias(self, value: Antialias) -> None:
        as_samples(value)
        self._antialias = value

    def fill(self, c: Level) -> None:
        """Set every pixel to level `c`."""
        y: cython.Py_ssize_t
        self._dip(c, "over")
        for y in range(self.surface.top, self.surface.bottom):
            self.surface.span(y, self.surface.left, self.surface.right)

    def clear(self) -> None:
        """Set every pixel to level 0."""
        self.fill(0)

    def text(
        self,
        s: Str,
        x: Real,
        y: Real,
        c: Level = None,
        *,
        font: Font | None = None,
        anchor: Str = "lt",
        op: Str = "over",
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
        left = min(max(whole("x", x) + dx, -NEAR), NEAR)
        top = min(max(whole("y", y) + dy, -NEAR), NEAR)
        self._dip(c, op)
        height, width = coverage.shape
        stamp(self.surface, pointer_to_bytes(coverage), width, height, left, top)

    def image(
        self, picture: Image.Image | NDArray[Any], x: Real = 0, y: Real = 0, *, dither: Dither | None = None
    ) -> None:
        """Paint a picture with its top-left pixel at (x, y).

        Parameters
        ----------
        picture : PIL.Image.Image or numpy.ndarray
            An array of grays: shape (height, width), uint8 0 ... 255 or bool; or of colors: (height, width, 3 or 4).
            Where a picture is transparent, what is there shines through.
        x, y : int or float
        dither : {None, "bayer", "floyd-steinberg"}
            How grays become levels: the nearest level, a fixed pattern, or diffusion of the error.

        Raises
        ------
        TypeError
            If the picture is neither.
        ValueError
            If the array has another shape or `dither` is none of these.
        """
        gray, alpha = pictures.to_gray(picture)
        levels = pictures.quantize(gray, self.surface.max_level, dither)
        part = self._visible(whole("x", x), whole("y", y), levels.shape[1], levels.shape[0])
        if part is None:
            return
        mine, its = part
        below = self.pixels[mine]
        if alpha is None:
            below[...] = levels[its]
        else:
            share = alpha[its].astype(np.int32)
            below[...] = (below * (255 - share) + levels[its] * share + 127) // 255

    def blit(
        self, source: Framebuffer | NDArray[np.uint8], x: Real, y: Real, key: Int = -1, palette: Any = None
    ) -> None:
        """Copy another framebuffer's pixels, its top-left pixel to (x, y).

        Parameters
        ----------
        source : Framebuffer or ndarray of uint8, shape (height, width)
            May be this framebuffer or a view of it. Levels of a framebuffer of another depth are scaled, so that its
            highest level becomes this one's; an array's must be levels of this framebuffer.
        x, y : int or float
        key : int, default -1
            The level, after `palette`, that is not copied; -1 for none.
        palette : Framebuffer of height 1 or sequence of int, optional
            Pixel or item k says which level stands for level k of the source, which then is not scaled.

        Raises
        ------
        TypeError
            If the source is neither.
        ValueError
            If an array holds a level, or a palette lacks one or holds one, that is none.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> stamp = Framebuffer(2, 2)
        >>> stamp.line(0, 0, 1, 1)
        >>> fb = Framebuffer(5, 2)
        >>> fb.blit(stamp, 0, 0)
        >>> fb.blit(stamp, 3, 0, palette=[1, 0])
        >>> print(fb)
        #...#
        .#.#.
        """
        key = size("key", key)
        levels = pictures.levels_for(source, self.surface.max_level, palette)
        part = self._visible(whole("x", x), whole("y", y), levels.shape[1], levels.shape[0])
        if part is None:
            return
        mine, its = part
        levels = levels[its]
        if np.may_share_memory(levels, self.pixels):
            levels = levels.copy()
        if key < 0:
            self.pixels[mine] = levels
        else:
            np.copyto(self.pixels[mine], levels, where=levels != key)

    def scroll(self, dx: Real, dy: Real, c: Level = None) -> None:
        """Move the picture by (dx, dy) pixels. What nothing moves to stays as it was or, with `c`, gets that level.

        Within `clip`, what is inside of the window moves, and nothing else.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(4, 2)
        >>> fb.vline(0, 0, 2)
        >>> fb.scroll(2, 0, 0)
        >>> print(fb)
        ..#.
        ..#.
        """
        window = self.surface
        part = self._visible(
            window.left + whole("dx", dx),
            window.top + whole("dy", dy),
            window.right - window.left,
            window.bottom - window.top,
        )
        inside = self.pixels[window.top : window.bottom, window.left : window.right]
        before = inside.copy()
        if c is not None:
            inside[...] = self._level(c)
        if part is not None:
            mine, its = part
            self.pixels[mine] = before[its]

    def _visible(self, x: Int, y: Int, width: Int, height: Int) -> Any:
        """The part of a picture at (x, y) that is in the window, as slices of the pixels here and there; or None."""
        window = self.surface
        left, right = max(x, window.left), min(x + width, window.right)
        top, bottom = max(y, window.top), min(y + height, window.bottom)
        if left >= right or top >= bottom:
            return None
        here = (slice(top, bottom), slice(left, right))
        return here, (slice(top - y, bottom - y), slice(left - x, right - x))

    # -- Parts of it

    def clip(self, x: Real, y: Real, w: Real, h: Real) -> Clip:
        """Confine drawing to a rectangle, for the length of a ``with`` block; within another one, to what both share.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(6, 3)
        >>> with fb.clip(1, 0, 3, 2):
        ...     fb.fill(1)
        >>> print(fb)
        .###..
        .###..
        ......
        """
        left, top = whole("x", x), whole("y", y)
        right = left + not_negative("w", whole("w", w))
        bottom = top + not_negative("h", whole("h", h))
        return Clip(self, left, top, right, bottom)

    def _window(self) -> Any:
        return self.surface.left, self.surface.top, self.surface.right, self.surface.bottom

    def _set_window(self, left: Int, top: Int, right: Int, bottom: Int) -> None:
        limits = (-LARGEST, LARGEST)
        left, top, right, bottom = (min(max(side, limits[0]), limits[1]) for side in (left, top, right, bottom))
        self.surface.set_window(left, top, right, bottom)

    def view(self, x: SupportsIndex, y: SupportsIndex, w: SupportsIndex, h: SupportsIndex) -> Framebuffer:
        """Return a framebuffer over part of the same pixels, with (0, 0) at (x, y).

        It clips to itself and has its own `antialias`, at first the same. Drawing on one shows on the other.

        Raises
        ------
        ValueError
            If the part does not lie within the framebuffer.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(6, 3)
        >>> fb.view(2, 0, 3, 2).line(-9, 0, 9, 0)
        >>> print(fb)
        ..###.
        ......
        ......
        """
        x, y, w, h = size("x", x), size("y", y), size("w", w), size("h", h)
        mine: Surface = self.surface
        if x < 0 or y < 0 or w < 1 or h < 1 or x + w > mine.width or y + h > mine.height:
            raise ValueError(
                f"x, y, w, h must be a part of the {mine.width} x {mine.height} pixels, not {(x, y, w, h)}"
            )
        part: Framebuffer = Framebuffer.__new__(Framebuffer)
        origin = mine.origin + y * mine.stride + x
        part.surface = Surface(mine.memory, origin, mine.stride, w, h, mine.max_level)
        part.pixels = self.pixels[y : y + h, x : x + w]
        part.depth = self.depth
        part._antialias = self._antialias
        part._contours = None
        return part

    # -- As a picture

    def to_image(self, scale: Int = 1) -> Image.Image:
        """Return a Pillow image, mode ``1`` for one bit a pixel, else ``L``, each pixel `scale` x `scale` large."""
        return pictures.to_image(self.pixels, self.surface.max_level, scale)

    def save(self, path: str | PathLike[str], scale: Int = 1) -> None:
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


class Clip:
    """Confines a framebuffer's drawing to a window while its ``with`` block lasts; made by `Framebuffer.clip`."""

    def __init__(self, framebuffer: Framebuffer, left: Int, top: Int, right: Int, bottom: Int) -> None:
        self._framebuffer = framebuffer
        self._inner = (left, top, right, bottom)

    def __enter__(self) -> Framebuffer:
        self._outer = self._framebuffer._window()
        left, top, right, bottom = self._outer
        inner = self._inner
        left, top = max(left, inner[0]), max(top, inner[1])
        self._framebuffer._set_window(left, top, max(min(right, inner[2]), left), max(min(bottom, inner[3]), top))
        return self._framebuffer

    def __exit__(self, *_: object) -> None:
        self._framebuffer._set_window(*self._outer)
