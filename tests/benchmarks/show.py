"""CPU time to bring a 128 x 64 frame onto an SSD1306, on a bus that takes every byte and forgets it."""

from __future__ import annotations

import random
from typing import Any

import numpy as np
from measure import Against, Contest, Names, Row

from paneldraw import Framebuffer, Panel
from paneldraw.controllers import SSD1306
from paneldraw.transports import I2CTransport

WIDTH, HEIGHT = 128, 64
LUMA = "luma.oled"
ADAFRUIT = "Adafruit"


def row(name: str, one: str, other: str, over_luma: float | None, over_adafruit: float | None = None) -> Row:
    """Show two pictures in turn. What Adafruit's `show` sends is its own buffer, whatever is in it."""
    return Row(
        name,
        2,
        f"show({one}); show({other})",
        (
            Against(LUMA, f"display({one}_image); display({other}_image)", over_luma),
            Against(ADAFRUIT, "show(); show()", over_adafruit),
        ),
    )


ROWS = [
    row("every pixel changed", "noise", "inverse", 10),
    row("another picture", "lines", "circles", 10),
    row("one pixel changed", "lines", "lines_and_a_pixel", 20, 1 / 1.4),
    row("nothing changed", "lines", "lines", 20),
]


def pictures() -> dict[str, Framebuffer]:
    """Pairs of pictures: all pixels differ, some do, one does."""
    pick = random.Random(1)
    made = {name: Framebuffer(WIDTH, HEIGHT) for name in ("noise", "inverse", "lines", "circles", "lines_and_a_pixel")}
    made["noise"].pixels[:] = np.random.default_rng(1).integers(0, 2, (HEIGHT, WIDTH))
    made["inverse"].pixels[:] = 1 - made["noise"].pixels
    for _ in range(8):
        x1, y1, x2, y2 = (pick.randrange(size) for size in (WIDTH, HEIGHT) * 2)
        made["lines"].line(x1, y1, x2, y2)
        made["circles"].circle(x1, y1, 10)
    made["lines_and_a_pixel"].pixels[:] = made["lines"].pixels
    made["lines_and_a_pixel"].pixel(64, 32, 1, op="xor")
    return made


class Forgetful:
    """A bus that takes every message, with as much of smbus2's interface as the drivers use."""

    def __init__(self, number: int = 1) -> None:
        """The number is luma's to give."""

    def i2c_rdwr(self, *messages: Any) -> None:
        """Take messages."""

    def write_i2c_block_data(self, address: int, register: int, data: Any) -> None:
        """Take a short command."""

    def close(self) -> None:
        """Nothing to close."""


def names() -> Names:
    """The pictures, and the `show` of a panel."""
    return {**pictures(), "show": Panel(SSD1306(WIDTH, HEIGHT), I2CTransport(Forgetful())).show}


def luma() -> Names:
    """Opens its bus itself, as it writes whole messages only then; pictures as Pillow's, which it wants."""
    import smbus2
    from luma.core.interface.serial import i2c
    from luma.oled.device import ssd1306

    real = smbus2.SMBus
    smbus2.SMBus = Forgetful
    try:
        device = ssd1306(i2c(port=1), WIDTH, HEIGHT)
    finally:
        smbus2.SMBus = real
    device.persist = True
    return {"display": device.display} | {f"{name}_image": fb.to_image() for name, fb in pictures().items()}


def adafruit() -> Names:
    """Sends its own buffer through the layers that Blinka has on Linux, down to the write to the bus's file."""
    import adafruit_ssd1306
    from Adafruit_PureIO import smbus

    class File:
        def write(self, data: Any) -> None:
            """Take bytes."""

        def close(self) -> None:
            """Nothing to close."""

    class Bus(smbus.SMBus):  # type: ignore[misc]
        def _select_device(self, address: int) -> None:
            """Spare the system call, as the write spares it."""

    class Wire:
        def __init__(self) -> None:
            self.bus = Bus()
            self.bus._device = File()

        def try_lock(self) -> bool:
            return True

        def unlock(self) -> None:
            """Nobody else asks."""

        def writeto(self, address: int, buffer: Any, *, start: int = 0, end: int | None = None) -> None:
            self.bus.write_bytes(address, memoryview(buffer)[start:end])

    return {"show": adafruit_ssd1306.SSD1306_I2C(WIDTH, HEIGHT, Wire()).show}


def run(rounds: int) -> None:
    """Print the group's rows."""
    contest = Contest(names(), {LUMA: luma, ADAFRUIT: adafruit}, rounds)
    for contest_row in ROWS:
        contest.run(contest_row)
