"""Solomon Systech's chips of one bit a pixel: the SSD1306 and its relatives."""

from __future__ import annotations

from typing import Any, ClassVar

from .addressing import ADDRESSING_MODE, page_pointer, windows
from .commands import DISPLAY, LOCK, Command, Commands, choice, nothing, numbered, relative, setting, switch
from .display_chip import DisplayChip
from .glass import Module
from .scroll import scroll

COM_PINS = (0x02, 0x12, 0x22, 0x32)
OFFSET = "display offset {offset}"

#: What the SSD130x and the SH110x have in common: how the RAM comes to the glass, and the timing.
ONE_BIT: Commands = {
    **DISPLAY,
    **switch("segment_remap", 0xA0),
    **switch("all_on", 0xA4, "every pixel lit: {all_on}"),
    **switch("inverted", 0xA6, "inversion {inverted}"),
    **choice("com_reversed", False, {0xC0: False, 0xC8: True}, "reversed COM scan {com_reversed}"),
    0x81: setting("contrast", 0x7F),
    0xD3: setting("offset", 0x00, range(64), "the display offset is 00 to 3F", mask=0x3F, name=OFFSET),
    0xD5: setting("clock", 0x80, name="clock {1:02X}"),
    0xD9: setting(
        "precharge",
        0x22,
        [n for n in range(256) if n & 0x0F and n & 0xF0],
        "a precharge phase of 0 clocks is invalid",
        harmless=True,
        name="precharge {1:02X}",
    ),
    0xE3: nothing("no operation"),
}

#: The commands of all relatives of this family, let pass by those that do not have them.
RELATIVES: Commands = {
    0x23: relative("fade and blink of the SSD1306B and the SSD1315", 1),
    **dict.fromkeys((0x26, 0x27), relative("scroll of the SSD1306", 6)),
    **dict.fromkeys((0x29, 0x2A), relative("scroll of the SSD1306", 5)),
    **dict.fromkeys((0x2C, 0x2D), relative("one-column scroll of the SSD1306B and the SSD1315", 6)),
    0x2E: relative("scroll of the SSD1306"),
    0x2F: relative("scroll of the SSD1306", misleads=True),
    **dict.fromkeys(range(0x30, 0x34), relative("pump voltage of the SH1106")),
    0x82: relative("area brightness of the SSD1305", 1),
    0x8D: relative("charge pump of the SSD1306", 1),
    0x91: relative("look-up table of the SSD1305", 4),
    **dict.fromkeys((0x92, 0x93), relative("bank colors of the SSD1305", 4)),
    0xA3: relative("scroll of the SSD1306", 2),
    0xAB: relative("dim mode of the SSD1305", 3),
    0xAC: relative("dim mode of the SSD1305"),
    0xAD: relative("supply of the SH1106 and the SSD1305, reference current of the SSD1315", 1),
    0xD6: relative("zoom of the SSD1306B and the SSD1315", 1),
    0xD8: relative("area color and low power of the SSD1305", 1),
    0xDA: relative("COM pins of the SSD1306", 1),
    0xDC: relative("start line of the SH1107, GPIO of the SSD1309", 1),
    0xE0: relative("read-modify-write of the SH1106"),
    0xEE: relative("read-modify-write of the SH1106"),
    0xFD: relative("command lock of the SSD1309", 1),
}


def _charge_pump(chip: Any, sent: bytes) -> None:
    enabled = chip.registers.charge_pump & 0x04
    if sent[1] & 0x3F not in (0x10, 0x14, 0x15):
        chip.complain("the charge pump takes 10 (off), 14 or, of later dies, 15 (on)", sent)
    elif chip.registers.on and sent[1] & 0x04 != enabled:
        chip.remark("the charge pump is switched while the display is off, before AF", sent)
    chip.registers.charge_pump = sent[1]


