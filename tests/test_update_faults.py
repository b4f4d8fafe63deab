"""A fault at every message of plans: an error of ours, nothing believed of the panel, the next show whole and right."""

from __future__ import annotations

import errno
from dataclasses import replace

import numpy as np
import pytest

from paneldraw import Panel, simulator
from paneldraw.controllers import CHIPS
from paneldraw.errors import PanelDisconnectedError, PanelError, PanelTimeoutError
from paneldraw.transports import I2CTransport

ON_I2C = [name for name, make in CHIPS.items() if "i2c" in make.buses]


class Bus:
    """A simulated bus that returns how many messages went through, as the kernel does."""

    def __init__(self, chip):
        self.bus = simulator.I2CBus({0x3C: chip}, timer=None)
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
    for _ in range(12):
        y, x = random.integers(0, shape[0] - 6), random.integers(0, shape[1] - 6)
        second[y : y + random.integers(1, 6), x : x + random.integers(1, 6)] ^= 1
    return first, second, random.integers(0, 2**controller.depth, shape, np.uint8)


def shown(name):
    """A panel that shows the first picture, its chip and its bus."""
    controller = CHIPS[name]()
    controller = replace(controller, init=tuple(entry for entry in controller.init if isinstance(entry, bytes)))
    chip = getattr(simulator, name.upper())(history=1)
    bus = Bus(chip)
    panel = Panel(controller, I2CTransport(bus))
    panel.contrast(33)
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
    bus.bus.fail(errno.EREMOTEIO, after=message, at_byte=1, then=bus.bus.devices[0x3C].power_cycle)


def short_write(bus, message):
    bus.stop_after = message


@pytest.mark.parametrize("name", ON_I2C)
@pytest.mark.parametrize("fault", [nack, nack_within, timeout, power_cut, short_write])
def test_after_a_fault_at_any_message_the_next_show_is_whole_and_right(name, fault):
    panel, _, _ = shown(name)
    second, third = pictures(panel.controller)[1:]
    counts = [panel.show(picture).messages for picture in (second, third)]
    assert counts[0] > 6
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
        assert chip.contrast == round(33 * panel.controller.contrast.highest / 255)


@pytest.mark.parametrize("name", ON_I2C)
def test_a_plan_is_one_call_for_every_42_messages(name):
    panel, _, bus = shown(name)
    for picture in pictures(panel.controller)[1:]:
        calls = bus.bus.transactions
        report = panel.show(picture)
        assert bus.bus.transactions - calls == -(-report.messages // 42)
