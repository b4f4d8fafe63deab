"""A spectrum analyzer: bars that jump with music, under caps that fall more slowly."""

from __future__ import annotations

import math

from .. import Framebuffer
from ..widgets import Bars

BEAT = 0.5
"""Seconds from beat to beat."""


def heard(band: float, t: float) -> float:
    """How loud a band is, 0 ... 1, in music that is made up: low bands on the beat, high ones in between."""
    beat, since = divmod(t / BEAT * (1 + round(3 * band)), 1)
    accent = 0.55 + 0.45 * math.sin(7.1 * beat + 11 * band)
    return accent * (1 - 0.4 * band) * (0.2 + 0.8 * math.exp(-2.5 * since))


def draw(fb: Framebuffer, t: float) -> None:
    """Draw a bar for every eight columns, and mirror it dimly below where the panel has grays and room."""
    fb.clear()
    count = max(fb.width // 8, 4)
    bands = [band / count for band in range(count)]
    levels = [max(heard(band, t), 0.04) for band in bands]
    # A cap falls from the highest that was heard in the last second.
    caps = [max(max(heard(band, t - ago / 20) - ago / 40, 0.06) for ago in range(20)) for band in bands]
    floor = fb.height * 3 // 4 if fb.depth > 1 and fb.height >= 48 else fb.height
    Bars(levels, low=0, high=1, caps=caps).draw(fb, 0, 0, fb.width, floor)
    if floor < fb.height:
        mirrored = fb.pixels[floor - 1 - 2 * (fb.height - floor) : floor - 1 : 2][::-1]
        fb.image(mirrored * (255 // fb.max_level) // 3, 0, floor + 1)
