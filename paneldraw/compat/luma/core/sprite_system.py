"""Sprite sheets, and a loop that keeps to a frame rate."""

from __future__ import annotations

import os
import time
from collections.abc import Iterator, Mapping
from types import SimpleNamespace
from typing import Any

from PIL import Image

__all__ = ["framerate_regulator", "spritesheet"]


class spritesheet:
    """Pictures of one size in a file, and sequences of them.

    Parameters
    ----------
    image : path
    frames : mapping
        ``width`` and ``height`` of a picture; ``regX`` and ``regY``, the margin of the sheet (default 0); ``count``,
        how many there are (default: what fits).
    animations : mapping of str to mapping
        Of each sequence ``frames``, numbers of pictures and names of other sequences; ``speed``, of how many a step
        (default 1); ``next``, the sequence that follows (default: it ends).

    Examples
    --------
    >>> Image.new("1", (64, 16)).save("walk.png")
    >>> walk = {"frames": [0, 1, 2, 1], "next": "walk"}
    >>> sprites = spritesheet("walk.png", {"width": 16, "height": 16}, {"walk": walk})
    >>> len(sprites)
    4
    >>> next(sprites.animate("walk")).size
    (16, 16)
    """

    def __init__(
        self, image: str | os.PathLike[str], frames: Mapping[str, Any], animations: Mapping[str, Mapping[str, Any]]
    ) -> None:
        self.frames = SimpleNamespace(**{"regX": 0, "regY": 0, **frames})
        self.animations = SimpleNamespace(**{name: SimpleNamespace(**each) for name, each in animations.items()})
        with Image.open(image) as sheet:
            left, top = self.frames.regX, self.frames.regY
            self.image = sheet.crop((left, top, sheet.width - left, sheet.height - top))
        self.width, self.height = self.image.size
        wide, high = self.frames.size = self.frames.width, self.frames.height
        if self.width % wide or self.height % high:
            raise ValueError(f"frames must be of a size that fills {self.width}x{self.height}, not {wide}x{high}")
        self._columns = self.width // wide
        if not hasattr(self.frames, "count"):
            self.frames.count = self._columns * (self.height // high)
        self._cut: dict[int, Image.Image] = {}

    def __len__(self) -> int:
        return int(self.frames.count)

    def __getitem__(self, frame_index: int) -> Image.Image:
        if not isinstance(frame_index, int):
            raise TypeError(f"frame index must be numeric, not {frame_index!r}")
        if not 0 <= frame_index < len(self):
            raise IndexError(f"frame index must be 0 to {len(self) - 1}, not {frame_index}")
        if frame_index not in self._cut:
            row, column = divmod(frame_index, self._columns)
            wide, high = self.frames.size
            self._cut[frame_index] = self.image.crop((column * wide, row * high, (column + 1) * wide, (row + 1) * high))
        return self._cut[frame_index]

    def animate(self, seq_name: str) -> Iterator[Image.Image]:
        """Yield the pictures of a sequence and of those that follow it."""
        name: str | None = seq_name
        while name is not None:
            sequence = getattr(self.animations, name)
            at: float = 0
            while at < len(sequence.frames):
                frame = sequence.frames[int(at)]
                at += getattr(sequence, "speed", 1)
                if isinstance(frame, int):
                    yield self[frame]
                else:
                    yield from self.animate(frame)
            name = getattr(sequence, "next", None)


class framerate_regulator:
    """Wait at the end of each ``with`` block until a frame's time is over.

    Parameters
    ----------
    fps : float, optional
        Frames a second; 0 does not wait. Default: 16.67.

    Attributes
    ----------
    called : int
        How many frames there were.
    total_transit_time : float
        Seconds that the blocks took.

    Examples
    --------
    >>> regulator = framerate_regulator(fps=100)
    >>> for _ in range(3):
    ...     with regulator:
    ...         pass  # draw
    >>> regulator.called
    3
    """

    def __init__(self, fps: float = 16.67) -> None:
        self.max_sleep_time = 1 / fps if fps else -1.0
        self.total_transit_time = 0.0
        self.called = 0
        self.start_time: float | None = None
        self.last_time = 0.0

    def __enter__(self) -> framerate_regulator:
        self.enter_time = time.perf_counter()
        if self.start_time is None:
            self.start_time = self.last_time = self.enter_time
        return self

    def __exit__(self, *exception: object) -> None:
        now = time.perf_counter()
        self.called += 1
        self.total_transit_time += now - self.enter_time
        left = self.last_time + self.max_sleep_time - now
        if left > 0:
            time.sleep(left)
        self.last_time = time.perf_counter()

    def effective_FPS(self) -> float:
        """Return how many frames a second there were."""
        return self.called / (time.perf_counter() - (self.start_time or 0.0))

    def average_transit_time(self) -> float:
        """Return how many milliseconds a block took on average."""
        return self.total_transit_time * 1000 / self.called
