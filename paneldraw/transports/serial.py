"""Panels behind a microcontroller on a serial port, through pyserial and the link of `firmware_protocol`."""

from __future__ import annotations

import contextlib
import errno
import os
import time
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any, Final, NoReturn

from paneldraw.errors import (
    PanelBusyError,
    PanelDisconnectedError,
    PanelError,
    PanelNotFoundError,
    PanelPermissionError,
    PanelTimeoutError,
    ProtocolError,
    TransportError,
)
from paneldraw.transports.base import DATA, Cost, Plan, join_group, transient

if TYPE_CHECKING:
    from firmware_protocol import HelloReply, HostLink, LinkError, PanelFaultError, Status
    from firmware_protocol.runs import Run

PYSERIAL_URLS: Final = ("rfc2217", "socket", "loop")
"""What a port may be of pyserial's URLs: its other handlers write files, among other things."""
# A far end that has stopped reading must not hold the script for ever.
_WRITE_TIMEOUT: Final = 5.0
_DENIED: Final = (errno.EACCES, errno.EPERM)
_IN_USE: Final = (errno.EBUSY, errno.EAGAIN)
_MISSING: Final = (errno.ENOENT, errno.ENODEV, errno.ENXIO)
_NO_PORT: Final = (errno.ENOTTY, errno.EINVAL, errno.EISDIR)


