"""Fonts of columns: luma.core's own where it is installed, else paneldraw's under all their names."""

from __future__ import annotations

import functools
import importlib
from collections.abc import Iterable
from typing import Protocol

from paneldraw.framebuffer import Framebuffer
from paneldraw.text import Font

__all__ = ["default_font", "proportional", "tolerant"]

_NAMES = (
    "ATARI_FONT", "CP437_FONT", "DEFAULT_FONT", "LCD_FONT", "SEG7_FONT", "SINCLAIR_FONT", "SPECCY_FONT", "TINY_FONT",
    "UKR_FONT",
)  # fmt: skip


class Columns(Protocol):
    """What gives a character's columns by its code, a byte each, the upper pixel in the lowest bit."""

    def __getitem__(self, ascii_code: int) -> Iterable[int]:
        """Return the columns; IndexError where there are none."""


class proportional:
    """A font whose characters are as wide as what is drawn of them, and a column of space.

    Examples
    --------
    >>> font = [[0x00, 0x7F, 0x00]] * 128
    >>> proportional(font)[ord("l")]
    [127, 0]
    """

    def __init__(self, font: Columns) -> None:
        self.font = font

    def __getitem__(self, ascii_code: int) -> list[int]:
        try:
            columns = list(self.font[ascii_code])
        except IndexError:
            raise IndexError(f"this font has no character {ascii_code}: see tolerant") from None
        if ascii_code == ord(" "):
            return [0] * 4
        drawn = [x for x, pixels in enumerate(columns) if pixels]
        return [*columns[drawn[0] : drawn[-1] + 1], 0] if drawn else [0]


class tolerant:
    """A font that has another character, `missing`, for those that it has not.

    Examples
    --------
    >>> font = [[0x00]] * 128
    >>> tolerant(font, missing="?")[0x20AC]
    [0]
    """

    def __init__(self, font: Columns, missing: str = "_") -> None:
        self.font, self.missing_code = font, ord(missing)

    def __getitem__(self, ascii_code: int) -> Iterable[int]:
        try:
            return self.font[ascii_code]
        except IndexError:
            return self.font[self.missing_code]


@functools.cache
def _own() -> list[list[int]]:
    """Paneldraw's own font of 6x8 pixels, in columns."""
    font = Font.builtin()
    columns: list[list[int]] = [[0] * font.advance] * 32
    for code in range(32, 256):
        cell = Framebuffer(font.advance, 8)
        cell.text(chr(code), 0, 0)
        columns.append([sum(int(cell.pixels[y, x]) << y for y in range(8)) for x in range(font.advance)])
    return columns


@functools.cache
def _named(name: str) -> Columns:
    try:
        theirs = importlib.import_module("luma.core.legacy.font")
    except ImportError:
        return _own()
    font: Columns = getattr(theirs, name, None) or _own()
    return font


def default_font() -> Columns:
    """Return the font that is meant where none is named.

    Examples
    --------
    >>> len(list(default_font()[ord("A")])) in (6, 8)
    True
    """
    return _named("DEFAULT_FONT")


def __getattr__(name: str) -> Columns:
    """Find a font where somebody asks for it."""
    if name not in _NAMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}; fonts are {', '.join(_NAMES)}")
    return _named(name)
