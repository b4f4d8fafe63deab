"""Terminals for tests: a real pty, with an emulator at its far end that says what the screen shows."""

from __future__ import annotations

import os
import struct
import threading
import time
from types import TracebackType
from typing import Any, TextIO

import numpy as np
import pyte
import pytest
from numpy.typing import NDArray

pty = pytest.importorskip("pty", reason="pseudo-terminals are a thing of Unix")
fcntl, termios = pytest.importorskip("fcntl"), pytest.importorskip("termios")


class Screen(pyte.Screen):
    """A screen that, made lower, loses what is below the cursor first, as xterm and others do it."""

    def resize(self, lines: int | None = None, columns: int | None = None) -> None:
        assert lines
        assert columns
        off = max(0, self.cursor.y - (lines - 1))
        kept = {y - off: line for y, line in self.buffer.items() if off <= y < off + lines}
        self.buffer.clear()
        self.buffer.update(kept)
        for line in self.buffer.values():
            for x in range(columns, self.columns):
                line.pop(x, None)
        self.lines, self.columns = lines, columns
        self.cursor.y -= off
        self.cursor.x = min(self.cursor.x, columns - 1)
        self.margins = None


class Terminal:
    """A terminal of so many columns and rows; `stream` is what a program writes to."""

    def __init__(self, columns: int, rows: int, encoding: str = "utf-8") -> None:
        self._near, self._far = pty.openpty()
        self.screen = Screen(columns, rows)
        self._feed = pyte.ByteStream(self.screen)
        self._marks = 0
        self._lock = threading.Lock()
        self.resize(columns, rows)
        self.stream: TextIO = open(self._far, "w", encoding=encoding, closefd=False)  # noqa: SIM115
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def __enter__(self) -> Terminal:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.stream.close()
        os.close(self._far)
        self._thread.join(10)
        os.close(self._near)
        assert not self._thread.is_alive()

    @property
    def fd(self) -> int:
        """The end that a program has for its standard streams."""
        return self._far

    def resize(self, columns: int, rows: int) -> None:
        """Drag the window to another size."""
        with self._lock:
            self.screen.resize(rows, columns)
            fcntl.ioctl(self._far, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    def type(self, keys: bytes) -> None:
        """Press keys."""
        os.write(self._near, keys)

    def lines(self) -> list[str]:
        """What the screen shows, now that all that was written has come through."""
        self._marks += 1
        os.write(self._far, b"\x1b]2;mark %d\x07" % self._marks)
        deadline = time.monotonic() + 30
        while self.screen.title != f"mark {self._marks}":
            assert time.monotonic() < deadline, "the terminal does not read"
            time.sleep(0.002)
        with self._lock:
            return [line.rstrip() for line in self.screen.display]

    def colors(self, x: int, y: int, columns: int, rows: int) -> NDArray[np.uint8]:
        """The colors of the upper and lower halves of cells, shape (2 * rows, columns, 3)."""
        self.lines()
        seen = np.zeros((2 * rows, columns, 3), np.uint8)
        for row in range(rows):
            for column in range(columns):
                cell = self.screen.buffer[y + row][x + column]
                halves = {" ": (cell.bg, cell.bg), "█": (cell.fg, cell.fg), "▀": (cell.fg, cell.bg)}
                halves["▄"] = cell.bg, cell.fg
                for half, color in enumerate(halves[cell.data]):
                    seen[2 * row + half, column] = list(bytes.fromhex(color))
        return seen

    def _read(self) -> None:
        while True:
            try:
                data = os.read(self._near, 65536)
            except OSError:  # the far end was closed
                return
            if not data:
                return
            with self._lock:
                self._feed.feed(data)

    def wait_for(self, text: str, seconds: float = 30) -> list[str]:
        """Wait until a text is on the screen; return its lines."""
        deadline = time.monotonic() + seconds
        while text not in "\n".join(self.shown()):
            assert time.monotonic() < deadline, "\n".join(self.shown())
            time.sleep(0.01)
        return self.shown()

    def shown(self) -> list[str]:
        """What the screen shows at this moment."""
        with self._lock:
            return [line.rstrip() for line in self.screen.display]


def in_order(terminal: Terminal) -> bool:
    """Whether a terminal is as a shell needs it."""
    screen: Any = terminal.screen
    return screen.margins is None and not screen.cursor.hidden and screen.cursor.attrs == pyte.screens.Char(" ")
