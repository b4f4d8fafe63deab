"""The I2C transport on the real smbus2, and below it a kernel that is played here, preloaded or real: i2c_lanes.py."""

from __future__ import annotations

import errno
import os
from concurrent.futures import ThreadPoolExecutor
from types import SimpleNamespace

import numpy as np
import pytest
import smbus2
from i2c_lanes import LANE, LANES, PATH, Bus
from kernel_answers import Asker, rows
from smbus2 import i2c_msg

from paneldraw import Panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelError,
    PanelNotFoundError,
    PanelPermissionError,
    PanelTimeoutError,
    TransportError,
)
from paneldraw.transports import COMMAND, DATA, I2CTransport, Plan


@pytest.fixture
def chip():
    return simulator.SSD1306(128, 64)


@pytest.fixture
def kernel(chip, monkeypatch):
    """A kernel that has the chip on bus 1: one that is played here with all that it holds, or the bus of a real one."""
    bus = Bus({0x3C: chip})
    with LANES[LANE](bus, monkeypatch) as played:
        yield played or SimpleNamespace(bus=bus)


@pytest.fixture
def played(kernel):
    """A kernel that can be told what to do."""
    if LANE != "patched":
        pytest.skip("only where the kernel is played here")
    return kernel


class Limited:
    """An adapter of limits of its own."""

    def __init__(self, kernel, longest=8192, most=42):
        self.longest, self.most, self.refused = longest, most, 0
        self._rdwr, kernel.rdwr = kernel.rdwr, self.rdwr

    def rdwr(self, file, call):
        if call.nmsgs > self.most or any(call.msgs[i].len > self.longest for i in range(call.nmsgs)):
            self.refused += 1
            raise OSError(errno.EOPNOTSUPP, "Operation not supported")
        return self._rdwr(file, call)


def plan_of(*messages):
    plan = Plan(sum(len(payload) + 1 for _, payload in messages), len(messages))
    end = 0
    for kind, payload in messages:
        plan.starts[plan.count], plan.stops[plan.count] = end, end + 1 + len(payload)
        plan.buffer[end] = kind
        plan.buffer[end + 1 : end + 1 + len(payload)] = np.frombuffer(payload, np.uint8)
        plan.count += 1
        plan.cost += 2 + len(payload)
        end += 1 + len(payload)
    return plan


@pytest.mark.parametrize("bus", [1, "/dev/i2c-1"])
def test_a_bus_by_number_or_path(kernel, chip, bus):
    transport = I2CTransport(bus)
    transport.command(b"\x81\x10")
    transport.close()
    transport.close()
    assert chip.contrast == 0x10


@pytest.mark.parametrize("bus", [1, "1", "/dev/i2c-1"])
def test_what_was_opened_is_closed(played, bus):
    transport = I2CTransport(bus)
    assert len(played.files) == 1
    transport.close()
    assert not played.files


def test_messages_as_the_wire_has_them(kernel):
    transport = I2CTransport(1)
    assert transport.command(b"\xa5\xaf") == 4
    assert transport.data(b"\x01") == 3
    plan = plan_of((COMMAND, b"\xb3\x05\x10"), (DATA, b"\xff"))
    assert transport.batch(plan) == 8
    assert kernel.bus.calls == [
        [(0, b"\x00\xa5\xaf")],
        [(0, b"\x40\x01")],
        [(0, b"\x00\xb3\x05\x10"), (0, b"\x40\xff")],
    ]
    assert [(kind, bytes(payload)) for kind, payload in plan] == [(COMMAND, b"\xb3\x05\x10"), (DATA, b"\xff")]


def test_an_object_with_smbus2s_interface_stays_the_callers(chip):
    bus = simulator.I2CBus({0x3C: chip})
    transport = I2CTransport(bus)
    transport.close()
    transport.command(b"\x81\x10")
    assert chip.contrast == 0x10


def test_a_picture_through_the_real_smbus2(kernel, chip):
    picture = np.random.default_rng(7).integers(0, 2, (64, 128), np.uint8)
    with Panel(SSD1306(), I2CTransport(1)) as panel:
        panel.show(picture)
        np.testing.assert_array_equal(chip.pixels, picture)
        before = kernel.bus.bytes
        picture[33, 100] ^= 1
        report = panel.show(picture)
        assert report.wire_bytes == kernel.bus.bytes - before
    np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_more_messages_than_a_call_takes(kernel):
    messages = [(DATA, bytes((i,))) for i in range(100)]
    I2CTransport(1).batch(plan_of(*messages))
    assert [len(call) for call in kernel.bus.calls] == [42, 42, 16]
    assert [payload for call in kernel.bus.calls for _, payload in call] == [
        b"\x40" + payload for _, payload in messages
    ]


