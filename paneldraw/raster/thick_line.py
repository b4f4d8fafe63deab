"""Thick lines: the filled rectangle around the ideal line.

Coordinates and widths come in 256ths of a pixel. In the line's own frame a point's distance along the line is
u / length and across it v / length, with u = dx X + dy Y and v = dx Y - dy X. A reference point on the rectangle's edge
is inside if the inside lies to its right or, on a horizontal edge, below: rectangles that share an edge share no point.
"""

import cython
from cython.cimports.libc.math import sqrt
from cython.cimports.paneldraw.raster.cone import FILTER_FULL, FILTER_SHIFT, Profile, profile_of
from cython.cimports.paneldraw.raster.coverage import Coverage, counts_before
from cython.cimports.paneldraw.raster.floors import floored
from cython.cimports.paneldraw.raster.paint import inverse_of, meet, paint_eight
from cython.cimports.paneldraw.raster.surface import CLEAR, OVER

if not cython.compiled:
    Bounds, Frame = type("Bounds", (), {}), type("Frame", (), {})


def thick_line(coverage, x1, y1, x2, y2, width, square):
    """The rectangle of `width` around a line, counted; with `square` it reaches half a width beyond the end points.

    A line of no length goes to the right.
    """
    dx: cython.longlong = x2 - x1
    dy: cython.longlong = y2 - y1
    n: cython.longlong = coverage.n
    reach: cython.longlong = n * width if square else 0
    if dy == 0:
        y1 *= 2 * n
        _upright(coverage, 2 * n * min(x1, x2) - reach, y1 - n * width, 2 * n * max(x1, x2) + reach, y1 + n * width)
        return
    if dx == 0:
        x1 *= 2 * n
        _upright(coverage, x1 - n * width, 2 * n * min(y1, y2) - reach, x1 + n * width, 2 * n * max(y1, y2) + reach)
        return
    if dy < 0:
        x1, y1, dx, dy = x2, y2, -dx, -dy
    # Half a width, times the length; rounded down for edges whose points are inside, up for the others.
    squared: cython.ulonglong = cython.cast(cython.ulonglong, dx * dx + dy * dy)
    scale: cython.ulonglong = cython.cast(cython.ulonglong, n * width)
    inside: cython.longlong = _root_of_product(scale, squared)
    root: cython.ulonglong = cython.cast(cython.ulonglong, inside)
    outside: cython.longlong = inside + (root * root != scale * scale * squared)
    # The rows of pixels that the rectangle may touch.
    length: cython.double = sqrt(squared)
    over: cython.double = width * (abs(dx) + (dy if square else 0)) / (512.0 * length)
    top: cython.longlong = max(coverage.surface.top, floored(y1 / 256.0 - over + 0.49))
    bottom: cython.longlong = min(coverage.surface.bottom, floored((y1 + dy) / 256.0 + over + 0.51) + 1)
    if top < bottom and not _swept(coverage, top, bottom, x1, y1, dx, dy, inside, outside, square):
        _exact(coverage, top * n, bottom * n, x1, y1, dx, dy, inside, outside, square)


def _upright(coverage, left, top, right, bottom):
    """An upright rectangle, its sides on the lattice."""
    h: cython.longlong
    ends: cython.longlong[2]
    if not cython.compiled:
        ends = [0, 0]
    ends[0] = (left + coverage.middle + 511) >> 9
    ends[1] = (right + coverage.middle + 511) >> 9
    first: cython.longlong = max((top + coverage.middle + 511) >> 9, coverage.first)
    for h in range(first, min((bottom + coverage.middle + 511) >> 9, coverage.end)):
        coverage.spans(h, ends, 1)


