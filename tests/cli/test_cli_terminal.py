"""The command in a real pseudo-terminal: live pictures, signals, and the state in which it leaves the terminal."""

from __future__ import annotations

import os
import re
import select
import signal
import sys
import time

import pyte
import pytest
from running import ENVIRONMENT, lit
from simulator.terminals import Screen

pty = pytest.importorskip("pty", reason="pseudo-terminals are a thing of Unix")

ESCAPE = r"\x1b\[\??[\d;]*[A-Za-z]"


class Terminal:
    """A process in a terminal of its own, and what it wrote there."""

    def __init__(self, *arguments, columns=140, rows=40):
        import fcntl
        import struct
        import termios

        environment = {**ENVIRONMENT, "TERM": "xterm-256color", "PYTHONIOENCODING": "utf-8"}
        environment.pop("COLUMNS", None), environment.pop("LINES", None)
        ready, go = os.pipe()
        self.pid, self.master = pty.fork()
        if not self.pid:
            os.read(ready, 1)
            os.execve(sys.executable, [sys.executable, "-m", "paneldraw", *map(str, arguments)], environment)
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        self.before = termios.tcgetattr(self.master)
        os.write(go, b".")
        os.close(ready), os.close(go)
        self.output = b""
        self.code = None

    def read(self, until=None, deadline=60):
        """Read until a pattern has come, or to the end; then the exit code is known."""
        end = time.monotonic() + deadline
        while until is None or not re.search(until, self.output):
            assert time.monotonic() < end, self.output[-500:]
            if not select.select([self.master], [], [], 1)[0]:
                continue
            try:
                chunk = os.read(self.master, 65536)
            except OSError:  # Linux: the last writer has closed its end
                chunk = b""
            if not chunk:
                break
            self.output += chunk
        if until is None:
            self.code = os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])
        return self.output.decode(errors="replace")  # a signal may cut a character in two

    def close(self):
        if self.code is None:
            os.kill(self.pid, signal.SIGKILL)
            os.waitpid(self.pid, 0)
        os.close(self.master)


@pytest.fixture
def terminal():
    opened = []

    def start(*arguments, **size):
        opened.append(Terminal(*arguments, **size))
        return opened[-1]

    yield start
    for each in opened:
        each.close()


def seen(window, columns=140, rows=40):
    """What a window shows, checked to be as a shell needs it."""
    screen = Screen(columns, rows)
    pyte.ByteStream(screen).feed(window.output)
    assert screen.margins is None
    assert not screen.cursor.hidden
    assert screen.cursor.attrs == pyte.screens.Char(" ")
    assert b"\x1b[?1049h" not in window.output
    lines = [line.rstrip() for line in screen.display]
    assert "Traceback" not in "\n".join(lines)
    return lines


def test_a_demo_plays_in_a_terminal(terminal):
    window = terminal("demo", "--seconds", "1.5", "--fps", "20")
    output = window.read()
    assert window.code == 0
    assert output.count("\x1b[?25l") > 3
    lines = seen(window)
    assert lines[-3].startswith("└")
    assert lines[-2].startswith("scene: ")
    assert lines[-1] == ""
    assert lit("\n".join(lines)) > 200


def test_a_demo_fits_a_usual_terminal(terminal):
    window = terminal("demo", "--frames", 3, "--panel", "sim://ssd1306", columns=80, rows=24)
    output = window.read()
    lines = seen(window, 80, 24)
    assert [line[:1] for line in lines[-20:]] == ["┌", *"│" * 16, "└", "s", ""]
    assert all(line.endswith("│") for line in lines[-19:-3])
    assert re.search("[\u2801-\u28ff]", output), "no braille dots"


@pytest.mark.parametrize(
    ("press", "code"),
    [
        (lambda window: os.write(window.master, b"\x03"), 130),
        pytest.param(lambda window: os.kill(window.pid, signal.SIGINT), 130, marks=pytest.mark.thorough),
        (lambda window: os.kill(window.pid, signal.SIGTERM), 143),
        pytest.param(lambda window: os.kill(window.pid, signal.SIGHUP), 129, marks=pytest.mark.thorough),
    ],
    ids=["ctrl-c", "SIGINT", "SIGTERM", "SIGHUP"],
)
def test_stopping_leaves_the_terminal_in_order(terminal, press, code):
    import termios

    window = terminal("demo", "--seconds", "inf")
    window.read(until=rb"(\x1b\[\?25h(?s:.)*){3}")
    press(window)
    state = termios.tcgetattr(window.master)
    window.read()
    assert window.code == code
    seen(window)
    assert state == window.before


def test_saving_in_a_terminal_counts_on_one_line(terminal, tmp_path):
    window = terminal("demo", "--save", tmp_path / "a.gif", "--frames", "5")
    window.read()
    assert window.code == 0
    assert (tmp_path / "a.gif").exists()
    assert seen(window)[-2].startswith("wrote ")


def test_the_shell_gets_its_prompt_on_a_line_of_its_own(terminal):
    for arguments in (("demo", "--frames", "2"), ("text", "Hi"), ("info",)):
        assert re.sub(ESCAPE, "", terminal(*arguments).read()).endswith("\n")
