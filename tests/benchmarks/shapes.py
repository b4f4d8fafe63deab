"""Drawing shapes on 128 x 64: rectangles, triangles, polygons and round ones, aliased and anti-aliased."""

from __future__ import annotations

import itertools
import math
import random

import canvases
import numpy as np
from canvases import HEIGHT, WIDTH
from measure import Against, Contest, Names, Row

from paneldraw import Gradient, Pattern

N = 200
SMALL, LARGE = 12, 20
CORNER = 4

RECTS = "for x, y, w, h in rects: "
BOXES = "for box in boxes: "
CORNERS = "for p, q in corners: "
CENTERS = "for x, y in centers: "
POINTS = "for center in centers: "
MIDDLES = "for x, y in middles: "
TRIANGLES = "for x1, y1, x2, y2, x3, y3 in triangles: "
TURNS = "for start, end in turns: "
ALL_ROUND = 2 * math.pi


def aliased() -> list[Row]:
    """Shapes of one bit a pixel."""
    return [
        Row(
            "rect",
            N,
            RECTS + "rect(x, y, w, h)",
            (
                Against("pygame", "for one in surface_rects: rect(wide, white, one, 1)", 1),
                Against("pygame", "for one in surface_rects: gfx_rectangle(wide, one, white)", 1, "gfxdraw"),
                Against("Pillow", BOXES + "rectangle(box, None, 1)", 2),
                Against("OpenCV", CORNERS + "rectangle(canvas, p, q, 255)"),
                Against("Skia", "for one in outlines: drawRect(one, outline)"),
                Against("framebuf", RECTS + "rect(x, y, w, h, 1)"),
            ),
        ),
        Row(
            "rect, filled",
            N,
            RECTS + "rect(x, y, w, h, 1, True)",
            (
                Against("pygame", "for one in surface_rects: fill(255, one)", 1),
                Against("pygame", "for one in surface_rects: gfx_box(surface, one, white)", 1, "gfxdraw"),
                Against("Pillow", BOXES + "rectangle(box, 1)", 2),
                Against("OpenCV", CORNERS + "rectangle(canvas, p, q, 255, -1)"),
                Against("numpy", "for x1, y1, x2, y2 in slices: a[y1:y2, x1:x2] = 1"),
                Against("Skia", "for one in skia_rects: drawRect(one, filled)"),
                Against("framebuf", RECTS + "fill_rect(x, y, w, h, 1)"),
            ),
        ),
        Row(
            f"round_rect, r {CORNER}",
            N,
            RECTS + "round_rect(x, y, w, h, CORNER)",
            (
                Against("pygame", "for one in surface_rects: rect(wide, white, one, 1, CORNER)"),
                Against("Pillow", BOXES + "rounded_rectangle(box, CORNER, None, 1)"),
                Against("Skia", "for one in outlines: drawRoundRect(one, CORNER, CORNER, outline)"),
            ),
            fastest=1,
        ),
        Row(
            f"round_rect, r {CORNER}, filled",
            N,
            RECTS + "round_rect(x, y, w, h, CORNER, 1, True)",
            (
                Against("pygame", "for one in surface_rects: rect(surface, 255, one, 0, CORNER)"),
                Against("Pillow", BOXES + "rounded_rectangle(box, CORNER, 1)"),
                Against("Skia", "for one in skia_rects: drawRoundRect(one, CORNER, CORNER, filled)"),
            ),
            fastest=1,
        ),
        Row(
            "triangle",
            N,
            TRIANGLES + "triangle(x1, y1, x2, y2, x3, y3)",
            (
                Against("pygame", "for points in point_triangles: polygon(surface, 255, points, 1)"),
                Against("pygame", TRIANGLES + "gfx_trigon(wide, x1, y1, x2, y2, x3, y3, white)", how="gfxdraw"),
                Against("Pillow", "for points in triangles: polygon(points, None, 1)"),
                Against("OpenCV", "for points in int32_triangles: polylines(canvas, points, True, 255)"),
            ),
            fastest=1,
        ),
        Row(
            "triangle, filled",
            N,
            TRIANGLES + "triangle(x1, y1, x2, y2, x3, y3, 1, True)",
            (
                Against("pygame", "for points in point_triangles: polygon(surface, 255, points)"),
                Against("Pillow", "for points in triangles: polygon(points, 1)"),
                Against("OpenCV", "for (points,) in int32_triangles: fillConvexPoly(canvas, points, 255)"),
            ),
            fastest=1,
        ),
        Row(
            f"circle, r {SMALL}",
            N,
            CENTERS + "circle(x, y, SMALL)",
            (
                Against("Pillow", "for box in small_boxes: ellipse(box, None, 1)", 3),
                Against("OpenCV", POINTS + "circle(canvas, center, SMALL, 255)"),
                Against("pygame", POINTS + "circle(wide, white, center, SMALL, 1)"),
                Against("pygame", CENTERS + "gfx_circle(wide, x, y, SMALL, white)", how="gfxdraw"),
                Against("framebuf", CENTERS + "circle(x, y, SMALL, 1)"),
            ),
        ),
        Row(
            f"disc, r {SMALL}",
            N,
            CENTERS + "circle(x, y, SMALL, 1, True)",
            (
                Against("Pillow", "for box in small_boxes: ellipse(box, 1)"),
                Against("OpenCV", POINTS + "circle(canvas, center, SMALL, 255, -1)", 1.5),
                Against("pygame", POINTS + "circle(wide, white, center, SMALL)"),
            ),
        ),
        Row(
            f"arc, r {SMALL}",
            N,
            TURNS + "arc(64, 32, SMALL, start, end)",
            (
                Against("Pillow", TURNS + "arc(box, start, end, 1)"),
                Against("OpenCV", TURNS + "ellipse(canvas, center, radii, 0, start, end, 255)"),
            ),
        ),
        Row(
            f"sector, r {SMALL}, filled",
            N,
            TURNS + "sector(64, 32, SMALL, start, end, 1, True)",
            (
                Against("Pillow", TURNS + "pieslice(box, start, end, 1)"),
                Against("OpenCV", TURNS + "ellipse(canvas, center, radii, 0, start, end, 255, -1)"),
            ),
        ),
        Row(
            "filled polygon, 12 points",
            N,
            "for table in polygons: poly(0, 0, table, 1, True)",
            (
                Against("Pillow", "for points in flat_polygons: polygon(points, 1)", 1.5),
                Against("OpenCV", "for points in int32_polygons: fillPoly(canvas, points, 255)", 1.5),
                Against("pygame", "for points in point_polygons: polygon(surface, 255, points)"),
            ),
        ),
        Row(
            "cubic curve",
            N,
            "for table in curves: bezier(table)",
            (
                Against("pygame", "for points in point_curves: gfx_bezier(wide, points, 32, white)", how="gfxdraw"),
                Against("Skia", "for one in skia_curves: drawPath(one, outline)"),
            ),
        ),
        Row(
            "filled cubic curve",
            N,
            "for table in curves: bezier(table, fill=True)",
            (Against("Skia", "for one in closed_curves: drawPath(one, covered)"),),
        ),
        Row(
            "arrow",
            N,
            "for x1, y1, x2, y2 in boxes: arrow(x1, y1, x2, y2)",
            (Against("OpenCV", CORNERS + "arrowedLine(canvas, p, q, 255)"),),
        ),
        Row(
            "rect, filled with a pattern",
            N,
            RECTS + "rect(x, y, w, h, checker, True)",
            (Against("Skia", "for one in skia_rects: drawRect(one, checkered)"),),
        ),
        Row(
            "rect, filled with a gradient",
            N,
            RECTS + "rect(x, y, w, h, shades, True)",
            (Against("Skia", "for one in skia_rects: drawRect(one, shaded)"),),
        ),
        Row(
            "flood fill, all of it",
            1,
            "flood_fill(3, 3)",
            (
                Against("Pillow", "flood(image, (3, 3), next(other))"),
                Against("OpenCV", "floodFill(canvas, None, (3, 3), 255)"),
            ),
        ),
    ]


