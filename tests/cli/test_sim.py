"""``paneldraw sim``: programs of others, unchanged, on simulated panels; what is said, saved and left behind."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import textwrap
import time

import numpy as np
import pytest
from PIL import Image
from running import ENVIRONMENT, UTF_8, forked, started
from searching import quick

from paneldraw import open_panel
from paneldraw.cli import sim
from paneldraw.simulator import mishaps
from paneldraw.simulator.preload import Preload

PANELDRAW = [sys.executable, "-m", "paneldraw"]
ON_1 = ["--panel", "i2c://1/0x3c?chip=ssd1306"]


def reason():
    try:
        with Preload():
            return ""
    except OSError as error:
        return str(error)


needs_buses = pytest.mark.skipif(bool(reason()), reason=f"simulated buses for programs: {reason()}")
needs_signals = pytest.mark.skipif(not hasattr(os, "openpty"), reason="signals and ptys are things of Unix")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    """A folder to work in, and one for temporary files in which nothing may be left."""
    left = tmp_path / "t"
    left.mkdir()
    work = tmp_path / "work"
    work.mkdir()
    monkeypatch.chdir(work)
    monkeypatch.setattr(tempfile, "tempdir", str(left))
    monkeypatch.setenv("TMPDIR", str(left))
    yield work
    assert [path.name for path in left.iterdir() if path.name.startswith("paneldraw-")] == []


def environment(**more):
    return {**ENVIRONMENT, **UTF_8, "TMPDIR": os.environ["TMPDIR"], **more}


def simulated(*arguments, **more):
    """Run ``paneldraw sim`` to its end, in a copy of this process where that can be."""
    start = forked if sys.platform == "linux" else started
    return start("sim", *arguments, TMPDIR=os.environ["TMPDIR"], **more)


def python(code):
    return ["--", sys.executable, "-c", textwrap.dedent(code)]


LIGHT = """
    import smbus2
    with smbus2.SMBus(1) as bus:
        bus.write_i2c_block_data(0x3C, 0x00, [0x8D, 0x14, 0xA5, 0xAF])
    print("lit")
"""

# -- Programs


@needs_buses
def test_a_plain_smbus2_script():
    done = simulated("run", *ON_1, *python(LIGHT))
    assert (done.returncode, done.stdout) == (0, "lit\n")
    assert done.stderr == "paneldraw: ssd1306: 1 frame, 6 bytes, no violations\n"


@needs_buses
def test_what_breaks_the_datasheet_is_told_at_the_end():
    wrong = LIGHT.replace("0xAF", "0xAF, 0xA8, 3")
    done = simulated("run", *ON_1, *python(wrong))
    assert done.stderr.splitlines() == [
        "paneldraw: ssd1306: 1 frame, 8 bytes, 1 violation",
        "  A8 03: the multiplex ratio is 0F to 3F (16 to 64 lines)",
    ]
    assert simulated("run", "--quiet", *ON_1, *python(wrong)).stderr == ""


@needs_buses
@pytest.mark.skipif(shutil.which("i2cdetect", path="/usr/sbin:/usr/bin") is None, reason="i2c-tools is not installed")
def test_i2cdetect_sees_who_is_there():
    panels = [*ON_1, "--panel", "i2c://1/0x70:3/0x3d?chip=sh1106"]
    done = simulated("run", *panels, "--", shutil.which("i2cdetect", path="/usr/sbin:/usr/bin"), "-y", "1")
    assert re.findall(r"\b[0-9a-f]{2}\b(?!:)", "\n".join(done.stdout.splitlines()[1:])) == ["3c", "70"]


C_PROGRAM = r"""
#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <stdio.h>
#include <sys/ioctl.h>
#include <unistd.h>

