"""Aliased and anti-aliased lines side by side, under a magnifying glass.

Both halves draw the same two lines. On the left each pixel is on or off; on the right it is as bright as the share of
it that the line covers. A panel of one bit a pixel shows a shade as a dot that fills as much of the magnified pixel.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from .. import Framebuffer, Supersample

if TYPE_CHECKING:
    from numpy.typing import NDArray

PERIOD = 10.0
SHADES = 255


def draw(fb: Framebuffer, t: float) -> None:
    """Draw the two halves, each with its name above where there is room."""
    fb.clear()
    half = (fb.width - 1) // 2
    for name, antialias, left in (("aliased", None, 0), ("antialias", Supersample(4), fb.width - half)):
        top = 9 if fb.height >= 24 and half >= 53 else 0
        if top:
            fb.text(name, left + half // 2, 0, anchor="mt")
        scale = max(2, min(half // 20, (fb.height - top) // 8))
        glass = Framebuffer(half // scale, (fb.height - top) // scale, depth=8)
        _scissors(glass, t, antialias)
        picture = _magnify(glass.pixels, scale, fb.max_level)
        fb.pixels[top : top + picture.shape[0], left : left + picture.shape[1]] = picture


def _scissors(fb: Framebuffer, t: float, antialias: Supersample | None) -> None:
    """Two lines that cross in the middle and open and close as time goes by."""
    right, bottom = fb.width - 1, fb.height - 1
    swing = (1 - math.cos(2 * math.pi * t / PERIOD)) / 2
    fb.line(0, bottom * swing, right, bottom * (1 - swing), antialias=antialias)
    fb.line(right * swing, 0, right * (1 - swing), bottom, antialias=antialias)


def _magnify(shades: NDArray[np.uint8], scale: int, max_level: int) -> NDArray[np.uint8]:
    """Make each pixel a square of ``scale`` pixels: of its shade where the panel has shades, else a dot of its size."""
    blocks = shades.repeat(scale, axis=0).repeat(scale, axis=1)
    if max_level > 1:
        return np.rint(blocks * (max_level / SHADES)).astype(np.uint8)
    across, down = np.meshgrid(np.arange(scale), np.arange(scale))
    middle = (scale - 1) / 2
    growth = np.hypot(across - middle, down - middle).ravel().argsort(kind="stable").argsort().reshape(scale, scale)
    return (blocks > np.tile((growth + 0.5) * (SHADES / scale**2), shades.shape)).astype(np.uint8)
