from __future__ import annotations

import importlib

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

LEVELS = hnp.arrays(np.uint8, st.tuples(st.sampled_from([8, 16, 40]), st.integers(1, 40)))
VIEWS = {
    "plain": lambda a: a,
    "turned half": lambda a: a[::-1, ::-1],
    "turned a quarter": lambda a: np.ascontiguousarray(a.T).T,
    "every other": lambda a: a[:, ::2],
}


@given(levels=LEVELS, view=st.sampled_from(sorted(VIEWS)), max_level=st.sampled_from([1, 3, 15, 255]))
def test_a_byte_is_eight_rows_the_topmost_lowest(package, levels, view, max_level):
    packing = importlib.import_module("paneldraw.controllers.packing")
    levels = np.minimum(VIEWS[view](levels), max_level)
    height, width = levels.shape
    packed = np.full((height // 8, width), 0xA5, np.uint8)
    packing.pack_pages(levels, max_level, packed)
    for page in range(height // 8):
        for x in range(width):
            column = [int(2 * int(levels[8 * page + row, x]) > max_level) << row for row in range(8)]
            assert packed[page, x] == sum(column)


@given(levels=LEVELS, view=st.sampled_from(sorted(VIEWS)), max_level=st.sampled_from([1, 3, 15, 255]))
def test_a_byte_is_two_pixels_the_left_one_above(package, levels, view, max_level):
    packing = importlib.import_module("paneldraw.controllers.packing")
    levels = np.minimum(VIEWS[view](levels), max_level)
    levels = levels[:, : levels.shape[1] & ~1]
    height, width = levels.shape
    packed = np.full((height, width // 2), 0xA5, np.uint8)
    packing.pack_nibbles(levels, max_level, packed)
    for y in range(height):
        for x in range(0, width, 2):
            left, right = (round(int(level) * 15 / max_level) for level in levels[y, x : x + 2])
            assert packed[y, x // 2] == 16 * left + right


@given(levels=LEVELS, view=st.sampled_from(sorted(VIEWS)), max_level=st.sampled_from([1, 3, 15, 255]))
def test_a_byte_is_eight_pixels_the_left_one_highest(package, levels, view, max_level):
    packing = importlib.import_module("paneldraw.controllers.packing")
    levels = np.minimum(VIEWS[view](levels), max_level)
    levels = levels[:, : levels.shape[1] & ~7]
    packed = np.full((levels.shape[0], levels.shape[1] // 8), 0xA5, np.uint8)
    packing.pack_rows(levels, max_level, packed)
    np.testing.assert_array_equal(packed, np.packbits(2 * levels.astype(int) > max_level, axis=1))


@given(levels=hnp.arrays(np.uint8, hnp.array_shapes(min_dims=2, max_dims=2, min_side=0, max_side=40)), data=st.data())
def test_the_highest_level_is_found_in_any_view(package, levels, data):
    packing = importlib.import_module("paneldraw.controllers.packing")
    levels = VIEWS[data.draw(st.sampled_from(sorted(VIEWS)))](levels)
    assert packing.highest(levels) == levels.max(initial=0)
    levels.flags.writeable = False
    assert packing.highest(levels) == levels.max(initial=0)
