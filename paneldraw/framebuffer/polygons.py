# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The calls that draw through a list of points."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

import cython

from paneldraw.framebuffer.arguments import as_samples, choice, dash_lengths, in_turn, real
from paneldraw.raster.far import cut_polygon, is_flat
from paneldraw.raster.strokes import CAPS, JOINS

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer._words import is_word
    from cython.cimports.paneldraw.framebuffer.arguments import Points, line_width, quick
else:
    from paneldraw.framebuffer._words import is_word
    from paneldraw.framebuffer.arguments import Points, line_width, quick
    from paneldraw.framebuffer.lines import Lines

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from paneldraw.framebuffer.arguments import AntialiasOrDefault, Level, Real, Str

_RULES = {"even-odd": 0, "nonzero": 1}


@cython.cclass
class Polygons(Lines):
    """The calls that draw through a list of points."""

    def polyline(
        self,
        points: ArrayLike,
        c: Level = None,
        *,
        closed: bool = False,
        width: Real = 1,
        cap: Str = "square",
        join: Str = "miter",
        dash: Iterable[Real] | None = None,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw lines from point to point, as one shape: where they meet or cross, a pixel is painted once.

        Parameters
        ----------
        points : array_like
            Shape (n, 2), or x and y in turn. One point is a line of no length; none draws nothing.
        c : int, optional
        closed : bool, default False
            Whether a line leads from the last point back to the first.
        width, cap, dash, antialias, op
            As for `line`. The dash pattern goes on around corners.
        join : {"miter", "round", "bevel"}
            How the outer side of a thick line's corner is filled: to a point, unless that lies more than 4 half widths
            away, else like a bevel; by an arc (a polygon within a 256th of a pixel of it); or by a straight cut.

        Raises
        ------
        ValueError
            If `points` are not points or `join` is none of these, and as for `line`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(7, 4)
        >>> fb.polyline([(0, 3), (3, 0), (6, 3)])
        >>> print(fb)
        ...#...
        ..#.#..
        .#...#.
        #.....#
        """
        self._dip(c, op)
        self._outline("points", points, closed, width, cap, join, dash, antialias)

    def triangle(
        self,
        x1: Real,
        y1: Real,
        x2: Real,
        y2: Real,
        x3: Real,
        y3: Real,
        c: Level = None,
        fill: bool = False,
        *,
        width: Real = 1,
        join: Str = "miter",
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw a triangle: its outline, or with `fill` what it encloses, as `poly` does.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(7, 4)
        >>> fb.triangle(0, 3, 3, 0, 6, 3)
        >>> print(fb)
        ...#...
        ..#.#..
        .#...#.
        #######
        """
        corners: Any = (x1, y1, x2, y2, x3, y3)
        for name, number in zip(("x1", "y1", "x2", "y2", "x3", "y3"), corners, strict=True):
            if type(number) is not int:
                real(name, number)
        self.poly(0, 0, corners, c, fill, width=width, join=join, antialias=antialias, op=op)

    def poly(
        self,
        x: Real,
        y: Real,
        coords: ArrayLike,
        c: Level = None,
        fill: bool = False,
        *,
        rule: Str = "even-odd",
        width: Real = 1,
        join: Str = "miter",
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw a polygon, which may cross itself: its outline, or with `fill` what it encloses.

        A pixel is in the filled polygon if its center is. A center on an edge is in if the inside lies to its right,
        or, on a horizontal edge, below: polygons that share an edge share no pixel and leave none out. The outline
        follows the same edges to the nearest pixel, so that fill and outline together have no gap. A filled polygon
        without an area, as of two points, is its outline.

        Parameters
        ----------
        x, y : int or float
            Added to all points.
        coords : array_like
            The corners: x and y in turn, as in ``array("h", [0, 0, 9, 5, 0, 9])``, or an array of shape (n, 2).
        c : int, optional
        fill : bool, default False
        rule : {"even-odd", "nonzero"}
            What is inside where a polygon crosses itself: what it goes around an odd number of times, or any number.
        width, join, antialias, op
            As for `polyline`.

        Raises
        ------
        ValueError
            If `coords` are not points or `rule` is neither of the two, and as for `polyline`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(7, 4)
        >>> fb.poly(0, 0, [0, 0, 6, 0, 3, 4], fill=True)
        >>> print(fb)
        ######.
        .#####.
        ..###..
        ...#...
        """
        nonzero: cython.bint = False if is_word(rule, "even-odd") else choice("rule", rule, _RULES)
        self._dip(c, op)
        if quick(x) != 0 or quick(y) != 0:
            coords = _shifted(real("x", x), real("y", y), coords)
        if fill:
            if not is_word(join, "miter"):
                choice("join", join, JOINS)
            line_width(width)
            corners = Points("coords", coords, True)
            if not _is_flat(corners):
                self._fill_polygon(corners, nonzero, self._antialias if antialias is ... else antialias)
                return
        self._outline("coords", coords, True, width, "square", join, None, antialias)

    @cython.cfunc
    def _fill_polygon(self, corners: Points, nonzero: cython.bint, antialias: Any) -> Any:
        end: cython.Py_ssize_t[1]
        if not cython.compiled:
            end = [0]
        if corners.exact is not None:
            corners = Points("coords", cut_polygon(corners.exact), False)
        end[0] = corners.count
        self._fill_contours(corners.values, end, 1, nonzero, antialias, 256)

    @cython.cfunc
    def _outline(
        self,
        name: Any,
        coords: Any,
        closed: cython.bint,
        width: Any,
        cap: Any,
        join: Any,
        dash: Any,
        antialias: Any,
    ) -> Any:
        """Read the arguments of a path and paint it."""
        if antialias is ...:
            antialias = self._antialias
        shape: cython.int = choice("cap", cap, CAPS)
        corner: cython.int = choice("join", join, JOINS)
        as_samples(antialias)
        wide = line_width(width)
        lengths = dash_lengths(dash)
        if antialias is None and wide == 256:
            self._thin_path(Points(name, coords, False), closed, lengths, False)
        else:
            self._stroke(Points(name, coords, True), closed, wide, shape, corner, lengths, antialias)


@cython.cfunc
def _is_flat(corners: Points) -> cython.bint:
    """Whether all corners lie on one line."""
    if corners.exact is not None:
        return is_flat(corners.exact)
    i: cython.Py_ssize_t
    p: cython.p_longlong = corners.values
    dx: cython.longlong = 0
    dy: cython.longlong = 0
    for i in range(2, 2 * corners.count, 2):
        if (p[i] - p[0]) * dy != (p[i + 1] - p[1]) * dx:
            return False
        if dx == 0 and dy == 0:
            dx = p[i] - p[0]
            dy = p[i + 1] - p[1]
    return True


def _shifted(x: Any, y: Any, coords: Any) -> list[Any]:
    """The points `coords`, moved by (x, y)."""
    points = in_turn("coords", coords)
    return [_sum(real("coords", number), y if i % 2 else x) for i, number in enumerate(points)]


def _sum(a: Any, b: Any) -> Any:
    """a + b; where floats would overflow, of their whole parts: there is no more to such numbers."""
    try:
        total = a + b
    except OverflowError:
        return int(a) + int(b)
    return total if isinstance(total, int) or isfinite(total) else int(a) + int(b)
