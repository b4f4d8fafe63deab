"""The demos draw on any panel, keep no state, and look as they did."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Framebuffer
from paneldraw.demos import DEMOS, find, life, menu, pong
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


@pytest.mark.parametrize("name", ["scene", "weather", "life"])
def test_a_demo_of_sixteen_shades_looks_as_it_did(name):
    assert_frame(drawn(name, 128, 64, 4, MOMENT), f"demo_{name}_shades.png")


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("name", DEMOS)
def test_demos_fit_any_panel(name, size, depth):
    fb = drawn(name, *size, depth, MOMENT)
    is_film = name == "video"
    assert fb.pixels.max() > fb.max_level // 2 if is_film else fb.pixels.max() == fb.max_level
    assert fb.pixels.min() == 0
    assert np.count_nonzero(fb.pixels) < fb.pixels.size / 2 or min(size) <= 16 or is_film


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


def test_life_goes_by_the_rules():
    for number in range(1, 30):
        before, after = (life.generation(20, 30, 3, n) == 255 for n in (number - 1, number))
        around = sum(np.roll(before, (y, x), (0, 1)).astype(int) for y in (-1, 0, 1) for x in (-1, 0, 1)) - before
        assert np.array_equal(after, np.where(before, (around == 2) | (around == 3), around == 3))


def test_life_never_ends():
    assert all((life.generation(5, 7, epoch, 149) == 255).any() for epoch in range(40))


def test_a_generation_is_the_same_whatever_was_asked_for_before():
    forward = [life.generation(16, 32, 5, number).copy() for number in range(20)]
    life.generation.cache_clear()
    assert all(np.array_equal(life.generation(16, 32, 5, number), forward[number]) for number in (19, 3, 11))


def test_a_rally_ends_with_a_point():
    # A moment after each crossing the ball is far from the figures.
    moments = [pong.CROSSING * (crossing + 0.05) for crossing in range(10 * (2 * pong.RALLY - 1))]
    pictures = [drawn("pong", 128, 64, 1, moment).pixels for moment in moments]
    for left in (40, 64):
        figures = [picture[1:17, left : left + 24].tobytes() for picture in pictures]
        assert len(set(figures)) == 10
        assert sum(one != other for one, other in itertools.pairwise(figures)) == 9 + (left == 40)


def test_the_ball_leaves_the_court_only_where_it_is_missed():
    out = [drawn("pong", 128, 64, 1, tenth / 20).pixels for tenth in range(int(20 * pong.CROSSING * 11))]
    passed = [bool(picture[:, 0].any()) + 2 * bool(picture[:, -1].any()) for picture in out]
    assert [side for side, _ in itertools.groupby(passed) if side] == [1, 2]


def test_the_menu_answers_the_keys():
    settings = [drawn("menu", 128, 64, 1, menu.STEP * (pressed + 0.01)).pixels for pressed in range(len(menu.KEYS))]
    assert len({picture.tobytes() for picture in settings}) > 10


def test_the_demos_fit_on_a_screen():
    folder = Path(menu.__file__).parent
    assert all(len((folder / f"{name}.py").read_text().splitlines()) <= 70 for name in DEMOS)


def test_an_unknown_demo():
    with pytest.raises(ValueError, match="lines, cube, clock"):
        find("snake")
