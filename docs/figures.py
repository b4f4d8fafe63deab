"""The figures of algorithms.md, drawn by paneldraw itself.

A figure is a stack of framebuffers of 256 levels. Each has a color, and its levels say how much of the color covers
what lies below. ``python docs/make_pictures.py`` writes them to docs/figures/.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path

import numpy as np
import plain_loops
from numpy.typing import NDArray
from PIL import Image

from paneldraw import Font, Framebuffer, Supersample

FOLDER = Path(__file__).with_name("figures")

Color = tuple[int, int, int]
Point = tuple[float, float]

PAPER = (16, 22, 30)
GRID = (58, 68, 80)
DIM = (120, 132, 146)
INK = (232, 238, 244)
AMBER = (255, 178, 64)
CYAN = (88, 200, 250)
ROSE = (255, 122, 140)

SMALL = Font.builtin().scaled(2)
LARGE = Font.builtin().scaled(3)


class Figure:
    """Layers, each a framebuffer with the color of its highest level."""

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._layers: list[tuple[Color, Framebuffer]] = []

    def layer(self, color: Color) -> Framebuffer:
        """Return a new layer above all others. What is drawn on it need not be done before the next one is made."""
        fb = Framebuffer(self.width, self.height, depth=8)
        fb.antialias = Supersample(8)
        self._layers.append((color, fb))
        return fb

    def image(self) -> Image.Image:
        picture = np.full((self.height, self.width, 3), PAPER, np.int32)
        for color, fb in self._layers:
            cover = fb.pixels[:, :, None].astype(np.int32)
            picture = (picture * (255 - cover) + np.array(color) * cover + 127) // 255
        return Image.fromarray(picture.astype(np.uint8))

    def text(self, s: str, x: float, y: float, color: Color = INK, anchor: str = "mm", font: Font = SMALL) -> None:
        self.layer(color).text(s, x, y, font=font, anchor=anchor)


class Grid:
    """A place on a figure where pixels are drawn large: pixel (x, y) is a square of `size` around its center."""

    def __init__(self, figure: Figure, left: float, top: float, size: float, columns: range, rows: range) -> None:
        self.figure, self.left, self.top, self.size = figure, left, top, size
        self.columns, self.rows = columns, rows

    def at(self, x: float, y: float) -> Point:
        """Return where the point (x, y) of the drawing is on the figure."""
        return (
            self.left + (x - self.columns.start + 0.5) * self.size - 0.5,
            self.top + (y - self.rows.start + 0.5) * self.size - 0.5,
        )

    def lines(self, fb: Framebuffer, n: int = 1, c: int = 255, width: float = 1) -> None:
        """Draw the borders of pixels, or of sub-pixels, n x n a pixel."""
        x1, y1 = self.at(self.columns.start - 0.5, self.rows.start - 0.5)
        x2, y2 = self.at(self.columns.stop - 0.5, self.rows.stop - 0.5)
        for i in range(n * len(self.columns) + 1):
            x = x1 + i * self.size / n
            fb.line(x, y1, x, y2, c, width=width)
        for j in range(n * len(self.rows) + 1):
            y = y1 + j * self.size / n
            fb.line(x1, y, x2, y, c, width=width)

    def cell(self, fb: Framebuffer, x: float, y: float, c: int, gap: float = 0.0) -> None:
        """Fill a pixel."""
        half = 0.5 - gap
        self.poly(fb, [(x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half)], c)

    def poly(self, fb: Framebuffer, corners: Iterable[Point], c: int) -> None:
        fb.poly(0, 0, [self.at(*corner) for corner in corners], c, fill=True)

    def path(
        self, fb: Framebuffer, points: Iterable[Point], c: int = 255, width: float = 2, closed: bool = False
    ) -> None:
        fb.polyline([self.at(*point) for point in points], c, width=width, closed=closed, cap="butt")

    def dot(self, fb: Framebuffer, x: float, y: float, r: float, c: int = 255) -> None:
        fb.circle(*self.at(x, y), r, c, fill=True)

    def ring(self, fb: Framebuffer, x: float, y: float, r: float, c: int = 255, width: float = 1.5) -> None:
        fb.circle(*self.at(x, y), r, c, width=width)

    def text(self, s: str, x: float, y: float, color: Color = INK, anchor: str = "mm", font: Font = SMALL) -> None:
        self.figure.text(s, *self.at(x, y), color, anchor, font)


def arrow(fb: Framebuffer, x1: float, y1: float, x2: float, y2: float, c: int = 255, width: float = 2) -> None:
    length = math.hypot(x2 - x1, y2 - y1)
    x, y = (x2 - x1) / length, (y2 - y1) / length
    fb.line(x1, y1, x2 - 8 * x, y2 - 8 * y, c, width=width, cap="butt")
    fb.poly(0, 0, [(x2, y2), (x2 - 12 * x + 5 * y, y2 - 12 * y - 5 * x), (x2 - 12 * x - 5 * y, y2 - 12 * y + 5 * x)], c,
            fill=True)


def rectangle(line: plain_loops.Line) -> list[Point]:
    """Return the corners of a thick line."""
    x1, y1, x2, y2, width = line
    length = math.hypot(x2 - x1, y2 - y1)
    a, b = (x2 - x1) / length * width / 2, (y2 - y1) / length * width / 2
    return [(x1 + b, y1 - a), (x2 + b, y2 - a), (x2 - b, y2 + a), (x1 - b, y1 + a)]


# -- The plain loops


def bresenham() -> Image.Image:
    """The example line, the midpoints at which it is decided, and the decision parameter below each column."""
    x1, y1, x2, y2 = 2, 1, 13, 8
    dx, dy = x2 - x1, y2 - y1
    figure = Figure(816, 560)
    grid = Grid(figure, 96, 24, 56, range(x1, x2 + 1), range(y1, y2 + 1))
    lit, lines, legend, ideal, stay, move = (figure.layer(color) for color in (AMBER, GRID, PAPER, INK, CYAN, ROSE))
    grid.lines(lines)
    for x, y in plain_loops.bresenham(x1, y1, x2, y2):
        grid.cell(lit, x, y, 120, 1 / 56)
        grid.dot(ideal, x, y, 3)
        grid.text(str(x), x, y2 + 0.85, DIM)
        p = 2 * dy * (x - x1 + 1) - dx * (2 * (y - y1) + 1)
        if x < x2:
            grid.dot(stay if p < 0 else move, x + 1, y + 0.5, 6)
            grid.text(str(p), x, y2 + 1.4, CYAN if p < 0 else ROSE)
    for y in grid.rows:
        grid.text(str(y), x1 - 0.85, y, DIM)
    grid.path(ideal, [(x1, y1), (x2, y2)], width=3)
    grid.text("x", x1 - 0.85, y2 + 0.85, DIM)
    grid.text("p", x1 - 0.85, y2 + 1.4, DIM)
    grid.poly(legend, [(8.52, 0), (14, 0), (14, 2.48), (8.52, 2.48)], 255)
    grid.dot(stay, 9.0, 1.0, 6)
    grid.text("p < 0: stay", 9.3, 1.0, CYAN, "lm")
    grid.dot(move, 9.0, 1.75, 6)
    grid.text("p >= 0: next row", 9.3, 1.75, ROSE, "lm")
    return figure.image()


def circle() -> Image.Image:
    """An octant of the circle of radius 8 with its midpoints, and its mirror image."""
    r = 8
    figure = Figure(816, 512)
    grid = Grid(figure, 24, 24, 50, range(9), range(-8, 1))
    lit, lines, ideal, stay, move = (figure.layer(color) for color in (AMBER, GRID, INK, CYAN, ROSE))
    grid.lines(lines)
    arc = [(r * math.sin(math.radians(a)), -r * math.cos(math.radians(a))) for a in range(0, 91, 2)]
    grid.path(ideal, arc, width=3)
    grid.figure.layer(DIM).line(*grid.at(0, 0), *grid.at(6.3, -6.3), width=2, dash=(8, 6), cap="butt")
    x, y, p = 0, r, 1 - r
    left, top = 512, 52
    for k, head in enumerate(("(x, y)", "p", "")):
        figure.text(head, left + (0, 108, 140)[k], top, DIM, ("lm", "rm", "lm")[k])
    k = 0
    while x <= y:
        grid.cell(lit, x, -y, 150, 1 / 50)
        if x != y:
            grid.cell(lit, y, -x, 60, 1 / 50)
        inner = p < 0
        grid.dot(stay if inner else move, x + 1, -y + 0.5, 6)
        k += 1
        figure.text(f"({x}, {y})", left, top + 32 * k, INK, "lm")
        color = CYAN if inner else ROSE
        figure.text(str(p), left + 124, top + 32 * k, color, "rm")
        figure.text("inside: stay" if inner else "next row", left + 140, top + 32 * k, color, "lm")
        x += 1
        if inner:
            p += 2 * x + 1
        else:
            y -= 1
            p += 2 * x + 1 - 2 * y
    return figure.image()


def thick_line() -> Image.Image:
    """The rectangle of a line of width 3, the four half-planes that meet in it, and the pixel centers inside."""
    line = (2, 2, 10, 8, 3)
    figure = Figure(784, 664)
    grid = Grid(figure, 28, 24, 56, range(13), range(11))
    lit, area, lines, edges, axes, within, outside = (
        figure.layer(color) for color in (AMBER, AMBER, GRID, AMBER, CYAN, INK, DIM)
    )
    grid.lines(lines)
    corners = rectangle(line)
    grid.poly(area, corners, 50)
    grid.path(edges, corners, width=3, closed=True)
    for y in grid.rows:
        for x in grid.columns:
            if plain_loops.inside(x, y, line):
                grid.cell(lit, x, y, 110, 1 / 56)
                grid.dot(within, x, y, 5)
            elif plain_loops.inside(x, y, (0.8, 1.1, 11.2, 8.9, 5.6)):
                grid.ring(outside, x, y, 4.5)
    arrow(axes, *grid.at(2, 2), *grid.at(10, 8), width=3)
    arrow(axes, *grid.at(2, 2), *grid.at(2 - 0.9, 2 + 1.2), width=3)
    grid.text("u", 10.3, 7.7, CYAN)
    grid.text("v", 0.6, 2.9, CYAN)
    grid.text("u >= 0", 0.85, 0.75, AMBER)
    grid.text("u <= length", 10.9, 9.5, AMBER)
    grid.text("v >= -width / 2", 9, 2, AMBER)
    grid.text("v <= width / 2", 3, 8, AMBER)
    return figure.image()


# -- Reference points and spans


def subpixels() -> Image.Image:
    """Sub-pixels, 4 x 4 a pixel, their reference points in a line and outside, and what is counted."""
    line, n = (-0.2, 0.1, 3.4, 1.7, 1.2), 4
    figure = Figure(848, 432)
    grid = Grid(figure, 24, 24, 128, range(4), range(3))
    area, fine, lines, edges, within, outside = (
        figure.layer(color) for color in (AMBER, GRID, DIM, AMBER, INK, DIM)
    )
    grid.poly(area, rectangle(line), 90)
    grid.lines(fine, n)
    grid.lines(lines, width=2)
    grid.path(edges, rectangle(line), width=3, closed=True)
    for y in range(3 * n):
        for x in range(4 * n):
            point = (x + 0.5) / n - 0.5, (y + 0.5) / n - 0.5
            if plain_loops.inside(*point, line):
                grid.dot(within, *point, 5)
            else:
                grid.ring(outside, *point, 4, 255)
    levels = Grid(figure, 568, 88, 64, range(4), range(3))
    lit, borders = figure.layer(AMBER), figure.layer(GRID)
    for y in range(3):
        for x in range(4):
            share = plain_loops.supersampled(x, y, line, n)
            levels.cell(lit, x, y, round(255 * share))
            levels.text(str(round(share * n * n)), x, y, PAPER if share > 0.4 else INK)
    levels.lines(borders)
    figure.text("counts of 16", 568 + 128, 62, INK)
    return figure.image()


def half_open() -> Image.Image:
    """Two polygons that share an edge, and which of them the pixel centers belong to."""
    figure = Figure(784, 520)
    grid = Grid(figure, 28, 24, 56, range(13), range(7))
    polygons = [[(1, 1), (4, 1), (8, 5), (1, 5)], [(4, 1), (11, 1), (11, 5), (8, 5)]]
    lines, *areas = (figure.layer(color) for color in (GRID, CYAN, AMBER))
    grid.lines(lines)
    dots, rings = [figure.layer(color) for color in (CYAN, AMBER)], figure.layer(DIM)
    owners = []
    for corners in polygons:
        fb = Framebuffer(13, 7)
        fb.poly(0, 0, corners, fill=True, antialias=Supersample(1))
        owners.append(fb.pixels)
    for corners, area in zip(polygons, areas, strict=True):
        grid.poly(area, corners, 70)
        grid.path(area, corners, 255, 3, closed=True)
    for y in grid.rows:
        for x in grid.columns:
            for fb, of in zip(dots, owners, strict=True):
                if of[y, x]:
                    grid.dot(fb, x, y, 9)
            if not (owners[0][y, x] or owners[1][y, x]):
                grid.ring(rings, x, y, 5)
    return figure.image()


FIGURES: dict[str, Callable[[], Image.Image]] = {
    "bresenham": bresenham, "circle": circle, "thick_line": thick_line,
    "subpixels": subpixels, "half_open": half_open,
}


if __name__ == "__main__":
    import sys

    for name in sys.argv[1:] or FIGURES:
        FIGURES[name]().save(FOLDER / f"{name}.png", optimize=True)
