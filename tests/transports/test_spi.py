"""The SPI transport over a simulated bus, and on the real spidev and gpiod as far as a machine without them goes."""

from __future__ import annotations

import errno
import glob
import os
import sys
import tempfile

import numpy as np
import pytest

from paneldraw import Panel, open_panel, simulator, urls
from paneldraw.controllers import SH1106, SSD1306, SSD1309, SSD1322, SSD1327
from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelError,
    PanelNotFoundError,
    PanelPermissionError,
    PanelTimeoutError,
    TransportError,
)
from paneldraw.transports import COMMAND, DATA, Plan, SPITransport, spi


class Recorder:
    """A chip that notes what reaches it."""

    def __init__(self):
        self.log = []

    def transfer(self, run, data):
        self.log.append((DATA if data else COMMAND, run))

    def deselect(self):
        self.log.append("deselect")

    def reset(self):
        self.log.append("reset")

    def settle(self, seconds, wire_bytes):
        pass


def plan_of(*messages):
    plan = Plan(sum(len(payload) + 1 for _, payload in messages), len(messages))
    end = 0
    for kind, payload in messages:
        plan.starts[plan.count], plan.stops[plan.count] = end, end + 1 + len(payload)
        plan.buffer[end] = kind
        plan.buffer[end + 1 : end + 1 + len(payload)] = np.frombuffer(payload, np.uint8)
        plan.count += 1
        plan.cost += len(payload)
        end += 1 + len(payload)
    return plan


def wired(chip, **options):
    bus = simulator.SPIBus(chip)
    return SPITransport(spi=bus.spi, pins=bus.pins, **options), bus


def noise(seed=7):
    return np.random.default_rng(seed).integers(0, 2, (64, 128), np.uint8)


# -- Messages


def test_each_message_is_a_chip_select_with_its_own_level_of_dc():
    chip = Recorder()
    transport, bus = wired(chip)
    assert chip.log == ["reset"]
    chip.log.clear()
    assert transport.command(b"\xa5\xaf") == 2
    assert transport.data(b"\x01") == 1
    assert transport.batch(plan_of((COMMAND, b"\xb3\x05\x10"), (DATA, b"\xff"), (DATA, b"\xfe"))) == 5
    sent = [(COMMAND, b"\xa5\xaf"), (DATA, b"\x01"), (COMMAND, b"\xb3\x05\x10"), (DATA, b"\xff"), (DATA, b"\xfe")]
    assert chip.log[::2] == sent
    assert chip.log[1::2] == ["deselect"] * 5
    assert (bus.bytes, bus.messages) == (8, 5)


def test_lines_are_set_only_where_they_change():
    levels = []

    class Pins:
        def set(self, line, value):
            levels.append((line, value))

    bus = simulator.SPIBus(Recorder())
    transport = SPITransport(spi=bus.spi, pins=Pins(), dc="D/C", reset=7)
    assert levels == [(7, False), (7, True)]
    for send in (transport.command, transport.command, transport.data, transport.data, transport.command):
        send(b"\x00")
    assert levels[2:] == [("D/C", False), ("D/C", True), ("D/C", False)]


@pytest.mark.parametrize("make", [SSD1306, SSD1309, SH1106, SSD1327, SSD1322], ids=lambda chip: chip.name)
def test_a_picture_arrives_and_its_bytes_are_counted(make):
    controller = make()
    chip = getattr(simulator, controller.name.upper())()
    transport, bus = wired(chip)
    size = controller.height, controller.width
    picture = np.random.default_rng(4).integers(0, chip.max_level + 1, size, np.uint8)
    with Panel(controller, transport) as panel:
        for x in (100, 101, 3):
            before = bus.bytes
            report = panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
            assert report.wire_bytes == bus.bytes - before
            picture[33, x] ^= 1
    assert chip.violations == []


@pytest.mark.parametrize(("make", "most"), [(SSD1306, 4), (SH1106, 4), (SSD1327, 7), (SSD1322, 9)])
def test_one_pixel_is_its_bytes_and_its_address(make, most):
    panel = Panel(make(), wired(getattr(simulator, make.name)())[0])
    picture = np.zeros((panel.height, panel.width), np.uint8)
    panel.show(picture)
    picture[33, 100] = 1
    assert panel.show(picture).wire_bytes == most
    assert panel.show(picture).messages == 0


class Daisy(Recorder):
    """A chip with a shift register of two bytes, as a MAX7219 has."""

    def __init__(self):
        super().__init__()
        self.register, self.latched = b"\x00\x00", []

    def transfer(self, run, data):
        shifted = self.register + run
        self.register = shifted[-2:]
        return shifted[:-2]

    def deselect(self):
        self.latched.append(self.register)


