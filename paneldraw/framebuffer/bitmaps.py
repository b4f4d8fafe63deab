"""Pictures as other programs hold them in bytes and in C source."""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import partial
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from paneldraw.framebuffer.pictures import Levels

Format = Literal["MONO_HLSB", "MONO_HMSB", "MONO_VLSB", "MONO_VMSB", "GS2_HMSB", "GS4_HMSB", "GS8", "RGB565"]


def _bits_across(order: Literal["big", "little"], data: Levels, width: int, height: int) -> Levels:
    return np.unpackbits(data.reshape(height, -1), axis=1, bitorder=order)[:, :width]


def _bits_down(order: Literal["big", "little"], data: Levels, width: int, height: int) -> Levels:
    pages = data.reshape(-1, 1, width)
    return np.unpackbits(pages, axis=1, bitorder=order).reshape(-1, width)[:height]


def _parts(shifts: tuple[int, ...], data: Levels, width: int, height: int) -> Levels:
    """Several pixels a byte, the first one shifted left by the first of `shifts`."""
    shifted = data.reshape(height, -1, 1) >> np.array(shifts, np.uint8)
    return (shifted & np.uint8((1 << 8 // len(shifts)) - 1)).reshape(height, -1)[:, :width]


def _colors(data: Levels, width: int, height: int) -> Levels:
    """Five bits of red, six of green and five of blue, the low byte first, as their luma."""
    words = data.view("<u2").reshape(height, width).astype(int)
    luma = 299 * (words >> 11) * 255 / 31 + 587 * (words >> 5 & 63) * 255 / 63 + 114 * (words & 31) * 255 / 31
    return np.rint(luma / 1000).astype(np.uint8)


class _Format(NamedTuple):
    depth: int
    length: Callable[[int, int], int]
    """How many bytes a picture of a width and height has."""
    read: Callable[[Levels, int, int], Levels]


def _rows(width: int, height: int) -> int:
    return (width + 7) // 8 * height


def _pages(width: int, height: int) -> int:
    return (height + 7) // 8 * width


_FORMATS = {
    "MONO_HLSB": _Format(1, _rows, partial(_bits_across, "big")),
    "MONO_HMSB": _Format(1, _rows, partial(_bits_across, "little")),
    "MONO_VLSB": _Format(1, _pages, partial(_bits_down, "little")),
    "MONO_VMSB": _Format(1, _pages, partial(_bits_down, "big")),
    "GS2_HMSB": _Format(2, lambda width, height: (width + 3) // 4 * height, partial(_parts, (0, 2, 4, 6))),
    "GS4_HMSB": _Format(4, lambda width, height: (width + 1) // 2 * height, partial(_parts, (4, 0))),
    "GS8": _Format(8, lambda width, height: width * height, lambda data, width, height: data.reshape(height, width)),
    "RGB565": _Format(8, lambda width, height: 2 * width * height, _colors),
}


def read_bytes(data: Any, width: int, height: int, format: str) -> tuple[Levels, int]:
    """Return levels of shape (height, width), and bits a pixel; see `Sprite.from_bytes`."""
    if not isinstance(format, str) or format not in _FORMATS:
        raise ValueError(f"format must be one of {', '.join(_FORMATS)}, not {format!r}")
    known = _FORMATS[format]
    held = _held(data)
    wanted = known.length(width, height)
    if held.size != wanted:
        raise ValueError(f"{width} x {height} pixels of {format} are {wanted} bytes, and data has {held.size}")
    return np.ascontiguousarray(known.read(held, width, height)), known.depth


def _held(data: Any) -> NDArray[np.uint8]:
    try:
        if isinstance(data, (int, str)):
            raise TypeError
        # numpy refuses bytes of which there are none.
        return np.frombuffer(bytes(data) + b"\0", np.uint8)[:-1]
    except (TypeError, ValueError):
        raise TypeError(f"data must be bytes or numbers 0 ... 255, not {type(data).__name__}") from None


# -- C source

_COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
_ARRAY = re.compile(
    r"(?P<type>[\w\s]*?)\b(?P<name>\w+)\s*(?:\[[^\]]*\]\s*)+[^={};]*=\s*(?P<body>\{(?:[^{};]|\{[^{};]*\})*\})"
)
_WORDS = re.compile(r"\b(?:short|u?int16_t)\b")
_SIZE_IN_COMMENT = re.compile(r"(\d+)\s*[xX]\s*(\d+)\s*(?:px|pixels?)?")


def _bytes_of(array: re.Match[str]) -> bytes:
    """The bytes that an array holds; numbers of 16 bits the low byte first."""
    size = 2 if _WORDS.search(array["type"]) else 1
    numbers = [_number(word) for word in re.split(r"[{},\s]+", array["body"].strip("{} ,\t\r\n")) if word]
    if any(not -(1 << 8 * size - 1) <= number < 1 << 8 * size for number in numbers):
        raise ValueError(f"{array['name']} holds numbers of more than {8 * size} bits")
    return b"".join((number % (1 << 8 * size)).to_bytes(size, "little") for number in numbers)


def _number(word: str) -> int:
    """The value of a C number, or of one of Arduino's like B0110."""
    digits = re.sub(r"(?i)u?l*$", "", word)
    for pattern, base in (
        ("B[01]+", 2),
        ("0[bB][01]+", 2),
        ("0[xX][0-9a-fA-F]+", 16),
        ("0[0-7]*", 8),
        ("-?[1-9][0-9]*", 10),
    ):
        if re.fullmatch(pattern, digits):
            return int(digits.lstrip("B"), base)
    raise ValueError(f"{word!r} is no number; an array of bytes is wanted")


def array_of(text: str, name: str | None) -> tuple[str, bytes]:
    """Return the name and bytes of one array of a C source: the one called `name`, else the only one of numbers."""
    arrays = {array["name"]: array for array in _ARRAY.finditer(_COMMENT.sub(" ", text))}
    likely = [one for one, array in arrays.items() if re.search(r"\d", array["body"].split(",")[0])] or list(arrays)
    if name is None and len(likely) == 1:
        name = likely[0]
    if name is None or name not in arrays:
        there = ", ".join(arrays) or "none"
        raise ValueError(f"the text has no array {name or 'alone'}; there are: {there}")
    return name, _bytes_of(arrays[name])


def size_of(text: str, name: str) -> tuple[int, int] | None:
    """Return the width and height that a C source tells of an array: in ``#define``s, or in the comment before it."""
    stem = re.sub(r"_?bits$", "", name)
    define = rf"^\s*#\s*define\s+{re.escape(stem)}_?%s\s+(\d+)"
    wide, high = (re.search(define % side, text, re.M | re.I) for side in ("width", "height"))
    if wide and high:
        return int(wide[1]), int(high[1])
    at = re.search(rf"\b{re.escape(name)}\b\s*\[", text)
    before = text[: at.start() if at else 0]
    comments = _COMMENT.findall(before)
    told = _SIZE_IN_COMMENT.search(comments[-1]) if comments else None
    return (int(told[1]), int(told[2])) if told else None
