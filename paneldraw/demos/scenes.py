"""Ten scenes as small panels show them, for counting what an update costs.

A scene is a function from a framebuffer of 128 x 64 and a frame's number to pixels. It draws the whole picture, keeps
no state, and moves as its kind does: a clock has one frame a second, the others have thirty.

>>> from paneldraw import Framebuffer
>>> from paneldraw.demos.scenes import SCENES
>>> fb = Framebuffer(128, 64)
>>> SCENES["stopwatch"](fb, 45)
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from .. import Framebuffer
from ..text import Font
from . import clock as clock_demo
from . import cube as cube_demo

Scene = Callable[[Framebuffer, int], None]

WIDTH: Final = 128
HEIGHT: Final = 64
RATE: Final = 30
"""Frames a second, but for the clock's."""


def ball(fb: Framebuffer, frame: int) -> None:
    """A ball bounces about a box."""
    fb.clear()
    fb.rect(0, 0, WIDTH, HEIGHT)
    radius = 5
    fb.circle(
        radius + 2 + _bounce(20 + 2 * frame, WIDTH - 2 * radius - 5),
        radius + 2 + _bounce(7 + frame, HEIGHT - 2 * radius - 5),
        radius,
        fill=True,
    )


def clock(fb: Framebuffer, frame: int) -> None:
    """A second hand moves on, once a frame, and so do the figures beside it."""
    clock_demo.draw(fb, 10 * 3600 + 9 * 60 + frame)


def stopwatch(fb: Framebuffer, frame: int) -> None:
    """Large figures run, to hundredths of a second; the last lap stands below."""
    fb.clear()
    fb.text("STOPWATCH", 64, 2, anchor="mt")
    fb.hline(0, 12, WIDTH)
    hundredths = 100 * frame // RATE
    minutes, rest = divmod(hundredths, 6000)
    fb.text(f"{minutes:02}:{rest // 100:02}.{rest % 100:02}", 64, 34, font=Font.builtin().scaled(2), anchor="mm")
    fb.text("lap 1  00:41.87", 64, 62, anchor="mb")


NEWS: Final = "Trains to the harbor leave from platform 4 today  *  Sunny, 21 degrees, light wind from the west  *  "


def ticker(fb: Framebuffer, frame: int) -> None:
    """A line of news runs through the foot of a page that stands."""
    fb.clear()
    fb.text("CENTRAL STATION", 64, 2, anchor="mt")
    fb.hline(0, 12, WIDTH)
    fb.text("12:04  Harbor     4\n12:11  Airport    1\n12:19  Old town   2", 4, 18)
    x = -(2 * frame % (6 * len(NEWS)))
    fb.text(NEWS + NEWS, x, 54)


def graph(fb: Framebuffer, frame: int) -> None:
    """A measured curve moves through its axes, a column a frame; the last value stands above."""
    fb.clear()
    left, top, bottom = 20, 12, 62
    fb.vline(left, top, bottom - top + 1)
    fb.hline(left, bottom, WIDTH - left)
    for value in (0, 50, 100):
        y = bottom - value * (bottom - top) // 100
        fb.hline(left - 2, y, 2)
        fb.text(str(value), left - 3, min(max(y, 15), 59), anchor="rm")
    xs = range(left + 1, WIDTH)
    values = [_measured(frame + x) for x in xs]
    fb.polyline([(x, bottom - 1 - value * (bottom - top - 1) / 100) for x, value in zip(xs, values, strict=True)])
    fb.text(f"load {values[-1]:3.0f} %", WIDTH - 1, 0, anchor="rt")


def progress(fb: Framebuffer, frame: int) -> None:
    """A bar fills in four seconds, and says how far it is."""
    fb.clear()
    share = min(frame / 120, 1)
    fb.text("Updating firmware", 64, 8, anchor="mt")
    fb.rect(4, 28, 120, 12)
    fb.rect(6, 30, int(116 * share), 8, fill=True)
    fb.text(f"{int(100 * share)} %", 64, 46, anchor="mt")


def wire_cube(fb: Framebuffer, frame: int) -> None:
    """A cube of lines turns."""
    cube_demo.draw(fb, frame / RATE)


ENTRIES: Final = ("Brightness", "Contrast", "Wi-Fi", "Bluetooth", "Language", "Date and time", "Sound", "About")
SHOWN: Final = 5


def menu(fb: Framebuffer, frame: int) -> None:
    """A bar steps through a list three times a second; the list scrolls to keep it in sight."""
    fb.clear()
    fb.text("SETTINGS", 2, 1)
    fb.hline(0, 10, WIDTH)
    chosen = _bounce(frame // (RATE // 3), len(ENTRIES) - 1)
    first = min(max(chosen - SHOWN // 2, 0), len(ENTRIES) - SHOWN)
    for line, entry in enumerate(ENTRIES[first : first + SHOWN]):
        fb.text(entry, 4, 13 + 10 * line)
        if first + line == chosen:
            fb.rect(0, 12 + 10 * line, 122, 10, fill=True, op="xor")
    fb.vline(126, 12, 50)
    fb.rect(125, 12 + 50 * first // len(ENTRIES), 3, 50 * SHOWN // len(ENTRIES), fill=True)


def spectrum(fb: Framebuffer, frame: int) -> None:
    """Sixteen bars jump with music and fall back, each under a cap that falls more slowly."""
    fb.clear()
    for band in range(16):
        level, cap = (max(_beat(band, frame - ago) - fall * ago for ago in range(24)) for fall in (4, 1))
        fb.rect(8 * band, HEIGHT - level, 6, level, fill=True)
        fb.hline(8 * band, HEIGHT - 2 - cap, 6)


LETTER: Final = "Dear all,\nthe panel is up and\nruns. It shows what\nis typed as it is\ntyped. Best, Ada"


def cursor(fb: Framebuffer, frame: int) -> None:
    """A text is typed, six characters and a rest each second; the cursor blinks nearly twice a second."""
    fb.clear()
    fb.text("note.txt", 0, 0)
    fb.hline(0, 9, WIDTH)
    typed = LETTER[: 34 + frame // 30 * 6 + min(frame % 30, 18) // 3]
    lines = typed.split("\n")
    fb.text(typed, 0, 14)
    if frame % 16 < 8:
        fb.rect(6 * len(lines[-1]), 14 + 8 * (len(lines) - 1), 5, 8, fill=True)


SCENES: Final[dict[str, Scene]] = {
    "ball": ball,
    "clock": clock,
    "stopwatch": stopwatch,
    "ticker": ticker,
    "graph": graph,
    "progress": progress,
    "wire cube": wire_cube,
    "menu": menu,
    "spectrum": spectrum,
    "cursor": cursor,
}
"""The scenes by name: ``draw(fb, frame)``."""


def _bounce(way: int, room: int) -> int:
    """Where something is that runs to and fro between 0 and `room`."""
    way %= 2 * room
    return min(way, 2 * room - way)


def _measured(x: int) -> float:
    """A quantity that drifts, swings and jitters, from 0 to 100."""
    return 50 + 25 * math.sin(x / 17) + 12 * math.sin(x / 5.3 + 1) + 8 * math.sin(12.9898 * x)


def _beat(band: int, frame: int) -> int:
    """How high a bar is thrown on a frame: low bands seldom and high, high ones often and less."""
    period = 15 - band // 2
    strength = 0.5 + 0.5 * math.sin(7.1 * band + 3.3 * (frame // period))
    return int((56 - 2 * band) * strength) if frame % period == 0 else 4
