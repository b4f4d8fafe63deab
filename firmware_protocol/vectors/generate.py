"""Writes the golden vectors: what frames look like, and what a device does in conversation.

``python firmware_protocol/vectors/generate.py`` rewrites both files; a change of them is a change of the protocol.

``frames.txt``: ``kind seq payload wire`` a line, in hexadecimal, ``-`` for no payload.
``conversations.txt``: ``# name`` begins a conversation with a device that has just started (boot 1, cause 1, the
profile `UNO`). Then ``> bytes`` from the host, ``< bytes`` that the device answers, ``= bytes`` that it writes to its
panel in one transaction, ``! gone`` and ``! back`` for the panel.
"""

from __future__ import annotations

import random
from pathlib import Path

from firmware_protocol.device import Device
from firmware_protocol.frames import FrameDecoder, encode_frame
from firmware_protocol.messages import Ack, Baud, Boot, Hello, Nak, Poll, Reset, Status, Write, encode
from firmware_protocol.runs import pack_runs

HERE = Path(__file__).parent
Step = bytes | str


def frames() -> str:
    """Return the lines of ``frames.txt``."""
    rng = random.Random(1)
    cases: list[tuple[int, int, bytes]] = [(0x02, 0, b""), (0, 0, b""), (0xFF, 0xFF, b"\xff" * 4), (0x10, 3, bytes(12))]
    cases += [(0x11, size & 0xFF, bytes(1 + i % 255 for i in range(size))) for size in (1, 128, 249, 250)]
    cases += [(rng.randrange(256), rng.randrange(256), rng.randbytes(rng.randrange(251))) for _ in range(24)]
    cases += [(0x10, seq, bytes(rng.choices((0, 0, 1, 255), k=rng.randrange(251)))) for seq in range(8)]
    messages = (Hello(0x01020304), Poll(9), Baud(2, 500_000), Reset(3), Status(9, 2), Boot(7, 8), Ack(0), Nak(5))
    cases += [frame for message in messages for frame in FrameDecoder().feed(encode(message)) if frame]
    return "".join(
        f"{kind:02x} {seq:02x} {payload.hex() or '-'} {encode_frame(kind, seq, payload).hex()}\n"
        for kind, seq, payload in cases
    )


def picture(seq: int, *runs: tuple[bool, bytes], end: bool = True) -> bytes:
    """Return one WRITE frame with these runs."""
    (payload,) = pack_runs(runs, 250)
    return encode(Write(seq, payload, end))


def damaged(frame: bytes, at: int = 3) -> bytes:
    """Return the frame with one byte changed."""
    return frame[:at] + bytes((frame[at] ^ 0x80 or 0x80,)) + frame[at + 1 :]


