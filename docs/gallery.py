"""The pictures of gallery.md and widgets.md, drawn by the code that the pages show beside them.

The pages are the only place where that code stands. A row of a table is a picture: ``| ![caption](pictures/NAME.png) |
`code`<br>`more code` |``. The Python block above the table runs before each of its rows. On widgets.md code may depend
on `t`, the seconds since it began, and a third column says what a frame costs on the wire.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from paneldraw import Framebuffer, open_panel, simulator

PAGES = tuple(Path(__file__).with_name(name) for name in ("gallery.md", "widgets.md"))
MOMENT = 3.0
"""The `t` of the pictures."""
RATE = 30
"""Frames a second, of those whose bytes are counted."""

_PART = re.compile(
    r"^```python\n(?P<setup>(?s:.*?))^```$|^\| !\[(?P<caption>.*?)\]\((?P<name>.*?)\) \|(?P<row>.*)\|$", re.M
)


def entries() -> Iterator[tuple[str, str, str]]:
    """Yield the file name, the caption and the code of every picture on the pages."""
    for page in PAGES:
        for part, code in _rows(page.read_text(encoding="utf-8")):
            yield part["name"], part["caption"], code


def _rows(page: str) -> Iterator[tuple[re.Match[str], str]]:
    """Yield each row that is a picture, and all the code that draws it."""
    setup = ""
    for part in _PART.finditer(page):
        if part["name"] is None:
            setup = part["setup"]
        else:
            yield part, setup + "\n".join(re.findall(r"`(.*?)`", part["row"])) + "\n"


def counted(page: str) -> str:
    """Return a page with the bytes that a frame costs, where a row has a third column."""
    for part, code in _rows(page):
        if part["row"].count(" |"):
            row = f"{part['row'].rpartition(' |')[0]} | {wire_bytes(code)} "
            page = page.replace(part["row"], row)
    return page


def wire_bytes(code: str) -> int:
    """How many bytes a frame costs on the wire, on average over a second, on a panel as deep as the framebuffer."""
    fb = run(code)
    chip = "ssd1306" if fb.depth == 1 else "ssd1325"
    with open_panel(f"sim://{chip}?size={fb.width}x{fb.height}") as panel:
        panel.show(fb)
        sent = [panel.show(run(code, MOMENT + frame / RATE)).wire_bytes for frame in range(1, RATE + 1)]
    return round(sum(sent) / len(sent))


def pictures() -> dict[str, Callable[[], Image.Image | list[Image.Image]]]:
    """What draws each picture of the pages, by its file name: of a GIF two seconds, ten pictures of each."""
    drawn = {name: partial(draw, code, caption) for name, caption, code in entries()}
    return {name: partial(_moving, picture) if name.endswith(".gif") else picture for name, picture in drawn.items()}


def _moving(picture: Callable[..., Image.Image]) -> list[Image.Image]:
    return [picture(t=MOMENT - 0.5 + number / 10) for number in range(20)]


def run(code: str, t: float = MOMENT) -> Any:
    """Return the framebuffer `fb` that the code leaves behind."""
    names: dict[str, Any] = {"t": t}
    exec(code, names)
    return names["fb"]


def draw(code: str, caption: str, t: float = MOMENT) -> Image.Image:
    """Run an entry's code and show its framebuffer as a panel, with the caption below."""
    fb = run(code, t)
    panel = simulator.image(_shades(fb), scale=5 if fb.width <= 72 else 3, max_level=255)
    if 12 * len(caption) > panel.width:
        raise ValueError(f"the caption {caption!r} is wider than its picture")
    strip = Framebuffer(panel.width // 2 - 2, 8, depth=8)
    strip.text(caption, strip.width // 2, 0, 150, anchor="mt")
    below = np.asarray(simulator.image(strip.pixels, scale=2, max_level=255))
    levels = np.zeros((panel.height + below.shape[0], panel.width), np.uint8)
    levels[: panel.height] = panel
    # Around the panel nothing glows, not even a pixel that is off.
    levels[panel.height :, : below.shape[1]] = np.where(below == 1, 0, below)
    picture = Image.fromarray(levels)
    picture.putpalette(panel.getpalette() or [])
    return picture


def _shades(fb: Framebuffer) -> NDArray[np.uint8]:
    """Levels of any depth as 0 ... 255, so that all pictures have one palette."""
    return fb.pixels * np.uint8(255 // fb.max_level)
