"""A panel's life: lost power, interrupts, signals, forks, threads, and the end of the script."""

from __future__ import annotations

import asyncio
import copy
import errno
import gc
import os
import shutil
import signal
import subprocess
import sys
import textwrap
import threading
import time
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from paneldraw import Framebuffer, Panel, open_panel, simulator
from paneldraw.controllers import SH1106, SSD1306, SSD1309, SSD1327
from paneldraw.errors import PanelDisconnectedError, PanelError, PanelTimeoutError
from paneldraw.pacing import Frames
from paneldraw.transports import I2CTransport

posix = pytest.mark.skipif(not hasattr(os, "fork"), reason="processes fork and take POSIX signals only on POSIX")


def simulated(query=""):
    panel = open_panel(f"sim://ssd1306{query}")
    return panel, panel.simulated


def noise(seed, size=(128, 64)):
    return np.random.default_rng(seed).integers(0, 2, size[::-1], np.uint8)


class Clock:
    """A clock in place of time.perf_counter, which the test moves."""

    def __init__(self, monkeypatch):
        self.now = 1000.0
        monkeypatch.setattr("paneldraw.panel.time.perf_counter", lambda: self.now)


# -- Lost power


@pytest.mark.parametrize("make", [SSD1306, SSD1309, SH1106, SSD1327])
def test_lost_power_is_noticed_within_a_second(monkeypatch, make):
    clock = Clock(monkeypatch)
    controller = make()
    chip = getattr(simulator, make.name)(external_vcc=True) if make is SSD1309 else getattr(simulator, make.name)()
    panel = Panel(controller, I2CTransport(simulator.I2CBus({0x3C: chip})))
    picture = np.random.default_rng(1).integers(0, 2**panel.depth, (panel.height, panel.width), np.uint8)
    panel.contrast(9)
    panel.invert()
    panel.show(picture)
    chip.power_cycle()
    assert not chip.pixels.any()
    clock.now += 0.5
    assert panel.show(picture).unchanged
    clock.now += 0.6
    panel.show(picture)
    np.testing.assert_array_equal(chip.pixels, chip.max_level - picture)
    assert chip.contrast == 9
    assert panel.stats.restarts == 1


def test_the_status_is_asked_once_a_second_at_most(monkeypatch):
    clock = Clock(monkeypatch)
    panel, _ = simulated()
    panel.show(noise(1))
    bus = panel.transport.bus
    before = bus.bytes
    for _ in range(50):
        clock.now += 0.1
        panel.show(noise(1))
    assert 8 <= bus.bytes - before <= 10  # a read is 2 bytes


@pytest.mark.parametrize("answer", [0x00, 0x40, 0xFF, None])
def test_a_chip_that_answers_wrong_is_not_believed(monkeypatch, answer):
    clock = Clock(monkeypatch)
    panel, chip = simulated()

    def read(length):
        if answer is None:
            raise OSError(errno.EREMOTEIO, "Remote I/O error")
        return bytes([answer]) * length

    monkeypatch.setattr(chip, "read", read)
    for second in range(5):
        clock.now += second
        panel.invalidate()
        panel.show(noise(second))
        np.testing.assert_array_equal(chip.pixels, noise(second))
    restarts = panel.stats.restarts
    for _ in range(5):
        clock.now += 2
        panel.show(noise(4))
    assert panel.stats.restarts == restarts


def test_a_panel_that_cannot_be_asked_is_refreshed(monkeypatch):
    clock = Clock(monkeypatch)
    chip = simulator.SSD1306()
    bus = simulator.SPIBus(chip)
    from paneldraw.transports import SPITransport

    panel = Panel(SSD1306(), SPITransport(spi=bus.spi, pins=bus.pins), refresh=60)
    panel.show(noise(1))
    chip.power_cycle()
    clock.now += 59
    panel.show(noise(1))
    assert not chip.pixels.any()
    clock.now += 2
    panel.show(noise(1))
    np.testing.assert_array_equal(chip.pixels, noise(1))
    with pytest.raises(ValueError, match="refresh must be seconds above 0"):
        Panel(SSD1306(), SPITransport(spi=bus.spi, pins=bus.pins), refresh=0)


def test_force_starts_the_chip_anew():
    panel, chip = simulated()
    panel.show(noise(1))
    chip.power_cycle()
    panel.show(noise(1), force=True)
    np.testing.assert_array_equal(chip.pixels, noise(1))


