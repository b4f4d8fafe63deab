"""Adafruit's face beside adafruit_ssd1306 and adafruit_framebuf: the same calls, the same pixels."""

from __future__ import annotations

from typing import Any

import adafruit_framebuf
import adafruit_ssd1306
import numpy as np
import pytest
import smbus2
from blinka import Busio, BusioSPI, Pin
from hypothesis import example, given
from hypothesis import strategies as st
from PIL import Image

from paneldraw import simulator
from paneldraw.compat import adafruit
from paneldraw.compat.adafruit.drawing import Drawing
from paneldraw.errors import PanelNotFoundError

FACES = (adafruit_ssd1306, adafruit)
SIZES = [(128, 64), (128, 32), (96, 16), (64, 48), (64, 32), (72, 40)]


# -- Pixels

WIDTH, HEIGHT = 24, 16
near = st.integers(-30, 50)
color = st.integers(0, 2)
CALLS = {
    "fill": (color,),
    "pixel": (near, near, color),
    "hline": (near, near, near, color),
    "vline": (near, near, near, color),
    "rect": (near, near, near, near, color),
    "fill_rect": (near, near, near, near, color),
    "line": (near, near, near, near, color),
    "circle": (near, near, st.integers(-3, 40), color),
    "scroll": (st.integers(-16, 16), st.integers(-16, 16)),
}
call = st.one_of(*(st.tuples(st.just(name), st.tuples(*arguments)) for name, arguments in CALLS.items()))
turn = st.tuples(st.just("rotation"), st.integers(0, 3))


