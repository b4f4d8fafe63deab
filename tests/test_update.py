from __future__ import annotations

import importlib
from dataclasses import replace

import numpy as np
import pytest
from exhaustive import cheapest, shortest
from hypothesis import assume, given
from hypothesis import strategies as st
from searching import examples

from paneldraw import simulator
from paneldraw.controllers import SH1106, SSD1306, SSD1327, Controller, PagePointer
from paneldraw.transports import COMMAND, DATA, Cost

I2C = Cost(2, 2, 2)
EXACT = 9
"""Up to so many pieces, says the planner, its path is the shortest there is."""
SIZES = [(128, 64), (128, 32), (96, 16), (72, 40), (64, 48), (64, 32), (48, 64)]


class Glass:
    """A planner and the chip that takes its plans."""

    def __init__(self, controller=None, cost=I2C):
        self.controller = controller or SSD1306()
        self.planner = importlib.import_module("paneldraw.update").Planner(self.controller, cost)
        self.planner.restart()
        self.longest = cost.longest or 1 << 20
        make = getattr(simulator, self.controller.name.upper())
        self.chip = make(self.controller.width, self.controller.height)
        self.start()

    def start(self):
        """Bring the chip to where the planner believes it to be, and light it."""
        self.chip.write(b"\x00" + b"".join(self.controller.init) + self.controller.power_on)

    def send(self, frame):
        """Bring a frame onto the chip; return the plan's messages as (kind, payload)."""
        self.planner.fresh[:] = frame
        plan = self.planner.plan()
        messages = [(kind, bytes(payload)) for kind, payload in plan]
        for kind, payload in messages:
            self.chip.write(bytes((kind,)) + payload)
        assert plan.cost == sum(2 + len(payload) for _, payload in messages)
        assert all(0 < len(payload) <= self.longest for _, payload in messages)
        self.planner.sent()
        return messages

    @property
    def shown(self):
        """What can be seen, packed as the planner has it."""
        pixels = self.chip.pixels
        if self.controller.packing == "pages":
            return np.packbits(pixels, axis=0, bitorder="little")
        return pixels[:, ::2] << 4 | pixels[:, 1::2]

    def cost(self, frame):
        return sum(2 + len(payload) for _, payload in self.send(frame))


def blank(controller=None):
    glass = Glass(controller)
    frame = np.zeros_like(glass.planner.fresh)
    glass.send(frame)
    return glass, frame


# -- Right


CONTROLLERS = [
    *(SSD1306(*size, chained_control=chained) for size in SIZES for chained in (False, True)),
    SSD1306(64, 48, mirror_x=False, column_offset=32),
    SH1106(),
    SH1106(chained_control=True),
    SSD1327(),
    SSD1327(96, 96),
]


@st.composite
def walks(draw, controllers=tuple(CONTROLLERS)):
    """A controller and frames that differ by a few bytes, a box or everything."""
    controller = draw(st.sampled_from(controllers))
    rows, width = controller.height // controller.cell[1], controller.width // controller.cell[0]
    random = np.random.default_rng(draw(st.integers(0, 2**32)))
    frame = np.zeros((rows, width), np.uint8)
    frames = []
    for kind in draw(
        st.lists(st.sampled_from(["bytes", "many", "box", "noise", "row", "line"]), min_size=1, max_size=8)
    ):
        frame = frame.copy()
        row, column = random.integers(rows), random.integers(width)
        if kind == "box":
            frame[row : row + random.integers(1, 5), column : column + random.integers(1, 40)] ^= 0xFF
        elif kind == "noise":
            frame[:] = random.integers(0, 256, frame.shape)
        elif kind == "row":
            frame[row] ^= 0xFF
        elif kind == "line":
            frame[np.arange(rows), np.linspace(column, 0, rows).astype(int)] ^= 0x0F
        else:
            count = random.integers(1, 9 if kind == "bytes" else 120)
            frame[random.integers(0, rows, count), random.integers(0, width, count)] ^= 0xA5
        frames.append(frame)
    return controller, frames


@given(walks(), st.sampled_from([None, 8191, 31, 1]))
def test_every_frame_arrives_by_the_datasheets_rules(package, walk, longest):
    controller, frames = walk
    glass = Glass(controller, I2C if longest in (None, 8191) else Cost(2, 2, None, longest))
    for frame in frames:
        glass.send(frame)
        np.testing.assert_array_equal(glass.shown, frame)
    assert glass.chip.violations == []


def test_the_first_plan_assumes_nothing_of_the_ram(package):
    glass = Glass()
    glass.send(np.zeros_like(glass.planner.fresh))
    assert not glass.shown.any()


