"""The ten scenes move, keep no state, and reach the panel."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import Framebuffer
from paneldraw.demos.scenes import HEIGHT, SCENES, WIDTH

SOME = [0, 1, 30, 31, 77, 119, 120]


def drawn(name, frame):
    fb = Framebuffer(WIDTH, HEIGHT)
    fb.fill(1)
    SCENES[name](fb, frame)
    return fb


def test_there_are_ten():
    assert list(SCENES) == [
        *("ball", "clock", "stopwatch", "ticker", "graph"),
        *("progress", "wire cube", "menu", "spectrum", "cursor"),
    ]


@pytest.mark.parametrize("name", SCENES)
def test_a_frame_depends_on_its_number_alone(name):
    forward = [drawn(name, frame).pixels for frame in SOME]
    backward = [drawn(name, frame).pixels for frame in reversed(SOME)]
    assert all(np.array_equal(one, other) for one, other in zip(forward, reversed(backward), strict=True))


@pytest.mark.parametrize("name", SCENES)
def test_every_scene_moves_and_is_a_picture(name):
    pictures = [drawn(name, frame) for frame in range(0, 121, 8)]
    assert len({bytes(picture.pixels) for picture in pictures}) >= len(pictures) // 2
    assert all(100 < np.count_nonzero(picture.pixels) < WIDTH * HEIGHT / 2 for picture in pictures)
