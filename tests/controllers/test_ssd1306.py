from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from paneldraw import Panel, simulator
from paneldraw.controllers import SSD1306, SSD1327
from paneldraw.transports import I2CTransport

MODULES = {
    # size: first column, multiplex, COM pins
    (128, 64): (0, 0x3F, 0x12),
    (128, 32): (0, 0x1F, 0x02),
    (96, 16): (0, 0x0F, 0x02),
    (96, 39): (32, 0x26, 0x12),
    (96, 40): (0, 0x27, 0x02),
    (72, 40): (28, 0x27, 0x12),
    (64, 48): (32, 0x2F, 0x12),
    (64, 32): (32, 0x1F, 0x12),
    (48, 64): (40, 0x3F, 0x12),
}


def initialized(controller):
    chip = simulator.SSD1306(controller.width, controller.height)
    chip.write(b"\x00" + controller.resync + b"".join(controller.init))
    return chip


@pytest.mark.parametrize("size", MODULES)
def test_init_sets_what_a_module_of_this_size_needs(size):
    controller = SSD1306(*size)
    chip = initialized(controller)
    registers = chip.registers
    assert (controller.column_offset, registers.multiplex, registers.com_pins & 0x32) == MODULES[size]
    assert (registers.start_line, registers.offset) == (0, 0)
    assert registers.segment_remap
    assert registers.com_reversed
    assert registers.charge_pump & 0x04
    assert (registers.on, registers.inverted, registers.all_on) == (False, False, False)
    assert chip.violations == []


@pytest.mark.parametrize("size", MODULES)
@pytest.mark.parametrize("mirror", [(True, False), (False, True), (True, True)])
def test_mirrored_glass(size, mirror):
    chip = simulator.SSD1306(*size)
    panel = Panel(SSD1306(*size, mirror_x=mirror[0], mirror_y=mirror[1]), I2CTransport(simulator.I2CBus({0x3C: chip})))
    picture = np.random.default_rng(1).integers(0, 2, size[::-1], np.uint8)
    panel.show(picture)
    seen = chip.pixels[:, ::-1] if mirror[0] else chip.pixels
    np.testing.assert_array_equal(seen[::-1] if mirror[1] else seen, picture)


def test_a_size_that_no_module_has_names_those_that_are():
    sizes = "128x64, 128x32, 96x16, 96x39, 96x40, 72x40, 64x48, 64x32 or 48x64"
    with pytest.raises(ValueError, match=f"{sizes}, not 100x50; for another one give column_offset= and com_pins= too"):
        SSD1306(100, 50)
    with pytest.raises(ValueError, match="com_pins="):
        SSD1306(100, 50, column_offset=14)
    with pytest.raises(ValueError, match="1x1 to 128x64, which its RAM holds, not 64x128"):
        SSD1306(64, 128)


@pytest.mark.parametrize("updates", ["least", "plain", "whole"])
@pytest.mark.parametrize("size", [(100, 50), (1, 1), (37, 9), (128, 39)])
def test_any_size_that_the_ram_holds(size, updates):
    wiring = {"column_offset": min(14, 128 - size[0]), "com_pins": 0x12}
    chip = simulator.SSD1306(*size, **wiring)
    panel = Panel(SSD1306(*size, **wiring), I2CTransport(simulator.I2CBus({0x3C: chip})), updates=updates)
    random = np.random.default_rng(3)
    for _ in range(4):
        picture = random.integers(0, 2, size[::-1], np.uint8)
        panel.show(picture)
        np.testing.assert_array_equal(chip.pixels, picture)


def test_the_first_com_line_is_brought_to_the_first_row():
    assert b"\xd3\x10" in SSD1306(64, 32, first_com=16).init
    assert b"\xd3\x30" in SSD1306(64, 32, first_com=16, mirror_y=True).init
    with pytest.raises(ValueError, match="first_com must be 0 to 63, not 64"):
        SSD1306(first_com=64)


def test_an_override_that_the_chip_has_not_names_those_that_it_has():
    with pytest.raises(ValueError, match="com_pins must not be given for the SSD1327, which has column_offset, first"):
        SSD1327(com_pins=0x12)


@pytest.mark.parametrize(
    ("override", "complaint"),
    [({"column_offset": 65}, "column_offset"), ({"column_offset": -1}, "column_offset"), ({"com_pins": 3}, "com_pins")],
)
def test_overrides_out_of_range(override, complaint):
    with pytest.raises(ValueError, match=complaint):
        SSD1306(64, 48, **override)


def test_a_misspelled_override_is_an_error():
    with pytest.raises(TypeError, match="colum_offset"):
        SSD1306(64, 48, colum_offset=0)


def test_external_supply_leaves_the_pump_off():
    chip = initialized(SSD1306(charge_pump=False))
    assert not chip.registers.charge_pump & 0x04


def test_internal_reference_is_one_command_more():
    assert b"\xad\x30" in SSD1306(internal_reference=True).init
    assert b"\xad\x30" not in SSD1306().init
    assert b"\xad\x30" in SSD1306(72, 40).init


def test_records_are_immutable_and_hashable():
    controller = SSD1306()
    with pytest.raises(dataclasses.FrozenInstanceError):
        controller.width = 64  # type: ignore[misc]
    assert hash(controller) == hash(SSD1306())


@pytest.mark.parametrize(
    "change",
    [
        {"width": 0},
        {"row_offset": 4},
        {"buses": ("parallel",)},
        {"row_offset": 8},
        {"packing": "diagonals"},
        {"pointer": None, "window": None},
        {"packing": "nibbles", "width": 127},
    ],
)
def test_a_record_that_cannot_be_is_refused(change):
    with pytest.raises(ValueError, match=list(change)[-1] if "packing" not in change else "pointer|width|packing"):
        dataclasses.replace(SSD1306(), **change)
