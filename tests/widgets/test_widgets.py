"""What each widget shows of what it is given."""

from __future__ import annotations

import dataclasses
import math
import sys
from array import array
from collections import deque

import numpy as np
import pytest
import segno
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Font, Framebuffer
from paneldraw.testing import assert_frame, assert_pattern
from paneldraw.widgets import (
    Bars,
    Battery,
    Chart,
    Gauge,
    Log,
    Marquee,
    Menu,
    Number,
    Pages,
    ProgressBar,
    QRCode,
    ScrollBar,
    Signal,
    Sparkline,
    Tabs,
    Toast,
    ticks,
)
from paneldraw.widgets.axis import label, nice

WAVE = [20 + 4 * math.sin(x / 10) + 1.5 * math.sin(x / 2) for x in range(128)]
ENTRIES = ["Brightness", ("Contrast", "50"), ("Wi-Fi", "on"), "Bluetooth", "Language", "Date and time", "About"]
FACES = {
    "progress": ProgressBar(0.43, "{:.0%}"),
    "gauge": Gauge(21.5, 0, 40, unit="°C", form=".1f"),
    "gauge_needle": Gauge(63, 0, 120, unit="km/h", needle=True),
    "number": Number(21.53, "°C", "inside"),
    "menu": Menu(ENTRIES, 3, "SETTINGS"),
    "tabs": Tabs(["Now", "Today", "Week"], 1),
    "sparkline": Sparkline(WAVE, fill=True),
    "bars": Bars([3, 6, 2, -2, 5, 7], ["Mo", "Tu", "We", "Th", "Fr", "Sa"], caps=[4, 7, 4, 1, 6, 9]),
    "chart": Chart([WAVE, WAVE[::-1]], xs=np.arange(128) / 128 * 24, grid=True),
    "toast": Toast("Saved to disk"),
    "marquee": Marquee("Trains leave from platform 4 today", 2.5),
    "log": Log(["connected", "3 files received", "a long line that does not fit the panel's width", "done"]),
    "pages": Pages([Number(21.5, "°C", "in"), Number(48, "%", "humidity")], 0.4, dots=True),
}


def drawn(widget, width=128, height=64, depth=1):
    fb = Framebuffer(width, height, depth)
    widget.draw(fb)
    return fb


def lit(fb):
    return int(np.count_nonzero(fb.pixels))


@pytest.mark.parametrize(("width", "height", "depth"), [(128, 64, 1), (128, 64, 4), (128, 32, 1), (64, 48, 1)])
@pytest.mark.parametrize("name", FACES)
def test_widgets_look_as_they_did(name, width, height, depth):
    shades = "_shades" if depth > 1 else ""
    assert_frame(drawn(FACES[name], width, height, depth), f"widgets/{name}_{width}x{height}{shades}.png")


@pytest.mark.parametrize("name", [name for name in FACES if name != "pages"])
def test_a_widget_draws_with_the_level_it_is_told(name):
    fb = drawn(dataclasses.replace(FACES[name], c=7), depth=4)
    assert fb.pixels.max() == 7


# -- One value


@given(st.floats(0, 1), st.floats(0, 1))
def test_what_is_more_lights_no_pixel_less(one, other):
    few, many = sorted((one, other))
    for make in (ProgressBar, Battery, Signal):
        assert not (drawn(make(few)).pixels > drawn(make(many)).pixels).any()


def test_a_bar_is_empty_at_0_and_full_at_1_and_beyond():
    empty, full = drawn(ProgressBar(0), 20, 7), drawn(ProgressBar(1), 20, 7)
    assert lit(empty) == 2 * 20 + 2 * 5
    assert lit(full) == lit(empty) + 16 * 3
    assert [drawn(ProgressBar(share), 20, 7) for share in (-3, math.nan, 1.2, math.inf)] == [empty, empty, full, full]


def test_a_label_is_dark_where_the_bar_is_light():
    label_alone = drawn(ProgressBar(0, "half"), 64, 12).pixels[2:-2, 2:-2]
    inverse = drawn(ProgressBar(1, "half"), 64, 12).pixels[2:-2, 2:-2]
    assert np.array_equal(inverse, 1 - label_alone)
    half = drawn(ProgressBar(0.5, "half"), 64, 12).pixels[2:-2, 2:-2]
    assert np.array_equal(half[:, :30], inverse[:, :30])
    assert np.array_equal(half[:, 30:], label_alone[:, 30:])


