"""What curves are: points of the true one, and how far reference points are from it."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from stroke_definitions import HEIGHT, WIDTH, lattice, per_pixel

# How far a stroke's edge may be off, in pixels: chords and the arcs of joins by a quarter of a 256th each, the points
# of the path and the corners of the stroke's pieces by their rounding to 256ths.
OFF = (0.25 + 0.25 + 2 * 0.5**0.5) / 256


def bezier(points, steps=4000):
    """Points along the curve with these control points, of any degree, by de Casteljau's definition."""
    t = np.linspace(0, 1, steps + 1)[:, None]
    rows = [np.asarray(point, float)[None, :] for point in points]
    while len(rows) > 1:
        rows = [(1 - t) * a + t * b for a, b in pairwise(rows)]
    return rows[0] + 0 * t


def chain(points):
    """Points along a quadratic curve, or cubic ones in a chain."""
    if len(points) == 3:
        return bezier(points)
    return np.concatenate([bezier(points[i : i + 4]) for i in range(0, len(points) - 1, 3)] or [bezier(points)])


def catmull_rom(points, closed, steps=2000):
    """Points along the centripetal curve, by Barry and Goldman's pyramid of weighted means."""
    points = [np.asarray(point, float) for point in points]
    if closed:
        points = [points[-1], *points, points[0], points[1]]
    else:
        points = [2 * points[0] - points[1], *points, 2 * points[-1] - points[-2]]
    knots = np.cumsum([0, *(np.hypot(*(b - a)) ** 0.5 for a, b in pairwise(points))])
    return np.concatenate([_piece(points[i : i + 4], knots[i : i + 4], steps) for i in range(len(points) - 3)])


def _piece(points, knots, steps):
    t = np.linspace(knots[1], knots[2], steps + 1)[:, None]
    rows = list(points)
    for spans in ((0, 1), (1, 2), (2, 3)), ((0, 2), (1, 3)), ((1, 2),):
        ends = [(knots[i], knots[j]) for i, j in spans]
        rows = [((v - t) * a + (t - u) * b) / (v - u) for (u, v), a, b in zip(ends, rows, rows[1:], strict=False)]
    return rows[0]


def ellipse(x, y, a, b, angle=0, start=0, swept=360, steps=8000):
    """Points along an ellipse, turned by an angle."""
    t = np.radians(start + swept * np.linspace(0, 1, steps + 1))
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return np.stack([x + a * np.cos(t) * c - b * np.sin(t) * s, y + a * np.cos(t) * s + b * np.sin(t) * c], axis=1)


def near(curve, half, n, reference="center", size=(WIDTH, HEIGHT)):
    """The least and the largest counts of what is within `half` of a curve, which may be a 256th of a pixel off."""
    xs, ys = (axis.astype(float) / (512 * n) for axis in lattice(n, reference, size))
    xs, ys = np.broadcast_arrays(xs, ys)
    nearest = np.full(xs.shape, np.inf)
    for part in np.array_split(curve, max(len(curve) // 500, 1)):
        squared = (xs[..., None] - part[:, 0]) ** 2 + (ys[..., None] - part[:, 1]) ** 2
        nearest = np.minimum(nearest, np.sqrt(squared.min(axis=-1)))
    # What lies between the points of the curve that are looked at, and what corners and chords are off.
    step = np.hypot(*np.diff(curve, axis=0).T).max()
    between = np.hypot(half, step) - half
    return per_pixel(nearest <= half - OFF, n), per_pixel(nearest <= half + OFF + between, n)
