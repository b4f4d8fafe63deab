"""What round shapes are, in exact arithmetic and without haste. The tests compare the raster with this.

As in `definitions`, a shape says how much of each pixel it covers. A reference point on an edge belongs to the side
that it is on after a step to the right, and another one downward, each far smaller than the one before.
"""

from __future__ import annotations

from fractions import Fraction

import definitions
import numpy as np
from definitions import nearest
from numpy.lib.stride_tricks import sliding_window_view

HAIR = 1 << 100


def ellipse(width, height, x, y, xr, yr, fill=False, quadrants=15):
    """The pixels whose side toward an axis has its midpoint in the true ellipse; of these the outermost."""
    x, y, xr, yr = halves(x, y, xr, yr)
    x, y = on_pixels(x, xr), on_pixels(y, yr)
    quarters = [signs for bit, signs in enumerate([(1, -1), (-1, -1), (-1, 1), (1, 1)]) if quadrants >> bit & 1]
    lit = np.zeros((height, width), bool)
    for row in range(height):
        for column in range(width):
            u, v = 2 * column - x, 2 * row - y
            wanted = any(u * sx >= 0 and v * sy >= 0 for sx, sy in quarters)
            if wanted and in_ellipse(x, y, xr, yr, u, v):
                outward = [(abs(u) + 2, abs(v)), (abs(u), abs(v) + 2)]
                lit[row, column] = fill or not all(in_ellipse(x, y, xr, yr, *pixel) for pixel in outward)
    return lit


def halves(*numbers):
    """Pixels in half pixels, to the nearest, halves upward."""
    return [nearest(2 * Fraction(number)) for number in numbers]


def on_pixels(center, radius):
    """A center in half pixels: where the curve is a line or a dot, that of the nearest pixel, halves upward."""
    return center if radius else center + center % 2


def in_ellipse(x, y, xr, yr, u, v):
    """Whether a pixel at (u, v) from the center, in half pixels, belongs to the filled ellipse."""
    u, v = abs(u), abs(v)
    if xr == 0 or yr == 0 or u == v == 0:
        return u <= xr and v <= yr
    whole = all(number % 2 == 0 for number in (x, y, xr, yr))
    # The midpoints of the sides toward the axes, against the equation of the ellipse; on it they are inside if all is
    # whole, or if the side lies on an axis.
    beside = (u - 1) ** 2 * yr**2 + v**2 * xr**2 - xr**2 * yr**2 if u else 1
    below = u**2 * yr**2 + (v - 1) ** 2 * xr**2 - xr**2 * yr**2 if v else 1
    return beside < (whole or u == 1) or below < (whole or v == 1)


def round_rect(width, height, x, y, w, h, r, fill=False):
    """Quadrants of circles, and straight sides between them. A radius goes as far as the sides have room for it."""
    r = Fraction(min(halves(r)[0], w - 1, h - 1), 2)
    left, top, right, bottom = x + r, y + r, x + w - 1 - r, y + h - 1 - r
    rows, columns = np.ogrid[:height, :width]
    box = (x <= columns) & (columns < x + w) & (y <= rows) & (rows < y + h)
    wanted = box if fill else box & ((columns == x) | (columns == x + w - 1) | (rows == y) | (rows == y + h - 1))
    if r < 1:
        return wanted
    lit = wanted & (((left <= columns) & (columns <= right)) | ((top <= rows) & (rows <= bottom)))
    for cx, cy, quadrant in ((right, top, 1), (left, top, 2), (left, bottom, 4), (right, bottom, 8)):
        lit |= ellipse(width, height, cx, cy, r, r, fill, quadrant)
    return lit


