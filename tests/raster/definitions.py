"""What each primitive is, in exact arithmetic and without haste. The tests compare the raster with this.

A shape is an array of shape (height, width) that says how much of each pixel it covers: a number of reference points,
or a bool. Coordinates are ints of any size and fractions.
"""

from __future__ import annotations

from fractions import Fraction
from math import ceil, floor

import numpy as np

HALF = Fraction(1, 2)
REACH = 2**17  # pixels: within it shapes are exact, and what reaches further may be off by a pixel


def nearest(value):
    """The nearest whole number, halves upward."""
    return floor(Fraction(value) + HALF)


def agree(drawn, exact, numbers):
    """Whether two pictures are equal or, if a number is beyond +-REACH, what is lit is within a pixel of each other.

    Of a pixel on the border the other may lie outside.
    """
    if all(abs(number) <= REACH for number in numbers):
        return (drawn == exact).all()
    drawn, exact = drawn > 0, exact > 0
    inner = np.s_[1:-1, 1:-1]
    return not (drawn & ~grown(exact))[inner].any() and not (exact & ~grown(drawn))[inner].any()


def grown(lit):
    """The pixels that are lit or touch one that is."""
    padded = np.pad(lit, 1)
    height, width = lit.shape
    return np.any([padded[y : y + height, x : x + width] for y in range(3) for x in range(3)], axis=0)


def bresenham(width, height, x1, y1, x2, y2):
    """In each column (in each row, if the line is steep) the pixel nearest to the true line.

    Where two are equally near, the one further along, seen from the end point on the left (at the top, if steep).
    """
    x1, y1, x2, y2 = map(nearest, (x1, y1, x2, y2))
    if abs(x2 - x1) < abs(y2 - y1):
        return bresenham(height, width, y1, x1, y2, x2).T
    if x2 < x1:
        x1, y1, x2, y2 = x2, y2, x1, y1
    lit = np.zeros((height, width), bool)
    for x in range(max(x1, 0), min(x2, width - 1) + 1):
        true = Fraction(y1) if x1 == x2 else y1 + Fraction((y2 - y1) * (x - x1), x2 - x1)
        y = floor(true + HALF) if y1 <= y2 else ceil(true - HALF)
        if 0 <= y < height:
            lit[y, x] = True
    return lit


def rectangle(width, height, x1, y1, x2, y2, thickness, cap="square", n=1, reference="center"):
    """How many of the n x n reference points of each pixel are in the rectangle around the line.

    Of the points on an edge, those belong that have the inside to their right, or, on a horizontal edge, below.
    """
    unit = 512 * n  # of these one pixel: every number below is whole
    x1, y1, x2, y2 = (nearest(Fraction(value) * 256) * 2 * n for value in (x1, y1, x2, y2))
    half = nearest(Fraction(thickness) * 256) * n
    xs, ys = reference_points(width, n, reference), reference_points(height, n, reference)
    dx, dy = (x2 - x1, y2 - y1) if (x1, y1) != (x2, y2) else (unit, 0)
    along = dx * (xs[None, :] - x1) + dy * (ys[:, None] - y1)
    across = dx * (ys[:, None] - y1) - dy * (xs[None, :] - x1)
    squared = dx * dx + dy * dy
    end = dx * (x2 - x1) + dy * (y2 - y1)
    # Half a width, times the length of (dx, dy), is the root of this.
    side = half * half * squared
    reach = side if cap == "square" else 0
    inside = (
        at_most_root(across, side, (dy, -dx))
        & at_most_root(-across, side, (-dy, dx))
        & at_most_root(along - end, reach, (-dx, -dy))
        & at_most_root(-along, reach, (dx, dy))
    )
    return inside.reshape(height, n, width, n).sum(axis=(1, 3))


def polygon(width, height, corners, rule="even-odd", n=1, reference="center"):
    """How many of the reference points of each pixel the polygon goes around an odd number of times, or any number."""
    xs, ys = reference_points(width, n, reference), reference_points(height, n, reference)
    corners = [tuple(nearest(Fraction(value) * 256) * 2 * n for value in corner) for corner in corners]
    turns = np.zeros((height * n, width * n), int)
    for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True):
        sign = 1 if y1 < y2 else -1
        if y2 < y1:
            x1, y1, x2, y2 = x2, y2, x1, y1
        beside = ((y1 <= ys) & (ys < y2))[:, None]
        right_of_it = (y2 - y1) * (xs[None, :] - x1) >= (x2 - x1) * (ys[:, None] - y1)
        turns += sign * (beside & right_of_it)
    inside = turns % 2 == 1 if rule == "even-odd" else turns != 0
    return inside.reshape(height, n, width, n).sum(axis=(1, 3))


def dashed(width, height, x1, y1, x2, y2, dash, phase=0):
    """The pixels of a line that a pattern shows, which counts them from (x1, y1)."""
    lit = bresenham(width, height, x1, y1, x2, y2)
    pattern = [k % 2 == 0 for k, length in enumerate(dash * 2) for _ in range(length)]
    steep = abs(x2 - x1) < abs(y2 - y1)
    for y, x in np.argwhere(lit).tolist():
        step = abs(y - y1) if steep else abs(x - x1)
        lit[y, x] = pattern[(step + phase) % len(pattern)]
    return lit


def reference_points(pixels, n, reference):
    """Where the reference points of the sub-pixels are along one axis, in 512 n-ths of a pixel."""
    first = -256 * n + (256 if reference == "center" else 0)
    return np.array([first + 512 * i for i in range(pixels * n)], object)


def at_most_root(values, square, inward):
    """Whether ``value < sqrt(square)``, or on the edge itself, if it is one whose points belong to the inside."""
    below = (values < 0) | (values * values < square)
    on_edge = (values >= 0) & (values * values == square)
    return below | on_edge if inward[0] > 0 or (inward[0] == 0 and inward[1] > 0) else below


def circle(width, height, x, y, r, fill=False):
    """In each column of the top and bottom octants, in each row of the others, the pixel nearest to the true one."""
    x, y, r = map(nearest, (x, y, r))
    lit = np.zeros((height, width), bool)
    for row in range(height):
        for column in range(width):
            low, high = sorted((abs(column - x), abs(row - y)))
            # Twice the distance of the true circle from the axis at `low`, squared; no half is ever a whole root.
            true = 4 * (r * r - low * low)
            reached = (2 * high - 1) ** 2 <= true if high else r == 0 or fill
            lit[row, column] = reached and (fill or true < (2 * high + 1) ** 2)
    return lit


def painted(before, covered, full, level, op, depth):
    """The levels after painting a shape that covers `covered` of `full` parts of each pixel over `before`."""
    levels = np.empty_like(before)
    for place, old in np.ndenumerate(before):
        levels[place] = one_painted(int(old), Fraction(int(covered[place]), full), level, op, depth)
    return levels


def one_painted(old, coverage, level, op, depth):
    if depth == 1:
        coverage = floor(coverage + HALF)
    if coverage == 0:
        return old
    share = nearest(level * coverage)
    if op == "over":
        return nearest(old * (1 - coverage) + level * coverage)
    if op == "clear":
        return nearest(old * (1 - coverage))
    return {"xor": old ^ share, "add": min(old + share, 2**depth - 1), "max": max(old, share)}[op]
