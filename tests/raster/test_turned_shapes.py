"""Ellipses and rectangles at an angle, and arcs of ellipses, against reference points and points of the true curves."""

from __future__ import annotations

import curve_definitions
import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from searching import examples
from stroke_definitions import HEIGHT, WIDTH, counted, lattice, per_pixel

places = st.tuples(st.integers(0, 12 * 256), st.integers(0, 8 * 256)).map(lambda v: (v[0] / 256, v[1] / 256))
radii = st.integers(256, 7 * 256).map(lambda v: v / 256)
angles = st.one_of(st.integers(-400, 400), st.floats(-180, 540))
widths = st.integers(128, 5 * 256).map(lambda v: v / 256)
samples = st.tuples(st.sampled_from([1, 2, 4]), st.sampled_from(["center", "corner"]))

# Radii and edges may be rounded by half a 256th, points and corners besides.
OFF = 1.5 / 256


def turned(x, y, angle, n, reference):
    """Reference points as an unturned shape around (x, y) sees them."""
    xs, ys = (axis.astype(float) / (512 * n) for axis in lattice(n, reference, (WIDTH, HEIGHT)))
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    return (xs - x) * c + (ys - y) * s, (ys - y) * c - (xs - x) * s


def assert_between(shape, package, draw, n, reference):
    """`shape` says of a distance which points are in, that much further or less far out."""
    counts = counted(package, draw, n, reference)
    assert (per_pixel(shape(-OFF), n) <= counts).all()
    assert (counts <= per_pixel(shape(OFF), n)).all()


@examples(0.6)
@given(places, radii, radii, angles, widths, st.booleans(), samples)
@example((6, 4), 5, 2, 30, 1, True, (4, "center"))
def test_an_ellipse_lies_between_two(package, place, a, b, angle, width, fill, samples):
    u, v = turned(*place, angle, *samples)

    def disc(beyond):
        p, q = a + beyond, b + beyond
        return (u / p) ** 2 + (v / q) ** 2 <= 1 if p > 0 and q > 0 else np.zeros(u.shape, bool)

    def ring(off):
        return disc(width / 2 + off) & ~(disc(-width / 2 - off) if not fill else disc(-99))

    def draw(fb, level, antialias):
        fb.ellipse(*place, a, b, level, fill, angle=angle, width=width, antialias=antialias)

    assert_between(ring, package, draw, *samples)


@examples(0.6)
@given(places, radii, radii, angles, widths, st.booleans(), samples)
def test_a_rectangle_lies_between_two(package, place, w, h, angle, width, fill, samples):
    u, v = turned(place[0] + (w - 1) / 2, place[1] + (h - 1) / 2, angle, *samples)

    def disc(beyond):
        return (abs(u) <= (w - 1) / 2 + beyond) & (abs(v) <= (h - 1) / 2 + beyond)

    def ring(off):
        return disc(width / 2 + off) & ~(disc(-width / 2 - off) if not fill else disc(-99))

    def draw(fb, level, antialias):
        fb.rect(*place, w, h, level, fill, angle=angle, width=width, antialias=antialias)

    assume(w > 1.1 and h > 1.1)
    assert_between(ring, package, draw, *samples)


@pytest.mark.parametrize("fill", [False, True])
@pytest.mark.parametrize("name", ["rect", "ellipse"])
def test_quarter_and_half_turns_are_the_shape_itself(package, name, fill):
    straight, half, quarter = (package.Framebuffer(21, 21) for _ in range(3))
    box, swapped = ((5, 7, 11, 7), (7, 5, 7, 11)) if name == "rect" else ((10, 10, 5, 3), (10, 10, 3, 5))
    getattr(straight, name)(*box, fill=fill)
    getattr(half, name)(*box, fill=fill, angle=-180.0)
    getattr(quarter, name)(*swapped, fill=fill, angle=90)
    assert (half.pixels == straight.pixels).all()
    if name == "rect":
        assert (quarter.pixels == straight.pixels).all()


