"""How panels look in a picture: the color of their light, their glass, the shape of their pixels."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from paneldraw.errors import did_you_mean

from .frames import Picture

if TYPE_CHECKING:
    from PIL.Image import Image

_PALETTE: Final = 256
_ROUND_SHADES: Final = 5
"""Steps from the glass to a round pixel's full color, at its edge."""
_FINE: Final = 8
"""Places a side at which the edge of a round pixel is looked at."""


@dataclass(frozen=True)
class Look:
    """How a panel looks in a picture; colors as Pillow reads them.

    Parameters
    ----------
    lit, dark : str
        Color of a pixel at the highest level, and at level 0. Default: a cold white on near black.
    glass : str
        Color between the pixels and around them. Default: black.
    gap : int or None
        Width of the gap between pixels, in image pixels; None is 1 from a scale of 4 on, else 0, and between round
        pixels a quarter of the scale. Default: None.
    top_lit : str, optional
        Color of the highest level in the first `top_rows` rows, of glass that has two. Default: `lit`.
    top_rows : int
        How many rows those are. Default: 0.
    round : bool
        Whether pixels are round, as LEDs are. Default: False.

    Examples
    --------
    >>> Look(lit="#ff0000", dark="#000000").colors([[0, 1]]).tolist()
    [[[0, 0, 0], [255, 0, 0]]]
    """

    lit: str = "#bfe9ff"
    dark: str = "#10161d"
    glass: str = "#000000"
    gap: int | None = None
    top_lit: str | None = None
    top_rows: int = 0
    round: bool = False

    def colors(self, pixels: Picture, max_level: int = 1) -> NDArray[np.uint8]:
        """Return the color of every pixel.

        Parameters
        ----------
        pixels : array_like
            Levels, shape (height, width).
        max_level : int
            The level that is fully lit. Default: 1.

        Returns
        -------
        numpy.ndarray
            Red, green and blue, uint8, shape (height, width, 3).
        """
        pixels = np.minimum(pixels, max_level)
        colors = self.ramp(max_level)[pixels]
        if self.top_rows and self.top_lit:
            colors[: self.top_rows] = self.ramp(max_level, top=True)[pixels[: self.top_rows]]
        return colors

    def ramp(self, steps: int, *, top: bool = False) -> NDArray[np.uint8]:
        """Return the colors from `dark` to `lit` in even steps, or to `top_lit`: uint8, shape (steps + 1, 3)."""
        dark, lit = _rgb(self.dark), _rgb((self.top_lit if top else None) or self.lit)
        colors: NDArray[np.uint8] = np.rint(dark + (lit - dark) * (np.arange(steps + 1) / steps)[:, None]).astype(
            np.uint8
        )
        return colors


LOOKS: Final[Mapping[str, Look]] = MappingProxyType(
    {
        "white": Look(),
        "blue": Look(lit="#38a4ff", dark="#0b121c"),
        "yellow-blue": Look(lit="#38a4ff", dark="#0b121c", top_lit="#ffd83a", top_rows=16),
        "green-led": Look(lit="#5dff3d", dark="#1a261b", glass="#070907", round=True),
        "red-led": Look(lit="#ff3b28", dark="#2b1613", glass="#0a0606", round=True),
        "lcd-green": Look(lit="#2b3a17", dark="#a5b84a", glass="#adc04f"),
        "lcd-gray": Look(lit="#23282c", dark="#b9c2c0", glass="#c1cac8"),
    }
)
"""The looks that have a name."""


def find_look(look: str | Look | None) -> Look:
    """Return the look of a name; None is white, and a look is itself.

    Raises
    ------
    ValueError
        For a name that there is none of.

    Examples
    --------
    >>> find_look("blue").lit
    '#38a4ff'
    """
    if isinstance(look, Look):
        return look
    found = LOOKS.get("white" if look is None else look)
    if found is None:
        hint = did_you_mean(str(look), LOOKS)
        raise ValueError(f"look: {look!r} is none of {', '.join(LOOKS)}{hint}")
    return found


