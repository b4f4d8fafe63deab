"""The picture of greys.md: one drawing on a panel of one bit, four ways, as an eye sees it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from paneldraw import Framebuffer, Panel, Supersample, simulator
from paneldraw.controllers import SSD1306
from paneldraw.framebuffer import pictures
from paneldraw.transports import I2CTransport

SCALE = 3
WIDTH, HEIGHT = 128, 64


def drawing(depth: int, antialias: Supersample | None) -> Framebuffer:
    """Draw the marks of a clock, a thick hand and a disc."""
    fb = Framebuffer(WIDTH, HEIGHT, depth)
    fb.antialias = antialias
    for number in range(6):
        turn = 2 * math.pi * (number / 6 + 0.03)
        x, y = math.cos(turn), math.sin(turn)
        fb.line(32 + 24 * x, 32 + 24 * y, 32 + 29 * x, 32 + 29 * y)
    fb.line(32, 32, 47, 19, width=3)
    fb.circle(96, 32, 12, fill=True)
    return fb


def seen(picture: Framebuffer, greys: int) -> NDArray[np.float64]:
    """Return the light of the pixels over 0.4 seconds on a bus of 400 kHz, from 0 to 1."""
    chip = simulator.SSD1306(history=1)
    chip.remembers = True
    bus = simulator.I2CBus({0x3C: chip}, timer=None)
    with Panel(SSD1306(), I2CTransport(bus), contrast=255, greys=greys) as panel:
        cycling = panel._cycling
        if cycling is None:
            panel.show(picture)
            bus.idle(0.5)
            return chip.seen(0.4)
        choice, still = cycling.choose(picture.pixels, picture.max_level)
        if choice is None:
            raise ValueError("picture must be one that the wire carries in greys")
        cycling.begin(choice, still)
        for lasts in choice.seconds * round(0.6 * choice.rate):
            busy = bus.seconds
            cycling.turn()
            bus.idle(max(0.0, lasts - (bus.seconds - busy)))
        return chip.seen(0.4)


def ways() -> dict[str, NDArray[np.float64]]:
    """The drawing as lines come, as the nearest of black and white, dithered, and in four greys."""
    smooth = drawing(8, Supersample(4)).pixels
    reduced: dict[str, NDArray[np.uint8]] = {
        name: pictures.quantize(smooth, 1, dither) for name, dither in (("nearest", None), ("dithered", "blue-noise"))
    }
    shown = {"aliased": seen(drawing(1, None), 1)}
    for name, levels in reduced.items():
        fb = Framebuffer(WIDTH, HEIGHT)
        fb.pixels[:] = levels
        shown[name] = seen(fb, 1)
    return {**shown, "4 greys": seen(drawing(2, Supersample(4)), 4)}


def sheet() -> Image.Image:
    """Put the four ways beside and below each other, in the order of `ways`."""
    tiles = [
        simulator.image(np.round(255 * light).astype(np.uint8), scale=SCALE, max_level=255) for light in ways().values()
    ]
    width, height = tiles[0].width + 8, tiles[0].height + 8
    picture = Image.new("RGB", (2 * width - 8, 2 * height - 8), "white")
    for number, tile in enumerate(tiles):
        picture.paste(tile, (number % 2 * width, number // 2 * height))
    return picture


PICTURES: dict[str, Callable[[], Image.Image]] = {"greys.png": sheet}
