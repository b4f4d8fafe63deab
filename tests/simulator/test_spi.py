"""The SPI bus as drivers use it: limits and errors, lines, time and bytes on the wire, faults, rows of chips."""

from __future__ import annotations

import array
import errno
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from PIL import Image

from paneldraw import simulator

from .helpers import init, pack, random_picture

ON = bytes.fromhex("8D 14 A5 AF")


class Recorder:
    """A chip that notes what reaches it, with or without a data output of so many bytes' delay."""

    def __init__(self, delay: int | None = None) -> None:
        self.log: list[tuple[bytes, bool] | str] = []
        self.calls: list[tuple[float, int]] = []
        self._inside = None if delay is None else bytes(delay)

    def transfer(self, run: bytes, data: bool) -> bytes | None:
        self.log.append((run, data))
        if self._inside is None:
            return None
        shifted = self._inside + run
        self._inside = shifted[len(run) :]
        return shifted[: len(run)]

    def deselect(self) -> None:
        self.log.append("deselect")

    def reset(self) -> None:
        self.log.append("reset")

    def settle(self, seconds: float, wire_bytes: int) -> None:
        self.calls.append((seconds, wire_bytes))


@pytest.fixture
def device() -> Recorder:
    return Recorder()


@pytest.fixture
def bus(device: Recorder) -> simulator.SPIBus:
    return simulator.SPIBus(device, timer=None)


def lit() -> tuple[simulator.SSD1306, simulator.SPIBus]:
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip, timer=None)
    bus.spi.writebytes2(ON)
    assert chip.pixels.all()
    return chip, bus


# -- The interface of spidev

SENDS: list[tuple[str, Any, Any]] = [
    ("writebytes", [7, 8, 0x1FF], None),
    ("writebytes", (7, 8, 255), None),
    ("writebytes2", [7, 8, 255], None),
    ("writebytes2", b"\x07\x08\xff", None),
    ("writebytes2", array.array("B", [7, 8, 255]), None),
    ("writebytes2", np.array([7, 8, 255], np.uint8), None),
    ("xfer", [7, 8, 255], [0, 0, 0]),
    ("xfer2", (7, 8, 255), (0, 0, 0)),
    ("xfer2", b"\x07\x08\xff", [0, 0, 0]),
    ("xfer3", [7, 8, 255], (0, 0, 0)),
]


@pytest.mark.parametrize(("name", "values", "answer"), SENDS)
def test_whatever_sends(bus: simulator.SPIBus, device: Recorder, name: str, values: Any, answer: Any) -> None:
    assert getattr(bus.spi, name)(values) == answer
    assert device.log == [(b"\x07\x08\xff", False), "deselect"]


def test_xfer2_puts_what_comes_back_into_the_list(bus: simulator.SPIBus) -> None:
    values = [7, 8]
    assert bus.spi.xfer2(values) is values
    assert values == [0, 0]


def test_readbytes_sends_zeros(bus: simulator.SPIBus, device: Recorder) -> None:
    assert bus.spi.readbytes(3) == [0, 0, 0]
    assert device.log == [(bytes(3), False), "deselect"]


@pytest.mark.parametrize("name", ["writebytes2", "xfer3"])
def test_what_takes_any_length_goes_in_several_chip_selects(bus: simulator.SPIBus, device: Recorder, name: str) -> None:
    payload = np.random.default_rng(1).bytes(9000)
    getattr(bus.spi, name)(payload)
    runs = [entry[0] for entry in device.log if entry != "deselect"]
    assert [len(run) for run in runs] == [4096, 4096, 808]
    assert b"".join(runs) == payload  # type: ignore[arg-type]
    assert bus.messages == 3


MISTAKES: list[tuple[str, Any]] = [
    ("writebytes", []),
    ("writebytes2", []),
    ("xfer2", []),
    ("xfer3", ()),
    ("writebytes", [0] * 4097),
    ("xfer", [0] * 4097),
    ("xfer2", bytes(4097)),
    ("writebytes", ["a"]),
    ("xfer2", [1, 2.5]),
    ("writebytes2", [None]),
    ("writebytes", 5),
]


@pytest.mark.parametrize(("name", "values"), MISTAKES)
def test_mistakes_are_refused_as_the_real_spidev_refuses_them(bus: simulator.SPIBus, name: str, values: Any) -> None:
    spidev = pytest.importorskip("spidev")
    with pytest.raises((TypeError, OverflowError)) as real:
        getattr(spidev.SpiDev(), name)(values)
    with pytest.raises((TypeError, OverflowError)) as played:
        getattr(bus.spi, name)(values)
    assert played.type is real.type
    assert bus.bytes == 0


