# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""The messages of a plan, and what they leave in the chip's addressing registers.

Columns and pages are those of the chip's RAM; window ends are exclusive.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import cython
import numpy as np

from paneldraw.transports.base import CHAINED, COMMAND, DATA

if TYPE_CHECKING:
    from paneldraw.controllers import Controller
    from paneldraw.transports.base import Cost, Plan

HORIZONTAL, VERTICAL, PAGE = 0, 1, 2

_COMMAND = cython.declare(cython.int, COMMAND)
_DATA = cython.declare(cython.int, DATA)
_CHAINED = cython.declare(cython.int, CHAINED)
_HORIZONTAL = cython.declare(cython.int, HORIZONTAL)
_VERTICAL = cython.declare(cython.int, VERTICAL)
_PAGE = cython.declare(cython.int, PAGE)


@cython.cclass
class Writer:
    """Writes messages into a plan, counts their bytes, and follows the chip: a register of -1 is unknown.

    Rehearsed messages are counted, and leave no trace.
    """

    def __init__(self, controller: Controller, cost: Cost, plan: Plan) -> None:
        pages = controller.height // 8
        self.new = np.zeros((pages, controller.width), np.uint8)
        self.old = np.zeros((pages, controller.width), np.uint8)
        self.known = False
        self.width = controller.width
        self.left, self.top = controller.column_offset, controller.row_offset // 8
        self.ram_width = controller.ram_width
        self.wraps = controller.column_wraps
        self.command_cost, self.data_cost = cost.command, cost.data
        chained = cost.chained if controller.chained_control else None
        self.chained_cost = -1 if chained is None else chained
        self._out, self._starts, self._stops = plan.buffer, plan.starts, plan.stops
        self._noted = np.zeros(7, np.intc)
        self._dry, self._kind = False, -1
        self.begin()
        self.forget()

    @cython.cfunc
    def forget(self) -> cython.void:
        """Know nothing of the chip's registers."""
        self.mode = self.page = self.column = -1
        self.window_left = self.window_right = self.window_top = self.window_bottom = -1

    @cython.cfunc
    def begin(self) -> cython.void:
        """Begin a plan."""
        self._end = self.messages = self.total = 0

    @cython.cfunc
    def rehearse(self) -> cython.void:
        """Only count, until `rehearsed`. No message has been written yet."""
        self._dry = True
        self._noted[0], self._noted[1], self._noted[2] = self.mode, self.page, self.column
        self._noted[3], self._noted[4] = self.window_left, self.window_right
        self._noted[5], self._noted[6] = self.window_top, self.window_bottom

    @cython.cfunc
    def rehearsed(self) -> cython.int:
        """Return the bytes counted; everything else is as it was before."""
        self.finish()
        total: cython.int = self.total
        self._dry, self.total = False, 0
        self.mode, self.page, self.column = self._noted[0], self._noted[1], self._noted[2]
        self.window_left, self.window_right = self._noted[3], self._noted[4]
        self.window_top, self.window_bottom = self._noted[5], self._noted[6]
        return total

    # -- Where data goes

    @cython.cfunc
    @cython.exceptval(check=False)
    def windowed(self) -> cython.bint:
        """Whether the chip is in a mode of windows."""
        return self.mode == _HORIZONTAL or self.mode == _VERTICAL

    @cython.cfunc
    @cython.exceptval(check=False)
    def pointer_commands(
        self, page: cython.int, column: cython.int, to_page: cython.int, to_column: cython.int
    ) -> cython.int:
        """How many commands lead the page pointer from one place to another."""
        if column < 0:
            return 2 + (page != to_page)
        # From 0 on, because numpy's truth values, which the uncompiled planner meets, do not add up to 2.
        return 0 + (page != to_page) + ((column ^ to_column) & 15 != 0) + (column >> 4 != to_column >> 4)

    @cython.cfunc
    def point(self, page: cython.int, column: cython.int) -> cython.void:
        """Send those of page, lower and upper half of the column pointer that do not hold."""
        started: cython.bint = False
        self.set_mode(_PAGE)
        count: cython.int = self.pointer_commands(self.page, self.column, page, column)
        chained: cython.bint = (
            self._kind != _COMMAND
            and self.chained_cost >= 0
            and self.chained_cost + 2 * count < self.command_cost + count + self.data_cost
        )
        if chained:
            self.finish()
        self._message(_CHAINED if chained else _COMMAND)
        if self.page != page:
            started = self._pointer_byte(0xB0 + page, started)
        if self.column < 0 or (self.column ^ column) & 15 != 0:
            started = self._pointer_byte(column & 15, started)
        if self.column < 0 or self.column >> 4 != column >> 4:
            self._pointer_byte(0x10 + (column >> 4), started)
        if chained:
            self._byte(_DATA)
        self.page, self.column = page, column

    @cython.cfunc
    def _pointer_byte(self, command: cython.int, started: cython.bint) -> cython.bint:
        if started and self._kind == _CHAINED:
            self._byte(_CHAINED)
        self._byte(command)
        return True

    @cython.cfunc
    def window_commands(self, left: cython.int, right: cython.int, top: cython.int, bottom: cython.int) -> cython.int:
        """How many command bytes open a window with the pointer at its start."""
        if not self.windowed():
            return 8
        count: cython.int = 0
        if self.window_left != left or self.window_right != right or self.column != left:
            count += 3
        if self.window_top != top or self.window_bottom != bottom or self.page != top:
            count += 3
        return count

    @cython.cfunc
    def window(self, left: cython.int, right: cython.int, top: cython.int, bottom: cython.int) -> cython.void:
        """Open a window, in a mode of windows, with what does not hold. A window written to its end is open again."""
        if self.window_left != left or self.window_right != right or self.column != left:
            self._command(0x21, left, right - 1)
            self.window_left, self.window_right, self.column = left, right, left
        if self.window_top != top or self.window_bottom != bottom or self.page != top:
            self._command(0x22, top, bottom - 1)
            self.window_top, self.window_bottom, self.page = top, bottom, top

    @cython.cfunc
    def set_mode(self, mode: cython.int) -> cython.void:
        """Set the addressing mode unless it holds. No datasheet says where the pointer is afterwards."""
        if self.mode != mode:
            self._message(_COMMAND)
            self._byte(0x20)
            self._byte(mode)
            self.mode, self.page, self.column = mode, -1, -1

    @cython.cfunc
    def _command(self, command: cython.int, first: cython.int, last: cython.int) -> cython.void:
        self._message(_COMMAND)
        self._byte(command)
        self._byte(first)
        self._byte(last)

    # -- Data

    @cython.cfunc
    def cells(self, count: cython.int) -> cython.void:
        """Send that many bytes of the new frame from where the pointer stands."""
        if count <= 0:
            return
        self._message(_DATA)
        self.total += count
        run: cython.int
        i: cython.int
        while count > 0:
            run = 1
            if self.mode != _VERTICAL:
                run = min(count, (self.ram_width if self.mode == _PAGE else self.window_right) - self.column)
            if not self._dry:
                for i in range(run):
                    self._out[self._end + i] = self.new[self.page - self.top, self.column - self.left + i]
                self._end += run
            self.column += run - 1
            self._step()
            count -= run

    @cython.cfunc
    @cython.inline
    @cython.exceptval(check=False)
    def _step(self) -> cython.void:
        """Move the pointer past a byte of data."""
        if self.mode == _VERTICAL:
            self.page += 1
            if self.page == self.window_bottom:
                self.page = self.window_top
                self.column = self.window_left if self.column + 1 == self.window_right else self.column + 1
            return
        self.column += 1
        if self.mode == _PAGE:
            if self.column == self.ram_width:
                self.column = 0 if self.wraps else -1
        elif self.column == self.window_right:
            self.column = self.window_left
            self.page = self.window_top if self.page + 1 == self.window_bottom else self.page + 1

    # -- Messages

    @cython.cfunc
    def _message(self, kind: cython.int) -> cython.void:
        """Begin a message, unless what follows belongs into the one that is open."""
        if self._kind == kind or (kind == _DATA and self._kind == _CHAINED):
            return
        self.finish()
        self._kind = kind
        if kind == _DATA:
            self.total += self.data_cost
        else:
            self.total += self.command_cost if kind == _COMMAND else self.chained_cost
        if not self._dry:
            self._starts[self.messages] = self._end
            self._out[self._end] = kind
            self._end += 1

    @cython.cfunc
    @cython.exceptval(check=False)
    def _byte(self, byte: cython.int) -> cython.void:
        self.total += 1
        if not self._dry:
            self._out[self._end] = byte
            self._end += 1

    @cython.cfunc
    def finish(self) -> cython.void:
        """End the message that is open."""
        if self._kind >= 0 and not self._dry:
            self._stops[self.messages] = self._end
            self.messages += 1
        self._kind = -1