SETTINGS = {
    "contrast": lambda panel: panel.contrast(9),
    "dim": lambda panel: panel.dim(3),
    "inversion": lambda panel: panel.invert(),
    "rotation": lambda panel: setattr(panel, "rotate", 180),
    "sleep": lambda panel: panel.sleep(),
}


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("recovery", ["noticed", "forced", "fault"])
@pytest.mark.parametrize("make", [SSD1306, SH1106, SSD1327])
def test_each_setting_is_back_after_a_recovery(monkeypatch, make, recovery, setting):
    clock = Clock(monkeypatch)
    chip = getattr(simulator, make.name)()
    panel = Panel(make(), I2CTransport(simulator.I2CBus({0x3C: chip})))
    first, second = (noise(seed, (panel.width, panel.height)) for seed in (1, 2))
    panel.show(first)
    usual = copy.deepcopy(chip.registers)
    SETTINGS[setting](panel)
    panel.show(first, force=True)
    registers, pixels = copy.deepcopy(chip.registers), chip.pixels
    assert registers != usual or setting == "rotation"
    assert pixels.any() == (setting != "sleep")
    if recovery == "fault":
        panel.transport.bus.fail(at_byte=2, then=chip.power_cycle)
        panel.show(second)
    else:
        chip.power_cycle()
        assert not chip.pixels.any()
        clock.now += 1.1
    panel.show(first, force=recovery == "forced")
    np.testing.assert_array_equal(chip.pixels, pixels)
    if setting == "sleep":  # a chip that is off says nothing of whether it has its set-up
        panel.wake()
        registers.on, pixels = True, first
    assert settings(chip.registers) == settings(registers)
    np.testing.assert_array_equal(chip.pixels, pixels)


def settings(registers):
    """The registers but for pointers and windows, which pictures move."""
    moved = ("column", "row", "page")
    return {name: value for name, value in vars(registers).items() if not name.startswith(moved) and name != "mode"}


def test_two_drivers_of_one_panel_and_force_mends_what_they_spoil():
    chip = simulator.SSD1306()
    bus = simulator.I2CBus({0x3C: chip})
    first, second = (Panel(SSD1306(), I2CTransport(bus)) for _ in range(2))
    first.show(noise(1))
    second.contrast(3)
    second.show(noise(2))
    first.show(noise(1))
    assert not np.array_equal(chip.pixels, noise(1)), "neither knows of the other"
    first.show(noise(1), force=True)
    np.testing.assert_array_equal(chip.pixels, noise(1))
    assert chip.contrast == 0xCF
    second.show(noise(3), force=True)
    np.testing.assert_array_equal(chip.pixels, noise(3))
    assert chip.contrast == 3


def test_nothing_flashes():
    """No RAM noise at the start, after wake before the first picture, or after recovery."""
    panel, chip = simulated()
    seen = []
    write = chip.write

    def watched(payload):
        write(payload)
        seen.append(chip.pixels.copy())

    chip.write = watched
    panel.wake()
    panel.sleep()
    panel.wake()
    panel.invert(False)
    panel.show(noise(1))
    panel.transport.bus.fail(at_byte=3, then=chip.power_cycle)
    panel.show(noise(2))
    allowed = [np.zeros((64, 128)), noise(1), noise(2)]
    strange = [picture for picture in seen if not any(np.array_equal(picture, each) for each in allowed)]
    for picture in strange:  # on the way from one picture to the next there is some of both
        assert not ((picture != noise(1)) & (picture != noise(2))).any()
    np.testing.assert_array_equal(chip.pixels, noise(2))


# -- Signals and Ctrl-C


class Interrupting(simulator.I2CBus):
    """A bus in the middle of whose calls something happens, once."""

    happening = None
    after = 0

    def i2c_rdwr(self, *messages):
        if self.happening is not None:
            if self.after == 0:
                happening, self.happening = self.happening, None
                happening()
            self.after -= 1
        return super().i2c_rdwr(*messages)


def interrupted(after=0):
    chip = simulator.SSD1306()
    bus = Interrupting({0x3C: chip})
    panel = Panel(SSD1306(), I2CTransport(bus))
    panel.show(noise(1))
    bus.after = after
    return panel, chip, bus


def test_a_show_within_a_show_is_whole_and_the_outer_one_last():
    panel, chip, bus = interrupted()
    reports = []
    bus.happening = lambda: reports.append(panel.show(noise(3)))
    chip.frames.clear()
    panel.show(noise(2))
    np.testing.assert_array_equal(chip.pixels, noise(2))
    assert [report.queued for report in reports] == [True]
    assert not reports[0].unchanged
    for frame, picture in zip(chip.frames, [noise(2), noise(3), noise(2)], strict=True):
        np.testing.assert_array_equal(frame.pixels, picture)


