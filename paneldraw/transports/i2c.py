"""Panels on an I2C bus, through smbus2."""

from __future__ import annotations

import ctypes
import errno
import functools
import glob
import importlib
import os
import sys
import threading
import weakref
from collections.abc import Callable
from types import ModuleType
from typing import Any, ClassVar, Final

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
_PASSING = (errno.EREMOTEIO, errno.ENXIO, errno.EIO, errno.ETIME)
"""What a panel that answered before may well get over."""
_FRAMING = 2  # address byte and control byte
_LENGTHS: Final = (4096, 2048, 1024, 512, 256, 255, 128, 64, 63, 32, 31, 16, 8, 2)
"""Longest messages, one of which an adapter takes that does not take any."""
_BLOCK: Final = 33
"""The same by SMBus alone."""
_I2C, _MANGLING = 0x1, 0x4  # bits of I2C_FUNCS
_STOP: Final = 0x8000
"""Flag of a message that ends with a STOP."""


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
    mux : (int, int), optional
        Address and channel of a multiplexer, such as a TCA9548A, behind which the panel is. Default: none.
    data_address : int, optional
        Where data goes to chips that have two addresses and no control bytes: the UC1609's is the one after `address`.
        Default: none, data goes to `address`.
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

    verbatim = True

    def __init__(
        self,
        bus: Any = 1,
        address: int = 0x3C,
        *,
        max_message: int = BYTES_A_MESSAGE,
        mux: tuple[int, int] | None = None,
        data_address: int | None = None,
        reset: Line | None = None,
        pins: Pins | None = None,
        gpiochip: int | str | None = None,
    ) -> None:
        _check_address("address", address)
        if data_address is not None:
            _check_address("data_address", data_address)
        if not 2 <= max_message <= BYTES_A_MESSAGE:
            raise ValueError(f"max_message must be 2 to {BYTES_A_MESSAGE}, not {max_message}")
        self.address, self.data_address = address, data_address
        self.wire = "i2c" if data_address is None else "i2c-pair"
        self._framing = _FRAMING if data_address is None else 1
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
        self._mux = None if mux is None else _Mux(*mux, self.bus, self._smbus2.i2c_msg)
        functions = int(getattr(self.bus, "funcs", 0))
        self._blocks = functions != 0 and not functions & _I2C
        self._limit(min(max_message, _BLOCK) if self._blocks else max_message)
        self._messages = _Messages(self._smbus2.i2c_msg, address, data_address)

    def command(self, payload: bytes) -> int:
        """Send one command message; return the bytes on the wire."""
        return self._write(COMMAND, payload)

    def data(self, payload: bytes) -> int:
        """Send one data message, in pieces where it is too long for one; return the bytes on the wire."""
        return self._write(DATA, payload)

    def batch(self, plan: Plan) -> int:
        """Send a plan in as few calls as the limits allow; return the bytes on the wire."""
        short = self.max_message < BYTES_A_MESSAGE
        if short or (plan.buffer.size > BYTES_A_MESSAGE and plan.longest > BYTES_A_MESSAGE):
            return sum(self._write(kind, payload) for kind, payload in plan)
        messages = self._messages.of(plan)
        wire = plan.cost
        try:
            if plan.count <= MESSAGES_A_CALL:
                return wire + self._send(messages)
            for first in range(0, plan.count, MESSAGES_A_CALL):
                wire += self._send(messages[first : first + MESSAGES_A_CALL])
        except _TooMuchError:
            if plan.count == 1:
                self._shorten(plan.longest)
            return sum(self._write(kind, payload) for kind, payload in plan)
        return wire

    def read_status(self) -> tuple[int, int]:
        """Read the panel's status byte; return it, and the bytes on the wire."""
        if self._blocks:
            return int(self._block(self.bus.read_byte, self.address)), _FRAMING
        message = self._smbus2.i2c_msg.read(self.address, 1)
        extra = self._send([message])
        return int(bytes(message)[0]), _FRAMING + extra

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

    def _limit(self, max_message: int) -> None:
        """Take messages of so many bytes for the longest."""
        self.max_message = max_message
        whole = max_message == BYTES_A_MESSAGE and self.data_address is None  # a chained message cannot be split
        self.cost = Cost(self._framing, self._framing, _FRAMING if whole else None, max_message - 1)

    def _shorten(self, length: int) -> None:
        """Know that a message of so many bytes is more than the adapter takes."""
        shorter = [each for each in _LENGTHS if each < min(length, self.max_message)]
        if shorter:
            self._limit(shorter[0])
        elif not self._blocks and callable(getattr(self.bus, "write_i2c_block_data", None)):
            self._blocks = True
            self._limit(_BLOCK)
        else:
            neither = f"the adapter of {self.name} takes neither I2C messages nor SMBus blocks"
            raise TransportError(errno.EOPNOTSUPP, neither)

    def _write(self, kind: int, payload: bytes | memoryview) -> int:
        """Send a message, in pieces where it is longer than the adapter takes; return the bytes on the wire."""
        if len(payload) < self.max_message:
            try:
                return self._piece(kind, payload)
            except _TooMuchError:
                self._shorten(len(payload) + 1)
                return self._write(kind, payload)
        if kind == CHAINED:
            return self._unchained(payload)
        if kind not in (COMMAND, DATA):
            limit = f"{self.name} takes messages of {self.max_message} bytes at most"
            raise transient(TransportError(errno.EOPNOTSUPP, limit))  # next time the planner knows
        done = self.max_message - 1
        return self._write(kind, payload[:done]) + self._write(kind, payload[done:])

    def _unchained(self, payload: bytes | memoryview) -> int:
        """Send a chained message as one of commands and one of data."""
        end = next(at for at in range(1, len(payload), 2) if payload[at] == DATA)
        return self._write(COMMAND, bytes(payload[:end:2])) + self._write(DATA, payload[end + 1 :])

    def _piece(self, kind: int, payload: bytes | memoryview) -> int:
        """Send one message; return the bytes on the wire."""
        address, control = self.address, bytes((kind,))
        if self.data_address is not None:
            address, control = self.data_address if kind == DATA else address, b""
        message = control + payload
        if self._blocks:
            self._block(self.bus.write_i2c_block_data, address, message[0], list(message[1:]))
            return self._framing + len(payload)
        return self._send([self._smbus2.i2c_msg.write(address, message)]) + self._framing + len(payload)

    def _send(self, messages: list[Any]) -> int:
        """Send messages in one call; return the bytes that this cost beside them."""
        self._lines.fresh = False
        try:
            if self._mux is None:
                extra, done = 0, self._rdwr(*messages)
            else:
                extra, done = self._mux.through(self._rdwr, messages)
        except (OSError, TypeError, AttributeError) as error:
            raise self._failure(error) from error
        if done is not None and done < len(messages):
            reached = f"only {done} of {len(messages)} messages reached {self._where()}"
            short = TransportError(errno.EIO, f"{reached}: check the panel's wiring and power")
            raise transient(short) if self._answered else short
        self._answered = True
        return extra

    def _block(self, transfer: Callable[..., Any], *arguments: Any) -> Any:
        """Do a transfer of SMBus."""
        try:
            answer = transfer(*arguments)
        except (OSError, TypeError) as error:
            raise self._failure(error) from error
        self._answered = True
        return answer

    def _failure(self, error: Exception) -> Exception:
        """What to raise for what a bus raised."""
        if self.bus is None:
            return TransportError(errno.EBADF, f"the transport to {self.name} is closed")
        if isinstance(error, OSError):
            too_much = error.errno == errno.EOPNOTSUPP and not self._blocks
            return _TooMuchError() if too_much else self._translated(error)
        if getattr(self.bus, "fd", -1) is None:
            return TransportError(errno.EBADF, f"bus {self.name} is closed: open it, or give its number")
        return error

    def _rdwr(self, *messages: Any) -> int | None:
        """Transfer messages; return how many went through, if that is known."""
        library = self._smbus2.smbus2
        if getattr(type(self.bus), "i2c_rdwr", None) is not library.SMBus.i2c_rdwr:
            return self.bus.i2c_rdwr(*messages)  # type: ignore[no-any-return]
        # What SMBus.i2c_rdwr does, which forgets the number that the kernel returns.
        call = library.i2c_rdwr_ioctl_data.create(*messages)
        return library.ioctl(self.bus.fd, library.I2C_RDWR, call)  # type: ignore[no-any-return]

    def _where(self) -> str:
        return f"0x{self.address:02X} on {self.name}"

    def _open(self, path: str) -> Any:
        bus = self._smbus2.SMBus() if isinstance(self._smbus2.SMBus, type) else None
        try:
            if bus is None:  # a function that somebody put there
                return self._smbus2.SMBus(path)
            bus.open(path)
        except OSError as error:
            if bus is not None:
                bus.close()  # a file that is no bus was opened all the same
            raise _not_opened(error, path) from error
        return bus

    def _translated(self, error: OSError) -> TransportError:
        where = self._where()
        code = error.errno
        if code in _NO_ACKNOWLEDGE:
            if not self._answered:
                return PanelNotFoundError(code, f"nobody answers at {where}: {self._advice()}")
            gone = PanelDisconnectedError(code, f"nobody answers at {where}")
            gone.more = self._advice  # asks another address, which may be another's device: not at every glitch
            return transient(gone)
        if code in _BUSY:
            return transient(PanelBusyError(code, f"{self.name} is busy: is another master or program using it?"))
        if code == errno.ETIMEDOUT or code == errno.ETIME:
            advice = "check SDA, SCL and the pull-up resistors, or try a slower clock"
            late = PanelTimeoutError(code, f"no end of a transfer to {where}: {advice}")
            return late if code == errno.ETIME and not self._answered else transient(late)
        if code == errno.EOPNOTSUPP:
            return TransportError(code, f"cannot write to {where}: the adapter does not take such messages")
        if code == errno.ENODEV:
            return PanelDisconnectedError(code, f"{self.name} is gone: plug the adapter in and open a new transport")
        reason = error.strerror or error
        failed = TransportError(code, f"cannot write to {where}: {reason}; check the panel's wiring and power")
        return transient(failed) if code in _PASSING and self._answered else failed

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


