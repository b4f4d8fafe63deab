"""Recordings of a wire, ours and others', played to a simulated chip."""

from __future__ import annotations

import gzip
import itertools
import os
import zlib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import IO, Any, Final, NamedTuple

from . import edges, log, recordings
from .chip import Chip
from .log import Call, Event, Reset, Select

_LONGEST_LINE: Final = 1 << 20
_MOST_TEXT: Final = 1 << 30
_SNIFFED: Final = 200
"""So many lines of a text are looked at for what it is."""
_MOST_EVENTS: Final = 5_000_000
FORMS: Final = (
    "paneldraw's logs, sigrok sessions (.sr) and CSV, annotations of sigrok's I2C decoder, Saleae's CSV exports, "
    "the kernel's I2C traces"
)
"""What can be read."""


class Replayed(NamedTuple):
    """What a recording was.

    Attributes
    ----------
    form : str
        What wrote it, in words.
    events : int
        Calls of the bus or chip selects.
    address : int or None
        The address of the chip, on I2C.
    remarks : list of str
        What was odd about the recording itself, and how often.
    """

    form: str
    events: int
    address: int | None
    remarks: list[str]


def replay(
    path: str | os.PathLike[str],
    chip: Chip,
    *,
    address: int | None = None,
    usual: int | None = None,
    mux: tuple[int, int] | None = None,
    bus: int | None = None,
    rate: float | None = None,
    lines: Mapping[str, str] | None = None,
) -> Replayed:
    """Play a recording of a wire to a simulated chip, in the recording's own time.

    Parameters
    ----------
    path : str or path-like
        A `Log`, or what others recorded: a sigrok session (``.sr``), sigrok's or Saleae's CSV, annotations of sigrok's
        I2C decoder, the kernel's I2C traces. The file's content says which; text may be compressed by gzip.
    chip : Chip
        The chip; its frames, violations and remarks tell what came of it.
    address : int, optional
        The chip's address on I2C. Default: `usual`, if a chip answered there, or else the only one at which one did.
    usual : int, optional
        The address that chips of the kind have.
    mux : (int, int), optional
        Address of the multiplexer before the chip, and the channel.
    bus : int, optional
        The bus of a kernel's trace that is of several.
    rate : float, optional
        Samples a second of annotations, and of a session, that do not tell them.
    lines : mapping of str to str, optional
        Which channel of a logic analyzer, by its name or its number from 0, is ``scl``, ``sda``, ``clk``, ``mosi``,
        ``cs``, ``dc`` or ``reset``. Default: found by their names.

    Raises
    ------
    ValueError
        For a file that is damaged, or none of these, or where it is not clear which address or channel is meant.
    OSError
        For a file that cannot be read.

    Examples
    --------
    >>> from pathlib import Path
    >>> from paneldraw import simulator
    >>> written = Path("on.log").write_text("0.000100 3c w ack 008d14a5af")
    >>> chip = simulator.SSD1306()
    >>> replay("on.log", chip).events, int(chip.pixels.sum())
    (1, 8192)
    """
    said: Counter[str] = Counter()

    def say(text: str) -> None:
        if chip.has_dc or edges.NO_DC not in text:
            said[text] += 1

    settings = _Settings(bus, rate, lines or {}, getattr(chip, "cs_high", False), say)
    try:
        with open(path, "rb") as file:
            form, found = _recognized(file, settings)
            events = list(itertools.islice(found, _MOST_EVENTS + 1))
        if len(events) > _MOST_EVENTS:
            raise ValueError(f"there are more than {_MOST_EVENTS} messages; cut the recording down")
        where = _where(events, chip, address, usual)
    except (ValueError, EOFError, zlib.error, gzip.BadGzipFile) as error:
        raise ValueError(f"{os.fspath(path)}: {error}") from None
    _play(events, chip, where, mux)
    return Replayed(
        form, len(events), where, [text if times == 1 else f"{text} ({times} times)" for text, times in said.items()]
    )


class _Settings(NamedTuple):
    bus: int | None
    rate: float | None
    lines: Mapping[str, str]
    cs_high: bool
    say: Callable[[str], object]


# -- Which form a file has


def _recognized(file: IO[bytes], settings: _Settings) -> tuple[str, Iterator[Event]]:
    """The form of a file, in words, and its events."""
    magic = file.read(4)
    file.seek(0)
    if magic[:2] == b"PK":
        samples = recordings.session(file, settings.rate)
        return "a sigrok session", edges.decode(samples, settings.lines, settings.say, cs_high=settings.cs_high)
    text = _numbered(gzip.GzipFile(fileobj=file) if magic[:2] == b"\x1f\x8b" else file)  # type: ignore[arg-type]
    beginning = list(itertools.islice(text, _SNIFFED))
    whole = itertools.chain(beginning, text)
    for form, fits, read in _READERS:
        if fits([line for _, line in beginning if line]):
            return form, read(whole, settings)
    raise ValueError(f"this is none of what can be read: {FORMS}")


def _numbered(file: IO[bytes]) -> Iterator[tuple[int, str]]:
    """Lines and their numbers, from 1 on."""
    total = 0
    for number in itertools.count(1):
        line = file.readline(_LONGEST_LINE)
        if not line:
            return
        total += len(line)
        if len(line) == _LONGEST_LINE or total > _MOST_TEXT:
            raise ValueError(f"line {number} is too long, or the file too large, for a recording")
        yield number, line.decode("utf-8-sig" if number == 1 else "utf-8", "replace").rstrip("\r\n")


