"""What our driver sends to an SSD1306, as the one that simavr has as a part decodes it: written by others, in C.

It knows the page pointer and not the ends of windows, so windows are left to the other judges.
"""

from __future__ import annotations

import ctypes
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from paneldraw import Panel
from paneldraw.controllers import SSD1306
from paneldraw.transports import I2CTransport, SPITransport

INVERTED, ON, SEGMENTS_PLAIN, LINES_PLAIN = range(4)
"""Flags of the part."""


@pytest.fixture(scope="module")
def library(tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    if not Path("/usr/include/simavr/parts/ssd1306_virt.h").exists() or not shutil.which("cc"):
        pytest.skip("libsimavr-dev or cc is not installed")
    target = tmp_path_factory.mktemp("rig") / "ssd1306.so"
    source = Path(__file__).parent / "rig" / "ssd1306.c"
    command = ["cc", "-O1", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-I/usr/include/simavr", str(source)]
    done = subprocess.run(
        [*command, "-o", str(target), "-lsimavrparts", "-lsimavr", "-lelf"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    made = ctypes.CDLL(str(target))
    made.part_ram.restype = ctypes.POINTER(ctypes.c_uint8 * 1024)
    return made


class Wire:
    """The part on both kinds of bus, with as much of smbus2's, spidev's and our pins' interfaces as transports use."""

    def __init__(self, library: ctypes.CDLL) -> None:
        self.part = library
        self._data = 0
        library.part_start()

    def i2c_rdwr(self, *messages: Any) -> None:
        for message in messages:
            if not message.flags:
                payload = bytes(message)
                self.part.part_i2c(message.addr, payload, len(payload))

    def writebytes2(self, values: Any) -> None:
        payload = bytes(values)
        self.part.part_spi(self._data, payload, len(payload))

    writebytes = writebytes2

    def set(self, line: int, value: bool) -> None:
        if line == 24:
            self._data = int(value)

    def close(self) -> None:
        """Nothing to close."""

    @property
    def ram(self) -> np.ndarray[Any, np.dtype[np.uint8]]:
        return np.unpackbits(np.array(self.part.part_ram().contents).reshape(8, 128), axis=0, bitorder="little")

    def flags(self) -> list[bool]:
        return [bool(self.part.part_flag(flag)) for flag in range(4)]


BUSES: dict[str, Callable[[Wire], I2CTransport | SPITransport]] = {
    "i2c": lambda wire: I2CTransport(wire),
    "spi": lambda wire: SPITransport(spi=wire, pins=wire),
}


@pytest.mark.parametrize("updates", ["least", "plain", "whole"])
@pytest.mark.parametrize("bus", BUSES)
def test_pictures_arrive(library: ctypes.CDLL, bus: str, updates: Any) -> None:
    wire = Wire(library)
    panel = Panel(replace(SSD1306(), window=None), BUSES[bus](wire), updates=updates)
    random = np.random.default_rng(1)
    picture = random.integers(0, 2, (64, 128), np.uint8)
    for _ in range(20):
        panel.show(picture)
        assert np.array_equal(wire.ram, picture)
        picture[random.integers(0, 64, 9), random.integers(0, 128, 9)] ^= 1
        picture[20:30, random.integers(0, 100) :] ^= random.integers(0, 2, dtype=np.uint8)


@pytest.mark.parametrize("bus", BUSES)
def test_settings_and_mirrors_arrive(library: ctypes.CDLL, bus: str) -> None:
    wire = Wire(library)
    panel = Panel(SSD1306(mirror_x=True), BUSES[bus](wire))
    assert wire.flags() == [False, False, True, False]
    panel.clear()
    panel.invert()
    panel.contrast(0x21)
    assert wire.flags() == [True, True, True, False]
    assert wire.part.part_contrast() == 0x21
    panel.sleep()
    Panel(SSD1306(mirror_y=True), BUSES[bus](wire))
    assert wire.flags()[1:] == [False, False, True]
