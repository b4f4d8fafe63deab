"""Polygons, polylines and dashes, against their definitions."""

from __future__ import annotations

from itertools import pairwise

import definitions
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from searching import examples

WIDTH, HEIGHT = 14, 10
near = st.one_of(
    st.integers(-8, 22), st.integers(-24, 80).map(lambda v: v / 4), st.integers(-999, 5000).map(lambda v: v / 256)
)
corners = st.lists(st.tuples(near, near), min_size=3, max_size=7)
whole_corners = st.lists(st.tuples(st.integers(-8, 22), st.integers(-8, 18)), min_size=1, max_size=6)
rules = st.sampled_from(["even-odd", "nonzero"])
samples = st.tuples(st.sampled_from([1, 2, 3, 4, 7]), st.sampled_from(["center", "corner"]))
dashes = st.lists(st.integers(1, 6), min_size=1, max_size=4)


def has_area(corners):
    (x0, y0), *others = corners
    x1, y1 = next((corner for corner in others if corner != corners[0]), corners[0])
    return any((x - x0) * (y1 - y0) != (y - y0) * (x1 - x0) for x, y in others)


def filled(package, corners, rule, n, reference):
    """The counts of reference points, read off the levels."""
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=8)
    fb.poly(0, 0, corners, n * n, True, rule=rule, antialias=package.Supersample(n, reference))
    return fb.pixels


@examples(2)
@given(corners, rules, samples)
@example([(0, 0), (8, 0), (8, 6), (0, 6)], "even-odd", (1, "center"))
@example([(0, 0), (8, 6), (8, 0), (0, 6)], "nonzero", (2, "corner"))
@example([(2, 1), (11, 1), (4, 9), (6, -3), (9, 8)], "nonzero", (4, "center"))
def test_fills_equal_counting(package, corners, rule, samples):
    assume(has_area(corners))
    assert (
        filled(package, corners, rule, *samples) == definitions.polygon(WIDTH, HEIGHT, corners, rule, *samples)
    ).all()


@given(corners, st.tuples(near, near), samples)
def test_polygons_that_share_an_edge_leave_no_gap_and_no_overlap(package, corners, point, samples):
    """A polygon cut in two through any of its points, by way of any other point, is the sum of its parts."""
    parts = ([corners[0], *corners[2:]], corners[:3])
    assume(all(map(has_area, (*parts, corners))))
    together = package.Framebuffer(WIDTH, HEIGHT, 1)
    for part in parts:
        together.poly(0, 0, part, 1, True, edges="shared", op="xor")
    whole = package.Framebuffer(WIDTH, HEIGHT, 1)
    whole.poly(0, 0, corners, 1, True, edges="shared", op="xor")
    assert together == whole


@given(corners, rules, st.integers(-5, 5), st.integers(-5, 5))
def test_a_polygon_moved_is_the_same_polygon(package, corners, rule, x, y):
    fb, said = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    fb.poly(x, y, corners, 1, True, rule=rule)
    said.poly(0, 0, [(a + x, b + y) for a, b in corners], 1, True, rule=rule)
    assert fb == said


def both(package, points, closed, op):
    """What `polyline` lights, and what its lines do by their definition."""
    ends = list(pairwise(points)) or [(points[0], points[0])]
    if closed:
        ends.append((points[-1], points[0]))
    wanted = np.zeros((HEIGHT, WIDTH), bool)
    for a, b in ends:
        wanted |= definitions.bresenham(WIDTH, HEIGHT, *a, *b)
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.polyline(points, 1, closed=closed, op=op)
    return fb.pixels.astype(bool), wanted


@given(whole_corners, st.booleans(), st.sampled_from(["over", "xor"]))
def test_polylines_are_their_lines_each_pixel_once(package, points, closed, op):
    drawn, wanted = both(package, points, closed, op)
    assert (drawn == wanted).all()


