"""The HT16K33: its commands, addresses and wirings, and Adafruit's driver on it."""

from __future__ import annotations

import importlib
from typing import Any

import numpy as np
import pytest
import smbus2
from PIL import Image

from paneldraw import simulator

from .helpers import BusioI2C, random_picture

ADDRESS = 0x70


def write(chip: simulator.HT16K33, *texts: str) -> None:
    """Send messages in hex."""
    for text in texts:
        chip.write(bytes.fromhex(text))


def started(width: int = 16, height: int = 8, **wiring: Any) -> simulator.HT16K33:
    chip = simulator.HT16K33(width, height, **wiring)
    write(chip, "21", "81", "00" * 17)
    return chip


def lit(chip: simulator.HT16K33) -> list[tuple[int, int]]:
    return [(int(x), int(y)) for y, x in np.argwhere(chip.pixels)]


def test_it_lights_with_oscillator_and_display_both_on() -> None:
    chip = simulator.HT16K33()
    assert any(chip.ram)  # noise
    write(chip, "81")
    assert not chip.pixels.any()
    write(chip, "21")
    assert chip.pixels.any()
    write(chip, "20")
    assert not chip.pixels.any()
    assert chip.violations == []


@pytest.mark.parametrize(
    ("command", "on", "blink"),
    [(0x80, False, 0), (0x81, True, 0), (0x83, True, 1), (0x85, True, 2), (0x87, True, 3), (0x86, False, 3)],
)
def test_display_setup(command: int, on: bool, blink: int) -> None:
    chip = started()
    chip.write(bytes([command]))
    assert (chip.registers.on, chip.registers.blink) == (on, blink)


@pytest.mark.parametrize("level", range(16))
def test_dimming(level: int) -> None:
    chip = started()
    assert chip.contrast == 15
    chip.write(bytes([0xE0 + level]))
    assert chip.contrast == level


def test_data_goes_to_an_address_and_those_behind_and_wraps() -> None:
    chip = started()
    write(chip, "0E 11 22 33")
    assert chip.ram == bytes([0x33, *[0] * 13, 0x11, 0x22])
    bus = simulator.I2CBus({ADDRESS: chip})
    answer = smbus2.i2c_msg.read(ADDRESS, 3)
    bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, [0x0E]), answer)
    assert bytes(answer) == b"\x11\x22\x33"


def test_row_15_tells_of_keys_while_it_is_the_interrupt_pin() -> None:
    chip = started()
    write(chip, "00" + "FF" * 16, "A1")
    assert not chip.pixels[:, 15].any()
    assert chip.pixels[:, :15].all()
    write(chip, "A0")
    assert chip.pixels.all()


@pytest.mark.parametrize("command", ["10", "30", "50", "70", "88", "90", "A4", "B0", "C0", "D9", "F0"])
def test_what_is_no_command(command: str) -> None:
    chip = started()
    before = vars(chip.registers).copy()
    write(chip, command)
    assert chip.violations == [f"{command}: not a command of the HT16K33; ignored"]
    assert vars(chip.registers) == before


def test_a_command_has_no_data() -> None:
    chip = simulator.HT16K33()
    write(chip, "21 81 EF")
    assert chip.violations == ["21 81 EF: a command has no data; ignored"]
    assert not chip.registers.on


@pytest.mark.parametrize(
    ("size", "wiring", "address", "bit", "seen"),
    [
        ((16, 8), {}, 0, 0, (0, 0)),
        ((16, 8), {}, 15, 7, (15, 7)),
        ((16, 8), {}, 5, 2, (10, 2)),
        ((16, 8), {"mirror_x": True}, 5, 2, (5, 2)),
        ((16, 8), {"mirror_y": True}, 5, 2, (10, 5)),
        ((16, 8), {"board": "featherwing"}, 5, 2, (10, 2)),
        ((16, 8), {"board": "featherwing"}, 4, 7, (2, 7)),
        ((8, 8), {}, 6, 7, (0, 3)),
        ((8, 8), {}, 6, 0, (1, 3)),
    ],
)
def test_which_bit_lights_which_pixel(size: Any, wiring: Any, address: int, bit: int, seen: Any) -> None:
    chip = started(*size, **wiring)
    chip.write(bytes([address, 1 << bit]))
    assert lit(chip) == [seen]


@pytest.mark.parametrize("wrong", [{"width": 8, "height": 16}, {"board": "wing"}, {"width": 8, "board": "featherwing"}])
def test_what_there_is_not(wrong: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=r"width and height|board"):
        simulator.HT16K33(**wrong)
    with pytest.raises(ValueError, match="HT16K33 cannot sit on SPI, but on I2C"):
        simulator.SPIBus(simulator.HT16K33())


@pytest.mark.parametrize(
    ("name", "size", "wiring"),
    [
        ("Matrix8x8", (8, 8), {}),
        ("Matrix16x8", (16, 8), {"board": "featherwing"}),
        ("MatrixBackpack16x8", (16, 8), {"board": "backpack"}),
    ],
)
def test_adafruit(name: str, size: tuple[int, int], wiring: dict[str, str]) -> None:
    chip = simulator.HT16K33(*size, **wiring)
    bus = simulator.I2CBus({ADDRESS: chip}, timer=None)
    matrix = importlib.import_module("adafruit_ht16k33.matrix")
    device = getattr(matrix, name)(BusioI2C(bus), auto_write=False)
    for seed in range(3):
        picture = random_picture(*size, seed)
        device.image(Image.fromarray(picture * 255).convert("1"))
        device.show()
        assert np.array_equal(chip.frames[-1].pixels, picture)
    device.brightness = 0.2
    device.blink_rate = 2
    assert (chip.contrast, chip.registers.blink) == (3, 2)
    assert (chip.violations, chip.remarks) == ([], [])
