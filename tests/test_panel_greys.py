"""A panel of one bit that shows greys: its thread, its pictures, and what may happen meanwhile."""

from __future__ import annotations

import asyncio
import math
import os
import signal
import threading
import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from paneldraw import ConeFilter, Framebuffer, Panel, Supersample, open_panel, simulator
from paneldraw.controllers import SH1106, SSD1306, SSD1327
from paneldraw.demos.scenes import SCENES
from paneldraw.errors import PanelError, TransportError
from paneldraw.framebuffer.pictures import quantize
from paneldraw.transports import I2CTransport
from paneldraw.update.greys import Cycle, in_greys

ADDRESS = 0x3C


def made(greys: int = 4, **settings: Any) -> tuple[Panel, simulator.SSD1306, simulator.I2CBus]:
    chip = simulator.SSD1306(history=None)
    bus = simulator.I2CBus({ADDRESS: chip})
    return Panel(SSD1306(), I2CTransport(bus), greys=greys, **settings), chip, bus


def picture(panel: Panel, x: int = 64) -> np.ndarray:
    fb = panel.framebuffer()
    fb.circle(x, 32, 20, fill=True, antialias=Supersample(4))
    return fb.pixels.copy()


def sub_pictures(levels: np.ndarray) -> list[bytes]:
    cycle = Cycle(4)
    return [one.tobytes() for one in cycle.pictures(cycle.steps(levels, 3))]


def until(happened: object, seconds: float = 5.0) -> bool:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if happened():  # type: ignore[operator]
            return True
        time.sleep(0.005)
    return False


def threads() -> Iterator[threading.Thread]:
    return (thread for thread in threading.enumerate() if thread.name == "paneldraw sender")


@pytest.mark.parametrize(("greys", "depth"), [(1, 1), (3, 2), (4, 2), (5, 4), (8, 4)])
def test_the_depth_is_that_of_the_greys(greys: int, depth: int) -> None:
    with made(greys, weighted=True)[0] as panel:
        assert (panel.depth, panel.framebuffer().depth) == (depth, depth)
        assert not list(threads())


def test_show_returns_at_once_and_the_sub_pictures_follow_each_other() -> None:
    panel, chip, _ = made()
    with panel:
        levels = picture(panel)
        assert panel.show(levels).queued
        assert until(lambda: len(chip.frames) > 12)
        frames = [frame.pixels.tobytes() for frame in list(chip.frames)]
    wanted = sub_pictures(levels)
    assert frames[:12] == wanted * 4
    assert not list(threads())
    assert chip.violations == []
    assert np.array_equal(chip.pixels, levels >= 2)


def test_two_pictures_never_mix_within_a_cycle() -> None:
    panel, chip, _ = made()
    with panel:
        shown = [picture(panel, x) for x in (30, 50, 70, 90)]
        for levels in shown:
            panel.show(levels)
            time.sleep(0.03)
            panel.flush()
        count = len(chip.frames)
        assert until(lambda: len(chip.frames) > count + 3)
        frames = [frame.pixels.tobytes() for frame in list(chip.frames)]
    cycles = [sub_pictures(levels) for levels in shown]
    starts = range(0, len(frames) - 2, 3)
    assert all(frames[at : at + 3] in cycles for at in starts)
    assert [cycle in [frames[at : at + 3] for at in starts] for cycle in cycles] == [True] * 4


def test_nothing_is_sent_while_there_is_no_grey() -> None:
    panel, chip, bus = made()
    with panel:
        panel.show(picture(panel))
        assert until(lambda: len(chip.frames) > 6)
        black_and_white = (picture(panel) >= 2).astype(np.uint8) * 3
        panel.show(black_and_white)
        panel.flush()
        before = bus.bytes
        time.sleep(0.1)
        assert bus.bytes == before
        assert np.array_equal(chip.pixels, black_and_white > 0)


def test_asleep_nothing_is_sent() -> None:
    panel, chip, bus = made()
    with panel:
        panel.show(picture(panel))
        assert until(lambda: len(chip.frames) > 6)
        panel.sleep()
        time.sleep(0.05)
        before, count = bus.bytes, len(chip.frames)
        time.sleep(0.1)
        assert bus.bytes == before
        panel.wake()
        assert until(lambda: len(chip.frames) > count + 6)


