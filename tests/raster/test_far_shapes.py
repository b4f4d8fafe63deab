"""What reaches further than +-131072 pixels is drawn as what just does not: within a pixel of it."""

from __future__ import annotations

from itertools import pairwise, product
from math import degrees

import definitions
import numpy as np
import pytest
import round_definitions
from definitions import REACH
from hypothesis import given
from hypothesis import strategies as st
from searching import at_both_speeds, examples

WIDTH, HEIGHT = 60, 40
IN, OUT = REACH - 40, REACH + 40  # radii that differ by 0.004 pixels in how far their circles bend in this picture

#: Calls with a radius or length r, large or larger: what is seen of them hardly depends on it.
SHAPES = {
    "circle": lambda r: ("circle", (r + 30, 20, r)),
    "circle, above": lambda r: ("circle", (30, 20 - r, r)),
    "ellipse": lambda r: ("ellipse", (r + 30, 20, r, r // 2)),
    "upper half": lambda r: ("ellipse", (r + 30, 20, r, r // 2), {"quadrants": 3}),
    "two quadrants apart": lambda r: ("ellipse", (r + 30, 20, r, r // 2), {"quadrants": 6}),
    "one quadrant": lambda r: ("ellipse", (30, 20 - r, r // 2, r), {"quadrants": 8}),
    "arc": lambda r: ("arc", (r + 30, 20, r, 100, 200)),
    "arc's start": lambda r: ("arc", (r + 30, 20, r, 180 - degrees(10 / r), 300)),
    "arc's end": lambda r: ("arc", (30, r + 20, r, 170, 270 + degrees(10 / r))),
    "sector's arc": lambda r: ("sector", (r + 30, 20, r, 170, 190)),
    "sector's center": lambda r: ("sector", (30, 20, r, 20, 60)),
    "sector's center, narrow": lambda r: ("sector", (30, 20, r, 200, 215)),
    "sector's center, reflex": lambda r: ("sector", (30, 20, r, 60, 20)),
    "sector's corner": lambda r: ("sector", (r + 30, 20, r, 180, 200)),
    "rectangle": lambda r: ("rect", (30, 20, r, r)),
    "round rectangle": lambda r: ("round_rect", (30 - r // 2, 20, 2 * r, r, r // 3)),
    "round rectangle's corner": lambda r: ("round_rect", (20, 10, r, 2 * r, 30)),
    "line": lambda r: ("line", (10, 30, r, r // 2)),
    "path": lambda r: ("polyline", ([(10, 5), (r, 20), (10, 35), (50, 38)],)),
    "polygon": lambda r: ("poly", (0, 0, [(10, 5), (r, 20), (10, 35)])),
    "triangle": lambda r: ("triangle", (10, 5, r, 20, 10, 35)),
}
FILLED = [name for name in SHAPES if SHAPES[name](9)[0] not in ("arc", "line", "polyline")]
DASHED = [name for name in SHAPES if SHAPES[name](9)[0] not in ("ellipse", "sector", "round_rect")]
#: One of each call.
FIRST = list({SHAPES[name](9)[0]: name for name in reversed(SHAPES)}.values())


def drawn(package, name, r, depth=8, **options):
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=depth)
    call, arguments, *more = SHAPES[name](r)
    getattr(fb, call)(*arguments, op="xor", **options, **dict(*more))
    return fb.pixels.copy()


def ways(package):
    """Thin, wide and anti-aliased: options by what a pixel is at most."""
    return [
        {},
        {"width": 5},
        {"width": 24, "antialias": package.Supersample(4)},
        {"antialias": package.Supersample(2)},
        {"width": 3, "antialias": package.ConeFilter()},
    ]


def assert_alike(package, name, **options):
    within, beyond = (drawn(package, name, r, **options) for r in (IN, OUT))
    assert definitions.agree(beyond, within, (OUT,))
    assert definitions.agree(255 - beyond, 255 - within, (OUT,))
    assert within.any()


@pytest.mark.parametrize(("package", "name"), at_both_speeds(SHAPES, FIRST), indirect=["package"])
def test_outlines(package, name):
    for options in ways(package):
        assert_alike(package, name, **options)


@pytest.mark.parametrize(
    ("package", "name"), at_both_speeds(FILLED, [name for name in FIRST if name in FILLED]), indirect=["package"]
)
def test_fillings(package, name):
    for options in ways(package):
        assert_alike(package, name, fill=True, **options)


@pytest.mark.parametrize("cap", ["square", "round"])
@pytest.mark.parametrize("name", ["arc's start", "arc's end"])
def test_caps(package, name, cap):
    assert_alike(package, name, width=9, cap=cap)


@pytest.mark.parametrize("width", [1, 5])
@pytest.mark.parametrize("name", DASHED)
def test_dashes(package, name, width):
    """They are in step where the way to them is as long: far around they may be anywhere, but are as long as others."""
    whole, dashed = (drawn(package, name, OUT, 1, width=width, **more) for more in ({}, {"dash": (8, 8)}))
    assert not (dashed & ~whole).any()
    assert 0.2 * whole.sum() < dashed.sum() < 0.8 * whole.sum()


@pytest.mark.parametrize("op", ["xor", "add"])
@pytest.mark.parametrize("r", [2**20, 2**70])
def test_quadrants_meet_without_a_seam(package, r, op):
    """Both halves of an axis belong to two of them, and are painted once."""
    for options in ways(package):
        for fill in (False, True):
            whole, parts = (package.Framebuffer(WIDTH, HEIGHT, depth=8) for _ in range(2))
            whole.ellipse(30, 20 - r, r, r, 100, fill, 0b1111, op=op, **options)
            parts.ellipse(30, 20 - r, r, r, 100, fill, 0b1100, op=op, **options)
            assert (parts.pixels == whole.pixels).all()
            assert whole.pixels.max() == 100


@examples(2)
@given(st.data(), st.integers(1, 60), st.booleans(), st.sampled_from([1, 2, 4]))
def test_wide_rings_of_flat_ellipses(package, data, width, fill, n):
    """Across a slope they are thinner than their width, as near ones are."""
    xr = data.draw(st.sampled_from([2**18, 2**21, 2**40]))
    yr = data.draw(st.one_of(st.integers(0, 60), st.integers(REACH, xr)))
    share = data.draw(st.floats(-1, 1))
    x, y = round(xr * share), round(yr * (1 - share**2) ** 0.5)
    fb = package.Framebuffer(20, 12, depth=8)
    fb.ellipse(8 - x, 5 - y, xr, yr, n * n, fill, width=width, antialias=package.Supersample(n))
    box = (8 - x, 5 - y, 8 - x, 5 - y)
    least, most = round_definitions.band(20, 12, box, (xr, yr), width, fill=fill, n=n, off=1)
    assert (least <= fb.pixels).all()
    assert (fb.pixels <= most).all()


@pytest.mark.parametrize("r", [30000, 100000, 2**18, 2**70])
@pytest.mark.parametrize("width", [1, 3])
def test_dashes_out_of_sight_cost_nothing(package, r, width):
    """A million dashes: this ends at once, or not for minutes."""
    for cap in ("butt", "round"):
        fb = package.Framebuffer(128, 64)
        fb.arc(r + 7, 5, r, 1, 359, width=width, dash=(1, 1), cap=cap)
        assert fb.pixels.any()
        fb.clear()
        fb.arc(3 * r, 5, r, 0, 360, width=width, dash=(1, 1), cap=cap)
        assert not fb.pixels.any()


STYLES = list(product([1, 3], [(3, 2), (1, 1, 9, 4), (700, 60)]))


@pytest.mark.parametrize(("package", "style"), at_both_speeds(STYLES, STYLES[1:2]), indirect=["package"])
def test_dashes_of_an_arc_are_those_of_a_larger_picture(package, style):
    """What is skipped as out of sight is no part of what is seen."""
    width, dash = style
    for antialias in (None, package.Supersample(4)):
        small, large = package.Framebuffer(30, 20, depth=8), package.Framebuffer(700, 400, depth=8)
        for fb in (small, large):
            fb.arc(-90, 130, 150, 17, 333, width=width, dash=dash, antialias=antialias)
            fb.circle(300, 10, 290, width=width, dash=dash, antialias=antialias)
        assert small.pixels.any()
        assert (small.pixels == large.pixels[:20, :30]).all()


@given(st.lists(st.tuples(st.integers(-300, 300), st.integers(-300, 300)), min_size=2, max_size=8), st.data())
def test_dashes_of_a_path_are_those_of_a_larger_picture(package, points, data):
    """Joins reach from out of sight into view, and so do caps."""
    style = {
        "width": data.draw(st.sampled_from([2, 5, 80])),
        "join": data.draw(st.sampled_from(["miter", "round", "bevel"])),
        "cap": data.draw(st.sampled_from(["butt", "square", "round"])),
        "closed": data.draw(st.booleans()),
        "dash": data.draw(st.lists(st.integers(1, 200), min_size=1, max_size=4)),
    }
    small, large = package.Framebuffer(20, 10), package.Framebuffer(300, 300)
    for fb in (small, large):
        fb.polyline(points, **style)
    assert (small.pixels == large.pixels[:10, :20]).all()


def test_the_textbook_square_of_what_is_exact(package):
    """A path from corner to corner of it, and one that leaves it and comes back."""
    corners = [(-REACH, 5), (REACH, 5), (REACH + 1, 9), (-REACH - 1, 9)]
    fb = package.Framebuffer(WIDTH, HEIGHT)
    for a, b in pairwise(corners):
        fb.line(*a, *b)
    assert np.flatnonzero(fb.pixels.all(axis=1)).tolist() == [5, 9]