@pytest.mark.parametrize("lose", ["forget", "restart"])
def test_a_planner_that_knows_nothing_sends_everything(package, lose):
    glass, frame = blank()
    glass.chip.power_cycle()
    glass.start()
    getattr(glass.planner, lose)()
    glass.send(frame)
    assert not glass.shown.any()


# -- Few bytes


def test_a_plan_counts_in_plain_numbers(package):
    glass, _ = blank()
    glass.planner.fresh[2, 5] = 1
    plan = glass.planner.plan()
    assert plan.changed == 1
    assert {type(number) for number in (plan.count, plan.cost, plan.changed)} == {int}


def test_nothing_changed_is_no_message(package):
    glass, frame = blank()
    assert glass.send(frame) == []


def test_one_pixel_is_eight_bytes(package):
    glass, frame = blank(SSD1306())
    frame[7, 100] = 1
    glass.send(frame)  # the chip is in page mode from here
    frame[2, 38] = 0x10
    assert glass.send(frame) == [(COMMAND, b"\xb2\x06\x12"), (DATA, b"\x10")]


@pytest.mark.parametrize(
    ("change", "commands"),
    [((7, 101), None), ((6, 101), b"\xb6"), ((7, 99), b"\x03"), ((7, 117), b"\x17"), ((3, 97), b"\xb3\x01")],
)
def test_a_command_that_holds_is_not_sent(package, change, commands):
    glass, frame = blank()
    frame[7, 100] = 1
    glass.send(frame)
    frame[change] = 1
    wanted = [(DATA, b"\x01")]
    assert glass.send(frame) == ([(COMMAND, commands), *wanted] if commands else wanted)


def test_the_pointer_wraps_into_the_first_column(package):
    glass, frame = blank()
    frame[4, 127] = 1
    glass.send(frame)
    frame[4, 0] = 1
    assert glass.send(frame) == [(DATA, b"\x01")]


def test_a_gap_is_sent_again_or_jumped_over_whichever_is_cheaper(package):
    for gap, size in [(3, 3), (5, 5), (6, 5), (16, 5), (17, 6)]:
        glass, frame = blank(SSD1306())
        frame[1, 0] = 1
        glass.send(frame)
        frame[3, 0] = frame[3, 1 + gap] = 1
        assert glass.cost(frame) == (2 + 2) + (2 + 1) + size + 1


def test_a_window_sent_again_needs_no_command(package):
    glass, frame = blank()
    frame[2:6, 40:60] = 1
    glass.send(frame)
    for value in (2, 3):
        frame[2:6, 40:60] = value
        assert [kind for kind, _ in glass.send(frame)] == [DATA]


def test_of_a_windows_two_commands_only_the_one_that_changes_is_sent(package):
    glass, frame = blank()
    for value, left, commands in ((1, 40, None), (2, 60, b"\x21\x3c\x45"), (3, 20, b"\x21\x14\x1d")):
        frame[2:7, left : left + 10] = value
        messages = glass.send(frame)
        if commands:
            assert messages[0] == (COMMAND, commands)
    assert glass.chip.violations == []


def test_chained_control_bytes_only_where_the_chip_takes_them(package):
    for chained, cost in ((False, 6), (True, 5)):
        glass, frame = blank(SSD1306(chained_control=chained))
        frame[7, 100] = 1
        glass.send(frame)
        frame[6, 101] = 1
        assert glass.cost(frame) == cost
        np.testing.assert_array_equal(glass.shown, frame)


