"""Faults in every call of a panel, and long runs on a bad wire: whatever happens, the next show is whole."""

from __future__ import annotations

import errno
import gc
import os
import tracemalloc

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


def picture(panel, seed):
    return np.random.default_rng(seed).integers(0, 2**panel.depth, (panel.height, panel.width), np.uint8)


def turn(panel):
    panel.rotate = 180
    panel.show(picture(panel, 5))


CALLS = {
    "show": lambda panel: panel.show(picture(panel, 2)),
    "contrast": lambda panel: panel.contrast(40),
    "invert": lambda panel: panel.invert(),
    "rotate": turn,
    "sleep": lambda panel: panel.sleep(),
    "wake": lambda panel: panel.wake(),
}


@pytest.mark.parametrize("code", FAULTS)
@pytest.mark.parametrize("times", [1, 3, None])
@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("chip", [SSD1306, SH1106, SSD1327, CHAIN], ids=["ssd1306", "sh1106", "ssd1327", "chain"])
def test_after_any_fault_in_any_call_the_next_show_is_whole(chip, call, times, code):
    if chip is CHAIN and code in (errno.EREMOTEIO, errno.ENXIO, errno.ETIME):
        code = errno.EIO  # nobody acknowledges anything on SPI
    for position in range(0, 12, 3):
        transport, glass, bus = made(chip)
        panel = Panel(chip if chip is CHAIN else chip(), transport)
        panel.show(picture(panel, 1))
        bus.fail(code, after=position, times=times)
        failed = None
        try:
            CALLS[call](panel)
        except PanelError as error:
            failed = error
        if failed is not None:
            assert failed.errno == code
            assert ": " in str(failed), "say what to do next"
            assert times is None
        bus.clear_faults()
        panel.wake()
        panel.show(picture(panel, 3))
        seen = glass.pixels if panel.rotate == 0 else glass.pixels[::-1, ::-1]
        highest = 2**panel.depth - 1
        wanted = highest - picture(panel, 3) if call == "invert" else picture(panel, 3)
        np.testing.assert_array_equal(seen, wanted)


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
    panel.close()


@pytest.mark.thorough
def test_an_hour_on_a_bad_wire(monkeypatch):
    """30 frames a second, 1 % of messages fail in all ways, the supply is cut every two minutes.

    No picture may be wrong, the panel dark for a second a cut at most, and nothing may grow.
    """
    now = [0.0]
    monkeypatch.setattr("paneldraw.panel.time.perf_counter", lambda: now[0])
    monkeypatch.setattr("paneldraw.panel.time.sleep", lambda seconds: None)
    random = np.random.default_rng(7)
    transport, glass, bus = made(SSD1306)
    panel = Panel(SSD1306(), transport)
    frame = np.zeros((64, 128), np.uint8)
    wrong = dark = cuts = errors = 0
    grown = []
    gc.collect()
    tracemalloc.start()
    for number in range(3600 * 30):
        now[0] += 1 / 30
        if number % 3600 == 1800:
            glass.power_cycle()
            cuts += 1
        if random.random() < 0.02:
            reach = None if random.random() < 0.5 else int(random.integers(0, 6))
            bus.fail(int(random.choice(CODES)), after=int(random.integers(0, 3)), at_byte=reach)
        y, x = random.integers(0, 64), random.integers(0, 120)
        frame[y, x : x + 8] ^= 1
        try:
            panel.show(frame)
        except PanelError:
            errors += 1
        else:
            if not glass.registers.on:
                dark += 1
            elif not np.array_equal(glass.pixels, frame):
                wrong += 1
        if number % 20000 == 19999:
            gc.collect()
            grown.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    assert panel.stats.retries > 500
    assert (wrong, errors) == (0, 0)
    assert dark <= 31 * cuts
    assert grown[-1] - grown[1] < 20_000


@pytest.mark.thorough
def test_nothing_is_left_behind_by_opening_and_failing_to_open():
    descriptors = "/proc/self/fd"

    def counted():
        gc.collect()
        return len(os.listdir(descriptors)) if os.path.isdir(descriptors) else 0

    before = counted()
    tracemalloc.start()
    sizes = []
    for number in range(10_000):
        transport, _, bus = made(SSD1306)
        if number % 2:
            bus.devices.clear()
            with pytest.raises(PanelError):
                Panel(SSD1306(), transport)
        else:
            with Panel(SSD1306(), transport) as panel:
                panel.clear()
        if number % 2500 == 2499:
            gc.collect()
            sizes.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    assert counted() == before
    assert sizes[-1] - sizes[1] < 50_000
