"""Drivers by others run unchanged on the simulated bus, their pictures arrive, and what they do wrong is recorded."""

from __future__ import annotations

import importlib
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import smbus2
from PIL import Image

from paneldraw import simulator

from .helpers import BusioI2C, pack, random_picture

LUMA_SIZES = [(128, 64), (128, 32), (96, 16), (64, 48), (64, 32)]
ADAFRUIT_SIZES = [(128, 64), (128, 32), (72, 40), (64, 48), (64, 32), (48, 64)]
ADDRESS = 0x3C


def bench(width: int, height: int, **options: int) -> tuple[simulator.SSD1306, simulator.I2CBus]:
    chip = simulator.SSD1306(width, height, **options)  # type: ignore[arg-type]
    return chip, simulator.I2CBus({ADDRESS: chip}, timer=None)


def as_image(picture: np.ndarray[Any, Any]) -> Image.Image:
    return Image.fromarray(picture * 255).convert("1")


# luma.oled


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("managed", [False, True], ids=["bus given", "bus opened by luma"])
@pytest.mark.parametrize(("width", "height"), LUMA_SIZES)
def test_luma(width: int, height: int, managed: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    from luma.core.interface.serial import i2c
    from luma.oled.device import ssd1306

    chip, bus = bench(width, height)
    monkeypatch.setattr(smbus2, "SMBus", lambda port: bus)
    device = ssd1306(i2c(port=1) if managed else i2c(bus=bus), width, height)
    device.persist = True
    for seed in range(3):
        picture = random_picture(width, height, seed)
        bytes_before, messages_before = bus.bytes, bus.messages
        device.display(as_image(picture))
        assert np.array_equal(chip.pixels, picture)
        if managed:
            assert bus.messages - messages_before == 2
            assert bus.bytes - bytes_before == width * height // 8 + 10
    assert chip.violations == []
    assert chip.remarks == ["DB 40: the VCOMH level is 00, 20 or 30"]

    device.contrast(0x21)
    assert chip.contrast == 0x21
    device.hide()
    assert not chip.pixels.any()
    device.show()
    assert np.array_equal(chip.pixels, picture)
    device.clear()
    assert not chip.pixels.any()


def test_luma_says_so_when_nobody_answers() -> None:
    from luma.core.error import DeviceNotFoundError
    from luma.core.interface.serial import i2c
    from luma.oled.device import ssd1306

    with pytest.raises(DeviceNotFoundError, match="0x3D"):
        ssd1306(i2c(bus=simulator.I2CBus({ADDRESS: simulator.SSD1306()}), address=0x3D))


# Adafruit's driver, over an object with busio's interface


@pytest.fixture
def adafruit() -> ModuleType:
    return importlib.import_module("adafruit_ssd1306")


def draw(device: Any, picture: np.ndarray[Any, Any]) -> None:
    device.fill(0)
    for y, x in np.argwhere(picture):
        device.pixel(int(x), int(y), 1)
    device.show()


ADAFRUIT_REMARKS = [
    "AF: display on before the panel has a supply (8D 14)",
    "AD 30: not a command of the SSD1306 (supply of the SH1106 and the SSD1305, reference current of the SSD1315); "
    "ignored",
]


@pytest.mark.parametrize(("width", "height"), ADAFRUIT_SIZES)
def test_adafruit(adafruit: ModuleType, width: int, height: int) -> None:
    chip, bus = bench(width, height)
    device = adafruit.SSD1306_I2C(width, height, BusioI2C(bus))
    for seed in range(3):
        picture = random_picture(width, height, seed)
        bytes_before, messages_before = bus.bytes, bus.messages
        draw(device, picture)
        assert np.array_equal(chip.pixels, picture)
        assert bus.messages - messages_before == 7
        assert bus.bytes - bytes_before == width * height // 8 + 20
    assert chip.violations == []
    assert chip.remarks == ADAFRUIT_REMARKS

    device.invert(True)
    assert np.array_equal(chip.pixels, 1 - picture)
    device.invert(False)
    device.contrast(9)
    assert chip.contrast == 9
    device.rotate(False)
    device.show()
    assert np.array_equal(chip.pixels, picture[::-1, ::-1])
    device.poweroff()
    assert not chip.pixels.any()


def test_adafruit_centers_a_96x16_which_common_modules_do_not(adafruit: ModuleType) -> None:
    """It sends to columns 16 to 111; U8g2 and luma.oled have such modules at 0 to 95."""
    picture = random_picture(96, 16, 1)
    centered, centered_bus = bench(96, 16, column_offset=16)
    draw(adafruit.SSD1306_I2C(96, 16, BusioI2C(centered_bus)), picture)
    assert np.array_equal(centered.pixels, picture)
    common, common_bus = bench(96, 16)
    draw(adafruit.SSD1306_I2C(96, 16, BusioI2C(common_bus)), picture)
    assert np.array_equal(common.pixels[:, 16:], picture[:, :80])


@pytest.mark.parametrize("height", [48, 32])
def test_adafruit_page_addressing_works_by_accident(adafruit: ModuleType, height: int) -> None:
    """It asks for mode 10 in binary and sends 10 in hex, which leaves the chip in horizontal mode."""
    chip, bus = bench(64, height)
    picture = random_picture(64, height, 1)
    draw(adafruit.SSD1306_I2C(64, height, BusioI2C(bus), page_addressing=True), picture)
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []
    assert "20 10: the upper bits of the addressing mode are 0" in chip.remarks
    assert any("page pointer commands" in text for text in chip.remarks)


def test_adafruit_external_supply(adafruit: ModuleType) -> None:
    picture = random_picture(128, 64, 2)
    supplied = simulator.SSD1306(external_vcc=True)
    draw(
        adafruit.SSD1306_I2C(128, 64, BusioI2C(simulator.I2CBus({ADDRESS: supplied})), external_vcc=True),
        picture,
    )
    assert np.array_equal(supplied.pixels, picture)
    chip, bus = bench(128, 64)
    draw(adafruit.SSD1306_I2C(128, 64, BusioI2C(bus), external_vcc=True), picture)
    assert not chip.pixels.any()
    assert chip.violations == ["a picture for a panel that is on without a supply (8D 14) stays dark"]


def test_adafruit_says_so_when_nobody_answers(adafruit: ModuleType) -> None:
    with pytest.raises(ValueError, match="0x3d"):
        adafruit.SSD1306_I2C(128, 64, BusioI2C(bench(128, 64)[1]), addr=0x3D)


# The byte streams of U8g2: a command and its arguments a transaction, tiles of 8 x 8 in rows, data in pieces of 24

U8G2_INIT = {
    (128, 64): "AE, D5 80, A8 3F, D3 00, 40, 8D 14, 20 00, A1, C8, DA 12, 81 CF, D9 F1, DB 40, 2E, A4, A6, AF",
    (96, 16): "AE, D5 80, A8 0F, D3 00, 40, 8D 14, 20 00, A1, C8, DA 02, 81 AF, D9 F1, DB 20, 2E, A4, A6, AF",
    (72, 40): "AE, D5 80, A8 27, D3 00, AD 30, 8D 14, 40, A6, A4, 20 00, A1, C8, DA 12, 81 AF, D9 22, DB 20, 2E, AF",
}
U8G2_OFFSETS = {(128, 64): (0, 0), (96, 16): (0, 32), (72, 40): (28, 28)}


def u8g2_tiles(bus: simulator.I2CBus, picture: np.ndarray[Any, Any], left: int) -> None:
    for page, row in enumerate(pack(picture)):
        for command in (0x10 | left >> 4, left & 0x0F, 0xB0 | page):
            bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, [0x00, command]))
        for at in range(0, row.size, 24):
            bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, b"\x40" + row[at : at + 24].tobytes()))


