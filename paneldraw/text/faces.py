"""What draws the characters of a line of text: pictures of a bitmap font, Pillow's FreeType, or several in turn."""

from __future__ import annotations

import math
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from paneldraw.raster.glyphs import Glyphs
from paneldraw.text.characters import is_invisible, is_mark, substitutes
from paneldraw.text.strike import NOTHING, Picture, Strike, box, overlaid

if TYPE_CHECKING:
    from PIL import ImageFont

KEPT = 1 << 20
"""Bytes of pictures of lines that a font keeps; a panel shows some ten lines of 2000 bytes."""

JOINERS = "\u200c\u200d"
"""What decides the form of the letters beside it is for the font to see."""


_RAQM = 1
"""Pillow's ImageFont.Layout.RAQM, without importing it."""


class Face(Protocol):
    """What draws the characters of a font."""

    def has(self, code: int) -> bool:
        """Whether the font has a picture of a character."""

    def line(self, text: str) -> Picture:
        """Return the picture of one line of text, its advance the columns that it takes."""


class StrikeFace:
    """The characters of a bitmap font side by side, and those of other fonts for what it does not have."""

    def __init__(self, strike: Strike, fallbacks: Sequence[tuple[Face, int]] = ()) -> None:
        self.strike, self.fallbacks = strike, tuple(fallbacks)
        self.glyphs = Glyphs(self._picture, self._missing(), strike.gap)

    def has(self, code: int) -> bool:
        """Whether the font has a picture of a character, or can put one together."""
        return self._own(code) is not None

    def line(self, text: str) -> Picture:
        """Return the picture of one line of text."""
        left, top, right, bottom = self.glyphs.bounds(text)
        memory = self.glyphs.cover(text, -left, -top, right - left, bottom - top)
        ink = np.frombuffer(memory, np.uint8).reshape(bottom - top, right - left)
        width = self.glyphs.measure(text)
        if not ink[:, max(width - left, 0) :].any():
            # The gap behind the last character is no part of a line unless it is lit.
            ink = ink[:, : max(width - left, 0)]
        return Picture(ink, left, top, width)

    def _picture(self, code: int) -> Picture | None:
        own = self._own(code)
        if own is not None:
            return own
        for face, ascent in self.fallbacks:
            if face.has(code):
                ink, left, top, advance = face.line(chr(code))
                lit = (ink >= 128).astype(np.uint8)
                return Picture(lit, left, top + self.strike.ascent - ascent, math.floor(advance + 0.5))
        return None

    def _own(self, code: int) -> Picture | None:
        if is_invisible(code):
            return NOTHING
        found = self.strike.pictures.get(code)
        if found is None:
            return self._put_together(code)
        if is_mark(code) and found.advance > 0:
            return found._replace(left=found.left - int(found.advance), advance=0)
        return found

    def _put_together(self, code: int) -> Picture | None:
        """Return a picture made of other characters: a letter with its marks over it."""
        found = [self.strike.pictures.get(ord(char)) for char in substitutes(code)]
        pictures = [picture for picture in found if picture is not None]
        if not found or len(pictures) < len(found):
            return None
        base = pictures[0]
        marks = [
            mark if mark.advance > 0 else mark._replace(left=mark.left + int(base.advance)) for mark in pictures[1:]
        ]
        return overlaid([base, *marks], base.advance)

    def _missing(self) -> Picture:
        pictures = self.strike.pictures
        for code in (self.strike.missing, 0xFFFD):
            found = None if code is None else pictures.get(code)
            if found is not None and found.ink.any():
                return found
        like = next(filter(None, map(pictures.get, map(ord, "0HMnx"))), None)
        if like is None or like.advance < 1:
            return box(self.strike.ascent // 2, self.strike.ascent, self.strike.ascent)
        height = self.strike.ascent - min(max(like.top, 0), self.strike.ascent - 1)
        return box(int(like.advance) - 1, height, self.strike.ascent)._replace(advance=like.advance)


def is_damage(error: OSError | ValueError) -> bool:
    """Whether Pillow says that a font is damaged: by an OSError of FreeType's, or a ValueError of raqm's."""
    return isinstance(error, OSError) or str(error).startswith("raqm")


class FreeTypeFace:
    """An outline font; a line is drawn whole, so that kerning and ligatures come out as the font has them."""

    def __init__(self, font: ImageFont.FreeTypeFont, has: Callable[[int], bool], antialias: bool) -> None:
        self._font, self._has, self._mode = font, has, "L" if antialias else "1"
        self._ascent = font.getmetrics()[0]
        self._shaping: dict[str, Any] = {}

    @property
    def shapes(self) -> bool:
        """Whether letters are shaped and ordered by raqm: those of Hebrew and Arabic from right to left."""
        return self._font.layout_engine == _RAQM

    def shaped(self, shaping: dict[str, Any]) -> FreeTypeFace:
        """Return the face with a direction, features or a language of Pillow's."""
        if not self.shapes:
            raise ValueError(
                "direction, features and language need Pillow with raqm, which pip's has, and a font that was loaded "
                "with ImageFont.Layout.RAQM, the default"
            )
        face = FreeTypeFace(self._font, self._has, self._mode == "L")
        face._shaping = self._shaping | shaping
        return face

    def is_from_the_right(self, text: str) -> bool:
        """Whether a text starts at the right: by the direction, else by its first letter that has one."""
        if not self.shapes:
            return False
        if "direction" in self._shaping:
            return bool(self._shaping["direction"] == "rtl")
        strong = (unicodedata.bidirectional(char) for char in text)
        return next((kind for kind in strong if kind in ("L", "R", "AL")), "L") != "L"

    def has(self, code: int) -> bool:
        """Whether the font has a picture of a character."""
        return self._has(code)

    def line(self, text: str) -> Picture:
        """Return the picture of one line of text."""
        if not text:
            return NOTHING
        try:
            return self._draw(text)
        except (OSError, ValueError) as error:
            if not is_damage(error):
                raise
            name = " ".join(part for part in self._font.getname() if part)
            raise OSError(f"font {name!r} is damaged and cannot draw {text[:40]!r}: {error}") from error

    def _draw(self, text: str) -> Picture:
        from PIL import Image, ImageDraw

        bounds = self._font.getbbox(text, self._mode, anchor="ls", **self._shaping)
        left, top, right, bottom = (int(edge) for edge in bounds)
        width, height = right - left, bottom - top
        if width * height > 2 * (Image.MAX_IMAGE_PIXELS or math.inf):
            raise ValueError(f"text must be of fewer pixels than Pillow's limit, and is {width} x {height}")
        image = Image.new("L", (width, height))
        draw = ImageDraw.Draw(image)
        draw.fontmode = self._mode
        draw.text((-left, -top), text, 255, self._font, anchor="ls", **self._shaping)
        length = self._font.getlength(text, self._mode, **self._shaping)
        return Picture(np.array(image, np.uint8), left, top + self._ascent, length)


class ScaledFace:
    """Another face with larger pixels."""

    def __init__(self, face: Face, factor: int) -> None:
        self._face, self._factor = face, factor

    def has(self, code: int) -> bool:
        """Whether the font has a picture of a character."""
        return self._face.has(code)

    def line(self, text: str) -> Picture:
        """Return the picture of one line of text."""
        picture, factor = self._face.line(text), self._factor
        ink = picture.ink.repeat(factor, axis=0).repeat(factor, axis=1)
        return Picture(ink, picture.left * factor, picture.top * factor, picture.advance * factor)


class ChainFace:
    """A face, others for the characters that it does not have, and a box for those that none has.

    It keeps the pictures of the last lines: what a panel shows stays much the same from frame to frame.
    """

    def __init__(self, faces: Sequence[tuple[Face, int]], missing: Picture) -> None:
        self.faces, self.missing = tuple(faces), missing
        self._sources: dict[str, int] = {}
        self._lines: dict[str, Picture] = {}
        self._size = 0

    def has(self, code: int) -> bool:
        """Whether one of the faces has a picture of a character."""
        return any(face.has(code) for face, _ in self.faces)

    def line(self, text: str) -> Picture:
        """Return the picture of one line of text."""
        kept = self._lines.get(text)
        if kept is not None:
            return kept
        picture = self._draw(text)
        picture.ink.flags.writeable = False
        size = picture.ink.size + 4 * len(text) + 200
        if size * 4 <= KEPT:
            if self._size + size > KEPT:
                self._lines, self._size = {}, 0
            self._lines[text] = picture
            self._size += size
        return picture

    def _draw(self, text: str) -> Picture:
        pictures = list(self._runs(text))
        if len(pictures) == 1:
            return pictures[0]
        first = self.faces[0][0]
        if isinstance(first, FreeTypeFace) and first.is_from_the_right(text):
            pictures.reverse()
        pen = 0.0
        placed = []
        for picture in pictures:
            placed.append(picture._replace(left=picture.left + math.floor(pen + 0.5)))
            pen += picture.advance
        return overlaid(placed, pen)

    def _runs(self, text: str) -> Iterator[Picture]:
        """Yield the pictures of the runs of characters that come from one face each."""
        ascent = self.faces[0][1]
        for source, chars in groupby(self._resolved(text), key=lambda pair: pair[1]):
            run = "".join(char for char, _ in chars)
            if source < 0:
                yield from [self.missing] * len(run)
            else:
                face, own = self.faces[source]
                picture = face.line(run)
                yield picture._replace(top=picture.top + ascent - own)

    def _resolved(self, text: str) -> Iterable[tuple[str, int]]:
        """Yield the characters that are drawn, and each one's face; -1 for a box."""
        for char in text:
            source = self._source(char)
            if is_invisible(ord(char)) and (char not in JOINERS or source):
                continue
            if source >= 0 or not substitutes(ord(char)):
                yield char, source
            else:
                yield from ((part, self._source(part)) for part in substitutes(ord(char)))

    def _source(self, char: str) -> int:
        if char not in self._sources:
            if len(self._sources) >= 65536:
                self._sources = {}
            having = (number for number, (face, _) in enumerate(self.faces) if face.has(ord(char)))
            self._sources[char] = next(having, -1)
        return self._sources[char]
