"""How levels meet what is there: each pixel of each shape, against the definition; and each pixel once."""

from __future__ import annotations

import definitions
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from searching import examples

WIDTH, HEIGHT = 12, 9
DEPTHS = (1, 2, 4, 8)
OPS = ("over", "xor", "add", "max", "clear")

coordinates = st.integers(-6, 16)
sizes = st.integers(0, 14)
segments = st.lists(st.tuples(*[coordinates] * 4), max_size=4)


@st.composite
def shapes(draw):
    """A call of one primitive, aliased, as (name, arguments, keywords)."""
    x, y, w, h = draw(coordinates), draw(coordinates), draw(sizes), draw(sizes)
    return draw(
        st.sampled_from(
            [
                ("pixel", (x, y), {}),
                ("hline", (x, y, w), {}),
                ("vline", (x, y, h), {}),
                ("line", (x, y, x + w - 7, y + h - 7), {}),
                ("line", (x, y, x + w - 7, y + h - 7), {"width": 3}),
                ("line", (x, y, x + w - 7, y + h - 7), {"width": 2.5, "cap": "butt"}),
                ("rect", (x, y, w, h), {}),
                ("rect", (x, y, w, h), {"fill": True}),
                ("circle", (x, y, w), {}),
                ("circle", (x, y, w), {"fill": True}),
                ("text", ("g%", x, y), {}),
                ("line", (x, y, x + w - 7, y + h - 7), {"dash": (2, 1)}),
                ("line", (x, y, x + w - 7, y + h - 7), {"width": 3, "cap": "round", "dash": (2, 1.5)}),
                ("triangle", (x, y, x + w - 7, y + h - 7, 3, 4), {}),
                ("triangle", (x, y, x + w - 7, y + h - 7, 3, 4), {"fill": True}),
                ("poly", (x, y, [0, 0, 5, 6, 6, 0, h - 7, w - 7]), {"fill": True}),
                ("polyline", ([x, y, 5, 6, 6, 0, w - 7, h - 7],), {}),
                ("polyline", ([x, y, 5, 6, 6, 0, w - 7, h - 7],), {"width": 2, "join": "round", "closed": True}),
            ]
        )
    )


def draw_shape(fb, shape, level, **keywords):
    name, arguments, options = shape
    getattr(fb, name)(*arguments, c=level, **options, **keywords)


def mask(package, shape):
    """The pixels of the shape, drawn over a blank picture."""
    fb = package.Framebuffer(WIDTH, HEIGHT)
    draw_shape(fb, shape, 1)
    return fb.pixels.copy()


@st.composite
def pictures(draw, package):
    depth = draw(st.sampled_from(DEPTHS))
    fb = package.Framebuffer(WIDTH, HEIGHT, depth)
    seed = np.random.default_rng(draw(st.integers(0, 2**32)))
    fb.pixels[...] = seed.integers(0, fb.max_level + 1, fb.pixels.shape)
    return fb, draw(st.integers(0, fb.max_level))


@examples(3)
@given(st.data(), shapes(), st.sampled_from(OPS))
def test_every_pixel_of_every_shape_meets_what_is_there_once(package, data, shape, op):
    fb, level = data.draw(pictures(package))
    wanted = definitions.painted(fb.pixels.copy(), mask(package, shape), 1, level, op, fb.depth)
    draw_shape(fb, shape, level, op=op)
    assert (fb.pixels == wanted).all()


@pytest.mark.parametrize("op", OPS)
@given(st.data(), st.tuples(*[coordinates] * 4), st.integers(1, 16), st.sampled_from(["center", "corner"]))
def test_coverage_meets_what_is_there(package, op, data, ends, n, reference):
    fb, level = data.draw(pictures(package))
    counts = definitions.rectangle(WIDTH, HEIGHT, *ends, 2.5, "square", n, reference)
    wanted = definitions.painted(fb.pixels.copy(), counts, n * n, level, op, fb.depth)
    fb.line(*ends, level, width=2.5, antialias=package.Supersample(n, reference), op=op)
    assert (fb.pixels == wanted).all()


@given(st.data(), shapes())
def test_xor_twice_is_nothing(package, data, shape):
    fb, level = data.draw(pictures(package))
    before = fb.pixels.copy()
    for _ in range(2):
        draw_shape(fb, shape, level, op="xor")
    assert (fb.pixels == before).all()


@given(st.data(), st.tuples(*[coordinates] * 4), st.floats(0.1, 9), st.integers(1, 16))
def test_xor_twice_is_nothing_where_a_shape_is_anti_aliased_too(package, data, ends, width, n):
    fb, level = data.draw(pictures(package))
    before = fb.pixels.copy()
    for _ in range(2):
        fb.line(*ends, level, width=width, antialias=package.Supersample(n), op="xor")
    assert (fb.pixels == before).all()


@given(shapes())
def test_xor_on_a_blank_picture_is_the_shape(package, shape):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    draw_shape(fb, shape, 1, op="xor")
    assert (fb.pixels == mask(package, shape)).all()


@given(st.data(), segments)
def test_lines_of_a_batch_meet_one_after_the_other(package, data, segments):
    fb, level = data.draw(pictures(package))
    wanted = fb.pixels.copy()
    for ends in segments:
        wanted = definitions.painted(wanted, definitions.bresenham(WIDTH, HEIGHT, *ends), 1, level, "xor", fb.depth)
    fb.lines(segments, level, op="xor")
    assert (fb.pixels == wanted).all()


@given(st.data(), st.integers(0, 255))
def test_levels_that_a_script_wrote_beyond_the_highest_do_no_harm(package, data, strange):
    fb, level = data.draw(pictures(package))
    fb.pixels[...] = strange
    for op in OPS:
        fb.rect(0, 0, 5, 5, level, True, op=op)
        fb.line(0, 0, 9, 5, level, op=op, antialias=package.Supersample(4))
    fb.clear()
    assert not fb.pixels.any()