def probe(bus: Any, address: int) -> None:
    """Ask in the way that is least likely to change anything: these ranges hold memories that a write would upset."""
    if 0x30 <= address <= 0x37 or 0x50 <= address <= 0x5F:
        bus.read_byte(address)
        return
    try:
        bus.write_quick(address)
    except OSError as error:
        if error.errno != errno.EOPNOTSUPP:
            raise
        bus.read_byte(address)


class _TooMuchError(Exception):
    """The adapter does not take such messages, so many, or so long."""


class _Mux:
    """One channel of a multiplexer, which connects it with the STOP behind the message that selects it.

    Where the adapter can put a STOP into a call, that message goes out in the call of the panel's messages; elsewhere
    in a call before, and no other panel of this process comes in between.
    """

    _locks: ClassVar[weakref.WeakValueDictionary[str, _Lock]] = weakref.WeakValueDictionary()

    def __init__(self, address: int, channel: int, bus: Any, message: Any) -> None:
        _check_address("mux", address)
        if not 0 <= channel <= 7:
            raise ValueError(f"mux must be an address and a channel of 0 to 7, not {channel!r}")
        self._select = message.write(address, (1 << channel,))
        self._together = bool(getattr(bus, "funcs", 0) & _MANGLING)
        if self._together:
            self._select.flags |= _STOP
        self._lock = self._locks.setdefault(str(getattr(bus, "name", "") or id(bus)), _Lock())

    def through(self, rdwr: Callable[..., int | None], messages: list[Any]) -> tuple[int, int | None]:
        """Send messages through the channel; return the bytes of its selection, and how many messages went through."""
        if self._together and len(messages) < MESSAGES_A_CALL:
            done = rdwr(self._select, *messages)
            return _FRAMING, None if done is None else max(done, 1) - 1
        with self._lock.held:
            return _FRAMING, 0 if rdwr(self._select) == 0 else rdwr(*messages)


