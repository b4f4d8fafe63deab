"""The bus as drivers use it: real smbus2 messages, Linux's limits and errors, bytes and time on the wire."""

from __future__ import annotations

import errno
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import smbus2
from smbus2 import i2c_msg

from paneldraw import simulator

from .helpers import init, pack, random_picture, started


class Recorder:
    """A device that notes what reaches it and answers with counting bytes."""

    def __init__(self) -> None:
        self.log: list[bytes | int] = []
        self.calls: list[tuple[float, int]] = []

    def write(self, payload: bytes) -> None:
        self.log.append(payload)

    def read(self, length: int) -> bytes:
        self.log.append(length)
        return bytes(range(1, length + 1))

    def settle(self, seconds: float, wire_bytes: int) -> None:
        self.calls.append((seconds, wire_bytes))


@pytest.fixture
def device() -> Recorder:
    return Recorder()


@pytest.fixture
def bus(device: Recorder) -> simulator.I2CBus:
    return simulator.I2CBus({0x3C: device}, timer=None)


WRITES: list[tuple[str, tuple[Any, ...], bytes]] = [
    ("write_quick", (), b""),
    ("write_byte", (0x12,), b"\x12"),
    ("write_byte_data", (0x12, 0x34), b"\x12\x34"),
    ("write_word_data", (0x12, 0x3456), b"\x12\x56\x34"),
    ("write_block_data", (0x12, [7, 8, 9]), b"\x12\x03\x07\x08\x09"),
    ("write_i2c_block_data", (0x12, [7, 8, 9]), b"\x12\x07\x08\x09"),
    ("write_i2c_block_data", (0x12, bytes(32)), b"\x12" + bytes(32)),
    ("write_i2c_block_data", (0x12, [0x1FF, 0x100]), b"\x12\xff\x00"),
    ("write_i2c_block_data", (0x12, []), b"\x12"),
]
READS: list[tuple[str, tuple[Any, ...], list[bytes | int], Any]] = [
    ("read_byte", (), [1], 1),
    ("read_byte_data", (0x12,), [b"\x12", 1], 1),
    ("read_word_data", (0x12,), [b"\x12", 2], 0x0201),
    ("process_call", (0x12, 0x3456), [b"\x12\x56\x34", 2], 0x0201),
    ("read_i2c_block_data", (0x12, 3), [b"\x12", 3], [1, 2, 3]),
]
CALLS = [(name, arguments) for name, arguments, *_ in [*WRITES, *READS]]


@pytest.mark.parametrize(("name", "arguments", "payload"), WRITES)
@pytest.mark.parametrize("force", [{}, {"force": True}, {"force": None}])
def test_smbus_writes(
    bus: simulator.I2CBus,
    device: Recorder,
    name: str,
    arguments: tuple[Any, ...],
    payload: bytes,
    force: dict[str, bool | None],
) -> None:
    assert getattr(bus, name)(0x3C, *arguments, **force) is None
    assert device.log == [payload]
    assert (bus.bytes, bus.messages, bus.transactions) == (1 + len(payload), 1, 1)


@pytest.mark.parametrize(("name", "arguments", "log", "answer"), READS)
def test_smbus_reads(
    bus: simulator.I2CBus,
    device: Recorder,
    name: str,
    arguments: tuple[Any, ...],
    log: list[bytes | int],
    answer: Any,
) -> None:
    assert getattr(bus, name)(0x3C, *arguments) == answer
    assert device.log == log
    wire = sum(1 + (part if isinstance(part, int) else len(part)) for part in log)
    assert (bus.bytes, bus.messages, bus.transactions) == (wire, len(log), 1)


@pytest.mark.parametrize(("name", "arguments"), [*CALLS, ("i2c_rdwr", None)])
def test_after_close_everything_raises_what_smbus2_raises(
    bus: simulator.I2CBus, device: Recorder, name: str, arguments: tuple[Any, ...] | None
) -> None:
    closed = smbus2.SMBus()
    bus.close()
    full = (i2c_msg.write(0x3C, b"x"),) if arguments is None else (0x3C, *arguments)
    with pytest.raises(TypeError) as theirs:
        getattr(closed, name)(*full)
    with pytest.raises(TypeError) as ours:
        getattr(bus, name)(*full)
    assert str(ours.value) == str(theirs.value)
    assert bus.fd is closed.fd is None
    assert device.log == []
    bus.close()
    bus.open(1)
    bus.write_byte(0x3C, 1)
    assert device.log == [b"\x01"]


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("write_i2c_block_data", (0, [0] * 33)),
        ("write_block_data", (0, [0] * 33)),
        ("block_process_call", (0, [0] * 33)),
        ("read_i2c_block_data", (0, 33)),
    ],
)
def test_blocks_past_32_bytes_raise_what_smbus2_raises(
    bus: simulator.I2CBus, name: str, arguments: tuple[Any, ...]
) -> None:
    with pytest.raises(ValueError, match="32 bytes") as theirs:
        getattr(smbus2.SMBus(), name)(0x3C, *arguments)
    with pytest.raises(ValueError, match="32 bytes") as ours:
        getattr(bus, name)(0x3C, *arguments)
    assert str(ours.value) == str(theirs.value)


