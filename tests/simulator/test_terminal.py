"""A picture as text, and the view that redraws in place, on a real pty with an emulated terminal."""

from __future__ import annotations

import contextlib
import io
import threading
import time
from collections.abc import Callable, Iterator

import numpy as np
import pyte
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from paneldraw import simulator
from paneldraw.simulator.terminal import Shown

from .helpers import random_picture, send, started
from .terminals import Screen, Terminal, in_order


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


PLAIN = {"TERM": "xterm", "COLORTERM": "", "NO_COLOR": ""}
Sized = Callable[..., Terminal]


@pytest.fixture
def sized(monkeypatch: pytest.MonkeyPatch) -> Iterator[Sized]:
    with contextlib.ExitStack() as stack:

        def size(columns: int, rows: int, encoding: str = "utf-8", **environment: str) -> Terminal:
            for name, value in (PLAIN | environment).items():
                monkeypatch.setenv(name, value)
            return stack.enter_context(Terminal(columns, rows, encoding))

        yield size


def test_it_redraws_in_place_and_what_is_printed_scrolls_above(sized: Sized) -> None:
    terminal = sized(140, 45)
    terminal.stream.write("$ paneldraw demo\n")
    with simulator.TerminalView(terminal.stream) as view:
        for seed in range(20):
            picture = random_picture(128, 64, seed)
            view.show(picture, caption=f"frame {seed}")
            terminal.stream.write(f"said {seed}\n")
        lines = terminal.lines()
        assert lines[:10] == [*(f"said {seed}" for seed in range(11, 20)), ""]
        assert lines[10] == "┌" + "─" * 128 + "┐"
        assert lines[11:43] == [f"│{line}│" for line in simulator.text(picture).split("\n")]
        assert lines[44] == "frame 19"
    assert terminal.lines() == [*lines[1:], ""]
    assert in_order(terminal)
    assert (terminal.screen.cursor.y, terminal.screen.cursor.x) == (44, 0)


def test_a_smaller_picture_leaves_nothing_of_a_larger_one(sized: Sized) -> None:
    terminal = sized(140, 50)
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.show(np.ones((64, 128), np.uint8), caption="all lit")
        view.show(np.ones((16, 96), np.uint8))
        assert terminal.lines() == [""] * 42 + ["█" * 96] * 8


@pytest.mark.parametrize(
    ("columns", "rows", "encoding", "mark"),
    [(130, 37, "utf-8", "█"), (129, 50, "utf-8", "⣿"), (140, 36, "utf-8", "⣿"), (140, 50, "ascii", ":")],
)
def test_the_style_suits_the_terminal(sized: Sized, columns: int, rows: int, encoding: str, mark: str) -> None:
    terminal = sized(columns, rows, encoding)
    with simulator.TerminalView(terminal.stream) as view:
        view.show(np.ones((64, 128), np.uint8), "all lit")
        lines = terminal.lines()
    inner = lines[-4]
    assert set(inner[1:-1]) == {mark}
    assert lines[-1] == "all lit"


SIZES = [(80, 24), (66, 19), (40, 12), (30, 40), (20, 8), (8, 30), (200, 6), (10, 5), (3, 4)]


@pytest.mark.parametrize(("columns", "rows"), SIZES)
@pytest.mark.parametrize("shape", [(64, 128), (16, 96), (128, 128), (8, 32)])
def test_what_is_too_large_is_shown_smaller_and_whole(
    sized: Sized, columns: int, rows: int, shape: tuple[int, int]
) -> None:
    terminal = sized(columns, rows)
    picture = np.zeros(shape, np.uint8)
    picture[[0, -1]] = picture[:, [0, -1]] = 1  # a frame, of which each side must be seen
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.show(picture)
        lines = terminal.lines()
    seen = [line for line in lines if line]
    assert 0 < len(seen) <= rows - 2
    lit = unblock("\n".join(seen), " ▀▄█") if set("".join(seen)) <= set(" ▀▄█") else unbraille(_even(seen))
    ys, xs = np.nonzero(lit)
    box = lit[: ys.max() + 1, : xs.max() + 1]
    assert all(side.all() for side in (box[0], box[-1], box[:, 0], box[:, -1]))
    if columns > 20 and rows > 12:
        assert shape[1] / shape[0] == pytest.approx(box.shape[1] / box.shape[0], rel=0.15)


def _even(lines: list[str]) -> str:
    width = max(map(len, lines))
    return "\n".join(line.ljust(width, "\u2800").replace(" ", "\u2800") for line in lines)


