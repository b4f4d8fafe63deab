"""Round shapes, wide or supersampled, against counting the reference points inside the true shape."""

from __future__ import annotations

from math import cos, radians, sin

import numpy as np
import pytest
import round_definitions as definitions
from definitions import REACH
from hypothesis import example, given
from hypothesis import strategies as st
from searching import examples

WIDTH, HEIGHT = 13, 9
UNIT = 2**27  # the length of the vectors that angles stand for

in_256ths = st.integers(-4 * 256, 16 * 256).map(lambda v: v / 256)
# Halves and quarters: where reference points fall on edges.
coarse = st.integers(-16, 64).map(lambda v: v / 4)
coordinates = st.one_of(st.integers(-4, 16), coarse, in_256ths)
lengths = st.one_of(st.integers(0, 10), coarse.map(abs), in_256ths.map(abs))
widths = st.one_of(st.just(1), st.integers(1, 6), st.integers(1, 8 * 256).map(lambda v: v / 256))
few_samples = st.tuples(st.sampled_from([1, 2, 3, 4]), st.sampled_from(["center", "corner"]))
many_samples = st.tuples(st.integers(5, 16), st.sampled_from(["center", "corner"]))
angles = st.one_of(
    st.sampled_from([0, 30, 45, 60, 90, 135, 180, 225, 270, 300, 315, 359.5]),
    st.integers(-720, 720),
    st.floats(-400, 400),
)


