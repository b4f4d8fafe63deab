"""Thick polylines, against the union of their rectangles, joins and caps; how paths of all kinds meet themselves."""

from __future__ import annotations

import definitions
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from searching import examples
from stroke_definitions import HEIGHT, ROUNDING, WIDTH, counted, stroke, stroke_bounds

from paneldraw.testing import assert_pattern

whole = st.integers(-3, 15)
quarters = st.integers(-12, 60).map(lambda v: v / 4)
in_256ths = st.integers(-3 * 256, 15 * 256).map(lambda v: v / 256)
paths = st.one_of(
    *[st.lists(st.tuples(number, number), min_size=1, max_size=5) for number in (whole, quarters, in_256ths)]
)
widths = st.one_of(st.integers(1, 8), st.integers(64, 8 * 256).map(lambda v: v / 256))
joins = st.sampled_from(["miter", "round", "bevel"])
caps = st.sampled_from(["butt", "square", "round"])
references = st.sampled_from(["center", "corner"])
samples = st.tuples(st.sampled_from([1, 2, 4]), references)


def drawn(points, width, **options):
    """What `counted` draws."""
    return lambda fb, level, antialias: fb.polyline(points, level, width=width, antialias=antialias, **options)


def assert_between(bounds, counts):
    least, most = bounds
    assert (least <= counts).all()
    assert (counts <= most).all()


def has_even_joins(points, closed):
    """Whether no corner is so near to the miter limit that rounding decides."""
    points = [point for i, point in enumerate(points) if i == 0 or point != points[i - 1]]
    steps = [complex(b[0] - a[0], b[1] - a[1]) for a, b in zip(points, points[1:] + points[:1], strict=True)]
    steps = [step for step in (steps if closed else steps[:-1]) if step]
    turns = zip(steps, steps[1:] + steps[:1], strict=True)
    return all(abs((a * b.conjugate()).real / abs(a) / abs(b) + 7 / 8) > 1e-6 for a, b in turns)


@pytest.mark.parametrize("join", ["miter", "round", "bevel"])
@examples(1.2)
@given(paths, widths, caps, st.booleans(), samples)
@example([(2, 2), (10, 2), (10, 7)], 3, "butt", False, (4, "center"))
@example([(2, 2), (10, 2), (2, 3)], 3, "square", False, (4, "center"))  # beyond the miter limit
@example([(2, 4), (10, 4), (4, 4)], 3, "round", False, (4, "center"))  # and straight back
@example([(2, 2), (2, 2), (10, 7), (10, 7), (2, 2)], 3, "round", True, (2, "corner"))
@example([(6, 4)], 5, "round", True, (4, "center"))
@example([(6, 4), (6, 4)], 5, "butt", False, (4, "center"))
def test_strokes_are_rectangles_joins_and_caps(package, join, points, width, cap, closed, samples):
    assume(has_even_joins(points, closed))
    counts = counted(package, drawn(points, width, join=join, cap=cap, closed=closed), *samples)
    assert_between(stroke_bounds(stroke(points, width, join, cap, closed), *samples), counts)


@st.composite
def pythagorean_paths(draw):
    """Corners whose normals end in halves of 256ths: where rounding has to choose."""
    points = [(draw(st.integers(500, 2500)), draw(st.integers(500, 1800)))]
    for _ in range(draw(st.integers(1, 2))):
        dx, dy = draw(st.permutations([3, 4])), draw(st.tuples(*[st.sampled_from([-1, 1])] * 2))
        length = draw(st.integers(100, 300))
        points.append(tuple(p + length * d * s for p, d, s in zip(points[-1], dx, dy, strict=True)))
    return [(x / 256, y / 256) for x, y in points]


@examples(0.8)
@given(pythagorean_paths(), st.integers(200, 500).map(lambda k: 5 * (2 * k + 1) / 256), joins, caps)
@example([(4, 3.5), (7, 7.5)], 2005 / 256, "round", "round")
def test_there_is_no_seam_where_pieces_meet(package, points, width, join, cap):
    """At 15 x 15 reference points a pixel a sliver between two pieces would not stay unseen."""
    counts = counted(package, drawn(points, width, join=join, cap=cap), 15)
    assert_between(stroke_bounds(stroke(points, width, join, cap), 15, "center"), counts)


