"""Pages one after the other, and how one gives way to the next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from paneldraw import Framebuffer
from paneldraw.widgets.widget import Widget, dim, finite

if TYPE_CHECKING:
    from numpy.typing import NDArray

Page = Widget | Callable[[Framebuffer], object]
"""A widget, or a function that draws on the framebuffer it is given."""


@dataclass(frozen=True, slots=True, eq=False)
class Pages(Widget):
    """One of several pages, or, between two, both of them on their way.

    Attributes
    ----------
    pages : sequence of Widget or callable
        Widgets, or functions that draw on the framebuffer they are given, which is empty.
    position : float
        Page 1 at 1.0, and at 1.25 a quarter of the way from page 1 to page 2. After the last page comes the first.
    transition : {"slide", "cover", "wipe", "dissolve", "cut"}
        Whether the next page pushes the old one out, comes over it, appears from left to right, appears pixel by pixel
        (on greys: fades), or is there at once.
    dots : bool
        Whether a row of dots at the foot says which page it is.

    Raises
    ------
    ValueError
        If there is no such transition.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.widgets import Number, Pages
    >>> pages = [Number(21.5, "°C"), Number(48, "%")]
    >>> fb = Framebuffer(128, 64)
    >>> Pages(pages, position=0.5).draw(fb)
    """

    pages: Sequence[Page]
    position: float = 0.0
    transition: str = "slide"
    dots: bool = False

    def __post_init__(self) -> None:
        if self.transition not in TRANSITIONS:
            raise ValueError(f"transition must be one of {', '.join(TRANSITIONS)}, not {self.transition!r}")

    @property
    def size(self) -> tuple[int, int]:
        sizes = [page.size for page in self.pages if isinstance(page, Widget)] or [(1, 1)]
        return max(w for w, _ in sizes), max(h for _, h in sizes) + (5 if self.dots else 0)

    def _paint(self, fb: Framebuffer, c: int) -> None:
        count = len(self.pages)
        if not count:
            return
        position = finite(self.position) % count
        old, way = int(position) % count, position % 1
        height = fb.height - 5 if self.dots and fb.height >= 24 else fb.height
        room = fb.view(0, 0, fb.width, height)
        before = self._drawn(old, room)
        after = self._drawn((old + 1) % count, room) if way and self.transition != "cut" else before
        TRANSITIONS[self.transition](room, before, after, way)
        if height < fb.height:
            self._paint_dots(fb, round(position) % count, c)

    def _drawn(self, number: int, room: Framebuffer) -> Framebuffer:
        """A page on a framebuffer of its own."""
        page = self.pages[number]
        fb = Framebuffer(room.width, room.height, room.depth, antialias=room.antialias)
        page.draw(fb) if isinstance(page, Widget) else page(fb)
        return fb

    def _paint_dots(self, fb: Framebuffer, shown: int, c: int) -> None:
        count = len(self.pages)
        step = min(6, max(fb.width // count, 1))
        left = (fb.width - step * (count - 1) - 1) // 2
        for number in range(count):
            x, y = left + step * number, fb.height - 2
            if number == shown and step >= 4:
                fb.rect(x - 1, y - 1, 3, 3, c, fill=True)
            else:
                fb.pixel(x, y, c if number == shown else dim(fb, c))


def _slide(fb: Framebuffer, before: Framebuffer, after: Framebuffer, way: float) -> None:
    gone = round(fb.width * way)
    fb.blit(before, -gone, 0)
    fb.blit(after, fb.width - gone, 0)


def _cover(fb: Framebuffer, before: Framebuffer, after: Framebuffer, way: float) -> None:
    fb.blit(before, 0, 0)
    fb.blit(after, fb.width - round(fb.width * way), 0)


def _wipe(fb: Framebuffer, before: Framebuffer, after: Framebuffer, way: float) -> None:
    fb.blit(before, 0, 0)
    with fb.clip(0, 0, round(fb.width * way), fb.height):
        fb.blit(after, 0, 0)


def _threshold(x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """When a pixel goes over to the next page: each at its own time, and neighbors at times far apart.

    Jorge Jimenez, "Next generation post processing in Call of Duty: Advanced Warfare", SIGGRAPH 2014 (its noise).
    """
    return 52.9829189 * ((0.06711056 * x + 0.00583715 * y) % 1) % 1


def _dissolve(fb: Framebuffer, before: Framebuffer, after: Framebuffer, way: float) -> None:
    old, new = before.pixels, after.pixels
    if fb.depth > 1:
        mixed = np.floor(old + (new.astype(np.float64) - old) * way + 0.5).astype(np.uint8)
    else:
        y, x = np.mgrid[: float(fb.height), : float(fb.width)]
        mixed = np.where(_threshold(x, y) < way, new, old)
    fb.blit(mixed, 0, 0)


def _cut(fb: Framebuffer, before: Framebuffer, after: Framebuffer, way: float) -> None:
    fb.blit(before, 0, 0)


TRANSITIONS: Final = {"slide": _slide, "cover": _cover, "wipe": _wipe, "dissolve": _dissolve, "cut": _cut}
"""Ways from one page to the next, by name."""
