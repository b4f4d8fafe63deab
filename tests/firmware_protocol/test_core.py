"""The C core against the golden vectors and against the reference device, byte for byte."""

from __future__ import annotations

import functools
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from c_core import FIRMWARE, Core, made
from hypothesis import given
from hypothesis import strategies as st
from searching import examples

from firmware_protocol import Device
from firmware_protocol.cycle import pack_cycle
from firmware_protocol.frames import FrameDecoder, encode_frame
from firmware_protocol.messages import (
    Baud,
    Boot,
    Cycle,
    Fault,
    Hello,
    Poll,
    Read,
    Reset,
    Status,
    Store,
    Write,
    decode,
    encode,
)
from firmware_protocol.runs import pack_runs

VECTORS = FIRMWARE.parent / "vectors"
HELLO = encode(Hello(0x01020304))
byte = st.integers(0, 255)


Cores = Callable[[str], Core]
OPTIONS = {
    "": "",
    "control-each": "-DPD_CONTROL_EACH=1",
    "no-repeats": "-DPD_REPEATS=0",
    "reset-line": "-DPD_RESET_LINE=1",
    "without-a-store": "-DPD_STORE_SIZE=0",
    "long": "-DPD_MAX_PAYLOAD=1024 -DPD_RING_SIZE=2048",
}


@pytest.fixture(scope="module")
def cores(tmp_path_factory: pytest.TempPathFactory) -> Cores:
    """The core as built for one kind of device or another."""

    @functools.cache
    def core(kind: str) -> Core:
        build = tmp_path_factory.mktemp("build")
        return Core(made("host", "host/libpaneldraw.so", build, "cc", options=OPTIONS[kind]))

    return core


@pytest.fixture(scope="module")
def core(cores: Cores) -> Core:
    return cores("")


@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        ({}, ""),
        ({"PD_RING_SIZE": 500}, "PD_RING_SIZE must be a power of two"),
        ({"PD_RING_SIZE": 131072}, "PD_RING_SIZE must be a power of two up to 65536"),
        ({"PD_RING_SIZE": 0}, "PD_RING_SIZE must be a power of two"),
        ({"PD_RING_SIZE": 256}, "PD_RING_SIZE must hold a frame"),
        ({"PD_RING_SIZE": 256, "PD_MAX_PAYLOAD": 186}, ""),
        ({"PD_RING_SIZE": 256, "PD_MAX_PAYLOAD": 187}, "PD_RING_SIZE must hold a frame"),
        ({"PD_RING_SIZE": 65536}, ""),
        ({"PD_MAX_PAYLOAD": 31}, "PD_MAX_PAYLOAD must be 32 to 1024"),
        ({"PD_MAX_PAYLOAD": 1025, "PD_RING_SIZE": 4096}, "PD_MAX_PAYLOAD must be 32 to 1024"),
        ({"PD_MAX_PAYLOAD": 1024, "PD_RING_SIZE": 2048}, ""),
        ({"PD_MAX_PAYLOAD": 441}, ""),
        ({"PD_MAX_PAYLOAD": 442}, "PD_RING_SIZE must hold a frame"),
        ({"PD_TX_SIZE": 256}, "PD_TX_SIZE must be a power of two up to 128"),
        ({"PD_TX_SIZE": 100}, "PD_TX_SIZE must be a power of two up to 128"),
        ({"PD_TX_SIZE": 64}, "hello_reply_fits"),
        ({"PD_STORE_SIZE": 0}, ""),
        ({"PD_STORE_SIZE": 32768}, "PD_STORE_SIZE must be 0 to 32767"),
        ({"PD_FRAME_LINE": 1}, ""),
        ({"PD_BUS": 3}, "PD_BUS must be"),
        ({"PD_BUS": "PD_BUS_IS_SPI", "PD_CONTROL_EACH": 1}, "PD_CONTROL_EACH must be 0 on SPI"),
    ],
)
def test_a_port_that_cannot_work_does_not_compile(tmp_path: Path, wrong: dict[str, object], complaint: str) -> None:
    if not shutil.which("cc"):
        pytest.skip("cc is not installed")
    changes = "".join(f"#undef {name}\n#define {name} {value}\n" for name, value in wrong.items())
    (tmp_path / "port.h").write_text(f'#include "{FIRMWARE}/host/port.h"\n{changes}')
    folders = [f"-I{tmp_path}", f"-I{FIRMWARE}/core"]
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-fsyntax-only", *folders, f"{FIRMWARE}/core/link.c"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (done.returncode == 0) == (complaint == ""), done.stderr
    assert complaint in done.stderr


