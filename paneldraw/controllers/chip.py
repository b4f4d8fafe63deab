"""Chips as tables: the facts of one, and the factory that makes a `Controller` of them for one module."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import Any, Final, NamedTuple

from paneldraw.controllers.record import Contrast, Controller, PagePointer, Window, commands, only_commands

Size = tuple[int, int]
_ELECTRICAL: Final = ("bias", "resistor_ratio", "level")
"""What a module of an unknown size has in common with the first of the sizes known."""
_CHOICES: Final[Mapping[str, Sequence[int]]] = MappingProxyType(
    {
        "com_pins": (0x02, 0x12, 0x22, 0x32),
        "bias": range(4, 12),
        "resistor_ratio": range(8),
        "duty": (33, 49, 53, 55, 65),
    }
)
"""What overrides can be on any chip."""


class Module(NamedTuple):
    """One module: a chip's glass, its wiring and which way up it is. What `Chip.init` and `Chip.window` are made of.

    ``upright`` is the argument of ``A0`` of a module that is bonded otherwise than the chip's common one.
    """

    chip: Chip
    width: int
    height: int
    column_offset: int = 0
    first_com: int = 0
    com_pins: int = 0x12
    clock: int = 0x80
    charge_pump: bool = True
    internal_reference: bool = False
    bias: int = 0
    resistor_ratio: int = 0
    duty: int = 65
    level: int = 0
    turned: bool = False
    upright: int | None = None
    mirror_x: bool = False
    mirror_y: bool = False

    @property
    def _driven(self) -> int:
        return self.width if self.chip.transposed else self.height

    @property
    def multiplex(self) -> str:
        """How many lines are driven, less one, in hex."""
        return f"{self._driven - 1:02X}"

    @property
    def segments(self) -> str:
        """Command that maps columns to segments, in hex."""
        mirrored = self.mirror_y if self.chip.transposed else self.mirror_x
        return f"{self.chip.upright[0] ^ mirrored ^ self.turned:02X}"

    @property
    def _lines(self) -> int:
        mirrored = self.mirror_x if self.chip.transposed else self.mirror_y
        return self.chip.upright[1] ^ 8 * (mirrored ^ self.turned)

    @property
    def lines(self) -> str:
        """Command of the direction of COM lines, in hex."""
        return f"{self._lines:02X}"

    @property
    def remap(self) -> int:
        """Argument of ``A0`` of chips that keep both directions in it."""
        upright, mirror_x, mirror_y = self.chip.remap
        return (self.upright or upright) ^ mirror_x * self.mirror_x ^ mirror_y * self.mirror_y

    @property
    def shift(self) -> int:
        """Lines by which the first row of the RAM must be shifted to be the glass's first line."""
        upwards = bool(self._lines & 8) if not self.chip.remap[0] else bool(self.remap & self.chip.remap[2])
        first = self.column_offset if self.chip.transposed else self.first_com
        if upwards:
            first += self._driven - (self.chip.reversed_lines or self._driven)
        return (first if upwards else -first) % self.chip.ram[0 if self.chip.transposed else 1]

    @property
    def offset(self) -> str:
        """Display offset that shifts by so many lines, in hex."""
        return f"{self.shift:02X}"

    @property
    def start_line(self) -> str:
        """Command of the row that the first COM line shows, of chips without a display offset, in hex."""
        last = max(self.duty - 1 - self.first_com - self.height, 0)
        return f"{0x40 + -(last if self._lines & 8 else self.first_com) % 64:02X}"


