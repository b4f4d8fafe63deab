# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""Updates as rectangles: which ones, in which order, and what they cost.

A box is a rectangle of cells (left, right, top, bottom), a piece a stretch of them (row, left, right); ends are
exclusive.
"""

from __future__ import annotations

import cython
import numpy as np

from paneldraw.update.messages import HORIZONTAL, VERTICAL

if cython.compiled:
    from cython.cimports.paneldraw.update.messages import Writer
else:
    from paneldraw.update.messages import Writer

MOST = 128
"""So many boxes are grown; what would be one more joins another."""
WORTHWHILE = 24
"""More boxes than that are not tried where there is a page pointer."""
AHEAD = 24
"""So many boxes are looked at for the one to write next."""
TURNED = 4
"""For up to so many boxes both modes of windows are tried."""

_MOST = cython.declare(cython.int, MOST)
_HORIZONTAL = cython.declare(cython.int, HORIZONTAL)
_VERTICAL = cython.declare(cython.int, VERTICAL)
_WORTHWHILE = cython.declare(cython.int, WORTHWHILE)
_AHEAD = cython.declare(cython.int, AHEAD)
_TURNED = cython.declare(cython.int, TURNED)
_FAR = cython.declare(cython.int, 1 << 24)


@cython.cclass
class Windows:
    """Boxes around changed pieces, and their way through a writer."""

    def __init__(self, writer: Writer, pieces: cython.int[:, ::1]) -> None:
        self.writer = writer
        self.pieces = pieces
        self.boxes = np.zeros((MOST + 1, 4), np.intc)
        self._kept = np.zeros_like(self.boxes)
        # What one more window costs, as a rule: its commands and the framing of two messages.
        self._window_cost = writer.data_price(2)

    @cython.cfunc
    def stream(self, count: cython.int) -> cython.int:
        """Cells from where the pointer stands in the open window to the last of the pieces; 0 if that is no way."""
        farthest: cython.int = 0
        i: cython.int
        for i in range(count):
            if not self._inside(self.pieces[i, 1], self.pieces[i, 2], self.pieces[i, 0], self.pieces[i, 0] + 1):
                return 0
            farthest = max(
                farthest, self._reach(self.pieces[i, 1], self.pieces[i, 0], self.pieces[i, 2] - 1, self.pieces[i, 0])
            )
        return farthest

    @cython.cfunc
    @cython.exceptval(check=False)
    def _inside(self, left: cython.int, right: cython.int, top: cython.int, bottom: cython.int) -> cython.bint:
        """Whether the pointer stands in an open window that holds a box."""
        w: Writer = self.writer
        return (
            w.windowed()
            and w.row >= 0
            and w.column >= 0
            and 0 <= w.window_left <= left
            and right <= w.window_right
            and 0 <= w.window_top <= top
            and bottom <= w.window_bottom
        )

    @cython.cfunc
    @cython.exceptval(check=False)
    def _reach(self, left: cython.int, top: cython.int, right: cython.int, bottom: cython.int) -> cython.int:
        """Cells from where the pointer stands in the open window by way of one cell to a later one."""
        w: Writer = self.writer
        wide: cython.int = w.window_right - w.window_left
        high: cython.int = w.window_bottom - w.window_top
        along: cython.int = 1 if w.mode == _HORIZONTAL else high
        down: cython.int = wide if w.mode == _HORIZONTAL else 1
        first: cython.int = (top - w.row) * down + (left - w.column) * along
        last: cython.int = (bottom - w.row) * down + (right - w.column) * along + 1
        if first < 0 < last:
            return wide * high
        return last if first >= 0 else last + wide * high

    # -- Which boxes

    @cython.cfunc
    def bounding(self, count: cython.int) -> cython.int:
        """Make one box around all pieces; return 1."""
        box: cython.int[:, ::1] = self.boxes
        i: cython.int
        box[0, 0], box[0, 1] = self.pieces[0, 1], self.pieces[0, 2]
        box[0, 2], box[0, 3] = self.pieces[0, 0], self.pieces[count - 1, 0] + 1
        for i in range(1, count):
            box[0, 0] = min(box[0, 0], self.pieces[i, 1])
            box[0, 1] = max(box[0, 1], self.pieces[i, 2])
        return 1

    @cython.cfunc
    def grown(self, count: cython.int) -> cython.int:
        """Grow boxes from the pieces, one after the other; return how many, or 0 if they are too many to pay."""
        box: cython.int[:, ::1] = self.boxes
        piece: cython.int
        new: cython.int
        other: cython.int
        boxes: cython.int = 0
        for piece in range(count):
            box[boxes, 0], box[boxes, 1] = self.pieces[piece, 1], self.pieces[piece, 2]
            box[boxes, 2], box[boxes, 3] = self.pieces[piece, 0], self.pieces[piece, 0] + 1
            new = boxes
            boxes += 1
            if boxes > _WORTHWHILE and self.writer.has_pointer:
                return 0
            other = self._partner(new, boxes)
            while other >= 0:
                self._join(other, new)
                boxes -= 1
                self._swap(new, boxes)
                new = new if other == boxes else other
                other = self._partner(new, boxes)
        return boxes

    @cython.cfunc
    def _partner(self, new: cython.int, boxes: cython.int) -> cython.int:
        """The box that a new one is best joined to; -1 where none is worth it."""
        i: cython.int
        saved: cython.int
        best: cython.int = -1
        most: cython.int = 0 if boxes <= _MOST else -_FAR
        for i in range(boxes):
            # Boxes come by rows: far above, none saves anything.
            if i == new or (most >= 0 and self.boxes[new, 2] - self.boxes[i, 3] > self._window_cost):
                continue
            saved = self._saved(i, new)
            if saved > most:
                best, most = i, saved
        return best

    @cython.cfunc
    @cython.inline
    def _saved(self, i: cython.int, j: cython.int) -> cython.int:
        """Bytes that joining two boxes saves."""
        box: cython.int[:, ::1] = self.boxes
        wide: cython.int = max(box[i, 1], box[j, 1]) - min(box[i, 0], box[j, 0])
        high: cython.int = max(box[i, 3], box[j, 3]) - min(box[i, 2], box[j, 2])
        one: cython.int = (box[i, 1] - box[i, 0]) * (box[i, 3] - box[i, 2])
        other: cython.int = (box[j, 1] - box[j, 0]) * (box[j, 3] - box[j, 2])
        return self._window_cost + self.writer.cell_bytes * (one + other - wide * high)

    @cython.cfunc
    def _join(self, one: cython.int, other: cython.int) -> cython.void:
        """Make one box the one around both."""
        box: cython.int[:, ::1] = self.boxes
        box[one, 0] = min(box[one, 0], box[other, 0])
        box[one, 1] = max(box[one, 1], box[other, 1])
        box[one, 2] = min(box[one, 2], box[other, 2])
        box[one, 3] = max(box[one, 3], box[other, 3])

    @cython.cfunc
    def _swap(self, one: cython.int, other: cython.int) -> cython.void:
        side: cython.int
        kept: cython.int
        for side in range(4):
            kept = self.boxes[one, side]
            self.boxes[one, side] = self.boxes[other, side]
            self.boxes[other, side] = kept

    @cython.cfunc
    def tall_first(self, count: cython.int) -> cython.int:
        """Bring the boxes of more than one row to the front; return how many they are."""
        i: cython.int
        tall: cython.int = 0
        for i in range(count):
            if self.boxes[i, 3] - self.boxes[i, 2] > 1:
                self._swap(i, tall)
                tall += 1
        return tall

    @cython.cfunc
    def cover(self, boxes: cython.int, piece: cython.int) -> cython.bint:
        """Whether one of the first boxes holds a piece whole."""
        i: cython.int
        for i in range(boxes):
            if (
                self.boxes[i, 2] <= self.pieces[piece, 0] < self.boxes[i, 3]
                and self.boxes[i, 0] <= self.pieces[piece, 1]
                and self.pieces[piece, 2] <= self.boxes[i, 1]
            ):
                return True
        return False

    # -- Through the writer

    @cython.cfunc
    def stream_cost(self, stream: cython.int) -> cython.int:
        """Bytes that so many cells onward in the open window take."""
        self.writer.rehearse()
        self.writer.cells(stream)
        return self.writer.rehearsed()

    @cython.cfunc
    def cost(self, count: cython.int) -> cython.int:
        """Bytes that writing the first boxes takes."""
        return min(self._rehearsed(count, False), self._rehearsed(count, True))

    @cython.cfunc
    def write(self, count: cython.int) -> cython.void:
        """Write the first boxes, in the other mode of windows if that pays."""
        turned: cython.int = self._rehearsed(count, True)
        self._write(count, turned < _FAR and turned < self._rehearsed(count, False))

    @cython.cfunc
    def _rehearsed(self, count: cython.int, turned: cython.bint) -> cython.int:
        """Bytes that writing the first boxes takes in the mode that is set or, turned, in the other one."""
        w: Writer = self.writer
        if turned and (count > _TURNED or not w.windowed()):
            return _FAR
        self._copy(self.boxes, self._kept, count)
        w.rehearse()
        self._write(count, turned)
        self._copy(self._kept, self.boxes, count)
        return w.rehearsed()

    @cython.cfunc
    def _copy(self, source: cython.int[:, ::1], target: cython.int[:, ::1], count: cython.int) -> cython.void:
        i: cython.int
        side: cython.int
        for i in range(count):
            for side in range(4):
                target[i, side] = source[i, side]

    @cython.cfunc
    def _write(self, count: cython.int, turned: cython.bint) -> cython.void:
        """Write the first boxes, always the one next that costs least beyond its own cells."""
        w: Writer = self.writer
        done: cython.int
        i: cython.int
        price: cython.int
        best: cython.int
        least: cython.int
        if turned:
            w.set_mode(_HORIZONTAL if w.mode == _VERTICAL else _VERTICAL)
        for done in range(count):
            best, least = done, _FAR
            for i in range(done, min(count, done + _AHEAD) if done < count - 1 else done):
                price = self._price(i)
                if price < least:
                    best, least = i, price
            self._swap(done, best)
            self._write_one(done, done == count - 1)
        w.finish()

    @cython.cfunc
    def _price(self, i: cython.int) -> cython.int:
        """Bytes that a box costs beyond its own cells: on the way to it, or for its commands."""
        box: cython.int[:, ::1] = self.boxes
        w: Writer = self.writer
        left: cython.int = box[i, 0]
        top: cython.int = box[i, 2]
        own: cython.int = w.cell_bytes * self._area(i)
        least: cython.int = self._begin_early(i) - own
        box[i, 0], box[i, 2] = left, top
        if self._inside(left, box[i, 1], top, box[i, 3]):
            least = min(least, w.data_price(0) + w.cell_bytes * self._reach_of(i, self._area(i)) - own)
        return least

    @cython.cfunc
    def _begin_early(self, i: cython.int) -> cython.int:
        """Let a box begin where the pointer stands if that is cheaper than to move it; return the box's bytes."""
        box: cython.int[:, ::1] = self.boxes
        w: Writer = self.writer
        left: cython.int = box[i, 0]
        top: cython.int = box[i, 2]
        best_left: cython.int = left
        best_top: cython.int = top
        least: cython.int = w.data_price(self._commands(i)) + w.cell_bytes * self._area(i)
        cost: cython.int
        early: cython.int
        for early in range(1, 4 if w.windowed() else 1):
            if (early & 1 and not 0 <= w.column < left) or (early & 2 and not 0 <= w.row < top):
                continue
            box[i, 0] = w.column if early & 1 else left
            box[i, 2] = w.row if early & 2 else top
            cost = w.cell_bytes * self._area(i)
            if cost < least:  # else no commands could be few enough
                cost += w.data_price(self._commands(i))
            if cost < least:
                least, best_left, best_top = cost, box[i, 0], box[i, 2]
        box[i, 0], box[i, 2] = best_left, best_top
        return least

    @cython.cfunc
    @cython.inline
    @cython.exceptval(check=False)
    def _area(self, i: cython.int) -> cython.int:
        return (self.boxes[i, 1] - self.boxes[i, 0]) * (self.boxes[i, 3] - self.boxes[i, 2])

    @cython.cfunc
    def _commands(self, i: cython.int) -> cython.int:
        """How many of a window's commands a box needs."""
        box: cython.int[:, ::1] = self.boxes
        w: Writer = self.writer
        columns: cython.bint = w.columns_hold(box[i, 0], box[i, 1], box[i, 3] - box[i, 2])
        rows: cython.bint = w.rows_hold(box[i, 2], box[i, 3], box[i, 1] - box[i, 0])
        return 2 - columns - rows

    @cython.cfunc
    def _write_one(self, i: cython.int, last: cython.bint) -> cython.void:
        """Write a box, on the way through the open window or as a window; the last only as far as something changed."""
        box: cython.int[:, ::1] = self.boxes
        w: Writer = self.writer
        if not w.windowed():
            downward: cython.bint = self._idle_tail(i, _VERTICAL) > self._idle_tail(i, _HORIZONTAL)
            w.set_mode(_VERTICAL if downward else _HORIZONTAL)
        idle: cython.int = self._idle_tail(i, w.mode) if last else 0
        through: cython.int = 0
        if self._inside(box[i, 0], box[i, 1], box[i, 2], box[i, 3]):
            through = self._reach_of(i, self._area(i) - idle)
        addressed: cython.int = self._begin_early(i) - w.cell_bytes * idle
        if through > 0 and w.data_price(0) + w.cell_bytes * through < addressed:
            w.cells(through)
            return
        w.window(box[i, 0], box[i, 1], box[i, 2], box[i, 3])
        w.cells(self._area(i) - idle)

    @cython.cfunc
    def _reach_of(self, i: cython.int, cells: cython.int) -> cython.int:
        """Cells from where the pointer stands to so many of a box."""
        box: cython.int[:, ::1] = self.boxes
        wide: cython.int = box[i, 1] - box[i, 0]
        high: cython.int = box[i, 3] - box[i, 2]
        last: cython.int = cells - 1
        if self.writer.mode == _HORIZONTAL:
            return self._reach(box[i, 0], box[i, 2], box[i, 0] + last % wide, box[i, 2] + last // wide)
        return self._reach(box[i, 0], box[i, 2], box[i, 0] + last // high, box[i, 2] + last % high)

    @cython.cfunc
    def _idle_tail(self, i: cython.int, mode: cython.int) -> cython.int:
        """Unchanged cells at the end of a box that is written in one of the two modes."""
        box: cython.int[:, ::1] = self.boxes
        row: cython.int = box[i, 3] - 1
        column: cython.int = box[i, 1] - 1
        idle: cython.int = 0
        while self.writer.held(row, column):
            idle += 1
            if mode == _VERTICAL:
                row -= 1
                if row < box[i, 2]:
                    row, column = box[i, 3] - 1, column - 1
            else:
                column -= 1
                if column < box[i, 0]:
                    row, column = row - 1, box[i, 1] - 1
        return idle
