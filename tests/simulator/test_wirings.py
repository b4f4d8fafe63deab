"""Modules that are wired in other ways: drivers that are made for them put the picture upright on their glass."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from paneldraw import Panel, controllers, simulator
from paneldraw.transports import I2CTransport

from .helpers import pack, random_picture

# chip, size, wiring, commands before the picture, first column sent: as public drivers have them
WIRINGS: list[tuple[str, tuple[int, int], dict[str, int], str, int]] = [
    # U8g2, u8x8_d_ssd1306_64x32.c: "noname" drives 48 lines of which the glass has the upper 32, "1f" drives 32
    ("SSD1306", (64, 32), {"first_com": 16}, "A8 2F D3 00 40 8D 14 20 02 A1 C8 DA 12", 32),
    ("SSD1306", (64, 32), {}, "A8 1F D3 00 40 8D 14 20 02 A1 C8 DA 12", 32),
    # 128x32 at the far end of the chip's COM lines
    ("SSD1306", (128, 32), {"first_com": 32}, "A8 1F D3 20 40 8D 14 20 02 A1 C8 DA 02", 0),
    ("SSD1306", (128, 32), {"first_com": 32}, "A8 3F D3 00 40 8D 14 20 02 A1 C8 DA 02", 0),
    # U8g2, u8x8_d_ssd1306_96x40.c: 96x39 drives a line more than there is, and starts a row earlier for it
    ("SSD1306", (96, 39), {}, "A8 27 D3 00 7F 8D 14 20 02 A1 C8 DA 10", 32),
    ("SSD1306", (96, 40), {}, "A8 27 D3 00 40 8D 14 20 02 A1 C8 DA 02", 0),
    # U8g2, u8x8_d_ssd1309.c: modules whose RAM has 132 columns
    ("SSD1309", (128, 64), {"column_offset": 2}, "D5 A0 40 20 02 A1 C8 DA 12 81 6F D9 D3 DB 20 2E A4 A6", 2),
    # U8g2, u8x8_d_ssd1316.c
    ("SSD1316", (128, 32), {}, "40 81 45 A6 A8 1F A1 C0 D3 00 D5 80 D9 22 DA 12 DB 20 8D 15 2E", 0),
    ("SSD1316", (96, 32), {}, "40 81 45 A6 A8 1F A1 C0 D3 00 D5 80 D9 22 DA 12 DB 20 8D 15 2E", 0),
    ("SSD1316", (96, 39), {}, "40 A6 A8 26 A1 C0 D3 00 DA 12 8D 15", 0),
    # luma.oled, sh1106: a line more than the glass has
    ("SH1106", (128, 32), {}, "AE 20 10 B0 C8 00 10 40 A1 A6 A8 20 A4 D3 0F D5 F0 D9 22 DA 12 DB 20 8D 14", 2),
    # U8g2, u8x8_d_sh1106_72x40.c and u8x8_d_sh1106_64x32.c
    ("SH1106", (72, 40), {}, "AE D5 80 A8 27 D3 0C 40 AD 8B 33 20 00 A1 C8 DA 12 81 80 D9 22 DB 28 2E A4 A6", 30),
    ("SH1106", (64, 32), {}, "AE D5 80 A8 1F D3 00 40 AD 8B 33 20 00 A1 C8 DA 12 81 80 D9 22 DB 28 2E A4 A6", 32),
]
TURNED = [
    ("SSD1309", (128, 64), {"column_offset": 2}, "A0 C0", 2),
    ("SSD1316", (128, 32), {}, "A8 1F 8D 15 A0 C8", 0),
    ("SH1106", (72, 40), {}, "A8 27 A0 C0 D3 34", 30),
    ("SH1106", (64, 32), {}, "A8 1F A0 C0 D3 00", 36),
    ("SSD1306", (96, 39), {}, "A8 27 8D 14 A0 C0 40", 0),
]


def shown(name: str, size: tuple[int, int], wiring: dict[str, int], start: str, left: int) -> tuple[Any, Any]:
    chip, picture = getattr(simulator, name)(*size, **wiring), random_picture(*size, 1)
    chip.write(b"\x00" + bytes.fromhex(start) + b"\xaf")
    for page, row in enumerate(pack(picture)):
        chip.write(bytes([0x00, 0xB0 | page, left & 15, 0x10 | left >> 4]))
        chip.write(b"\x40" + row.tobytes())
    return chip, picture


@pytest.mark.parametrize(("name", "size", "wiring", "start", "left"), WIRINGS)
def test_upright(name: str, size: tuple[int, int], wiring: dict[str, int], start: str, left: int) -> None:
    chip, picture = shown(name, size, wiring, start, left)
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []


@pytest.mark.parametrize(("name", "size", "wiring", "start", "left"), TURNED)
def test_turned(name: str, size: tuple[int, int], wiring: dict[str, int], start: str, left: int) -> None:
    chip, picture = shown(name, size, wiring, start, left)
    assert np.array_equal(chip.pixels, picture[::-1, ::-1])


@pytest.mark.parametrize(
    ("name", "size", "wiring"),
    [
        ("SSD1306", (64, 32), {"first_com": 16}),
        ("SSD1306", (128, 32), {"first_com": 32}),
        ("SSD1306", (96, 39), {"column_offset": 32, "com_pins": 0x12}),
        ("SH1106", (128, 32), {"column_offset": 2, "com_pins": 0x12, "first_com": 16}),
        ("SH1106", (72, 40), {"column_offset": 30, "com_pins": 0x12, "first_com": 12}),
        ("SH1106", (64, 32), {"column_offset": 32, "com_pins": 0x12}),
    ],
)
@pytest.mark.parametrize("mirrors", [{}, {"mirror_x": True}, {"mirror_y": True}])
def test_our_driver_with_the_same_overrides(
    name: str, size: tuple[int, int], wiring: dict[str, int], mirrors: dict[str, bool]
) -> None:
    chip = getattr(simulator, name)(*size, **wiring)
    record = getattr(controllers, name)(*size, **wiring, **mirrors)
    picture = random_picture(*size, 2)
    Panel(record, I2CTransport(simulator.I2CBus({0x3C: chip}, timer=None))).show(picture)
    expected = picture[:, ::-1] if "mirror_x" in mirrors else picture[::-1] if "mirror_y" in mirrors else picture
    assert np.array_equal(chip.pixels, expected)
    assert chip.violations == []


def test_a_window_of_look_alikes_reaches_their_last_column() -> None:
    chip = simulator.SSD1309(column_offset=2)
    chip.write(bytes.fromhex("00 20 00 A1 C8 21 02 81 22 00 07 AF"))
    picture = random_picture(128, 64, 3)
    chip.write(b"\x40" + pack(picture).tobytes())
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []
    with pytest.raises(ValueError, match="column_offset: 5 is not 0 to 0"):
        simulator.SSD1309(column_offset=5)


def test_what_the_ssd1316_has_not() -> None:
    chip = simulator.SSD1316()
    chip.write(bytes.fromhex("00 8D 15 A8 1F B5"))
    assert chip.violations == ["B5: not a command of the SSD1316 (pages past 4 of the SSD1306); ignored"]
    chip.write(bytes.fromhex("00 A8 3F"))
    assert "the multiplex ratio is 0F to 26" in chip.violations[1]
