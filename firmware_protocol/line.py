"""A pyserial port that carries messages: opening, rates, bytes in and out, and what its errors mean."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import Any, NoReturn

from firmware_protocol.errors import LinkLostError
from firmware_protocol.frames import FrameDecoder, wire_size
from firmware_protocol.messages import BASE_BAUDRATE, Message, decode

try:
    import termios

    PORT_ERRORS: tuple[type[Exception], ...] = (OSError, ValueError, termios.error)
except ImportError:  # Windows
    PORT_ERRORS = (OSError, ValueError)

#: Bytes of the shortest message a device sends; waiting for all of them at once saves half the system calls.
SHORTEST = wire_size(1)

_READ_TIMEOUT = 0.005
#: Bytes taken at a time, however many wait.
_MOST = 4096


@dataclass
class LinkStats:
    """What a `HostLink` has done so far, in bytes and in times."""

    bytes_sent: int = 0
    bytes_received: int = 0
    frames: int = 0
    resent: int = 0
    naks: int = 0
    timeouts: int = 0
    damaged: int = 0
    sessions: int = 0


class Line:
    """Sends bytes and receives messages over a pyserial port.

    Parameters
    ----------
    port : pyserial port
        Its ``timeout`` and ``baudrate`` are set here.

    Attributes
    ----------
    lost : bool
        Whether the port has failed; `open` tries it again.
    """

    def __init__(self, port: Any) -> None:
        self.port = port
        self.stats = LinkStats()
        self.lost = False
        self._decoder = FrameDecoder()

    @property
    def name(self) -> str:
        """The port's name."""
        return str(getattr(self.port, "name", None) or "the port")

    @property
    def baudrate(self) -> int:
        """Bits a second."""
        return int(self.port.baudrate)

    def set_rate(self, rate: int) -> None:
        """Change the rate; one of `PORT_ERRORS` where the adapter cannot."""
        if self.port.baudrate != rate:
            self.port.baudrate = rate

    def open(self) -> None:
        """Make the port ready at the first rate, opening it again if it was lost; LinkLostError if it is not there."""
        try:
            if self.lost or not self.port.is_open:
                self.port.close()
                self.port.baudrate = BASE_BAUDRATE
                self.port.open()
                self.lost = False
            self.port.timeout = _READ_TIMEOUT
            self.set_rate(BASE_BAUDRATE)
        except PORT_ERRORS as error:
            self.lost = True
            raise LinkLostError(f"{self.name} does not open ({error}); plug the board in and try again") from error
        with suppress(AttributeError, NotImplementedError, *PORT_ERRORS):
            self.port.set_low_latency_mode(True)
        self._decoder.clear()

    def close(self) -> None:
        """Send what is left and close the port."""
        with suppress(*PORT_ERRORS):
            self.port.flush()
        with suppress(*PORT_ERRORS):
            self.port.close()

    def send(self, data: bytes) -> None:
        """Write bytes; LinkLostError if the port is gone."""
        self.stats.bytes_sent += len(data)
        try:
            self.port.write(data)
        except PORT_ERRORS as error:
            self._lose(error)

    def receive(self) -> list[Message]:
        """Return the messages that have come; waits a little where there are none. LinkLostError as in `send`."""
        try:
            waiting = min(self.port.in_waiting, _MOST)
            data = self.port.read(max(waiting, SHORTEST - self._decoder.held, 1))
        except PORT_ERRORS as error:
            self._lose(error)
        self.stats.bytes_received += len(data)
        messages = []
        for frame in self._decoder.feed(data):
            if frame is None:
                self.stats.damaged += 1
            else:
                with suppress(ValueError):
                    messages.append(decode(frame))
        return messages

    def _lose(self, error: Exception) -> NoReturn:
        self.lost = True
        raise LinkLostError(f"{self.name} is gone ({error}); plug the board in again and go on") from error
