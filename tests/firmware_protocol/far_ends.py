"""Far ends for real pyserial: a board behind a pseudo-terminal, and servers of pyserial's network ports."""

from __future__ import annotations

import errno
import os
import random
import re
import select
import socket
import threading
import time
from collections.abc import Callable
from pathlib import Path

import emulated
import pytest
from simulated import Noise, PagePanel

from firmware_protocol import Device, HelloReply

serial = pytest.importorskip("serial", reason="pyserial is not installed")
pty = pytest.importorskip("pty", reason="no pseudo-terminals here")
tty = pytest.importorskip("tty", reason="no pseudo-terminals here")
termios = pytest.importorskip("termios", reason="no pseudo-terminals here")
rfc2217 = pytest.importorskip("serial.rfc2217")

Panel = Callable[[bytes], None]
Noisy = Callable[[bytes, random.Random], bytes]


class PtyBoard:
    """Something that runs in a thread behind a pseudo-terminal that hangs at ``path``.

    Attributes
    ----------
    taken : int
        Bytes that have come from the host.
    trouble : str
        What the panel's bus does: ``"absent"`` (nobody answers), ``"stuck"``, or nothing unusual.
    """

    def __init__(self, path: Path, panel: Panel | None) -> None:
        self.path = path
        self.panel = panel or PagePanel()
        self.taken = 0
        self.trouble = ""
        self.plug_in()

    def plug_in(self) -> None:
        self.far, near = pty.openpty()
        tty.setraw(near)
        self.path.unlink(missing_ok=True)
        self.path.symlink_to(os.ttyname(near))
        self.near = near
        self.quit, self.tell = os.pipe()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def pull_out(self) -> None:
        os.write(self.tell, b"q")
        self.thread.join()
        self.path.unlink()
        for handle in (self.far, self.near, self.quit, self.tell):
            os.close(handle)

    def run(self) -> None:
        """Live until there is something to read from ``quit``."""
        raise NotImplementedError

    def come(self, timeout: float | None = None) -> bytes | None:
        """Return what the host sent, no bytes if nothing came in time, and None when it is time to quit."""
        ready = select.select([self.far, self.quit], [], [], timeout)[0]
        if self.quit in ready:
            return None
        data = os.read(self.far, 4096) if ready else b""
        self.taken += len(data)
        return data


class Board(PtyBoard):
    """The reference device, with a noisy line."""

    def __init__(
        self, path: Path, noise: Noisy | None = None, panel: Panel | None = None, profile: HelloReply | None = None
    ) -> None:
        self.noise = noise or Noise()
        self.rng = random.Random(7)
        self.device = Device(self.write, profile=profile)
        self.reset_due = False
        super().__init__(path, panel)

    def run(self) -> None:
        self.say(self.device.reset(1))
        while (data := self.come()) is not None:
            answer = self.device.receive(self.noise(data, self.rng))
            if self.reset_due:  # what it would have answered is lost with it
                self.reset_due = False
                answer = self.device.reset(8)
            self.say(answer)

    def write(self, content: bytes) -> None:
        if self.trouble:
            raise OSError(errno.EREMOTEIO if self.trouble == "absent" else errno.ETIMEDOUT, self.trouble)
        self.panel(content)

    def say(self, data: bytes) -> None:
        os.write(self.far, self.noise(data, self.rng))


class EmulatedBoard(PtyBoard):
    """The firmware on the emulated chip, at the speed of its wire and of the clock on the wall.

    On a busy machine it runs slower: if it had to catch up, each turn could take longer than the one before. Whoever
    waits for it has to measure that by its own `seconds`.
    """

    def __init__(self, binaries: tuple[Path, Path], path: Path, panel: Panel | None = None) -> None:
        self.chip = emulated.Board(*binaries)
        super().__init__(path, panel)

    def seconds(self) -> float:
        """Return the time on the board."""
        return self.chip.cycle / emulated.HZ

    def run(self) -> None:
        self.chip.reset(power=True)
        before = time.monotonic()
        while (data := self.come(0.001)) is not None:
            rate = line_rate(self.near)
            self.chip.panel(absent=self.trouble == "absent", stuck=self.trouble == "stuck")
            self.chip.feed(data, rate)
            now = time.monotonic()
            self.chip.run(self.chip.cycle + round(min(now - before, 0.02) * emulated.HZ))
            before = now
            for content in self.chip.transactions():
                self.panel(content)
            if answer := self.chip.output(rate):
                os.write(self.far, answer)


def line_rate(handle: int) -> int:
    """Return the rate that a terminal is set to, in bits a second."""
    speed = termios.tcgetattr(handle)[4]
    return next(
        int(name[1:]) for name in dir(termios) if re.fullmatch(r"B\d+", name) and getattr(termios, name) == speed
    )


class Server:
    """Serves one connection after another, each from a device that goes on living."""

    def __init__(self, telnet: bool, panel: Panel | None = None) -> None:
        self.telnet = telnet
        self.panel = panel or PagePanel()
        self.device = Device(self.panel)
        self.listener = socket.create_server(("127.0.0.1", 0))
        address = f"127.0.0.1:{self.listener.getsockname()[1]}"
        self.url = f"{'rfc2217' if telnet else 'socket'}://{address}"
        self.connection: socket.socket | None = None
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self) -> None:
        while True:
            try:
                self.connection, _ = self.listener.accept()
            except OSError:
                return
            with self.connection:
                (self.talk_rfc2217 if self.telnet else self.talk)(self.connection)

    def talk(self, connection: socket.socket) -> None:
        while data := received(connection):
            connection.sendall(self.device.receive(data))

    def talk_rfc2217(self, connection: socket.socket) -> None:
        port = serial.serial_for_url("loop://", timeout=0)  # for its settings and modem lines

        class Sender:
            def write(self, data: bytes) -> None:
                connection.sendall(data)

        manager = rfc2217.PortManager(port, Sender())
        while data := received(connection):
            answer = self.device.receive(b"".join(manager.filter(data)))
            connection.sendall(b"".join(manager.escape(answer)))
        port.close()

    def drop(self) -> None:
        assert self.connection
        self.connection.shutdown(socket.SHUT_RDWR)

    def close(self) -> None:
        self.listener.shutdown(socket.SHUT_RDWR)
        self.listener.close()
        self.thread.join(5)


def received(connection: socket.socket) -> bytes:
    select.select([connection], [], [])
    try:
        return connection.recv(4096)
    except OSError:
        return b""
