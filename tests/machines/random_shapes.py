"""Random shapes of all kinds, hashed: what every machine has to agree on.

Run as a script it prints a line a group: a hash of the pictures, then the group's name, which is the kind of shape,
the framebuffer's depth and the anti-aliasing. Every group has its own stream of random numbers, so the
same group draws the same shapes whatever else is drawn. Needs nothing but the package and what it needs.
"""

from __future__ import annotations

import hashlib
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from random import Random
from typing import Any

from paneldraw import ConeFilter, Framebuffer, Gradient, Pattern, Supersample

WIDTH, HEIGHT = 61, 37
DEPTHS = (1, 2, 4, 8)
OPS = ("over", "xor", "add", "max", "clear")
#: How far out coordinates lie, in pixels, and how often of a hundred.
REACHES = ((40.0, 60), (300.0, 20), (1e5, 10), (1e9, 5), (1e15, 5))
SMOOTH: tuple[Supersample | ConeFilter, ...] = (
    *(Supersample(n, reference) for reference in ("center", "corner") for n in range(1, 17)),
    *(ConeFilter(radius, name) for name in ("cone", "box", "gaussian") for radius in (0.5, 1.0, 1.625, 4.0)),
    ConeFilter(1.0, "cone", 8),
)


class Dice(Random):
    """Random numbers made of `Random.random` alone, which no version of Python changes."""

    def below(self, n: int) -> int:
        """Return a whole number from 0 to n - 1."""
        return int(self.random() * n)

    def one_of(self, *things: Any) -> Any:
        """Return one of them."""
        return things[self.below(len(things))]

    def within(self, least: float, most: float) -> float:
        """Return a number between the two: of an even grid, of a fine one, or any."""
        number = least + (most - least) * self.random()
        return self.one_of(float(round(number)), round(number * 2) / 2, round(number * 256) / 256, number)

    def reach(self) -> float:
        """Return how far out the next shape may lie."""
        at = self.below(100)
        for reach, share in REACHES:
            at -= share
            if at < 0:
                return reach
        raise AssertionError("the shares make a hundred")

    def points(self, count: int) -> list[tuple[float, float]]:
        """Return points of one reach around the middle of the framebuffer, or around where 32 bits take that for it."""
        reach = self.reach()
        x = WIDTH // 2 + self.one_of(*[0] * 20, 2**32, -(2**32))
        y = HEIGHT // 2 + self.one_of(*[0] * 20, 2**32, -(2**32))
        return [(x + self.within(-reach, reach), y + self.within(-reach, reach)) for _ in range(count)]

    def size(self) -> float:
        """Return a radius or the side of a rectangle, rarely a large one."""
        return self.within(0, self.one_of(2, 12, 12, 40, 40, self.reach()))

    def width(self) -> float:
        """Return the width of a line, mostly 1."""
        return self.one_of(1, 1, 0.25 + self.within(0, 3), self.within(1, 12))

    def dash(self) -> list[float] | None:
        """Return lengths of dashes and gaps, or none of them."""
        return self.one_of(None, None, [self.within(1, 6) for _ in range(2 + 2 * self.below(2))])


