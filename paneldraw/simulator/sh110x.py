"""Sino Wealth's chips, the SH1106, the SH1107 and, of four bits a pixel, the SH1122; and the CH1115, alike."""

from __future__ import annotations

from typing import Any, ClassVar

from .addressing import DOWN, NIBBLES, PAGE, page_pointer, row_pointer
from .commands import Command, Commands, choice, nothing, numbered, relative, setting
from .display_chip import DisplayChip
from .glass import Module
from .ssd130x import ONE_BIT, RELATIVES


def _converter(chip: Any, sent: bytes) -> None:
    if sent[1] not in (0x8A, 0x8B):
        chip.remark("the DC-DC converter takes 8A (off) or 8B (on); all else is ignored here", sent)
        return
    if chip.registers.on and sent[1] != chip.registers.converter:
        chip.remark("the DC-DC converter is switched while the display is off", sent)
    chip.registers.converter = sent[1]


def modify(chip: Any, sent: bytes) -> None:
    """Begin a read-modify-write: note where."""
    chip.registers.kept_column = chip.registers.column


def end_modify(chip: Any, sent: bytes) -> None:
    """End a read-modify-write where it began."""
    if chip.registers.kept_column is None:
        chip.remark("the end of a read-modify-write that was not begun (E0)", sent)
    else:
        chip.registers.column, chip.registers.kept_column = chip.registers.kept_column, None


#: What the SH110x add to the commands that all chips of one bit have.
SINO_WEALTH: Commands = {
    **RELATIVES,
    **ONE_BIT,
    **choice(
        "com_reversed",
        False,
        {opcode: opcode >= 0xC8 for opcode in range(0xC0, 0xD0)},
        "reversed COM scan {com_reversed}",
    ),
    0x81: setting("contrast", 0x80),
    0xAD: Command(1, _converter, {"converter": 0x8B}, name="DC-DC converter {1:02X}"),
    0xDB: setting("vcomh", 0x35, name="VCOM level {1:02X}"),
    0xE0: Command(0, modify, {"kept_column": None}, name="read-modify-write from column {kept_column}"),
    0xEE: Command(0, end_modify, {"kept_column": None}, name="end of read-modify-write, column pointer {column}"),
}


class SH1106(DisplayChip):
    """An SH1106 with its glass: 132 x 64 bits of RAM behind a window of 128 x 64, 128 x 32, 72 x 40 or 64 x 32 pixels.

    Parameters, attributes and errors are those of `simulator.SSD1306`; `column_offset` is 2 of 128 columns, of some
    modules 0 or 4, and `external_vcc` is a supply beside the DC-DC converter. The glass of 128x32 begins at COM 16,
    that of 72x40 at 12. Data past column 131 is lost, as no datasheet says where it goes. The status byte's lower bits
    are 8, as seen of modules.

    Examples
    --------
    >>> chip = SH1106()
    >>> chip.write(bytes.fromhex("00 20 02 A5 AF"))
    >>> chip.remarks
    ['20 02: not a command of the SH1106 (addressing mode of the SSD1306); ignored']
    """

    columns, lines = 132, 8
    # The small ones as luma.oled (128x32) and U8g2 (u8x8_d_sh1106_72x40.c, u8x8_d_sh1106_64x32.c) drive them.
    modules: ClassVar = {
        (128, 64): Module(2, 0x12),
        (128, 32): Module(2, 0x12, 16),
        (72, 40): Module(30, 0x12, 12),
        (64, 32): Module(32, 0x12),
    }
    com_pin_settings = (0x02, 0x12)
    last_column_wraps = False
    supply, supply_command = ("converter", 0x01), "AD 8B"
    identity = 0x08
    commands: ClassVar = {
        **SINO_WEALTH,
        **page_pointer(),
        **numbered("start_line", 0x40, 64),
        **numbered("pump_voltage", 0x30, 4, reset=2),
        0x20: relative("addressing mode of the SSD1306", 1),
        **dict.fromkeys((0x21, 0x22), relative("windows of the SSD1306", 2, misleads=True)),
        0xA8: setting("multiplex", 63, range(64), "the multiplex ratio is 00 to 3F (1 to 64 lines)", mask=0x3F),
        0xD5: setting("clock", 0x50),
        0xDA: setting("com_pins", 0x12, (0x02, 0x12), "the COM pins are 02 or 12", mask=0x12),
    }


