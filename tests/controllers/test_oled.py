"""Every OLED chip, of every size and both ways round on each axis, on its simulated twin over each of its buses."""

from __future__ import annotations

import math

import numpy as np
import pytest

from paneldraw import ConeFilter, Panel, Supersample, open_panel, simulator
from paneldraw.controllers import (
    CH1115,
    CHIPS,
    SH1106,
    SH1107,
    SH1122,
    SSD1305,
    SSD1306,
    SSD1309,
    SSD1312,
    SSD1316,
    SSD1322,
    SSD1325,
    SSD1327,
    SSD1362,
)
from paneldraw.transports import I2CTransport, SPITransport

OLEDS = {chip.name: chip for chip in CHIPS.values() if chip.about.startswith("OLED")}
MODULES = [(name, size) for name, chip in OLEDS.items() for size in chip.sizes]
REFERENCE = "reference current of the SSD1315"
"""Part of the remark on AD 30, which 72x40 modules of the SSD1306 need and its sheet does not have."""


def lit(name, size, bus="", *, updates="least", **wiring):
    chip = getattr(simulator, name)(*size, **{key: wiring[key] for key in wiring if not key.startswith("mirror")})
    controller = OLEDS[name](*size, **wiring)
    if (bus or controller.buses[0]) == "i2c":
        return Panel(controller, I2CTransport(simulator.I2CBus({0x3C: chip})), updates=updates), chip
    wire = simulator.SPIBus(chip)
    return Panel(controller, SPITransport(spi=wire.spi, pins=wire.pins), updates=updates), chip


