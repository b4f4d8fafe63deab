"""Faults on demand: what the caller gets, and what the chip has received by then."""

from __future__ import annotations

import errno
from contextlib import nullcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from smbus2 import i2c_msg

from paneldraw import simulator

from .helpers import init, random_picture, send, started

FULL = b"\x00" + init(128, 64)


def bench() -> tuple[simulator.SSD1306, simulator.I2CBus]:
    chip = simulator.SSD1306()
    return chip, simulator.I2CBus({0x3C: chip}, timer=None)


@given(at_byte=st.integers(0, len(FULL) + 2))
def test_the_chip_has_received_exactly_the_bytes_before_the_fault(at_byte: int) -> None:
    chip, bus = bench()
    bus.fail(at_byte=at_byte)
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.i2c_rdwr(i2c_msg.write(0x3C, FULL))
    cut = simulator.SSD1306()
    cut.write(FULL[:at_byte])
    assert chip.registers == cut.registers
    delivered = min(at_byte, len(FULL))
    assert bus.bytes == 1 + delivered + (delivered < len(FULL)), "the byte that was not acknowledged was on the wire"
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + FULL[delivered:] if delivered else FULL))
    assert chip.registers == started().registers, "a half-sent command waits for its arguments"


def test_an_address_that_is_not_acknowledged_delivers_nothing() -> None:
    chip, bus = bench()
    bus.fail()
    with pytest.raises(OSError, match="Remote I/O error") as caught:
        bus.i2c_rdwr(i2c_msg.write(0x3C, FULL))
    assert caught.value.errno == 121
    assert chip.registers == simulator.SSD1306().registers
    assert bus.bytes == 1


@pytest.mark.parametrize("code", [6, errno.ETIMEDOUT, errno.EAGAIN, errno.EBUSY, errno.EIO, errno.ENODEV])
def test_any_errno(code: int) -> None:
    _, bus = bench()
    bus.fail(code)
    with pytest.raises(OSError) as caught:  # noqa: PT011
        bus.write_quick(0x3C)
    assert caught.value.errno == code
    bus.write_quick(0x3C)


@given(after=st.integers(0, 6), times=st.integers(1, 4))
def test_the_nth_message_fails_however_the_messages_are_split_into_calls(after: int, times: int) -> None:
    _, bus = bench()
    bus.fail(after=after, times=times)
    outcomes = []
    for _ in range(12):
        try:
            bus.write_quick(0x3C)
            outcomes.append(True)
        except OSError:
            outcomes.append(False)
    assert outcomes == [True] * after + [False] * times + [True] * (12 - after - times)

    chip, bus = bench()
    bus.fail(after=after)
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.i2c_rdwr(*[i2c_msg.write(0x3C, [0x00, 0x81, n]) for n in range(7)])
    assert chip.contrast == (after - 1 if after else 0x7F)
    assert bus.messages == after + 1


def test_for_ever_until_cleared() -> None:
    _, bus = bench()
    bus.fail(times=None)
    for _ in range(5):
        with pytest.raises(OSError, match="Remote I/O error"):
            bus.write_quick(0x3C)
    bus.clear_faults()
    bus.write_quick(0x3C)


def test_two_faults_count_the_same_messages_and_the_one_asked_for_first_goes_first() -> None:
    _, bus = bench()
    bus.fail(errno.ETIMEDOUT, after=1)
    bus.fail(errno.EBUSY, after=1)
    bus.fail(errno.EIO, after=4)
    outcomes = []
    for _ in range(7):
        try:
            bus.write_quick(0x3C)
            outcomes.append(0)
        except OSError as error:
            outcomes.append(error.errno or -1)
    assert outcomes == [0, errno.ETIMEDOUT, errno.EBUSY, 0, errno.EIO, 0, 0]


def test_only_one_address() -> None:
    first, second = simulator.SSD1306(), simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: first, 0x3D: second})
    bus.fail(address=0x3D, after=1)
    for address in (0x3D, 0x3C, 0x3C, 0x3C):
        bus.write_quick(address)
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.write_quick(0x3D)


def test_power_lost_in_the_middle_of_a_picture() -> None:
    chip, bus = bench()
    bus.i2c_rdwr(i2c_msg.write(0x3C, FULL))
    send(chip, random_picture(128, 64, 8))
    bus.fail(errno.EIO, at_byte=100, then=chip.power_cycle)
    with pytest.raises(OSError, match="Input/output error"):
        bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x40" + bytes(1024)))
    assert chip.registers == simulator.SSD1306().registers
    assert not chip.pixels.any()


