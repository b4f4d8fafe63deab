"""Patterns and gradients in the place of a level, by definition: each pixel's paint as far as the shape covers it."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import hypot

import definitions
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples

from paneldraw.testing import assert_pattern

WIDTH, HEIGHT = 21, 14
CALLS = {
    "fill": {},
    "pixel": {"x": 5, "y": 6},
    "hline": {"x": -3, "y": 6, "w": 12},
    "vline": {"x": 6, "y": 2, "h": 99},
    "line": {"x1": 2, "y1": 3, "x2": 25, "y2": 9.5},
    "lines": {"segments": [(0, 0, 20, 13), (0, 13, 20, 0)], "width": 2},
    "points": {"xy": [(1, 1), (20, 13), (4, 40)]},
    "arrow": {"x1": 2, "y1": 3, "x2": 18, "y2": 9, "heads": "both"},
    "polyline": {"points": [(1, 1), (8, 11), (18, 2)], "width": 3, "join": "round", "closed": True},
    "bezier": {"points": [(1, 1), (8, 15), (14, -4), (20, 12)], "dash": (3, 2)},
    "curve": {"points": [(1, 1), (8, 11), (18, 2)], "width": 2.5},
    "triangle": {"x1": 2, "y1": 2, "x2": 19, "y2": 6, "x3": 4, "y3": 13, "fill": True},
    "poly": {"x": 1, "y": 2, "coords": [0, 0, 17, 9, 17, 0, 0, 9], "fill": True},
    "rect": {"x": 3, "y": 2, "w": 14.5, "h": 9, "angle": 20, "width": 2},
    "round_rect": {"x": 3, "y": 2, "w": 15, "h": 11, "r": 4, "fill": True, "corners": 5},
    "circle": {"x": 10, "y": 6, "r": 6, "fill": True},
    "ellipse": {"x": 10, "y": 6, "xr": 9, "yr": 4, "width": 3, "quadrants": 7},
    "arc": {"x": 10, "y": 6, "r": 6, "start": 0, "end": 720},
    "sector": {"x": 10, "y": 6, "r": 7, "start": 30, "end": 300, "fill": True},
    "text": {"s": "Grüße", "x": -2, "y": 3},
    "text_box": {"s": "one two three", "x": 1, "y": 1, "w": 18, "h": 12},
}
OPS = ("over", "xor", "add", "max", "clear")
places = st.tuples(st.integers(-30, 30), st.integers(-30, 30))


@st.composite
def paints(draw, package):
    """A paint, and what it says of a pixel of a framebuffer with a highest level: a level, and whether it is opaque."""
    if draw(st.booleans()):
        rows = draw(st.integers(1, 4).flatmap(lambda w: st.lists(st.text("#.0", min_size=w, max_size=w), min_size=1)))
        x0, y0 = draw(places)
        return package.Pattern("\n".join(rows), (x0, y0)), lambda x, y, top: (
            top * ((cell := rows[(y - y0) % len(rows)][(x - x0) % len(rows[0])]) == "#"),
            cell != ".",
        )
    start, end, tones = draw(places), draw(places), draw(st.tuples(*[st.sampled_from([0, 0.25, 0.5, 1])] * 2))
    dx, dy = end[0] - start[0], end[1] - start[1]

    def tone(x, y, top):
        t = 1 if (dx, dy) == (0, 0) else ((x - start[0]) * dx + (y - start[1]) * dy) / (dx * dx + dy * dy)
        exact = 255 * (tones[0] + min(max(t, 0), 1) * (tones[1] - tones[0]))
        # Where floating-point numbers decide, halves of a gray may count either way.
        return [int((2 * gray * top + 255) // 510) for gray in (np.floor(exact + 0.499999), np.floor(exact + 0.500001))]

    return package.Gradient(start, end, tones, dither=None), tone


def drawn(fb, name, **more):
    return getattr(fb, name)(**CALLS[name], **more)


@pytest.mark.parametrize("name", CALLS)
@examples(2)
@given(st.data(), st.sampled_from([1, 2, 4, 8]), st.sampled_from(OPS), st.sampled_from([None, 3, "cone"]))
def test_each_pixel_meets_its_ink_as_far_as_the_call_covers_it(package, name, data, depth, op, n):
    paint, at = data.draw(paints(package))
    smooth = package.ConeFilter() if n == "cone" else n and package.Supersample(n)
    fb = package.Framebuffer(WIDTH, HEIGHT, depth, antialias=smooth)
    cover = package.Framebuffer(WIDTH, HEIGHT, 8, antialias=smooth)
    before = np.random.default_rng(data.draw(st.integers(0, 99))).integers(0, 2**depth, (HEIGHT, WIDTH))
    fb.pixels[:] = before
    left, top, width, height = window = data.draw(st.sampled_from([(0, 0, WIDTH, HEIGHT), (4, 3, 9, 8)]))
    with fb.clip(*window), cover.clip(*window):
        drawn(fb, name, c=paint, **({"op": op} if name != "fill" else {}))
        drawn(cover, name, c=255)
    for (y, x), covered in np.ndenumerate(cover.pixels):
        share = Fraction(int(covered), 255)
        here = at(x, y, fb.max_level)
        levels = here if isinstance(here, list) else here[:1]
        wanted = {
            definitions.one_painted(int(before[y, x]), share, int(level), "over" if name == "fill" else op, depth)
            for level in levels
        }
        if isinstance(here, tuple) and not here[1]:
            wanted = {before[y, x]}
        assert fb.pixels[y, x] in wanted, (x, y)
    outside = np.ones((HEIGHT, WIDTH), bool)
    outside[top : top + height, left : left + width] = False
    assert (fb.pixels == before)[outside].all()


@pytest.mark.parametrize("name", CALLS)
@given(st.sampled_from([1, 2, 4, 8]), st.sampled_from(OPS), st.sampled_from([None, 4, 5]), st.booleans())
def test_a_pattern_of_one_level_is_that_level(package, name, depth, op, n, dark):
    """With one bit a pixel always; with more where no pixel is painted twice and none in part."""
    if depth > 1:
        n = None
    smooth = n and package.Supersample(n)
    one, other = (package.Framebuffer(WIDTH, HEIGHT, depth, antialias=smooth) for _ in range(2))
    style = {} if name == "fill" else {"op": "over" if name in ("lines", "points") else op}
    for fb in (one, other):
        fb.pixels[:, ::3] = 1
    drawn(one, name, c=0 if dark else one.max_level, **style)
    drawn(other, name, c=package.Pattern("0" if dark else "#"), **style)
    assert (one.pixels == other.pixels).all()


@given(st.sampled_from([1, 4]), st.sampled_from([None, 2]), places)
def test_a_flood_fill_with_an_ink(package, depth, border, place):
    fb = package.Framebuffer(WIDTH, HEIGHT, depth)
    fb.circle(8, 6, 5)
    if depth == 4:
        fb.line(0, 0, 20, 13, 2)
    border = border and min(border, fb.max_level)
    plain, before = fb.copy(), fb.pixels.copy()
    count = plain.flood_fill(*place, c=1, border=border, op="xor")
    assert fb.flood_fill(*place, c=package.Pattern("0#", (3, 0)), border=border) == count
    taken = plain.pixels != before
    x = np.arange(WIDTH) + np.zeros((HEIGHT, 1))
    assert (fb.pixels == np.where(taken, np.where((x - 3) % 2, fb.max_level, 0), before)).all()


@pytest.mark.parametrize("call", ["text", "text_box"])
@pytest.mark.parametrize("depth", [1, 4])
def test_inverse_text_is_dark_on_the_ink(package, call, depth):
    place = (1, 1) if call == "text" else (0, 0, 20, 10)
    on_dark, on_bright, painted, left = (package.Framebuffer(20, 10, depth) for _ in range(4))
    on_bright.fill(None)
    for fb in (painted, left):
        fb.fill(1)
    for fb in (on_dark, on_bright):
        getattr(fb, call)("Ab", *place, inverse=True)
    around, characters = on_dark.pixels > 0, on_bright.pixels == 0
    assert characters.any()
    getattr(painted, call)("Ab", *place, package.Pattern("#0"), inverse=True)
    stripes = np.where(np.arange(20) % 2, 0, np.where(around, painted.max_level, 1))
    assert (painted.pixels == np.where(characters, 0, np.where(around, stripes, 1))).all()
    getattr(left, call)("Ab", *place, package.Pattern("0"), inverse=True, op="max")
    assert (left.pixels == 1).all()


def test_neighbors_meet_and_views_count_from_their_own_corner(package):
    whole, parts = package.Framebuffer(24, 12), package.Framebuffer(24, 12)
    whole.rect(2, 1, 19, 9, package.Pattern.bricks, fill=True)
    for x, w in ((2, 7), (9, 3), (12, 9)):
        parts.rect(x, 1, w, 9, package.Pattern.bricks, fill=True)
    assert whole == parts
    fb = package.Framebuffer(6, 3)
    fb.view(1, 1, 4, 2).fill(package.Pattern("#..."))
    assert_pattern(fb, "......\n.#....\n.#....")
    fb.fill(package.Pattern("#...").at(-2, 0))
    assert_pattern(fb, "..#...\n.##...\n.##...")


def test_ready_patterns(package):
    names = ("checker", "dots", "horizontal", "vertical", "diagonal", "bricks")
    fb = package.Framebuffer(48, 6)
    for i, name in enumerate(names):
        fb.view(8 * i, 0, 8, 6).fill(getattr(package.Pattern, name))
    assert_pattern(
        fb,
        """
        #.#.#.#.........#########...#......#...#########
        .#.#.#.#..#...#.........#...#.....#...#.#.......
        #.#.#.#.................#...#....#...#..#.......
        .#.#.#.#................#...#...#...#...########
        #.#.#.#.........#########...#......#...#....#...
        .#.#.#.#..#...#.........#...#.....#...#.....#...
        """,
    )


def test_digits_are_levels_as_those_of_a_sprite(package):
    fb = package.Framebuffer(4, 1, 4)
    fb.fill(package.Pattern("12#."))
    assert fb.pixels.tolist() == [[5, 10, 15, 0]]
    fb.fill(package.Pattern(package.Sprite(np.array([[0, 255]], np.uint8))))
    assert fb.pixels.tolist() == [[0, 15, 0, 15]]


@pytest.mark.parametrize("dither", ["blue-noise", "bayer"])
@pytest.mark.parametrize("depth", [1, 2, 4])
def test_a_dithered_gradient_is_on_average_what_it_is_exactly(package, depth, dither):
    fb = package.Framebuffer(256, 64, depth)
    fb.fill(package.Gradient((0, 0), (255, 0), dither=dither))
    shares = fb.pixels.mean(axis=0) / fb.max_level
    strips = shares.reshape(16, 16).mean(axis=1)
    assert np.allclose(strips, (np.arange(16) * 16 + 7.5) / 255, atol=0.02)
    exact = fb.max_level * np.arange(256) / 255
    assert (abs(fb.pixels - exact) <= 1).all()


@given(places, st.floats(0.5, 40), st.sampled_from([(0, 1), (1, 0), [(0, 1), (0.25, 0), (1, 0.5)]]))
def test_a_radial_gradient_goes_by_the_distance(package, center, r, tones):
    fb = package.Framebuffer(WIDTH, HEIGHT, 8)
    fb.fill(package.Gradient.radial(center, r, tones))
    stops = [(0, tones[0]), (1, tones[1])] if len(tones) == 2 else tones
    for (y, x), level in np.ndenumerate(fb.pixels):
        t = min(hypot(x - center[0], y - center[1]) / r, 1)
        (t0, a), (t1, b) = next(pair for pair in pairwise(stops) if t <= pair[1][0])
        assert abs(level - 255 * (a + (b - a) * (t - t0) / (t1 - t0))) <= 0.501


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(
    ("make", "columns"),
    [
        (lambda p: p.Gradient((1e308, 0), (-1e308, 3)), [128] * 3),
        (lambda p: p.Gradient((10**400, 0), (-(10**400), 0)), [128] * 3),
        (lambda p: p.Gradient((1, 0), (1 + 1e-310, 0)), [255] * 3),
        (lambda p: p.Gradient((0, 0), (1e-310, 0)), [0, 255, 255]),
        (lambda p: p.Gradient.radial((0, 0), 1e-320), [0, 255, 255]),
        (lambda p: p.Gradient.radial((-1e308, 1e308), 3), [255] * 3),
        (lambda p: p.Gradient.radial((0, 0), 10**400), [0] * 3),
        (lambda p: p.Pattern("#", (-(10**400), 10**400)), [255] * 3),
    ],
)
def test_paints_may_begin_and_end_far_away_or_in_a_point(package, make, columns):
    fb = package.Framebuffer(3, 1, 8)
    fb.fill(make(package))
    assert fb.pixels.tolist() == [columns]


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda p: p.Pattern(""), ValueError, "a sprite must have pixels"),
        (lambda p: p.Pattern("#x"), ValueError, "a sprite is written with"),
        (lambda p: p.Pattern(3), TypeError, "picture must be"),
        (lambda p: p.Pattern("#", 3), TypeError, "origin must be a point"),
        (lambda p: p.Gradient((0, 0), (1, float("nan"))), ValueError, "end must be finite"),
        (lambda p: p.Gradient((0, 0), (9, 0), (1,)), ValueError, "tones must be two or more"),
        (lambda p: p.Gradient((0, 0), (9, 0), (0, 2)), ValueError, "tones must be from 0 to 1"),
        (lambda p: p.Gradient((0, 0), (9, 0), [(1, 0), (0, 1)]), ValueError, "in order"),
        (lambda p: p.Gradient((0, 0), (9, 0), 1), TypeError, "tones must be a sequence"),
        (lambda p: p.Gradient((0, 0), (9, 0), dither="floyd-steinberg"), ValueError, "dither must be"),
        (lambda p: p.Gradient.radial((0, 0), 0), ValueError, "r must be above 0"),
    ],
)
def test_what_is_no_paint_is_refused(package, make, error, message):
    with pytest.raises(error, match=message):
        make(package)


@pytest.mark.parametrize("name", CALLS)
def test_a_wrong_argument_beside_a_paint_is_named_and_nothing_is_drawn(package, name):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    if name != "fill":
        with pytest.raises(ValueError, match="op must be one of"):
            drawn(fb, name, c=package.Pattern.checker, op="under")
    for number in (1.5, "#"):
        with pytest.raises(TypeError, match="c must be a whole number"):
            drawn(fb, name, c=number)
    with pytest.raises(ValueError, match="border must be a level"):
        fb.flood_fill(1, 1, package.Pattern.checker, border=9)
    assert not fb.pixels.any()
