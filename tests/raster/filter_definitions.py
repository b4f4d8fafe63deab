"""What a filter makes of a shape: its volume above it, integrated point by point; and what is inside a round shape.

A shape is a function of arrays xs and ys, in pixels, that says which points are inside.
"""

from __future__ import annotations

import numpy as np

POINTS = 20000

heights = {
    "cone": lambda distance: 1 - distance,
    "box": np.ones_like,
    "gaussian": lambda distance: np.exp(-2 * distance**2),
}


def volumes(inside, radius, filter, size):
    """The filter's volume above a shape for each pixel, from 0 to 1."""
    # A sunflower's seeds: each stands for the same area, and no straight edge passes through more of them than another.
    seeds = np.arange(POINTS) + 0.5
    distance, turn = np.sqrt(seeds / POINTS), seeds * np.pi * (3 - np.sqrt(5))
    weights = heights[filter](distance)
    dx, dy = radius * distance * np.cos(turn), radius * distance * np.sin(turn)
    width, height = size
    rows = [[weights[inside(x + dx, y + dy)].sum() for x in range(width)] for y in range(height)]
    return np.array(rows) / weights.sum()


def polygon(corners, rule):
    def inside(xs, ys):
        turns = np.zeros(xs.shape, int)
        for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True):
            sign = 1 if y1 < y2 else -1
            if y2 < y1:
                x1, y1, x2, y2 = x2, y2, x1, y1
            turns += sign * ((y1 <= ys) & (ys < y2) & ((y2 - y1) * (xs - x1) >= (x2 - x1) * (ys - y1)))
        return turns % 2 == 1 if rule == "even-odd" else turns != 0

    return inside


def band(box, radii, width, fill=False, sharp=False, cut=None):
    """As `round_definitions.band`, in floating point."""

    def inside(xs, ys):
        here = _in_curve(xs, ys, box, radii, width / 2, sharp)
        if not fill:
            here &= ~_in_curve(xs, ys, box, radii, -width / 2, sharp)
        return here if cut is None else cut(here, xs - box[0], ys - box[1], radii[0], width / 2)

    return inside


def _in_curve(xs, ys, box, radii, outward, sharp):
    a, b = (0, 0) if sharp else (radius + outward for radius in radii)
    x, y = (outward, outward) if sharp else (min(0, a), min(0, b))
    left, top, right, bottom = box[0] - x, box[1] - y, box[2] + x, box[3] + y
    a, b = max(a, 0), max(b, 0)
    if left > right or top > bottom:
        return np.zeros(xs.shape, bool)
    away_x = np.maximum(np.maximum(left - xs, xs - right), 0)
    away_y = np.maximum(np.maximum(top - ys, ys - bottom), 0)
    return ((away_x == 0) & (away_y == 0)) | ((away_x * b) ** 2 + (away_y * a) ** 2 < (a * b) ** 2)


def quadrants(bits):
    def cut(inside, xs, ys, r, half):
        wanted = np.zeros(xs.shape, bool)
        for bit, (sx, sy) in enumerate([(1, -1), (-1, -1), (-1, 1), (1, 1)]):
            if bits >> bit & 1:
                wanted |= (xs * sx > -0.5) & (ys * sy > -0.5)
        return inside & wanted

    return cut


def wedge(start, swept):
    return lambda inside, xs, ys, r, half: inside & ((np.degrees(np.arctan2(ys, xs)) - start) % 360 < swept)


def sector_outline(start, swept):
    def cut(inside, xs, ys, r, half):
        outline = wedge(start, swept)(inside, xs, ys, r, half)
        for angle in np.radians([start, start + swept]):
            x, y = np.cos(angle), np.sin(angle)
            outline |= (abs(x * ys - y * xs) < half) & (x * xs + y * ys > 0)
        outline |= xs**2 + ys**2 < half**2
        return outline & (xs**2 + ys**2 < (r + half) ** 2)

    return cut
