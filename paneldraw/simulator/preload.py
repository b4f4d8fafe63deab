"""Simulated buses for other programs, which find them where Linux has /dev/i2c-N and /dev/spidevB.D."""

from __future__ import annotations

import errno
import importlib.machinery
import os
import shutil
import struct
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from .bus import I2CBus
from .kernel.gpio import LABEL, LINES, GPIOChip, SysfsLines
from .kernel.i2c_dev import I2CFile
from .kernel.server import File, Server
from .kernel.spidev import SPIFile
from .spi import SPIBus
from .wire import os_error

_LONGEST: Final = 107 - len("/socket")
"""Of a folder whose socket has a name that the kernel takes."""
_MEMORY: Final = "/dev/shm"
"""Where files come and go fastest."""
_INTERPRETER: Final = 3
_LINE_FILES: Final = ("value", "direction", "active_low", "edge")


class PreloadUnavailableError(OSError):
    """A program cannot be given simulated buses, or not here; says why, and what to do."""


class Preload:
    """Simulated buses in place of the devices of child processes: any program's, unchanged. Linux only.

    A child sees the buses as /dev/i2c-N and /dev/spidevB.D, the lines that SPI buses are wired to as /dev/gpiochip0
    and below /sys/class/gpio, and none of the machine's own. What it and its own children open, read, write and list is
    caught by a C library in ``LD_PRELOAD``; so it must be a program that loads libraries. The chips stay here, to be
    looked at while the program runs and after.

    Parameters
    ----------
    i2c : mapping of int to I2CBus
        The buses by their numbers.
    spi : mapping of (int, int) to SPIBus
        The buses by the numbers of bus and chip select.
    serial : mapping of str to str
        What stands for a serial port: a pty's path by a path such as /dev/ttyACM0.
    folder : path, optional
        Where the socket and the files that programs see are made, and stay in no one's way: an empty folder, or one
        that is not there yet. Default: a temporary one.

    Attributes
    ----------
    gpio : GPIOChip
        The lines. ``gpio.lines[4].wires.append(call)`` has ``call(high)`` called whenever line 4 is driven.

    Raises
    ------
    PreloadUnavailableError
        On entering, where the C library is missing; from `popen` and `run` for a program that it cannot reach.

    Notes
    -----
    ::

        chip = simulator.SSD1306()
        with simulator.Preload({1: simulator.I2CBus({0x3C: chip})}) as preload:
            preload.run(["i2cset", "-y", "1", "0x3c", "0x00", "0xaf"])
        assert chip.registers.on

    The program itself is looked at before it is started; one that it starts in turn, and that is linked statically or
    runs with another user's rights, finds the machine's own devices.
    """

    def __init__(
        self,
        i2c: Mapping[int, I2CBus] | None = None,
        spi: Mapping[tuple[int, int], SPIBus] | None = None,
        serial: Mapping[str, str] | None = None,
        *,
        folder: Path | None = None,
    ) -> None:
        self.i2c, self.spi, self.serial = dict(i2c or {}), dict(spi or {}), dict(serial or {})
        for path in self.serial:
            if not path.startswith("/dev/") or ".." in path:
                raise ValueError(f"serial: {path!r} is not a path below /dev")
        self.gpio = GPIOChip(self.spi.values())
        self._sysfs = SysfsLines(self.gpio, self._show_line)
        self._given = folder
        self._folder: Path | None = None
        self._server: Server | None = None

    def __enter__(self) -> Preload:
        built = library()
        if self._server is not None:
            raise RuntimeError("this Preload is in use already")
        self._folder = _new_folder(self._given)
        try:
            (self._folder / "preload.so").symlink_to(built)
            self._furnish(self._folder)
            self._server = Server(str(self._folder / "socket"), self._open)
        except BaseException:
            self.close()
            raise
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def close(self) -> None:
        """End serving; programs that still run find their devices gone. Closing twice does nothing."""
        if self._server is not None:
            self._server.close()
            self._server = None
        if self._folder is not None:
            shutil.rmtree(self._folder)
            self._folder = None

    def environment(self, base: Mapping[str, str] | None = None) -> dict[str, str]:
        """Return what a child's environment needs beside ``os.environ``, or beside `base`."""
        if self._folder is None or self._server is None:
            raise RuntimeError("a Preload serves in its with block alone")
        others = (os.environ if base is None else base).get("LD_PRELOAD", "")
        libraries = f"{self._folder}/preload.so" + (f":{others}" if others else "")
        return {"LD_PRELOAD": libraries, "PANELDRAW_PRELOAD": str(self._folder)}

    def popen(self, command: Sequence[str] | str, **options: Any) -> subprocess.Popen[Any]:
        """Start a program as ``subprocess.Popen`` does."""
        return subprocess.Popen(command, **self._options(command, options))

    def run(self, command: Sequence[str] | str, **options: Any) -> subprocess.CompletedProcess[Any]:
        """Run a program as ``subprocess.run`` does."""
        return subprocess.run(command, **self._options(command, options))

    # inside

    def _options(self, command: Sequence[str] | str, options: dict[str, Any]) -> dict[str, Any]:
        given = options.get("env")
        environment = dict(os.environ if given is None else given)
        environment |= self.environment(environment)
        program = options.get("executable") or ("/bin/sh" if options.get("shell") else _first(command))
        check_program(program, environment.get("PATH"))
        return options | {"env": environment}

    def _open(self, name: str) -> File:
        for number, i2c in self.i2c.items():
            if name == f"/dev/i2c-{number}":
                return I2CFile(i2c)
        for (bus, device), spi in self.spi.items():
            if name == f"/dev/spidev{bus}.{device}":
                return SPIFile(spi)
        if name == "/dev/gpiochip0":
            return self.gpio
        below = name.removeprefix("/sys/class/gpio/")
        if self._folder is None or below == name or not (self._folder / name[1:]).exists():
            raise os_error(errno.ENOENT)
        return self._sysfs.open(below)

    def _furnish(self, root: Path) -> None:
        """Make the files that programs look for."""
        for folder in ("dev", "sys/class/i2c-dev", "sys/bus/i2c/devices", "sys/class/spidev", "sys/bus/spi/devices"):
            (root / folder).mkdir(parents=True)
        for number in self.i2c:
            name = f"simulated bus {number}\n"
            for folder in ("class/i2c-dev", "class/i2c-adapter", "bus/i2c/devices"):
                _write(root / f"sys/{folder}/i2c-{number}/name", name)
            _write(root / f"sys/class/i2c-dev/i2c-{number}/dev", f"89:{number}\n")
            _write(root / f"sys/class/i2c-dev/i2c-{number}/device/name", name)
            _write(root / f"dev/i2c-{number}")
            _link(root / f"sys/dev/char/89:{number}/subsystem", "../../../class/i2c-dev")
        for bus, device in self.spi:
            _write(root / f"dev/spidev{bus}.{device}")
            _write(root / f"sys/class/spidev/spidev{bus}.{device}/dev", f"153:{16 * bus + device}\n")
            _write(root / f"sys/bus/spi/devices/spi{bus}.{device}/modalias", "spi:spidev\n")
        bufsiz = min((bus.bufsiz for bus in self.spi.values()), default=4096)
        _write(root / "sys/module/spidev/parameters/bufsiz", f"{bufsiz}\n")
        self._furnish_lines(root)
        for path, pty in self.serial.items():
            _link(root / path[1:], pty)

    def _furnish_lines(self, root: Path) -> None:
        _write(root / "dev/gpiochip0")
        _write(root / "sys/bus/gpio/devices/gpiochip0/dev", "254:0\n")
        _link(root / "sys/dev/char/254:0/subsystem", "../../../bus/gpio")
        for name, text in {"base": "0", "ngpio": str(LINES), "label": LABEL}.items():
            _write(root / f"sys/class/gpio/gpiochip0/{name}", f"{text}\n")
        for name in ("export", "unexport"):
            _write(root / f"sys/class/gpio/{name}")

    def _show_line(self, number: int, exported: bool) -> None:
        if self._folder is None:
            return
        folder = self._folder / f"sys/class/gpio/gpio{number}"
        if not exported:
            shutil.rmtree(folder)
            return
        for name in _LINE_FILES:
            _write(folder / name)


