"""``paneldraw firmware flash`` and ``sources``: what avrdude is asked, and that the ready files are the sources'."""

from __future__ import annotations

import errno
import os
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from c_core import made
from running import assert_one_line_of_advice

import firmware_protocol
from paneldraw.cli import flashing, main
from paneldraw.transports import serial as transport

PROTOCOL = Path(firmware_protocol.__file__).parent
READY = sorted(flashing.READY.glob("*.hex"))

#: Other compilers write other code for the same sources.
COMPILER = "5.4.0"

AVRDUDE = """#!/bin/sh
for word; do echo "$word"; done > "$0.asked"
exit {code}
"""


@pytest.fixture
def avrdude(tmp_path, monkeypatch):
    """A folder on PATH, the only one, where an avrdude that ends with a code can be put; and what it was asked."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))

    def put(code=0):
        file = folder / "avrdude"
        file.write_text(AVRDUDE.format(code=code))
        file.chmod(0o755)
        return file.with_name("avrdude.asked")

    return put


@pytest.fixture
def port():
    pty = pytest.importorskip("pty")
    ends = pty.openpty()
    yield os.ttyname(ends[1])
    for end in ends:
        os.close(end)


@pytest.mark.skipif(sys.platform == "win32", reason="the stand-in is a shell script")
@pytest.mark.parametrize(
    ("options", "file", "baud"),
    [
        ([], "atmega328p-i2c-3c.hex", 115200),
        (["--panel-on", "i2c-3d", "--board", "nano"], "atmega328p-i2c-3d.hex", 115200),
        (["--panel-on", "spi", "--board", "old-nano"], "atmega328p-spi.hex", 57600),
    ],
)
def test_flash_asks_avrdude(avrdude, port, capfd, options, file, baud):
    asked = avrdude()
    assert main(["firmware", "flash", port, *options]) == 0
    words = asked.read_text().splitlines()
    ready = PROTOCOL / "firmware" / "hex" / file
    expected = ["-c", "arduino", "-p", "m328p", "-P", port, "-b", str(baud), "-D", "-U", f"flash:w:{ready}:i"]
    assert words == expected
    command, after = capfd.readouterr().out.splitlines()
    assert shlex.split(command) == ["avrdude", *expected]
    assert after == f"flashed; who answers: paneldraw firmware info {port}"


def test_a_dry_run_runs_nothing(avrdude, capsys, tmp_path):
    own = tmp_path / "own.hex"
    own.write_text(":00000001FF\n")
    asked = avrdude()
    assert main(["firmware", "flash", "/dev/ttyNONE", "--file", str(own), "--dry-run"]) == 0
    assert not asked.exists()
    assert shlex.split(capsys.readouterr().out)[-1] == f"flash:w:{own}:i"


def said(capsys, *arguments):
    assert main(["firmware", *map(str, arguments)]) == 1
    text = capsys.readouterr().err
    assert text.startswith("paneldraw: ")
    assert text.count("\n") == 1
    return text


@pytest.mark.usefixtures("avrdude")
def test_without_avrdude_it_says_how_to_get_it(capsys):
    assert "sudo apt install avrdude" in said(capsys, "flash", "/dev/ttyNONE")


@pytest.mark.skipif(sys.platform == "win32", reason="the stand-in is a shell script")
def test_what_can_be_wrong_is_said_in_one_line(avrdude, port, capsys, tmp_path, monkeypatch):
    avrdude(code=1)
    assert "avrdude ended with 1; check the board and its cable, or try --board old-nano" in said(capsys, "flash", port)
    assert "there is no port /dev/ttyNONE: plug the board in" in said(capsys, "flash", "/dev/ttyNONE")
    assert "not on socket://board:7777" in said(capsys, "flash", "socket://board:7777")
    assert f"there is no file {tmp_path / 'none.hex'}" in said(capsys, "flash", port, "--file", tmp_path / "none.hex")

    def denied(name, *_, **__):
        raise PermissionError(errno.EACCES, "Permission denied", name)

    monkeypatch.setattr("serial.serial_for_url", denied)
    text = said(capsys, "flash", port)
    assert f"no permission to open {port}: {transport.join_group(transport._group(port))}" in text


def test_sources_are_whole_and_only_go_into_a_new_folder(capsys, tmp_path):
    folder = tmp_path / "mine"
    assert main(["firmware", "sources", str(folder)]) == 0
    assert f"make -C {folder / 'firmware'} atmega328p" in capsys.readouterr().out
    copied = {file.relative_to(folder): file.read_bytes() for file in folder.rglob("*") if file.is_file()}
    kinds = {".c", ".h", ".ld", ".md", ".hex", ".txt", ""}
    own = {
        file.relative_to(PROTOCOL): file.read_bytes()
        for file in PROTOCOL.rglob("*")
        if file.is_file() and file.suffix in kinds and "build" not in file.parts
    }
    assert copied == own
    assert {Path("PROTOCOL.md"), Path("firmware/Makefile"), Path("firmware/core/link.c")} <= copied.keys()
    assert "name a new folder" in said(capsys, "sources", folder)


def test_usage(run):
    assert_one_line_of_advice(run("firmware", "flash", "--board", "mega"), 2)
    assert_one_line_of_advice(run("firmware", "sources"), 2)


@pytest.mark.parametrize("file", READY, ids=lambda file: file.stem)
def test_a_ready_file_fits_below_the_boot_loader(file):
    """Each record adds up to 0, the last one is the end, and all that is written is within 31.5 KB."""
    records = [bytes.fromhex(line.removeprefix(":")) for line in file.read_text().splitlines()]
    assert all(sum(record) % 256 == 0 and record[0] == len(record) - 5 for record in records)
    assert records[-1] == bytes.fromhex("00000001FF")
    ends = [int.from_bytes(record[1:3], "big") + record[0] for record in records if record[3] == 0]
    assert 4000 < max(ends) < 32256


def test_the_ready_files_are_what_the_sources_make(tmp_path):
    version = shutil.which("avr-gcc") and subprocess.run(["avr-gcc", "-dumpversion"], capture_output=True, text=True)
    if not version or version.stdout.strip() != COMPILER:
        pytest.skip(f"avr-gcc {COMPILER} is not installed")
    folder = made("hex", "", tmp_path / "build", "avr-gcc", READY=str(tmp_path / "ready")).parent / "ready"
    assert [file.name for file in READY] == ["atmega328p-i2c-3c.hex", "atmega328p-i2c-3d.hex", "atmega328p-spi.hex"]
    assert {file.name: file.read_bytes() for file in folder.iterdir()} == {
        file.name: file.read_bytes() for file in READY
    }
