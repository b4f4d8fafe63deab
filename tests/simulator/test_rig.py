"""A rig of simulated panels: from URLs and from a file, on shared buses, behind multiplexers and serial ports."""

from __future__ import annotations

import contextlib
import errno
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

from firmware_protocol.messages import Hello, encode
from paneldraw import Framebuffer, Panel, open_panel, urls
from paneldraw.controllers import CHIPS
from paneldraw.errors import PanelDisconnectedError, PanelError, TransportError
from paneldraw.simulator import I2CBus, Rig, SPIBus, mishaps
from paneldraw.simulator.mishaps import read_mishap
from paneldraw.transports import I2CTransport, SPITransport

needs_pty = pytest.mark.skipif(not hasattr(os, "openpty"), reason="pseudo-terminals are a thing of Unix")


@pytest.fixture(autouse=True)
def nothing_is_left(tmp_path, monkeypatch):
    """No thread, file descriptor or temporary file outlives a test."""
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    before = set(threading.enumerate()), descriptors()
    yield
    assert (set(threading.enumerate()), descriptors()) == before
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith("paneldraw-")] == []


def descriptors():
    folder = "/proc/self/fd"
    return len(os.listdir(folder)) if os.path.isdir(folder) else 0


def drawn(panel, text="Rig"):
    """Draw with a panel; return the levels that its glass must show."""
    with panel.frame() as fb:
        fb.rect(0, 0, fb.width, fb.height)
        fb.text(text, 2, 1)
    return fb.pixels


def shows(chip, picture):
    return np.array_equal(chip.pixels > 0, picture > 0)


def transport_to(panel):
    """Our own transport to a panel of a rig, as `open_panel` makes it on the real bus."""
    wanted = urls.parse(panel.url)
    if isinstance(panel.bus, I2CBus):
        return I2CTransport(panel.bus, wanted.address, **wanted.transport), wanted.controller
    lines = {name: value for name, value in wanted.transport.items() if name in ("dc", "reset")}
    panel.bus.spi.cshigh = wanted.controller.synced
    return SPITransport(spi=panel.bus.spi, pins=panel.bus.pins, **lines), wanted.controller


# -- URLs


@pytest.mark.parametrize("name", CHIPS)
def test_every_chip_stands_at_its_usual_place(name):
    with Rig([f"sim://{name}"]) as rig:
        [panel] = rig.panels
        transport, controller = transport_to(panel)
        picture = drawn(Panel(controller, transport))
    assert panel.name == name
    assert shows(panel.chip, picture)
    assert panel.chip.violations == []
    assert [*rig.i2c, *rig.spi] == [1 if "i2c" in CHIPS[name].buses else (0, 0)]


def test_panels_of_one_bus_share_it_and_multiplexers_keep_them_apart():
    places = ["1/0x3c?chip=ssd1306", "1/0x3d?chip=sh1106", "1/0x70:3/0x3e", "1/0x70:5/0x3e?size=128x32", "2/0x3c"]
    with Rig([f"i2c://{place}" for place in places]) as rig:
        pictures = [
            drawn(Panel(controller, transport), panel.name)
            for panel, (transport, controller) in ((panel, transport_to(panel)) for panel in rig.panels)
        ]
        assert [panel.name for panel in rig.panels] == ["ssd1306", "sh1106", "ssd1306-2", "ssd1306-3", "ssd1306-4"]
        assert [panel.bus is rig.i2c[1] for panel in rig.panels] == [True] * 4 + [False]
        assert all(shows(panel.chip, picture) for panel, picture in zip(rig.panels, pictures, strict=True))
        selections = rig.i2c[1].bytes - sum(panel.chip.wire_bytes for panel in rig.panels[:4])
        assert selections > 0
        assert selections % 2 == 0  # an address and a byte for the multiplexer


def test_a_module_is_wired_as_its_url_says():
    with Rig(["i2c://1/0x3c?chip=sh1106&column_offset=0", "spi://0.1?chip=ssd1306&dc=GPIO6&reset=none"]) as rig:
        transport, controller = transport_to(rig.panels[0])
        assert shows(rig.panels[0].chip, drawn(Panel(controller, transport)))  # usual modules begin at column 2
        assert (rig.spi[0, 1].dc, rig.spi[0, 1].reset) == (6, None)


