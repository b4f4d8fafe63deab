"""Any call with any numbers draws or says what is wrong, and writes nowhere else. The interpreted package is the
witness: what would be a stray write in C is an IndexError there, or comes out differently.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import Phase, example, given, settings
from hypothesis import strategies as st
from searching import examples

import paneldraw

EDGES = [0, 2**7, 2**14, 2**15, 2**16, 2**18, 2**26, 2**29, 2**31, 2**32, 2**62, 2**63, 2**64, 2**70]
near = st.integers(-40, 60)
edges = st.builds(
    lambda edge, step, sign: sign * (edge + step), st.sampled_from(EDGES), st.integers(-2, 2), st.sampled_from([1, -1])
)
floats = st.floats(allow_nan=False, allow_infinity=False)
numbers = st.one_of(near, edges, st.floats(-40, 60), floats)
sizes = numbers.map(abs)
ops = st.sampled_from(["over", "xor", "add", "max", "clear"])
samples = st.one_of(st.none(), st.tuples(st.integers(1, 16), st.sampled_from(["center", "corner"])))
caps = st.sampled_from(["square", "butt"])
paths = st.lists(st.tuples(numbers, numbers), max_size=6)
ends = st.sampled_from(["butt", "square", "round"])
joins = st.sampled_from(["miter", "round", "bevel"])
square, mitered = ends.filter(lambda cap: cap != "round"), joins.filter(lambda join: join != "round")
dashes = st.lists(st.one_of(st.integers(1, 9), sizes.filter(lambda w: w >= 1)), min_size=1, max_size=3)

calls = st.one_of(
    st.tuples(st.just("pixel"), st.tuples(numbers, numbers)),
    st.tuples(st.sampled_from(["hline", "vline"]), st.tuples(numbers, numbers, sizes)),
    st.tuples(st.just("rect"), st.tuples(numbers, numbers, sizes, sizes)),
    st.tuples(st.just("disc"), st.tuples(numbers, numbers, sizes)),
    st.tuples(st.just("circle"), st.tuples(numbers, numbers, sizes)),
    st.tuples(st.just("line"), st.tuples(*[numbers] * 4)),
    st.tuples(st.just("thick"), st.tuples(*[numbers] * 4, sizes.filter(lambda w: w >= 1), caps, samples)),
    st.tuples(st.just("polyline"), st.tuples(paths)),
    st.tuples(st.just("polygon"), st.tuples(paths, near, near)),
    st.tuples(
        st.just("stroke"), st.tuples(paths, st.floats(1, 40), ends, joins, st.one_of(st.none(), dashes), samples)
    ),
    # Arcs of such a size, or so many dashes, the interpreted package would draw for minutes.
    st.tuples(st.just("stroke"), st.tuples(paths, sizes.filter(lambda w: w >= 1), square, mitered, st.none(), samples)),
    st.tuples(st.just("text"), st.tuples(st.text("Ag\n\t", max_size=30), numbers, numbers)),
    st.tuples(st.just("image"), st.tuples(st.integers(0, 30), st.integers(0, 30), numbers, numbers)),
)


def perform(package, fb, call, arguments, level, op):
    """One drawing call."""
    if call == "thick":
        *ends, width, cap, samples = arguments
        fb.line(*ends, level, width=width, cap=cap, antialias=samples and package.Supersample(*samples), op=op)
    elif call == "stroke":
        points, width, cap, join, dash, samples = arguments
        samples = samples and package.Supersample(*samples)
        fb.polyline(points, level, width=width, cap=cap, join=join, dash=dash, antialias=samples, op=op)
    elif call == "polygon":
        points, x, y = arguments
        fb.poly(x, y, points, level, fill=True, op=op)
    elif call == "image":
        width, height, x, y = arguments
        fb.image(np.arange(width * height, dtype=np.int64).astype(np.uint8).reshape(height, width), x, y)
    elif call == "disc":
        fb.circle(*arguments, level, fill=True, op=op)
    else:
        getattr(fb, call)(*arguments, level, op=op)


# Shrinking a failure of so many calls would take longer than a test may.
quickly = (Phase.explicit, Phase.reuse, Phase.generate)


@examples(4, phases=quickly)
@given(
    st.lists(st.tuples(calls, ops), min_size=1, max_size=6), st.integers(1, 40), st.integers(1, 40), st.integers(1, 15)
)
@example([(("circle", (2**29, 0, 2**29)), "xor"), (("disc", (0, -(2**14), 2**14)), "over")], 5, 7, 3)
def test_both_speeds_give_equal_pixels(sources, script, width, height, level):
    pictures = []
    for package in (paneldraw, None):
        if package:
            pictures.append(perform_all(package, script, width, height, level))
        else:
            with sources.in_place() as interpreted:
                pictures.append(perform_all(interpreted, script, width, height, level))
    assert (pictures[0] == pictures[1]).all()


def perform_all(package, script, width, height, level):
    fb = package.Framebuffer(width, height, depth=4)
    for (call, arguments), op in script:
        perform(package, fb, call, arguments, level, op)
    assert fb.pixels.max() <= 15
    return fb.pixels


@settings(phases=quickly)
@given(st.lists(st.tuples(calls, ops), min_size=10, max_size=20))
def test_neighbors_in_memory_are_left_alone(script):
    """Framebuffers of a size lie close together; only the one drawn on may change."""
    row = [paneldraw.Framebuffer(16, 8, depth=8) for _ in range(9)]
    for fb in row:
        fb.pixels[...] = 0xA5
    for (call, arguments), op in script:
        perform(paneldraw, row[4], call, arguments, 0x3C, op)
    assert all((fb.pixels == 0xA5).all() for fb in row if fb is not row[4])


@pytest.mark.parametrize("distance", [2**17, 2**31, 2**40, 2**70])
@pytest.mark.parametrize("scale", [1, -1])
def test_lines_across_everything(package, distance, scale):
    """Half of the plane is a very wide line, though of 2**32 pixels at most; the picture is all in it, or all out."""
    fb = package.Framebuffer(20, 10)
    d = scale * distance
    fb.line(-d, d // 2, d, d // 2, width=distance - 100, antialias=package.Supersample(4))
    assert not fb.pixels.any()
    fb.line(-d, d // 2, d, d // 2, width=distance + 100, antialias=package.Supersample(4))
    assert fb.pixels.all() == fb.pixels.any() == (distance < 2**32)
