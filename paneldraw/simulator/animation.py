"""Animated GIFs and PNGs, written frame by frame: a recording of hours is as small in memory as one of a second.

The forms are CompuServe's GIF89a and the W3C's PNG, third edition (chunks ``acTL``, ``fcTL`` and ``fdAT``). Each frame
has the rectangle that changed; Pillow packs it for GIF.
"""

from __future__ import annotations

import io
import struct
import zlib
from typing import IO, Final, Protocol

import numpy as np
from numpy.typing import NDArray

Colors = NDArray[np.uint8]
"""Numbers of a palette's colors, shape (height, width)."""

_LONGEST: Final = 0xFFFF
_PNG: Final = b"\x89PNG\r\n\x1a\n"
_BITS, _PALETTED = 8, 3
_LOOP: Final = b"\x21\xff\x0bNETSCAPE2.0\x03\x01\x00\x00\x00"


class Animation(Protocol):
    """A file that frames are added to."""

    unit: int
    """Milliseconds that times are counted in."""

    def add(self, colors: Colors, x: int, y: int, milliseconds: int) -> None:
        """Add a rectangle that changed, and for how long it stays."""

    def close(self) -> None:
        """Write the end."""


class GIF:
    """An animated GIF; the first frame is whole."""

    unit = 10

    def __init__(self, file: IO[bytes], width: int, height: int, palette: bytes, count: int) -> None:
        self._file, self._palette = file, palette
        table = palette.ljust(768, b"\0")
        file.write(b"GIF89a" + struct.pack("<HHBBB", width, height, 0xF7, 0, 0) + table + _LOOP)

    def add(self, colors: Colors, x: int, y: int, milliseconds: int) -> None:
        """Add a frame; one that stays for longer than eleven minutes is several."""
        delay = milliseconds // self.unit
        while delay > _LONGEST:
            self._add(colors, x, y, _LONGEST)
            colors, delay = colors[:1, :1], delay - _LONGEST
        self._add(colors, x, y, delay)

    def _add(self, colors: Colors, x: int, y: int, delay: int) -> None:
        height, width = colors.shape
        control = struct.pack("<BBBBHBB", 0x21, 0xF9, 4, 0x04, delay, 0, 0)  # left in place
        place = struct.pack("<BHHHHB", 0x2C, x, y, width, height, 0)
        self._file.write(control + place + _packed(colors, self._palette))

    def close(self) -> None:
        """Write the end."""
        self._file.write(b"\x3b")


def _packed(colors: Colors, palette: bytes) -> bytes:
    """A picture as GIF packs it, out of the file that Pillow makes of it."""
    from PIL import Image

    picture, file = Image.fromarray(colors), io.BytesIO()
    picture.putpalette(palette)
    picture.save(file, "GIF", optimize=False, interlace=False)
    content = file.getvalue()
    at = 13 + 3 * (2 << (content[10] & 7))
    while content[at] == 0x21:  # extensions: a label and blocks, the last one empty
        at += 2
        while content[at]:
            at += 1 + content[at]
        at += 1
    return content[at + 10 : -1]


class APNG:
    """An animated PNG; the first frame is whole, and what viewers without animations show."""

    unit = 1

    def __init__(self, file: IO[bytes], width: int, height: int, palette: bytes, count: int) -> None:
        self._file, self._number, self._first = file, 0, True
        file.write(_PNG)
        self._chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, _BITS, _PALETTED, 0, 0, 0))
        self._chunk(b"acTL", struct.pack(">II", count, 0))
        self._chunk(b"PLTE", palette)

    def add(self, colors: Colors, x: int, y: int, milliseconds: int) -> None:
        """Add a frame; what stays for longer than a minute is timed less finely."""
        height, width = colors.shape
        parts = next(parts for parts in (1000, 100, 10, 1) if milliseconds * parts // 1000 <= _LONGEST or parts == 1)
        delay = min(milliseconds * parts // 1000, _LONGEST)
        self._chunk(b"fcTL", struct.pack(">IIIIIHHBB", self._next(), width, height, x, y, delay, parts, 0, 0))
        rows = np.zeros((height, width + 1), np.uint8)  # each with the number of its filter, none
        rows[:, 1:] = colors
        packed = zlib.compress(rows.tobytes(), 3)
        if self._first:
            self._chunk(b"IDAT", packed)
            self._first = False
        else:
            self._chunk(b"fdAT", struct.pack(">I", self._next()) + packed)

    def _next(self) -> int:
        self._number += 1
        return self._number - 1

    def _chunk(self, kind: bytes, content: bytes) -> None:
        checked = kind + content
        self._file.write(struct.pack(">I", len(content)) + checked + struct.pack(">I", zlib.crc32(checked)))

    def close(self) -> None:
        """Write the end."""
        self._chunk(b"IEND", b"")


FORMS: Final[dict[str, type[GIF] | type[APNG]]] = {".gif": GIF, ".apng": APNG}
"""By extension."""
