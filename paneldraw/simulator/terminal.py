"""Panels in a terminal: a picture as text, and a view that redraws in place below what the script prints."""

from __future__ import annotations

import contextlib
import os
import shutil
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from types import TracebackType
from typing import Any, Final, Literal, NamedTuple, TextIO

import numpy as np
from numpy.typing import NDArray

from .frames import Picture
from .looks import Look, find_look
from .recorder import Showing
from .views import BEAT, Sight

Style = Literal["blocks", "braille", "ascii"]

_BLOCKS = np.array([" ", "▀", "▄", "█"])
_ASCII = np.array([" ", "'", ".", ":"])
_BRAILLE = np.array([chr(0x2800 + code) for code in range(256)])
_BRAILLE_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_CELLS = {"blocks": (1, 2), "braille": (2, 4), "ascii": (1, 2)}
_LINES = ("┌", "─", "┐", "│", "└", "┘")
_BORDERS = {"blocks": _LINES, "braille": _LINES, "ascii": ("+", "-", "+", "|", "+", "+")}
_SCALES: Final = (1, 1.125, 1.25, 1.5, 1.75, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 16, 24, 32, 48, 64, 128, 256, 512)
"""Panel pixels a pixel of what is drawn."""
_KEPT: Final = 2
"""Lines of the terminal that are left for what the script prints; a scrolling region has two or more."""
_CUBE: Final = np.array([0, 95, 135, 175, 215, 255])
"""Steps of each color in the palette of 256."""
_GRAYS: Final = 8 + 10 * np.arange(24)
_BREAK: Final = "\x18\x1b[0m"
"""Breaks off a control sequence of which only the start was written, and ends its colors."""
_BUSY: Final = 3.0
"""Drawing may take one part in so many of the time, and one more."""


def text(pixels: Picture, style: Style = "blocks", *, max_level: int = 1) -> str:
    """Turn levels into lines of text.

    Parameters
    ----------
    pixels : numpy.ndarray
        Levels, shape (height, width). A pixel of half `max_level` or more counts as lit.
    style : {"blocks", "braille", "ascii"}
        One character is 1 x 2 pixels as half blocks (default), 2 x 4 as braille dots, or 1 x 2 in plain ASCII.
    max_level : int
        The level that is fully lit. Default: 1.

    Returns
    -------
    str
        Lines joined by newlines, all of one length, without a newline at the end.

    Raises
    ------
    ValueError
        For another style.

    Examples
    --------
    >>> import numpy as np
    >>> text(np.eye(4, dtype=np.uint8), "ascii").split("\\n")
    ["'.  ", "  '."]
    """
    _check_style(style)
    lit = 2 * np.asarray(pixels, np.int64) >= max_level
    if style == "braille":
        dots = [_cell(lit, x, y, 2, 4) * np.uint8(_BRAILLE_DOTS[y][x]) for y in range(4) for x in range(2)]
        cells = _BRAILLE[np.bitwise_or.reduce(dots)]
    else:
        codes = _cell(lit, 0, 0, 1, 2) + 2 * _cell(lit, 0, 1, 1, 2)
        cells = (_BLOCKS if style == "blocks" else _ASCII)[codes]
    return "\n".join("".join(row) for row in cells)


def _cell(lit: NDArray[np.bool_], x: int, y: int, across: int, down: int) -> NDArray[np.uint8]:
    """One pixel of every character cell, the edge filled up with dark."""
    height, width = lit.shape
    padded = np.pad(lit, ((0, -height % down), (0, -width % across)))
    return padded[y::down, x::across].astype(np.uint8)


def _check_style(style: str) -> None:
    if style not in _CELLS:
        raise ValueError(f"style: {style!r} is none of {', '.join(_CELLS)}")


# -- Colors


