"""LCD chips of one bit a pixel: the PCD8544, the ST7565 and its relatives, and the UC1609."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np

from .addressing import ACROSS, DOWN, PAGE, page_pointer
from .commands import DISPLAY, UNKNOWN, Command, Commands, choice, nothing, numbered, relative, setting, switch
from .display_chip import DisplayChip
from .frames import Picture
from .glass import Glass, Module
from .sh110x import end_modify, modify


def address(register: str, count: int) -> Command:
    """Put the low bits of a command, as many as `count` needs, into a register that can be up to `count` less 1."""

    def act(chip: Any, sent: bytes) -> None:
        number = sent[0] & (1 << (count - 1).bit_length()) - 1
        if number >= count:
            chip.complain(f"there is no {register} past {count - 1}", sent)
        setattr(chip.registers, register, number % count)

    return Command(0, act, {register: 0}, True, f"{register} pointer {{{register}}}")


# -- The PCD8544


def _function_set(chip: Any, sent: bytes) -> None:
    bits, registers = sent[0], chip.registers
    registers.on, registers.down, registers.extended = not bits & 0x04, bool(bits & 0x02), bool(bits & 0x01)


#: What function set and extended commands set.
_REGISTERS: Mapping[str, Any] = {
    "on": False,
    "down": False,
    "extended": False,
    "temperature": 0,
    "bias": 0,
    "contrast": 0,
}
_COMMON: Commands = {
    0x00: nothing("no operation"),
    **dict.fromkeys(
        range(0x20, 0x28),
        Command(0, _function_set, _REGISTERS, name="function set: power {on}, vertical {down}, extended {extended}"),
    ),
}
_EXTENDED: Commands = {
    **_COMMON,
    **numbered("temperature", 0x04, 4),
    **numbered("bias", 0x10, 8),
    **numbered("contrast", 0x80, 128),
}


class PCD8544(DisplayChip):
    """A PCD8544 with its glass: the display of the Nokia 5110, 84 x 48 pixels, on SPI alone.

    Parameters, attributes and errors are those of `simulator.SSD1306`. It shows nothing while it is powered down (24),
    blank (08) or without a voltage for the glass (21 80).

    Examples
    --------
    >>> chip = PCD8544()
    >>> chip.transfer(bytes.fromhex("21 13 C0 20 0C 80 40"), data=False)
    >>> chip.transfer(b"\\x03", data=True)
    >>> chip.pixels[:3, 0].tolist()
    [1, 1, 0]
    """

    look = "lcd-gray"
    buses = ("spi",)
    columns, lines = 84, 6
    modules: ClassVar = {(84, 48): Module()}
    upright = (False, False)
    supply_command = "21 80 and more"
    commands: ClassVar = {
        **_COMMON,
        **choice("display", 0x08, {0x08: 0x08, 0x09: 0x09, 0x0C: 0x0C, 0x0D: 0x0D}, "display mode {display:02X}"),
        **dict.fromkeys(range(0x40, 0x48), address("page", 6)),
        **dict.fromkeys(range(0x80, 0x100), address("column", 84)),
    }

    def _command(self, opcode: int) -> Command:
        return _EXTENDED.get(opcode, UNKNOWN) if self.registers.extended else super()._command(opcode)

    @property
    def fed(self) -> bool:
        """Whether there is a voltage for the glass."""
        return bool(self.external_vcc or self.registers.contrast)

    @property
    def lit(self) -> bool:
        """Whether pixels can be seen."""
        return super().lit and self.registers.display != 0x08

    @property
    def mode(self) -> int:
        """Whether data goes along banks or down columns, and on from the end of one to the next."""
        return DOWN if self.registers.down else ACROSS

    @property
    def segment_remap(self) -> bool:
        """Never: the chip has no such command."""
        return False

    @property
    def inverted(self) -> bool:
        """Whether levels are turned over."""
        return bool(self.registers.display == 0x0D)

    @property
    def all_on(self) -> bool:
        """Whether every pixel is on."""
        return bool(self.registers.display == 0x09)

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """All lines, as they stand."""
        return 47, 0, 0, False, 0


# -- The ST7565 and its relatives


def _internal_reset(*names: str) -> Command:
    """Put some registers back to what reset gives them."""

    def act(chip: Any, sent: bytes) -> None:
        for name in names:
            setattr(chip.registers, name, chip.reset_values[name])

    return Command(0, act, name="internal reset")


#: What the ST7565, the ST7567 and the UC1701 have in common.
PAGED: Commands = {
    **page_pointer(9),
    **DISPLAY,
    **switch("segment_remap", 0xA0),
    **switch("bias", 0xA2),
    **switch("all_on", 0xA4, "every pixel lit: {all_on}"),
    **switch("inverted", 0xA6, "inversion {inverted}"),
    **choice(
        "com_reversed",
        False,
        {opcode: opcode >= 0xC8 for opcode in range(0xC0, 0xD0)},
        "reversed COM scan {com_reversed}",
    ),
    **numbered("resistor_ratio", 0x20, 8),
    **numbered("power", 0x28, 8),
    **numbered("start_line", 0x40, 64),
    0x81: setting("contrast", 0x20, range(64), "the electronic volume is 00 to 3F", mask=0x3F, harmless=True),
    0xE0: Command(0, modify, {"kept_column": None}, name="read-modify-write from column {kept_column}"),
    0xE2: _internal_reset("column", "page", "start_line", "com_reversed", "resistor_ratio", "contrast", "kept_column"),
    0xE3: nothing("no operation"),
    0xEE: Command(0, end_modify, {"kept_column": None}, name="end of read-modify-write, column pointer {column}"),
    0xF8: setting("booster", 0x00, range(4), "the booster ratio is 00 to 03", mask=0x03),
    0xAC: relative("static indicator of the ST7565"),
    0xAD: relative("static indicator of the ST7565", 1),
    0xFA: relative("program control of the UC1701", 1),
    0x84: relative("line inversion of the ST7567"),
    0x85: relative("line inversion of the ST7567", 1),
}


class ST7565(DisplayChip):
    """An ST7565 with its glass: 132 x 65 bits of RAM, of which the last row is that of icons, on SPI alone.

    Parameters, attributes and errors are those of `simulator.SSD1306`, and `duty`: what the module's pins choose, 65
    (default), 55, 53, 49 or 33. Pixels are seen once booster, regulator and follower are on (2F). Data past column 131
    is lost. Display off with all points on is sleep, in which the RAM is kept and can be written.

    Examples
    --------
    >>> chip = ST7565()
    >>> chip.transfer(bytes.fromhex("A1 C0 2F AF B0 00 10"), data=False)
    >>> chip.transfer(b"\\x03", data=True)
    >>> chip.pixels[:3, 0].tolist()
    [1, 1, 0]
    """

    look = "lcd-green"
    buses: ClassVar[tuple[str, ...]] = ("spi",)
    columns, lines, last_rows = 132, 9, 1
    modules: ClassVar = {(128, 64): Module(), (128, 32): Module(4), (132, 64): Module()}
    duties: ClassVar[Mapping[tuple[int, int], int]] = {(128, 32): 33}
    """The duty that modules are wired for. Default: 65."""
    turned: ClassVar[tuple[tuple[int, int], ...]] = ()
    """Modules that stand upside down to others of the chip."""
    upright = (True, False)
    last_column_wraps = False
    supply_command = "2F"
    commands: ClassVar = {
        **PAGED,
        0xAC: nothing("static indicator"),
        0xAD: nothing("static indicator", 1),
    }

    def __init__(
        self, width: int | None = None, height: int | None = None, *, duty: int | None = None, **wiring: Any
    ) -> None:
        self._duty = duty
        super().__init__(width, height, **wiring)

    @property
    def fed(self) -> bool:
        """Whether booster, regulator and follower are on."""
        return bool(self.external_vcc or self.registers.power == 0x07)

    @property
    def asleep(self) -> bool:
        """Whether the chip needs next to no power."""
        return bool(not self.registers.on and self.registers.all_on)

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """Lines that the duty leaves, less 1, no display offset, start line, whether COM lines are reversed."""
        return (self._duty or 65) - 2, 0, self.registers.start_line, self.registers.com_reversed, 0

    def _wired(self, width: int, height: int, module: Module) -> Glass:
        self.commons = 64
        if self._duty is None:
            self._duty = self.duties.get((width, height), 65)
        if self._duty not in (65, 55, 53, 49, 33):
            raise ValueError(f"duty: {self._duty} is none of 65, 55, 53, 49, 33")
        if (width, height) in self.turned:
            self.upright = (not self.upright[0], not self.upright[1])
        if height > 65:
            raise ValueError(f"width and height: {width}x{height} is not within 1x1 and {self.columns}x65")
        return super()._wired(width, min(height, 64), module)

    def _look(self) -> Picture:
        if not self.lit:
            return np.zeros((self.height, self.width), np.uint8)
        rows = self._levels()
        seen, dark = self._glass.pixels(rows[:64], self)
        if self.height > 64:
            seen = np.vstack((seen, self._glass.dots(rows[64:])))
        if self.all_on:
            seen = np.ones_like(seen)
        elif self.inverted:
            seen = 1 - seen
        if dark is not None:
            seen[: len(dark)][dark] = 0
        return seen


class ST7567(ST7565):
    """An ST7567: an ST7565 without a static indicator, on SPI or I2C.

    Examples
    --------
    >>> chip = ST7567(64, 32)
    >>> chip.write(bytes.fromhex("00 A1 C0 2F A5 AF"))
    >>> chip.pixels.shape, int(chip.pixels.min())
    ((32, 64), 1)
    """

    buses = ("i2c", "spi")
    modules: ClassVar = {
        (128, 64): Module(4),
        (132, 64): Module(),
        (132, 32): Module(),
        (128, 32): Module(4),
        (122, 32): Module(4, 0, 32),
        (96, 65): Module(),
        (64, 32): Module(36),
    }
    duties: ClassVar = {(132, 32): 33, (128, 32): 33, (64, 32): 33}
    commands: ClassVar = {
        **PAGED,
        0x84: nothing("line inversion"),
        0x85: nothing("line inversion", 1),
    }


def _program(chip: Any, sent: bytes) -> None:
    if sent[1] & 0x6C or not sent[1] & 0x10:
        chip.complain("the program control is 10, with bits 7, 1 and 0 as wanted", sent)
    chip.registers.wraps = sent[1] & 0x03


class UC1701(ST7565):
    """A UC1701 with its glass: 132 x 65 bits of RAM behind 128 x 64 or 102 x 64 pixels, on SPI alone.

    The module of 128x64 stands upright under A0 C8, as U8g2 has it and luma.lcd has it upside down; the one of 102x64,
    a DOGS102, under A1 C0.

    Examples
    --------
    >>> chip = UC1701()
    >>> chip.transfer(bytes.fromhex("A0 C8 2F A5 AF"), data=False)
    >>> int(chip.pixels.sum())
    8192
    """

    modules: ClassVar = {(128, 64): Module(), (102, 64): Module()}
    duties: ClassVar = {}
    turned = ((102, 64),)
    upright = (False, True)
    commands: ClassVar = {
        **PAGED,
        0xAC: nothing("static indicator"),
        0xAD: nothing("static indicator", 1),
        0xF8: setting("booster", 0x00, range(2), "the booster ratio is 00 or 01", mask=0x01),
        0xFA: Command(1, _program, {"wraps": 0}, name="program control {1:02X}"),
    }

    @property
    def mode(self) -> int:
        """Whether data goes on from the end of a page to the next."""
        return ACROSS if self.registers.wraps == 0x03 else PAGE


# -- The UC1609


class DataPort:
    """The second address of a chip, which takes data where the first takes commands."""

    def __init__(self, chip: UC1609) -> None:
        self.chip = chip

    def write(self, payload: bytes) -> None:
        """Take one I2C write: data from its first byte."""
        self.chip.transfer(payload, data=True)

    def read(self, length: int) -> bytes:
        """Answer one I2C read with zeros: the RAM is not read here."""
        return bytes(length)

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Note that a bus call is over."""
        self.chip.settle(seconds, wire_bytes)


