"""pyserial's other kinds of port: a bare TCP socket and RFC 2217, with the reference device behind them."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from far_ends import Server, serial
from simulated import whole

from firmware_protocol import HostLink, LinkLostError

PICTURE = bytes(range(256)) * 4


@pytest.fixture
def server(request: pytest.FixtureRequest) -> Iterator[Server]:
    server = Server(request.param == "rfc2217")
    yield server
    server.close()


@pytest.mark.filterwarnings("ignore:set(Daemon|Name):DeprecationWarning")  # pyserial's own
@pytest.mark.parametrize("server", ["socket", "rfc2217"], indirect=True)
def test_pictures_arrive(server: Server) -> None:
    with HostLink(serial.serial_for_url(server.url, 115200)) as link:
        link.write(whole(PICTURE))
        assert server.panel.ram == PICTURE
        assert link.stats.timeouts == 0


@pytest.mark.parametrize("server", ["socket"], indirect=True)
def test_a_dropped_connection_is_made_again(server: Server) -> None:
    with HostLink(serial.serial_for_url(server.url, 115200)) as link:
        link.write([(True, b"\1")])
        server.drop()
        with pytest.raises(LinkLostError):
            link.write([(True, b"\2")])
        link.write(whole(PICTURE))
        assert server.panel.ram == PICTURE
