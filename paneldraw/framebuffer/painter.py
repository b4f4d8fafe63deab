# cython: nonecheck=True
"""How shapes are painted that the framebuffer's calls ask for: thin or wide, near or far.

Numbers come read and checked. What is thin, one pixel wide and aliased, is in whole or half pixels; all else, and all
that is far away, is in 256ths of a pixel.
"""

from __future__ import annotations

from array import array

import cython
from cython.cimports.paneldraw.framebuffer.arguments import (
    FAR,
    Numbers,
    coordinate,
    extent,
    int64s,
    is_word,
    level,
    level_named,
    near_pixel,
    points_of,
    quick,
)
from cython.cimports.paneldraw.raster.bezier import Path, chain, through, walk
from cython.cimports.paneldraw.raster.blit import block
from cython.cimports.paneldraw.raster.circle import arc, circle, ellipse, round_rect, sector
from cython.cimports.paneldraw.raster.circle import disc as thin_disc
from cython.cimports.paneldraw.raster.cone import ConeFilter
from cython.cimports.paneldraw.raster.coverage import Coverage
from cython.cimports.paneldraw.raster.disc import Part, Round, disc, ring
from cython.cimports.paneldraw.raster.flood import flood
from cython.cimports.paneldraw.raster.line import bresenham, dashed, polyline
from cython.cimports.paneldraw.raster.paint import once, painted
from cython.cimports.paneldraw.raster.polygon import polygon
from cython.cimports.paneldraw.raster.stroke import Contours, Stroke, arc_path, distinct, doubles, is_endless
from cython.cimports.paneldraw.raster.surface import OVER, Surface
from cython.cimports.paneldraw.raster.thick_line import filtered_line, thick_line

from paneldraw.framebuffer.angles import dashes, direction, is_reflex, on_ellipse, turned_box, turned_ellipse
from paneldraw.framebuffer.arguments import (
    check_antialias,
    choice,
    dash_lengths,
    dash_steps,
    line_width,
    nearest,
    whole,
)
from paneldraw.raster import clip, outline
from paneldraw.raster.circle import UNIT as THIN_UNIT
from paneldraw.raster.disc import UNIT
from paneldraw.raster.stroke import CAPS, JOINS
from paneldraw.raster.surface import OPS

_BUTT = cython.declare(cython.int, CAPS["butt"])
_SQUARE = cython.declare(cython.int, CAPS["square"])
_ROUND = cython.declare(cython.int, CAPS["round"])
_WIDEST = cython.declare(cython.longlong, clip.REACH * 256)
_REACH = cython.declare(cython.longlong, clip.REACH)

# The length of the vectors that say where a far turn begins and ends: as exact as floating-point numbers are.
_FAR_UNIT = 1 << 60


@cython.final
@cython.cclass
class Style:
    """What a call paints a shape with, but for the level and how it meets what is there, which the surface knows."""


