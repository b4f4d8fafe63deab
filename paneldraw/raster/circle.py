"""Thin and filled round shapes: circle, disc, ellipse, arc, sector, and the rectangle with round corners.

Centers and radii are whole numbers of half pixels. Seen from a center (x, y), a pixel is at (u, v), which is twice its
coordinates less (x, y): even numbers where the center is on a pixel, odd ones where it is halfway between two.

A pixel belongs to the filled curve if the midpoint of its side toward an axis of the curve, (|u| - 1, v) or
(u, |v| - 1), is inside the true curve; the outline is the outermost pixels of that. This is what Bresenham's midpoint
method finds: integers only, one decision a step, every pixel once. A midpoint on the curve itself is inside if center
and radii are whole pixels, or if the side lies on the axis. With half pixels it is outside: then the inner one of the
two pixels it lies between is the nearer one, and no single pixel sticks out at the ends of the axes.

Centers may be as far from the window as a radius, radii up to 2**18 half pixels: 64 bits hold all decisions.
"""

from __future__ import annotations

import cython
from cython.cimports.libc.math import sqrt
from cython.cimports.paneldraw.raster.floors import floored
from cython.cimports.paneldraw.raster.line import bresenham
from cython.cimports.paneldraw.raster.paint import once, painted
from cython.cimports.paneldraw.raster.surface import Surface, holds, near

#: The length of the vectors that `arc` and `sector` take for angles.
UNIT = 1 << 40
_UNIT_BITS = cython.declare(cython.int, 40)

# -- Circles, and rectangles with the quarters of a circle for corners


def circle(surface, x, y, r):
    """The midpoint circle of radius `r` around (x, y); a radius of 0 is a pixel."""
    if (x ^ y) & 1:  # on a pixel one way, between two the other: its octants differ
        ellipse(surface, x, y, r, r, False, 15)
    elif r <= 1 + (x & 1):  # one pixel or four
        disc(surface, x, y, r)
    else:
        round_rect(surface, x, y, x, y, r, False)


def disc(surface, x, y, r):
    """The midpoint circle and what it encloses."""
    if (x ^ y) & 1 or r == 0:
        ellipse(surface, x, y, r, r, True, 15)
    else:
        round_rect(surface, x, y, x, y, r, True)


def round_rect(surface, left, top, right, bottom, r, fill):
    """The quarters of a circle around the corners of a box, and the straight sides between them.

    The four corners are all on pixels or all halfway between them. The radius is at least 1 pixel, or any if it is
    filled; smaller ones make sharp corners, which other functions draw.
    """
    row: cython.longlong
    half: cython.longlong = left & 1
    if (
        left - r >= 2 * surface.right
        or right + r < 2 * surface.left
        or top - r >= 2 * surface.bottom
        or bottom + r < 2 * surface.top
    ):
        return
    if r <= 2 * (surface.bottom - surface.top):
        # The walk by octants takes half the time of the one by quadrants, but walks all around.
        _octants(surface, left, top, right, bottom, r, fill)
        return
    for row in range(max(((top - half) >> 1) + 1, surface.top), min((bottom + half) >> 1, surface.bottom)):
        _row(surface, row, left, right, 0 if fill else r, r, -r, r)
    _quadrants(surface, left, top, right, bottom, r, r, fill, 15, None)