def check_program(program: str | os.PathLike[str], path: str | None = None) -> None:
    """Raise PreloadUnavailableError for a program that no library can be loaded into; `path` is where to look for it.

    One that is not found is left to be missed by whoever starts it.
    """
    found = shutil.which(program, path=path)
    if found is None:
        return
    try:
        with open(found, "rb") as file:
            head = file.read(1 << 16)
        special = os.stat(found).st_mode & 0o6000
    except OSError:  # not for us to read; perhaps it can be run all the same
        return
    if head.startswith(b"#!"):
        words = head[2:].split(b"\n", 1)[0].split()
        if words:
            check_program(os.fsdecode(words[0]), path)
    elif head.startswith(b"\x7fELF"):
        reason = _unreachable(head) or ("runs with rights of its own (set-user-ID)" if special else None)
        if reason:
            raise PreloadUnavailableError(
                errno.ENOEXEC, f"{found} {reason}: LD_PRELOAD cannot give it simulated buses; take another build of it"
            )


def _unreachable(head: bytes) -> str | None:
    """Say why a library like ours does not load into the program whose file begins so."""
    own = Path(sys.executable).read_bytes()[:20]
    if head[4:6] != own[4:6] or head[18:20] != own[18:20]:
        return "is made for another kind of processor, or has another width, than this Python"
    wide, order = head[4] == 2, "<" if head[5] == 1 else ">"
    start, size, count = (
        *struct.unpack_from(order + ("Q" if wide else "I"), head, 32 if wide else 28),
        *struct.unpack_from(order + "HH", head, 54 if wide else 42),
    )
    for at in range(start, min(start + size * count, len(head) - size + 1), size):
        (kind,) = struct.unpack_from(order + "I", head, at)
        if kind == _INTERPRETER:
            place, length = struct.unpack_from(
                order + ("QxxxxxxxxxxxxxxxxQ" if wide else "IxxxxxxxxI"), head, at + (8 if wide else 4)
            )
            return (
                "is linked with musl, and the library with glibc"
                if b"ld-musl" in head[place : place + length]
                else None
            )
    return "is linked statically, and loads no libraries"


