"""Dashed lines and paths: pixels counted one by one, or coverage cut along the true line; and the DDA."""

from __future__ import annotations

from itertools import pairwise
from math import ceil, degrees

import definitions
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from searching import examples
from stroke_definitions import HEIGHT, ROUNDING, WIDTH, counted, dashed_stroke, stroke_bounds

from paneldraw.testing import assert_pattern

REACH = definitions.REACH
near = st.integers(-20, 33)
far = st.one_of(
    near,
    st.integers(-(2**31), 2**31),
    st.integers(-(2**70), 2**70),
    st.integers(-REACH, REACH),
    st.builds(lambda d, s: s * (REACH + d), st.integers(-2, 2), st.sampled_from([-1, 1])),
)
patterns = st.lists(st.integers(1, 6), min_size=1, max_size=5)
algorithms = st.sampled_from(["bresenham", "dda"])
in_256ths = st.integers(-3 * 256, 15 * 256).map(lambda v: v / 256)
samples = st.tuples(st.sampled_from([1, 2, 4]), st.sampled_from(["center", "corner"]))


@given(st.tuples(*[st.one_of(near, far)] * 4), patterns, algorithms)
@example((-(2**70), 3, 2**70, 3), [1, 1], "dda")
@example((3, 2**70, 3, -(2**70)), [2, 1, 1], "bresenham")
def test_the_pattern_begins_at_the_first_point(package, ends, dash, algorithm):
    """Near and far, in either direction, steep and shallow, whatever is clipped away."""
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(*ends, dash=dash, algorithm=algorithm)
    assert definitions.agree(fb.pixels, definitions.dashed(WIDTH, HEIGHT, *ends, dash), ends)
    batch = package.Framebuffer(WIDTH, HEIGHT)
    batch.lines([ends], dash=dash, algorithm=algorithm)
    assert (batch.pixels == fb.pixels).all()


@given(
    st.tuples(*[st.one_of(near, far)] * 4),
    st.tuples(*[st.integers(0, 8)] * 2, *[st.integers(1, 9)] * 2),
    algorithms,
    st.sampled_from([None, (3, 2)]),
)
def test_a_clip_takes_away_and_adds_nothing(package, ends, box, algorithm, dash):
    whole, clipped = (package.Framebuffer(WIDTH, HEIGHT) for _ in range(2))
    whole.line(*ends, algorithm=algorithm, dash=dash)
    x, y, w, h = box
    with clipped.clip(x, y, w, h):
        clipped.line(*ends, algorithm=algorithm, dash=dash)
    inside = np.zeros((HEIGHT, WIDTH), bool)
    inside[y : y + h, x : x + w] = True
    assert (clipped.pixels == np.where(inside, whole.pixels, 0)).all()


@given(
    st.lists(st.tuples(st.one_of(near, far), st.one_of(near, far)), min_size=2, max_size=5),
    patterns,
    st.booleans(),
    st.sampled_from(["over", "xor"]),
)
def test_the_pattern_goes_on_around_corners(package, points, dash, closed, op):
    ends = list(pairwise(points)) + ([(points[-1], points[0])] if closed and len(points) > 2 else [])
    wanted = np.zeros((HEIGHT, WIDTH), bool)
    phase = 0
    for a, b in ends:
        wanted |= definitions.dashed(WIDTH, HEIGHT, *a, *b, dash, phase)
        phase += max(abs(b[0] - a[0]), abs(b[1] - a[1]))
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.polyline(points, dash=dash, closed=closed, op=op)
    assert definitions.agree(fb.pixels, wanted, sum(points, ()))


@pytest.mark.parametrize("length", [2**29, 2**40, 2**63, 2**80, 2**2000, 1e300])
@pytest.mark.parametrize("ends", [(0, 4, 12, 4), (-(2**70), 4, 2**70, 4)])
def test_a_dash_may_be_of_any_length(package, length, ends):
    for style in ({}, {"width": 3}, {"antialias": package.Supersample(4), "cap": "round"}):
        for dash in ((length, 3), (3, length)):
            fb = package.Framebuffer(WIDTH, HEIGHT)
            fb.line(*ends, dash=dash, **style)
            fb.lines([ends], dash=dash, **style)
            fb.polyline([*pairwise(ends[::2] + ends[1::2])][::2], dash=dash, **style)
            assert fb.pixels[4].all() or length in dash[1:] or ends[0]


