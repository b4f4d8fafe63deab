"""OLED chips of one bit a pixel: Solomon Systech's SSD130x and SSD131x, Sino Wealth's SH110x, Chip Wealth's CH1115.

The commands are those of the datasheets; sizes, offsets and drive of modules are those that public drivers send: U8g2
(``csrc/u8x8_d_*.c``), luma.oled (``luma/oled/device``), Zephyr (``drivers/display``), Linux
(``drivers/gpu/drm/solomon``) and Adafruit's. Where they disagree it says so.
"""

from __future__ import annotations

from typing import Any, Final

from paneldraw.controllers.chip import Chip, Module
from paneldraw.controllers.record import Effect, PagePointer, Scroll, Window

#: The two ways of the SSD130x: pages, or windows filled across and down.
_PAGES = PagePointer(mode=b"\x20\x02", wraps=True)
_WIRING: Final = ("first_com", "com_pins")
_ALL_ON: Final = {"all_on": b"\xa5", "follow": (b"\xa4",)}
_AREA: Final = "A3 {top} {height}"

#: The scrolls of the SSD1306 and SSD1305, and those of the SSD1309 and of the SSD1315 and SSD1316, which have columns.
_SCROLL = Scroll(
    across="26 00 {first} {speed} {last} 00 FF",
    diagonal="29 00 {first} {speed} {last} {rows}",
    area=_AREA,
    frames=(5, 64, 128, 256, 3, 4, 25, 2),
)
_SCROLL_1305 = Scroll(
    across="26 01 {first} {speed} {last}",
    diagonal="29 {columns} {first} {speed} {last} {rows}",
    area=_AREA,
    frames=(6, 32, 64, 128),  # as Microchip's graphics library has them; codes 4 to 7 are not known for sure
)
_SCROLL_1309 = Scroll(
    across="26 00 {first} {speed} {last} 00 {left} {right}",
    diagonal="29 {columns} {first} {speed} {last} {rows} {left} {right}",
    area=_AREA,
    once="2C 00 {first} 01 {last} 00 {left} {right}",
    frames=(5, 64, 128, 256, 2, 3, 4, 1),
)
_SCROLL_1315 = Scroll(
    across="26 00 {first} {speed} {last} {left} {right}",
    diagonal="29 {columns} {first} {speed} {last} {rows} {left} {right}",
    area=_AREA,
    once="2C 00 {first} 01 {last} {left} {right}",
    frames=(6, 32, 64, 128, 3, 4, 5, 2),
)


def _effect(mode: int) -> Effect:
    """Fading (20) or blinking (30) by steps of 128 frames down to 8."""
    return Effect(speeds=tuple(bytes((0x23, mode + step)) for step in range(15, -1, -1)), off=b"\x23\x00")


_LATER: Final[dict[str, Any]] = {**_ALL_ON, "scroll": _SCROLL_1315, "fade": _effect(0x20), "blink": _effect(0x30)}
"""What the SSD1315 and SSD1316 do by themselves."""


def _windows(module: Module) -> Window:
    return Window(columns=0x21, rows=0x22, across=b"\x20\x00", down=b"\x20\x01")


def _pumped(m: Module, pump: str = "14") -> str:
    """The init of the SSD1306 and its relatives with a charge pump, by the argument that switches it on."""
    reference = "AD 30, " if m.internal_reference else ""
    supply, drive = (f"8D {pump}", "81 CF, D9 F1") if m.charge_pump else ("8D 10", "81 9F, D9 22")
    return (
        f"AE, D5 {m.clock:02X}, A8 {m.multiplex}, D3 {m.offset}, 40, {supply}, {reference}20 02, "
        f"{m.segments}, {m.lines}, DA {m.com_pins:02X}, {drive}, DB 30, 2E, A4, A6"
    )


def _pumped_drive(m: Module) -> tuple[str, ...]:
    return f"D9 {'F1' if m.charge_pump else '22'}, DB 30", "D9 F1, DB 00", "D9 22, DB 00", "D9 11, DB 00"


