"""Runs a demo: on a panel in real time, in the terminal, into a file."""

from __future__ import annotations

import contextlib
import datetime
import itertools
import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from paneldraw.pacing import Frames
from paneldraw.simulator import Frame, TerminalView, save
from paneldraw.simulator.averaged import WINDOW, Averaged
from paneldraw.simulator.recorder import Showing
from paneldraw.watching import watched

if TYPE_CHECKING:
    from paneldraw.demos import Demo
    from paneldraw.panel import Panel

TEN_PAST_TEN = 10 * 3600 + 9 * 60 + 36.0
"""Seconds after midnight at which what is saved begins, so that it comes out the same every time."""

PATIENCE = 1.0
"""Seconds without a word that a person is asked to bear."""


class Progress:
    """Says on stderr how far long work is: one line that counts up in a terminal, a line now and then elsewhere."""

    def __init__(self, what: str) -> None:
        self._what = what
        self._live = sys.stderr.isatty()
        self._next = time.monotonic() + PATIENCE
        self._said = False

    def __call__(self, done: int, total: float) -> None:
        if time.monotonic() < self._next:
            return
        self._next = time.monotonic() + (0.1 if self._live else 5 * PATIENCE)
        self._said = True
        end = "\x1b[K\r" if self._live else "\n"
        share = f"{done} of {total:.0f}" if math.isfinite(total) else f"{done}"
        print(f"{self._what}: {share} frames", end=end, file=sys.stderr, flush=True)

    def __enter__(self) -> Progress:
        return self

    def __exit__(self, *exception: object) -> None:
        if self._said and self._live:
            print("\x1b[K", end="", file=sys.stderr, flush=True)


def simulated(panel: Panel) -> Showing | None:
    """Return the chip behind a panel if it is a simulated one, in greys as an eye sees it."""
    if not isinstance(panel.simulated, Showing):
        return None
    return Averaged(panel.simulated) if in_greys(panel) else panel.simulated


def in_greys(panel: Panel) -> bool:
    """Whether a panel shows greys by sub-pictures, for which an eye needs a moment."""
    return panel.depth > panel.controller.depth


def print_panel(panel: Panel, caption: str) -> None:
    """Print what a simulated panel shows; of a real one, or one that is watched, the caption alone."""
    chip = simulated(panel)
    if chip is None or watched(panel):
        print(caption)
        return
    if in_greys(panel):
        time.sleep(2 * WINDOW)
    with TerminalView() as view:
        view.show(chip, caption)


@contextlib.contextmanager
def view_of(chip: Showing | None) -> Iterator[Callable[[str], None]]:
    """Show a simulated chip again and again, with a caption; of a real panel, which a person can see, nothing."""
    with TerminalView() if chip else contextlib.nullcontext() as view:
        yield lambda caption: view.show(chip, caption) if view and chip else None


def play(demo: Demo, panel: Panel, name: str, *, frames: float, fps: float, save_to: Path | None = None) -> None:
    """Run a demo on a panel.

    In real time where somebody watches: on a real panel, and on a simulated one in a terminal. Else, and where the
    frames go to a file, as fast as they can be drawn.

    Parameters
    ----------
    demo : callable
        As `paneldraw.demos.find` returns it.
    panel : Panel
        What to draw on.
    name : str
        What to call the demo in captions.
    frames : float
        How many frames, inf for ever.
    fps : float
        Frames a second.
    save_to : Path, optional
        A .gif or .apng of all frames, or a .png of the last.
    """
    chip = simulated(panel)
    seen = watched(panel)
    real_time = in_greys(panel) or (save_to is None and (chip is None or seen or sys.stdout.isatty()))
    still = save_to is not None and save_to.suffix.lower() == ".png"
    start = _seconds_after_midnight() if real_time and save_to is None else TEN_PAST_TEN
    fb = panel.framebuffer()
    recording: list[Frame] = []
    drawn = total_bytes = 0
    before, whole = panel.stats.wire_bytes, fb.width * fb.height * fb.depth // 8
    with contextlib.ExitStack() as stack:
        view = stack.enter_context(TerminalView()) if chip and not seen else None
        progress = stack.enter_context(Progress("drawing")) if not (chip and sys.stdout.isatty()) else None
        for index in _paced(int(frames - 1) if still else 0, frames, fps, real_time):
            demo(fb, start + index / fps)
            panel.show(fb)
            if still:
                panel.flush()
            sent = panel.stats.wire_bytes - before - total_bytes
            drawn, total_bytes = drawn + 1, total_bytes + sent
            if still and in_greys(panel):
                time.sleep(2 * WINDOW)
            if save_to:
                shown, max_level = (chip.pixels, chip.max_level) if chip else (fb.pixels, fb.max_level)
                recording.append(Frame(shown.copy(), index / fps, sent, max_level=max_level))
            each = f"{total_bytes / drawn:.0f} bytes{' each' if drawn > 1 else ''}"
            caption = f"{name}: {_count(drawn, 'frame')}, {each} on the wire for {whole} of pixels"
            if view:
                view.show(chip, caption)
            if progress:
                progress(index + 1, frames)
    if view is None:
        print(caption)
    if save_to:
        with Progress("writing") as progress:
            save(recording, save_to, look=getattr(chip, "look", None), progress=progress)
        print(f"wrote {save_to}: {_count(drawn, 'frame')}")


def _paced(first: int, frames: float, fps: float, real_time: bool) -> Iterator[int]:
    """Count frames, in real time at `fps`; those that come too late are left out."""
    beats = (beat.number for beat in Frames(fps)) if real_time else itertools.count()
    for number in beats:
        if first + number >= frames:
            return
        yield first + number


def _seconds_after_midnight() -> float:
    now = datetime.datetime.now()
    return (now - now.replace(hour=0, minute=0, second=0, microsecond=0)).total_seconds()


def _count(number: int, what: str) -> str:
    return f"{number} {what}" if number == 1 else f"{number} {what}s"
