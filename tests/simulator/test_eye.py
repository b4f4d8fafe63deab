"""What an eye sees over time: scans in the chip's own time, row by row, of what is there in that moment."""

from __future__ import annotations

import numpy as np
import pytest

from paneldraw import Panel, controllers, simulator
from paneldraw.transports import I2CTransport, SPITransport

ADDRESS = 0x3C
SCAN = 54 * 64 / 370_000
"""Seconds a scan takes after reset: 50 + 2 + 2 clocks a line, 64 lines, 370 kHz."""


def bus_of(chip: simulator.SSD1306, clock: float = 400_000) -> simulator.I2CBus:
    chip.remembers = True
    bus = simulator.I2CBus({ADDRESS: chip}, clock, timer=None)
    send(bus, "00 8D 14 20 00 A1 C8 81 FF AF")
    return bus


def send(bus: simulator.I2CBus, text: str) -> None:
    bus.exchange(ADDRESS, bytes.fromhex(text))


def filled(value: int) -> str:
    return "40" + f"{value:02X}" * 1024


def test_the_rate_of_the_scan_after_reset_is_107_hz() -> None:
    assert 1 / simulator.SSD1306().frame_seconds == pytest.approx(107.06, abs=0.01)


@pytest.mark.parametrize(("contrast", "light"), [(0xFF, 1.0), (0x7F, 127 / 255), (0x00, 0.0)])
def test_a_steady_picture_is_as_bright_as_its_contrast(contrast: int, light: float) -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip)
    send(bus, filled(0x0F))
    send(bus, f"00 81 {contrast:02X}")
    bus.idle(0.2)
    assert np.array_equal(chip.seen(0.1) > 0, (chip.pixels > 0) & (light > 0))
    assert chip.seen(0.1).max() == pytest.approx(light)
    assert chip.flicker(0.1).max() == 0


def test_a_row_shows_what_the_ram_holds_when_it_is_scanned() -> None:
    chip = simulator.SSD1306(history=1)
    bus = bus_of(chip, clock=9_000_000)  # a byte a microsecond
    send(bus, filled(0))
    bus.idle(5 * SCAN - bus._now + SCAN * 20.6 / 64)  # in the sixth scan, in the middle of row 20
    send(bus, filled(0xFF))
    bus.idle(6.004 * SCAN - bus._now)
    rows = chip.seen(1.008 * SCAN)[:, 0]
    # The first byte of page 2 comes 0.26 ms later, when row 21 has been scanned.
    assert np.array_equal(rows, np.arange(64) > 21)


def test_data_reaches_each_row_when_its_byte_has_come() -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip)
    send(bus, filled(0))
    start = 10 * SCAN
    bus.idle(start - bus._now)
    send(bus, filled(0xFF))  # 23 ms: two scans and a half
    bus.idle(15 * SCAN + 1e-6 - bus._now)
    byte = 9 / 400_000
    page, column = np.indices((8, 128))
    arrived = start + 1 / 400_000 + byte * (page * 128 + column + 3)
    moments = (np.arange(10, 15)[:, None] + (np.arange(64) + 0.5) / 64) * SCAN
    lit = moments[:, :, None] >= arrived.repeat(8, axis=0)[None]
    assert np.array_equal(chip.seen(5 * SCAN + 2e-6), lit.mean(axis=0))


def test_a_reversed_scan_begins_at_the_other_end() -> None:
    chip = simulator.SSD1306()
    straight = chip._scan_order()
    chip.write(bytes.fromhex("00 C8"))
    assert np.array_equal(chip._scan_order(), straight[::-1])


def test_a_picture_half_of_the_time_is_half_the_light_and_flickers() -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip, clock=4_000_000)
    start = 3 * SCAN
    bus.idle(start - bus._now)
    for turn in range(40):  # 17.8 Hz
        send(bus, filled(0xFF if turn % 2 else 0))
        bus.idle(start + (turn + 1) * 3 * SCAN + 1e-6 - bus._now)
    seconds = 60 * SCAN + 2e-6
    assert np.allclose(chip.seen(seconds), 0.5)
    assert np.allclose(chip.flicker(seconds), 4 / 3)  # the first component of three scans lit and three dark


def test_the_contrast_counts_when_the_row_is_scanned() -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip)
    send(bus, filled(0xFF))
    start = bus._now
    for turn in range(80):
        send(bus, f"00 81 {(51, 102)[turn % 2]:02X}")
        bus.idle(start + (turn + 1) / 160 - bus._now)
    assert chip.seen(0.4).mean() == pytest.approx(0.3, abs=0.005)


def test_an_eye_sees_the_same_every_time() -> None:
    pictures = []
    for _ in range(2):
        chip = simulator.SSD1306()
        bus = bus_of(chip)
        for turn in range(20):
            send(bus, filled(turn))
        pictures.append(chip.seen(0.3))
    assert np.array_equal(pictures[0], pictures[1])


