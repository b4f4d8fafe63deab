"""Round shapes whose centers and radii are halves of a pixel, against their definition, and as pictures."""

from __future__ import annotations

from math import atan2, ceil, cos, degrees, floor, hypot, pi, radians, sin

import definitions
import numpy as np
import pytest
import round_definitions
from hypothesis import assume, example, given
from hypothesis import strategies as st
from PIL import Image, ImageDraw
from searching import examples

from paneldraw.testing import assert_pattern

WIDTH, HEIGHT = 21, 15
LARGEST = 131072

coordinates = st.integers(-20, 60).map(lambda number: number / 2)
radii = st.integers(0, 48).map(lambda number: number / 2)
angles = st.one_of(st.sampled_from(range(0, 361, 45)), st.integers(-720, 720), st.floats(-400, 400))


def drawn(package, name, *arguments, size=(WIDTH, HEIGHT), **options):
    fb = package.Framebuffer(*size)
    getattr(fb, name)(*arguments, op="xor", **options)
    return fb.pixels.astype(bool)


def flood(lit):
    """The pixels that what floods in from outside reaches, across sides only."""
    page = Image.fromarray(np.pad(lit, 1).astype(np.uint8)).copy()  # what shares an array's memory is read-only
    ImageDraw.floodfill(page, (0, 0), 2)
    return (np.array(page) == 2)[1:-1, 1:-1]


# -- Pictures


def test_disc_of_even_diameter(package):
    fb = package.Framebuffer(11, 11)
    fb.circle(4.5, 4.5, 4.5, fill=True)
    assert_pattern(
        fb,
        """
        ...####....
        ..######...
        .########..
        ##########.
        ##########.
        ##########.
        ##########.
        .########..
        ..######...
        ...####....
        ...........
        """,
    )


def test_circles_around_half_pixels(package):
    fb = package.Framebuffer(30, 8)
    for x, r in ((0.5, 0.5), (4.5, 1.5), (10.5, 2.5), (17.5, 3), (25.5, 3.5)):
        fb.circle(x, 3.5, r)
    assert_pattern(
        fb,
        """
        ........................####..
        ..........##....####...#....#.
        ....##...#..#..#....#.#......#
        ##.#..#.#....#.#....#.#......#
        ##.#..#.#....#.#....#.#......#
        ....##...#..#..#....#.#......#
        ..........##....####...#....#.
        ........................####..
        """,
    )


def test_discs_around_half_pixels(package):
    fb = package.Framebuffer(30, 8)
    for x, r in ((0.5, 0.5), (4.5, 1.5), (10.5, 2.5), (17.5, 3), (25.5, 3.5)):
        fb.circle(x, 3.5, r, fill=True)
    assert_pattern(
        fb,
        """
        ........................####..
        ..........##....####...######.
        ....##...####..######.########
        ##.####.######.######.########
        ##.####.######.######.########
        ....##...####..######.########
        ..........##....####...######.
        ........................####..
        """,
    )


def test_half_radii_around_whole_pixels(package):
    """The row in which a radius of 3.5 ends belongs half to the next pixel: it stays dark, or it would stick out."""
    fb = package.Framebuffer(30, 9)
    for x, r in ((0, 0.5), (3, 1.5), (8, 2.5), (15, 3.5), (24, 4.5)):
        fb.circle(x, 4, r)
    assert_pattern(
        fb,
        """
        ......................#####...
        .............#####...#.....#..
        .......###..#.....#.#.......#.
        ..###.#...#.#.....#.#.......#.
        #.#.#.#...#.#.....#.#.......#.
        ..###.#...#.#.....#.#.......#.
        .......###..#.....#.#.......#.
        .............#####...#.....#..
        ......................#####...
        """,
    )


def test_circles_half_a_pixel_off_one_way(package):
    fb = package.Framebuffer(21, 9)
    fb.circle(3, 3.5, 3.5)
    fb.circle(11.5, 4, 4, fill=True)
    fb.circle(18, 4.5, 2)
    assert_pattern(
        fb,
        """
        ..###.....####.......
        .#...#...######......
        #.....#.########.....
        #.....#.########.###.
        #.....#.#########...#
        #.....#.#########...#
        .#...#..########.###.
        ..###....######......
        ..........####.......
        """,
    )


def test_ellipses_around_half_pixels(package):
    fb = package.Framebuffer(26, 7)
    fb.ellipse(5.5, 2.5, 5.5, 2.5)
    fb.ellipse(18.5, 0.5, 6.5, 0.5)
    fb.ellipse(19, 4.5, 6.5, 1.5, fill=True)
    assert_pattern(
        fb,
        """
        ...######...##############
        .##......##.##############
        #..........#..............
        #..........#...#########..
        .##......##..#############
        ...######....#############
        ...............#########..
        """,
    )


