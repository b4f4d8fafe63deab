"""Plans of chips that have windows alone: right, counted exactly, and held to what trying everything finds."""

from __future__ import annotations

import importlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples
from windows import Ram, cheapest

from paneldraw.controllers import SSD1327, Controller, Window
from paneldraw.transports import COMMAND, DATA, Cost

I2C = Cost(2, 2)
PAIRS = Window(columns=0x15, rows=0x75, across=b"\xa0\x51", down=b"\xa0\x55")
"""Two pixels a column, as of an SSD1327."""
FOURS = Window(
    columns=0x15,
    rows=0x75,
    across=b"\xa0\x06\x11",
    down=b"\xa0\x07\x11",
    column_bytes=2,
    write=b"\x5c",
)
"""Four pixels a column, arguments with D/C high and a command before data, as of an SSD1322."""


def controller(width, height, window, left=0, beyond=0):
    wide = 2 * window.column_bytes
    return Controller(
        name="small",
        width=wide * width,
        height=height,
        init=(),
        ram_width=wide * (left + width + beyond),
        ram_height=height,
        column_offset=wide * left,
        packing="nibbles",
        pointer=None,
        window=window,
        arguments_are_data=bool(window.write),
    )


class Panel:
    """A planner and the RAM that takes its plans."""

    def __init__(self, controller, cost=I2C):
        self.planner = importlib.import_module("paneldraw.update").Planner(controller, cost)
        self.planner.restart()
        self.controller, self.price, self.ram = controller, cost, Ram(controller)
        self.left = controller.column_offset // controller.cell[0]
        self.send()

    def change(self, cells):
        """Change one byte in each of some cells (row, column); return them as the RAM counts them."""
        unit = self.controller.window.column_bytes
        for number, (row, column) in enumerate(sorted(cells)):
            self.planner.fresh[row, unit * column + number % unit] += 1
        return {(row, column + self.left) for row, column in cells}

    def send(self):
        """Bring the fresh frame into the RAM; return the plan's messages as (kind, payload)."""
        plan = self.planner.plan()
        messages = [(kind, bytes(payload)) for kind, payload in plan]
        for kind, payload in messages:
            self.ram.take(kind, payload)
        fresh, unit = self.planner.fresh, self.controller.window.column_bytes
        np.testing.assert_array_equal(self.ram.bytes[:, unit * self.left :][:, : fresh.shape[1]], fresh)
        framing = {COMMAND: self.price.command, DATA: self.price.data}
        assert plan.cost == sum(framing[kind] + len(payload) for kind, payload in messages)
        self.planner.sent()
        return messages

    def cost(self):
        price = self.price
        return sum({COMMAND: price.command, DATA: price.data}[kind] + len(payload) for kind, payload in self.send())


@st.composite
def walks(draw, most_cells):
    """A panel of a few cells, what its wire costs, and which cells change from frame to frame."""
    width, height = draw(st.integers(2, 5)), draw(st.integers(1, 4))
    small = controller(width, height, draw(st.sampled_from([PAIRS, FOURS])), draw(st.sampled_from([0, 3])), 1)
    cost = draw(st.builds(Cost, st.integers(0, 4), st.integers(0, 4), st.none(), st.none()))
    cells = st.sets(st.tuples(st.integers(0, height - 1), st.integers(0, width - 1)), min_size=1, max_size=most_cells)
    return small, cost, draw(st.lists(cells, min_size=1, max_size=4))


@given(walks(12))
def test_every_frame_arrives_and_is_counted_to_the_byte(package, walk):
    small, cost, steps = walk
    panel = Panel(small, cost)
    for cells in steps:
        panel.change(cells)
        panel.send()


def bounding(small, cost, cells, state):
    """Bytes of one window around some cells: the commands that do not hold, and data up to the last of them."""
    window = small.window
    rows, columns = zip(*cells, strict=True)
    box = (min(columns), max(columns)), (min(rows), max(rows))
    commands = (state.columns != box[0] or state.column != box[0][0]) + (state.rows != box[1] or state.row != box[1][0])
    wide, high = (last - first + 1 for first, last in box)
    if state.down:
        last = max(high * (column - box[0][0]) + row - box[1][0] for row, column in cells)
    else:
        last = max(wide * (row - box[1][0]) + column - box[0][0] for row, column in cells)
    data = cost.data + window.column_bytes * (last + 1)
    if small.arguments_are_data:
        return commands * (cost.command + 3 + cost.data) + cost.command + len(window.write) + data
    return (cost.command + 3 * commands if commands else 0) + data


@examples(1.2)
@given(walks(4))
def test_between_the_cheapest_there_is_and_one_bounding_window(walk):
    small, cost, steps = walk
    panel = Panel(small, cost)
    for cells in steps:
        state = panel.ram.state
        wanted = panel.change(cells)
        assert cheapest(small, cost, wanted, state) <= panel.cost() <= bounding(small, cost, wanted, state)


@pytest.mark.parametrize(("window", "size"), [(PAIRS, 11), pytest.param(FOURS, 21, marks=pytest.mark.thorough)])
def test_one_cell_where_nothing_holds_is_the_cheapest_there_is(window, size):
    """Two windows' commands and a cell: 15 c c 75 r r, its data; with D/C high in between, 15 | c c | 75 | r r | 5C."""
    small = controller(9, 9, window)
    panel = Panel(small)
    panel.change({(4, 4)})
    panel.send()
    state = panel.ram.state
    wanted = panel.change({(1, 2)})
    assert panel.cost() == cheapest(small, I2C, wanted, state) == size


@pytest.mark.thorough
def test_the_cheapest_is_met_more_often_than_not():
    """How near a fixed walk of small updates comes to it: none is guaranteed."""
    random = np.random.default_rng(4)
    ours = best = 0
    for _ in range(60):
        small = controller(5, 4, PAIRS)
        panel = Panel(small)
        for _ in range(2):
            cells = {(int(random.integers(4)), int(random.integers(5))) for _ in range(random.integers(1, 4))}
            state = panel.ram.state
            wanted = panel.change(cells)
            ours += panel.cost()
            best += cheapest(small, I2C, wanted, state)
    assert best <= ours <= 1.08 * best


def test_a_diagonal_of_greys_costs_no_bounding_window(package):
    """More pieces than boxes are kept: neighbors share boxes."""
    planner = importlib.import_module("paneldraw.update").Planner(SSD1327(), I2C)
    planner.restart()
    planner.plan()
    planner.sent()
    for row in range(128):
        planner.fresh[row, row // 2] = 0xF0
    assert planner.plan().cost < 800


def test_every_byte_of_a_cell_that_changes_is_counted(package):
    panel = Panel(controller(9, 9, FOURS))
    panel.planner.fresh[4, 6:8] = 1
    assert panel.planner.plan().changed == 2


def test_windows_are_filled_down_where_that_pays_for_the_switch():
    """A column and one cell beside its top: across, the cells beside it would go out too."""
    panel = Panel(controller(8, 20, PAIRS))
    panel.change({(row, 3) for row in range(20)} | {(0, 4)})
    assert panel.send()[0] == (COMMAND, b"\xa0\x55\x15\x03\x04\x75\x00\x13")
    assert panel.ram.state.down
    panel.change({(row, 3) for row in range(2)})
    assert all(b"\xa0" not in payload for kind, payload in panel.send() if kind == COMMAND)