def image(pixels: Picture, *, scale: int = 4, max_level: int = 1, look: str | Look | None = None) -> Image:
    """Draw levels as they look on a panel.

    Parameters
    ----------
    pixels : numpy.ndarray
        Levels, shape (height, width).
    scale : int
        Image pixels a panel pixel, at least 1. Default: 4. A margin of one panel pixel is drawn around.
    max_level : int
        The level that is fully lit. Default: 1.
    look : str or Look, optional
        A name of `LOOKS` or a look of your own. Default: white.

    Returns
    -------
    PIL.Image.Image
        Mode P, ((width + 2) * scale, (height + 2) * scale) pixels.

    Raises
    ------
    ValueError
        For an unknown look, a scale below 1 or a gap that leaves nothing of a pixel.

    Examples
    --------
    >>> import numpy as np
    >>> image(np.eye(8, dtype=np.uint8), scale=3).size
    (30, 30)
    """
    from PIL import Image

    drawn = drawing(scale, max_level, find_look(look))
    picture = Image.fromarray(drawn.colors(pixels))
    picture.putpalette(drawn.palette)
    return picture


@functools.lru_cache(maxsize=16)
def drawing(scale: int, max_level: int, look: Look) -> Drawing:
    """Return what draws pictures that are alike in scale, depth and look."""
    return Drawing(scale, max_level, look)


class Drawing:
    """Draws pictures that are alike in scale, depth and look, in the colors of a `palette`.

    Color 0 is the glass; then come, by level, the shades that a pixel has from its edge to its middle; and then the
    same of the top rows of split glass.
    """

    def __init__(self, scale: int, max_level: int, look: Look) -> None:
        gap = look.gap
        if gap is None:
            gap = scale // 4 if look.round else int(scale >= 4)
        if scale < 1 or not 0 <= gap < scale:
            raise ValueError(f"scale is at least 1 and the gap smaller than it, not {scale} and {gap}")
        self._scale = scale
        cell = _disc(scale, gap) if look.round and scale > 2 else _square(scale, gap)
        self._shades = int(cell.max())
        self._split = look.top_rows if look.top_lit else 0
        self._steps = min(max_level, (_PALETTE - 1) // (self._shades * (2 if self._split else 1)) - 1)
        self._indices = np.rint(np.arange(max_level + 1) * (self._steps / max_level)).astype(np.uint8)
        first = np.arange((self._steps + 1) * (2 if self._split else 1)) * self._shades
        self._rows = [np.where(row, first[:, None] + row, 0).astype(np.uint8) for row in cell]
        self.palette = self._mixed(look).tobytes()

    def _mixed(self, look: Look) -> NDArray[np.uint8]:
        glass = _rgb(look.glass)
        ramps = [look.ramp(self._steps, top=top) for top in ((False, True) if self._split else (False,))]
        shares = (np.arange(self._shades) + 1) / self._shades
        shaded = glass + (np.vstack(ramps)[:, None] - glass) * shares[:, None]
        return np.vstack([glass[None], np.rint(shaded).reshape(-1, 3)]).astype(np.uint8)

    def colors(self, pixels: Picture) -> NDArray[np.uint8]:
        """Draw a picture: numbers of the palette's colors."""
        colors = self._indices[np.minimum(pixels, len(self._indices) - 1)]
        if self._split:
            colors[: self._split] += np.uint8(self._steps + 1)
        height, width = colors.shape
        scale = self._scale
        canvas = np.zeros((height + 2, scale, width + 2, scale), np.uint8)
        for at, row in enumerate(self._rows):
            same = at > 0 and np.array_equal(row, self._rows[at - 1])
            canvas[1:-1, at, 1:-1] = canvas[1:-1, at - 1, 1:-1] if same else row.take(colors, axis=0)
        return canvas.reshape((height + 2) * scale, (width + 2) * scale)


def _square(scale: int, gap: int) -> NDArray[np.uint8]:
    """Shades within the square of a pixel: the gap is at its right and lower edges."""
    cell = np.zeros((scale, scale), np.uint8)
    cell[: scale - gap, : scale - gap] = 1
    return cell


def _disc(scale: int, gap: int) -> NDArray[np.uint8]:
    """Shades within the square of a round pixel: how much of each image pixel the disc covers."""
    middle, radius = (scale - gap) / 2, (scale - gap) / 2
    places = (np.arange(scale * _FINE) + 0.5) / _FINE - middle
    inside = np.hypot(places[:, None], places) <= radius
    covered = inside.reshape(scale, _FINE, scale, _FINE).mean(axis=(1, 3))
    cell: NDArray[np.uint8] = np.rint(covered * _ROUND_SHADES).astype(np.uint8)
    return cell


def _rgb(color: str) -> NDArray[np.float64]:
    from PIL import ImageColor

    return np.array(ImageColor.getrgb(color)[:3], np.float64)
