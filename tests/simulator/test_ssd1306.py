"""Control bytes, commands and their arguments, state after reset, and what the datasheet forbids."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import simulator

from .helpers import SIZES, commands, init, random_picture, send, started


def test_reset_values() -> None:
    registers = simulator.SSD1306().registers
    assert (registers.mode, registers.column, registers.page) == (2, 0, 0)
    assert (registers.column_start, registers.column_end, registers.page_start, registers.page_end) == (0, 127, 0, 7)
    assert (registers.start_line, registers.offset, registers.multiplex, registers.com_pins) == (0, 0, 63, 0x12)
    assert (registers.segment_remap, registers.com_reversed, registers.all_on, registers.inverted) == (False,) * 4
    assert (registers.on, registers.charge_pump, registers.contrast) == (False, 0x10, 0x7F)
    assert (registers.clock, registers.precharge, registers.vcomh) == (0x80, 0x22, 0x20)


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_init_of_a_module_breaks_no_rule_and_shows_the_picture(width: int, height: int) -> None:
    chip = started(width, height)
    picture = random_picture(width, height, 1)
    send(chip, picture)
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []


@given(st.data())
def test_arguments_may_come_in_later_transactions_and_behind_any_control_byte(data: st.DataObject) -> None:
    sequence = init(128, 64)
    whole, pieces = started(), simulator.SSD1306()
    at = 0
    while at < len(sequence):
        run = sequence[at : at + data.draw(st.integers(1, 5))]
        chained = data.draw(st.integers(0, len(run)))
        payload = b"".join(bytes([0x80, byte]) for byte in run[:chained])
        pieces.write(payload + b"\x00" + run[chained:])
        at += len(run)
    assert pieces.registers == whole.registers
    assert pieces.violations == []


def test_co_chains_commands_and_data_in_one_transaction() -> None:
    chip = started(mode=2)
    chip.write(bytes.fromhex("80 B3 80 05 80 10 C0 AA 80 B4 40 BB CC"))
    ram = chip.ram[:, ::-1]
    assert (ram[3, 5], ram[4, 6], ram[4, 7]) == (0xAA, 0xBB, 0xCC)
    assert chip.violations == []


def test_data_bytes_that_look_like_control_bytes_are_data() -> None:
    chip = started(mode=2)
    commands(chip, "B0 00 10")
    chip.write(bytes.fromhex("40 80 00 C0 40"))
    assert chip.ram[0, ::-1][:4].tobytes() == bytes.fromhex("80 00 C0 40")


def test_power_cycle_forgets_everything_and_reset_keeps_the_ram() -> None:
    chip = started()
    send(chip, random_picture(128, 64, 2))
    ram = chip.ram
    commands(chip, "81 40 81")
    chip.reset()
    assert np.array_equal(chip.ram, ram)
    assert chip.registers == simulator.SSD1306().registers
    assert not chip.pixels.any()
    commands(chip, "A7")
    assert chip.registers.inverted, "the argument that 81 waited for is forgotten too"
    chip.power_cycle()
    assert not np.array_equal(chip.ram, ram)
    assert not chip.registers.inverted


def test_ram_after_power_up_is_noise_that_a_seed_repeats() -> None:
    first, same, other = (simulator.SSD1306(seed=seed) for seed in (5, 5, 6))
    assert np.array_equal(first.ram, same.ram)
    assert not np.array_equal(first.ram, other.ram)
    assert 0.4 < np.unpackbits(first.ram).mean() < 0.6
    first.power_cycle()
    same.power_cycle()
    assert np.array_equal(first.ram, same.ram)


def test_status_tells_whether_the_display_is_off() -> None:
    chip = simulator.SSD1306()
    assert [byte & 0x40 for byte in chip.read(2)] == [0x40, 0x40]
    commands(chip, "8D 14 AF")
    assert chip.read(1)[0] & 0x40 == 0


def test_contrast_can_be_read() -> None:
    chip = simulator.SSD1306()
    commands(chip, "81 2A")
    assert chip.contrast == 0x2A


def test_scroll_commands_take_their_arguments_and_are_kept() -> None:
    chip = started()
    commands(chip, "A3 00 40 2A 00 01 07 05 03 2F")
    scroll = chip.registers.scroll
    assert (scroll.opcode, scroll.page_start, scroll.page_end, scroll.interval) == (0x2A, 1, 5, 7)
    assert (scroll.rows_per_step, scroll.top_rows, scroll.scroll_rows) == (3, 0, 64)
    assert chip.registers.scrolling
    commands(chip, "2E 26 00 02 00 03 00 FF A7")
    scroll = chip.registers.scroll
    assert (scroll.opcode, scroll.page_start, scroll.page_end, scroll.scroll_rows) == (0x26, 2, 3, 64)
    assert not chip.registers.scrolling
    assert chip.registers.inverted
    assert chip.violations == []


FORBIDDEN = [
    ("3F", "3F: a command neither of the SSD1306 nor"),
    ("B8", "B8: a command neither"),
    ("C1", "C1: a command neither"),
    ("20 03", "20 03: the addressing mode"),
    ("20 02 18", "18: there is no column past 127"),
    ("20 02 21 00 7F", "21 00 7F: windows are for"),
    ("20 02 22 00 07", "22 00 07: windows are for"),
    ("21 00 80", "21 00 80: there is no column past 127"),
    ("22 08 09", "22 08 09: there is no page past 7"),
    ("21 40 3F", "21 40 3F: the window starts after its end, at the columns"),
    ("22 05 04", "22 05 04: the window starts after its end, at the pages"),
    ("A8 0E", "A8 0E: the multiplex ratio"),
    ("A8 40", "A8 40: the multiplex ratio"),
    ("D3 40", "D3 40: the display offset"),
    ("8D 16", "8D 16: the charge pump takes"),
    ("26 01 00 00 03 00 FF", "the first argument of a scroll"),
    ("26 00 00 08 03 00 FF", "pages and interval"),
    ("27 00 08 00 03 00 FF", "pages and interval"),
    ("27 00 04 00 03 00 FF", "end page is before"),
    ("29 00 00 00 03 00", "vertical scroll offset"),
    ("A3 10 20 29 00 00 00 03 20", "vertical scroll offset"),
    ("A3 20 21", "fixed and the scrolling rows"),
    ("2F", "none was set up"),
    ("26 00 00 00 03 00 FF 2F 26 00 00 00 03 00 FF", "send 2E first"),
    ("26 00 00 00 03 00 FF 2F A3 00 40", "send 2E first"),
]


@pytest.mark.parametrize(("sent", "violation"), FORBIDDEN)
def test_what_endangers_the_picture_is_a_violation(sent: str, violation: str) -> None:
    chip = started()
    commands(chip, sent)
    assert [violation in text for text in chip.violations] == [True]
    assert chip.remarks == []


HARMLESS = [
    ("20 10", "20 10: the upper bits of the addressing mode"),
    ("B1 05 12 B2", "B1: the page pointer commands"),
    ("05", "05: the page pointer commands"),
    ("12", "12: the page pointer commands"),
    ("27 00 00 00 03 00 7F", "last arguments of a horizontal scroll"),
    ("D9 F0 D9 0F", "D9 F0: a precharge phase"),
    ("DA 00", "DA 00: the COM pins"),
    ("DB 40", "DB 40: the VCOMH level"),
    ("8D 10", "8D 10: the charge pump is switched while"),
    ("AE 8D 10 AF", "AF: display on before the panel has a supply"),
    ("AC", "AC: not a command of the SSD1306 (dim mode of the SSD1305)"),
    ("23 20", "23 20: not a command of the SSD1306 (fade"),
    ("AD 30", "AD 30: not a command of the SSD1306 (supply of the SH1106"),
    ("D6 01", "D6 01: not a command of the SSD1306 (zoom"),
]


@pytest.mark.parametrize(("sent", "remark"), HARMLESS)
def test_what_does_not_is_a_remark(sent: str, remark: str) -> None:
    chip = started()
    commands(chip, sent)
    assert [remark in text for text in chip.remarks] == [True]
    assert chip.violations == []


@pytest.mark.parametrize("sent", ["FD 12", "D8 05", "AD AF", "23 40", "D6 B3", "82 10", "DC A7", "91 AE 00 10 20"])
def test_a_command_of_a_relative_takes_its_arguments_with_it(sent: str) -> None:
    chip, plain = started(mode=2), started(mode=2)
    commands(chip, sent)
    commands(chip, "81 2A")
    commands(plain, "81 2A")
    assert chip.registers == plain.registers
    assert chip.violations == []


def test_a_panel_that_is_on_and_not_fed_is_told_so_when_it_gets_a_picture() -> None:
    chip = simulator.SSD1306()
    commands(chip, "AF 20 00")
    assert chip.violations == []
    chip.write(b"\x40\x00")
    assert chip.violations == ["a picture for a panel that is on without a supply (8D 14) stays dark"]


@pytest.mark.parametrize(
    "sent",
    ["8D 54", "8D 94", "DB 00", "DB 30", "A8 0F", "DA 22", "DA 32", "E3", "D5 F0", "20 01", "26 00 03 07 03 00 FF"],
)
def test_what_the_datasheet_allows_is_not(sent: str) -> None:
    chip = simulator.SSD1306()
    commands(chip, sent)
    assert chip.violations == []


@pytest.mark.parametrize(
    ("payload", "violation"),
    [
        ("01 AE", "01: the lower six bits of a control byte are 0"),
        ("80", "80: a byte must follow this control byte"),
        ("80 A4 C0", "C0: a byte must follow this control byte"),
    ],
)
def test_broken_control_bytes_are_recorded(payload: str, violation: str) -> None:
    chip = started()
    chip.write(bytes.fromhex(payload))
    assert [violation in text for text in chip.violations] == [True]


def test_data_in_the_middle_of_a_command_is_recorded_and_the_command_waits_on() -> None:
    chip = started()
    commands(chip, "81")
    chip.write(b"\x40\x12")
    commands(chip, "33")
    assert chip.violations == ["81: data while a command waits for its arguments"]
    assert chip.contrast == 0x33


def test_data_while_a_scroll_runs_is_recorded() -> None:
    chip = started()
    commands(chip, "26 00 00 00 07 00 FF 2F")
    chip.write(b"\x40\x00")
    assert chip.violations == ["data while a scroll is running; send 2E first"]


def test_a_violation_is_listed_once_and_again_after_clearing() -> None:
    chip = started()
    for _ in range(3):
        commands(chip, "D3 40 A8 0E D3 41")
    assert len(chip.violations) == 2
    chip.violations.clear()
    commands(chip, "D3 41")
    assert chip.violations == ["D3 41: the display offset is 00 to 3F"]


def test_a_rule_speaks_once_whatever_bytes_break_it() -> None:
    chip = started()
    for start in range(128):
        for end in range(start):
            chip.write(bytes([0x00, 0x21, start, end]))
    assert chip.violations == ["21 01 00: the window starts after its end, at the columns"]


@given(st.lists(st.binary(max_size=40), max_size=12))
def test_no_bytes_upset_the_chip(payloads: list[bytes]) -> None:
    chip = simulator.SSD1306()
    for payload in payloads:
        chip.write(payload)
        chip.settle(0.0, len(payload) + 1)
    assert chip.pixels.shape == (64, 128)
    assert set(np.unique(chip.pixels)) <= {0, 1}
    registers = chip.registers
    assert 0 <= registers.column < 128
    assert 0 <= registers.page < 8


@pytest.mark.parametrize(
    ("arguments", "name"),
    [
        ({"width": 100, "height": 30}, "width and height"),
        ({"width": 129, "height": 64, "column_offset": 0, "com_pins": 0x12}, "width and height"),
        ({"width": 96, "height": 65, "column_offset": 0, "com_pins": 0x12}, "width and height"),
        ({"width": 96, "height": 16, "column_offset": 33}, "column_offset"),
        ({"com_pins": 0x42}, "com_pins"),
    ],
)
def test_impossible_modules_are_refused(arguments: dict[str, int], name: str) -> None:
    with pytest.raises(ValueError, match=name):
        simulator.SSD1306(**arguments)  # type: ignore[arg-type]


def test_what_is_handed_out_cannot_be_written_to() -> None:
    chip = started()
    with pytest.raises(ValueError, match="read-only"):
        chip.pixels[0, 0] = 1
    chip.ram[:] = 0
    assert chip.ram.any()
