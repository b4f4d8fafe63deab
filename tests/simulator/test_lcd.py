"""LCD chips against their datasheets' own numbers, and under drivers by others."""

from __future__ import annotations

import sys
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import smbus2
from numpy.typing import NDArray
from PIL import Image

from paneldraw import simulator
from paneldraw.simulator.display_chip import DisplayChip

from .helpers import pack, random_picture


def commands(chip: DisplayChip, text: str) -> None:
    chip.transfer(bytes.fromhex(text), data=False)


def data(chip: DisplayChip, text: str) -> None:
    chip.transfer(bytes.fromhex(text), data=True)


def place(chip: DisplayChip) -> tuple[int, int]:
    return chip.registers.column, chip.registers.page


def send_pages(chip: DisplayChip, picture: NDArray[np.uint8], left: int = 0) -> None:
    for page, row in enumerate(pack(picture)):
        commands(chip, f"{0xB0 + page:02X} {left & 15:02X} {0x10 | left >> 4:02X}")
        chip.transfer(row.tobytes(), data=True)


def spoken(chip: DisplayChip) -> list[str]:
    return chip.violations + chip.remarks


# -- PCD8544 (Philips, 1999 Apr 12): table 1, figures 5 and 6, sections 7.7 and 8


def test_pcd8544_after_reset_is_down_and_without_a_voltage() -> None:
    chip = simulator.PCD8544()
    registers = vars(chip.registers)
    assert (registers["on"], registers["down"], registers["extended"], registers["contrast"]) == (
        False,
        False,
        False,
        0,
    )
    assert not chip.pixels.any()
    commands(chip, "20 0C")
    data(chip, "FF")
    assert not chip.pixels.any()
    assert chip.violations == ["a picture for a panel that is on without a supply (21 80 and more) stays dark"]
    commands(chip, "21 80 FF 20 09")
    assert chip.pixels.all()


def test_pcd8544_counts_along_banks_or_down_columns_and_around() -> None:
    chip = simulator.PCD8544()
    commands(chip, "21 C0")
    for start, after in (("20 D3 40", (0, 1)), ("20 D3 45", (0, 0)), ("22 80 45", (1, 0)), ("22 D3 45", (0, 0))):
        commands(chip, start)
        data(chip, "A5")
        assert place(chip) == after
    commands(chip, "22 80 40")
    data(chip, "01 02 03 04 05 06 07")
    assert chip.ram[:, 0].tolist() == [1, 2, 3, 4, 5, 6]
    assert chip.ram[0, 1] == 7
    commands(chip, "20 D0 44")
    data(chip, "01 02 03 04 05")
    assert [chip.ram[4, 83], chip.ram[5, 0]] == [4, 5]
    assert spoken(chip) == []


def test_pcd8544_display_modes_and_the_extended_set() -> None:
    chip = simulator.PCD8544()
    commands(chip, "21 06 13 C8 20 0C 80 40")
    chip.transfer(bytes(504), data=True)
    assert (chip.registers.temperature, chip.registers.bias, chip.contrast) == (2, 3, 0x48)
    for mode, lit in (("08", 0), ("09", 1), ("0D", 1), ("0C", 0)):
        commands(chip, mode)
        assert (chip.pixels == lit).all()
    commands(chip, "0D 24")
    assert not chip.pixels.any()
    commands(chip, "20")
    assert chip.pixels.all()
    assert spoken(chip) == []


@pytest.mark.parametrize(
    ("sent", "rule"),
    [
        ("20 46", "46: there is no page past 5"),
        ("20 D4", "D4: there is no column past 83"),
        ("20 10", "10: a command neither of the PCD8544 nor of its relatives; ignored here"),
        ("21 40", "40: a command neither of the PCD8544 nor of its relatives; ignored here"),
        ("0A", "0A: a command neither of the PCD8544 nor of its relatives; ignored here"),
    ],
)
def test_pcd8544_complains(sent: str, rule: str) -> None:
    chip = simulator.PCD8544()
    commands(chip, sent)
    assert chip.violations == [rule]


# -- ST7565 (Sitronix ST7565P and S): figures 4 and 6, tables 4 and 16; ST7567 and UC1701x where they differ


def lit(make: Any = simulator.ST7565, start: str = "A1 C0", **wiring: Any) -> Any:
    chip = make(**wiring)
    commands(chip, f"2F AF {start}")
    return chip


