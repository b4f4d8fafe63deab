"""Panels on an I2C bus, through smbus2."""

from __future__ import annotations

import ctypes
import errno
import glob
import os
from types import ModuleType
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelNotFoundError,
    PanelPermissionError,
    PanelTimeoutError,
    TransportError,
)
from paneldraw.transports.base import CHAINED, COMMAND, DATA, Cost, Plan, join_group, transient
from paneldraw.transports.pins import Line, PanelLines, Pins

MESSAGES_A_CALL: Final = 42
BYTES_A_MESSAGE: Final = 8192
PANEL_ADDRESSES: Final = (0x3C, 0x3D)
_NO_ACKNOWLEDGE = (errno.EREMOTEIO, errno.ENXIO)  # which of the two depends on the adapter's driver
_BUSY = (errno.EAGAIN, errno.EBUSY)
_FRAMING = 2  # address byte and control byte


class I2CTransport:
    """Commands and data for the panel at one address of an I2C bus.

    Parameters
    ----------
    bus : int, str or object, optional
        Number of the bus, path of its device, or an object with the interface of `smbus2.SMBus`, which remains the
        caller's to close. Default: 1, as on a Raspberry Pi's header.
    address : int, optional
        The panel's 7-bit address, 0x08 to 0x77. Default: 0x3C.
    max_message : int, optional
        Longest message in bytes that the bus adapter takes, control byte included, 2 to 8192. Default: 8192, the
        kernel's own limit.
    reset : int or str, optional
        GPIO line of the module's reset pin, which is pulsed here and by `reset`: a number on the header's chip (BCM's,
        not the pin's) or the line's name. Default: none, as most modules reset themselves; 2.42-inch ones do not.
    pins : object, optional
        An object with a method ``set(line, value)``. Default: the line through gpiod.
    gpiochip : int or str, optional
        Number or path of the GPIO chip that has the line. Default: the header's.

    Raises
    ------
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        The bus or the line cannot be opened.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)})
    >>> I2CTransport(bus).command(b"\\xaf")  # bytes on the wire: address, control byte, command
    3
    """

    wire = "i2c"

    def __init__(
        self,
        bus: Any = 1,
        address: int = 0x3C,
        *,
        max_message: int = BYTES_A_MESSAGE,
        reset: Line | None = None,
        pins: Pins | None = None,
        gpiochip: int | str | None = None,
    ) -> None:
        if isinstance(address, bool) or not isinstance(address, int):
            raise TypeError(f"address must be an int, not {address!r}")
        if not 0x08 <= address <= 0x77:
            raise ValueError(f"address must be 0x08 to 0x77, usually 0x3C or 0x3D, not {address:#x}")
        if not 2 <= max_message <= BYTES_A_MESSAGE:
            raise ValueError(f"max_message must be 2 to {BYTES_A_MESSAGE}, not {max_message}")
        chained = _FRAMING if max_message == BYTES_A_MESSAGE else None  # a chained message cannot be split
        self.cost = Cost(_FRAMING, _FRAMING, chained, max_message - 1)
        self.address = address
        self.max_message = max_message
        self._smbus2 = _smbus2()
        self._owned = isinstance(bus, (int, str, os.PathLike)) and not isinstance(bus, bool)
        if not self._owned and not callable(getattr(bus, "i2c_rdwr", None)):
            raise TypeError(f"bus must be a number, a path or an object with smbus2's interface, not {bus!r}")
        if isinstance(bus, int) and bus < 0:
            raise ValueError(f"bus must be 0 or more, not {bus}")
        self.name = _path(bus) if self._owned else type(bus).__name__
        self.bus = self._open(self.name) if self._owned else bus
        try:
            self._lines = PanelLines(None, reset, pins, gpiochip)
        except BaseException:
            self._close_bus()
            raise
        self._answered = False
        self._messages = _Messages(self._smbus2.i2c_msg, address)

    def command(self, payload: bytes) -> int:
        """Send one command message; return the bytes on the wire."""
        return self._write(COMMAND, payload)

    def data(self, payload: bytes) -> int:
        """Send one data message, in pieces where it is too long for one; return the bytes on the wire."""
        return self._write(DATA, payload)

    def batch(self, plan: Plan) -> int:
        """Send a plan in as few calls as the limits allow; return the bytes on the wire."""
        if plan.buffer.size > self.max_message and plan.longest > self.max_message:
            return sum(self._write(kind, payload) for kind, payload in plan)
        messages = self._messages.of(plan)
        # An adapter that takes short messages only takes few of them a call, and nobody says how few.
        number = MESSAGES_A_CALL if self.max_message == BYTES_A_MESSAGE else 1
        for first in range(0, plan.count, number):
            self._send(messages[first : first + number])
        return plan.cost

    def reset(self) -> bool:
        """Pulse the reset line unless nothing was sent since the last time; return whether there is one."""
        return self._lines.reset()

    def close(self) -> None:
        """Close the bus and the line if they were opened here. Closing twice does nothing."""
        self._lines.close()
        self._close_bus()

    def _close_bus(self) -> None:
        if self._owned and self.bus is not None:
            self.bus.close()
            self.bus = None

    def _write(self, kind: int, payload: bytes | memoryview) -> int:
        room = self.max_message - 1
        if len(payload) > room and kind == CHAINED:
            raise ValueError(f"a chained message of {len(payload)} bytes cannot be split to {room}")
        wire = 0
        for start in range(0, len(payload), room):
            piece = bytes((kind,)) + payload[start : start + room]
            self._send([self._smbus2.i2c_msg.write(self.address, piece)])
            wire += len(piece) + 1
        return wire

    def _send(self, messages: list[Any]) -> None:
        if self.bus is None:
            raise TransportError(errno.EBADF, f"the transport to {self.name} is closed")
        self._lines.fresh = False
        try:
            done = self._rdwr(*messages)
        except OSError as error:
            raise self._translated(error) from error
        if done is not None and done < len(messages):
            raise TransportError(errno.EIO, f"only {done} of {len(messages)} messages reached {self._where()}")
        self._answered = True

    def _rdwr(self, *messages: Any) -> int | None:
        """Transfer messages; return how many went through, if that is known."""
        library = self._smbus2.smbus2
        if type(self.bus) is not library.SMBus:
            return self.bus.i2c_rdwr(*messages)  # type: ignore[no-any-return]
        # What SMBus.i2c_rdwr does, which forgets the number that the kernel returns.
        call = library.i2c_rdwr_ioctl_data.create(*messages)
        return library.ioctl(self.bus.fd, library.I2C_RDWR, call)  # type: ignore[no-any-return]

    def _where(self) -> str:
        return f"0x{self.address:02X} on {self.name}"

    def _open(self, path: str) -> Any:
        try:
            return self._smbus2.SMBus(path)
        except OSError as error:
            raise _not_opened(error, path) from error

    def _translated(self, error: OSError) -> TransportError:
        where = self._where()
        code = error.errno
        if code in _NO_ACKNOWLEDGE:
            kind = PanelDisconnectedError if self._answered else PanelNotFoundError
            return kind(code, f"nobody answers at {where}: {self._advice()}")
        if code in _BUSY:
            return transient(PanelBusyError(code, f"{self.name} is busy: is another master or program using it?"))
        if code == errno.ETIMEDOUT:
            advice = "check SDA, SCL and the pull-up resistors, or try a slower clock"
            return transient(PanelTimeoutError(code, f"no end of a transfer to {where}: {advice}"))
        if code == errno.EOPNOTSUPP:
            advice = f"give I2CTransport a max_message below {self.max_message}"
            return TransportError(code, f"cannot write to {where}: the adapter takes no messages this long: {advice}")
        if code == errno.ENODEV:
            return PanelDisconnectedError(code, f"{self.name} is gone: plug the adapter in and open a new transport")
        reason = error.strerror or error
        return TransportError(code, f"cannot write to {where}: {reason}; check the panel's wiring and power")

    def _advice(self) -> str:
        others = [other for other in PANEL_ADDRESSES if other != self.address and self._answers(other)]
        if others:
            return f"found 0x{others[0]:02X} instead"
        return "check the panel's wiring and power, and its address with `paneldraw detect`"

    def _answers(self, address: int) -> bool:
        try:
            self._rdwr(self._smbus2.i2c_msg.read(address, 1))
        except Exception:  # a probe for an error message must not replace the error
            return False
        return True