def test_a_chip_of_two_addresses_answers_at_both():
    with Rig(["i2c://1/0x3e?chip=uc1609"]) as rig:
        assert sorted(rig.i2c[1].devices) == [0x3E, 0x3F]
        transport, controller = transport_to(rig.panels[0])
        assert shows(rig.panels[0].chip, drawn(Panel(controller, transport)))


def test_the_same_chip_is_made_for_a_script_and_for_a_rig():
    query = "size=64x32&com_pins=0x12&column_offset=32"
    with Rig([f"i2c://1/0x3c?chip=ssd1306&{query}"]) as rig, open_panel(f"sim://ssd1306?{query}") as panel:
        assert vars(panel.simulated).keys() == vars(rig.panels[0].chip).keys()
        assert drawn(panel).sum() == panel.simulated.pixels.sum()


@pytest.mark.parametrize(
    ("places", "message"),
    [
        (["i2c://1/0x3c", "i2c://1/0x3c?chip=sh1106"], "bus 1: there is a device at 0x3c already: give one of the two"),
        (["sim://", "sim://"], "bus 1: there is a device at 0x3c already"),
        (["i2c://1/0x70:3/0x3c", "i2c://1/0x3c"], "there is a device at 0x3c already"),
        (["i2c://1/0x3c", "i2c://1/0x70:3/0x3c"], "there is a device at 0x3c already"),
        (["i2c://1/0x70:3/0x3c", "i2c://1/0x70:3/0x3c"], "there is a device at 0x3c already"),
        (["i2c://1/0x70:3/0x3c", "i2c://1/0x70?chip=ht16k33"], "there is a device at 0x70 already"),
        (["i2c://1/0x70?chip=ht16k33", "i2c://1/0x70:3/0x3c"], "give the multiplexer another address"),
        (["i2c://1/0x70:8/0x3c"], "channel of 0 to 7, not 8"),
        (["i2c://1/0x78"], "address must be 0x08 to 0x77"),
        (["i2c:///dev/oled/0x3c"], "the bus by its number, such as i2c://1/0x3c, not '/dev/oled'"),
        (["i2c://1/0x3c?max_message=1"], "max_message must be 2 to 8192, not 1"),
        (["spi://0.0?chip=max7219"] * 2, "SPI 0.0 has a panel.*modules in a row are one panel, of size=64x8"),
        (["spi://0.0?dc=58"], "dc must be a line of a Raspberry Pi's chip, 0 to 57, not 58"),
        (["spi://0.0?reset=RST"], "reset must be a line of .*, not 'RST'"),
        (["serial:///dev/ttyACM0"] * 2, "/dev/ttyACM0 has a panel: give each a port of its own"),
        (["serial:///dev/ttyACM0?chip=ht16k33"], "chip must be one that takes control bytes .* not ht16k33"),
        (["socket://localhost:7000"], "url must have the name of a port"),
        (["i2c://1/0x3c?chip=sh110"], "did you mean sh1107?"),
        (["i2c://1/0x3c?look=blu"], "did you mean blue?"),
        (["i2c://1/0x3c?colum_offset=2"], "did you mean column_offset?"),
    ],
)
def test_what_cannot_be_is_refused(places, message):
    with pytest.raises(ValueError, match=message.replace("?", r"\?")):
        Rig(places)


# -- Files


FILE = """
[i2c.1]
clock = 100_000

[panel.clock]
url = "i2c://1/0x3c?chip=ssd1306"
size = "128x32"

[panel.weather]
url = "i2c://1/0x70:3/0x3d"
chip = "sh1106"
mirror_x = true

[panel.stage]
url = "spi://0.0?chip=max7219"
size = "64x8"
order = "rows"
"""


