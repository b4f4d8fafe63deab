"""The reference device: the far end of the link as `PROTOCOL.md` describes it, over any I²C-like bus."""

from __future__ import annotations

import errno
import re
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Protocol

from firmware_protocol.cycle import TICKS
from firmware_protocol.cycle import Store as Kept
from firmware_protocol.frames import DELIMITER, Frame, FrameDecoder
from firmware_protocol.messages import (
    BASE_BAUDRATE,
    NEWEST_VERSION,
    OLDEST_VERSION,
    Ack,
    Baud,
    Boot,
    Byte,
    Cycle,
    Fault,
    Feature,
    Hello,
    HelloReply,
    Kind,
    Message,
    Nak,
    NakReason,
    Poll,
    Read,
    Reset,
    Status,
    Store,
    Write,
    decode,
    encode,
    is_sequenced,
)
from firmware_protocol.runs import unpack_runs

#: Seconds after a change of rate in which a valid frame must come.
PROBATION = 0.3
#: Seconds after any byte in which a valid frame must come, at any rate but the first.
DOUBT = 1.5
#: Seconds without a byte after which a device looks whether its panel is still there.
QUIET = 1.0

# What ends with a delimiter, and what does not yet.
_PIECES = re.compile(rb"[^\0]*\0|[^\0]+")
_STUCK = (errno.ETIMEDOUT, errno.EBUSY, errno.EAGAIN)


class Bus(Protocol):
    """What a device needs of an I²C bus: smbus2's ``i2c_rdwr``."""

    def i2c_rdwr(self, *messages: Any) -> object:
        """Carry the messages; raise OSError if nobody acknowledges."""


class SMBusWriter:
    """Writes to one address of a bus with smbus2's interface.

    Parameters
    ----------
    bus : object
        ``smbus2.SMBus`` or anything with its ``i2c_rdwr``.
    address : int, default 0x3C
        7-bit address of the panel.
    """

    def __init__(self, bus: Bus, address: int = 0x3C) -> None:
        from smbus2 import i2c_msg

        self.bus = bus
        self.address = address
        self._message = i2c_msg.write

    def __call__(self, content: bytes) -> None:
        """Write ``content`` in one transaction; OSError if the panel does not acknowledge."""
        self.bus.i2c_rdwr(self._message(self.address, content))


@dataclass
class Counters:
    """What a device has seen go wrong since its start; each wraps at 65 536."""

    damaged: int = 0
    overflows: int = 0
    line_errors: int = 0


