"""Solomon Systech's chips of four bits a pixel: the SSD1327, the SSD1325, the SSD1362 and the SSD1322."""

from __future__ import annotations

import itertools
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .addressing import ACROSS, DOWN, NIBBLES, windows
from .commands import DISPLAY, LOCK, Command, Commands, choice, nothing, relative, setting
from .display_chip import DisplayChip
from .glass import Module
from .scroll import Scroll

_OSCILLATOR, _STEP = 600_000, 20_000


def _greys(chip: Any, sent: bytes) -> None:
    if max(sent[1:]) > chip.longest_pulse or any(low >= high for low, high in itertools.pairwise(sent[1:])):
        chip.complain(f"a grey table rises from step to step, to {chip.longest_pulse:02X} at most", sent)
    chip.registers.greys = tuple(sent[1:])


def _table(last: int) -> Commands:
    """Pulse widths of levels 1 to 15 in clocks, which after reset and B9 are even from level 1 on, which is dark."""
    linear = tuple(range(0, last + 1, last // 14))

    def select(chip: Any, sent: bytes) -> None:
        chip.registers.greys = linear

    return {
        0xB8: Command(15, _greys, {"greys": linear}, name="gray table"),
        0xB9: Command(0, select, {"greys": linear}, name="linear gray table"),
    }


#: What the SSD132x have in common.
GREY: Commands = {
    **DISPLAY,
    **choice("display", 0xA4, {opcode: opcode for opcode in range(0xA4, 0xA8)}, "display mode {display:02X}"),
    0xAB: setting("regulator", 0x01, (0x00, 0x01), "the regulator takes 00 (external) or 01 (internal)", harmless=True),
    0xB1: setting(
        "phases",
        0x74,
        [n for n in range(256) if n & 0x0F and n & 0xF0],
        "a phase of 0 is invalid",
        harmless=True,
        name="phases {1:02X}",
    ),
    0xB3: setting("clock", 0x00, name="clock {1:02X}"),
    0xB5: setting("gpio", 0x02),
    0xB6: setting("second_precharge", 0x04, range(1, 16), "the second precharge period is 01 to 0F"),
    **_table(28),
    0xBE: setting("vcomh", 0x05, range(8), "the VCOMH level is 00 to 07", harmless=True),
    0xFD: LOCK,
}


class GreyChip(DisplayChip):
    """What the SSD132x have in common: a remap register, and display modes of which one turns all pixels off."""

    line_name = "row"
    packing = NIBBLES
    longest_pulse = 0x3F
    down_bit = 0x04
    all_off, all_lit, inverse = 0xA6, 0xA5, 0xA7
    com_remap_bit = 0x10

    @property
    def lit(self) -> bool:
        """Whether the panel is on, and not all off by command."""
        return super().lit and self.registers.display != self.all_off

    @property
    def all_on(self) -> bool:
        """Whether every pixel is at the highest level."""
        return bool(self.registers.display == self.all_lit)

    @property
    def inverted(self) -> bool:
        """Whether levels are turned over."""
        return bool(self.registers.display == self.inverse)

    @property
    def frame_seconds(self) -> float:
        """How long the chip takes to show its RAM once, at about 600 kHz of its oscillator's code 0."""
        r = self.registers
        clocks = self._line_clocks * (r.multiplex + 1)
        return float(clocks * ((r.clock & 0x0F) + 1) / (_OSCILLATOR + _STEP * (r.clock >> 4)))

    @property
    def _line_clocks(self) -> int:
        """Clocks a line: two phases, the longest pulse, and 10 beside it."""
        r = self.registers
        return int((r.phases & 0x0F) + (r.phases >> 4) + self._pulses[-1] + 10)

    @property
    def _pulses(self) -> tuple[int, ...]:
        """Clocks that levels 1 to 15 are lit."""
        pulses: tuple[int, ...] = self.registers.greys
        return pulses

    @property
    def _shares(self) -> NDArray[np.float64]:
        return np.array((0, *self._pulses)) / (self._pulses[-1] or 1)

    @property
    def mode(self) -> int:
        """Whether windows are filled across or down."""
        return DOWN if self.registers.remap & self.down_bit else ACROSS

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """Multiplex ratio less 1, display offset, start line, whether COM lines are reversed, COM pins."""
        r = self.registers
        return r.multiplex, r.offset, r.start_line, bool(r.remap & self.com_remap_bit), r.remap & self.alternate_bit


def _scroll(chip: Any, sent: bytes) -> None:
    """The SSD1327's, by rows and columns of two pixels."""
    if chip.registers.scrolling:
        chip.complain("a scroll is set up only while none is running; send 2E first", sent)
    opcode, first, top, interval, bottom, left, right, last = sent
    if (first, last) != (0, 0) or interval > 7:
        chip.complain("the first and last arguments of a scroll are 00, its interval is 00 to 07", sent)
    if not (top <= bottom < chip.lines and left <= right < chip.columns):
        chip.complain("a scroll's rows and columns are within the RAM, the end ones not before the start ones", sent)
    frames = (6, 32, 64, 256, 3, 4, 5, 2)
    chip.registers.scroll = Scroll(
        opcode, top, bottom, interval & 7, column_start=left, column_end=right, frames=frames
    )


def _scroll_unseen(chip: Any, sent: bytes) -> None:
    chip.registers.scroll = Scroll(sent[0], across=False)


def _scroll_run(chip: Any, sent: bytes) -> None:
    chip.registers.scrolling = sent[0] == 0x2F
    if chip.registers.scrolling and not chip.registers.scroll.opcode:
        chip.complain("a scroll is started and none was set up (26 or 27)", sent)


class SSD1327(GreyChip):
    """An SSD1327 with its glass: 128 x 128 pixels of four bits behind a window of that size or of a smaller one.

    Parameters, attributes and errors are those of `simulator.SSD1306`. Modules stand upright under A0 51, that of 96x64
    under A0 42.
    `pixels` are in levels, `seen` is the light that the gray table makes of them. A scroll moves by a column address,
    two pixels, a step; the sheet says "one column".

    Examples
    --------
    >>> chip = SSD1327()
    >>> chip.write(bytes.fromhex("00 A0 51 15 02 02 75 05 05 AF"))
    >>> chip.write(bytes.fromhex("40 C3"))
    >>> chip.pixels[5, 4:6].tolist()
    [12, 3]
    """

    columns, lines = 64, 128
    modules: ClassVar = {
        (128, 128): Module(0, 0x40),
        (128, 96): Module(0, 0x40, 32),
        (96, 96): Module(16, 0x40, 32),
        (96, 64): Module(16, 0x40, upright=(False, False)),
    }
    com_pin_settings = (0x00, 0x40)
    alternate_bit, swap_bit = 0x40, 0x00
    commands: ClassVar = {
        **GREY,
        **windows(64, 128, 0x15, 0x75),
        **dict.fromkeys(
            (0x26, 0x27), Command(7, _scroll, {"scroll": Scroll(), "scrolling": False}, name="scroll set up")
        ),
        **dict.fromkeys((0x2E, 0x2F), Command(0, _scroll_run, name="scroll {scrolling}")),
        **dict.fromkeys((0x84, 0x85, 0x86, 0xB2, 0xB4, 0xBB), nothing("no operation")),
        0x81: setting("contrast", 0x7F),
        0xA0: setting(
            "remap",
            0x00,
            [n for n in range(256) if not n & 0xA8],
            "bits 3, 5 and 7 of the remap are 0",
            mask=0x57,
            name="remap {1:02X}",
        ),
        0xA1: setting("start_line", 0x00, range(128), "the start line is 00 to 7F", mask=0x7F),
        0xA2: setting("offset", 0x00, range(128), "the display offset is 00 to 7F", mask=0x7F),
        0xA8: setting("multiplex", 127, range(15, 128), "the multiplex ratio is 0F to 7F (16 to 128 lines)", mask=0x7F),
        0xBC: setting("precharge_voltage", 0x05, range(32), "the precharge voltage is 00 to 1F", harmless=True),
        0xD9: relative("precharge of the SSD1306", 1),
        0xD5: setting("function_b", 0x60, range(0x60, 0x64), "function selection B is 60 to 63", harmless=True),
    }

    @property
    def segment_remap(self) -> bool:
        """Whether column 0 is at the last segment."""
        return bool(self.registers.remap & 0x01)

    @property
    def high_first(self) -> bool:
        """Whether the upper half of a byte is the pixel nearer to column 0."""
        return self.segment_remap != bool(self.registers.remap & 0x02)


def _steps(chip: Any, sent: bytes) -> None:
    first, *pairs = sent[1:]
    if any(byte & 0x88 for byte in (first & 0x0F, *pairs)) or first & 0xF0:
        chip.complain("steps of the gray table are 0 to 7, that of level 1 and then two a byte", sent)
    chip.registers.steps = (first & 7, *(byte >> shift & 7 for byte in pairs for shift in (0, 4)))


def _fill(chip: Any, sent: bytes) -> None:
    _, left, top, right, bottom, pattern = sent
    if left > right or top > bottom or right >= chip.columns or bottom >= chip.lines:
        chip.complain("a rectangle is within the RAM, from its left and top to its right and bottom", sent)
    chip._addressed[top : bottom + 1, left : right + 1] = pattern >> 4, pattern & 0x0F


class SSD1325(GreyChip):
    """An SSD1325 with its glass: 128 x 80 pixels of four bits behind a window of 128 x 64, or the SSD0323, its twin.

    Parameters, attributes and errors are those of `simulator.SSD1306`. The module's glass is at COM 12 to 75, upright
    under A0 52 A2 4C. A reversed scan begins at the last of the 80 lines, as U8g2's values for a turned module have it;
    which lines a smaller multiplex ratio leaves dark is not known, so none is, unless there are fewer than the glass
    has. Copying and scrolling are state only.

    Examples
    --------
    >>> chip = SSD1325()
    >>> chip.write(bytes.fromhex("00 A8 3F A2 4C A0 52 24 00 00 3F 3F 77 24 02 05 02 05 C3 AF"))
    >>> chip.pixels[5, 2:8].tolist()
    [7, 7, 12, 3, 7, 7]
    """

    columns, lines, highest_contrast = 64, 80, 0x7F
    modules: ClassVar = {(128, 64): Module(0, 0x40, 12)}
    com_pin_settings = (0x00, 0x40)
    alternate_bit, swap_bit = 0x40, 0x00
    upright = (False, True)
    reversed_lines = 80
    commands: ClassVar = {
        **{opcode: GREY[opcode] for opcode in (*range(0xA4, 0xA8), 0xAE, 0xAF, 0xB1, 0xB3)},
        **windows(64, 80, 0x15, 0x75),
        **dict.fromkeys((0x84, 0x85, 0x86, 0xE3), nothing("no operation")),
        0x23: setting("drawing", 0x00, range(32), "the drawing options are 00 to 1F", harmless=True),
        0x24: Command(5, _fill, name="rectangle: columns {1} to {3}, rows {2} to {4}, filled with {5:02X}"),
        0x25: nothing("copy", 6),
        0x26: Command(4, _scroll_unseen, {"scroll": Scroll(), "scrolling": False}, name="scroll set up"),
        **dict.fromkeys((0x2E, 0x2F), Command(0, _scroll_run, name="scroll {scrolling}")),
        0x81: setting("contrast", 0x40, range(128), "the contrast is 00 to 7F", mask=0x7F, harmless=True),
        0xA0: setting(
            "remap",
            0x00,
            [n for n in range(256) if not n & 0xA8],
            "bits 3, 5 and 7 of the remap are 0",
            mask=0x57,
            name="remap {1:02X}",
        ),
        0xA1: setting("start_line", 0x00, range(80), "the start line is 00 to 4F", mask=0x7F),
        0xA2: setting("offset", 0x00, range(80), "the display offset is 00 to 4F", mask=0x7F, harmless=True),
        0xA8: setting("multiplex", 79, range(15, 80), "the multiplex ratio is 0F to 4F (16 to 80 lines)", mask=0x7F),
        0xAD: setting("master", 0x03, (0x02, 0x03), "the master configuration takes 02 or 03", harmless=True),
        0xB2: setting("row_period", 0x25),
        0xB8: Command(8, _steps, {"steps": (1,) * 15}, name="gray table"),
        **dict.fromkeys((0xB0, 0xB4, 0xBF), nothing("timing {1:02X}", 1)),
        0xB9: relative("linear grey table of the SSD1327"),
        0xBC: setting("precharge_voltage", 0x00),
        0xBE: setting("vcomh", 0x00),
        **dict.fromkeys((0xAB, 0xB5, 0xB6, 0xD5, 0xFD), relative("supply and timing of the SSD1327", 1)),
    }

    @property
    def segment_remap(self) -> bool:
        """Whether column 0 is at the last segment."""
        return bool(self.registers.remap & 0x01)

    @property
    def high_first(self) -> bool:
        """Whether the upper half of a byte is the pixel nearer to column 0."""
        return self.segment_remap != bool(self.registers.remap & 0x02)

    @property
    def _line_clocks(self) -> int:
        return int(self.registers.row_period)

    @property
    def _pulses(self) -> tuple[int, ...]:
        """Each is longer than the one before by its step and one clock."""
        first, *more = self.registers.steps
        return tuple(itertools.accumulate((first, *(step + 1 for step in more))))

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """As of all chips, but with all lines driven unless they are fewer than the glass has."""
        multiplex, offset, start_line, com_reversed, com_pins = super().scan
        driven = multiplex if multiplex < self.height - 1 else self.lines - 1
        return driven, offset, start_line, com_reversed, com_pins


class SSD1362(GreyChip):
    """An SSD1362 with its glass: 256 x 64 pixels of four bits behind a window of that or of 206 x 36 pixels.

    Parameters, attributes and errors are those of `simulator.SSD1306`. Modules stand upright under A0 C3, with the left
    pixel in the upper half of a byte, or under A0 43 with the right one. Fading is state only.

    Examples
    --------
    >>> chip = SSD1362()
    >>> chip.write(bytes.fromhex("00 A0 C3 15 02 02 75 05 05 AF"))
    >>> chip.write(bytes.fromhex("40 C3"))
    >>> chip.pixels[5, 4:6].tolist()
    [12, 3]
    """

    columns, lines = 128, 64
    modules: ClassVar = {(256, 64): Module(0), (206, 36): Module(0, 0, 14)}
    alternate_bit, swap_bit = 0x00, 0x00
    upright = (True, False)
    commands: ClassVar = {
        **GREY,
        **windows(128, 64, 0x15, 0x75),
        0x23: setting("fade", 0x00),
        0x81: setting("contrast", 0x7F),
        0xA0: setting(
            "remap",
            0x40,
            [n for n in range(256) if n & 0x68 == 0x40],
            "bits 3 and 5 of the remap are 0, bit 6 is 1",
            name="remap {1:02X}",
        ),
        0xA1: setting("start_line", 0x00, range(64), "the start line is 00 to 3F", mask=0x3F),
        0xA2: setting("offset", 0x00, range(64), "the display offset is 00 to 3F", mask=0x3F),
        0xA8: setting("multiplex", 63, range(3, 64), "the multiplex ratio is 03 to 3F (4 to 64 lines)", mask=0x3F),
        0xAD: setting("reference", 0x8E, (0x8E, 0x9E), "the reference takes 8E or 9E", harmless=True),
        0xBC: setting("precharge_voltage", 0x04, range(32), "the precharge voltage is 00 to 1F", harmless=True),
        0xBD: setting("capacitor", 0x00, (0x00, 0x01), "the capacitor takes 00 or 01", harmless=True),
        0xE3: nothing("no operation"),
    }

    @property
    def segment_remap(self) -> bool:
        """Whether column 0 is at the last segment."""
        return bool(self.registers.remap & 0x01)

    @property
    def high_first(self) -> bool:
        """Whether the upper half of a byte is the pixel nearer to column 0; bit 7 swaps the segments' two sides."""
        remap = self.registers.remap
        return (self.segment_remap != bool(remap & 0x02)) != bool(remap & 0x80)


def _remap(chip: Any, sent: bytes) -> None:
    if sent[1] & 0xC8 or sent[2] & ~0x10 != 0x01:
        chip.complain("the remap is 00 to 37 without bit 3, and then 01 or 11", sent)
    chip.registers.remap, chip.registers.dual_com = sent[1], bool(sent[2] & 0x10)


def _use_table(chip: Any, sent: bytes) -> None:
    chip.registers.greys = chip.registers.table


def _greys_to_come(chip: Any, sent: bytes) -> None:
    """The SSD1322's table, which is used from 00 on."""
    before = chip.registers.greys
    _greys(chip, sent)
    chip.registers.table, chip.registers.greys = chip.registers.greys, before


def _write_ram(chip: Any, sent: bytes) -> None:
    chip.registers.writing = True


class SSD1322(GreyChip):
    """An SSD1322 with its glass: 480 x 128 pixels of four bits behind a window of 256 x 64 and others, on SPI alone.

    Parameters, attributes and errors are those of `simulator.SSD1306`; `column_offset` is 112 of 256 columns, of some
    modules 96. Arguments come with D/C high; data only after 5C. A column address is four pixels. Modules stand upright
    under A0 14 11, as vendors send it, that of 240x128 under A0 36 01; A0 06 11 turns the former by 180 degrees.

    Examples
    --------
    >>> chip = SSD1322()
    >>> for sent in ("A0 14 11", "CA 3F", "15 1C 5B", "75 00 3F", "AF", "5C C3 21"):
    ...     chip.transfer(bytes.fromhex(sent)[:1], data=False)
    ...     chip.transfer(bytes.fromhex(sent)[1:], data=True)
    >>> chip.pixels[0, :4].tolist()
    [12, 3, 2, 1]
    """

    buses = ("spi",)
    arguments_are_data = True
    columns, lines, column_bytes = 120, 128, 2
    modules: ClassVar = {
        (256, 64): Module(112),
        (240, 128): Module(96, 0x20, upright=(True, True)),
        **{(128, lines): Module(176, 0, 64 - lines) for lines in (64, 48, 32)},
        **{(256, lines): Module(112, 0, 64 - lines) for lines in (48, 32)},
        **{(64, lines): Module(208, 0, 64 - lines) for lines in (64, 48, 32)},
    }
    com_pin_settings = (0x00, 0x20)
    upright = (False, True)
    alternate_bit, swap_bit, down_bit = 0x20, 0x00, 0x01
    longest_pulse = 0xB4
    all_off, all_lit, inverse = 0xA4, 0xA5, 0xA7
    commands: ClassVar = {
        **GREY,
        **choice("display", 0xA6, {opcode: opcode for opcode in range(0xA4, 0xA8)}, "display mode {display:02X}"),
        **windows(120, 128, 0x15, 0x75),
        **_table(112),
        0x00: Command(0, _use_table, name="gray table in use"),
        0xB8: Command(15, _greys_to_come, {"table": tuple(range(0, 113, 8))}, name="gray table"),
        0x5C: Command(0, _write_ram, {"writing": False}, name="data follows"),
        0x5D: nothing("data is read from the RAM"),
        0xA0: Command(2, _remap, {"remap": 0x00, "dual_com": False}, name="remap {1:02X} {2:02X}"),
        0xA1: setting("start_line", 0x00, range(128), "the start line is 00 to 7F", mask=0x7F),
        0xA2: setting("offset", 0x00, range(128), "the display offset is 00 to 7F", mask=0x7F),
        0xA8: relative("multiplex ratio of the SSD1327; partial display here", 2),
        0xA9: nothing("partial display off"),
        0xB4: nothing("enhancement A", 2),
        0xBB: setting("precharge_voltage", 0x17, range(32), "the precharge voltage is 00 to 1F", harmless=True),
        0xC1: setting("contrast", 0x7F),
        0xC7: setting("master_contrast", 0x0F, range(16), "the master contrast is 00 to 0F", mask=0x0F),
        0xCA: setting("multiplex", 127, range(15, 128), "the multiplex ratio is 0F to 7F (16 to 128 lines)", mask=0x7F),
        0xD1: nothing("enhancement B", 2),
    }

    @property
    def segment_remap(self) -> bool:
        """Whether column 0 is at the last segments."""
        return bool(self.registers.remap & 0x02)

    @property
    def high_first(self) -> bool:
        """Whether the first pixel of a column address is the one nearer to column 0."""
        return bool(self.registers.remap & 0x04)