def test_a_show_from_a_finalizer_within_a_show_is_whole_and_the_outer_one_last():
    class Last:
        def __del__(self):
            reports.append(panel.show(noise(3)))

    reports = []
    panel, chip, bus = interrupted()
    held = [Last()]
    bus.happening = held.clear
    chip.frames.clear()
    panel.show(noise(2))
    assert [report.queued for report in reports] == [True]
    np.testing.assert_array_equal(chip.pixels, noise(2))
    for frame, picture in zip(chip.frames, [noise(2), noise(3), noise(2)], strict=True):
        np.testing.assert_array_equal(frame.pixels, picture)
    held.append(Last())
    held.clear()
    np.testing.assert_array_equal(chip.pixels, noise(3))


def test_settings_within_a_show_hold():
    panel, chip, bus = interrupted()
    bus.happening = lambda: (panel.contrast(5), panel.invert())
    panel.show(noise(2))
    np.testing.assert_array_equal(chip.pixels, 1 - noise(2))
    assert chip.contrast == 5


def test_a_close_within_a_show_comes_after_it():
    panel, chip, bus = interrupted()
    panel.on_close = "off"
    bus.happening = panel.close
    panel.show(noise(2))
    assert not chip.registers.on
    with pytest.raises(PanelError, match="closed"):
        panel.show(noise(3))


def test_a_show_within_one_that_fails_is_made_up_for():
    panel, chip, bus = interrupted()

    def happening():
        panel.show(noise(3))
        bus.fail(times=None)

    bus.happening = happening
    with pytest.raises(PanelDisconnectedError):
        panel.show(noise(2))
    bus.clear_faults()
    panel.show(noise(4))
    np.testing.assert_array_equal(chip.pixels, noise(4))


@posix
@pytest.mark.thorough
def test_ctrl_c_at_any_instruction():
    """A timer interrupts start, show, settings and close 2,000 times; the next show is whole every time."""
    interrupts = 0

    def ring(number, frame):
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGALRM, ring)
    chip = simulator.SSD1306(history=1)
    bus = simulator.I2CBus({0x3C: chip}, timer=None)
    try:
        panel = Panel(SSD1306(), I2CTransport(bus))
        random = np.random.default_rng(1)
        tries = 0
        while interrupts < 2000:
            tries += 1
            assert tries < 50_000
            picture = noise(tries % 7)
            delay = float(random.uniform(2e-6, 600e-6))
            try:
                signal.setitimer(signal.ITIMER_REAL, delay)
                panel.show(noise(tries % 5 + 10))
                panel.contrast(tries % 256)
                panel.invert(tries % 2)
                if tries % 50 == 0:
                    panel.close()
                    panel = Panel(SSD1306(), I2CTransport(bus))
                panel.show(picture)
                signal.setitimer(signal.ITIMER_REAL, 0)
            except KeyboardInterrupt:
                interrupts += 1
            finally:
                while True:
                    try:
                        signal.setitimer(signal.ITIMER_REAL, 0)
                        break
                    except KeyboardInterrupt:
                        interrupts += 1
            if panel._closed:
                panel = Panel(SSD1306(), I2CTransport(bus))
            panel.contrast(77)
            panel.invert(False)
            panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
            assert chip.contrast == 77
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


# -- Threads and waiting


@pytest.mark.parametrize("frames", [30, pytest.param(1000, marks=pytest.mark.thorough)])
def test_eight_threads_on_one_panel(frames):
    panel, chip = simulated()
    pictures = [noise(seed) for seed in range(8)]
    strange = []
    panel.show(pictures[0])

    def animate(number):
        for frame in range(frames):
            panel.show(pictures[(number + frame) % 8])

    settle = chip.settle

    def settled(seconds, wire_bytes):
        """Look at what an eye sees after each call of the bus."""
        settle(seconds, wire_bytes)
        if not any(np.array_equal(chip.pixels, picture) for picture in pictures):
            strange.append(chip.pixels.copy())

    chip.settle = settled
    with ThreadPoolExecutor(8) as threads:
        list(threads.map(animate, range(8)))
    assert panel.stats.frames == 8 * frames + 1
    assert not strange


