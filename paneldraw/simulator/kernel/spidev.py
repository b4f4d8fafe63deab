"""An open file of /dev/spidevB.D over a simulated bus."""

from __future__ import annotations

import errno
import struct
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from ..spi import SPIBus
from ..wire import os_error

_MAGIC: Final = ord("k")
_MESSAGE, _MODE, _LSB_FIRST, _BITS, _SPEED, _MODE32 = range(6)
_WRITE, _READ = 1, 2
_CS_HIGH, _LSB, _NO_CS = 0x04, 0x08, 0x40
_PLAIN: Final = 0x03

_TRANSFER: Final = struct.Struct("=IIHBBBB")
_TRANSFER_BYTES: Final = 32
"""Size of the kernel's ``spi_ioc_transfer``."""


@dataclass(frozen=True, slots=True)
class Transfer:
    """One piece of a message; `sent` is None for zeros."""

    length: int
    speed: int
    delay: int
    bits: int
    cs_change: bool
    sent: bytes | None
    wanted: bool


class SPIFile:
    """An open file of a bus; its settings are the bus's, as the kernel has them.

    Parameters
    ----------
    bus : SPIBus

    Examples
    --------
    >>> from paneldraw import simulator
    >>> chip = simulator.SSD1306()
    >>> SPIFile(simulator.SPIBus(chip)).write(b"\\x81\\x40"), chip.contrast
    (2, 64)
    """

    def __init__(self, bus: SPIBus) -> None:
        self.bus = bus

    def close(self) -> None:
        """Do nothing: what was set stays."""

    def read(self, length: int) -> bytes:
        """Read `length` bytes in one chip select, during which the data line sends zeros."""
        self.write(bytes(self._within(length)))
        return bytes(length)

    def write(self, payload: bytes) -> int:
        """Send in one chip select."""
        if self._within(len(payload)):
            self.bus.select([payload])
        return len(payload)

    def message(self, transfers: Sequence[Transfer]) -> int:
        """Do ``SPI_IOC_MESSAGE``; return how many bytes went over the wire."""
        self._within(sum(transfer.length for transfer in transfers if transfer.sent is not None))
        self._within(sum(transfer.length for transfer in transfers if transfer.wanted))
        if any(transfer.bits not in (0, 8) for transfer in transfers):
            raise os_error(errno.EINVAL)
        run: list[bytes] = []
        delay = 0
        for transfer in transfers:
            run.append(bytes(transfer.length) if transfer.sent is None else transfer.sent)
            delay += transfer.delay
            if transfer.cs_change or transfer is transfers[-1]:
                self.bus.select(run, transfer.speed, delay)
                run, delay = [], 0
        return sum(transfer.length for transfer in transfers)

    def ioctl(self, request: int, value: int, argument: bytes) -> tuple[int, bytes]:
        """Do a request as the C library packs it; return what the call returns, and what goes back."""
        direction, size, number = request >> 30, request >> 16 & 0x3FFF, request & 0xFF
        if request >> 8 & 0xFF != _MAGIC or number > _MODE32:
            raise os_error(errno.ENOTTY)
        if number == _MESSAGE:
            if direction != _WRITE or size % _TRANSFER_BYTES:
                raise os_error(errno.EINVAL if direction == _WRITE else errno.ENOTTY)
            transfers = _unpacked(argument) if size else []
            sent = self.message(transfers)
            return sent, bytes(sum(transfer.length for transfer in transfers if transfer.wanted))
        if direction == _READ:
            return 0, self._setting(number).to_bytes(size, "little")[:size]
        if direction == _WRITE:
            self._set(number, int.from_bytes(argument, "little"))
            return 0, b""
        raise os_error(errno.ENOTTY)

    def _within(self, length: int) -> int:
        if length > self.bus.bufsiz:
            raise os_error(errno.EMSGSIZE)
        return length

    def _setting(self, number: int) -> int:
        spi = self.bus.spi
        if number in (_MODE, _MODE32):
            return spi.mode | _CS_HIGH * spi.cshigh | _NO_CS * spi.no_cs
        return {_LSB_FIRST: 0, _BITS: 8, _SPEED: spi.max_speed_hz}[number]

    def _set(self, number: int, value: int) -> None:
        spi = self.bus.spi
        if number in (_MODE, _MODE32):
            if value & ~(_PLAIN | _CS_HIGH | _NO_CS):
                raise os_error(errno.EINVAL)
            spi.mode, spi.cshigh, spi.no_cs = value & _PLAIN, bool(value & _CS_HIGH), bool(value & _NO_CS)
        elif number == _LSB_FIRST:
            spi.lsbfirst = bool(value)
        elif number == _BITS:
            spi.bits_per_word = value or 8
        else:
            spi.max_speed_hz = value


def _unpacked(argument: bytes) -> list[Transfer]:
    """Transfers as they are packed: all headers behind their number, then what the buffers hold."""
    (count,) = struct.unpack_from("=I", argument)
    at = 4 + count * _TRANSFER.size
    transfers = []
    for length, speed, delay, bits, cs_change, sends, wants in _TRANSFER.iter_unpack(argument[4:at]):
        sent = argument[at : at + length] if sends else None
        at += length if sends else 0
        transfers.append(Transfer(length, speed, delay, bits, bool(cs_change), sent, bool(wants)))
    if at != len(argument):
        raise ValueError("transfers and their bytes do not agree")
    return transfers
