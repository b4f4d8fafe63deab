"""The SSD1322 on SPI: arguments as data, the remap, windows of four pixels a column."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from paneldraw import simulator

# A vendor's start of a 256x64 module (Newhaven's example for its NHD-3.12-25664).
START = (
    "FD 12, AE, B3 91, CA 3F, A2 00, AB 01, A0 14 11, C7 0F, C1 9F, B1 E2, D1 82 20, BB 1F, B4 A0 FD, BE 07, A6, A9, AF"
)


def send(chip: simulator.SSD1322, text: str, data: bytes = b"") -> None:
    """Send commands, their arguments with D/C high."""
    for command in text.split(","):
        sent = bytes.fromhex(command)
        chip.transfer(sent[:1], data=False)
        if len(sent) > 1:
            chip.transfer(sent[1:], data=True)
    if data:
        chip.transfer(data, data=True)


def started(remap: str = "14 11") -> simulator.SSD1322:
    chip = simulator.SSD1322()
    send(chip, START.replace("14 11", remap))
    return chip


def greys(seed: int) -> NDArray[np.uint8]:
    return np.random.default_rng(seed).integers(0, 16, (64, 256), dtype=np.uint8)


def pack(picture: NDArray[np.uint8]) -> bytes:
    return bytes((picture[:, ::2] << 4 | picture[:, 1::2]).ravel())


@pytest.mark.parametrize(("remap", "turn"), [("14 11", 1), ("06 11", -1)])
def test_vendors_remap_is_upright_and_the_other_upside_down(remap: str, turn: int) -> None:
    chip, picture = started(remap), greys(1)
    send(chip, "15 1C 5B, 75 00 3F, 5C", pack(picture))
    assert np.array_equal(chip.pixels, picture[::turn, ::turn])
    assert (chip.violations, chip.remarks) == ([], [])


def test_without_the_nibble_remap_a_column_is_turned_over() -> None:
    chip = started("10 11")
    send(chip, "15 1C 5B, 75 00 3F, 5C", bytes.fromhex("12 34"))
    assert chip.pixels[0, :4].tolist() == [4, 3, 2, 1]


def test_windows_across_and_down_and_data_in_odd_pieces() -> None:
    for remap, order in (("14 11", [1, 3, 2]), ("15 11", [1, 2, 3])):
        chip = started(remap)
        send(chip, "15 1C 1D, 75 02 03, 5C")
        for piece in ("11", "11 22", "22 33", "33"):
            chip.transfer(bytes.fromhex(piece), data=True)
        first, below, beside = order[0], *((2, 3) if remap == "15 11" else (3, 2))
        assert (chip.pixels[2, 0], chip.pixels[3, 0], chip.pixels[2, 4]) == (first, below, beside)


def test_display_modes_have_numbers_of_their_own() -> None:
    chip, picture = started(), greys(2)
    send(chip, "15 1C 5B, 75 00 3F, 5C", pack(picture))
    for mode, wanted in (("A4", 0 * picture), ("A5", 0 * picture + 15), ("A7", 15 - picture), ("A6", picture)):
        send(chip, mode)
        assert np.array_equal(chip.pixels, wanted)


def test_what_endangers_the_picture() -> None:
    chip = started()
    send(chip, "15 1C")
    send(chip, "A6")
    chip.transfer(b"\x12", data=True)
    assert chip.violations == [
        "15 1C: a command is cut off before its arguments",
        "data that no command waits for is lost",
    ]


def test_it_is_not_for_i2c() -> None:
    with pytest.raises(ValueError, match="SSD1322 cannot sit on I2C, but on SPI"):
        simulator.I2CBus({0x3C: simulator.SSD1322()})
