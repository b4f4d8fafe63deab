"""The SSD1325 and the SSD1362: windows, remaps, nibbles, and what the SSD1325 fills by itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from paneldraw import simulator

# Start lines, offsets and mirrors of the two, upright and turned, with where their picture begins in the RAM.
SSD1325 = [("A0 52 A2 4C", 1, 0), ("A0 41 A2 44", -1, 0), ("A0 41 A2 4C", -1, 8)]
SSD1362 = [("A0 C3", 1, 0), ("A0 D0", -1, 0)]


def commands(chip: Any, text: str) -> None:
    chip.write(b"\x00" + bytes.fromhex(text))


def grays(width: int, height: int) -> NDArray[np.uint8]:
    return np.random.default_rng(1).integers(0, 16, (height, width), np.uint8)


def pairs(levels: NDArray[np.uint8]) -> bytes:
    return (levels[:, ::2] << 4 | levels[:, 1::2]).tobytes()


def shown(chip: Any, text: str, top: int = 0) -> NDArray[np.uint8]:
    levels = grays(chip.width, chip.height)
    commands(chip, f"A8 3F {text} 15 00 {chip.width // 2 - 1:02X} 75 {top:02X} {top + chip.height - 1:02X} AF")
    chip.write(b"\x40" + pairs(levels))
    return levels


@pytest.mark.parametrize(
    ("name", "text", "turn", "top"),
    [*(("SSD1325", *case) for case in SSD1325), *(("SSD1362", *case) for case in SSD1362)],
)
def test_upright_and_turned(name: str, text: str, turn: int, top: int) -> None:
    chip = getattr(simulator, name)()
    levels = shown(chip, text, top)
    assert np.array_equal(chip.pixels, levels[::turn, ::turn])
    assert (chip.violations, chip.remarks) == ([], [])


def test_nibbles_change_places_with_the_remap() -> None:
    cases = {"SSD1325": (("50", [2, 1]), ("52", [1, 2])), "SSD1362": (("43", [2, 1]), ("C3", [1, 2]), ("41", [1, 2]))}
    for name, remaps in cases.items():
        for remap, wanted in remaps:
            chip = getattr(simulator, name)()
            offset = "A2 4C" if name == "SSD1325" else ""
            commands(chip, f"A8 3F {offset} A0 {remap} 15 00 00 75 00 00 AF")
            chip.write(b"\x40\x12")
            assert chip.pixels[0, :2].tolist() == wanted


def test_vertical_windows() -> None:
    chip = simulator.SSD1325()
    commands(chip, "A8 3F A2 4C A0 56 15 01 02 75 03 04 AF")
    chip.write(bytes.fromhex("40 11 22 33 44"))
    assert chip.pixels[3:5, 2:6:2].tolist() == [[1, 3], [2, 4]]


def test_a_rectangle_is_filled() -> None:
    chip = simulator.SSD1325()
    levels = shown(chip, "A2 4C A0 52")
    commands(chip, "24 02 05 03 06 9A")
    levels[5:7, 4:8] = [9, 10, 9, 10]
    assert np.array_equal(chip.pixels, levels)
    assert chip.violations == []
    commands(chip, "24 03 05 02 06 00")
    assert len(chip.violations) == 1


def test_display_modes() -> None:
    for name, text in (("SSD1325", "A2 4C A0 52"), ("SSD1362", "A0 C3")):
        chip = getattr(simulator, name)()
        levels = shown(chip, text)
        for mode, wanted in (("A5", 0 * levels + 15), ("A6", 0 * levels), ("A7", 15 - levels), ("A4", levels)):
            commands(chip, mode)
            assert np.array_equal(chip.pixels, wanted)


def test_fewer_lines_than_the_glass_has_leave_some_dark() -> None:
    chip = simulator.SSD1325()
    levels = shown(chip, "A2 4C A0 52")
    commands(chip, "A8 1F")
    assert np.array_equal(chip.pixels[:32], levels[:32])
    assert not chip.pixels[32:].any()


@pytest.mark.parametrize(
    ("name", "sent"),
    [
        ("SSD1325", "15 00 40"),
        ("SSD1325", "75 00 50"),
        ("SSD1325", "A0 08"),
        ("SSD1325", "A1 50"),
        ("SSD1325", "A8 50"),
        ("SSD1362", "15 80 81"),
        ("SSD1362", "A0 03"),
        ("SSD1362", "A2 40"),
    ],
)
def test_what_endangers_the_picture(name: str, sent: str) -> None:
    chip = getattr(simulator, name)()
    commands(chip, sent)
    assert len(chip.violations) == 1


@pytest.mark.parametrize(
    ("name", "sent", "remarks"),
    [
        ("SSD1325", "B8 01 11 22 32 43 54 65 76 84 85 86 E3 B0 28 B2 51 B4 02 BF 0F AD 02 23 03 BC 10 BE 1C", 0),
        ("SSD1325", "25 00 00 01 01 05 05", 0),
        ("SSD1325", "A2 50", 1),
        ("SSD1325", "B9", 1),
        ("SSD1325", "FD 12", 1),
        ("SSD1325", "AD 8E", 1),
        ("SSD1325", "15 00 7F", 1),
        ("SSD1362", "FD 12 23 00 AB 01 AD 9E B6 04 B9 BC 1F BD 01 BE 07", 0),
        ("SSD1362", "AD 02", 1),
    ],
)
def test_what_is_not_seen_takes_its_arguments(name: str, sent: str, remarks: int) -> None:
    chip = getattr(simulator, name)()
    commands(chip, f"{sent} 81 2A")
    assert (chip.contrast, len(chip.remarks), chip.violations) == (0x2A, remarks, [])
