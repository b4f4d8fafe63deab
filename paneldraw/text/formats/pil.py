"""Pillow's own bitmap fonts, of 256 characters in Latin-1."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from paneldraw.text.formats import standing_row
from paneldraw.text.strike import Picture, Strike

if TYPE_CHECKING:
    from PIL import ImageFont


def strike_of(font: ImageFont.ImageFont, name: str) -> Strike:
    """Return a font that Pillow has loaded; it says nothing of the baseline, so letters do that stand on it."""
    pictures = {}
    height = 0
    for code in range(256):
        mask = font.getmask(bytes((code,)), "1")
        width, height = mask.size[0], max(height, mask.size[1])
        if width and mask.size[1]:
            ink = np.frombuffer(bytes(mask), np.uint8).reshape(mask.size[1], width)
            pictures[code] = Picture(ink, 0, 0, width)
    ascent = standing_row(pictures, height - 1) + 1
    return Strike(name, ascent, height - ascent, pictures)
