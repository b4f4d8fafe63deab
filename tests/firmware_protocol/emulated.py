"""The emulated ATmega328P with the real firmware, as a port for `HostLink` in simulated time."""

from __future__ import annotations

import atexit
import ctypes
import functools
import random
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from itertools import groupby
from pathlib import Path
from typing import Protocol

import pytest
from c_core import made
from simulated import Noise, PagePanel

HZ = 16_000_000
RIG = Path(__file__).parent / "rig" / "rig.c"


def folder() -> Path:
    """Return a new folder that lasts as long as this process."""
    name = tempfile.mkdtemp(prefix="atmega328p-")
    atexit.register(shutil.rmtree, name, ignore_errors=True)
    return Path(name)


@functools.cache
def built(options: str = "", **settings: str) -> tuple[Path, Path]:
    """Return the rig's library and the firmware, or skip where something to build them with is missing.

    Settings are the Makefile's: ``BUS``, ``CHIP``, ``SIZE``. What was built for one test, the others get too.
    """
    if not Path("/usr/include/simavr").exists():
        pytest.skip("libsimavr-dev is not installed")
    if not shutil.which("cc"):
        pytest.skip("cc is not installed")
    return rig(), made("atmega328p", "atmega328p/paneldraw.elf", folder(), "avr-gcc", options=options, **settings)


