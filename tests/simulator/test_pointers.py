"""Where data bytes land: the chip against a slow model of the datasheet's text, a byte at a time."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples

from .helpers import commands, started


class Model:
    """Pointer rules as the datasheet words them; nothing is shared with the chip under test."""

    def __init__(self) -> None:
        self.memory: dict[tuple[int, int], int] = {}
        self.mode = "page"
        self.column = self.page = 0
        self.columns, self.pages = (0, 127), (0, 7)
        self.mirrored = False

    def command(self, sent: bytes) -> None:
        opcode = sent[0]
        if opcode == 0x20:
            self.mode = {0: "horizontal", 1: "vertical", 2: "page"}[sent[1]]
        elif opcode == 0x21:
            self.columns, self.column = (sent[1], sent[2]), sent[1]
        elif opcode == 0x22:
            self.pages, self.page = (sent[1], sent[2]), sent[1]
        elif opcode < 0x10:
            self.column = self.column // 16 * 16 + opcode
        elif opcode < 0x18:
            self.column = (opcode - 0x10) * 16 + self.column % 16
        elif opcode in (0xA0, 0xA1):
            self.mirrored = opcode == 0xA1
        else:
            self.page = opcode - 0xB0

    def data(self, byte: int) -> None:
        self.memory[self.page, 127 - self.column if self.mirrored else self.column] = byte
        if self.mode == "page":
            self.column = 0 if self.column == 127 else self.column + 1
        elif self.mode == "horizontal":
            if self.next_column():
                self.next_page()
        elif self.next_page():
            self.next_column()

    def next_column(self) -> bool:
        if self.column == self.columns[1]:
            self.column = self.columns[0]
            return True
        self.column = (self.column + 1) % 128
        return False

    def next_page(self) -> bool:
        if self.page == self.pages[1]:
            self.page = self.pages[0]
            return True
        self.page = (self.page + 1) % 8
        return False


columns, pages = st.integers(0, 127), st.integers(0, 7)
steps = st.one_of(
    st.builds(lambda mode: bytes([0x20, mode]), st.integers(0, 2)),
    st.builds(lambda a, b: bytes([0x21, a, b]), columns, columns),
    st.builds(lambda a, b: bytes([0x22, a, b]), pages, pages),
    st.sampled_from([*range(0x18), 0xA0, 0xA1, *range(0xB0, 0xB8)]).map(lambda opcode: bytes([opcode])),
    st.tuples(st.just("data"), st.integers(1, 400), st.integers(0, 255)),
)


@examples(4)
@given(st.lists(steps, min_size=5, max_size=25))
def test_every_byte_lands_where_the_datasheet_says(sequence: list[bytes | tuple[str, int, int]]) -> None:
    chip, model = started(mode=2), Model()
    model.mirrored = True
    expected = chip.ram
    for step in sequence:
        if isinstance(step, bytes):
            chip.write(b"\x00" + step)
            model.command(step)
        else:
            _, count, first = step
            run = bytes((first + 7 * index) % 256 for index in range(count))
            chip.write(b"\x40" + run)
            for byte in run:
                model.data(byte)
        assert (chip.registers.page, chip.registers.column) == (model.page, model.column)
    for (page, segment), byte in model.memory.items():
        expected[page, segment] = byte
    assert np.array_equal(chip.ram, expected)


def landed(chip_commands: str, count: int) -> list[tuple[int, int]]:
    """Where bytes 1, 2, 3 ... land, as (page, column), under A0."""
    chip = started(mode=2)
    commands(chip, "20 00 A0 21 00 7F 22 00 07")
    chip.write(b"\x40" + bytes(1024))
    commands(chip, chip_commands)
    chip.write(b"\x40" + bytes(range(1, count + 1)))
    ram = chip.ram
    return [
        tuple(int(n) for n in np.argwhere(ram == value)[0]) for value in range(1, count + 1) if (ram == value).any()
    ]


def test_page_mode_wraps_in_its_page() -> None:
    assert landed("20 02 B3 0E 17", 4) == [(3, 126), (3, 127), (3, 0), (3, 1)]


def test_horizontal_mode_goes_through_the_window_row_by_row_and_starts_again() -> None:
    assert landed("20 00 21 05 06 22 02 03", 4) == [(2, 5), (2, 6), (3, 5), (3, 6)]
    assert landed("20 00 21 05 06 22 02 03", 5) == [(2, 6), (3, 5), (3, 6), (2, 5)]


def test_vertical_mode_goes_through_the_window_column_by_column() -> None:
    assert landed("20 01 21 05 06 22 02 03", 4) == [(2, 5), (3, 5), (2, 6), (3, 6)]
    assert landed("20 01 21 05 06 22 02 03", 5) == [(3, 5), (2, 6), (3, 6), (2, 5)]


def test_a_pointer_past_its_window_counts_on_to_the_end_of_the_ram() -> None:
    assert landed("20 00 21 7D 05 22 02 03", 5) == [(2, 125), (2, 126), (2, 127), (2, 0), (2, 1)]
    assert landed("20 00 21 03 05 22 02 03 20 02 0C 17 20 00", 6)[3:] == [(2, 127), (2, 0), (2, 1)]
    assert landed("20 01 21 03 05 22 06 01", 5) == [(6, 3), (7, 3), (0, 3), (1, 3), (6, 4)]


def test_setting_one_side_of_the_window_leaves_the_other_pointer_alone() -> None:
    assert landed("20 00 21 0A 0F 22 02 03 21 0C 0F 22 01 03", 1) == [(1, 12)]
    assert landed("20 02 B4 20 00 21 0A 0F", 1) == [(4, 10)]


@pytest.mark.parametrize(("remap", "segment"), [("A0", 3), ("A1", 124)])
def test_segment_remap_is_for_data_that_comes_after_it(remap: str, segment: int) -> None:
    chip = started(mode=2)
    commands(chip, f"{remap} B0 03 10")
    before = chip.ram
    chip.write(bytes([0x40, int(before[0, segment]) ^ 0xFF]))
    changed = chip.ram
    assert np.argwhere(changed != before).tolist() == [[0, segment]]
    commands(chip, "A0" if remap == "A1" else "A1")
    assert np.array_equal(chip.ram, changed)
