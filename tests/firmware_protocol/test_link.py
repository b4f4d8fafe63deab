"""The host's side against the reference device, in simulated time."""

from __future__ import annotations

import itertools
import random
import tracemalloc
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples
from simulated import Noise, SimulatedPort, whole

from firmware_protocol import (
    DeviceResetError,
    Fault,
    Feature,
    HostLink,
    LinkError,
    LinkLostError,
    LinkTimeoutError,
    NoDeviceError,
    PanelFaultError,
    VersionError,
)
from firmware_protocol.device import UNO
from firmware_protocol.frames import Frame, FrameDecoder
from firmware_protocol.messages import Ack, Boot, HelloReply, Nak, PanelBus, Status, encode

EACH = 0.001
NOISES = {
    "flipped": Noise(flip=EACH),
    "dropped": Noise(drop=EACH),
    "inserted": Noise(insert=EACH),
    "together": Noise(EACH, EACH, EACH),
}


def joined(port: SimulatedPort, **options) -> HostLink:
    return HostLink(port, clock=port.clock, **options)


def screens(count: int, seed: int = 1) -> list[bytes]:
    rng = random.Random(seed)
    return [rng.randbytes(1024) for _ in range(count)]


def cost(port: SimulatedPort, link: HostLink, pictures: list[bytes]) -> float:
    before = port.carried
    for picture in pictures:
        link.write(whole(picture))
        assert port.panel.ram == picture
    return (port.carried - before) / len(pictures)


@pytest.mark.parametrize("baudrate", [115_200, 500_000, 1_000_000])
def test_pictures_arrive_and_nothing_overflows(baudrate: int) -> None:
    port = SimulatedPort()
    link = joined(port, baudrate=baudrate)
    assert link.baudrate == port.device.baudrate == baudrate
    assert cost(port, link, screens(5)) < 1024 / 0.85
    assert port.device.pictures == 5
    seen = link.status()
    assert (seen.damaged, seen.overflows, seen.line_errors) == (0, 0, 0)
    assert link.stats.resent == link.stats.timeouts == 0


@pytest.mark.parametrize("name", NOISES)
@pytest.mark.parametrize("baudrate", [115_200, pytest.param(500_000, marks=pytest.mark.thorough)])
def test_a_noisy_line_costs_bytes_and_no_picture(name: str, baudrate: int) -> None:
    clean = SimulatedPort()
    per_picture = cost(clean, joined(clean, baudrate=baudrate), screens(3))
    port = SimulatedPort(noise=NOISES[name], seed=3)
    link = joined(port, baudrate=baudrate)
    assert cost(port, link, screens(25)) < 2.2 * per_picture
    assert link.stats.resent > 0
    assert port.device.counters.overflows == 0


@examples(0.6)
@given(
    st.integers(0, 2**31),
    st.builds(Noise, *[st.floats(0, 0.003)] * 3),
    st.lists(st.lists(st.tuples(st.booleans(), st.integers(1, 300), st.booleans()), max_size=6), max_size=4),
)
def test_the_panel_gets_every_run_once_and_in_order(seed: int, noise: Noise, work) -> None:
    port = SimulatedPort(noise=noise, seed=seed)
    came: dict[int, bytearray] = {0x00: bytearray(), 0x40: bytearray()}
    port.panel = lambda content: content and came[content[0]].extend(content[1:])
    sent: dict[int, bytearray] = {0x00: bytearray(), 0x40: bytearray()}
    rng = random.Random(seed)
    link = joined(port, timeout=30.0)
    for runs in work:
        made = [(d, bytes(size) if flat else rng.randbytes(size)) for d, size, flat in runs]
        for is_data, content in made:
            sent[0x40 * is_data].extend(content)
        link.submit(made)
    link.drain()
    assert came == sent


def test_unacknowledged_bytes_stay_within_the_window() -> None:
    port = SimulatedPort(profile=replace(UNO, window=100, max_payload=60))
    port.ring = 101
    link = joined(port)
    link.write(whole(bytes(range(256)) * 4))
    assert port.device.counters.overflows == 0
    assert port.panel.ram == bytes(range(256)) * 4


