"""Rows and walls of MAX7219s."""

from __future__ import annotations

from typing import Final

from paneldraw import controllers
from paneldraw.compat.luma.core.device import device
from paneldraw.compat.luma.core.error import DeviceDisplayModeError
from paneldraw.compat.luma.core.interface.serial import Interface
from paneldraw.compat.luma.led_matrix.segment_mapper import dot_muncher

__all__ = ["max7219"]

_MOUNTED: Final = {0: 270, 90: 0, 180: 90, -90: 180}
"""How modules are turned for which luma has an orientation."""


class max7219(device):
    """MAX7219 matrices of 8x8 pixels, or digits of seven segments, in a row or a wall.

    Parameters
    ----------
    serial_interface : spi, optional
    width, height : int, optional
        Pixels, multiples of 8. Default: 8 and 8.
    cascaded : int, optional
        How many matrices there are in a row, instead.
    rotate : int, optional
        Quarter turns clockwise. Default: 0.
    block_orientation : int, optional
        0 (default), 90, -90 or 180: how each matrix is mounted.
    blocks_arranged_in_reverse_order : bool, optional
        Whether the data comes in on the right. Default: False.
    contrast : int, optional
        Brightness to begin with. Default: 0x70.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.core.interface.serial import noop, spi
    >>> bus = simulator.SPIBus(simulator.MAX7219(32, 8), dc=None, reset=None)
    >>> max7219(spi(spi=bus.spi, gpio=noop()), cascaded=4).size
    (32, 8)
    """

    chip = controllers.MAX7219
    glass = (8, 8)

    def __init__(
        self,
        serial_interface: Interface | None = None,
        width: int = 8,
        height: int = 8,
        cascaded: int | None = None,
        rotate: int = 0,
        block_orientation: int = 0,
        blocks_arranged_in_reverse_order: bool = False,
        contrast: int = 0x70,
    ) -> None:
        if block_orientation not in _MOUNTED:
            raise DeviceDisplayModeError(f"block_orientation must be 0, 90, -90 or 180, not {block_orientation!r}")
        if cascaded is not None:
            width, height = 8 * cascaded, 8
        self.cascaded = width * height // 64
        self.segment_mapper = dot_muncher
        first = "top-right" if blocks_arranged_in_reverse_order else "top-left"
        mounted = _MOUNTED[block_orientation]
        super().__init__(serial_interface, width, height, rotate, first_block=first, block_rotation=mounted)
        self.contrast(contrast)
