"""Where outlines lie, which corners are round, and arrows: against other shapes that are the same by definition."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples

from paneldraw.testing import assert_pattern

SHAPES = {
    "rect": (5, 6, 20, 15),
    "round_rect": (5, 6, 20, 15, 6),
    "circle": (16, 15, 9),
    "ellipse": (16, 15, 11, 7),
}
POLYGONS = {"triangle": (4, 24, 15, 3, 28, 20), "poly": (1, 1, [4, 22, 9, 4, 15, 14, 27, 3, 20, 24])}


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


@pytest.mark.parametrize("name", POLYGONS)
@pytest.mark.parametrize("n", [None, 4])
@given(st.sampled_from([1, 2, 3.5]), st.sampled_from(["miter", "round", "bevel"]), st.sampled_from([None, (4, 2)]))
def test_polygons_have_the_half_of_a_wider_outline_that_is_inside_or_outside(package, name, n, width, join, dash):
    """Levels are counts of 16 points, or all; a count is off by one at most where two edges are in a pixel."""
    fbs = [package.Framebuffer(32, 30, 8, antialias=n and package.Supersample(n)) for _ in range(6)]
    full, band, inside, outside, within, around = fbs
    shape, style = POLYGONS[name], {"join": join, "dash": dash}
    for fb, options in (
        (full, {"fill": True}),
        (band, {"width": 2 * width, **style}),
        (inside, {"width": width, "align": "inside", "op": "xor", **style}),
        (outside, {"width": width, "align": "outside", "op": "add", **style}),
        (within, {"width": width, "align": "inside", "fill": True, **style}),
        (around, {"width": width, "align": "outside", "fill": True, **style}),
    ):
        getattr(fb, name)(*shape, 16, **options)
    full, band, inside, outside, within, around = (fb.pixels.astype(int) for fb in fbs)
    assert (inside <= full).all()
    assert (full + outside == around).all()
    assert (within == full).all()
    assert (inside == np.minimum(full, band)).all()
    assert (around == np.maximum(full, band)).all()
    if not dash and n:
        whole = (full == 0) | (full == 16) | (band == 16)
        assert (inside + outside == band)[whole].all()


@pytest.mark.parametrize("name", POLYGONS)
def test_an_aligned_polygon_with_an_ink(package, name):
    plain, painted = package.Framebuffer(32, 30), package.Framebuffer(32, 30)
    with plain.clip(3, 3, 20, 20), painted.clip(3, 3, 20, 20):
        getattr(plain, name)(*POLYGONS[name], width=4, align="inside")
        getattr(painted, name)(*POLYGONS[name], package.Pattern.checker, width=4, align="inside")
    y, x = np.ogrid[:30, :32]
    assert plain.pixels.any()
    assert (painted.pixels == np.where((x + y) % 2, 0, plain.pixels)).all()


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


def signed(corners, x, y):
    """How far points lie outside of a triangle, along the normal of its nearest side's line; inside it is negative."""
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True))
    out = np.full(np.broadcast_shapes(x.shape, y.shape), -np.inf)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        along = (b - a) * np.sign(area) / max(np.hypot(*(b - a)), 1e-9)
        out = np.maximum(out, (x - a[0]) * along[1] - (y - a[1]) * along[0])
    return out


def away(path, x, y):
    """How far points are from a path."""
    near = np.full(np.broadcast_shapes(x.shape, y.shape), np.inf)
    for a, b in pairwise([*path, path[-1]]):
        t = ((x - a[0]) * (b - a)[0] + (y - a[1]) * (b - a)[1]) / max((b - a) @ (b - a), 1e-9)
        t = np.clip(t, 0, 1)
        near = np.minimum(near, np.hypot(x - a[0] - t * (b - a)[0], y - a[1] - t * (b - a)[1]))
    return near


def base(path, length):
    """The middle of the base of the head at the end of a path, and the path to there, by small steps back."""
    tip = path[-1]
    fine = np.concatenate([a + np.linspace(0, 1, 4000, endpoint=False)[:, None] * (b - a) for a, b in pairwise(path)])
    beyond = np.flatnonzero(np.hypot(*(fine - tip).T) >= length)
    if not beyond.size:
        along = tip - path[0]
        return tip - length * (along / np.hypot(*along) if along.any() else np.array([1, 0])), None
    return fine[beyond[-1]], fine[: beyond[-1] + 1 : 20]


corners = st.tuples(st.integers(0, 39 * 256), st.integers(0, 39 * 256)).map(lambda p: np.array(p) / 256)


