"""Bézier curves, smooth curves through points, and ellipses at any angle: how they become paths, and thin ones pixels.

A curve is a chain of cubic pieces, each of four control points. Halved until it is flat, a piece becomes chords within
a quarter of a 256th of a pixel. Control points are in 256ths of a pixel, within +-2**26.
"""

import cython
from cython.cimports.libc.math import acos, ceil, cos, sin, sqrt
from cython.cimports.paneldraw.raster.floors import floored
from cython.cimports.paneldraw.raster.paint import once, painted
from cython.cimports.paneldraw.raster.stroke import doubles
from cython.cimports.paneldraw.raster.surface import Surface

# A piece with second differences of d is 3/4 d from its chord at most: so large they may be, squared, for a quarter.
_FLAT = cython.declare(cython.double, 1.0 / 9.0)

# Halved so often, any piece is flat.
_DEEPEST = cython.declare(cython.int, 24)

_PI = cython.declare(cython.double, 3.141592653589793)


def chain(values, count):
    """The control points of pieces that are given by theirs: a quadratic one by 3 points, n cubic ones by 3 n + 1.

    Returns them as doubles in a bytearray. The last point of a piece is the first one of the next.
    """
    i: cython.Py_ssize_t
    quadratic: cython.bint = count == 3
    memory = bytearray(16 * (4 if quadratic else count))
    to: cython.p_double = doubles(memory, 0)
    if not quadratic:
        for i in range(2 * count):
            to[i] = values[i]
        return memory
    for i in range(2):
        to[i] = values[i]
        to[2 + i] = (values[i] + 2.0 * values[2 + i]) / 3
        to[4 + i] = (values[4 + i] + 2.0 * values[2 + i]) / 3
        to[6 + i] = values[4 + i]
    return memory


def through(points, count, closed):
    """The control points of the smooth curve through `count` points, no two neighbors of which are equal, as `chain`.

    It is Catmull and Rom's with centripetal knots: the root of the distance of two points lies between theirs. Before
    the first point and behind the last one of an open curve, the next to it is mirrored. A closed one has three points
    or more.
    """
    i: cython.Py_ssize_t
    k: cython.Py_ssize_t
    pieces: cython.Py_ssize_t = count if closed else count - 1
    memory = bytearray(16 * (3 * pieces + 1))
    to: cython.p_double = doubles(memory, 0)
    for i in range(pieces):
        for k in range(2):
            a: cython.double = points[2 * i + k]
            b: cython.double = points[2 * ((i + 1) % count) + k]
            before: cython.double = 2 * a - b
            behind: cython.double = 2 * b - a
            if i > 0 or closed:
                before = points[2 * ((i + count - 1) % count) + k]
            if i < count - 2 or closed:
                behind = points[2 * ((i + 2) % count) + k]
            d: cython.double = _knots(points, count, i)
            to[6 * i + k] = a
            to[6 * i + 2 + k] = _handle(before, a, b, d if not closed and i == 0 else _knots(points, count, i - 1), d)
            last: cython.bint = not closed and i == count - 2
            to[6 * i + 4 + k] = _handle(behind, b, a, d if last else _knots(points, count, i + 1), d)
            to[6 * i + 6 + k] = b
    return memory


@cython.cfunc
@cython.exceptval(check=False)
def _knots(points: cython.p_double, count: cython.Py_ssize_t, i: cython.Py_ssize_t) -> cython.double:
    """How far the knots of point i and of the next one are apart."""
    a: cython.Py_ssize_t = 2 * ((i + count) % count)
    b: cython.Py_ssize_t = 2 * ((i + 1 + count) % count)
    return sqrt(sqrt((points[b] - points[a]) ** 2 + (points[b + 1] - points[a + 1]) ** 2))


@cython.cfunc
@cython.exceptval(check=False)
def _handle(
    before: cython.double, at: cython.double, to: cython.double, d1: cython.double, d2: cython.double
) -> cython.double:
    """The control point next to `at` toward `to`, where the knots on either side are d1 and d2 away."""
    return (d1 * d1 * to - d2 * d2 * before + (2 * d1 * d1 + 3 * d1 * d2 + d2 * d2) * at) / (3 * d1 * (d1 + d2))


