"""LED chips: what goes out, how walls and boards are wired, and what cannot be."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from paneldraw import Framebuffer, Panel, open_panel, simulator
from paneldraw.controllers import CHIPS, HT16K33, IS31FL3731, MAX7219, Contrast
from paneldraw.transports import I2CTransport, SPITransport


class Wire:
    """An SPI bus or an I2C bus that notes what it is asked to send, and hands it on to a simulated chip."""

    def __init__(self, chip=None):
        self.sent = []
        self.chip = chip

    def writebytes2(self, payload):
        self.sent.append(bytes(payload))
        if self.chip is not None:
            self.chip.transfer(bytes(payload), False)
            self.chip.deselect()

    def i2c_rdwr(self, *messages):
        for message in messages:
            self.sent.append(bytes(message))
            if self.chip is not None:
                self.chip.write(bytes(message))

    def since(self):
        """What was sent since the last call, in hex."""
        sent, self.sent = self.sent, []
        return [message.hex(" ").upper() for message in sent]


def on_spi(controller, chip=None, **settings):
    wire = Wire(chip)
    return Panel(controller, SPITransport(spi=wire, dc=None, reset=None), **settings), wire


def on_i2c(controller, chip=None, **settings):
    wire = Wire(chip)
    return Panel(controller, I2CTransport(wire, 0x70), **settings), wire


def picture(controller, seed=1):
    shape = controller.height, controller.width
    return np.random.default_rng(seed).integers(0, 2**controller.depth, shape, np.uint8)


# -- What goes out


def test_a_max7219_is_told():
    panel, wire = on_spi(MAX7219(8, 8))
    assert wire.since() == ["0F 00", "0C 00", "09 00", "0A 0A", "0B 07"]
    panel.show(np.eye(8, dtype=np.uint8))
    assert wire.since() == [f"0{row} {0x80 >> row - 1:02X}" for row in range(1, 9)] + ["0C 01"]
    panel.contrast(255)
    panel.contrast(0)
    panel.sleep()
    panel.wake()
    assert wire.since() == ["0A 0F", "0A 00", "0C 00", "0C 01"]


def test_every_chip_of_a_row_is_told_in_one_select():
    panel, wire = on_spi(MAX7219(24, 8), contrast=136)
    assert wire.since() == [" ".join([text] * 3) for text in ("0F 00", "0C 00", "09 00", "0A 0A", "0B 07", "0A 08")]
    fb = panel.framebuffer()
    panel.show(fb)
    wire.since()
    fb.hline(0, 2, 3, 1)  # the left block, at the far end: what goes out first
    panel.show(fb)
    assert wire.since() == ["03 E0 00 00 00 00"]
    fb.pixel(23, 2, 1)
    fb.pixel(8, 7, 1)
    panel.show(fb)  # different registers of different chips go together
    assert wire.since() == ["00 00 08 80 03 01"]


def test_one_pixel_of_a_row_of_eight_is_a_select_of_16_bytes():
    panel, wire = on_spi(MAX7219(64, 8))
    fb = panel.framebuffer()
    panel.show(fb)
    wire.since()
    fb.pixel(20, 3, 1)
    report = panel.show(fb)
    assert (report.messages, report.wire_bytes, report.changed_bytes) == (1, 16, 1)
    assert wire.since() == ["00 00 00 00 04 08" + 5 * " 00 00"]


def test_an_ht16k33_is_told():
    panel, wire = on_i2c(HT16K33())
    assert wire.since() == ["21", "80", "A0", "EF"]
    fb = panel.framebuffer()
    fb.pixel(9, 1, 1)
    assert panel.show(fb).wire_bytes == 18 + 2
    assert wire.since() == ["00 00 00 00 02" + 12 * " 00", "81"]
    fb.pixel(9, 2, 1)
    fb.pixel(9, 7, 1)
    assert panel.show(fb).wire_bytes == 6
    assert wire.since() == ["05 02", "0F 02"]
    panel.contrast(34)
    panel.sleep()
    panel.wake()
    panel.command(b"\x85")  # blink once a second
    assert wire.since() == ["E2", "80", "81", "85"]


def test_an_is31fl3731_is_told():
    panel, wire = on_i2c(IS31FL3731())
    functions = ["FD 0B", "0A 00", "00 00", "01 00", "05 00", "06 00", "09 00", "FD 00"]
    assert wire.since() == functions + [f"{register:02X} FF" for register in range(0x12)]
    fb = panel.framebuffer()
    fb.pixel(1, 0, 255)
    panel.show(fb)
    assert wire.since() == ["24 00 FF" + 142 * " 00", "FD 0B", "0A 01", "FD 00"]
    fb.pixel(4, 0, 7)
    fb.pixel(7, 0, 8)
    fb.pixel(11, 0, 9)
    assert panel.show(fb).wire_bytes == 6 + 3
    assert wire.since() == ["28 07 00 00 08", "2F 09"]
    panel.sleep()
    assert wire.since() == ["FD 0B", "0A 00", "FD 00"]


@pytest.mark.parametrize("max_message", [2, 3, 5, 17, 8192])
@pytest.mark.parametrize("name", ["ht16k33", "is31fl3731"])
def test_adapters_that_take_short_messages_only(name, max_message):
    controller, chip = CHIPS[name](), getattr(simulator, name.upper())()
    wire = Wire(chip)
    panel = Panel(controller, I2CTransport(wire, 0x70, max_message=max_message))
    for seed in range(3):
        report = panel.show(picture(controller, seed))
        np.testing.assert_array_equal(chip.pixels, picture(controller, seed))
        assert max(map(len, wire.sent)) <= max_message
        wire.since()
    assert report.wire_bytes == controller.registers.size + 2 * report.messages
    assert chip.violations == []


@pytest.mark.parametrize("name", ["ht16k33", "is31fl3731"])
def test_a_bus_alone_stands_for_the_usual_address(name):
    chip = getattr(simulator, name.upper())()
    panel = Panel(name, simulator.I2CBus({CHIPS[name].address: chip}))
    panel.show(picture(panel.controller))
    np.testing.assert_array_equal(chip.pixels, picture(panel.controller))


def test_commands_of_another_length_are_refused():
    panel, wire = on_spi(MAX7219(16, 8))
    wire.since()
    with pytest.raises(ValueError, match="command must be of 2 bytes, or several of them, not 0F"):
        panel.command(b"\x0f", keep=True)
    panel.command(b"\x0f\x01\x0f\x00")
    assert wire.since() == ["0F 01 0F 01", "0F 00 0F 00"]


# -- Settings


SETTINGS = [("sim://max7219?size=24x16", 15), ("sim://ht16k33", 15), ("sim://ht16k33?size=8x8", 15)]


@pytest.mark.parametrize(("url", "steps"), SETTINGS)
def test_contrast_inversion_and_sleep_of_one_bit(url, steps):
    panel = open_panel(f"{url}&contrast=51" if "?" in url else f"{url}?contrast=51")
    chip = panel.simulated
    assert chip.contrast == round(51 / 255 * steps)
    panel.invert()
    shown = picture(panel.controller)
    panel.show(shown)
    np.testing.assert_array_equal(chip.pixels, 1 - shown)
    panel.invert(False)
    np.testing.assert_array_equal(chip.pixels, shown)
    assert panel.show(shown).unchanged
    panel.sleep()
    panel.show(1 - shown)
    assert not chip.pixels.any()
    panel.invert()
    panel.wake()
    np.testing.assert_array_equal(chip.pixels, shown)
    panel.contrast(255)
    assert chip.contrast == steps
    chip.power_cycle()
    panel.show(shown, force=True)
    np.testing.assert_array_equal(chip.pixels, 1 - shown)
    assert chip.contrast == steps


@pytest.mark.parametrize("size", IS31FL3731.sizes)
def test_greys_are_inverted_and_dimmed_as_they_are_sent(size):
    panel = open_panel(f"sim://is31fl3731?size={size[0]}x{size[1]}&contrast=51")
    chip, shown = panel.simulated, picture(panel.controller)
    panel.show(shown)
    np.testing.assert_array_equal(chip.pixels, np.rint(shown / 5))
    panel.contrast(255)
    np.testing.assert_array_equal(chip.pixels, shown)
    panel.invert()
    np.testing.assert_array_equal(chip.pixels, 255 - shown)
    panel.dim(0)
    assert not chip.pixels.any()
    panel.invert(False)
    panel.contrast(255)
    np.testing.assert_array_equal(chip.pixels, shown)
    assert (chip.violations, chip.remarks) == ([], [])


@pytest.mark.parametrize("depth", [1, 2, 4, 8])
def test_framebuffers_of_every_depth(depth):
    panel = open_panel("sim://is31fl3731")
    fb = Framebuffer(16, 9, depth)
    fb.pixels[:] = np.arange(144).reshape(9, 16) % (fb.max_level + 1)
    panel.show(fb)
    np.testing.assert_array_equal(panel.simulated.pixels, fb.pixels * (255 // fb.max_level))
    assert panel.framebuffer().depth == 8


@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
@pytest.mark.parametrize("url", ["sim://max7219?size=24x16", "sim://ht16k33?size=16x8", "sim://is31fl3731?size=15x7"])
def test_every_turn(url, rotate):
    with open_panel(f"{url}&rotate={rotate}") as panel:
        shown = picture(panel.controller)
        panel.show(np.rot90(shown, rotate // 90).copy())
        np.testing.assert_array_equal(panel.simulated.pixels, shown)


@pytest.mark.parametrize("updates", ["least", "plain", "whole"])
@pytest.mark.parametrize("url", ["sim://max7219?size=64x16", "sim://ht16k33?size=8x8", "sim://is31fl3731?size=17x7"])
def test_whatever_is_assumed_of_the_chip_pictures_arrive(url, updates):
    panel = open_panel(f"{url}&updates={updates}")
    shown = picture(panel.controller)
    whole = panel.show(shown).wire_bytes
    for y, x in np.random.default_rng(2).integers(0, shown.shape, (30, 2)):
        shown[y, x] ^= 1
        report = panel.show(shown)
        np.testing.assert_array_equal(panel.simulated.pixels, shown)
        assert report.changed_bytes == 1
        assert report.wire_bytes <= (whole if updates == "whole" else 32)
    assert panel.simulated.violations == []


# -- Wirings


WIRINGS = st.fixed_dictionaries(
    {
        "order": st.sampled_from(["rows", "columns", "serpentine"]),
        "first_block": st.sampled_from(["top-left", "top-right", "bottom-left", "bottom-right"]),
        "mirror_blocks": st.booleans(),
        "mirror_x": st.booleans(),
        "mirror_y": st.booleans(),
    }
)


@given(WIRINGS, st.integers(1, 4), st.integers(1, 4), st.data())
def test_walls_of_any_size_and_wiring(wiring, wide, high, data):
    turn = st.sampled_from([0, 90, 180, 270])
    wiring["block_rotation"] = data.draw(turn | st.lists(turn, min_size=wide * high, max_size=wide * high))
    if data.draw(st.booleans()):
        del wiring["first_block"]
        blocks = [(column, row) for column in range(wide) for row in range(high)]
        wiring["order"] = data.draw(st.permutations(blocks))
    chip = simulator.MAX7219(8 * wide, 8 * high, **wiring)
    panel, _ = on_spi(MAX7219(8 * wide, 8 * high, **wiring), chip)
    for seed in range(2):
        panel.show(picture(panel.controller, seed))
        np.testing.assert_array_equal(chip.pixels, picture(panel.controller, seed))
    assert (chip.violations, chip.remarks) == ([], [])


def test_texts_say_what_sequences_say():
    by_text = MAX7219(16, 16, order="0.0,0.1,1.1,1.0", block_rotation="0,90,180,270")
    assert by_text == MAX7219(16, 16, order=[(0, 0), (0, 1), (1, 1), (1, 0)], block_rotation=[0, 90, 180, 270])
    assert MAX7219(16, 8, block_rotation="90") == MAX7219(16, 8, block_rotation=90) != MAX7219(16, 8)
    assert len({by_text, MAX7219(16, 16)}) == 2


@pytest.mark.parametrize(
    ("wiring", "complaint"),
    [
        ({"width": 33}, "size of the MAX7219 must be in blocks of 8x8, such as 32x8, not 33x8"),
        ({"height": 0}, "must be in blocks of 8x8"),
        ({"order": "zigzag"}, "order must be 'rows', 'columns' or 'serpentine', or the column and row of each block"),
        ({"order": [(0, 0), (1, 0), (1, 0), (3, 0)]}, r"once: \(2, 0\) is missing, \(1, 0\) is there twice$"),
        ({"order": "0.0,1.0,2.0"}, r"order must name each of 4x1 blocks \(column, row\) once: \(3, 0\) is missing$"),
        ({"order": "0.0,1.0,2.0,3.0,0.1"}, r"\(0, 1\) is outside"),
        ({"order": [0, 1, 2, 3]}, "the column and row of each block"),
        ({"order": "0.0,1.0,2.0,3.0", "first_block": "top-left"}, "first_block must not be given"),
        ({"first_block": "left"}, "first_block must be top-left, top-right, bottom-left or bottom-right, not 'left'"),
        ({"block_rotation": 45}, "block_rotation must be 0, 90, 180 or 270, one or 4 of them, not 45"),
        ({"block_rotation": [0, 90]}, "one or 4 of them"),
        ({"block_rotation": "right"}, "one or 4 of them"),
    ],
)
def test_wirings_that_cannot_be(wiring, complaint):
    with pytest.raises(ValueError, match=complaint):
        MAX7219(**wiring)


@pytest.mark.parametrize(
    ("make", "settings", "complaint"),
    [
        (HT16K33, {"width": 8, "height": 16}, "size of the HT16K33 must be 16x8 or 8x8, not 8x16"),
        (HT16K33, {"board": "wing"}, "board must be backpack or featherwing for 16x8, not 'wing'"),
        (HT16K33, {"width": 8, "board": "featherwing"}, "board must be backpack for 8x8"),
        (IS31FL3731, {"width": 12}, "size of the IS31FL3731 must be 16x9, 15x7, 16x8, 17x7 or 11x7, not 12x9"),
    ],
)
def test_boards_that_there_are_not(make, settings, complaint):
    with pytest.raises(ValueError, match=complaint):
        make(**settings)


def test_a_chip_on_what_cannot_carry_it():
    with pytest.raises(ValueError, match="controller must be one that I2C reaches: the max7219 is on SPI"):
        Panel(MAX7219(), I2CTransport(Wire()))
    with pytest.raises(ValueError, match="controller must be one that SPI reaches: the ht16k33 is on I2C"):
        on_spi(HT16K33())
    with pytest.raises(ValueError, match="at most 2048 chips, as the transport carries 4096 bytes"):
        on_spi(MAX7219(2048 * 8, 16))


class Board:
    """A transport that reaches an I2C bus, as a serial one does, and puts control bytes before what it sends."""

    wire = "i2c"

    def close(self):
        """Close nothing."""

    command = data = batch = close


def test_control_bytes_are_not_for_these_chips():
    with pytest.raises(ValueError, match="transport must send no control bytes to the ht16k33"):
        Panel(HT16K33(), Board())


@pytest.mark.parametrize(
    ("changes", "complaint"),
    [
        ({"registers": None}, "pointer, window and registers must not all be None"),
        ({"packing": "pages"}, "registers must be given for a packing of bits or bytes alone, not 'pages'"),
        ({"width": 15}, "a place of its own for each of 15x8 pixels"),
        ({"contrast": Contrast(command=b""), "inverse": b"\xa7"}, "contrast must have a command where inverse has one"),
    ],
)
def test_records_that_cannot_be(changes, complaint):
    with pytest.raises(ValueError, match=complaint):
        replace(HT16K33(), **changes)
