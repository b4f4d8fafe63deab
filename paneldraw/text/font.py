"""Fonts: what draws the characters of a line of text."""

from __future__ import annotations

import functools
import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from paneldraw.raster.glyphs import Glyphs

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from PIL import ImageFont

TAB = 4
"""Columns between tab stops, in characters: a narrow panel has about twenty of them."""


class _Face(Protocol):
    """What draws the characters of a font."""

    def line(self, text: str) -> NDArray[np.uint8]:
        """Coverage 0 ... 255 of one line of text, an array of shape (height, width)."""


@dataclass(frozen=True, slots=True, eq=False)
class Font:
    """A typeface at one size. Immutable; a font can be shared by panels and threads.

    Scripts use the built-in font by naming none, or make one with :meth:`truetype` or :meth:`from_pillow`.

    Attributes
    ----------
    name : str
        What people call it.
    width : int
        Columns of the widest printable ASCII character.
    height : int
        Rows of a line of text, descenders included; also the distance from one line to the next.
    advance : int
        Columns from one character to the next, 0 where it depends on the character.
    baseline : int
        The row, counted from the top, on which letters stand.

    Examples
    --------
    >>> from paneldraw.text import Font
    >>> font = Font.builtin()
    >>> font.name, font.width, font.height, font.advance, font.baseline
    ('6x8', 5, 8, 6, 6)
    >>> font.measure("21.5°C")
    (35, 8)
    """

    name: str
    width: int
    height: int
    advance: int
    baseline: int
    _face: _Face = field(repr=False)
    # Of a font of one bit a pixel that sets its characters side by side: them, and how many times larger they are here.
    _glyphs: Glyphs | None = field(default=None, repr=False)
    _factor: int = field(default=1, repr=False)

    @staticmethod
    def builtin(name: str = "6x8") -> Font:
        """Return a font that is part of this package.

        Parameters
        ----------
        name : {"6x8"}, default "6x8"
            The default is what text is written with where no font is named: cells of 6 x 8 pixels.

        Raises
        ------
        ValueError
            If there is no such font.
        """
        return _builtin(name)

    @staticmethod
    def truetype(path: str | os.PathLike[str], size: float, *, antialias: bool = False) -> Font:
        """Return a TrueType or OpenType font.

        Parameters
        ----------
        path : path-like
            The font file, or the file name of an installed font such as ``"DejaVuSans.ttf"``.
        size : float
            Pixels to the em, positive.
        antialias : bool, default False
            Whether edges are grey. The crisp default suits panels of one bit a pixel.

        Raises
        ------
        ValueError
            If the size is not positive.
        OSError
            If there is no such font or it cannot be read.
        """
        from PIL import ImageFont

        if not size > 0:
            raise ValueError(f"size must be positive, not {size}")
        try:
            loaded = ImageFont.truetype(os.fspath(path), size)
        except OSError as error:
            raise OSError(
                f"cannot read font {os.fspath(path)!r} ({error}); give the path of a .ttf or .otf file"
            ) from error
        return Font.from_pillow(loaded, antialias=antialias)

    @staticmethod
    def from_pillow(
        font: ImageFont.FreeTypeFont | ImageFont.ImageFont, *, name: str | None = None, antialias: bool = False
    ) -> Font:
        """Return a font that Pillow draws: ``ImageFont.truetype(...)``, ``ImageFont.load(...)``.

        Parameters
        ----------
        font : PIL.ImageFont.FreeTypeFont or PIL.ImageFont.ImageFont
            The font as Pillow loaded it.
        name : str, optional
            What people call it. Default: the name in the font file.
        antialias : bool, default False
            Whether edges are grey; a bitmap font has none.

        Raises
        ------
        TypeError
            If it is no font of Pillow's.
        """
        from PIL import ImageFont

        face: _Face
        if isinstance(font, ImageFont.FreeTypeFont):
            ascent, descent = font.getmetrics()
            face = _FreeTypeFace(font, ascent, ascent + descent, "L" if antialias else "1")
            known = " ".join(part for part in font.getname() if part)
        elif isinstance(font, ImageFont.ImageFont):
            ascent, descent = int(font.getbbox("Ag")[3]), 0
            face = _BitmapFace(font, ascent)
            known = "bitmap"
        else:
            raise TypeError(f"font must be an ImageFont of Pillow's, not {type(font).__name__}")
        widest = max(face.line(chr(code)).shape[1] for code in range(0x20, 0x7F))
        return Font(name or known, widest, ascent + descent, 0, ascent - 1, face)

    def scaled(self, factor: int) -> Font:
        """Return the font with each pixel a square of `factor` x `factor` pixels.

        Raises
        ------
        ValueError
            If the factor is not a whole number of 1 or more.

        Examples
        --------
        >>> Font.builtin().scaled(2).measure("12:34")
        (58, 16)
        """
        if not (isinstance(factor, int) and factor >= 1):
            raise ValueError(f"factor must be a whole number of 1 or more, not {factor!r}")
        return Font(
            f"{self.name} x{factor}",
            self.width * factor,
            self.height * factor,
            self.advance * factor,
            (self.baseline + 1) * factor - 1,
            _ScaledFace(self._face, factor),
            self._glyphs,
            self._factor * factor,
        )

    def glyph(self, char: str) -> NDArray[np.uint8]:
        """Return the picture of one character.

        Parameters
        ----------
        char : str
            One character.

        Returns
        -------
        numpy.ndarray
            Coverage 0 ... 255, shape (height, width of the character); 0 or 255 unless the font is anti-aliased.

        Raises
        ------
        ValueError
            If it is not exactly one character.
        """
        if len(char) != 1:
            raise ValueError(f"char must be one character, not {char!r}")
        return self._face.line(char)

    def measure(self, text: str) -> tuple[int, int]:
        """Return (width, height) in pixels of a text, which may have several lines.

        Examples
        --------
        >>> Font.builtin().measure("two\\nlines")
        (29, 16)
        """
        covers = [self._face.line(line) for line in split_lines(text)]
        return max(cover.shape[1] for cover in covers), self.height * len(covers)