def _octants(surface, left, top, right, bottom, r, fill):
    """Walk the octant from the top to the diagonal, and paint what it says of all eight.

    x and y count pixels, from the four that are nearest to the center: it may be between them. The decision parameter p
    is the circle's equation, a quarter of it, at the midpoint between the next two pixels. While it is negative, the
    midpoint is inside and y stays. Around a whole pixel it starts at the textbook's 1 - r.

    Filled, a step is the end of a row in a side octant and, before y changes, of one in the top octant.
    """
    odd: cython.longlong = left & 1
    x: cython.longlong = 0
    y: cython.longlong = (r - odd) >> 1
    p: cython.longlong = ((odd + 2) * (odd + 2) + (2 * y + odd - 1) * (2 * y + odd - 1) - r * r) >> 2
    left = (left - odd) >> 1
    top = (top - odd) >> 1
    right = (right + odd) >> 1
    bottom = (bottom + odd) >> 1
    visible: cython.bint = holds(surface, left - y, top - y) and holds(surface, right + y, bottom + y)
    _sides(surface, left, top, right, bottom, y, fill)
    while x <= y:
        if fill:
            _rows(surface, left - y, top - x, right + y, bottom + x)
        elif x > 0:
            _corners(surface, visible, left - x, top - y, right + x, bottom + y)
            if x < y:
                _corners(surface, visible, left - y, top - x, right + y, bottom + x)
        x += 1
        if p < 0:
            p += 2 * x + odd + 1
        else:
            if fill and x <= y:
                _rows(surface, left - x + 1, top - y, right + x - 1, bottom + y)
            y -= 1
            p += 2 * (x - y) + 1


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _sides(
    surface: Surface,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
    outward: cython.longlong,
    fill: cython.bint,
) -> cython.void:
    """Paint the four sides of a box, moved outward; filled, the rows between the upper and the lower corners."""
    row: cython.longlong
    if fill:
        for row in range(max(top + 1, surface.top), min(bottom, surface.bottom)):
            surface.span(row, left - outward, right + outward + 1)
        return
    surface.span(top - outward, left, right + 1)
    surface.span(bottom + outward, left, right + 1)
    for row in range(max(top, surface.top), min(bottom + 1, surface.bottom)):
        surface.point(left - outward, row)
        surface.point(right + outward, row)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _rows(
    surface: Surface, left: cython.longlong, top: cython.longlong, right: cython.longlong, bottom: cython.longlong
) -> cython.void:
    """Paint the first and the last row of a box."""
    surface.span(top, left, right + 1)
    if top < bottom:
        surface.span(bottom, left, right + 1)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _corners(
    surface: Surface,
    visible: cython.bint,
    left: cython.longlong,
    top: cython.longlong,
    right: cython.longlong,
    bottom: cython.longlong,
) -> cython.void:
    """Paint the four corners of a box. Where all are known to be visible, that takes 0.6 of the time."""
    if not visible:
        surface.point(left, top)
        surface.point(right, top)
        surface.point(left, bottom)
        surface.point(right, bottom)
        return
    pixels: cython.p_uchar = surface.pixels
    becomes: cython.p_uchar = surface.becomes
    above: cython.Py_ssize_t = near(top * surface.stride)
    below: cython.Py_ssize_t = near(bottom * surface.stride)
    pixels[above + left] = becomes[pixels[above + left]]
    pixels[above + right] = becomes[pixels[above + right]]
    pixels[below + left] = becomes[pixels[below + left]]
    pixels[below + right] = becomes[pixels[below + right]]


# -- Ellipses, and what a choice of quadrants or an angle leaves of them


def ellipse(surface, x, y, a, b, fill, quadrants):
    """The midpoint ellipse with the radii `a` and `b`, or some of its quadrants.

    These are the sum of 1 for the top right one, 2 for the top left, 4 for the bottom left, 8 for the bottom right. Of
    a radius of 0 the ellipse is a line, or a pixel.
    """
    x += x & 1 if a == 0 else 0
    y += y & 1 if b == 0 else 0
    _quadrants(surface, x, y, x, y, a, b, fill, quadrants, None)