def pictures(panel, count=4):
    """A picture of noise, and others that differ from the one before in a box and a few pixels."""
    random = np.random.default_rng(1)
    height, width, levels = panel.height, panel.width, 2**panel.depth
    picture = random.integers(0, levels, (height, width), np.uint8)
    for _ in range(count):
        yield picture
        picture = picture.copy()
        picture[random.integers(0, height, 5), random.integers(0, width, 5)] ^= 1
        picture[height // 3 : height // 2, width // 4 : width // 2] = random.integers(levels)


ALWAYS = ("least", *(pytest.param(each, marks=pytest.mark.thorough) for each in ("plain", "whole")))


@pytest.mark.parametrize("updates", ALWAYS)
@pytest.mark.parametrize("mirror_y", [False, True])
@pytest.mark.parametrize("mirror_x", [False, True])
@pytest.mark.parametrize(("name", "size"), MODULES)
def test_every_glass_shows_the_pictures(name, size, mirror_x, mirror_y, updates):
    for bus in OLEDS[name].buses:
        panel, chip = lit(name, size, bus, updates=updates, mirror_x=mirror_x, mirror_y=mirror_y)
        for picture in pictures(panel):
            panel.show(picture)
            seen = chip.pixels[:: -1 if mirror_y else 1, :: -1 if mirror_x else 1]
            np.testing.assert_array_equal(seen, picture)
        assert chip.violations == []
        assert [remark for remark in chip.remarks if REFERENCE not in remark] == []


@pytest.mark.parametrize(("name", "size"), MODULES)
def test_settings_reach_the_chip(name, size):
    panel, chip = lit(name, size)
    (picture,) = pictures(panel, 1)
    highest = 2**panel.depth - 1
    panel.show(picture)
    panel.contrast(255)
    assert chip.contrast == OLEDS[name].contrast.highest
    panel.invert()
    np.testing.assert_array_equal(chip.pixels, highest - picture)
    panel.invert(False)
    panel.sleep()
    assert not chip.pixels.any()
    panel.wake()
    np.testing.assert_array_equal(chip.pixels, picture)
    chip.power_cycle()
    panel.show(picture, force=True)
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


@pytest.mark.parametrize("name", OLEDS)
def test_dim_goes_below_contrast_0_and_comes_back(name):
    panel, chip = lit(name, OLEDS[name].sizes[0])
    (picture,) = pictures(panel, 1)
    panel.show(picture)
    bright = dict(vars(chip.registers))
    panel.dim(0)
    assert chip.contrast == 0
    assert {key for key, value in vars(chip.registers).items() if value != bright[key]} > {"contrast"}
    panel.dim(255)
    assert {key for key, value in vars(chip.registers).items() if value != bright[key]} <= {"contrast"}
    assert set(panel.controller.drive[0]) <= set(panel.controller.init)
    np.testing.assert_array_equal(chip.pixels, picture)
    assert (chip.violations, chip.remarks) == ([], [])


@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
@pytest.mark.parametrize("name", OLEDS)
def test_a_simulated_panel_by_url_in_every_turn(name, rotate):
    with open_panel(f"sim://{name.lower()}?rotate={rotate}") as panel:
        (picture,) = pictures(panel, 1)
        panel.show(picture)
        np.testing.assert_array_equal(np.rot90(panel.simulated.pixels, rotate // 90), picture)


# -- The light of levels


GRAYS = [name for name, chip in OLEDS.items() if chip.depth == 4]


def seen(name, *, picture, **how):
    """What an eye sees of a picture, in shares of full light."""
    panel, chip = lit(name, OLEDS[name].sizes[0])
    chip.remembers = True
    with panel:
        panel.contrast(255)
        panel.show(picture(panel), **how)
        panel.transport.bus.idle(0.3) if hasattr(panel.transport, "bus") else chip.timeline.wait(0.3)
        return chip.seen(0.1)


@pytest.mark.parametrize("name", GRAYS)
def test_light_rises_in_even_steps(name):
    panel, chip = lit(name, OLEDS[name].sizes[0])
    pulses = panel.controller.pulses
    shares = chip._shares
    assert shares == pytest.approx(np.arange(16) / 15)
    assert name == "SH1122" or np.array(pulses) / pulses[-1] == pytest.approx(shares)
    assert chip.violations == []


@pytest.mark.parametrize("name", GRAYS)
def test_half_covered_is_half_the_light(name):
    def covered(panel):
        fb = panel.framebuffer()
        fb.rect(8.5, 8, 16, 16, fill=True, antialias=Supersample(4))
        return fb

    light = seen(name, picture=covered)
    assert light[12, 9:24] == pytest.approx(1)
    assert light[12, [8, 24]] == pytest.approx(0.5, abs=1 / 30)
    assert light[12, [7, 25]] == pytest.approx(0)


@pytest.mark.parametrize("name", GRAYS)
def test_a_picture_is_as_light_as_its_file_says(name):
    grays = np.arange(0, 256, 2, dtype=np.uint8)

    def ramp(panel):
        fb = panel.framebuffer(8)
        fb.pixels[:, :] = 0
        fb.pixels[:, : grays.size][:] = grays[: panel.width]
        return fb

    light = seen(name, picture=ramp, gamma=2.2)[0, : grays.size]
    assert np.abs(light - (grays / 255) ** 2.2).max() <= 1 / 30 + 1e-9


@pytest.mark.parametrize("width", [1, 2])
def test_a_line_is_as_bright_at_every_angle(width):
    light = []
    for degrees in range(0, 180, 15):
        across, down = 25 * math.cos(math.radians(degrees)), 25 * math.sin(math.radians(degrees))

        def spoke(panel, across=across, down=down):
            fb = panel.framebuffer(8)
            fb.line(64 - across, 64 - down, 64 + across, 64 + down, width=width, antialias=ConeFilter())
            return fb

        light.append(seen("SSD1327", picture=spoke, dither="blue-noise").sum())
    assert np.abs(np.array(light) / np.mean(light) - 1).max() <= 0.03


WIRINGS = [
    ("SSD1306", (64, 32), {"first_com": 16}),
    ("SSD1306", (128, 32), {"first_com": 32}),
    ("SSD1306", (100, 39), {"column_offset": 20, "com_pins": 0x22, "first_com": 5}),
    ("SSD1309", (128, 64), {"column_offset": 2}),
    ("SSD1309", (102, 64), {"column_offset": 13, "com_pins": 0x12}),
    ("SSD1305", (128, 64), {"column_offset": 0}),
    ("SSD1305", (128, 64), {"column_offset": 4}),
    ("SSD1312", (96, 32), {"column_offset": 4, "com_pins": 0x12, "first_com": 3}),
    ("SSD1316", (128, 32), {"com_pins": 0x02}),
    ("SH1106", (64, 48), {"column_offset": 34, "com_pins": 0x12, "first_com": 8}),
    ("SH1107", (128, 128), {"column_offset": 96}),
    ("SH1107", (96, 96), {"column_offset": 0}),
    ("CH1115", (128, 64), {"column_offset": 2}),
    ("CH1115", (128, 32), {"column_offset": 0, "first_com": 16}),
    ("SSD1322", (256, 64), {"column_offset": 96}),
    ("SSD1322", (256, 64), {"column_offset": 128}),
    ("SSD1325", (128, 64), {"first_com": 0}),
    ("SSD1327", (128, 64), {"column_offset": 0, "first_com": 64}),
    ("SSD1362", (200, 40), {"column_offset": 20, "first_com": 7}),
    ("SH1122", (128, 32), {"column_offset": 64, "first_com": 16}),
]


@pytest.mark.parametrize(("name", "size", "wiring"), WIRINGS)
@pytest.mark.parametrize("mirrors", ["", "&mirror_x=1", "&mirror_y=1", "&mirror_x=1&mirror_y=1"])
def test_modules_that_are_wired_in_other_ways(name, size, wiring, mirrors):
    given = "".join(f"&{key}={value}" for key, value in wiring.items())
    with open_panel(f"sim://{name.lower()}?size={size[0]}x{size[1]}{given}{mirrors}") as panel:
        chip = panel.simulated
        for picture in pictures(panel):
            panel.show(picture)
            down, across = (-1 if f"mirror_{axis}" in mirrors else 1 for axis in "yx")
            np.testing.assert_array_equal(chip.pixels[::down, ::across], picture)
        assert chip.violations == []


def commands(controller):
    return [command.hex() for command in controller.init]


def test_what_brings_the_ram_to_glass_that_begins_elsewhere():
    """Offsets against those of public drivers, upright and turned."""
    assert "d330" in commands(SSD1312(128, 32))
    assert "d310" in commands(SSD1312(128, 32, mirror_y=True))
    assert "d310" in commands(SH1106(128, 32))
    assert {"d30c", "c8"} <= set(commands(SH1106(72, 40)))
    assert {"d334", "c0"} <= set(commands(SH1106(72, 40, mirror_y=True)))
    assert [SH1107(width, 128).init[7].hex() for width in (64, 80, 128)] == ["d360", "d368", "d300"]
    assert {"a24c", "a052"} <= set(commands(SSD1325()))
    assert {"a244", "a041"} <= set(commands(SSD1325(mirror_x=True, mirror_y=True)))
    assert "a240" in commands(SSD1325(first_com=0))
    assert {"a220", "a051"} <= set(commands(SSD1327(96, 96)))
    assert {"a260", "a042"} <= set(commands(SSD1327(96, 96, mirror_x=True, mirror_y=True)))
    assert "a232" in commands(SSD1362(206, 36))
    assert {"40", "a0", "c0"} <= set(commands(SH1122()))
    assert {"60", "a1", "c8"} <= set(commands(SH1122(mirror_x=True, mirror_y=True)))
    assert "a03601" in commands(SSD1322(240, 128))


def test_turned_columns_count_from_the_other_end():
    assert SSD1305(128, 32, mirror_x=True).column_offset == 0
    assert SSD1309(column_offset=2, mirror_x=True).column_offset == 132 - 128 - 2
    assert CH1115(column_offset=2).ram_width == 132
    assert CH1115().ram_width == 128
    assert SSD1362(206, 36, mirror_x=True).column_offset == 2 * 25
    assert SH1107(96, 96, column_offset=0, mirror_y=True).row_offset == 32


def test_supplies():
    assert "ad8a" in commands(CH1115(charge_pump=False))
    assert "8d15" in commands(SSD1316())
    assert "8d10" in commands(SSD1316(charge_pump=False))
    assert "ad8e" in commands(SSD1305())
    assert "ad8e" in commands(SSD1362(internal_reference=False))
    assert "ad80" in commands(SH1122(charge_pump=False))


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda: SSD1316(128, 40), "1x1 to 128x39"),
        (lambda: SSD1309(column_offset=5), "column_offset must be 0 to 4, not 5"),
        (lambda: SH1107(column_offset=128), "column_offset must be 0 to 127"),
        (lambda: SH1107(64, 128, com_pins=2), "com_pins must not be given for the SH1107"),
        (lambda: SH1107(64, 100, mirror_y=True, column_offset=0), "row_offset 28 must be a multiple of 8"),
        (lambda: SSD1325(128, 96), "1x1 to 128x80"),
        (lambda: SSD1325(column_offset=1), "column_offset must be 0 to 0"),
        (lambda: SSD1362(206, 36, column_offset=3), "multiples of 2"),
        (lambda: SSD1306(first_com=64), "first_com must be 0 to 63"),
    ],
)
def test_what_cannot_be(make, complaint):
    with pytest.raises(ValueError, match=complaint):
        make()


FIGURES = [
    # chip, size, bus, most bytes for one pixel, most for a whole picture
    ("SSD1327", (128, 128), "i2c", 11, 8202),
    ("SSD1325", (128, 64), "i2c", 11, 4106),
    ("SSD1362", (256, 64), "i2c", 11, 8202),
    ("SH1106", (128, 64), "i2c", 8, 8 * 135),
    ("SH1107", (128, 128), "i2c", 8, 16 * 135),
    ("SH1122", (256, 64), "i2c", 9, 64 * 136),
    ("SSD1322", (256, 64), "spi", 9, 8199),
]


@pytest.mark.parametrize(("name", "size", "bus", "pixel", "whole"), FIGURES)
def test_how_many_bytes_a_picture_takes(name, size, bus, pixel, whole):
    panel, chip = lit(name, size, bus)
    first, second = np.random.default_rng(1).integers(0, 2**panel.depth, (2, *size[::-1]), np.uint8)
    panel.show(first)
    assert panel.show(second).wire_bytes <= whole
    for y, x in ((60, 100), (10, 50), (33, 3)):
        second[y, x] ^= 1
        assert panel.show(second).wire_bytes <= pixel
        np.testing.assert_array_equal(chip.pixels, second)
