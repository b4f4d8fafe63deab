"""What needs nothing of Unix runs without it: simulated panels, demos, drawing and its tests, command and plugin."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from running import ENVIRONMENT, UTF_8, picture_of

from paneldraw.controllers import CHIPS
from paneldraw.demos import DEMOS

PROJECT = Path(__file__).parent.parent
HIDE = """
import sys
HIDDEN = ("fcntl", "termios", "tty", "pty", "grp", "pwd", "resource", "gpiod", "spidev")
class Hide:
    def find_spec(self, name, path=None, target=None):
        if name in HIDDEN:
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)
for name in HIDDEN:
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Hide())
"""


def run(code, *arguments, cwd=PROJECT):
    """Run a program in a Python that has no module of Unix."""
    return subprocess.run(
        [sys.executable, "-c", HIDE + code, *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        encoding="utf-8",
        env=ENVIRONMENT | UTF_8,
        timeout=280,
    )


def test_the_modules_are_hidden():
    assert run("import pty").stderr.splitlines()[-1] == "ModuleNotFoundError: No module named 'pty'"
    assert run("import smbus2").stderr.splitlines()[-1] == "ModuleNotFoundError: No module named 'fcntl'"


SHOW = """
import numpy as np
from paneldraw import open_panel
from paneldraw.controllers import CHIPS
from paneldraw.demos import DEMOS, find
for chip in CHIPS:
    with open_panel(f"sim://{chip}") as panel:
        for name in DEMOS:
            for moment in (36579.2, 36579.3):
                with panel.frame() as fb:
                    find(name)(fb, moment)
            assert np.array_equal(panel.simulated.pixels, fb.pixels)
            print(chip, name, fb.pixels.any())
assert "smbus2" not in sys.modules and "fcntl" not in sys.modules
"""


def test_every_simulated_panel_shows_the_demos():
    done = run(SHOW)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [f"{chip} {name} True" for chip in CHIPS for name in DEMOS]


def test_a_real_bus_is_not_there_and_it_is_said_so():
    said = run("from paneldraw import open_panel; open_panel('i2c://99/0x3c')").stderr.splitlines()[-1]
    assert "PanelNotFoundError" in said
    assert "there is no bus /dev/i2c-99" in said


def test_the_command_shows_a_demo():
    done = run("from paneldraw.cli import main; main()", "demo", "clock", "--seconds", 0.1)
    assert (done.returncode, done.stderr) == (0, "")
    assert any("█" in line for line in picture_of(done.stdout))


SESSION = """
import pytest
sys.exit(pytest.main(["-p", "no:cacheprovider", *sys.argv[1:]]))
"""

TESTS = """
from paneldraw.testing import assert_pattern


def test_a_panel(sim_panel):
    with sim_panel.frame() as fb:
        fb.line(0, 0, 2, 2)
    sim_panel.assert_pattern("#..\\n.#.\\n..#", at=(0, 0))


def test_buses(i2c_bus, spi_bus):
    assert (len(i2c_bus.devices), len(spi_bus.chips)) == (1, 1)
"""


def test_the_plugin_hands_out_panels(tmp_path):
    (tmp_path / "test_panels.py").write_text(TESTS)
    done = run(SESSION, cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "2 passed" in done.stdout


@pytest.mark.thorough
def test_what_ci_runs_on_windows_passes():
    chosen = re.findall(r"\btests/\S+", (PROJECT / ".github/workflows/ci.yml").read_text(encoding="utf-8"))
    chosen.remove("tests/test_elsewhere.py")
    assert len(chosen) > 6
    done = run(SESSION, *chosen)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr
    assert " passed" in done.stdout
    assert " skipped" not in done.stdout


@pytest.mark.thorough
def test_the_tests_of_drawing_pass():
    patterns = sorted(Path("tests/raster").glob("test_*patterns.py"))
    assert len(patterns) > 3
    done = run(SESSION, *patterns, "tests/test_picture_patterns.py", "tests/test_framebuffer.py", "tests/demos")
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr
    assert " passed" in done.stdout
    assert " skipped" not in done.stdout