def test_a_file_names_panels_and_what_they_are(tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(FILE)
    with Rig.from_file(path) as rig:
        assert [(panel.name, repr(panel.chip)) for panel in rig.panels] == [
            ("clock", "<SSD1306 128x32, off, 0 frames>"),
            ("weather", "<SH1106 128x64, off, 0 frames>"),
            ("stage", "<MAX7219 64x8, off, 0 frames>"),
        ]
        assert rig.panels[1].url == "i2c://1/0x70:3/0x3d?chip=sh1106&mirror_x=1"
        assert rig.i2c[1].clock == 100_000
        transport, controller = transport_to(rig.panels[0])
        drawn(Panel(controller, transport))
        assert rig.i2c[1].seconds > 9 * 512 / 100_000
        rig.add("i2c://1/0x3f", name="more")
        assert [panel.name for panel in rig.panels][-1] == "more"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "there is no panel: write"),
        ("[panel.a]\nurl = i2c", "is no TOML: .*line 2"),
        ('[panels.a]\nurl = "i2c://1"', "'panels' must be one of panel, i2c; did you mean panel?"),
        ('[panel]\nurl = "i2c://1"', r"panel.url must be a table, such as \[panel.url\], not 'i2c://1'"),
        ("panel = 1", r"panel must be a table, such as \[panel.1\], not 1"),
        ("[panel.a]\nurls = 'i2c://1'", r"\[panel.a\]: url must be text, .*; did you mean urls?"),
        ("[panel.a]\nurl = 7", r"\[panel.a\]: url must be text"),
        ("[panel.a]\nurl = 'i2c://1'\ncolum_offset = 2", r"\[panel.a\]: .*'colum_offset'; did you mean column_offset?"),
        ("[panel.a]\nurl = 'i2c://1'\nsize = [128, 64]", r"\[panel.a\]: size must be text, a whole number"),
        ("[panel.a]\nurl = 'i2c://1?size=128x32'\nsize = '128x64'", "each parameter once"),
        ("[panel.a]\nurl = 'i2c://1'\n[panel.b]\nurl = 'i2c://1'", r"\[panel.b\]: bus 1: there is a device at 0x3c"),
        (
            "[panel.a]\nurl = 'i2c://1'\n[i2c.1]\nclok = 1",
            r"\[i2c.1\]: 'clok' must be one of clock; did you mean clock?",
        ),
        ("[panel.a]\nurl = 'i2c://1'\n[i2c.one]\nclock = 1", r"\[i2c.one\]: i2c must have the number of a bus"),
        ("[panel.a]\nurl = 'i2c://1'\n[i2c.1]\nclock = 0", r"\[i2c.1\]: clock: 0 is not a rate"),
    ],
)
def test_a_bad_file_says_what_is_wrong_and_where(text, message, tmp_path):
    path = tmp_path / "rig.toml"
    path.write_text(text)
    with pytest.raises(ValueError, match=message.replace("?", r"\?")) as raised:
        Rig.from_file(path)
    assert str(path) in str(raised.value)


def test_python_without_toml_says_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "tomllib", None)
    monkeypatch.setitem(sys.modules, "tomli", None)
    with pytest.raises(OSError, match="pip install tomli"):
        Rig.from_file(tmp_path / "rig.toml")


# -- Serial ports


BOARDS = ["", "chip=sh1106&size=128x32", "chip=ssd1327", "chip=max7219&size=64x8", "chip=ssd1322", "chip=st7920"]


@needs_pty
@pytest.mark.parametrize("query", BOARDS)
def test_a_panel_on_a_serial_port(query):
    with Rig([f"serial:///dev/ttyACM0?{query}"]) as rig:
        [panel] = rig.panels
        assert rig.serial == {"/dev/ttyACM0": panel.port.path}
        with open_panel(f"serial://{panel.port.path}") as opened:  # chip and size come from the board
            picture = drawn(opened)
        assert opened.controller.name == type(panel.chip).__name__.lower()
        assert shows(panel.chip, picture)
        assert panel.chip.violations == []
    assert not os.path.lexists(panel.port.path)


@needs_pty
def test_raw_pyserial_talks_to_the_board():
    import serial

    with Rig(["serial:///dev/ttyUSB3"]) as rig, serial.Serial(rig.panels[0].port.path, timeout=5) as port:
        port.write(encode(Hello(nonce=7)))
        answer = b""
        while b"ssd1306" not in answer:
            more = port.read(port.in_waiting or 1)
            assert more, answer
            answer += more
        assert port.name.endswith("/ttyUSB3")


