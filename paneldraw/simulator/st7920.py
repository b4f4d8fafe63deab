"""The ST7920: serial, with sync bytes in a D/C pin's place, and the lower half of its glass beside the upper one."""

from __future__ import annotations

import re
from typing import Any, ClassVar, Final

import numpy as np

from .addressing import ROWS, Bytes
from .commands import Command, choice, nothing, numbered
from .display_chip import DisplayChip
from .frames import Picture
from .glass import Glass, Module

_SYNC: Final = re.compile(rb"[\xf8-\xff]")
"""Half bytes end in four zeros, so that a sync byte is never one of them."""
_LEGAL: Final = bytes((*range(0, 0x100, 0x10), *range(0xF8, 0x100)))


def either(basic: Command, extended: Command) -> Command:
    """A command of no arguments that is one thing or another, as the register `extended` has it."""

    def act(chip: Any, sent: bytes) -> None:
        (extended if chip.registers.extended else basic).act(chip, sent)

    def name(chip: Any, sent: bytes) -> str:
        return (extended if chip.registers.extended else basic).reading(chip, sent)

    return Command(0, act, {**basic.registers, **extended.registers}, name=name)


def _function_set(chip: Any, sent: bytes) -> None:
    registers, extended = chip.registers, bool(sent[0] & 0x04)
    if registers.extended and extended:
        registers.graphics = bool(sent[0] & 0x02)
    registers.extended = extended  # and no more: one command cannot alter both, the sheet says


def _clear(chip: Any, sent: bytes) -> None:
    chip.registers.text, chip.registers.target, chip.registers.backwards = False, "text", False


def _entry(chip: Any, sent: bytes) -> None:
    chip.registers.backwards = not sent[0] & 0x02


def _text_address(chip: Any, sent: bytes) -> None:
    chip.registers.target = "text"


def _glyph_address(chip: Any, sent: bytes) -> None:
    chip.registers.target = "glyphs"


def _picture_address(chip: Any, sent: bytes) -> None:
    registers = chip.registers
    chip._progress.pointed = True
    if registers.half_address is None:
        if sent[0] & 0x40:
            chip.complain("there is no row past 63", sent)
        registers.half_address = sent[0] & 0x3F
        return
    if sent[0] & 0x70:
        chip.complain("there is no column past 15", sent)
    registers.row, registers.column = registers.half_address, sent[0] & 0x0F
    registers.half_address, registers.target = None, "picture"


def _address_name(chip: Any, sent: bytes) -> str:
    r = chip.registers
    return f"row pointer {r.row}, column pointer {r.column}" if r.half_address is None else f"row {r.half_address}"


_NOTHING: Final = nothing("nothing to be seen")
_ADDRESS: Final = Command(0, _picture_address, {"half_address": None, "row": 0, "column": 0}, name=_address_name)


