"""The whole path: a script draws, the panel plans, the link carries, the firmware writes, the simulated chip shows."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from emulated import HZ, Board, BoardPort, built
from simulated import Noise, SimulatedPort

from paneldraw import Panel, simulator
from paneldraw.controllers import CHIPS, SSD1306, SSD1322
from paneldraw.demos.scenes import SCENES
from paneldraw.errors import PanelDisconnectedError, PanelNotFoundError, PanelTimeoutError
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


SPI_PIXEL = {"ssd1306": 4, "sh1106": 4, "ssd1322": 9, "max7219": 16, "pcd8544": 3}


class Wire:
    """What lies between the board's pins and a simulated chip: counts bytes and resets."""

    def __init__(self, chip: Any) -> None:
        self.chip = chip
        self.bytes = self.resets = 0

    def transfer(self, run: bytes, data: bool) -> None:
        self.bytes += len(run)
        self.chip.transfer(run, data)

    def deselect(self) -> None:
        self.chip.deselect()

    def reset(self) -> None:
        self.resets += 1
        self.chip.reset()


@pytest.fixture(scope="module", params=SPI_PIXEL)
def spi_binaries(request: pytest.FixtureRequest) -> tuple[Path, Path]:
    size = {"SIZE": "64x8"} if request.param == "max7219" else {}
    return built(BUS="spi", CHIP=request.param, **size)


