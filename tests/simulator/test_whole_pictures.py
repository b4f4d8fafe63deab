"""One frame a picture, whoever drives the chip: drivers by others, our own, and the rule itself call by call."""

from __future__ import annotations

import importlib
import threading
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import smbus2
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image

from paneldraw import Panel, controllers, simulator
from paneldraw.simulator.frames import Progress
from paneldraw.transports import I2CTransport, SPITransport

from .helpers import commands, init, pack, random_picture
from .test_peers import BusioI2C, draw

Picture = NDArray[np.uint8]
PICTURES = [random_picture(128, 64, seed) for seed in range(3)]


def bench(chip: simulator.SSD1306 | simulator.SH1106) -> simulator.I2CBus:
    return simulator.I2CBus({0x3C: chip}, timer=None)


def shown(chip: Any) -> list[Picture]:
    return [frame.pixels for frame in chip.frames]


def same(frames: list[Picture], pictures: list[Picture]) -> bool:
    return len(frames) == len(pictures) and all(map(np.array_equal, frames, pictures))


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("managed", [False, True], ids=["blocks of 32", "one message"])
@pytest.mark.parametrize("name", ["ssd1306", "sh1106"])
def test_luma(name: str, managed: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    from luma.core.interface.serial import i2c
    from luma.oled import device as devices

    chip = getattr(simulator, name.upper())()
    bus = bench(chip)
    monkeypatch.setattr(smbus2, "SMBus", lambda port: bus)
    device = getattr(devices, name)(i2c(port=1) if managed else i2c(bus=bus))
    device.persist = True
    for picture in PICTURES:
        device.display(Image.fromarray(picture * 255).convert("1"))
    assert same(shown(chip), PICTURES)
    assert sum(frame.wire_bytes for frame in chip.frames) == bus.bytes


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("name", ["ssd1306", "sh1106", "ssd1322"])
def test_luma_on_spi(name: str) -> None:
    from luma.core.interface.serial import spi
    from luma.oled import device as devices

    chip = getattr(simulator, name.upper())()
    bus = simulator.SPIBus(chip, timer=None)
    device = getattr(devices, name)(spi(spi=bus.spi, gpio=bus.gpio))
    device.persist = True
    pictures = [random_picture(chip.width, chip.height, seed) * chip.max_level for seed in range(3)]
    for picture in pictures:
        device.display(Image.fromarray(picture // chip.max_level * 255).convert(device.mode))
    assert same(shown(chip), pictures)


def test_ours_on_spi_whole_pictures() -> None:
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip, timer=None)
    panel = Panel(controllers.SSD1306(128, 64), SPITransport(spi=bus.spi, pins=bus.pins))
    for picture in PICTURES:
        panel.show(picture)
    assert same(shown(chip), PICTURES)


def test_ours_on_spi_with_a_pause_in_between() -> None:
    """There a plan is several calls; what tells small ones apart that lie in different places is time."""
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip, timer=None)
    panel = Panel(controllers.SSD1306(128, 64), SPITransport(spi=bus.spi, pins=bus.pins))
    fb = panel.framebuffer()
    expected = []
    for x, y in ((3, 5), (100, 60), (64, 20), (64, 60)):
        fb.pixel(x, y, 1)
        panel.show(fb)
        bus.idle(0.03)
        expected.append(fb.pixels.copy())
    assert same(shown(chip), expected)


def test_adafruit() -> None:
    chip = simulator.SSD1306()
    device = importlib.import_module("adafruit_ssd1306").SSD1306_I2C(128, 64, BusioI2C(bench(chip)))
    chip.frames.clear()
    for picture in PICTURES:
        draw(device, picture)
    assert same(shown(chip), PICTURES)


def send_bytes(bus: simulator.I2CBus, picture: Picture) -> None:
    for page, row in enumerate(pack(picture)):
        for command in (0xB0 | page, 0x00, 0x10):
            bus.write_byte_data(0x3C, 0x00, command)
        for byte in row:
            bus.write_byte_data(0x3C, 0x40, int(byte))


def send_pages_from_below(bus: simulator.I2CBus, picture: Picture) -> None:
    for page, row in reversed(list(enumerate(pack(picture)))):
        bus.i2c_rdwr(smbus2.i2c_msg.write(0x3C, [0x00, 0xB0 | page, 0x00, 0x10]))
        bus.i2c_rdwr(smbus2.i2c_msg.write(0x3C, b"\x40" + row.tobytes()))


@pytest.mark.parametrize("send", [send_bytes, send_pages_from_below])
def test_drivers_that_go_by_small_steps(send: Callable[[simulator.I2CBus, Picture], None]) -> None:
    chip = simulator.SSD1306()
    bus = bench(chip)
    commands(chip, init(128, 64, 2).hex())
    bus.write_quick(0x3C)
    chip.frames.clear()
    for picture in PICTURES:
        send(bus, picture)
    assert same(shown(chip), PICTURES)


def test_a_driver_that_sets_its_window_once_and_then_sends_data_alone() -> None:
    chip = simulator.SSD1306()
    bus = bench(chip)
    commands(chip, init(128, 64).hex())
    bus.write_i2c_block_data(0x3C, 0x00, [0x21, 0, 127, 0x22, 0, 7])
    chip.frames.clear()
    for picture in PICTURES:
        data = pack(picture).tobytes()
        for at in range(0, 1024, 32):
            bus.write_i2c_block_data(0x3C, 0x40, data[at : at + 32])
    assert same(shown(chip), PICTURES)


def panel_on(chip: simulator.SSD1306) -> Panel:
    return Panel(controllers.SSD1306(128, 64), I2CTransport(bench(chip)))


@given(st.lists(st.lists(st.tuples(st.integers(0, 127), st.integers(0, 63)), min_size=1, max_size=8), max_size=12))
def test_every_show_of_ours_is_a_frame(shows: list[list[tuple[int, int]]]) -> None:
    chip = simulator.SSD1306()
    panel = panel_on(chip)
    fb = panel.framebuffer()
    expected: list[Picture] = []
    for dots in shows:
        for x, y in dots:
            fb.pixel(x, y, 1)
        if not expected or not np.array_equal(fb.pixels, expected[-1]):
            expected.append(fb.pixels.copy())
        panel.show(fb)
    assert same(shown(chip), expected)


def test_a_bar_that_grows_by_a_byte_that_needs_no_command_is_a_frame_a_byte() -> None:
    chip = simulator.SSD1306()
    panel = panel_on(chip)
    fb = panel.framebuffer()
    for x in range(40):
        fb.pixel(x, 3, 1)
        panel.show(fb)
    assert [int(pixels.sum()) for pixels in shown(chip)] == list(range(1, 41))


def test_a_command_that_changes_what_is_seen_is_a_frame_and_does_not_end_a_picture() -> None:
    chip = simulator.SSD1306()
    bus = bench(chip)
    bus.i2c_rdwr(smbus2.i2c_msg.write(0x3C, b"\x00" + init(128, 64, 2)))
    send_bytes(bus, PICTURES[0])
    chip.frames.clear()
    rows = pack(PICTURES[1])
    for page in range(8):
        bus.write_i2c_block_data(0x3C, 0x00, [0xB0 | page, 0x00, 0x10])
        for at in range(0, 128, 32):
            bus.write_i2c_block_data(0x3C, 0x40, rows[page, at : at + 32].tolist())
        if page == 3:
            bus.write_byte_data(0x3C, 0x00, 0xA7)
    assert len(chip.frames) == 3
    assert np.array_equal(shown(chip)[2], 1 - PICTURES[1])
    send_bytes(bus, PICTURES[2])
    assert len(chip.frames) == 4


def test_setting_the_pointer_after_a_rest_begins_a_picture() -> None:
    chip = simulator.SSD1306()
    bus = bench(chip)
    bus.i2c_rdwr(smbus2.i2c_msg.write(0x3C, b"\x00" + init(128, 64, 2)))
    bus.write_i2c_block_data(0x3C, 0x40, [0] * 32)
    for page, pause in enumerate((0.0, 0.001, 0.03, 0.0)):
        bus.idle(pause)
        bus.write_i2c_block_data(0x3C, 0x00, [0xB0 | page, 0x00, 0x10])
        bus.write_i2c_block_data(0x3C, 0x40, [0x55] * 32)
    before = len(chip.frames)
    assert before >= 2
    bus.idle(1.0)
    bus.write_i2c_block_data(0x3C, 0x40, [0x33] * 32)
    assert len(chip.frames) == before, "data that goes on where it stood is the same picture, whatever the rest"


def test_chips_whose_data_carries_its_address_end_a_picture_where_a_place_repeats_or_after_a_rest() -> None:
    progress = Progress((8,))
    numbers: list[Any] = []
    for seconds, row in [(0.0, 0), (0.001, 1), (0.002, 2), (0.003, 0), (0.004, 1), (0.1, 5), (0.101, 6)]:
        progress.draw_at(row)
        numbers.append(progress.end_call(seconds))
    assert numbers == [1, 1, 1, 2, 2, 3, 3]


def test_who_watches_from_another_thread_disturbs_no_frame() -> None:
    chip = simulator.SSD1306()
    bus = bench(chip)
    commands(chip, init(128, 64, 2).hex())
    bus.write_quick(0x3C)
    chip.frames.clear()
    watching, seen = threading.Event(), []

    def watch() -> None:
        while not watching.is_set():
            seen.append(len(chip.frames) + int(chip.pixels.sum()))

    watcher = threading.Thread(target=watch)
    watcher.start()
    try:
        for picture in PICTURES:
            send_pages_from_below(bus, picture)
    finally:
        watching.set()
        watcher.join()
    assert seen
    assert same(shown(chip), PICTURES)
