"""Rows of MAX7219s: the shift register, every register of the sheet, wires that were recorded, and luma's driver."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest
from PIL import Image

from paneldraw import simulator

from .helpers import random_picture

INIT = ("0F00", "0900", "0A04", "0B07", "0C01")
BLANK = tuple(f"{row:02X}00" for row in range(1, 9))
ONE = """
    09ff 0a04 0b07 0c01 0f01 010f 020f 030f 040f 050f 060f 070f 080f 0b 0a060b 0d0c 0f00 0104 0201 0403 0502 0700 0801
    0105 0201 0403 0502 0700 0801
"""
FOUR = """
    0f010f010f010f01 0900090009000900 0a070a070a070a07 0b070b070b070b07 0f000f000f000f00 0100010001000100
    0200020002000200 0300030003000300 0400040004000400 0500050005000500 0600060006000600 0700070007000700
    0800080008000800 0c010c010c010c01 000000000000 00000000000000000000 0e090d060e090d06 0408030402020101
    0400030002000100
"""
"""What logic analyzers saw on the wires of one chip and of four in a row, a chip select a word: the sigrok project's
example captures max7219.sr and max7219-4-in-a-row.sr, which are in the public domain. One byte, three, six and ten in a
select are errors on purpose."""


def select(chip: simulator.MAX7219, *texts: str) -> None:
    """Send bytes in hex, a chip select a text."""
    for text in texts:
        chip.transfer(bytes.fromhex(text), False)
        chip.deselect()


def started(width: int = 8, height: int = 8, **wiring: Any) -> simulator.MAX7219:
    chip = simulator.MAX7219(width, height, **wiring)
    select(chip, *(text * chip.count for text in (*INIT, *BLANK)))
    return chip


def lit(chip: simulator.MAX7219) -> list[tuple[int, int]]:
    """The columns and rows of what is lit, row by row."""
    return [(int(x), int(y)) for y, x in np.argwhere(chip.pixels)]


def test_after_power_up_it_is_in_shutdown_and_scans_one_digit() -> None:
    chip = simulator.MAX7219(8, 8)
    assert not chip.pixels.any()
    select(chip, "01FF", "02FF", "0C01")
    assert lit(chip) == [(x, 0) for x in range(8)]
    assert chip.contrast == 0


def test_a_register_and_a_byte_light_a_row_the_highest_bit_on_the_left() -> None:
    chip = started()
    select(chip, "0181", "0840")
    assert lit(chip) == [(0, 0), (7, 0), (1, 7)]


@pytest.mark.parametrize("limit", range(8))
def test_scan_limit(limit: int) -> None:
    chip = started()
    select(chip, *(f"{row:02X}80" for row in range(1, 9)), f"0BF{limit:X}")
    assert lit(chip) == [(0, row) for row in range(limit + 1)]


def test_test_lights_all_even_in_shutdown_and_shutdown_keeps_digits() -> None:
    chip = started()
    select(chip, "0310", "0C00")
    assert not chip.pixels.any()
    select(chip, "0F01")
    assert chip.pixels.all()
    select(chip, "0F00", "0C01")
    assert lit(chip) == [(3, 2)]


@pytest.mark.parametrize(("value", "intensity"), [(0x00, 0), (0x0F, 15), (0xF3, 3)])
def test_intensity(value: int, intensity: int) -> None:
    chip = started()
    select(chip, f"0A{value:02X}")
    assert chip.contrast == intensity


CODE_B = {
    **dict(enumerate((0x7E, 0x30, 0x6D, 0x79, 0x33, 0x5B, 0x5F, 0x70, 0x7F, 0x7B))),
    0x0A: 0x01,
    0x0B: 0x4F,
    0x0C: 0x37,
    0x0D: 0x0E,
    0x0E: 0x67,
    0x0F: 0x00,
}
"""Segments A to G of table 5 of the sheet, A in bit 6."""


@pytest.mark.parametrize("value", CODE_B)
def test_code_b_for_the_digits_that_the_mode_names(value: int) -> None:
    chip = started()
    select(chip, "0902", f"017{value:X}", f"02F{value:X}")
    assert np.packbits(chip.pixels[0])[0] == 0x70 + value
    assert np.packbits(chip.pixels[1])[0] == CODE_B[value] | 0x80


def test_addresses_have_four_bits_and_those_without_a_register_do_nothing() -> None:
    chip = started()
    select(chip, "F1FF", "00FF", "0DFF", "0EFF")
    assert lit(chip) == [(x, 0) for x in range(8)]
    assert chip.violations == []
    assert chip.remarks == ["0D FF: there is no such register; ignored"]


def test_the_first_pair_of_bytes_reaches_the_far_end() -> None:
    chip = started(24, 8)
    select(chip, "0180 0240 0320".replace(" ", ""))
    assert lit(chip) == [(0, 0), (9, 1), (18, 2)]
    assert [list(digits[:3]) for digits in chip.digits] == [[0, 0, 0x20], [0, 0x40, 0], [0x80, 0, 0]]


@pytest.mark.parametrize("pieces", [[6], [1, 5], [2, 2, 2], [1] * 6])
def test_bytes_of_a_select_may_come_in_pieces(pieces: list[int]) -> None:
    chip = started(24, 8)
    sent = bytes.fromhex("018002400320")
    for end, length in zip(itertools.accumulate(pieces), pieces, strict=True):
        chip.transfer(sent[end - length : end], True)
    chip.deselect()
    assert lit(chip) == [(0, 0), (9, 1), (18, 2)]


def test_what_is_shifted_out_feeds_the_next_chip() -> None:
    whole, parts = started(16, 8), [started(), started()]
    bus = simulator.SPIBus(parts, dc=None, reset=None, timer=None)
    for text in ("01020304", "0506", "07", "0108020303040405", ""):
        if text:
            bus.spi.writebytes(bytes.fromhex(text))
            select(whole, text)
    assert (parts[0].pixels == whole.pixels[:, 8:]).all()
    assert (parts[1].pixels == whole.pixels[:, :8]).all()


@pytest.mark.parametrize("wrong", ["01", "010203", "0102030405"])
def test_selects_too_short_or_odd_are_violations(wrong: str) -> None:
    chip = started(16, 8)
    select(chip, wrong)
    assert len(chip.violations) == 1
    assert chip.violations[0].endswith("a select takes a register and a byte for each of 2 chips")


# -- Wires


def test_the_capture_of_one_chip() -> None:
    chip = simulator.MAX7219(8, 8)
    words = ONE.split()
    select(chip, *words[: words.index("0f00")])
    assert chip.pixels.all()  # under test; the byte 0b alone came behind an 0f
    select(chip, *words[words.index("0f00") :])
    segments = [CODE_B[digit] for digit in (5, 1, 15, 3, 2, 11, 0, 1)]
    assert np.packbits(chip.pixels, axis=1)[:, 0].tolist() == segments
    assert chip.violations == ["0F 0B: a select takes a register and a byte for each of 1 chips"]
    assert chip.remarks == ["0D 0C: there is no such register; ignored"]


def test_the_capture_of_four_chips() -> None:
    chip = simulator.MAX7219(32, 8)
    words = FOUR.split()
    select(chip, *words[:-1])
    assert lit(chip) == [(31, 0), (22, 1), (13, 2), (4, 3)]
    select(chip, words[-1])
    assert not chip.pixels.any()
    assert len(chip.violations) == 1
    assert chip.remarks == [
        "a select of more than 8 bytes: the first leave at the far end",
        "0D 06: there is no such register; ignored",
    ]


# -- Wirings


ARROW = """
    ........
    .#......
    .##.....
    .###....
    .##.....
    .#......
    ........
    ........
