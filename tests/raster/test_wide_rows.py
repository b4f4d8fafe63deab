"""Rows much wider than what they hold are painted from end to end of their spans: the same as part by part."""

from __future__ import annotations

from hypothesis import example, given
from hypothesis import strategies as st

WIDTH, HEIGHT, PART = 700, 5, 50

points = st.tuples(st.integers(-200, WIDTH + 200), st.integers(-4, HEIGHT + 4))
samples = st.tuples(st.integers(2, 16), st.sampled_from(["center", "corner"]))
shapes = st.one_of(
    st.tuples(st.just("poly"), st.lists(points, min_size=3, max_size=7), st.sampled_from(["even-odd", "nonzero"])),
    st.tuples(st.just("polyline"), st.lists(points, min_size=2, max_size=4), st.sampled_from([0.5, 1, 6])),
    st.tuples(st.just("line"), st.tuples(points, points), st.sampled_from([1, 3.25])),
    st.tuples(st.just("disc"), points, st.integers(1, 500)),
    st.tuples(st.just("ring"), points, st.integers(1, 500)),
)


def draw(fb, shape, **style):
    name, place, more = shape
    if name == "poly":
        fb.poly(0, 0, place, fill=True, rule=more, **style)
    elif name == "polyline":
        fb.polyline(place, width=more, **style)
    elif name == "line":
        fb.line(*place[0], *place[1], width=more, **style)
    else:
        fb.circle(*place, more, fill=name == "disc", **style)


@given(
    shapes, samples, st.sampled_from([1, 4, 8]), st.sampled_from(["over", "xor", "add", "max", "clear"]), st.integers()
)
@example(("disc", (WIDTH - 1, 2), 300), (4, "center"), 8, "over", 0)  # open where the window ends
@example(("poly", [(0, 0), (WIDTH, 2), (0, 4)], "nonzero"), (16, "center"), 8, "xor", 5)
def test_a_wide_row_is_its_parts(package, shape, sampling, depth, op, ground):
    whole, parts = package.Framebuffer(WIDTH, HEIGHT, depth), package.Framebuffer(WIDTH, HEIGHT, depth)
    style = {"antialias": package.Supersample(*sampling), "op": op}
    for fb in (whole, parts):
        fb.fill(ground % (fb.max_level + 1))
    draw(whole, shape, **style)
    for left in range(0, WIDTH, PART):
        with parts.clip(left, 0, PART, HEIGHT):
            draw(parts, shape, **style)
    assert (whole.pixels == parts.pixels).all()
    # Nothing is left behind for the next shape.
    for fb in (whole, parts):
        fb.fill(0)
        fb.line(0, 0, WIDTH, HEIGHT, antialias=package.Supersample(3))
    assert (whole.pixels == parts.pixels).all()
