"""From the codes of a font's own character set to Unicode."""

from __future__ import annotations

import codecs
import re
import unicodedata
from collections.abc import Iterable

_UNICODE = ("iso10646", "unicode", "utf")

# By the start of what X11 calls a set: the codec, what is added to a code of two bytes, and what stands before it.
_TWO_BYTES = {
    "jisx0208": ("euc_jp", 0x8080, b""),
    "jisx0212": ("euc_jp", 0x8080, b"\x8f"),
    "jisx0213": ("euc_jis_2004", 0x8080, b""),
    "jisc6226": ("euc_jp", 0x8080, b""),
    "gb2312": ("gb2312", 0x8080, b""),
    "ksc5601": ("euc_kr", 0x8080, b""),
    "ksx1001": ("euc_kr", 0x8080, b""),
    "gbk": ("gbk", 0, b""),
    "gb18030": ("gb18030", 0, b""),
    "big5": ("big5", 0, b""),
}
_ONE_BYTE = {"jisx0201": "shift_jis", "iso646": "ascii", "tis620": "tis-620", "applestandard": "mac_roman"}


def to_unicode(charset: str, codes: Iterable[int]) -> dict[int, int]:
    """Return, by code of a character set such as ``"KOI8-R"``, the code point.

    Codes of a set that Python has no codec for are taken as they are: ``chr(code)`` reaches them.
    """
    name = re.sub(r"[^a-z0-9]", "", charset.lower())
    points = {code: code for code in codes if 0 <= code <= 0x10FFFF}
    if not name or name.startswith(_UNICODE) or name in ("raw", "iso88591"):
        return points
    for start, (codec, added, before) in _TWO_BYTES.items():
        if name.startswith(start):
            return _decoded(points, codec, added, before)
    found = next((codec for start, codec in _ONE_BYTE.items() if name.startswith(start)), None) or _codec(charset)
    return _decoded(points, found, 0, b"") if found else points


def check(encoding: str) -> None:
    """Refuse the name of an encoding that there is none of."""
    if not isinstance(encoding, str) or (encoding != "raw" and not _known(encoding)):
        raise ValueError(f"encoding must be 'raw' or a character set of one of Python's codecs, not {encoding!r}")


def _known(charset: str) -> bool:
    name = re.sub(r"[^a-z0-9]", "", charset.lower())
    return name.startswith((*_UNICODE, *_TWO_BYTES, *_ONE_BYTE)) or _codec(charset) is not None


def _codec(charset: str) -> str | None:
    """Python's codec for a character set; X11 adds a maker's name or a number to some."""
    plain = charset.lower()
    for name in (plain, plain.split("-", 1)[-1], plain.rsplit("-", 1)[0], plain.replace("-", "")):
        try:
            # Codecs of bytes to bytes know no characters.
            "".encode(name)
            return codecs.lookup(name).name
        except (LookupError, ValueError, UnicodeError):
            continue
    return None


def _decoded(points: dict[int, int], codec: str, added: int, before: bytes) -> dict[int, int]:
    decoded = {}
    for code in points:
        if codec.startswith(("euc", "gb", "big5")) and code > 0x7F:
            data = before + ((code | added) & 0xFFFF).to_bytes(2, "big")
        elif code < 0x100:
            data = bytes((code,))
        else:
            continue
        try:
            text = unicodedata.normalize("NFC", data.decode(codec))
        except UnicodeError:
            continue
        if len(text) == 1:
            decoded[code] = ord(text)
    return decoded
