"""How a level meets what is there: covered in part, and once where curves meet."""

import cython
from cython.cimports.paneldraw.raster.surface import ADD, CLEAR, OVER, XOR, Surface

if not cython.compiled:

    def inverse_of(full):
        """What to multiply by, and shift right by 32 bits, to divide a number below 512 * full by 2 * full."""
        return (1 << 32) // (2 * full) + 1

    def meet(old, level, covered, full, inverse, op, top):
        """What becomes of a pixel that `level` covers `covered` times of `full`, rounded to the nearest level."""
        if op in (OVER, CLEAR):
            return ((2 * (level - old) * covered + (2 * old + 1) * full) * inverse) >> 32
        share = ((2 * level * covered + full) * inverse) >> 32
        if op == XOR:
            return old ^ share
        return min(old + share, top) if op == ADD else max(old, share)


def once(surface):
    """What to paint a shape on whose parts may overlap: `painted` then paints each of its pixels once.

    It is the surface itself, if its operation may be repeated on a pixel, else a scratch surface of the same window.
    """
    if surface.op == XOR or surface.op == ADD:
        return scratch(surface)
    return surface


def scratch(surface):
    """A surface of the same window, all 0, on which pixels are marked by a 1."""
    if surface.marks is None:
        memory = bytearray(surface.width * surface.height)
        surface.marks = Surface(memory, 0, surface.width, surface.width, surface.height, 1)
        surface.marks.paint_with(1, OVER)
    surface.marks.set_window(surface.left, surface.top, surface.right, surface.bottom)
    return surface.marks


def painted(surface, marks, top, bottom):
    """Paint what was painted on `marks` in the rows ``top <= y < bottom``, which hold it all, and clear it there."""
    x: cython.Py_ssize_t
    y: cython.longlong
    row: cython.p_uchar
    if marks is surface:
        return
    for y in range(max(top, surface.top), min(bottom, surface.bottom)):
        row = marks.pixels + y * marks.stride if cython.compiled else marks.pixels[y * marks.stride :]
        for x in range(surface.left, surface.right):
            if row[x]:
                row[x] = 0
                surface.point(x, y)


def paint_coverage(surface, y, x, changes, first, count, shift, full, inverse):
    """Paint `count` pixels of row `y`, which is in the window, from (x, y) on by their coverage.

    From number `first` on, `changes` says by how much a pixel is covered more than the one before it: in 1 / full after
    a shift right by `shift` bits, with rounding. They are zero afterwards. Pixels outside of the window stay as they
    are. `inverse` is ``inverse_of(full)``.
    """
    i: cython.Py_ssize_t
    at: cython.Py_ssize_t
    start: cython.Py_ssize_t
    total: cython.int = 0
    covered: cython.int
    half: cython.int = (1 << shift) >> 1
    pixels: cython.p_uchar = surface.pixels
    op: cython.int = surface.op
    top: cython.int = surface.max_level
    level: cython.longlong = surface.level if op != CLEAR else 0
    before: cython.Py_ssize_t = min(max(surface.left - x, 0), count)
    end: cython.Py_ssize_t = min(surface.right - x, count)
    for i in range(first, first + before):
        total += changes[i]
        changes[i] = 0
    for i in range(first + max(end, 0), first + count):
        changes[i] = 0
    # From here on, numbers of changes and places in the row's memory differ by a constant.
    row: cython.Py_ssize_t = y * surface.stride + x - first
    i = first + before
    end += first
    while i < end:
        # A run of pixels that are covered alike.
        start = i
        total += changes[i]
        changes[i] = 0
        i += 1
        covered = (total + half) >> shift
        if i < end and changes[i] == 0:
            i = _end_of_zeros(changes, i, end)
            if covered >= full or (top == 1 and 2 * covered >= full):
                surface.span(y, x + start - first, x + i - first)
            elif covered > 0 and top > 1:
                for at in range(row + start, row + i):
                    pixels[at] = meet(pixels[at], level, covered, full, inverse, op, top)
            continue
        # A run of one: rows of lines and edges take a third less time.
        at = row + start
        if covered >= full or (top == 1 and 2 * covered >= full):
            pixels[at] = surface.becomes[pixels[at]]
        elif covered > 0 and top > 1:
            pixels[at] = meet(pixels[at], level, covered, full, inverse, op, top)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _end_of_zeros(changes: cython.p_int, i: cython.Py_ssize_t, end: cython.Py_ssize_t) -> cython.Py_ssize_t:
    """Where zeros end that go on from number `i` on."""
    while i + 4 <= end and (changes[i] | changes[i + 1] | changes[i + 2] | changes[i + 3]) == 0:
        i += 4
    while i < end and changes[i] == 0:
        i += 1
    return i


def paint_eight(surface, y, x, counts, full, inverse):
    """Paint up to eight pixels from (x, y) on, all in the window, by the bytes of `counts`, the lowest one first.

    A byte of `full` is the whole pixel.
    """
    covered: cython.int
    at: cython.Py_ssize_t = y * surface.stride + x
    pixels: cython.p_uchar = surface.pixels
    op: cython.int = surface.op
    top: cython.int = surface.max_level
    level: cython.longlong = surface.level if op != CLEAR else 0
    while counts:
        covered = counts & 255
        counts >>= 8
        if top > 1:
            pixels[at] = meet(pixels[at], level, covered, full, inverse, op, top)
        elif 2 * covered >= full:
            pixels[at] = surface.becomes[pixels[at]]
        at += 1
