# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Aliased outlines made of several curves: where these meet or cross, a pixel is painted once all the same."""

from __future__ import annotations

from typing import Any

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.lines import dashed
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.lines import dashed
    from paneldraw.raster.surface import Surface


@cython.cclass
class Outline:
    """Curves that are painted as one shape; what they are is a subclass's `trace`."""

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def trace(self, surface: Surface) -> cython.void:
        """Ink the curves on a surface, one after the other."""

    @cython.cfunc
    def paint(self, surface: Surface, top: cython.longlong, bottom: cython.longlong) -> Any:
        """Paint the outline, which has no pixels outside of the rows ``top <= y < bottom``.

        Most operations may be repeated on a pixel. Where that would show, as with xor, the outline is first traced
        row by row on a surface that is a single row, and what it holds is painted.
        """
        if surface.op != 1 and surface.op != 2:
            self.trace(surface)
            return
        x: cython.Py_ssize_t
        y: cython.Py_ssize_t
        marks: cython.p_uchar
        row: Surface = surface.single_row()
        marks = row.pixels
        row.dip(1, 0)
        row.left = surface.left
        row.right = surface.right
        for y in range(max(top, surface.top), min(bottom, surface.bottom)):
            row.top = y
            row.bottom = y + 1
            self.trace(row)
            for x in range(surface.left, surface.right):
                if marks[x]:
                    marks[x] = 0
                    surface.point(x, y)


@cython.cclass
class Polyline(Outline):
    """Lines one pixel wide from point to point, dashed where there is a pattern; coordinates within +-2**29."""

    points: cython.p_longlong
    count: cython.Py_ssize_t
    closed: cython.bint
    pattern: cython.p_longlong
    lengths: cython.Py_ssize_t
    dda: cython.bint

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def trace(self, surface: Surface) -> cython.void:
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        points: cython.p_longlong = self.points
        phase: cython.longlong = 0
        lines: cython.Py_ssize_t = self.count if self.closed and self.count > 2 else max(self.count - 1, 1)
        for i in range(lines):
            j = (i + 1) % self.count
            x1: cython.longlong = points[2 * i]
            y1: cython.longlong = points[2 * i + 1]
            x2: cython.longlong = points[2 * j]
            y2: cython.longlong = points[2 * j + 1]
            dashed(surface, x1, y1, x2, y2, self.pattern, self.lengths, phase, self.dda)
            phase += max(abs(x2 - x1), abs(y2 - y1))