def smooth(kind: str, call: str, opencv: float | None = None, blend2d: float | None = None) -> list[Row]:
    """Anti-aliased shapes: the name of the kind, the prefix of our calls, and the ratios that we want."""
    return [
        Row(
            f"circle, r {LARGE}, {kind}",
            N,
            CENTERS + f"{call}circle(x, y, LARGE)",
            (
                Against("OpenCV", POINTS + "circle(canvas, center, LARGE, 255, 1, AA)"),
                Against("Blend2D", "for one in circles: stroke(thin, CIRCLE, one)"),
                Against("Skia", MIDDLES + "drawCircle(x, y, LARGE, thin)"),
                Against("cairo", MIDDLES + "arc(soft, x, y, LARGE, 0, ALL_ROUND); stroke(soft)"),
                Against("AGG", "for box in ring_boxes: ellipse(box, thin)"),
                Against("pygame", POINTS + "aacircle(wide, white, center, LARGE, 1)"),
            ),
        ),
        Row(
            f"ring, r {LARGE}, width 3, {kind}",
            N,
            CENTERS + f"{call}circle(x, y, LARGE, width=3)",
            (
                Against("OpenCV", POINTS + "circle(canvas, center, LARGE, 255, 3, AA)", opencv),
                Against("Blend2D", "for one in circles: stroke(wide, CIRCLE, one)", blend2d),
                Against("Skia", MIDDLES + "drawCircle(x, y, LARGE, wide)"),
                Against("cairo", MIDDLES + "arc(thick, x, y, LARGE, 0, ALL_ROUND); stroke(thick)"),
                Against("AGG", "for box in ring_boxes: ellipse(box, wide)"),
                Against("pygame", POINTS + "aacircle(wide, white, center, LARGE + 1, 3)"),
            ),
        ),
        Row(
            f"disc, r {LARGE}, {kind}",
            N,
            CENTERS + f"{call}circle(x, y, LARGE, 255, True)",
            (
                Against("OpenCV", POINTS + "circle(canvas, center, LARGE, 255, -1, AA)", opencv),
                Against("Blend2D", "for one in discs: fill(thin, CIRCLE, one)", blend2d),
                Against("Skia", MIDDLES + "drawCircle(x, y, RADIUS, smooth)"),
                Against("cairo", MIDDLES + "arc(soft, x, y, RADIUS, 0, ALL_ROUND); fill(soft)"),
                Against("AGG", "for box in disc_boxes: ellipse(box, brush)"),
                Against("pygame", POINTS + "aacircle(wide, white, center, LARGE)"),
            ),
        ),
        Row(
            f"filled polygon, 12 points, {kind}",
            N,
            f"for table in polygons: {call}poly(0, 0, table, 255, True)",
            filled("polygons", opencv, blend2d),
        ),
        Row(
            f"filled regular polygon, 12 points, {kind}",
            N,
            f"for table in regular: {call}poly(0, 0, table, 255, True)",
            filled("regular", opencv, blend2d),
        ),
        Row(
            f"polyline, 10 points, width 3, {kind}",
            N,
            f"for table in paths: {call}polyline(table, width=3)",
            (
                Against("OpenCV", "for points in int32_paths: polylines(canvas, points, False, 255, 3, AA)"),
                Against("Blend2D", "for one in path_views: stroke(wide, POLYLINED, one)"),
                Against("Skia", "for one in skia_paths: drawPath(one, wide)"),
                Against("cairo", "for one in data_paths: append_path(thick, one); stroke(thick)"),
                Against("AGG", "for points in agg_paths: line(points, wide)"),
            ),
        ),
        Row(
            f"cubic curve, width 3, {kind}",
            N,
            f"for table in curves: {call}bezier(table, width=3)",
            (Against("Skia", "for one in skia_curves: drawPath(one, wide)"),),
        ),
        Row(
            f"arc, r {LARGE}, width 3, {kind}",
            N,
            TURNS + f"{call}arc(64, 32, LARGE, start, end, width=3)",
            (
                Against("OpenCV", TURNS + "ellipse(canvas, center, large_radii, 0, start, end, 255, 3, AA)"),
                Against("Blend2D", "for one in arcs: stroke(wide, ARC, one)"),
                Against("Skia", TURNS + "drawArc(oval, start, end - start, False, wide)"),
                Against("cairo", "for start, end in radians: arc(thick, 64.5, 32.5, LARGE, start, end); stroke(thick)"),
            ),
        ),
        Row(
            f"sector, r {LARGE}, filled, {kind}",
            N,
            TURNS + f"{call}sector(64, 32, LARGE, start, end, 255, True)",
            (
                Against("OpenCV", TURNS + "ellipse(canvas, center, large_radii, 0, start, end, 255, -1, AA)"),
                Against("Blend2D", "for one in pies: fill(thin, PIE, one)"),
                Against("Skia", TURNS + "drawArc(wide_oval, start, end - start, True, smooth)"),
                Against("AGG", "for start, end in counterclockwise: pieslice(pie_box, start, end, brush)"),
            ),
        ),
    ]


