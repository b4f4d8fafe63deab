"""Sprites from strings, bytes, C source and sheets."""

from __future__ import annotations

import contextlib
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from PIL import Image


def test_a_drawing_is_read_as_it_is_written(package):
    sprite = package.Sprite("""
        .#3
        0 f
    """)
    assert (sprite.width, sprite.height, sprite.depth) == (3, 2, 4)
    assert sprite.levels.pixels.tolist() == [[0, 15, 3], [0, 0, 15]]
    assert sprite.opacity.tolist() == [[0, 255, 255], [255, 0, 255]]


@pytest.mark.parametrize("call", ["blit", "image"])
def test_what_is_transparent_is_not_drawn(package, call):
    fb = package.Framebuffer(4, 2, 4)
    fb.fill(5)
    getattr(fb, call)(package.Sprite(".#3\n0 f"), 1, 0)
    assert fb.pixels.tolist() == [[5, 5, 15, 3], [5, 0, 5, 15]]


@pytest.mark.parametrize("call", ["blit", "image"])
@pytest.mark.parametrize(
    ("op", "row"), [("xor", [5, 10, 6]), ("add", [5, 15, 8]), ("max", [5, 15, 5]), ("clear", [5, 0, 0])]
)
def test_operations(package, call, op, row):
    fb = package.Framebuffer(3, 1, 4)
    fb.fill(5)
    getattr(fb, call)(package.Sprite(".f3"), 0, 0, op=op)
    assert fb.pixels.tolist() == [row]


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
def test_the_highest_level_is_so_everywhere(package, depth):
    fb = package.Framebuffer(2, 1, depth)
    fb.blit(package.Sprite("#."), 0, 0)
    assert fb.pixels.tolist() == [[2**depth - 1, 0]]


@given(arrays.arrays(np.uint8, st.tuples(st.integers(1, 9), st.integers(1, 9)), elements=st.integers(0, 1)))
def test_what_a_framebuffer_prints_is_a_sprite(package, bits):
    fb = package.Framebuffer(bits.shape[1], bits.shape[0])
    fb.pixels[:] = bits
    assert (package.Sprite(str(fb)).levels.pixels == bits).all()
    assert package.Sprite(fb).levels == fb


@pytest.mark.parametrize("bad", ["", "\n\n", "#?", "12g", "#\tz"])
def test_other_texts(package, bad):
    with pytest.raises(ValueError, match=r"sprite"):
        package.Sprite(bad)


@pytest.mark.parametrize("bad", [None, 5, object(), [[1]]])
def test_other_things(package, bad):
    with pytest.raises(TypeError, match=r"^picture must be "):
        package.Sprite(bad)


def test_pictures(package, tmp_path):
    gray = np.random.default_rng(1).integers(0, 256, (4, 5), np.uint8)
    Image.fromarray(gray).save(tmp_path / "a.png")
    for picture in (gray, Image.fromarray(gray), Path(tmp_path / "a.png")):
        sprite = package.Sprite(picture)
        assert (sprite.levels.pixels == gray).all()
        assert sprite.opacity is None


# -- Bytes, by the formats' definitions

