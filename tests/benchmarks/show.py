"""CPU time to bring a frame onto an SSD1306 or an SSD1327, on a bus that takes every byte and forgets it."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from typing import Any

import numpy as np
import peers
from measure import Against, Contest, Names, Row
from peers import HEIGHT, WIDTH
from PIL import Image, ImageDraw

from paneldraw import Framebuffer, Panel
from paneldraw.controllers import SSD1306, SSD1325, SSD1327, Controller
from paneldraw.transports import I2CTransport, SPITransport
from paneldraw.widgets import Chart

LUMA = "luma.oled"
LUMA_SPI = "luma.oled on SPI"
LUMA_GRAY = "luma.oled of 16 grays"
ADAFRUIT = "Adafruit"
DISPLAYIO = "displayio"


def row(
    name: str, one: str, other: str, over_luma: float, over_adafruit: float | None = None, displayio: str = ""
) -> Row:
    """Show two pictures in turn. What Adafruit's `show` sends is its own buffer, whatever is in it."""
    against = [
        Against(LUMA, f"display({one}_image); display({other}_image)", over_luma),
        Against(ADAFRUIT, "show(); show()", over_adafruit),
    ]
    if displayio:
        against.append(Against(DISPLAYIO, displayio))
    return Row(name, 2, f"show({one}); show({other})", tuple(against))


def spi_row(name: str, one: str, other: str, over_luma: float) -> Row:
    """Show two pictures in turn on SPI."""
    against = Against(LUMA_SPI, f"display({one}_image); display({other}_image)", over_luma)
    return Row(name, 2, f"show_spi({one}); show_spi({other})", (against,))


def gray_row(name: str, one: str, other: str, over_luma: float | None = None) -> Row:
    """Show two pictures of 128 x 128 pixels and 16 grays in turn."""
    against = Against(LUMA_GRAY, f"display({one}_image); display({other}_image)", over_luma)
    return Row(name, 2, f"show_gray({one}); show_gray({other})", (against,))


ROWS = [
    row("every pixel changed", "noise", "inverse", 40, displayio="dirty(); show(); dirty(); show()"),
    row("another picture", "lines", "circles", 10),
    row(
        "one pixel changed",
        "lines",
        "lines_and_a_pixel",
        60,
        1,
        displayio="pixel(64, 32, 1); show(); pixel(64, 32, 0); show()",
    ),
    row("nothing changed", "lines", "lines", 20, displayio="show(); show()"),
    spi_row("every pixel changed, on SPI", "noise", "inverse", 20),
    spi_row("one pixel changed, on SPI", "lines", "lines_and_a_pixel", 20),
    gray_row("every pixel changed, 16 grays", "gray_noise", "gray_inverse", 20),
    gray_row("one pixel changed, 16 grays", "gray_noise", "gray_noise_and_a_pixel"),
    # luma's is drawn with Pillow, and has no axes.
    Row(
        "a chart of 128 points, drawn and shown",
        2,
        "chart(one); chart(other)",
        (Against(LUMA, "chart(one); chart(other)"),),
    ),
    Row("a chart of 128 points, drawn and shown, 16 grays", 2, "gray_chart(one); gray_chart(other)"),
    Row("the same with grid and area, 16 grays", 2, "gray_area(one); gray_area(other)"),
]

#: Two readings of a quantity, 128 points each, the second a step later.
READINGS = [[20 + 4 * math.sin(x / 10) + 1.5 * math.sin(x / 2) for x in range(start, start + 128)] for start in (0, 1)]


def pictures() -> dict[str, Framebuffer]:
    """Pairs of pictures: all pixels differ, some do, one does."""
    pick = random.Random(1)
    made = {name: Framebuffer(WIDTH, HEIGHT) for name in ("noise", "inverse", "lines", "circles", "lines_and_a_pixel")}
    made["noise"].pixels[:] = np.random.default_rng(1).integers(0, 2, (HEIGHT, WIDTH))
    made["inverse"].pixels[:] = 1 - made["noise"].pixels
    for _ in range(8):
        x1, y1, x2, y2 = (pick.randrange(size) for size in (WIDTH, HEIGHT) * 2)
        made["lines"].line(x1, y1, x2, y2)
        made["circles"].circle(x1, y1, 10)
    made["lines_and_a_pixel"].pixels[:] = made["lines"].pixels
    made["lines_and_a_pixel"].pixel(64, 32, 1, op="xor")
    return made


def gray_pictures() -> dict[str, Framebuffer]:
    """Of 16 grays: noise, and what differs from it in all pixels or in one."""
    size = SSD1327.sizes[0]
    made = {name: Framebuffer(*size, 4) for name in ("gray_noise", "gray_inverse", "gray_noise_and_a_pixel")}
    made["gray_noise"].pixels[:] = made["gray_noise_and_a_pixel"].pixels[:] = np.random.default_rng(1).integers(
        0, 16, size[::-1]
    )
    made["gray_inverse"].pixels[:] = 15 - made["gray_noise"].pixels
    made["gray_noise_and_a_pixel"].pixels[64, 32] ^= 1
    return made


