"""Blinka's buses and pins, with the interfaces of smbus2, spidev and gpiod that transports know."""

from __future__ import annotations

import ctypes
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_READ = 0x1


@contextmanager
def locked(bus: Any) -> Iterator[None]:
    """Hold a bus of Blinka's, which threads share."""
    while not bus.try_lock():
        time.sleep(0)
    try:
        yield
    finally:
        bus.unlock()


class I2C:
    """A ``busio.I2C`` with smbus2's interface; each message is a transfer of its own."""

    def __init__(self, bus: Any) -> None:
        self._bus = bus

    def i2c_rdwr(self, *messages: Any) -> int:
        """Carry smbus2's messages; return how many."""
        with locked(self._bus):
            for message in messages:
                if message.flags & _READ:
                    answer = bytearray(message.len)
                    self._bus.readfrom_into(message.addr, answer)
                    ctypes.memmove(message.buf, bytes(answer), message.len)
                else:
                    self._bus.writeto(message.addr, bytes(message))
        return len(messages)


class SPI:
    """A ``busio.SPI`` and its chip select with spidev's interface."""

    def __init__(self, bus: Any, select: Any, baudrate: int, polarity: int, phase: int) -> None:
        self._bus, self._select = bus, select
        self._settings = {"baudrate": baudrate, "polarity": polarity, "phase": phase}
        if select is not None:
            select.switch_to_output(value=True)

    def writebytes2(self, payload: Any) -> None:
        """Send bytes in one chip select."""
        with locked(self._bus):
            self._bus.configure(**self._settings)
            self._choose(True)
            try:
                self._bus.write(payload)
            finally:
                self._choose(False)

    def _choose(self, chosen: bool) -> None:
        if self._select is not None:
            self._select.value = not chosen


class Pins:
    """``DigitalInOut`` objects, by names, as transports set lines."""

    def __init__(self, **pins: Any) -> None:
        self._pins = {name: pin for name, pin in pins.items() if pin is not None}
        for name, pin in self._pins.items():
            if not hasattr(pin, "switch_to_output"):
                raise TypeError(f"{name} must be a digitalio.DigitalInOut, not {pin!r}")
            pin.switch_to_output(value=name != "dc")

    def line(self, name: str) -> str | None:
        """Return the name of a line, if there is a pin for it."""
        return name if name in self._pins else None

    def set(self, line: str, value: bool) -> None:
        """Put a line high or low."""
        self._pins[line].value = value
