"""The page of wishes: each is answered by a short script that runs as printed, and shows what the page says."""

from __future__ import annotations

import contextlib
import io
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from paneldraw import Framebuffer
from paneldraw.testing import frames_of

PAGE = (Path(__file__).parent.parent / "docs" / "they_asked.md").read_text(encoding="utf-8")
ANSWERS = dict(re.findall(r"^## (\d+)\. (.*?)(?=^## |\Z)", PAGE, re.M | re.S))
ON_THE_HEADER = "6"
"""Its panel is on a bus of the machine, so it needs one that is lent."""
SIMULATED = [number for number in ANSWERS if number != ON_THE_HEADER]


def script(number):
    (code,) = re.findall(r"^```python\n(.*?)^```$", ANSWERS[number], re.M | re.S)
    return code


def test_there_are_ten_of_at_most_twenty_lines_with_their_sources():
    assert list(ANSWERS) == [str(number) for number in range(1, 11)]
    for number, text in ANSWERS.items():
        assert script(number).count("\n") <= 20, number
        threads = re.findall(r"\]\(https://github\.com/[\w.-]+/[\w.-]+/(?:issues|pull)/\d+\)", text)
        assert 1 <= len(set(threads)) == len(threads) <= 3, number


@pytest.fixture(scope="module")
def ran():
    """What each script left in its names, and what it printed."""
    left = {}
    for number in SIMULATED:
        names = {}
        with contextlib.redirect_stdout(io.StringIO()) as out, pytest.MonkeyPatch.context() as patch:
            patch.delenv("PANELDRAW_PANEL", raising=False)
            exec(script(number), names)
        left[number] = names, out.getvalue()
    return left


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("number", SIMULATED)
def test_a_script_prints_what_the_page_says(number, ran):
    assert ran[number][1] == "".join(re.findall(r"^```text\n(.*?)^```$", ANSWERS[number], re.M | re.S))


@pytest.mark.parametrize("number", ["1", "3", "7", "8"])
def test_the_last_picture_is_on_the_glass(number, ran):
    names, _ = ran[number]
    chip = names["panel"].simulated or next(iter(names["bus"].devices.values()))
    assert np.array_equal(chip.pixels, names["fb"].pixels)
    assert chip.pixels.sum() > 50
    assert chip.violations == []


def test_three_panels_show_three_names(ran):
    names, _ = ran["9"]
    chips = [names[name] for name in names["panels"]]
    assert [chip.pixels.sum() for chip in chips] == [48, 58, 68]
    assert [chip.violations for chip in chips] == [[], [], []]


@pytest.mark.skipif(sys.platform != "linux", reason="programs are lent devices by Linux's loader")
@pytest.mark.parametrize("sim_run", ["i2c://1/0x3c?chip=ssd1309&reset=4"], indirect=True)
def test_a_panel_whose_reset_is_on_the_header(sim_run, tmp_path):
    pytest.importorskip("gpiod")
    (tmp_path / "script.py").write_text(script(ON_THE_HEADER), encoding="utf-8")
    done = sim_run(tmp_path / "script.py")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    wanted = Framebuffer(128, 64)
    wanted.text("GPIO 4, through gpiod", 64, 32, anchor="mm")
    (frame,) = frames_of(done)
    assert np.array_equal(frame.pixels, wanted.pixels)
    assert done.panel.chip.violations == []
