"""OLED chips of 16 grays, two pixels a byte, addressed by windows."""

from __future__ import annotations

from paneldraw.controllers.chip import Chip, Module
from paneldraw.controllers.record import Contrast, Window


def _ssd1327_window(m: Module) -> Window:
    return Window(columns=0x15, rows=0x75, across=bytes((0xA0, m.remap)), down=bytes((0xA0, m.remap | 0x04)))


SSD1327 = Chip(
    name="SSD1327",
    about="OLED, 16 grays; 1.5-inch modules",
    ram=(128, 128),
    modules={(128, 128): {}, (96, 96): {"column_offset": 16, "first_com": 32}},
    remap=(0x51, 0x03, 0x10),  # split COM lines, reversed, columns from the right
    init=lambda m: (
        f"FD 12, AE, A8 {m.multiplex}, A1 00, A2 {m.offset}, A0 {m.remap:02X}, AB 01, 81 53, B1 51, "
        "B3 01, B9, BC 08, BE 07, B6 01, D5 62, A4"
    ),
    overrides=("first_com",),
    window=_ssd1327_window,
    drive=lambda m: ("B1 51, BC 08, BE 07", "B1 51, BC 00, BE 00", "B1 21, BC 00, BE 00", "B1 11, BC 00, BE 00"),
    facts={"packing": "nibbles", "resync": b"\xb2" * 15, "normal": b"\xa4"},
)

SSD1322 = Chip(
    name="SSD1322",
    about="OLED, 16 grays, on SPI; 256x64 modules",
    ram=(480, 128),
    modules={(256, 64): {"column_offset": 112}},
    remap=(0x14, 0x02, 0x10),  # columns from the left, nibbles in order, lines from the last, as vendors' code has it
    init=lambda m: (
        f"FD 12, AE, B3 91, CA {m.multiplex}, A2 00, A1 00, AB 01, B4 A0 FD, C1 9F, C7 0F, B9, B1 E2, D1 A2 20, "
        f"BB 1F, B6 08, BE 07, A6, A9, A0 {m.remap:02X} 11"
    ),
    window=lambda m: Window(
        columns=0x15,
        rows=0x75,
        across=bytes((0xA0, m.remap, 0x11)),
        down=bytes((0xA0, m.remap | 0x01, 0x11)),
        column_bytes=2,
        write=b"\x5c",
    ),
    buses=("spi",),
    contrast=Contrast(command=b"\xc1"),
    drive=lambda m: ("B1 E2, BB 1F, BE 07", "B1 E2, BB 00, BE 00", "B1 32, BB 00, BE 00"),
    facts={"packing": "nibbles", "arguments_are_data": True, "resync": b""},  # D/C low always begins a command
)
