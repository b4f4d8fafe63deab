# cython: annotation_typing=False, nonecheck=True
"""The framebuffer: the pixels, and the drawing calls of a script.

A call reads its arguments, says what it paints with, and leaves it to `raster` which pixels that are.
"""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any

import cython
import numpy as np
from cython.cimports.paneldraw.framebuffer.arguments import FAR, is_word, level, level_named, near_pixel, quick, rows_of
from cython.cimports.paneldraw.framebuffer.copying import (
    copy_levels,
    move_levels,
    operation,
    paint_picture,
    paint_seen,
    set_text,
    write_box,
    write_text,
)
from cython.cimports.paneldraw.framebuffer.painter import Painter
from cython.cimports.paneldraw.raster.surface import OVER, Surface

from paneldraw._signatures import SignatureOfInit
from paneldraw.framebuffer import pictures
from paneldraw.framebuffer.alignment import ALIGNMENTS, aligned_box, aligned_radius, outward
from paneldraw.framebuffer.angles import sweep
from paneldraw.framebuffer.arguments import LARGEST, check_antialias, choice, in_turn, line_width, real, size, whole
from paneldraw.framebuffer.paints import Paint, covered_box
from paneldraw.framebuffer.scaling import check_fit, checked_size
from paneldraw.raster.surface import OPS

if TYPE_CHECKING:
    from collections.abc import Iterable
    from os import PathLike
    from typing import SupportsIndex

    from numpy.typing import ArrayLike, NDArray
    from PIL import Image

    from paneldraw.framebuffer.arguments import Antialias, AntialiasOrDefault
    from paneldraw.framebuffer.pictures import Dither
    from paneldraw.framebuffer.scaling import Fit
    from paneldraw.framebuffer.sprites import Sprite
    from paneldraw.simulator.looks import Look
    from paneldraw.text import Font
    from paneldraw.text.box import Align, Valign, Wrap
    from paneldraw.text.layout import Direction

_DEPTHS = (1, 2, 4, 8)
_ALGORITHMS = {"bresenham": 0, "dda": 1}
_RULES = {"even-odd": 0, "nonzero": 1}
_EDGES = {"shared": 0, "covered": 1}
_HEADS = {"end": 1, "start": 2, "both": 3}

# The attributes that are no subclass's.
_OWN = {"pixels", "depth", "surface", "painter", "_whole", "_clips"}


class _Instead:
    """In the place of a call that other libraries have: an AttributeError that says what to write."""

    def __init__(self, name: str, call: str) -> None:
        self._advice = f"a framebuffer has no {name}: write {call}"

    def __get__(self, framebuffer: object, owner: object) -> _Instead:
        if framebuffer is not None:
            raise AttributeError(self._advice)
        return self

    def __repr__(self) -> str:
        return f"<{self._advice}>"


