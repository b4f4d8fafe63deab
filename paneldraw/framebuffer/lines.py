# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The calls that draw points and lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import cython

from paneldraw.framebuffer.arguments import (
    LARGEST,
    as_samples,
    choice,
    dash_lengths,
    dash_steps,
    integers,
    not_negative,
    table,
    to_256ths,
    whole,
)
from paneldraw.raster.far import cut_path
from paneldraw.raster.strokes import CAPS

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer._words import is_word
    from cython.cimports.paneldraw.framebuffer.arguments import (
        FAR,
        FIXED_REACH,
        NEAR,
        Points,
        line_width,
        pointer_to_int64,
        quick,
        quick_256ths,
        quick_rows,
    )
    from cython.cimports.paneldraw.raster.cone import ConeFilter, strip
    from cython.cimports.paneldraw.raster.lines import bresenham, dashed, far
    from cython.cimports.paneldraw.raster.supersample import Supersample
    from cython.cimports.paneldraw.raster.thick import slab, slab_far
else:
    from paneldraw.framebuffer._words import is_word
    from paneldraw.framebuffer.arguments import (
        FAR,
        FIXED_REACH,
        NEAR,
        Points,
        line_width,
        pointer_to_int64,
        quick,
        quick_256ths,
        quick_rows,
    )
    from paneldraw.framebuffer.paths import Paths
    from paneldraw.raster.cone import ConeFilter, strip
    from paneldraw.raster.lines import bresenham, dashed, far
    from paneldraw.raster.supersample import Supersample
    from paneldraw.raster.thick import slab, slab_far

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from paneldraw.framebuffer.arguments import AntialiasOrDefault, Level, Real, Str

_ALGORITHMS = {"bresenham": 0, "dda": 1}
_SQUARE = cython.declare(cython.int, CAPS["square"])
_ROUND = cython.declare(cython.int, CAPS["round"])

# Lines wider than this, in 256ths, are left to Python's arithmetic.
_WIDE = cython.declare(cython.longlong, 1 << 20)


