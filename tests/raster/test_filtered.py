"""Paths, polygons and round shapes through a filter: its volume above them, as numeric integration has it.

They are within 5/255, and within 10/255 where parts of them are thinner than half a pixel.
"""

from __future__ import annotations

from itertools import pairwise
from math import cos, floor, radians, sin

import filter_definitions as definitions
import numpy as np
import pytest
import stroke_definitions
from hypothesis import assume, given
from hypothesis import strategies as st
from searching import examples

import paneldraw

SIZE = (7, 5)

filters = st.tuples(st.sampled_from([0.5, 0.5, 0.8, 1.0, 1.7, 4.0]), st.sampled_from(["cone", "box", "gaussian"]))
widths = st.sampled_from([0.25, 1, 1, 2, 3.5])


def positions(low, high):
    """Whole numbers often: edges through the centers of pixels and along their sides, corners in the middle of one."""
    return st.one_of(st.integers(low, high), st.integers(256 * low, 256 * high).map(lambda number: number / 256))


points = st.tuples(positions(-3, 10), positions(-3, 8))
paths = st.lists(points, min_size=2, max_size=6).filter(
    lambda path: path[0] != path[-1] and all(a != b for a, b in pairwise(path))
)
# Edges that rise by less than a pixel in many: where samples see none or a whole row of them.
flat = st.integers(0, 4).flatmap(
    lambda y: st.lists(
        st.tuples(positions(-30, 40), st.integers(-40, 40).map(lambda number: y + number / 256)), min_size=3, max_size=6
    )
)


def is_flat(corners):
    """Without an area: such a polygon is drawn as its outline."""
    (x, y), *others = corners
    return not any((a - x) * (d - y) != (b - y) * (c - x) for a, b in others for c, d in others)


def assert_filtered(package, filter, draw, inside, thinnest=1.0):
    fb = package.Framebuffer(*SIZE, depth=8)
    draw(fb, package.ConeFilter(*filter))
    exact = 255 * definitions.volumes(inside, *filter, SIZE)
    assert abs(fb.pixels - exact).max() <= (5 if thinnest >= 0.5 else 10)


@pytest.mark.parametrize("rule", ["even-odd", "nonzero"])
@examples(0.6)
@given(
    filters, st.one_of(st.lists(points, min_size=3, max_size=9), flat, flat.map(lambda path: [p[::-1] for p in path]))
)
def test_polygons(package, rule, filter, corners):
    assume(not is_flat(corners))
    inside = definitions.polygon(corners, rule)
    assert_filtered(
        package, filter, lambda fb, cone: fb.poly(0, 0, corners, fill=True, rule=rule, antialias=cone), inside, 0
    )


@pytest.mark.parametrize("join", ["miter", "round", "bevel"])
@examples(0.6)
@given(filters, paths, widths, st.sampled_from(["butt", "square", "round"]), st.booleans())
def test_polylines(package, join, filter, path, width, cap, closed):
    pieces = stroke_definitions.stroke(path, width, join, cap, closed)
    style = {"width": width, "join": join, "cap": cap, "closed": closed}
    assert_filtered(
        package,
        filter,
        lambda fb, cone: fb.polyline(path, antialias=cone, **style),
        stroke_definitions.union(pieces),
        width,
    )


@examples(0.8)
@given(
    filters,
    paths,
    widths,
    st.lists(st.sampled_from([1, 1.5, 3, 40]), min_size=1, max_size=3),
    st.sampled_from(["butt", "square", "round"]),
    st.booleans(),
)
def test_dashes(package, filter, path, width, dash, cap, closed):
    pieces, nearest_end = stroke_definitions.dashed_stroke(path, width, dash, "miter", cap, closed)
    # Where a dash ends at a corner, rounding decides whether a join is made.
    assume(nearest_end > 1e-6)
    style = {"width": width, "dash": dash, "cap": cap, "closed": closed}
    assert_filtered(
        package,
        filter,
        lambda fb, cone: fb.polyline(path, antialias=cone, **style),
        stroke_definitions.union(pieces),
        width,
    )


@examples(0.8)
@given(
    filters,
    points,
    st.tuples(positions(0, 6), positions(0, 6)),
    widths,
    st.booleans(),
    st.sampled_from([15, 15, *range(16)]),
)
def test_circles_and_ellipses(package, filter, center, sizes, width, fill, quadrants):
    cut = None if quadrants == 15 else definitions.quadrants(quadrants)
    inside = definitions.band((*center, *center), sizes, width, fill, cut=cut)
    style = {"width": width, "fill": fill}
    thinnest = min(width, *sizes)
    if sizes[0] == sizes[1] and quadrants == 15:
        assert_filtered(
            package, filter, lambda fb, cone: fb.circle(*center, sizes[0], antialias=cone, **style), inside, thinnest
        )
    style["quadrants"] = quadrants
    assert_filtered(
        package, filter, lambda fb, cone: fb.ellipse(*center, *sizes, antialias=cone, **style), inside, thinnest
    )


