"""What a driver must know of a panel chip, as data."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

Levels = npt.NDArray[np.uint8]

#: Pixels that share a byte, by packing: columns and rows.
PACKINGS: Final = {"pages": (1, 8), "nibbles": (2, 1), "rows": (8, 1), "bits": (1, 1), "bytes": (1, 1)}
#: Kinds of bus, by the name that a transport and a record give them.
BUSES: Final = {"i2c": "I2C", "i2c-pair": "I2C with a data_address=", "spi": "SPI"}
_DEPTHS: Final = {"pages": 1, "nibbles": 4, "rows": 1, "bits": 1, "bytes": 8}
_PAUSE: Final = " ms"


def only_commands(text: str) -> tuple[bytes, ...]:
    """Read commands, each with its arguments, in hex and with commas in between.

    Examples
    --------
    >>> only_commands("AE, D5 80")
    (b'\\xae', b'\\xd5\\x80')
    """
    return tuple(map(bytes.fromhex, text.split(",")))


def commands(text: str) -> tuple[bytes | float, ...]:
    """Read commands, as `only_commands` does, and pauses in milliseconds among them, which become seconds.

    Examples
    --------
    >>> commands("AE, D5 80, 50 ms")
    (b'\\xae', b'\\xd5\\x80', 0.05)
    """
    return tuple(
        float(entry.removesuffix(_PAUSE)) / 1000 if entry.endswith(_PAUSE) else bytes.fromhex(entry)
        for entry in text.split(",")
    )


class PagePointer(NamedTuple):
    """One way to say where data goes: ``B0+p 00+lo 10+hi``, of which each can be sent alone, or the like.

    Attributes
    ----------
    mode : bytes
        Command that selects this way; empty where the chip has no other. Default: empty.
    wraps : bool
        Whether the column pointer returns from the last RAM column to the first. Default: False.
    row : int
        Command of the page or row, to which its number is added. Default: ``B0``.
    row_argument : bool
        Whether the number follows the command as an argument instead. Default: False.
    column : int, optional
        Command to which the column is added. Default: none, its halves are added to ``00`` and ``10``.
    paired : bool
        Whether row and column are always sent together, the row first. Default: False.
    turns : bool
        Whether data goes on from the last RAM column to the first of the next row, and from the last row to the first.
        Default: False.
    column_bytes : int
        Bytes that share a column address. Default: 1.

    Examples
    --------
    >>> PagePointer(mode=bytes((0x20, 2)), wraps=True).wraps
    True
    """

    mode: bytes = b""
    wraps: bool = False
    row: int = 0xB0
    row_argument: bool = False
    column: int | None = None
    paired: bool = False
    turns: bool = False
    column_bytes: int = 1


class Window(NamedTuple):
    """Another way: a rectangle, whose columns and rows each have a command, first and last one as arguments.

    The command puts the pointer at its first column or row; data fills the rectangle, and from its end goes on at its
    start.

    Attributes
    ----------
    columns, rows : int
        The two commands.
    across, down : bytes
        Commands that select this way, filled row by row and column by column.
    column_bytes : int
        Bytes that share a column address. Default: 1.
    write : bytes
        Command between any other and data. Default: none.

    Examples
    --------
    >>> Window(columns=0x21, rows=0x22, across=bytes((0x20, 0)), down=bytes((0x20, 1))).column_bytes
    1
    """

    columns: int
    rows: int
    across: bytes
    down: bytes
    column_bytes: int = 1
    write: bytes = b""


class Registers(NamedTuple):
    """The way of LED chips: a RAM of a few registers, and messages that begin with the number of the first they write.

    On I2C such a message has no control byte. Commands are messages of their own.

    Attributes
    ----------
    places : tuple of int
        Where in the RAM each pixel is, row by row: the number of its byte, or eight times that and the number of its
        bit, of which 0 is the lowest.
    size : int
        Bytes of the RAM.
    first : int
        Number of the register that is its first byte. Default: 0.
    command_bytes : int
        Bytes of a command. Default: 1.
    chips : int
        Chips in a row on SPI, each of which hands on what it took in two bytes before; the RAM is then eight registers
        of a byte for each chip, that of the chip at the far end first. Default: 0, the chip is alone and counts up the
        register itself.

    Examples
    --------
    >>> Registers(places=(1, 0), size=2).first
    0
    """

    places: tuple[int, ...]
    size: int
    first: int = 0
    command_bytes: int = 1
    chips: int = 0


class Contrast(NamedTuple):
    """How a chip is told the brightness of lit pixels.

    Attributes
    ----------
    command : bytes
        Command that the level follows. Default: ``81``. Empty where there is none, and levels are sent darker instead.
    highest : int
        The highest level. Default: 255.
    added : bool
        Whether the level is added to the command's last byte instead. Default: False.
    before, after : tuple of bytes
        Commands around it. Default: none.

    Examples
    --------
    >>> Contrast().commands(16), Contrast(command=b"\\xe0", added=True, highest=15).commands(255)
    ((b'\\x81\\x10',), (b'\\xef',))
    """

    command: bytes = b"\x81"
    highest: int = 255
    added: bool = False
    before: tuple[bytes, ...] = ()
    after: tuple[bytes, ...] = ()

    def commands(self, level: int) -> tuple[bytes, ...]:
        """Return the commands for a level of 0 to 255."""
        if not self.command:
            return ()
        level = round(level * self.highest / 255)
        *head, last = self.command
        command = bytes((*head, last + level)) if self.added else self.command + bytes((level,))
        return *self.before, command, *self.after


class Scroll(NamedTuple):
    """How a chip moves its picture by itself.

    A way is a command in hex, to the right; its first byte is one less than that to the left. In braces are the names
    of what is filled in: ``first`` and ``last``, the pages or rows that move; ``left`` and ``right``, the columns;
    ``speed``, the place of the interval in `frames`; ``columns``, whether columns move at all; and ``rows``, by how
    many rows the ``height`` rows below the ``top`` ones move up.

    Attributes
    ----------
    across : str
        To move by a column, again and again.
    diagonal : str
        To move by a column and some rows. Default: the chip cannot.
    area : str
        The command for the rows that the diagonal moves. Default: none.
    once : str
        To move by one column, once. Default: the chip cannot.
    frames : tuple of int
        The intervals, in frames of the panel, by the code for them.
    start, stop : bytes
        Commands that begin and end what was set up. Default: ``2F`` and ``2E``.
    pause : float
        Seconds that a single move takes. Default: 0.025, two frames of a slow clock.

    Examples
    --------
    >>> scroll = Scroll(across="26 00 {first} {speed} {last} 00 FF", frames=(5, 64))
    >>> scroll.command(scroll.across, True, first=0, last=7, speed=1).hex(" ")
    '27 00 00 01 07 00 ff'
    """

    across: str
    frames: tuple[int, ...]
    diagonal: str = ""
    area: str = ""
    once: str = ""
    start: bytes = b"\x2f"
    stop: bytes = b"\x2e"
    pause: float = 0.025

    def command(self, way: str, to_left: bool = False, /, **numbers: int) -> bytes:
        """Fill in a way's numbers."""
        right, *arguments = bytes.fromhex(way.format(**{name: f"{number:02X}" for name, number in numbers.items()}))
        return bytes((right + to_left, *arguments))


