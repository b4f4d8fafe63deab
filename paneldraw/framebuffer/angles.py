"""Angles in degrees, clockwise from the x axis as the screen shows them, and the vectors they stand for."""

from __future__ import annotations

from fractions import Fraction
from math import cos, nextafter, radians, sin

_EXACT = 1 << 53
_NEARLY = nextafter(360, 0)

Vector = tuple[int, int]


def sweep(start: float, end: float) -> float:
    """How far it is clockwise from one angle to another: less than 360 degrees, or 360 for that and more."""
    near = max(abs(start), abs(end)) < _EXACT
    turned = end - start if near else Fraction(end) - Fraction(start)
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


def is_reflex(start: Vector, end: Vector, swept: float) -> bool:
    """Whether more than half a turn lies between two vectors whose angles, before rounding, were `swept` apart."""
    cross = start[0] * end[1] - start[1] * end[0]
    return cross < 0 if cross and 90 < swept < 270 else swept > 180
