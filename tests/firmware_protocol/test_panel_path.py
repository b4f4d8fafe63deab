"""The whole path: a script draws, the panel plans, the link carries, the firmware writes, the simulated chip shows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from emulated import HZ, Board, BoardPort
from simulated import SimulatedPort

from paneldraw import Panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.demos.scenes import SCENES
from paneldraw.errors import PanelDisconnectedError
from paneldraw.transports import SerialTransport


@pytest.fixture
def board(binaries: tuple[Path, Path]) -> Iterator[Board]:
    board = Board(*binaries)
    board.run(HZ // 20)
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
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        checked(panel, port, chip)
        board.panel(absent=True)
        with pytest.raises(PanelDisconnectedError, match="wiring"):
            draw(panel, 1)
        board.panel()
        chip.power_cycle()
        checked(panel, port, chip)
    assert not port.is_open


def test_pictures_by_the_reference_device() -> None:
    port = SimulatedPort()
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        checked(panel, port, chip)


def test_a_pixel_and_nothing_by_the_emulated_chip(board: Board) -> None:
    port = BoardPort(board)
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    picture = np.random.default_rng(1).integers(0, 2, (64, 128), np.uint8)
    with Panel(SSD1306(128, 64), SerialTransport(port, 500_000, clock=port.clock)) as panel:
        for whole in (True, False, False, True, True):
            if whole:  # sent in another addressing mode than a pixel
                picture ^= 1
                panel.show(picture)
                panel.show(picture ^ 1)
                panel.show(picture)
            for x, y in ((127, 63), (0, 0), (64, 31)):
                picture[y, x] ^= 1
                start = port.clock()
                assert panel.show(picture).wire_bytes <= 13
                assert port.clock() - start < 0.0015  # the board's time, not this machine's
                assert panel.show(picture).unchanged
                port.read()
                np.testing.assert_array_equal(chip.pixels, picture)
    assert chip.violations == []


@pytest.mark.thorough
def test_scenes_by_the_emulated_chip_in_frames_a_second(binaries: tuple[Path, Path]) -> None:
    seconds = 0.0
    for scene in SCENES.values():
        board = Board(*binaries)
        board.run(HZ // 20)
        port = BoardPort(board)
        chip = simulator.SSD1306(128, 64, history=1)
        port.panel = chip.write
        with Panel(SSD1306(128, 64), SerialTransport(port, 115_200, clock=port.clock)) as panel:
            fb = panel.framebuffer()
            for number in range(31):
                scene(fb, number)
                start = port.clock()
                panel.show(fb)
                seconds += (port.clock() - start) * (number > 0)
                port.read()
                np.testing.assert_array_equal(chip.pixels, fb.pixels)
        assert chip.violations == []
        board.close()
    assert 30 * len(SCENES) / seconds > 60


@pytest.mark.parametrize("fault", ["reset", "power", "watchdog"])
def test_a_restart_in_the_middle_of_a_picture_of_the_emulated_chip(board: Board, fault: str) -> None:
    port = BoardPort(board)
    chip = simulator.SSD1306(128, 64)
    left = [-1]

    def restarting(content: bytes) -> None:
        left[0] -= 1
        if left[0] == 0:
            if fault == "watchdog":
                board.hang()
            else:
                board.reset(power=fault == "power")
                chip.power_cycle()
        else:
            chip.write(content)

    port.panel = restarting
    noise = np.random.default_rng(1).integers(0, 2, (64, 128), np.uint8)
    with Panel(SSD1306(128, 64), SerialTransport(port, 115_200, clock=port.clock)) as panel:
        panel.show(noise)
        left[0] = 3
        panel.show(1 - noise)
        port.read()
        np.testing.assert_array_equal(chip.pixels, 1 - noise)
        assert panel.stats.retries == 1
    assert left[0] < 0