Beginning = list[str]
Text = Iterable[tuple[int, str]]


def _is_log(beginning: Beginning) -> bool:
    said = [line for line in beginning if not line.startswith("#")]
    return bool(said) and log.is_line(said[0])


def _is_analyzer(beginning: Beginning) -> bool:
    return bool(beginning) and beginning[0].startswith("Time") and "Packet ID" in beginning[0]


def _is_digital(beginning: Beginning) -> bool:
    return bool(beginning) and beginning[0].replace(" ", "").lower().startswith("time[s],")


def _samples(read: Callable[[Text], edges.Samples]) -> Callable[[Text, _Settings], Iterator[Event]]:
    def events(text: Text, settings: _Settings) -> Iterator[Event]:
        return edges.decode(read(text), settings.lines, settings.say, cs_high=settings.cs_high)

    return events


_READERS: Final[tuple[tuple[str, Callable[[Beginning], bool], Callable[[Text, _Settings], Iterator[Event]]], ...]] = (
    ("a log", _is_log, lambda text, settings: log.read(text)),
    (
        "a table of Saleae's Logic",
        lambda lines: bool(lines) and lines[0].startswith("name,type,start_time"),
        lambda text, settings: recordings.saleae_table(text, settings.say),
    ),
    (
        "an export of Saleae's analyzer",
        _is_analyzer,
        lambda text, settings: recordings.saleae_analyzer(text, settings.say),
    ),
    ("digital channels of Saleae's Logic", _is_digital, _samples(recordings.saleae_digital)),
    (
        "sigrok's CSV",
        lambda lines: any(line.startswith((";", "#")) and "libsigrok" in line for line in lines[:3]),
        _samples(recordings.sigrok_csv),
    ),
    (
        "a trace of the kernel's",
        lambda lines: any(recordings.TRACE.search(line) for line in lines),
        lambda text, settings: recordings.kernel_trace(text, settings.bus, settings.say),
    ),
    (
        "annotations of sigrok's",
        lambda lines: bool(lines) and all(recordings.ANNOTATION.match(line) for line in lines[:5]),
        lambda text, settings: recordings.sigrok_annotations(text, settings.rate, settings.say),
    ),
)


# -- Playing


def _where(events: list[Event], chip: Chip, address: int | None, usual: int | None) -> int | None:
    """The chip's address on I2C, None on SPI."""
    kind = "i2c" if any(isinstance(event, Call) for event in events) else "spi"
    if not events:
        raise ValueError("there is no message in it")
    if kind not in chip.buses:
        buses = " or ".join(map(str.upper, chip.buses))
        raise ValueError(f"this is a recording of {kind.upper()}, and {type(chip).__name__}s sit on {buses}")
    if kind == "spi":
        return None
    messages = (message for event in events if isinstance(event, Call) for message in event.messages)
    written = Counter(m.address for m in messages if m.payload and m.acknowledged and not m.read)
    if usual in written and address is None:
        return usual
    if address in written:
        return address
    if address is not None:
        there = ", ".join(f"{where:#04x}" for where in sorted(written)) or "none"
        raise ValueError(f"nothing was written to a chip at {address:#04x}; chips answered at: {there}")
    if len(written) == 1:
        return next(iter(written))
    if not written:
        raise ValueError("no chip acknowledged anything that was written")
    there = ", ".join(f"{where:#04x} ({count} messages)" for where, count in sorted(written.items()))
    raise ValueError(f"there are messages to several addresses; say which is the panel's: {there}")


def _play(events: Iterable[Event], chip: Chip, address: int | None, mux: tuple[int, int] | None) -> None:
    """Give the chip what is meant for it."""
    doors: dict[int | None, Any] = {address: chip}
    if address is not None and hasattr(chip, "data"):
        doors[address + 1] = chip.data
    connected = mux is None
    for event in events:
        chip.wait(event.seconds)
        if isinstance(event, Reset):
            chip.reset()
            chip.settle(event.seconds, 0)
        elif isinstance(event, Select):
            _select(event, chip)
        else:
            heard = _call(event, doors) if connected else 0
            if heard:
                chip.settle(event.seconds, heard)
            for message in event.messages:
                if mux and message.address == mux[0] and message.payload and not message.read:
                    connected = bool(message.payload[-1] >> mux[1] & 1)


def _select(event: Select, chip: Chip) -> None:
    for data, run in event.runs:
        if data is not None:
            chip.transfer(run, data)
    if event.ends:
        chip.deselect()
    if event.runs:
        chip.settle(event.seconds, sum(len(run) for _, run in event.runs))


def _call(event: Call, doors: Mapping[int | None, Any]) -> int:
    """Hand messages over; return how many bytes that was on the wire."""
    heard = 0
    for message in event.messages:
        device = doors.get(message.address)
        if device is None:
            continue
        heard += 1 + len(message.payload)
        if message.read:
            device.read(len(message.payload))
        elif message.payload:
            device.write(message.payload)
            heard += not message.acknowledged
    return heard
