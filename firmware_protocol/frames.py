"""Frames on the wire: ``COBS(kind, seq, payload, CRC-16) 00``."""

from __future__ import annotations

from binascii import crc_hqx
from typing import NamedTuple

from cobs import cobs  # type: ignore[import-untyped]

DELIMITER = b"\0"
CRC_SEED = 0xFFFF
#: Bytes a frame has on the wire beyond its payload, while kind, seq, payload and checksum fit 254 bytes.
FRAME_OVERHEAD = 6
#: Bytes of a decoded frame that are not payload: kind, seq and the checksum.
ENVELOPE = 4


class Frame(NamedTuple):
    """A frame whose checksum was right.

    Attributes
    ----------
    kind : int
        The message's number, 0 to 255.
    seq : int
        Its sequence number, or the token of an unsequenced message, 0 to 255.
    payload : bytes
        What the message carries.
    """

    kind: int
    seq: int
    payload: bytes


def encode_frame(kind: int, seq: int, payload: bytes = b"") -> bytes:
    """Return the bytes that go on the wire, delimiter included.

    Parameters
    ----------
    kind, seq : int
        0 to 255 each.
    payload : bytes, default empty
        Anything; what length the far end takes, it says in its hello.

    Examples
    --------
    >>> encode_frame(0x02, 7).hex(" ")
    '05 02 07 0b 8a 00'
    """
    body = bytes((kind, seq)) + payload
    encoded: bytes = cobs.encode(body + crc_hqx(body, CRC_SEED).to_bytes(2, "big"))
    return encoded + DELIMITER


def wire_size(payload: int) -> int:
    """Return how many bytes a frame with a payload of this many bytes takes on the wire."""
    return payload + FRAME_OVERHEAD + (payload + ENVELOPE - 1) // 254


def payload_within(wire: int) -> int:
    """Return the longest payload whose frame never takes more than this many bytes on the wire.

    Examples
    --------
    >>> payload_within(256), payload_within(257), payload_within(258)
    (250, 250, 251)
    """
    room = wire - FRAME_OVERHEAD
    return room - (room + ENVELOPE) // 255


class FrameDecoder:
    """Cuts a stream of bytes into frames, whatever the stream holds.

    Parameters
    ----------
    max_payload : int, default 1024
        Longer frames count as damaged. It bounds what the decoder ever keeps.

    Examples
    --------
    >>> decoder = FrameDecoder()
    >>> decoder.feed(encode_frame(0x02, 7) + b"noise" + encode_frame(0x02, 8))
    [Frame(kind=2, seq=7, payload=b''), None]
    >>> decoder.feed(encode_frame(0x02, 9))
    [Frame(kind=2, seq=9, payload=b'')]
    """

    def __init__(self, max_payload: int = 1024) -> None:
        self._longest = max_payload + ENVELOPE
        self._longest_encoded = wire_size(max_payload) - 1
        self._held = bytearray()
        self._overlong = False

    @property
    def held(self) -> int:
        """How many bytes of an unfinished frame are held."""
        return len(self._held)

    def feed(self, data: bytes) -> list[Frame | None]:
        """Take bytes as they come; return the frames that they complete, with None for each damaged one."""
        *complete, rest = data.split(DELIMITER)
        found: list[Frame | None] = []
        for part in complete:
            self._hold(part)
            if self._held or self._overlong:
                found.append(None if self._overlong else self._open(bytes(self._held)))
            self.clear()
        self._hold(rest)
        return found

    def clear(self) -> None:
        """Forget the beginning of a frame that was held."""
        self._held.clear()
        self._overlong = False

    def _hold(self, part: bytes) -> None:
        self._overlong = self._overlong or len(self._held) + len(part) > self._longest_encoded
        if self._overlong:
            self._held.clear()
        else:
            self._held += part

    def _open(self, encoded: bytes) -> Frame | None:
        try:
            body = cobs.decode(encoded)
        except cobs.DecodeError:
            return None
        # Over a frame and its own checksum the remainder is 0.
        if not ENVELOPE <= len(body) <= self._longest or crc_hqx(body, CRC_SEED):
            return None
        return Frame(body[0], body[1], body[2:-2])
