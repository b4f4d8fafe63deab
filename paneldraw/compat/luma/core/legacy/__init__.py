"""Text in fonts of columns of eight pixels, for LED matrices."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from PIL import ImageDraw

from paneldraw.compat.luma.core.legacy.font import Columns, default_font
from paneldraw.compat.luma.core.mixin import capabilities
from paneldraw.compat.luma.core.render import canvas
from paneldraw.compat.luma.core.sprite_system import framerate_regulator
from paneldraw.compat.luma.core.virtual import viewport

__all__ = ["show_message", "text", "textsize"]


def _columns(txt: str, font: Columns | None) -> Iterator[int]:
    """Yield a byte a column, the upper pixel in the lowest bit."""
    font = font or default_font()
    for character in txt:
        yield from font[ord(character)]


def textsize(txt: str, font: Columns | None = None) -> tuple[int, int]:
    """Return the width and height of a text.

    Examples
    --------
    >>> font = [[0xFF, 0x81, 0]] * 128
    >>> textsize("abc", font)
    (9, 8)
    """
    return len(list(_columns(txt, font))), 8


def text(
    draw: ImageDraw.ImageDraw, xy: tuple[int, int], txt: str, fill: Any = None, font: Columns | None = None
) -> None:
    """Draw a text, with its upper left corner at a place.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> from paneldraw.compat.luma.core.render import canvas
    >>> font = [[0xFF, 0x81, 0]] * 128
    >>> device = dummy(32, 8, mode="1")
    >>> with canvas(device) as draw:
    ...     text(draw, (1, 0), "ab", fill="white", font=font)
    >>> device.image.getbbox()
    (1, 0, 6, 8)
    """
    x, y = xy
    lit = [
        (x + column, y + row)
        for column, pixels in enumerate(_columns(txt, font))
        for row in range(8)
        if pixels >> row & 1
    ]
    draw.point(lit, fill=fill)


def show_message(
    device: capabilities,
    msg: str,
    y_offset: int = 0,
    fill: Any = None,
    font: Columns | None = None,
    scroll_delay: float = 0.03,
) -> None:
    """Let a message run through a device from right to left, a pixel every `scroll_delay` seconds.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> show_message(dummy(32, 8), "Hello", fill="white", scroll_delay=0)
    """
    beat = framerate_regulator(1 / scroll_delay if scroll_delay else 0)
    width = textsize(msg, font)[0] + device.width
    device.clear()
    strip = viewport(device, width + device.width, device.height)
    with canvas(strip) as draw:
        text(draw, (device.width, y_offset), msg, fill, font)
    for x in range(width + 1):
        with beat:
            strip.set_position((x, 0))
