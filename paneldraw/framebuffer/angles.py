"""Angles in degrees, clockwise from the x axis as the screen shows them, and the vectors they stand for."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, nextafter, radians, sin, tan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from fractions import Fraction

_EXACT = 1 << 53
_NEARLY = nextafter(360, 0)

# How far an arc may reach that is not halved any more to see where it is: in pixels.
_SHORT = 64

Vector = tuple[int, int]
Turn = tuple[float, float]


def sweep(start: float, end: float) -> float:
    """How far it is clockwise from one angle to another: less than 360 degrees, or 360 for that and more."""
    turned: float | Fraction
    if max(abs(start), abs(end)) < _EXACT:
        turned = end - start
    else:
        from fractions import Fraction  # brings decimal along

        turned = Fraction(end) - Fraction(start)
    return 360 if turned >= 360 else min(float(turned % 360), _NEARLY)


def direction(angle: float, unit: int) -> Vector:
    """The vector of length `unit` at an angle, to the nearest whole numbers; exact for quarter turns."""
    angle %= 360
    quarters = round(angle / 90)
    rest = radians(angle - 90 * quarters)
    x, y = round(unit * cos(rest)), round(unit * sin(rest))
    for _ in range(quarters % 4):
        x, y = -y, x
    return x, y


def on_ellipse(angle: float, a: float, b: float) -> float:
    """The angle by which an ellipse with the radii a and b is written that has a point in the direction of another."""
    x, y = b * cos(radians(angle)), a * sin(radians(angle))
    if x == y == 0 or angle % 90 == 0:
        return angle
    own = degrees(atan2(y, x))
    return own + 360 * round((angle - own) / 360)


def turned_box(box: list[int], angle: float) -> list[float]:
    """The corners, x and y in turn, of a box (x, y, w, h) turned around its center; it in 256ths, they in pixels."""
    x, y, w, h = box
    unit = 1 << 60
    ux, uy = direction(angle, unit)
    corners = []
    for dx, dy in ((-w, -h), (w, -h), (w, h), (-w, h)):
        corners += [2 * x + w + (dx * ux - dy * uy) // unit, 2 * y + h + (dx * uy + dy * ux) // unit]
    return [number / 512 if abs(number) < _EXACT else number >> 9 for number in corners]


def turned_ellipse(x: int, y: int, a: int, b: int, turn: tuple[float, float, float]) -> list[int]:
    """The control points of cubic Bézier pieces of an ellipse of any size: its own angle, and as `Path.ellipse`."""
    angle, start, swept = turn
    unit = 1 << 60
    pieces = 128
    reach = round(4 / 3 * tan(radians(swept) / pieces / 4) * unit)
    ux, uy = direction(angle, unit)
    controls: list[int] = []
    for k in range(pieces + 1):
        c, s = direction(start + swept * k / pieces, unit)
        for side in (-1, 0, 1):
            dx, dy = a * (c - side * reach * s // unit), b * (s + side * reach * c // unit)
            controls += [x + (dx * ux - dy * uy) // unit**2, y + (dx * uy + dy * ux) // unit**2]
    return controls[2:-2]


def is_reflex(start: Vector, end: Vector, swept: float) -> bool:
    """Whether more than half a turn lies between two vectors whose angles, before rounding, were `swept` apart."""
    cross = start[0] * end[1] - start[1] * end[0]
    return cross < 0 if cross and 90 < swept < 270 else swept > 180


def dashes(turn: Turn, radius: float, dash: list[int], center: tuple[float, float], window: list[int]) -> list[Turn]:
    """Which arcs a dash pattern shows of one and can be seen: where each begins and how far it goes on, in degrees.

    Lengths are in pixels, those of the pattern in 256ths; its pixels at both ends count. The window is left, top, right
    and bottom.
    """
    start, swept = turn
    degree = radians(1) * radius
    if degree == 0 or dash[0] >= 256 * swept * degree:
        return [turn]
    lengths = [number / 256 for number in dash]
    period = sum(lengths)
    begins = [sum(lengths[:i]) for i in range(0, len(lengths), 2)]
    arcs: list[Turn] = []
    following = 0
    for begin, turned in _seen(turn, radius, center, window):
        first = (begin - start) * degree
        last = first + turned * degree
        number = max(following, int(first // period) * len(begins))
        while True:
            periods, i = divmod(number, len(begins))
            passed = periods * period + begins[i]
            if passed >= last:
                break
            if passed + lengths[2 * i] >= first:
                length = max(min(lengths[2 * i] - 1, swept * degree - passed), 0)
                arcs.append((start + passed / degree, length / degree))
            number += 1
        following = number
    return arcs


def _seen(turn: Turn, radius: float, center: tuple[float, float], window: list[int]) -> list[Turn]:
    """The parts of an arc that are not far from a window, in order."""
    left, top, right, bottom = window
    parts = []
    open_turns = [turn]
    while open_turns:
        start, swept = open_turns.pop()
        middle = radians(start + swept / 2)
        x, y = center[0] + radius * cos(middle), center[1] + radius * sin(middle)
        # No point of it is further from its middle; and a pixel may be one off.
        reach = 2 * radius * sin(radians(swept / 4)) + 2
        if hypot(max(left - x, x - right, 0), max(top - y, y - bottom, 0)) > reach:
            continue
        if reach <= _SHORT:
            parts.append((start, swept))
        else:
            open_turns += [(start + swept / 2, swept / 2), (start, swept / 2)]
    return parts
