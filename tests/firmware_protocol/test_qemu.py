"""The firmware on a Cortex-M3 that QEMU emulates, looked at through QEMU's own panel: an eye that is not ours."""

from __future__ import annotations

import json
import re
import shutil
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from c_core import made

from firmware_protocol import DeviceResetError, Fault, Feature, HostLink, PanelFaultError
from firmware_protocol.messages import PanelBus

serial = pytest.importorskip("serial", reason="pyserial is not installed")
MAGNIFIED = 4
OFFSET = 36


class Machine:
    """QEMU with the firmware; its serial line hangs on a pseudo-terminal, its monitor on its standard streams."""

    def __init__(self, board: str, elf: Path, width: int, height: int) -> None:
        self.width, self.height = width, height
        self.debugger = elf.with_suffix(".gdb")
        joints = ["-display", "none", "-serial", "pty", "-qmp", "stdio"]
        joints += ["-gdb", f"unix:{self.debugger},server=on,wait=off"]
        self.process = subprocess.Popen(
            ["qemu-system-arm", "-M", board, "-kernel", str(elf), *joints],
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
        """Return what the panel shows, as (height, width) of 0 to 255."""
        self.ask("screendump", filename=str(file))
        head, size, _, pixels = re.fullmatch(rb"(P6)\s+(\d+ \d+)\s+(255)\s(.*)", file.read_bytes(), re.DOTALL).groups()
        width, height = map(int, size.split())
        assert (head, width, height) == (b"P6", self.width * MAGNIFIED, self.height * MAGNIFIED)
        seen = np.frombuffer(pixels, np.uint8).reshape(height, width, 3)
        assert (seen == seen[::MAGNIFIED, ::MAGNIFIED].repeat(MAGNIFIED, 0).repeat(MAGNIFIED, 1)).all()
        return seen[::MAGNIFIED, ::MAGNIFIED, 0]

    def debug(self, *commands: str) -> None:
        """Stop the machine, do what the commands of gdb's remote protocol say, and let it go on."""
        with socket.socket(socket.AF_UNIX) as line:
            line.settimeout(10)
            line.connect(str(self.debugger))
            for command in (*commands, "D"):
                line.sendall(f"+${command}#{sum(command.encode()) & 0xFF:02x}".encode())
                answer = b""
                while not (found := re.search(rb"\$(?!T)(.*)#..", answer)):  # T tells that the machine has stopped
                    came = line.recv(1000)
                    assert came, "QEMU has ended"
                    answer += came
                assert found[1][:1] in (b"O", b"m"), (command, answer)

    def hang(self) -> None:
        """Send the core into an endless loop, as a fault in the firmware would."""
        knows_registers = "qXfer:features:read:target.xml:0,10"
        self.debug(knows_registers, "M20001000,2:fee7", "Pf=00100020")

    def stop_spi(self) -> None:
        reaches_peripherals = "Qqemu.PhyMemMode:1"
        self.debug(reaches_peripherals, "M40008004,4:00000000", "Qqemu.PhyMemMode:0")

    def close(self) -> None:
        self.process.terminate()
        self.process.communicate(timeout=10)


@pytest.fixture
def machine(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Machine]:
    if not shutil.which("qemu-system-arm"):
        pytest.skip("qemu-system-arm is not installed")
    target, width, height = request.param
    elf = made(target, f"{target}/paneldraw.elf", tmp_path / "build", "arm-none-eabi-gcc")
    machine = Machine(f"{target}evb", elf, width, height)
    yield machine
    machine.close()


def pages(picture: np.ndarray) -> list[tuple[bool, bytes]]:
    """Return the runs that show a picture of 0 and 1 on the SSD0303."""
    height, width = picture.shape
    packed = np.packbits(picture.reshape(height // 8, 8, width), axis=1, bitorder="little")[:, 0]
    runs: list[tuple[bool, bytes]] = []
    for page, row in enumerate(packed):
        runs += [(False, bytes((0xB0 + page, OFFSET & 15, 0x10 + (OFFSET >> 4)))), (True, row.tobytes())]
    return runs


@pytest.mark.parametrize("machine", [("lm3s811", 96, 16)], indirect=True)
def test_qemus_i2c_panel_shows_what_was_sent(machine: Machine, tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    with HostLink(serial.Serial(machine.port, 115200)) as link:
        said = link.device
        assert (said.controller, said.width, said.height, said.present) == ("ssd0303", 96, 16, True)
        link.write([(False, b"\xae\xa0\xa4\xa6\x40\x81\x7f\xd3\x00\xaf")])
        pictures = [(rng.random((16, 96)) < share).astype(np.uint8) for share in np.linspace(0, 1, 20)]
        for picture in pictures:
            link.write(pages(picture))
            np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), picture * 255)
        link.write([(False, b"\xa7")])
        link.write(pages(pictures[7]))
        np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), 255 - pictures[7] * 255)
        assert link.stats.resent == 0
        assert link.status().overflows == 0


