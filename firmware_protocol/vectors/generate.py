"""Writes the golden vectors: what frames look like, and what a device does in conversation.

``python firmware_protocol/vectors/generate.py`` rewrites both files; a change of them is a change of the protocol.

`PROTOCOL.md` says what their lines mean.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from firmware_protocol.cycle import pack_cycle
from firmware_protocol.device import UNO, Device
from firmware_protocol.frames import FrameDecoder, encode_frame
from firmware_protocol.messages import (
    Ack,
    Baud,
    Boot,
    Byte,
    Cycle,
    Feature,
    Hello,
    Kind,
    Nak,
    Poll,
    Read,
    Reset,
    Status,
    Store,
    Write,
    encode,
)
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
    for size in (251, 252, 253, 504, 505, 1024):
        cases += [(0x10, size & 0xFF, bytes(1 + i % 255 for i in range(size))), (0x11, 0, rng.randbytes(size))]
    messages = (
        *(Hello(0x01020304), Poll(9), Read(4), Baud(2, 500_000), Reset(3)),
        *(Status(9, 2), Boot(7, 8), Ack(0), Nak(5), Byte(4, value=0x43)),
        *(Store(4, 260, b"\x02\x00\x00\xff"), Cycle(5, 264, 3), Cycle(6)),
    )
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
    """Return the host's half of each conversation, and what happens besides."""
    return {**exchanges(), **cycles(), **troubles(), **rates(), **kinds_of_device()}


def exchanges() -> dict[str, list[Step]]:
    """Return those in which the line is as it should be."""
    hello = b"\0" + encode(Hello(0x01020304))
    pixel = ((False, bytes.fromhex("b00810")), (True, b"\xff"))
    row = (True, bytes(range(64)) + bytes(64))
    return {
        "one changed pixel": [hello, picture(0, *pixel)],
        "repeats, joined runs, an empty end": [
            hello,
            picture(0, (False, b"\xae"), (False, b"\xd5\x80"), row, row, (True, b"\1"), (False, bytes(range(40)))),
            encode(Write(1, b"")),
            encode(Write(2, b"\x80\xa6\x80\xa7\x00\x01\xff\x02\xc0\x03\x87" + bytes(8), False)),
            encode(Write(3, b"\x90\xa6\x01\x02\x00\x03\x80\xa7\x80\xae\xbf" + bytes(range(15)), False)),
        ],
        "several frames at once": [
            hello, picture(0, *pixel) + picture(1, row) + picture(2, *pixel), picture(3, *pixel) + encode(Poll(1)),
        ],
        "numbers wrap": [
            hello, *(picture(n & 0xFF, (True, bytes((n & 0xFF,)))) for n in range(260)), picture(250, row),
        ],
        "versions": [
            encode(Hello(1, 2, 9)), encode(Poll(1)), picture(0, *pixel), encode(Hello(2, 1, 9)), picture(0, *pixel),
            encode(Hello(3, 0, 0)), encode(Poll(1)),
        ],
        "a host that names no features": [encode_frame(Kind.HELLO, 0, bytes((4, 3, 2, 1, 1, 1))), picture(0, *pixel)],
        "a host with features of later times": [
            b"\0" + encode(Hello(5, features=0xFFFC)), encode_frame(Kind.HELLO, 0, bytes((6, 0, 0, 0, 1, 1, 0, 0, 9))),
        ],
        "a byte read from the panel": [
            encode(Read(1)), hello, encode(Read(1)), b"\0" + encode(Hello(8, features=Feature.READ)), "! reads 43",
            encode(Read(2)), picture(0, *pixel) + encode(Read(3)), "! gone", encode(Read(4)), "! back", "! reads 0",
            encode(Read(5)), encode(Poll(6)),
        ],
        "a session begun anew": [
            hello, picture(0, *pixel), picture(1, *pixel), hello, picture(1, *pixel), picture(0, *pixel),
        ],
    }  # fmt: skip