#: What the SSD1306 and its relatives with a charge pump have in common.
_PUMPED: Final[dict[str, Any]] = {
    "init": _pumped,
    "overrides": (*_WIRING, "charge_pump", "internal_reference"),
    "pointer": _PAGES,
    "window": _windows,
    "drive": _pumped_drive,
}

SSD1306 = Chip(
    name="SSD1306",
    about="OLED, 1 bit a pixel, with a charge pump; the chip of most small modules",
    ram=(128, 64),
    modules={
        (128, 64): {},
        (128, 32): {"com_pins": 0x02},
        (96, 16): {"com_pins": 0x02, "clock": 0x60},  # Adafruit's driver has it at column 16, U8g2 and luma.oled at 0
        (96, 39): {"column_offset": 32},
        (96, 40): {"com_pins": 0x02},
        (72, 40): {"column_offset": 28, "internal_reference": True},
        (64, 48): {"column_offset": 32},
        (64, 32): {"column_offset": 32},
        (48, 64): {"column_offset": 40},
    },
    **_PUMPED,
    facts={**_ALL_ON, "scroll": _SCROLL},
)

SSD1315 = Chip(
    name="SSD1315",
    about="OLED, 1 bit a pixel; what newer modules have that are sold as SSD1306",
    ram=(128, 64),
    # U8g2 sends AD 10 always, Zephyr where it is asked to, and luma.oled, as here, drives it as an SSD1306.
    modules=SSD1306.modules,
    **_PUMPED,
    facts=_LATER,
)

SSD1312 = Chip(
    name="SSD1312",
    about="OLED, 1 bit a pixel, of ultra-thin and 1.7-inch modules",
    ram=(128, 64),
    # U8g2's u8x8_d_ssd1312.c: all start at COM 16 (D3 30). It doubts its own COM pins 12 since issue 2690.
    modules={
        (128, 64): {},
        (128, 32): {"first_com": 16},
        (120, 32): {"first_com": 16},
        (120, 28): {"first_com": 16},
    },
    upright=(0xA1, 0xC0),
    **_PUMPED,
    facts=_ALL_ON,
)

SSD1316 = Chip(
    name="SSD1316",
    about="OLED, 1 bit a pixel, 39 rows of RAM",
    ram=(128, 39),
    modules={(128, 32): {}, (96, 32): {}, (128, 39): {}, (96, 39): {}},
    # As in U8g2; luma.oled drives it as an SSD1306, with C8, COM pins 02 and 8D 14.
    upright=(0xA1, 0xC0),
    **{**_PUMPED, "init": lambda m: _pumped(m, "15")},
    facts=_LATER,
)

SSD1309 = Chip(
    name="SSD1309",
    about="OLED, 1 bit a pixel, fed with the panel voltage from outside; 2.42-inch modules, which need reset=",
    ram=(128, 64),
    wide=132,  # U8g2's "noname2" modules begin at column 2
    modules={(128, 64): {}},
    init=lambda m: (
        f"AE, D5 A0, A8 {m.multiplex}, D3 {m.offset}, 40, 20 02, {m.segments}, {m.lines}, DA {m.com_pins:02X}, "
        "81 6F, D9 D3, DB 34, 2E, A4, A6"
    ),
    overrides=_WIRING,
    pointer=_PAGES,
    window=_windows,
    drive=lambda m: ("D9 D3, DB 34", "D9 D3, DB 00", "D9 22, DB 00", "D9 11, DB 00"),
    facts={**_ALL_ON, "scroll": _SCROLL_1309},
)

