"""The figures of algorithms.md, drawn by paneldraw itself.

A figure is a stack of framebuffers of 256 levels. Each has a color, and its levels say how much of the color covers
what lies below. ``python docs/make_pictures.py`` writes them to docs/figures/.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import plain_loops
from PIL import Image

from paneldraw import Font, Framebuffer, Supersample

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
        picture: Any = np.full((self.height, self.width, 3), PAPER, np.int32)
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
    fb.poly(
        0,
        0,
        [(x2, y2), (x2 - 12 * x + 5 * y, y2 - 12 * y - 5 * x), (x2 - 12 * x - 5 * y, y2 - 12 * y + 5 * x)],
        c,
        fill=True,
    )


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
    grid.text("p < 0: stay", 9.4, 1.0, CYAN, "lm")
    grid.dot(move, 9.0, 1.75, 6)
    grid.text("p >= 0: next row", 9.4, 1.75, ROSE, "lm")
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
            elif plain_loops.inside(x, y, (1.12, 1.34, 10.88, 8.66, 5.6)):
                grid.ring(outside, x, y, 4.5)
    arrow(axes, *grid.at(2, 2), *grid.at(10, 8), width=3)
    arrow(axes, *grid.at(2, 2), *grid.at(2 - 0.9, 2 + 1.2), width=3)
    grid.text("u", 10.32, 8.3, CYAN)
    grid.text("v", 0.7, 3.32, CYAN)
    grid.text("u >= 0", 0.5, 0, AMBER)
    grid.text("u <= length", 11.15, 10, AMBER)
    grid.text("v >= -width / 2", 9, 2, AMBER)
    grid.text("v <= width / 2", 3, 8, AMBER)
    return figure.image()


# -- Reference points and spans


def subpixels() -> Image.Image:
    """Sub-pixels, 4 x 4 a pixel, their reference points in a line and outside, and what is counted."""
    line, n = (-0.2, 0.1, 3.2, 1.7, 1), 4
    figure = Figure(848, 432)
    grid = Grid(figure, 24, 24, 128, range(4), range(3))
    area, fine, lines, edges, within, outside = (figure.layer(color) for color in (AMBER, GRID, DIM, AMBER, INK, DIM))
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
            levels.text(str(round(share * n * n)), x, y, PAPER if share > 0.7 else INK)
    levels.lines(borders)
    figure.text("counts of 16", 568 + 128, 62, INK)
    return figure.image()


def half_open() -> Image.Image:
    """Two polygons that share an edge, and which of them the pixel centers belong to."""
    figure = Figure(784, 440)
    grid = Grid(figure, 28, 24, 56, range(13), range(7))
    polygons = [[(1, 1), (4, 1), (8, 5), (1, 5)], [(4, 1), (11, 1), (11, 5), (8, 5)]]
    lines, *areas = (figure.layer(color) for color in (GRID, CYAN, AMBER))
    grid.lines(lines)
    dots, rings = [figure.layer(color) for color in (CYAN, AMBER)], figure.layer(INK)
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
                grid.ring(rings, x, y, 5, 160)
    return figure.image()


N = 4
DISC = 3.4, 3.3, 3.6


def disc_spans() -> list[tuple[int, int, int]]:
    """Return the sub-scanlines of two rows of a disc, each with its span of sub-pixels; an empty one begins at 0."""
    x, y, r = DISC
    found = []
    for k in range(2 * N):
        held = [g for g in range(8 * N) if math.hypot((g + 0.5) / N - 0.5 - x, (k + 0.5) / N - 0.5 - y) <= r]
        found.append((k, held[0], held[-1] + 1) if held else (k, 0, 0))
    return found


def spans() -> Image.Image:
    """Two rows of a disc: the span of each sub-scanline, and what the spans count up to in each pixel."""
    figure = Figure(904, 472)
    grid = Grid(figure, 24, 24, 96, range(8), range(2))
    area, fine, lines, bars, first, end = (figure.layer(color) for color in (AMBER, GRID, DIM, AMBER, INK, INK))
    with area.clip(24, 24, 8 * 96, 2 * 96):
        area.circle(*grid.at(*DISC[:2]), DISC[2] * 96, 80, fill=True)
    grid.lines(fine, N)
    grid.lines(lines, width=2)
    figure.text("sub-pixels", 892, 12, DIM, "rm")
    for k, a, b in disc_spans():
        left, y, right = a / N - 0.5, (k + 0.5) / N - 0.5, b / N - 0.5
        if a == b:
            figure.text("none", 892, grid.at(0, y)[1], DIM, "rm")
            continue
        grid.poly(bars, [(left, y - 0.06), (right, y - 0.06), (right, y + 0.06), (left, y + 0.06)], 255)
        grid.dot(first, left, y, 6)
        grid.ring(end, right, y, 5.5, 255, 2)
        figure.text(f"{a}...{b - 1}", 892, grid.at(0, y)[1], INK, "rm")
    cells = Grid(figure, 24, 256, 96, range(8), range(2))
    lit, borders = figure.layer(AMBER), figure.layer(GRID)
    for y in cells.rows:
        rows = [(a, b) for k, a, b in disc_spans() if k // N == y]
        for x, count in enumerate(plain_loops.counted(rows, N, 8)):
            cells.cell(lit, x, y, round(255 * count / N**2))
            cells.text(str(count), x, y, PAPER if count > 0.7 * N**2 else INK)
    cells.lines(borders)
    figure.text("count", 892, cells.at(0, 0)[1] - 12, DIM, "rm")
    figure.text("of 16", 892, cells.at(0, 0)[1] + 12, DIM, "rm")
    return figure.image()


# -- The cone


def height(x: float, y: float) -> float:
    """The cone of volume 1 over the circle of radius 1."""
    return max(0.0, 3 / math.pi * (1 - math.hypot(x, y)))


def cone_shade(fb: Framebuffer, x: float, y: float, r: float, low: int, high: int) -> None:
    """Paint the cone as seen from above, brighter where it is higher."""
    for k in range(48):
        fb.circle(x, y, r * (1 - k / 48), low + (high - low) * k // 47, fill=True)


class Scene:
    """A cone that stands on the pixels around (0, 0), seen from the front at an angle."""

    def __init__(self, figure: Figure, x: float, y: float, size: float, theta: float) -> None:
        self.figure, self.x, self.y, self.size = figure, x, y, size
        self.along = math.cos(theta), math.sin(theta)

    def at(self, x: float, y: float, z: float = 0.0) -> Point:
        return self.x + self.size * (x - y) * 0.866, self.y + self.size * ((x + y) * 0.5 - 1.85 * z)

    def plane(self, u: float, v: float) -> Point:
        """Return x and y of a point in the line's own frame."""
        a, b = self.along
        return u * a - v * b, u * b + v * a

    def path(self, fb: Framebuffer, points: Sequence[tuple[float, ...]], c: int = 255, width: float = 1.5) -> None:
        fb.polyline([self.at(*point) for point in points], c, width=width, cap="butt", join="round")

    def wall(self, points: Sequence[Point]) -> list[Point]:
        """The outline of a wall that stands over a path on the ground and is as high as the cone."""
        top = [self.at(*p, height(*p)) for p in points]
        return [self.at(*points[0]), *top, self.at(*points[-1])]

    def part(self, u0: float, u1: float, v0: float, v1: float) -> None:
        """Draw the cone's part over u0 ... u1, v0 ... v1."""
        cover, shade = (Framebuffer(self.figure.width, self.figure.height, depth=8) for _ in range(2))
        cover.antialias = shade.antialias = Supersample(8)
        # Beyond the shape's border its shade goes on.
        shade.fill(130)
        steps = 60
        us = [u0 + (u1 - u0) * i / steps for i in range(steps + 1)]
        vs = [v0 + (v1 - v0) * j / steps for j in range(steps + 1)]
        for v in vs:
            cover.poly(0, 0, self.wall([self.plane(u, v) for u in us]), 255, fill=True, op="max")
        for u in us:
            cover.poly(0, 0, self.wall([self.plane(u, v) for v in vs]), 255, fill=True, op="max")
        for i in range(steps):
            for j in range(steps):
                x, y = self.plane((us[i] + us[i + 1]) / 2, (vs[j] + vs[j + 1]) / 2)
                r = math.hypot(x, y)
                bright = 175 + int(80 * (-0.75 * x + 0.25 * y) / max(r, 0.05))
                corners = [self.plane(us[i + a], vs[j + b]) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
                quad = [self.at(*c, height(*c)) for c in corners]
                for fill in False, True:
                    shade.poly(0, 0, quad, min(255, bright), fill=fill, antialias=None)
        shade.poly(0, 0, self.wall([self.plane(u, v1) for u in us]), 150, fill=True)
        shade.poly(0, 0, self.wall([self.plane(u1, v) for v in vs]), 95, fill=True)
        self.figure.layer(PAPER).blit(cover, 0, 0)
        mixed = self.figure.layer(AMBER)
        mixed.pixels[:] = cover.pixels.astype(np.int32) * shade.pixels // 255
        edges = self.figure.layer(AMBER)
        for side in ([self.plane(u, v1) for u in us], [self.plane(u1, v) for v in vs]):
            self.path(edges, [(*p, height(*p)) for p in side if math.hypot(*p) <= 1], 255, 2)


def _runs(
    points: Sequence[tuple[float, ...]], wanted: Callable[[tuple[float, ...]], bool]
) -> Iterable[list[tuple[float, ...]]]:
    run: list[tuple[float, ...]] = []
    for point in points:
        if wanted(point):
            run.append(point)
        elif run:
            yield run
            run = []
    if run:
        yield run


def _cone_scene(figure: Figure, left: float, theta: float, u1: float, v0: float, v1: float) -> None:
    scene = Scene(figure, left, 206, 84, theta)
    ground, pixel, road, back, glass = (figure.layer(color) for color in (GRID, DIM, AMBER, DIM, CYAN))
    for k in range(4):
        scene.path(ground, [(-1.5, k - 1.5), (1.5, k - 1.5)])
        scene.path(ground, [(k - 1.5, -1.5), (k - 1.5, 1.5)])
    scene.path(pixel, [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5)], 255, 2)
    reach = 1.75
    corners = [scene.plane(*c) for c in ((-reach, v0), (min(u1, reach), v0), (min(u1, reach), v1), (-reach, v1))]
    road.poly(0, 0, [scene.at(*c) for c in corners], 70, fill=True)
    rim = [(math.cos(math.radians(a)), math.sin(math.radians(a))) for a in range(0, 361, 3)]
    apex = scene.at(0, 0, height(0, 0))
    for i in range(0, 120, 2):
        corners = [rim[i], rim[(i + 20) % 120], rim[(i + 40) % 120]]
        glass.poly(0, 0, [apex, *(scene.at(*c) for c in corners)], 28, fill=True, op="max")
    paths: list[list[tuple[float, ...]]] = []
    for r in (1, 0.75, 0.5, 0.25):
        paths.append([(r * x, r * y, height(r * x, r * y)) for x, y in rim])
    for x, y in rim[:-1:10]:
        paths.append([(t / 20 * x, t / 20 * y, height(t / 20 * x, t / 20 * y)) for t in range(21)])
    for path in paths:
        scene.path(back, path, 150, 1.2)

    def in_front(point: tuple[float, ...]) -> bool:
        x, y = point[:2]
        a, b = scene.along
        return b * -x + a * y >= v1 or a * x + b * y >= u1

    scene.part(-1.0, min(u1, 1.0), v0, v1)
    front = figure.layer(DIM)
    for path in paths:
        for run in _runs(path, in_front):
            if len(run) > 1:
                scene.path(front, run, 150, 1.2)


