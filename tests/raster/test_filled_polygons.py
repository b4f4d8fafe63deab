"""Filled polygons, against counting the reference points that their edges go around."""

from __future__ import annotations

from array import array

import numpy as np
import pytest
from definitions import painted
from hypothesis import assume, example, given
from hypothesis import strategies as st
from searching import examples
from stroke_definitions import HEIGHT, WIDTH, as_counted, counted, far_polygon, polygon

from paneldraw.testing import assert_pattern

rules = st.sampled_from(["even-odd", "nonzero"])
references = st.sampled_from(["center", "corner"])
few_samples = st.tuples(st.sampled_from([1, 2, 3, 4]), references)
# Small whole numbers and quarters: corners repeat, lie on one line, and edges pass through reference points.
whole = st.integers(-4, 16)
quarters = st.integers(-16, 60).map(lambda v: v / 4)
in_256ths = st.integers(-6 * 256, 18 * 256).map(lambda v: v / 256)
corners = st.one_of(
    *[st.lists(st.tuples(number, number), min_size=3, max_size=9) for number in (whole, quarters, in_256ths)]
)
STAR = [(6, -1), (9, 9), (0, 3), (12, 3), (3, 9)]
BOW = [(0, 0), (12, 8), (12, 0), (0, 8)]


def is_flat(points):
    (x, y), *others = points
    offsets = [(a - x, b - y) for a, b in others]
    return all(a * d == b * c for a, b in offsets for c, d in offsets)


def filled(points, rule="even-odd"):
    """What `counted` draws."""
    return lambda fb, level, antialias: fb.poly(0, 0, points, level, fill=True, rule=rule, antialias=antialias)


def test_the_rules_differ_where_a_polygon_goes_around_twice(package):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.poly(0, 0, STAR, fill=True, rule="even-odd", edges="shared")
    assert_pattern(
        fb,
        """
        ......#......
        ......#......
        ......#......
        #####...####.
        ..###...###..
        ...##...#....
        ....#...#....
        ....#####....
        ....#...#....
        """,
    )
    fb.clear()
    fb.poly(0, 0, STAR, fill=True, rule="nonzero", edges="shared")
    assert_pattern(
        fb,
        """
        ......#......
        ......#......
        ......#......
        ############.
        ..#########..
        ...######....
        ....#####....
        ....#####....
        ....#...#....
        """,
    )


@examples(2)
@given(corners, rules, few_samples)
@example(STAR, "even-odd", (4, "center"))
@example(STAR, "nonzero", (4, "corner"))
@example(BOW, "nonzero", (1, "center"))
@example([(2, 2), (8, 2), (8, 2), (8, 6), (2, 6), (2, 4), (2, 4)], "even-odd", (1, "corner"))
@example([(1, 1), (5, 1), (5, 5), (1, 5), (1, 1), (5, 1), (5, 5), (1, 5)], "even-odd", (1, "center"))
@example([(1, 1), (5, 1), (5, 5), (1, 5), (1, 1), (5, 1), (5, 5), (1, 5)], "nonzero", (2, "center"))
def test_polygons_equal_counting(package, points, rule, samples):
    assume(not is_flat(points))
    assert (counted(package, filled(points, rule), *samples) == polygon(points, rule, *samples)).all()


@examples(0.4)
@given(corners, rules, st.tuples(st.integers(5, 16), references))
@example(BOW, "nonzero", (16, "corner"))
def test_polygons_of_many_samples_equal_counting(package, points, rule, samples):
    assume(not is_flat(points))
    n = samples[0]
    assert (counted(package, filled(points, rule), *samples) == as_counted(polygon(points, rule, *samples), n)).all()


@examples(0.2)
@given(st.lists(st.tuples(in_256ths, in_256ths), min_size=40, max_size=80), rules, few_samples)
def test_tangles_equal_counting(package, points, rule, samples):
    assume(not is_flat(points))
    assert (counted(package, filled(points, rule), *samples) == polygon(points, rule, *samples)).all()


