"""The firmware on a Cortex-M3 that QEMU emulates, looked at through QEMU's own panel: an eye that is not ours."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from c_core import made

from firmware_protocol import HostLink

serial = pytest.importorskip("serial", reason="pyserial is not installed")
WIDTH, HEIGHT, OFFSET, MAGNIFIED = 96, 16, 36, 4


class Machine:
    """QEMU with the firmware; its serial line hangs on a pseudo-terminal, its monitor on its standard streams."""

    def __init__(self, elf: Path) -> None:
        joints = ["-display", "none", "-serial", "pty", "-qmp", "stdio"]
        self.process = subprocess.Popen(
            ["qemu-system-arm", "-M", "lm3s811evb", "-kernel", str(elf), *joints],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.port = ""
        while not self.port:
            line = self.read()
            if found := re.search(r"/dev/\S+", line):
                self.port = found.group()
        self.ask("qmp_capabilities")

    def read(self) -> str:
        assert self.process.stdout is not None
        line = self.process.stdout.readline()
        assert line, "QEMU has ended"
        return line

    def ask(self, command: str, **arguments: str) -> None:
        assert self.process.stdin is not None
        self.process.stdin.write(json.dumps({"execute": command, "arguments": arguments}) + "\n")
        self.process.stdin.flush()
        while True:
            line = self.read()
            if line.startswith("{") and "return" in (answer := json.loads(line)):
                return
            assert "error" not in line, answer

    def screen(self, file: Path) -> np.ndarray:
        """Return what the panel shows, as (HEIGHT, WIDTH) of 0 and 1."""
        self.ask("screendump", filename=str(file))
        head, size, _, pixels = re.fullmatch(rb"(P6)\s+(\d+ \d+)\s+(255)\s(.*)", file.read_bytes(), re.DOTALL).groups()
        width, height = map(int, size.split())
        assert (head, width, height) == (b"P6", WIDTH * MAGNIFIED, HEIGHT * MAGNIFIED)
        seen = np.frombuffer(pixels, np.uint8).reshape(height, width, 3)
        return (seen[::MAGNIFIED, ::MAGNIFIED, 0] > 127).astype(np.uint8)

    def close(self) -> None:
        self.process.terminate()
        self.process.communicate(timeout=10)


@pytest.fixture
def machine(tmp_path: Path) -> Iterator[Machine]:
    if not shutil.which("qemu-system-arm"):
        pytest.skip("qemu-system-arm is not installed")
    machine = Machine(made("lm3s811", "lm3s811/paneldraw.elf", tmp_path / "build", "arm-none-eabi-gcc"))
    yield machine
    machine.close()


def runs(picture: np.ndarray) -> list[tuple[bool, bytes]]:
    """Return the runs that show a picture of 0 and 1 on the SSD0303."""
    packed = np.packbits(picture.reshape(HEIGHT // 8, 8, WIDTH), axis=1, bitorder="little")[:, 0]
    made: list[tuple[bool, bytes]] = []
    for page, row in enumerate(packed):
        made += [(False, bytes((0xB0 + page, OFFSET & 15, 0x10 + (OFFSET >> 4)))), (True, row.tobytes())]
    return made


def test_qemus_panel_shows_what_was_sent(machine: Machine, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    with HostLink(serial.Serial(machine.port, 115200)) as link:
        assert (link.device.controller, link.device.width, link.device.present) == ("ssd0303", WIDTH, True)
        link.write([(False, b"\xae\xa0\xa4\xa6\x40\x81\x7f\xd3\x00\xaf")])
        pictures = [(rng.random((HEIGHT, WIDTH)) < share).astype(np.uint8) for share in np.linspace(0, 1, 20)]
        for picture in pictures:
            link.write(runs(picture))
            np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), picture)
        link.write([(False, b"\xa7")])
        link.write(runs(pictures[7]))
        np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), 1 - pictures[7])
        assert link.stats.resent == 0
        assert link.status().overflows == 0
