"""Letters shaped by Pillow's raqm: from the right, with features, in a language; and what is said without it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import ImageFont, features

from paneldraw import Font, Framebuffer
from paneldraw.text import render

DEJAVU = Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")
HEBREW = "\u05e9\u05dc\u05d0\u05de"

installed = pytest.mark.skipif(
    not (DEJAVU.exists() and features.check("raqm")), reason="DejaVu or Pillow's raqm is not installed"
)


def basic():
    return Font.from_pillow(ImageFont.truetype(DEJAVU, 14, layout_engine=ImageFont.Layout.BASIC))


def ink(font, text):
    return render(text, font)[0]


def ends(font, text):
    """Which characters of a text stand first and last, from the left."""
    line, found = ink(font, text), []
    lit = np.flatnonzero(line.any(axis=0))
    for side in (1, -1):
        for char in text:
            own = ink(font, char)
            own = own[:, own.any(axis=0)]
            start = lit[0] if side == 1 else lit[-1] + 1 - own.shape[1]
            if np.array_equal(line[:, start : start + own.shape[1]], own):
                found.append(char)
    return "".join(found)


@installed
def test_hebrew_runs_from_the_right():
    assert ends(Font.load(DEJAVU, 14), HEBREW) == HEBREW[-1] + HEBREW[0]
    assert ends(Font.load(DEJAVU, 14), "ABC") == "AC"


@installed
def test_a_direction_is_told():
    font = Font.load(DEJAVU, 14)
    assert ends(font.shaped(direction="rtl"), HEBREW + "!") == "!" + HEBREW[0]
    assert ends(font.shaped(direction="ltr"), HEBREW + "!") == HEBREW[-1] + "!"
    assert ends(font.shaped(direction="rtl"), "ABC!") == "!C"


@installed
def test_characters_of_other_fonts_keep_their_place_in_text_from_the_right():
    font = Font.load(DEJAVU, 14).with_fallback(Font.builtin())
    box = render("\U0010ffff", font)[0]
    line, word = ink(font, HEBREW + "\U0010ffff"), ink(font, HEBREW)
    assert np.array_equal(line[:, : box.shape[1]], box)
    assert np.array_equal(line[:, -word.shape[1] :], word)


@installed
def test_lines_of_a_box_run_from_the_right_each():
    fb, lines = Framebuffer(60, 34), Framebuffer(60, 34)
    font = Font.load(DEJAVU, 14)
    fb.text_box(f"{HEBREW} {HEBREW}", 0, 0, 60, 34, font=font, align="right")
    lines.text(f"{HEBREW}\n{HEBREW}", 59, 0, font=font, anchor="ra")
    assert fb == lines


@installed
def test_features_are_switched():
    font = Font.load(DEJAVU, 14)
    plain = ImageFont.truetype(DEJAVU, 14)
    for told in (["-kern"], ["-liga"]):
        assert font.shaped(features=told).measure("AVAVAV fi")[0] == np.ceil(
            plain.getlength("AVAVAV fi", "1", features=told)
        )
    assert font.shaped(features=["-kern"]).measure("AVAVAV") > font.measure("AVAVAV")
    assert font.shaped(features=["-kern"], language="sr").shaped(direction="ltr").measure("AVAV") > font.measure("AVAV")


@installed
def test_a_font_of_the_basic_layout_says_what_it_lacks():
    with pytest.raises(ValueError, match="need Pillow with raqm, which pip's has"):
        basic().shaped(direction="rtl")


@installed
@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"direction": "ttb"}, ValueError, "direction must be 'ltr' or 'rtl', not 'ttb'"),
        ({"features": "kern"}, TypeError, "features must be a sequence of strings"),
        ({"features": [1]}, TypeError, "features must be a sequence of strings"),
        ({"language": 5}, TypeError, "language must be a string, not int"),
    ],
)
def test_what_cannot_be_meant_is_refused(how, error, message):
    with pytest.raises(error, match=message):
        Font.load(DEJAVU, 14).shaped(**how)


def test_a_font_of_bitmaps_is_not_shaped():
    with pytest.raises(ValueError, match=r"only fonts with outlines are shaped, .* and 6x8 is none"):
        Font.builtin().shaped(direction="rtl")