def test_a_device_without_repeats_gets_none() -> None:
    port = SimulatedPort(profile=replace(UNO, repeats=False))
    link = joined(port)
    link.write(whole(bytes(1024)))
    assert link.stats.bytes_sent > 1024


def test_acknowledgements_twice_late_and_out_of_order_do_no_harm() -> None:
    port = SimulatedPort()
    held: list[bytes] = []

    def shuffle(replies: bytes) -> bytes:
        frames = [part + b"\0" for part in replies.split(b"\0")[:-1]]
        held.extend(frames)
        if len(held) < 3:
            return b"".join(frames)
        out = [held[2], held[0], held[2], held[1], *frames]
        held.clear()
        return b"".join(out)

    link = joined(port)
    port.mangle = shuffle
    cost(port, link, screens(20))


def test_lost_acknowledgements_are_asked_for() -> None:
    port = SimulatedPort()
    link = joined(port)

    def swallow(replies: bytes) -> bytes:
        kinds = [frame.kind for frame in FrameDecoder().feed(replies) if frame]
        return b"" if 0x84 in kinds else replies

    port.mangle = swallow
    link.write([(True, b"\1")])
    assert link.stats.timeouts == 1
    assert port.device.counters.damaged == 0


@pytest.mark.parametrize("baudrate", [115_200, 500_000])
def test_a_lost_acknowledgement_is_asked_for_as_soon_as_it_is_overdue(baudrate: int) -> None:
    port = SimulatedPort()
    link = joined(port, baudrate=baudrate)
    link.write([(True, b"\1")])
    link.write([(True, bytes(8000))])  # 0.18 s on the bus, from which nothing follows for others
    for number in range(10):
        left = [b""]
        port.mangle = lambda replies, left=left: left.pop() if replies and left else replies
        start = port.now
        link.write([(True, bytes((number,)))])
        assert port.now - start < 0.02
    assert (link.stats.timeouts, link.stats.resent) == (10, 0)


@pytest.mark.parametrize("baudrate", [115_200, 1_000_000])
def test_a_slow_bus_is_waited_for(baudrate: int) -> None:
    port = SimulatedPort()
    port.bus_byte = 90e-6
    link = joined(port, baudrate=baudrate)
    for size in (1, 1, 1, 8000, 1, 8000):  # repeats: 250 bytes on the wire, 0.7 s on the bus
        link.write([(True, bytes(size))])
    cost(port, link, screens(3))
    assert (link.stats.timeouts, link.stats.resent) == (0, 0)


def test_answers_that_come_late_are_learned_from_and_lose_nothing() -> None:
    port = SimulatedPort()
    link = joined(port)
    cost(port, link, screens(3))
    assert link.stats.timeouts == 0
    rng = random.Random(2)
    port.late = lambda: rng.uniform(0.03, 0.06)
    cost(port, link, screens(4))
    learning = link.stats.timeouts
    cost(port, link, screens(10))
    assert 0 < learning < 8
    assert link.stats.timeouts == learning
    assert link.stats.resent == 0
    assert link.baudrate == 500_000


def test_a_reset_in_the_middle_fails_the_work_and_the_next_begins_anew() -> None:
    port = SimulatedPort()
    link = joined(port)

    def reset() -> None:
        port.waiting.clear()
        port.reply(port.device.reset(8), 115200)

    port.at(port.now + 0.01, reset)
    with pytest.raises(DeviceResetError, match="watchdog"):
        link.write(whole(screens(1)[0]))
    assert cost(port, link, screens(2)) > 0
    assert link.stats.sessions == 2
    assert link.device.cause == 8


def test_a_reset_that_nobody_heard_is_noticed_at_the_next_write() -> None:
    port = SimulatedPort()
    link = joined(port)
    port.device.reset(1)
    with pytest.raises(DeviceResetError):
        link.write([(True, b"\1")])
    link.write([(True, b"\1")])