class Drawing:
    """Draws on a small framebuffer and reads counts of reference points off the levels of an eight-bit picture."""

    def __init__(self, package, samples):
        self.n, self.reference = samples
        self.fb = package.Framebuffer(WIDTH, HEIGHT, depth=8)
        self.antialias = package.Supersample(*samples)

    # Of 16 x 16 points one level is lost, that of the last.
    def __call__(self, name, *arguments, **options):
        self.fb.clear()
        level = min(self.n * self.n, 255)
        getattr(self.fb, name)(*arguments, level, antialias=self.antialias, **options)
        return self.fb.pixels.copy()

    def assert_counted(self, drawn, numbers, *arguments, **options):
        """Compare with the least and the most that may be counted of what a call's numbers say."""
        off = int(max(map(abs, numbers)) > REACH)
        least, most = definitions.band(
            WIDTH, HEIGHT, *arguments, n=self.n, reference=self.reference, off=off, **options
        )
        if self.n == 16:
            least, most = ((counts * 510 + 256) // 512 for counts in (least, most))
        assert (least <= drawn).all()
        assert (drawn <= most).all()


def vectors(start, end, unit):
    """What angles stand for: vectors of a length that is rounded to whole numbers."""
    return *(tuple(round(unit * part) for part in directed(angle)) for angle in (start, end)), (end - start) % 360, unit


def directed(angle):
    quarters = round(angle / 90)
    rest = radians(angle - 90 * quarters)
    x, y = cos(rest), sin(rest)
    return [(x, y), (-y, x), (-x, -y), (y, -x)][quarters % 4]


def assert_circle(package, samples, x, y, r, width, fill):
    draw = Drawing(package, samples)
    drawn = draw("circle", x, y, r, width=width, fill=fill)
    draw.assert_counted(drawn, (x, y, r), (x, y, x, y), (r, r), width, fill=fill)


def assert_ellipse(package, samples, x, y, xr, yr, width, fill, quadrants):
    draw = Drawing(package, samples)
    drawn = draw("ellipse", x, y, xr, yr, width=width, fill=fill, quadrants=quadrants)
    cut = definitions.quadrants(quadrants)
    draw.assert_counted(drawn, (x, y, xr, yr), (x, y, x, y), (xr, yr), width, fill=fill, cut=cut)


def assert_turn(package, samples, x, y, r, start, end, width, shape):
    draw = Drawing(package, samples)
    cut = (definitions.sector_outline if shape == "sector" else definitions.wedge)(*vectors(start, end, UNIT))
    fill = shape == "slice"
    drawn = draw(
        "arc" if shape == "arc" else "sector", x, y, r, start, end, width=width, **({"fill": True} if fill else {})
    )
    draw.assert_counted(drawn, (x, y, r), (x, y, x, y), (r, r), width, fill=fill, cut=cut)


def assert_round_rect(package, samples, x, y, w, h, r, width, fill):
    draw = Drawing(package, samples)
    drawn = draw("round_rect", x, y, w, h, r, width=width, fill=fill)
    if definitions.fixed(w) == 0 or definitions.fixed(h) == 0:
        assert not drawn.any()
        return
    numbers = x, y, w, h, r
    x, y, w, h, r = map(definitions.fixed, numbers)
    r = max(0, min(r, (w - 256) // 2, (h - 256) // 2))
    box = [definitions.definitions.Fraction(value, 256) for value in (x + r, y + r, x + w - 256 - r, y + h - 256 - r)]
    r = definitions.definitions.Fraction(r, 256)
    draw.assert_counted(drawn, numbers, box, (r, r), width, fill=fill, sharp=r == 0)


@given(few_samples, coordinates, coordinates, lengths, widths, st.booleans())
@example((1, "center"), 6, 4, 5, 2, False)  # 3-4-5: pixel centers on the edge
@example((1, "center"), 6, 4, 4.5, 1, True)
@example((2, "corner"), 6, 4, 2.5, 5, False)
@example((4, "center"), 6, 4, 0, 1, True)
def test_circles_equal_counting(package, samples, x, y, r, width, fill):
    assert_circle(package, samples, x, y, r, width, fill)


@given(few_samples, coordinates, coordinates, lengths, lengths, widths, st.booleans(), st.integers(0, 15))
@example((1, "center"), 6, 4, 5.5, 3.5, 1, False, 15)
@example((1, "corner"), 6, 4, 9.5, 2.5, 1, True, 15)
@example((4, "center"), 6, 4, 5, 0, 1, True, 15)
@example((4, "center"), 6, 4, 0, 3, 2, False, 5)
@example((3, "center"), 6, 4, 4, 4, 1, True, 10)
def test_ellipses_equal_counting(package, samples, x, y, xr, yr, width, fill, quadrants):
    assert_ellipse(package, samples, x, y, xr, yr, width, fill, quadrants)


shapes = st.sampled_from(["arc", "slice", "sector"])


@examples(2)
@given(few_samples, coordinates, coordinates, lengths, angles, angles, widths, shapes)
@example((1, "center"), 6, 4, 4, 0, 90, 1, "slice")
@example((1, "center"), 6, 4, 4, 90, 0, 1, "slice")
@example((1, "center"), 6, 4, 4, 0, 180, 1, "slice")
@example((1, "center"), 6, 4, 4, 45, 225, 2, "sector")
@example((2, "corner"), 6, 4, 4, 180, 0, 1, "arc")
@example((2, "corner"), 6, 4, 4, 30, 30, 1, "sector")
@example((2, "center"), 6, 4, 0.5, 30, 20, 3, "sector")
def test_arcs_and_sectors_equal_counting(package, samples, x, y, r, start, end, width, shape):
    if end - start < 360:
        assert_turn(package, samples, x, y, r, start, end, width, shape)


@given(few_samples, coordinates, coordinates, lengths, lengths, lengths, widths, st.booleans())
@example((1, "center"), 1, 1, 9, 7, 3, 1, False)
@example((4, "center"), 1, 1, 9, 7, 0, 1, False)
@example((4, "center"), 1, 1, 9, 7, 1, 4, False)
@example((4, "center"), 1, 1, 0.5, 7, 1, 1, True)
def test_rounded_rectangles_equal_counting(package, samples, x, y, w, h, r, width, fill):
    assert_round_rect(package, samples, x, y, w, h, r, width, fill)


@examples(0.2)
@given(many_samples, coordinates, coordinates, lengths, lengths, angles, widths, st.booleans())
def test_many_samples_equal_counting(package, samples, x, y, xr, yr, start, width, fill):
    assert_circle(package, samples, x, y, xr, width, fill)
    assert_ellipse(package, samples, x, y, xr, yr, width, fill, 15)
    assert_turn(package, samples, x, y, xr, start, start + 210, width, "slice" if fill else "sector")
    assert_round_rect(package, samples, x, y, xr, yr, 2, width, fill)


@st.composite
def passing_circles(draw, radius):
    """Circles of which the edge passes through or near the window; an angle at which it does."""
    r = draw(st.integers(radius // 2, 2 * radius))
    across = draw(st.integers(-r, r))
    along = draw(st.sampled_from([1, -1])) * int((r * r - across * across) ** 0.5)
    along, across = draw(st.permutations([along, across]))
    return draw(st.integers(0, WIDTH)) - along, draw(st.integers(0, HEIGHT)) - across, r


@pytest.mark.parametrize("radius", [300, 2**13, REACH // 3, 2**20, 2**63, 2**70])
@examples(0.3)
@given(st.data(), few_samples, widths, st.booleans(), angles)
def test_large_shapes_equal_counting(package, radius, data, samples, width, fill, start):
    x, y, r = data.draw(passing_circles(radius))
    assert_circle(package, samples, x, y, r, width, fill)
    assert_ellipse(package, samples, x, y, r, max(0, r + data.draw(st.integers(-9, 9))), width, fill, 13)
    w, h = data.draw(st.tuples(st.integers(0, 3 * radius), st.integers(0, 3 * radius)))
    assert_round_rect(package, samples, x, y, w, h, r // 3, width, fill)
    end = start + data.draw(st.sampled_from([1e-6, 90, 180, 300]))
    assert_turn(package, samples, x, y, r, start, end, width, data.draw(shapes))


@examples(0.4)
@given(st.sampled_from([REACH - 9, REACH - 7.5, REACH - 7, REACH + 1]), widths, few_samples, st.booleans())
def test_shapes_on_both_sides_of_what_is_cut_equal_counting(package, r, width, samples, fill):
    assert_circle(package, samples, 7 + r, 3, r, width, fill)
    assert_ellipse(package, samples, 7, 3 - r, r // 2, r, width, fill, 15)
    assert_turn(package, samples, 7 + r, 3, r, 100, 190, width, "slice" if fill else "arc")


@given(*[st.sampled_from([-(2**70), -(2**18) - 1, -(2**18), 3, 2**18, 2**18 + 1, 2**63])] * 2, st.integers(0, 2**19))
def test_shapes_around_far_centers(package, x, y, r):
    for fill in (False, True):
        assert_circle(package, (2, "center"), x, y, r, 1, fill)
        assert_round_rect(package, (2, "center"), x, y, 2**71, 2**71, r, 1, fill)
        assert_turn(package, (2, "center"), x, y, r, 10, 200, 1, "slice" if fill else "sector")


# -- What holds between shapes

antialiased = st.tuples(st.integers(1, 6), st.sampled_from(["center", "corner"]))
wholes = st.integers(-3, 14)


@given(antialiased, coordinates, coordinates, lengths, widths, st.booleans())
def test_a_circle_is_an_ellipse_and_a_turn(package, samples, x, y, r, width, fill):
    draw = Drawing(package, samples)
    circle = draw("circle", x, y, r, width=width, fill=fill)
    assert (draw("ellipse", x, y, r, r, width=width, fill=fill) == circle).all()
    assert (draw("sector", x, y, r, 20, 380, width=width, fill=fill) == circle).all()


@given(antialiased, wholes, wholes, st.integers(0, 7), st.booleans())
def test_a_rounded_square_with_no_straight_side_is_a_circle(package, samples, x, y, r, fill):
    draw = Drawing(package, samples)
    square = draw("round_rect", x - r, y - r, 2 * r + 1, 2 * r + 1, 99, fill=fill)
    assert r == 0 or (square == draw("circle", x, y, r, fill=fill)).all()


@given(antialiased, wholes, wholes, st.integers(0, 9), st.integers(0, 9), st.booleans())
def test_whole_rectangles_look_the_same_anti_aliased(package, samples, x, y, w, h, fill):
    plain = package.Framebuffer(WIDTH, HEIGHT, depth=4)
    smooth = package.Framebuffer(WIDTH, HEIGHT, depth=4, antialias=package.Supersample(*samples))
    for fb in (plain, smooth):
        fb.rect(x, y, w, h, fill=fill)
    assert plain == smooth


@given(antialiased, coordinates, coordinates, lengths, st.lists(st.floats(0, 359), min_size=2, max_size=5, unique=True))
def test_slices_that_go_around_are_the_disc(package, samples, x, y, r, cuts):
    draw = Drawing(package, samples)
    cuts.sort()
    parts = [
        draw("sector", x, y, r, start, end, fill=True) for start, end in zip(cuts, cuts[1:] + cuts[:1], strict=True)
    ]
    assert (sum(part.astype(int) for part in parts) == draw("circle", x, y, r, fill=True)).all()


@given(antialiased, coordinates, coordinates, lengths, lengths, widths)
def test_an_outline_and_what_it_encloses_are_the_filled_shape(package, samples, x, y, xr, yr, width):
    draw = Drawing(package, samples)
    whole = draw("ellipse", x, y, xr + width, yr + width, fill=True, width=width).astype(int)
    outline = draw("ellipse", x, y, xr + width, yr + width, width=width)
    assert (outline + draw("ellipse", x, y, xr, yr, fill=True, width=width) == whole).all()


@st.composite
def any_shape(draw):
    """A call of a shape: a function of a framebuffer and further options."""
    name = draw(st.sampled_from(["rect", "round_rect", "circle", "ellipse", "arc", "sector"]))
    place = draw(st.tuples(coordinates, coordinates))
    numbers = {"rect": [lengths] * 2, "round_rect": [lengths] * 3, "circle": [lengths], "ellipse": [lengths] * 2}
    arguments = draw(st.tuples(*numbers.get(name, [lengths, angles, angles])))
    options = {"width": draw(widths)}
    if name != "arc":
        options["fill"] = draw(st.booleans())
    if name == "ellipse":
        options["quadrants"] = draw(st.integers(0, 15))
    return lambda fb, **more: getattr(fb, name)(*place, *arguments, **options, **more)


@examples(2)
@given(any_shape(), st.one_of(st.none(), antialiased), st.integers(0, 2**32))
def test_xor_twice_is_nothing(package, shape, samples, seed):
    antialias = samples and package.Supersample(*samples)
    fb = package.Framebuffer(WIDTH, HEIGHT, depth=4)
    fb.pixels[...] = before = np.random.default_rng(seed).integers(0, 16, (HEIGHT, WIDTH))
    shape(fb, op="xor", antialias=antialias)
    shape(fb, op="xor", antialias=antialias)
    assert (fb.pixels == before).all()


@examples(2)
@given(any_shape(), st.one_of(st.none(), antialiased), st.sampled_from(["xor", "add", "max"]))
def test_on_a_blank_picture_operations_are_the_same(package, shape, samples, op):
    antialias = samples and package.Supersample(*samples)
    once, other = package.Framebuffer(WIDTH, HEIGHT, depth=4), package.Framebuffer(WIDTH, HEIGHT, depth=4)
    shape(once, antialias=antialias)
    shape(other, antialias=antialias, op=op)
    assert once == other


@given(any_shape(), antialiased)
def test_with_one_bit_half_or_more_is_lit(package, shape, samples):
    bit, deep = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT, depth=8)
    for fb in (bit, deep):
        shape(fb, c=fb.max_level, antialias=package.Supersample(*samples))
    assert (bit.pixels == (deep.pixels >= 127.5)).all()


@given(any_shape(), st.one_of(st.none(), antialiased))
def test_clipping_changes_no_pixel(package, shape, samples):
    antialias = samples and package.Supersample(*samples)
    whole = package.Framebuffer(WIDTH, HEIGHT, depth=4)
    part = package.Framebuffer(WIDTH - 4, HEIGHT - 3, depth=4)
    for fb in (whole, part):
        shape(fb, antialias=antialias)
    assert (whole.pixels[: HEIGHT - 3, : WIDTH - 4] == part.pixels).all()