@examples(0.6)
@given(st.lists(st.tuples(in_256ths, in_256ths), min_size=2, max_size=5), widths, joins, caps)
def test_nor_anywhere_else(package, points, width, join, cap):
    assume(has_even_joins(points, False))
    counts = counted(package, drawn(points, width, join=join, cap=cap), 15)
    assert_between(stroke_bounds(stroke(points, width, join, cap), 15, "center"), counts)


@given(st.tuples(*[in_256ths] * 4), widths, st.sampled_from(["butt", "square"]), samples)
@example((0, 0, 0, 0), 625 / 256, "square", (15, "center"))
def test_a_polyline_of_two_points_is_the_line_up_to_rounding(package, ends, width, cap, samples):
    points = [ends[:2], ends[2:]]
    assert_between(
        stroke_bounds(stroke(points, width, cap=cap), *samples),
        definitions.rectangle(WIDTH, HEIGHT, *ends, width, cap, *samples),
    )
    counts = counted(package, drawn(points, width, cap=cap), *samples)
    assert_between(stroke_bounds(stroke(points, width, cap=cap), *samples), counts)


@given(st.tuples(*[st.one_of(whole, in_256ths, st.integers(-(2**70), 2**70))] * 4))
def test_and_a_thin_one_exactly(package, ends):
    pictures = []
    for points in ([ends[:2], ends[2:]], [ends[:2], ends[2:], ends[2:]], [ends[2:], ends[:2]]):
        fb = package.Framebuffer(WIDTH, HEIGHT)
        fb.polyline(points)
        pictures.append(fb.pixels)
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.line(*ends)
    assert all((picture == fb.pixels).all() for picture in pictures)


@given(st.tuples(*[in_256ths] * 4), widths, samples)
def test_round_caps_of_a_line(package, ends, width, samples):
    def draw(fb, level, antialias):
        fb.line(*ends, level, width=width, cap="round", antialias=antialias)

    assert_between(
        stroke_bounds(stroke([ends[:2], ends[2:]], width, cap="round"), *samples), counted(package, draw, *samples)
    )


# -- Each pixel once


@given(paths, st.one_of(st.just(1), widths), joins, caps, st.booleans(), st.sampled_from([None, 1, 4]))
@example([(2, 2), (9, 7), (9, 2), (2, 7)], 1, "miter", "square", True, None)
def test_a_pixel_is_painted_once(package, points, width, join, cap, closed, n):
    """So xor on blank pixels equals over, twice it is nothing, and add adds once."""
    style = {"width": width, "join": join, "cap": cap, "closed": closed, "antialias": n and package.Supersample(n)}
    over, xor, add = (package.Framebuffer(WIDTH, HEIGHT, depth=8) for _ in range(3))
    over.polyline(points, 100, **style)
    xor.polyline(points, 100, **style, op="xor")
    add.polyline(points, 100, **style, op="add")
    assert (xor.pixels == over.pixels).all()
    assert (add.pixels == over.pixels).all()
    xor.polyline(points, 100, **style, op="xor")
    assert not xor.pixels.any()


# -- From far away


@st.composite
def arms(draw):
    """The directions of two arms of a corner, not so far apart that the side between their ends comes near again."""
    (a, b), (c, d) = (draw(st.tuples(*[st.integers(-9, 9)] * 2).filter(any)) for _ in range(2))
    assume(a * c + b * d >= -0.8 * np.hypot(a, b) * np.hypot(c, d))
    return (a, b), (c, d)


