"""The CH1115: its page pointer, its own commands, and look-alikes with more columns."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import simulator

from .helpers import commands, pack, random_picture


@pytest.mark.parametrize("offset", [0, 2])
def test_a_picture_begins_where_the_module_does(offset: int) -> None:
    chip, picture = simulator.CH1115(column_offset=offset), random_picture(128, 64, 1)
    commands(chip, "AD 8B A1 C8 AF")
    for page, row in enumerate(pack(picture)):
        commands(chip, f"{0xB0 + page:02X} {offset:02X} 10")
        chip.write(b"\x40" + row.tobytes())
    assert np.array_equal(chip.pixels, picture)
    commands(chip, "A7")
    assert np.array_equal(chip.pixels, 1 - picture)
    assert (chip.violations, chip.remarks) == ([], [])


@pytest.mark.parametrize(
    "sent", ["23 81", "24 00 7F", "26 00 00 07", "27 07 07 00", "28", "2E", "2F", "32", "82 04", "A2", "A3", "DB 40"]
)
def test_its_own_commands_take_their_arguments(sent: str) -> None:
    chip = simulator.CH1115()
    commands(chip, f"{sent} 81 2A")
    assert chip.contrast == 0x2A
    assert (chip.violations, chip.remarks) == ([], [])


@pytest.mark.parametrize("sent", ["DA 12", "8D 14", "20 02", "82 08", "AD 30", "D9 20"])
def test_what_relatives_drivers_send_is_let_pass(sent: str) -> None:
    chip = simulator.CH1115()
    commands(chip, f"{sent} 81 2A")
    assert (chip.contrast, len(chip.remarks), chip.violations) == (0x2A, 1, [])


@pytest.mark.parametrize("sent", ["21 00 7F", "A8 40", "18"])
def test_what_endangers_the_picture(sent: str) -> None:
    chip = simulator.CH1115()
    commands(chip, sent)
    assert len(chip.violations) == 1


def test_without_converter_it_is_dark() -> None:
    for chip in (simulator.CH1115(), simulator.CH1115(external_vcc=True)):
        commands(chip, "AD 8A A5 AF")
        assert chip.pixels.all() == chip.external_vcc
