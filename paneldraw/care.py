"""Care for the glass: what to do when a panel shows the same picture for long, so that it does not burn in."""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

#: Where the picture goes, in pixels to the right and down, one after the other.
_STEPS: Final = ((0, 0), (1, 0), (1, 1), (0, 1))


class Care:
    """When to dim, darken and shift a panel. It knows no panel and no clock.

    Parameters
    ----------
    dim_after, off_after : float or None
        Seconds without another picture.
    pixel_shift : float or None
        Seconds between two steps by a pixel.
    now : float
        The time, in seconds.
    """

    def __init__(self, dim_after: float | None, off_after: float | None, pixel_shift: float | None, now: float) -> None:
        settings = {"dim_after": dim_after, "off_after": off_after, "pixel_shift": pixel_shift}
        for name, seconds in settings.items():
            if seconds is not None and not seconds > 0:
                raise ValueError(f"{name} must be seconds above 0, or None, not {seconds!r}")
        self._rests = {"dim": dim_after, "off": off_after}
        self._pixel_shift = pixel_shift
        self._changed = self._moved = now
        self._step = 0
        self.rest = ""
        """What the panel does while nothing changes: ``"dim"``, ``"off"``, or nothing yet."""

    @property
    def needed(self) -> bool:
        """Whether anything was asked for."""
        return self._pixel_shift is not None or any(self._rests.values())

    def changed(self, now: float) -> None:
        """Know that another picture was shown."""
        self._changed, self.rest = now, ""

    def due(self) -> float | None:
        """When something is to be done next."""
        rests = [after for rest, after in self._rests.items() if after is not None and self._further(rest)]
        times = [self._changed + after for after in rests]
        if self._pixel_shift is not None and self.rest != "off":
            times.append(self._moved + self._pixel_shift)
        return min(times, default=None)

    def act(self, now: float) -> bool:
        """Do what is due: note the rest that begins, and whether the picture moves; return that."""
        for rest, after in self._rests.items():
            if after is not None and now >= self._changed + after and self._further(rest):
                self.rest = rest
        if self._pixel_shift is None or now < self._moved + self._pixel_shift:
            return False
        self._moved, self._step = now, (self._step + 1) % len(_STEPS)
        return True

    def _further(self, rest: str) -> bool:
        return not self.rest or (self.rest, rest) == ("dim", "off")

    def moved(self, pixels: npt.NDArray[np.uint8]) -> npt.NDArray[np.uint8]:
        """Return a picture where it is to be now; what leaves the glass is lost, what comes in is black."""
        right, down = _STEPS[self._step]
        if not (right or down):
            return pixels
        there = np.zeros_like(pixels)
        height, width = pixels.shape
        there[down:, right:] = pixels[: height - down, : width - right]
        return there
