"""The whole path: a script draws, the panel plans, the link carries, the firmware writes, the simulated chip shows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from emulated import HZ, Board, BoardPort, built
from simulated import SimulatedPort

from firmware_protocol import HostLink, PanelFaultError
from paneldraw import Panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.transports.base import DATA, Cost, Plan


class LinkTransport:
    """As little as a panel needs of a link."""

    cost = Cost(command=1, data=1)

    def __init__(self, link: HostLink) -> None:
        self.link = link

    def command(self, payload: bytes) -> int:
        return self.link.write([(False, payload)], end=False)

    def data(self, payload: bytes) -> int:
        return self.link.write([(True, payload)], end=False)

    def batch(self, plan: Plan) -> int:
        return self.link.write((kind == DATA, payload) for kind, payload in plan)

    def close(self) -> None:
        self.link.close()


@pytest.fixture(scope="module")
def binaries(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return built(tmp_path_factory.mktemp("avr"))


@pytest.fixture
def board(binaries: tuple[Path, Path]) -> Iterator[Board]:
    board = Board(*binaries)
    board.run(HZ // 50)
    yield board
    board.close()


def draw(panel: Panel, number: int) -> np.ndarray:
    with panel.frame() as fb:
        fb.clear()
        fb.line(number, 0, 127 - 3 * number, 63)
        fb.text(f"frame {number}", 4, 50, 1)
        fb.rect(60, 5 + number, 40, 20, 1, True)
    return np.array(fb.pixels)


def checked(panel: Panel, port: BoardPort | SimulatedPort, chip: simulator.SSD1306) -> None:
    for number in range(8):
        picture = draw(panel, number)
        port.read()
        np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


def test_pictures_by_the_emulated_chip(board: Board) -> None:
    port = BoardPort(board)
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    link = HostLink(port, clock=port.clock)
    with Panel(SSD1306(128, 64), LinkTransport(link)) as panel:
        checked(panel, port, chip)
        board.panel(absent=True)
        with pytest.raises(PanelFaultError):
            draw(panel, 1)
        board.panel()
        chip.power_cycle()
        checked(panel, port, chip)
    assert not port.is_open


def test_pictures_by_the_reference_device() -> None:
    port = SimulatedPort()
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    link = HostLink(port, clock=port.clock)
    with Panel(SSD1306(128, 64), LinkTransport(link)) as panel:
        checked(panel, port, chip)
