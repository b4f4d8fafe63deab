"""As much of MicroPython's ``machine`` as drivers of panels use: its buses and output pins, on Linux's.

Wires and clock rates of a bus are Linux's affair (on a Raspberry Pi ``/boot/firmware/config.txt``): what a script says
of them is taken and not heeded.
"""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar

from paneldraw.transports.i2c import I2CTransport, probe
from paneldraw.transports.pins import GPIO, Line, Pins
from paneldraw.transports.spi import SPITransport

if TYPE_CHECKING:
    from typing_extensions import Buffer

__all__ = ["I2C", "SPI", "Pin", "SoftI2C", "SoftSPI"]


class I2C:
    """An I2C bus, through smbus2.

    Parameters
    ----------
    id : int, str or object, default 1
        Number of the bus or path of its device, or an open object with the interface of `smbus2.SMBus`. A Raspberry
        Pi's header has bus 1.
    scl, sda, freq, timeout
        Not heeded.

    Raises
    ------
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        The bus cannot be opened. All are an ``OSError``, and so is what any call raises where nobody acknowledges.

    Notes
    -----
    Linux ends every call with a STOP. What a script writes with ``stop=False`` waits for its next call, and goes out
    joined to it.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.machine import I2C
    >>> i2c = I2C(simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)}))
    >>> i2c.scan()
    [60]
    >>> i2c.writevto(0x3C, (b"\\x00", b"\\xa5\\xaf"))
    3
    """

    def __init__(
        self,
        id: Any = 1,
        scl: object = None,
        sda: object = None,
        *,
        freq: int | None = None,
        timeout: int | None = None,
    ) -> None:
        from smbus2 import i2c_msg

        self._transport = I2CTransport(id)
        self._message = i2c_msg
        self._waiting: list[Any] = []

    def init(self, *arguments: object, **more: object) -> None:
        """Do nothing: the bus is ready."""

    def deinit(self) -> None:
        """Close the bus, if it was opened here."""
        self._transport.close()

    def scan(self) -> list[int]:
        """Return the addresses from 0x08 to 0x77 where somebody answers."""
        found = []
        for address in range(0x08, 0x78):
            with suppress(OSError):
                probe(self._transport.bus, address)
                found.append(address)
        return found

    def writeto(self, addr: int, buf: Buffer, stop: bool = True, /) -> int:
        """Write bytes; return how many were acknowledged: all."""
        return self.writevto(addr, (buf,), stop)

    def writevto(self, addr: int, vector: Iterable[Buffer], stop: bool = True, /) -> int:
        """Write the bytes of several buffers as one message; return how many were acknowledged: all."""
        data = b"".join(vector)
        self._waiting.append(self._message.write(addr, data))
        if stop:
            self._transfer()
        return len(data)

    def readfrom(self, addr: int, nbytes: int, stop: bool = True, /) -> bytes:
        """Read so many bytes."""
        message = self._message.read(addr, nbytes)
        self._waiting.append(message)
        self._transfer()
        return bytes(message)

    def readfrom_into(self, addr: int, buf: Buffer, stop: bool = True, /) -> None:
        """Read as many bytes as a buffer has."""
        view = memoryview(buf).cast("B")
        view[:] = self.readfrom(addr, len(view), stop)

    def readfrom_mem(self, addr: int, memaddr: int, nbytes: int, *, addrsize: int = 8) -> bytes:
        """Read from a register on."""
        self.writeto(addr, memaddr.to_bytes(addrsize // 8, "big"), False)
        return self.readfrom(addr, nbytes)

    def readfrom_mem_into(self, addr: int, memaddr: int, buf: Buffer, *, addrsize: int = 8) -> None:
        """Read from a register on, as many bytes as a buffer has."""
        view = memoryview(buf).cast("B")
        view[:] = self.readfrom_mem(addr, memaddr, len(view), addrsize=addrsize)

    def writeto_mem(self, addr: int, memaddr: int, buf: Buffer, *, addrsize: int = 8) -> None:
        """Write from a register on."""
        self.writevto(addr, (memaddr.to_bytes(addrsize // 8, "big"), buf))

    def _transfer(self) -> None:
        messages, self._waiting = self._waiting, []
        self._transport.bus.i2c_rdwr(*messages)


class SoftI2C(I2C):
    """The same bus: Linux has its own for wires elsewhere (``dtoverlay=i2c-gpio``).

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.machine import Pin, SoftI2C
    >>> SoftI2C(Pin(22), Pin(21), freq=400_000, bus=simulator.I2CBus()).scan()
    []
    """

    def __init__(
        self, scl: object = None, sda: object = None, *, freq: int = 400_000, timeout: int = 50_000, bus: Any = 1
    ) -> None:
        super().__init__(bus)


class SPI:
    """An SPI bus, through spidev.

    Parameters
    ----------
    id : int or object, default 0
        Number of the bus, whose first chip select is taken, or an open object with the interface of
        ``spidev.SpiDev``. A Raspberry Pi's header has bus 0.
    baudrate : int, default 1 000 000
        Clock rate in Hz.
    polarity, phase : {0, 1}, default 0
    bits, firstbit, sck, mosi, miso
        Not heeded.

    Raises
    ------
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        The bus cannot be opened.

    Notes
    -----
    Linux drives the chip select that goes with the bus. A script that drives one of its own besides is given a pin
    that goes nowhere: ``Pin(None)``.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.machine import SPI
    >>> bus = simulator.SPIBus(simulator.SSD1306(128, 64))
    >>> SPI(bus.spi, baudrate=10_000_000).write(b"\\xaf")
    >>> bus.bytes
    1
    """

    MSB = 0
    LSB = 1

    def __init__(
        self, id: Any = 0, baudrate: int = 1_000_000, *, polarity: int = 0, phase: int = 0, **more: object
    ) -> None:
        self._transport: SPITransport | None = None
        if isinstance(id, int):
            self._transport = SPITransport(id, 0, dc=None, reset=None)
        self._spi: Any = id if self._transport is None else self._transport.spi
        self.init(baudrate, polarity=polarity, phase=phase)

    def init(self, baudrate: int | None = None, *, polarity: int = 0, phase: int = 0, **more: object) -> None:
        """Set clock rate and mode."""
        if baudrate is not None:
            self._spi.max_speed_hz = baudrate
        self._spi.mode = 2 * polarity + phase

    def deinit(self) -> None:
        """Close the bus, if it was opened here."""
        if self._transport is not None:
            self._transport.close()

    def write(self, buf: Buffer, /) -> None:
        """Write bytes."""
        self._spi.writebytes2(bytes(buf))

    def read(self, nbytes: int, write: int = 0, /) -> bytes:
        """Read so many bytes while a byte is written over and over."""
        return bytes(self._spi.xfer3([write] * nbytes))

    def readinto(self, buf: Buffer, write: int = 0, /) -> None:
        """Read as many bytes as a buffer has while a byte is written over and over."""
        view = memoryview(buf).cast("B")
        view[:] = self.read(len(view), write)

    def write_readinto(self, write_buf: Buffer, read_buf: Buffer, /) -> None:
        """Write bytes, and read as many meanwhile."""
        view = memoryview(read_buf).cast("B")
        view[:] = bytes(self._spi.xfer3(list(bytes(write_buf))))


SoftSPI = SPI


class Pin:
    """An output pin, through gpiod.

    Parameters
    ----------
    id : int, str or None
        Number on the header's GPIO chip (BCM's, not the pin's), or the line's name. None is a pin that goes nowhere.
    mode : int, optional
        `Pin.OUT`. Default: none; the line is taken when it is made an output.
    pull, drive, alt
        Not heeded.
    value : int, optional
        Level that it starts with. Default: 0.
    pins : object, optional
        An object with a method ``set(line, value)``. Default: the lines of this machine.

    Raises
    ------
    NotImplementedError
        If it is made an input: take ``gpiozero.Button``.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> from paneldraw.compat.machine import Pin
    >>> bus = simulator.SPIBus(simulator.SSD1306())
    >>> dc = Pin(24, Pin.OUT, pins=bus.pins)
    >>> dc(1)
    >>> dc.value()
    1
    """

    IN = 0
    OUT = 1
    OPEN_DRAIN = 2
    PULL_UP = 1
    PULL_DOWN = 2

    _lines: ClassVar[dict[Line, GPIO]] = {}
    """The lines of this machine that scripts made outputs: making one again is no conflict."""

    def __init__(
        self,
        id: Line | None,
        mode: int = -1,
        pull: int = -1,
        *,
        value: Any = None,
        drive: int = 0,
        alt: int = -1,
        pins: Pins | None = None,
    ) -> None:
        self._line, self._pins, self._value = id, pins, 0
        self.init(mode, pull, value=value)

    def init(self, mode: int = -1, pull: int = -1, *, value: Any = None, drive: int = 0, alt: int = -1) -> None:
        """Make it an output, and set its level."""
        if mode == self.IN:
            raise NotImplementedError("pins of paneldraw.compat.machine are outputs; for an input take gpiozero.Button")
        if mode != -1 and self._line is not None and self._pins is None:
            if self._line not in self._lines:
                gpio = GPIO(None)
                gpio.claim(self._line, high=bool(value))
                self._lines[self._line] = gpio
            self._pins = self._lines[self._line]
        if value is not None:
            self.value(value)

    def value(self, x: Any = None, /) -> int | None:
        """Set the level, or, with none given, return the one that was set last."""
        if x is None:
            return self._value
        self._value = int(bool(x))
        if self._pins is not None:
            self._pins.set(self._line, bool(x))
        return None

    __call__ = value

    def on(self) -> None:
        """Put it high."""
        self.value(1)

    def off(self) -> None:
        """Put it low."""
        self.value(0)

    high, low = on, off

    def toggle(self) -> None:
        """Put it to the other level."""
        self.value(not self._value)
