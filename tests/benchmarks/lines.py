"""Drawing random lines on 128 x 64, one a call or all in one, aliased and anti-aliased."""

from __future__ import annotations

import random

import canvases
import numpy as np
from canvases import HEIGHT, WIDTH
from measure import Against, Contest, Names, Row

N = 500

EACH = "for x1, y1, x2, y2 in segments: "
SHIFTED = "for x1, y1, x2, y2 in shifted: "
TUPLES = "for segment in segments: "
ENDS = "for p, q in ends: "
CAIRO = SHIFTED + "move_to({0}, x1, y1); line_to({0}, x2, y2); stroke({0})"
BLEND2D = "for one in structures: stroke({0}, LINE, one)"


def thin(skia: float, agg: float | None = None) -> tuple[Against, ...]:
    """Anti-aliased lines of width 1, and the ratios that we want to two of the peers."""
    return (
        Against("Skia", SHIFTED + "drawLine(x1, y1, x2, y2, thin)", skia),
        Against("AGG", "for segment in shifted: line(segment, thin)", agg),
        Against("cairo", CAIRO.format("soft")),
        Against("Blend2D", BLEND2D.format("thin")),
        Against("pygame", ENDS + "aaline(wide, white, p, q)"),
    )


WIDE = (
    Against("Skia", SHIFTED + "drawLine(x1, y1, x2, y2, wide)"),
    Against("AGG", "for segment in shifted: line(segment, wide)"),
    Against("Blend2D", BLEND2D.format("wide")),
)

ROWS = [
    Row(
        "line, one call a line",
        N,
        EACH + "line(x1, y1, x2, y2)",
        (
            Against("Pillow", TUPLES + "line(segment, 1)", 4),
            Against("OpenCV", ENDS + "line(canvas, p, q, 255)", 4),
            Against("pygame", ENDS + "line(wide, white, p, q)"),
            Against("pygame", EACH + "gfx_line(wide, x1, y1, x2, y2, white)", how="gfxdraw"),
            Against("cairo", CAIRO.format("hard")),
            Against("Skia", SHIFTED + "drawLine(x1, y1, x2, y2, hairline)"),
            Against("AGG", "for segment in shifted: hard_line(segment, thin)"),
            Against("numba", EACH + "line(a, x1, y1, x2, y2, 1)"),
            Against("framebuf", EACH + "line(x1, y1, x2, y2, 1)"),
        ),
    ),
    Row(
        "lines, one call",
        N,
        "lines(table)",
        (
            Against("OpenCV", "polylines(canvas, listed_pairs, False, 255)", 4, "a list"),
            Against("OpenCV", "polylines(canvas, pairs, False, 255)", None, "an array"),
            Against("C", "lines(pixels, WIDTH, int32_table, N, 1)", 1 / 1.2),
            Against("numba", "lines(a, table, 1)"),
            Against("Skia", "drawPoints(LINES, points, hairline)"),
        ),
    ),
    Row(
        "line, Supersample(4)",
        N,
        EACH + "smooth_line(x1, y1, x2, y2)",
        (Against("OpenCV", ENDS + "line(canvas, p, q, 255, 1, AA)", 1), *thin(3, 3)),
    ),
    Row(
        "line, width 3, Supersample(4)",
        N,
        EACH + "smooth_line(x1, y1, x2, y2, width=3)",
        (Against("OpenCV", ENDS + "line(canvas, p, q, 255, 3, AA)", 1.5), *WIDE),
    ),
    Row(
        "lines, one call, Supersample(4)",
        N,
        "smooth_lines(table)",
        (
            Against("OpenCV", "polylines(canvas, listed_pairs, False, 255, 1, AA)", 1.3, "a list"),
            Against("OpenCV", "polylines(canvas, pairs, False, 255, 1, AA)", 1.3, "an array"),
            Against("Skia", "drawPoints(LINES, points, thin)"),
        ),
    ),
    Row(
        "line, ConeFilter()",
        N,
        EACH + "cone_line(x1, y1, x2, y2)",
        (Against("OpenCV", ENDS + "line(canvas, p, q, 255, 1, AA)", 1), *thin(2)),
    ),
    Row(
        "line, width 3, ConeFilter()",
        N,
        EACH + "cone_line(x1, y1, x2, y2, width=3)",
        (Against("OpenCV", ENDS + "line(canvas, p, q, 255, 3, AA)"), *WIDE),
    ),
    Row(
        "lines, one call, ConeFilter()",
        N,
        "cone_lines(table)",
        (Against("OpenCV", "polylines(canvas, listed_pairs, False, 255, 1, AA)", None, "a list"),),
    ),
    Row(
        "line, ConeFilter() made in the call",
        N,
        EACH + "grey_line(x1, y1, x2, y2, antialias=ConeFilter())",
        (Against("ours", EACH + "grey_line(x1, y1, x2, y2, antialias=one)", 0.95, "made before"),),
    ),
]


def shapes() -> Names:
    """The lines as rows of numbers and as pairs of points; `shifted` where a pixel's center is at its half."""
    pick = random.Random(1)
    points = [(pick.randrange(WIDTH), pick.randrange(HEIGHT)) for _ in range(2 * N)]
    ends = list(zip(points[::2], points[1::2], strict=True))
    segments = [p + q for p, q in ends]
    table = np.array(segments)
    return {
        "ends": ends,
        "segments": segments,
        "shifted": (table + 0.5).tolist(),
        "table": table,
        "N": N,
        "WIDTH": WIDTH,
    }


def opencv() -> Names:
    """Lines as arrays of two points: in one array of three dimensions, and in a list."""
    pairs = shapes()["table"].astype(np.int32).reshape(-1, 2, 2)
    return canvases.opencv() | {"pairs": pairs, "listed_pairs": list(pairs)}


def skia() -> Names:
    """Lines as pairs of its points."""
    names = canvases.skia()
    points = [names["skia"].Point(*shifted[k : k + 2]) for shifted in shapes()["shifted"] for k in (0, 2)]
    return names | {"points": points}


def blend2d() -> Names:
    """Lines as its structures."""
    names = canvases.blend2d()
    return names | {"structures": canvases.blend2d_shapes(names["ffi"].BLLine, shapes()["shifted"])}


def floor() -> Names:
    """Lines as 32-bit numbers."""
    table = shapes()["table"].astype(np.int32)
    return canvases.floor() | {"int32_table": table.ctypes.data, "memory of the table": table}


def kept() -> Names:
    """Ours with a filter that was made before."""
    names = canvases.ours()
    return names | {"one": names["ConeFilter"]()}


def contest(rounds: int) -> Contest:
    """Us and the peers."""
    peers = canvases.PEERS | {
        "OpenCV": opencv,
        "Skia": skia,
        "Blend2D": blend2d,
        "C": floor,
        "ours": kept,
    }
    return Contest(canvases.ours(), peers, rounds, shapes())


def run(rounds: int) -> None:
    """Print the group's rows."""
    contest(rounds).run_all(ROWS)
