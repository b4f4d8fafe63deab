# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True, nonecheck=True
"""What the drawing calls have in common: the surface they draw on, its ink, and paths of any width."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import cython
import numpy as np

from paneldraw.framebuffer.arguments import ALIASED, LARGEST, as_samples, choice, dash_steps, size
from paneldraw.raster.far import cut_path, pairs
from paneldraw.raster.surface import OPS

if cython.compiled:
    from cython.cimports.paneldraw.framebuffer._words import is_word
    from cython.cimports.paneldraw.framebuffer.arguments import (
        FAR,
        FIXED_REACH,
        Points,
        pointer_to_int64,
        quick,
    )
    from cython.cimports.paneldraw.raster.cone import ConeFilter
    from cython.cimports.paneldraw.raster.filtered import fill
    from cython.cimports.paneldraw.raster.lines import far
    from cython.cimports.paneldraw.raster.outlines import Polyline
    from cython.cimports.paneldraw.raster.polygons import polygons
    from cython.cimports.paneldraw.raster.strokes import Contours, Dashes, stroke
    from cython.cimports.paneldraw.raster.supersample import Supersample
else:
    from paneldraw.framebuffer._words import is_word
    from paneldraw.framebuffer.arguments import FAR, FIXED_REACH, Points, pointer_to_int64, quick
    from paneldraw.raster.cone import ConeFilter
    from paneldraw.raster.filtered import fill
    from paneldraw.raster.lines import far
    from paneldraw.raster.outlines import Polyline
    from paneldraw.raster.polygons import polygons
    from paneldraw.raster.strokes import Contours, Dashes, stroke
    from paneldraw.raster.supersample import Supersample
    from paneldraw.raster.surface import Surface

# In 256ths of a pixel.
_NEARBY = 5 * 256

# Filters take contours in 1 / FINENESS of a 256th.
FINENESS = 8


@cython.cclass
class Paths:
    """A surface to draw on, and how paths are painted on it."""

    surface: Surface
    _antialias: Any
    _contours: Contours | None

    @cython.cfunc
    @cython.inline
    def _dip(self, c: Any, op: Any) -> Any:
        """Fill the ink for level `c` and operation `op`."""
        code: cython.int = 0 if is_word(op, "over") else choice("op", op, OPS)
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
    def _block(self, x: Any, y: Any, w: Any, h: Any) -> Any:
        """Ink the pixels ``x <= column < x + w`` of the rows ``y <= row < y + h``."""
        row: cython.Py_ssize_t
        first: cython.Py_ssize_t = min(max(x, 0), LARGEST)
        last: cython.Py_ssize_t = min(max(x + w, 0), LARGEST)
        top: cython.Py_ssize_t = min(max(y, self.surface.top), self.surface.bottom)
        bottom: cython.Py_ssize_t = max(min(y + h, self.surface.bottom), top)
        for row in range(top, bottom):
            self.surface.span(row, first, last)

    @cython.cfunc
    def _thin_path(self, path: Points, closed: cython.bint, dash: Any, dda: cython.bint) -> Any:
        """Aliased lines of width 1 from point to point, each a whole pixel, as one shape."""
        pattern = [(length + 128) >> 8 for length in dash]
        if path.exact is None:
            lengths = dash_steps(dash)
            outline = Polyline()
            outline.points = path.values
            outline.count = path.count
            outline.closed = closed
            outline.dda = dda
            outline.lengths = len(lengths) // 8
            outline.pattern = pointer_to_int64(lengths)
            if path.count:
                outline.paint(self.surface, self.surface.top, self.surface.bottom)
            return
        points = pairs(path.exact)
        if len(points) == 1 or (closed and len(points) > 2):
            points.append(points[0])
        # First on a surface of its own: what is painted where lines meet or cross shall be painted once.
        width, height = self.surface.width, self.surface.height
        memory = np.zeros(width * height, np.uint8)
        marks: Surface = Surface(memory, 0, width, width, height, 1)
        marks.set_window(self.surface.left, self.surface.top, self.surface.right, self.surface.bottom)
        marks.dip(1, 0)
        phase = 0
        for (x1, y1), (x2, y2) in pairwise(points):
            far(marks, x1, y1, x2, y2, pattern, phase)
            phase += max(abs(x2 - x1), abs(y2 - y1))
        for i in np.flatnonzero(memory).tolist():
            self.surface.point(i % width, i // width)

    @cython.cfunc
    def _empty_contours(self, antialias: Any) -> Contours:
        """Contours to be filled with this anti-aliasing, in memory that is kept from call to call."""
        if self._contours is None:
            self._contours = Contours()
        if isinstance(antialias, ConeFilter):
            cone: ConeFilter = antialias
            self._contours.begin(FINENESS, 256 * cone.radius)
        else:
            self._contours.begin(1, 0)
        return self._contours

    @cython.cfunc
    def _stroke(
        self,
        path: Points,
        closed: cython.bint,
        width: Any,
        cap: cython.int,
        join: cython.int,
        dash: Any,
        antialias: Any,
    ) -> Any:
        """A path of any width, its points and lengths in 256ths of a pixel, as one shape."""
        contours: Contours = self._empty_contours(antialias)
        width = min(width, FIXED_REACH * 256)
        if path.exact is None:
            self._add_stroke(contours, path, closed, width, cap, join, dash, 0)
        else:
            for piece, distance in cut_path(path.exact, closed, bool(dash)):
                shape = 0 if closed else cap
                self._add_stroke(contours, Points("points", piece, False), False, width, shape, join, dash, distance)
        unit: cython.int = 256 * contours.fineness
        self._fill_contours(contours.points, contours.ends, contours.contours, True, antialias, unit)

    @cython.cfunc
    def _fill_contours(
        self,
        points: cython.p_longlong,
        ends: cython.p_Py_ssize_t,
        contours: cython.Py_ssize_t,
        nonzero: cython.bint,
        antialias: Any,
        unit: cython.int,
    ) -> Any:
        """Fill contours with any anti-aliasing; points in 1 / `unit` pixels, which are 256ths without a filter."""
        if isinstance(antialias, ConeFilter):
            cone: ConeFilter = antialias
            fill(self.surface, cone, points, ends, contours, nonzero, unit)
        else:
            samples: Supersample = ALIASED if antialias is None else as_samples(antialias)
            polygons(self.surface, points, ends, contours, nonzero, samples.n, samples.corner)

    @cython.cfunc
    def _add_stroke(
        self,
        contours: Contours,
        path: Points,
        closed: cython.bint,
        width: cython.double,
        cap: cython.int,
        join: cython.int,
        dash: Any,
        distance: Any,
    ) -> Any:
        """Add a path's stroke. A point that repeats the one before it counts once; dashes begin at `distance`."""
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t = 0
        points: cython.p_double
        if cython.compiled:
            kept = bytearray(16 * (path.count + 1))
            points = cython.cast(cython.p_double, cython.cast(cython.p_char, kept))
        else:
            points = [0.0] * (2 * path.count + 2)
        for i in range(path.count):
            x: cython.double = path.values[2 * i]
            y: cython.double = path.values[2 * i + 1]
            if count == 0 or x != points[2 * count - 2] or y != points[2 * count - 1]:
                points[2 * count] = x
                points[2 * count + 1] = y
                count += 1
        if closed and count > 1 and points[0] == points[2 * count - 2] and points[1] == points[2 * count - 1]:
            count -= 1
        if count == 0:
            return
        closed = closed and count > 2
        if not dash or count == 1:
            stroke(contours, points, count, closed, width, cap, cap, join)
            return
        if closed:
            points[2 * count] = points[0]
            points[2 * count + 1] = points[1]
            count += 1
            cap = 0
        # Dashes are made near the surface, not the window: how they are cut there does not depend on what is clipped.
        # Reference points at its edge count as well, and what a filter reaches.
        left, top = -_NEARBY, -_NEARBY
        right, bottom = 256 * self.surface.width + _NEARBY, 256 * self.surface.height + _NEARBY
        box = (left, top, right, bottom)
        Dashes(contours, dash, distance % sum(dash), box, 4 * width, count).stroke(points, count, width, cap, join)
