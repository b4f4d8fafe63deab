"""A panel on a bad wire, in simulated time: ``python tests/bad_wire.py 168`` runs a week of hours and says how it went.

30 frames a second go to an SSD1306 on I2C at 400 kHz. One message in a hundred fails, in one of all the ways there are,
those of recoveries included, and the supply is cut for a moment once an hour.
"""

from __future__ import annotations

import argparse
import errno
import gc
import random
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from unittest import mock

import numpy as np

from paneldraw import Panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.errors import PanelError
from paneldraw.transports import I2CTransport

FPS = 30
#: What the kernel says of a transfer that failed; 0 is one that ends early without an error.
CODES = (errno.EREMOTEIO, errno.ENXIO, errno.EIO, errno.ETIME, errno.EAGAIN, errno.EBUSY, errno.ETIMEDOUT, 0)


class Clock:
    """Stands in for the module `time`: time passes as it is told to."""

    def __init__(self):
        self.now = 1.0

    def perf_counter(self):
        return self.now

    monotonic = perf_counter

    def sleep(self, seconds):
        self.now += seconds


class BadBus(simulator.I2CBus):
    """A bus on which each message fails with a given probability, and whose transfers take their time on a clock."""

    def __init__(self, devices, rate, clock, seed):
        super().__init__(devices, timer=None)
        self.rate, self.clock_of_time, self.random = rate, clock, random.Random(seed)

    def i2c_rdwr(self, *messages):
        self.clear_faults()
        pick = self.random
        for place in range(len(messages)):
            if pick.random() < self.rate:
                # Of a message nothing arrives, not even its address, or some of it, or all.
                reach = pick.choice((None, pick.randrange(40), 1 << 16))
                self.fail(pick.choice(CODES), after=place, at_byte=reach)
        before = self.seconds
        try:
            return super().i2c_rdwr(*messages)
        finally:
            self.clock_of_time.now += self.seconds - before


@dataclass
class Outcome:
    """What a run saw; `dark` is seconds."""

    frames: int = 0
    wrong: int = 0
    errors: int = 0
    cuts: int = 0
    dark: float = 0.0
    longest_dark: float = 0.0
    late: int = 0
    retries: int = 0
    faults: Counter = field(default_factory=Counter)
    blocks: list[int] = field(default_factory=list)

    @property
    def grown(self):
        """By how many blocks of Python's memory there are more, since what is made once was made."""
        return self.blocks[-1] - self.blocks[0] if self.blocks else 0

    def __str__(self):
        kinds = ", ".join(f"{kind} {count}" for kind, count in sorted(self.faults.items()))
        return (
            f"{self.frames / FPS / 3600:.2f} h, {self.frames:,} frames: {self.wrong} wrong pictures, "
            f"{self.errors} exceptions; {self.cuts} power cuts, dark for {self.dark:.1f} s in all and "
            f"{self.longest_dark:.2f} s at most; {self.retries:,} retries, {self.late} frames late; "
            f"{self.grown} blocks of memory more\n  faults: {kinds}"
        )


def run(hours, *, seed=7, rate=0.01, cut_every=3600.0, say=None):
    """Animate for so many hours; `say` is given the outcome so far once in six simulated hours."""
    clock, outcome = Clock(), Outcome()
    chip = simulator.SSD1306(seed=seed, history=1)
    bus = BadBus({0x3C: chip}, 0.0, clock, seed)
    pick = random.Random(seed)
    with mock.patch("paneldraw.panel.time", clock), mock.patch("paneldraw.driver.time", clock):
        panel = Panel(SSD1306(), I2CTransport(bus))
        bus.rate = rate
        start, next_cut, cut_at = clock.now, clock.now + cut_every / 2, None
        frame = np.zeros((64, 128), np.uint8)
        for number in range(int(hours * 3600 * FPS)):
            beat = start + number / FPS
            outcome.late += clock.now > beat + 1 / FPS
            clock.now = max(clock.now, beat)
            if clock.now >= next_cut:
                chip.power_cycle()
                outcome.cuts += 1
                next_cut, cut_at = next_cut + cut_every, clock.now
            draw(frame, number, pick)
            try:
                panel.show(frame)
            except PanelError:
                outcome.errors += 1
                continue
            if chip.registers.on:
                outcome.wrong += not np.array_equal(chip.pixels, frame)
                if cut_at is not None:
                    dark, cut_at = clock.now - cut_at, None
                    outcome.dark += dark
                    outcome.longest_dark = max(outcome.longest_dark, dark)
            elif cut_at is None:
                outcome.wrong += 1
            if number % (FPS * 900) == FPS * 300:
                gc.collect()
                outcome.blocks[1:] = [sys.getallocatedblocks()]
            if say is not None and number % (FPS * 21_600) == FPS * 21_600 - 1:
                say(taken(outcome, number + 1, panel))
    return taken(outcome, number + 1, panel)


def taken(outcome, frames, panel):
    """The outcome with what the panel counted."""
    outcome.frames, outcome.retries = frames, panel.stats.retries
    outcome.faults = Counter(panel.stats.faults)
    return outcome


def draw(frame, number, pick):
    """Change a little in most frames, nothing in some, and all now and then."""
    if number % 16 == 0:
        return
    y, x = pick.randrange(64), pick.randrange(120)
    frame[y, x : x + 8] ^= 1
    if number % 1024 == 1:
        frame[...] = np.frombuffer(pick.randbytes(64 * 128), np.uint8).reshape(64, 128) & 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("hours", type=float, nargs="?", default=168.0)
    parser.add_argument("--seed", type=int, default=7)
    arguments = parser.parse_args()
    begun = time.monotonic()
    outcome = run(arguments.hours, seed=arguments.seed, say=lambda so_far: print(so_far, flush=True))
    seconds = time.monotonic() - begun
    print(f"{outcome}\n  in {seconds:.0f} s, {outcome.frames / seconds:,.0f} frames a second")


if __name__ == "__main__":
    main()
