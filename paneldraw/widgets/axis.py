"""Round numbers along an axis."""

from __future__ import annotations

import math
from typing import Final

_STEPS: Final = (1.0, 2.0, 5.0, 10.0)
_PREFIXES: Final = ((1e12, "T"), (1e9, "G"), (1e6, "M"), (1e3, "k"))


def ticks(low: float, high: float, most: int = 5) -> list[float]:
    """Return round numbers from `low` to `high`, evenly spaced: 1, 2 or 5 times a power of ten apart.

    Parameters
    ----------
    low, high : float
        Both ends, in either order.
    most : int, default 5
        How many there may be; there are as many as their distance lets be, and none where no round number lies
        between the ends.

    Notes
    -----
    Paul S. Heckbert, "Nice numbers for graph labels", Graphics Gems (1990), 61-63.

    Examples
    --------
    >>> from paneldraw.widgets import ticks
    >>> ticks(3, 41)
    [10.0, 20.0, 30.0, 40.0]
    >>> ticks(-0.2, 0.3, 6)
    [-0.2, -0.1, 0.0, 0.1, 0.2, 0.3]
    """
    low, high = min(low, high), max(low, high)
    span = high - low
    if most < 1 or not math.isfinite(span):
        return []
    if span <= max(abs(low), abs(high)) * 1e-12 or span < 1e-300:
        return [low]
    step = nice(span / (most + 1))
    first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    while last - first + 1 > most:
        step = nice(step * 1.1)
        first, last = math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9)
    digits = max(-math.floor(math.log10(step) + 1e-9), 0)
    # Rounded to the step's own place, 0.1 + 0.2 is 0.3; beyond what round() takes there is nothing to mend.
    return [round(number * step, digits) + 0.0 if digits < 300 else number * step for number in range(first, last + 1)]


def nice(number: float) -> float:
    """Return the smallest of 1, 2 and 5 times a power of ten that is not below a positive number.

    Examples
    --------
    >>> nice(0.03)
    0.05
    """
    power = 10.0 ** math.floor(math.log10(number))
    return next((step * power for step in _STEPS if step * power >= number * (1 - 1e-9)), 10 * power)


def label(value: float, step: float) -> str:
    """Return a tick's number, as short as the distance to the next one, 0 if there is none, lets it be.

    Examples
    --------
    >>> label(0.5, 0.05), label(30, 10), label(15000, 5000)
    ('0.50', '30', '15k')
    """
    size = max(abs(value), abs(step))
    if not 1e-4 <= size < 1e15:
        return f"{value:.3g}"
    if size >= 1e3:
        for factor, prefix in _PREFIXES:
            if abs(value) >= 10 * factor or abs(step) >= factor:
                return label(value / factor, step / factor) + prefix if value else "0"
    if not step:
        return f"{value:.4g}"
    digits = max(-math.floor(math.log10(abs(step)) + 1e-9), 0)
    return f"{value:.{min(digits, 6)}f}"
