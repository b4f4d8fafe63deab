"""CPU time that a recording of a minute at 30 frames a second takes to become a GIF or an animated PNG."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from statistics import median

import measure
import numpy as np

from paneldraw import Framebuffer, simulator
from paneldraw.demos import find

WANTED = 5000.0
"""Milliseconds, for a GIF."""
FRAMES, FPS = 1800, 30


def reels() -> Iterator[tuple[str, list[simulator.Frame]]]:
    """Recordings of 128 x 64 pixels: a demo of which much moves, one of which little does, and all pixels anew."""
    for name in ("cube", "clock"):
        demo, fb, frames = find(name), Framebuffer(128, 64), []
        for number in range(FRAMES):
            demo(fb, 36_000 + number / FPS)
            frames.append(simulator.Frame(fb.pixels.copy(), number / FPS, 0))
        yield name, frames
    noise = np.random.default_rng(1).integers(0, 2, (FRAMES, 64, 128), np.uint8)
    yield "noise", [simulator.Frame(pixels, number / FPS, 0) for number, pixels in enumerate(noise)]


def run(rounds: int) -> None:
    """Print a row for every recording and format."""
    once = measure.SAMPLE == 0
    rounds = 1 if once else min(rounds, 3)
    with tempfile.TemporaryDirectory() as folder:
        for name, frames in reels():
            for kind in (".gif", ".apng"):
                path = Path(folder, name + kind)
                taken = 1000 * median(_seconds(frames[:60] if once else frames, path) for _ in range(rounds))
                row = f"{name} as {kind[1:]}"
                size = f"{path.stat().st_size / 1e6:.1f} MB"
                verdict = measure.VERDICTS.judge(row, "at most 5000 ms", WANTED / taken, 1.0) if kind == ".gif" else ""
                wanted = f"at most {WANTED:.0f}: {verdict}" if verdict else ""
                print(f"  {row:<44}{taken:9.3f} ms    {size}   {wanted}", flush=True)


def _seconds(frames: list[simulator.Frame], path: Path) -> float:
    start = time.process_time()
    simulator.save(frames, path)
    return time.process_time() - start