class Effect(NamedTuple):
    """What a chip does with its light by itself.

    Attributes
    ----------
    speeds : tuple of bytes
        Commands that begin it, from the slowest to the fastest.
    off : bytes
        Command that ends it.
    lights : bool
        Whether these commands turn the panel on, too, as `Controller.power_on` does. Default: False.

    Examples
    --------
    >>> Effect(speeds=(b"\\x87", b"\\x85", b"\\x83"), off=b"\\x81", lights=True).command(1.0)
    b'\\x83'
    """

    speeds: tuple[bytes, ...]
    off: bytes
    lights: bool = False

    def command(self, speed: float) -> bytes:
        """Return the command for a speed from 0, the slowest, to 1; the nearest there is."""
        if not 0 <= speed <= 1:
            raise ValueError(f"speed must be 0 to 1, not {speed!r}")
        return self.speeds[round(speed * (len(self.speeds) - 1))]


@dataclass(frozen=True, slots=True, kw_only=True)
class Controller:
    """A panel chip with the glass that is bonded to it. Make one with a chip's own function, such as ``SSD1306``.

    Commands are the bytes that follow a command control byte. A record is immutable; `dataclasses.replace` makes
    a variant.

    Attributes
    ----------
    name : str
        The chip, in lower case.
    width, height : int
        Visible pixels.
    init : tuple of bytes and float
        Commands, each with its arguments, that bring the chip from any state to a dark, configured one, in the mode of
        the page pointer if it has one, else with windows filled across. A number is a pause in seconds.
    ram_width, ram_height : int
        Pixels that the chip's RAM holds.
    column_offset, row_offset : int
        RAM column and row, in pixels, of the top-left visible pixel. Default: 0.
    packing : str
        How pixels share bytes: ``"pages"`` is eight rows of one bit a byte, the topmost in the lowest bit;
        ``"nibbles"`` two pixels of four bits, the left one in the upper half; ``"rows"`` eight columns of one bit, the
        left one in the highest bit; ``"bits"`` and ``"bytes"`` one bit or one byte a pixel, where the registers say.
        Default: ``"pages"``.
    bands : int
        How many bands of the picture, from the top, stand beside each other in the RAM. Default: 1.
    mirror_x, mirror_y : bool
        Whether the driver turns pictures over, for glass that is bonded the other way round where the chip cannot.
        Default: False.
    pointer : PagePointer, optional
    window : Window, optional
        The ways to say where data goes; there is one or both. Default: the page pointer alone.
    registers : Registers, optional
        The way of LED chips instead.
    arguments_are_data : bool
        Whether arguments of commands go as data, with D/C high, which rules I2C out. Default: False.
    chained_control : bool
        Whether the chip takes I2C control bytes with the continuation bit well, clones included. Default: False.
    pulses : tuple of int
        Clocks that a pixel of each level is lit, as `init` has it, where the chip takes a table of them. Light goes by
        them: they are even steps, so that half the level is half the light. Default: the chip takes none.
    resync : bytes
        Commands that do nothing, enough of them to satisfy a command that was cut off before its arguments.
    power_on, power_off, normal : bytes
        Commands of those names.
    inverse : bytes, optional
        Command that shows lit pixels dark; None where the driver turns levels over, empty where LED chips are sent
        pictures inverted. Default: ``A7``.
    contrast : Contrast, optional
        How it is told the brightness; None where it has none. Default: ``81`` and a byte.
    drive : tuple of tuple of bytes
        Commands for precharge and COM voltage, as init has them and then for steps ever darker. Default: none.
    scroll : Scroll, optional
        How it scrolls by itself. Default: it does not.
    blink, fade : Effect, optional
        How it blinks, and fades until it is dark, by itself. Default: it does not.
    all_on : bytes
        Command that lights every pixel, whatever the RAM holds. Default: none.
    follow : tuple of bytes
        Commands that end this, before `normal` or `inverse`. Default: none.
    status_off : int
        Bit of the byte read from it on I2C that says that the display is off; 0 if that cannot be read. Default: bit 6.
    buses : tuple of str
        What it can be on: ``"i2c"``, ``"spi"``, or ``"i2c-pair"``, where data goes to an address of its own and there
        are no control bytes. Default: the first two.
    synced : bool
        Whether the chip has no D/C pin, and bytes go as `transports.synced` has them. Default: False.
    speed : int
        Clock rate on SPI in Hz that the chip takes. Default: 8 000 000.
    """

    name: str
    width: int
    height: int
    init: tuple[bytes | float, ...]
    ram_width: int
    ram_height: int
    column_offset: int = 0
    row_offset: int = 0
    packing: str = "pages"
    bands: int = 1
    mirror_x: bool = False
    mirror_y: bool = False
    pointer: PagePointer | None = PagePointer()
    window: Window | None = None
    registers: Registers | None = None
    arguments_are_data: bool = False
    chained_control: bool = False
    pulses: tuple[int, ...] = ()
    resync: bytes = b"\xe3" * 6
    power_on: bytes = b"\xaf"
    power_off: bytes = b"\xae"
    normal: bytes = b"\xa6"
    inverse: bytes | None = b"\xa7"
    contrast: Contrast | None = Contrast()
    drive: tuple[tuple[bytes, ...], ...] = ()
    scroll: Scroll | None = None
    blink: Effect | None = None
    fade: Effect | None = None
    all_on: bytes = b""
    follow: tuple[bytes, ...] = ()
    status_off: int = 0x40
    buses: tuple[str, ...] = ("i2c", "spi")
    synced: bool = False
    speed: int = 8_000_000

    def __post_init__(self) -> None:
        if self.width < 1 or self.height < 1:
            raise ValueError(f"width and height must be positive, not {self.width}x{self.height}")
        if self.bands < 1 or self.height % self.bands:
            raise ValueError(f"bands must divide the height of {self.height}, not be {self.bands}")
        width, height = self.width * self.bands, self.height // self.bands
        if self.column_offset < 0 or self.column_offset + width > self.ram_width:
            raise ValueError(f"column_offset must be 0 to {self.ram_width - width}, not {self.column_offset}")
        if self.row_offset < 0 or self.row_offset + height > self.ram_height:
            raise ValueError(f"row_offset must be 0 to {self.ram_height - height}, not {self.row_offset}")
        if not self.buses or not set(self.buses) <= set(BUSES):
            raise ValueError(f"buses must be some of {', '.join(BUSES)}, not {self.buses}")
        if self.packing not in PACKINGS:
            raise ValueError(f"packing must be one of {', '.join(PACKINGS)}, not {self.packing!r}")
        if self.pointer is None and self.window is None and self.registers is None:
            raise ValueError("pointer, window and registers must not all be None: data must have a way")
        if (self.registers is not None) != (self.packing in ("bits", "bytes")):
            raise ValueError(f"registers must be given for a packing of bits or bytes alone, not {self.packing!r}")
        if self.registers is not None and len(set(self.registers.places)) != self.width * self.height:
            raise ValueError(f"registers must have a place of its own for each of {self.width}x{self.height} pixels")
        if self.arguments_are_data and (self.pointer is not None or not (self.window and self.window.write)):
            raise ValueError("arguments_are_data must be False where no command of the window sets data apart")
        if self.contrast is not None and not self.contrast.command and self.inverse:
            raise ValueError("contrast must have a command where inverse has one")
        wide, high = self.cell
        if self.width % wide or self.column_offset % wide:
            raise ValueError(f"width {self.width} and column_offset {self.column_offset} must be multiples of {wide}")
        if self.row_offset % high:
            raise ValueError(f"row_offset {self.row_offset} must be a multiple of {high}")

    @property
    def depth(self) -> int:
        """Bits a pixel."""
        return _DEPTHS[self.packing]

    def arranged(self, pixels: Levels) -> Levels:
        """Return a picture as the RAM has it: mirrored where the chip cannot, and its bands beside each other."""
        pixels = pixels[:: -1 if self.mirror_y else 1, :: -1 if self.mirror_x else 1]
        return np.hstack(np.split(pixels, self.bands)) if self.bands > 1 else pixels

    @property
    def cell(self) -> tuple[int, int]:
        """Width and height in pixels of what one address holds: the grid of pointers and windows."""
        wide, high = PACKINGS[self.packing]
        return wide * self.cell_bytes, high

    @property
    def cell_bytes(self) -> int:
        """Bytes of a cell."""
        way = self.window or self.pointer
        return way.column_bytes if way else 1
