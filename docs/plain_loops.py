"""The plain loops that algorithms.md begins with: the textbook's algorithms, said as shortly as they can be.

They need nothing of paneldraw, and paneldraw uses none of them; tests hold its drawing calls to them.
``python docs/plain_loops.py`` draws a line with each.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from fractions import Fraction
from math import ceil, floor, hypot, pi

Pixel = tuple[int, int]
Loop = Callable[[int, int, int, int], Iterator[Pixel]]
Line = tuple[float, float, float, float, float]


def dda(x1: int, y1: int, x2: int, y2: int) -> Iterator[Pixel]:
    m = (y2 - y1) / (x2 - x1)
    y = float(y1)
    for x in range(x1, x2 + 1):
        yield x, floor(y + 0.5)
        y += m


def bresenham(x1: int, y1: int, x2: int, y2: int) -> Iterator[Pixel]:
    dx, dy = x2 - x1, y2 - y1
    p = 2 * dy - dx
    y = y1
    for x in range(x1, x2 + 1):
        yield x, y
        if p < 0:
            p += 2 * dy
        else:
            y += 1
            p += 2 * dy - 2 * dx


def any_direction(loop: Loop, x1: int, y1: int, x2: int, y2: int) -> list[Pixel]:
    if abs(y2 - y1) > abs(x2 - x1):
        return [(x, y) for y, x in any_direction(loop, y1, x1, y2, x2)]
    if x1 > x2:
        return any_direction(loop, x2, y2, x1, y1)
    if y1 > y2:
        return [(x, -y) for x, y in any_direction(loop, x1, -y1, x2, -y2)]
    return list(loop(x1, y1, x2, y2))


def circle(xc: int, yc: int, r: int) -> set[Pixel]:
    pixels = set()
    x, y = 0, r
    p = 1 - r
    while x <= y:
        for a, b in (x, y), (y, x):
            pixels |= {(xc + a, yc + b), (xc - a, yc + b), (xc + a, yc - b), (xc - a, yc - b)}
        x += 1
        if p < 0:
            p += 2 * x + 1
        else:
            y -= 1
            p += 2 * x + 1 - 2 * y
    return pixels


def inside(x: float, y: float, line: Line) -> bool:
    x1, y1, x2, y2, width = line
    x, y = x + 1e-7, y + 1e-10
    dx, dy = x2 - x1, y2 - y1
    length = hypot(dx, dy)
    u = (dx * (x - x1) + dy * (y - y1)) / length
    v = (dx * (y - y1) - dy * (x - x1)) / length
    return 0 <= u <= length and -width / 2 <= v <= width / 2


def thick_line(line: Line, columns: int, rows: int) -> list[Pixel]:
    return [(x, y) for y in range(rows) for x in range(columns) if inside(x, y, line)]


def supersampled(x: int, y: int, line: Line, n: int) -> float:
    count = 0
    for j in range(n):
        for i in range(n):
            if inside(x - 0.5 + (i + 0.5) / n, y - 0.5 + (j + 0.5) / n, line):
                count += 1
    return count / n**2


def cone_filtered(x: int, y: int, line: Line, n: int = 64) -> float:
    volume = 0.0
    for j in range(-n, n):
        for i in range(-n, n):
            a, b = (i + 0.5) / n, (j + 0.5) / n
            height = 3 / pi * (1 - hypot(a, b))
            if height > 0 and inside(x + a, y + b, line):
                volume += height / n**2
    return volume


def polygon(corners: list[Pixel]) -> list[Pixel]:
    pixels = []
    edges = list(zip(corners, corners[1:] + corners[:1], strict=True))
    for y in range(min(y for _, y in corners), max(y for _, y in corners)):
        crossings = sorted(
            x1 + Fraction((y - y1) * (x2 - x1), y2 - y1)
            for (x1, y1), (x2, y2) in edges
            if min(y1, y2) <= y < max(y1, y2)
        )
        for left, right in zip(crossings[::2], crossings[1::2], strict=True):
            pixels += [(x, y) for x in range(ceil(left), ceil(right))]
    return pixels


def counted(spans: Iterable[tuple[int, int]], n: int, columns: int) -> list[int]:
    changes = [0] * (columns + 2)
    for first, end in spans:
        for g, sign in (first, 1), (end, -1):
            x, part = divmod(g, n)
            changes[x] += sign * (n - part)
            changes[x + 1] += sign * part
    counts = []
    count = 0
    for change in changes[:columns]:
        count += change
        counts.append(count)
    return counts


def show(title: str, level: Callable[[int, int], float]) -> None:
    """Print 16 x 10 pixels, whose levels are from 0 to 1."""
    print(title)
    for y in range(10):
        print("  " + "".join(".:-=+*%#@"[round(8 * level(x, y))] for x in range(16)))


def lit(pixels: Iterable[Pixel]) -> Callable[[int, int], float]:
    """Return the level of a pixel, 1 or 0."""
    pixels = set(pixels)
    return lambda x, y: float((x, y) in pixels)


def main() -> None:
    line = (2.0, 1.0, 13.0, 8.0, 3.0)
    show("DDA", lit(dda(2, 1, 13, 8)))
    show("Bresenham's line", lit(bresenham(2, 1, 13, 8)))
    show("Midpoint circle", lit(circle(7, 4, 4)))
    show("Thick line", lit(thick_line(line, 16, 10)))
    show("Polygon", lit(polygon([(2, 1), (13, 4), (6, 9)])))
    show("Supersampling", lambda x, y: supersampled(x, y, line, 4))
    show("Cone filter", lambda x, y: cone_filtered(x, y, line, 16))


if __name__ == "__main__":
    main()
