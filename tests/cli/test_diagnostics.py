"""Looking for panels on buses that are simulated below smbus2's interface, and using them from the command line."""

from __future__ import annotations

import errno
import importlib.metadata
import itertools
import json
import re
import shlex
import signal
import sys
from pathlib import Path
from urllib.parse import urlsplit

import numpy as np
import pytest
import smbus2

import paneldraw
from paneldraw import _compiled, simulator
from paneldraw._interpreted import rebuild
from paneldraw.cli import diagnostics, main
from paneldraw.framebuffer import Framebuffer


class Wire:
    """A bus that cannot be told from a real one by its type."""

    def __init__(self, bus):
        self.bus = bus

    def __getattr__(self, name):
        return getattr(self.bus, name)


@pytest.fixture
def machine(monkeypatch):
    """A machine with the buses that a test puts into this dictionary: number to (adapter's name, bus or error)."""
    buses = {}

    def opened(path):
        number = int(re.fullmatch(r"/dev/i2c-(\d+)", path).group(1))
        if number not in buses:
            raise FileNotFoundError(errno.ENOENT, "No such file or directory", path)
        _, bus = buses[number]
        if isinstance(bus, Exception):
            raise bus
        bus.open(number)
        return Wire(bus)

    monkeypatch.setattr(smbus2, "SMBus", opened)
    monkeypatch.setattr(diagnostics, "i2c_buses", lambda: [(f"/dev/i2c-{n}", name) for n, (name, _) in buses.items()])
    monkeypatch.setattr(diagnostics, "serial_ports", list)
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    return buses


def test_all_that_answers_is_told_and_panels_are_named(machine):
    chips = {0x3D: simulator.SSD1306(), 0x68: simulator.SSD1306(), 0x36: simulator.SSD1306()}
    machine[1] = ("bcm2835 (i2c@7e804000)", simulator.I2CBus(chips))
    found = diagnostics.detect()
    told = [line.partition(": ")[2] for line in found.lines]
    assert [line.split()[0] for line in told] == ["36", "3d", "68"]
    assert found.panels == ["i2c://1/0x3d?chip=ssd1306"]
    assert "paneldraw demo --panel 'i2c://1/0x3d?chip=ssd1306'" in told[1]


@pytest.mark.parametrize(("make", "guess"), [("SSD1306", "ssd1306"), ("SH1106", "sh1106"), ("SH1107", "sh1107")])
def test_the_chip_is_guessed_by_its_status(machine, make, guess):
    machine[1] = ("bcm2835", simulator.I2CBus({0x3C: getattr(simulator, make)()}))
    found = diagnostics.detect()
    assert found.panels == [f"i2c://1/0x3c?chip={guess}"]
    assert f"its status is that of an {guess.upper()}, at a guess" in found.lines[0]
    assert not any("noise" in line for line in found.lines)


def test_led_matrices_are_known_by_their_address(machine):
    machine[1] = ("bcm2835", simulator.I2CBus({0x70: simulator.HT16K33(), 0x74: simulator.IS31FL3731()}))
    assert diagnostics.detect().panels == ["i2c://1/0x70?chip=ht16k33", "i2c://1/0x74?chip=is31fl3731"]


def test_where_nothing_can_be_read_the_symptoms_are_told(machine):
    class WriteOnly(simulator.SSD1306):
        def read(self, length):
            raise OSError(121, "Remote I/O error")

    machine[1] = ("bcm2835", simulator.I2CBus({0x3C: WriteOnly()}))
    found = diagnostics.detect()
    assert found.panels == ["i2c://1/0x3c"]
    told = "\n".join(found.lines)
    for advice in ("chip=sh1106", "size=128x32", "mirror_x=1", "internal_reference=1", "reset="):
        assert advice in told


def test_the_search_changes_nothing(machine):
    chip = simulator.SSD1306()
    machine[1] = ("bus", simulator.I2CBus({0x3C: chip}))
    before = vars(chip.registers).copy()
    diagnostics.detect()
    assert vars(chip.registers) == before
    assert not chip.violations


