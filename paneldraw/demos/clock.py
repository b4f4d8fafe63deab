"""The time, with hands and in figures: circles, lines at any angle, text at an anchor."""

from __future__ import annotations

import math

from .. import Framebuffer, Supersample
from ..text import Font


def draw(fb: Framebuffer, t: float) -> None:
    """Draw a face as large as fits, and the figures where it leaves room.

    Parameters
    ----------
    fb : Framebuffer
        What to draw on.
    t : float
        Seconds after midnight.
    """
    fb.clear()
    radius = (min(fb.width, fb.height) - 1) // 2
    beside = fb.width - 2 * radius - 1
    time = f"{int(t // 3600) % 24:02}:{int(t // 60) % 60:02}"
    font = Font.builtin()
    if beside < font.measure(time)[0] + 2:
        _face(fb, (fb.width - 1) // 2, radius, radius, t)
        below = fb.height - 2 * radius - 1
        if below >= font.height and fb.width >= font.measure(time)[0]:
            fb.text(time, (fb.width - 1) // 2, fb.height - below // 2, anchor="mm")
        return
    _face(fb, radius, radius, radius, t)
    large = font.scaled(2)
    x, y = fb.width - 1 - (beside - 1) // 2, radius
    if beside < large.measure(time)[0] + 2 or fb.height < 32:
        fb.text(time, x, y, anchor="mm")
    else:
        fb.text(time, x, y, font=large, anchor="ms")
        fb.text(f"{int(t) % 60:02}", x, y + 4, anchor="mt")


def _face(fb: Framebuffer, x: int, y: int, radius: int, t: float) -> None:
    antialias = Supersample(4) if fb.depth > 1 else None

    def ray(turn: float, start: float, end: float, width: int = 1) -> None:
        """Draw along a direction, given in turns clockwise from twelve o'clock."""
        dx, dy = math.sin(2 * math.pi * turn), -math.cos(2 * math.pi * turn)
        fb.line(x + dx * start, y + dy * start, x + dx * end, y + dy * end, width=width, antialias=antialias)

    fb.circle(x, y, radius, antialias=antialias)
    for hour in range(12):
        ray(hour / 12, radius - radius // 8, radius)
    ray(t / 43200, 0, radius * 0.5, width=max(1, round(radius / 9)))
    ray(t / 3600, 0, radius * 0.78, width=max(1, round(radius / 16)))
    if radius >= 12:
        ray(int(t) / 60, -radius * 0.2, radius * 0.85)