def test_a_forced_picture_starts_the_chip_anew_while_greys_cycle() -> None:
    panel, chip, _ = made()
    with panel:
        levels = picture(panel)
        panel.show(levels)
        assert until(lambda: len(chip.frames) > 6)
        for restarts in range(1, 11):
            asyncio.run(panel.ashow(levels, force=True))
            panel.flush()
            assert until(lambda restarts=restarts: panel.stats.restarts >= restarts)  # type: ignore[misc]
        time.sleep(0.05)
        assert panel.stats.restarts == 10
    assert chip.violations == []


def test_a_fault_within_a_cycle_heals() -> None:
    panel, chip, bus = made()
    with panel:
        levels = picture(panel)
        panel.show(levels)
        assert until(lambda: len(chip.frames) > 6)
        bus.fail(at_byte=3)
        bus.fail(after=5)
        assert until(lambda: panel.stats.retries >= 2)
        count = len(chip.frames)
        assert until(lambda: len(chip.frames) > count + 6)
        tail = [frame.pixels.tobytes() for frame in list(chip.frames)[-5:]]
    assert set(tail) <= set(sub_pictures(levels))


def test_a_panel_that_is_gone_ends_the_cycle_and_the_next_show_says_so() -> None:
    panel, chip, bus = made()
    levels = picture(panel)
    panel.show(levels)
    assert until(lambda: len(chip.frames) > 6)
    del bus.devices[ADDRESS]
    assert until(lambda: panel._sender is not None and panel._sender.error is not None)
    with pytest.raises(TransportError):
        panel.show(levels)
    bus.devices[ADDRESS] = chip
    count = len(chip.frames)
    panel.show(levels)
    assert until(lambda: len(chip.frames) > count + 6)
    panel.close()
    with pytest.raises(PanelError):
        panel.show(levels)


def test_settings_between_sub_pictures_mix_nothing() -> None:
    panel, chip, _ = made()
    with panel:
        levels = picture(panel)
        panel.show(levels)
        for level in range(0, 250, 10):
            panel.contrast(level)
            time.sleep(0.002)
        assert until(lambda: len(chip.frames) > 12)
        panel.rotate = 180
        panel.show(levels)
        panel.flush()
        frames = {frame.pixels.tobytes() for frame in list(chip.frames)}
    turned = np.ascontiguousarray(levels[::-1, ::-1])
    assert frames <= {*sub_pictures(levels), *sub_pictures(turned), (turned >= 2).astype(np.uint8).tobytes()}
    assert chip.contrast == 240


def test_too_much_for_the_wire_is_shown_in_fewer_greys_and_said_once() -> None:
    panel, chip, _ = made(bus_clock=100_000)
    noise = np.random.default_rng(1).integers(0, 4, (64, 128), np.uint8)

    def shown(levels: np.ndarray) -> None:
        panel.show(levels)
        panel.flush()

    with pytest.warns(RuntimeWarning, match="shown in 2 greys instead of 4"):
        shown(noise)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        shown(noise[::-1])
    panel.close()
    assert panel.stats.fewer_greys == 2
    assert np.array_equal(chip.pixels, noise[::-1] >= 2)


@pytest.mark.parametrize(
    ("settings", "complaint"),
    [
        ({"greys": 6}, "greys must be one of 3, 4, 5, 8, 16, not 6"),
        ({"greys": 4, "bus_share": 0}, "bus_share must be above 0 and at most 1, not 0"),
        ({"greys": 4, "bus_clock": -1}, "bus_clock must be Hz above 0"),
        ({"greys": 8}, "greys must be at most 4 for the ssd1306 on this wire.*weighted=True, not 8"),
        ({"greys": 16, "weighted": True}, "greys must be at most 8 for the ssd1306 on this wire, .* a cycle, not 16"),
        ({"greys": 4, "bus_clock": 3000}, "greys must be at most 1 for the ssd1306 on this wire"),
        ({"greys": 4, "weighted": (0, 1, 2)}, "weighted must be True, .*: light must be 256 figures that rise.* not 3"),
        ({"greys": 4, "weighted": [1.0] + [0.0] * 255}, "weighted must be True, .*: light must be 256 figures"),
    ],
)
def test_settings_that_cannot_be_are_refused(settings: dict[str, int], complaint: str) -> None:
    with pytest.raises(ValueError, match=complaint):
        made(**settings)


