"""What a wire carried, as events; and the text form in which it is kept, a line a message.

I2C, ``seconds address w/r ack/nak payload``::

    0.000185000 3c w ack 0081cf
    0.000413000 3c w ack 00b0
    + 3c w ack 40ffff
    0.000800000 3c r ack 43

The time is that of the STOP, and ``+`` in its place joins a message to the one before by a repeated START. ``nak`` with
a payload broke off behind it; without one, nobody answered at the address.

SPI, ``seconds`` and what was sent in one chip select: ``c`` with the D/C line low (and where there is none), ``d`` with
it high, ``x`` where no chip listened; ``-`` at the end where the chip select stays. A reset pulse is a line too::

    0.000001000 reset
    0.000011000 caf
    0.000152000 cb00010 dffff

Lines that begin with ``#`` say nothing. Files whose names end in ``.gz`` are compressed.
"""

from __future__ import annotations

import gzip
import os
import re
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Final, NamedTuple, TextIO

if TYPE_CHECKING:
    from .wire import Wire


class Message(NamedTuple):
    """A message on an I2C bus: what was written or read, as far as it got."""

    address: int
    payload: bytes
    read: bool = False
    acknowledged: bool = True


class Call(NamedTuple):
    """A call of an I2C bus: messages from START to STOP, and when it was over."""

    seconds: float
    messages: tuple[Message, ...]


class Select(NamedTuple):
    """A chip select on SPI: bytes with the D/C line high (True) or low (None where no chip listened), and its end."""

    seconds: float
    runs: tuple[tuple[bool | None, bytes], ...]
    ends: bool = True


class Reset(NamedTuple):
    """A pulse on the reset line."""

    seconds: float


Event = Call | Select | Reset

_LETTERS: Final = {True: "d", False: "c", None: "x"}
_LEVELS: Final = {letter: level for level, letter in _LETTERS.items()}
_I2C: Final = re.compile(r"(\+|\d+\.\d+) ([0-9a-f]{2}) ([wr]) (ack|nak) ?((?:[0-9a-f]{2})*)$")
_SPI: Final = re.compile(r"(\d+\.\d+)((?: [cdx](?:[0-9a-f]{2})+)*)( -)?$")
_RESET: Final = re.compile(r"(\d+\.\d+) reset$")


def is_line(text: str) -> bool:
    """Tell whether this is a line of a log."""
    return any(form.match(text) for form in (_I2C, _SPI, _RESET))


class Log:
    """Writes what a simulated bus carries to a file, which `replay` and ``paneldraw replay`` read.

    Parameters
    ----------
    bus : I2CBus or SPIBus
        A bus that has no other log.
    path : str or path-like
        The file; it is overwritten. Compressed if its name ends in ``.gz``.

    Raises
    ------
    OSError
        Where the file cannot be written.
    ValueError
        If the bus has a log already.

    Notes
    -----
    What does not cross the wire is not in it: a chip that loses its power, say.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306()}, timer=None)
    >>> with Log(bus, "panel.log"):
    ...     bus.write_i2c_block_data(0x3C, 0x00, [0x81, 0xCF])
    >>> print(open("panel.log").read())
    # seconds address w/r ack/nak payload
    0.000095000 3c w ack 0081cf
    <BLANKLINE>
    """

    def __init__(self, bus: Wire, path: str | os.PathLike[str]) -> None:
        if bus.log is not None:
            raise ValueError("bus: it has a log already; close that first")
        self._file: TextIO = _opened(path)
        self._file.write(f"# {bus.log_form}\n")
        self._bus = bus
        bus.log = self

    def write(self, event: Event) -> None:
        """Write an event down."""
        for line in lines(event):
            self._file.write(f"{line}\n")

    def close(self) -> None:
        """Leave the bus and close the file."""
        if self._bus.log is self:
            self._bus.log = None
        self._file.close()

    def __enter__(self) -> Log:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


def _opened(path: str | os.PathLike[str]) -> TextIO:
    if os.fspath(path).lower().endswith(".gz"):
        return gzip.open(path, "wt", encoding="ascii", newline="\n")
    return open(path, "w", encoding="ascii", newline="\n")


def lines(event: Event) -> Iterator[str]:
    """An event in the text form."""
    if isinstance(event, Call):
        for number, (address, payload, read, acknowledged) in enumerate(event.messages):
            when = "+" if number else f"{event.seconds:.9f}"
            line = f"{when} {address:02x} {'r' if read else 'w'} {'ack' if acknowledged else 'nak'} {payload.hex()}"
            yield line.rstrip()
    elif isinstance(event, Select):
        runs = (f"{_LETTERS[data]}{run.hex()}" for data, run in event.runs)
        yield " ".join([f"{event.seconds:.9f}", *runs, *([] if event.ends else ["-"])])
    else:
        yield f"{event.seconds:.9f} reset"


def read(text: Iterable[tuple[int, str]]) -> Iterator[Event]:
    """Read the text form: numbered lines, as events.

    Raises
    ------
    ValueError
        For a line of another form.
    """
    seconds, messages = 0.0, list[Message]()
    for number, line in text:
        if not line or line.startswith("#"):
            continue
        joined = False
        event: Event | None = None
        if found := _I2C.match(line):
            when, address, direction, acknowledge, payload = found.groups()
            joined = when == "+"
            message = Message(int(address, 16), bytes.fromhex(payload or ""), direction == "r", acknowledge == "ack")
        elif found := _SPI.match(line):
            event = Select(float(found[1]), tuple(_runs(found[2])), not found[3])
        elif found := _RESET.match(line):
            event = Reset(float(found[1]))
        else:
            raise ValueError(f"line {number} is none of a log: {line[:40]!r}")
        if messages and not joined:
            yield Call(seconds, tuple(messages))
            messages.clear()
        if event is not None:
            yield event
        else:
            seconds = seconds if joined else float(when)
            messages.append(message)
    if messages:
        yield Call(seconds, tuple(messages))


def _runs(text: str) -> Iterator[tuple[bool | None, bytes]]:
    for run in text.split():
        yield _LEVELS[run[0]], bytes.fromhex(run[1:])
