"""What drivers in C by others send, in their order, as data: it lights the chip, upright, without a violation."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from paneldraw import simulator

Picture = NDArray[np.uint8]


class Driver(NamedTuple):
    """What one driver sends to one module.

    Attributes
    ----------
    source : str
        Where the values are from; what a device tree gives is the module's.
    chip, size : str, (int, int)
    start : str
        Commands in order, each with its arguments, in hex.
    way, place : str, int
        How it says where data goes, a method of `Ways`, and its first column in that way's units.
    wiring : dict
        How the module differs from the simulator's common one.
    turned : (int, int)
        What becomes of rows and columns: 1, or -1 where the module is upright for another driver.
    """

    source: str
    chip: str
    size: tuple[int, int]
    start: str
    way: str
    place: int = 0
    wiring: dict[str, int] = {}  # noqa: RUF012 - read only
    turned: tuple[int, int] = (1, 1)


class Ways:
    """How data is addressed: commands in hex, and the data behind them."""

    @staticmethod
    def pages(picture: Picture, left: int) -> Iterator[tuple[str, bytes]]:
        """A page pointer before every page."""
        for page, row in enumerate(np.packbits(picture, axis=0, bitorder="little")):
            yield f"{0xB0 | page:02X}, {left & 15:02X}, {0x10 | left >> 4:02X}", row.tobytes()

    @staticmethod
    def windows(picture: Picture, left: int) -> Iterator[tuple[str, bytes]]:
        """A window of pages, filled at once."""
        pages = np.packbits(picture, axis=0, bitorder="little")
        bounds = f"21 {left:02X} {left + picture.shape[1] - 1:02X}, 22 00 {len(pages) - 1:02X}"
        yield bounds, pages.tobytes()

    @staticmethod
    def grays(picture: Picture, left: int, unit: int = 2, write: str = "") -> Iterator[tuple[str, bytes]]:
        """A window of rows, the left pixel of two in the upper half."""
        height, width = picture.shape
        last = left + width // unit - 1
        pairs = picture[:, ::2] << 4 | picture[:, 1::2]
        yield f"15 {left:02X} {last:02X}, 75 00 {height - 1:02X}{write}", pairs.tobytes()

    @staticmethod
    def swapped(picture: Picture, left: int) -> Iterator[tuple[str, bytes]]:
        """The same, the left pixel in the lower half."""
        height, width = picture.shape
        pairs = picture[:, 1::2] << 4 | picture[:, ::2]
        yield f"15 {left:02X} {left + width // 2 - 1:02X}, 75 00 {height - 1:02X}", pairs.tobytes()

    @staticmethod
    def fours(picture: Picture, left: int) -> Iterator[tuple[str, bytes]]:
        """A window of which a column is four pixels, and the command before data."""
        yield from Ways.grays(picture, left, 4, ", 5C")

    @staticmethod
    def rows(picture: Picture, left: int) -> Iterator[tuple[str, bytes]]:
        """A row pointer before every row."""
        for row, levels in enumerate(picture):
            yield f"{0x10 | left >> 4:02X}, {left & 15:02X}, B0 {row:02X}", (levels[::2] << 4 | levels[1::2]).tobytes()


FB = "Linux, drivers/video/fbdev/ssd1307fb.c"
DRM = "Linux, drivers/gpu/drm/solomon/ssd130x.c"
Z1306, Z1327, Z1122 = (f"Zephyr, drivers/display/display_{name}.c" for name in ("ssd1306", "ssd1327_5", "sh1122"))
U8G2 = "U8g2, csrc/u8x8_d_"

LINUX = "81 7F, A1, C8, A8 {}, D3 00, D5 {}, {}D9 22, DA {}, DB {}, 8D {}, {}20 {}".format
LINUX_132X = (
    "81 80, 15 00 3F, 75 00 {0}, A0 53, A1 00, A2 00, A4, A8 {0}, B1 55, B9, B3 01, AB 01, B6 01, BC 08, BE 07, D5 62"
).format
NHD_TABLE = "86, B8 01 11 22 32 43 54 65 76"
U8G2_1305 = "40, 20 00, A1, C8, DA 12, 81 CF, D9 F1, DB 40, 2E, A4, A6"
U8G2_1312 = "40, 8D 14, 20 00, A1, C0, DA 12, {}81 CF, D9 F1, DB 40, 2E, A4, A6"
U8G2_1322 = "AB 01, B4 A0 FD, C1 9F, C7 0F, B9, B1 E2, D1 A2 20, BB 1F, B6 08, BE 07, A6, A9"
U8G2_1327 = "AB 01, 81 53, B1 51, B3 01, B9, BC 08, BE 07, B6 01, D5 62, A4"
U8G2_1362 = "A4, A8 3F, AB 01, AD 8E, B1 22, B3 A0, B6 04, B9, BC 1F, BD 01, BE 07"

# fmt: off
DRIVERS = [
    Driver(FB, "SSD1306", (128, 64), LINUX("3F", "80", "", "12", "20", "14", "", "00"), "windows"),
    Driver(FB, "SSD1306", (128, 32), LINUX("1F", "80", "", "02", "20", "14", "", "00"), "windows"),
    Driver(FB, "SSD1309", (128, 64), LINUX("3F", "A0", "", "12", "34", "10", "", "00"), "windows"),
    Driver(FB, "SSD1305", (128, 32), LINUX("1F", "70", "", "12", "34", "10", "", "00"), "windows", 4),
    Driver(DRM, "SSD1305", (128, 64), LINUX("3F", "70", "D8 05, ", "12", "34", "10", "91 3F 3F 3F 3F, ", "00"),
        "windows", 2),
    Driver(DRM, "SH1106", (128, 64), LINUX("3F", "50", "", "12", "40", "10", "", "02"), "pages", 2),
    Driver(f"{DRM}, ssd132x_init", "SSD1327", (128, 128), LINUX_132X("7F"), "swapped"),
    Driver(f"{DRM}, ssd132x_init", "SSD1325", (128, 80), LINUX_132X("4F"), "swapped",
        wiring={"column_offset": 0, "com_pins": 0x40}, turned=(1, -1)),
    Driver(Z1306, "SSD1306", (128, 64),
        "AE, D5 80, D9 22, 40, D3 00, DA 12, A8 3F, A1, C8, 8D 14, 33, DB 20, A4, A6, 81 80, AF, 20 00", "windows"),
    Driver(Z1306, "SSD1315", (128, 64),
        "AE, D5 80, D9 22, 40, D3 00, DA 12, A8 3F, A1, C8, 8D 14, 33, AD 10, DB 20, A4, A6, 81 80, AF, 20 00",
        "windows"),
    Driver(Z1306, "SSD1309", (128, 64),
        "AE, D5 A0, D9 22, 40, D3 00, DA 12, A8 3F, A1, C8, DB 34, A4, A6, 81 80, AF, 20 00", "windows"),
    Driver(Z1306, "SH1106", (128, 64),
        "AE, D5 50, D9 22, 40, D3 00, DA 12, A8 3F, A1, C8, AD 8B, DB 35, A4, A6, 81 80, AF", "pages", 2),
    Driver(Z1306, "CH1115", (128, 64),
        "AE, D5 80, D9 22, 40, D3 00, DA 12, A8 3F, A1, C8, AD 8B, 82 00, DB 35, A4, A6, 81 80, AF", "pages"),
    Driver(Z1306, "SH1107", (64, 128),
        "AE, D5 51, D9 22, 40, D3 60, DA 12, A8 7F, A0, C0, AD 8B, DB 35, A4, A6, 81 80, AF", "pages"),
    Driver(Z1327, "SSD1327", (128, 128),
        "AE, 15 00 7F, 75 00 7F, A0 53, 81 80, A8 7F, A1 00, A2 00, A0 53, AB 01, A4, B1 51, B3 01, "
        "B8 00 02 04 06 08 0A 0C 0E 10 12 14 16 18 1A 1C, B6 01, BC 08, BE 07, D5 62, FD 12, AF", "swapped"),
    Driver(Z1327, "SSD1325", (128, 64),
        "AE, 15 00 7F, 75 00 3F, A0 50, 81 40, A8 3F, A1 00, A2 4C, A0 50, AD 02, 86, A4, B1 55, B3 91, B2 28, "
        "B8 01 11 11 11 11 11 11 11, BC 10, BE 1C, B4 03, B0 28, AF", "swapped"),
    Driver(Z1122, "SH1122", (256, 64),
        "AE, 81 80, 40, D3 00, A4, A6, C0, A0, 30, A8 3F, D9 22, D5 50, DC 35, DB 35, AD 81, A6, AF", "rows"),
    Driver(f"{U8G2}ssd1305.c, noname", "SSD1305", (128, 32), f"AE, D5 80, A8 3F, D3 20, {U8G2_1305}", "pages", 2,
        {"column_offset": 2}),
    Driver(f"{U8G2}ssd1305.c, adafruit", "SSD1305", (128, 32), f"AE, D5 80, A8 3F, D3 20, {U8G2_1305}", "pages", 4),
    Driver(f"{U8G2}ssd1305.c, flipped", "SSD1305", (128, 32), f"AE, D5 80, A8 3F, D3 20, {U8G2_1305}, D3 00, A0, C0",
        "pages", 0, turned=(-1, -1)),
    Driver(f"{U8G2}ssd1305.c, adafruit", "SSD1305", (128, 64),
        "AE, D5 F0, A8 3F, D3 40, 40, 20 00, A1, C8, DA 12, 81 32, 82 80, D9 F1, DB 40, 2E, A4, A6", "pages", 2),
    Driver(f"{U8G2}ssd1306_128x64_noname.c", "SSD1312", (128, 64), f"AE, D5 80, A8 3F, D3 00, {U8G2_1312.format('')}",
        "pages"),
    Driver(f"{U8G2}ssd1306_128x64_noname.c, flipped", "SSD1312", (128, 64),
        f"AE, D5 80, A8 3F, D3 00, {U8G2_1312.format('')}, A0, C8", "pages", turned=(-1, -1)),
    *(Driver(f"{U8G2}ssd1312.c", "SSD1312", size, f"AE, D5 80, A8 3F, D3 00, {U8G2_1312.format('D3 30, ')}", "pages")
        for size in ((128, 32), (120, 32), (120, 28))),
    Driver(f"{U8G2}ssd1312.c, flipped", "SSD1312", (128, 32),
        f"AE, D5 80, A8 3F, D3 00, {U8G2_1312.format('D3 30, ')}, A0, C8", "pages", turned=(-1, -1)),
    Driver(f"{U8G2}ssd1315_128x64_noname.c", "SSD1315", (128, 64),
        "AE, D5 90, A8 3F, D3 00, 40, A1, C8, DA 12, 81 7F, D9 22, DB 30, A4, A6, AD 10, 8D 14", "pages"),
    Driver("G. Lyons, ER_OLEDM1_CH1115", "CH1115", (128, 64),
        "AE, 00, 10, B0, 40, 81 80, 82 00, A0, A2, A4, A6, A8 3F, C0, D3 00, D5 A0, D9 22, DB 40, 31, AD 8B, AF",
        "pages", turned=(-1, -1)),
    Driver(f"{U8G2}ssd1325.c, nhd", "SSD1325", (128, 64),
        f"AE, B3 91, A8 3F, A2 4C, A1 00, AD 02, A0 52, {NHD_TABLE}, 81 70, B2 51, B1 55, BC 10, B4 02, B0 28, "
        "BE 1C, BF 0F, A4, 23 03", "grays"),
    Driver(f"{U8G2}ssd1325.c, os128064", "SSD1325", (128, 64),
        f"AE, B3 91, A8 3F, A2 40, A1 00, AD 02, A0 52, {NHD_TABLE}, 81 70, B2 51, B1 55, BC 10, B4 02, B0 28, "
        "BE 1C, BF 0F, A4, 23 03", "grays", wiring={"first_com": 0}),
    Driver(f"{U8G2}ssd1325.c, os128064 flipped", "SSD1325", (128, 64),
        f"AE, B3 91, A8 3F, A2 40, A1 00, AD 02, A0 52, {NHD_TABLE}, 81 70, B2 51, B1 55, BC 10, B4 02, B0 28, "
        "BE 1C, BF 0F, A4, 23 03, A0 41, A2 50", "grays", wiring={"first_com": 0}, turned=(-1, -1)),
    *(Driver(f"{U8G2}ssd1327.c", "SSD1327", size, f"FD 12, AE, A8 {lines}, A1 00, A2 {offset}, A0 51, {U8G2_1327}",
        "grays", left) for size, lines, offset, left in (((128, 128), "7F", "00", 0), ((96, 96), "5F", "20", 8))),
    *(Driver(f"{U8G2}ssd1327.c, flipped", "SSD1327", size,
        f"FD 12, AE, A8 {lines}, A1 00, A2 00, A0 51, {U8G2_1327}, A2 {offset}, A0 42", "grays", left, turned=(-1, -1))
        for size, lines, offset, left in (((128, 128), "7F", "00", 0), ((96, 96), "5F", "60", 8))),
    Driver(f"{U8G2}ssd1327.c, visionox", "SSD1327", (128, 96),
        "FD 12, AE, A8 5F, A1 00, A2 20, A0 51, AB 01, 81 DF, B1 22, B3 50, B9, BC 10, BE 05, B6 0A, D5 62, A4",
        "grays"),
    Driver(f"{U8G2}ssd1327.c, ws", "SSD1327", (128, 128),
        "AE, 15 00 7F, 75 00 7F, 81 80, A0 51, A1 00, A2 00, A4, A8 7F, B1 F1, B3 00, AB 01, B6 0F, BE 0F, BC 08, "
        "D5 62, FD 12", "grays"),
    Driver(f"{U8G2}ssd1327.c, winstar", "SSD1327", (96, 64),
        "FD 12, AE, D9 00, A0 42, A1 00, A2 00, A8 63, AB 01, 81 53, B1 47, B3 00, B9, BC 07, BE 07, B6 04, D5 62, A4",
        "grays", 8),
    Driver(f"{U8G2}ssd1322.c, flipped", "SSD1322", (256, 64),
        f"FD 12, AE, B3 91, CA 3F, A2 00, A1 00, A0 14 11, {U8G2_1322}", "fours", 0x1C),
    Driver(f"{U8G2}ssd1322.c, nhd", "SSD1322", (256, 64),
        f"FD 12, AE, B3 91, CA 3F, A2 00, A1 00, A0 06 11, {U8G2_1322}", "fours", 0x1C, turned=(-1, -1)),
    Driver(f"{U8G2}ssd1322.c, zjy", "SSD1322", (256, 64),
        f"FD 12, AE, B3 91, CA 3F, A2 00, A1 00, A0 16 11, {U8G2_1322}", "fours", 0x18, {"column_offset": 128},
        turned=(1, -1)),
    Driver(f"{U8G2}ssd1322.c, topwin", "SSD1322", (240, 128),
        f"FD 12, AE, B3 91, CA 7F, A2 00, A1 00, A0 36 01, {U8G2_1322}", "fours", 24),
    Driver(f"{U8G2}ssd1362.c", "SSD1362", (256, 64), f"FD 12, AE, 23 00, 81 9F, A0 C3, A1 00, A2 00, {U8G2_1362}",
        "grays"),
    Driver(f"{U8G2}ssd1362.c, flipped", "SSD1362", (256, 64),
        f"FD 12, AE, 23 00, 81 9F, A0 D0, A1 00, A2 00, {U8G2_1362}", "grays", turned=(-1, -1)),
    Driver(f"{U8G2}ssd1362.c", "SSD1362", (206, 36), f"FD 12, AE, 23 00, 81 9F, A0 C3, A1 32, A2 00, {U8G2_1362}",
        "grays"),
    Driver(f"{U8G2}ssd1362.c, flipped", "SSD1362", (206, 36),
        f"FD 12, AE, 23 00, 81 9F, A0 D0, A1 32, A2 00, {U8G2_1362}", "grays", 25, turned=(-1, -1)),
    Driver(f"{U8G2}sh1122.c", "SH1122", (256, 64),
        "AE, 40, A0, C0, 81 80, A8 3F, AD 81, D5 50, D3 00, D9 22, DB 35, DC 35, 30", "rows"),
    Driver(f"{U8G2}sh1122.c, flipped", "SH1122", (256, 64),
        "AE, 40, A0, C0, 81 80, A8 3F, AD 81, D5 50, D3 00, D9 22, DB 35, DC 35, 30, A1, C8, 60", "rows",
        turned=(-1, -1)),
]
# fmt: on


def send(chip: Any, text: str, data: bytes = b"", *, one_by_one: bool = False) -> None:
    """Send commands: over SPI with their arguments as data, or over I2C, where Linux sends every byte for itself."""
    for command in text.split(","):
        sent = bytes.fromhex(command)
        if chip.arguments_are_data:
            chip.transfer(sent[:1], data=False)
            chip.transfer(sent[1:], data=True)
        elif one_by_one:
            for byte in sent:
                chip.write(bytes((0x80, byte)))
        else:
            chip.write(b"\x00" + sent)
    if chip.arguments_are_data:
        chip.transfer(data, data=True)
    elif data:
        chip.write(b"\x40" + data)


@pytest.mark.parametrize("driver", DRIVERS, ids=lambda driver: f"{driver.chip} {driver.size} {driver.source}")
def test_it_shows_the_picture(driver: Driver) -> None:
    chip = getattr(simulator, driver.chip)(*driver.size, **driver.wiring)
    picture = np.random.default_rng(1).integers(0, chip.max_level + 1, driver.size[::-1], np.uint8)
    singly = driver.source.startswith("Linux")
    send(chip, driver.start, one_by_one=singly)
    for commands, data in getattr(Ways, driver.way)(picture, driver.place):
        send(chip, commands, data, one_by_one=singly)
    send(chip, "AF", one_by_one=singly)
    down, across = driver.turned
    assert np.array_equal(chip.pixels, picture[::down, ::across])
    assert chip.violations == []
