"""Draws what characters the built-in fonts have, one picture a font, and names them.

``python docs/make_pictures.py``
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from PIL import Image

from paneldraw import Font, Framebuffer, simulator
from paneldraw.text.builtin import strike

COLUMNS, SCALE, GAP = 32, 2, 2

FONTS = ("6x8", "8x8")

#: First and last code points of what stands together; Braille has its 256 patterns by rule and is left out.
BLOCKS = ((0x20, 0x7E), (0xA0, 0x17F), (0x218, 0x21B), (0x370, 0x3FF), (0x400, 0x491), (0x2010, 0x22FF),
          (0x2300, 0x24FF), (0x2500, 0x259F), (0x25A0, 0x27FF), (0x1F300, 0x1FAFF))  # fmt: skip


def lines(name: str) -> list[str]:
    """The characters of a font, as many in a line as the picture has columns."""
    pictures = strike(name).pictures
    found: list[str] = []
    for first, last in BLOCKS:
        chars = "".join(chr(code) for code in range(first, last + 1) if code in pictures)
        found += [chars[start : start + COLUMNS] for start in range(0, len(chars), COLUMNS)]
    return found


def draw(name: str) -> Image.Image:
    """Show a font on a simulated panel."""
    font, rows = Font.builtin(name), lines(name)
    fb = Framebuffer(COLUMNS * font.advance + 2 * GAP, len(rows) * (font.height + GAP) + GAP)
    for row, text in enumerate(rows):
        fb.text(text, GAP, GAP + row * (font.height + GAP), font=font)
    return simulator.image(fb.pixels, scale=SCALE)


def pictures() -> dict[str, Callable[[], Image.Image]]:
    """What draws each picture, by its file name."""
    return {f"fonts/{name}.png": partial(draw, name) for name in FONTS}
