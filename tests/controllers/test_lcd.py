"""LCD chips: every size, wiring and turn on the simulated glass; bytes on the wire; pauses; what a chip lacks."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from paneldraw import Panel, driver, open_panel, panel, simulator
from paneldraw.controllers import CHIPS, PCD8544, SSD1306, ST7565, ST7567, ST7920, UC1609, UC1701
from paneldraw.errors import PanelError
from paneldraw.transports import I2CTransport, SPITransport
from paneldraw.transports.synced import synced

LCDS = (PCD8544, ST7565, ST7567, UC1701, UC1609, ST7920)
MODULES = [(chip, size) for chip in LCDS for size in chip.sizes]
WIRINGS = [
    *MODULES,
    (ST7565, {"column_offset": 4}),
    (ST7565, {"width": 100, "height": 48, "column_offset": 16, "duty": 49, "bias": 8}),
    (ST7567, {"width": 100, "height": 32, "column_offset": 16, "first_com": 16, "bias": 7}),
    (UC1701, {"column_offset": 3}),
    (UC1609, {"width": 160, "height": 56, "column_offset": 20, "bias": 8}),
    (PCD8544, {"width": 60, "height": 40, "column_offset": 12}),
    (ST7920, {"width": 96, "height": 32, "column_offset": 64}),
]


class Pauses:
    """A clock on which waiting takes no time, and is noted."""

    def __init__(self):
        self.made = []

    def sleep(self, seconds):
        self.made.append(seconds)

    def perf_counter(self):
        return sum(self.made)

    monotonic = perf_counter


@pytest.fixture(autouse=True)
def pauses(monkeypatch):
    clock = Pauses()
    for module in (panel, driver):
        monkeypatch.setattr(module, "time", clock)
    return clock


def on_spi(chip):
    """A simulated chip on SPI, wired as it needs."""
    bus = simulator.SPIBus(chip, dc=None if isinstance(chip, simulator.ST7920) else 24, timer=None)
    bus.spi.cshigh = bus.dc is None
    return SPITransport(spi=bus.spi, pins=bus.pins, dc=bus.dc), bus


def started(make, *size, **wiring):
    """A panel of a chip, and the simulated chip."""
    wired = {name: value for name, value in wiring.items() if name in ("column_offset", "first_com", "duty")}
    controller = make(*size, **wiring)
    chip = getattr(simulator, make.name)(controller.width, controller.height, **wired)
    return Panel(controller, on_spi(chip)[0]), chip


def picture(panel, seed=1):
    return np.random.default_rng(seed).integers(0, 2, (panel.height, panel.width), np.uint8)


def blameless(chip):
    return chip.violations == chip.remarks == []


# -- Right


@pytest.mark.parametrize("rotate", [0, 90, 180, 270])
@pytest.mark.parametrize(("make", "size"), MODULES)
def test_every_size_shows_every_picture_in_every_turn(make, size, rotate):
    panel, chip = started(make, *size)
    panel.rotate = rotate
    for seed in range(2):
        drawn = picture(panel, seed)
        panel.show(drawn)
        np.testing.assert_array_equal(chip.pixels, np.rot90(drawn, -rotate // 90))
    assert blameless(chip)


@pytest.mark.parametrize("mirror", [(True, False), (False, True), (True, True)])
@pytest.mark.parametrize(("make", "wiring"), WIRINGS)
def test_mirrored_glass(make, wiring, mirror):
    if wiring == (96, 65) and mirror[1]:
        with pytest.raises(ValueError, match="mirror_y must be False where there are 65 rows"):
            make(*wiring, mirror_y=True)
        return
    wiring = {"width": wiring[0], "height": wiring[1]} if isinstance(wiring, tuple) else wiring
    panel, chip = started(make, **wiring, mirror_x=mirror[0], mirror_y=mirror[1])
    drawn = picture(panel)
    panel.show(drawn)
    np.testing.assert_array_equal(chip.pixels[:: -1 if mirror[1] else 1, :: -1 if mirror[0] else 1], drawn)
    assert blameless(chip)


@pytest.mark.parametrize("make", LCDS)
@pytest.mark.parametrize("updates", ["least", "plain", "whole"])
def test_small_changes(make, updates):
    panel, chip = started(make)
    panel = Panel(panel.controller, panel.transport, updates=updates)
    random = np.random.default_rng(3)
    drawn = picture(panel)
    for _ in range(40):
        panel.show(drawn)
        np.testing.assert_array_equal(chip.pixels, drawn)
        for _ in range(random.integers(1, 5)):
            y, x = random.integers(0, panel.height - 9), random.integers(0, panel.width - 20)
            drawn[y : y + random.integers(1, 9), x : x + random.integers(1, 20)] ^= 1
    assert blameless(chip)


@pytest.mark.parametrize("make", LCDS)
def test_settings_reach_the_chip(make):
    panel, chip = started(make)
    drawn = picture(panel)
    panel.invert()
    assert not chip.pixels.any()
    panel.show(drawn)
    np.testing.assert_array_equal(chip.pixels, 1 - drawn)
    panel.sleep()
    if panel.controller.contrast:
        panel.contrast(255)
        assert chip.contrast == panel.controller.contrast.highest
    drawn[3, 5] ^= 1
    panel.show(drawn)
    panel.invert(False)
    panel.invert(False)
    assert not chip.pixels.any()
    panel.wake()
    np.testing.assert_array_equal(chip.pixels, drawn)
    panel.invert()
    np.testing.assert_array_equal(chip.pixels, 1 - drawn)
    assert blameless(chip)


@pytest.mark.parametrize("make", LCDS)
def test_a_panel_is_dark_until_its_first_picture(make):
    panel, chip = started(make)
    panel = Panel(make(), panel.transport, contrast=200 if make is not ST7920 else None)
    assert not chip.pixels.any()
    assert not chip.registers.on
    drawn = picture(panel)
    panel.show(drawn)
    np.testing.assert_array_equal(chip.pixels, drawn)


def test_asleep_an_st7565_needs_no_power_and_a_pcd8544_stays_down_whatever_its_contrast():
    panel, chip = started(ST7565)
    assert chip.asleep
    panel.show(picture(panel))
    assert not chip.asleep
    panel, chip = started(PCD8544)
    panel.contrast(100)
    assert (chip.contrast, chip.registers.on) == (50, False)


# -- Bytes on the wire


@pytest.mark.parametrize(
    ("make", "commands", "data", "whole"),
    [
        (PCD8544, "B4 42", "04", 2 + 504),
        (ST7565, "B2 04 13", "04", 8 * (1 + 128) + 10),
        (ST7567, "B2 08 13", "04", 8 * (1 + 2 + 128)),
        (UC1701, "B2 04 13", "04", 8 * (1 + 128) + 10),
        (UC1609, "B2 04 13", "04", 8 * (1 + 2 + 192)),
    ],
)
def test_one_pixel_and_whole_pictures(make, commands, data, whole):
    panel, chip = started(make)
    empty = np.zeros((panel.height, panel.width), np.uint8)
    assert panel.show(empty).wire_bytes <= whole + 2  # and the command for light
    drawn = empty.copy()
    drawn[18, 52] = 1
    log = []
    chip.transfer = lambda run, data: log.append((bytes(run).hex(" ").upper(), data))
    report = panel.show(drawn)
    (sent, is_data), pixel = log
    assert set(sent.split()) <= set(commands.split())
    assert (is_data, pixel) == (False, (data, True))
    assert report.wire_bytes == len(sent.split()) + 1


def test_one_pixel_of_an_st7920_is_an_address_and_a_word():
    panel, chip = started(ST7920)
    drawn = np.zeros((64, 128), np.uint8)
    panel.show(drawn)
    log = []
    chip.transfer = lambda run, data: log.append(bytes(run))
    drawn[40, 21] = 1
    report = panel.show(drawn)
    assert log == [synced(False, bytes((0x88, 0x89))) + synced(True, bytes((0x04, 0x00)))]
    assert report.wire_bytes == len(log[0]) == 10


def test_a_whole_picture_of_an_st7920_is_one_chip_select():
    chip = simulator.ST7920()
    transport, bus = on_spi(chip)
    panel = Panel(ST7920(), transport)
    panel.show(picture(panel))
    messages = bus.messages
    report = panel.show(picture(panel, 2))
    assert (bus.messages - messages, report.wire_bytes) == (1, 32 * (1 + 4 + 1 + 64))


def test_a_bus_that_takes_short_messages_only():
    chip = simulator.ST7920()
    bus = simulator.SPIBus(chip, dc=None, bufsiz=100, timer=None)
    bus.spi.cshigh = True
    transport = SPITransport(spi=bus.spi, dc=None, reset=None)
    transport.cost = transport.cost._replace(longest=100)
    panel = Panel(ST7920(), transport)
    panel.show(drawn := picture(panel))
    np.testing.assert_array_equal(chip.pixels, drawn)
    assert bus.messages > 2240 // 100


def test_a_pcd8544_goes_on_into_the_next_bank():
    panel, chip = started(PCD8544)
    panel.show(drawn := picture(panel))
    drawn[0:16, 80:] ^= 1
    drawn[8:16, :80] ^= 1
    report = panel.show(drawn)
    assert report.wire_bytes == 2 + 4 + 84
    assert report.messages == 2
    np.testing.assert_array_equal(chip.pixels, drawn)
    assert [panel.show(drawn ^ n).wire_bytes for n in (1, 0)] == [504, 504]  # around the whole RAM


# -- Starts

U8G2 = {
    # u8x8_d_st7565.c: EA DOGM128, NHD C12832; u8x8_d_st7567.c: JLX12864, pi_132x64, erc13232, 122x32, 64x32;
    # u8x8_d_uc1701_mini12864.c, u8x8_d_uc1701_dogs102.c; u8x8_d_pcd8544_84x48.c; u8x8_d_uc1609.c
    ("ST7565", 128, 64): "E2 AE 40 A1 C0 A6 A2 2F F8 00 27 81 18 AE A5",
    ("ST7565", 128, 32): "E2 AE 40 A1 C0 A6 A2 2F F8 00 23 81 0A AE A5",
    ("ST7567", 128, 64): "E2 AE 40 A1 C0 A6 A3 2C 2E 2F 23 81 0A AE A5",
    ("ST7567", 132, 64): "E2 AE 40 A1 C0 A6 A3 2C 2E 2F 26 81 27 AE A5",
    ("ST7567", 132, 32): "E2 AE 40 A1 C0 A6 A3 2C 2E 2F 26 81 27 AE A5",
    ("ST7567", 122, 32): "E2 AE 60 A1 C0 A6 A2 2C 2E 2F 23 81 0A AE A5",
    ("ST7567", 96, 65): "E2 AE 40 A1 C0 A6 A3 2C 2E 2F 23 81 0A AE A5",
    ("ST7567", 64, 32): "E2 AE 40 A1 C0 A6 A2 2C 2E 2F 24 81 20 AE A5",
    ("UC1701", 128, 64): "E2 AE 40 A0 C8 A6 A2 2F F8 00 23 81 27 AC AE A5",
    ("UC1701", 102, 64): "E2 AE 40 A1 C0 A6 A2 2F 27 81 0E FA 90 AE A5",
    ("PCD8544", 84, 48): "21 06 13 C0",
    ("UC1609", 192, 64): "F1 3F 40 2E EB 81 8F 88 A1 C4 A6 A4",
}
ADDED = {"ST7565": "2C 2E", "ST7567": "F8 00", "UC1701": "F8 00", "UC1609": "E2 AE 24", "PCD8544": "20 0C 24"}


@pytest.mark.parametrize("module", U8G2)
def test_the_start_is_that_of_u8g2(module):
    name, *size = module
    sent = b"".join(entry for entry in CHIPS[name.lower()](*size).init if isinstance(entry, bytes))
    theirs = bytes.fromhex(U8G2[module])
    assert sorted(set(sent) - set(bytes.fromhex(ADDED[name]))) == sorted(set(theirs) - set(bytes.fromhex(ADDED[name])))


def test_the_voltage_rises_in_steps_with_pauses(pauses):
    panel, _ = started(ST7567)
    log = []
    transport = panel.transport
    transport.command, command = lambda payload: log.append(bytes(payload)) or command(payload), transport.command
    before = len(pauses.made)
    panel.show(picture(panel), force=True)
    assert pauses.made[before:] == [0.05, 0.05, 0.05]
    assert [entry[-1] for entry in log[:3]] == [0x2C, 0x2E, 0x2F]
    started(ST7920)
    assert pauses.made[-1] == 0.01


def test_pauses_are_made_at_a_start_only(pauses):
    panel, _ = started(ST7567)
    before = len(pauses.made)
    drawn = picture(panel)
    for _ in range(3):
        panel.show(drawn)
        drawn[9, 9] ^= 1
    panel.contrast(3)
    panel.sleep()
    panel.wake()
    assert len(pauses.made) == before


@pytest.mark.parametrize(
    ("make", "override", "command"),
    [
        (PCD8544, {"bias": 7}, b"\x14"),
        (PCD8544, {"bias": 11}, b"\x10"),
        (ST7565, {"bias": 7}, b"\xa3"),
        (ST7565, {"bias": 5, "duty": 33}, b"\xa3"),
        (ST7565, {"bias": 8, "duty": 55}, b"\xa2"),
        (ST7567, {"resistor_ratio": 2}, b"\x22"),
        (UC1701, {"bias": 7}, b"\xa3"),
        (UC1609, {"bias": 6}, b"\xe8"),
        (UC1609, {"bias": 9}, b"\xeb"),
    ],
)
def test_bias_and_regulation(make, override, command):
    assert command in make(**override).init


@pytest.mark.parametrize(
    ("make", "override", "message"),
    [
        (PCD8544, {"bias": 12}, "bias of the PCD8544 must be 4, .*10 or 11, not 12"),
        (PCD8544, {"resistor_ratio": 1}, "must not be given for the PCD8544, which has column_offset, bias"),
        (ST7565, {"bias": 8}, "bias of the ST7565 must be 9 or 7 at a duty of 65, not 8"),
        (ST7565, {"duty": 64}, "duty of the ST7565 must be 33, 49, 53, 55 or 65, not 64"),
        (ST7567, {"resistor_ratio": 8}, "resistor_ratio of the ST7567 must be 0, .* or 7, not 8"),
        (UC1701, {"duty": 33}, "duty must not be given for the UC1701"),
        (UC1609, {"bias": 5}, "bias of the UC1609 must be 9, 8, 7 or 6, not 5"),
        (ST7920, {"bias": 9}, "bias must not be given for the ST7920"),
        (ST7920, {"width": 100, "height": 32}, "size of the ST7920 must be 128x64, .* or 256x32, not 100x32"),
        (ST7920, {"width": 96, "height": 64, "column_offset": 0}, "size of the ST7920 must be 1x1 to 256x32"),
        (ST7920, {"width": 100, "height": 32, "column_offset": 0}, "multiples of 16"),
    ],
)
def test_overrides_that_a_chip_has_not(make, override, message):
    with pytest.raises(ValueError, match=message):
        make(**override)


def test_contrast_of_a_chip_without_names_those_with():
    panel, _ = started(ST7920)
    with pytest.raises(ValueError, match=r"the st7920 has no command for it; there is one on ssd1306, .*uc1609"):
        panel.contrast(9)


# -- Buses


@pytest.mark.parametrize("name", [make.name.lower() for make in LCDS])
def test_urls(name):
    with open_panel(f"sim://{name}?contrast=60" if name != "st7920" else "sim://st7920?size=192x32") as panel:
        panel.show(drawn := picture(panel))
        np.testing.assert_array_equal(panel.simulated.pixels, drawn)


def test_urls_of_real_buses_know_the_chip(monkeypatch):
    made = []

    def transport(*place, **settings):
        made.append((place, settings))
        raise PanelError("no bus here")

    monkeypatch.setattr("paneldraw.transports.SPITransport", transport)
    monkeypatch.setattr("paneldraw.transports.I2CTransport", transport)
    for url in (
        "spi://0.0?chip=pcd8544",
        "spi://0.1?chip=st7920&speed=500000",
        "spi://0.0?chip=st7565&bias=7&resistor_ratio=5&duty=65&mirror_y=1",
        "i2c://1/0x3f?chip=st7567",
        "i2c://1?chip=uc1609",
    ):
        with pytest.raises(PanelError, match="no bus here"):
            open_panel(url)
    assert made == [
        ((0,), {"device": 0, "speed": 4_000_000}),
        ((0,), {"device": 1, "speed": 500_000, "dc": None, "cs_high": True}),
        ((0,), {"device": 0, "speed": 8_000_000}),
        ((1, 0x3F), {}),
        ((1, 0x3C), {"data_address": 0x3D}),
    ]
    with pytest.raises(ValueError, match="chip must be one that I2C reaches, not 'pcd8544': it is on SPI"):
        open_panel("i2c://1?chip=pcd8544")


def test_an_st7567_on_i2c():
    chip = simulator.ST7567()
    panel = Panel(ST7567(), I2CTransport(simulator.I2CBus({0x3F: chip}, timer=None), 0x3F))
    panel.show(drawn := picture(panel))
    drawn[20, 77] ^= 1
    assert panel.show(drawn)[:3] == (8, 2, 1)
    np.testing.assert_array_equal(chip.pixels, drawn)
    assert blameless(chip)


def test_a_uc1609_on_i2c_has_two_addresses_and_no_control_bytes():
    chip = simulator.UC1609()
    bus = simulator.I2CBus({0x3C: chip, 0x3D: chip.data}, timer=None)
    panel = Panel(UC1609(), I2CTransport(bus, 0x3C, data_address=0x3D))
    panel.show(drawn := picture(panel))
    drawn[20, 77] ^= 1
    calls = bus.transactions
    assert panel.show(drawn)[:3] == (1 + 3 + 1 + 1, 2, 1)
    assert bus.transactions == calls + 1
    np.testing.assert_array_equal(chip.pixels, drawn)
    panel.show(1 - drawn)
    np.testing.assert_array_equal(chip.pixels, 1 - drawn)
    assert blameless(chip)
    with pytest.raises(ValueError, match="the uc1609 is on SPI or I2C with a data_address="):
        Panel(UC1609(), I2CTransport(bus, 0x3C))
    with pytest.raises(ValueError, match="data_address must be 0x08 to 0x77"):
        I2CTransport(bus, 0x3C, data_address=0x80)
    with pytest.raises(ValueError, match="the ssd1306 is on I2C or SPI"):
        Panel(SSD1306(), I2CTransport(bus, 0x3C, data_address=0x3D))


def test_a_uc1609_on_an_adapter_of_short_messages():
    chip = simulator.UC1609()
    bus = simulator.I2CBus({0x3C: chip, 0x3D: chip.data}, timer=None)
    panel = Panel(UC1609(), I2CTransport(bus, 0x3C, data_address=0x3D, max_message=32))
    panel.show(drawn := picture(panel))
    np.testing.assert_array_equal(chip.pixels, drawn)
    assert bus.messages > 1536 // 31


# -- Faults


@pytest.mark.parametrize("make", [LCDS[0], *(pytest.param(make, marks=pytest.mark.thorough) for make in LCDS[1:])])
@pytest.mark.parametrize("at_byte", [None, 1, 7])
def test_faults_heal(make, at_byte):
    for number, cut in itertools.product(range(6), (False, True)):
        chip = getattr(simulator, make.name)()
        transport, bus = on_spi(chip)
        panel = Panel(make(), transport)
        panel.show(picture(panel))
        panel.invert()
        bus.fail(after=number, at_byte=at_byte, then=chip.power_cycle if cut else None)
        for seed in range(5):
            panel.show(drawn := picture(panel, seed))
        np.testing.assert_array_equal(chip.pixels, 1 - drawn)
        assert panel.stats.restarts <= 1
        bus.fail(times=None)
        with pytest.raises(PanelError):
            panel.show(1 - drawn)
        bus.clear_faults()
        panel.show(drawn)
        np.testing.assert_array_equal(chip.pixels, 1 - drawn)
