"""Blinka's buses and pins, on simulated ones."""

from __future__ import annotations

from typing import Any

import smbus2

from paneldraw import simulator


class Busio:
    """``busio.I2C`` on a simulated bus."""

    def __init__(self, bus: Any) -> None:
        self._bus = bus
        self._locked = False

    def try_lock(self) -> bool:
        taken, self._locked = not self._locked, True
        return taken

    def unlock(self) -> None:
        self._locked = False

    def deinit(self) -> None:
        self._locked = True

    def writeto(self, address: int, buffer: Any, *, start: int = 0, end: int | None = None) -> None:
        assert self._locked
        self._bus.i2c_rdwr(smbus2.i2c_msg.write(address, bytes(buffer[start:end])))

    def readfrom_into(self, address: int, buffer: Any) -> None:
        assert self._locked
        answer = smbus2.i2c_msg.read(address, len(buffer))
        self._bus.i2c_rdwr(answer)
        buffer[:] = bytes(answer)


class BusioSPI(Busio):
    """``busio.SPI`` on a simulated bus."""

    def configure(self, *, baudrate: int, polarity: int, phase: int) -> None:
        assert self._locked
        self._bus.spi.max_speed_hz, self._bus.spi.mode = baudrate, 2 * polarity + phase

    def write(self, buffer: Any) -> None:
        assert self._locked
        self._bus.spi.writebytes2(bytes(buffer))


class Pin:
    """``digitalio.DigitalInOut`` on a simulated bus."""

    def __init__(self, bus: simulator.SPIBus, line: int) -> None:
        self._bus, self._line = bus, line

    def switch_to_output(self, value: bool = False) -> None:
        self.value = value

    def __setattr__(self, name: str, value: Any) -> None:
        if name == "value":
            self._bus.pins.set(self._line, bool(value))
        else:
            super().__setattr__(name, value)
