"""Recordings of a wire that other programs made, as events.

sigrok's session files (PulseView, sigrok-cli; https://sigrok.org/wiki/File_format:Sigrok/v2, libsigrok's
``session_file.c``): a zip with ``metadata``, an INI file, and samples in ``logic-1`` or ``logic-1-1``, ``logic-1-2``
and so on, ``unitsize`` bytes each, the first channel in the lowest bit.

sigrok's CSV (libsigrok's ``output/csv.c``): comments that begin with ``;``, a line of labels, a line a sample.

Annotations of sigrok's I2C decoder (libsigrokdecode's ``i2c/pd.py``), as PulseView exports them
(``12-34 I2C: Address/data: Address write: 3C``, the format being the user's) or sigrok-cli prints them
(``i2c-1: Address write: 3C``).

Saleae's CSV: Logic 2's table of an analyzer (``name,type,start_time,duration,"ack","address","read","data"``; the
frames are those of https://support.saleae.com/extensions/analyzer-frame-types/i2c-analyzer), the analyzers' own export
(``Time [s],Packet ID,Address,Data,Read/Write,ACK/NAK``), and digital channels (``Time [s],Channel 0,Channel 1``,
https://support.saleae.com/faq/technical-faq/binary-and-csv-export-formats-2025-update).

The kernel's tracepoints of I2C (include/trace/events/i2c.h, ``echo 1 > /sys/kernel/tracing/events/i2c/enable``), whose
text shows 64 bytes of a message at the most (``%*ph`` in Documentation/core-api/printk-formats.rst).
"""

from __future__ import annotations

import configparser
import csv
import re
import zipfile
import zlib
from collections.abc import Iterable, Iterator, Mapping
from itertools import groupby
from typing import IO, Any, Final

import numpy as np
from numpy.typing import NDArray

from .edges import NO_DC, Bits, Samples, Say
from .log import Call, Event, Message, Select

Text = Iterable[tuple[int, str]]
"""Numbered lines."""

_MOST_METADATA: Final = 1 << 20
_MOST_SAMPLES: Final = 1 << 32
"""Bytes of samples that are looked through, in all."""
_MOST_EDGES: Final = 1 << 25
_CHUNK: Final = 1 << 22
_DAMAGED: Final = (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, KeyError)
_SHOWN: Final = 64
"""Bytes of a message that the kernel's text shows."""


# -- sigrok's session files


