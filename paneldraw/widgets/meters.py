"""One value, shown: progress bar, gauge, number with its unit, battery, signal."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

from paneldraw.text import Font
from paneldraw.widgets.axis import ticks
from paneldraw.widgets.widget import Widget, dim, fitted, largest, share_of, width_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from paneldraw import Framebuffer

_SWEEP = 240
"""Degrees of a gauge from its lowest to its highest value; it opens downward."""
_START = 270 - _SWEEP / 2


@dataclass(frozen=True, slots=True, eq=False)
class ProgressBar(Widget):
    """A bar that fills from the left, with a label where there is room for one.

    Attributes
    ----------
    share : float
        How much is done, 0 ... 1.
    label : str, optional
        What stands in the middle of it, light on dark and dark on light; ``"{:.0%}"`` is the share itself.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import ProgressBar
    >>> fb = Framebuffer(16, 7)
    >>> ProgressBar(0.5).draw(fb)
    >>> print(fb)
    ################
    #..............#
    #.######.......#
    #.######.......#
    #.######.......#
    #..............#
    ################
    """

    share: float
    label: str = ""

    _stretches: ClassVar = (True, False)

    @property
    def size(self) -> tuple[int, int]:
        if not self.label:
            return 8, 7
        return width_of(self._text, self._font) + 8, self._font.height + 4

    @property
    def _text(self) -> str:
        return self.label.format(share_of(self.share))

    def _paint(self, fb: Framebuffer, c: int) -> None:
        border = 2 if min(fb.width, fb.height) >= 5 else 0
        if border:
            fb.rect(0, 0, fb.width, fb.height, c)
        room = fb.width - 2 * border
        done = round(room * share_of(self.share))
        fb.rect(border, border, done, fb.height - 2 * border, c, fill=True)
        if not self.label or fb.height < self._font.baseline + 1 + border:
            return
        text = fitted(self._text, room - 2, self._font)
        place = ((fb.width - 1) // 2, (fb.height - self._font.baseline - 1) // 2 + self._font.baseline)
        for x, w, level in (border, done, 0), (border + done, room - done, c):
            with fb.clip(x, 1, w, fb.height - 2):
                fb.text(text, *place, level, font=self._font, anchor="ms")


@dataclass(frozen=True, slots=True, eq=False)
class Gauge(Widget):
    """A dial, and in its middle the value.

    Attributes
    ----------
    value : float
    low, high : float
        Where the dial begins and ends.
    unit : str
        What stands below the value.
    needle : bool
        Whether a needle points to the value, along a scale, instead of a thick arc that ends there.
    form : str
        How the value is written, as for `format`.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Gauge
    >>> fb = Framebuffer(64, 48, depth=4)
    >>> Gauge(21.5, 0, 40, unit="°C", form=".1f").draw(fb)
    """

    value: float
    low: float = 0.0
    high: float = 100.0
    unit: str = ""
    needle: bool = False
    form: str = ".0f"

    @property
    def size(self) -> tuple[int, int]:
        text = max(width_of(format(self.value, self.form), self._font), width_of(self.unit, self._font))
        radius = max(text // 2 + 8, 2 * self._font.height)
        return 2 * radius + 1, radius + math.ceil(radius / 2) + 1

    def _paint(self, fb: Framebuffer, c: int) -> None:
        # The dial reaches half a radius below its center, where it opens.
        radius = math.floor(min((fb.width - 1) / 2, (fb.height - 1) / 1.5))
        if radius < 3:
            return
        dial = _Dial(fb, (fb.width - 1) / 2, round((fb.height - 1 + radius / 2) / 2), radius)
        degrees = _START + _SWEEP * share_of(self.value, self.low, self.high)
        if self.needle:
            marks = [_START + _SWEEP * share_of(mark, self.low, self.high) for mark in ticks(self.low, self.high, 6)]
            dial.scale(marks, c)
            dial.needle(degrees, c)
            self._write_below(dial, c)
        else:
            dial.track(c)
            if degrees > _START:
                dial.fill(degrees, c)
            self._write_within(dial, c)

    def _write_below(self, dial: _Dial, c: int) -> None:
        """Write value and unit, or the value alone, where the dial is open."""
        fb, font = dial.fb, self._font
        value = format(self.value, self.form)
        for text in (f"{value} {self.unit}", value):
            if width_of(text, font) <= 1.2 * dial.radius and dial.radius >= 3 * font.height:
                fb.text(text, dial.x, fb.height - 1, c, font=font, anchor="mb")
                return

    def _write_within(self, dial: _Dial, c: int) -> None:
        """Write the value as large as it fits, and below it the unit, if there is room for that."""
        fb, small, radius = dial.fb, self._font, dial.radius - dial.thickness
        text = format(self.value, self.form)
        if width_of(text, small) > 2 * radius - 2 or radius < small.height - 1:
            return
        room = 2 * (fb.height - 1 - dial.y - small.baseline - 2)
        unit = fitted(self.unit, 2 * radius - 2, small) if room >= small.height else ""
        font = largest(text, 2 * radius - max(radius // 3, 4), min(radius, room) if unit else radius, small)
        fb.text(text, dial.x, dial.y, c, font=font, anchor="mm")
        fb.text(unit, dial.x, dial.y + font.height // 2 + 2, c, font=small, anchor="mt")


class _Dial(NamedTuple):
    """Where a gauge's dial is, and its parts."""

    fb: Framebuffer
    x: float
    y: int
    radius: int

    @property
    def thickness(self) -> int:
        return max(self.radius // 5, 2)

    @property
    def stroke(self) -> int:
        """Length of the strokes of the scale."""
        return max(self.radius // 6, 2)

    def ray(self, degrees: float, start: float, end: float, c: int, width: int = 1) -> None:
        """Draw a line along a direction, from and to a distance from the center."""
        dx, dy = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        self.fb.line(self.x + start * dx, self.y + start * dy, self.x + end * dx, self.y + end * dy, c, width=width)

    def track(self, c: int) -> None:
        """Draw the whole arc: dimly, or where there are no grays, its outline."""
        if self.fb.max_level > 1:
            self.fill(_START + _SWEEP, dim(self.fb, c))
            return
        inner = self.radius - self.thickness
        for radius in (inner, self.radius):
            self.fb.arc(self.x, self.y, radius, _START, _START + _SWEEP, c)
        for degrees in (_START, _START + _SWEEP):
            self.ray(degrees, inner, self.radius, c)

    def fill(self, degrees: float, c: int) -> None:
        """Draw the thick arc up to an angle."""
        self.fb.arc(self.x, self.y, self.radius - self.thickness / 2, _START, degrees, c, width=self.thickness)

    def scale(self, marks: Sequence[float], c: int) -> None:
        """Draw a thin arc with strokes at angles."""
        self.fb.arc(self.x, self.y, self.radius, _START, _START + _SWEEP, dim(self.fb, c))
        for degrees in marks:
            self.ray(degrees, self.radius - self.stroke, self.radius, c)

    def needle(self, degrees: float, c: int) -> None:
        """Draw the needle and its hub."""
        self.ray(degrees, 0, self.radius - self.stroke - 2, c, width=max(self.radius // 14, 1))
        self.fb.circle(self.x, self.y, max(self.radius // 10, 1), c, fill=True)


@dataclass(frozen=True, slots=True, eq=False)
class Number(Widget):
    """A number as large as fits, its unit beside it, and above, where there is room, what it is.

    Without a `font`, it is written in the built-in ``"numbers"`` or ``"segments"``, or in the default one where those
    have no room.

    Attributes
    ----------
    value : float or str
        The number, or what stands in its place, such as ``"--"``.
    unit, label : str
    form : str
        How the number is written, as for `format`.
    segments : bool
        Whether its digits are those of a seven-segment display, where they have room.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Number
    >>> fb = Framebuffer(64, 32)
    >>> Number(21.5, "°C", "inside").draw(fb)
    """

    value: float | str
    unit: str = ""
    label: str = ""
    form: str = ".1f"
    segments: bool = False

    @property
    def size(self) -> tuple[int, int]:
        font = self._font
        beside = width_of(self.unit, font) + 2 if self.unit else 0
        across = max(width_of(self._text, font) + beside, width_of(self.label, font))
        return across, font.height * (2 if self.label else 1)

    @property
    def _text(self) -> str:
        return self.value if isinstance(self.value, str) else format(self.value, self.form)

    def _paint(self, fb: Framebuffer, c: int) -> None:
        small = self._font
        top = small.height + 1 if self.label and fb.height >= 2 * small.height else 0
        beside = width_of(self.unit, small) + 2 if self.unit else 0
        if beside and width_of(self._text, small) + beside > fb.width:
            beside = 0
        font = self._large(fb.width - beside, fb.height - top)
        text = fitted(self._text, fb.width, font)
        across = width_of(text, font)
        left = max((fb.width - across - beside) // 2, 0)
        base = top + (fb.height - top - (font.baseline + 1)) // 2 + font.baseline
        if top:
            fb.text(fitted(self.label, fb.width, small), (fb.width - 1) // 2, 0, c, font=small, anchor="mt")
        fb.text(text, left, base, c, font=font, anchor="ls")
        if beside:
            # Beside a large number the unit hangs from its top, as on an instrument.
            above = base - font.baseline + small.baseline
            fb.text(self.unit, left + across + 2, above, c, font=small, anchor="ls")

    def _large(self, width: int, height: int) -> Font:
        """The font that the number is written in, as large as fits."""
        digits = Font.builtin("segments" if self.segments else "numbers")
        if self.font is None and width_of(self._text, digits) <= width and digits.height <= height + 1:
            return largest(self._text, width, height, digits)
        return largest(self._text, width, height, self._font)


@dataclass(frozen=True, slots=True, eq=False)
class Battery(Widget):
    """A battery, as full as it is.

    Attributes
    ----------
    share : float
        0 ... 1.
    charging : bool
        Whether a flash stands on it.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Battery
    >>> fb = Framebuffer(15, 8)
    >>> Battery(0.5).draw(fb)
    >>> print(fb)
    #############..
    #...........#..
    #.####......###
    #.####......###
    #.####......###
    #.####......###
    #...........#..
    #############..
    """

    share: float
    charging: bool = False

    _stretches: ClassVar = (False, False)

    @property
    def size(self) -> tuple[int, int]:
        return 15, 8

    def _paint(self, fb: Framebuffer, c: int) -> None:
        knob = max(fb.width // 7, 1)
        body, height = fb.width - knob, fb.height
        fb.rect(0, 0, body, height, c)
        knob_height = max(height // 2, 1)
        fb.rect(body - 1, (height - knob_height) // 2, knob + 1, knob_height, c, fill=True)
        gap = 2 if min(body, height) >= 6 else 1
        room = max(body - 2 * gap, 0)
        fb.rect(gap, gap, round(room * share_of(self.share)), max(height - 2 * gap, 0), c, fill=True)
        if self.charging:
            _flash(fb, body, height, c)


def _flash(fb: Framebuffer, w: int, h: int, c: int) -> None:
    """A flash in a battery's middle, with a dark rim."""
    x, y, a, b = (w - 1) / 2, (h - 1) / 2, max(w / 5, 2), h / 2 - 1
    corners = [x + a / 3, y - b, x - a, y + b / 4, x, y + b / 4, x - a / 3, y + b, x + a, y - b / 4, x, y - b / 4]
    fb.poly(0, 0, corners, 0, width=3, join="round")
    fb.poly(0, 0, corners, c, fill=True)


@dataclass(frozen=True, slots=True, eq=False)
class Signal(Widget):
    """Bars that say how strong a signal is.

    Attributes
    ----------
    share : float
        0 ... 1.
    bars : int
        How many there are.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Signal
    >>> fb = Framebuffer(11, 8)
    >>> Signal(0.7).draw(fb)
    >>> print(fb)
    ...........
    ...........
    ......##...
    ......##...
    ...##.##...
    ...##.##...
    ##.##.##...
    ##.##.##.##
    """

    share: float
    bars: int = 4

    _stretches: ClassVar = (False, False)

    @property
    def size(self) -> tuple[int, int]:
        return 3 * max(self.bars, 1) - 1, 8

    def _paint(self, fb: Framebuffer, c: int) -> None:
        bars = min(max(self.bars, 1), fb.width)
        lit = math.ceil(bars * share_of(self.share) - 1e-9)
        for bar in range(bars):
            left, right = (fb.width + 1) * bar // bars, (fb.width + 1) * (bar + 1) // bars - 1
            height = max(round(fb.height * (bar + 1) / bars), 1)
            w = max(right - left, 1)
            if bar < lit:
                fb.rect(left, fb.height - height, w, height, c, fill=True)
            else:
                fb.hline(left, fb.height - 1, w, dim(fb, c))
