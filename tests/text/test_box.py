"""Text in a box: where lines end by definition, nothing lost, nothing outside, and the rest is the rest."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from paneldraw import Font, Framebuffer
from paneldraw.text import BoxStyle, box, render, wrap

FONT = Font.builtin()
WORDS = st.text("ab i-\u00ad\u00a0\u2011\u200b\t\n中。e\u0301(", max_size=40)
WIDTHS = st.integers(1, 70)


def columns(count):
    """The width of so many characters of the built-in font."""
    return 6 * count - 1


def slow_lines(text, width):
    """Lines by definition, of characters that are all as wide: as many words as fit, else as many letters."""
    lines = []
    for paragraph in text.split("\n"):
        rest = paragraph
        while FONT.measure(rest.rstrip(" "))[0] > width:
            ends = [k for k in range(1, len(rest)) if rest[k] == " " and rest[:k].strip(" ")]
            ends += [k for k in range(1, len(rest)) if re.search(r"\w-$", rest[:k]) and rest[k].isalpha()]
            fitting = [k for k in ends if FONT.measure(rest[:k].rstrip(" "))[0] <= width]
            if not fitting:
                fitting = [1, *(k for k in range(1, len(rest)) if FONT.measure(rest[:k].rstrip(" "))[0] <= width)]
            lines.append(rest[: max(fitting)].rstrip(" "))
            rest = rest[max(fitting) :].lstrip(" ")
        lines.append(rest.rstrip(" "))
    return lines


@given(st.text("ab- \n", max_size=60), st.integers(5, 80))
@example("a-b -c", 11)
@example("   aa", 11)
def test_lines_end_where_the_definition_says(text, width):
    assert wrap(text, width) == slow_lines(text, width)


@given(WORDS, WIDTHS, st.sampled_from(["word", "letter", None]))
@example("a\r\nb", 30, "word")
def test_no_character_is_lost_or_out_of_order(text, width, by):
    lines = list(box.lines_of(text, width, FONT, by))
    assert [line.start for line in lines] == [0, *(line.end for line in lines[:-1])]
    assert lines[-1].end == len(text)
    for line in lines:
        part = text[line.start : line.end]
        shown = line.text if part.startswith(line.text) else line.text.removesuffix("-")
        assert part.startswith(shown)
        assert shown == line.text or part[len(shown)] == "\u00ad"
        assert not part[len(shown) :].strip("\r\n\u00ad\u200b \t")


@given(st.text(max_size=30), WIDTHS, st.sampled_from(["word", "letter", None]), st.booleans())
def test_any_text_can_be_in_a_box(text, width, by, inverse):
    fb = Framebuffer(64, 32)
    with fb.clip(3, 3, 20, 20):
        assert text.endswith(fb.text_box(text, 0, 0, width, 24, wrap=by, inverse=inverse, op="xor"))
    fb.pixels[3:23, 3:23] = 0
    assert not fb.pixels.any()


@given(WORDS, WIDTHS, st.sampled_from(["word", "letter"]))
def test_no_line_is_wider_than_the_box_unless_one_letter_is(text, width, by):
    for line in wrap(text, width, by=by):
        letters = [char for char in line if char not in "\u00ad\u200b\u0301"]
        assert len(letters) <= 1 or FONT.measure(line)[0] <= width


@given(WORDS, WIDTHS, st.integers(0, 40), st.sampled_from(["word", "letter"]), st.sampled_from(["…", "", ">>"]))
def test_what_a_box_holds_and_the_rest_are_the_text(text, width, height, by, ellipsis):
    style = BoxStyle(wrap=by, ellipsis=ellipsis)
    lines, rest = box.chosen(text, width, height, FONT, style)
    assert len(lines) <= height // 8
    assert text.endswith(rest)
    whole = wrap(text, width, by=by)
    if not rest:
        assert lines == whole[: len(lines)]
        assert not "".join(whole[len(lines) :]).strip()
    elif lines:
        assert lines[:-1] == whole[: len(lines) - 1]
        shown = lines[-1].removesuffix(ellipsis) if ellipsis else lines[-1]
        before = text[: len(text) - len(rest)].rstrip()
        assert before.endswith(shown.rstrip().removesuffix("-"))
        letters = [char for char in lines[-1] if char not in "\u00ad\u200b\u0301"]
        assert len(letters) <= 1 or FONT.measure(lines[-1])[0] <= width


@given(WORDS, st.integers(-9, 50), st.integers(-9, 30), WIDTHS, st.integers(0, 40), st.booleans())
def test_nothing_is_drawn_outside_of_the_box(text, x, y, width, height, inverse):
    fb = Framebuffer(64, 32, depth=2)
    fb.text_box(text, x, y, width, height, align="right", valign="bottom", inverse=inverse, line_spacing=-2)
    inside = Framebuffer(64, 32, depth=2)
    inside.rect(x, y, width, height, fill=True)
    assert not fb.pixels[inside.pixels == 0].any()


def drawn(text, *size, **how):
    fb = Framebuffer(*size)
    rest = fb.text_box(text, 0, 0, *size, **how)
    return fb, rest


def with_lines(width, height, *lines, **how):
    fb = Framebuffer(width, height)
    for line, x, y in lines:
        fb.text(line, x, y, **how)
    return fb


@pytest.mark.parametrize(("align", "x"), [("left", 0), ("center", 9), ("right", 19)])
@pytest.mark.parametrize(("valign", "y"), [("top", 0), ("middle", 7), ("bottom", 15)])
def test_lines_are_flush_with_the_sides(align, x, valign, y):
    fb, rest = drawn("Hi", 30, 23, align=align, valign=valign)
    assert fb == with_lines(30, 23, ("Hi", x, y))
    assert rest == ""


def test_lines_are_so_many_rows_apart():
    fb, rest = drawn("a b c", 5, 29, line_spacing=2)
    assert fb == with_lines(5, 29, ("a", 0, 0), ("b", 0, 10), ("c", 0, 20))
    assert rest == ""
    assert drawn("a b c", 5, 27, line_spacing=2, ellipsis="")[1] == "c"


@pytest.mark.parametrize(
    ("text", "count", "lines"),
    [
        ("one two", 5, ["one", "two"]),
        ("one two", 3, ["one", "two"]),
        ("one  two ", 4, ["one", "two"]),
        ("north-west", 7, ["north-", "west"]),
        ("at -5 to -9", 5, ["at -5", "to -9"]),
        ("a --all", 4, ["a", "--al", "l"]),
        ("Donau\u00addampf\u00adschiff", 11, ["Donau\u00addampf-", "schiff"]),
        ("Donau\u00addampf\u00adschiff", 10, ["Donau-", "dampf-", "schiff"]),
        ("21\u00a0°C now", 6, ["21\u00a0°C", "now"]),
        ("it is 21\u00a0°C", 8, ["it is", "21\u00a0°C"]),
        ("a b\u2011c", 3, ["a", "b\u2011c"]),
        ("some\u200bthing", 6, ["some\u200b", "thing"]),
        ("abcdefgh", 3, ["abc", "def", "gh"]),
        ("x\n\ny", 3, ["x", "", "y"]),
        ("x\r\ny", 3, ["x", "y"]),
        ("\ta b", 6, ["    a", "b"]),
        ("天気は晴れ。", 5, ["天気は晴", "れ。"]),
        ("ae\u0301io", 2, ["ae\u0301", "io"]),
        ("", 3, [""]),
    ],
)
def test_lines_end_behind_words(text, count, lines):
    assert [line.expandtabs(4) for line in wrap(text, columns(count))] == lines


def test_lines_of_letters_and_lines_as_they_are():
    assert wrap("one two", columns(5), by="letter") == ["one t", "wo"]
    assert wrap("one two\nthree", columns(5), by=None) == ["one two", "three"]


def cut(text, count, rows, **how):
    return box.chosen(text, columns(count), 8 * rows, FONT, BoxStyle(**how))


def test_an_ellipsis_is_there_only_where_text_is_cut():
    assert cut("one two", 7, 1) == (["one two"], "")
    assert cut("one two \n", 7, 1) == (["one two"], "")
    assert cut("one two", 5, 1) == (["one…"], "two")
    assert cut("one two three", 7, 1) == (["one tw…"], "o three")
    assert cut("one\ntwo", 7, 1) == (["one…"], "two")
    assert cut("\none", 7, 1) == (["…"], "one")
    assert cut("one two", 1, 1) == (["o"], "ne two")
    assert cut("one two", 5, 0) == ([], "one two")


def test_lines_that_are_not_wrapped_are_cut_each():
    assert cut("one two\nab\nthree", 5, 2, wrap=None) == (["one…", "ab…"], "three")
    assert cut("one two\nthree", 5, 2, wrap=None) == (["one…", "three"], "")
    assert cut("one two", 5, 1, wrap=None, ellipsis="") == (["one t"], "")


def test_an_ellipsis_that_the_font_lacks_is_three_dots():
    from paneldraw.text.font import of_strike
    from paneldraw.text.strike import Strike

    pictures = {code: FONT._face.strike.pictures[code] for code in range(0x20, 0x7F)}
    plain = of_strike(Strike("ascii", 7, 1, pictures, 1, True))
    assert box.chosen("abcdefgh", columns(6), 8, plain, BoxStyle())[0] == ["abc..."]


def test_pages_of_a_text_are_read_one_after_the_other():
    text = "Rain in the afternoon, wind from the west"
    fb = Framebuffer(64, 16)
    pages = []
    while text:
        rest = fb.text_box(text, 0, 0, 64, 16, ellipsis="")
        pages.append(text[: len(text) - len(rest)])
        text = rest
    assert pages == ["Rain in the ", "afternoon, wind from ", "the west"]


def test_an_inverse_box_is_lit_but_for_the_letters():
    fb, _ = drawn("Hi", 30, 12, inverse=True, align="center", valign="middle")
    plain, _ = drawn("Hi", 30, 12, align="center", valign="middle")
    assert np.array_equal(fb.pixels, 1 - plain.pixels)


@pytest.mark.parametrize("op", ["over", "xor", "add", "max", "clear"])
def test_inverse_meets_what_is_there(op):
    fb = Framebuffer(12, 9, depth=4)
    fb.fill(5)
    fb.text_box("Hi", 0, 0, 12, 9, 3, op=op, inverse=True)
    letters = with_lines(12, 9, ("Hi", 0, 0)).pixels == 1
    lit = {"over": 3, "xor": 5 ^ 3, "add": 8, "max": 5, "clear": 0}[op]
    assert set(fb.pixels[~letters].tolist()) == {lit}
    assert set(fb.pixels[letters].tolist()) == {0 if op == "over" else 5}


def test_a_box_may_be_of_any_size_anywhere():
    fb = Framebuffer(20, 10)
    assert fb.text_box("Hi", 0, 0, 0, 10) == "Hi"
    assert fb.text_box("Hi", 0, 0, 10, 0) == "Hi"
    assert fb.text_box("Hi", 0, 0, 10**30, 10**30, align="right", inverse=True) == ""
    assert fb.pixels.all()
    fb.clear()
    assert fb.text_box("Hi", -(10**30), 10**30, 20, 8) == ""
    assert not fb.pixels.any()
    assert fb.text_box("x" * 100_000, 0, 0, 20, 8, ellipsis="") == "x" * (100_000 - 3)


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        (
            {"align": "centre"},
            ValueError,
            "align must be one of 'left', 'center', 'right', not 'centre'; did you mean center",
        ),
        ({"valign": "center"}, ValueError, "valign must be one of 'top', 'middle', 'bottom', not 'center'"),
        ({"wrap": "words"}, ValueError, "wrap must be one of 'word', 'letter', None, not 'words'; did you mean word"),
        ({"wrap": []}, ValueError, "wrap must be one of"),
        ({"ellipsis": None}, TypeError, "ellipsis must be a string, '' for none, not NoneType"),
        ({"line_spacing": -8}, ValueError, "line_spacing must be from -7, which leaves lines a row apart"),
        ({"line_spacing": 1.5}, TypeError, "line_spacing must be a whole number of rows, not float"),
        ({"font": "6x8"}, TypeError, "font must be a Font"),
        ({"op": "and"}, ValueError, "op must be one of"),
    ],
)
def test_what_cannot_be_meant_is_refused(how, error, message):
    with pytest.raises(error, match=re.escape(message)):
        Framebuffer(20, 10).text_box("Hi", 0, 0, 20, 10, **how)


def test_a_box_of_no_size_that_can_be_is_refused():
    fb = Framebuffer(20, 10)
    with pytest.raises(ValueError, match="w must not be negative"):
        fb.text_box("Hi", 0, 0, -1, 10)
    with pytest.raises(ValueError, match="h must be finite"):
        fb.text_box("Hi", 0, 0, 10, float("nan"))
    with pytest.raises(TypeError, match="text must be a string, not int"):
        fb.text_box(21, 0, 0, 10, 10)
    with pytest.raises(ValueError, match="width must be 1 or more, not 0"):
        wrap("Hi", 0)
    with pytest.raises(TypeError, match="width must be a whole number, not float"):
        wrap("Hi", 9.5)


OUTLINES = Path("/usr/share/fonts/truetype/dejavu")


@pytest.mark.skipif(not OUTLINES.exists(), reason="DejaVu is not installed")
@pytest.mark.parametrize("name", ["DejaVuSans.ttf", "DejaVuSerif-BoldItalic.ttf", "DejaVuSansMono.ttf"])
@pytest.mark.parametrize("antialias", [False, True])
@given(st.text("AVfij \u00adW-", max_size=30), st.integers(1, 90), st.sampled_from(["left", "center", "right"]))
@settings(max_examples=25)
def test_no_ink_of_an_outline_font_is_cut_where_lines_fit(name, antialias, text, width, align):
    font = Font.load(OUTLINES / name, 13, antialias=antialias)
    lines = wrap(text, width, font)
    height = font.height * len(lines)
    boxed, free = Framebuffer(300, height + 20, depth=4), Framebuffer(300, height + 20, depth=4)
    assert boxed.text_box(text, 100, 10, width, height, font=font, align=align) == ""
    widths = []
    for number, line in enumerate(lines):
        coverage, dx, _ = render(line, font)
        left, right = min(dx, 0), dx + coverage.shape[1]
        widths.append(right - left)
        room = {"left": 0, "center": max(width - widths[-1], 0) // 2, "right": max(width - widths[-1], 0)}[align]
        free.text(line, 100 + room - left, 10 + number * font.height, font=font)
    assert all(one <= width or len(line) < 2 for one, line in zip(widths, lines, strict=True))
    if max(widths) <= width:
        rows = slice(10, 10 + height)
        assert np.array_equal(boxed.pixels[rows], free.pixels[rows])
    assert not boxed.pixels[:, :100].any()
    assert not boxed.pixels[:, 100 + width :].any()
