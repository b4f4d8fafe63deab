"""PSF 1 and 2, the fonts of the Linux console."""

from __future__ import annotations

import struct
import unicodedata

from paneldraw.text.formats import LARGEST, DamagedFontError, Pictures, standing_row, unpacked
from paneldraw.text.formats.charsets import to_unicode
from paneldraw.text.strike import Picture, Strike

MAGICS = (b"\x36\x04", b"\x72\xb5\x4a\x86")

_DIRECT = 0xF000
"""Where Linux puts the characters of a console font that have no code (Documentation/admin-guide/unicode.rst)."""


def read(data: bytes, name: str, encoding: str | None) -> Strike:
    """Read a font."""
    try:
        if data.startswith(MAGICS[0]):
            mode, size = data[2], data[3]
            start, count, width, height, has_table = 4, 512 if mode & 1 else 256, 8, size, bool(mode & 6)
        else:
            start, flags, count, size, height, width = struct.unpack_from("<6I", data, 8)
            has_table = bool(flags & 1)
    except (struct.error, IndexError) as error:
        raise DamagedFontError("a PSF file that ends within its header") from error
    count = min(count, (len(data) - start) // size if size else 0)
    if not (count > 0 and 0 < width <= LARGEST and 0 < height <= LARGEST):
        raise DamagedFontError(f"a PSF file of {max(count, 0)} characters of {width} x {height} pixels")
    table = data[start + count * size :] if has_table and not encoding else b""
    codes = _wide(table, count) if data.startswith(MAGICS[0]) else _utf8(table, count)
    if not codes:
        codes = {point: code for code, point in to_unicode(encoding or "cp437", range(min(count, 256))).items()}
    raw = {_DIRECT + k: k for k in range(count)} | codes

    def picture(k: int) -> Picture:
        return Picture(unpacked(data[start + k * size : start + (k + 1) * size], width, height), 0, 0, width)

    pictures = Pictures(raw, picture)
    ascent = standing_row(pictures, height - 1) + 1
    return Strike(name, ascent, height - ascent, pictures)


def _wide(table: bytes, count: int) -> dict[int, int]:
    """Read PSF 1's table: 16-bit codes of each character, then of sequences, each behind FFFE, to FFFF."""
    codes: dict[int, int] = {}
    words = struct.unpack(f"<{len(table) // 2}H", table[: len(table) // 2 * 2])
    k, sequence = 0, False
    for word in words:
        if k >= count:
            break
        if word == 0xFFFF:
            k, sequence = k + 1, False
        elif word == 0xFFFE:
            sequence = True
        elif not sequence:
            codes.setdefault(word, k)
    return codes


def _utf8(table: bytes, count: int) -> dict[int, int]:
    """Read PSF 2's table: UTF-8 of each character, then of sequences, each behind FE, to FF."""
    codes: dict[int, int] = {}
    for k, entry in enumerate(table.split(b"\xff")[:count]):
        singles, *sequences = entry.split(b"\xfe")
        for char in singles.decode("utf-8", "ignore"):
            codes.setdefault(ord(char), k)
        for sequence in sequences:
            text = unicodedata.normalize("NFC", sequence.decode("utf-8", "ignore"))
            if len(text) == 1:
                codes.setdefault(ord(text), k)
    return codes