@examples(3)
@given(st.lists(corners, min_size=2, max_size=4), st.sampled_from([1.5, 2, 3]), st.integers(8, 12), st.booleans())
def test_an_arrow_is_its_head_and_the_stroke_up_to_there(package, path, width, length, is_line):
    """Each pixel but those within a 32nd of a pixel of an edge: a head's tip, direction, size, and nothing besides."""
    fb = package.Framebuffer(40, 40)
    if is_line:
        path = path[:2]
        fb.arrow(*path[0], *path[1], width=width, head=length, cap="round", op="xor")
    else:
        fb.polyline(path, heads="end", width=width, head=length, cap="round", join="round", op="xor")
    y, x = np.ogrid[:40, :40]
    middle, rest = base(path, length)
    tip = path[-1]
    half = (tip - middle)[::-1] * (-0.5, 0.5)
    out = signed(np.array([tip, middle + half, middle - half]), x, y)
    if rest is not None:
        out = np.minimum(out, away(rest, x, y) - width / 2)
    assert fb.pixels[out < -1 / 32].all()
    assert not fb.pixels[out > 1 / 32].any()


@given(st.sampled_from(["start", "end", "both"]), st.sampled_from(["polyline", "bezier", "curve"]), st.booleans())
def test_heads_at_either_end_are_those_of_the_path_reversed(package, heads, call, thin):
    points = [(4, 30), (9, 6), (26, 9), (34, 33)]
    style = {"width": 1 if thin else 3, "op": "xor"}
    fb, reverse, plain = (package.Framebuffer(40, 40) for _ in range(3))
    getattr(fb, call)(points, heads=heads, **style)
    getattr(reverse, call)(points[::-1], heads={"start": "end", "end": "start"}.get(heads, heads), **style)
    getattr(plain, call)(points, **style)
    differing = np.argwhere(fb.pixels != reverse.pixels)
    assert len(differing) <= (0 if call == "polyline" else 2)
    for place, name in ((points[0], "start"), (points[-1], "end")):
        y, x = np.ogrid[:40, :40]
        around = np.hypot(x - place[0], y - place[1]) < 11
        assert (fb.pixels != plain.pixels)[around].any() == (heads in (name, "both"))
        assert fb.pixels[place[1], place[0]] or not thin


@pytest.mark.parametrize("call", ["polyline", "bezier", "curve"])
@pytest.mark.parametrize("width", [1, 2])
def test_heads_of_paths_that_come_from_afar(package, call, width):
    near, far = (package.Framebuffer(40, 30) for _ in range(2))
    for fb, begin in ((near, -600), (far, -3 * 2**40)):
        points = [(begin, 15), (begin / 3, 15), (0, 15), (30, 15)]
        getattr(fb, call)(points, heads="both", width=width, head=9)
    assert (near.pixels == far.pixels).all()
    assert near.pixels.sum(axis=0)[:20].max() == width


@pytest.mark.parametrize(
    ("call", "arguments", "message"),
    [
        ("rect", {"x": 1, "y": 1, "w": 3, "h": 3, "align": "left"}, "align must be one of 'center'"),
        ("triangle", {"x1": 1, "y1": 1, "x2": 3, "y2": 9, "x3": 5, "y3": 1, "align": "left"}, "align must be one of"),
        ("poly", {"x": 1, "y": 1, "coords": [0, 0, 3, 9, 5, 1], "align": "inside", "width": 0}, "width must be"),
        ("circle", {"x": 1, "y": 1, "r": -1, "align": "inside"}, "r must not be negative"),
        ("round_rect", {"x": 1, "y": 1, "w": 3, "h": 3, "r": 1, "corners": 16}, "corners must be from 0 to 15"),
        ("round_rect", {"x": 1, "y": 1, "w": -3, "h": 3, "r": 1, "corners": 1}, "w must not be negative"),
        ("arrow", {"x1": 1, "y1": 1, "x2": 3, "y2": 3, "head": -1}, "head must not be negative"),
        ("arrow", {"x1": 1, "y1": 1, "x2": 3, "y2": 3, "heads": "none"}, "heads must be one of"),
        ("arrow", {"x1": 1, "y1": 1, "x2": 3, "y2": 3, "cap": "flat"}, "cap must be one of 'butt', 'square', 'round'"),
        ("polyline", {"points": [1, 1, 3, 3], "heads": "none"}, "heads must be one of"),
        ("curve", {"points": [1, 1, 3, 3, 5, 1], "heads": "end", "closed": True}, "heads must be None of a path that"),
        ("bezier", {"points": [1, 1, 3, 3], "heads": "end"}, "points must be 3, of a quadratic"),
        ("arrow", {"x1": float("nan"), "y1": 1, "x2": 3, "y2": 3}, "x1 must be finite"),
    ],
)
def test_what_is_wrong_is_named(package, call, arguments, message):
    fb = package.Framebuffer(8, 8)
    with pytest.raises(ValueError, match=message):
        getattr(fb, call)(**arguments)
    assert not fb.pixels.any()
