"""Faults in every call of a panel, and long runs on a bad wire: whatever happens, the next show is whole."""

from __future__ import annotations

import errno
import gc
import os
import sys
import threading

import bad_wire
import numpy as np
import pytest

from paneldraw import Panel, simulator
from paneldraw.controllers import MAX7219, SH1106, SSD1306, SSD1327
from paneldraw.errors import PanelError
from paneldraw.transports import I2CTransport, SPITransport

pytestmark = pytest.mark.usefixtures("own_time")

CODES = [errno.EREMOTEIO, errno.ENXIO, errno.EIO, errno.ETIME, errno.EAGAIN, errno.EBUSY, errno.ETIMEDOUT]
#: One code of each kind always; those that are like them, in the thorough tests.
FIRST = (errno.EREMOTEIO, errno.ETIME, errno.EAGAIN, errno.ETIMEDOUT)
FAULTS = [code if code in FIRST else pytest.param(code, marks=pytest.mark.thorough) for code in CODES]
CHAIN = MAX7219(32, 8)


def made(chip):
    """A panel that shows a picture, its simulated chip, and its bus."""
    if chip is CHAIN:
        glass = simulator.MAX7219(32, 8)
        bus = simulator.SPIBus(glass, dc=None, reset=None, timer=None)
        transport = SPITransport(spi=bus.spi, pins=bus.pins, dc=None, reset=None)
    else:
        glass = getattr(simulator, chip.name)(history=1)
        bus = simulator.I2CBus({0x3C: glass}, timer=None)
        transport = I2CTransport(bus)
    return transport, glass, bus


def made_again(chip, bus):
    """Another transport to a chip that is there already."""
    return SPITransport(spi=bus.spi, pins=bus.pins, dc=None, reset=None) if chip is CHAIN else I2CTransport(bus)


def picture(panel, seed):
    return np.random.default_rng(seed).integers(0, 2**panel.depth, (panel.height, panel.width), np.uint8)


def turn(panel):
    panel.rotate = 180
    panel.show(picture(panel, 5))


CALLS = {
    "show": lambda panel: panel.show(picture(panel, 2)),
    "contrast": lambda panel: panel.contrast(40),
    "dim": lambda panel: panel.dim(20),
    "invert": lambda panel: panel.invert(),
    "rotate": turn,
    "sleep": lambda panel: panel.sleep(),
    "wake": lambda panel: panel.wake(),
}
CHIPS = {"ssd1306": SSD1306, "sh1106": SH1106, "ssd1327": SSD1327, "chain": CHAIN}
every_chip = pytest.mark.parametrize("chip", CHIPS.values(), ids=CHIPS)


def of_chip(chip, code):
    """The code as a bus of this chip can have it: nobody acknowledges anything on SPI."""
    return errno.EIO if chip is CHAIN and code in (errno.EREMOTEIO, errno.ENXIO, errno.ETIME) else code


def opened(chip, transport, **options):
    return Panel(chip if chip is CHAIN else chip(), transport, **options)


def failing(bus, code, position, times, operation, answered=True):
    """Do something while messages fail; return whether one did, and our error if it was raised.

    Only a fault that lasts may be raised once the panel has answered.
    """
    came = []
    bus.fail(code, after=position, times=times, then=lambda: came.append(1))
    failed = None
    try:
        operation()
    except PanelError as error:
        failed = error
        assert failed.errno == code
        assert ": " in str(failed), "say what to do next"
        assert times is None or not answered
    bus.clear_faults()
    return bool(came), failed


def survives(chip, call, times, code, position):
    """See that a call with a fault at a message of it ends well; return whether there was such a message."""
    transport, glass, bus = made(chip)
    if call == "init":
        panels = []

        def start():
            panels.append(opened(chip, transport))

        came, failed = failing(bus, code, position, times, start, answered=position > 0)
        panel = panels[0] if panels else opened(chip, made_again(chip, bus))
        assert bool(panels) == (failed is None)
    else:
        panel = opened(chip, transport)
        panel.show(picture(panel, 1))
        came, _ = failing(bus, code, position, times, lambda: CALLS[call](panel))
    panel.wake()
    panel.show(picture(panel, 3))
    seen = glass.pixels if panel.rotate == 0 else glass.pixels[::-1, ::-1]
    highest = 2**panel.depth - 1
    wanted = highest - picture(panel, 3) if call == "invert" else picture(panel, 3)
    np.testing.assert_array_equal(seen, wanted)
    return came


