"""A picture as text, and the view that redraws in place, on a small terminal that understands its sequences."""

from __future__ import annotations

import io
import re
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from paneldraw import simulator

from .helpers import random_picture, send, started


def unblock(text: str, marks: str) -> NDArray[np.uint8]:
    codes = np.array([[marks.index(mark) for mark in line] for line in text.split("\n")])
    return np.stack([codes & 1, codes >> 1], axis=1).reshape(-1, codes.shape[1]).astype(np.uint8)


def unbraille(text: str) -> NDArray[np.uint8]:
    lines = text.split("\n")
    pixels = np.zeros((4 * len(lines), 2 * len(lines[0])), np.uint8)
    for row, line in enumerate(lines):
        for column, mark in enumerate(line):
            for bit, (y, x) in enumerate([(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1), (3, 0), (3, 1)]):
                pixels[4 * row + y, 2 * column + x] = (ord(mark) - 0x2800) >> bit & 1
    return pixels


@given(st.integers(1, 24), st.integers(1, 24), st.integers(0, 999))
def test_every_pixel_can_be_read_back_from_the_text(width: int, height: int, seed: int) -> None:
    picture = random_picture(width, height, seed)
    for pixels in (
        unblock(simulator.text(picture), " ▀▄█"),
        unblock(simulator.text(picture, "ascii"), " '.:"),
        unbraille(simulator.text(picture, "braille")),
    ):
        assert np.array_equal(pixels[:height, :width], picture)
        assert pixels.sum() == picture.sum()


def test_gray_levels_are_lit_from_the_middle_on() -> None:
    assert simulator.text(np.arange(16, dtype=np.uint8)[None], "ascii", max_level=15) == " " * 8 + "'" * 8


def test_unknown_style() -> None:
    with pytest.raises(ValueError, match="style: 'emoji' is none of blocks, braille, ascii"):
        simulator.text(np.zeros((2, 2), np.uint8), "emoji")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="style"):
        simulator.TerminalView(io.StringIO(), style="emoji")  # type: ignore[arg-type]


class Terminal(io.StringIO):
    """A terminal of so many columns and rows, as far as the view needs one."""

    def __init__(self, columns: int, rows: int, encoding: str = "utf-8") -> None:
        super().__init__()
        self.columns, self.rows, self._encoding = columns, rows, encoding
        self.lines = [""] * rows
        self.row, self.scrolled = 0, 0
        self.cursor = True

    @property
    def encoding(self) -> str:
        return self._encoding

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        text.encode(self._encoding)
        for token in re.findall(r"\x1b\[[?\d]*[A-Za-z]|\n|\r|[^\x1b\n\r]+", text):
            self._take(token)
        return super().write(text)

    def _take(self, token: str) -> None:
        if token == "\n":
            self.row += 1
            if self.row == self.rows:
                self.lines = [*self.lines[1:], ""]
                self.row -= 1
                self.scrolled += 1
        elif token == "\x1b[J":
            self.lines[self.row :] = [""] * (self.rows - self.row)
        elif up := re.fullmatch(r"\x1b\[(\d+)A", token):
            assert int(up[1]) <= self.row, "the view moves above the screen"
            self.row -= int(up[1])
        elif token in ("\x1b[?25l", "\x1b[?25h"):
            self.cursor = token[-1] == "h"
        elif token not in ("\r", "\x1b[K", "\x1b[0m"):
            assert not token.startswith("\x1b"), token
            assert len(token) <= self.columns, "the line wraps"
            self.lines[self.row] = token


Sized = Callable[..., Terminal]


@pytest.fixture
def sized(monkeypatch: pytest.MonkeyPatch) -> Sized:
    def size(columns: int, rows: int, encoding: str = "utf-8") -> Terminal:
        monkeypatch.setenv("COLUMNS", str(columns))
        monkeypatch.setenv("LINES", str(rows))
        return Terminal(columns, rows, encoding)

    return size