class _Lock:
    """A lock that can be kept in a dictionary as long as somebody needs it."""

    def __init__(self) -> None:
        self.held = threading.Lock()


class _Messages:
    """smbus2 messages made once; their length and address are written into their memory for each plan."""

    def __init__(self, message: Any, address: int, data_address: int | None) -> None:
        self._message = message
        self._address, self._data_address = address, data_address
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
        self._lengths, self._addresses, self._chips = fields["len"].data, fields["buf"].data, fields["addr"].data
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
        if self._data_address is not None:
            self._address_apart(plan, self._data_address)
        return self._pool[:count]

    def _address_apart(self, plan: Plan, data_address: int) -> None:
        """Leave the control byte out of each message, and let the address say what it is."""
        kinds = plan.buffer.data
        for index in range(plan.count):
            self._chips[index] = data_address if kinds[plan.starts[index]] == DATA else self._address
            self._lengths[index] -= 1
            self._addresses[index] += 1


def _smbus2() -> ModuleType:
    try:
        import smbus2  # not needed by a script that never opens a bus
    except ModuleNotFoundError as error:
        if error.name != "fcntl":
            raise
        return _smbus2_without_fcntl()
    return smbus2


@functools.cache
def _smbus2_without_fcntl() -> ModuleType:
    """Import smbus2 where there is no bus to open, for its messages to simulated ones."""
    lent = ModuleType("fcntl")
    lent.ioctl = None  # type: ignore[attr-defined]
    sys.modules["fcntl"] = lent
    try:
        return importlib.import_module("smbus2")
    finally:
        for name in ("fcntl", "smbus2", "smbus2.smbus2"):  # nobody else shall believe that they work here
            sys.modules.pop(name, None)


