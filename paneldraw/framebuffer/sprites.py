"""Small pictures that are drawn many times: from strings, bytes, C source and sheets."""

from __future__ import annotations

import textwrap
from typing import Any

import numpy as np

from paneldraw.framebuffer import bitmaps, pictures
from paneldraw.framebuffer.arguments import LARGEST
from paneldraw.framebuffer.arguments import size as whole_number
from paneldraw.framebuffer.bitmaps import Format
from paneldraw.framebuffer.framebuffer import Framebuffer
from paneldraw.framebuffer.pictures import Levels

_SHADES = {character: level for level, character in enumerate("0123456789abcdef")}
_NOTHING = " ."


class Sprite:
    """A small picture, some of whose pixels may be transparent, for `Framebuffer.blit` and `Framebuffer.image`.

    Parameters
    ----------
    picture : str or any picture
        Lines of text, a character a pixel: ``#`` is the highest level, 0 to 9 and a to f are levels, ``.`` and the
        space are transparent. Or what `Framebuffer.image` takes: an image, an array, a `pathlib.Path`; or a
        Framebuffer.

    Attributes
    ----------
    levels : Framebuffer
        The pixels, of as few bits as they need: 1, 2 or 4 for a text, 8 for a picture.
    opacity : ndarray of uint8, shape (height, width), or None
        0 ... 255, where not all is opaque.

    Raises
    ------
    TypeError
        If it is none of these.
    ValueError
        If it has no pixels, or a text holds another character.

    Examples
    --------
    >>> from paneldraw import Framebuffer, Sprite
    >>> heart = Sprite('''
    ...     .#.#.
    ...     #####
    ...     .###.
    ...     ..#..
    ... ''')
    >>> fb = Framebuffer(12, 4)
    >>> fb.blit(heart, 0, 0)
    >>> fb.blit(heart, 6, 0)
    >>> print(fb)
    .#.#...#.#..
    #####.#####.
    .###...###..
    ..#.....#...
    """

    def __init__(self, picture: Any) -> None:
        if isinstance(picture, str):
            levels, depth, opacity = _read_text(picture)
        elif isinstance(picture, Framebuffer):
            levels, depth, opacity = picture.pixels, picture.depth, None
        else:
            levels, opacity = pictures.to_gray(picture)
            depth = 8
        self._keep(levels, depth, opacity)

    def _keep(self, levels: Levels, depth: int, opacity: Levels | None) -> None:
        height, width = levels.shape
        if not width or not height:
            raise ValueError(f"a sprite must have pixels, and this has {width} x {height}")
        self.levels = Framebuffer(width, height, depth)
        self.levels.pixels[:] = levels
        self.opacity = None if opacity is None or opacity.min() == 255 else opacity.copy()

    @classmethod
    def _of(cls, levels: Levels, depth: int, opacity: Levels | None) -> Sprite:
        sprite = cls.__new__(cls)
        sprite._keep(levels, depth, opacity)
        return sprite

    @classmethod
    def from_bytes(
        cls, data: Any, width: int, height: int, format: Format = "MONO_HLSB", *, transparent: bool = False
    ) -> Sprite:
        """Read a picture from bytes.

        Parameters
        ----------
        data : bytes-like or sequence of int
        width, height : int
        format : str, default "MONO_HLSB"
            As MicroPython's framebuf names them. ``MONO_HLSB``: rows of bits, the highest one leftmost, each row whole
            bytes (Adafruit's drawBitmap, image2cpp horizontally); ``MONO_HMSB``: the lowest one leftmost (XBM);
            ``MONO_VLSB``: pages of eight rows, a byte a column, the lowest bit topmost (SSD1306, image2cpp vertically);
            ``MONO_VMSB``: the highest one topmost; ``GS2_HMSB``, ``GS4_HMSB``, ``GS8``: grays; ``RGB565``: colors.
        transparent : bool, default False
            Whether level 0 is.

        Raises
        ------
        TypeError, ValueError
            If it is no such format, or not as many bytes as the picture has.

        Examples
        --------
        >>> from paneldraw import Sprite
        >>> print(Sprite.from_bytes(b"\\x18\\x24\\x24\\x18", 8, 4).levels)
        ...##...
        ..#..#..
        ..#..#..
        ...##...
        """
        size = whole_number("width", width), whole_number("height", height)
        if not (1 <= size[0] <= LARGEST and 1 <= size[1] <= LARGEST):
            raise ValueError(f"width and height must be 1 to {LARGEST}, not {width} x {height}")
        levels, depth = bitmaps.read_bytes(data, *size, format)
        return cls._of(levels, depth, np.where(levels, 255, 0).astype(np.uint8) if transparent else None)

    @classmethod
    def from_c(
        cls,
        text: str,
        width: int | None = None,
        height: int | None = None,
        format: Format = "MONO_HLSB",
        *,
        name: str | None = None,
        transparent: bool = False,
    ) -> Sprite:
        """Read a picture from an array in C source, as image2cpp and Arduino sketches have it.

        Parameters
        ----------
        text : str
            The source; ``const``, ``static``, ``PROGMEM`` and the like may stand in it, and comments.
        width, height : int, optional
            Default: what ``#define``s (``NAME_width``, ``NAME_height``) or the comment before the array (``16x16px``)
            say.
        format : str, default "MONO_HLSB"
            See `from_bytes`.
        name : str, optional
            Which array. Default: the only one.
        transparent : bool, default False
            Whether level 0 is.

        Raises
        ------
        TypeError, ValueError
            If there is no such array, its size is not told, or it is not as many bytes as the picture has.

        Examples
        --------
        >>> from paneldraw import Sprite
        >>> box = Sprite.from_c("// 'box', 8x2px\\nconst uint8_t box [] PROGMEM = {0xff, 0x81};")
        >>> print(box.levels)
        ########
        #......#
        """
        if not isinstance(text, str):
            raise TypeError(f"text must be C source, not {type(text).__name__}")
        name, data = bitmaps.array_of(text, name)
        if width is None or height is None:
            told = bitmaps.size_of(text, name)
            if told is None:
                raise ValueError(f"the text does not tell the size of {name}: give width and height")
            width, height = told
        return cls.from_bytes(data, width, height, format, transparent=transparent)

    @classmethod
    def xbm(cls, text: str, *, name: str | None = None, transparent: bool = False) -> Sprite:
        """Read an X bitmap, also one with ``const``, ``PROGMEM`` and other types than X11's; set bits are lit.

        Parameters
        ----------
        text : str
            The file's text.
        name : str, optional
            Which array. Default: the only one.
        transparent : bool, default False
            Whether what is not set is.

        Raises
        ------
        TypeError, ValueError
            As of `from_c`.

        Examples
        --------
        >>> from paneldraw import Sprite
        >>> source = '''
        ... #define dot_width 4
        ... #define dot_height 2
        ... static const unsigned char dot_bits[] U8X8_PROGMEM = { 0x03, 0x0c };
        ... '''
        >>> print(Sprite.xbm(source).levels)
        ##..
        ..##
        """
        if not isinstance(text, str):
            raise TypeError(f"text must be an X bitmap's, not {type(text).__name__}")
        name, data = bitmaps.array_of(text, name)
        told = bitmaps.size_of(text, name)
        if told is None:
            raise ValueError(f"the text does not define the width and height of {name}")
        width, height = told
        if len(data) == (width + 15) // 16 * 2 * height != (width + 7) // 8 * height:
            # Version 10 of X had rows of 16 bits.
            data = np.frombuffer(data, np.uint8).reshape(height, -1)[:, : (width + 7) // 8].tobytes()
        return cls.from_bytes(data, width, height, "MONO_HMSB", transparent=transparent)

    @classmethod
    def sheet(cls, picture: Any, width: int, height: int, *, gap: int = 0) -> list[Sprite]:
        """Cut a picture into sprites of one size, row by row.

        Parameters
        ----------
        picture : any picture
            As `Framebuffer.image` takes it, or a Framebuffer or Sprite.
        width, height : int
            Of a sprite; what is left over at the right and below is left out.
        gap : int, default 0
            Pixels between two sprites.

        Raises
        ------
        ValueError
            If not one fits in.

        Examples
        --------
        >>> from paneldraw import Framebuffer, Sprite
        >>> fb = Framebuffer(6, 3)
        >>> fb.rect(0, 0, 3, 3)
        >>> fb.rect(3, 0, 3, 3, fill=True)
        >>> [int(sprite.levels.pixels.sum()) for sprite in Sprite.sheet(fb, 3, 3)]
        [8, 9]
        """
        whole = (
            picture
            if isinstance(picture, Sprite)
            else cls(pictures.opened(picture) if isinstance(picture, str) else picture)
        )
        width, height, gap = whole_number("width", width), whole_number("height", height), whole_number("gap", gap)
        if not (1 <= width <= whole.width and 1 <= height <= whole.height and gap >= 0):
            raise ValueError(f"no sprite of {width} x {height} is in {whole.width} x {whole.height} pixels")
        return [
            whole._cut(x, y, width, height)
            for y in range(0, whole.height - height + 1, height + gap)
            for x in range(0, whole.width - width + 1, width + gap)
        ]

    def _cut(self, x: int, y: int, width: int, height: int) -> Sprite:
        part = np.s_[y : y + height, x : x + width]
        return self._of(self.levels.pixels[part], self.depth, None if self.opacity is None else self.opacity[part])

    def turned(self, quarters: int = 1) -> Sprite:
        """Return it turned by quarter turns clockwise."""
        turns = -whole_number("quarters", quarters)
        return self._of(
            np.rot90(self.levels.pixels, turns),
            self.depth,
            None if self.opacity is None else np.rot90(self.opacity, turns),
        )

    def mirrored(self) -> Sprite:
        """Return it with left and right exchanged."""
        return self._of(
            self.levels.pixels[:, ::-1], self.depth, None if self.opacity is None else self.opacity[:, ::-1]
        )

    @property
    def width(self) -> int:
        """Width in pixels."""
        return self.levels.width

    @property
    def height(self) -> int:
        """Height in pixels."""
        return self.levels.height

    @property
    def depth(self) -> int:
        """Bits a pixel."""
        return self.levels.depth

    def as_image(self) -> Any:
        """Return grays as an array or, where something is transparent, a Pillow image with its opacity."""
        grays = self.levels.pixels * np.uint8(255 // self.levels.max_level)
        if self.opacity is None:
            return grays
        from PIL import Image

        return Image.fromarray(np.dstack([grays, self.opacity]), "LA")

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sprite):
            return NotImplemented
        return self.levels == other.levels and np.array_equal(self._cover(), other._cover())

    __hash__ = None  # type: ignore[assignment]

    def _cover(self) -> Levels:
        return np.full((self.height, self.width), 255, np.uint8) if self.opacity is None else self.opacity

    def __repr__(self) -> str:
        return f"<Sprite {self.width}x{self.height}, {self.depth} bits a pixel>"


def _read_text(text: str) -> tuple[Levels, int, Levels]:
    rows = [row.rstrip() for row in textwrap.dedent(text).strip("\n").split("\n")]
    while rows and not rows[-1]:
        rows.pop()
    width = max(map(len, rows), default=0)
    rows = [row.ljust(width, ".").lower() for row in rows]
    unknown = sorted(set("".join(rows)) - set(_SHADES) - set("#" + _NOTHING))
    if unknown:
        raise ValueError(f"a sprite is written with #, 0 to 9, a to f, and . or space, not {unknown[0]!r}")
    highest = max((_SHADES.get(character, 0) for row in rows for character in row), default=0)
    depth = 1 if highest < 2 else 2 if highest < 4 else 4
    shades = _SHADES | {"#": 2**depth - 1} | dict.fromkeys(_NOTHING, 0)
    levels = np.array([[shades[character] for character in row] for row in rows], np.uint8).reshape(len(rows), width)
    opacity = np.array([[0 if character in _NOTHING else 255 for character in row] for row in rows], np.uint8)
    return levels, depth, opacity.reshape(len(rows), width)