@examples(0.6)
@given(places, radii, radii, angles, st.integers(10, 350), widths, samples)
def test_an_elliptical_arc_lies_between_two_directions(package, place, a, b, start, swept, width, samples):
    x, y = place
    curve = curve_definitions.ellipse(0, 0, a, b)
    from_start = (np.degrees(np.arctan2(curve[:, 1], curve[:, 0])) - start) % 360
    part = curve[from_start <= swept]
    # In order from the start on.
    part = part[np.argsort(from_start[from_start <= swept])] + (x, y)
    ends = np.radians([start, start + swept])
    reach = 1 / np.hypot(np.cos(ends) / a, np.sin(ends) / b)
    ends = np.stack([x + reach * np.cos(ends), y + reach * np.sin(ends)], axis=1)
    least, most = curve_definitions.near(np.concatenate([ends[:1], part, ends[1:]]), width / 2, *samples)

    def draw(fb, level, antialias):
        fb.arc(*place, a, start, start + swept, level, yr=b, width=width, cap="round", antialias=antialias)

    # Joins are miters of next to no angle.
    counts = counted(package, draw, *samples)
    assert (least <= counts).all()
    assert (counts <= most).all()


@given(places, radii, radii, angles, st.sampled_from([1, 2.5]), st.booleans())
def test_a_pixel_is_painted_once(package, place, a, b, angle, width, fill):
    for n in (None, 3):
        over, xor, add = (package.Framebuffer(WIDTH, HEIGHT, depth=8) for _ in range(3))
        for fb, op in ((over, "over"), (xor, "xor"), (add, "add")):
            style = {"width": width, "antialias": n and package.Supersample(n), "op": op}
            fb.ellipse(*place, a, b, 100, fill, angle=angle, **style)
        assert (xor.pixels == over.pixels).all()
        assert (add.pixels == over.pixels).all()
        for fb, op in ((over, "over"), (xor, "xor"), (add, "add")):
            style = {"width": width, "antialias": n and package.Supersample(n), "op": op}
            fb.clear()
            fb.rect(*place, a, b, 100, fill, angle=angle, **style)
            fb.view(0, 0, 3, 9).arc(*place, a, angle, angle + 200, 10, yr=b, **style)
        assert (add.pixels >= over.pixels).all()


@pytest.mark.parametrize("width", [1, 3])
@pytest.mark.parametrize("reach", [2**18, 2**40, 2**60])
def test_from_far_away(package, reach, width):
    """What is seen of so large a shape is a half plane or a line through the middle."""
    ellipse, rect, arc, line = (package.Framebuffer(15, 15) for _ in range(4))
    ellipse.ellipse(7 + reach, 7, reach, reach // 2, angle=360, width=width)
    rect.rect(7, 7 - reach, 2 * reach, 2 * reach, angle=180, width=width)
    arc.arc(7 + reach, 7, reach, 90, 270, yr=2 * reach, width=width)
    line.line(7, -99, 7, 99, width=width)
    for fb in (ellipse, rect, arc):
        assert (fb.pixels == line.pixels).all()
    slanted = package.Framebuffer(15, 15)
    slanted.rect(8 - reach, 7.5 - reach, 2 * reach, 2 * reach, angle=45, width=width)
    slanted.ellipse(7, 7, reach, reach / 3, angle=12)
    assert not slanted.pixels.any()


def test_what_is_wrong_is_named(package):
    fb = package.Framebuffer(8, 8)
    with pytest.raises(ValueError, match="angle must be finite"):
        fb.rect(1, 1, 3, 3, angle=float("nan"))
    with pytest.raises(TypeError, match="angle must be a number"):
        fb.ellipse(1, 1, 3, 3, angle="45")
    with pytest.raises(ValueError, match="quadrants must be 15"):
        fb.ellipse(1, 1, 3, 3, quadrants=1, angle=45)
    for name in ("xr", "yr"):
        with pytest.raises(ValueError, match=f"{name} must not be negative"):
            fb.ellipse(**{"x": 1, "y": 1, "xr": 3, "yr": 3, name: -1}, angle=45)
    for name in ("w", "h"):
        with pytest.raises(ValueError, match=f"{name} must not be negative"):
            fb.rect(**{"x": 1, "y": 1, "w": 3, "h": 3, name: -1}, angle=45)
    with pytest.raises(ValueError, match="yr must not be negative"):
        fb.arc(1, 1, 3, 0, 90, yr=-1)
    assert not fb.pixels.any()
