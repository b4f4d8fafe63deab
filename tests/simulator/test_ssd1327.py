"""The SSD1327 by its datasheet: windows, remap, greys."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from paneldraw import simulator

ADDRESS = 0x3C
UPRIGHT = "FD 12 AE A8 7F A0 51 A4 AF"


def started(width: int = 128, height: int = 128, init: str = UPRIGHT) -> simulator.SSD1327:
    chip = simulator.SSD1327(width, height)
    commands(chip, init)
    return chip


def commands(chip: simulator.SSD1327, text: str) -> None:
    chip.write(b"\x00" + bytes.fromhex(text))


def greys(width: int, height: int, seed: int) -> NDArray[np.uint8]:
    return np.random.default_rng(seed).integers(0, 16, (height, width), dtype=np.uint8)


def pack(picture: NDArray[np.uint8]) -> bytes:
    """The left pixel in the upper half."""
    return bytes((picture[:, ::2] << 4 | picture[:, 1::2]).ravel())


def test_data_fills_the_window_across_or_down_and_starts_anew() -> None:
    chip = started()
    commands(chip, "15 02 04 75 10 11")
    chip.write(b"\x40" + bytes.fromhex("12 34 56 78 9A BC DE"))
    assert chip.pixels[16:18, 4:10].tolist() == [[13, 14, 3, 4, 5, 6], [7, 8, 9, 10, 11, 12]]
    assert (chip.registers.column, chip.registers.row) == (3, 16)
    commands(chip, "A0 55 15 02 04 75 10 11")
    chip.write(b"\x40" + bytes.fromhex("12 34 56 78"))
    assert chip.pixels[16:18, 4:8].tolist() == [[1, 2, 5, 6], [3, 4, 7, 8]]
    assert (chip.registers.column, chip.registers.row) == (4, 16)
    assert chip.violations == []


def test_of_the_two_bounds_each_can_be_sent_alone() -> None:
    chip = started()
    commands(chip, "15 02 04 75 10 11")
    chip.write(b"\x40\x11\x22")
    commands(chip, "75 20 21")
    chip.write(b"\x40\x33\x44")
    assert chip.pixels[32:34, 4:10].tolist()[0][4:] == [3, 3]
    assert chip.pixels[33, 4:6].tolist() == [4, 4]


@pytest.mark.parametrize(
    ("remap", "turned", "swapped"),
    [
        ("51", (1, 1), False),
        ("42", (-1, -1), False),
        ("53", (1, 1), True),
        ("41", (-1, 1), False),
        ("52", (1, -1), False),
    ],
)
def test_remap_turns_the_picture_and_swaps_the_nibbles(remap: str, turned: tuple[int, int], swapped: bool) -> None:
    chip = started(init=f"FD 12 A0 {remap} AF")
    picture = greys(128, 128, 1)
    sent = picture.reshape(128, 64, 2)[:, :, ::-1].reshape(128, 128) if swapped else picture
    chip.write(b"\x40" + pack(sent))
    assert np.array_equal(chip.pixels, picture[:: turned[0], :: turned[1]])


def test_the_smaller_module_stands_upright_and_flipped() -> None:
    picture = greys(96, 96, 2)
    for init, wanted in (("A8 5F A2 20 A0 51 AF", picture), ("A8 5F A2 60 A0 42 AF", picture[::-1, ::-1])):
        chip = started(96, 96, init)
        commands(chip, "15 08 37 75 00 5F")
        chip.write(b"\x40" + pack(picture))
        assert np.array_equal(chip.pixels, wanted)


def test_display_modes_and_start_line() -> None:
    chip = started()
    picture = greys(128, 128, 3)
    chip.write(b"\x40" + pack(picture))
    for mode, wanted in (("A5", np.full_like(picture, 15)), ("A6", 0 * picture), ("A7", 15 - picture), ("A4", picture)):
        commands(chip, mode)
        assert np.array_equal(chip.pixels, wanted)
    commands(chip, "A1 05")
    assert np.array_equal(chip.pixels, np.roll(picture, -5, axis=0))
    commands(chip, "AE")
    assert not chip.pixels.any()


def test_fewer_lines_are_driven() -> None:
    chip = started(init="A8 3F A0 51 AF")
    chip.write(b"\x40" + b"\xff" * 8192)
    assert np.count_nonzero(chip.pixels.any(axis=1)) == 64


def test_greys() -> None:
    chip = started()
    commands(chip, "B8 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 3F")
    assert chip.registers.greys[-1] == 0x3F
    commands(chip, "B9")
    assert chip.registers.greys == tuple(range(0, 30, 2))
    assert chip.violations == []
    commands(chip, "B8 01 02 03 03 05 06 07 08 09 0A 0B 0C 0D 0E 3F")
    assert "a grey table rises" in chip.violations[0]


def test_a_locked_chip_takes_nothing_but_the_key() -> None:
    chip = started()
    commands(chip, "FD 16 81 22 AE")
    assert chip.contrast == 0x7F
    assert chip.registers.on
    assert chip.violations[0] == "81 22: commands are locked; send FD 12 first"
    commands(chip, "FD 12 81 22")
    assert chip.contrast == 0x22


@pytest.mark.parametrize(
    ("sent", "text"),
    [
        ("15 00 40", "15 00 40: there is no column past 63"),
        ("75 05 04", "75 05 04: the window starts after its end, at the rows"),
        ("A0 59", "A0 59: bits 3, 5 and 7 of the remap are 0"),
        ("A8 0E", "A8 0E: the multiplex ratio"),
        ("20", "20: a command neither of the SSD1327 nor of its relatives"),
        ("2F", "2F: a scroll is started and none was set up"),
        ("FD 13", "FD 13: the command lock takes"),
    ],
)
def test_what_the_datasheet_forbids(sent: str, text: str) -> None:
    chip = started()
    commands(chip, sent)
    assert chip.violations[0].startswith(text)


def test_no_data_while_a_scroll_is_running() -> None:
    chip = started()
    commands(chip, "26 00 00 06 10 00 3F 00 2F")
    assert chip.violations == []
    chip.write(b"\x40\x00")
    commands(chip, "26 00 00 06 10 00 3F 00")
    assert [text.split(";")[0] for text in chip.violations] == [
        "data while a scroll is running",
        "26 00 00 06 10 00 3F 00: a scroll is set up only while none is running",
    ]


def test_a_size_that_no_module_has() -> None:
    with pytest.raises(ValueError, match=r"128x64 is no module known here \(128x128, 128x96, 96x96, 96x64\)"):
        simulator.SSD1327(128, 64)
