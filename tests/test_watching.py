"""Panels that are watched: their views and recordings, time as the wire takes it, the twin of a real panel."""

from __future__ import annotations

import gc
import os
import signal
import socket
import subprocess
import sys
import textwrap
import threading
import urllib.request

import numpy as np
import pytest
import smbus2
from far_ends import Server
from PIL import Image
from searching import quick

from paneldraw import open_panel, simulator, watching
from paneldraw.controllers import CHIPS
from paneldraw.errors import TransportError
from paneldraw.pacing import Frames
from paneldraw.simulator import wire
from paneldraw.transports import SPITransport

posix = pytest.mark.skipif(not hasattr(os, "fork"), reason="ptys and signals are POSIX")


def noise(panel, seed=1):
    return np.random.default_rng(seed).integers(0, 2**panel.depth, (panel.height, panel.width), np.uint8)


def ours():
    return [thread.name for thread in threading.enumerate() if thread.name.startswith("paneldraw")]


# -- What a URL asks for


@pytest.mark.parametrize("url", ["sim://ssd1306", "i2c://1/0x3c", "spi://0.0?dc=24", "serial://COM3"])
def test_every_url_says_how_its_panel_is_watched(url):
    from paneldraw import urls

    joint = "&" if "?" in url else "?"
    wanted = urls.parse(f"{url}{joint}view=terminal,web&save=out.gif&look=blue&listen=0.0.0.0:80")
    assert wanted.watch == urls.Watch(("terminal", "web"), "out.gif", "blue", False, ("0.0.0.0", 80))
    assert wanted.place == url.partition("?")[0]
    assert not urls.parse(url).watch


@pytest.mark.parametrize(
    ("query", "complaint"),
    [
        ("view=screen", "view must be terminal or web or browser, not 'screen'"),
        ("view=wep", "did you mean web"),
        ("view=", "view must be"),
        ("save=out.jpg", r"save must end in .*gif.*, not 'out.jpg'"),
        ("look=bleu", "did you mean blue"),
        ("realtime=perhaps", "realtime must be 1 or 0"),
        ("listen=0.0.0.0:99999", "listen must be like"),
        ("listen=host:port", "listen must be like"),
    ],
)
def test_what_cannot_be_watched_says_so(query, complaint):
    with pytest.raises(ValueError, match=complaint):
        open_panel(f"sim://ssd1306?{query}")


def test_only_a_simulated_bus_can_take_more_time_than_it_does():
    with pytest.raises(ValueError, match="no parameters but"):
        open_panel("i2c://1/0x3c?realtime=1")


def test_an_environment_variable_views_all_panels(monkeypatch, capfd):
    monkeypatch.setenv("PANELDRAW_VIEW", "terminal")
    with open_panel("sim://ssd1306?size=96x16") as panel:
        panel.show(np.ones((16, 96), np.uint8))
    assert capfd.readouterr().out.count("█" * 96) == 8
    monkeypatch.setenv("PANELDRAW_VIEW", "screen")
    with pytest.raises(ValueError, match="the environment variable PANELDRAW_VIEW is 'screen': view must be"):
        open_panel("sim://ssd1306")


# -- Recordings


@pytest.mark.parametrize("kind", ["gif", "apng"])
def test_a_recording_is_written_at_close(tmp_path, kind):
    path = tmp_path / f"out.{kind}"
    panel = open_panel(f"sim://ssd1306?save={path}&look=blue")
    for seed in range(3):
        panel.show(noise(panel, seed))
        panel.simulated.settle(seed + 1.0, 0)
    assert not path.exists()
    panel.close()
    with Image.open(path) as image:
        assert image.n_frames == 3
        image.seek(2)
        lit = np.asarray(image.convert("RGB"))[4:-4:4, 4:-4:4]
    assert np.array_equal(lit, simulator.find_look("blue").colors(noise(panel, 2)))


@pytest.mark.parametrize("on_close", ["keep", "clear", "off"])
def test_a_still_picture_is_the_last_that_shone(tmp_path, on_close):
    path = tmp_path / "out.png"
    with open_panel(f"sim://ssd1306?save={path}&on_close={on_close}") as panel:
        panel.show(noise(panel))
    with Image.open(path) as image:
        assert np.array_equal(np.asarray(image.convert("L"))[4:-4:4, 4:-4:4] > 128, noise(panel).astype(bool))


def test_a_panel_that_showed_nothing_leaves_a_dark_picture(tmp_path):
    for name in ("out.gif", "out.png"):
        open_panel(f"sim://ssd1306?save={tmp_path / name}").close()
        with Image.open(tmp_path / name) as image:
            assert image.size == (520, 264)


