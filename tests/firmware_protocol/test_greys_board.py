"""Greys behind a board: it keeps the sub-pictures, and writes them by itself while the host is silent."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from emulated import HZ, Board, BoardPort, built
from simulated import Noise, SimulatedPort
from smbus2 import i2c_msg

from firmware_protocol import HostLink
from firmware_protocol.cycle import pack_cycle
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
        port.panel, port.status = self, lambda: self.chip.status

    def __call__(self, content: bytes) -> None:
        self.bus.i2c_rdwr(i2c_msg.write(0x3C, content))

    def watch(self, seconds: float) -> None:
        """Let time pass, in which nobody asks the board."""
        board = self.port.board
        until = board.cycle + round(seconds * HZ)
        while board.cycle < until:
            board.run(board.cycle + HZ // 100_000)
            for content in board.transactions():
                self(content)


@pytest.fixture(autouse=True)
def nobody_looks(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have no thread look at the panel meanwhile: time here is the board's."""
    monkeypatch.setattr("paneldraw.cycling._LOOK", 3600.0)


def look(panel: Panel) -> None:
    """Do what the sender does once a second."""
    panel._driver.look_again()
    panel._cycling._due = 0.0
    panel._look_after()


def opened(board: Board, baudrate: int = 500_000, noise: Noise | None = None) -> tuple[Panel, Glass]:
    port = BoardPort(board, noise=noise, seed=5)
    glass = Glass(port)
    return Panel(SSD1306(), SerialTransport(port, baudrate, clock=port.clock), greys=4, contrast=255), glass


def clock(panel: Panel, turn: float = 1.1) -> np.ndarray:
    fb = panel.framebuffer()
    fb.circle(64, 32, 30, antialias=Supersample(4))
    for length, angle in ((18, turn), (26, 3 * turn)):
        fb.line(64, 32, 64 + length * np.cos(angle), 32 + length * np.sin(angle), antialias=Supersample(4))
    return fb.pixels.copy()


def error(glass: Glass, levels: np.ndarray, light: float = 1.0) -> np.ndarray:
    return np.abs(glass.chip.seen(0.2) - light * levels / 3)


def is_seen(glass: Glass, levels: np.ndarray, light: float = 1.0) -> bool:
    """Whether an eye sees the levels, and no flicker of whole sub-pictures."""
    glass.watch(0.3)
    found = error(glass, levels, light)
    return bool(found.mean() < 0.03 and np.percentile(found, 99) < 0.08)


def shown(panel: Panel, levels: np.ndarray) -> int:
    """Show a picture; return what the host sent for it."""
    before = panel.transport.link.stats.bytes_sent
    panel.show(levels)
    panel.flush()
    return int(panel.transport.link.stats.bytes_sent - before)


@pytest.mark.parametrize("baudrate", [115_200, 500_000])
def test_four_greys_by_the_emulated_chip(board: Board, baudrate: int) -> None:
    panel, glass = opened(board, baudrate)
    with panel:
        levels = clock(panel)
        shown(panel, levels)
        sent = panel.transport.link.stats.bytes_sent
        assert len(np.unique(levels)) == 4
        assert is_seen(glass, levels)
        assert panel.transport.link.stats.bytes_sent == sent
        assert (panel.stats.fewer_greys, panel.stats.cycled_by_host) == (0, 0)
        assert glass.chip.violations == []
        assert board.overruns == 0
    glass.watch(0.1)
    np.testing.assert_array_equal(glass.chip.pixels, levels >= 2)
    before = glass.chip.frames[-1]
    glass.watch(0.1)
    assert glass.chip.frames[-1] is before


def test_only_what_changes_is_sent(board: Board) -> None:
    panel, glass = opened(board)
    with panel:
        first, second = clock(panel), clock(panel)
        second[62:, 100:102] = 1
        whole = shown(panel, first)
        assert shown(panel, first) < 20
        assert shown(panel, second) < whole
        assert is_seen(glass, second)
        shown(panel, 3 * (second > 1).astype(np.uint8))
        glass.watch(0.1)
        before = glass.chip.frames[-1]
        glass.watch(0.1)
        assert glass.chip.frames[-1] is before
        assert shown(panel, second) > 0
        assert is_seen(glass, second)


def test_a_setting_and_sleep_within_a_cycle(board: Board) -> None:
    panel, glass = opened(board)
    with panel:
        levels = clock(panel)
        shown(panel, levels)
        glass.watch(0.03)
        panel.contrast(127)
        assert is_seen(glass, levels, 127 / 255)
        panel.sleep()
        glass.watch(0.1)
        before = glass.chip.frames[-1]
        glass.watch(0.3)
        assert glass.chip.frames[-1] is before
        panel.wake()
        assert is_seen(glass, levels, 127 / 255)


