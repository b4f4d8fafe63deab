"""CPU time that a simulated chip and its bus take for a full frame, every pixel changed, as our driver sends it."""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median
from typing import Any

import measure
import numpy as np
from smbus2 import i2c_msg

from paneldraw import Panel, controllers, simulator
from paneldraw.transports import I2CTransport, SPITransport

WANTED = 200.0
"""Microseconds."""


class Tape:
    """Takes what a driver sends over I2C or SPI, and plays it to a simulated bus."""

    def __init__(self) -> None:
        self.calls: list[tuple[str, tuple[Any, ...]]] = []

    def i2c_rdwr(self, *messages: Any) -> None:
        """Keep copies of messages."""
        self.calls.append(("i2c_rdwr", tuple(i2c_msg.write(message.addr, bytes(message)) for message in messages)))

    def writebytes2(self, values: Any) -> None:
        """Keep bytes."""
        self.calls.append(("writebytes2", (bytes(values),)))

    def set(self, line: int, value: bool) -> None:
        """Keep the level of a line."""
        self.calls.append(("set", (line, value)))

    def cut(self) -> list[tuple[str, tuple[Any, ...]]]:
        """What came since the last cut."""
        kept, self.calls = self.calls, []
        return kept


def reels(name: str) -> Iterator[tuple[str, list[Any], list[Any]]]:
    """For each bus that a chip sits on, the calls that show one picture and those that show another, bound to it."""
    record, chip = controllers.CHIPS[name](), getattr(simulator, name.upper())
    address = controllers.CHIPS[name].address
    lines: dict[str, Any] = {"dc": None, "reset": None} if record.registers else {}
    noise = np.random.default_rng(1).integers(0, 2**record.depth, (record.height, record.width), np.uint8)
    inverse = (2**record.depth - 1) - noise
    for kind in record.buses:
        tape, twin = Tape(), chip(history=2)
        if kind == "spi":
            wired = {"dc": None} if record.synced else lines
            panel = Panel(record, SPITransport(spi=tape, pins=tape, **wired))
            wire = simulator.SPIBus(twin, timer=None, **wired)
            wire.spi.cshigh = record.synced
            doors: dict[str, Any] = {"writebytes2": wire.spi.writebytes2, "set": wire.pins.set}
        else:
            pair = {"data_address": address + 1} if kind == "i2c-pair" else {}
            panel = Panel(record, I2CTransport(tape, address, **pair))
            bus = simulator.I2CBus({address: twin} | ({address + 1: twin.data} if pair else {}), timer=None)
            doors = {"i2c_rdwr": bus.i2c_rdwr}
        parts = []
        for picture in (noise, inverse, noise, inverse):
            panel.show(picture)
            parts.append([(doors[door], sent) for door, sent in tape.cut()])
        for part, picture in zip(parts, (noise, inverse, noise, inverse), strict=True):
            for call, sent in part:
                call(*sent)
            assert np.array_equal(twin.pixels, picture)
        yield kind, parts[2], parts[3]


def run(rounds: int) -> None:
    """Print a row for every chip that both sides have, on every bus that it sits on."""
    for name in controllers.CHIPS:
        for kind, one, other in reels(name):
            statement = "for call, sent in one: call(*sent)\nfor call, sent in other: call(*sent)"
            timer = measure.Timer(statement, {"one": one, "other": other})
            taken = 1e6 * median(timer.sample() for _ in range(rounds)) / 2
            verdict = measure.VERDICTS.judge(f"{name} on {kind}", "at most 200 us", WANTED / taken, 1.0)
            print(f"  {name + ' on ' + kind:<44}{taken:9.3f} us   at most {WANTED:.0f}: {verdict}", flush=True)
