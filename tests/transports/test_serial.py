"""A panel over real pyserial: a pseudo-terminal or a socket, the reference device and the simulated chip behind it."""

from __future__ import annotations

import contextlib
import errno
import os
import threading
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from far_ends import Board, EmulatedBoard, Server, pty, serial, tty
from hypothesis import given
from hypothesis import strategies as st
from searching import examples
from simulated import Noise, SimulatedPort

from firmware_protocol.device import UNO
from firmware_protocol.messages import Ack, encode
from paneldraw import Panel, open_panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelError,
    PanelNotFoundError,
    PanelPermissionError,
    PanelTimeoutError,
    ProtocolError,
    TransportError,
)
from paneldraw.transports import SerialTransport

NOISE = np.random.default_rng(1).integers(0, 2, (64, 128), np.uint8)
INVERSE = 1 - NOISE


@pytest.fixture
def path(tmp_path):
    return tmp_path / "ttyBOARD"


@pytest.fixture
def chip():
    return simulator.SSD1306(128, 64)


#: What links are opened with: a clock, where the board has one of its own.
CLOCK = {}


@pytest.fixture(params=["reference", "emulated"])
def board(request, path, chip, monkeypatch):
    """A board with a panel behind a port: the reference device, or the firmware on the emulated chip."""
    if request.param == "reference":
        board = Board(path, panel=chip.write)
    else:
        board = EmulatedBoard(request.getfixturevalue("binaries"), path, chip.write)
        monkeypatch.setitem(CLOCK, "clock", board.seconds)
    yield board
    board.pull_out()


def opened(path, *arguments):
    return Panel(SSD1306(128, 64), SerialTransport(str(path), *arguments, **CLOCK))


@contextlib.contextmanager
def far_end(path, talk):
    """A pseudo-terminal that hangs at ``path``, and something that talks on its far end until it is over."""
    far, near = pty.openpty()
    tty.setraw(near)
    path.symlink_to(os.ttyname(near))
    over = threading.Event()
    thread = threading.Thread(target=talk, args=(far, over))
    thread.start()
    yield
    over.set()
    thread.join()
    os.close(far)
    os.close(near)


def handles():
    return len(os.listdir("/proc/self/fd")) if Path("/proc/self/fd").exists() else 0


# Pictures


@pytest.mark.parametrize("noise", [Noise(), Noise(0.001, 0.001, 0.001)], ids=["clean", "noisy"])
@pytest.mark.parametrize("baudrate", [None, 115_200])
def test_pictures_arrive(path, chip, noise, baudrate):
    board = Board(path, noise, chip.write)
    pick = np.random.default_rng(3)
    with opened(path, baudrate) as panel:
        for density in (0.5, 0.02, 0.001, 0.3, 0.9, 0.0):
            picture = (pick.random((64, 128)) < density).astype(np.uint8)
            panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []
    board.pull_out()


def test_a_picture_that_is_there_already_sends_nothing(path, board):
    with opened(path) as panel:
        panel.show(NOISE)
        taken = board.taken
        assert panel.show(NOISE).unchanged
        assert board.taken == taken


def part(draw):
    """A rectangle of the panel and what fills it: noise of some density, or one level."""
    left, top = draw(st.integers(0, 127)), draw(st.integers(0, 63))
    right, bottom = draw(st.integers(left + 1, 128)), draw(st.integers(top + 1, 64))
    return slice(top, bottom), slice(left, right), draw(st.sampled_from((0.0, 0.01, 0.5, 1.0)))


WHOLE = (slice(None), slice(None), 0.5)
SETTINGS = ("invert", "sleep", "wake", "contrast")
BEFORE = st.one_of(st.just(WHOLE), st.composite(part)(), st.sampled_from(SETTINGS))


@examples(3)
@given(st.lists(st.tuples(BEFORE, st.integers(0, 127), st.integers(0, 63)), max_size=6), st.integers(0, 99))
def test_a_pixel_is_thirteen_bytes_at_most_after_anything(steps, seed):
    port, chip, pick = SimulatedPort(), simulator.SSD1306(128, 64), np.random.default_rng(seed)
    port.panel = chip.write
    picture = NOISE.copy()
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        panel.show(picture)
        for before, x, y in [(WHOLE, 127, 63), *steps]:
            if before in SETTINGS:
                getattr(panel, before)(*[7] * (before == "contrast"))
            else:
                rows, columns, density = before
                picture[rows, columns] = pick.random(picture[rows, columns].shape) < density
                panel.show(picture)
            picture[y, x] ^= 1
            carried = port.carried
            sent = panel.show(picture).wire_bytes
            assert sent <= 13
            assert port.carried - carried == sent + len(encode(Ack(0)))
        panel.wake()
        panel.invert(False)
        np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_what_repeats_is_packed(path, board, chip):
    with opened(path) as panel:
        panel.show(NOISE)
        assert panel.show(np.ones((64, 128), np.uint8)).wire_bytes < 100
        assert chip.pixels.all()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")  # pyserial's own