SETTINGS: list[tuple[str, Any]] = [
    ("mode", 4),
    ("mode", "0"),
    ("bits_per_word", 7),
    ("bits_per_word", 33),
    ("max_speed_hz", "fast"),
    ("cshigh", 1),
    ("no_cs", 0),
    ("lsbfirst", 1),
    ("loop", 1),
]


@pytest.mark.parametrize(("name", "value"), SETTINGS)
def test_settings_are_refused_as_the_real_spidev_refuses_them(bus: simulator.SPIBus, name: str, value: Any) -> None:
    spidev = pytest.importorskip("spidev")
    for device in (spidev.SpiDev(), bus.spi):
        with pytest.raises(TypeError):
            setattr(device, name, value)


def test_settings_that_hold(bus: simulator.SPIBus) -> None:
    spi = bus.spi
    spi.mode, spi.max_speed_hz, spi.bits_per_word, spi.lsbfirst, spi.no_cs = 3, 500_000, 8, False, True
    assert (spi.mode, spi.max_speed_hz, spi.bits_per_word, spi.lsbfirst, spi.no_cs) == (3, 500_000, 8, False, True)
    for name, value in (("max_speed_hz", 0), ("bits_per_word", 9), ("lsbfirst", True), ("loop", True)):
        with pytest.raises(OSError, match="Invalid argument"):
            setattr(spi, name, value)


def test_closed_and_opened_again(bus: simulator.SPIBus, device: Recorder) -> None:
    with bus.spi as spi:
        spi.max_speed_hz = 1000
    assert (spi.max_speed_hz, spi.bits_per_word, spi.fileno()) == (0, 0, -1)
    for use in (lambda: spi.writebytes([1]), lambda: spi.xfer2([1]), lambda: setattr(spi, "mode", 0)):
        with pytest.raises(OSError, match="Bad file descriptor") as caught:
            use()
        assert caught.value.errno == errno.EBADF
    assert device.log == []
    for again in (lambda: spi.open(0, 0), lambda: spi.open_path("/dev/spidev0.0")):
        again()
        assert spi.max_speed_hz == 8_000_000
        spi.writebytes([1])


def test_a_kernel_with_a_small_buffer(device: Recorder) -> None:
    bus = simulator.SPIBus(device, bufsiz=64)
    for name in ("writebytes", "xfer2"):
        with pytest.raises(OSError, match="Message too long") as caught:
            getattr(bus.spi, name)([0] * 65)
        assert caught.value.errno == errno.EMSGSIZE
    bus.spi.writebytes2(bytes(65))
    assert bus.messages == 2


# -- Lines


def test_dc_says_what_is_data(bus: simulator.SPIBus, device: Recorder) -> None:
    for level in (1, 0, True):
        bus.pins.set(24, level)
        bus.spi.writebytes([level])
    assert device.log[::2] == [(b"\x01", True), (b"\x00", False), (b"\x01", True)]
    bus.dc = None
    bus.spi.writebytes([9])
    assert device.log[-2] == (b"\x09", False)


def test_the_reset_pin_resets_once_and_is_deaf_while_low() -> None:
    chip, bus = lit()
    ram = chip.ram
    for level in (0, 0):
        bus.pins.set(25, level)
        bus.spi.writebytes2(ON)
        assert not chip.pixels.any()
    bus.pins.set(25, 1)
    assert np.array_equal(chip.ram, ram), "a reset leaves the RAM alone"
    bus.spi.writebytes2(ON)
    assert chip.pixels.all()
    assert [frame.pixels.any() for frame in chip.frames] == [True, False, True]


def test_lines_that_are_wired_to_nothing(bus: simulator.SPIBus, device: Recorder) -> None:
    for line in (18, 4):
        bus.pins.set(line, 1)
        bus.pins.set(line, 0)
    assert device.log == []


def test_a_chip_select_of_the_wrong_polarity_is_heard_by_nobody() -> None:
    chip, bus = lit()
    bus.spi.cshigh = True
    bus.spi.writebytes([0xAE])
    assert chip.pixels.all()
    bus.spi.cshigh = False
    bus.spi.writebytes([0xAE])
    assert not chip.pixels.any()


def test_a_chip_select_that_the_driver_drives_itself(device: Recorder) -> None:
    bus = simulator.SPIBus(device, cs=8)
    bus.spi.no_cs = True
    bus.spi.writebytes([1])
    bus.pins.set(8, 0)
    bus.spi.writebytes([2])
    bus.spi.writebytes([3])
    bus.pins.set(8, 1)
    assert device.log == [(b"\x02", False), (b"\x03", False), "deselect"]


def test_a_chip_select_that_is_tied_to_ground(bus: simulator.SPIBus, device: Recorder) -> None:
    bus.spi.no_cs = True
    bus.spi.writebytes([1])
    assert device.log == [(b"\x01", False)]


