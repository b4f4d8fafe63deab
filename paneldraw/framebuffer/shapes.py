# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""The calls that draw shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import cython

from paneldraw.framebuffer.arguments import not_negative, whole

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer.arguments import NEAR
    from cython.cimports.paneldraw.raster.curves import circle, circle_far
else:
    from paneldraw.framebuffer.arguments import NEAR
    from paneldraw.framebuffer.polygons import Polygons
    from paneldraw.raster.curves import circle, circle_far

if TYPE_CHECKING:
    from paneldraw.framebuffer.arguments import Level, Real, Str

_LARGE_RADIUS = cython.declare(cython.longlong, 1 << 14)


@cython.cclass
class Shapes(Polygons):
    """The calls that draw shapes, outlined or filled."""

    def rect(
        self, x: Real, y: Real, w: Real, h: Real, c: Level = None, fill: bool = False, *, op: Str = "over"
    ) -> None:
        """Draw a rectangle of `w` x `h` pixels, its top-left pixel at (x, y): the outline, or with `fill` all of it.

        A width or height of 0 draws nothing.
        """
        x, y = whole("x", x), whole("y", y)
        w, h = not_negative("w", whole("w", w)), not_negative("h", whole("h", h))
        self._dip(c, op)
        if fill or w <= 2 or h <= 2:
            self._block(x, y, w, h)
        else:
            self._block(x, y, w, 1)
            self._block(x, y + h - 1, w, 1)
            self._block(x, y + 1, 1, h - 2)
            self._block(x + w - 1, y + 1, 1, h - 2)

    def circle(self, x: Real, y: Real, r: Real, c: Level = None, fill: bool = False, *, op: Str = "over") -> None:
        """Draw the midpoint circle of radius `r` around (x, y): its outline, or with `fill` the disc within it.

        A radius of 0 draws one pixel. The disc ends where the outline does.

        Notes
        -----
        J. E. Bresenham, "A linear algorithm for incremental digital display of circular arcs", CACM 20 (1977), 100-106.
        """
        x, y, r = whole("x", x), whole("y", y), not_negative("r", whole("r", r))
        self._dip(c, op)
        if max(abs(x), abs(y)) <= NEAR and r <= _LARGE_RADIUS:
            circle(self.surface, x, y, r, fill)
        else:
            circle_far(self.surface, x, y, r, fill)
