"""Today's weather on three pages: now, the hours, the week."""

from __future__ import annotations

import math

from .. import Framebuffer, Supersample
from ..widgets import Bars, Chart, Number, Pages

STAY = 4.0
"""Seconds that a page stays, the half second included in which the next one comes."""

HOURS = [11.2, 10.6, 10.1, 11.8, 14.9, 17.6, 19.4, 20.8, 19.9, 17.2, 14.6, 12.9]
"""Degrees every second hour."""

WEEK = {"Mo": 21, "Tu": 19, "We": 23, "Th": 25, "Fr": 17, "Sa": 16, "Su": 20}


def draw(fb: Framebuffer, t: float) -> None:
    """Draw a page, or two while one gives way to the next."""
    fb.clear()
    fb.antialias = Supersample(4) if fb.depth > 1 else None
    page, stayed = divmod(t / STAY, 1)
    day = Chart(HOURS, xs=range(0, 24, 2), grid=True, fill=True)
    week = Bars(WEEK.values(), list(WEEK), low=10)
    Pages([lambda part: now(part, t), day, week], page + max(0.0, 8 * stayed - 7), dots=True).draw(fb)


def now(fb: Framebuffer, t: float) -> None:
    """Sun, cloud and rain, and beside them the temperature."""
    beside = fb.width >= 2 * fb.height
    size = min(fb.width, fb.height)
    sky(fb, size if beside else fb.width, size if beside or fb.height < 24 else fb.height // 2, t)
    x, y = (size, 0) if beside else (0, fb.height // 2)
    if fb.height >= 24 or beside:
        Number(19.4, "°C", "Bergen" if beside else "").draw(fb, x, y)


def sky(fb: Framebuffer, w: int, h: int, t: float) -> None:
    """A sun that turns behind a cloud, out of which it rains, within `w` x `h` pixels."""
    r = min(w, h) / 2
    x, y = w / 2, h / 2
    for ray in range(12):
        dx, dy = math.cos(ray * math.tau / 12 + t / 4), math.sin(ray * math.tau / 12 + t / 4)
        sun_x, sun_y = x + r / 4, y - r / 4
        fb.line(sun_x + 0.48 * r * dx, sun_y + 0.48 * r * dy, sun_x + 0.66 * r * dx, sun_y + 0.66 * r * dy)
    fb.circle(x + r / 4, y - r / 4, 0.36 * r, fill=True)
    for level, grown in ((0, max(r / 9, 1)), (None, 0)):
        for dx, dy, radius in ((-0.4, 0.25, 0.25), (-0.1, 0.05, 0.36), (0.3, 0.22, 0.28)):
            fb.circle(x + dx * r, y + dy * r, radius * r + grown, level, fill=True)
        fb.rect(x - 0.4 * r, y + 0.2 * r - grown, 0.7 * r, 0.3 * r + 2 * grown, level, fill=True)
    for drop in range(4):
        fall = (t * 1.5 + drop * 0.37) % 1
        left, top = x + (0.25 * drop - 0.45) * r, y + (0.6 + 0.3 * fall) * r
        fb.line(left, top, left - 0.05 * r, top + 0.12 * r)
