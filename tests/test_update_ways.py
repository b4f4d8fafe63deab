"""Pointers of all forms, and updates that assume little: a RAM by definition takes the plans."""

from __future__ import annotations

import importlib
from dataclasses import replace

import numpy as np
import pytest
from exhaustive import cheapest
from hypothesis import given
from hypothesis import strategies as st
from windows import Ram

from paneldraw import Panel, simulator
from paneldraw.controllers import SH1106, SH1122, SSD1306, SSD1322, SSD1327, PagePointer
from paneldraw.transports import I2CTransport
from paneldraw.transports.base import CHAINED, COMMAND, DATA, Cost

I2C, SPI = Cost(2, 2, 2), Cost(0, 0)
FORMS = {
    "halves": PagePointer(),
    "a row as argument": PagePointer(row_argument=True),
    "one command": PagePointer(row=0x40, column=0x80, wraps=True),
    "pairs": PagePointer(row=0x80, column=0x80, paired=True),
    "one after the other": PagePointer(row=0x40, column=0x80, turns=True),
}
#: Width, height and left edge of the glass, in a RAM of 120 x 64.
GLASS = [(60, 32, 20), (120, 32, 0), (120, 64, 0)]


class PointedRam:
    """A RAM behind a page pointer of any form. Where it forgets, a pointer is lost behind every run of data."""

    def __init__(self, controller, forgets=False):
        self.pointer, self.forgets = controller.pointer, forgets
        wide, high = controller.cell
        self.bytes = np.zeros((controller.ram_height // high, controller.ram_width // wide), np.uint8)
        self.row = self.column = None
        self.waiting = 0

    def take(self, kind, payload):
        if kind == CHAINED:
            at = 0
            self.command(payload[0])
            while payload[at + 1] == CHAINED:
                at += 2
                self.command(payload[at])
            assert payload[at + 1] == DATA
            payload = payload[at + 2 :]
        if kind == COMMAND:
            for byte in payload:
                self.command(byte)
        else:
            self.data(payload)

    def command(self, byte):
        pointer = self.pointer
        if pointer.paired:
            if self.waiting:
                self.column = byte - pointer.column
            else:
                self.row = byte - pointer.row
            self.waiting = 1 - self.waiting
        elif self.waiting:
            self.row, self.waiting = byte, 0
        elif pointer.row_argument and byte == pointer.row:
            self.waiting = 1
        elif pointer.column is not None and byte >= pointer.column:
            self.column = byte - pointer.column
        elif byte >= pointer.row:
            self.row = byte - pointer.row
        elif byte < 0x10:
            self.column = (self.column or 0) & 0xF0 | byte
        else:
            self.column = (self.column or 0) & 0x0F | (byte & 0x0F) << 4

    def data(self, payload):
        assert not self.waiting
        for byte in payload:
            self.bytes[self.row, self.column] = byte
            self.column += 1
            if self.column == self.bytes.shape[1] and (self.pointer.wraps or self.pointer.turns):
                self.column = 0
                self.row = (self.row + self.pointer.turns) % len(self.bytes)
        if self.forgets:
            self.row = self.column = None


def frames(draw, shape, count=6):
    """Frames of which each differs from the one before in a few bytes, the last one in all."""
    frame = np.zeros(shape, np.uint8)
    yield frame
    for _ in range(count):
        frame = frame.copy()
        for _ in range(draw(st.integers(1, 6))):
            row, column = draw(st.integers(0, shape[0] - 1)), draw(st.integers(0, shape[1] - 1))
            frame[row, column : column + draw(st.integers(1, 9))] ^= draw(st.integers(1, 255))
        yield frame
    yield ~frame


@given(
    data=st.data(), form=st.sampled_from(sorted(FORMS)), cost=st.sampled_from([I2C, SPI]), glass=st.sampled_from(GLASS)
)
def test_every_form_of_pointer_is_followed(package, data, form, cost, glass):
    chained = data.draw(st.booleans())
    (width, height, left), rows = glass, glass[1] // 8
    controller = replace(
        SH1106(),
        width=width,
        height=height,
        ram_width=120,
        column_offset=left,
        pointer=FORMS[form],
        chained_control=chained,
    )
    planner, ram = importlib.import_module("paneldraw.update").Planner(controller, cost), PointedRam(controller)
    planner.restart()
    for frame in frames(data.draw, (rows, width)):
        planner.fresh[:] = frame
        for kind, payload in planner.plan():
            ram.take(kind, bytes(payload))
        planner.sent()
        np.testing.assert_array_equal(ram.bytes[:rows, left : left + width], frame)


@given(data=st.data(), cost=st.sampled_from([I2C, SPI]), chained=st.booleans())
def test_rows_of_nibbles_are_written_in_the_fewest_bytes(package, data, cost, chained):
    """A part of an SH1122's RAM small enough for an exhaustive search: B0 takes the row, a cell holds two pixels."""
    left, width, rows = data.draw(st.integers(0, 9)), data.draw(st.integers(8, 30)), data.draw(st.integers(1, 3))
    controller = replace(
        SH1122(), width=2 * width, height=rows, column_offset=2 * left, row_offset=60, chained_control=chained
    )
    planner, ram = importlib.import_module("paneldraw.update").Planner(controller, cost), PointedRam(controller)
    planner.restart()

    def send():
        plan = planner.plan()
        for kind, payload in plan:
            ram.take(kind, bytes(payload))
        planner.sent()
        return plan.cost

    send()
    cells = st.tuples(st.integers(0, rows - 1), st.integers(0, width - 1))
    for most in (1, 6):
        changed = data.draw(st.sets(cells, min_size=1, max_size=most))
        for cell in changed:
            planner.fresh[cell] += 1
        wanted = {(60 + row, left + column) for row, column in changed}
        fewest = cheapest(controller, cost, wanted, ram.row, ram.column)
        assert send() == fewest
    np.testing.assert_array_equal(ram.bytes[60 : 60 + rows, left : left + width], planner.fresh)


@pytest.mark.parametrize(
    ("form", "pointer"),
    [("halves", 3), ("a row as argument", 4), ("one command", 2), ("pairs", 2), ("one after the other", 2)],
)
def test_what_a_byte_costs(package, form, pointer):
    controller = replace(SH1106(), pointer=FORMS[form])
    planner = importlib.import_module("paneldraw.update").Planner(controller, I2C)
    planner.restart()
    planner.plan()
    planner.sent()
    costs = []
    for row, column in ((2, 50), (6, 106)):
        planner.fresh[row, column] ^= 1
        costs.append(planner.plan().cost)
        planner.sent()
    assert costs == [2 + pointer + 2 + 1] * 2


@pytest.mark.parametrize("updates", ["plain", "whole"])
@given(data=st.data(), chip=st.sampled_from([SH1106, SSD1306]))
def test_a_page_pointer_that_is_lost_behind_data_does_no_harm(package, updates, data, chip):
    controller = chip(chained_control=True)
    planner = importlib.import_module("paneldraw.update").Planner(controller, I2C, updates)
    planner.restart()
    ram = PointedRam(replace(controller, pointer=controller.pointer._replace(mode=b"", wraps=False)), forgets=True)
    for frame in frames(data.draw, (8, 128), 3):
        planner.fresh[:] = frame
        plan = planner.plan()
        assert plan.count <= 42
        for kind, payload in plan:
            assert kind != CHAINED
            ram.take(kind, bytes(payload).removeprefix(controller.pointer.mode) if kind == COMMAND else bytes(payload))
        planner.sent()
        if updates == "whole" and plan.changed:
            assert plan.cost == 8 * (2 + 3 + 2 + 128) + len(controller.pointer.mode)
        np.testing.assert_array_equal(ram.bytes[:, controller.column_offset :][:, :128], frame)


@pytest.mark.parametrize("updates", ["plain", "whole"])
@given(data=st.data(), chip=st.sampled_from([SSD1322, SSD1327]))
def test_a_window_that_is_lost_behind_data_does_no_harm(package, updates, data, chip):
    controller = chip()
    planner = importlib.import_module("paneldraw.update").Planner(controller, I2C, updates)
    planner.restart()
    shape, unit = planner.fresh.shape, controller.window.column_bytes
    ram = Ram(controller)
    left = controller.column_offset // controller.cell[0] * unit
    for frame in frames(data.draw, shape, 2):
        planner.fresh[:] = frame
        plan = planner.plan()
        assert plan.count <= (3 * 42 if controller.arguments_are_data else 42)
        commands = b""
        for kind, payload in plan:
            if kind == DATA and (not controller.arguments_are_data or commands.endswith(controller.window.write)):
                assert controller.window.columns in commands
                assert controller.window.rows in commands
                commands = b""
            else:
                commands += bytes(payload)
            ram.take(kind, bytes(payload))
        planner.sent()
        np.testing.assert_array_equal(ram.bytes[: shape[0], left : left + shape[1]], frame)


def test_an_unknown_way_is_refused():
    with pytest.raises(ValueError, match="updates must be one of 'least', 'plain', 'whole', not 'most'"):
        Panel(SSD1306(), I2CTransport(simulator.I2CBus()), updates="most")