def test_two_panels_at_a_time_have_a_file_each(tmp_path):
    url = f"sim://ssd1306?save={tmp_path / 'out.png'}"
    with open_panel(url) as one, open_panel(url) as two:
        one.clear()
        two.clear()
    assert sorted(file.name for file in tmp_path.iterdir()) == ["out-2.png", "out.png"]
    open_panel(url).close()
    assert len(list(tmp_path.iterdir())) == 2


def test_a_recording_has_more_frames_than_a_chip_keeps(tmp_path):
    with open_panel(f"sim://ssd1306?save={tmp_path / 'out.png'}") as panel:
        assert panel.simulated.history > 10_000


def test_a_folder_that_is_not_there_is_said_at_once(tmp_path):
    with pytest.raises(OSError, match="cannot write there; check the folder"):
        open_panel(f"sim://ssd1306?save={tmp_path / 'none' / 'out.gif'}")
    assert watching._files == set()


# -- The wire's time


class Time:
    """A clock that moves only while somebody sleeps."""

    def __init__(self):
        self.now = 0.0

    def monotonic(self):
        return self.now

    def sleep(self, seconds):
        self.now += seconds


@pytest.mark.filterwarnings("ignore:30 frames a second were asked for")
@pytest.mark.parametrize(("chip", "rate"), [("ssd1327", 5), ("ssd1306", 30), ("sh1122", 5)])
def test_a_loop_shows_as_many_frames_a_second_as_the_wire_carries(monkeypatch, chip, rate):
    clock = Time()
    monkeypatch.setattr(wire, "time", clock)
    panel = open_panel(f"sim://{chip}?realtime=1&updates=whole")
    panel.transport.bus.timer = clock.monotonic
    clock.now = 10.0
    frames, start = Frames(30, clock=clock.monotonic, sleep=clock.sleep), panel.transport.bus.seconds
    for beat in frames:
        if beat.seconds >= 4:
            break
        panel.show(noise(panel, beat.number))
    assert rate <= frames.count / 4 < rate + 1
    assert clock.now - 10.0 == pytest.approx(max(4, panel.transport.bus.seconds - start), abs=0.25)


def test_a_wire_that_rested_owes_nothing(monkeypatch):
    clock = Time()
    monkeypatch.setattr(wire, "time", clock)
    with open_panel("sim://ssd1306?realtime=1") as panel:
        panel.transport.bus.timer = clock.monotonic
        clock.now = 100.0
        before = panel.transport.bus.seconds
        panel.show(noise(panel))
        assert clock.now == pytest.approx(100.0 + panel.transport.bus.seconds - before)


def test_without_it_nobody_sleeps(monkeypatch):
    clock = Time()
    monkeypatch.setattr(wire, "time", clock)
    with open_panel("sim://ssd1306?view=terminal") as panel:
        panel.show(noise(panel))
    assert clock.now == 0


# -- Real panels, of which a twin is sent what they are sent


def on_bus(monkeypatch, name, record):
    """A bus in place of the real one, and the URL of the panel there."""
    chip = getattr(simulator, name.upper())(record.width, record.height)
    if record.buses == ("i2c",) or "i2c" in record.buses:
        bus = simulator.I2CBus({record.address: chip})
        monkeypatch.setattr(smbus2, "SMBus", lambda path: bus)
        return chip, f"i2c://1/{record.address:#x}?chip={name}"
    lines = {"dc": None, "reset": None} if record.registers or record.synced else {}
    bus = simulator.SPIBus(chip, **lines)
    bus.spi.cshigh = record.synced

    def on_it(number=0, *, device=0, spi=None, pins=None, **settings):
        return SPITransport(spi=spi or bus.spi, pins=pins or bus.pins, **settings)

    monkeypatch.setattr("paneldraw.transports.SPITransport", on_it)
    return chip, f"spi://0.0?chip={name}"


@pytest.mark.parametrize("name", CHIPS)
@pytest.mark.parametrize("rotate", [0, 90])
def test_the_twin_of_a_real_panel_shows_what_it_shows(monkeypatch, capfd, name, rotate):
    record = CHIPS[name]()
    record = record if hasattr(record, "address") else _with_address(record, name)
    chip, url = on_bus(monkeypatch, name, record)
    with open_panel(f"{url}&view=terminal&rotate={rotate}") as panel:
        assert panel.simulated is None
        for seed in range(3):
            panel.show(noise(panel, seed))
        panel.show(noise(panel, 3), force=True)
        if panel.controller.inverse:
            panel.invert()
        if panel.controller.contrast:
            panel.contrast(30)
        twin = panel.transport.chip
        assert twin is not chip
        assert np.array_equal(twin.pixels, chip.pixels)
        assert chip.pixels.any()
        assert vars(twin.registers).keys() == vars(chip.registers).keys()
        assert twin.contrast == chip.contrast
    assert chip.frames[-1].max_level == twin.max_level


