"""What `adafruit_framebuf` draws, pixel by pixel."""

from __future__ import annotations

import functools
import operator
import os
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from paneldraw.framebuffer import Framebuffer
from paneldraw.text import Font

if TYPE_CHECKING:
    from PIL import Image

Levels = NDArray[np.uint8]
FONT: Final = "font5x8.bin"


class Drawing:
    """Pixels of one bit and the calls that draw them.

    Coordinates are those of the turned picture; `width` and `height` remain those of the glass. What is outside is cut
    off, but an outline of `rect` that leaves the glass runs along its edge. A color is 0 or anything else.

    Parameters
    ----------
    width, height : int
        Pixels of the glass.
    """

    def __init__(self, width: int, height: int) -> None:
        self.width, self.height = width, height
        self._pixels: Levels = np.zeros((height, width), np.uint8)
        self._seen = self._pixels
        self._rotation = 0

    @property
    def rotation(self) -> int:
        """Quarter turns clockwise of what is drawn from now on: 0 to 3."""
        return self._rotation

    @rotation.setter
    def rotation(self, val: int) -> None:
        if val not in (0, 1, 2, 3):
            raise ValueError(f"rotation must be 0, 1, 2 or 3, not {val!r}")
        self._rotation = val
        self._seen = np.rot90(self._pixels, val)  # a view

    def fill(self, color: int) -> None:
        """Set all pixels."""
        self._pixels[:] = bool(color)

    def pixel(self, x: int, y: int, color: int | None = None) -> int | None:
        """Set a pixel, or return one; None outside."""
        height, width = self._seen.shape
        if not (0 <= x < width and 0 <= y < height):
            return None
        if color is None:
            return int(self._seen[y, x])
        self._seen[y, x] = bool(color)
        return None

    def hline(self, x: int, y: int, width: int, color: int) -> None:
        """Draw a line to the right."""
        self.rect(x, y, width, 1, color, fill=True)

    def vline(self, x: int, y: int, height: int, color: int) -> None:
        """Draw a line down."""
        self.rect(x, y, 1, height, color, fill=True)

    def fill_rect(self, x: int, y: int, width: int, height: int, color: int) -> None:
        """Fill a rectangle."""
        self.rect(x, y, width, height, color, fill=True)

    def rect(self, x: int, y: int, width: int, height: int, color: int, *, fill: bool = False) -> None:
        """Draw a rectangle's outline, or fill it."""
        rows, columns = self._seen.shape
        left, top, right, bottom = max(x, 0), max(y, 0), min(x + width, columns), min(y + height, rows)
        if left >= right or top >= bottom:
            return
        inside = self._seen[top:bottom, left:right]
        if fill:
            inside[:] = bool(color)
        else:
            inside[[0, -1]] = inside[:, [0, -1]] = bool(color)

    def line(self, x_0: int, y_0: int, x_1: int, y_1: int, color: int) -> None:
        """Draw a line by Bresenham's algorithm; of two equally near pixels it takes that of its start's side."""
        ends = [(operator.index(x_0), operator.index(x_1)), (operator.index(y_0), operator.index(y_1))]
        steep = abs(x_1 - x_0) <= abs(y_1 - y_0)
        (start, stop), (other, goal) = reversed(ends) if steep else ends
        run, rise = abs(stop - start), abs(goal - other)
        along, across = (1 if stop >= start else -1), (1 if goal >= other else -1)
        length = self._seen.shape[0 if steep else 1]
        # Only steps that are on the glass, however far the ends are.
        first, last = (-start, length - 1 - start) if along > 0 else (start - length + 1, start)
        points = [
            (start + along * step, other + across * -((run - 2 * step * rise) // (2 * run or 1)))
            for step in range(max(first, 0), min(last, run) + 1)
        ]
        self._points((each[::-1] for each in points) if steep else points, color)

    def circle(self, center_x: int, center_y: int, radius: int, color: int) -> None:
        """Draw a circle's outline; its outermost pixels are `radius` - 1 from the center."""
        x, y, error = radius - 1, 0, 1 - 2 * radius
        step_x = step_y = 1
        eighth = []
        while x >= y:
            eighth += [(x, y), (y, x)]
            if error <= 0:
                y, error, step_y = y + 1, error + step_y, step_y + 2
            if error > 0:
                x, step_x = x - 1, step_x + 2
                error += step_x - 2 * radius
        signs = ((1, 1), (-1, 1), (1, -1), (-1, -1))
        self._points(((center_x + a * x, center_y + b * y) for x, y in eighth for a, b in signs), color)

    def scroll(self, delta_x: int, delta_y: int) -> None:
        """Move the glass's pixels, unturned; what is left behind stays."""
        height, width = self._pixels.shape
        here = self._pixels[max(-delta_y, 0) : max(height - delta_y, 0), max(-delta_x, 0) : max(width - delta_x, 0)]
        there = self._pixels[max(delta_y, 0) : max(height + delta_y, 0), max(delta_x, 0) : max(width + delta_x, 0)]
        there[:] = here.copy()

    def image(self, img: Image.Image) -> None:
        """Draw a Pillow image of mode ``1`` and of the turned glass's size."""
        height, width = self._seen.shape
        if img.mode != "1":
            raise ValueError(f'img must be of mode "1", not {img.mode!r}: img.convert("1")')
        if img.size != (width, height):
            raise ValueError(f"img must be of the display's size {width}x{height}, not {img.width}x{img.height}")
        self._seen[:] = np.asarray(img)

    def text(self, string: str, x: int, y: int, color: int, *, font_name: str = FONT, size: int = 1) -> None:
        r"""Draw text, with its upper left corner at a place; ``\n`` begins a line.

        Parameters
        ----------
        string : str
        x, y : int
        color : int
        font_name : str, optional
            A file of Adafruit's format. Default: ``font5x8.bin`` where the script runs, if it is there, else
            paneldraw's own font, which stands at the same distances.
        size : int, optional
            How many times larger. Default: 1.

        Raises
        ------
        OSError, ValueError
            There is no such file, or it is no font, or `size` is below 1.
        """
        glyphs = _Own() if font_name == FONT and not Path(FONT).exists() else _File(font_name)
        if size < 1:
            raise ValueError(f"size must be 1 or more, not {size}")
        for line in string.split("\n"):
            at = x
            for character in line:
                self._stamp(glyphs.glyph(character), at, y, size, color)
                at += (glyphs.width + 1) * size
            y += glyphs.height * size

    def _stamp(self, glyph: Levels, x: int, y: int, size: int, color: int) -> None:
        """Draw the lit pixels of a glyph."""
        drawn = glyph.repeat(size, axis=0).repeat(size, axis=1)[max(-y, 0) :, max(-x, 0) :]
        place = self._seen[max(y, 0) : max(y, 0) + drawn.shape[0], max(x, 0) : max(x, 0) + drawn.shape[1]]
        place[drawn[: place.shape[0], : place.shape[1]] != 0] = bool(color)

    def _points(self, points: Iterable[tuple[int, int]], color: int) -> None:
        height, width = self._seen.shape
        for x, y in points:
            if 0 <= x < width and 0 <= y < height:
                self._seen[y, x] = bool(color)


class _Own:
    """Paneldraw's own font."""

    width, height = 5, 8

    def glyph(self, character: str) -> Levels:
        """Return a character's pixels."""
        return _own_glyph(character)


@functools.cache
def _own_glyph(character: str) -> Levels:
    cell = Framebuffer(_Own.width + 1, _Own.height)
    cell.text(character, 0, 0, font=Font.builtin())
    return cell.pixels


class _File:
    """A font in a file: width, height, and a byte a column of 256 characters, the upper pixel in the lowest bit."""

    def __init__(self, path: str | os.PathLike[str]) -> None:
        data = Path(path).read_bytes()
        if len(data) < 2 or len(data) != 2 + 256 * data[0] or not 1 <= data[1] <= 8:
            raise ValueError(f"font_name must be a font of Adafruit's format, 2 + 256 * width bytes, not {path}")
        self.width, self.height = data[:2]
        columns = np.frombuffer(data, np.uint8, offset=2).reshape(256, self.width)
        rows = np.arange(self.height, dtype=np.uint8)[:, None]
        self._glyphs: Levels = (columns[:, None, :] >> rows & 1).astype(np.uint8)

    def glyph(self, character: str) -> Levels:
        """Return a character's pixels; those of ``?`` for one that no byte names."""
        code = ord(character)
        glyph: Levels = self._glyphs[code if code < len(self._glyphs) else ord("?")]
        return glyph