@pytest.mark.parametrize("telnet", [False, True], ids=["socket", "rfc2217"])
def test_pyserials_own_urls(chip, telnet):
    server = Server(telnet, chip.write)
    with opened(server.url) as panel:
        panel.show(NOISE)
        np.testing.assert_array_equal(chip.pixels, NOISE)
        if not telnet:
            server.drop()
            with pytest.raises(PanelDisconnectedError):
                panel.show(INVERSE)
            panel.show(INVERSE)
            np.testing.assert_array_equal(chip.pixels, INVERSE)
    server.close()


def test_a_port_of_the_callers(chip):
    port = SimulatedPort()
    port.panel = chip.write
    transport = SerialTransport(port, 250_000, clock=port.clock)
    assert (transport.baudrate, transport.device.width, transport.name) == (250_000, 128, "simulated")
    with Panel(SSD1306(128, 64), transport) as panel:
        panel.show(NOISE)
        np.testing.assert_array_equal(chip.pixels, NOISE)
    assert not port.is_open
    with pytest.raises(TransportError, match="closed"):
        transport.command(b"\xaf")


def test_a_url_opens_what_the_board_says_it_has(path, monkeypatch):
    small = simulator.SSD1306(96, 16)
    board = Board(path, panel=small.write, profile=replace(UNO, width=96, height=16))
    url = f"serial://{path}?baudrate=250000&rotate=180"
    with open_panel(url) as panel:
        assert (panel.width, panel.height, panel.transport.baudrate) == (96, 16, 250_000)
        panel.show(NOISE[:16, :96])
        np.testing.assert_array_equal(small.pixels, NOISE[:16, :96][::-1, ::-1])
    monkeypatch.setenv("PANELDRAW_PANEL", f"serial://{path}?rotate=90")
    with open_panel() as panel:
        assert (panel.width, panel.height) == (16, 96)
    board.pull_out()


@pytest.mark.parametrize("scheme", ["", "serial://"])
def test_a_url_of_pyserials(chip, scheme):
    server = Server(False, chip.write)
    with open_panel(f"{scheme}{server.url}?rotate=180") as panel:
        panel.show(NOISE)
        np.testing.assert_array_equal(chip.pixels, NOISE[::-1, ::-1])
    server.close()


def test_a_url_that_fails_leaves_the_port_free(path):
    board = Board(path, profile=replace(UNO, controller="ssd9999"))
    before = handles()
    for url, kind in (("", ProtocolError), ("?chip=ssd1306&rotate=45", ValueError)):
        with pytest.raises(kind):
            open_panel(f"serial://{path}{url}")
    assert handles() == before
    board.pull_out()


# Faults on the way


def test_unplugged_and_plugged_in_again(path, board, chip):
    with opened(path) as panel:
        panel.show(NOISE)
        board.pull_out()
        for _ in range(2):
            with pytest.raises(PanelDisconnectedError, match="plug the board in"):
                panel.show(INVERSE)
        chip.power_cycle()
        board.plug_in()
        panel.show(INVERSE)
        np.testing.assert_array_equal(chip.pixels, INVERSE)
    assert chip.violations == []


def test_plugged_in_again_where_another_program_took_the_port(path, board, chip):
    with opened(path) as panel:
        board.pull_out()
        with pytest.raises(PanelDisconnectedError):
            panel.show(NOISE)
        board.plug_in()
        with serial.Serial(str(path), exclusive=True), pytest.raises(PanelBusyError, match="in use"):
            panel.show(NOISE)
        panel.show(NOISE)
        np.testing.assert_array_equal(chip.pixels, NOISE)


@pytest.mark.parametrize("after", [1, 3, 6])
def test_a_restart_in_the_middle_of_a_picture(path, chip, after):
    left = after

    def write(content):
        nonlocal left
        left -= bool(content)
        if content and left == 0:
            chip.power_cycle()
            board.reset_due = True
        else:
            chip.write(content)

    board = Board(path, panel=chip.write)
    with opened(path) as panel:
        panel.show(NOISE)
        board.panel = write
        panel.show(INVERSE)
        np.testing.assert_array_equal(chip.pixels, INVERSE)
        assert panel.stats.retries == 1
    assert chip.violations == []
    board.pull_out()


def test_a_panel_that_is_missing_or_vanishes(path, board, chip):
    board.trouble = "absent"
    with pytest.raises(PanelNotFoundError, match="no panel answers at 0x3c"):
        opened(path)
    board.trouble = ""
    with opened(path) as panel:
        panel.show(NOISE)
        board.trouble = "absent"
        with pytest.raises(PanelDisconnectedError, match="no panel answers at 0x3c"):
            panel.show(INVERSE)
        chip.power_cycle()
        board.trouble = ""
        panel.show(INVERSE)
        np.testing.assert_array_equal(chip.pixels, INVERSE)