@given(walks([controller for controller in CONTROLLERS if controller.name == "ssd1306"]))
def test_never_worse_than_the_page_pointer_or_one_bounding_window(package, walk):
    """Each step of its own: the same frame before, the same pointer."""
    controller, frames = walk
    before = np.zeros((controller.height // 8, controller.width), np.uint8)
    for frame in frames:
        changed = np.argwhere(frame != before)
        if not changed.size:
            continue
        glass, _ = blank(controller)
        glass.send(before)
        windowed = glass.chip.registers.mode != 2
        cost = glass.cost(frame)
        box = np.ptp(changed, axis=0) + 1
        assert cost <= 2 + 6 + 2 * (not windowed) + 2 + box[0] * box[1]
        runs = sum(_page_cost(np.unique(changed[changed[:, 0] == page, 1])) for page in np.unique(changed[:, 0]))
        assert cost <= runs + 2 * windowed
        before = frame


def _page_cost(columns):
    """One page by itself: every run addressed in full, gaps sent along where that is cheaper."""
    gaps = np.diff(columns) - 1
    return 7 + len(columns) + sum(min(gap, 7) for gap in gaps)


# -- Fewest


@st.composite
def small_updates(draw):
    """A panel small enough for an exhaustive search, where its pointer is, and what changed."""
    left, width, beyond = draw(st.sampled_from([0, 2, 10])), draw(st.integers(8, 36)), draw(st.sampled_from([0, 0, 3]))
    pages = draw(st.integers(1, 3))
    controller = Controller(
        name="small",
        width=width,
        height=8 * pages,
        init=(),
        ram_width=left + width + beyond,
        ram_height=8 * pages,
        column_offset=left,
        pointer=PagePointer(wraps=draw(st.booleans())),
        chained_control=draw(st.booleans()),
    )
    cells = st.tuples(st.integers(0, pages - 1), st.integers(0, width - 1))
    return controller, draw(cells), draw(st.sets(cells, min_size=1, max_size=6))


@examples(2)
@given(small_updates())
def test_the_page_pointers_plan_is_the_cheapest_there_is(update):
    _assert_cheapest(update, I2C)


@given(small_updates(), st.builds(Cost, st.integers(0, 5), st.integers(0, 5), st.none(), st.none()))
def test_on_other_wires_too(update, cost):
    _assert_cheapest(update, cost)


def _assert_cheapest(update, cost):
    controller, (page, column), cells = update
    planner = importlib.import_module("paneldraw.update").Planner(controller, cost)
    planner.restart()
    planner.plan()
    planner.sent()
    planner.fresh[page, column] += 1
    planner.plan()
    planner.sent()
    pointer = controller.column_offset + column + 1
    if pointer == controller.ram_width:
        assume(controller.pointer.wraps)
        pointer = 0
    for cell in cells:
        planner.fresh[cell] += 1
    wanted = {(page, controller.column_offset + column) for page, column in cells}
    assert planner.plan().cost == cheapest(controller, cost, wanted, page, pointer)


def _scattered(random, count):
    """A frame of so many changed pieces, as (page, first, end), and where the pointer stands."""
    planner = importlib.import_module("paneldraw.update").Planner(replace(SSD1306(), window=None), I2C)
    planner.restart()
    planner.plan()
    planner.sent()
    page, column = (int(end) for end in (random.integers(8), random.integers(127)))
    planner.fresh[page, column] += 1
    planner.plan()
    planner.sent()
    free = np.ones((8, 128), bool)
    while count:
        at, first, size = random.integers(8), random.integers(125), random.integers(1, 4)
        if free[at, max(first - 1, 0) : first + size + 1].all():
            free[at, first : first + size] = False
            count -= 1
    planner.fresh[~free] += 1
    edges = np.diff(np.pad(~free, ((0, 0), (1, 1))).astype(int))
    starts, stops = np.argwhere(edges == 1), np.argwhere(edges == -1)
    pieces = [(int(at), int(first), int(end)) for (at, first), (_, end) in zip(starts, stops, strict=True)]
    return planner.plan().cost, pieces, page, column + 1


@pytest.mark.parametrize("count", [1, 4, 8, EXACT])
def test_up_to_the_exact_searchs_pieces_no_order_is_cheaper(count):
    random = np.random.default_rng(count)
    for _ in range(20):
        cost, *update = _scattered(random, count)
        assert cost == shortest(I2C, *update)


def test_with_more_pieces_the_order_found_is_near_the_cheapest():
    """A fixed walk of updates, of which docs and docstrings say how near: none is guaranteed."""
    random = np.random.default_rng(5)
    costs, best = [], []
    for count in [EXACT + 1, EXACT + 2, EXACT + 3] * 8:
        cost, *update = _scattered(random, count)
        costs.append(cost)
        best.append(shortest(I2C, *update))
    above = np.subtract(costs, best)
    assert 0 <= above.min() <= above.max() <= 4
    assert sum(costs) <= 1.015 * sum(best)


def test_more_pieces_than_the_exact_search_takes_still_beat_page_by_page():
    """Two columns of single bytes: down one and up the other is shorter than left and right in every page."""
    glass, frame = blank(SSD1306())
    frame[0, 0] = 1
    glass.send(frame)
    frame[:, 21] = frame[:, 70] = np.arange(1, 9)
    assert glass.planner.fresh.shape == (8, 128)
    assert glass.cost(frame) < 8 * (2 + 3 + 2 + 1) + 8 * (2 + 2 + 2 + 1)
    np.testing.assert_array_equal(glass.shown, frame)
