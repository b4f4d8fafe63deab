"""Views and recordings of panels in greys: what an eye sees, and not the sub-pictures."""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from PIL import Image

from paneldraw import Panel, open_panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.simulator.averaged import Averaged
from paneldraw.simulator.views import Sight
from paneldraw.transports import I2CTransport


def bars(panel: Panel) -> np.ndarray:
    """Four bars, one of each level, 2 pixels wide."""
    levels = np.zeros((panel.height, panel.width), np.uint8)
    levels[:, 40:48] = np.repeat(np.arange(4), 2)
    return levels


def test_a_sight_shows_greys_and_not_the_sub_pictures() -> None:
    chip = simulator.SSD1306(history=None)
    averaged = Averaged(chip)
    sight = Sight(averaged)
    with Panel(SSD1306(), I2CTransport(simulator.I2CBus({0x3C: chip})), greys=4) as panel:
        panel.show(bars(panel))
        time.sleep(0.5)
        assert sight.glance()
        assert sight.max_level == 15
        np.testing.assert_allclose(sight.picture[:, 40:48].mean(axis=0), 5.0 * np.repeat(np.arange(4), 2), atol=1.0)
        assert not sight.picture[:, :40].any()
        assert 1 <= len(averaged.frames) < len(chip.frames) / 3


def test_before_a_scan_is_over_it_is_the_picture() -> None:
    averaged = Averaged(simulator.SSD1306())
    assert not averaged.pixels.any()
    assert averaged.history == averaged._chip.history


def test_a_recording_holds_greys(tmp_path: Path) -> None:
    with open_panel(f"sim://ssd1306?greys=4&save={tmp_path}/greys.png&look=white") as panel:
        panel.show(bars(panel))
        time.sleep(0.5)
    with Image.open(tmp_path / "greys.png") as picture:
        lights = np.asarray(picture.convert("L"))[130, 4 + 40 * 4 + 5 :: 8][:4]
    assert lights[0] < lights[1] < lights[2] < lights[3]
