"""BDF, Adobe's Glyph Bitmap Distribution Format 2.1 (Adobe technical note 5005), as real files have it.

Of 390 that are around, a third break the letter of it: no CHARS or ENDFONT, no properties, rows unlike their BBX,
numbers in quotes, DWIDTH 0, ends of lines of other systems, comments in 8 bits. None of that keeps one from being read;
FreeType opens 247 of them, and Pillow's reader 382, of which it keeps 256 characters.
"""

from __future__ import annotations

import re

from paneldraw.text.characters import is_mark
from paneldraw.text.formats import DamagedFontError, Pictures, unpacked
from paneldraw.text.formats.charsets import to_unicode
from paneldraw.text.strike import Picture, Strike

_WORD = re.compile(rb"^[ \t]*([A-Z_]+)[ \t]+(.*?)[ \t]*$", re.M)
_ENCODING = re.compile(rb"^[ \t]*ENCODING[ \t]+(-?\d+)(?:[ \t]+(\d+))?", re.M)
_NAMED = re.compile(rb"[ \t]*(?:uni|u|U\+)([0-9A-Fa-f]{4,6})\s")
_NOT_HEX = re.compile(rb"[^0-9A-Fa-f]")


def read(data: bytes, name: str, encoding: str | None) -> Strike:
    """Read a font."""
    data = data.replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    header, *chunks = re.split(rb"^[ \t]*STARTCHAR\b", data, flags=re.M)
    said = {word: value.strip(b'"') for word, value in reversed(_WORD.findall(header))}
    chunks_of: dict[int, bytes] = {}
    for chunk in chunks:
        code = _code(chunk)
        if code >= 0:
            chunks_of.setdefault(code, chunk)
    if not chunks_of:
        raise DamagedFontError("a BDF file without any character that has a code")
    points = to_unicode(encoding or _charset(said), chunks_of)
    width, height, left, bottom = _numbers(said.get(b"FONTBOUNDINGBOX", b""), 4) or (0, 0, 0, 0)
    ascent = _number(said.get(b"FONT_ASCENT"), height + bottom)
    descent = _number(said.get(b"FONT_DESCENT"), -bottom)
    if not 0 < ascent + descent <= 4096:
        ascent, descent = max(height + bottom, 1), max(-bottom, 0)
    common = width + left, width, height, left, bottom

    def picture(item: tuple[int, bytes]) -> Picture:
        return _picture(item, common, ascent)

    raw = {points[code]: (points[code], chunk) for code, chunk in chunks_of.items() if code in points}
    default = _number(said.get(b"DEFAULT_CHAR"), -1)
    return Strike(
        said.get(b"FAMILY_NAME", b"").decode("latin-1") or name,
        ascent,
        descent,
        Pictures(raw, picture),
        missing=points.get(default) if default in chunks_of and default not in (0x20, 0xA0) else None,
        size=_number(said.get(b"PIXEL_SIZE"), 0) or None,
    )


def _code(chunk: bytes) -> int:
    """The code of a character, else -1; one without has it in its name, or behind."""
    found = _ENCODING.search(chunk)
    if found and int(found[1]) >= 0:
        return int(found[1])
    named = _NAMED.match(chunk)
    if named:
        return int(named[1], 16)
    return int(found[2]) if found and found[2] else -1


def _charset(said: dict[bytes, bytes]) -> str:
    registry, encoding = said.get(b"CHARSET_REGISTRY", b""), said.get(b"CHARSET_ENCODING", b"")
    if not registry:
        parts = said.get(b"FONT", b"").split(b"-")
        registry, encoding = (parts[-2], parts[-1]) if len(parts) == 15 else (b"", b"")
    return f"{registry.decode('latin-1')}-{encoding.decode('latin-1')}" if registry else ""


def _picture(item: tuple[int, bytes], common: tuple[int, ...], ascent: int) -> Picture:
    code, chunk = item
    advance, *box = common
    head, _, tail = chunk.partition(b"BITMAP")
    said = dict(_WORD.findall(head))
    width, height, left, bottom = _numbers(said.get(b"BBX", b""), 4) or box
    advance = _number(said.get(b"DWIDTH"), advance)
    if advance <= 0 and not is_mark(code) and width > 1:
        # A letter that does not move the pen would be written over by the next.
        advance = max(width + left, 1)
    stride = (width + 7) // 8
    rows = [_NOT_HEX.sub(b"", row) for row in tail.partition(b"ENDCHAR")[0].split(b"\n")[1 : 1 + max(height, 0)]]
    ink = unpacked(b"".join(bytes.fromhex(_digits(row, stride)) for row in rows), width, height)
    return Picture(ink, left, ascent - bottom - height, advance)


def _digits(row: bytes, stride: int) -> str:
    return row[: 2 * stride].ljust(2 * stride, b"0").decode("ascii")


def _numbers(value: bytes, count: int) -> tuple[int, ...] | None:
    found = re.findall(rb"-?\d+", value)[:count]
    return tuple(max(min(int(number[:9]), 9999), -9999) for number in found) if len(found) == count else None


def _number(value: bytes | None, default: int) -> int:
    found = _numbers(value or b"", 1)
    return found[0] if found else default
