"""Bézier curves and smooth curves, against points of the true ones."""

from __future__ import annotations

from itertools import pairwise

import curve_definitions
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from searching import examples
from stroke_definitions import HEIGHT, WIDTH, counted

from paneldraw.testing import assert_pattern

in_256ths = st.integers(-4 * 256, 16 * 256).map(lambda v: v / 256)
places = st.one_of(st.tuples(*[st.integers(-3, 15)] * 2), st.tuples(in_256ths, in_256ths))
controls = st.sampled_from([1, 3, 4, 7]).flatmap(lambda n: st.lists(places, min_size=n, max_size=n))
through = st.lists(places, min_size=3, max_size=6)
widths = st.integers(128, 6 * 256).map(lambda v: v / 256)
samples = st.tuples(st.sampled_from([1, 2, 4]), st.sampled_from(["center", "corner"]))
kinds = pytest.mark.parametrize("kind", ["bezier", "curve"])


def of(kind, points, closed=False):
    """Points along the true curve."""
    return curve_definitions.chain(points) if kind == "bezier" else curve_definitions.catmull_rom(points, closed)


def assert_within(curve, width, package, draw, samples):
    least, most = curve_definitions.near(curve, width / 2, *samples)
    counts = counted(package, draw, *samples)
    assert (least <= counts).all()
    assert (counts <= most).all()


@examples(0.5)
@given(controls, widths, samples)
@example([(2, 2), (30, 7), (-15, 7), (10, 2)], 3, (4, "center"))  # a loop
@example([(2, 2), (10, 8), (2, 8), (10, 2)], 2, (4, "corner"))  # a cusp
@example([(0, 0), (0, 8), (12, 8)], 1, (4, "center"))
def test_a_bezier_stroke_is_what_is_within_half_a_width(package, points, width, samples):
    def draw(fb, level, antialias):
        fb.bezier(points, level, width=width, cap="round", join="round", antialias=antialias)

    assert_within(curve_definitions.chain(points), width, package, draw, samples)


@examples(0.5)
@given(through, st.booleans(), widths, samples)
@example([(2, 2), (6, 7), (10, 2)], True, 2, (4, "center"))
def test_a_smooth_stroke_is_what_is_within_half_a_width(package, points, closed, width, samples):
    assume(all(a != b for a, b in zip(points, points[1:] + points[:closed], strict=False)))

    def draw(fb, level, antialias):
        fb.curve(points, level, closed=closed, width=width, cap="round", join="round", antialias=antialias)

    assert_within(curve_definitions.catmull_rom(points, closed), width, package, draw, samples)


# -- Thin ones


@kinds
@given(through.filter(lambda points: len(points) >= 4))
def test_a_thin_curve_is_connected_and_near_the_true_one(package, kind, points):
    points = points[:4]
    assume(all(a != b for a, b in pairwise(points)))
    fb = package.Framebuffer(64, 64)
    points = [(x + 24, y + 24) for x, y in points]
    getattr(fb, kind)(points)
    curve = of(kind, points)
    lit = np.argwhere(fb.pixels)[:, ::-1]
    away = np.abs(curve[None, :, :] - lit[:, None, :]).max(axis=2).min(axis=1)
    assert (away <= 1).all()
    covered = np.abs(curve[:, None, :] - lit[None, :, :]).max(axis=2).min(axis=1)
    # A corner that is left out is the neighbor of two pixels that are lit.
    assert (covered <= 1.5).all()
    for x, y in (points[0], points[-1]):
        assert fb.pixel(int(np.floor(x + 0.5)), int(np.floor(y + 0.5))) == 1
    assert _is_connected(lit)


def _is_connected(lit):
    rest = {tuple(place) for place in lit.tolist()}
    reached = [rest.pop()]
    while reached:
        x, y = reached.pop()
        around = {(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)} & rest
        rest -= around
        reached += around
    return not rest


@given(st.lists(st.integers(0, 8 * 64), min_size=4, max_size=4))
def test_a_flat_thin_curve_has_in_each_column_the_pixel_nearest_to_it(package, heights):
    """x grows evenly, and the curve rises by less than it goes on."""
    points = [(16 * i, height / 64) for i, height in enumerate(heights)]
    fb = package.Framebuffer(49, 10)
    fb.bezier(points)
    true = curve_definitions.bezier(points, steps=48)[:, 1]
    assert (fb.pixels.sum(axis=0) == 1).all()
    assert (np.abs(np.argmax(fb.pixels, axis=0) - true) <= 0.5 + 1 / 256).all()


def test_a_straight_one_is_bresenhams_line(package):
    for end in ((30, 11), (11, 30), (30, 30), (30, 0), (0, 30)):
        curve, line = package.Framebuffer(31, 31), package.Framebuffer(31, 31)
        curve.bezier([(0, 0), (end[0] / 3, end[1] / 3), (2 * end[0] / 3, 2 * end[1] / 3), end])
        line.line(0, 0, *end)
        assert (curve.pixels == line.pixels).all()


@kinds
def test_a_thin_one_counts_the_pixels_of_its_dashes(package, kind):
    points = [(1, 18), (12, -14), (20, 32), (30, 2)]
    whole, dashed, rest = (package.Framebuffer(32, 20) for _ in range(3))
    getattr(whole, kind)(points)
    getattr(dashed, kind)(points, dash=(3, 2))
    getattr(rest, kind)(points, op="xor")
    getattr(rest, kind)(points, dash=(3, 2), op="xor")
    number = int(whole.pixels.sum())
    assert dashed.pixels.sum() == sum(k % 5 < 3 for k in range(number))
    assert (dashed.pixels + rest.pixels == whole.pixels).all()


