"""Pixels and pictures on 128 x 64: single ones, rows and columns of them, blocks that are filled, moved and copied."""

from __future__ import annotations

import random
from itertools import cycle, islice

import canvases
import numpy as np
from canvases import HEIGHT, WIDTH
from measure import Against, Contest, Names, Row

from paneldraw import Framebuffer

N = 500
FEW = 20
SIDE = 16

POINTS = "for x, y in points: "
SPOTS = "for point in points: "
PLACES = "for x, y in places: "
WINDOWS = "for x1, y1, x2, y2 in windows: "
PICTURES = "for one in pictures: "


def rows_and_columns(call: str, where: str) -> Row:
    """A horizontal or a vertical line."""
    line = "line(canvas, p, q, 255)"
    part = "a[y1, x1:x2] = 1" if call == "hline" else "a[y1:y2, x1] = 1"
    ends = "x1, x2, y" if call == "hline" else "x, y1, y2"
    return Row(
        call,
        N,
        f"for x, y, size in {where}: {call}(x, y, size, 1)",
        (
            Against("numpy", f"for x1, y1, x2, y2 in {where}_slices: {part}"),
            Against("pygame", f"for rect in {where}_rects: fill(255, rect)"),
            Against("pygame", f"for {ends} in {where}_ends: gfx_{call}(wide, {ends}, white)", how="gfxdraw"),
            Against("Pillow", f"for segment in {where}_segments: line(segment, 1)"),
            Against("OpenCV", f"for p, q in {where}_points: {line}"),
            Against("framebuf", f"for x, y, size in {where}: {call}(x, y, size, 1)"),
        ),
        fastest=1,
    )


