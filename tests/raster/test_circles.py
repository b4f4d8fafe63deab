"""The circle, against the nearest pixels to the true one."""

from __future__ import annotations

from math import hypot

import definitions
import numpy as np
import pytest
import round_definitions
from hypothesis import example, given
from hypothesis import strategies as st
from PIL import Image, ImageDraw
from searching import examples

WIDTH, HEIGHT = 21, 15
LARGE_RADIUS, FAR = 2**14, 2**29  # beyond either the raster computes in another way


def drawn(package, x, y, r, fill=False, width=WIDTH, height=HEIGHT):
    fb = package.Framebuffer(width, height)
    fb.circle(x, y, r, fill=fill, op="xor")
    return fb.pixels.astype(bool)


@given(st.integers(-10, 30), st.integers(-10, 30), st.integers(0, 30), st.booleans())
def test_circles_equal_the_nearest_pixels(package, x, y, r, fill):
    assert (drawn(package, x, y, r, fill) == definitions.circle(WIDTH, HEIGHT, x, y, r, fill)).all()


@st.composite
def passing_circles(draw, radius):
    """Circles whose outline passes through or near the window."""
    r = draw(st.integers(radius // 2, 2 * radius))
    x = draw(st.integers(-r, r))
    y = int((r * r - x * x) ** 0.5) * draw(st.sampled_from([1, -1]))
    return x + draw(st.integers(0, WIDTH)), y + draw(st.integers(0, HEIGHT)), r


@pytest.mark.parametrize("radius", [100, LARGE_RADIUS, 2**30])
@examples(0.4)
@given(st.data(), st.booleans())
def test_large_circles_equal_the_nearest_pixels(package, radius, data, fill):
    x, y, r = data.draw(passing_circles(radius))
    assert definitions.agree(drawn(package, x, y, r, fill), definitions.circle(WIDTH, HEIGHT, x, y, r, fill), (x, y, r))


@examples(0.5)
@given(st.sampled_from([LARGE_RADIUS - 1, LARGE_RADIUS, LARGE_RADIUS + 1]), st.integers(-2, 2), st.booleans())
def test_circles_on_both_sides_of_the_threshold_equal_the_nearest_pixels(package, r, shift, fill):
    for x, y in ((10 + shift - r, 7), (10, 7 + shift + r), (10 + r * 7071 // 10000, 7 + shift - r * 7071 // 10000)):
        assert (drawn(package, x, y, r, fill) == definitions.circle(WIDTH, HEIGHT, x, y, r, fill)).all()


def test_large_circles_end_their_top_row_where_the_definition_does(package):
    """A square as radius, r = k * k: the pixel k steps from the top just is not in the top row."""
    k = 129
    assert k * k > LARGE_RADIUS
    lit = drawn(package, 10 - k, 7 + k * k, k * k)
    assert (lit == definitions.circle(WIDTH, HEIGHT, 10 - k, 7 + k * k, k * k)).all()
    assert lit[7, 9]
    assert not lit[7, 10]


@given(*[st.sampled_from([-(2**70), -FAR - 1, -FAR, 3, FAR, FAR + 1, 2**63, 2**70])] * 2, st.integers(0, 2**71))
@example(FAR, 3, FAR)
@example(FAR + 1, 3, FAR + 1)
@example(3, -FAR - 1, FAR + 3)
def test_circles_around_far_centers(package, x, y, r):
    for fill in (False, True):
        assert (drawn(package, x, y, r, fill) == definitions.circle(WIDTH, HEIGHT, x, y, r, fill)).all()


@pytest.fixture(params=[*range(12), 25, 60])
def ring(request, package):
    r = request.param
    return r, drawn(package, r, r, r, width=2 * r + 1, height=2 * r + 1)


def test_circles_look_the_same_in_eight_directions(ring):
    _, lit = ring
    assert (lit == lit[::-1]).all()
    assert (lit == lit[:, ::-1]).all()
    assert (lit == lit.T).all()


def test_circles_reach_their_radius(ring):
    r, lit = ring
    assert lit[0, r]
    assert lit[r, 0]


def test_circles_stay_close_to_the_true_one(ring):
    r, lit = ring
    assert all(abs(hypot(x - r, y - r) - r) < 0.71 for y, x in np.argwhere(lit))


def test_circles_are_closed(ring):
    """Each pixel of the ring touches two others, and what floods in from outside does not reach the center."""
    r, lit = ring
    padded = np.pad(lit, 1).astype(int)
    neighbors = sum(np.roll(padded, (dy, dx), (0, 1)) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dx or dy)
    assert r == 0 or (neighbors[padded == 1] >= 2).all()
    page = Image.fromarray(np.pad(lit, 1).astype(np.uint8)).copy()  # what shares an array's memory is read-only
    ImageDraw.floodfill(page, (0, 0), 2)
    assert page.getpixel((r + 1, r + 1)) != 2


def test_discs_are_the_ring_and_what_it_encloses(ring, package):
    r, lit = ring
    filled = drawn(package, r, r, r, True, 2 * r + 1, 2 * r + 1)
    enclosed = np.maximum.accumulate(lit, axis=1) & np.maximum.accumulate(lit[:, ::-1], axis=1)[:, ::-1]
    assert (filled == enclosed).all()


@given(*[st.floats(-30, 30)] * 2, st.floats(0, 30))
@example(4.5, -0.5, 3.5)
@example(4.25, -0.75, 3.25)
def test_floats_are_taken_to_the_nearest_half_pixel(package, x, y, r):
    assert (drawn(package, x, y, r) == round_definitions.ellipse(WIDTH, HEIGHT, x, y, r, r)).all()
