"""How text is set beyond one line to the right: turned, inverse, with room between its lines."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Font, Framebuffer
from paneldraw.text import render

DIRECTIONS = ("right", "down", "left", "up")
ANCHORS = [h + v for h in "lmr" for v in "atmsbd"]
TEXTS = st.text("Agj|1 \nÜ", max_size=6)


def square(text, **how):
    """The text at the middle of 121 x 121 pixels."""
    fb = Framebuffer(121, 121)
    fb.text(text, 60, 60, **how)
    return fb.pixels


@given(TEXTS, st.sampled_from(ANCHORS), st.sampled_from(range(4)), st.booleans(), st.integers(-7, 5))
def test_a_direction_turns_the_text_about_its_anchor(text, anchor, quarters, inverse, line_spacing):
    how = {"anchor": anchor, "inverse": inverse, "line_spacing": line_spacing}
    plain = square(text, **how)
    assert np.array_equal(square(text, direction=DIRECTIONS[quarters], **how), np.rot90(plain, -quarters))


def test_text_can_be_read_down_and_up():
    fb = Framebuffer(17, 11)
    fb.text("L!", 7, 0, direction="down")
    fb.text("L!", 9, 10, direction="up")
    assert str(fb).split("\n") == [
        ".#######.........",
        ".#...............",
        ".#.......#####.#.",
        ".#...............",
        ".#...............",
        ".................",
        "...............#.",
        "...............#.",
        ".#.#####.......#.",
        "...............#.",
        ".........#######.",
    ]


@pytest.mark.parametrize("line_spacing", [-3, 0, 4])
def test_lines_are_so_many_rows_apart(line_spacing):
    fb, other = Framebuffer(30, 40), Framebuffer(30, 40)
    fb.text("Ag\nbj", 3, 5, line_spacing=line_spacing)
    other.text("Ag", 3, 5)
    other.text("bj", 3, 5 + 8 + line_spacing)
    assert fb == other
    assert Font.builtin().measure("Ag\nbj", line_spacing) == (11, 16 + line_spacing)
    assert render("Ag\nbj", line_spacing=line_spacing)[0].shape == (16 + line_spacing, 11)


@pytest.mark.parametrize(("anchor", "row"), [("la", 0), ("lm", 9), ("ls", 6), ("ld", 18), ("lb", 18)])
def test_anchors_count_the_rows_between_lines(anchor, row):
    assert render("Ag\nbj", anchor=anchor, line_spacing=3)[2] == -row


def test_inverse_is_a_box_around_dark_characters():
    fb = Framebuffer(9, 12, depth=4)
    fb.fill(7)
    fb.text("i.", 1, 2, 5, inverse=True)
    plain = Framebuffer(9, 12)
    plain.text("i.", 1, 2)
    box = np.full((12, 9), 7)
    box[1:11] = np.where(plain.pixels[1:11] == 1, 0, 5)
    assert np.array_equal(fb.pixels, box)


@pytest.mark.parametrize("op", ["xor", "add", "max", "clear"])
def test_inverse_leaves_the_characters_as_they_were_where_it_does_not_replace(op):
    fb, plain = Framebuffer(20, 12, depth=4), Framebuffer(20, 12)
    fb.fill(7)
    fb.text("Hi", 2, 2, 3, op=op, inverse=True)
    plain.text("Hi", 2, 2)
    assert (fb.pixels[plain.pixels == 1] == 7).all()
    around = {"xor": 4, "add": 10, "max": 7, "clear": 0}[op]
    assert fb.pixels[1, 1] == fb.pixels[10, 13] == around
    assert fb.pixels[0, 0] == 7


def test_text_that_is_scaled_turns_too():
    plain, turned = Framebuffer(40, 40), Framebuffer(40, 40)
    big = Font.builtin().scaled(2)
    plain.text("A", 20, 20, font=big)
    turned.text("A", 20, 20, font=big, direction="down")
    assert np.array_equal(np.rot90(plain.pixels[1:, 1:], -1), turned.pixels[1:, 1:])


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"direction": "rigth"}, ValueError, "direction must be one of 'right', .*, not 'rigth'; did you mean right?"),
        ({"direction": 90}, ValueError, "direction must be one of .*, not 90"),
        ({"line_spacing": -8}, ValueError, "line_spacing must be from -7"),
        ({"line_spacing": 10**9}, ValueError, "to 1000, not 1000000000"),
        ({"line_spacing": "2"}, TypeError, "line_spacing must be a whole number of rows, not str"),
    ],
)
def test_what_cannot_be_meant_is_refused(how, error, message):
    with pytest.raises(error, match=message):
        Framebuffer(8, 8).text("Hi", 0, 0, **how)
