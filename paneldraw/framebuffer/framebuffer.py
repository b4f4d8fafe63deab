# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The framebuffer: the pixels in memory, and pictures in and out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, SupportsIndex

import cython
import numpy as np

from paneldraw.framebuffer import pictures
from paneldraw.framebuffer.arguments import LARGEST, as_samples, size, whole

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
    combines the bits, ``"add"`` adds up to the highest level, ``"max"`` keeps the higher and ``"clear"`` makes it 0.

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
        window: Surface = self.surface
        left, top = whole("x", x), whole("y", y)
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
