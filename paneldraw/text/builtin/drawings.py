"""Reads drawings of characters: cells of ``#`` and ``.`` side by side, under a line that names their characters."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Cell = NDArray[np.uint8]
"""Where a character is lit, of shape (height, width): 1, elsewhere 0."""


def text(name: str) -> str:
    """The text of a file of this package."""
    return Path(__file__).with_name(name + ".txt").read_text(encoding="utf-8")


def drawings(name: str, width: int = 6, height: int = 8) -> dict[str, Cell]:
    """Read the characters of a file, each drawn in a cell of `width` x `height`, as many in a band as it likes.

    A band is a line with each character's name above the third column of its cell, then the rows of the cells, a
    blank between one cell and the next.
    """
    rows = text(name).splitlines()
    found: dict[str, Cell] = {}
    for top in range(0, len(rows), height + 1):
        cells = np.frombuffer("".join(row + " " for row in rows[top + 1 : top + 1 + height]).encode(), np.uint8)
        band = (cells == ord("#")).reshape(height, -1, width + 1)[:, :, :width].astype(np.uint8)
        for column, char in enumerate(rows[top][2 :: width + 1]):
            found[char] = band[:, column]
    return found


def alike() -> dict[str, str]:
    """Read which characters are drawn as others are."""
    lines = text("alike").splitlines()[1:]
    return {char: drawn for drawn, *others in map(str.split, lines) for char in others}
