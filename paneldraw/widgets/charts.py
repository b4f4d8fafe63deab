"""Many values, shown: sparkline, bars, and a line chart with axes."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from paneldraw.widgets.axis import label, nice, ticks
from paneldraw.widgets.widget import Widget, dim, fitted, share_of, width_of

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from numpy.typing import ArrayLike, NDArray

    from paneldraw import Framebuffer

    Numbers = ArrayLike | Collection[float]

_MARKS: Final = 5
"""About how many round numbers a vertical axis has."""

_LARGE: Final = 1e150
"""What is larger counts as this, so that no difference of two numbers is too large for a float."""


def _numbers(values: Numbers) -> NDArray[np.float64]:
    """Values as an array of finite numbers and of NaN for what is missing."""
    given: Any = values
    numbers: NDArray[np.float64] = np.asarray(given if hasattr(given, "__getitem__") else list(given), np.float64)
    return np.clip(numbers, -_LARGE, _LARGE)


def _range(values: NDArray[np.float64], low: float | None, high: float | None) -> tuple[float, float]:
    """The values that stand for the lowest and the topmost row; they differ."""
    bottom = float(np.fmin.reduce(values, axis=None, initial=_LARGE))
    top = float(np.fmax.reduce(values, axis=None, initial=-_LARGE))
    if bottom > top:
        bottom, top = 0.0, 1.0
    if low is not None:
        bottom = _bounded(low, bottom)
        top = max(top, bottom)
    if high is not None:
        top = _bounded(high, top)
        bottom = min(bottom, top) if low is None else bottom
    if abs(top - bottom) <= max(1e-12 * max(abs(top), abs(bottom)), 1 / _LARGE):
        middle = abs(bottom) / 2 if abs(bottom) > 1 / _LARGE else 0.5
        return bottom - middle, bottom + middle
    return bottom, top


def _bounded(number: float, instead: float) -> float:
    return instead if number != number else min(max(float(number), -_LARGE), _LARGE)


def _spread(values: NDArray[np.float64], low: float, high: float, first: float, last: float) -> NDArray[np.float64]:
    """Where values lie on the way from pixel `first`, which stands for `low`, to pixel `last`; nothing lies beyond."""
    return np.minimum(np.maximum((values - low) / (high - low), 0), 1) * (last - first) + first


def _curve(fb: Framebuffer, xs: NDArray[np.float64], ys: NDArray[np.float64], c: int, **options: Any) -> None:
    """Draw a line through points, with gaps where one is missing."""
    there = np.isfinite(xs) & np.isfinite(ys)
    points = np.column_stack((xs, ys))
    if there.all():
        fb.polyline(points, c, **options)
        return
    edges = np.flatnonzero(np.diff(there.astype(np.int8), prepend=0, append=0))
    for start, end in zip(edges[::2], edges[1::2], strict=True):
        fb.polyline(points[start:end], c, **options)


@dataclass(frozen=True, slots=True, eq=False)
class Sparkline(Widget):
    """A line through values, as wide and high as the rectangle, and a dot at the last one.

    Attributes
    ----------
    values : array_like
        Numbers; NaN leaves a gap. Of more than there are columns, the last ones count: one a column.
    low, high : float, optional
        What the lowest and the topmost row stand for. Default: the lowest and the highest value.
    fill : bool
        Whether the area below the line is shaded.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Sparkline
    >>> fb = Framebuffer(9, 4)
    >>> Sparkline([0, 1, 2, 3, 2, 1, 0, 1, 3]).draw(fb)
    >>> print(fb)
    ...#...##
    ..#.#..##
    .#...#.#.
    #.....#..
    """

    values: Numbers
    low: float | None = None
    high: float | None = None
    fill: bool = False

    @property
    def size(self) -> tuple[int, int]:
        return max(min(_numbers(self.values).size, 64), 1), self._font.height

    def _paint(self, fb: Framebuffer, c: int) -> None:
        values = _numbers(self.values).ravel()[-fb.width :]
        if not values.size:
            return
        low, high = _range(values, self.low, self.high)
        ys = _spread(values, low, high, fb.height - 1, 0)
        xs = np.linspace(0, fb.width - 1, values.size) if values.size > 1 else np.array([fb.width - 1.0])
        if self.fill:
            _area(fb, xs, ys, c)
        _curve(fb, xs, ys, c)
        if np.isfinite(ys[-1]) and min(fb.width, fb.height) >= 4:
            fb.rect(fb.width - 2, min(max(round(ys[-1]) - 1, 0), fb.height - 2), 2, 2, c, fill=True)


def _area(
    fb: Framebuffer, xs: NDArray[np.float64], ys: NDArray[np.float64], c: int, left: int = 0, bottom: int | None = None
) -> None:
    """Shade what lies below a line, down to the row `bottom`: with a dim level, or with every fourth pixel."""
    there = np.isfinite(xs) & np.isfinite(ys)
    if not there.any():
        return
    end = fb.height - 1 if bottom is None else bottom
    top, level = int(ys[there].min()), dim(fb, c)
    line = np.interp(np.arange(left, int(xs[there].max()) + 1), xs[there], ys[there])
    shaded = np.arange(top, end + 1)[:, None] > line
    if fb.max_level == 1:
        whole, shaded = shaded, np.zeros_like(shaded)
        for row in (0, 2):
            fourths = np.s_[(row - top) % 4 :: 4, (row - left) % 4 :: 4]
            shaded[fourths] = whole[fourths]
    # Of two levels that differ in their last bit, the one that is not painted is the key.
    key = level ^ 1
    fb.blit(shaded.view(np.uint8) ^ np.uint8(key), left, top, key)


@dataclass(frozen=True, slots=True, eq=False)
class Bars(Widget):
    """A bar for each value, side by side, with their names below where there is room.

    Attributes
    ----------
    values : array_like
        Numbers. Where there are more than columns, the highest of those that share a column counts.
    labels : sequence of str
    low, high : float, optional
        What the lowest and the topmost row stand for. Default: 0 or the lowest value, and the highest.
    caps : array_like, optional
        Values that a short line stands at, above each bar.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Bars
    >>> fb = Framebuffer(11, 5)
    >>> Bars([1, 3, 5, 2]).draw(fb)
    >>> print(fb)
    ......##...
    ......##...
    ...##.##...
    ...##.##.##
    ##.##.##.##
    """

    values: Numbers
    labels: Sequence[str] = ()
    low: float | None = None
    high: float | None = None
    caps: Numbers | None = None

    @property
    def size(self) -> tuple[int, int]:
        count = max(_numbers(self.values).size, 1)
        across = max((width_of(text, self._font) + 2 for text in self.labels), default=3)
        return count * across - 1, self._font.height * (2 if self.labels else 1)

    def _paint(self, fb: Framebuffer, c: int) -> None:
        values = _folded(_numbers(self.values).ravel(), (fb.width + 1) // 2 if fb.width > 2 else 1)
        if not values.size:
            return
        font = self._font
        bottom = fb.height - (font.height + 1 if self.labels and fb.height >= 2 * font.height else 0)
        caps = None if self.caps is None else _folded(_numbers(self.caps).ravel(), values.size)
        low, high = _range(np.append(values, [] if caps is None else caps), self.low, self.high)
        if self.low is None and high > 0:
            low = min(low, 0.0)
        if self.high is None and low < 0:
            high = max(high, 0.0)
        edges = ((fb.width + 1) * np.arange(values.size + 1) // values.size).tolist()
        base = float(_spread(np.zeros(1), low, high, bottom, 0)[0].round())
        ends = _spread(values, low, high, bottom, 0).round()
        for left, right, end in zip(edges, edges[1:], ends.tolist(), strict=False):
            if np.isfinite(end):
                fb.rect(left, min(base, end), max(right - left - 1, 1), abs(base - end), c, fill=True)
        for left, right, cap in zip(edges, edges[1:], [] if caps is None else caps.tolist(), strict=False):
            if np.isfinite(cap):
                fb.hline(left, float(_spread(cap, low, high, bottom - 1, 0)), max(right - left - 1, 1), c)
        if bottom < fb.height:
            for left, right, text in zip(edges, edges[1:], self.labels, strict=False):
                text = fitted(text, right - left - 1, font)
                fb.text(text, left + (right - left - 2) // 2, bottom + 1, c, font=font, anchor="mt")


def _folded(values: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Values, of more than `most` the highest of each group of neighbors."""
    if values.size <= most:
        return values
    folded: NDArray[np.float64] = np.fmax.reduceat(values, values.size * np.arange(most) // most)
    return folded


@dataclass(frozen=True, slots=True, eq=False)
class Chart(Widget):
    """A line chart; its axes choose round numbers, and leave them out where there is no room.

    Attributes
    ----------
    values : array_like
        Numbers, or several series of them, shape (series, n); NaN leaves a gap. The first series is drawn brightest;
        on one bit a pixel, further ones are dashed.
    xs : array_like, optional
        Where each value lies on the horizontal axis, rising. Default: evenly, and the axis has no numbers.
    low, high : float, optional
        The ends of the vertical axis. Default: round numbers beyond the values.
    grid : bool
        Whether dotted lines lead from the numbers across.
    fill : bool
        Whether the area below the first series is shaded.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Chart
    >>> fb = Framebuffer(128, 64)
    >>> Chart([18.2, 18.9, 21.4, 23.0, 22.1, 19.5], xs=[6, 9, 12, 15, 18, 21]).draw(fb)
    """

    values: Numbers
    xs: Numbers | None = None
    low: float | None = None
    high: float | None = None
    grid: bool = False
    fill: bool = False

    @property
    def size(self) -> tuple[int, int]:
        return 8 * self._font.width + 4, 5 * self._font.height

    def _paint(self, fb: Framebuffer, c: int) -> None:
        series = np.atleast_2d(_numbers(self.values))
        if not series.size:
            return
        xs = np.arange(series.shape[1], dtype=np.float64) if self.xs is None else _numbers(self.xs).ravel()
        count = min(xs.size, series.shape[1])
        series, xs = series[:, :count], xs[:count]
        font = self._font
        bottom = fb.height - 1
        if min(fb.width, fb.height) >= 12:
            bottom -= font.height + 3 if self.xs is not None and fb.height >= 4 * font.height - 4 else 2
        vertical, ends = self._vertical(series), _range(xs, None, None)
        left = 0
        if min(fb.width, fb.height) >= 12:
            left = self._draw_vertical(fb, vertical, bottom, c)
            self._draw_horizontal(fb, ends, left, bottom, c)
        first = left + 1 if left else 0
        across = _spread(xs, *ends, first, fb.width - 1)
        rows = _spread(series, vertical.low, vertical.high, bottom - (1 if left else 0), 0)
        if self.fill:
            _area(fb, across, rows[0], c, first, bottom)
        for number in range(len(rows) - 1, -1, -1):
            behind = {"dash": (3, 2)} if number and fb.max_level == 1 else {}
            _curve(fb, across, rows[number], dim(fb, c) if number else c, **behind)

    def _vertical(self, series: NDArray[np.float64]) -> _Axis:
        low, high = _range(series, self.low, self.high)
        step = nice(abs(high - low) / (_MARKS - 1))
        if self.low is None and low < high:
            low = math.floor(low / step + 1e-9) * step
        if self.high is None and low < high:
            high = math.ceil(high / step - 1e-9) * step
        return _axis(low, high, _MARKS + 1)

    def _draw_vertical(self, fb: Framebuffer, axis: _Axis, bottom: int, c: int) -> int:
        """Draw the vertical axis, down to a row, and its numbers where there is room; return its column."""
        font = self._font
        texts = axis.texts
        left = max((width_of(text, font) for text in texts), default=0) + 4
        if 2 * left > fb.width or bottom < font.height:
            left, texts = 2, ()
        quiet = dim(fb, c)
        fb.vline(left, 0, bottom + 1, quiet)
        rows = [axis.place(mark, bottom, 0) for mark in axis.marks]
        for row in rows:
            fb.hline(left - 2, row, 2, quiet)
            if self.grid and row < bottom:
                fb.line(left + 4, row, fb.width - 1, row, quiet, dash=(1, 3), antialias=None)
        # Where not every number has room, those at both ends have.
        every = 1 if (len(rows) - 1) * (font.height + 2) <= bottom else max(len(rows) - 1, 1)
        for row, text in list(zip(rows, texts, strict=False))[::every]:
            above = min(max(row - font.baseline // 2, 0), bottom - font.baseline)
            fb.text(text, left - 4, above, c, font=font, anchor="rt")
        return left

    def _draw_horizontal(self, fb: Framebuffer, ends: tuple[float, float], left: int, bottom: int, c: int) -> None:
        """Draw the horizontal axis in a row, and below it as many numbers as have room."""
        font = self._font
        fb.hline(left, bottom, fb.width - left, dim(fb, c))
        has_numbers = self.xs is not None and bottom + font.height < fb.height
        axis = _axis(*ends, max((fb.width - left) // (2 * font.width), 2))
        while (
            len(axis.marks) > 2 and sum(width_of(text, font) + 2 * font.width for text in axis.texts) > fb.width - left
        ):
            axis = _axis(*ends, len(axis.marks) - 1)
        for mark, text in zip(axis.marks, axis.texts, strict=True):
            column = axis.place(mark, left + 1, fb.width - 1)
            fb.vline(column, bottom + 1, 2, dim(fb, c))
            if has_numbers:
                across = width_of(text, font)
                fb.text(text, min(max(column - across // 2, left - 1), fb.width - across), bottom + 3, c, font=font)


class _Axis(NamedTuple):
    """The values at both ends, and the round numbers between them."""

    low: float
    high: float
    marks: tuple[float, ...]
    texts: tuple[str, ...]

    def place(self, mark: float, first: int, last: int) -> int:
        """The pixel of a round number, on the way from pixel `first` to pixel `last`."""
        return round(share_of(mark, self.low, self.high) * (last - first) + first)


@functools.lru_cache(64)
def _axis(low: float, high: float, most: int) -> _Axis:
    marks = tuple(ticks(low, high, most))
    step = marks[1] - marks[0] if len(marks) > 1 else 0.0
    return _Axis(low, high, marks, tuple(label(mark, step) for mark in marks))