def theirs(width: int, height: int) -> Any:
    return adafruit_framebuf.FrameBuffer(bytearray(width * height // 8), width, height)


def unpacked(buffer: Any, width: int, height: int) -> Any:
    pages = np.frombuffer(bytes(buffer), np.uint8).reshape(height // 8, 1, width)
    return (pages >> np.arange(8, dtype=np.uint8)[:, None] & 1).reshape(height, width)


@given(st.lists(call | turn, min_size=1, max_size=12))
@example([("rect", (-3, -3, 10, 10, 1))])
@example([("line", (0, 0, 9, 3, 1)), ("line", (9, 13, 0, 10, 1)), ("line", (2, 9, 5, 0, 1))])
@example([("rotation", 1), ("line", (0, 0, 12, 20, 1)), ("rotation", 3), ("circle", (8, 12, 7, 1))])
def test_calls_draw_the_same_pixels(steps: list[tuple[str, Any]]) -> None:
    wanted, drawn = theirs(WIDTH, HEIGHT), Drawing(WIDTH, HEIGHT)
    for name, arguments in steps:
        for each in (wanted, drawn):
            if name == "rotation":
                each.rotation = arguments
            else:
                getattr(each, name)(*arguments)
        assert np.array_equal(drawn._pixels, unpacked(wanted.buf, WIDTH, HEIGHT)), (name, arguments)
    for x, y in ((0, 0), (5, 3), (15, 15), (23, 15), (24, 0), (0, -1)):
        assert drawn.pixel(x, y) == wanted.pixel(x, y)


@given(st.integers(0, 3), st.binary(min_size=WIDTH * HEIGHT // 8, max_size=WIDTH * HEIGHT // 8))
def test_images_are_drawn_as_they_are_turned(turns: int, pixels: bytes) -> None:
    size = (WIDTH, HEIGHT) if turns % 2 == 0 else (HEIGHT, WIDTH)
    image = Image.frombytes("1", size, pixels)
    wanted, drawn = theirs(WIDTH, HEIGHT), Drawing(WIDTH, HEIGHT)
    for each in (wanted, drawn):
        each.rotation = turns
        each.image(image)
    assert np.array_equal(drawn._pixels, unpacked(wanted.buf, WIDTH, HEIGHT))


@given(st.text("abcXYZ 019~\xff\n", max_size=8), near, near, color, st.integers(1, 3), st.integers(0, 3))
def test_text_in_a_font_file_is_theirs(
    tmp_path: Any, string: str, x: int, y: int, ink: int, size: int, turns: int
) -> None:
    path = tmp_path / "font.bin"
    if not path.exists():
        path.write_bytes(bytes((5, 7)) + np.random.default_rng(1).bytes(256 * 5))
    wanted, drawn = theirs(WIDTH, HEIGHT), Drawing(WIDTH, HEIGHT)
    for each in (wanted, drawn):
        each.rotation = turns
        each.fill(1 - min(ink, 1))
        each.text(string, x, y, ink, font_name=str(path), size=size)
    assert np.array_equal(drawn._pixels, unpacked(wanted.buf, WIDTH, HEIGHT))


def test_text_has_our_own_font_where_theirs_is_not(tmp_path: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    drawn = Drawing(16, 8)
    drawn.text("Hi", 0, 0, 1)
    assert ["".join(".#"[each] for each in row) for row in drawn._pixels[:, :12]] == [
        "#...#...#...",
        "#...#.......",
        "#...#..##...",
        "#####...#...",
        "#...#...#...",
        "#...#...#...",
        "#...#..###..",
        "............",
    ]
    (tmp_path / "font5x8.bin").write_bytes(bytes((5, 8)) + b"\xff" * 1280)
    drawn.text("H", 0, 0, 1)
    assert drawn._pixels[:, :5].all()


def test_a_line_whose_ends_are_far_away_is_quick() -> None:
    drawn = Drawing(128, 64)
    drawn.line(-(10**12), 10**12, 10**12, -(10**12), 1)
    assert drawn._pixels[0, 0] == 1
    assert drawn._pixels.sum() == 1


# -- Panels


@pytest.mark.parametrize(("width", "height"), SIZES)
def test_both_show_the_same_and_ours_sends_less(width: int, height: int) -> None:
    wiring = {"column_offset": (128 - width) // 2, "com_pins": 0x02 if width > 2 * height else 0x12}
    chips = [simulator.SSD1306(width, height, **wiring) for _ in FACES]
    buses = [simulator.I2CBus({0x3C: chip}, timer=None) for chip in chips]
    displays = [face.SSD1306_I2C(width, height, Busio(bus)) for face, bus in zip(FACES, buses, strict=True)]
    spent = [bus.bytes for bus in buses]
    for turns in (0, 2):
        for display in displays:
            display.rotation = turns
            display.fill(0)
            display.rect(0, 0, width, height, 1)
            display.circle(20, 8, 6, 1)
            display.line(3, 3, width - 4, height - 2, 1)
            display.show()
            display.pixel(7, 7, 1)
            display.show()
        assert np.array_equal(chips[0].pixels, chips[1].pixels)
        assert chips[0].pixels[0].all()
    for display in displays:
        display.invert(True)
        display.contrast(9)
    assert np.array_equal(chips[0].pixels, chips[1].pixels)
    assert chips[0].contrast == chips[1].contrast == 9
    for display in displays:
        display.rotate(False)
        display.show()
    assert np.array_equal(chips[0].pixels, chips[1].pixels)
    assert buses[1].bytes - spent[1] < (buses[0].bytes - spent[0]) / 2
    for display in displays:
        display.poweroff()
    assert not chips[0].pixels.any()
    assert not chips[1].pixels.any()
    assert [display.power for display in displays] == [False, False]
    displays[1].poweron()  # anew: asleep the chip could not tell that it lost its power
    assert chips[1].pixels.any()
    assert chips[1].violations == []


def test_buses_by_others() -> None:
    chip = simulator.SSD1306(128, 64)
    bus = simulator.I2CBus({0x3D: chip})
    display = adafruit.SSD1306_I2C(128, 64, bus, addr=0x3D, page_addressing=True)
    display.fill(1)
    display.show()
    assert chip.pixels.all()


def test_a_bus_by_its_number(monkeypatch: pytest.MonkeyPatch) -> None:
    opened = []
    bus = simulator.I2CBus({0x3C: simulator.SH1106(128, 64)})
    monkeypatch.setattr(smbus2, "SMBus", lambda path: opened.append(path) or bus)
    adafruit.SH1106_I2C(128, 64, 1).show()
    assert opened == ["/dev/i2c-1"]


@pytest.mark.parametrize(("name", "chip"), [("SSD1306_SPI", simulator.SSD1306), ("SH1106_SPI", simulator.SH1106)])
def test_spi(name: str, chip: Any) -> None:
    panel = chip(128, 64)
    bus = simulator.SPIBus(panel, cs=8, timer=None)
    bus.spi.no_cs = True
    display = getattr(adafruit, name)(128, 64, BusioSPI(bus), Pin(bus, 24), Pin(bus, 25), Pin(bus, 8))
    display.fill_rect(10, 10, 20, 5, 1)
    display.show()
    assert panel.pixels.sum() == 100
    assert panel.pixels[10:15, 10:30].all()
    assert panel.violations == []


# -- What is wrong


def test_nobody_there() -> None:
    with pytest.raises(PanelNotFoundError, match="0x3C"):
        adafruit.SSD1306_I2C(128, 64, Busio(simulator.I2CBus({})))


@pytest.mark.parametrize(
    ("wrong", "error", "says"),
    [
        (lambda d: setattr(d, "rotation", 4), ValueError, "rotation must be 0, 1, 2 or 3, not 4"),
        (lambda d: d.image(Image.new("L", (128, 64))), ValueError, r'img must be of mode "1".*convert'),
        (lambda d: d.image(Image.new("1", (64, 64))), ValueError, "img must be of the display's size 128x64"),
        (lambda d: d.text("x", 0, 0, 1, font_name="there is none"), OSError, "there is none"),
        (lambda d: d.line(0.5, 0, 3, 3, 1), TypeError, "integer"),
        (lambda d: d.contrast(256), ValueError, "256"),
        (lambda d: d.text("x", 0, 0, 1, font_name=__file__), ValueError, "Adafruit's format"),
    ],
)
def test_errors_are_clear(wrong: Any, error: type[Exception], says: str) -> None:
    display = adafruit.SSD1306_I2C(128, 64, simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)}))
    with pytest.raises(error, match=says):
        wrong(display)


def test_a_bus_that_is_none() -> None:
    with pytest.raises(TypeError, match="bus must be"):
        adafruit.SSD1306_I2C(128, 64, object())
    with pytest.raises(TypeError, match="dc must be a digitalio"):
        adafruit.SSD1306_SPI(128, 64, object(), 24, None, None)
