"""Sub-pictures that a device keeps and writes to its panel in turn: what the eye averages to greys.

The store begins with how long each sub-picture lasts, two bytes each, in ticks. Then come tokens as a WRITE has
them, in which each part of data stands once for each sub-picture.
"""

from __future__ import annotations

from collections.abc import Sequence

from firmware_protocol.runs import COMMAND_HEADER, MAX_COMMANDS, MAX_LITERAL, MAX_TRAILING, Run, unpack_runs

#: Ticks a second, in which times are told.
TICKS = 250_000
#: The shortest time that a sub-picture may last: a millisecond.
LEAST_TICKS = 250
#: Ticks are counted in 16 bits.
MOST_TICKS = 0xFFFF

_TICKS_SIZE = 2


def pack_cycle(pictures: Sequence[Sequence[Run]], seconds: Sequence[float]) -> bytes:
    """Return what a store must hold for a cycle.

    Parameters
    ----------
    pictures : sequence of sequences of (bool, bytes or memoryview)
        The runs that bring each sub-picture onto the panel, whatever other it showed before: in all of them the same
        commands, and data of the same sizes.
    seconds : sequence of float
        How long each sub-picture lasts, 0.001 to 0.262.

    Raises
    ------
    ValueError
        The runs differ in more than their data, or a time that cannot be.

    Examples
    --------
    >>> pictures = [[(False, b"\\xb0"), (True, bytes((byte,)))] for byte in (0x0F, 0xFF)]
    >>> pack_cycle(pictures, (0.002, 0.004)).hex(" ")
    'f4 01 e8 03 88 b0 0f ff'
    """
    ticks = [round(each * TICKS) for each in seconds]
    if len(ticks) != len(pictures) or not all(LEAST_TICKS <= each <= MOST_TICKS for each in ticks):
        raise ValueError(f"seconds must be {len(pictures)} of 0.001 to 0.262, not {seconds}")
    content = bytearray().join(each.to_bytes(_TICKS_SIZE, "little") for each in ticks)
    open_token: int | None = None
    for runs in zip(*pictures, strict=True):
        kinds, parts = zip(*runs, strict=True)
        if len(set(kinds)) > 1 or len(set(map(len, parts))) > 1 or (not kinds[0] and len(set(map(bytes, parts))) > 1):
            raise ValueError("pictures must be the same runs but for their data")
        if kinds[0]:
            _add_data(content, parts, open_token)
            open_token = None
        else:
            open_token = _add_commands(content, parts[0])
    return bytes(content)


def _add_commands(content: bytearray, commands: bytes | memoryview) -> int | None:
    """Add tokens of commands; return where the last begins."""
    opened = None
    for at in range(0, len(commands), MAX_COMMANDS):
        opened, part = len(content), commands[at : at + MAX_COMMANDS]
        content.append(COMMAND_HEADER + len(part) - 1)
        content += part
    return opened


def _add_data(content: bytearray, copies: Sequence[bytes | memoryview], opened: int | None) -> None:
    """Add data, and the first bytes of it to a token of commands that is open."""
    at = 0
    if opened is not None:
        at = min(MAX_TRAILING, len(copies[0]))
        content[opened] += at << 3
        content += b"".join(copy[:at] for copy in copies)
    for start in range(at, len(copies[0]), MAX_LITERAL):
        parts = [copy[start : start + MAX_LITERAL] for copy in copies]
        content.append(len(parts[0]) - 1)
        content += b"".join(parts)


class Store:
    """The store of a device, and the cycle that is written from it.

    Parameters
    ----------
    size : int
        Bytes.
    repeats : bool
        Whether tokens may be repeats.

    Attributes
    ----------
    on : bool
        Whether a cycle goes on.
    shown : int
        The number of the sub-picture on the panel; 0 when there is no cycle.

    Examples
    --------
    >>> store = Store(64, True)
    >>> pictures = [[(False, b"\\xb0"), (True, bytes((byte,)))] for byte in (0x0F, 0xFF)]
    >>> content = pack_cycle(pictures, (0.002, 0.004))
    >>> store.put(0, content)
    >>> store.begin(len(content), 2, now=0)
    >>> store.due(499), store.due(500), store.take(500), store.shown
    (False, True, [(False, b'\\xb0'), (True, b'\\xff')], 1)
    """

    def __init__(self, size: int, repeats: bool) -> None:
        self._bytes = bytearray(size)
        self._repeats = repeats
        self._pictures: list[list[tuple[bool, bytes]]] = []
        self._ticks: list[int] = []
        self._began = self.shown = 0
        self.on = False

    def put(self, offset: int, content: bytes) -> None:
        """Put bytes into the store; ValueError if they do not fit."""
        if offset + len(content) > len(self._bytes):
            raise ValueError(f"{len(content)} bytes at {offset} are more than the store's {len(self._bytes)}")
        self._bytes[offset : offset + len(content)] = content

    def begin(self, length: int, count: int, now: int) -> None:
        """Begin a cycle at a tick, with the first sub-picture on the panel; ValueError if the store holds none such."""
        head = count * _TICKS_SIZE
        if not head <= length <= len(self._bytes):
            raise ValueError(f"length must be {head} to {len(self._bytes)} bytes, not {length}")
        ticks = [int.from_bytes(self._bytes[at : at + _TICKS_SIZE], "little") for at in range(0, head, _TICKS_SIZE)]
        if min(ticks) < LEAST_TICKS:
            raise ValueError(f"a sub-picture must last {LEAST_TICKS} ticks or more, not {min(ticks)}")
        tokens = bytes(self._bytes[head:length])
        self._pictures = [unpack_runs(tokens, repeats=self._repeats, copies=count, copy=copy) for copy in range(count)]
        self._ticks, self._began, self.shown, self.on = ticks, now, 0, True

    def due(self, now: int) -> bool:
        """Whether the next sub-picture is due."""
        return self.on and now - self._began & 0xFFFF >= self._ticks[self.shown]

    def take(self, now: int, *, first: bool = False) -> list[tuple[bool, bytes]]:
        """Go on to the next sub-picture, or to the first; return its runs."""
        self._began = self._began + self._ticks[self.shown] & 0xFFFF
        self.shown = 0 if first else (self.shown + 1) % len(self._pictures)
        if now - self._began & 0xFFFF >= self._ticks[self.shown]:  # too late for the next one to be in time
            self._began = now
        return self._pictures[self.shown]

    def end(self) -> None:
        """End the cycle."""
        self.on, self.shown = False, 0
