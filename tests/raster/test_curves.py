"""Aliased curves of width 1: ellipses, arcs, sectors and rounded rectangles, against their definitions."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, pi, radians, sin

import definitions
import numpy as np
import pytest
import round_definitions
from hypothesis import assume, example, given
from hypothesis import strategies as st
from PIL import Image, ImageDraw
from searching import examples

WIDTH, HEIGHT = 21, 15
LARGE = 2**14

wholes = st.integers(-10, 30)
radii = st.integers(0, 24)
angles = st.one_of(
    st.sampled_from([0, 45, 90, 135, 180, 225, 270, 315, 360]), st.integers(-720, 720), st.floats(-400, 400)
)


def drawn(package, name, *arguments, size=(WIDTH, HEIGHT), **options):
    fb = package.Framebuffer(*size)
    getattr(fb, name)(*arguments, op="xor", **options)
    return fb.pixels.astype(bool)


def flood(lit):
    """The pixels that what floods in from outside reaches, across sides only."""
    page = Image.fromarray(np.pad(lit, 1).astype(np.uint8)).copy()  # what shares an array's memory is read-only
    ImageDraw.floodfill(page, (0, 0), 2)
    return (np.array(page) == 2)[1:-1, 1:-1]


# -- Ellipses


@given(wholes, wholes, radii, radii, st.booleans(), st.integers(0, 15))
@example(10, 7, 10, 1, False, 15)
@example(10, 7, 10, 0, True, 15)
@example(10, 7, 0, 5, False, 15)
@example(10, 7, 0, 0, False, 3)
def test_ellipses_equal_their_definition(package, x, y, xr, yr, fill, quadrants):
    lit = drawn(package, "ellipse", x, y, xr, yr, fill=fill, quadrants=quadrants)
    assert (lit == round_definitions.ellipse(WIDTH, HEIGHT, x, y, xr, yr, fill, quadrants)).all()


@st.composite
def passing_ellipses(draw, radius):
    xr, yr = draw(st.integers(0, 2 * radius)), draw(st.integers(radius // 2, 2 * radius))
    angle = draw(st.floats(0, 2 * pi))
    x, y = round(xr * cos(angle)), round(yr * sin(angle))
    if draw(st.booleans()):
        xr, yr, x, y = yr, xr, y, x
    return draw(st.integers(0, WIDTH)) - x, draw(st.integers(0, HEIGHT)) - y, xr, yr


@pytest.mark.parametrize("radius", [100, LARGE, 2**40, 2**70])
@examples(0.4)
@given(st.data(), st.booleans(), st.integers(0, 15))
def test_large_ellipses_equal_their_definition(package, radius, data, fill, quadrants):
    x, y, xr, yr = data.draw(passing_ellipses(radius))
    lit = drawn(package, "ellipse", x, y, xr, yr, fill=fill, quadrants=quadrants)
    wanted = round_definitions.ellipse(WIDTH, HEIGHT, x, y, xr, yr, fill, quadrants)
    assert definitions.agree(lit, wanted, (x, y, xr, yr))


@pytest.mark.parametrize("xr", [0, 1, 2, 3, 7, 30, 100])
@pytest.mark.parametrize("yr", [0, 1, 2, 5, 31])
def test_ellipses_are_symmetric_closed_and_close_to_the_true_one(package, xr, yr):
    lit = drawn(package, "ellipse", xr, yr, xr, yr, size=(2 * xr + 1, 2 * yr + 1))
    assert (lit == lit[::-1]).all()
    assert (lit == lit[:, ::-1]).all()
    assert lit[0, xr]
    assert lit[yr, 0]
    filled = drawn(package, "ellipse", xr, yr, xr, yr, fill=True, size=(2 * xr + 1, 2 * yr + 1))
    assert (filled == ~flood(lit)).all()
    true = np.linspace(0, 2 * pi, 40 * (xr + yr + 1))
    for y, x in np.argwhere(lit):
        assert np.hypot(xr * np.cos(true) - (x - xr), yr * np.sin(true) - (y - yr)).min() < 0.71


@pytest.mark.parametrize(("xr", "yr"), [(30, 1), (40, 2), (25, 9), (9, 25), (1, 30), (2, 2)])
def test_ellipses_are_one_pixel_thick(package, xr, yr):
    """Without any one of its pixels an ellipse leaks."""
    lit = drawn(package, "ellipse", xr, yr, xr, yr, size=(2 * xr + 1, 2 * yr + 1))
    inside = ~flood(lit) & ~lit
    for y, x in np.argwhere(lit):
        lit[y, x] = False
        sides = [(y + dy, x + dx) for dy, dx in ((1, 0), (-1, 0), (0, 1), (0, -1))]
        if any(0 <= v < 2 * yr + 1 and 0 <= u < 2 * xr + 1 and inside[v, u] for v, u in sides):
            assert flood(lit)[y, x]
        lit[y, x] = True


@given(wholes, wholes, radii, st.booleans())
def test_a_circle_is_an_ellipse_and_a_turn(package, x, y, r, fill):
    circle = drawn(package, "circle", x, y, r, fill=fill)
    assert (drawn(package, "ellipse", x, y, r, r, fill=fill) == circle).all()
    assert (drawn(package, "sector", x, y, r, -90, 270, fill=fill) == circle).all()
    assert fill or (drawn(package, "arc", x, y, r, 5, 500) == circle).all()


# -- Arcs and sectors

SIZE, CENTER = 61, 30
small = st.integers(0, 28)


def end_pixel(package, r, angle):
    """Where a radius ends: an arc of no length, seen from the center."""
    ((y, x),) = np.argwhere(drawn(package, "arc", CENTER, CENTER, r, angle, angle, size=(SIZE, SIZE)))
    return int(x) - CENTER, int(y) - CENTER


def between(first, last, x, y):
    """Whether a pixel lies clockwise from one to another, as seen from the center, or on the way to one of them."""
    reach, turned = (degrees(atan2(v, u) - atan2(first[1], first[0])) % 360 for u, v in (last, (x, y)))
    return turned < reach + 1e-9 or turned > 360 - 1e-9


@given(small, angles)
def test_radii_end_at_the_nearest_pixel_of_the_circle(package, r, angle):
    x, y = r * cos(radians(angle)), r * sin(radians(angle))
    circle = definitions.circle(SIZE, SIZE, CENTER, CENTER, r)
    distances = [hypot(column - CENTER - x, row - CENTER - y) for row, column in np.argwhere(circle)]
    u, v = end_pixel(package, r, angle)
    assert circle[CENTER + v, CENTER + u]
    assert hypot(u - x, v - y) < min(distances) + 1e-9


@given(small, angles, angles)
@example(3, 5, 355)
@example(3, 355, 5)
@example(1, 44, 46)
@example(20, 10, 190)
@example(20, 10, 190.001)
def test_arcs_are_the_circle_from_end_to_end(package, r, start, end):
    assume(end - start < 360)
    swept = (end - start) % 360
    arc = drawn(package, "arc", CENTER, CENTER, r, start, end, size=(SIZE, SIZE))
    circle = definitions.circle(SIZE, SIZE, CENTER, CENTER, r)
    first, last = end_pixel(package, r, start), end_pixel(package, r, end)
    if first == last:
        assert (arc == circle).all() or swept <= 180
        assert arc.sum() == 1 or swept > 180
        return
    for y, x in np.argwhere(circle):
        assert arc[y, x] == between(first, last, x - CENTER, y - CENTER)
    assert not (arc & ~circle).any()


@given(small, angles, angles)
def test_an_arc_and_the_one_back_are_the_circle(package, r, start, end):
    assume((end - start) % 360 > 0 and abs(end - start) < 360)
    there = drawn(package, "arc", CENTER, CENTER, r, start, end, size=(SIZE, SIZE))
    back = drawn(package, "arc", CENTER, CENTER, r, end, start, size=(SIZE, SIZE))
    ends = {end_pixel(package, r, start), end_pixel(package, r, end)}
    assert ((there | back) == definitions.circle(SIZE, SIZE, CENTER, CENTER, r)).all()
    assert {(int(x) - CENTER, int(y) - CENTER) for y, x in np.argwhere(there & back)} == ends


@given(small, angles, angles)
@example(12, 20, 21)
@example(12, 20, 20)
@example(2, 300, 200)
@example(1, 0, -1e-175)
def test_sectors_are_an_arc_and_two_radii_and_what_these_enclose(package, r, start, end):
    assume(end - start < 360)
    outline = drawn(package, "arc", CENTER, CENTER, r, start, end, size=(SIZE, SIZE))
    ends = end_pixel(package, r, start), end_pixel(package, r, end)
    for x, y in ends:
        outline |= definitions.bresenham(SIZE, SIZE, CENTER, CENTER, CENTER + x, CENTER + y)
    assert (drawn(package, "sector", CENTER, CENTER, r, start, end, size=(SIZE, SIZE)) == outline).all()
    filled = drawn(package, "sector", CENTER, CENTER, r, start, end, fill=True, size=(SIZE, SIZE))
    assert not (filled & flood(outline)).any()
    # Radii that lie close together may enclose a pixel outside of the sector.
    for y, x in np.argwhere(~filled & ~flood(outline)):
        assert not between(*ends, x - CENTER, y - CENTER)


@st.composite
def passing_arcs(draw, radius):
    """Sectors of which the arc or a side passes through or near the window."""
    r = draw(st.integers(radius // 2, 2 * radius))
    start = draw(st.sampled_from([0, 17, 45, 100, 180, 222, 300]))
    place, at = draw(st.sampled_from([(0, 0.5), (0, 1), (10, 1), (-1, 1)]))
    x, y = round(at * r * cos(radians(start + place))), round(at * r * sin(radians(start + place)))
    return draw(wholes) - x, draw(wholes) - y, r, start, start + draw(st.sampled_from([20, 90, 180, 300]))


@pytest.mark.parametrize("radius", [LARGE, 2**40, 2**63])
@examples(0.3)
@given(st.data())
def test_large_sectors_are_cut_off_from_their_disc(package, radius, data):
    x, y, r, start, end = data.draw(passing_arcs(radius))
    filled = drawn(package, "sector", x, y, r, start, end, fill=True)
    outline = drawn(package, "sector", x, y, r, start, end)
    arc = drawn(package, "arc", x, y, r, start, end)
    disc, circle = (round_definitions.ellipse(WIDTH, HEIGHT, x, y, r, r, fill) for fill in (True, False))
    assert not (outline & ~filled).any()
    assert not (arc & ~outline).any()
    assert definitions.agree(arc | circle, circle, (x, y, r))
    # Away from the sides all of the disc, or nothing.
    for row, column in np.ndindex(disc.shape):
        turned = (degrees(atan2(row - y, column - x)) - start) % 360
        # Where a side is, floats can tell to some 1e-13 degrees.
        near = min(turned, 360 - turned, abs(turned - (end - start))) < max(
            degrees(3 / max(hypot(row - y, column - x), 1)), 2e-13
        )
        # Far away the curve may be off by a pixel.
        near = near or (radius > LARGE and abs(hypot(row - y, column - x) - r) <= 2)
        if not near:
            inside = turned < end - start
            assert filled[row, column] == (disc[row, column] and inside)
            assert arc[row, column] == (circle[row, column] and inside)


@given(st.sampled_from([LARGE, LARGE + 1, 2**62]), st.sampled_from([0, 90, 180, 270]), st.booleans())
def test_quarter_turns_are_quadrants(package, r, start, fill):
    """On both sides of where large radii begin."""
    for x, y in ((10, 7), (10 - r, 7), (10, 7 + r), (10 + r, 7), (10, 7 - r)):
        quadrant = {0: 8, 90: 4, 180: 2, 270: 1}[start]
        ellipse = round_definitions.ellipse(WIDTH, HEIGHT, x, y, r, r, fill, quadrant)
        if fill:
            assert (drawn(package, "sector", x, y, r, start, start + 90, fill=True) == ellipse).all()
        else:
            assert (drawn(package, "arc", x, y, r, start, start + 90) == ellipse).all()


# -- Rounded rectangles


@given(wholes, wholes, st.integers(1, 30), st.integers(1, 30), st.integers(0, 12), st.booleans())
@example(2, 2, 4, 4, 2, False)
@example(2, 2, 3, 9, 99, False)
@example(2, 2, 9, 3, 99, True)
@example(2, 2, 1, 9, 99, False)
def test_rounded_rectangles_are_quadrants_and_sides(package, x, y, w, h, r, fill):
    assert (
        drawn(package, "round_rect", x, y, w, h, r, fill=fill)
        == round_definitions.round_rect(WIDTH, HEIGHT, x, y, w, h, r, fill)
    ).all()


@pytest.mark.parametrize("r", [3, LARGE, 2**40])
@examples(0.4)
@given(st.data(), st.booleans())
def test_large_rounded_rectangles_are_quadrants_and_sides(package, r, data, fill):
    side = st.sampled_from([2 * r + 1, 2 * r + 2, 3 * r, 2**63, 2**70])
    w, h = data.draw(side), data.draw(side)
    corners = st.tuples(st.sampled_from([0, r // 3, r, w // 2, w - r, w - 1]), st.sampled_from([0, r, h // 2, h - 1]))
    x, y = data.draw(corners)
    x, y = data.draw(wholes) - x, data.draw(wholes) - y
    assert (
        drawn(package, "round_rect", x, y, w, h, r, fill=fill)
        == round_definitions.round_rect(WIDTH, HEIGHT, x, y, w, h, r, fill)
    ).all()


@given(wholes, wholes, st.integers(0, 20), st.integers(0, 20), st.booleans())
def test_with_a_radius_of_0_it_is_a_rectangle(package, x, y, w, h, fill):
    assert (
        drawn(package, "round_rect", x, y, w, h, 0, fill=fill) == drawn(package, "rect", x, y, w, h, fill=fill)
    ).all()


# -- Arguments

CALLS = {
    "rect": {"x": 1, "y": 1, "w": 5, "h": 5},
    "round_rect": {"x": 1, "y": 1, "w": 5, "h": 5, "r": 2},
    "circle": {"x": 1, "y": 1, "r": 3},
    "ellipse": {"x": 1, "y": 1, "xr": 3, "yr": 2},
    "arc": {"x": 1, "y": 1, "r": 3, "start": 0, "end": 90},
    "sector": {"x": 1, "y": 1, "r": 3, "start": 0, "end": 90},
}


@pytest.fixture(params=[None, 4], ids=["aliased", "anti-aliased"])
def fb(request, package):
    return package.Framebuffer(9, 7, antialias=request.param and package.Supersample(request.param))


@pytest.mark.parametrize("name", CALLS)
def test_numbers_that_are_none_are_refused_by_name(fb, name):
    for argument in [*CALLS[name], "width"]:
        for wrong, error in (
            (float("nan"), ValueError),
            (float("-inf"), ValueError),
            ("3", TypeError),
            (None, TypeError),
        ):
            with pytest.raises(error, match=rf"^{argument} must be "):
                getattr(fb, name)(**{**CALLS[name], argument: wrong})


@pytest.mark.parametrize("name", CALLS)
def test_negative_lengths_are_refused_by_name(fb, name):
    for argument in {"w", "h", "r", "xr", "yr"} & set(CALLS[name]):
        for wrong in (-1, -0.001, -(2**70)):
            with pytest.raises(ValueError, match=rf"^{argument} must not be negative"):
                getattr(fb, name)(**{**CALLS[name], argument: wrong})
    for wrong in (0, -1, 0.001, -(2**70)):
        with pytest.raises(ValueError, match=r"^width must be at least 1/256 of a pixel"):
            getattr(fb, name)(**CALLS[name], width=wrong)


@pytest.mark.parametrize("name", CALLS)
def test_other_arguments_are_refused_by_name(fb, name):
    call = getattr(fb, name)
    dash = () if name in ("rect", "circle", "arc") else ({"dash": (1, 2)},)
    for wrong in ({"antialias": 4}, {"antialias": "yes"}, {"c": 1.5}, *dash):
        with pytest.raises(TypeError, match=next(iter(wrong))):
            call(**CALLS[name], **wrong)
    for wrong in ({"c": 2}, {"c": -1}, {"op": "under"}):
        with pytest.raises(ValueError, match=next(iter(wrong))):
            call(**CALLS[name], **wrong)
    assert not fb.pixels.any()


@pytest.mark.parametrize("wrong", [-1, 16, 2**70])
def test_quadrants_out_of_range_are_refused(fb, wrong):
    with pytest.raises(ValueError, match=r"^quadrants must be from 0 to 15"):
        fb.ellipse(1, 1, 2, 2, quadrants=wrong)
    with pytest.raises(TypeError, match=r"^quadrants must be a whole number"):
        fb.ellipse(1, 1, 2, 2, quadrants=1.0)


@pytest.mark.parametrize(
    ("start", "end"), [(10**400, 0.5), (-1e308, 1e308), (1e308, -1e308), (2**80 + 90, 2**80 + 180)]
)
def test_angles_of_any_size(fb, start, end):
    fb.arc(4, 3, 3, start, end)
    fb.sector(4, 3, 3, start, end, fill=True)
    assert fb.pixels.any()


@pytest.mark.parametrize("turns", [-3, 0, 10**20])
def test_whole_turns_more_are_the_same_angle(package, fb, turns):
    fb.arc(4, 3, 3, 360 * turns + 30, 360 * turns + 100)
    other = package.Framebuffer(9, 7, antialias=fb.antialias)
    other.arc(4, 3, 3, 30, 100)
    assert fb == other
