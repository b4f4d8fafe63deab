"""OLED chips of 16 grays, two pixels a byte, addressed by windows, the SH1122 by rows.

Sources are those of `paneldraw.controllers.oled`; where they disagree it says so.

A level is lit for as many clocks of its line as a table says, which most of them take on ``B8``. Their own table,
``B9``, leaves level 1 dark; that of Newhaven's code for the SSD1325 gives half the level a third of the light. Here the
steps are even, and the longest is near that of their own, so that brightness and scan stay as they were. What light the
precharge adds is not known.
"""

from __future__ import annotations

import itertools

from paneldraw.controllers.chip import Chip, Module
from paneldraw.controllers.record import Contrast, PagePointer, Scroll, Window


def _even(clocks: int) -> tuple[int, ...]:
    """Pulses of levels 0 to 15, so many clocks from each to the next."""
    return tuple(range(0, 16 * clocks, clocks))


def _table(pulses: tuple[int, ...]) -> str:
    """Command for the pulses of levels 1 to 15."""
    return f"B8 {bytes(pulses[1:]).hex(' ')}"


def _steps(pulses: tuple[int, ...]) -> str:
    """The SSD1325's: the first pulse, and what each one behind has more, less 1; two a byte, the lower half first."""
    first, *more = (high - low for low, high in itertools.pairwise(pulses))
    pairs = bytes(low - 1 | high - 1 << 4 for low, high in zip(more[::2], more[1::2], strict=True))
    return f"B8 {first:02X} {pairs.hex(' ')}"


_PULSES_1327 = _even(2)  # B9 has them up to 28
_PULSES_1325 = _even(4)  # Newhaven's up to 66; B2 leaves room for 71
_PULSES_1322 = _even(8)  # B9 has them up to 112


def _window(m: Module) -> Window:
    return Window(columns=0x15, rows=0x75, across=bytes((0xA0, m.remap)), down=bytes((0xA0, m.remap | 0x04)))


SSD1327 = Chip(
    name="SSD1327",
    about="OLED, 16 grays; 1.5-inch modules",
    ram=(128, 128),
    modules={
        (128, 128): {},
        (96, 96): {"column_offset": 16, "first_com": 32},
        (128, 96): {"first_com": 32},
        # Winstar's, in U8g2, which drives 100 lines of it.
        (96, 64): {"column_offset": 16, "upright": 0x42},
    },
    remap=(0x51, 0x03, 0x10),  # split COM lines, reversed, columns from the right
    init=lambda m: (
        f"FD 12, AE, A8 {m.multiplex}, A1 00, A2 {m.offset}, A0 {m.remap:02X}, AB 01, 81 53, B1 51, "
        f"B3 01, {_table(_PULSES_1327)}, BC 08, BE 07, B6 01, D5 62, 2E, A4"
    ),
    overrides=("first_com",),
    window=_window,
    drive=lambda m: ("B1 51, BC 08, BE 07", "B1 51, BC 00, BE 00", "B1 21, BC 00, BE 00", "B1 11, BC 00, BE 00"),
    facts={
        "packing": "nibbles",
        "pulses": _PULSES_1327,
        "resync": b"\xb2" * 15,
        "normal": b"\xa4",
        "all_on": b"\xa5",
        "scroll": Scroll(across="26 00 {first} {speed} {last} {left} {right} 00", frames=(6, 32, 64, 256, 3, 4, 5, 2)),
    },
)

SSD1325 = Chip(
    name="SSD1325",
    about="OLED, 16 grays; 2.7-inch modules",
    ram=(128, 80),
    # The glass of Newhaven's 128x64 is at COM 12 to 75 (A2 4C). U8g2's other values for it, turned, fit where a
    # reversed scan begins at the last of the 80 lines, not at the last that is driven: 41, row 8; and 41, A2 50 of
    # the SSD0323, which is the same chip on glass at COM 0.
    modules={(128, 64): {"first_com": 12}},
    reversed_lines=80,
    remap=(0x52, 0x03, 0x10),  # split COM lines, reversed, columns from the left
    init=lambda m: (
        f"AE, B3 91, A8 {m.multiplex}, A2 {m.offset}, A1 00, AD 02, A0 {m.remap:02X}, 86, "
        f"{_steps(_PULSES_1325)}, 81 70, B2 51, B1 55, BC 10, B4 02, B0 28, BE 1C, BF 0F, A4"
    ),
    overrides=("first_com",),
    window=_window,
    contrast=Contrast(highest=0x7F),
    drive=lambda m: ("B1 55, BC 10, BE 1C, 86", "B1 55, BC 00, BE 00, 86", "B1 11, BC 00, BE 00, 84"),
    facts={
        "packing": "nibbles",
        "pulses": _PULSES_1325,
        "resync": b"\xe3" * 8,
        "normal": b"\xa4",
        "all_on": b"\xa5",
    },
)


