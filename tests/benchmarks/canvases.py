"""What is drawn on, 128 x 64 pixels: our framebuffers, and each peer's canvas with the calls that its statements name.

A peer gets the format of pixels that is its fastest, one thread, and no more of Python around its C than it needs: its
colors, points and boxes are made beforehand, and where its wrapper is Python (cairo's, Blend2D's), the C functions
beneath are called.
"""

from __future__ import annotations

import atexit
import ctypes
import os
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from measure import Names

from paneldraw import ConeFilter, Framebuffer, Supersample

WIDTH, HEIGHT = 128, 64

#: The calls of a framebuffer that statements name, after "", "smooth_" or "cone_" for how they are anti-aliased.
CALLS = (
    *("pixel", "hline", "vline", "line", "lines", "polyline", "rect", "round_rect", "circle", "arc", "sector"),
    *("arrow", "bezier", "flood_fill"),
    *("triangle", "poly", "fill", "text", "image", "blit", "scroll"),
)


def memory(*arrays: Any) -> Names:
    """How a test looks at canvases that are arrays, or have their memory in some, and how it wipes them."""
    return {"shown": lambda: [np.array(one) for one in arrays], "wipe": lambda: [one.fill(0) for one in arrays]}


def ours() -> Names:
    """One bit a pixel; and 8 to blend in, anti-aliased one way and the other. `grey` is 8 bits a pixel, aliased."""
    framebuffers = {
        "": Framebuffer(WIDTH, HEIGHT),
        "grey_": Framebuffer(WIDTH, HEIGHT, 8),
        "smooth_": Framebuffer(WIDTH, HEIGHT, 8, antialias=Supersample(4)),
        "cone_": Framebuffer(WIDTH, HEIGHT, 8, antialias=ConeFilter()),
    }
    return {
        **{prefix + call: getattr(fb, call) for prefix, fb in framebuffers.items() for call in CALLS},
        "ConeFilter": ConeFilter,
        **memory(*(fb.pixels for fb in framebuffers.values())),
    }


def numpy() -> Names:
    """An array of a byte a pixel, and what a script that draws on it itself writes."""
    a = np.zeros((HEIGHT, WIDTH), np.uint8)
    return {"a": a, "fill": a.fill, "copyto": np.copyto, "greater": np.greater, **memory(a)}


def pillow() -> Names:
    """An image of one bit a pixel, and one of 8."""
    from PIL import Image, ImageDraw, ImageFont

    image, grey = (Image.new(mode, (WIDTH, HEIGHT)) for mode in "1L")
    draw = ImageDraw.Draw(image)
    shapes = ("line", "rectangle", "rounded_rectangle", "ellipse", "arc", "pieslice", "polygon", "text")
    return {
        **{name: getattr(draw, name) for name in shapes},
        "image": image,
        "core": draw.draw,
        "pixels": image.load(),
        "paste": image.paste,
        "grey_paste": grey.paste,
        "font": ImageFont.load_default_imagefont(),
        "NO_DITHER": Image.Dither.NONE,
        "shown": lambda: [np.array(one, np.uint8) for one in (image, grey)],
        "wipe": lambda: [one.paste(0, (0, 0, WIDTH, HEIGHT)) for one in (image, grey)],
    }


def opencv() -> Names:
    """8 bits a pixel, of which it knows no fewer."""
    import cv2

    cv2.setNumThreads(1)
    canvas = np.zeros((HEIGHT, WIDTH), np.uint8)
    shapes = (
        "line",
        "polylines",
        "rectangle",
        "circle",
        "ellipse",
        "fillPoly",
        "fillConvexPoly",
        "floodFill",
        "arrowedLine",
    )
    return {
        **{name: getattr(cv2, name) for name in (*shapes, "putText", "copyTo", "threshold")},
        "canvas": canvas,
        "AA": cv2.LINE_AA,
        "FONT": cv2.FONT_HERSHEY_SIMPLEX,
        "BINARY": cv2.THRESH_BINARY,
        **memory(canvas),
    }


def pygame() -> Names:
    """A surface of 8 bits a pixel, and a `wide` one of 32: each call is on the one where it is faster.

    Shapes are in two of its modules, of which none is always the faster, so that both are measured.
    """
    import pygame
    import pygame.font
    import pygame.surfarray
    from pygame import gfxdraw

    pygame.font.init()
    surface, wide = (pygame.Surface((WIDTH, HEIGHT), 0, bits) for bits in (8, 32))
    surface.set_palette([(grey, grey, grey) for grey in range(256)])
    shapes = ("line", "rect", "circle", "polygon", "aaline", "aacircle")
    gfx_shapes = ("line", "rectangle", "box", "circle", "hline", "vline", "trigon", "bezier")
    return {
        **{name: getattr(pygame.draw, name) for name in shapes},
        **{f"gfx_{name}": getattr(gfxdraw, name) for name in gfx_shapes},
        "surface": surface,
        "wide": wide,
        "white": pygame.Color("white"),
        "Rect": pygame.Rect,
        "fill": surface.fill,
        "wide_fill": wide.fill,
        "scroll": surface.scroll,
        "blit": surface.blit,
        "set_at": surface.set_at,
        "get_at": surface.get_at_mapped,
        "render": pygame.font.Font(None, 13).render,
        "wide_blit": wide.blit,
        "pygame": pygame,
        "shown": lambda: [pygame.surfarray.array2d(one).T & 255 for one in (surface, wide)],
        "wipe": lambda: [one.fill(0) for one in (surface, wide)],
    }


