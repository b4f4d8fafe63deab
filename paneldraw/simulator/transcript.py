"""What a chip makes of the bytes that it is sent, line by line: for people who ask why their picture is shifted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Final

import numpy as np

from .addressing import Place
from .chip import Chip, written
from .display_chip import DisplayChip
from .frames import Frame

_MOST_BYTES: Final = 8
"""So many of a command's bytes are spelled."""


class Transcript:
    """Writes down what a simulated chip makes of what it is sent: commands by their names, data by its place.

    A line is the time of the bus call (once for all its lines), the bytes, and what they are. What breaks the datasheet
    follows where it happens, the first time; `close` says how often, and what of the glass was never written.

    Parameters
    ----------
    chip : Chip
        A simulated chip, which has no other transcript.
    out : callable
        Takes each line, a str without a newline: ``print``, or a list's ``append``.
    name : str, optional
        What lines begin with, where several chips are written down together.

    Raises
    ------
    ValueError
        If the chip has a transcript already.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> chip = simulator.SH1106()
    >>> bus = simulator.I2CBus({0x3C: chip}, timer=None)
    >>> with Transcript(chip, print):
    ...     bus.write_i2c_block_data(0x3C, 0x00, [0x81, 0xCF, 0x21, 0, 127, 0xB3])
    ...     bus.write_i2c_block_data(0x3C, 0x40, [0xFF] * 16)
      0.000185  81 CF                contrast 207
                21 00 7F             windows of the SSD1306
                                     violation: not a command of the SH1106 (windows of the SSD1306); ignored
                B3                   page pointer 3
      0.000595  data                 16 bytes of data on page 3, columns 0 to 15
                                     note: columns 0 to 1 are beside the glass, which shows columns 2 to 129
                                     never written: pages 0 to 2, 4 to 7; columns 16 to 129
    """

    def __init__(self, chip: Chip, out: Callable[[str], object], name: str = "") -> None:
        if chip.listener is not None:
            raise ValueError(f"chip: {chip!r} has a transcript already; close that first")
        self._chip, self._out, self._name = chip, out, f"{name}  " if name else ""
        self._lines: list[tuple[str, str]] = []
        self._asides: list[str] = []
        self._said: Counter[tuple[str, str]] = Counter()
        self._noted: set[str] = set()
        self._pictures = 0
        self._glass: tuple[object, tuple[range, range]] | None = None
        self._written = np.zeros((chip.lines, chip.columns), np.bool_) if isinstance(chip, DisplayChip) else None
        chip.listener = self

    def close(self) -> None:
        """Write down what is left to say, and leave the chip."""
        if self._chip.listener is not self:
            return
        self._chip._at_rest(self._chip._end_picture)
        self._chip.listener = None
        self._flush("")
        for (kind, rule), times in self._said.items():
            if times > 1:
                self._line("", "", f"{times} times in all, {kind}: {rule}")
        if unwritten := self._unwritten():
            self._line("", "", f"never written: {unwritten}")

    def __enter__(self) -> Transcript:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # what the chip tells

    def told(self, kind: str, sent: bytes, meaning: str) -> None:
        """Note a command, or what is said of one."""
        if kind in ("violation", "remark"):
            self._said[kind, meaning] += 1
            if self._said[kind, meaning] == 1:
                self._asides.append(f"{kind}: {meaning}")
            return
        if kind == "read":
            meaning = f"read: {meaning}"
        self._add(_spelled(sent), meaning)

    def placed(self, count: int, places: Sequence[Place], down: bool) -> None:
        """Note data and where it went."""
        chip = self._chip
        if not isinstance(chip, DisplayChip):
            return
        where = _where(places, chip.line_name, down) or "lost"
        self._add("data", f"{count} {'byte' if count == 1 else 'bytes'} of data {where}")
        for place in places:
            if self._written is not None:
                (self._written.T if down else self._written)[place] = True
        beside = [n for n in _numbers(place[not down] for place in places) if n not in self._shown(chip)[0]]
        if beside and (columns := self._shown(chip)[0]):
            shows = f"columns {columns[0]} to {columns[-1]}"
            note = f"note: {_named('column', beside)} {_verb(beside)} beside the glass, which shows {shows}"
            if note not in self._noted:
                self._noted.add(note)
                self._aside(note)

    def seen(self, frame: Frame) -> None:
        """Note a frame."""
        self._pictures += 1
        lit = np.count_nonzero(frame.pixels)
        self._flush("")
        self._line(
            f"{frame.seconds:10.6f}",
            "",
            f"picture {self._pictures}: {lit} of {frame.pixels.size} pixels lit, {frame.wire_bytes} bytes on the wire",
        )

    def settled(self, seconds: float) -> None:
        """Note that a call of the bus is over."""
        self._flush(f"{seconds:10.6f}")

    # inside

    def _shown(self, chip: DisplayChip) -> tuple[range, range]:
        """The columns and lines that the glass shows."""
        setting = chip.scan, chip.segment_remap
        if self._glass is None or self._glass[0] != setting:
            self._glass = setting, chip.visible()
        return self._glass[1]

    def _unwritten(self) -> str:
        """What the glass shows and nobody wrote."""
        chip, cells = self._chip, self._written
        if cells is None or not isinstance(chip, DisplayChip) or not cells.any():
            return ""
        columns, lines = self._shown(chip)
        if not columns or not lines:
            return ""
        seen = cells[lines.start : lines.stop, columns.start : columns.stop]
        missing_lines = [lines[n] for n in np.flatnonzero(~seen.any(axis=1))]
        missing_columns = [columns[n] for n in np.flatnonzero(~seen.any(axis=0))]
        names = (chip.line_name, missing_lines), ("column", missing_columns)
        return "; ".join(_named(name, missing) for name, missing in names if missing)

    def _add(self, sent: str, meaning: str) -> None:
        self._lines.append((sent, meaning))
        for aside in self._asides:
            self._aside(aside)
        self._asides = []

    def _aside(self, text: str) -> None:
        self._lines.append(("", text))

    def _flush(self, time: str) -> None:
        """Write down what came since the last call."""
        for aside in self._asides:
            self._aside(aside)
        lines, self._lines, self._asides = self._lines, [], []
        for number, (sent, meaning) in enumerate(lines):
            self._line("" if number else time, sent, meaning)

    def _line(self, time: str, sent: str, meaning: str) -> None:
        self._out(f"{self._name}{time:10}  {sent:<20} {meaning}")