@examples(0.8)
@given(filters, points, positions(0, 6), widths, st.integers(-360, 360), st.integers(1, 359))
def test_arcs_and_sectors(package, filter, center, r, width, start, swept):
    wedge = definitions.wedge(start, swept)
    box, end = (*center, *center), start + swept
    inside = definitions.band(box, (r, r), width, cut=wedge)
    assert_filtered(
        package, filter, lambda fb, cone: fb.arc(*center, r, start, end, width=width, antialias=cone), inside, width
    )
    for fill, cut in (True, wedge), (False, definitions.sector_outline(start, swept)):
        style = {"fill": fill, "width": width}
        inside = definitions.band(box, (r, r), width, fill, cut=cut)
        assert_filtered(
            package,
            filter,
            lambda fb, cone, style=style: fb.sector(*center, r, start, end, antialias=cone, **style),
            inside,
            0 if fill else width,
        )


@examples(0.8)
@given(
    filters,
    points,
    st.tuples(positions(1, 9), positions(1, 7)),
    st.sampled_from([0, 0, 0.5, 1.25, 3]),
    widths,
    st.booleans(),
)
def test_rectangles(package, filter, corner, sides, r, width, fill):
    (x, y), (w, h) = corner, sides
    r = min(r, *(floor(128 * (side - 1)) / 256 for side in sides))
    box = (x + r, y + r, x + w - 1 - r, y + h - 1 - r)
    inside = definitions.band(box, (r, r), width, fill, sharp=r == 0)
    style = {"fill": fill, "width": width}
    assert_filtered(
        package, filter, lambda fb, cone: fb.round_rect(x, y, w, h, r, antialias=cone, **style), inside, width
    )


@pytest.mark.parametrize("r", [40, 5000, 20000, 131000])
@examples(0.2)
@given(filters, st.integers(0, 359), widths, st.booleans())
def test_large_circles(package, r, filter, angle, width, fill):
    x, y = round(3 + r * cos(radians(angle))), round(2 + r * sin(radians(angle)))
    inside = definitions.band((x, y, x, y), (r, r), width, fill)
    style = {"fill": fill, "width": width}
    assert_filtered(package, filter, lambda fb, cone: fb.circle(x, y, r, antialias=cone, **style), inside, width)
    angles = (angle + 90, angle + 270)
    cut = definitions.wedge(angles[0], 180)
    if not fill:
        inside = definitions.band((x, y, x, y), (r, r), width, cut=cut)
        assert_filtered(
            package, filter, lambda fb, cone: fb.arc(x, y, r, *angles, width=width, antialias=cone), inside, width
        )


@examples(0.2)
@given(filters, st.sampled_from([2**18, 2**30, 2**70]), st.sampled_from([0, 90, 180, 270]), widths, st.booleans())
def test_circles_that_are_cut_are_at_most_a_pixel_off(package, filter, r, angle, width, fill):
    x, y = 3 + r * round(cos(radians(angle))), 2 + r * round(sin(radians(angle)))
    fb = package.Framebuffer(*SIZE, depth=8)
    fb.circle(x, y, r, width=width, fill=fill, antialias=package.ConeFilter(*filter))

    def within(beyond):
        """The disc or ring near the picture, where its edges are straight; `beyond` as much larger."""

        def inside(xs, ys):
            outward = {0: 3 - xs, 90: 2 - ys, 180: xs - 3, 270: ys - 2}[angle]
            return (outward < width / 2 + beyond) & (fill | (outward > -width / 2 - beyond))

        return 255 * definitions.volumes(inside, *filter, SIZE)

    assert (within(-1) - 5 <= fb.pixels).all()
    assert (fb.pixels <= within(1) + 5).all()


@pytest.mark.parametrize(
    ("filter", "center", "r", "width"),
    [
        ((0.5, "cone"), (-604.3984375, -483.3984375), 777.49609375, 0.04296875),
        ((1, "cone"), (-762, -718), 1050.53125, 0.25),
    ],
)
def test_thin_rings_do_not_swell(package, filter, center, r, width):
    """As between two edges of unlike chords, one with its corners where the other has its middles."""
    x, y = (position + (filter[0] == 1) / 32 for position in center)
    inside = definitions.band((x, y, x, y), (r, r), width)
    assert_filtered(package, filter, lambda fb, cone: fb.circle(x, y, r, width=width, antialias=cone), inside, width)


