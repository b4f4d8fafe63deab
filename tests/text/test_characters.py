"""Characters that are not simply there: composed, invisible, missing, overhanging."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import sample_fonts as sample
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageDraw, ImageFont

from paneldraw import Font, Framebuffer
from paneldraw.text import render

DEJAVU = Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")
UNIFONT = Path("/usr/share/unifont/unifont.hex")
X11 = Path("/usr/share/fonts/X11/misc/6x13-ISO8859-1.pcf.gz")
TERMINUS = Path("/usr/share/fonts/opentype/terminus/terminus-normal.otb")

FONTS = {
    "built-in": Font.builtin,
    "outline": lambda: Font.load(sample.installed(DEJAVU), 13),
    "smooth": lambda: Font.load(sample.installed(DEJAVU), 13, antialias=True),
    "scaled outline": lambda: Font.load(sample.installed(DEJAVU), 13).scaled(2),
    "bitmap": lambda: Font.load(sample.installed(X11)),
    "bitmap of OpenType": lambda: Font.load(sample.installed(TERMINUS), 12),
    "Unifont": lambda: Font.load(sample.installed(UNIFONT)),
    "Pillow's": lambda: Font.from_pillow(ImageFont.load_default_imagefont()),
}


@pytest.fixture(params=FONTS)
def font(request):
    return FONTS[request.param]()


def test_letters_and_their_marks_are_one(font):
    for text in ("e\u0308", "A\u030a", "n\u0303"):
        assert (render(f"x{text}x", font)[0] == render(f"x{'ëÅñ'['eAn'.index(text[0])]}x", font)[0]).all()


@pytest.mark.parametrize("char", ["\u200b", "\u2060", "\ufeff", "\u00ad", "\u200e", "\ufe0f", "\u202c"])
def test_what_is_invisible_has_no_width(font, char):
    assert font.measure(f"a{char}b") == font.measure("ab")
    assert (render(f"a{char}b", font)[0] == render("ab", font)[0]).all()
    assert not font.glyph(char).any()


@pytest.mark.parametrize("char", ["\u00a0", "\u202f", "\u2007"])
def test_spaces_that_do_not_break_are_spaces(font, char):
    coverage = render(f"a{char}b", font)[0]
    assert font.measure(f"a{char}b")[0] > font.measure("ab")[0]
    assert coverage.any(axis=0).sum() == render("ab", font)[0].any(axis=0).sum()


def test_a_hyphen_that_does_not_break_is_one(font):
    assert render("a\u2011b", font)[0].sum() in {render("a-b", font)[0].sum(), render("a\u2010b", font)[0].sum()}


@pytest.mark.parametrize("char", ["\U0010ffff", "\ud800", "\x07", "\x00", "\ue123", "\r"])
def test_what_is_missing_is_a_box(font, char):
    assert font.glyph(char).any()
    assert font.measure(f"a{char}b")[0] > font.measure("ab")[0]


def test_a_box_stands_on_the_baseline():
    font = Font.load(sample.installed(DEJAVU), 13)
    box = font.glyph("\U0010ffff")
    assert box[font.baseline].sum() == box[font.baseline - 8].sum() > 0
    assert not box[font.baseline + 1 :].any()


def test_others_are_looked_in_for_what_is_missing(font):
    unifont = Font.load(sample.installed(UNIFONT))
    both = font.with_fallback(unifont)
    assert both.height == font.height
    coverage, _, dy = render("中", both, "ls")
    alone, _, dy_alone = render("中", unifont, "ls")
    rows = np.flatnonzero(coverage.any(axis=1)) + dy
    assert list(rows) == list(np.flatnonzero(alone.any(axis=1)) + dy_alone)
    assert (render("Ag", both)[0] == render("Ag", font)[0]).all()
    assert (render("\U0010fffe", both)[0] == render("\U0010fffe", font)[0]).all() or font.name == "unifont"


def test_fallbacks_are_asked_in_their_order():
    unifont, outline = Font.load(sample.installed(UNIFONT)), Font.load(sample.installed(DEJAVU), 13)
    assert (Font.builtin().with_fallback(outline, unifont).glyph("Ֆ") != 0).sum() == (outline.glyph("Ֆ") != 0).sum()
    assert (Font.builtin().with_fallback(unifont, outline).glyph("Ֆ") != 0).sum() == (unifont.glyph("Ֆ") != 0).sum()
    with pytest.raises(TypeError, match="Font"):
        outline.with_fallback("unifont")


LETTERS = "ÖÜÉÈÑ" + "ẤỆỐŰǺĢķ" + "fjQ_/|"


@pytest.mark.parametrize("antialias", [False, True])
@pytest.mark.parametrize("size", [5, 8, 10, 13, 24])
def test_no_ink_is_cut(size, antialias):
    outline = ImageFont.truetype(sample.installed(DEJAVU), size)
    font = Font.from_pillow(outline, antialias=antialias)
    for text in (*LETTERS, LETTERS):
        coverage, dx, dy = render(text, font, "ls")
        page = Image.new("L", (400, 120))
        draw = ImageDraw.Draw(page)
        draw.fontmode = "L" if antialias else "1"
        draw.text((60, 60), text, 255, outline, anchor="ls")
        ours = np.zeros((120, 400), np.uint8)
        ours[59 + dy :, 60 + dx :][: coverage.shape[0], : coverage.shape[1]] = coverage
        assert (ours == np.array(page)).all(), text


def test_ink_beyond_a_bitmap_fonts_line_is_kept(tmp_path):
    tall = np.ones((12, 9), np.uint8)
    (tmp_path / "tall.bdf").write_bytes(sample.bdf([(65, tall, -3, -4, 5), (66, sample.A, 0, 0, 5)]))
    font = Font.load(tmp_path / "tall.bdf")
    coverage, dx, dy = render("BAB", font)
    assert (dx, dy) == (0, -3)
    assert coverage.shape == (12, 15)
    fb = Framebuffer(24, 20)
    fb.text("A", 8, 8, font=font)
    assert fb.pixels.sum() == 12 * 9
    assert fb.pixels[5, 5] == fb.pixels[16, 13] == 1


def test_overlapping_letters_are_painted_once(tmp_path):
    wide = np.ones((5, 8), np.uint8)
    (tmp_path / "wide.bdf").write_bytes(sample.bdf([(65, wide, -2, 0, 4)]))
    font = Font.load(tmp_path / "wide.bdf")
    fb = Framebuffer(30, 8)
    fb.text("AAA", 4, 1, font=font, op="xor")
    assert fb.pixels.sum() == 5 * 16


@pytest.mark.parametrize("text", ["jA", "/x", "ÀÅ", "ffi", "__"])
def test_crisp_or_smooth_text_stands_at_the_same_place(text):
    for size in (9, 13, 20, 40):
        crisp, smooth = (
            render(text, Font.load(sample.installed(DEJAVU), size, antialias=choice), "ls") for choice in (False, True)
        )
        columns = [np.flatnonzero((cover >= 96).any(axis=0)) + dx for cover, dx, _ in (crisp, smooth)]
        assert abs(int(columns[0][0]) - int(columns[1][0])) <= 1
        assert crisp[2] - smooth[2] in (-1, 0, 1)


WAYS_TO_WRITE = {
    "line": lambda fb, font: fb.text("jÄg 21.5", 9, 3, 1, font=font),
    "anchor": lambda fb, font: fb.text("jÄg 21.5", 60, 20, 1, font=font, anchor="rs"),
    "lines": lambda fb, font: fb.text("jÄg\n21.5", 9, 3, 1, font=font, direction="down"),
    "box": lambda fb, font: fb.text_box("jÄg 21.5", 9, 3, 40, 60, 1, font=font),
    "inverse box": lambda fb, font: fb.text_box("jÄg 21.5", 9, 3, 40, 60, 1, font=font, inverse=True),
}
FROM_OUTLINES = {
    "load": lambda **how: Font.load(sample.installed(DEJAVU), 13, **how),
    "find": lambda **how: (sample.installed(DEJAVU), Font.find("DejaVu Sans", 13, **how))[1],
    "from_pillow": lambda **how: Font.from_pillow(ImageFont.load_default(13), **how),
    "scaled": lambda **how: Font.from_pillow(ImageFont.load_default(7), **how).scaled(2),
    "with_fallback": lambda **how: (
        Font.builtin().scaled(2).with_fallback(Font.from_pillow(ImageFont.load_default(13), **how))
    ),
}


@pytest.mark.parametrize("write", WAYS_TO_WRITE.values(), ids=WAYS_TO_WRITE)
@pytest.mark.parametrize("source", FROM_OUTLINES.values(), ids=FROM_OUTLINES)
def test_outlines_are_crisp_on_one_bit_and_smooth_on_grays(source, write):
    for depth in (1, 2, 4, 8):
        default, chosen = Framebuffer(80, 80, depth), Framebuffer(80, 80, depth)
        write(default, source())
        write(chosen, source(antialias=depth > 1))
        assert default == chosen
        assert default.pixels.any()


def test_edges_are_gray_where_there_are_grays_unless_told_otherwise():
    levels = []
    for antialias in (None, False, True):
        fb = Framebuffer(80, 20, 4)
        fb.text("Sag 8", 2, 2, font=Font.from_pillow(ImageFont.load_default(13), antialias=antialias))
        levels.append(set(np.unique(fb.pixels).tolist()))
    assert levels[1] == {0, 15}
    assert levels[0] == levels[2] > levels[1]


def test_kinds_of_pictures_are_kept_apart():
    font = Font.load(sample.installed(DEJAVU), 13)
    for depth in (4, 1, 4, 1):
        fb = Framebuffer(40, 20, depth)
        fb.text("Sag", 2, 2, font=font)
        assert bool(set(np.unique(fb.pixels).tolist()) - {0, fb.max_level}) == (depth > 1)


@pytest.mark.parametrize("anchor", ["la", "ls", "ra", "md"])
@pytest.mark.parametrize("text", ["jH", "Ho"])
def test_the_weight_of_a_text_lies_at_the_same_pixel_on_any_depth(text, anchor):
    for size in (12, 13, 16, 24):
        font = Font.load(sample.installed(DEJAVU), size)
        centers = []
        for depth in (1, 4):
            fb = Framebuffer(200, 60, depth)
            fb.text(text, 100, 30, font=font, anchor=anchor)
            weights = fb.pixels.astype(float)
            centers.append([(place * weights).sum() / weights.sum() for place in np.indices(weights.shape)])
        assert np.abs(np.subtract(*centers)).max() <= 0.75


def test_a_first_letter_that_overhangs_moves_nothing():
    font = Font.load(sample.installed(DEJAVU), 40)
    for text in ("jX", "/X"):
        assert render(text, font)[1] <= 0
        fb = Framebuffer(100, 60)
        fb.text(text, 20, 5, font=font)
        alone = Framebuffer(100, 60)
        alone.text("X", 20 + round(ImageFont.truetype(sample.installed(DEJAVU), 40).getlength(text[0])), 5, font=font)
        assert np.flatnonzero(fb.pixels.any(axis=0))[-1] == np.flatnonzero(alone.pixels.any(axis=0))[-1]


def test_pictures_of_lines_are_kept_and_bounded():
    font = Font.load(sample.installed(DEJAVU), 12)
    assert font._face.line("21.5") is font._face.line("21.5")
    for number in range(3000):
        font.measure(f"{number:040d}")
    assert font._face._size <= 1 << 20
    assert len(font._face._lines) < 3000


@given(st.text(max_size=12))
def test_any_text_in_a_bitmap_font(text):
    font = Font.from_pillow(ImageFont.load_default_imagefont())
    fb = Framebuffer(80, 30)
    fb.text(text, 2, 2, font=font)
    coverage, dx, dy = render(text, font)
    expected = np.zeros((200, 200), np.uint8)
    part = expected[2 + dy :, 2 + dx :][: coverage.shape[0], : coverage.shape[1]]
    part[:] = coverage[: part.shape[0], : part.shape[1]]
    assert (fb.pixels == (expected[:30, :80] > 0)).all()
