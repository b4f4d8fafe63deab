# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Anti-aliasing by filtering: each pixel's area of influence is a circle, on which a cone of volume 1 stands.

The coverage of a pixel is the volume above the shape. The cone looks the same from every side, so one table serves
lines of all angles and widths, their ends included. Other shapes are filled by `paneldraw.raster.filtered`.
"""

from __future__ import annotations

from array import array
from functools import lru_cache
from numbers import Integral, Real
from typing import Any

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER
    from cython.cimports.libc.math import ceil, hypot
    from cython.cimports.paneldraw.raster._floors import floored
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from math import ceil, hypot

    from paneldraw.raster._floors import floored
    from paneldraw.raster.surface import Surface

#: In how many steps coverage is handed on; `Surface.blend` divides exactly by no more.
_STEPS = cython.declare(cython.int, 1024)

# Entries a radius of the tables by distance, and the fraction of an entry that a distance is known to.
_FINE = cython.declare(cython.int, 256)
_PART = cython.declare(cython.longlong, 1 << 24)

# Farther than anything on a surface.
_FAR = cython.declare(cython.double, 1e9)

#: The height at a distance from the middle, in radii; made to have volume 1 afterwards.
HEIGHTS = {
    "cone": lambda distance: 1 - distance,
    "box": lambda distance: 1 + 0 * distance,
    "gaussian": lambda distance: np.exp(-2 * distance**2),
}


@cython.cclass
class ConeFilter:
    """Anti-aliasing by a filter: the coverage of a pixel is the filter's volume above the shape.

    Immutable and hashable. Tables are built at the first use of a filter and kept for all that are equal.

    Parameters
    ----------
    radius : float, default 1.0
        Of the circle around the pixel's center in which it is influenced, in pixels, 0.5 to 4.
    filter : {"cone", "box", "gaussian"}, default "cone"
        Its height: falling to 0 at the rim; the same everywhere; or a bell curve with a standard deviation of half a
        radius, cut off at the rim.
    resolution : int, default 32
        Steps a radius of the table of volumes, 8 to 256. From 12 on coverage is within 2/255 of the filter's volume
        above the shape; with less it may be 3/255 from that.

    Raises
    ------
    TypeError
        If `radius` or `resolution` is not a number.
    ValueError
        If an argument is out of its range.

    Notes
    -----
    S. Gupta and R. F. Sproull, "Filtering edges for gray-scale displays", SIGGRAPH 1981, 1-5. Their tables are for one
    width of line. Here C(u, v) is the volume over the quadrant left of u and below v, and the volume over a rectangle
    in the line's own frame is C(u1, v1) - C(u0, v1) - C(u1, v0) + C(u0, v0).

    Examples
    --------
    >>> from paneldraw import ConeFilter, Framebuffer
    >>> fb = Framebuffer(8, 3, depth=4)
    >>> fb.line(0, 0, 7, 2, antialias=ConeFilter())
    >>> print(fb)
    aa731...
    259bb952
    ...137aa
    """

    def __init__(self, radius: Any = 1.0, filter: Any = "cone", resolution: Any = 32) -> None:
        if not isinstance(radius, Real) or isinstance(radius, bool):
            raise TypeError(f"radius must be a number of pixels, not {type(radius).__name__}")
        pixels: Any = radius
        if not 0.5 <= pixels <= 4:
            raise ValueError(f"radius must be from 0.5 to 4 pixels, not {radius}")
        if not isinstance(filter, str) or filter not in HEIGHTS:
            raise ValueError(f"filter must be one of {', '.join(map(repr, HEIGHTS))}, not {filter!r}")
        if not isinstance(resolution, Integral) or isinstance(resolution, bool):
            raise TypeError(f"resolution must be a whole number of steps, not {type(resolution).__name__}")
        if int(resolution) not in range(8, 257):
            raise ValueError(f"resolution must be from 8 to 256 steps a radius, not {resolution}")
        self.radius = float(radius)
        self.filter = filter
        self.resolution = int(resolution)
        self.kept = _volumes(filter, self.resolution)
        self.fitted = 0
        self.kept_band: Any = None
        # What `paneldraw.raster.filtered` makes of it at first use.
        self.volumes_of_edges: Any = None
        if cython.compiled:
            self.volumes = cython.cast(cython.p_double, PyMemoryView_GET_BUFFER(memoryview(self.kept)).buf)
        else:
            self.volumes = self.kept.ravel().tolist()

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ConeFilter):
            return NotImplemented
        return self.__reduce__() == other.__reduce__()

    def __hash__(self) -> Any:
        return hash(self.__reduce__())

    def __repr__(self) -> str:
        return f"ConeFilter(radius={self.radius!r}, filter={self.filter!r}, resolution={self.resolution})"

    def __reduce__(self) -> tuple[Any, ...]:
        return ConeFilter, (self.radius, self.filter, self.resolution)

    @property
    def table(self) -> Any:
        """C from -radius to radius, a read-only array of float64 of shape (2 * resolution + 1, 2 * resolution + 1)."""
        return self.kept

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def volume(self, u: cython.double, v: cython.double) -> cython.double:
        """C(u, v), interpolated between the table's four nearest entries; lengths in pixels."""
        steps: cython.int = 2 * self.resolution
        scale: cython.double = self.resolution / self.radius
        u = min(max((u + self.radius) * scale, 0), steps)
        v = min(max((v + self.radius) * scale, 0), steps)
        i: cython.int = min(floored(u), steps - 1)
        j: cython.int = min(floored(v), steps - 1)
        u -= i
        v -= j
        at: cython.int = i * (steps + 1) + j
        table: cython.p_double = self.volumes
        below: cython.double = table[at] + (table[at + 1] - table[at]) * v
        at += steps + 1
        above: cython.double = table[at] + (table[at + 1] - table[at]) * v
        return below + (above - below) * u

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def profile(self, v: cython.double) -> cython.double:
        """C(radius, v): the volume on one side of an endless straight edge."""
        steps: cython.int = 2 * self.resolution
        v = min(max((v + self.radius) * self.resolution / self.radius, 0), steps)
        j: cython.int = min(floored(v), steps - 1)
        at: cython.int = steps * (steps + 1) + j
        return self.volumes[at] + (self.volumes[at + 1] - self.volumes[at]) * (v - j)

    @cython.cfunc
    def fit(self, width: cython.double) -> Any:
        """Have `band` be the coverage by the distance from the middle of a line of that width, away from its ends.

        Its entries are a radius / `_FINE` apart and begin at `nearest`; closer to the middle the first one holds. The
        last one is 0.
        """
        if width == self.fitted:
            return
        self.kept_band = _band(self, width)
        self.band = _pointer_to_ints(self.kept_band)
        self.farthest = len(self.kept_band) - 1
        self.nearest = max(width / 2 - self.radius, 0)
        self.fitted = width


