"""From display RAM to what an eye sees: how a module's glass is joined to the pads of its chip."""

from __future__ import annotations

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from .frames import Picture


class Module(NamedTuple):
    """How a module of one size is wired.

    Attributes
    ----------
    column_offset : int
        First visible RAM column, upright and without a display offset.
    com_pins : int
        The setting of the COM pins that the glass is wired for.
    first_com : int
        First COM signal that the glass uses.
    upright : (bool, bool), optional
        The segment remap and the direction of the COM lines under which it stands upright. Default: as the chip's
        common modules.
    """

    column_offset: int = 0
    com_pins: int = 0
    first_com: int = 0
    upright: tuple[bool, bool] | None = None


class Scan(Protocol):
    """What says how RAM rows come onto the glass."""

    reversed_lines: int
    """So many lines a reversed scan begins at the end of; 0 where they are as many as the multiplex ratio."""

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """Multiplex ratio less 1, display offset, start line, whether COM lines are reversed, COM pins."""

    def com_signals(self, setting: int) -> NDArray[np.intp]:
        """Which COM signal each pad carries under a setting of the COM pins."""


def com_signals(rows: int, *, alternate: bool, swapped: bool = False) -> NDArray[np.intp]:
    """Which COM signal each pad carries: in sequence, or even ones before odd ones; the halves swapped or not."""
    signals = np.arange(rows)
    if alternate:
        signals = np.concatenate((signals[0::2], signals[1::2]))
    if swapped:
        signals = np.roll(signals, rows // 2)
    return signals


class Glass:
    """The visible lines and dots of a module, joined to fixed COM and SEG pads.

    Parameters
    ----------
    lines, dots : int
        Visible lines, which are joined to COM pads, and pixels a line, joined to SEG pads.
    segments : int
        Segments of the chip.
    first_segment : int
        First visible segment, from the left where the module stands upright.
    pads : int array
        The COM pads of the lines, in order of their signals under the setting that the glass is wired for.
    remapped, com_reversed : bool
        Under which segment remap and which direction of the COM lines the module stands upright.
    transposed : bool
        Whether COM lines are the columns of what is seen. Default: False.
    """

    def __init__(
        self,
        lines: int,
        dots: int,
        *,
        segments: int,
        first_segment: int,
        pads: NDArray[np.intp],
        remapped: bool,
        com_reversed: bool,
        transposed: bool = False,
    ) -> None:
        self._transposed = transposed
        left = segments - 1 - first_segment
        stop = left - dots if left >= dots else None
        self._segments = slice(left, stop, -1) if remapped else slice(first_segment, first_segment + dots)
        self._pads = pads[::-1] if com_reversed else pads
        self._known: tuple[tuple[int, ...], slice | NDArray[np.intp], NDArray[np.bool_] | None] | None = None

    def pixels(self, levels: Picture, chip: Scan) -> tuple[Picture, NDArray[np.bool_] | None]:
        """Bring levels onto the glass; return them and which lines are dark, if any, come what may."""
        scan = chip.scan
        if self._known is None or self._known[0] != scan:
            self._known = (scan, *self._rows(levels.shape[self._transposed], chip))
        _, rows, dark = self._known
        seen = levels[self._segments, rows] if self._transposed else levels[rows, self._segments]
        return np.array(seen, order="C"), dark

    def dots(self, levels: Picture) -> Picture:
        """Bring levels of lines that are not scanned, such as icons, onto the glass."""
        return levels[:, self._segments]

    def turns(self, chip: Scan) -> NDArray[np.intp]:
        """Which turn in a scan each visible line has."""
        multiplex, _, _, com_reversed, setting = chip.scan
        signals = chip.com_signals(setting)[self._pads]
        return (chip.reversed_lines or multiplex + 1) - 1 - signals if com_reversed else signals

    def _rows(self, count: int, chip: Scan) -> tuple[slice | NDArray[np.intp], NDArray[np.bool_] | None]:
        multiplex, offset, start_line, _, _ = chip.scan
        rows = (self.turns(chip) + offset) % count
        dark = rows > multiplex
        rows = (rows + start_line) % count
        steady = bool((np.diff(rows) == 1).all())
        return slice(rows[0], rows[-1] + 1) if steady else rows, dark if dark.any() else None