def cycles() -> dict[str, list[Step]]:
    """Return those with sub-pictures that the device writes in turn, each 100 ms after the last."""
    hello = b"\0" + encode(Hello(9, features=Feature.CYCLE | Feature.WATCH))
    place = (False, bytes.fromhex("b00810"))
    row = (True, bytes(range(40)))
    pixel = place, (True, b"\1")
    kept = pack_cycle([[place, (True, bytes((byte,)))] for byte in (1, 2, 3)], [0.1] * 3)
    long = pack_cycle([[place, row, place, (True, bytes(range(n, n + 9))), row] for n in (1, 2)], [0.1, 0.2])
    empty = pack_cycle([[], []], [0.1] * 2)
    three = [hello, picture(0, *pixel), encode(Store(1, 0, kept)), encode(Cycle(2, len(kept), 3))]
    return {
        "sub-pictures in turn": [*three, *["! wait 100"] * 5, encode(Poll(1)), picture(3, *pixel), "! wait 200"],
        "a cycle ends with its first sub-picture": [
            *three, encode(Cycle(3)), encode(Cycle(4, len(kept), 3)), "! wait 100", encode(Cycle(5)), "! wait 200",
            encode(Cycle(6, len(kept), 3)), "! wait 100", encode(Baud(7, 115_200)), "! wait 100", hello, "! wait 200",
        ],
        "a store in two parts, and one that lasts longer": [
            hello, encode(Store(0, 0, long[:70])), encode(Store(1, 70, long[70:])), encode(Cycle(2, len(long), 2)),
            "! wait 100", "! wait 100", "! wait 100", "! wait 100", encode(Reset(3)), encode(Store(4, 719, b"\x01")),
        ],
        "repeats, and no change at all": [
            hello, encode(Store(0, 0, kept[:4] + b"\xfd\x11\x22\x90\xa6\1\2\3\4\x80\xa7")), encode(Cycle(1, 15, 2)),
            "! wait 100", encode(Cycle(2)), encode(Store(3, 0, empty)), encode(Cycle(4, len(empty), 2)), "! wait 100",
            "! gone", "! wait 100", encode(Poll(1)),
        ],
        "cycles that cannot be": [
            hello, encode(Store(0, 719, b"\1\2")), encode(Reset(1)), encode_frame(Kind.STORE, 2, b"\0"),
            encode(Reset(3)), encode(Cycle(4, 2, 1)), encode(Reset(5)), encode_frame(Kind.CYCLE, 6, b"\0\x80"),
            encode(Reset(7)), encode(Store(8, 0, kept)), encode(Cycle(9, len(kept) - 1, 3)), encode(Reset(10)),
            encode(Cycle(11, 5, 3)), encode(Reset(12)), encode(Cycle(13, 721, 3)), encode(Reset(14)),
            encode(Cycle(15, len(kept), 2)), encode(Store(16, 0, empty)), encode(Reset(17)), encode(Cycle(18, 4, 255)),
        ],
        "nobody asked for cycles": [
            b"\0" + encode(Hello(9)), encode(Store(0, 0, kept)), encode(Reset(1)), encode(Cycle(2, len(kept), 3)),
        ],
        "the panel goes within a cycle": [
            *three, "! wait 100", "! gone", "! wait 100", "! back", "! wait 100", encode(Poll(1)), picture(3, *pixel),
            encode(Reset(4)), picture(5, *pixel),
        ],
        "a start within a cycle": [
            *three, "! wait 100", "! start 8", "! wait 300", hello, encode(Cycle(0, len(kept), 3)),
        ],
    }  # fmt: skip


