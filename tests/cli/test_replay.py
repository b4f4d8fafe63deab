"""``paneldraw replay``: the picture, the frames and what was wrong, of recordings of real wires."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest
from PIL import Image
from running import assert_one_line_of_advice, lit

from paneldraw.cli import main

CAPTURES = Path(__file__).parent.parent / "simulator/captures"
ON = "0.1 3c w ack 008d14a5af\n"


def test_a_capture_is_shown_and_saved(run, tmp_path):
    done = run("replay", CAPTURES / "ssd1306-spi.txt.gz", "--save", tmp_path / "a.gif", "--look", "blue", "--scale", 2)
    assert (done.returncode, done.stderr) == (0, "")
    assert lit(done.stdout) == 7229
    assert done.stdout.splitlines()[-4:] == [
        "a log: 84 pictures in 1.157 s on SSD1306",
        "remark: 20 10: the upper bits of the addressing mode are 0",
        "remark: B0: the page pointer commands B0-B7, 00-0F and 10-1F are for page addressing mode only",
        f"wrote {tmp_path / 'a.gif'}",
    ]
    with Image.open(tmp_path / "a.gif") as animation:
        assert (animation.size, animation.n_frames) == ((260, 132), 50)


def test_the_transcript_comes_first_and_the_frames_last(run, tmp_path):
    (tmp_path / "a.log").write_text(ON + "0.5 3c w ack 0081cfa4a7\n0.9 3c w ack 00d340\n")
    done = run("replay", tmp_path / "a.log", "--transcript", "--frames")
    lines = done.stdout.splitlines()
    assert lines[0] == "  0.100000  8D 14                charge pump 14"
    assert "                                 violation: the display offset is 00 to 3F" in lines
    assert lines[-3:] == [
        "picture 1 at 0.100000 s, 6 bytes",
        "picture 2 at 0.500000 s, 6 bytes",
        "violation: D3 40: the display offset is 00 to 3F",
    ]


@pytest.mark.parametrize(
    ("arguments", "address"),
    [
        (["--panel", "i2c://1/0x3d?chip=ssd1306"], "0x3d"),
        (["--panel", "i2c://1/0x70:1/0x3c"], "0x3c"),
        (["--chip", "ssd1306", "--address", "3d"], "0x3d"),
        ([], "0x3c"),
    ],
)
def test_which_panel(run, tmp_path, arguments, address):
    (tmp_path / "a.log").write_text("0.05 70 w ack 02\n" + ON + ON.replace("3c", "3d"))
    done = run("replay", tmp_path / "a.log", *arguments)
    assert f"a log to {address}: 1 picture on SSD1306\nnothing was wrong\n" in done.stdout


def test_the_panel_of_the_environment(run, tmp_path):
    (tmp_path / "a.log").write_text("0.1 c0f01\n")
    done = run("replay", tmp_path / "a.log", PANELDRAW_PANEL="spi://0.0?chip=max7219&size=8x8")
    assert lit(done.stdout) == 64


def test_channels_are_named_on_the_command_line(run, tmp_path):
    bits = [f"{byte:08b}" for byte in (0x0F, 0x01)]
    rows = ["0.0,0,1,0"]
    for number, bit in enumerate("".join(bits)):
        rows += [f"{number + 1}e-6,0,0,{bit}", f"{number + 1.5}e-6,1,0,{bit}"]
    (tmp_path / "a.csv").write_text("\n".join(["Time [s],Channel 0,Channel 1,Channel 2", *rows, "1e-3,0,1,0", ""]))
    lost = run("replay", tmp_path / "a.csv", "--chip", "max7219")
    assert_one_line_of_advice(lost, 1)
    assert "say so with --scl and --sda for I2C, or with --clk, --mosi, --cs" in lost.stderr
    done = run("replay", tmp_path / "a.csv", "--chip", "max7219", "--clk", 0, "--cs", 1, "--mosi", "channel 2")
    assert "recording:" not in done.stdout
    assert (
        "violation: 00 00 00 00 00 00 0F 01: a select takes a register and a byte for each of 4 chips\n" in done.stdout
    )


def test_more_pictures_than_are_kept(capsys, monkeypatch, tmp_path):
    monkeypatch.setattr("paneldraw.cli.replay._HISTORY", 3)
    lines = [f"{number}.0 3c w ack 00{0xA6 + number % 2:02x}\n" for number in range(1, 9)]
    (tmp_path / "a.log").write_text("0.1 3c w ack 008d14af\n" + "".join(lines))
    assert main(["replay", str(tmp_path / "a.log"), "--save", str(tmp_path / "a.apng")]) == 0
    shown, errors = capsys.readouterr()
    assert "9 pictures in 2.000 s" in shown
    assert errors.startswith(f"paneldraw: {tmp_path / 'a.apng'} lacks the first 6 frames, 5.9 seconds")
    assert errors.count("\n") == 1


def broken(tmp_path):
    (tmp_path / "text.txt").write_text("Dear diary,\n")
    with zipfile.ZipFile(tmp_path / "capture.sal", "w") as archive:
        archive.writestr("meta.json", "{}")
    (tmp_path / "a.log").write_text(ON)
    return tmp_path


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["missing.sr"], "there is no file"),
        (["text.txt"], "text.txt: this is none of what can be read: paneldraw's logs, sigrok sessions (.sr)"),
        (["capture.sal"], "it looks like Saleae's: export it as CSV there"),
        (["a.log", "--chip", "ssd1307"], "not 'ssd1307'; did you mean"),
        (["a.log", "--chip", "max7219"], "a recording of I2C, and MAX7219s sit on SPI"),
        (["a.log", "--look", "bleu"], "did you mean blue?"),
        (["a.log", "--address", "50"], "nothing was written to a chip at 0x50; chips answered at: 0x3c"),
        (["a.log", "--panel", "serial:///dev/ttyACM0"], "give the panel's own URL, such as i2c://1/0x3c"),
    ],
)
def test_what_is_wrong_is_one_line(run, tmp_path, monkeypatch, arguments, words):
    monkeypatch.chdir(broken(tmp_path))
    done = run("replay", *arguments)
    assert_one_line_of_advice(done, 1)
    assert words in done.stderr


@pytest.mark.parametrize(
    "arguments", [["a.log", "--save", "a.jpg"], ["a.log", "--address", "xyz"], [], ["a.log", "--rate", "0"]]
)
def test_wrong_usage(run, tmp_path, arguments):
    assert_one_line_of_advice(run("replay", *arguments), 2)
