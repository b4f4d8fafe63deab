"""Updates as rectangles: which ones, in which order, and what they cost.

A box is a rectangle of cells, a piece a stretch of them in one row; right and bottom are exclusive.
"""

from __future__ import annotations

import cython
from cython.cimports.paneldraw.update.messages import HORIZONTAL, VERTICAL

if not cython.compiled:
    from types import SimpleNamespace as Box

    Piece = Box

MOST = 128
"""So many boxes are grown; what would be one more joins another."""
WORTHWHILE = cython.declare(cython.int, 24)
"""More boxes than that are not tried where there is a page pointer."""
AHEAD = cython.declare(cython.int, 24)
"""So many boxes are looked at for the one to write next."""
TURNED = cython.declare(cython.int, 4)
"""For up to so many boxes both modes of windows are tried."""
_INFINITY = cython.declare(cython.int, 1 << 24)


class Windows:
    """Boxes around the pieces, and their way through a writer."""

    def __init__(self, writer):
        self.writer = writer
        pieces = self.writer.most_pieces
        if cython.compiled:
            room = pieces * cython.sizeof(Piece) + (MOST + 1) * (cython.sizeof(Box) + cython.sizeof(cython.int))
            self._memory = bytearray(room)
            self.pieces = cython.cast(cython.pointer(Piece), cython.cast(cython.p_char, self._memory))
            self.boxes = cython.cast(cython.pointer(Box), self.pieces + pieces)
            self._turns = cython.cast(cython.p_int, self.boxes + MOST + 1)
        else:
            self.pieces = [Piece() for _ in range(pieces)]
            self.boxes = [Box() for _ in range(MOST + 1)]
            self._turns = [0] * (MOST + 1)
            self._begun = Box()
        # What one more window costs, as a rule: its commands and the framing of two messages.
        self._window_cost = self.writer.data_price(2)

    def stream(self, count):
        """Cells from where the pointer stands in the open window to the last of the pieces; 0 if that is no way."""
        farthest: cython.int = 0
        for i in range(count):
            piece = cython.address(self.pieces[i])
            if not self._inside(piece.left, piece.right, piece.row, piece.row + 1):
                return 0
            farthest = max(farthest, self._reach(piece.left, piece.row, piece.right - 1, piece.row))
        return farthest

    def _inside(self, left, right, top, bottom):
        """Whether the pointer stands in an open window that holds a box."""
        chip = cython.address(self.writer.chip)
        return (
            self.writer.windowed()
            and chip.row >= 0
            and chip.column >= 0
            and 0 <= chip.left <= left
            and right <= chip.right
            and 0 <= chip.top <= top
            and bottom <= chip.bottom
        )

    def _reach(self, left, top, right, bottom):
        """Cells from where the pointer stands in the open window by way of one cell to a later one."""
        chip = cython.address(self.writer.chip)
        wide, high = chip.right - chip.left, chip.bottom - chip.top
        along: cython.int = 1 if chip.mode == HORIZONTAL else high
        down: cython.int = wide if chip.mode == HORIZONTAL else 1
        first = (top - chip.row) * down + (left - chip.column) * along
        last = (bottom - chip.row) * down + (right - chip.column) * along + 1
        if first < 0 < last:
            return wide * high
        return last if first >= 0 else last + wide * high

    # -- Which boxes

    def bounding(self, count):
        """Make one box around all pieces; return 1."""
        box = cython.address(self.boxes[0])
        box.left, box.right = self.pieces[0].left, self.pieces[0].right
        box.top, box.bottom = self.pieces[0].row, self.pieces[count - 1].row + 1
        for i in range(1, count):
            box.left = min(box.left, self.pieces[i].left)
            box.right = max(box.right, self.pieces[i].right)
        return 1

    def grown(self, count):
        """Grow boxes from the pieces, one after the other; return how many, or 0 if they are too many to pay."""
        boxes = self.boxes
        grown: cython.int = 0
        for i in range(count):
            piece = cython.address(self.pieces[i])
            new = grown
            boxes[new].left, boxes[new].right = piece.left, piece.right
            boxes[new].top, boxes[new].bottom = piece.row, piece.row + 1
            grown += 1
            if grown > WORTHWHILE and self.writer.has_pointer:
                return 0
            other = self._partner(new, grown)
            while other >= 0:
                self._join(cython.address(boxes[other]), cython.address(boxes[new]))
                grown -= 1
                boxes[new], boxes[grown] = boxes[grown], boxes[new]
                new = new if other == grown else other
                other = self._partner(new, grown)
        return grown

    def _partner(self, new, count):
        """The box that a new one is best joined to; -1 where none is worth it."""
        best: cython.int = -1
        most: cython.int = 0 if count <= MOST else -_INFINITY
        one = cython.address(self.boxes[new])
        for i in range(count):
            other = cython.address(self.boxes[i])
            # Boxes come by rows: far above, none saves anything.
            if i == new or (most >= 0 and one.top - other.bottom > self._window_cost):
                continue
            saved = self._saved(other, one)
            if saved > most:
                best, most = i, saved
        return best

    def _saved(self, one, other):
        """Bytes that joining two boxes saves."""
        wide = max(one.right, other.right) - min(one.left, other.left)
        high = max(one.bottom, other.bottom) - min(one.top, other.top)
        return self._window_cost + self.writer.cell_bytes * (_area(one) + _area(other) - wide * high)

    def _join(self, one, other):
        """Make one box the one around both."""
        one.left, one.right = min(one.left, other.left), max(one.right, other.right)
        one.top, one.bottom = min(one.top, other.top), max(one.bottom, other.bottom)

    def tall_first(self, count):
        """Bring the boxes of more than one row to the front; return how many they are."""
        boxes = self.boxes
        tall: cython.int = 0
        for i in range(count):
            if boxes[i].bottom - boxes[i].top > 1:
                boxes[i], boxes[tall] = boxes[tall], boxes[i]
                tall += 1
        return tall

    def cover(self, count, piece):
        """Whether one of the first boxes holds a piece whole."""
        for i in range(count):
            box = cython.address(self.boxes[i])
            if box.top <= piece.row < box.bottom and box.left <= piece.left and piece.right <= box.right:
                return True
        return False

    # -- Through the writer

    def stream_cost(self, cells):
        """Bytes that so many cells onward in the open window take."""
        self.writer.rehearse()
        self.writer.cells(cells)
        return self.writer.rehearsed()

    def cost(self, count):
        """Bytes that writing the first boxes takes."""
        return min(self._rehearsed(count, False), self._rehearsed(count, True))

    def write(self, count):
        """Write the first boxes, in the other mode of windows if that pays."""
        turned = self._rehearsed(count, True)
        self._write(count, turned < _INFINITY and turned < self._rehearsed(count, False))

    def write_plainly(self, i):
        """Write a box across, from commands of its own for mode, columns and rows."""
        box = cython.address(self.boxes[i])
        self.writer.set_mode(HORIZONTAL)
        self.writer.window(box.left, box.right, box.top, box.bottom)
        self.writer.cells((box.right - box.left) * (box.bottom - box.top))

    def _rehearsed(self, count, turned):
        """Bytes that writing the first boxes takes in the mode that is set or, turned, in the other one."""
        if turned and (count > TURNED or not self.writer.windowed()):
            return _INFINITY
        self.writer.rehearse()
        self._write(count, turned)
        return self.writer.rehearsed()

    def _write(self, count, turned):
        """Write the first boxes, always the one next that costs least beyond its own cells."""
        w, turns = self.writer, self._turns
        if turned:
            w.set_mode(HORIZONTAL if w.chip.mode == VERTICAL else VERTICAL)
        for i in range(count):
            turns[i] = i
        for done in range(count):
            following = self._next(done, count)
            turns[done], turns[following] = turns[following], turns[done]
            self._write_one(cython.address(self.boxes[turns[done]]), done == count - 1)
        w.finish()

    def _next(self, done, count):
        """The turn of the box to write after so many; the last one needs no search."""
        best: cython.int = done
        least: cython.int = _INFINITY
        turn: cython.int
        for turn in range(done, min(count, done + AHEAD) if done < count - 1 else done):
            price = self._price(cython.address(self.boxes[self._turns[turn]]))
            if price < least:
                best, least = turn, price
        return best

    def _price(self, box):
        """Bytes that a box costs beyond its own cells: on the way to it, or for its commands."""
        w = self.writer
        own = w.cell_bytes * _area(box)
        least = self._begin_early(box) - own
        if self._inside(box.left, box.right, box.top, box.bottom):
            least = min(least, w.data_price(0) + w.cell_bytes * self._reach_of(box, _area(box)) - own)
        return least

    def _begin_early(self, box):
        """Let a box begin where the pointer stands if that is cheaper than to move it; return the box's bytes.

        What becomes of the box is left in `_begun`.
        """
        w, begun = self.writer, cython.address(self._begun)
        row, column = w.chip.row, w.chip.column
        best_left, best_top = box.left, box.top
        begun.left, begun.right, begun.top, begun.bottom = box.left, box.right, box.top, box.bottom
        least = w.data_price(self._commands(begun)) + w.cell_bytes * _area(begun)
        early: cython.int
        for early in range(1, 4 if w.windowed() else 1):
            if (early & 1 and not 0 <= column < box.left) or (early & 2 and not 0 <= row < box.top):
                continue
            begun.left = column if early & 1 else box.left
            begun.top = row if early & 2 else box.top
            cost = w.cell_bytes * _area(begun)
            if cost < least:  # else no commands could be few enough
                cost += w.data_price(self._commands(begun))
            if cost < least:
                least, best_left, best_top = cost, begun.left, begun.top
        begun.left, begun.top = best_left, best_top
        return least

    def _commands(self, box):
        """How many of a window's commands a box needs."""
        columns = self.writer.columns_hold(box.left, box.right, box.bottom - box.top)
        rows = self.writer.rows_hold(box.top, box.bottom, box.right - box.left)
        return 2 - columns - rows

    def _write_one(self, box, last):
        """Write a box, on the way through the open window or as a window; the last only as far as something changed."""
        w, begun = self.writer, cython.address(self._begun)
        if not w.windowed():
            downward = self._idle_tail(box, VERTICAL) > self._idle_tail(box, HORIZONTAL)
            w.set_mode(VERTICAL if downward else HORIZONTAL)
        idle: cython.int = self._idle_tail(box, w.chip.mode) if last else 0
        through: cython.int = 0
        if self._inside(box.left, box.right, box.top, box.bottom):
            through = self._reach_of(box, _area(box) - idle)
        addressed = self._begin_early(box) - w.cell_bytes * idle
        if through > 0 and w.data_price(0) + w.cell_bytes * through < addressed:
            w.cells(through)
            return
        w.window(begun.left, begun.right, begun.top, begun.bottom)
        w.cells(_area(begun) - idle)

    def _reach_of(self, box, cells):
        """Cells from where the pointer stands to so many of a box."""
        wide, high = box.right - box.left, box.bottom - box.top
        last: cython.int = cells - 1
        if self.writer.chip.mode == HORIZONTAL:
            return self._reach(box.left, box.top, box.left + last % wide, box.top + last // wide)
        return self._reach(box.left, box.top, box.left + last // high, box.top + last % high)

    def _idle_tail(self, box, mode):
        """Unchanged cells at the end of a box that is written in one of the two modes."""
        row: cython.int = box.bottom - 1
        column: cython.int = box.right - 1
        idle: cython.int = 0
        while self.writer.held(row, column):
            idle += 1
            if mode == VERTICAL:
                row -= 1
                if row < box.top:
                    row, column = box.bottom - 1, column - 1
            else:
                column -= 1
                if column < box.left:
                    row, column = row - 1, box.right - 1
        return idle


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _area(box: cython.pointer(Box)) -> cython.int:  # type: ignore[valid-type]
    return (box.right - box.left) * (box.bottom - box.top)