@cython.final
@cython.cclass
class Path:
    """A list of points that grows, as strokes are drawn along it. What is far from a square is one chord.

    The square goes from `low` to `high` both ways; with ``low > high`` nothing is left out. For the seamless pieces of
    a stroke the points are `whole` 256ths.
    """

    def __init__(self, low, high, whole):
        self.whole = whole
        self.memory = bytearray()
        self.capacity = 0
        self.count = 0
        self.low = low
        self.high = high
        if not cython.compiled:
            self.points = [0.0, 0.0]

    def add(self, x, y):
        """Add a point, unless it is the last one again. Behind it there is room for another."""
        last: cython.Py_ssize_t = 2 * self.count - 2
        if self.whole:
            x, y = floored(x + 0.5), floored(y + 0.5)
        if self.count > 0 and self.points[last] == x and self.points[last + 1] == y:
            return
        if cython.compiled:
            if self.count + 2 > self.capacity:
                self.capacity = 2 * self.capacity + 64
                self.memory.extend(bytes(16 * self.capacity - len(self.memory)))
                self.points = doubles(self.memory, 0)
            self.points[last + 2] = x
            self.points[last + 3] = y
        else:
            self.points[last + 2 :] = [x, y, 0.0, 0.0]
        self.count += 1

    def ends_where_it_begins(self):
        last: cython.Py_ssize_t = 2 * self.count - 2
        return self.points[0] == self.points[last] and self.points[1] == self.points[last + 1]

    def pieces(self, controls, count):
        """Add `count` pieces of a chain."""
        k: cython.Py_ssize_t
        for k in range(count):
            self.piece(controls, 6 * k)

    def piece(self, controls, first):
        """Add the piece whose control points begin at number `first`: the chords from its first one to its last."""
        i: cython.int
        parts: cython.double[200]
        if not cython.compiled:
            parts = [0.0] * 200
        for i in range(8):
            parts[i] = controls[first + i]
        self.add(parts[0], parts[1])
        # What is left to add, the next part of it last.
        at: cython.int = 0
        while at >= 0:
            if at == 8 * _DEEPEST or self._is_unseen(parts, at) or _is_flat(parts, at):
                self.add(parts[at + 6], parts[at + 7])
                at -= 8
            else:
                _halve(parts, at)
                at += 8

    def _is_unseen(self, q, at):
        """Whether a part lies all on one side of the square."""
        k: cython.int
        if self.low > self.high:
            return False
        for k in range(at, at + 2):
            if max(max(q[k], q[k + 2]), max(q[k + 4], q[k + 6])) < self.low:
                return True
            if min(min(q[k], q[k + 2]), min(q[k + 4], q[k + 6])) > self.high:
                return True
        return False

    def ellipse(self, x, y, a, b, angle, start, swept):
        """Add the ellipse with the radii `a` and `b`, turned by an angle, from one of its own angles on; in degrees.

        Of the whole of it the last point is not the first one again.
        """
        i: cython.int
        steps: cython.int = 4
        turn: cython.double = swept * (_PI / 180)
        radius: cython.double = max(a, b)
        if radius > 1:
            steps = max(int(ceil(abs(turn) / (2 * acos(1 - 0.25 / radius)))), 4)
        ux: cython.double = cos(angle * (_PI / 180))
        uy: cython.double = sin(angle * (_PI / 180))
        for i in range(steps if swept >= 360 else steps + 1):
            t: cython.double = start * (_PI / 180) + turn * i / steps
            dx: cython.double = a * cos(t)
            dy: cython.double = b * sin(t)
            self.add(x + dx * ux - dy * uy, y + dx * uy + dy * ux)


@cython.cfunc
@cython.exceptval(check=False)
def _is_flat(q: cython.p_double, at: cython.int) -> cython.bint:
    """Whether a part is within a quarter of a 256th of its chord."""
    i: cython.int
    for i in range(at, at + 4, 2):
        dx: cython.double = q[i] - 2 * q[i + 2] + q[i + 4]
        dy: cython.double = q[i + 1] - 2 * q[i + 3] + q[i + 5]
        if dx * dx + dy * dy > _FLAT:
            return False
    return True


@cython.cfunc
@cython.exceptval(check=False)
def _halve(q: cython.p_double, at: cython.int) -> cython.void:
    """Put the first half of a part behind the second, in its place: de Casteljau's midpoints."""
    k: cython.int
    for k in range(at, at + 2):
        a: cython.double = (q[k] + q[k + 2]) / 2
        b: cython.double = (q[k + 2] + q[k + 4]) / 2
        c: cython.double = (q[k + 4] + q[k + 6]) / 2
        q[k + 8] = q[k]
        q[k + 10] = a
        q[k + 12] = (a + b) / 2
        q[k + 14] = ((a + b) / 2 + (b + c) / 2) / 2
        q[k] = q[k + 14]
        q[k + 2] = (b + c) / 2
        q[k + 4] = c


# -- Thin curves


