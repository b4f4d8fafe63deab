"""The cone filter: its volume above a line, against numeric integration; and what paths and shapes make of it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples

positions = st.integers(-3 * 256, 15 * 256).map(lambda number: number / 256)
widths = st.integers(64, 5 * 256).map(lambda number: number / 256)
radii = st.sampled_from([0.5, 0.8, 1.0, 1.7, 2.5])
heights = {
    "cone": lambda distance: 1 - distance,
    "box": np.ones_like,
    "gaussian": lambda distance: np.exp(-2 * distance**2),
}


def integral(line, width, square, radius, shape, size=8, cells=200):
    """The filter's volume above the rectangle around the line, cell by cell, for each pixel."""
    x1, y1, x2, y2 = line
    length = np.hypot(x2 - x1, y2 - y1)
    ux, uy = ((x2 - x1) / length, (y2 - y1) / length) if length else (1.0, 0.0)
    reach = width / 2 if square else 0.0
    offsets = ((np.arange(2 * cells) + 0.5) / cells - 1) * radius
    dx, dy = np.meshgrid(offsets, offsets)
    distance = np.hypot(dx, dy) / radius
    weights = np.where(distance < 1, heights[shape](distance), 0)
    weights /= weights.sum()
    result = np.empty((size, size))
    for y in range(size):
        for x in range(size):
            u = ux * (x + dx - x1) + uy * (y + dy - y1)
            v = ux * (y + dy - y1) - uy * (x + dx - x1)
            inside = (u >= -reach) & (u <= length + reach) & (abs(v) <= width / 2)
            result[y, x] = weights[inside].sum()
    return result


@pytest.mark.parametrize("shape", heights)
@examples(0.3)
@given(positions, positions, positions, positions, widths, st.booleans(), radii)
def test_lines_are_within_two_levels_of_the_integral(package, shape, x1, y1, x2, y2, width, square, radius):
    fb = package.Framebuffer(8, 8, 8)
    cone = package.ConeFilter(radius, shape)
    fb.line(x1, y1, x2, y2, width=width, cap="square" if square else "butt", antialias=cone)
    exact = 255 * integral((x1, y1, x2, y2), width, square, radius, shape)
    assert abs(fb.pixels - exact).max() <= 2


def test_the_table_is_the_volume_over_quadrants(package):
    cone = package.ConeFilter(1.0, "cone", 16)
    table = cone.table
    assert table.shape == (33, 33)
    assert table[0].max() == 0
    assert table[-1, -1] == 1
    assert table[16, 16] == pytest.approx(0.25)
    assert np.allclose(table, table.T)
    with pytest.raises(ValueError, match="read-only"):
        table[0, 0] = 1


@pytest.mark.parametrize("resolution", [8, 32, 256])
def test_all_resolutions_agree(package, resolution):
    fb, other = package.Framebuffer(20, 9, 8), package.Framebuffer(20, 9, 8)
    fb.line(1, 1, 17, 6, width=2, antialias=package.ConeFilter(resolution=resolution))
    other.line(1, 1, 17, 6, width=2, antialias=package.ConeFilter())
    assert abs(fb.pixels.astype(int) - other.pixels).max() <= 2


def test_lines_in_one_call_equal_lines_one_by_one(package):
    cone = package.ConeFilter()
    segments = np.random.default_rng(1).integers(-5, 20, (9, 4))
    one, many = package.Framebuffer(16, 16, 8), package.Framebuffer(16, 16, 8)
    many.lines(segments, antialias=cone)
    for segment in segments.tolist():
        one.line(*segment, antialias=cone)
    assert one == many


@given(positions, positions, positions, positions, widths, radii)
def test_a_path_of_one_line_is_the_line(package, x1, y1, x2, y2, width, radius):
    line, path = package.Framebuffer(12, 12, 8), package.Framebuffer(12, 12, 8)
    cone = package.ConeFilter(radius)
    line.line(x1, y1, x2, y2, width=width, antialias=cone)
    path.polyline([x1, y1, x2, y2], width=width, antialias=cone)
    # Two ways that know nothing of each other.
    assert abs(line.pixels.astype(int) - path.pixels).max() <= 2