@cython.final
@cython.cclass
class Painter:
    """Paints shapes on a surface, and keeps what they need from call to call."""

    def __init__(self, surface: Surface, antialias):
        check_antialias(antialias)
        self.surface = surface
        self.coverage = Coverage(surface)
        self.contours = Contours()
        self.kept_style = Style()
        self.antialias = antialias

    def paint_with(self, c, op):
        """Paint with level `c` and operation `op`."""
        code: cython.int = OVER if is_word(op, "over") else choice("op", op, OPS)
        self.surface.paint_with(level(self.surface, c), code)

    def style(self, c, op, width, antialias, cap="square", join="miter", dash=None):
        """What a call's arguments say of how to paint."""
        style: Style = self.kept_style
        style.cap = _SQUARE if is_word(cap, "square") else _BUTT if is_word(cap, "butt") else choice("cap", cap, CAPS)
        style.join = 0 if is_word(join, "miter") else choice("join", join, JOINS)
        if antialias is ...:
            antialias = self.antialias
        else:
            check_antialias(antialias)
        style.antialias = antialias
        style.width = 256 if type(width) is int and width == 1 else min(line_width(width), clip.WIDEST)
        style.dash = None if dash is None else dash_lengths(dash)
        style.thin = antialias is None and style.width == 256
        style.butt_start = style.butt_end = False
        self.paint_with(c, op)
        return style

    def line(self, x1, y1, x2, y2, style, dda):
        """Draw a line."""
        unit: cython.longlong = 1 if style.thin else 256
        a: cython.longlong = coordinate("x1", x1, unit)
        b: cython.longlong = coordinate("y1", y1, unit)
        c: cython.longlong = coordinate("x2", x2, unit)
        d: cython.longlong = coordinate("y2", y2, unit)
        if a == FAR or b == FAR or c == FAR or d == FAR:
            names = (("x1", x1), ("y1", y1), ("x2", x2), ("y2", y2))
            self._far_line([nearest(name, value, unit) for name, value in names], style, dda)
        elif style.thin and style.dash is None and not dda:
            bresenham(self.surface, a, b, c, d)
        else:
            self.segment(a, b, c, d, style, dda)

    def arrow(self, kind, name, points, head, pointed, style):
        """Draw a path with a head at its start, its end or both: lines, a Bézier curve or a smooth one."""
        numbers: Numbers = points_of(name, points, 256)
        length = 3 * style.width + 256 if head is None else nearest("head", head, 256)
        if length < 0:
            raise ValueError(f"head must not be negative, and is {head}")
        if kind == 1:
            _check_controls(numbers.count)
        if numbers.count == 0:
            return
        shape, rest = outline.heads(self._chords(kind, numbers, style), length, style.width, pointed)
        if style.thin:
            self._thin_arrow(kind, name, points, shape, style)
            return
        style.butt_start, style.butt_end = pointed
        self.contours.begin()
        if rest:
            self._add_far_path(rest, False, style)
        self._add_polygons(shape)
        self._fill_contours(style, True)

    def _thin_arrow(self, kind, name, points, shape, style):
        """Draw an aliased path of width 1 and fill its heads, each pixel once."""
        surface: Surface = self.surface
        marks: Surface = once(surface)
        self.surface = self.coverage.surface = marks
        try:
            if kind == 0:
                self.path(name, points, False, style)
            elif kind == 1:
                self.curve(points, False, False, style)
            else:
                self.smooth(points, False, False, style)
            for triangle in shape:
                pixels = [number / 256 if abs(number) < FAR else number >> 8 for number in triangle]
                self.polygon(pixels, True, True, True, style)
        finally:
            self.surface = self.coverage.surface = surface
        painted(surface, marks, surface.top, surface.bottom)

    def _chords(self, kind, numbers, style):
        """The points of a path, or those along a curve, x and y in turn."""
        values = numbers.exact
        if values is None:
            values = [numbers.values[i] for i in range(2 * numbers.count)]
        if kind == 0 or numbers.count == 1:
            return values
        controls = outline.through(clip.pairs(values), False) if kind == 2 else outline.chain(values)
        if numbers.exact is not None:
            return outline.curve(controls)
        path: Path = Path(1, 0, True)
        memory = bytearray(array("d", controls))
        path.pieces(doubles(memory, 0), len(controls) // 6)
        return [int(path.points[i]) for i in range(2 * path.count)]

    def segments(self, numbers, style, dda):
        """Draw the line of each row."""
        row: cython.Py_ssize_t
        p: cython.p_longlong = numbers.values
        if numbers.exact is not None:
            for row in range(0, 4 * numbers.count, 4):
                self._far_line(numbers.exact[row : row + 4], style, dda)
        elif style.thin and style.dash is None and not dda:
            for row in range(0, 4 * numbers.count, 4):
                bresenham(self.surface, p[row], p[row + 1], p[row + 2], p[row + 3])
        elif not style.thin and style.dash is None and style.cap != _ROUND and style.width <= _WIDEST:
            self.coverage.begin(style.antialias)
            for row in range(0, 4 * numbers.count, 4):
                self._rectangle(p[row], p[row + 1], p[row + 2], p[row + 3], style)
        else:
            for row in range(0, 4 * numbers.count, 4):
                self.segment(p[row], p[row + 1], p[row + 2], p[row + 3], style, dda)

    def points(self, numbers):
        row: cython.Py_ssize_t
        p: cython.p_longlong = numbers.values
        if numbers.exact is not None:
            for x, y in clip.pairs(numbers.exact):
                if max(abs(x), abs(y)) <= clip.REACH:
                    self.surface.point(x, y)
            return
        for row in range(0, 2 * numbers.count, 2):
            self.surface.point(p[row], p[row + 1])

    def triangle(self, x1, y1, x2, y2, x3, y3, fill, covered, style):
        """Fill a triangle or draw its outline."""
        points: cython.longlong[6]
        i: cython.int
        if not cython.compiled:
            points = [0] * 6
        points[0], points[1] = coordinate("x1", x1, 256), coordinate("y1", y1, 256)
        points[2], points[3] = coordinate("x2", x2, 256), coordinate("y2", y2, 256)
        points[4], points[5] = coordinate("x3", x3, 256), coordinate("y3", y3, 256)
        bits: cython.longlong = 0
        far: cython.bint = False
        for i in range(6):
            bits |= points[i]
            far = far or points[i] == FAR
        if far or bits & 255 or not style.thin or style.dash is not None:
            self.polygon((x1, y1, x2, y2, x3, y3), fill, False, covered, style)
            return
        # Whole pixels, one pixel wide, aliased.
        marks: Surface = once(self.surface)
        if fill:
            self._fill(marks, points, 3, False, None)
        if covered or not fill:
            for i in range(6):
                points[i] >>= 8
            polyline(marks, points, 3, True, points, 0, 0, False)
        painted(self.surface, marks, self.surface.top, self.surface.bottom)

    def _fill(self, surface, points, count, nonzero, antialias):
        """Fill what points enclose, in 256ths, on a surface like this one."""
        end: cython.Py_ssize_t[1]
        if not cython.compiled:
            end = [0]
        end[0] = count
        self.coverage.surface = surface
        self.coverage.begin(antialias)
        polygon(self.coverage, points, end, 1, nonzero)
        self.coverage.finish()
        self.coverage.surface = self.surface

    def polygon(self, coords, fill, nonzero, covered, style):
        """Fill a polygon or draw its outline."""
        corners: Numbers
        if fill:
            coords = coords if hasattr(coords, "__len__") or not hasattr(coords, "__iter__") else list(coords)
            corners = points_of("coords", coords, 256)
            if not _is_flat(corners):
                self._fill_polygon(corners, coords, nonzero, covered, style)
                return
            style.dash = None
        self.path("coords", coords, True, style)

    def _fill_polygon(self, corners, coords, nonzero, covered, style):
        """Fill what corners enclose and, if it is to be covered, what lies on the lines between them."""
        lines: Numbers
        covered = covered and style.antialias is None
        if corners.exact is not None:
            if covered:
                self._far_outlines([corners.exact], True, True, nonzero, style)
            else:
                self._far_fill([corners.exact], nonzero, style)
            return
        marks: Surface = once(self.surface) if covered else self.surface
        self._fill(marks, corners.values, corners.count, nonzero, style.antialias)
        if covered:
            lines = points_of("coords", coords, 1)
            polyline(marks, lines.values, lines.count, True, lines.values, 0, 0, False)
            painted(self.surface, marks, self.surface.top, self.surface.bottom)

    def fill(self, c):
        """Paint all that is in the window."""
        surface: Surface = self.surface
        block(surface, 0, 0, surface.width, surface.height, level(surface, c), OVER)

    def run(self, x, y, length, across, c, op):
        """Paint a row of pixels from (x, y) on, or a column of them."""
        left: cython.longlong = quick(x)
        top: cython.longlong = quick(y)
        count: cython.longlong = quick(length)
        if left == FAR or top == FAR or count == FAR or count < 0:
            left, top = near_pixel("x", x), near_pixel("y", y)
            count = extent("w" if across else "h", length, 1)
        if count == FAR or left == -_REACH or top == -_REACH:
            # It may begin out of reach and lead into the window.
            begin = whole("x", x) if across else whole("y", y)
            count = min(max(begin + whole("w", length), -clip.REACH), clip.REACH) - (left if across else top)
        right: cython.longlong = left + (count if across else 1)
        bottom: cython.longlong = top + (1 if across else count)
        operation: cython.int = OVER if is_word(op, "over") else choice("op", op, OPS)
        color: cython.longlong = quick(c)
        if not 0 <= color <= self.surface.max_level:
            color = level(self.surface, c)
        block(self.surface, left, top, right, bottom, cython.cast(cython.int, color), operation)

    def segment(self, x1, y1, x2, y2, style, dda):
        """Draw a line: in whole pixels if it is thin, else in 256ths."""
        ends: cython.longlong[4]
        if not cython.compiled:
            ends = [0, 0, 0, 0]
        if style.thin:
            steps = dash_steps(style.dash)
            dashed(self.surface, x1, y1, x2, y2, int64s(steps), len(steps) // 8, 0, dda)
        elif style.dash is None and style.cap != _ROUND and style.width <= _WIDEST:
            self.coverage.begin(style.antialias)
            self._rectangle(x1, y1, x2, y2, style)
        else:
            ends[0], ends[1], ends[2], ends[3] = x1, y1, x2, y2
            self._wide_path(ends, 2, False, style)

    def _rectangle(self, x1, y1, x2, y2, style):
        """Paint the rectangle around a line; `coverage` has begun."""
        if isinstance(style.antialias, ConeFilter):
            filtered_line(self.coverage, x1, y1, x2, y2, style.width, style.cap == _SQUARE)
        else:
            thick_line(self.coverage, x1, y1, x2, y2, style.width, style.cap == _SQUARE)
            self.coverage.finish()

    def path(self, name, points, closed, style):
        """Draw lines from point to point."""
        numbers: Numbers = points_of(name, points, 1 if style.thin else 256)
        if style.thin:
            marks: Surface = once(self.surface)
            self._thin_path(marks, numbers, closed, style)
            painted(self.surface, marks, self.surface.top, self.surface.bottom)
        elif numbers.exact is not None:
            self._far_path(numbers.exact, closed, style)
        else:
            self._wide_path(numbers.values, numbers.count, closed, style)

    def _thin_path(self, surface, numbers, closed, style):
        """Draw aliased lines of width 1 on a surface, from point to point, each a whole pixel."""
        if numbers.exact is not None:
            self._far_thin_path(surface, [256 * number for number in numbers.exact], closed, style.dash, False)
        elif numbers.count:
            steps = dash_steps(style.dash)
            polyline(surface, numbers.values, numbers.count, closed, int64s(steps), len(steps) // 8, 0, False)

    def _wide_path(self, values, count, closed, style):
        """Draw the stroke of a path near by, its points in 256ths."""
        last: cython.Py_ssize_t = 2 * count - 2
        while last > 0 and values[last] == values[0] and values[last + 1] == values[1]:
            last -= 2
        # A line is a rectangle, whichever call draws it.
        self.contours.begin()
        if self._add_piece(values, count, closed, style, 0, True):
            self._fill_contours(style, True)
        elif count:
            self.coverage.begin(style.antialias)
            self._rectangle(values[0], values[1], values[last], values[last + 1], style)

    def _add_piece(self, values, count, closed, style, distance, alone):
        """Add the contours of a path's stroke, its points in 256ths; dashes begin at `distance`.

        Returns whether it did: what is alone and but one straight line is left to be painted as such.
        """
        memory = bytearray(16 * (count + 1))
        points: cython.p_double = doubles(memory, 0)
        number: cython.Py_ssize_t = distinct(values, count, points)
        if closed and number > 1 and points[0] == points[2 * number - 2] and points[1] == points[2 * number - 1]:
            number -= 1
        closed = closed and number > 2
        if number == 0:
            return False
        whole_dash = style.dash is None or is_endless(points, number, closed, style.dash[0])
        if alone and number <= 2 and whole_dash and style.cap != _ROUND and style.width <= _WIDEST:
            return False
        self._add_stroke(points, number, closed, style, distance, None)
        return True

    def _add_stroke(self, points, count, closed, style, distance, circle):
        """Add the contours of a path's stroke, or of a circle's. Behind its points there is room for another."""
        pixels: cython.Py_ssize_t = max(self.surface.width, self.surface.height)
        stroke: Stroke = Stroke(self.contours, style.width, style.join, pixels, circle)
        cap: cython.int = _BUTT if closed and style.cap == _SQUARE else style.cap
        if style.dash is None or count == 1 or (distance == 0 and is_endless(points, count, closed, style.dash[0])):
            start: cython.int = _BUTT if style.butt_start else cap
            stroke.path(points, count, closed, start, _BUTT if style.butt_end else cap)
            return
        if cap == _SQUARE and (style.butt_start or style.butt_end):
            cap = _BUTT
        if closed:
            points[2 * count] = points[0]
            points[2 * count + 1] = points[1]
            count += 1
        stroke.dashes(points, count, closed, cap, style.dash, distance)

    def curve(self, points, closed, fill, style):
        """Draw the Bézier curves that these control points have, or fill what they enclose."""
        numbers: Numbers = points_of("points", points, 256)
        _check_controls(numbers.count)
        if numbers.count < 2:
            self.path("points", points, False, style)
        elif numbers.exact is not None:
            self._far_curve(outline.chain(numbers.exact), closed, fill, style)
        else:
            self._chain(chain(numbers.values, numbers.count), closed, fill, style)

    def smooth(self, points, closed, fill, style):
        """Draw the smooth curve through points, or fill what it encloses."""
        numbers: Numbers = points_of("points", points, 256)
        if numbers.exact is not None:
            self._far_curve(outline.through(clip.pairs(numbers.exact), closed), closed, fill, style)
            return
        memory = bytearray(16 * (numbers.count + 1))
        to: cython.p_double = doubles(memory, 0)
        count: cython.Py_ssize_t = distinct(numbers.values, numbers.count, to)
        if closed and count > 1 and to[0] == to[2 * count - 2] and to[1] == to[2 * count - 1]:
            count -= 1
        if count > 2:
            self._chain(through(to, count, closed), closed, fill, style)
        else:
            self.path("points", points, closed, style)

    def _chain(self, controls, closed, fill, style):
        """Draw the pieces that these control points have, near by, or fill what they enclose."""
        p: cython.p_double = doubles(controls, 0)
        last: cython.Py_ssize_t = len(controls) // 8 - 2
        if fill:
            _as_area(style)
        path: Path = self._new_path(style)
        if fill:
            self._fill_chain(controls, path, style)
        elif style.thin:
            walk(self.surface, path, controls, closed, _in_steps(style.dash))
        else:
            path.pieces(p, last // 6)
            self._smooth_path(path, closed, style)

    def _fill_chain(self, controls, path, style):
        """Fill what pieces enclose and, aliased, draw them with the path of theirs that is there to walk along."""
        i: cython.Py_ssize_t
        surface: Surface = self.surface
        marks: Surface = once(surface) if style.thin else surface
        area: Path = Path(path.low, path.high, True)
        area.pieces(doubles(controls, 0), (len(controls) // 8 - 2) // 6)
        self.contours.begin()
        for i in range(area.count):
            self.contours.add(area.points[2 * i], area.points[2 * i + 1], 0, 0)
        self.contours.close()
        self.coverage.surface = marks
        self._fill_contours(style, False)
        self.coverage.surface = surface
        if style.thin:
            walk(marks, path, controls, True, [])
            painted(surface, marks, surface.top, surface.bottom)

    def _new_path(self, style):
        """A path that leaves out what cannot be seen."""
        if style.dash is not None:
            return Path(1, 0, not style.thin)
        beyond: cython.longlong = clip.MARGIN + 2 * style.width
        return Path(-beyond, 256 * max(self.surface.width, self.surface.height) + beyond, not style.thin)

    def _smooth_path(self, path, closed, style):
        """Draw the stroke of a path."""
        count: cython.Py_ssize_t = path.count
        if closed and count > 1 and path.ends_where_it_begins():
            count -= 1
        self.contours.begin()
        self._add_stroke(path.points, count, closed and count > 2, style, 0, None)
        self._fill_contours(style, True)

    def _fill_contours(self, style, nonzero):
        """Fill the contours that are collected."""
        contours: Contours = self.contours
        self.coverage.begin(style.antialias)
        polygon(self.coverage, contours.points, contours.ends, contours.contours, nonzero)
        self.coverage.finish()

    def _read_round(self, x, y, a, b, name_a, name_b, style):
        """Read a center and two radii into `x`, `y`, `a` and `b`: in half pixels if it is thin, else in 256ths.

        Returns None; or, if one of them is beyond reach, all four as Python's integers, in 256ths.
        """
        unit: cython.longlong = 2 if style.thin else 256
        self.x = coordinate("x", x, unit)
        self.y = coordinate("y", y, unit)
        self.a = extent(name_a, a, unit)
        self.b = self.a if b is a else extent(name_b, b, unit)
        if self.x != FAR and self.y != FAR and self.a != FAR and self.b != FAR:
            return None
        return _in_256ths((("x", x), ("y", y), (name_a, a), (name_b, b)))

    def circle(self, x, y, r, fill, style):
        """Draw a circle or disc."""
        far = self._read_round(x, y, r, r, "r", "r", style)
        if far is not None:
            cx, cy, a, b = far
            self._far_box((cx, cy, cx, cy), a, b, False, fill, style)
        elif not style.thin:
            self._round_shape(self.x, self.y, self.x, self.y, self.a, self.a, False, fill, None, style)
        elif fill:
            thin_disc(self.surface, self.x, self.y, self.a)
        else:
            circle(self.surface, self.x, self.y, self.a)

    def ellipse(self, x, y, xr, yr, fill, quadrants, style):
        """Draw quarters of an ellipse."""
        far = self._read_round(x, y, xr, yr, "xr", "yr", style)
        if far is not None:
            cx, cy, a, b = far
            if quadrants == 15:
                self._far_box((cx, cy, cx, cy), a, b, False, fill, style)
            else:
                self._far_quarters(cx, cy, a, b, quadrants, fill, style)
        elif style.thin:
            ellipse(self.surface, self.x, self.y, self.a, self.b, fill, quadrants)
        elif quadrants:
            part = None if quadrants == 15 else Part(quadrants, (0, 0), (0, 0), False, False, 0)
            self._round_shape(self.x, self.y, self.x, self.y, self.a, self.b, False, fill, part, style)

    def turned_box(self, x, y, w, h, angle, fill, style):
        """Draw a rectangle turned around its center."""
        left, top, across, down = _in_256ths((("x", x), ("y", y), ("w", w), ("h", h)))
        if across < 0 or down < 0:
            extent("w", w, 256)
            extent("h", h, 256)
        if across == 0 or down == 0:
            return
        box = [left, top, across - 256, down - 256]
        if style.thin or (style.dash is not None and not fill):
            self.polygon(turned_box(box, angle), fill, False, style.thin, style)
            return
        corners = turned_box(_grown(box, style.width // 2), angle)
        inner = _grown(box, -(style.width // 2))
        if not fill and min(inner[2:]) > 0:
            # There and back along one edge, which then bounds nothing. Corners of their own keep short sides exact.
            hole = turned_box(inner, angle)
            corners += [*corners[:2], *hole, *hole[:2]]
        self.polygon(corners, True, False, False, style)

    def turned_ellipse(self, x, y, xr, yr, angle, fill, style):
        """Draw an ellipse turned around its center."""
        cx, cy, a, b = _in_256ths((("x", x), ("y", y), ("xr", xr), ("yr", yr)))
        if a < 0 or b < 0:
            extent("xr", xr, 256)
            extent("yr", yr, 256)
        half = style.width // 2
        if max(abs(cx), abs(cy), a, b) > 256 * clip.REACH:
            self._far_ellipse(cx, cy, a, b, angle, fill, style)
            return
        outer: Path = self._ellipse(cx, cy, a, b, angle, style) if style.thin else None
        surface: Surface = self.surface
        marks: Surface = once(surface) if style.thin else surface
        if fill or not style.thin:
            self.contours.begin()
            self._add_ellipse(cx, cy, a, b, angle, 0 if style.thin else half, style)
            if not fill and min(a, b) > half:
                self._add_ellipse(cx, cy, a, b, angle, -half, style)
            self.coverage.surface = marks
            self._fill_contours(style, False)
            self.coverage.surface = surface
        if style.thin:
            walk(marks, outer, None, True, [])
            painted(surface, marks, surface.top, surface.bottom)

    def _ellipse(self, x, y, a, b, angle, style):
        """The path around an ellipse."""
        path: Path = self._new_path(style)
        path.ellipse(x, y, a, b, angle, 0, 360)
        path.add(path.points[0], path.points[1])
        return path

    def _add_ellipse(self, x, y, a, b, angle, beyond, style):
        """Add the contour of an ellipse with radii larger by `beyond`."""
        i: cython.Py_ssize_t
        path: Path = self._ellipse(x, y, a + beyond, b + beyond, angle, style)
        for i in range(path.count - 1):
            self.contours.add(path.points[2 * i], path.points[2 * i + 1], 0, 0)
        self.contours.close()

    def _far_ellipse(self, x, y, a, b, angle, fill, style):
        """Draw a turned ellipse of any size."""
        half = style.width // 2
        paths = [outline.curve(turned_ellipse(x, y, a, b, (angle, 0, 360)))]
        if style.thin:
            self._far_outlines(paths, True, fill, True, style)
            return
        radii = [(a + half, b + half)] if fill or min(a, b) <= half else [(a + half, b + half), (a - half, b - half)]
        self._far_fill([outline.curve(turned_ellipse(x, y, *pair, (angle, 0, 360))) for pair in radii], False, style)

    def elliptical_turn(self, x, y, r, yr, start, swept, style):
        """Draw a part of an ellipse, between the directions of two angles."""
        cx, cy, a, b = _in_256ths((("x", x), ("y", y), ("r", r), ("yr", yr)))
        if a < 0 or b < 0:
            extent("r", r, 256)
            extent("yr", yr, 256)
        begin = on_ellipse(start, a, b)
        turned = 360 if swept >= 360 else on_ellipse(start + swept, a, b) - begin
        if max(abs(cx), abs(cy), a, b) > 256 * clip.REACH:
            controls = turned_ellipse(cx, cy, a, b, (0, begin, turned))
            self._far_outlines([outline.curve(controls)], swept >= 360, False, True, style)
            return
        path: Path = self._new_path(style)
        path.ellipse(cx, cy, a, b, 0, begin, turned)
        if swept >= 360:
            path.add(path.points[0], path.points[1])
        if style.thin:
            walk(self.surface, path, None, False, _in_steps(style.dash))
        else:
            self._smooth_path(path, swept >= 360, style)

    def flood(self, x, y, c, border, op):
        """Fill what hangs together with a pixel; return how many pixels that is."""
        self.paint_with(c, op)
        surface: Surface = self.surface
        column: cython.longlong = near_pixel("x", x)
        row: cython.longlong = near_pixel("y", y)
        edge: cython.int = 0 if border is None else level_named("border", surface, border)
        if not (surface.left <= column < surface.right and surface.top <= row < surface.bottom):
            return 0
        if border is None:
            edge = surface.pixels[row * surface.stride + column]
        return flood(surface, column, row, edge, border is not None)

    def some_corners(self, x, y, w, h, r, corners, fill, style):
        """Draw a rectangle of which some corners are round: each quarter of it in a window of its own."""
        surface: Surface = self.surface
        left: cython.Py_ssize_t = surface.left
        top: cython.Py_ssize_t = surface.top
        right: cython.Py_ssize_t = surface.right
        bottom: cython.Py_ssize_t = surface.bottom
        across, down, w2, h2 = _in_256ths((("x", x), ("y", y), ("w", w), ("h", h)))
        column = min(max((across + w2 // 2) >> 8, left), right)
        row = min(max((down + h2 // 2) >> 8, top), bottom)
        windows = ((column, top, right, row), (left, top, column, row))
        windows += ((left, row, column, bottom), (column, row, right, bottom))
        try:
            for bit, window in enumerate(windows):
                surface.set_window(*window)
                self.box(x, y, w, h, r if corners >> bit & 1 else 0, fill, style)
        finally:
            surface.set_window(left, top, right, bottom)

    def box(self, x, y, w, h, r, fill, style):
        """Draw a rectangle, its corners sharp for r = 0 or else round."""
        unit: cython.longlong = 1 if style.thin else 256
        left: cython.longlong = coordinate("x", x, unit)
        top: cython.longlong = coordinate("y", y, unit)
        across: cython.longlong = extent("w", w, unit)
        down: cython.longlong = extent("h", h, unit)
        corner: cython.longlong = extent("r", r, 2 * unit if style.thin else unit)
        if left == FAR or top == FAR or across == FAR or down == FAR:
            wx, wy, ww, wh, wr = _in_256ths((("x", x), ("y", y), ("w", w), ("h", h), ("r", r)))
            if ww > 0 and wh > 0:
                wr = max(min(wr, (ww - 256) // 2, (wh - 256) // 2), 0)
                box = (wx + wr, wy + wr, wx + ww - 256 - wr, wy + wh - 256 - wr)
                self._far_box(box, wr, wr, wr == 0, fill, style)
            return
        if across == 0 or down == 0:
            return
        # The centers of the first and the last pixel of a side are a pixel less apart than it is long.
        right: cython.longlong = left + across - unit
        bottom: cython.longlong = top + down - unit
        if style.dash is not None and not fill:
            corners = (left, top, right, top, right, bottom, left, bottom)
            if style.thin:
                self.path("points", corners, True, style)
            else:
                memory = bytearray(array("q", corners))
                self._wide_path(int64s(memory), 4, True, style)
        elif style.thin:
            corner = min(corner, across - 1, down - 1)
            if corner > 1:
                left, top, right, bottom = 2 * left + corner, 2 * top + corner, 2 * right - corner, 2 * bottom - corner
                round_rect(self.surface, left, top, right, bottom, corner, fill)
            else:
                self._thin_rect(left, top, right + 1, bottom + 1, fill)
        else:
            corner = max(min(corner, (across - 256) // 2, (down - 256) // 2), 0)
            sharp: cython.bint = corner == 0
            left, top, right, bottom = left + corner, top + corner, right - corner, bottom - corner
            self._round_shape(left, top, right, bottom, corner, corner, sharp, fill, None, style)

    def _thin_rect(self, left, top, right, bottom, fill):
        """Paint an aliased rectangle: left <= x < right, top <= y < bottom."""
        surface: Surface = self.surface
        color: cython.int = surface.level
        op: cython.int = surface.op
        if fill or right - left <= 2 or bottom - top <= 2:
            block(surface, left, top, right, bottom, color, op)
            return
        block(surface, left, top, right, top + 1, color, op)
        block(surface, left, bottom - 1, right, bottom, color, op)
        block(surface, left, top + 1, left + 1, bottom - 1, color, op)
        block(surface, right - 1, top + 1, right, bottom - 1, color, op)

    def _round_shape(self, left, top, right, bottom, a, b, sharp, fill, part, style):
        """Paint the ring of a curve, or the disc within it; in 256ths."""
        shape: Round
        if not cython.compiled:
            shape = Round()
        shape.left, shape.top, shape.right, shape.bottom = left, top, right, bottom
        shape.a, shape.b, shape.sharp = a, b, sharp
        to: cython.pointer[Round] = cython.address(shape) if cython.compiled else shape
        width: cython.longlong = min(style.width, 2 * _WIDEST)
        self.coverage.begin(style.antialias)
        if fill:
            disc(self.coverage, to, width, part)
        else:
            ring(self.coverage, to, width, part)
        self.coverage.finish()

    def slice(self, x, y, r, start, end, swept, fill, style):
        """Draw a sector of less than a full turn."""
        far = self._read_round(x, y, r, r, "r", "r", style)
        if far is not None:
            self._far_turn(far[0], far[1], far[2], start, swept, True, fill, style)
        elif style.thin:
            (sx, sy), (ex, ey) = direction(start, THIN_UNIT), direction(end, THIN_UNIT)
            sector(self.surface, self.x, self.y, self.a, sx, sy, ex, ey, swept > 180, fill)
        else:
            begin, stop = direction(start, UNIT), direction(end, UNIT)
            part = Part(0, begin, stop, is_reflex(begin, stop, swept), not fill, 0)
            self._round_shape(self.x, self.y, self.x, self.y, self.a, self.a, False, fill, part, style)

    def turn(self, x, y, r, start, end, swept, style):
        """Draw an arc, which may be dashed."""
        far = self._read_round(x, y, r, r, "r", "r", style)
        if far is not None:
            self._far_turn(far[0], far[1], far[2], start, swept, False, False, style)
        elif style.thin:
            self._thin_arc(self.x, self.y, self.a, start, swept, style)
        elif style.dash is not None:
            memory = arc_path(self.x, self.y, self.a, start, swept)
            self._dashed_arc(memory, (self.x, self.y, self.a), swept >= 360, style)
        else:
            begin, stop = direction(start, UNIT), direction(end, UNIT)
            part = Part(0, begin, stop, is_reflex(begin, stop, swept), False, style.cap)
            self._round_shape(self.x, self.y, self.x, self.y, self.a, self.a, False, False, part, style)

    def _thin_arc(self, cx, cy, radius, start, swept, style):
        """Draw an aliased arc of width 1, in half pixels; dashed, it is an arc for every dash."""
        surface: Surface = self.surface
        pieces = [(start, swept)]
        if style.dash is not None:
            window = [surface.left, surface.top, surface.right, surface.bottom]
            pieces = dashes((start, swept), radius / 2, style.dash, (cx / 2, cy / 2), window)
        marks: Surface = once(surface)
        for begin, turned in pieces:
            if turned >= 360:
                circle(marks, cx, cy, radius)
            else:
                (sx, sy), (ex, ey) = direction(begin, THIN_UNIT), direction(begin + turned, THIN_UNIT)
                arc(marks, cx, cy, radius, sx, sy, ex, ey, turned > 180)
        painted(surface, marks, surface.top, surface.bottom)

    def _dashed_arc(self, memory, circle, closed, style):
        """Draw the dashed stroke along the points of an arc or circle."""
        points: cython.p_double = doubles(memory, 0)
        count: cython.Py_ssize_t = len(memory) // 16 - 1
        self.contours.begin()
        self._add_stroke(points, count, closed, style, 0, circle)
        self._fill_contours(style, True)

    # -- What reaches beyond the square that is exact: its outline, cut to the square

    def _far_line(self, ends, style, dda):
        """Draw a line between points at any distance: in whole pixels if it is thin, else in 256ths."""
        if max(map(abs, ends)) <= clip.REACH * (1 if style.thin else 256):
            self.segment(ends[0], ends[1], ends[2], ends[3], style, dda)
        elif style.thin:
            self._far_thin_path(self.surface, [256 * number for number in ends], False, style.dash, dda)
        elif style.dash is None and style.cap != _ROUND:
            self._far_fill([outline.thick_line(*ends, style.width, style.cap == _SQUARE)], True, style)
        else:
            self._far_path(ends, False, style)

    def _far_thin_path(self, surface, points, closed, dash, dda):
        """Draw aliased lines of width 1 on a surface, from point to point at any distance, in 256ths."""
        near: Numbers
        steps = dash_steps(dash)
        pattern: cython.p_longlong = int64s(steps)
        period = sum(array("q", steps)) or 1
        for piece, _, phase in clip.cut_path(points, closed, dash is not None):
            near = points_of("points", [(number + 128) >> 8 for number in piece], 1)
            polyline(surface, near.values, near.count, False, pattern, len(steps) // 8, (phase >> 8) % period, dda)

    def _far_path(self, points, closed, style):
        """Draw the stroke of a path between points at any distance, in 256ths."""
        self.contours.begin()
        self._add_far_path(points, closed, style)
        self._fill_contours(style, True)

    def _add_far_path(self, points, closed, style):
        """Add the contours of that stroke."""
        period = sum(style.dash) if style.dash is not None else 1
        # Further than joins and caps reach.
        beyond = 2 * style.width
        is_whole = clip.is_near(points, beyond)
        pieces = [(points, 0, 0)] if is_whole else clip.cut_path(points, closed, style.dash is not None, beyond)
        for piece, distance, _ in pieces:
            memory = bytearray(array("q", piece))
            self._add_piece(int64s(memory), len(piece) // 2, closed and is_whole, style, distance % period, False)

    def _far_curve(self, controls, closed, fill, style):
        """Draw Bézier curves with control points at any distance, or fill what they enclose."""
        if fill:
            _as_area(style)
        if fill and not style.thin:
            self._far_fill([outline.curve(controls)], False, style)
        else:
            self._far_outlines([outline.curve(controls)], closed, fill, False, style)

    def _far_fill(self, shape, nonzero, style):
        """Fill contours with corners at any distance, in 256ths."""
        self.contours.begin()
        self._add_polygons(shape)
        self._fill_contours(style, nonzero)

    def _add_polygons(self, shape):
        """Add polygons with corners at any distance, in 256ths."""
        contours: Contours = self.contours
        for contour in shape:
            for x, y in clip.pairs(clip.cut_polygon(contour)):
                contours.add(x, y, 0, 0)
            contours.close()

    def _far_outlines(self, paths, closed, fill, nonzero, style):
        """Draw paths of any size, thin or dashed, or fill what they enclose and draw them thin."""
        if not style.thin and not fill:
            for path in paths:
                self._far_path(path, closed, style)
            return
        surface: Surface = self.surface
        marks: Surface = once(surface)
        self.coverage.surface = marks
        if fill:
            self._far_fill(paths, nonzero, style)
        self.coverage.surface = surface
        for path in paths:
            self._far_thin_path(marks, path, closed or fill, None if fill else style.dash, False)
        painted(surface, marks, surface.top, surface.bottom)

    def _far_box(self, box, a, b, sharp, fill, style):
        """Draw a rectangle or ellipse of any size, as `_round_shape` does it."""
        if style.thin or (style.dash is not None and not fill):
            self._far_outlines([outline.rounded_box(*box, a, b)], True, fill, True, style)
        else:
            draw = outline.disc if fill else outline.ring
            self._far_fill(draw(box, a, b, sharp, style.width // 2), True, style)

    def _far_quarters(self, x, y, a, b, quadrants, fill, style):
        """Draw quarters of an ellipse of any size."""
        if style.thin:
            paths = outline.thin_quarters(x, y, a, b, quadrants, fill)
            self._far_outlines(paths, False, fill, True, style)
        else:
            self._far_fill(outline.quarters(x, y, a, b, quadrants, fill, style.width // 2), True, style)

    def _far_turn(self, x, y, r, start, swept, is_sector, fill, style):
        """Draw an arc or a sector of any size."""
        quarters = max(int(-(-swept // 90)), 1)
        turns = [direction(start + swept * k / quarters, _FAR_UNIT) for k in range(quarters + 1)]
        half = style.width // 2
        if style.thin or (style.dash is not None and not is_sector):
            path = [x, y] * is_sector + outline.arc(x, y, r, turns)
            self._far_outlines([path], is_sector or swept >= 360, fill, True, style)
        elif fill:
            self._far_fill(outline.slice_of_disc(x, y, r + half, turns), True, style)
        else:
            shape = outline.slice_of_ring(x, y, r, turns, half)
            if is_sector:
                shape += outline.spokes(x, y, r, turns, half)
            elif style.cap != _BUTT:
                shape += outline.arc_caps(x, y, r, turns, half, style.cap == _ROUND)
            self._far_fill(shape, True, style)


def _as_area(style):
    """As what is filled, a style has no width of its own: an aliased area covers its outline, one pixel wide."""
    style.width = 256
    style.dash = None
    style.thin = style.antialias is None


def _check_controls(count):
    if count and count != 3 and count % 3 != 1:
        raise ValueError(f"points must be 3, of a quadratic curve, or 4, 7, 10, ... of cubic ones, not {count}")


def _in_steps(dash):
    """The lengths of a dash pattern in whole pixels."""
    return list(array("q", dash_steps(dash)))


def _grown(box, beyond):
    """A box (x, y, w, h) that reaches further on all sides."""
    x, y, w, h = box
    return [x - beyond, y - beyond, w + 2 * beyond, h + 2 * beyond]


def _in_256ths(names):
    """Numbers of any size, each behind its name, in 256ths of a pixel."""
    return [nearest(name, value, 256) for name, value in names]


@cython.cfunc
def _is_flat(corners: Numbers) -> cython.bint:
    """Whether all corners lie on one line."""
    if corners.exact is not None:
        return clip.is_flat(corners.exact)
    i: cython.Py_ssize_t
    p: cython.p_longlong = corners.values
    dx: cython.longlong = 0
    dy: cython.longlong = 0
    for i in range(2, 2 * corners.count, 2):
        if (p[i] - p[0]) * dy != (p[i + 1] - p[1]) * dx:
            return False
        if dx == 0 and dy == 0:
            dx = p[i] - p[0]
            dy = p[i + 1] - p[1]
    return True
