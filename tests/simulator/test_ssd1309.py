"""The SSD1309: what it has not of the SSD1306, and what it has besides."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import simulator

from .helpers import pack, random_picture

START = "D5 A0 A8 3F D3 00 40 20 00 A1 C8 DA 12 81 7F D9 22 DB 34 21 00 7F 22 00 07 A4 A6 AF"


def test_it_shows_a_picture_without_a_word() -> None:
    chip, picture = simulator.SSD1309(), random_picture(128, 64, 1)
    chip.write(b"\x00" + bytes.fromhex(START))
    chip.write(b"\x40" + pack(picture).tobytes())
    assert np.array_equal(chip.pixels, picture)
    assert (chip.violations, chip.remarks) == ([], [])


def test_what_it_has_not() -> None:
    chip = simulator.SSD1309()
    chip.write(bytes.fromhex("00 8D 14 A5 AF"))
    assert chip.pixels.all()
    assert chip.remarks == ["8D 14: not a command of the SSD1309 (charge pump of the SSD1306); ignored"]


def test_a_locked_chip_takes_nothing_but_the_key() -> None:
    chip = simulator.SSD1309()
    chip.write(bytes.fromhex("00 FD 16 81 22 A7"))
    assert (chip.contrast, chip.registers.inverted) == (0x7F, False)
    assert chip.violations == ["81 22: commands are locked; send FD 12 first"]
    chip.write(bytes.fromhex("00 FD 12 81 22"))
    assert chip.contrast == 0x22


def test_sizes_that_need_more() -> None:
    with pytest.raises(ValueError, match=r"102x64 is no module known here \(128x64\); give column_offset too"):
        simulator.SSD1309(102, 64)
    assert simulator.SSD1309(102, 64, column_offset=13).pixels.shape == (64, 102)