def conversations() -> dict[str, list[str]]:
    text = (VECTORS / "conversations.txt").read_text()
    return {name: lines for name, *lines in (part.splitlines() for part in text.split("# ")[1:])}


def happens(core: Core, what: str) -> list[str]:
    """Let something happen to a core; return the lines of what it does then."""
    name, _, value = what.partition(" ")
    if name == "start":
        return [f"< {core.start(2, int(value)).hex()}"]
    if name == "wait":
        core.now += int(value)
        assert core.receive(b"") == b""
        return [f"= {content.hex()}" for content in core.transactions()]
    if name == "reads":
        core.gives(int(value, 16))
    else:
        core.panel(gone=name == "gone")
    return []


@pytest.mark.parametrize("name", conversations())
def test_the_core_holds_the_golden_conversations(cores: Cores, name: str) -> None:
    lines = conversations()[name]
    core = cores(lines[0][2:] if lines[0].startswith(":") else "")
    core.start()
    held: list[str] = []
    for line in lines:
        mark, _, text = line.partition(" ")
        if mark not in ">!:":
            continue
        held.append(line)
        rate, resets = core.baudrate, core.resets
        if mark == "!":
            did = happens(core, text)
            held += ["^"] * (text.startswith("start") and core.resets) + did
        for value in bytes.fromhex(text) if mark == ">" else b"":
            answer = core.receive(bytes((value,)))
            held += ["^"] * (core.resets - resets)
            resets = core.resets
            held += [f"= {content.hex()}" for content in core.transactions()]
            held += [f"< {answer.hex()}"] * bool(answer)
        if core.baudrate != rate:
            held.append(f"@ {core.baudrate}")
    assert held == [line.replace("~", "<") for line in lines]


def test_the_core_takes_the_golden_frames_for_whole(cores: Cores) -> None:
    core = cores("long")
    core.start()
    for line in (VECTORS / "frames.txt").read_text().splitlines():
        core.receive(bytes.fromhex(line.split()[3]))
    core.receive(HELLO)
    assert status(core).damaged == 0


def status(device: Core | Device) -> Status:
    *_, frame = FrameDecoder().feed(device.receive(b"\0" + encode(Poll(1))))
    assert frame is not None
    message = decode(frame)
    assert isinstance(message, Status)
    return message


RUNS = st.lists(st.tuples(st.booleans(), st.binary(min_size=1, max_size=80)), max_size=3)
SEQ = st.integers(0, 5)
SMALL = st.integers(0, 3)
KEPT = st.builds(
    lambda runs, seconds: pack_cycle([[(True, bytes((n,))), *runs] for n in range(len(seconds))], seconds),
    RUNS,
    st.lists(st.sampled_from([0.001, 0.1, 0.2]), min_size=1, max_size=3),
)
PIECES = st.one_of(
    st.builds(lambda n: encode(Hello(n)), st.integers(0, 3)),
    st.builds(lambda n, a, b: encode(Hello(n, a, b)), st.integers(0, 3), st.integers(0, 3), st.integers(0, 3)),
    st.builds(lambda n, bits: encode(Hello(n, features=bits)), st.integers(0, 3), st.integers(0, 0xFFFF)),
    st.builds(lambda t: encode(Poll(t)), byte),
    st.builds(lambda t: encode(Read(t)), byte),
    st.builds(lambda s, runs, end: encode(Write(s, b"".join(pack_runs(runs, 250)), end)), SEQ, RUNS, st.booleans()),
    st.builds(lambda s, p: encode(Write(s, p)), SEQ, st.binary(max_size=30)),
    st.builds(lambda s, r: encode(Baud(s, r)), SEQ, st.sampled_from([115200, 500000, 9600])),
    st.builds(lambda s, p: encode(Reset(s, p)), SEQ, st.booleans()),
    st.builds(lambda s, at, content: encode(Store(s, at, content)), SEQ, st.integers(0, 900), st.binary(max_size=30)),
    st.builds(lambda s, kept: encode(Store(s, 0, kept)), SEQ, KEPT),
    st.builds(lambda s, kept, n: encode(Cycle(s, len(kept), n)), SEQ, KEPT, SMALL),
    st.builds(encode_frame, byte, SEQ, st.binary(max_size=12)),
    st.builds(encode_frame, st.just(0x10), SEQ, st.binary(min_size=240, max_size=260)),
    st.binary(max_size=40),
    st.just(b"\0"),
)