@needs_pty
def test_a_board_that_is_pulled_out_and_put_back():
    with Rig(["serial:///dev/ttyACM0"]) as rig:
        port, chip = rig.panels[0].port, rig.panels[0].chip
        with open_panel(f"serial://{port.path}") as panel:
            first = drawn(panel, "before")
            assert shows(chip, first)
            port.unplug()
            port.unplug()
            assert not port.plugged
            with pytest.raises(PanelDisconnectedError):
                drawn(panel, "away")
            port.plug()
            port.plug()
            assert not chip.registers.on
            assert shows(chip, drawn(panel, "again"))


@needs_pty
def test_a_board_may_be_pulled_out_by_a_fault_of_its_bus():
    with Rig(["serial:///dev/ttyACM0"]) as rig:
        [panel] = rig.panels
        with open_panel(f"serial://{panel.port.path}") as opened:
            panel.bus.fail(after=1, then=panel.port.unplug)
            with pytest.raises(PanelError):
                drawn(opened)
        assert not panel.port.plugged
        with pytest.raises(ValueError, match="closed"):
            panel.port.close() or panel.port.plug()


@needs_pty
def test_a_host_that_reads_no_answers_does_not_hold_the_board():
    with Rig(["serial:///dev/ttyACM0"]) as rig:
        port = rig.panels[0].port
        far = os.open(port.path, os.O_RDWR | os.O_NOCTTY)
        for _ in range(300):
            os.write(far, encode(Hello(nonce=1)))
        end = time.monotonic() + 10
        while port.bytes < 300 * len(encode(Hello(nonce=1))) and time.monotonic() < end:
            time.sleep(0.01)
        assert port.bytes == 300 * len(encode(Hello(nonce=1)))
        os.close(far)


@needs_pty
def test_a_script_that_closes_nothing_leaves_nothing():
    script = "from paneldraw.simulator import Rig; print(Rig(['serial:///dev/ttyACM0']).panels[0].port.path)"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert done.stdout.endswith("/ttyACM0\n"), done.stderr
    assert not os.path.lexists(os.path.dirname(done.stdout))


@needs_pty
def test_noise_on_the_line_is_healed():
    with Rig(["serial:///dev/ttyACM0"]) as rig:
        for text in ("flip:0.2%", "drop:0.1%"):
            mishap = read_mishap(text)
            mishap.strike(rig.panels)
        with open_panel(f"serial://{rig.panels[0].port.path}?baudrate=115200") as panel:
            for number in range(10):
                picture = drawn(panel, f"picture {number}")
                assert shows(rig.panels[0].chip, picture)
        assert mishap.struck > 0


# -- Mishaps


def test_a_mishap_strikes_at_its_rate_and_the_same_for_a_seed():
    def errors(seed):
        with Rig(["i2c://1/0x3c", "i2c://1/0x3d"]) as rig:
            mishap = read_mishap("nack:5%")
            mishap.strike(rig.panels[:1], seed)
            found = []
            for number in range(2000):
                rig.i2c[1].write_quick(0x3D)
                try:
                    rig.i2c[1].write_quick(0x3C)
                except OSError as error:
                    found.append((number, error.errno))
            assert mishap.struck == len(found)
            return found

    first = errors(1)
    assert 60 < len(first) < 140
    assert {number for _, number in first} == {errno.EREMOTEIO}
    assert errors(1) == first != errors(2)


@pytest.mark.parametrize("kind", mishaps.KINDS)
def test_what_a_panel_shows_after_mishaps_of_every_kind_is_whole(kind):
    with Rig(["i2c://1/0x3c"]) as rig:
        transport, controller = transport_to(rig.panels[0])
        panel = Panel(controller, transport)
        drawn(panel)
        mishap = read_mishap(f"{kind}:3%")
        mishap.strike(rig.panels)
        for number in range(60):
            with contextlib.suppress(TransportError):
                drawn(panel, f"number {number}")
        rig.i2c[1].clear_faults()
        panel.invalidate()
        assert shows(rig.panels[0].chip, drawn(panel, "healed"))
        assert mishap.struck > 3


