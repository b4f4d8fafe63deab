"""Solomon Systech SSD1306: 128x64 pixels of RAM, one bit a pixel."""

from __future__ import annotations

from typing import NamedTuple

from paneldraw.controllers.record import Controller, PagePointer, Window, commands

RAM_WIDTH, RAM_HEIGHT = 128, 64


class _Glass(NamedTuple):
    """What a module of one size needs: its first column, COM pins (``DA``) and clock (``D5``)."""

    column_offset: int
    com_pins: int
    clock: int = 0x80


_GLASSES = {
    (128, 64): _Glass(0, 0x12),
    (128, 32): _Glass(0, 0x02),
    (96, 16): _Glass(0, 0x02, clock=0x60),
    (72, 40): _Glass(28, 0x12),
    (64, 48): _Glass(32, 0x12),
    (64, 32): _Glass(32, 0x12),
    (48, 64): _Glass(40, 0x12),
}


def SSD1306(  # noqa: N802 - reads as the chip that it makes
    width: int = 128,
    height: int = 64,
    *,
    column_offset: int | None = None,
    com_pins: int | None = None,
    charge_pump: bool = True,
    mirror_x: bool = False,
    mirror_y: bool = False,
    internal_reference: bool = False,
    chained_control: bool = False,
) -> Controller:
    """Describe an SSD1306 module.

    Parameters
    ----------
    width, height : int, optional
        Visible pixels: 128x64 (default), 128x32, 96x16, 72x40, 64x48, 64x32 or 48x64.
    column_offset : int, optional
        First visible RAM column. Default: what modules of this size have.
    com_pins : int, optional
        Argument of ``DA``, 0x02, 0x12, 0x22 or 0x32. Default: what modules of this size have.
    charge_pump : bool, optional
        False where the module is fed with the panel voltage from outside. Default: True.
    mirror_x, mirror_y : bool, optional
        For glass that is bonded the other way round. Default: False, the common module.
    internal_reference : bool, optional
        Send ``AD 30``, without which 72x40 modules with a later die (SSD1306B, SSD1315) are dim. Default: False.
    chained_control : bool, optional
        Allow control bytes with the continuation bit, which genuine chips take and some clones do not. Default: False.

    Raises
    ------
    ValueError
        A size that no module has, or an offset or COM pins that the chip has not.

    Examples
    --------
    >>> SSD1306(64, 48).column_offset
    32
    """
    glass = _GLASSES.get((width, height))
    if glass is None:
        sizes = ", ".join(f"{w}x{h}" for w, h in _GLASSES)
        raise ValueError(f"size of an SSD1306 must be one of {sizes}, not {width}x{height}")
    pins = glass.com_pins if com_pins is None else com_pins
    if pins not in (0x02, 0x12, 0x22, 0x32):
        raise ValueError(f"com_pins must be 0x02, 0x12, 0x22 or 0x32, not {pins!r}")
    offset = glass.column_offset if column_offset is None else column_offset
    init = (
        *commands(f"AE, D5 {glass.clock:02X}, A8 {height - 1:02X}, D3 00, 40, 8D {'14' if charge_pump else '10'}"),
        *(commands("AD 30") if internal_reference else ()),
        *commands(f"20 02, {'A0' if mirror_x else 'A1'}, {'C0' if mirror_y else 'C8'}, DA {pins:02X}"),
        *commands("81 CF, D9 F1" if charge_pump else "81 9F, D9 22"),
        *commands("DB 30, 2E, A4, A6"),
    )
    return Controller(
        name="ssd1306",
        width=width,
        height=height,
        init=init,
        ram_width=RAM_WIDTH,
        ram_height=RAM_HEIGHT,
        column_offset=RAM_WIDTH - width - offset if mirror_x else offset,
        pointer=PagePointer(mode=b"\x20\x02", wraps=True),
        window=Window(columns=0x21, rows=0x22, across=b"\x20\x00", down=b"\x20\x01"),
        chained_control=chained_control,
    )