@pytest.mark.parametrize("machine", [("lm3s811", 96, 16)], indirect=True)
def test_a_byte_is_read_from_qemus_i2c_panel_between_pictures(machine: Machine, tmp_path: Path) -> None:
    picture = np.random.default_rng(2).integers(0, 2, (16, 96), np.uint8)
    with HostLink(serial.Serial(machine.port, 115200)) as link:
        assert link.device.features & Feature.READ
        link.write([(False, b"\xae\xa0\xa4\xa6\x40\x81\x7f\xd3\x00\xaf")])
        for _ in range(3):
            assert link.read_panel() == 0xFF  # what QEMU's panel gives, which says that it has no status
            link.write(pages(picture))
        np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), picture * 255)


@pytest.mark.parametrize(
    "machine",
    [("lm3s811", 96, 16), pytest.param(("lm3s6965", 128, 64), marks=pytest.mark.thorough)],
    indirect=True,
)
def test_the_watchdog_ends_an_endless_loop(machine: Machine) -> None:
    with HostLink(serial.Serial(machine.port, 115200)) as link:
        link.write([(False, b"\xae")])
        machine.hang()
        with pytest.raises(DeviceResetError):
            link.write([(False, b"\xae")])
        link.write([(False, b"\xae")])
        assert link.stats.sessions == 2


@pytest.mark.parametrize("machine", [("lm3s6965", 128, 64)], indirect=True)
def test_an_spi_that_stops_is_a_fault_and_comes_back(machine: Machine, tmp_path: Path) -> None:
    picture = np.random.default_rng(3).integers(0, 16, (64, 128))
    packed = (picture[:, ::2] << 4 | picture[:, 1::2]).astype(np.uint8)
    with HostLink(serial.Serial(machine.port, 115200)) as link:
        machine.stop_spi()
        with pytest.raises(PanelFaultError) as caught:
            link.write([(True, bytes(100))])
        assert caught.value.fault == Fault.BUS_STUCK
        link.write([(False, b"\xae\xa0\x40\xa4\x81\x40\xaf\x15\x00\x3f\x75\x00\x3f"), (True, packed.tobytes())])
        np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), picture * 17)
        assert link.stats.sessions == 1


@pytest.mark.thorough
@pytest.mark.parametrize("machine", [("lm3s6965", 128, 64)], indirect=True)
def test_qemus_spi_panel_shows_what_was_sent(machine: Machine, tmp_path: Path) -> None:
    rng = np.random.default_rng(2)
    with HostLink(serial.Serial(machine.port, 115200)) as link:
        said = link.device
        assert (said.controller, said.bus, said.acknowledges) == ("ssd0323", PanelBus.SPI, False)
        link.write([(False, b"\xae\xa0\x40\xa4\x81\x40\xaf")])
        for flat in (False, True, False, False):
            picture = np.full((64, 128), 9) if flat else rng.integers(0, 16, (64, 128))
            packed = (picture[:, ::2] << 4 | picture[:, 1::2]).astype(np.uint8)
            link.write([(False, b"\x15\x00\x3f\x75\x00\x3f"), (True, packed.tobytes())])
            np.testing.assert_array_equal(machine.screen(tmp_path / "screen.ppm"), picture * 17)
        assert link.stats.resent == 0
