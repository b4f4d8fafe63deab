"""What was shown, when, what it cost on the wire, and where one picture ends and the next begins."""

from __future__ import annotations

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


class Progress:
    """Tells where one picture ends and the next begins, from the calls on the bus alone.

    A call that sets the pointer and writes data is a picture of its own. Of drivers that do so in calls of their own,
    a call that sets the pointer opens a picture, and calls with data add to it until a place is written a second time,
    or the pointer is set after a rest of more than `REST` seconds. A call with data while no picture is open is one by
    itself, and opens one where it leaves its window unfilled. Chips without a pointer, whose data carries its address,
    add to a picture until a place is written a second time or after a rest.

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
    """

    REST = 0.02

    def __init__(self, shape: tuple[int, ...]) -> None:
        self.stamps = np.zeros(shape, np.uint32)
        self.number = 0
        self.pointed = False
        self._drew = self._open = False
        self._addressed: list[Any] = []
        self._ended = 0.0

    def draw(self) -> None:
        """Note that this call writes data where the pointer stands, and begin a picture where none is open."""
        if not self._drew and (self.pointed or not self._open):
            self.number += 1
        self._drew = True

    def draw_at(self, cells: Any) -> None:
        """Note data that carries its own address: an index into `stamps`."""
        self._addressed.append(cells)

    def end_call(self, seconds: float, unfilled: bool = False) -> int:
        """Note that a call is over, with the pointer within a window or not; tell which picture it drew, or 0."""
        rested, self._ended = seconds - self._ended > self.REST, seconds
        pointed, drew = self.pointed, self._drew
        self.pointed = self._drew = False
        if self._addressed:
            again = any(np.any(self.stamps[cells] == self.number) for cells in self._addressed)
            self.number += again or rested
            for cells in self._addressed:
                self.stamps[cells] = self.number
            self._addressed.clear()
            return self.number
        if pointed and drew:
            self._open = False
        elif pointed and (rested or not self._open):
            self.number += 1
            self._open = True
        elif drew and not self._open:
            self._open = unfilled
        return self.number if drew else 0
