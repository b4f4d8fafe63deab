"""The demos on examples.md: their pictures, what they cost on the wire, and where their code is."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PIL import Image

from paneldraw import Framebuffer, open_panel, simulator
from paneldraw.demos import DEMOS, find

MOMENT = 10 * 3600 + 9 * 60 + 36.2
"""Seconds after midnight."""
RATE = 30
"""Frames a second, of those whose bytes are counted."""


def draw(name: str, frames: int = 30, scale: int = 3) -> list[Image.Image]:
    """Draw a demo as a panel of 128 x 64 pixels and 16 grays shows it, ten frames of each second."""
    pictures = []
    for number in range(frames):
        fb = Framebuffer(128, 64, depth=4)
        find(name)(fb, MOMENT + number / 10)
        pictures.append(simulator.image(fb.pixels, scale=scale, max_level=fb.max_level))
    return pictures


def pictures() -> dict[str, Callable[[], list[Image.Image]]]:
    """What draws each picture of the page, by its file name."""
    return {f"demos/{name}.gif": partial(draw, name) for name in DEMOS}


def wire_bytes(name: str, url: str) -> int:
    """How many bytes a frame costs on the wire, on average over a second."""
    with open_panel(url) as panel:
        fb = panel.framebuffer()
        sent = []
        for frame in range(RATE + 1):
            find(name)(fb, MOMENT + frame / RATE)
            sent.append(panel.show(fb).wire_bytes)
    return round(sum(sent[1:]) / RATE)


def table() -> str:
    """Return the table of the demos."""
    rows = ["| | | bytes a frame: 1 bit, 16 grays |", "|---|---|---|"]
    for name, about in DEMOS.items():
        costs = ", ".join(str(wire_bytes(name, url)) for url in ("sim://ssd1306", "sim://ssd1325"))
        code = f"[`{name}`](../paneldraw/demos/{name}.py)"
        rows.append(f"| ![{name}](demos/{name}.gif) | {code}: {about} | {costs} |")
    return "\n".join(rows)
