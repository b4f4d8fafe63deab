from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from paneldraw import Framebuffer, Panel, open_panel, simulator
from paneldraw.controllers import SSD1327
from paneldraw.transports import I2CTransport

SIZES = [(128, 128), (96, 96)]


def lit(controller):
    chip = simulator.SSD1327(controller.width, controller.height)
    return Panel(controller, I2CTransport(simulator.I2CBus({0x3C: chip}))), chip


def greys(size, seed=1):
    return np.random.default_rng(seed).integers(0, 16, size[::-1], np.uint8)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("mirror", [(False, False), (True, False), (False, True), (True, True)])
def test_every_glass_shows_the_picture_in_both_ways_to_fill(size, mirror):
    panel, chip = lit(SSD1327(*size, mirror_x=mirror[0], mirror_y=mirror[1]))
    picture = greys(size)
    for box in (slice(None), slice(8, 30)):
        picture[box, 10:20] ^= 5
        picture[40:70, 30] ^= 1
        picture[40:42, 31:34] ^= 1
        panel.show(picture)
        seen = chip.pixels[:, ::-1] if mirror[0] else chip.pixels
        np.testing.assert_array_equal(seen[::-1] if mirror[1] else seen, picture)
    assert chip.violations == []


@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
def test_a_panel_by_url_in_every_turn(rotate):
    with open_panel(f"sim://ssd1327?size=96x96&rotate={rotate}") as panel:
        chip = panel.simulated
        assert panel.framebuffer().depth == 4
        panel.show(greys((96, 96)))
        np.testing.assert_array_equal(chip.pixels, np.rot90(greys((96, 96)), -rotate // 90))


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
def test_framebuffers_of_every_depth(depth):
    panel, chip = lit(SSD1327())
    fb = Framebuffer(128, 128, depth)
    fb.pixels[:] = np.arange(128) * 2 % (fb.max_level + 1)
    panel.show(fb)
    np.testing.assert_array_equal(chip.pixels, np.rint(fb.pixels * (15 / fb.max_level)))


def test_pictures_of_every_kind():
    panel, chip = lit(SSD1327())
    picture = greys((128, 128))
    for source in (picture, picture.astype(np.int64), Image.fromarray(picture * 17)):
        panel.show(np.zeros((128, 128), np.uint8))
        panel.show(source)
        np.testing.assert_array_equal(chip.pixels, picture)
    with pytest.raises(ValueError, match="levels from 0 to 15"):
        panel.show(picture + 1)


def test_a_frame_longer_than_a_message_goes_out_in_two():
    panel, chip = lit(SSD1327())
    panel.show(np.zeros((128, 128), np.uint8))
    bus = panel.transport.bus
    before = bus.bytes, bus.messages
    report = panel.show(np.full((128, 128), 9, np.uint8))
    assert report[:3] == (bus.bytes - before[0], bus.messages - before[1], 8192)
    assert bus.messages - before[1] == 2
    assert (chip.pixels == 9).all()


def test_settings_reach_the_chip():
    panel, chip = lit(SSD1327())
    panel.show(greys((128, 128)))
    panel.contrast(9)
    panel.invert()
    assert chip.contrast == 9
    np.testing.assert_array_equal(chip.pixels, 15 - greys((128, 128)))
    panel.invert(False)
    np.testing.assert_array_equal(chip.pixels, greys((128, 128)))
    panel.sleep()
    assert not chip.pixels.any()
    assert chip.violations == []


@pytest.mark.parametrize("sent", ["FD", "15", "15 02", "B8", "B8 01 02 03", "A0", "26 00"])
def test_a_command_that_was_cut_off_is_made_up_for(sent):
    chip = simulator.SSD1327()
    chip.write(b"\x00" + bytes.fromhex(sent))
    panel = Panel(SSD1327(), I2CTransport(simulator.I2CBus({0x3C: chip})))
    panel.show(greys((128, 128)))
    np.testing.assert_array_equal(chip.pixels, greys((128, 128)))


def test_a_locked_chip_is_opened():
    chip = simulator.SSD1327()
    chip.write(bytes.fromhex("00 FD 16"))
    panel = Panel(SSD1327(), I2CTransport(simulator.I2CBus({0x3C: chip})))
    panel.show(greys((128, 128)))
    np.testing.assert_array_equal(chip.pixels, greys((128, 128)))


def test_a_size_that_no_module_has():
    with pytest.raises(
        ValueError, match="128x128, 96x96, 128x96 or 96x64, not 128x64; for another one give column_offset= too"
    ):
        SSD1327(128, 64)
