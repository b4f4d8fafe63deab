"""Aliased and anti-aliased lines side by side, under a magnifying glass.

Both halves draw the same turning cross. On the left, a pixel is on or off. On the right, it is as bright as the share
of it that the line covers; a panel of one bit a pixel shows that as a pattern of as many dots.
"""

from __future__ import annotations

import math

from .. import Framebuffer, Supersample

PERIOD = 20.0
"""Seconds a turn."""


def draw(fb: Framebuffer, t: float) -> None:
    """Draw the two halves, each with its name above where there is room."""
    fb.clear()
    half = (fb.width - 1) // 2
    for name, antialias, left in (("aliased", None, 0), ("antialias", Supersample(4), fb.width - half)):
        top = 9 if fb.height >= 24 and half >= 53 else 0
        if top:
            fb.text(name, left + half // 2, 0, anchor="mt")
        scale = max(2, min(half // 20, (fb.height - top) // 8))
        glass = Framebuffer(half // scale, (fb.height - top) // scale, depth=8, antialias=antialias)
        cross(glass, t)
        magnified = glass.pixels.repeat(scale, axis=0).repeat(scale, axis=1)
        fb.image(magnified, left, top, dither="bayer" if fb.depth == 1 else None)


def cross(fb: Framebuffer, t: float) -> None:
    """Draw two lines at right angles that turn about the middle and reach beyond the edges."""
    x, y = (fb.width - 1) / 2, (fb.height - 1) / 2
    turn = 2 * math.pi * t / PERIOD
    dx, dy = fb.width * math.cos(turn), fb.width * math.sin(turn)
    fb.line(x - dx, y - dy, x + dx, y + dy)
    fb.line(x + dy, y - dx, x - dy, y + dx)
