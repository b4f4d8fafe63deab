"""OLED chips of one bit a pixel: Solomon Systech's SSD130x and SSD131x, Sino Wealth's SH110x."""

from __future__ import annotations

from paneldraw.controllers.chip import Chip, Module
from paneldraw.controllers.record import PagePointer, Window

#: The two ways of the SSD130x: pages, or windows filled across and down.
_PAGES = PagePointer(mode=b"\x20\x02", wraps=True)


def _windows(module: Module) -> Window:
    return Window(columns=0x21, rows=0x22, across=b"\x20\x00", down=b"\x20\x01")


def _ssd1306(m: Module) -> str:
    reference = "AD 30, " if m.internal_reference else ""
    pump, drive = ("8D 14", "81 CF, D9 F1") if m.charge_pump else ("8D 10", "81 9F, D9 22")
    return (
        f"AE, D5 {m.clock:02X}, A8 {m.multiplex}, D3 {m.offset}, 40, {pump}, {reference}20 02, "
        f"{m.segments}, {m.lines}, DA {m.com_pins:02X}, {drive}, DB 30, 2E, A4, A6"
    )


SSD1306 = Chip(
    name="SSD1306",
    about="OLED, 1 bit a pixel, with a charge pump; the chip of most small modules",
    ram=(128, 64),
    modules={
        (128, 64): {},
        (128, 32): {"com_pins": 0x02},
        (96, 16): {"com_pins": 0x02, "clock": 0x60},
        (72, 40): {"column_offset": 28, "internal_reference": True},
        (64, 48): {"column_offset": 32},
        (64, 32): {"column_offset": 32},
        (48, 64): {"column_offset": 40},
    },
    init=_ssd1306,
    overrides=("first_com", "com_pins", "charge_pump", "internal_reference"),
    pointer=_PAGES,
    window=_windows,
    drive=lambda m: (f"D9 {'F1' if m.charge_pump else '22'}, DB 30", "D9 F1, DB 00", "D9 22, DB 00", "D9 11, DB 00"),
)

SSD1309 = Chip(
    name="SSD1309",
    about="OLED, 1 bit a pixel, fed with the panel voltage from outside; 2.42-inch modules, which need reset=",
    ram=(128, 64),
    modules={(128, 64): {}},
    init=lambda m: (
        f"AE, D5 A0, A8 {m.multiplex}, D3 {m.offset}, 40, 20 02, {m.segments}, {m.lines}, DA {m.com_pins:02X}, "
        "81 6F, D9 D3, DB 20, 2E, A4, A6"
    ),
    overrides=("first_com", "com_pins"),
    pointer=_PAGES,
    window=_windows,
    drive=lambda m: ("D9 D3, DB 20", "D9 D3, DB 00", "D9 22, DB 00", "D9 11, DB 00"),
)

SH1106 = Chip(
    name="SH1106",
    about="OLED, 1 bit a pixel, 132 columns of RAM; most 1.3-inch modules",
    ram=(132, 64),
    modules={(128, 64): {"column_offset": 2}},
    init=lambda m: (
        f"AE, A4, D5 50, A8 {m.multiplex}, D3 {m.offset}, 40, AD {'8B' if m.charge_pump else '8A'}, D9 22, DB 35, 32, "
        f"81 FF, A6, DA {m.com_pins:02X}, {m.segments}, {m.lines}"
    ),
    overrides=("first_com", "com_pins", "charge_pump"),
    pointer=PagePointer(),
    drive=lambda m: ("D9 22, DB 35", "D9 22, DB 00", "D9 11, DB 00"),
)
