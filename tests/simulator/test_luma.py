"""luma.oled's drivers and ours, over I2C and SPI, on simulated modules of every chip that both have: equal pictures."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import smbus2
from PIL import Image

from paneldraw import Panel, controllers, simulator
from paneldraw.transports import I2CTransport, SPITransport

# Wiring where luma.oled means another module than ours: its SSD1305 of 128x64 begins at column 0, its CH1115 at 2; its
# SSD1316 is an SSD1306's glass.
SIZES = [(128, 64), (128, 32), (96, 16), (64, 48), (64, 32)]
MODULES: list[tuple[str, tuple[int, int], dict[str, int]]] = [
    *(("SSD1306", size, {}) for size in SIZES),
    *(("SSD1315", size, {}) for size in SIZES),
    ("SSD1305", (128, 64), {"column_offset": 0}),
    ("SSD1305", (128, 32), {}),
    ("SSD1309", (128, 64), {}),
    ("SSD1316", (128, 32), {"com_pins": 0x02}),
    ("SH1106", (128, 64), {}),
    ("SH1106", (128, 32), {}),
    *(("SH1107", (width, 128), {}) for width in (64, 80, 128)),
    ("CH1115", (128, 64), {"column_offset": 2}),
    *(("SSD1322", (width, height), {}) for width in (256, 128, 64) for height in (64, 48, 32)),
    ("SSD1325", (128, 64), {}),
    ("SSD1327", (128, 128), {}),
    ("SSD1362", (256, 64), {}),
]
UPSIDE_DOWN = {"SSD1316": {"mirror_y": True}}
TOO_LONG = {"SSD1325"}
"""Chips to which luma.oled sends more commands at once than its own I2C takes."""
WRONG = {"SSD1327": "a grey table rises from step to step"}
"""It gives this chip half a grey table, for which the chip takes the commands behind it; the picture arrives."""


class Bench:
    """A simulated module on a bus of either kind, as luma.oled and as our transport see it."""

    def __init__(self, chip: Any, kind: str) -> None:
        self.kind, self.chip = kind, chip
        self.bus: Any = simulator.SPIBus(chip) if kind == "spi" else simulator.I2CBus({0x3C: chip})

    def luma(self) -> Any:
        from luma.core.interface.serial import i2c, spi

        return i2c(port=1) if self.kind == "i2c" else spi(spi=self.bus.spi, gpio=self.bus.gpio)

    def ours(self) -> I2CTransport | SPITransport:
        return I2CTransport(self.bus) if self.kind == "i2c" else SPITransport(spi=self.bus.spi, pins=self.bus.pins)


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("kind", ["i2c", "spi"])
@pytest.mark.parametrize(("name", "size", "wiring"), MODULES)
def test_both_show_the_same(
    name: str, size: tuple[int, int], wiring: dict[str, int], kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    from luma.oled import device as devices

    if kind not in getattr(simulator, name).buses or (kind == "i2c" and name in TOO_LONG):
        pytest.skip(f"luma.oled does not have the {name} on {kind}")
    theirs, ours = (Bench(getattr(simulator, name)(*size, **wiring), kind) for _ in range(2))
    monkeypatch.setattr(smbus2, "SMBus", lambda port: theirs.bus)
    device = getattr(devices, name.lower())(theirs.luma(), *size)
    device.persist = True
    panel = Panel(getattr(controllers, name)(*size, **wiring, **UPSIDE_DOWN.get(name, {})), ours.ours())
    random, highest = np.random.default_rng(1), theirs.chip.max_level
    picture = random.integers(0, highest + 1, size[::-1], np.uint8)
    for _ in range(3):
        device.display(Image.fromarray(picture * (255 // highest)).convert(device.mode))
        panel.show(picture)
        assert np.array_equal(ours.chip.pixels, theirs.chip.pixels)
        assert np.array_equal(ours.chip.pixels, picture[::-1] if name in UPSIDE_DOWN else picture)
        picture[random.integers(0, size[1], 20), random.integers(0, size[0], 20)] ^= 1
    device.contrast(0x21)
    assert theirs.chip.contrast == 0x21
    device.hide()
    assert not theirs.chip.pixels.any()
    assert ours.chip.violations == []
    if name in WRONG:
        assert WRONG[name] in theirs.chip.violations[0]
    else:
        assert theirs.chip.violations == []
