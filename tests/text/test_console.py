"""The text terminal: what stands where after which sequences, and what of that is seen."""

from __future__ import annotations

import string

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Font, Framebuffer
from paneldraw.text import Console


def written(*parts, columns=8, rows=3, **how):
    console = Console(columns, rows, **how)
    for part in parts:
        console.write(part)
    return console


@pytest.mark.parametrize(
    ("text", "stands", "position"),
    [
        ("ab\ncd", "ab\ncd\n", (2, 1)),
        ("ab\rc", "cb\n\n", (1, 0)),
        ("abc\b\bX", "aXc\n\n", (2, 0)),
        ("a\tb\tc", "a   b  c\n\n", (7, 0)),
        ("a\tb\tc\t", "a   b  c\n\n", (7, 0)),
        ("12345678", "12345678\n\n", (7, 0)),
        ("123456789", "12345678\n9\n", (1, 1)),
        ("12345678\n9", "12345678\n9\n", (1, 1)),
        ("a\nb\nc\nd", "b\nc\nd", (1, 2)),
        ("a\x07\x00\x7fb", "ab\n\n", (2, 0)),
        ("Gru\u0308\u200bße", "Grüße\n\n", (5, 0)),
        ("\u0308a", "a\n\n", (1, 0)),
        ("中a中中中", "中a中中\n中\n", (2, 1)),
        ("中\rx", "x\n\n", (1, 0)),
        ("中\bx", " x\n\n", (2, 0)),
        ("\x1b[2;3Hx", "\n  x\n", (3, 1)),
        ("\x1b[99;99Hx", "\n\n       x", (7, 2)),
        ("\x1b[2Bx\x1b[Ay\x1b[3Dz\x1b[2Cw", "\nzy w\nx", (4, 1)),
        ("ab\x1b[5Gc\x1b[3dd\x1b[Fe", "ab  c\ne\n     d", (1, 1)),
        ("abcdef\x1b[3G\x1b[K", "ab\n\n", (2, 0)),
        ("abcdef\x1b[3G\x1b[1K", "   def\n\n", (2, 0)),
        ("abcdef\x1b[3G\x1b[2Kx", "  x\n\n", (3, 0)),
        ("a\nb\nc\x1b[2;1H\x1b[J", "a\n\n", (0, 1)),
        ("a\nb\nc\x1b[2;1H\x1b[1J", "\n\nc", (0, 1)),
        ("a\nb\nc\x1b[2J\x1b[Hx", "x\n\n", (1, 0)),
        ("abcdef\x1b[2G\x1b[2P", "adef\n\n", (1, 0)),
        ("abcdef\x1b[2G\x1b[2@", "a  bcdef\n\n", (1, 0)),
        ("abcdef\x1b[2G\x1b[2X", "a  def\n\n", (1, 0)),
        ("a\nb\nc\x1b[2;1H\x1b[L", "a\n\nb", (0, 1)),
        ("a\nb\nc\x1b[2;1H\x1b[M", "a\nc\n", (0, 1)),
        ("a\nb\nc\x1b[S", "b\nc\n", (1, 2)),
        ("a\nb\nc\x1b[9T", "\n\n", (1, 2)),
        ("a\nb\nc\x1b[H\x1bM", "\na\nb", (0, 0)),
        ("a\nb\nc\x1b[1;2r\x1b[2H\nd", "b\nd\nc", (1, 1)),
        ("ab\x1b7\x1b[3Hx\x1b8c", "abc\n\nx", (3, 0)),
        ("ab\x1b[s\x1b[3Hx\x1b[uc", "abc\n\nx", (3, 0)),
        ("ab\x1bDc\x1bEd", "ab\n  c\nd", (1, 2)),
        ("ab\x1bcd", "d\n\n", (1, 0)),
        ("\x1b[?7l123456789", "12345679\n\n", (7, 0)),
        ("a\x1b]0;title\x07b\x1b]8;;http://x\x1b\\c", "abc\n\n", (3, 0)),
        ("a\x1b(Bb\x1b=c\x1b[>0cd\x1b[6n\x1b[?2004h", "abcd\n\n", (4, 0)),
        ("a\x1b[" + "9" * 6000 + "Db", "b\n\n", (1, 0)),
        ("a\x1b[1;" + "\x1bb", "a[1;\n\n", (4, 0)),
    ],
)
def test_characters_stand_where_a_terminal_puts_them(text, stands, position):
    console = written(text)
    assert (console.text, console.position) == (stands, position)


@given(st.text("ab\n\r\t\x1b[;?0123456789mHJKLMPSTXABCDrhlc@]\x07中\u0308", max_size=80), st.integers(0, 80))
def test_nothing_written_is_too_odd_and_sequences_may_come_in_parts(text, cut):
    whole, parts = written(text, columns=4), written(text[:cut], text[cut:], columns=4)
    assert whole.text == parts.text
    assert whole.position == parts.position
    assert len(whole._cells) == 3
    assert {len(row) for row in whole._cells} == {4}
    assert 0 <= whole.position[0] < 4
    assert 0 <= whole.position[1] < 3
    pictures = [Framebuffer(24, 24, depth=4), Framebuffer(24, 24, depth=4)]
    for fb, console in zip(pictures, (whole, parts), strict=True):
        console.draw(fb)
    assert pictures[0] == pictures[1]


