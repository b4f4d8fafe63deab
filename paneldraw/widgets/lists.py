"""What there is to choose from: menu, scroll bar, tabs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from paneldraw.widgets.widget import Widget, dim, finite, fitted, share_of, width_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from paneldraw import Framebuffer


@dataclass(frozen=True, slots=True, eq=False)
class Menu(Widget):
    """Entries one below the other; the chosen one stands on a bar and is kept in sight.

    Attributes
    ----------
    entries : sequence of str or of (str, str)
        What there is; of a pair the second one is written at the right, such as a setting's value.
    chosen : int, optional
        Number of the chosen entry, from 0; default: none, and the list begins with its first entry.
    title : str
        What stands above, with a line below it.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Menu
    >>> fb = Framebuffer(128, 64)
    >>> Menu(["Brightness", ("Wi-Fi", "on"), "About"], chosen=1, title="SETTINGS").draw(fb)
    """

    entries: Sequence[str | tuple[str, str]]
    chosen: int | None = None
    title: str = ""

    @property
    def size(self) -> tuple[int, int]:
        texts = [self.title, *(entry if isinstance(entry, str) else "  ".join(entry) for entry in self.entries)]
        across = max(width_of(text, self._font) for text in texts)
        return across + 4, len(self.entries) * self._row + (self._row + 2 if self.title else 0)

    @property
    def _row(self) -> int:
        return self._font.height + 2

    def _paint(self, fb: Framebuffer, c: int) -> None:
        font, row = self._font, self._row
        top = 0
        if self.title and fb.height >= 3 * row:
            fb.text(fitted(self.title, fb.width - 2, font), 1, 0, c, font=font)
            fb.hline(0, font.height + 1, fb.width, dim(fb, c))
            top = font.height + 4
        count = len(self.entries)
        shown = max((fb.height - top + 1) // row, 1)
        chosen = None if self.chosen is None or not count else min(max(self.chosen, 0), count - 1)
        first = min(max((chosen or 0) - shown // 2, 0), max(count - shown, 0))
        room = fb.width
        if count > shown and fb.width >= 24:
            room -= 5
            ScrollBar(first, shown, count, c=c).draw(fb, fb.width - 3, top, 3, fb.height - top)
        for line, entry in enumerate(self.entries[first : first + shown]):
            is_chosen = first + line == chosen
            y = top + line * row
            if is_chosen:
                fb.rect(0, y, room, row, c, fill=True)
            self._write(fb.view(0, y, room, min(row, fb.height - y)), entry, 0 if is_chosen else c)

    def _write(self, fb: Framebuffer, entry: str | tuple[str, str], c: int) -> None:
        font = self._font
        name, value = (entry, "") if isinstance(entry, str) else entry
        room = fb.width - 3
        if value:
            value = fitted(value, max(room // 2, 1), font)
            fb.text(value, fb.width - 2, 1, c, font=font, anchor="rt")
            room -= width_of(value, font) + font.width
        if room > 0:
            fb.text(fitted(name, room, font), 2, 1, c, font=font)


@dataclass(frozen=True, slots=True, eq=False)
class ScrollBar(Widget):
    """A thin track, and on it a bar that says which part of a list is seen.

    Attributes
    ----------
    first, shown, total : float
        The first row that is seen, how many are, and how many there are.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import ScrollBar
    >>> fb = Framebuffer(3, 8)
    >>> ScrollBar(4, 4, 8).draw(fb)
    >>> print(fb)
    .#.
    .#.
    .#.
    .#.
    ###
    ###
    ###
    ###
    """

    first: float
    shown: float
    total: float

    _stretches: ClassVar = (False, True)

    @property
    def size(self) -> tuple[int, int]:
        return 3, 8

    def _paint(self, fb: Framebuffer, c: int) -> None:
        shown = max(finite(self.shown), 0.0)
        total = max(finite(self.total), shown)
        length = min(max(round(fb.height * share_of(shown, 0, total)), 2), fb.height) if total else fb.height
        start = round((fb.height - length) * share_of(self.first, 0, total - shown))
        fb.vline((fb.width - 1) // 2, 0, fb.height, dim(fb, c))
        fb.rect(0, start, fb.width, length, c, fill=True)


@dataclass(frozen=True, slots=True, eq=False)
class Tabs(Widget):
    """Names side by side above a line; the chosen one is open to what stands below.

    Where they do not all fit, the chosen one stands alone between arrows.

    Attributes
    ----------
    names : sequence of str
    chosen : int
        Number of the chosen one, from 0.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Tabs
    >>> fb = Framebuffer(128, 64)
    >>> Tabs(["Now", "Today", "Week"], chosen=1).draw(fb)
    """

    names: Sequence[str]
    chosen: int = 0

    _stretches: ClassVar = (True, False)

    @property
    def size(self) -> tuple[int, int]:
        return sum(width_of(name, self._font) + 7 for name in self.names) + 2, self._font.height + 4

    def _paint(self, fb: Framebuffer, c: int) -> None:
        if not self.names:
            return
        font = self._font
        chosen = min(max(self.chosen, 0), len(self.names) - 1)
        base = fb.height - 1
        y = base - 2 - font.height + font.baseline + 1
        quiet = c if fb.max_level == 1 else (2 * c + 2) // 3
        if self.size[0] > fb.width:
            self._paint_one(fb, chosen, y, c)
            return
        x = 1
        for number, name in enumerate(self.names):
            w = width_of(name, font) + 7
            is_chosen = number == chosen
            fb.text(name, x + 4, y, c if is_chosen else quiet, font=font, anchor="ls")
            if is_chosen:
                fb.polyline([(0, base), (x, base), (x, 1), (x + 1, 0), (x + w - 1, 0), (x + w, 1), (x + w, base),
                             (fb.width - 1, base)], c, antialias=None)  # fmt: skip
            x += w

    def _paint_one(self, fb: Framebuffer, chosen: int, y: int, c: int) -> None:
        font = self._font
        fb.hline(0, fb.height - 1, fb.width, c)
        arrows = fb.width >= 8 * font.width
        if arrows and chosen > 0:
            fb.text("←", 0, y, c, font=font, anchor="ls")
        if arrows and chosen < len(self.names) - 1:
            fb.text("→", fb.width - 1, y, c, font=font, anchor="rs")
        room = fb.width - (2 * font.width + 6 if arrows else 2)
        fb.text(fitted(self.names[chosen], room, font), (fb.width - 1) // 2, y, c, font=font, anchor="ms")
