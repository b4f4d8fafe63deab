"""The pictures of gallery.md, drawn by the code that the page shows beside them.

The page is the only place where that code stands. A row of a table is a picture: ``| ![caption](pictures/NAME.png) |
`code`<br>`more code` |``. The Python block above the table runs before each of its rows.
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

from paneldraw import Framebuffer, simulator

PAGE = Path(__file__).with_name("gallery.md")
SCALE = 5

_PART = re.compile(
    r"^```python\n(?P<setup>(?s:.*?))^```$|^\| !\[(?P<caption>.*?)\]\((?P<name>.*?)\) \|(?P<row>.*)\|$", re.M
)


def entries() -> Iterator[tuple[str, str, str]]:
    """Yield the file name, the caption and the code of every picture on the page."""
    setup = ""
    for part in _PART.finditer(PAGE.read_text(encoding="utf-8")):
        if part["name"] is None:
            setup = part["setup"]
        else:
            yield part["name"], part["caption"], setup + "\n".join(re.findall(r"`(.*?)`", part["row"])) + "\n"


def pictures() -> dict[str, Callable[[], Image.Image]]:
    """What draws each picture of the page, by its file name."""
    return {name: partial(draw, code, caption) for name, caption, code in entries()}


def run(code: str) -> Any:
    """Return the framebuffer `fb` that the code leaves behind."""
    names: dict[str, Any] = {}
    exec(code, names)
    return names["fb"]


def draw(code: str, caption: str) -> Image.Image:
    """Run an entry's code and show its framebuffer as a panel, with the caption below."""
    fb = run(code)
    panel = simulator.image(_shades(fb), scale=SCALE, max_level=255)
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