def test_a_picture_handed_over_is_shown_by_one_thread_that_ends_with_the_panel():
    threads = threading.active_count()
    panel, chip = simulated()
    picture = noise(1)
    assert panel.show(picture, wait=False).queued
    picture[:] = 0  # the caller's again
    panel.flush(5)
    np.testing.assert_array_equal(chip.pixels, noise(1))
    panel.show(noise(2))
    np.testing.assert_array_equal(chip.pixels, noise(2))
    assert threading.active_count() == threads + 1
    panel.show(noise(3), wait=False)
    panel.close()
    np.testing.assert_array_equal(chip.pixels, noise(3))
    assert threading.active_count() == threads


def test_a_panel_that_is_forgotten_takes_its_thread_along():
    threads = threading.active_count()
    panel, _ = simulated()
    panel.show(noise(1), wait=False)
    panel.flush(5)
    alive = weakref.ref(panel)
    del panel
    gc.collect()
    assert alive() is None
    deadline = time.monotonic() + 5
    while threading.active_count() > threads and time.monotonic() < deadline:
        time.sleep(0.01)
    assert threading.active_count() == threads


class Slow(simulator.I2CBus):
    """A bus that takes its time when it is told to, and says when it is being waited for."""

    gate = None

    def __init__(self, devices):
        super().__init__(devices)
        self.reached = threading.Event()

    def i2c_rdwr(self, *messages):
        if self.gate is not None:
            self.reached.set()
            self.gate.wait(60)
        return super().i2c_rdwr(*messages)


def test_the_latest_picture_wins_and_flush_has_an_end():
    chip = simulator.SSD1306()
    bus = Slow({0x3C: chip})
    panel = Panel(SSD1306(), I2CTransport(bus))
    panel.show(noise(0))
    bus.gate = threading.Event()
    for seed in range(1, 10):
        panel.show(noise(seed), wait=False)
        assert bus.reached.wait(60)
    with pytest.raises(PanelTimeoutError, match=r"not shown within 0.05 s"):
        panel.flush(0.05)
    bus.gate.set()
    panel.flush(5)
    np.testing.assert_array_equal(chip.pixels, noise(9))
    assert panel.stats.dropped == 7
    assert panel.stats.frames == 3
    panel.close()


def test_what_goes_wrong_in_the_thread_is_raised_by_the_next_call():
    panel, chip = simulated()
    panel.show(noise(1), wait=False)
    panel.flush(5)
    panel.transport.bus.fail(times=None)
    panel.show(noise(2), wait=False)
    with pytest.raises(PanelDisconnectedError):
        panel.flush(5)
    panel.transport.bus.clear_faults()
    panel.show(noise(3), wait=False)
    panel.flush(5)
    np.testing.assert_array_equal(chip.pixels, noise(3))
    panel.close()


def test_ashow():
    panel, chip = simulated()

    async def script():
        reports = await asyncio.gather(panel.ashow(noise(1)), asyncio.sleep(0))
        return reports[0]

    assert asyncio.run(script()).changed_bytes == 1024
    np.testing.assert_array_equal(chip.pixels, noise(1))


@pytest.mark.parametrize("dither", ["bayer", "floyd-steinberg", "blue-noise", "stable"])
def test_ashow_dithers_as_show_does(dither):
    picture = Framebuffer(128, 64, 8)
    picture.pixels[:] = np.add.outer(np.arange(64), np.arange(128))
    (panel, chip), (other, same) = simulated(), simulated()
    asyncio.run(panel.ashow(picture, dither=dither, gamma=2.2))
    other.show(picture, dither=dither, gamma=2.2)
    np.testing.assert_array_equal(chip.pixels, same.pixels)
    assert 500 < chip.pixels.sum() < 4000


def test_frames_keep_their_beat():
    now = [0.0]
    slept = []

    def sleep(seconds):
        slept.append(seconds)
        now[0] += seconds

    frames = Frames(10, clock=lambda: now[0], sleep=sleep)
    beats = []
    for beat in frames:
        beats.append(beat)
        if len(beats) == 6:
            break
        now[0] += 0.35 if len(beats) == 3 else 0.02
    assert [beat.number for beat in beats] == [0, 1, 2, 5, 6, 7]
    assert [beat.dropped for beat in beats] == [0, 0, 0, 2, 0, 0]
    assert [round(beat.seconds, 3) for beat in beats] == [0, 0.1, 0.2, 0.55, 0.6, 0.7]
    assert (frames.count, frames.late, frames.dropped) == (6, 1, 2)
    with pytest.raises(ValueError, match="fps must be above 0"):
        Frames(0)