class SH1107(DisplayChip):
    """An SH1107 with its glass: 128 x 128 bits of RAM, its columns joined to COM lines and its rows to segments.

    Parameters, attributes and errors are those of `simulator.SSD1306`. `column_offset` is the first visible RAM column
    under D3 00: 32 of 64x128 (which drivers turn to 0 by D3 60), 24 of 80x128 (or 0 by D3 68), 0 of 128x128, of some
    96. The page pointer wraps within its page, on which drivers of the modules at 96 rely; in vertical mode (21) it
    counts through the pages and then to the next column.

    Examples
    --------
    >>> chip = SH1107(64, 128)
    >>> chip.write(bytes.fromhex("00 A8 3F D3 60 A5 AF"))
    >>> chip.pixels.shape, int(chip.pixels.min())
    ((128, 64), 1)
    """

    columns, lines = 128, 16
    modules: ClassVar = {(64, 128): Module(32), (80, 128): Module(24), (128, 128): Module(0)}
    transposed, remaps_ram, upright = True, False, (False, False)
    identity = 0x07
    commands: ClassVar = {
        **SINO_WEALTH,
        **page_pointer(16),
        **choice("mode", PAGE, {0x20: PAGE, 0x21: DOWN}, "addressing mode: {mode}"),
        0x22: relative("windows of the SSD1306", 2, misleads=True),
        **dict.fromkeys(range(0x40, 0x80), relative("start line of the SH1106")),
        0xA8: setting("multiplex", 127, range(128), "the multiplex ratio is 00 to 7F (1 to 128 lines)", mask=0x7F),
        0xAD: setting("converter", 0x80, range(0x80, 0x90), "the DC-DC converter takes 80 to 8F", harmless=True),
        0xD3: setting("offset", 0x00, range(128), "the display offset is 00 to 7F", mask=0x7F),
        0xD5: setting("clock", 0x50),
        0xDC: setting("start_line", 0x00, range(128), "the start line is 00 to 7F", mask=0x7F),
    }


class CH1115(DisplayChip):
    """A CH1115 with its glass: 128 x 64 pixels. Scrolling and breathing are state only.

    Parameters, attributes and errors are those of `simulator.SSD1306`. Look-alikes with 132 columns of RAM begin at
    column 2 (`column_offset`).

    Examples
    --------
    >>> chip = CH1115()
    >>> chip.write(bytes.fromhex("00 AD 8B A5 AF"))
    >>> int(chip.pixels.sum()), chip.violations
    (8192, [])
    """

    columns, lines, wide_columns = 128, 8, 132
    modules: ClassVar = {(128, 64): Module(0)}
    last_column_wraps = False
    supply, supply_command = ("converter", 0x01), "AD 8B"
    commands: ClassVar = {
        **SINO_WEALTH,
        **page_pointer(),
        **numbered("start_line", 0x40, 64),
        **numbered("pump_voltage", 0x30, 4, reset=1),
        0x20: relative("addressing mode of the SSD1306", 1),
        **dict.fromkeys((0x21, 0x22), relative("windows of the SSD1306", 2, misleads=True)),
        0x23: setting("breathing", 0x00),
        0x24: nothing("scroll window", 2),
        **dict.fromkeys((0x26, 0x27), nothing("scroll set up", 3)),
        **dict.fromkeys(range(0x28, 0x2C), nothing("scroll mode")),
        **dict.fromkeys((0x2E, 0x2F), nothing("scroll off or on")),
        0x82: setting("reference", 0x00, range(8), "the reference takes 00 to 07", harmless=True),
        **dict.fromkeys((0xA2, 0xA3), nothing("output")),
        0xA8: setting("multiplex", 63, range(64), "the multiplex ratio is 00 to 3F (1 to 64 lines)", mask=0x3F),
        0xDB: setting("vcomh", 0x40),
    }


class SH1122(DisplayChip):
    """An SH1122 with its glass: 256 x 64 pixels of four bits, the left one of two in the upper half of a byte.

    Parameters, attributes and errors are those of `simulator.SSD1306`. The module stands upright under A0 and C0. A
    reversed scan (C8) begins in the middle, at line 31: public drivers then start the RAM at row 32. Data past a row is
    lost, as no datasheet says where it goes.

    Examples
    --------
    >>> chip = SH1122()
    >>> chip.write(bytes.fromhex("00 B0 05 02 10 AF"))
    >>> chip.write(bytes.fromhex("40 C3"))
    >>> chip.pixels[5, 4:6].tolist()
    [12, 3]
    """

    columns, lines, line_name, packing = 128, 64, "row", NIBBLES
    modules: ClassVar = {(256, 64): Module(0)}
    upright = (False, False)
    reversed_lines = 32
    last_column_wraps = False
    commands: ClassVar = {
        **SINO_WEALTH,
        **row_pointer(64),
        **numbered("start_line", 0x40, 64),
        **numbered("discharge_level", 0x30, 16),
        0xA8: setting("multiplex", 63, range(64), "the multiplex ratio is 00 to 3F (1 to 64 lines)", mask=0x3F),
        0xAD: setting("converter", 0x80, range(0x80, 0x90), "the DC-DC converter takes 80 to 8F", harmless=True),
        0xD5: setting("clock", 0x50),
        0xDC: setting("precharge_voltage", 0x35),
    }
