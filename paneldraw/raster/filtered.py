# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Filling contours through a filter: each pixel's coverage is the filter's volume above the shape.

What an edge contributes to it is the volume to the right of the edge, between the heights of its ends. The filter looks
the same from every side. So let F(r) be its volume within the distance r of the middle in an angle of 1, and let

    T(d, t) = the integral of F over the angle, along a straight line at the distance d of the middle, from its nearest
              point as far as t: the volume of a right-angled triangle, where that is within the filter's circle

Around any closed outline these add up to the volume within. Of an edge it is T twice, and twice more for the rays that
go out from its ends to the right.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import cython
import numpy as np

from paneldraw.raster.cone import HEIGHTS

if cython.compiled:
    from cython.cimports.libc.math import atan2, sqrt
    from cython.cimports.paneldraw.raster._floors import floored
    from cython.cimports.paneldraw.raster.boundaries import Boundary
    from cython.cimports.paneldraw.raster.cone import ConeFilter
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from math import atan2, sqrt

    from paneldraw.raster._floors import floored
    from paneldraw.raster.boundaries import Boundary
    from paneldraw.raster.cone import ConeFilter
    from paneldraw.raster.surface import Surface

# In how many steps coverage is handed on; `Surface.blend` divides exactly by no more.
_STEPS = cython.declare(cython.int, 1024)

# Steps a radius of the table of what is on one side of an edge.
_SIDES = cython.declare(cython.int, 256)


@cython.cclass
class Volumes:
    """What edges look up of a filter."""

    def __init__(self, cone: ConeFilter) -> None:
        self.radius = cone.radius
        self.steps = cone.resolution
        self.scale = cone.resolution / cone.radius
        self.kept = _triangles(cone.filter, cone.resolution)
        # The volume on one side of an endless edge. Toward the rim it is curved the more, the nearer; and all around
        # a disc as large as the filter there are edges that just touch the rim, whose errors add up.
        self.kept_sides = np.ascontiguousarray(ConeFilter(1, cone.filter, _SIDES).table[2 * _SIDES])
        self.sides_scale = _SIDES / cone.radius
        if cython.compiled:
            address: cython.size_t = self.kept.__array_interface__["data"][0]
            self.triangles = cython.cast(cython.p_double, address)
            address = self.kept_sides.__array_interface__["data"][0]
            self.sides = cython.cast(cython.p_double, address)
        else:
            self.triangles = self.kept.ravel().tolist()
            self.sides = self.kept_sides.tolist()

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def triangle(self, d: cython.double, t: cython.double) -> cython.double:
        """T(d, t) for a point within the circle, interpolated between the table's four nearest entries."""
        x: cython.double = abs(d) * self.scale
        y: cython.double = abs(t) * self.scale
        i: cython.int = min(floored(x), self.steps - 1)
        j: cython.int = min(floored(y), self.steps - 1)
        x -= i
        y -= j
        at: cython.int = i * (self.steps + 1) + j
        table: cython.p_double = self.triangles
        near: cython.double = table[at] + (table[at + 1] - table[at]) * y
        at += self.steps + 1
        far: cython.double = table[at] + (table[at + 1] - table[at]) * y
        near += (far - near) * x
        return near if (d < 0) == (t < 0) else -near

    @cython.cfunc
    @cython.inline
    @cython.nogil
    @cython.exceptval(check=False)
    def side(self, d: cython.double) -> cython.double:
        """The volume on that side of an endless straight edge on which the middle is, `d` away; d < 0: the other."""
        d = min(max((d + self.radius) * self.sides_scale, 0), 2 * _SIDES)
        i: cython.int = min(floored(d), 2 * _SIDES - 1)
        return self.sides[i] + (self.sides[i + 1] - self.sides[i]) * (d - i)