def test_a_short_transfer_without_an_error() -> None:
    chip, bus = bench()
    bus.fail(0, after=1, at_byte=3)
    bus.i2c_rdwr(*[i2c_msg.write(0x3C, [0x00, 0x81, n, 0xA7]) for n in range(3)])
    assert chip.contrast == 1
    assert bus.messages == 2
    bus.fail(0)
    with pytest.raises(OSError, match="Input/output error"):
        bus.write_byte(0x3C, 0)


def test_a_read_that_breaks_off_hands_nothing_over_as_the_kernel_does() -> None:
    _, bus = bench()
    bus.fail(at_byte=2)
    answer = i2c_msg.read(0x3C, 4)
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.i2c_rdwr(answer)
    assert list(answer) == [0, 0, 0, 0]


def test_a_frame_shows_what_a_broken_transfer_left() -> None:
    chip, bus = bench()
    bus.i2c_rdwr(i2c_msg.write(0x3C, FULL))
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x40" + bytes(1024)))
    bus.fail(at_byte=65)
    with pytest.raises(OSError, match="Remote I/O error"):
        bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x40" + b"\xff" * 1024))
    expected = np.zeros((64, 128), np.uint8)
    expected[:8, :64] = 1
    assert np.array_equal(chip.frames[-1].pixels, expected)
    assert chip.frames[-1].wire_bytes == 67


@pytest.mark.parametrize("arguments", [{"after": -1}, {"at_byte": -1}, {"times": 0}])
def test_faults_that_cannot_be(arguments: dict[str, int]) -> None:
    _, bus = bench()
    with pytest.raises(ValueError, match="after and at_byte"):
        bus.fail(**arguments)  # type: ignore[arg-type]


def test_a_stuck_bus_carries_nothing_until_it_is_freed() -> None:
    chip, bus = bench()
    bus.stick(errno.EAGAIN)
    for _ in range(3):
        with pytest.raises(OSError) as caught:  # noqa: PT011
            bus.i2c_rdwr(i2c_msg.write(0x3C, FULL))
        assert caught.value.errno == errno.EAGAIN
    assert (bus.bytes, bus.messages, bus.transactions) == (0, 0, 3)
    bus.recover()
    bus.i2c_rdwr(i2c_msg.write(0x3C, FULL))
    assert chip.registers.on


def test_an_adapter_that_recovers_by_itself() -> None:
    _, bus = bench()
    bus.stick(calls=2)
    outcomes = []
    for _ in range(4):
        try:
            bus.write_quick(0x3C)
            outcomes.append(0)
        except OSError as error:
            outcomes.append(error.errno or -1)
    assert outcomes == [errno.ETIMEDOUT, errno.ETIMEDOUT, 0, 0]


@pytest.mark.parametrize(("seconds", "late"), [(0.4, False), (1.0, False), (1.5, True)])
def test_a_stretched_clock_takes_its_time_or_the_adapter_gives_up(seconds: float, late: bool) -> None:
    chip, bus = bench()
    bus.stretch(seconds, at_byte=3, after=1)
    bus.write_quick(0x3C)
    before = bus.seconds
    with pytest.raises(TimeoutError) if late else nullcontext():
        bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00\x81\x55\xaf"))
    assert bus.seconds - before == pytest.approx(min(seconds, 1), abs=1e-3)
    assert (chip.contrast, chip.registers.on) == (0x55, not late)
    bus.timeout = 2
    bus.stretch(seconds)
    bus.write_quick(0x3C)


def test_the_kernel_tries_again_as_often_as_it_was_told() -> None:
    _, bus = bench()
    bus.retries = 2
    bus.fail(errno.EAGAIN, times=2)
    bus.write_quick(0x3C)
    assert bus.transactions == 3
    bus.fail(errno.EAGAIN, times=3)
    with pytest.raises(BlockingIOError):
        bus.write_quick(0x3C)
    bus.fail(errno.ETIMEDOUT)
    with pytest.raises(TimeoutError):
        bus.write_quick(0x3C)
    assert bus.transactions == 7


def test_an_address_that_a_driver_holds() -> None:
    chip, bus = bench()
    bus.claimed.add(0x3C)
    with pytest.raises(OSError) as caught:  # noqa: PT011
        bus.write_byte_data(0x3C, 0x00, 0xAF)
    assert caught.value.errno == errno.EBUSY
    bus.write_byte_data(0x3C, 0x00, 0xAF, force=True)
    assert chip.registers.on
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00\xae"))
    assert not chip.registers.on


def test_faults_of_the_lines_that_cannot_be() -> None:
    _, bus = bench()
    with pytest.raises(ValueError, match="seconds"):
        bus.stretch(0)
    with pytest.raises(ValueError, match="errno and calls"):
        bus.stick(0)
    with pytest.raises(ValueError, match="errno and calls"):
        bus.stick(calls=0)
