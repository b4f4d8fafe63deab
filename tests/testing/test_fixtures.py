"""The fixtures: panels of every kind, faults in a line, and nothing left when a test is over."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import tempfile
import threading

import numpy as np
import pytest

from paneldraw import Panel, open_panel, simulator
from paneldraw.controllers import CHIPS
from paneldraw.errors import PanelDisconnectedError, PanelError, PanelTimeoutError
from paneldraw.testing import SerialPanel, SimPanel, assert_pattern, chip_of, frames_of, leaks, panels, programs
from paneldraw.transports import I2CTransport

CORNER = "###\n#.#\n###"

_ = programs  # imported here with the others: a session in a session forgets what it imported


def draw(panel):
    with panel.frame() as fb:
        fb.rect(0, 0, 3, 3, fb.max_level)
    return fb.pixels


def test_a_panel(sim_panel):
    assert type(sim_panel) is SimPanel
    draw(sim_panel)
    sim_panel.assert_pattern(CORNER, at=(0, 0))
    assert sim_panel.pixels is sim_panel.chip.pixels
    assert sim_panel.simulated is sim_panel.chip
    assert (sim_panel.controller.name, sim_panel.chip.violations) == ("ssd1306", [])


URLS = [
    "sim://ssd1306?size=64x32",
    "sim://ssd1322?contrast=200",
    "i2c://1/0x3d?chip=sh1106&column_offset=2&reset=4",
    "i2c://1/0x70:3/0x3c?chip=ssd1306",
    "i2c:///dev/i2c-7/0x38?chip=uc1609",
    "spi://0.1?chip=ssd1322&dc=22&reset=none",
    "spi://0.0?chip=st7920",
    "spi://0.0?chip=max7219&size=32x8",
]


@pytest.mark.parametrize("sim_panel", [*URLS, *(f"sim://{chip}" for chip in CHIPS)], indirect=True)
def test_a_panel_of_a_url(sim_panel):
    assert np.array_equal(draw(sim_panel), sim_panel.pixels)
    assert sim_panel.bus.bytes > 0
    assert len(frames_of(sim_panel)) == 1
    assert sim_panel.chip.violations == []


@pytest.mark.parametrize("sim_panel", ["sim://ssd1306?rotate=90"], indirect=True)
def test_a_turned_panel_shows_the_glass(sim_panel):
    assert (sim_panel.width, sim_panel.height) == (64, 128)
    draw(sim_panel)
    sim_panel.assert_pattern(CORNER, at=(125, 0))


def test_time_is_that_of_the_wire():
    times = []
    for _ in range(2):
        with SimPanel() as panel:
            draw(panel)
            panel.bus.idle(0.5)
            panel.invert(True)
            times.append([frame.seconds for frame in frames_of(panel)])
    assert times[0] == times[1]
    assert 0.5 < times[0][1] - times[0][0] < 0.51


def test_a_fault_in_a_line(sim_panel):
    sim_panel.bus.fail(after=3, errno=121)
    draw(sim_panel)
    assert sim_panel.stats.faults == {"EREMOTEIO": 1}
    sim_panel.bus.fail(errno=110, times=None)
    with pytest.raises(PanelTimeoutError):
        sim_panel.show(force=True)
    sim_panel.bus.clear_faults()
    sim_panel.show()
    sim_panel.assert_pattern(CORNER, at=(0, 0))


def test_lost_power_heals_with_the_next_show(sim_panel):
    picture = draw(sim_panel)
    sim_panel.power_cycle()
    assert not sim_panel.pixels.any()
    sim_panel.show(picture)
    sim_panel.assert_pattern(CORNER, at=(0, 0))
    assert sim_panel.stats.restarts == 1


def test_a_closed_panel_can_be_looked_at(sim_panel):
    draw(sim_panel)
    sim_panel.close()
    sim_panel.close()
    sim_panel.assert_pattern(CORNER, at=(0, 0))
    with pytest.raises(PanelError, match="closed"):
        draw(sim_panel)


def test_a_panel_that_is_none():
    with pytest.raises(ValueError, match="did you mean ssd1327"):
        SimPanel("sim://ssd1307")
    with pytest.raises(ValueError, match="contrast must be 0 to 255"):
        SimPanel("sim://ssd1306?contrast=300")
    with pytest.raises(ValueError, match="url must"):
        SimPanel("sim://ssd1306?view=terminal")
    with pytest.raises(ValueError, match=r"url must be like serial:///dev/ttyACM0\?chip=ssd1306"):
        SerialPanel("sim://ssd1306")


# -- buses


def test_a_bus_for_other_drivers(i2c_bus):
    i2c_bus.write_i2c_block_data(0x3C, 0x00, [0x8D, 0x14, 0xA5, 0xAF])
    assert chip_of(i2c_bus).pixels.all()
    i2c_bus.fail(errno=5)
    with pytest.raises(OSError, match="Input/output error"):
        i2c_bus.write_byte(0x3C, 0)


@pytest.mark.parametrize("i2c_bus", [("i2c://1/0x3c?chip=ssd1306", "i2c://1/0x70:3/0x3d?chip=sh1106")], indirect=True)
def test_a_bus_with_two_panels(i2c_bus):
    with Panel("sh1106", I2CTransport(i2c_bus, 0x3D, mux=(0x70, 3))) as panel:
        draw(panel)
    assert_pattern(i2c_bus.devices[0x70].channels[3][0x3D], CORNER, at=(0, 0))
    assert not chip_of(i2c_bus.devices[0x3C]).pixels.any()


@pytest.mark.parametrize("spi_bus", ["spi://0.0?chip=ssd1322&dc=22&reset=27"], indirect=True)
def test_an_spi_bus(spi_bus):
    assert (spi_bus.dc, spi_bus.reset) == (22, 27)
    assert type(chip_of(spi_bus)) is simulator.SSD1322


@pytest.mark.parametrize("where", ["spi://0.0", ("i2c://1", "i2c://2"), (), ("i2c://1", "spi://0.0")])
def test_what_is_not_one_bus(where):
    with (
        pytest.raises(ValueError, match="i2c_bus must be parametrized with panels of one i2c:// bus"),
        panels.bus_of(where, "i2c"),
    ):
        pass


# -- serial ports


pty = pytest.mark.skipif(not hasattr(os, "openpty"), reason="there are no pseudo-terminals here")


@pty
def test_a_panel_behind_a_board(serial_panel):
    draw(serial_panel)
    serial_panel.assert_pattern(CORNER, at=(0, 0))
    assert serial_panel.port.bytes > 0
    assert serial_panel.transport.device.controller == "ssd1306"


@pty
@pytest.mark.parametrize("serial_panel", ["serial:///dev/ttyUSB0?chip=ssd1322&rotate=180"], indirect=True)
def test_another_panel_behind_a_board(serial_panel):
    assert (serial_panel.controller.name, serial_panel.rotate) == ("ssd1322", 180)
    draw(serial_panel)
    serial_panel.assert_pattern("fff\nf.f\nfff", at=(253, 61))


@pty
def test_a_board_that_is_pulled_out_and_put_back(serial_panel):
    draw(serial_panel)
    serial_panel.port.unplug()
    with pytest.raises(PanelDisconnectedError):
        serial_panel.show(force=True)
    serial_panel.port.plug()
    serial_panel.show(force=True)
    serial_panel.assert_pattern(CORNER, at=(0, 0))


# -- what is left


LEAVE = """
import os, socket, tempfile, threading, time
import pytest
from paneldraw import open_panel
from paneldraw.simulator.rig import Rig