def _quadrants(surface, left, top, right, bottom, a, b, fill, quadrants, wedge):
    """Walk a quadrant of the ellipse from the top, (0, b), to the side, (a, 0), row by row, and paint all four.

    They lie around the corners of a box; some of them, or a wedge, are wanted of a single center only. Two decision
    parameters say whether u grows in a row: p, the ellipse's equation at the midpoint below the next pixel, decides
    where the curve is flat, and q, at the midpoint to its left, where it is steep. Where one of them decides, the other
    says nothing more. The walk begins just before the rows in the window, and ends with them.
    """
    odd: cython.longlong = left & 1
    whole: cython.bint = ((left | top | a | b) & 1) == 0
    widest: cython.longlong = a - ((a ^ left) & 1)
    nearest: cython.longlong = max(0, 2 * surface.top - bottom, top + 2 - 2 * surface.bottom)
    farthest: cython.longlong = max(top - 2 * surface.top, 2 * surface.bottom - 2 - bottom)
    v: cython.longlong = min(b - ((b ^ top) & 1), farthest + 2)
    u: cython.longlong = _half_width(a, b, odd, v, whole)
    inner: cython.longlong = odd
    p: cython.longlong = _equation(a, b, u + 2, v - 1) - whole
    q: cython.longlong = _equation(a, b, u + 1, v) - whole
    while v >= nearest:
        # Sixteen pixels more, and the root is quicker: 40 times for an ellipse of 131,000 by 30 pixels.
        if p + 64 * b * b * (u + 16) < 0:
            u = _half_width(a, b, odd, v, whole)
            p = _equation(a, b, u + 2, v - 1) - whole
            q = _equation(a, b, u + 1, v) - whole
        while u < widest and (p < 0 or q < 0 or v <= 1):
            u += 2
            p += 4 * b * b * (u + 1)
            q += 4 * b * b * u
        inner = 0 if fill else min(u, inner)
        _part(surface, (top - v) >> 1, left, right, -v, inner, u, quadrants, wedge)
        if v > 0 or top < bottom:
            _part(surface, (bottom + v) >> 1, left, right, v, inner, u, quadrants, wedge)
        inner = u + 2
        v -= 2
        p -= 4 * a * a * v
        q -= 4 * a * a * (v + 1)


def _half_width(a, b, odd, v, whole):
    """How far the filled ellipse reaches in row `v`; -1 above its top.

    From a little before the end of the true one on, the decision parameters of `_quadrants` decide.
    """
    widest: cython.longlong = a - ((a ^ odd) & 1)
    if v > b:
        return -1
    if v <= 1:
        return widest
    u: cython.longlong = max(_true_half_width(a, b, v - 1), _true_half_width(a, b, v) + 1) - 2
    u = max(u - ((u ^ odd) & 1), odd)
    p: cython.longlong = _equation(a, b, u + 2, v - 1) - whole
    q: cython.longlong = _equation(a, b, u + 1, v) - whole
    while u < widest and (p < 0 or q < 0):
        u += 2
        p += 4 * b * b * (u + 1)
        q += 4 * b * b * u
    return u


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _true_half_width(a: cython.longlong, b: cython.longlong, v: cython.longlong) -> cython.longlong:
    """How far the true ellipse reaches at `v`, rounded down; it may be one off."""
    slope: cython.double = cython.cast(cython.double, a) / cython.cast(cython.double, b)
    return floored(slope * sqrt(cython.cast(cython.double, b * b - v * v)))


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _equation(a: cython.longlong, b: cython.longlong, u: cython.longlong, v: cython.longlong) -> cython.longlong:
    """Negative inside of the ellipse, 0 on it. The terms are taken modulo 2**64: near the curve, that is all of it."""
    aa: cython.ulonglong = cython.cast(cython.ulonglong, a * a)
    bb: cython.ulonglong = cython.cast(cython.ulonglong, b * b)
    uu: cython.ulonglong = cython.cast(cython.ulonglong, u * u)
    vv: cython.ulonglong = cython.cast(cython.ulonglong, v * v)
    return cython.cast(cython.longlong, bb * uu + aa * vv - aa * bb)