@pytest.mark.parametrize("trouble", ["reset", "power", "hang", "panel gone", "panel without power"])
def test_what_happens_within_a_cycle_heals_with_the_next_look(board: Board, trouble: str) -> None:
    panel, glass = opened(board)
    with panel:
        levels = clock(panel)
        shown(panel, levels)
        glass.watch(0.1)
        if trouble == "hang":
            board.hang()
        elif trouble in ("reset", "power"):
            board.reset(power=trouble == "power")
        else:
            board.panel(absent=True)
        if trouble in ("power", "panel without power"):
            glass.chip.power_cycle()
        glass.watch(1.0)
        board.panel()
        look(panel)
        assert is_seen(glass, levels)
        restarts = panel.stats.restarts
        assert restarts in (1, 2)
        look(panel)
        assert panel.stats.restarts == restarts
        assert is_seen(glass, levels)


def test_a_noisy_line_costs_no_grey(board: Board) -> None:
    panel, glass = opened(board, 115_200, Noise(0.001, 0.001, 0.001))
    with panel:
        for turn in range(3):
            levels = clock(panel, turn)
            shown(panel, levels)
            assert is_seen(glass, levels)
        assert panel.transport.link.stats.resent > 0


@pytest.mark.filterwarnings("ignore:a picture is shown")
def test_what_the_board_cannot_keep_is_counted(board: Board) -> None:
    panel, _ = opened(board, 1_000_000)
    with panel:
        levels = np.zeros((64, 128), np.uint8)
        levels[::8, :48] = 1
        choice, _ = panel._cycling.choose(levels, 3)
        assert choice.cycle.greys == 4
        assert panel.stats.cycled_by_host == 1
        choice, _ = panel._cycling.choose(np.random.default_rng(1).integers(0, 4, (64, 128), np.uint8), 3)
        assert choice is None
        assert (panel.stats.cycled_by_host, panel.stats.fewer_greys) == (1, 1)


def test_the_reference_device_cycles_as_well() -> None:
    port = SimulatedPort()
    chip = simulator.SSD1306(history=None)
    bus = simulator.I2CBus({0x3C: chip}, timer=port.clock)
    port.panel = lambda content: bus.i2c_rdwr(i2c_msg.write(0x3C, content))
    with Panel(SSD1306(), SerialTransport(port, clock=port.clock), greys=4) as panel:
        levels = clock(panel)
        shown(panel, levels)
        port.read()
        count = len(chip.frames)
        sent = panel.transport.link.stats.bytes_sent
        for _ in range(200):
            port.now += 0.001
            port.device.tick()
        assert len(chip.frames) > count + 15
        assert panel.transport.link.stats.bytes_sent == sent
        lit = np.mean([frame.pixels for frame in list(chip.frames)[-12:]], axis=0)
        assert set(np.round(lit[levels == 3], 2)) == {1.0}
        assert not lit[levels == 0].any()
    assert chip.violations == []


def times(board: Board, seconds: float) -> list[float]:
    """Return when the board begins to write sub-pictures."""
    until, found = board.cycle + round(seconds * HZ), []
    while board.cycle < until:
        board.run(board.cycle + HZ // 100_000)
        found += [board.cycle / HZ for content in board.transactions() if content == bytes.fromhex("00b00810")]
    return found


def test_the_frame_line_sets_the_pace() -> None:
    board = Board(*built("-DPD_FRAME_LINE=1"))
    board.run(HZ // 20)
    link = HostLink(port := BoardPort(board), clock=port.clock)
    assert link.device.frame_line
    pictures = [[(False, bytes.fromhex("b00810")), (True, bytes((byte,)))] for byte in (1, 2)]
    link.cycle(pack_cycle(pictures, (0.01, 0.02)), 2)
    board.transactions()
    for pace, wanted in ((0.0103, (0.0103, 0.0206)), (0.0, (0.0125, 0.025)), (0.0096, (0.0096, 0.0192))):
        board.frames(pace)
        times(board, 0.06)  # the first ones began at the old pace
        lasts = np.diff(times(board, 0.2))
        assert min(abs(lasts[0] - each) for each in wanted) < 5e-5
        np.testing.assert_allclose(np.sort(lasts[:6]), np.repeat(wanted, 3), atol=5e-5)
    board.close()
