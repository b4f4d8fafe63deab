"""Sino Wealth SH1106: 132x64 pixels of RAM, one bit a pixel, addressed by page pointer alone."""

from __future__ import annotations

from paneldraw.controllers.record import Controller, PagePointer, commands

RAM_WIDTH, RAM_HEIGHT = 132, 64


def SH1106(  # noqa: N802 - reads as the chip that it makes
    width: int = 128,
    height: int = 64,
    *,
    column_offset: int = 2,
    mirror_x: bool = False,
    mirror_y: bool = False,
    chained_control: bool = False,
) -> Controller:
    """Describe an SH1106 module.

    Parameters
    ----------
    width, height : int, optional
        Visible pixels: 128x64 (default).
    column_offset : int, optional
        First visible RAM column. Default: 2, the common module; some have 0 or 4.
    mirror_x, mirror_y : bool, optional
        For glass that is bonded the other way round. Default: False, the common module.
    chained_control : bool, optional
        Allow control bytes with the continuation bit. Default: False.

    Raises
    ------
    ValueError
        A size that no module has, or an offset that the chip has not.

    Examples
    --------
    >>> SH1106().window is None
    True
    """
    if (width, height) != (128, 64):
        raise ValueError(f"size of an SH1106 must be 128x64, not {width}x{height}")
    return Controller(
        name="sh1106",
        width=width,
        height=height,
        init=(
            *commands("AE, A4, D5 50, A8 3F, D3 00, 40, AD 8B, D9 22, DB 35, 32, 81 FF, A6, DA 12"),
            b"\xa0" if mirror_x else b"\xa1",
            b"\xc0" if mirror_y else b"\xc8",
        ),
        ram_width=RAM_WIDTH,
        ram_height=RAM_HEIGHT,
        column_offset=RAM_WIDTH - width - column_offset if mirror_x else column_offset,
        pointer=PagePointer(),
        chained_control=chained_control,
    )