def _part(surface, y, left, right, v, inner, outer, quadrants, wedge):
    """Paint what is wanted of the pixels ``inner <= |u| <= outer`` of row `y`, which is at `v`."""
    on_left: cython.bint
    on_right: cython.bint
    if wedge is None:
        on_right = (v <= 0 and quadrants & 1) or (v >= 0 and quadrants & 8)
        on_left = (v <= 0 and quadrants & 2) or (v >= 0 and quadrants & 4)
        if on_right or on_left:
            _row(surface, y, left, right, inner, outer, -outer if on_left else 0, outer if on_right else 0)
        return
    wedge.cut(v, outer)
    if not wedge.reflex:
        _row(surface, y, left, right, inner, outer, wedge.low, wedge.high)
    elif wedge.low > wedge.high:
        _row(surface, y, left, right, inner, outer, -outer, outer)
    else:
        _row(surface, y, left, right, inner, outer, -outer, wedge.low - 1)
        _row(surface, y, left, right, inner, outer, wedge.high + 1, outer)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _row(
    surface: Surface,
    y: cython.longlong,
    left: cython.longlong,
    right: cython.longlong,
    inner: cython.longlong,
    outer: cython.longlong,
    low: cython.longlong,
    high: cython.longlong,
) -> cython.void:
    """Paint ``inner <= |u| <= outer`` as far as ``low <= u <= high``; u < 0 is seen from `left`, u > 0 from `right`."""
    start: cython.longlong = (left + max(-outer, low) + 1) >> 1
    end: cython.longlong = ((right + min(outer, high)) >> 1) + 1
    if inner <= 1:
        surface.span(y, start, end)
    else:
        surface.span(y, start, ((left + min(-inner, high)) >> 1) + 1)
        surface.span(y, (right + max(inner, low) + 1) >> 1, end)


# -- Arcs and sectors


@cython.final
@cython.cclass
class Wedge:
    """The angle clockwise from a start to an end, two pixels (u, v) that belong to it.

    It is reflex if it is more than half a turn.
    """

    def __init__(self):
        self.reflex = False
        self.distance = 0

    def aim(self, at_end, x, y, r, dx, dy):
        """Let the start or the end be the pixel of the circle nearest to where its radius ends, in direction (dx, dy).

        Of two equally near ones, on both sides of an axis it is the one within the wedge, elsewhere the inner one.
        """
        step: cython.longlong
        odd_x: cython.longlong = x & 1
        odd_y: cython.longlong = y & 1
        whole: cython.bint = ((x | y | r) & 1) == 0
        leftward: cython.bint = dx < 0 or (dx == 0 and (dy > 0) != at_end)
        upward: cython.bint = dy < 0 or (dy == 0 and (dx < 0) != at_end)
        dx = abs(dx)
        dy = abs(dy)
        # The last column and the last row before that point.
        u: cython.longlong = (r * dx) >> _UNIT_BITS
        v: cython.longlong = (r * dy) >> _UNIT_BITS
        u = max(u - ((u ^ odd_x) & 1), odd_x)
        v = max(v - ((v ^ odd_y) & 1), odd_y)
        self.u = -1
        for step in range(0, 4, 2):
            self.consider(r, dx, dy, _half_width(r, r, odd_x, v + step, whole), v + step)
            self.consider(r, dx, dy, u + step, _half_width(r, r, odd_y, u + step, whole))
        u = -self.u if leftward else self.u
        v = -self.v if upward else self.v
        if at_end:
            self.end_u = u
            self.end_v = v
        else:
            self.start_u = u
            self.start_v = v

    def consider(self, r, dx, dy, u, v):
        """Keep a pixel of the circle, if it is nearer than what is kept. The directions are not negative."""
        if u < 0 or v < 0 or max(u, v) > r:
            return
        # The squared distance, less what is the same for all; taken modulo 2**64, of which a difference is right.
        squares: cython.ulonglong = cython.cast(cython.ulonglong, u * u + v * v)
        along: cython.ulonglong = cython.cast(cython.ulonglong, u * dx + v * dy)
        distance: cython.ulonglong = (squares << _UNIT_BITS) - cython.cast(cython.ulonglong, 2 * r) * along
        if self.u < 0 or cython.cast(cython.longlong, distance - self.distance) < 0:
            self.distance = distance
            self.u = u
            self.v = v

    def cut(self, v, reach):
        """Set ``low <= u <= high`` to what of -reach ... reach is in the wedge in row `v`; if it is reflex, is not.

        A pixel lies clockwise of a vector, or on it, if the cross product of the two is not negative.
        """
        self.low = -reach
        self.high = reach
        if self.reflex:
            self.keep_clockwise(-self.start_u, -self.start_v, v)
            self.keep_clockwise(self.end_u, self.end_v, v)
        else:
            self.keep_clockwise(self.start_u, self.start_v, v)
            self.keep_clockwise(-self.end_u, -self.end_v, v)

    def keep_clockwise(self, du, dv, v):
        """Cut off what is counterclockwise of a vector, or on it, too, if the wedge is reflex."""
        cross: cython.longlong = du * v - self.reflex
        if dv > 0:
            self.high = min(self.high, _floor_quotient(cross, dv))
        elif dv < 0:
            self.low = max(self.low, -_floor_quotient(cross, -dv))
        elif cross < 0:
            self.low = self.high + 1


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _floor_quotient(number: cython.longlong, divisor: cython.longlong) -> cython.longlong:
    """The quotient rounded down, which C would round toward 0; the divisor is positive."""
    return number // divisor if number >= 0 else -((divisor - 1 - number) // divisor)