def library() -> Path:
    """Find the C library."""
    if sys.platform != "linux":
        raise PreloadUnavailableError(
            errno.ENOSYS,
            "simulated buses for other programs need Linux; here scripts on paneldraw can use sim:// panels",
        )
    for suffix in importlib.machinery.EXTENSION_SUFFIXES:
        path = Path(__file__).with_name(f"_preload{suffix}")
        if path.exists():
            return path
    advice = "install a C compiler, then install paneldraw anew with pip's --force-reinstall --no-cache-dir"
    raise PreloadUnavailableError(errno.ENOENT, f"this install has no library for simulated buses: {advice}")


def _new_folder(given: Path | None) -> Path:
    """Make a folder whose path suits a socket's name and ``LD_PRELOAD``."""
    if given is not None:
        given.mkdir(exist_ok=True)
    quick = [_MEMORY] if os.access(_MEMORY, os.W_OK | os.X_OK) else []
    for place in (*quick, None, "/tmp"):
        folder = tempfile.mkdtemp(prefix=f"paneldraw-{os.getpid()}-", dir=place) if given is None else str(given)
        if len(os.fsencode(folder)) <= _LONGEST and not set(folder) & set(" :\t\n$"):
            return Path(folder)
        os.rmdir(folder)
        if given is not None:
            break
    advice = f"take one of {_LONGEST} bytes at most, without spaces or colons"
    raise PreloadUnavailableError(errno.ENAMETOOLONG, f"{folder} does not suit a socket and LD_PRELOAD: {advice}")


def _first(command: Sequence[str] | str) -> str:
    return os.fsdecode(command if isinstance(command, (str, bytes, os.PathLike)) else command[0])


def _write(path: Path, text: str = "") -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="ascii")


def _link(path: Path, target: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.symlink_to(target)