@pytest.mark.parametrize("reach", [2**15, 2**20, 2**40, 2**63, 2**70])
@examples(0.4)
@given(
    arms(),
    st.tuples(whole, whole),
    st.integers(1, 8),
    joins,
    caps,
    st.sampled_from(["first", "second", "loop"]),
    samples,
)
@example(((2, -1), (3, 4)), (10, 10), 8, "miter", "butt", "loop", (2, "center"))  # just beyond, nothing to cut
def test_strokes_from_far_away(package, reach, arms, corner, width, join, cap, place, samples):
    """A corner in the picture, whose arms reach far out of it; in floating point their beginnings will do."""
    (ax, ay), (bx, by) = ((corner[0] + reach * dx, corner[1] + reach * dy) for dx, dy in arms)
    nearer = [(corner[0] + 512 * dx, corner[1] + 512 * dy) for dx, dy in arms]
    points = [corner, (ax, ay), (bx, by)] if place != "second" else [(ax, ay), corner, (bx, by)]
    assume(has_even_joins([nearer[0], corner, nearer[1]], False))
    pieces = stroke([corner, nearer[0]], width, cap=cap)
    if place == "second":
        pieces = stroke([nearer[0], corner, nearer[1]], width, join)
    elif place == "loop":
        pieces = stroke([nearer[1], corner, nearer[0]], width, join)
    counts = counted(package, drawn(points, width, join=join, cap=cap, closed=place == "loop"), *samples)
    # If both arms are one, the side between their ends lies on it.
    if (ax - corner[0]) * (by - corner[1]) != (ay - corner[1]) * (bx - corner[0]) or place == "second":
        assert_between(stroke_bounds(pieces, *samples, tolerance=2 * ROUNDING), counts)


def test_a_far_closed_path_is_joined_where_it_begins(package):
    far, near = (package.Framebuffer(40, 40) for _ in range(2))
    far.polyline([(8, 8), (2**40, 8 + 2**39), (8, 2**40)], closed=True, width=5, join="round")
    near.polyline([(8, 8), (2**16, 8 + 2**15), (8, 2**16)], closed=True, width=5, join="round")
    assert far.pixels.any()
    assert (far.pixels == near.pixels).all()


def test_joins_and_caps_as_pictures(package):
    fb = package.Framebuffer(27, 11)
    for x, join, cap in ((2, "miter", "butt"), (11, "round", "round"), (20, "bevel", "square")):
        fb.polyline([(x, 8), (x, 2), (x + 4, 6)], width=3, join=join, cap=cap)
    assert_pattern(
        fb,
        """
        .##........................
        .###......###........#.....
        .####.....####.....####....
        .#####....#####....#####...
        .######...######...######..
        .######...#######..#######.
        .#####....#######..########
        .###......###.###..###.###.
        ..........###......###..#..
        ..........###......###.....
        ...........................
        """,
    )


# -- What is wrong


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"points": np.zeros((2, 2, 2))}, ValueError, r"points must hold points"),
        ({"cap": "flat"}, ValueError, r"cap must be one of 'butt', 'square', 'round', not 'flat'"),
        ({"cap": []}, ValueError, r"cap must be one of"),
        ({"join": 1}, ValueError, r"join must be one of"),
        ({"op": None}, ValueError, r"op must be one of"),
        ({"width": 0}, ValueError, r"width must be at least 1/256"),
        ({"width": -3}, ValueError, r"width must be at least 1/256"),
        ({"width": float("nan")}, ValueError, r"width must be finite"),
        ({"width": "1"}, TypeError, r"width must be a number"),
        ({"dash": float("nan")}, TypeError, r"dash must be a sequence"),
        ({"dash": (3, float("nan"))}, ValueError, r"dash must be finite"),
        ({"dash": []}, ValueError, r"dash must hold lengths of 1 pixel or more"),
        ({"c": -1}, ValueError, r"c must be a level"),
    ],
)
def test_what_is_wrong_is_named(package, change, error, message):
    fb = package.Framebuffer(8, 8)
    with pytest.raises(error, match=message):
        fb.polyline(**{"points": [(1, 1), (6, 6)], **change})
    if not change.keys() & {"points", "join"}:
        with pytest.raises(error, match=message):
            fb.line(1, 1, 6, 6, **change)
        with pytest.raises(error, match=message):
            fb.lines([(1, 1, 6, 6)], **change)
    assert not fb.pixels.any()
