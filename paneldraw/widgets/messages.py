"""Text that comes and goes: toast, marquee, log."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from paneldraw import text
from paneldraw.widgets.widget import Widget, finite, fitted, share_of, width_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from paneldraw import Framebuffer


@dataclass(frozen=True, slots=True, eq=False)
class Toast(Widget):
    """A message in a frame, over the lower part of a picture.

    Attributes
    ----------
    text : str
        One or more lines.
    share : float
        How far it is in sight: 0 is below the rectangle, 1 at its place.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Toast
    >>> fb = Framebuffer(128, 64)
    >>> Toast("Saved").draw(fb)
    """

    text: str
    share: float = 1.0

    @property
    def size(self) -> tuple[int, int]:
        lines = self.text.split("\n")
        return max(width_of(line, self._font) for line in lines) + 10, len(lines) * self._font.height + 8

    def _paint(self, fb: Framebuffer, c: int) -> None:
        font = self._font
        across, down = self.size
        w, h = min(across, fb.width), min(down, fb.height)
        margin = 2 if fb.height >= h + 8 else 0
        x = (fb.width - w) // 2
        y = fb.height - round((h + margin) * share_of(self.share))
        fb.round_rect(x, y, w, h, 4, 0, fill=True)
        if min(w, h) > 4:
            fb.round_rect(x + 1, y + 1, w - 2, h - 2, 3, c)
        top = y + max(4 - (down - h) // 2, 2)
        with fb.clip(x + 2, y + 2, max(w - 4, 0), max(h - 4, 0)):
            for number, line in enumerate(self.text.split("\n")):
                place = x + (w - 1) // 2, top + number * font.height
                fb.text(fitted(line, w - 6, font), *place, c, font=font, anchor="mt")


@dataclass(frozen=True, slots=True, eq=False)
class Marquee(Widget):
    """A line of text; where it is wider than its rectangle it runs through it, around and around.

    Attributes
    ----------
    text : str
    t : float
        Seconds; it starts with the first letter at the left.
    speed : float
        Pixels a second.
    gap : int
        Pixels from its end to its next beginning.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Marquee
    >>> fb = Framebuffer(64, 8)
    >>> Marquee("Trains leave from platform 4", t=1.5).draw(fb)
    """

    text: str
    t: float = 0.0
    speed: float = 30.0
    gap: int = 24

    _stretches: ClassVar = (True, False)

    @property
    def size(self) -> tuple[int, int]:
        return width_of(self.text, self._font), self._font.height

    def _paint(self, fb: Framebuffer, c: int) -> None:
        font = self._font
        line = text.Marquee(self.text, fb.width, font=font, speed=1, pause=0, gap=max(self.gap, 1))
        line.draw(fb, 0, (fb.height - font.height) // 2, c, t=finite(self.t * self.speed))


@dataclass(frozen=True, slots=True, eq=False)
class Log(Widget):
    """The last lines that fit, so that they scroll up as new ones are added; long ones take several rows.

    Attributes
    ----------
    lines : sequence of str
        A list or ``deque(maxlen=100)`` that the script adds to.
    back : int
        How many rows before the last ones to show.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Log
    >>> lines = ["connected"]
    >>> log = Log(lines)
    >>> lines.append("3 files received")
    >>> fb = Framebuffer(128, 64)
    >>> log.draw(fb)
    """

    lines: Sequence[str]
    back: int = 0

    @property
    def size(self) -> tuple[int, int]:
        across = max((width_of(line, self._font) for line in self.lines), default=0)
        return across, len(self.lines) * self._font.height

    def _paint(self, fb: Framebuffer, c: int) -> None:
        font = self._font
        wanted = max(fb.height // font.height, 1)
        back = max(self.back, 0)
        rows: list[str] = []
        for line in reversed(self.lines):
            rows[:0] = text.wrap(line, fb.width, font)
            if len(rows) >= wanted + back:
                break
        end = max(len(rows) - back, min(wanted, len(rows)))
        for number, row in enumerate(rows[max(end - wanted, 0) : end]):
            fb.text(row, 0, number * font.height, c, font=font)
