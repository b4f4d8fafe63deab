"""The built-in fonts: which characters they have, and what must hold for every drawing."""

from __future__ import annotations

import unicodedata
from itertools import pairwise

import numpy as np
import pytest

from paneldraw import Framebuffer
from paneldraw.text import Font, render
from paneldraw.text.builtin import NAMES, strike
from paneldraw.text.builtin.drawings import alike

SMALL = ("6x8", "8x8")


def span(first, last):
    return [chr(code) for code in range(first, last + 1) if unicodedata.category(chr(code)) not in ("Cn", "Cf")]


LETTERS = {
    "ASCII": span(0x20, 0x7E),
    "Latin-1": span(0xA0 + 1, 0xFF),
    "Latin Extended-A": [*span(0x100, 0x17F), *"ȘșȚț"],
    "Greek": span(0x384, 0x3CE),
    "Cyrillic": [*span(0x400, 0x45F), *"Ґґ"],
}
SIGNS = {
    "punctuation": "‐‑‒–—―‘’‚“”„†‡•…‰′″‹›€№™",  # noqa: RUF001
    "boxes": span(0x2500, 0x257F),
    "blocks": span(0x2580, 0x259F),
    "Braille": span(0x2800, 0x28FF),
    "arrows": [*span(0x2190, 0x2199), *"⇐⇑⇒⇓⇔↵↩↪↺↻"],
    "signs": "♥♡★☆✓✔✗✘⚙⚠☀☁☂☃⚡❄⛅⛈☔🌧🌨🌫🌡💧🔋🪫🔌📶🛜🔔🔊🔇🔒🔓🔍🔥💡🏠⌂♪♫●○■□▲▼◀▶⏏⏩⏪⏭⏮⏸⏹⏺⏻☎✉⌚⏰⌛⏳°Ωµ√∞≈≠≤≥",
}
ALL = LETTERS | SIGNS


def lit(name):
    """What the characters of a font light, by character, in rows of True and False."""
    pictures = strike(name).pictures
    return {char: pictures[ord(char)].ink.astype(bool) for chars in ALL.values() for char in chars}


def picture(text, name="6x8"):
    coverage = render(text, Font.builtin(name))[0]
    return "\n".join("".join("#" if ink else "." for ink in row) for row in coverage).split("\n")


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize("block", ALL)
def test_blocks_are_whole(name, block):
    pictures = strike(name).pictures
    assert [char for char in ALL[block] if ord(char) not in pictures] == []
    assert len(ALL[block]) >= 20


@pytest.mark.parametrize("name", SMALL)
def test_different_characters_have_different_pictures(name):
    drawn_as, seen = alike(), {}
    for char, ink in lit(name).items():
        drawn = drawn_as.get(unicodedata.normalize("NFC", char), char)
        letter, *marks = unicodedata.normalize("NFD", drawn)
        seen.setdefault(ink.tobytes(), set()).add("".join((drawn_as.get(letter, letter), *marks)))
    assert [chars for chars in seen.values() if len(chars) > 1 and chars not in SAME] == []


#: What is the same by its nature, and the eighths that six columns are too few for.
SAME = [{" ", "\N{BRAILLE PATTERN BLANK}"}, {"|", "│"}, {"¦", "╎"}, {"—", "─"}, {"▊", "▋"}, {"▍", "▎"}]


@pytest.mark.parametrize("name", NAMES)
def test_every_picture_is_a_cell(name):
    font = Font.builtin(name)
    for char, ink in lit(name).items():
        assert ink.shape[0] == font.height, char
        if name in SMALL:
            assert ink.shape[1] == font.advance, char


@pytest.mark.parametrize("name", SMALL)
def test_letters_keep_a_blank_column_between_them(name):
    pictures = lit(name)
    for block in LETTERS:
        for char in LETTERS[block]:
            assert not pictures[char][:, -1].any(), char


