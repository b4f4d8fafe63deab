# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""The messages of a plan, and what they leave in the chip's addressing registers.

A cell is what one address of the chip's RAM holds, a row a page of cells where the chip has pages. Columns and rows
are those of the RAM; window ends are exclusive.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import cython
import numpy as np

from paneldraw.transports.base import CHAINED, COMMAND, DATA

if cython.compiled:
    from cython.cimports.libc.string import memcpy

if TYPE_CHECKING:
    import numpy.typing as npt

    from paneldraw.controllers import Controller
    from paneldraw.transports.base import Cost, Plan

HORIZONTAL, VERTICAL, PAGE = 0, 1, 2
"""Windows filled across, windows filled down, and the page pointer."""

_COMMAND = cython.declare(cython.int, COMMAND)
_DATA = cython.declare(cython.int, DATA)
_CHAINED = cython.declare(cython.int, CHAINED)
_HORIZONTAL = cython.declare(cython.int, HORIZONTAL)
_VERTICAL = cython.declare(cython.int, VERTICAL)
_PAGE = cython.declare(cython.int, PAGE)
_ENDLESS = cython.declare(cython.int, 1 << 30)


@cython.cclass
class Writer:
    """Writes messages into a plan, counts their bytes, and follows the chip: a register of -1 is unknown.

    Rehearsed messages are counted, and leave no trace.
    """

    def __init__(self, controller: Controller, cost: Cost, plan: Plan) -> None:
        wide, high = controller.cell
        pointer, window = controller.pointer, controller.window
        self.cell_bytes = window.column_bytes if window else 1
        self.width, self.height = controller.width // wide, controller.height // high
        self.new = np.zeros((self.height, self.width * self.cell_bytes), np.uint8)
        self.old = np.zeros_like(self.new)
        self.known = False
        self.left, self.top = controller.column_offset // wide, controller.row_offset // high
        self.ram_width = controller.ram_width // wide
        self.has_pointer, self.has_window = pointer is not None, window is not None
        self.wraps = pointer is not None and pointer.wraps
        self._modes = _side_by_side(
            window.across if window else b"", window.down if window else b"", pointer.mode if pointer else b""
        )
        self._write = _side_by_side(window.write if window else b"")
        self._columns, self._rows = (window.columns, window.rows) if window else (0, 0)
        self._arguments = DATA if controller.arguments_are_data else COMMAND
        self.command_cost, self.data_cost = cost.command, cost.data
        chained = cost.chained if controller.chained_control else None
        self.chained_cost = -1 if chained is None else chained
        self._longest = _ENDLESS if cost.longest is None else cost.longest
        self._out, self._starts, self._stops = plan.buffer, plan.starts, plan.stops
        self._noted = np.zeros(8, np.intc)
        self._dry, self._kind, self._length, self._filling = False, -1, 0, False
        self.begin()
        self.forget()

    @cython.cfunc
    def forget(self) -> cython.void:
        """Know nothing of the chip's registers."""
        self.mode = -1 if self.has_window else _PAGE
        self.row = self.column = -1
        self.window_left = self.window_right = self.window_top = self.window_bottom = -1

    @cython.cfunc
    def restart(self) -> cython.void:
        """Know what the chip's init leaves."""
        self.forget()
        self.mode = _PAGE if self.has_pointer else _HORIZONTAL

    @cython.cfunc
    @cython.exceptval(check=False)
    def held(self, row: cython.int, column: cython.int) -> cython.bint:
        """Whether the panel holds a cell of the new frame already."""
        i: cython.int
        for i in range(self.cell_bytes * (column - self.left), self.cell_bytes * (column - self.left + 1)):
            if self.new[row - self.top, i] != self.old[row - self.top, i]:
                return False
        return self.known

    @cython.cfunc
    def begin(self) -> cython.void:
        """Begin a plan."""
        self._end = self.messages = self.total = 0

    @cython.cfunc
    def rehearse(self) -> cython.void:
        """Only count, until `rehearsed`. No message is open."""
        self._dry = True
        self._noted[0], self._noted[1], self._noted[2] = self.mode, self.row, self.column
        self._noted[3], self._noted[4] = self.window_left, self.window_right
        self._noted[5], self._noted[6] = self.window_top, self.window_bottom
        self._noted[7] = self.total

    @cython.cfunc
    def rehearsed(self) -> cython.int:
        """Return the bytes counted; everything else is as it was before."""
        self.finish()
        counted: cython.int = self.total - self._noted[7]
        self._dry, self.total = False, self._noted[7]
        self.mode, self.row, self.column = self._noted[0], self._noted[1], self._noted[2]
        self.window_left, self.window_right = self._noted[3], self._noted[4]
        self.window_top, self.window_bottom = self._noted[5], self._noted[6]
        return counted

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
        count: cython.int = self.pointer_commands(self.row, self.column, page, column)
        chained: cython.bint = (
            self._kind != _COMMAND
            and self.chained_cost >= 0
            and self.chained_cost + 2 * count < self.command_cost + count + self.data_cost
        )
        if chained:
            self.finish()
        self._message(_CHAINED if chained else _COMMAND)
        if self.row != page:
            started = self._pointer_byte(0xB0 + page, started)
        if self.column < 0 or (self.column ^ column) & 15 != 0:
            started = self._pointer_byte(column & 15, started)
        if self.column < 0 or self.column >> 4 != column >> 4:
            self._pointer_byte(0x10 + (column >> 4), started)
        if chained:
            self._byte(_DATA)
        self.row, self.column = page, column

    @cython.cfunc
    def _pointer_byte(self, command: cython.int, started: cython.bint) -> cython.bint:
        if started and self._kind == _CHAINED:
            self._byte(_CHAINED)
        self._byte(command)
        return True

    @cython.cfunc
    @cython.exceptval(check=False)
    def mode_length(self, mode: cython.int) -> cython.int:
        """How many bytes the command of a mode has."""
        return self._modes[mode, 0]

    @cython.cfunc
    @cython.exceptval(check=False)
    def columns_hold(self, left: cython.int, right: cython.int, rows: cython.int) -> cython.bint:
        """Whether a box of so many rows needs no command for its columns.

        Where data turns, the window's edges must be the box's; elsewhere it is enough that it gets so far.
        """
        if self.column != left or not self.windowed():
            return False
        if self.mode == _VERTICAL or rows == 1:
            return self.window_right >= right
        return self.window_left == left and self.window_right == right

    @cython.cfunc
    @cython.exceptval(check=False)
    def rows_hold(self, top: cython.int, bottom: cython.int, columns: cython.int) -> cython.bint:
        """Whether a box of so many columns needs no command for its rows."""
        if self.row != top or not self.windowed():
            return False
        if self.mode == _HORIZONTAL or columns == 1:
            return self.window_bottom >= bottom
        return self.window_top == top and self.window_bottom == bottom

    @cython.cfunc
    @cython.exceptval(check=False)
    def data_price(self, bounds: cython.int) -> cython.int:
        """Bytes from here to the first cell after so many of a window's two commands."""
        price: cython.int = 0
        commanding: cython.bint = self._kind == _COMMAND
        if bounds == 0 and self._filling:
            return 0
        if self._arguments == _DATA:
            price = bounds * (self.command_cost + 3 + self.data_cost)
            commanding = False
        elif bounds > 0:
            price = 3 * bounds + (0 if commanding else self.command_cost)
            commanding = True
        if self._write[0, 0] > 0:
            price += self._write[0, 0] + (0 if commanding else self.command_cost)
        return price + self.data_cost

    @cython.cfunc
    def window(self, left: cython.int, right: cython.int, top: cython.int, bottom: cython.int) -> cython.void:
        """Bring the pointer to the start of a box, in a mode of windows, with what does not hold."""
        if not self.columns_hold(left, right, bottom - top):
            self._bounds(self._columns, left, right - 1)
            self.window_left, self.window_right, self.column = left, right, left
        if not self.rows_hold(top, bottom, right - left):
            self._bounds(self._rows, top, bottom - 1)
            self.window_top, self.window_bottom, self.row = top, bottom, top

    @cython.cfunc
    def set_mode(self, mode: cython.int) -> cython.void:
        """Set the addressing mode unless it holds. No datasheet says where the pointer is afterwards."""
        if self.mode != mode:
            self._command(self._modes[mode])
            self.mode, self.row, self.column = mode, -1, -1

    @cython.cfunc
    def _command(self, command: cython.uchar[::1]) -> cython.void:
        i: cython.int
        for i in range(1, command[0] + 1):
            self._message(_COMMAND if i == 1 else self._arguments)
            self._byte(command[i])

    @cython.cfunc
    def _bounds(self, command: cython.int, first: cython.int, last: cython.int) -> cython.void:
        self._message(_COMMAND)
        self._byte(command)
        self._message(self._arguments)
        self._byte(first)
        self._byte(last)

    # -- Data

    @cython.cfunc
    def cells(self, count: cython.int) -> cython.void:
        """Send that many cells of the new frame from where the pointer stands."""
        if count <= 0:
            return
        if not self._filling:
            self._command(self._write[0])
        self._message(_DATA)
        self._filling = True
        if self._dry and self.windowed():
            self._pass(count)
            return
        run: cython.int
        while count > 0:
            run = 1
            if self.mode != _VERTICAL:
                run = min(count, (self.ram_width if self.mode == _PAGE else self.window_right) - self.column)
            self._copy(run)
            self.column += run - 1
            self._step()
            count -= run

    @cython.cfunc
    def _pass(self, count: cython.int) -> cython.void:
        """Count cells, and move the pointer past them through the window."""
        todo: cython.int = self.cell_bytes * count
        fitting: cython.int
        while todo > 0:
            self._make_room()
            fitting = min(todo, self._longest - self._length)
            self._length += fitting
            self.total += fitting
            todo -= fitting
        wide: cython.int = self.window_right - self.window_left
        high: cython.int = self.window_bottom - self.window_top
        column: cython.int = self.column - self.window_left
        row: cython.int = self.row - self.window_top
        place: cython.int = count + (row * wide + column if self.mode == _HORIZONTAL else column * high + row)
        place %= wide * high
        if self.mode == _HORIZONTAL:
            row, column = place // wide, place % wide
        else:
            row, column = place % high, place // high
        self.column, self.row = self.window_left + column, self.window_top + row

    @cython.cfunc
    def _copy(self, count: cython.int) -> cython.void:
        """Put cells of one row into the plan, in as many messages as it takes."""
        first: cython.int = self.cell_bytes * (self.column - self.left)
        todo: cython.int = self.cell_bytes * count
        fitting: cython.int
        row: cython.int = self.row - self.top
        while todo > 0:
            self._make_room()
            fitting = min(todo, self._longest - self._length)
            if not self._dry:
                if cython.compiled:
                    memcpy(cython.address(self._out[self._end]), cython.address(self.new[row, first]), fitting)
                else:
                    self._out[self._end : self._end + fitting] = self.new[row, first : first + fitting]
                self._end += fitting
            self._length += fitting
            self.total += fitting
            first += fitting
            todo -= fitting

    @cython.cfunc
    @cython.inline
    @cython.exceptval(check=False)
    def _step(self) -> cython.void:
        """Move the pointer past a cell."""
        if self.mode == _VERTICAL:
            self.row += 1
            if self.row == self.window_bottom:
                self.row = self.window_top
                self.column = self.window_left if self.column + 1 == self.window_right else self.column + 1
            return
        self.column += 1
        if self.mode == _PAGE:
            if self.column == self.ram_width:
                self.column = 0 if self.wraps else -1
        elif self.column == self.window_right:
            self.column = self.window_left
            self.row = self.window_top if self.row + 1 == self.window_bottom else self.row + 1

    # -- Messages

    @cython.cfunc
    def _message(self, kind: cython.int) -> cython.void:
        """Begin a message, unless what follows belongs into the one that is open."""
        if self._kind == kind or (kind == _DATA and self._kind == _CHAINED):
            return
        self.finish()
        self._kind, self._length, self._filling = kind, 0, False
        if kind == _DATA:
            self.total += self.data_cost
        else:
            self.total += self.command_cost if kind == _COMMAND else self.chained_cost
        if not self._dry:
            self._starts[self.messages] = self._end
            self._out[self._end] = kind
            self._end += 1

    @cython.cfunc
    @cython.inline
    def _make_room(self) -> cython.void:
        """Where the message is full, go on in another one."""
        kind: cython.int = self._kind
        filling: cython.bint = self._filling
        if self._length >= self._longest:
            self.finish()
            self._message(kind)
            self._filling = filling

    @cython.cfunc
    def _byte(self, byte: cython.int) -> cython.void:
        self._make_room()
        self.total += 1
        self._length += 1
        if not self._dry:
            self._out[self._end] = byte
            self._end += 1

    @cython.cfunc
    def finish(self) -> cython.void:
        """End the message that is open."""
        if self._kind >= 0 and not self._dry:
            self._stops[self.messages] = self._end
            self.messages += 1
        self._kind, self._filling = -1, False


def _side_by_side(*commands: bytes) -> npt.NDArray[np.uint8]:
    """Commands as rows of an array, each behind its length."""
    rows = np.zeros((len(commands), 1 + max(map(len, commands))), np.uint8)
    for row, command in zip(rows, commands, strict=True):
        row[0] = len(command)
        row[1 : 1 + len(command)] = np.frombuffer(command, np.uint8)
    return rows
