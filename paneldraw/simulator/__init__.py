"""Byte-level panels, buses and recorders: the whole path with no hardware."""

from __future__ import annotations

from typing import TYPE_CHECKING

from paneldraw._later import importer

from .bus import I2CBus, Multiplexer
from .frames import Frame
from .ht16k33 import HT16K33
from .is31fl3731 import IS31FL3731
from .lcd import PCD8544, ST7565, ST7567, UC1609, UC1701
from .log import Log
from .looks import LOOKS, Look, find_look, image
from .max7219 import MAX7219
from .recorder import contact_sheet, save
from .sh110x import CH1115, SH1106, SH1107, SH1122
from .spi import SPIBus
from .ssd130x import SSD1305, SSD1306, SSD1309, SSD1312, SSD1315, SSD1316
from .ssd132x import SSD1322, SSD1325, SSD1327, SSD1362
from .st7920 import ST7920
from .terminal import TerminalView, text
from .transcript import Transcript
from .views import open_view

if TYPE_CHECKING:
    from .player import Replayed, replay
    from .port import SerialPort
    from .preload import Preload, PreloadUnavailableError
    from .rig import Rig, RigPanel, simulated_bus, simulated_chip
    from .web import serve

__all__ = [
    "CH1115",
    "HT16K33",
    "IS31FL3731",
    "LOOKS",
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
    "Frame",
    "I2CBus",
    "Log",
    "Look",
    "Multiplexer",
    "Preload",
    "PreloadUnavailableError",
    "Replayed",
    "Rig",
    "RigPanel",
    "SPIBus",
    "SerialPort",
    "TerminalView",
    "Transcript",
    "contact_sheet",
    "find_look",
    "image",
    "open_view",
    "replay",
    "save",
    "serve",
    "simulated_bus",
    "simulated_chip",
    "text",
]


#: Names that are imported only where somebody asks for them, with what they need: asyncio, zipfile, subprocess.
_LATER = {
    name: module
    for module, names in {
        "web": ("serve",),
        "player": ("Replayed", "replay"),
        "port": ("SerialPort",),
        "preload": ("Preload", "PreloadUnavailableError"),
        "rig": ("Rig", "RigPanel", "simulated_bus", "simulated_chip"),
    }.items()
    for name in names
}

if not TYPE_CHECKING:
    __getattr__ = importer(__name__, _LATER)