@cython.cclass
class Framebuffer:
    """A picture in memory, one byte a pixel, and the calls that draw on it.

    x runs right and y down from (0, 0), the center of the top-left pixel. What lies outside is clipped away; no
    coordinate is too large. Whole coordinates and floats are welcome everywhere; aliased shapes take the nearest pixel,
    round ones the nearest half.

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
    (default: the highest) or a paint, and `op` says how it meets the level that is there: ``"over"`` replaces it,
    ``"xor"`` combines the bits, ``"add"`` adds up to the highest level, ``"max"`` keeps the higher and ``"clear"``
    makes it 0.

    A paint, a `Pattern` or `Gradient`, has a level for every pixel, with which that one is painted, once a call, as far
    as the shape covers it: to the nearest 255th, and with one bit a pixel where that is half or more.

    Aliased and of width 1, curves are the midpoint method's. Wider or anti-aliased, an outline goes along the true
    curve, half of its width on either side, and a pixel or sub-pixel is in it if its reference point is. Filled, a
    rectangle or round shape is its outline and all that this encloses, and so goes on for half a width beyond the true
    curve: by default half a pixel. Of a filled polygon see `poly`. Fractions of a pixel are taken to the nearest 256th.

    Shapes within 131,072 pixels of (0, 0) are exact. What reaches further is cut there, and may be off by a pixel.

    Framebuffers copy, pickle and compare as arrays do; a copy of a `view` has pixels of its own.

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

    if TYPE_CHECKING:
        pixels: NDArray[np.uint8]
        depth: int

    else:
        # What people know from Adafruit's libraries and from Pillow.
        fill_rect = _Instead("fill_rect", "rect(x, y, w, h, c, fill=True)")
        rectangle = _Instead("rectangle", "rect(x, y, w, h, c)")
        rounded_rect = _Instead("rounded_rect", "round_rect(x, y, w, h, r, c)")

    __signature__ = SignatureOfInit()

    def __init__(
        self, width: SupportsIndex, height: SupportsIndex, depth: int = 1, *, antialias: Antialias = None
    ) -> None:
        width, height = size("width", width), size("height", height)
        for name, side in (("width", width), ("height", height)):
            if not 1 <= side <= LARGEST:
                raise ValueError(f"{name} must be from 1 to {LARGEST} pixels, not {side}")
        depth = size("depth", depth)
        if depth not in _DEPTHS:
            raise ValueError(f"depth must be 1, 2, 4 or 8 bits a pixel, not {depth!r}")
        # While an array looks at a bytearray, nobody can change its size.
        memory = bytearray(width * height)
        self.pixels = np.frombuffer(memory, np.uint8).reshape(height, width)
        self.depth = depth
        self._draw_on(Surface(memory, 0, width, width, height, (1 << depth) - 1), antialias)

    def _draw_on(self, surface, antialias):
        """Draw on this surface."""
        self.surface = surface
        self.painter = Painter(surface, antialias)
        self._whole = (surface.left, surface.top, surface.right, surface.bottom)
        self._clips = []

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
        return self.painter.antialias

    @antialias.setter
    def antialias(self, value: Antialias) -> None:
        check_antialias(value)
        self.painter.antialias = value

    def _draw_with_paint(self, name, given):
        """Draw with a paint: its levels, as far as the same call with the highest level covers pixels of 8 bits."""
        del given["self"]
        paint, op = given.pop("c"), given.pop("op", "over")
        code: cython.int = operation(op)
        shape = self._blank()
        if name == "flood_fill":
            if given["border"] is not None:
                level_named("border", self.surface, given["border"])
            shape.pixels[...] = self.pixels
            result = shape.flood_fill(c=255, op="xor", **given)
            cover = np.where(shape.pixels == self.pixels, np.uint8(0), np.uint8(255))
        else:
            result = getattr(shape, name)(c=255, **given)
            cover = shape.pixels
        if code == OVER and given.get("inverse"):
            # The characters are dark.
            getattr(self, name)(c=0, **given)
        self._cover(cover, paint, op)
        return result

    def _aligned(self, name, given):
        """Draw the part of a twice as wide outline that is inside of a polygon, or outside; or fill it as far as that.

        It is taken pixel by pixel, so it is exact but for pixels that more than one side of the outline goes through.
        """
        del given["self"]
        c, op, fill, width = (given.pop(name) for name in ("c", "op", "fill", "width"))
        inside = choice("align", given.pop("align"), ALIGNMENTS) == ALIGNMENTS["inside"]
        line_width(width)
        operation(op)
        area, stroke = self._blank(), self._blank()
        getattr(area, name)(c=255, fill=True, **given)
        getattr(stroke, name)(c=255, width=2 * width, **given)
        if inside:
            cover = area.pixels if fill else np.minimum(area.pixels, stroke.pixels)
        else:
            cover = np.maximum(area.pixels, stroke.pixels)
            cover = cover if fill else cover - area.pixels
        self._cover(cover, level(self.surface, c), op)

    def _blank(self):
        """A framebuffer of 8 bits a pixel, as large and clipped alike, to find on what a shape covers."""
        mine: Surface = self.surface
        shape = Framebuffer(mine.width, mine.height, 8, antialias=self.painter.antialias)
        shape.surface.set_window(mine.left, mine.top, mine.right, mine.bottom)
        return shape

    def _cover(self, cover, c, op):
        """Paint pixels with a level or a paint as far as they are covered, in 255ths."""
        box = covered_box(cover)
        if box is None:
            return
        left, top, right, bottom = box
        cover = cover[top:bottom, left:right]
        if _is_paint(c):
            levels, opacity = c.levels(box, self.surface.max_level)
            if opacity is not None:
                cover = np.rint(cover * (opacity / 255)).astype(np.uint8)
        else:
            levels = np.full(cover.shape, c, np.uint8)
        copy_levels(self.surface, levels, cover, left, top, -1, None, op)

    # -- Points and lines

    def fill(self, c: int | Paint | None) -> None:
        """Set every pixel, or within `clip` those of its window, to level `c` (None: the highest)."""
        if _is_paint(c):
            self._draw_with_paint("fill", locals())
            return
        self.painter.fill(c)

    def clear(self) -> None:
        """Set every pixel, or within `clip` those of its window, to level 0."""
        self.fill(0)

    @cython.locals(surface=Surface, column=cython.longlong, row=cython.longlong, color=cython.longlong)
    def pixel(self, x: int | float, y: int | float, c: int | Paint | None = None, *, op: str = "over") -> int | None:
        """Paint one pixel with level `c`, or, with no level given, return the level it has (0 outside).

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(4, 2, depth=4)
        >>> fb.pixel(1, 0, 9)
        >>> fb.pixel(1, 0)
        9
        """
        surface = self.surface
        column = quick(x)
        row = quick(y)
        if column == FAR or row == FAR:
            column, row = near_pixel("x", x), near_pixel("y", y)
        if c is None:
            if 0 <= column < surface.width and 0 <= row < surface.height:
                return surface.pixels[row * surface.stride + column]
            return 0
        color = quick(c)
        if not 0 <= color <= surface.max_level:
            if _is_paint(c):
                self._draw_with_paint("pixel", {"self": self, "x": x, "y": y, "c": c, "op": op})
                return None
            color = level(surface, c)
        if not is_word(op, "over"):
            surface.paint_with(cython.cast(cython.int, color), choice("op", op, OPS))
            surface.point(column, row)
        elif surface.left <= column < surface.right and surface.top <= row < surface.bottom:
            surface.pixels[row * surface.stride + column] = color
        return None

    def hline(
        self, x: int | float, y: int | float, w: int | float, c: int | Paint | None = None, *, op: str = "over"
    ) -> None:
        """Draw a horizontal line of `w` pixels from (x, y) to the right; a negative `w` raises ``ValueError``."""
        if _is_paint(c):
            self._draw_with_paint("hline", locals())
            return
        self.painter.run(x, y, w, True, c, op)

    def vline(
        self, x: int | float, y: int | float, h: int | float, c: int | Paint | None = None, *, op: str = "over"
    ) -> None:
        """Draw a vertical line of `h` pixels from (x, y) downward; a negative `h` raises ``ValueError``."""
        if _is_paint(c):
            self._draw_with_paint("vline", locals())
            return
        self.painter.run(x, y, h, False, c, op)

    def line(
        self,
        x1: int | float,
        y1: int | float,
        x2: int | float,
        y2: int | float,
        c: int | Paint | None = None,
        *,
        width: int | float = 1,
        cap: str = "square",
        dash: Iterable[int | float] | None = None,
        algorithm: str = "bresenham",
        antialias: AntialiasOrDefault = ...,
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
        cap : {"square", "butt", "round"}
            Whether a thick line reaches half a width beyond its end points, ends there, or ends in half a disc (a
            polygon within a 256th of a pixel of it). An aliased line of width 1 has no caps.
        dash : iterable of int or float, optional
            Lengths in pixels, each 1 or more, drawn and left out in turn from where the line begins, over and over;
            with an odd number of them, what was drawn is left out the next time. An aliased line of width 1 counts
            pixels; others measure along the line. A round cap ends every dash, a square one the line.
        algorithm : {"bresenham", "dda"}
            How the pixels of an aliased line of width 1 are found. They are the same; the DDA is there to compare.
        antialias : Supersample, ConeFilter or None, optional
            Default: the framebuffer's.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        TypeError
            If `dash` is not a sequence of numbers.
        ValueError
            If `width` is below 1/256, `dash` is empty or a length of it below 1, or `cap`, `algorithm` or `op` is none
            of these.

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
        if _is_paint(c):
            self._draw_with_paint("line", locals())
            return
        style = self.painter.style(c, op, width, antialias, cap, "miter", dash)
        dda = 0 if is_word(algorithm, "bresenham") else choice("algorithm", algorithm, _ALGORITHMS)
        self.painter.line(x1, y1, x2, y2, style, dda)

    def lines(
        self,
        segments: ArrayLike,
        c: int | Paint | None = None,
        *,
        width: int | float = 1,
        cap: str = "square",
        dash: Iterable[int | float] | None = None,
        algorithm: str = "bresenham",
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw many lines in one call: as `line` for each row (x1, y1, x2, y2) of an array of shape (n, 4).

        Parameters
        ----------
        segments : array_like
            Shape (n, 4).
        c, width, cap, dash, algorithm, antialias, op
            As for `line`. Each line begins the dash pattern anew.

        Raises
        ------
        ValueError
            If `segments` are not rows of four finite numbers, and as for `line`. Nothing is painted then.

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
        if _is_paint(c):
            self._draw_with_paint("lines", locals())
            return
        style = self.painter.style(c, op, width, antialias, cap, "miter", dash)
        dda = 0 if is_word(algorithm, "bresenham") else choice("algorithm", algorithm, _ALGORITHMS)
        self.painter.segments(rows_of("segments", segments, 4, 1 if style.thin else 256), style, dda)

    def points(self, xy: ArrayLike, c: int | Paint | None = None, *, op: str = "over") -> None:
        """Paint many pixels in one call: the rows (x, y) of an array of shape (n, 2).

        A pixel that is there twice is painted twice.

        Raises
        ------
        ValueError
            If `xy` are not rows of two finite numbers. Nothing is painted then.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(4, 2)
        >>> fb.points([[0, 0], [3, 1]])
        >>> print(fb)
        #...
        ...#
        """
        if _is_paint(c):
            self._draw_with_paint("points", locals())
            return
        self.painter.paint_with(c, op)
        self.painter.points(rows_of("xy", xy, 2, 1))

    def arrow(
        self,
        x1: int | float,
        y1: int | float,
        x2: int | float,
        y2: int | float,
        c: int | Paint | None = None,
        *,
        heads: str = "end",
        head: int | float | None = None,
        width: int | float = 1,
        cap: str = "square",
        dash: Iterable[int | float] | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw the line from (x1, y1) to (x2, y2) with an arrow head at its end, as one shape.

        A head is a filled triangle with its tip at the end point, as broad as it is long. `polyline`, `bezier` and
        `curve` have heads too.

        Parameters
        ----------
        x1, y1, x2, y2 : int or float
        c : int, optional
        heads : {"end", "start", "both"}
            Where there is a head: at (x2, y2), at (x1, y1), or at both.
        head : int or float, optional
            How long a head is, in pixels. Default: a pixel and three times the width.
        width, cap, dash, antialias, op
            As for `line`. An end with a head has no cap.

        Raises
        ------
        ValueError
            If `head` is negative or `heads` is none of these, and as for `line`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(12, 5)
        >>> fb.arrow(0, 2, 11, 2)
        >>> print(fb)
        .......#....
        .......###..
        ############
        .......###..
        .......#....
        """
        if _is_paint(c):
            self._draw_with_paint("arrow", locals())
            return
        points = [real(name, number) for name, number in (("x1", x1), ("y1", y1), ("x2", x2), ("y2", y2))]
        style = self.painter.style(c, op, width, antialias, cap, "miter", dash)
        self.painter.arrow(0, "points", points, head, _pointed(heads), style)

    # -- Paths

    def polyline(
        self,
        points: ArrayLike,
        c: int | Paint | None = None,
        *,
        closed: bool = False,
        width: int | float = 1,
        cap: str = "square",
        join: str = "miter",
        dash: Iterable[int | float] | None = None,
        heads: str | None = None,
        head: int | float | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
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
            away, else like a bevel; by an arc (a polygon within a 256th of a pixel of it); or by a straight edge.
        heads : {"end", "start", "both"}, optional
            Where an open path has an arrow head, as `arrow` has: its tip at the end point, the middle of its base where
            the path is `head` pixels away from that for the last time, and what is between left out.
        head : int or float, optional
            How long a head is, in pixels. Default: a pixel and three times the width.

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
        if _is_paint(c):
            self._draw_with_paint("polyline", locals())
            return
        style = self.painter.style(c, op, width, antialias, cap, join, dash)
        if heads is not None:
            self.painter.arrow(0, "points", points, head, _pointed(heads, closed), style)
        else:
            self.painter.path("points", points, closed, style)

    def bezier(
        self,
        points: ArrayLike,
        c: int | Paint | None = None,
        *,
        closed: bool = False,
        fill: bool = False,
        width: int | float = 1,
        cap: str = "square",
        join: str = "miter",
        dash: Iterable[int | float] | None = None,
        heads: str | None = None,
        head: int | float | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a Bézier curve, quadratic or cubic, or cubic ones in a chain.

        Aliased and of width 1, it has in each column the pixel nearest to the true curve, where that is nearer to the
        horizontal, else in each row, and those nearest to the points that it goes through. Wider or anti-aliased, it is
        the stroke along chords within a quarter of a 256th of a pixel of the true curve.

        Parameters
        ----------
        points : array_like
            Three points are a quadratic curve's: where it begins, its control point, where it ends. Four are a cubic
            one's, with two control points. 7, 10, ... are cubic ones in a chain, where each begins at the end of the
            one before. One point is a line of no length; none draws nothing.
        c : int, optional
        closed : bool, default False
            Whether a line leads from the end back to the beginning, if that is elsewhere.
        fill : bool, default False
            Whether to fill what the closed curve encloses, as `poly` does by its even-odd rule.
        width, cap, dash, antialias, op
            As for `line`. An aliased curve of width 1 counts pixels of the dash pattern.
        join : {"miter", "round", "bevel"}
            As for `polyline`; where pieces of a chain meet at an angle, and at cusps.
        heads, head
            As for `polyline`.

        Raises
        ------
        ValueError
            If `points` are not so many points, and as for `polyline`.

        Notes
        -----
        P. de Casteljau's midpoints halve a curve until its chords are flat: G. Farin, "Curves and Surfaces for CAGD",
        5th ed. (2002), chapter 4.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(12, 6)
        >>> fb.bezier([(0, 5), (2, -4), (9, 10), (11, 0)])
        >>> print(fb)
        ...........#
        ...........#
        ..###.....#.
        .#...##...#.
        #......###..
        #...........
        """
        if _is_paint(c):
            self._draw_with_paint("bezier", locals())
            return
        style = self.painter.style(c, op, width, antialias, cap, join, dash)
        if heads is not None:
            self.painter.arrow(1, "points", points, head, _pointed(heads, closed or fill), style)
        else:
            self.painter.curve(points, closed or fill, fill, style)

    def curve(
        self,
        points: ArrayLike,
        c: int | Paint | None = None,
        *,
        closed: bool = False,
        fill: bool = False,
        width: int | float = 1,
        cap: str = "square",
        join: str = "miter",
        dash: Iterable[int | float] | None = None,
        heads: str | None = None,
        head: int | float | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a smooth curve through points.

        It is the centripetal Catmull-Rom curve, which never makes a loop or cusp between two points, drawn as `bezier`
        draws. Through two points it is a line.

        Parameters
        ----------
        points : array_like
            Shape (n, 2), or x and y in turn. A point that repeats the one before counts once.
        c : int, optional
        closed : bool, default False
            Whether the curve goes on from the last point to the first.
        fill : bool, default False
            As for `bezier`.
        width, cap, join, dash, heads, head, antialias, op
            As for `bezier`.

        Raises
        ------
        ValueError
            If `points` are not points, and as for `polyline`.

        Notes
        -----
        E. Catmull and R. Rom, "A class of local interpolating splines", in Computer Aided Geometric Design (1974),
        317-326; C. Yuksel, S. Schaefer and J. Keyser, "Parameterization and applications of Catmull-Rom curves",
        Computer-Aided Design 43 (2011), 747-755.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(13, 6)
        >>> fb.curve([(0, 5), (3, 0), (8, 5), (12, 2)])
        >>> print(fb)
        ...#.........
        ..#.#........
        .#...#......#
        .#....#....#.
        .#.....#..#..
        #.......##...
        """
        if _is_paint(c):
            self._draw_with_paint("curve", locals())
            return
        style = self.painter.style(c, op, width, antialias, cap, join, dash)
        if heads is not None:
            self.painter.arrow(2, "points", points, head, _pointed(heads, closed or fill), style)
        else:
            self.painter.smooth(points, closed or fill, fill, style)

    def triangle(
        self,
        x1: int | float,
        y1: int | float,
        x2: int | float,
        y2: int | float,
        x3: int | float,
        y3: int | float,
        c: int | Paint | None = None,
        fill: bool = False,
        *,
        width: int | float = 1,
        align: str = "center",
        join: str = "miter",
        dash: Iterable[int | float] | None = None,
        edges: str = "covered",
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a triangle: its outline, or with `fill` what it encloses, as `poly` does.

        Parameters
        ----------
        x1, y1, x2, y2, x3, y3 : int or float
            The corners.
        c, fill, width, align, join, dash, edges, antialias, op
            As for `poly`.

        Raises
        ------
        ValueError
            As for `poly`.

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
        if _is_paint(c):
            self._draw_with_paint("triangle", locals())
            return
        if not is_word(align, "center"):
            self._aligned("triangle", locals())
            return
        style = self.painter.style(c, op, width, antialias, "square", join, dash)
        covered = 1 if is_word(edges, "covered") else choice("edges", edges, _EDGES)
        self.painter.triangle(x1, y1, x2, y2, x3, y3, fill, covered, style)

    def poly(
        self,
        x: int | float,
        y: int | float,
        coords: ArrayLike,
        c: int | Paint | None = None,
        fill: bool = False,
        *,
        rule: str = "even-odd",
        edges: str = "covered",
        width: int | float = 1,
        align: str = "center",
        join: str = "miter",
        dash: Iterable[int | float] | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a polygon, which may cross itself: its outline, or with `fill` what it encloses.

        A pixel or sub-pixel is in the filled polygon if its reference point is. A point on an edge is in if the inside
        lies to its right, or, on a horizontal edge, below: polygons that share an edge share no point and leave none
        out. An aliased one covers, besides, its outline one pixel wide, unless `edges` says that they are shared.
        A filled polygon without an area, as of two points, is its outline.

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
        edges : {"covered", "shared"}
            Whether an aliased filled polygon is at least its outline, or shares no pixel with a neighbor.
        width, join, dash
            As for `polyline`; of the outline that is drawn without `fill`.
        align : {"center", "inside", "outside"}
            Where the outline lies: half of it on either side of the edges; or all of it inside or outside of what the
            polygon fills, exact but for pixels that more than one side of the outline goes through. Filled, it ends
            where that does.
        antialias, op
            As for `line`.

        Raises
        ------
        ValueError
            If `coords` are not points, `rule` or `edges` is neither of the two, and as for `polyline`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(7, 4)
        >>> fb.poly(0, 0, [0, 0, 6, 0, 3, 3], fill=True)
        >>> print(fb)
        #######
        .#####.
        ..###..
        ...#...
        """
        if _is_paint(c):
            self._draw_with_paint("poly", locals())
            return
        if not is_word(align, "center"):
            self._aligned("poly", locals())
            return
        nonzero = 0 if is_word(rule, "even-odd") else choice("rule", rule, _RULES)
        covered = 1 if is_word(edges, "covered") else choice("edges", edges, _EDGES)
        style = self.painter.style(c, op, width, antialias, "square", join, dash)
        if type(x) is not int or type(y) is not int or x != 0 or y != 0:
            coords = _shifted(real("x", x), real("y", y), coords)
        self.painter.polygon(coords, fill, nonzero, covered, style)

    # -- Rectangles and round shapes

    def rect(
        self,
        x: int | float,
        y: int | float,
        w: int | float,
        h: int | float,
        c: int | Paint | None = None,
        fill: bool = False,
        *,
        angle: int | float = 0,
        width: int | float = 1,
        align: str = "center",
        dash: Iterable[int | float] | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a rectangle of `w` x `h` pixels, its top-left pixel at (x, y): the outline, or with `fill` all of it.

        Its true outline leads through the centers of the outermost pixels, so that the rectangle reaches from
        x - 1/2 to x + w - 1/2 and from y - 1/2 to y + h - 1/2, whole numbers or not.

        Parameters
        ----------
        x, y : int or float
        w, h : int or float
            Size in pixels. A width or height of 0 draws nothing.
        c : int, optional
        fill : bool, default False
        angle : int or float, default 0
            Degrees by which it is turned around its center, clockwise as the screen shows it. Aliased and of width 1,
            it is then the polygon with those corners.
        width : int or float, default 1
            Thickness of the outline in pixels, half of it on either side of the true outline.
        align : {"center", "inside", "outside"}
            Where the outline lies: half of it on either side of the true one; or all of it inside or outside of where
            the shape ends, half a pixel beyond the true outline. Filled, it ends where that does.
        dash : iterable of int or float, optional
            As for `line`, clockwise from the top-left corner; of the outline that is drawn without `fill`.
        antialias : Supersample, ConeFilter or None, optional
            Default: the framebuffer's.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        ValueError
            If `w` or `h` is negative, and as for `line`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(9, 4)
        >>> fb.rect(1, 0, 7, 4)
        >>> print(fb)
        .#######.
        .#.....#.
        .#.....#.
        .#######.
        """
        if _is_paint(c):
            self._draw_with_paint("rect", locals())
            return
        if not is_word(align, "center"):
            box = aligned_box((x, y, w, h), outward(align, width))
            # A second call, since arguments that are never set anew make the first one cheaper.
            form = {"width": width, "fill": fill} if box is not None else {"width": 1, "fill": True}
            self.rect(*(box or (x, y, w, h)), c, angle=angle, dash=dash, antialias=antialias, op=op, **form)
            return
        style = self.painter.style(c, op, width, antialias, "butt", "miter", dash)
        if quick(angle) != 0 and real("angle", angle) % 180 != 0:
            self.painter.turned_box(x, y, w, h, angle, fill, style)
        else:
            self.painter.box(x, y, w, h, 0, fill, style)

    def round_rect(
        self,
        x: int | float,
        y: int | float,
        w: int | float,
        h: int | float,
        r: int | float,
        c: int | Paint | None = None,
        fill: bool = False,
        *,
        corners: int = 0b1111,
        width: int | float = 1,
        align: str = "center",
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a rectangle with rounded corners: the outline, or with `fill` all of it.

        Parameters
        ----------
        x, y, w, h : int or float
            As for `rect`.
        r : int or float
            Radius of the corners. Of one too large, as much is taken as the sides have room for: half of the shorter
            one, less half a pixel. With 0 the corners are sharp, and it is `rect`. Halves count, as for `circle`.
        c, fill, width, align, antialias, op
            As for `rect`.
        corners : int, default 0b1111
            Which corners are round, bits as for the quarters of `ellipse`: 1 top right, 2 top left, 4 bottom left, 8
            bottom right. The others are sharp.

        Raises
        ------
        ValueError
            If `w`, `h` or `r` is negative, `width` is below 1/256, `corners` is not from 0 to 15, or `align` or
            `op` is none of these.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(9, 5)
        >>> fb.round_rect(0, 0, 9, 5, 2)
        >>> print(fb)
        .#######.
        #.......#
        #.......#
        #.......#
        .#######.
        """
        if _is_paint(c):
            self._draw_with_paint("round_rect", locals())
            return
        if not is_word(align, "center"):
            off = outward(align, width)
            box = aligned_box((x, y, w, h), off)
            # Round corners stay round, a little.
            r = max(r + off, 1 / 256) if box is not None and real("r", r) > 0 else r
            if box is None:
                width, fill = 1, True
            else:
                x, y, w, h = box
        style = self.painter.style(c, op, width, antialias, "butt")
        if quick(corners) == 15:
            self.painter.box(x, y, w, h, r, fill, style)
        elif 0 <= size("corners", corners) <= 15:
            self.painter.some_corners(x, y, w, h, r, corners, fill, style)
        else:
            raise ValueError(f"corners must be from 0 to 15, the sum of those to round of 1, 2, 4 and 8, not {corners}")

    def circle(
        self,
        x: int | float,
        y: int | float,
        r: int | float,
        c: int | Paint | None = None,
        fill: bool = False,
        *,
        width: int | float = 1,
        align: str = "center",
        dash: Iterable[int | float] | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw the circle of radius `r` around (x, y): its outline, or with `fill` the disc within it.

        Parameters
        ----------
        x, y, r : int or float
            A radius of 0 draws one pixel, or else a dot as large as the width. Aliased and of width 1, all three are
            taken to the nearest half: ``circle(4.5, 4.5, 4.5, fill=True)`` is 10 pixels wide.
        c, fill, width, align, dash, antialias, op
            As for `rect`, but dashes begin on the right. They are measured along the true circle.

        Raises
        ------
        ValueError
            If `r` is negative, and as for `line`.

        Notes
        -----
        J. E. Bresenham, "A linear algorithm for incremental digital display of circular arcs", CACM 20 (1977), 100-106.

        Examples
        --------
        >>> from paneldraw import Framebuffer, Supersample
        >>> fb = Framebuffer(14, 7, depth=4)
        >>> fb.circle(3, 3, 3)
        >>> fb.circle(10, 3, 3, antialias=Supersample(4))
        >>> print(fb)
        ..fff...5dfd5.
        .f...f.5c4.4c5
        f.....fd4...4d
        f.....ff.....f
        f.....fd4...4d
        .f...f.5c4.4c5
        ..fff...5dfd5.
        """
        if _is_paint(c):
            self._draw_with_paint("circle", locals())
            return
        if not is_word(align, "center"):
            radius = aligned_radius("r", r, outward(align, width))
            r, width, fill = (r, 1, True) if radius is None else (radius, width, fill)
        style = self.painter.style(c, op, width, antialias, "butt", "miter", dash)
        if style.dash is not None and not fill:
            self.painter.turn(x, y, r, 0, 0, 360, style)
            return
        self.painter.circle(x, y, r, fill, style)

    def ellipse(
        self,
        x: int | float,
        y: int | float,
        xr: int | float,
        yr: int | float,
        c: int | Paint | None = None,
        fill: bool = False,
        quadrants: int = 0b1111,
        *,
        angle: int | float = 0,
        width: int | float = 1,
        align: str = "center",
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw the ellipse with the radii `xr` and `yr` around (x, y), or some quarters of it.

        Wider or anti-aliased, the outline is what lies between two ellipses, whose radii are half a width larger and
        smaller. Across a slope that is a little less than the width.

        Parameters
        ----------
        x, y : int or float
        xr, yr : int or float
            With a radius of 0 the ellipse is a line. Halves count, as for `circle`.
        c : int, optional
        fill : bool, default False
        quadrants : int, default 0b1111
            The quarters to draw, bits as in MicroPython's framebuf: 1 top right, 2 top left, 4 bottom left, 8 bottom
            right. A quarter includes the pixels on its axes, half a pixel beyond the center.
        angle : int or float, default 0
            Degrees by which it is turned around its center, clockwise as the screen shows it; all of it, no quarters.
            Aliased and of width 1, a turned outline is found as that of `bezier`.
        width, align, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If a radius is negative, `width` is below 1/256, `quadrants` is not from 0 to 15, or other than 15 with an
            `angle`, or `op` is none of these.

        Notes
        -----
        J. R. Van Aken, "An efficient ellipse-drawing algorithm", IEEE Computer Graphics and Applications 4:9 (1984),
        24-35.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(11, 5)
        >>> fb.ellipse(5, 2, 5, 2)
        >>> print(fb)
        ..#######..
        .#.......#.
        #.........#
        .#.......#.
        ..#######..
        """
        if _is_paint(c):
            self._draw_with_paint("ellipse", locals())
            return
        quarters = size("quadrants", quadrants)
        if not 0 <= quarters <= 15:
            wanted = "the sum of those to draw of 1, 2, 4 and 8"
            raise ValueError(f"quadrants must be from 0 to 15, {wanted}, not {quadrants}")
        if not is_word(align, "center"):
            off = outward(align, width)
            a, b = aligned_radius("xr", xr, off), aligned_radius("yr", yr, off)
            xr, yr, width, fill = (xr, yr, 1, True) if a is None or b is None else (a, b, width, fill)
        style = self.painter.style(c, op, width, antialias)
        if quick(angle) == 0 or real("angle", angle) % 180 == 0:
            self.painter.ellipse(x, y, xr, yr, fill, quarters, style)
        elif quarters == 15:
            self.painter.turned_ellipse(x, y, xr, yr, angle % 360, fill, style)
        else:
            raise ValueError(f"quadrants must be 15, all of them, of an ellipse at an angle, not {quadrants}")

    def arc(
        self,
        x: int | float,
        y: int | float,
        r: int | float,
        start: int | float,
        end: int | float,
        c: int | Paint | None = None,
        *,
        yr: int | float | None = None,
        width: int | float = 1,
        cap: str = "butt",
        dash: Iterable[int | float] | None = None,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw the part of a circle that lies clockwise from the angle `start` to the angle `end`.

        Aliased, it is the part of the midpoint circle from the pixel nearest to the one end to the pixel nearest to the
        other, both included. Wider or anti-aliased, it goes along the true circle, half of its width on either side,
        and ends as `cap` says.

        Parameters
        ----------
        x, y, r : int or float
            As for `circle`.
        start, end : int or float
            Degrees clockwise from the x axis, as the screen shows them: 0 is right, 90 down, -90 up. If `end` is 360
            or more beyond `start`, it is the circle; else the arc goes on until it first comes to `end`. From an angle
            to the same one it is a pixel; where it is wider or anti-aliased, its two caps.
        yr : int or float, optional
            The radius downward and upward, if it is another one than `r`: then it is the part of an ellipse that lies
            between the directions of the two angles, drawn as `bezier` draws.
        c, width, antialias, op
            As for `rect`.
        cap : {"butt", "square", "round"}
            Whether a wider or anti-aliased arc ends straight at the angles, half a width beyond them, or in half a disc
            there. An aliased arc of width 1 has no caps.
        dash : iterable of int or float, optional
            As for `line`, from `start` on, measured along the true circle.

        Raises
        ------
        ValueError
            If `r` or `yr` is negative or an angle is not finite, and as for `line`.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(9, 5)
        >>> fb.arc(4, 4, 4, 180, 0)
        >>> print(fb)
        ...###...
        .##...##.
        .#.....#.
        #.......#
        #.......#
        """
        if _is_paint(c):
            self._draw_with_paint("arc", locals())
            return
        start, end = real("start", start), real("end", end)
        style = self.painter.style(c, op, width, antialias, cap, "miter", dash)
        swept = sweep(start, end)
        if yr is not None:
            self.painter.elliptical_turn(x, y, r, yr, start % 360, swept, style)
        elif swept >= 360 and style.dash is None:
            self.circle(x, y, r, c, width=width, antialias=antialias, op=op)
        else:
            self.painter.turn(x, y, r, start % 360, end % 360, swept, style)

    def sector(
        self,
        x: int | float,
        y: int | float,
        r: int | float,
        start: int | float,
        end: int | float,
        c: int | Paint | None = None,
        fill: bool = False,
        *,
        width: int | float = 1,
        antialias: AntialiasOrDefault = ...,
        op: str = "over",
    ) -> None:
        """Draw a slice of a disc, clockwise from the angle `start` to the angle `end`: its outline, or all of it.

        Aliased, its outline is `arc` and Bresenham's lines from the center to the ends of that; with `fill` it is these
        and all of the disc between them. Wider or anti-aliased, the outline goes along the true arc and the two radii,
        half of its width on either side, with a round corner at the center, and `fill` is the slice itself: slices that
        share an angle share no sub-pixel and leave none out, and the whole of them is the disc.

        Parameters
        ----------
        x, y, r : int or float
            As for `circle`.
        start, end : int or float
            As for `arc`; if `end` is 360 or more beyond `start`, it is the circle or disc. From an angle to the same
            one it is a radius, or with `fill`, where it is wider or anti-aliased, nothing.
        c, fill, width, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If `r` is negative, an angle is not finite, `width` is below 1/256, or `op` is none of these.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(8, 8)
        >>> fb.sector(0, 7, 7, -90, 0)
        >>> print(fb)
        ###.....
        #..##...
        #....#..
        #.....#.
        #.....#.
        #......#
        #......#
        ########
        """
        if _is_paint(c):
            self._draw_with_paint("sector", locals())
            return
        start, end = real("start", start), real("end", end)
        style = self.painter.style(c, op, width, antialias, "butt")
        swept = sweep(start, end)
        if swept >= 360:
            self.circle(x, y, r, c, fill, width=width, antialias=antialias, op=op)
        else:
            self.painter.slice(x, y, r, start % 360, end % 360, swept, fill, style)

    def flood_fill(
        self,
        x: int | float,
        y: int | float,
        c: int | Paint | None = None,
        *,
        border: int | None = None,
        op: str = "over",
    ) -> int:
        """Fill the area that (x, y) lies in: the pixels of its level that hang together with it.

        Pixels hang together that share a side; two that touch at a corner do not. So a line of Bresenham's, which steps
        from corner to corner, is a boundary. What `clip` and the edges of the picture leave out ends the area too.

        Parameters
        ----------
        x, y : int or float
            Where to begin, to the nearest pixel. Outside, nothing is filled.
        c : int, optional
        border : int, optional
            A level that bounds the area, whatever levels are within. Default: all that is not of the level at (x, y).
        op : {"over", "xor", "add", "max", "clear"}

        Returns
        -------
        int
            How many pixels the area has, all of which are painted, those of level `c` too.

        Raises
        ------
        ValueError
            If `c` or `border` is no level or `op` is none of these.

        Notes
        -----
        A. R. Smith, "Tint fill", SIGGRAPH 1979, 276-283.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(8, 5)
        >>> fb.line(0, 4, 4, 0)
        >>> fb.flood_fill(0, 0)
        10
        >>> print(fb)
        #####...
        ####....
        ###.....
        ##......
        #.......
        """
        if _is_paint(c):
            return self._draw_with_paint("flood_fill", locals())
        return self.painter.flood(x, y, c, border, op)

    # -- Text and pictures

    def text(
        self,
        s: str,
        x: int | float,
        y: int | float,
        c: int | Paint | None = None,
        *,
        font: Font | None = None,
        anchor: str = "la",
        line_spacing: int = 0,
        direction: Direction = "right",
        inverse: bool = False,
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
            Of the characters' lit pixels; the others stay as they are.
        font : Font, optional
            Default: the built-in font of 6 x 8 pixels a character. ``font.scaled(2)`` is twice as large.
        anchor : str, default "la"
            Which pixel of the text (x, y) means, in Pillow's letters: ``l``, ``m`` or ``r``; then ``a`` and ``d`` for
            the top and lowest row of the line, ``t`` and ``b`` for those that are lit, ``m``, or ``s`` for the row that
            the first line stands on. See `paneldraw.text.render`.
        line_spacing : int, default 0
            Rows between lines; negative to bring them closer.
        direction : {"right", "down", "left", "up"}, default "right"
            Where the text runs, as the whole of it is turned about (x, y) by quarter turns.
        inverse : bool, default False
            Whether the characters are dark, in a box of level `c` that reaches a pixel beyond the lines on each side.
            Where `op` is not ``"over"``, they are left as they were.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        ValueError
            If `anchor`, `direction` or `op` is none of these, or lines are closer than a row.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(9, 12)
        >>> fb.text("Hi", 8, 0, direction="down")
        >>> print(fb)
        ..#######
        .....#...
        .....#...
        .....#...
        ..#######
        .........
        .........
        ..#...#..
        ..#####.#
        ..#......
        .........
        .........
        """
        if _is_paint(c):
            self._draw_with_paint("text", locals())
            return
        self.painter.paint_with(c, op)
        if is_word(direction, "right") and inverse is False and quick(line_spacing) == 0:
            write_text(self.painter.coverage, s, x, y, font, anchor)
        else:
            set_text(self.painter.coverage, s, x, y, font, anchor, line_spacing, direction, inverse)

    def text_box(
        self,
        s: str,
        x: int | float,
        y: int | float,
        w: int | float,
        h: int | float,
        c: int | Paint | None = None,
        *,
        font: Font | None = None,
        align: Align = "left",
        valign: Valign = "top",
        wrap: Wrap = "word",
        ellipsis: str = "…",
        line_spacing: int = 0,
        inverse: bool = False,
        op: str = "over",
    ) -> str:
        """Write as much of a text as a box holds, in lines no wider than it.

        Parameters
        ----------
        s : str
            Ends of line in it stay.
        x, y : int or float
            The top-left pixel of the box. Nothing is drawn outside of the box.
        w, h : int or float
            Its size in pixels. A box lower than a line holds none.
        c : int, optional
            Of the characters' lit pixels; the others stay as they are.
        font : Font, optional
            Default: the built-in font of 6 x 8 pixels a character.
        align : {"left", "center", "right"}, default "left"
            Which side of the box the lines are flush with.
        valign : {"top", "middle", "bottom"}, default "top"
            Where they stand in it if it is higher.
        wrap : {"word", "letter", None}, default "word"
            Lines end where words do (see `paneldraw.text.wrap`), or behind any letter, or only where the text has an
            end of line; then each line that is too wide is cut.
        ellipsis : str, default "…"
            What stands at the end of a text that is cut, or of a line; ``"..."`` where the font has no ``"…"``. Empty
            for nothing. A line too narrow for a letter and this is without.
        line_spacing : int, default 0
            Rows between lines; negative to bring them closer.
        inverse : bool, default False
            Whether the characters are dark and the rest of the box has level `c`. Where `op` is not ``"over"``, they
            are left as they were.
        op : {"over", "xor", "add", "max", "clear"}

        Returns
        -------
        str
            The rest of the text that the box does not hold, to go on with in another; empty if it holds all. Without
            wrapping, whole lines.

        Raises
        ------
        ValueError
            If `align`, `valign`, `wrap` or `op` is none of these, or lines are closer than a row.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(64, 16)
        >>> fb.text_box("Rain in the afternoon, wind from the west", 0, 0, 64, 16, ellipsis="")
        'afternoon, wind from the west'
        """
        if _is_paint(c):
            return self._draw_with_paint("text_box", locals())
        self.painter.paint_with(c, op)
        style = (align, valign, wrap, ellipsis, line_spacing)
        return write_box(self.painter.coverage, s, x, y, w, h, font, style, inverse)

    def image(
        self,
        picture: Any,
        x: int | float = 0,
        y: int | float = 0,
        *,
        size: tuple[int, int] | None = None,
        fit: Fit | None = None,
        fill: int | None = None,
        crop: tuple[int, int, int, int] | None = None,
        dither: Dither | None = None,
        gamma: float = 1.0,
        invert: bool = False,
        op: str = "over",
    ) -> None:
        """Paint a picture with its top-left pixel at (x, y).

        Parameters
        ----------
        picture : PIL.Image.Image, numpy.ndarray, Sprite, matplotlib figure or path
            An array of grays: shape (height, width), uint8 0 ... 255 or bool; or of colors: (height, width, 3 or 4). A
            path is that of a file that Pillow reads. Where a picture is transparent, what is there shines through. What
            a camera says of which side is up is obeyed.
        x, y : int or float
        size : tuple of int, optional
            Width and height to scale it to. Default: as it is; with `fit`, those of the framebuffer.
        fit : {"stretch", "contain", "cover"}, optional
            How it gets that size: by other proportions (default), the whole of it, in the middle, or as much of it as
            fills the size.
        fill : int, optional
            The level of what is around and behind a picture of a `size`. Default: as it was.
        crop : tuple of int, optional
            x, y, width and height of the part to take. Default: all of it.
        dither : {None, "bayer", "floyd-steinberg", "blue-noise", "stable"}
            How grays become levels: the nearest level (default); a fixed pattern; diffusion of the error; a pattern
            that is not seen as one; or that, while a pixel keeps the level that it has unless that is clearly off,
            which keeps videos from flickering.
        gamma : float, default 1.0
            Gray 0 ... 1 becomes gray ** gamma of the highest level. 2.2 is right where levels are shares of light, as
            on a 1-bit panel that is dithered.
        invert : bool, default False
            Whether dark and light change places.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        TypeError
            If the picture is none, or an option of the wrong kind.
        ValueError
            If the array has another shape, or an option is none of these.

        Notes
        -----
        Pictures are scaled in linear light: fine black and white lines become gray 188, not 128.

        Examples
        --------
        >>> import numpy as np
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(6, 2)
        >>> fb.image(np.array([[255, 0]], np.uint8), size=(6, 2))
        >>> print(fb)
        ###...
        ###...
        """
        if size is None and fit is None and fill is None and crop is None and gamma == 1 and invert is False:
            if paint_picture(self.painter.surface, picture, x, y, dither, op):
                return
        elif size is not None:
            size = checked_size(size)
        check_fit(fit)
        if fit is not None and size is None:
            size = (self.width, self.height)
        options = {"size": size, "fit": fit, "crop": crop}
        tones = {"dither": dither, "gamma": gamma, "invert": invert}
        paint_seen(self.painter.surface, self.pixels, picture, (x, y, op), fill, options, tones)

    def blit(
        self,
        source: Framebuffer | Sprite | NDArray[np.uint8],
        x: int | float,
        y: int | float,
        key: int = -1,
        palette: Any = None,
        *,
        op: str = "over",
    ) -> None:
        """Copy another framebuffer's pixels, its top-left pixel to (x, y).

        Parameters
        ----------
        source : Framebuffer, Sprite or ndarray of uint8, shape (height, width)
            May be this framebuffer or a view of it. Levels of a framebuffer of another depth are scaled, so that its
            highest level becomes this one's; an array's must be levels of this framebuffer.
        x, y : int or float
        key : int, default -1
            The level, after `palette` or scaling, that is not copied; -1 for none.
        palette : Framebuffer of height 1 or sequence of int, optional
            Pixel or item k says which level stands for level k of the source, which then is not scaled.
        op : {"over", "xor", "add", "max", "clear"}
            How a level meets what is there.

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
        cover: Any = None
        if not isinstance(source, (Framebuffer, np.ndarray)):
            cover = getattr(source, "opacity", None)
            source = getattr(source, "levels", source)
        copy_levels(self.painter.surface, _surface_of(source), cover, x, y, key, palette, op)

    def scroll(self, dx: int | float, dy: int | float, c: int | None = None) -> None:
        """Move the picture by (dx, dy) pixels. What nothing moves to stays as it was or, with `c`, gets that level.

        Within `clip`, what is inside of the window moves, and nothing else.

        Parameters
        ----------
        dx, dy : int or float
            Pixels to the right and down, to the nearest whole number.
        c : int, optional

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
        move_levels(self.painter.surface, dx, dy, c)

    # -- Parts of it

    def clip(self, x: int | float, y: int | float, w: int | float, h: int | float) -> Clip:
        """Confine drawing to a rectangle, for the length of a ``with`` block; within another one, to what both share.

        Parameters
        ----------
        x, y : int or float
            The top-left pixel.
        w, h : int or float
            Size in pixels.

        Raises
        ------
        ValueError
            If `w` or `h` is negative.

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
        for name, value in (("w", w), ("h", h)):
            if real(name, value) < 0:
                raise ValueError(f"{name} must not be negative, and is {value}")
        return Clip(self, (left, top, left + whole("w", w), top + whole("h", h)))

    def _clip_to(self, clips):
        """Confine drawing to what these windows share."""
        self._clips = clips
        lefts, tops, rights, bottoms = zip(self._whole, *clips, strict=True)
        left, top, right, bottom = max(lefts), max(tops), min(rights), min(bottoms)
        limit = LARGEST
        self.surface.set_window(min(left, limit), min(top, limit), max(right, 0), max(bottom, 0))

    def view(self, x: SupportsIndex, y: SupportsIndex, w: SupportsIndex, h: SupportsIndex) -> Framebuffer:
        """Return a framebuffer over part of the same pixels, with (0, 0) at (x, y).

        It clips to itself, and to what `clip` leaves of it now, and has its own `antialias`, at first the same. Drawing
        on one shows on the other.

        Parameters
        ----------
        x, y : int
            The top-left pixel of the part.
        w, h : int
            Its size in pixels, 1 or more.

        Raises
        ------
        TypeError
            If one of the four is not a whole number.
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
        mine = self.surface
        if x < 0 or y < 0 or w < 1 or h < 1 or x + w > mine.width or y + h > mine.height:
            raise ValueError(
                f"x, y, w, h must be a part of the {mine.width} x {mine.height} pixels, not {(x, y, w, h)}"
            )
        its = Surface(mine.memory, mine.origin + y * mine.stride + x, mine.stride, w, h, mine.max_level)
        its.set_window(mine.left - x, mine.top - y, mine.right - x, mine.bottom - y)
        part = _unmade()
        part.pixels = self.pixels[y : y + h, x : x + w]
        part.depth = self.depth
        part._draw_on(its, self.painter.antialias)
        return part

    def copy(self) -> Framebuffer:
        """Return a framebuffer of its own with the same pixels.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(4, 1)
        >>> other = fb.copy()
        >>> other.fill(1)
        >>> print(fb, other)
        .... ####
        """
        return _restored(*self.__reduce__()[1])

    def turned(self, quarters: SupportsIndex = 1) -> Framebuffer:
        """Return a framebuffer of its own with the picture turned by quarter turns clockwise, as to `blit` it.

        Examples
        --------
        >>> from paneldraw import Framebuffer
        >>> fb = Framebuffer(5, 2)
        >>> fb.hline(0, 0, 4)
        >>> print(fb.turned())
        .#
        .#
        .#
        .#
        ..
        """
        levels = np.rot90(self.pixels, -size("quarters", quarters))
        height, width = levels.shape
        other = Framebuffer(width, height, self.depth, antialias=self.painter.antialias)
        other.pixels[...] = levels
        return other

    def __reduce__(self) -> tuple[Any, ...]:
        attributes = {name: value for name, value in getattr(self, "__dict__", {}).items() if name not in _OWN}
        picture = (self.width, self.height, self.depth, self.painter.antialias, self.pixels.tobytes())
        return _restored, (type(self), *picture, attributes)

    # -- As a picture

    def to_image(self, scale: int = 1) -> Image.Image:
        """Return a Pillow image, mode ``1`` for one bit a pixel, else ``L``, each pixel `scale` x `scale` large."""
        return pictures.to_image(self.pixels, self.surface.max_level, scale)

    def save(self, path: str | PathLike[str], scale: int = 1, look: str | Look | None = None) -> None:
        """Write the picture to a file; its name's ending says in which format (``.png``, ``.bmp``, ...).

        Parameters
        ----------
        path : str or path-like
        scale : int
            Image pixels a pixel, at least 1. Default: 1.
        look : str or Look, optional
            Draw it as it looks on a panel: ``"white"``, ``"blue"``, ``"yellow-blue"``, ``"green-led"``, ``"red-led"``,
            ``"lcd-green"``, ``"lcd-gray"`` or a `simulator.Look`. Default: plain black to white.
        """
        if look is None:
            self.to_image(scale).save(path)
        else:
            from paneldraw.simulator import image  # who draws alone does not pay for it

            image(self.pixels, scale=scale, max_level=self.max_level, look=look).save(path)

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

    def __dir__(self) -> list[str]:
        kind = type(self)
        return [name for name in object.__dir__(self) if not isinstance(getattr(kind, name, None), _Instead)]

    def __repr__(self) -> str:
        return f"Framebuffer({self.width}, {self.height}, depth={self.depth})"


@cython.cfunc
@cython.inline
@cython.returns(cython.bint)
@cython.exceptval(-1)
def _is_paint(c):
    return c is not None and type(c) is not int and _is_of_class_ink(c)


def _is_of_class_ink(c):
    return isinstance(c, Paint)


def _surface_of(source):
    """The pixels of a framebuffer; anything else as it is."""
    if not isinstance(source, Framebuffer):
        return source
    return _surface(source)


def _surface(fb):
    # The attribute is asked for, so that a framebuffer that was never made is an error.
    return fb.surface if fb.surface.stride else None


def _unmade():
    return Framebuffer.__new__(Framebuffer)


class Clip:
    """Confines a framebuffer's drawing to a window while its ``with`` block lasts; made by `Framebuffer.clip`."""

    def __init__(self, framebuffer: Framebuffer, window: tuple[int, int, int, int]) -> None:
        self._framebuffer = framebuffer
        self._window = window

    def __enter__(self) -> Framebuffer:
        self._framebuffer._clip_to([*self._framebuffer._clips, self._window])
        return self._framebuffer

    def __exit__(self, *_: object) -> None:
        clips = list(self._framebuffer._clips)
        # The last one that is this one: windows may be left in any order.
        del clips[len(clips) - 1 - next(i for i, window in enumerate(reversed(clips)) if window is self._window)]
        self._framebuffer._clip_to(clips)


def _restored(kind, width, height, depth, antialias, levels, attributes):
    """A framebuffer from what `Framebuffer.__reduce__` tells of one."""
    fb = kind.__new__(kind)
    Framebuffer.__init__(fb, width, height, depth, antialias=antialias)
    fb.pixels[...] = np.frombuffer(levels, np.uint8).reshape(height, width)
    for name, value in attributes.items():
        setattr(fb, name, value)
    return fb


def _pointed(heads, closed=False):
    """Whether there is a head at the start, and at the end."""
    if closed:
        raise ValueError("heads must be None of a path that is closed or filled: it has no ends")
    ends = choice("heads", heads, _HEADS)
    return ends > 1, ends % 2 == 1


def _shifted(x, y, coords):
    """The points `coords`, moved by (x, y)."""
    points = in_turn("coords", coords)
    return [_sum(real("coords", number), y if i % 2 else x) for i, number in enumerate(points)]


def _sum(a, b):
    """a + b; where floats would overflow, of their whole parts: there is no more to such numbers."""
    try:
        total = a + b
    except OverflowError:
        return int(a) + int(b)
    return total if isinstance(total, int) or isfinite(total) else int(a) + int(b)
