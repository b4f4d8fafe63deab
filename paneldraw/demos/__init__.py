"""The examples, runnable by name: ``paneldraw demo clock``.

A demo is a function from a framebuffer and a time to pixels. It clears the framebuffer, fits its drawing to whatever
size and depth that has, and keeps no state, so that any moment can be drawn at any time, in any order:

>>> from paneldraw import Framebuffer
>>> from paneldraw.demos import find
>>> fb = Framebuffer(128, 64)
>>> find("cube")(fb, 1.5)
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from ..framebuffer import Framebuffer

    Demo = Callable[[Framebuffer, float], None]

DEMOS = {
    "scene": "lines, a cube and a clock together",
    "lines": "aliased and anti-aliased lines side by side, under a magnifying glass",
    "cube": "a turning cube whose far edges are dotted",
    "clock": "the time, with hands and in figures",
    "system": "a system monitor: bars, and a chart of the last minute",
    "menu": "a menu that somebody walks through",
    "weather": "three pages: now, the hours, the week",
    "spectrum": "a spectrum analyzer with falling caps",
    "life": "Conway's Game of Life",
    "pong": "two players and a ball",
    "video": "a video player",
}
"""Names of the demos, and what they show."""


def find(name: str) -> Demo:
    """Return a demo: ``draw(fb, t)``, where t is the time of day in seconds after midnight.

    Parameters
    ----------
    name : str
        A key of :data:`DEMOS`.

    Raises
    ------
    ValueError
        If there is no demo of that name.
    """
    if name not in DEMOS:
        raise ValueError(f"there is no demo {name!r}; there are {', '.join(DEMOS)}")
    return cast("Demo", import_module(f"{__name__}.{name}").draw)