@pytest.mark.parametrize(("columns", "rows"), [(200, 60), (80, 24), (40, 20), (12, 8)])
def test_several_panels_are_all_seen(sized: Sized, columns: int, rows: int) -> None:
    terminal = sized(columns, rows)
    pictures = [Shown(np.ones((64, 128), np.uint8), 1, simulator.Look(), f"panel {n}") for n in range(3)]
    with simulator.TerminalView(terminal.stream) as view:
        view.draw(pictures)
        lines = terminal.lines()
    text = "\n".join(lines)
    if columns > 12:
        assert [text.count(corner) for corner in "┌┐└┘"] == [3] * 4
        assert all(f"panel {n}" in text for n in range(3))
    else:
        assert [len(line.split()) for line in lines if line] == [1] * 6  # two lines each


# -- Colors

RAMP = np.tile(np.arange(16, dtype=np.uint8).repeat(2), (8, 1))


def test_grays_have_their_colors_where_the_terminal_has_all(sized: Sized) -> None:
    terminal = sized(60, 12, COLORTERM="truecolor")
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.draw([Shown(RAMP, 15, simulator.find_look("blue"), "")])
        seen = terminal.colors(0, 8, 32, 4)
    assert np.array_equal(seen, simulator.find_look("blue").colors(RAMP, 15))


def test_grays_have_the_nearest_colors_where_there_are_256(sized: Sized) -> None:
    terminal = sized(60, 12, TERM="xterm-256color")
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.draw([Shown(RAMP, 15, simulator.Look(lit="#ffffff", dark="#000000"), "")])
        seen = terminal.colors(0, 8, 32, 4).astype(int)
    wanted = np.rint(RAMP * 17.0).astype(int)[..., None]
    assert np.abs(seen - wanted).max() <= 8
    assert len({tuple(color) for color in seen[0].tolist()}) == 16


def test_one_bit_has_the_colors_of_its_look(sized: Sized) -> None:
    look = simulator.find_look("yellow-blue")
    picture = random_picture(40, 32, 3)
    terminal = sized(60, 30, COLORTERM="24bit")
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.draw([Shown(picture, 1, look, "")])
        seen = terminal.colors(0, 14, 40, 16)
    assert np.array_equal(seen, look.colors(picture))


@pytest.mark.parametrize("environment", [{"TERM": "vt220"}, {"NO_COLOR": "1", "COLORTERM": "truecolor"}])
def test_grays_are_dithered_where_there_are_no_colors(sized: Sized, environment: dict[str, str]) -> None:
    terminal = sized(80, 20, **environment)
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.draw([Shown(np.full((16, 64), level, np.uint8), 15, simulator.Look(), "") for level in (4,)])
        lines = terminal.lines()[12:]
        assert {cell.fg for row in range(20) for cell in terminal.screen.buffer[row].values()} <= {"default"}
    lit = unblock("\n".join(line.ljust(64) for line in lines), " ▀▄█")
    assert lit.mean() == pytest.approx(4 / 15, abs=0.03)


# -- Sizes that change


@pytest.mark.parametrize("sizes", [[(100, 30), (140, 45)], [(140, 45), (60, 20), (140, 40), (61, 44)]])
def test_resizing_leaves_nothing_behind(sized: Sized, sizes: list[tuple[int, int]]) -> None:
    terminal = sized(*sizes[0])
    picture = random_picture(128, 64, 1)
    terminal.stream.write("said before\n")
    with simulator.TerminalView(terminal.stream) as view:
        view.show(picture, "caption")
        for columns, rows in sizes[1:]:
            terminal.lines()
            terminal.resize(columns, rows)
            view.show(picture, "caption")
            terminal.stream.write("said\n")
            lines = terminal.lines()
            fresh = Terminal(columns, rows)
            with fresh, simulator.TerminalView(fresh.stream) as other:
                other.show(picture, "caption")
                alone = [line for line in fresh.lines() if line]
            count = len(alone)
            assert lines[-count:] == alone
            assert set(lines[:-count]) <= {"", "said", "said before"}
            assert "said" in lines


def test_a_live_view_follows_its_chips_and_the_size_of_the_window(
    sized: Sized, monkeypatch: pytest.MonkeyPatch
) -> None:
    terminal = sized(140, 45)
    monkeypatch.setattr("sys.stdout", terminal.stream)
    chip = started(96, 16)
    with simulator.open_view("terminal", [chip], ["hall"]) as view:
        for seed in range(3):
            picture = random_picture(96, 16, seed)
            send(chip, picture)
            chip.settle(seed, 100)
            lines = terminal.wait_for(f"hall: {seed + 1} frame")
            assert lines[-10:-2] == [f"│{line}│" for line in simulator.text(picture).split("\n")]
        terminal.resize(60, 20)
        view.add(started(96, 16), "stairs")
        terminal.wait_for("stairs: 0 frames")
        lines = terminal.lines()
        assert max(map(len, lines)) <= 60
        assert "".join(lines).count("┌") == 2
        view.remove(chip)
        send(chip, picture)
        while any("hall" in line for line in terminal.shown()):
            time.sleep(0.01)
    terminal.lines()
    assert in_order(terminal)
    assert not [thread for thread in threading.enumerate() if thread.name == "paneldraw terminal"]


