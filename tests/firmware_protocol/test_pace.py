"""How updates are cut into frames: in time, and within what the device takes."""

from __future__ import annotations

import math
import random
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from simulated import Noise, SimulatedPort, whole

from firmware_protocol import HostLink
from firmware_protocol.device import UNO
from firmware_protocol.frames import FRAME_OVERHEAD, wire_size
from firmware_protocol.messages import Kind
from firmware_protocol.pace import BUS_BYTE, LEAST_PATIENCE, Pace, RoundTrip, Work
from firmware_protocol.runs import LEAST_PAYLOAD, bus_bytes, most_bus_bytes, pack_runs, unpack_runs

RATES = (57_600, 115_200, 230_400, 500_000)
RUNS = st.lists(
    st.tuples(st.booleans(), st.binary(min_size=1, max_size=90) | st.builds(bytes, st.integers(1, 300))), max_size=8
)


def seconds(payloads: list[bytes], rate: int) -> float:
    """Return when the panel's bus has written all: a frame's content when it is there whole, one after the other."""
    there = done = 0.0
    for payload in payloads:
        there += (len(payload) + FRAME_OVERHEAD) * 10 / rate
        done = max(done, there) + BUS_BYTE * bus_bytes(unpack_runs(payload))
    return done


@given(st.integers(1, 140), st.sampled_from(RATES), st.booleans())
def test_no_way_to_cut_an_update_in_two_is_faster(size: int, rate: int, alike: bool) -> None:
    content = bytes(size) if alike else random.Random(size).randbytes(size)
    payloads = [payload for _, payload in Pace(UNO, rate).writes([(True, content)], True)]
    cuts = ([content], *([content[:at], content[at:]] for at in range(1, size)))
    best = min(seconds([packed for part in cut for packed in pack_runs([(True, part)], 250)], rate) for cut in cuts)
    # What would save less than a frame's envelope is left whole; a cut adds a header or two.
    spare = 2 if len(payloads) > 1 else FRAME_OVERHEAD + 2
    assert seconds(payloads, rate) <= best + spare * 10 / rate


def written(messages: list[Work], kind: bool) -> bytes:
    return b"".join(content for _, payload in messages for is_data, content in unpack_runs(payload) if is_data == kind)


@given(RUNS, st.sampled_from(RATES), st.booleans(), st.lists(st.booleans(), max_size=6))
def test_whatever_the_pace_all_is_sent_once_and_ends_once(runs, rate: int, end: bool, losses: list[bool]) -> None:
    pace = Pace(UNO, rate)
    messages = pace.writes(runs, end)
    for lost in losses:
        if lost:
            pace.slow_down()
        else:
            pace.speed_up(20)
        messages = [piece for message in messages for piece in pace.again(message)]
        assert all(len(payload) <= pace.payload for _, payload in messages)
    for kind in (False, True):
        assert written(messages, kind) == b"".join(content for is_data, content in runs if is_data == kind)
    ends = [kind == Kind.WRITE_END for kind, _ in messages]
    assert ends == [False] * (len(messages) - 1) + [end] * bool(messages)


@given(
    st.integers(LEAST_PAYLOAD, 300), st.integers(wire_size(LEAST_PAYLOAD), 600), st.lists(st.integers(0, 40)),
    st.sampled_from(RATES),
)  # fmt: skip
def test_a_device_never_gets_more_than_it_takes(most: int, window: int, arrived: list[int], rate: int) -> None:
    pace = Pace(replace(UNO, max_payload=most, window=window), rate)
    for count in arrived:
        if count:
            pace.speed_up(count)
        else:
            pace.slow_down()
        assert LEAST_PAYLOAD <= pace.payload <= most
        assert wire_size(pace.payload) <= pace.window <= window


@pytest.mark.parametrize("window", [wire_size(LEAST_PAYLOAD), 90])
def test_the_smallest_devices_get_pictures_over_a_noisy_line(window: int) -> None:
    profile = replace(UNO, max_payload=LEAST_PAYLOAD, window=window)
    port = SimulatedPort(profile=profile, noise=Noise(0.001, 0.001, 0.001), seed=1)
    port.ring = window + 40 + 1
    link = HostLink(port, clock=port.clock, timeout=10.0)
    rng = random.Random(1)
    for _ in range(5):
        picture = rng.randbytes(1024)
        link.write(whole(picture))
        assert port.panel.ram == picture
    assert link.stats.resent > 0
    assert port.device.counters.overflows == 0


# How long an answer may take


def test_patience_is_the_mean_and_four_deviations() -> None:
    trip = RoundTrip()
    assert trip.most == math.inf
    trip.took(0.1)
    assert trip.most == pytest.approx(0.1 + 4 * 0.05)
    trip.took(0.1)
    assert trip.most == pytest.approx(0.1 + 4 * 0.0375)
    trip.took(0.18)
    assert trip.most == pytest.approx(0.11 + 4 * (0.0375 * 3 / 4 + 0.08 / 4))
    for _ in range(100):
        trip.took(-0.001)
    assert trip.most == LEAST_PATIENCE


@given(RUNS)
def test_the_bus_never_carries_more_than_is_waited_for(runs) -> None:
    for payload in pack_runs(runs, 250):
        assert bus_bytes(unpack_runs(payload)) <= most_bus_bytes(payload)
