"""A transcript names every command of every chip, says where data went, and says what is wrong where it happens."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from paneldraw import Panel, controllers, simulator
from paneldraw.simulator.display_chip import DisplayChip
from paneldraw.simulator.transcript import Transcript
from paneldraw.transports import I2CTransport, SPITransport

from .helpers import init, pack, random_picture


def told(chip: Any, *payloads: str | bytes) -> list[str]:
    """What is written down of I2C writes, a call each, less the times and the pictures."""
    lines: list[str] = []
    bus = simulator.I2CBus({0x3C: chip}, timer=None)
    with Transcript(chip, lines.append):
        for payload in payloads:
            sent = bytes.fromhex(payload) if isinstance(payload, str) else payload
            bus.i2c_rdwr(_write(sent))
    return [re.sub(r"  +", "  ", line[12:]).strip() for line in lines if "picture" not in line]


def _write(payload: bytes) -> Any:
    from smbus2 import i2c_msg

    return i2c_msg.write(0x3C, payload)


def started(chip: Any) -> Any:
    chip.write(b"\x00" + init(128, 64))
    chip.violations.clear()
    chip.remarks.clear()
    return chip


# -- Why a picture is shifted


def test_an_sh1106_driven_by_code_for_an_ssd1306() -> None:
    """The picture comes two columns to the left, with two columns of noise at its right edge."""
    chip = simulator.SH1106()
    chip.write(bytes.fromhex("00 AE A1 C8 AD 8B AF"))
    pages = [b"\x40" + bytes(run) for run in pack(random_picture(128, 64, 1))]
    lines = told(chip, *(part for page, run in enumerate(pages) for part in (bytes([0, 0xB0 + page, 0x00, 0x10]), run)))
    assert lines[:5] == [
        "B0  page pointer 0",
        "00  column pointer 0",
        "10  column pointer 0",
        "data  128 bytes of data on page 0, columns 0 to 127",
        "note: columns 0 to 1 are beside the glass, which shows columns 2 to 129",
    ]
    assert lines[-1] == "never written: columns 128 to 129"


def test_an_sh1106_that_is_sent_windows() -> None:
    chip = simulator.SH1106()
    chip.write(bytes.fromhex("00 AD 8B AF"))
    lines = told(chip, "00 20 00 21 00 7F 22 00 07", b"\x40" + bytes(1024))
    assert lines[:8] == [
        "20 00  addressing mode of the SSD1306",
        "remark: not a command of the SH1106 (addressing mode of the SSD1306); ignored",
        "21 00 7F  windows of the SSD1306",
        "violation: not a command of the SH1106 (windows of the SSD1306); ignored",
        "22 00 07  windows of the SSD1306",
        "data  1024 bytes of data on page 0, columns 0 to 131",
        "violation: data past column 131 is lost",
        "note: columns 0 to 1, 130 to 131 are beside the glass, which shows columns 2 to 129",
    ]
    assert lines[-2:] == [
        "2 times in all, violation: not a command of the SH1106 (windows of the SSD1306); ignored",
        "never written: pages 1 to 7",
    ]


def test_a_missing_page_command() -> None:
    """All pages land on the first."""
    lines = told(
        started(simulator.SSD1306()),
        "00 20 02",
        *(part for _ in range(8) for part in ("00 00 10", b"\x40" + bytes(128))),
    )
    assert lines.count("data  128 bytes of data on page 0, columns 0 to 127") == 8
    assert lines[-1] == "never written: pages 1 to 7"


def test_a_panel_of_32_rows_in_a_ram_of_64() -> None:
    chip = simulator.SSD1306(128, 32)
    lines = told(chip, b"\x00" + init(128, 32), "00 21 00 7F 22 00 03", b"\x40" + bytes(512))
    assert "multiplex 31" in " ".join(lines)
    assert not any("never written" in line or "note" in line for line in lines)


def test_columns_beside_small_glass() -> None:
    chip = simulator.SSD1306(72, 40)
    chip.write(b"\x00" + init(72, 40))
    lines = told(chip, "00 21 00 47 22 00 04", b"\x40" + bytes(72 * 5))
    assert lines[-2:] == [
        "note: columns 0 to 27 are beside the glass, which shows columns 28 to 99",
        "never written: columns 72 to 99",
    ]


# -- The words


def test_commands_are_named_with_what_they_set() -> None:
    lines = told(started(simulator.SSD1306()), "00 81 CF A7 A4 20 01 21 05 0A B3 D5 F0 DA 12 AE 81", "00 20")
    assert lines == [
        "81 CF  contrast 207",
        "A7  inversion on",
        "A4  every pixel lit: off",
        "20 01  addressing mode: vertical",
        "21 05 0A  columns 5 to 10",
        "B3  page pointer 3",
        "remark: the page pointer commands B0-B7, 00-0F and 10-1F are for page addressing mode only",
        "D5 F0  clock F0",
        "DA 12  COM pins 12",
        "AE  display off",
        "81 20  contrast 32",
    ]


@pytest.mark.parametrize(
    ("payload", "words"),
    [
        (b"\x40" + bytes(16), "16 bytes of data on page 3, columns 12 to 27"),
        (b"\x40\xff", "1 byte of data on page 3, column 12"),
        (b"\x40" + bytes(200), "200 bytes of data from column 12 of page 3 to column 83 of page 4"),
        (b"\x40" + bytes(116 + 256), "372 bytes of data from column 12 of page 3 to column 127 of page 5"),
    ],
)
def test_data_is_said_by_its_place(payload: bytes, words: str) -> None:
    chip = started(simulator.SSD1306())
    chip.write(bytes.fromhex("00 B3 0C 10"))
    assert told(chip, payload)[0] == f"data  {words}"


def test_data_down_columns() -> None:
    lines = told(started(simulator.SSD1306()), "00 20 01 21 05 06 22 00 07", b"\x40" + bytes(16))
    assert lines[3] == "data  16 bytes of data on columns 5 to 6, pages 0 to 7"


def test_a_violation_follows_what_broke_it_and_is_counted() -> None:
    lines = told(started(simulator.SSD1306()), "00 D3 40 D3 41 A8 01", "00 D3 42")
    assert lines == [
        "D3 40  display offset 0",
        "violation: the display offset is 00 to 3F",
        "D3 41  display offset 1",
        "A8 01  multiplex 1",
        "violation: the multiplex ratio is 0F to 3F (16 to 64 lines)",
        "D3 42  display offset 2",
        "3 times in all, violation: the display offset is 00 to 3F",
    ]


def test_times_pictures_reads_and_power() -> None:
    chip = started(simulator.SSD1306())
    lines: list[str] = []
    bus = simulator.I2CBus({0x3C: chip}, timer=None)
    with Transcript(chip, lines.append, "oled"):
        bus.write_byte_data(0x3C, 0x00, 0xA5)
        bus.read_byte(0x3C)
        chip.power_cycle()
        bus.write_byte_data(0x3C, 0x00, 0xE3)
    assert lines == [
        "oled    0.000073  A5                   every pixel lit: on",
        "oled    0.000073                       picture 1: 8192 of 8192 pixels lit, 3 bytes on the wire",
        "oled    0.000122  03                   read: status",
        "oled    0.000195                       power lost and back; what the RAM holds is noise",
        "oled                                   reset",
        "oled              E3                   no operation",
        "oled    0.000195                       picture 2: 0 of 8192 pixels lit, 5 bytes on the wire",
    ]


def test_who_has_no_listener_is_told_nothing_more() -> None:
    chip = started(simulator.SSD1306())
    lines: list[str] = []
    first = Transcript(chip, lines.append)
    with pytest.raises(ValueError, match="has a transcript already"):
        Transcript(chip, print)
    first.close()
    first.close()
    chip.write(b"\x00\xa7")
    chip.settle(1.0, 3)
    assert (lines, chip.listener) == ([], None)


# -- Every chip


@pytest.mark.parametrize("name", sorted(controllers.CHIPS))
def test_every_command_of_every_chip_has_a_name(name: str) -> None:
    """All its opcodes, whatever arguments they have, leave a name without a brace and without a register's object."""
    chip = getattr(simulator, name.upper())()
    if not isinstance(chip, DisplayChip):
        return
    for opcode, command in type(chip).commands.items():
        sent = bytes([opcode, *[1] * command.arguments])
        command.act(chip, sent)
        reading = command.reading(chip, sent)
        assert re.fullmatch(r"[\w(][^{}<>=]*", reading), (hex(opcode), reading)


