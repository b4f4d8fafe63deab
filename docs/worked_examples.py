"""The excerpts and tables of algorithms.md.

An excerpt follows a link to its function; of the function it shows the lines from its own first line to its own last
one. A table stands between ``<!-- NAME -->`` and ``<!-- end -->``, and the function NAME makes it: it runs the raster
modules uncompiled and notes what their variables hold.
"""

from __future__ import annotations

import ast
import importlib
import inspect
import math
import re
import sys
import textwrap
from collections.abc import Callable, Iterable
from fractions import Fraction
from functools import cache, partial
from pathlib import Path
from types import FrameType
from typing import Any

from paneldraw._compiled import MODULES
from paneldraw._interpreted import load_sources
from paneldraw.controllers import SSD1306
from paneldraw.transports import COMMAND, DATA, Cost

PAGE = Path(__file__).with_name("algorithms.md")
ROOT = PAGE.parent.parent

_EXCERPT = re.compile(
    r"(?P<head>^\[`(?P<name>[\w.]+)`\]\(\.\./(?P<file>[\w/.]+)\).*\n(?:.+\n)*\n```python\n)(?P<code>(?s:.*?))(?=^```$)",
    re.M,
)
_TABLE = re.compile(r"(?P<head>^<!-- (?P<name>(?!end)\w+) -->\n)(?s:.*?)(?=^<!-- end -->$)", re.M)


def page(text: str) -> str:
    """Return the page with its excerpts and tables as the code has them."""
    text = _EXCERPT.sub(lambda found: found["head"] + excerpt(found["file"], found["name"], found["code"]), text)
    return _TABLE.sub(lambda found: found["head"] + globals()[found["name"]]() + "\n", text)


def excerpt(file: str, name: str, shown: str) -> str:
    """Return the lines of a function, or a class's method, from the first line of `shown` to its last one."""
    source = (ROOT / file).read_text(encoding="utf-8")
    node: Any = ast.parse(source)
    for part in name.split("."):
        node = next(child for child in node.body if getattr(child, "name", "") == part)
    lines = textwrap.dedent("\n".join(source.splitlines()[node.lineno - 1 : node.end_lineno])).splitlines()
    wanted = [line.strip() for line in shown.strip().splitlines()]
    stripped = [line.strip() for line in lines]
    try:
        start = stripped.index(wanted[0])
        end = stripped.index(wanted[-1], start)
    except ValueError:
        raise ValueError(
            f"{name} in {file} has no lines from {wanted[0]!r} to {wanted[-1]!r}; name others in {PAGE.name}"
        ) from None
    return textwrap.dedent("\n".join(lines[start : end + 1])) + "\n"


# -- The raster modules at work


@cache
def plain() -> dict[str, Any]:
    """The modules that are compiled otherwise, as plain Python, by the last part of their names in raster."""
    for name in MODULES:
        importlib.import_module(name)
    compiled = {name: sys.modules.pop(name) for name in MODULES}
    try:
        load_sources()
        loaded = {name: sys.modules[name] for name in MODULES}
    finally:
        for name, module in compiled.items():
            sys.modules[name] = module
            setattr(importlib.import_module(name.rpartition(".")[0]), name.rpartition(".")[2], module)
    raster = {name.rpartition(".")[2]: module for name, module in loaded.items() if ".raster." in name}
    return raster | {
        "Framebuffer": loaded["paneldraw.framebuffer.framebuffer"].Framebuffer,
        "Planner": loaded["paneldraw.update.planner"].Planner,
    }


def watch(
    function: Any, line: str, run: Callable[[], object], look: Callable[[dict[str, Any]], Any] = dict
) -> list[Any]:
    """Call `run`, and `look` at the variables of an uncompiled function whenever it comes to a line of this text."""
    source, first = inspect.getsourcelines(function)
    numbers = {first + i for i, text in enumerate(source) if text.strip() == line}
    if not numbers:
        raise ValueError(f"{function.__name__} has no line {line!r}")
    seen = []

    def at_line(frame: FrameType, event: str, _: object) -> Any:
        if event == "line" and frame.f_lineno in numbers:
            seen.append(look(frame.f_locals))
        return at_line

    before = sys.gettrace()
    sys.settrace(lambda frame, _event, _: at_line if frame.f_code is function.__code__ else None)
    try:
        run()
    finally:
        sys.settrace(before)
    if not seen:
        raise ValueError(f"{function.__name__} never comes to the line {line!r}")
    return seen


def table(heads: str, rows: Iterable[Iterable[object]]) -> str:
    """A table with these heads, which are separated by bars, and rows."""
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in (heads.split("|"), *rows)]
    lines.insert(1, "|---" * (heads.count("|") + 1) + "|")
    return "\n" + re.sub(r"-(?=[\d½ ])", "\N{MINUS SIGN}", "\n".join(lines)) + "\n"


