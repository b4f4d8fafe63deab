"""Solomon Systech SSD1322: 480x128 pixels of RAM, four bits a pixel, on SPI alone."""

from __future__ import annotations

from paneldraw.controllers.record import Controller, Window, commands

RAM_WIDTH, RAM_HEIGHT = 480, 128
_UPRIGHT, _MIRROR_X, _MIRROR_Y, _DOWN = 0x06, 0x02, 0x10, 0x01
"""First argument of ``A0``: columns from the left, nibbles in order, lines reversed; what to turn over in it."""


def SSD1322(  # noqa: N802 - reads as the chip that it makes
    width: int = 256,
    height: int = 64,
    *,
    column_offset: int = 112,
    mirror_x: bool = False,
    mirror_y: bool = False,
) -> Controller:
    """Describe an SSD1322 module.

    Parameters
    ----------
    width, height : int, optional
        Visible pixels: 256x64 (default).
    column_offset : int, optional
        First visible RAM column in pixels, a multiple of 4. Default: 112, the common module; some have 96.
    mirror_x, mirror_y : bool, optional
        For glass that is bonded the other way round. Default: False, the common module.

    Raises
    ------
    ValueError
        A size that no module has, or an offset that the chip has not.

    Examples
    --------
    >>> SSD1322().cell
    (4, 1)
    """
    if (width, height) != (256, 64):
        raise ValueError(f"size of an SSD1322 must be 256x64, not {width}x{height}")
    remap = _UPRIGHT ^ (_MIRROR_X if mirror_x else 0) ^ (_MIRROR_Y if mirror_y else 0)
    across = bytes((0xA0, remap, 0x11))
    return Controller(
        name="ssd1322",
        width=width,
        height=height,
        init=(
            *commands("FD 12, AE, B3 91, CA 3F, A2 00, A1 00, AB 01, B4 A0 FD, C1 9F, C7 0F, B9, B1 E2, D1 A2 20"),
            *commands("BB 1F, B6 08, BE 07, A6, A9"),
            across,
        ),
        ram_width=RAM_WIDTH,
        ram_height=RAM_HEIGHT,
        column_offset=column_offset,
        packing="nibbles",
        pointer=None,
        window=Window(
            columns=0x15,
            rows=0x75,
            across=across,
            down=bytes((0xA0, remap | _DOWN, 0x11)),
            column_bytes=2,
            write=b"\x5c",
        ),
        arguments_are_data=True,
        resync=b"",  # a command byte, with D/C low, always begins a command
        contrast=b"\xc1",
    )
