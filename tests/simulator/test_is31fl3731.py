"""The IS31FL3731: pages, frames and registers, wirings, and Adafruit's driver on it."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest
import smbus2
from PIL import Image

from paneldraw import simulator

from .helpers import BusioI2C

ADDRESS = 0x74


def write(chip: simulator.IS31FL3731, *texts: str) -> None:
    """Send messages in hex."""
    for text in texts:
        chip.write(bytes.fromhex(text))


def started(*size: int) -> simulator.IS31FL3731:
    chip = simulator.IS31FL3731(*size)
    write(chip, "FD 0B", "0A 01", "FD 00", "00" + "FF" * 18)
    return chip


def greys(width: int, height: int, seed: int) -> np.ndarray[Any, Any]:
    return np.random.default_rng(seed).integers(0, 256, (height, width), dtype=np.uint8)


def test_a_led_needs_power_its_switch_and_a_brightness() -> None:
    chip = simulator.IS31FL3731()
    write(chip, "FD 00", "24 80")
    assert not chip.pixels.any()
    write(chip, "00 01")
    assert not chip.pixels.any()
    write(chip, "FD 0B", "0A 01")
    assert chip.pixels[0, 0] == 128
    assert chip.pixels.sum() == 128
    write(chip, "0A 00")
    assert not chip.pixels.any()


def test_switches_are_bits_eight_leds_a_byte() -> None:
    chip = started()
    write(chip, "24" + "07" * 144, "03 A0")
    assert chip.pixels[1].tolist() == [7] * 8 + [0, 0, 0, 0, 0, 7, 0, 7]


def test_the_frame_that_is_shown() -> None:
    chip = started()
    write(chip, "FD 05", "00 FF", "24 09", "FD 0B", "01 05")
    assert chip.pixels[0, 0] == 9
    write(chip, "05 20")  # all frames take the brightness of the first
    assert chip.pixels[0, 0] == 0
    write(chip, "05 00", "00 0D", "01 00")  # frames play from the fifth on
    assert chip.pixels[0, 0] == 9


def test_registers_can_be_read() -> None:
    chip = started()
    bus = simulator.I2CBus({ADDRESS: chip})
    write(chip, "24 01 02 03")
    for register, held in ((0x24, b"\x01\x02\x03"), (0x00, b"\xff\xff\xff"), (0xFD, b"\x00\x00\x00")):
        answer = smbus2.i2c_msg.read(ADDRESS, 3)
        bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, [register]), answer)
        assert bytes(answer) == held


@pytest.mark.parametrize(
    ("messages", "violation"),
    [
        (["FD 08"], "FD 08: pages are 00 to 07 and 0B"),
        (["B4 01"], "B4 01: there is no such register on page 00; ignored"),
        (["FD 0B", "0E 01"], "0E 01: there is no such register on page 0B; ignored"),
    ],
)
def test_what_is_not_there(messages: list[str], violation: str) -> None:
    chip = started()
    write(chip, *messages)
    assert chip.violations == [violation]


@pytest.mark.parametrize(
    ("size", "register", "seen"),
    [
        ((16, 9), 0x24 + 16 * 3 + 5, (5, 3)),
        ((15, 7), 0x24 + 7, (0, 0)),
        ((15, 7), 0x24 + 16 * 7 + 1, (7, 6)),
        ((15, 7), 0x24 + 16 * 7 + 8, (8, 0)),
        ((15, 7), 0x24 + 16 * 1 + 14, (14, 6)),
        ((16, 8), 0x24 + 16 * 1 + 7, (0, 0)),
        ((16, 8), 0x24 + 16 * 1 + 8, (8, 7)),
        ((17, 7), 0x24 + 16 * 8 + 6, (0, 0)),
        ((17, 7), 0x24 + 16 * 7 + 14, (16, 6)),
        ((11, 7), 0x24 + 16 * 5 + 6, (5, 0)),
        ((11, 7), 0x24 + 16 * 0 + 14, (6, 0)),
    ],
)
def test_which_register_lights_which_pixel(size: tuple[int, int], register: int, seen: tuple[int, int]) -> None:
    chip = started(*size)
    chip.write(bytes([register, 200]))
    assert [(int(x), int(y)) for y, x in np.argwhere(chip.pixels == 200)] == [seen]


def test_sizes_that_there_are_not() -> None:
    with pytest.raises(ValueError, match="8x8 is none of 16x9, 15x7"):
        simulator.IS31FL3731(8, 8)


@pytest.mark.parametrize(
    ("module", "name", "size"),
    [
        ("matrix", "Matrix", (16, 9)),
        ("charlie_wing", "CharlieWing", (15, 7)),
        ("charlie_bonnet", "CharlieBonnet", (16, 8)),
        ("scroll_phat_hd", "ScrollPhatHD", (17, 7)),
        ("matrix_11x7", "Matrix11x7", (11, 7)),
    ],
)
def test_adafruit(module: str, name: str, size: tuple[int, int]) -> None:
    chip = simulator.IS31FL3731(*size)
    bus = simulator.I2CBus({ADDRESS: chip}, timer=None)
    board = getattr(importlib.import_module(f"adafruit_is31fl3731.{module}"), name)
    device = board.__new__(board)
    # That of Matrix11x7 hands its address on as frames, and cannot be called.
    importlib.import_module("adafruit_is31fl3731").IS31FL3731.__init__(device, BusioI2C(bus), address=ADDRESS)
    for seed in range(3):
        picture = greys(*size, seed)
        device.image(Image.fromarray(picture), frame=0)  # of none, Matrix writes to the page that is selected
        assert np.array_equal(chip.pixels, picture)
    assert [np.array_equal(frame.pixels, greys(*size, seed)) for seed, frame in enumerate(chip.frames)] == [True] * 3
    device.sleep(True)
    assert not chip.pixels.any()
    device.sleep(False)
    assert np.array_equal(chip.pixels, picture)
    assert (chip.violations, chip.remarks) == ([], [])