@pytest.mark.parametrize("join", ["miter", "round", "bevel"])
@given(
    st.lists(st.tuples(in_256ths, in_256ths), min_size=2, max_size=4),
    st.integers(64, 6 * 256).map(lambda v: v / 256),
    st.lists(st.integers(256, 6 * 256).map(lambda v: v / 256), min_size=1, max_size=3),
    st.sampled_from(["butt", "square", "round"]),
    st.booleans(),
    samples,
)
@example([(2, 4), (10, 4)], 3, [2, 2], "butt", False, (4, "center"))
@example([(2, 4), (10, 4)], 3, [2, 1.5], "round", False, (4, "center"))
@example([(2, 2), (10, 2), (10, 7)], 2, [3, 1], "square", True, (2, "corner"))
# A reference point between a dash and its cap, which are rounded.
@example(
    [(4.82421875, -0.98828125), (4.75390625, -1.015625), (0.125, 14.17578125)],
    2,
    [273 / 256],
    "round",
    False,
    (2, "center"),
)
def test_thick_dashes_are_the_stroke_cut_along_the_line(package, join, points, width, dash, cap, closed, samples):
    assume(all(a != b for a, b in pairwise(points)) and points[0] != points[-1])
    pieces, nearest_end = dashed_stroke(points, width, dash, join, cap, closed)
    assume(nearest_end > 1 / 64)

    def draw(fb, level, antialias):
        fb.polyline(points, level, width=width, dash=dash, join=join, cap=cap, closed=closed, antialias=antialias)

    counts = counted(package, draw, *samples)
    least, most = stroke_bounds(pieces, *samples, tolerance=1.5 * ROUNDING)
    assert (least <= counts).all()
    assert (counts <= most).all()


@pytest.mark.parametrize("distance", [2**19, 2**40, 2**70])
@examples(0.5)
@given(
    st.sampled_from([(1, 0), (0, -1), (3, 4), (-4, 3), (-5, -12), (8, -15), (-7, 24)]),
    st.tuples(*[st.integers(0, 8)] * 2),
    st.integers(1, 5),
    st.lists(st.integers(1, 5), min_size=2, max_size=2),
    st.sampled_from(["butt", "round"]),
)
def test_thick_dashes_from_far_away_keep_time(package, distance, direction, point, width, dash, cap):
    """Each step in a direction has a whole length, so that a whole number of periods lies before the picture."""
    (dx, dy), (x, y) = direction, point
    period = sum(dash)
    steps = distance // period * period
    seen = ceil(24 / (dx * dx + dy * dy) ** 0.5 / period) * period
    ends = (x - steps * dx, y - steps * dy, x + seen * dx, y + seen * dy)

    def draw(fb, level, antialias):
        fb.line(*ends, level, width=width, dash=dash, cap=cap, antialias=antialias)

    before = (x - seen * dx, y - seen * dy)
    pieces, _ = dashed_stroke([before, ends[2:]], width, dash, cap=cap)
    least, most = stroke_bounds(pieces, 4, "center", tolerance=2 * ROUNDING)
    counts = counted(package, draw, 4)
    assert (least <= counts).all()
    assert (counts <= most).all()


@given(
    st.lists(st.tuples(st.integers(-15, 90), st.integers(-10, 60)), min_size=2, max_size=6),
    st.lists(st.sampled_from([1, 1.5, 3.3, 7]), min_size=1, max_size=3),
    st.sampled_from([2.5, 9.7]),
    st.sampled_from(["butt", "round"]),
    st.tuples(st.integers(0, 40), st.integers(0, 9)),
)
@example([(0, 39), (20, 24), (83, 22), (25, -9), (80, 58)], [1], 9.7, "butt", (39, 5))
def test_dashes_of_a_path_that_is_moved_by_whole_pixels_move_with_it(package, points, dash, width, cap, by):
    """Where a dash ends is measured from the corner before it, not from (0, 0)."""
    alone = package.Framebuffer(64, 48)
    alone.polyline(points, dash=dash, width=width, cap=cap)
    moved = package.Framebuffer(104, 57)
    moved.polyline([(x + by[0], y + by[1]) for x, y in points], dash=dash, width=width, cap=cap)
    assert (moved.view(*by, 64, 48).pixels == alone.pixels).all()


@pytest.mark.parametrize("cap", ["butt", "square", "round"])
@pytest.mark.parametrize(
    "width", [1, 2.5, 300, *(pytest.param(width, marks=pytest.mark.thorough) for width in (2**17, 2**40))]
)
@pytest.mark.parametrize("reach", [2**17, 2**40, 2**70])
def test_dashes_out_of_sight_cost_nothing(package, cap, width, reach):
    """A dash a pixel, from end to end: this ends at once, or never."""
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(-reach, 3, reach, 5, width=width, dash=(1, 1), cap=cap, antialias=package.Supersample(2))
    fb.polyline([(-reach, 3), (reach, 5), (4, -reach), (2, reach)], width=width, dash=(1, 1), cap=cap)
    assert fb.pixels.any()


