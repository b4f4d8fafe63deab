"""What a WRITE carries: runs of command and data bytes for the panel, as a stream of tokens.

The tokens are PackBits (a header below 80 opens a literal, one from C0 a repeat) in which the headers 80 to BF, the
longest repeats, are given to commands and the few data bytes that often follow them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

MAX_LITERAL = 128
MAX_COMMANDS = 8
#: Data bytes that a token of commands can hold besides.
MAX_TRAILING = 7
MAX_REPEAT = 65
COMMAND_HEADER = 0x80
REPEAT_HEADER = 0xC0
#: Bytes that the panel's bus carries for a run besides its own: the address and the control byte.
RUN_ENVELOPE = 2
#: With a lower payload limit frames would be envelopes for the most part.
LEAST_PAYLOAD = 32

# A repeat inside a literal costs its two bytes and the header of the literal after it: three equal bytes are never
# cheaper in a literal. Two are, unless there is nothing but pairs and the literal falls away.
_REPEATS = re.compile(rb"(.)\1{2,%d}" % (MAX_REPEAT - 1), re.DOTALL)
_PAIRS = re.compile(rb"(?:(.)\1)+", re.DOTALL)

#: Whether the bytes are data (True) or commands (False), and the bytes.
Run = tuple[bool, bytes | memoryview]


def pack_runs(runs: Iterable[Run], limit: int, *, repeats: bool = True, whole: int = 0) -> list[bytes]:
    """Turn runs into WRITE payloads, as few as there can be.

    Parameters
    ----------
    runs : iterable of (bool, bytes or memoryview)
        Whether the bytes are data (True) or commands (False), and the bytes. Commands of one run are kept in one
        payload where they fit into one.
    limit : int
        Most bytes a payload may have, at least 32.
    repeats : bool, default True
        Whether the device understands repeats.
    whole : int, default 0
        For a bus on which a run is a chip select, the longest payload of all: a run that fits into one is not cut, be
        it above `limit`, and neighbors of one kind stand in two. Default: runs may be cut and joined.

    Returns
    -------
    list of bytes
        Payloads, none of them empty.

    Examples
    --------
    >>> [p.hex(" ") for p in pack_runs([(False, b"\\xb0\\x02\\x10"), (True, bytes(40))], 64)]
    ['82 b0 02 10 d9 00']
    >>> [p.hex(" ") for p in pack_runs([(False, b"\\xb0\\x02\\x10"), (True, b"\\x01\\x02")], 64)]
    ['92 b0 02 10 01 02']
    >>> [p.hex(" ") for p in pack_runs([(True, b"\\x01\\x80"), (True, b"\\x02\\x40")], 64, whole=64)]
    ['01 01 80', '01 02 40']
    """
    if limit < LEAST_PAYLOAD:
        raise ValueError(f"limit must be at least {LEAST_PAYLOAD} bytes, not {limit}")
    packer = _Packer(limit, repeats)
    for is_data, content in runs:
        if whole:
            packer.apart(is_data, content, whole)
        else:
            packer.add(is_data, content)
    return packer.finish()


def unpack_runs(payload: bytes, *, repeats: bool = True, copies: int = 1, copy: int = 0) -> list[tuple[bool, bytes]]:
    """Return the runs of a WRITE payload, neighbors of one kind joined, as they go onto the panel's bus.

    In a store, each part of data stands in several copies, of which `copy` is the number of the one that is meant.

    Raises
    ------
    ValueError
        If the payload ends inside a token, or holds a repeat and ``repeats`` is False.

    Examples
    --------
    >>> unpack_runs(bytes.fromhex("82 b0 02 10 00 ff fd 55"))
    [(False, b'\\xb0\\x02\\x10'), (True, b'\\xffUUUU')]
    """
    joined: list[tuple[bool, bytearray]] = []
    for is_data, content in _tokens(payload, repeats, copies, copy):
        if joined and joined[-1][0] == is_data:
            joined[-1][1].extend(content)
        else:
            joined.append((is_data, bytearray(content)))
    return [(is_data, bytes(content)) for is_data, content in joined]


def bus_bytes(runs: Iterable[Run]) -> int:
    """Return how many bytes the panel's bus carries for runs."""
    return sum(RUN_ENVELOPE + len(content) for _, content in runs)


def most_bus_bytes(payload: bytes) -> int:
    """Return how many bytes the panel's bus carries for a payload, were each token a run of its own, or two.

    Examples
    --------
    >>> most_bus_bytes(bytes.fromhex("82 b0 02 10 fd 55"))
    13
    """
    at = written = 0
    while at < len(payload):
        header = payload[at]
        commands, data = _sizes(header)
        at += 1 + commands + data
        written += RUN_ENVELOPE * (2 if header >> 6 == 2 else 1) + commands
        written += 257 - header if header >= REPEAT_HEADER else data
    return written


