"""Conway's Game of Life; on a panel of grays, cells that died fade away."""

from __future__ import annotations

import functools

import numpy as np
from numpy.typing import NDArray

from .. import Framebuffer

Cells = NDArray[np.uint8]

RATE = 10
"""Generations a second."""
EPOCH = 150
"""Generations until it begins anew."""


def draw(fb: Framebuffer, t: float) -> None:
    """Draw this moment's cells, two pixels large where there is room."""
    size = 2 if min(fb.width, fb.height) >= 32 else 1
    epoch, number = divmod(int(t * RATE), EPOCH)
    heat = generation(-(-fb.height // size), -(-fb.width // size), epoch % 1000, number)
    levels = np.where(heat == 255, fb.max_level, heat // 64 * fb.max_level // 6)
    fb.blit(levels.astype(np.uint8).repeat(size, axis=0).repeat(size, axis=1), 0, 0)


@functools.lru_cache(2)
def generation(rows: int, columns: int, epoch: int, number: int) -> Cells:
    """Return the heat of each cell: 255 where one lives; where one died, ever less."""
    if number == 0:
        chance = np.random.RandomState(epoch).rand(rows, columns)
        return np.where(chance < 0.25, 255, 0).astype(np.uint8)
    before = generation(rows, columns, epoch, number - 1)
    alive = before == 255
    # The edges of the panel are joined, left to right and top to bottom.
    around = sum(np.roll(alive, (y, x), (0, 1)).astype(np.uint8) for y in (-1, 0, 1) for x in (-1, 0, 1)) - alive
    lives = (around == 3) | (alive & (around == 2))
    if not lives.any():
        return generation(rows, columns, epoch + 1, 0)
    return np.where(lives, 255, before * 0.8).astype(np.uint8)
