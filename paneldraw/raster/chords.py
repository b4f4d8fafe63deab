# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""How wide an ellipse is at a given height, exactly."""

from __future__ import annotations

import cython

if cython.compiled:
    from cython.cimports.libc.math import floor, sqrt
else:
    from math import floor, sqrt


@cython.cfunc
@cython.inline
@cython.nogil
@cython.exceptval(check=False)
def chord(a: cython.longlong, b: cython.longlong, y: cython.longlong) -> cython.longlong:
    """Floor plus ceiling of how far the ellipse reaches to each side at height `y`; radii below 2**26.

    A root in floating point is exact where the argument is a whole number below 2**52 and its floor is asked for. The
    product with a / b may be off by less than 2**-24: close to a whole number the squares are compared.
    """
    if y == 0:
        return 2 * a
    squared: cython.longlong = b * b - y * y
    whole: cython.longlong
    if a == b:
        whole = cython.cast(cython.longlong, floor(sqrt(squared)))
        return 2 * whole + (whole * whole != squared)
    reach: cython.double = a * sqrt(squared) / b
    whole = cython.cast(cython.longlong, floor(reach + 0.5))
    if abs(reach - whole) > 1e-6:
        return 2 * cython.cast(cython.longlong, floor(reach)) + 1
    return 2 * whole - compare_products(whole * b, whole * b, a * a, squared)


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def compare_products(a: cython.longlong, b: cython.longlong, c: cython.longlong, d: cython.longlong) -> cython.longlong:
    """The sign of a * b - c * d for numbers from 0 to 2**53, in digits of 26 bits."""
    one: cython.longlong = 1
    low: cython.longlong = (one << 26) - 1
    digit: cython.longlong = (a & low) * (b & low) - (c & low) * (d & low)
    rest: cython.longlong = digit & low
    digit >>= 26
    digit += (a >> 26) * (b & low) + (a & low) * (b >> 26) - (c >> 26) * (d & low) - (c & low) * (d >> 26)
    rest |= digit & low
    digit >>= 26
    digit += (a >> 26) * (b >> 26) - (c >> 26) * (d >> 26)
    return -1 if digit < 0 else 1 if digit > 0 or rest > 0 else 0
