# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The calls that draw points and lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import cython

from paneldraw.framebuffer.arguments import (
    LARGEST,
    as_samples,
    integers,
    line_width,
    not_negative,
    operation,
    reaches,
    size,
    table,
    to_256ths,
    whole,
)

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer.arguments import FAR, NEAR, pointer_to_int64, quick
    from cython.cimports.paneldraw.raster.lines import bresenham, bresenham_far
    from cython.cimports.paneldraw.raster.supersample import Supersample
    from cython.cimports.paneldraw.raster.thick import slab, slab_far
else:
    from paneldraw.framebuffer.arguments import FAR, NEAR, pointer_to_int64, quick
    from paneldraw.raster.lines import bresenham, bresenham_far
    from paneldraw.raster.supersample import Supersample
    from paneldraw.raster.thick import slab, slab_far

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from paneldraw.framebuffer.arguments import AntialiasOrDefault, Level, Real, Str
    from paneldraw.raster.surface import Surface

_NEAR_256THS = cython.declare(cython.longlong, 1 << 26)
_WIDE_256THS = cython.declare(cython.longlong, 1 << 20)


@cython.cclass
class Lines:
    """A surface to draw on, and the calls that draw points and lines on it."""

    surface: Surface
    _antialias: Any

    @cython.cfunc
    @cython.inline
    def _dip(self, c: Any, op: Any) -> Any:
        """Fill the ink for level `c` and operation `op`."""
        code: cython.int = 0 if op == "over" else operation(op)
        if c is None:
            self.surface.dip(self.surface.max_level, code)
        else:
            self.surface.dip(self._level(c), code)

    @cython.cfunc
    @cython.inline
    @cython.exceptval(-1)
    def _level(self, c: Any) -> cython.int:
        level: cython.longlong = quick(c)
        if level == FAR:
            if isinstance(c, float):
                raise TypeError("c must be a whole number, and is a float; round it first")
            level = min(max(size("c", c), -1), 256)
        if not 0 <= level <= self.surface.max_level:
            raise ValueError(f"c must be a level from 0 to {self.surface.max_level}, not {c}")
        return level

    @cython.cfunc
    def _samples(self, antialias: Any) -> Supersample:
        """The anti-aliasing of a call, as a Supersample."""
        return as_samples(self._antialias if antialias is ... else antialias)

    def pixel(self, x: Real, y: Real, c: Level = None, *, op: Str = "over") -> int | None:
        """Paint one pixel with level `c`, or, with no level given, return the level it has (0 outside)."""
        x = min(max(whole("x", x), -1), LARGEST)
        y = min(max(whole("y", y), -1), LARGEST)
        if c is None:
            inside = 0 <= x < self.surface.width and 0 <= y < self.surface.height
            return self.surface.pixels[y * self.surface.stride + x] if inside else 0
        self._dip(c, op)
        self.surface.point(x, y)
        return None

    def hline(self, x: Real, y: Real, w: Real, c: Level = None, *, op: Str = "over") -> None:
        """Draw a horizontal line of `w` pixels from (x, y) to the right."""
        self._dip(c, op)
        self._block(whole("x", x), whole("y", y), not_negative("w", whole("w", w)), 1)

    def vline(self, x: Real, y: Real, h: Real, c: Level = None, *, op: Str = "over") -> None:
        """Draw a vertical line of `h` pixels from (x, y) downward."""
        self._dip(c, op)
        self._block(whole("x", x), whole("y", y), 1, not_negative("h", whole("h", h)))

    @cython.cfunc
    def _block(self, x: Any, y: Any, w: Any, h: Any) -> Any:
        """Ink the pixels ``x <= column < x + w`` of the rows ``y <= row < y + h``."""
        row: cython.Py_ssize_t
        first: cython.Py_ssize_t = min(max(x, 0), LARGEST)
        last: cython.Py_ssize_t = min(max(x + w, 0), LARGEST)
        top: cython.Py_ssize_t = min(max(y, self.surface.top), self.surface.bottom)
        bottom: cython.Py_ssize_t = max(min(y + h, self.surface.bottom), top)
        for row in range(top, bottom):
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
        cap: Str = "square",
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
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
            self._thick(x1, y1, x2, y2, line_width(width), reaches(cap), as_samples(antialias))

    @cython.cfunc
    @cython.inline
    def _thin(self, x1: Any, y1: Any, x2: Any, y2: Any) -> Any:
        a: cython.longlong = quick(x1)
        b: cython.longlong = quick(y1)
        c: cython.longlong = quick(x2)
        d: cython.longlong = quick(y2)
        if a != FAR and b != FAR and c != FAR and d != FAR:
            bresenham(self.surface, a, b, c, d)
        else:
            self._thin_far(whole("x1", x1), whole("y1", y1), whole("x2", x2), whole("y2", y2))

    @cython.cfunc
    def _thin_far(self, x1: Any, y1: Any, x2: Any, y2: Any) -> Any:
        if max(abs(x1), abs(y1), abs(x2), abs(y2)) <= NEAR:
            bresenham(self.surface, x1, y1, x2, y2)
        else:
            bresenham_far(self.surface, x1, y1, x2, y2)

    @cython.cfunc
    def _thick(self, x1: Any, y1: Any, x2: Any, y2: Any, width: Any, square: cython.bint, samples: Supersample) -> Any:
        x1, y1, x2, y2 = to_256ths("x1", x1), to_256ths("y1", y1), to_256ths("x2", x2), to_256ths("y2", y2)
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
        cap: Str = "square",
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw many lines in one call: as `line` for each row (x1, y1, x2, y2) of an array of shape (n, 4)."""
        rows = table("segments", segments, 4)
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        thin: cython.bint = antialias is None and width == 1 and cap == "square"
        square: cython.bint = reaches(cap)
        samples: Supersample = as_samples(antialias)
        wide: cython.longlong = min(line_width(width), _WIDE_256THS + 1)
        whole = integers(rows, 1 if thin else 256, NEAR if thin else _NEAR_256THS)
        if whole is None or wide > _WIDE_256THS:
            for x1, y1, x2, y2 in rows.tolist():
                self.line(x1, y1, x2, y2, c, width=width, cap=cap, antialias=antialias, op=op)
            return
        row: cython.Py_ssize_t
        points: cython.p_longlong = pointer_to_int64(whole)
        for row in range(0, 4 * len(whole), 4):
            if thin:
                bresenham(self.surface, points[row], points[row + 1], points[row + 2], points[row + 3])
            else:
                slab(
                    self.surface,
                    points[row],
                    points[row + 1],
                    points[row + 2],
                    points[row + 3],
                    wide,
                    square,
                    samples.n,
                    samples.corner,
                )

    def points(self, xy: ArrayLike, c: Level = None, *, op: Str = "over") -> None:
        """Paint many pixels in one call: the rows (x, y) of an array of shape (n, 2)."""
        rows = table("xy", xy, 2)
        self._dip(c, op)
        whole = integers(rows, 1, NEAR)
        if whole is None:
            for x, y in rows.tolist():
                self.pixel(x, y, self.surface.max_level if c is None else c, op=op)
            return
        row: cython.Py_ssize_t
        points: cython.p_longlong = pointer_to_int64(whole)
        for row in range(0, 2 * len(whole), 2):
            self.surface.point(points[row], points[row + 1])
