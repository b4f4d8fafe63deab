"""A simulated I2C bus with the interface of ``smbus2.SMBus``, the kernel's limits, and faults on demand."""

from __future__ import annotations

import ctypes
import errno as codes
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from . import log
from .chip import Chip
from .wire import EREMOTEIO, Fault, Wire, check_bus, os_error

_MAX_MESSAGES = 42
_MAX_MESSAGE_BYTES = 8192
_MAX_BLOCK = 32
_READ, _TEN, _RECV_LEN, _STOP = 0x0001, 0x0010, 0x0400, 0x8000
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
class Message:
    """One START-to-START piece of a transfer: bytes to write, or a number of bytes to read."""

    address: int
    payload: bytes = b""
    length: int | None = None
    answer: bytes = b""
    flags: int = 0

    @classmethod
    def of(cls, address: int, flags: int, length: int, payload: bytes) -> Message:
        """Make one of what the kernel's ``i2c_msg`` says, and of what its buffer holds."""
        return cls(address, payload, length, flags=flags) if flags & _READ else cls(address, payload, flags=flags)

    @property
    def size(self) -> int:
        """Bytes to write or to read."""
        return len(self.payload) if self.length is None else self.length

    @property
    def counts(self) -> bool:
        """Whether the kernel takes it for an SMBus block read, whose first byte is the count of those that follow."""
        return self.length is not None and self.payload[:1] > b"\0" and self.length >= self.payload[0] + _MAX_BLOCK


