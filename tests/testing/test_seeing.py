"""What is looked at, as text and in bytes, and what a failure says of it."""

from __future__ import annotations

import re

import numpy as np
import pytest

from paneldraw import Framebuffer, Panel, open_panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.testing import SimPanel, assert_bytes, assert_pattern, chip_of, frames_of
from paneldraw.transports import I2CTransport, SPITransport


def text_of(failing, *arguments, **options):
    with pytest.raises(AssertionError) as caught:
        failing(*arguments, **options)
    return str(caught.value).split("\n")


def fb_of(rows, depth=1):
    levels = np.array([[int(level, 16) for level in row] for row in rows.split()], np.uint8)
    fb = Framebuffer(levels.shape[1], levels.shape[0], depth)
    fb.pixels[:] = levels
    return fb


def test_a_pattern_of_grays():
    fb = fb_of("0f0 1a2", depth=4)
    assert_pattern(fb, ".f.\n1a2")
    assert text_of(assert_pattern, fb, ".f.\n1b2") == [
        "the picture differs",
        "1 of 6 pixels, x 1, y 1",
        "wanted    drawn     differs",
        ".f.       .f.       ...",
        "1b2       1a2       .^.",
    ]


@pytest.mark.parametrize(
    ("pattern", "marks"), [("#.", ["..^"]), ("#.#\n...", ["...", "^^^"]), ("", ["^^^"])], ids=["narrow", "high", "none"]
)
def test_a_pattern_of_another_size(pattern, marks):
    lines = text_of(assert_pattern, fb_of("101"), pattern)
    assert [line.split()[-1] for line in lines[3:]] == marks


def test_a_part_of_a_picture():
    fb = Framebuffer(128, 64)
    fb.rect(100, 50, 4, 3, 1)
    assert_pattern(fb, "####\n#..#\n####", at=(100, 50))
    assert_pattern(fb, "#", at=(103, 52))
    assert text_of(assert_pattern, fb, "##", at=(102, 51))[1:] == [
        "1 of 2 pixels, x 0, y 0",
        "wanted    drawn     differs",
        "##        .#        ^.",
    ]


@pytest.mark.parametrize("at", [(-1, 0), (0, -1), (126, 0), (0, 63)])
def test_a_part_out_of_the_picture(at):
    with pytest.raises(ValueError, match=re.escape(f"at must leave room for 3x2 pixels in 128x64, not {at!r}")):
        assert_pattern(Framebuffer(128, 64), "...\n...", at=at)


def test_framebuffers_that_differ_are_shown(pytester):
    pytester.makepyfile(
        """
        from paneldraw import Framebuffer

        def test_it():
            left, right = Framebuffer(4, 2), Framebuffer(4, 2)
            left.pixel(3, 1, 1)
            assert left == right
        """
    )
    result = pytester.runpytest_inprocess("-vv")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(
        [
            "E * the framebuffers differ",
            "E *   1 of 8 pixels, x 3, y 1",
            "E *   left      right     differs",
            "E *   ....      ....      ....",
            "E *   ...#      ....      ...^",
        ]
    )


def sources():
    chip = simulator.SSD1306()
    yield chip, chip
    with open_panel("sim://sh1106") as panel:
        yield panel, panel.simulated
    bus = simulator.I2CBus({0x3C: chip, 0x3D: simulator.SH1106()})
    yield bus.devices[0x3C], chip
    yield Panel(SSD1306(), I2CTransport(bus)), chip
    spi = simulator.SPIBus(chip)
    yield Panel(SSD1306(), SPITransport(spi=spi.spi, pins=spi.pins)), chip
    yield simulator.I2CBus({0x3C: chip}), chip
    yield simulator.I2CBus({0x70: simulator.Multiplexer({2: {0x3C: chip}})}), chip
    yield simulator.SPIBus(chip), chip
    uc1609 = simulator.UC1609()
    yield simulator.I2CBus({0x38: uc1609, 0x39: uc1609.data}), uc1609
    with SimPanel() as panel:
        yield panel, panel.chip


def test_where_a_chip_is_found():
    found = 0
    for source, chip in sources():
        assert chip_of(source) is chip, source
        assert frames_of(source) == list(chip.frames)
        found += 1
    assert found == 10


NO_CHIP = {"text": str, "object": object, "framebuffer": lambda: Framebuffer(8, 8), "bus": simulator.I2CBus}


@pytest.mark.parametrize("kind", NO_CHIP)
def test_where_there_is_no_chip(kind):
    source = NO_CHIP[kind]()
    with pytest.raises(TypeError, match="source must be simulated, or a framebuffer, not "):
        chip_of(source)


def test_a_bus_with_two_chips():
    bus = simulator.I2CBus({0x3C: simulator.SSD1306(), 0x3D: simulator.SH1106()})
    with pytest.raises(ValueError, match=r"source must be one of 2 chips, such as bus.devices\[0x3C\], not all of "):
        chip_of(bus)


def test_what_a_frame_may_cost(sim_panel):
    with sim_panel.frame() as fb:
        fb.pixel(64, 32, 1)
    fb.pixel(65, 32, 1)
    report = sim_panel.show(fb)
    frame = frames_of(sim_panel)[-1]
    assert (frame.wire_bytes, report.wire_bytes) == (10, 8)  # before it the panel was asked whether it is on
    assert_bytes(frame, at_most=10)
    assert_bytes(report, at_most=8)
    assert text_of(assert_bytes, report, at_most=5) == ["8 bytes on the wire are 3 more than 5"]
    assert text_of(assert_bytes, sim_panel.stats, at_most=0)[0].startswith(f"{sim_panel.stats.wire_bytes} bytes on")
