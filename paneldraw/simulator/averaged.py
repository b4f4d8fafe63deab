"""A simulated chip as an eye sees it, for views and recordings of a panel that shows greys by sub-pictures."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from .frames import Frame, History, Picture

WINDOW: Final = 0.06
"""Seconds over which light is averaged: three cycles of sub-pictures or so."""
EVERY: Final = 0.1
"""Seconds from one look to the next."""
_LEVELS: Final = 15


class Averaged:
    """What an eye sees of a chip, ten times a second; all else is the chip's own.

    Parameters
    ----------
    chip : DisplayChip
        It remembers from now on, see `DisplayChip.seen`.

    Examples
    --------
    >>> from paneldraw import Panel, simulator
    >>> chip = simulator.SSD1306()
    >>> averaged = Averaged(chip)
    >>> averaged.max_level, averaged.pixels.shape, averaged.width
    (15, (64, 128), 128)
    """

    max_level = _LEVELS

    def __init__(self, chip: Any) -> None:
        chip.remembers = True
        self._chip = chip
        self._frames = History(chip.history)
        self._looked = -EVERY
        self._wire_bytes = 0

    def __getattr__(self, name: str) -> Any:
        return getattr(self._chip, name)

    @property
    def pixels(self) -> Picture:
        """Light of each pixel, 0 to 15, where 15 is lit all the time at the present contrast."""
        full = self._chip._light or 1.0
        try:
            light = np.minimum(self._chip.seen(WINDOW) / full, 1.0)
        except ValueError:  # not one scan is over
            light = self._chip.pixels / self._chip.max_level
        return np.asarray(np.floor(light * _LEVELS + 0.5), np.uint8)

    @property
    def history(self) -> int | None:
        """How many frames `frames` keeps; None keeps all."""
        return self._frames.maxlen

    @history.setter
    def history(self, history: int | None) -> None:
        self._frames = self._frames.resized(history)

    @property
    def frames(self) -> History:
        """What was seen, whenever it was another picture."""
        self.glance()
        return self._frames

    def glance(self) -> None:
        """Look, unless it was done lately."""
        now = self._chip.timeline.now
        if now < self._looked + EVERY:
            return
        self._looked, pixels = now, self.pixels
        if self._frames and np.array_equal(self._frames[-1].pixels, pixels):
            return
        sent, self._wire_bytes = self._chip.wire_bytes - self._wire_bytes, self._chip.wire_bytes
        self._frames.append(Frame(pixels, now, sent, _LEVELS))
