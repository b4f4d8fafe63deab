"""Pictures in: every kind of array and of Pillow image, and how their grays become levels."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from PIL import Image

DEPTHS = (1, 2, 4, 8)
grays = arrays.arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9)))


def painted(package, picture, depth=8, before=0, **options):
    """The levels of a framebuffer as large as the picture, painted over `before`."""
    height, width = np.asarray(picture).shape[:2]
    fb = package.Framebuffer(width, height, depth)
    fb.fill(before)
    fb.image(picture, **options)
    return fb.pixels


@given(grays, st.sampled_from(DEPTHS))
def test_grays_become_the_nearest_level(package, gray, depth):
    """There always is one: 255 being odd, no gray lies halfway between two levels."""
    top = 2**depth - 1
    nearest = [[min(range(top + 1), key=lambda k: abs(g * top - k * 255)) for g in row] for row in gray.tolist()]
    assert painted(package, gray, depth).tolist() == nearest


def test_true_is_white(package):
    picture = np.array([[True, False, True]])
    assert painted(package, picture, 4).tolist() == [[15, 0, 15]]


def test_false_is_painted_black(package):
    assert painted(package, np.zeros((1, 2), bool), 4, before=9).tolist() == [[0, 0]]


@given(arrays.arrays(np.uint8, st.tuples(st.integers(1, 5), st.integers(1, 5), st.just(3))))
def test_colors_become_their_luma(package, rgb):
    assert (painted(package, rgb) == np.asarray(Image.fromarray(rgb).convert("L"))).all()
    assert np.abs(painted(package, rgb) - rgb @ [0.299, 0.587, 0.114]).max() < 1


@given(st.integers(0, 255), st.integers(0, 255), st.integers(0, 255))
def test_what_is_transparent_lets_shine_through(package, before, gray, alpha):
    picture = np.array([[[gray, gray, gray, alpha]]], np.uint8)
    mixed = (before * (255 - alpha) + gray * alpha) / 255
    assert painted(package, picture, 8, before).tolist() == [[round(mixed)]]


@pytest.mark.parametrize("depth", DEPTHS)
def test_opaque_covers_and_clear_does_not(package, depth):
    picture = np.array([[[255, 255, 255, 255], [255, 255, 255, 0], [0, 0, 0, 255], [0, 0, 0, 0]]], np.uint8)
    top = 2**depth - 1
    assert painted(package, picture, depth, before=0).tolist() == [[top, 0, 0, 0]]
    assert painted(package, picture, depth, before=top).tolist() == [[top, top, 0, top]]


@pytest.mark.parametrize(
    "mode", ["1", "L", "P", "RGB", "RGBA", "LA", "PA", "CMYK", "YCbCr", "HSV", "RGBX", "RGBa", "I"]
)
def test_images_of_every_mode(package, mode):
    image = Image.new("L", (2, 1))
    image.putpixel((1, 0), 255)
    image = image.convert("RGB").convert("RGBA").convert(mode) if mode in ("PA", "RGBa") else _converted(image, mode)
    assert image.mode == mode
    levels = painted(package, image)
    assert levels[0, 0] <= 1
    assert levels[0, 1] >= 254


def _converted(image, mode):
    return image.convert(mode) if mode in ("1", "L", "LA", "I") else image.convert("RGB").convert(mode)


def test_a_palette_is_looked_up(package):
    image = Image.new("P", (3, 1))
    image.putpalette([10, 10, 10, 200, 200, 200, 90, 90, 90])
    for x in range(3):
        image.putpixel((x, 0), x)
    assert painted(package, image).tolist() == [[10, 200, 90]]
    image.info["transparency"] = 1
    assert painted(package, image, before=50).tolist() == [[10, 50, 90]]
    image.info["transparency"] = bytes([255, 0, 128])
    assert painted(package, image, before=50).tolist() == [[10, 50, 70]]


def test_a_color_that_stands_for_nothing_is_transparent(package):
    image = Image.new("RGB", (2, 1), (7, 7, 7))
    image.putpixel((1, 0), (99, 99, 99))
    image.info["transparency"] = (7, 7, 7)
    assert painted(package, image, before=50).tolist() == [[50, 99]]


def test_sixteen_bits_keep_their_shades(package):
    image = Image.fromarray(np.array([[0, 255, 256, 0x8000, 0xFFFF]], np.uint16))
    assert image.mode == "I;16"
    assert painted(package, image).tolist() == [[0, 0, 1, 128, 255]]


@given(grays, st.integers(-12, 20), st.integers(-12, 20))
def test_pictures_are_cut_off_at_every_side(package, gray, x, y):
    fb = package.Framebuffer(11, 8, 8)
    fb.fill(1)
    fb.image(gray, x, y)
    page = np.ones((60, 60), np.uint8)
    page[20 + y :, 20 + x :][: gray.shape[0], : gray.shape[1]] = gray
    assert (fb.pixels == page[20:28, 20:31]).all()


@pytest.mark.parametrize("far", [2**31, -(2**31), 2**63, -(2**70), 1e300, -1e300])
def test_pictures_far_away_are_not_seen(package, far):
    fb = package.Framebuffer(8, 8)
    picture = np.full((4, 4), 255, np.uint8)
    for x, y in ((far, 0), (0, far), (far, far)):
        fb.image(picture, x, y)
        fb.image(Image.fromarray(picture), x, y)
    assert not fb.pixels.any()


def test_pictures_lie_at_the_nearest_pixel(package):
    fb = package.Framebuffer(3, 3)
    fb.image(np.ones((1, 1), bool), 0.5, 1.4)
    assert np.argwhere(fb.pixels).tolist() == [[1, 1]]


@pytest.mark.parametrize("shape", [(0, 3), (3, 0), (0, 0), (0, 3, 3), (3, 0, 4)])
@pytest.mark.parametrize("dither", [None, "bayer", "floyd-steinberg"])
def test_pictures_without_pixels_paint_nothing(package, shape, dither):
    fb = package.Framebuffer(4, 4)
    fb.image(np.full(shape, 255, np.uint8), dither=dither)
    assert not fb.pixels.any()


def test_arrays_in_any_order_are_the_same_picture(package):
    gray = np.arange(48, dtype=np.uint8).reshape(6, 8)
    wide = np.zeros((12, 16), np.uint8)
    wide[::2, ::2] = gray
    for same in (np.asfortranarray(gray), gray[::-1][::-1], wide[::2, ::2], gray.T.copy().T):
        assert (painted(package, same) == gray).all()


def test_a_picture_is_not_changed(package):
    gray = np.arange(48, dtype=np.uint8).reshape(6, 8)
    for dither in (None, "bayer", "floyd-steinberg"):
        painted(package, gray, 1, dither=dither)
    assert gray.ravel().tolist() == list(range(48))


@pytest.mark.parametrize("depth", [1, 2, 4])
@pytest.mark.parametrize("dither", ["bayer", "floyd-steinberg"])
@given(gray=st.integers(0, 255))
def test_dithers_keep_the_brightness_of_an_area(package, depth, dither, gray):
    levels = painted(package, np.full((32, 32), gray, np.uint8), depth, dither=dither)
    top = 2**depth - 1
    # An ordered dither has 64 thresholds; diffusion keeps all but the error carried over the edge.
    assert abs(levels.mean() - gray * top / 255) <= (1 / 64 if dither == "bayer" else 1 / 16)
    assert levels.max() - levels.min() <= 1


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("dither", [None, "bayer", "floyd-steinberg"])
def test_what_is_a_level_already_is_not_dithered(package, depth, dither):
    top = 2**depth - 1
    levels = np.arange(top + 1).repeat(8).reshape(-1, 8)
    gray = (levels * 255 // top).astype(np.uint8)
    assert (painted(package, gray, depth, dither=dither) == levels).all()


def test_an_error_goes_seven_three_five_and_one_sixteenths_of_its_way(package):
    """Four pixels by hand.

    96 is dark and hands on 96: to its right 42, so that 100 becomes 142, is lit and hands on -113.
    Below, 0 becomes 96 * 5/16 - 113 * 3/16 = 8.8, and 130 becomes 130 + 96/16 - 113 * 5/16 + 8.8 * 7/16 = 104.5.
    """
    gray = np.array([[96, 100], [0, 130]], np.uint8)
    assert painted(package, gray, 1, dither="floyd-steinberg").tolist() == [[0, 1], [0, 0]]
    assert painted(package, gray, 1).tolist() == [[0, 0], [0, 1]]


def test_an_ordered_dither_stays_where_it_is(package):
    """The pattern belongs to the picture: parts that do not change do not flicker."""
    gray = np.full((16, 16), 100, np.uint8)
    before = painted(package, gray, 1, dither="bayer")
    gray[:8] = 200
    after = painted(package, gray, 1, dither="bayer")
    assert (before[8:] == after[8:]).all()
    assert (before[8:] == before[:8]).all()


@pytest.mark.parametrize("bad", [[[1]], None, 5, object()])
def test_other_things_are_no_pictures(package, bad):
    with pytest.raises(TypeError, match=r"^picture must be a numpy array, a Pillow image or a path, not "):
        package.Framebuffer(4, 4).image(bad)


@pytest.mark.parametrize("dtype", [float, int, np.int8, np.uint16, complex, object, "U1"])
def test_arrays_hold_bytes_or_truths(package, dtype):
    with pytest.raises(TypeError, match=r"^picture must hold uint8 grays 0 \.\.\. 255 or bool, not "):
        package.Framebuffer(4, 4).image(np.zeros((2, 2), dtype))


@pytest.mark.parametrize("shape", [(), (4,), (2, 2, 1), (2, 2, 2), (2, 2, 5), (2, 2, 3, 1)])
def test_arrays_have_the_shape_of_a_picture(package, shape):
    with pytest.raises(ValueError, match=r"^picture must have the shape "):
        package.Framebuffer(4, 4).image(np.zeros(shape, np.uint8))


@pytest.mark.parametrize("bad", ["", "floyd", True, 1, []])
def test_dithers_are_known(package, bad):
    with pytest.raises(ValueError, match=r'^dither must be None, "bayer", "floyd-steinberg", "blue-noise" or '):
        package.Framebuffer(4, 4).image(np.zeros((2, 2), np.uint8), dither=bad)


@pytest.mark.parametrize("mode", ["1", "L"])
@pytest.mark.parametrize("made", ["new", "over an array", "cut", "in pieces", "of a file", "empty"])
def test_images_are_read_wherever_they_lie(package, mode, made, tmp_path):
    """Pillow lends the bytes of an image that lies in one piece; of others they are copied out."""
    gray = np.random.default_rng(3).integers(0, 2, (37, 50), np.uint8) * 255
    image = Image.fromarray(gray > 0) if mode == "1" else Image.fromarray(gray)
    if made == "new":
        image = image.copy()
    elif made == "cut":
        image = image.crop((3, 5, 40, 30))
    elif made == "in pieces":
        before = Image.core.get_block_size()
        Image.core.set_block_size(4096)
        try:
            image = image.resize((300, 37), Image.Resampling.NEAREST)
        finally:
            Image.core.set_block_size(before)
    elif made == "of a file":
        image.save(tmp_path / "picture.png")
        image = Image.open(tmp_path / "picture.png")
        assert image.mode == mode
    elif made == "empty":
        image = image.crop((3, 3, 3, 9))
    for depth in DEPTHS:
        fb = package.Framebuffer(60, 40, depth)
        fb.image(image, 1, 2)
        wanted = np.zeros((40, 60), np.uint8)
        lit = np.asarray(image) > 0
        wanted[2 : 2 + lit.shape[0], 1 : 1 + lit.shape[1]] = (lit * (2**depth - 1))[:38, :59]
        assert (fb.pixels == wanted).all()


def test_a_picture_by_its_path(package, tmp_path):
    gray = np.random.default_rng(1).integers(0, 256, (5, 7), np.uint8)
    Image.fromarray(gray).save(tmp_path / "a.png")
    named, given = package.Framebuffer(9, 9, 8), package.Framebuffer(9, 9, 8)
    named.image(str(tmp_path / "a.png"), 1, 2)
    given.image(gray, 1, 2)
    assert named == given
    with pytest.raises(FileNotFoundError):
        named.image(tmp_path / "b.png")
