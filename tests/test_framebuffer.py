"""What a framebuffer is: pixels in memory that can be read, written, compared, shown and saved."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image
from searching import at_both_speeds

from paneldraw.testing import assert_pattern

DEPTHS = (1, 2, 4, 8)


def shades(package, depth):
    """All levels, or 256 of them, one after the other."""
    fb = package.Framebuffer(2**depth, 1, depth)
    fb.pixels[0] = range(2**depth)
    return fb


@pytest.mark.parametrize("depth", DEPTHS)
def test_a_new_framebuffer_is_dark(package, depth):
    fb = package.Framebuffer(5, 3, depth)
    assert (fb.width, fb.height, fb.depth, fb.max_level, fb.antialias) == (5, 3, depth, 2**depth - 1, None)
    assert fb.pixels.shape == (3, 5)
    assert fb.pixels.dtype == np.uint8
    assert not fb.pixels.any()


def test_one_bit_a_pixel_unless_said_otherwise(package):
    assert package.Framebuffer(5, 3) == package.Framebuffer(5, 3, 1) == package.Framebuffer(5, 3, depth=1)


@pytest.mark.parametrize("depth", DEPTHS)
def test_the_highest_level_unless_said_otherwise(package, depth):
    fb = package.Framebuffer(20, 8, depth)
    fb.line(0, 0, 1, 0)
    fb.lines([(2, 0, 3, 0)])
    fb.points([(4, 0)])
    fb.hline(5, 0, 1)
    fb.vline(6, 0, 1)
    fb.rect(7, 0, 1, 1)
    fb.circle(8, 0, 0)
    fb.text("|", 10, 0)
    assert fb.pixels[0].tolist() == [fb.max_level] * 9 + [0] * 3 + [fb.max_level] + [0] * 7


def test_pixels_are_the_memory_that_is_drawn_on(package):
    fb = package.Framebuffer(4, 2, depth=4)
    fb.pixel(1, 0, 5)
    assert fb.pixels[0, 1] == 5
    fb.pixels[1, 2] = 7
    assert fb.pixel(2, 1) == 7
    fb.pixels[...] = 3
    assert_pattern(
        fb,
        """
        3333
        3333
        """,
    )


def test_pixels_stay_when_the_framebuffer_goes(package):
    pixels = package.Framebuffer(300, 300, depth=8).pixels
    pixels[...] = 200
    assert (pixels == 200).all()


def test_pixels_outside_are_dark_and_unpaintable(package):
    fb = package.Framebuffer(3, 2)
    fb.fill(1)
    for x, y in ((-1, 0), (3, 0), (0, -1), (0, 2), (2**70, 0), (0, -(2**70)), (-1e300, 0.0)):
        assert fb.pixel(x, y) == 0
        assert fb.pixel(x, y, 0) is None
    assert fb.pixels.all()
    assert type(fb.pixel(0, 0)) is int


@pytest.mark.parametrize("name", ["pixels", "width", "height", "depth", "max_level"])
def test_what_is_decided_stays(name):
    from paneldraw import Framebuffer

    with pytest.raises(AttributeError):
        setattr(Framebuffer(3, 2), name, 1)


def test_an_anti_aliasing_of_its_own(package):
    fb = package.Framebuffer(12, 5, 4, antialias=package.Supersample(4))
    fb.line(1, 1, 10, 3)
    said = package.Framebuffer(12, 5, 4)
    said.line(1, 1, 10, 3, antialias=package.Supersample(4))
    assert fb == said
    batch = package.Framebuffer(12, 5, 4, antialias=package.Supersample(4))
    batch.lines([(1, 1, 10, 3)])
    assert batch == said
    fb.antialias = None
    fb.clear()
    fb.line(1, 1, 10, 3)
    said.clear()
    said.line(1, 1, 10, 3)
    assert fb == said
    with pytest.raises(TypeError, match="antialias"):
        fb.antialias = 4
    assert fb.antialias is None


def test_samples_are_values(package):
    four = package.Supersample()
    assert (four.n, four.reference) == (4, "center")
    assert four == package.Supersample(4) != package.Supersample(4, "corner")
    assert package.Supersample(4) != package.Supersample(5)
    assert four != 4
    assert len({four, package.Supersample(4, "center"), package.Supersample(4, "corner")}) == 2
    assert eval(repr(four), {"Supersample": package.Supersample}) == four
    assert repr(package.Supersample(2, "corner")) == "Supersample(n=2, reference='corner')"


def test_samples_can_be_pickled():
    import pickle

    from paneldraw import Supersample

    assert pickle.loads(pickle.dumps(Supersample(3, "corner"))) == Supersample(3, "corner")


def test_samples_cannot_be_changed():
    from paneldraw import Supersample

    with pytest.raises(AttributeError):
        Supersample(4).n = 5
    with pytest.raises(AttributeError):
        Supersample(4).reference = "corner"


def test_equal_are_the_same_levels_at_the_same_depth(package):
    fb, other = package.Framebuffer(4, 3, 2), package.Framebuffer(4, 3, 2)
    assert fb == other
    assert (fb != other) is False
    other.pixel(3, 2, 1)
    assert fb != other
    assert fb != package.Framebuffer(3, 4, 2)
    assert fb != package.Framebuffer(4, 3, 1)
    assert fb != "....\n....\n...."
    assert (fb == fb.pixels.tolist()) is False


def test_what_can_change_is_no_key(package):
    with pytest.raises(TypeError, match="unhashable"):
        hash(package.Framebuffer(2, 2))


@pytest.mark.parametrize(
    ("depth", "text"),
    [(1, ".#"), (2, ".123"), (4, ".123456789abcdef"), (8, "." + "1" * 31 + "".join(c * 16 for c in "23456789abcdef"))],
)
def test_as_text_each_pixel_is_a_character(package, depth, text):
    assert str(shades(package, depth)) == text


def test_as_text_each_row_is_a_line(package):
    assert str(package.Framebuffer(3, 2)) == "...\n..."


def test_its_description_makes_one_like_it(package):
    fb = package.Framebuffer(3, 2, 4)
    assert repr(fb) == "Framebuffer(3, 2, depth=4)"
    assert eval(repr(fb), {"Framebuffer": package.Framebuffer}) == fb


@pytest.mark.parametrize("depth", DEPTHS)
def test_as_an_image_levels_run_from_black_to_white(package, depth):
    image = shades(package, depth).to_image()
    assert image.mode == ("1" if depth == 1 else "L")
    grays = np.asarray(image.convert("L"))[0].tolist()
    assert grays == [level * 255 // (2**depth - 1) for level in range(2**depth)]


def test_an_image_is_a_copy(package):
    fb = package.Framebuffer(2, 2, 8)
    image = fb.to_image()
    fb.fill(9)
    assert image.getpixel((0, 0)) == 0


def test_an_image_can_be_enlarged(package):
    fb = package.Framebuffer(2, 1)
    fb.pixel(1, 0, 1)
    image = fb.to_image(3)
    assert image.size == (6, 3)
    assert np.asarray(image).tolist() == [[False] * 3 + [True] * 3] * 3


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("ending", [".png", ".bmp"])
def test_what_is_saved_can_be_painted_again(package, tmp_path, depth, ending):
    fb = shades(package, depth)
    path = tmp_path / f"picture{ending}"
    fb.save(path)
    again = package.Framebuffer(fb.width, 1, depth)
    with Image.open(path) as image:
        again.image(image)
    assert again == fb
    fb.save(str(path), scale=2)
    with Image.open(path) as image:
        assert image.size == (2 * fb.width, 2)


def test_files_need_an_ending_that_says_how(package, tmp_path):
    with pytest.raises(ValueError, match="extension"):
        package.Framebuffer(2, 2).save(tmp_path / "picture.paneldraw")


def test_notebooks_show_it_enlarged(package):
    fb = shades(package, 2)
    with Image.open(io.BytesIO(fb._repr_png_())) as image:
        assert image.format == "PNG"
        assert image.size == (4 * fb.width, 4)
        assert np.asarray(image)[0, ::4].tolist() == [0, 85, 170, 255]


def test_numpy_sees_the_pixels_themselves(package):
    fb = shades(package, 4)
    assert np.asarray(fb) is fb.pixels
    assert np.array(fb, copy=False) is fb.pixels
    copy = np.array(fb)
    assert not np.shares_memory(copy, fb.pixels)
    assert copy.tolist() == fb.pixels.tolist()


def test_numpy_sees_other_numbers_in_a_copy(package):
    fb = shades(package, 4)
    for dtype in (np.float64, np.int16, bool):
        array = np.asarray(fb, dtype)
        assert array.dtype == dtype
        assert array.tolist() == fb.pixels.astype(dtype).tolist()
        with pytest.raises(ValueError, match="copied"):
            np.array(fb, dtype, copy=False)
    assert np.array(fb, np.uint8, copy=False) is fb.pixels
    assert not np.shares_memory(np.array(fb, float), fb.pixels)


@given(st.integers(1, 40), st.integers(1, 40), st.sampled_from(DEPTHS), st.data())
def test_fill_sets_every_pixel(package, width, height, depth, data):
    fb = package.Framebuffer(width, height, depth)
    level = data.draw(st.integers(0, fb.max_level))
    fb.fill(level)
    assert (fb.pixels == level).all()
    fb.clear()
    assert not fb.pixels.any()


@pytest.mark.parametrize(("package", "size"), at_both_speeds([(65536, 1), (1, 65536)], []), indirect=["package"])
def test_the_largest_framebuffers_can_be_drawn_to_their_ends(package, size):
    width, height = size
    fb = package.Framebuffer(width, height)
    fb.line(0, 0, width - 1, height - 1)
    assert fb.pixels.all()
    fb.line(0, 0, width - 1, height - 1, op="xor", antialias=package.Supersample(2))
    assert not fb.pixels.any()
    fb.circle(width - 1, height - 1, 2, fill=True)
    assert fb.pixels[-1, -1]
    assert fb.pixels.sum() == 3
