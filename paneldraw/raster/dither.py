"""Grays to fewer levels: by thresholds that lie still, and by handing the error on."""

from __future__ import annotations

from typing import Any

import cython
import numpy as np
from cython.cimports.paneldraw.raster.floors import cut_off

#: A level, as `ordered` counts: in these parts.
ONE = 1 << 20
_ONE = cython.declare(cython.int, 1 << 20)


def ordered(
    grays: Any,
    levels: Any,
    values: Any,
    thresholds: Any,
    place: tuple[int, int],
    hold: cython.int,
) -> None:
    """Take the whole part of each gray's value plus the threshold of its place.

    Parameters
    ----------
    grays : (height, width) uint8
    levels : (height, width) uint8
        Where the levels go; before, the picture that was there.
    values : (256,) int32
        What each gray is, in levels of which each has `ONE` parts.
    thresholds : (side, side) int32
        0 ... `ONE` - 1, repeated over the plane.
    place : tuple of int
        Where the first pixel lies in that plane: x and y, 0 or more.
    hold : int
        By how many parts of a level, at most, a value may leave the level that was there, which stays; 0 for none.
    """
    source: cython.const[cython.uchar][:, :] = memoryview(grays)  # type: ignore[valid-type]
    target: cython.uchar[:, :] = memoryview(levels)
    value: cython.const[cython.int][::1] = memoryview(values)  # type: ignore[valid-type]
    matrix: cython.const[cython.int][:, ::1] = memoryview(thresholds)  # type: ignore[valid-type]
    side: cython.Py_ssize_t = thresholds.shape[0]
    height: cython.Py_ssize_t = grays.shape[0]
    width: cython.Py_ssize_t = grays.shape[1]
    left: cython.Py_ssize_t = place[0]
    top: cython.Py_ssize_t = place[1]
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    i: cython.Py_ssize_t
    j: cython.Py_ssize_t
    k: cython.Py_ssize_t
    exact: cython.int
    found: cython.int
    reach: cython.int
    kept: cython.int
    above: cython.int
    for y in range(height):
        j = (top + y) % side
        i = left % side
        if hold == 0:
            x = 0
            while x < width:
                # As far as the matrix goes: without looking each time whether it is at its end.
                for k in range(min(side - i, width - x)):
                    target[y, x + k] = (value[source[y, x + k]] + matrix[j, i + k]) >> 20
                x += side - i
                i = 0
            continue
        for x in range(width):
            exact = value[source[y, x]]
            found = exact + matrix[j, i]
            # Less near a level, which is held by itself: white is white.
            reach = min(hold, exact & (_ONE - 1), _ONE - (exact & (_ONE - 1)))
            kept = target[y, x] * _ONE
            # One comparison for both ends: what is below the lower one is a very large number.
            above = (found - kept + reach) & 0x7FFFFFFF
            target[y, x] = (kept if above < _ONE + 2 * reach else found) >> 20
            i += 1
            if i == side:
                i = 0


def diffuse(grays: Any, levels: Any, values: Any, max_level: cython.int) -> None:
    """Floyd and Steinberg's error diffusion: 7/16 of a pixel's error right, 3/16, 5/16 and 1/16 below.

    Parameters
    ----------
    grays : (height, width) uint8
    levels : (height, width) uint8
        Where the levels go.
    values : (256,) float
        What each gray is in levels.
    max_level : int
    """
    source: cython.const[cython.uchar][:, :] = memoryview(grays)  # type: ignore[valid-type]
    target: cython.uchar[:, :] = memoryview(levels)
    value: cython.const[cython.double][::1] = memoryview(values)  # type: ignore[valid-type]
    height: cython.Py_ssize_t = grays.shape[0]
    width: cython.Py_ssize_t = grays.shape[1]
    # What the row above hands to pixel x - 1 of this one, and then this one to that below.
    nothing: Any = np.zeros(width + 1)
    carried: cython.double[::1] = memoryview(nothing)
    x: cython.Py_ssize_t
    y: cython.Py_ssize_t
    level: cython.long
    wanted: cython.double
    error: cython.double
    right: cython.double
    # What goes to the pixel below the last one so far, and what to the one below this.
    pending: cython.double
    ahead: cython.double
    for y in range(height):
        right = pending = ahead = 0.0
        for x in range(width):
            wanted = value[source[y, x]] + carried[x + 1] + right
            level = min(max(cut_off(wanted + 0.5), 0), max_level)
            target[y, x] = level
            error = wanted - level
            right = error * 0.4375
            carried[x] = pending + error * 0.1875
            pending = ahead + error * 0.3125
            ahead = error * 0.0625
        carried[width] = pending
