"""Where outlines lie, which corners are round, and arrows: against other shapes that are the same by definition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw.testing import assert_pattern

SHAPES = {
    "rect": (5, 6, 20, 15),
    "round_rect": (5, 6, 20, 15, 6),
    "circle": (16, 15, 9),
    "ellipse": (16, 15, 11, 7),
}


def drawn(package, name, n, *arguments, **options):
    fb = package.Framebuffer(32, 30, depth=8, antialias=package.Supersample(n) if n else None)
    getattr(fb, name)(*SHAPES[name], 16, *arguments, **options)
    return fb.pixels.astype(int)


@pytest.mark.parametrize("name", SHAPES)
@given(st.sampled_from([2, 3, 3.5, 4, 5]))
def test_inside_and_outside_share_no_point_and_end_where_the_shape_ends(package, name, width):
    """With 16 points a pixel, levels are counts: what is inside and outside adds up to what is filled."""
    full = drawn(package, name, 4, True)
    inside, outside = (drawn(package, name, 4, width=width, align=side) for side in ("inside", "outside"))
    assert (inside <= full).all()
    assert (full + outside <= 16).all()
    around = drawn(package, name, 4, True, width=width, align="outside")
    assert (full + outside == around).all()
    assert (drawn(package, name, 4, True, width=width, align="inside") == full).all()


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("n", [None, 4])
def test_of_width_1_inside_is_the_outline_itself(package, name, n):
    assert (drawn(package, name, n, align="inside") == drawn(package, name, n)).all()
    assert (drawn(package, name, n, align="center", width=3) == drawn(package, name, n, width=3)).all()


@pytest.mark.parametrize("name", SHAPES)
def test_what_is_wider_than_the_shape_fills_it(package, name):
    for n in (None, 4):
        assert (drawn(package, name, n, width=99, align="inside") == drawn(package, name, n, True)).all()


def test_a_rectangle_outside_is_the_larger_one(package):
    fb, other = package.Framebuffer(32, 30), package.Framebuffer(32, 30)
    fb.rect(5, 6, 20, 15, align="outside")
    other.rect(4, 5, 22, 17)
    assert (fb.pixels == other.pixels).all()


@given(st.integers(0, 15), st.sampled_from([1, 2, 3.5]), st.booleans(), st.sampled_from([None, 4]))
def test_chosen_corners_are_round_and_the_others_sharp(package, corners, width, fill, n):
    style = {"width": width, "antialias": n and package.Supersample(n), "op": "add"}
    some, rounded, sharp = (package.Framebuffer(32, 30, 8) for _ in range(3))
    some.round_rect(3, 4, 25, 20, 7, 16, fill, corners=corners, **style)
    rounded.round_rect(3, 4, 25, 20, 7, 16, fill, **style)
    sharp.rect(3, 4, 25, 20, 16, fill, **style)
    y, x = np.mgrid[:30, :32]
    bit = np.where(y < 14, np.where(x >= 15, 1, 2), np.where(x >= 15, 8, 4))
    assert (some.pixels == np.where(bit & corners, rounded.pixels, sharp.pixels)).all()
    with some.clip(2, 2, 5, 9):
        some.round_rect(3, 4, 25, 20, 7, 0, True, corners=corners)
        some.fill(255)
    assert (some.pixels == 255).sum() == 5 * 9


# -- Arrows


def test_arrows_as_a_picture(package):
    fb = package.Framebuffer(20, 14)
    fb.arrow(0, 2, 8, 2, op="xor")
    fb.arrow(12, 0, 12, 13, heads="both", op="xor")
    fb.arrow(1, 12, 8, 5, heads="start", head=3)
    fb.arrow(17, 6, 17, 6)
    assert_pattern(
        fb,
        """
        ....#.......#.......
        ....###....###......
        #########..###......
        ....###...#####.....
        ....#.....#####.....
        ........#...####....
        .......#....######..
        ......#.....####....
        .....#......##......
        ..#.#.....#####.....
        ..##.......###......
        .####......###......
        .##.........#.......
        ............#.......
        """,
    )


@given(st.tuples(*[st.integers(0, 31 * 256)] * 4), st.integers(256, 1280), st.sampled_from(["end", "start", "both"]))
def test_a_wide_arrow_is_the_union_of_a_line_and_triangles(package, ends, width, heads):
    """So it has all of the triangles, and nothing but those and the line."""
    x1, y1, x2, y2 = (number / 256 for number in ends)
    width /= 256
    fb, line = (package.Framebuffer(32, 32, 8) for _ in range(2))
    fb.arrow(x1, y1, x2, y2, 100, heads=heads, width=width, head=8, antialias=package.Supersample(4), op="xor")
    line.line(x1, y1, x2, y2, 100, width=width, antialias=package.Supersample(4))
    long = np.hypot(x2 - x1, y2 - y1)
    u = np.array([x2 - x1, y2 - y1]) / long if long else np.array([1, 0])
    for tip, side, name in ((np.array([x1, y1]), -1, "start"), (np.array([x2, y2]), 1, "end")):
        if heads in (name, "both"):
            base = tip - 8 * side * u
            corners = [tip, base + 3.9 * np.array([-u[1], u[0]]), base - 3.9 * np.array([-u[1], u[0]])]
            inner = package.Framebuffer(32, 32, 8)
            mean = sum(corners) / 3
            inner.poly(0, 0, np.array([mean + 0.95 * (c - mean) for c in corners]), 100, True, edges="shared")
            assert fb.pixels[inner.pixels > 0].all()
            line.poly(0, 0, np.array([mean + 1.8 * (c - mean) for c in corners]), 100, True, op="max")
    assert not fb.pixels[line.pixels == 0].any()


@pytest.mark.parametrize(
    ("call", "arguments", "message"),
    [
        ("rect", {"x": 1, "y": 1, "w": 3, "h": 3, "align": "left"}, "align must be one of 'center'"),
        ("circle", {"x": 1, "y": 1, "r": -1, "align": "inside"}, "r must not be negative"),
        ("round_rect", {"x": 1, "y": 1, "w": 3, "h": 3, "r": 1, "corners": 16}, "corners must be from 0 to 15"),
        ("round_rect", {"x": 1, "y": 1, "w": -3, "h": 3, "r": 1, "corners": 1}, "w must not be negative"),
        ("arrow", {"x1": 1, "y1": 1, "x2": 3, "y2": 3, "head": -1}, "head must not be negative"),
        ("arrow", {"x1": 1, "y1": 1, "x2": 3, "y2": 3, "heads": "none"}, "heads must be one of"),
        ("arrow", {"x1": 1, "y1": 1, "x2": 3, "y2": 3, "cap": "round"}, "cap must be one of 'square', 'butt'"),
        ("arrow", {"x1": float("nan"), "y1": 1, "x2": 3, "y2": 3}, "x1 must be finite"),
    ],
)
def test_what_is_wrong_is_named(package, call, arguments, message):
    fb = package.Framebuffer(8, 8)
    with pytest.raises(ValueError, match=message):
        getattr(fb, call)(**arguments)
    assert not fb.pixels.any()
