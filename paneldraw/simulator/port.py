"""A simulated serial port: a pseudo-terminal, and a thread that is the board behind it."""

from __future__ import annotations

import contextlib
import os
import selectors
import shutil
import tempfile
import threading
import time
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from firmware_protocol import Device

_TICK: Final = 0.5
"""Seconds between looks of an idle board at its panel."""
_CHARACTER: Final = 10
"""Bits of one byte on the line."""


class SerialPort:
    """A serial port that programs open by its path, with a board on its far end; a context manager that unplugs it.

    Parameters
    ----------
    device : firmware_protocol.Device
        The board.
    name : str
        What the port is called. Default: ``ttyACM0``.
    power : callable, optional
        Called when the board, and its panel with it, lost its supply and has it again: ``chip.power_cycle``, say.
    noise : callable, optional
        Turns the bytes of either direction into those that arrive. Default: all arrive.
    realtime : bool
        Whether bytes take as long as they do at the rate of the line. Default: False.

    Attributes
    ----------
    path : str
        A link in a folder of its own to the pseudo-terminal; the same after `plug`.
    bytes : int
        Bytes that came from the host.

    Raises
    ------
    OSError
        On systems without pseudo-terminals, such as Windows.

    Notes
    -----
    As with a real board nothing holds the host back: an answer that nobody reads is lost once the port is full.

    Examples
    --------
    >>> from firmware_protocol import Device
    >>> from paneldraw.transports import SerialTransport
    >>> with SerialPort(Device(lambda content: None)) as port:
    ...     transport = SerialTransport(port.path)
    ...     transport.device.controller
    ...     transport.close()
    'ssd1306'
    """

    def __init__(
        self,
        device: Device,
        name: str = "ttyACM0",
        *,
        power: Callable[[], object] = lambda: None,
        noise: Callable[[bytes], bytes] | None = None,
        realtime: bool = False,
    ) -> None:
        if not hasattr(os, "openpty"):
            raise OSError("a simulated serial port needs a pseudo-terminal, which this system has not; try sim://")
        self.device = device
        self.noise = noise
        self.realtime = realtime
        self.bytes = 0
        self._power = power
        self._plug: int | None = None  # closed, it ends the thread
        self._thread: threading.Thread | None = None
        self._lock = threading.Lock()
        folder = tempfile.mkdtemp(prefix=f"paneldraw-{os.getpid()}-")
        self._tidy = weakref.finalize(self, _remove, folder, os.getpid())  # at the end of the script, if not before
        self.path = os.path.join(folder, name)
        try:
            self.plug()
        except BaseException:
            self.close()
            raise

    @property
    def plugged(self) -> bool:
        """Whether the board is plugged in."""
        return self._plug is not None

    def plug(self) -> None:
        """Plug the board in again, under the same path; it starts anew, as its supply was away."""
        import tty

        with self._lock:
            if self._plug is not None:
                return
            if not self._tidy.alive:
                raise ValueError("the port is closed: make a new one")
            if self._thread is not None:
                self._power()
            far, near = os.openpty()
            tty.setraw(near)
            os.set_blocking(far, False)
            os.symlink(os.ttyname(near), self.path)
            pulled, self._plug = os.pipe()
            self._thread = threading.Thread(target=self._live, args=(far, near, pulled), name=self.path, daemon=True)
            self._thread.start()

    def unplug(self) -> None:
        """Pull the board out: programs that have the port open find it gone. Unplugging twice does nothing."""
        with self._lock:
            plug, self._plug = self._plug, None
            if plug is None:
                return
            os.unlink(self.path)
            os.close(plug)
        if self._thread is not threading.current_thread() and self._thread is not None:
            self._thread.join()

    def close(self) -> None:
        """Unplug the board for good. Closing twice does nothing."""
        self.unplug()
        self._tidy()

    def __enter__(self) -> SerialPort:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # the board

    def _live(self, far: int, near: int, pulled: int) -> None:
        """Be the board, until the plug is pulled; `near` is held so that the terminal keeps its settings."""
        try:
            self._say(far, self.device.reset(1))
            with selectors.DefaultSelector() as ready:
                ready.register(far, selectors.EVENT_READ)
                ready.register(pulled, selectors.EVENT_READ)
                while True:
                    keys = {key.fd for key, _ in ready.select(_TICK)}
                    if pulled in keys:
                        return
                    if far in keys:
                        self._hear(far)
                    else:
                        self.device.tick()
        finally:
            for handle in (far, near, pulled):
                os.close(handle)

    def _hear(self, far: int) -> None:
        data = os.read(far, 4096)
        self.bytes += len(data)
        start, rate = time.monotonic(), self.device.baudrate
        answer = self.device.receive(self.noise(data) if self.noise else data)
        if self.realtime:  # the board writes to its panel while more is coming
            end = start + _CHARACTER * (len(data) + len(answer)) / rate
            time.sleep(max(0.0, end - time.monotonic()))
        self._say(far, answer)

    def _say(self, far: int, data: bytes) -> None:
        with contextlib.suppress(BlockingIOError):
            os.write(far, self.noise(data) if self.noise else data)


def _remove(folder: str, process: int) -> None:
    if os.getpid() == process:  # a forked child's port is its parent's
        shutil.rmtree(folder, ignore_errors=True)
