"""PCF, X11's compiled bitmap fonts, by the tables that its libXfont reads."""

from __future__ import annotations

import struct
from dataclasses import dataclass

import numpy as np

from paneldraw.text.formats import DamagedFontError, Pictures, unpacked
from paneldraw.text.formats.charsets import to_unicode
from paneldraw.text.strike import Picture, Strike

_PROPERTIES, _ACCELERATORS, _METRICS, _BITMAPS, _ENCODINGS = 1, 2, 4, 8, 32
_BDF_ACCELERATORS = 256
_COMPRESSED_METRICS = 0x100


@dataclass(frozen=True)
class _Table:
    """A table's bytes behind its format, and what the format says of them."""

    data: bytes
    format: int

    def read(self, layout: str, at: int = 0) -> tuple[int, ...]:
        """Numbers in the table's byte order."""
        return struct.unpack_from((">" if self.format & 4 else "<") + layout, self.data, at)


def read(data: bytes, name: str, encoding: str | None) -> Strike:
    """Read a font."""
    try:
        return _read(data, name, encoding)
    except (struct.error, IndexError, KeyError, OverflowError) as error:
        raise DamagedFontError("a PCF file that is cut short or damaged") from error


def _read(data: bytes, name: str, encoding: str | None) -> Strike:
    tables = {}
    (count,) = struct.unpack_from("<I", data, 4)
    for k in range(min(count, 64)):
        kind, form, size, offset = struct.unpack_from("<4I", data, 8 + 16 * k)
        tables[kind] = _Table(data[offset + 4 : offset + size], form)
    said = _properties(tables[_PROPERTIES]) if _PROPERTIES in tables else {}
    indices, default = _encodings(tables[_ENCODINGS])
    metrics, bitmaps = tables[_METRICS], tables[_BITMAPS]
    accelerators = tables.get(_BDF_ACCELERATORS) or tables[_ACCELERATORS]
    ascent, descent = accelerators.read("ii", 8)
    if not 0 < ascent + descent <= 4096:
        raise DamagedFontError(f"a PCF file whose lines are {ascent + descent} pixels high")
    (glyphs,) = bitmaps.read("I")
    start = 4 + 4 * glyphs + 16

    def picture(index: int) -> Picture:
        try:
            left, right, advance, above, below = _metrics(metrics, index)
            (offset,) = bitmaps.read("I", 4 + 4 * index)
        except struct.error as error:
            raise ValueError("no such glyph") from error
        ink = _ink(bitmaps, start + offset, right - left, above + below)
        return Picture(ink, left, ascent - above, advance)

    points = to_unicode(encoding or _charset(said), indices)
    raw = {points[code]: index for code, index in indices.items() if code in points and index < glyphs}
    if not raw:
        raise DamagedFontError("a PCF file without any character that has a code")
    missing = points.get(default) if default in indices and default not in (0x20, 0xA0) else None
    family, size = said.get("FAMILY_NAME"), said.get("PIXEL_SIZE")
    return Strike(
        family if isinstance(family, str) and family else name,
        ascent,
        descent,
        Pictures(raw, picture),
        missing=missing,
        size=size if isinstance(size, int) and size > 0 else None,
    )


def _charset(said: dict[str, str | int]) -> str:
    registry, encoding = said.get("CHARSET_REGISTRY"), said.get("CHARSET_ENCODING")
    return f"{registry}-{encoding}" if registry else ""


def _properties(table: _Table) -> dict[str, str | int]:
    (count,) = table.read("I")
    count = min(count, len(table.data) // 9)
    start = 4 + 9 * count + (-count & 3)
    strings = table.data[start + 4 :]

    def text(at: int) -> str:
        return strings[at : strings.find(b"\0", at)].decode("latin-1")

    said: dict[str, str | int] = {}
    for k in range(count):
        key, is_text, value = table.read("IBi", 4 + 9 * k)
        said[text(key)] = text(value) if is_text else value
    return said


def _encodings(table: _Table) -> tuple[dict[int, int], int]:
    """The glyph of each code, and the code of what stands for the others."""
    low, high, first, last, default = table.read("5H")
    columns = high - low + 1
    count = max(columns, 0) * max(last - first + 1, 0)
    numbers = table.read(f"{min(count, (len(table.data) - 10) // 2)}H", 10)
    indices = {(first + k // columns) << 8 | (low + k % columns): glyph for k, glyph in enumerate(numbers)}
    return {code: glyph for code, glyph in indices.items() if glyph != 0xFFFF}, default


def _metrics(table: _Table, index: int) -> tuple[int, ...]:
    """First and last column, advance, rows above and below the baseline."""
    if table.format & _COMPRESSED_METRICS:
        return tuple(number - 0x80 for number in table.read("5B", 2 + 5 * index))
    return table.read("5h", 4 + 12 * index)


def _ink(table: _Table, start: int, width: int, height: int) -> np.ndarray[tuple[int, int], np.dtype[np.uint8]]:
    """The pixels of a glyph, whose rows are padded, whose bits and bytes stand in either order."""
    pad = 1 << (table.format & 3)
    stride = (max(width, 0) + 8 * pad - 1) // (8 * pad) * pad
    rows = table.data[start : start + stride * max(height, 0)].ljust(min(stride * max(height, 0), 1 << 22), b"\0")
    bytes_first, bits_first = bool(table.format & 4), bool(table.format & 8)
    pixels = np.frombuffer(rows, np.uint8)
    unit = 1 << (table.format >> 4 & 3)
    if unit > 1 and bytes_first != bits_first and len(pixels) % unit == 0:
        pixels = pixels.reshape(-1, unit)[:, ::-1].ravel()
    if not bits_first:
        pixels = np.packbits(np.unpackbits(pixels, bitorder="little"))
    return unpacked(pixels.tobytes(), 8 * stride, height)[:, : max(width, 0)]
