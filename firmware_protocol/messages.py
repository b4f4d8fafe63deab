"""The messages of the link, as frozen records, and their way into frames and back."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum, IntFlag

from firmware_protocol.frames import Frame, encode_frame

#: The protocol versions this package speaks.
OLDEST_VERSION = 1
NEWEST_VERSION = 1
#: Every device starts, and after trouble ends, at this rate.
BASE_BAUDRATE = 115_200


class Kind(IntEnum):
    """The number of a message: below 80 from the host, 10 to 1F in sequence, from 80 on from the device."""

    HELLO = 0x01
    POLL = 0x02
    READ = 0x03
    WRITE = 0x10
    WRITE_END = 0x11
    BAUD = 0x12
    RESET = 0x13
    STORE = 0x14
    CYCLE = 0x15
    HELLO_REPLY = 0x81
    STATUS = 0x82
    BOOT = 0x83
    ACK = 0x84
    NAK = 0x85
    BYTE = 0x86


class Feature(IntFlag):
    """What an end can do beyond the rest; both must, or it is not done."""

    WATCH = 0x0001
    READ = 0x0002
    CYCLE = 0x0004


#: What this package knows to do as a host.
HOST_FEATURES = Feature.WATCH | Feature.READ | Feature.CYCLE


class Fault(IntEnum):
    """What went wrong first since the last HELLO or RESET; while it is not NONE, nothing is written to the panel."""

    NONE = 0
    ADDRESS_NACK = 1
    DATA_NACK = 2
    BUS_STUCK = 3
    MALFORMED = 4
    UNKNOWN_KIND = 5
    BAUD_NOT_OFFERED = 6


class NakReason(IntEnum):
    """Why a NAK was sent."""

    DAMAGED = 1
    GAP = 2


class PanelBus(IntEnum):
    """What joins the device to its panel."""

    NONE = 0
    I2C = 1
    SPI = 2


def cause_text(cause: int) -> str:
    """Say why a device started."""
    names = ("power on", "reset pin", "brown-out", "watchdog")
    return " and ".join(name for bit, name in enumerate(names) if cause >> bit & 1) or "cause unknown"


def is_sequenced(kind: int) -> bool:
    """Return whether frames of this kind are counted, acknowledged and repeated when lost."""
    return 0x10 <= kind <= 0x1F


@dataclass(frozen=True, slots=True)
class Hello:
    """Host: begin a session. ``nonce`` (32 bits) comes back in the reply; ``features`` are those the host knows."""

    nonce: int
    oldest: int = OLDEST_VERSION
    newest: int = NEWEST_VERSION
    features: int = 0


@dataclass(frozen=True, slots=True)
class Poll:
    """Host: say, once all before this is done, what you expect next. ``token`` (8 bits) comes back in the reply."""

    token: int


@dataclass(frozen=True, slots=True)
class Read:
    """Host: read a byte from the panel once all before this is done. ``token`` comes back with it."""

    token: int


@dataclass(frozen=True, slots=True)
class Write:
    """Host: write these runs to the panel (see `pack_runs`); ``end`` says that they complete a picture."""

    seq: int
    payload: bytes
    end: bool = True


@dataclass(frozen=True, slots=True)
class Baud:
    """Host: acknowledge, then go on at this rate, in bits a second."""

    seq: int
    rate: int


@dataclass(frozen=True, slots=True)
class Reset:
    """Host: forget the fault and, with ``pulse``, pull the panel's reset line if there is one."""

    seq: int
    pulse: bool = False


@dataclass(frozen=True, slots=True)
class Store:
    """Host: put bytes into the store, from ``offset`` on."""

    seq: int
    offset: int
    content: bytes


@dataclass(frozen=True, slots=True)
class Cycle:
    """Host: write the ``count`` sub-pictures in turn that the first ``length`` bytes of the store are.

    None with a ``count`` of 0: then it ends a cycle, as every sequenced message but BAUD does.
    """

    seq: int
    length: int = 0
    count: int = 0


