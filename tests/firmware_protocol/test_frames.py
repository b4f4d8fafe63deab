"""Frames, messages and tokens: there and back, whatever the bytes."""

from __future__ import annotations

import re
from binascii import crc_hqx
from importlib import resources
from itertools import groupby
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import firmware_protocol
from firmware_protocol.device import UNO
from firmware_protocol.frames import Frame, FrameDecoder, encode_frame, wire_size
from firmware_protocol.messages import (
    Ack,
    Baud,
    Boot,
    Fault,
    Hello,
    Kind,
    Message,
    Nak,
    NakReason,
    Poll,
    Reset,
    Status,
    Write,
    decode,
    encode,
)
from firmware_protocol.runs import LEAST_PAYLOAD, bus_bytes, cut_runs, pack_runs, unpack_runs
from firmware_protocol.vectors import generate

HERE = Path(str(resources.files(firmware_protocol)))
byte = st.integers(0, 255)
short = st.integers(0, 0xFFFF)
MESSAGES = st.one_of(
    st.builds(Hello, st.integers(0, 2**32 - 1), byte, byte),
    st.builds(Poll, byte),
    st.builds(Write, byte, st.binary(max_size=250), st.booleans()),
    st.builds(Baud, byte, st.integers(0, 2**32 - 1)),
    st.builds(Reset, byte, st.booleans()),
    st.builds(Status, byte, byte, st.sampled_from(Fault), short, short, short, short),
    st.builds(Boot, short, byte),
    st.builds(Ack, byte, st.sampled_from(Fault)),
    st.builds(Nak, byte, st.sampled_from(NakReason)),
    st.just(UNO),
)
RUNS = st.lists(
    st.tuples(st.booleans(), st.binary(min_size=1, max_size=400) | st.builds(bytes, st.integers(1, 400))), max_size=12
)


@given(st.lists(st.builds(Frame, byte, byte, st.binary(max_size=1024)), max_size=5), st.randoms(use_true_random=False))
def test_frames_come_back_however_the_stream_is_cut(frames: list[Frame], random) -> None:
    stream = b"".join(encode_frame(*frame) for frame in frames)
    cuts = sorted(random.sample(range(len(stream) + 1), min(len(stream), 4)))
    decoder = FrameDecoder()
    found = [f for a, b in zip([0, *cuts], [*cuts, len(stream)], strict=True) for f in decoder.feed(stream[a:b])]
    assert found == frames


@given(st.binary(max_size=2000))
def test_wire_size_is_the_size_on_the_wire(payload: bytes) -> None:
    assert len(encode_frame(1, 2, bytes(b or 1 for b in payload))) <= wire_size(len(payload))
    assert len(encode_frame(1, 2, payload)) >= len(payload) + 6


@given(st.lists(st.binary(max_size=300), max_size=8))
def test_any_bytes_leave_the_decoder_bounded_and_ready(chunks: list[bytes]) -> None:
    decoder = FrameDecoder(max_payload=64)
    for chunk in chunks:
        decoder.feed(chunk)
        assert decoder.held <= wire_size(64)
    decoder.feed(b"\0")
    assert decoder.feed(encode_frame(2, 3, b"x")) == [Frame(2, 3, b"x")]


@given(st.builds(Frame, byte, byte, st.binary(max_size=200)), st.data())
def test_one_changed_byte_is_never_taken_for_the_frame(frame: Frame, data: st.DataObject) -> None:
    wire = bytearray(encode_frame(*frame))
    wire[data.draw(st.integers(0, len(wire) - 2))] ^= data.draw(st.integers(1, 255))
    assert frame not in FrameDecoder().feed(bytes(wire))


@given(MESSAGES)
def test_messages_come_back(message: Message) -> None:
    (frame,) = FrameDecoder().feed(encode(message))
    assert frame is not None
    assert decode(frame) == message


@given(st.builds(Frame, st.sampled_from([*Kind, 0x00, 0x1F, 0x99]), byte, st.binary(max_size=80)))
def test_any_payload_is_a_message_or_a_value_error(frame: Frame) -> None:
    try:
        message = decode(frame)
    except ValueError:
        return
    again = encode(message)
    (back,) = FrameDecoder().feed(again)
    assert back is not None
    assert decode(back) == message