def test_a_terminal_that_went_away_is_no_error(monkeypatch: pytest.MonkeyPatch) -> None:
    class Gone(io.StringIO):
        def isatty(self) -> bool:
            return True

        def write(self, text: str) -> int:
            raise OSError(5, "Input/output error")

    monkeypatch.setattr("sys.stdout", Gone())
    chip = started(96, 16)
    with simulator.open_view("terminal", [chip]):
        send(chip, random_picture(96, 16, 1))
        chip.settle(0, 0)
        while threading.active_count() > 1 and any(t.name == "paneldraw terminal" for t in threading.enumerate()):
            time.sleep(0.01)


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError, SystemExit])
def test_the_terminal_is_in_order_whatever_happens(sized: Sized, error: type[BaseException]) -> None:
    terminal = sized(140, 50)

    def draw() -> None:
        with simulator.TerminalView(terminal.stream) as view:
            view.show(np.ones((16, 96), np.uint8))
            raise error

    with pytest.raises(error):
        draw()
    terminal.lines()
    assert in_order(terminal)


class Cut(io.StringIO):
    """A terminal's stream whose writing a signal breaks off once, so many characters from the start."""

    def __init__(self, room: int) -> None:
        super().__init__()
        self.room = room

    def isatty(self) -> bool:
        return True

    def write(self, text: str) -> int:
        cut, self.room = self.room, self.room - len(text)
        if 0 <= cut < len(text):
            super().write(text[:cut])
            raise KeyboardInterrupt
        return super().write(text)


def test_the_terminal_is_in_order_wherever_a_signal_cuts_what_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("paneldraw.simulator.terminal._terminal_size", lambda stream: (40, 20))
    pictures = [random_picture(16, 8, seed) for seed in range(2)]

    def written(stream: Cut) -> str:
        with contextlib.suppress(KeyboardInterrupt), simulator.TerminalView(stream) as view:
            for picture in pictures:
                view.show(picture)
        return stream.getvalue()

    whole = written(Cut(-1))
    second = whole.index("\x1b[?25h")  # the room for a picture is made with the first
    shown = [simulator.text(picture, "ascii").split("\n") for picture in pictures]
    for cut in range(len(whole)):
        screen = Screen(40, 20)
        pyte.Stream(screen).feed(written(Cut(cut)).replace("\n", "\r\n"))
        assert screen.margins is None, cut
        assert not screen.cursor.hidden, cut
        assert screen.cursor.attrs == pyte.screens.Char(" "), cut
        if cut > second:
            assert [line[1:17] for line in screen.display[14:18]] in shown, cut


# -- No terminal


def test_a_pipe_gets_the_last_picture_once() -> None:
    pipe = io.StringIO()
    with simulator.TerminalView(pipe, style="ascii", border=False) as view:
        for seed in range(3):
            picture = random_picture(96, 16, seed)
            view.show(picture)
    assert pipe.getvalue() == simulator.text(picture, "ascii") + "\n"


def test_a_dumb_terminal_gets_plain_text(sized: Sized) -> None:
    terminal = sized(140, 50, TERM="dumb", COLORTERM="truecolor")
    picture = random_picture(96, 16, 1)
    with simulator.TerminalView(terminal.stream, border=False) as view:
        view.show(picture)
        view.show(picture)
    assert terminal.lines()[:9] == [line.rstrip() for line in simulator.text(picture).split("\n")] + [""]


def test_it_shows_chips_frames_and_arrays_alike(sized: Sized) -> None:
    chip, picture = started(96, 16), random_picture(96, 16, 1)
    send(chip, picture)
    chip.settle(0, 0)
    screens = []
    for source in (chip, chip.frames[-1], picture):
        terminal = sized(140, 50)
        with simulator.TerminalView(terminal.stream) as view:
            view.show(source)
        screens.append(terminal.lines())
    assert screens[0] == screens[1] == screens[2]


def test_leaving_twice_or_without_a_picture_writes_nothing(sized: Sized) -> None:
    terminal = sized(140, 50)
    view = simulator.TerminalView(terminal.stream)
    view.close()
    assert terminal.lines() == [""] * 50
    view.show(np.ones((2, 2), np.uint8))
    view.close()
    once = terminal.lines()
    view.close()
    assert terminal.lines() == once
    pipe = io.StringIO()
    with simulator.TerminalView(pipe):
        pass
    assert pipe.getvalue() == ""