def test_more_frames_than_can_be_are_said_once_with_the_figure():
    now = [0.0]
    frames = Frames(30, clock=lambda: now[0], sleep=lambda seconds: None)

    def animate():
        for _, _ in zip(range(60), frames, strict=False):
            now[0] += 0.2

    with pytest.warns(RuntimeWarning, match=r"30 frames a second were asked for and 5\.\d are") as said:
        animate()
    assert len(said) == 1


# -- Care for the glass


def until(condition):
    """Wait for something that a thread does."""
    deadline = time.monotonic() + 10
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.005)
    assert condition()


def test_a_panel_dims_and_goes_off_and_the_next_picture_wakes_it():
    panel, chip = simulated("?dim_after=1&off_after=2&contrast=200")
    panel.show(noise(1))
    care = panel._care
    for rest, contrast, on in (("dim", 0, True), ("off", 0, False)):
        panel._care._changed -= 1
        panel._sender.wake_at(care.due())
        until(lambda rest=rest: care.rest == rest and panel._driver.ready)
        assert (chip.contrast, chip.registers.on) == (contrast, on)
    assert panel.show(noise(1)).unchanged
    assert not chip.registers.on
    panel.show(noise(2))
    np.testing.assert_array_equal(chip.pixels, noise(2))
    assert (chip.contrast, chip.registers.precharge, care.rest) == (200, 0xF1, "")
    panel.close()


def test_a_restart_at_rest_stays_at_rest():
    panel, chip = simulated("?dim_after=1")
    panel.show(noise(1))
    panel._care._changed -= 1
    panel._sender.wake_at(panel._care.due())
    until(lambda: panel._care.rest == "dim" and panel._driver.ready)
    chip.power_cycle()
    panel.show(noise(1), force=True)
    np.testing.assert_array_equal(chip.pixels, noise(1))
    assert (chip.contrast, chip.registers.precharge) == (0, 0x11)
    panel.close()


def test_the_picture_moves_around_a_square():
    panel, chip = simulated("?pixel_shift=1000")
    picture = noise(1)
    panel.show(picture)
    for right, down in ((1, 0), (1, 1), (0, 1), (0, 0)):
        moved = np.zeros_like(picture)
        moved[down:, right:] = picture[: 64 - down, : 128 - right]
        panel._care._moved -= 1000
        panel._sender.wake_at(panel._care.due())
        until(lambda moved=moved: np.array_equal(chip.pixels, moved))
    panel.show(noise(2))
    np.testing.assert_array_equal(chip.pixels, noise(2))
    panel.close()


@pytest.mark.parametrize("name", ["dim_after", "off_after", "pixel_shift"])
def test_no_care_in_no_time(name):
    with pytest.raises(ValueError, match=f"{name} must be seconds above 0"):
        simulated(f"?{name}=0")


@pytest.mark.parametrize("seconds", ["1e12", "inf"])
def test_care_that_is_never_due(seconds):
    panel, chip = simulated(f"?dim_after={seconds}")
    panel.show(noise(1))
    time.sleep(0.02)
    panel.show(noise(2), wait=False)
    panel.flush(5)
    np.testing.assert_array_equal(chip.pixels, noise(2))
    panel.close()


@pytest.mark.parametrize("chip", ["ssd1306", "ssd1327", "pcd8544", "st7920", "max7219", "is31fl3731"])
def test_an_inverted_panel_is_left_black_too(chip):
    panel = open_panel(f"sim://{chip}?on_close=clear")
    panel.invert()
    panel.show(np.zeros((panel.height, panel.width), np.uint8))
    assert panel.simulated.pixels.all()
    panel.close()
    assert not panel.simulated.pixels.any()


# -- Processes


def run(script, *, check=True, **options):
    """Run a script in a process of its own that leaves the simulated chip's last picture in a file."""
    return subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)], capture_output=True, text=True, check=check, **options
    )


LEFT = """
    import os, signal, sys, threading, time
    import numpy as np
    from paneldraw import open_panel

    def watch(panel):
        chip = panel.simulated
        write = chip.write
        def watched(payload):
            write(payload)
            print(int(chip.pixels.sum()), int(chip.registers.on), flush=True)
        chip.write = watched
        return panel

    panel = watch(open_panel("sim://ssd1306?on_close={on_close}"))
    panel.show(np.ones((64, 128), np.uint8))
"""

