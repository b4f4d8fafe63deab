"""Strokes: the contours of a thick path, with its joins, caps and dashes.

A stroke is the union of simple pieces, a rectangle for each segment and a wedge for each join, all wound the same way;
the non-zero rule makes one shape of them. Lengths are in 256ths of a pixel, to which the pieces' corners are rounded.
"""

import cython
from cython.cimports.libc.math import acos, atan2, ceil, cos, floor, rint, sin, sqrt

from paneldraw.raster.clip import LIMIT, MARGIN, cut_polygon

#: The numbers by which `Stroke` knows a cap and a join.
CAPS = {"butt": 0, "square": 1, "round": 2}
JOINS = {"miter": 0, "round": 1, "bevel": 2}

_BUTT = cython.declare(cython.int, 0)
_SQUARE = cython.declare(cython.int, 1)
_ROUND = cython.declare(cython.int, 2)
_LIMIT = cython.declare(cython.double, LIMIT)
_PI = cython.declare(cython.double, 3.141592653589793)

# How far an arc may be from its chords, and how far round caps may be from closing a gap.
_FLAT = cython.declare(cython.double, 0.25)

# Added and taken away again, it leaves a number rounded to whole 65536ths, to the even ones if it is halfway.
_ROUNDING = cython.declare(cython.double, 1.5 * (1 << 36))

# Longer than any path.
_ENDLESS = cython.declare(cython.double, 1e30)


@cython.final
@cython.cclass
class Contours:
    """A list of closed contours that grows, as `polygon` fills it. What lies far away is cut off as they are closed."""

    def __init__(self):
        self.memory = bytearray()
        self.ends_memory = bytearray()
        self.capacity = 0
        self.ends_capacity = 0
        self.begin()

    def begin(self):
        """Begin a new list, in the memory of the one before."""
        self.count = 0
        self.contours = 0
        self.far = False
        if not cython.compiled:
            self.points = []
            self.ends = []

    def add(self, x, y, dx, dy):
        """Add the point (x + dx, y + dy) to the open contour, rounded to whole 256ths.

        Halves go to the even number: two points that lie symmetrically about a whole one still do so afterwards, and
        the edge between them runs through it, where other pieces meet this one. The vector is rounded first, so that
        sums are exact and a shape that is moved by whole pixels stays the same.
        """
        x += _rounded(dx)
        y += _rounded(dy)
        if abs(x) > _LIMIT or abs(y) > _LIMIT:
            self.far = True
        if cython.compiled:
            if self.count == self.capacity:
                self.capacity = 2 * self.capacity + 64
                self.memory.extend(bytes(16 * self.capacity - len(self.memory)))
                self.points = cython.cast(cython.p_longlong, _address(self.memory))
            self.points[2 * self.count] = cython.cast(cython.longlong, rint(x))
            self.points[2 * self.count + 1] = cython.cast(cython.longlong, rint(y))
        else:
            self.points += [round(x), round(y)]
        self.count += 1

    def close(self):
        """Close the open contour, turned clockwise as the screen shows it."""
        i: cython.Py_ssize_t
        start: cython.Py_ssize_t = self.ends[self.contours - 1] if self.contours else 0
        if self.far:
            corners = [self.points[i] for i in range(2 * start, 2 * self.count)]
            self.count = start
            self.far = False
            if not cython.compiled:
                del self.points[2 * start :]
            corners = cut_polygon(corners)
            for i in range(0, len(corners), 2):
                self.add(corners[i], corners[i + 1], 0, 0)
        j: cython.Py_ssize_t = self.count - 1
        area: cython.longlong = 0
        points: cython.p_longlong = self.points
        for i in range(start, self.count):
            area += points[2 * j] * points[2 * i + 1] - points[2 * i] * points[2 * j + 1]
            j = i
        if area < 0:
            i, j = start, self.count - 1
            while i < j:
                points[2 * i], points[2 * j] = points[2 * j], points[2 * i]
                points[2 * i + 1], points[2 * j + 1] = points[2 * j + 1], points[2 * i + 1]
                i += 1
                j -= 1
        if cython.compiled:
            if self.contours == self.ends_capacity:
                self.ends_capacity = 2 * self.ends_capacity + 16
                size: cython.Py_ssize_t = self.ends_capacity * cython.sizeof(cython.Py_ssize_t)
                self.ends_memory.extend(bytes(size - len(self.ends_memory)))
                self.ends = cython.cast(cython.p_Py_ssize_t, _address(self.ends_memory))
            self.ends[self.contours] = self.count
        else:
            self.ends.append(self.count)
        self.contours += 1