def session(file: IO[bytes], rate: float | None = None) -> Samples:
    """Read a sigrok session file; `rate` is for one that does not tell its samples a second.

    Raises
    ------
    ValueError
        If it is damaged, or none.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            return _session(archive, rate)
    except _DAMAGED as error:
        raise ValueError(f"the file is damaged, or no sigrok session: {error}") from None


def _session(archive: zipfile.ZipFile, rate: float | None) -> Samples:
    names = archive.namelist()
    if "metadata" not in names:
        hint = "; it looks like Saleae's: export it as CSV there" if "meta.json" in names else ""
        raise ValueError(f"the zip has no file metadata, as sigrok sessions have{hint}")
    with archive.open("metadata") as metadata:
        text = metadata.read(_MOST_METADATA).decode("utf-8", "replace")
    parser = configparser.ConfigParser(interpolation=None, strict=False)
    try:
        parser.read_string(text)
    except configparser.Error:
        raise ValueError("the session's metadata is damaged") from None
    device = next((parser[name] for name in parser.sections() if "capturefile" in parser[name]), None)
    if device is None:
        raise ValueError("the session has no logic channels, only analog ones or none")
    probes = {int(key[5:]) - 1: name for key, name in device.items() if re.fullmatch(r"probe[1-9]\d{0,2}", key)}
    size, rate = device.get("unitsize", ""), _rate(device.get("samplerate", "")) or rate
    if not re.fullmatch("[1-8]", size) or not probes or max(probes) >= 8 * int(size):
        raise ValueError("the session's metadata does not say its unitsize and probes")
    if not rate:
        raise ValueError("the session does not tell its samplerate; say it with --rate")
    stem = re.escape(device["capturefile"])
    parts = sorted(
        (name for name in names if re.fullmatch(rf"{stem}(-\d+)?", name)), key=lambda name: (len(name), name)
    )
    if not parts:
        raise ValueError(f"the session lacks its samples, {device['capturefile']}")
    numbers, values = _changes(_chunks(archive, parts, int(size)), int(size), sum(1 << bit for bit in probes))
    channels = sorted(probes)
    return Samples([probes[bit] for bit in channels], numbers / rate, _bits(values, channels))


def _rate(text: str) -> float:
    """Read a rate such as "2 MHz"; 0 where there is none."""
    found = re.fullmatch(r"\s*(\d+(?:\.\d+)?)\s*([kMG]?)(?:Hz)?\s*", text)
    return float(found[1]) * {"": 1, "k": 1e3, "M": 1e6, "G": 1e9}[found[2]] if found else 0.0


def _chunks(archive: zipfile.ZipFile, parts: Iterable[str], size: int) -> Iterator[bytes]:
    """The samples, in pieces of whole samples."""
    rest, total = b"", 0
    for part in parts:
        with archive.open(part) as samples:
            while chunk := samples.read(_CHUNK):
                total += len(chunk)
                if total > _MOST_SAMPLES:
                    raise ValueError(
                        f"there are more than {_MOST_SAMPLES >> 30} GiB of samples; cut the recording down"
                    )
                chunk = rest + chunk
                whole = len(chunk) - len(chunk) % size
                rest = chunk[whole:]
                yield chunk[:whole]


def _words(chunk: bytes, size: int) -> NDArray[Any]:
    """Samples of so many bytes as numbers."""
    if size in (1, 2, 4, 8):
        return np.frombuffer(chunk, f"<u{size}")
    padded = np.zeros((len(chunk) // size, 8), np.uint8)
    padded[:, :size] = np.frombuffer(chunk, np.uint8).reshape(-1, size)
    return padded.view("<u8")[:, 0]


def _changes(chunks: Iterable[bytes], size: int, mask: int) -> tuple[NDArray[np.int64], NDArray[Any]]:
    """The numbers of the samples at which a channel changes, and what they are."""
    numbers: list[NDArray[np.int64]] = []
    values: list[NDArray[Any]] = []
    start, last, edges = 0, None, 0
    for chunk in filter(None, chunks):
        words = _words(chunk, size)
        samples = words & np.array(mask, words.dtype)
        before = np.concatenate((~samples[:1] if last is None else last, samples[:-1]))
        at = np.flatnonzero(samples != before)
        numbers.append(at + start)
        values.append(samples[at])
        start, last, edges = start + len(samples), samples[-1:], edges + len(at)
        _check_edges(edges)
    if not start:
        raise ValueError("the session has no samples")
    return np.concatenate([*numbers, np.array([start])]), np.concatenate([*values, samples[-1:]])


def _bits(values: NDArray[Any], channels: Iterable[int]) -> Bits:
    return np.stack([(values >> np.array(bit, values.dtype) & 1).astype(np.bool_) for bit in channels], axis=1)


# -- Samples as CSV


def sigrok_csv(text: Text) -> Samples:
    """Read samples as sigrok writes them, every one or those that differ, with their times or without."""
    rate, channels, columns = 0.0, list[str](), 0
    times: list[int] = []
    levels: list[list[str]] = []
    count = 0
    for number, line in text:
        if line.startswith((";", "#")):
            name, _, value = line.lstrip(";# ").partition(":")
            if name == "Samplerate":
                rate = _rate(value)
            elif name.startswith("Channels"):
                channels = [channel.strip() for channel in value.split(",")]
            continue
        cells = line.split(",")
        if not line or (not columns and not cells[-1].isdigit()):  # the labels
            continue
        columns = columns or len(cells)
        if len(cells) != columns or not line.replace(",", "").isdigit():
            raise ValueError(f"line {number} is none of sigrok's CSV: {line[:40]!r}")
        count += 1
        if not levels or cells[-len(channels) :] != levels[-1]:
            times.append(int(cells[0]) if columns > len(channels) else count)
            levels.append(cells[-len(channels) :])
            _check_edges(len(levels) * columns)
    if not rate or not levels or columns not in (len(channels), len(channels) + 1):
        raise ValueError(
            "the CSV does not say its channels and its samplerate, or has no samples; export its header too"
        )
    tick = 1 / rate if columns == len(channels) else _tick(rate)
    return Samples(channels, np.array(times) * tick, np.array(levels) == "1")


def _tick(rate: float) -> float:
    """What sigrok counts times in: the largest of seconds, milliseconds and so on that is below a sample's."""
    ticks = 1.0
    while 1 / ticks < rate:
        ticks /= 1000
    return ticks