@cython.final
@cython.cclass
class Walk:
    """Paints paths of width 1, pixel by pixel, and those pixels only that a dash pattern shows.

    Where a path is nearer to the horizontal, it has in each column the pixel nearest to it, else in each row. Where the
    one follows the other, a gap is closed, and a corner between two pixels that touch is left out. The pixels nearest
    to its ends are always painted.
    """

    def __init__(self, surface: Surface, dash):
        self.surface = surface
        self.dash = dash
        self.period = sum(dash) if dash else 0
        self.number = 0
        self.held = 0
        self.x = self.y = 0

    def along(self, path):
        """Walk along a path, on from where the last one ended or from a new place."""
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t = path.count
        p: cython.p_double = path.points
        self.step(_nearest(p[0]), _nearest(p[1]))
        self.kept = True
        for i in range(0, 2 * count - 2, 2):
            if self.period > 0 or self._is_near(p[i], p[i + 1], p[i + 2], p[i + 3]):
                self._chord(p[i], p[i + 1], p[i + 2], p[i + 3])
            else:
                self.end()
        self.step(_nearest(p[2 * count - 2]), _nearest(p[2 * count - 1]))
        self.kept = True

    def end(self):
        """Paint the pixel that waits to be known as no corner."""
        if self.held > 0:
            self._paint(self.x, self.y)
        self.held = 0

    def step(self, x, y):
        """Go on to a pixel."""
        k: cython.longlong
        if self.held > 0:
            dx: cython.longlong = x - self.x
            dy: cython.longlong = y - self.y
            if dx == 0 and dy == 0:
                return
            gap: cython.longlong = max(abs(dx), abs(dy))
            from_x: cython.longlong = self.x
            from_y: cython.longlong = self.y
            for k in range(1, gap):
                self._go(from_x + floored(1.0 * k * dx / gap + 0.5), from_y + floored(1.0 * k * dy / gap + 0.5))
        self._go(x, y)

    def _go(self, x, y):
        """Go on to a neighbor of the last pixel, which is left out if it is a corner."""
        corner: cython.bint = self.held > 1 and not self.kept
        corner = corner and abs(x - self.before_x) == 1 and abs(y - self.before_y) == 1
        if not (corner and abs(x - self.x) + abs(y - self.y) == 1):
            if self.held > 0:
                self._paint(self.x, self.y)
            self.before_x, self.before_y = self.x, self.y
            self.held = min(self.held + 1, 2)
        self.x, self.y = x, y
        self.kept = False

    def _paint(self, x, y):
        """Paint the next pixel, if the pattern shows it."""
        left: cython.longlong
        if self.period == 0:
            self.surface.point(x, y)
            return
        left = self.number % self.period
        self.number += 1
        for i, length in enumerate(self.dash):
            left -= length
            if left < 0:
                if i % 2 == 0:
                    self.surface.point(x, y)
                return

    def _is_near(self, x1, y1, x2, y2):
        """Whether a chord comes within two pixels of the window."""
        return (
            max(x1, x2) >= 256 * (self.surface.left - 2)
            and min(x1, x2) <= 256 * (self.surface.right + 2)
            and max(y1, y2) >= 256 * (self.surface.top - 2)
            and min(y1, y2) <= 256 * (self.surface.bottom + 2)
        )

    def _chord(self, x1, y1, x2, y2):
        """Step through the columns or the rows whose middle a chord crosses or starts from."""
        at: cython.longlong
        steep: cython.bint = abs(x2 - x1) < abs(y2 - y1)
        if steep:
            x1, y1, x2, y2 = y1, x1, y2, x2
        if x1 == x2:
            return
        slope: cython.double = (y2 - y1) / (x2 - x1)
        way: cython.int = 1 if x2 > x1 else -1
        at = -floored(-way * x1 / 256)
        end: cython.longlong = -floored(-way * x2 / 256)
        while at < end:
            across: cython.longlong = _nearest(y1 + (256.0 * way * at - x1) * slope)
            if steep:
                self.step(across, way * at)
            else:
                self.step(way * at, across)
            at += 1


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _nearest(place: cython.double) -> cython.longlong:
    """The nearest pixel, halves upward."""
    return floored((place + 128) / 256)


def walk(surface, path, controls, closed, dash):
    """Paint a chain of pieces that are one pixel wide, by way of a path; or the path itself. Each pixel once."""
    k: cython.Py_ssize_t
    marks: Surface = once(surface)
    walker: Walk = Walk(marks, dash)
    if controls is None:
        walker.along(path)
    else:
        p: cython.p_double = doubles(controls, 0)
        last: cython.Py_ssize_t = len(controls) // 8 - 2
        for k in range(0, last, 6):
            path.count = 0
            path.piece(p, k)
            walker.along(path)
        if closed and (p[0] != p[last] or p[1] != p[last + 1]):
            path.count = 0
            path.add(p[last], p[last + 1])
            path.add(p[0], p[1])
            walker.along(path)
    walker.end()
    painted(surface, marks, surface.top, surface.bottom)
