"""Pictures dithered to one bit: 128 x 64 in time, beside Pillow's Floyd-Steinberg; and corners of a large one."""

from __future__ import annotations

from statistics import median

import measure
import numpy as np
from PIL import Image

from paneldraw import Framebuffer

#: Microseconds at most.
WANTED = {"floyd-steinberg": 100.0, "bayer": 20.0, "blue-noise": 20.0, "stable": 100.0}
WANTED_LARGE = 11000.0


def timed(statement: str, names: measure.Names, rounds: int) -> float:
    """Microseconds that a statement takes."""
    timer = measure.Timer(statement, names)
    return 1e6 * median(timer.sample() for _ in range(rounds))


def run(rounds: int) -> None:
    """Print the group's rows."""
    random = np.random.default_rng(1)
    gray = random.integers(0, 256, (64, 128), np.uint8)
    large = Image.fromarray(random.integers(0, 256, (720, 1280, 3), np.uint8))
    fb = Framebuffer(128, 64)
    names = {"fb": fb, "gray": gray, "pillow": Image.fromarray(gray), "large": large}
    pillow = timed('pillow.convert("1")', names, rounds)
    for dither, wanted in WANTED.items():
        taken = timed(f'fb.image(gray, dither="{dither}")', names, rounds)
        verdict = measure.VERDICTS.judge(dither, f"at most {wanted:g} us", wanted / taken, 1.0)
        print(
            f"  {dither:<44}{taken:9.3f} us   Pillow {pillow / taken:.3g}x   at most {wanted:g}: {verdict}", flush=True
        )
    for name, place in (("the first pixels of 1280 x 720", "0, 0"), ("the last ones", "-1152, -656")):
        taken = timed(f'fb.image(large, {place}, dither="floyd-steinberg")', names, rounds)
        verdict = measure.VERDICTS.judge(name, f"at most {WANTED_LARGE:g} us", WANTED_LARGE / taken, 1.0)
        print(f"  {name:<44}{taken:9.3f} us   at most {WANTED_LARGE:g}: {verdict}", flush=True)
