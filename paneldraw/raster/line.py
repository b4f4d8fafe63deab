"""Lines one pixel wide: Bresenham's, and the DDA it is measured against.

Both step along the longer axis, one pixel a step, from the end point with the smaller coordinate there, so that a line
has the same pixels in either direction. Where the exact line passes halfway between two pixels, the one further along
the shorter axis is lit. Coordinates are whole pixels within +-2**29.
"""

import cython
from cython.cimports.paneldraw.raster.paint import once, painted
from cython.cimports.paneldraw.raster.surface import Surface, holds, near

if not cython.compiled:
    Walk = type("Walk", (), {})


def bresenham(surface, x1, y1, x2, y2):
    """Bresenham's line, both end points included."""
    walk: Walk
    if not cython.compiled:
        walk = Walk()
    to: cython.pointer[Walk] = cython.address(walk) if cython.compiled else walk
    _begin(to, surface, x1, y1, x2, y2)
    # A line that the window holds whole is not cut: many of them in one call take a fifth less time.
    if (holds(surface, x1, y1) and holds(surface, x2, y2)) or _cut(to, surface, 0, to.dx + 1):
        _bresenham(surface, to)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _begin(
    walk: cython.pointer[Walk],
    surface: Surface,
    x1: cython.longlong,
    y1: cython.longlong,
    x2: cython.longlong,
    y2: cython.longlong,
) -> cython.void:
    """Set out on a whole line: along its longer axis, from the end with the smaller coordinate there."""
    dx: cython.longlong = x2 - x1
    dy: cython.longlong = y2 - y1
    walk.along = 1
    walk.across = surface.stride
    walk.steep = abs(dx) < abs(dy)
    # From here on x is the longer axis.
    if walk.steep:
        x1, y1, dx, dy = y1, x1, dy, dx
        walk.along, walk.across = walk.across, walk.along
    walk.back = dx < 0
    if walk.back:
        x1, y1, dx, dy = x1 + dx, y1 + dy, -dx, -dy
    walk.x = x1
    walk.y = y1
    walk.index = x1 * walk.along + y1 * walk.across
    walk.up = dy < 0
    if walk.up:
        dy = -dy
        walk.across = -walk.across
    walk.dx = dx
    walk.dy = dy
    walk.first = 0
    walk.last = dx
    walk.moved = 0