def panel(fb: Any) -> str:
    """What is on a framebuffer, as a block of text."""
    return f"\n```\n{fb}\n```\n"


# -- Lines one pixel wide

X1, Y1, X2, Y2 = LINE = (2, 1, 13, 8)
SIZE = (16, 10)


def _line_surface() -> Any:
    surface = plain()["Framebuffer"](*SIZE).surface
    surface.dip(1, 0)
    return surface


def _pixel(i: int) -> str:
    return f"({i % SIZE[0]}, {i // SIZE[0]})"


def dda() -> str:
    lines = plain()["lines"]
    steps = watch(lines.dda_part, "above += slope", lambda: lines.dda_part(_line_surface(), *LINE, 0, lines.WHOLE))
    rows = [
        (k, at["x"], f"{Y1 + k * (Y2 - Y1) / (X2 - X1):.3f}", f"{at['above']:.3f}", f"({at['x']}, {at['y']})")
        for k, at in enumerate(steps)
    ]
    return table("step|x|exact y|`above`|pixel", rows)


def bresenham() -> str:
    lines, surface = plain()["lines"], _line_surface()
    rows = []
    for k in range(X2 - X1 + 1):
        alone = partial(lines.bresenham_part, surface, *LINE, k, k + 1)
        at = watch(lines.bresenham_part, "pixels[i] = ink[pixels[i]]", alone)[0]
        choice = f"stay: p + {at['stay']}" if at["p"] < 0 else f"next row: p \N{MINUS SIGN} {-at['move']}"
        rows.append((k, _pixel(at["i"]), at["p"], choice if k < X2 - X1 else "done"))
    return table("k|pixel|p<sub>k</sub>|so", rows)


def bresenham_clipped() -> str:
    lines, surface = plain()["lines"], _line_surface()
    surface.set_window(6, 0, 11, SIZE[1])
    (at,) = watch(
        lines.bresenham_part,
        "count: cython.longlong = last - first + 1",
        lambda: lines.bresenham(surface, *LINE),
    )
    return table(
        "`first`|`last`|`moved`|pixel|p",
        [(*(at[name] for name in ("first", "last", "moved")), _pixel(at["i"]), at["p"])],
    )


def bresenham_both_ends() -> str:
    lines = plain()["lines"]
    steps = watch(lines.bresenham_part, "below = p >> 63", lambda: lines.bresenham(_line_surface(), *LINE))
    return table(
        "turn|from the start|p|from the end|q",
        [(k, _pixel(at["i"]), at["p"], _pixel(at["j"]), at["q"]) for k, at in enumerate(steps)],
    )


# -- Curves


def circle() -> str:
    curves, fb = plain()["curves"], plain()["Framebuffer"](17, 17)
    decided = watch(curves.rounded, "x += 1", lambda: fb.circle(8, 8, 8), lambda at: (at["x"], at["y"], at["p"]))
    rows = []
    for x, y, p in decided:
        rows.append((x, f"({x}, {y})", p, "inside: stay" if p < 0 else "outside: next row"))
    return table("k|(x, y)|p<sub>k</sub>|the midpoint is", rows) + panel(fb)


def ellipse() -> str:
    curves, fb = plain()["curves"], plain()["Framebuffer"](19, 11)
    rows = watch(
        curves.ellipse,
        "inner = 0 if fill else min(x, before + 1)",
        lambda: fb.ellipse(9, 5, 9, 5),
        lambda at: (at["y"], at["p"], at["q"], f"{min(at['x'], at['before'] + 1)} … {at['x']}"),
    )
    return table("row y|p|q|x", rows) + panel(fb)


# -- Shapes by reference points


def thick() -> str:
    thick, fb = plain()["thick"], plain()["Framebuffer"](13, 11)

    def draw() -> None:
        fb.line(2, 2, 10, 8, width=3, cap="butt")

    (at,) = watch(thick.slab, "slack: cython.longlong = lines + 4096", draw)
    names = ("dx", "dy", "squared", "inside", "outside", "whole")
    fb.clear()
    rows = []
    for y, *bounds in watch(
        thick._sweep,
        "first = left + min(0, side_turn)",
        draw,
        lambda at: (at["y"], *(at[name] >> 40 for name in ("left", "back", "right", "front"))),
    ):
        a, b = max(bounds[:2]), min(bounds[2:])
        rows.append((y, *bounds, f"{a} … {b - 1}" if a < b else "none"))
    return (
        table("name|value", [(f"`{name}`", f"{at[name]:,}".replace(",", " ")) for name in names])
        + table("row|left side|left end|right side|right end|columns", rows)
        + panel(fb)
    )


def ties() -> str:
    fb = plain()["Framebuffer"](14, 12, 2)
    fb.line(4, 1, 12, 7, 1, width=5, cap="butt", op="add")
    fb.line(1, 5, 9, 11, 2, width=5, cap="butt", op="add")
    return panel(fb)


