"""Displays under the names of Adafruit's drivers."""

from __future__ import annotations

from typing import Any, ClassVar

from paneldraw import controllers
from paneldraw.compat.adafruit import buses
from paneldraw.compat.adafruit.drawing import Drawing
from paneldraw.controllers import Chip, Controller
from paneldraw.panel import Panel, Report, Updates
from paneldraw.transports import I2CTransport, SPITransport, Transport


class _Display(Drawing):
    """A panel and what is drawn for it.

    Attributes
    ----------
    panel : paneldraw.Panel
        What does the work; all that it can is here for scripts that move on.
    power : bool
        Whether the panel is on.
    """

    chip: ClassVar[Chip]

    def _start(self, transport: Transport, record: Controller, page_addressing: bool) -> None:
        super().__init__(record.width, record.height)
        self.pages = self.height // 8
        updates: Updates = "plain" if page_addressing else "least"
        self.panel = Panel(record, transport, contrast=255, updates=updates)
        self.power = True
        self.show()

    def show(self) -> Report:
        """Bring what was drawn onto the panel, by sending what differs from the last time."""
        return self.panel.show(self._pixels)

    def poweron(self) -> None:
        """Light the panel."""
        self.panel.wake()
        self.power = True

    def poweroff(self) -> None:
        """Turn the panel dark."""
        self.panel.sleep()
        self.power = False

    def contrast(self, contrast: int) -> None:
        """Set the brightness, 0 to 255."""
        self.panel.contrast(contrast)

    def invert(self, invert: bool) -> None:
        """Show lit pixels dark and dark ones lit, or as they are."""
        self.panel.invert(bool(invert))

    def rotate(self, rotate: bool) -> None:
        """Turn the panel: False is upside down, True as it was at first. The next `show` has it so."""
        self.panel.rotate = 0 if rotate else 180

    def write_cmd(self, cmd: int) -> None:
        """Send a byte of a command, as the datasheet has it."""
        self.panel.command(bytes((cmd,)))

    @classmethod
    def _record(cls, width: int, height: int, external_vcc: bool) -> Controller:
        """The module that Adafruit's driver means."""
        return cls.chip(width, height)


class _I2C(_Display):
    """A display on I2C.

    Parameters
    ----------
    width, height : int
        Pixels of the glass.
    i2c : busio.I2C, smbus2.SMBus, int or str
        Blinka's bus, or one of smbus2's, or its number or path.
    addr : int, optional
        The display's address. Default: 0x3C.
    external_vcc : bool, optional
        Whether the panel voltage comes from outside. Default: False.
    reset : digitalio.DigitalInOut, optional
        The reset pin. Default: none.
    page_addressing : bool, optional
        Address every run of bytes in full, with nothing assumed of the chip. Default: False.

    Raises
    ------
    PanelError
        The display cannot be reached; the message says what to do.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.adafruit import SSD1306_I2C
    >>> chip = simulator.SSD1306(128, 64)
    >>> display = SSD1306_I2C(128, 64, simulator.I2CBus({0x3C: chip}))
    >>> display.fill_rect(10, 10, 20, 5, 1)
    >>> display.show().wire_bytes
    26
    >>> int(chip.pixels.sum())
    100
    """

    def __init__(
        self,
        width: int,
        height: int,
        i2c: Any,
        *,
        addr: int = 0x3C,
        external_vcc: bool = False,
        reset: Any = None,
        page_addressing: bool = False,
    ) -> None:
        record = self._record(width, height, external_vcc)
        self.addr, self.external_vcc = addr, external_vcc
        pins = buses.Pins(reset=reset)
        bus = buses.I2C(i2c) if hasattr(i2c, "try_lock") else i2c
        transport = I2CTransport(bus, addr, reset=pins.line("reset"), pins=pins)
        self._start(transport, record, page_addressing)


class _SPI(_Display):
    """A display on SPI.

    Parameters
    ----------
    width, height : int
        Pixels of the glass.
    spi : busio.SPI or spidev.SpiDev
        Blinka's bus, or an open one of spidev's.
    dc, reset, cs : digitalio.DigitalInOut
        Pins of D/C, reset and chip select; the last two may be None.
    external_vcc : bool, optional
        Whether the panel voltage comes from outside. Default: False.
    baudrate, polarity, phase : int, optional
        Of Blinka's bus. Default: 8 000 000, 0 and 0.
    page_addressing : bool, optional
        Address every run of bytes in full, with nothing assumed of the chip. Default: False.
    """

    def __init__(
        self,
        width: int,
        height: int,
        spi: Any,
        dc: Any,
        reset: Any,
        cs: Any,
        *,
        external_vcc: bool = False,
        baudrate: int = 8_000_000,
        polarity: int = 0,
        phase: int = 0,
        page_addressing: bool = False,
    ) -> None:
        record = self._record(width, height, external_vcc)
        self.external_vcc = external_vcc
        pins = buses.Pins(dc=dc, reset=reset)
        bus = buses.SPI(spi, cs, baudrate, polarity, phase) if hasattr(spi, "try_lock") else spi
        transport = SPITransport(spi=bus, dc=pins.line("dc"), reset=pins.line("reset"), pins=pins, speed=baudrate)
        self._start(transport, record, page_addressing)


class _SSD1306(_Display):
    chip = controllers.SSD1306

    @classmethod
    def _record(cls, width: int, height: int, external_vcc: bool) -> Controller:
        return cls.chip(
            width,
            height,
            column_offset=(128 - width) // 2,
            com_pins=0x02 if width > 2 * height else 0x12,
            charge_pump=not external_vcc,
            internal_reference=True,
        )


class SSD1306_I2C(_SSD1306, _I2C):
    __doc__ = _I2C.__doc__


class SSD1306_SPI(_SSD1306, _SPI):
    __doc__ = _SPI.__doc__


class SH1106_I2C(_I2C):
    __doc__ = _I2C.__doc__
    chip = controllers.SH1106


class SH1106_SPI(_SPI):
    __doc__ = _SPI.__doc__
    chip = controllers.SH1106