def test_a_chip_with_greys_of_its_own_needs_none() -> None:
    bus = simulator.I2CBus({ADDRESS: simulator.SSD1327()})
    with pytest.raises(ValueError, match="greys must be 1 for the ssd1327, which has 16 of its own"):
        Panel(SSD1327(), I2CTransport(bus), greys=4)


def test_a_url_has_them_too() -> None:
    with open_panel("sim://ssd1306?greys=4") as panel:
        assert panel.depth == 2
        levels = picture(panel)
        panel.show(levels)
        panel.flush()
        time.sleep(0.5)
        seen = panel.simulated.seen(0.3) / (panel.simulated.contrast / 255)
    assert np.abs(seen - levels / 3)[levels == 3].max() == pytest.approx(0)
    assert np.abs(seen - levels / 3).mean() < 0.03


@pytest.mark.parametrize("name", ["ssd1306?size=128x32", "sh1106", "st7920", "ht16k33", "max7219", "pcd8544"])
def test_other_chips_of_one_bit_have_them_too(name: str) -> None:
    with open_panel(f"sim://{name}{'&' if '?' in name else '?'}greys=4") as panel:
        chip = panel.simulated
        levels = np.zeros((panel.height, panel.width), np.uint8)
        levels[1, 1:4], levels[3:5, 2] = (1, 2, 3), (2, 1)
        panel.show(levels)
        panel.flush()
        seen = set()
        wanted = set(sub_pictures(levels))
        assert until(lambda: seen.add(chip.pixels.tobytes()) or seen >= wanted)
        assert chip.violations == []
    assert np.array_equal(chip.pixels > 0, levels >= 2)


@pytest.mark.parametrize("bus_share", [0.4, 0.8])
def test_two_panels_share_a_bus(bus_share: float) -> None:
    chips = {address: simulator.SSD1306(history=None) for address in (0x3C, 0x3D)}
    bus = simulator.I2CBus(chips)
    bus.realtime = True
    panels = [Panel(SSD1306(), I2CTransport(bus, address), greys=4, bus_share=bus_share) for address in chips]
    for panel in panels:
        fb = panel.framebuffer()
        fb.circle(64, 32, 10, fill=True, antialias=Supersample(4))
        panel.show(fb)
    assert until(lambda: all(panel.stats.sub_pictures > 30 for panel in panels))
    assert [panel.stats.frames for panel in panels] == [1, 1]
    frames = [panel.stats.sub_pictures for panel in panels]
    assert max(frames) < 1.5 * min(frames)
    for panel, chip in zip(panels, chips.values(), strict=True):
        panel.close()
        assert chip.violations == []


