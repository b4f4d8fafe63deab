"""Real pyserial over a real pseudo-terminal, the reference device on its far end."""

from __future__ import annotations

import errno
import os
import random
import threading
from pathlib import Path

import pytest
from far_ends import Board, serial
from simulated import Noise, whole

from firmware_protocol import (
    DeviceResetError,
    HostLink,
    LinkLostError,
    NoDeviceError,
    PanelFaultError,
    SMBusWriter,
)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "ttyBOARD"


def opened(path: Path) -> serial.Serial:
    return serial.Serial(str(path), 115200, exclusive=True)


@pytest.mark.parametrize("noise", [Noise(), Noise(0.001, 0.001, 0.001)], ids=["clean", "noisy"])
@pytest.mark.parametrize("baudrate", [None, 115200])
def test_pictures_arrive(path: Path, noise: Noise, baudrate: int | None) -> None:
    board = Board(path, noise)
    rng = random.Random(1)
    with HostLink(opened(path), baudrate=baudrate) as link:
        for _ in range(5):
            picture = rng.randbytes(1024)
            link.write(whole(picture))
            assert board.panel.ram == picture
    board.pull_out()


def test_pulled_out_and_put_back_under_the_same_name(path: Path) -> None:
    board = Board(path)
    link = HostLink(opened(path))
    link.write([(True, b"\1")])
    board.pull_out()
    for _ in range(2):
        with pytest.raises(LinkLostError, match="ttyBOARD"):
            link.write([(True, b"\2")])
    board.plug_in()
    picture = bytes(range(256)) * 4
    link.write(whole(picture))
    assert board.panel.ram == picture
    assert link.stats.sessions == 2
    link.close()
    board.pull_out()


def test_a_reset_in_the_middle(path: Path) -> None:
    board = Board(path)
    with HostLink(opened(path), baudrate=115200) as link:
        board.say(board.device.reset(2))
        with pytest.raises(DeviceResetError, match="reset pin"):
            link.write([(True, b"\1")])
        link.write([(True, b"\1")])
    board.pull_out()


def test_the_panel_vanishes_behind_the_board(path: Path) -> None:
    board = Board(path)
    with HostLink(opened(path)) as link:
        board.panel.gone = True
        with pytest.raises(PanelFaultError, match="no panel answers"):
            link.write([(True, b"\1")])
        board.panel.gone = False
        link.write([(True, b"\1")])
    board.pull_out()


def test_close_leaves_nothing_behind(path: Path) -> None:
    board = Board(path)
    before = set(threading.enumerate())
    handles = len(os.listdir("/proc/self/fd")) if Path("/proc/self/fd").exists() else None
    link = HostLink(opened(path))
    link.write([(True, b"\1")])
    link.close()
    link.close()
    assert set(threading.enumerate()) == before
    if handles is not None:
        assert len(os.listdir("/proc/self/fd")) == handles
    board.pull_out()


def test_pyserials_own_loop_back_is_no_board() -> None:
    port = serial.serial_for_url("loop://", baudrate=115200)
    with pytest.raises(NoDeviceError, match="loop-back"):
        HostLink(port, timeout=0.6)
    port.close()


def test_the_reference_device_writes_to_smbus2_like_buses() -> None:
    class Bus:
        def __init__(self) -> None:
            self.seen: list[tuple[int, bytes]] = []

        def i2c_rdwr(self, *messages: object) -> None:
            if self.seen and self.seen[-1][1][1:] == b"\xae":
                raise OSError(errno.EREMOTEIO, "Remote I/O error")
            self.seen += [(m.addr, bytes(m)) for m in messages]

    bus = Bus()
    write = SMBusWriter(bus, 0x3D)
    write(b"\x00\xae")
    assert bus.seen == [(0x3D, b"\x00\xae")]
    with pytest.raises(OSError, match="Remote"):
        write(b"\x00")
