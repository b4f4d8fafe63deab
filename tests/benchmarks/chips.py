"""Bytes on the wire of one changed pixel and of a whole picture, of every chip."""

from __future__ import annotations

from typing import Any

import numpy as np
import peers

from paneldraw import Panel, open_panel, simulator
from paneldraw.controllers import CHIPS

#: Most bytes that one changed pixel may take, by the panel's URL; of a MAX7219 there are none fewer.
PIXEL = {"max7219?size=64x8": 16, "ht16k33": 3, "is31fl3731": 3, "sh1106": 8, "ssd1327": 11}


def run(rounds: int) -> None:
    """Print the table."""
    names = [url.partition("?")[0] for url in PIXEL]
    for url in (*PIXEL, *(name for name in CHIPS if name not in names)):
        with open_panel(f"sim://{url}") as panel:
            one, whole = sizes(panel)
            wanted = f"   (wanted at most {PIXEL[url]})" if url in PIXEL else ""
            print(f"  {url:<20}{one:6} bytes; of a whole picture {whole:6}{wanted}", flush=True)
    if (theirs := luma()) is not None:
        print(f"  luma, max7219 64x8{theirs:7} bytes; it sends all always")


def noise(panel: Panel, seed: int) -> Any:
    """A picture of the panel's size and depth."""
    shape = panel.height, panel.width
    return np.random.default_rng(seed).integers(0, 2**panel.depth, shape, np.uint8)


def sizes(panel: Panel) -> tuple[int, int]:
    """Bytes on the wire of a changed pixel after a whole picture, and of one more whole picture."""
    picture = noise(panel, 1)
    panel.show(picture)
    picture[panel.height // 2, panel.width // 2] ^= 1
    return panel.show(picture).wire_bytes, panel.show(noise(panel, 2)).wire_bytes


def luma() -> int | None:
    """Bytes that luma.led_matrix sends for a changed pixel of eight MAX7219s; None where it is not at hand."""
    bus = simulator.SPIBus(simulator.MAX7219(64, 8), dc=None, reset=None)
    device = peers.luma_led(bus.spi)
    if device is None:
        return None
    from PIL import Image

    picture = Image.new("1", (64, 8))
    device.display(picture)
    picture.putpixel((20, 3), 1)
    before = bus.bytes
    device.display(picture)
    return bus.bytes - before