class UC1609(DisplayChip):
    """A UC1609 with its glass: 192 x 64 pixels, on SPI, or on I2C with `data` at the address after its own.

    Parameters, attributes and errors are those of `simulator.SSD1306`. On I2C there are no control bytes: the address
    says what is a command and what is data. The module stands upright under C4.

    Attributes
    ----------
    data : DataPort
        What answers at the second address.

    Notes
    -----
    After reset the chip's own supply is on, and data goes on from the end of a page to the next. Under 8A, which some
    drivers send, sources disagree: here it fills columns first, as U8g2 has it.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> chip = UC1609()
    >>> bus = simulator.I2CBus({0x3C: chip, 0x3D: chip.data})
    >>> bus.write_i2c_block_data(0x3C, 0xC4, [0x10, 0x00, 0xB0, 0xAF])
    >>> bus.write_byte(0x3D, 0x03)
    >>> chip.pixels[:3, 0].tolist()
    [1, 1, 0]
    """

    look = "lcd-green"
    columns, lines = 192, 8
    modules: ClassVar = {(192, 64): Module()}
    upright = (False, True)
    last_column_wraps = False
    supply, supply_command = ("power", 0x04), "2E"
    commands: ClassVar = {
        **page_pointer(8),
        **DISPLAY,
        **switch("all_on", 0xA4, "every pixel lit: {all_on}"),
        **switch("inverted", 0xA6, "inversion {inverted}"),
        **numbered("temperature", 0x24, 4),
        **numbered("power", 0x28, 8, reset=6),
        **dict.fromkeys(range(0x30, 0x34), nothing("test", 1)),
        **numbered("start_line", 0x40, 64),
        0x81: setting("contrast", 0x49),
        **numbered("access", 0x88, 8, reset=1),
        **numbered("frame_rate", 0xA0, 4, reset=1),
        **numbered("mapping", 0xC0, 8),
        0xE2: _internal_reset("column", "page", "start_line", "power", "access", "mapping", "contrast", "multiplex"),
        0xE3: nothing("no operation"),
        **numbered("bias", 0xE8, 4, reset=3),
        0xF1: setting("multiplex", 63, range(64), "the last COM line is 00 to 3F", mask=0x3F),
        **dict.fromkeys((0xF2, 0xF3), nothing("partial display {1}", 1)),
    }

    @property
    def data(self) -> DataPort:
        """What answers at the second address."""
        return DataPort(self)

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one I2C write to the first address: commands from its first byte."""
        self.transfer(payload, data=False)

    @property
    def mode(self) -> int:
        """Whether data stops at the end of a page, goes on with the next, or fills columns first."""
        if self.registers.access & 0x02:
            return DOWN
        return ACROSS if self.registers.access & 0x01 else PAGE

    @property
    def segment_remap(self) -> bool:
        """Whether column 0 is at the last segment."""
        return bool(self.registers.mapping & 0x02)

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """Last COM line, no display offset, scroll line, whether COM lines are reversed."""
        return self.registers.multiplex, 0, self.registers.start_line, bool(self.registers.mapping & 0x04), 0
