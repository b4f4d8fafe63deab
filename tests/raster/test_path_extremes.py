"""Paths of many points, at both speeds and in odd places: what working memory is too small for writes elsewhere."""

from __future__ import annotations

import random

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from searching import examples

import paneldraw

seeds = st.integers(0, 2**32 - 1)
# How far points lie from the picture, which is at most 24 pixels wide.
reaches = st.sampled_from([4, 30, 30, 500, 2**17, 2**18, 2**30, 2**70])


def tangle(rng, count, reach):
    """Points of which some repeat, some lie on one line and some are far away."""
    points = []
    for _ in range(count):
        far = reach if rng.random() < 0.2 else 30
        point = (rng.randint(-far, far) + rng.randint(0, 255) / 256, rng.randint(-far, far))
        points.append(rng.choice([point, point, point, points[-1] if points else point, (point[0], 5)]))
    return points


def draw_at_random(package, fb, seed, reach):
    """A few shapes, small and large in turn, so that memory kept from one is used by the next."""
    rng = random.Random(seed)
    for _ in range(4):
        points = tangle(rng, rng.choice([0, 1, 2, 3, 5, 40, 90]), reach)
        samples = rng.choice([None, package.Supersample(rng.randint(1, 16), rng.choice(["center", "corner"]))])
        style = {"op": rng.choice(["over", "xor", "add", "max", "clear"]), "antialias": samples}
        level = rng.randint(0, fb.max_level)
        if rng.random() < 0.4:
            fb.poly(0, 0, points, level, fill=True, rule=rng.choice(["even-odd", "nonzero"]), **style)
        else:
            fb.polyline(
                points,
                level,
                closed=rng.random() < 0.5,
                width=rng.choice([1, 1, 1 / 256, 3, 7.25, 40]),
                cap=rng.choice(["butt", "square", "round"]),
                join=rng.choice(["miter", "round", "bevel"]),
                dash=rng.choice([None, (1,), (2, 1.5, 3), (40, 3), (2**70, 1)]),
                **style,
            )


@examples(0.8)
@given(seeds, reaches, st.integers(1, 24), st.integers(1, 16))
def test_both_speeds_give_equal_pixels(sources, seed, reach, width, height):
    compiled = paneldraw.Framebuffer(width, height, depth=4)
    draw_at_random(paneldraw, compiled, seed, reach)
    with sources.in_place() as package:
        interpreted = package.Framebuffer(width, height, depth=4)
        draw_at_random(package, interpreted, seed, reach)
    assert (compiled.pixels == interpreted.pixels).all()


@examples(0.4)
@given(seed=seeds, reach=reaches, box=st.tuples(*[st.integers(0, 9)] * 2, *[st.integers(1, 9)] * 2))
@example(seed=330636, reach=4, box=(6, 0, 5, 4))  # an endless dash, once cut where the window ended
def test_views_and_clips_hold_what_is_theirs(package, seed, reach, box):
    x, y, w, h = box
    outside = np.ones((18, 18), bool)
    outside[y : y + h, x : x + w] = False
    before = np.arange(18 * 18, dtype=np.uint32).astype(np.uint8).reshape(18, 18) & 15
    fb = package.Framebuffer(18, 18, depth=4)
    fb.pixels[...] = before
    with fb.clip(x, y, w, h):
        draw_at_random(package, fb, seed, reach)
    assert (fb.pixels[outside] == before[outside]).all()
    clipped = fb.pixels.copy()
    fb.pixels[...] = before
    draw_at_random(package, fb, seed, reach)
    assert (fb.pixels[~outside] == clipped[~outside]).all()
    fb.pixels[...] = before
    draw_at_random(package, fb.view(x, y, w, h), seed, reach)
    assert (fb.pixels[outside] == before[outside]).all()


@examples(0.8)
@given(seeds, reaches)
def test_neighbors_in_memory_are_left_alone(seed, reach):
    row = [paneldraw.Framebuffer(16, 8, depth=8) for _ in range(9)]
    for fb in row:
        fb.pixels[...] = 0xA5
    draw_at_random(paneldraw, row[4], seed, reach)
    assert all((fb.pixels == 0xA5).all() for fb in row if fb is not row[4])


@pytest.mark.parametrize("cap", ["butt", "square", "round"])
@pytest.mark.parametrize("join", ["miter", "round", "bevel"])
@pytest.mark.parametrize("width", [2**12, 2**2000], ids=["wide", "endless"])
def test_a_stroke_may_be_of_any_width(package, cap, join, width):
    for points in ([(3, 3)], [(3, 3), (9, 4)], [(-50, 2), (2, -50), (2**70, 9)]):
        for closed in (False, True):
            fb = package.Framebuffer(12, 8)
            fb.polyline(points, width=width, cap=cap, join=join, closed=closed)
            assert fb.pixels.any() or cap == "butt"


def test_thousands_of_points_are_drawn(package):
    """Ends at once, or, if edges were not kept in order, not for a long while."""
    rng = random.Random(1)
    many = 10000 if package is paneldraw else 300
    points = [(rng.uniform(-10, 140), rng.uniform(-10, 70)) for _ in range(many)]
    fb = package.Framebuffer(128, 64)
    fb.polyline(points, antialias=package.Supersample(4))
    assert fb.pixels.all() or many == 300
    fb.poly(0, 0, points, 0, fill=True)
    fb.polyline(sorted(points), 1, dash=(1, 1), width=2)
    assert fb.pixels.any()