@pytest.mark.parametrize("name", SMALL)
@pytest.mark.parametrize("block", ["Latin-1", "Latin Extended-A", "Greek", "Cyrillic"])
def test_letters_stand_on_the_baseline(name, block):
    pictures = lit(name)
    letters = [char for char in LETTERS[block] if unicodedata.category(char) in ("Lu", "Ll")]
    assert len(letters) > 60
    assert [char for char in letters if not pictures[char][6].any()] == []
    below = [char for char in letters if pictures[char][7].any()]
    allowed = set("µýþÿçÇąĄęĘĝğġģĢįĮĵķĶļĻņŊŋŅŗŖşŞţŢŷĳųŲșȘțȚβγζηήμξρςφχψДЦЩЏЂдрруфцщђјўџ") | set("уў")
    assert [char for char in below if char not in allowed] == []


@pytest.mark.parametrize("name", SMALL)
def test_marks_above_small_letters_are_apart_from_them(name):
    pictures = lit(name)
    above = set("\u0300\u0301\u0302\u0303\u0304\u0306\u0307\u0308\u030b\u030c")
    small = [char for chars in LETTERS.values() for char in chars if char.islower()]
    marked = [char for char in small if set(unicodedata.normalize("NFD", char)[1:]) & above]
    touching = [char for char in marked if pictures[char][1:3].any(axis=1).all()]
    assert len(marked) > 80
    assert set(touching) == set("ďĥĺľťέ")


@pytest.mark.parametrize("name", SMALL)
def test_letters_under_flat_marks_are_as_tall_as_without(name):
    pictures = lit(name)
    for letter, marked in (*zip("aeouy", "äëöüÿ", strict=True), *zip("aeu", "āēū", strict=True), ("е", "ё")):  # noqa: RUF001
        assert (pictures[marked][2:] == pictures[letter][2:]).all(), marked


def test_words_look_as_they_were_drawn():
    assert picture("Grüße") == [
        ".###.........#.#...##........",
        "#...#.............#..#.......",
        "#.....#.##..#...#.#..#...###.",
        "#.###.##..#.#...#.#.##..#...#",
        "#...#.#.....#...#.#...#.#####",
        "#...#.#.....#..##.#...#.#....",
        ".####.#......##.#.#.##...###.",
        ".............................",
    ]


def test_bold_strokes_are_two_pixels_wide():
    assert picture("Ää", "8x8") == [
        "##..##..##..##.",
        ".####..........",
        "##..##...####..",
        "##..##......##.",
        "######...#####.",
        "##..##..##..##.",
        "##..##...#####.",
        "...............",
    ]


