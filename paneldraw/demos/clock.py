"""The time, with hands and in figures: circles, lines at any angle, text at an anchor."""

from __future__ import annotations

import math

from .. import Framebuffer, Supersample


def draw(fb: Framebuffer, t: float) -> None:
    """Draw a face as large as fits; beside or below it the figures, where there is room.

    Parameters
    ----------
    fb : Framebuffer
        What to draw on.
    t : float
        Seconds after midnight.
    """
    fb.clear()
    size = min(fb.width, fb.height)
    beside, below = fb.width - size, fb.height - size
    hours, minutes, seconds = int(t // 3600) % 24, int(t // 60) % 60, int(t) % 60
    if beside >= 47:
        _face(fb, (size - 1) // 2, (size - 1) // 2, (size - 1) // 2, t)
        fb.text(f"{hours:02}:{minutes:02}:{seconds:02}", size + (beside - 1) // 2, size // 2, anchor="mm")
    elif beside >= 30:
        _face(fb, (size - 1) // 2, (size - 1) // 2, (size - 1) // 2, t)
        fb.text(f"{hours:02}:{minutes:02}", size + (beside - 1) // 2, size // 2, anchor="mm")
    else:
        _face(fb, (fb.width - 1) // 2, (size - 1) // 2, (size - 1) // 2, t)
        if below >= 9 and fb.width >= 47:
            fb.text(f"{hours:02}:{minutes:02}:{seconds:02}", fb.width // 2, size + below // 2, anchor="mm")


def _face(fb: Framebuffer, x: int, y: int, radius: int, t: float) -> None:
    antialias = Supersample(4) if fb.depth > 1 else None
    fb.circle(x, y, radius)
    for hour in range(12):
        _ray(fb, x, y, hour / 12, radius - max(1, radius // 8), radius, antialias=antialias)
    _ray(fb, x, y, t / 43200, 0, radius * 0.5, width=max(1, radius // 8), antialias=antialias)
    _ray(fb, x, y, t / 3600, 0, radius * 0.78, width=max(1, radius // 16), antialias=antialias)
    if radius >= 12:
        _ray(fb, x, y, int(t) / 60, -radius * 0.15, radius * 0.85, antialias=antialias)


def _ray(
    fb: Framebuffer,
    x: int,
    y: int,
    turn: float,
    start: float,
    end: float,
    *,
    width: int = 1,
    antialias: Supersample | None = None,
) -> None:
    """Draw along a direction, given in turns clockwise from twelve o'clock."""
    dx, dy = math.sin(2 * math.pi * turn), -math.cos(2 * math.pi * turn)
    fb.line(x + dx * start, y + dy * start, x + dx * end, y + dy * end, width=width, antialias=antialias)