@given(corners, rules, few_samples)
def test_one_bit_pixels_are_lit_when_half_of_them_is_covered(package, points, rule, samples):
    assume(not is_flat(points))
    n = samples[0]
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.poly(0, 0, points, fill=True, rule=rule, antialias=package.Supersample(*samples))
    assert (fb.pixels == (2 * polygon(points, rule, *samples) >= n * n)).all()


@pytest.mark.parametrize("op", ["over", "xor", "add", "max", "clear"])
@examples(0.24)
@given(corners, rules, few_samples, st.integers(0, 15), st.integers(0, 2**32 - 1))
def test_operations_blend_what_is_covered(package, op, points, rule, samples, level, seed):
    assume(not is_flat(points))
    n = samples[0]
    before = np.random.default_rng(seed).integers(0, 16, (HEIGHT, WIDTH), np.uint8)
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=4)
    fb.pixels[...] = before
    fb.poly(0, 0, points, level, fill=True, rule=rule, antialias=package.Supersample(*samples), op=op)
    assert (fb.pixels == painted(before, polygon(points, rule, *samples), n * n, level, op, 4)).all()


@given(corners, rules, few_samples, st.integers(1, 10), st.integers(1, 7))
def test_clipping_changes_nothing(package, points, rule, samples, left, top):
    assume(not is_flat(points))
    whole_picture = counted(package, filled(points, rule), *samples)
    moved = [(x - left, y - top) for x, y in points]
    part = counted(package, filled(moved, rule), *samples, size=(WIDTH - left, HEIGHT - top))
    assert (part == whole_picture[top:, left:]).all()


# -- Neighbors


@st.composite
def tilings(draw):
    """Polygons that make up the rectangle around all reference points: triangles around a point, cut in two at will."""
    number = draw(st.sampled_from([whole, quarters, in_256ths]))
    x, y = draw(number.filter(lambda v: -2 < v < 14)), draw(number.filter(lambda v: -2 < v < 10))
    around = [(-2, -2), (14, -2), (14, 10), (-2, 10)]
    triangles = [[around[i - 1], around[i], (x, y)] for i in range(4)]
    tiles = []
    for a, b, c in triangles:
        # A point anywhere, even outside: the pieces then overlap in pairs of opposite winding.
        d = draw(st.tuples(number, number))
        tiles += [[a, b, d], [b, c, d], [c, a, d]] if draw(st.booleans()) else [[a, b, c]]
    return tiles


@given(tilings())
def test_neighbors_leave_no_gap_and_with_xor_no_overlap(package, tiles):
    """Three triangles around a point outside of the one that they come from cover what is not in it twice or never."""
    fb = package.Framebuffer(WIDTH, HEIGHT)
    for tile in tiles:
        if not is_flat(tile):
            fb.poly(0, 0, tile, fill=True, edges="shared", op="xor")
    assert fb.pixels.all()


@st.composite
def halves(draw):
    """The rectangle around all reference points in two parts, along a path that may cross itself."""
    number = draw(st.sampled_from([whole, quarters, in_256ths]))
    cut = draw(st.lists(st.tuples(number.filter(lambda v: -2 < v < 14), number), min_size=1, max_size=5))
    cut = [(-2, draw(number)), *cut, (14, draw(number))]
    return [[*cut, (14, -99), (-2, -99)], [*cut, (14, 99), (-2, 99)]]


@given(halves(), rules, few_samples)
def test_the_parts_of_a_whole_add_up_to_it(package, parts, rule, samples):
    n = samples[0]
    if rule == "nonzero":
        cut = sorted(parts[0][1:-3])
        parts = [[part[0], *cut, *part[-3:]] for part in parts]
    assert (sum(counted(package, filled(part, rule), *samples) for part in parts) == n * n).all()


# -- Far and flat


