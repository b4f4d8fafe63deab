"""What all widgets share: the rectangle that one draws itself into, levels that suit the panel, and text that fits."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from paneldraw import Framebuffer, Supersample
from paneldraw.text import Font, font_of
from paneldraw.text.box import BoxStyle, chosen

if TYPE_CHECKING:
    from paneldraw.framebuffer.arguments import Antialias

_LARGEST = 4096
"""Of a rectangle that reaches beyond the framebuffer, as many columns and rows count."""

_SMOOTH = Supersample(4)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Widget:
    """A part of a panel's face. It keeps what it shows and draws itself where it is told to.

    Attributes
    ----------
    c : int, optional
        The level that it draws with; default: the highest.
    font : Font, optional
        Default: the built-in one.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Signal, Widget
    >>> signal = Signal(0.5)
    >>> isinstance(signal, Widget), signal.size
    (True, (11, 8))
    >>> fb = Framebuffer(128, 64)
    >>> signal.draw(fb, 117, 0)
    >>> signal.draw(fb, 0, 20, 60, 40)
    """

    c: int | None = None
    font: Font | None = None

    _stretches: ClassVar[tuple[bool, bool]] = (True, True)
    """Whether it takes all the room there is, across and down, if nothing else is said."""

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels of the smallest rectangle that has room for all of it."""
        raise NotImplementedError

    def draw(self, fb: Framebuffer, x: float = 0, y: float = 0, w: float | None = None, h: float | None = None) -> None:
        """Draw it into a rectangle, over what is there, and paint nothing outside.

        Where there is too little room, less of it is drawn; where there is none, nothing. On a framebuffer of more than
        one bit a pixel its curves and slanting lines are anti-aliased.

        Parameters
        ----------
        fb : Framebuffer
            What to draw on, such as a panel's or a view of it.
        x, y : int or float
            The top-left pixel. The rectangle may reach beyond the framebuffer's edges.
        w, h : int or float, optional
            Size in pixels. Default: what `size` says, or, of a widget that grows, all from (x, y) to the edge.
        """
        left, top = _whole(x), _whole(y)
        if w is None:
            w = fb.width - left if self._stretches[0] else self.size[0]
        if h is None:
            h = fb.height - top if self._stretches[1] else self.size[1]
        width, height = min(_whole(w), _LARGEST), min(_whole(h), _LARGEST)
        if left >= fb.width or top >= fb.height or left + width <= 0 or top + height <= 0 or min(width, height) < 1:
            return
        if left >= 0 and top >= 0 and left + width <= fb.width and top + height <= fb.height:
            self._draw_on(fb.view(left, top, width, height), fb.antialias)
            return
        whole = Framebuffer(width, height, fb.depth)
        whole.blit(fb, -left, -top)
        self._draw_on(whole, fb.antialias)
        fb.blit(whole, left, top)

    def _draw_on(self, fb: Framebuffer, antialias: Antialias) -> None:
        fb.antialias = antialias or (_SMOOTH if fb.depth > 1 else None)
        self._paint(fb, fb.max_level if self.c is None else self.c)

    def _paint(self, fb: Framebuffer, c: int) -> None:
        """Draw with level `c` on a framebuffer that is all the widget's own."""
        raise NotImplementedError

    @property
    def _font(self) -> Font:
        return font_of(self.font)


def _whole(number: float) -> int:
    """The nearest whole number, of infinity one that is large enough."""
    return round(min(max(number, -1e9), 1e9))


def finite(number: float, instead: float = 0.0) -> float:
    """A number as a float, or what stands instead of one that is not finite."""
    number = float(number)
    return number if math.isfinite(number) else instead


def share_of(value: float, low: float = 0.0, high: float = 1.0) -> float:
    """How far a value is on the way from low to high: 0 ... 1, and 0 of what is no number."""
    if math.isnan(value) or math.isnan(low) or math.isnan(high) or low == high:
        return 0.0
    share = value / 2 - low / 2, high / 2 - low / 2
    if math.isinf(share[0]) or math.isinf(share[1]):
        return float(value == high or value > high)
    return min(max(share[0] / share[1], 0.0), 1.0)


def dim(fb: Framebuffer, c: int) -> int:
    """A level for what stands behind: a third of `c`, where the panel has levels between."""
    return max(c // 3, 1) if fb.max_level > 1 else c


@functools.lru_cache(256)
def width_of(text: str, font: Font) -> int:
    """Columns that a line of text takes."""
    return font.measure(text)[0]


def fitted(text: str, width: int, font: Font) -> str:
    """A line of text, cut and ended with an ellipsis where it is wider than `width`."""
    if width_of(text, font) <= width:
        return text
    return chosen(text, max(width, 1), font.height, font, BoxStyle(wrap=None))[0][0]


def largest(text: str, width: int, height: int, font: Font) -> Font:
    """The font, by as large a whole factor as lets the text fit; its own size if not even that does."""
    across, down = font.measure(text)
    return font.scaled(max(min(width // max(across, 1), (height + 1) // max(down, 1)), 1))