def cairo() -> Names:
    """8 bits of coverage a pixel; aliased, and anti-aliased the fast way. The C functions, called through cffi."""
    try:
        import cairocffi
        from cairocffi import cairo as library
    except OSError as error:
        raise OSError(f"{str(error).splitlines()[0]}; Debian's libcairo2 brings it") from error

    kinds = {
        "hard": (cairocffi.ANTIALIAS_NONE, 1),
        "soft": (cairocffi.ANTIALIAS_FAST, 1),
        "thick": (cairocffi.ANTIALIAS_FAST, 3),
    }
    contexts = {}
    for kind, (antialias, width) in kinds.items():
        contexts[kind] = context = cairocffi.Context(cairocffi.ImageSurface(cairocffi.FORMAT_A8, WIDTH, HEIGHT))
        context.set_source_rgba(1, 1, 1, 1)
        context.set_line_width(width)
        context.set_antialias(antialias)
        context.set_fill_rule(cairocffi.FILL_RULE_EVEN_ODD)
    calls = ("move_to", "line_to", "arc", "new_path", "append_path", "copy_path", "stroke", "fill")
    views = [np.frombuffer(one.get_target().get_data(), np.uint8).reshape(HEIGHT, -1) for one in contexts.values()]
    return {
        **{name: getattr(library, f"cairo_{name}") for name in calls},
        **{kind: context._pointer for kind, context in contexts.items()},
        "contexts": contexts,
        **memory(*views),
    }


def skia() -> Names:
    """8 bits of grey a pixel."""
    import skia

    info = skia.ImageInfo.Make(WIDTH, HEIGHT, skia.kGray_8_ColorType, skia.kOpaque_AlphaType)
    pixels = np.zeros((HEIGHT, WIDTH), np.uint8)
    surface = skia.Surface.MakeRasterDirect(info, pixels, WIDTH)
    canvas = surface.getCanvas()
    calls = ("drawLine", "drawPoints", "drawRect", "drawRoundRect", "drawCircle", "drawArc", "drawPath")

    def paint(antialias: bool, width: int | None = None) -> Any:
        stroked = {} if width is None else {"Style": skia.Paint.kStroke_Style, "StrokeWidth": width}
        return skia.Paint(AntiAlias=antialias, Color=skia.ColorWHITE, **stroked)

    return {
        **{call: getattr(canvas, call) for call in calls},
        "surface": surface,
        "skia": skia,
        "LINES": skia.Canvas.PointMode.kLines_PointMode,
        "hairline": paint(False, 0),
        "filled": paint(False),
        "covered": skia.Paint(Color=skia.ColorWHITE, Style=skia.Paint.kStrokeAndFill_Style, StrokeWidth=1),
        "smooth": paint(True),
        "thin": paint(True, 1),
        "wide": paint(True, 3),
        **memory(pixels),
    }


def agg() -> Names:
    """8 bits of grey a pixel; aliased and anti-aliased."""
    import aggdraw

    hard, soft = (aggdraw.Draw("L", (WIDTH, HEIGHT)) for _ in range(2))
    hard.setantialias(False)
    return {
        "hard_line": hard.line,
        "line": soft.line,
        "ellipse": soft.ellipse,
        "polygon": soft.polygon,
        "pieslice": soft.pieslice,
        "thin": aggdraw.Pen(255, 1),
        "wide": aggdraw.Pen(255, 3),
        "brush": aggdraw.Brush(255),
        "shown": lambda: [np.frombuffer(one.tobytes(), np.uint8).reshape(HEIGHT, WIDTH) for one in (hard, soft)],
        "wipe": lambda: [one.clear(0) for one in (hard, soft)],
    }


def blend2d() -> Names:
    """8 bits of coverage a pixel; it knows no aliased drawing. The C functions, called through ctypes."""
    try:
        from blend2d import Context, FillRule, Format, GeometryType, Image, ffi
    except RuntimeError as error:  # the package is there, and its library is for another machine
        raise OSError(*error.args) from error

    names: Names = {kind.name: int(kind) for kind in GeometryType}
    views = []
    for prefix, width in (("thin", 1.0), ("wide", 3.0)):
        image = Image(WIDTH, HEIGHT, Format.A8)
        context = Context(image)
        context.set_fill_style(0xFFFFFFFF)
        context.set_stroke_style(0xFFFFFFFF)
        context.stroke_width = width
        context.fill_rule = FillRule.EVEN_ODD
        names[f"{prefix}_objects"] = image, context
        views.append(np.frombuffer(image.buffer, np.uint8).reshape(HEIGHT, -1))
        names[prefix] = ctypes.byref(context._core)
    return names | {
        "ffi": ffi,
        "fill": ffi.bl.bl_context_fill_geometry,
        "stroke": ffi.bl.bl_context_stroke_geometry,
        **memory(*views),
    }


