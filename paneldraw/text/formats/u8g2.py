"""The fonts of U8g2, as the C source that it has them in.

The format is described in the project's wiki, page "u8g2fontformat": 23 bytes of header, then characters of one-byte
codes, then a table that leads to those of two-byte codes. Pictures are runs of dark and lit pixels, of so many bits
each, that repeat while a bit says so.
"""

from __future__ import annotations

import re

import numpy as np

from paneldraw.text.formats import LARGEST, DamagedFontError, Pictures
from paneldraw.text.formats.charsets import to_unicode
from paneldraw.text.strike import Picture, Strike

_HEADER = 23
_ARRAY = re.compile(rb"\b(u8g2_font_\w+)\s*\[[^\]]*\][^=;{]*=\s*")
_STRING = re.compile(rb'\s*"((?:[^"\\]|\\.)*)"', re.S)
_ESCAPE = re.compile(rb"\\(?:([0-7]{1,3})|x([0-9A-Fa-f]{1,2})|(.))", re.S)
_ESCAPED = {b"n": b"\n", b"t": b"\t", b"r": b"\r", b"a": b"\a", b"b": b"\b", b"f": b"\f", b"v": b"\v"}


def names(source: bytes) -> list[str]:
    """The fonts in a C source."""
    return [match[1].decode("ascii") for match in _ARRAY.finditer(source)]


def read(source: bytes, name: str, encoding: str | None) -> Strike:
    """Read the font of that name from a C source, or its only one."""
    arrays = {match[1].decode("ascii"): match.end() for match in _ARRAY.finditer(source)}
    if not arrays:
        raise DamagedFontError("a C source without an array u8g2_font_...")
    if name not in arrays and len(arrays) != 1:
        some = ", ".join(sorted(arrays)[:8]) + (", …" if len(arrays) > 8 else "")
        raise DamagedFontError(f"{len(arrays)} fonts: put the name of one behind the path and a #, of {some}")
    chosen = name if name in arrays else next(iter(arrays))
    data = _bytes(source, arrays[chosen])
    if len(data) < _HEADER:
        raise DamagedFontError("a font of U8g2 that ends within its header")
    raw = _characters(data)
    if not raw:
        raise DamagedFontError("a font of U8g2 without any character")
    points = to_unicode(encoding or "", raw)
    bits = tuple(data[2:9])
    descent = -_signed(data[12])
    ascent = min(max(data[10] - descent, 1), 255)

    def picture(glyph: bytes) -> Picture:
        return _picture(glyph, bits, ascent)

    pictures = Pictures({points[code]: glyph for code, glyph in raw.items() if code in points}, picture)
    return Strike(chosen, ascent, max(descent, 0), pictures)


def _signed(byte: int) -> int:
    return byte - 256 if byte > 127 else byte


def _bytes(source: bytes, at: int) -> bytes:
    """The bytes of an array: strings side by side, or numbers in braces."""
    if source[at : at + 1] == b"{":
        numbers = re.findall(rb"0[xX][0-9A-Fa-f]+|\d+", source[at : source.find(b"}", at)])
        return bytes(int(number, 0) & 255 if not number.isdigit() else int(number) & 255 for number in numbers)
    parts = []
    while match := _STRING.match(source, at):
        parts.append(_ESCAPE.sub(_unescaped, match[1]))
        at = match.end()
    # The zero that C puts behind a string ends the last list of characters.
    return b"".join(parts) + b"\0"


def _unescaped(match: re.Match[bytes]) -> bytes:
    if match[1]:
        return bytes((int(match[1], 8) & 255,))
    if match[2]:
        return bytes((int(match[2], 16),))
    return _ESCAPED.get(match[3], match[3])


def _characters(data: bytes) -> dict[int, bytes]:
    """What stands behind the code and size of each character."""
    found: dict[int, bytes] = {}
    at = _HEADER
    while at + 2 <= len(data) and data[at + 1] >= 2:
        found.setdefault(data[at], data[at + 2 : at + data[at + 1]])
        at += data[at + 1]
    table = _HEADER + int.from_bytes(data[21:23], "big")
    at = table + int.from_bytes(data[table : table + 2], "big") if table > _HEADER else len(data)
    while at + 3 <= len(data) and data[at + 2] >= 3 and (data[at] or data[at + 1]):
        found.setdefault(int.from_bytes(data[at : at + 2], "big"), data[at + 3 : at + data[at + 2]])
        at += data[at + 2]
    return found


class _Bits:
    """Numbers of so many bits, the lowest first."""

    def __init__(self, data: bytes) -> None:
        self._rest, self.left = int.from_bytes(data, "little"), 8 * len(data)

    def take(self, count: int) -> int:
        number = self._rest & ((1 << count) - 1)
        self._rest >>= count
        self.left -= count
        return number

    def take_signed(self, count: int) -> int:
        return self.take(count) - (1 << (count - 1) if count else 0)


def _picture(glyph: bytes, bits: tuple[int, ...], ascent: int) -> Picture:
    dark, lit, *of_sizes = bits
    source = _Bits(glyph)
    width, height = source.take(of_sizes[0]), source.take(of_sizes[1])
    left, bottom, advance = (source.take_signed(count) for count in of_sizes[2:])
    if not (width <= LARGEST and height <= LARGEST and max(abs(left), abs(bottom), abs(advance)) <= LARGEST):
        raise ValueError("sizes that make no sense")
    ink = np.zeros(width * height, np.uint8)
    at = 0
    while at < len(ink) and source.left > 0:
        off, on = source.take(dark), source.take(lit)
        repeat = True
        while repeat and at < len(ink):
            ink[at + off : at + off + on] = 1
            at += off + on
            repeat = bool(source.take(1)) and source.left > 0
            if off + on == 0:
                break
    return Picture(ink.reshape(height, width), left, ascent - bottom - height, advance)
