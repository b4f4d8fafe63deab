"""``paneldraw firmware``, run as a process on a pseudo-terminal with the reference device behind it."""

from __future__ import annotations

import re
from dataclasses import replace
from types import SimpleNamespace

import pytest
from far_ends import Board, EmulatedBoard, serial
from running import assert_one_line_of_advice

from firmware_protocol.device import UNO
from paneldraw import simulator
from paneldraw.cli import diagnostics, firmware, main


@pytest.fixture
def board(tmp_path):
    board = Board(tmp_path / "ttyBOARD", panel=lambda content: None)
    yield board
    board.pull_out()


def test_info(run, board):
    done = run("firmware", "info", board.path)
    assert done.returncode == 0, done.stderr
    said = dict(line.split(":", 1) for line in done.stdout.splitlines())
    assert "at 500000 baud; it offers 500000, 1000000, 250000, 115200" in said["port"]
    assert said["firmware"].strip() == UNO.firmware
    assert said["panel"].strip() == "ssd1306 128x64 on I2C at 0x3C, answers"
    assert said["protocol"].strip() == "version 1; it speaks 1 to 1"
    assert said["last start"].strip() == "power on"
    assert said["line"].strip() == "0 damaged frames, 0 overflows, 0 line errors"


def test_info_of_a_board_without_a_panel(run, tmp_path):
    def nobody(content):
        raise OSError(121, "Remote I/O error")

    board = Board(tmp_path / "ttyBOARD", panel=nobody, profile=replace(UNO, controller="", width=0, height=0))
    done = run("firmware", "info", f"serial://{board.path}?baudrate=250000")
    assert "a chip it does not know on I2C at 0x3C, does not answer: check its wiring" in done.stdout
    assert "at 250000 baud" in done.stdout
    board.pull_out()


def test_ping(run, board):
    done = run("firmware", "ping", board.path, "--count", 7, "--baudrate", 115200)
    assert done.returncode == 0, done.stderr
    found = re.fullmatch(
        r".*ttyBOARD at 115200 baud: 7 round trips, least (\S+) ms, median (\S+), mean (\S+), most (\S+)\n", done.stdout
    )
    least, middle, average, most = map(float, found.groups())
    assert 0 < least <= middle <= most
    assert least <= average <= most


def test_monitor(run, board):
    board.device.line_error()
    done = run("firmware", "monitor", board.path, "--seconds", 0.5, "--interval", 0.2)
    assert done.returncode == 0, done.stderr
    head, *rows = done.stdout.splitlines()
    assert re.split(r" {2,}", head)[2:5] == ["damaged", "overflows", "line errors"]
    assert rows
    for row in rows:  # what was sent again and came late depends on how busy this machine is
        assert row.split()[2:5] == ["0", "0", "1"]
        assert row.split()[-1] == "none"


def test_the_firmware_on_the_emulated_chip(run, tmp_path, binaries):
    board = EmulatedBoard(binaries, tmp_path / "ttyBOARD")
    said = dict(line.split(":", 1) for line in run("firmware", "info", board.path).stdout.splitlines())
    assert said["firmware"].strip() == "paneldraw-atmega328p 1.0"
    assert said["panel"].strip() == "ssd1306 128x64 on I2C at 0x3C, answers"
    assert (
        "at 115200 baud: 5 round trips"
        in run("firmware", "ping", board.path, "--count", 5, "--baudrate", 115200).stdout
    )
    rows = run("firmware", "monitor", board.path, "--seconds", 0.3, "--interval", 0.2).stdout.splitlines()
    assert {row.split()[-1] for row in rows[1:]} == {"none"}
    board.pull_out()


def test_monitor_sees_a_restart(board, capsys, monkeypatch):
    pauses = []

    def pause(seconds):
        pauses.append(seconds)
        if len(pauses) == 1:
            board.say(board.device.reset(8))

    monkeypatch.setattr(firmware, "time", SimpleNamespace(monotonic=lambda: sum(pauses), sleep=pause))
    assert main(["firmware", "monitor", str(board.path), "--seconds", "1.5", "--interval", "0.5"]) == 0
    assert pauses == [0.5, 0.5, 0.5]
    _, first, second, *others = capsys.readouterr().out.splitlines()
    assert "has restarted (watchdog)" in second
    assert [row.split()[-1] for row in (first, *others)] == ["none"] * 3


def test_ports(run, monkeypatch, capsys):
    assert main(["firmware", "ports"]) == 0
    assert capsys.readouterr().out.splitlines() == (diagnostics.serial_ports() or ["no serial port; plug a board in"])
    assert_one_line_of_advice(run("firmware"), 2)


def test_the_port_of_the_environment(run, board):
    done = run("firmware", "ping", "--count", 1, PANELDRAW_PANEL=f"serial://{board.path}?baudrate=250000")
    assert "ttyBOARD at 250000 baud: 1 round trips" in done.stdout


@pytest.mark.parametrize(("query", "lit"), [("", False), ("?on_close=clear", False), ("?on_close=keep", True)])
def test_a_demo_leaves_a_real_panel_black_unless_the_url_says_otherwise(run, tmp_path, query, lit):
    board = Board(tmp_path / "ttyBOARD", panel=simulator.SSD1306().write)
    done = run("demo", "cube", "--frames", 3, "--panel", f"serial://{board.path}{query}")
    assert done.returncode == 0, done.stderr
    assert board.panel.__self__.pixels.any() == lit
    board.pull_out()


@pytest.mark.parametrize(
    ("there", "said"),
    [
        ([], "there is no serial port here; plug a board in"),
        (["/dev/ttyA (a)", "/dev/ttyB (b)"], "say which port: /dev/ttyA, /dev/ttyB"),
        (["/dev/ttyNONE (a)"], "there is no port /dev/ttyNONE"),
    ],
)
def test_no_port_said(there, said, monkeypatch, capsys):
    monkeypatch.setattr(diagnostics, "serial_ports", lambda: there)
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    assert main(["firmware", "info"]) == 1
    assert said in capsys.readouterr().err


@pytest.mark.parametrize("action", ["info", "monitor", "ping"])
def test_errors_are_one_line(run, action, board, tmp_path):
    assert_one_line_of_advice(run("firmware", action, tmp_path / "nothing"), 1)
    with serial.Serial(str(board.path), exclusive=True):
        done = run("firmware", action, board.path)
    assert_one_line_of_advice(done, 1)
    assert "in use" in done.stderr


def test_wrong_usage(run):
    assert_one_line_of_advice(run("firmware", "ping", "/dev/null", "--count", 0), 2)
    assert_one_line_of_advice(run("firmware", "info", "nonsense://1"), 1)
