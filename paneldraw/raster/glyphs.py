"""Text: the characters of a font as spans, and masks that say how much of each pixel is covered."""

from __future__ import annotations

from array import array
from typing import Any

import cython
import numpy as np
from cython.cimports.paneldraw.raster.paint import inverse_of, paint_coverage
from cython.cimports.paneldraw.raster.surface import OVER, Surface, near

#: Of characters that a font does not have, how many are remembered to be missing.
REMEMBERED = 65536

#: What the numbers of a picture are limited to.
LARGEST = 16383


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Glyphs:
    """The characters of a font of one bit a pixel, each as the spans of its rows, kept from its first use on.

    Parameters
    ----------
    picture_of : callable
        Takes a code point. Returns where it is lit, as an array of shape (height, width), the column of the picture's
        left edge from the pen, its top row from the top of the line, and the columns from this pen to the next; or
        None if the font does not have it.
    missing : tuple
        The picture of what stands for characters that the font does not have.
    gap : int
        Columns of the last advance that do not belong to a line.
    """

    def __init__(self, picture_of: Any, missing: Any, gap: cython.int) -> None:
        code: cython.int
        self.gap = gap
        self.left = self.right = self.top = self.bottom = 0
        self.overlapping = False
        self.picture_of = picture_of
        # Of each span row, first column, and the column behind it; character k has those from firsts[k] on.
        # Of each character: left, top, right and bottom of its picture.
        self.kept = (array("i", [0]), array("h"), array("h"), array("h"))
        self.far: dict[int, int] = {}
        if not cython.compiled:
            self.near = [-1] * 256
        for code in range(256):
            self.near[code] = -1
        self._keep(missing)

    def _keep(self, picture):
        """Add the picture of a character."""
        ink, left, top, advance = picture
        height, width = ink.shape
        if max(abs(left), abs(top), abs(advance), width, height) > LARGEST:
            raise ValueError(f"the picture of a character must be within {LARGEST} pixels, and is {width} x {height}")
        padded = np.zeros((height, width + 2), np.int8)
        padded[:, 1:-1] = ink != 0
        edges = np.diff(padded, axis=1)
        begins, ends = np.argwhere(edges > 0), np.argwhere(edges < 0)
        firsts, spans, advances, boxes = self.kept
        spans.extend(np.add(np.column_stack((begins, ends[:, 1])), (top, left, left)).ravel().tolist())
        firsts.append(len(spans) // 3)
        advances.append(advance)
        boxes.extend((left, top, left + width, top + height))
        self._point()
        self.left, self.right = min(self.left, left), max(self.right, left + width)
        self.top, self.bottom = min(self.top, top), max(self.bottom, top + height)
        lit = padded.any(axis=0).nonzero()[0]
        if len(lit):
            self.overlapping |= bool(lit.min() - 1 + left < 0 or lit.max() + left > advance)

    def _point(self):
        """Look again where the arrays are, which may move when they grow."""
        if cython.compiled:
            self.firsts = cython.cast(cython.p_int, _address(self.kept[0]))
            self.spans = cython.cast(cython.p_short, _address(self.kept[1]))
            self.advances = cython.cast(cython.p_short, _address(self.kept[2]))
            self.boxes = cython.cast(cython.p_short, _address(self.kept[3]))
        else:
            self.firsts, self.spans, self.advances, self.boxes = self.kept

    def add(self, code):
        """Ask for the picture of a character."""
        k: cython.int = 0
        picture = self.picture_of(code)
        if picture is not None:
            k = len(self.kept[2])
            self._keep(picture)
        if code < 256:
            self.near[code] = k
        elif k or len(self.far) < REMEMBERED:
            self.far[code] = k
        return k

    def find(self, code):
        """Which of the characters a code point is."""
        k: cython.int = self.near[code] if code < 256 else self.far.get(code, -1)
        return k if k >= 0 else self.add(code)

    def advance(self, text):
        """Columns from the pen at the start of a line to the pen at its end."""
        columns: cython.Py_ssize_t = 0
        k: cython.int
        character: cython.Py_UCS4
        for character in text:
            k = self.find(ord(character))
            columns += self.advances[k]
        return columns

    def measure(self, text: str) -> int:
        """Columns of a line of text."""
        return max(self.advance(text) - self.gap, 0)

    def bounds(self, text: str) -> tuple[int, int, int, int]:
        """Return left, top, right, bottom of a line's pictures, from its pen and top; all 0 where there are none."""
        character: cython.Py_UCS4
        k: cython.int
        x: cython.longlong = 0
        left: cython.longlong = 1 << 60
        right: cython.longlong = -(1 << 60)
        top: cython.longlong = left
        bottom: cython.longlong = right
        for character in text:
            k = self.find(ord(character))
            if self.boxes[4 * k] < self.boxes[4 * k + 2]:
                left = min(left, x + self.boxes[4 * k])
                top = min(top, self.boxes[4 * k + 1])
                right = max(right, x + self.boxes[4 * k + 2])
                bottom = max(bottom, self.boxes[4 * k + 3])
            x += self.advances[k]
        if left >= right:
            left = right = top = bottom = 0
        return left, top, right, bottom

    def cover(self, text: str, x: int, y: int, width: int, height: int) -> bytearray:
        """Return the coverage of a line, its pen at (x, y), in `width` x `height` pixels: rows of 0 and 255."""
        memory = bytearray(width * height)
        surface: Surface = Surface(memory, 0, width, width, height, 255)
        surface.paint_with(255, OVER)
        write(surface, self, text, x, y, 1)
        return memory


@cython.cfunc
@cython.exceptval(0, check=True)
def _address(numbers: Any) -> cython.size_t:
    return numbers.buffer_info()[0]


def one_line(text):
    """Whether a text is its characters side by side, without an end of line or a tab."""
    character: cython.Py_UCS4
    breaks: cython.Py_ssize_t = 0
    for character in text:
        breaks += character == "\n" or character == "\t"
    return breaks == 0


def write(surface, glyphs, text, x, y, factor):
    """Paint a line of text, its pen at x and its top at y, each pixel of the font `factor` x `factor` large."""
    character: cython.Py_UCS4
    k: cython.int
    i: cython.int
    line: cython.longlong
    first: cython.longlong
    left: cython.longlong
    right: cython.longlong
    top: cython.longlong
    spans: cython.p_short
    for character in text:
        k = glyphs.find(ord(character))
        spans = glyphs.spans
        if (
            x + glyphs.left * factor < surface.right
            and x + glyphs.right * factor > surface.left
            and y + glyphs.top * factor < surface.bottom
            and y + glyphs.bottom * factor > surface.top
        ):
            for i in range(3 * glyphs.firsts[k], 3 * glyphs.firsts[k + 1], 3):
                top = y + spans[i] * factor
                left = min(max(x + spans[i + 1] * factor, surface.left), surface.right)
                right = max(min(x + spans[i + 2] * factor, surface.right), surface.left)
                first = min(max(top, surface.top), surface.bottom)
                for line in range(first, min(top + factor, surface.bottom)):
                    surface.span(line, left, right)
        x += glyphs.advances[k] * factor


def stamp(coverage, mask, width, height, x, y):
    """Paint through a mask of coverages 0 ... 255, row by row in memory, its top-left pixel at (x, y)."""
    line: cython.longlong
    column: cython.longlong
    covered: cython.int
    first: cython.longlong = max(0, coverage.surface.left - x)
    last: cython.longlong = min(width, coverage.surface.right - x)
    changes: cython.p_int = coverage.row_of_changes()
    if first >= last:
        return
    for line in range(max(0, coverage.surface.top - y), min(height, coverage.surface.bottom - y)):
        before: cython.int = 0
        for column in range(first, last):
            covered = mask[line * width + column]
            changes[column - first] = covered - before
            before = covered
        count = near(last - first)
        paint_coverage(coverage.surface, near(y + line), near(x + first), changes, 0, count, 0, 255, inverse_of(255))