SSD1305 = Chip(
    name="SSD1305",
    about="OLED, 1 bit a pixel, 132 columns of RAM, fed from outside; 2.3-inch modules",
    ram=(132, 64),
    # U8g2 has 128x64 at column 2, of Raystar's at 4, and luma.oled at 0; 128x32 at 4, of unnamed ones at 2.
    modules={(128, 64): {"column_offset": 2}, (128, 32): {"column_offset": 4}},
    # AD 8E is what the datasheet asks for after a reset and Adafruit's driver sends. U8g2's DB 40 is not in the sheet.
    init=lambda m: (
        f"AE, D5 F0, A8 {m.multiplex}, D3 {m.offset}, 40, AD 8E, 20 02, {m.segments}, {m.lines}, "
        f"DA {m.com_pins:02X}, 81 32, 82 80, D9 F1, DB 34, 2E, A4, A6"
    ),
    overrides=_WIRING,
    pointer=_PAGES,
    window=_windows,
    drive=lambda m: ("D9 F1, DB 34", "D9 F1, DB 00", "D9 22, DB 00", "D9 11, DB 00"),
    facts={**_ALL_ON, "scroll": _SCROLL_1305},
)

SH1106 = Chip(
    name="SH1106",
    about="OLED, 1 bit a pixel, 132 columns of RAM; most 1.3-inch modules",
    ram=(132, 64),
    # 128x32 as luma.oled and U8g2's "visionox" have it, the smaller ones from U8g2's u8x8_d_sh1106_*.c.
    modules={
        (128, 64): {"column_offset": 2},
        (128, 32): {"column_offset": 2, "first_com": 16},
        (72, 40): {"column_offset": 30, "first_com": 12},
        (64, 32): {"column_offset": 32},
    },
    init=lambda m: (
        f"AE, A4, D5 50, A8 {m.multiplex}, D3 {m.offset}, 40, AD {'8B' if m.charge_pump else '8A'}, D9 22, DB 35, 32, "
        f"81 FF, A6, DA {m.com_pins:02X}, {m.segments}, {m.lines}"
    ),
    overrides=(*_WIRING, "charge_pump"),
    pointer=PagePointer(),
    drive=lambda m: ("D9 22, DB 35", "D9 22, DB 00", "D9 11, DB 00"),
    facts=_ALL_ON,
)

SH1107 = Chip(
    name="SH1107",
    about="OLED, 1 bit a pixel, upright; 1.12-inch and 64x128 modules",
    ram=(128, 128),
    transposed=True,
    # Columns are COM lines: what other drivers call an offset of 96 or D3 60 is where the glass begins. U8g2 and
    # luma.oled drive all 128 lines of a 64x128, Adafruit's driver, as here, those of the glass.
    modules={(64, 128): {"column_offset": 32}, (128, 128): {}, (80, 128): {"column_offset": 24}},
    upright=(0xA0, 0xC0),
    init=lambda m: (
        f"AE, DC 00, 81 7F, 20, {m.segments}, {m.lines}, A8 {m.multiplex}, D3 {m.offset}, D5 51, D9 22, DB 35, A4, A6"
    ),
    pointer=PagePointer(wraps=True),
    drive=lambda m: ("D9 22, DB 35", "D9 22, DB 00", "D9 11, DB 00"),
    facts=_ALL_ON,
)

CH1115 = Chip(
    name="CH1115",
    about="OLED, 1 bit a pixel; 1.09-inch modules",
    ram=(128, 64),
    wide=132,  # luma.oled begins at column 2 of 132; EastRising's module is at 0, and turned (mirror_x=1, mirror_y=1)
    modules={(128, 64): {}},
    # No DA, which luma.oled sends, is in G. Lyons' list of the chip's commands (github.com/gavinlyonsrepo, ER_OLEDM1).
    init=lambda m: (
        f"AE, D5 80, A8 {m.multiplex}, D3 {m.offset}, 40, AD {'8B' if m.charge_pump else '8A'}, {m.segments}, "
        f"{m.lines}, 81 7F, D9 22, DB 20, 2E, A4, A6"
    ),
    overrides=("first_com", "charge_pump"),
    pointer=PagePointer(),
    drive=lambda m: ("D9 22, DB 20", "D9 22, DB 00", "D9 11, DB 00"),
    facts=_ALL_ON,
)
