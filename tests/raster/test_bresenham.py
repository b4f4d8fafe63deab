"""The thin line, against the textbook's definition in exact arithmetic."""

from __future__ import annotations

from fractions import Fraction

import definitions
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

WIDTH, HEIGHT = 23, 17
near = st.one_of(st.integers(-2, 2), st.integers(14, 24), st.integers(-40, 60))
REACH = definitions.REACH


def drawn(package, x1, y1, x2, y2, width=WIDTH, height=HEIGHT):
    fb = package.Framebuffer(width, height)
    fb.line(x1, y1, x2, y2, op="xor")
    return fb.pixels.astype(bool)


@st.composite
def crossing_lines(draw, reach):
    """Lines with end points up to `reach` away that pass through or near the window."""
    x, y = draw(st.integers(-3, WIDTH + 3)), draw(st.integers(-3, HEIGHT + 3))
    dx, dy = draw(st.integers(-reach, reach)), draw(st.integers(-reach, reach))
    before, behind = draw(st.fractions(0, 1, max_denominator=7)), draw(st.fractions(0, 1, max_denominator=7))
    return x - round(before * dx), y - round(before * dy), x + round(behind * dx), y + round(behind * dy)


@given(st.tuples(near, near, near, near))
@example((0, 0, 8, 4))
@example((0, 4, 8, 0))
@example((3, 3, 3, 3))
def test_lines_equal_exact_rounding(package, ends):
    assert (drawn(package, *ends) == definitions.bresenham(WIDTH, HEIGHT, *ends)).all()


@pytest.mark.parametrize("x", [-2, -1, 0, 2, 5, 6, 7])
@pytest.mark.parametrize("y", [-2, -1, 0, 1, 3, 4])
def test_all_lines_around_a_small_picture_equal_exact_rounding(package, x, y):
    for x2 in range(-3, 10):
        for y2 in range(-3, 8):
            assert (drawn(package, x, y, x2, y2, 6, 4) == definitions.bresenham(6, 4, x, y, x2, y2)).all(), (x2, y2)


@pytest.mark.parametrize("reach", [1000, REACH - WIDTH - 3, 2 * REACH, 2**30, 2**63, 2**70])
@given(st.data())
def test_lines_from_far_away_agree_with_exact_rounding(package, reach, data):
    ends = data.draw(crossing_lines(reach))
    assert definitions.agree(drawn(package, *ends), definitions.bresenham(WIDTH, HEIGHT, *ends), ends)


@given(st.tuples(*[st.sampled_from([s * (v + d) for v in (0, REACH) for d in (-1, 0, 1) for s in (1, -1)])] * 4))
@example((-REACH, -REACH, REACH, REACH - 1))
def test_lines_on_both_sides_of_the_threshold_agree_with_exact_rounding(package, ends):
    assert definitions.agree(drawn(package, *ends), definitions.bresenham(WIDTH, HEIGHT, *ends), ends)


@given(st.sampled_from([-(2**70), -(2**40), 5, 2**40, 2**70]), st.sampled_from([-(2**70), 2**40, 5, 2**63]))
def test_a_line_of_no_length_is_a_pixel_wherever_it_is(package, x, y):
    assert drawn(package, x, y, x, y).sum() == (x == y == 5)


@given(crossing_lines(100))
def test_the_same_pixels_in_both_directions(package, ends):
    assert (drawn(package, *ends) == drawn(package, *ends[2:], *ends[:2])).all()


@given(st.tuples(near, near, near, near))
def test_clipping_changes_no_pixel(package, ends):
    whole = drawn(package, *(v + 40 for v in ends), 101, 101)
    assert (drawn(package, *ends) == whole[40 : 40 + HEIGHT, 40 : 40 + WIDTH]).all()


@given(st.tuples(*[st.integers(0, 40)] * 4))
def test_one_pixel_a_step_each_within_half_a_pixel_of_the_true_line(package, ends):
    x1, y1, x2, y2 = ends
    lit = drawn(package, *ends, 41, 41)
    assert lit[y1, x1]
    assert lit[y2, x2]
    if abs(x2 - x1) < abs(y2 - y1):
        lit, x1, y1, x2, y2 = lit.T, y1, x1, y2, x2
    assert (lit.sum(axis=0)[min(x1, x2) : max(x1, x2) + 1] == 1).all()
    assert lit.sum() == abs(x2 - x1) + 1
    for y, x in np.argwhere(lit).tolist():
        true = y1 + Fraction((y2 - y1) * (x - x1), x2 - x1) if x1 != x2 else y1
        assert abs(y - true) <= Fraction(1, 2)


@given(st.tuples(*[st.floats(-30, 50)] * 4))
@example((0.5, -0.5, 12.5, 3.5))
@example((0.49999999999999994, 0.0, 9.0, 3.0))
def test_floats_are_taken_to_the_nearest_pixel(package, ends):
    assert (drawn(package, *ends) == definitions.bresenham(WIDTH, HEIGHT, *ends)).all()


@given(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 4))
@example((1e308, 0.0, -1e308, 5.0))
@example((2.0**52 + 1, 3.0, -(2.0**52) - 1, 4.0))
def test_floats_of_any_size(package, ends):
    assert definitions.agree(drawn(package, *ends), definitions.bresenham(WIDTH, HEIGHT, *ends), ends)