def _ssd1362(m: Module) -> str:
    return (
        f"FD 12, AE, 23 00, 81 9F, A0 {m.remap:02X}, A1 00, A2 {m.offset}, A4, A8 {m.multiplex}, AB 01, "
        f"AD {'9E' if m.internal_reference else '8E'}, B1 22, B3 A0, B6 04, "
        f"{_table(_PULSES_1327)}, BC 04, BE 05"
    )


SSD1362 = Chip(
    name="SSD1362",
    about="OLED, 16 grays; 256x64 modules",
    ram=(256, 64),
    # luma.oled and one of U8g2's two drivers of 256x64 use the internal reference, the other AD 8E; 206x36 is U8g2's.
    modules={(256, 64): {"internal_reference": True}, (206, 36): {"first_com": 14}},
    # Split and swapped segments, columns from the right, as in U8g2. luma.oled sends 43 and its nibbles the other way
    # round, which is the same; U8g2's OEL1M0033 swaps them once more.
    remap=(0xC3, 0x03, 0x10),
    init=_ssd1362,
    overrides=("first_com", "internal_reference"),
    window=_window,
    drive=lambda m: ("B1 22, BC 04, BE 05", "B1 22, BC 00, BE 00", "B1 11, BC 00, BE 00"),
    facts={
        "packing": "nibbles",
        "pulses": _PULSES_1327,
        "resync": b"\xe3" * 15,
        "normal": b"\xa4",
        "all_on": b"\xa5",
    },
)

SSD1322 = Chip(
    name="SSD1322",
    about="OLED, 16 grays, on SPI; 256x64 modules",
    ram=(480, 128),
    # Some begin at 96; U8g2's "zjy" at 96 from the right (column_offset=128, mirror_x=1). The small ones are those of
    # luma.oled, which drives 64 lines of all; Newhaven's 128x64, of two segments a pixel, is none of them.
    modules={
        (256, 64): {"column_offset": 112},
        (256, 48): {"column_offset": 112, "first_com": 16},
        (256, 32): {"column_offset": 112, "first_com": 32},
        (240, 128): {"column_offset": 96, "upright": 0x36},
        (128, 64): {"column_offset": 176},
        (128, 48): {"column_offset": 176, "first_com": 16},
        (128, 32): {"column_offset": 176, "first_com": 32},
        (64, 64): {"column_offset": 208},
        (64, 48): {"column_offset": 208, "first_com": 16},
        (64, 32): {"column_offset": 208, "first_com": 32},
    },
    remap=(0x14, 0x02, 0x10),  # columns from the left, nibbles in order, lines from the last, as vendors' code has it
    init=lambda m: (
        f"FD 12, AE, B3 91, CA {m.multiplex}, A2 {m.offset}, A1 00, AB 01, B4 A0 FD, C1 9F, C7 0F, "
        f"{_table(_PULSES_1322)}, 00, B1 E2, D1 A2 20, BB 1F, B6 08, BE 07, A6, A9, A0 {m.remap:02X} {_dual(m):02X}"
    ),
    overrides=("first_com",),
    window=lambda m: Window(
        columns=0x15,
        rows=0x75,
        across=bytes((0xA0, m.remap, _dual(m))),
        down=bytes((0xA0, m.remap | 0x01, _dual(m))),
        column_bytes=2,
        write=b"\x5c",
    ),
    buses=("spi",),
    contrast=Contrast(command=b"\xc1"),
    drive=lambda m: ("B1 E2, BB 1F, BE 07", "B1 E2, BB 00, BE 00", "B1 32, BB 00, BE 00"),
    facts={
        "packing": "nibbles",
        "pulses": _PULSES_1322,
        "arguments_are_data": True,
        "resync": b"",  # D/C low always begins a command
        "all_on": b"\xa5",
    },
)


def _dual(m: Module) -> int:
    """The second argument of A0: two COM lines at once, where there are no more than 64."""
    return 0x11 if m.height <= 64 else 0x01


SH1122 = Chip(
    name="SH1122",
    about="OLED, 16 grays; 2.08-inch modules",
    ram=(256, 64),
    modules={(256, 64): {}},
    # Upright under A0 and C0, as U8g2 starts it; its flip mode 0 has it the other way round. A reversed scan begins in
    # the middle, so that the RAM starts at row 32, in U8g2 and in the Mooltipass's firmware.
    upright=(0xA0, 0xC0),
    reversed_lines=32,
    init=lambda m: (
        f"AE, {0x40 + m.shift:02X}, {m.segments}, {m.lines}, 81 80, A8 3F, AD {'81' if m.charge_pump else '80'}, "
        "D5 50, D3 00, D9 22, DB 35, DC 35, 30, A4, A6"
    ),
    overrides=("first_com", "charge_pump"),
    pointer=PagePointer(row_argument=True),
    drive=lambda m: ("D9 22, DB 35, DC 35", "D9 22, DB 00, DC 00", "D9 11, DB 00, DC 00"),
    # It takes no table, and what light its levels have is not known here: even steps are assumed.
    facts={"packing": "nibbles", "all_on": b"\xa5", "follow": (b"\xa4",)},
)
