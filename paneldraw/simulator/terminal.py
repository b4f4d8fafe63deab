"""A panel in a terminal: a picture as text, and a view that redraws in place."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Any, Literal, TextIO

import numpy as np
from numpy.typing import NDArray

from .frames import Picture

Style = Literal["blocks", "braille", "ascii"]

_BLOCKS = np.array([" ", "▀", "▄", "█"])
_ASCII = np.array([" ", "'", ".", ":"])
_BRAILLE = np.array([chr(0x2800 + code) for code in range(256)])
_BRAILLE_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
_CELLS = {"blocks": (1, 2), "braille": (2, 4), "ascii": (1, 2)}
_LINES = ("┌", "─", "┐", "│", "└", "┘")
_BORDERS = {"blocks": _LINES, "braille": _LINES, "ascii": ("+", "-", "+", "|", "+", "+")}


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
    if style not in _CELLS:
        raise ValueError(f"style: {style!r} is none of {', '.join(_CELLS)}")
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


class TerminalView:
    """Draws a panel in a terminal, again and again in the same place; a context manager.

    On leaving, whatever happened, the cursor and the colors are as before and the last picture stays above the prompt.
    A stream that is no terminal gets the last picture once, on leaving.

    Parameters
    ----------
    stream : text stream, optional
        Default: ``sys.stdout``.
    style : {"blocks", "braille", "ascii"}, optional
        Default: half blocks where they fit in the terminal, else braille, or ASCII where the stream's encoding has
        neither. What is still too large is cut off at the right and at the bottom.
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
        if style is not None and style not in _CELLS:
            raise ValueError(f"style: {style!r} is none of {', '.join(_CELLS)}")
        self._stream = sys.stdout if stream is None else stream
        self._live = self._stream.isatty()
        self._style, self._border = style, border
        self._lines_above = 0
        self._last: list[str] = []
        self._hidden = False

    def __enter__(self) -> TerminalView:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def show(self, source: Any, caption: str = "") -> None:
        """Draw a chip, a frame, a framebuffer or an array of levels, with a caption of one line below."""
        pixels = np.asarray(getattr(source, "pixels", source))
        lines = self._framed(pixels, getattr(source, "max_level", 1))
        self._last = [*lines, caption] if caption else lines
        if not self._live:
            return
        columns, rows = _terminal_size()
        visible = [line[:columns] for line in self._last[: rows - 1]]
        start = f"\x1b[{self._lines_above}A\r" if self._lines_above else ""
        if not self._hidden:
            start += "\x1b[?25l"
            self._hidden = True
        self._stream.write(start + "".join(f"{line}\x1b[K\n" for line in visible) + "\x1b[J")
        self._stream.flush()
        self._lines_above = len(visible)

    def close(self) -> None:
        """Give the cursor back and leave the last picture standing."""
        if self._live and self._hidden:
            self._stream.write("\x1b[0m\x1b[?25h")
        elif not self._live and self._last:
            self._stream.write("\n".join(self._last) + "\n")
        self._stream.flush()
        self._hidden = False
        self._lines_above = 0
        self._last = []

    def _framed(self, pixels: Picture, max_level: int) -> list[str]:
        style = self._style or self._suitable(*pixels.shape)
        lines = text(pixels, style, max_level=max_level).split("\n")
        if not self._border:
            return lines
        left_top, bar, right_top, side, left_bottom, right_bottom = _BORDERS[style]
        width = len(lines[0])
        return [
            left_top + bar * width + right_top,
            *(f"{side}{line}{side}" for line in lines),
            left_bottom + bar * width + right_bottom,
        ]

    def _suitable(self, height: int, width: int) -> Style:
        try:
            "▀⣿┌".encode(self._stream.encoding or "ascii")
        except (UnicodeEncodeError, LookupError):
            return "ascii"
        if not self._live:
            return "blocks"
        columns, rows = _terminal_size()
        across, down = _CELLS["blocks"]
        frame = 2 * self._border
        fits = width / across + frame <= columns and height / down + frame + 2 <= rows
        return "blocks" if fits else "braille"


def _terminal_size() -> tuple[int, int]:
    import shutil

    return shutil.get_terminal_size()