class SSD1306(DisplayChip):
    """An SSD1306 with its glass: 128 x 64 bits of RAM behind a window of `width` x `height` pixels.

    Parameters
    ----------
    width, height : int
        Visible size in pixels: 128x64 (default), 128x32, 96x16, 96x39, 96x40, 72x40, 64x48, 64x32 or 48x64; any other
        size that the RAM holds needs `column_offset` and `com_pins`.
    column_offset : int, optional
        First visible RAM column under A1. Default: as modules of that size are wired (72x40: 28, 96x39, 64x48 and
        64x32: 32, 48x64: 40, others 0).
    com_pins : int, optional
        The DA value that the glass is wired for: 0x02, 0x12, 0x22 or 0x32. Default: 0x02 (sequential) for 128x32,
        96x16 and 96x40, 0x12 (alternative) for the others. Under another DA value the lines appear where the pads
        take them.
    first_com : int, optional
        First COM signal that the glass uses. Default: 0; 16 of some modules of 64x32, 32 of 128x32 at the far end.
    external_vcc : bool
        The module has its own panel supply and lights up without the charge pump. Default: False.
    history : int or None
        How many frames `frames` keeps, the oldest dropped first; None keeps all. Default: 1000 (8 MB at 128x64).
    seed : int or None
        Seed of the noise that the RAM holds after power-up; None makes it differ from run to run. Default: 0.

    Attributes
    ----------
    frames, violations, remarks, registers
        As `paneldraw.simulator.chip.Chip` says.

    Raises
    ------
    ValueError
        For a size, offset or COM setting that the chip cannot have.

    Notes
    -----
    A command that the datasheet forbids is recorded and then acts as far as its bits reach; an unknown one is ignored,
    a relative's with its arguments. Hardware scrolling moves the RAM, in the time of the bus. Where the datasheet is
    silent: page mode runs through all 128 columns, whatever window was set; a
    pointer past the end of its window counts on to the end of the RAM; data in the middle of a command reaches the RAM
    and the command waits on; A5 lights an inverted display too. The status byte's lower bits are 3, as seen of modules.

    Examples
    --------
    >>> chip = SSD1306(128, 32)
    >>> chip.write(bytes.fromhex("00 A8 1F DA 02 8D 14 20 00 A1 C8 A5 AF"))
    >>> chip.pixels.shape, int(chip.pixels.min())
    ((32, 128), 1)
    >>> chip.violations
    []
    """

    columns, lines = 128, 8
    modules: ClassVar = {
        (128, 64): Module(0, 0x12),
        (128, 32): Module(0, 0x02),
        (96, 16): Module(0, 0x02),
        (96, 39): Module(32, 0x12),
        (96, 40): Module(0, 0x02),
        (72, 40): Module(28, 0x12),
        (64, 48): Module(32, 0x12),
        (64, 32): Module(32, 0x12),
        (48, 64): Module(40, 0x12),
    }
    com_pin_settings = COM_PINS
    supply, supply_command = ("charge_pump", 0x04), "8D 14"
    identity = 0x03
    commands: ClassVar = {
        **RELATIVES,
        **ONE_BIT,
        **scroll("0 p i P 00 FF", "- p i P v"),
        **page_pointer(only_in_page_mode=True),
        **windows(128, 8, 0x21, 0x22, "page", not_in_page_mode=True),
        **numbered("start_line", 0x40, 64),
        0x20: ADDRESSING_MODE,
        0x8D: Command(1, _charge_pump, {"charge_pump": 0x10}, name="charge pump {1:02X}"),
        0xA8: setting("multiplex", 63, range(15, 64), "the multiplex ratio is 0F to 3F (16 to 64 lines)", mask=0x3F),
        0xDA: setting(
            "com_pins", 0x12, COM_PINS, "the COM pins are 02, 12, 22 or 32", harmless=True, name="COM pins {1:02X}"
        ),
        0xDB: setting(
            "vcomh",
            0x20,
            (0x00, 0x20, 0x30),
            "the VCOMH level is 00, 20 or 30",
            harmless=True,
            name="VCOMH level {1:02X}",
        ),
    }


class SSD1309(SSD1306):
    """An SSD1309: what the SSD1306 is without its charge pump, on glass of 128 x 64 pixels.

    Some that are sold as one have 132 columns of RAM; their modules begin at column 2 (`column_offset`).

    Examples
    --------
    >>> chip = SSD1309()
    >>> chip.write(bytes.fromhex("00 DB 34 A5 AF"))
    >>> int(chip.pixels.sum()), chip.violations
    (8192, [])
    """

    modules: ClassVar = {(128, 64): Module(0, 0x12)}
    wide_columns = 132
    supply, identity = ("on", 1), 0x00
    commands: ClassVar = {
        **SSD1306.commands,
        **scroll("0 p i P - c C", "h p i P v c C", once="0 p b P - c C", frames=(5, 64, 128, 256, 2, 3, 4, 1)),
        0x8D: RELATIVES[0x8D],
        0xDB: setting(
            "vcomh",
            0x34,
            (0x00, 0x34, 0x3C),
            "the VCOMH level is 00, 34 or 3C",
            harmless=True,
            name="VCOMH level {1:02X}",
        ),
        0xDC: setting("gpio", 0x02, range(4), "the GPIO takes 00 to 03", harmless=True),
        0xFD: LOCK,
    }