@st.composite
def far_polygons(draw, reach):
    near, far = st.integers(-4, 16), st.integers(-reach, reach)
    number = st.one_of(near, far, st.sampled_from([reach, -reach, 2**17, -(2**17), 2**18, 2**18 + 1]))
    points = draw(st.lists(st.tuples(number, number), min_size=2, max_size=5))
    # Through the picture goes one edge at the least.
    (x, y), (dx, dy) = draw(st.tuples(near, near)), draw(st.tuples(far, far))
    return [*points, (x - dx, y - dy), (x + dx, y + dy)]


@pytest.mark.parametrize("reach", [2**16, 2**19, 2**33, 2**63, 2**70])
@examples(0.5)
@given(st.data(), rules, few_samples)
def test_polygons_from_far_away_are_exact_to_a_512th_of_a_pixel(package, reach, data, rule, samples):
    points = data.draw(far_polygons(reach))
    assume(not is_flat(points))
    least, most = far_polygon(points, rule, *samples)
    counts = counted(package, filled(points, rule), *samples)
    assert (least <= counts).all()
    assert (counts <= most).all()


@pytest.mark.parametrize("distance", [2**40, 2**70, 1e300])
@given(st.tuples(quarters, quarters), few_samples, rules)
def test_neighbors_that_meet_far_away_leave_no_gap(package, distance, center, samples, rule):
    """Four triangles around a point, out to where no surface reaches."""
    around = [(-distance, -distance), (distance, -distance / 3), (distance, distance), (-distance / 7, distance)]
    tiles = [[around[i - 1], around[i], center] for i in range(4)]
    counts = sum(counted(package, filled(tile, rule), *samples) for tile in tiles)
    assert (counts == samples[0] ** 2).all()


@pytest.mark.parametrize("antialias", [None, 4])
@given(
    st.one_of(
        st.lists(st.tuples(whole, whole), max_size=2),
        st.builds(
            lambda x, y, dx, dy, steps: [(x + step * dx, y + step * dy) for step in steps],
            whole,
            whole,
            st.one_of(whole, st.integers(-(2**70), 2**70)),
            whole,
            st.lists(st.integers(-3, 3), min_size=1, max_size=5),
        ),
    )
)
@example([])
@example([(3, 3)])
@example([(3, 3), (2**40, 3)])
@example([(5, 5), (5, 5), (5, 5)])
def test_polygons_without_an_area_are_their_outlines(package, antialias, points):
    pictures = []
    for fill in (True, False):
        fb = package.Framebuffer(WIDTH, HEIGHT, depth=8)
        fb.poly(0, 0, points, fill=fill, antialias=antialias and package.Supersample(antialias))
        pictures.append(fb.pixels)
    assert (pictures[0] == pictures[1]).all()


@given(st.lists(st.tuples(whole, whole), min_size=3, max_size=7), rules)
def test_fill_and_outline_have_no_gap_between_them(package, points, rule):
    """All pixels that are in the polygon or on its edge are lit, and others only next to the edge."""
    assume(not is_flat(points))
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.poly(0, 0, points, fill=True, rule=rule)
    fb.poly(0, 0, points)
    edges = list(zip(points[-1:] + points[:-1], points, strict=True))
    for (y, x), inside in np.ndenumerate(polygon(points, rule)):
        if inside or any(on_segment((x, y), *edge) for edge in edges):
            assert fb.pixels[y, x]
        elif fb.pixels[y, x]:
            assert any(near_segment((x, y), *edge) for edge in edges)


def on_segment(point, a, b):
    (x, y), (dx, dy) = (point[0] - a[0], point[1] - a[1]), (b[0] - a[0], b[1] - a[1])
    return x * dy == y * dx and min(0, dx) <= x <= max(0, dx) and min(0, dy) <= y <= max(0, dy)


def near_segment(point, a, b):
    """Within half a pixel, along the axis on which the segment is shorter."""
    (x, y), (dx, dy) = (point[0] - a[0], point[1] - a[1]), (b[0] - a[0], b[1] - a[1])
    return 2 * abs(x * dy - y * dx) <= max(abs(dx), abs(dy)) and (dx, dy) != (0, 0)


# -- How a polygon is written down