ROWS = [
    Row(
        "pixel, write",
        N,
        POINTS + "pixel(x, y, 1)",
        (
            Against("numpy", POINTS + "a[y, x] = 1", 2),
            Against("Pillow", SPOTS + "pixels[point] = 1"),
            Against("pygame", SPOTS + "set_at(point, 255)"),
            Against("framebuf", POINTS + "pixel(x, y, 1)"),
        ),
    ),
    Row(
        "pixel, read",
        N,
        POINTS + "pixel(x, y)",
        (
            Against("numpy", POINTS + "a[y, x]", 2),
            Against("Pillow", SPOTS + "pixels[point]"),
            Against("pygame", SPOTS + "get_at(point)"),
            Against("framebuf", POINTS + "pixel(x, y)"),
        ),
    ),
    rows_and_columns("hline", "rows"),
    rows_and_columns("vline", "columns"),
    Row(
        "fill",
        N,
        "for level in levels: fill(level)",
        (
            Against("numpy", "for level in levels: fill(level)"),
            Against("pygame", "for level in levels: fill(level, area)"),
            Against("pygame", "for level in levels: wide_fill(level)", how="32 bits"),
            Against("Pillow", "for level in levels: paste(level, area)"),
            Against("framebuf", "for level in levels: fill(level)"),
        ),
        fastest=1,
    ),
    Row(
        "scroll",
        FEW,
        "for dx, dy in steps: scroll(dx, dy)",
        (
            Against("numpy", "for there, here in moves: a[there] = a[here]"),
            Against("pygame", "for dx, dy in steps: scroll(dx, dy)"),
            Against("framebuf", "for dx, dy in steps: scroll(dx, dy)"),
        ),
        fastest=1,
    ),
    Row(
        f"blit, {SIDE} x {SIDE}",
        N,
        PLACES + "blit(stamp, x, y)",
        (
            Against("numpy", WINDOWS + "a[y1:y2, x1:x2] = stamp"),
            Against("pygame", "for place in places: blit(stamp, place)"),
            Against("Pillow", "for place in places: paste(stamp, place)"),
            Against("OpenCV", WINDOWS + "copyTo(stamp, None, canvas[y1:y2, x1:x2])"),
        ),
        fastest=1,
    ),
    Row(
        f"blit, {SIDE} x {SIDE}, a key",
        N,
        PLACES + "blit(stamp, x, y, 0)",
        (
            Against("numpy", WINDOWS + "copyto(a[y1:y2, x1:x2], stamp, where=mask)"),
            Against("pygame", "for place in places: blit(keyed, place)"),
            Against("Pillow", "for place in places: paste(stamp, place, mask)"),
            Against("OpenCV", WINDOWS + "copyTo(stamp, mask, canvas[y1:y2, x1:x2])"),
        ),
        fastest=1,
    ),
    Row(
        f"blit, {WIDTH} x {HEIGHT}",
        FEW,
        PICTURES + "blit(one, 0, 0)",
        (
            Against("numpy", PICTURES + "a[:] = one"),
            Against("pygame", PICTURES + "blit(one, origin)"),
            Against("Pillow", PICTURES + "paste(one)"),
            Against("OpenCV", PICTURES + "copyTo(one, None, canvas)"),
        ),
        fastest=1,
    ),
    Row(
        "image, an array of grays on 8 bits",
        FEW,
        "for one in gray_arrays: grey_image(one)",
        (
            Against("numpy", "for one in gray_arrays: a[:] = one"),
            Against("OpenCV", "for one in gray_arrays: copyTo(one, None, canvas)"),
        ),
        fastest=1,
    ),
    Row(
        "image, an array of grays on 1 bit",
        FEW,
        "for one in gray_arrays: image(one)",
        (
            Against("numpy", "for one in gray_arrays: greater(one, 127, a)"),
            Against("OpenCV", "for one in gray_arrays: threshold(one, 127, 1, BINARY, canvas)"),
        ),
        fastest=1,
    ),
    Row(
        "image, an array of bool on 1 bit",
        FEW,
        "for one in bool_arrays: image(one)",
        (Against("numpy", "for one in bool_arrays: a[:] = one"),),
        fastest=1,
    ),
    Row(
        "image, Pillow's L on 8 bits",
        FEW,
        "for one in gray_images: grey_image(one)",
        (
            Against("Pillow", "for one in gray_images: grey_paste(one)"),
            Against("numpy", "for one in gray_images: a[:] = one"),
        ),
        fastest=1,
    ),
    Row(
        "image, Pillow's L on 1 bit",
        FEW,
        "for one in gray_images: image(one)",
        (
            Against("Pillow", 'for one in gray_images: paste(one.convert("1", dither=NO_DITHER))'),
            Against("numpy", "for one in gray_images: greater(one, 127, a)"),
        ),
        fastest=1,
    ),
    Row(
        "image, Pillow's 1 on 1 bit",
        FEW,
        "for one in bit_images: image(one)",
        (
            Against("Pillow", "for one in bit_images: paste(one)"),
            Against("numpy", "for one in bit_images: a[:] = one"),
            Against("framebuf", "for one in bit_images: image(one)"),
        ),
        fastest=1,
    ),
]


def shapes() -> Names:
    """Where things are drawn, and pictures as arrays and as Pillow's images, which all of us take."""
    from PIL import Image

    pick = random.Random(1)
    points = [(pick.randrange(WIDTH), pick.randrange(HEIGHT)) for _ in range(N)]
    places = [(pick.randrange(WIDTH - SIDE), pick.randrange(HEIGHT - SIDE)) for _ in range(N)]
    grays = np.random.default_rng(1).integers(0, 256, (FEW, HEIGHT, WIDTH), np.uint8)
    gray_images = [Image.fromarray(gray) for gray in grays]
    return {
        "points": points,
        "places": places,
        "windows": [(x, y, x + SIDE, y + SIDE) for x, y in places],
        **spans("rows", [(x, y, pick.randrange(1, WIDTH - x + 1), 1) for x, y in points]),
        **spans("columns", [(x, y, 1, pick.randrange(1, HEIGHT - y + 1)) for x, y in points]),
        "levels": list(islice(cycle((0, 1)), N)),
        "area": (0, 0, WIDTH, HEIGHT),
        "origin": (0, 0),
        "steps": [(pick.randint(-5, 5), pick.randint(-5, 5)) for _ in range(FEW)],
        "gray_arrays": list(grays),
        "bool_arrays": list(grays > 127),
        "gray_images": gray_images,
        "bit_images": [image.convert("1", dither=Image.Dither.NONE) for image in gray_images],
    }


