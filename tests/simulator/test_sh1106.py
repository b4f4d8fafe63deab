"""The SH1106 by its datasheet: the page pointer, what it does not know, and luma.oled's driver for it."""

from __future__ import annotations

import numpy as np
import pytest
import smbus2

from paneldraw import simulator

from .helpers import pack, random_picture

ADDRESS = 0x3C


def started(**options: object) -> simulator.SH1106:
    chip = simulator.SH1106(**options)  # type: ignore[arg-type]
    commands(chip, "AE AD 8B A1 C8 DA 12 AF")
    return chip


def commands(chip: simulator.SH1106, text: str) -> None:
    chip.write(b"\x00" + bytes.fromhex(text))


def test_the_pointer_runs_through_132_columns_of_one_page() -> None:
    chip = started()
    commands(chip, "B3 00 10")
    chip.write(b"\x40" + bytes(range(132)))
    assert chip.ram[3, ::-1].tolist() == list(range(132))
    commands(chip, "B3 03 18")
    chip.write(b"\x40\xaa")
    assert chip.ram[3, 0] == 0xAA
    assert chip.violations == []


def test_data_past_the_last_column_is_lost_and_recorded() -> None:
    chip = started()
    before = chip.ram
    commands(chip, "B3 03 18")
    chip.write(b"\x40\xaa\xbb")
    assert chip.violations == ["data past column 131 is lost"]
    assert np.count_nonzero(chip.ram != before) <= 1


def test_a_picture_starts_at_column_2() -> None:
    chip = started()
    picture = random_picture(128, 64, 1)
    for page, row in enumerate(pack(picture)):
        commands(chip, f"{0xB0 + page:02X} 02 10")
        chip.write(b"\x40" + row.tobytes())
    assert np.array_equal(chip.pixels, picture)
    commands(chip, "C0")
    assert np.array_equal(chip.pixels, picture[::-1])
    commands(chip, "A7")
    assert np.array_equal(chip.pixels, 1 - picture[::-1])
    commands(chip, "A5")
    assert chip.pixels.all()


@pytest.mark.parametrize(
    ("sent", "text"),
    [
        ("21 00 7F", "21 00 7F: not a command of the SH1106 (windows of the SSD1306)"),
        ("26 00 00 00 07 00 FF 2F", "2F: not a command of the SH1106 (scroll of the SSD1306)"),
        ("A8 40", "A8 40: the multiplex ratio is 00 to 3F"),
    ],
)
def test_what_endangers_the_picture(sent: str, text: str) -> None:
    chip = started()
    commands(chip, sent)
    assert [violation.startswith(text) for violation in chip.violations] == [True]


@pytest.mark.parametrize(
    ("sent", "text"),
    [
        ("20 02", "20 02: not a command of the SH1106 (addressing mode of the SSD1306); ignored"),
        ("8D 14", "8D 14: not a command of the SH1106 (charge pump of the SSD1306)"),
        ("2E", "2E: not a command of the SH1106 (scroll of the SSD1306)"),
        ("AD 30", "AD 30: the DC-DC converter takes 8A"),
        ("AD 8A", "AD 8A: the DC-DC converter is switched while the display is off"),
        ("D9 20", "D9 20: a precharge phase of 0 clocks"),
        ("EE", "EE: the end of a read-modify-write that was not begun"),
    ],
)
def test_what_is_merely_not_in_the_sheet(sent: str, text: str) -> None:
    chip = started()
    commands(chip, sent)
    assert [remark.startswith(text) for remark in chip.remarks] == [True]
    assert chip.violations == []


def test_a_reference_current_meant_for_another_chip_leaves_it_lit() -> None:
    chip = started()
    commands(chip, "A5 AD 30")
    assert chip.pixels.all()


def test_read_modify_write_returns_to_its_column() -> None:
    chip = started()
    commands(chip, "B0 05 11 E0")
    chip.write(b"\x40\x01\x02")
    commands(chip, "EE")
    assert chip.registers.column == 0x15
    assert chip.violations == []


def test_without_converter_the_panel_is_dark_unless_it_has_its_own_supply() -> None:
    for chip in (simulator.SH1106(), simulator.SH1106(external_vcc=True)):
        commands(chip, "AD 8A A5 AF")
        assert chip.pixels.all() == chip.external_vcc


def test_sizes_and_offsets_that_cannot_be() -> None:
    with pytest.raises(ValueError, match="64x48 is no module"):
        simulator.SH1106(64, 48)
    with pytest.raises(ValueError, match="column_offset: 5"):
        simulator.SH1106(column_offset=5)


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
def test_luma(monkeypatch: pytest.MonkeyPatch) -> None:
    from luma.core.interface.serial import i2c
    from luma.oled.device import sh1106
    from PIL import Image

    chip = simulator.SH1106()
    bus = simulator.I2CBus({ADDRESS: chip}, timer=None)
    monkeypatch.setattr(smbus2, "SMBus", lambda port: bus)
    device = sh1106(i2c(port=1))
    device.persist = True
    for seed in range(3):
        picture = random_picture(128, 64, seed)
        before = bus.bytes, bus.messages
        device.display(Image.fromarray(picture * 255).convert("1"))
        assert np.array_equal(chip.pixels, picture)
        assert (bus.bytes - before[0], bus.messages - before[1]) == (8 * (5 + 130), 16)
    device.contrast(0x21)
    assert chip.contrast == 0x21
    assert chip.violations == []
    assert chip.remarks == [
        "20 10: not a command of the SH1106 (addressing mode of the SSD1306); ignored",
        "8D 14: not a command of the SH1106 (charge pump of the SSD1306); ignored",
    ]