@examples(6)
@given(
    st.lists(st.tuples(PIECES, st.sampled_from(["", "", "", "cut", "flip", "gone", "back", "wait", "line error"]))),
    st.data(),
)
def test_the_core_does_what_the_reference_does(core: Core, work: list[tuple[bytes, str]], data: st.DataObject) -> None:
    written: list[bytes] = []
    gone = False
    now = 0

    def write(content: bytes) -> None:
        if gone:
            raise OSError(121, "Remote I/O error")
        if content:
            written.append(content)

    def read() -> int:
        if gone:
            raise OSError(121, "Remote I/O error")
        return 0x43

    device = Device(write, read=read, clock=lambda: now / 1000)
    assert core.start() == b"\0" + encode(Boot(1, 1))
    core.gives(0x43)
    for piece, what in [(HELLO, ""), *work]:
        if what in ("cut", "flip") and len(piece) > 1:
            at = data.draw(st.integers(0, len(piece) - 2))
            piece = piece[:at] + (b"" if what == "cut" else bytes((piece[at] ^ 0x41,))) + piece[at + 1 :]
        elif what in ("gone", "back"):
            gone = what == "gone"
            core.panel(gone=gone)
        elif what == "wait":
            now = core.now = now + data.draw(st.sampled_from([100, 299, 300, 999, 1000, 1499, 1500]))
            device.tick()
            core.receive(b"")
            assert core.transactions() == written
            written.clear()
        elif what == "line error":
            device.line_error()
            core.c.host_line_error()
            core.receive(b"")
        for value in piece:
            assert core.receive(bytes((value,))) == device.receive(bytes((value,)))
            assert core.transactions() == written
            assert core.baudrate == device.baudrate
            written.clear()


@examples(1.2)
@given(st.lists(RUNS.filter(bool), min_size=1, max_size=3))
def test_frames_that_come_while_the_bus_is_busy_wait_their_turn(core: Core, work) -> None:
    core.start()
    core.receive(HELLO)
    core.panel(slow=True)
    sent = b"".join(encode(Write(n, b"".join(pack_runs(runs, 250)))) for n, runs in enumerate(work))
    answers = core.receive(sent)
    assert answers == b""
    while True:
        while core.c.host_bus_step():
            pass
        answer = core.receive(b"")
        if not answer:
            break
        answers += answer
    wanted: list[bytes] = []
    reference = Device(wanted.append)
    reference.receive(HELLO)
    reference.receive(sent)
    assert core.transactions() == [content for content in wanted if content]
    assert [frame.seq for frame in FrameDecoder().feed(answers) if frame] == list(range(len(work)))


def test_a_stuck_bus_ends_in_a_fault(core: Core) -> None:
    core.start()
    core.receive(HELLO)
    core.panel(slow=True, stuck=True)
    assert core.receive(encode(Write(0, b"\x00\xff"))) == b""
    core.now += 24
    assert core.receive(b"") == b""
    core.now += 1
    (frame,) = FrameDecoder().feed(core.receive(b""))
    assert frame is not None
    assert decode(frame).fault is Fault.BUS_STUCK
    core.panel()
    core.receive(encode(Reset(1)))
    core.receive(encode(Write(2, b"\x00\xff")))
    assert core.transactions() == [b"\x40\xff"]


def test_more_than_the_ring_holds_is_counted_and_harmless(core: Core) -> None:
    core.start()
    core.receive(HELLO)
    core.panel(slow=True)
    core.receive(encode(Write(0, b"\x00\xff")) + encode(Write(1, b"\x00\xfe")) + bytes(range(1, 256)) * 3)
    while core.c.host_bus_step() or core.receive(b""):
        pass
    core.panel()
    assert status(core).overflows > 0
    core.receive(encode(Write(2, b"\x00\xfd")))
    assert core.transactions() == [b"\x40\xff", b"\x40\xfe", b"\x40\xfd"]