ENDS = {
    "end": ("", 0),
    "with": ("with panel: pass", 0),
    "sys.exit": ("sys.exit(3)", 3),
    "exception": ("raise RuntimeError('so it ends')", 1),
    "SIGINT": ("signal.signal(signal.SIGINT, signal.default_int_handler); signal.raise_signal(signal.SIGINT)", -2),
    "SIGTERM": ("signal.raise_signal(signal.SIGTERM)", -15),
    "SIGHUP": ("signal.raise_signal(signal.SIGHUP)", -1),
    "forgotten": ("del panel", 0),
    "in the middle": (
        "panel.simulated.write = lambda payload, write=panel.simulated.write: ("
        "os.kill(os.getpid(), signal.SIGTERM) if signal.getsignal(signal.SIGTERM) else None, write(payload))\n"
        "    panel.show(np.eye(64, 128, dtype=np.uint8))",
        -15,
    ),
}


@posix
@pytest.mark.parametrize(("on_close", "left"), [("clear", "0 1"), ("off", "0 0"), ("keep", "8192 1")])
@pytest.mark.parametrize("end", ENDS)
def test_what_the_end_of_a_script_leaves(on_close, left, end):
    script, code = ENDS[end]
    if end == "in the middle" and on_close == "keep":  # that script kills itself only where something is installed
        left, code = "64 1", 0
    done = run(LEFT.format(on_close=on_close) + "    " + script, check=False)
    assert done.returncode == code, done.stderr
    assert done.stdout.splitlines()[-1] == left


def test_the_first_process_of_a_container_ends_at_sigterm_too():
    namespace = ["unshare", "--map-root-user", "--pid", "--fork", "--kill-child"]
    if shutil.which("unshare") is None or subprocess.run([*namespace, "true"], capture_output=True).returncode:
        pytest.skip("this machine makes no namespaces")
    script = textwrap.dedent(LEFT.format(on_close="off")) + "os.kill(os.getpid(), signal.SIGTERM)\nprint('still here')"
    done = subprocess.run([*namespace, sys.executable, "-c", script], capture_output=True, text=True)
    assert done.returncode == 128 + 15, done.stderr
    assert done.stdout.splitlines()[-1] == "0 0"


@posix
def test_what_nothing_can_help():
    """os._exit and SIGKILL leave the panel as it is."""
    for end in ("os._exit(0)", "os.kill(os.getpid(), signal.SIGKILL)"):
        assert run(LEFT.format(on_close="off") + "    " + end, check=False).stdout.splitlines()[-1] == "8192 1"


@posix
def test_other_handlers_are_kept_and_nothing_is_installed_for_keep():
    script = """
        import signal
        from paneldraw import open_panel
        open_panel("sim://ssd1306")
        assert signal.getsignal(signal.SIGTERM) is signal.SIG_DFL
        mine = lambda number, frame: print("mine")
        signal.signal(signal.SIGTERM, mine)
        panel = open_panel("sim://ssd1306?on_close=off")
        assert signal.getsignal(signal.SIGTERM) is mine
        assert signal.getsignal(signal.SIGHUP) not in (signal.SIG_DFL, mine)
        signal.raise_signal(signal.SIGTERM)
        panel.clear()
    """
    assert run(script).stdout == "mine\n"


@posix
def test_a_forked_child_hears_that_the_panel_is_its_parents():
    script = """
        import os, threading, time
        import numpy as np
        from paneldraw import open_panel
        from paneldraw.errors import PanelError

        panel = open_panel("sim://ssd1306?on_close=off")
        panel.show(np.ones((64, 128), np.uint8), wait=False)
        panel.flush()
        held, go = threading.Event(), threading.Event()
        def hold():
            with panel._lock:
                held.set()
                go.wait(20)
        threading.Thread(target=hold).start()
        held.wait()
        child = os.fork()
        if child == 0:
            for call in (panel.clear, lambda: panel.contrast(3), panel.sleep, lambda: panel.show(wait=False)):
                try:
                    call()
                except PanelError as error:
                    assert f"process {os.getppid()}" in str(error), error
                else:
                    os._exit(1)
            panel.close()
            del panel
            os._exit(0)
        assert os.waitpid(child, 0)[1] == 0
        go.set()
        panel.show(np.eye(64, 128, dtype=np.uint8))
        assert panel.simulated.pixels.sum() == 64
        print("whole")
    """
    assert run(script, timeout=60).stdout == "whole\n"
