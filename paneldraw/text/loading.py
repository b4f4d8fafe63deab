"""Fonts from files: what kind of font a file is, who reads it, and which sizes it has."""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from paneldraw.text.faces import is_damage
from paneldraw.text.font import Font, of_strike, outline
from paneldraw.text.formats import DamagedFontError, bdf, charsets, pcf, psf, u8g2, unifont
from paneldraw.text.outline import characters_of, is_scalable, is_symbolic
from paneldraw.text.strike import Picture, Strike

if TYPE_CHECKING:
    from PIL import ImageFont

LARGEST = 1 << 26
"""Bytes of a bitmap font, unpacked: the largest known, all of Unicode as BDF, has 10 MB."""

_PROBED = range(1, 129)

_LOOKED_THROUGH = (*range(0x3000), *range(0xF000, 0xF100))
"""Where characters of a font of bitmaps are looked for to know how wide they are: alphabets, signs and symbols."""

_KINDS = "TrueType, OpenType, BDF, PCF, OTB, PSF, .hex, .pil and C sources of U8g2's are read"

Reader = Callable[[bytes, str, "str | None"], Strike]


def load(path: str | os.PathLike[str], size: float | None, antialias: bool | None, encoding: str | None) -> Font:
    """Read a font file; see `Font.load`."""
    place, wanted = _named(os.fspath(path))
    if size is not None:
        check_size(size)
    if encoding is not None:
        charsets.check(encoding)
    start, rest = _contents(place)
    try:
        reader = _reader(_unzipped(start, 4096), place)
        if reader is None:
            return _through_pillow(place, size, antialias)
        strike = reader(_unzipped(start + rest, LARGEST + 1), wanted or _stem(place), encoding)
        return of_strike(_at(size, strike, place))
    except DamagedFontError as error:
        raise OSError(f"cannot read font {str(place)!r}: {error}") from error


def _contents(place: Path) -> tuple[bytes, bytes]:
    """The beginning of a file, and what follows, as far as a bitmap font goes."""
    try:
        with place.open("rb") as file:
            return file.read(4096), file.read(LARGEST + 1)
    except OSError as error:
        raise type(error)(
            error.errno, f"cannot read font {str(place)!r}: {error.strerror}; Font.find(name) looks for installed ones"
        ) from error


def check_size(size: float) -> None:
    """Refuse what is no size."""
    if isinstance(size, bool) or not isinstance(size, (int, float)):
        raise TypeError(f"size must be a number of pixels, not {type(size).__name__}")
    if not 0 < size <= 4096:
        raise ValueError(f"size must be positive and at most 4096, not {size}")


def _named(path: str | bytes) -> tuple[Path, str]:
    """The file, and the name behind a # of one of the fonts in it."""
    if isinstance(path, bytes):
        path = os.fsdecode(path)
    file, _, name = path.rpartition("#")
    return (Path(file), name) if file and not os.path.exists(path) else (Path(path), "")


def _stem(place: Path) -> str:
    return place.name.split(".")[0] or place.name


def _unzipped(data: bytes, limit: int) -> bytes:
    """The bytes that a gzip file holds; no more than its limit, however small it was packed."""
    if not data.startswith(b"\x1f\x8b"):
        found = data
    else:
        try:
            found = zlib.decompressobj(31).decompress(data, limit)
        except zlib.error as error:
            raise DamagedFontError(f"damaged gzip data ({error})") from error
        if len(found) < 4:
            raise DamagedFontError("damaged gzip data (cut short)")
    if len(found) > LARGEST:
        raise DamagedFontError(f"more than {LARGEST >> 20} MB, which is no bitmap font")
    return found


def _reader(start: bytes, place: Path) -> Reader | None:
    """Who reads a file, by how it begins; None for Pillow."""
    if start.startswith(b"\x01fcp"):
        return pcf.read
    if start.startswith(psf.MAGICS):
        return psf.read
    if re.search(rb"^[ \t]*START(?:FONT|CHAR)\b", start, re.M):
        return bdf.read
    if re.match(rb"(?:#.*\r?\n|\s)*[0-9A-Fa-f]{4,6}:[0-9A-Fa-f]{16}", start):
        return unifont.read
    if b"u8g2_font_" in start or place.suffix in (".c", ".h"):
        return u8g2.read
    return None


