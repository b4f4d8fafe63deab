"""Pictures cropped, scaled and fitted, and painted by operations, against what that is defined to be."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from PIL import Image

OPS = ["over", "xor", "add", "max", "clear"]
sides = st.integers(1, 6)


def painted(package, picture, width, height, depth=8, before=0, x=0, y=0, **options):
    fb = package.Framebuffer(width, height, depth)
    fb.pixels[...] = before
    fb.image(picture, x, y, **options)
    return fb.pixels


def light(gray):
    share = np.asarray(gray) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def gray_of(share):
    return 255 * np.where(share <= 0.0031308, 12.92 * share, 1.055 * np.maximum(share, 1e-9) ** (1 / 2.4) - 0.055)


@given(st.data(), sides, sides, sides, sides)
def test_a_pixel_is_as_bright_as_the_pixels_that_it_stands_for(package, data, width, height, across, down):
    gray = data.draw(arrays.arrays(np.uint8, (height * down, width * across)))
    mean = light(gray).reshape(height, down, width, across).mean(axis=(1, 3))
    found = painted(package, gray, width, height, size=(width, height))
    assert np.abs(found - gray_of(mean)).max() <= 1.01


@pytest.mark.parametrize("mode", ["1", "L", "RGB", "RGBA", "P"])
def test_fine_lines_become_the_gray_that_is_half_the_light(package, mode):
    image = Image.fromarray((np.indices((64, 64)).sum(0) % 2 * 255).astype(np.uint8)).convert(mode)
    assert set(painted(package, image, 32, 32, size=(32, 32)).ravel().tolist()) == {188}
    assert np.abs(painted(package, image, 25, 25, size=(25, 25)).astype(int) - 188).max() < 12


def test_colors_are_mixed_before_they_become_grays(package):
    image = Image.fromarray(np.array([[[255, 0, 0], [0, 255, 0]]], np.uint8))
    mixed = Image.new("RGB", (1, 1), (188, 188, 0)).convert("L").getpixel((0, 0))
    assert painted(package, image, 1, 1, size=(1, 1)).tolist() == [[mixed]]


def test_what_is_transparent_adds_no_light(package):
    image = Image.fromarray(np.array([[[100, 100, 100, 255], [255, 255, 255, 0]]], np.uint8))
    # Half covered by 100, over 20.
    assert painted(package, image, 1, 1, before=20, size=(1, 1)).tolist() == [[60]]
    assert painted(package, image.convert("LA"), 1, 1, before=20, size=(1, 1)).tolist() == [[60]]


@given(arrays.arrays(bool, st.tuples(sides, sides)), st.integers(1, 4), st.integers(1, 4))
def test_black_and_white_stays_so_when_enlarged(package, bits, across, down):
    height, width = bits.shape[0] * down, bits.shape[1] * across
    wanted = bits.repeat(down, 0).repeat(across, 1) * 255
    for picture in (bits, Image.fromarray(bits), Image.fromarray(bits * np.uint8(255))):
        assert (painted(package, picture, width, height, size=(width, height)) == wanted).all()


@given(arrays.arrays(np.uint8, (12, 15)), st.integers(-40, 12), st.integers(-40, 9), st.booleans())
def test_what_is_seen_of_a_scaled_picture_is_part_of_the_whole(package, gray, x, y, larger):
    size = (40, 31) if larger else (9, 7)
    whole = painted(package, gray, *size, size=size)
    page = np.zeros((120, 120), np.uint8)
    page[50 + y : 50 + y + size[1], 50 + x : 50 + x + size[0]] = whole
    assert (painted(package, gray, 12, 9, x=x, y=y, size=size) == page[50:59, 50:62]).all()


@pytest.mark.parametrize("dither", [None, "bayer", "floyd-steinberg", "stable"])
def test_a_picture_as_large_as_can_be(package, dither):
    """Only what is seen of it is made."""
    gray = np.array([[0, 255], [255, 0]], np.uint8)
    found = painted(package, gray, 8, 8, 1, x=-32764, y=-4, size=(65536, 65536), dither=dither)
    assert found.tolist() == [[0] * 4 + [1] * 4] * 8


@given(st.integers(1, 30), st.integers(1, 30), st.integers(1, 20), st.integers(1, 20))
@example(30, 1, 3, 20)
def test_contain_is_the_largest_that_goes_in(package, width, height, wide, high):
    picture = np.full((height, width), 200, np.uint8)
    found = painted(package, picture, wide, high, size=(wide, high), fit="contain", fill=7)
    rows, columns = (found == 200).any(1), (found == 200).any(0)
    assert set(np.unique(found).tolist()) <= {7, 200}
    scale = min(wide / width, high / height)
    assert abs(columns.sum() - width * scale) <= 0.5 or columns.sum() == 1
    assert abs(rows.sum() - height * scale) <= 0.5 or rows.sum() == 1
    for lit in (rows, columns):
        before, after = lit.argmax(), lit[::-1].argmax()
        assert 0 <= after - before <= 1
    assert (found == 200).sum() == rows.sum() * columns.sum()


@given(st.integers(1, 30), st.integers(1, 30), st.integers(1, 12), st.integers(1, 12))
def test_cover_fills_with_the_middle(package, width, height, wide, high):
    x, y = np.meshgrid(np.linspace(0, 250, width), np.linspace(0, 250, height))
    for ramp in (x, y):
        ramp = np.rint(ramp).astype(np.uint8)
        found = painted(package, ramp, wide, high, before=0, size=(wide, high), fit="cover").astype(int)
        stretched = painted(package, ramp, wide, high, size=(wide, high), fit="stretch").astype(int)
        assert np.ptp(found) <= np.ptp(stretched) + 25
    assert (painted(package, np.full((height, width), 9, np.uint8), wide, high, fit="cover") == 9).all()


def test_a_fit_without_a_size_is_of_the_framebuffer(package):
    picture = np.full((10, 10), 255, np.uint8)
    fb = package.Framebuffer(20, 8, 8)
    fb.fill(3)
    fb.view(2, 0, 12, 8).image(picture, fit="contain", fill=5)
    assert fb.pixels[0].tolist() == [3] * 2 + [5] * 2 + [255] * 8 + [5] * 2 + [3] * 6


def test_fill_is_behind_what_is_transparent(package):
    picture = np.zeros((1, 2, 4), np.uint8)
    picture[0, 1] = 255
    assert painted(package, picture, 3, 1, before=9, fill=4).tolist() == [[4, 255, 9]]


def test_crop(package):
    gray = np.arange(48, dtype=np.uint8).reshape(6, 8)
    for picture in (gray, Image.fromarray(gray), Image.fromarray(gray).convert("RGB")):
        assert (painted(package, picture, 3, 2, crop=(2, 1, 3, 2)) == gray[1:3, 2:5]).all()
        assert (painted(package, picture, 6, 2, crop=(2, 1, 3, 2), size=(6, 2))[:, ::5] == gray[1:3, 2:5:2]).all()


@pytest.mark.parametrize(
    "crop", [(0, 0, 0, 1), (0, 0, 1, 0), (-1, 0, 2, 2), (0, 0, 9, 1), (0, 5, 1, 2), (0, 0, 2**70, 1)]
)
def test_crops_are_parts(package, crop):
    with pytest.raises(ValueError, match=r"^crop must be a part of the picture's 8 x 6 pixels, not "):
        package.Framebuffer(4, 4).image(np.zeros((6, 8), np.uint8), crop=crop)


@pytest.mark.parametrize("size", [(0, 1), (1, 0), (-1, 5), (65537, 1), (1, 2**70)])
def test_sizes_are_sizes(package, size):
    with pytest.raises(ValueError, match=r"^size must be 1 to 65536 pixels wide and high, not "):
        package.Framebuffer(4, 4).image(np.zeros((6, 8), np.uint8), size=size)


@pytest.mark.parametrize("bad", [5, (1,), (1, 2, 3), "ab", (1.5, 2), (None, 1), object()])
def test_sizes_are_two_whole_numbers(package, bad):
    with pytest.raises((TypeError, ValueError), match=r"^size must be "):
        package.Framebuffer(4, 4).image(np.zeros((6, 8), np.uint8), size=bad)


@pytest.mark.parametrize("bad", ["", "fill", True, 3, []])
def test_fits_are_known(package, bad):
    with pytest.raises(ValueError, match=r'^fit must be None, "contain", "cover" or "stretch", not '):
        package.Framebuffer(4, 4).image(np.zeros((6, 8), np.uint8), fit=bad)


def test_levels_to_fill_with_are_levels(package):
    with pytest.raises(ValueError, match=r"^fill must be a level from 0 to 1, not 2"):
        package.Framebuffer(4, 4).image(np.zeros((6, 8), np.uint8), fit="contain", fill=2)


@pytest.mark.parametrize("shape", [(0, 3), (3, 0)])
def test_nothing_scaled_is_nothing(package, shape):
    assert not painted(package, np.zeros(shape, np.uint8), 4, 4, size=(4, 4), fit="contain").any()


# -- Operations


def met(old, level, share, op, top):
    """What a pixel becomes that a level covers by share / 255."""
    part = (2 * level * share + 255) // 510
    if op in ("over", "clear"):
        level = 0 if op == "clear" else level
        return (2 * (old * (255 - share) + level * share) + 255) // 510
    return {"xor": old ^ part, "add": min(old + part, top), "max": max(old, part)}[op]


@pytest.mark.parametrize("op", OPS)
@given(st.data(), st.sampled_from([1, 2, 4, 8]), st.booleans(), st.booleans())
def test_images_meet_what_is_there(package, op, data, depth, transparent, pillow):
    top = 2**depth - 1
    gray = data.draw(arrays.arrays(np.uint8, (3, 4)))
    alpha = data.draw(arrays.arrays(np.uint8, (3, 4))) if transparent else np.full((3, 4), 255, np.uint8)
    before = data.draw(arrays.arrays(np.uint8, (3, 4), elements=st.integers(0, top)))
    picture = np.dstack([gray, gray, gray, alpha]) if transparent else gray
    levels = painted(package, gray, 4, 3, depth)
    found = painted(package, Image.fromarray(picture) if pillow else picture, 4, 3, depth, before, op=op)
    wanted = [
        [met(int(before[y, x]), int(levels[y, x]), int(alpha[y, x]), op, top) for x in range(4)] for y in range(3)
    ]
    assert found.tolist() == wanted


@pytest.mark.parametrize("op", OPS)
@given(st.data(), st.sampled_from([1, 2, 4, 8]), st.integers(-1, 3))
def test_copies_meet_what_is_there(package, op, data, depth, key):
    top = 2**depth - 1
    levels = st.integers(0, top)
    source, before = (data.draw(arrays.arrays(np.uint8, (3, 4), elements=levels)) for _ in range(2))
    for form in (source, _framebuffer(package, source, depth)):
        fb = _framebuffer(package, before, depth)
        fb.blit(form, 1, -1, key, op=op)
        wanted = before.astype(int)
        for y in range(2):
            for x in range(1, 4):
                level = int(source[y + 1, x - 1])
                if level != key:
                    wanted[y, x] = met(int(before[y, x]), level, 255, op, top)
        assert fb.pixels.tolist() == wanted.tolist()


def _framebuffer(package, levels, depth):
    fb = package.Framebuffer(levels.shape[1], levels.shape[0], depth)
    fb.pixels[:] = levels
    return fb


def test_a_framebuffer_meets_itself(package):
    fb = _framebuffer(package, np.array([[1, 2, 4, 8]], np.uint8), 4)
    fb.blit(fb, 1, 0, op="xor")
    assert fb.pixels.tolist() == [[1, 3, 6, 12]]


@pytest.mark.parametrize("bad", ["", "under", None, 0, []])
def test_operations_are_known(package, bad):
    for draw in (lambda fb: fb.image(np.zeros((2, 2), np.uint8), op=bad), lambda fb: fb.blit(fb, 0, 0, op=bad)):
        with pytest.raises(ValueError, match=r"^op must be one of "):
            draw(package.Framebuffer(4, 4))