def test_st7565_shows_nothing_before_all_three_parts_of_its_supply_are_on() -> None:
    chip = simulator.ST7565()
    commands(chip, "A5 AF")
    for power in ("28", "2C", "2E", "2B"):
        commands(chip, power)
        assert not chip.pixels.any()
    commands(chip, "2F")
    assert chip.pixels.all()
    assert chip.remarks == ["AF: display on before the panel has a supply (2F)"]
    assert simulator.ST7565(external_vcc=True).external_vcc


def test_st7565_sleep_is_display_off_with_all_points_on_and_keeps_the_ram() -> None:
    chip, picture = lit(), random_picture(128, 64, 1)
    commands(chip, "AE A5")
    assert chip.asleep
    send_pages(chip, picture)
    assert not chip.pixels.any()
    commands(chip, "A4 AF")
    assert not chip.asleep
    assert np.array_equal(chip.pixels, picture)


def test_st7565_mirrors_start_line_and_inverse() -> None:
    chip, picture = lit(width=132, height=64), random_picture(132, 64, 2)
    send_pages(chip, picture)
    commands(chip, "C8")
    assert np.array_equal(chip.pixels, picture[::-1])
    commands(chip, "C0 49")
    assert np.array_equal(chip.pixels, np.roll(picture, -9, axis=0))
    commands(chip, "40 A0 A7")
    assert np.array_equal(chip.pixels, 1 - picture)  # A0 mirrors what comes into the RAM
    send_pages(chip, picture)
    assert np.array_equal(chip.pixels, 1 - picture[:, ::-1])
    assert spoken(chip) == []


def test_st7565_columns_stop_at_83_and_pages_do_not_go_on() -> None:
    chip = lit()
    commands(chip, "B2 18 02")
    data(chip, "01 02 03")
    assert chip.violations == ["data past column 131 is lost"]
    assert chip.ram[2, 131 - 131] == 2
    assert chip.ram[3, 131] != 3
    assert chip.registers.page == 2


def test_st7565_read_modify_write_returns_to_where_it_began() -> None:
    chip = lit()
    commands(chip, "B1 10 05 E0")
    data(chip, "01 02 03")
    assert place(chip) == (8, 1)
    commands(chip, "EE")
    assert place(chip) == (5, 1)
    commands(chip, "EE")
    assert chip.remarks == ["EE: the end of a read-modify-write that was not begun (E0)"]


def test_st7565_internal_reset() -> None:
    chip = lit(start="A1 C8 47 27 81 3F A7 B5 13 07")
    commands(chip, "E2")
    registers = vars(chip.registers)
    reset = {"start_line": 0, "com_reversed": False, "resistor_ratio": 0, "contrast": 0x20, "column": 0, "page": 0}
    assert {name: registers[name] for name in reset} == reset
    assert (registers["segment_remap"], registers["inverted"], registers["on"]) == (True, True, True)


def test_st7565_electronic_volume_has_six_bits() -> None:
    chip = lit(start="81 AA")
    assert chip.contrast == 0x2A
    assert chip.remarks == ["81 AA: the electronic volume is 00 to 3F"]


@pytest.mark.parametrize("duty", [33, 49, 55])
def test_duty_leaves_the_lines_that_it_has(duty: int) -> None:
    lines = duty - 1
    chip, picture = lit(width=128, height=64, duty=duty), random_picture(128, 64, 3)
    send_pages(chip, picture)
    assert np.array_equal(chip.pixels[:lines], picture[:lines])
    assert not chip.pixels[lines:].any()
    commands(chip, "C8")
    assert np.array_equal(chip.pixels[:lines], picture[:lines][::-1])


def test_the_line_of_icons_stays_where_it_is() -> None:
    chip, picture = lit(simulator.ST7567, width=96, height=65), random_picture(96, 72, 4)
    send_pages(chip, picture)
    assert np.array_equal(chip.pixels, picture[:65])
    commands(chip, "C8 45")
    assert np.array_equal(chip.pixels[64], picture[64])
    commands(chip, "A7")
    assert np.array_equal(chip.pixels[64], 1 - picture[64])


