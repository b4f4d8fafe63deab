"""OLED chips, each as luma.oled means its module to be."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from paneldraw import controllers
from paneldraw.compat.luma.core.device import device
from paneldraw.compat.luma.core.interface.serial import Interface

__all__ = [
    "ch1115", "sh1106", "sh1107", "ssd1305", "ssd1306", "ssd1309", "ssd1315", "ssd1316",
    "ssd1322", "ssd1325", "ssd1327", "ssd1362",
]  # fmt: skip


class ssd1306(device):
    """SSD1306 of 128x64, 128x32, 96x16, 64x48, 64x32 pixels and the other sizes of `paneldraw.controllers`.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.core.interface.serial import i2c
    >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306(64, 48)})
    >>> device = ssd1306(i2c(bus=bus), width=64, height=48, rotate=1)
    >>> device.size, device.mode
    ((48, 64), '1')
    """

    chip = controllers.SSD1306
    glass = (128, 64)


class ssd1305(device):
    """SSD1305 of 128x32 or 128x64 pixels."""

    chip = controllers.SSD1305
    glass = (128, 32)

    def __init__(
        self,
        serial_interface: Interface | None = None,
        width: int = 128,
        height: int = 32,
        rotate: int = 0,
        **wiring: Any,
    ) -> None:
        if height == 64:
            wiring.setdefault("column_offset", 0)
        super().__init__(serial_interface, width, height, rotate, **wiring)


class ssd1309(device):
    """SSD1309 of 128x64 pixels."""

    chip = controllers.SSD1309
    glass = (128, 64)


class ssd1315(device):
    """SSD1315 of the sizes of the SSD1306."""

    chip = controllers.SSD1315
    glass = (128, 64)


class ssd1316(device):
    """SSD1316 of 128x32 pixels."""

    chip = controllers.SSD1316
    glass = (128, 32)
    wiring: ClassVar[Mapping[str, Any]] = {"com_pins": 0x02, "mirror_y": True}


class sh1106(device):
    """SH1106 of 128x64 or 128x32 pixels; `page_address_offset` is the RAM column where the glass begins."""

    chip = controllers.SH1106
    glass = (128, 64)

    def __init__(
        self,
        serial_interface: Interface | None = None,
        width: int = 128,
        height: int = 64,
        rotate: int = 0,
        page_address_offset: int | None = None,
        **wiring: Any,
    ) -> None:
        if page_address_offset is not None:
            wiring["column_offset"] = page_address_offset
        super().__init__(serial_interface, width, height, rotate, **wiring)


class sh1107(device):
    """SH1107 of 64x128, 80x128 or 128x128 pixels."""

    chip = controllers.SH1107
    glass = (64, 128)


class ch1115(device):
    """CH1115 of 128x64 pixels."""

    chip = controllers.CH1115
    glass = (128, 64)
    wiring: ClassVar[Mapping[str, Any]] = {"column_offset": 2}


class _gray(device):
    """A chip of 16 grays."""

    modes = ("RGB", "1")


class ssd1322(_gray):
    """SSD1322 of 256x64 pixels and smaller, 16 grays."""

    chip = controllers.SSD1322
    glass = (256, 64)


class ssd1325(_gray):
    """SSD1325 of 128x64 pixels, 16 grays."""

    chip = controllers.SSD1325
    glass = (128, 64)
    contrast_shift = 1


class ssd1327(_gray):
    """SSD1327 of 128x128 pixels, 16 grays."""

    chip = controllers.SSD1327
    glass = (128, 128)


class ssd1362(_gray):
    """SSD1362 of 256x64 pixels, 16 grays."""

    chip = controllers.SSD1362
    glass = (256, 64)