def _check_edges(count: int) -> None:
    if count > _MOST_EDGES:
        raise ValueError(f"there are more than {_MOST_EDGES >> 20} million edges; cut the recording down")


def saleae_digital(text: Text) -> Samples:
    """Read digital channels as Saleae's Logic writes them: a line a change."""
    channels: list[str] = []
    seconds: list[float] = []
    levels: list[list[bool]] = []
    for number, line in text:
        cells = next(csv.reader([line]), [])
        if not channels:
            channels = [cell.strip() for cell in cells[1:]]
            continue
        if not line:
            continue
        try:
            if len(cells) != len(channels) + 1:
                raise ValueError
            seconds.append(float(cells[0]))
            levels.append([cell.strip() == "1" for cell in cells[1:]])
        except ValueError:
            raise ValueError(f"line {number} is none of Saleae's CSV: {line[:40]!r}") from None
        _check_edges(len(levels) * len(cells))
    if not seconds:
        raise ValueError("the CSV has no samples")
    return Samples(channels, np.array(seconds), np.array(levels, np.bool_))


# -- Saleae's analyzers


def saleae_table(text: Text, say: Say) -> Iterator[Event]:
    """Read Logic 2's table of an I2C or SPI analyzer."""
    rows = _Rows(text, "Saleae's table")
    if "mosi" in rows.fields:
        return _table_spi(rows, say)
    if {"address", "data", "ack", "read"} <= rows.fields:
        return _table_i2c(rows, say)
    raise ValueError("the table is of neither an I2C nor an SPI analyzer")


class _Rows:
    """Rows of a CSV by their column's names, with their line's number."""

    def __init__(self, text: Text, what: str) -> None:
        self._lines, self._what = iter(text), what
        _, header = next(self._lines, (0, ""))
        self._names = [name.strip() for name in next(csv.reader([header]), [])]
        self.fields = frozenset(self._names)

    def __iter__(self) -> Iterator[tuple[int, dict[str, str]]]:
        for number, line in self._lines:
            if line:
                cells = next(csv.reader([line]), [])
                if len(cells) != len(self._names):
                    raise ValueError(f"line {number} is none of {self._what}: {line[:40]!r}")
                yield number, dict(zip(self._names, (cell.strip() for cell in cells), strict=True))


def _number(text: str, line: int) -> int:
    """A byte as Saleae writes it: 0x3C, 60, 0b00111100 or a character in quotes."""
    text = text.strip()
    if len(text) == 3 and text[0] == text[2] == "'":
        return ord(text[1]) & 0xFF
    try:
        value = int(text.strip("'"), 0)
    except ValueError:
        raise ValueError(f"line {line}: {text[:20]!r} is no byte; export numbers as hexadecimal") from None
    if not 0 <= value <= 0xFF:
        raise ValueError(f"line {line}: {text[:20]!r} is no byte")
    return value


def _seconds(text: str, line: int) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"line {line}: {text[:20]!r} is no time in seconds; export times as seconds") from None


def _table_i2c(rows: _Rows, say: Say) -> Iterator[Event]:
    messages = _Messages(say)
    for line, row in rows:
        seconds = _seconds(row["start_time"], line)
        if row["type"] == "start":
            messages.start()
        elif row["type"] == "address":
            messages.address(_number(row["address"], line), row["read"] == "true", row["ack"] == "true")
        elif row["type"] == "data":
            messages.byte(_number(row["data"], line), row["ack"] == "true")
        elif row["type"] == "stop":
            yield from messages.stop(seconds)
    yield from messages.stop(messages.seconds)