def test_pictures_are_counted_and_their_sub_pictures_beside_them() -> None:
    panel, chip, _ = made()
    with panel:
        panel.show(picture(panel))
        panel.flush()
        panel.show(picture(panel, 40))
        panel.flush()
        panel.show(picture(panel, 40) // 3 * 3)
        panel.flush()
        assert panel.stats.frames == 3
        assert panel.stats.sub_pictures == len(chip.frames) >= 7


def test_weighted_sub_pictures_change_the_contrast_and_the_last_picture_has_it_back() -> None:
    panel, chip, _ = made(weighted=True)
    contrasts = set()
    with panel:
        panel.contrast(200)
        levels = picture(panel)
        panel.show(levels)
        assert until(lambda: contrasts.add(chip.contrast) or {100, 200} <= contrasts)
        panel.contrast(80)
        contrasts.clear()
        assert until(lambda: contrasts.add(chip.contrast) or {40, 80} <= contrasts)
        panel.show(levels // 3 * 3)
        panel.flush()
        assert chip.contrast == 80
    weighted = Cycle(4, weighted=True)
    wanted = {one.tobytes() for one in (*weighted.pictures(levels), levels == 3)}
    assert {frame.pixels.tobytes() for frame in list(chip.frames)} <= wanted


def test_a_table_of_ones_own_weighs_them() -> None:
    panel, chip, _ = made(weighted=[(contrast / 255) ** 2 for contrast in range(256)])
    contrasts = set()
    with panel:
        panel.show(picture(panel))
        assert until(lambda: contrasts.add(chip.contrast) or {180, 255} <= contrasts)


def test_a_chip_of_unknown_light_is_not_weighted_without_a_table() -> None:
    chip = simulator.SH1106()
    with pytest.raises(ValueError, match="weighted must be False for the sh1106, of which it is not known"):
        Panel(SH1106(), I2CTransport(simulator.I2CBus({ADDRESS: chip})), greys=4, weighted=True)
    with Panel(
        SH1106(), I2CTransport(simulator.I2CBus({ADDRESS: chip})), greys=4, weighted=np.linspace(0, 1, 256)
    ) as panel:
        assert panel.depth == 2


@pytest.mark.parametrize(
    ("query", "depth"),
    [("greys=4&bus_share=0.5&bus_clock=1000000", 2), ("greys=8&weighted=1", 4), ("greys=3&weighted=0", 2)],
)
def test_urls_have_the_settings(query: str, depth: int) -> None:
    with open_panel(f"sim://ssd1306?{query}") as panel:
        assert panel.depth == depth
    with pytest.raises(ValueError, match=r"bus_share must be a number, such as 0.8, not 'half'"):
        open_panel("sim://ssd1306?greys=4&bus_share=half")


def test_a_panel_that_is_dimmed_turned_off_and_woken_keeps_its_greys() -> None:
    panel, chip, bus = made(dim_after=0.15, off_after=0.4, contrast=200)
    with panel:
        levels = picture(panel)
        panel.show(levels)
        assert until(lambda: chip.contrast == 0)
        count = len(chip.frames)
        assert until(lambda: len(chip.frames) > count + 6)
        assert until(lambda: not chip.lit)
        time.sleep(0.05)
        before = bus.bytes
        time.sleep(0.1)
        assert bus.bytes == before
        panel.show(picture(panel, 40))
        assert until(lambda: chip.lit and chip.contrast == 200)
        count = len(chip.frames)
        assert until(lambda: len(chip.frames) > count + 6)
        tail = {frame.pixels.tobytes() for frame in list(chip.frames)[-3:]}
    assert tail == set(sub_pictures(picture(panel, 40)))


def test_a_picture_in_greys_moves_as_a_whole() -> None:
    panel, chip, _ = made(pixel_shift=0.1)
    with panel:
        levels = picture(panel)
        panel.show(levels)
        moved = np.zeros_like(levels)
        moved[:, 1:] = levels[:, :-1]
        wanted = sub_pictures(moved)
        assert until(lambda: {frame.pixels.tobytes() for frame in list(chip.frames)[-3:]} == set(wanted))
        frames = [frame.pixels.tobytes() for frame in list(chip.frames)]
    cycles = [frames[at : at + 3] for at in range(0, len(frames) - 2, 3)]
    assert sub_pictures(levels) in cycles
    assert frames.index(wanted[0]) % 3 == 0


def test_inverted_greys_are_inverted() -> None:
    panel, chip, _ = made()
    with panel:
        panel.show(picture(panel))
        panel.invert()
        assert until(lambda: len(chip.frames) > 12)
        assert chip.inverted
        tail = {frame.pixels.tobytes() for frame in list(chip.frames)[-3:]}
    assert tail == {(1 - np.frombuffer(one, np.uint8)).tobytes() for one in sub_pictures(picture(panel))}


@pytest.fixture
def alarm() -> Iterator[Callable[[Callable[..., object]], None]]:
    """Sets what happens when the timer is over."""
    if not hasattr(signal, "setitimer"):
        pytest.skip("there is no timer here that sends signals")
    before = signal.getsignal(signal.SIGALRM)
    yield lambda handler: signal.signal(signal.SIGALRM, handler) and None
    signal.setitimer(signal.ITIMER_REAL, 0)
    signal.signal(signal.SIGALRM, before)


def test_a_caller_that_is_interrupted_leaves_a_panel_that_goes_on(alarm: Any) -> None:
    panel, chip, _ = made()
    levels = picture(panel)

    def show_for_ever() -> None:
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        while True:
            panel.show(levels)

    alarm(signal.default_int_handler)
    with panel:
        panel.show(levels)
        assert until(lambda: len(chip.frames) > 6)
        for _ in range(20):
            with pytest.raises(KeyboardInterrupt):
                show_for_ever()
        count = len(chip.frames)
        assert until(lambda: len(chip.frames) > count + 6)
        panel.flush(5)
        tail = {frame.pixels.tobytes() for frame in list(chip.frames)[-3:]}
    assert tail == set(sub_pictures(levels))
    assert not list(threads())


def test_an_exception_in_the_block_ends_the_cycle() -> None:
    panel, chip, bus = made()
    levels = picture(panel)

    def draw() -> None:
        with panel:
            panel.show(levels)
            assert until(lambda: len(chip.frames) > 6)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        draw()
    before = bus.bytes
    time.sleep(0.05)
    assert bus.bytes == before
    assert np.array_equal(chip.pixels, levels >= 2)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork here")
def test_a_forked_child_sends_nothing_and_the_parent_goes_on() -> None:
    panel, chip, bus = made()
    with panel:
        levels = picture(panel)
        panel.show(levels)
        assert until(lambda: len(chip.frames) > 6)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of a fork beside threads
            child = os.fork()
        if not child:
            before = bus.bytes
            try:
                panel.show(levels)
            except PanelError:
                time.sleep(0.1)
                os._exit(0 if bus.bytes == before else 2)
            os._exit(1)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        count = len(chip.frames)
        assert until(lambda: len(chip.frames) > count + 6)


def test_a_picture_from_a_signal_handler_hangs_nothing(alarm: Any) -> None:
    panel, chip, _ = made()
    with panel:
        levels, other = picture(panel), picture(panel, 40)
        alarm(lambda *_: panel.show(other))
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.002, 0.002)
            end = time.monotonic() + 0.3
            while time.monotonic() < end:
                panel.show(levels)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        panel.show(other)
        panel.flush(5)
        assert until(lambda: chip.frames[-1].pixels.tobytes() in sub_pictures(other))


def test_a_picture_may_turn_while_it_cycles() -> None:
    panel, chip, _ = made()
    turned = []
    with panel:
        for rotate in (0, 180, 0, 180):
            panel.rotate = rotate
            levels = picture(panel, 40)
            panel.show(levels)
            panel.flush()
            turned.append(levels if not rotate else np.ascontiguousarray(levels[::-1, ::-1]))
            time.sleep(0.05)
        frames = {frame.pixels.tobytes() for frame in list(chip.frames)}
    last = (turned[-1] >= 2).astype(np.uint8).tobytes()
    assert frames <= {last, *(one for levels in turned for one in sub_pictures(levels))}


# -- By the simulated eye


def shown(levels: np.ndarray, seconds: float = 0.5, max_level: int = 3) -> simulator.SSD1306:
    """A chip on which a picture has cycled, in the bus's own time."""
    chip = simulator.SSD1306(history=1)
    chip.remembers = True
    bus = simulator.I2CBus({ADDRESS: chip}, timer=None)
    cycling = Panel(SSD1306(), I2CTransport(bus), greys=4, contrast=255)._cycling
    assert cycling is not None
    choice, still = cycling.choose(levels, max_level)
    assert choice is not None
    cycling.begin(choice, still)
    for lasts in choice.seconds * int(seconds * choice.rate):
        before = bus.seconds
        cycling.turn()
        bus.idle(max(0.0, lasts - (bus.seconds - before)))
    return chip


@pytest.mark.parametrize("scene", ["graph", "wire cube", "ball"])
def test_the_light_of_each_pixel_is_its_level(scene: str) -> None:
    fb = Framebuffer(128, 64, 2, antialias=Supersample(4))
    SCENES[scene](fb, 30)
    chip = shown(fb.pixels)
    gray = (fb.pixels > 0) & (fb.pixels < 3)
    errors = np.abs(chip.seen(0.1) - fb.pixels / 3)
    assert gray.sum() > 10
    assert errors[gray].mean() <= 0.03
    assert errors.max() <= 0.08
    assert chip.flicker(0.3)[gray].max() < 0.2


def test_the_clock_has_four_greys_and_few_torn_lines() -> None:
    fb = Framebuffer(128, 64, 2)
    SCENES["clock"](fb, 30)
    errors = np.abs(shown(fb.pixels).seen(0.1) - fb.pixels / 3)
    assert errors.mean() <= 0.03
    assert np.percentile(errors, 99) <= 0.08


def spoke(degrees: float, width: float, x: float = 64, y: float = 32) -> np.ndarray:
    """A line of 50 pixels, drawn in 256 levels."""
    fb = Framebuffer(128, 64, 8, antialias=ConeFilter())
    across, down = 25 * math.cos(math.radians(degrees)), 25 * math.sin(math.radians(degrees))
    fb.line(x - across, y - down, x + across, y + down, width=width)
    return fb.pixels


@pytest.mark.parametrize("width", [1, 2])
def test_a_line_is_as_bright_at_every_angle(width: float) -> None:
    light = [
        shown(spoke(degrees, width), seconds=0.3, max_level=255).seen(9 / 51).sum() for degrees in range(0, 180, 20)
    ]
    assert np.abs(np.array(light) / np.mean(light) - 1).max() <= 0.03


@pytest.mark.parametrize("greys", [3, 4, 5, 8])
@pytest.mark.parametrize("width", [1, 1.5, 2, 3])
def test_rounding_to_greys_keeps_the_light_of_a_line(greys: int, width: float) -> None:
    for x, y in ((64, 32), (64.3, 32.7), (64.5, 32.5)):
        light = [in_greys(spoke(degrees, width, x, y), 255, greys).sum() for degrees in range(0, 180, 4)]
        assert np.abs(np.array(light) / np.mean(light) - 1).max() <= 0.03


@given(st.integers(0, 2**32 - 1), st.sampled_from([1, 3, 15, 255]), st.sampled_from([3, 4, 5, 8, 16]))
def test_rounding_is_off_by_less_than_a_grey(seed: int, max_level: int, greys: int) -> None:
    levels = np.random.default_rng(seed).integers(0, max_level + 1, (9, 70), dtype=np.uint8)
    found = in_greys(levels, max_level, greys).astype(int)
    exact = levels.astype(float) * (greys - 1) / max_level
    assert np.abs(found - exact).max() < 1
    assert np.abs((found - exact).cumsum(axis=1)).max() < 1
    assert np.array_equal(found[levels == 0], 0 * found[levels == 0])
    assert np.all(found[levels == max_level] == greys - 1)


def test_half_covered_is_half_the_light() -> None:
    covered = np.zeros((64, 128), np.uint8)
    covered[16:32, 50:66] = 128
    seen = shown(quantize(covered, 3, "blue-noise")).seen(9 / 51)
    assert seen[16:32, 50:66].mean() == pytest.approx(128 / 255, abs=0.02)
    assert seen[:, 70:].max() == 0


@pytest.mark.parametrize("dither", [None, "blue-noise"])
@pytest.mark.parametrize("greys", [3, 4, 5])
def test_a_picture_is_as_light_as_its_file_says(greys: int, dither: Any) -> None:
    with made(greys, weighted=greys > 4)[0] as panel:
        photograph = Image.fromarray(np.full((64, 128), 186, np.uint8))
        levels, max_level = panel._levels(photograph, dither, 2.2)
    if dither is None:
        levels = in_greys(levels, max_level, greys)
    else:
        assert max_level == greys - 1
    assert levels.mean() / (greys - 1) == pytest.approx((186 / 255) ** 2.2, abs=0.01)


def test_a_picture_that_is_drawn_on_after_its_show_is_shown_as_it_was() -> None:
    panel, chip, _ = made()
    with panel:
        levels = picture(panel)
        wanted = sub_pictures(levels)
        for _ in range(20):
            panel.show(levels)
            before = levels.copy()
            levels[...] = np.random.default_rng(1).integers(0, 4, levels.shape, np.uint8)
            time.sleep(0.002)
            levels[...] = before
        panel.flush()
        frames = {frame.pixels.tobytes() for frame in list(chip.frames)}
    assert frames <= {*wanted, (before >= 2).astype(np.uint8).tobytes()}
