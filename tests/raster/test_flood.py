"""Flood fill, against pixels that are reached one by one."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

WIDTH, HEIGHT = 13, 9

pictures = st.lists(st.integers(0, 2), min_size=WIDTH * HEIGHT, max_size=WIDTH * HEIGHT)
places = st.tuples(st.integers(-2, WIDTH + 1), st.integers(-2, HEIGHT + 1))
ops = st.sampled_from(["over", "xor", "add", "max", "clear"])
windows = st.tuples(st.integers(0, 6), st.integers(0, 4), st.integers(1, 13), st.integers(1, 9))


def area(levels, x, y, border, window=(0, 0, WIDTH, HEIGHT)):
    """The pixels that hang together with (x, y), found one at a time."""
    left, top, width, height = window
    inside = np.zeros(levels.shape, bool)
    inside[top : top + height, left : left + width] = True
    taken = np.zeros(levels.shape, bool)
    if not (0 <= x < WIDTH and 0 <= y < HEIGHT and inside[y, x]):
        return taken
    wanted = inside & (levels == levels[y, x] if border is None else levels != border)
    reached = [(x, y)]
    while reached:
        x, y = reached.pop()
        if 0 <= x < WIDTH and 0 <= y < HEIGHT and wanted[y, x] and not taken[y, x]:
            taken[y, x] = True
            reached += [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)]
    return taken


@given(pictures, places, st.sampled_from([None, 0, 2]), windows, ops)
def test_it_fills_what_hangs_together(package, levels, place, border, window, op):
    levels = np.array(levels, np.uint8).reshape(HEIGHT, WIDTH)
    fb = package.Framebuffer(WIDTH, HEIGHT, 2)
    fb.pixels[:] = levels
    taken = area(levels, *place, border, window)
    with fb.clip(*window):
        count = fb.flood_fill(*place, 3, border=border, op=op)
    over = {"over": 3 + 0 * levels, "xor": levels ^ 3, "add": np.minimum(levels + 3, 3), "max": 3 + 0 * levels}
    assert count == taken.sum()
    assert (fb.pixels == np.where(taken, over.get(op, 0 * levels), levels)).all()


@given(pictures, places)
def test_within_a_view_it_ends_where_that_does(package, levels, place):
    fb = package.Framebuffer(WIDTH, HEIGHT, 8)
    fb.pixels[:] = levels = np.array(levels, np.uint8).reshape(HEIGHT, WIDTH)
    taken = area(levels, *place, None, (2, 1, 8, 6))
    assert fb.view(2, 1, 8, 6).flood_fill(place[0] - 2, place[1] - 1, 200) == taken.sum()
    assert (fb.pixels == np.where(taken, 200, levels)).all()


def test_a_spiral_and_a_whole_picture(package):
    fb = package.Framebuffer(101, 101)
    fb.polyline([(50 + (-1) ** (k // 2) * k, 50 + (-1) ** ((k + 1) // 2) * k) for k in range(0, 99, 2)])
    dark = int((fb.pixels == 0).sum())
    reached = fb.flood_fill(0, 100, 1)
    assert 0 < reached <= dark
    fb.clear()
    assert fb.flood_fill(100, 0) == 101 * 101
    assert fb.flood_fill(7, 7, 1) == 101 * 101  # of the same level: all of it again
    assert fb.flood_fill(2**80, -(2**80)) == 0
    assert fb.flood_fill(-0.6, 0) == 0
    assert fb.flood_fill(100.4, -0.5, op="xor") == 101 * 101
    assert not fb.pixels.any()


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"x": "0"}, TypeError, "x must be a number"),
        ({"y": float("nan")}, ValueError, "y must be finite"),
        ({"c": 2}, ValueError, "c must be a level"),
        ({"border": -1}, ValueError, "border must be a level"),
        ({"op": "under"}, ValueError, "op must be one of"),
    ],
)
def test_what_is_wrong_is_named(package, change, error, message):
    fb = package.Framebuffer(8, 8)
    with pytest.raises(error, match=message):
        fb.flood_fill(**{"x": 1, "y": 1, **change})
    assert not fb.pixels.any()
