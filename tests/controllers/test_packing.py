from __future__ import annotations

import importlib

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

LEVELS = hnp.arrays(np.uint8, st.tuples(st.sampled_from([8, 16, 40]), st.integers(1, 40)), elements=st.integers(0, 15))
VIEWS = {
    "plain": lambda a: a,
    "turned half": lambda a: a[::-1, ::-1],
    "turned a quarter": lambda a: np.ascontiguousarray(a.T).T,
    "every other": lambda a: a[:, ::2],
}


@given(levels=LEVELS, view=st.sampled_from(sorted(VIEWS)), threshold=st.integers(0, 15))
def test_a_byte_is_eight_rows_the_topmost_lowest(package, levels, view, threshold):
    packing = importlib.import_module("paneldraw.controllers.packing")
    levels = VIEWS[view](levels)
    height, width = levels.shape
    packed = np.full((height // 8, width), 0xA5, np.uint8)
    packing.pack_pages(levels, threshold, packed)
    for page in range(height // 8):
        for x in range(width):
            column = [int(levels[8 * page + row, x] > threshold) << row for row in range(8)]
            assert packed[page, x] == sum(column)