def test_only_the_bus_that_is_named_is_searched(machine):
    for number in (1, 3):
        machine[number] = ("bus", simulator.I2CBus({0x3C: simulator.SSD1306()}))
    for url in ("i2c://3", "i2c://3/0x3c", "i2c:///dev/i2c-3/0x3c", "i2c:///dev/i2c-3"):
        assert diagnostics.detect(url).panels == ["i2c://3/0x3c?chip=ssd1306"]
    assert machine[1][1].messages == 0


def test_the_mainboards_own_bus_is_left_alone_unless_asked_for(machine):
    machine[0] = ("SMBus I801 adapter at efa0", simulator.I2CBus({0x3C: simulator.SSD1306()}))
    found = diagnostics.detect()
    assert machine[0][1].messages == 0
    assert not found.panels
    assert "i2c://0" in found.lines[0]
    assert diagnostics.detect("i2c://0").panels == ["i2c://0/0x3c?chip=ssd1306"]


@pytest.mark.parametrize(
    ("code", "told"), [(errno.EBUSY, "08 is in use by a driver"), (errno.ETIMEDOUT, "stuck"), (errno.ENXIO, "nobody")]
)
def test_what_a_bus_may_answer(machine, code, told):
    machine[1] = ("bus", simulator.I2CBus())
    machine[1][1].fail(code)
    found = diagnostics.detect()
    assert told in found.lines[0]
    assert not found.panels


def test_an_adapter_that_cannot_write_an_address_alone_is_read(machine, monkeypatch):
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()})

    def refuse(*_):
        raise OSError(errno.EOPNOTSUPP, "Operation not supported")

    monkeypatch.setattr(bus, "write_quick", refuse)
    machine[1] = ("bus", bus)
    assert diagnostics.detect().panels == ["i2c://1/0x3c?chip=ssd1306"]


def test_a_bus_without_permission_does_not_hide_the_next(machine):
    machine[0] = ("bus", PermissionError(errno.EACCES, "Permission denied", "/dev/i2c-0"))
    machine[1] = ("bus", simulator.I2CBus({0x3C: simulator.SSD1306()}))
    found = diagnostics.detect()
    assert "group i2c" in found.lines[0]
    assert found.panels == ["i2c://1/0x3c?chip=ssd1306"]


def test_what_to_do_without_bus_and_without_panel(machine, capsys):
    assert main(["detect"]) == 1
    assert "raspi-config" in capsys.readouterr().err
    machine[1] = ("bus", simulator.I2CBus())
    assert main(["detect"]) == 1
    output = capsys.readouterr()
    assert "nobody answers" in output.out
    assert "SDA" in output.err


@pytest.mark.parametrize(
    ("url", "advice"),
    [
        ("spi://0.0", "--panel i2c://1"),
        ("serial:///dev/ttyACM0", "paneldraw firmware info serial:///dev/ttyACM0"),
        ("panel", "--panel i2c://1"),
    ],
)
def test_where_detect_cannot_look(url, advice):
    with pytest.raises(ValueError, match=f"try {advice}$"):
        diagnostics.detect(url)


def test_every_url_that_is_found_opens(machine, capsys):
    machine[1] = ("bus", simulator.I2CBus({0x3C: simulator.SSD1306(), 0x3D: simulator.SSD1306()}))
    for url in diagnostics.detect().panels:
        assert urlsplit(url).scheme == "i2c"
        assert main(["info", "--panel", url]) == 0
        assert "ssd1306 128x64" in capsys.readouterr().out


def test_text_on_a_real_bus_stays_on_the_glass(machine, capsys):
    chip = simulator.SSD1306()
    machine[1] = ("bus", simulator.I2CBus({0x3C: chip}))
    assert main(["text", "Hello", "--panel", "i2c://1/0x3c"]) == 0
    wanted = Framebuffer(128, 64)
    wanted.text("Hello", 63, 31, anchor="mm")
    assert np.array_equal(chip.pixels, wanted.pixels)
    assert re.fullmatch(r"Hello: \d+ bytes on the wire\n", capsys.readouterr().out)
    assert not chip.violations


