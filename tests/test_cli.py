"""The command, run as a person runs it: as a process, in a pipe and in a terminal."""

from __future__ import annotations

import os
import re
import select
import shutil
import signal
import subprocess
import sys
import sysconfig
import time

import numpy as np
import pytest
from PIL import Image

from paneldraw.cli import main

ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PANELDRAW_PANEL"}
ESCAPE = r"\x1b\[\??[\d;]*[A-Za-z]"
COMMANDS = ["demo", "show", "text", "detect", "info"]


def run(*arguments, stdin="", **environment):
    return subprocess.run(
        [sys.executable, "-m", "paneldraw", *map(str, arguments)],
        input=stdin,
        capture_output=True,
        encoding="utf-8",
        env={**ENVIRONMENT, "PYTHONIOENCODING": "utf-8", **environment},
        timeout=120,
    )


def picture_of(output):
    """The lines between the borders of what the command printed."""
    return [line[1:-1] for line in output.splitlines() if line.startswith("│")]


def lit(output):
    return sum({"█": 2, "▀": 1, "▄": 1}.get(char, 0) for line in picture_of(output) for char in line)


@pytest.fixture
def picture(tmp_path):
    """A wide picture, white on its left half."""
    levels = np.zeros((40, 160), np.uint8)
    levels[:, :80] = 255
    path = tmp_path / "picture.png"
    Image.fromarray(levels).save(path)
    return path


# A demo with nobody watching


def test_a_strangers_first_command():
    done = run("demo")
    assert done.returncode == 0
    assert done.stderr == ""
    assert "\x1b" not in done.stdout
    assert [len(line) for line in picture_of(done.stdout)] == [128] * 32
    assert lit(done.stdout) > 200
    assert "300 frames" in done.stdout.splitlines()[-1]


def test_a_pipe_that_knows_no_unicode():
    done = run("demo", "cube", "--frames", 2, PYTHONIOENCODING="ascii")
    assert done.returncode == 0
    assert done.stdout.isascii()
    assert len(done.stdout.splitlines()) == 35


def test_a_reader_who_leaves_early():
    command = f"{sys.executable} -m paneldraw demo --frames 2 | head -n 1"
    done = subprocess.run(command, shell=True, capture_output=True, text=True, env=ENVIRONMENT, timeout=60)
    assert done.stdout.startswith("┌")
    assert done.stderr == ""