# -- The interface of RPi.GPIO


def test_lines_through_rpi_gpio(bus: simulator.SPIBus, device: Recorder) -> None:
    gpio = bus.gpio
    gpio.setwarnings(False)
    gpio.setmode(gpio.BCM)
    gpio.setup([24, 25], gpio.OUT, initial=gpio.HIGH)
    assert (gpio.input(24), gpio.input(25), gpio.getmode()) == (1, 1, gpio.BCM)
    gpio.output(25, gpio.LOW)
    gpio.output((24, 25), (0, 1))
    bus.spi.writebytes([1])
    gpio.output([24, 25], gpio.HIGH)
    bus.spi.writebytes([2])
    assert device.log == ["reset", (b"\x01", False), "deselect", (b"\x02", True), "deselect"]


def test_mistakes_with_rpi_gpio(bus: simulator.SPIBus) -> None:
    gpio = bus.gpio
    with pytest.raises(ValueError, match="different mode"):
        gpio.setmode(gpio.BOARD)
    with pytest.raises(RuntimeError, match="not been set up as an OUTPUT"):
        gpio.output(24, 1)
    gpio.setup(24, gpio.OUT)
    gpio.setup(25, gpio.OUT)
    with pytest.raises(RuntimeError, match="Number of channels"):
        gpio.output([24, 25], [1])
    gpio.setup(24, gpio.IN)
    with pytest.raises(RuntimeError, match="not been set up as an OUTPUT"):
        gpio.output(24, 1)


def test_a_reset_pin_that_nobody_holds_is_pulled_up(bus: simulator.SPIBus, device: Recorder) -> None:
    bus.gpio.setup(25, bus.gpio.OUT, initial=0)
    bus.spi.writebytes([1])
    bus.gpio.cleanup()
    bus.spi.writebytes([2])
    assert device.log == ["reset", "deselect", (b"\x02", False), "deselect"]


# -- Time, bytes, frames


def test_bytes_and_time(device: Recorder) -> None:
    bus = simulator.SPIBus(device, clock=1_000_000, timer=None)
    bus.spi.writebytes2(bytes(100))
    assert (bus.bytes, bus.messages, bus.seconds) == (100, 1, pytest.approx(0.0008))
    bus.spi.max_speed_hz = 4_000_000
    bus.spi.xfer2([0] * 100)
    assert bus.seconds == pytest.approx(0.001)
    bus.spi.xfer2([0] * 100, 100_000, 500)
    assert bus.seconds == pytest.approx(0.0095)
    bus.idle(1)
    bus.spi.writebytes([0])
    assert device.calls[0] == (pytest.approx(0.0008), 100)
    assert device.calls[-1] == (pytest.approx(1.009502), 1)


def test_frames_are_stamped_with_the_hosts_time_where_it_is_later() -> None:
    now = [5.0]
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip, timer=lambda: now[0])
    now[0] = 7.5
    bus.spi.writebytes2(ON)
    assert [(frame.seconds, frame.wire_bytes) for frame in chip.frames] == [(2.5, 4)]


# -- Faults


def test_the_chip_has_received_the_bytes_before_the_fault(bus: simulator.SPIBus, device: Recorder) -> None:
    called = []
    bus.fail(errno.EIO, after=1, at_byte=2, then=lambda: called.append(len(device.log)))
    bus.spi.writebytes([1, 2, 3])
    with pytest.raises(OSError, match="Input/output error"):
        bus.spi.writebytes([4, 5, 6])
    bus.spi.writebytes([7])
    assert [entry[0] for entry in device.log[::2]] == [b"\x01\x02\x03", b"\x04\x05", b"\x07"]
    assert called == [4]
    assert bus.bytes == 6


def test_a_loose_wire_loses_bytes_and_says_nothing(bus: simulator.SPIBus, device: Recorder) -> None:
    bus.fail(0, times=2)
    for value in (1, 2, 3):
        bus.spi.writebytes([value])
    assert device.log == ["deselect", "deselect", (b"\x03", False), "deselect"]
    assert bus.bytes == 3


def test_for_ever_until_cleared(bus: simulator.SPIBus) -> None:
    bus.fail(times=None)
    for _ in range(3):
        with pytest.raises(TimeoutError):
            bus.spi.writebytes([0])
    bus.clear_faults()
    bus.spi.writebytes([0])


def test_an_unplugged_panel_is_no_error() -> None:
    chip, bus = lit()
    bus.chips.clear()
    bus.spi.writebytes([0xAE])
    assert chip.pixels.all()


# -- Rows of chips


