"""Sub-pictures that a device keeps and writes to its panel in turn: what the eye averages to greys."""

from __future__ import annotations

from collections.abc import Iterable

from firmware_protocol.runs import Run, pack_runs, unpack_runs

#: Ticks a second, in which a period is told.
TICKS = 250_000
#: The shortest period: a millisecond.
LEAST_PERIOD = 250
#: Ticks are counted in 16 bits.
MOST_PERIOD = 0xFFFF
#: Most sub-pictures of a cycle.
MOST_TURNS = 0xFF

_LENGTH = 2


def pack_turns(turns: Iterable[Iterable[Run]], room: int, *, repeats: bool = True, apart: bool = False) -> bytes:
    """Return the store's content for the runs of each turn, or no bytes where it would be longer than ``room``.

    Parameters
    ----------
    turns : iterable of iterables of (bool, bytes or memoryview)
        What takes the panel from each sub-picture to the next, and from the last to the first.
    room : int
        Bytes of the store.
    repeats : bool, default True
        Whether the device understands repeats.
    apart : bool, default False
        Whether neighbors of one kind must stay apart, as `pack_runs` has it with ``whole``: there is no content then
        where there are some.

    Examples
    --------
    >>> pack_turns([[(False, b"\\xb0"), (True, b"\\xff")], [(True, b"\\x01")]], 64).hex(" ")
    '03 00 88 b0 ff 02 00 00 01'
    """
    content = bytearray()
    for runs in turns:
        payloads = pack_runs(runs, max(room, 32), repeats=repeats, whole=room if apart else 0)
        if len(payloads) > 1:
            return b""
        tokens = b"".join(payloads)
        content += len(tokens).to_bytes(_LENGTH, "little") + tokens
    return bytes(content) if len(content) <= room else b""


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

    Examples
    --------
    >>> store = Store(64, True)
    >>> store.put(0, pack_turns([[(True, b"\\xff")], [(True, b"\\x01")]], 64))
    >>> store.begin(period=1000, count=2, now=0)
    >>> store.due(999), store.due(1000), store.take(1000), store.within
    (False, True, [(True, b'\\xff')], True)
    """

    def __init__(self, size: int, repeats: bool) -> None:
        self._bytes = bytearray(size)
        self._repeats = repeats
        self._turns: list[list[tuple[bool, bytes]]] = []
        self._turn = self._period = self._began = 0
        self.on = False

    @property
    def within(self) -> bool:
        """Whether the panel shows another sub-picture than the first."""
        return self.on and self._turn > 0

    def put(self, offset: int, content: bytes) -> None:
        """Put bytes into the store; ValueError if they do not fit."""
        if offset + len(content) > len(self._bytes):
            raise ValueError(f"{len(content)} bytes at {offset} are more than the store's {len(self._bytes)}")
        self._bytes[offset : offset + len(content)] = content

    def begin(self, period: int, count: int, now: int) -> None:
        """Begin a cycle at a tick; ValueError if it is too fast or the store does not hold so many sub-pictures."""
        if period < LEAST_PERIOD:
            raise ValueError(f"period must be at least {LEAST_PERIOD} ticks, not {period}")
        at, turns = 0, []
        for _ in range(count):
            start = at + _LENGTH
            at = start + int.from_bytes(self._bytes[at:start], "little")
            if at > len(self._bytes) or start > len(self._bytes):
                raise ValueError("a sub-picture is cut off")
            turns.append(unpack_runs(bytes(self._bytes[start:at]), repeats=self._repeats))
        self._turns, self._turn, self._period, self._began, self.on = turns, 0, period, now, True

    def due(self, now: int) -> bool:
        """Whether the next sub-picture is due."""
        return self.on and now - self._began & 0xFFFF >= self._period

    def take(self, now: int) -> list[tuple[bool, bytes]]:
        """Return the runs of the next sub-picture, and go on."""
        self._began = self._began + self._period & 0xFFFF
        if now - self._began & 0xFFFF >= self._period:  # too late for the next one to be in time
            self._began = now
        runs = self._turns[self._turn]
        self._turn = (self._turn + 1) % len(self._turns)
        return runs
