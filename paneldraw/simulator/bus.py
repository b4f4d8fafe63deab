"""A simulated I2C bus with the interface of ``smbus2.SMBus``, the kernel's limits, and faults on demand."""

from __future__ import annotations

import ctypes
import errno as codes
import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

from . import log
from .wire import EREMOTEIO, Fault, Wire, check_bus, os_error

_MAX_MESSAGES = 42
_MAX_MESSAGE_BYTES = 8192
_MAX_BLOCK = 32
_READ, _STOP = 0x0001, 0x8000
_MANGLING = 0x4  # I2C_FUNC_PROTOCOL_MANGLING: a message may end with a STOP
# I2C_FUNC_I2C and what Linux emulates of SMBus on plain I2C adapters, less packet error checking.
_FUNCS = 0x0EFF0001


class Device(Protocol):
    """What the bus asks of a chip at an address."""

    def write(self, payload: bytes) -> None:
        """Take the bytes of one write message, without the address byte."""

    def read(self, length: int) -> bytes:
        """Answer a read message with `length` bytes."""

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Note that a bus call is over; it put `wire_bytes` bytes on the wire for this chip and ended at `seconds`."""


@dataclass(slots=True)
class _Message:
    """One START-to-START piece of a transfer: bytes to write, or a number of bytes to read."""

    address: int
    payload: bytes = b""
    length: int | None = None
    answer: bytes = b""
    stop: bool = False


class _ShortTransferError(Exception):
    """The adapter stopped early and reports no error."""

    count = 0


class Multiplexer:
    """A multiplexer of the TCA9548A's kind: an address of its own, and eight channels with devices behind them.

    A write selects channels by the bits of its last byte; they are connected from the STOP on that follows.

    Parameters
    ----------
    channels : mapping of int to mapping
        Devices by their addresses, by the number of the channel, 0 to 7, that they are behind.

    Attributes
    ----------
    channels : dict
    selected : int
        The connected channels, a bit each. Reset leaves none.

    Examples
    --------
    >>> from paneldraw import Panel, simulator
    >>> from paneldraw.controllers import SSD1306
    >>> from paneldraw.transports import I2CTransport
    >>> chips = [simulator.SSD1306(), simulator.SSD1306()]
    >>> bus = simulator.I2CBus({0x70: simulator.Multiplexer({n: {0x3C: chip} for n, chip in enumerate(chips)})})
    >>> panels = [Panel(SSD1306(), I2CTransport(bus, mux=(0x70, n))) for n in range(2)]
    >>> report = panels[1].clear()
    >>> [len(chip.frames) for chip in chips], chips[1].registers.on
    ([0, 0], True)
    """

    def __init__(self, channels: Mapping[int, Mapping[int, Device]]) -> None:
        for number, devices in channels.items():
            if number not in range(8):
                raise ValueError(f"channels: {number!r} is not a channel of 0 to 7")
            for device in devices.values():
                check_bus(device, "i2c")
        self.channels = {number: dict(devices) for number, devices in channels.items()}
        self.reset()

    def reset(self) -> None:
        """Pull the reset pin: no channel is connected."""
        self.selected = self._next = 0

    def write(self, payload: bytes) -> None:
        """Take a write: the channels to connect."""
        if payload:
            self._next = payload[-1]

    def read(self, length: int) -> bytes:
        """Answer with the connected channels."""
        return bytes((self.selected,)) * length

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Nothing is seen here."""

    def stop(self) -> None:
        """Connect what was selected before a STOP."""
        self.selected = self._next

    def find(self, address: int) -> Device | None:
        """Return the device at an address behind the connected channels."""
        for number, devices in self.channels.items():
            if self.selected >> number & 1 and address in devices:
                return devices[address]
        return None


