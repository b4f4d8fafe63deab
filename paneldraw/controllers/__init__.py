"""The panel chips: one module a chip family, each a record of facts."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final

from paneldraw.controllers.record import Controller, PagePointer, Window
from paneldraw.controllers.sh1106 import SH1106
from paneldraw.controllers.ssd1306 import SSD1306
from paneldraw.controllers.ssd1322 import SSD1322
from paneldraw.controllers.ssd1327 import SSD1327

__all__ = ["CHIPS", "SH1106", "SSD1306", "SSD1322", "SSD1327", "Controller", "PagePointer", "Window"]

CHIPS: Final[dict[str, Callable[..., Controller]]] = {
    "ssd1306": SSD1306,
    "sh1106": SH1106,
    "ssd1322": SSD1322,
    "ssd1327": SSD1327,
}
"""Chips by the name that a panel's URL uses; each makes a record, of a width and a height in pixels if given."""
