"""What changed since the last frame, and the cheapest way found to send it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np
import numpy.typing as npt

from paneldraw.transports.base import Cost, Plan
from paneldraw.update.planner import UPDATES, Planner
from paneldraw.update.registers import ChainPlanner, RegisterPlanner

if TYPE_CHECKING:
    from paneldraw.controllers import Controller

__all__ = ["UPDATES", "Planner", "Plans", "planner_for"]


class Plans(Protocol):
    """What a panel's driver knows of a planner."""

    @property
    def fresh(self) -> npt.NDArray[np.uint8]:
        """The frame to bring onto the panel, packed: write into it, then call `plan`."""

    @property
    def shadow(self) -> npt.NDArray[np.uint8]:
        """What the panel holds."""

    def plan(self) -> Plan:
        """Return the plan from what the panel holds to `fresh`, valid until the next; then call `sent` or `forget`."""

    def commands(self, *commands: bytes) -> Plan | None:
        """Return the plan that sends commands, or None where they go out as messages of the transport's own."""

    def sent(self) -> None:
        """Note that the plan arrived."""

    def forget(self) -> None:
        """Note that nothing is known of the panel."""

    def doubt(self) -> None:
        """Note that nothing is known of how the chip is addressed: the next plan depends on what it changes alone."""

    def restart(self) -> None:
        """Note that the chip took its init."""


def planner_for(controller: Controller, cost: Cost, updates: str = "least") -> Plans:
    """Make the planner for a chip's way of addressing; `Planner` says what the parameters are.

    Examples
    --------
    >>> from paneldraw.controllers import HT16K33
    >>> planner_for(HT16K33(), Cost(2, 2)).plan().cost  # one message for all 16 bytes
    18
    """
    registers = controller.registers
    if registers is None:
        return Planner(controller, cost, updates)
    if updates not in UPDATES:
        raise ValueError(f"updates must be one of {', '.join(map(repr, UPDATES))}, not {updates!r}")
    kind = ChainPlanner if registers.chips else RegisterPlanner
    return kind(controller, registers, cost, updates == "whole")