def test_quadrants_around_a_half_pixel(package):
    """No pixel lies on the axes: quadrants share none."""
    fb = package.Framebuffer(21, 10)
    fb.ellipse(4.5, 4.5, 4.5, 4.5, quadrants=0b0101)
    fb.ellipse(15.5, 4.5, 4.5, 4.5, fill=True, quadrants=0b1010)
    assert_pattern(
        fb,
        """
        .....##.......##.....
        .......#.....###.....
        ........#...####.....
        .........#.#####.....
        .........#.#####.....
        #...............#####
        #...............#####
        .#..............####.
        ..#.............###..
        ...##...........##...
        """,
    )


def test_arcs_around_half_pixels(package):
    fb = package.Framebuffer(21, 10)
    fb.arc(4.5, 4.5, 4.5, 180, 270)
    fb.arc(4.5, 4.5, 4.5, 0, 90)
    fb.arc(15.5, 4.5, 4.5, 150, 30)
    assert_pattern(
        fb,
        """
        ...##.........####...
        ..#..........#....#..
        .#..........#......#.
        #..........#........#
        #..........#........#
        .........#.#........#
        .........#.#........#
        ........#...#......#.
        .......#.............
        .....##..............
        """,
    )


def test_sectors_around_a_half_pixel(package):
    """A radius begins at that one of the four pixels around the center toward which it goes."""
    fb = package.Framebuffer(32, 10)
    fb.sector(4.5, 4.5, 4.5, 180, 270)
    fb.sector(4.5, 4.5, 4.5, 0, 90)
    fb.sector(15.5, 4.5, 4.5, 30, 330)
    fb.sector(26.5, 4.5, 4.5, 30, 330, fill=True)
    assert_pattern(
        fb,
        """
        ...##.........####.......####...
        ..#.#........#....#.....######..
        .#..#.......#......#...########.
        #...#......#.....##...########..
        #####......#....#.....######....
        .....#####.#....#.....######....
        .....#...#.#.....##...########..
        .....#..#...#......#...########.
        .....#.#.....#....#.....######..
        .....##.......####.......####...
        """,
    )


def test_rectangles_with_corners_of_half_radii(package):
    fb = package.Framebuffer(34, 10)
    fb.round_rect(0, 0, 10, 10, 4.5, fill=True)
    fb.round_rect(11, 0, 11, 10, 3.5)
    fb.round_rect(23, 0, 11, 5, 0.5)
    fb.round_rect(23, 6, 11, 4, 1.5)
    assert_pattern(
        fb,
        """
        ...####......#######...###########
        ..######....#.......#..#.........#
        .########..#.........#.#.........#
        ##########.#.........#.#.........#
        ##########.#.........#.###########
        ##########.#.........#............
        ##########.#.........#..#########.
        .########..#.........#.#.........#
        ..######....#.......#..#.........#
        ...####......#######....#########.
        """,
    )


# -- Circles and ellipses


@given(coordinates, coordinates, radii, radii, st.booleans(), st.integers(0, 15))
@example(4.5, 4.5, 4.5, 4.5, True, 15)
@example(0.5, 0.5, 0.5, 0.5, False, 15)
@example(10, 7, 3.5, 3.5, True, 15)
@example(10.5, 7, 5, 0, True, 15)
@example(10, 7.5, 0, 0, False, 15)
@example(10.5, 7.5, 9.5, 0.5, False, 15)
@example(10, 7.5, 10, 1.5, False, 15)
def test_ellipses_equal_their_definition(package, x, y, xr, yr, fill, quadrants):
    lit = drawn(package, "ellipse", x, y, xr, yr, fill=fill, quadrants=quadrants)
    assert (lit == round_definitions.ellipse(WIDTH, HEIGHT, x, y, xr, yr, fill, quadrants)).all()


@st.composite
def passing(draw, radius):
    """Ellipses that pass through or near the window: center and radii, halves of a pixel."""
    xr, yr = draw(st.integers(0, 2 * radius)) / 2, draw(st.integers(radius, 2 * radius)) / 2
    angle = draw(st.floats(0, 2 * pi))
    x, y = round(2 * xr * cos(angle)) / 2, round(2 * yr * sin(angle)) / 2
    if draw(st.booleans()):
        xr, yr, x, y = yr, xr, y, x
    column, row = draw(st.integers(0, 2 * WIDTH)) / 2, draw(st.integers(0, 2 * HEIGHT)) / 2
    return column - x, row - y, xr, yr


