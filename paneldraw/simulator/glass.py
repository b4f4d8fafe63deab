"""From display RAM to what an eye sees: how a module's glass is joined to the pads of its chip."""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from .frames import Picture


class Scan(Protocol):
    """The registers that say how RAM rows come onto the glass."""

    multiplex: int
    offset: int
    start_line: int

    @property
    def com_reversed(self) -> bool:
        """Whether COM lines are reversed."""

    @property
    def signals(self) -> NDArray[np.intp]:
        """Which COM signal each pad carries."""


def com_signals(rows: int, *, alternate: bool, swapped: bool = False) -> NDArray[np.intp]:
    """Which COM signal each pad carries: in sequence, or even ones before odd ones; the halves swapped or not."""
    signals = np.arange(rows)
    if alternate:
        signals = np.concatenate((signals[0::2], signals[1::2]))
    if swapped:
        signals = np.roll(signals, rows // 2)
    return signals


class Glass:
    """The visible lines and columns of a module, joined to fixed COM and SEG pads.

    With COM lines reversed the bottom line of the glass is on the first COM signal that the module uses, and with
    segments remapped column 0 is on the left: the common module stands upright under both.

    Parameters
    ----------
    width, height : int
        Visible pixels.
    columns : int
        Segments of the chip.
    column_offset : int
        First visible segment from the left.
    signals : (rows,) int array
        Which COM signal each pad carries under the setting that the glass is wired for.
    first_com : int, optional
        First COM signal that the glass uses. Default: 0.
    """

    def __init__(
        self,
        width: int,
        height: int,
        *,
        columns: int,
        column_offset: int,
        signals: NDArray[np.intp],
        first_com: int = 0,
    ) -> None:
        left = columns - 1 - column_offset
        self._segments = np.arange(left, left - width, -1)
        pads = np.argsort(signals)
        self._pads = pads[first_com : first_com + height][::-1]

    def pixels(self, levels: Picture, scan: Scan) -> tuple[Picture, NDArray[np.bool_]]:
        """Bring levels (rows, segments) onto the glass; return them and which lines are driven at all."""
        signals = scan.signals[self._pads]
        lines = scan.multiplex - signals if scan.com_reversed else signals
        rows = (lines + scan.offset) % len(levels)
        seen = levels[(rows + scan.start_line) % len(levels)][:, self._segments]
        return seen, rows <= scan.multiplex
