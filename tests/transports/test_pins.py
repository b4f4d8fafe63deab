"""D/C and reset lines through gpiod: its chips and requests are played here, all else of it is real."""

from __future__ import annotations

import errno
import os

import pytest

from paneldraw import simulator
from paneldraw.errors import (
    PanelBusyError,
    PanelError,
    PanelNotFoundError,
    PanelPermissionError,
    TransportError,
)
from paneldraw.transports import I2CTransport, SPITransport, pins

gpiod = pytest.importorskip("gpiod")

PI_5 = {"/dev/gpiochip10": ("gpio-brcmstb@107d508500", {}), "/dev/gpiochip0": ("pinctrl-rp1", {"GPIO24": 24})}
PI_4 = {"/dev/gpiochip0": ("pinctrl-bcm2711", {}), "/dev/gpiochip1": ("raspberrypi-exp-gpio", {"BT_ON": 0})}
OTHER = {"/dev/gpiochip0": ("300b000.pinctrl", {}), "/dev/gpiochip1": ("7022000.pinctrl", {"PL5": 5})}


class Machine:
    """GPIO chips by path, each a label and named lines, and what their lines are held by and set to."""

    def __init__(self, chips):
        self.chips = chips
        self.held = {}
        self.levels = []
        self.refused = {}

    def chip(self, path):
        if path in self.refused:
            raise OSError(self.refused[path], os.strerror(self.refused[path]))
        if path not in self.chips:
            raise FileNotFoundError(errno.ENOENT, "No such file or directory")
        return Chip(self, path)


class Chip:
    def __init__(self, machine, path):
        self.machine, self.path = machine, path
        self.label, self.names = machine.chips[path]

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        pass

    def get_info(self):
        return Info(label=self.label, num_lines=54)

    def get_line_info(self, offset):
        return Info(consumer=self.machine.held[self.path, offset])

    def line_offset_from_id(self, name):
        if name not in self.names:
            raise FileNotFoundError(errno.ENOENT, "No such file or directory")
        return self.names[name]

    def request_lines(self, config, consumer):
        ((offset, settings),) = config.items()
        assert settings.direction == gpiod.line.Direction.OUTPUT
        if (self.path, offset) in self.machine.held:
            raise OSError(errno.EBUSY, "Device or resource busy")
        self.machine.held[self.path, offset] = consumer
        return Request(self.machine, self.path, offset, settings.output_value)


class Info:
    def __init__(self, **values):
        self.__dict__.update(values)


class Request:
    def __init__(self, machine, path, offset, value):
        self.machine, self.at = machine, (path, offset)
        self.set_value(offset, value)

    def set_value(self, offset, value):
        assert offset == self.at[1]
        self.machine.levels.append((*self.at, value == gpiod.line.Value.ACTIVE))

    def release(self):
        del self.machine.held[self.at]


@pytest.fixture
def machine(monkeypatch):
    machine = Machine(dict(PI_4))
    monkeypatch.setattr(gpiod, "Chip", machine.chip)
    monkeypatch.setattr(pins.glob, "glob", lambda pattern: list(machine.chips))
    return machine


@pytest.fixture
def bus():
    return simulator.SPIBus(simulator.SSD1306())


@pytest.mark.parametrize(("chips", "path"), [(PI_5, "/dev/gpiochip0"), (PI_4, "/dev/gpiochip0")])
def test_the_lines_of_the_header(chips, path, machine, bus):
    machine.chips = chips
    transport = SPITransport(spi=bus.spi)
    assert machine.held == {(path, 24): "paneldraw", (path, 25): "paneldraw"}
    assert machine.levels == [(path, 24, False), (path, 25, True), (path, 25, False), (path, 25, True)]
    transport.data(b"\x00")
    transport.command(b"\xe3")
    assert machine.levels[4:] == [(path, 24, True), (path, 24, False)]
    transport.close()
    transport.close()
    assert machine.held == {}
    with pytest.raises(TransportError, match="closed: open a new transport"):
        transport.data(b"\x00")


def test_lines_by_name_and_by_chip(machine, bus):
    machine.chips = OTHER
    SPITransport(spi=bus.spi, dc="PL5", reset=None)
    assert list(machine.held) == [("/dev/gpiochip1", 5)]
    SPITransport(spi=bus.spi, dc=6, reset=7, gpiochip=1)
    SPITransport(spi=bus.spi, dc=6, reset=None, gpiochip="/dev/gpiochip0")
    assert list(machine.held)[1:] == [("/dev/gpiochip1", 6), ("/dev/gpiochip1", 7), ("/dev/gpiochip0", 6)]


