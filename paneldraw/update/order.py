"""In which order to visit places: the travelling salesman's problem, from a start to wherever the path ends.

Steps differ by direction. Places belong to regions, and come region by region.
"""

from __future__ import annotations

import cython

EXACT = 9
"""Up to so many places the path is the shortest there is."""
IMPROVED = 24
"""Up to so many it is improved step by step, until no move makes it shorter, which need not be the shortest; more are
not to be asked of this module."""

_INFINITY = cython.declare(cython.int, 1 << 24)
_SEGMENT = cython.declare(cython.int, 3)


class Order:
    """The lengths of all steps between up to `IMPROVED` places, and the search for a short path by them.

    ``regions[j]`` is the region of place j.
    """

    def __init__(self):
        lengths: cython.int = (IMPROVED + 1) * IMPROVED
        table: cython.int = EXACT << EXACT
        if cython.compiled:
            self._memory = bytearray(cython.sizeof(cython.int) * (lengths + IMPROVED + table))
            self._lengths = cython.cast(cython.p_int, cython.cast(cython.p_char, self._memory))
            self.regions = self._lengths + lengths
            self._table = self.regions + IMPROVED
        else:
            self._lengths, self.regions, self._table = [0] * lengths, [0] * IMPROVED, [0] * table

    def set_step(self, i, j, length):
        """Set the length of the step from place i to place j; -1 is the start."""
        self._lengths[(i + 1) * IMPROVED + j] = length

    def step(self, i, j):
        """Length of the step from place i to place j; -1 is the start."""
        return self._lengths[(i + 1) * IMPROVED + j]

    def shorten(self, order, count):
        """Put 1 to `IMPROVED` places, given as 0, 1, 2, ..., into a good order; return the length of the path."""
        self._order, self._count = order, count
        length: cython.int = 0
        for i in range(count):
            length += self.step(i - 1, i)
        bound = self._bound()
        if length <= bound:
            return length
        return self._exact() if count <= EXACT else self._improved(length, bound)

    def _bound(self):
        """No path is shorter: every place is reached by some step, and one place of each region from outside of it."""
        bound: cython.int = 0
        detour: cython.int = 0
        for j in range(self._count):
            nearest, outside = _INFINITY, self.step(-1, j)
            for i in range(self._count):
                if self.regions[i] != self.regions[j]:
                    outside = min(outside, self.step(i, j))
                elif i != j:
                    nearest = min(nearest, self.step(i, j))
            nearest = min(nearest, outside)
            if j == 0 or self.regions[j] != self.regions[j - 1]:
                bound += detour
                detour = _INFINITY
            detour = min(detour, outside - nearest)
            bound += nearest
        return bound + detour

    def _exact(self):
        """Set by set, the shortest way to have visited the places of a set and to stand at one of them.

        M. Held, R. M. Karp, "A dynamic programming approach to sequencing problems", J. SIAM 10 (1962), 196-210.
        """
        count, table = self._count, self._table
        visited: cython.int
        for visited in range(1, 1 << count):
            for last in range(count):
                if not visited >> last & 1:
                    continue
                others = visited ^ (1 << last)
                best = self.step(-1, last) if others == 0 else _INFINITY
                for i in range(count):
                    if others >> i & 1:
                        best = min(best, table[others * EXACT + i] + self.step(i, last))
                table[visited * EXACT + last] = best
        return self._walk_back()

    def _walk_back(self):
        """Follow the table from the set of all places to that of one."""
        count, table = self._count, self._table
        visited: cython.int = (1 << count) - 1
        total: cython.int = _INFINITY
        chosen: cython.int = -1
        following: cython.int = -1
        turn: cython.int
        for turn in range(count - 1, -1, -1):
            best = _INFINITY
            for i in range(count):
                if visited >> i & 1:
                    length = table[visited * EXACT + i] + (self.step(i, following) if following >= 0 else 0)
                    if length < best:
                        best, chosen = length, i
            total = min(total, best) if following < 0 else total
            self._order[turn] = following = chosen
            visited ^= 1 << chosen
        return total

    def _turn(self, turn, following):
        """Length of the step between two turns of the order; turn -1 is the start, and after the last comes nothing."""
        if following >= self._count:
            return 0
        return self.step(self._order[turn] if turn >= 0 else -1, self._order[following])

    def _improved(self, length, bound):
        """Move segments of the order elsewhere while that makes the path shorter (the or-opt exchange)."""
        behind: cython.int
        last: cython.int
        moved = True
        while moved and length > bound:
            moved = False
            for first in range(self._count):
                for last in range(first, min(first + _SEGMENT, self._count)):
                    without = self._without(first, last)
                    for behind in range(-1, self._count):
                        if first - 1 <= behind <= last:
                            continue
                        gain = without - self._inserted(first, last, behind)
                        if gain > 0:
                            self._move(first, last, behind)
                            length -= gain
                            moved = True
                            break
        return length

    def _without(self, first, last):
        """How much shorter the path is without the turns `first` to `last`."""
        return self._turn(first - 1, first) + self._turn(last, last + 1) - self._turn(first - 1, last + 1)

    def _inserted(self, first, last, behind):
        """How much longer it gets by having them behind another turn."""
        return self._turn(behind, first) + self._turn(last, behind + 1) - self._turn(behind, behind + 1)

    def _move(self, first, last, behind):
        """Move the turns `first` to `last` of the order behind another."""
        order = self._order
        for _ in range(last - first + 1):
            if behind < first:
                place = order[last]
                for turn in range(last, behind + 1, -1):
                    order[turn] = order[turn - 1]
                order[behind + 1] = place
            else:
                place = order[first]
                for turn in range(first, behind):
                    order[turn] = order[turn + 1]
                order[behind] = place
