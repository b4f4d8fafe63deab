"""Pages that are run as they are printed: one block after the other, in one interpreter, on simulated panels.

A picture below a block of Python is what the block left on the panel that it calls `panel`, or its `picture`; a GIF is
all that the panel showed, or a list of pictures. A block of text below one is what it printed. Clocks stand at nine
past ten, and go on where the code sleeps or waits for the next frame; what would go on for ever ends after a few turns.
"""

from __future__ import annotations

import atexit
import contextlib
import io
import itertools
import os
import re
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import cache, partial
from pathlib import Path
from typing import Any
from unittest import mock

import smbus2
from PIL import Image

from paneldraw import Panel, simulator
from paneldraw.pacing import Beat

HERE = Path(__file__).parent
PAGES = ("tutorial.md", "trouble.md", "urls.md", "which_panel.md")
"""Pages whose pictures and printed lines are made so."""
TURNS = 12
"""Of a loop without an end."""
_START = time.struct_time((2026, 3, 14, 10, 9, 30, 5, 73, 0))
_STEP = re.compile(
    r"^```python\n(?P<code>(?s:.*?))^```\n(?:\n```text\n(?P<text>(?s:.*?))^```\n)?(?:\n!\[.*?\]\((?P<picture>[\w/.]+)\)$)?",
    re.M,
)


class _OverError(BaseException):
    """A loop has gone round often enough."""


@dataclass
class Step:
    """A block of a page, what is printed below it, and what running it left behind."""

    code: str
    text: str | None
    picture: str | None
    printed: str = ""
    frames: list[Image.Image] = field(default_factory=list)


def steps(page: str) -> list[Step]:
    """Return the blocks of a page, not yet run."""
    text = (HERE / page).read_text(encoding="utf-8")
    return [Step(found["code"], found["text"], found["picture"]) for found in _STEP.finditer(text)]


@cache
def run(page: str) -> list[Step]:
    """Run all blocks of a page; return them with what they left behind."""
    names: dict[str, Any] = {"__name__": "__main__"}
    done = steps(page)
    with _stage() as clock:
        for step in done:
            clock.turns = 0
            printed = io.StringIO()
            with contextlib.redirect_stdout(printed), contextlib.suppress(_OverError):
                exec(compile(step.code, page, "exec"), names)
            step.printed = printed.getvalue()
            if step.picture:
                step.frames = _seen(names, moving=step.picture.endswith(".gif"))
    return done


def _seen(names: dict[str, Any], *, moving: bool) -> list[Image.Image]:
    """What a block left behind, as it looks."""
    if "picture" in names:
        picture = names.pop("picture")
        return picture if moving else [picture]
    chip = names["panel"].simulated
    pictures = [frame.pixels for frame in chip.frames] if moving else [chip.pixels]
    return [simulator.image(pixels, scale=3, max_level=chip.max_level) for pixels in pictures]


class _Clock:
    """A time of day that goes on by what is slept."""

    def __init__(self) -> None:
        self.now, self.turns = 0.0, 0

    def sleep(self, seconds: float) -> None:
        self.now += seconds
        self.turns += seconds > 0.02  # and no wait between two tries of the wire's
        if self.turns > 100:
            raise _OverError

    def localtime(self, seconds: float | None = None) -> time.struct_time:
        return _localtime(seconds) if seconds is not None else _localtime(time.mktime(_START) + self.now)

    def strftime(self, form: str, when: Any = None) -> str:
        return _strftime(form, when or self.localtime())

    def frames(self, panel: Panel, fps: float = 30) -> Iterator[Beat]:
        for number in itertools.count():
            if number == TURNS:
                raise _OverError
            yield Beat(number, number / fps, 0)
            self.now += 1 / fps


_localtime, _strftime = time.localtime, time.strftime


def _bus(*place: object) -> simulator.I2CBus:
    return simulator.I2CBus({0x3C: simulator.SSD1306()})


@contextlib.contextmanager
def _stage() -> Iterator[_Clock]:
    """A folder, an environment, a clock and an I2C bus for a page alone."""
    clock, before = _Clock(), Path.cwd()
    with contextlib.ExitStack() as stack:
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        stack.enter_context(mock.patch.dict(os.environ, {"PANELDRAW_PANEL": "sim://ssd1306"}))
        stack.enter_context(
            mock.patch.multiple(time, sleep=clock.sleep, localtime=clock.localtime, strftime=clock.strftime)
        )
        stack.enter_context(mock.patch.object(Panel, "frames", lambda panel, fps=30: clock.frames(panel, fps)))
        stack.enter_context(mock.patch.object(smbus2, "SMBus", _bus))
        stack.enter_context(mock.patch.object(atexit, "register", lambda function, *arguments: function))
        os.chdir(folder)
        stack.callback(os.chdir, before)
        yield clock


def draw(page: str, name: str) -> list[Image.Image]:
    """Return the frames of one of a page's pictures."""
    return next(step.frames for step in run(page) if step.picture == name)


def pictures() -> dict[str, Callable[[], list[Image.Image]]]:
    """What draws each picture of these pages, by its file name."""
    return {step.picture: partial(draw, page, step.picture) for page in PAGES for step in steps(page) if step.picture}


def printed(page: str) -> str:
    """Return a page with what its blocks print below them."""
    done = iter(run(page))

    def renewed(found: re.Match[str]) -> str:
        said = next(done).printed
        return found[0] if found["text"] is None else found[0].replace(f"```text\n{found['text']}", f"```text\n{said}")

    return _STEP.sub(renewed, (HERE / page).read_text(encoding="utf-8"))