class ST7920(DisplayChip):
    """An ST7920 with its glass: 64 rows of 16 words of 16 pixels, of which 32 are driven; on SPI, without a D/C pin.

    Parameters, attributes and errors are those of `simulator.SSD1306`. A module of 128x64 has its lower half in words 8
    to 15 of the same 32 rows. The chip listens while its chip select is high. Text has its place, and is not shown.

    Notes
    -----
    After power-up there is no text, as the sheet has it, and the picture is noise. Of the commands for text, only what
    may spoil a picture is kept: that there is some, and the direction of the cursor.

    Examples
    --------
    >>> chip = ST7920()
    >>> chip.transfer(bytes.fromhex("F8 00 C0 30 40 30 60 80 00 80 00"), data=False)  # 0C 34 36 80 80
    >>> chip.transfer(bytes.fromhex("FA C0 00 00 00"), data=False)  # C0 00
    >>> chip.pixels[0, :4].tolist()
    [1, 1, 0, 0]
    """

    buses = ("spi",)
    has_dc, look = False, "lcd-green"
    cs_high = True
    packing, line_name = ROWS._replace(elements=1), "row"  # bytes, which are spread when they are looked at
    columns, lines, column_bytes = 16, 64, 2
    modules: ClassVar = {size: Module() for size in ((128, 64), (128, 32), (144, 32), (160, 32), (192, 32), (256, 32))}
    upright = (False, False)
    commands: ClassVar = {
        0x01: either(Command(0, _clear, {"text": False, "target": "text"}, name="clear the text"), _NOTHING),
        **dict.fromkeys((0x02, 0x03), either(Command(0, _text_address, name="text address {0:02X}"), _NOTHING)),
        **dict.fromkeys(
            range(0x04, 0x08),
            either(Command(0, _entry, {"backwards": False}, name="cursor to the left {backwards}"), _NOTHING),
        ),
        **{
            n: either(display, _NOTHING)
            for n, display in choice("on", False, {n: n >= 0x0C for n in range(0x08, 0x10)}, "display {on}").items()
        },
        **dict.fromkeys(range(0x10, 0x20), _NOTHING),
        **dict.fromkeys(
            range(0x20, 0x40),
            Command(
                0,
                _function_set,
                {"extended": False, "graphics": False},
                name="function set: extended {extended}, graphics {graphics}",
            ),
        ),
        **{
            0x40 + n: either(Command(0, _glyph_address, name="glyph address {0:02X}"), scroll)
            for n, scroll in enumerate(numbered("scroll_row", 0x40, 64).values())
        },
        **dict.fromkeys(range(0x80, 0x100), either(Command(0, _text_address, name="text address {0:02X}"), _ADDRESS)),
    }

    def reset(self) -> None:
        """Pull the reset pin: registers at reset, a half-sent byte forgotten, RAM as it was."""
        super().reset()
        self._sync, self._half = 0, ""

    def deselect(self) -> None:
        """Note that the chip select falls: what comes next begins with a sync byte."""
        self._sync, self._half = 0, ""

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Refuse I2C, which the chip does not have."""
        raise ValueError("an ST7920 cannot sit on I2C, but on SPI")

    def transfer(self, run: bytes | bytearray | memoryview, data: bool) -> None:
        """Take bytes of the serial line; there is no D/C pin."""
        run = bytes(run)
        if run.translate(None, _LEGAL):
            self.complain("a half byte ends in four zeros")
        halves, at = run.hex()[::2], 0
        for sync in _SYNC.finditer(run):
            self._take_halves(halves[at : sync.start()])
            if self._half:
                self.complain("a byte is cut off after its first half")
            self._sync, self._half, at = run[sync.start()], "", sync.end()
            if self._sync & 0x05:
                self.complain("a sync byte is F8 or FA where nothing is read", sync.group())
        self._take_halves(halves[at:])

    def _take_halves(self, halves: str) -> None:
        """Take half bytes, of each its digit."""
        if not halves:
            return
        if not self._sync:
            self.complain("bytes before the first sync byte are lost")
            return
        halves = self._half + halves
        whole = len(halves) & ~1
        payload, self._half = bytes.fromhex(halves[:whole]), halves[whole:]
        if self._sync & 0x02:
            self._take_data(payload)
            return
        self._half_cell = b""
        for byte in payload:
            command, sent = self._table[byte], bytes((byte,))
            command.act(self, sent)
            if self.listener:
                self._tell(sent, command.reading(self, sent))
        if not self._progress.pointed:
            self._end_picture()
            self._picture = None

    def _take_data(self, data: bytes) -> None:
        registers = self.registers
        if registers.target == "text":
            registers.text = registers.text or bool(data.strip(b" "))
        elif registers.target == "picture":
            if registers.half_address is not None:
                self.complain("a row's address without a column's")
            if registers.text:
                self.complain("text shines through the picture; clear it (01)")
            if registers.backwards:
                self.complain("the cursor moves left, and the picture with it; send 06")
            data = self._half_cell + data
            whole = len(data) & ~1
            self._half_cell = data[whole:]
            self._fill(data[:whole])

    def _fill(self, words: bytes) -> None:
        """Put words into the row, around its end if need be."""
        registers, count = self.registers, len(words) // 2
        column, row = registers.column, registers.row
        room = min(count, 16 - column)
        place = row, slice(column, column + room)
        if self._progress.draw([place]):
            self._end_picture()
        if self.listener:
            self.listener.placed(2 * room, [place], False)
        self._ram[place] = np.frombuffer(words, np.uint8, 2 * room).reshape(room, 2)
        self._picture = None
        registers.column = (column + room) % 16
        if count > room:
            self._fill(words[2 * room :])

    def _lose_ram(self) -> None:
        self._ram[:] = np.frombuffer(self._random.randbytes(self._ram.size), np.uint8).reshape(self._ram.shape)

    def _levels(self) -> Picture:
        return np.unpackbits(self._ram.reshape(self.lines, -1), axis=1)

    def _spread(self, cells: Bytes) -> Bytes:
        return cells.repeat(8, axis=1)

    @property
    def contrast(self) -> int:
        """There is none: a trimmer on the module sets it."""
        return 0

    @property
    def fed(self) -> bool:
        """Always: a trimmer on the module makes the voltage for the glass."""
        return True

    @property
    def lit(self) -> bool:
        """Whether the picture can be seen."""
        return bool(self.registers.on and self.registers.graphics)

    @property
    def segment_remap(self) -> bool:
        """Never: the chip has no such command."""
        return False

    @property
    def inverted(self) -> bool:
        """Never: the chip turns over lines of text alone."""
        return False

    @property
    def all_on(self) -> bool:
        """Never: the chip has no such command."""
        return False

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """The 32 lines that are driven."""
        return 31, 0, 0, False, 0

    def _wired(self, width: int, height: int, module: Module) -> Glass:
        self._folded = height > 32
        if self._folded and (width, height) != (128, 64):
            raise ValueError(f"width and height: {width}x{height} is not within 256x32, and not 128x64")
        return super()._wired(2 * width if self._folded else width, min(height, 32), module)

    def _look(self) -> Picture:
        if not self.lit:
            return np.zeros((self.height, self.width), np.uint8)
        seen, _ = self._glass.pixels(self._levels(), self)
        return np.vstack(np.split(seen, 2, axis=1)) if self._folded else seen