@pytest.mark.parametrize("size", ["128x32", "72x40", "64x48"])
def test_a_demo_on_panels_of_other_sizes(size):
    width, height = map(int, size.split("x"))
    done = run("demo", "--frames", 2, "--panel", f"sim://ssd1306?size={size}")
    assert done.returncode == 0, done.stderr
    assert [len(line) for line in picture_of(done.stdout)] == [width] * (height // 2)


# Files


def test_a_saved_demo_moves(tmp_path):
    path = tmp_path / "scene.gif"
    done = run("demo", "--save", path, "--frames", 12, "--fps", 10)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == f"wrote {path}: 12 frames"
    with Image.open(path) as gif:
        pictures, durations = [], []
        for index in range(gif.n_frames):
            gif.seek(index)
            pictures.append(gif.convert("L").tobytes())
            durations.append(gif.info["duration"])
        assert gif.info["loop"] == 0
        assert gif.size[0] > 2 * 128
    assert len(set(pictures)) == 12
    assert set(durations[:-1]) == {100}


def test_what_is_saved_is_the_same_every_time(tmp_path):
    for name in ("a.gif", "b.gif"):
        run("demo", "clock", "--save", tmp_path / name, "--frames", 3)
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()


def test_a_saved_still_is_the_moment_asked_for(tmp_path):
    for seconds in ("1", "4"):
        done = run("demo", "clock", "--save", tmp_path / f"{seconds}.png", "--seconds", seconds)
        assert done.returncode == 0, done.stderr
    stills = [Image.open(tmp_path / f"{seconds}.png") for seconds in ("1", "4")]
    assert stills[0].size == stills[1].size
    assert stills[0].convert("L").tobytes() != stills[1].convert("L").tobytes()


def test_long_work_says_how_far_it_is(tmp_path):
    done = run("demo", "--save", tmp_path / "long.gif", "--seconds", "40", "--fps", "50")
    assert done.returncode == 0
    assert re.search(r"^(drawing|writing): \d+ of 2000 frames$", done.stderr, re.MULTILINE)


def test_a_file_that_cannot_be_written(tmp_path):
    done = run("demo", "--save", tmp_path / "nowhere" / "a.gif", "--frames", 2)
    assert_one_line_of_advice(done, 1)


# Pictures and text


def test_a_picture_is_shown_as_large_as_fits(picture):
    shown = picture_of(run("show", picture).stdout)
    rows = [line for line in shown if line.strip()]
    assert len(rows) == 16
    assert set(rows) == {"█" * 64 + " " * 64}


@pytest.mark.parametrize(
    ("options", "share"), [(["--fit", "cover"], 1 / 2), (["--fit", "stretch"], 1 / 2), (["--invert"], 1 / 4)]
)
def test_ways_to_show_a_picture(picture, options, share):
    assert lit(run("show", picture, *options).stdout) == 128 * 64 * share


def test_grey_is_dithered(tmp_path):
    Image.new("L", (128, 64), 128).save(tmp_path / "grey.png")
    share = lit(run("show", tmp_path / "grey.png").stdout) / (128 * 64)
    assert 0.48 < share < 0.52
    assert lit(run("show", tmp_path / "grey.png", "--dither", "none").stdout) == 128 * 64


def test_transparent_is_dark(tmp_path):
    Image.new("RGBA", (128, 64), (255, 255, 255, 0)).save(tmp_path / "clear.png")
    assert lit(run("show", tmp_path / "clear.png").stdout) == 0


def test_text_stands_in_the_middle():
    rows = picture_of(run("text", "Hello").stdout)
    filled = [index for index, line in enumerate(rows) if line.strip()]
    assert filled == [14, 15, 16, 17]
    columns = [index for index in range(128) if any(line[index] != " " for line in rows)]
    assert (columns[0], columns[-1]) == (49, 77)


def test_words_become_lines_where_they_must():
    rows = picture_of(run("text", "every", "word", "of", "this", "can", "be", "read").stdout)
    assert len([line for line in rows if line.strip()]) > 4
    assert not any(line[0] != " " or line[-1] != " " for line in rows)


def test_text_from_standard_input_and_larger():
    plain = run("text", "-", stdin="21.5°C\n").stdout
    assert lit(plain) == lit(run("text", "21.5°C").stdout) > 0
    assert lit(run("text", "21.5°C", "--scale", 2).stdout) == 4 * lit(plain)


def test_text_in_a_font_of_ones_own(tmp_path):
    from PIL import ImageFont

    path = tmp_path / "face.ttf"
    path.write_bytes(ImageFont.load_default(10).font_bytes)
    small, large = (lit(run("text", "Hi", "--font", path, "--size", size).stdout) for size in (10, 30))
    assert 0 < small < large / 3


# What there is


def test_detect_finds_the_simulated_panel():
    done = run("detect", "--panel", "sim://ssd1306")
    assert done.returncode == 0
    assert "3c answers" in done.stdout
    assert "paneldraw demo --panel sim://" in done.stdout


def test_detect_without_a_bus():
    assert_one_line_of_advice(run("detect", "--panel", "i2c://77"), 1)


def test_info_tells_what_a_bug_report_needs():
    done = run("info")
    assert done.returncode == 0
    told = dict(line.split(":", 1) for line in done.stdout.splitlines())
    for name in ("paneldraw", "drawing", "Python", "platform", "numpy", "Pillow", "smbus2", "pyserial", "I2C buses"):
        assert told[name].strip(), name
    assert told["drawing"].strip().split(",")[0] in ("compiled", "interpreted")


def test_info_of_a_panel():
    assert "128x32" in run("info", "--panel", "sim://ssd1306?size=128x32").stdout


def test_the_installed_command_is_the_same():
    script = shutil.which("paneldraw", path=sysconfig.get_path("scripts"))
    assert script, "install the project to test it"
    done = subprocess.run([script, "--version"], capture_output=True, text=True, timeout=60)
    assert done.stdout == run("--version").stdout
    assert re.fullmatch(r"paneldraw \d+\.\d+\.\d+\S*\n", done.stdout)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_takes_a_panel_and_explains_itself(command, capsys):
    with pytest.raises(SystemExit) as left:
        main([command, "--help"])
    assert left.value.code == 0
    assert "--panel" in capsys.readouterr().out


# Mistakes


def assert_one_line_of_advice(done, code):
    assert done.returncode == code, done.stderr
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("paneldraw")
    assert "Traceback" not in done.stdout + done.stderr
    assert "Errno" not in lines[0]


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["dmo"],
        ["demo", "snake"],
        ["demo", "--save", "a.txt"],
        ["demo", "--fps", "0"],
        ["demo", "--fps", "nan"],
        ["demo", "--frames", "-1"],
        ["demo", "--frames", "1.5"],
        ["demo", "--seconds", "soon"],
        ["demo", "--seconds", "1", "--frames", "1"],
        ["show"],
        ["show", "a.png", "--dither", "salt"],
        ["text"],
        ["text", "a", "--size", "-2"],
        ["text", "a", "--size", "9", "--scale", "2"],
        ["info", "--verbose"],
    ],
)
def test_wrong_usage(arguments):
    done = run(*arguments)
    assert_one_line_of_advice(done, 2)
    assert "--help" in done.stderr


