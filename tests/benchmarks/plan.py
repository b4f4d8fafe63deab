"""CPU time of a plan alone: from the shadow and a packed frame to messages, of an SSD1306 and an SSD1327 on I2C."""

from __future__ import annotations

import time
from statistics import median

import measure
import numpy as np
import numpy.typing as npt

from paneldraw.controllers import SSD1306, SSD1327, Controller
from paneldraw.transports import I2CTransport
from paneldraw.update import Planner

ROWS = [
    ("one byte changed", (1,), 10.0),
    ("noise, every byte", (), 60.0),
    (
        "2 to 1000 bytes here and there, the slowest",
        (2, 4, 6, 8, 12, 16, 20, 24, 28, 40, 60, 100, 200, 400, 1000),
        60.0,
    ),
]
CHIPS = {"SSD1306": SSD1306(), "SSD1327": SSD1327()}

Packed = npt.NDArray[np.uint8]


class Bus:
    """Only the wire's costs are asked for."""

    def i2c_rdwr(self, *messages: object) -> None:
        """Take messages."""


def times(planner: Planner, frames: tuple[Packed, Packed], count: int) -> float:
    """Median microseconds of a plan from one frame to the other and back."""
    taken = []
    for number in range(count + 2):
        planner.fresh[:] = frames[number % 2]
        start = time.process_time_ns()
        planner.plan()
        taken.append(time.process_time_ns() - start)
        planner.sent()
    return median(taken[2:]) / 1e3


def worst(controller: Controller, counts: tuple[int, ...], rounds: int) -> float:
    """The slowest of some pairs of frames that differ in so many bytes; without a number, in every one."""
    planner = Planner(controller, I2CTransport(Bus()).cost)
    planner.restart()
    slowest = 0.0
    for seed, count in enumerate(counts or (0,)):
        random = np.random.default_rng(seed)
        before = random.integers(0, 256, planner.fresh.shape, np.uint8)
        after = before.copy()
        if count:
            after.ravel()[random.choice(after.size, count, replace=False)] ^= 0xFF
        else:
            after += random.integers(1, 256, after.shape, np.uint8)
        slowest = max(slowest, times(planner, (before, after), rounds))
    return slowest


def run(rounds: int) -> None:
    """Print the table; the limits are for the 128 x 64 pixels of the SSD1306."""
    rounds = 20 * rounds if measure.SAMPLE else 2
    for name, counts, wanted in ROWS:
        cells = [f"{chip} {worst(controller, counts, rounds):8.2f} us " for chip, controller in CHIPS.items()]
        print(f"  {name:<44}{'   '.join(cells)}   (wanted of the SSD1306: at most {wanted:g})", flush=True)
