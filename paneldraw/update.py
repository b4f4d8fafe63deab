"""What changed since the last frame, and the cheapest way to send it."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from paneldraw.controllers import Controller
from paneldraw.transports.base import COMMAND, DATA, Cost, Plan


class Planner:
    """Keeps the shadow of one panel's RAM and plans the update from it to a new frame."""

    def __init__(self, controller: Controller, cost: Cost) -> None:
        pages = controller.height // 8
        self.fresh: npt.NDArray[np.uint8] = np.zeros((pages, controller.width), np.uint8)
        self._shadow = np.zeros_like(self.fresh)
        self._known = False
        self._controller = controller
        self._cost = cost
        self._plan = Plan(self.fresh.size * 8 + 64, self.fresh.size + 8)

    def plan(self) -> Plan:
        plan = self._plan
        plan.count = plan.cost = 0
        changed = self.fresh != self._shadow if self._known else np.ones(self.fresh.shape, bool)
        plan.changed = int(changed.sum())
        end = 0
        for page in np.flatnonzero(changed.any(axis=1)).tolist():
            columns = np.flatnonzero(changed[page])
            for run in np.split(columns, np.flatnonzero(np.diff(columns) > 6) + 1):
                first, last = int(run[0]), int(run[-1])
                column = first + self._controller.column_offset
                where = (0xB0 + page + self._controller.row_offset // 8, column & 15, 0x10 + (column >> 4))
                end = self._add(end, COMMAND, bytes(where))
                end = self._add(end, DATA, self.fresh[page, first : last + 1].tobytes())
        return plan

    def sent(self) -> None:
        """The plan arrived: the panel now holds the fresh frame."""
        self._shadow[:] = self.fresh
        self._known = True

    def forget(self) -> None:
        """Nothing is known of the panel's RAM any more."""
        self._known = False

    def restart(self) -> None:
        """The chip went through its init: its RAM is unknown, its addressing is not."""
        self._known = False

    def _add(self, end: int, kind: int, payload: bytes) -> int:
        plan = self._plan
        stop = end + 1 + len(payload)
        plan.buffer[end] = kind
        plan.buffer[end + 1 : stop] = np.frombuffer(payload, np.uint8)
        plan.starts[plan.count], plan.stops[plan.count] = end, stop
        plan.count += 1
        plan.cost += len(payload) + (self._cost.command if kind == COMMAND else self._cost.data)
        return stop
