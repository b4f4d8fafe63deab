# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Curves by Bresenham's midpoint method: integers only, one decision a step, every pixel once.

A pixel belongs to the filled curve if the midpoint of its side toward an axis of the curve is inside the true curve or
on it; the outline is the seam of that, from row to row one pixel thick. Both lie within half a pixel of the true curve.
"""

from __future__ import annotations

from math import isqrt
from typing import Any

import cython
import numpy as np

if cython.compiled:
    from cython.cimports.libc.math import floor, sqrt
    from cython.cimports.paneldraw.raster.lines import bresenham, far
    from cython.cimports.paneldraw.raster.outlines import Outline
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from math import floor, sqrt

    from paneldraw.raster.lines import bresenham, far
    from paneldraw.raster.outlines import Outline
    from paneldraw.raster.surface import Surface

# -- Circles, and rectangles with the quarters of a circle for corners


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def rounded(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    r: cython.longlong,
    fill: cython.bint,
) -> cython.void:
    """The midpoint circle of radius `r`, its quarters moved apart to the corners of a rectangle; a dot has r = 0.

    The four centers may be one: then it is the circle. Its octant from the top, (0, r), to the diagonal is walked. The
    decision parameter starts at 1 - r, the circle's equation at the midpoint between the next two candidates; while it
    is negative the midpoint is inside and y stays.
    """
    if left - r >= surface.right or right + r < surface.left or top - r >= surface.bottom or bottom + r < surface.top:
        return
    if left == right and top == bottom and r > surface.bottom - surface.top:
        # Of a circle larger than the window the rows in sight have the same pixels.
        ellipse(surface, left, top, r, r, fill, 15, None)
        return
    if fill or r == 0:
        _rounded_rows(surface, left, top, right, bottom, r)
        return
    row: cython.longlong
    surface.span(top - r, left, right + 1)
    surface.span(bottom + r, left, right + 1)
    for row in range(max(top, surface.top), min(bottom + 1, surface.bottom)):
        surface.point(left - r, row)
        surface.point(right + r, row)
    x: cython.longlong = 0
    y: cython.longlong = r
    p: cython.longlong = 1 - r
    visible: cython.bint = (
        left - r >= surface.left
        and right + r < surface.right
        and top - r >= surface.top
        and bottom + r < surface.bottom
    )
    while True:
        x += 1
        if p < 0:
            p += 2 * x + 1
        else:
            y -= 1
            p += 2 * (x - y) + 1
        if x > y:
            return
        if visible:
            _quarters(surface, left, top, right, bottom, x, y)
            if x < y:
                _quarters(surface, left, top, right, bottom, y, x)
        else:
            _clipped_quarters(surface, left, top, right, bottom, x, y)
            if x < y:
                _clipped_quarters(surface, left, top, right, bottom, y, x)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _quarters(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    x: cython.longlong,
    y: cython.longlong,
) -> cython.void:
    """Ink the pixel (x, y) of each quarter, all of them in the window."""
    pixels: cython.p_uchar = surface.pixels
    ink: cython.p_uchar = surface.ink
    above: cython.Py_ssize_t = (top - y) * surface.stride
    below: cython.Py_ssize_t = (bottom + y) * surface.stride
    pixels[above + left - x] = ink[pixels[above + left - x]]
    pixels[above + right + x] = ink[pixels[above + right + x]]
    pixels[below + left - x] = ink[pixels[below + left - x]]
    pixels[below + right + x] = ink[pixels[below + right + x]]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _clipped_quarters(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    x: cython.longlong,
    y: cython.longlong,
) -> cython.void:
    surface.point(left - x, top - y)
    surface.point(right + x, top - y)
    surface.point(left - x, bottom + y)
    surface.point(right + x, bottom + y)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _rounded_rows(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    r: cython.longlong,
) -> cython.void:
    """The same, filled: a step is the end of a row in a side octant; before y changes, of one in the top octant."""
    x: cython.longlong = 0
    y: cython.longlong = r
    p: cython.longlong = 1 - r
    row: cython.longlong
    for row in range(max(top + 1, surface.top), min(bottom, surface.bottom)):
        surface.span(row, left - r, right + r + 1)
    while x <= y:
        surface.span(top - x, left - y, right + y + 1)
        if x > 0 or top < bottom:
            surface.span(bottom + x, left - y, right + y + 1)
        x += 1
        if p < 0:
            p += 2 * x + 1
        else:
            if y >= x:
                surface.span(top - y, left - x + 1, right + x)
                surface.span(bottom + y, left - x + 1, right + x)
            y -= 1
            p += 2 * (x - y) + 1


# -- Ellipses, and what an angle or a choice of quadrants leaves of them


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def ellipse(
    surface: Surface,
    cx: cython.longlong,
    cy: cython.longlong,
    a: cython.longlong,
    b: cython.longlong,
    fill: cython.bint,
    quadrants: cython.int,
    wedge: Wedge | None,
) -> cython.void:
    """The midpoint ellipse with the radii `a` and `b`, both within 2**14, or the part of it in a wedge.

    Walks from the top, (0, b), to the side, (a, 0), row by row; a curve that comes from above the window is entered
    where it is in the first row that shows. Two decision parameters say whether x grows in a row: p, four times the
    ellipse's equation at the midpoint below the next pixel, decides where the curve is flat, and q, at the midpoint to
    its left, where it is steep. Where one of them decides, the other says nothing more.
    """
    near: cython.longlong = max(0, surface.top - cy, cy - surface.bottom + 1)
    y: cython.longlong = min(b, max(cy - surface.top, surface.bottom - 1 - cy))
    first: cython.longlong = y
    x: cython.longlong = -1
    before: cython.longlong
    inner: cython.longlong
    if surface.top >= surface.bottom or near > b:
        return
    if y < b:
        y += 1
        x = max(0, cython.cast(cython.longlong, floor(a * sqrt(b * b - y * y) / b)) - 1) - 1
    p: cython.longlong = 4 * b * b * (x + 1) * (x + 1) + a * a * (2 * y - 1) * (2 * y - 1) - 4 * a * a * b * b
    q: cython.longlong = b * b * (2 * x + 1) * (2 * x + 1) + 4 * a * a * (y * y - b * b)
    while y >= near:
        before = x
        while x < a and (p <= 0 or q <= 0):
            x += 1
            p += 4 * b * b * (2 * x + 1)
            q += 8 * b * b * x
        if y <= first:
            inner = 0 if fill else min(x, before + 1)
            _part(surface, cx, cy, -y, inner, x, quadrants, wedge)
            if y > 0:
                _part(surface, cx, cy, y, inner, x, quadrants, wedge)
        y -= 1
        p -= 8 * a * a * y
        q -= 4 * a * a * (2 * y + 1)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _part(
    surface: Surface,
    cx: cython.longlong,
    cy: cython.longlong,
    y: cython.longlong,
    inner: cython.longlong,
    outer: cython.longlong,
    quadrants: cython.int,
    wedge: Wedge | None,
) -> cython.void:
    """Ink what is wanted of ``inner <= |x - cx| <= outer`` in row ``cy + y``."""
    right: cython.int = (quadrants if y <= 0 else 0) & 1 | (quadrants >> 3 if y >= 0 else 0) & 1
    left: cython.int = (quadrants >> 1 if y <= 0 else 0) & 1 | (quadrants >> 2 if y >= 0 else 0) & 1
    if wedge is None:
        _row(surface, cx, cy + y, inner, outer, -outer if left else 0, outer if right else 0 if left else -1)
        return
    wedge.row(y, outer)
    if not wedge.reflex:
        _row(surface, cx, cy + y, inner, outer, wedge.low, wedge.high)
    elif wedge.low > wedge.high:
        _row(surface, cx, cy + y, inner, outer, -outer, outer)
    else:
        _row(surface, cx, cy + y, inner, outer, -outer, wedge.low - 1)
        _row(surface, cx, cy + y, inner, outer, wedge.high + 1, outer)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _row(
    surface: Surface,
    cx: cython.longlong,
    y: cython.longlong,
    inner: cython.longlong,
    outer: cython.longlong,
    low: cython.longlong,
    high: cython.longlong,
) -> cython.void:
    """Ink ``inner <= |x - cx| <= outer`` as far as ``low <= x - cx <= high``."""
    if inner <= 0:
        surface.span(y, cx + max(-outer, low), cx + min(outer, high) + 1)
    else:
        surface.span(y, cx + max(-outer, low), cx + min(-inner, high) + 1)
        surface.span(y, cx + max(inner, low), cx + min(outer, high) + 1)


@cython.cclass
class Wedge:
    """The angle clockwise from one vector to another, its sides included; reflex if it is more than half a turn."""

    def __init__(self, start: tuple[int, int], end: tuple[int, int], reflex: bool) -> None:
        self.start_x, self.start_y = start
        self.end_x, self.end_y = end
        self.reflex = reflex

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def row(self, y: cython.longlong, reach: cython.longlong) -> cython.void:
        """Set ``low <= x <= high`` to what of -reach ... reach is in the wedge in row `y`; if it is reflex, is not.

        (x, y) lies clockwise of a vector, or on it, if the cross product of the two is not negative.
        """
        edge: cython.int
        vx: cython.longlong
        vy: cython.longlong
        cross: cython.longlong
        flip: cython.bint
        self.low = -reach
        self.high = reach
        for edge in range(2):
            flip = edge == (0 if self.reflex else 1)
            vx = self.start_x if edge == 0 else self.end_x
            vy = self.start_y if edge == 0 else self.end_y
            if flip:
                vx, vy = -vx, -vy
            # vx * y - vy * x is at least 0, and above it where the sides are not the angle's own.
            cross = vx * y - self.reflex
            if vy > 0:
                self.high = min(self.high, cross // vy if cross >= 0 else -((vy - 1 - cross) // vy))
            elif vy < 0:
                self.low = max(self.low, -(cross // -vy) if cross >= 0 else (-vy - 1 - cross) // -vy)
            elif cross < 0:
                self.low = reach + 1


@cython.cclass
class Sector(Outline):
    """The outline of a circle's sector, one arc and two radii, or with `fill` these and all between them.

    The radii end on the circle at the wedge's vectors. Where these are one, so are the radii.
    """

    def __init__(self, cx: int, cy: int, r: int, fill: bool, wedge: Any) -> None:
        self.cx = cx
        self.cy = cy
        self.r = r
        self.fill = fill
        self.wedge = wedge

    @cython.cfunc
    @cython.nogil
    @cython.exceptval(check=False)
    def trace(self, surface: Surface) -> cython.void:
        x1: cython.longlong = self.wedge.start_x
        y1: cython.longlong = self.wedge.start_y
        x2: cython.longlong = self.wedge.end_x
        y2: cython.longlong = self.wedge.end_y
        if self.wedge.reflex or x1 != x2 or y1 != y2:
            ellipse(surface, self.cx, self.cy, self.r, self.r, self.fill, 0, self.wedge)
        bresenham(surface, self.cx, self.cy, self.cx + x1, self.cy + y1)
        bresenham(surface, self.cx, self.cy, self.cx + x2, self.cy + y2)


# -- The same, whatever their size and place, found row by visible row


def _half_width(a: int, b: int, y: int) -> int:
    """How far a midpoint ellipse reaches to each side, `y` rows from its center; -1 beyond its top."""
    if y > b:
        return -1
    if b == 0:
        return a
    flat = isqrt(a * a * (4 * b * b - (2 * y - 1) ** 2) // (4 * b * b))
    steep = isqrt(4 * a * a * (b * b - y * y) // (b * b))
    return max(flat, (steep + 1) // 2)


def end_of_radius(r: int, direction: tuple[int, int], unit: int) -> tuple[int, int]:
    """The pixel of the midpoint circle around (0, 0) nearest to the end of a radius; the direction is `unit` long."""
    x, y = abs(direction[0]), abs(direction[1])
    ends = []
    for step in (0, 1):
        row, column = r * y // unit + step, r * x // unit + step
        if row <= r:
            ends.append((_half_width(r, r, row), row))
        if column <= r:
            ends.append((column, _half_width(r, r, column)))
    # The squared distance, less what is the same for all.
    column, row = min(
        ends, key=lambda end: (unit * (end[0] ** 2 + end[1] ** 2) - 2 * r * (end[0] * x + end[1] * y), end)
    )
    return column if direction[0] >= 0 else -column, row if direction[1] >= 0 else -row


@cython.cfunc
def curve_far(
    surface: Surface, centers: Any, a: Any, b: Any, fill: cython.bint, quadrants: cython.int, wedge: Any
) -> Any:
    """A midpoint ellipse, its quarters around the corners of a rectangle, its left, top, right and bottom.

    A choice of quadrants or a wedge (its two vectors, and whether it is reflex) is for the case that there is one
    center.
    """
    left, top, right, bottom = centers
    for y in range(max(surface.top, top - b), min(surface.bottom, bottom + b + 1)):
        distance = max(top - y, y - bottom, 0)
        outer = _half_width(a, b, distance)
        inner = 0 if fill else min(outer, _half_width(a, b, distance + 1) + 1)
        if top < y < bottom and not fill:
            inner = outer
        limits = [_quadrants_far(quadrants, y - top, outer)] if wedge is None else _wedge_far(wedge, y - top, outer)
        sides = [(left - outer, left - inner), (right + inner, right + outer)]
        for low, high in [(left - outer, right + outer)] if inner <= 0 else sides:
            for first, last in limits:
                start, end = max(low, left + first), min(high, right + last) + 1
                surface.span(y, min(max(start, 0), surface.right), max(min(end, surface.right), 0))


def _quadrants_far(quadrants: int, y: int, reach: int) -> tuple[int, int]:
    right = (y <= 0 and quadrants & 1) or (y >= 0 and quadrants & 8)
    left = (y <= 0 and quadrants & 2) or (y >= 0 and quadrants & 4)
    return -reach if left else 0, reach if right else 0 if left else -1


def _wedge_far(wedge: Any, y: int, reach: int) -> list[tuple[int, int]]:
    """What of -reach ... reach is in the wedge in row `y`."""
    start, end, reflex = wedge
    low, high = -reach, reach
    for (x, down), sign in ((start, -1 if reflex else 1), (end, 1 if reflex else -1)):
        cross = sign * x * y - reflex
        if sign * down > 0:
            high = min(high, cross // (sign * down))
        elif sign * down < 0:
            low = max(low, -(cross // -(sign * down)))
        elif cross < 0:
            low = reach + 1
    if not reflex:
        return [(low, high)]
    return [(-reach, low - 1), (high + 1, reach)] if low <= high else [(-reach, reach)]


@cython.cfunc
def sector_far(surface: Surface, cx: Any, cy: Any, r: Any, fill: cython.bint, wedge: Any) -> Any:
    """A sector's outline or, with `fill`, all of it; drawn apart first, so that a pixel is painted once."""
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    start, end, reflex = wedge
    width, height = surface.width, surface.height
    apart: Surface = Surface(np.zeros(width * height, np.uint8), 0, width, width, height, 1)
    apart.set_window(surface.left, surface.top, surface.right, surface.bottom)
    apart.dip(1, 0)
    if reflex or start != end:
        curve_far(apart, (cx, cy, cx, cy), r, r, fill, 0, wedge)
    far(apart, cx, cy, cx + start[0], cy + start[1], [], 0)
    far(apart, cx, cy, cx + end[0], cy + end[1], [], 0)
    for y in range(surface.top, surface.bottom):
        for x in range(surface.left, surface.right):
            if apart.pixels[y * apart.stride + x]:
                surface.point(x, y)