@cython.final
@cython.cclass
class Stroke:
    """Adds the pieces of strokes of one width and join to contours, exact in a square of `pixels` from (0, 0) on.

    Arcs of a circle, which is given by its center and radius, end along its radii; other paths end square.
    """

    def __init__(self, contours: Contours, width, join, pixels, circle):
        self.contours = contours
        self.half = width / 2
        self.join = join
        self.x = self.y = self.radius = 0.0
        if circle is not None:
            self.x, self.y, self.radius = circle
        # Beyond the center radii have crossed each other.
        self.around = circle is not None and self.half <= self.radius
        self.low = -MARGIN
        self.high = 256 * pixels + MARGIN

    def path(self, points, count, closed, cap, end_cap):
        """Add the stroke along `count` points (x, y), no two neighbors of which are equal.

        A single point is a line of no length to the right. A closed path has three points or more, and no caps.
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        segments: cython.Py_ssize_t = count if closed else count - 1
        # The unit vectors along the present segment and the one before it.
        ux: cython.double = 1
        uy: cython.double = 0
        if count == 1:
            self._cap(points[0], points[1], -1, 0, cap)
            self._cap(points[0], points[1], 1, 0, end_cap)
            return
        first: cython.Py_ssize_t = 0
        for i in range(segments + closed):
            j = (i + 1) % count
            vx: cython.double = ux
            vy: cython.double = uy
            ux, uy = _unit_vector(points, i % count, j)
            if i > 0 and (i == segments or not self._is_smooth(points, i, j, vx * ux + vy * uy, vx * uy - vy * ux)):
                self._corner(points[2 * (i % count)], points[2 * (i % count) + 1], vx, vy, ux, uy)
                self._outline(points, count, first, i)
                first = i
            if i < segments and not closed and i == 0:
                start: tuple[cython.double, cython.double] = self._direction(points[0], points[1], ux, uy)
                self._cap(points[0], points[1], -start[0], -start[1], cap)
        if not closed:
            self._outline(points, count, first, segments)
            x: cython.double = points[2 * segments]
            y: cython.double = points[2 * segments + 1]
            end: tuple[cython.double, cython.double] = self._direction(x, y, ux, uy)
            self._cap(x, y, end[0], end[1], end_cap)

    def _is_smooth(self, points, i, j, dot, cross):
        """Whether the segments before and behind point i, that to point j, bend so little that they have one outline.

        Then all joins are within a quarter of a 256th of each other, and the inner sides meet within both segments.
        """
        if self.around:
            return True
        if dot <= 0:
            return False
        # The tangent of half the angle.
        bend: cython.double = abs(cross) / (1 + dot)
        shorter: cython.double = min(_length(points, i - 1, i), _length(points, i, j))
        return self.half * bend * bend <= _FLAT and 2 * self.half * bend <= shorter

    def _outline(self, points, count, first, last):
        """Add what is around the segments from point `first` to point `last` of a path, which is smooth between.

        One shape for all of a curve, and not a rectangle for every chord: 2.4 times as fast, 7 times if filtered.
        """
        i: cython.Py_ssize_t
        for i in range(first, last + 1):
            dx, dy = self._aside(points, count, i, first, last)
            self.contours.add(points[2 * (i % count)], points[2 * (i % count) + 1], dx, dy)
        for i in range(last, first - 1, -1):
            dx, dy = self._aside(points, count, i, first, last)
            self.contours.add(points[2 * (i % count)], points[2 * (i % count) + 1], -dx, -dy)
        self.contours.close()

    def _aside(self, points, count, i, first, last):
        """From point i of an outline to its left side: square to its ends, halfway between its segments elsewhere."""
        at: cython.Py_ssize_t = i % count
        half: cython.double = self.half
        ux, uy = _unit_vector(points, at, (i + 1) % count) if i < last else _unit_vector(points, (i - 1) % count, at)
        if self.around:
            ux, uy = self._direction(points[2 * at], points[2 * at + 1], ux, uy)
        elif first < i < last:
            vx, vy = _unit_vector(points, (i - 1) % count, at)
            half /= 1 + vx * ux + vy * uy
            ux, uy = ux + vx, uy + vy
        return uy * half, -ux * half

    def _direction(self, x, y, ux, uy):
        """The direction of a path at a point of a segment: that of the segment, or along the circle there."""
        return ((self.y - y) / self.radius, (x - self.x) / self.radius) if self.around else (ux, uy)

    def _segment(self, x1, y1, x2, y2, start, end):
        """Add what is around a segment between its ends, which lie square to the directions `start` and `end`."""
        half: cython.double = self.half
        self.contours.add(x1, y1, -start[1] * half, start[0] * half)
        self.contours.add(x1, y1, start[1] * half, -start[0] * half)
        self.contours.add(x2, y2, end[1] * half, -end[0] * half)
        self.contours.add(x2, y2, -end[1] * half, end[0] * half)
        self.contours.close()

    def _cap(self, x, y, ux, uy, cap):
        """Add what a cap adds beyond an end point, in the direction (ux, uy)."""
        half: cython.double = self.half
        if cap == _SQUARE:
            self._segment(x, y, x + _rounded(ux * half), y + _rounded(uy * half), (ux, uy), (ux, uy))
        elif cap == _ROUND:
            self._arc(x, y, uy * half, -ux * half, -uy * half, ux * half, _PI)

    def _corner(self, x, y, vx, vy, ux, uy):
        """Fill the wedge on the outer side of a corner, where direction v turns into direction u."""
        cross: cython.double = vx * uy - vy * ux
        dot: cython.double = vx * ux + vy * uy
        outer: cython.double = self.half if cross > 0 else -self.half
        contours: Contours = self.contours
        if self.around or (cross == 0 and dot > 0):
            return
        vx, vy, ux, uy = vx * outer, vy * outer, ux * outer, uy * outer
        contours.add(x, y, 0, 0)
        if self.join == 1:
            if cross > 0:
                self._arc(x, y, vy, -vx, uy, -ux, atan2(abs(cross), dot))
            else:
                self._arc(x, y, uy, -ux, vy, -vx, atan2(abs(cross), dot))
            return
        contours.add(x, y, vy, -vx)
        # The miter is 1 / cos(angle / 2) half widths long; up to 4 of them it is drawn.
        if self.join == 0 and 8 * (1 + dot) >= 1:
            contours.add(x, y, (vy + uy) / (1 + dot), -(vx + ux) / (1 + dot))
        contours.add(x, y, uy, -ux)
        contours.close()

    def _arc(self, x, y, dx, dy, ex, ey, angle):
        """End a contour with the arc around (x, y) from (x + dx, y + dy) clockwise to (x + ex, y + ey).

        It is within a quarter of a 256th where it can be seen.
        """
        i: cython.longlong = 0
        jump: cython.longlong
        steps: cython.longlong = 1
        radius: cython.double = sqrt(dx * dx + dy * dy)
        contours: Contours = self.contours
        if radius > 2 * _FLAT:
            steps = int(ceil(angle / (2 * acos(max(0.5, 1 - _FLAT / radius)))))
        while i < steps:
            px, py = _turned(dx, dy, angle * i / steps)
            contours.add(x, y, px, py)
            px, py = x + px, y + py
            jump = 1
            # What cannot be seen is left out, by steps that are as large as it is.
            while not self._is_seen(px, px, py, py, 0) and i % (2 * jump) == 0 and i + 2 * jump <= steps:
                qx, qy = _turned(dx, dy, angle * (i + 2 * jump) / steps)
                qx, qy = x + qx, y + qy
                rise: cython.double = radius * (1 - cos(angle * jump / steps))
                if self._is_seen(min(px, qx), max(px, qx), min(py, qy), max(py, qy), rise):
                    break
                jump *= 2
            i += jump
        contours.add(x, y, ex, ey)
        contours.close()

    def _is_seen(self, left, right, top, bottom, margin):
        """Whether a box, and so much around it, meets the square that can be seen."""
        return (
            right + margin >= self.low
            and left - margin <= self.high
            and bottom + margin >= self.low
            and top - margin <= self.high
        )

    def _next_seen(self, view, start, cap):
        """Move on to the first segment of which something can be seen from a distance along the path on.

        Returns from which distance that is; where nothing more can be seen, how long the path is.
        """
        while True:
            low, high = self._seen(view.points, view.count, view.i, cap)
            if low <= high and view.passed + high > start:
                return view.passed + low
            if view.i >= view.count - 2:
                return view.ahead
            view.move()

    def _seen(self, points, count, i, cap):
        """Between which distances from point i the dashes of its segment can be seen, and caps that end them.

        With the corner at its end, if its join can be seen. If nothing can, the first distance is the larger one.
        """
        length: cython.double = _length(points, i, i + 1)
        ux, uy = _unit_vector(points, i, i + 1)
        x: cython.double = (self.low + self.high) / 2 - points[2 * i]
        y: cython.double = (self.low + self.high) / 2 - points[2 * i + 1]
        reach: cython.double = (self.high - self.low) / 2 * (abs(ux) + abs(uy))
        aside: cython.double = max(abs(x * uy - y * ux) - reach, 0)
        first: cython.double = length
        last: cython.double = -1
        if aside <= self.half:
            if cap == _ROUND:
                reach += sqrt(self.half**2 - aside**2)
            first = max(x * ux + y * uy - reach, 0)
            last = min(x * ux + y * uy + reach, length)
        if i < count - 2 and self._is_corner_seen(points, i + 1, ux, uy):
            return min(first, length), length
        return first, last

    def _is_corner_seen(self, points, i, ux, uy):
        """Whether something can be seen of the join at point i, where direction u ends."""
        vx, vy = _unit_vector(points, i, i + 1)
        dot: cython.double = ux * vx + uy * vy
        reach: cython.double = self.half
        if self.join == 0 and 8 * (1 + dot) >= 1:
            reach *= sqrt(2 / (1 + dot))
        return self._is_seen(points[2 * i], points[2 * i], points[2 * i + 1], points[2 * i + 1], reach)

    def _covers_all(self, x, y):
        """Whether all that can be seen is in a disc around a point."""
        middle: cython.double = (self.low + self.high) / 2
        farthest: cython.double = self.half - (self.high - self.low) * 0.75
        return farthest > 0 and (x - middle) ** 2 + (y - middle) ** 2 < farthest**2

    def dashes(self, points, count, closed, cap, dash, distance):
        """Add the strokes of the pieces of a path that a dash pattern shows, back to its first point if it is closed.

        The pattern, alternately a length that is drawn and one that is left out, goes on around corners; the path
        begins at `distance` within it. A round cap ends every piece, a square one the path. Pieces that cannot
        be seen are left out.
        """
        whole: cython.double = _whole_length(points, count) + distance
        dash = self._without_closed_gaps(dash, cap, whole)
        way: Way = Way()
        way.begin(points, count)
        view: Way = Way()
        view.begin(points, count)
        inner: cython.int = _ROUND if cap == _ROUND else _BUTT
        first_cap: cython.int = cap if distance == 0 else inner
        last_cap: cython.int = cap
        if closed and distance == 0 and _last_end(whole, dash) >= whole:
            # The last piece goes on into the first one.
            self._first_corner(points, count)
            first_cap = last_cap = _BUTT
        stops: list = [0.0, *_running_sum(dash)]
        period: cython.double = sum(dash)
        pairs: cython.longlong = len(dash) // 2
        number: cython.longlong = 0
        while True:
            k: cython.longlong = 2 * (number % pairs)
            before: cython.double = cython.cast(cython.double, number // pairs) * period - distance
            start: cython.double = before + cython.cast(cython.double, stops[k])
            end: cython.double = before + cython.cast(cython.double, stops[k + 1])
            number += 1
            if end <= 0:
                continue
            skip: cython.double = self._next_seen(view, start, cap)
            if start > 0 and end < skip:
                if number % pairs == 0:
                    # Fewer periods by one, so that no piece that reaches into view is lost.
                    number += pairs * cython.cast(cython.longlong, max(floor((skip - end) / period) - 1, 0))
                continue
            if not way.reach(start):
                return
            count = way.piece(max(start, 0), end)
            if cap == _ROUND and self._covers_all(way.cut[0], way.cut[1]):
                self.path(way.cut, 1, False, cap, cap)
                return
            if count > 1:
                self.path(way.cut, count, False, first_cap if start <= 0 else inner, last_cap if way.ended else inner)

    def _without_closed_gaps(self, dash, cap, whole):
        """The same dash pattern, or one long dash if round caps close every gap of a path as long as `whole`."""
        if cap == _ROUND and max(dash[1::2]) ** 2 < 8 * _FLAT * self.half:
            return [_last_end(whole, dash), _ENDLESS]
        return dash

    def _first_corner(self, points, count):
        """Join the end of a closed path to its beginning."""
        vx, vy = _unit_vector(points, count - 2, count - 1)
        ux, uy = _unit_vector(points, 0, 1)
        self._corner(points[0], points[1], vx, vy, ux, uy)


@cython.final
@cython.cclass
class Way:
    """A place that moves on along a path: on the segment from point i on, from `passed` to `ahead` along the path.

    `cut` is the last piece that was cut out, and `ended` whether the path ended with it.
    """

    def begin(self, points, count):
        """Begin at the first point of a path."""
        self.points = points
        self.count = count
        self.i = 0
        self.passed = 0
        self.ahead = _length(points, 0, 1)
        self.memory = bytearray(16 * (count + 2))
        self.cut = doubles(self.memory, 0)

    def reach(self, distance):
        """Move on to the segment that holds a distance; return whether the path is as long."""
        while distance >= self.ahead and self.i < self.count - 2:
            self.move()
        return distance < self.ahead

    def move(self):
        """Move on to the next segment."""
        self.i += 1
        self.passed = self.ahead
        self.ahead += _length(self.points, self.i, self.i + 1)

    def piece(self, start, end):
        """Cut out the piece from `start`, on the present segment, to `end`; return how many points it has."""
        k: cython.Py_ssize_t = 1
        cut: cython.p_double = self.cut
        _at(self.points, self.i, start - self.passed, cut)
        while end > self.ahead and self.i < self.count - 2:
            self.move()
            cut[2 * k] = self.points[2 * self.i]
            cut[2 * k + 1] = self.points[2 * self.i + 1]
            k += 1
        _at(self.points, self.i, min(end, self.ahead) - self.passed, doubles(self.memory, 2 * k))
        self.ended = self.i == self.count - 2 and end >= self.ahead
        # Where the piece ends at a corner, it may stand there twice.
        return k + (cut[2 * k] != cut[2 * k - 2] or cut[2 * k + 1] != cut[2 * k - 1])


def doubles(memory, first):
    """The numbers that lie in a bytearray, from one on."""
    if cython.compiled:
        return cython.cast(cython.p_double, _address(memory)) + first
    return memoryview(memory).cast("d")[first:]


def distinct(values, count, points):
    """Write points (x, y) as floating-point numbers, those that repeat the one before once; return how many."""
    i: cython.Py_ssize_t
    number: cython.Py_ssize_t = 0
    for i in range(count):
        points[2 * number] = values[2 * i]
        points[2 * number + 1] = values[2 * i + 1]
        if number == 0 or values[2 * i] != values[2 * i - 2] or values[2 * i + 1] != values[2 * i - 1]:
            number += 1
    return number


def is_endless(points, count, closed, dash):
    """Whether a dash is as long as a whole path, to which it then does nothing."""
    whole: cython.double = _whole_length(points, count)
    if closed:
        whole += _length(points, count - 1, 0)
    return dash >= whole


def arc_path(x, y, radius, start, swept):
    """Points along a circle, as many doubles in a bytearray; lengths in 256ths, angles in degrees.

    Its chords are within a quarter of a 256th of it. The last point of a whole circle is not its first one; behind the
    points there is room for another.
    """
    i: cython.int
    turn: cython.double = swept * (_PI / 180)
    steps: cython.int = 1
    if radius > 0:
        steps = max(int(ceil(turn / (2 * acos(max(0.5, 1 - 0.25 / radius))))), 1)
    count: cython.int = steps if swept >= 360 else steps + 1
    memory = bytearray(16 * (count + 1))
    points: cython.p_double = doubles(memory, 0)
    for i in range(count):
        angle: cython.double = start * (_PI / 180) + turn * i / steps
        points[2 * i] = x + _rounded(radius * cos(angle))
        points[2 * i + 1] = y + _rounded(radius * sin(angle))
    return memory


def _length(points, i, j):
    """How far it is from point i to point j."""
    return sqrt((points[2 * j] - points[2 * i]) ** 2 + (points[2 * j + 1] - points[2 * i + 1]) ** 2)


@cython.cfunc
@cython.inline
def _unit_vector(
    points: cython.p_double, i: cython.Py_ssize_t, j: cython.Py_ssize_t
) -> tuple[cython.double, cython.double]:
    """The direction from point i to point j."""
    length: cython.double = _length(points, i, j)
    return (points[2 * j] - points[2 * i]) / length, (points[2 * j + 1] - points[2 * i + 1]) / length


@cython.cfunc
def _whole_length(points: cython.p_double, count: cython.Py_ssize_t) -> cython.double:
    """How far it is from the first point to the last."""
    i: cython.Py_ssize_t
    whole: cython.double = 0
    for i in range(count - 1):
        whole += _length(points, i, i + 1)
    return whole


@cython.cfunc
def _last_end(length: cython.double, dash: list) -> cython.double:
    """Where the last dash ends that a pattern shows within a length."""
    passed: cython.double = max(ceil(length / sum(dash)) - 1, 0) * sum(dash)
    last: cython.double = passed
    for shown, left_out in zip(dash[::2], dash[1::2], strict=True):
        if passed < length:
            last = min(passed + shown, length)
        passed += shown + left_out
    return last


@cython.cfunc
@cython.inline
def _turned(dx: cython.double, dy: cython.double, angle: cython.double) -> tuple[cython.double, cython.double]:
    """A vector turned clockwise."""
    return dx * cos(angle) - dy * sin(angle), dx * sin(angle) + dy * cos(angle)


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _rounded(length: cython.double) -> cython.double:
    """A length rounded to a 65536th, which points on the square can be moved by without an error."""
    return (length + _ROUNDING) - _ROUNDING


@cython.cfunc
def _at(points: cython.p_double, i: cython.Py_ssize_t, distance: cython.double, to: cython.p_double):
    """Write the point at a distance from point i toward the next."""
    share: cython.double = distance / _length(points, i, i + 1)
    to[0] = points[2 * i] + _rounded((points[2 * i + 2] - points[2 * i]) * share)
    to[1] = points[2 * i + 1] + _rounded((points[2 * i + 3] - points[2 * i + 1]) * share)


def _running_sum(numbers):
    total = 0
    for number in numbers:
        total += number
        yield float(total)


@cython.cfunc
def _address(memory: bytearray) -> cython.p_char:
    return memory
