"""An open file of /dev/i2c-N over a simulated bus."""

from __future__ import annotations

import errno
import struct
from collections.abc import Sequence
from typing import Final

from ..bus import I2CBus, Message
from ..wire import os_error

I2C_RETRIES: Final = 0x0701
I2C_TIMEOUT: Final = 0x0702
I2C_SLAVE: Final = 0x0703
I2C_TENBIT: Final = 0x0704
I2C_FUNCS: Final = 0x0705
I2C_SLAVE_FORCE: Final = 0x0706
I2C_RDWR: Final = 0x0707
I2C_PEC: Final = 0x0708
I2C_SMBUS: Final = 0x0720

QUICK, BYTE, BYTE_DATA, WORD_DATA, PROC_CALL, BLOCK_DATA, BLOCK_BROKEN, BLOCK_PROC_CALL, I2C_BLOCK_DATA = range(9)
_MOST: Final = 8192
_MOST_BLOCK: Final = 32
_BLOCK_BYTES: Final = _MOST_BLOCK + 2
_TEN: Final = 0x0010
_READ: Final = 0x0001
_INT_MAX: Final = 0x7FFFFFFF
_JIFFIES: Final = 0.01
"""Seconds that ``I2C_TIMEOUT`` counts in."""
_MESSAGE: Final = struct.Struct("=HHHH")
_SMBUS: Final = struct.Struct("=BBHI")


class I2CFile:
    """An open file of a bus, with an address of its own.

    Parameters
    ----------
    bus : I2CBus

    Examples
    --------
    >>> from paneldraw import simulator
    >>> chip = simulator.SSD1306()
    >>> file = I2CFile(simulator.I2CBus({0x3C: chip}))
    >>> file.set(I2C_SLAVE, 0x3C)
    >>> file.write(b"\\x00\\x81\\x40"), chip.contrast
    (3, 64)
    """

    def __init__(self, bus: I2CBus) -> None:
        self.bus = bus
        self.address = 0
        self._flags = 0
        self._checked = False

    def close(self) -> None:
        """Do nothing: what was set of the adapter stays."""

    def read(self, length: int) -> bytes:
        """Read from the address, 8192 bytes at most."""
        message = Message(self.address, length=min(length, _MOST), flags=self._flags | _READ)
        return message.answer.ljust(message.size, b"\0") if self.bus.rdwr([message]) else b""

    def write(self, payload: bytes) -> int:
        """Write to the address, 8192 bytes at most; return how many."""
        message = Message(self.address, payload[:_MOST], flags=self._flags)
        return message.size if self.bus.rdwr([message]) else 0

    def set(self, request: int, value: int) -> None:
        """Do a request whose argument is a number."""
        if request in (I2C_SLAVE, I2C_SLAVE_FORCE):
            self.bus.select(value, request == I2C_SLAVE_FORCE, 0x3FF if self._flags else 0x7F)
            self.address = value
        elif request == I2C_TENBIT:
            self._flags = _TEN if value else 0
        elif request == I2C_PEC:
            self._checked = bool(value)
        elif request in (I2C_RETRIES, I2C_TIMEOUT):
            if value > _INT_MAX:
                raise os_error(errno.EINVAL)
            if request == I2C_RETRIES:
                self.bus.retries = value
            else:
                self.bus.timeout = value * _JIFFIES
        else:
            raise os_error(errno.ENOTTY)

    def rdwr(self, messages: Sequence[Message]) -> int:
        """Do ``I2C_RDWR``; return how many messages went through."""
        return self.bus.rdwr(messages)

    def smbus(self, direction: int, command: int, size: int, data: bytes | None) -> bytes:
        """Do ``I2C_SMBUS``.

        Parameters
        ----------
        direction : int
            1 reads, 0 writes.
        command, size : int
            The register, and the kind of the transfer.
        data : bytes or None
            The 34 bytes of the kernel's union, or as many as the kind needs.

        Returns
        -------
        bytes
            What replaces the beginning of `data`.
        """
        if size > I2C_BLOCK_DATA or direction not in (0, 1):
            raise os_error(errno.EINVAL)
        if size == QUICK or (size == BYTE and not direction):
            if size == QUICK and direction:
                self._exchange(None, 0)
            else:
                self._exchange(b"" if size == QUICK else bytes((command,)))
            return b""
        if data is None:
            raise os_error(errno.EINVAL)
        return self._sized(direction, command, size, data)

    def _sized(self, direction: int, command: int, size: int, data: bytes) -> bytes:
        register = bytes((command,))
        if size in (BYTE, BYTE_DATA, WORD_DATA):
            count = 2 if size == WORD_DATA else 1
            if not direction:
                self._exchange(register + data[:count])
                return b""
            return self._exchange(None if size == BYTE else register, count)
        if size == PROC_CALL:
            return self._exchange(register + data[:2], 2)
        if size == BLOCK_PROC_CALL or (size == BLOCK_DATA and direction):
            raise os_error(errno.EOPNOTSUPP)
        count = _MOST_BLOCK if size == BLOCK_BROKEN and direction else data[0]
        if count > _MOST_BLOCK:
            raise os_error(errno.EINVAL)
        if direction:
            return bytes((count,)) + self._exchange(register, count)
        self._exchange(register + data[size != BLOCK_DATA : 1 + count])
        return b""

    def _exchange(self, payload: bytes | None, length: int | None = None) -> bytes:
        if self._checked:
            raise os_error(errno.EOPNOTSUPP)
        address = -1 if self._flags else self.address  # nobody has an address of ten bits
        return self.bus.exchange(address, payload, length)

    def ioctl(self, request: int, value: int, argument: bytes) -> tuple[int, bytes]:
        """Do a request as the C library packs it; return what the call returns, and what goes back."""
        if request == I2C_RDWR:
            messages = unpacked(argument)
            done = self.bus.rdwr(messages)
            return done, b"".join([m.answer.ljust(m.length, b"\0") for m in messages if m.length is not None])
        if request == I2C_SMBUS:
            direction, command, _, size = _SMBUS.unpack_from(argument)
            return 0, self.smbus(direction, command, size, argument[_SMBUS.size :] or None)
        if request == I2C_FUNCS:
            return 0, struct.pack("=Q", self.bus.funcs)
        self.set(request, value)
        return 0, b""


def unpacked(argument: bytes) -> list[Message]:
    """Messages as they are packed: all headers behind their number, then what the buffers hold."""
    (count,) = struct.unpack_from("=I", argument)
    at = 4 + count * _MESSAGE.size
    messages = []
    for address, flags, length, given in _MESSAGE.iter_unpack(argument[4:at]):
        messages.append(Message.of(address, flags, length, argument[at : at + given]))
        at += given
    if at != len(argument):
        raise ValueError("messages and their bytes do not agree")
    return messages
