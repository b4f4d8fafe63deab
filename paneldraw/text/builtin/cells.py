"""The characters of the built-in fonts: drawn, put together from a letter and its marks, or made by rule."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Iterator, Mapping

import numpy as np
from numpy.typing import NDArray

from paneldraw.text.builtin.boxes import by_rule
from paneldraw.text.builtin.drawings import Cell, alike, drawings
from paneldraw.text.strike import Picture

#: The combining marks, and what names their drawings.
MARKS = {
    "\u0300": "`",
    "\u0301": "´",  # noqa: RUF001
    "\u0302": "^",
    "\u0303": "~",
    "\u0304": "¯",
    "\u0306": "˘",
    "\u0307": "˙",
    "\u0308": "¨",
    "\u030a": "˚",
    "\u030b": "˝",
    "\u030c": "ˇ",
    "\u0326": ",",
    "\u0327": "¸",  # noqa: RUF001
    "\u0328": "˛",  # noqa: RUF001
    "\u0344": "΅",
}
#: Marks below a letter leave it as it is.
_BELOW = "\u0326\u0327\u0328"
#: Marks of one row, under which a small letter keeps its height, unless it would look like the capital.
_FLAT = "\u0304\u0307\u0308\u0344"
_LIKE_CAPITALS = "coswzиυ"  # noqa: RUF001
_DOTLESS = {"i": "ı", "j": "ȷ"}  # noqa: RUF001


class Cells(Mapping[int, Picture]):
    """The characters of a font by code point, each drawn when it is first asked for.

    Parameters
    ----------
    draw : callable
        Takes a character; returns its cell, or None if the font does not have it.
    """

    def __init__(self, draw: Callable[[str], Cell | None]) -> None:
        self._draw = draw
        self._drawn: dict[int, Picture] = {}

    def __getitem__(self, code: int) -> Picture:
        """Return the picture of a character."""
        found = self._drawn.get(code)
        if found is None:
            cell = self._draw(chr(code))
            if cell is None:
                raise KeyError(code)
            found = self._drawn[code] = Picture(cell, 0, 0, cell.shape[1])
        return found

    def __iter__(self) -> Iterator[int]:
        """Yield the code points in order."""
        return (code for code in range(0x20, 0x20000) if code in self)

    def __len__(self) -> int:
        """Count the characters."""
        return sum(1 for _ in self)


class Regular:
    """The characters of 6 x 8: ASCII is read at once, the rest with the first character beyond it."""

    width = 6

    def __init__(self) -> None:
        self._letters = self._read("ascii")
        self._marks: dict[str, Cell] = {}
        self._squeezed: dict[str, Cell] = {}
        self._alike: dict[str, str] = {}

    def __call__(self, char: str) -> Cell | None:
        """Return the cell of a character, or None if there is none."""
        found = self._letters.get(char)
        if found is None and not self._alike:
            self._read_on()
        char = unicodedata.normalize("NFC", char)
        char = self._alike.get(char, char)
        found = self._letters.get(char)
        if found is not None:
            return found
        parts = unicodedata.normalize("NFD", char)
        return self._composed(parts) if len(parts) > 1 else by_rule(char, self.width, 8)

    def _read(self, name: str) -> dict[str, Cell]:
        return drawings(name)

    def _read_on(self) -> None:
        self._alike = alike()
        self._marks, self._squeezed = self._read("marks"), self._read("squeezed")
        alone = {char: self._marks[name] for mark, name in MARKS.items() for char in (mark, name) if not char.isascii()}
        self._letters |= self._read("letters") | self._read("signs") | alone

    def _composed(self, parts: str) -> Cell | None:
        """Return a letter with a mark, the letter lower where it has to make room; None if it cannot."""
        letter, mark = self._alike.get(parts[0], parts[0]), parts[1:].replace("\u0308\u0301", "\u0344")
        whole = self._letters.get(unicodedata.normalize("NFC", letter + mark))
        if whole is not None or mark not in MARKS or not letter.isalpha():
            return whole
        base = None
        if mark not in _BELOW:
            letter = _DOTLESS.get(letter, letter)
            if letter.isupper() or mark not in _FLAT or letter in _LIKE_CAPITALS:
                base = self._squeezed.get(letter)
        if base is None and (mark in _BELOW or letter.islower()):
            base = self._letters.get(letter)
        drawn = self._marks[MARKS[mark]]
        return None if base is None or (base & drawn).any() else base | drawn


class Bold(Regular):
    """The characters of 8 x 8: those of 6 x 8 with strokes two pixels wide, or drawn where those would run together."""

    width = 8

    def _read(self, name: str) -> dict[str, Cell]:
        by_hand = {"marks": "bold_marks", "squeezed": "bold_squeezed"}.get(name, "bold")
        thin = drawings(name)
        return dict(zip(thin, bold(np.stack(list(thin.values()))), strict=True)) | drawings(by_hand, self.width)


def bold(cells: NDArray[np.uint8]) -> NDArray[np.uint8]:
    """Return cells with wider strokes and two more columns; where a gap is one pixel wide, strokes stay as they are."""
    wide = np.pad(cells, ((0, 0), (0, 0), (0, 2)))
    narrow: NDArray[np.uint8] = cells[..., :-2] & cells[..., 2:] & ~cells[..., 1:-1]
    thin, wide[..., 1:] = np.roll(wide, 1, axis=2), wide[..., 1:] | wide[..., :-1]
    return np.where(narrow.any(axis=(1, 2), keepdims=True), thin, wide)
