"""What a panel knows of a transport, and what a plan is."""

from __future__ import annotations

import operator
from collections.abc import Iterator
from typing import Final, NamedTuple, Protocol

import numpy as np
import numpy.typing as npt

from paneldraw.errors import TransportError

COMMAND: Final = 0x00
DATA: Final = 0x40
CHAINED: Final = 0x80
"""Kinds of message, as the I2C wire spells them. A chained one holds its own further control bytes."""


class Cost(NamedTuple):
    """Bytes on the wire that a message costs beyond its payload."""

    command: int
    data: int
    chained: int | None = None
    """The same of a chained message; None where the transport has none."""
    longest: int | None = None
    """Bytes of payload that a message may have; None where there is no limit."""


class Plan:
    """The messages of one update, in one buffer that is used again for the next.

    Message ``i`` is ``buffer[starts[i]:stops[i]]``: its kind (`COMMAND`, `DATA` or `CHAINED`), then its payload. The
    kind's place belongs to the transport, which may send it as it stands or put a byte of its own there.

    Attributes
    ----------
    buffer : (capacity,) uint8 array
    address : int
        Where the buffer stands in memory.
    starts, stops : (limit,) memoryviews of intp
    count : int
        How many messages there are.
    cost : int
        Bytes on the wire by the transport's `Cost`.
    changed : int
        Bytes of panel RAM that change.
    """

    __slots__ = ("address", "buffer", "changed", "cost", "count", "starts", "stops")

    def __init__(self, capacity: int, limit: int) -> None:
        self.buffer: npt.NDArray[np.uint8] = np.zeros(capacity, np.uint8)
        self.address: int = self.buffer.ctypes.data
        # Reading one number from a memoryview is twice as fast as from an array.
        self.starts = np.zeros(limit, np.intp).data
        self.stops = np.zeros(limit, np.intp).data
        self.count = 0
        self.cost = 0
        self.changed = 0

    def __len__(self) -> int:
        return self.count

    @property
    def longest(self) -> int:
        """Bytes of the longest message, its kind included."""
        return max(map(operator.sub, self.stops[: self.count], self.starts[: self.count]), default=0)

    def __iter__(self) -> Iterator[tuple[int, memoryview]]:
        """Yield each message's kind and payload."""
        view = self.buffer.data
        for start, stop in zip(self.starts[: self.count], self.stops[: self.count], strict=True):
            yield view[start], view[start + 1 : stop]


class Transport(Protocol):
    """What carries bytes to a panel. A write returns the bytes that it put on the wire, or raises `TransportError`.

    One that has an attribute ``wire``, ``"i2c"`` or ``"spi"``, is kept from chips that cannot be on such a bus.
    Chips that know no control bytes, whose messages have their own first byte as their kind, are on one alone whose
    attribute ``verbatim`` is True: it sends the messages of a plan as they stand.
    """

    @property
    def cost(self) -> Cost:
        """What a message costs here."""

    def command(self, payload: bytes) -> int:
        """Send one command message."""

    def data(self, payload: bytes) -> int:
        """Send one data message."""

    def batch(self, plan: Plan) -> int:
        """Send all messages of a plan in order."""

    def reset(self) -> bool:
        """Pulse the panel's reset line unless nothing was sent since the last time; return whether there is one."""

    def close(self) -> None:
        """Release what the transport opened itself. Closing twice does nothing."""


def transient(error: TransportError) -> TransportError:
    """Mark an error as one after which the same write may well succeed."""
    error.transient = True
    return error


def join_group(group: str) -> str:
    """Say what to do where only a group may open a device."""
    return f"add the user to group {group} (`sudo usermod -aG {group} $USER`) and log in again"
