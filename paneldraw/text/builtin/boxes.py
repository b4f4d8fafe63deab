"""Characters that fill their cells and join: box drawing, blocks, shades, Braille; drawn by rule at any size."""

from __future__ import annotations

import unicodedata
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from paneldraw.text.builtin.drawings import Cell

_SIDES = {"LEFT": "l", "RIGHT": "r", "UP": "u", "DOWN": "d", "HORIZONTAL": "lr", "VERTICAL": "ud"}
_LIGHT, _HEAVY, _DOUBLE = 1, 2, 3
_WEIGHTS = {"LIGHT": _LIGHT, "SINGLE": _LIGHT, "HEAVY": _HEAVY, "DOUBLE": _DOUBLE}
_DASHES = {"DOUBLE DASH": 2, "TRIPLE DASH": 3, "QUADRUPLE DASH": 4}
_QUARTERS = {"UPPER LEFT": (0, 0), "UPPER RIGHT": (0, 1), "LOWER LEFT": (1, 0), "LOWER RIGHT": (1, 1)}
#: Of the eight dots of a Braille cell, in the order of their bits: row and column.
_DOTS = ((0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (3, 0), (3, 1))


def by_rule(char: str, width: int, height: int) -> Cell | None:
    """Draw a character in a cell of `width` x `height`; None if there is no rule for it."""
    code = ord(char)
    if not 0x2500 <= code < 0x25A0 and not 0x2800 <= code < 0x2900:
        return None
    cell = np.zeros((height, width), np.uint8)
    if code >= 0x2800:
        for bit, (row, column) in enumerate(_DOTS):
            cell[height * (2 * row + 1) // 8, width * (2 * column + 1) // 4] = code >> bit & 1
    elif code >= 0x2580:
        _fill(cell, unicodedata.name(char))
    elif code in (0x2571, 0x2572, 0x2573):
        _cross(cell, code)
    else:
        _join(cell, unicodedata.name(char).removeprefix("BOX DRAWINGS "))
    return cell


def _fill(cell: Cell, name: str) -> None:
    """Draw a block, a part of one, a shade, or quarters."""
    height, width = cell.shape
    rows, columns = np.indices(cell.shape)
    eighths = ("ONE EIGHTH", "ONE QUARTER", "THREE EIGHTHS", "HALF", "FIVE EIGHTHS", "THREE QUARTERS", "SEVEN EIGHTHS")
    part = next((k + 1 for k, eighth in enumerate(eighths) if eighth in name), 8)
    if "SHADE" in name:
        dark = (rows + columns) % 2 if "MEDIUM" in name else (rows % 2 == 0) & ((columns + rows // 2) % 2 == 0)
        cell[:] = 1 - dark if "DARK" in name else dark
    elif name.startswith("QUADRANT"):
        for quarter, (down, across) in _QUARTERS.items():
            if quarter in name:
                cell[down * height // 2 :, across * width // 2 :][: height // 2, : width // 2] = 1
    elif name.startswith("LOWER"):
        cell[height - round(height * part / 8) :] = 1
    elif name.startswith("UPPER"):
        cell[: round(height * part / 8)] = 1
    elif name.startswith("RIGHT"):
        cell[:, width - round(width * part / 8) :] = 1
    else:
        cell[:, : max(round(width * part / 8), 1)] = 1


def _cross(cell: Cell, code: int) -> None:
    """Draw diagonals from corner to corner."""
    height, width = cell.shape
    for row in range(height):
        column = row * width // height
        if code != 0x2571:
            cell[row, column] = 1
        if code != 0x2572:
            cell[row, width - 1 - column] = 1


def _join(cell: Cell, name: str) -> None:
    """Draw lines from the middle of the cell to its sides."""
    weights = _weights(name)
    height, width = cell.shape
    x, y, turned = (width - 1) // 2, (height - 1) // 2, cell.T
    across, along = weights["lr"], weights["ud"]
    _left(cell, x, y, across, along)
    _left(cell[:, ::-1], width - 1 - x, y, across[::-1], along, second=0)
    _left(turned, y, x, along, across)
    _left(turned[:, ::-1], height - 1 - y, x, along[::-1], across, second=0)
    if "ARC" in name:
        cell[y, x] = 0
    dash = next((count for word, count in _DASHES.items() if word in name), 0)
    if dash:
        lines = cell if across[0] else turned
        length = lines.shape[1]
        lines[:, [(k + 1) * dash // length > k * dash // length for k in range(length)]] = 0


def _weights(name: str) -> dict[str, tuple[int, int]]:
    """How heavy the lines to left and right, up and down are, by a name such as "DOWN HEAVY AND HORIZONTAL LIGHT"."""
    for dash in _DASHES:
        name = name.replace(dash, "")
    found = dict.fromkeys("lrud", 0)
    weight = 0
    for phrase in name.split(" AND "):
        words = phrase.split()
        weight = next((_WEIGHTS[word] for word in words if word in _WEIGHTS), weight)
        for side in "".join(_SIDES.get(word, "") for word in words):
            found[side] = weight
    return {"lr": (found["l"], found["r"]), "ud": (found["u"], found["d"])}


def _left(cell: Cell, x: int, y: int, across: tuple[int, int], along: tuple[int, int], second: int = 1) -> None:
    """Draw the line from the middle, column `x` of row `y`, to the left side; `across` and `along` weigh all four.

    A light line is one pixel wide, a double one has a line on each side of its middle, a heavy one a second row below
    and a second column right of it, which is `second` columns further on.
    """
    weight, opposite = across
    if weight == _LIGHT:
        past = 0 if opposite else -1 if along == (_DOUBLE, _DOUBLE) else int(_DOUBLE in along)
        cell[y, : x + past + 1] = 1
    elif weight == _HEAVY:
        past = second if _HEAVY in (opposite, *along) else 0
        cell[y : y + 2, : x + past + 1] = 1
    elif weight == _DOUBLE:
        for row, near, far in ((y - 1, *along), (y + 1, *along[::-1])):
            past = -1 if near == _DOUBLE else int(far == _DOUBLE and not near and not opposite)
            cell[row, : x + past + 1] = 1
