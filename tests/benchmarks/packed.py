"""Drawing as MicroPython does, straight into an SSD1306's packed bytes: `paneldraw.compat.framebuf`, 128 x 64."""

from __future__ import annotations

import random
from array import array
from itertools import cycle, islice

import canvases
import numpy as np
from canvases import HEIGHT, WIDTH
from measure import Against, Contest, Names, Row

N = 100

CALLS = ("pixel", "hline", "vline", "line", "rect", "fill_rect", "fill", "scroll", "text", "ellipse", "poly", "blit")

LINES = "for x1, y1, x2, y2 in lines: line(x1, y1, x2, y2, 1)"
BLOCKS = "for x, y in corners: fill_rect(x, y, 64, 32, 1)"
FRAMES = "for x, y in corners: rect(x, y, 64, 32, 1)"
MOVES = "for dx, dy in steps: scroll(dx, dy)"

ROWS = [
    Row("line", N, LINES, (Against("framebuf", LINES, 20),)),
    Row("fill_rect, 64 x 32", N, BLOCKS, (Against("framebuf", BLOCKS, 60),)),
    Row("rect, 64 x 32", N, FRAMES, (Against("framebuf", FRAMES),)),
    Row("scroll", N, MOVES, (Against("framebuf", MOVES, 200),)),
    *(
        Row(name, N, statement, (Against("framebuf", statement),))
        for name, statement in {
            "pixel, write": "for x, y in points: pixel(x, y, 1)",
            "hline": "for x, y in points: hline(x, y, 50, 1)",
            "vline": "for x, y in points: vline(x, y, 30, 1)",
            "fill": "for level in levels: fill(level)",
        }.items()
    ),
    Row("text, 10 characters", N, "for x, y in points: text('0123456789', x - 40, y - 4)"),
    Row("ellipse, filled", N, "for x, y in points: ellipse(x, y, 20, 12, 1, True)"),
    Row("poly, filled, 5 corners", N, "for x, y in points: poly(x - 20, y - 20, corners_of_five, 1, True)"),
    Row("blit, 16 x 16", N, "for x, y in points: blit(stamp, x - 8, y - 8, 0)"),
]


def shapes() -> Names:
    """Where things are drawn."""
    pick = random.Random(1)
    points = [(pick.randrange(WIDTH), pick.randrange(HEIGHT)) for _ in range(N)]
    return {
        "points": points,
        "lines": [(*one, *other) for one, other in zip(points, points[1:] + points[:1], strict=True)],
        "corners": [(pick.randrange(WIDTH - 63), pick.randrange(HEIGHT - 31)) for _ in range(N)],
        "steps": [(pick.randint(-5, 5), pick.randint(-5, 5)) for _ in range(N)],
        "levels": list(islice(cycle((0, 1)), N)),
        "corners_of_five": array("h", (20, 0, 40, 15, 32, 38, 8, 38, 0, 15)),
    }


def ours() -> Names:
    """The calls on packed pages."""
    from paneldraw.compat import framebuf

    pages = np.zeros((HEIGHT // 8, WIDTH), np.uint8)
    fb = framebuf.FrameBuffer(pages, WIDTH, HEIGHT, framebuf.MONO_VLSB)
    return {
        **{name: getattr(fb, name) for name in CALLS},
        "stamp": (bytes(range(7, 39)), 16, 16, framebuf.MONO_VLSB),
        "shown": lambda: [np.unpackbits(pages[:, np.newaxis], axis=1, bitorder="little").reshape(HEIGHT, WIDTH)],
        "wipe": lambda: pages.fill(0),
    }


def contest(rounds: int) -> Contest:
    """Us and Adafruit's framebuf, which is Python."""
    return Contest(ours(), canvases.PEERS, rounds, shapes())


def run(rounds: int) -> None:
    """Print the group's rows."""
    contest(rounds).run_all(ROWS)
