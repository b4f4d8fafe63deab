"""Writing text on 128 x 64; no string comes twice in 10 000, but where the row says so.

U8g2's C, ab9e48b of its repository built by gcc -O2 for a machine that takes 1.4 us here, takes 4.4 us for 21
characters of its 6x10 font, and 5.7 us with their background.
"""

from __future__ import annotations

import random
from functools import partial
from itertools import cycle, islice

import canvases
from canvases import HEIGHT, WIDTH
from measure import Against, Contest, Names, Row
from PIL import ImageFont

from paneldraw import Font

N = 100
STRINGS = 10_000

EACH = "for x, y, s in take(): "
POINTS = "for point, s in take_points(): "

LINES = "for x, y, s in take_lines(): "
LINE_POINTS = "for point, s in take_line_points(): "

PEERS = (
    Against("Pillow", POINTS + "text(point, s, 1, font)", 3),
    Against("Pillow", POINTS + "draw_bitmap(point, getmask(s), 1)", how="its core"),
    Against("OpenCV", POINTS + "putText(canvas, s, point, FONT, 0.4, 255)"),
    Against("pygame", POINTS + "wide_blit(render(s, False, white), point)"),
    Against("framebuf", EACH + "text(s, x, y, 1, font_name=FONT)"),
)

ROWS = [
    Row("text, 13 characters", N, EACH + "text(s, x, y)", PEERS),
    Row(
        "text, 21 characters",
        N,
        LINES + "text(s, x, y)",
        (Against("Pillow", LINE_POINTS + "text(point, s, 1, font)", 3),),
    ),
    Row(
        "text, 21 characters in Pillow's bitmap font",
        N,
        LINES + "text(s, x, y, font=BITMAPS)",
        (Against("Pillow", LINE_POINTS + "text(point, s, 1, font)", 3),),
    ),
    Row(
        "text, 13 characters, always the same",
        N,
        "for x, y in places: text('21.5 \\xb0C 48 %', x, y)",
        (Against("Pillow", "for point in places: text(point, '21.5 \\xb0C 48 %', 1, font)"),),
    ),
    Row(
        "text, 13 characters on 8 bits",
        N,
        EACH + "grey_text(s, x, y)",
        (Against("Pillow", POINTS + "text(point, s, 1, font)"),),
    ),
]


def shapes() -> Names:
    """Strings and where they go, endless."""
    pick = random.Random(1)
    places = [(pick.randrange(WIDTH - 78), pick.randrange(HEIGHT - 11)) for _ in range(STRINGS)]
    strings = [f"{k:04d}: {pick.randrange(10**6):6d}m" for k in range(STRINGS)]
    rows = [(x, y, s) for (x, y), s in zip(places, strings, strict=True)]
    lines = [(x % 8, y, f"{s} {pick.randrange(10**6):6d}") for x, y, s in rows]
    return {
        "places": places[:N],
        "take": partial(islice, cycle(rows), N),
        "take_lines": partial(islice, cycle(lines), N),
        "take_line_points": partial(islice, cycle([((x, y), s) for x, y, s in lines]), N),
        "take_points": partial(islice, cycle(zip(places, strings, strict=True)), N),
    }


def pillow() -> Names:
    """What ``ImageDraw.text`` comes down to."""
    names = canvases.pillow()
    return names | {"draw_bitmap": names["core"].draw_bitmap, "getmask": names["font"].getmask}


def ours() -> Names:
    """Our calls, and Pillow's bitmap font as one of ours."""
    return canvases.ours() | {"BITMAPS": Font.from_pillow(ImageFont.load_default_imagefont())}


def contest(rounds: int) -> Contest:
    """Us and the peers."""
    return Contest(ours(), canvases.PEERS | {"Pillow": pillow}, rounds, shapes())


def run(rounds: int) -> None:
    """Print the group's rows."""
    contest(rounds).run_all(ROWS)