@pytest.mark.parametrize("at", [(0, 0), (5, 3), (-3, -2)])
def test_a_shape_is_the_same_wherever_it_is_clipped(package, at):
    cone = package.ConeFilter(1.5)
    corners = np.array([[3, 2], [11, 6], [6, 12], [2, 9]])
    whole = package.Framebuffer(30, 30, 8)
    whole.poly(10, 10, corners, fill=True, antialias=cone)
    part = package.Framebuffer(8, 7, 8)
    part.poly(-at[0], -at[1], corners, fill=True, antialias=cone)
    left, top = 10 + at[0], 10 + at[1]
    assert (part.pixels == whole.pixels[top : top + 7, left : left + 8]).all()


def test_a_large_shape_is_fully_covered_inside(package):
    fb = package.Framebuffer(12, 12, 8)
    fb.poly(0, 0, [-20, -20, 40, -20, 40, 40, -20, 40], fill=True, antialias=package.ConeFilter(2))
    assert (fb.pixels == 255).all()


def test_an_edge_through_pixel_centers_covers_half(package):
    fb = package.Framebuffer(9, 9, 8)
    fb.poly(0, 0, [4, -20, 40, -20, 40, 40, 4, 40], fill=True, antialias=package.ConeFilter())
    assert abs(fb.pixels[:, 4].astype(int) - 128).max() <= 2
    assert not fb.pixels[:, :3].any()


def test_xor_twice_is_nothing(package):
    fb = package.Framebuffer(16, 16, 4)
    fb.pixels[...] = np.random.default_rng(2).integers(0, 16, (16, 16))
    before = fb.pixels.copy()
    for _ in range(2):
        fb.line(1, 2, 14, 9, op="xor", antialias=package.ConeFilter())
        fb.polyline([2, 2, 13, 13, 2, 13, 13, 2], op="xor", antialias=package.ConeFilter())
    assert (fb.pixels == before).all()


def test_one_bit_lights_what_is_covered_by_half(package):
    deep, flat = package.Framebuffer(20, 10, 8), package.Framebuffer(20, 10)
    for fb in (deep, flat):
        fb.line(1, 1, 17, 7, width=3, antialias=package.ConeFilter())
    sure = abs(deep.pixels.astype(int) - 127) > 1
    assert ((deep.pixels > 127) == flat.pixels)[sure].all()


@pytest.mark.parametrize("far", [2**20, 2**40, 2**70])
def test_far_lines_end_out_of_sight(package, far):
    fb, near = package.Framebuffer(20, 10, 8), package.Framebuffer(20, 10, 8)
    fb.line(-far, 5, far, 5, antialias=package.ConeFilter())
    near.line(-50, 5, 70, 5, antialias=package.ConeFilter())
    assert fb == near


def test_a_filter_is_a_value(package):
    cone = package.ConeFilter()
    assert cone == package.ConeFilter(1, "cone", 32)
    assert hash(cone) == hash(package.ConeFilter(1, "cone", 32))
    assert cone != package.ConeFilter(2)
    assert cone != package.Supersample()
    assert repr(cone) == "ConeFilter(radius=1.0, filter='cone', resolution=32)"
    if package._compiled.COMPILED:
        with pytest.raises(AttributeError):
            cone.radius = 2


@pytest.mark.parametrize(
    ("arguments", "error", "words"),
    [
        ({"radius": 0.4}, ValueError, "radius must be from 0.5 to 4"),
        ({"radius": float("nan")}, ValueError, "radius must be from 0.5 to 4"),
        ({"radius": "1"}, TypeError, "radius must be a number"),
        ({"filter": "tent"}, ValueError, "filter must be one of 'cone', 'box', 'gaussian'"),
        ({"filter": []}, ValueError, "filter must be one of 'cone', 'box', 'gaussian'"),
        ({"resolution": 7}, ValueError, "resolution must be from 8 to 256"),
        ({"resolution": 8.0}, TypeError, "resolution must be a whole number"),
    ],
)
def test_filters_have_limits(package, arguments, error, words):
    with pytest.raises(error, match=f"^{words}"):
        package.ConeFilter(**arguments)
