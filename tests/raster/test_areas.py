"""What fills and rings of all shapes have in common: their size, their outline, their neighbors, their brightness."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from searching import examples

WIDTH, HEIGHT = 24, 18


# -- Half pixels


@pytest.mark.parametrize("size", [2, 3, 4, 5, 9, 10, 16])
def test_a_disc_of_any_diameter_by_the_default_call(package, size):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    middle = (size - 1) / 2
    fb.circle(middle, middle, middle, fill=True)
    rows, columns = fb.pixels.any(1).nonzero()[0], fb.pixels.any(0).nonzero()[0]
    assert (rows.tolist(), columns.tolist()) == (list(range(size)), list(range(size)))
    disc = fb.pixels[:size, :size]
    for turned in (disc[::-1], disc[:, ::-1], disc.T):
        assert (disc == turned).all()


half_shapes = [
    ("circle", (0.5, 0.5, 4.5)),
    ("ellipse", (0.5, 0.5, 5.5, 3.5)),
    ("sector", (0.5, 0.5, 4.5, 0, 180)),
    ("arc", (0.5, 0.5, 4.5, 0, 180)),
]


@pytest.mark.parametrize("fill", [False, True])
@pytest.mark.parametrize(("name", "arguments"), half_shapes)
@pytest.mark.parametrize("antialias", ["Supersample", "ConeFilter"])
def test_anti_aliased_shapes_lie_between_pixels(package, name, arguments, antialias, fill):
    """Around a center between two columns the picture is its own mirror image, and no pixel is the middle one."""
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=8, antialias=getattr(package, antialias)())
    x, y, *others = arguments
    options = {} if name == "arc" else {"fill": fill}
    getattr(fb, name)(x + 10, y + 8, *others, **options)
    assert fb.pixels[:, 10].any()
    # One reference point on an edge belongs to one side only.
    off = fb.pixels[:, :22].astype(int) - fb.pixels[:, 21::-1]
    assert abs(off).max() <= (0 if antialias == "ConeFilter" else 255 // 16 + 1)
    assert (fb.pixels[:, 22:] == 0).all()


@pytest.mark.parametrize("fill", [False, True])
@pytest.mark.parametrize("antialias", ["Supersample", "ConeFilter"])
def test_an_anti_aliased_round_rect_lies_between_pixels(package, antialias, fill):
    """Half a pixel further it covers half of the column before its first one and half of the one behind its last."""
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=8, antialias=getattr(package, antialias)())
    fb.round_rect(4.5, 3, 9, 9, 2.5, fill=fill)
    middle = fb.pixels[7].tolist()
    assert middle[4:14] == middle[13:3:-1]
    assert abs(middle[4] - 128) <= 1
    if antialias == "Supersample":
        assert middle[3] == middle[14] == 0


# -- A filled shape is at least its outline

numbers = st.one_of(st.integers(-6, 26), st.integers(-12, 52).map(lambda v: v / 2), st.floats(-6, 26))
sizes = numbers.map(abs)
angles = st.integers(-400, 400)
points = st.lists(st.tuples(numbers, numbers), min_size=1, max_size=6)
filled = {
    "rect": st.tuples(numbers, numbers, sizes, sizes),
    "round_rect": st.tuples(numbers, numbers, sizes, sizes, sizes),
    "circle": st.tuples(numbers, numbers, sizes),
    "ellipse": st.tuples(numbers, numbers, sizes, sizes),
    "sector": st.tuples(numbers, numbers, sizes, angles, angles),
    "triangle": st.tuples(*[numbers] * 6),
    "poly": st.tuples(numbers, numbers, points),
}


@pytest.mark.parametrize("name", filled)
@examples(3)
@given(st.data())
def test_a_filled_shape_is_at_least_its_outline(package, name, data):
    arguments = data.draw(filled[name])
    options = {"quadrants": data.draw(st.integers(0, 15))} if name == "ellipse" else {}
    outline, whole = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    getattr(outline, name)(*arguments, **options)
    getattr(whole, name)(*arguments, fill=True, op="xor", **options)
    assert (outline.pixels <= whole.pixels).all()


@pytest.mark.parametrize("rule", ["even-odd", "nonzero"])
@pytest.mark.parametrize("op", ["xor", "add"])
@given(points)
def test_covered_pixels_are_painted_once(package, op, rule, corners):
    over, other = package.Framebuffer(WIDTH, HEIGHT, 4), package.Framebuffer(WIDTH, HEIGHT, 4)
    over.poly(0, 0, corners, 5, fill=True, rule=rule)
    other.poly(0, 0, corners, 5, fill=True, rule=rule, op=op)
    assert over == other


whole_numbers = st.integers(-3, 26)


@given(*[st.tuples(whole_numbers, whole_numbers)] * 4)
def test_triangles_with_shared_edges_share_no_pixel_and_leave_none(package, a, b, c, d):
    """Two triangles on either side of a line from a to b are the one they make up, cut at d on its far side."""
    (ax, ay), (bx, by) = a, b
    side = [(bx - ax) * (y - ay) - (by - ay) * (x - ax) for x, y in (c, d)]
    assume(side[0] * side[1] < 0)
    summed, quad = package.Framebuffer(WIDTH, HEIGHT, 2), package.Framebuffer(WIDTH, HEIGHT, 2)
    for corner in (c, d):
        summed.triangle(*a, *b, *corner, 1, True, edges="shared", op="add")
    assert summed.pixels.max(initial=0) <= 1
    quad.poly(0, 0, [a, c, b, d], 1, fill=True, edges="shared")
    assert summed == quad


# -- Equally bright at every angle


ANTIALIASINGS = [*(("Supersample", n) for n in (4, 5, 6, 8, 16)), ("ConeFilter", 1.0), ("ConeFilter", 1.5)]


@pytest.mark.parametrize("radius", [20, 33.5, 60])
@pytest.mark.parametrize(
    ("antialias", "width"),
    [
        (one, width)
        for one in ANTIALIASINGS
        for width in (1, 1.5, 2, 3)
        if one[0] == "ConeFilter" or one[1] * width % 1 == 0
    ],
)
def test_a_ring_is_equally_bright_at_every_angle(package, radius, width, antialias):
    """Its coverage is its area, a width times the length of the arc, within 3 %, wherever one looks.

    One looks at ten pixels to either side, at the outer ones less and less: none counts for much that is cut in two.
    Widths are of whole sub-pixels: of 7.5, a piece that is nearly straight and level holds 7 or 8.
    """
    kind, value = antialias
    side = 2 * int(radius) + 12
    middle = side / 2 + 0.25
    fb = package.Framebuffer(side, side, depth=8, antialias=getattr(package, kind)(value))
    fb.circle(middle, middle, radius, width=width)
    rows, columns = fb.pixels.nonzero()
    reach = np.degrees(10 / radius)
    angles = np.degrees(np.arctan2(rows - middle, columns - middle))
    for middle_angle in range(0, 360, 5):
        away = abs((angles - middle_angle + 180) % 360 - 180)
        seen = (fb.pixels[rows, columns] / 255 * np.maximum(1 - away / reach, 0)).sum()
        assert abs(seen / (10 * width) - 1) < 0.03
