"""Three ways to a simulated bus for a program on the real smbus2: a kernel played below smbus2, here; the library for
LD_PRELOAD; and the i2c-dev of a real kernel, user-mode Linux's. The same tests take each, as I2C_LANE says.
"""

from __future__ import annotations

import ctypes
import errno
import os
import threading
from contextlib import contextmanager
from pathlib import Path

import smbus2
from user_mode_linux import ADAPTER

from paneldraw import simulator
from paneldraw.simulator.bus import Message
from paneldraw.simulator.kernel import i2c_dev

LANE = os.environ.get("I2C_LANE", "patched")
PATH = "/dev/i2c-1"
DMA_SAFE = 0x0200
"""A flag that i2c-dev adds for its adapters."""


class Bus(simulator.I2CBus):
    """A simulated bus that notes the calls of I2C_RDWR, read and write: flags and bytes of each message."""

    def __init__(self, devices):
        super().__init__(devices)
        self.calls = []

    def transfer(self, messages):
        self.calls.append([(m.flags, m.payload if m.length is None else bytes(m.length)) for m in messages])
        return super().transfer(messages)


class Kernel:
    """What smbus2 calls of os and fcntl, with one bus; descriptors that are open, and errors for those that open."""

    O_RDWR = os.O_RDWR

    def __init__(self, bus):
        self.bus = bus
        self.files = {}
        self.paths = {PATH}
        self.open_error = None

    def open(self, path, flags):
        if self.open_error:
            raise OSError(self.open_error, os.strerror(self.open_error))
        if path not in self.paths:
            raise FileNotFoundError(errno.ENOENT, "No such file or directory")
        descriptor = max(self.files, default=4710) + 1
        self.files[descriptor] = i2c_dev.I2CFile(self.bus)
        return descriptor

    def close(self, descriptor):
        del self.files[descriptor]

    def read(self, descriptor, count):
        return self.files[descriptor].read(count)

    def write(self, descriptor, payload):
        return self.files[descriptor].write(payload)

    def ioctl(self, descriptor, request, argument):
        if descriptor is None:
            raise TypeError("argument must be an int, or have a fileno() method.")
        file = self.files[descriptor]
        if request not in (i2c_dev.I2C_RDWR, i2c_dev.I2C_SMBUS, i2c_dev.I2C_FUNCS):
            file.set(request, argument & 0xFFFFFFFFFFFFFFFF)
            return 0
        if isinstance(argument, int):
            raise OSError(errno.EFAULT, "Bad address")
        if request == i2c_dev.I2C_RDWR:
            return self.rdwr(file, argument)
        if request == i2c_dev.I2C_SMBUS:
            self._smbus(file, argument)
        else:
            argument.value = self.bus.funcs
        return 0

    def rdwr(self, file, call):
        count = call.nmsgs if call.msgs else 0
        raw = [(call.msgs[i], ctypes.cast(call.msgs[i].buf, ctypes.c_void_p).value) for i in range(count)]
        if any(m.len and place and place < 4096 for m, place in raw):
            raise OSError(errno.EFAULT, "Bad address")
        messages = [Message.of(m.addr, m.flags, m.len, ctypes.string_at(place, m.len)) for m, place in raw]
        done = file.rdwr(messages)
        for (_, place), message in zip(raw, messages, strict=True):
            ctypes.memmove(place, message.answer, len(message.answer))
        return done

    def _smbus(self, file, call):
        place = ctypes.cast(call.data, ctypes.c_void_p).value
        command = call.command if isinstance(call.command, int) else call.command[0]
        direction = call.read_write if isinstance(call.read_write, int) else call.read_write[0]
        answer = file.smbus(direction, command, call.size, ctypes.string_at(place, 34) if place else None)
        if answer:
            ctypes.memmove(place, answer, len(answer))


@contextmanager
def patched(bus, monkeypatch):
    """Below smbus2."""
    kernel = Kernel(bus)
    monkeypatch.setattr(smbus2.smbus2, "os", kernel)
    monkeypatch.setattr(smbus2.smbus2, "ioctl", kernel.ioctl)
    yield kernel


@contextmanager
def preloaded(bus, monkeypatch):
    """The library is in this very process already, and looks for the server where the environment says."""
    from paneldraw.simulator.preload import Preload

    with Preload({1: bus}, folder=Path(os.environ["PANELDRAW_PRELOAD"])):
        yield


@contextmanager
def user_mode_linux(bus, monkeypatch):
    """This is the only program that runs on that kernel, whose adapter module asks here what to do."""
    adapter = os.open(ADAPTER, os.O_RDWR)
    thread = threading.Thread(target=_serve, args=(adapter, bus), daemon=True)
    thread.start()
    try:
        yield
    finally:
        os.write(adapter, b"")  # ends what waits there
        thread.join()
        os.close(adapter)


def _serve(adapter, bus):
    while call := os.read(adapter, 1 << 20):
        messages = i2c_dev.unpacked(call)
        for message in messages:
            message.flags &= ~DMA_SAFE
        try:
            result = bus.transfer(messages)
        except OSError as error:
            result = -error.errno
        answers = [m.answer.ljust(m.length, b"\0") for m in messages if m.length is not None]
        os.write(adapter, result.to_bytes(4, "little", signed=True) + b"".join(answers))


LANES = {"patched": patched, "preload": preloaded, "uml": user_mode_linux}
