# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""Lines one pixel wide: Bresenham's, and the DDA it is measured against.

Both step along the longer axis, one pixel a step, from the end point with the smaller coordinate there, so that a
line has the same pixels in either direction. Where the exact line passes halfway between two pixels, the one further
along the shorter axis is lit.
"""

from __future__ import annotations

from typing import Any

import cython

if cython.compiled:
    from cython.cimports.paneldraw.raster.surface import Surface
else:
    from paneldraw.raster.surface import Surface

# More steps than a line has.
WHOLE = cython.declare(cython.longlong, 1 << 40)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def bresenham(
    surface: Surface, x1: cython.longlong, y1: cython.longlong, x2: cython.longlong, y2: cython.longlong
) -> cython.void:
    """Bresenham's line, both end points included; coordinates within +-2**29."""
    bresenham_part(surface, x1, y1, x2, y2, 0, WHOLE)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def bresenham_part(
    surface: Surface,
    x1: cython.longlong,
    y1: cython.longlong,
    x2: cython.longlong,
    y2: cython.longlong,
    start: cython.longlong,
    stop: cython.longlong,
) -> cython.void:
    """Of Bresenham's line the pixels from step `start` up to and without step `stop`, counted from (x1, y1).

    The decision parameter p is the textbook's: it starts at 2 dy - dx; while it is negative the line stays on its
    row and p grows by 2 dy, else the line moves to the next row and p grows by 2 dy - 2 dx. A line that comes from
    outside of the window enters it with the p that it has there.
    """
    dx: cython.longlong = x2 - x1
    dy: cython.longlong = y2 - y1
    # Steps of the pixel's index along the longer axis ("x" from here on) and the shorter one ("y").
    along: cython.Py_ssize_t = 1
    across: cython.Py_ssize_t = surface.stride
    left: cython.longlong = surface.left
    right: cython.longlong = surface.right
    top: cython.longlong = surface.top
    bottom: cython.longlong = surface.bottom
    if abs(dx) < abs(dy):
        x1, y1, dx, dy = y1, x1, dy, dx
        along, across = across, along
        left, right, top, bottom = top, bottom, left, right
    # A branch on these signs would be guessed wrong half of the time: -1 where one is negative, 0 elsewhere.
    negative: cython.longlong = dx >> 63
    x1 += dx & negative
    y1 += dy & negative
    dx = (dx ^ negative) - negative
    dy = (dy ^ negative) - negative
    first: cython.longlong = max(0, left - x1)
    last: cython.longlong = min(dx, right - 1 - x1)
    if start > 0 or stop <= dx:
        first = max(first, dx + 1 - stop if negative else start)
        last = min(last, dx - start if negative else stop - 1)
    i: cython.Py_ssize_t = x1 * along + y1 * across
    # How many rows the line may have moved, at least and at most, to be in the window.
    low: cython.longlong = top - y1
    high: cython.longlong = bottom - 1 - y1
    negative = dy >> 63
    dy = (dy ^ negative) - negative
    across = (across ^ negative) - negative
    if negative:
        low, high = -high, -low
    if low > dy or high < 0:
        return
    if low > 0:
        first = max(first, ((2 * low - 1) * dx + 2 * dy - 1) // (2 * dy))
    if high < dy:
        last = min(last, ((2 * high + 1) * dx + 2 * dy - 1) // (2 * dy) - 1)
    if first > last:
        return
    moved: cython.longlong = 0
    end: cython.longlong = dy
    if first > 0:
        moved = (2 * first * dy + dx) // (2 * dx)
    if last < dx:
        end = (2 * last * dy + dx) // (2 * dx)
    # From both ends to the middle: two short chains of decisions run faster than a long one. Backwards a tie
    # falls the other way, so p is one less there.
    stay: cython.longlong = 2 * dy
    move: cython.longlong = 2 * dy - 2 * dx
    diagonal: cython.Py_ssize_t = along + across
    p: cython.longlong = 2 * dy * (first + 1) - dx * (2 * moved + 1)
    q: cython.longlong = dx * (2 * end - 1) - 2 * dy * (last - 1) - 1
    j: cython.Py_ssize_t = i + last * along + end * across
    i += first * along + moved * across
    pixels: cython.p_uchar = surface.pixels
    ink: cython.p_uchar = surface.ink
    level: cython.uchar = ink[0]
    # Painting over what is there needs no look at it.
    blind: cython.bint = surface.op == 0 or surface.op == 4
    below: cython.longlong
    count: cython.longlong = last - first + 1
    while count > 1:
        if blind:
            pixels[i] = level
            pixels[j] = level
        else:
            pixels[i] = ink[pixels[i]]
            pixels[j] = ink[pixels[j]]
        below = p >> 63
        p = p + move + (below & (stay - move))
        i = i + diagonal + (below & (along - diagonal))
        below = q >> 63
        q = q + move + (below & (stay - move))
        j = j - diagonal - (below & (along - diagonal))
        count -= 2
    if count:
        pixels[i] = ink[pixels[i]]


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def dda_part(
    surface: Surface,
    x1: cython.longlong,
    y1: cython.longlong,
    x2: cython.longlong,
    y2: cython.longlong,
    start: cython.longlong,
    stop: cython.longlong,
) -> cython.void:
    """The digital differential analyzer: the same pixels as `bresenham_part` lights, found in floating point.

    A unit step along the longer axis, the slope added on the other, and the sum rounded. Only the fraction of a row is
    summed up, from an exact start and half of the least distance from a tie above it, so that the pixels are those
    of the exact line in spite of the slope's rounding.
    """
    dx: cython.longlong = x2 - x1
    dy: cython.longlong = y2 - y1
    steep: cython.bint = abs(dx) < abs(dy)
    if steep:
        x1, y1, x2, y2, dx, dy = y1, x1, y2, x2, dy, dx
    if dx < 0:
        x1, y1, dx, dy = x2, y2, -dx, -dy
        start, stop = dx + 1 - stop, dx + 1 - start
    first: cython.longlong = max(0, start, (surface.top if steep else surface.left) - x1)
    last: cython.longlong = min(dx, stop - 1, (surface.bottom if steep else surface.right) - 1 - x1)
    if first > last:
        return
    direction: cython.longlong = 1 if dy >= 0 else -1
    run: cython.double = max(dx, 1)
    slope: cython.double = abs(dy) / run
    doubled: cython.longlong = 2 * max(dx, 1)
    moved: cython.longlong = (2 * first * abs(dy) + dx) // doubled
    above: cython.double = ((2 * first * abs(dy) + dx) % doubled + 0.5) / doubled
    x: cython.longlong
    y: cython.longlong = y1 + direction * moved
    for x in range(x1 + first, x1 + last + 1):
        if steep:
            surface.point(y, x)
        else:
            surface.point(x, y)
        above += slope
        if above >= 1:
            above -= 1
            y += direction


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def dashed(
    surface: Surface,
    x1: cython.longlong,
    y1: cython.longlong,
    x2: cython.longlong,
    y2: cython.longlong,
    pattern: cython.p_longlong,
    count: cython.Py_ssize_t,
    phase: cython.longlong,
    dda: cython.bint,
) -> cython.void:
    """Of the line those pixels that a dash pattern shows: pixels lit and left out in turn, an even `count` of lengths.

    The pixel at (x1, y1) is number `phase` of the pattern. With no pattern the whole line is drawn.
    """
    k: cython.Py_ssize_t
    period: cython.longlong = 0
    steps: cython.longlong = max(abs(x2 - x1), abs(y2 - y1))
    if count == 0:
        if dda:
            dda_part(surface, x1, y1, x2, y2, 0, WHOLE)
        else:
            bresenham_part(surface, x1, y1, x2, y2, 0, WHOLE)
        return
    for k in range(count):
        period += pattern[k]
    # Steps before the window and behind it, along the longer axis.
    first: cython.longlong = 0
    last: cython.longlong = steps
    if abs(x2 - x1) >= abs(y2 - y1):
        first = max(first, surface.left - x1 if x2 >= x1 else x1 - surface.right)
        last = min(last, surface.right - x1 if x2 >= x1 else x1 - surface.left)
    else:
        first = max(first, surface.top - y1 if y2 >= y1 else y1 - surface.bottom)
        last = min(last, surface.bottom - y1 if y2 >= y1 else y1 - surface.top)
    at: cython.longlong = first - (first + phase) % period
    while at <= last:
        for k in range(0, count, 2):
            if dda:
                dda_part(surface, x1, y1, x2, y2, max(at, 0), at + pattern[k])
            else:
                bresenham_part(surface, x1, y1, x2, y2, max(at, 0), at + pattern[k])
            at += pattern[k] + pattern[k + 1]


@cython.cfunc
def far(surface: Surface, x1: Any, y1: Any, x2: Any, y2: Any, pattern: Any, phase: Any) -> Any:
    """The line between end points at any distance, found column by visible column (row, if steep).

    `pattern` is a list of the lengths of `dashed`, empty for the whole line.
    """
    steep = abs(x2 - x1) < abs(y2 - y1)
    if steep:
        x1, y1, x2, y2 = y1, x1, y2, x2
    backward = x2 < x1
    if backward:
        x1, y1, x2, y2 = x2, y2, x1, y1
    dx = x2 - x1
    dy = y2 - y1
    low, high = (surface.top, surface.bottom) if steep else (surface.left, surface.right)
    limits = (surface.left, surface.right) if steep else (surface.top, surface.bottom)
    first, last = max(x1, low), min(x2, high - 1)
    if first > last:
        return
    ends = [y1 + _moved(x - x1, dx, dy) for x in (first, last)]
    if max(ends) < limits[0] or min(ends) >= limits[1]:
        return
    for x in range(first, last + 1):
        if pattern and not _is_lit(pattern, phase + (x2 - x if backward else x - x1)):
            continue
        y = y1 + _moved(x - x1, dx, dy)
        if limits[0] <= y < limits[1]:
            surface.point(y if steep else x, x if steep else y)


def _moved(steps: Any, dx: Any, dy: Any) -> Any:
    """How many rows further a line is after so many steps."""
    rows = (2 * steps * abs(dy) + dx) // (2 * dx) if dx else 0
    return rows if dy >= 0 else -rows


def _is_lit(pattern: list[Any], step: Any) -> bool:
    """Whether a dash pattern shows its pixel number `step`."""
    step %= sum(pattern)
    for number, length in enumerate(pattern):
        if step < length:
            return number % 2 == 0
        step -= length
    return False
