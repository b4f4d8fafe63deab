"""Byte-level panels, buses and recorders: the whole path with no hardware."""

from .bus import I2CBus
from .frames import Frame
from .ssd1306 import SSD1306

__all__ = ["SSD1306", "Frame", "I2CBus"]