def filled(which: str, opencv: float | None, blend2d: float | None) -> tuple[Against, ...]:
    """Anti-aliased polygons of one list or the other."""
    return (
        Against("OpenCV", f"for points in int32_{which}: fillPoly(canvas, points, 255, AA)", opencv),
        Against("Blend2D", f"for one in views_{which}: fill(thin, POLYGOND, one)", blend2d),
        Against("Skia", f"for one in skia_{which}: drawPath(one, smooth)"),
        Against("cairo", f"for one in data_{which}: append_path(soft, one); fill(soft)"),
        Against("AGG", f"for points in agg_{which}: polygon(points, brush)"),
    )


ROWS = [*aliased(), *smooth("Supersample(4)", "smooth_", 1.5, 2), *smooth("ConeFilter()", "cone_")]

Points = list[tuple[int, int]]
Halves = list[tuple[float, float]]


def shapes() -> Names:
    """The shapes as rows of numbers, lists of points and tables; where all know a form of it, it is here."""
    pick = random.Random(1)
    points: Points = [(pick.randrange(WIDTH), pick.randrange(HEIGHT)) for _ in range(2 * N + 12)]
    centers = points[: 2 * N : 2]
    boxes = [
        (min(x1, x2), min(y1, y2), max(x1, x2), max(y1, y2))
        for (x1, y1), (x2, y2) in zip(centers, points[1 : 2 * N : 2], strict=True)
    ]
    lists: dict[str, list[Points]] = {
        "triangles": [points[k : k + 3] for k in range(N)],
        "polygons": [points[k : k + 12] for k in range(N)],
        "regular": [ngon(x, y) for x, y in centers],
        "paths": [points[k : k + 10] for k in range(N)],
        "curves": [points[k : k + 4] for k in range(N)],
    }
    turns = [(pick.randrange(-180, 180), pick.randrange(10, 350)) for _ in range(N)]
    return {
        "lists": lists,
        "boxes": boxes,
        "rects": [(x1, y1, x2 - x1 + 1, y2 - y1 + 1) for x1, y1, x2, y2 in boxes],
        "slices": [(x1, y1, x2 + 1, y2 + 1) for x1, y1, x2, y2 in boxes],
        "centers": centers,
        "middles": [(x + 0.5, y + 0.5) for x, y in centers],
        "small_boxes": [(x - SMALL, y - SMALL, x + SMALL, y + SMALL) for x, y in centers],
        "flat_polygons": flat(lists["polygons"]),
        "turns": [(start, start + sweep) for start, sweep in turns],
        "triangles": flat(lists["triangles"]),
        **{name: [np.array(one) for one in lists[name]] for name in ("polygons", "regular", "paths", "curves")},
        "checker": Pattern.checker,
        "shades": Gradient((0, 0), (WIDTH, 0)),
        "SMALL": SMALL,
        "LARGE": LARGE,
        "RADIUS": LARGE + 0.5,
        "CORNER": CORNER,
        "ALL_ROUND": ALL_ROUND,
    }