def test_lost_power_is_seen() -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip)
    send(bus, filled(0xFF))
    bus.idle(0.1)
    chip.power_cycle()
    bus.idle(0.1)
    send(bus, "00 E3")
    assert chip.seen(0.05).max() == 0
    assert chip.seen(0.2).max() == pytest.approx(0.5, abs=0.06)  # to a scan of 20


@pytest.mark.parametrize("name", ["SSD1306", "SH1106", "SH1107", "SSD1322", "SSD1327", "SSD1325", "SSD1362", "SH1122"])
def test_what_lies_still_is_seen_as_it_is(name: str) -> None:
    chip = getattr(simulator, name)()
    record = controllers.CHIPS[name.lower()]()
    bus = simulator.simulated_bus(chip, record, 0x3C)
    bus.timer, chip.remembers = None, True
    transport: I2CTransport | SPITransport
    if isinstance(bus, simulator.I2CBus):
        transport = I2CTransport(bus)
    else:
        transport = SPITransport(spi=bus.spi, pins=bus.pins, dc=bus.dc, reset=bus.reset)
    with Panel(record, transport) as panel:
        picture = np.random.default_rng(2).integers(0, 2**record.depth, (record.height, record.width), np.uint8)
        panel.show(picture)
        bus.idle(0.3)
        seen = chip.seen(0.1)
    assert np.allclose(seen, picture / (2**record.depth - 1) * chip._light)
    assert chip.flicker(0.1).max() == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize(
    ("name", "sent", "pulses"),
    [
        ("SSD1327", "", [0, 2, 14, 28]),  # levels 1, 2, 8 and 15, of which the last one is the light that there is
        ("SSD1327", "B8 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 3F", [1, 2, 8, 63]),
        ("SSD1327", "B8 01 02 03 04 05 06 07 08 09 0A 0B 0C 0D 0E 3F B9", [0, 2, 14, 28]),
        ("SSD1362", "", [0, 2, 14, 28]),
        ("SSD1325", "", [1, 3, 15, 29]),
        ("SSD1325", "B8 01 11 22 32 43 54 65 76", [1, 3, 22, 66]),  # Newhaven's
        ("SSD1322", "", [0, 8, 56, 112]),
        ("SSD1322", "B8 0C 18 24 30 3C 48 54 60 6C 78 84 90 9C A8 B4", [0, 8, 56, 112]),  # Univision's, not in use
        ("SSD1322", "B8 0C 18 24 30 3C 48 54 60 6C 78 84 90 9C A8 B4 00", [12, 24, 96, 180]),
        ("SSD1322", "B8 0C 18 24 30 3C 48 54 60 6C 78 84 90 9C A8 B4 00 B9", [0, 8, 56, 112]),
    ],
)
def test_light_is_what_the_grey_table_makes_of_levels(name: str, sent: str, pulses: list[int]) -> None:
    chip = getattr(simulator, name)()
    chip.transfer(bytes.fromhex("AF"), data=False)
    for at, opcode in enumerate(table := bytes.fromhex(sent)):
        chip.transfer(bytes((opcode,)), data=name == "SSD1322" and 0 < at < 16)
    assert len(table) in (0, 9, 16, 17, 18)
    assert chip.violations == []
    assert chip._shares[[1, 2, 8, 15]] == pytest.approx(np.array(pulses) / pulses[-1])
    assert chip._shares[0] == 0


def test_a_longer_pulse_makes_a_longer_scan() -> None:
    chip = simulator.SSD1327()
    before = chip.frame_seconds
    send(bus_of(chip), "00 B8 02 04 06 08 0A 0C 0E 10 12 14 16 18 1A 1C 38")
    assert chip.frame_seconds / before == pytest.approx((4 + 7 + 10 + 56) / (4 + 7 + 10 + 28))


def test_a_chip_that_does_not_remember_says_so() -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip)
    assert chip.remembers
    chip.remembers = False
    bus.idle(0.2)
    with pytest.raises(ValueError, match="remembers must be True"):
        chip.flicker(0.1)


@pytest.mark.parametrize("seconds", [0, -1, 2.1, 0.001])
def test_times_that_hold_no_scan_are_refused(seconds: float) -> None:
    chip = simulator.SSD1306()
    bus = bus_of(chip)
    bus.idle(3)
    with pytest.raises(ValueError, match="seconds must be"):
        chip.seen(seconds)


def test_the_long_past_is_forgotten() -> None:
    chip = simulator.SSD1306(history=1)
    bus = bus_of(chip)
    for turn in range(300):
        send(bus, filled(turn % 256))
    assert chip.timeline is not None
    assert len(chip.timeline._past) < 4.2 / 0.023
    assert chip.seen(2.0).shape == (64, 128)