@cython.cclass
class Lines(Paths):
    """The calls that draw points and lines."""

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
        dash: Iterable[Real] | None = None,
        algorithm: Str = "bresenham",
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
        cap : {"square", "butt", "round"}
            Whether a thick line reaches half a width beyond its end points, ends there, or ends in half a disc (a
            polygon within a 256th of a pixel of it). An aliased line of width 1 has no caps.
        dash : iterable of int or float, optional
            Lengths in pixels, each 1 or more, drawn and left out in turn from where the line begins. An aliased line
            of width 1 counts pixels; others measure along the line, and their dashes are cut square.
        algorithm : {"bresenham", "dda"}
            How the pixels of an aliased line of width 1 are found. They are the same; the DDA is there to compare.
        antialias : Supersample, ConeFilter or None, optional
            Default: the framebuffer's.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        ValueError
            If `width` is below 1/256, a length of `dash` is below 1, or `cap`, `algorithm` or `op` is none of these.

        Notes
        -----
        J. E. Bresenham, "Algorithm for computer control of a digital plotter", IBM Systems Journal 4 (1965), 25-30.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(8, 4)
        >>> fb.line(0, 0, 7, 3)
        >>> print(fb)
        ##......
        ..##....
        ....##..
        ......##
        """
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        shape: cython.int = _SQUARE if is_word(cap, "square") else choice("cap", cap, CAPS)
        wide = line_width(width)
        if antialias is None and wide == 256 and dash is None and is_word(algorithm, "bresenham"):
            self._thin(x1, y1, x2, y2)
            return
        dda: cython.bint = False if is_word(algorithm, "bresenham") else choice("algorithm", algorithm, _ALGORITHMS)
        if not isinstance(antialias, Supersample):
            as_samples(antialias)
        if antialias is None and wide == 256:
            self._thin_path(Points("line", (x1, y1, x2, y2), False), False, dash_lengths(dash), dda)
        elif dash is None and shape != _ROUND:
            self._thick(x1, y1, x2, y2, wide, shape == _SQUARE, antialias)
        else:
            path = Points("line", (x1, y1, x2, y2), True)
            self._stroke(path, False, wide, shape, 0, dash_lengths(dash), antialias)

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
            far(self.surface, x1, y1, x2, y2, [], 0)

    @cython.cfunc
    @cython.inline
    def _thick(self, x1: Any, y1: Any, x2: Any, y2: Any, width: Any, square: cython.bint, antialias: Any) -> Any:
        a: cython.longlong = quick_256ths(x1)
        b: cython.longlong = quick_256ths(y1)
        c: cython.longlong = quick_256ths(x2)
        d: cython.longlong = quick_256ths(y2)
        if a != FAR and b != FAR and c != FAR and d != FAR and width <= _WIDE:
            self._rectangle(a, b, c, d, width, square, antialias)
        else:
            x1, y1 = to_256ths("x1", x1), to_256ths("y1", y1)
            x2, y2 = to_256ths("x2", x2), to_256ths("y2", y2)
            self._thick_far(x1, y1, x2, y2, width, square, antialias)

    @cython.cfunc
    @cython.inline
    def _rectangle(
        self,
        x1: cython.longlong,
        y1: cython.longlong,
        x2: cython.longlong,
        y2: cython.longlong,
        width: cython.longlong,
        square: cython.bint,
        antialias: Any,
    ) -> Any:
        """The rectangle around a line; lengths in 256ths."""
        if isinstance(antialias, ConeFilter):
            cone: ConeFilter = antialias
            cone.fit(width / 256.0)
            strip(self.surface, cone, x1 / 256.0, y1 / 256.0, x2 / 256.0, y2 / 256.0, width / 256.0, square)
        else:
            samples: Supersample = antialias if isinstance(antialias, Supersample) else as_samples(antialias)
            if not slab(self.surface, x1, y1, x2, y2, width, square, samples.n, samples.corner):
                slab_far(self.surface, x1, y1, x2, y2, width, square, samples.n, samples.corner)

    @cython.cfunc
    def _thick_far(self, x1: Any, y1: Any, x2: Any, y2: Any, width: Any, square: cython.bint, antialias: Any) -> Any:
        if max(abs(x1), abs(y1), abs(x2), abs(y2)) <= FIXED_REACH * 256 and width <= _WIDE:
            self._rectangle(x1, y1, x2, y2, width, square, antialias)
        elif isinstance(antialias, ConeFilter):
            for (a, b, c, d), _ in cut_path([x1, y1, x2, y2], False, False):
                self._rectangle(a, b, c, d, min(width, FIXED_REACH * 256), square, antialias)
        else:
            samples: Supersample = as_samples(antialias)
            slab_far(self.surface, x1, y1, x2, y2, width, square, samples.n, samples.corner)

    def lines(
        self,
        segments: ArrayLike,
        c: Level = None,
        *,
        width: Real = 1,
        cap: Str = "square",
        dash: Iterable[Real] | None = None,
        algorithm: Str = "bresenham",
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw many lines in one call: as `line` for each row (x1, y1, x2, y2) of an array of shape (n, 4).

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(8, 3)
        >>> fb.lines([[0, 0, 7, 0], [0, 2, 7, 2]])
        >>> print(fb)
        ########
        ........
        ########
        """
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        shape: cython.int = _SQUARE if is_word(cap, "square") else choice("cap", cap, CAPS)
        dda: cython.bint = False if is_word(algorithm, "bresenham") else choice("algorithm", algorithm, _ALGORITHMS)
        as_samples(antialias)
        pattern = dash_lengths(dash)
        wide = line_width(width)
        thin: cython.bint = antialias is None and wide == 256
        unit: cython.longlong = 1 if thin else 256
        reach: cython.longlong = NEAR if thin else FIXED_REACH
        numbers = quick_rows(segments, 4, False, unit, reach)
        if numbers is None:
            segments = table("segments", segments, 4)
            numbers = integers(segments, unit, reach * unit)
        if numbers is None or wide > _WIDE or (not thin and (pattern or shape == _ROUND)):
            style: Any = {"width": width, "cap": cap, "dash": dash, "algorithm": algorithm, "antialias": antialias}
            for x1, y1, x2, y2 in table("segments", segments, 4).tolist():
                self.line(x1, y1, x2, y2, c, op=op, **style)
        elif thin:
            self._thin_lines(numbers, dash_steps(pattern), dda)
        else:
            self._thick_lines(numbers, wide, shape == _SQUARE, antialias)

    @cython.cfunc
    def _thin_lines(self, numbers: Any, lengths: Any, dda: cython.bint) -> Any:
        row: cython.Py_ssize_t
        p: cython.p_longlong = pointer_to_int64(numbers)
        pattern: cython.p_longlong = pointer_to_int64(lengths)
        count: cython.Py_ssize_t = len(lengths) // 8
        for row in range(0, len(numbers) // 8, 4):
            if count or dda:
                dashed(self.surface, p[row], p[row + 1], p[row + 2], p[row + 3], pattern, count, 0, dda)
            else:
                bresenham(self.surface, p[row], p[row + 1], p[row + 2], p[row + 3])

    @cython.cfunc
    def _thick_lines(self, numbers: Any, width: cython.longlong, square: cython.bint, antialias: Any) -> Any:
        row: cython.Py_ssize_t
        p: cython.p_longlong = pointer_to_int64(numbers)
        for row in range(0, len(numbers) // 8, 4):
            self._rectangle(p[row], p[row + 1], p[row + 2], p[row + 3], width, square, antialias)

    def points(self, xy: ArrayLike, c: Level = None, *, op: Str = "over") -> None:
        """Paint many pixels in one call: the rows (x, y) of an array of shape (n, 2).

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(4, 2)
        >>> fb.points([[0, 0], [3, 1]])
        >>> print(fb)
        #...
        ...#
        """
        self._dip(c, op)
        numbers = quick_rows(xy, 2, False, 1, NEAR)
        if numbers is None:
            rows = table("xy", xy, 2)
            numbers = integers(rows, 1, NEAR)
        if numbers is None:
            for x, y in rows.tolist():
                self.pixel(x, y, self.surface.max_level if c is None else c, op=op)
            return
        row: cython.Py_ssize_t
        points: cython.p_longlong = pointer_to_int64(numbers)
        for row in range(0, len(numbers) // 8, 2):
            self.surface.point(points[row], points[row + 1])