def font_of(font: Any) -> Font:
    """The font that an argument means."""
    if font is None:
        return _builtin("6x8")
    if not isinstance(font, Font):
        raise TypeError(f"font must be a Font, such as Font.truetype(path, size), not {type(font).__name__}")
    return font


def split_lines(text: str) -> list[str]:
    if not isinstance(text, str):
        raise TypeError(f"text must be a string, not {type(text).__name__}; str(...) makes one")
    return text.replace("\r\n", "\n").expandtabs(TAB).split("\n")


class _Indices(dict[int, int]):
    """Code point to column of the glyph table; the first one is for whatever the font does not have."""

    def __missing__(self, code: int) -> int:
        return 0


class _CellFace:
    """Characters in cells of one size: a line is one look-up in a table of shape (height, characters, advance)."""

    def __init__(self, indices: _Indices, table: NDArray[np.uint8], gap: int) -> None:
        self._indices, self._table, self._gap = indices, table, gap

    def line(self, text: str) -> NDArray[np.uint8]:
        height, _, advance = self._table.shape
        picks = np.frombuffer(text.translate(self._indices).encode("utf-16-le"), np.uint16)
        width = len(picks) * advance
        return self._table.take(picks, axis=1).reshape(height, width)[:, : max(width - self._gap, 0)]


class _ScaledFace:
    """Another face with larger pixels."""

    def __init__(self, face: _Face, factor: int) -> None:
        self._face, self._factor = face, factor

    def line(self, text: str) -> NDArray[np.uint8]:
        return self._face.line(text).repeat(self._factor, axis=0).repeat(self._factor, axis=1)


class _FreeTypeFace:
    """An outline font; a line is drawn whole, so that kerning and ligatures come out as the font has them."""

    def __init__(self, font: ImageFont.FreeTypeFont, ascent: int, height: int, mode: str) -> None:
        self._font, self._ascent, self._height, self._mode = font, ascent, height, mode

    def line(self, text: str) -> NDArray[np.uint8]:
        left, _, right, _ = self._font.getbbox(text, self._mode, anchor="ls")
        start = min(int(np.floor(left)), 0)
        end = int(np.ceil(max(right, self._font.getlength(text, self._mode))))
        return _draw(text, self._font, (end - start, self._height), self._mode, (-start, self._ascent), anchor="ls")


class _BitmapFace:
    """A bitmap font in Pillow's own format."""

    def __init__(self, font: ImageFont.ImageFont, height: int) -> None:
        self._font, self._height = font, height

    def line(self, text: str) -> NDArray[np.uint8]:
        width = int(self._font.getbbox(text)[2]) if text else 0
        return _draw(text, self._font, (width, self._height), "1", (0, 0))


def _draw(
    text: str,
    font: ImageFont.FreeTypeFont | ImageFont.ImageFont,
    size: tuple[int, int],
    mode: str,
    origin: tuple[int, int],
    anchor: str | None = None,
) -> NDArray[np.uint8]:
    from PIL import Image, ImageDraw

    image = Image.new("L", size)
    if text:
        draw = ImageDraw.Draw(image)
        draw.fontmode = mode
        draw.text(origin, text, 255, font, anchor=anchor)
    return np.array(image, np.uint8)


@functools.cache
def _builtin(name: str) -> Font:
    from paneldraw.text.builtin import strike

    drawn = strike(name)
    pictures = sorted(drawn.pictures.items(), key=lambda item: item[0] != drawn.missing)
    codes = [code for code, _ in pictures]
    advance = pictures[0][1].advance
    table = np.stack([picture.ink for _, picture in pictures], axis=1) * np.uint8(255)
    glyphs = Glyphs(codes, table.transpose(1, 0, 2), [advance] * len(codes), drawn.gap)
    face = _CellFace(_Indices(zip(codes, range(len(codes)), strict=True)), table, drawn.gap)
    height = drawn.ascent + drawn.descent
    return Font(name, advance - drawn.gap, height, advance, drawn.ascent - 1, face, glyphs)
