"""Greys behind a board: it keeps the sub-pictures, and writes them by itself while the host is silent."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from emulated import HZ, Board, BoardPort, built
from smbus2 import i2c_msg

from paneldraw import Panel, Supersample, simulator
from paneldraw.controllers import SSD1306
from paneldraw.transports import SerialTransport


@pytest.fixture
def board(binaries: tuple[Path, Path]) -> Iterator[Board]:
    board = Board(*binaries)
    board.run(HZ // 20)
    yield board
    board.close()


class Glass:
    """A simulated panel that takes transactions when the board's bus had carried them."""

    def __init__(self, port: BoardPort) -> None:
        self.port, self.chip = port, simulator.SSD1306(history=None)
        self.bus = simulator.I2CBus({0x3C: self.chip}, timer=port.clock)
        self.chip.remembers = True
        port.panel = self

    def __call__(self, content: bytes) -> None:
        self.bus.i2c_rdwr(i2c_msg.write(0x3C, content))

    def watch(self, seconds: float) -> None:
        """Let time pass, in which nobody asks the board."""
        board = self.port.board
        until = board.cycle + round(seconds * HZ)
        while board.cycle < until:
            board.run(board.cycle + HZ // 20_000)
            for content in board.transactions():
                self(content)


def opened(board: Board, baudrate: int = 500_000, greys: int = 4) -> tuple[Panel, Glass]:
    port = BoardPort(board)
    glass = Glass(port)
    return Panel(SSD1306(), SerialTransport(port, baudrate, clock=port.clock), greys=greys, contrast=255), glass


def clock(panel: Panel, turn: float = 1.1) -> np.ndarray:
    fb = panel.framebuffer()
    fb.circle(64, 32, 30, antialias=Supersample(4))
    for length, angle in ((18, turn), (26, 3 * turn)):
        fb.line(64, 32, 64 + length * np.cos(angle), 32 + length * np.sin(angle), antialias=Supersample(4))
    return fb.pixels.copy()


def error(glass: Glass, levels: np.ndarray) -> np.ndarray:
    return np.abs(glass.chip.seen(0.2) - levels / 3)


@pytest.mark.parametrize("baudrate", [115_200, 500_000])
def test_four_greys_by_the_emulated_chip(board: Board, baudrate: int) -> None:
    panel, glass = opened(board, baudrate)
    with panel:
        levels = clock(panel)
        panel.show(levels)
        panel.flush()
        sent = panel.transport.link.stats.bytes_sent
        glass.watch(0.5)
        found = error(glass, levels)
        assert panel.transport.link.stats.bytes_sent == sent
        assert (panel.stats.fewer_greys, panel.stats.cycled_by_host) == (0, 0)
        assert len(np.unique(levels)) == 4
        assert found.mean() < 0.03
        assert np.percentile(found, 99) < 0.08
        assert glass.chip.violations == []
    glass.watch(0.1)
    np.testing.assert_array_equal(glass.chip.pixels, levels >= 2)
    before = glass.chip.frames[-1]
    glass.watch(0.1)
    assert glass.chip.frames[-1] is before
