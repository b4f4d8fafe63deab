# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The calls that draw rectangles and round shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import cython

from paneldraw.framebuffer.angles import sweep
from paneldraw.framebuffer.arguments import as_samples, length, real, size, to_256ths, whole

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer.arguments import FAR, line_width, quick, quick_256ths
    from cython.cimports.paneldraw.framebuffer.rounds import LARGE, LARGE_256THS
    from cython.cimports.paneldraw.raster.curves import rounded
    from cython.cimports.paneldraw.raster.rounds import band
    from cython.cimports.paneldraw.raster.supersample import Supersample
else:
    from paneldraw.framebuffer.arguments import FAR, line_width, quick, quick_256ths
    from paneldraw.framebuffer.rounds import LARGE, LARGE_256THS, Rounds
    from paneldraw.raster.curves import rounded
    from paneldraw.raster.rounds import band
    from paneldraw.raster.supersample import Supersample

if TYPE_CHECKING:
    from paneldraw.framebuffer.arguments import AntialiasOrDefault, Level, Real, Str


@cython.cclass
class Shapes(Rounds):
    """The calls that draw rectangles and round shapes, outlined or filled.

    Aliased and of width 1, curves are the midpoint method's, between whole pixels. Wider or anti-aliased, an outline is
    the band along the true curve, half of its width on either side, and a pixel or sub-pixel is in it if its reference
    point is. A filled shape is its outline and all that this encloses, and so goes on for half a width beyond the true
    curve: by default half a pixel. Fractions of a pixel are taken to the nearest 256th.
    """

    def rect(
        self,
        x: Real,
        y: Real,
        w: Real,
        h: Real,
        c: Level = None,
        fill: bool = False,
        *,
        width: Real = 1,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
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
        width : int or float, default 1
            Thickness of the outline in pixels, half of it on either side of the true outline.
        antialias : Supersample, ConeFilter or None, optional
            Default: the framebuffer's.
        op : {"over", "xor", "add", "max", "clear"}

        Raises
        ------
        ValueError
            If `w` or `h` is negative or `width` is below 1/256.

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
        self.round_rect(x, y, w, h, 0, c, fill, width=width, antialias=antialias, op=op)

    def round_rect(
        self,
        x: Real,
        y: Real,
        w: Real,
        h: Real,
        r: Real,
        c: Level = None,
        fill: bool = False,
        *,
        width: Real = 1,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw a rectangle with rounded corners: the outline, or with `fill` all of it.

        Parameters
        ----------
        x, y, w, h : int or float
            As for `rect`.
        r : int or float
            Radius of the corners. Of one too large, as much is taken as the sides have room for: half of the shorter
            one, less half a pixel. With 0 the corners are sharp, and it is `rect`.
        c, fill, width, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If `w`, `h` or `r` is negative or `width` is below 1/256.

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
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        thickness = line_width(width)
        if antialias is None and thickness == 256:
            self._thin_rect(whole("x", x), whole("y", y), length("w", w, 1), length("h", h, 1), length("r", r, 1), fill)
            return
        as_samples(antialias)
        left, right, most_x = _side(to_256ths("x", x), length("w", w, 256))
        top, bottom, most_y = _side(to_256ths("y", y), length("h", h, 256))
        corner = min(length("r", r, 256), most_x, most_y)
        if right > left - 256 and bottom > top - 256:
            centers = (left + corner, top + corner, right - corner, bottom - corner)
            self._band(centers, corner, corner, thickness, corner == 0, fill, None, antialias)

    def circle(
        self,
        x: Real,
        y: Real,
        r: Real,
        c: Level = None,
        fill: bool = False,
        *,
        width: Real = 1,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw the circle of radius `r` around (x, y): its outline, or with `fill` the disc within it.

        Parameters
        ----------
        x, y, r : int or float
            A radius of 0 draws one pixel, or else a dot as large as the width.
        c, fill, width, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If `r` is negative or `width` is below 1/256.

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
        a: cython.longlong
        b: cython.longlong
        k: cython.longlong
        wide: cython.longlong
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        thickness = line_width(width)
        if antialias is None and thickness == 256:
            a = quick(x)
            b = quick(y)
            k = quick(r)
            if a != FAR and b != FAR and 0 <= k <= LARGE:
                rounded(self.surface, a, b, a, b, k, fill)
            else:
                self._thin_ellipse(whole("x", x), whole("y", y), length("r", r, 1), length("r", r, 1), fill, 15)
            return
        a = quick_256ths(x)
        b = quick_256ths(y)
        k = quick_256ths(r)
        wide = min(thickness, 2 * LARGE_256THS)
        near: cython.bint = a != FAR and b != FAR and 0 < k <= LARGE_256THS
        if near and 2 * k + wide < 2 * LARGE_256THS and isinstance(antialias, Supersample):
            samples: Supersample = antialias
            band(self.surface, a, b, a, b, k, k, wide, False, fill, None, samples.n, samples.corner)
        else:
            as_samples(antialias)
            radius = length("r", r, 256)
            self._around(to_256ths("x", x), to_256ths("y", y), radius, radius, thickness, fill, None, antialias)

    def ellipse(
        self,
        x: Real,
        y: Real,
        xr: Real,
        yr: Real,
        c: Level = None,
        fill: bool = False,
        quadrants: Any = 0b1111,
        *,
        width: Real = 1,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw the ellipse with the radii `xr` and `yr` around (x, y), or some quarters of it.

        Wider or anti-aliased, the outline is what lies between two ellipses, whose radii are half a width larger and
        smaller. Across a slope that is a little less than the width.

        Parameters
        ----------
        x, y : int or float
        xr, yr : int or float
            With a radius of 0 the ellipse is a line.
        c : int, optional
        fill : bool, default False
        quadrants : int, default 0b1111
            The quarters to draw, bits as in MicroPython's framebuf: 1 top right, 2 top left, 4 bottom left, 8 bottom
            right. A quarter includes the pixels on its axes, half a pixel beyond the center.
        width, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If a radius is negative, `width` is below 1/256, or `quadrants` is not from 0 to 15.

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
        if antialias is ...:
            antialias = self._antialias
        quarters: cython.int = _quadrants(quadrants)
        self._dip(c, op)
        thickness = line_width(width)
        if antialias is None and thickness == 256:
            width_reach, height_reach = length("xr", xr, 1), length("yr", yr, 1)
            self._thin_ellipse(whole("x", x), whole("y", y), width_reach, height_reach, fill, quarters)
            return
        as_samples(antialias)
        a, b = length("xr", xr, 256), length("yr", yr, 256)
        cut: Any = None if quarters == 15 else quarters
        self._around(to_256ths("x", x), to_256ths("y", y), a, b, thickness, fill, cut, antialias)

    def arc(
        self,
        x: Real,
        y: Real,
        r: Real,
        start: Real,
        end: Real,
        c: Level = None,
        *,
        width: Real = 1,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw the part of a circle that lies clockwise from the angle `start` to the angle `end`.

        Aliased, it is the part of the midpoint circle from the pixel nearest to the one end to the pixel nearest to the
        other, both included. Wider or anti-aliased, it is the band along the true circle, cut off straight at the
        angles.

        Parameters
        ----------
        x, y, r : int or float
            As for `circle`.
        start, end : int or float
            Degrees clockwise from the x axis, as the screen shows them: 0 is right, 90 down, -90 up. If `end` is 360
            or more beyond `start`, it is the circle; else the arc goes on until it first comes to `end`. From an angle
            to the same one it is a pixel, or nothing where it is wider or anti-aliased.
        c, width, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If `r` is negative, an angle is not finite, or `width` is below 1/256.

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
        self._turn(x, y, r, start, end, c, False, False, width, antialias, op)

    def sector(
        self,
        x: Real,
        y: Real,
        r: Real,
        start: Real,
        end: Real,
        c: Level = None,
        fill: bool = False,
        *,
        width: Real = 1,
        antialias: AntialiasOrDefault = ...,
        op: Str = "over",
    ) -> None:
        """Draw a slice of a disc, clockwise from the angle `start` to the angle `end`: its outline, or all of it.

        Aliased, its outline is `arc` and Bresenham's lines from the center to the ends of that; with `fill` it is these
        and all of the disc between them. Wider or anti-aliased, the outline is the band along the true arc and along
        the two radii, rounded at the center, and `fill` the slice itself: slices that share an angle share no sub-pixel
        and leave none out, and the whole of them is the disc.

        Parameters
        ----------
        x, y, r : int or float
            As for `circle`.
        start, end : int or float
            As for `arc`; if `end` is 360 or more beyond `start`, it is the circle or disc. From an angle to the same
            one it is a radius, or with `fill` and anti-aliased nothing.
        c, fill, width, antialias, op
            As for `rect`.

        Raises
        ------
        ValueError
            If `r` is negative, an angle is not finite, or `width` is below 1/256.

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
        self._turn(x, y, r, start, end, c, True, fill, width, antialias, op)

    @cython.cfunc
    def _turn(
        self,
        x: Any,
        y: Any,
        r: Any,
        start: Any,
        end: Any,
        c: Any,
        sector: cython.bint,
        fill: cython.bint,
        width: Any,
        antialias: Any,
        op: Any,
    ) -> Any:
        """Draw an arc or a sector."""
        start, end = real("start", start), real("end", end)
        swept = sweep(start, end)
        if swept >= 360:
            self.circle(x, y, r, c, fill, width=width, antialias=antialias, op=op)
            return
        if antialias is ...:
            antialias = self._antialias
        self._dip(c, op)
        thickness = line_width(width)
        if antialias is None and thickness == 256:
            self._thin_turn(whole("x", x), whole("y", y), length("r", r, 1), start, end, swept, sector, fill)
            return
        as_samples(antialias)
        x, y, r = to_256ths("x", x), to_256ths("y", y), length("r", r, 256)
        self._wide_turn(x, y, r, start, end, swept, sector, fill, thickness, antialias)


def _side(start: Any, size: Any) -> Any:
    """The centers of the first and the last pixel of a side, in 256ths, and the largest radius it has room for."""
    return start, start + size - 256, max(0, (size - 256) // 2)


@cython.cfunc
@cython.exceptval(-1)
def _quadrants(value: Any) -> cython.int:
    number = size("quadrants", value)
    if not 0 <= number <= 15:
        raise ValueError(f"quadrants must be from 0 to 15, the sum of those to draw of 1, 2, 4 and 8, not {value}")
    return number
