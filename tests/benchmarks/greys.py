"""Greys on a panel of one bit, on a simulated bus of 400 kHz and by a simulated eye: rate, error of the light, flicker.

Errors are of a pixel's light over 100 ms against its level, in percent of full light: over all pixels, and over those
that are gray; a slot that is off is one of a chip whose oscillator is. The last rows are what the sender's thread takes
here, and a call of `show` behind the drawing of its picture.
"""

from __future__ import annotations

import math
import resource
import time
from collections.abc import Callable, Iterator
from statistics import median
from typing import NamedTuple

import measure
import numpy as np
from numpy.typing import NDArray

from paneldraw import ConeFilter, Framebuffer, Panel, Supersample, simulator
from paneldraw.controllers import SSD1306
from paneldraw.cycling import Cycling
from paneldraw.demos.scenes import SCENES
from paneldraw.raster.blue_noise import thresholds
from paneldraw.transports import I2CTransport
from paneldraw.transports.base import Cost
from paneldraw.update.greys import EVEN, PACES, Choice, Cycle, Forecaster, choose, laid_out

CLOCK = 400_000
GREYS = 4
WINDOW = 0.1
LEAST_RATE, MOST_MEAN, MOST_99, LEAST_GAIN, MOST_CPU, MOST_SHOW = 49.0, 3.0, 8.0, 1.3, 5.0, 20.0
Levels = NDArray[np.uint8]


class Seen(NamedTuple):
    """What an eye saw: errors in percent, and the flicker of gray pixels."""

    mean: float
    most: float
    gray_mean: float
    gray_most: float
    flicker: float

    def __str__(self) -> str:
        return (
            f"mean {self.mean:4.1f} %, 99 % {self.most:4.1f} %; of grays {self.gray_mean:4.1f} %, "
            f"{self.gray_most:4.1f} %; flicker {self.flicker:.2f}"
        )


def wheel(fb: Framebuffer) -> None:
    """Sixteen anti-aliased spokes."""
    for number in range(16):
        turn = 2 * math.pi * (number / 16 + 0.01)
        x, y = math.cos(turn), math.sin(turn)
        fb.line(64 + 8 * x, 32 + 8 * y, 64 + 30 * x, 32 + 30 * y, antialias=ConeFilter())


def disc(fb: Framebuffer) -> None:
    """A large anti-aliased disc."""
    fb.circle(64, 32, 28, fill=True, antialias=Supersample(4))


def photograph(fb: Framebuffer) -> None:
    """Soft gradients with grain, in four levels."""
    y, x = np.mgrid[:64, :128]
    light = 1.5 + 1.5 * np.sin(x / 17) * np.cos(y / 13)
    fb.pixels[:] = np.clip(np.floor(light + np.tile(thresholds(), (1, 2)) / 256), 0, 3)


def scenes() -> Iterator[tuple[str, Levels]]:
    """Names and pictures, all drawn anti-aliased; scenes of text and straight boxes alone have no grey."""
    drawn: dict[str, Callable[[Framebuffer], None]] = {"wheel": wheel, "disc": disc, "photograph": photograph}
    drawn |= {name: lambda fb, scene=scene: scene(fb, 30) for name, scene in SCENES.items()}  # type: ignore[misc]
    for name, draw in drawn.items():
        fb = Framebuffer(128, 64, 2, antialias=Supersample(4))
        draw(fb)
        yield name, fb.pixels


def chosen(forecaster: Forecaster, levels: Levels, *, weighted: bool, clock: float = CLOCK) -> Choice | None:
    """The cycle for a picture, each sub-picture as long as a scan."""
    return choose(forecaster, levels, 3, GREYS, clock, weighted=weighted, paces=PACES["ssd1306"])


def look(levels: Levels, choice: Choice, seconds: float, drift: float = 1.0) -> Seen:
    """Have a panel send cycles, in slots that are off by a factor, and see how far the light is from the levels."""
    chip = simulator.SSD1306(history=1)
    chip.remembers = True
    bus = simulator.I2CBus({0x3C: chip}, CLOCK, timer=None)
    wanted = levels / 3
    gray = (levels > 0) & (levels < 3)
    weighted = choice.cycle.weighted
    full = 1.0
    if weighted:
        contrasts = EVEN.contrasts(choice.cycle.weights, 255)
        full = sum(contrasts) / len(contrasts) / 255
    errors = []
    with Panel(SSD1306(), I2CTransport(bus), contrast=255) as panel:
        wire = {"bus_share": 0.8, "bus_clock": CLOCK, "weighted": weighted, "updates": "least"}
        cycling = Cycling(panel._driver, panel.stats, GREYS, **wire)
        cycling.begin(choice, levels)
        began = now = bus.seconds
        next_look, turn = 0.3, 0
        while now - began < seconds:
            then = now
            now += choice.seconds[turn] * drift
            turn = (turn + 1) % len(choice.seconds)
            busy = bus.seconds
            cycling.turn()
            bus.idle(max(0.0, now - then - (bus.seconds - busy)))
            if now - began > next_look:
                errors.append(100 * np.abs(chip.seen(WINDOW) / full - wanted))
                next_look += 0.037
        found = np.array(errors)
        flicker = chip.flicker(min(seconds / 2, 1.0))[gray]
    grays = found[:, gray]
    return Seen(
        float(found.mean()),
        float(np.percentile(found, 99)),
        float(grays.mean()),
        float(np.percentile(grays, 99)),
        float(flicker.mean()),
    )