def cut_runs(runs: Iterable[Run], size: int) -> tuple[list[Run], list[Run]]:
    """Cut runs in two after so many bytes on the panel's bus. Commands stay whole, and with the data after them.

    Examples
    --------
    >>> cut_runs([(False, b"\\xb0"), (True, b"abcdef"), (False, b"\\xb1\\x10"), (True, b"gh")], 9)
    ([(False, b'\\xb0'), (True, b'abcd')], [(True, b'ef'), (False, b'\\xb1\\x10'), (True, b'gh')])
    """
    before: list[Run] = []
    after: list[Run] = []
    for is_data, content in runs:
        size -= RUN_ENVELOPE
        if size <= 0:
            after.append((is_data, content))
        elif is_data and size < len(content):
            before.append((True, content[:size]))
            after.append((True, content[size:]))
        else:
            before.append((is_data, content))
        size -= len(content)
    while before and not before[-1][0]:
        after.insert(0, before.pop())
    return before, after


def _tokens(payload: bytes, repeats: bool, copies: int, copy: int) -> Iterator[tuple[bool, bytes]]:
    at = 0
    while at < len(payload):
        header = payload[at]
        commands, data = _sizes(header)
        start, behind = at + 1, at + 1 + commands
        at = behind + copies * data
        if at > len(payload):
            raise ValueError(f"the payload ends inside the token {header:02x}")
        if header >= REPEAT_HEADER and not repeats:
            raise ValueError(f"the token {header:02x} is a repeat")
        if commands:
            yield False, payload[start:behind]
        if data:
            content = payload[behind + copy * data : behind + (copy + 1) * data]
            yield True, content * (257 - header if header >= REPEAT_HEADER else 1)


def _sizes(header: int) -> tuple[int, int]:
    """How many bytes of commands and of data follow a header."""
    if header >= REPEAT_HEADER:
        return 0, 1
    if header >= COMMAND_HEADER:
        return (header & 7) + 1, header >> 3 & 7
    return 0, header + 1


class _Packer:
    """Fills payloads token by token."""

    def __init__(self, limit: int, repeats: bool) -> None:
        self.limit = limit
        self.repeats = repeats
        self.payload = bytearray()
        self.done: list[bytes] = []
        # Where the token of commands stands that the payload ends with.
        self.open: int | None = None
        # The kind of the run that the payload ends with.
        self.kind: bool | None = None

    def finish(self) -> list[bytes]:
        if self.payload:
            self.done.append(bytes(self.payload))
            self.payload.clear()
            self.open = self.kind = None
        return self.done

    def add(self, is_data: bool, content: bytes | memoryview) -> None:
        if is_data:
            self.data(content)
        else:
            self.commands(content)

    def apart(self, is_data: bool, content: bytes | memoryview, whole: int) -> None:
        """Add a run that neither joins the one before nor is cut if a payload of ``whole`` bytes can hold it."""
        if is_data == self.kind:
            self.finish()
        before, payload, opened = len(self.done), bytes(self.payload), self.open
        self.add(is_data, content)
        self.kind = is_data
        if len(self.done) == before:
            return
        if len(pack_runs([(is_data, content)], whole, repeats=self.repeats)) == 1:
            del self.done[before:]
            self.payload[:], self.open = payload, opened
            self.finish()
            limit, self.limit = self.limit, whole
            self.add(is_data, content)
            self.limit, self.kind = limit, is_data
            if len(self.payload) > limit:
                self.finish()

    def commands(self, content: bytes | memoryview) -> None:
        size = len(content) + -(-len(content) // MAX_COMMANDS)
        if size > self.limit - len(self.payload) and size <= self.limit:
            self.finish()
        for at in range(0, len(content), MAX_COMMANDS):
            part = content[at : at + MAX_COMMANDS]
            if len(self.payload) + 1 + len(part) > self.limit:
                self.finish()
            self.open = len(self.payload)
            self.payload.append(COMMAND_HEADER + len(part) - 1)
            self.payload += part

    def data(self, content: bytes | memoryview) -> None:
        if not self.repeats or len(content) < 2:
            self._literal(content)
            return
        at = 0
        for match in _REPEATS.finditer(content):
            self._between(content[at : match.start()])
            at = match.end()
            self._repeat(at - match.start(), content[at - 1])
        self._between(content[at:])

    def _between(self, content: bytes | memoryview) -> None:
        if _PAIRS.fullmatch(content):
            for value in content[::2]:
                self._repeat(2, value)
        else:
            self._literal(content)

    def _repeat(self, times: int, value: int) -> None:
        if len(self.payload) + 2 > self.limit:
            self.finish()
        self.open = None
        self.payload += bytes((257 - times, value))

    def _literal(self, content: bytes | memoryview) -> None:
        at = self._trailing(content)
        while at < len(content):
            if len(self.payload) + 2 > self.limit:
                self.finish()
            part = content[at : at + min(MAX_LITERAL, self.limit - len(self.payload) - 1)]
            self.payload.append(len(part) - 1)
            self.payload += part
            at += len(part)

    def _trailing(self, content: bytes | memoryview) -> int:
        """Put the first bytes into a token of commands that is open; return how many."""
        if self.open is None or not content:
            return 0
        size = min(MAX_TRAILING, len(content), self.limit - len(self.payload))
        self.payload[self.open] += size << 3
        self.payload += content[:size]
        self.open = None
        return size