@pytest.mark.parametrize("start", ["\x1b[" + "1;" * 500, "\x1b]0;" + "t" * 1000, "\x1bP" + "q" * 1000])
def test_a_sequence_without_end_is_text(start):
    assert written(start, "x", columns=100, rows=20).text.rstrip().replace("\n", "") == start[1:] + "x"


def drawn(console, depth=1):
    fb = Framebuffer(console.width, console.height, depth)
    console.draw(fb)
    return fb


def test_plain_text_is_drawn_as_text():
    fb = Framebuffer(48, 24)
    fb.text("Hi there", 0, 0)
    fb.text("21 °C", 0, 8)
    assert drawn(written("Hi there21 °C")) == fb


def test_all_cells_are_drawn():
    console = written("Hi")
    fb = Framebuffer(60, 30, depth=2)
    fb.fill(3)
    console.draw(fb, 5, 3)
    assert np.array_equal(fb.pixels[3:27, 5:53], drawn(console, 2).pixels)
    fb.pixels[3:27, 5:53] = 3
    assert (fb.pixels == 3).all()


def cell(text, depth=8):
    """The levels of a letter and of what is beside it."""
    fb = drawn(written(text + "I", columns=1, rows=1), depth)
    return int(fb.pixels[3, 2]), int(fb.pixels[3, 4])


@pytest.mark.parametrize(
    ("sequence", "levels"),
    [
        ("", (255, 0)),
        ("\x1b[7m", (0, 255)),
        ("\x1b[7;27m", (255, 0)),
        ("\x1b[31m", (51, 0)),
        ("\x1b[32m", (100, 0)),
        ("\x1b[37;44m", (170, 19)),
        ("\x1b[97;100m", (255, 85)),
        ("\x1b[91;39m", (255, 0)),
        ("\x1b[41;49m", (255, 0)),
        ("\x1b[31;7m", (0, 51)),
        ("\x1b[38;5;196m", (76, 0)),
        ("\x1b[38;5;244;48;5;233m", (128, 18)),
        ("\x1b[38;2;0;255;0m", (150, 0)),
        ("\x1b[38;2;0;255;0;0m", (255, 0)),
        ("\x1b[48;2;300;300;300;30m", (0, 255)),
        ("\x1b[38:5:231m", (255, 0)),
        ("\x1b[38;9;1m", (255, 0)),
        ("\x1b[38m", (255, 0)),
        ("\x1b[5;99;1234m", (255, 0)),
        ("\x1b[31m\x1b[m", (255, 0)),
    ],
)
def test_colors_are_levels_by_their_brightness(sequence, levels):
    assert cell(sequence) == levels


def test_colors_that_differ_can_be_told_apart_in_few_levels():
    assert cell("\x1b[34m", depth=1) == (1, 0)
    assert cell("\x1b[34;41m", depth=1) == (1, 0)
    assert cell("\x1b[37;47;30m", depth=1) == (0, 1)
    assert cell("\x1b[33;47m", depth=1) == (0, 1)
    assert cell("\x1b[30;40m", depth=1) == (0, 0)


def test_erasing_leaves_the_color_of_the_background():
    assert (drawn(written("\x1b[47m\x1b[2J"), 8).pixels == 170).all()


def test_bold_is_wider_and_underlined_has_a_line():
    plain = drawn(written("lo")).pixels
    shifted = np.pad(plain, ((0, 0), (1, 0)))[:, :-1]
    assert np.array_equal(drawn(written("\x1b[1mlo")).pixels, plain | shifted)
    lined = drawn(written("\x1b[4mlo")).pixels
    assert lined[7].tolist() == [1] * 12 + [0] * 36
    assert np.array_equal(lined[:7], plain[:7])
    assert np.array_equal(drawn(written("\x1b[1;22;4;24mlo")).pixels, plain)


def test_the_cursor_is_an_inverse_cell():
    without, shown = drawn(written("abc\b")).pixels, drawn(written("abc\b", cursor=True)).pixels
    changed = np.argwhere(without != shown)
    assert (changed.min(axis=0).tolist(), changed.max(axis=0).tolist(), len(changed)) == ([0, 12], [7, 17], 48)
    assert np.array_equal(drawn(written("abc\b\x1b[?25l", cursor=True)).pixels, without)
    assert np.array_equal(drawn(written("abc\b\x1b[?25h")).pixels, shown)


def test_cells_are_as_large_as_the_font_s():
    console = written("A", font=Font.builtin().scaled(2))
    assert (console.width, console.height) == (96, 48)
    assert drawn(console).pixels[:16].any()


def test_print_writes_to_it():
    console = Console(20, 2)
    print("load", 0.42, file=console, flush=True)
    assert console.text == "load 0.42\n"
    assert console.write(string.ascii_letters) == 52


@pytest.mark.parametrize(
    ("size", "error", "message"),
    [
        ((0, 3), ValueError, "columns must be from 1 to 1000, not 0"),
        ((3, 1001), ValueError, "rows must be from 1 to 1000, not 1001"),
        ((3.5, 3), TypeError, "columns must be a whole number, not float"),
    ],
)
def test_a_size_that_cannot_be_is_refused(size, error, message):
    with pytest.raises(error, match=message):
        Console(*size)


def test_only_text_is_written():
    with pytest.raises(TypeError, match="s must be a string, not bytes"):
        Console(3, 3).write(b"ab")
