"""What the README prints is true: its scripts run as printed, CI runs its set-up line, its pictures are fresh."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import make_pictures as pictures
import numpy as np
import pytest
from PIL import Image

from paneldraw import Framebuffer, open_panel, simulator
from paneldraw.controllers import CHIPS

PROJECT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def glass():
    """What the first script brings onto the simulated panel, 0 and 1."""
    return pictures.glass_of(pictures.blocks("python")[0])


def test_the_first_script_is_ten_lines():
    assert len(pictures.blocks("python")[0].splitlines()) <= 10


def test_the_first_script_draws_a_sun_and_a_greeting(glass):
    assert glass.shape == (64, 128)
    y, x = np.ogrid[:64, :128]
    from_sun = np.hypot(x - 92, y - 32)
    assert glass[from_sun <= 8.5].all(), "the sun is a disc"
    assert not glass[(from_sun >= 10) & (from_sun <= 12.5)].any(), "between the sun and its rays it is dark"
    for k in range(24):
        turn = k * np.pi / 12
        ray = [(round(32 + r * np.sin(turn)), round(92 + r * np.cos(turn))) for r in range(16, 28)]
        assert all(glass[y - 1 : y + 2, x - 1 : x + 2].any() for y, x in ray), f"ray {k} is whole"
    assert np.array_equal(glass[1:64, 62:122], glass[63:0:-1, 62:122]), "top and bottom mirror each other"
    greeting = Framebuffer(128, 64)
    greeting.text("Hello,\npanel!", 30, 32, anchor="mm")
    assert greeting.pixels.any()
    assert np.array_equal(glass[:, :60], greeting.pixels[:, :60])


def test_the_first_script_saves_the_picture_it_shows(tmp_path, glass):
    (tmp_path / "hello.py").write_text(pictures.blocks("python")[0], encoding="utf-8")
    done = subprocess.run([sys.executable, "hello.py"], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    saved, shown = (Image.open(path).convert("RGB") for path in (tmp_path / "hello.png", PROJECT / "docs/hello.png"))
    assert np.array_equal(saved, shown)
    assert np.array_equal(saved, simulator.image(glass, look="white").convert("RGB"))


def test_the_example_of_a_test_passes_and_can_fail(tmp_path):
    example = pictures.blocks("python", "Testing without a panel")[0]
    assert "    assert" in example
    (tmp_path / "test_example.py").write_text(example, encoding="utf-8")
    (tmp_path / "test_wrong.py").write_text(example.replace("63, 63)", "62, 62)"), encoding="utf-8")
    command = [sys.executable, "-m", "pytest", "-q", "-rA", "-p", "no:cacheprovider"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True).stdout
    outcomes = re.findall(r"^(PASSED|FAILED) (\w+)\.py", done, re.M)
    assert outcomes == [("PASSED", "test_example"), ("FAILED", "test_wrong")]


def test_every_python_block_is_tested_here():
    assert len(pictures.blocks("python")) == 2


@pytest.mark.parametrize("name", ["panel.gif", "hello.png"])
def test_the_pictures_are_what_the_package_draws_now(name):
    assert pictures.is_fresh(name, pictures.PICTURES[name]()), "python docs/make_pictures.py"


def test_every_link_leads_to_a_file():
    for target in re.findall(r"\]\(([^)]+)\)", pictures.README.read_text(encoding="utf-8")):
        assert target.startswith("https://") or (PROJECT / target.partition("#")[0]).is_file(), target


def test_its_figures_are_those_of_the_page_that_says_how_fast():
    readme = pictures.README.read_text(encoding="utf-8")
    page = (PROJECT / "docs" / "benchmarks.md").read_text(encoding="utf-8")
    pillow, opencv = re.search(r"^\| line, one call a line \|.*Pillow ([\d.]+), OpenCV ([\d.]+),", page, re.M).groups()
    luma = re.search(r"^\| one pixel changed \|.*luma\.oled (\d+),", page, re.M)[1]
    mean = round(float(re.search(r"^\| mean \| ([\d.]+) \|", page, re.M)[1]))
    said = " ".join(readme.split())
    assert f"for a line Pillow takes {pillow} and OpenCV {opencv} times as long, and luma.oled {luma} times" in said
    assert f"over ten scenes a frame costs {mean} bytes on average" in said
    assert f"{len(CHIPS)} simulated chips" in said


def test_the_set_up_is_two_lines():
    run, test = pictures.blocks("sh", "Set-up")
    for line in (run, test):
        assert line.count("\n") == 1
        assert line.startswith("python3 -m venv .venv && .venv/bin/pip install -e ")
    assert run.endswith(" && .venv/bin/paneldraw demo\n")
    assert test.endswith(" && .venv/bin/pytest -n auto\n")


def test_ci_takes_its_line_from_the_readme():
    script = (PROJECT / ".ci" / "run").read_text(encoding="utf-8")
    function = re.search(r"^second_line\(\) \{\n.*?^\}\n", script, re.M | re.S).group()
    found = subprocess.run(["bash", "-c", function + "second_line"], cwd=PROJECT, capture_output=True, text=True)
    assert found.stdout == pictures.blocks("sh", "Set-up")[1]
    assert ".venv/bin/pytest" not in script


def test_shell_blocks_are_sound():
    for block in pictures.blocks("sh"):
        subprocess.run(["bash", "-n", "-c", block], check=True)


def test_a_new_pixel_costs_eight_bytes():
    with open_panel("sim://ssd1306") as panel:
        fb = panel.framebuffer()
        # The first pixels after a whole frame may find the chip in another addressing mode.
        for x, y in ((5, 5), (100, 50), (41, 22)):
            panel.show(fb)
            fb.pixel(x, y, 1)
            cost = panel.show(fb).wire_bytes
        assert cost == 8


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
def test_a_driver_of_whole_frames_spends_1034_bytes(monkeypatch):
    from luma.core.interface.serial import i2c
    from luma.oled.device import ssd1306

    bus = simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)})
    monkeypatch.setattr("smbus2.SMBus", lambda port: bus)
    device = ssd1306(i2c(port=1), 128, 64)
    device.persist = True
    before = bus.bytes
    device.display(Image.new("1", (128, 64)))
    assert bus.bytes - before == 1034
