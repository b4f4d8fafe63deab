"""Solomon Systech SSD1327: 128x128 pixels of RAM, four bits a pixel."""

from __future__ import annotations

from typing import NamedTuple

from paneldraw.controllers.record import Controller, Window, commands

RAM_WIDTH, RAM_HEIGHT = 128, 128
_UPRIGHT, _MIRROR_X, _MIRROR_Y, _DOWN = 0x51, 0x03, 0x10, 0x04
"""Argument of ``A0``: split COM lines, reversed, columns from the right; and what to turn over in it."""


class _Glass(NamedTuple):
    """What a module of one size needs: its first column, and the display offset (``A2``) upright and mirrored."""

    column_offset: int
    offset: int
    mirrored_offset: int


_GLASSES = {(128, 128): _Glass(0, 0x00, 0x00), (96, 96): _Glass(16, 0x20, 0x60)}


def SSD1327(  # noqa: N802 - reads as the chip that it makes
    width: int = 128, height: int = 128, *, mirror_x: bool = False, mirror_y: bool = False
) -> Controller:
    """Describe an SSD1327 module.

    Parameters
    ----------
    width, height : int, optional
        Visible pixels: 128x128 (default) or 96x96.
    mirror_x, mirror_y : bool, optional
        For glass that is bonded the other way round. Default: False, the common module.

    Raises
    ------
    ValueError
        A size that no module has.

    Examples
    --------
    >>> SSD1327(96, 96).depth
    4
    """
    glass = _GLASSES.get((width, height))
    if glass is None:
        sizes = ", ".join(f"{w}x{h}" for w, h in _GLASSES)
        raise ValueError(f"size of an SSD1327 must be one of {sizes}, not {width}x{height}")
    across = _UPRIGHT ^ (_MIRROR_X if mirror_x else 0) ^ (_MIRROR_Y if mirror_y else 0)
    offset = glass.mirrored_offset if mirror_y else glass.offset
    return Controller(
        name="ssd1327",
        width=width,
        height=height,
        init=(
            *commands(f"FD 12, AE, A8 {height - 1:02X}, A1 00, A2 {offset:02X}, A0 {across:02X}, AB 01, 81 53, B1 51"),
            *commands("B3 01, B9, BC 08, BE 07, B6 01, D5 62, A4"),
        ),
        ram_width=RAM_WIDTH,
        ram_height=RAM_HEIGHT,
        column_offset=glass.column_offset,
        packing="nibbles",
        pointer=None,
        window=Window(columns=0x15, rows=0x75, across=bytes((0xA0, across)), down=bytes((0xA0, across | _DOWN))),
        resync=b"\xb2" * 15,
        normal=b"\xa4",
    )
