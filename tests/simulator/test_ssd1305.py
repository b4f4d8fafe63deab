"""The SSD1305 and the SSD1312: what they have besides the SSD1306, and what they have not."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import simulator

from .helpers import commands, pack, random_picture


def test_reset_values() -> None:
    registers = simulator.SSD1305().registers
    assert (registers.column_end, registers.page_end, registers.mode) == (131, 7, 2)
    assert (registers.contrast, registers.area_brightness, registers.vcomh) == (0x7F, 0x80, 0x34)
    assert (registers.com_pins, registers.multiplex, registers.on) == (0x12, 63, False)


@pytest.mark.parametrize("size", [(128, 64), (128, 32)])
@pytest.mark.parametrize("offset", [0, 2, 4])
def test_a_window_reaches_all_132_columns(size: tuple[int, int], offset: int) -> None:
    chip = simulator.SSD1305(*size, column_offset=offset)
    pages = size[1] // 8
    picture = random_picture(*size, 1)
    commands(chip, f"A8 {size[1] - 1:02X} A1 C8 20 00 21 00 83 22 00 {pages - 1:02X} AF")
    ram = np.zeros((pages, 132), np.uint8)
    ram[:, offset : offset + 128] = pack(picture)
    chip.write(b"\x40" + ram.tobytes())
    assert np.array_equal(chip.pixels, picture)
    assert (chip.violations, chip.remarks) == ([], [])


@pytest.mark.parametrize(
    ("sent", "state"),
    [
        ("82 10 A7", {"area_brightness": 0x10}),
        ("91 3F 3F 3F 3F A7", {}),
        ("92 AE AE AE AE A7", {}),
        ("AB 00 80 80 A7", {}),
        ("AD 8E A7", {"master": 0x8E}),
        ("D8 05 A7", {"area_color": 0x05}),
        ("26 01 00 00 03 A7", {}),
        ("AC A7", {"on": True}),
    ],
)
def test_commands_take_their_arguments(sent: str, state: dict[str, int]) -> None:
    chip = simulator.SSD1305()
    commands(chip, sent)
    assert chip.registers.inverted
    assert {name: getattr(chip.registers, name) for name in state} == state
    assert (chip.violations, chip.remarks) == ([], [])


def test_it_needs_no_pump_and_says_so() -> None:
    chip = simulator.SSD1305()
    commands(chip, "8D 10 A5 AF")
    assert chip.pixels.all()
    assert chip.remarks == ["8D 10: not a command of the SSD1305 (charge pump of the SSD1306); ignored"]


@pytest.mark.parametrize("sent", ["D3 40", "DB 40", "AD 30"])
def test_what_is_merely_not_in_the_sheet(sent: str) -> None:
    chip = simulator.SSD1305()
    commands(chip, sent)
    assert (len(chip.remarks), chip.violations) == (1, [])


def test_the_ssd1312_stands_upright_under_a1_and_c0_and_begins_at_com_16() -> None:
    chip, picture = simulator.SSD1312(128, 32), random_picture(128, 32, 2)
    commands(chip, "A8 3F D3 30 8D 14 AD 30 20 00 A1 C0 21 00 7F 22 00 03 AF")
    chip.write(b"\x40" + pack(picture).tobytes())
    assert np.array_equal(chip.pixels, picture)
    commands(chip, "A0 C8")
    assert np.array_equal(chip.pixels[::-1], picture), "A0 mirrors what is written from now on"
    assert (chip.violations, chip.remarks) == ([], [])