def spans(name: str, rects: list[tuple[int, int, int, int]]) -> Names:
    """Rows or columns of pixels in the forms that calls want."""
    flat = name == "rows"
    last = [(x, y, x + w - 1, y + h - 1) for x, y, w, h in rects]
    return {
        name: [(x, y, w if flat else h) for x, y, w, h in rects],
        f"{name}_rects": rects,
        f"{name}_slices": [(x, y, x + w, y + h) for x, y, w, h in rects],
        f"{name}_segments": last,
        f"{name}_points": [((x1, y1), (x2, y2)) for x1, y1, x2, y2 in last],
        f"{name}_ends": [(x1, x2, y1) if flat else (x1, y1, y2) for x1, y1, x2, y2 in last],
    }


def stamp() -> np.typing.NDArray[np.uint8]:
    """A small picture: half of its pixels are lit."""
    lit: np.typing.NDArray[np.uint8] = np.random.default_rng(2).integers(0, 2, (SIDE, SIDE), np.uint8)
    return lit


def ours() -> Names:
    """Framebuffers to copy."""
    small = Framebuffer(SIDE, SIDE)
    small.pixels[:] = stamp()
    pictures = [Framebuffer(WIDTH, HEIGHT) for _ in range(FEW)]
    for fb, picture in zip(pictures, shapes()["bool_arrays"], strict=True):
        fb.pixels[:] = picture
    return canvases.ours() | {"stamp": small, "pictures": pictures}


def numpy() -> Names:
    """Arrays to copy, and the slices that a scroll moves."""
    made = shapes()

    def part(step: int, size: int) -> slice:
        return slice(max(step, 0), size + min(step, 0))

    moves = [((part(dy, HEIGHT), part(dx, WIDTH)), (part(-dy, HEIGHT), part(-dx, WIDTH))) for dx, dy in made["steps"]]
    pictures = [picture.astype(np.uint8) for picture in made["bool_arrays"]]
    return canvases.numpy() | {
        "stamp": stamp(),
        "mask": stamp() > 0,
        "moves": moves,
        "pictures": pictures,
    }


def pillow() -> Names:
    """Images of one bit a pixel to copy."""
    from PIL import Image

    small = Image.fromarray(stamp() > 0)
    return canvases.pillow() | {"stamp": small, "mask": small, "pictures": shapes()["bit_images"]}


def opencv() -> Names:
    """Arrays to copy."""
    pictures = [picture.astype(np.uint8) for picture in shapes()["bool_arrays"]]
    return canvases.opencv() | {"stamp": stamp(), "mask": stamp(), "pictures": pictures}


def pygame() -> Names:
    """Surfaces of the format of the one that they are copied to."""
    names = canvases.pygame()
    surface = names["surface"]

    def copy(picture: np.typing.NDArray[np.uint8]) -> object:
        made = names["pygame"].Surface(picture.shape[::-1], 0, surface)
        made.set_palette(surface.get_palette())
        for y, x in np.argwhere(picture).tolist():
            made.set_at((x, y), 255)
        return made

    small, keyed = copy(stamp()), copy(stamp())
    keyed.set_colorkey(0)  # type: ignore[attr-defined]
    return names | {"stamp": small, "keyed": keyed, "pictures": [copy(one) for one in shapes()["bool_arrays"]]}


def contest(rounds: int) -> Contest:
    """Us and the peers."""
    peers = canvases.PEERS | {"numpy": numpy, "Pillow": pillow, "OpenCV": opencv, "pygame": pygame}
    return Contest(ours(), peers, rounds, shapes())


def run(rounds: int) -> None:
    """Print the group's rows."""
    contest(rounds).run_all(ROWS)
