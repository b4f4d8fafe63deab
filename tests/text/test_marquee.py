"""A line of text that runs: where it is by when, and that its window holds it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Framebuffer
from paneldraw.text import Marquee

LONG = "Now playing: a long title"  # 25 characters, 149 pixels


def test_a_text_that_fits_stands_still():
    marquee = Marquee("Hi", 64)
    fb, still = Framebuffer(64, 8), Framebuffer(64, 8)
    marquee.draw(fb, t=100)
    still.text("Hi", 0, 0)
    assert fb == still
    assert not marquee.runs


def test_a_loop_waits_and_goes_round():
    marquee = Marquee(LONG, 64, speed=10, pause=2, gap=11)
    assert [marquee.shift(t) for t in (0, 2, 2.5, 3, 17.9, 18, 20.5)] == [0, 0, 5, 10, 159, 0, 5]


def test_a_bounce_waits_at_both_ends():
    marquee = Marquee(LONG, 64, speed=10, pause=2, run="bounce")
    assert [marquee.shift(t) for t in (0, 2, 3, 10.5, 12.4, 12.65, 13.55, 21, 22)] == [0, 0, 10, 85, 85, 84, 75, 0, 0]


@given(st.floats(0, 1e6), st.sampled_from(["loop", "bounce"]), st.integers(1, 160), st.integers(0, 50))
def test_the_window_shows_the_text_shifted_and_nothing_else_changes(t, run, width, gap):
    marquee = Marquee(LONG, width, run=run, gap=gap)
    shift = marquee.shift(t)
    period = 149 + gap
    assert 0 <= shift <= (period if run == "loop" else max(149 - width, 0))
    ribbon = Framebuffer(2 * period + 200, 8)
    ribbon.text(LONG, 0, 0)
    if run == "loop" and width < 149:
        ribbon.text(LONG, period, 0)
    fb = Framebuffer(170, 12, depth=2)
    fb.fill(1)
    marquee.draw(fb, 5, 2, 3, t=t)
    shown = np.where(ribbon.pixels[:, shift : shift + width] == 1, 3, 1)
    assert np.array_equal(fb.pixels[2:10, 5 : 5 + width], shown)
    fb.pixels[2:10, 5 : 5 + width] = 1
    assert (fb.pixels == 1).all()


def test_the_clock_starts_with_the_first_drawing_of_a_text(monkeypatch):
    now = [50.0]
    monkeypatch.setattr("time.monotonic", lambda: now[0])
    marquee = Marquee(LONG, 64, speed=10, pause=1)

    def first_column():
        fb = Framebuffer(64, 8)
        marquee.draw(fb)
        return fb.pixels[:, 0].tolist()

    start = first_column()
    now[0] = 51.3
    moved = first_column()
    assert moved != start
    marquee.text = LONG
    assert first_column() == moved
    marquee.text = LONG + "!"
    assert first_column() == start


def test_ends_of_line_are_spaces():
    assert Marquee("one\ntwo\r\nthree", 10).text == "one two three"


@pytest.mark.parametrize(
    ("how", "error", "message"),
    [
        ({"width": 0}, ValueError, "width and speed must be positive.* width=0"),
        ({"width": 9.5}, TypeError, "width and gap must be whole numbers"),
        ({"speed": 0}, ValueError, "speed=0"),
        ({"speed": float("nan")}, ValueError, "speed=nan"),
        ({"pause": -1}, ValueError, "pause=-1"),
        ({"gap": -1}, ValueError, "gap"),
        ({"run": "bouncing"}, ValueError, "run must be one of 'loop', 'bounce', not 'bouncing'; did you mean bounce?"),
        ({"text": 5}, TypeError, "text must be a string, not int"),
        ({"font": "small"}, TypeError, "font must be a Font"),
    ],
)
def test_what_cannot_be_meant_is_refused(how, error, message):
    with pytest.raises(error, match=message):
        Marquee(**({"text": LONG, "width": 64} | how))
