"""Thick and supersampled lines, against counting the reference points in the rectangle."""

from __future__ import annotations

import definitions
import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from searching import examples

import paneldraw

WIDTH, HEIGHT = 13, 9
REACH = definitions.REACH
WIDEST = 2**32  # what is wider counts as that

caps = st.sampled_from(["square", "butt"])
samples = st.tuples(st.integers(1, 16), st.sampled_from(["center", "corner"]))
few_samples = st.tuples(st.sampled_from([1, 2, 3, 4]), st.sampled_from(["center", "corner"]))
in_256ths = st.integers(-12 * 256, 24 * 256).map(lambda v: v / 256)
# Halves and quarters: where reference points fall on edges.
coarse = st.integers(-24, 96).map(lambda v: v / 4)
coordinates = st.one_of(st.integers(-12, 24), coarse, in_256ths)
widths = st.one_of(st.integers(1, 12), st.integers(1, 8 * 256).map(lambda v: v / 256))


def drawn(package, ends, width, cap="square", n=1, reference="center"):
    """The counts of reference points, read off the levels: they come out unrounded in an eight-bit picture."""
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=8)
    antialias = package.Supersample(n, reference)
    if n == 1:
        fb.line(*ends, 1, width=width, cap=cap, antialias=antialias)
        return fb.pixels
    # 255 levels count to 15 x 15; of 256 points one level is lost, that of the last.
    full = n * n if n < 16 else 255
    fb.line(*ends, full, width=width, cap=cap, antialias=antialias)
    return fb.pixels


def counted(ends, width, cap="square", n=1, reference="center"):
    counts = definitions.rectangle(WIDTH, HEIGHT, *ends, width, cap, n, reference)
    return (counts * 510 + 256) // 512 if n == 16 else counts


@examples(1.6)
@given(st.tuples(*[coordinates] * 4), widths, caps, few_samples)
@example((2, 2, 9, 2), 3, "butt", (1, "center"))
@example((2, 2, 9, 6), 4, "square", (1, "corner"))
@example((5, 4, 5, 4), 3, "square", (1, "center"))
@example((5, 4, 5, 4), 3, "butt", (2, "center"))
@example((0, 0, 8, 6), 5, "butt", (1, "center"))  # a 3-4-5 triangle: edges through pixel centers
@example((0, 8, 8, 2), 5, "square", (2, "corner"))
def test_lines_equal_counting(package, ends, width, cap, samples):
    assert (drawn(package, ends, width, cap, *samples) == counted(ends, width, cap, *samples)).all()


within = st.tuples(
    *[st.integers(0, 12 * 256).map(lambda v: v / 256), st.integers(0, 8 * 256).map(lambda v: v / 256)] * 2
)


@examples(3)
@given(within, st.integers(100, 1000).map(lambda v: v / 256), caps, st.sampled_from([(4, "center"), (3, "corner")]))
def test_lines_within_the_picture_equal_counting(package, ends, width, cap, samples):
    assert (drawn(package, ends, width, cap, *samples) == counted(ends, width, cap, *samples)).all()


@pytest.mark.parametrize("across", [-1, 1])
@pytest.mark.parametrize("along", [-1, 1])
def test_points_just_within_an_edge_are_in(package, across, along):
    """A center 16 lattice steps from a line whose edge lies 16.97 steps away, which no rounded bound may cut off."""
    x, y, step = 5, 4 + across * 4 / 256, along / 256
    for ends in ((x, y, x + step, y + step), (x, y, x + step, y - step)):
        lit = drawn(package, ends, 6 / 256)
        assert lit[4, 5] == 1
        assert (lit == counted(ends, 6 / 256)).all()


@examples(0.5)
@given(st.tuples(*[coordinates] * 4), widths, caps, samples)
def test_lines_of_many_samples_equal_counting(package, ends, width, cap, samples):
    assert (drawn(package, ends, width, cap, *samples) == counted(ends, width, cap, *samples)).all()


@st.composite
def crossing_lines(draw, reach):
    x, y = draw(st.integers(-3, WIDTH + 3)), draw(st.integers(-3, HEIGHT + 3))
    dx, dy = draw(st.integers(-reach, reach)), draw(st.integers(-reach, reach))
    before, behind = draw(st.fractions(0, 1, max_denominator=7)), draw(st.fractions(0, 1, max_denominator=7))
    return x - round(before * dx), y - round(before * dy), x + round(behind * dx), y + round(behind * dy)


