"""LCD chips, each as luma.lcd means its module to be, and their backlight."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, ClassVar

from paneldraw import controllers
from paneldraw.compat.luma.core.device import device
from paneldraw.compat.luma.core.interface.serial import Interface
from paneldraw.transports.pins import GPIO

__all__ = ["backlit_device", "pcd8544", "st7567", "uc1701x"]


class backlit_device(device):
    """A panel with a light behind it, which is on from the start until `cleanup`.

    Parameters
    ----------
    serial_interface : spi, optional
    rotate : int, optional
        Quarter turns clockwise. Default: 0.
    gpio : object, optional
        Something with RPi.GPIO's ``setup`` and ``output``. Default: that of `serial_interface`, else gpiod.
    gpio_LIGHT : int, optional
        The light's line. Default: 18.
    active_low : bool, optional
        Whether a low line lights it. Default: False.
    backlight : callable, optional
        What is called with True and False instead.
    **more : int
        As of any device.
    """

    def __init__(
        self,
        serial_interface: Interface | None = None,
        rotate: int = 0,
        *,
        gpio: Any = None,
        gpio_LIGHT: int = 18,
        active_low: bool = False,
        backlight: Callable[[bool], object] | None = None,
        **more: Any,
    ) -> None:
        gpio = getattr(serial_interface, "gpio", None) if gpio is None else gpio
        self.backlight = backlight or _Light(gpio, gpio_LIGHT, active_low)
        self.backlight(True)
        super().__init__(serial_interface, rotate=rotate, **more)

    def cleanup(self) -> None:
        """Turn panel and light off unless they are to `persist`, and close what they are on."""
        if not self.persist:
            self.backlight(False)
        super().cleanup()
        close = getattr(self.backlight, "close", None)
        if close is not None:
            close()


class _Light:
    """A line that lights something."""

    def __init__(self, gpio: Any, line: int, active_low: bool) -> None:
        self._gpio, self._line, self._active_low = gpio, line, active_low
        self._own: GPIO | None = None
        if gpio is None:
            self._own = GPIO(None)
            self._own.claim(line, high=active_low)
        else:
            gpio.setup(line, getattr(gpio, "OUT", 0))

    def __call__(self, on: bool) -> None:
        high = bool(on) != self._active_low
        if self._own is None:
            self._gpio.output(self._line, int(high))
        else:
            self._own.set(self._line, high)

    def close(self) -> None:
        """Release the line if it was claimed here."""
        if self._own is not None:
            self._own.close()


class pcd8544(backlit_device):
    """PCD8544 of 84x48 pixels, the Nokia 5110's.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.core.interface.serial import spi
    >>> bus = simulator.SPIBus(simulator.PCD8544())
    >>> pcd8544(spi(spi=bus.spi, gpio=bus.gpio)).size
    (84, 48)
    """

    chip = controllers.PCD8544
    glass = (84, 48)
    contrast_shift = 1


class st7567(backlit_device):
    """ST7567 of 128x64 pixels."""

    chip = controllers.ST7567
    glass = (128, 64)
    contrast_shift = 2


class uc1701x(backlit_device):
    """UC1701X of 128x64 pixels."""

    chip = controllers.UC1701
    glass = (128, 64)
    wiring: ClassVar[Mapping[str, Any]] = {"mirror_x": True, "mirror_y": True}
