"""The fonts that are part of this package, drawn in ``#`` and ``.``, read when one is asked for."""

from __future__ import annotations

import numpy as np

from paneldraw.text.strike import Picture, Strike

NAMES = ("6x8",)

_MISSING = 0xFFFD


def strike(name: str) -> Strike:
    """Read the font of that name."""
    if name not in NAMES:
        raise ValueError(f"there is no built-in font {name!r}; there are {', '.join(NAMES)}")
    from paneldraw.text.builtin.font_6x8 import GLYPHS

    return Strike(name, 7, 1, read(GLYPHS, 8, 6), gap=1, cells=True, missing=_MISSING)


def read(drawing: str, height: int, advance: int) -> dict[int, Picture]:
    """Read bands of cells of `advance` x `height`, each under a line that names their characters."""
    rows = drawing.strip("\n").split("\n")
    pictures: dict[int, Picture] = {}
    for top in range(0, len(rows), height + 1):
        cells = np.frombuffer("".join(row + " " for row in rows[top + 1 : top + 1 + height]).encode(), np.uint8)
        band = (cells == ord("#")).reshape(height, -1, advance + 1)[:, :, :advance].astype(np.uint8)
        for column, name in enumerate(rows[top][2 :: advance + 1]):
            pictures[ord(name)] = Picture(band[:, column], 0, 0, advance)
    return pictures