def test_a_gauge_fills_clockwise_from_the_lower_left():
    lower, middle, upper = (drawn(Gauge(value, 0, 9), 65, 49).pixels.astype(int) for value in (0, 4.5, 9))
    outer = np.hypot(*(np.mgrid[-32:17, -32:33])) > 27
    for half, like in ((np.s_[:, :30], upper), (np.s_[:, 35:], lower)):
        assert np.abs(middle - like)[half][outer[half]].sum() <= 2
    assert (upper - lower)[outer].sum() > 200


def test_a_number_is_as_large_as_fits_and_its_unit_and_label_are_there():
    fb = drawn(Number(7, "%", "load", form=".0f"), 40, 41)
    words = Framebuffer(40, 41)
    words.text("load", 19, 0, anchor="mt")
    assert np.array_equal(fb.pixels[:8], words.pixels[:8])
    assert drawn(Number("--"), 128, 64).pixels.any()
    given = [lit(drawn(Number(7, form=".0f", font=Font.builtin()), side, side)) for side in (8, 16, 24, 32)]
    assert [size / given[0] for size in given] == [1, 4, 9, 16]
    sizes = [lit(drawn(Number(7, form=".0f"), side, side)) for side in (8, 16, 32, 48)]
    assert sizes[0] == given[0]
    assert [size / sizes[1] for size in sizes[1:]] == [1, 4, 9]


