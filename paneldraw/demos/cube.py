"""A turning cube whose far edges are dotted: three-dimensional points, two rotations, a perspective, twelve lines."""

from __future__ import annotations

import math

import numpy as np

from .. import Framebuffer, Supersample

CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
EDGES = [(a, b) for a in range(8) for b in range(a) if np.abs(CORNERS[a] - CORNERS[b]).sum() == 2]
EYE = 5.0
PERIOD = 10.0


def draw(fb: Framebuffer, t: float) -> None:
    """Draw the cube as large as fits; it turns once in ten seconds and nods as it goes."""
    fb.clear()
    turn = 2 * math.pi * t / PERIOD
    corners = CORNERS @ _about_y(turn) @ _about_x(0.45 + 0.25 * math.sin(turn))
    flat = corners[:, :2] / (1 - corners[:, 2:] / EYE)
    size = min(fb.width, fb.height)
    points = flat * size * 0.265 + ((fb.width - 1) / 2, (fb.height - 1) / 2)
    hidden = corners[:, 2].argmin()
    antialias = Supersample(4) if fb.depth > 1 else None
    for a, b in EDGES:
        if hidden in (a, b):
            _dotted(fb, *points[a], *points[b])
        else:
            fb.line(*points[a], *points[b], antialias=antialias)


def _dotted(fb: Framebuffer, x1: float, y1: float, x2: float, y2: float) -> None:
    """Draw a pixel every third one along the way."""
    steps = int(math.hypot(x2 - x1, y2 - y1) / 3)
    for step in range(1, steps):
        fb.pixel(round(x1 + (x2 - x1) * step / steps), round(y1 + (y2 - y1) * step / steps), fb.max_level)


def _about_y(angle: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([(c, 0, s), (0, 1, 0), (-s, 0, c)])


def _about_x(angle: float) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    c, s = math.cos(angle), math.sin(angle)
    return np.array([(1, 0, 0), (0, c, s), (0, -s, c)])
