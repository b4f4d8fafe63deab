"""What Unicode says of characters: which are seen, which stand on others, and which may stand for which."""

from __future__ import annotations

import unicodedata

_SPACES = {0xA0, *range(0x2000, 0x200B), 0x202F, 0x205F, 0x3000}
_HYPHENS = {0x2010, 0x2011}

# Formatting characters that have a picture all the same: signs of numbers in Arabic, Syriac and Kaithi.
_SEEN = {*range(0x600, 0x606), 0x6DD, 0x70F, 0x8E2, 0x110BD, 0x110CD}


def composed(text: str) -> str:
    """The text with letters and their marks as one character where there is one (NFC)."""
    return unicodedata.normalize("NFC", text)


def is_invisible(code: int) -> bool:
    """Whether a character is there for how others are set, and has neither width nor picture."""
    if code < 0xAD:
        return False
    return (
        code in (0xAD, 0x34F, 0x61C, 0x180E)
        or 0xFE00 <= code <= 0xFE0F
        or 0xE0000 <= code <= 0xE0FFF
        or (unicodedata.category(chr(code)) == "Cf" and code not in _SEEN)
    )


def is_mark(code: int) -> bool:
    """Whether a character stands on the one before it."""
    return code >= 0x300 and unicodedata.category(chr(code)) in ("Mn", "Me")


def substitutes(code: int) -> str:
    """What may be drawn in place of a character that a font lacks: a space, a hyphen, or a letter and its marks."""
    if code in _SPACES:
        return " "
    if code in _HYPHENS:
        return "-"
    parts = unicodedata.normalize("NFD", chr(code))
    return parts if len(parts) > 1 and all(is_mark(ord(mark)) for mark in parts[1:]) else ""