def cone() -> Image.Image:
    """The cone over a pixel, and its part above a line: in the line's middle, and at its end."""
    figure = Figure(904, 396)
    theta = math.atan2(2, 7)
    v0, v1 = -0.35, 0.65
    for left, u1, title in ((226, 9.0, "in its middle"), (678, 0.3, "at its end")):
        _cone_scene(figure, left, theta, u1, v0, v1)
        u, v = u1, -(v0 + v1) / 2
        a, b = math.cos(theta), math.sin(theta)
        line = ((u - 20) * a + v * b, (u - 20) * b - v * a, u * a + v * b, u * b - v * a, v1 - v0)
        share = plain_loops.cone_filtered(0, 0, line)
        figure.text(f"{title}: {share:.2f}", left, 370)
    return figure.image()


def volume(u: float, v: float) -> float:
    """The cone's volume over the quadrant that ends at (u, v), added up on a fine grid."""
    middles = (np.arange(1000) + 0.5) / 500 - 1
    heights = np.maximum(0, 3 / math.pi * (1 - np.hypot(middles[:, None], middles)))
    return float(heights[np.ix_(middles < v, middles < u)].sum()) / 500**2


def look_ups() -> Image.Image:
    """The volume above a rectangle as four quadrants' volumes, added and taken away."""
    figure = Figure(904, 264)
    u0, u1, v0, v1 = -0.44, 0.68, -0.3, 0.56
    r, y = 68, 134
    quadrants = [("C(u1,v1)", u1, v1), ("C(u0,v1)", u0, v1), ("C(u1,v0)", u1, v0), ("C(u0,v0)", u0, v0)]
    circles, whole, part, box, dot = (figure.layer(color) for color in (GRID, DIM, AMBER, INK, INK))
    total = 0.0
    for k in range(5):
        x = 84 + 184 * k
        cone_shade(whole, x, y, r, 30, 130)
        circles.circle(x, y, r, 255, width=2)
        if k < 4:
            name, u, v = quadrants[k]
            window = (x - r - 2, y - r - 2, round(r + 2 + r * u), round(r + 2 + r * v))
        else:
            name, u, v = "volume", 0.0, 0.0
            window = (round(x + r * u0), round(y + r * v0), round(r * (u1 - u0)), round(r * (v1 - v0)))
        with part.clip(*window):
            cone_shade(part, x, y, r, 110, 255)
        corners = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]
        box.poly(0, 0, [(x + r * a, y + r * b) for a, b in corners], 255, width=1.5)
        figure.text(name, x, 32, AMBER)
        if k < 4:
            dot.circle(x + r * u, y + r * v, 5, fill=True)
            sign = (1, -1, -1, 1)[k]
            share = volume(u, v)
            total += sign * share
        else:
            share = total
        figure.text(f"{share:.3f}", x, 236)
        if k:
            figure.text("--+="[k - 1], x - 92, y, INK, font=LARGE)
    return figure.image()


