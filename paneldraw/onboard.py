"""Sub-pictures that a board behind a serial port keeps, and writes to its panel by itself."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from paneldraw.transports.base import DATA, Cost
from paneldraw.update import planner_for
from paneldraw.update.greys import GREYS, LEAST_RATE, STEADY_RATE, Choice, Cycle, Forecaster, Levels, Pace, laid_out

if TYPE_CHECKING:
    from paneldraw.driver import Driver

_SHARE: Final = 0.95
"""How much of its bus a board may take, on which there is nobody else."""
_COSTS: Final = {"i2c": Cost(3, 3), "spi": Cost(0, 0)}
_CLOCKS: Final = {"i2c": 375_000.0, "spi": 4_000_000 * 9 / 8}
"""What a message takes on the board's own bus, and its bits a second, nine of which are a byte.

On I2C as an ATmega328P does it, measured on an emulated one: 24 us a byte, and as much again a message.
"""


class Board:
    """Chooses cycles that a board can keep, and hands them over.

    Parameters
    ----------
    driver : Driver
        Whose transport is a `SerialTransport` to a board with a store.
    updates : str
        As `Panel` has it.
    """

    def __init__(self, driver: Driver, updates: str) -> None:
        transport: Any = driver.transport
        self._driver, self._transport, self._room = driver, transport, transport.store
        self._clock, cost = _CLOCKS[transport.wire], _COSTS[transport.wire]
        self._forecaster = Forecaster(driver.controller, cost, updates)
        self._planner = planner_for(driver.controller, cost, updates)
        self._choice: Choice | None = None
        self._content = self._kept = b""

    def choose(self, levels: Levels, max_level: int, greys: int, paces: Sequence[Pace]) -> Choice | None:
        """Return the cycle of a picture with the most greys that the board can keep and write in time, if any is."""
        self._choice = None
        for fewer in (grey for grey in reversed(GREYS) if grey <= greys):
            best = 0.0
            for cycle in (Cycle(fewer), Cycle(fewer, timed=True)) if fewer > 3 else (Cycle(fewer),):
                choice = self._laid_out(cycle, cycle.steps(levels, max_level), paces)
                if not choice.seconds:
                    return choice
                rate = min(choice.rate, STEADY_RATE)
                content = self._packed(choice) if rate >= LEAST_RATE and rate > best else b""
                if content and len(content) <= self._room:
                    best, self._choice, self._content = rate, choice, content
            if self._choice is not None:
                break
        return self._choice

    def _laid_out(self, cycle: Cycle, steps: Levels, paces: Sequence[Pace]) -> Choice:
        """Lay a cycle out so that no sub-picture takes longer than a scan."""
        lines = self._driver.controller.height
        for _ in range(2):
            choice = laid_out(self._forecaster, cycle, steps, self._clock, bus_share=_SHARE, paces=paces, lines=lines)
            taken = choice.forecast.seconds(self._clock)
            paces = [pace for pace in paces if lines * pace.line_seconds >= taken]
        return choice

    def keeps(self, choice: Choice | None) -> bool:
        """Whether a cycle is the one that was chosen last."""
        return choice is not None and choice is self._choice

    def begin(self) -> int:
        """Have the board begin the cycle that was chosen, unless it says that it is in it; return bytes on the wire.

        The panel shows its first sub-picture.
        """
        return self._driver.leave_to(self._hand_over)

    def _hand_over(self) -> int:
        if self._transport.cycling and self._kept == self._content:
            self._transport.status()  # raises what went wrong meanwhile
            if self._transport.cycling:
                return 0
        count = len(self._choice.packed) if self._choice is not None else 0
        wire: int = self._transport.cycle(self._content, count)
        self._kept = self._content
        return wire

    def end(self) -> int:
        """End a cycle; return the bytes on the wire."""
        if not self._transport.cycling:
            return 0
        return self._driver.leave_to(lambda: self._transport.cycle(b"", 0))

    def _packed(self, choice: Choice) -> bytes:
        """What the board has to keep."""
        from firmware_protocol.cycle import pack_cycle

        planner, pictures = self._planner, []
        np.copyto(planner.fresh, choice.packed[0])
        planner.plan()
        planner.sent()
        for packed in choice.packed:
            np.copyto(planner.fresh, packed)
            np.invert(packed, out=planner.shadow, where=choice.moving)
            planner.doubt()
            pictures.append([(kind == DATA, bytes(payload)) for kind, payload in planner.plan()])
            planner.sent()
        return pack_cycle(pictures, choice.seconds)


def board_of(driver: Driver, updates: str) -> Board | None:
    """Return the board that can cycle for a driver, or None where there is none, or what is sent is not the picture."""
    able = getattr(driver.transport, "store", 0) and getattr(driver.transport, "wire", "") in _CLOCKS
    chip = driver.controller
    adjusted = not chip.inverse or (chip.contrast is not None and not chip.contrast.command)
    return Board(driver, updates) if able and not adjusted and not chip.synced else None