@pytest.mark.parametrize("name", sorted(controllers.CHIPS))
def test_our_own_driver_is_written_down_on_every_chip(name: str) -> None:
    """Without a violation, with a line for the picture, and with data where the glass is."""
    record, chip = controllers.CHIPS[name](), getattr(simulator, name.upper())()
    lines: list[str] = []
    transport: Any
    if "spi" in record.buses:
        wiring: dict[str, Any] = {"dc": None, "reset": None} if record.registers else {}
        wiring = {"dc": None} if record.synced else wiring
        bus = simulator.SPIBus(chip, timer=None, **wiring)
        bus.spi.cshigh = record.synced
        transport = SPITransport(spi=bus.spi, pins=bus.pins, **wiring)
    else:
        address = controllers.CHIPS[name].address
        transport = I2CTransport(simulator.I2CBus({address: chip}, timer=None), address)
    with Transcript(chip, lines.append), Panel(record, transport) as panel:
        panel.show(np.full((record.height, record.width), 2**record.depth - 1, np.uint8))
    text = "\n".join(lines)
    assert "violation" not in text
    assert "unknown" not in text
    assert "never written" not in text
    assert re.search(r"picture \d+: (\d+) of \1 pixels lit", text)
    assert re.search(r"\d+ bytes of|digit 7", text)


@pytest.mark.parametrize(
    ("chip", "sent", "words"),
    [
        (
            simulator.HT16K33(),
            ["21", "81", "E7", "00 01 02", "F9"],
            ["oscillator on", "display on, blinking 0", "dimming 7", "2 bytes of data from address 0", "unknown"],
        ),
        (
            simulator.IS31FL3731(),
            ["FD 0B", "0A 01", "FD 00", "24 01 02", "00 FF"],
            [
                "page 0B",
                "out of shutdown 01",
                "page 00",
                "2 bytes of brightness on page 0, from LED 0",
                "1 bytes of LEDs on and off on page 00, from register 00",
            ],
        ),
    ],
)
def test_messages_of_led_chips(chip: Any, sent: list[str], words: list[str]) -> None:
    lines = [line.partition("  ")[2] for line in told(chip, *sent)]
    assert [line for line in lines if line][: len(words)] == words


def test_half_bytes_of_an_st7920() -> None:
    chip, lines = simulator.ST7920(), list[str]()
    with Transcript(chip, lines.append):
        chip.transfer(bytes.fromhex("F8 00 C0 30 40 30 60 80 30 80 10"), data=False)  # 0C 34 36 83 81
        chip.transfer(bytes.fromhex("FA C0 00 00 00"), data=False)
        chip.settle(0.5, 16)
    assert [line[33:] for line in lines][:6] == [
        "display on",
        "function set: extended on, graphics off",
        "function set: extended on, graphics on",
        "row 3",
        "row pointer 3, column pointer 1",
        "2 bytes of data on row 3, column 1",
    ]
