"""Programs with simulated panels: what they show can be looked at, and however they end, nothing is left."""

from __future__ import annotations

import os
import signal
import sys
import textwrap
import time
from pathlib import Path

import pytest

from paneldraw import Framebuffer
from paneldraw.simulator.preload import PreloadUnavailableError
from paneldraw.testing import SimRun, assert_pattern, chip_of, frames_of
from paneldraw.testing.leaks import Held

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="programs are lent devices by Linux's loader")

OURS = """
    from paneldraw import open_panel
    with open_panel() as panel, panel.frame() as fb:
        fb.rect(1, 1, 5, 3, 1)
"""
CORNER = """
    .......
    .#####.
    .#...#.
    .#####.
    .......
"""


@pytest.fixture
def script(tmp_path):
    """Write a script: ``script("print(1)")`` is its path."""

    def write(code):
        path = tmp_path / "script.py"
        path.write_text(textwrap.dedent(code), encoding="utf-8")
        return path

    return write


def test_a_script_of_ours_finds_its_panel_by_itself(sim_run, script):
    done = sim_run(script(OURS))
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert_pattern(sim_run, CORNER, at=(0, 0))
    assert_pattern(done, CORNER, at=(0, 0))
    assert len(frames_of(done)) == 1
    assert done.panel is sim_run.panel
    assert done.panel.chip.violations == []


LUMA = """
    from luma.core.interface.serial import i2c
    from luma.core.render import canvas
    from luma.oled.device import sh1106
    device = sh1106(i2c(port=1, address=0x3D))
    with canvas(device) as draw:
        draw.rectangle((1, 1, 5, 3), outline="white")
    device.cleanup = lambda: None
"""


@pytest.mark.parametrize("sim_run", ["i2c://1/0x3d?chip=sh1106"], indirect=True)
def test_a_script_on_luma(sim_run, script):
    done = sim_run(script(LUMA))
    assert done.returncode == 0, done.stderr
    assert_pattern(done, CORNER, at=(0, 0))
    assert done.panel.chip.violations == []


BOTH = """
    from paneldraw import open_panel
    for url in ("i2c://1/0x3c?chip=ssd1306", "spi://0.0?chip=ssd1322&dc=24&reset=25", "serial:///dev/ttyACM0"):
        with open_panel(url) as panel, panel.frame() as fb:
            fb.rect(1, 1, 5, 3)
"""
THREE = ["i2c://1/0x3c?chip=ssd1306", "spi://0.0?chip=ssd1322&dc=24&reset=25", "serial:///dev/ttyACM0?chip=ssd1327"]


@pytest.mark.parametrize("sim_run", [THREE], indirect=True)
def test_several_panels(sim_run, script):
    pytest.importorskip("spidev")
    done = sim_run(script(BOTH))
    assert done.returncode == 0, done.stderr
    assert [panel.name for panel in done.panels] == ["ssd1306", "ssd1322", "ssd1327"]
    for panel in done.panels:
        assert chip_of(panel).pixels[1:4, 1:6].tolist()[0] == [chip_of(panel).max_level] * 5
    with pytest.raises(ValueError, match="there are 3 panels: take one"):
        done.panel  # noqa: B018


def test_a_fault_is_asked_for_before_it_runs(sim_run, script):
    sim_run.panel.bus.fail(after=3, errno=121)
    code = "from paneldraw import open_panel\nwith open_panel() as panel:\n    panel.clear()\nprint(panel.stats.faults)"
    done = sim_run(script(code))
    assert done.stdout == "{'EREMOTEIO': 1}\n"


LOOP = """
    import itertools
    from paneldraw import open_panel
    with open_panel() as panel:
        for number in itertools.count():
            with panel.frame() as fb:
                fb.text(str(number), 0, 0)
            print(number, flush=True)
"""


def test_a_script_that_does_not_end_is_looked_at_and_stopped(sim_run, script):
    with sim_run.start(script(LOOP)) as program:
        assert program.returncode is None
        program.wait_until(lambda: len(frames_of(program)) >= 3)
        number = Framebuffer(128, 64)
        number.text("2", 0, 0)
        assert (frames_of(program)[2].pixels == number.pixels).all()
    assert program.returncode == -signal.SIGTERM
    assert program.stdout.startswith("0\n1\n2\n")