def test_it_offers_every_public_name_of_smbus2(bus: simulator.I2CBus) -> None:
    missing = [name for name in dir(smbus2.SMBus()) if not name.startswith("_") and not hasattr(bus, name)]
    assert missing == []


def test_pec_is_refused_as_on_adapters_without(bus: simulator.I2CBus) -> None:
    assert not bus.funcs & smbus2.I2cFunc.SMBUS_PEC
    with pytest.raises(OSError, match="SMBUS_PEC is not a feature"):
        bus.pec = 1
    with pytest.raises(OSError, match="SMBUS_PEC is not a feature"):
        bus.enable_pec()
    assert bus.pec == 0


def test_smbus_block_reads_are_not_offered(bus: simulator.I2CBus, device: Recorder) -> None:
    assert not bus.funcs & smbus2.I2cFunc.SMBUS_READ_BLOCK_DATA
    for call in (lambda: bus.read_block_data(0x3C, 0), lambda: bus.block_process_call(0x3C, 0, [1])):
        with pytest.raises(OSError, match=str(errno.EOPNOTSUPP)):
            call()
    assert device.log == []


def test_rdwr_carries_real_messages_both_ways(bus: simulator.I2CBus, device: Recorder) -> None:
    answer = i2c_msg.read(0x3C, 4)
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"ab"), answer, i2c_msg.write(0x3C, []))
    assert device.log == [b"ab", 4, b""]
    assert bytes(answer) == bytes([1, 2, 3, 4])
    assert (bus.bytes, bus.messages, bus.transactions) == (3 + 5 + 1, 3, 1)
    assert device.calls == [(bus.seconds, 9)]


def test_a_display_is_written_through_rdwr() -> None:
    chip = simulator.SSD1306()
    bus = simulator.I2CBus({0x3D: chip})
    picture = random_picture(128, 64, 7)
    bus.i2c_rdwr(
        i2c_msg.write(0x3D, b"\x00" + init(128, 64)),
        i2c_msg.write(0x3D, [0x00, 0x21, 0, 127, 0x22, 0, 7]),
        i2c_msg.write(0x3D, b"\x40" + pack(picture).tobytes()),
    )
    assert np.array_equal(chip.pixels, picture)
    status = i2c_msg.read(0x3D, 1)
    bus.i2c_rdwr(status)
    assert bytes(status)[0] & 0x40 == 0
    bus.write_byte_data(0x3D, 0x00, 0xAE)
    assert bus.read_byte(0x3D) & 0x40


def nobody(bus: simulator.I2CBus, name: str, arguments: tuple[Any, ...]) -> OSError:
    with pytest.raises(OSError, match="Remote I/O error") as caught:
        getattr(bus, name)(0x3D, *arguments)
    return caught.value


@pytest.mark.parametrize(("name", "arguments"), CALLS)
def test_nobody_at_the_address_is_remote_io_error(
    bus: simulator.I2CBus, device: Recorder, name: str, arguments: tuple[Any, ...]
) -> None:
    error = nobody(bus, name, arguments)
    assert error.errno == 121
    assert (bus.bytes, bus.messages, bus.transactions) == (1, 1, 1)
    assert device.log == []


def test_what_stands_before_a_missing_chip_is_delivered(bus: simulator.I2CBus, device: Recorder) -> None:
    messages = [i2c_msg.write(address, b"xy") for address in (0x3C, 0x3D, 0x3C)]
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.i2c_rdwr(*messages)
    assert device.log == [b"xy"]
    assert (bus.bytes, bus.messages) == (4, 2)


def test_unplugging_and_plugging_in(bus: simulator.I2CBus, device: Recorder) -> None:
    del bus.devices[0x3C]
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.write_quick(0x3C)
    bus.devices[0x3C] = device
    bus.write_quick(0x3C)
    assert device.log == [b""]