@pytest.mark.parametrize("name", SMALL)
def test_boxes_join_without_a_gap(name):
    for text in ("┌─┬┐\n│ ││\n├─┼┤\n└─┴┘", "┏━┳┓\n┃ ┃┃\n┣━╋┫\n┗━┻┛", "╔═╦╗\n║ ║║\n╠═╬╣\n╚═╩╝"):
        ink = render(text, Font.builtin(name))[0] > 0
        width, height = Font.builtin(name).advance, 8
        middle = ink[height // 2 - 2 : height // 2 + 1]
        assert middle[:, width // 2 + 1 : 3 * width].any(axis=0).all()
        for row in range(height // 2, 3 * height):
            assert ink[row, :width].any(), (text, row)


@pytest.mark.parametrize("name", SMALL)
def test_sides_of_boxes_are_as_heavy_as_their_names_say(name):
    """A line reaches its side with as many pixels as its weight has: 1, 2, and 1, a blank, 1."""
    pictures = lit(name)
    weights = {"LIGHT": 1, "HEAVY": 2, "SINGLE": 1, "DOUBLE": 2}
    for char in "─│━┃═║┌┏╔┐┓╗└┗╚┘┛╝├┣╠┤┫╣┬┳╦┴┻╩┼╋╬":
        words = unicodedata.name(char).removeprefix("BOX DRAWINGS ").split()
        weight = weights[words[0]]
        has = {side: any(word in words for word in spelled) for side, spelled in SIDES.items()}
        edges = {"left": pictures[char][:, 0], "right": pictures[char][:, -1]}
        edges |= {"up": pictures[char][0], "down": pictures[char][-1]}
        assert {side: int(edge.sum()) for side, edge in edges.items()} == {side: weight * has[side] for side in edges}


SIDES = {
    "left": ("LEFT", "HORIZONTAL"),
    "right": ("RIGHT", "HORIZONTAL"),
    "up": ("UP", "VERTICAL"),
    "down": ("DOWN", "VERTICAL"),
}


@pytest.mark.parametrize("name", SMALL)
def test_blocks_fill_their_share_of_the_cell(name):
    pictures = lit(name)
    assert [int(pictures[char].all(axis=1).sum()) for char in "▁▂▃▄▅▆▇█"] == [1, 2, 3, 4, 5, 6, 7, 8]
    left = [int(pictures[char].all(axis=0).sum()) for char in "▏▎▍▌▋▊▉█"]
    assert left == sorted(left)
    assert left[-1] == Font.builtin(name).advance
    assert [pictures[char].mean() for char in "░▒▓▚▞▌▐▀▄"] == [0.25, 0.5, 0.75, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5]


@pytest.mark.parametrize("name", SMALL)
def test_braille_lights_a_pixel_for_each_dot(name):
    pictures = lit(name)
    for code in range(256):
        assert pictures[chr(0x2800 + code)].sum() == bin(code).count("1")
    assert (pictures["⣿"] == pictures["⢸"] | pictures["⡇"]).all()


@pytest.mark.parametrize("name", SMALL)
def test_marks_may_be_written_after_their_letters(name):
    font = Font.builtin(name)
    assert (render("u\u0308", font)[0] == render("ü", font)[0]).all()
    apart = render("n\u0308", font)[0]
    assert apart.shape == render("n", font)[0].shape
    assert (apart > 0).sum() == (render("n", font)[0] > 0).sum() + (render("¨", font)[0] > 0).sum()


@pytest.mark.parametrize("name", ["numbers", "segments"])
def test_numbers_do_not_jump_when_their_digits_change(name):
    font = Font.builtin(name)
    assert len({font.measure(f"-{digit}{digit}.{digit}°") for digit in range(10)}) == 1
    assert len({font.glyph(str(digit)).tobytes() for digit in range(10)}) == 10
    assert font.measure("1")[0] > font.measure(":")[0]
    assert (font.height, font.baseline) == (16, 13)


def test_a_seven_segment_digit_is_its_segments():
    assert picture("3", "segments")[:14] == [
        ".######.",
        "..####.#",
        "......##",
        "......##",
        "......##",
        "......##",
        "..####.#",
        "..####.#",
        "......##",
        "......##",
        "......##",
        "......##",
        "..####.#",
        ".######.",
    ]


@pytest.mark.parametrize("name", ["numbers", "segments"])
def test_tall_fonts_have_all_other_characters_too(name):
    pictures = strike(name).pictures
    assert [char for chars in ALL.values() for char in chars if ord(char) not in pictures] == []
    assert len(pictures[ord("ß")].ink) == 16


def test_a_font_counts_its_characters():
    pictures = strike("6x8").pictures
    assert list(pictures)[:3] == [0x20, 0x21, 0x22]
    assert len(pictures) > 1000
    assert all(first < second for first, second in pairwise(pictures))


def test_no_such_font():
    with pytest.raises(ValueError, match="6x8, 8x8, numbers, segments"):
        Font.builtin("9x9")


def test_text_of_all_fonts_is_drawn():
    fb = Framebuffer(128, 32)
    for name in NAMES:
        fb.clear()
        fb.text("21.5 °C", 0, 0, font=Font.builtin(name))
        width, height = Font.builtin(name).measure("21.5 °C")
        assert (fb.pixels[:height, :width] == (render("21.5 °C", Font.builtin(name))[0] > 0)).all()
        assert np.count_nonzero(fb.pixels) > 50