class SerialTransport:
    """Commands and data for the panel behind a microcontroller that runs paneldraw's firmware.

    After an error the next call begins anew, on a port that has come back too.

    Parameters
    ----------
    port : str or object
        Name of the port's device, such as ``/dev/ttyACM0`` or ``COM3``; a URL of pyserial's, such as
        ``socket://host:port`` or ``rfc2217://host:port``; or an open port with pyserial's interface, which the
        transport takes over: it sets its rate and timeout, and closes it in the end.
    baudrate : int, optional
        Bits a second, one of those that the board offers. Default: the rate that the board likes best.
    timeout : float, optional
        Seconds that a call waits while the board answers and acknowledges nothing. Default: 3.0, as many boards
        restart when their port is opened.
    clock : callable, optional
        Seconds. Default: `time.monotonic`.

    Attributes
    ----------
    cost : Cost
    name : str
        The port's.
    link : firmware_protocol.HostLink
        The session, with its ``stats``.

    Raises
    ------
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        The port cannot be opened, or nothing on it speaks the protocol.
    ProtocolError
        The board's firmware is too old or too new.

    Examples
    --------
    >>> try:
    ...     SerialTransport("/dev/ttyACM99", 1_000_000)
    ... except PanelNotFoundError as error:
    ...     print(error.strerror.partition(";")[0])
    there is no port /dev/ttyACM99: plug the board in or check the name
    """

    # The headers of tokens. Those of short data are spared, which no plan would be much cheaper for knowing.
    cost = Cost(command=1, data=1)

    def __init__(
        self,
        port: Any,
        baudrate: int | None = None,
        *,
        timeout: float = 3.0,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        from firmware_protocol import HostLink

        if baudrate is not None and (isinstance(baudrate, bool) or not isinstance(baudrate, int)):
            raise TypeError(f"baudrate must be an int, not {baudrate!r}")
        if baudrate is not None and baudrate <= 0:
            raise ValueError(f"baudrate must be above 0, such as 115200, not {baudrate}")
        named = isinstance(port, (str, os.PathLike))
        if not named and not all(callable(getattr(port, name, None)) for name in ("read", "write", "open", "close")):
            raise TypeError(f"port must be a name, a URL or an object with pyserial's interface, not {port!r}")
        self._answered = False
        self._fresh = False  # whether nothing was sent since the last reset
        opened = open_port(os.fspath(port), timeout) if named else port
        self.name = str(getattr(opened, "name", None) or getattr(opened, "port", None) or type(opened).__name__)
        try:
            with self._translating():
                self.link: HostLink = HostLink(opened, baudrate=baudrate, timeout=timeout, clock=clock)
        except BaseException:
            if named:
                opened.close()
            raise

    @property
    def device(self) -> HelloReply:
        """What the board said of itself and its panel."""
        return self.link.device

    @property
    def wire(self) -> str:
        """The bus between board and panel: ``"i2c"``, ``"spi"``, or ``"serial"`` where the board has none."""
        return {1: "i2c", 2: "spi"}.get(self.device.bus, "serial")

    @property
    def baudrate(self) -> int:
        """The rate in use, bits a second."""
        return self.link.baudrate

    def status(self) -> Status:
        """Ask the board for its counters."""
        with self._translating():
            return self.link.status()

    def read_status(self) -> tuple[int, int]:
        """Have the board read the panel's status byte; return it, and the bytes on the wire."""
        from firmware_protocol import Feature

        if not self.device.features & Feature.READ:
            raise TransportError(errno.EOPNOTSUPP, f"the board on {self.name} cannot read from its panel")
        before = self.link.stats.bytes_sent
        with self._translating():
            status = self.link.read_panel()
        return status, self.link.stats.bytes_sent - before

    def command(self, payload: bytes) -> int:
        """Send one command message; return the bytes on the wire."""
        return self._write([(False, payload)], end=False)

    def data(self, payload: bytes) -> int:
        """Send one data message; return the bytes on the wire."""
        return self._write([(True, payload)], end=False)

    def batch(self, plan: Plan) -> int:
        """Send a plan, in as many frames as the board's memory asks for; return the bytes on the wire."""
        return self._write(((kind == DATA, payload) for kind, payload in plan), end=True)

    @property
    def store(self) -> int:
        """Bytes that the board keeps of sub-pictures to write them in turn; 0 where it does not."""
        return self.link.store

    @property
    def cycling(self) -> bool:
        """Whether the board writes sub-pictures in turn, as far as is known without asking."""
        return self.link.cycling

    def cycle(self, content: bytes, count: int) -> int:
        """Have the board write sub-pictures in turn until something else is sent; return the bytes on the wire."""
        before = self.link.stats.bytes_sent
        with self._translating():
            self.link.cycle(content, count)
        return self.link.stats.bytes_sent - before

    def reset(self) -> bool:
        """Have the board pulse the panel's reset line, unless nothing was sent since; return whether there is one."""
        if self.device.reset_line and not self._fresh:
            with self._translating():
                self.link.reset_panel()
            self._fresh = True
        return self.device.reset_line

    def close(self) -> None:
        """Leave the board at its first rate and close the port. Closing twice does nothing."""
        self.link.close()

    def _write(self, runs: Iterable[Run], end: bool) -> int:
        self._fresh = False
        with self._translating():
            wire = self.link.write(runs, end=end)
        self._answered = True
        return wire

    @contextlib.contextmanager
    def _translating(self) -> Iterator[None]:
        from firmware_protocol import LinkError

        try:
            yield
        except LinkError as error:
            raise self._translated(error) from error

    def _translated(self, error: LinkError) -> PanelError:
        import firmware_protocol as link

        text = str(error)
        match error:
            case link.PanelFaultError():
                return self._faulty(error)
            case link.VersionError():
                return ProtocolError(text)
            case link.NoDeviceError():
                return PanelNotFoundError(errno.ENODEV, text)
            case link.LinkTimeoutError():
                return PanelTimeoutError(errno.ETIMEDOUT, text)
            case link.DeviceResetError():
                return transient(TransportError(errno.ECONNRESET, f"{text}: show again, everything will be sent"))
            case link.LinkLostError():
                code = _code(error) or errno.ENODEV
                if code in _DENIED or code in _IN_USE:
                    return _not_opened(error, self.name)
                return PanelDisconnectedError(code, text)
        return TransportError(errno.EINVAL, text)

    def _faulty(self, error: PanelFaultError) -> PanelError:
        from firmware_protocol import Fault

        text = str(error)
        if error.fault in (Fault.ADDRESS_NACK, Fault.DATA_NACK):
            kind = PanelDisconnectedError if self._answered else PanelNotFoundError
            failed: TransportError = kind(errno.ENXIO, text)
        elif error.fault == Fault.BUS_STUCK:
            failed = PanelTimeoutError(errno.ETIMEDOUT, text)
        else:
            return ProtocolError(text)
        return transient(failed) if self._answered else failed


def open_port(name: str, patience: float) -> Any:
    """Return pyserial's port of a name, or raise what says why it cannot be had; `patience` is for writing."""
    import serial  # not needed by a script that never opens a port

    from firmware_protocol.line import PORT_ERRORS
    from firmware_protocol.messages import BASE_BAUDRATE

    scheme, elsewhere, _ = name.partition("://")
    if elsewhere and scheme.lower() not in PYSERIAL_URLS:
        kinds = ", ".join(f"{kind}://" for kind in PYSERIAL_URLS)
        raise ValueError(f"port must be a device or one of {kinds}, not {name!r}: no other handler is reached")
    timeout = None if "://" in name else min(patience, _WRITE_TIMEOUT)  # rfc2217 has none
    try:
        return serial.serial_for_url(name, BASE_BAUDRATE, exclusive=True, write_timeout=timeout)
    except PORT_ERRORS as error:
        if isinstance(error, ValueError):
            _refuse(name, error)
        raise _not_opened(error, name) from error


def _refuse(name: str, error: ValueError) -> NoReturn:
    known = "a device name or a URL that pyserial knows, such as socket://host:port"
    raise ValueError(f"port must be {known}, not {name!r} ({error})") from error


def _code(error: BaseException | None) -> int | None:
    """The system's error number behind an error, if it is told somewhere along the chain of causes."""
    while error is not None:
        for code in (getattr(error, "errno", None), *error.args[:1]):
            if isinstance(code, int):
                return code
        error = error.__cause__ or error.__context__
    return None


def _not_opened(error: Exception, name: str) -> TransportError:
    code = _code(error)
    if code in _DENIED:
        return PanelPermissionError(code, f"no permission to open {name}: {join_group(_group(name))}")
    if code in _IN_USE:
        return PanelBusyError(code, f"{name} is in use: close the other program that has it open and try again")
    if "://" in name:
        return PanelNotFoundError(code, f"cannot open {name}: check the address and that its server runs ({error})")
    if code in _MISSING:
        there = ", ".join(_ports())
        others = f"; there is {there}" if there else "; no other port is there either"
        return PanelNotFoundError(code, f"there is no port {name}: plug the board in or check the name{others}")
    if code in _NO_PORT:
        return PanelNotFoundError(code, f"{name} is no serial port: see `paneldraw firmware ports` for those there are")
    return TransportError(code, f"cannot open {name}: {error}; plug the board out and in again")


def _group(name: str) -> str:
    """The group that may open a port, as far as the system tells."""
    try:
        import grp

        group = grp.getgrgid(os.stat(name).st_gid).gr_name
    except (ImportError, OSError, KeyError):
        return "dialout"
    return group if group != "root" else "dialout"


def _ports() -> list[str]:
    from serial.tools import list_ports

    return sorted(port.device for port in list_ports.comports() if port.hwid != "n/a")