def test_a_message_for_chips_without_dc_is_one_chip_select():
    row = [Daisy(), Daisy()]
    bus = simulator.SPIBus(row, dc=None, reset=None)
    transport = SPITransport(spi=bus.spi, dc=None, reset=None)
    transport.command(b"\x01\x81\x01\x42")
    transport.batch(plan_of((COMMAND, b"\x02\x18\x00\x00"), (DATA, b"\x0c\x01\x0c\x01")))
    assert row[1].latched == [b"\x01\x81", b"\x02\x18", b"\x0c\x01"]
    assert row[0].latched == [b"\x01\x42", b"\x00\x00", b"\x0c\x01"]
    assert bus.messages == 3


def test_a_message_that_must_stay_whole_has_a_longest(tmp_path, monkeypatch):
    monkeypatch.setattr(spi, "BUFSIZ", tmp_path / "bufsiz")
    assert SPITransport(spi=simulator.SPIBus().spi, dc=None, reset=None).cost.longest == 4096
    (tmp_path / "bufsiz").write_text("8\n")
    transport = SPITransport(spi=simulator.SPIBus().spi, dc=None, reset=None)
    assert transport.cost == (0, 0, None, 8)
    with pytest.raises(ValueError, match="at most 8 bytes, not 9"):
        transport.data(bytes(9))
    assert wired(Recorder())[0].cost == (0, 0, None, None)


@pytest.mark.parametrize("names", [("writebytes", "xfer2"), ("xfer2",)])
def test_an_object_that_only_takes_short_lists(names):
    chip = Recorder()
    bus = simulator.SPIBus(chip)

    class Old:
        pass

    old = Old()
    for name in names:
        setattr(old, name, getattr(bus.spi, name))
    transport = SPITransport(spi=old, pins=bus.pins, reset=None)
    payload = np.random.default_rng(3).bytes(9000)
    assert transport.data(payload) == 9000
    sent = [run for kind, run in chip.log[::2]]
    assert [len(run) for run in sent] == [4096, 4096, 808]
    assert b"".join(sent) == payload


# -- Reset


def test_a_reset_pin_is_pulsed_at_the_start_and_when_the_chip_begins_anew():
    chip = simulator.SSD1306()
    resets = []
    chip.reset = lambda: (resets.append(bus.bytes), type(chip).reset(chip))
    bus = simulator.SPIBus(chip)
    panel = Panel(SSD1306(), SPITransport(spi=bus.spi, pins=bus.pins))
    assert resets == [0], "once, though transport and panel both begin"
    panel.show(noise())
    begun = bus.bytes
    panel.invalidate()
    panel.show(noise())
    assert resets == [0, begun]
    np.testing.assert_array_equal(chip.pixels, noise())


def test_no_reset_line_is_said():
    transport, _ = wired(Recorder(), reset=None)
    assert transport.reset() is False
    assert wired(Recorder())[0].reset() is True


# -- Faults


@pytest.mark.parametrize(
    ("code", "kind", "transient", "advice"),
    [
        (errno.EAGAIN, PanelBusyError, True, "another program"),
        (errno.EBUSY, PanelBusyError, True, "another program"),
        (errno.ETIMEDOUT, PanelTimeoutError, True, "lower speed"),
        (errno.EIO, TransportError, True, "wiring"),
        (errno.EINVAL, TransportError, False, "not 8000000 Hz perhaps.*speed=1000000"),
        (errno.EMSGSIZE, TransportError, False, "spidev.bufsiz=65536"),
        (errno.ESHUTDOWN, PanelDisconnectedError, False, "adapter"),
        (errno.ENODEV, PanelDisconnectedError, False, "adapter"),
    ],
)
def test_what_linux_says_and_what_to_do(code, kind, transient, advice):
    transport, bus = wired(Recorder())
    for send in (transport.command, transport.data, lambda payload: transport.batch(plan_of((DATA, payload)))):
        bus.fail(code)
        with pytest.raises(kind, match=advice) as caught:
            send(b"\xaf")
        assert caught.value.errno == code
        assert caught.value.transient == transient


def test_a_short_write_which_spidev_reports_oddly():
    class Short:
        def writebytes2(self, payload):
            raise SystemError("<method 'writebytes2'> returned NULL without setting an exception")

    with pytest.raises(TransportError, match="cannot write to Short") as caught:
        SPITransport(spi=Short(), dc=None, reset=None).data(b"\x00")
    assert (caught.value.errno, caught.value.transient) == (errno.EIO, True)