def blend2d_shapes(make: Callable[..., ctypes.Structure], rows: Sequence[Sequence[float]]) -> list[Any]:
    """Blend2D's structures for rows of numbers, ready to be passed on."""
    return [ctypes.byref(make(*row)) for row in rows]


def blend2d_points(ffi: Any, paths: Sequence[Sequence[tuple[float, float]]]) -> list[Any]:
    """Blend2D's views of the points of polygons or polylines, ready to be passed on."""
    views = []
    for path in paths:
        numbers = np.array(path, float)
        view = ffi.BLArrayView(numbers.ctypes.data, len(numbers))
        view.numbers = numbers  # to keep the memory
        views.append(ctypes.byref(view))
    return views


def numba() -> Names:
    """Bresenham's loop, compiled: a line a call, and a table of lines. Nothing is clipped and nothing checked."""
    from numba import njit

    @njit("void(u1[:, ::1], i8, i8, i8, i8, u1)")  # type: ignore[misc, unused-ignore]
    def line(a: Any, x1: int, y1: int, x2: int, y2: int, level: int) -> None:
        dx, dy = abs(x2 - x1), abs(y2 - y1)
        step_x = 1 if x1 < x2 else -1
        step_y = 1 if y1 < y2 else -1
        x, y = x1, y1
        if dx >= dy:
            p = 2 * dy - dx
            for _ in range(dx + 1):
                a[y, x] = level
                if p > 0:
                    y += step_y
                    p -= 2 * dx
                x += step_x
                p += 2 * dy
        else:
            p = 2 * dx - dy
            for _ in range(dy + 1):
                a[y, x] = level
                if p > 0:
                    x += step_x
                    p -= 2 * dy
                y += step_y
                p += 2 * dx

    @njit("void(u1[:, ::1], i8[:, ::1], u1)")  # type: ignore[misc, unused-ignore]
    def lines(a: Any, table: Any, level: int) -> None:
        for k in range(table.shape[0]):
            line(a, table[k, 0], table[k, 1], table[k, 2], table[k, 3], level)

    a = np.zeros((HEIGHT, WIDTH), np.uint8)
    return {"a": a, "line": line, "lines": lines, **memory(a)}


def floor() -> Names:
    """The textbook's loop in C, ``floor.c``, compiled by the system's compiler and called through ctypes."""
    compiler = shlex.split(os.environ.get("CC", "cc"))
    if shutil.which(compiler[0]) is None:
        raise FileNotFoundError(f"there is no C compiler {compiler[0]!r}")
    with tempfile.TemporaryDirectory() as folder:
        library = Path(folder) / "floor.so"
        source = Path(__file__).with_name("floor.c")
        command = [*compiler, "-O3", "-shared", "-fPIC", "-o", str(library), str(source)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise OSError(f"{shlex.join(compiler)} cannot compile {source.name}: {done.stderr.strip()}")
        lines = ctypes.CDLL(str(library)).lines
    canvas = np.zeros((HEIGHT, WIDTH), np.uint8)
    lines.argtypes = (ctypes.c_void_p, ctypes.c_int, ctypes.c_void_p, ctypes.c_int, ctypes.c_int)
    lines.restype = None
    return {"lines": lines, "pixels": canvas.ctypes.data, **memory(canvas)}


def framebuf() -> Names:
    """Adafruit's framebuf in Python, the format of an SSD1306, with our font in its file format."""
    import adafruit_framebuf

    from paneldraw.text import Font

    pages = np.zeros((HEIGHT // 8, WIDTH), np.uint8)
    buffer = adafruit_framebuf.FrameBuffer(memoryview(pages).cast("B"), WIDTH, HEIGHT, adafruit_framebuf.MVLSB)
    font = Font.builtin()
    columns = bytearray((font.width, font.height))
    for code in range(256):
        glyph = np.zeros((font.height, font.width), bool)
        # A soft hyphen has no columns.
        lit = font.glyph(chr(code))[:, : font.width] > 0
        glyph[:, : lit.shape[1]] = lit
        columns += np.packbits(glyph, axis=0, bitorder="little").tobytes()
    folder = tempfile.TemporaryDirectory()
    atexit.register(folder.cleanup)
    path = Path(folder.name) / "font5x8.bin"
    path.write_bytes(columns)
    calls = ("pixel", "hline", "vline", "line", "rect", "fill_rect", "circle", "fill", "scroll", "text", "image")
    return {
        **{name: getattr(buffer, name) for name in calls},
        "FONT": str(path),
        "shown": lambda: [np.unpackbits(pages[:, np.newaxis], axis=1, bitorder="little").reshape(HEIGHT, WIDTH)],
        "wipe": lambda: pages.fill(0),
    }


PEERS: dict[str, Callable[[], Names]] = {
    "Pillow": pillow,
    "OpenCV": opencv,
    "pygame": pygame,
    "cairo": cairo,
    "Skia": skia,
    "AGG": agg,
    "Blend2D": blend2d,
    "numba": numba,
    "numpy": numpy,
    "C": floor,
    "framebuf": framebuf,
}