READ = {
    "MONO_HLSB": lambda data, w, x, y: data[y * ((w + 7) // 8) + x // 8] >> 7 - x % 8 & 1,
    "MONO_HMSB": lambda data, w, x, y: data[y * ((w + 7) // 8) + x // 8] >> x % 8 & 1,
    "MONO_VLSB": lambda data, w, x, y: data[y // 8 * w + x] >> y % 8 & 1,
    "MONO_VMSB": lambda data, w, x, y: data[y // 8 * w + x] >> 7 - y % 8 & 1,
    "GS2_HMSB": lambda data, w, x, y: data[y * ((w + 3) // 4) + x // 4] >> x % 4 * 2 & 3,
    "GS4_HMSB": lambda data, w, x, y: data[y * ((w + 1) // 2) + x // 2] >> (0 if x % 2 else 4) & 15,
    "GS8": lambda data, w, x, y: data[y * w + x],
}
LENGTH = {
    "MONO_HLSB": lambda w, h: (w + 7) // 8 * h,
    "MONO_VLSB": lambda w, h: (h + 7) // 8 * w,
    "GS2_HMSB": lambda w, h: (w + 3) // 4 * h,
    "GS4_HMSB": lambda w, h: (w + 1) // 2 * h,
    "GS8": lambda w, h: w * h,
}
LENGTH |= {"MONO_HMSB": LENGTH["MONO_HLSB"], "MONO_VMSB": LENGTH["MONO_VLSB"]}


@pytest.mark.parametrize("format", READ)
@given(st.integers(1, 20), st.integers(1, 20), st.data())
def test_formats(package, format, width, height, data):
    length = LENGTH[format](width, height)
    held = data.draw(st.binary(min_size=length, max_size=length))
    wanted = [[READ[format](held, width, x, y) for x in range(width)] for y in range(height)]
    for form in (held, bytearray(held), list(held), np.frombuffer(held, np.uint8)):
        sprite = package.Sprite.from_bytes(form, width, height, format, transparent=True)
        assert sprite.levels.pixels.tolist() == wanted
        assert (package.Sprite.from_bytes(form, width, height, format).opacity) is None
        if sprite.opacity is not None:
            assert ((sprite.opacity == 255) == (np.array(wanted) > 0)).all()


def test_colors(package):
    words = np.array([0, 0xFFFF, 0xF800, 0x07E0, 0x001F], "<u2")
    sprite = package.Sprite.from_bytes(words.tobytes(), 5, 1, "RGB565")
    assert sprite.levels.pixels.tolist() == [[0, 255, 76, 150, 29]]


@pytest.mark.parametrize("format", LENGTH)
def test_other_lengths(package, format):
    for wrong in (0, LENGTH[format](9, 5) - 1, LENGTH[format](9, 5) + 1):
        with pytest.raises(ValueError, match=rf"^9 x 5 pixels of {format} are \d+ bytes, and data has {wrong}$"):
            package.Sprite.from_bytes(bytes(wrong), 9, 5, format)


@pytest.mark.parametrize("size", [(0, 8), (8, 0), (-8, 8), (65537, 1)])
def test_other_sizes(package, size):
    with pytest.raises(ValueError, match=r"^width and height must be 1 to 65536, not "):
        package.Sprite.from_bytes(b"", *size)


@pytest.mark.parametrize("bad", [None, 5, "\0" * 8, [300] * 8, [-1] * 8, [1.5] * 8, object()])
def test_other_data(package, bad):
    with pytest.raises(TypeError, match=r"^data must be bytes or numbers 0 \.\.\. 255, not "):
        package.Sprite.from_bytes(bad, 8, 8)


@pytest.mark.parametrize("bad", ["", "MONO", None, 3])
def test_other_formats(package, bad):
    with pytest.raises(ValueError, match=r"^format must be one of MONO_HLSB, "):
        package.Sprite.from_bytes(bytes(8), 8, 8, bad)


# -- C source

IMAGE2CPP = """
// 'arrow', 10x3px
const unsigned char epd_bitmap_arrow [] PROGMEM = {
	0x18, 0x00, 0xff, 0xc0, // the shaft
	0x18, 0x00
};

// Array of all bitmaps for convenience. (Total bytes used to store images in PROGMEM = 32)
const int epd_bitmap_allArray_LEN = 1;
const unsigned char* epd_bitmap_allArray[1] = {
	epd_bitmap_arrow
};
"""
ARROW = ["...##.....", "##########", "...##....."]


def test_image2cpp(package):
    sprite = package.Sprite.from_c(IMAGE2CPP)
    assert package.Sprite.from_c(IMAGE2CPP, name="epd_bitmap_arrow") == sprite
    assert str(sprite.levels).split() == ARROW
    first = IMAGE2CPP.split("// Array")[0]
    assert package.Sprite.from_c(first) == sprite
    assert package.Sprite.from_c(first, 8, 6).levels.pixels.shape == (6, 8)


@pytest.mark.parametrize(
    "start",
    [
        "static char a_bits[] = {",
        "static const unsigned char a_bits[] U8X8_PROGMEM = {",
        "const uint8_t PROGMEM a_bits[6] = {",
        'static const uint8_t a_bits[] __attribute__((section(".rodata"))) = {',
        "/* drawn { by } hand */ static const unsigned char a_bits [ ] = {",
        "constexpr std::uint8_t a_bits[] = {",
    ],
)
@pytest.mark.parametrize(
    "numbers", ["0x18,0x00,0xff,0x03,0x18,0x00", "24, 0U, B11111111, 0b11, 030, 0x0,", "0X18,0,-1,3,24,0"]
)
def test_xbm(package, start, numbers):
    text = f"#define a_width 10\n#define a_height 3\n#define a_x_hot 1\n{start}\n   {numbers} }};\n"
    sprite = package.Sprite.xbm(text)
    assert str(sprite.levels).split() == ARROW
    assert package.Sprite.xbm(text, transparent=True).opacity.max() == 255


def test_xbm_of_16_bits(package):
    text = "#define a_width 10\n#define a_height 3\nstatic short a_bits[] = { 0x0018, 0x03ff, 0x0018 };"
    assert str(package.Sprite.xbm(text).levels).split() == ARROW
    narrow = "#define a_width 4\n#define a_height 2\nstatic short a_bits[] = { 0x0001, 0x0008 };"
    assert str(package.Sprite.xbm(narrow).levels).split() == ["#...", "...#"]


def test_rows_in_braces(package):
    sprite = package.Sprite.from_c("const byte icons[2][3] = { {0x18, 0x00, 0xff}, {0xc0, 0x18, 0x00} };", 10, 3)
    assert str(sprite.levels).split() == ARROW


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no array"),
        ("int x = 3;", "has no array"),
        ("char a[] = {1}; char b[] = {2};", "a, b"),
        ("char a[] = {1};", "size of a"),
        ("#define a_width 8\n#define a_height 2\nchar a[] = {1};", "are 2 bytes, and data has 1"),
        ("#define a_width 8\n#define a_height 1\nchar a[] = {x};", "'x' is no number"),
        ("#define a_width 8\n#define a_height 1\nchar a[] = {256};", "more than 8 bits"),
        ("#define a_width 0\n#define a_height 1\nchar a[] = {1};", "width and height"),
        ("char a[] = {1", "has no array"),
    ],
)
def test_texts_that_hold_no_picture(package, text, message):
    with pytest.raises(ValueError, match=message):
        package.Sprite.from_c(text)


@pytest.mark.parametrize("bad", [None, b"", 5])
def test_source_is_text(package, bad):
    for read in (package.Sprite.from_c, package.Sprite.xbm):
        with pytest.raises(TypeError, match=r"^text must be "):
            read(bad)


@given(st.text(alphabet="ab[]{}=;,0x1 \n#/*'", max_size=60))
def test_any_text_is_a_picture_or_an_error(package, text):
    sprite = None
    with contextlib.suppress(ValueError):
        sprite = package.Sprite.from_c(text, 8, 1)
    assert sprite is None or sprite.levels.pixels.shape == (1, 8)


# -- Sheets and turns


def test_sheets(package):
    gray = np.arange(7 * 11, dtype=np.uint8).reshape(7, 11)
    found = package.Sprite.sheet(gray, 3, 2, gap=1)
    assert len(found) == 6
    for number, sprite in enumerate(found):
        y, x = number // 3 * 3, number % 3 * 4
        assert (sprite.levels.pixels == gray[y : y + 2, x : x + 3]).all()


def test_a_sheet_that_is_transparent(package):
    sheet = np.zeros((2, 4, 4), np.uint8)
    sheet[:, 2:] = 255
    left, right = package.Sprite.sheet(Image.fromarray(sheet), 2, 2)
    assert not left.opacity.any()
    assert right.opacity is None
    assert [one.levels.pixels.sum() for one in package.Sprite.sheet(package.Sprite("##..\n##.."), 2, 2)] == [4, 0]


@pytest.mark.parametrize("size", [(0, 1), (1, 0), (9, 1), (1, 9), (-1, 1)])
def test_sheets_without_a_sprite(package, size):
    with pytest.raises(ValueError, match=r"^no sprite of "):
        package.Sprite.sheet(np.zeros((8, 8), np.uint8), *size)


@pytest.mark.parametrize("quarters", range(-5, 6))
def test_turns(package, quarters):
    sprite = package.Sprite("#2.\n0 #")
    turned = sprite.turned(quarters)
    wanted = np.rot90(sprite.levels.pixels, -quarters)
    assert (turned.levels.pixels == wanted).all()
    assert (turned.opacity == np.rot90(sprite.opacity, -quarters)).all()
    assert turned.turned(-quarters) == sprite
    assert sprite.mirrored().levels.pixels.tolist() == sprite.levels.pixels[:, ::-1].tolist()
    assert sprite.mirrored().mirrored() == sprite
    assert (sprite == 3) is False