def half_plane(vx, vy, margin, y, bounds, at):
    """Confine ``bounds[at] <= x < bounds[at + 1]`` to the points (x, y) clockwise of a vector, as the screen shows it.

    The cross product of the vector and the point is -margin or more.
    """
    cross: cython.longlong = vx * y + margin
    if vy > 0:
        bounds[at + 1] = min(bounds[at + 1], (cross + vy - 1) // vy if cross > 0 else -(-cross // vy))
    elif vy < 0:
        bounds[at] = max(bounds[at], -(cross // -vy) if cross >= 0 else (-cross - vy - 1) // -vy)
    elif cross < 0 or (cross == 0 and vx < 0):
        bounds[at + 1] = bounds[at]


def _exact(coverage, first, end, x1, y1, dx, dy, inside, outside, square):
    """Each sub-scanline as the definition has it: what four half planes have in common; dy > 0."""
    h: cython.longlong
    ends: cython.longlong[2]
    if not cython.compiled:
        ends = [0, 0]
    n: cython.longlong = coverage.n
    whole: cython.longlong = 2 * n * (dx * dx + dy * dy)
    before: cython.longlong = (inside if dx > 0 else outside) if square else 0
    behind: cython.longlong = (outside if dx > 0 else inside) if square else 0
    x: cython.longlong = 2 * n * x1
    for h in range(first, end):
        y: cython.longlong = 512 * h - coverage.middle - 2 * n * y1
        ends[0] = 512 * coverage.low - coverage.middle - x
        ends[1] = 512 * coverage.high - coverage.middle - x
        half_plane(dx, dy, outside, y, ends, 0)
        half_plane(-dx, -dy, inside, y, ends, 0)
        half_plane(dy, -dx, before, y, ends, 0)
        half_plane(-dy, dx, whole + behind, y, ends, 0)
        ends[0] = (ends[0] + x + coverage.middle + 511) >> 9
        ends[1] = (ends[1] + x + coverage.middle + 511) >> 9
        coverage.spans(h, ends, 1)


# One sub-pixel in the fixed-point numbers of `_sweep`, and where their range ends.
_UNIT = cython.declare(cython.longlong, 1 << 40)
_LARGEST_BOUND = cython.declare(cython.double, 1 << 21)


def _swept(coverage, top, bottom, x1, y1, dx, dy, inside, outside, square):
    """The same in fixed-point numbers, a step a sub-scanline: twice as fast. False, where these are not exact."""
    n: cython.longlong = coverage.n
    at: Bounds
    if not cython.compiled:
        at = Bounds()
    whole: cython.longlong = 2 * n * (dx * dx + dy * dy)
    end_inside: cython.longlong = inside if square else 0
    end_outside: cython.longlong = outside if square else 0
    down: cython.longlong = 512 * n * top - coverage.middle - 2 * n * y1
    offset: cython.longlong = 2 * n * x1 + coverage.middle
    run: cython.longlong = abs(dx)
    lines: cython.longlong = n * (bottom - top)
    side_step: cython.double = dx / cython.cast(cython.double, dy)
    end_step: cython.double = -dy / cython.cast(cython.double, dx)
    left: cython.double = _bound(dx * down - inside, dy, offset)
    right: cython.double = _bound(dx * down + outside, dy, offset)
    back: cython.double
    front: cython.double
    if dx > 0:
        back = _bound(-dy * down - end_inside, run, offset)
        front = _bound(-dy * down + whole + end_outside, run, offset)
    else:
        back = _bound(dy * down - whole - end_inside, run, offset)
        front = _bound(dy * down + end_outside, run, offset)
    # A bound is a fraction. Its distance below the next whole number is a multiple of 1 / divisor: a slack that is more
    # than all errors of rounding and less than half of that leaves its whole part exact.
    slack: cython.longlong = lines + 4096
    if (
        (2 * slack * max(dy, run)) >> 40
        or max(abs(left), abs(right), abs(left + lines * side_step), abs(right + lines * side_step)) > _LARGEST_BOUND
        or max(abs(back), abs(front), abs(back + lines * end_step), abs(front + lines * end_step)) > _LARGEST_BOUND
    ):
        return False
    at.left = floored(left * _UNIT) + slack
    at.right = floored(right * _UNIT) + slack
    at.back = floored(back * _UNIT) + slack
    at.front = floored(front * _UNIT) + slack
    at.side_step = floored(side_step * _UNIT)
    at.end_step = floored(end_step * _UNIT)
    _sweep(coverage, top, bottom, cython.address(at) if cython.compiled else at)
    return True


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _bound(edge: cython.longlong, divisor: cython.longlong, offset: cython.longlong) -> cython.double:
    """A number whose floor is the first sub-pixel at or right of an edge, up to errors of rounding."""
    return (((edge + divisor * offset - 1) >> 9) + divisor) / cython.cast(cython.double, divisor)


def _sweep(coverage, top, bottom, at):
    """Count and paint the rows, given the bounds of their first sub-scanline."""
    one: cython.longlong = 1
    n: cython.int = coverage.n
    low: cython.longlong = (coverage.surface.left * n) * (one << 40)
    high: cython.longlong = (coverage.surface.right * n + 1) * (one << 40)
    # From the first sub-scanline of a row to the last one.
    side_turn: cython.longlong = (n - 1) * at.side_step
    turn: cython.longlong = side_turn - (n - 1) * at.end_step
    before: cython.p_ulonglong = counts_before(n)
    y: cython.longlong
    for y in range(top, bottom):
        # Most rows are cut by the sides alone, visible, and no wider than the eight pixels that are counted at once in
        # the bytes of a number: such a row takes 37 % less time.
        x: cython.longlong = (((at.left + min(0, side_turn)) >> 40) * coverage.n_inverse) >> 32
        if (
            1 < n < 16
            and at.left + min(0, side_turn) >= low
            and at.right + max(0, side_turn) < high
            and ((at.right + max(0, side_turn)) >> 40) - x * n <= 8 * n
            and at.left - at.back >= max(0, -turn)
            and at.front - at.right >= max(0, turn)
        ):
            _eight_pixels(coverage, y, x, at, before)
        else:
            _row(coverage, y, at)


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _eight_pixels(
    coverage: Coverage,
    y: cython.longlong,
    x: cython.longlong,
    at: cython.pointer[Bounds],
    before: cython.p_ulonglong,
) -> cython.void:
    """Count and paint a row that the sides bound within eight pixels from (x, y) on."""
    n: cython.int = coverage.n
    left: cython.longlong = at.left
    right: cython.longlong = at.right
    step: cython.longlong = at.side_step
    first: cython.longlong = x * n
    counts: cython.ulonglong = 0
    _: cython.int
    for _ in range(n):
        counts += before[(right >> 40) - first] - before[(left >> 40) - first]
        left += step
        right += step
    paint_eight(coverage.surface, y, x, counts, coverage.full, coverage.full_inverse)
    at.left = left
    at.right = right
    at.back += n * at.end_step
    at.front += n * at.end_step


def _row(coverage, y, at):
    """Count and paint any row."""
    ends: cython.longlong[32]
    if not cython.compiled:
        ends = [0] * 32
    k: cython.int
    n: cython.int = coverage.n
    for k in range(n):
        ends[2 * k] = max(at.left, at.back) >> 40
        ends[2 * k + 1] = min(at.right, at.front) >> 40
        at.left += at.side_step
        at.right += at.side_step
        at.back += at.end_step
        at.front += at.end_step
    coverage.row_of_spans(y, ends, n)


def _root_of_product(a, b):
    """Largest t with t * t <= a * a * b, for t below 2**56.

    The root in floating point is off by little; the difference of the squares is small enough to survive arithmetic
    modulo 2**64, in which the squares themselves are lost.
    """
    t: cython.ulonglong = cython.cast(cython.ulonglong, floored(a * sqrt(b)))
    while cython.cast(cython.longlong, a * a * b - t * t) < 0:
        t -= 1
    while cython.cast(cython.longlong, a * a * b - (t + 1) * (t + 1)) >= 0:
        t += 1
    return cython.cast(cython.longlong, t)


def filtered_line(coverage, x1, y1, x2, y2, width, square):
    """The same rectangle, filtered: its volume under the filter at each pixel, by four look-ups.

    Away from the ends, where the filter reaches neither, coverage depends on the distance across alone.
    """
    frame: Frame
    if not cython.compiled:
        frame = Frame()
    dx: cython.double = (x2 - x1) / 256.0
    dy: cython.double = (y2 - y1) / 256.0
    length: cython.double = sqrt(dx * dx + dy * dy)
    frame.x = x1 / 256.0
    frame.y = y1 / 256.0
    frame.ux = dx / length if length > 0 else 1
    frame.uy = dy / length if length > 0 else 0
    frame.half = width / 512.0
    frame.before = -frame.half if square else 0
    frame.behind = length - frame.before
    profile: Profile = profile_of(coverage.filter, width / 256.0)
    _filtered_rows(coverage.surface, profile, cython.address(frame) if cython.compiled else frame)


# Entries of a profile a radius; the parts that a distance in entries is known to; farther than anything on a surface.
_ENTRIES = cython.declare(cython.double, 256)
_PART = cython.declare(cython.longlong, 1 << 24)
_FAR = cython.declare(cython.double, 1e9)


def _filtered_rows(surface, profile, frame):
    """Find the rows that the filter touches the rectangle in and, in each, what lies between its sides and its ends."""
    radius: cython.double = profile.filter.radius
    ux: cython.double = frame.ux
    uy: cython.double = frame.uy
    down: cython.double = uy * (frame.behind + frame.before)
    rise: cython.double = abs(ux) * (frame.half + radius) + abs(uy) * (radius - frame.before)
    top: cython.Py_ssize_t = max(surface.top, -floored(rise - frame.y - min(down, 0)))
    bottom: cython.Py_ssize_t = min(surface.bottom, floored(frame.y + max(down, 0) + rise) + 1)
    side_slope: cython.double = ux / uy if uy != 0 else 0
    side: cython.double = abs((frame.half + radius) / uy) if uy != 0 else _FAR
    end_slope: cython.double = -uy / ux if ux != 0 else 0
    back: cython.double = -_FAR
    front: cython.double = _FAR
    if ux != 0:
        back = min((frame.before - radius) / ux, (frame.behind + radius) / ux)
        front = max((frame.before - radius) / ux, (frame.behind + radius) / ux)
    # u and v in fixed-point numbers: entries of the profile, and their parts. Steps of whole numbers add up to the
    # same, wherever a window lets a row begin.
    scale: cython.double = _ENTRIES / radius * _PART
    frame.scale = scale
    frame.along = floored(ux * scale)
    frame.across = floored(uy * scale)
    frame.past_start = floored((frame.before + radius) * scale)
    frame.before_end = floored((frame.behind - radius) * scale)
    origin: cython.longlong = floored(frame.x)
    aside: cython.double = origin - frame.x
    y: cython.Py_ssize_t
    for y in range(top, bottom):
        below: cython.double = y - frame.y
        middle: cython.double = frame.x + side_slope * below
        foot: cython.double = frame.x + end_slope * below
        first: cython.Py_ssize_t = -floored(min(side - middle, -back - foot, -surface.left))
        end: cython.Py_ssize_t = floored(min(middle + side, foot + front, surface.right - 1)) + 1
        u: cython.longlong = floored((ux * aside + uy * below) * scale) + frame.along * (first - origin)
        v: cython.longlong = floored((ux * below - uy * aside) * scale) - frame.across * (first - origin)
        _filtered_row(surface, profile, frame, y * surface.stride + first, end - first, u, v)


def _filtered_row(surface, profile, frame, at, count, u, v):
    """Paint `count` pixels from place `at` on, of which the first is at (u, v) in the line's frame."""
    nearest: cython.longlong = profile.nearest_part
    farthest: cython.longlong = profile.farthest
    profiled: cython.p_int = profile.coverage
    pixels: cython.p_uchar = surface.pixels
    op: cython.int = surface.op
    highest: cython.int = surface.max_level
    level: cython.longlong = surface.level if op != CLEAR else 0
    inverse: cython.longlong = inverse_of(FILTER_FULL)
    mixes: cython.bint = highest > 1 and op in (OVER, CLEAR)
    last: cython.longlong = u + (count - 1) * frame.along
    i: cython.Py_ssize_t
    if mixes and frame.past_start <= min(u, last) and max(u, last) <= frame.before_end:
        # The row is away from both ends, as most are: a line takes a sixteenth fewer instructions.
        for i in range(at, at + count):
            share: cython.longlong = profiled[min(max((abs(v) - nearest) >> 24, 0), farthest)]
            pixels[i] = _mixed(pixels[i], level, share)
            v -= frame.across
        return
    for i in range(at, at + count):
        covered: cython.longlong = profiled[min(max((abs(v) - nearest) >> 24, 0), farthest)]
        if u < frame.past_start or u > frame.before_end:
            covered = _near_end(profile.filter, frame, u / frame.scale, v / frame.scale, covered)
        u += frame.along
        v -= frame.across
        if mixes:
            pixels[i] = _mixed(pixels[i], level, covered)
        elif highest > 1:
            pixels[i] = meet(pixels[i], level, covered, FILTER_FULL, inverse, op, highest)
        elif 2 * covered >= FILTER_FULL:
            pixels[i] = surface.becomes[pixels[i]]


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def _mixed(old: cython.longlong, level: cython.longlong, covered: cython.longlong) -> cython.longlong:
    """As `meet` has it, for a whole that is a power of two: a sixth of a line's time."""
    return old + (((level - old) * covered + FILTER_FULL // 2) >> FILTER_SHIFT)


def _near_end(filter, frame, u, v, away):
    """The coverage of a pixel at (u, v), near an end: what is before the end, less what is before the beginning.

    `away` is what it would be away from both.
    """
    behind: cython.double = frame.behind - u
    before: cython.double = frame.before - u
    volume: cython.double
    if behind < filter.radius:
        volume = filter.strip(behind, -frame.half - v, frame.half - v)
    else:
        volume = away / cython.cast(cython.double, FILTER_FULL)
    if before > -filter.radius:
        volume -= filter.strip(before, -frame.half - v, frame.half - v)
    return floored(volume * FILTER_FULL + 0.5)