def conversations() -> dict[str, list[Step]]:
    """Return the host's half of each conversation."""
    hello = b"\0" + encode(Hello(0x01020304))
    pixel = ((False, bytes.fromhex("b00810")), (True, b"\xff"))
    row = (True, bytes(range(64)) + bytes(64))
    return {
        "one changed pixel": [hello, picture(0, *pixel)],
        "no session yet": [
            picture(0, *pixel), encode(Poll(1)), encode(Reset(0)), b"\x05\x05\x05\0", hello, encode(Poll(2)),
        ],
        "repeats, joined runs, an empty end": [
            hello,
            picture(0, (False, b"\xae"), (False, b"\xd5\x80"), row, row, (True, b"\1"), (False, bytes(range(40)))),
            encode(Write(1, b"")),
            encode(Write(2, b"\x80\xa6\x80\xa7\x00\x01\xff\x02\xc0\x03\x87" + bytes(8), False)),
            encode(Write(3, b"\x90\xa6\x01\x02\x00\x03\x80\xa7\x80\xae\xbf" + bytes(range(15)), False)),
        ],
        "a damaged frame, then recovery": [
            hello, picture(0, *pixel), damaged(picture(1, *pixel)), picture(2, *pixel), damaged(picture(3, *pixel)),
            b"\0" + encode(Poll(0x55)), picture(1, *pixel), picture(2, *pixel), picture(3, *pixel),
        ],
        "a lost frame": [
            hello, picture(0, *pixel), picture(2, *pixel), picture(3, *pixel), encode(Poll(0)), picture(1, row),
        ],
        "duplicates": [
            hello, picture(0, *pixel), picture(0, *pixel), picture(1, row), picture(0, *pixel), picture(1, row),
        ],
        "numbers wrap": [
            hello, *(picture(n & 0xFF, (True, bytes((n & 0xFF,)))) for n in range(260)), picture(250, row),
        ],
        "garbage of every kind": [
            b"$GPGGA,123519,4807.038,N\r\n", hello, b"\xff" * 300, b"\0\0\0", b"\1\0", b"\2\1\0", b"\3\1\1\0",
            encode(Poll(1)), b"\x05\x10\0", encode(Poll(2)), encode_frame(0x10, 0, b"\x00" * 251), encode(Poll(3)),
            encode_frame(0x42, 0, b"later"), encode_frame(0x01, 0, b"short"), picture(0, *pixel),
        ],
        "a frame cut off by the next": [
            hello, picture(0, row)[:20] + picture(0, *pixel), encode(Poll(7)), picture(0, *pixel),
        ],
        "the panel goes and comes back": [
            hello, picture(0, *pixel), "! gone", picture(1, *pixel), picture(2, *pixel), "! back", picture(3, *pixel),
            encode(Baud(4, 500_000)), encode(Poll(1)), encode(Reset(5)), picture(6, *pixel), "! gone", hello,
        ],
        "malformed writes": [
            hello, encode(Write(0, b"\x05\x01")), encode(Reset(1)), encode(Write(2, b"\x00\x11\xc0")), encode(Reset(3)),
            encode(Write(4, b"\x91\xae\xaf\x11")), encode(Reset(5)), encode_frame(0x13, 6),
            encode_frame(0x12, 7, b"\1\2\3"), encode(Reset(8)), encode_frame(0x1F, 9, b"?"), picture(10, *pixel),
            encode(Reset(11)), picture(12, *pixel),
        ],
        "a rate that is not offered": [
            hello, encode(Baud(0, 9600)), encode(Reset(1, pulse=True)), encode(Baud(2, 250_000)),
        ],
        "versions": [
            encode(Hello(1, 2, 9)), encode(Poll(1)), picture(0, *pixel), encode(Hello(2, 1, 9)), picture(0, *pixel),
            encode(Hello(3, 0, 0)), encode(Poll(1)),
        ],
        "a session begun anew": [
            hello, picture(0, *pixel), picture(1, *pixel), hello, picture(1, *pixel), picture(0, *pixel),
        ],
    }  # fmt: skip


class Panel:
    """Notes what the device writes; may be gone."""

    def __init__(self) -> None:
        self.gone = False
        self.lines: list[str] = []

    def __call__(self, content: bytes) -> None:
        if self.gone:
            raise OSError(121, "Remote I/O error")
        if content:
            self.lines.append(f"= {content.hex()}")


def played(name: str, steps: list[Step]) -> list[str]:
    """Return the lines of one conversation, held with the reference device."""
    panel = Panel()
    device = Device(panel)
    panel.lines.append(f"# {name}")
    for step in steps:
        if isinstance(step, str):
            panel.gone = step == "! gone"
            panel.lines.append(step)
            continue
        panel.lines.append(f"> {step.hex()}")
        for byte in step:
            answer = device.receive(bytes((byte,)))
            if answer:
                panel.lines.append(f"< {answer.hex()}")
    return panel.lines


def transcript() -> str:
    """Return the lines of ``conversations.txt``."""
    return "\n".join(line for name, steps in conversations().items() for line in played(name, steps)) + "\n"


if __name__ == "__main__":
    (HERE / "frames.txt").write_text(frames())
    (HERE / "conversations.txt").write_text(transcript())
