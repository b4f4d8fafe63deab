"""Flood fill: the pixels that hang together, four-connected, span by span.

From a pixel the span around it is found, and above and below it the pixels that begin a span there: A. R. Smith, "Tint
fill", SIGGRAPH 1979, 276-283.
"""

import cython
from cython.cimports.paneldraw.raster.paint import painted, scratch
from cython.cimports.paneldraw.raster.surface import Surface, holds, near


@cython.final
@cython.cclass
class Flood:
    """What is filled: pixels of a level, or all up to a border of one; and the spans that are still to be looked at."""

    def __init__(self, surface: Surface, level, border):
        self.surface = surface
        self.marks = scratch(surface)
        self.level = level
        self.border = border
        self.memory = bytearray()
        self.waiting = 0
        if not cython.compiled:
            self.places = [0, 0]

    def takes(self, x, y):
        """Whether a pixel in the window is to be filled, and is not yet."""
        level: cython.uchar = self.surface.pixels[y * self.surface.stride + x]
        return (level == self.level) != self.border and not self.marks.pixels[y * self.marks.stride + x]

    def push(self, x, y):
        """Remember a pixel of a span to fill."""
        if cython.compiled:
            if 16 * self.waiting == len(self.memory):
                self.memory.extend(bytes(len(self.memory) + 1024))
                self.places = cython.cast(cython.p_longlong, cython.cast(cython.p_char, self.memory))
            self.places[2 * self.waiting] = x
            self.places[2 * self.waiting + 1] = y
        else:
            self.places[2 * self.waiting :] = [x, y]
        self.waiting += 1

    def run(self):
        """Mark all that hangs together with the remembered pixels; return how many that are."""
        count: cython.Py_ssize_t = 0
        while self.waiting > 0:
            self.waiting -= 1
            left: cython.longlong = self.places[2 * self.waiting]
            y: cython.longlong = self.places[2 * self.waiting + 1]
            if not self.takes(left, y):
                continue
            right: cython.longlong = left + 1
            while left > self.surface.left and self.takes(left - 1, y):
                left -= 1
            while right < self.surface.right and self.takes(right, y):
                right += 1
            self.marks.span(y, left, right)
            count += near(right - left)
            self.top = min(self.top, y)
            self.bottom = max(self.bottom, y + 1)
            if y > self.surface.top:
                self.look(left, right, y - 1)
            if y + 1 < self.surface.bottom:
                self.look(left, right, y + 1)
        return count

    def look(self, left, right, y):
        """Remember one pixel of each span of a row that begins beside another span or goes on there."""
        x: cython.longlong
        inside: cython.bint = False
        for x in range(left, right):
            taken: cython.bint = self.takes(x, y)
            if taken and not inside:
                self.push(x, y)
            inside = taken


def flood(surface, x, y, level, border):
    """Paint the pixels of a level that hang together with (x, y), or with `border` all up to those; how many it was."""
    if not holds(surface, x, y):
        return 0
    fill: Flood = Flood(surface, level, border)
    fill.top = fill.bottom = y
    fill.push(x, y)
    count: cython.Py_ssize_t = fill.run()
    painted(surface, fill.marks, fill.top, fill.bottom)
    return count