def test_each_chip_of_a_row_feeds_the_next() -> None:
    row = [Recorder(2), Recorder(2), Recorder()]
    bus = simulator.SPIBus(row)
    bus.spi.writebytes([1, 2, 3])
    bus.spi.writebytes([4, 5, 6])
    heard = [[entry[0] for entry in chip.log[::2]] for chip in row]
    assert heard == [
        [b"\x01\x02\x03", b"\x04\x05\x06"],
        [b"\x00\x00\x01", b"\x02\x03\x04"],
        [b"\x00\x00\x00", b"\x00\x01\x02"],
    ]


def test_a_chip_without_a_data_output_feeds_nobody() -> None:
    bus = simulator.SPIBus([simulator.SSD1306(), simulator.SSD1306()])
    with pytest.raises(TypeError, match="each but the last must have a data output"):
        bus.spi.writebytes([0xAF])


# -- What cannot be


def test_a_chip_on_the_wrong_kind_of_bus(monkeypatch: pytest.MonkeyPatch) -> None:
    chip = simulator.SSD1306()
    monkeypatch.setattr(simulator.SSD1306, "buses", ("i2c",))
    with pytest.raises(ValueError, match="SSD1306 cannot sit on SPI, but on I2C"):
        simulator.SPIBus(chip)
    monkeypatch.setattr(simulator.SSD1306, "buses", ("spi",))
    with pytest.raises(ValueError, match="SSD1306 cannot sit on I2C, but on SPI"):
        simulator.I2CBus({0x3C: chip})


@pytest.mark.parametrize("options", [{"clock": 0}, {"clock": float("nan")}, {"bufsiz": 0}])
def test_numbers_out_of_range(options: dict[str, Any]) -> None:
    with pytest.raises(ValueError, match=next(iter(options))):
        simulator.SPIBus(**options)


@pytest.mark.parametrize("options", [{"after": -1}, {"at_byte": -1}, {"times": 0}])
def test_faults_that_cannot_be(bus: simulator.SPIBus, options: dict[str, int]) -> None:
    with pytest.raises(ValueError, match="0 or more"):
        bus.fail(**options)


# -- Drivers by others


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
def test_luma_with_a_chip_select_of_its_own() -> None:
    from luma.core.interface.serial import gpio_cs_spi
    from luma.oled.device import sh1106

    chip = simulator.SH1106()
    bus = simulator.SPIBus(chip, cs=8)
    device = sh1106(gpio_cs_spi(spi=bus.spi, gpio=bus.gpio, gpio_CS=8))
    device.persist = True
    picture = random_picture(128, 64, 5)
    device.display(Image.fromarray(picture * 255).convert("1"))
    assert np.array_equal(chip.pixels, picture)


class Pin:
    """A pin as Adafruit's drivers have them: `value` is its level."""

    def __init__(self, bus: simulator.SPIBus, line: int) -> None:
        self._set: Callable[[bool], None] = lambda level: bus.pins.set(line, level)

    def switch_to_output(self, value: bool = False) -> None:
        self._set(value)

    value = property(None, lambda self, level: self._set(bool(level)))


class BusioSPI:
    """What ``busio.SPI`` does on Linux: settings, then bytes."""

    def __init__(self, bus: simulator.SPIBus) -> None:
        self._spi = bus.spi
        self._locked = False

    def try_lock(self) -> bool:
        taken, self._locked = not self._locked, True
        return taken

    def unlock(self) -> None:
        self._locked = False

    def configure(self, *, baudrate: int, polarity: int, phase: int) -> None:
        self._spi.max_speed_hz, self._spi.mode = baudrate, 2 * polarity + phase

    def write(self, buffer: Any, start: int = 0, end: int | None = None) -> None:
        self._spi.writebytes2(bytes(buffer[start:end]))


def test_adafruit() -> None:
    """Its pins are the chip select's too."""
    driver = pytest.importorskip("adafruit_ssd1306")
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip, cs=8)
    bus.spi.no_cs = True
    device = driver.SSD1306_SPI(128, 64, BusioSPI(bus), Pin(bus, 24), Pin(bus, 25), Pin(bus, 8))
    picture = random_picture(128, 64, 6)
    device.fill(0)
    for y, x in np.argwhere(picture):
        device.pixel(int(x), int(y), 1)
    device.show()
    assert np.array_equal(chip.pixels, picture)


def test_a_small_driver_that_sends_byte_by_byte() -> None:
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip)
    picture = random_picture(128, 64, 7)
    for byte in init(128, 64):
        bus.spi.xfer([byte])
    bus.pins.set(24, 1)
    for byte in pack(picture).tobytes():
        bus.spi.xfer([byte])
    assert np.array_equal(chip.pixels, picture)
    assert chip.violations == []