class Palette:
    """Which colors a terminal has, and how it is told to use them.

    Parameters
    ----------
    colors : int
        2**24, 256, or 0 for those that it writes text in.
    """

    def __init__(self, colors: int) -> None:
        self.colors = colors

    @staticmethod
    def of(environment: Mapping[str, str]) -> Palette:
        """Find out what a terminal can, by what it says of itself.

        Examples
        --------
        >>> Palette.of({"TERM": "xterm-256color"}).colors, Palette.of({"NO_COLOR": "1", "COLORTERM": "24bit"}).colors
        (256, 0)
        """
        kind = environment.get("TERM", "")
        if environment.get("NO_COLOR") or kind == "dumb":
            return Palette(0)
        if environment.get("COLORTERM") in ("truecolor", "24bit") or "direct" in kind or "WT_SESSION" in environment:
            return Palette(2**24)
        return Palette(256 if "256" in kind else 0)

    def codes(self, colors: NDArray[np.uint8]) -> NDArray[np.int64]:
        """Return the number that the terminal has for every color, shape (..., 3), or for the one most like it."""
        wide = colors.astype(np.int64)
        if self.colors > 256:
            packed: NDArray[np.int64] = (wide << (16, 8, 0)).sum(-1)
            return packed
        steps = np.abs(wide[..., None] - _CUBE).argmin(-1)
        gray = np.abs(wide.mean(-1)[..., None] - _GRAYS).argmin(-1)
        off_cube = ((_CUBE[steps] - wide) ** 2).sum(-1)
        off_gray = ((_GRAYS[gray][..., None] - wide) ** 2).sum(-1)
        nearest: NDArray[np.int64] = np.where(off_gray < off_cube, 232 + gray, 16 + (steps * (36, 6, 1)).sum(-1))
        return nearest

    def sequence(self, code: int, *, back: bool = False) -> str:
        """Return what makes a color that of the text, or of what is behind it."""
        layer = 48 if back else 38
        if self.colors > 256:
            return f"{layer};2;{code >> 16};{code >> 8 & 255};{code & 255}"
        return f"{layer};5;{code}"


def _shaded(colors: NDArray[np.uint8], palette: Palette) -> list[str]:
    """Half blocks, each with a color for its upper and its lower pixel."""
    codes = palette.codes(colors)
    if len(codes) % 2:
        codes = np.vstack([codes, codes[-1:]])
    lines = []
    for upper, lower in zip(codes[::2], codes[1::2], strict=True):
        changes = np.flatnonzero((np.diff(upper) != 0) | (np.diff(lower) != 0)) + 1
        runs = []
        for start, end in pairwise([0, *changes.tolist(), len(upper)]):
            top, bottom = int(upper[start]), int(lower[start])
            mark = "▀" if top != bottom else " "
            both = f"{palette.sequence(top)};" if top != bottom else ""
            runs.append(f"\x1b[{both}{palette.sequence(bottom, back=True)}m{mark * (end - start)}")
        lines.append("".join(runs) + "\x1b[0m")
    return lines


def _tinted(pixels: Picture, style: Style, look: Look, palette: Palette) -> list[str]:
    """Marks of one bit, in the colors of a look if there are any."""
    lines = text(pixels, style).split("\n")
    if not palette.colors:
        return lines
    down = _CELLS[style][1]
    ramps = [palette.codes(look.ramp(1, top=top)).tolist() for top in (False, True)]
    tints = [f"\x1b[{palette.sequence(lit)};{palette.sequence(dark, back=True)}m" for dark, lit in ramps]
    rows = look.top_rows if look.top_lit else 0
    return [f"{tints[number * down < rows]}{line}\x1b[0m" for number, line in enumerate(lines)]


def _dithered(pixels: Picture, max_level: int) -> Picture:
    from paneldraw.framebuffer.pictures import quantize

    return quantize(np.rint(pixels * (255 / max_level)).astype(np.uint8), 1, "bayer")


def _shrunk(pixels: Picture, scale: float) -> NDArray[np.float32]:
    """The mean level of each square of so many pixels a side."""
    from PIL import Image

    size = tuple(max(1, round(length / scale)) for length in pixels.shape[::-1])
    return np.asarray(Image.fromarray(pixels.astype(np.float32)).resize(size, Image.Resampling.BOX))


# -- What is drawn where


class Shown(NamedTuple):
    """A picture as it is to be shown."""

    pixels: Picture
    max_level: int
    look: Look
    caption: str