class Device:
    """A device on the far end of a serial link.

    It is a function from bytes to bytes: `receive` takes what came over the line and returns what goes back.
    Whatever carries the bytes (a pty, a socket, a test) stays outside.

    Parameters
    ----------
    write : callable
        Called with the bytes of one transaction on the panel's bus, control byte first (00 commands, 40 data; on SPI
        it stands for the D/C line), or with no bytes to see whether the panel answers. Raises OSError where the panel
        does not. See `SMBusWriter`.
    read : callable, optional
        Returns a byte that it reads from the panel, or raises OSError. Default: this device cannot read.
    reset_panel : callable, optional
        Pulls the panel's reset line, where `profile` says that there is one.
    control_each : bool, default False
        Whether the panel wants the control byte 80 before each command byte.
    profile : HelloReply, optional
        What the device says of itself; ``nonce``, ``version``, ``boot``, ``cause`` and ``present`` are filled in by
        the device. Default: a 128 x 64 SSD1306 at 3C behind an ATmega328P.
    boot : int, default 1
        Number of this start, 16 bits; `reset` counts on.
    clock : callable, default `time.monotonic`
        Seconds, for changes of rate.

    Attributes
    ----------
    baudrate : int
        The rate that the device listens at now, bits a second.
    counters : Counters
        What went wrong on the line.
    pictures : int
        How many times a WRITE completed a picture.

    Examples
    --------
    >>> from firmware_protocol.messages import Hello, Write, decode, encode
    >>> written = []
    >>> device = Device(written.append)
    >>> hello = device.receive(encode(Hello(nonce=7)))
    >>> reply = device.receive(encode(Write(0, bytes.fromhex("82 b0 02 10 00 ff"))))
    >>> reply == encode(Ack(0))
    True
    >>> [transaction.hex() for transaction in written if transaction]
    ['00b00210', '40ff']
    """

    def __init__(
        self,
        write: Callable[[bytes], None],
        *,
        read: Callable[[], int] | None = None,
        reset_panel: Callable[[], object] = lambda: None,
        control_each: bool = False,
        profile: HelloReply | None = None,
        boot: int = 1,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.write = write
        self.read = read
        self.reset_panel = reset_panel
        self.control_each = control_each
        self.profile = profile or UNO
        self.clock = clock
        self.boot = boot - 1 & 0xFFFF
        self.counters = Counters()
        self.pictures = 0
        self._decoder = FrameDecoder(self.profile.max_payload)
        self.reset(1)

    def reset(self, cause: int = 2) -> bytes:
        """Start anew, as after a reset; return the BOOT message that goes out at 115 200 bits a second.

        Parameters
        ----------
        cause : int, default 2
            1 power on, 2 reset pin, 4 brown-out, 8 watchdog.
        """
        self.boot = self.boot + 1 & 0xFFFF
        self.cause = cause
        self.baudrate = BASE_BAUDRATE
        self.counters = Counters()
        self._decoder.clear()
        self._in_session = False
        self._expected = 0
        self._fault = Fault.NONE
        self._nak_armed = False
        self._features = 0
        self._store = Kept(self.profile.store, self.profile.repeats)
        self._quiet_since = self.clock()
        self._revert_at: float | None = None
        if self.profile.reset_line:
            self.reset_panel()
        return _wire(Boot(self.boot, cause))

    def receive(self, data: bytes) -> bytes:
        """Take bytes from the line, carry out what they complete, return the bytes that answer."""
        self.tick()
        answer = b""
        rate = self.baudrate
        for piece in _PIECES.findall(data):
            self._quiet_since = self.clock()
            self._doubt()
            for frame in self._decoder.feed(piece):
                answer += b"".join(map(_wire, self._answer(frame)))
            if self.baudrate != rate:
                break  # what came behind it came at the old rate
        return answer

    def line_error(self) -> None:
        """Count a character that the line's receiver found broken or had to drop."""
        self.counters.line_errors = self.counters.line_errors + 1 & 0xFFFF
        self._doubt()

    def tick(self) -> None:
        """Let time pass: write the next sub-picture, look after the panel, go back to 115 200 at a rate in vain."""
        now = self.clock()
        if self._store.due(self._ticks):
            self._take_turn()
        if now - self._quiet_since >= QUIET:
            self._quiet_since = now
            if self._features & Feature.WATCH and not self._fault and not self._store.on:
                self._fail(self._transfer(b""))
        if self._revert_at is not None and now >= self._revert_at:
            self._revert_at = None
            self.baudrate = BASE_BAUDRATE
            self._decoder.clear()

    def _doubt(self) -> None:
        if self.baudrate != BASE_BAUDRATE and self._revert_at is None:
            self._revert_at = self.clock() + DOUBT

    def _answer(self, frame: Frame | None) -> list[Message]:
        if frame is None:
            self.counters.damaged = self.counters.damaged + 1 & 0xFFFF
            return self._nak(NakReason.DAMAGED)
        self._revert_at = None
        if is_sequenced(frame.kind):
            return self._in_sequence(frame)
        try:
            message = decode(frame)
        except ValueError:
            return []
        match message:
            case Hello():
                return [self._greet(message)]
            case Poll(token):
                return [self._status(token)]
            case Read(token) if self.read is not None:
                return self._read(token, self.read)
        return []

    def _in_sequence(self, frame: Frame) -> list[Message]:
        if not self._in_session:
            return [Boot(self.boot, self.cause)]
        ahead = frame.seq - self._expected & 0xFF
        if ahead >= 128:
            return [Ack(self._expected - 1 & 0xFF, self._fault)]
        if ahead:
            return self._nak(NakReason.GAP)
        self._expected = self._expected + 1 & 0xFF
        self._nak_armed = True
        self._execute(frame)
        return [Ack(frame.seq, self._fault)]

    def _nak(self, reason: NakReason) -> list[Message]:
        if not self._in_session or (reason == NakReason.GAP and not self._nak_armed):
            return []
        self._nak_armed = False
        return [Nak(self._expected, reason)]

    def _greet(self, hello: Hello) -> Message:
        self._end_cycle()
        version = min(hello.newest, self.profile.newest)
        if version < max(hello.oldest, self.profile.oldest):
            version = 0
        self._in_session = version > 0
        self._nak_armed = True
        self._expected = 0
        self._fault = Fault.NONE
        self._features = self._can & hello.features if self._in_session else 0
        return replace(
            self.profile,
            features=self._can,
            nonce=hello.nonce,
            version=version,
            boot=self.boot,
            cause=self.cause,
            present=self._transfer(b"") is Fault.NONE,
        )

    @property
    def _can(self) -> int:
        return self.profile.features & (~int(Feature.READ) if self.read is None else -1)

    def _read(self, token: int, read: Callable[[], int]) -> list[Message]:
        if not self._in_session:
            return [Boot(self.boot, self.cause)]
        if not self._features & Feature.READ:
            return []
        try:
            return [Byte(token, Fault.NONE, read())]
        except OSError as error:
            return [Byte(token, _fault_of(error))]

    def _status(self, token: int) -> Message:
        if not self._in_session:
            return Boot(self.boot, self.cause)
        self._nak_armed = True
        seen = self.counters
        return Status(token, self._expected, self._fault, self.boot, seen.damaged, seen.overflows, seen.line_errors)

    @property
    def _ticks(self) -> int:
        return round(self.clock() * TICKS) & 0xFFFF

    def _take_turn(self, first: bool = False) -> None:
        """Write the next sub-picture, or the first; a fault ends the cycle."""
        runs = self._store.take(self._ticks, first=first)
        fault = self._put_out(runs) if runs else self._transfer(b"")
        if fault:
            self._fail(fault)
            self._store.end()

    def _end_cycle(self) -> None:
        """See to it that the panel shows the first sub-picture."""
        if self._store.shown:
            self._take_turn(first=True)
        self._store.end()

    def _execute(self, frame: Frame) -> None:
        if frame.kind != Kind.BAUD:
            self._end_cycle()
        if frame.kind in (Kind.STORE, Kind.CYCLE) and not self._features & Feature.CYCLE:
            self._fail(Fault.UNKNOWN_KIND)
            return
        try:
            message = decode(frame)
        except ValueError:
            self._fail(Fault.MALFORMED if frame.kind in set(Kind) else Fault.UNKNOWN_KIND)
            return
        match message:
            case Reset(pulse=pulse):
                self._fault = Fault.NONE
                if pulse and self.profile.reset_line:
                    self.reset_panel()
            case Baud(rate=rate) if not self._fault:
                self._change_rate(rate)
            case Write(payload=payload, end=end) if not self._fault:
                self._write(payload, end)
            case Store() | Cycle() if not self._fault:
                self._cycle(message)

    def _cycle(self, message: Store | Cycle) -> None:
        try:
            if isinstance(message, Store):
                self._store.put(message.offset, message.content)
            elif message.count:
                self._store.begin(message.length, message.count, self._ticks)
        except ValueError:
            self._fail(Fault.MALFORMED)

    def _change_rate(self, rate: int) -> None:
        if rate not in self.profile.bauds:
            self._fail(Fault.BAUD_NOT_OFFERED)
            return
        self.baudrate = rate
        self._decoder.clear()
        self._revert_at = None if rate == BASE_BAUDRATE else self.clock() + PROBATION

    def _write(self, payload: bytes, end: bool) -> None:
        try:
            runs = unpack_runs(payload, repeats=self.profile.repeats)
        except ValueError:
            self._fail(Fault.MALFORMED)
            return
        self._fail(self._put_out(runs))
        self.pictures += end and not self._fault

    def _put_out(self, runs: list[tuple[bool, bytes]]) -> Fault:
        """Write runs to the panel, up to the first that it does not take."""
        for is_data, content in runs:
            fault = self._transfer(self._transaction(is_data, content))
            if fault:
                return fault
        return Fault.NONE

    def _transaction(self, is_data: bool, content: bytes) -> bytes:
        if is_data:
            return b"\x40" + content
        if self.control_each:
            return b"".join(b"\x80" + content[at : at + 1] for at in range(len(content)))
        return b"\x00" + content

    def _transfer(self, content: bytes) -> Fault:
        try:
            self.write(content)
        except OSError as error:
            return _fault_of(error)
        return Fault.NONE

    def _fail(self, fault: Fault) -> None:
        self._fault = self._fault or fault


def _wire(message: Message) -> bytes:
    """What goes out; what is not counted must not be swallowed by the rest of a frame that broke off."""
    return (b"" if isinstance(message, Ack | Nak) else DELIMITER) + encode(message)


def _fault_of(error: OSError) -> Fault:
    return Fault.BUS_STUCK if error.errno in _STUCK else Fault.ADDRESS_NACK


#: What the firmware on an Arduino Uno or Nano with a 128 x 64 SSD1306 says of itself.
UNO = HelloReply(
    nonce=0,
    oldest=OLDEST_VERSION,
    newest=NEWEST_VERSION,
    max_payload=250,
    window=448,
    width=128,
    height=64,
    bauds=(500_000, 1_000_000, 250_000, 115_200),
    controller="ssd1306",
    firmware="paneldraw reference 1.0",
    features=Feature.WATCH | Feature.READ | Feature.CYCLE,
    store=720,
)
