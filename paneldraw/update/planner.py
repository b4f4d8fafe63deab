# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""From the shadow of the panel's RAM and a new frame to a plan of few bytes.

A *piece* is a stretch of changed cells in one row. Which ways there are, the controller says.

**Page pointer.** A plan visits the pieces in some order. Between two of them it either sends the bytes in between, or
begins a new data message after those of the three pointer commands that do not hold already; the pointer moves with
the data and may be driven some bytes further, or the next piece be begun some bytes early, where that spares commands.
So every step has a length, and the cheapest plan is the shortest path through all pieces. Up to `paths.EXACT` (9)
pieces the path is the shortest there is, and no page pointer plan is cheaper. With more it is only the best found:
pieces a byte apart are taken for one, and up to `paths.IMPROVED` (24) the order page by page, left to right is improved
by moving stretches of it; with more that order stays. Such a path is never longer than page by page, and seldom the
shortest: on random frames of 10 to 14 pieces 1 % above it in the mean, 4 bytes at the most.

**Windows.** Boxes are written by windows that are filled across or down. Candidates are the bounding box; boxes grown
from the pieces by joining those that are cheaper together; of these the ones taller than a row, with the page pointer
for the rest; and, with no command at all, the open window onward from where its pointer stands. Boxes are written one
after the other, next always the one of those at hand that costs least beyond its own cells:

- Of its two commands only those go out that do not hold. A window written to its end stands at its start; and its
  edges must be the box's only where data turns, elsewhere data need not reach them.
- A box inside the open window may be reached through it, and one to the right of the pointer or below it may begin
  where the pointer stands, where the cells in between are cheaper than a command.
- The last box ends with its last changed cell. Up to `windows.TURNED` boxes are tried across and down.

The plan is the cheapest of all these; a cheaper one of windows may exist.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import cython
import numpy as np

from paneldraw.transports.base import Plan
from paneldraw.update.messages import PAGE
from paneldraw.update.paths import EXACT, IMPROVED
from paneldraw.update.windows import MOST

if cython.compiled:
    from cython.cimports.libc.string import memcmp
    from cython.cimports.paneldraw.update.messages import Writer
    from cython.cimports.paneldraw.update.paths import shortest_path
    from cython.cimports.paneldraw.update.windows import Windows
else:
    from paneldraw.update.messages import Writer
    from paneldraw.update.paths import shortest_path
    from paneldraw.update.windows import Windows

if TYPE_CHECKING:
    from paneldraw.controllers import Controller
    from paneldraw.transports.base import Cost

_EXACT = cython.declare(cython.int, EXACT)
_IMPROVED = cython.declare(cython.int, IMPROVED)
_PAGE = cython.declare(cython.int, PAGE)
_MOST = cython.declare(cython.int, MOST)
_FAR = cython.declare(cython.int, 1 << 24)
_POINTER = cython.declare(cython.int, 0)
_STREAM = cython.declare(cython.int, 1)
_BOUNDING = cython.declare(cython.int, 2)
_GROWN = cython.declare(cython.int, 3)
_MIXED = cython.declare(cython.int, 4)