class SSD1315(SSD1306):
    """An SSD1315: an SSD1306 with a reference current of its own, fading, blinking and zoom, which are state only.

    Its scroll has a window of columns and goes one column at a time, too.

    Examples
    --------
    >>> chip = SSD1315(72, 40)
    >>> chip.write(bytes.fromhex("00 AD 30 8D 14 A5 AF"))
    >>> chip.registers.reference, chip.remarks
    (48, [])
    """

    commands: ClassVar = {
        **SSD1306.commands,
        **scroll("0 p i P c C", "h p i P v c C", once="0 p b P c C", frames=(6, 32, 64, 128, 3, 4, 5, 2)),
        0x23: setting("fade", 0x00, [n for n in range(64) if n >> 4 != 1], "fading takes 00, 20 to 2F or 30 to 3F"),
        0xAD: setting(
            "reference", 0x00, (0x00, 0x10, 0x20, 0x30), "the reference takes 00, 10, 20 or 30", harmless=True
        ),
        0xD6: setting("zoom", 0x00, (0x00, 0x01), "the zoom takes 00 or 01", harmless=True),
    }


class SSD1316(SSD1315):
    """An SSD1316: an SSD1315 with 39 rows of RAM, on glass of 128 or 96 columns that stands upright under A1 and C0.

    Examples
    --------
    >>> chip = SSD1316(96, 39)
    >>> chip.write(bytes.fromhex("00 A8 26 8D 15 A5 AF"))
    >>> int(chip.pixels.sum()) == 96 * 39
    True
    """

    lines, last_rows = 5, 7
    upright = (True, False)
    modules: ClassVar = {size: Module(0, 0x12) for size in ((128, 32), (96, 32), (128, 39), (96, 39))}
    commands: ClassVar = {
        **SSD1315.commands,
        **page_pointer(5, only_in_page_mode=True),
        **windows(128, 5, 0x21, 0x22, "page", not_in_page_mode=True),
        **dict.fromkeys(range(0xB5, 0xB8), relative("pages past 4 of the SSD1306", misleads=True)),
        0xA8: setting("multiplex", 38, range(15, 39), "the multiplex ratio is 0F to 26 (16 to 39 lines)", mask=0x3F),
    }


class SSD1312(SSD1306):
    """An SSD1312: an SSD1306 with a choice of reference current, whose modules stand upright under A1 and C0.

    The glass of 32 lines and less begins at COM 16.

    Examples
    --------
    >>> chip = SSD1312(120, 28)
    >>> chip.write(bytes.fromhex("00 A8 1B D3 30 8D 14 A5 AF"))
    >>> int(chip.pixels.sum()) == 120 * 28
    True
    """

    upright = (True, False)
    identity = 0x00
    modules: ClassVar = {
        (128, 64): Module(0, 0x12),
        (128, 32): Module(0, 0x12, 16),
        (120, 32): Module(0, 0x12, 16),
        (120, 28): Module(0, 0x12, 16),
    }
    commands: ClassVar = {**SSD1306.commands, 0xAD: SSD1315.commands[0xAD]}


def _dim_on(chip: Any, sent: bytes) -> None:
    chip.registers.on = True


class SSD1305(SSD1306):
    """An SSD1305: 132 columns of RAM, fed from outside, areas of other brightness, which are state only.

    128x64 begins at column 2, of some modules at 0 or 4, 128x32 at 4. Of the arguments of its scroll the number of
    columns a step is taken for 1.

    Examples
    --------
    >>> chip = SSD1305(128, 32)
    >>> chip.write(bytes.fromhex("00 A8 1F AD 8E A5 AF"))
    >>> chip.pixels.shape, int(chip.pixels.min()), chip.violations
    ((32, 128), 1, [])
    """

    columns = 132
    modules: ClassVar = {(128, 64): Module(2, 0x12), (128, 32): Module(4, 0x12)}
    supply, supply_command, identity = ("on", 1), "", 0x00
    commands: ClassVar = {
        **SSD1306.commands,
        **scroll("h p i P", "h p i P v", frames=(6, 32, 64, 128, 3, 4, 5, 2)),
        **windows(132, 8, 0x21, 0x22, "page", not_in_page_mode=True),
        0x82: setting("area_brightness", 0x80),
        0x8D: RELATIVES[0x8D],
        0x91: nothing("look-up table", 4),
        **dict.fromkeys((0x92, 0x93), nothing("bank colors", 4)),
        0xAB: nothing("dim mode", 3),
        0xAC: Command(0, _dim_on, name="display {on}, dim"),
        0xAD: setting("master", 0x8F, (0x8E, 0x8F), "the master configuration takes 8E or 8F", harmless=True),
        0xD3: setting(
            "offset", 0x00, range(64), "the display offset is 00 to 3F", mask=0x3F, harmless=True, name=OFFSET
        ),
        0xD8: setting("area_color", 0x00),
        0xDB: setting(
            "vcomh",
            0x34,
            (0x00, 0x34, 0x3C),
            "the VCOMH level is 00, 34 or 3C",
            harmless=True,
            name="VCOMH level {1:02X}",
        ),
    }
