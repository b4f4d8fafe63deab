"""Hardware scrolling in its own time: which pixels move, when, and what is a frame."""

from __future__ import annotations

import numpy as np
import pytest
from smbus2 import i2c_msg

from paneldraw import simulator

from .helpers import commands, init, pack, random_picture

PICTURE = random_picture(128, 64, 1)
FRAME = (15 + 1 + 50) * 64 / 370_000
"""Seconds a frame under D5 80, D9 F1 and A8 3F: 66 clocks a line, 64 lines, 370 kHz."""


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


def scrolling(
    setup: str, chip: simulator.SSD1306 | None = None, timer: Clock | None = None
) -> tuple[simulator.SSD1306, simulator.I2CBus]:
    """A chip that begins to scroll at the end of the call, its frames cleared."""
    chip = chip or simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip}, timer=timer)
    bus.i2c_rdwr(
        i2c_msg.write(0x3C, b"\x00" + init(128, 64)),
        i2c_msg.write(0x3C, b"\x40" + pack(PICTURE).tobytes()),
        i2c_msg.write(0x3C, b"\x00" + bytes.fromhex(setup)),
    )
    chip.frames.clear()
    return chip, bus


def moved(pages: slice, columns: int, rows: int = 0) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    picture = PICTURE.copy()
    lines = slice(8 * pages.start, 8 * pages.stop)
    picture[lines] = np.roll(picture[lines], columns, axis=1)
    return np.roll(picture, -rows, axis=0)


@pytest.mark.parametrize(("opcode", "columns"), [("26", 1), ("27", -1)])
def test_pages_move_by_a_column_every_so_many_frames(opcode: str, columns: int) -> None:
    chip, bus = scrolling(f"{opcode} 00 02 00 05 00 FF 2F")
    start = bus.seconds
    bus.idle(4.9 * FRAME)
    assert len(chip.frames) == 0
    bus.idle(10.2 * FRAME)
    assert [frame.seconds for frame in chip.frames] == pytest.approx([start + n * 5 * FRAME for n in (1, 2, 3)])
    for steps, frame in enumerate(chip.frames, 1):
        assert np.array_equal(frame.pixels, moved(slice(2, 6), steps * columns))
    assert np.array_equal(chip.pixels, chip.frames[-1].pixels)


@pytest.mark.parametrize(("code", "frames"), list(enumerate((5, 64, 128, 256, 3, 4, 25, 2))))
def test_intervals(code: int, frames: int) -> None:
    chip, bus = scrolling(f"26 00 00 {code:02X} 07 00 FF 2F")
    bus.idle(3.5 * frames * FRAME)
    assert len(chip.frames) == 3


@pytest.mark.parametrize(
    ("chip", "frames"),
    [(simulator.SSD1309, (5, 64, 128, 256, 2, 3, 4, 1)), (simulator.SSD1315, (6, 32, 64, 128, 3, 4, 5, 2))],
)
def test_relatives_have_intervals_of_their_own(chip: type[simulator.SSD1306], frames: tuple[int, ...]) -> None:
    columns = {simulator.SSD1309: "00 00 7F", simulator.SSD1315: "00 7F"}[chip]
    for code, count in enumerate(frames):
        made, bus = scrolling(f"26 00 00 {code:02X} 07 {columns} 2F", chip())
        bus.idle(3.5 * count * made.frame_seconds)
        assert len(made.frames) == 3, code


def test_a_single_step_leaves_what_comes_in_blank_or_rolls_it_round() -> None:
    for blank in (1, 0):
        chip, bus = scrolling("2E", simulator.SSD1315())
        bus.write_i2c_block_data(0x3C, 0x00, [0x2D, 0, 2, blank, 5, 8, 0x78])  # the sheet's example, and 00 for 01
        expected = PICTURE.copy()
        expected[16:48, 8:121] = np.roll(PICTURE[16:48, 8:121], -1, axis=1)
        if blank:
            expected[16:48, 120] = 0
        assert np.array_equal(chip.pixels, expected)
        assert chip.violations == []


