"""What was shown, when, and what it cost on the wire."""

from __future__ import annotations

from dataclasses import dataclass

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