class _Messages:
    """Puts messages together from their parts."""

    def __init__(self, say: Say) -> None:
        self._say = say
        self._done: list[Message] = []
        self._head: tuple[int, bool, bool] | None = None
        self._payload = bytearray()
        self.seconds = 0.0

    def start(self) -> None:
        """Note a START: the message before is over."""
        if self._head is not None:
            address, read, acknowledged = self._head
            self._done.append(Message(address, bytes(self._payload), read, acknowledged))
        self._head, self._payload = None, bytearray()

    def address(self, address: int, read: bool, acknowledged: bool) -> None:
        """Note an address."""
        self._head = address & 0x7F, read, acknowledged

    def byte(self, value: int, acknowledged: bool) -> None:
        """Note a byte of data."""
        if self._head is None:
            self._say("data without an address is left out")
            return
        if not acknowledged and not self._head[1]:
            self._say("the chip did not acknowledge every byte of what was written")
        self._payload.append(value)

    def stop(self, seconds: float) -> Iterator[Call]:
        """Note a STOP, or the end."""
        self.start()
        self.seconds = seconds
        if self._done:
            yield Call(seconds, tuple(self._done))
        self._done = []


def _table_spi(rows: _Rows, say: Say) -> Iterator[Event]:
    say(f"the table does not tell the level of {NO_DC}")
    payload, seconds = bytearray(), 0.0
    for line, row in rows:
        seconds = _seconds(row["start_time"], line)
        if row["type"] == "result":
            payload.append(_number(row["mosi"], line))
        elif payload and row["type"] in ("enable", "disable"):
            yield Select(seconds, ((False, bytes(payload)),))
            payload.clear()
    if payload:
        yield Select(seconds, ((False, bytes(payload)),))


def saleae_analyzer(text: Text, say: Say) -> Iterator[Event]:
    """Read what Saleae's I2C or SPI analyzer itself exports: a line a byte, a packet's number for each message."""
    rows = _Rows(text, "Saleae's export")
    spi = "MOSI" in rows.fields
    if spi:
        say(f"the export does not tell the level of {NO_DC}")
    parsed = [(_seconds(row["Time [s]"], line), line, row) for line, row in rows]
    packets = [list(packet) for _, packet in groupby(parsed, key=lambda entry: entry[2]["Packet ID"])]
    if spi:
        for packet in packets:
            yield Select(packet[-1][0], ((False, bytes(_number(row["MOSI"], line) for _, line, row in packet)),))
        return
    addresses = [_number(packet[0][2]["Address"], packet[0][1]) for packet in packets]
    shift = 1 if max(addresses, default=0) > 0x77 else 0  # addresses with the bit for reading
    for address, packet in zip(addresses, packets, strict=True):
        filled = [(line, row) for _, line, row in packet if row["Data"]]
        payload = bytes(_number(row["Data"], line) for line, row in filled)
        read = packet[0][2]["Read/Write"].lower() == "read"
        if not read and any(row["ACK/NAK"].upper() == "NAK" for _, row in filled):
            say("the chip did not acknowledge every byte of what was written")
        acknowledged = bool(payload) or packet[0][2]["ACK/NAK"].upper() != "NAK"
        yield Call(packet[-1][0], (Message(address >> shift & 0x7F, payload, read, acknowledged),))


# -- sigrok's annotations

ANNOTATION: Final = re.compile(
    r"^(?:(\d+)-(\d+)\s+)?\"?(?:.*: )?\"?"
    r"(Start repeat|Start|Stop|ACK|NACK|(?:Address|Data) (?:read|write): [0-9A-Fa-f]{2}|Read|Write|[01]|Warning.*)\"?$"
)