def line(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    (x1, y1), (x2, y2) = dice.points(2)
    extra = {"algorithm": dice.one_of("bresenham", "dda")}
    if style["antialias"] is not None:
        extra = {"width": dice.width(), "cap": dice.one_of("square", "butt", "round"), "dash": dice.dash()}
    fb.line(x1, y1, x2, y2, c, **extra, **style)


def thick_line(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    (x1, y1), (x2, y2) = dice.points(2)
    cap = dice.one_of("square", "butt", "round")
    fb.line(x1, y1, x2, y2, c, width=dice.within(1, 15), cap=cap, dash=dice.dash(), **style)


def lines(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    rows = [(*a, *b) for a, b in (dice.points(2) for _ in range(3))]
    fb.lines(rows, c, width=dice.width(), **style)


def polyline(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    join = dice.one_of("miter", "round", "bevel")
    cap = dice.one_of("square", "butt", "round")
    path = dice.points(2 + dice.below(4))
    closed = bool(dice.below(2))
    fb.polyline(path, c, closed=closed, width=dice.width(), cap=cap, join=join, dash=dice.dash(), **style)


def rect(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    ((x, y),) = dice.points(1)
    fb.rect(x, y, dice.size(), dice.size(), c, bool(dice.below(2)), width=dice.width(), **style)


def round_rect(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    ((x, y),) = dice.points(1)
    fb.round_rect(x, y, dice.size(), dice.size(), dice.size(), c, bool(dice.below(2)), width=dice.width(), **style)


def circle(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    ((x, y),) = dice.points(1)
    fb.circle(x, y, dice.size(), c, bool(dice.below(2)), width=dice.width(), **style)


def ellipse(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    ((x, y),) = dice.points(1)
    quadrants = dice.one_of(15, 15, dice.below(16))
    fb.ellipse(x, y, dice.size(), dice.size(), c, bool(dice.below(2)), quadrants, width=dice.width(), **style)


def arc(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    ((x, y),) = dice.points(1)
    fb.arc(x, y, dice.size(), dice.within(-360, 720), dice.within(-360, 720), c, width=dice.width(), **style)


def sector(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    ((x, y),) = dice.points(1)
    start, end = dice.within(-360, 720), dice.within(-360, 720)
    fb.sector(x, y, dice.size(), start, end, c, bool(dice.below(2)), width=dice.width(), **style)


def triangle(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    corners = [number for point in dice.points(3) for number in point]
    fb.triangle(*corners, c, bool(dice.below(2)), width=dice.width(), **style)


def poly(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    corners = dice.points(3 + dice.below(6))
    rule = dice.one_of("even-odd", "nonzero")
    join = dice.one_of("miter", "round", "bevel")
    fill = bool(dice.below(2))
    fb.poly(dice.within(-9, 9), dice.within(-9, 9), corners, c, fill, rule=rule, width=dice.width(), join=join, **style)


def curve(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    extra = {"join": dice.one_of("miter", "round", "bevel"), "fill": bool(dice.below(2)), "width": dice.width()}
    if not extra["fill"]:
        extra |= {"cap": dice.one_of("square", "butt", "round"), "dash": dice.dash()}
        extra |= {"heads": dice.one_of(None, "end", "both"), "head": dice.size()}
    if dice.below(2):
        fb.bezier(dice.points(dice.one_of(3, 4, 7)), c, **extra, **style)
    else:
        fb.curve(dice.points(3 + dice.below(4)), c, **extra, **style)


def arrow(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    (x1, y1), (x2, y2) = dice.points(2)
    heads, head = dice.one_of("start", "end", "both"), dice.one_of(None, dice.size())
    fb.arrow(x1, y1, x2, y2, c, heads=heads, head=head, width=dice.width(), dash=dice.dash(), **style)


def turned(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    """Draw what is turned, of two radii, aligned, or round at some corners."""
    ((x, y),) = dice.points(1)
    w, h, angle, width = dice.size(), dice.size(), dice.within(-360, 360), dice.width()
    fill, align = bool(dice.below(2)), dice.one_of("inside", "center", "outside")
    dice.one_of(
        lambda: fb.rect(x, y, w, h, c, fill, angle=angle, width=width, align=align, **style),
        lambda: fb.ellipse(x, y, w, h, c, fill, angle=angle, width=width, align=align, **style),
        lambda: fb.arc(x, y, w, angle, angle + 100, c, yr=h, width=width, **style),
        lambda: fb.round_rect(x, y, w, h, width, c, fill, corners=dice.below(16), width=width, align=align, **style),
    )()


def painted(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    """Draw with patterns and gradients, and fill an area."""
    ((x, y), (x2, y2)) = dice.points(2)
    paint = dice.one_of(Pattern.bricks.at(x, y), Gradient((x, y), (x2, y2)), Gradient.radial((x, y), 1 + dice.size()))
    fb.ellipse(30, 18, dice.size(), dice.size(), paint, bool(dice.below(2)), width=dice.width(), **style)
    fb.flood_fill(dice.within(0, 60), dice.within(0, 36), dice.one_of(c, paint), op=style["op"])


def small(fb: Framebuffer, dice: Dice, c: int, style: dict[str, Any]) -> None:
    """Draw what knows no anti-aliasing: pixels, straight runs, text, and pixels that are moved."""
    op = style["op"]
    ((x, y), (x2, y2)) = dice.points(2)
    fb.points([(x, y), (x2, y2), *dice.points(2)], c, op=op)
    fb.pixel(x, y, c, op=op)
    fb.hline(x, y2, dice.size(), c, op=op)
    fb.vline(x2, y, dice.size(), c, op=op)
    fb.text("Ag!", *dice.points(1)[0], c, op=op)
    fb.scroll(dice.below(7) - 3, dice.below(7) - 3)
    fb.blit(fb.pixels[5:20, 9:40].copy(), *dice.points(1)[0], key=dice.one_of(-1, 0))


Draw = Callable[[Framebuffer, Dice, int, dict[str, Any]], None]
KINDS: tuple[Draw, ...] = (
    line,
    thick_line,
    lines,
    polyline,
    rect,
    round_rect,
    circle,
    ellipse,
    arc,
    sector,
    triangle,
    poly,
    curve,
    arrow,
    turned,
    painted,
)


@dataclass(frozen=True)
class Group:
    """Shapes of one kind on framebuffers of one depth, with one kind of anti-aliasing."""

    kind: Draw
    depth: int
    antialias: Supersample | ConeFilter | None

    def __str__(self) -> str:
        return f"{self.kind.__name__}, depth {self.depth}, {self.antialias or 'aliased'}"

    def hash(self, shapes: int) -> str:
        """Return a hash of what the framebuffer holds after each shape, each over what was there."""
        fb = Framebuffer(WIDTH, HEIGHT, depth=self.depth)
        dice = Dice(str(self))
        for y in range(0, HEIGHT, 4):
            fb.pixels[y] = 1 + dice.below(fb.max_level)
        seen = hashlib.sha256()
        for _ in range(shapes):
            style = {"antialias": self.antialias, "op": dice.one_of("over", *OPS)}
            self.kind(fb, dice, dice.one_of(0, *[1 + dice.below(fb.max_level)] * 4), style)
            seen.update(fb.pixels.tobytes())
        return seen.hexdigest()[:16]


def groups() -> Iterator[tuple[Group, int]]:
    """Yield all groups, and how many shapes each draws: with anti-aliasings of 45 kinds, few of each."""
    for depth in DEPTHS:
        yield Group(small, depth, None), 60
        for kind in KINDS:
            yield Group(kind, depth, None), 24
            for antialias in SMOOTH:
                yield Group(kind, depth, antialias), 3


def main() -> None:
    """Print the groups' hashes; every so manieth group only, if a number is given."""
    every = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    for at, (group, shapes) in enumerate(groups()):
        if at % every == 0:
            print(group.hash(shapes), group)


if __name__ == "__main__":
    main()