def _with_address(record, name):
    class Known:
        address = CHIPS[name].address

        def __getattr__(self, what):
            return getattr(record, what)

    return Known()


def test_the_twin_of_a_panel_on_a_board(capfd):
    chip = simulator.SSD1306(128, 32)
    server = Server(False, chip.write)
    with open_panel(f"{server.url}?chip=ssd1306&size=128x32&view=terminal") as panel:
        panel.show(noise(panel))
        assert np.array_equal(panel.transport.chip.pixels, noise(panel))
        assert np.array_equal(chip.pixels, noise(panel))
    server.close()
    assert "ssd1306 128x32, socket://127.0.0.1" in capfd.readouterr().out


def test_what_a_panel_did_not_get_its_twin_does_not_show(monkeypatch, capfd):
    chip = simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip})
    monkeypatch.setattr(smbus2, "SMBus", lambda path: bus)
    with open_panel("i2c://1/0x3c?view=terminal") as panel:
        panel.show(noise(panel, 1))
        bus.fail(at_byte=500, times=100)
        with pytest.raises(TransportError):
            panel.show(noise(panel, 2))
        assert np.array_equal(panel.transport.chip.pixels, noise(panel, 1))
        bus.clear_faults()
        panel.show(noise(panel, 3))
        assert np.array_equal(panel.transport.chip.pixels, noise(panel, 3))


def test_what_goes_wrong_with_a_twin_is_no_concern_of_the_panels(monkeypatch, capfd):
    chip = simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip})
    monkeypatch.setattr(smbus2, "SMBus", lambda path: bus)
    with open_panel("i2c://1/0x3c?view=terminal") as panel:
        panel.transport._twin.bus.fail(errno=5, times=None)
        with pytest.warns(RuntimeWarning, match="the view of the panel stands still"):
            panel.show(noise(panel, 1))
        panel.show(noise(panel, 2))
        assert np.array_equal(chip.pixels, noise(panel, 2))


# -- A view's life


def page_of(capfd):
    return capfd.readouterr().err.partition("watch at ")[2].split()[0]


def answers(url):
    address, _, port = url.partition("//")[2].partition("/")[0].rpartition(":")
    with socket.socket() as probe:
        return probe.connect_ex((address, int(port))) == 0


def test_a_page_lives_as_long_as_the_panel(capfd):
    assert ours() == []
    with open_panel("sim://ssd1306?view=web") as panel:
        url = page_of(capfd)
        panel.show(noise(panel))
        with urllib.request.urlopen(url, timeout=10) as answer:
            assert b"paneldraw" in answer.read()
        assert ours() == ["paneldraw-web"]
    assert ours() == []
    assert not answers(url)


def test_panels_share_a_page_and_the_last_one_ends_it(capfd):
    with open_panel("sim://ssd1306?view=web"):
        url = page_of(capfd)
        with open_panel("sim://ssd1327?view=web"):
            assert ours() == ["paneldraw-web"]
        assert answers(url)
        assert capfd.readouterr().err == ""
    assert not answers(url)


def test_a_port_in_use_gives_way_unless_it_was_asked_for(monkeypatch, capfd):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(OSError, match="address already in use"):
            open_panel(f"sim://ssd1306?view=web&listen=:{port}")
        monkeypatch.setattr("paneldraw.simulator.views.PORT", port)
        with open_panel("sim://ssd1306?view=web"):
            assert f":{port}" not in page_of(capfd)
    assert ours() == []


def test_an_error_ends_the_view(capfd):
    with pytest.raises(ZeroDivisionError), open_panel("sim://ssd1306?view=web,terminal"):
        raise ZeroDivisionError
    assert ours() == []


def test_a_panel_that_nobody_has_any_more_is_watched_no_more(tmp_path, capfd):
    panel = open_panel(f"sim://ssd1306?view=web&save={tmp_path / 'out.png'}")
    panel.show(noise(panel))
    del panel
    gc.collect()
    assert ours() == []
    assert (tmp_path / "out.png").exists()


def test_words_go_to_the_page(capfd):
    with open_panel("sim://ssd1306?view=web,terminal") as panel:
        watching.describe(panel, "21 °C")
        server = watching._shared["web"].view
        assert [each.sight.label for each in server._panels] == ["21 °C"]


# -- Scripts


SCRIPT = """
    import os, signal, sys, time
    import numpy as np
    from paneldraw import open_panel

    panel = open_panel()
    panel.show(np.eye(64, 128, dtype=np.uint8))
"""