@pytest.mark.parametrize("code", FAULTS)
@pytest.mark.parametrize("times", [1, 3, None])
@pytest.mark.parametrize("call", CALLS)
@every_chip
def test_after_any_fault_in_any_call_the_next_show_is_whole(chip, call, times, code):
    for position in range(0, 12, 3):
        survives(chip, call, times, of_chip(chip, code), position)


@pytest.mark.thorough
@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("times", [1, 3, None])
@pytest.mark.parametrize("call", ["init", *CALLS])
@every_chip
def test_after_a_fault_at_every_message_the_next_show_is_whole(chip, call, times, code):
    position = 0
    while survives(chip, call, times, of_chip(chip, code), position):
        position += 1
    assert position >= 1


@pytest.mark.parametrize("code", FAULTS)
@pytest.mark.parametrize("times", [1, 3, None])
@pytest.mark.parametrize("on_close", ["clear", "off"])
@every_chip
def test_a_fault_at_every_message_of_close_is_ours_and_the_bus_is_closed(chip, on_close, times, code):
    position, came = 0, True
    while came:
        transport, glass, bus = made(chip)
        panel = opened(chip, transport, on_close=on_close)
        panel.show(picture(panel, 1))
        came, failed = failing(bus, of_chip(chip, code), position, times, panel.close)
        if failed is None:
            assert not glass.pixels.any()
        with pytest.raises(PanelError, match="closed"):
            panel.show(picture(panel, 2))
        again = opened(chip, made_again(chip, bus))
        again.show(picture(again, 3))
        np.testing.assert_array_equal(glass.pixels, picture(again, 3))
        position += 1
    assert position > 1


@pytest.mark.parametrize("code", CODES)
def test_a_fault_at_the_start_or_at_the_end_is_ours(code):
    transport, _, bus = made(SSD1306)
    bus.fail(code, times=None)
    with pytest.raises(PanelError) as caught:
        Panel(SSD1306(), transport)
    assert caught.value.errno == code
    bus.clear_faults()
    transport, _, bus = made(SSD1306)
    panel = Panel(SSD1306(), transport, on_close="off")
    panel.show(picture(panel, 1))
    bus.fail(code, times=None)
    with pytest.raises(PanelError):
        panel.close()
    panel.close()  # a second time does nothing


# -- What happens to a bus


def other_master(glass):
    """Another program moves the pointer, and the window."""
    glass.write(b"\x00" + bytes.fromhex("21 20 5F 22 02 03 B3 05 12"))


FAULTS = {
    "short": lambda bus, glass: bus.fail(0, after=1),
    "short in a message": lambda bus, glass: bus.fail(0, at_byte=3),
    "stuck, soon free": lambda bus, glass: bus.stick(calls=2),
    "stuck, soon free, busy": lambda bus, glass: bus.stick(errno.EAGAIN, calls=2),
    "a long stretch": lambda bus, glass: bus.stretch(2, at_byte=2),
    "a short stretch": lambda bus, glass: bus.stretch(0.5),
    "a reset": lambda bus, glass: bus.fail(at_byte=4, then=glass.reset),
    "a brown-out": lambda bus, glass: bus.fail(after=1, at_byte=30, then=glass.power_cycle),
    "arbitration lost": lambda bus, glass: bus.fail(errno.EAGAIN, at_byte=2, then=lambda: other_master(glass)),
    "stuck": lambda bus, glass: bus.stick(),
    "short for ever": lambda bus, glass: bus.fail(0, times=None),
    "a stretch for ever": lambda bus, glass: bus.stretch(5, times=None),
}
LASTING = ("stuck", "short for ever", "a stretch for ever")


@pytest.mark.usefixtures("own_time")
@pytest.mark.parametrize("fault", FAULTS)
@pytest.mark.parametrize("chip", [SSD1306, SH1106, SSD1327], ids=["ssd1306", "sh1106", "ssd1327"])
@pytest.mark.parametrize("fresh", [False, True], ids=["the same picture", "a new picture"])
def test_the_next_show_is_whole_or_says_what_to_do(chip, fault, fresh):
    transport, glass, bus = made(chip)
    with Panel(chip(), transport) as panel:
        first = picture(panel, 1)
        panel.show(first)
        first[10:14, 20:70] ^= 1
        wanted = picture(panel, 2) if fresh else first
        FAULTS[fault](bus, glass)
        if fault in LASTING:
            with pytest.raises(PanelError, match=r"check|pull-up") as caught:
                panel.show(wanted)
            assert caught.value.errno in (errno.EIO, errno.ETIMEDOUT)
            bus.clear_faults()
        panel.show(wanted)
        np.testing.assert_array_equal(glass.pixels, wanted)
        assert glass.registers.on