def _wedge(x, y, r, start_x, start_y, end_x, end_y, reflex):
    """The wedge between two directions; where these are nearly opposite, its pixels say whether it is reflex."""
    wedge: Wedge = Wedge()
    wedge.aim(False, x, y, r, start_x, start_y)
    if start_x == end_x and start_y == end_y and not reflex:
        wedge.end_u = wedge.start_u
        wedge.end_v = wedge.start_v
    else:
        wedge.aim(True, x, y, r, end_x, end_y)
    half: cython.int = _UNIT_BITS // 2
    turned: cython.longlong = wedge.start_u * wedge.end_v - wedge.start_v * wedge.end_u
    if turned != 0 and (start_x >> half) * (end_x >> half) + (start_y >> half) * (end_y >> half) < 0:
        wedge.reflex = turned < 0
    else:
        wedge.reflex = reflex
    return wedge


def arc(surface, x, y, r, start_x, start_y, end_x, end_y, reflex):
    """The midpoint circle clockwise from the pixel nearest to one end of the arc to the pixel nearest to the other.

    The ends are given as directions, vectors of the length `UNIT`; `reflex` says whether the angle between them is more
    than half a turn.
    """
    if r == 0:
        x += x & 1
        y += y & 1
    wedge: Wedge = _wedge(x, y, r, start_x, start_y, end_x, end_y, reflex)
    if wedge.start_u == wedge.end_u and wedge.start_v == wedge.end_v and not wedge.reflex:
        surface.point((x + wedge.start_u) >> 1, (y + wedge.start_v) >> 1)
    else:
        _quadrants(surface, x, y, x, y, r, r, False, 15, wedge)


def sector(surface, x, y, r, start_x, start_y, end_x, end_y, reflex, fill):
    """An arc and Bresenham's lines from the center to its ends; with `fill`, these and all of the disc between them."""
    if r == 0:
        x += x & 1
        y += y & 1
    wedge: Wedge = _wedge(x, y, r, start_x, start_y, end_x, end_y, reflex)
    marks: Surface = once(surface)
    if wedge.start_u != wedge.end_u or wedge.start_v != wedge.end_v or wedge.reflex:
        _quadrants(marks, x, y, x, y, r, r, fill, 15, wedge)
    _radius(marks, x, y, wedge.start_u, wedge.start_v)
    _radius(marks, x, y, wedge.end_u, wedge.end_v)
    painted(surface, marks, (y - r) >> 1, ((y + r) >> 1) + 1)


def _radius(surface, x, y, u, v):
    """The line to (u, v) from the pixel at the center; of those equally near, from the one in that direction."""
    column: cython.longlong = (x + (x & 1 if u > 0 else 0)) >> 1
    row: cython.longlong = (y + (y & 1 if v > 0 else 0)) >> 1
    bresenham(surface, column, row, (x + u) >> 1, (y + v) >> 1)
