"""From the shadow of the panel's RAM and a new frame to a plan of few bytes.

A *piece* is a stretch of changed cells in one row. Which ways there are, the controller says.

**Page pointer.** A plan visits the pieces in some order. Between two of them it either sends the bytes in between, or
begins a new data message after those of the three pointer commands that do not hold already; the pointer moves with
the data and may be driven some bytes further, or the next piece be begun some bytes early, where that spares commands.
So every step has a length, and the cheapest plan is the shortest path through all pieces. Up to `order.EXACT` (9)
pieces the path is the shortest there is, and no page pointer plan is cheaper. With more it is only the best found:
pieces a byte apart are taken for one, and up to `order.IMPROVED` (24) the order page by page, left to right is improved
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
from cython.cimports.libc.string import memcmp, memcpy
from cython.cimports.paneldraw.update.messages import HORIZONTAL, PAGE, Writer
from cython.cimports.paneldraw.update.order import EXACT, IMPROVED, Order
from cython.cimports.paneldraw.update.windows import MOST, Windows

if TYPE_CHECKING:
    from paneldraw.controllers import Controller
    from paneldraw.transports.base import Cost, Plan

UPDATES = ("least", "plain", "whole")
"""How much is believed of the chip."""

_PLAIN = cython.declare(cython.int, 20)
"""So many runs of two messages go out in one call of an I2C bus."""
_INFINITY = cython.declare(cython.int, 1 << 24)
_POINTER = cython.declare(cython.int, 0)
_STREAM = cython.declare(cython.int, 1)
_BOUNDING = cython.declare(cython.int, 2)
_GROWN = cython.declare(cython.int, 3)
_MIXED = cython.declare(cython.int, 4)
_EQUAL = cython.declare(cython.int, 0)
_DIFFERENT = cython.declare(cython.int, 1)
_MIXTURE = cython.declare(cython.int, 2)


@cython.final
@cython.cclass
class Planner:
    """The shadow of one panel's RAM, and the plans from it to the next frame.

    Parameters
    ----------
    controller : Controller
    cost : Cost
        What a message costs on the transport.
    updates : str, optional
        ``"least"`` (default): the fewest bytes. ``"plain"``: of every run page and columns are sent in full, nothing is
        assumed of the chip's pointers and no control bytes are chained. ``"whole"``: every picture that differs is
        sent whole, as plainly.

    Attributes
    ----------
    fresh : (rows, bytes a row) uint8 array
        The frame to bring onto the panel, packed: write into it, then call `plan`.
    shadow : array like `fresh`
        What the panel holds.
    """

    fresh = cython.declare(object, visibility="readonly")
    shadow = cython.declare(object, visibility="readonly")
    _memory: object
    _plainly: cython.bint
    _whole: cython.bint
    _writer: Writer
    _windows: Windows
    _order: Order
    _around: cython.bint
    # Bytes of a jump by those of its pointer commands, and how far it can pay to shift its ends.
    _jumps: cython.int[5]
    _shifts: cython.int
    _count: cython.int
    # The pieces in the order of the path, and those of them that no window holds.
    _path: cython.p_int
    _rest: cython.p_int
    # What to do on the step last asked for: send so many bytes in between, or, at -1, jump after so many and before.
    _bridge: cython.int
    _late: cython.int
    _early: cython.int

    def __init__(self, controller: Controller, cost: Cost, updates: str = "least") -> None:
        if updates not in UPDATES:
            raise ValueError(f"updates must be one of {', '.join(map(repr, UPDATES))}, not {updates!r}")
        self._plainly, self._whole = updates != "least", updates == "whole"
        self._writer = w = Writer(controller, cost._replace(chained=None) if self._plainly else cost)
        self._windows = Windows(w)
        self._order = Order()
        self.fresh, self.shadow = w.fresh, w.shadow
        self._around = w.wraps and w.width == w.ram_width
        pieces = w.most_pieces
        if cython.compiled:
            self._memory = bytearray(2 * pieces * cython.sizeof(cython.int))
            self._path = cython.cast(cython.p_int, cython.cast(cython.p_char, self._memory))
            self._rest = self._path + pieces
        else:
            self._path, self._rest, self._jumps = [0] * pieces, [0] * pieces, [0] * 5
        for count in range(5):
            jump = w.data_cost + (w.command_cost + count if count > 0 else 0)
            self._jumps[count] = min(jump, w.chained_cost + 2 * count) if w.chained_cost >= 0 else jump
        self._shifts = max(self._jumps[w.pointer_most] - self._jumps[1] - 1, 0)

    def plan(self) -> Plan:
        """Return the cheapest plan found from what the panel holds to `fresh`. It is valid until the next one.

        Once it went out call `sent`; if it failed, `forget`.
        """
        w = self._writer
        plan = w.plan
        w.begin()
        plan.changed = self._find_pieces()
        if self._count > 0 and self._plainly:
            self._write_plainly()
        elif self._count > 0:
            self._choose()
        plan.count, plan.cost = w.messages, w.total
        return plan

    def commands(self, *commands: bytes) -> None:
        """Return no plan: the transport has messages for commands."""

    def sent(self) -> None:
        """Note that the plan arrived: the panel holds the fresh frame."""
        self._writer.sent()

    def forget(self) -> None:
        """Note that nothing is known of the panel, neither its RAM nor its addressing."""
        self._writer.forget()

    def doubt(self) -> None:
        """Note that nothing is known of how the chip is addressed: the next plan depends on what it changes alone."""
        w = self._writer
        w.doubt()
        if w.has_window:
            w.chip.mode = -1

    def restart(self) -> None:
        """Note that the chip took its init: its mode is known, and nothing else."""
        self._writer.restart()

    # -- What changed

    @cython.cfunc
    @cython.exceptval(check=False)
    def _find_pieces(self) -> cython.int:
        """Find the pieces, apart where the pointer stands; return how many bytes changed."""
        w = self._writer
        new, old, known, size = w.new, w.old, w.known, w.cell_bytes
        changed: cython.int = 0
        words: cython.bint = known and size == 1
        self._count = 0
        for row in range(w.height):
            if known and self._same(row):
                continue
            pointer: cython.int = w.chip.column - w.left if row + w.top == w.chip.row else -1
            start: cython.int = -1
            i: cython.int = row * w.width * size
            column: cython.int = -1
            while column + 1 < w.width:
                column += 1
                if words and column & 7 == 0 and column + 8 <= w.width and not column <= pointer < column + 8:
                    alike = self._alike(i)
                    if alike != _MIXTURE:
                        if alike == _DIFFERENT:
                            changed += 8
                            if start < 0:
                                start = column
                        elif start >= 0:
                            self._add_piece(row, start, column)
                            start = -1
                        i += 8
                        column += 7
                        continue
                differ: cython.int = 0
                for _ in range(size):
                    differ += not known or new[i] != old[i]
                    i += 1
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
    @cython.inline
    @cython.exceptval(check=False)
    def _add_piece(self, row: cython.int, start: cython.int, stop: cython.int) -> cython.void:
        piece = cython.address(self._windows.pieces[self._count])
        piece.row = row + self._writer.top
        piece.left, piece.right = start + self._writer.left, stop + self._writer.left
        self._count += 1

    @cython.cfunc
    @cython.inline
    @cython.exceptval(check=False)
    def _alike(self, i: cython.int) -> cython.int:
        """Whether of eight bytes none changed, or each: in one step, which halves the time of a wholly new picture."""
        difference: cython.ulonglong = 0
        held: cython.ulonglong = 0
        if not cython.compiled:
            return _MIXTURE
        memcpy(cython.address(difference), self._writer.new + i, 8)
        memcpy(cython.address(held), self._writer.old + i, 8)
        difference ^= held
        if difference == 0:
            return _EQUAL
        # The lowest byte of 0 borrows from its highest bit.
        ones: cython.ulonglong = 0x0101010101010101
        borrowed: cython.ulonglong = (difference - ones) & ~difference & (ones << 7)
        return _DIFFERENT if borrowed == 0 else _MIXTURE

    @cython.cfunc
    @cython.inline
    @cython.exceptval(check=False)
    def _same(self, row: cython.int) -> cython.bint:
        """Whether nothing changed in a row."""
        w = self._writer
        size = w.width * w.cell_bytes
        first = row * size
        same: cython.bint
        if cython.compiled:
            same = memcmp(w.new + first, w.old + first, size) == 0
        else:
            same = w.new[first : first + size] == w.old[first : first + size]
        return same

    @cython.cfunc
    @cython.exceptval(check=False)
    def _merge(self, gap: cython.int) -> cython.void:
        """Make one piece of neighbors in a row with no more than `gap` cells between them."""
        pieces = self._windows.pieces
        last: cython.int = 0
        for i in range(1, self._count):
            if pieces[i].row == pieces[last].row and pieces[i].left - pieces[last].right <= gap:
                pieces[last].right = pieces[i].right
            else:
                last += 1
                pieces[last], pieces[i] = pieces[i], pieces[last]
        self._count = last + 1

    # -- Which way

    @cython.cfunc
    @cython.exceptval(check=False)
    def _choose(self) -> cython.void:
        """Write the cheapest plan found for the pieces."""
        w, windows = self._writer, self._windows
        way: cython.int = _POINTER
        best: cython.int = _INFINITY
        stream: cython.int = windows.stream(self._count)
        if stream > 0 and stream == self._cells():  # what changed and no command: nothing is cheaper
            w.cells(stream)
            w.finish()
            return
        if w.has_pointer:
            best = self._solve()
            # The first frame goes by page pointer too: small updates follow it more often than windows.
            if not w.has_window or not w.known or (self._count == 1 and w.chip.mode == PAGE):
                self._write_path(self._path, self._count)
                return
        elif self._count > MOST:
            self._merge(self._jumps[0])
        stream = windows.stream(self._count)
        if stream > 0:
            cost = windows.stream_cost(stream)
            if cost < best:
                best, way = cost, _STREAM
        cost = windows.cost(windows.bounding(self._count))
        if cost < best:
            best, way = cost, _BOUNDING
        grown = windows.grown(self._count)
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
            self._write_path(self._path, self._count)
        elif way == _STREAM:
            w.cells(stream)
            w.finish()
        elif way == _MIXED:
            self._write_mixed(tall, flat)
        else:
            windows.write(grown if way == _GROWN else windows.bounding(self._count))

    @cython.cfunc
    @cython.exceptval(check=False)
    def _cells(self) -> cython.int:
        """How many cells the pieces have."""
        cells: cython.int = 0
        for i in range(self._count):
            cells += self._windows.pieces[i].right - self._windows.pieces[i].left
        return cells

    @cython.cfunc
    @cython.exceptval(check=False)
    def _outside(self, boxes: cython.int) -> cython.int:
        """Put the pieces that lie in none of the first boxes into _rest, in the path's order; return how many."""
        count: cython.int = 0
        for turn in range(self._count):
            piece = self._path[turn]
            if not self._windows.cover(boxes, cython.address(self._windows.pieces[piece])):
                self._rest[count] = piece
                count += 1
        return count

    @cython.cfunc
    @cython.exceptval(check=False)
    def _write_mixed(self, tall: cython.int, flat: cython.int) -> cython.void:
        """Write boxes as windows and the rest by the page pointer, beginning with what needs no other mode."""
        paged = self._writer.chip.mode == PAGE
        if paged:
            self._write_path(self._rest, flat)
        self._windows.write(tall)
        if not paged:
            self._write_path(self._rest, flat)

    @cython.cfunc
    @cython.exceptval(check=False)
    def _write_plainly(self) -> cython.void:
        """Write runs, of which each says in full where it goes."""
        w, windows = self._writer, self._windows
        if self._whole:
            w.known = False
            self._find_pieces()
        mode = cython.declare(cython.int, PAGE if w.has_pointer else HORIZONTAL)
        if w.has_window:
            w.chip.mode = -1
        if mode == HORIZONTAL:
            count = windows.grown(self._count)
            if count > _PLAIN:
                count = windows.bounding(self._count)
            for i in range(count):
                w.doubt()
                windows.write_plainly(i)
        else:
            self._merge(self._jumps[w.pointer_most] // w.cell_bytes if self._count <= _PLAIN else w.width)
            for i in range(self._count):
                piece = cython.address(windows.pieces[i])
                w.doubt()
                w.point(piece.row, piece.left)
                w.cells(piece.right - piece.left)
        w.finish()

    # -- Steps of the page pointer

    @cython.cfunc
    @cython.inline
    @cython.exceptval(check=False)
    def _after(self, column: cython.int, cells: cython.int) -> cython.int:
        """The column pointer, so many bytes later."""
        column += cells
        if column < self._writer.ram_width:
            return column
        return column - self._writer.ram_width if self._writer.wraps else -1

    @cython.cfunc
    @cython.exceptval(check=False)
    def _step(self, row: cython.int, column: cython.int, room: cython.int, piece: cython.int) -> cython.int:
        """Bytes from a place to the start of a piece.

        `room` bytes may be sent first to drive the pointer further; -1 stands for the start of a plan.
        """
        w = self._writer
        size = w.cell_bytes
        to_row, to_column = self._windows.pieces[piece].row, self._windows.pieces[piece].left
        gap = to_column - column
        best: cython.int = _INFINITY
        late: cython.int
        early: cython.int
        if row == to_row and column >= w.left:
            if gap < 0 and self._around:
                gap += w.width
            if gap >= 0:
                best, self._bridge = size * gap + (self._jumps[0] if room < 0 else 0), gap
        for late in range(min(max(room, 0), self._shifts) + 1):
            for early in range(self._shifts - late + 1):
                first = to_column - early
                if first < w.left:
                    if not self._around:
                        break
                    first += w.width
                jump = self._jumps[w.pointer_bytes(row, self._after(column, late), to_row, first)]
                cost = jump + size * (late + early)
                if cost < best:
                    best, self._bridge, self._late, self._early = cost, -1, late, early
                    if cost <= self._jumps[1]:
                        return best
        return best

    @cython.cfunc
    @cython.exceptval(check=False)
    def _step_between(self, one: cython.int, other: cython.int) -> cython.int:
        """Bytes from the end of one piece to the start of another."""
        w = self._writer
        row, stop = self._windows.pieces[one].row, self._windows.pieces[one].right
        if w.turns and stop == w.ram_width:
            return self._step(w.following(row), 0, 0, other)
        room: cython.int = w.width if self._around else max(w.left + w.width - stop - w.turns, 0)
        return self._step(row, self._after(stop, 0), room, other)

    @cython.cfunc
    @cython.exceptval(check=False)
    def _first_step(self, piece: cython.int) -> cython.int:
        """Bytes from where the pointer stands to the start of a piece, a change of mode included."""
        w = self._writer
        if w.chip.mode != PAGE:
            self._bridge, self._late, self._early = -1, 0, 0
            return w.command_cost + w.mode_length(PAGE) + w.pointer_most + w.data_cost
        return self._step(w.chip.row, w.chip.column, -1, piece)

    # -- The path

    @cython.cfunc
    @cython.exceptval(check=False)
    def _solve(self) -> cython.int:
        """Put the pieces into the best order there is time to find; return the bytes of the path."""
        order, w = self._order, self._writer
        if self._count > EXACT:
            self._merge(1)
        if self._count > IMPROVED:
            self._merge(self._jumps[1] // w.cell_bytes)
        for i in range(self._count):
            self._path[i] = i
        if 1 < self._count <= IMPROVED:
            for j in range(self._count):
                order.regions[j] = self._windows.pieces[j].row
                order.set_step(-1, j, self._first_step(j))
                for i in range(self._count):
                    if i != j:
                        order.set_step(i, j, self._step_between(i, j))
            order.shorten(self._path, self._count)
        return self._path_cost(self._path, self._count)

    @cython.cfunc
    @cython.exceptval(check=False)
    def _path_cost(self, path: cython.p_int, count: cython.int) -> cython.int:
        """Bytes of a path, pieces included."""
        cost: cython.int = 0
        for turn in range(count):
            piece = path[turn]
            cost += self._first_step(piece) if turn == 0 else self._step_between(path[turn - 1], piece)
            cost += self._writer.cell_bytes * (self._windows.pieces[piece].right - self._windows.pieces[piece].left)
        return cost

    @cython.cfunc
    @cython.exceptval(check=False)
    def _write_path(self, path: cython.p_int, count: cython.int) -> cython.void:
        """Write a path as messages."""
        w = self._writer
        for turn in range(count):
            piece = cython.address(self._windows.pieces[path[turn]])
            if turn == 0:
                self._first_step(path[turn])
            else:
                self._step_between(path[turn - 1], path[turn])
            if self._bridge >= 0:
                w.cells(self._bridge)
            else:
                w.cells(self._late)
                start = piece.left - self._early
                w.point(piece.row, start if start >= w.left else start + w.width)
                w.cells(self._early)
            w.cells(piece.right - piece.left)
        w.finish()