@pytest.mark.parametrize("across", [0, 2**16, 2**30, 2**31 - 8, 2**31 + 20])
@pytest.mark.parametrize("dash", [(5000, 5000), (1, 30000), (1, 1, 1, 9000)])
def test_nor_do_round_ones_that_reach_far(package, dash, across):
    """Each is in reach of the picture, and most add nothing to it."""
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(-(2**70), across, 2**70, across, width=2**32, dash=dash, cap="round")
    assert fb.pixels.all() == fb.pixels.any() == (across < 2**31)


def test_dashes_as_a_picture(package):
    fb = package.Framebuffer(20, 9)
    fb.line(0, 0, 19, 0, dash=(4, 2))
    fb.line(19, 2, 0, 2, dash=(4, 2, 1, 2))
    fb.polyline([(1, 4), (10, 4), (10, 8)], dash=(3, 2))
    fb.line(13, 7, 19, 4, width=2, dash=(2, 1))
    assert_pattern(
        fb,
        """
        ####..####..####..##
        ....................
        ##..#..####..#..####
        ...................#
        .###..###........#.#
        ..........#.....##.#
        ..........#..##.##..
        ..........#.####....
        .............#......
        """,
    )


def test_a_closed_path_has_no_notch_where_it_begins(package):
    """Its last dash goes on into the first one, if there is no gap between them."""
    fb = package.Framebuffer(28, 9)
    fb.rect(2, 2, 9, 5, width=3, dash=(5, 3))
    fb.rect(16, 2, 9, 5, width=3, dash=(5, 2))
    assert_pattern(
        fb,
        """
        ............................
        ..#####........######..###..
        ..#####..###...######..###..
        ..#####..###...######..###..
        .........###...###.....###..
        .#####...###.....#####.###..
        .#####...###.....#####......
        .#####...###.....#####......
        ............................
        """,
    )


@pytest.mark.parametrize("cap", ["butt", "round"])
@pytest.mark.parametrize(("r", "width", "length"), [(20, 30, 13), (20, 38, 7), (12, 20, 9.5), (25, 40, 30), (8, 14, 5)])
def test_dashes_of_a_circle_end_along_its_radii(package, r, width, length, cap):
    """Each is the arc of its angles."""
    dashed, whole = (package.Framebuffer(96, 96, depth=8) for _ in range(2))
    style = {"width": width, "cap": cap, "antialias": package.Supersample(8)}
    dashed.arc(47, 48, r, 17, 360, 64, dash=(length, 1000), **style)
    whole.arc(47, 48, r, 17, 17 + degrees(length / r), 64, **style)
    differences = np.abs(dashed.pixels.astype(int) - whole.pixels)
    assert differences.max() <= 3
    assert differences.sum() <= whole.pixels.astype(int).sum() / 1000


# -- The digital differential analyzer


@given(st.tuples(*[st.one_of(near, far)] * 4))
@example((-REACH, -REACH, REACH, REACH - 1))
@example((0, 0, REACH, REACH // 2 + 1))
def test_the_dda_rounds_the_exact_line(package, ends):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(*ends, algorithm="dda")
    assert definitions.agree(fb.pixels, definitions.bresenham(WIDTH, HEIGHT, *ends), ends)


@examples(0.2)
@given(st.integers(-REACH, -1), st.integers(0, 30), st.integers(2**16, REACH), st.integers(-40, 70), st.booleans())
def test_the_dda_does_so_over_the_widest_picture(package, x1, y1, x2, y2, turned):
    """The slope's rounding adds up over 65536 steps, and must not decide."""
    size, ends = (65536, 40), (x1, y1, x2, y2)
    if turned:
        size, ends = size[::-1], (y1, x1, y2, x2)
    dda, bresenham = (package.Framebuffer(*size) for _ in range(2))
    dda.line(*ends, algorithm="dda")
    bresenham.line(*ends)
    assert (dda.pixels == bresenham.pixels).all()


@given(st.tuples(*[near] * 4), st.integers(0, 255), st.sampled_from(["over", "xor", "add", "max", "clear"]))
def test_the_dda_paints_each_pixel_once(package, ends, level, op):
    before = np.arange(HEIGHT * WIDTH, dtype=np.uint8).reshape(HEIGHT, WIDTH)
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=8)
    fb.pixels[...] = before
    fb.line(*ends, level, algorithm="dda", op=op)
    wanted = definitions.painted(before, definitions.bresenham(WIDTH, HEIGHT, *ends), 1, level, op, 8)
    assert (fb.pixels == wanted).all()