def test_a_stuck_bus(path, board, chip):
    with opened(path) as panel:
        board.trouble = "stuck"
        with pytest.raises(PanelTimeoutError, match="pull-up"):
            panel.show(NOISE)
        board.trouble = ""
        panel.show(NOISE)
        np.testing.assert_array_equal(chip.pixels, NOISE)


# Ports that will not do


@pytest.mark.parametrize(("version", "advice"), [(0, "the board's firmware"), (9, "update paneldraw")])
def test_another_version(path, version, advice):
    board = Board(path, profile=replace(UNO, oldest=version, newest=version))
    before = handles()
    with pytest.raises(ProtocolError, match=advice):
        SerialTransport(str(path))
    assert handles() == before
    board.pull_out()


def test_a_gps(path):
    def talk(far, over):
        while not over.wait(0.02):
            os.write(far, b"$GPGGA,123519,4807.038,N,01131.000,E,1,08,0.9,545.4,M,46.9,M,,*47\r\n")

    with far_end(path, talk):
        before = handles()
        with pytest.raises(PanelNotFoundError, match="paneldraw's firmware at 115200 baud: check the port") as caught:
            SerialTransport(str(path), timeout=0.6)
        assert str(path) in str(caught.value)
        assert handles() == before


def test_a_silent_port(path):
    with far_end(path, lambda far, over: over.wait()), pytest.raises(PanelNotFoundError, match="nothing answers"):
        SerialTransport(str(path), timeout=0.6)


def test_a_board_that_listens_at_another_rate(path):
    board = Board(path, lambda data, rng: bytes(byte * 37 + 11 & 0xFF for byte in data))
    with pytest.raises(PanelNotFoundError, match="at 115200 baud: check the port"):
        SerialTransport(str(path), timeout=0.6)
    board.pull_out()


def test_a_rate_that_the_board_does_not_offer(path, board):
    with pytest.raises(TransportError, match="does not offer 57600 baud; it offers 500000"):
        SerialTransport(str(path), 57_600)


def test_a_rate_that_the_adapter_cannot_do(chip):
    class Slow(SimulatedPort):
        def __setattr__(self, name, value):
            if name == "baudrate" and value > 115_200:
                raise ValueError("no such rate")
            super().__setattr__(name, value)

    port = Slow()
    port.panel = chip.write
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        assert panel.transport.baudrate == 115_200
        panel.show(NOISE)
        np.testing.assert_array_equal(chip.pixels, NOISE)


def test_a_busy_port(path, board):
    with serial.Serial(str(path), exclusive=True), pytest.raises(PanelBusyError, match="close the other program"):
        SerialTransport(str(path))
    with opened(path), pytest.raises(PanelBusyError):
        SerialTransport(str(path))


@pytest.mark.parametrize(
    ("code", "kind", "advice"),
    [
        (errno.EACCES, PanelPermissionError, r"add the user to group \w+ \(`sudo usermod -aG"),
        (errno.EPERM, PanelPermissionError, "log in again"),
        (errno.EBUSY, PanelBusyError, "in use"),
        (errno.ENXIO, PanelNotFoundError, "plug the board in"),
        (errno.EIO, TransportError, "plug the board"),
    ],
)
def test_what_the_system_says(path, board, monkeypatch, code, kind, advice):
    """The system's own call refuses: the tests' user may be one whom it refuses nothing."""
    system = os.open

    def refusing(name, *arguments, **keywords):
        if name == str(path):
            raise OSError(code, os.strerror(code), name)
        return system(name, *arguments, **keywords)

    monkeypatch.setattr(os, "open", refusing)
    with pytest.raises(kind, match=advice) as caught:
        SerialTransport(str(path))
    assert caught.value.errno == code
    assert str(path) in str(caught.value)


def test_what_is_no_port(tmp_path, path):
    with pytest.raises(PanelNotFoundError, match=r"there is no port .*: plug the board in"):
        SerialTransport(path)
    path.write_text("a file")
    for name in (path, tmp_path):
        with pytest.raises(PanelNotFoundError, match="no serial port"):
            SerialTransport(name)
    with pytest.raises(PanelNotFoundError, match="check the address"):
        SerialTransport("socket://127.0.0.1:1")
    with pytest.raises(PanelNotFoundError, match="loop-back"):
        SerialTransport("loop://", timeout=0.6)


@pytest.mark.parametrize("port", [None, 3, b"/dev/ttyACM0", object()])
def test_ports_of_a_wrong_type(port):
    with pytest.raises(TypeError, match="port must be"):
        SerialTransport(port)


def test_wrong_arguments():
    with pytest.raises(ValueError, match=r"port must be .* not 'nonsense://1'"):
        SerialTransport("nonsense://1")
    for baudrate in ("115200", 1.5, True):
        with pytest.raises(TypeError, match="baudrate must be an int"):
            SerialTransport("/dev/null", baudrate)
    for baudrate in (0, -1):
        with pytest.raises(ValueError, match="baudrate must be above 0"):
            SerialTransport("/dev/null", baudrate)


def test_errors_are_the_packages_own():
    assert issubclass(ProtocolError, PanelError)
