"""Panels on an SPI bus, through spidev and gpiod."""

from __future__ import annotations

import errno
import glob
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelNotFoundError,
    PanelPermissionError,
    PanelTimeoutError,
    TransportError,
)
from paneldraw.transports.base import DATA, Cost, Plan, join_group, transient
from paneldraw.transports.pins import Line, PanelLines, Pins, package

BUFSIZ: Final = Path("/sys/module/spidev/parameters/bufsiz")
"""Bytes that the kernel takes in one chip select; it splits nothing, but spidev's ``writebytes2`` does."""
_USUAL_BUFSIZ: Final = 4096
_GONE: Final = (errno.ENODEV, errno.ENXIO, errno.ESHUTDOWN)
_BUSY: Final = (errno.EAGAIN, errno.EBUSY)


class SPITransport:
    """Commands and data for the panel at one chip select of an SPI bus.

    Parameters
    ----------
    bus, device : int, optional
        Bus and chip select: ``/dev/spidevBUS.DEVICE``. Default: 0 and 0, pin 24 of a Raspberry Pi's header.
    dc : int, str or None, optional
        GPIO line of the D/C pin, a number on the header's chip (BCM's, not the pin's) or the line's name. Default: 24,
        pin 18. None for chips without one: each message is then one chip select.
    reset : int, str or None, optional
        The same of the reset pin, which is pulsed here and by `reset`. Default: 25, pin 22.
    speed : int, optional
        Clock rate in Hz. Default: 8 000 000, which all chips take but the slowest (PCD8544: 4 000 000).
    cs_high : bool, optional
        Whether the chip select is high while the chip listens, as the ST7920's is. Default: False.
    spi : object, optional
        An open object with the interface of ``spidev.SpiDev``, which remains the caller's to set up and to close.
    pins : object, optional
        An object with a method ``set(line, value)``, which remains the caller's. Default: the lines through gpiod.
    gpiochip : int or str, optional
        Number or path of the GPIO chip that has the lines. Default: the header's.

    Raises
    ------
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        The bus or a line cannot be opened.
    PanelError
        spidev or gpiod is not installed.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> bus = simulator.SPIBus(simulator.SSD1306(128, 64))
    >>> SPITransport(spi=bus.spi, pins=bus.pins).command(b"\\xaf")  # bytes on the wire
    1
    """

    wire = "spi"

    def __init__(
        self,
        bus: int = 0,
        device: int = 0,
        *,
        dc: Line | None = 24,
        reset: Line | None = 25,
        speed: int = 8_000_000,
        cs_high: bool = False,
        spi: Any = None,
        pins: Pins | None = None,
        gpiochip: int | str | None = None,
    ) -> None:
        for name, value, least in (("bus", bus, 0), ("device", device, 0), ("speed", speed, 1)):
            if isinstance(value, bool) or not isinstance(value, int):
                raise TypeError(f"{name} must be an int, not {value!r}")
            if value < least:
                raise ValueError(f"{name} must be {least} or more, not {value}")
        self.name = f"/dev/spidev{bus}.{device}" if spi is None else type(spi).__name__
        self.speed, self.cs_high = speed, cs_high
        self._longest = _bufsiz() if dc is None else None
        self.cost = Cost(0, 0, longest=self._longest)
        self.spi = self._open(bus, device) if spi is None else spi
        self._owned = spi is None
        self._write: Callable[[Any], object] = _closed
        try:
            writes = _writes(self.spi)
            self._lines = PanelLines(dc, reset, pins, gpiochip)
        except BaseException:
            self._close_device()
            raise
        self._write = writes

    def command(self, payload: bytes) -> int:
        """Send one command message; return the bytes on the wire."""
        return self._message(False, payload)

    def data(self, payload: bytes) -> int:
        """Send one data message; return the bytes on the wire."""
        return self._message(True, payload)

    def batch(self, plan: Plan) -> int:
        """Send a plan, a chip select a message; return the bytes on the wire."""
        lines, write = self._lines, self._write
        lines.fresh = False
        try:
            for kind, payload in plan:
                data = kind == DATA
                if data is not lines.data:
                    lines.set_data(data)
                write(payload)
        except (OSError, SystemError) as error:
            raise self._translated(error) from error
        return plan.cost

    def reset(self) -> bool:
        """Pulse the reset line unless nothing was sent since the last time; return whether there is one."""
        return self._lines.reset()

    def close(self) -> None:
        """Close what was opened here. Closing twice does nothing."""
        self._write = _closed
        self._lines.close()
        self._close_device()

    def _message(self, data: bool, payload: bytes) -> int:
        if self._longest is not None and len(payload) > self._longest:
            raise ValueError(f"a message must be at most {self._longest} bytes, not {len(payload)}")
        self._lines.fresh = False
        try:
            if data is not self._lines.data:
                self._lines.set_data(data)
            self._write(payload)
        except (OSError, SystemError) as error:
            raise self._translated(error) from error
        return len(payload)

    def _open(self, bus: int, device: int) -> Any:
        spi = package("spidev").SpiDev()
        try:
            spi.open(bus, device)
            if spi.mode != 0:
                spi.mode = 0
            spi.max_speed_hz = self.speed
            if self.cs_high:
                spi.cshigh = True
        except OSError as error:
            spi.close()
            raise self._not_opened(error) from error
        return spi

    def _close_device(self) -> None:
        if self._owned and self.spi is not None:
            self.spi.close()
            self.spi = None

    def _not_opened(self, error: OSError) -> TransportError:
        code = error.errno
        if code in (errno.EACCES, errno.EPERM):
            return PanelPermissionError(code, f"no permission to open {self.name}: {join_group('spi')}")
        if code in (errno.ENOENT, *_GONE):
            there = ", ".join(sorted(glob.glob("/dev/spidev*")))
            advice = "enable SPI (on a Raspberry Pi: `sudo raspi-config nonint do_spi 0`, then reboot)"
            others = f"; there is {there}" if there else ""
            return PanelNotFoundError(code, f"there is no {self.name}: {advice}{others}")
        if code in _BUSY:
            return PanelBusyError(code, f"{self.name} is in use: end the other program that has it open")
        return self._translated(error)

    def _translated(self, error: OSError | SystemError) -> TransportError:
        if isinstance(error, TransportError):
            return error
        code = error.errno if isinstance(error, OSError) else errno.EIO  # what spidev makes of a short write
        if code in _GONE:
            return PanelDisconnectedError(code, f"{self.name} is gone: plug the adapter in and open a new transport")
        if code == errno.EINVAL:
            advice = f"not {self.speed} Hz perhaps; try a lower speed, such as speed=1000000"
            return TransportError(code, f"{self.name} does not take these settings: {advice}")
        if code == errno.EMSGSIZE:
            advice = "add spidev.bufsiz=65536 to the kernel's command line"
            return TransportError(code, f"{self.name} takes no messages this long: {advice}")
        if code in _BUSY:
            return transient(PanelBusyError(code, f"{self.name} is busy: is another program using it?"))
        if code == errno.ETIMEDOUT:
            return transient(PanelTimeoutError(code, f"no end of a transfer on {self.name}: try a lower speed"))
        reason = getattr(error, "strerror", None) or error
        failed = TransportError(code, f"cannot write to {self.name}: {reason}; check the panel's wiring and power")
        return transient(failed) if code == errno.EIO else failed


def _closed(payload: Any) -> None:
    raise TransportError(errno.EBADF, "the transport is closed: open a new one")


def _bufsiz() -> int:
    try:
        return int(BUFSIZ.read_text())
    except (OSError, ValueError):
        return _USUAL_BUFSIZ


def _writes(spi: Any) -> Callable[[Any], object]:
    """Return what sends a buffer through an object with spidev's interface."""
    whole = getattr(spi, "writebytes2", None)
    if callable(whole):
        return whole  # type: ignore[no-any-return]
    pieces = getattr(spi, "writebytes", None) or getattr(spi, "xfer2", None)
    if not callable(pieces):
        raise TypeError(f"spi must have spidev's writebytes2, writebytes or xfer2, not be {spi!r}")

    def write(payload: Any) -> None:
        for start in range(0, len(payload), _USUAL_BUFSIZ):
            pieces(list(payload[start : start + _USUAL_BUFSIZ]))

    return write