@pytest.mark.parametrize(
    ("filter", "center", "r"), [((0.5, "gaussian"), (-5015, -5016), 7096), ((0.5, "cone"), (-4671, -4334), 6375)]
)
def test_large_discs_do_not_bulge(package, filter, center, r):
    inside = definitions.band((*center, *center), (r, r), 1, True)
    assert_filtered(package, filter, lambda fb, cone: fb.circle(*center, r, fill=True, antialias=cone), inside)


@pytest.mark.parametrize("resolution", [8, 32])
@pytest.mark.parametrize("filter", ["cone", "box", "gaussian"])
@pytest.mark.parametrize("r", [3.4, 3.46875, 3.49])
def test_a_disc_about_as_large_as_the_filter(package, r, filter, resolution):
    """Seen from its center all edges are near the rim, where the least errors of all add up."""
    exact = 255 * definitions.volumes(definitions.band((3, 2, 3, 2), (r, r), 1, True), 4, filter, SIZE)
    fb = package.Framebuffer(*SIZE, depth=8)
    fb.circle(3, 2, r, fill=True, antialias=package.ConeFilter(4, filter, resolution))
    assert abs(fb.pixels - exact).max() <= 5


def draw_shapes(fb, number, shift=(0, 0), **style):
    """One of a few shapes."""
    x, y = shift
    path = [(x + 2, y + 3), (x + 11, y + 6.25), (x + 6, y + 12), (x + 2, y + 2), (x + 9, y + 11)]
    (
        lambda: fb.poly(x, y, [(2, 3), (11, 6.25), (6, 12), (2, 2), (9, 11)], fill=True, **style),
        lambda: fb.polyline(path, width=2.5, join="round", cap="round", **style),
        lambda: fb.polyline(path, width=1, dash=(3, 2), closed=True, **style),
        lambda: fb.circle(x + 6, y + 5, 4.5, width=2, **style),
        lambda: fb.ellipse(x + 6, y + 5, 7, 3, fill=True, quadrants=7, **style),
        lambda: fb.arc(x + 6, y + 5, 6, 20, 200, width=3, **style),
        lambda: fb.sector(x + 6, y + 5, 6, 100, 350, width=1, **style),
        lambda: fb.sector(x + 6, y + 5, 6, 100, 350, fill=True, **style),
        lambda: fb.round_rect(x + 1, y + 2, 11, 9, 3, **style),
        lambda: fb.rect(x + 1, y + 2, 11.5, 9, fill=True, **style),
    )[number]()


@pytest.mark.parametrize("shape", range(10))
@pytest.mark.parametrize("window", [(0, 0, 6, 5), (5, 3, 4, 9), (11, 11, 3, 3)])
def test_clips_and_views_show_a_part_of_the_same(package, shape, window):
    x, y, w, h = window
    cone = package.ConeFilter(1.5)
    whole, clipped, seen = (package.Framebuffer(16, 16, 8) for _ in range(3))
    draw_shapes(whole, shape, antialias=cone)
    with clipped.clip(x, y, w, h):
        draw_shapes(clipped, shape, antialias=cone)
    draw_shapes(seen.view(x, y, w, h), shape, (-x, -y), antialias=cone)
    for part in (clipped, seen):
        assert (part.pixels[y : y + h, x : x + w] == whole.pixels[y : y + h, x : x + w]).all()
        part.pixels[y : y + h, x : x + w] = 0
        assert not part.pixels.any()
    assert whole.pixels.any()


@pytest.mark.parametrize("shape", range(10))
def test_each_pixel_is_painted_once(package, shape):
    cone = package.ConeFilter()
    over, added, most = (package.Framebuffer(16, 16, 8) for _ in range(3))
    draw_shapes(over, shape, c=100, antialias=cone)
    draw_shapes(added, shape, c=100, op="add", antialias=cone)
    draw_shapes(most, shape, c=100, op="max", antialias=cone)
    assert over == added == most
    assert over.pixels.max() <= 100
    fb = package.Framebuffer(16, 16, 8)
    before = np.random.default_rng(shape).integers(0, 256, (16, 16))
    fb.pixels[...] = before
    draw_shapes(fb, shape, c=100, op="xor", antialias=cone)
    assert (fb.pixels == before ^ over.pixels).all()
    draw_shapes(fb, shape, c=100, op="xor", antialias=cone)
    assert (fb.pixels == before).all()
    full = package.Framebuffer(16, 16, 8)
    full.pixels[...] = 100
    draw_shapes(full, shape, c=100, op="clear", antialias=cone)
    assert abs(100 - over.pixels.astype(int) - full.pixels).max() <= 1


