"""What was shown, when, what it cost on the wire, and where one picture ends and the next begins."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]


@dataclass(frozen=True, eq=False)
class Frame:
    """One picture that a panel showed.

    Attributes
    ----------
    pixels : numpy.ndarray
        Levels, uint8, shape (height, width), read-only.
    seconds : float
        When the picture was complete, on the bus's clock (see `I2CBus`).
    wire_bytes : int
        Bytes that the panel was sent since the frame before, address bytes included.
    max_level : int
        The level of a fully lit pixel.
    """

    pixels: Picture
    seconds: float
    wire_bytes: int
    max_level: int = 1


class History(deque[Frame]):
    """Frames in order, of which the oldest give way to new ones.

    Attributes
    ----------
    dropped : int
        How many gave way.
    began : float or None
        The `seconds` of the first frame of all, which may have given way.
    """

    def __init__(self, maxlen: int | None = None) -> None:
        super().__init__(maxlen=maxlen)
        self.dropped = 0
        self.began: float | None = None

    def append(self, frame: Frame) -> None:
        """Take a frame at the end."""
        if self.began is None:
            self.began = frame.seconds
        self.dropped += len(self) == self.maxlen
        super().append(frame)

    def resized(self, maxlen: int | None) -> History:
        """Return one of another length, with as many of the last frames as fit."""
        other = History(maxlen)
        other.extend(self)
        other.dropped = self.dropped + len(self) - len(other)
        other.began = self.began
        return other


class Progress:
    """Tells where one picture ends and the next begins, from the calls on the bus alone.

    A call that sets the pointer and writes data is a picture of its own. Of drivers that do so in calls of their own,
    a call that sets the pointer opens a picture, and calls with data add to it until one writes again more than it
    writes anew, or the pointer is set after a rest of more than `REST` seconds. A call with data while no picture is
    open is one by itself, and opens one where it leaves its window unfilled. Data that carries its own address, of
    chips without a pointer, adds to a picture until places repeat or after a rest.

    Parameters
    ----------
    shape : tuple of int
        The cells of the RAM.

    Attributes
    ----------
    stamps : numpy.ndarray
        By cell, the number of the picture that wrote it last.
    number : int
        The picture in progress.
    pointed : bool
        Whether this call set the pointer.
    open : bool
        Whether the picture goes on.
    """

    REST = 0.02

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.stamps = np.zeros(shape, np.uint32)
        self.number = 0
        self.pointed = False
        self._drew = self.open = False
        self._addressed: list[Any] = []
        self._ended = 0.0

    def draw(self, places: list[Any], down: bool = False) -> bool:
        """Note a run of data where the pointer stands, and tell whether it begins a picture.

        `places` are indices into `stamps`, of columns and lines if `down`.
        """
        before = self.number
        if not self._drew and (self.pointed or not self.open):
            self.number += 1
        self._drew = True
        if not self.pointed:  # or else the call is a picture of its own
            self._stamp(self.stamps.T if down else self.stamps, places)
        return self.number != before

    def _stamp(self, stamps: NDArray[np.uint32], places: list[Any], rested: bool = False) -> None:
        """Stamp cells with the number of the picture: the next one if they are more again than anew."""
        again = total = 0
        for place in places:
            found = stamps[place] == self.number
            again, total = again + int(np.count_nonzero(found)), total + np.size(found)
        self.number += rested or 2 * again > total
        for place in places:
            stamps[place] = self.number

    def draw_at(self, cells: Any) -> None:
        """Note data that carries its own address: an index into `stamps`."""
        self._addressed.append(cells)

    def end_call(self, seconds: float, unfilled: bool = False) -> int:
        """Note that a call is over, with the pointer within a window or not; tell which picture it drew, or 0."""
        rested, self._ended = seconds - self._ended > self.REST, seconds
        pointed, drew = self.pointed, self._drew
        self.pointed = self._drew = False
        if self._addressed:
            self._stamp(self.stamps, self._addressed, rested)
            self._addressed = []
            return self.number
        if pointed and drew:
            self.open = False
        elif pointed and (rested or not self.open):
            self.number += 1
            self.open = True
        elif drew and not self.open:
            self.open = unfilled
        return self.number if drew else 0
