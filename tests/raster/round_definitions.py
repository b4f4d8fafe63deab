"""What round shapes are, in exact arithmetic and without haste. The tests compare the raster with this.

As in `definitions`, a shape says how much of each pixel it covers. A reference point on an edge belongs to the side
that it is on after a step to the right, and another one downward, each far smaller than the one before.
"""

from __future__ import annotations

import definitions
import numpy as np
from definitions import nearest

HAIR = 1 << 100


def ellipse(width, height, x, y, xr, yr, fill=False, quadrants=15):
    """The pixels whose side toward an axis has its midpoint in the true ellipse; of these the outermost."""
    x, y, xr, yr = map(nearest, (x, y, xr, yr))
    lit = np.zeros((height, width), bool)
    for row in range(height):
        for column in range(width):
            dx, dy = column - x, row - y
            if not in_ellipse(abs(dx), abs(dy), xr, yr):
                continue
            outermost = not (in_ellipse(abs(dx) + 1, abs(dy), xr, yr) and in_ellipse(abs(dx), abs(dy) + 1, xr, yr))
            quarters = {(1, -1): 1, (-1, -1): 2, (-1, 1): 4, (1, 1): 8}
            wanted = any(quadrants & bit and dx * sx >= 0 and dy * sy >= 0 for (sx, sy), bit in quarters.items())
            lit[row, column] = wanted and (fill or outermost)
    return lit


def in_ellipse(x, y, xr, yr):
    if xr == 0 or yr == 0 or x == y == 0:
        return x <= xr and y <= yr
    # Twice the midpoints, against the equation of the ellipse.
    left = x > 0 and (2 * x - 1) ** 2 * yr**2 + 4 * y**2 * xr**2 <= 4 * xr**2 * yr**2
    below = y > 0 and 4 * x**2 * yr**2 + (2 * y - 1) ** 2 * xr**2 <= 4 * xr**2 * yr**2
    return left or below


def band(width, height, box, radii, thickness, *, fill=False, sharp=False, cut=None, n=1, reference="center"):
    """How many reference points of each pixel are in the band along a curve, or in what it encloses.

    The curve goes around `box`, the left, top, right and bottom of the rectangle between the centers of its corners.
    `cut` is a function of (xs, ys, half a width, n) seen from the box's top-left corner that says what is inside.
    """
    box = [fixed(value) * 2 * n for value in box]
    radii = [fixed(value) * 2 * n for value in radii]
    half = fixed(thickness) * n
    xs = definitions.reference_points(width, n, reference)[None, :] * HAIR**3 + HAIR**2
    ys = definitions.reference_points(height, n, reference)[:, None] * HAIR**3 + 1
    inside = in_box(xs, ys, box, radii, half, sharp)
    if not fill:
        inside = inside & ~in_box(xs, ys, box, radii, -half, sharp)
    if cut is not None:
        inside = cut(inside, xs - box[0] * HAIR**3, ys - box[1] * HAIR**3, radii[0], half, n)
    return inside.reshape(height, n, width, n).sum(axis=(1, 3))


def fixed(value):
    return nearest(definitions.Fraction(value) * 256)


def in_box(xs, ys, box, radii, outward, sharp):
    """Whether points are within the curve, `outward` of where it is."""
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
    return ((away_x == 0) & (away_y == 0)) | (away_x**2 * b**2 + away_y**2 * a**2 < a**2 * b**2)


def quadrants(bits):
    def cut(inside, xs, ys, r, half, n):
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
    return lambda inside, xs, ys, r, half, n: inside & in_wedge(xs, ys, start, end, swept)


def sector_outline(start, end, swept, unit):
    def cut(inside, xs, ys, r, half, n):
        outline = inside & in_wedge(xs, ys, start, end, swept)
        for x, y in (start, end):
            across = x * ys - y * xs
            reach = half * unit * HAIR**3
            outline = outline | ((across > -reach) & (across < reach) & (x * xs + y * ys > 0))
        outline = outline | (xs**2 + ys**2 < (half * HAIR**3) ** 2)
        return outline & (xs**2 + ys**2 < ((r + half) * HAIR**3) ** 2)

    return cut
