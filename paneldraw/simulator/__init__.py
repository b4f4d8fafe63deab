"""Byte-level panels, buses and recorders: the whole path with no hardware."""

from .bus import I2CBus
from .frames import Frame
from .recorder import Look, contact_sheet, image, save
from .ssd1306 import SSD1306
from .terminal import TerminalView, text

__all__ = ["SSD1306", "Frame", "I2CBus", "Look", "TerminalView", "contact_sheet", "image", "save", "text"]