def _path(bus: Any) -> str:
    return f"/dev/i2c-{bus}" if isinstance(bus, int) or str(bus).isdecimal() else os.fspath(bus)


def _check_address(name: str, address: int) -> None:
    if isinstance(address, bool) or not isinstance(address, int):
        raise TypeError(f"{name} must be an int, not {address!r}")
    if 0x08 <= address <= 0x77:
        return
    advice = ""
    if address in [2 * each for each in PANEL_ADDRESSES]:
        advice = f", which is 0x{address // 2:02X} with the bit for writing: write 0x{address // 2:02X}"
    elif 0x77 < address <= 0x3FF:
        advice = ": panels have addresses of 7 bits, not of 10"
    raise ValueError(f"{name} must be 0x08 to 0x77, of a panel usually 0x3C or 0x3D, not {address:#x}{advice}")


def _not_opened(error: OSError, path: str) -> TransportError:
    if error.errno == errno.EPERM:
        advice = f"in a container, start it with --device {path}"
        return PanelPermissionError(error.errno, f"no permission to open {path}: {advice}, else {join_group('i2c')}")
    if error.errno in (errno.ENOTTY, errno.EINVAL, errno.EISDIR):
        return PanelNotFoundError(error.errno, f"{path} is no I2C bus: give its number, such as 1, or its /dev/i2c-N")
    if error.errno == errno.EACCES:
        return PanelPermissionError(error.errno, f"no permission to open {path}: {join_group('i2c')}")
    if error.errno in (errno.ENOENT, errno.ENODEV, errno.ENXIO):
        there = ", ".join(sorted(glob.glob("/dev/i2c-*")))
        advice = "enable I2C (on a Raspberry Pi: `sudo raspi-config nonint do_i2c 0`, then reboot)"
        others = f"; there is {there}" if there else ""
        return PanelNotFoundError(error.errno, f"there is no bus {path}: {advice}{others}")
    return TransportError(error.errno, f"cannot open {path}: {error.strerror or error}")
