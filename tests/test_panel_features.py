"""What some chips do by themselves: scroll, blink, fade, light every pixel."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import Panel, open_panel
from paneldraw.controllers import CHIPS
from paneldraw.transports import I2CTransport


def started(url="sim://ssd1306", rotate=0):
    """A panel that shows a random picture, its chip, and the commands that it is sent from now on."""
    panel = open_panel(url)
    panel.rotate = rotate
    picture = np.random.default_rng(1).integers(0, 2**panel.depth, (panel.height, panel.width), np.uint8)
    panel.show(picture)
    sent = []
    command = panel.transport.command
    panel.transport.command = lambda payload: sent.append(payload.hex(" ").upper()) or command(payload)
    return panel, panel.simulated, picture, sent


def steps(panel, count, frames):
    """Let the chip take so many steps of so many frames."""
    panel.transport.bus.idle((count + 0.5) * frames * panel.simulated.frame_seconds)


# -- The bytes of the datasheets


@pytest.mark.parametrize(
    ("chip", "call", "expected"),
    [
        ("ssd1306", {}, "27 00 00 00 07 00 FF 2F"),
        ("ssd1306", {"dx": 1, "frames": 70, "rows": (16, 32)}, "26 00 02 01 03 00 FF 2F"),
        ("ssd1306", {"dx": 1, "dy": -1, "frames": 1}, "A3 00 40 29 00 00 07 07 01 2F"),
        ("ssd1306", {"dx": -1, "dy": 3, "frames": 9999, "rows": (8, 40)}, "A3 08 20 2A 00 01 03 04 1D 2F"),
        ("ssd1306?size=128x32", {"frames": 24}, "27 00 00 06 03 00 FF 2F"),
        ("ssd1309", {"frames": 1, "columns": (8, 121)}, "27 00 00 07 07 00 08 78 2F"),
        ("ssd1309", {"dx": 0, "dy": -2, "frames": 2, "rows": (3, 60)}, "A3 03 39 29 00 00 04 07 02 00 7F 2F"),
        ("ssd1309", {"dx": -1, "rows": (16, 48), "columns": (8, 121), "once": True}, "2D 00 02 01 05 00 08 78"),
        ("ssd1315", {"dx": -1, "rows": (16, 48), "columns": (8, 121), "once": True}, "2D 00 02 01 05 08 78"),
        ("ssd1315", {"frames": 6, "columns": (8, 121)}, "27 00 00 00 07 08 78 2F"),
        ("ssd1315", {"dx": 1, "dy": -1, "frames": 5}, "A3 00 40 29 01 00 06 07 01 00 7F 2F"),
        ("ssd1316", {"dx": 0, "dy": 1, "frames": 40}, "A3 00 20 29 00 00 01 03 1F 00 7F 2F"),
        ("ssd1305", {"frames": 6}, "27 01 00 00 07 2F"),
        ("ssd1305", {"dx": 0, "dy": -1, "rows": (1, 9), "frames": 30}, "A3 01 08 29 00 00 01 01 01 2F"),
        ("ssd1327", {"dx": 1, "frames": 5, "rows": (5, 99), "columns": (2, 64)}, "26 00 05 06 62 01 1F 00 2F"),
    ],
)
def test_bytes_of_a_scroll(chip, call, expected):
    panel, chip, _, sent = started(f"sim://{chip}")
    panel.scroll(**call)
    assert sent[-1] == expected
    assert chip.violations == []


# -- Scrolling, as the eye sees it


@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
@pytest.mark.parametrize(("dx", "dy"), [(1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 2), (2, -1)])
def test_a_step_moves_the_picture_as_asked_whichever_way_it_is_turned(rotate, dx, dy):
    panel, chip, picture, _ = started("sim://ssd1309", rotate)
    if abs((dx, dy)[rotate // 90 % 2]) > 1:
        with pytest.raises(ValueError, match="a step across the glass must be of one column"):
            panel.scroll(dx, dy)
        return
    panel.scroll(dx, dy, frames=3)
    steps(panel, 5, 3)
    upright = np.rot90(chip.pixels, rotate // 90)
    np.testing.assert_array_equal(upright, np.roll(picture, (5 * dy, 5 * dx), axis=(0, 1)))
    assert len(chip.frames) >= 5
    assert chip.violations == []


def test_rows_and_columns_that_are_not_chosen_stand_still():
    panel, chip, picture, _ = started("sim://ssd1309", rotate=180)
    panel.scroll(1, rows=(8, 24), columns=(10, 100))
    steps(panel, 3, 5)
    picture[8:24, 10:100] = np.roll(picture[8:24, 10:100], 3, axis=1)
    np.testing.assert_array_equal(chip.pixels[::-1, ::-1], picture)


def test_grays_move_by_two_pixels():
    panel, chip, picture, _ = started("sim://ssd1327?size=96x96")
    panel.scroll(-1, frames=4, rows=(10, 90))
    steps(panel, 5, 4)
    picture[10:90] = np.roll(picture[10:90], -10, axis=1)
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


@pytest.mark.parametrize(("chip", "frames"), [("ssd1305", 6), ("ssd1306", 5), ("ssd1315", 5), ("ssd1316", 5)])
def test_every_chip_that_scrolls_keeps_its_picture_whole(chip, frames):
    panel, chip, picture, _ = started(f"sim://{chip}")
    panel.scroll(1, -1)
    steps(panel, 200, frames)
    wide = np.zeros((panel.height, chip.segments), np.uint8)
    left = panel.controller.column_offset
    wide[:, left : left + panel.width] = picture
    np.testing.assert_array_equal(chip.pixels, np.roll(wide, (-200, 200), axis=(0, 1))[:, left : left + panel.width])
    panel.show(picture)
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_beside_a_narrower_glass_the_ram_is_blank():
    panel, chip, picture, _ = started("sim://ssd1306?size=64x48")
    panel.scroll(1, frames=2)
    steps(panel, 70, 2)
    wide = np.zeros((48, 128), np.uint8)
    wide[:, 32:96] = picture
    np.testing.assert_array_equal(chip.pixels, np.roll(wide, 70, axis=1)[:, 32:96])
    assert chip.violations == []


def test_a_picture_ends_the_scroll_and_is_sent_whole():
    panel, chip, picture, sent = started()
    panel.scroll()
    steps(panel, 7, 5)
    report = panel.show(picture)
    assert sent[-1] == "2E"
    assert report.changed_bytes == 1024
    np.testing.assert_array_equal(chip.pixels, picture)
    picture[3, 3] ^= 1
    assert panel.show(picture).changed_bytes == 1
    panel.transport.bus.idle(1)
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_another_scroll_begins_with_the_picture_as_it_was():
    panel, chip, picture, _ = started()
    panel.scroll(1)
    steps(panel, 9, 5)
    panel.scroll(-1)
    steps(panel, 2, 5)
    np.testing.assert_array_equal(chip.pixels, np.roll(picture, -2, axis=1))
    assert chip.violations == []


def test_a_scroll_that_is_stopped_leaves_the_picture_where_it_is():
    panel, chip, picture, sent = started()
    panel.stop_scroll()
    assert sent == []
    panel.scroll(1)
    steps(panel, 4, 5)
    panel.stop_scroll()
    panel.transport.bus.idle(1)
    np.testing.assert_array_equal(chip.pixels, np.roll(picture, 4, axis=1))
    assert panel.show(picture).changed_bytes == 1024
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_a_setting_while_it_scrolls_leaves_it_scrolling():
    panel, chip, picture, _ = started()
    panel.scroll(1)
    steps(panel, 1, 5)
    panel.contrast(9)
    steps(panel, 2, 5)
    assert chip.contrast == 9
    np.testing.assert_array_equal(chip.pixels, np.roll(picture, 4, axis=1))  # 1½ steps and 2½


@pytest.mark.parametrize(("dx", "columns"), [(-1, None), (1, (8, 120))])
def test_after_single_steps_only_what_came_in_is_sent(dx, columns):
    panel, chip, picture, _ = started("sim://ssd1309")
    ticker = panel.framebuffer()
    ticker.pixels[:] = picture
    left, right = columns or (0, 128)
    for _ in range(3):
        panel.scroll(dx, columns=columns, once=True)
        ticker.pixels[:, left:right] = np.roll(ticker.pixels[:, left:right], dx, axis=1)
        ticker.pixels[:, left if dx > 0 else right - 1] = 1
        report = panel.show(ticker)
        assert report.wire_bytes <= 20
        np.testing.assert_array_equal(chip.pixels, ticker.pixels)
    for _ in range(2):
        panel.scroll(dx, columns=columns, once=True)
    assert panel.show(ticker).changed_bytes > 8
    np.testing.assert_array_equal(chip.pixels, ticker.pixels)
    assert chip.violations == []


@pytest.mark.parametrize("chip", ["ssd1305", "ssd1306", "ssd1309", "ssd1315", "ssd1316", "ssd1327"])
def test_a_chip_that_was_left_scrolling_takes_a_new_scripts_picture(chip):
    panel, chip, picture, _ = started(f"sim://{chip}")
    panel.scroll()
    steps(panel, 3, 5)
    with Panel(panel.controller, I2CTransport(panel.transport.bus)) as another:
        another.show(picture)
        panel.transport.bus.idle(1)
        np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_a_recovery_ends_a_scroll():
    panel, chip, picture, _ = started()
    panel.scroll()
    steps(panel, 3, 5)
    chip.power_cycle()
    panel.invalidate()
    panel.contrast(5)
    panel.transport.bus.idle(1)
    np.testing.assert_array_equal(chip.pixels, picture)


@pytest.mark.parametrize(
    ("chip", "call", "complaint"),
    [
        ("sh1106", {}, "the SH1106 cannot scroll by itself; SSD1306, .*SSD1309.*, SSD1327 can"),
        ("ssd1306", {"dx": 0, "dy": 1}, "the SSD1306 cannot scroll up or down alone, without left or right; .*SSD1309"),
        ("ssd1306", {"columns": (0, 64)}, "the SSD1306 cannot scroll some columns and keep others; .*SSD1309"),
        ("ssd1306", {"once": True}, "the SSD1306 cannot scroll by a single column; .*SSD1309"),
        ("ssd1327", {"dy": 1}, "the SSD1327 cannot scroll up or down; SSD1306"),
        ("ssd1306", {"dx": 0}, "dx and dy must not both be 0"),
        ("ssd1306", {"dx": 2}, "must be of one column, to the left or to the right, not of 2"),
        ("ssd1306", {"dy": 64}, "dy must be less than the 64 rows that scroll, not 64"),
        ("ssd1306", {"frames": 0}, "frames must be above 0, not 0"),
        ("ssd1306", {"rows": (4, 12)}, "must be whole pages of 8, not 4 to 12"),
        ("ssd1306", {"rows": (8, 65)}, "rows must be a first one and the one behind the last, 0 to 64, not"),
        ("ssd1309", {"columns": (9, 9)}, "columns must be a first one and the one behind the last, 0 to 128, not"),
        ("ssd1309", {"dy": 1, "once": True}, "dy must be 0 where once is True, not 1"),
        ("ssd1327", {"columns": (1, 5)}, "columns that scroll must be multiples of 2, not 1 to 5"),
    ],
)
def test_a_scroll_that_cannot_be(chip, call, complaint):
    panel, _, _, sent = started(f"sim://{chip}")
    with pytest.raises(ValueError, match=complaint):
        panel.scroll(**call)
    assert sent == []


def test_stop_scroll_of_a_chip_that_never_scrolls():
    with pytest.raises(ValueError, match="the SH1106 cannot scroll by itself"):
        open_panel("sim://sh1106").stop_scroll()


# -- Light


@pytest.mark.parametrize("chip", [name for name, chip in CHIPS.items() if chip().all_on])
def test_all_on_lights_every_pixel_until_it_ends(chip):
    panel = open_panel(f"sim://{chip}")
    chip = panel.simulated
    picture = np.random.default_rng(1).integers(0, chip.max_level + 1, (panel.height, panel.width), np.uint8)
    panel.show(picture)
    panel.all_on()
    panel.invert()
    assert (chip.pixels == chip.max_level).all()
    chip.power_cycle()
    panel.show(picture, force=True)
    assert (chip.pixels == chip.max_level).all()
    panel.all_on(False)
    np.testing.assert_array_equal(chip.pixels, chip.max_level - picture)
    panel.invert(False)
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_blinking_and_fading_last_through_a_recovery():
    panel, chip, picture, sent = started("sim://ssd1315")
    panel.blink()
    assert sent[-1] == "23 30"
    panel.blink(0.5)
    assert sent[-1] == "23 37"
    chip.power_cycle()
    panel.show(picture, force=True)
    assert chip.registers.fade == 0x37
    panel.fade(0)
    assert chip.registers.fade == 0x2F
    panel.fade(None)
    panel.show(picture, force=True)
    assert chip.registers.fade == 0x00
    assert chip.violations == []


def test_an_led_chip_blinks_from_its_first_light_on_and_through_sleep():
    panel = open_panel("sim://ht16k33")
    chip, lit = panel.simulated, np.ones((8, 16), np.uint8)
    panel.blink(0)
    assert (chip.registers.on, chip.registers.blink) == (False, 0)
    panel.show(lit)
    assert (chip.registers.on, chip.registers.blink) == (True, 3)
    panel.sleep()
    panel.blink()
    assert not chip.registers.on
    panel.wake()
    assert (chip.registers.on, chip.registers.blink) == (True, 1)
    chip.power_cycle()
    panel.show(lit, force=True)
    assert (chip.registers.on, chip.registers.blink) == (True, 1)
    panel.blink(None)
    assert (chip.registers.on, chip.registers.blink) == (True, 0)
    panel.show(lit, force=True)
    assert (chip.registers.on, chip.registers.blink) == (True, 0)
    assert chip.violations == []


def test_an_effect_that_the_chip_has_not_and_a_speed_that_is_none():
    for effect in ("blink", "fade"):
        with pytest.raises(ValueError, match=f"the SH1106 cannot {effect} by itself; "):
            getattr(open_panel("sim://sh1106"), effect)()
    panel = open_panel("sim://ht16k33")
    with pytest.raises(ValueError, match=r"speed must be 0 to 1, not 1\.5"):
        panel.blink(1.5)
