"""What carries command and data bytes to a panel."""

from __future__ import annotations

from paneldraw.transports.base import COMMAND, DATA, Cost, Plan, Transport
from paneldraw.transports.i2c import I2CTransport
from paneldraw.transports.serial import SerialTransport
from paneldraw.transports.spi import SPITransport

__all__ = ["COMMAND", "DATA", "Cost", "I2CTransport", "Plan", "SPITransport", "SerialTransport", "Transport"]
