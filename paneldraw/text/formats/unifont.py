"""The text form of GNU Unifont: a code and the hexadecimal digits of 16 rows, a character a line."""

from __future__ import annotations

import re

from paneldraw.text.formats import DamagedFontError, Pictures, unpacked
from paneldraw.text.strike import Picture, Strike

_LINE = re.compile(rb"^([0-9A-Fa-f]{4,6}):([0-9A-Fa-f]{16,1024})[ \t\r]*$", re.M)

_ROWS = 16
_DESCENT = 2


def read(data: bytes, name: str, encoding: str | None) -> Strike:
    """Read a font; its codes are Unicode's."""
    raw = {int(code, 16): digits for code, digits in _LINE.findall(data)}
    raw = {code: digits for code, digits in raw.items() if code <= 0x10FFFF}
    if not raw:
        raise DamagedFontError("a .hex file without any character")
    return Strike(name, _ROWS - _DESCENT, _DESCENT, Pictures(raw, _picture))


def _picture(digits: bytes) -> Picture:
    # Fonts of the same form but 8 columns in fewer rows have fewer digits than those take.
    stride = max(len(digits) // (2 * _ROWS), 1)
    rows = bytes.fromhex(digits[: len(digits) // 2 * 2].decode("ascii"))
    return Picture(unpacked(rows, 8 * stride, _ROWS), 0, 0, 8 * stride)