def _given(flags: int, length: int) -> int:
    """How many bytes of a message's buffer the kernel looks at."""
    return length if not flags & _READ else min(length, 1) if flags & _RECV_LEN else 0


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
    claimed : set of int
        Addresses that a driver of the kernel's own holds, which ``i2cdetect`` marks UU: SMBus calls and ``I2C_SLAVE``
        are refused with errno 16 (Device or resource busy) unless they are forced; ``i2c_rdwr`` is not.
    timeout : float
        Seconds after which the adapter gives a transfer up whose clock a chip holds. Default: 1, as most adapters have
        it; ``I2C_TIMEOUT`` sets it.
    retries : int
        How often the kernel tries a transfer again that ended in ``EAGAIN``. Default: 0; ``I2C_RETRIES`` sets it.
    bytes : int
        Bytes on the wire since the bus was made: the address byte of every message, and its payload as far as it got.
    messages, transactions : int
        Messages (START or repeated START to the next), and calls (START to STOP), failed ones included.
    seconds : float
        Time that the wire was busy at `clock`: 9 bit times a byte, 1 for every START, 1 for every STOP.
    realtime : bool
        Whether a call lasts until the wire has carried it, by the host's time. Default: False.

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
        self.claimed: set[int] = set()
        self.timeout = 1.0
        self.retries = 0
        for address, device in self.devices.items():
            check_bus(device, "i2c")
            if not 0 <= address <= 0x7F:
                raise ValueError(f"devices: {address:#x} is not a 7-bit address (0x00 to 0x7F)")
        super().__init__(timer)
        self.clock = clock
        self._stuck: tuple[int, int | None] | None = None
        self._held = 0.0
        self._call = 0, 0  # bytes and messages before the present call
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
        if any(m.len > _MAX_MESSAGE_BYTES for m in i2c_msgs):
            raise os_error(codes.EINVAL)
        parts = [Message.of(m.addr, m.flags, m.len, m.buf[: _given(m.flags, m.len)]) for m in i2c_msgs]
        done = self.rdwr(parts)
        for message, part in zip(i2c_msgs, parts, strict=True):
            if part.answer:
                ctypes.memmove(message.buf, part.answer, len(part.answer))
        return done

    def rdwr(self, messages: Sequence[Message]) -> int:
        """Do what the kernel does for ``I2C_RDWR``; return how many messages went through.

        As there, nothing that was read is handed over if the call fails.
        """
        if not 1 <= len(messages) <= _MAX_MESSAGES or any(message.size > _MAX_MESSAGE_BYTES for message in messages):
            raise os_error(codes.EINVAL)
        if any(message.flags & _RECV_LEN and not message.counts for message in messages):
            raise os_error(codes.EINVAL)
        return self.transfer(messages)

    def transfer(self, messages: Sequence[Message]) -> int:
        """Do what an adapter does with messages that the kernel let through; return how many went through."""
        if any(message.flags & _RECV_LEN for message in messages):
            raise os_error(codes.EOPNOTSUPP)
        try:
            self._transfer(messages)
        except _ShortTransferError as short:
            return short.count
        return len(messages)

    def write_quick(self, i2c_addr: int, force: bool | None = None) -> None:
        """Send the address alone: does anybody answer?"""
        self._smbus(i2c_addr, b"", force=force)

    def write_byte(self, i2c_addr: int, value: int, force: bool | None = None) -> None:
        """Send one byte."""
        self._smbus(i2c_addr, _bytes([value]), force=force)

    def write_byte_data(self, i2c_addr: int, register: int, value: int, force: bool | None = None) -> None:
        """Send a register number and a byte."""
        self._smbus(i2c_addr, _bytes([register, value]), force=force)

    def write_word_data(self, i2c_addr: int, register: int, value: int, force: bool | None = None) -> None:
        """Send a register number and two bytes, the low one first."""
        self._smbus(i2c_addr, _bytes([register, value, value >> 8]), force=force)

    def write_block_data(self, i2c_addr: int, register: int, data: Iterable[int], force: bool | None = None) -> None:
        """Send a register number, a count and up to 32 bytes."""
        block = _block(data)
        self._smbus(i2c_addr, _bytes([register, len(block)]) + block, force=force)

    def write_i2c_block_data(
        self, i2c_addr: int, register: int, data: Iterable[int], force: bool | None = None
    ) -> None:
        """Send a register number and up to 32 bytes; as in smbus2, values above 255 lose their upper bits."""
        self._smbus(i2c_addr, _bytes([register]) + _block(data), force=force)

    def read_byte(self, i2c_addr: int, force: bool | None = None) -> int:
        """Read one byte."""
        return self._smbus(i2c_addr, None, 1, force=force)[0]

    def read_byte_data(self, i2c_addr: int, register: int, force: bool | None = None) -> int:
        """Send a register number, then read one byte."""
        return self._smbus(i2c_addr, _bytes([register]), 1, force=force)[0]

    def read_word_data(self, i2c_addr: int, register: int, force: bool | None = None) -> int:
        """Send a register number, then read two bytes, the low one first."""
        return int.from_bytes(self._smbus(i2c_addr, _bytes([register]), 2, force=force), "little")

    def process_call(self, i2c_addr: int, register: int, value: int, force: bool | None = None) -> int:
        """Send a register number and two bytes, then read two bytes."""
        return int.from_bytes(self._smbus(i2c_addr, _bytes([register, value, value >> 8]), 2, force=force), "little")

    def read_i2c_block_data(self, i2c_addr: int, register: int, length: int, force: bool | None = None) -> list[int]:
        """Send a register number, then read up to 32 bytes."""
        if length > _MAX_BLOCK:
            raise ValueError(f"Desired block length over {_MAX_BLOCK} bytes")
        return list(self._smbus(i2c_addr, _bytes([register]), length, force=force))

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

    def stretch(
        self, seconds: float, *, after: int = 0, at_byte: int = 0, times: int | None = 1, address: int | None = None
    ) -> Fault:
        """Make a chip hold the clock low in a coming message.

        Up to `timeout` seconds the transfer merely takes that much longer on the wire; past it the adapter gives up
        with ``ETIMEDOUT``, the chip having received `at_byte` bytes.

        Parameters
        ----------
        seconds : float
            How long the clock is held.
        after, at_byte, times, address
            As in `fail`.

        Examples
        --------
        >>> from paneldraw import simulator
        >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306()}, timer=None)
        >>> fault = bus.stretch(0.5)
        >>> bus.write_byte_data(0x3C, 0x00, 0xAF)
        >>> f"{bus.seconds:.3f} s"
        '0.500 s'
        """
        if not seconds > 0:
            raise ValueError(f"seconds: {seconds!r} is not above 0")
        return self._await(Fault(codes.ETIMEDOUT, after, at_byte, times, None, address, seconds))

    def stick(self, errno: int = codes.ETIMEDOUT, *, calls: int | None = None) -> None:
        """Let a chip hold SDA low, as one does whose read broke off: no call gets as far as a START.

        Parameters
        ----------
        errno : int
            What every call raises: ``ETIMEDOUT`` (default) or ``EAGAIN``, as the adapter has it.
        calls : int or None
            After how many calls the adapter's own recovery, nine pulses of the clock, has freed the line. Default:
            None, it has none; `recover` frees it.

        Examples
        --------
        >>> import errno
        >>> from paneldraw import simulator
        >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306()})
        >>> bus.stick(errno.EIO)
        >>> bus.write_quick(0x3C)
        Traceback (most recent call last):
        OSError: [Errno 5] Input/output error
        >>> bus.recover()
        >>> bus.write_quick(0x3C)
        """
        if errno < 1 or (calls is not None and calls < 1):
            raise ValueError("errno and calls are 1 or more")
        self._stuck = errno, calls

    def recover(self) -> None:
        """Free SDA by pulses of the clock."""
        self._stuck = None

    def clear_faults(self) -> None:
        """Forget all faults that wait, and free SDA."""
        super().clear_faults()
        self.recover()

    # inside

    def _check_open(self) -> None:
        if self.fd is None:
            raise TypeError("argument must be an int, or have a fileno() method.")

    def select(self, address: int, force: bool = False, most: int = 0x7F) -> None:
        """Do what the kernel does for ``I2C_SLAVE`` and ``I2C_SLAVE_FORCE``; `most` is the highest address."""
        if not 0 <= address <= most:
            raise os_error(codes.EINVAL)
        if address in self.claimed and not force:
            raise os_error(codes.EBUSY)

    def _smbus(
        self, address: int, payload: bytes | None, length: int | None = None, *, force: bool | None = None
    ) -> bytes:
        self._check_open()
        self.select(address, self.force if force is None else force)
        self.address = address
        return self.exchange(address, payload, length)

    def exchange(self, address: int, payload: bytes | None, length: int | None = None) -> bytes:
        """Write `payload`, then read `length` bytes, either of which may be None; all or an error, as SMBus has it."""
        parts = [] if payload is None else [Message(address, payload)]
        if length is not None:
            parts.append(Message(address, length=length))
        try:
            self._transfer(parts)
        except _ShortTransferError:
            raise os_error(codes.EIO) from None
        return parts[-1].answer

    def _transfer(self, parts: Sequence[Message]) -> None:
        for attempt in range(self.retries, -1, -1):
            try:
                self._try(parts)
                return
            except OSError as error:
                if error.errno != codes.EAGAIN or not attempt:
                    raise
            finally:
                self._rest()

    def _try(self, parts: Sequence[Message]) -> None:
        with self._lock:
            self._pass_time()
            self.transactions += 1
            self._check_free()
            bytes_before, started, stops = self.bytes, 0, 1
            self._call = self.bytes, self.messages
            touched: dict[int, tuple[Device, int]] = {}
            try:
                for part in parts:
                    started += 1
                    before = self.bytes
                    device = None if part.flags & _TEN else self._at(part.address)
                    try:
                        self._carry(part, device)
                    finally:
                        if device is not None:
                            chip = getattr(device, "chip", device)  # of two addresses, perhaps
                            wire_bytes = touched.get(id(chip), (chip, 0))[1] + self.bytes - before
                            touched[id(chip)] = chip, wire_bytes
                    if part.flags & _STOP and self.funcs & _MANGLING:
                        stops += 1
                        self._stop()
            except _ShortTransferError as short:
                short.count = started - 1
                raise
            finally:
                self._stop()
                busy, self._held = (9 * (self.bytes - bytes_before) + started + stops) / self.clock + self._held, 0
                now = self._elapse(busy)
                for device, wire_bytes in touched.values():
                    if isinstance(device, Chip) and device.timeline:
                        device.timeline.settle(now - busy)
                    device.settle(now, wire_bytes)
                if self._heard and self.log:
                    self.log.write(log.Call(now, tuple(self._heard)))
                self._heard.clear()

    def _check_free(self) -> None:
        """Raise if SDA is held low."""
        if self._stuck is None:
            return
        errno, calls = self._stuck
        if calls is None or calls > 1:
            self._stuck = errno, None if calls is None else calls - 1
        else:
            self._stuck = None
        raise os_error(errno)

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

    def _carry(self, part: Message, device: Device | None) -> None:
        """Put one message on the wire, as far as chip and faults let it."""
        self.messages += 1
        self.bytes += 1
        fault = self._due(part.address) if self._faults else None
        if device is None or (fault and fault.at_byte is None):
            self._note(part.address, b"", read=part.length is not None, acknowledged=False)
            self._raise(fault)
            raise os_error(EREMOTEIO)
        size = part.size
        got = size if fault is None else fault.reach(size)
        if fault and fault.hold:
            self._held += min(fault.hold, self.timeout)
            if fault.hold <= self.timeout:
                fault, got = None, size
        self.bytes += got
        if part.length is None:
            if isinstance(device, Chip) and device.timeline:
                bits = 9 * (self.bytes - got - self._call[0]) + self.messages - self._call[1]
                device.timeline.begin(bits / self.clock, 9 / self.clock)
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
