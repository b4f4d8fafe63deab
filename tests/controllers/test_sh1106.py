from __future__ import annotations

import numpy as np
import pytest

from paneldraw import Panel, open_panel, simulator
from paneldraw.controllers import SH1106
from paneldraw.transports import I2CTransport


def lit(controller, **options):
    chip = simulator.SH1106(**options)
    return Panel(controller, I2CTransport(simulator.I2CBus({0x3C: chip}))), chip


@pytest.mark.parametrize("offset", [0, 2, 4])
@pytest.mark.parametrize("mirror", [(False, False), (True, False), (False, True), (True, True)])
def test_every_glass_shows_the_picture(offset, mirror):
    panel, chip = lit(SH1106(column_offset=offset, mirror_x=mirror[0], mirror_y=mirror[1]), column_offset=offset)
    picture = np.random.default_rng(1).integers(0, 2, (64, 128), np.uint8)
    panel.show(picture)
    seen = chip.pixels[:, ::-1] if mirror[0] else chip.pixels
    np.testing.assert_array_equal(seen[::-1] if mirror[1] else seen, picture)
    assert chip.violations == []


def test_the_page_pointer_is_the_only_way():
    with open_panel("sim://sh1106") as panel:
        chip = panel.simulated
        picture = np.random.default_rng(2).integers(0, 2, (64, 128), np.uint8)
        panel.show(picture)
        picture[20, 77] ^= 1
        assert panel.show(picture)[:3] == (8, 2, 1)
        np.testing.assert_array_equal(chip.pixels, picture)
        assert chip.violations == []


def test_settings_reach_the_chip():
    panel, chip = lit(SH1106())
    picture = np.random.default_rng(3).integers(0, 2, (64, 128), np.uint8)
    panel.show(picture)
    panel.contrast(9)
    panel.invert()
    assert chip.contrast == 9
    np.testing.assert_array_equal(chip.pixels, 1 - picture)
    panel.sleep()
    assert not chip.pixels.any()
    assert chip.violations == []


def test_sizes_and_offsets_that_no_module_has():
    with pytest.raises(ValueError, match="128x64, 128x32, 72x40 or 64x32, not 64x48"):
        SH1106(64, 48)
    with pytest.raises(ValueError, match="column_offset must be 0 to 4"):
        SH1106(column_offset=5)