def _cut(walk, surface, start, stop):
    """Cut a walk to its pixels number `start` up to and without `stop`, from (x1, y1) on, and of these to the window.

    Returns whether any can be seen.
    """
    left: cython.longlong = surface.top if walk.steep else surface.left
    right: cython.longlong = surface.bottom if walk.steep else surface.right
    top: cython.longlong = surface.left if walk.steep else surface.top
    bottom: cython.longlong = surface.right if walk.steep else surface.bottom
    dx: cython.longlong = walk.dx
    dy: cython.longlong = walk.dy
    if walk.back:
        start, stop = dx + 1 - stop, dx + 1 - start
    # How many moves to the side lead into the window, and how many out of it.
    low: cython.longlong = walk.y - bottom + 1 if walk.up else top - walk.y
    high: cython.longlong = walk.y - top if walk.up else bottom - 1 - walk.y
    first: cython.longlong = max(0, start, left - walk.x)
    last: cython.longlong = min(dx, stop - 1, right - 1 - walk.x)
    if low > dy or high < 0:
        return False
    # The line moves to the side for the k-th time at the first step s with 2 s dy + dx >= 2 k dx.
    if low > 0:
        first = max(first, ((2 * low - 1) * dx + 2 * dy - 1) // (2 * dy))
    if high < dy:
        last = min(last, ((2 * high + 1) * dx + 2 * dy - 1) // (2 * dy) - 1)
    if first > last:
        return False
    walk.first = first
    walk.last = last
    walk.moved = (2 * first * dy + dx) // (2 * dx) if first > 0 else 0
    return True


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _bresenham(surface: Surface, walk: cython.pointer[Walk]) -> cython.void:
    """The textbook's loop.

    The decision parameter p starts at 2 dy - dx; while it is negative the line goes straight on and p grows by 2 dy,
    else it moves to the side as well and p grows by 2 dy - 2 dx. A line that comes from outside of the window enters it
    with the p that it has there.
    """
    _: cython.longlong
    straight: cython.longlong = 2 * walk.dy
    diagonal: cython.longlong = 2 * walk.dy - 2 * walk.dx
    p: cython.longlong = straight * (walk.first + 1) - walk.dx * (2 * walk.moved + 1)
    along: cython.Py_ssize_t = walk.along
    both: cython.Py_ssize_t = walk.along + walk.across
    i: cython.Py_ssize_t = near(walk.index + walk.first * walk.along + walk.moved * walk.across)
    pixels: cython.p_uchar = surface.pixels
    becomes: cython.p_uchar = surface.becomes
    for _ in range(walk.last - walk.first + 1):
        pixels[i] = becomes[pixels[i]]
        if p < 0:
            p += straight
            i += along
        else:
            p += diagonal
            i += both


def _walk(surface, walk, dda):
    """Paint the pixels of a walk by one algorithm or the other."""
    if dda:
        _dda(surface, walk)
    else:
        _bresenham(surface, walk)


def _dda(surface, walk):
    """The digital differential analyzer: the same pixels, found in floating point.

    A unit step along the longer axis, the slope added on the other, and the sum rounded. Only the fraction of a row is
    summed up, from an exact start and half of the least distance from a tie above it, so that the pixels are those
    of the exact line in spite of the slope's rounding.
    """
    _: cython.longlong
    run: cython.double = max(walk.dx, 1)
    slope: cython.double = walk.dy / run
    doubled: cython.longlong = 2 * max(walk.dx, 1)
    above: cython.double = ((2 * walk.first * walk.dy + walk.dx) % doubled + 0.5) / doubled
    i: cython.Py_ssize_t = near(walk.index + walk.first * walk.along + walk.moved * walk.across)
    for _ in range(walk.last - walk.first + 1):
        surface.pixels[i] = surface.becomes[surface.pixels[i]]
        i += walk.along
        above += slope
        if above >= 1:
            above -= 1
            i += walk.across


def dashed(surface, x1, y1, x2, y2, pattern, count, phase, dda):
    """Of the line those pixels that a dash pattern shows: pixels lit and left out in turn, an even `count` of lengths.

    The pixel at (x1, y1) is number `phase` of the pattern. With no pattern the whole line is drawn.
    """
    k: cython.Py_ssize_t
    walk: Walk
    if not cython.compiled:
        walk = Walk()
    to: cython.pointer[Walk] = cython.address(walk) if cython.compiled else walk
    _begin(to, surface, x1, y1, x2, y2)
    if not _cut(to, surface, 0, to.dx + 1):
        return
    if count == 0:
        _walk(surface, to, dda)
        return
    period: cython.longlong = 0
    for k in range(count):
        period += pattern[k]
    # From the period in which the line enters the window, seen from (x1, y1), to the pixel where it leaves it.
    first: cython.longlong = walk.dx - walk.last if walk.back else walk.first
    last: cython.longlong = walk.dx - walk.first if walk.back else walk.last
    at: cython.longlong = first - (first + phase) % period
    while at <= last:
        for k in range(0, count, 2):
            if _cut(to, surface, max(at, 0), at + pattern[k]):
                _walk(surface, to, dda)
            at += pattern[k] + pattern[k + 1]


def polyline(surface, points, count, closed, pattern, lengths, phase, dda):
    """Lines from point to point, dashed where there is a pattern; where they meet or cross, a pixel is painted once."""
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    if count == 0:
        return
    top: cython.longlong = points[1]
    bottom: cython.longlong = points[1]
    lines: cython.Py_ssize_t = count if closed and count > 2 else max(count - 1, 1)
    marks: Surface = surface if lines == 1 else once(surface)
    for i in range(lines):
        j = (i + 1) % count
        x1: cython.longlong = points[2 * i]
        y1: cython.longlong = points[2 * i + 1]
        x2: cython.longlong = points[2 * j]
        y2: cython.longlong = points[2 * j + 1]
        if lengths == 0 and not dda:
            bresenham(marks, x1, y1, x2, y2)
        else:
            dashed(marks, x1, y1, x2, y2, pattern, lengths, phase, dda)
        phase += max(abs(x2 - x1), abs(y2 - y1))
        top = min(top, y1)
        bottom = max(bottom, y1)
    painted(surface, marks, min(top, points[2 * count - 1]), max(bottom, points[2 * count - 1]) + 1)