def test_every_message_fails_at_a_rate_of_all():
    with Rig(["spi://0.0?chip=ssd1322"]) as rig:
        read_mishap("timeout:100%").strike(rig.panels)
        for _ in range(3):
            with pytest.raises(OSError, match="timed out"):
                rig.spi[0, 0].spi.writebytes([0])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("nak:1%", "fail must be one of nack, .*, not 'nak'; did you mean nack?"),
        ("nack", "such as nack:1%, not 'nack'"),
        ("nack:1", "such as nack:1%"),
        ("nack:0%", "above 0% and up to 100%"),
        ("nack:101%", "above 0% and up to 100%"),
        ("nack:-1%", "above 0%"),
    ],
)
def test_a_mishap_that_is_none(text, message):
    with pytest.raises(ValueError, match=message.replace("?", r"\?")):
        read_mishap(text)


@pytest.mark.parametrize(("kind", "about"), [("nack", "nobody acknowledges"), ("flip", "serial line")])
def test_a_mishap_that_no_panel_can_have(kind, about):
    with Rig(["spi://0.0?chip=max7219"]) as rig, pytest.raises(ValueError, match=f"{kind} strikes no panel.*{about}"):
        read_mishap(f"{kind}:1%").strike(rig.panels)


# -- Time


@pytest.mark.parametrize("url", ["i2c://1/0x3c?chip=ssd1327", "spi://0.0?chip=ssd1327"])
def test_in_real_time_a_call_lasts_as_long_as_the_wire_is_busy(url):
    with Rig([url], realtime=True) as rig:
        transport, controller = transport_to(rig.panels[0])
        panel = Panel(controller, transport)
        busy, start = rig.panels[0].bus.seconds, time.monotonic()
        picture = Framebuffer(128, 128, 4)
        for level in (15, 3):
            picture.fill(level)
            panel.show(picture)
        assert time.monotonic() - start >= rig.panels[0].bus.seconds - busy > 0.01


def test_the_buses_are_those_that_urls_say():
    with Rig(["i2c://0/0x3c", "spi://1.2?chip=max7219"]) as rig:
        assert isinstance(rig.i2c[0], I2CBus)
        assert isinstance(rig.spi[1, 2], SPIBus)


# -- Programs of others


def unavailable():
    try:
        with Rig().preload():
            return ""
    except OSError as error:
        return str(error)


needs_buses = pytest.mark.skipif(bool(unavailable()), reason=f"simulated buses for programs: {unavailable()}")

SMBUS2 = """
from smbus2 import SMBus, i2c_msg
with SMBus(1) as bus:
    bus.write_i2c_block_data(0x3C, 0x00, [0x8D, 0x14, 0xA1, 0xC8, 0x20, 0x00, 0x21, 0, 127, 0x22, 0, 7])
    bus.i2c_rdwr(i2c_msg.write(0x3C, [0x40] + [0xFF] * 512 + [0x00] * 512), i2c_msg.write(0x3C, [0x00, 0xAF]))
    print(bus.read_byte(0x3C) & 0x40)
"""
LUMA = """
from luma.core.interface.serial import i2c
from luma.core.render import canvas
from luma.oled.device import ssd1306

device = ssd1306(i2c(port=1, address=0x3C))
device.persist = True
with canvas(device) as draw:
    draw.rectangle(device.bounding_box, outline="white", fill="black")
    draw.text((30, 40), "Hello World", fill="white")
"""
LUMA_MATRIX = """
from luma.core.interface.serial import noop, spi
from luma.core.render import canvas
from luma.led_matrix.device import max7219

device = max7219(spi(port=0, device=0, gpio=noop()), cascaded=4)
device.persist = True
with canvas(device) as draw:
    draw.rectangle(device.bounding_box, outline="white", fill="black")
"""
SPIDEV = """
import gpiod, spidev
from gpiod.line import Direction, Value

lines = gpiod.request_lines("/dev/gpiochip0", {24: gpiod.LineSettings(direction=Direction.OUTPUT)})
bus = spidev.SpiDev()
bus.open(0, 0)
bus.max_speed_hz = 8_000_000
lines.set_value(24, Value.INACTIVE)
bus.writebytes([0x8D, 0x14, 0xA5, 0xAF])
"""
RESET = """
import gpiod
from gpiod.line import Direction, Value

with gpiod.request_lines("/dev/gpiochip0", {4: gpiod.LineSettings(direction=Direction.OUTPUT)}) as lines:
    lines.set_value(4, Value.INACTIVE)
"""
ADAFRUIT = """
import board, busio
from adafruit_ssd1306 import SSD1306_I2C

oled = SSD1306_I2C(128, 64, busio.I2C(board.SCL, board.SDA))
oled.fill(0)
oled.rect(0, 0, 128, 64, 1)
oled.show()
"""
BLINKA = {"BLINKA_FORCEBOARD": "RASPBERRY_PI_4B", "BLINKA_FORCECHIP": "BCM2XXX"}


