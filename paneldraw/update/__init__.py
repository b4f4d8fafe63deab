"""What changed since the last frame, and the cheapest way found to send it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from paneldraw.transports.base import Cost
from paneldraw.update.planner import UPDATES, Planner
from paneldraw.update.registers import ChainPlanner, RegisterPlanner

if TYPE_CHECKING:
    from paneldraw.controllers import Controller

__all__ = ["UPDATES", "Planner", "RegisterPlanner", "planner_for"]


def planner_for(controller: Controller, cost: Cost, updates: str = "least") -> Planner | RegisterPlanner:
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