int main(void)
{
    unsigned char on[] = {0x00, 0x8D, 0x14, 0xA5, 0xAF};
    int bus = open("/dev/i2c-1", O_RDWR);

    if (bus < 0 || ioctl(bus, I2C_SLAVE, 0x3C) < 0 || write(bus, on, sizeof on) != sizeof on) {
        perror("/dev/i2c-1");
        return 1;
    }
    puts("lit");
    return 7;
}
"""


def compiled(folder, *flags):
    compiler = shutil.which("gcc") or shutil.which("cc")
    if compiler is None:
        pytest.skip("there is no C compiler")
    (folder / "light.c").write_text(C_PROGRAM)
    built = subprocess.run([compiler, *flags, "light.c", "-o", "light"], cwd=folder, capture_output=True, text=True)
    if built.returncode:
        pytest.skip(f"the C program cannot be built here: {built.stderr.splitlines()[-1]}")
    return folder / "light"


@needs_buses
def test_a_program_in_c(folder):
    done = simulated("run", *ON_1, "--", compiled(folder))
    assert (done.returncode, done.stdout) == (7, "lit\n")
    assert "1 frame, 6 bytes" in done.stderr


@needs_buses
def test_a_static_program_is_refused(folder):
    done = simulated("run", *ON_1, "--", compiled(folder, "-static"))
    assert (done.returncode, done.stdout) == (126, "")
    assert re.fullmatch("paneldraw: .*light is linked statically.*\n", done.stderr)


@needs_buses
def test_our_own_scripts_find_the_panel_by_the_environment():
    pytest.importorskip("spidev")
    for url in ("i2c://1/0x3d?chip=sh1106&rotate=180", "spi://0.0?chip=ssd1322", "serial:///dev/ttyACM0?chip=ssd1309"):
        done = simulated("run", "--panel", url, "--", *PANELDRAW, "text", "Hello")
        assert done.returncode == 0, done.stderr
        assert re.fullmatch(r"Hello: \d+ bytes on the wire\n", done.stdout)
        assert re.search(r": 1 frame, [\d,]+ bytes, no violations\n$", done.stderr)


@needs_buses
def test_what_a_simulated_panels_url_asks_for_is_done(folder):
    url = "sim://ssd1306?size=128x32&save=out.png&view=terminal&look=blue&rotate=180"
    done = simulated("run", *python(LIGHT), PANELDRAW_PANEL=url)
    assert done.returncode == 0
    assert done.stdout.startswith("lit\n")
    assert done.stdout.count("█" * 128) == 16
    with Image.open(folder / "out.png") as picture:
        assert len(picture.convert("RGB").getcolors()) > 1


# -- What is saved and written down


@needs_buses
def test_several_panels_are_saved_each_in_a_file_of_its_own(folder):
    (folder / "rig.toml").write_text(
        '[panel.left]\nurl = "i2c://1/0x3c"\n[panel."on the right"]\nurl = "i2c://1/0x3d"\n'
    )
    done = simulated("run", "--file", "rig.toml", "--save", "out.gif", *python(LIGHT))
    assert sorted(path.name for path in folder.iterdir()) == ["out-left.gif", "rig.toml"]
    assert done.stderr.splitlines() == [
        "paneldraw: left: 1 frame, 6 bytes, no violations",
        "paneldraw: on the right: was sent nothing, at i2c://1/0x3d",
        "paneldraw: wrote out-left.gif",
        "paneldraw: on the right showed nothing, so there is no out-on-the-right.gif",
    ]


@needs_buses
def test_a_picture_is_the_last_that_shone(folder):
    done = simulated(
        "run", *ON_1, "--save", "out.png", *python(LIGHT + "    smbus2.SMBus(1).write_byte_data(60, 0, 0xAE)")
    )
    assert "2 frames" in done.stderr
    with Image.open(folder / "out.png") as picture:
        assert np.asarray(picture.convert("L")).max() > 200


@needs_buses
def test_a_log_can_be_replayed(folder):
    panels = [*ON_1, "--panel", "i2c://1/0x3d", "--panel", "i2c://2/0x3c?chip=sh1106"]
    done = simulated("run", "--quiet", *panels, "--log", "wire.log", *python(LIGHT))
    assert (done.returncode, done.stderr) == (0, "")
    assert sorted(path.name for path in folder.iterdir()) == ["wire-sh1106.log", "wire-ssd1306.log"]
    log = (folder / "wire-ssd1306.log").read_text().splitlines()
    assert [line.split()[1:] for line in log[1:]] == [["3c", "w", "ack", "008d14a5af"]]


@needs_buses
def test_a_transcript_tells_what_the_chips_make_of_each_message():
    done = simulated("run", *ON_1, "--panel", "i2c://1/0x3d", "--transcript", *python(LIGHT))
    assert done.stdout == "lit\n"
    told = [line for line in done.stderr.splitlines() if not line.startswith("paneldraw:")]
    assert all(line.startswith("ssd1306 ") for line in told)
    assert re.search("AF +display on", done.stderr)


# -- Faults


NACKED = """
    import smbus2
    for number in range(200):
        try:
            smbus2.SMBus(1).write_byte(0x3C, 0)
        except OSError as error:
            print(number, error.errno)
