"""The SH1122: rows by an argument, two pixels a byte, and a reversed scan that begins in the middle."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from paneldraw import simulator


def commands(chip: simulator.SH1122, text: str) -> None:
    chip.write(b"\x00" + bytes.fromhex(text))


def shown(text: str) -> tuple[simulator.SH1122, NDArray[np.uint8]]:
    """A chip after some commands with a picture in its RAM."""
    chip = simulator.SH1122()
    commands(chip, text)
    levels = np.random.default_rng(1).integers(0, 16, (64, 256), np.uint8)
    for row, line in enumerate(levels):
        commands(chip, f"B0 {row:02X} 00 10")
        chip.write(b"\x40" + (line[::2] << 4 | line[1::2]).tobytes())
    commands(chip, "AF")
    return chip, levels


def test_reset_values() -> None:
    registers = simulator.SH1122().registers
    assert (registers.row, registers.column, registers.start_line, registers.offset) == (0, 0, 0, 0)
    assert (registers.multiplex, registers.contrast, registers.segment_remap, registers.on) == (63, 0x80, False, False)


@pytest.mark.parametrize(
    ("sent", "down", "across"), [("A0 C0", 1, 1), ("A1 C0", 1, -1), ("A0 C8 60", -1, 1), ("A1 C8 60", -1, -1)]
)
def test_each_mirror_turns_its_own_axis(sent: str, down: int, across: int) -> None:
    chip, levels = shown(sent)
    assert np.array_equal(chip.pixels, levels[::down, ::across])
    assert (chip.violations, chip.remarks) == ([], [])


def test_a_reversed_scan_without_the_start_line_shows_the_halves_swapped() -> None:
    chip, levels = shown("C8 40")
    assert np.array_equal(chip.pixels, np.roll(levels[::-1], 32, axis=0))


def test_offset_and_display_modes() -> None:
    chip, levels = shown("D3 05")
    assert np.array_equal(chip.pixels, np.roll(levels, -5, axis=0))
    commands(chip, "D3 00 A7")
    assert np.array_equal(chip.pixels, 15 - levels)
    commands(chip, "A5")
    assert (chip.pixels == 15).all()
    commands(chip, "A4 A6 A8 1F")
    assert np.array_equal(chip.pixels[:32], levels[:32])
    assert not chip.pixels[32:].any()
    assert chip.violations == []


def test_the_pointer_stays_in_its_row_and_ends_with_it() -> None:
    chip, levels = shown("A0")
    commands(chip, "B0 07 0E 17")
    chip.write(bytes.fromhex("40 12 34 56"))
    assert chip.pixels[7, 252:].tolist() == [1, 2, 3, 4]
    assert np.array_equal(chip.pixels[8], levels[8])
    assert chip.violations == ["data past column 127 is lost"]


@pytest.mark.parametrize("sent", ["B0 40", "18", "A8 40", "D3 40"])
def test_what_endangers_the_picture(sent: str) -> None:
    chip = simulator.SH1122()
    commands(chip, sent)
    assert len(chip.violations) == 1


@pytest.mark.parametrize("sent", ["AD 81", "D5 50", "D9 22", "DB 35", "DC 35", "E3", "30", "3F", "E0 EE"])
def test_commands_that_are_not_seen_take_their_arguments(sent: str) -> None:
    chip = simulator.SH1122()
    commands(chip, f"{sent} 81 2A")
    assert (chip.contrast, chip.violations, chip.remarks) == (0x2A, [], [])
