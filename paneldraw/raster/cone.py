"""Anti-aliasing by filtering: each pixel's area of influence is a circle, on which a cone of volume 1 stands.

The coverage of a pixel is the filter's volume above the shape. The cone looks the same from every side, so that one
table serves straight lines of all angles and widths, their ends included; another weighs the ends of the spans that all
other shapes are made of.
"""

import array
import functools
import numbers

import cython
import numpy as np
from cython.cimports.libc.math import ceil
from cython.cimports.paneldraw.raster.floors import floored

from paneldraw._signatures import SignatureOfInit

# As typing has it, without an import that costs as much as the rest.
TYPE_CHECKING = False

if not cython.compiled:
    FILTER_FULL, FILTER_SHIFT, BLOCK = 1024, 10, 5

# In a Profile, the entries a radius.
PROFILE_STEPS = 256

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
        Steps a radius of the tables, 8 to 256. From 12 on a straight line's coverage is within 2/255 of the filter's
        volume above it. Other shapes are made of sub-scanlines, five for four steps or some more, at most 120 a pixel,
        and from 24 on are within 5/255, parts thinner than half a pixel within 10/255; at 8, within 11 and 31.

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

    if TYPE_CHECKING:
        radius: float
        filter: str
        resolution: int

    __signature__ = SignatureOfInit()

    @cython.annotation_typing(False)
    def __init__(self, radius: float = 1.0, filter: str = "cone", resolution: int = 32) -> None:
        if type(radius) is not float and (isinstance(radius, bool) or not isinstance(radius, numbers.Real)):
            raise TypeError(f"radius must be a number of pixels, not {type(radius).__name__}")
        if not 0.5 <= radius <= 4:
            raise ValueError(f"radius must be from 0.5 to 4 pixels, not {radius}")
        if not isinstance(filter, str) or filter not in HEIGHTS:
            raise ValueError(f"filter must be one of {', '.join(map(repr, HEIGHTS))}, not {filter!r}")
        whole = type(resolution) is int or isinstance(resolution, numbers.Integral)
        if not whole or isinstance(resolution, bool):
            raise TypeError(f"resolution must be a whole number of steps, not {type(resolution).__name__}")
        if not 8 <= resolution <= 256:
            raise ValueError(f"resolution must be from 8 to 256 steps a radius, not {resolution}")
        self.radius = radius if type(radius) is float else float(radius)
        self.filter = filter
        self.resolution = resolution if type(resolution) is int else int(resolution)
        self.kept = _tables_of(self)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ConeFilter):
            return NotImplemented
        return self.__reduce__() == other.__reduce__()

    def __hash__(self) -> int:
        return hash(self.__reduce__())

    def __repr__(self) -> str:
        return f"ConeFilter(radius={self.radius!r}, filter={self.filter!r}, resolution={self.resolution})"

    def __reduce__(self) -> tuple[object, ...]:
        return ConeFilter, (self.radius, self.filter, self.resolution)

    @property
    def table(self):
        """C from -radius to radius, a read-only array of float64 of shape (2 * resolution + 1, 2 * resolution + 1)."""
        self.kept.prepare()
        return self.kept.table


@cython.final
@cython.cclass
class Filter:
    """The tables of a filter."""

    def __init__(self, radius, name, resolution):
        self.radius = radius
        self.name = name
        self.resolution = resolution
        self.steps = 2 * resolution
        self.table = None
        self.latest = None
        # An even number of blocks: the middle of a pixel lies between two of them.
        self.n = 2 * BLOCK * min(int(ceil(0.125 * resolution / self.radius)), 12)
        self.lines = 2 * BLOCK * int(ceil(self.radius * self.n / BLOCK))
        self.reach = int(ceil(self.radius + 0.5))

    def prepare(self):
        """Make the tables, if they are not there yet."""
        if self.table is not None:
            return
        quadrants = np.zeros((self.steps + 1, self.steps + 1), np.int64)
        quadrants[1:, 1:] = _volumes(self.name, self.steps, 1.0).cumsum(0).cumsum(1)
        volumes = quadrants / quadrants[self.steps, self.steps]
        volumes.setflags(write=False)
        extent = self.lines / (2 * self.n * self.radius)
        weights = _weights(_volumes(self.name, self.lines, extent), self.n, self.reach)
        blocks = weights.reshape(-1, BLOCK, *weights.shape[1:]).sum(1)
        weights = np.concatenate([weights, blocks])
        if cython.compiled:
            self.kept_weights = bytearray(weights.astype(np.intc).tobytes())
            self.weights = cython.cast(cython.p_int, _bytes(self.kept_weights))
            self.volumes = cython.cast(cython.p_double, cython.cast(cython.size_t, volumes.ctypes.data))
        else:
            self.weights = weights.ravel().tolist()
            self.volumes = volumes.ravel().tolist()
        self.table = volumes

    def strip(self, u, low, high):
        """C(u, high) - C(u, low), interpolated between the table's nearest entries; lengths in pixels."""
        scale: cython.double = self.resolution / self.radius
        u = min(max((u + self.radius) * scale, 0), self.steps)
        i: cython.int = min(cython.cast(cython.int, floored(u)), self.steps - 1)
        u -= i
        i *= self.steps + 1
        low = (low + self.radius) * scale
        high = (high + self.radius) * scale
        left: cython.double = self._entry(i, high) - self._entry(i, low)
        i += self.steps + 1
        return left + (self._entry(i, high) - self._entry(i, low) - left) * u

    def _entry(self, row, v):
        """A table's row at `v`, in steps, interpolated."""
        v = min(max(v, 0), self.steps)
        at: cython.int = min(cython.cast(cython.int, floored(v)), self.steps - 1)
        v -= at
        at += row
        return self.volumes[at] + (self.volumes[at + 1] - self.volumes[at]) * v


