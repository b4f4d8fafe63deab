"""Drawing allocates nothing that grows with the shape: working memory is the framebuffer's, kept from call to call."""

from __future__ import annotations

import gc
import tracemalloc

import numpy as np
import pytest

from paneldraw import ConeFilter, Framebuffer, Supersample, _compiled

WIDTH, HEIGHT = 256, 256
# A counter a pixel, and one beyond the right end.
ROW = 8 * (WIDTH + 1)

PATH = np.array([(3, 5), (250, 50), (20, 200), (90, 3), (50, 250)])

CALLS = {
    "line": lambda fb: fb.line(3, 5, 250, 200),
    "thick line": lambda fb: fb.line(3, 5, 250, 200, width=7.5),
    "round caps": lambda fb: fb.line(3, 5, 250, 200, width=9, cap="round"),
    "dashes": lambda fb: fb.line(3, 5, 250, 200, dash=(2, 1)),
    "polyline": lambda fb: fb.polyline(PATH),
    "thick polyline": lambda fb: fb.polyline(PATH, width=9, join="round", closed=True),
    "polygon": lambda fb: fb.poly(0, 0, PATH, fill=True),
    "triangle": lambda fb: fb.triangle(3, 5, 250, 100, 80, 250, fill=True),
    "rect": lambda fb: fb.rect(3, 5, 200, 100),
    "round_rect": lambda fb: fb.round_rect(3, 5, 200, 100, 30, fill=True),
    "circle": lambda fb: fb.circle(120, 120, 90),
    "thick circle": lambda fb: fb.circle(120, 120, 90, width=9),
    "disc": lambda fb: fb.circle(120, 120, 90, fill=True),
    "ellipse": lambda fb: fb.ellipse(120, 120, 90, 50),
    "arc": lambda fb: fb.arc(120, 120, 90, 10, 300),
    "sector": lambda fb: fb.sector(120, 120, 90, 10, 300, fill=True),
    "text": lambda fb: fb.text("memory", 3, 5),
    "points": lambda fb: fb.points(PATH),
}


@pytest.mark.skipif(not _compiled.COMPILED, reason="plain Python allocates each number")
@pytest.mark.parametrize("antialias", [None, Supersample(4), ConeFilter()], ids=repr)
@pytest.mark.parametrize("call", CALLS)
def test_a_call_allocates_less_than_a_row(call, antialias):
    fb = Framebuffer(WIDTH, HEIGHT, 8, antialias=antialias)
    draw = CALLS[call]
    draw(fb)
    gc.disable()
    tracemalloc.start()
    try:
        draw(fb)
        draw(fb)
        before, _ = tracemalloc.get_traced_memory()
        tracemalloc.reset_peak()
        draw(fb)
        after, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
        gc.enable()
    assert peak - before < ROW
    assert after - before < 64
    assert fb.pixels.any()
