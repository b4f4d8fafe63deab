"""The panel chips, each a table of facts; called, one makes the record of a module."""

from __future__ import annotations

from typing import Final

from paneldraw.controllers.chip import Chip
from paneldraw.controllers.gray import SSD1322, SSD1327
from paneldraw.controllers.lcd import PCD8544, ST7565, ST7567, ST7920, UC1609, UC1701
from paneldraw.controllers.oled import SH1106, SSD1306, SSD1309
from paneldraw.controllers.record import BUSES, Contrast, Controller, PagePointer, Window

__all__ = [
    "BUSES",
    "CHIPS",
    "PCD8544",
    "SH1106",
    "SSD1306",
    "SSD1309",
    "SSD1322",
    "SSD1327",
    "ST7565",
    "ST7567",
    "ST7920",
    "UC1609",
    "UC1701",
    "Chip",
    "Contrast",
    "Controller",
    "PagePointer",
    "Window",
]

CHIPS: Final[dict[str, Chip]] = {
    chip.name.lower(): chip
    for chip in (
        SSD1306,
        SSD1309,
        SH1106,
        SSD1322,
        SSD1327,
        PCD8544,
        ST7565,
        ST7567,
        UC1701,
        UC1609,
        ST7920,
    )
}
"""Chips by the name that a panel's URL uses."""