def _supersampled() -> tuple[Any, Callable[[], None]]:
    """A framebuffer, and the call that draws the line of the examples on it."""
    fb = plain()["Framebuffer"](8, 3, 4)
    return fb, lambda: fb.line(0, 0, 7, 2, antialias=plain()["supersample"].Supersample(4))


def supersampled_row() -> str:
    thick = plain()["thick"]
    fb, draw = _supersampled()
    line = "counts += before[(right >> 40) - x * n] - before[(left >> 40) - x * n]"
    spans = watch(thick._sweep, line, draw, lambda at: (at["y"], at["left"] >> 40, at["right"] >> 40, at["before"]))
    before = spans[0][3]
    rows = []
    sums = 0
    for k, (a, b) in enumerate(span[1:3] for span in spans if span[0] == 1):
        sums += before[b] - before[a]
        rows.append((f"sub-scanline {k}", f"{a} … {b - 1}", *(before[b] - before[a]).to_bytes(8, "little")))
    counts = sums.to_bytes(8, "little")
    heads = "|sub-pixels inside|" + "|".join(map(str, range(8)))
    return table(heads, [*rows, ("count of 16", "", *counts), ("level of 15", "", *fb.pixels[1])]) + panel(fb)


def cells_of_a_row() -> str:
    supersample = plain()["supersample"]
    fb, draw = _supersampled()
    cells = watch(supersample.paint, "if first < last:", draw, lambda at: list(at["cells"]))[0]
    halves = []
    for cell in cells[:8]:
        begun = (cell + (1 << 31)) % (1 << 32) - (1 << 31)
        halves.append((begun, (cell - begun) >> 32))
    spans, counts = 0, []
    for begun, left_out in halves:
        spans += begun
        counts.append(4 * spans - left_out)
    return table(
        "pixel|" + "|".join(map(str, range(8))),
        [
            ("cell", *(f"{begun}, {left_out}" for begun, left_out in halves)),
            ("count of 16", *counts),
            ("level of 15", *fb.pixels[0]),
        ],
    )


def levels() -> str:
    rows = []
    for covered in range(5):
        row: list[object] = [f"{covered} of 4"]
        for depth in (1, 2, 4, 8):
            surface = (fb := plain()["Framebuffer"](1, 1, depth)).surface
            surface.dip(fb.max_level, 0)
            surface.count_in(1, 4)
            surface.cells[0] = covered
            surface.blend(0, 0, 1, 0)
            row.append(fb.pixels[0, 0])
        rows.append(row)
    return table("counted|depth 1|depth 2|depth 4|depth 8", rows)


def polygon() -> str:
    polygons, fb = plain()["polygons"], plain()["Framebuffer"](13, 11)
    corners = [(1, 1), (11, 4), (4, 9)]
    names = "ABC"
    edges: list[list[object]] = []

    def look(at: dict[str, Any]) -> list[object]:
        if not edges:
            for i, edge in enumerate(at["edges"]):
                edges.append([names[i], corners[i - 1], corners[i], edge.first, edge.end, _step(edge)])
        standing = []
        for edge in at["active"][: at["crossing"]]:
            i = at["edges"].index(edge)
            (x1, y1), (x2, y2) = corners[i - 1], corners[i]
            crossing = x1 + Fraction((x2 - x1) * (at["y"] - y1), y2 - y1)
            standing.append(f"{names[i]}: {float(crossing):.2f} → {edge.bound}")
        a, b = (edge.bound for edge in at["active"][:2])
        return [at["y"], *standing, f"{a} … {b - 1}" if a < b else "none"]

    rows = watch(polygons._fill, "before = active[0].bound", lambda: fb.poly(0, 0, corners, fill=True), look)
    return (
        table("edge|from|to|first row|end row|x a row", edges)
        + table("row|first active|second active|columns", rows)
        + panel(fb)
    )


def _step(edge: Any) -> str:
    return f"{edge.step} + {edge.fraction_step / (1 << 62):.3f}"


def joins() -> str:
    strokes, half = plain()["strokes"], 25600
    rows = []
    for turn in (30, 60, 90, 120, 150, 152, 170):
        contours = strokes.Contours()
        u = math.cos(math.radians(turn)), math.sin(math.radians(turn))
        strokes._join(contours, 0, 0, 1, 0, *u, half, strokes.JOINS["miter"])
        mitered = contours.count == 4
        long = 1 / math.cos(math.radians(turn) / 2)
        drawn = math.hypot(*contours.points[4:6]) / half
        rows.append((f"{turn}°", f"{long:.2f}", f"miter, {drawn:.2f}" if mitered else "bevel"))
    return table("turn by|1 / cos(turn / 2)|drawn", rows)


