"""A video player: pictures in motion, the time, and how far it is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from .. import Framebuffer
from ..widgets import ProgressBar

LENGTH = 60.0
"""Seconds."""


def picture(t: float) -> NDArray[np.uint8]:
    """One picture of the film, 160 x 90 grays: a planet turns and a moon goes round it. Yours may come from a file."""
    y, x = (np.mgrid[:90, :160] - np.array([45, 80])[:, None, None]) / 34
    within = x * x + y * y < 1
    z = np.sqrt(np.clip(1 - x * x - y * y, 0, 1))
    east = np.arctan2(x, z) + t / 3
    land = np.sin(3 * east + np.sin(4 * y)) + np.sin(5 * y - 2 * east) > 0.3
    light = np.clip(-0.6 * x - 0.4 * y + 0.7 * z, 0.04, 1)
    film = np.where(within, light * np.where(land, 255, 120), 0)
    moon_x, moon_z = 1.75 * np.sin(t), np.cos(t)
    moon = (x - moon_x) ** 2 + (y - 0.25 * moon_z) ** 2 < 0.04
    film[moon & ~(within & (moon_z < 0))] = 220
    stars = np.random.RandomState(1).rand(90, 160) > 0.997
    film[stars & ~within & ~moon] = 150
    return film.astype(np.uint8)


def draw(fb: Framebuffer, t: float) -> None:
    """Draw a picture so that it covers the panel, and the player's line over its foot."""
    t %= LENGTH
    film = Image.fromarray(picture(t))
    scale = max(fb.width / film.width, fb.height / film.height)
    w, h = round(film.width * scale), round(film.height * scale)
    fb.clear()
    fb.image(film.resize((w, h)), (fb.width - w) // 2, (fb.height - h) // 2, dither="bayer" if fb.depth < 4 else None)
    if fb.width < 64 or fb.height < 32:
        return
    with fb.clip(0, fb.height - 9, fb.width, 9):
        fb.clear()
    fb.poly(1, fb.height - 8, [0, 0, 0, 6, 5, 3], fill=True)
    ProgressBar(t / LENGTH).draw(fb, 10, fb.height - 8, fb.width - 38, 7)
    fb.text(f"0:{int(t):02}", fb.width - 1, fb.height - 8, anchor="rt")
