"""Parts of a framebuffer: clip, view, blit, scroll, against what a plain array does."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

coordinates = st.one_of(st.integers(-12, 12), st.sampled_from([-(2**70), -(2**31), 2**31, 2**70]))
sizes = st.integers(1, 9)


def noise(package, width, height, depth=4, seed=0):
    fb = package.Framebuffer(width, height, depth)
    fb.pixels[...] = np.random.default_rng(seed).integers(0, fb.max_level + 1, (height, width))
    return fb


def moved(picture, x, y, width, height):
    """The picture at (x, y) of an empty surface, and where it lies, pixel by pixel."""
    levels = np.zeros((height, width), np.uint8)
    there = np.zeros((height, width), bool)
    for row in range(height):
        for column in range(width):
            if 0 <= row - y < picture.shape[0] and 0 <= column - x < picture.shape[1]:
                levels[row, column] = picture[row - y, column - x]
                there[row, column] = True
    return levels, there


@given(coordinates, coordinates, sizes, sizes, st.integers(-1, 15))
def test_blit_copies_what_is_visible(package, x, y, width, height, key):
    fb = noise(package, 8, 6)
    before = fb.pixels.copy()
    stamp = noise(package, width, height, seed=1)
    levels, there = moved(stamp.pixels, x, y, 8, 6)
    fb.blit(stamp, x, y, key)
    assert (fb.pixels == np.where(there & (levels != key), levels, before)).all()


def test_blit_of_an_array_equals_blit_of_its_framebuffer(package):
    stamp = noise(package, 4, 3)
    one, other = package.Framebuffer(8, 6, 4), package.Framebuffer(8, 6, 4)
    one.blit(stamp, 1, 2)
    other.blit(stamp.pixels, 1, 2)
    assert one == other


@given(st.integers(-9, 9), st.integers(-9, 9))
def test_blit_of_a_framebuffer_on_itself_reads_before_it_writes(package, x, y):
    fb = noise(package, 8, 6)
    before = fb.pixels.copy()
    fb.blit(fb, x, y)
    levels, there = moved(before, x, y, 8, 6)
    assert (fb.pixels == np.where(there, levels, before)).all()


def test_blit_scales_levels_between_depths(package):
    stamp = package.Framebuffer(4, 1, 2)
    stamp.pixels[0] = [0, 1, 2, 3]
    fb = package.Framebuffer(4, 1, 8)
    fb.blit(stamp, 0, 0)
    assert fb.pixels.tolist() == [[0, 85, 170, 255]]
    dark = package.Framebuffer(4, 1, 1)
    dark.blit(fb, 0, 0)
    assert dark.pixels.tolist() == [[0, 0, 1, 1]]


def test_a_palette_says_which_level_stands_for_which(package):
    stamp = package.Framebuffer(3, 1)
    stamp.pixel(1, 0, 1)
    fb = package.Framebuffer(3, 1, 4)
    fb.blit(stamp, 0, 0, palette=[3, 9])
    assert fb.pixels.tolist() == [[3, 9, 3]]
    colors = package.Framebuffer(2, 1, 4)
    colors.pixels[0] = [5, 6]
    fb.blit(stamp, 0, 0, 5, colors)
    assert fb.pixels.tolist() == [[3, 6, 3]]


@pytest.mark.parametrize(
    ("source", "options", "error", "words"),
    [
        ("picture", {}, TypeError, "source must be a Framebuffer or a uint8 array"),
        (np.zeros((2, 2), float), {}, TypeError, "source must be"),
        (np.zeros(4, np.uint8), {}, TypeError, "source must be"),
        (np.full((2, 2), 16, np.uint8), {}, ValueError, "source must hold levels from 0 to 15"),
        (np.zeros((2, 2), np.uint8), {"palette": [16]}, ValueError, "palette must hold levels from 0 to 15"),
        (np.ones((2, 2), np.uint8), {"palette": [1]}, ValueError, "palette must have a level for each"),
        (np.ones((2, 2), np.uint8), {"key": 1.5}, TypeError, "key must be a whole number"),
    ],
)
@pytest.mark.parametrize("x", [0, 99])
def test_blit_refuses_what_it_cannot_copy(package, source, options, error, words, x):
    with pytest.raises(error, match=words):
        package.Framebuffer(8, 6, 4).blit(source, x, 0, **options)


def test_blit_of_no_pixels_changes_none(package):
    fb = noise(package, 8, 6)
    before = fb.pixels.copy()
    for options in ({}, {"key": 0}, {"palette": [1]}):
        fb.blit(np.zeros((0, 3), np.uint8), 1, 1, **options)
    assert (fb.pixels == before).all()


@given(coordinates, coordinates, st.one_of(st.none(), st.integers(0, 15)))
def test_scroll_moves_the_picture(package, dx, dy, level):
    fb = noise(package, 8, 6)
    before = fb.pixels.copy()
    levels, there = moved(before, dx, dy, 8, 6)
    fb.scroll(dx, dy, level)
    assert (fb.pixels == np.where(there, levels, before if level is None else level)).all()


def test_scroll_within_a_clip_leaves_the_rest_alone(package):
    fb = noise(package, 8, 6)
    before = fb.pixels.copy()
    part = package.Framebuffer(4, 3, 4)
    part.blit(before[2:5, 1:5], 0, 0)
    part.scroll(1, -1, 0)
    with fb.clip(1, 2, 4, 3):
        fb.scroll(1, -1, 0)
    before[2:5, 1:5] = part.pixels
    assert (fb.pixels == before).all()


def draw_everything(fb, package, dx=0, dy=0):
    """Each kind of painting there is, as seen from (dx, dy)."""
    fb.rect(-3 - dx, -3 - dy, 20, 15, 2, True)
    fb.line(-5 - dx, -2 - dy, 14 - dx, 9 - dy, 9)
    fb.line(9 - dx, -3 - dy, 1 - dx, 11 - dy, 5, width=2.5, antialias=package.Supersample(3))
    fb.circle(4 - dx, 3 - dy, 5, 7)
    fb.poly(-dx, -dy, [-2, 4, 5, -3, 9, 9], 3, True, op="xor")
    fb.polyline([(-2 - dx, 5 - dy), (5 - dx, -2 - dy), (9 - dx, 9 - dy)], 1, op="xor")
    fb.text("Ag", 2 - dx, -1 - dy, 12)
    fb.image(np.arange(200, dtype=np.uint8).reshape(20, 10), 5 - dx, -4 - dy)
    fb.points([[3 - dx, 3 - dy], [7 - dx, 5 - dy]], 15)
    fb.pixel(1 - dx, 1 - dy, 14)


@given(coordinates, coordinates, st.integers(0, 9), st.integers(0, 9))
def test_nothing_is_painted_outside_of_a_clip(package, x, y, width, height):
    whole = package.Framebuffer(10, 8, 4)
    draw_everything(whole, package)
    clipped = noise(package, 10, 8)
    before = clipped.pixels.copy()
    with clipped.clip(x, y, width, height):
        clipped.clear()
        draw_everything(clipped, package)
    rows, columns = np.mgrid[:8, :10].astype(object)
    inside = (columns >= x) & (columns < x + width) & (rows >= y) & (rows < y + height)
    assert (clipped.pixels == np.where(inside.astype(bool), whole.pixels, before)).all()


def test_clips_nest_and_end(package):
    fb = package.Framebuffer(6, 1)
    with fb.clip(0, 0, 4, 1), fb.clip(2, 0, 4, 1):
        fb.fill(1)
    assert str(fb) == "..##.."
    with pytest.raises(RuntimeError), fb.clip(0, 0, 1, 1):
        raise RuntimeError
    fb.fill(1)
    assert str(fb) == "######"


@given(st.integers(0, 9), st.integers(0, 7), st.data())
def test_a_view_shows_what_it_would_see(package, x, y, data):
    width, height = data.draw(st.integers(1, 10 - x)), data.draw(st.integers(1, 8 - y))
    whole, parted = package.Framebuffer(10, 8, 4), package.Framebuffer(10, 8, 4)
    draw_everything(whole, package)
    view = parted.view(x, y, width, height)
    draw_everything(view, package, x, y)
    assert (view.width, view.height, view.depth) == (width, height, 4)
    assert (view.pixels == whole.pixels[y : y + height, x : x + width]).all()
    assert np.shares_memory(view.pixels, parted.pixels)
    view.clear()
    assert not parted.pixels.any()


def test_a_view_of_a_view(package):
    fb = package.Framebuffer(10, 8, antialias=package.Supersample(2))
    inner = fb.view(2, 2, 6, 4).view(1, 1, 3, 2)
    inner.fill(1)
    assert fb.pixels[3:5, 3:6].all()
    assert fb.pixels.sum() == 6
    assert inner.antialias == fb.antialias


@pytest.mark.parametrize(
    "part", [(-1, 0, 2, 2), (0, 0, 0, 2), (0, 0, 2, -1), (9, 0, 2, 2), (0, 7, 1, 2), (0, 0, 2**70, 1)]
)
def test_a_view_lies_within(package, part):
    with pytest.raises(ValueError, match="x, y, w, h must be a part of the 10 x 8 pixels"):
        package.Framebuffer(10, 8).view(*part)


@given(st.integers(-9, 9), sizes, sizes, st.sampled_from([1, 4]))
def test_turned_it_is_a_picture_of_its_own(package, quarters, width, height, depth):
    fb = noise(package, 12, 11, depth)
    view = fb.view(2, 1, width, height)
    turned, wanted = view.turned(quarters), view.pixels.copy()
    for _ in range(quarters % 4):
        wanted = wanted[::-1].T
    assert turned.depth == depth
    assert (turned.pixels == wanted).all()
    assert turned.turned(-quarters) == view
    turned.clear()
    assert not turned.pixels.any()
    assert fb == noise(package, 12, 11, depth)
    with pytest.raises(TypeError, match="quarters must be a whole number"):
        view.turned(0.5)


@pytest.mark.parametrize(("size", "name"), [((-1, 2), "w"), ((2, -1), "h")])
def test_a_clip_has_no_negative_size(package, size, name):
    with pytest.raises(ValueError, match=f"^{name} must not be negative"):
        package.Framebuffer(10, 8).clip(0, 0, *size)
