"""Serial chips without a D/C pin: a byte ahead of others says what they are, as the ST7920 has it."""

from __future__ import annotations

from typing import Final

from paneldraw.transports.base import DATA, Cost, Plan, Transport

_SYNC: Final = 0xF8
_IS_DATA: Final = 0x02
_HALVES: Final = bytes.maketrans(b"0123456789abcdef", bytes(range(0x00, 0x100, 0x10)))


def synced(data: bool, payload: bytes | memoryview) -> bytes:
    """Frame a message: ``F8`` before commands, ``FA`` before data, then each byte's upper half and its lower half.

    Examples
    --------
    >>> synced(False, b"\\x36").hex(" "), synced(True, b"\\xa5\\x0f").hex(" ")
    ('f8 30 60', 'fa a0 50 00 f0')
    """
    return bytes((_SYNC | _IS_DATA * data,)) + payload.hex().encode().translate(_HALVES)


class SyncedTransport:
    """Frames messages for a transport that carries them as they are, such as ``SPITransport(dc=None, cs_high=True)``.

    Parameters
    ----------
    transport : Transport
    """

    def __init__(self, transport: Transport) -> None:
        self._transport = transport
        longest = transport.cost.longest
        self._longest = 1 << 16 if longest is None else longest
        # In halves of what goes out: a jump is a message of commands and one of data, and each has a byte of its own.
        self.cost = Cost(1, 0, longest=(self._longest - 1) // 2)

    def command(self, payload: bytes) -> int:
        """Send one command message; return the bytes on the wire."""
        return self._transport.data(synced(False, payload))

    def data(self, payload: bytes) -> int:
        """Send one data message; return the bytes on the wire."""
        return self._transport.data(synced(True, payload))

    def batch(self, plan: Plan) -> int:
        """Send all messages of a plan, as many at once as fit; return the bytes on the wire."""
        waiting: list[bytes] = []
        wire = size = 0
        for kind, payload in plan:
            message = synced(kind == DATA, payload)
            if size + len(message) > self._longest:
                wire += self._transport.data(b"".join(waiting))
                waiting, size = [], 0
            waiting.append(message)
            size += len(message)
        return wire + (self._transport.data(b"".join(waiting)) if waiting else 0)