@pytest.mark.parametrize("radius", [40, 400, 2**14, LARGEST])
@examples(0.6)
@given(st.data(), st.booleans())
def test_large_ellipses_equal_their_definition(package, radius, data, fill):
    x, y, xr, yr = data.draw(passing(radius))
    lit = drawn(package, "ellipse", x, y, xr, yr, fill=fill)
    assert (lit == round_definitions.ellipse(WIDTH, HEIGHT, x, y, xr, yr, fill)).all()


@pytest.mark.parametrize("radius", [100, 400, LARGEST])
@examples(0.6)
@given(st.data(), st.booleans())
def test_large_circles_equal_their_definition(package, radius, data, fill):
    x, y, _, r = data.draw(passing(radius))
    if data.draw(st.booleans()):
        x, y = data.draw(coordinates) - r, data.draw(coordinates)
    lit = drawn(package, "circle", x, y, r, fill=fill)
    assert (lit == round_definitions.ellipse(WIDTH, HEIGHT, x, y, r, r, fill)).all()


def first_and_last(row):
    lit = np.flatnonzero(row)
    return (int(lit[0]), int(lit[-1])) if len(lit) else None


@pytest.mark.parametrize("yr", [1, 1.5, 30, 30.5])
@pytest.mark.parametrize("xr", [LARGEST, LARGEST - 0.5])
def test_wide_flat_ellipses_row_by_row(package, xr, yr):
    """Their ends, far from the center, in windows that hold all of their rows."""
    height = int(2 * yr) + 1
    for distance in (xr - 3, xr - 200, xr / 2, xr / 20, 8):
        x = -int(distance) - (xr % 1)
        lit = drawn(package, "ellipse", x, yr, xr, yr, size=(40, height))
        filled = drawn(package, "ellipse", x, yr, xr, yr, fill=True, size=(40, height))
        assert (lit == round_definitions.ellipse(40, height, x, yr, xr, yr)).all()
        assert (filled == round_definitions.ellipse(40, height, x, yr, xr, yr, True)).all()
        assert not (lit & ~filled).any()


@pytest.fixture(params=[(x, y) for x in (0, 0.5) for y in (0, 0.5)], ids=str)
def off(request):
    """How far a center is from a pixel."""
    return np.array(request.param)


@pytest.mark.parametrize("r", [0.5, 1, 1.5, 2, 2.5, 3.5, 4.5, 6.5, 8.5, 12, 12.5, 42.5, 60.5])
def test_circles_are_symmetric_and_closed_and_end_in_no_single_pixel(package, off, r):
    x, y = off + np.ceil(r)
    size = (int(2 * x) + 1, int(2 * y) + 1)
    lit = drawn(package, "circle", x, y, r, size=size)
    filled = drawn(package, "circle", x, y, r, fill=True, size=size)
    assert (lit == lit[::-1]).all()
    assert (lit == lit[:, ::-1]).all()
    assert x != y or (lit == lit.T).all()
    assert (filled == ~flood(lit)).all()
    assert lit.any(axis=0).sum() == 2 * (r - (x + r) % 1) + 1
    assert lit.any(axis=1).sum() == 2 * (r - (y + r) % 1) + 1
    if r > 1:
        rows = np.flatnonzero(filled.any(axis=1))
        assert filled[rows[0]].sum() > 1
    true = np.linspace(0, 2 * pi, 40 * int(r + 1))
    for row, column in np.argwhere(lit):
        assert np.hypot(r * np.cos(true) - (column - x), r * np.sin(true) - (row - y)).min() < 0.72


@given(coordinates, coordinates, radii, st.booleans())
def test_a_circle_is_an_ellipse_and_a_turn(package, x, y, r, fill):
    circle = drawn(package, "circle", x, y, r, fill=fill)
    assert (drawn(package, "ellipse", x, y, r, r, fill=fill) == circle).all()
    assert (drawn(package, "sector", x, y, r, -90, 270, fill=fill) == circle).all()
    assert fill or (drawn(package, "arc", x, y, r, 5, 500) == circle).all()


# -- Arcs and sectors

SIZE, CENTER = 61, 30
small = st.integers(0, 56).map(lambda number: number / 2)
offsets = st.sampled_from([(0, 0), (0.5, 0.5), (0, 0.5), (0.5, 0)])


def centered(package, name, off, *arguments, **options):
    return drawn(package, name, CENTER + off[0], CENTER + off[1], *arguments, size=(SIZE, SIZE), **options)


def whole_circle(off, r, fill=False):
    return round_definitions.ellipse(SIZE, SIZE, CENTER + off[0], CENTER + off[1], r, r, fill)


