"""Drivers by others for a 128 x 64 SSD1306 and an SSD1327, each on a bus of our choice."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

WIDTH, HEIGHT = 128, 64
ADDRESS = 0x3C

Write = Callable[[int, Any], object]
Mask = npt.NDArray[np.bool_]


def luma(bus: Any, name: str = "ssd1306", size: tuple[int, int] = (WIDTH, HEIGHT)) -> Any:
    """luma.oled's device on an object with smbus2's interface. It writes whole messages only if it opens the bus."""
    import smbus2
    from luma.core.interface.serial import i2c
    from luma.oled import device as devices

    real: Any = smbus2.SMBus
    smbus2.SMBus = lambda port: bus
    try:
        device = getattr(devices, name)(i2c(port=1), *size)
    finally:
        smbus2.SMBus = real
    device.persist = True
    return device


def luma_spi(spi: Any, gpio: Any) -> Any:
    """luma.oled's device on objects with the interfaces of spidev and RPi.GPIO."""
    from luma.core.interface import serial
    from luma.oled.device import ssd1306

    device = ssd1306(serial.spi(spi=spi, gpio=gpio), WIDTH, HEIGHT)
    device.persist = True
    return device


def luma_led(spi: Any) -> Any:
    """Make luma.led_matrix's device of eight MAX7219s; None where the package is not at hand."""
    try:
        from luma.core.interface import serial
        from luma.led_matrix.device import max7219
    except ImportError:
        return None
    device = max7219(serial.spi(spi=spi, gpio=serial.noop()), cascaded=8)
    device.persist = True
    return device


class Wire:
    """An object with the interface of ``busio.I2C``; every write goes to one function."""

    def __init__(self, write: Write) -> None:
        self._write = write
        self._locked = False

    def try_lock(self) -> bool:
        """Take the bus, unless somebody has it."""
        taken, self._locked = not self._locked, True
        return taken

    def unlock(self) -> None:
        """Give the bus back."""
        self._locked = False

    def writeto(self, address: int, buffer: Any, *, start: int = 0, end: int | None = None) -> None:
        """Write part of a buffer."""
        self._write(address, memoryview(buffer)[start:end])

    def deinit(self) -> None:
        """Nothing to close."""


def adafruit(write: Write) -> Any:
    """Adafruit's driver of the framebuf kind: `pixel`, then `show`."""
    import adafruit_ssd1306

    return adafruit_ssd1306.SSD1306_I2C(WIDTH, HEIGHT, Wire(write), addr=ADDRESS)


class Displayio:
    """displayio's display with one bitmap on it, as Blinka has it for Python: `pixel`, then `show`.

    The rectangle that it sends grows around the pixels that were set, whether they changed or not.
    """

    def __init__(self, write: Write) -> None:
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            import displayio  # it has something to say about machines without pins
            import i2cdisplaybus
            from adafruit_displayio_ssd1306 import SSD1306

        displayio.background_thread_stop_event.set()  # of use to displays that refresh themselves only
        displayio.release_displays()
        bus = i2cdisplaybus.I2CDisplayBus(Wire(write), device_address=ADDRESS)
        display = SSD1306(bus, width=WIDTH, height=HEIGHT, auto_refresh=False)
        palette = displayio.Palette(2)
        palette[0], palette[1] = 0x000000, 0xFFFFFF
        self.bitmap = displayio.Bitmap(WIDTH, HEIGHT, 2)
        group = displayio.Group()
        group.append(displayio.TileGrid(self.bitmap, pixel_shader=palette))
        display.root_group = group
        self.show = display.refresh

    def pixel(self, x: int, y: int, level: int) -> None:
        """Set a pixel."""
        self.bitmap[x, y] = level


def draw(device: Any, picture: npt.NDArray[np.uint8], changed: Mask) -> None:
    """Set the pixels that changed and show the picture."""
    for y, x in np.argwhere(changed).tolist():
        device.pixel(x, y, int(picture[y, x]))
    device.show()
