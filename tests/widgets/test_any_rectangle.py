"""Whatever a widget is given and wherever it is drawn: it never raises, and paints nothing outside its rectangle."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Font, Framebuffer
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
    ScrollBar,
    Signal,
    Sparkline,
    Tabs,
    Toast,
)
from paneldraw.widgets.pages import TRANSITIONS

NUMBERS = st.floats(width=64) | st.integers(-(2**40), 2**40)
SERIES = st.lists(NUMBERS, max_size=140)
TEXTS = st.text(st.characters(exclude_categories=["Cs"]), max_size=30)
NAMES = st.lists(TEXTS, max_size=9)
SIDES = st.integers(-3, 70) | st.sampled_from([0, 1, 2, 3, 1e9, math.inf])
LIMITS = st.none() | NUMBERS

WIDGETS = {
    "progress": st.builds(ProgressBar, NUMBERS, st.sampled_from(["", "{:.0%}", "busy"])),
    "gauge": st.builds(Gauge, NUMBERS, NUMBERS, NUMBERS, unit=TEXTS, needle=st.booleans()),
    "number": st.builds(Number, NUMBERS | TEXTS, TEXTS, TEXTS, segments=st.booleans()),
    "battery": st.builds(Battery, NUMBERS, st.booleans()),
    "signal": st.builds(Signal, NUMBERS, st.integers(-1, 50)),
    "menu": st.builds(
        Menu, st.lists(TEXTS | st.tuples(TEXTS, TEXTS), max_size=9), st.none() | st.integers(-2, 12), TEXTS
    ),
    "scroll bar": st.builds(ScrollBar, NUMBERS, NUMBERS, NUMBERS),
    "tabs": st.builds(Tabs, NAMES, st.integers(-2, 12)),
    "sparkline": st.builds(Sparkline, SERIES, LIMITS, LIMITS, fill=st.booleans()),
    "bars": st.builds(Bars, SERIES, NAMES, LIMITS, LIMITS, st.none() | SERIES),
    "chart": st.builds(Chart, SERIES, st.none() | SERIES, LIMITS, LIMITS, st.booleans(), st.booleans()),
    "toast": st.builds(Toast, TEXTS, NUMBERS),
    "marquee": st.builds(Marquee, TEXTS, NUMBERS, NUMBERS, st.integers(-5, 50)),
    "log": st.builds(Log, NAMES, st.integers(-2, 12)),
    "pages": st.builds(
        Pages, st.lists(st.builds(Number, NUMBERS), max_size=3), NUMBERS, st.sampled_from([*TRANSITIONS]), st.booleans()
    ),
}


def outside(fb, x, y, w, h):
    """The pixels that are none of the rectangle's."""
    rows, columns = np.mgrid[: fb.height, : fb.width]
    inside = (columns >= x) & (columns < x + w) & (rows >= y) & (rows < y + h)
    return fb.pixels[~inside]


@pytest.mark.parametrize("name", WIDGETS)
@given(data=st.data())
def test_a_widget_stays_in_its_rectangle(name, data):
    widget = data.draw(WIDGETS[name])
    depth, there = data.draw(st.sampled_from([1, 2, 4, 8])), data.draw(st.integers(0, 1))
    x, y, w, h = (data.draw(sides) for sides in (st.integers(-70, 140), st.integers(-70, 70), SIDES, SIDES))
    fb = Framebuffer(128, 64, depth)
    fb.fill(there)
    widget.draw(fb, x, y, w, h)
    assert (outside(fb, x, y, w, h) == there).all()


@pytest.mark.parametrize("name", WIDGETS)
@given(data=st.data())
def test_a_widget_has_a_size_and_draws_at_it(name, data):
    widget = data.draw(WIDGETS[name])
    w, h = widget.size
    assert (type(w), type(h)) == (int, int)
    assert min(w, h) >= 0
    fb = Framebuffer(128, 64)
    widget.draw(fb, 3, 2, w, h)
    assert not outside(fb, 3, 2, w, h).any()


@pytest.mark.parametrize("name", WIDGETS)
@given(data=st.data())
def test_a_widget_in_a_view_is_the_widget_in_a_rectangle_even_one_that_reaches_out(name, data):
    widget = data.draw(WIDGETS[name])
    x, y, w, h = (data.draw(st.integers(*ends)) for ends in ((0, 60), (0, 30), (1, 64), (1, 32)))
    depth = data.draw(st.sampled_from([1, 4]))
    through_view, in_rectangle = Framebuffer(124, 62, depth), Framebuffer(124, 62, depth)
    widget.draw(through_view.view(x, y, w, h), 0, 0, w, h)
    widget.draw(in_rectangle, x, y, w, h)
    assert through_view == in_rectangle
    right, down = w // 2, h // 2
    cut = Framebuffer(64, 32, depth)
    widget.draw(cut, -right, -down, w, h)
    assert np.array_equal(cut.pixels[: h - down, : w - right], in_rectangle.pixels[y + down : y + h, x + right : x + w])


@pytest.mark.parametrize("name", WIDGETS)
@given(data=st.data())
def test_any_font_will_do(name, data):
    widget = data.draw(WIDGETS[name])
    large = dataclasses.replace(widget, font=Font.builtin().scaled(data.draw(st.integers(1, 4))))
    fb = Framebuffer(100, 50)
    large.draw(fb, 10, 10, 50, 20)
    assert not outside(fb, 10, 10, 50, 20).any()