def troubles() -> dict[str, list[Step]]:
    """Return those in which the line or the panel is not as it should be."""
    hello = b"\0" + encode(Hello(0x01020304))
    watched = b"\0" + encode(Hello(7, features=Feature.WATCH))
    pixel = ((False, bytes.fromhex("b00810")), (True, b"\xff"))
    row = (True, bytes(range(64)) + bytes(64))
    return {
        "no session yet": [
            picture(0, *pixel), encode(Poll(1)), encode(Reset(0)), b"\x05\x05\x05\0", hello, encode(Poll(2)),
        ],
        "a start in the middle": [
            hello, picture(0, *pixel)[:5], "! start 8", picture(0, *pixel), encode(Poll(1)), hello, picture(0, *pixel),
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
        "nothing of a malformed write is written": [
            hello, encode(Write(0, b"\x82\xb0\x08\x10\x00\xff\x01\x02")), encode(Reset(1)), picture(2, *pixel),
        ],
        "the first fault stays": [
            hello, "! gone", picture(0, *pixel), "! back", encode(Write(1, b"\x05")), encode_frame(0x1F, 2),
            encode(Baud(3, 9600)), encode(Poll(1)), encode(Reset(4)), encode_frame(0x1E, 5), encode(Write(6, b"\x05")),
            hello, encode(Baud(0, 9600)), encode_frame(0x1E, 1), encode(Poll(2)),
        ],
        "the panel goes while nothing is sent": [
            watched, picture(0, *pixel), "! gone", "! wait 900", encode(Poll(1)), "! wait 1100", "! back",
            picture(1, *pixel), encode(Poll(2)), encode(Reset(2)), "! wait 1100", picture(3, *pixel),
        ],
        "nobody asked for the panel to be watched": [hello, "! gone", "! wait 1100", "! back", picture(0, *pixel)],
    }  # fmt: skip


def rates() -> dict[str, list[Step]]:
    """Return those in which the rate changes."""
    hello = b"\0" + encode(Hello(0x01020304))
    pixel = ((False, bytes.fromhex("b00810")), (True, b"\xff"))
    return {
        "a rate that is not offered": [
            hello, encode(Baud(0, 9600)), encode(Reset(1, pulse=True)), encode(Baud(2, 250_000)),
        ],
        "another rate and back": [
            hello, encode(Baud(0, 250_000)), encode(Poll(1)), "! wait 5000", picture(1, *pixel),
            encode(Baud(2, 115_200)), "! wait 2000", b"\x01\x02", "! wait 2000", b"\0" + encode(Poll(2)),
        ],
        "another rate at which nothing comes": [
            hello, encode(Baud(0, 250_000)), "! wait 250", "! wait 100", encode(Poll(1)), picture(1, *pixel),
        ],
        "another rate at which nothing whole comes": [
            hello, encode(Baud(0, 250_000)), b"\xff\0\xff", "! wait 350", encode(Poll(1)),
        ],
        "a host that came back at the first rate": [
            hello, encode(Baud(0, 250_000)), encode(Poll(1)), b"\0", "! wait 1400", encode(Poll(2)), "! wait 1600",
            b"\0\0\0", "! wait 1400", "! wait 150", encode(Poll(3)),
        ],
        "a frame that breaks off at another rate": [
            hello, encode(Baud(0, 250_000)), encode(Poll(1)), picture(1, *pixel)[:6], "! wait 1600",
            picture(1, *pixel),
        ],
    }  # fmt: skip


def kinds_of_device() -> dict[str, list[Step]]:
    """Return those with devices that are not all alike; the first step says how they differ."""
    hello = b"\0" + encode(Hello(0x01020304))
    commands = ((False, bytes.fromhex("b00810")), (True, b"\1\2\3"), (False, b"\xae"))
    return {
        "a control byte before each command": [": control-each", hello, picture(0, *commands)],
        "no repeats": [
            ": no-repeats", hello, picture(0, *commands), encode(Write(1, b"\x00\x07\xc0\x00")), encode(Reset(2)),
            picture(3, *commands),
        ],
        "a reset line": [
            ": reset-line", "! start 4", hello, encode(Reset(0)), encode(Reset(1, pulse=True)), picture(2, *commands),
        ],
    }  # fmt: skip


class Panel:
    """Notes what the device does to it; may be gone."""

    def __init__(self) -> None:
        self.gone = False
        self.status = 0
        self.lines: list[str] = []

    def read(self) -> int:
        if self.gone:
            raise OSError(121, "Remote I/O error")
        return self.status

    def reset(self) -> None:
        self.lines.append("^")

    def __call__(self, content: bytes) -> None:
        if self.gone:
            raise OSError(121, "Remote I/O error")
        if content:
            self.lines.append(f"= {content.hex()}")


def made(settings: list[str], panel: Panel, clock: Callable[[], float]) -> Device:
    """Return a device that has just started."""
    profile = replace(UNO, repeats="no-repeats" not in settings, reset_line="reset-line" in settings)
    device = Device(
        panel, read=panel.read, reset_panel=panel.reset, control_each="control-each" in settings, profile=profile,
        clock=clock,
    )  # fmt: skip
    panel.lines.clear()
    return device


def played(name: str, steps: list[Step]) -> list[str]:
    """Return the lines of one conversation, held with the reference device."""
    panel = Panel()
    now = 0
    settings = steps[0].split()[1:] if isinstance(steps[0], str) and steps[0].startswith(":") else []
    device = made(settings, panel, lambda: now / 1000)
    panel.lines.append(f"# {name}")
    for step in steps:
        rate = device.baudrate
        panel.lines.append(step if isinstance(step, str) else f"> {step.hex()}")
        if isinstance(step, bytes):
            hear(device, step, panel.lines)
        elif step.startswith("! wait"):
            now += int(step.split()[2])
            device.tick()
        elif step.startswith("! start"):
            panel.lines.append(f"< {device.reset(int(step.split()[2])).hex()}")
        elif step.startswith("! reads"):
            panel.status = int(step.split()[2], 16)
        elif step.startswith("!"):
            panel.gone = step == "! gone"
        if device.baudrate != rate:
            panel.lines.append(f"@ {device.baudrate}")
    return panel.lines


def hear(device: Device, data: bytes, lines: list[str]) -> None:
    """Give the device bytes one by one and note its answers; an ACK may be left out where another follows at once."""
    acknowledged = None
    for byte in data:
        answer = device.receive(bytes((byte,)))
        if not answer:
            continue
        is_ack = any(frame and frame.kind == Kind.ACK for frame in FrameDecoder().feed(answer))
        if is_ack and acknowledged is not None:
            lines[acknowledged] = "~" + lines[acknowledged][1:]
        acknowledged = len(lines) if is_ack else None
        lines.append(f"< {answer.hex()}")


def transcript() -> str:
    """Return the lines of ``conversations.txt``."""
    return "\n".join(line for name, steps in conversations().items() for line in played(name, steps)) + "\n"


if __name__ == "__main__":
    (HERE / "frames.txt").write_text(frames())
    (HERE / "conversations.txt").write_text(transcript())