@dataclass(frozen=True, slots=True)
class HelloReply:
    """Device: what answers.

    Attributes
    ----------
    nonce : int
        That of the HELLO.
    version : int
        The version of this session, 0 if there is none that both speak.
    oldest, newest : int
        The versions that the device speaks.
    boot : int
        Another number after each start, 16 bits.
    cause : int
        Bits: 1 power on, 2 reset pin, 4 brown-out, 8 watchdog.
    bus : PanelBus
        What joins device and panel.
    address : int
        The panel's 7-bit I²C address, 0 elsewhere.
    acknowledges : bool
        Whether the panel's bus tells that a byte arrived.
    present : bool
        Whether the panel answered just now (True where the bus cannot tell).
    reset_line : bool
        Whether RESET can pull the panel's reset line.
    repeats : bool
        Whether WRITE may hold repeats.
    max_payload, window : int
        Longest payload, and most bytes on the wire that may be unacknowledged.
    width, height : int
        Of the panel in pixels, 0 if the device does not know.
    bauds : tuple of int
        Rates for BAUD, the best first; empty where the rate does not matter.
    controller, firmware : str
        The panel's chip as the host names it, or "" if not known; the firmware's name and version.
    features : int
        Those of `Feature` that the device has, and others that later versions add.
    store : int
        Bytes of sub-pictures that the device can keep; 0 if it keeps none.
    frame_line : bool
        Whether the panel's frame line tells the device when to go on to the next of them.
    """

    nonce: int
    version: int = NEWEST_VERSION
    oldest: int = OLDEST_VERSION
    newest: int = NEWEST_VERSION
    boot: int = 0
    cause: int = 0
    bus: PanelBus = PanelBus.I2C
    address: int = 0x3C
    acknowledges: bool = True
    present: bool = True
    reset_line: bool = False
    repeats: bool = True
    max_payload: int = 250
    window: int = 448
    width: int = 0
    height: int = 0
    bauds: tuple[int, ...] = ()
    controller: str = ""
    firmware: str = ""
    features: int = 0
    store: int = 0
    frame_line: bool = False


@dataclass(frozen=True, slots=True)
class Status:
    """Device: the answer to a POLL; ``expected`` is the sequence number it wants next, the rest are counters."""

    token: int
    expected: int
    fault: Fault = Fault.NONE
    boot: int = 0
    damaged: int = 0
    overflows: int = 0
    line_errors: int = 0


@dataclass(frozen=True, slots=True)
class Boot:
    """Device: I have started and know of no session."""

    boot: int
    cause: int


@dataclass(frozen=True, slots=True)
class Ack:
    """Device: all up to ``seq`` is done; ``fault`` if something of it failed."""

    seq: int
    fault: Fault = Fault.NONE


@dataclass(frozen=True, slots=True)
class Nak:
    """Device: something was lost, ``seq`` is wanted."""

    seq: int
    reason: NakReason = NakReason.DAMAGED


@dataclass(frozen=True, slots=True)
class Byte:
    """Device: the answer to a READ: the byte that the panel gave, or why there is none."""

    token: int
    fault: Fault = Fault.NONE
    value: int = 0


Message = Hello | Poll | Read | Write | Baud | Reset | Store | Cycle | HelloReply | Status | Boot | Ack | Nak | Byte

_HELLO = struct.Struct("<IBB")
_NUMBER = struct.Struct("<H")
_REPLY = struct.Struct("<IBBBHBBBBBHHHHB")
_STATUS = struct.Struct("<BBHHHH")
_BOOT = struct.Struct("<HB")
_CYCLE = struct.Struct("<HB")


def encode(message: Message) -> bytes:
    """Return a message as the frame that goes on the wire.

    Examples
    --------
    >>> encode(Ack(5)).hex(" ")
    '03 84 05 03 d4 f3 00'
    """
    return encode_frame(*_fields(message))


def decode(frame: Frame) -> Message:
    """Return the message in a frame.

    Bytes after the last field are ignored, so that later versions can add some.

    Raises
    ------
    ValueError
        If there is no message of that kind or its payload does not fit.

    Examples
    --------
    >>> decode(Frame(0x84, 5, b"\\x00"))
    Ack(seq=5, fault=<Fault.NONE: 0>)
    """
    reader = _READERS.get(frame.kind)
    if reader is None:
        raise ValueError(f"there is no message of kind {frame.kind:02x}")
    try:
        return reader(frame.seq, frame.payload)
    except (struct.error, IndexError, ValueError) as error:
        raise ValueError(f"the payload of {Kind(frame.kind).name} does not fit: {error}") from error


def _fields(message: Message) -> tuple[int, int, bytes]:
    match message:
        case Write(seq, payload, end):
            return Kind.WRITE_END if end else Kind.WRITE, seq, payload
        case Ack(seq, fault):
            return Kind.ACK, seq, bytes((fault,))
        case Hello(nonce, oldest, newest, features):
            return Kind.HELLO, 0, _HELLO.pack(nonce, oldest, newest) + _NUMBER.pack(features)
        case Poll(token):
            return Kind.POLL, token, b""
        case Read(token):
            return Kind.READ, token, b""
        case Baud(seq, rate):
            return Kind.BAUD, seq, rate.to_bytes(4, "little")
        case Reset(seq, pulse):
            return Kind.RESET, seq, bytes((pulse,))
        case Store(seq, offset, content):
            return Kind.STORE, seq, _NUMBER.pack(offset) + content
        case Cycle(seq, length, count):
            return Kind.CYCLE, seq, _CYCLE.pack(length, count) if count else b""
        case HelloReply():
            return Kind.HELLO_REPLY, 0, _pack_reply(message)
        case Status(token, expected, fault, boot, damaged, overflows, line_errors):
            return Kind.STATUS, token, _STATUS.pack(expected, fault, boot, damaged, overflows, line_errors)
        case Boot(boot, cause):
            return Kind.BOOT, 0, _BOOT.pack(boot, cause)
        case Nak(seq, reason):
            return Kind.NAK, seq, bytes((reason,))
        case Byte(token, fault, value):
            return Kind.BYTE, token, bytes((fault, value))