# The tables of all filters that were asked for, and the filter that was asked for last: the next one mostly equals it.
_FILTERS: dict = {}
_latest = cython.declare(ConeFilter, None)


def _tables_of(cone):
    """The tables of a filter, the same for all that are equal."""
    global _latest
    if (
        _latest is not None
        and _latest.radius == cone.radius
        and _latest.resolution == cone.resolution
        and _latest.filter is cone.filter
    ):
        return _latest.kept
    key = (cone.radius, cone.filter, cone.resolution)
    cone.kept = _FILTERS.get(key)
    if cone.kept is None:
        cone.kept = _FILTERS[key] = Filter(*key)
    _latest = cone
    return cone.kept


def _volumes(name, cells, extent):
    """The filter's volume above each of cells x cells squares, which cover a square of `extent` radii to each side.

    Heights are whole numbers, so that their sums are the same on every machine.
    """
    fine = max(1, 1024 // cells)
    middles = ((np.arange(cells * fine) + 0.5) * (2 / (cells * fine)) - 1) * extent
    distance = np.sqrt(middles[:, None] ** 2 + middles**2)
    heights = np.where(distance < 1, np.floor(HEIGHTS[name](distance) * (1 << 20) + 0.5), 0).astype(np.int64)
    return heights.reshape(cells, fine, cells, fine).sum((1, 3))


def _weights(volumes, n, reach):
    """The table of how a span that begins changes coverage, shape (lines / 2, n, 2 * reach), from sub-pixels' volumes.

    By sub-scanline, from the circle's rim to its middle; by sub-pixel, at whose left side the span begins; and by
    pixel: how much more is covered of it than of the one before. Pixel number `reach` - 1 is the sub-pixel's own.
    """
    lines = len(volumes)
    whole = volumes.sum()
    # What lies left of a place across the circle, of each sub-scanline, to the nearest whole number.
    left_of = np.zeros((lines // 2, lines + 1), np.int64)
    left_of[:, 1:] = volumes[: lines // 2].cumsum(1)
    left_of = (2 * left_of * (FILTER_FULL << FILTER_SHIFT) + whole) // (2 * whole)
    # A pixel's middle is so many sub-pixels right of the span's end; by symmetry that much of its circle is covered.
    pixels = np.arange(-1, 2 * reach) - (reach - 1)
    middles = pixels * n + n // 2 - np.arange(n)[:, None]
    covered = left_of[:, np.clip(middles + lines // 2, 0, lines)]
    return np.diff(covered, axis=2)


@cython.final
@cython.cclass
class Profile:
    """The coverage by the distance from the middle of a line of some width, away from its ends.

    Entries are a radius / `PROFILE_STEPS` apart and begin at `nearest`; closer to the middle the first one holds. The
    last one, number `farthest`, is 0.
    """

    def __init__(self, filter: Filter, width):
        t: cython.int
        half: cython.double = width / 2
        self.filter = filter
        self.width = width
        self.nearest = max(half - filter.radius, 0.0)
        # In 2**24 parts of an entry; what is nearer to an entry than to others is read there.
        self.nearest_part = floored(self.nearest * (PROFILE_STEPS / filter.radius * (1 << 24))) - (1 << 23)
        self.farthest = int(ceil((half + filter.radius - self.nearest) * PROFILE_STEPS / filter.radius))
        coverage = array.array("i", [0]) * (self.farthest + 1)
        for t in range(self.farthest):
            distance: cython.double = self.nearest + t * (filter.radius / PROFILE_STEPS)
            volume: cython.double = filter.strip(filter.radius, -half - distance, half - distance)
            coverage[t] = int(volume * FILTER_FULL + 0.5)
        self.kept = bytearray(coverage.tobytes())
        self.coverage = cython.cast(cython.p_int, _bytes(self.kept)) if cython.compiled else list(coverage)


@functools.lru_cache(maxsize=64)
def _profile(filter, width):
    return Profile(filter, width)


def profile_of(filter, width):
    """The profile of a line of that width, made once."""
    if filter.latest is None or filter.latest.width != width:
        filter.prepare()
        filter.latest = _profile(filter, width)
    return filter.latest


@cython.cfunc
def _bytes(kept: bytearray) -> cython.p_char:
    return kept