def run(rounds: int) -> None:
    """Print a row for every scene."""
    seconds = 0.6 if measure.SAMPLE == 0 else 1.5
    forecaster = Forecaster(SSD1306(), Cost(2, 2, 2, 8191))
    for name, levels in scenes():
        choices = {kind: chosen(forecaster, levels, weighted=kind == "weighted") for kind in ("equal", "weighted")}
        for kind, choice in choices.items():
            if choice is None:
                print(f"  {name + ', ' + kind:<22} takes more than the wire carries", flush=True)
            elif choice.seconds:
                _report(name, kind, levels, choice, seconds)
        weighted = choices["weighted"]
        if weighted and weighted.seconds and weighted.cycle.greys == GREYS:
            equal = laid_out(forecaster, Cycle(GREYS), levels, CLOCK, paces=PACES["ssd1306"])
            gain = weighted.rate / equal.rate
            verdict = measure.VERDICTS.judge(f"{name}, weighted", "cycles of equal ones", gain, LEAST_GAIN)
            print(f"{gain:>40.2f}x the cycles of {GREYS - 1} equal ones: {verdict}", flush=True)
    _sender(rounds)


def _report(name: str, kind: str, levels: Levels, choice: Choice, seconds: float) -> None:
    verdicts = ""
    seen = look(levels, choice, seconds)
    judge = measure.VERDICTS.judge
    if kind == "equal":
        row = f"{name}, {kind}"
        verdicts = f"mean {judge(row, 'mean error', MOST_MEAN / max(seen.mean, 1e-9), 1.0)}"
        verdicts += f", 99 % {judge(row, '99 % of errors', MOST_99 / max(seen.most, 1e-9), 1.0)}"
        if name == "clock":
            rate = choice.rate * (choice.cycle.greys == GREYS)
            verdicts += f", rate {judge(row, 'cycles a second', rate / LEAST_RATE, 1.0)}"
    way = "timed" if choice.cycle.timed else kind
    print(
        f"  {name + ', ' + way:<22}{choice.cycle.greys} greys {choice.forecast.wire_bytes:4} bytes; "
        f"{choice.rate:5.1f} cycles/s; error {seen}",
        flush=True,
    )
    for drift in (1.03, 1.1):
        print(f"{'slots off by ':>42}{drift - 1:3.0%}         error {look(levels, choice, seconds, drift)}")
    if verdicts:
        print(f"{'':<42}{verdicts}")


class Sink:
    """A bus that takes everything."""

    clock = CLOCK

    def i2c_rdwr(self, *messages: object) -> None:
        """Take messages."""

    def close(self) -> None:
        """Do nothing."""


def _sender(rounds: int) -> None:
    """What the thread takes of a core, and what a call of show takes."""
    bus = Sink()
    seconds = 0.2 if measure.SAMPLE == 0 else 2.0
    with Panel(SSD1306(), I2CTransport(bus), greys=GREYS) as panel:
        fb = panel.framebuffer()
        SCENES["clock"](fb, 30)
        panel.show(fb)
        panel.flush()
        before = resource.getrusage(resource.RUSAGE_SELF)
        time.sleep(seconds)
        after = resource.getrusage(resource.RUSAGE_SELF)
        share = 100 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime) / seconds
        verdict = measure.VERDICTS.judge("sender", "at most 5 % of a core", MOST_CPU / share, 1.0)
        print(f"  {'sender, with a bus that takes all':<44}{share:9.1f} % of a core  at most {MOST_CPU:.0f}: {verdict}")
        taken = []
        for number in range(20 * min(rounds, 5)):
            SCENES["clock"](fb, number)
            start = time.perf_counter()
            panel.show(fb)
            taken.append(1e6 * (time.perf_counter() - start))
            panel.flush()
        verdict = measure.VERDICTS.judge("show", "at most 20 us", MOST_SHOW / median(taken), 1.0)
        print(f"  {'show':<44}{median(taken):9.1f} us   at most {MOST_SHOW:.0f}: {verdict}", flush=True)
