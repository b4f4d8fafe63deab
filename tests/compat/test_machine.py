"""MicroPython's drivers on simulated buses, and what `machine` has for them."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from paneldraw import simulator
from paneldraw.compat import framebuf, machine, micropython

HERE = Path(__file__).parent
PAGE = HERE.parent.parent / "docs" / "coming_from" / "micropython.md"


@pytest.fixture
def installed(micropython_names):
    """MicroPython's modules by their own names, for as long as a test takes."""
    micropython.install()


def loaded(path, name="driver"):
    spec = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def driver(installed):
    return loaded(HERE / "microcontroller_driver.py")


def pixels_of(fb, width=128, height=64):
    pages = np.frombuffer(fb, np.uint8).reshape(height // 8, 1, width)
    return np.unpackbits(pages, axis=1, bitorder="little").reshape(height, width)


def draw(panel):
    panel.text("paneldraw", 3, 5)
    panel.ellipse(64, 40, 30, 15, 1)
    panel.line(0, 63, 127, 0, 1)
    panel.show()


def test_a_driver_runs_on_i2c(driver):
    chip = simulator.SSD1306(128, 64)
    bus = simulator.I2CBus({0x3C: chip})
    panel = driver.PanelI2C(128, 64, machine.I2C(bus))
    draw(panel)
    assert np.array_equal(chip.pixels, pixels_of(panel))
    assert chip.pixels.sum() > 200
    assert chip.violations == []
    before = bus.bytes
    panel.show()
    assert bus.bytes - before == 1026 + 6 * 3


def test_a_driver_runs_on_spi(driver):
    chip = simulator.SSD1306(128, 64)
    bus = simulator.SPIBus(chip, dc=24, reset=25, cs=8)
    dc, res, cs = (machine.Pin(line, pins=bus.pins) for line in (24, 25, 8))
    panel = driver.PanelSPI(128, 64, machine.SPI(bus.spi), dc, res, cs)
    draw(panel)
    assert np.array_equal(chip.pixels, pixels_of(panel))
    assert chip.violations == []
    assert bus.spi.max_speed_hz == 4_000_000


PUBLISHED = """if True:
    import sys
    sys.path.insert(0, sys.argv[1])
    import numpy as np
    from paneldraw import simulator
    from paneldraw.compat import micropython
    micropython.install()
    from machine import I2C
    from ssd1306 import SSD1306_I2C
    chip = simulator.SSD1306(128, 64)
    oled = SSD1306_I2C(128, 64, I2C(simulator.I2CBus({0x3C: chip})))
    oled.fill(0)
    oled.text("MicroPython", 10, 10)
    oled.rect(0, 0, 128, 64, 1)
    oled.show()
    pages = np.frombuffer(oled.buffer, np.uint8).reshape(8, 1, 128)
    shown = np.unpackbits(pages, axis=1, bitorder="little").reshape(64, 128)
    print(np.array_equal(chip.pixels, shown), chip.pixels.sum() > 400, chip.violations)
"""


@pytest.mark.thorough
def test_a_published_driver_runs_as_it_is(tmp_path):
    """It comes with pip, as source in the form of MicroPython's packages."""
    command = [sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", str(tmp_path)]
    done = subprocess.run([*command, "micropython-ssd1306-driver==1.0.2"], capture_output=True, text=True)
    if done.returncode:
        pytest.skip(f"pip does not bring the driver: {done.stderr.strip()[-200:]}")
    command = [sys.executable, "-c", PUBLISHED, str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=HERE.parent.parent)
    assert done.stdout.split() == ["True", "True", "[]"], done.stderr


class Registers:
    """A device on the bus that is a row of registers."""

    def __init__(self):
        self.memory, self.at, self.heard = bytearray(range(32)), 0, []

    def write(self, payload):
        self.heard.append(payload)
        if payload:
            self.at = payload[0]
            self.memory[self.at : self.at + len(payload) - 1] = payload[1:]

    def read(self, length):
        found = bytes(self.memory[self.at : self.at + length])
        self.at += length
        return found

    def settle(self, seconds, wire_bytes):
        pass


@pytest.fixture
def device():
    return Registers()


@pytest.fixture
def bus(device):
    return simulator.I2CBus({0x48: device})


def test_registers_are_read_and_written(bus, device):
    i2c = machine.I2C(bus, freq=100_000)
    assert i2c.readfrom_mem(0x48, 5, 3) == b"\5\6\7"
    i2c.writeto_mem(0x48, 9, b"\xaa\xbb")
    buffer = bytearray(4)
    i2c.readfrom_mem_into(0x48, 8, buffer)
    assert buffer == b"\x08\xaa\xbb\x0b"
    i2c.readfrom_into(0x48, memoryview(buffer)[:2])
    assert buffer == b"\x0c\x0d\xbb\x0b"
    i2c.writeto_mem(0x48, 0x0102, b"", addrsize=16)
    assert device.heard[-1] == b"\1\2"
    assert i2c.writeto(0x48, bytearray(3)) == 3
    assert i2c.writevto(0x48, (b"\1", b"", memoryview(b"\2\3"))) == 3
    assert device.heard[-1] == b"\1\2\3"


def test_what_has_no_stop_goes_out_with_the_next_call(bus, device):
    i2c = machine.I2C(bus)
    before = bus.transactions
    assert i2c.writeto(0x48, b"\7", False) == 1
    assert device.heard == []
    assert i2c.readfrom(0x48, 2) == b"\7\x08"
    assert bus.transactions == before + 1


def test_a_bus_is_searched(bus):
    assert machine.I2C(bus).scan() == [0x48]
    assert machine.SoftI2C(machine.Pin(22), machine.Pin(21), bus=bus).scan() == [0x48]


def test_nobody_there_is_an_oserror_and_the_next_call_is_whole(bus):
    i2c = machine.I2C(bus)
    i2c.writeto(0x10, b"\1", False)
    with pytest.raises(OSError, match="Remote I/O"):
        i2c.writeto(0x10, b"\2")
    assert i2c.readfrom_mem(0x48, 5, 1) == b"\5"


def test_a_bus_that_is_not_there_is_told():
    with pytest.raises(OSError, match="i2c-77"):
        machine.I2C(77)


def test_spi_reads_while_it_writes():
    class Echo:
        def __init__(self):
            self.sent = []

        def xfer3(self, values):
            self.sent += values
            return [value ^ 0xFF for value in values]

        def writebytes2(self, values):
            self.sent += values

    echo = Echo()
    spi = machine.SPI(echo, 1000, polarity=1, phase=1)
    assert (echo.max_speed_hz, echo.mode) == (1000, 3)
    assert spi.read(2, 0x0F) == b"\xf0\xf0"
    buffer = bytearray(2)
    spi.readinto(buffer)
    assert buffer == b"\xff\xff"
    spi.write_readinto(b"\1\2", buffer)
    assert buffer == b"\xfe\xfd"
    spi.write(memoryview(b"\3"))
    assert bytes(echo.sent) == b"\x0f\x0f\0\0\1\2\3"


class Lines:
    def __init__(self):
        self.set_to = []

    def set(self, line, value):
        self.set_to.append((line, value))


def test_an_output_pin():
    lines = Lines()
    pin = machine.Pin(24, machine.Pin.OUT, value=1, pins=lines)
    pin.off()
    pin(1)
    pin.toggle()
    pin.high()
    assert lines.set_to == [(24, True), (24, False), (24, True), (24, False), (24, True)]
    assert (pin(), pin.value()) == (1, 1)


def test_a_line_of_this_machine_is_taken_once(monkeypatch):
    claimed = []

    class GPIO(Lines):
        def __init__(self, gpiochip):
            super().__init__()

        def claim(self, line, *, high):
            claimed.append((line, high))

    monkeypatch.setattr(machine, "GPIO", GPIO)
    monkeypatch.setattr(machine.Pin, "_lines", {})
    machine.Pin(17, machine.Pin.OUT, value=1)
    again = machine.Pin(17)
    again.init(again.OUT, value=0)
    assert claimed == [(17, True)]
    assert machine.Pin._lines[17].set_to == [(17, True), (17, False)]


def test_a_pin_that_is_only_named_is_not_taken():
    pin = machine.Pin(22)
    pin.value(1)
    assert pin.value() == 1
    nowhere = machine.Pin(None, machine.Pin.OUT)
    nowhere(1)
    assert nowhere() == 1


def test_an_input_is_refused():
    with pytest.raises(NotImplementedError, match="gpiozero"):
        machine.Pin(24, machine.Pin.IN, machine.Pin.PULL_UP)


def test_the_modules_have_their_own_names(installed):
    names = {}
    exec("import framebuf, machine, utime\nfrom micropython import const, native, viper", names)
    assert names["framebuf"] is framebuf
    assert names["machine"] is machine
    assert names["const"](7) == 7
    assert names["viper"](len) is len
    utime = names["utime"]
    start = utime.ticks_us()
    utime.sleep_ms(2)
    utime.sleep_us(1000)
    assert utime.ticks_diff(utime.ticks_us(), start) >= 3000
    assert utime.ticks_diff(3, utime.ticks_add(3, -10)) == 10
    assert utime.ticks_diff(5, (1 << 30) - 5) == 10
    assert abs(utime.ticks_diff(utime.ticks_ms(), utime.ticks_us() // 1000)) < 1 << 30


@pytest.fixture
def page_runs(installed, monkeypatch):
    """Runs a block of the page; returns the chip that it shows on."""
    own = loaded(HERE / "microcontroller_driver.py")
    own.SSD1306_I2C = own.PanelI2C
    monkeypatch.setitem(sys.modules, "ssd1306", own)
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)

    def run(block, names):
        chip = simulator.SSD1306(128, 64)
        bus = simulator.I2CBus({0x3C: chip})
        monkeypatch.setattr("smbus2.SMBus", lambda *path: bus)
        exec(block, names)
        return chip

    return run


def test_the_blocks_of_the_page_run(page_runs):
    first, before, after, *more = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text("utf-8"), re.M | re.S)
    assert np.array_equal(page_runs(before, {}).pixels, page_runs(after, {}).pixels)
    names = {}
    chip = page_runs(first, names)
    assert np.array_equal(chip.pixels, pixels_of(names["oled"]))
    assert chip.pixels.any()
    for block in more:
        page_runs(block, names)
    assert len(more) == 2
    assert np.array_equal(names["panel"].simulated.pixels, pixels_of(names["fb"]))
    assert names["cost"] <= 8
