"""The excerpts and tables of the pages, and what makes the tables of algorithms.md.

An excerpt follows a link to its function, class or value; of that it shows the lines from its own first line to its own
last one. A table stands between ``<!-- NAME -->`` and ``<!-- end -->``, and a function NAME makes it, in algorithms.md
from the plain loops or from what a drawing call does.
"""

from __future__ import annotations

import ast
import importlib
import math
import re
import sys
import textwrap
from collections.abc import Iterable, Mapping
from functools import cache
from math import ceil
from pathlib import Path
from typing import Any

import figures
import plain_loops

from paneldraw import ConeFilter, Framebuffer, Supersample
from paneldraw._compiled import MODULES
from paneldraw._interpreted import load_sources
from paneldraw.controllers import SSD1306
from paneldraw.transports import COMMAND, DATA, Cost

PAGE = Path(__file__).with_name("algorithms.md")

_EXCERPT = re.compile(
    r"(?P<head>^.*\[`(?P<name>[\w.]+)`\]\((?P<file>[\w/.]+)\).*\n(?:.+\n)*\n```python\n)(?P<code>(?s:.*?))(?=^```$)",
    re.M,
)
_TABLE = re.compile(r"(?P<head>^<!-- (?P<name>(?!end)\w+) -->\n)(?s:.*?)(?=^<!-- end -->$)", re.M)


def page(text: str, tables: Mapping[str, Any] | None = None) -> str:
    """Return a page with its excerpts and tables as the code has them; default: the tables of algorithms.md."""
    made = globals() if tables is None else tables
    text = _EXCERPT.sub(lambda found: found["head"] + excerpt(found["file"], found["name"], found["code"]), text)
    return _TABLE.sub(lambda found: found["head"] + made[found["name"]]() + "\n", text)


def excerpt(file: str, name: str, shown: str) -> str:
    """Return the lines of a function, method, class or value, from the first line of `shown` to its last one."""
    source = (PAGE.parent / file).read_text(encoding="utf-8")
    node: Any = ast.parse(source)
    for part in name.split("."):
        node = next((child for child in ast.walk(node) if child is not node and part in _names(child)), None)
        if node is None:
            raise ValueError(f"{file} defines no {name}; name something else on the page")
    lines = textwrap.dedent("\n".join(source.splitlines()[node.lineno - 1 : node.end_lineno])).splitlines()
    wanted = [line.strip() for line in shown.strip().splitlines()]
    stripped = [line.strip() for line in lines]
    try:
        start = stripped.index(wanted[0])
        end = stripped.index(wanted[-1], start)
    except ValueError:
        raise ValueError(
            f"{name} in {file} has no lines from {wanted[0]!r} to {wanted[-1]!r}; name others on the page"
        ) from None
    return textwrap.dedent("\n".join(lines[start : end + 1])) + "\n"


def _names(node: ast.AST) -> list[str]:
    """What a statement defines."""
    if isinstance(node, ast.Assign):
        return [target.id for target in node.targets if isinstance(target, ast.Name)]
    return [node.name] if isinstance(node, (ast.FunctionDef, ast.ClassDef)) else []


def table(heads: str, rows: Iterable[Iterable[object]]) -> str:
    """A table with these heads, which are separated by bars, and rows."""
    lines = ["| " + " | ".join(map(str, row)) + " |" for row in (heads.split("|"), *rows)]
    lines.insert(1, "|---" * (heads.count("|") + 1) + "|")
    return "\n" + re.sub(r"-(?=[\d½ ])", "\N{MINUS SIGN}", "\n".join(lines)) + "\n"


def panel(fb: Any) -> str:
    """What is on a framebuffer, as a block of text."""
    return f"\n```\n{fb}\n```\n"


# -- The plain loops, and what drawing calls do


def dda() -> str:
    x1, y1, x2, y2 = 2, 1, 13, 8
    m = (y2 - y1) / (x2 - x1)
    pixels = list(plain_loops.dda(x1, y1, x2, y2))
    rows = [
        ["x", *(x for x, _ in pixels)],
        ["y", *(f"{y1 + k * m:.2f}" for k in range(len(pixels)))],
        ["row", *(y for _, y in pixels)],
    ]
    return table("|".join(map(str, ["k", *range(len(pixels))])), rows)


def polygon() -> str:
    corners = [(1, 1), (11, 4), (4, 9)]
    pixels = plain_loops.polygon(corners)
    rows = []
    for y in range(1, 9):
        crossings = []
        for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True):
            if min(y1, y2) <= y < max(y1, y2):
                crossings.append(x1 + (y - y1) * (x2 - x1) / (y2 - y1))
        found = [x for x, row in pixels if row == y]
        crossed = [f"{x:.2f} → {ceil(x)}" for x in sorted(crossings)]
        rows.append([y, *crossed, f"{found[0]} … {found[-1]}" if found else "none"])
    fb = Framebuffer(13, 11)
    fb.poly(0, 0, corners, fill=True, antialias=Supersample(1))
    return table("row|in|out|columns", rows) + panel(fb)


