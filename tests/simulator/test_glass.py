"""What an eye sees: orientation, windows, start line, offset, multiplex, COM pins, against the datasheet's tables."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import simulator

from .helpers import SIZES, commands, offset, pack, random_picture, row_numbers, send, show_row_numbers, started

Rows = list[int | None]


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_a0_and_c0_turn_the_picture(width: int, height: int) -> None:
    chip = started(width, height)
    commands(chip, "A0 C0")
    picture = random_picture(width, height, 3)
    left = 128 - width - offset(width)
    chip.write(bytes([0x00, 0x21, left, left + width - 1, 0x22, 0, height // 8 - 1]))
    chip.write(b"\x40" + pack(picture).tobytes())
    assert np.array_equal(chip.pixels, picture[::-1, ::-1])


def test_com_direction_flips_what_is_there_and_segment_remap_does_not() -> None:
    chip, picture = started(), random_picture(128, 64, 4)
    send(chip, picture)
    commands(chip, "A0")
    assert np.array_equal(chip.pixels, picture)
    commands(chip, "C0")
    assert np.array_equal(chip.pixels, picture[::-1])


def test_inversion_all_on_and_off() -> None:
    chip, picture = started(), random_picture(128, 64, 5)
    send(chip, picture)
    commands(chip, "A7")
    assert np.array_equal(chip.pixels, 1 - picture)
    commands(chip, "A5")
    assert chip.pixels.all()
    commands(chip, "A6 AE")
    assert not chip.pixels.any()
    commands(chip, "AF")
    assert chip.pixels.all()
    commands(chip, "A4")
    assert np.array_equal(chip.pixels, picture)


def test_without_charge_pump_the_panel_is_dark_unless_it_has_its_own_supply() -> None:
    bare, supplied = simulator.SSD1306(), simulator.SSD1306(external_vcc=True)
    for chip in (bare, supplied):
        commands(chip, "A5 AF")
    assert not bare.pixels.any()
    assert supplied.pixels.all()
    assert supplied.violations == []
    commands(bare, "AE 8D 14 AF")
    assert bare.pixels.all()
    commands(bare, "AE 8D 10 AF")
    assert not bare.pixels.any()


# The datasheet's examples of offset and start line: multiplex ratio, offset, start line, and the RAM rows at COM0 to
# COM63, as (first COM, last COM, RAM row at the first); the COMs that are not listed are dark.
NOT_REMAPPED = [
    (64, 0, 0, [(0, 63, 0)]),
    (64, 8, 0, [(0, 55, 8), (56, 63, 0)]),
    (64, 0, 8, [(0, 55, 8), (56, 63, 0)]),
    (56, 0, 0, [(0, 55, 0)]),
    (56, 8, 0, [(0, 47, 8), (56, 63, 0)]),
    (56, 0, 8, [(0, 55, 8)]),
]
REMAPPED = [
    (64, 0, 0, [(0, 63, 63)]),
    (64, 8, 0, [(0, 7, 7), (8, 63, 63)]),
    (64, 0, 8, [(0, 7, 7), (8, 63, 63)]),
    (48, 0, 0, [(0, 47, 47)]),
    (48, 8, 0, [(8, 55, 47)]),
    (48, 0, 8, [(0, 47, 55)]),
    (48, 8, 16, [(8, 55, 63)]),
]


def by_com(parts: list[tuple[int, int, int]], step: int) -> Rows:
    rows: Rows = [None] * 64
    for first, last, row in parts:
        for com in range(first, last + 1):
            rows[com] = row + step * (com - first)
    return rows


@pytest.mark.parametrize(("multiplex", "shift", "start", "parts"), NOT_REMAPPED)
def test_offset_start_line_and_multiplex_without_remap(
    multiplex: int, shift: int, start: int, parts: list[tuple[int, int, int]]
) -> None:
    chip = started()
    show_row_numbers(chip)
    commands(chip, f"C0 A8 {multiplex - 1:02X} D3 {shift:02X} {0x40 + start:02X}")
    assert row_numbers(chip.pixels)[::-1] == by_com(parts, 1)


@pytest.mark.parametrize(("multiplex", "shift", "start", "parts"), REMAPPED)
def test_offset_start_line_and_multiplex_with_remap(
    multiplex: int, shift: int, start: int, parts: list[tuple[int, int, int]]
) -> None:
    chip = started()
    show_row_numbers(chip)
    commands(chip, f"C8 A8 {multiplex - 1:02X} D3 {shift:02X} {0x40 + start:02X}")
    assert row_numbers(chip.pixels)[::-1] == by_com(parts, -1)


def test_dark_lines_stay_dark_when_inverted_or_all_on() -> None:
    chip = started()
    commands(chip, "A8 1F A7 A5")
    assert [bool(line.any()) for line in chip.pixels] == [False] * 32 + [True] * 32


# The datasheet's figures of the COM pins: which row the pads COM0, COM1, COM31, COM32 and COM63 carry.
PADS = [
    ("02", "C0", [0, 1, 31, 32, 63]),
    ("22", "C0", [32, 33, 63, 0, 31]),
    ("02", "C8", [63, 62, 32, 31, 0]),
    ("22", "C8", [31, 30, 0, 63, 32]),
    ("12", "C0", [0, 2, 62, 1, 63]),
    ("32", "C0", [1, 3, 63, 0, 62]),
    ("12", "C8", [63, 61, 1, 62, 0]),
    ("32", "C8", [62, 60, 0, 63, 1]),
]


@pytest.mark.parametrize(("pins", "direction", "rows"), PADS)
def test_com_pins_against_the_figures(pins: str, direction: str, rows: list[int]) -> None:
    chip = started(com_pins=0x02)
    show_row_numbers(chip)
    commands(chip, f"DA {pins} {direction}")
    pads = row_numbers(chip.pixels)[::-1]
    assert [pads[pad] for pad in (0, 1, 31, 32, 63)] == rows


def test_sequential_pins_on_a_128x64_interleave_the_halves() -> None:
    chip = started()
    show_row_numbers(chip)
    commands(chip, "DA 02")
    expected: Rows = [row for pair in zip(range(32), range(32, 64), strict=True) for row in pair]
    assert row_numbers(chip.pixels) == expected


def test_alternative_pins_on_a_128x32_lose_every_other_line() -> None:
    chip = started(128, 32)
    show_row_numbers(chip)
    commands(chip, "DA 12")
    assert row_numbers(chip.pixels) == [None] * 16 + list(range(1, 32, 2))


def test_left_right_remap_on_a_128x64_swaps_neighbors() -> None:
    chip = started()
    show_row_numbers(chip)
    commands(chip, "DA 32")
    assert row_numbers(chip.pixels) == [row ^ 1 for row in range(64)]


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_nothing_outside_the_window_is_seen(width: int, height: int) -> None:
    chip = started(width, height)
    commands(chip, "20 00 21 00 7F 22 00 07")
    chip.write(b"\x40" + b"\xff" * 1024)
    send(chip, np.zeros((height, width), np.uint8))
    assert not chip.pixels.any()


def test_start_line_scrolls_a_32_line_module_through_the_whole_ram() -> None:
    chip = started(128, 32)
    show_row_numbers(chip)
    commands(chip, "54")
    assert row_numbers(chip.pixels) == list(range(20, 52))
    commands(chip, "7E")
    assert row_numbers(chip.pixels) == [62, 63, *range(30)]


def test_a_module_of_another_size_says_its_own_wiring() -> None:
    chip = simulator.SSD1306(100, 40, column_offset=7, com_pins=0x12)
    commands(chip, "A8 27 DA 12 8D 14 20 00 A1 C8 21 07 6A 22 00 04 AF")
    picture = random_picture(100, 40, 6)
    chip.write(b"\x40" + pack(picture).tobytes())
    assert np.array_equal(chip.pixels, picture)