@pytest.mark.parametrize(("width", "height"), U8G2_INIT)
def test_u8g2_upright_and_flipped(width: int, height: int) -> None:
    chip, bus = bench(width, height)
    for command in U8G2_INIT[width, height].split(","):
        bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, b"\x00" + bytes.fromhex(command)))
    upright, flipped = U8G2_OFFSETS[width, height]
    picture = random_picture(width, height, 1)
    u8g2_tiles(bus, picture, upright)
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []
    assert len([text for text in chip.remarks if "page pointer commands" in text]) == 1
    for command in (0xA0, 0xC0):
        bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, [0x00, command]))
    u8g2_tiles(bus, picture, flipped)
    assert np.array_equal(chip.pixels, picture[::-1, ::-1])


# In the style of small microcontroller code: page mode, every byte behind a control byte of its own


def test_a_driver_that_chains_control_bytes() -> None:
    chip, bus = bench(128, 64)
    picture = random_picture(128, 64, 1)
    bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, bytes.fromhex("80AE 808D 8014 80A1 80C8 80AF")))
    for page, row in enumerate(pack(picture)):
        chained = b"".join(bytes([0xC0, byte]) for byte in row)
        bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, bytes([0x80, 0xB0 | page, 0x80, 0x00, 0x80, 0x10]) + chained))
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []


# The order of commands of other drivers, as data: name of the chip, its start, the commands before the data of a page
# or of a picture, and what is merely remarked. MicroPython: drivers ssd1306.py (micropython-lib) and sh1106.py
# (robert-hh/SH1106), the latter with rotate=180; Linux: drivers/video/fbdev/ssd1307fb.c and
# drivers/gpu/drm/solomon/ssd130x.c with the defaults of their tables, com-invdir and page-offset 0.

WINDOW = "21 00 7F 22 00 07"
STARTS = {
    "MicroPython ssd1306": (
        "SSD1306",
        "AE 20 00 40 A1 A8 3F C8 D3 00 DA 12 D5 80 D9 F1 DB 30 81 FF A4 A6 AD 30 8D 14 AF",
        WINDOW,
        1,
    ),
    "MicroPython sh1106": ("SH1106", "AF A1 C8", "B{:X} 02 10", 0),
    "Linux ssd1307fb": (
        "SSD1306",
        "81 7F A1 C8 A8 3F D3 00 D5 80 D9 22 DA 12 DB 20 8D 14 20 00 AF",
        WINDOW,
        0,
    ),
    "Linux ssd130x": (
        "SSD1306",
        "81 7F A1 C8 A8 3F D3 00 D5 80 D9 22 DA 12 DB 20 8D 14 20 00 AF",
        WINDOW,
        0,
    ),
    "Linux ssd130x, sh1106": (
        "SH1106",
        "81 7F A1 C8 A8 3F D3 00 D5 50 D9 22 DA 12 DB 40 8D 10 20 02 AF",
        "B{:X} 02 10",
        2,
    ),
    "Linux ssd130x, ssd1309": (
        "SSD1309",
        "81 7F A1 C8 A8 3F D3 00 D5 A0 D9 22 DA 12 DB 34 8D 10 20 00 AF",
        WINDOW,
        1,
    ),
}


@pytest.mark.parametrize("name", STARTS)
def test_starts_of_other_drivers_light_the_chip_upright_without_a_violation(name: str) -> None:
    chip_name, start, before, remarks = STARTS[name]
    chip = getattr(simulator, chip_name)()
    bus, picture = simulator.I2CBus({ADDRESS: chip}, timer=None), random_picture(128, 64, 1)
    for command in bytes.fromhex(start):
        bus.write_byte_data(ADDRESS, 0x80, command)
    pages = pack(picture)
    for number, rows in enumerate([pages] if before == WINDOW else pages):
        for command in bytes.fromhex(before.format(number)):
            bus.write_byte_data(ADDRESS, 0x80, command)
        bus.i2c_rdwr(smbus2.i2c_msg.write(ADDRESS, b"\x40" + rows.tobytes()))
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []
    assert len(chip.remarks) == remarks
    assert np.array_equal(chip.frames[-1].pixels, picture)
    assert len(chip.frames) <= 3  # noise, noise mirrored, the picture