@given(RUNS, st.integers(LEAST_PAYLOAD, 250), st.booleans())
def test_runs_come_back_in_payloads_within_the_limit(runs, limit: int, repeats: bool) -> None:
    payloads = pack_runs(runs, limit, repeats=repeats)
    assert all(0 < len(p) <= limit for p in payloads)
    for wanted in (False, True):
        sent = b"".join(content for is_data, content in runs if is_data == wanted)
        came = b"".join(content for p in payloads for is_data, content in unpack_runs(p) if is_data == wanted)
        assert came == sent
    kinds = "".join("dc"[not k] for k, _ in runs)
    came_kinds = "".join("dc"[not k] for p in payloads for k, _ in unpack_runs(p))
    assert re.sub(r"(.)\1+", r"\1", came_kinds) == re.sub(r"(.)\1+", r"\1", kinds)


@given(RUNS, st.integers(LEAST_PAYLOAD, 250), st.integers(0, 250), st.booleans())
def test_runs_that_are_chip_selects_stay_whole_and_apart(runs, limit: int, more: int, repeats: bool) -> None:
    whole = limit + more
    payloads = pack_runs(runs, limit, repeats=repeats, whole=whole)
    assert all(0 < len(p) <= whole for p in payloads)
    came = [run for p in payloads for run in unpack_runs(p)]
    for is_data, content in runs:
        pieces = [came.pop(0)]
        fits = len(pack_runs([(is_data, content)], whole, repeats=repeats)) == 1
        while not fits and len(b"".join(piece for _, piece in pieces)) < len(content):
            pieces.append(came.pop(0))
        assert {kind for kind, _ in pieces} == {is_data}
        assert b"".join(piece for _, piece in pieces) == content
    assert came == []


