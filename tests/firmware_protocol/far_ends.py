"""Far ends for real pyserial: a board behind a pseudo-terminal, and servers of pyserial's network ports."""

from __future__ import annotations

import os
import random
import select
import socket
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from simulated import Noise, PagePanel

from firmware_protocol import Device, HelloReply

serial = pytest.importorskip("serial", reason="pyserial is not installed")
pty = pytest.importorskip("pty", reason="no pseudo-terminals here")
tty = pytest.importorskip("tty", reason="no pseudo-terminals here")
rfc2217 = pytest.importorskip("serial.rfc2217")

Panel = Callable[[bytes], None]
Noisy = Callable[[bytes, random.Random], bytes]


class Board:
    """A device behind a pseudo-terminal that hangs at ``path``, with a noisy line."""

    def __init__(
        self, path: Path, noise: Noisy | None = None, panel: Panel | None = None, profile: HelloReply | None = None
    ) -> None:
        self.path = path
        self.noise = noise or Noise()
        self.rng = random.Random(7)
        self.panel = panel or PagePanel()
        self.device = Device(lambda content: self.panel(content), profile=profile)
        self.taken = 0
        self.reset_due = False
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
        self.say(self.device.reset(1))
        while self.quit not in (ready := select.select([self.far, self.quit], [], [])[0]):
            assert ready == [self.far]
            data = os.read(self.far, 4096)
            self.taken += len(data)
            answer = self.device.receive(self.noise(data, self.rng))
            if self.reset_due:  # what it would have answered is lost with it
                self.reset_due = False
                answer = self.device.reset(8)
            self.say(answer)

    def say(self, data: bytes) -> None:
        os.write(self.far, self.noise(data, self.rng))


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