def coverages() -> str:
    """Row 1 of a line one pixel wide, whose square ends are half a pixel beyond its end points."""
    u, v = 3.5 / math.hypot(7, 2), 1 / math.hypot(7, 2)
    line = (-u, -v, 7 + u, 2 + v, 1.0)
    rows: list[list[object]] = [
        ["count of 16", *(round(16 * plain_loops.supersampled(x, 1, line, 4)) for x in range(8))],
        ["`Supersample(4)`", *_painted(Supersample(4))],
        ["volume", *(f"{plain_loops.cone_filtered(x, 1, line):.2f}" for x in range(8))],
        ["`ConeFilter()`", *_painted(ConeFilter())],
    ]
    return table("x|" + "|".join(map(str, range(8))), rows)


def _painted(antialias: Supersample | ConeFilter) -> list[int]:
    fb = Framebuffer(8, 3, depth=4)
    fb.line(0, 0, 7, 2, antialias=antialias)
    return [int(level) for level in fb.pixels[1]]


def counts() -> str:
    """The changes and counts of the second row of the figure of spans."""
    spans = [(a, b) for y, a, b in figures.disc_spans() if y // figures.N == 1]
    counts = plain_loops.counted(spans, figures.N, 8)
    changes = [count - before for before, count in zip([0, *counts], counts, strict=False)]
    return table("pixel|" + "|".join(map(str, range(8))), [["change", *changes], ["count of 16", *counts]])


def cone_table() -> str:
    volumes = ConeFilter().table[::16, ::16]
    places = ["-1", "-½", "0", "½", "1"]
    return table(
        "C(u, v)|" + "|".join(f"v = {place}" for place in places),
        [[f"u = {place}", *(f"{volume:.4f}" for volume in row)] for place, row in zip(places, volumes, strict=True)],
    )


def levels() -> str:
    """A pixel with a polygon over none to all of its 2 x 2 reference points."""
    rows = []
    for covered in range(5):
        row: list[object] = [f"{covered} of 4"]
        for depth in (1, 2, 4, 8):
            fb = Framebuffer(1, 1, depth)
            right, middle = (0, 1, 1, 2, 2)[covered] / 2 - 0.5, (0, 0, 1, 1, 2)[covered] / 2 - 0.5
            corners = [(-0.5, -0.5), (right, -0.5), (right, 0), (middle, 0), (middle, 0.5), (-0.5, 0.5)]
            if covered:
                fb.poly(0, 0, corners, fill=True, antialias=Supersample(2))
            row.append(fb.pixels[0, 0])
        rows.append(row)
    return table("counted|depth 1|depth 2|depth 4|depth 8", rows)


def joins() -> str:
    rows = []
    for turn in (30, 60, 90, 120, 150, 152, 170):
        drawn = []
        for join in "miter", "bevel":
            fb = Framebuffer(128, 128)
            x, y = math.cos(math.radians(turn)), math.sin(math.radians(turn))
            fb.polyline([(10, 64), (64, 64), (64 + 50 * x, 64 + 50 * y)], width=20, join=join)
            drawn.append(fb.pixels.tobytes())
        kind = "bevel" if drawn[0] == drawn[1] else "miter"
        rows.append((f"{turn}°", f"{1 / math.cos(math.radians(turn) / 2):.2f}", kind))
    return table("turn by|1 / cos(turn / 2)|drawn", rows)


# -- Updates


@cache
def plain_planner() -> Any:
    """The planner as plain Python, whose insides can be seen."""
    for name in MODULES:
        importlib.import_module(name)
    compiled = {name: sys.modules.pop(name) for name in MODULES}
    try:
        load_sources()
        return sys.modules["paneldraw.update.planner"].Planner
    finally:
        for name, module in compiled.items():
            sys.modules[name] = module
            setattr(importlib.import_module(name.rpartition(".")[0]), name.rpartition(".")[2], module)


def _update() -> Any:
    """A planner whose pointer stands behind page 2, column 9, and three bytes to bring onto the panel."""
    planner = plain_planner()(SSD1306(), Cost(2, 2))
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
    names = [f"page {piece.row}, column {piece.left}" for piece in planner._windows.pieces[:count]]
    rows = []
    for i, name in enumerate(["where it stands", *names]):
        lengths = ["" if i == j + 1 else planner._order.step(i - 1, j) for j in range(count)]
        rows.append([name, *lengths])
    return table(f"from|to {'|to '.join(names)}", rows)


def update_messages() -> str:
    _, messages = _update()
    kinds = {COMMAND: "commands", DATA: "data"}
    rows = [[kinds[kind], f"`{payload.hex(' ')}`", 2 + len(payload)] for kind, payload in messages]
    return table("message|bytes|on the wire", [*rows, ["", "", sum(int(row[2]) for row in rows)]])