def test_what_the_fixture_leaves_to_run_it_ends(script):
    before = Held.now()
    with SimRun() as run:
        program = run.start(script(LOOP))
        program.wait_until(lambda: frames_of(program))
        folder = Path(run._preload.environment()["PANELDRAW_PRELOAD"])
        assert folder.is_dir()
    assert program.process.returncode == -signal.SIGTERM
    assert not folder.exists()
    assert before.left() == []
    run.close()


def test_a_script_that_refuses_to_end_is_killed(sim_run, script, monkeypatch):
    monkeypatch.setattr("paneldraw.testing.programs._PATIENCE", 0.1)
    code = "import signal, time\nsignal.signal(signal.SIGTERM, signal.SIG_IGN)\nprint(1, flush=True)\ntime.sleep(60)"
    program = sim_run.start(script(code))
    program.wait_until(lambda: program.stdout)
    assert program.stop() == -signal.SIGKILL
    assert program.stop() == -signal.SIGKILL


def test_what_it_started_ends_with_it(sim_run, script):
    code = "import subprocess\nchild = subprocess.Popen(['sleep', '60'])\nprint(child.pid, flush=True)"
    done = sim_run(script(code))
    child = int(done.stdout)
    os.kill(child, 0)
    done.stop()
    until = time.monotonic() + 5
    while Path(f"/proc/{child}").exists() and "\nState:\tZ" not in Path(f"/proc/{child}/status").read_text():
        assert time.monotonic() < until
        time.sleep(0.01)


def test_a_child_that_is_killed_in_the_middle_of_a_picture(sim_run, script):
    program = sim_run.start(script(LOOP))
    program.wait_until(lambda: frames_of(program))
    os.kill(program.process.pid, signal.SIGKILL)
    assert program.wait() == -signal.SIGKILL
    done = sim_run(script(OURS))
    assert done.returncode == 0, done.stderr
    assert_pattern(done, CORNER, at=(0, 0))


def test_one_that_takes_too_long(sim_run, script):
    with pytest.raises(TimeoutError, match=r"(?s)script.py did not end within 0.5 s; it wrote:\nslow"):
        sim_run(script("import time\nprint('slow', flush=True)\ntime.sleep(60)"), timeout=0.5)


def test_one_that_fails_is_not_waited_for(sim_run, script):
    program = sim_run.start(script("raise SystemExit('no panel')"))
    with pytest.raises(RuntimeError, match="ended with exit code 1 before what was waited for; it wrote:\nno panel"):
        program.wait_until(lambda: frames_of(program))


def test_what_never_comes(sim_run):
    program = sim_run.start(["sleep", "60"])
    with pytest.raises(TimeoutError, match=r"sleep 60 did not do .* within 0.1 s; it wrote:\nnothing"):
        program.wait_until(lambda: frames_of(program), timeout=0.1)


def test_where_and_with_what_it_runs(sim_run, tmp_path):
    show = "import os; print(os.getcwd(), os.environ['NAME'], os.environ['PANELDRAW_PANEL'])"
    done = sim_run([sys.executable, "-c", show], cwd=tmp_path, env={"NAME": "value"})
    assert done.stdout == f"{tmp_path} value i2c://1/0x3c?chip=ssd1306\n"
    assert repr(done).startswith(f"<Program {sys.executable} -c import os")
    assert repr(sim_run) == "<SimRun of i2c://1/0x3c?chip=ssd1306>"


def test_a_program_that_does_not_exist(sim_run):
    with pytest.raises(FileNotFoundError):
        sim_run("no-such-program")


def test_a_static_binary_is_refused(sim_run, tmp_path):
    path = tmp_path / "static"
    head = Path(os.path.realpath(sys.executable)).read_bytes()[:64]
    path.write_bytes(head[:56] + bytes(8))  # no program headers: no loader is asked for
    path.chmod(0o755)
    with pytest.raises(PreloadUnavailableError, match="is linked statically, and loads no libraries"):
        sim_run(path)


def test_no_such_chip():
    with pytest.raises(ValueError, match="did you mean ssd1327"):
        SimRun("i2c://1/0x3c?chip=ssd1307")