class _Messages:
    """smbus2 messages made once; their length and address are written into their memory for each plan."""

    def __init__(self, message: Any, address: int) -> None:
        self._message = message
        self._address = address
        self._keep: npt.NDArray[Any] = np.empty(0)
        self._pool: list[Any] = []
        self._grow(MESSAGES_A_CALL)

    def _grow(self, count: int) -> None:
        message = self._message
        pointer = np.dtype(f"u{ctypes.sizeof(ctypes.c_void_p)}")
        layout = {
            "names": ["addr", "flags", "len", "buf"],
            "formats": ["u2", "u2", "u2", pointer],
            "offsets": [message.addr.offset, message.flags.offset, message.len.offset, message.buf.offset],
            "itemsize": ctypes.sizeof(message),
        }
        fields: npt.NDArray[Any] = np.zeros(count, np.dtype(layout))  # type: ignore[call-overload]
        fields["addr"] = self._address
        self._keep = fields
        self._lengths, self._addresses = fields["len"].data, fields["buf"].data
        self._pool = [message.from_buffer(fields, index * fields.itemsize) for index in range(count)]

    def of(self, plan: Plan) -> list[Any]:
        """Messages over the plan's own buffer: valid until the next call."""
        count = plan.count
        if count > len(self._pool):
            self._grow(count)
        buffer, starts, stops = plan.address, plan.starts, plan.stops
        lengths, addresses = self._lengths, self._addresses
        for index in range(count):
            start = starts[index]
            lengths[index] = stops[index] - start
            addresses[index] = buffer + start
        return self._pool[:count]


def _smbus2() -> ModuleType:
    import smbus2  # Linux only, and not needed by a script that never opens a bus

    return smbus2


def _path(bus: Any) -> str:
    return f"/dev/i2c-{bus}" if isinstance(bus, int) else os.fspath(bus)


def _not_opened(error: OSError, path: str) -> TransportError:
    if error.errno == errno.EACCES or error.errno == errno.EPERM:
        return PanelPermissionError(error.errno, f"no permission to open {path}: {join_group('i2c')}")
    if error.errno in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
        there = ", ".join(sorted(glob.glob("/dev/i2c-*")))
        advice = "enable I2C (on a Raspberry Pi: `sudo raspi-config nonint do_i2c 0`, then reboot)"
        others = f"; there is {there}" if there else ""
        return PanelNotFoundError(error.errno, f"there is no bus {path}: {advice}{others}")
    return TransportError(error.errno, f"cannot open {path}: {error.strerror or error}")
