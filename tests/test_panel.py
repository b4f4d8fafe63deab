from __future__ import annotations

import numpy as np
import pytest

from paneldraw.panel import open_panel


def simulated(query: str = ""):
    panel = open_panel(f"sim://ssd1306{query}")
    return panel, panel.transport.bus.devices[0x3C]


@pytest.mark.parametrize("size", [(128, 64), (128, 32), (96, 16), (72, 40), (64, 48), (64, 32)])
@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
def test_every_size_shows_every_picture_in_every_turn(size, rotate):
    panel, chip = simulated(f"?size={size[0]}x{size[1]}&rotate={rotate}")
    random = np.random.default_rng(rotate)
    for _ in range(3):
        picture = random.integers(0, 2, (panel.height, panel.width), np.uint8)
        panel.show(picture)
        np.testing.assert_array_equal(chip.pixels, np.rot90(picture, -rotate // 90))
    assert chip.violations == []


def test_a_frame_is_shown_on_leaving_and_only_then():
    panel, chip = simulated()
    with panel.frame() as fb:
        fb.line(0, 0, 127, 63)
        assert not chip.pixels.any()
    np.testing.assert_array_equal(chip.pixels, fb.pixels)


def test_a_block_that_raises_shows_nothing():
    panel, chip = simulated()
    panel.show(np.eye(64, 128, dtype=bool))
    wire = panel.transport.bus.bytes

    def fill_and_fail():
        with panel.frame() as fb:
            fb.fill(1)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fill_and_fail()
    assert panel.transport.bus.bytes == wire
    np.testing.assert_array_equal(chip.pixels, np.eye(64, 128))