kept = []

def test_it(sim_panel):
    {}
"""
SENDER = "p = open_panel('sim://ssd1306'); p.show(p.framebuffer(), wait=False); kept.append(p)"
RIG = "kept.append(Rig(['serial:///dev/ttyACM0?chip=ssd1306']))"


@pytest.fixture
def left(pytester):
    """Run a test that keeps something; return what is said of it."""

    def run(code):
        pytester.makepyfile(LEAVE.format(code))
        result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
        result.assert_outcomes(passed=1, errors=1)
        said = [line for line in result.stdout.lines if line.startswith("the test left open: ")]
        return said[0].removeprefix("the test left open: ")

    return run


@pytest.mark.skipif(sys.platform != "linux", reason="open files are listed on Linux alone")
@pytest.mark.parametrize(
    ("code", "what"),
    [
        (SENDER, "thread paneldraw"),
        (RIG, "/dev/ptmx"),
        pytest.param("kept.append(socket.socketpair())", "socket:", marks=pytest.mark.thorough),
        ("s = socket.create_server(('127.0.0.1', 0)); kept.append(s)", "socket:"),
        ("tempfile.mkdtemp(prefix=f'paneldraw-{os.getpid()}-', dir=os.environ.get('TMPDIR'))", "paneldraw-"),
    ],
    ids=["thread", "port", "socket", "server", "folder"],
)
def test_what_a_test_leaves_is_named(left, code, what):
    assert what in left(code)


def test_what_a_failed_test_leaves_is_no_news(pytester):
    pytester.makepyfile(LEAVE.format(RIG + "; assert 0"))
    pytester.runpytest_subprocess().assert_outcomes(failed=1)


def test_what_others_keep_is_theirs():
    before = leaks.Held.now()
    with tempfile.TemporaryFile(), socket.socket(), open(os.devnull):
        done = threading.Event()
        thread = threading.Thread(target=done.wait)
        thread.start()
        assert before.left() == []
        done.set()
        thread.join()


def test_what_ends_soon_is_waited_for():
    before = leaks.Held.now()
    panel = open_panel("sim://ssd1306")
    panel.show(panel.framebuffer(), wait=False)
    threading.Timer(0.1, panel.close).start()
    assert before.left() == []


# -- the plugin in everybody's sessions


def test_the_plugin_imports_nothing_heavy():
    code = "import sys, paneldraw.testing.plugin as p; print(sorted({n.partition('.')[0] for n in sys.modules}))"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert "'paneldraw'" in loaded
    for heavy in ("numpy", "PIL", "smbus2", "serial", "firmware_protocol", "asyncio", "ctypes"):
        assert f"'{heavy}'" not in loaded


def test_it_is_listed_with_its_fixtures_and_settings(pytester):
    result = pytester.runpytest_inprocess("--fixtures", "-q")
    for name in ("sim_panel", "i2c_bus", "spi_bus", "serial_panel", "sim_run"):
        result.stdout.fnmatch_lines([f"{name} -- *paneldraw/testing/plugin.py:*"])
    listed = pytester.runpytest_inprocess("--help").stdout.str()
    assert all(name in listed for name in ("--update-frames", "paneldraw_golden", "paneldraw_failures"))


def test_without_it(pytester):
    pytester.makepyfile("def test_it(sim_panel): pass")
    pytester.runpytest_inprocess("-p", "no:paneldraw").assert_outcomes(errors=1)