def test_a_demo_on_a_real_bus_leaves_the_glass_dark(machine, capsys):
    chip = simulator.SSD1306()
    machine[1] = ("bus", simulator.I2CBus({0x3C: chip}))
    assert main(["demo", "--panel", "i2c://1/0x3c", "--frames", "3", "--fps", "1000"]) == 0
    assert len({frame.pixels.tobytes() for frame in chip.frames}) > 1
    assert not chip.pixels.any()
    assert "frame" in capsys.readouterr().out


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("call", [1, 2, 3, 10])
def test_a_signal_at_any_transfer_leaves_the_glass_dark(machine, number, call):
    chip = simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip})
    machine[1] = ("bus", bus)
    carry, calls = bus.i2c_rdwr, itertools.count(1)

    def interrupted(*messages):
        carry(*messages)
        if next(calls) == call:
            signal.raise_signal(number)

    bus.i2c_rdwr = interrupted
    handlers = signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)
    assert main(["demo", "--panel", "i2c://1", "--seconds", "inf", "--fps", "1000"]) == 128 + number
    assert not chip.pixels.any()
    assert not chip.violations
    assert (signal.getsignal(signal.SIGINT), signal.getsignal(signal.SIGTERM)) == handlers


@pytest.mark.parametrize("command", [["demo", "--frames", "500"], ["text", "hi"]])
def test_a_panel_that_fails_is_told_in_one_line(machine, capsys, command):
    bus = simulator.I2CBus({0x3C: simulator.SSD1306()})
    machine[1] = ("bus", bus)
    bus.fail(after=1, times=None)
    assert main([*command, "--panel", "i2c://1"]) == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1
    assert told.startswith("paneldraw: nobody answers at 0x3C")


def test_the_other_address_is_named(machine, capsys):
    machine[1] = ("bus", simulator.I2CBus({0x3D: simulator.SSD1306()}))
    assert main(["text", "hi", "--panel", "i2c://1/0x3c"]) == 1
    assert "found 0x3D instead" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("recorded", "asked"),
    [
        (None, ["paneldraw"]),
        ({"url": "file:///home/me/paneldraw", "dir_info": {}}, ["file:///home/me/paneldraw"]),
        ({"url": "file:///a%20b", "dir_info": {"editable": True}}, ["--editable", "file:///a%20b"]),
        (
            {"url": "https://example.org/p.git", "vcs_info": {"vcs": "git", "commit_id": "ba17"}},
            ["git+https://example.org/p.git@ba17"],
        ),
    ],
)
def test_the_command_that_compiles_installs_from_where_it_came(monkeypatch, recorded, asked):
    class Distribution:
        def read_text(self, name):
            assert name == "direct_url.json"
            return None if recorded is None else json.dumps(recorded)

    monkeypatch.setattr(importlib.metadata, "distribution", lambda name: Distribution())
    words = shlex.split(rebuild())
    assert words[:4] == [sys.executable, "-m", "pip", "install"]
    assert {"--force-reinstall", "--no-cache-dir", "--no-binary", "--no-deps"} <= set(words)
    assert words[-len(asked) :] == asked


def test_what_is_not_installed_is_compiled_where_it_lies(monkeypatch):
    def missing(name):
        raise importlib.metadata.PackageNotFoundError(name)

    monkeypatch.setattr(importlib.metadata, "distribution", missing)
    assert shlex.split(rebuild())[-2:] == ["--editable", str(Path(paneldraw.__file__).parent.parent)]


def test_where_there_is_no_pip_uv_compiles(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", {}.get)
    words = shlex.split(rebuild())
    assert words[:5] == ["uv", "pip", "install", "--python", sys.executable]
    assert {"--reinstall", "--no-deps", "--no-cache", "--no-binary"} <= set(words)


def test_info_tells_an_interpreted_install_how_to_compile(monkeypatch):
    monkeypatch.setattr(_compiled, "COMPILED", False)
    told = dict(diagnostics.info())["drawing"]
    assert told.startswith("interpreted")
    assert told.endswith(f"run: {rebuild()}")
    monkeypatch.setattr(_compiled, "COMPILED", True)
    assert dict(diagnostics.info())["drawing"] == "compiled"