def test_a_panel_that_goes_and_comes_back() -> None:
    port = SimulatedPort()
    link = joined(port)
    port.panel.gone = True
    for _ in range(2):
        with pytest.raises(PanelFaultError, match="0x3c") as caught:
            link.write(whole(screens(1)[0]))
        assert caught.value.fault == Fault.ADDRESS_NACK
    port.panel.gone = False
    cost(port, link, screens(2))
    assert link.stats.timeouts == 0
    assert link.stats.sessions == 1


def test_the_handshake_says_whether_the_panel_answers() -> None:
    port = SimulatedPort()
    port.panel.gone = True
    assert not joined(port).device.present
    port.panel.gone = False
    assert joined(port).device.present


@pytest.mark.parametrize(
    ("profile", "advice"),
    [(replace(UNO, oldest=7, newest=9), "update paneldraw"), (replace(UNO, oldest=0, newest=0), "update the board's")],
)
def test_versions_that_have_nothing_in_common(profile: HelloReply, advice: str) -> None:
    with pytest.raises(VersionError, match=advice):
        joined(SimulatedPort(profile=profile))


def test_a_newer_device_that_still_speaks_ours() -> None:
    assert joined(SimulatedPort(profile=replace(UNO, newest=9))).device.version == 1


class Other(SimulatedPort):
    """A port with something else on it."""

    def __init__(self, answer) -> None:
        super().__init__()
        self.answer = answer

    def write(self, data: bytes) -> int:
        self.reply(self.answer(data), self.baudrate)
        return len(data)


@pytest.mark.parametrize(
    ("answer", "says"),
    [
        (lambda data: b"", "nothing answers"),
        (lambda data: b"$GPGGA,123519,4807.038,N,01131.000,E,1,08\r\n", "something talks"),
        (lambda data: bytes(random.Random(len(data)).randbytes(5000)), "something talks"),
        (lambda data: data, "loop-back"),
    ],
)
def test_a_port_that_is_no_panel(answer, says: str) -> None:
    port = Other(answer)
    with pytest.raises(NoDeviceError, match=says):
        joined(port)
    assert port.now < 4


@examples(3)
@given(st.randoms(use_true_random=False), st.integers(0, 255))
def test_whatever_a_device_says_ends_in_a_link_error_or_well(random: random.Random, manners: int) -> None:
    """The device answers each frame with messages of any content, garbage, or nothing."""

    def number(bits: int) -> int:
        return random.choice([0, 1, 33, (1 << bits) - 1, random.getrandbits(bits)])

    def anything(frame: Frame | None) -> bytes:
        kind = random.choice(["ack", "status", "nak", "boot", "garbage", "nothing", "hello"])
        seq = frame.seq if frame and random.random() < 0.7 else number(8)
        fault = random.choice([Fault.NONE, Fault.NONE, *Fault])
        if kind == "nothing" or (frame and frame.kind == 1 and random.random() < 0.8) or kind == "hello":
            nonce = int.from_bytes(frame.payload[:4], "little") if frame and frame.kind == 1 else number(32)
            sizes = [random.choice([250, number(16)]), random.choice([464, number(16)]), number(16), number(16)]
            rates = tuple(random.choice([115_200, 500_000, number(32)]) for _ in range(random.randrange(4)))
            version = random.choice([1, 1, 1, 0, number(8)])
            return encode(HelloReply(nonce, version, 1, 1, 0, 0, PanelBus.I2C, 60, *[True] * 4, *sizes, rates, "x", ""))
        return {
            "ack": encode(Ack(seq, fault)),
            "status": encode(Status(seq, number(8), fault)),
            "nak": encode(Nak(seq)),
            "boot": encode(Boot(number(16), number(8))) if random.random() < 0.1 else b"",
            "garbage": random.randbytes(random.randrange(400)),
        }[kind]

    decoder = FrameDecoder()
    port = Other(lambda data: b"".join(anything(f) for f in decoder.feed(data) if manners or random.random() < 0.9))
    start = port.now
    try:
        link = joined(port)
        for _ in range(4):
            link.write([(True, random.randbytes(random.randrange(700)))])
        link.status()
        link.close()
    except LinkError:
        pass
    assert port.now - start < 400


