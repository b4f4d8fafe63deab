"""What drivers by others really put on real wires ends in their picture, and in no violation."""

from __future__ import annotations

import gzip
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from paneldraw import simulator
from paneldraw.testing import assert_frame

CAPTURES = Path(__file__).parent / "captures"
RESERVED_MODE = "20 10: the upper bits of the addressing mode are 0"
POINTER = "B0: the page pointer commands B0-B7, 00-0F and 10-1F are for page addressing mode only"


def lines(name: str) -> Iterator[list[str]]:
    with gzip.open(CAPTURES / f"{name}.txt.gz", "rt") as file:
        for line in file:
            yield line.split()


def over_i2c(name: str, chip: simulator.SSD1306) -> None:
    for seconds, address, direction, _, *payload in lines(name):
        if address == "3c" and direction == "w" and payload:
            sent = bytes.fromhex(payload[0])
            chip.write(sent)
            chip.settle(float(seconds), 1 + len(sent))


def over_spi(name: str, chip: simulator.SSD1306) -> None:
    for seconds, *runs in lines(name):
        for run in runs:
            chip.transfer(bytes.fromhex(run[1:]), run[0] == "d")
        chip.deselect()
        chip.settle(float(seconds), sum(len(run) // 2 for run in runs))


def test_the_same_program_over_i2c_and_spi_shows_the_same_pictures() -> None:
    """A line of letters below another wanders on from picture to picture; the one capture is longer than the other."""
    wired, serial = simulator.SSD1306(), simulator.SSD1306()
    over_i2c("ssd1306-i2c", wired)
    over_spi("ssd1306-spi", serial)
    loop = {frame.pixels[::-1, ::-1].tobytes() for frame in serial.frames if np.count_nonzero(frame.pixels) == 7229}
    assert len(loop) == 11
    assert wired.pixels.tobytes() in loop
    assert loop <= {frame.pixels.tobytes() for frame in wired.frames}
    assert_frame(wired.frames[-1], "capture_ssd1306.png")
    for chip in (wired, serial):
        assert chip.violations == []
        assert chip.remarks == [RESERVED_MODE, POINTER]


def test_their_frames_are_whole_pictures() -> None:
    """The capture on SPI is without glitches: noise, an empty panel, and then nothing but pictures of the loop."""
    chip = simulator.SSD1306()
    over_spi("ssd1306-spi", chip)
    lit = [int(np.count_nonzero(frame.pixels)) for frame in chip.frames]
    assert lit[1:] == [0] + [7229] * 82
    assert np.diff([frame.seconds for frame in chip.frames])[1:].min() > 0.009


def test_the_reserved_mode_works_as_its_low_bits_say() -> None:
    chip = simulator.SSD1306()
    over_i2c("ssd1306-i2c-reserved-mode", chip)
    assert_frame(simulator.Frame(chip.pixels[::-1, ::-1], 0, 0), "capture_reserved_mode.png")
    assert (chip.violations, chip.remarks) == ([], [RESERVED_MODE, POINTER])