@pytest.mark.parametrize(
    ("wiring", "complaint"),
    [
        ({"dc": 24}, r"no line 24 on a Raspberry Pi's header; there is .*/dev/gpiochip1 \(7022000.*give .*gpiochip="),
        ({"dc": "PL6"}, "no line PL6"),
        ({"dc": 54, "gpiochip": 1}, "no line 54 on /dev/gpiochip1"),
        ({"dc": 1, "gpiochip": 7}, "/dev/gpiochip7 is no GPIO chip; there is /dev/gpiochip0, /dev/gpiochip1"),
    ],
)
def test_a_line_that_is_not_there(wiring, complaint, machine, bus):
    machine.chips = OTHER
    with pytest.raises(PanelNotFoundError, match=complaint):
        SPITransport(spi=bus.spi, reset=None, **wiring)


def test_no_chip_at_all(machine, bus):
    machine.chips = {}
    with pytest.raises(PanelNotFoundError, match="there is no /dev/gpiochip"):
        SPITransport(spi=bus.spi)


def test_the_real_gpiod_on_a_chip_that_is_not_there(bus):
    with pytest.raises(PanelNotFoundError, match="/dev/gpiochip99 is no GPIO chip") as caught:
        SPITransport(spi=bus.spi, gpiochip=99)
    assert caught.value.errno == errno.ENOENT
    with pytest.raises(PanelNotFoundError, match="/dev/null is no GPIO chip"):
        SPITransport(spi=bus.spi, gpiochip="/dev/null")


@pytest.mark.parametrize(
    ("code", "kind", "advice"),
    [
        (errno.EACCES, PanelPermissionError, "group gpio"),
        (errno.EPERM, PanelPermissionError, "group gpio"),
        (errno.EMFILE, TransportError, "Too many open files"),
    ],
)
def test_a_chip_that_does_not_open(code, kind, advice, machine, bus):
    machine.refused["/dev/gpiochip0"] = code
    with pytest.raises(kind, match=f"/dev/gpiochip0: .*{advice}") as caught:
        SPITransport(spi=bus.spi)
    assert caught.value.errno == code


@pytest.mark.parametrize(("consumer", "holder"), [("spi0 CS0", "spi0 CS0"), ("", "the kernel")])
def test_a_busy_line_says_who_holds_it(consumer, holder, machine, bus):
    machine.held["/dev/gpiochip0", 8] = consumer
    with pytest.raises(PanelBusyError, match=f"line 8 of /dev/gpiochip0 is in use by {holder}: .*overlay") as caught:
        SPITransport(spi=bus.spi, reset=8)
    assert caught.value.errno == errno.EBUSY
    assert machine.held == {("/dev/gpiochip0", 8): consumer}, "the line that was had is given back"


def test_gpiod_of_the_first_generation(bus, monkeypatch):
    monkeypatch.delattr(gpiod, "LineSettings")
    with pytest.raises(PanelError, match=r"older than 2.0: pip install --upgrade"):
        SPITransport(spi=bus.spi)


# -- On I2C


def test_the_reset_line_of_an_i2c_module(machine):
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()})
    transport = I2CTransport(bus, reset=4)
    assert machine.levels == [("/dev/gpiochip0", 4, high) for high in (True, False, True)]
    assert transport.reset() is True
    assert len(machine.levels) == 3, "nothing was sent since"
    transport.command(b"\xaf")
    transport.reset()
    assert machine.levels[3:] == [("/dev/gpiochip0", 4, False), ("/dev/gpiochip0", 4, True)]
    transport.close()
    assert machine.held == {}


def test_an_i2c_module_resets_through_pins_that_are_given():
    chip = simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip})
    wires = simulator.SPIBus(chip, reset=4)  # the same chip's reset pin
    first = I2CTransport(bus)
    assert first.reset() is False
    first.command(b"\x81\x10")
    I2CTransport(bus, reset=4, pins=wires.pins)
    assert chip.contrast == 0x7F


def test_a_bus_is_closed_again_where_the_line_cannot_be_had(machine, monkeypatch):
    import smbus2

    closed = []
    bus = simulator.I2CBus()
    bus.close = lambda: closed.append(True)
    monkeypatch.setattr(smbus2, "SMBus", lambda path: bus)
    machine.held["/dev/gpiochip0", 4] = "lirc"
    with pytest.raises(PanelBusyError, match="in use by lirc"):
        I2CTransport(1, reset=4)
    assert closed == [True]
