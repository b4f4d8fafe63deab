"""Fonts and layout: the built-in font as a picture, and the rules that hold for any text."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
import unicodedata
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageDraw, ImageFont

from paneldraw.text import Font, render

GOLDEN = Path(__file__).parents[1] / "golden" / "font_6x8.txt"
ASCII = "".join(map(chr, range(0x20, 0x7F)))
SIGNS = "°←↑→↓↔↕±×÷·²³µΩ…"  # noqa: RUF001
DESCENDERS = ",;_gjpqy|µ"


def picture(coverage):
    return "\n".join("".join("#" if ink else "." for ink in row) for row in coverage)


def sheet():
    characters = ASCII + SIGNS + "\N{REPLACEMENT CHARACTER}"
    return "\n".join(characters[start : start + 16] for start in range(0, len(characters), 16))


def test_the_font_is_as_it_was_drawn(request):
    if request.config.getoption("--update-frames"):
        GOLDEN.write_text(picture(render(sheet())[0]) + "\n", encoding="ascii")
    assert picture(render(sheet())[0]) + "\n" == GOLDEN.read_text(encoding="ascii")


def test_a_word_can_be_read():
    assert picture(render("Ag→1")[0]).split("\n") == [
        ".###................#..",
        "#...#.........#....##..",
        "#...#..####....#....#..",
        "#####.#...#.#####...#..",
        "#...#.#...#....#....#..",
        "#...#..####...#.....#..",
        "#...#.....#........###.",
        ".......###.............",
    ]


def test_every_character_has_a_picture_of_its_own():
    box = Font.builtin().glyph("\0").tobytes()
    pictures = {char: Font.builtin().glyph(char).tobytes() for char in ASCII + SIGNS}
    assert len(set(pictures.values())) == len(pictures)
    assert box not in pictures.values()


def test_letters_stand_on_the_baseline_and_only_descenders_hang_below():
    font = Font.builtin()
    for char in ASCII + SIGNS:
        assert font.glyph(char)[font.baseline + 1].any() == (char in DESCENDERS), char
    for char in "ABCXYZabcxz0189":
        assert font.glyph(char)[font.baseline].any(), char


SEEN = st.characters(exclude_categories=("Cf", "Mn", "Me")).filter(lambda char: not 0xE0000 <= ord(char) <= 0xE0FFF)


@given(st.text(SEEN).map(partial(unicodedata.normalize, "NFC")))
def test_any_text_is_its_characters_side_by_side(text):
    font = Font.builtin()
    coverage, dx, dy = render(text)
    expected = np.zeros_like(coverage)
    for row, line in enumerate(text.replace("\r\n", "\n").expandtabs(4).split("\n")):
        for column, char in enumerate(line):
            glyph = font.glyph(char)
            assert glyph.shape == (font.height, font.width)
            expected[row * font.height :, column * font.advance :][: glyph.shape[0], : glyph.shape[1]] = glyph
    assert (coverage == expected).all()
    assert coverage.flags.c_contiguous
    assert coverage.dtype == np.uint8
    assert set(np.unique(coverage)) <= {0, 255}
    assert coverage.shape == font.measure(text)[::-1]
    assert (dx, dy) == (0, 0)


@given(st.text("Hxg\n", max_size=12), st.sampled_from("lmr"), st.sampled_from("atmsbd"))
def test_the_anchor_names_a_pixel_of_the_box(text, horizontal, vertical):
    coverage, dx, dy = render(text, anchor=horizontal + vertical)
    height, width = coverage.shape
    last_column, last_row = max(width - 1, 0), height - 1
    assert -dx == {"l": 0, "m": last_column // 2, "r": last_column}[horizontal]
    assert -dy == {"a": 0, "t": 0, "m": last_row // 2, "s": 6, "b": last_row, "d": last_row}[vertical]


@pytest.mark.parametrize(("side", "column"), [("l", 2), ("m", 8), ("r", 14)])
def test_lines_are_flush_with_the_anchored_side(side, column):
    coverage, _, _ = render("|\n|||", anchor=side + "t")
    assert list(np.flatnonzero(coverage[8])) == [2, 8, 14]
    assert list(np.flatnonzero(coverage[0])) == [column]


def test_tabs_reach_to_the_next_fourth_character():
    assert (render("a\tb")[0] == render("a   b")[0]).all()
    assert (render("x\nabcd\te")[0] == render("x\nabcd    e")[0]).all()


def test_lines_of_other_systems_end_the_same_way():
    assert (render("a\r\nb")[0] == render("a\nb")[0]).all()


def test_no_text_has_no_width_and_the_height_of_a_line():
    assert Font.builtin().measure("") == (0, 8)
    assert render("")[0].shape == (8, 0)


@pytest.mark.parametrize("text", [12, b"12", None])
def test_only_strings_are_text(text):
    with pytest.raises(TypeError, match="string"):
        render(text)


@pytest.mark.parametrize("anchor", ["", "l", "tl", "ltt", "xx", None])
def test_unknown_anchors_are_refused(anchor):
    with pytest.raises(ValueError, match="anchor"):
        render("a", anchor=anchor)


@pytest.mark.parametrize("char", ["", "ab"])
def test_a_glyph_is_of_one_character(char):
    with pytest.raises(ValueError, match="char"):
        Font.builtin().glyph(char)


def test_fonts_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Font.builtin().height = 9
    Font.builtin().glyph("A")[:] = 0
    assert Font.builtin().glyph("A").any()


@pytest.mark.parametrize("antialias", [False, True])
def test_outlines_are_those_that_pillow_draws(antialias):
    outline = ImageFont.load_default(14)
    font = Font.from_pillow(outline, antialias=antialias)
    coverage, dx, dy = render("AVA Quality", font, "ls")
    page = Image.new("L", (120, 40))
    draw = ImageDraw.Draw(page)
    draw.fontmode = "L" if antialias else "1"
    draw.text((10, 20), "AVA Quality", 255, outline, anchor="ls")
    ours = np.zeros((40, 120), np.uint8)
    ours[20 - 1 + dy :, 10 + dx :][: coverage.shape[0], : coverage.shape[1]] = coverage
    assert (ours == np.array(page)).all()
    assert coverage.any()
    assert set(np.unique(coverage)) - {0, 255} if antialias else set(np.unique(coverage)) == {0, 255}


def test_ink_left_of_the_origin_is_kept():
    outline = ImageFont.load_default(40)
    left = outline.getbbox("/", anchor="ls")[0]
    assert left < 0, "choose a character that overhangs"
    assert Font.from_pillow(outline).glyph("/")[:, :1].any()


def test_pillows_bitmap_fonts_serve_too():
    font = Font.from_pillow(ImageFont.load_default_imagefont(), name="old")
    assert font.name == "old"
    assert font.measure("ab\nc")[1] == 2 * font.height
    assert font.glyph("M").any()
    assert font.measure("") == (0, font.height)


def test_fonts_from_files(tmp_path):
    path = tmp_path / "face.ttf"
    path.write_bytes(ImageFont.load_default(10).font_bytes)
    font = Font.truetype(path, 10)
    assert (render("file", font)[0] == render("file", Font.from_pillow(ImageFont.truetype(path, 10)))[0]).all()


def test_fonts_that_cannot_be_had(tmp_path):
    broken = tmp_path / "broken.ttf"
    broken.write_bytes(b"no font")
    with pytest.raises(OSError, match="broken"):
        Font.truetype(broken, 10)
    with pytest.raises(OSError, match="nowhere"):
        Font.truetype(tmp_path / "nowhere.ttf", 10)
    with pytest.raises(ValueError, match="size"):
        Font.truetype(broken, 0)
    with pytest.raises(TypeError, match="ImageFont"):
        Font.from_pillow("DejaVuSans.ttf")


def test_importing_reads_no_font():
    code = "import sys, paneldraw.text; print([m for m in sys.modules if m.startswith('PIL') or 'text.builtin' in m])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
