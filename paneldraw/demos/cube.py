"""A turning cube whose hidden edges are dotted: a rotation, a perspective, twelve lines."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .. import Framebuffer, Supersample

Array = NDArray[np.float64]

CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
EDGES = [(a, b) for a in range(8) for b in range(a) if np.count_nonzero(CORNERS[a] != CORNERS[b]) == 1]
FACES = np.array([np.where(CORNERS[a] == CORNERS[b], CORNERS[a], 0) for a, b in EDGES])
"""For each edge, the two sides of the cube that it lies between: -1 or 1 along two of the three axes."""
EYE = 6.0
"""The eye's distance from the middle; the cube's edges are 2 long."""
PERIOD = 10.0
"""Seconds a turn."""


def draw(fb: Framebuffer, t: float) -> None:
    """Draw the cube as large as fits; it nods as it turns."""
    fb.clear()
    turn = 2 * math.pi * t / PERIOD
    axes = _about_y(turn) @ _about_x(-0.5 + 0.2 * math.sin(turn))
    corners = CORNERS @ axes
    middle = np.array((fb.width - 1, fb.height - 1)) / 2
    points = middle + corners[:, :2] / (1 - corners[:, 2:] / EYE) * min(fb.width, fb.height) * 0.26
    antialias = Supersample(4) if fb.depth > 1 else None
    # An edge is seen if one of its two faces is turned towards the eye.
    seen = np.any(FACES * axes[:, 2] * EYE > 1, axis=1)
    for (a, b), in_sight in zip(EDGES, seen.tolist(), strict=True):
        if in_sight:
            fb.line(*points[a], *points[b], antialias=antialias)
        else:
            fb.points(_dots(points[a], points[b]))


def _dots(start: Array, end: Array) -> Array:
    """Points on the way from one point to another, three pixels apart."""
    steps = max(int(np.hypot(*(end - start)) / 3), 1)
    return start + (end - start) * np.arange(1, steps)[:, None] / steps


def _about_y(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([(c, 0, s), (0, 1, 0), (-s, 0, c)])


def _about_x(angle: float) -> Array:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([(1, 0, 0), (0, c, s), (0, -s, c)])
