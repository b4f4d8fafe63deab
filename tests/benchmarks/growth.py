"""What a call costs by the pixels that it paints: nothing else should matter, not the surface nor what lies outside."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from statistics import median
from typing import Any

import measure
from measure import Timer

from paneldraw import ConeFilter, Framebuffer, Supersample

N = 60
SMALL = (128, 64)
SIZES = (SMALL, (512, 512), (4096, 4096))

Draw = Callable[[Framebuffer, list[tuple[int, int]]], None]

#: A call, the points it takes, and the depth of the framebuffer.
SHAPES: dict[str, tuple[Draw, int, int]] = {
    "line": (lambda fb, p: fb.line(*p[0], *p[1]), 2, 1),
    "line, Supersample(4)": (lambda fb, p: fb.line(*p[0], *p[1], antialias=Supersample(4)), 2, 8),
    "line, ConeFilter()": (lambda fb, p: fb.line(*p[0], *p[1], antialias=ConeFilter()), 2, 8),
    "polyline, 12 points, width 3, Supersample(4)": (
        lambda fb, p: fb.polyline(p, width=3, antialias=Supersample(4)),
        12,
        8,
    ),
    "filled polygon, 12 points": (lambda fb, p: fb.poly(0, 0, p, fill=True), 12, 1),
    "circle, through a point": (lambda fb, p: fb.circle(*p[0], max(abs(p[1][0] - p[0][0]), 1)), 2, 1),
    "disc, Supersample(4)": (
        lambda fb, p: fb.circle(*p[0], max(abs(p[1][0] - p[0][0]), 1), fill=True, antialias=Supersample(4)),
        2,
        8,
    ),
}


def places() -> Iterator[tuple[str, tuple[int, int], tuple[int, int], tuple[int, int]]]:
    """What is drawn: its name, the size of the surface, the least and the greatest coordinates of its points."""
    for size in SIZES:
        yield f"all over {size[0]} x {size[1]}", size, (0, 0), size
    yield "small ones on 4096 x 4096", SIZES[-1], (2000, 2000), (2000 + SMALL[0], 2000 + SMALL[1])
    for reach, name in ((10**4, "10 000"), (2**63 - 1, "2**63")):
        yield f"mostly outside 128 x 64, up to {name}", SMALL, (-reach, -reach), (reach, reach)


def picks(low: tuple[int, int], high: tuple[int, int], points: int) -> list[list[tuple[int, int]]]:
    """The points of N shapes, or of a few where it only matters that they are drawn."""
    pick = random.Random(7)
    count = N if measure.SAMPLE else 3
    return [
        [(pick.randrange(low[0], high[0]), pick.randrange(low[1], high[1])) for _ in range(points)]
        for _ in range(count)
    ]


def painted(fb: Framebuffer, draw: Draw, shapes: list[list[tuple[int, int]]]) -> float:
    """How many pixels a call touches in the mean."""
    total = 0
    for points in shapes[:12]:
        fb.fill(0)
        draw(fb, points)
        total += int((fb.pixels != 0).sum())
    return total / len(shapes[:12])


def run(rounds: int) -> None:
    """Print for each shape and place the time a call, the pixels a call, and the time a pixel."""
    for name, (draw, points, depth) in SHAPES.items():
        print(f"  {name}")
        contests: list[tuple[str, float, Any]] = []
        for place, size, low, high in places():
            fb = Framebuffer(*size, depth)
            shapes = picks(low, high, points)
            names = {"draw": draw, "fb": fb, "shapes": shapes}
            contests.append((place, painted(fb, draw, shapes), Timer("for points in shapes: draw(fb, points)", names)))
        samples: list[list[float]] = [[] for _ in contests]
        for _ in range(min(rounds, 5)):
            for k, (_, _, timer) in enumerate(contests):
                samples[k].append(timer.sample() / len(shapes))
        for (place, pixels, _), seconds in zip(contests, samples, strict=True):
            cost = median(seconds)
            each = f"{1e9 * cost / pixels:8.2f} ns a pixel" if pixels else ""
            print(f"    {place:<42}{1e6 * cost:10.2f} us {pixels:12.1f} pixels {each}", flush=True)