@pytest.mark.parametrize("shape", range(10))
@pytest.mark.parametrize("filter", [(0.5, "box"), (1.0, "cone"), (4.0, "gaussian")])
def test_both_speeds_give_equal_pixels(sources, shape, filter):
    compiled = paneldraw.Framebuffer(16, 16, 8)
    draw_shapes(compiled, shape, antialias=paneldraw.ConeFilter(*filter))
    with sources.in_place() as package:
        interpreted = package.Framebuffer(16, 16, 8)
        draw_shapes(interpreted, shape, antialias=package.ConeFilter(*filter))
    assert (compiled.pixels == interpreted.pixels).all()


@examples(0.5)
@given(st.lists(points, min_size=12, max_size=40), filters)
def test_tangles(package, corners, filter):
    """Many crossings in each pixel, some of many edges in one point."""
    assume(not is_flat(corners))
    inside = definitions.polygon(corners, "even-odd")
    assert_filtered(package, filter, lambda fb, cone: fb.poly(0, 0, corners, fill=True, antialias=cone), inside, 0)


@pytest.mark.parametrize("filter", ["cone", "box", "gaussian"])
def test_polygons_that_share_an_edge_leave_no_seam(package, filter):
    corners = [(-9, -9), (30, -9), (30, 30), (-9, 30)]
    for cut in ([(4.3, -9), (6.6, 30)], [(7, -9), (7, 30)]):
        fb = package.Framebuffer(12, 12, 8)
        for part in ([corners[0], *cut, corners[3]], [cut[0], corners[1], corners[2], cut[1]]):
            fb.poly(0, 0, part, 200, fill=True, op="add", antialias=package.ConeFilter(1, filter))
        # Each part is rounded to a whole level.
        assert abs(fb.pixels.astype(int) - 200).max() <= 1


EDGES = [0, 5, 2**13, 2**14, 2**17, 2**18, 2**26, 2**31, 2**40, 2**62, 2**63, 2**70]
edges = st.builds(
    lambda edge, step, sign: sign * edge + step, st.sampled_from(EDGES), st.integers(-2, 9), st.sampled_from([1, -1])
)
numbers = st.one_of(st.integers(-20, 30), edges, st.floats(-20, 30))
sizes = numbers.map(abs)
far_paths = st.lists(st.tuples(numbers, numbers), min_size=2, max_size=6)
thick = sizes.filter(lambda width: width >= 1)
angles = st.integers(-400, 400)

calls = st.one_of(
    st.tuples(st.just("poly"), st.tuples(numbers, numbers, far_paths), st.fixed_dictionaries({"fill": st.just(True)})),
    st.tuples(
        st.just("polyline"),
        st.tuples(far_paths),
        st.fixed_dictionaries({"width": thick, "join": st.sampled_from(["miter", "bevel"]), "closed": st.booleans()}),
    ),
    st.tuples(
        st.just("rect"), st.tuples(numbers, numbers, sizes, sizes), st.fixed_dictionaries({"fill": st.booleans()})
    ),
    st.tuples(
        st.just("round_rect"),
        st.tuples(numbers, numbers, sizes, sizes, sizes),
        st.fixed_dictionaries({"fill": st.booleans(), "width": thick}),
    ),
    st.tuples(
        st.just("circle"),
        st.tuples(numbers, numbers, sizes),
        st.fixed_dictionaries({"fill": st.booleans(), "width": thick}),
    ),
    st.tuples(
        st.just("ellipse"),
        st.tuples(numbers, numbers, sizes, sizes),
        st.fixed_dictionaries({"fill": st.booleans(), "width": thick, "quadrants": st.integers(0, 15)}),
    ),
    st.tuples(
        st.just("arc"), st.tuples(numbers, numbers, sizes, angles, angles), st.fixed_dictionaries({"width": thick})
    ),
    st.tuples(
        st.just("sector"),
        st.tuples(numbers, numbers, sizes, angles, angles),
        st.fixed_dictionaries({"fill": st.booleans(), "width": thick}),
    ),
)


@examples(6)
@given(calls)
def test_numbers_of_any_size(package, call):
    """Where the samples of a pixel and of all its neighbors say the same, so does the filter."""
    name, arguments, style = call
    sampled, filtered = package.Framebuffer(12, 9, 8), package.Framebuffer(12, 9, 8)
    getattr(sampled, name)(*arguments, antialias=package.Supersample(16), **style)
    getattr(filtered, name)(*arguments, antialias=package.ConeFilter(), **style)
    around = np.lib.stride_tricks.sliding_window_view(sampled.pixels, (3, 3))
    seen = filtered.pixels[1:-1, 1:-1]
    # Between two rows of samples a 16th of a pixel may remain unseen.
    assert (seen[around.min((2, 3)) == 255] >= 238).all()
    assert (seen[around.max((2, 3)) == 0] <= 17).all()
