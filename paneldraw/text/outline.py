"""Which characters an outline font has; Pillow tells only what it draws."""

from __future__ import annotations

import contextlib
import io
import os
import struct
from bisect import bisect_left
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from PIL import ImageFont

Lookup = Callable[[int], int]

LARGEST_TABLE = 1 << 22


def characters_of(font: ImageFont.FreeTypeFont) -> Callable[[int], bool]:
    """Return what says whether a font has a character: its table of characters, else a look at what is drawn."""
    _, lookup = _table_of(font)
    return (lambda code: lookup(code) != 0) if lookup is not None else _drawn(font)


def is_symbolic(font: ImageFont.FreeTypeFont) -> bool:
    """Whether a font has a table of symbols alone, whose codes Windows puts at F000; Pillow calls it ``symb``."""
    return _table_of(font)[0] == _SYMBOLS


def _table_of(font: ImageFont.FreeTypeFont) -> tuple[tuple[int, int], Lookup | None]:
    with contextlib.suppress(OSError, struct.error, ValueError, IndexError, OverflowError):
        return _lookup(_bytes_of(font), getattr(font, "index", 0))
    return _NONE


def is_scalable(font: ImageFont.FreeTypeFont) -> bool:
    """Whether a font has outlines; one of bitmaps alone is of its own sizes."""
    try:
        font.font_variant(size=61.25)
    except (OSError, ValueError):
        return False
    return True


def _drawn(font: ImageFont.FreeTypeFont) -> Callable[[int], bool]:
    """Whether what is drawn is something else than for what is no character."""

    def look(text: str) -> tuple[float, bytes]:
        return font.getlength(text, "1"), bytes(font.getmask(text, "1"))

    missing = look("\U0010ffff")
    return lambda code: chr(code).isspace() or look(chr(code)) != missing


def _bytes_of(font: ImageFont.FreeTypeFont) -> io.BufferedIOBase:
    data = getattr(font, "font_bytes", None)
    if data is not None:
        return io.BytesIO(data)
    if isinstance(font.path, (str, bytes, os.PathLike)):
        return Path(os.fsdecode(font.path)).open("rb")
    return io.BytesIO(font.path.getvalue()) if isinstance(font.path, io.BytesIO) else io.BytesIO()


def _lookup(file: io.BufferedIOBase, index: int) -> tuple[tuple[int, int], Lookup | None]:
    """Return what tells the glyph of a character, the table ``cmap`` of a font of TrueType's or OpenType's form."""
    with file:
        start = 0
        if file.read(4) == b"ttcf":
            file.seek(12 + 4 * index)
            (start,) = struct.unpack(">I", file.read(4))
        file.seek(start)
        kind, count = struct.unpack(">4sH6x", file.read(12))
        if kind not in (b"\0\1\0\0", b"OTTO", b"true", b"typ1"):
            return _NONE
        directory = file.read(16 * count)
        for tag, _, offset, length in struct.iter_unpack(">4sIII", directory[: len(directory) // 16 * 16]):
            if tag == b"cmap":
                file.seek(offset)
                return _best(file.read(min(length, LARGEST_TABLE)))
    return _NONE


_NONE = (-1, -1), None
_SYMBOLS = (3, 0)

# By platform and encoding, the ones that know more first: all of Unicode, then its first plane, then symbols.
_PREFERRED = ((3, 10), (0, 6), (0, 4), (3, 1), (0, 3), (0, 2), (0, 1), (0, 0), _SYMBOLS)


def _best(table: bytes) -> tuple[tuple[int, int], Lookup | None]:
    (count,) = struct.unpack_from(">2xH", table)
    places = {(p, e): at for p, e, at in (struct.unpack_from(">HHI", table, 4 + 8 * k) for k in range(count))}
    for key in _PREFERRED:
        if key in places:
            sub = table[places[key] :]
            read = {0: _format_0, 4: _format_4, 6: _format_6, 12: _format_12, 13: _format_12}
            form = struct.unpack_from(">H", sub)[0]
            if form in read:
                return key, read[form](sub)
    return _NONE


def _format_0(sub: bytes) -> Lookup:
    return lambda code: sub[6 + code] if code < min(256, len(sub) - 6) else 0


def _format_4(sub: bytes) -> Lookup:
    """Segments of codes with one distance to their glyphs each, or glyphs one by one."""
    count = struct.unpack_from(">6xH", sub)[0] // 2
    ends: tuple[int, ...] = struct.unpack_from(f">{count}H", sub, 14)
    starts: tuple[int, ...] = struct.unpack_from(f">{count}H", sub, 16 + 2 * count)
    deltas: tuple[int, ...] = struct.unpack_from(f">{count}H", sub, 16 + 4 * count)
    offsets = struct.unpack_from(f">{count}H", sub, 16 + 6 * count)

    def glyph(code: int) -> int:
        segment = bisect_left(ends, code)
        if segment >= count or code < starts[segment]:
            return 0
        if not offsets[segment]:
            return (code + deltas[segment]) & 0xFFFF
        place = 16 + 6 * count + 2 * segment + offsets[segment] + 2 * (code - starts[segment])
        if place + 2 > len(sub):
            return 0
        found = int.from_bytes(sub[place : place + 2], "big")
        return (found + deltas[segment]) & 0xFFFF if found else 0

    return glyph


def _format_6(sub: bytes) -> Lookup:
    first, count = struct.unpack_from(">6xHH", sub)
    glyphs: tuple[int, ...] = struct.unpack_from(f">{min(count, (len(sub) - 10) // 2)}H", sub, 10)
    return lambda code: glyphs[code - first] if 0 <= code - first < len(glyphs) else 0


def _format_12(sub: bytes) -> Lookup:
    """Groups of codes whose glyphs follow one another (format 12) or are the same (13)."""
    form, count = struct.unpack_from(">H10xI", sub)
    count = min(count, (len(sub) - 16) // 12)
    groups: list[tuple[int, int, int]] = list(struct.iter_unpack(">III", sub[16 : 16 + 12 * count]))
    ends = [end for _, end, _ in groups]

    def glyph(code: int) -> int:
        group = bisect_left(ends, code)
        if group >= count or code < groups[group][0]:
            return 0
        start, _, first = groups[group]
        return first + (code - start if form == 12 else 0)

    return glyph