def ngon(x: int, y: int) -> Points:
    """A regular polygon of 12 points around (x, y), at whole pixels."""
    return [
        (x + round(LARGE * math.cos(k * math.pi / 6)), y + round(LARGE * math.sin(k * math.pi / 6))) for k in range(12)
    ]


def flat(lists: list[Points] | list[Halves]) -> list[tuple[float, ...]]:
    """Points as x and y in turn."""
    return [tuple(number for point in points for number in point) for points in lists]


def halves(lists: list[Points]) -> list[Halves]:
    """Points of which a pixel's center is at its half."""
    return [[(x + 0.5, y + 0.5) for x, y in points] for points in lists]


def pillow() -> Names:
    """The box around the arcs, and for its flood fill, which does nothing to an area of its level, levels in turn."""
    from PIL import ImageDraw

    box = (64 - SMALL, 32 - SMALL, 64 + SMALL, 32 + SMALL)
    return canvases.pillow() | {"box": box, "flood": ImageDraw.floodfill, "other": itertools.cycle((1, 0))}


def opencv() -> Names:
    """Points as arrays of 32-bit numbers, each in a list of one contour."""
    made = shapes()
    return canvases.opencv() | {
        "corners": [((x1, y1), (x2, y2)) for x1, y1, x2, y2 in made["boxes"]],
        **{f"int32_{name}": [[np.array(one, np.int32)] for one in lists] for name, lists in made["lists"].items()},
        "center": (64, 32),
        "radii": (SMALL, SMALL),
        "large_radii": (LARGE, LARGE),
    }


