"""The messages of a plan, and what they leave in the chip's addressing registers.

A cell is what one address of the chip's RAM holds, a row a page of cells where the chip has pages. Columns and rows
are those of the RAM; window ends are exclusive.
"""

from __future__ import annotations

from copy import copy

import cython
import numpy as np
from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER
from cython.cimports.libc.string import memcpy

from paneldraw.controllers.record import PagePointer
from paneldraw.transports.base import CHAINED, COMMAND, DATA, Plan

if not cython.compiled:
    from types import SimpleNamespace as Registers

HORIZONTAL, VERTICAL, PAGE = 0, 1, 2
"""Windows filled across, windows filled down, and the page pointer."""

_COMMAND = cython.declare(cython.int, COMMAND)
_DATA = cython.declare(cython.int, DATA)
_CHAINED = cython.declare(cython.int, CHAINED)
_UNLIMITED = cython.declare(cython.int, 1 << 30)


class Writer:
    """Writes messages into a plan, counts their bytes, and follows the chip: a register of -1 is unknown.

    Rehearsed messages are counted, and leave no trace.
    """

    def __init__(self, controller, cost):
        wide: cython.int
        high: cython.int
        wide, high = controller.cell
        pointer, window = controller.pointer, controller.window
        self.left, self.top = controller.column_offset // wide, controller.row_offset // high
        self.width = controller.width * controller.bands // wide
        self.height = -(-controller.height // (controller.bands * high))
        self.ram_width, self.ram_height = controller.ram_width // wide, controller.ram_height // high
        self.has_pointer, self.has_window = pointer is not None, window is not None
        self.wraps = pointer is not None and pointer.wraps
        self._set_pointer(pointer if pointer is not None else PagePointer())
        self.cell_bytes, self._columns, self._rows, self._write = controller.cell_bytes, 0, 0, b""
        across = down = b""
        if window is not None:
            self._write = window.write
            self._columns, self._rows, across, down = window.columns, window.rows, window.across, window.down
        self._modes = (across, down, pointer.mode if pointer is not None else b"")
        self._arguments = _DATA if controller.arguments_are_data else _COMMAND
        self.command_cost, self.data_cost = cost.command, cost.data
        self.chained_cost = -1 if cost.chained is None or not controller.chained_control else cost.chained
        self._longest = _UNLIMITED if cost.longest is None else cost.longest
        self._make_room_for(controller.width * controller.bands)
        self._rehearsing, self._kind, self._length, self._filling = False, -1, 0, False
        self.begin()
        self.forget()

    def _set_pointer(self, pointer):
        """Take in how the page pointer is moved."""
        self._row_command, self._row_bytes, self._paired = pointer.row, 1 + pointer.row_argument, pointer.paired
        self.turns = pointer.turns
        self._column_command = -1 if pointer.column is None else pointer.column
        self.pointer_most = self._row_bytes + (2 if pointer.column is None else 1)

    def _make_room_for(self, width):
        """Make the frames and a plan of a panel of this width."""
        self.fresh = np.zeros((self.height, self.width * self.cell_bytes), np.uint8)
        self.shadow = np.zeros_like(self.fresh)
        self.most_pieces = self.height * (self.width // 2 + 1) + 1
        payload = self.height * (width + 16) + 64
        messages = 8 * self.most_pieces + payload // max(self._longest, 1)
        self.plan = Plan(payload + messages, messages)
        self.new = cython.cast(cython.p_uchar, _memory(self.fresh.reshape(-1).data))
        self.old = cython.cast(cython.p_uchar, _memory(self.shadow.reshape(-1).data))
        self._out = cython.cast(cython.p_uchar, _memory(self.plan.buffer.data))
        self._starts = cython.cast(cython.p_Py_ssize_t, _memory(self.plan.starts))
        self._stops = cython.cast(cython.p_Py_ssize_t, _memory(self.plan.stops))
        if not cython.compiled:
            self.chip = Registers()

    def sent(self):
        """Know that the chip holds the new frame."""
        _copy_bytes(self.old, 0, self.new, 0, self.height * self.width * self.cell_bytes)
        self.known = True

    def forget(self):
        """Know nothing of the chip, neither its RAM nor its registers."""
        self.known = False
        self.chip.mode = -1 if self.has_window else PAGE
        self.chip.row = self.chip.column = -1
        self.chip.left = self.chip.right = self.chip.top = self.chip.bottom = -1

    def restart(self):
        """Know what the chip's init leaves."""
        self.forget()
        self.chip.mode = PAGE if self.has_pointer else HORIZONTAL

    def held(self, row, column):
        """Whether the panel holds a cell of the new frame already."""
        first = self.cell_bytes * ((row - self.top) * self.width + column - self.left)
        for i in range(first, first + self.cell_bytes):
            if self.new[i] != self.old[i]:
                return False
        return self.known

    def begin(self):
        """Begin a plan."""
        self._end = self.messages = self.total = 0

    def rehearse(self):
        """Only count, until `rehearsed`. No message is open."""
        self._rehearsing, self._counted = True, self.total
        self._before = self.chip if cython.compiled else copy(self.chip)

    def rehearsed(self):
        """Return the bytes counted; everything else is as it was before."""
        self.finish()
        counted = self.total - self._counted
        self._rehearsing, self.total, self.chip = False, self._counted, self._before
        return counted

    # -- Where data goes

    def windowed(self):
        """Whether the chip is in a mode of windows."""
        return self.chip.mode == HORIZONTAL or self.chip.mode == VERTICAL

    def doubt(self):
        """Believe nothing of the chip's pointers and windows."""
        self.chip.row = self.chip.column = -1
        self.chip.left = self.chip.right = self.chip.top = self.chip.bottom = -1

    def pointer_bytes(self, row, column, to_row, to_column):
        """How many bytes of commands lead the page pointer from one place to another."""
        if self._paired and (row != to_row or column != to_column):
            return self.pointer_most
        price: cython.int = self._row_bytes if row != to_row else 0
        if self._column_command >= 0:
            return price + (column != to_column)
        if column < 0:
            return price + 2
        return price + ((column ^ to_column) & 15 != 0) + (column >> 4 != to_column >> 4)

    def point(self, row, column):
        """Send those of row, lower and upper half of the column pointer that do not hold."""
        self.set_mode(PAGE)
        chip = cython.address(self.chip)
        count = self.pointer_bytes(chip.row, chip.column, row, column)
        chained = (
            self._kind != _COMMAND
            and self.chained_cost >= 0
            and self.chained_cost + 2 * count < self.command_cost + count + self.data_cost
        )
        if chained:
            self.finish()
        self._message(_CHAINED if chained else _COMMAND)
        if chip.row != row or self._paired:
            self._point_row(row)
        if self._column_command >= 0:
            if chip.column != column or self._paired:
                self._pointer_byte(self._column_command + column)
        else:
            if chip.column < 0 or (chip.column ^ column) & 15 != 0:
                self._pointer_byte(column & 15)
            if chip.column < 0 or chip.column >> 4 != column >> 4:
                self._pointer_byte(0x10 + (column >> 4))
        if chained:
            self._byte(_DATA)
        chip.row, chip.column = row, column

    def _point_row(self, row):
        if self._row_bytes == 1:
            self._pointer_byte(self._row_command + row)
        else:
            self._pointer_byte(self._row_command)
            self._pointer_byte(row)

    def _pointer_byte(self, command):
        """Put a byte of a pointer command, behind a control byte of its own in a chained message."""
        if self._kind == _CHAINED and self._length > 0:
            self._byte(_CHAINED)
        self._byte(command)

    def mode_length(self, mode):
        """How many bytes the command of a mode has."""
        return len(self._modes[mode])

    def columns_hold(self, left, right, rows):
        """Whether a box of so many rows needs no command for its columns.

        Where data turns, the window's edges must be the box's; elsewhere it is enough that it gets so far.
        """
        chip = cython.address(self.chip)
        if chip.column != left or not self.windowed():
            return False
        if chip.mode == VERTICAL or rows == 1:
            return chip.right >= right
        return chip.left == left and chip.right == right

    def rows_hold(self, top, bottom, columns):
        """Whether a box of so many columns needs no command for its rows."""
        chip = cython.address(self.chip)
        if chip.row != top or not self.windowed():
            return False
        if chip.mode == HORIZONTAL or columns == 1:
            return chip.bottom >= bottom
        return chip.top == top and chip.bottom == bottom

    def data_price(self, bounds):
        """Bytes from here to the first cell after so many of a window's two commands."""
        price: cython.int = 0
        commanding = self._kind == _COMMAND
        if bounds == 0 and self._filling:
            return 0
        if self._arguments == _DATA:
            price = bounds * (self.command_cost + 3 + self.data_cost)
            commanding = False
        elif bounds > 0:
            price = 3 * bounds + (0 if commanding else self.command_cost)
            commanding = True
        if self._write:
            price += len(self._write) + (0 if commanding else self.command_cost)
        return price + self.data_cost

    def window(self, left, right, top, bottom):
        """Bring the pointer to the start of a box, in a mode of windows, with what does not hold."""
        chip = cython.address(self.chip)
        if not self.columns_hold(left, right, bottom - top):
            self._bounds(self._columns, left, right - 1)
            chip.left, chip.right, chip.column = left, right, left
        if not self.rows_hold(top, bottom, right - left):
            self._bounds(self._rows, top, bottom - 1)
            chip.top, chip.bottom, chip.row = top, bottom, top

    def set_mode(self, mode):
        """Set the addressing mode unless it holds. No datasheet says where the pointer is afterwards."""
        if self.chip.mode != mode:
            self._command(self._modes[mode])
            self.chip.mode, self.chip.row, self.chip.column = mode, -1, -1

    def _command(self, command):
        """Send a command's first byte, and then its arguments."""
        kind = _COMMAND
        for byte in command:
            self._message(kind)
            self._byte(byte)
            kind = self._arguments

    def _bounds(self, command, first, last):
        self._message(_COMMAND)
        self._byte(command)
        self._message(self._arguments)
        self._byte(first)
        self._byte(last)

    # -- Data

    def cells(self, count):
        """Send that many cells of the new frame from where the pointer stands."""
        if count <= 0:
            return
        if not self._filling:
            self._command(self._write)
        self._message(_DATA)
        self._filling = True
        if self._rehearsing and self.windowed():
            self._pass(count)
            return
        chip = cython.address(self.chip)
        run: cython.int
        while count > 0:
            run = 1
            if chip.mode != VERTICAL:
                run = min(count, (self.ram_width if chip.mode == PAGE else chip.right) - chip.column)
            self._put(run)
            chip.column += run - 1
            self._step()
            count -= run

    def _pass(self, count):
        """Count cells, and move the pointer past them through the window."""
        chip = cython.address(self.chip)
        todo = self.cell_bytes * count
        while todo > 0:
            self._make_room()
            fitting = min(todo, self._longest - self._length)
            self._length += fitting
            self.total += fitting
            todo -= fitting
        wide, high = chip.right - chip.left, chip.bottom - chip.top
        column, row = chip.column - chip.left, chip.row - chip.top
        place = (count + (row * wide + column if chip.mode == HORIZONTAL else column * high + row)) % (wide * high)
        if chip.mode == HORIZONTAL:
            row, column = place // wide, place % wide
        else:
            row, column = place % high, place // high
        chip.column, chip.row = chip.left + column, chip.top + row

    def _put(self, count):
        """Put cells of one row into the plan, in as many messages as it takes."""
        first = self.cell_bytes * ((self.chip.row - self.top) * self.width + self.chip.column - self.left)
        todo = self.cell_bytes * count
        while todo > 0:
            self._make_room()
            fitting = min(todo, self._longest - self._length)
            if not self._rehearsing:
                _copy_bytes(self._out, self._end, self.new, first, fitting)
                self._end += fitting
            self._length += fitting
            self.total += fitting
            first += fitting
            todo -= fitting

    def _step(self):
        """Move the pointer past a cell."""
        chip = cython.address(self.chip)
        if chip.mode == VERTICAL:
            chip.row += 1
            if chip.row == chip.bottom:
                chip.row = chip.top
                chip.column = chip.left if chip.column + 1 == chip.right else chip.column + 1
            return
        chip.column += 1
        if chip.mode == PAGE:
            if chip.column == self.ram_width:
                chip.column = 0 if self.wraps or self.turns else -1
                if self.turns:
                    chip.row = self.following(chip.row)
        elif chip.column == chip.right:
            chip.column = chip.left
            chip.row = chip.top if chip.row + 1 == chip.bottom else chip.row + 1

    def following(self, row):
        """The row after a row, where data turns."""
        return row + 1 if row + 1 < self.ram_height else 0

    # -- Messages

    def _message(self, kind):
        """Begin a message, unless what follows belongs into the one that is open."""
        if self._kind == kind or (kind == _DATA and self._kind == _CHAINED):
            return
        self.finish()
        self._kind, self._length, self._filling = kind, 0, False
        if kind == _DATA:
            self.total += self.data_cost
        else:
            self.total += self.command_cost if kind == _COMMAND else self.chained_cost
        if not self._rehearsing:
            self._starts[self.messages] = self._end
            self._out[self._end] = cython.cast(cython.uchar, kind)
            self._end += 1

    def _make_room(self):
        """Where the message is full, go on in another one."""
        if self._length >= self._longest:
            kind, filling = self._kind, self._filling
            self.finish()
            self._message(kind)
            self._filling = filling

    def _byte(self, byte):
        self._make_room()
        self.total += 1
        self._length += 1
        if not self._rehearsing:
            self._out[self._end] = cython.cast(cython.uchar, byte)
            self._end += 1

    def finish(self):
        """End the message that is open."""
        if self._kind >= 0 and not self._rehearsing:
            self._stops[self.messages] = self._end
            self.messages += 1
        self._kind, self._filling = -1, False


@cython.cfunc
def _memory(view: memoryview) -> cython.p_void:
    """Where the memory of a memoryview begins."""
    return PyMemoryView_GET_BUFFER(view).buf if cython.compiled else view


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _copy_bytes(
    target: cython.p_uchar, at: cython.Py_ssize_t, source: cython.p_uchar, first: cython.Py_ssize_t, count: cython.int
) -> cython.void:
    """Copy so many bytes from a place of one memory to a place of another."""
    if cython.compiled:
        memcpy(target + at, source + first, count)
    else:
        target[at : at + count] = source[first : first + count]
