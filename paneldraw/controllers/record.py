"""What a driver must know of a panel chip, as data."""

from __future__ import annotations

from dataclasses import dataclass

ADDRESSING = ("page", "window")
PACKINGS = ("pages",)


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
    init : bytes
        Commands that bring the chip from any state to a dark, configured one, in page mode where it has modes.
    ram_width, ram_height : int
        Pixels that the chip's RAM holds.
    column_offset, row_offset : int
        RAM column and row of the top-left visible pixel. Default: 0.
    depth : int
        Bits a pixel. Default: 1.
    packing : str
        How pixels share bytes: ``"pages"`` is eight rows a byte, the topmost in the lowest bit. Default: ``"pages"``.
    addressing : tuple of str
        Ways to say where data goes: ``"page"`` (``B0+p 00+lo 10+hi``), ``"window"`` (``20`` mode, ``21`` columns,
        ``22`` pages). Default: ``("page",)``.
    column_wraps : bool
        Whether the column pointer of page mode returns from the last RAM column to the first. Default: False.
    chained_control : bool
        Whether the chip takes I2C control bytes with the continuation bit well, clones included. Default: False.
    resync : bytes
        Commands that do nothing, enough of them to satisfy a command that was cut off before its arguments.
    power_on, power_off, normal, inverse : bytes
        Commands of those names.
    contrast : bytes
        Command that the contrast byte follows. Default: ``81``.
    contrast_max : int
        Largest value of that byte. Default: 255.
    """

    name: str
    width: int
    height: int
    init: bytes
    ram_width: int
    ram_height: int
    column_offset: int = 0
    row_offset: int = 0
    depth: int = 1
    packing: str = "pages"
    addressing: tuple[str, ...] = ("page",)
    column_wraps: bool = False
    chained_control: bool = False
    resync: bytes = b"\xe3" * 6
    power_on: bytes = b"\xaf"
    power_off: bytes = b"\xae"
    normal: bytes = b"\xa6"
    inverse: bytes = b"\xa7"
    contrast: bytes = b"\x81"
    contrast_max: int = 255

    def __post_init__(self) -> None:
        if self.width < 1 or self.height < 1:
            raise ValueError(f"width and height must be positive, not {self.width}x{self.height}")
        if self.column_offset < 0 or self.column_offset + self.width > self.ram_width:
            raise ValueError(f"column_offset must be 0 to {self.ram_width - self.width}, not {self.column_offset}")
        if self.row_offset < 0 or self.row_offset + self.height > self.ram_height:
            raise ValueError(f"row_offset must be 0 to {self.ram_height - self.height}, not {self.row_offset}")
        if self.packing not in PACKINGS:
            raise ValueError(f"packing must be one of {', '.join(PACKINGS)}, not {self.packing!r}")
        if "page" not in self.addressing or not set(self.addressing) <= set(ADDRESSING):
            raise ValueError(f"addressing must hold 'page' and may hold 'window', not {self.addressing!r}")
        if self.height % 8 or self.row_offset % 8:
            raise ValueError(f"pages are 8 rows: height {self.height} and row_offset {self.row_offset} must fit them")