@pytest.mark.parametrize(
    "messages",
    [
        list,
        lambda: [i2c_msg.write(0x3C, b"x")] * 43,
        lambda: [i2c_msg.write(0x3C, bytes(8193))],
        lambda: [i2c_msg.write(0x3C, b"x"), i2c_msg.read(0x3C, 8193)],
    ],
)
def test_past_the_kernels_limits_nothing_is_sent(
    bus: simulator.I2CBus, device: Recorder, messages: Callable[[], list[i2c_msg]]
) -> None:
    with pytest.raises(OSError, match="Invalid argument") as caught:
        bus.i2c_rdwr(*messages())
    assert caught.value.errno == errno.EINVAL
    assert device.log == []
    assert (bus.bytes, bus.transactions) == (0, 0)


def test_at_the_kernels_limits_all_is_sent(bus: simulator.I2CBus, device: Recorder) -> None:
    bus.i2c_rdwr(*[i2c_msg.write(0x3C, bytes(8192))] * 42)
    assert device.log == [bytes(8192)] * 42


def test_a_message_of_65537_bytes_silently_sends_one_as_with_smbus2(bus: simulator.I2CBus, device: Recorder) -> None:
    bus.i2c_rdwr(i2c_msg.write(0x3C, bytes(65537)))
    assert device.log == [b"\x00"]


@pytest.mark.parametrize("address", [-1, 0x80])
def test_smbus_calls_refuse_addresses_past_seven_bits(bus: simulator.I2CBus, address: int) -> None:
    with pytest.raises(OSError, match="Invalid argument"):
        bus.write_quick(address)


def test_arguments_of_the_wrong_kind(bus: simulator.I2CBus) -> None:
    with pytest.raises(TypeError, match="expected i2c_msg instance, got bytes"):
        bus.i2c_rdwr(b"abc")
    with pytest.raises(TypeError, match=r"Unexpected type\(bus\)"):
        bus.open(1.5)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="clock"):
        simulator.I2CBus({}, clock=0)
    with pytest.raises(ValueError, match="devices"):
        simulator.I2CBus({0x80: Recorder()})


@pytest.mark.parametrize(("clock", "seconds"), [(100_000, 0.09311), (400_000, 0.0232775), (1_000_000, 0.009311)])
def test_time_on_the_wire_is_nine_bits_a_byte_and_a_bit_for_start_and_stop(clock: int, seconds: float) -> None:
    bus = simulator.I2CBus({0x3C: Recorder()}, clock, timer=None)
    bus.i2c_rdwr(i2c_msg.write(0x3C, bytes(7)), i2c_msg.write(0x3C, bytes(1025)))
    assert bus.bytes == 1034
    assert bus.seconds == pytest.approx((9 * 1034 + 3) / clock)
    assert bus.seconds == pytest.approx(seconds, rel=1e-3)


def test_two_chips_share_a_bus_and_each_is_told_its_own_bytes() -> None:
    first, second = Recorder(), Recorder()
    bus = simulator.I2CBus({0x3C: first, 0x3D: second}, timer=None)
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"abc"), i2c_msg.write(0x3D, b"d"), i2c_msg.write(0x3C, b"e"))
    assert (first.log, second.log) == ([b"abc", b"e"], [b"d"])
    assert [wire for _, wire in first.calls] == [6]
    assert [wire for _, wire in second.calls] == [2]


def test_calls_from_many_threads_stay_whole() -> None:
    class Slow(Recorder):
        def write(self, payload: bytes) -> None:
            time.sleep(0)
            super().write(payload)

    device = Slow()
    bus = simulator.I2CBus({0x3C: device})

    def send(name: int) -> None:
        for _ in range(50):
            bus.i2c_rdwr(*[i2c_msg.write(0x3C, [name, part]) for part in range(4)])

    threads = [threading.Thread(target=send, args=(name,)) for name in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    calls = [device.log[at : at + 4] for at in range(0, len(device.log), 4)]
    assert sorted(calls) == sorted([bytes([name, part]) for part in range(4)] for name in range(4) for _ in range(50))
    assert bus.bytes == 4 * 50 * 12


def test_leaving_the_block_closes_the_bus_and_leaves_the_chip_alone() -> None:
    chip = started()
    with simulator.I2CBus({0x3C: chip}) as bus:
        assert bus.fd is not None
        bus.write_byte_data(0x3C, 0x00, 0xA5)
    assert bus.fd is None
    assert chip.pixels.all()
