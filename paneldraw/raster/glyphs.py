"""Text: the characters of a font as spans, and masks that say how much of each pixel is covered."""

from __future__ import annotations

from array import array
from typing import Any

import cython
import numpy as np
from cython.cimports.paneldraw.raster.paint import inverse_of, paint_coverage
from cython.cimports.paneldraw.raster.surface import near


@cython.final
@cython.auto_pickle(False)
@cython.cclass
class Glyphs:
    """The characters of a font of one bit a pixel, each as the spans of its rows.

    Parameters
    ----------
    codes : sequence of int
        Code points of the characters. The first one stands for all that are not among them.
    pictures : ndarray, shape (characters, height, width)
        Where each is lit, in the order of `codes`.
    advances : sequence of int
        Columns from each character to the next.
    gap : int
        Columns of the last advance that do not belong to a line.
    """

    def __init__(self, codes: Any, pictures: Any, advances: Any, gap: cython.int) -> None:
        k: cython.int
        count, height, width = pictures.shape
        self.height = height
        self.width = width
        self.gap = gap
        # Of each span row, first column, and the column behind it; character k has those from firsts[k] on.
        padded = np.zeros((count, height, width + 2), np.int8)
        padded[:, :, 1:-1] = pictures != 0
        edges = np.diff(padded, axis=2)
        begins, ends = np.argwhere(edges > 0), np.argwhere(edges < 0)
        spans = np.column_stack((begins[:, 1:], ends[:, 2]))
        firsts = np.searchsorted(begins[:, 0], np.arange(count + 1))
        self.kept = (array("i", firsts.tolist()), array("h", spans.ravel().tolist()), array("h", advances))
        if cython.compiled:
            self.firsts = cython.cast(cython.p_int, _address(self.kept[0]))
            self.spans = cython.cast(cython.p_short, _address(self.kept[1]))
            self.advances = cython.cast(cython.p_short, _address(self.kept[2]))
        else:
            self.firsts, self.spans, self.advances = self.kept
            self.near = [0] * 256
        self.far = {code: k for k, code in enumerate(codes)}
        for k in range(256):
            self.near[k] = self.far.get(k, 0)

    def find(self, code):
        """Which of the characters a code point is."""
        return self.near[code] if code < 256 else self.far.get(code, 0)

    def measure(self, text):
        """Columns of a line of text."""
        columns: cython.int = -self.gap
        character: cython.Py_UCS4
        for character in text:
            columns += self.advances[self.find(ord(character))]
        return max(columns, 0)


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
    """Paint a line of text, its top-left pixel at (x, y), each pixel of the font `factor` x `factor` large."""
    character: cython.Py_UCS4
    k: cython.int
    i: cython.int
    line: cython.longlong
    first: cython.longlong
    left: cython.longlong
    right: cython.longlong
    top: cython.longlong
    spans: cython.p_short = glyphs.spans
    if y >= surface.bottom or y + glyphs.height * factor <= surface.top:
        return
    for character in text:
        k = glyphs.find(ord(character))
        if x < surface.right and x + glyphs.width * factor > surface.left:
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
