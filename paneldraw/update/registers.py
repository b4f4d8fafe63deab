"""Plans for LED chips: a RAM of a few registers, and messages that say which of them they write."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from paneldraw.controllers.packing import packer
from paneldraw.transports.base import COMMAND, DATA, Plan

if TYPE_CHECKING:
    from paneldraw.controllers import Controller, Registers
    from paneldraw.transports.base import Cost

Changed = npt.NDArray[np.bool_]

_ROWS = 8
"""Registers of a chip in a row of them; they are numbered from 1."""
_KINDS = (COMMAND, DATA)
"""Kinds in turn, which these chips do not tell apart: a board behind a serial port joins neighbors of one kind."""


class RegisterPlanner:
    """The shadow of a chip that counts up its registers, and the plans from it to the next frame.

    A message is the number of a register, where others have their control byte, and what goes into it and those behind.
    Between two changes the bytes that did not change are sent too where they are no more than a message's own two.

    Parameters
    ----------
    controller : Controller
    cost : Cost
        What a message costs on the transport.
    whole : bool
        Whether to send every picture that differs whole.

    Attributes
    ----------
    fresh : uint8 array
        The frame to bring onto the panel, packed: write into it, then call `plan`.
    shadow : array like `fresh`
        What the panel holds.

    Examples
    --------
    >>> from paneldraw.controllers import HT16K33
    >>> from paneldraw.transports import Cost
    >>> chip = HT16K33()
    >>> planner = RegisterPlanner(chip, chip.registers, Cost(2, 2), whole=False)
    >>> [(kind, len(payload)) for kind, payload in planner.plan()]
    [(0, 16)]
    """

    def __init__(self, controller: Controller, registers: Registers, cost: Cost, whole: bool) -> None:
        self._registers, self._cost, self._whole = registers, cost, whole
        self._longest = registers.size if cost.longest is None else cost.longest
        self.fresh: npt.NDArray[np.uint8] = np.zeros(registers.size, np.uint8)
        self.shadow = self.fresh.copy()
        all_lit = self.fresh.copy()
        packer(controller)(np.ones((controller.height, controller.width), np.uint8), 1, all_lit)
        self._used = all_lit != 0
        self._known = False
        self._plan = Plan(*self._room())

    def plan(self) -> Plan:
        """Return the cheapest plan from what the panel holds to `fresh`. It is valid until the next one.

        Once it went out call `sent`; if it failed, `forget`.
        """
        changed = self._used & (self.fresh != self.shadow) if self._known else self._used
        plan = self._begin(self._plan)
        plan.changed = int(np.count_nonzero(changed))
        if plan.changed:
            self._write(self._used if self._whole else changed)
        return plan

    def commands(self, *commands: bytes) -> Plan:
        """Return the messages of commands."""
        size = self._registers.command_bytes
        sent = b"".join(commands)
        number = len(sent) // size
        plan = Plan(number * (1 + self._command_length), number)
        for start in range(0, len(sent), size):
            self._add_command(plan, sent[start : start + size])
        return plan

    def sent(self) -> None:
        """Note that the plan arrived: the panel holds the fresh frame."""
        self.shadow[:] = self.fresh
        self._known = True

    def forget(self) -> None:
        """Note that nothing is known of the panel."""
        self._known = False

    restart = forget

    def doubt(self) -> None:
        """Do nothing: each message says where it goes."""

    def _room(self) -> tuple[int, int]:
        """Bytes and messages of the longest plan."""
        return 2 * self._registers.size, self._registers.size

    @property
    def _command_length(self) -> int:
        """Bytes of a command's message, less its kind."""
        return self._registers.command_bytes - 1

    def _add_command(self, plan: Plan, command: bytes) -> None:
        self._add(plan, command[0], np.frombuffer(command, np.uint8)[1:])

    def _write(self, changed: Changed) -> None:
        where = np.flatnonzero(changed)
        cuts = np.flatnonzero(np.diff(where) > 1 + self._cost.data) + 1
        for run in np.split(where, cuts):
            for start in range(run[0], run[-1] + 1, self._longest):
                stop = min(run[-1] + 1, start + self._longest)
                self._add(self._plan, self._registers.first + start, self.fresh[start:stop])

    def _begin(self, plan: Plan) -> Plan:
        plan.count = plan.cost = plan.changed = 0
        return plan

    def _add(self, plan: Plan, kind: int, payload: npt.NDArray[np.uint8]) -> None:
        start = plan.stops[plan.count - 1] if plan.count else 0
        stop = start + 1 + payload.size
        plan.buffer[start], plan.buffer[start + 1 : stop] = kind, payload
        plan.starts[plan.count], plan.stops[plan.count] = start, stop
        plan.count += 1
        plan.cost += self._cost.data + payload.size


class ChainPlanner(RegisterPlanner):
    """The same of chips in a row: a message is a register and its byte for each, and chips may differ in the register.

    So it takes as many messages as the chip with the most changes has; those that have no more are sent a register 0,
    which is none.
    """

    def __init__(self, controller: Controller, registers: Registers, cost: Cost, whole: bool) -> None:
        super().__init__(controller, registers, cost, whole)
        length = 2 * registers.chips
        if self._cost.longest is not None and length > self._cost.longest:
            most = f"{self._cost.longest // 2} chips, as the transport carries {self._cost.longest} bytes a message"
            raise ValueError(f"controller must have at most {most}, not {registers.chips}")

    def _room(self) -> tuple[int, int]:
        return _ROWS * (1 + 2 * self._registers.chips), _ROWS

    @property
    def _command_length(self) -> int:
        return 2 * self._registers.chips

    def _add_command(self, plan: Plan, command: bytes) -> None:
        self._add(plan, _KINDS[plan.count % 2], np.tile(np.frombuffer(command, np.uint8), self._registers.chips))

    def _write(self, changed: Changed) -> None:
        changed = changed.reshape(_ROWS, -1)
        turns = np.cumsum(changed, axis=0)
        rows, chips = np.nonzero(changed)
        messages = np.zeros((turns[-1].max(), self._registers.chips, 2), np.uint8)
        messages[turns[rows, chips] - 1, chips, 0] = rows + 1
        messages[turns[rows, chips] - 1, chips, 1] = self.fresh.reshape(_ROWS, -1)[rows, chips]
        for number, message in enumerate(messages):
            self._add(self._plan, _KINDS[number % 2], message.reshape(-1))