@pytest.mark.parametrize("length", [8191, 8192, 65536, 65537])
def test_more_bytes_than_a_message_takes(kernel, length):
    payload = np.random.default_rng(length).bytes(length)
    pieces = -(-length // 8191)
    assert I2CTransport(1).batch(plan_of((DATA, payload))) == length + 2 * pieces
    sent = [message for call in kernel.bus.calls for _, message in call]
    assert len(sent) == pieces
    assert all(message[0] == DATA and len(message) <= 8192 for message in sent)
    assert b"".join(message[1:] for message in sent) == payload


def test_an_adapter_with_short_messages_shows_the_same_picture(kernel, chip):
    picture = np.random.default_rng(8).integers(0, 2, (64, 128), np.uint8)
    Panel(SSD1306(chained_control=True), I2CTransport(1, max_message=32)).show(picture)
    assert max(len(message) for call in kernel.bus.calls for _, message in call) == 32
    np.testing.assert_array_equal(chip.pixels, picture)


@pytest.mark.parametrize("code", [errno.EREMOTEIO, errno.ENXIO])
def test_nobody_at_the_address(kernel, code):
    kernel.bus.devices.clear()
    kernel.bus.fail(code, times=None)
    with pytest.raises(PanelNotFoundError, match=r"0x3C on /dev/i2c-1.*wiring") as caught:
        I2CTransport(1).command(b"\xaf")
    assert caught.value.errno == code


@pytest.mark.parametrize(("asked", "there"), [(0x3C, 0x3D), (0x3D, 0x3C)])
def test_a_panel_at_the_other_address_is_found(kernel, chip, asked, there):
    kernel.bus.devices = {there: chip}
    with pytest.raises(PanelNotFoundError, match=f"found 0x{there:02X} instead"):
        Panel(SSD1306(), I2CTransport(1, asked))


def test_a_panel_that_answered_and_is_gone(kernel):
    transport = I2CTransport(1)
    transport.command(b"\xaf")
    kernel.bus.devices.clear()
    with pytest.raises(PanelDisconnectedError):
        transport.command(b"\xaf")


@pytest.mark.parametrize(
    ("code", "kind", "transient", "advice"),
    [
        (errno.EAGAIN, PanelBusyError, True, "master"),
        (errno.EBUSY, PanelBusyError, True, "master"),
        (errno.ETIMEDOUT, PanelTimeoutError, True, "pull-up"),
        (errno.ENODEV, PanelDisconnectedError, False, "adapter"),
        (errno.EIO, TransportError, False, "wiring"),
    ],
)
def test_what_linux_says_and_what_to_do(kernel, code, kind, transient, advice):
    transport = I2CTransport(1)
    kernel.bus.fail(code)
    with pytest.raises(kind, match=advice) as caught:
        transport.command(b"\xaf")
    assert caught.value.errno == code
    assert caught.value.transient == transient
    assert isinstance(caught.value, PanelError)
    assert isinstance(caught.value, OSError)


def test_a_transfer_that_stops_early_is_noticed(kernel):
    transport = I2CTransport(1)
    kernel.bus.fail(0, after=1)
    with pytest.raises(TransportError, match="only 1 of 2 messages"):
        transport.batch(plan_of((COMMAND, b"\xb0"), (DATA, b"\x00")))


@pytest.mark.parametrize(
    ("code", "kind", "advice"),
    [
        (errno.EACCES, PanelPermissionError, "group i2c"),
        (errno.EPERM, PanelPermissionError, "--device /dev/i2c-3"),
        (errno.ENOENT, PanelNotFoundError, "enable I2C"),
        (errno.ENXIO, PanelNotFoundError, "enable I2C"),
        (errno.EMFILE, TransportError, "Too many open files"),
    ],
)
def test_a_bus_that_does_not_open(played, code, kind, advice):
    played.open_error = code
    with pytest.raises(kind, match=advice) as caught:
        I2CTransport(3)
    assert "/dev/i2c-3" in str(caught.value)
    assert caught.value.errno == code


def test_a_closed_transport_says_so(kernel):
    transport = I2CTransport(1)
    transport.close()
    with pytest.raises(TransportError, match="closed"):
        transport.command(b"\xaf")


@pytest.mark.parametrize("bus", [None, 1.0, True, object()])
def test_what_is_no_bus(bus):
    with pytest.raises(TypeError, match="bus must be"):
        I2CTransport(bus)


def test_arguments_out_of_range():
    bus = simulator.I2CBus()
    with pytest.raises(ValueError, match="bus must be 0 or more"):
        I2CTransport(-1)
    for address in (0x07, 0x78, 0x13C):
        with pytest.raises(ValueError, match="address must be"):
            I2CTransport(bus, address)
    with pytest.raises(TypeError, match="address must be"):
        I2CTransport(bus, "0x3C")
    for max_message in (1, 8193):
        with pytest.raises(ValueError, match="max_message must be"):
            I2CTransport(bus, max_message=max_message)


def test_messages_are_smbus2s_own(chip):
    seen = []

    class Bus:
        def i2c_rdwr(self, *messages):
            seen.extend((type(message), bytes(message)) for message in messages)

    I2CTransport(Bus()).batch(plan_of((COMMAND, b"\xb0"), (DATA, b"\x01\x02")))
    assert seen == [(i2c_msg, b"\x00\xb0"), (i2c_msg, b"\x40\x01\x02")]


# -- Faults that pass, and who is asked when


@pytest.mark.usefixtures("own_time")
@pytest.mark.parametrize("code", [errno.EREMOTEIO, errno.ENXIO, errno.EIO, errno.ETIME])
@pytest.mark.parametrize("times", [1, 2, 3])
def test_a_panel_that_answered_is_tried_again(kernel, chip, code, times):
    picture = np.random.default_rng(code).integers(0, 2, (64, 128), np.uint8)
    with Panel(SSD1306(), I2CTransport(1)) as panel:
        panel.show(picture)
        picture[5, 5] ^= 1
        kernel.bus.fail(code, times=times)
        panel.show(picture)
        np.testing.assert_array_equal(chip.pixels, picture)
        assert panel.stats.retries == times
        assert panel.stats.faults == {errno.errorcode[code]: times}


def test_a_lone_missing_acknowledge_asks_no_other_address(kernel, chip):
    asked = []
    kernel.bus.devices[0x3D] = Listener(asked)
    with Panel(SSD1306(), I2CTransport(1)) as panel:
        panel.show(np.ones((64, 128), np.uint8))
        kernel.bus.fail(errno.EREMOTEIO)
        panel.clear()
        assert asked == []
        kernel.bus.devices.pop(0x3C)
        with pytest.raises(PanelDisconnectedError, match="nobody answers at 0x3C on /dev/i2c-1: found 0x3D instead"):
            panel.show(np.ones((64, 128), np.uint8))
        assert asked == ["read"]
        kernel.bus.devices[0x3C] = chip


class Listener:
    """Somebody else's device."""

    def __init__(self, asked):
        self.asked = asked

    def read(self, length):
        self.asked.append("read")
        return bytes(length)

    def write(self, payload):
        self.asked.append("write")

    def settle(self, seconds, wire_bytes):
        pass


# -- Adapters


@pytest.mark.parametrize("longest", [4096, 1000, 255, 64, 32, 20])
def test_a_length_limit_is_measured_once(played, chip, longest):
    adapter = Limited(played, longest)
    random = np.random.default_rng(longest)
    with Panel(SSD1306(chained_control=True), I2CTransport(1)) as panel:
        panel.show(np.ones((64, 128), np.uint8))
        panel.clear()
        refused = adapter.refused
        assert refused <= 14
        for _ in range(3):
            picture = random.integers(0, 2, (64, 128), np.uint8)
            panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
    assert adapter.refused == refused
    assert chip.violations == []


def test_an_adapter_of_few_messages_a_call(played, chip):
    Limited(played, most=1)
    with Panel(SSD1306(), I2CTransport(1)) as panel:
        for seed in range(3):
            picture = np.random.default_rng(seed).integers(0, 2, (64, 128), np.uint8)
            report = panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
    assert report.wire_bytes > 1000


@pytest.mark.parametrize("told", [True, False])
def test_an_adapter_of_smbus_alone_is_driven_by_blocks(chip, told):
    class SMBusOnly(simulator.I2CBus):
        def i2c_rdwr(self, *messages):
            raise OSError(errno.EOPNOTSUPP, "Operation not supported")

    bus = SMBusOnly({0x3C: chip})
    if told:
        bus.funcs &= ~1
    transport = I2CTransport(bus)
    with Panel(SSD1306(), transport) as panel:
        for seed in range(3):
            picture = np.random.default_rng(seed).integers(0, 2, (64, 128), np.uint8)
            before = bus.bytes
            report = panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
        assert report.wire_bytes == bus.bytes - before
        assert transport.max_message == 33
    assert chip.violations == []


def test_what_takes_nothing_says_so():
    class Nothing:
        def i2c_rdwr(self, *messages):
            raise OSError(errno.EOPNOTSUPP, "Operation not supported")

    with pytest.raises(TransportError, match="takes neither I2C messages nor SMBus blocks"):
        I2CTransport(Nothing()).command(b"\xaf")


# -- Multiplexers


@pytest.mark.parametrize("together", [True, False])
@pytest.mark.parametrize("frames", [20, pytest.param(1000, marks=pytest.mark.thorough)])
def test_eight_panels_of_one_address_behind_a_multiplexer(together, frames, monkeypatch):
    monkeypatch.setattr("paneldraw.driver._LOOK", 1e9)  # no look at the status among what is counted
    chips = [simulator.SSD1306(history=frames) for _ in range(8)]
    bus = simulator.I2CBus({0x70: simulator.Multiplexer({n: {0x3C: chip} for n, chip in enumerate(chips)})})
    if together:
        bus.funcs |= 0x4
    panels = [Panel(SSD1306(), I2CTransport(bus, mux=(0x70, channel))) for channel in range(8)]

    def pictures(number):
        random = np.random.default_rng(number)
        return (random.integers(0, 2, (64, 128), np.uint8) for _ in range(frames))

    def animate(number):
        for picture in pictures(number):
            panels[number].show(picture)

    with ThreadPoolExecutor(8) as threads:
        list(threads.map(animate, range(8)))
    for number, chip in enumerate(chips):
        for frame, picture in zip(chip.frames, pictures(number), strict=True):
            np.testing.assert_array_equal(frame.pixels, picture)
    before = bus.bytes, bus.transactions
    report = panels[3].clear()
    assert report.wire_bytes == bus.bytes - before[0]
    assert bus.transactions - before[1] == (1 if together else 2)


def test_a_multiplexer_that_cannot_be():
    bus = simulator.I2CBus()
    with pytest.raises(ValueError, match="channel of 0 to 7, not 8"):
        I2CTransport(bus, mux=(0x70, 8))
    with pytest.raises(ValueError, match="mux must be 0x08 to 0x77"):
        I2CTransport(bus, mux=(0x80, 1))


# -- What people type


@pytest.mark.parametrize(
    ("address", "advice"),
    [(0x78, "write 0x3C"), (0x7A, "write 0x3D"), (0x13C, "7 bits, not of 10"), (0x07, "usually 0x3C or 0x3D")],
)
def test_an_address_that_is_none_says_what_to_write(address, advice):
    with pytest.raises(ValueError, match=advice):
        I2CTransport(simulator.I2CBus(), address)


def test_a_bus_that_the_caller_closed(kernel):
    bus = smbus2.SMBus(1)
    transport = I2CTransport(bus)
    transport.command(b"\xae")
    bus.close()
    with pytest.raises(TransportError, match="bus SMBus is closed: open it, or give its number"):
        transport.command(b"\xaf")


@pytest.mark.parametrize("code", [errno.ENOTTY, errno.EINVAL])
def test_a_path_that_is_no_bus_is_closed_again(played, monkeypatch, code):
    def refuse(descriptor, request, argument):
        raise OSError(code, os.strerror(code))

    monkeypatch.setattr(smbus2.smbus2, "ioctl", refuse)
    for _ in range(3):
        with pytest.raises(PanelNotFoundError, match="/dev/i2c-1 is no I2C bus"):
            I2CTransport(PATH)
    assert not played.files


def test_a_panel_that_cannot_be_opened_closes_its_transport(played):
    played.bus.devices.clear()
    for _ in range(3):
        with pytest.raises(PanelNotFoundError):
            Panel(SSD1306(), I2CTransport(1))
        with pytest.raises(ValueError, match="rotate"):
            Panel(SSD1306(), I2CTransport(1), rotate=45)
        with pytest.raises(ValueError, match="on_close"):
            Panel(SSD1306(), I2CTransport(1), on_close="burn")
    assert not played.files


# -- What the kernel answers


@pytest.fixture
def asker(kernel):
    """One that asks the kernel, on the bus that kernel_answers.txt describes."""
    bus = kernel.bus
    bus.devices = {address: Counter() for address in (0x3C, 0x30, 0x31, 0x32)}
    bus.claimed = {0x6B}
    for address, code in ((0x30, 0), (0x31, errno.EAGAIN), (0x32, errno.ETIMEDOUT)):
        bus.fail(code, address=address, times=None)
    return Asker(PATH, kernel, kernel.ioctl) if LANE == "patched" else Asker(PATH)


class Counter(Listener):
    """A device that answers with 1, 2, 3 and so on."""

    def __init__(self):
        super().__init__([])

    def read(self, length):
        return bytes(at + 1 & 0xFF for at in range(length))


@pytest.mark.parametrize(("request_", "answer"), rows())
def test_what_linux_answers(asker, request_, answer):
    assert asker.answer(request_) == answer
