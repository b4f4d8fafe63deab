"""The SH1107: its pages and modes, its columns on COM lines, and drivers by others."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import simulator

from .helpers import pack, random_picture

# U8g2's start of a 64x128 module, and what it changes for the others (u8x8_d_sh1107.c).
U8G2 = "AE DC 00 81 2F 20 A0 C0 A8 7F {} D5 51 D9 22 DB 35 B0 DA 12 A4 A6 AF"


def commands(chip: simulator.SH1107, text: str) -> None:
    chip.write(b"\x00" + bytes.fromhex(text))


def send(chip: simulator.SH1107, picture: np.ndarray[tuple[int, int], np.dtype[np.uint8]], left: int) -> None:
    for page, row in enumerate(pack(picture)):
        chip.write(bytes([0x00, 0x10 | left >> 4, left & 15, 0xB0 | page]))
        chip.write(b"\x40" + row.tobytes())


@pytest.mark.parametrize(
    ("width", "offset", "left", "wiring"),
    [
        (64, "D3 60", 0, {}),
        (80, "", 24, {}),
        (80, "A8 4F D3 68", 0, {}),
        (128, "", 0, {}),
        (128, "", 96, {"column_offset": 96}),
    ],
)
def test_u8g2(width: int, offset: str, left: int, wiring: dict[str, int]) -> None:
    chip = simulator.SH1107(width, 128, **wiring)
    commands(chip, U8G2.format(offset))
    picture = random_picture(width, 128, 1)
    send(chip, picture, left)
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []
    if "A8 4F" not in offset:
        commands(chip, "A1 C8")
        assert np.array_equal(chip.pixels, picture[::-1, ::-1] if left != 96 else chip.pixels)


def test_each_mirror_turns_its_own_axis() -> None:
    chip, picture = simulator.SH1107(128, 128), random_picture(128, 128, 2)
    commands(chip, "A0 C0 AF")
    send(chip, picture, 0)
    commands(chip, "A1")
    assert np.array_equal(chip.pixels, picture[::-1])
    commands(chip, "A0 C8")
    assert np.array_equal(chip.pixels, picture[:, ::-1])
    commands(chip, "C0 DC 05")
    assert np.array_equal(chip.pixels, np.roll(picture, -5, axis=1))


def test_vertical_mode_goes_down_the_pages_and_to_the_next_column() -> None:
    chip = simulator.SH1107()
    commands(chip, "21 BE 03 10")
    chip.write(bytes.fromhex("40 01 02 03 04"))
    assert [int(chip.ram[page, column]) for page, column in ((14, 3), (15, 3), (0, 4), (1, 4))] == [1, 2, 3, 4]
    commands(chip, "20 BE 03 10")
    chip.write(bytes.fromhex("40 05 06"))
    assert chip.ram[14, 3:5].tolist() == [5, 6]
    assert chip.violations == []