def pygame() -> Names:
    """Its rectangles, and lists of points."""
    names, made = canvases.pygame(), shapes()
    return names | {
        "surface_rects": [names["Rect"](*rect) for rect in made["rects"]],
        "point_triangles": made["lists"]["triangles"],
        "point_polygons": made["lists"]["polygons"],
        "point_curves": made["lists"]["curves"],
    }


def cairo() -> Names:
    """Its paths."""
    names, lists = canvases.cairo(), shapes()["lists"]

    def path(points: Halves) -> object:
        (x, y), *rest = points
        names["new_path"](names["soft"])
        names["move_to"](names["soft"], x, y)
        for x, y in rest:
            names["line_to"](names["soft"], x, y)
        made: object = names["copy_path"](names["soft"])
        names["new_path"](names["soft"])
        return made

    return names | {
        **{f"data_{name}": [path(one) for one in halves(lists[name])] for name in ("polygons", "regular", "paths")},
        "radians": [(math.radians(start), math.radians(end)) for start, end in shapes()["turns"]],
    }


def skia() -> Names:
    """Its rectangles and paths."""
    names, made = canvases.skia(), shapes()
    library = names["skia"]

    def paths(name: str, closed: bool) -> list[object]:
        lists = [[library.Point(*point) for point in points] for points in halves(made["lists"][name])]
        return [library.Path.Polygon(points, closed, library.PathFillType.kEvenOdd) for points in lists]

    def curve(points: Halves) -> object:
        made = library.Path()
        made.moveTo(*points[0])
        made.cubicTo(*(number for point in points[1:] for number in point))
        return made

    def oval(r: float) -> object:
        made: object = library.Rect.MakeXYWH(64.5 - r, 32.5 - r, 2 * r, 2 * r)
        return made

    tile = library.Image.fromarray(np.array([[[255] * 4, [0] * 4], [[0] * 4, [255] * 4]], np.uint8))
    repeated = tile.makeShader(library.TileMode.kRepeat, library.TileMode.kRepeat, library.SamplingOptions())
    ends = [library.Point(0, 0), library.Point(WIDTH, 0)]
    shades = library.GradientShader.MakeLinear(ends, [library.ColorBLACK, library.ColorWHITE])
    return names | {
        "checkered": library.Paint(Shader=repeated),
        "shaded": library.Paint(Shader=shades, Dither=True),
        "skia_rects": [library.Rect.MakeXYWH(x, y, w, h) for x, y, w, h in made["rects"]],
        "outlines": [library.Rect.MakeXYWH(x + 0.5, y + 0.5, w - 1, h - 1) for x, y, w, h in made["rects"]],
        "outline": library.Paint(Color=library.ColorWHITE, Style=library.Paint.kStroke_Style, StrokeWidth=1),
        "skia_polygons": paths("polygons", True),
        "skia_regular": paths("regular", True),
        "skia_paths": paths("paths", False),
        "skia_curves": [curve(points) for points in halves(made["lists"]["curves"])],
        "closed_curves": [curve(points).close() for points in halves(made["lists"]["curves"])],
        "oval": oval(LARGE),
        "wide_oval": oval(LARGE + 0.5),
    }


