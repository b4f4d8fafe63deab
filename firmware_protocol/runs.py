"""What a WRITE carries: runs of command and data bytes for the panel, as a stream of tokens.

The tokens are PackBits (a header below 80 opens a literal, one from A0 a repeat) in which the headers 80 to 9F, the
longest repeats, are given to commands instead.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

MAX_LITERAL = 128
MAX_COMMANDS = 32
MAX_REPEAT = 97
COMMAND_HEADER = 0x80
REPEAT_HEADER = 0xA0
#: A payload limit below this could not hold every command token.
LEAST_PAYLOAD = 1 + MAX_COMMANDS

# A repeat inside a literal costs its two bytes and the header of the literal after it.
_REPEATS = re.compile(rb"(.)\1{3,%d}" % (MAX_REPEAT - 1), re.DOTALL)

#: Whether the bytes are data (True) or commands (False), and the bytes.
Run = tuple[bool, bytes | memoryview]


def pack_runs(runs: Iterable[Run], limit: int, *, first: int | None = None, repeats: bool = True) -> list[bytes]:
    """Turn runs into WRITE payloads, as few as there can be.

    Parameters
    ----------
    runs : iterable of (bool, bytes or memoryview)
        Whether the bytes are data (True) or commands (False), and the bytes. Commands of one run are kept in one
        payload where they fit into one.
    limit : int
        Most bytes a payload may have, at least 33.
    first : int, optional
        Most bytes the first payload may have, at least 33. Default: ``limit``.
    repeats : bool, default True
        Whether the device understands repeats.

    Returns
    -------
    list of bytes
        Payloads, none of them empty.

    Examples
    --------
    >>> [p.hex(" ") for p in pack_runs([(False, b"\\xb0\\x02\\x10"), (True, bytes(40))], 64)]
    ['82 b0 02 10 d9 00']
    """
    if min(limit, first or limit) < LEAST_PAYLOAD:
        raise ValueError(f"limit and first must be at least {LEAST_PAYLOAD} bytes, not {limit} and {first}")
    packer = _Packer(limit, first or limit)
    for is_data, content in runs:
        if is_data:
            packer.data(content, repeats)
        else:
            packer.commands(content)
    return packer.finish()


def unpack_runs(payload: bytes) -> list[tuple[bool, bytes]]:
    """Return the runs of a WRITE payload, neighbors of one kind joined, as they go onto the panel's bus.

    Raises
    ------
    ValueError
        If the payload ends inside a token.

    Examples
    --------
    >>> unpack_runs(bytes.fromhex("82 b0 02 10 00 ff fd 55"))
    [(False, b'\\xb0\\x02\\x10'), (True, b'\\xffUUUU')]
    """
    joined: list[tuple[bool, bytearray]] = []
    for is_data, content in _tokens(payload):
        if joined and joined[-1][0] == is_data:
            joined[-1][1].extend(content)
        else:
            joined.append((is_data, bytearray(content)))
    return [(is_data, bytes(content)) for is_data, content in joined]


def _tokens(payload: bytes) -> Iterator[tuple[bool, bytes]]:
    at = 0
    while at < len(payload):
        header = payload[at]
        at += 1
        if header >= REPEAT_HEADER:
            length, content = 1, payload[at : at + 1] * (257 - header)
        else:
            length = header - COMMAND_HEADER + 1 if header >= COMMAND_HEADER else header + 1
            content = payload[at : at + length]
        at += length
        if at > len(payload):
            raise ValueError(f"the payload ends inside the token {header:02x}")
        yield not COMMAND_HEADER <= header < REPEAT_HEADER, content


class _Packer:
    """Fills payloads token by token."""

    def __init__(self, limit: int, first: int) -> None:
        self.later = limit
        self.limit = first
        self.payload = bytearray()
        self.done: list[bytes] = []

    def finish(self) -> list[bytes]:
        if self.payload:
            self.done.append(bytes(self.payload))
            self.payload.clear()
            self.limit = self.later
        return self.done

    def commands(self, content: bytes | memoryview) -> None:
        size = len(content) + -(-len(content) // MAX_COMMANDS)
        if size > self.limit - len(self.payload) and size <= self.later:
            self.finish()
        for at in range(0, len(content), MAX_COMMANDS):
            part = content[at : at + MAX_COMMANDS]
            if len(self.payload) + 1 + len(part) > self.limit:
                self.finish()
            self.payload.append(COMMAND_HEADER + len(part) - 1)
            self.payload += part

    def data(self, content: bytes | memoryview, repeats: bool) -> None:
        at = 0
        if repeats and len(content) > 3:
            for match in _REPEATS.finditer(content):
                self._literal(content[at : match.start()])
                at = match.end()
                if len(self.payload) + 2 > self.limit:
                    self.finish()
                self.payload += bytes((257 - (at - match.start()), content[at - 1]))
        self._literal(content[at:])

    def _literal(self, content: bytes | memoryview) -> None:
        at = 0
        while at < len(content):
            if len(self.payload) + 2 > self.limit:
                self.finish()
            part = content[at : at + min(MAX_LITERAL, self.limit - len(self.payload) - 1)]
            self.payload.append(len(part) - 1)
            self.payload += part
            at += len(part)
