"""Fonts: what draws the characters of a line of text."""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from typing import TYPE_CHECKING, Any

from paneldraw.raster.glyphs import Glyphs
from paneldraw.text.characters import composed
from paneldraw.text.faces import ChainFace, Face, FreeTypeFace, ScaledFace, StrikeFace
from paneldraw.text.strike import Strike, box

if TYPE_CHECKING:
    from typing import Literal

    import numpy as np
    from numpy.typing import NDArray
    from PIL import ImageFont

NO_CHARACTER = 0x10FFFF
"""What no font has a picture of."""

_MOST_EMS = 16
"""A line of a font is at most so many times as high as its em; what says more is damaged."""

LARGEST_SPACING = 1000
"""Rows; more than any panel has."""

TAB = 4
"""Columns between tab stops, in characters: a narrow panel has about twenty of them."""


@dataclass(frozen=True, slots=True, eq=False)
class Font:
    """A typeface at one size. Immutable; a font can be shared by panels and threads.

    Scripts use the built-in font by naming none, or make one with :meth:`find`, :meth:`load` or :meth:`from_pillow`.

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
    _face: Face = field(repr=False)
    # Of a font of one bit a pixel that sets its characters side by side: them, and how many times larger they are here.
    _glyphs: Glyphs | None = field(default=None, repr=False)
    _factor: int = field(default=1, repr=False)
    # Whether the characters fill a cell each, so that the box of a text is its cells and not its ink.
    _cells: bool = field(default=False, repr=False)
    # The same font with gray edges, which stands for it on framebuffers that have grays.
    _gray: Font | None = field(default=None, repr=False)

    @staticmethod
    def builtin(name: str = "6x8") -> Font:
        """Return a font that is part of this package.

        Parameters
        ----------
        name : {"6x8", "8x8", "numbers", "segments"}, default "6x8"
            The default is what text is written with where no font is named. ``"6x8"`` and ``"8x8"``, with thin and
            with bold strokes, are named by their cells. They have the letters of Europe's languages (Latin-1, Latin
            Extended-A, Greek, Cyrillic), box drawing, blocks, Braille, arrows and signs such as ♥ ✓ ☂ ⚡ 🔋 📶.
            ``"numbers"`` has plain digits of 12 x 16, ``"segments"`` those of a seven-segment display of 10 x 16, in
            both with the point, the comma and the colon narrower, and all other characters of ``"6x8"``, doubled.

        Raises
        ------
        ValueError
            If there is no such font.

        Examples
        --------
        >>> Font.builtin("numbers").measure("21.5 °C")
        (72, 16)
        """
        return _builtin(name)

    @staticmethod
    def truetype(path: str | os.PathLike[str], size: float, *, antialias: bool | None = None) -> Font:
        """Return a TrueType or OpenType font.

        Parameters
        ----------
        path : path-like
            The font file, or the file name of an installed font such as ``"DejaVuSans.ttf"``.
        size : float
            Pixels to the em, positive.
        antialias : bool, optional
            Whether edges are gray; see :meth:`load`.

        Raises
        ------
        ValueError
            If the size is not positive.
        OSError
            If there is no such font or it cannot be read.
        """
        from PIL import ImageFont

        from paneldraw.text.loading import check_size

        check_size(size)
        # Of a file that it cannot read, truetype() looks for an installed one of the same name.
        read = ImageFont.FreeTypeFont if os.path.exists(path) else ImageFont.truetype
        try:
            loaded = read(os.fspath(path), size)
        except OSError as error:
            raise OSError(
                f"cannot read font {os.fspath(path)!r} ({error}); give the path of a .ttf or .otf file, or Font.load "
                "reads other kinds"
            ) from error
        return Font.from_pillow(loaded, antialias=antialias)

    @staticmethod
    def load(
        path: str | os.PathLike[str],
        size: float | None = None,
        *,
        antialias: bool | None = None,
        encoding: str | None = None,
    ) -> Font:
        """Return the font of a file.

        TrueType and OpenType, with outlines or bitmaps (``.otb``), and what else FreeType reads; BDF and PCF of X11,
        PSF of the Linux console, packed with gzip or not; Unifont's ``.hex``; Pillow's ``.pil``; a C source of U8g2's
        fonts, the name of one behind a ``#`` where it has several.

        Parameters
        ----------
        path : path-like
            The file.
        size : float, optional
            Pixels to the em. A bitmap font has sizes of its own; where it has one, that is the default.
        antialias : bool, optional
            Whether edges of outlines are gray. Default: where the framebuffer that is drawn on has grays; on one bit
            a pixel, and in :meth:`glyph` and `render`, which draw on none, they are crisp and hinted for it.
        encoding : str, optional
            The character set of a bitmap font's codes, such as ``"koi8-r"``, instead of the one that the file names;
            ``"raw"`` for the codes as they are. Codes of a set that Python has no codec for are so anyway: ``chr(65)``
            is the character of code 65.

        Raises
        ------
        ValueError
            If the font has no such size, or there is no such encoding.
        OSError
            If there is no such file or it cannot be read.
        """
        from paneldraw.text.loading import load

        return load(path, size, antialias, encoding)

    @staticmethod
    def find(
        name: str, size: float | None = None, *, bold: bool = False, italic: bool = False, antialias: bool | None = None
    ) -> Font:
        """Return a font that is installed on this system, by the name of its family or file.

        Parameters
        ----------
        name : str
            Such as ``"terminus"`` or ``"DejaVu Sans"``. Case, spaces and hyphens do not count; the start will do.
        size : float, optional
            Pixels to the em, as for :meth:`load`.
        bold, italic : bool, default False
            The style, where there are several.
        antialias : bool, optional
            Whether edges of outlines are gray; see :meth:`load`.

        Raises
        ------
        FileNotFoundError
            If there is none of that name; the message tells which there are.
        ValueError
            If there is none of that size.
        """
        from paneldraw.text.finding import find

        return find(name, size, bold, italic, antialias)

    @staticmethod
    def from_pillow(
        font: ImageFont.FreeTypeFont | ImageFont.ImageFont, *, name: str | None = None, antialias: bool | None = None
    ) -> Font:
        """Return a font that Pillow draws: ``ImageFont.truetype(...)``, ``ImageFont.load(...)``.

        Parameters
        ----------
        font : PIL.ImageFont.FreeTypeFont or PIL.ImageFont.ImageFont
            The font as Pillow loaded it.
        name : str, optional
            What people call it. Default: the name in the font file.
        antialias : bool, optional
            Whether edges are gray, see :meth:`load`; those of a bitmap font never are.

        Raises
        ------
        TypeError
            If it is no font of Pillow's.
        """
        from PIL import ImageFont

        if isinstance(font, ImageFont.FreeTypeFont):
            return outline(font, name, antialias)
        if isinstance(font, ImageFont.ImageFont):
            from paneldraw.text.formats.pil import strike_of

            return of_strike(strike_of(font, name or "bitmap"))
        raise TypeError(f"font must be an ImageFont of Pillow's, not {type(font).__name__}")

    def with_fallback(self, *fonts: Font) -> Font:
        """Return the font with others to look in for the characters that it does not have, in that order.

        Their letters stand on the same baseline. What none of them has is drawn as a box.

        Raises
        ------
        TypeError
            If one of them is not a Font.

        Examples
        --------
        >>> small = Font.builtin().with_fallback(Font.builtin().scaled(2))
        >>> small.height
        8
        """
        fonts = tuple(map(font_of, fonts))
        others = [(other._face, other.baseline + 1) for other in fonts]
        if isinstance(self._face, StrikeFace) and self._factor == 1:
            face = StrikeFace(self._face.strike, (*self._face.fallbacks, *others))
            return replace(self, _face=face, _glyphs=face.glyphs)
        if isinstance(self._face, ChainFace):
            chain = ChainFace((*self._face.faces, *others), self._face.missing)
        else:
            chain = ChainFace(((self._face, self.baseline + 1), *others), self._face.line(chr(NO_CHARACTER)))
        gray = None
        if any(font._gray is not None for font in (self, *fonts)):
            gray = (self._gray or self).with_fallback(*(font._gray or font for font in fonts))
        return replace(self, _face=chain, _glyphs=None, _gray=gray)

    def shaped(
        self,
        *,
        direction: Literal["ltr", "rtl"] | None = None,
        features: Sequence[str] | None = None,
        language: str | None = None,
    ) -> Font:
        """Return the font with letters shaped as told, by Pillow's raqm; without it, letters stand side by side.

        Hebrew and Arabic need not be told of where Pillow has raqm (``PIL.features.check("raqm")``, as pip's has): a
        text that starts with one of their letters runs from the right.

        Parameters
        ----------
        direction : {"ltr", "rtl"}, optional
            Where each line runs, whatever it starts with.
        features : sequence of str, optional
            Of OpenType, by their four letters: ``["-kern"]`` switches one off, ``["smcp"]`` on.
        language : str, optional
            A language's tag, such as ``"sr"``, for fonts whose letters differ by it.

        Raises
        ------
        ValueError
            If the font has no outlines, there is no such direction, or Pillow is without raqm.
        TypeError
            If the features or the language are not strings.
        """
        if direction not in (None, "ltr", "rtl"):
            raise ValueError(f"direction must be 'ltr' or 'rtl', not {direction!r}; that of text is a call's argument")
        if isinstance(features, str) or not all(isinstance(name, str) for name in features or ()):
            raise TypeError(f"features must be a sequence of strings, such as ['-kern'], not {features!r}")
        if not (language is None or isinstance(language, str)):
            raise TypeError(f"language must be a string, not {type(language).__name__}")
        told = {"direction": direction, "features": None if features is None else list(features), "language": language}
        shaping = {name: value for name, value in told.items() if value is not None}
        chain = self._face
        if not (isinstance(chain, ChainFace) and isinstance(chain.faces[0][0], FreeTypeFace)):
            raise ValueError(f"only fonts with outlines are shaped, before they are scaled, and {self.name} is none")
        faces = [(face.shaped(shaping) if isinstance(face, FreeTypeFace) else face, top) for face, top in chain.faces]
        gray = self._gray and self._gray.shaped(direction=direction, features=features, language=language)
        return replace(self, _face=ChainFace(faces, chain.missing), _gray=gray)

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
        return replace(
            self,
            name=f"{self.name} x{factor}",
            width=self.width * factor,
            height=self.height * factor,
            advance=self.advance * factor,
            baseline=(self.baseline + 1) * factor - 1,
            _face=ScaledFace(self._face, factor),
            _factor=self._factor * factor,
            _gray=self._gray and self._gray.scaled(factor),
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
        from paneldraw.text.layout import cover

        return cover([char], self, "la")[0]

    def measure(self, text: str, line_spacing: int = 0) -> tuple[int, int]:
        """Return (width, height) in pixels of a text, which may have several lines, so many rows apart.

        Examples
        --------
        >>> Font.builtin().measure("two\\nlines")
        (29, 16)
        """
        check_line_spacing(line_spacing, self)
        lines = split_lines(text)
        width = max(self._face.line(line).advance for line in lines)
        return math.ceil(width), (self.height + line_spacing) * len(lines) - line_spacing


def font_of(font: Any) -> Font:
    """The font that an argument means."""
    if font is None:
        return _builtin("6x8")
    if not isinstance(font, Font):
        raise TypeError(f"font must be a Font, such as Font.truetype(path, size), not {type(font).__name__}")
    return font


def font_on(font: Any, max_level: int) -> Font:
    """The font that an argument means where there are so many levels."""
    found = font_of(font)
    return found._gray if max_level > 1 and found._gray is not None else found


def split_lines(text: str) -> list[str]:
    """The lines of a text, tabs as spaces, letters and their marks composed."""
    if not isinstance(text, str):
        raise TypeError(f"text must be a string, not {type(text).__name__}; str(...) makes one")
    if not text.isascii():
        text = composed(text)
    return text.replace("\r\n", "\n").expandtabs(TAB).split("\n")


def check_line_spacing(rows: int, font: Font) -> None:
    """Refuse what is no distance between lines."""
    if not isinstance(rows, int):
        raise TypeError(f"line_spacing must be a whole number of rows, not {type(rows).__name__}")
    if not -font.height < rows <= LARGEST_SPACING:
        raise ValueError(
            f"line_spacing must be from {1 - font.height}, which leaves lines a row apart, to {LARGEST_SPACING}, "
            f"not {rows}"
        )


def of_strike(strike: Strike) -> Font:
    """Return the font that a bitmap font is."""
    face = StrikeFace(strike)
    pictures = strike.pictures
    codes = [code for code in range(0x20, 0x7F) if code in pictures] or list(islice(pictures, 95))
    found = [picture for picture in map(pictures.get, codes) if picture is not None]
    advances = {int(picture.advance) for picture in found} or {0}
    height = strike.ascent + strike.descent
    return Font(
        strike.name,
        max(advances) - strike.gap,
        height,
        max(advances) if len(advances) == 1 else 0,
        strike.ascent - 1,
        face,
        face.glyphs,
        _cells=strike.cells,
    )


def outline(font: ImageFont.FreeTypeFont, name: str | None, antialias: bool | None) -> Font:
    """Return the font that Pillow's FreeType draws."""
    from paneldraw.text.outline import characters_of

    ascent, descent = font.getmetrics()
    if not 0 < ascent + descent <= _MOST_EMS * font.size:
        raise OSError(f"its lines would be {ascent + descent} rows high")
    has = characters_of(font)
    like = font.getbbox("H", "1", anchor="ls")
    frame = box(int(like[2]) - 1, -int(like[1]), ascent)
    widest = max(math.ceil(font.getlength(chr(code), "1")) for code in range(0x20, 0x7F))
    known = " ".join(part for part in font.getname() if part)

    def drawn(antialias: bool, gray: Font | None = None) -> Font:
        face = ChainFace([(FreeTypeFace(font, has, antialias), ascent)], frame)
        return Font(name or known, widest, ascent + descent, 0, ascent - 1, face, _gray=gray)

    return drawn(False, drawn(True)) if antialias is None else drawn(antialias)


@functools.cache
def _builtin(name: str) -> Font:
    from paneldraw.text.builtin import strike

    return of_strike(strike(name))
