"""The panel chips, each a table of facts; called, one makes the record of a module."""

from __future__ import annotations

from typing import Final

from paneldraw.controllers.chip import Chip
from paneldraw.controllers.gray import SH1122, SSD1322, SSD1325, SSD1327, SSD1362
from paneldraw.controllers.lcd import PCD8544, ST7565, ST7567, ST7920, UC1609, UC1701
from paneldraw.controllers.led import HT16K33, IS31FL3731, MAX7219, Chain, Matrix
from paneldraw.controllers.oled import CH1115, SH1106, SH1107, SSD1305, SSD1306, SSD1309, SSD1312, SSD1315, SSD1316
from paneldraw.controllers.record import (
    BUSES,
    Contrast,
    Controller,
    Effect,
    PagePointer,
    Registers,
    Scroll,
    Window,
)

__all__ = [
    "BUSES",
    "CH1115",
    "CHIPS",
    "HT16K33",
    "IS31FL3731",
    "MAX7219",
    "PCD8544",
    "SH1106",
    "SH1107",
    "SH1122",
    "SSD1305",
    "SSD1306",
    "SSD1309",
    "SSD1312",
    "SSD1315",
    "SSD1316",
    "SSD1322",
    "SSD1325",
    "SSD1327",
    "SSD1362",
    "ST7565",
    "ST7567",
    "ST7920",
    "UC1609",
    "UC1701",
    "Chain",
    "Chip",
    "Contrast",
    "Controller",
    "Effect",
    "Matrix",
    "PagePointer",
    "Registers",
    "Scroll",
    "Window",
]

CHIPS: Final[dict[str, Chip | Matrix | Chain]] = {
    chip.name.lower(): chip
    for chip in (
        SSD1306,
        SSD1305,
        SSD1309,
        SSD1312,
        SSD1315,
        SSD1316,
        SH1106,
        SH1107,
        CH1115,
        SSD1322,
        SSD1325,
        SSD1327,
        SSD1362,
        SH1122,
        PCD8544,
        ST7565,
        ST7567,
        UC1701,
        UC1609,
        ST7920,
        MAX7219,
        HT16K33,
        IS31FL3731,
    )
}
"""Chips by the name that a panel's URL uses."""