@dataclass(frozen=True)
class Arrangement:
    """How pictures are drawn so that all fit: marks of one bit, scale, and whether with borders and captions."""

    style: Style
    scale: float
    palette: Palette
    border: bool
    captions: bool

    def draw(self, shown: Shown) -> list[str]:
        """Draw a picture as lines of one width, without border and caption."""
        pixels, shades = shown.pixels, shown.max_level > 1
        if self.scale > 1:
            mean = _shrunk(pixels, self.scale)
            lit = mean >= 0.499 / self.scale  # of one bit, so that a line of one pixel is not lost
            pixels = (np.rint(mean) if shades else lit).astype(np.uint8)
        if shades and self.palette.colors:
            return _shaded(_colors(shown, pixels, self.scale), self.palette)
        if shades:
            pixels = _dithered(pixels, shown.max_level)
        return _tinted(pixels, self.style, _scaled(shown.look, self.scale), self.palette)

    def size(self, shown: Shown) -> tuple[int, int]:
        """Columns and lines that a picture takes, border and caption included."""
        style: Style = "blocks" if shown.max_level > 1 and self.palette.colors else self.style
        across, down = _CELLS[style]
        height, width = (max(1, round(length / self.scale)) for length in shown.pixels.shape)
        frame = 2 * self.border
        return -(-width // across) + frame, -(-height // down) + frame + (self.captions and bool(shown.caption))

    def rows(self, pictures: Sequence[Shown], columns: int) -> Iterator[list[Shown]]:
        """Lay pictures out from left to right, as many in a row as fit."""
        row: list[Shown] = []
        used = 0
        for shown in pictures:
            width = self.size(shown)[0]
            if row and used + 1 + width > columns:
                yield row
                row, used = [], 0
            used += width + bool(row)
            row.append(shown)
        yield row

    def fits(self, pictures: Sequence[Shown], columns: int, lines: int) -> bool:
        """Whether all pictures can be seen whole."""
        sizes = [[self.size(shown) for shown in row] for row in self.rows(pictures, columns)]
        high = sum(max(height for _, height in row) for row in sizes)
        return high <= lines and all(width <= columns for row in sizes for width, _ in row)

    def lines(self, pictures: Sequence[Shown], columns: int) -> Iterator[str]:
        """Draw all pictures."""
        for row in self.rows(pictures, columns):
            tiles = [self._tile(shown, columns if len(row) == 1 else 0) for shown in row]
            high = max(len(tile) for tile, _ in tiles)
            for number in range(high):
                parts = [tile[number] if number < len(tile) else " " * width for tile, width in tiles]
                yield " ".join(parts)

    def _tile(self, shown: Shown, room: int) -> tuple[list[str], int]:
        lines = self.draw(shown)
        width = self.size(shown)[0]
        if self.border:
            left_top, bar, right_top, side, left_bottom, right_bottom = _BORDERS[self.style]
            bars = bar * (width - 2)
            lines = [f"{side}{line}{side}" for line in lines]
            lines = [left_top + bars + right_top, *lines, left_bottom + bars + right_bottom]
        if self.captions and shown.caption:
            lines.append(_cut(shown.caption, room or width).ljust(0 if room else width))
        return lines, width


def _cut(caption: str, columns: int) -> str:
    return caption if len(caption) <= columns else caption[: columns - 1] + "…"


def _scaled(look: Look, scale: float) -> Look:
    return replace(look, top_rows=round(look.top_rows / scale)) if look.top_rows and scale != 1 else look


def _colors(shown: Shown, pixels: Picture, scale: float) -> NDArray[np.uint8]:
    return _scaled(shown.look, scale).colors(pixels, shown.max_level)


# -- The views


class TerminalView:
    """Draws panels in a terminal, again and again in the same place at its lower edge; a context manager.

    What is printed meanwhile, by whom ever, scrolls above. On leaving, whatever happened, the terminal is as before
    and the last picture stays above the prompt. A stream that is no terminal, or one that is ``TERM=dumb``, gets the
    last picture once, on leaving.

    Parameters
    ----------
    stream : text stream, optional
        Default: ``sys.stdout``.
    style : {"blocks", "braille", "ascii"}, optional
        Marks for pictures of one bit. Default: half blocks where they fit in the terminal, else braille, or ASCII where
        the stream's encoding has neither. Greys are half blocks in their colors where the terminal has them
        (``COLORTERM``, ``TERM``; ``NO_COLOR`` has none), and dithered elsewhere. What is still too large is drawn
        smaller.
    border : bool
        Draw a line around the picture. Default: True.

    Examples
    --------
    >>> import io
    >>> from paneldraw import simulator
    >>> out = io.StringIO()
    >>> with simulator.TerminalView(out, style="ascii", border=False) as view:
    ...     view.show(simulator.SSD1306(96, 16))
    >>> len(out.getvalue().splitlines())
    8
    """

    def __init__(self, stream: TextIO | None = None, *, style: Style | None = None, border: bool = True) -> None:
        if style is not None:
            _check_style(style)
        self._stream = sys.stdout if stream is None else stream
        self.live = self._stream.isatty() and os.environ.get("TERM") != "dumb"
        self._palette = Palette.of(os.environ) if self.live else Palette(0)
        self._style, self._border = style, border
        self._pictures: list[Shown] = []
        self._place = (0, 0, 0)  # columns and lines of the terminal, and lines of it that are drawn in
        self._drawn: list[str] = []
        self._torn = False  # whether what was written last may have been cut off anywhere

    def __enter__(self) -> TerminalView:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is not None:
            self._distrust()
        self.close()

    def show(self, source: Any, caption: str = "", look: str | Look | None = None) -> None:
        """Draw a chip, a frame, a framebuffer or an array of levels, with a caption of one line below.

        Parameters
        ----------
        source : chip, Frame, Framebuffer or numpy.ndarray
        caption : str, optional
        look : str or Look, optional
            Default: the chip's own.
        """
        pixels = np.asarray(getattr(source, "pixels", source))
        look = find_look(look or getattr(source, "look", None))
        self.draw([Shown(pixels, getattr(source, "max_level", 1), look, caption)])

    def draw(self, pictures: Sequence[Shown]) -> None:
        """Draw several pictures, beside each other and below."""
        self._pictures = list(pictures)
        columns, rows = _terminal_size(self._stream)
        if not (self.live and pictures and rows > _KEPT):
            return
        lines = self._arranged(columns, rows - _KEPT)
        place = (columns, rows, len(lines))
        room = "" if place == self._place else self._make_room(rows, len(lines))
        before = [] if room or self._torn else self._drawn
        changes = self._changes(before, lines, rows)
        self._place, self._drawn = place, lines
        if changes:
            start = f"{_BREAK if self._torn else ''}\x1b[?25l{room}\x1b7"
            try:
                self._write(f"{start}{changes}\x1b8\x1b[?25h")
            except BaseException:
                self._distrust()
                self._place = (columns, rows, 0) if room else place  # the room may be cut too, and is made anew
                raise
            self._torn = False

    def _distrust(self) -> None:
        """Take it that the terminal did not get all that was written: Ctrl-C has it lose what it has not yet read."""
        self._torn = True

    def close(self) -> None:
        """Leave the last pictures standing, with the cursor below them."""
        try:
            self._finish()
        except BaseException:  # of a signal, say; the terminal has to be left in order all the same
            self._distrust()
            with contextlib.suppress(OSError, ValueError):
                self._finish()
            raise
        finally:
            self._pictures, self._drawn, self._place, self._torn = [], [], (0, 0, 0), False

    def _finish(self) -> None:
        if self._drawn:
            columns, rows, count = self._place
            start = ""
            if self._torn:
                stands = count and _terminal_size(self._stream) == (columns, rows)
                again = self._changes([], self._drawn, rows) if stands else ""
                start = f"{_BREAK}{again}\x1b[?25h"
            self._write(f"{start}\x1b[r\x1b[{rows};1H\x1b[0m\n")
        elif self._pictures and not self.live:
            self._write("\n".join([*self._plain(), ""]))

    @staticmethod
    def _changes(before: list[str], lines: list[str], rows: int) -> str:
        """Draw those lines that are not as before, each in its place at the lower edge."""
        first = rows - len(lines) + 1
        return "".join(
            f"\x1b[{first + number};1H\x1b[2K{line}"
            for number, line in enumerate(lines)
            if not before or line != before[number]
        )

    def _make_room(self, rows: int, count: int) -> str:
        """Clear what was drawn below the cursor, bring as many free lines there, and let the rest scroll by itself."""
        clear = "\x1b7\x1b[r\x1b8\x1b[J" if self._drawn else ""
        down = "\x1bD" * count  # a line down, at the lower edge by scrolling, in the same column
        return f"{clear}{down}\x1b[{count}A\x1b7\x1b[1;{rows - count}r\x1b8"

    def _arranged(self, columns: int, rows: int) -> list[str]:
        """Draw the pictures as large as they can be seen whole."""
        styles: list[Style] = [self._style] if self._style else self._suitable()
        for border, captions in dict.fromkeys([(self._border, True), (False, True), (False, False)]):
            for scale in _SCALES[: len(_SCALES) if not captions else _SCALES.index(4) + 1]:
                for style in styles if scale == 1 else styles[-1:]:
                    arrangement = Arrangement(style, scale, self._palette, border, captions)
                    if arrangement.fits(self._pictures, columns, rows):
                        return list(arrangement.lines(self._pictures, columns))
        return [_cut(f"{len(self._pictures)} panels: this terminal is too small to show them", columns)]

    def _plain(self) -> list[str]:
        """Draw the pictures at full size for who reads a file."""
        arrangement = Arrangement(self._style or self._suitable()[0], 1, self._palette, self._border, True)
        widths = [max(arrangement.size(shown)[0], len(shown.caption)) for shown in self._pictures]
        return list(arrangement.lines(self._pictures, max(widths)))

    def _suitable(self) -> list[Style]:
        try:
            "▀⣿┌".encode(self._stream.encoding or "ascii")
        except (UnicodeEncodeError, LookupError):
            return ["ascii"]
        return ["blocks", "braille"]

    def _write(self, text: str) -> None:
        self._stream.write(text)
        self._stream.flush()


class LiveTerminal:
    """Chips in the terminal, looked at from a thread until the view is closed; `open_view` makes it.

    Parameters
    ----------
    stream : text stream, optional
        Default: ``sys.stdout``.
    """

    url = ""

    def __init__(self, stream: TextIO | None = None) -> None:
        self._stream = sys.stdout if stream is None else stream
        self._view = TerminalView(stream)
        self._sights: list[Sight] = []
        self._others = False  # whether chips came or went since the last time that all were drawn
        self._change = threading.Condition()
        self._closed = False
        self._thread: threading.Thread | None = None

    def __enter__(self) -> LiveTerminal:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def add(self, chip: Showing, title: str = "", look: str | Look | None = None) -> None:
        """Show one more chip, under a title."""
        with self._change:
            self._sights.append(Sight(chip, title, look))
            self._others = True
            if self._thread is None and not self._closed and self._view.live:
                self._thread = threading.Thread(target=self._watch, name="paneldraw terminal", daemon=True)
                self._thread.start()

    def remove(self, chip: Showing) -> None:
        """Show a chip no longer."""
        with self._change:
            self._sights = [sight for sight in self._sights if sight.chip is not chip]
            self._others = True

    def describe(self, chip: Showing, text: str) -> None:
        """Words are for those who do not see; here the picture is all there is."""

    def wait(self, timeout: float) -> bool:
        """Who looks at the terminal is there already."""
        return True

    def close(self) -> None:
        """Draw what was shown last, and leave the terminal in order."""
        with self._change:
            if self._closed:
                return
            self._closed = True
            self._change.notify_all()
        try:
            if self._thread is not None:
                self._thread.join(2)
        finally:  # a signal may end the waiting
            self._view._distrust()
            with contextlib.suppress(OSError, ValueError), self._view:  # nobody is there any more
                self._draw()

    def _watch(self) -> None:
        pause, size = 0.0, (0, 0)
        while True:
            with self._change:
                if self._change.wait_for(lambda: self._closed, max(BEAT, pause)):
                    return
                changed = [self._others, *(sight.glance() for sight in self._sights)]
            start = time.perf_counter()
            now = _terminal_size(self._stream)
            try:
                if any(changed) or now != size:
                    size = now
                    self._draw()
            except (OSError, ValueError):  # the terminal is gone; there is nobody to tell
                return
            pause = _BUSY * (time.perf_counter() - start)

    def _draw(self) -> None:
        with self._change:
            self._others = False
            for sight in self._sights:
                sight.glance()
            self._view.draw(
                [
                    Shown(each.picture, each.max_level, each.look, f"{each.title}: {each.summary}")
                    for each in self._sights
                ]
            )


def _terminal_size(stream: TextIO) -> tuple[int, int]:
    """Columns and lines of the terminal that a stream goes to."""
    with contextlib.suppress(AttributeError, ValueError, OSError):
        columns, rows = os.get_terminal_size(stream.fileno())
        if columns and rows:
            return columns, rows
    return shutil.get_terminal_size()
