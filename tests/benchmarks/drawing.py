"""Drawing random shapes on 128 x 64, against Pillow, OpenCV, Skia and AGG."""

from __future__ import annotations

import random

import numpy as np
from measure import Against, Contest, Names, Row

from paneldraw import ConeFilter, Framebuffer, Supersample

WIDTH, HEIGHT = 128, 64
N = 500

EACH = "for x1, y1, x2, y2 in segments: "
ENDS = "for p, q in ends: "
CENTERS = "for x, y in centers: "

ROWS = [
    Row(
        "line, one call a line",
        N,
        EACH + "line(x1, y1, x2, y2)",
        (
            Against("Pillow", "for segment in segments: line(segment, 1)", 4),
            Against("OpenCV", ENDS + "line(canvas, p, q, 255)", 4),
        ),
    ),
    Row(
        "lines, one call",
        N,
        "fb.lines(table)",
        (
            Against("OpenCV", "cv2.polylines(canvas, pairs, False, 255)", 5),
            Against("OpenCV, a list", "cv2.polylines(canvas, listed_pairs, False, 255)"),
        ),
    ),
    Row(
        "line, Supersample(4)",
        N,
        EACH + "smooth_line(x1, y1, x2, y2)",
        (
            Against("OpenCV", ENDS + "line(canvas, p, q, 255, 1, AA)", 1),
            Against("Skia", EACH + "line(x1, y1, x2, y2, thin)", 3),
            Against("AGG", "for segment in segments: line(segment, thin)", 3),
        ),
    ),
    Row(
        "line, width 3, Supersample(4)",
        N,
        EACH + "smooth_line(x1, y1, x2, y2, width=3)",
        (
            Against("OpenCV", ENDS + "line(canvas, p, q, 255, 3, AA)", 1.5),
            Against("Skia", EACH + "line(x1, y1, x2, y2, wide)"),
            Against("AGG", "for segment in segments: line(segment, wide)"),
        ),
    ),
    Row(
        "lines, one call, Supersample(4)",
        N,
        "smooth.lines(table)",
        (Against("OpenCV", "cv2.polylines(canvas, pairs, False, 255, 1, AA)", 1.2),),
    ),
    Row(
        "line, ConeFilter()",
        N,
        EACH + "cone_line(x1, y1, x2, y2)",
        (
            Against("OpenCV", ENDS + "line(canvas, p, q, 255, 1, AA)"),
            Against("Skia", EACH + "line(x1, y1, x2, y2, thin)", 2),
        ),
    ),
    Row(
        "circle, r 12",
        N,
        CENTERS + "circle(x, y, 12)",
        (
            Against("Pillow", "for box in boxes: ellipse(box, outline=1)", 3),
            Against("OpenCV", "for center in centers: circle(canvas, center, 12, 255)"),
        ),
    ),
    Row(
        "disc, r 12",
        N,
        CENTERS + "circle(x, y, 12, 1, True)",
        (
            Against("Pillow", "for box in boxes: ellipse(box, fill=1)"),
            Against("OpenCV", "for center in centers: circle(canvas, center, 12, 255, -1)", 1.5),
        ),
    ),
    Row(
        "filled polygon, 12 points",
        len(range(0, 2 * N - 12, 12)),
        "for table in polygons: poly(0, 0, table, 1, True)",
        (
            Against("Pillow", "for corners in listed_polygons: polygon(corners, 1)", 1.5),
            Against("OpenCV", "for table in int32_polygons: cv2.fillPoly(canvas, table, 255)", 1.5),
        ),
    ),
]


def names() -> Names:
    """The shapes in every form that a statement wants, and our framebuffers: 1 bit a pixel, and 8 to blend in."""
    pick = random.Random(1)
    points = [(pick.randrange(WIDTH), pick.randrange(HEIGHT)) for _ in range(2 * N)]
    ends = list(zip(points[::2], points[1::2], strict=True))
    segments = [p + q for p, q in ends]
    centers = points[::2]
    polygons = [points[k : k + 12] for k in range(0, 2 * N - 12, 12)]
    fb = Framebuffer(WIDTH, HEIGHT)
    smooth = Framebuffer(WIDTH, HEIGHT, 8, antialias=Supersample(4))
    cone = Framebuffer(WIDTH, HEIGHT, 8, antialias=ConeFilter())
    return {
        "ends": ends,
        "segments": segments,
        "centers": centers,
        "boxes": [(x - 12, y - 12, x + 12, y + 12) for x, y in centers],
        "table": np.array(segments),
        "polygons": [np.array(corners) for corners in polygons],
        "listed_polygons": polygons,
        "fb": fb,
        "line": fb.line,
        "circle": fb.circle,
        "smooth": smooth,
        "smooth_line": smooth.line,
        "cone_line": cone.line,
        "poly": fb.poly,
    }


def pillow() -> Names:
    """An image of one bit a pixel."""
    from PIL import Image, ImageDraw

    draw = ImageDraw.Draw(Image.new("1", (WIDTH, HEIGHT)))
    return {"line": draw.line, "ellipse": draw.ellipse, "polygon": draw.polygon}


def opencv() -> Names:
    """One thread; 8 bits a pixel, of which it knows no fewer."""
    import cv2

    cv2.setNumThreads(1)
    shapes = names()
    pairs = np.array(shapes["segments"], np.int32).reshape(-1, 2, 2)
    return {
        "cv2": cv2,
        "canvas": np.zeros((HEIGHT, WIDTH), np.uint8),
        "line": cv2.line,
        "circle": cv2.circle,
        "AA": cv2.LINE_AA,
        "pairs": pairs,
        "listed_pairs": list(pairs),
        "int32_polygons": [[corners.astype(np.int32)] for corners in shapes["polygons"]],
    }


def skia() -> Names:
    """8 bits of grey a pixel."""
    import skia

    info = skia.ImageInfo.Make(WIDTH, HEIGHT, skia.kGray_8_ColorType, skia.kOpaque_AlphaType)
    surface = skia.Surface.MakeRaster(info)
    thin, wide = (
        skia.Paint(AntiAlias=True, Color=skia.ColorWHITE, Style=skia.Paint.kStroke_Style, StrokeWidth=width)
        for width in (1, 3)
    )
    return {"surface": surface, "line": surface.getCanvas().drawLine, "thin": thin, "wide": wide}


def agg() -> Names:
    """8 bits of grey a pixel."""
    import aggdraw

    draw = aggdraw.Draw("L", (WIDTH, HEIGHT))
    return {"draw": draw, "line": draw.line, "thin": aggdraw.Pen(255, 1), "wide": aggdraw.Pen(255, 3)}


def run(rounds: int) -> None:
    """Print the group's rows."""
    peers = {"Pillow": pillow, "OpenCV": opencv, "OpenCV, a list": opencv, "Skia": skia, "AGG": agg}
    contest = Contest(names(), peers, rounds)
    for row in ROWS:
        contest.run(row)