# -- The cone


def cone_table() -> str:
    volumes = plain()["cone"].ConeFilter().table[::16, ::16]
    places = ["-1", "-½", "0", "½", "1"]
    return table(
        "C(u, v)|" + "|".join(f"v = {place}" for place in places),
        [[f"u = {place}", *(f"{volume:.4f}" for volume in row)] for place, row in zip(places, volumes, strict=True)],
    )


def cone_row() -> str:
    cone, fb = plain()["cone"], plain()["Framebuffer"](8, 3, 4)

    def look(at: dict[str, Any]) -> tuple[Any, ...]:
        u, v = at["u"] / at["scale"], at["v"] / at["scale"]
        known = at["behind_start"] <= at["u"] <= at["before_end"]
        return at["y"], at["x"], f"{u:.3f}", f"{v:.3f}", "by distance" if known else "four", at["covered"]

    steps = watch(
        cone.strip, "cells[x] = covered - last", lambda: fb.line(0, 0, 7, 2, antialias=cone.ConeFilter()), look
    )
    rows = [(*step[1:], fb.pixels[1, step[1]]) for step in steps if step[0] == 1]
    return table("x|u|v|look-up|volume in 1024ths|level of 15", rows) + panel(fb)


def cone_look_ups() -> str:
    cone, fb = plain()["cone"], plain()["Framebuffer"](8, 3, 4)
    at = watch(cone._near_end, "return (", lambda: fb.line(0, 0, 7, 2, antialias=cone.ConeFilter()))[0]
    u1, u0, v1, v0 = at["behind"] - at["u"], at["before"] - at["u"], at["half"] - at["v"], -at["half"] - at["v"]
    volumes = [at["cone"].volume(u, v) for u, v in ((u1, v1), (u0, v1), (u1, v0), (u0, v0))]
    rows = [
        (sign, name, f"({u:.3f}, {v:.3f})", f"{volume:.4f}")
        for (sign, name, u, v), volume in zip(
            (
                ("+", "C(u₁, v₁)", u1, v1),
                ("-", "C(u₀, v₁)", u0, v1),
                ("-", "C(u₁, v₀)", u1, v0),
                ("+", "C(u₀, v₀)", u0, v0),
            ),
            volumes,
            strict=True,
        )
    ]
    total = volumes[0] - volumes[1] - volumes[2] + volumes[3]
    return table("|look-up|at|value", [*rows, ("=", "volume", "", f"{total:.4f}")])


def filtered_edges() -> str:
    """The segments that reach pixel (1, 1), what is to the right of each, and their sum."""
    filtered, fb = plain()["filtered"], plain()["Framebuffer"](5, 5, 4)
    cone = plain()["cone"].ConeFilter()
    seen = watch(
        filtered._add,
        "volume *= sign",
        lambda: fb.poly(0, 0, [0, 0, 4, 1, 1, 4], fill=True, antialias=cone),
    )
    rows, total = [], 0.0
    for at in seen:
        if (at["x"], at["y"]) == (1, 1):
            start, stop = (f"({at[x]:g}, {at[y] + 1:g})" for x, y in (("start", "ay"), ("stop", "by")))
            total += at["sign"] * at["volume"]
            rows.append(("+" if at["sign"] > 0 else "-", start, stop, f"{at['d']:.3f}", f"{at['volume']:.4f}"))
    return table("|from|to|d|volume to the right", [*rows, ("=", "", "", "", f"{total:.4f}")]) + panel(fb)


def _update() -> Any:
    """A planner whose pointer stands behind page 2, column 9, and three bytes to bring onto the panel."""
    planner = plain()["Planner"](SSD1306(), Cost(2, 2))
    planner.restart()
    planner.plan()
    planner.sent()
    for cells in ([(2, 9)], [(2, 14), (2, 48), (5, 15)]):
        for cell in cells:
            planner.fresh[cell] += 1
        plan = planner.plan()
        messages = [(kind, bytes(payload)) for kind, payload in plan]
        planner.sent()
    return planner, messages


def update_steps() -> str:
    planner, _ = _update()
    count = planner._count
    names = [f"page {row}, column {first}" for row, first, _ in planner._pieces[:count].tolist()]
    rows = []
    for i, name in enumerate(["where it stands", *names]):
        lengths = ["" if i == j + 1 else int(planner._lengths[i, j]) for j in range(count)]
        rows.append([name, *lengths])
    return table(f"from|to {'|to '.join(names)}", rows)


def update_messages() -> str:
    _, messages = _update()
    kinds = {COMMAND: "commands", DATA: "data"}
    rows = [[kinds[kind], f"`{payload.hex(' ')}`", 2 + len(payload)] for kind, payload in messages]
    return table("message|bytes|on the wire", [*rows, ["", "", sum(int(row[2]) for row in rows)]])