def _spelled(sent: bytes) -> str:
    if len(sent) <= _MOST_BYTES:
        return written(sent)
    return f"{written(sent[: _MOST_BYTES - 3])} ({len(sent)})"


def _bounds(place: slice | int) -> tuple[int, int]:
    return (place.start, place.stop - 1) if isinstance(place, slice) else (place, place)


def _numbers(places: Iterable[slice | int]) -> list[int]:
    """All the numbers that slices are of, in order."""
    return sorted({number for first, last in map(_bounds, places) for number in range(first, last + 1)})


def _where(places: Sequence[Place], line: str, down: bool) -> str:
    """Where data went, in words; empty if nowhere."""
    if not places:
        return ""
    one, many = ("column", line) if down else (line, "column")
    if len({_bounds(inner) for _, inner in places}) == 1:
        return f"on {_named(one, _numbers(outer for outer, _ in places))}, {_named(many, _numbers([places[0][1]]))}"
    begin, end = places[0], places[-1]
    return (
        f"from {many} {_bounds(begin[1])[0]} of {one} {_bounds(begin[0])[0]} "
        f"to {many} {_bounds(end[1])[1]} of {one} {_bounds(end[0])[1]}"
    )


def _named(name: str, numbers: Sequence[int]) -> str:
    """Numbers with what they are of: "pages 0 to 2, 4"."""
    runs: list[list[int]] = []
    for number in numbers:
        if runs and number == runs[-1][1] + 1:
            runs[-1][1] = number
        else:
            runs.append([number, number])
    spans = ", ".join(str(first) if first == last else f"{first} to {last}" for first, last in runs)
    return f"{name} {spans}" if len(numbers) == 1 else f"{name}s {spans}"


def _verb(numbers: Sequence[int]) -> str:
    return "is" if len(numbers) == 1 else "are"