@cython.cclass
class Planner:
    """The shadow of one panel's RAM, and the plans from it to the next frame.

    Parameters
    ----------
    controller : Controller
    cost : Cost
        What a message costs on the transport.

    Attributes
    ----------
    fresh : (rows, bytes a row) uint8 array
        The frame to bring onto the panel, packed: write into it, then call `plan`.
    """

    fresh = cython.declare(object, visibility="readonly")
    _plan = cython.declare(object)
    _writer: Writer
    _windows: Windows
    _around: cython.bint
    # Bytes of a jump by its number of pointer commands, and how far it can pay to shift its ends.
    _jumps: cython.int[::1]
    _shifts: cython.int
    _pieces: cython.int[:, ::1]
    _count: cython.int
    _order: cython.int[::1]
    _rest: cython.int[::1]
    _regions: cython.int[::1]
    _lengths: cython.int[:, ::1]
    _table: cython.int[:, ::1]
    # What to do on the step last asked for: send so many bytes in between, or, at -1, jump after so many and before.
    _bridge: cython.int
    _late: cython.int
    _early: cython.int

    def __init__(self, controller: Controller, cost: Cost) -> None:
        wide, high = controller.cell
        rows, width = controller.height // high, controller.width // wide
        limit = rows * (width // 2 + 1) + 1
        payload = rows * (controller.width + 16) + 64
        messages = 8 * limit + (payload // cost.longest if cost.longest else 0)
        self._plan = Plan(payload + messages, messages)
        self._writer = Writer(controller, cost, self._plan)
        self._pieces = np.zeros((limit, 3), np.intc)
        self._windows = Windows(self._writer, self._pieces)
        self._around = self._writer.wraps and controller.width == controller.ram_width
        self.fresh = np.asarray(self._writer.new)
        jumps = [cost.data] + [cost.command + commands + cost.data for commands in (1, 2, 3)]
        if controller.chained_control and cost.chained is not None:
            jumps = [min(jump, cost.chained + 2 * commands) for commands, jump in enumerate(jumps)]
        self._jumps = np.array(jumps, np.intc)
        self._shifts = max(jumps[3] - jumps[1] - 1, 0)
        self._order, self._rest = np.zeros(limit, np.intc), np.zeros(limit, np.intc)
        self._regions = np.zeros(IMPROVED, np.intc)
        self._lengths = np.zeros((IMPROVED + 1, IMPROVED), np.intc)
        self._table = np.zeros((1 << EXACT, EXACT), np.intc)

    def plan(self) -> Plan:
        """Return the cheapest plan found from what the panel holds to `fresh`. It is valid until the next one.

        Once it went out call `sent`; if it failed, `forget`.
        """
        plan = self._plan
        self._writer.begin()
        plan.changed = self._find_pieces()
        if self._count > 0:
            self._choose()
        plan.count, plan.cost = int(self._writer.messages), int(self._writer.total)
        return plan

    def sent(self) -> None:
        """Note that the plan arrived: the panel holds the fresh frame."""
        self._writer.old[:] = self._writer.new
        self._writer.known = True

    def forget(self) -> None:
        """Note that nothing is known of the panel, neither its RAM nor its addressing."""
        self._writer.forget()
        self._writer.known = False

    def restart(self) -> None:
        """Note that the chip took its init: its mode is known, and nothing else."""
        self._writer.restart()
        self._writer.known = False

    # -- What changed

    @cython.cfunc
    def _find_pieces(self) -> cython.int:
        """Find the pieces, apart where the pointer stands; return how many bytes changed."""
        w: Writer = self._writer
        new: cython.uchar[::1]
        old: cython.uchar[::1]
        known: cython.bint = w.known
        size: cython.Py_ssize_t = w.cell_bytes
        row: cython.int
        column: cython.Py_ssize_t
        pointer: cython.int
        start: cython.int
        differ: cython.int
        i: cython.Py_ssize_t
        changed: cython.int = 0
        self._count = 0
        for row in range(w.height):
            if known and self._same(row):
                continue
            pointer = w.column - w.left if row + w.top == w.row else -1
            start = -1
            new, old = w.new[row], w.old[row]
            for column in range(w.width):
                differ = not known or new[size * column] != old[size * column]
                for i in range(size * column + 1, size * (column + 1)):
                    differ += not known or new[i] != old[i]
                changed += differ
                if differ > 0 and start < 0:
                    start = column
                elif start >= 0 and (differ == 0 or column == pointer):
                    self._add_piece(row, start, column)
                    start = column if differ > 0 else -1
            if start >= 0:
                self._add_piece(row, start, w.width)
        return changed

    @cython.cfunc
    def _add_piece(self, row: cython.int, start: cython.int, stop: cython.int) -> cython.void:
        w: Writer = self._writer
        self._pieces[self._count, 0] = row + w.top
        self._pieces[self._count, 1] = start + w.left
        self._pieces[self._count, 2] = stop + w.left
        self._count += 1

    @cython.cfunc
    def _same(self, row: cython.Py_ssize_t) -> cython.bint:
        """Whether nothing changed in a row."""
        w: Writer = self._writer
        if cython.compiled:
            return memcmp(cython.address(w.new[row, 0]), cython.address(w.old[row, 0]), w.new.shape[1]) == 0
        return bytes(w.new[row]) == bytes(w.old[row])

    @cython.cfunc
    def _merge(self, gap: cython.int) -> cython.void:
        """Make one piece of neighbors in a row with no more than `gap` cells between them."""
        piece: cython.int
        last: cython.int = 0
        for piece in range(1, self._count):
            if (
                self._pieces[piece, 0] == self._pieces[last, 0]
                and self._pieces[piece, 1] - self._pieces[last, 2] <= gap
            ):
                self._pieces[last, 2] = self._pieces[piece, 2]
            else:
                last += 1
                self._pieces[last, 0] = self._pieces[piece, 0]
                self._pieces[last, 1] = self._pieces[piece, 1]
                self._pieces[last, 2] = self._pieces[piece, 2]
        self._count = last + 1

    # -- Which way

    @cython.cfunc
    def _choose(self) -> cython.void:
        """Write the cheapest plan found for the pieces."""
        w: Writer = self._writer
        windows: Windows = self._windows
        way: cython.int = _POINTER
        best: cython.int = _FAR
        cost: cython.int
        if w.has_pointer:
            best = self._solve()
            # The first frame goes by page pointer too: small updates follow it more often than windows.
            if not w.has_window or not w.known or (self._count == 1 and w.mode == _PAGE):
                self._write_path(self._order, self._count)
                return
        elif self._count > _MOST:
            self._merge(self._jumps[0])
        stream: cython.int = windows.stream(self._count)
        if stream > 0:
            cost = windows.stream_cost(stream)
            if cost < best:
                best, way = cost, _STREAM
        cost = windows.cost(windows.bounding(self._count))
        if cost < best:
            best, way = cost, _BOUNDING
        grown: cython.int = windows.grown(self._count)
        if grown > 1:
            cost = windows.cost(grown)
            if cost < best:
                best, way = cost, _GROWN
        tall: cython.int = windows.tall_first(grown) if w.has_pointer else 0
        flat: cython.int = self._outside(tall) if tall > 0 else 0
        if 0 < flat < self._count:
            cost = windows.cost(tall) + self._path_cost(self._rest, flat)
            if cost < best:
                best, way = cost, _MIXED
        if way == _POINTER:
            self._write_path(self._order, self._count)
        elif way == _STREAM:
            w.cells(stream)
            w.finish()
        elif way == _MIXED:
            self._write_mixed(tall, flat)
        else:
            windows.write(grown if way == _GROWN else windows.bounding(self._count))

    @cython.cfunc
    def _outside(self, boxes: cython.int) -> cython.int:
        """Put the pieces that lie in none of the first boxes into _rest, in the path's order; return how many."""
        turn: cython.int
        count: cython.int = 0
        for turn in range(self._count):
            if not self._windows.cover(boxes, self._order[turn]):
                self._rest[count] = self._order[turn]
                count += 1
        return count

    @cython.cfunc
    def _write_mixed(self, tall: cython.int, flat: cython.int) -> cython.void:
        """Write boxes as windows and the rest by the page pointer, beginning with what needs no other mode."""
        paged: cython.bint = self._writer.mode == _PAGE
        if paged:
            self._write_path(self._rest, flat)
        self._windows.write(tall)
        if not paged:
            self._write_path(self._rest, flat)

    # -- Steps of the page pointer

    @cython.cfunc
    def _after(self, column: cython.int, cells: cython.int) -> cython.int:
        """The column pointer, so many bytes later."""
        column += cells
        if column < self._writer.ram_width:
            return column
        return column - self._writer.ram_width if self._writer.wraps else -1

    @cython.cfunc
    def _step(self, row: cython.int, column: cython.int, room: cython.int, piece: cython.int) -> cython.int:
        """Bytes from a place to the start of a piece.

        `room` bytes may be sent first to drive the pointer further; -1 stands for the start of a plan.
        """
        w: Writer = self._writer
        to_row: cython.int = self._pieces[piece, 0]
        to_column: cython.int = self._pieces[piece, 1]
        gap: cython.int = to_column - column
        best: cython.int = _FAR
        cost: cython.int
        late: cython.int
        early: cython.int
        first: cython.int
        if row == to_row and column >= w.left:
            if gap < 0 and self._around:
                gap += w.width
            if gap >= 0:
                best, self._bridge = gap + (self._jumps[0] if room < 0 else 0), gap
        for late in range(min(max(room, 0), self._shifts) + 1):
            for early in range(self._shifts - late + 1):
                first = to_column - early
                if first < w.left:
                    if not self._around:
                        break
                    first += w.width
                cost = self._jumps[w.pointer_commands(row, self._after(column, late), to_row, first)] + late + early
                if cost < best:
                    best, self._bridge, self._late, self._early = cost, -1, late, early
                    if cost <= self._jumps[1]:
                        return best
        return best

    @cython.cfunc
    def _step_between(self, one: cython.int, other: cython.int) -> cython.int:
        """Bytes from the end of one piece to the start of another."""
        w: Writer = self._writer
        stop: cython.int = self._pieces[one, 2]
        room: cython.int = w.width if self._around else w.left + w.width - stop
        return self._step(self._pieces[one, 0], self._after(stop, 0), room, other)

    @cython.cfunc
    def _first_step(self, piece: cython.int) -> cython.int:
        """Bytes from where the pointer stands to the start of a piece, a change of mode included."""
        w: Writer = self._writer
        if w.mode != _PAGE:
            self._bridge, self._late, self._early = -1, 0, 0
            return w.command_cost + w.mode_length(_PAGE) + 3 + w.data_cost
        return self._step(w.row, w.column, -1, piece)

    # -- The path

    @cython.cfunc
    def _solve(self) -> cython.int:
        """Put the pieces into the best order there is time to find; return the bytes of the path."""
        i: cython.int
        j: cython.int
        if self._count > _EXACT:
            self._merge(1)
        if self._count > _IMPROVED:
            self._merge(self._jumps[1])
        for i in range(self._count):
            self._order[i] = i
        if 1 < self._count <= _IMPROVED:
            for j in range(self._count):
                self._regions[j] = self._pieces[j, 0]
                self._lengths[0, j] = self._first_step(j)
                for i in range(self._count):
                    self._lengths[i + 1, j] = self._step_between(i, j) if i != j else _FAR
            shortest_path(self._lengths, self._regions, self._table, self._order, self._count)
        return self._path_cost(self._order, self._count)

    @cython.cfunc
    def _path_cost(self, order: cython.int[::1], count: cython.int) -> cython.int:
        """Bytes of a path, pieces included."""
        turn: cython.int
        piece: cython.int
        cost: cython.int = 0
        for turn in range(count):
            piece = order[turn]
            cost += self._first_step(piece) if turn == 0 else self._step_between(order[turn - 1], piece)
            cost += self._pieces[piece, 2] - self._pieces[piece, 1]
        return cost

    @cython.cfunc
    def _write_path(self, order: cython.int[::1], count: cython.int) -> cython.void:
        """Write a path as messages."""
        w: Writer = self._writer
        turn: cython.int
        piece: cython.int
        start: cython.int
        for turn in range(count):
            piece = order[turn]
            if turn == 0:
                self._first_step(piece)
            else:
                self._step_between(order[turn - 1], piece)
            if self._bridge >= 0:
                w.cells(self._bridge)
            else:
                w.cells(self._late)
                start = self._pieces[piece, 1] - self._early
                w.point(self._pieces[piece, 0], start if start >= w.left else start + w.width)
                w.cells(self._early)
            w.cells(self._pieces[piece, 2] - self._pieces[piece, 1])
        w.finish()
