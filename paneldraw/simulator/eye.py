"""What an eye sees of a panel over time: light of rows that a chip scans in its own time, whatever comes meanwhile."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from copy import copy
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .addressing import Bytes, Place, put

if TYPE_CHECKING:
    from .display_chip import DisplayChip

Light = NDArray[np.float64]

MEMORY: Final = 2.0
"""Seconds that a chip's past is known for."""
FUSION: Final = 50.0
"""Hz from which on an eye sees no flicker."""


class Cells(NamedTuple):
    """Data that came into the RAM."""

    cell_seconds: float
    places: list[Place]
    cells: Bytes
    down: bool


class State(NamedTuple):
    """The registers, and the RAM where it changed by itself."""

    registers: Any
    ram: Bytes | None = None


class Timeline:
    """What a chip took in the last seconds, and when.

    Parameters
    ----------
    chip : DisplayChip

    Attributes
    ----------
    now : float
        The time on the bus's clock.
    """

    def __init__(self, chip: DisplayChip) -> None:
        self._chip = chip
        self._base = _twin(chip)
        self._past: deque[tuple[float, Cells | State]] = deque()
        self._coming: list[tuple[float, Cells | State]] = []
        self._offset = self._byte_seconds = 0.0
        self._place = 0
        self.now = 0.0

    # what chip and bus tell

    def begin(self, offset: float, byte_seconds: float) -> None:
        """Note that bytes come, so many seconds after the bus call began, at a pace."""
        self._offset, self._byte_seconds, self._place = offset, byte_seconds, 0

    def at(self, place: int) -> None:
        """Note which of these bytes is the first of what the chip is told next."""
        self._place = place

    def placed(self, places: list[Place], cells: Bytes, *, down: bool, size: int) -> None:
        """Note data, of so many bytes a cell."""
        change = Cells(size * self._byte_seconds, places, cells, down)
        self._coming.append((self._offset + self._place * self._byte_seconds, change))

    def commanded(self, end: int) -> None:
        """Note a command that ended so many bytes later."""
        self._coming.append(
            (self._offset + (self._place + end) * self._byte_seconds, State(copy(self._chip.registers)))
        )

    def changed(self) -> None:
        """Note a chip that changed as a whole."""
        change = State(copy(self._chip.registers), self._chip._ram.copy())
        if self._coming:
            self._coming.append((self._coming[-1][0], change))
        else:
            self._past.append((self.now, change))

    def settle(self, began: float) -> None:
        """Note when the bus call began of which all that came is."""
        self._past.extend((began + offset, change) for offset, change in self._coming)
        self._coming.clear()
        self._offset = self._byte_seconds = 0.0

    def wait(self, seconds: float) -> None:
        """Note what time it is, and forget what is long past."""
        self.now = max(self.now, seconds)
        if self._past and self._past[0][0] < self.now - 2 * MEMORY:
            while self._past and self._past[0][0] < self.now - MEMORY:
                _apply(self._base, self._past.popleft()[1])

    # what is seen

    def scans(self, seconds: float) -> Light:
        """Return the light of each scan that fits into the last seconds, shape (scans, height, width).

        Raises
        ------
        ValueError
            Not one scan fits, or the past is not known so long.
        """
        return self._flashes(*self._window(seconds))[1]

    def seen(self, seconds: float) -> Light:
        """Return the mean light of the flashes of each line in the last seconds, shape (height, width).

        Raises
        ------
        ValueError
            Not one scan fits, or the past is not known so long.
        """
        first, last = self._window(seconds)
        moments, light = self._flashes(max(first - 1, 0), last + 1)
        counted = (moments >= self.now - seconds) & (moments < self.now)
        lines = np.swapaxes(light, 1, 2) if self._chip.transposed else light
        mean: Light = (lines * counted[:, :, None]).sum(axis=0) / counted.sum(axis=0)[:, None]
        return mean.T if self._chip.transposed else mean

    def _window(self, seconds: float) -> tuple[int, int]:
        """Which scans are whole in the last seconds: the first one, and the one behind the last."""
        if not 0 < seconds <= MEMORY:
            raise ValueError(f"seconds must be above 0 and at most {MEMORY:g}, not {seconds!r}")
        period = self._chip.frame_seconds
        first, last = -int(-max(self.now - seconds, 0.0) // period), int(self.now / period)
        if first >= last:
            raise ValueError(
                f"seconds must be {period:.4f} or more, the time of a scan, and have passed, not {seconds!r}"
            )
        return first, last

    def _flashes(self, first: int, last: int) -> tuple[Light, Light]:
        """When each line is lit in each of some scans, and the light of these scans."""
        period = self._chip.frame_seconds
        shares = self._chip._scan_order()
        moments = (np.arange(first, last)[:, None] + shares) * period
        order = np.argsort(moments, axis=None)
        scan, line = np.unravel_index(order, moments.shape)
        sorted_moments = moments.ravel()[order]
        twin = _twin(self._base)
        light = np.zeros((last - first, self._chip.height, self._chip.width))
        lines = np.swapaxes(light, 1, 2) if self._chip.transposed else light
        at = 0
        for moment, change in self._changes(sorted_moments):
            stop = len(order) if change is None else int(np.searchsorted(sorted_moments, moment))
            if stop > at:
                seen = (twin._shares * twin._light)[twin._look()]
                lines[scan[at:stop], line[at:stop]] = (seen.T if twin.transposed else seen)[line[at:stop]]
                at = stop
            _apply(twin, change)
        return moments, light

    def _changes(self, moments: Light) -> Iterator[tuple[float, Cells | State | tuple[Any, ...] | None]]:
        """All changes in order, of data those cells apart between which a line is scanned; None is the end."""
        for time, change in (*self._past, *((self.now, change) for _, change in self._coming)):
            if isinstance(change, State) or not change.cell_seconds:
                yield time, change
                continue
            count = len(change.cells)
            arrivals = time + change.cell_seconds * np.arange(1, count + 1)
            first, last = np.searchsorted(moments, (time, arrivals[-1]))
            if first == last:
                yield float(arrivals[-1]), change
                continue
            cuts = np.unique((0, *np.searchsorted(arrivals, moments[first:last], "right"), count))
            for start, stop in zip(cuts[:-1].tolist(), cuts[1:].tolist(), strict=True):
                yield float(arrivals[stop - 1]), (change, start, stop)
        yield self.now, None


def _twin(chip: DisplayChip) -> DisplayChip:
    """Return a chip with the same registers and a RAM of its own, to look at."""
    twin = copy(chip)
    twin._ram, twin.registers, twin.timeline = chip._ram.copy(), copy(chip.registers), None
    return twin


def _apply(chip: DisplayChip, change: Cells | State | tuple[Any, ...] | None) -> None:
    if isinstance(change, State):
        chip.registers = change.registers
        if change.ram is not None:
            chip._ram = change.ram.copy()
    elif change is not None:
        whole = isinstance(change, Cells)
        data: Cells = change if whole else change[0]  # type: ignore[assignment]
        ram = chip._addressed.swapaxes(0, 1) if data.down else chip._addressed
        if whole:
            put(ram, data.places, data.cells)
        else:
            _, start, stop = change
            numbers = np.arange(ram.shape[0] * ram.shape[1]).reshape(ram.shape[:2])
            where = np.concatenate([numbers[place].ravel() for place in data.places])[start:stop]
            ram[where // ram.shape[1], where % ram.shape[1]] = data.cells[start:stop]


def flicker(scans: Light, period: float) -> Light:
    """Return each pixel's strongest component below `FUSION` relative to its light; 0 where there is none."""
    mean = scans.mean(axis=0)
    spectrum = 2 * np.abs(np.fft.rfft(scans, axis=0)) / len(scans)
    slow = np.fft.rfftfreq(len(scans), period) < FUSION
    slow[0] = False
    strongest = spectrum[slow].max(axis=0, initial=0.0)
    return np.asarray(np.divide(strongest, mean, out=np.zeros_like(mean), where=mean > 0))
