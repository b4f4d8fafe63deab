"""The demos draw on any panel, keep no state, and look as they did."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Framebuffer
from paneldraw.demos import DEMOS, find
from paneldraw.testing import assert_frame

MOMENT = 36579.2
SIZES = [(128, 64), (128, 32), (96, 16), (72, 40), (64, 48), (48, 64), (64, 128), (128, 128), (256, 64), (8, 8)]


def drawn(name, width, height, depth, t):
    fb = Framebuffer(width, height, depth)
    fb.fill(fb.max_level)
    find(name)(fb, t)
    return fb


@pytest.mark.parametrize("name", DEMOS)
def test_demos_look_as_they_did(name):
    assert_frame(drawn(name, 128, 64, 1, MOMENT), f"demo_{name}.png")


def test_a_demo_of_sixteen_shades_looks_as_it_did():
    assert_frame(drawn("scene", 128, 64, 4, MOMENT), "demo_scene_shades.png")


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", DEMOS)
def test_demos_fit_any_panel(name, size, depth):
    fb = drawn(name, *size, depth, MOMENT)
    assert fb.pixels.max() == fb.max_level
    assert fb.pixels.min() == 0
    assert np.count_nonzero(fb.pixels) < fb.pixels.size / 2 or min(size) <= 16


@given(st.sampled_from(list(DEMOS)), st.integers(8, 200), st.integers(8, 100), st.floats(0, 86400))
def test_any_size_at_any_time(name, width, height, t):
    assert drawn(name, width, height, 1, t).pixels.any()


@pytest.mark.parametrize("name", DEMOS)
def test_a_moment_always_looks_the_same_and_another_does_not(name):
    once = drawn(name, 128, 64, 4, MOMENT)
    later = drawn(name, 128, 64, 4, MOMENT + 1.5)
    assert once == drawn(name, 128, 64, 4, MOMENT)
    assert once != later


def test_the_cube_fits_at_every_angle():
    for step in range(100):
        fb = drawn("cube", 64, 64, 1, step / 10)
        edge = np.concatenate([fb.pixels[0], fb.pixels[-1], fb.pixels[:, 0], fb.pixels[:, -1]])
        assert not edge.any()


def test_the_right_half_of_the_lines_has_shades_and_the_left_has_none():
    fb = drawn("lines", 128, 64, 8, MOMENT)
    below_names = fb.pixels[9:]
    assert set(np.unique(below_names[:, :64])) == {0, 255}
    assert len(np.unique(below_names[:, 65:])) > 8


def test_the_clock_tells_the_time():
    fb = drawn("clock", 128, 64, 1, 10 * 3600 + 9 * 60 + 36)
    figures = Framebuffer(128, 64)
    figures.text("36", 95, 35, anchor="mt")
    assert (fb.pixels[35:43, 88:104] == figures.pixels[35:43, 88:104]).all()


def test_an_unknown_demo():
    with pytest.raises(ValueError, match="lines, cube, clock"):
        find("snake")
