"""Byte-level panels, buses and recorders: the whole path with no hardware."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .bus import I2CBus
from .frames import Frame
from .recorder import Look, contact_sheet, image, save
from .sh1106 import SH1106
from .ssd1306 import SSD1306
from .ssd1327 import SSD1327
from .terminal import TerminalView, text

if TYPE_CHECKING:
    from .web import serve

__all__ = [
    "SH1106",
    "SSD1306",
    "SSD1327",
    "Frame",
    "I2CBus",
    "Look",
    "TerminalView",
    "contact_sheet",
    "image",
    "save",
    "serve",
    "text",
]


def __getattr__(name: str) -> object:
    """Import the web page, and asyncio with it, only where somebody asks for it."""
    if name == "serve":
        from .web import serve

        return serve
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