def agg() -> Names:
    """Points of which a pixel's center is at its half, and boxes around the true circles."""
    made = shapes()
    around_centers = [((x - r, y - r, x + r, y + r), r) for x, y in made["middles"] for r in (LARGE, LARGE + 0.5)]
    return canvases.agg() | {
        "ring_boxes": [box for box, r in around_centers if r == LARGE],
        "disc_boxes": [box for box, r in around_centers if r != LARGE],
        "counterclockwise": [(-end, -start) for start, end in made["turns"]],
        "pie_box": (64 - LARGE, 32 - LARGE, 65 + LARGE, 33 + LARGE),
        **{f"agg_{name}": flat(halves(made["lists"][name])) for name in ("polygons", "regular", "paths")},
    }


def blend2d() -> Names:
    """Its structures and views of points."""
    names, made = canvases.blend2d(), shapes()
    ffi, lists = names["ffi"], made["lists"]
    make, view = canvases.blend2d_shapes, canvases.blend2d_points
    sweeps = [(math.radians(start), math.radians(end - start)) for start, end in made["turns"]]
    return names | {
        "circles": make(ffi.BLCircle, [(x, y, LARGE) for x, y in made["middles"]]),
        "discs": make(ffi.BLCircle, [(x, y, LARGE + 0.5) for x, y in made["middles"]]),
        "arcs": make(ffi.BLArc, [(64.5, 32.5, LARGE, LARGE, *sweep) for sweep in sweeps]),
        "pies": make(ffi.BLArc, [(64.5, 32.5, LARGE + 0.5, LARGE + 0.5, *sweep) for sweep in sweeps]),
        "views_polygons": view(ffi, halves(lists["polygons"])),
        "views_regular": view(ffi, halves(lists["regular"])),
        "path_views": view(ffi, halves(lists["paths"])),
    }


def contest(rounds: int) -> Contest:
    """Us and the peers."""
    peers = canvases.PEERS | {
        "Pillow": pillow,
        "OpenCV": opencv,
        "pygame": pygame,
        "cairo": cairo,
        "Skia": skia,
        "AGG": agg,
        "Blend2D": blend2d,
    }
    return Contest(canvases.ours(), peers, rounds, shapes())


def run(rounds: int) -> None:
    """Print the group's rows."""
    contest(rounds).run_all(ROWS)
