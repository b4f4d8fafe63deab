"""I2C and SPI, as luma's scripts open them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final, Protocol

from paneldraw.compat.luma.core.error import DeviceAddressError
from paneldraw.controllers import Controller
from paneldraw.transports import DATA, Cost, I2CTransport, Plan, SPITransport, Transport

__all__ = ["i2c", "noop", "spi"]

_LONGEST: Final = 31
"""Bytes that one call of an interface by others takes for sure: a block of SMBus."""


class Interface(Protocol):
    """What luma calls a serial interface; one by others will do."""

    def command(self, *cmd: int) -> None:
        """Send a command with its arguments."""

    def data(self, data: Any) -> None:
        """Send a sequence of bytes of data."""

    def cleanup(self) -> None:
        """Close what was opened."""


class i2c:
    """A panel's place on an I2C bus.

    Parameters
    ----------
    bus : object, optional
        An open bus with smbus2's interface, which remains the caller's. Default: the bus of number `port`.
    port : int, optional
        Number of the bus. Default: 1.
    address : int or str, optional
        The panel's address. Default: 0x3C.

    Raises
    ------
    DeviceAddressError
        `address` is none.
    DeviceNotFoundError, DevicePermissionError
        The bus cannot be opened.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.oled.device import ssd1306
    >>> serial = i2c(bus=simulator.I2CBus({0x3D: simulator.SSD1306(128, 64)}), address=0x3D)
    >>> ssd1306(serial).size
    (128, 64)
    """

    def __init__(self, bus: Any = None, port: int = 1, address: int | str = 0x3C) -> None:
        try:
            number = int(str(address), 0)
        except ValueError:
            raise DeviceAddressError(f"address must be a number such as 0x3C, not {address!r}") from None
        if not 0x08 <= number <= 0x77:
            raise DeviceAddressError(f"address must be 0x08 to 0x77, not {address!r}")
        self._transport = I2CTransport(int(port) if bus is None else bus, number)

    def _open(self, record: Controller) -> Transport:
        return self._transport

    def command(self, *cmd: int) -> None:
        """Send a command with its arguments."""
        self._transport.command(bytes(cmd))

    def data(self, data: Iterable[int]) -> None:
        """Send bytes of data."""
        self._transport.data(bytes(data))

    def cleanup(self) -> None:
        """Close the bus if it was opened here."""
        self._transport.close()


class spi:
    """A panel's place on an SPI bus.

    Parameters
    ----------
    spi : object, optional
        An open ``spidev.SpiDev``, which remains the caller's to set up and to close. Default: that of `port` and
        `device`.
    gpio : object, optional
        The lines: something with RPi.GPIO's ``setup`` and ``output``, or `noop`. Default: the header's, through gpiod.
    port, device : int, optional
        Bus and chip select. Default: 0 and 0.
    bus_speed_hz : int, optional
        Clock rate. Default: 8 000 000.
    transfer_size : int, optional
        Not needed: the kernel's own limit is known.
    gpio_DC, gpio_RST : int, optional
        Lines of D/C and reset. Default: 24 and 25. Chips without one do not use it.
    spi_mode : int, optional
        Clock polarity and phase: 0 alone, as all these chips have it; for another set up `spi` yourself.
    reset_hold_time, reset_release_time : float, optional
        Not needed: reset is pulsed for as long as the chips ask for.

    Raises
    ------
    ValueError
        Another `spi_mode`.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.oled.device import ssd1322
    >>> bus = simulator.SPIBus(simulator.SSD1322(256, 64))
    >>> ssd1322(spi(spi=bus.spi, gpio=bus.gpio)).size
    (256, 64)
    """

    def __init__(
        self,
        spi: Any = None,
        gpio: Any = None,
        port: int = 0,
        device: int = 0,
        bus_speed_hz: int = 8_000_000,
        transfer_size: int = 4096,
        gpio_DC: int | None = 24,
        gpio_RST: int | None = 25,
        spi_mode: int | None = None,
        reset_hold_time: float = 0,
        reset_release_time: float = 0,
    ) -> None:
        if spi_mode not in (None, 0):
            raise ValueError(f"spi_mode must be 0, not {spi_mode!r}: set up an SpiDev yourself and give it as spi=")
        self._place, self._speed, self._spi = (port, device), bus_speed_hz, spi
        self._lines = gpio_DC, gpio_RST
        self.gpio = gpio
        self._transport: SPITransport | None = None

    def _open(self, record: Controller | None) -> Transport:
        """Open the bus as a chip needs it, with the lines that it has."""
        if self._transport is None:
            dc, reset = self._lines
            if record is not None and record.registers is not None:
                dc = reset = None
            pins = None if self.gpio is None else _Lines(self.gpio, (dc, reset))
            bus, device = self._place
            self._transport = SPITransport(bus, device, dc=dc, reset=reset, speed=self._speed, spi=self._spi, pins=pins)
        return self._transport

    def command(self, *cmd: int) -> None:
        """Send a command with its arguments."""
        self._open(None).command(bytes(cmd))

    def data(self, data: Iterable[int]) -> None:
        """Send bytes of data."""
        self._open(None).data(bytes(data))

    def cleanup(self) -> None:
        """Close what was opened here."""
        if self._transport is not None:
            self._transport.close()


class noop:
    """Lines, or an interface, that do nothing.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.luma.led_matrix.device import max7219
    >>> bus = simulator.SPIBus(simulator.MAX7219(8, 8), dc=None, reset=None)
    >>> max7219(spi(spi=bus.spi, gpio=noop())).size
    (8, 8)
    """

    def setup(self, *args: Any, **kwargs: Any) -> None:
        """Do nothing."""

    output = command = data = cleanup = setup


class _Lines:
    """Lines that have RPi.GPIO's interface, as transports set them."""

    def __init__(self, gpio: Any, lines: Iterable[int | None]) -> None:
        self._gpio = gpio
        for line in lines:
            if line is not None:
                gpio.setup(line, getattr(gpio, "OUT", 0))

    def set(self, line: int | str, value: bool) -> None:
        """Put a line high or low."""
        self._gpio.output(line, int(value))


class _Carrier:
    """A transport over an interface by others."""

    cost = Cost(0, 0, longest=_LONGEST)

    def __init__(self, interface: Interface) -> None:
        self._interface = interface

    def command(self, payload: bytes) -> int:
        self._interface.command(*payload)
        return len(payload)

    def data(self, payload: bytes) -> int:
        self._interface.data(list(payload))
        return len(payload)

    def batch(self, plan: Plan) -> int:
        return sum((self.data if kind == DATA else self.command)(bytes(payload)) for kind, payload in plan)

    def reset(self) -> bool:
        return False

    def close(self) -> None:
        cleanup = getattr(self._interface, "cleanup", None)
        if cleanup is not None:
            cleanup()


def carrier(interface: Any, record: Controller) -> Transport:
    """Return what carries a panel's bytes over an interface.

    Raises
    ------
    TypeError
        It is none.
    """
    if isinstance(interface, (i2c, spi)):
        return interface._open(record)
    if not callable(getattr(interface, "command", None)) or not callable(getattr(interface, "data", None)):
        raise TypeError(f"serial_interface must be i2c(...), spi(...) or have command and data, not {interface!r}")
    return _Carrier(interface)