@pytest.mark.parametrize(
    "talk",
    [
        *(b"\xff", b"\0", encode(HelloReply(1))),
        *(pytest.param(talk, marks=pytest.mark.thorough) for talk in (b"\1\0", encode(Status(0, 0)), encode(Ack(0)))),
    ],
)
def test_a_port_that_never_stops_talking_takes_no_memory(talk: bytes) -> None:
    class Torrent(Other):
        in_waiting = 1 << 30

        def read(self, size: int = 1) -> bytes:
            self.now += size / 200_000
            return (talk * (size // len(talk) + 1))[:size]

    port = Torrent(lambda data: b"")
    tracemalloc.start()
    with pytest.raises(NoDeviceError):
        joined(port)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert port.now < 3.1
    assert peak < 2_000_000


def test_noise_before_the_handshake() -> None:
    port = SimulatedPort()
    port.device.receive(bytes(range(1, 256)) * 3)
    port.received += bytes(range(256)) * 20
    cost(port, joined(port), screens(1))


def test_a_device_that_falls_silent_is_given_up_in_bounded_time() -> None:
    port = SimulatedPort()
    link = joined(port)
    port.mangle = lambda replies: b""
    start = port.now
    with pytest.raises(LinkTimeoutError, match="stopped answering"):
        link.write([(True, b"\1")])
    assert port.now - start < 10
    port.mangle = lambda replies: replies
    cost(port, link, screens(1))


def test_a_line_that_passes_no_whole_picture_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("firmware_protocol.link.STALLED", 0.5)
    port = SimulatedPort()
    link = joined(port)
    carry = port.device.receive
    port.device.receive = lambda data: carry(b"\x80" if data == b"\x55" else data)
    with pytest.raises(LinkTimeoutError, match="noisy"):
        link.write([(True, b"\x55")])


class Unplugged(SimulatedPort):
    """A port that can be pulled out."""

    out = False

    def _check(self) -> None:
        if self.out:
            raise OSError(5, "Input/output error")

    def open(self) -> None:
        self._check()
        super().open()

    def write(self, data: bytes) -> int:
        self._check()
        return super().write(data)

    def read(self, size: int = 1) -> bytes:
        self._check()
        return super().read(size)


def test_a_port_pulled_out_and_put_back() -> None:
    port = Unplugged()
    link = joined(port)
    port.at(port.now + 0.02, lambda: setattr(port, "out", True))
    for _ in range(3):
        with pytest.raises(LinkLostError, match="plug"):
            link.write(whole(screens(1)[0]))
    port.out = False
    port.device.reset(1)
    cost(port, link, screens(2))
    assert link.stats.sessions == 2


def test_a_rate_that_is_not_offered() -> None:
    with pytest.raises(LinkError, match="9600 baud; it offers 500000"):
        joined(SimulatedPort(), baudrate=9600)


class Slow(SimulatedPort):
    """A port whose adapter cannot go fast: it says so, or it does not."""

    honest = True

    @property
    def baudrate(self) -> int:
        return self.rate

    @baudrate.setter
    def baudrate(self, rate: int) -> None:
        if rate > 115_200:
            if self.honest:
                raise OSError(22, "Invalid argument")
            rate = 300_000
        self.rate = rate


@pytest.mark.parametrize("honest", [True, False])
def test_an_adapter_that_cannot_do_the_rate_stays_at_the_first(honest: bool) -> None:
    port = Slow()
    port.honest = honest
    link = joined(port)
    assert link.baudrate == port.device.baudrate == 115_200
    cost(port, link, screens(2))


def test_a_device_left_at_another_rate_is_found() -> None:
    port = SimulatedPort()
    joined(port, baudrate=1_000_000)
    port.baudrate = 115_200
    assert port.device.baudrate == 1_000_000
    cost(port, joined(port), screens(1))


def test_close_leaves_the_device_at_its_first_rate_and_the_port_closed() -> None:
    port = SimulatedPort()
    with joined(port, baudrate=500_000) as link:
        link.write([(True, b"\1")])
    assert not port.is_open
    port.read()
    assert port.device.baudrate == 115_200
    link.close()
    with pytest.raises(LinkLostError, match="closed"):
        link.write([(True, b"\1")])


def test_the_answer_to_hello_is_read_whole() -> None:
    link = joined(SimulatedPort())
    assert (link.device.controller, link.device.width, link.device.height) == ("ssd1306", 128, 64)
    assert link.device.bauds == UNO.bauds
    assert 0 < link.ping() < 0.01


@pytest.mark.parametrize("baudrate", [0, -9600])
def test_a_rate_that_is_no_rate(baudrate: int) -> None:
    with pytest.raises(ValueError, match="baudrate"):
        joined(SimulatedPort(), baudrate=baudrate)


# What goes wrong heals at once


@pytest.mark.parametrize("damage", [b"\x84\x55\0", b"\x01\x02\0", b"\x03\x84\x05\x03\xd4\xf2\0"])
def test_a_damaged_acknowledgement_is_asked_for_at_once(damage: bytes) -> None:
    port = SimulatedPort()
    link = joined(port)
    left = [damage]
    port.mangle = lambda replies: left.pop() if left else replies
    start = port.now
    link.write([(True, b"\1")])
    assert port.now - start < 0.005
    assert (link.stats.timeouts, link.stats.resent) == (0, 0)


def test_a_line_that_brings_nothing_but_damage_is_not_asked_more_often_than_the_ring_bears() -> None:
    port = SimulatedPort()
    link = joined(port, timeout=10.0, baudrate=115_200)
    port.busy_until = port.now + 4.0
    polls = []
    write = port.write

    def counted(data: bytes) -> int:
        polls.extend(frame for frame in FrameDecoder().feed(data) if frame and frame.kind == 0x02)
        return write(data)

    port.write = counted  # type: ignore[method-assign]
    for at in range(200):
        port.at(port.now + at * 0.01, lambda: port.received.extend(b"\5\5\0"))
    link.write([(True, random.Random(1).randbytes(1024))])
    assert port.device.counters.overflows == 0
    assert 4 < len(polls) <= 9


@pytest.mark.parametrize("answered", [0, 1, 2])
def test_a_status_that_answers_any_poll_of_the_recovery_counts(answered: int) -> None:
    port = SimulatedPort()
    link = joined(port, timeout=10.0, baudrate=115_200)
    asked = 0

    def only_one(replies: bytes) -> bytes:
        nonlocal asked
        asked += 0x82 in [frame.kind for frame in FrameDecoder().feed(replies) if frame]
        if asked == answered + 1:  # comes when the next POLL has gone
            port.at(port.now + 1.1, lambda: port.received.extend(replies))
            port.mangle = lambda replies: b""
        return b""

    port.mangle = only_one
    link.write([(True, b"\1")])
    assert link.stats.timeouts >= answered + 2
    port.mangle = lambda replies: replies
    cost(port, link, screens(1))
    assert link.stats.sessions == 1


def test_one_acknowledgement_stands_for_several_frames() -> None:
    port = SimulatedPort()
    link = joined(port, baudrate=115_200)
    held: list[bytes] = []

    def merged(replies: bytes) -> bytes:
        held.extend([replies] * bool(replies))
        return replies if len(held) % 3 == 0 else b""

    port.mangle = merged
    for number in range(9):
        link.submit([(True, bytes((number,)))])
    link.drain()
    assert len(held) == 9
    assert (link.stats.timeouts, link.stats.resent) == (0, 0)


def lost_count(port: SimulatedPort) -> None:
    port.device._expected = 77


def another_start(port: SimulatedPort) -> None:
    port.device.boot = 9


@pytest.mark.parametrize("trouble", [lost_count, another_start])
def test_a_device_that_lost_count_is_asked_anew_at_the_rate_it_has(trouble) -> None:
    port = SimulatedPort()
    link = joined(port)
    cost(port, link, screens(1))
    trouble(port)
    with pytest.raises(DeviceResetError):
        link.status()
    start = port.now
    cost(port, link, screens(1))
    assert port.now - start < 0.1
    assert link.baudrate == port.device.baudrate == 500_000


def test_a_status_that_nobody_asked_for_does_no_harm() -> None:
    port = SimulatedPort()
    link = joined(port)
    link.write([(True, b"\1")])
    port.received += encode(Status(77, 99, Fault.DATA_NACK, boot=5))
    start = port.now
    cost(port, link, screens(1))
    assert port.now - start < 0.1
    assert link.stats.sessions == 1


# Rates that do not work, and work later


def refuses_rates(port: SimulatedPort) -> None:
    port.device._change_rate = lambda rate: port.device._fail(Fault.BAUD_NOT_OFFERED)  # type: ignore[method-assign]


def test_a_rate_that_the_device_refuses_after_all_is_gone_without_and_tried_again_later() -> None:
    port = SimulatedPort()
    change = port.device._change_rate
    refuses_rates(port)
    link = joined(port)
    assert link.baudrate == 115_200
    cost(port, link, screens(1))
    port.device._change_rate = change  # type: ignore[method-assign]
    port.now += 9
    cost(port, link, screens(1))
    assert link.baudrate == 115_200
    port.now += 2
    cost(port, link, screens(1))
    assert link.baudrate == port.device.baudrate == 500_000
    assert link.stats.sessions == 1


def test_a_rate_that_never_works_is_tried_ever_more_rarely() -> None:
    port = SimulatedPort()
    refuses_rates(port)
    tries: list[float] = []
    fail = port.device._change_rate
    port.device._change_rate = lambda rate: (tries.append(port.now), fail(rate))  # type: ignore[method-assign]
    link = joined(port)
    while port.now < 4000:
        port.now += 5
        link.write([(True, b"\1")])
    pauses = [later - before for before, later in itertools.pairwise(tries)]
    assert [round(pause, -1) for pause in pauses[:6]] == [10, 20, 40, 80, 160, 320]
    assert all(640 <= pause < 650 for pause in pauses[6:])
    assert len(pauses) > 8


def test_an_adapter_that_is_slow_for_a_while_becomes_fast() -> None:
    port = Slow()
    port.honest = False
    link = joined(port)
    assert link.baudrate == 115_200
    port.__class__ = SimulatedPort
    port.__dict__["baudrate"] = port.rate
    port.now += 11
    cost(port, link, screens(1))
    assert link.baudrate == port.device.baudrate == 500_000
    assert link.stats.sessions == 1


def test_a_restart_that_shows_when_a_rate_is_tried_again_fails_the_work() -> None:
    port = SimulatedPort()
    refuses_rates(port)
    link = joined(port)
    port.device.reset(1)
    port.now += 11
    with pytest.raises(DeviceResetError):
        link.write([(True, b"\1")])
    cost(port, link, screens(1))


def test_a_silence_at_a_fast_rate_ends_at_the_first_and_the_fast_one_comes_back() -> None:
    port = SimulatedPort()
    link = joined(port)
    port.mangle = lambda replies: b"" if port.device.baudrate > 115_200 else replies
    cost(port, link, screens(1))
    assert link.baudrate == port.device.baudrate == 115_200
    port.mangle = lambda replies: replies
    port.now += 11
    cost(port, link, screens(1))
    assert link.baudrate == port.device.baudrate == 500_000
    assert link.stats.sessions == 1


# Within the time that the caller has


@pytest.mark.parametrize("timeout", [0.3, 0.5, 1.0, 3.0])
@pytest.mark.parametrize("baudrate", [115_200, 500_000])
def test_the_timeout_bounds_a_call_to_a_device_that_is_silent(timeout: float, baudrate: int) -> None:
    port = SimulatedPort()
    link = joined(port, timeout=timeout, baudrate=baudrate)
    port.mangle = lambda replies: b""
    for _ in range(3):
        start = port.now
        with pytest.raises((LinkTimeoutError, NoDeviceError)):
            link.write(whole(screens(1)[0]))
        assert port.now - start < timeout + 0.1
    port.mangle = lambda replies: replies
    cost(port, link, screens(1))


@pytest.mark.parametrize("timeout", [0.5, 2.0])
def test_the_timeout_bounds_a_call_over_a_line_that_passes_nothing_whole(timeout: float) -> None:
    port = SimulatedPort()
    link = joined(port, timeout=timeout)
    carry = port.device.receive
    port.device.receive = lambda data: carry(b"\x80" if data == b"\x55" else data)  # type: ignore[method-assign]
    start = port.now
    with pytest.raises(LinkTimeoutError):
        link.write([(True, b"\x55")])
    assert port.now - start < timeout + 0.1


def test_a_long_picture_may_take_longer_than_the_timeout() -> None:
    port = SimulatedPort()
    link = joined(port, timeout=0.3, baudrate=115_200)
    start = port.now
    link.write([(True, random.Random(2).randbytes(8192))])
    assert port.now - start > 0.6


# Features


def test_a_byte_read_from_the_panel() -> None:
    port = SimulatedPort()
    port.device.read = lambda: 0x43
    link = joined(port)
    assert link.device.features & Feature.READ
    assert link.read_panel() == 0x43
    lost = [0, 1]
    port.mangle = lambda replies: b"\1\2\0" if lost and lost.pop() else replies
    assert link.read_panel() == 0x43

    def gone() -> int:
        raise OSError(121, "Remote I/O error")

    port.device.read = gone
    with pytest.raises(PanelFaultError, match="0x3c") as caught:
        link.read_panel()
    assert caught.value.fault == Fault.ADDRESS_NACK
    cost(port, link, screens(1))
    port.mangle = lambda replies: b""
    with pytest.raises(LinkTimeoutError):
        link.read_panel()
    port.mangle = lambda replies: replies
    cost(port, link, screens(1))
    assert link.stats.sessions == 1


def test_a_byte_that_is_lost_is_asked_for_as_soon_as_it_is_overdue() -> None:
    port = SimulatedPort()
    port.device.read = lambda: 0x43
    link = joined(port)
    link.write([(True, b"\1")])
    left = [b"", b""]
    port.mangle = lambda replies: left.pop() if replies and left else replies
    start = port.now
    assert link.read_panel() == 0x43
    assert left == []
    assert port.now - start < 0.05


def test_a_device_that_cannot_read_is_not_asked_to() -> None:
    port = SimulatedPort()
    link = joined(port)
    sent = link.stats.bytes_sent
    with pytest.raises(LinkError, match="cannot read"):
        link.read_panel()
    assert link.stats.bytes_sent == sent


def test_a_panel_that_goes_while_nothing_is_sent_is_told_at_the_next_write() -> None:
    port = SimulatedPort()
    link = joined(port)
    cost(port, link, screens(1))
    port.panel.gone = True
    port.now += 1.5
    port.device.tick()
    port.panel.gone = False
    with pytest.raises(PanelFaultError) as caught:
        link.write(whole(screens(1)[0]))
    assert caught.value.fault == Fault.ADDRESS_NACK
    cost(port, link, screens(1))


def test_features_of_later_times_do_no_harm() -> None:
    port = SimulatedPort(profile=replace(UNO, features=0xFFFC))
    link = joined(port)
    assert link.device.features == 0xFFFC
    cost(port, link, screens(1))


def test_an_spi_that_stops_has_no_pull_ups_to_check() -> None:
    port = SimulatedPort(profile=replace(UNO, bus=PanelBus.SPI, address=0, acknowledges=False))
    link = joined(port)

    def stuck(content: bytes) -> None:
        raise OSError(110, "timed out")

    port.panel = stuck
    with pytest.raises(PanelFaultError, match="SPI has stopped: press the board's reset") as caught:
        link.write([(True, b"\1")])
    assert caught.value.fault == Fault.BUS_STUCK
    assert "pull-up" not in str(caught.value)