"""


@needs_buses
def test_faults_strike_at_a_rate_and_the_same_for_a_seed():
    first, again, other = (
        simulated("run", *ON_1, "--fail", "nack:10%", "--seed", seed, *python(NACKED)) for seed in (1, 1, 2)
    )
    struck = first.stdout.splitlines()
    assert 5 < len(struck) < 40
    assert {line.split()[1] for line in struck} == {"121"}
    assert first.stdout == again.stdout != other.stdout
    assert first.stderr.splitlines()[-1] == f"paneldraw: nack: {len(struck)} faults"


def test_the_help_names_every_kind_of_fault(run):
    assert [name for name in (*mishaps.KINDS, *mishaps.NOISE) if name not in run("sim", "--help").stdout] == []


# -- Ends


@needs_buses
@pytest.mark.parametrize(
    ("script", "code", "said"),
    [
        ("exit 3", 3, ""),
        ("kill -KILL $$", 137, r"sh was killed \(SIGKILL\), by somebody or for want of memory: see `dmesg`\n"),
        ("kill -SEGV $$", 139, r"sh crashed \(SIGSEGV\): put a debugger before it, as in `-- gdb --args sh`\n"),
        ("kill -TERM $$", 143, r"sh was ended by SIGTERM\n"),
    ],
)
def test_the_exit_code_is_the_programs(script, code, said):
    done = simulated("run", "--quiet", *ON_1, "--", "sh", "-c", script)
    assert done.returncode == code
    assert re.fullmatch(f"paneldraw: {said}" if said else "", done.stderr)


@needs_buses
def test_a_program_that_cannot_be_run(folder):
    (folder / "plain.py").write_text("print(1)")
    (folder / "lost.py").write_text("#!/no/such/python\n")
    (folder / "bare.py").write_text("print(1)\n")
    for name in ("lost.py", "bare.py"):
        (folder / name).chmod(0o755)
    for name, code, said in (
        ("no-such-program", 127, "there is no command no-such-program: check its spelling and the PATH"),
        ("./plain.py", 126, "./plain.py may not be run: chmod \\+x ./plain.py, or put its interpreter before it, .*"),
        ("./bare.py", 126, "./bare.py cannot be run .*: put its interpreter before it, as in `python ./bare.py`"),
        ("./lost.py", 127, "./lost.py cannot be run: the interpreter that its first line names is missing"),
    ):
        done = simulated("run", *ON_1, "--save", "out.gif", "--", name)
        assert done.returncode == code
        assert re.fullmatch(f"paneldraw: {said}\n", done.stderr)


TRAPS = """
    import signal, sys, time
    def leave(number, frame):
        print("heard", number, flush=True)
        sys.exit(5)
    for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGUSR1):
        signal.signal(number, leave)
    print("ready", flush=True)
    time.sleep(60)
"""


def begun(*arguments, **options):
    """Start ``paneldraw sim`` in a session of its own."""
    command = [*PANELDRAW, "sim", *map(str, arguments)]
    return subprocess.Popen(
        command, stdout=subprocess.PIPE, encoding="utf-8", env=environment(), start_new_session=True, **options
    )


@needs_buses
@pytest.mark.parametrize("name", quick(["SIGTERM", "SIGINT", "SIGHUP", "SIGUSR1"], ["SIGTERM", "SIGUSR1"]))
def test_signals_are_passed_on(name, folder):
    number = getattr(signal, name)
    with begun("run", *ON_1, "--save", "out.gif", *python(TRAPS), stderr=subprocess.PIPE) as process:
        assert process.stdout.readline() == "ready\n"
        process.send_signal(number)
        output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (5, f"heard {number}\n")
    assert "showed nothing" in errors


@needs_buses
def test_a_signal_that_ends_the_program_is_told_by_the_code_alone():
    with begun("run", "--quiet", *ON_1, "--", "sleep", "60", stderr=subprocess.PIPE) as process:
        time.sleep(0.1)
        while not children(process.pid):
            time.sleep(0.02)
        process.terminate()
        assert process.communicate(timeout=60) == ("", "")
    assert process.returncode == 143


def children(pid):
    """The processes that one has started; none that is still this program's copy."""
    with open(f"/proc/{pid}/task/{pid}/children") as file:
        started = file.read().split()
    return [child for child in started if b"sleep" in open(f"/proc/{child}/cmdline", "rb").read()]


CTRL_C = """
    import signal, sys, time
    signal.signal(signal.SIGINT, lambda number, frame: print("heard", number, flush=True))
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(5))
    print("ready", flush=True)
    while True:
        time.sleep(60)
"""


@needs_buses
def test_ctrl_c_reaches_the_program_once():
    import pty

    pid, master = pty.fork()
    if not pid:
        os.execve(sys.executable, [*PANELDRAW, "sim", "run", "--quiet", *ON_1, *python(CTRL_C)], environment())
    output = b""

    def read_until(text):
        nonlocal output
        while text not in output:
            output += os.read(master, 1000)

    read_until(b"ready")
    os.write(master, b"\x03")
    read_until(b"heard 2")
    time.sleep(0.5)  # for a second one
    os.kill(pid, signal.SIGTERM)
    try:
        read_until(b"nothing that comes")
    except OSError:  # the last writer has closed its end
        assert os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) == 5
    os.close(master)
    assert output.count(b"heard") == 1