@lru_cache(maxsize=32)
def _band(cone: ConeFilter, width: Any) -> Any:
    """The table by distance that `ConeFilter.fit` describes."""
    t: cython.int
    half: cython.double = width / 2
    nearest: cython.double = max(half - cone.radius, 0)
    band = array("i", [0]) * int(ceil((half + cone.radius - nearest) * _FINE / cone.radius) + 1)
    for t in range(len(band) - 1):
        distance: cython.double = nearest + t * cone.radius / _FINE
        band[t] = int((cone.profile(half - distance) - cone.profile(-half - distance)) * _STEPS + 0.5)
    return band


@cython.cfunc
def _pointer_to_ints(numbers: Any) -> cython.p_int:
    """The numbers of an array of C's ints."""
    if cython.compiled:
        return cython.cast(cython.p_int, PyMemoryView_GET_BUFFER(memoryview(numbers)).buf)
    return numbers


@lru_cache(maxsize=16)
def _volumes(filter: Any, resolution: Any) -> Any:
    """The table of C(u, v): heights on a finer grid, added up in both directions."""
    fine = max(1, 512 // resolution)
    middles = (np.arange(2 * resolution * fine) + 0.5) / (resolution * fine) - 1
    distance = np.hypot(middles[:, None], middles)
    heights = np.where(distance < 1, HEIGHTS[filter](distance), 0.0)
    table = np.zeros((2 * resolution + 1, 2 * resolution + 1))
    sums = heights.reshape(2 * resolution, fine, 2 * resolution, fine).sum((1, 3))
    table[1:, 1:] = sums.cumsum(0).cumsum(1)
    table /= table[-1, -1]
    table.setflags(write=False)
    return table


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def strip(
    surface: Surface,
    cone: ConeFilter,
    x1: cython.double,
    y1: cython.double,
    x2: cython.double,
    y2: cython.double,
    width: cython.double,
    square: cython.bint,
) -> cython.void:
    """The rectangle of `width` around a line, all in pixels, filtered; with `square` half a width longer at both ends.

    A pixel's distance along the line is u and across it v. Away from the ends, where the filter reaches neither, the
    coverage depends on v alone; it is in the table that `ConeFilter.fit` made for this width.
    """
    radius: cython.double = cone.radius
    length: cython.double = hypot(x2 - x1, y2 - y1)
    ux: cython.double = (x2 - x1) / length if length > 0 else 1
    uy: cython.double = (y2 - y1) / length if length > 0 else 0
    half: cython.double = width / 2
    before: cython.double = -half if square else 0
    behind: cython.double = length - before
    # The rows that the filter touches the rectangle in; in a row, what is between the sides and between the ends.
    rise: cython.double = abs(ux) * (half + radius) + abs(uy) * (radius - before)
    top: cython.Py_ssize_t = max(surface.top, -floored(rise - min(y1, y2)))
    bottom: cython.Py_ssize_t = min(surface.bottom, floored(max(y1, y2) + rise) + 1)
    side_slope: cython.double = ux / uy if uy != 0 else 0
    side: cython.double = abs((half + radius) / uy) if uy != 0 else _FAR
    end_slope: cython.double = -uy / ux if ux != 0 else 0
    back: cython.double = min((before - radius) / ux, (behind + radius) / ux) if ux != 0 else -_FAR
    front: cython.double = max((before - radius) / ux, (behind + radius) / ux) if ux != 0 else _FAR
    # u and v in fixed-point numbers: entries of the table, and their parts. Steps of whole numbers add up to the same,
    # wherever a window lets a row begin.
    scale: cython.double = _FINE / radius * _PART
    along: cython.longlong = floored(ux * scale)
    across: cython.longlong = floored(uy * scale)
    behind_start: cython.longlong = floored((before + radius) * scale)
    before_end: cython.longlong = floored((behind - radius) * scale)
    origin: cython.Py_ssize_t = floored(x1)
    nearest: cython.longlong = floored(cone.nearest * scale) - _PART // 2
    farthest: cython.longlong = cone.farthest
    band: cython.p_int = cone.band
    cells: cython.p_longlong = surface.cells
    surface.count_in(1, _STEPS)
    y: cython.Py_ssize_t
    x: cython.Py_ssize_t
    u: cython.longlong
    v: cython.longlong
    covered: cython.longlong
    last: cython.longlong
    for y in range(top, bottom):
        middle: cython.double = x1 + side_slope * (y - y1)
        foot: cython.double = x1 + end_slope * (y - y1)
        first: cython.Py_ssize_t = -floored(min(side - middle, -back - foot, -surface.left))
        end: cython.Py_ssize_t = floored(min(middle + side, foot + front, surface.right - 1)) + 1
        if first >= end:
            continue
        u = floored((ux * (origin - x1) + uy * (y - y1)) * scale) + along * (first - origin)
        v = floored((ux * (y - y1) - uy * (origin - x1)) * scale) - across * (first - origin)
        last = 0
        for x in range(first, end):
            if behind_start <= u <= before_end:
                covered = band[min(max((abs(v) - nearest) >> 24, 0), farthest)]
            else:
                covered = floored(_near_end(cone, u / scale, v / scale, before, behind, half) * _STEPS + 0.5)
            cells[x] = covered - last
            last = covered
            u += along
            v -= across
        surface.blend(y, first, end, 0)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _near_end(
    cone: ConeFilter,
    u: cython.double,
    v: cython.double,
    before: cython.double,
    behind: cython.double,
    half: cython.double,
) -> cython.double:
    """The volume over a rectangle, by four look-ups."""
    return (
        cone.volume(behind - u, half - v)
        - cone.volume(before - u, half - v)
        - cone.volume(behind - u, -half - v)
        + cone.volume(before - u, -half - v)
    )
