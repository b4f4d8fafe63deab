"""The cheapest way to write some bytes by page pointer, found by trying everything or every order."""

from __future__ import annotations

import heapq
import itertools

import numpy as np


def cheapest(controller, cost, cells, page, column):
    """Bytes of the cheapest sequence of messages that writes the RAM cells (page, column) at least once.

    Dijkstra's algorithm over all there is to know between two bytes on the wire: what is still to be written, the page,
    the lower and the upper half of the column pointer (None: unknown), and which kind of message is open. Every byte
    of every message is one step; data stays within the visible columns.
    """
    wide, high = controller.cell
    left, top = controller.column_offset // wide, controller.row_offset // high
    visible, pages = range(left, left + controller.width // wide), range(top, top + controller.height // high)
    uppers = range((controller.ram_width // wide + 15) // 16)
    chained = cost.chained if controller.chained_control else None
    start = (frozenset(cells), page, column % 16, column // 16, "none")
    return dijkstra(
        start,
        lambda state: [
            *_data(controller, cost, state, visible),
            *_commands(cost.command, chained, state, pages, uppers, 1 + controller.pointer.row_argument),
        ],
    )


def dijkstra(start, steps):
    """The least that leads from `start` to a state with nothing to write, which a state says first.

    ``steps(state)`` holds pairs of a price and the state that it leads to.
    """
    costs = {start: 0}
    number = itertools.count()
    queue = [(0, next(number), start)]
    while queue:
        paid, _, state = heapq.heappop(queue)
        if not state[0]:
            return paid
        if paid > costs[state]:
            continue
        for price, following in steps(state):
            if paid + price < costs.get(following, 1 << 30):
                costs[following] = paid + price
                heapq.heappush(queue, (paid + price, next(number), following))
    raise AssertionError("everything can be written")


def _data(controller, cost, state, visible):
    todo, page, lower, upper, message = state
    if page is None or lower is None or upper is None or 16 * upper + lower not in visible:
        return
    column = 16 * upper + lower
    after = column + 1
    if after == controller.ram_width // controller.cell[0]:
        after = 0 if controller.pointer.wraps else None
    lower, upper = (None, None) if after is None else (after % 16, after // 16)
    opening = 0 if message in ("data", "chain") else cost.data
    yield 1 + opening, (todo - {(page, column)}, page, lower, upper, "data")


def _commands(opening, chained, state, pages, uppers, page_bytes):
    todo, page, lower, upper, message = state
    pointers = {(p, lower, upper): page_bytes for p in pages}
    pointers |= {(page, c, upper): 1 for c in range(16)} | {(page, lower, c): 1 for c in uppers}
    for pointer, size in pointers.items():
        if message != "chain":
            yield size + (0 if message == "command" else opening), (todo, *pointer, "command")
        if chained is not None:
            yield 2 * size + (0 if message == "chain" else chained), (todo, *pointer, "chain")


def shortest(cost, pieces, page, column):
    """Bytes of the shortest path through pieces (page, first, end) of a 128-column RAM whose pointer wraps.

    Every order counts: set by set of pieces the least bytes to have written them and to stand behind one of them.
    """
    places = [(page, first, end) for page, first, end in pieces]
    begin = [_step(cost, (page, column), piece, opening=cost.data) for piece in places]
    between = np.array([[_step(cost, (one[0], one[2] % 128), other) for other in places] for one in places])
    least = np.full((1 << len(places), len(places)), 1 << 30)
    for last, length in enumerate(begin):
        least[1 << last, last] = length
    for visited in range(1, len(least)):
        onward = (least[visited][:, np.newaxis] + between).min(axis=0)
        for following in range(len(places)):
            if not visited >> following & 1:
                rest = visited | 1 << following
                least[rest, following] = min(least[rest, following], onward[following])
    return int(least[-1].min()) + sum(end - first for _, first, end in places)


def _step(cost, place, piece, opening=0):
    """Bytes from a place of the pointer to the start of a piece: all in between sent, or a jump with its ends shifted.

    At the start of a plan no data message is open: to send at once costs `opening`, and nothing can be sent first.
    """
    (page, column), (to_page, to_column, _) = place, piece
    shifts = range(8)
    best = opening + (to_column - column) % 128 if page == to_page else 1 << 20
    for late, early in itertools.product(range(1) if opening else shifts, shifts):
        after, start = (column + late) % 128, (to_column - early) % 128
        commands = (page != to_page) + (after % 16 != start % 16) + (after // 16 != start // 16)
        jump = cost.command + commands + cost.data if commands else opening
        best = min(best, jump + late + early)
    return best