def test_commands_of_relatives_pass_with_their_arguments() -> None:
    chip = lit(simulator.ST7567, "AD AF FA 90 85 0F 84")
    assert chip.remarks == [
        "AD AF: not a command of the ST7567 (static indicator of the ST7565); ignored",
        "FA 90: not a command of the ST7567 (program control of the UC1701); ignored",
    ]
    chip = lit(simulator.UC1701, "F8 01 AD 02 AC FA 93")
    assert spoken(chip) == []
    chip = lit(simulator.UC1701, "F8 02 FA 80")
    assert chip.violations == [
        "F8 02: the booster ratio is 00 or 01",
        "FA 80: the program control is 10, with bits 7, 1 and 0 as wanted",
    ]


def test_uc1701_wraps_where_it_is_told_to() -> None:
    chip = lit(simulator.UC1701, "A0 FA 93 B1 18 03")
    data(chip, "01 02")
    assert [chip.ram[1, 131], chip.ram[2, 0]] == [1, 2]
    assert spoken(chip) == []


@pytest.mark.parametrize(
    ("wiring", "message"),
    [
        ({"duty": 64}, "duty: 64 is none of 65, 55, 53, 49, 33"),
        ({"width": 128, "height": 66, "column_offset": 0}, "not within 1x1 and 132x65"),
        ({"width": 100, "height": 64}, "give column_offset too"),
        ({"column_offset": 5}, "column_offset: 5 is not 0 to 4"),
    ],
)
def test_modules_that_cannot_be(wiring: dict[str, int], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        simulator.ST7565(**wiring)


# U8g2's orders for glass of every kind: start, both ways up with their column offsets (u8x8_d_NAME.c).
U8G2 = [
    (simulator.ST7565, (128, 64), {}, "A2 2F F8 00 27 81 18", ("40 A1 C0", 0), ("40 A0 C8", 4)),
    (simulator.ST7565, (128, 64), {"column_offset": 4}, "A2 2F F8 00 25", ("40 A1 C0", 4), ("40 A0 C8", 0)),
    (simulator.ST7565, (128, 32), {}, "A2 2F F8 00 23 81 0A", ("40 A1 C0", 4), ("40 A0 C8", 0)),
    (simulator.ST7567, (132, 64), {}, "A3 2C 2E 2F 26 81 27", ("40 A1 C0", 0), ("40 A0 C8", 0)),
    (simulator.ST7567, (132, 32), {}, "A3 2C 2E 2F 26 81 27", ("40 A1 C0", 0), ("40 A0 C8", 0)),
    (simulator.ST7567, (128, 64), {}, "A3 2C 2E 2F 23 81 0A", ("40 A1 C0", 4), ("40 A0 C8", 0)),
    (simulator.ST7567, (128, 32), {}, "A3 2C 2E 2F 23 81 0A", ("40 A1 C0", 4), ("40 A0 C8", 0)),
    (simulator.ST7567, (122, 32), {}, "A2 2C 2E 2F 23 81 0A", ("60 A1 C0", 4), ("40 A0 C8", 6)),  # U8g2 has 0 there
    (simulator.ST7567, (64, 32), {}, "A2 2C 2E 2F 24 81 38", ("40 A1 C0", 36), ("40 A0 C8", 32)),
    (simulator.UC1701, (128, 64), {}, "A2 2F F8 00 23 81 27 AC", ("40 A0 C8", 0), ("40 A1 C0", 4)),
    (simulator.UC1701, (102, 64), {}, "A2 2F 27 81 0E FA 90", ("40 A1 C0", 0), ("40 A0 C8", 30)),
    (simulator.UC1609, (192, 64), {}, "F1 3F 2E EB 81 8F 88 A1 A6 A4", ("40 C4", 0), ("40 C2", 0)),
]


@pytest.mark.parametrize(("make", "size", "wiring", "start", "upright", "turned"), U8G2)
def test_u8g2s_orders(
    make: Any, size: tuple[int, int], wiring: dict[str, int], start: str, upright: tuple[str, int], turned: Any
) -> None:
    chip, picture = make(*size, **wiring), random_picture(*size, 5)
    commands(chip, f"AE {start}")
    for (way, left), turn in ((upright, 1), (turned, -1)):
        commands(chip, f"{way} A4 AF")
        send_pages(chip, picture, left)
        assert np.array_equal(chip.pixels, picture[::turn, ::turn])
    assert spoken(chip) == []


# -- UC1609 (UltraChip UC1609c), as U8g2, e-tinkers/uc1609, gavinlyonsrepo/ERM19264_UC1609 and
# -- wangshujun-tj/mpy-Framebuf-boost-uc1609 have it, none of which is in Python


def test_uc1609_under_e_tinkers_order_which_trusts_the_reset_values() -> None:
    chip, picture = simulator.UC1609(), random_picture(192, 64, 6)
    commands(chip, "E2 81 49 C4 00 10 B0 40 A6 AF")
    chip.transfer(pack(picture).tobytes(), data=True)
    assert np.array_equal(chip.pixels, picture)
    assert place(chip) == (0, 0)
    assert (spoken(chip), chip.contrast) == ([], 0x49)


@pytest.mark.parametrize(("access", "order", "after"), [("89", "C", (0, 0)), ("8B", "F", (0, 0))])
def test_uc1609_fills_pages_or_columns_first(access: str, order: Any, after: tuple[int, int]) -> None:
    chip, picture = simulator.UC1609(), random_picture(192, 64, 7)
    commands(chip, f"E2 AE 24 2F EB 81 B4 40 33 2A C4 F1 3F {access} B0 10 00 AF")
    chip.transfer(pack(picture).tobytes(order), data=True)
    assert np.array_equal(chip.pixels, picture)
    assert place(chip) == after
    assert spoken(chip) == []


def test_uc1609_mirrors_scrolls_and_ends_at_a_com_line() -> None:
    chip, picture = simulator.UC1609(), random_picture(192, 64, 8)
    commands(chip, "C4 88 AF")
    send_pages(chip, picture)
    commands(chip, "C0")
    assert np.array_equal(chip.pixels, picture[::-1])
    commands(chip, "C4 45")
    assert np.array_equal(chip.pixels, np.roll(picture, -5, axis=0))
    commands(chip, "40 C6")
    send_pages(chip, picture)
    assert np.array_equal(chip.pixels, picture[:, ::-1])
    commands(chip, "F1 37")
    assert np.array_equal(chip.pixels[8:], picture[:56, ::-1])
    assert not chip.pixels[:8].any()
    commands(chip, "F1 3F 28 10 00")
    assert not chip.pixels.any()
    data(chip, "00")
    assert chip.violations == ["a picture for a panel that is on without a supply (2E) stays dark"]


def test_uc1609_columns_stop_at_the_end_of_the_page_under_88() -> None:
    chip = simulator.UC1609()
    commands(chip, "88 AF B3 1B 0F")
    data(chip, "01 02")
    assert chip.violations == ["data past column 191 is lost"]


def test_uc1609_on_i2c_takes_data_at_the_next_address() -> None:
    chip = simulator.UC1609()
    bus = simulator.I2CBus({0x3C: chip, 0x3D: chip.data}, timer=None)
    for command in bytes.fromhex("E2 C4 B1 10 05 AF"):
        bus.write_byte(0x3C, command)
    chip.frames.clear()
    message, words = smbus2.i2c_msg.write(0x3C, b"\xb1\x10\x05"), smbus2.i2c_msg.write(0x3D, b"\x11\x22")
    bus.i2c_rdwr(message, words)
    assert chip.ram[1, 5:7].tolist() == [0x11, 0x22]
    assert [frame.wire_bytes for frame in chip.frames] == [4 + 3]
    assert bus.read_byte(0x3D) == 0


# -- ST7920 (Sitronix, V4.0): tables 5 and 6, and the serial interface


def serial(text: str, sync: int = 0xF8) -> bytes:
    return bytes((sync,)) + bytes(half for byte in bytes.fromhex(text) for half in (byte & 0xF0, byte << 4 & 0xF0))


def write(chip: simulator.ST7920, text: str, words: str = "") -> None:
    """Send commands, and then data."""
    chip.transfer(serial(text) + (serial(words, 0xFA) if words else b""), data=False)


def drawing() -> simulator.ST7920:
    chip = simulator.ST7920()
    write(chip, "30 0C 34 36")
    return chip


def test_st7920_has_its_lower_half_beside_the_upper_one() -> None:
    chip, picture = drawing(), random_picture(128, 64, 9)
    for y, row in enumerate(np.packbits(picture, axis=1)):
        write(chip, f"{0x80 | y % 32:02X} {0x88 if y > 31 else 0x80:02X}", row.tobytes().hex())
    assert np.array_equal(chip.pixels, picture)
    assert spoken(chip) == []


def test_st7920_words_wrap_within_their_row() -> None:
    chip = drawing()
    write(chip, "83 8F", "1234 5678")
    assert chip.registers.column == 1
    assert chip.ram[3, [30, 31, 0, 1]].tolist() == [0x12, 0x34, 0x56, 0x78]
    write(chip, "84 80", "00" * 68)
    assert chip.registers.column == 2
    assert not chip.ram[4].any()
    assert spoken(chip) == []


def test_st7920_takes_words_in_pieces_and_a_command_ends_one() -> None:
    chip = drawing()
    write(chip, "80 80", "AB")
    chip.transfer(serial("CD EF", 0xFA), data=False)
    write(chip, "80 82", "1122")
    assert chip.ram[0, [0, 1, 4, 5]].tolist() == [0xAB, 0xCD, 0x11, 0x22]


def test_st7920_shows_graphics_only_and_the_command_from_the_basic_set_does_not_switch_them() -> None:
    chip = simulator.ST7920()
    write(chip, "30 0C 36")
    assert (chip.registers.extended, chip.registers.graphics) == (True, False)
    assert not chip.pixels.any()
    write(chip, "36")
    assert chip.pixels.any()
    write(chip, "30")
    assert chip.pixels.any()
    write(chip, "08")
    assert not chip.pixels.any()


@pytest.mark.parametrize(
    ("sent", "rule"),
    [
        (serial("80") + b"\x80" + serial("80"), "a byte is cut off after its first half"),
        (serial("80", 0xFC), "FC: a sync byte is F8 or FA where nothing is read"),
        (b"\xf8\x81\x00", "a half byte ends in four zeros"),
        (b"\x80\x00", "bytes before the first sync byte are lost"),
        (serial("C0 80"), "C0: there is no row past 63"),
        (serial("80 90"), "90: there is no column past 15"),
        (serial("80 80 81") + serial("0000", 0xFA), "a row's address without a column's"),
        (serial("30 80") + serial("41", 0xFA) + serial("34 80 80") + serial("00", 0xFA), "text shines through"),
        (serial("30 04 34 80 80") + serial("00", 0xFA), "the cursor moves left"),
    ],
)
def test_st7920_complains(sent: bytes, rule: str) -> None:
    chip = drawing()
    chip.deselect()
    chip.transfer(sent, data=False)
    assert len(chip.violations) == 1
    assert rule in chip.violations[0]


def test_st7920_clears_its_text() -> None:
    chip = drawing()
    write(chip, "30 04 80", "4142")
    write(chip, "01 34 80 80", "FFFF")
    assert spoken(chip) == []
    assert chip.pixels[0, :16].all()


def test_st7920_listens_while_its_select_is_high_and_to_nobody_on_i2c() -> None:
    chip = simulator.ST7920()
    bus = simulator.SPIBus(chip, dc=None, timer=None)
    bus.spi.writebytes2(serial("30 0C"))
    assert not chip.registers.on
    bus.spi.cshigh = True
    bus.spi.writebytes2(serial("30 0C"))
    assert chip.registers.on
    with pytest.raises(ValueError, match=r"cannot sit on I2C|sits on spi"):
        simulator.I2CBus({0x3C: chip})
    with pytest.raises(ValueError, match="cannot sit on I2C"):
        chip.write(b"\x00")


@pytest.mark.parametrize("size", [(128, 32), (144, 32), (160, 32), (192, 32), (256, 32)])
def test_st7920_u8g2s_order_on_every_size(size: tuple[int, int]) -> None:
    # u8x8_d_st7920.c, which sends 3E twice; a tile is eight rows of so many bytes
    chip, picture = simulator.ST7920(*size), random_picture(*size, 10)
    write(chip, "38 08 06 02 01 38 0C")
    for top in range(0, size[1], 8):
        write(chip, "3E 3E")
        for y in range(top, top + 8):
            write(chip, f"{0x80 | y:02X} 80", np.packbits(picture[y]).tobytes().hex())
    assert np.array_equal(chip.pixels, picture)
    assert spoken(chip) == []


def test_st7920_sizes_that_cannot_be() -> None:
    with pytest.raises(ValueError, match="96x64 is not within 256x32, and not 128x64"):
        simulator.ST7920(96, 64, column_offset=0)


# -- Drivers by others


class Spi:
    """A simulated chip on a bus, and luma.core's SPI on it."""

    def __init__(self, chip: DisplayChip) -> None:
        from luma.core.interface.serial import spi

        self.chip = chip
        self.bus = simulator.SPIBus(chip, timer=None)
        self.serial = spi(spi=self.bus.spi, gpio=self.bus.gpio, gpio_DC=24, gpio_RST=25)


@pytest.mark.filterwarnings("ignore:Image.Image.getdata is deprecated")
@pytest.mark.parametrize(
    ("make", "name", "turn", "contrast"),
    [
        (simulator.PCD8544, "pcd8544", 1, 0x30),
        (simulator.ST7567, "st7567", 1, 57),
        (simulator.UC1701, "uc1701x", -1, 0xB0 >> 2),
    ],
)
def test_luma(make: Any, name: str, turn: int, contrast: int, monkeypatch: pytest.MonkeyPatch) -> None:
    import luma.lcd.device

    wired = Spi(make())
    device = getattr(luma.lcd.device, name)(wired.serial, gpio=wired.bus.gpio)
    device.persist = True
    chip = wired.chip
    assert chip.contrast == contrast
    for seed in range(2):
        picture = random_picture(chip.width, chip.height, seed)
        device.display(Image.fromarray(picture * 255).convert("1"))
        assert np.array_equal(chip.pixels[::turn, ::turn], picture)
    device.contrast(40)
    device.hide()
    assert not chip.pixels.any()
    device.show()
    assert np.array_equal(chip.pixels[::turn, ::turn], picture)
    assert chip.violations == []
    assert set(chip.remarks) <= {"AF: display on before the panel has a supply (2F)"}


class Pin:
    """A line as Adafruit's drivers set it."""

    def __init__(self, bus: simulator.SPIBus, line: int) -> None:
        self._bus, self._line = bus, line

    def switch_to_output(self, value: bool = False) -> None:
        self.value = value

    @property
    def value(self) -> bool:
        return bool(self._bus.gpio.input(self._line))

    @value.setter
    def value(self, high: bool) -> None:
        self._bus.pins.set(self._line, high)


class Busio:
    """What Adafruit's SPIDevice asks of a bus."""

    def __init__(self, bus: simulator.SPIBus) -> None:
        self._bus = bus

    def try_lock(self) -> bool:
        return True

    def unlock(self) -> None:
        pass

    def configure(self, **settings: Any) -> None:
        pass

    def write(self, payload: bytes | bytearray) -> None:
        self._bus.spi.writebytes2(bytes(payload))


@pytest.mark.parametrize(
    ("make", "module", "name"),
    [(simulator.PCD8544, "adafruit_pcd8544", "PCD8544"), (simulator.ST7565, "adafruit_st7565", "ST7565")],
)
def test_adafruit(make: Any, module: str, name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    driver = pytest.importorskip(module)
    monkeypatch.setattr("time.sleep", lambda seconds: None)
    chip = make()
    bus = simulator.SPIBus(chip, cs=8, timer=None)
    display = getattr(driver, name)(Busio(bus), Pin(bus, 24), Pin(bus, 8), Pin(bus, 25))
    picture = random_picture(chip.width, chip.height, 11)
    for y, x in np.argwhere(picture):
        display.pixel(int(x), int(y), 1)
    display.show()
    assert np.array_equal(chip.pixels, picture)
    display.invert = True
    assert np.array_equal(chip.pixels, 1 - picture)
    display.contrast = 50
    assert chip.contrast == 50
    assert spoken(chip) == []


def test_joyit_st7920(monkeypatch: pytest.MonkeyPatch) -> None:
    chip = simulator.ST7920()

    class Select:
        """spidev on a bus whose chip select the module has tied high."""

        def open(self, bus: int, device: int) -> None:
            pass

        def writebytes(self, values: list[int]) -> None:
            chip.transfer(bytes(values), data=False)

    lines = SimpleNamespace(OutputDevice=lambda line: SimpleNamespace(on=lambda: None, off=lambda: None))
    monkeypatch.setitem(sys.modules, "spidev", SimpleNamespace(SpiDev=Select))
    monkeypatch.setitem(sys.modules, "gpiozero", lines)
    monkeypatch.setattr("time.sleep", lambda seconds: None)
    driver = pytest.importorskip("ST7920.st7920", reason="joyit-st7920 needs a C compiler to install; .ci/run does")
    display = driver.ST7920()
    picture = random_picture(128, 64, 12)
    display.draw_image(Image.fromarray((1 - picture) * 255).convert("1", dither=Image.Dither.NONE))  # black is lit
    assert np.array_equal(chip.pixels, picture)
    assert spoken(chip) == []
