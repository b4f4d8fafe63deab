"""Windows by definition: a RAM that takes messages, and the cheapest way to write some cells, found by trying all."""

from __future__ import annotations

import itertools
from typing import NamedTuple

import numpy as np
from exhaustive import dijkstra

from paneldraw.transports import DATA


class State(NamedTuple):
    """What a chip of windows knows: whether it goes down first; window (None: unknown); pointer (None: unknown)."""

    down: bool
    columns: tuple[int, int] | None
    rows: tuple[int, int] | None
    column: int | None
    row: int | None

    def placed(self):
        return None not in (self.columns, self.rows, self.column, self.row)

    def stepped(self):
        """Move past a cell: across (down) first, at the window's edge on to the next row (column), from the end on
        to the start."""
        (left, right), (top, bottom) = self.columns, self.rows
        column, row = self.column, self.row
        if self.down:
            row += 1
            if row > bottom:
                row, column = top, left if column == right else column + 1
        else:
            column += 1
            if column > right:
                column, row = left, top if row == bottom else row + 1
        return self._replace(column=column, row=row)


class Ram:
    """The RAM of a chip that has windows alone, after its init."""

    def __init__(self, controller):
        wide, high = controller.cell
        self.window, self.arguments_are_data = controller.window, controller.arguments_are_data
        self.bytes = np.zeros((controller.ram_height // high, controller.ram_width // wide * self.window.column_bytes))
        self.state = State(False, None, None, None, None)
        self._command, self._cell = b"", []
        self._writing = False

    def take(self, kind, payload):
        """Take a message. Where arguments go as data, a command byte always begins a command."""
        for byte in payload:
            if kind == DATA and not self.arguments_are_data:
                assert not self._waiting()
                self._data(byte)
            elif kind == DATA and self._writing:
                self._data(byte)
            elif kind == DATA or (not self.arguments_are_data and self._waiting()):
                self._obey(self._command + bytes((byte,)))
            else:
                self._obey(bytes((byte,)))

    def _waiting(self):
        """Whether the last command, of a chip that has no others than these, waits for arguments."""
        window = self.window
        lengths = {window.columns: 3, window.rows: 3, window.across[0]: len(window.across)}
        return bool(self._command) and len(self._command) < lengths[self._command[0]]

    def _obey(self, command):
        window = self.window
        self._command, self._writing = command, command == window.write
        if command[0] == window.columns and len(command) == 3:
            self.state = self.state._replace(columns=(command[1], command[2]), column=command[1])
        elif command[0] == window.rows and len(command) == 3:
            self.state = self.state._replace(rows=(command[1], command[2]), row=command[1])
        elif command in (window.across, window.down):
            self.state = self.state._replace(down=command == window.down, column=None, row=None)

    def _data(self, byte):
        assert self._writing or not self.window.write
        self._cell.append(byte)
        unit = self.window.column_bytes
        if len(self._cell) == unit:
            self.bytes[self.state.row, unit * self.state.column : unit * (self.state.column + 1)] = self._cell
            self._cell, self.state = [], self.state.stepped()


def cheapest(controller, cost, cells, state):
    """Bytes of the cheapest sequence of messages that writes the RAM cells (row, column) at least once.

    Dijkstra's algorithm over what is still to be written, the chip's state and which kind of message is open:
    ``"command"``, ``"argument"`` (where arguments go as data), ``"cells"`` or none.
    """
    window = controller.window
    wide, high = controller.cell
    left, top = controller.column_offset // wide, controller.row_offset // high
    columns = range(left, left + controller.width // wide)
    rows = range(top, top + controller.height // high)
    start = (frozenset(cells), state, "none")
    return dijkstra(
        start,
        lambda node: [*_data(window, cost, node), *_commands(controller, cost, node, columns, rows)],
    )


def _data(window, cost, node):
    todo, state, message = node
    if not state.placed():
        return
    price = window.column_bytes
    if message != "cells":
        price += cost.data
        if window.write:
            price += len(window.write) + (0 if message == "command" else cost.command)
    yield price, (todo - {(state.row, state.column)}, state.stepped(), "cells")


def _commands(controller, cost, node, columns, rows):
    todo, state, message = node

    def price(length):
        opening = 0 if message == "command" else cost.command
        if not controller.arguments_are_data:
            return opening + length, "command"
        return opening + length + cost.data, "argument"

    bounds, after = price(3)
    for first, last in itertools.combinations_with_replacement(columns, 2):
        yield bounds, (todo, state._replace(columns=(first, last), column=first), after)
    for first, last in itertools.combinations_with_replacement(rows, 2):
        yield bounds, (todo, state._replace(rows=(first, last), row=first), after)
    mode, after = price(len(controller.window.across))
    yield mode, (todo, state._replace(down=not state.down, column=None, row=None), after)
