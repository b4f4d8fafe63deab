"""Plans for LED chips: none is cheaper, and they bring what they say."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw.controllers import HT16K33, IS31FL3731, MAX7219, SSD1306
from paneldraw.transports import COMMAND, DATA, Cost
from paneldraw.update import Planner, planner_for

I2C, SPI = Cost(2, 2, 2), Cost(0, 0)


def known(controller, cost):
    """A planner that knows a black frame."""
    plans = planner_for(controller, cost)
    plans.plan()
    plans.sent()
    return plans


def messages(plan):
    return [(kind, bytes(payload)) for kind, payload in plan]


def cheapest(changed, framing=2):
    """Bytes of the cheapest messages for a row of bytes, each of them changed or not, by trying all."""
    least = [0]
    for end in range(1, len(changed) + 1):
        begun = [least[start] + framing + end - start for start in range(end)]
        least.append(min(begun if changed[end - 1] else [*begun, least[end - 1]]))
    return least[-1]


@given(st.sets(st.integers(0, 15)))
def test_no_plan_of_registers_is_cheaper(changed):
    plans = known(HT16K33(), I2C)
    plans.fresh[list(changed)] = 0xFF
    plan = plans.plan()
    held = bytearray(16)
    for register, payload in messages(plan):
        held[register : register + len(payload)] = payload
    assert bytes(held) == plans.fresh.tobytes()
    assert plan.cost == cheapest([number in changed for number in range(16)])
    assert plan.changed == len(changed)


@given(st.sets(st.tuples(st.integers(0, 7), st.integers(0, 4))))
def test_no_plan_of_a_row_of_chips_is_cheaper(changed):
    plans = known(MAX7219(40, 8), SPI)
    frame = plans.fresh.reshape(8, 5)
    for row, chip in changed:
        frame[row, chip] = 0x81
    plan = plans.plan()
    held = np.zeros((9, 5), np.uint8)
    for _, payload in messages(plan):
        for chip, (register, byte) in enumerate(zip(payload[::2], payload[1::2], strict=True)):
            held[register, chip] = byte
    np.testing.assert_array_equal(held[1:], frame)
    assert plan.count == max((sum(chip == other for _, other in changed) for chip in range(5)), default=0)
    assert plan.cost == 10 * plan.count


def test_messages_to_a_row_of_chips_are_of_two_kinds_in_turn():
    plans = known(MAX7219(16, 8), SPI)
    plans.fresh[:] = 0xFF
    assert [kind for kind, _ in plans.plan()] == [COMMAND, DATA] * 4
    assert messages(plans.commands(b"\x0f\x00\x0c\x01", b"\x0a\x03")) == [
        (COMMAND, b"\x0f\x00\x0f\x00"),
        (DATA, b"\x0c\x01\x0c\x01"),
        (COMMAND, b"\x0a\x03\x0a\x03"),
    ]


def test_bytes_that_light_nothing_never_differ():
    plans = known(HT16K33(8, 8), I2C)
    plans.fresh[1::2] = 0x55
    assert plans.plan().count == 0
    plans.fresh[0] = plans.fresh[4] = 1
    assert messages(plans.plan()) == [(0, b"\x01"), (4, b"\x01")]


def test_what_failed_is_sent_again_and_what_is_forgotten_whole():
    plans = known(IS31FL3731(15, 7), I2C)
    plans.fresh[7] = 9
    assert messages(plans.plan()) == messages(plans.plan()) == [(0x24 + 7, b"\x09")]
    plans.forget()
    plan = plans.plan()
    assert (plan.changed, plan.count) == (105, 2)


def test_which_planner_and_which_updates_there_are():
    assert isinstance(planner_for(SSD1306(), I2C), Planner)
    with pytest.raises(ValueError, match="updates must be one of 'least', 'plain', 'whole', not 'most'"):
        planner_for(HT16K33(), I2C, "most")