class I2CBus(Wire):
    """A simulated I2C bus. Drivers take it where they take an open ``smbus2.SMBus``.

    Parameters
    ----------
    devices : mapping of int to device
        Which chip answers at which 7-bit address. `devices` may be changed while the bus is in use: taking a chip out
        unplugs it.
    clock : float
        Clock rate in Hz. Default: 400 000.
    timer : callable or None
        Gives the host's time in seconds; default: ``time.monotonic``. Frames are stamped with whichever is later, the
        host's time since the bus was made or the time by which the wire can have carried the bytes: a script that
        pauses leaves pauses between its frames, and one that does not is slowed to what the wire carries. None leaves
        the host out: frames carry `seconds`, the same in every run.

    Attributes
    ----------
    devices : dict
        The chips by address.
    bytes : int
        Bytes on the wire since the bus was made: the address byte of every message, and its payload as far as it got.
    messages, transactions : int
        Messages (START or repeated START to the next), and calls (START to STOP), failed ones included.
    seconds : float
        Time that the wire was busy at `clock`: 9 bit times a byte, 1 for every START, 1 for every STOP.

    Notes
    -----
    Limits and errors are Linux's: nobody at an address is ``OSError`` 121 (Remote I/O error); more than 42 messages in
    a call, none, or more than 8192 bytes in a message are 22 (Invalid argument); after `close` every call is the
    ``TypeError`` that smbus2 gives. SMBus block reads and packet error checking are not offered, as on most adapters.
    Calls from several threads follow one another whole.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> chip = simulator.SSD1306(128, 64)
    >>> with simulator.I2CBus({0x3C: chip}) as bus:
    ...     bus.write_i2c_block_data(0x3C, 0x00, [0x8D, 0x14, 0xA5, 0xAF])
    >>> bus.bytes, bus.messages, int(chip.pixels.sum())
    (6, 1, 8192)
    """

    log_form = "seconds address w/r ack/nak payload"

    def __init__(
        self,
        devices: Mapping[int, Device] | None = None,
        clock: float = 400_000,
        *,
        timer: Callable[[], float] | None = time.monotonic,
    ) -> None:
        if not clock > 0:
            raise ValueError(f"clock: {clock!r} is not a rate in Hz above 0")
        self.devices: dict[int, Device] = dict(devices or {})
        for address, device in self.devices.items():
            check_bus(device, "i2c")
            if not 0 <= address <= 0x7F:
                raise ValueError(f"devices: {address:#x} is not a 7-bit address (0x00 to 0x7F)")
        super().__init__(timer)
        self.clock = clock
        self.transactions = 0
        self._heard: list[log.Message] = []
        self.fd: int | None = None
        self.funcs = 0
        self.address: int | None = None
        self.force = False
        self.open(0)

    # as smbus2 has it

    def open(self, bus: int | str) -> None:
        """Open the bus again after `close`; any number or path will do."""
        if not isinstance(bus, (int, str)):
            raise TypeError(f"Unexpected type(bus)={type(bus)}")
        self.fd, self.funcs = -1, _FUNCS

    def close(self) -> None:
        """Close the bus. The chips keep their state."""
        self.fd = self.address = None

    def __enter__(self) -> I2CBus:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    @property
    def pec(self) -> int:
        """Packet error checking: always 0; setting it is refused as smbus2 refuses it on adapters without."""
        return 0

    @pec.setter
    def pec(self, enable: bool) -> None:
        self.enable_pec(enable)

    def enable_pec(self, enable: bool = True) -> None:
        """Refuse packet error checking, which this adapter does not offer."""
        raise OSError("SMBUS_PEC is not a feature")

    def i2c_rdwr(self, *i2c_msgs: Any) -> int:
        """Carry ``smbus2.i2c_msg`` messages, joined by repeated STARTs; read messages are filled in.

        Returns
        -------
        int
            How many messages went through, which the kernel tells and smbus2 forgets.

        Raises
        ------
        OSError
            121 where nobody answers, 22 past the kernel's limits, or the errno of a fault asked for with `fail`.
        """
        for message in i2c_msgs:
            if not (hasattr(message, "addr") and hasattr(message, "buf")):
                raise TypeError(f"expected i2c_msg instance, got {type(message).__name__}")
        self._check_open()
        if not 1 <= len(i2c_msgs) <= _MAX_MESSAGES or any(m.len > _MAX_MESSAGE_BYTES for m in i2c_msgs):
            raise os_error(codes.EINVAL)
        parts = [
            _Message(
                m.addr,
                b"" if m.flags & _READ else m.buf[: m.len],
                m.len if m.flags & _READ else None,
                stop=bool(m.flags & _STOP and self.funcs & _MANGLING),
            )
            for m in i2c_msgs
        ]
        try:
            self._transfer(parts)
        except _ShortTransferError as short:
            return short.count
        finally:
            for message, part in zip(i2c_msgs, parts, strict=True):
                if part.answer:
                    ctypes.memmove(message.buf, part.answer, len(part.answer))
        return len(parts)

    def write_quick(self, i2c_addr: int, force: bool | None = None) -> None:
        """Send the address alone: does anybody answer?"""
        self._smbus(i2c_addr, b"")

    def write_byte(self, i2c_addr: int, value: int, force: bool | None = None) -> None:
        """Send one byte."""
        self._smbus(i2c_addr, _bytes([value]))

    def write_byte_data(self, i2c_addr: int, register: int, value: int, force: bool | None = None) -> None:
        """Send a register number and a byte."""
        self._smbus(i2c_addr, _bytes([register, value]))

    def write_word_data(self, i2c_addr: int, register: int, value: int, force: bool | None = None) -> None:
        """Send a register number and two bytes, the low one first."""
        self._smbus(i2c_addr, _bytes([register, value, value >> 8]))

    def write_block_data(self, i2c_addr: int, register: int, data: Iterable[int], force: bool | None = None) -> None:
        """Send a register number, a count and up to 32 bytes."""
        block = _block(data)
        self._smbus(i2c_addr, _bytes([register, len(block)]) + block)

    def write_i2c_block_data(
        self, i2c_addr: int, register: int, data: Iterable[int], force: bool | None = None
    ) -> None:
        """Send a register number and up to 32 bytes; as in smbus2, values above 255 lose their upper bits."""
        self._smbus(i2c_addr, _bytes([register]) + _block(data))

    def read_byte(self, i2c_addr: int, force: bool | None = None) -> int:
        """Read one byte."""
        return self._smbus(i2c_addr, None, 1)[0]

    def read_byte_data(self, i2c_addr: int, register: int, force: bool | None = None) -> int:
        """Send a register number, then read one byte."""
        return self._smbus(i2c_addr, _bytes([register]), 1)[0]

    def read_word_data(self, i2c_addr: int, register: int, force: bool | None = None) -> int:
        """Send a register number, then read two bytes, the low one first."""
        return int.from_bytes(self._smbus(i2c_addr, _bytes([register]), 2), "little")

    def process_call(self, i2c_addr: int, register: int, value: int, force: bool | None = None) -> int:
        """Send a register number and two bytes, then read two bytes."""
        return int.from_bytes(self._smbus(i2c_addr, _bytes([register, value, value >> 8]), 2), "little")

    def read_i2c_block_data(self, i2c_addr: int, register: int, length: int, force: bool | None = None) -> list[int]:
        """Send a register number, then read up to 32 bytes."""
        if length > _MAX_BLOCK:
            raise ValueError(f"Desired block length over {_MAX_BLOCK} bytes")
        return list(self._smbus(i2c_addr, _bytes([register]), length))

    def read_block_data(self, i2c_addr: int, register: int, force: bool | None = None) -> list[int]:
        """Refuse an SMBus block read with errno 95, as adapters do that are not SMBus hosts."""
        self._check_open()
        raise os_error(codes.EOPNOTSUPP)

    def block_process_call(
        self, i2c_addr: int, register: int, data: Iterable[int], force: bool | None = None
    ) -> list[int]:
        """Refuse an SMBus block process call with errno 95, as adapters do that are not SMBus hosts."""
        _block(data)
        return self.read_block_data(i2c_addr, register)

    # faults

    def fail(
        self,
        errno: int = EREMOTEIO,
        *,
        after: int = 0,
        at_byte: int | None = None,
        times: int | None = 1,
        address: int | None = None,
        then: Callable[[], object] | None = None,
    ) -> Fault:
        """Make a coming message fail.

        Parameters
        ----------
        errno : int
            What the call raises: 121 (default) or 6 for a missing acknowledge, ``ETIMEDOUT``, ``EAGAIN``, ``EBUSY``,
            any other; 0 drops the rest of the call without an error, as adapters do that transfer less than asked.
        after : int
            How many messages pass first. Default: 0, the next message fails.
        at_byte : int or None
            How many payload bytes the chip receives before the fault; from the payload's length on, it receives all
            and the call fails all the same. Default: None, not even the address is acknowledged.
        times : int or None
            How many messages in a row fail; None is for ever. Default: 1.
        address : int or None
            Count and fail only messages to this address. Default: None, all.
        then : callable or None
            Called at the moment of the fault, with the chip having received what it did: ``chip.power_cycle``, say.

        Returns
        -------
        Fault
            The fault, waiting; `clear_faults` takes all away.

        Examples
        --------
        >>> from paneldraw import simulator
        >>> chip = simulator.SSD1306()
        >>> bus = simulator.I2CBus({0x3C: chip})
        >>> fault = bus.fail(at_byte=2)
        >>> bus.write_i2c_block_data(0x3C, 0x00, [0x81, 0x20])
        Traceback (most recent call last):
        OSError: [Errno 121] Remote I/O error
        >>> bus.write_byte_data(0x3C, 0x00, 0x40)
        >>> chip.contrast
        64
        """
        return self._await(Fault(errno, after, at_byte, times, then, address))

    # inside

    def _check_open(self) -> None:
        if self.fd is None:
            raise TypeError("argument must be an int, or have a fileno() method.")

    def _smbus(self, address: int, payload: bytes | None, length: int | None = None) -> bytes:
        self._check_open()
        if not 0 <= address <= 0x7F:
            raise os_error(codes.EINVAL)
        self.address = address
        parts = [] if payload is None else [_Message(address, payload)]
        if length is not None:
            parts.append(_Message(address, length=length))
        try:
            self._transfer(parts)
        except _ShortTransferError:
            raise os_error(codes.EIO) from None
        return parts[-1].answer

    def _transfer(self, parts: list[_Message]) -> None:
        with self._lock:
            self._pass_time()
            self.transactions += 1
            bytes_before, started, stops = self.bytes, 0, 1
            touched: dict[int, tuple[Device, int]] = {}
            try:
                for part in parts:
                    started += 1
                    before = self.bytes
                    device = self._at(part.address)
                    try:
                        self._carry(part, device)
                    finally:
                        if device is not None:
                            chip = getattr(device, "chip", device)  # of two addresses, perhaps
                            wire_bytes = touched.get(id(chip), (chip, 0))[1] + self.bytes - before
                            touched[id(chip)] = chip, wire_bytes
                    if part.stop:
                        stops += 1
                        self._stop()
            except _ShortTransferError as short:
                short.count = started - 1
                raise
            finally:
                self._stop()
                now = self._elapse((9 * (self.bytes - bytes_before) + started + stops) / self.clock)
                for device, wire_bytes in touched.values():
                    device.settle(now, wire_bytes)
                if self._heard and self.log:
                    self.log.write(log.Call(now, tuple(self._heard)))
                self._heard.clear()

    def _chips(self) -> Iterable[object]:
        for device in self.devices.values():
            yield device
            if isinstance(device, Multiplexer):
                for behind in device.channels.values():
                    yield from behind.values()

    def _at(self, address: int) -> Device | None:
        """Who answers at an address, behind multiplexers too."""
        direct = self.devices.get(address)
        if direct is not None:
            return direct
        behind = (device.find(address) for device in self.devices.values() if isinstance(device, Multiplexer))
        return next((device for device in behind if device is not None), None)

    def _stop(self) -> None:
        for device in self.devices.values():
            if isinstance(device, Multiplexer):
                device.stop()

    def _carry(self, part: _Message, device: Device | None) -> None:
        """Put one message on the wire, as far as chip and faults let it."""
        self.messages += 1
        self.bytes += 1
        fault = self._due(part.address) if self._faults else None
        if device is None or (fault and fault.at_byte is None):
            self._note(part.address, b"", read=part.length is not None, acknowledged=False)
            self._raise(fault)
            raise os_error(EREMOTEIO)
        size = len(part.payload) if part.length is None else part.length
        got = size if fault is None else fault.reach(size)
        self.bytes += got
        if part.length is None:
            device.write(part.payload[:got])
            self.bytes += got < size
            self._note(part.address, part.payload[:got], read=False, acknowledged=got == size)
        else:
            part.answer = device.read(got)
            self._note(part.address, part.answer, read=True, acknowledged=True)
        if fault is not None:
            self._raise(fault)

    def _note(self, address: int, payload: bytes, *, read: bool, acknowledged: bool) -> None:
        """Keep what a message carried for the log."""
        if self.log:
            self._heard.append(log.Message(address, payload, read, acknowledged))

    def _raise(self, fault: Fault | None) -> None:
        if fault is None:
            return
        if fault.then:
            fault.then()
        raise os_error(fault.errno) if fault.errno else _ShortTransferError


def _bytes(values: Iterable[int]) -> bytes:
    return bytes(value & 0xFF for value in values)


def _block(data: Iterable[int]) -> bytes:
    block = _bytes(data)
    if len(block) > _MAX_BLOCK:
        raise ValueError(f"Data length cannot exceed {_MAX_BLOCK} bytes")
    return block
