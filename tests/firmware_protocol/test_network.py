"""pyserial's other kinds of port: a bare TCP socket and RFC 2217, with the reference device behind them."""

from __future__ import annotations

import select
import socket
import threading
from collections.abc import Iterator

import pytest
from simulated import PagePanel, whole

from firmware_protocol import Device, HostLink, LinkLostError

serial = pytest.importorskip("serial", reason="pyserial is not installed")
rfc2217 = pytest.importorskip("serial.rfc2217")

PICTURE = bytes(range(256)) * 4


class Server:
    """Serves one connection after another, each from a device that goes on living."""

    def __init__(self, telnet: bool) -> None:
        self.telnet = telnet
        self.panel = PagePanel()
        self.device = Device(self.panel)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.address = f"127.0.0.1:{self.listener.getsockname()[1]}"
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


@pytest.fixture
def server(request: pytest.FixtureRequest) -> Iterator[Server]:
    server = Server(request.param == "rfc2217")
    yield server
    server.close()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")  # pyserial's own
@pytest.mark.parametrize("server", ["socket", "rfc2217"], indirect=True)
def test_pictures_arrive(server: Server) -> None:
    url = f"{'rfc2217' if server.telnet else 'socket'}://{server.address}"
    with HostLink(serial.serial_for_url(url, 115200)) as link:
        link.write(whole(PICTURE))
        assert server.panel.ram == PICTURE
        assert link.stats.timeouts == 0


@pytest.mark.parametrize("server", ["socket"], indirect=True)
def test_a_dropped_connection_is_made_again(server: Server) -> None:
    with HostLink(serial.serial_for_url(f"socket://{server.address}", 115200)) as link:
        link.write([(True, b"\1")])
        server.drop()
        with pytest.raises(LinkLostError):
            link.write([(True, b"\2")])
        link.write(whole(PICTURE))
        assert server.panel.ram == PICTURE
