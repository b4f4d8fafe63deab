"""Adafruit's face: scripts written for ``adafruit_ssd1306`` run with ``from paneldraw.compat.adafruit import ...``.

The calls draw the same pixels as those of ``adafruit_framebuf``; `show` sends what changed.
"""

from __future__ import annotations

from paneldraw.compat.adafruit.displays import SH1106_I2C, SH1106_SPI, SSD1306_I2C, SSD1306_SPI

__all__ = ["SH1106_I2C", "SH1106_SPI", "SSD1306_I2C", "SSD1306_SPI"]