@functools.cache
def rig() -> Path:
    library = folder() / "rig.so"
    flags = ["-O2", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC"]
    done = subprocess.run(
        ["cc", *flags, str(RIG), "-o", str(library), "-lsimavr", "-lelf"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return library


class Board:
    """The chip: runs cycle by cycle, takes and gives characters, logs what its panel's bus carried."""

    def __init__(self, library: Path, elf: Path) -> None:
        self.c = ctypes.CDLL(str(library))
        self.c.rig_new.restype = ctypes.c_void_p
        self.c.rig_cycle.restype = ctypes.c_uint64
        self.c.rig_run.restype = ctypes.c_bool
        self.c.rig_run.argtypes = [ctypes.c_void_p, ctypes.c_uint64, ctypes.c_bool]
        for name in ("take", "log", "wire", "overruns", "untouched", "spi_fastest"):
            getattr(self.c, f"rig_{name}").restype = ctypes.c_uint32
        self.c.rig_panel.argtypes = [ctypes.c_void_p, ctypes.c_bool, ctypes.c_bool, ctypes.c_long]
        self.rig = ctypes.c_void_p(self.c.rig_new(str(elf).encode()))
        assert self.rig, "the rig does not start"
        self.room = (ctypes.c_uint8 * (1 << 18))()
        self.character = ctypes.c_uint8()

    def close(self) -> None:
        if self.rig:
            self.c.rig_free(self.rig)
            self.rig = ctypes.c_void_p()

    @property
    def cycle(self) -> int:
        return int(self.c.rig_cycle(self.rig))

    def run(self, until: int, stop_at_output: bool = False) -> None:
        assert self.c.rig_run(self.rig, until, stop_at_output), "the firmware has crashed"

    def feed(self, data: bytes, baudrate: int) -> None:
        self.c.rig_feed(self.rig, data, len(data), round(HZ / baudrate))

    def output(self, baudrate: int) -> bytes:
        """Return the characters that went out; one at another rate than ``baudrate`` reads as another character."""
        out = bytearray()
        while bit := self.c.rig_take(self.rig, ctypes.byref(self.character)):
            right = abs(bit * baudrate / HZ - 1) < 0.05
            out.append(self.character.value if right else self.character.value * 37 + 11 & 0xFF)
        return bytes(out)

    def transactions(self) -> list[bytes]:
        written = bytes(self.room[: self.c.rig_log(self.rig, self.room, len(self.room))])
        found, at = [], 0
        while at < len(written):
            size = int.from_bytes(written[at : at + 2], "little")
            found.append(written[at + 2 : at + 2 + size])
            at += 2 + size
        return [content for content in found if content]

    def wire(self) -> list[tuple[str, bytes]]:
        """Return what a panel on SPI has seen since: runs of bytes and what happened between them.

        ``"c"`` and ``"d"`` are bytes with D/C low and high, ``"/"`` the end of a chip select, ``"r"`` the end of a
        reset pulse, with its milliseconds.
        """
        seen = bytes(self.room[: self.c.rig_wire(self.rig, self.room, len(self.room))])
        wrong = {chr(what) for event, what in zip(seen[::2], seen[1::2], strict=True) if event == ord("!")}
        assert not wrong, f"a panel may have missed something: {wrong}"
        return [
            (kind, bytes(byte for _, byte in run))
            for kind, run in groupby(zip(map(chr, seen[::2]), seen[1::2], strict=True), lambda event: event[0])
        ]

    @property
    def spi_clock(self) -> float:
        """The fastest clock that the panel has seen, in Hz."""
        return HZ / int(self.c.rig_spi_fastest(self.rig))

    def panel(self, *, absent: bool = False, stuck: bool = False, nack_after: int = -1) -> None:
        self.c.rig_panel(self.rig, absent, stuck, nack_after)

    def gives(self, status: int) -> None:
        """Say what byte the panel gives when it is read."""
        self.c.rig_gives(self.rig, status)

    def frames(self, seconds: float) -> None:
        """Have the panel's frame line pulse every so many seconds, or no more with 0."""
        self.c.rig_frames(self.rig, round(seconds * HZ))

    def reset(self, *, power: bool = False) -> None:
        self.c.rig_reset(self.rig, power)

    def hang(self) -> None:
        self.c.rig_hang(self.rig)

    @property
    def eeprom(self) -> bytes:
        content = (ctypes.c_uint8 * 1024)()
        self.c.rig_eeprom(self.rig, content)
        return bytes(content)

    @property
    def overruns(self) -> int:
        return int(self.c.rig_overruns(self.rig))

    @property
    def untouched_ram(self) -> int:
        return int(self.c.rig_untouched(self.rig))


class SPIPanel(Protocol):
    """What a panel on SPI takes, as a simulated chip does."""

    def transfer(self, run: bytes, data: bool) -> object: ...
    def deselect(self) -> object: ...
    def reset(self) -> object: ...


class Recorder:
    """Keeps what a panel on SPI is sent: chip selects, each of runs with D/C high (True) or low, and resets."""

    def __init__(self) -> None:
        self.selects: list[list[tuple[bool, bytes]]] = []
        self.open: list[tuple[bool, bytes]] = []
        self.resets = 0

    def transfer(self, run: bytes, data: bool) -> None:
        if self.open and self.open[-1][0] == data:
            run = self.open.pop()[1] + run
        self.open.append((data, run))

    def deselect(self) -> None:
        self.selects.append(self.open)
        self.open = []

    def reset(self) -> None:
        self.resets += 1


class BoardPort:
    """What `HostLink` needs of a pyserial port, joined to a `Board`; `clock` is the board's time.

    A panel on I²C is ``panel``, called with each transaction, and ``status`` says what it gives when it is read; one on
    SPI is ``spi``.
    """

    name = "emulated"

    def __init__(self, board: Board, *, noise: Noise | None = None, seed: int = 0) -> None:
        self.board = board
        self.noise = noise or Noise()
        self.rng = random.Random(seed)
        self.panel: Callable[[bytes], None] | PagePanel = PagePanel()
        self.status: Callable[[], int] = lambda: 0
        self.spi: SPIPanel = Recorder()
        self.baudrate, self.timeout, self.is_open = 115200, 0.02, True
        self.received = bytearray()
        self.carried = 0

    def clock(self) -> float:
        return self.board.cycle / HZ

    @property
    def in_waiting(self) -> int:
        return len(self.received)

    def open(self) -> None:
        self.is_open = True

    def close(self) -> None:
        self.is_open = False

    def flush(self) -> None:
        pass

    def write(self, data: bytes) -> int:
        self.carried += len(data)
        self.board.gives(self.status())
        self.board.feed(self.noise(data, self.rng), self.baudrate)
        return len(data)

    def read(self, size: int = 1) -> bytes:
        until = self.board.cycle + round(self.timeout * HZ)
        while not self.received and self.board.cycle < until:
            self.board.run(until, stop_at_output=True)
            data = self.board.output(self.baudrate)
            self.carried += len(data)
            self.received += self.noise(data, self.rng)
        for content in self.board.transactions():
            self.panel(content)
        for kind, content in self.board.wire():
            if kind == "/":
                self.spi.deselect()
            elif kind == "r":
                self.spi.reset()
            else:
                self.spi.transfer(content, kind == "d")
        data = bytes(self.received[:size])
        del self.received[:size]
        return data