def _at(size: float | None, strike: Strike, place: Path) -> Strike:
    sizes = {strike.size or 0, strike.ascent + strike.descent} - {0}
    if size is not None and size not in sizes:
        raise wrong_size(place, size, sorted(sizes)[:1])
    return strike


def wrong_size(place: Path, size: float | None, sizes: list[int]) -> ValueError:
    """What is said of a size that a bitmap font does not have, or of none where it has several."""
    known = ", ".join(map(str, sizes))
    if size is None:
        return ValueError(f"size must be one of those of {place.name}: {known}")
    only = "the size" if len(sizes) == 1 else "the sizes"
    return ValueError(f"{place.name} has {only} {known}, not {size}; font.scaled(2) doubles one")


def _through_pillow(place: Path, size: float | None, antialias: bool | None) -> Font:
    """An outline font, a font of Pillow's own, or bitmaps in the form of OpenType."""
    from PIL import ImageFont

    if place.suffix == ".pil":
        return _pillows_own(place, size)
    # Not truetype(): of a file that it cannot read, it looks for an installed one of the same name.
    try:
        probe = ImageFont.FreeTypeFont(str(place), 16)
        if is_scalable(probe):
            if size is None:
                raise ValueError(f"size must be given: {place.name} is drawn at any, in pixels to the em")
            charmap = "symb" if is_symbolic(probe) else ""
            return outline(ImageFont.FreeTypeFont(str(place), size, encoding=charmap), None, antialias)
    except (OSError, ValueError) as error:
        if not is_damage(error):
            raise
        if "pixel size" not in str(error):
            raise DamagedFontError(f"{error}; {_KINDS}") from error
    sizes = {}
    for known in _PROBED:
        try:
            sizes[known] = ImageFont.FreeTypeFont(str(place), known, layout_engine=ImageFont.Layout.BASIC)
        except (OSError, ValueError):
            continue
    if not sizes:
        raise DamagedFontError(f"it has no size up to {_PROBED[-1]}")
    if (size is None and len(sizes) > 1) or (size is not None and size not in sizes):
        raise wrong_size(place, size, list(sizes))
    known = next(iter(sizes)) if size is None else int(size)
    return of_strike(_bitmaps(sizes[known], known))


def _pillows_own(place: Path, size: float | None) -> Font:
    from PIL import ImageFont

    from paneldraw.text.formats.pil import strike_of

    try:
        loaded = ImageFont.load(str(place))
        return of_strike(_at(size, strike_of(loaded, place.stem), place))
    except (OSError, SyntaxError, TypeError, ValueError, EOFError) as error:
        if isinstance(error, ValueError) and "size" in str(error):
            raise
        raise DamagedFontError(str(error) or type(error).__name__) from error


def _bitmaps(font: ImageFont.FreeTypeFont, size: int) -> Strike:
    """The characters of a font of bitmaps that FreeType reads."""
    ascent, descent = font.getmetrics()
    name = " ".join(part for part in font.getname() if part)
    return Strike(name, ascent, descent, _FreeTypePictures(font, ascent), size=size)


class _FreeTypePictures(Mapping[int, Picture]):
    """Characters of a font of bitmaps. Without its table of them, only drawing tells which there are: one at a time."""

    def __init__(self, font: ImageFont.FreeTypeFont, ascent: int) -> None:
        self._font, self._ascent, self._has = font, ascent, characters_of(font)

    def __contains__(self, code: object) -> bool:
        return isinstance(code, int) and self._has(code)

    def __getitem__(self, code: int) -> Picture:
        if code not in self:
            raise KeyError(code)
        font, char = self._font, chr(code)
        left, top, right, bottom = (int(edge) for edge in font.getbbox(char, "1", anchor="ls"))
        if right <= left or bottom <= top:
            return Picture(np.zeros((0, 0), np.uint8), 0, 0, round(font.getlength(char, "1")))
        ink = np.frombuffer(bytes(font.getmask(char, "1")), np.uint8).reshape(bottom - top, right - left)
        return Picture(ink, left, self._ascent + top, round(font.getlength(char, "1")))

    def __iter__(self) -> Iterator[int]:
        return (code for code in _LOOKED_THROUGH if code in self)

    def __len__(self) -> int:
        return sum(1 for _ in self)
