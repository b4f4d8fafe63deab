"""A fault at every message of plans: an error of ours, nothing believed of the panel, the next show whole and right."""

from __future__ import annotations

import errno
from dataclasses import replace
from functools import partial

import numpy as np
import pytest

from paneldraw import Panel, simulator
from paneldraw.controllers import CHIPS, MAX7219
from paneldraw.errors import PanelDisconnectedError, PanelError, PanelTimeoutError
from paneldraw.transports import I2CTransport, SPITransport

pytestmark = pytest.mark.usefixtures("own_time")

ON_I2C = [name for name, make in CHIPS.items() if "i2c" in make.buses]
#: One chip of each way of addressing always; those that are like them, in the thorough tests.
FIRST = ("ssd1306", "sh1106", "ssd1327", "ht16k33")
FAULTY = [name if name in FIRST else pytest.param(name, marks=pytest.mark.thorough) for name in ON_I2C]


class Bus:
    """A simulated bus that returns how many messages went through, as the kernel does."""

    def __init__(self, chip, address=0x3C):
        self.chip = chip
        self.bus = simulator.I2CBus({address: chip}, timer=None)
        self.stop_after = None

    def i2c_rdwr(self, *messages):
        done = len(messages)
        if self.stop_after is not None:
            if self.stop_after < done:
                done, self.stop_after = self.stop_after, None
            else:
                self.stop_after -= done
        if done:
            self.bus.i2c_rdwr(*messages[:done])
        return done


def pictures(controller):
    """Three pictures: from the first to the second by many windows or jumps, to the third by everything."""
    random = np.random.default_rng(5)
    shape = controller.height, controller.width
    first = random.integers(0, 2**controller.depth, shape, np.uint8)
    second = first.copy()
    second[0, 0] ^= 1
    second[-1, -1] ^= 1
    for _ in range(12 if first.size > 1000 else 0):
        y, x = random.integers(0, shape[0] - 6), random.integers(0, shape[1] - 6)
        second[y : y + random.integers(1, 6), x : x + random.integers(1, 6)] ^= 1
    return first, second, random.integers(0, 2**controller.depth, shape, np.uint8)


def shown(name):
    """A panel that shows the first picture, its chip and its bus."""
    controller = CHIPS[name]()
    controller = replace(controller, init=tuple(entry for entry in controller.init if isinstance(entry, bytes)))
    chip = getattr(simulator, name.upper())(history=1)
    bus = Bus(chip, CHIPS[name].address)
    panel = Panel(controller, I2CTransport(bus, CHIPS[name].address))
    if controller.contrast.command:
        panel.contrast(34)
    panel.show(pictures(controller)[0])
    return panel, chip, bus


def nack(bus, message):
    bus.bus.fail(errno.EREMOTEIO, after=message, times=None)
    return PanelDisconnectedError


def nack_within(bus, message):
    bus.bus.fail(errno.EREMOTEIO, after=message, at_byte=2, times=None)
    return PanelDisconnectedError


def timeout(bus, message):
    bus.bus.fail(errno.ETIMEDOUT, after=message, at_byte=3, times=None)
    return PanelTimeoutError


def power_cut(bus, message):
    bus.bus.fail(errno.EREMOTEIO, after=message, at_byte=1, then=bus.chip.power_cycle)


def short_write(bus, message):
    bus.stop_after = message


@pytest.mark.parametrize("name", FAULTY)
@pytest.mark.parametrize("fault", [nack, nack_within, timeout, power_cut, short_write])
def test_after_a_fault_at_any_message_the_next_show_is_whole_and_right(name, fault):
    panel, _, _ = shown(name)
    second, third = pictures(panel.controller)[1:]
    counts = [panel.show(picture).messages for picture in (second, third)]
    assert counts[0] > (1 if panel.controller.registers else 6)
    everything = panel.width * panel.height * panel.depth // 8
    for number in range(sum(counts)):
        panel, chip, bus = shown(name)
        kind = fault(bus, number)
        errors = []
        for picture in (second, third):
            try:
                panel.show(picture)
            except PanelError as error:
                errors.append(error)
                bus.bus.clear_faults()
                assert panel.show(picture).changed_bytes == everything
            np.testing.assert_array_equal(chip.pixels, picture)
        if kind is None:  # what passes is healed in the show itself
            assert errors == []
            assert panel.stats.retries == 1
        else:
            assert [(isinstance(error, kind), isinstance(error, OSError)) for error in errors] == [(True, True)]
        if panel.controller.contrast.command:
            assert chip.contrast == round(34 * panel.controller.contrast.highest / 255)


@pytest.mark.parametrize("name", ON_I2C)
def test_a_plan_is_one_call_for_every_42_messages(name):
    panel, _, bus = shown(name)
    for picture in pictures(panel.controller)[1:]:
        calls = bus.bus.transactions
        report = panel.show(picture)
        assert bus.bus.transactions - calls == -(-report.messages // 42)


def spoil(chip, sent):
    """Let a row of chips obey what a select that broke off left in it."""
    chip.transfer(sent, False)
    chip.deselect()


@pytest.mark.parametrize("at_byte", [0, 1, 3, 8])
def test_a_row_of_chips_heals_from_what_half_a_message_did_to_it(at_byte):
    """A select that breaks off leaves rubbish in registers: test mode, decoding, fewer digits."""
    for number in range(9):
        chip = simulator.MAX7219(32, 8, history=1)
        bus = simulator.SPIBus(chip, dc=None, reset=None, timer=None)
        panel = Panel(MAX7219(32, 8), SPITransport(spi=bus.spi, dc=None, reset=None), contrast=34)
        first, second, third = pictures(panel.controller)
        panel.show(first)
        broken = bytes.fromhex("0F 09 0B 0A 09 FF 0C 00")[:at_byte]
        bus.fail(errno.EIO, after=number, at_byte=at_byte, then=partial(spoil, chip, broken))
        for picture in (second, third):
            panel.show(picture)
            np.testing.assert_array_equal(chip.pixels, picture)
        assert (panel.stats.retries, chip.contrast) == (1, 2)