@lru_cache(maxsize=16)
def _triangles(filter: Any, resolution: Any) -> Any:
    """The table of T(d, t) for d and t from 0 to the radius; beyond the circle the filter's height goes on."""
    fine = max(1, 512 // resolution)
    steps = resolution * fine
    # F(r) / r ** 2, in radii.
    distance = (np.arange(2 * steps) + 0.5) / steps
    within = (HEIGHTS[filter](distance) * distance).cumsum()
    share = within / within[steps - 1] / (2 * np.pi) / ((np.arange(2 * steps) + 1) / steps) ** 2
    d = np.arange(resolution + 1) / resolution
    t = (np.arange(steps) + 0.5) / steps
    density = np.interp(np.hypot(d[:, None], t), (np.arange(2 * steps) + 1) / steps, share) * d[:, None] / steps
    table = np.zeros((resolution + 1, resolution + 1))
    table[:, 1:] = density.reshape(resolution + 1, resolution, fine).sum(2).cumsum(1)
    return table


@cython.cfunc
def fill(
    surface: Surface,
    cone: ConeFilter,
    points: cython.p_longlong,
    ends: cython.p_Py_ssize_t,
    contours: cython.Py_ssize_t,
    nonzero: cython.bint,
    unit: cython.int,
) -> Any:
    """Fill the shape with these contours as `polygons` does, but through a filter; points in 1 / `unit` pixels."""
    if contours == 0 or surface.left >= surface.right or surface.top >= surface.bottom:
        return
    if cone.volumes_of_edges is None:
        cone.volumes_of_edges = Volumes(cone)
    if surface.boundary is None:
        surface.boundary = Boundary()
    volumes: Volumes = cone.volumes_of_edges
    boundary: Boundary = surface.boundary
    # A pixel of the window is influenced from no further away.
    boundary.left = surface.left - cone.radius - 1
    boundary.top = surface.top - cone.radius
    boundary.right = surface.right + cone.radius
    boundary.bottom = surface.bottom + cone.radius
    boundary.find(points, ends, contours, nonzero, unit)
    rows: cython.Py_ssize_t = surface.bottom - surface.top
    width: cython.Py_ssize_t = surface.width + 2
    sums: cython.p_double
    starting: cython.p_int
    if cython.compiled:
        surface.make_room(
            width * cython.sizeof(cython.double) + (rows + 2 * boundary.count) * cython.sizeof(cython.int)
        )
        sums = cython.cast(cython.p_double, surface.room)
        starting = cython.cast(cython.p_int, sums + width)
    else:
        sums = [0.0] * width
        starting = [0] * (rows + 2 * boundary.count)
    _paint(surface, volumes, boundary.segments, boundary.count, sums, starting)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _paint(
    surface: Surface,
    volumes: Volumes,
    segments: cython.p_double,
    count: cython.Py_ssize_t,
    sums: cython.p_double,
    starting: cython.p_int,
) -> cython.void:
    """Paint row by row what the segments add up to. `sums` holds differences, as the surface's own row does."""
    rows: cython.Py_ssize_t = surface.bottom - surface.top
    radius: cython.double = volumes.radius
    # Chains of segments whose influence begins in the same row; and those in reach of the present row.
    following: cython.Py_ssize_t = rows
    active: cython.Py_ssize_t = rows + count
    reached: cython.Py_ssize_t = 0
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    k: cython.Py_ssize_t
    y: cython.Py_ssize_t
    touched: cython.Py_ssize_t[2]
    if not cython.compiled:
        touched = [0, 0]
    surface.count_in(1, _STEPS)
    for i in range(surface.left, surface.right + 2):
        sums[i] = 0
    for i in range(rows):
        starting[i] = -1
    for i in range(count):
        k = max(-floored(radius - segments[12 * i + 1]) - surface.top, 0)
        if k < rows:
            starting[following + i] = starting[k]
            starting[k] = i
    for y in range(surface.top, surface.bottom):
        j = 0
        for i in range(reached):
            k = starting[active + i]
            if segments[12 * k + 6] + radius > y:
                starting[active + j] = k
                j += 1
        reached = j
        k = starting[y - surface.top]
        while k >= 0:
            starting[active + reached] = k
            reached += 1
            k = starting[following + k]
        touched[0] = surface.right
        touched[1] = surface.left
        for i in range(reached):
            _add(surface, volumes, segments, 12 * starting[active + i], y, sums, touched)
        if reached:
            _paint_row(surface, y, sums, touched[0], touched[1])


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _add(
    surface: Surface,
    volumes: Volumes,
    segments: cython.p_double,
    at: cython.Py_ssize_t,
    y: cython.Py_ssize_t,
    sums: cython.p_double,
    touched: cython.p_Py_ssize_t,
) -> cython.void:
    """Add up what a segment contributes to the pixels of row `y`."""
    radius: cython.double = volumes.radius
    # The segment's ends a and b, seen from the middle of pixel x, and the filter's volumes above them.
    start: cython.double = segments[at]
    stop: cython.double = segments[at + 5]
    ay: cython.double = segments[at + 1] - y
    by: cython.double = segments[at + 6] - y
    ux: cython.double = segments[at + 2]
    uy: cython.double = segments[at + 3]
    length: cython.double = segments[at + 4]
    slope: cython.double = segments[at + 10]
    sign: cython.double = segments[at + 7]
    # The angle at a between the line, upward, and the ray to the right, in turns.
    turn: cython.double = segments[at + 11]
    # Two segments that go on from each other have the ray between them in common, the one as much as the other lacks.
    ray_a: cython.bint = segments[at + 8] == 0
    ray_b: cython.bint = segments[at + 9] == 0
    above_a: cython.double = volumes.side(ay)
    above_b: cython.double = volumes.side(by)
    whole: cython.double = above_b - above_a
    # The part within reach, from left to right, and how far that is in this row.
    near: cython.double = start + max(0, -radius - ay) * slope
    far: cython.double = stop - max(0, by - radius) * slope
    reach: cython.double = max(0, max(ay, -by))
    reach = sqrt(max(0, radius * radius - reach * reach)) + 1e-6
    near, far = max(min(near, far) - reach, surface.left), max(near, far) + reach
    if near >= surface.right:
        return
    first: cython.Py_ssize_t = -floored(-near)
    last: cython.Py_ssize_t = floored(min(far, surface.right - 1)) + 1 if far >= surface.left else surface.left
    x: cython.Py_ssize_t
    ax: cython.double
    bx: cython.double
    d: cython.double
    t: cython.double
    half: cython.double
    upper: cython.double
    lower: cython.double
    volume: cython.double
    before: cython.double = 0
    within_a: cython.bint
    within_b: cython.bint
    for x in range(first, last):
        ax = start - x
        bx = stop - x
        # How far the middle is to the right of the segment's line, and a from the point nearest to it.
        d = ay * ux - ax * uy
        t = ax * ux + ay * uy
        within_a = ax * ax + ay * ay < radius * radius
        within_b = bx * bx + by * by < radius * radius
        if within_a or within_b or (abs(d) < radius and t < 0 and t + length > 0):
            upper = lower = 0
            if not (within_a and within_b):
                # Of the whole line, what is beyond the ends.
                half = 0.5 * (volumes.side(d) - 0.5)
                if turn < 0:
                    segments[at + 11] = turn = atan2(uy, -ux) / 6.283185307179586
                upper = (above_a if ax < 0 else 0) - turn - half
                lower = 0.5 - turn + half - (1 - above_b if bx < 0 else 0)
            if within_a:
                upper = volumes.triangle(d, t)
                if ray_a:
                    upper += 0.5 * (above_a - 0.5) - volumes.triangle(ay, ax)
            if within_b:
                lower = volumes.triangle(d, t + length)
                if ray_b:
                    lower += 0.5 * (above_b - 0.5) - volumes.triangle(by, bx)
            volume = lower - upper
        else:
            # It passes by the circle.
            volume = whole if (d > 0 if abs(d) >= radius else ax < 0 if t >= 0 else bx < 0) else 0
        volume *= sign
        sums[x] += volume - before
        before = volume
    sums[last] += whole * sign - before
    touched[0] = min(touched[0], first)
    touched[1] = max(touched[1], last)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _paint_row(
    surface: Surface, y: cython.Py_ssize_t, sums: cython.p_double, first: cython.Py_ssize_t, last: cython.Py_ssize_t
) -> cython.void:
    """Paint the pixels from `first` on, the coverages of which no longer change from `last` on."""
    x: cython.Py_ssize_t
    total: cython.double = 0
    covered: cython.int = 0
    before: cython.int = 0
    cells: cython.p_longlong = surface.cells
    for x in range(first, min(last + 1, surface.right)):
        total += sums[x]
        sums[x] = 0
        covered = min(floored(max(total, 0) * _STEPS + 0.5), _STEPS)
        cells[x] = covered - before
        before = covered
    sums[surface.right] = 0
    if first < surface.right:
        surface.blend(y, first, surface.right if covered else min(last + 1, surface.right), 0)