def test_it_redraws_in_place(sized: Sized) -> None:
    terminal = sized(140, 50)
    terminal.write("$ paneldraw demo\n")
    with simulator.TerminalView(terminal) as view:
        for seed in range(5):
            picture = random_picture(128, 64, seed)
            view.show(picture, caption=f"frame {seed}")
            assert not terminal.cursor
    assert terminal.cursor
    assert terminal.lines[0] == "$ paneldraw demo"
    assert terminal.lines[1] == "┌" + "─" * 128 + "┐"
    assert terminal.lines[2:34] == [f"│{line}│" for line in simulator.text(picture).split("\n")]
    assert terminal.lines[35:] == ["frame 4"] + [""] * 14
    assert terminal.row == 36


def test_a_smaller_picture_leaves_nothing_of_a_larger_one(sized: Sized) -> None:
    terminal = sized(140, 50)
    with simulator.TerminalView(terminal, border=False) as view:
        view.show(np.ones((64, 128), np.uint8), caption="all lit")
        view.show(np.ones((16, 96), np.uint8))
    assert terminal.lines == ["█" * 96] * 8 + [""] * 42


@pytest.mark.parametrize(
    ("columns", "rows", "encoding", "mark"),
    [(130, 36, "utf-8", "█"), (129, 50, "utf-8", "⣿"), (140, 35, "utf-8", "⣿"), (140, 50, "ascii", ":")],
)
def test_the_style_suits_the_terminal(sized: Sized, columns: int, rows: int, encoding: str, mark: str) -> None:
    terminal = sized(columns, rows, encoding)
    with simulator.TerminalView(terminal) as view:
        view.show(np.ones((64, 128), np.uint8))
    assert mark in terminal.lines[1]
    assert terminal.scrolled == 0


def test_what_is_too_large_is_cut_off(sized: Sized) -> None:
    terminal = sized(40, 10)
    with simulator.TerminalView(terminal) as view:
        for _ in range(3):
            view.show(np.ones((64, 128), np.uint8))
    assert terminal.scrolled == 0
    assert terminal.lines[0] == "┌" + "─" * 39
    assert terminal.lines[8] == "│" + "⣿" * 39


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError, SystemExit])
def test_the_terminal_is_in_order_whatever_happens(sized: Sized, error: type[BaseException]) -> None:
    terminal = sized(140, 50)

    def draw() -> None:
        with simulator.TerminalView(terminal) as view:
            view.show(np.ones((16, 96), np.uint8))
            raise error

    with pytest.raises(error):
        draw()
    assert terminal.cursor
    assert terminal.getvalue().endswith("\x1b[0m\x1b[?25h")


def test_a_pipe_gets_the_last_picture_once() -> None:
    pipe = io.StringIO()
    with simulator.TerminalView(pipe, style="ascii", border=False) as view:
        for seed in range(3):
            picture = random_picture(96, 16, seed)
            view.show(picture)
    assert pipe.getvalue() == simulator.text(picture, "ascii") + "\n"


def test_it_shows_chips_frames_and_arrays_alike(sized: Sized) -> None:
    chip, picture = started(96, 16), random_picture(96, 16, 1)
    send(chip, picture)
    chip.settle(0, 0)
    screens = []
    for source in (chip, chip.frames[-1], picture):
        terminal = sized(140, 50)
        with simulator.TerminalView(terminal) as view:
            view.show(source)
        screens.append(terminal.lines)
    assert screens[0] == screens[1] == screens[2]


def test_leaving_twice_or_without_a_picture_writes_nothing(sized: Sized) -> None:
    terminal = sized(140, 50)
    view = simulator.TerminalView(terminal)
    view.close()
    view.show(np.ones((2, 2), np.uint8))
    view.close()
    once = terminal.getvalue()
    view.close()
    assert terminal.getvalue() == once
    pipe = io.StringIO()
    with simulator.TerminalView(pipe):
        pass
    assert pipe.getvalue() == ""