# -- Panels by themselves


@needs_buses
def test_panels_wait_for_programs_until_a_signal(folder):
    text = '[panel.board]\nurl = "serial:///dev/ttyACM0?chip=sh1106"\n[panel.bus]\nurl = "i2c://1/0x3c"\n'
    (folder / "rig.toml").write_text(text)
    with begun("rig.toml", "--save", "out.png", "--look", "blue", stderr=subprocess.PIPE) as process:
        told = [process.stdout.readline() for _ in range(6)]
        url = shlex.split(re.search("PANELDRAW_PANEL=(.*)", told[0])[1])[0]
        with open_panel(url) as panel, panel.frame() as fb:
            fb.circle(64, 32, 20)
        exports = dict(re.findall("^  export (.*?)=(.*)$", "".join(told), re.M))
        assert exports.keys() == {"LD_PRELOAD", "PANELDRAW_PRELOAD", "PANELDRAW_PANEL"}
        other = python(LIGHT)[1:]
        lit = subprocess.run(other, env={**environment(), **exports}, capture_output=True, text=True, timeout=60)
        assert lit.stdout == "lit\n", lit.stderr
        process.terminate()
        output, errors = process.communicate(timeout=60)
    assert (process.returncode, output) == (143, "")
    assert errors == "paneldraw: wrote out-board.png\npaneldraw: wrote out-bus.png\n"
    assert told[0].startswith("board: /")
    assert told[1] == "bus: i2c://1/0x3c\n"
    with Image.open(folder / "out-bus.png") as picture:
        colors = picture.convert("RGB").getcolors()
    assert (0x38, 0xA4, 0xFF) in {color for _, color in colors}


@needs_signals
def test_a_serial_panel_needs_no_library(monkeypatch, capsys, folder):
    def look(seconds):
        url = re.search("PANELDRAW_PANEL=(.*)", capsys.readouterr().out)[1]
        with open_panel(url) as panel:
            assert panel.clear().wire_bytes > 0
        raise KeyboardInterrupt

    monkeypatch.setattr(sim.time, "sleep", look)
    with pytest.raises(KeyboardInterrupt):
        sim_in_process("--panel", "serial:///dev/ttyACM0")


def sim_in_process(*arguments):
    from paneldraw.cli import main

    return main(["sim", *arguments])


def test_buses_that_no_program_can_reach_say_why(monkeypatch, capsys):
    from paneldraw.simulator import preload

    def unavailable(*buses):
        raise preload.PreloadUnavailableError(38, "only on Linux")

    monkeypatch.setattr("paneldraw.simulator.preload.Preload", unavailable)
    monkeypatch.setattr(sim.time, "sleep", lambda seconds: sys.exit(9))
    with pytest.raises(SystemExit):
        sim_in_process(*ON_1)
    told = capsys.readouterr().out.splitlines()
    assert told[0] == "ssd1306: i2c://1/0x3c?chip=ssd1306"
    assert "only on Linux" in told[1]
    assert sim_in_process("run", *ON_1, "--", "true") == 1
    assert "only on Linux" in capsys.readouterr().err


# -- Bad input


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["run"], 2, "required: -- COMMAND; see paneldraw sim run --help"),
        (["run", "--"], 2, "required: -- COMMAND; see paneldraw sim run --help"),
        (["run", "--fail", "nak:1%", "--", "true"], 2, "did you mean nack?"),
        (["run", "--fail", "nack:200%", "--", "true"], 2, "above 0% and up to 100%"),
        (["run", "--fail", "flip:1%", *ON_1, "--", "true"], 1, "flip strikes no panel here: a bit of a byte"),
        (["run", "--look", "blu", "--", "true"], 1, "did you mean blue?"),
        (["run", "--save", "out.gif.txt", "--", "true"], 2, "ends in none of .gif, .apng, .png"),
        (["run", "--save", "nowhere/out.gif", "--", "true"], 1, "there is no folder nowhere; make it first"),
        (["run", "--panel", "i2c://1/0x3c?chip=sh110", "--", "true"], 1, "did you mean sh1107?"),
        (["run", "--file", "rig.toml", "--", "true"], 1, "there is no file rig.toml; check the path"),
        (["rigs.toml"], 1, "there is no file rigs.toml; check the path"),
        (["--view", "terminl"], 2, "invalid choice: 'terminl'"),
    ],
)
def test_what_is_wrong_is_said_in_a_line(arguments, code, said, run):
    done = run("sim", *arguments)
    assert done.returncode == code
    assert len(done.stderr.splitlines()) == 1, done.stderr
    assert said in done.stderr
