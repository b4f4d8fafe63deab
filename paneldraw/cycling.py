"""Keeps the sub-pictures of a picture in greys going on a panel of one bit."""

from __future__ import annotations

import time
import warnings
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from paneldraw.update.greys import LEAST_RATE, PACES, STEADY, Choice, Cycle, Forecaster, Levels, choose

if TYPE_CHECKING:
    from paneldraw.driver import Driver
    from paneldraw.panel import Stats

_CLOCK: Final = 400_000.0
"""Bits a second of an I2C bus that does not say."""


class Cycling:
    """What a panel in greys shows, and which of its sub-pictures is next. It is for one thread at a time.

    Parameters
    ----------
    driver : Driver
    stats : Stats
        Where pictures with fewer greys are counted.
    greys : int
    bus_share : float
        How much of the wire the sub-pictures may take.
    bus_clock : float or None
        Bits a second of the wire. Default: what the bus says, else 400 000.

    Raises
    ------
    ValueError
        A chip that has greys of its own or is too slow, or a setting that does not exist.
    """

    def __init__(self, driver: Driver, stats: Stats, greys: int, bus_share: float, bus_clock: float | None) -> None:
        chip = driver.controller
        if chip.depth > 1:
            raise ValueError(
                f"greys must be 1 for the {chip.name}, which has {2**chip.depth} of its own, not {greys!r}"
            )
        Cycle(greys)
        if not 0 < bus_share <= 1:
            raise ValueError(f"bus_share must be above 0 and at most 1, not {bus_share!r}")
        if bus_clock is not None and not bus_clock > 0:
            raise ValueError(f"bus_clock must be Hz above 0, or None, not {bus_clock!r}")
        self._driver, self._stats, self.greys = driver, stats, greys
        self._bus_share, self._clock = bus_share, bus_clock or _bits_a_second(driver.transport)
        self._forecaster = Forecaster(chip, driver.cost)
        self._paces = [(command, chip.height * seconds) for command, seconds in PACES.get(chip.name, ())]
        self._sub_pictures: list[Levels] = []
        self._still: Levels = np.zeros((chip.height, chip.width), np.uint8)
        self._slot = self._due = 0.0
        self._turn = 0
        self._pace = b""

    @property
    def depth(self) -> int:
        """Bits a pixel of a picture."""
        return 2 if self.greys <= 4 else 4

    @property
    def going(self) -> bool:
        """Whether there is a sub-picture to come."""
        return self._slot > 0

    @property
    def within(self) -> bool:
        """Whether a cycle has begun and not ended."""
        return self.going and self._turn > 0

    @property
    def due(self) -> float:
        """When the next sub-picture is due, on the monotonic clock."""
        return self._due

    def choose(self, levels: Levels, max_level: int) -> tuple[Choice | None, Levels]:
        """Return the cycle for a picture, as the unturned glass has it, and the picture without grey."""
        choice = choose(
            self._forecaster,
            levels,
            max_level,
            self.greys,
            self._clock,
            bus_share=self._bus_share,
            paces=self._paces,
        )
        if choice is None or choice.cycle.greys < self.greys:
            self._say_fewer(choice)
        return choice, (2 * levels > max_level).astype(np.uint8)

    def begin(self, choice: Choice | None, levels: Levels, max_level: int, still: Levels) -> None:
        """Have the next turn be the first of a picture's."""
        self._still, self._turn = still, 0
        self._slot = choice.slot if choice else 0.0
        if choice is None or not choice.slot:
            self._sub_pictures = [still]
            return
        cycle = choice.cycle
        self._sub_pictures = list(cycle.pictures(cycle.steps(levels, max_level)))
        if choice.pace not in (b"", self._pace):
            self._driver.change(lambda: (STEADY, choice.pace))
            self._driver.kept = [command for command in self._driver.kept if command not in (STEADY, self._pace)]
            self._driver.kept += [STEADY, choice.pace]
            self._pace = choice.pace

    def turn(self, force: bool = False) -> tuple[int, int, int]:
        """Show the next sub-picture; return bytes on the wire, messages, changed bytes."""
        now = time.monotonic()
        self._due = max(self._due + self._slot, now)
        self._driver.pack(self._sub_pictures[self._turn], 1)
        self._turn = (self._turn + 1) % len(self._sub_pictures)
        return self._driver.show(force, time.perf_counter())

    def stop(self) -> None:
        """Have no sub-picture come."""
        self._slot = 0.0

    def settle(self) -> None:
        """Leave the picture without grey: the cycle has ended for good."""
        if self.going:
            self.begin(None, self._still, 1, self._still)
            self.turn()

    def _say_fewer(self, choice: Choice | None) -> None:
        self._stats.fewer_greys += 1
        if self._stats.fewer_greys == 1:
            used = choice.cycle.greys if choice else 2
            warnings.warn(
                f"a picture is shown in {used} greys instead of {self.greys}: the wire does not carry more "
                f"{LEAST_RATE:g} times a second; a faster bus does, or a picture with fewer gray edges",
                RuntimeWarning,
                stacklevel=2,
            )


def _bits_a_second(transport: Any) -> float:
    """What a wire carries, in bits of an I2C bus, of which a byte takes nine."""
    speed = getattr(transport, "speed", None)
    if speed:
        return float(speed) * 9 / 8
    rate = getattr(transport, "baudrate", None)
    if rate:
        return float(rate) * 9 / 10
    return float(getattr(getattr(transport, "bus", None), "clock", None) or _CLOCK)
