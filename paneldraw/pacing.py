"""A steady beat for drawing, without busy waiting."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from typing import NamedTuple


class Beat(NamedTuple):
    """One turn of `Panel.frames`."""

    number: int
    """Frames since the start, those left out included: a demo's time is ``number / fps``."""
    seconds: float
    """Seconds since the start."""
    dropped: int
    """Frames left out just before this one, because the one before took too long."""


class Frames:
    """An iterator that keeps to a beat. Make one with `Panel.frames`.

    Attributes
    ----------
    fps : float
        Frames a second.
    count, late, dropped : int
        Frames so far; those that began more than a tenth of their time late; and those that had to be left out.
    """

    def __init__(
        self,
        fps: float,
        *,
        clock: Callable[[], float] = time.perf_counter,
        sleep: Callable[[float], object] = time.sleep,
    ) -> None:
        if not 0 < fps <= 1000:
            raise ValueError(f"fps must be above 0 and at most 1000, not {fps!r}")
        self.fps = fps
        self.count = self.late = self.dropped = 0
        self._clock, self._sleep = clock, sleep
        self._start: float | None = None
        self._number = -1
        self._said = False

    def __iter__(self) -> Iterator[Beat]:
        return self

    def __next__(self) -> Beat:
        now = self._clock()
        if self._start is None:
            self._start = now
        self._number += 1
        behind = now - self._start - self._number / self.fps
        dropped = 0
        if behind < 0:
            self._sleep(-behind)
            now = self._clock()
        else:
            dropped = int(behind * self.fps)
            self._number += dropped
            self.late += behind * self.fps > 0.1
        self.count += 1
        self.dropped += dropped
        self._say(now)
        return Beat(self._number, now - self._start, dropped)

    def _say(self, now: float) -> None:
        """Say once that the beat cannot be kept."""
        if self._said or self.count < 20 or self.dropped < self.count or self._start is None:
            return
        self._said = True
        warnings.warn(
            f"{self.fps:g} frames a second were asked for and {self.count / (now - self._start):.1f} are what drawing "
            "and the wire allow; frames are left out",
            RuntimeWarning,
            stacklevel=3,
        )