def frame_of(width, height):
    fb = Framebuffer(width, height)
    fb.rect(0, 0, width, height)
    return fb.pixels


def top_half():
    fb = Framebuffer(128, 64)
    fb.rect(0, 0, 128, 32, fill=True)
    return fb.pixels


def ran(rig, script, **environment):
    """Run a script in Python with a rig's panels; return what it printed."""
    with rig.preload() as preload:
        done = preload.run(
            [sys.executable, "-c", script],
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            timeout=120,
        )
    assert done.returncode == 0, done.stderr
    return done.stdout


@needs_buses
@pytest.mark.parametrize(
    ("url", "script", "package", "picture"),
    [
        ("i2c://1/0x3c", SMBUS2, "smbus2", top_half()),
        ("i2c://1/0x3c", ADAFRUIT, "adafruit_ssd1306", frame_of(128, 64)),
        (
            "spi://0.0?chip=max7219&first_block=top-left&block_rotation=270",
            LUMA_MATRIX,
            "luma.led_matrix",
            frame_of(32, 8),
        ),
        ("spi://0.0?chip=ssd1306&dc=24&reset=none", SPIDEV, "spidev", np.ones((64, 128), np.uint8)),
    ],
)
def test_programs_of_others_run_unchanged(url, script, package, picture):
    pytest.importorskip(package)
    if url.startswith("spi"):
        pytest.importorskip("spidev")
    with Rig([url]) as rig:
        ran(rig, script, **BLINKA)
        [panel] = rig.panels
        assert np.array_equal(panel.chip.pixels, picture)
        assert panel.chip.violations == []


@needs_buses
def test_an_example_of_luma_shows_its_picture():
    pytest.importorskip("luma.oled")
    from luma.core.device import dummy
    from luma.core.render import canvas

    with Rig(["i2c://1/0x3c"]) as rig:
        ran(rig, LUMA)
    device = dummy(width=128, height=64, mode="1")
    with canvas(device) as draw:
        draw.rectangle(device.bounding_box, outline="white", fill="black")
        draw.text((30, 40), "Hello World", fill="white")
    assert np.array_equal(rig.panels[0].chip.pixels, np.asarray(device.image))
    assert rig.panels[0].chip.violations == []


@needs_buses
def test_a_program_finds_several_panels_of_one_bus_and_one_behind_a_multiplexer():
    urls = ["i2c://1/0x3c", "i2c://1/0x3d?chip=sh1106", "i2c://1/0x70:3/0x3e?size=128x32", "serial:///dev/ttyACM0"]
    script = """
from paneldraw import open_panel

for url in URLS:
    with open_panel(url) as panel, panel.frame() as fb:
        fb.rect(0, 0, fb.width, fb.height)
"""
    with Rig(urls) as rig:
        ran(rig, script.replace("URLS", repr(urls)))
        for panel in rig.panels:
            assert np.array_equal(panel.chip.pixels, frame_of(panel.chip.width, panel.chip.height)), panel.name


@needs_buses
def test_a_reset_line_resets_the_module_on_i2c():
    with Rig(["i2c://1/0x3c?reset=4"]) as rig:
        rig.i2c[1].write_i2c_block_data(0x3C, 0, [0xAF])
        assert rig.panels[0].chip.registers.on
        ran(rig, RESET)
        assert not rig.panels[0].chip.registers.on