def assert_agreement(package, ends, width, cap, samples):
    counts = counted(ends, min(width, WIDEST), cap, *samples)
    assert definitions.agree(drawn(package, ends, width, cap, *samples), counts, (*ends, width))


@pytest.mark.parametrize("reach", [REACH - WIDTH - 3, 4 * REACH, 2**63, 2**70])
@examples(0.6)
@given(st.data(), st.one_of(st.integers(1, 12), st.floats(1.5, 8)), caps, few_samples)
def test_lines_from_far_away_agree_with_counting(package, reach, data, width, cap, samples):
    assert_agreement(package, data.draw(crossing_lines(reach)), width, cap, samples)


edges = st.sampled_from([0, 4, REACH - 1, REACH, REACH + 1, -REACH + 1, -REACH, -REACH - 1, 2**70, -(2**70)])


@given(st.tuples(*[edges] * 4), st.sampled_from([1, 2.5, 4097, REACH, REACH + 1, 2**60, 2**70]), caps, few_samples)
@example((2**80, 0, 2**80, 5), 3, "square", (2, "center"))
@example((0, 2**80, 5, 2**80), 3, "square", (2, "center"))
@example((-REACH, -REACH, REACH, REACH), 4096, "butt", (4, "corner"))
def test_lines_on_both_sides_of_the_thresholds_agree_with_counting(package, ends, width, cap, samples):
    assert_agreement(package, ends, width, cap, samples)


@given(st.tuples(*[st.floats(allow_nan=False, allow_infinity=False)] * 4), st.floats(1, 1e308), few_samples)
@example((1e308, 0.0, -1e308, 3.0), 1e308, (2, "center"))
@example((1.5 / 256, 0.0, 2.5 / 256, 3.0), 1.5, (4, "center"))
def test_floats_of_any_size_are_taken_to_the_nearest_256th(package, ends, width, samples):
    assert_agreement(package, ends, width, "square", samples)


@pytest.mark.parametrize("cap", ["square", "butt"])
@given(st.tuples(*[coarse] * 4), few_samples)
def test_neighbors_share_an_edge_and_no_pixel(package, cap, ends, samples):
    """Two halves of a wide line, cut along its middle, are the whole one: no gap, no overlap."""
    x1, y1, x2, y2 = ends
    if (x1 == x2) == (y1 == y2):
        return
    counts = np.zeros((HEIGHT, WIDTH), int)
    across = (1, 0) if x1 == x2 else (0, 1)
    for side in (-1, 1):
        moved = (x1 + side * across[0], y1 + side * across[1], x2 + side * across[0], y2 + side * across[1])
        counts += drawn(package, moved, 2, "butt", *samples)
    assert (counts == drawn(package, ends, 4, "butt", *samples)).all()


@given(st.tuples(*[st.integers(-3, 15)] * 4), few_samples, st.integers(1, 5))
def test_the_same_pixels_in_both_directions(package, ends, samples, width):
    there, back = (drawn(package, way, width, "square", *samples) for way in (ends, (*ends[2:], *ends[:2])))
    assert (there == back).all()


@pytest.mark.parametrize("n", range(2, 17))
def test_every_step_from_nothing_to_the_full_level_is_reached(package, n):
    """A rectangle that grows by one reference point after the other, in the one pixel there is."""
    seen = set()
    for rows in range(n + 1):
        for columns in range(n + 1):
            fb = package.Framebuffer(1, 1, depth=8)
            if rows and columns:
                y = -0.5 + rows / n / 2
                fb.line(-0.5, y, -0.5 + columns / n, y, width=rows / n, cap="butt", antialias=package.Supersample(n))
            seen.add(int(fb.pixels[0, 0]))
    reached = {a * b for a in range(n + 1) for b in range(n + 1)}
    assert seen == {(510 * count + n * n) // (2 * n * n) for count in reached}


def test_samples_of_a_class_that_forgets_to_initialize_do_not_end_the_process(package):
    class Forgetful(package.Supersample):
        def __init__(self):
            pass

    fb = package.Framebuffer(8, 8)
    for draw in (lambda: fb.line(0, 0, 7, 3, antialias=Forgetful()), lambda: fb.circle(3, 3, 2, antialias=Forgetful())):
        try:
            draw()
        except AttributeError:
            assert package is not paneldraw
        else:
            assert fb.pixels.any()
