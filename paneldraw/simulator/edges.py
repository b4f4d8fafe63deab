"""I2C and SPI out of what a logic analyzer sampled: the lines' edges become calls and chip selects.

The rules are those of the buses. I2C (NXP's UM10204, section 3.1): SDA that falls while SCL is high is a START, one
that rises a STOP; bits are taken as SCL rises, eight and an acknowledge. SPI: bits are taken as the clock rises while
the chip select is active, as modes 0 and 3 have it, which all panels use.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .log import Call, Event, Message, Reset, Select

Bits = NDArray[np.bool_]
Say = Callable[[str], object]
"""Takes what is to be said of a recording; the same text may come often."""

NAMES: Final[Mapping[str, tuple[str, ...]]] = {
    "scl": ("scl", "scl/d0", "i2c_scl"),
    "sda": ("sda", "sda/d1", "i2c_sda"),
    "clk": ("clk", "sck", "sclk", "clock", "d0", "spi_clk"),
    "mosi": ("mosi", "din", "sdi", "copi", "sda", "d1", "spi_mosi"),
    "cs": ("cs", "ss", "ce", "ce0", "ce1", "ncs", "cs#", "/cs", "csn", "spi_cs", "enable", "load"),
    "dc": ("dc", "d/c", "d/c#", "dc#", "a0", "rs", "cd", "d-c"),
    "reset": ("reset", "rst", "res", "reset#", "res#", "nrst", "/reset", "/res"),
}
"""What people call the lines."""
NO_DC: Final = "D/C: all bytes are taken for commands"
"""How everything ends that is said of recordings without the D/C line."""
_SHORTEST_PAUSE: Final = 20
"""Without a chip select, so many clock periods at rest part what was sent."""


class Samples(NamedTuple):
    """What was sampled, where anything changed.

    Attributes
    ----------
    channels : sequence of str
        The channels' names.
    seconds : float64 array
        When.
    levels : bool array, shape (times, channels)
        What each channel is from then on.
    """

    channels: Sequence[str]
    seconds: NDArray[np.float64]
    levels: Bits


def decode(samples: Samples, lines: Mapping[str, str], say: Say, *, cs_high: bool = False) -> Iterator[Event]:
    """Find the events of a bus.

    Parameters
    ----------
    samples : Samples
    lines : mapping of str to str
        Which channel, by its name or its number from 0, is which of `NAMES`; the others are found by their names.
    say : callable
        Takes what was odd.
    cs_high : bool
        Whether the chip listens while its chip select is high. Default: False.

    Raises
    ------
    ValueError
        For a channel that does not exist, or where it is not clear which one is which.
    """
    found = _channels(samples, lines, say)
    wires = {line: samples.levels[:, channel] for line, channel in found.items()}
    if "scl" in wires:
        return _i2c(samples.seconds, wires["scl"], wires["sda"], say)
    return _spi(samples.seconds, wires, say, cs_high)


def _channels(samples: Samples, lines: Mapping[str, str], say: Say) -> dict[str, int]:
    """Which channel is which line."""
    names = [name.strip().lower() for name in samples.channels]
    found = {line: _channel(names, line, wanted) for line, wanted in lines.items()}
    wanted = set(lines)
    kind = ("scl", "sda") if wanted & {"scl", "sda"} else ("clk", "mosi", "cs", "dc", "reset")
    if not wanted:
        kind = ("scl", "sda") if "scl" in names or (len(names) == 2 and "clk" not in names) else kind
    for line in kind:
        for name in NAMES[line]:
            if line not in found and name in names and names.index(name) not in found.values():
                found[line] = names.index(name)
    if kind[0] == "scl" and len(names) == 2 and not found:
        edges = [int(np.count_nonzero(np.diff(samples.levels[:, channel]))) for channel in range(2)]
        found = {"scl": edges.index(max(edges)), "sda": edges.index(min(edges))}
        say(f"channel {samples.channels[found['scl']]} is taken for SCL, as it has more edges")
    missing = [line for line in kind[:2] if line not in found]
    if missing:
        there = ", ".join(f"{number} {name}" for number, name in enumerate(samples.channels))
        raise ValueError(
            f"which channel is {' and which '.join(line.upper() for line in missing)}? There are {there}; say so with "
            f"--scl and --sda for I2C, or with --clk, --mosi, --cs, --dc and --reset for SPI"
        )
    return found


def _channel(names: Sequence[str], line: str, wanted: str) -> int:
    name = wanted.strip().lower()
    if name in names:
        return names.index(name)
    if name.isdigit() and int(name) < len(names):
        return int(name)
    raise ValueError(f"--{line}: there is no channel {wanted!r}; there are {', '.join(names)}, from 0 on")


# -- I2C


def _i2c(seconds: NDArray[np.float64], scl: Bits, sda: Bits, say: Say) -> Iterator[Event]:
    """Calls from START to STOP."""
    steady = scl[1:] & scl[:-1]
    starts = np.flatnonzero(steady & sda[:-1] & ~sda[1:]) + 1
    stops = np.flatnonzero(steady & ~sda[:-1] & sda[1:]) + 1
    clocks = np.flatnonzero(scl[1:] & ~scl[:-1]) + 1
    marks = np.sort(np.concatenate((starts, stops)))
    is_start = np.isin(marks, starts)
    bounds = np.searchsorted(clocks, marks)
    bits = sda[clocks]
    messages: list[Message] = []
    for number, mark in enumerate(marks):
        if is_start[number]:
            end = bounds[number + 1] if number + 1 < len(marks) else len(bits)
            message = _message(bits[bounds[number] : end], say)
            if message is not None:
                messages.append(message)
        elif messages:
            yield Call(float(seconds[mark]), tuple(messages))
            messages = []
    if messages:
        say("the recording ends before the last STOP")
        yield Call(float(seconds[-1]), tuple(messages))


def _message(bits: Bits, say: Say) -> Message | None:
    """One message out of the bits behind its START; a clock edge more belongs to what follows it."""
    count = len(bits) // 9
    if len(bits) % 9 > 1:
        say("a message breaks off within a byte")
    if not count:
        return None
    rows = bits[: 9 * count].reshape(count, 9)
    values, naks = np.packbits(rows[:, :8], axis=1)[:, 0].tobytes(), rows[:, 8]
    read = bool(values[0] & 1)
    if naks[0]:
        return Message(values[0] >> 1, b"", read, False)
    if not read and naks[1:].any():
        say("the chip did not acknowledge every byte of what was written")
    return Message(values[0] >> 1, values[1:], read, True)


# -- SPI


def _spi(seconds: NDArray[np.float64], wires: Mapping[str, Bits], say: Say, cs_high: bool) -> Iterator[Event]:
    """Chip selects and resets, in order."""
    if "dc" not in wires:
        say(f"no channel is {NO_DC}")
    rising = np.flatnonzero(wires["clk"][1:] & ~wires["clk"][:-1]) + 1
    if "cs" in wires:
        selected = wires["cs"] == cs_high
        rising = rising[selected[rising]]
        ends = np.flatnonzero(selected[:-1] & ~selected[1:]) + 1
        ends = np.append(ends, len(seconds) - 1)
    else:
        say("no channel is CS: bytes are counted from pauses of the clock on")
        ends = _pauses(seconds, rising)
    events: list[tuple[int, Event]] = []
    if "reset" in wires:
        reset = wires["reset"]
        events += [(int(at), Reset(float(seconds[at]))) for at in np.flatnonzero(~reset[1:] & reset[:-1]) + 1]
    first = 0
    for end, last in zip(ends, np.searchsorted(rising, ends), strict=True):
        if last > first:
            select = _select(float(seconds[end]), rising[first:last], wires, say)
            if select is not None:
                events.append((int(end), select))
        first = last
    events.sort(key=lambda pair: pair[0])
    yield from (event for _, event in events)


def _pauses(seconds: NDArray[np.float64], rising: NDArray[np.intp]) -> NDArray[np.intp]:
    """Where the clock rests: ends of what was sent together."""
    if len(rising) < 2:
        return np.array([len(seconds) - 1])
    gaps = np.diff(seconds[rising])
    rests = np.flatnonzero(gaps > _SHORTEST_PAUSE * np.median(gaps))
    return np.append(rising[rests] + 1, len(seconds) - 1)


def _select(seconds: float, clocks: NDArray[np.intp], wires: Mapping[str, Bits], say: Say) -> Select | None:
    """What was sent in one chip select."""
    count = len(clocks) // 8
    if len(clocks) % 8:
        say("a chip select ends within a byte")
    if not count:
        return None
    clocks = clocks[: 8 * count].reshape(count, 8)
    payload = np.packbits(wires["mosi"][clocks], axis=1)[:, 0].tobytes()
    if "dc" not in wires:
        return Select(seconds, ((False, payload),))
    data = wires["dc"][clocks[:, 7]]
    cuts = [0, *(np.flatnonzero(np.diff(data)) + 1).tolist(), count]
    return Select(seconds, tuple((bool(data[cut]), payload[cut:end]) for cut, end in itertools.pairwise(cuts)))