def test_diagonal_moves_rows_up_too_within_its_area() -> None:
    chip, bus = scrolling("29 00 00 07 07 03 2F")
    bus.idle(2.5 * 2 * FRAME)
    assert np.array_equal(chip.pixels, moved(slice(0, 8), 2, 6))
    chip, bus = scrolling("A3 10 10 2A 00 00 07 01 01 2F")
    bus.idle(1.5 * 2 * FRAME)
    expected = moved(slice(0, 2), -1)
    expected[16:32] = np.roll(expected[16:32], -1, axis=0)
    assert np.array_equal(chip.pixels, expected)


def test_a_stop_takes_hold_at_its_own_time_and_leaves_the_ram_moved() -> None:
    chip, bus = scrolling("26 00 00 07 07 00 FF 2F")
    bus.idle(2.5 * 2 * FRAME)
    bus.write_byte_data(0x3C, 0x00, 0x2E)
    bus.idle(10)
    assert np.array_equal(chip.pixels, moved(slice(0, 8), 2))
    assert len(chip.frames) == 2
    bus.write_byte_data(0x3C, 0x00, 0x2F)
    bus.idle(1.5 * 2 * FRAME)
    assert np.array_equal(chip.pixels, moved(slice(0, 8), 3))
    assert chip.violations == []


def test_a_long_rest_keeps_as_many_frames_as_there_is_room_for() -> None:
    chip, bus = scrolling("26 00 00 07 07 00 FF 2F", simulator.SSD1306(history=10))
    bus.idle((128_000 + 5.5) * 2 * FRAME)
    assert len(chip.frames) == 10
    assert np.array_equal(chip.pixels, moved(slice(0, 8), 5))


def test_who_looks_sees_it_where_the_hosts_time_has_brought_it() -> None:
    clock = Clock()
    chip, _ = scrolling("27 00 00 07 07 00 FF 2F", timer=clock)
    clock.now += 10 + 3.5 * 2 * FRAME
    shown = len(chip.frames)
    assert shown > 100
    assert np.array_equal(chip.pixels, moved(slice(0, 8), -shown))
    assert np.array_equal(chip.frames[-1].pixels, chip.pixels)


def test_a_slower_clock_and_fewer_lines_tell_on_the_time() -> None:
    chip, bus = scrolling("D5 81 A8 1F D9 22 26 00 00 07 03 00 FF 2F")
    assert chip.frame_seconds == pytest.approx(54 * 32 * 2 / 370_000)
    bus.idle(2.5 * 2 * chip.frame_seconds)
    assert len(chip.frames) == 2


def test_reset_and_power_loss_end_it() -> None:
    for end in ("reset", "power_cycle"):
        chip, bus = scrolling("26 00 00 07 07 00 FF 2F")
        getattr(chip, end)()
        ram = chip.ram
        bus.idle(1)
        assert np.array_equal(chip.ram, ram)


def test_the_ssd1309_has_windows_of_columns_and_one_step_at_a_time() -> None:
    chip = simulator.SSD1309()
    _, bus = scrolling("26 00 01 04 02 00 10 1F 2F", chip)
    bus.idle(1.5 * 2 * chip.frame_seconds)
    expected = PICTURE.copy()
    expected[8:24, 16:32] = np.roll(expected[8:24, 16:32], 1, axis=1)
    assert np.array_equal(chip.pixels, expected)
    bus.write_i2c_block_data(0x3C, 0x00, [0x2E, 0x2D, 0, 1, 0, 2, 0, 0x10, 0x1F])
    assert np.array_equal(chip.pixels, PICTURE)
    _, bus = scrolling("29 00 00 04 07 02 00 7F 2F", chip)
    bus.idle(1.5 * 2 * chip.frame_seconds)
    assert np.array_equal(chip.pixels, np.roll(PICTURE, -2, axis=0)), "without columns, as bit 0 of A is 0"
    assert chip.violations == []
    commands(chip, "2E 26 00 01 07 02 00 1F 10")
    assert chip.violations == ["26 00 01 07 02 00 1F 10: the scroll's end column is before its start column"]