class Chip(NamedTuple):
    """What one kind of chip has, and, called, a `Controller` of it.

    Attributes
    ----------
    name : str
        As the datasheet has it.
    about : str
        What it is, in a few words.
    ram : (int, int)
        Columns and rows of its RAM, in pixels.
    modules : mapping of (int, int) to mapping
        Known sizes, the first being the default, and what is special in their wiring, by the names of `Module`.
    init : callable
        Makes of a `Module` the commands that configure it, as `record.commands` reads them.
    overrides : tuple of str
        What a module's wiring may differ in, beside ``column_offset``, ``mirror_x`` and ``mirror_y``.
    choices : mapping of str
        What an override can be, where this chip has less than others.
    mirrors : bool
        Whether the chip turns columns and lines over; else the driver does. Default: True.
    fold : int
        Rows that fit beneath each other; of a picture twice as high the lower half stands beside the upper one in the
        RAM. Default: all of the RAM's.
    upright : (int, int)
        The commands for segments and lines under which the common module is upright. Default: ``A1 C8``.
    reversed_lines : int
        So many lines a reversed scan begins at the end of, where they are not as many as are driven. Default: 0.
    transposed : bool
        Whether COM lines are the columns of the RAM, which ``column_offset`` counts then. Default: False.
    wide : int
        Columns of the RAM of look-alikes, whose modules begin at a later column. Default: 0, there are none.
    remap : (int, int, int)
        Of chips that have both in the argument of ``A0``: its value for the common module, and the bits that turn over
        columns and lines. Default: none.
    window : callable, optional
        Makes of a `Module` the addressing by windows. Default: none.
    drive : callable, optional
        Makes of a `Module` the commands for precharge and COM voltage, as init has them and ever darker. Default: none.
    address : int
        The usual one on I2C. Default: 0x3C.
    facts : mapping
        All else that a `Controller` says of the chip.

    Examples
    --------
    >>> from paneldraw.controllers import SSD1306
    >>> SSD1306.sizes[:2]
    ((128, 64), (128, 32))
    >>> SSD1306(64, 48).column_offset
    32
    """

    name: str
    about: str
    ram: Size
    modules: Mapping[Size, Mapping[str, Any]]
    init: Callable[[Module], str]
    overrides: tuple[str, ...] = ()
    choices: Mapping[str, Sequence[int]] = MappingProxyType({})
    mirrors: bool = True
    fold: int = 1 << 10
    upright: tuple[int, int] = (0xA1, 0xC8)
    reversed_lines: int = 0
    transposed: bool = False
    wide: int = 0
    remap: tuple[int, int, int] = (0, 0, 0)
    window: Callable[[Module], Window] | None = None
    pointer: PagePointer | None = None
    buses: tuple[str, ...] = ("i2c", "spi")
    contrast: Contrast | None = Contrast()
    drive: Callable[[Module], tuple[str, ...]] | None = None
    address: int = 0x3C
    facts: Mapping[str, Any] = MappingProxyType({})

    @property
    def sizes(self) -> tuple[Size, ...]:
        """Widths and heights of the modules known, in pixels; the first is the default."""
        return tuple(self.modules)

    @property
    def parameters(self) -> tuple[str, ...]:
        """What can be said of a module beside its size, by name."""
        return ("column_offset", *self.overrides, "mirror_x", "mirror_y", "chained_control")

    @property
    def depth(self) -> int:
        """Bits a pixel."""
        return 4 if self.facts.get("packing") == "nibbles" else 1

    def __call__(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        column_offset: int | None = None,
        first_com: int | None = None,
        com_pins: int | None = None,
        charge_pump: bool | None = None,
        internal_reference: bool | None = None,
        bias: int | None = None,
        resistor_ratio: int | None = None,
        duty: int | None = None,
        mirror_x: bool = False,
        mirror_y: bool = False,
        chained_control: bool = False,
    ) -> Controller:
        """Describe a module of this chip.

        Parameters
        ----------
        width, height : int, optional
            Visible pixels. Default: the first of `sizes`. A size that is none of them needs the offset, and the COM
            pins where the chip has them.
        column_offset : int, optional
            First visible RAM column, in pixels, of the module the right way up; of the SH1107 with no display offset.
            Default: what modules of this size have.
        first_com : int, optional
            First COM line that the glass is on. Default: what modules of this size have.
        com_pins : int, optional
            Argument of ``DA``, 0x02, 0x12, 0x22 or 0x32. Default: what modules of this size have.
        charge_pump : bool, optional
            False where the module is fed with the panel voltage from outside. Default: True.
        internal_reference : bool, optional
            Send ``AD 30``, without which modules with no resistor for the current are dim. Default: what modules of
            this size need.
        bias : int, optional
            LCD: 9 for a bias of 1/9, and so on. Default: what modules of this size need.
        resistor_ratio : int, optional
            LCD: step of the voltage regulator, 0 to 7, of which contrast is the fine part. Default: what modules of
            this size need.
        duty : int, optional
            LCD: the duty that the module's pins choose, 65, 55, 53, 49 or 33. Default: what modules of this size have.
        mirror_x, mirror_y : bool, optional
            For glass that is bonded the other way round. Default: False, the common module.
        chained_control : bool, optional
            Allow control bytes with the continuation bit, which genuine chips take and some clones do not. Default:
            False.

        Returns
        -------
        Controller

        Raises
        ------
        ValueError
            A size that no module has, given without its wiring; an override that the chip has not, or out of range.
        """
        size = self._size(width, height)
        given = {
            "column_offset": column_offset,
            "first_com": first_com,
            "com_pins": com_pins,
            "charge_pump": charge_pump,
            "internal_reference": internal_reference,
            "bias": bias,
            "resistor_ratio": resistor_ratio,
            "duty": duty,
        }
        given = {name: value for name, value in given.items() if value is not None}
        self._check(size, given)
        usual = self.modules[self.sizes[0]]
        known = self.modules.get(size) or {name: usual[name] for name in _ELECTRICAL if name in usual}
        module = Module(
            chip=self, width=size[0], height=size[1], mirror_x=mirror_x, mirror_y=mirror_y, **{**known, **given}
        )
        columns = self.ram[0]
        if module.column_offset > self._most(size[0], columns):
            columns = self.wide
        left, top = self._place(module, columns)
        return Controller(
            name=self.name.lower(),
            width=module.width,
            height=module.height,
            init=commands(self.init(module)),
            ram_width=columns,
            ram_height=self.ram[1],
            column_offset=left,
            row_offset=top,
            bands=2 if module.height > self.fold else 1,
            mirror_x=mirror_x and not self.mirrors,
            mirror_y=mirror_y and not self.mirrors,
            pointer=self.pointer,
            window=self.window(module) if self.window else None,
            chained_control=chained_control,
            buses=self.buses,
            contrast=self.contrast,
            drive=tuple(only_commands(text) for text in self.drive(module)) if self.drive else (),
            **self.facts,
        )

    def __repr__(self) -> str:
        return f"<{self.name}: {self.about}>"

    @property
    def _needed(self) -> list[str]:
        """What a module of an unknown size must be told."""
        return ["column_offset", *(["com_pins"] if "com_pins" in self.overrides else [])]

    def _most(self, width: int, columns: int) -> int:
        """The last column that a module can begin at."""
        return columns - 1 if self.transposed else columns - width

    def _place(self, module: Module, columns: int) -> Size:
        """Column and row of the RAM that a module's picture begins at: mirrored segments count from the other end."""
        if self.transposed:  # COM lines are shifted to where the RAM begins
            return 0, self.ram[1] - module.height if module.mirror_y else 0
        left = module.column_offset
        return columns - module.width - left if module.mirror_x and self.mirrors else left, 0

    def _size(self, width: int | None, height: int | None) -> Size:
        first = self.sizes[0]
        return (first[0] if width is None else width, first[1] if height is None else height)

    def _check(self, size: Size, given: Mapping[str, Any]) -> None:
        """Refuse what the chip cannot have, and a size of which too little is known."""
        width, height = size
        fits = 1 <= width <= self.ram[0] and 1 <= height <= self.ram[1]
        if not fits and size not in self.modules:
            most = f"{self.ram[0]}x{self.ram[1]}, which its RAM holds"
            raise ValueError(f"size of the {self.name} must be 1x1 to {most}, not {width}x{height}")
        for name in given:
            if name not in (*self.overrides, "column_offset"):
                has = ", ".join(self.parameters)
                raise ValueError(f"{name} must not be given for the {self.name}, which has {has}")
        if size not in self.modules and not all(name in given for name in self._needed):
            sizes, needed = listed(f"{w}x{h}" for w, h in self.sizes), " and ".join(f"{n}=" for n in self._needed)
            raise ValueError(
                f"size of the {self.name} must be {sizes}, not {width}x{height}; for another one give {needed} too"
            )
        offset, last = given.get("column_offset", 0), self._most(width, max(self.ram[0], self.wide))
        if not 0 <= offset <= last:
            raise ValueError(f"column_offset must be 0 to {last}, not {offset}")
        if not 0 <= given.get("first_com", 0) < self.ram[1]:
            raise ValueError(f"first_com must be 0 to {self.ram[1] - 1}, not {given['first_com']}")
        for name, allowed in {**_CHOICES, **self.choices}.items():
            if given.get(name, allowed[0]) not in allowed:
                values = listed(f"{value:#04x}" if name == "com_pins" else str(value) for value in allowed)
                raise ValueError(f"{name} of the {self.name} must be {values}, not {given[name]!r}")


def listed(names: Any) -> str:
    """Join names as a sentence has them.

    Examples
    --------
    >>> listed(["128x64", "128x32", "96x16"])
    '128x64, 128x32 or 96x16'
    """
    *most, last = names
    return f"{', '.join(most)} or {last}" if most else str(last)