@pytest.mark.parametrize("at_byte", [None, 0, 1, 2, 5, 40])
@pytest.mark.parametrize("after", range(4))
def test_faults_heal(after, at_byte):
    chip = simulator.SSD1306()
    transport, bus = wired(chip)
    panel = Panel(SSD1306(), transport)
    panel.show(noise(1))
    bus.fail(after=after, at_byte=at_byte, then=chip.power_cycle)
    for seed in range(2, 6):
        panel.show(noise(seed))
    np.testing.assert_array_equal(chip.pixels, noise(5))
    assert panel.stats.retries == 1


def test_a_fault_that_stays_is_told_and_the_next_show_is_whole():
    chip = simulator.SSD1306()
    transport, bus = wired(chip)
    panel = Panel(SSD1306(), transport)
    bus.fail(errno.ENODEV)
    with pytest.raises(PanelDisconnectedError):
        panel.show(noise(1))
    chip.power_cycle()
    panel.show(noise(2))
    np.testing.assert_array_equal(chip.pixels, noise(2))


def test_a_line_that_fails_is_told():
    class Pins:
        def set(self, line, value):
            if line == 24 and value:
                raise OSError(errno.ENODEV, "No such device")

    transport = SPITransport(spi=simulator.SPIBus(Recorder()).spi, pins=Pins())
    transport.command(b"\x00")
    with pytest.raises(TransportError, match="cannot set line 24: No such device"):
        transport.batch(plan_of((DATA, b"\x00")))


def test_a_closed_transport_says_so():
    transport, bus = wired(Recorder())
    transport.close()
    transport.close()
    with pytest.raises(TransportError, match="closed: open a new one"):
        transport.command(b"\xaf")
    bus.spi.writebytes([0])  # the caller's own


# -- Arguments


def test_arguments_that_cannot_be():
    bus = simulator.SPIBus()
    for name in ("bus", "device", "speed"):
        with pytest.raises(ValueError, match=f"{name} must be"):
            SPITransport(spi=bus.spi, pins=bus.pins, **{name: -1})
        with pytest.raises(TypeError, match=f"{name} must be an int"):
            SPITransport(spi=bus.spi, pins=bus.pins, **{name: True})
    for name in ("dc", "reset"):
        with pytest.raises(ValueError, match=f"{name} must be 0 or more"):
            SPITransport(spi=bus.spi, pins=bus.pins, **{name: -1})
        with pytest.raises(TypeError, match=f"{name} must be the number or name"):
            SPITransport(spi=bus.spi, pins=bus.pins, **{name: 1.5})
    with pytest.raises(ValueError, match="two lines, not both 24"):
        SPITransport(spi=bus.spi, pins=bus.pins, reset=24)
    with pytest.raises(TypeError, match="pins must have a method set"):
        SPITransport(spi=bus.spi, pins=bus.gpio)
    with pytest.raises(TypeError, match="spi must have spidev's writebytes2"):
        SPITransport(spi=bus, pins=bus.pins)


# -- The real spidev


@pytest.fixture
def spidev():
    return pytest.importorskip("spidev")


def test_no_such_device(spidev, monkeypatch):
    monkeypatch.setattr(glob, "glob", lambda pattern: ["/dev/spidev1.0", "/dev/spidev0.1"])
    with pytest.raises(
        PanelNotFoundError, match=r"no /dev/spidev9.8: enable SPI .*do_spi 0.*; there is /dev/spi"
    ) as caught:
        SPITransport(9, 8)
    assert caught.value.errno == errno.ENOENT
    assert str(caught.value).endswith("there is /dev/spidev0.1, /dev/spidev1.0")


@pytest.mark.parametrize(
    ("code", "kind", "advice"),
    [
        (errno.EACCES, PanelPermissionError, "group spi"),
        (errno.EPERM, PanelPermissionError, "group spi"),
        (errno.EBUSY, PanelBusyError, "end the other program"),
        (errno.ENXIO, PanelNotFoundError, "enable SPI"),
        (errno.EMFILE, TransportError, "Too many open files"),
    ],
)
def test_a_device_that_does_not_open(code, kind, advice, spidev, monkeypatch):
    class SpiDev:
        closed = False

        def open(self, bus, device):
            raise OSError(code, os.strerror(code))

        def close(self):
            SpiDev.closed = True

    monkeypatch.setattr(spidev, "SpiDev", SpiDev)
    with pytest.raises(kind, match=advice) as caught:
        SPITransport(3, 1)
    assert "/dev/spidev3.1" in str(caught.value)
    assert caught.value.errno == code
    assert SpiDev.closed