ENDS = {
    "end": ("", 0),
    "with": ("with panel: pass", 0),
    "exception": ("raise RuntimeError('so it ends')", 1),
    "SIGINT": ("signal.signal(signal.SIGINT, signal.default_int_handler); signal.raise_signal(signal.SIGINT)", -2),
    "SIGTERM": ("signal.raise_signal(signal.SIGTERM)", -15),
    "forgotten": ("del panel", 0),
    "child": ("pid = os.fork(); pid and os.waitpid(pid, 0); sys.exit(0)", 0),
}


def script(end="", first=""):
    return f"{first}\n{textwrap.dedent(SCRIPT)}{end}\n"


@posix
@pytest.mark.parametrize("end", quick(ENDS, ("end", "exception", "SIGTERM", "child")))
def test_however_a_script_ends_its_views_end_too(tmp_path, end):
    code, status = ENDS[end]
    path = tmp_path / "out.png"
    environment = os.environ | {"PANELDRAW_PANEL": f"sim://ssd1306?view=terminal,web&save={path}"}
    done = subprocess.run(
        [sys.executable, "-W", "ignore", "-c", script(code)], env=environment, capture_output=True, timeout=60
    )
    assert done.returncode == status, done.stderr
    with Image.open(path) as image:
        assert np.array_equal(np.asarray(image.convert("L"))[4:-4:4, 4:-4:4] > 128, np.eye(64, 128, dtype=bool))
    text = done.stdout.decode()
    assert text.count("┌") == 1
    assert "1 frame, " in text
    assert ("RuntimeError" in done.stderr.decode()) == (end == "exception")


@posix
@pytest.mark.parametrize("end", quick(("end", "exception", "SIGINT", "SIGTERM"), ("exception", "SIGTERM")))
def test_a_terminal_is_left_in_order(end):
    from simulator.terminals import Terminal, in_order

    environment = os.environ | {"PANELDRAW_PANEL": "sim://ssd1306?view=terminal", "TERM": "xterm"}
    with Terminal(140, 50) as terminal:
        print_and = "print('\\nnow'); time.sleep(0.1)\n"
        command = [sys.executable, "-c", script(print_and + ENDS[end][0])]
        ends = {"stdin": terminal.fd, "stdout": terminal.fd, "stderr": terminal.fd}
        subprocess.run(command, env=environment, timeout=60, **ends)
        lines = terminal.lines()
        assert in_order(terminal)
    assert lines[-1] == ""
    assert lines[-2] == "ssd1306 128x64, sim://ssd1306: 1 frame, 1104 bytes on the wire"
    assert lines[-3] == "└" + "─" * 128 + "┘"
    assert lines[-36] == "┌" + "─" * 128 + "┐"
    above = "\n".join(lines[:-36])
    assert "now" in above
    assert ("Traceback" in above) == (end in ("exception", "SIGINT"))


@posix
@pytest.mark.parametrize(
    ("environment", "said"),
    [
        ({}, True),
        ({"PANELDRAW_PANEL": "sim://ssd1306"}, False),
        pytest.param({"PANELDRAW_VIEW": "terminal"}, False, marks=pytest.mark.thorough),
    ],
)
def test_a_person_at_a_terminal_is_told_once_how_to_see_the_panel(environment, said):
    from simulator.terminals import Terminal

    clean = {name: value for name, value in os.environ.items() if not name.startswith("PANELDRAW")}
    with Terminal(120, 40) as terminal:
        code = "from paneldraw import open_panel\nopen_panel(); open_panel()"
        options = {"env": clean | environment, "stdout": subprocess.DEVNULL, "timeout": 60}
        subprocess.run([sys.executable, "-c", code], stderr=terminal.fd, **options)
        lines = "\n".join(terminal.lines())
    assert lines.count("PANELDRAW_PANEL is not set") == said
    assert lines.count("view=terminal'") == said
    piped = subprocess.run([sys.executable, "-c", code], stderr=subprocess.PIPE, **options)
    assert piped.stderr == b""


@posix
@pytest.mark.parametrize(
    ("end", "number"),
    [
        ("", signal.SIGINT),
        ("panel.close()", signal.SIGTERM),
        pytest.param("panel.close()", signal.SIGINT, marks=pytest.mark.thorough),
        pytest.param("", signal.SIGTERM, marks=pytest.mark.thorough),
    ],
)
def test_a_page_waits_for_its_first_browser_where_a_person_can_open_one(end, number):
    from simulator.terminals import Terminal

    environment = os.environ | {"PANELDRAW_PANEL": "sim://ssd1306?view=web"}
    with Terminal(120, 40) as terminal:
        child = subprocess.Popen([sys.executable, "-c", script(end)], env=environment, stderr=terminal.fd)
        lines = terminal.wait_for("the last picture waits there for a browser")
        url = next(line for line in lines if "watch at" in line).rpartition(" ")[2]
        assert answers(url)
        child.send_signal(number)
        assert child.wait(30) == (0 if number == signal.SIGINT else -number)
        assert not answers(url)