@given(st.lists(st.binary(min_size=1, max_size=3), min_size=1, max_size=60), st.integers(LEAST_PAYLOAD, 250))
def test_keeping_small_runs_whole_costs_hardly_a_frame(contents: list[bytes], limit: int) -> None:
    runs = [(at % 2 == 1, content) for at, content in enumerate(contents)]
    unfilled = 4  # a run of three bytes did not fit any more
    least = -(-sum(map(len, pack_runs(runs, 250))) // (limit - unfilled))
    assert len(pack_runs(runs, limit, whole=250)) <= least + 1


@given(st.binary(min_size=1, max_size=600), st.booleans())
def test_packing_never_costs_more_than_literals(content: bytes, doubled: bool) -> None:
    content = bytes(b for b in content for _ in range(1 + 3 * doubled))
    plain = sum(map(len, pack_runs([(True, content)], 250, repeats=False)))
    assert sum(map(len, pack_runs([(True, content)], 250))) <= plain


def fewest(content: bytes) -> int:
    """Return the bytes of the shortest string of literals and repeats that stands for the content."""
    least = [0]
    for start in range(len(content) - 1, -1, -1):
        rest = content[start:]
        literals = [1 + size + least[size - 1] for size in range(1, len(rest) + 1)]
        equal = next((at for at, value in enumerate(rest) if value != rest[0]), len(rest))
        least.insert(0, min([*literals, *(2 + least[size - 1] for size in range(2, min(equal, 65) + 1))]))
    return least[0]


@given(st.lists(st.tuples(st.integers(0, 3), st.sampled_from((1, 1, 2, 2, 3, 4, 64, 65, 66, 67)))))
def test_packing_is_the_shortest_there_is(stretches: list[tuple[int, int]]) -> None:
    content = b"".join(bytes((value,)) * times for value, times in stretches)[:128]
    spare = sum(map(len, pack_runs([(True, content)], 250))) - fewest(content)
    # Of 66 equal bytes the last follows the repeat, where the first before it would sometimes be cheaper.
    assert 0 <= spare <= (66 in [len(list(equal)) for _, equal in groupby(content)])


@given(st.binary(max_size=250))
def test_any_write_payload_unpacks_or_is_a_value_error(payload: bytes) -> None:
    try:
        runs = unpack_runs(payload)
    except ValueError:
        return
    assert sum(len(content) for _, content in runs) <= 65 * len(payload)


def test_runs_may_be_views() -> None:
    content = bytes(range(50)) + bytes(300)
    runs = [(False, content[:9]), (True, content)]
    assert pack_runs([(kind, memoryview(part)) for kind, part in runs], 99) == pack_runs(runs, 99)


def test_commands_of_one_run_stay_in_one_payload() -> None:
    runs = [(True, bytes(range(60))), (False, bytes(range(40)))]
    first, second = pack_runs(runs, 100)
    assert unpack_runs(first) == runs[:1]
    assert unpack_runs(second) == runs[1:]


def test_a_limit_that_holds_no_command_token_is_refused() -> None:
    with pytest.raises(ValueError, match="limit"):
        pack_runs([], LEAST_PAYLOAD - 1)


def test_one_changed_pixel_costs_11_bytes() -> None:
    (payload,) = pack_runs([(False, bytes.fromhex("b00810")), (True, b"\xff")], 250)
    assert len(encode(Write(0, payload))) == 11


def test_the_vectors_are_those_of_the_code() -> None:
    assert (HERE / "vectors/frames.txt").read_text() == generate.frames()
    assert (HERE / "vectors/conversations.txt").read_text() == generate.transcript()


def test_the_examples_of_the_contract_are_frames() -> None:
    text = (HERE / "PROTOCOL.md").read_text()
    rows = re.findall(r"^\| (host|device) \| `([0-9a-f ]+)` \| (\w+)", text, re.MULTILINE)
    assert len(rows) >= 10
    for side, wire, name in rows:
        (frame,) = FrameDecoder().feed(bytes.fromhex(wire))
        assert frame is not None, wire
        assert Kind(frame.kind).name == name
        assert (frame.kind < 0x80) == (side == "host")
        assert encode(decode(frame)) == bytes.fromhex(wire).lstrip(b"\0")


def test_the_worked_frame_of_the_contract() -> None:
    text = (HERE / "PROTOCOL.md").read_text()
    assert f"`123456789` is {crc_hqx(b'123456789', 0xFFFF):04X}" in text
    assert f"84 00 00 have the checksum {crc_hqx(bytes.fromhex('840000'), 0xFFFF):04X}" in text
    assert "`02 84`, `01`, `03 2B 06`, and the delimiter `00`" in text
    assert encode(Ack(0)) == bytes.fromhex("02 84 01 03 2B 06 00")


def test_the_token_example_of_the_contract() -> None:
    text = (HERE / "PROTOCOL.md").read_text()
    assert "`92 B0 08 10 01 02` is three command bytes, B0 08 10, and two data bytes, 01 02" in text
    assert unpack_runs(bytes.fromhex("92 B0 08 10 01 02")) == [(False, b"\xb0\x08\x10"), (True, b"\1\2")]


def test_the_contract_lists_every_message_and_fault() -> None:
    text = (HERE / "PROTOCOL.md").read_text()
    for kind in Kind:
        assert re.search(rf"^\| {kind:02x} \| {kind.name} \|", text, re.MULTILINE | re.IGNORECASE), kind
    for fault in Fault:
        assert re.search(rf"^\| {fault:02d} \| \w", text, re.MULTILINE), fault


@given(RUNS, st.integers(0, 900))
def test_a_cut_loses_nothing_and_keeps_commands_whole(runs, size: int) -> None:
    before, after = cut_runs(runs, size)
    pieces = {kind: b"".join(content for k, content in before + after if k == kind) for kind in (False, True)}
    assert pieces == {kind: b"".join(content for k, content in runs if k == kind) for kind in (False, True)}
    commands = [content for is_data, content in runs if not is_data]
    assert [content for is_data, content in before + after if not is_data] == commands
    assert not before or before[-1][0]
    assert not before or bus_bytes(before) <= size