def grown(pixels):
    """Those pixels and the eight around each."""
    padded = np.pad(pixels, 1)
    height, width = pixels.shape
    return np.any([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)


far = st.one_of(st.integers(-8, 22), st.sampled_from([2**29 + 1, -(2**29) - 1, 2**40, -(2**63), 2**70]))


@given(st.lists(st.tuples(far, far), min_size=2, max_size=5), st.booleans(), st.sampled_from(["over", "xor"]))
@example([(0, 0), (5, 5), (2**40, 5)], False, "xor")
@example([(2**29 + 1, 0), (-(2**29) - 1, 1)], False, "over")
def test_polylines_from_far_away_are_a_pixel_off_at_most(package, points, closed, op):
    drawn, wanted = both(package, points, closed, op)
    inside = np.s_[1:-1, 1:-1]  # what is a pixel off may come into sight at its edges
    assert not (drawn & ~grown(wanted))[inside].any()
    assert not (wanted & ~grown(drawn))[inside].any()


@given(whole_corners)
def test_an_outline_is_a_closed_polyline(package, points):
    fb, said = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    fb.poly(0, 0, points)
    said.polyline(points, closed=True)
    assert fb == said


@given(st.tuples(*[st.integers(-30, 40)] * 4), dashes)
def test_dashes_count_pixels(package, ends, dash):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(*ends, 1, dash=dash)
    assert (fb.pixels == definitions.dashed(WIDTH, HEIGHT, *ends, dash)).all()


@given(st.tuples(*[far] * 4), dashes)
def test_dashes_of_far_lines_count_pixels(package, ends, dash):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(*ends, 1, dash=dash)
    assert (fb.pixels == definitions.dashed(WIDTH, HEIGHT, *ends, dash)).all()


@given(st.tuples(*[st.one_of(st.integers(-30, 40), st.integers(-(2**29), 2**29), far)] * 4))
def test_the_dda_finds_the_same_pixels(package, ends):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(*ends, algorithm="dda")
    assert (fb.pixels == definitions.bresenham(WIDTH, HEIGHT, *ends)).all()


@given(st.tuples(*[near] * 4), st.integers(1, 5 * 256).map(lambda v: v / 256), samples)
def test_a_polyline_of_one_segment_is_near_the_line(package, ends, width, samples):
    """Its corners are rounded to a 256th of a pixel: next to the exact rectangle, not always equal to it."""
    pictures = []
    for draw in ("line", "polyline"):
        fb = package.Framebuffer(WIDTH, HEIGHT, depth=8)
        arguments = ends if draw == "line" else ([ends[:2], ends[2:]],)
        getattr(fb, draw)(*arguments, 200, width=width, antialias=package.Supersample(16))
        pictures.append(fb.pixels.astype(int))
    assert np.abs(pictures[0] - pictures[1]).max() <= 200 / 6


@pytest.mark.parametrize("join", ["miter", "round", "bevel"])
@pytest.mark.parametrize("cap", ["butt", "square", "round"])
@given(
    points=st.lists(st.tuples(near, near), min_size=1, max_size=5),
    closed=st.booleans(),
    width=st.floats(0.5, 9),
    data=st.data(),
)
@examples(0.4)
def test_strokes_touch_a_pixel_once(package, join, cap, points, closed, width, data):
    dash = data.draw(st.one_of(st.none(), dashes))
    level = data.draw(st.integers(1, 15))
    options = {
        "closed": closed,
        "width": width,
        "join": join,
        "cap": cap,
        "dash": dash,
        "antialias": package.Supersample(3),
    }
    over, xor = package.Framebuffer(WIDTH, HEIGHT, 4), package.Framebuffer(WIDTH, HEIGHT, 4)
    over.polyline(points, level, **options)
    xor.polyline(points, level, **options, op="xor")
    assert over == xor
    xor.polyline(points, level, **options, op="xor")
    assert not xor.pixels.any()


@pytest.mark.parametrize("dash", [(1, 1), (2, 3), (1, 2, 3), (5,)])
def test_long_dashed_lines_cost_no_more_than_what_is_seen(package, dash):
    """This ends at once, or never."""
    for algorithm in ("bresenham", "dda"):
        fb = package.Framebuffer(WIDTH, HEIGHT)
        fb.line(-(2**63), 0, 2**63, 9, dash=dash, algorithm=algorithm)
        fb.line(-(2**63), 0, 2**63, 9, dash=dash, width=3)
        fb.polyline([(-(2**63), 0), (2**63, 9), (-(2**70), 5)], dash=dash, width=2.5, antialias=package.Supersample(4))
        assert fb.pixels.any()


@pytest.mark.parametrize("length", [2**42, 2.0**63, 2**63, 2**70, 1e308, 10**400])
def test_a_dash_may_be_endless(package, length):
    for style in ({}, {"width": 3}, {"width": 2.5, "cap": "round", "antialias": package.Supersample(2)}):
        for ends in ((0, 0, 12, 9), (-(2**40), 5, 2**40, 5)):
            dashed, solid = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
            dashed.line(*ends, dash=[length], **style)
            solid.polyline([ends[:2], ends[2:]], **style)
            assert dashed == solid


@pytest.mark.parametrize("name", ["points", "coords"])
@pytest.mark.parametrize(
    ("bad", "error"),
    [
        ([1, 2, 3], ValueError),
        ([(1, 2, 3)], ValueError),
        ([(1, float("nan"))], ValueError),
        ([("1", "2")], TypeError),
        ([1j, 2], TypeError),
        ("ab", TypeError),
        (5, ValueError),
        (None, (TypeError, ValueError)),
        ([(1, 2), (3,)], ValueError),
    ],
)
def test_what_is_no_list_of_points_is_refused(package, name, bad, error):
    fb = package.Framebuffer(4, 4)
    for fill in (False, True):
        with pytest.raises(error, match=rf"^{name} must "):
            fb.polyline(bad) if name == "points" else fb.poly(0, 0, bad, 1, fill)
        with pytest.raises(error, match=rf"^{name} must "):
            fb.polyline(bad, width=3) if name == "points" else fb.poly(1, 1, bad, 1, fill)
    assert not fb.pixels.any()


def test_styles_that_do_not_exist_are_refused(package):
    fb = package.Framebuffer(4, 4)
    points = [(0, 0), (3, 3), (0, 3)]
    for join in ("", "arc", None, []):
        with pytest.raises(ValueError, match=r"^join must be one of 'miter', 'round', 'bevel', not "):
            fb.polyline(points, join=join)
    for rule in ("", "odd", None, []):
        with pytest.raises(ValueError, match=r"^rule must be one of 'even-odd', 'nonzero', not "):
            fb.poly(0, 0, points, rule=rule)
    for algorithm in ("", "wu", None, []):
        with pytest.raises(ValueError, match=r"^algorithm must be one of "):
            fb.line(0, 0, 3, 3, algorithm=algorithm)
    for dash in ((), (0,), (1, 0), (-1, 2), (0.5,), (float("nan"), 1), (float("inf"), 1)):
        with pytest.raises(ValueError, match=r"^dash must "):
            fb.line(0, 0, 3, 3, dash=dash)
    for dash in (5, "12", (None,), ("1",)):
        with pytest.raises(TypeError, match=r"^dash must "):
            fb.line(0, 0, 3, 3, dash=dash)
    assert not fb.pixels.any()


def test_no_points_draw_nothing(package):
    fb = package.Framebuffer(4, 4)
    for nothing in ([], (), np.zeros((0, 2))):
        fb.polyline(nothing)
        fb.polyline(nothing, width=3)
        fb.poly(0, 0, nothing)
        fb.poly(1, 1, nothing, 1, True)
    assert not fb.pixels.any()