def pixels(lit, off, r):
    """Lit pixels as seen from the center of a circle."""
    x, y = CENTER + off[0], CENTER + off[1]
    if r == 0:  # that is one pixel
        x, y = definitions.nearest(x), definitions.nearest(y)
    return [(int(column) - x, int(row) - y) for row, column in np.argwhere(lit)]


def crossed(first, second):
    """Positive where the second vector lies clockwise of the first by less than half a turn."""
    return first[0] * second[1] - first[1] * second[0]


@given(offsets, small, angles)
@example((0.5, 0.5), 4.5, 180)
@example((0.5, 0.5), 4.5, 45)
def test_radii_end_at_the_nearest_pixel_of_the_circle(package, off, r, angle):
    x, y = r * cos(radians(angle)), r * sin(radians(angle))
    ((u, v),) = pixels(centered(package, "arc", off, r, angle, angle), off, r)
    ring = pixels(whole_circle(off, r), off, r)
    assert (u, v) in ring
    assert hypot(u - x, v - y) < min(hypot(column - x, row - y) for column, row in ring) + 1e-9


@examples(0.6)
@given(st.integers(100, 2 * LARGEST) | st.integers(2 * LARGEST - 5, 2 * LARGEST), angles, coordinates, coordinates)
def test_radii_of_large_circles_end_at_the_nearest_pixel(package, diameter, angle, x, y):
    r = diameter / 2
    end_x, end_y = r * cos(radians(angle)), r * sin(radians(angle))
    x, y = x % 1 + 10 - round(end_x), y % 1 + 7 - round(end_y)
    ((row, column),) = np.argwhere(drawn(package, "arc", x, y, r, angle, angle))
    ring = np.argwhere(round_definitions.ellipse(WIDTH, HEIGHT, x, y, r, r))
    nearest = min(hypot(u - x - end_x, v - y - end_y) for v, u in ring)
    assert hypot(column - x - end_x, row - y - end_y) < nearest + 1e-6


@given(offsets, small, angles, angles)
@example((0.5, 0.5), 4.5, 180, 270)
@example((0.5, 0.5), 0.5, 0, 180)
@example((0.5, 0), 12.5, 10, 190.001)
def test_an_arc_and_the_one_back_are_the_circle(package, off, r, start, end):
    """They share no more than the pixels at their ends."""
    assume((end - start) % 360 > 0 and abs(end - start) < 360)
    there = centered(package, "arc", off, r, start, end)
    back = centered(package, "arc", off, r, end, start)
    assert ((there | back) == whole_circle(off, r)).all()
    assert (there & back).sum() <= 2 or r < 2


@given(offsets, small, angles, st.floats(1, 179))
def test_arcs_are_the_circle_between_their_ends(package, off, r, start, swept):
    arc = centered(package, "arc", off, r, start, start + swept)
    ring = pixels(whole_circle(off, r), off, r)
    found = pixels(arc, off, r)
    assert set(found) <= set(ring)
    first, last = ((cos(radians(angle)), sin(radians(angle))) for angle in (start, start + swept))
    for pixel in ring:
        # Within a pixel of an end the nearest pixel decides.
        if min(hypot(r * end[0] - pixel[0], r * end[1] - pixel[1]) for end in (first, last)) > 1:
            assert (pixel in found) == (crossed(first, pixel) > 0 and crossed(last, pixel) < 0)


@given(
    st.sampled_from([2.5, 7, 9.5, 300.5, LARGEST - 20, LARGEST - 20.5]),
    st.sampled_from([0, 90, 180, 270]),
    st.booleans(),
)
def test_quarter_turns_are_quadrants(package, r, start, fill):
    for x, y in ((10.5, 7.5), (10.5 - r, 7.5), (10.5, 7.5 + r), (10.5 + r, 7.5), (10.5, 7.5 - r)):
        if x % 1 == 0.5 and y % 1 == 0.5:
            quadrant = {0: 8, 90: 4, 180: 2, 270: 1}[start]
            ellipse = round_definitions.ellipse(WIDTH, HEIGHT, x, y, r, r, fill, quadrant)
            name, options = ("sector", {"fill": True}) if fill else ("arc", {})
            assert (drawn(package, name, x, y, r, start, start + 90, **options) == ellipse).all()


def beside_center(center, outward):
    """The row or column of the pixel at a center; of two equally near the one in a direction."""
    return ceil(center) if outward > 0 else floor(center)


