# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""How rectangles and round shapes are painted, thin or wide, near or far."""

from __future__ import annotations

from functools import partial
from typing import Any

import cython

from paneldraw.framebuffer.angles import direction, is_reflex
from paneldraw.framebuffer.arguments import as_samples
from paneldraw.framebuffer.paths import FINENESS
from paneldraw.raster.curves import end_of_radius
from paneldraw.raster.cuts import UNIT, quadrants_far, sector_outline_far, wedge_far
from paneldraw.raster.round_contours import HalfPlane, add_band_far

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer.arguments import FIXED_REACH, NEAR
    from cython.cimports.paneldraw.raster.cone import ConeFilter
    from cython.cimports.paneldraw.raster.curves import Sector, Wedge, curve_far, ellipse, rounded, sector_far
    from cython.cimports.paneldraw.raster.cuts import Cut, Quadrants, SectorOutline
    from cython.cimports.paneldraw.raster.cuts import Wedge as WedgeCut
    from cython.cimports.paneldraw.raster.round_contours import add_band
    from cython.cimports.paneldraw.raster.rounds import band, band_far
    from cython.cimports.paneldraw.raster.strokes import Contours
    from cython.cimports.paneldraw.raster.supersample import Supersample
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.framebuffer.arguments import FIXED_REACH, NEAR
    from paneldraw.framebuffer.polygons import Polygons
    from paneldraw.raster.cone import ConeFilter
    from paneldraw.raster.curves import Sector, Wedge, curve_far, ellipse, rounded, sector_far
    from paneldraw.raster.cuts import Cut, Quadrants, SectorOutline
    from paneldraw.raster.cuts import Wedge as WedgeCut
    from paneldraw.raster.round_contours import add_band
    from paneldraw.raster.rounds import band, band_far
    from paneldraw.raster.strokes import Contours
    from paneldraw.raster.supersample import Supersample
    from paneldraw.raster.surface import Surface

# Radii beyond these, in pixels and in 256ths, are left to Python's arithmetic.
LARGE = cython.declare(cython.longlong, 1 << 14)
LARGE_256THS = cython.declare(cython.longlong, 1 << 21)

# Radii up to this, in 256ths, are followed all around for a filter; of larger ones what is in sight.
_FOLLOWED = 1 << 21

# The length of the vectors of angles, where 64 bits do not limit it.
_FINE = 1 << 60


