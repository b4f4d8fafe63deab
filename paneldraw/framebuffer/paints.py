"""What shapes are drawn with in the place of one level: patterns that repeat, and gradients."""

from __future__ import annotations

from abc import ABC, abstractmethod
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np

from paneldraw.framebuffer import pictures
from paneldraw.framebuffer.arguments import real, whole

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TypeAlias

    from numpy.typing import NDArray

    from paneldraw.framebuffer.pictures import Levels

    Number: TypeAlias = int | float
    Place: TypeAlias = tuple[Number, Number]
    Box: TypeAlias = tuple[int, int, int, int]

Steps = Literal["bayer", "blue-noise"]

#: So far points may lie that their distance, squared, is still a number.
_FARTHEST = 1e150


class Paint(ABC):
    """A level for every pixel of a framebuffer, counted from its pixel (0, 0)."""

    @abstractmethod
    def levels(self, box: Box, max_level: int) -> tuple[Levels, Levels | None]:
        """Return what it is there: levels 0 ... `max_level` and, where not all is opaque, the opacity 0 ... 255.

        Parameters
        ----------
        box : tuple of int
            Left, top, right and bottom: the pixels ``left <= x < right``, ``top <= y < bottom``, none below 0.
        max_level : int
        """


class _Ready:
    """A ready pattern, made when somebody asks for it: `Sprite` is not there before."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __get__(self, instance: object, owner: type[Pattern]) -> Pattern:
        return owner(self._text)


class Pattern(Paint):
    """A small picture that repeats over the framebuffer, to draw with in the place of a level.

    It lies still: shapes side by side that are drawn with the same pattern meet without a seam.

    Parameters
    ----------
    picture : str or any picture
        As for `Sprite`: lines of text, in which ``#`` is the highest level, 0 to 9 and a to f are levels, and what is
        ``.`` leaves the pixel as it is; or an image, an array, a path, a Framebuffer or a Sprite.
    origin : tuple of int, default (0, 0)
        A pixel of the framebuffer at which the picture's top-left pixel lies.

    Attributes
    ----------
    checker, dots, horizontal, vertical, diagonal, bricks : Pattern
        Ready ones: every other pixel, one pixel of 16, lines 4 pixels apart, and a wall of bricks.

    Raises
    ------
    TypeError, ValueError
        If there is no such picture, or `origin` is no place.

    Examples
    --------
    >>> from paneldraw import Framebuffer, Pattern
    >>> fb = Framebuffer(16, 4)
    >>> fb.rect(0, 0, 7, 4, Pattern.checker, fill=True)
    >>> fb.rect(9, 0, 7, 4, Pattern("#..\\n.#.\\n..#"), fill=True)
    >>> print(fb)
    #.#.#.#..#..#..#
    .#.#.#....#..#..
    #.#.#.#....#..#.
    .#.#.#...#..#..#
    """

    checker = _Ready("#.\n.#")
    dots = _Ready("....\n..#.\n....\n....")
    horizontal = _Ready("#\n.\n.\n.")
    vertical = _Ready("#...")
    diagonal = _Ready("...#\n..#.\n.#..\n#...")
    bricks = _Ready("########\n#.......\n#.......\n########\n....#...\n....#...")

    def __init__(self, picture: Any, origin: tuple[Number, Number] = (0, 0)) -> None:
        from paneldraw.framebuffer.sprites import Sprite  # which draws on framebuffers

        self._sprite = picture if isinstance(picture, Sprite) else Sprite(picture)
        x, y = (whole("origin", number) for number in _place("origin", origin))
        self._origin = x % self._sprite.width, y % self._sprite.height
        self._tiles: dict[int, Levels] = {}

    def at(self, x: int | float, y: int | float) -> Pattern:
        """Return the same pattern with its origin at (x, y)."""
        return Pattern(self._sprite, (x, y))

    def levels(self, box: Box, max_level: int) -> tuple[Levels, Levels | None]:
        left, top, right, bottom = box
        sprite = self._sprite
        tile = self._tiles.get(max_level)
        if tile is None:
            scaled = type(sprite.levels)(sprite.width, sprite.height, max_level.bit_length())
            scaled.blit(sprite.levels, 0, 0)
            tile = self._tiles[max_level] = scaled.pixels
        rows = np.arange(top - self._origin[1], bottom - self._origin[1]) % sprite.height
        columns = np.arange(left - self._origin[0], right - self._origin[0]) % sprite.width
        opacity = None if sprite.opacity is None else sprite.opacity.take(rows, 0).take(columns, 1)
        return tile.take(rows, 0).take(columns, 1), opacity

    def __repr__(self) -> str:
        return f"<Pattern {self._sprite.width}x{self._sprite.height}, origin={self._origin}>"


class Gradient(Paint):
    """Tones that go over into each other, to draw with in the place of a level.

    Parameters
    ----------
    start, end : tuple of int or float
        The points (x, y) of the framebuffer at which the first and the last tone are reached. Between, the tone
        changes along the line from one to the other; before and behind them it stays.
    tones : sequence of float, or of pairs of float, default (0, 1)
        Shares of the highest level, from 0 to 1, evenly spread between the points; or (where, tone) with where each is
        reached: 0 at the first point, 1 at the last.
    dither : {"blue-noise", "bayer", None}
        How levels are mixed to a tone between them, as for `Framebuffer.image`; None takes the nearest. Default: blue
        noise.

    Raises
    ------
    TypeError, ValueError
        If a point or tone is none, or the tones are fewer than two or out of order.

    Examples
    --------
    >>> from paneldraw import Framebuffer, Gradient
    >>> fb = Framebuffer(16, 4)
    >>> fb.rect(0, 0, 16, 4, Gradient((0, 0), (15, 0), dither="bayer"), fill=True)
    >>> print(fb)
    .......#.#.#.###
    ..#.#.#.#.######
    .....#.#.#.#####
    ....#.#.########
    >>> fb.circle(8, 2, 2, Gradient.radial((8, 2), 2, tones=(1, 0)))
    """

    def __init__(
        self,
        start: Place,
        end: Place,
        tones: Sequence[Number] | Sequence[tuple[Number, Number]] = (0, 1),
        *,
        dither: Steps | None = "blue-noise",
    ) -> None:
        if dither is not None and dither not in get_args(Steps):
            raise ValueError(f'dither must be "blue-noise", "bayer" or None, not {dither!r}')
        self._start, self._end = _place("start", start), _place("end", end)
        self._where, self._tones = _stops(tones)
        self._dither = dither
        self._radius: float | None = None

    @classmethod
    def radial(
        cls,
        center: Place,
        r: int | float,
        tones: Sequence[Number] | Sequence[tuple[Number, Number]] = (0, 1),
        *,
        dither: Steps | None = "blue-noise",
    ) -> Gradient:
        """Return one whose first tone is at a point and whose last one is `r` pixels around it and beyond.

        Parameters
        ----------
        center : tuple of int or float
        r : int or float
            Above 0.
        tones, dither
            As for `Gradient`.
        """
        radius = float(min(real("r", r), _FARTHEST))
        if radius <= 0:
            raise ValueError(f"r must be above 0, and is {r}")
        gradient = cls(center, center, tones, dither=dither)
        gradient._radius = radius
        return gradient

    def levels(self, box: Box, max_level: int) -> tuple[Levels, Levels | None]:
        left, top, right, bottom = box
        x = np.arange(left, right) - self._start[0]
        y = (np.arange(top, bottom) - self._start[1])[:, np.newaxis]
        with np.errstate(over="ignore"):  # a share too large for a number lies beyond the end
            shares = self._shares(x, y)
        grays = np.rint(255 * np.interp(shares, self._where, self._tones)).astype(np.uint8)
        return pictures.quantize(grays, max_level, self._dither, place=(left, top)), None

    def _shares(self, x: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
        """How far along the gradient points are, given from its start: 0 at the first tone, 1 at the last."""
        if self._radius is not None:
            return np.hypot(x, y) / self._radius
        dx, dy = self._end[0] - self._start[0], self._end[1] - self._start[1]
        length = float(np.hypot(dx, dy))
        if length == 0:
            return np.ones(np.broadcast_shapes(x.shape, y.shape))
        return (x * (dx / length) + y * (dy / length)) / length

    def __repr__(self) -> str:
        to = f"r={self._radius}" if self._radius is not None else f"end={self._end}"
        return f"<Gradient start={self._start}, {to}, {len(self._tones)} tones>"


def covered_box(cover: Levels) -> Box | None:
    """Return the smallest box that holds all that is not 0, None if all is 0."""
    columns = np.maximum.reduce(cover, 0).nonzero()[0]
    if not len(columns):
        return None
    left, right = int(columns[0]), int(columns[-1]) + 1
    rows = np.maximum.reduce(cover[:, left:right], 1).nonzero()[0]
    return left, int(rows[0]), right, int(rows[-1]) + 1


def _place(name: str, place: Any) -> tuple[float, float]:
    try:
        x, y = place
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a point (x, y), not {place!r}") from None
    column, row = (float(min(max(real(name, number), -_FARTHEST), _FARTHEST)) for number in (x, y))
    return column, row


def _stops(tones: Any) -> tuple[list[float], list[float]]:
    """Where tones are reached, from 0 to 1, and which they are."""
    try:
        items = list(tones)
    except TypeError:
        raise TypeError(f"tones must be a sequence of numbers or of pairs of them, not {tones!r}") from None
    if len(items) < 2:
        raise ValueError(f"tones must be two or more, not {len(items)}")
    if not hasattr(items[0], "__len__"):
        items = [(i / (len(items) - 1), tone) for i, tone in enumerate(items)]
    pairs = [_place("tones", item) for item in items]
    where = [pair[0] for pair in pairs]
    shades = [pair[1] for pair in pairs]
    if not all(0 <= number <= 1 for number in where + shades) or any(b < a for a, b in pairwise(where)):
        raise ValueError(f"tones must be from 0 to 1, and so must where they are, in order, not {tones!r}")
    return where, shades
