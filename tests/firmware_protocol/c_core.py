"""The C core, built for this computer and driven through ctypes."""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from pathlib import Path

import pytest

import firmware_protocol

FIRMWARE = Path(firmware_protocol.__file__).parent / "firmware"


def made(target: str, result: str, build: Path, *needed: str, options: str = "", **settings: str) -> Path:
    """Build a target of the firmware's Makefile with settings such as ``BUS``, or skip where a compiler is missing."""
    for tool in ("make", *needed):
        if not shutil.which(tool):
            pytest.skip(f"{tool} is not installed")
    done = subprocess.run(
        [
            *("make", "-C", str(FIRMWARE), target, f"BUILD={build}", f"OPTIONS={options}"),
            *(f"{name}={value}" for name, value in settings.items()),
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    return build / result


class Core:
    """The C core with the interface of the reference `Device`, as far as the tests need it."""

    def __init__(self, library: Path) -> None:
        self.c = ctypes.CDLL(str(library))
        self.c.host_rate.restype = ctypes.c_uint32
        self.c.host_receive.restype = self.c.host_written.restype = ctypes.c_uint16
        self.answer = (ctypes.c_uint8 * 4096)()
        self.bytes = (ctypes.c_uint8 * 60000)()
        self.now = 0
        self.start()

    def start(self, boot: int = 1, cause: int = 1) -> bytes:
        self.c.host_start(boot, cause)
        self.now = 0
        return self.receive(b"")

    def receive(self, data: bytes) -> bytes:
        size = self.c.host_receive(data, len(data), self.answer, len(self.answer), self.now & 0xFFFF)
        return bytes(self.answer[:size])

    def panel(self, *, gone: bool = False, slow: bool = False, stuck: bool = False) -> None:
        self.c.host_set(gone, slow, stuck)

    def gives(self, status: int) -> None:
        """Say what byte the panel gives when it is read."""
        self.c.host_set_status(status)

    @property
    def resets(self) -> int:
        """How often the panel's reset line was pulled since the start."""
        return int(self.c.host_resets())

    def transactions(self) -> list[bytes]:
        written = bytes(self.bytes[: self.c.host_written(self.bytes)])
        found, at = [], 0
        while at < len(written):
            size = int.from_bytes(written[at : at + 2], "little")
            found.append(written[at + 2 : at + 2 + size])
            at += 2 + size
        return [content for content in found if content]

    @property
    def baudrate(self) -> int:
        return int(self.c.host_rate())