@pytest.fixture
def spi_board(spi_binaries: tuple[Path, Path]) -> Iterator[Board]:
    board = Board(*spi_binaries)
    board.run(HZ // 20)
    yield board
    board.close()


def on_spi(board: Board, baudrate: int | None = None, noise: Noise | None = None) -> tuple[BoardPort, Wire, Panel]:
    """Return the panel that the board says it has, and the simulated chip on the board's pins."""
    port = BoardPort(board, noise=noise, seed=3)
    transport = SerialTransport(port, baudrate, clock=port.clock)
    said = transport.device
    port.spi = wire = Wire(getattr(simulator, said.controller.upper())(said.width, said.height))
    return port, wire, Panel(CHIPS[said.controller](said.width, said.height), transport)


def noise_pictures(panel: Panel, count: int) -> Iterator[np.ndarray]:
    rng = np.random.default_rng(4)
    for _ in range(count):
        yield rng.integers(0, 2**panel.depth, (panel.height, panel.width), np.uint8)


@pytest.mark.parametrize("baudrate", [115_200, 500_000, 1_000_000])
@pytest.mark.parametrize("noise", [None, Noise(0.001, 0.001, 0.001)], ids=["clean", "noisy"])
def test_pictures_on_spi_by_the_emulated_chip(spi_board: Board, baudrate: int, noise: Noise | None) -> None:
    port, wire, panel = on_spi(spi_board, baudrate, noise)
    with panel:
        for picture in noise_pictures(panel, 3):
            panel.show(picture)
            port.read()
            np.testing.assert_array_equal(wire.chip.pixels, picture)
        for number in range(4):
            picture = draw(panel, number)
            port.read()
            np.testing.assert_array_equal(wire.chip.pixels, picture)
        assert panel.stats.retries == 0
    assert (wire.chip.violations, wire.chip.remarks) == ([], [])
    assert wire.resets == 1


def test_a_pixel_on_spi_by_the_emulated_chip(spi_board: Board) -> None:
    port, wire, panel = on_spi(spi_board, 500_000)
    (picture,) = noise_pictures(panel, 1)
    with panel:
        panel.show(picture)
        for x, y in ((panel.width - 1, panel.height - 1), (0, 0), (panel.width // 2, panel.height // 2 - 1)):
            picture[y, x] ^= 1
            port.read()
            before, start = wire.bytes, port.clock()
            report = panel.show(picture)
            assert report.wire_bytes <= SPI_PIXEL[panel.controller.name] + 9
            assert port.clock() - start < 0.0015
            port.read()
            assert wire.bytes - before <= SPI_PIXEL[panel.controller.name]
            np.testing.assert_array_equal(wire.chip.pixels, picture)


@pytest.mark.parametrize("fault", ["reset", "power", "watchdog"])
def test_a_restart_in_the_middle_of_a_picture_on_spi(spi_board: Board, fault: str) -> None:
    port, wire, panel = on_spi(spi_board, 115_200)
    first, second = noise_pictures(panel, 2)
    transfer, left = wire.transfer, [-1]

    def restarting(run: bytes, data: bool) -> None:
        left[0] -= 1
        if left[0] == 0 and fault == "watchdog":
            spi_board.hang()
        elif left[0] == 0:
            spi_board.reset(power=fault == "power")
        transfer(run, data)

    wire.transfer = restarting  # type: ignore[method-assign]
    with panel:
        panel.show(first)
        resets, left[0] = wire.resets, 3
        panel.show(second)
        port.read()
        np.testing.assert_array_equal(wire.chip.pixels, second)
        assert panel.stats.retries == 1
    assert left[0] < 0
    assert wire.resets == resets + 2  # by the board at its start, and by the panel's


def test_a_chip_that_is_on_spi_alone_is_refused_behind_a_board_with_i2c(board: Board) -> None:
    port = BoardPort(board)
    with pytest.raises(ValueError, match=r"I2C reaches.*ssd1322 is on SPI"):
        Panel(SSD1322(), SerialTransport(port, clock=port.clock))


@pytest.mark.parametrize("end", ["reference", "emulated"])
def test_a_panel_that_lost_its_power_for_a_moment_is_started_again(
    request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch, end: str
) -> None:
    chip = simulator.SSD1306(128, 64)
    port: BoardPort | SimulatedPort
    if end == "emulated":
        port = BoardPort(request.getfixturevalue("board"))
        port.status = lambda: chip.read(1)[0]
    else:
        port = SimulatedPort()
        port.device.read = lambda: chip.read(1)[0]
    port.panel = chip.write
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        checked(panel, port, chip)
        monkeypatch.setattr("paneldraw.driver._LOOK", 0.0)
        chip.power_cycle()
        picture = draw(panel, 3)
        port.read()
        np.testing.assert_array_equal(chip.pixels, picture)
        assert (panel.stats.restarts, panel.stats.retries) == (1, 0)
        checked(panel, port, chip)
        assert panel.stats.restarts == 1


def test_a_panel_that_says_nothing_of_itself_is_missed_while_nothing_is_sent(board: Board) -> None:
    port = BoardPort(board)
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        checked(panel, port, chip)
        board.panel(absent=True)
        board.run(board.cycle + 3 * HZ // 2)
        board.panel()
        chip.power_cycle()
        checked(panel, port, chip)
        assert (panel.stats.restarts, panel.stats.retries) == (1, 1)


def test_a_panel_that_misses_an_acknowledge_is_served_again_in_the_same_show(board: Board) -> None:
    port = BoardPort(board)
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    with Panel(SSD1306(128, 64), SerialTransport(port, clock=port.clock)) as panel:
        checked(panel, port, chip)
        board.panel(nack_after=3)
        read = port.read

        def well_again(size: int = 1) -> bytes:
            came = read(size)
            if panel.stats.retries:
                board.panel()
            return came

        port.read = well_again  # type: ignore[method-assign]
        checked(panel, port, chip)
        assert panel.stats.faults == {"ENXIO": panel.stats.retries}


@pytest.mark.parametrize("timeout", [0.5, 2.0])
def test_the_timeout_bounds_a_show(timeout: float) -> None:
    port = SimulatedPort()
    chip = simulator.SSD1306(128, 64)
    port.panel = chip.write
    with Panel(SSD1306(128, 64), SerialTransport(port, timeout=timeout, clock=port.clock)) as panel:
        checked(panel, port, chip)
        port.mangle = lambda replies: b""
        for error in (PanelTimeoutError, PanelNotFoundError, PanelNotFoundError):
            start = port.now
            with pytest.raises(error):
                draw(panel, 1)
            assert port.now - start < timeout + 0.1
        port.mangle = lambda replies: replies
        checked(panel, port, chip)
