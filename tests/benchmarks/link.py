"""The serial link: the real host side against the real firmware on an emulated ATmega328P, in simulated time.

Simulated figures are the same on every machine. Needs what `tests/firmware_protocol` needs: avr-gcc and libsimavr.
"""

from __future__ import annotations

import contextlib
import os
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import mean, median
from typing import TYPE_CHECKING

import measure
import numpy as np
import numpy.typing as npt
from scenes import FRAMES, frames

from paneldraw import Panel, simulator
from paneldraw.controllers import CHIPS, SSD1306
from paneldraw.demos.scenes import SCENES
from paneldraw.transports import SerialTransport

sys.path.insert(0, str(Path(__file__).parents[1] / "firmware_protocol"))

if TYPE_CHECKING:
    from emulated import Board, BoardPort
    from simulated import Noise

MakeBoard = Callable[[], "Board"]

CPU_WANTED = 150
PIXEL_BYTES, PIXEL_MS = 13, 1.5
SPI_PIXEL_BYTES = {"sh1106": 13, "ssd1322": 18}
SCENES_AT, SCENES_WANTED = 115_200, 60
NOISE_WANTED = 2.2
EACH = 0.001
SCREENS = 200


def run(rounds: int) -> None:
    """Print the figures; ``rounds`` counts for the one that a clock measures."""
    host_cpu(rounds)
    import pytest
    from emulated import HZ, Board, built
    from simulated import Noise

    def maker(**settings: str) -> MakeBoard:
        binaries = built(**settings)

        def board() -> Board:
            fresh = Board(*binaries)
            fresh.run(HZ // 20)
            return fresh

        return board

    try:
        board = maker()
    except pytest.skip.Exception as missing:
        print(f"  without the emulated chip: {missing}")
        return
    for baudrate, wanted in ((115_200, 10.5), (500_000, 33.0), (1_000_000, None)):
        whole_pictures(board, baudrate, wanted)
    for baudrate in (115_200, 500_000):
        pixels(board, baudrate, PIXEL_BYTES)
    scenes(board)
    kinds = {
        "flipped": Noise(flip=EACH),
        "dropped": Noise(drop=EACH),
        "inserted": Noise(insert=EACH),
        "together": Noise(EACH, EACH, EACH),
    }
    for baudrate in (115_200, 500_000):
        for name, noise in kinds.items():
            noisy(board, baudrate, name, noise)
    for chip, wanted_bytes in SPI_PIXEL_BYTES.items():
        board = maker(BUS="spi", CHIP=chip)
        print(f"  {chip} on the board's SPI:")
        for baudrate in (115_200, 500_000, 1_000_000):
            whole_pictures(board, baudrate, None)
        pixels(board, 500_000, wanted_bytes)


class Screen:
    """The panel that the emulated board says it has, and the simulated chip behind the board."""

    def __init__(self, board: Board, baudrate: int, noise: Noise | None) -> None:
        from emulated import BoardPort

        self.port: BoardPort = BoardPort(board, noise=noise, seed=5)
        transport = SerialTransport(self.port, baudrate, clock=self.port.clock)
        said = transport.device
        size = said.width, said.height
        self.chip = getattr(simulator, said.controller.upper())(*size, history=1)
        self.port.panel, self.port.spi = self.chip.write, self.chip
        self.panel = Panel(CHIPS[said.controller](*size), transport)

    def random_pictures(self, count: int) -> list[npt.NDArray[np.uint8]]:
        """Pictures of noise, the same in each run."""
        shape = count, self.panel.height, self.panel.width
        return list(np.random.default_rng(2).integers(0, 2**self.panel.depth, shape, np.uint8))

    def shows(self, picture: npt.NDArray[np.uint8]) -> bool:
        """Whether an eye would see the picture."""
        self.port.read()
        return np.array_equal(self.chip.pixels, picture)

    def show(self, picture: npt.NDArray[np.uint8]) -> tuple[int, float]:
        """Show a picture; return bytes on the wire and seconds of the board's time."""
        start = self.port.clock()
        sent = self.panel.show(picture).wire_bytes
        return sent, self.port.clock() - start

    def show_all(self, pictures: list[npt.NDArray[np.uint8]]) -> float:
        """Show pictures one after the other, see that the last is there, and return frames a second."""
        seconds = sum(self.show(picture)[1] for picture in pictures)
        if not self.shows(pictures[-1]):
            raise RuntimeError("the panel shows another picture")
        return len(pictures) / seconds


@contextlib.contextmanager
def screen(board: MakeBoard, baudrate: int, noise: Noise | None = None) -> Iterator[Screen]:
    """A new board with a panel on it, until it is done with."""
    made = board()
    one = Screen(made, baudrate, noise)
    yield one
    one.panel.close()
    made.close()


def whole_pictures(board: MakeBoard, baudrate: int, wanted: float | None) -> None:
    """Print random whole pictures a second, and how much of the wire they take."""
    with screen(board, baudrate) as one:
        first, *pictures = one.random_pictures(31 if measure.SAMPLE else 4)
        one.show(first)
        rate = one.show_all(pictures)
        size = first.size * one.panel.depth // 8
    aim = f" (wanted {wanted})" if wanted else ""
    share = 100 * rate * size / (baudrate / 10)
    print(f"  {baudrate:>9} baud: {rate:5.2f} random pictures/s{aim}, {share:.0f} % of the wire")


def pixels(board: MakeBoard, baudrate: int, wanted: int) -> None:
    """Print what single pixels take, those right after a whole picture included."""
    pick = np.random.default_rng(3)
    trips = []
    with screen(board, baudrate) as one:
        for picture in one.random_pictures(20 if measure.SAMPLE else 2):
            one.show(picture)
            for _ in range(5):
                picture[pick.integers(one.panel.height), pick.integers(one.panel.width)] ^= 1
                trips.append(one.show(picture))
        if not one.shows(picture):
            raise RuntimeError("the panel shows another picture")
    sizes, seconds = zip(*trips, strict=True)
    aim = f" (wanted {PIXEL_MS})" if baudrate == 500_000 else ""
    print(
        f"  {baudrate:>9} baud: one pixel {min(sizes)} to {max(sizes)} bytes (wanted {wanted}), "
        f"round trip {1000 * median(seconds):.2f}, at most {1000 * max(seconds):.2f} ms{aim}"
    )


def scenes(board: MakeBoard) -> None:
    """Print frames a second of the ten scenes; a show returns when the panel's bus has acknowledged the frame."""
    count = FRAMES if measure.SAMPLE else 12
    rates = {}
    for name, scene in SCENES.items():
        first, *rest = (np.array(fb.pixels) for fb in frames(scene, count))
        with screen(board, SCENES_AT) as one:
            one.show(first)
            rates[name] = one.show_all(rest)
    print(f"  {SCENES_AT:>9} baud: " + ", ".join(f"{name} {rate:.0f}" for name, rate in rates.items()) + " frames/s")
    overall = 1 / mean(1 / rate for rate in rates.values())
    print(
        f"  ten scenes: {overall:.0f} frames/s over all frames, mean of the scenes {mean(rates.values()):.0f} "
        f"(wanted {SCENES_WANTED})"
    )


def noisy(board: MakeBoard, baudrate: int, name: str, noise: Noise) -> None:
    """Print how many screens come right over a noisy line, and what they cost on the wire, both ways."""
    count = SCREENS if measure.SAMPLE else 4

    def cost(noise: Noise | None, count: int) -> tuple[int, float]:
        with screen(board, baudrate, noise) as one:
            before = one.port.carried
            right = 0
            for picture in one.random_pictures(count):
                one.show(picture)
                right += one.shows(picture)
            return right, (one.port.carried - before) / count

    _, once = cost(None, min(count, 10))
    right, each = cost(noise, count)
    print(
        f"  {baudrate:>9} baud: 1 in 1000 bytes {name}: {right} of {count} screens right, "
        f"wire cost {each / once:.2f} (wanted {NOISE_WANTED})"
    )


def host_cpu(rounds: int) -> None:
    """Print the host's CPU time for `show` of one pixel, the device in a process of its own on a pseudo-terminal."""
    if not hasattr(os, "fork"):
        print("  host CPU for one pixel: no pseudo-terminals here")
        return
    with device_process() as name, Panel(SSD1306(128, 64), SerialTransport(name)) as panel:
        picture = np.zeros((64, 128), np.uint8)
        panel.show(picture)
        samples = []
        for _ in range(rounds):
            start = time.process_time()
            for place in range(200):
                picture[place % 64, 37 * place % 128] ^= 1
                panel.show(picture)
            samples.append((time.process_time() - start) / 200)
    print(f"  host CPU to show one pixel: {1e6 * median(samples):.0f} us (wanted {CPU_WANTED})")


@contextlib.contextmanager
def device_process() -> Iterator[str]:
    """A pseudo-terminal with the reference device on its far end, in a child process; gives the name of ours."""
    import pty
    import tty

    from firmware_protocol import Device

    far, near = pty.openpty()
    tty.setraw(near)
    child = os.fork()
    if child == 0:
        device = Device(lambda content: None)
        try:
            while True:
                os.write(far, device.receive(os.read(far, 4096)))
        finally:
            os._exit(0)
    os.close(far)
    try:
        yield os.ttyname(near)
    finally:
        os.kill(child, 9)
        os.waitpid(child, 0)
        os.close(near)