def band(width, height, box, radii, thickness, *, fill=False, sharp=False, cut=None, n=1, reference="center", off=0):
    """The least and the most reference points of each pixel in the band along a curve, or in what it encloses.

    The curve goes around `box`, the left, top, right and bottom of the rectangle between the centers of its corners.
    `cut` is a function of (xs, ys, half a width, n) seen from the box's top-left corner that says what is inside. A
    point within 1/256 of a pixel of the curve may be counted or not; with `off`, all may be so many pixels elsewhere.
    """
    box = [(fixed(value) + 256 * off) * 2 * n for value in box]
    radii = [fixed(value) * 2 * n for value in radii]
    half = fixed(thickness) * n
    xs = definitions.reference_points(width + 2 * off, n, reference)[None, :] * HAIR**3 + HAIR**2
    ys = definitions.reference_points(height + 2 * off, n, reference)[:, None] * HAIR**3 + 1
    counts = []
    for slack, around in (-2 * n, np.all), (2 * n, np.any):
        inside = in_box(xs, ys, box, radii, half, sharp, slack)
        if not fill:
            inside = inside & ~in_box(xs, ys, box, radii, -half, sharp, -slack)
        if cut is not None:
            inside = cut(inside, xs - box[0] * HAIR**3, ys - box[1] * HAIR**3, radii[0], half, n, slack)
        inside = around(sliding_window_view(inside.astype(bool), [2 * n * off + 1] * 2), axis=(2, 3))
        counts.append(inside.reshape(height, n, width, n).sum(axis=(1, 3)))
    return counts


def fixed(value):
    return nearest(Fraction(value) * 256)


def in_box(xs, ys, box, radii, outward, sharp, slack):
    """Whether points are within the curve, `outward` of where it is; where it is round, by `slack` more."""
    left, top, right, bottom = box
    a, b = (0, 0) if sharp else (radius + outward for radius in radii)
    beyond_x, beyond_y = (outward, outward) if sharp else (min(0, a), min(0, b))
    a, b = max(a, 0) * HAIR**3, max(b, 0) * HAIR**3
    left, right = (left - beyond_x) * HAIR**3, (right + beyond_x) * HAIR**3
    top, bottom = (top - beyond_y) * HAIR**3, (bottom + beyond_y) * HAIR**3
    if left > right or top > bottom:
        return (xs != xs) & (ys != ys)
    away_x = np.maximum(np.maximum(left - xs, xs - right), 0)
    away_y = np.maximum(np.maximum(top - ys, ys - bottom), 0)
    straight = (away_x == 0) & (away_y < b) | (away_y == 0) & (away_x < a) | (away_x == 0) & (away_y == 0)
    if a == 0 or b == 0:
        return straight
    a, b = (max(radius + slack * HAIR**3, 0) for radius in (a, b))
    return straight | (away_x > 0) & (away_y > 0) & (away_x**2 * b**2 + away_y**2 * a**2 < a**2 * b**2)


def quadrants(bits):
    def cut(inside, xs, ys, r, half, n, slack):
        reach = 256 * n * HAIR**3
        wanted = (xs != xs) & (ys != ys)
        for bit, (sx, sy) in enumerate([(1, -1), (-1, -1), (-1, 1), (1, 1)]):
            if bits >> bit & 1:
                wanted = wanted | ((xs * sx > -reach) & (ys * sy > -reach))
        return inside & wanted

    return cut


def in_wedge(xs, ys, start, end, swept):
    after = start[0] * ys - start[1] * xs > 0
    before = end[0] * ys - end[1] * xs < 0
    return after & before if swept <= 180 else after | before


def wedge(start, end, swept, unit):
    return lambda inside, xs, ys, r, half, n, slack: inside & in_wedge(xs, ys, start, end, swept)


def sector_outline(start, end, swept, unit):
    def cut(inside, xs, ys, r, half, n, slack):
        outline = inside & in_wedge(xs, ys, start, end, swept)
        for x, y in (start, end):
            across = x * ys - y * xs
            reach = half * unit * HAIR**3
            outline = outline | ((across > -reach) & (across < reach) & (x * xs + y * ys > 0))
        outline = outline | (xs**2 + ys**2 < (max(half + slack, 0) * HAIR**3) ** 2)
        return outline & (xs**2 + ys**2 < (max(r + half + slack, 0) * HAIR**3) ** 2)

    return cut