def sigrok_annotations(text: Text, rate: float | None, say: Say) -> Iterator[Event]:
    """Read annotations of sigrok's I2C decoder."""
    messages, pending, timed = _Messages(say), None, None
    for number, line in text:
        if not line:
            continue
        found = ANNOTATION.match(line)
        if not found:
            raise ValueError(f"line {number} is no annotation of sigrok's I2C decoder: {line[:40]!r}")
        what, end = found[3], found[2]
        if timed is None and not (timed := bool(end and rate)):
            say("the annotations do not tell the samplerate, so times are not true; say it with --rate")
        seconds = int(end) / (rate or 1e6) if end else messages.seconds + 1e-3
        if what in ("ACK", "NACK"):
            if pending is not None:
                _hand_over(messages, *pending, what == "ACK")
            pending = None
        elif what in ("Start", "Start repeat"):
            messages.start()
        elif what == "Stop":
            yield from messages.stop(seconds)
        elif what.startswith(("Address", "Data")):
            kind, direction, value = what.replace(":", "").split()
            pending = kind, direction == "read", int(value, 16)
    yield from messages.stop(messages.seconds)


def _hand_over(messages: _Messages, kind: str, read: bool, value: int, acknowledged: bool) -> None:
    if kind == "Address":
        messages.address(value, read, acknowledged)
    else:
        messages.byte(value, acknowledged)


# -- the kernel's traces

TRACE: Final = re.compile(
    r"\s(\d+\.\d+):\s+(?:i2c:)?i2c_(write|read|reply|result):\s+i2c-(\d+)\s+"
    r"(?:#(\d+) a=([0-9a-f]+) f=[0-9a-f]+ l=(\d+)(?: \[([0-9a-f :-]*)\])?|n=(\d+) ret=(-?\d+))\s*$"
)


def kernel_trace(text: Text, bus: int | None, say: Say) -> Iterator[Event]:
    """Read the kernel's tracepoints of I2C, from ``trace`` or ``trace_pipe``, perf or trace-cmd."""
    waiting: dict[str, dict[int, Message]] = {}
    adapters: set[str] = set()
    for number, line in text:
        found = TRACE.search(line)
        if not found:
            if re.search(r"\bi2c_(write|read|reply|result): ", line):
                raise ValueError(f"line {number} is cut off, or no I2C trace: {line[:60]!r}")
            continue
        seconds, event, adapter, at, address, length, shown, count, result = found.groups()
        if bus is not None and int(adapter) != bus:
            continue
        adapters.add(adapter)
        if len(adapters) > 1:
            raise ValueError(f"the trace is of buses {', '.join(sorted(adapters))}; say which with --bus")
        messages = waiting.setdefault(adapter, {})
        if event == "result":
            yield from _call(float(seconds), messages, int(count), int(result), say)
            messages.clear()
        elif event != "read" or int(at) not in messages:
            payload = bytes.fromhex(re.sub("[^0-9a-f]", "", shown or ""))
            messages[int(at)] = _traced(int(address, 16), payload, int(length), event, say)
    if any(waiting.values()):
        say("the trace ends within a call, which is left out")


def _traced(address: int, payload: bytes, length: int, event: str, say: Say) -> Message:
    """One message; what the kernel's text leaves out of it is zeros."""
    if event == "read":
        return Message(address & 0x7F, bytes(length), True)
    if missing := length - len(payload):
        say(f"the kernel's text shows {_SHOWN} bytes of a message at the most; zeros stand for the others")
        payload += bytes(missing)
    return Message(address & 0x7F, payload, event == "reply")


def _call(seconds: float, messages: Mapping[int, Message], count: int, result: int, say: Say) -> Iterator[Call]:
    """A call as far as it got: the kernel tells how many messages, or an error."""
    done = [messages[number] for number in sorted(messages)]
    if len(done) < count:
        say("the trace begins within a call")
    if result < 0:
        say(f"a call failed with errno {-result}; its messages are left out, though the chip may have got some")
        done = [message._replace(payload=b"", acknowledged=False) for message in done[:1]]
    else:
        done = done[:result]
    if done:
        yield Call(seconds, tuple(done))