def _pack_reply(reply: HelloReply) -> bytes:
    flags = reply.acknowledges | reply.present << 1 | reply.reset_line << 2 | reply.frame_line << 3
    return b"".join(
        (
            _REPLY.pack(
                reply.nonce, reply.version, reply.oldest, reply.newest, reply.boot, reply.cause,
                reply.bus, reply.address, flags, reply.repeats, reply.max_payload, reply.window,
                reply.width, reply.height, len(reply.bauds),
            ),
            *(rate.to_bytes(4, "little") for rate in reply.bauds),
            *(bytes((len(name),)) + name.encode("ascii") for name in (reply.controller, reply.firmware)),
            _NUMBER.pack(reply.features),
            _NUMBER.pack(reply.store),
        )
    )  # fmt: skip


def _read_reply(seq: int, payload: bytes) -> HelloReply:
    nonce, version, oldest, newest, boot, cause, bus, address, flags, encodings, *rest = _REPLY.unpack_from(payload)
    max_payload, window, width, height, bauds = rest
    at = _REPLY.size + 4 * bauds
    rates = struct.unpack(f"<{bauds}I", payload[_REPLY.size : at])
    controller, at = _read_name(payload, at)
    firmware, at = _read_name(payload, at)
    features, store = _read_number(payload, at), _read_number(payload, at + _NUMBER.size)
    return HelloReply(
        nonce, version, oldest, newest, boot, cause, PanelBus(bus), address,
        bool(flags & 1), bool(flags & 2), bool(flags & 4), bool(encodings & 1),
        max_payload, window, width, height, rates, controller, firmware, features,
        store, bool(flags & 8),
    )  # fmt: skip


def _read_hello(seq: int, payload: bytes) -> Hello:
    nonce, oldest, newest = _HELLO.unpack_from(payload)
    return Hello(nonce, oldest, newest, _read_number(payload, _HELLO.size))


def _read_number(payload: bytes, at: int) -> int:
    """A field that was added: it is 0 of who does not send it."""
    return int(_NUMBER.unpack_from(payload, at)[0]) if len(payload) >= at + _NUMBER.size else 0


def _read_store(seq: int, payload: bytes) -> Store:
    return Store(seq, int(_NUMBER.unpack_from(payload)[0]), payload[_NUMBER.size :])


def _read_status(seq: int, payload: bytes) -> Status:
    expected, fault, *counters = _STATUS.unpack_from(payload)
    return Status(seq, expected, Fault(fault), *counters)


def _read_name(payload: bytes, at: int) -> tuple[str, int]:
    end = at + 1 + payload[at]
    if end > len(payload):
        raise ValueError("a name is cut off")
    return payload[at + 1 : end].decode("ascii"), end


_READERS: dict[int, Callable[[int, bytes], Message]] = {
    Kind.HELLO: _read_hello,
    Kind.POLL: lambda seq, payload: Poll(seq),
    Kind.READ: lambda seq, payload: Read(seq),
    Kind.WRITE: lambda seq, payload: Write(seq, payload, False),
    Kind.WRITE_END: lambda seq, payload: Write(seq, payload, True),
    Kind.BAUD: lambda seq, payload: Baud(seq, int.from_bytes(struct.unpack_from("4s", payload)[0], "little")),
    Kind.RESET: lambda seq, payload: Reset(seq, bool(payload[0] & 1)),
    Kind.STORE: _read_store,
    Kind.CYCLE: lambda seq, payload: Cycle(seq, *(_CYCLE.unpack_from(payload) if payload else ())),
    Kind.HELLO_REPLY: _read_reply,
    Kind.STATUS: _read_status,
    Kind.BOOT: lambda seq, payload: Boot(*_BOOT.unpack_from(payload)),
    Kind.ACK: lambda seq, payload: Ack(seq, Fault(payload[0])),
    Kind.NAK: lambda seq, payload: Nak(seq, NakReason(payload[0])),
    Kind.BYTE: lambda seq, payload: Byte(seq, Fault(payload[0]), payload[1]),
}