def test_a_speed_that_the_adapter_does_not_take(spidev, monkeypatch):
    class SpiDev:
        mode = 0

        def open(self, bus, device):
            self.at = bus, device

        def close(self):
            pass

        @property
        def max_speed_hz(self):
            return 0

        @max_speed_hz.setter
        def max_speed_hz(self, speed):
            raise OSError(errno.EINVAL, "Invalid argument")

    monkeypatch.setattr(spidev, "SpiDev", SpiDev)
    with pytest.raises(TransportError, match="not 80000000 Hz perhaps"):
        SPITransport(speed=80_000_000)


def test_the_real_spidev_takes_a_plan_as_it_stands(spidev):
    """A file refuses the settings of a bus, and stays open all the same: what is written can be read back."""
    with tempfile.NamedTemporaryFile() as file:
        device = spidev.SpiDev()
        with pytest.raises(OSError, match="ioctl"):
            device.open_path(file.name)
        transport = SPITransport(spi=device, dc=None, reset=None)
        payload = np.random.default_rng(1).bytes(3000)
        transport.batch(plan_of((COMMAND, b"\xb0\x00\x10"), (DATA, payload)))
        transport.data(b"\x05\x06")
        assert file.read() == b"\xb0\x00\x10" + payload + b"\x05\x06"
        device.close()
        with pytest.raises(TransportError, match="Bad file descriptor"):
            transport.data(b"\x05")


@pytest.mark.parametrize("missing", ["spidev", "gpiod"])
def test_a_package_that_is_missing(missing, monkeypatch):
    monkeypatch.delitem(sys.modules, missing, raising=False)

    class Missing:
        def find_spec(self, name, path=None, target=None):
            if name == missing:
                raise ModuleNotFoundError(f"No module named {name!r}", name=name)

    monkeypatch.setattr(sys, "meta_path", [Missing(), *sys.meta_path])
    given = {} if missing == "spidev" else {"spi": simulator.SPIBus().spi}
    with pytest.raises(PanelError, match=rf'{missing} is missing.*pip install "paneldraw\[spi\]"'):
        SPITransport(**given)


# -- URLs


def test_a_url_says_everything(monkeypatch):
    made = {}
    chip = simulator.SSD1306(128, 32)
    bus = simulator.SPIBus(chip)

    def transport(*place, **wiring):
        made.update(wiring, place=place)
        return SPITransport(spi=bus.spi, pins=bus.pins)

    monkeypatch.setattr("paneldraw.transports.SPITransport", transport)
    url = "spi://1.2?chip=ssd1306&size=128x32&dc=GPIO5&reset=none&gpiochip=4&speed=0x10&rotate=180&on_close=clear"
    with open_panel(url) as panel:
        assert panel.simulated is None
        assert (panel.rotate, panel.height, panel.on_close) == (180, 32, "clear")
    assert made == {"place": (1,), "device": 2, "dc": "GPIO5", "reset": None, "gpiochip": 4, "speed": 16}


@pytest.mark.parametrize(
    ("url", "complaint"),
    [
        ("spi://", "spi://0.0"),
        ("spi://0", "spi://0.0"),
        ("spi://0.a", "spi://0.0"),
        ("spi://0.0/0x3c", "spi://0.0"),
        ("spi://0.0?speed=fast", "speed must be a whole number, such as 8000000"),
        ("spi://0.0?baudrate=1", "no parameters but chip, .*dc, reset, gpiochip, speed"),
    ],
)
def test_what_a_url_cannot_say(url, complaint):
    with pytest.raises(ValueError, match=complaint):
        open_panel(url)


def test_a_url_of_i2c_says_the_reset_line():
    wanted = urls.parse("i2c://1/0x3c?chip=ssd1309&reset=4&gpiochip=/dev/gpiochip1")
    assert wanted.transport == {"reset": 4, "gpiochip": "/dev/gpiochip1"}
    with pytest.raises(ValueError, match=r"it is on SPI, such as spi://0.0\?chip=ssd1322"):
        urls.parse("i2c://1/0x3c?chip=ssd1322")


def test_a_simulated_chip_that_is_on_spi_alone_is_there():
    with open_panel("sim://ssd1322?rotate=180") as panel:
        panel.show(np.full((64, 256), 7, np.uint8))
        assert panel.transport.wire == "spi"
        assert (panel.simulated.pixels == 7).all()


def test_a_simulated_chip_that_is_on_i2c_too_stays_there():
    with open_panel("sim://sh1106") as panel:
        assert panel.transport.wire == "i2c"
        assert panel.simulated is panel.transport.bus.devices[0x3C]