@cython.cclass
class Rounds(Polygons):
    """How rectangles and round shapes are painted."""

    @cython.cfunc
    def _thin_rect(self, x: Any, y: Any, w: Any, h: Any, r: Any, fill: cython.bint) -> Any:
        """Paint the aliased rectangle, with rounded corners where there is room for them."""
        r = min(r, (w - 1) // 2, (h - 1) // 2)
        if r > 0:
            self._rounded(x + r, y + r, x + w - 1 - r, y + h - 1 - r, r, fill)
        elif fill or w <= 2 or h <= 2:
            self._block(x, y, w, h)
        else:
            self._block(x, y, w, 1)
            self._block(x, y + h - 1, w, 1)
            self._block(x, y + 1, 1, h - 2)
            self._block(x + w - 1, y + 1, 1, h - 2)

    @cython.cfunc
    def _thin_ellipse(self, x: Any, y: Any, xr: Any, yr: Any, fill: cython.bint, quadrants: cython.int) -> Any:
        if max(xr, yr) <= LARGE:
            ellipse(self.surface, _clamp(x, NEAR), _clamp(y, NEAR), xr, yr, fill, quadrants, None)
        else:
            curve_far(self.surface, (x, y, x, y), xr, yr, fill, quadrants, None)

    @cython.cfunc
    def _thin_turn(
        self, x: Any, y: Any, r: Any, start: Any, end: Any, swept: Any, sector: cython.bint, fill: cython.bint
    ) -> Any:
        """Paint the aliased arc or sector between two angles that are `swept` degrees apart."""
        start, end = (end_of_radius(r, direction(angle, _FINE), _FINE) for angle in (start, end))
        wedge = (start, end, is_reflex(start, end, swept))
        if r > LARGE:
            if sector:
                sector_far(self.surface, x, y, r, fill, wedge)
            else:
                curve_far(self.surface, (x, y, x, y), r, r, False, 0, wedge)
            return
        cx: cython.longlong = _clamp(x, NEAR)
        cy: cython.longlong = _clamp(y, NEAR)
        if sector:
            outline: Sector = Sector(cx, cy, r, fill, Wedge(*wedge))
            outline.paint(self.surface, cy - r, cy + r + 1)
        elif start == end and swept <= 180:
            self.surface.point(cx + start[0], cy + start[1])
        else:
            ellipse(self.surface, cx, cy, r, r, False, 0, Wedge(*wedge))

    @cython.cfunc
    def _wide_turn(
        self,
        x: Any,
        y: Any,
        r: Any,
        start: Any,
        end: Any,
        swept: Any,
        sector: cython.bint,
        fill: cython.bint,
        width: Any,
        antialias: Any,
    ) -> Any:
        unit = UNIT if _is_near(r, width) else _FINE
        start, end = direction(start, unit), direction(end, unit)
        wedge = (start, end, is_reflex(start, end, swept), sector and not fill)
        self._around(x, y, r, r, width, fill, wedge, antialias)

    @cython.cfunc
    def _rounded(self, left: Any, top: Any, right: Any, bottom: Any, r: Any, fill: cython.bint) -> Any:
        """Paint the midpoint circle, its quarters around the corners of a rectangle."""
        if r > LARGE:
            curve_far(self.surface, (left, top, right, bottom), r, r, fill, 15, None)
            return
        # Corners that far away are as invisible as farther ones.
        a: cython.longlong = _clamp(left, NEAR)
        b: cython.longlong = _clamp(right, NEAR)
        rounded(self.surface, a, _clamp(top, NEAR), b, _clamp(bottom, NEAR), r, fill)

    @cython.cfunc
    def _around(self, x: Any, y: Any, a: Any, b: Any, width: Any, fill: cython.bint, cut: Any, antialias: Any) -> Any:
        self._band((x, y, x, y), a, b, width, False, fill, cut, antialias)

    @cython.cfunc
    def _band(
        self,
        centers: Any,
        a: Any,
        b: Any,
        width: Any,
        sharp: cython.bint,
        fill: cython.bint,
        cut: Any,
        antialias: Any,
    ) -> Any:
        """Paint a band or what it encloses; numbers in 256ths.

        `cut` is None, a number of quadrants, or two vectors, whether their angle is reflex, and whether it is outlined.
        """
        if isinstance(antialias, ConeFilter):
            self._filtered_band(centers, a, b, width, sharp, fill, cut, antialias)
            return
        samples: Supersample = as_samples(antialias)
        if _is_near(max(a, b), width):
            left, top, right, bottom = (_clamp(center, 256 * FIXED_REACH) for center in centers)
            near = _near_cut(cut)
            band(self.surface, left, top, right, bottom, a, b, width, sharp, fill, near, samples.n, samples.corner)
        else:
            far = _far_cut(cut)
            band_far(self.surface, centers, a, b, width, sharp, fill, far, samples.n, samples.corner)

    @cython.cfunc
    def _filtered_band(
        self,
        centers: Any,
        a: Any,
        b: Any,
        width: Any,
        sharp: cython.bint,
        fill: cython.bint,
        cut: Any,
        cone: ConeFilter,
    ) -> Any:
        """As `_band`, by way of its contours."""
        contours: Contours = self._empty_contours(cone)
        surface: Surface = self.surface
        unit: cython.int = 256 * FINENESS
        # What a filter of any radius can reach.
        sight = (surface.left - 6, surface.top - 6, surface.right + 6, surface.bottom + 6)
        left, top, right, bottom = centers
        beyond = width // 2 + 1
        if (
            left - a - beyond > 256 * sight[2]
            or top - b - beyond > 256 * sight[3]
            or right + a + beyond < 256 * sight[0]
            or bottom + b + beyond < 256 * sight[1]
        ):
            return
        near: cython.bint = max(a, b, width) <= _FOLLOWED and max(map(abs, centers)) <= 256 * FIXED_REACH // 2
        box = tuple([FINENESS * center for center in centers])
        radii = (FINENESS * a, FINENESS * b)
        half = FINENESS * width // 2
        parts, sides = _planes(cut, half, unit, UNIT if _is_near(max(a, b), width) else _FINE)
        if near:
            add_band(contours, box, radii, half, sharp, not fill, parts, sides)
        else:
            sight = tuple([unit * side for side in sight])
            add_band_far(contours, sight, box, radii, half, sharp, not fill, parts, sides)
        self._fill_contours(contours.points, contours.ends, contours.contours, True, cone, unit)


def _planes(cut: Any, half: Any, pixel: Any, length: Any) -> tuple[list[list[HalfPlane]], list[list[HalfPlane]]]:
    """The parts and sides that `add_band` takes for a `cut`, whose vectors have the given length."""
    if cut is None:
        return [[]], []
    if not isinstance(cut, tuple):
        signs = ((1, 1, -1), (2, -1, -1), (4, -1, 1), (8, 1, 1))
        quarters = [[(0, -sx, pixel // 2), (sy, 0, pixel // 2)] for bit, sx, sy in signs if cut & bit]
        return quarters, []
    (sx, sy), (ex, ey), reflex, outlined = cut
    begin, end, turned = (sx, sy, 0), (-ex, -ey, 0), (-sx, -sy, 0)
    # More than half a turn is half a turn and the rest.
    parts = [[begin], [turned, end]] if reflex else [[begin, end]]
    margin = half * length
    sides = [[(x, y, margin), (-x, -y, margin), (y, -x, 0)] for x, y in ((sx, sy), (ex, ey))] if outlined else []
    return parts, sides


@cython.cfunc
def _near_cut(cut: Any) -> Cut | None:
    if isinstance(cut, tuple):
        start, end, reflex, outlined = cut
        return SectorOutline(start, end, reflex) if outlined else WedgeCut(start, end, reflex)
    return None if cut is None else Quadrants(cut)


def _far_cut(cut: Any) -> Any:
    if isinstance(cut, tuple):
        start, end, reflex, outlined = cut
        return partial(sector_outline_far, _FINE, start, end, reflex) if outlined else partial(wedge_far, *cut[:3])
    return None if cut is None else partial(quadrants_far, cut)


def _is_near(radius: Any, width: Any) -> Any:
    """Whether 64-bit arithmetic holds a band of that radius, in 256ths."""
    return 2 * radius + width < 2 * LARGE_256THS


def _clamp(number: Any, limit: Any) -> Any:
    return min(max(number, -limit), limit)