@pytest.mark.parametrize(("segments", "name"), [(False, "numbers"), (True, "segments")])
def test_a_number_with_room_is_written_in_the_digits_made_for_it(segments, name):
    number = Number(21.5, segments=segments)
    for factor in (1, 2):
        fb, words = Framebuffer(80, 16 * factor), Framebuffer(80, 16 * factor)
        number.draw(fb)
        font = Font.builtin(name).scaled(factor)
        words.text("21.5", (80 - font.measure("21.5")[0]) // 2, 0, font=font)
        assert np.array_equal(fb.pixels.any(axis=0), words.pixels.any(axis=0))
        assert lit(fb) == lit(words)
    assert drawn(number, 31, 16) == drawn(Number(21.5, font=Font.builtin()), 31, 16)


def test_a_battery_charges():
    resting, charging = Framebuffer(40, 20), Framebuffer(40, 20)
    Battery(0.5).draw(resting, 0, 0, 40, 20)
    Battery(0.5, charging=True).draw(charging, 0, 0, 40, 20)
    differs = resting.pixels != charging.pixels
    assert differs[4:-4, 12:22].any()
    assert not differs[:, :7].any()
    assert not differs[:, 27:].any()


def test_signal_bars_light_one_by_one():
    assert [lit(drawn(Signal(share), 11, 8)) for share in (0, 0.25, 0.5, 0.75, 1)] == [8, 10, 16, 26, 40]
    assert_pattern(
        drawn(Signal(0.5), 11, 8),
        """
        ...........
        ...........
        ...........
        ...........
        ...##......
        ...##......
        ##.##......
        ##.##.##.##
        """,
    )


# -- Many values


@given(st.floats(-1e9, 1e9), st.floats(1e-6, 1e9), st.integers(2, 12))
def test_ticks_are_few_round_and_within(low, span, most):
    marks = ticks(low, low + span, most)
    assert len(marks) <= most
    assert all(low - span * 1e-6 <= mark <= low + span * (1 + 1e-6) for mark in marks)
    steps = np.diff(marks)
    if steps.size:
        assert steps.max() - steps.min() <= 1e-6 * span
        step = nice(float(steps[0]) * (1 - 1e-6))
        assert step == pytest.approx(float(steps[0]), rel=1e-5)
        assert f"{step:.0e}"[0] in "125"


def test_ticks_fill_the_axis():
    assert ticks(0, 100, 5) == [0, 50, 100]
    assert ticks(0, 100, 6) == [0, 20, 40, 60, 80, 100]
    assert ticks(100, 0, 6) == [0, 20, 40, 60, 80, 100]
    assert ticks(7, 7) == [7]
    assert ticks(0.1, 0.4, 4) == [0.1, 0.2, 0.3, 0.4]
    assert ticks(0, math.inf) == ticks(math.nan, 1) == ticks(0, 1, 0) == []


@pytest.mark.parametrize(
    ("value", "step", "text"),
    [(0, 10, "0"), (1500, 500, "1500"), (15000, 5000, "15k"), (2e6, 1e6, "2M"), (0.05, 0.01, "0.05"),
     (-50, 10, "-50"), (10, 0, "10"), (1e-9, 1e-9, "1e-09"), (3e20, 1e20, "3e+20")],
)  # fmt: skip
def test_labels_are_short(value, step, text):
    assert label(value, step) == text


def test_a_chart_writes_its_numbers_beside_their_rows():
    fb = drawn(Chart([0, 100], low=0, high=100), 128, 64)
    words = Framebuffer(128, 64)
    words.text("100", 17, 0, anchor="rt")
    assert np.array_equal(fb.pixels[:7, :18], words.pixels[:7, :18])
    assert fb.pixel(127, 0) == 1
    assert fb.pixels[:, 21].sum() == 62


def test_values_that_are_missing_leave_a_gap():
    whole = drawn(Sparkline([1, 2, 3, 4, 5, 4, 3, 2, 1], low=0, high=6), 9, 7)
    gap = drawn(Sparkline([1, 2, 3, math.nan, math.nan, 4, 3, 2, 1], low=0, high=6), 9, 7)
    assert not gap.pixels[:, 3:5].any()
    assert np.array_equal(whole.pixels[:, 6:], gap.pixels[:, 6:])


def test_bars_stand_on_zero():
    assert_pattern(
        drawn(Bars([2, -2, 4]), 8, 6),
        """
        ......##
        ......##
        ##....##
        ##....##
        ...##...
        ...##...
        """,
    )


def test_of_more_bars_than_columns_the_highest_count():
    many = [0] * 100
    many[37] = 5
    fb = drawn(Bars(many), 19, 5)
    assert fb.pixels.sum(axis=0).tolist() == [0] * 6 + [5] + [0] * 12


def test_of_more_values_than_columns_a_sparkline_shows_the_last():
    assert drawn(Sparkline([99] * 50 + WAVE[:64]), 64, 16) == drawn(Sparkline(WAVE[:64]), 64, 16)


def test_any_collection_of_numbers_will_do():
    by_name = dict(zip("abcd", (1, 4, 2, 3), strict=True))
    same = [by_name.values(), deque(by_name.values()), array("h", by_name.values()), np.array([1, 4, 2, 3], np.uint8)]
    for make in (Bars, Sparkline, Chart):
        assert all(drawn(make(values)) == drawn(make([1, 4, 2, 3])) for values in same)
        assert all(make(values).size == make([1, 4, 2, 3]).size for values in same)


def test_nothing_to_show_is_nothing():
    for widget in (Bars([]), Chart([]), Sparkline([]), Tabs([]), Pages([]), Log([]), Menu([])):
        assert lit(drawn(widget)) == 0


# -- Lists


@pytest.mark.parametrize("height", [12, 30, 48, 64])
def test_the_chosen_entry_is_in_sight(height):
    for chosen, entry in enumerate(ENTRIES):
        fb = drawn(Menu(ENTRIES, chosen), 90, height)
        bars = [y for y in range(height - 9) if fb.pixels[y : y + 10, 0].all() and (y == 0 or not fb.pixels[y - 1, 0])]
        assert len(bars) == 1
        name = Framebuffer(60, 8)
        name.text(entry if isinstance(entry, str) else entry[0], 0, 0)
        shown = fb.pixels[bars[0] + 1 : bars[0] + 9, 2:50]
        assert np.array_equal(shown, 1 - name.pixels[:, :48])


def test_a_name_too_long_ends_in_an_ellipsis():
    fb, words = drawn(Menu(["Date and time"]), 50, 10), Framebuffer(50, 10)
    words.text("Date an…", 2, 1)
    assert fb == words


def test_a_scroll_bar_reaches_both_ends():
    for total in (5, 17, 1000):
        first, last = drawn(ScrollBar(0, 4, total), 3, 40), drawn(ScrollBar(total - 4, 4, total), 3, 40)
        assert first.pixels[0].all()
        assert last.pixels[-1].all()
        assert np.array_equal(first.pixels, last.pixels[::-1])
    assert drawn(ScrollBar(0, 9, 4), 3, 40).pixels.all()


def test_tabs_without_room_show_the_chosen_one_alone():
    fb, words = drawn(Tabs(["Now", "Today", "Week"], 2), 64, 48), Framebuffer(64, 12)
    words.text("Week", 31, 8, anchor="ms")
    words.text("←", 0, 8, anchor="ls")
    words.hline(0, 11, 64)
    assert np.array_equal(fb.pixels[:12], words.pixels)


# -- Text that moves


def test_a_text_that_fits_stands_still():
    assert drawn(Marquee("short", 0)) == drawn(Marquee("short", 7.3))


def test_a_marquee_comes_around():
    text = "a text that is wider than the panel"
    period = (Font.builtin().measure(text)[0] + 24) / 30
    start = drawn(Marquee(text, 0), 64, 8)
    assert drawn(Marquee(text, period), 64, 8) == start
    later = drawn(Marquee(text, 0.1), 64, 8)
    assert np.array_equal(later.pixels[:, :-3], start.pixels[:, 3:])


def test_a_log_shows_the_end_and_what_was_before():
    lines = [str(k) for k in range(20)]
    words = Framebuffer(64, 32)
    words.text("16\n17\n18\n19", 0, 0)
    assert drawn(Log(lines), 64, 32) == words
    words.clear()
    words.text("14\n15\n16\n17", 0, 0)
    assert drawn(Log(lines, back=2), 64, 32) == words
    words.clear()
    words.text("0\n1\n2\n3", 0, 0)
    assert drawn(Log(lines, back=99), 64, 32) == words


def test_a_line_of_a_log_breaks_after_words_and_long_words_anywhere():
    words = Framebuffer(64, 32)
    words.text("one two\nthree\nabcdefghij\nklm", 0, 0)
    assert drawn(Log(["one two three", "abcdefghijklm"]), 64, 32) == words


def test_a_toast_hides_what_is_below_and_comes_from_below():
    fb = Framebuffer(64, 48)
    fb.fill(1)
    Toast("ok", share=0).draw(fb)
    assert fb.pixels.all()
    Toast("ok").draw(fb)
    assert not fb.pixels[-20:].all()
    assert fb.pixels[:28].all()


# -- Codes


def test_a_code_has_the_modules_of_the_standard():
    matrix = np.array(segno.make("https://example.org", error="L", micro=False).matrix, np.uint8)
    fb = drawn(QRCode("https://example.org"), 128, 64)
    assert lit(fb) == 4 * (1 - matrix).sum() + (54**2 - 50**2)
    assert np.array_equal(fb.pixels[7:57:2, 39:89:2], 1 - matrix)


def test_a_code_without_room_is_a_question_mark():
    fb, words = drawn(QRCode("https://example.org"), 20, 20), Framebuffer(20, 20)
    words.rect(0, 0, 20, 20)
    words.text("?", 9, 9, anchor="mm")
    assert fb == words


def test_a_code_without_its_package_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "segno", None)
    with pytest.raises(ImportError, match=r'pip install "paneldraw\[qr\]"'):
        drawn(QRCode("a text that no other test has"))


def test_a_text_too_long_for_a_code():
    with pytest.raises(ValueError, match="too large"):
        drawn(QRCode("x" * 5000))


# -- Pages


@pytest.mark.parametrize("transition", ["slide", "cover", "wipe", "dissolve", "cut"])
@pytest.mark.parametrize("depth", [1, 4])
def test_a_whole_position_is_a_page_and_around_it_goes(transition, depth):
    numbers = [Number(k, form=".0f") for k in range(3)]
    for position in (0, 1, 2, 3, -1):
        assert drawn(Pages(numbers, position, transition), depth=depth) == drawn(numbers[position % 3], depth=depth)
    halfway = drawn(Pages(numbers, 0.5, transition), depth=depth)
    assert (halfway == drawn(numbers[0], depth=depth)) == (transition == "cut")


def test_pages_may_be_functions():
    fb = drawn(Pages([lambda part: part.fill(1), lambda part: None], 0.25), 40, 8)
    assert fb.pixels[0].tolist() == [1] * 30 + [0] * 10


def test_an_unknown_transition():
    with pytest.raises(ValueError, match="slide, cover, wipe, dissolve, cut"):
        Pages([], transition="fly")