@given(offsets, small, angles, st.integers(1, 359))
@example((0.5, 0.5), 12.5, 20, 1)
@example((0.5, 0.5), 4.5, 180, 90)
def test_sectors_are_an_arc_and_two_radii_and_what_these_enclose(package, off, r, start, swept):
    end = start + swept
    assume(r > 0)
    x, y = CENTER + off[0], CENTER + off[1]
    outline = centered(package, "arc", off, r, start, end)
    for angle, inward in ((start, 1e-6), (end, -1e-6)):
        # On an axis an end may be in the middle between two pixels: then it is at the one within the sector.
        angle += inward if abs((angle + 45) % 90 - 45) < 1e-6 else 0
        ((u, v),) = pixels(centered(package, "arc", off, r, angle, angle), off, r)
        line = (beside_center(x, u), beside_center(y, v), int(x + u), int(y + v))
        outline |= definitions.bresenham(SIZE, SIZE, *line)
    assert (centered(package, "sector", off, r, start, end) == outline).all()
    filled = centered(package, "sector", off, r, start, end, fill=True)
    assert not (outline & ~filled).any()
    assert not (filled & flood(outline)).any()
    # Radii that lie close together may enclose a pixel outside of the sector.
    for u, v in pixels(~filled & ~flood(outline), off, r):
        turned = (degrees(atan2(v, u)) - start) % 360
        assert min(turned, 360 - turned, abs(turned - swept)) * radians(1) * hypot(u, v) < 1.5


def test_a_sector_from_an_angle_to_the_same_is_a_radius(package):
    fb = package.Framebuffer(10, 10)
    fb.sector(4.5, 4.5, 4.5, 20, 20)
    fb.sector(4.5, 4.5, 4.5, 200, 200, fill=True)
    assert_pattern(
        fb,
        """
        ..........
        ..........
        ..........
        ##........
        ..###.....
        .....##...
        .......###
        ..........
        ..........
        ..........
        """,
    )


@given(offsets, small, st.integers(-8, 8).map(lambda number: 45 * number) | st.integers(-360, 360), st.integers(1, 350))
def test_arcs_in_a_mirror_are_those_of_mirrored_angles(package, off, r, start, swept):
    x, y = CENTER + off[0], CENTER + off[1]
    size = (int(2 * x) + 1, int(2 * y) + 1)
    arc = drawn(package, "arc", x, y, r, start, start + swept, size=size)
    assume(r > 0)  # else the center is not in the middle
    assert (arc == drawn(package, "arc", x, y, r, 180 - start - swept, 180 - start, size=size)[:, ::-1]).all()
    assert (arc == drawn(package, "arc", x, y, r, -start - swept, -start, size=size)[::-1]).all()


# -- Rectangles with round corners


sides = st.integers(1, 30)


@given(st.integers(-10, 30), st.integers(-10, 30), sides, sides, radii, st.booleans())
@example(0, 0, 10, 10, 4.5, True)
@example(2, 2, 4, 4, 1.5, False)
@example(2, 2, 4, 9, 99, False)
@example(2, 2, 5, 5, 0.5, False)
@example(2, 2, 9, 2, 1, True)
def test_rounded_rectangles_are_quadrants_and_sides(package, x, y, w, h, r, fill):
    assert (
        drawn(package, "round_rect", x, y, w, h, r, fill=fill)
        == round_definitions.round_rect(WIDTH, HEIGHT, x, y, w, h, r, fill)
    ).all()


@examples(0.5)
@given(st.sampled_from([100.5, 8000.5, 131071.5]), st.data(), st.booleans())
def test_large_rounded_rectangles_are_quadrants_and_sides(package, r, data, fill):
    side = st.sampled_from([int(2 * r) + 1, int(2 * r) + 2])
    w, h = data.draw(side), data.draw(side)
    corners = st.sampled_from([(0, r), (r, 0), (r / 3, r / 9), (0.29 * r, 0.29 * r), (w - 1, h / 2), (w / 2, h - 1)])
    x, y = data.draw(corners)
    x, y = data.draw(st.integers(-9, 9)) - int(x), data.draw(st.integers(-9, 9)) - int(y)
    assert (
        drawn(package, "round_rect", x, y, w, h, r, fill=fill)
        == round_definitions.round_rect(WIDTH, HEIGHT, x, y, w, h, r, fill)
    ).all()


@given(st.integers(-10, 20), st.integers(-10, 20), sides, st.booleans())
def test_a_square_with_corners_as_large_as_it_is_is_a_circle(package, x, y, side, fill):
    assume(side > 2)
    r = (side - 1) / 2
    square = drawn(package, "round_rect", x, y, side, side, r, fill=fill)
    assert (square == drawn(package, "circle", x + r, y + r, r, fill=fill)).all()
    assert (square == drawn(package, "round_rect", x, y, side, side, side, fill=fill)).all()