@pytest.mark.parametrize("lost", ["reset", "power_cycle"])
def test_a_module_that_restarts_between_two_shows_is_noticed_within_a_second(monkeypatch, lost):
    now = [0.0]
    monkeypatch.setattr("paneldraw.panel.time.perf_counter", lambda: now[0])
    transport, glass, _ = made(SSD1306)
    with Panel(SSD1306(), transport) as panel:
        wanted = picture(panel, 1)
        panel.show(wanted)
        getattr(glass, lost)()
        now[0] += 1.1
        panel.show(wanted)
        np.testing.assert_array_equal(glass.pixels, wanted)


@pytest.mark.parametrize("chip", [SSD1306, SH1106], ids=["ssd1306", "sh1106"])
def test_two_masters_a_panel_that_assumes_nothing_is_whole(chip):
    transport, glass, _ = made(chip)
    with Panel(chip(), transport, updates="plain") as panel:
        wanted = picture(panel, 1)
        for seed in range(20):
            wanted[seed : seed + 9, 3 * seed : 3 * seed + 30] ^= 1
            panel.show(wanted)
            np.testing.assert_array_equal(glass.pixels, wanted)
            if chip is SSD1306:
                other_master(glass)
            else:
                glass.write(b"\x00\xb3\x05\x12")


def test_two_masters_a_panel_that_saves_bytes_is_whole_when_it_is_told():
    transport, glass, _ = made(SSD1306)
    with Panel(SSD1306(), transport) as panel:
        wanted = picture(panel, 1)
        for seed in range(20):
            wanted[seed : seed + 9, 3 * seed : 3 * seed + 30] ^= 1
            panel.show(wanted)
            np.testing.assert_array_equal(glass.pixels, wanted)
            other_master(glass)
            panel.invalidate()


@pytest.mark.parametrize(
    ("hours", "cut_every", "seed"),
    [(0.05, 30, 7), *(pytest.param(1, 3600, seed, marks=pytest.mark.thorough) for seed in (8, 9, 10))],
)
def test_a_time_on_a_bad_wire(hours, cut_every, seed):
    """No picture is wrong, a power cut leaves the panel dark for a second at most, and nothing grows."""
    outcome = bad_wire.run(hours, seed=seed, cut_every=cut_every)
    assert sum(outcome.faults.values()) > 1900 * hours
    assert len(outcome.faults) == len(bad_wire.CODES) - 1  # a transfer that ends early is an EIO too
    assert outcome.cuts == round(hours * 3600 / cut_every)
    assert (outcome.wrong, outcome.errors) == (0, 0)
    assert outcome.longest_dark < 1.2, "a second until it is asked, and what the start and the picture take"
    assert outcome.grown < 1000


def counted():
    """Descriptors, threads and blocks of Python's memory in use."""
    gc.collect()
    descriptors = "/proc/self/fd"
    open_ones = len(os.listdir(descriptors)) if os.path.isdir(descriptors) else 0
    return open_ones, threading.active_count(), sys.getallocatedblocks()


def stays(count, times):
    """Do something so many times, and see that nothing grows with it."""
    before = None
    for number in range(times):
        count(number)
        if number == times // 10:
            before = counted()
    after = counted()
    assert after[:2] == before[:2]
    assert after[2] - before[2] < 1000


@pytest.mark.parametrize("wait", [True, False])
@pytest.mark.parametrize("times", [2_000, pytest.param(200_000, marks=pytest.mark.thorough)])
def test_nothing_grows_with_shows(times, wait):
    transport, glass, _ = made(SSD1306)
    frame = np.zeros((64, 128), np.uint8)
    with Panel(SSD1306(), transport) as panel:

        def show(number):
            frame[number % 64, number * 7 % 128] ^= 1
            panel.show(frame, wait=wait)
            if number % 1000 == 0:
                panel.flush()
                np.testing.assert_array_equal(glass.pixels, frame)

        stays(show, times)


@pytest.mark.parametrize("times", [200, pytest.param(10_000, marks=pytest.mark.thorough)])
def test_nothing_is_left_behind_by_opening_and_failing_to_open(times, tmp_path):
    no_bus = tmp_path / "file"
    no_bus.touch()

    def opened(number):
        transport, _, bus = made(SSD1306)
        if number % 3 == 0:
            with Panel(SSD1306(), transport, on_close="clear") as panel:
                panel.clear()
        elif number % 3 == 1:
            bus.devices.clear()
            with pytest.raises(PanelError):
                Panel(SSD1306(), transport)
        else:  # a file of the system's, which takes a descriptor to be known for no bus
            with pytest.raises(PanelError):
                Panel(SSD1306(), str(no_bus))

    stays(opened, times)