# -- Each pixel once; windows; far away


@kinds
@given(through.filter(lambda points: len(points) >= 4), st.one_of(st.just(1), widths), st.sampled_from([None, 4]))
@example([(2, 2), (30, 7), (-15, 7), (10, 2)], 1, None)
def test_a_pixel_is_painted_once(package, kind, points, width, n):
    style = {"width": width, "closed": True, "antialias": n and package.Supersample(n)}
    over, xor, add = (package.Framebuffer(WIDTH, HEIGHT, depth=8) for _ in range(3))
    for fb, op in ((over, "over"), (xor, "xor"), (add, "add")):
        getattr(fb, kind)(points[:4], 100, **style, op=op)
    assert (xor.pixels == over.pixels).all()
    assert (add.pixels == over.pixels).all()


@kinds
@given(
    through.filter(lambda points: len(points) >= 4),
    st.sampled_from([1, 2.5]),
    st.sampled_from([None, "supersample", "cone"]),
    st.sampled_from([None, (3, 2)]),
    st.sampled_from([1, 2, 4, 8]),
)
def test_a_window_shows_a_part_of_the_same_pixels(package, kind, points, width, antialias, dash, depth):
    ways = {None: None, "supersample": package.Supersample(3), "cone": package.ConeFilter()}
    style = {"width": width, "dash": dash, "antialias": ways[antialias]}
    whole, clipped, viewed = (package.Framebuffer(40, 40, depth) for _ in range(3))
    moved = [(x + 14, y + 14) for x, y in points[:4]]
    getattr(whole, kind)(moved, **style)
    with clipped.clip(16, 17, 9, 7):
        getattr(clipped, kind)(moved, **style)
    getattr(viewed.view(16, 17, 9, 7), kind)([(x - 16, y - 17) for x, y in moved], **style)
    expected = np.zeros_like(whole.pixels)
    expected[17:24, 16:25] = whole.pixels[17:24, 16:25]
    assert (clipped.pixels == expected).all()
    assert (viewed.pixels == expected).all()


@pytest.mark.parametrize("reach", [2**18, 2**40, 2**70, 10**30])
@pytest.mark.parametrize("width", [1, 5])
def test_curves_from_far_away(package, reach, width):
    """A parabola about the picture's middle: it is the straight line there, but for a hair."""
    fb, line = package.Framebuffer(21, 21), package.Framebuffer(21, 21)
    fb.bezier([(10 - reach, 10 - reach), (10, 10), (10 + reach, 10 + reach)], width=width)
    line.line(-100, -100, 100, 100, width=width)
    assert (fb.pixels == line.pixels).all()
    fb.clear()
    fb.curve([(10 - reach, 10 - reach), (10, 10), (10 + reach, 10 + reach)], width=width)
    assert (fb.pixels == line.pixels).all()


@given(st.lists(st.tuples(*[st.integers(-(2**80), 2**80)] * 2), min_size=4, max_size=4), st.booleans())
def test_any_numbers_draw(package, points, closed):
    fb = package.Framebuffer(9, 9)
    for width in (1, 3):
        fb.bezier(points, closed=closed, width=width, antialias=package.Supersample(2), dash=(9, 3))
        fb.curve(points, closed=closed, width=width)


# -- Arguments


def test_few_points(package):
    fb = package.Framebuffer(9, 3)
    fb.bezier([])
    fb.curve([])
    assert not fb.pixels.any()
    fb.bezier([(1, 1)])
    fb.curve([(3, 1), (3, 1)])
    fb.curve([(5, 0), (7, 2)], closed=True)
    assert_pattern(
        fb,
        """
        .....#...
        .#.#..#..
        .......#.
        """,
    )


@pytest.mark.parametrize("count", [2, 5, 6, 8])
def test_a_wrong_number_of_points_is_named(package, count):
    fb = package.Framebuffer(9, 9)
    with pytest.raises(ValueError, match=f"points must be 3, of a quadratic curve, .* not {count}"):
        fb.bezier([(k, k) for k in range(count)])
    assert not fb.pixels.any()


# -- Filled


@given(
    st.lists(st.tuples(st.integers(-5, 28), st.integers(-5, 24)), min_size=3, max_size=6, unique=True),
    st.sampled_from(["bezier", "curve"]),
    st.sampled_from([None, 4]),
    st.sampled_from([1, 3]),
)
def test_a_filled_curve_is_what_it_encloses_and_aliased_its_outline_too(package, points, call, n, width):
    """Against a polygon along the curve; of 16 points in a pixel two may lie on it, or where both cross it."""
    fb, outline, area = (package.Framebuffer(24, 20, 8) for _ in range(3))
    smooth = n and package.Supersample(n)
    if call == "bezier":
        points = points[:3] if len(points) < 4 else points[:4]
    assume(np.linalg.matrix_rank(np.subtract(points, points[0])) == 2)
    getattr(fb, call)(points, 16, fill=True, width=width, antialias=smooth, op="xor")
    area.poly(0, 0, of(call, points, True)[::20], 16, fill=True, edges="shared", antialias=smooth)
    if n is None:
        getattr(outline, call)(points, 16, closed=True)
        assert (fb.pixels[outline.pixels > 0] == 16).all()
        fb.pixels[outline.pixels > 0] = area.pixels[outline.pixels > 0]
    assert (abs(fb.pixels.astype(int) - area.pixels) <= (2 if n else 0)).all()
