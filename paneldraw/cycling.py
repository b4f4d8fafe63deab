"""Keeps the sub-pictures of a picture in greys going on a panel of one bit."""

from __future__ import annotations

import math
import time
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from paneldraw.onboard import board_of
from paneldraw.update.greys import (
    GREYS,
    LEAST_RATE,
    PACES,
    RESPONSES,
    Choice,
    Cycle,
    Forecaster,
    Levels,
    Pace,
    Response,
    choose,
    in_greys,
)

if TYPE_CHECKING:
    from paneldraw.controllers import Controller
    from paneldraw.driver import Driver
    from paneldraw.panel import Stats

_CLOCK: Final = 400_000.0
"""Bits a second of an I2C bus that does not say."""
_LOOK: Final = 1.0
"""Seconds between two looks at a panel whose board cycles by itself."""


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
    weighted : bool or sequence of float
        Whether the contrast makes sub-pictures worth more than others; or the light at each contrast.
    updates : str
        As `Panel` has it.

    Attributes
    ----------
    boarded : bool
        Whether a board writes the sub-pictures by itself.

    Raises
    ------
    ValueError
        A chip that has greys of its own, too many for the chip or the wire, or a setting that does not exist.
    """

    def __init__(
        self,
        driver: Driver,
        stats: Stats,
        greys: int,
        *,
        bus_share: float,
        bus_clock: float | None,
        weighted: bool | Sequence[float],
        updates: str,
    ) -> None:
        chip = driver.controller
        if chip.depth > 1:
            raise ValueError(
                f"greys must be 1 for the {chip.name}, which has {2**chip.depth} of its own, not {greys!r}"
            )
        Cycle(greys)
        if not 0 < bus_share <= 1:
            raise ValueError(f"bus_share must be above 0 and at most 1, not {bus_share!r}")
        if bus_clock is not None and not 0 < bus_clock < math.inf:
            raise ValueError(f"bus_clock must be Hz above 0, or None, not {bus_clock!r}")
        self._driver, self._stats, self.greys = driver, stats, greys
        self._bus_share, self._clock = bus_share, bus_clock or _bits_a_second(driver.transport)
        self._response = _response(chip, weighted)
        if self._response is not None and driver.contrast is None:
            driver.contrast = 255
        self._forecaster = Forecaster(chip, driver.cost, updates)
        self._choice: Choice | None = None
        self._still: Levels = np.zeros((chip.height, chip.width), np.uint8)
        self._due = 0.0
        self.boarded = False
        self._turn = 0
        self._pace: Pace | None = None
        self._board = None if self._response is not None else board_of(driver, updates)
        self._check()

    def _check(self) -> None:
        """See that one gray pixel can be shown."""
        levels = np.zeros_like(self._still)
        levels[0, 0] = 1

        def able(greys: int) -> bool:
            choice = self._chosen(levels, greys - 1, greys)
            return choice is not None and choice.cycle.greys == greys

        if not able(self.greys):
            most = max((greys for greys in GREYS if greys < self.greys and able(greys)), default=1)
            advice = "" if self._response is not None else ", or be shown with weighted=True"
            raise ValueError(
                f"greys must be at most {most} for the {self._driver.controller.name} on this wire, where more take "
                f"longer than 1/{LEAST_RATE:g} s a cycle{advice}, not {self.greys}"
            )

    @property
    def depth(self) -> int:
        """Bits a pixel of a picture."""
        return 2 if self.greys <= 4 else 4

    @property
    def going(self) -> bool:
        """Whether there is a sub-picture to come."""
        return self._choice is not None

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
        still = (2 * levels > max_level).astype(np.uint8)
        if max_level >= 2**self.depth:
            levels, max_level = in_greys(levels, max_level, self.greys), self.greys - 1
        choice = self._chosen(levels, max_level, self.greys)
        if choice is None or choice.cycle.greys < self.greys:
            self._say_fewer(choice)
        if self._board is not None and choice is not None and choice.seconds:
            self._stats.cycled_by_host += not self._board.keeps(choice)
        return choice, still

    def _chosen(self, levels: Levels, max_level: int, greys: int) -> Choice | None:
        paces = PACES.get(self._driver.controller.name, ())
        kept = None if self._board is None else self._board.choose(levels, max_level, greys, paces)
        if kept is not None and kept.cycle.greys == greys:
            return kept
        sent = choose(
            self._forecaster,
            levels,
            max_level,
            greys,
            self._clock,
            weighted=self._response is not None,
            bus_share=self._bus_share,
            paces=paces,
            lines=self._driver.controller.height,
        )
        return max((one for one in (kept, sent) if one is not None), key=lambda one: one.cycle.greys, default=None)

    def begin(self, choice: Choice | None, still: Levels) -> None:
        """Have the next turn be the first of a picture's."""
        before, driver = self._choice, self._driver
        self._still, self._turn = still, 0
        self._choice = choice if choice is not None and choice.seconds else None
        self.boarded = self._board is not None and self._board.keeps(self._choice)
        driver.moving = None if self._choice is None or self.boarded else self._choice.moving
        if self._choice is None:
            if before is not None and before.cycle.weighted:
                driver.change(driver.brightness)
        elif self._choice.pace not in (None, self._pace):
            self._keep(self._choice.pace)

    def _keep(self, pace: Pace) -> None:
        """Have the chip scan at a pace, after each start too."""
        driver, before = self._driver, self._pace.commands if self._pace else ()
        driver.change(lambda: pace.commands)
        driver.kept = [*(command for command in driver.kept if command not in before), *pace.commands]
        self._pace = pace

    def turn(self, force: bool = False) -> tuple[int, int, int]:
        """Show the next sub-picture; return bytes on the wire, messages, changed bytes."""
        choice, driver = self._choice, self._driver
        if choice is None:
            driver.pack(self._still, 1)
            wire, messages, changed = driver.show(force, time.perf_counter())
            return wire + (self._board.end() if self._board is not None else 0), messages, changed
        if self.boarded:
            driver.take(choice.packed[0])
            wire, messages, changed = driver.show(force, time.perf_counter())
            self._due = time.monotonic() + _LOOK
            return wire + self.resume(), messages, changed
        turn, lasts = self._turn, choice.seconds[self._turn]
        self._turn = (turn + 1) % len(choice.packed)
        self._due = max(self._due, time.monotonic() - lasts) + lasts
        wire = messages = 0
        if choice.cycle.weighted and not driver.rest:
            wire, messages = driver.change(lambda: self._brightness(choice.cycle.weights, turn))
        driver.take(choice.packed[turn])
        sent = driver.show(force, time.perf_counter())
        return sent[0] + wire, sent[1] + messages, sent[2]

    def resume(self) -> int:
        """Have a board go on that was sent something; return the bytes on the wire."""
        if not self.boarded or self._board is None or self._driver.asleep or self._driver.rest == "off":
            return 0
        return self._board.begin()

    def _brightness(self, weights: tuple[int, ...], turn: int) -> tuple[bytes, ...]:
        """The commands for the contrast that a sub-picture is worth."""
        contrast, most = self._driver.controller.contrast, self._driver.contrast
        if contrast is None or most is None or self._response is None:
            return ()
        return contrast.commands(self._response.contrasts(weights, most)[turn])

    def stop(self) -> None:
        """Have no sub-picture come."""
        self._choice = self._driver.moving = None
        self.boarded = False

    def settle(self) -> None:
        """Leave the picture without grey: the cycle has ended for good."""
        if self.going:
            self.begin(None, self._still)
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


def _response(chip: Controller, weighted: bool | Sequence[float]) -> Response | None:
    """How a chip's light follows its contrast, where that is to weigh sub-pictures."""
    given = np.ndim(weighted) > 0
    if not given and not weighted:
        return None
    if chip.contrast is None or not chip.contrast.command or not (given or chip.name in RESPONSES):
        raise ValueError(
            f"weighted must be False for the {chip.name}, of which it is not known how light follows contrast"
        )
    response = Response(tuple(weighted), "given") if given else RESPONSES[chip.name]  # type: ignore[arg-type]
    try:
        response.contrasts((1,), 255)
    except ValueError as error:
        raise ValueError(f"weighted must be True, False, or the light at each contrast: {error}") from None
    return response


def _bits_a_second(transport: Any) -> float:
    """What a wire carries, in bits of an I2C bus, of which a byte takes nine."""
    speed = getattr(transport, "speed", None)
    if speed:
        return float(speed) * 9 / 8
    rate = getattr(transport, "baudrate", None)
    if rate:
        return float(rate) * 9 / 10
    return float(getattr(getattr(transport, "bus", None), "clock", None) or _CLOCK)
