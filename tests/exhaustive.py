"""The cheapest way to write some bytes by page pointer, found by trying everything."""

from __future__ import annotations

import heapq
import itertools


def cheapest(controller, cost, cells, page, column):
    """Bytes of the cheapest sequence of messages that writes the RAM cells (page, column) at least once.

    Dijkstra's algorithm over all there is to know between two bytes on the wire: what is still to be written, the page,
    the lower and the upper half of the column pointer (None: unknown), and which kind of message is open. Every byte
    of every message is one step; data stays within the visible columns.
    """
    visible = range(controller.column_offset, controller.column_offset + controller.width)
    top = controller.row_offset // 8
    pages = range(top, top + controller.height // 8)
    uppers = range((controller.ram_width + 15) // 16)
    chained = cost.chained if controller.chained_control else None
    start = (frozenset(cells), page, column % 16, column // 16, "none")
    costs = {start: 0}
    number = itertools.count()
    queue = [(0, next(number), start)]
    while queue:
        paid, _, state = heapq.heappop(queue)
        if not state[0]:
            return paid
        if paid > costs[state]:
            continue
        for price, following in [
            *_data(controller, cost, state, visible),
            *_commands(cost.command, chained, state, pages, uppers),
        ]:
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
    if after == controller.ram_width:
        after = 0 if controller.pointer.wraps else None
    lower, upper = (None, None) if after is None else (after % 16, after // 16)
    opening = 0 if message in ("data", "chain") else cost.data
    yield 1 + opening, (todo - {(page, column)}, page, lower, upper, "data")


def _commands(opening, chained, state, pages, uppers):
    todo, page, lower, upper, message = state
    pointers = {(p, lower, upper) for p in pages} | {(page, c, upper) for c in range(16)}
    for pointer in pointers | {(page, lower, c) for c in uppers}:
        if message != "chain":
            yield 1 + (0 if message == "command" else opening), (todo, *pointer, "command")
        if chained is not None:
            yield 2 + (0 if message == "chain" else chained), (todo, *pointer, "chain")
