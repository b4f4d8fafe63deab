"""When a frame is recorded, and what it carries."""

from __future__ import annotations

import numpy as np
import pytest
from smbus2 import i2c_msg

from paneldraw import simulator

from .helpers import init


class Clock:
    def __init__(self) -> None:
        self.now = 1000.0

    def __call__(self) -> float:
        return self.now


def bench(**options: object) -> tuple[simulator.SSD1306, simulator.I2CBus]:
    chip = simulator.SSD1306(**options)  # type: ignore[arg-type]
    return chip, simulator.I2CBus({0x3C: chip}, timer=None)


def level(bus: simulator.I2CBus, byte: int) -> None:
    """Fill the RAM with one byte in one call."""
    bus.i2c_rdwr(
        i2c_msg.write(0x3C, [0, 0x21, 0, 127, 0x22, 0, 7]), i2c_msg.write(0x3C, b"\x40" + bytes([byte]) * 1024)
    )


def test_a_call_that_changes_what_the_eye_sees_is_a_frame_and_no_other() -> None:
    chip, bus = bench()
    bus.write_i2c_block_data(0x3C, 0x00, [0x20, 0x00])
    level(bus, 0)
    assert not chip.frames, "the panel is off"
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + init(128, 64)))
    assert not chip.frames, "the panel is on and shows black"
    level(bus, 0x0F)
    level(bus, 0x0F)
    bus.write_byte_data(0x3C, 0x00, 0xE3)
    assert len(chip.frames) == 1
    bus.write_byte_data(0x3C, 0x00, 0xA7)
    bus.write_byte_data(0x3C, 0x00, 0xAE)
    shares = [float(frame.pixels.mean()) for frame in chip.frames]
    assert shares == [0.5, 0.5, 0.0]
    assert not np.array_equal(chip.frames[0].pixels, chip.frames[1].pixels)


def test_a_frame_counts_the_bytes_since_the_one_before() -> None:
    chip, bus = bench()
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + init(128, 64)))
    level(bus, 0xFF)
    level(bus, 0xFF)
    bus.write_byte_data(0x3C, 0x00, 0xA7)
    counts = [frame.wire_bytes for frame in chip.frames]
    assert counts[-2:] == [1034, 1034 + 3]
    assert sum(counts) == bus.bytes


def test_frames_are_stamped_with_the_time_on_the_wire() -> None:
    chip, bus = bench()
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + init(128, 64)))
    level(bus, 0x55)
    assert chip.frames[-1].seconds == bus.seconds
    bus.idle(0.5)
    level(bus, 0xAA)
    assert chip.frames[-1].seconds == pytest.approx(bus.seconds + 0.5)
    with pytest.raises(ValueError, match="seconds"):
        bus.idle(-1)


def test_a_script_that_pauses_leaves_pauses_and_one_that_does_not_waits_for_the_wire() -> None:
    clock, chip = Clock(), simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip}, timer=clock)
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + init(128, 64)))
    chip.frames.clear()
    for pause in (1.0, 0.0, 0.0, 2.0):
        clock.now += pause
        level(bus, 0x55 if bus.transactions % 2 else 0xAA)
    wire = (9 * 1034 + 3) / 400_000
    assert [frame.seconds for frame in chip.frames] == pytest.approx([1.0, 1.0 + wire, 1.0 + 2 * wire, 3.0])


def test_history_is_bounded() -> None:
    chip, bus = bench(history=3)
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + init(128, 64)))
    for byte in range(1, 9):
        level(bus, byte)
    assert [int(frame.pixels[:8, 0] @ (1 << np.arange(8))) for frame in chip.frames] == [6, 7, 8]
    assert simulator.SSD1306().frames.maxlen == 1000
    assert simulator.SSD1306(history=None).frames.maxlen is None


def test_frames_keep_their_picture() -> None:
    chip, bus = bench()
    bus.i2c_rdwr(i2c_msg.write(0x3C, b"\x00" + init(128, 64)))
    level(bus, 0xFF)
    first = chip.frames[-1]
    level(bus, 0x00)
    assert first.pixels.all()
    with pytest.raises(ValueError, match="read-only"):
        first.pixels[0, 0] = 0


def test_a_chip_without_a_bus_is_settled_by_hand() -> None:
    chip = simulator.SSD1306()
    chip.write(b"\x00" + init(128, 64) + b"\xa5")
    assert not chip.frames
    chip.settle(1.5, 30)
    assert [(frame.seconds, frame.wire_bytes) for frame in chip.frames] == [(1.5, 30)]