def weights() -> Image.Image:
    """A sub-scanline through a pixel's circle of influence, and the table by which a span's ends are weighed."""
    figure = Figure(816, 600)
    size, a, b, y = 132.0, -0.55, 0.4, 0.3125
    grid = Grid(figure, 24, 24, size, range(-1, 2), range(-1, 2))
    shade, fine, lines, ring, bar, first, end, guides = (
        figure.layer(color) for color in (DIM, GRID, DIM, INK, AMBER, INK, INK, DIM)
    )
    cone_shade(shade, *grid.at(0, 0), size, 25, 120)
    for k in range(25):
        fine.line(*grid.at(-1.5, -1.5 + k / 8), *grid.at(1.5, -1.5 + k / 8), 200)
    grid.lines(lines, width=2)
    grid.ring(ring, 0, 0, size, 255, 2)
    grid.poly(bar, [(a, y - 0.05), (b, y - 0.05), (b, y + 0.05), (a, y + 0.05)], 255)
    grid.dot(first, a, y, 6)
    grid.ring(end, b, y, 5.5, 255, 2)
    chord = np.array([height((k + 0.5) / 256, y) for k in range(-384, 384)]) / 256
    left = np.concatenate([[0], chord.cumsum()])
    base, tall = 572, 124
    curve = [(grid.at(-1.5 + k / 256, 0)[0], base - tall * left[k] / left[-1]) for k in range(0, 769, 8)]
    table, axis = figure.layer(CYAN), figure.layer(GRID)
    axis.line(grid.at(-1.5, 0)[0], base, grid.at(1.5, 0)[0], base, width=2)
    table.polyline(curve, width=3, join="round")
    marks = []
    for x in (a, b):
        px, py = grid.at(x, y)
        share = left[round((x + 1.5) * 256)] / left[-1]
        marks.append(base - tall * share)
        guides.line(px, py + 8, px, marks[-1], width=1.5, dash=(6, 5), cap="butt")
        guides.line(px, marks[-1], 466, marks[-1], width=1.5, dash=(6, 5), cap="butt")
        figure.layer(CYAN).circle(px, marks[-1], 6, fill=True)
    bracket = figure.layer(AMBER)
    bracket.line(478, marks[0], 478, marks[1], width=5, cap="butt")
    figure.text("W(b) - W(a)", 494, (marks[0] + marks[1]) / 2, AMBER, "lm")
    figure.text("W(b)", 494, marks[1], CYAN, "lm")
    figure.text("W(a)", 494, marks[0], CYAN, "lm")
    tx = 452
    figure.text("the pixel's circle,", tx, 60, INK, "lm")
    figure.text("the cone from above", tx, 84, INK, "lm")
    py = grid.at(0, y)[1]
    figure.text("a span a...b", tx, py - 12, AMBER, "lm")
    figure.text("of a sub-scanline", tx, py + 12, AMBER, "lm")
    figure.text("its table W(x):", tx, 384, CYAN, "lm")
    figure.text("the volume left of x", tx, 408, CYAN, "lm")
    return figure.image()


def pictures() -> dict[str, Callable[[], Image.Image]]:
    """What draws each figure, by its file name."""
    drawn = (bresenham, circle, thick_line, half_open, subpixels, spans, cone, look_ups, weights)
    return {f"figures/{draw.__name__}.png": draw for draw in drawn}