@pytest.mark.parametrize(
    "arguments",
    [
        ["demo", "--panel", "i2c://77"],
        ["demo", "--panel", "gopher://panel"],
        ["demo", "--panel", "sim://ssd9999"],
        ["demo", "--panel", "sim://ssd1306?size=big"],
        ["demo", "--panel", "sim://ssd1306?colour=red"],
        ["demo", "--save", "endless.gif", "--seconds", "inf"],
        ["text", "hi", "--font", "nowhere.ttf"],
        ["show", "nowhere.png"],
        ["show", "."],
        ["detect", "--panel", "gopher://panel"],
    ],
)
def test_mistakes_are_one_line(arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert_one_line_of_advice(run(*arguments), 1)


@pytest.mark.parametrize("content", [b"", b"no picture", b"\x89PNG\r\n\x1a\n" + b"\0" * 40])
def test_files_that_are_no_pictures(content, tmp_path):
    path = tmp_path / "broken.png"
    path.write_bytes(content)
    done = run("show", path)
    assert_one_line_of_advice(done, 1)
    assert "broken.png" in done.stderr


def test_a_picture_that_was_cut_off(picture):
    noise = np.random.default_rng(1).integers(0, 256, (64, 64), np.uint8)
    Image.fromarray(noise).save(picture)
    picture.write_bytes(picture.read_bytes()[:1000])
    assert_one_line_of_advice(run("show", picture), 1)


def test_the_environment_names_the_panel():
    assert_one_line_of_advice(run("text", "hi", PANELDRAW_PANEL="i2c://77"), 1)
    assert len(picture_of(run("text", "hi", PANELDRAW_PANEL="sim://ssd1306?size=128x32").stdout)) == 16


# In a terminal

pty = pytest.importorskip("pty", reason="pseudo-terminals are a thing of Unix")


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


def assert_in_order(output):
    """The cursor is shown and the attributes are plain at the end, and no other screen was entered for good."""
    assert output.count("\x1b[?25l") == 1
    assert output.rindex("\x1b[?25h") > output.rindex("\x1b[?25l")
    colors = re.findall(r"\x1b\[([\d;]*)m", output)
    assert not colors or colors[-1] in ("", "0")
    assert output.count("\x1b[?1049h") == output.count("\x1b[?1049l")
    assert "Traceback" not in output


def test_a_demo_plays_in_a_terminal(terminal):
    window = terminal("demo", "--seconds", "1.5", "--fps", "20")
    output = window.read()
    assert window.code == 0
    assert_in_order(output)
    frames = output.split("\x1b[34A\r"), output.split("\x1b[35A\r")
    assert max(map(len, frames)) > 3
    last = output.replace("\r\n", "\n").rsplit("┌", 1)[1]
    assert lit(last) > 200


def test_a_demo_fits_a_usual_terminal(terminal):
    output = terminal("demo", "--frames", 3, columns=80, rows=24).read()
    lines = [re.sub(ESCAPE, "", line).strip("\r") for line in output.split("\n")]
    assert max(map(len, lines)) <= 80
    assert re.search("[\u2801-\u28ff]", output), "no braille dots"


@pytest.mark.parametrize(
    ("press", "code"),
    [
        (lambda window: os.write(window.master, b"\x03"), 130),
        (lambda window: os.kill(window.pid, signal.SIGINT), 130),
        (lambda window: os.kill(window.pid, signal.SIGTERM), 143),
        (lambda window: os.kill(window.pid, signal.SIGHUP), 129),
    ],
    ids=["ctrl-c", "SIGINT", "SIGTERM", "SIGHUP"],
)
def test_stopping_leaves_the_terminal_in_order(terminal, press, code):
    import termios

    window = terminal("demo", "--seconds", "inf")
    window.read(until=rb"\x1b\[\d+A(?s:.)*\x1b\[\d+A")
    press(window)
    state = termios.tcgetattr(window.master)
    output = window.read()
    assert window.code == code
    assert_in_order(output)
    assert state == window.before


def test_saving_in_a_terminal_counts_on_one_line(terminal, tmp_path):
    window = terminal("demo", "--save", tmp_path / "a.gif", "--frames", "5")
    output = window.read()
    assert window.code == 0
    assert (tmp_path / "a.gif").exists()
    assert_in_order(output)


def test_the_shell_gets_its_prompt_on_a_line_of_its_own(terminal):
    for arguments in (("demo", "--frames", "2"), ("text", "Hi"), ("info",)):
        assert re.sub(ESCAPE, "", terminal(*arguments).read()).endswith("\n")


def test_a_module_of_the_command_costs_little():
    code = "import sys, paneldraw.cli; print([m for m in ('PIL', 'smbus2', 'serial') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == "[]"
