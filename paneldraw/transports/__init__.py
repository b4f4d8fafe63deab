"""What carries command and data bytes to a panel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from paneldraw._later import importer
from paneldraw.transports.base import COMMAND, DATA, Cost, Plan, Transport

if TYPE_CHECKING:
    from paneldraw.transports.i2c import I2CTransport
    from paneldraw.transports.serial import SerialTransport
    from paneldraw.transports.spi import SPITransport

__all__ = ["COMMAND", "DATA", "Cost", "I2CTransport", "Plan", "SPITransport", "SerialTransport", "Transport"]

if not TYPE_CHECKING:
    # A panel is on one of them.
    __getattr__ = importer(__name__, {"I2CTransport": "i2c", "SPITransport": "spi", "SerialTransport": "serial"})
