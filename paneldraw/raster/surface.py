"""The pixels that shapes are painted on, and the window outside of which nothing is painted."""

import cython
from cython.cimports.libc.string import memset

if not cython.compiled:
    OVER, XOR, ADD, MAX, CLEAR = range(5)

    def near(number):
        """A number as large as memory at most, in the type that counts that: cut to the window, or within reach."""
        return number

    def holds(surface, x, y):
        """Whether a pixel is in the window."""
        return surface.left <= x < surface.right and surface.top <= y < surface.bottom


#: How a level meets the level that a pixel has; `Surface.paint_with` takes the number.
OPS = {"over": OVER, "xor": XOR, "add": ADD, "max": MAX, "clear": CLEAR}


@cython.final
@cython.cclass
class Surface:
    """A rectangle of pixels, one byte each, in the memory of a bytearray.

    Shapes are clipped to the half-open window ``left <= x < right``, ``top <= y < bottom``. What a pixel of each level
    becomes where it is painted stands in the table `becomes`, so that each operation costs one look-up a pixel.
    """

    def __init__(self, memory, origin, stride, width, height, max_level):
        # Pixel (x, y) is memory[origin + y * stride + x].
        self.memory = memory
        self.origin = origin
        if cython.compiled:
            kept: bytearray = memory
            self.pixels = cython.cast(cython.p_uchar, cython.cast(cython.p_char, kept)) + self.origin
        else:
            self.pixels = memoryview(memory)[origin:]
            self.becomes = bytearray(256)
        self.marks = None
        self.stride = stride
        self.width = width
        self.height = height
        self.max_level = max_level
        self.level = -1
        self.op = -1
        self.set_window(0, 0, width, height)

    def set_window(self, left, top, right, bottom):
        """Confine painting to ``left <= x < right``, ``top <= y < bottom`` and to the surface."""
        self.left = min(max(left, 0), self.width)
        self.top = min(max(top, 0), self.height)
        self.right = max(min(right, self.width), self.left)
        self.bottom = max(min(bottom, self.height), self.top)

    def paint_with(self, level, op):
        """From now on paint with `level` and operation `op`."""
        old: cython.int
        if self.level == level and self.op == op:
            return
        self.level = level
        self.op = op
        for old in range(256):
            if op == OVER:
                self.becomes[old] = level
            elif op == XOR:
                self.becomes[old] = old ^ level
            elif op == ADD:
                self.becomes[old] = min(old + level, self.max_level)
            elif op == MAX:
                self.becomes[old] = max(old, level)
            else:
                self.becomes[old] = 0

    def point(self, x, y):
        """Paint one pixel, if it is in the window."""
        i: cython.longlong
        if holds(self, x, y):
            i = y * self.stride + x
            self.pixels[i] = self.becomes[self.pixels[i]]

    def span(self, y, x1, x2):
        """Paint the pixels ``x1 <= x < x2`` of row `y` that are in the window."""
        i: cython.longlong
        level: cython.uchar
        if not self.top <= y < self.bottom:
            return
        x1 = y * self.stride + max(x1, self.left)
        x2 = y * self.stride + min(x2, self.right)
        if self.op == OVER or self.op == CLEAR:
            level = self.becomes[0]
            if cython.compiled and x1 < x2:
                memset(self.pixels + x1, level, cython.cast(cython.size_t, x2 - x1))
            elif not cython.compiled:
                for i in range(x1, x2):
                    self.pixels[i] = level
        else:
            for i in range(x1, x2):
                self.pixels[i] = self.becomes[self.pixels[i]]
