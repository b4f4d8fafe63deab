"""LCD chips of one bit a pixel.

Facts are those of the datasheets (Philips PCD8544, Sitronix ST7565P/R/S, ST7567 and ST7920, UltraChip UC1701x and
UC1609c), of U8g2 (csrc/u8x8_d_NAME.c) and of luma.lcd (device.py).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from paneldraw.controllers.chip import Chip, Module
from paneldraw.controllers.record import Contrast, PagePointer

_LEVELS = Contrast(highest=63)
_BIASES = {65: (9, 7), 55: (8, 6), 53: (8, 6), 49: (8, 6), 33: (6, 5)}
"""What A2 and A3 are, by duty."""


def _bias(m: Module) -> str:
    """Command of the bias of chips whose pins choose the duty, in hex."""
    biases = _BIASES[m.duty]
    if m.bias not in biases:
        raise ValueError(
            f"bias of the {m.chip.name} must be {biases[0]} or {biases[1]} at a duty of {m.duty}, not {m.bias}"
        )
    return f"{0xA2 + biases.index(m.bias):02X}"


def _paged(m: Module, power: str = "2C, 50 ms, 2E, 50 ms, 2F, 50 ms", more: str = "") -> str:
    """Start of the ST756x and their relatives, dark: display off and all points on is their sleep."""
    if m.height > 64 and m.mirror_y:
        raise ValueError("mirror_y must be False where there are 65 rows: the last is that of icons, and does not move")
    return (
        f"E2, AE, {m.start_line}, {m.segments}, {m.lines}, A6, {_bias(m)}, {power}, F8 00, "
        f"{0x20 + m.resistor_ratio:02X}, 81 {m.level:02X}, {more}A5"
    )


_ALL_ON: Mapping[str, Any] = {"all_on": b"\xa5", "follow": (b"\xa4",)}
_PAGED: Mapping[str, Any] = {
    "resync": b"\x00",
    "power_on": b"\xa4\xaf",
    "power_off": b"\xae\xa5",
    "status_off": 0,
    **_ALL_ON,
}
_OVERRIDES = ("first_com", "duty", "bias", "resistor_ratio")

PCD8544 = Chip(
    name="PCD8544",
    about="LCD of the Nokia 5110, on SPI; needs reset=",
    ram=(84, 48),
    modules={(84, 48): {"bias": 8}},  # the sheet's bias at 48 lines, and U8g2's; luma.lcd and Adafruit take 7
    # Dark by power-down, so that the display mode is left to inversion.
    init=lambda m: f"21, 06, {0x1B - m.bias:02X}, C0, 20, 0C, 24",
    overrides=("bias",),
    mirrors=False,
    pointer=PagePointer(row=0x40, column=0x80, turns=True),
    buses=("spi",),
    contrast=Contrast(command=b"\x80", added=True, highest=127, before=(b"\x21",), after=(b"\x20",)),
    facts={
        "resync": b"",
        "power_on": b"\x20",
        "power_off": b"\x24",
        "normal": b"\x0c",
        "inverse": b"\x0d",
        "speed": 4_000_000,
    },
)

# The power supply rises in three steps, as Adafruit's ST7565 and U8g2's ST7567 have it; U8g2's ST7565 sends 2F alone.
ST7565 = Chip(
    name="ST7565",
    about="LCD, on SPI; DOGM128, LM6063 and the like; ZOLEN: mirror_y=1; NHD-C12864, 64128N: column_offset=4",
    ram=(132, 65),
    modules={
        (128, 64): {"bias": 9, "resistor_ratio": 7, "level": 0x18},
        (128, 32): {"column_offset": 4, "duty": 33, "bias": 6, "resistor_ratio": 3, "level": 0x0A},
        (132, 64): {"bias": 9, "resistor_ratio": 7, "level": 0x18},
    },
    init=_paged,
    overrides=_OVERRIDES,
    upright=(0xA1, 0xC0),
    pointer=PagePointer(),
    buses=("spi",),
    contrast=_LEVELS,
    facts=_PAGED,
)

# Of 64x32 modules U8g2 has the offset 32 in one place and 36, 32 upside down, in another: only the latter is one glass.
ST7567 = Chip(
    name="ST7567",
    about="LCD; JLX12864 and the like, at 0x3F on I2C",
    ram=(132, 65),
    modules={
        (128, 64): {"column_offset": 4, "bias": 7, "resistor_ratio": 3, "level": 0x0A},
        (132, 64): {"bias": 7, "resistor_ratio": 6, "level": 0x27},
        (132, 32): {"duty": 33, "bias": 5, "resistor_ratio": 6, "level": 0x27},
        (128, 32): {"column_offset": 4, "duty": 33, "bias": 5, "resistor_ratio": 3, "level": 0x0A},
        (122, 32): {"column_offset": 4, "first_com": 32, "bias": 9, "resistor_ratio": 3, "level": 0x0A},
        (96, 65): {"bias": 7, "resistor_ratio": 3, "level": 0x0A},
        (64, 32): {"column_offset": 36, "duty": 33, "bias": 6, "resistor_ratio": 4, "level": 0x20},
    },
    init=_paged,
    overrides=_OVERRIDES,
    upright=(0xA1, 0xC0),
    pointer=PagePointer(),
    contrast=_LEVELS,
    facts=_PAGED,
)

# U8g2 and luma.lcd have the 128x64 module upside down to each other; this is U8g2's way. The 102x64 is a DOGS102.
UC1701 = Chip(
    name="UC1701",
    about="LCD, on SPI; 128x64 (mini 12864) and DOGS102",
    ram=(132, 65),
    modules={
        (128, 64): {"bias": 9, "resistor_ratio": 3, "level": 0x27},
        (102, 64): {"turned": True, "bias": 9, "resistor_ratio": 7, "level": 0x0E},
    },
    init=lambda m: _paged(m, power="2F", more="FA 90, " if m.turned else "AC, "),
    overrides=("first_com", "bias", "resistor_ratio"),
    choices={"bias": (9, 7)},
    upright=(0xA0, 0xC8),
    pointer=PagePointer(),
    buses=("spi",),
    contrast=_LEVELS,
    facts=_PAGED,
)

UC1609 = Chip(
    name="UC1609",
    about="LCD, 192x64; on I2C with its data at the next address",
    ram=(192, 64),
    modules={(192, 64): {"bias": 9}},
    # The column stops at the end of its page (88), the supply is the chip's own pump (2E). U8g2 and gavinlyonsrepo's
    # driver differ in temperature compensation and contrast alone.
    init=lambda m: (
        f"E2, 10 ms, AE, F1 {m.multiplex}, {0xC4 ^ m.mirror_y << 2 ^ m.mirror_x << 1:02X}, 40, 24, 2E, "
        f"{0xE8 + m.bias - 6:02X}, 81 8F, 88, A1, A6, A4"
    ),
    overrides=("bias",),
    choices={"bias": (9, 8, 7, 6)},
    pointer=PagePointer(),
    buses=("spi", "i2c-pair"),
    facts={"resync": b"\x00", "status_off": 0, **_ALL_ON},
)

# Serial: no D/C pin, a chip select that is high; the pictures of its 32 rows of RAM are 64 rows of 128 pixels. U8g2
# sends 1 Mbit/s, others 0.5 to 1.8, where the sheet's 72 microseconds a byte would allow 0.2.
ST7920 = Chip(
    name="ST7920",
    about="LCD, serial on SPI with cs_high=True and dc=None; contrast by a trimmer",
    ram=(256, 32),
    modules={size: {} for size in ((128, 64), (128, 32), (144, 32), (160, 32), (192, 32), (256, 32))},
    # From basic commands (30), text cleared and its cursor moving right, to graphics without a scroll.
    init=lambda m: "30, 30, 08, 01, 10 ms, 06, 34, 03, 40, 02, 36",
    mirrors=False,
    fold=32,
    pointer=PagePointer(row=0x80, column=0x80, paired=True, wraps=True, column_bytes=2),
    buses=("spi",),
    contrast=None,
    facts={
        "packing": "rows",
        "synced": True,
        "speed": 1_000_000,
        "resync": b"",
        "power_on": b"\x30\x0c\x34\x36",
        "power_off": b"\x30\x08\x34\x36",
        "normal": b"",
        "inverse": None,
    },
)
