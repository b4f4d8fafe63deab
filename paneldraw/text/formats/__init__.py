"""Readers of the world's bitmap fonts: what they have in common.

A reader takes the bytes of a file, and keeps to what a file can be made to say: numbers that are missing or make no
sense have a default, a character that cannot be read is not there. Only a file without any character is refused.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Generic, TypeVar

import numpy as np

from paneldraw.text.strike import Picture

LARGEST = 1024
"""Pixels that a character may be wide or high: the fonts of clocks have some hundred."""

Raw = TypeVar("Raw")


class DamagedFontError(ValueError):
    """There is no font in a file, and why not."""


class Pictures(Mapping[int, Picture], Generic[Raw]):
    """Characters whose pictures are read when asked for: large fonts have 60 000, a script writes some hundred.

    Parameters
    ----------
    raw : dict
        By code point, what `read` takes.
    read : callable
        Returns the picture; raises ValueError if there is none that can be read.
    """

    def __init__(self, raw: dict[int, Raw], read: Callable[[Raw], Picture]) -> None:
        self._raw, self._read = raw, read

    def __getitem__(self, code: int) -> Picture:
        try:
            return self._read(self._raw[code])
        except ValueError as error:
            raise KeyError(code) from error

    def __contains__(self, code: object) -> bool:
        return code in self._raw

    def __iter__(self) -> Iterator[int]:
        return iter(self._raw)

    def __len__(self) -> int:
        return len(self._raw)


def unpacked(rows: bytes, width: int, height: int) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    """The pixels of rows of whole bytes, the highest bit leftmost; rows that are missing are empty."""
    if not (0 <= width <= LARGEST and 0 <= height <= LARGEST):
        raise ValueError(f"a character of {width} x {height} pixels")
    stride = (width + 7) // 8
    if not stride * height:
        return np.zeros((height, width), np.uint8)
    packed = np.frombuffer(rows[: stride * height].ljust(stride * height, b"\0"), np.uint8)
    return np.unpackbits(packed.reshape(height, stride), axis=1)[:, :width]


def standing_row(pictures: Mapping[int, Picture], default: int) -> int:
    """The row that letters stand on, of a font that does not say it: the lowest lit one of those that do stand."""
    for letter in "HEXMIAx01":
        picture = pictures.get(ord(letter))
        if picture is not None and picture.ink.any():
            return picture.top + int(np.flatnonzero(picture.ink.any(axis=1))[-1])
    return default
