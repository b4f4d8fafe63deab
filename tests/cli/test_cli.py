"""The command, run as a person runs it: as a process, in a pipe and in a terminal."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import sysconfig

import numpy as np
import pytest
from PIL import Image
from running import ENVIRONMENT, assert_one_line_of_advice, lit, picture_of

from paneldraw.cli import _parser, main, playback

COMMANDS = ["demo", "show", "text", "detect", "info"]


@pytest.fixture
def picture(tmp_path):
    """A wide picture, white on its left half."""
    levels = np.zeros((40, 160), np.uint8)
    levels[:, :80] = 255
    path = tmp_path / "picture.png"
    Image.fromarray(levels).save(path)
    return path


# A demo with nobody watching


def test_a_strangers_first_command(run):
    done = run("demo")
    assert done.returncode == 0
    assert re.fullmatch(r"(drawing: \d+ of 300 frames\n)*", done.stderr)
    assert "\x1b" not in done.stdout
    assert [len(line) for line in picture_of(done.stdout)] == [128] * 32
    assert lit(done.stdout) > 200
    assert "300 frames" in done.stdout.splitlines()[-1]


def test_a_demo_has_grays_unless_a_panel_is_named(run):
    wholes = {"": 4096, "sim://ssd1306": 1024, "sim://sh1122": 8192}
    for url, whole in wholes.items():
        done = run("demo", "--frames", 1, **({"PANELDRAW_PANEL": url} if url else {}))
        assert done.stdout.splitlines()[-1].endswith(f"bytes on the wire for {whole} of pixels")
    assert run("text", "Hi").stdout.count("█") > 5


def test_a_pipe_that_knows_no_unicode(run):
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
def test_a_demo_on_panels_of_other_sizes(run, size):
    width, height = map(int, size.split("x"))
    done = run("demo", "--frames", 2, "--panel", f"sim://ssd1306?size={size}")
    assert done.returncode == 0, done.stderr
    assert [len(line) for line in picture_of(done.stdout)] == [width] * (height // 2)


# Files


def test_a_saved_demo_moves(run, tmp_path):
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


def test_what_is_saved_is_the_same_every_time(run, tmp_path):
    for name in ("a.gif", "b.gif"):
        run("demo", "clock", "--save", tmp_path / name, "--frames", 3)
    assert (tmp_path / "a.gif").read_bytes() == (tmp_path / "b.gif").read_bytes()


def test_a_saved_still_is_the_moment_asked_for(run, tmp_path):
    for seconds in ("1", "4"):
        done = run("demo", "clock", "--save", tmp_path / f"{seconds}.png", "--seconds", seconds)
        assert done.returncode == 0, done.stderr
    stills = [Image.open(tmp_path / f"{seconds}.png") for seconds in ("1", "4")]
    assert stills[0].size == stills[1].size
    assert stills[0].convert("L").tobytes() != stills[1].convert("L").tobytes()


def test_long_work_says_how_far_it_is(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(playback, "PATIENCE", 0)
    assert main(["demo", "--save", str(tmp_path / "a.gif"), "--frames", "5", "--panel", "sim://ssd1306"]) == 0
    told = capsys.readouterr().err.splitlines()
    assert [line for line in told if line.startswith("drawing")] == [f"drawing: {n} of 5 frames" for n in range(1, 6)]
    assert told[-1] == "writing: 5 of 5 frames"


def test_a_file_that_cannot_be_written(run, tmp_path):
    done = run("demo", "--save", tmp_path / "nowhere" / "a.gif", "--frames", 2)
    assert_one_line_of_advice(done, 1)


# Pictures and text


def test_a_picture_is_shown_as_large_as_fits(run, picture):
    shown = picture_of(run("show", picture).stdout)
    rows = [line for line in shown if line.strip()]
    assert len(rows) == 16
    assert set(rows) == {"█" * 64 + " " * 64}


@pytest.mark.parametrize(
    ("options", "share"), [(["--fit", "cover"], 1 / 2), (["--fit", "stretch"], 1 / 2), (["--invert"], 1 / 4)]
)
def test_ways_to_show_a_picture(run, picture, options, share):
    assert lit(run("show", picture, *options).stdout) == 128 * 64 * share


def test_grey_is_dithered(run, tmp_path):
    Image.new("L", (128, 64), 128).save(tmp_path / "grey.png")
    share = lit(run("show", tmp_path / "grey.png").stdout) / (128 * 64)
    assert 0.48 < share < 0.52
    assert lit(run("show", tmp_path / "grey.png", "--dither", "none").stdout) == 128 * 64


def test_transparent_is_dark(run, tmp_path):
    Image.new("RGBA", (128, 64), (255, 255, 255, 0)).save(tmp_path / "clear.png")
    assert lit(run("show", tmp_path / "clear.png").stdout) == 0


def test_text_stands_in_the_middle(run):
    rows = picture_of(run("text", "Hello").stdout)
    filled = [index for index, line in enumerate(rows) if line.strip()]
    assert filled == [14, 15, 16, 17]
    columns = [index for index in range(128) if any(line[index] != " " for line in rows)]
    assert (columns[0], columns[-1]) == (49, 77)


def test_words_become_lines_where_they_must(run):
    rows = picture_of(run("text", "every", "word", "of", "this", "can", "be", "read").stdout)
    assert len([line for line in rows if line.strip()]) > 4
    assert not any(line[0] != " " or line[-1] != " " for line in rows)


def test_text_from_standard_input_and_larger(run):
    plain = run("text", "-", stdin="21.5°C\n").stdout
    assert lit(plain) == lit(run("text", "21.5°C").stdout) > 0
    assert lit(run("text", "21.5°C", "--scale", 2).stdout) == 4 * lit(plain)


def test_text_in_a_font_of_ones_own(run, tmp_path):
    from PIL import ImageFont

    path = tmp_path / "face.ttf"
    path.write_bytes(ImageFont.load_default(10).font_bytes)
    small, large = (lit(run("text", "Hi", "--font", path, "--size", size).stdout) for size in (10, 30))
    assert 0 < small < large / 3


# What there is


def test_detect_finds_the_simulated_panel(run):
    done = run("detect", "--panel", "sim://ssd1306")
    assert done.returncode == 0
    assert "3c answers" in done.stdout
    assert "paneldraw demo --panel sim://" in done.stdout


def test_detect_without_a_bus(run):
    assert_one_line_of_advice(run("detect", "--panel", "i2c://77"), 1)


def test_info_tells_what_a_bug_report_needs(run):
    done = run("info")
    assert done.returncode == 0
    told = dict(line.split(":", 1) for line in done.stdout.splitlines())
    for name in ("paneldraw", "drawing", "Python", "platform", "numpy", "Pillow", "smbus2", "pyserial", "I2C buses"):
        assert told[name].strip(), name
    assert told["drawing"].strip().split(",")[0] in ("compiled", "interpreted")


def test_info_of_a_panel(run):
    assert "128x32" in run("info", "--panel", "sim://ssd1306?size=128x32").stdout


def test_the_installed_command_is_the_same(run):
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


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["dmo"],
        ["demo", "snake"],
        ["demo", "--save", "a.txt"],
        ["demo", "--fps", "0"],
        ["demo", "--fps", "nan"],
        ["demo", "--fps", "inf"],
        ["text", "a", "--scale", "100000"],
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
def test_wrong_usage(run, arguments):
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
def test_mistakes_are_one_line(run, arguments, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert_one_line_of_advice(run(*arguments), 1)


@pytest.mark.parametrize("content", [b"", b"no picture", b"\x89PNG\r\n\x1a\n" + b"\0" * 40])
def test_files_that_are_no_pictures(run, content, tmp_path):
    path = tmp_path / "broken.png"
    path.write_bytes(content)
    done = run("show", path)
    assert_one_line_of_advice(done, 1)
    assert "broken.png" in done.stderr


def test_a_picture_that_was_cut_off(run, picture):
    noise = np.random.default_rng(1).integers(0, 256, (64, 64), np.uint8)
    Image.fromarray(noise).save(picture)
    picture.write_bytes(picture.read_bytes()[:1000])
    assert_one_line_of_advice(run("show", picture), 1)


def test_the_environment_names_the_panel(run):
    assert_one_line_of_advice(run("text", "hi", PANELDRAW_PANEL="i2c://77"), 1)
    assert len(picture_of(run("text", "hi", PANELDRAW_PANEL="sim://ssd1306?size=128x32").stdout)) == 16


def test_a_module_of_the_command_costs_little():
    code = "import sys, paneldraw.cli; print([m for m in ('PIL', 'smbus2', 'serial') if m in sys.modules])"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize("shell", ["bash", "zsh", "tcsh"])
def test_completion_knows_every_command(shell, capsys):
    pytest.importorskip("shtab")
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    commands = _parser()._subparsers._group_actions[0].choices
    assert len(commands) > 12
    assert [name for name in commands if name not in script] == []


@pytest.mark.skipif(not shutil.which("bash"), reason="bash is not installed")
def test_bash_completes_words(capsys):
    pytest.importorskip("shtab")
    main(["completion", "bash"])
    ask = """
    COMP_WORDS=(paneldraw firmware f); COMP_CWORD=2
    "$(complete -p paneldraw | sed 's/.*-F //; s/ .*//')"
    echo "${COMPREPLY[@]}"
    """
    done = subprocess.run(["bash", "-c", capsys.readouterr().out + ask], capture_output=True, text=True)
    assert (done.stdout, done.stderr) == ("flash\n", "")


def test_completion_says_what_it_needs(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["completion", "bash"]) == 1
    assert capsys.readouterr().err == "paneldraw: shtab is not installed; run: pip install 'paneldraw[completion]'\n"


@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="argparse of another Python writes other usage lines")
def test_the_man_page_is_what_the_parser_says():
    pytest.importorskip("argparse_manpage")
    import man_page

    assert man_page.PAGE.read_text(encoding="utf-8") == man_page.page(), "run docs/man_page.py"
    assert r"paneldraw firmware flash" in man_page.page().replace(r"\fR", "").replace(r"\fI\,", "").replace(r"\/", "")
