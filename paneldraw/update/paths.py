# cython: language_level=3, boundscheck=False, wraparound=False, initializedcheck=False, cdivision=True
"""A short path that visits every place once, from a start to wherever it ends; steps differ by direction.

``lengths[i + 1, j]`` is the length of the step from place i to place j, ``lengths[0, j]`` of the one from the start.
Places belong to regions, and come region by region.
"""

from __future__ import annotations

import cython

EXACT = 9
"""Up to so many places the path is the shortest there is."""
IMPROVED = 24
"""Up to so many it is improved step by step, until no move makes it shorter, which need not be the shortest; more are
not to be asked of this module."""

_EXACT = cython.declare(cython.int, EXACT)
_FAR = cython.declare(cython.int, 1 << 24)
_STRETCH = cython.declare(cython.int, 3)


@cython.cfunc
def shortest_path(
    lengths: cython.int[:, ::1],
    regions: cython.int[::1],
    table: cython.int[:, ::1],
    order: cython.int[::1],
    count: cython.int,
) -> cython.int:
    """Find a path, leave it in `order`, and return its length. The order given is 0, 1, 2, ...

    Parameters
    ----------
    lengths : (count + 1, count) int or larger
    regions : (count,) int or larger
    table : (2**EXACT, EXACT) int
        Room to work in.
    order : (count,) int or larger
    count : int
        1 to IMPROVED places.
    """
    i: cython.int
    length: cython.int = 0
    for i in range(count):
        length += lengths[i, i]
    bound: cython.int = _bound(lengths, regions, count)
    if length <= bound:
        return length
    if count <= _EXACT:
        return _exact(lengths, table, order, count)
    return _improved(lengths, order, count, length, bound)


@cython.cfunc
def _bound(lengths: cython.int[:, ::1], regions: cython.int[::1], count: cython.int) -> cython.int:
    """No path is shorter: every place is reached by some step, and one place of each region from outside of it."""
    i: cython.int
    j: cython.int
    nearest: cython.int
    outside: cython.int
    bound: cython.int = 0
    detour: cython.int = 0
    for j in range(count):
        nearest, outside = _FAR, lengths[0, j]
        for i in range(count):
            if regions[i] != regions[j]:
                outside = min(outside, lengths[i + 1, j])
            elif i != j:
                nearest = min(nearest, lengths[i + 1, j])
        nearest = min(nearest, outside)
        if j == 0 or regions[j] != regions[j - 1]:
            bound += detour
            detour = _FAR
        detour = min(detour, outside - nearest)
        bound += nearest
    return bound + detour


@cython.cfunc
def _exact(
    lengths: cython.int[:, ::1], table: cython.int[:, ::1], order: cython.int[::1], count: cython.int
) -> cython.int:
    """Set by set, the shortest way to have visited the places of a set and to stand at one of them.

    M. Held, R. M. Karp, "A dynamic programming approach to sequencing problems", J. SIAM 10 (1962), 196-210.
    """
    visited: cython.int
    others: cython.int
    last: cython.int
    i: cython.int
    best: cython.int
    for visited in range(1, 1 << count):
        for last in range(count):
            if not visited >> last & 1:
                continue
            others = visited ^ (1 << last)
            best = lengths[0, last] if others == 0 else _FAR
            for i in range(count):
                if others >> i & 1:
                    best = min(best, table[others, i] + lengths[i + 1, last])
            table[visited, last] = best
    return _walk_back(lengths, table, order, count)


@cython.cfunc
def _walk_back(
    lengths: cython.int[:, ::1], table: cython.int[:, ::1], order: cython.int[::1], count: cython.int
) -> cython.int:
    """Follow the table from the set of all places to that of one."""
    visited: cython.int = (1 << count) - 1
    place: cython.int
    i: cython.int
    length: cython.int
    best: cython.int
    total: cython.int = _FAR
    chosen: cython.int = -1
    following: cython.int = -1
    for place in range(count - 1, -1, -1):
        best = _FAR
        for i in range(count):
            if visited >> i & 1:
                length = table[visited, i] + (lengths[i + 1, following] if following >= 0 else 0)
                if length < best:
                    best, chosen = length, i
        total = min(total, table[visited, chosen]) if following < 0 else total
        order[place] = following = chosen
        visited ^= 1 << chosen
    return total


@cython.cfunc
@cython.inline
def _step(
    lengths: cython.int[:, ::1], order: cython.int[::1], count: cython.int, turn: cython.int, following: cython.int
) -> cython.int:
    """Length of the step between two turns of the order; turn -1 is the start, and after the last comes nothing."""
    if following >= count:
        return 0
    return lengths[order[turn] + 1 if turn >= 0 else 0, order[following]]


@cython.cfunc
def _improved(
    lengths: cython.int[:, ::1], order: cython.int[::1], count: cython.int, length: cython.int, bound: cython.int
) -> cython.int:
    """Move stretches of the order elsewhere while that makes the path shorter (the or-opt exchange)."""
    first: cython.int
    last: cython.int
    behind: cython.int
    without: cython.int
    gain: cython.int
    moved: cython.bint = True
    while moved and length > bound:
        moved = False
        for first in range(count):
            for last in range(first, min(first + _STRETCH, count)):
                without = (
                    _step(lengths, order, count, first - 1, first)
                    + _step(lengths, order, count, last, last + 1)
                    - _step(lengths, order, count, first - 1, last + 1)
                )
                for behind in range(-1, count):
                    if first - 1 <= behind <= last:
                        continue
                    gain = (
                        without
                        + _step(lengths, order, count, behind, behind + 1)
                        - _step(lengths, order, count, behind, first)
                        - _step(lengths, order, count, last, behind + 1)
                    )
                    if gain > 0:
                        _move(order, first, last, behind)
                        length -= gain
                        moved = True
                        break
    return length


@cython.cfunc
def _move(order: cython.int[::1], first: cython.int, last: cython.int, behind: cython.int) -> cython.void:
    """Move the turns `first` to `last` of the order behind another."""
    place: cython.int
    turn: cython.int
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