def test_points_come_in_many_forms(package):
    pictures = []
    for coords in (
        [1, 1, 11, 2, 4, 8],
        array("h", [1, 1, 11, 2, 4, 8]),
        [(1, 1), (11, 2), (4, 8)],
        np.array([[1, 1], [11, 2], [4, 8]], np.float32),
        np.array([1, 1, 11, 2, 4, 8], np.uint8),
        iter([(1, 1), (11, 2), (4, 8)]),
        [np.array([1, 1]), np.array([11, 2]), np.array([4, 8])],
    ):
        fb = package.Framebuffer(WIDTH, HEIGHT)
        fb.poly(0, 0, coords, fill=True)
        pictures.append(fb.pixels)
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.triangle(1, 1, 11, 2, 4, 8, fill=True)
    assert fb.pixels.any()
    assert all((picture == fb.pixels).all() for picture in pictures)


@given(st.tuples(quarters, quarters), corners, st.booleans())
@example((2**70, -(2**70)), [(3 - 2**70, 2**70), (9 - 2**70, 2**70), (6 - 2**70, 2**70 + 5)], True)
def test_x_and_y_are_added_to_all_points(package, offset, points, fill):
    x, y = offset
    pictures = []
    for arguments in ((x, y, points), (0, 0, [(a + x, b + y) for a, b in points])):
        fb = package.Framebuffer(WIDTH, HEIGHT)
        fb.poly(*arguments, fill=fill)
        pictures.append(fb.pixels)
    assert (pictures[0] == pictures[1]).all()


@pytest.mark.parametrize("offset", [0.5, 1e308, 2**2000])
@pytest.mark.parametrize("coords", [[2**2000, 0, 0, 2**2000], [1e308, 3, 3, 1e308]])
def test_sums_beyond_what_a_float_holds_draw_all_the_same(package, offset, coords):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.poly(offset, 0, coords)
    fb.poly(offset, offset, coords, fill=True)


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"rule": "odd"}, ValueError, r"rule must be one of 'even-odd', 'nonzero', not 'odd'"),
        ({"rule": []}, ValueError, r"rule must be one of"),
        ({"op": "under"}, ValueError, r"op must be one of"),
        ({"join": "mitre"}, ValueError, r"join must be one of 'miter', 'round', 'bevel', not 'mitre'"),
        ({"width": 0}, ValueError, r"width must be at least 1/256"),
        ({"width": float("nan")}, ValueError, r"width must be finite"),
        ({"antialias": 4}, TypeError, r"antialias must be None, a Supersample"),
        ({"coords": [1, 2, 3]}, ValueError, r"coords must hold an x and a y for each point, and holds 3 numbers"),
        ({"coords": [(1, 2), (3, 4, 5)]}, ValueError, r"coords must hold points \(x, y\)"),
        ({"coords": np.zeros((4, 3))}, ValueError, r"coords must hold points"),
        ({"coords": np.zeros((2, 2, 2))}, ValueError, r"coords must hold points"),
        ({"coords": np.zeros(())}, ValueError, r"coords must hold points"),
        ({"coords": 7}, ValueError, r"coords must hold points"),
        ({"coords": [1, 2, 3, "4"]}, TypeError, r"coords must be a number, not str"),
        ({"coords": [(1, 2), (3, float("inf"))]}, ValueError, r"coords must be finite"),
        ({"x": float("nan")}, ValueError, r"x must be finite"),
        ({"y": "1"}, TypeError, r"y must be a number"),
        ({"c": 2}, ValueError, r"c must be a level from 0 to 1"),
    ],
)
@pytest.mark.parametrize("fill", [True, False])
def test_what_is_wrong_is_named(package, change, error, message, fill):
    fb = package.Framebuffer(8, 8)
    arguments = {"x": 0, "y": 0, "coords": [1, 1, 6, 1, 3, 6], "fill": fill, **change}
    with pytest.raises(error, match=message):
        fb.poly(**arguments)
    assert not fb.pixels.any()