class Forgetful:
    """A bus that takes every message, with as much of smbus2's, spidev's and RPi.GPIO's interfaces as drivers use."""

    OUT = LOW = 0
    HIGH = 1

    def i2c_rdwr(self, *messages: Any) -> None:
        """Take messages."""

    def write_i2c_block_data(self, address: int, register: int, data: Any) -> None:
        """Take a short command."""

    def writebytes2(self, values: Any) -> None:
        """Take any number of bytes."""

    def writebytes(self, values: list[int]) -> None:
        """Take up to 4096 bytes."""

    def set(self, line: int, value: bool) -> None:
        """Take a level; so do the two of RPi.GPIO's."""

    output = setup = set

    def open(self, bus: int, device: int) -> None:
        """Nothing to open."""

    def close(self) -> None:
        """Nothing to close."""


def names() -> Names:
    """The pictures, and the `show` of a panel."""
    bus = Forgetful()
    show_spi = Panel(SSD1306(WIDTH, HEIGHT), SPITransport(spi=bus, pins=bus)).show
    show, show_gray = (Panel(chip, I2CTransport(bus)).show for chip in (SSD1306(WIDTH, HEIGHT), SSD1327()))
    gray = SSD1325(WIDTH, HEIGHT)
    charts = {
        "chart": charting(SSD1306(WIDTH, HEIGHT)),
        "gray_chart": charting(gray),
        "gray_area": charting(gray, grid=True, fill=True),
    }
    readings = {"one": np.array(READINGS[0]), "other": np.array(READINGS[1])}
    shows = {"show": show, "show_spi": show_spi, "show_gray": show_gray}
    return {**pictures(), **gray_pictures(), **shows, **charts, **readings}


def charting(chip: Controller, **options: bool) -> Callable[[Any], None]:
    """What draws a chart with its axes on a panel, and shows it."""
    panel = Panel(chip, I2CTransport(Forgetful()))
    fb = panel.framebuffer()

    def chart(values: Any) -> None:
        fb.clear()
        Chart(values, **options).draw(fb)
        panel.show(fb)

    return chart


def images() -> Names:
    """The pictures as Pillow's, which luma wants."""
    return {f"{name}_image": fb.to_image() for name, fb in pictures().items()}


def luma() -> Names:
    """Its device on I2C."""
    device = peers.luma(Forgetful())

    def chart(values: list[float]) -> None:
        image = Image.new("1", (WIDTH, HEIGHT))
        ImageDraw.Draw(image).line([(x, 63 - (value - 10) * 3) for x, value in enumerate(values)], 1)
        device.display(image)

    return {"display": device.display, "chart": chart, "one": READINGS[0], "other": READINGS[1], **images()}


def luma_spi() -> Names:
    """Its device on SPI."""
    return {"display": peers.luma_spi(Forgetful(), Forgetful()).display, **images()}


def luma_gray() -> Names:
    """Its device of 16 grays on I2C, which wants colors and makes grays of them."""
    colored = {f"{name}_image": fb.to_image().convert("RGB") for name, fb in gray_pictures().items()}
    return {"display": peers.luma(Forgetful(), "ssd1327", SSD1327.sizes[0]).display, **colored}


def linux_write() -> peers.Write:
    """What a write costs below ``busio.I2C`` on Linux: Blinka's layers down to the bus's file."""
    from Adafruit_PureIO import smbus

    class File:
        def write(self, data: Any) -> None:
            """Take bytes."""

        def close(self) -> None:
            """Nothing to close."""

    class Bus(smbus.SMBus):  # type: ignore[misc]
        def _select_device(self, address: int) -> None:
            """Spare the system call, as the write spares it."""

    bus = Bus()
    bus._device = File()
    return bus.write_bytes  # type: ignore[no-any-return]


def adafruit() -> Names:
    """Sends its own buffer."""
    return {"show": peers.adafruit(linux_write()).show}


def displayio() -> Names:
    """One pixel is set to one level and the other; for all pixels a whole bitmap is declared dirty."""
    device = peers.Displayio(linux_write())
    device.show()
    return {"pixel": device.pixel, "dirty": device.bitmap.dirty, "show": device.show}


def run(rounds: int) -> None:
    """Print the group's rows."""
    by_others = {LUMA: luma, LUMA_SPI: luma_spi, LUMA_GRAY: luma_gray, ADAFRUIT: adafruit, DISPLAYIO: displayio}
    Contest(names(), by_others, rounds).run_all(ROWS)