"""


def picture(text: str) -> np.ndarray[Any, Any]:
    return np.array([[cell == "#" for cell in row] for row in text.split()], np.uint8)


@pytest.mark.parametrize(
    ("wiring", "seen"),
    [
        ({}, picture(ARROW)),
        ({"block_rotation": 90}, np.rot90(picture(ARROW), -1)),
        ({"block_rotation": 180}, np.rot90(picture(ARROW), 2)),
        ({"block_rotation": 270}, np.rot90(picture(ARROW))),
        ({"mirror_blocks": True}, picture(ARROW)[:, ::-1]),
        ({"mirror_blocks": True, "block_rotation": 90}, np.rot90(picture(ARROW)[:, ::-1], -1)),
        ({"mirror_x": True}, picture(ARROW)[:, ::-1]),
        ({"mirror_y": True}, picture(ARROW)[::-1]),
    ],
)
def test_how_a_module_is_mounted(wiring: dict[str, Any], seen: np.ndarray[Any, Any]) -> None:
    chip = started(**wiring)
    select(chip, *(f"{row:02X}{byte:02X}" for row, byte in enumerate(np.packbits(picture(ARROW), axis=1)[:, 0], 1)))
    assert np.array_equal(chip.pixels, seen)


@pytest.mark.parametrize(
    ("wiring", "blocks"),
    [
        ({}, "2,0 1,0 0,0 2,1 1,1 0,1"),
        ({"first_block": "top-left"}, "0,0 1,0 2,0 0,1 1,1 2,1"),
        ({"first_block": "bottom-left"}, "0,1 1,1 2,1 0,0 1,0 2,0"),
        ({"first_block": "bottom-right"}, "2,1 1,1 0,1 2,0 1,0 0,0"),
        ({"order": "columns"}, "2,0 2,1 1,0 1,1 0,0 0,1"),
        ({"order": "columns", "first_block": "bottom-left"}, "0,1 0,0 1,1 1,0 2,1 2,0"),
        ({"order": "serpentine"}, "2,0 1,0 0,0 0,1 1,1 2,1"),
        ({"order": "serpentine", "first_block": "bottom-left"}, "0,1 1,1 2,1 2,0 1,0 0,0"),
        ({"order": [(0, 0), (1, 1), (2, 0), (0, 1), (1, 0), (2, 1)]}, "0,0 1,1 2,0 0,1 1,0 2,1"),
        ({"order": "0.0,1.1,2.0,0.1,1.0,2.1"}, "0,0 1,1 2,0 0,1 1,0 2,1"),
    ],
)
def test_the_order_of_the_blocks(wiring: dict[str, Any], blocks: str) -> None:
    chip = started(24, 16, **wiring)
    for number, block in enumerate(blocks.split()):
        select(chip, "0400" * 6, "0000" * (5 - number) + "0480" + "0000" * number)
        column, row = map(int, block.split(","))
        back = wiring.get("order") == "serpentine" and number >= 3
        assert lit(chip) == [(8 * column + (7 if back else 0), 8 * row + (4 if back else 3))]


def test_wirings_that_cannot_be() -> None:
    with pytest.raises(ValueError, match="12x8 is not made of matrices of 8x8"):
        simulator.MAX7219(12, 8)
    with pytest.raises(ValueError, match="leaves modules"):
        simulator.MAX7219(16, 8, order=[(0, 0), (0, 0)])


def test_it_is_not_on_i2c() -> None:
    with pytest.raises(ValueError, match="MAX7219 cannot sit on I2C, but on SPI"):
        simulator.I2CBus({0x70: simulator.MAX7219()})


# -- luma


LUMA = {0: 270, 90: 0, 180: 90, -90: 180}
"""How modules are mounted for which luma has this `block_orientation`."""


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize("orientation", LUMA)
@pytest.mark.parametrize(
    ("width", "height", "reverse"),
    [(8, 8, False), (32, 8, False), (32, 8, True), (64, 8, True), (24, 16, False), (16, 32, False)],
)
def test_luma(orientation: int, width: int, height: int, reverse: bool) -> None:
    from luma.core.interface.serial import noop, spi
    from luma.led_matrix.device import max7219

    first = "top-right" if reverse else "top-left"
    chip = simulator.MAX7219(width, height, first_block=first, block_rotation=LUMA[orientation])
    bus = simulator.SPIBus(chip, dc=None, reset=None, timer=None)
    size = {"cascaded": width // 8} if height == 8 else {"width": width, "height": height}
    device = max7219(
        spi(spi=bus.spi, gpio=noop()),
        **size,
        block_orientation=orientation,
        blocks_arranged_in_reverse_order=reverse,
    )
    device.persist = True
    for seed in range(2):
        image = random_picture(width, height, seed)
        device.display(Image.fromarray(image * 255).convert("1"))
        assert np.array_equal(chip.pixels, image)
        assert np.array_equal(chip.frames[-1].pixels, image)
    assert len(chip.frames) == 2  # however many selects a picture takes
    device.contrast(0x50)
    assert chip.contrast == 5
    device.hide()
    assert not chip.pixels.any()
    device.show()
    assert np.array_equal(chip.pixels, image)
    assert (chip.violations, chip.remarks) == ([], [])
