"""LED chips: walls of MAX7219s on SPI, and matrices of one chip on I2C.

Wirings are as in luma.led_matrix, U8g2 and MD_MAX72XX (MAX7219) and in Adafruit's libraries for CircuitPython (the
others); commands are from the data sheets of Maxim, Holtek and ISSI.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

from paneldraw.controllers.chip import Size, listed
from paneldraw.controllers.record import Contrast, Controller, Effect, Registers, commands

Block = tuple[int, int]
"""A module of a wall: its column and its row."""
Wiring = Callable[[int, int], int]
"""Where in the RAM a pixel is, as in `Registers`."""

_BLOCK: Final = 8
_CORNERS: Final = ("top-left", "top-right", "bottom-left", "bottom-right")
_ORDERS: Final = ("rows", "columns", "serpentine")
_MIRRORS: Final = ("mirror_x", "mirror_y")


# -- Chips in a row


#: What no LED chip here has: commands that do nothing, inversion, and a status to read.
_LACKING: Final[dict[str, Any]] = {"resync": b"", "normal": b"", "inverse": b"", "status_off": 0}


class Chain(NamedTuple):
    """A chip of 8 x 8 LEDs of which any number stand in a row, and, called, a `Controller` of a wall of them.

    Attributes
    ----------
    name, about, sizes, buses, depth, parameters, address
        As of a `Chip`; a wall may be of any size in blocks of 8 x 8.
    init : str
        The commands that configure it, as `record.commands` reads them.

    Examples
    --------
    >>> from paneldraw.controllers import MAX7219
    >>> MAX7219(64, 16).registers.chips
    16
    """

    name: str
    about: str
    init: str
    power_on: bytes
    power_off: bytes
    contrast: Contrast
    all_on: bytes = b""
    follow: tuple[bytes, ...] = ()
    sizes: tuple[Size, ...] = ((32, 8), (8, 8), (64, 8), (128, 8), (32, 16), (64, 16), (32, 32), (64, 64))
    buses: tuple[str, ...] = ("spi",)
    depth: int = 1
    parameters: tuple[str, ...] = ("order", "first_block", "block_rotation", "mirror_blocks", *_MIRRORS)
    address: int = 0x3C

    def __call__(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        order: str | Sequence[Block] = "rows",
        first_block: str | None = None,
        block_rotation: int | str | Sequence[int] = 0,
        mirror_blocks: bool = False,
        mirror_x: bool = False,
        mirror_y: bool = False,
    ) -> Controller:
        """Describe a wall of modules.

        Parameters
        ----------
        width, height : int, optional
            Visible pixels, multiples of 8. Default: the first of `sizes`.
        order : str or sequence of (int, int), optional
            How the data goes through the blocks: ``"rows"`` one row after the other, each in the same direction
            (default); ``"columns"`` likewise; ``"serpentine"`` every second row the other way, with its blocks upside
            down, as short wires have it; or the column and row of each block in the order of the data, which
            ``"0.0,1.0,1.1,0.1"`` says too.
        first_block : str, optional
            The corner where the data comes in: ``"top-right"`` (default), as on boards of four modules,
            ``"top-left"``, ``"bottom-right"`` or ``"bottom-left"``.
        block_rotation : int or sequence of int, optional
            Degrees by which modules are mounted turned clockwise: 0 (default) where the first register is the top row
            and its highest bit on the left, 90, 180 or 270; or those of each block, in the order of the data.
        mirror_blocks : bool, optional
            True where the text is mirrored in every block: the highest bit is on the right. Default: False.
        mirror_x, mirror_y : bool, optional
            For a wall that is seen in a mirror. Default: False.

        Returns
        -------
        Controller

        Raises
        ------
        ValueError
            A size that blocks do not fill, or a wiring that leaves one out or has it twice.
        """
        size = (self.sizes[0][0] if width is None else width, self.sizes[0][1] if height is None else height)
        if min(size) < _BLOCK or size[0] % _BLOCK or size[1] % _BLOCK:
            raise ValueError(f"size of the {self.name} must be in blocks of 8x8, such as 32x8, not {size[0]}x{size[1]}")
        wide, high = size[0] // _BLOCK, size[1] // _BLOCK
        blocks = _blocks(wide, high, order, first_block)
        turns = _turns(block_rotation, len(blocks))
        if order == "serpentine":
            rows = list(dict.fromkeys(row for _, row in blocks))
            turns = [turn + 180 * (rows.index(row) % 2) for turn, (_, row) in zip(turns, blocks, strict=True)]
        places = {}
        for number, (block, turn) in enumerate(zip(blocks, turns, strict=True)):
            far = len(blocks) - 1 - number  # what goes out first ends up in the last
            for y in range(_BLOCK):
                for x in range(_BLOCK):
                    column, row = _upright(x, y, turn)
                    bit = column if mirror_blocks else 7 - column
                    places[8 * block[0] + x, 8 * block[1] + y] = 8 * (row * len(blocks) + far) + bit
        return Controller(
            name=self.name.lower(),
            width=size[0],
            height=size[1],
            init=commands(self.init),
            ram_width=size[0],
            ram_height=size[1],
            packing="bits",
            pointer=None,
            registers=Registers(
                places=_seen(size, lambda x, y: places[x, y], mirror_x, mirror_y),
                size=8 * len(blocks),
                command_bytes=2,
                chips=len(blocks),
            ),
            power_on=self.power_on,
            power_off=self.power_off,
            contrast=self.contrast,
            **_LACKING,
            all_on=self.all_on,
            follow=self.follow,
            buses=self.buses,
        )

    def __repr__(self) -> str:
        return f"<{self.name}: {self.about}>"


def _blocks(wide: int, high: int, order: str | Sequence[Block], first: str | None) -> list[Block]:
    """The blocks of a wall in the order of the data, each there once."""
    if isinstance(order, str) and order in _ORDERS:
        return list(_walk(wide, high, order, first or "top-right"))
    if first is not None:
        raise ValueError(f"first_block must not be given where order says all, not {first!r}")
    blocks = _read_blocks(order)
    there = {(column, row) for column in range(wide) for row in range(high)}
    wrong = [f"{block} is missing" for block in sorted(there - set(blocks), key=lambda block: block[::-1])]
    for block, times in Counter(blocks).items():
        if block not in there:
            wrong.append(f"{block} is outside")
        elif times > 1:
            wrong.append(f"{block} is there {'twice' if times == 2 else f'{times} times'}")
    if wrong:
        raise ValueError(f"order must name each of {wide}x{high} blocks (column, row) once: {', '.join(wrong)}")
    return blocks


def _walk(wide: int, high: int, order: str, first: str) -> Iterator[Block]:
    if first not in _CORNERS:
        raise ValueError(f"first_block must be {listed(_CORNERS)}, not {first!r}")
    columns = range(wide) if first.endswith("left") else range(wide - 1, -1, -1)
    rows = range(high) if first.startswith("top") else range(high - 1, -1, -1)
    if order == "columns":
        yield from ((column, row) for column in columns for row in rows)
        return
    for turn, row in enumerate(rows):
        back = order == "serpentine" and turn % 2 == 1
        yield from ((column, row) for column in (reversed(columns) if back else columns))


def _read_blocks(order: str | Sequence[Block]) -> list[Block]:
    try:
        pairs = [block.split(".") for block in order.split(",")] if isinstance(order, str) else order
        return [(int(column), int(row)) for column, row in pairs]
    except (TypeError, ValueError):
        advice = f"{listed(map(repr, _ORDERS))}, or the column and row of each block, such as '0.0,1.0'"
        raise ValueError(f"order must be {advice}, not {order!r}") from None


def _turns(rotation: int | str | Sequence[int], count: int) -> list[int]:
    """The rotation of each of so many blocks."""
    try:
        if isinstance(rotation, str):
            rotation = [int(turn) for turn in rotation.split(",")]
        turns = [rotation] if isinstance(rotation, int) else [int(turn) for turn in rotation]
    except (TypeError, ValueError):
        turns = []
    if len(turns) not in (1, count) or not set(turns) <= {0, 90, 180, 270}:
        raise ValueError(f"block_rotation must be 0, 90, 180 or 270, one or {count} of them, not {rotation!r}")
    return turns * count if len(turns) == 1 else turns


def _upright(x: int, y: int, turn: int) -> tuple[int, int]:
    """Where a pixel of a module that is turned clockwise would be if it were not."""
    for _ in range(turn // 90 % 4):
        x, y = y, 7 - x
    return x, y


MAX7219 = Chain(
    name="MAX7219",
    about="LED, 1 bit a pixel, on SPI: modules of 8x8 in a row or a wall",
    init="0F 00, 0C 00, 09 00, 0A 0A, 0B 07",
    power_on=b"\x0c\x01",
    power_off=b"\x0c\x00",
    contrast=Contrast(command=b"\x0a", highest=15),
    all_on=b"\x0f\x01",  # the display test, in full brightness
    follow=(b"\x0f\x00",),
)


# -- Chips alone


class Matrix(NamedTuple):
    """A chip that lights a matrix of LEDs alone, and, called, a `Controller` of a module of it.

    Attributes
    ----------
    name, about, sizes, buses, depth, parameters, address
        As of a `Chip`.
    boards : mapping of (int, int) to mapping
        The wirings of boards of one size by name, the first being the default.
    init : str
        The commands that configure it, as `record.commands` reads them.

    Examples
    --------
    >>> from paneldraw.controllers import IS31FL3731
    >>> IS31FL3731.depth, IS31FL3731.sizes[0], hex(IS31FL3731.address)
    (8, (16, 9), '0x74')
    """

    name: str
    about: str
    address: int
    boards: Mapping[Size, Mapping[str, Wiring]]
    init: str
    power_on: bytes
    power_off: bytes
    contrast: Contrast
    depth: int
    ram_bytes: int
    first: int
    command_bytes: int
    blink: Effect | None = None
    buses: tuple[str, ...] = ("i2c",)

    @property
    def sizes(self) -> tuple[Size, ...]:
        """Widths and heights of the modules known, in pixels; the first is the default."""
        return tuple(self.boards)

    @property
    def parameters(self) -> tuple[str, ...]:
        """What can be said of a module beside its size, by name."""
        return (*(["board"] if any(len(boards) > 1 for boards in self.boards.values()) else []), *_MIRRORS)

    def __call__(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        board: str | None = None,
        mirror_x: bool = False,
        mirror_y: bool = False,
    ) -> Controller:
        """Describe a module of this chip.

        Parameters
        ----------
        width, height : int, optional
            Visible pixels, one of `sizes`. Default: the first of them.
        board : str, optional
            Which board, where those of one size differ. Default: the first of `boards`.
        mirror_x, mirror_y : bool, optional
            For a matrix that is bonded the other way round. Default: False.

        Returns
        -------
        Controller

        Raises
        ------
        ValueError
            A size or board that is not known.
        """
        first = self.sizes[0]
        size = (first[0] if width is None else width, first[1] if height is None else height)
        if size not in self.boards:
            sizes = listed(f"{w}x{h}" for w, h in self.sizes)
            raise ValueError(f"size of the {self.name} must be {sizes}, not {size[0]}x{size[1]}")
        boards = self.boards[size]
        if board is not None and board not in boards:
            raise ValueError(f"board must be {listed(boards)} for {size[0]}x{size[1]}, not {board!r}")
        wiring = boards[board or next(iter(boards))]
        return Controller(
            name=self.name.lower(),
            width=size[0],
            height=size[1],
            init=commands(self.init),
            ram_width=size[0],
            ram_height=size[1],
            packing="bits" if self.depth == 1 else "bytes",
            pointer=None,
            registers=Registers(
                places=_seen(size, wiring, mirror_x, mirror_y),
                size=self.ram_bytes,
                first=self.first,
                command_bytes=self.command_bytes,
            ),
            power_on=self.power_on,
            power_off=self.power_off,
            contrast=self.contrast,
            **_LACKING,
            blink=self.blink,
            buses=self.buses,
        )

    def __repr__(self) -> str:
        return f"<{self.name}: {self.about}>"


def _seen(size: Size, wiring: Wiring, mirror_x: bool, mirror_y: bool) -> tuple[int, ...]:
    """The places of all pixels, row by row, as they are seen."""
    columns, rows = (range(length) for length in size)
    if mirror_x:
        columns = columns[::-1]
    if mirror_y:
        rows = rows[::-1]
    return tuple(wiring(x, y) for y in rows for x in columns)


HT16K33 = Matrix(
    name="HT16K33",
    about="LED, 1 bit a pixel, on I2C; Adafruit's backpacks and FeatherWings of 8x8 and 16x8",
    address=0x70,
    boards={
        (16, 8): {
            "backpack": lambda x, y: 8 * (2 * y + x // 8) + x % 8,
            "featherwing": lambda x, y: 8 * (2 * (x % 8) + x // 8) + y,
        },
        (8, 8): {"backpack": lambda x, y: 8 * 2 * y + (x - 1) % 8},  # the matrix's pins begin with its second column
    },
    init="21, 80, A0, EF",
    power_on=b"\x81",
    power_off=b"\x80",
    contrast=Contrast(command=b"\xe0", added=True, highest=15),
    depth=1,
    ram_bytes=16,
    first=0x00,
    command_bytes=1,
    blink=Effect(speeds=(b"\x87", b"\x85", b"\x83"), off=b"\x81", lights=True),  # 0.5, 1 and 2 Hz
)

_LED_ON: Final = ", ".join(f"{register:02X} FF" for register in range(0x12))

IS31FL3731 = Matrix(
    name="IS31FL3731",
    about="LED, 256 brightnesses a pixel, on I2C; CharliePlex matrices, wings and bonnets",
    address=0x74,
    boards={
        (16, 9): {"matrix": lambda x, y: 16 * y + x},
        (15, 7): {"featherwing": lambda x, y: 16 * x + 7 - y if x < 8 else 16 * (15 - x) + 8 + y},
        (16, 8): {"bonnet": lambda x, y: 16 * (x + 1) + 7 - y if x < 8 else 16 * (x - 6) - 1 - y},
        (17, 7): {"scroll-phat-hd": lambda x, y: 16 * (8 - x) + 6 - y if x < 9 else 16 * (x - 8) - 8 + y},
        (11, 7): {"matrix-11x7": lambda x, y: 16 * x + 6 - y if x < 6 else 16 * x - 82 - y},
    },
    # Page 0B: dark, picture mode, frame 0, no blinking, sound or breathing. Page 0: all LEDs in use.
    init=f"FD 0B, 0A 00, 00 00, 01 00, 05 00, 06 00, 09 00, FD 00, {_LED_ON}",
    power_on=bytes.fromhex("FD 0B 0A 01 FD 00"),
    power_off=bytes.fromhex("FD 0B 0A 00 FD 00"),
    contrast=Contrast(command=b""),
    depth=8,
    ram_bytes=0x90,
    first=0x24,
    command_bytes=2,
)
