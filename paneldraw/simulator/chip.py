"""What simulated chips have in common: the I2C wire comes in, frames and violations come out."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator, Sequence
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .commands import Command
from .frames import Frame, Picture
from .glass import Glass

_STATUS_OFF = 0x40
_MAX_VIOLATIONS = 1000


class Chip(ABC):
    """A chip with its glass. Chips say what their commands do, where data goes, and which levels the RAM holds.

    Attributes
    ----------
    frames : collections.deque of Frame
        One frame for every bus call (one ``i2c_rdwr`` or one SMBus call) that changed what the eye sees, unless the
        panel was dark before and after. A driver that sends a picture in several calls leaves several frames.
    violations : list of str
        What the datasheet forbids and the chip was sent, in order; each text once, at most 1000. Clear it as you like.
    """

    max_level: ClassVar[int] = 1
    _commands: ClassVar[Sequence[Command]]
    registers: Any
    _glass: Glass

    def __init__(self, width: int, height: int, ram: NDArray[np.uint8], history: int | None, seed: int | None) -> None:
        self.width, self.height = width, height
        self.frames: deque[Frame] = deque(maxlen=history)
        self.violations: list[str] = []
        self._random = random.Random(seed)
        self._ram = ram
        self._seen: Picture = np.zeros((height, width), np.uint8)
        self._unframed_bytes = 0
        self.power_cycle()

    # power

    def power_cycle(self) -> None:
        """Lose power and get it back: registers at reset, RAM undefined (noise from `seed`)."""
        noise = np.frombuffer(self._random.randbytes(self._ram.size), np.uint8)
        self._ram[:] = self._undefined(noise).reshape(self._ram.shape)
        self.reset()

    def reset(self) -> None:
        """Pull the reset pin: registers at reset, a half-sent command forgotten, RAM as it was."""
        self.registers = self._registers()
        self._pending = bytearray()
        self._picture: Picture | None = None

    # the wire

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one I2C write: the bytes after the address byte, control bytes included.

        A command whose arguments do not fit in this write waits for them in the next, as the chip does.
        """
        self._picture = None
        for is_data, run in self._runs(bytes(payload)):
            if is_data:
                self._data(run)
            else:
                self._obey(run)

    def read(self, length: int) -> bytes:
        """Answer one I2C read: the status byte, `length` times. Bit 6 is set while the display is off."""
        return bytes([0 if self.registers.on else _STATUS_OFF]) * length

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Note that a bus call is over: record a frame if the eye sees another picture than before.

        Buses call this; call it yourself only where you call `write` without a bus.

        Parameters
        ----------
        seconds : float
            The time, for the frame.
        wire_bytes : int
            Bytes that this call put on the wire for this chip.
        """
        self._unframed_bytes += wire_bytes
        pixels = self.pixels
        if not np.array_equal(pixels, self._seen):
            self._seen = pixels
            self.frames.append(Frame(pixels, seconds, self._unframed_bytes, self.max_level))
            self._unframed_bytes = 0

    # what can be seen

    @property
    def pixels(self) -> Picture:
        """What an eye sees: levels from 0 to `max_level`, uint8, shape (height, width), read-only."""
        if self._picture is None:
            self._picture = self._look()
            self._picture.flags.writeable = False
        return self._picture

    @property
    def ram(self) -> Picture:
        """A copy of the RAM, uint8, as the class says."""
        return self._ram.copy()

    @property
    def contrast(self) -> int:
        """Contrast, 0 ... 255."""
        return int(self.registers.contrast)

    def __repr__(self) -> str:
        power = "on" if self.registers.on else "off"
        return f"<{type(self).__name__} {self.width}x{self.height}, {power}, {len(self.frames)} frames>"

    # what a chip says

    @abstractmethod
    def _registers(self) -> Any:
        """Make the registers as reset leaves them."""

    def _undefined(self, noise: NDArray[np.uint8]) -> NDArray[np.uint8]:
        """What the RAM makes of noise."""
        return noise

    @abstractmethod
    def _store(self, data: NDArray[np.uint8]) -> None:
        """Take data into the RAM."""

    @abstractmethod
    def _levels(self) -> Picture:
        """The RAM as levels, rows and segments."""

    # inside

    def _look(self) -> Picture:
        """Make a picture of what an eye sees."""
        registers = self.registers
        if not registers.lit:
            return np.zeros((self.height, self.width), np.uint8)
        levels, driven = self._glass.pixels(self._levels(), registers)
        if registers.all_on:
            levels = np.full_like(levels, self.max_level)
        elif registers.inverted:
            levels = self.max_level - levels
        return levels * driven[:, np.newaxis].astype(np.uint8)

    def _complain(self, violation: str) -> None:
        if violation not in self.violations and len(self.violations) < _MAX_VIOLATIONS:
            self.violations.append(violation)

    def _runs(self, payload: bytes) -> Iterator[tuple[bool, bytes]]:
        """Split a write at its control bytes into (is data, bytes)."""
        at = 0
        while at < len(payload):
            control = payload[at]
            if control & 0x3F:
                self._complain(f"control byte {control:02X}: the lower six bits are 0")
            one_byte = bool(control & 0x80)
            end = at + 2 if one_byte else len(payload)
            if end > len(payload):
                self._complain(f"control byte {control:02X}: a byte must follow, and the transaction ended")
            yield bool(control & 0x40), payload[at + 1 : end]
            at = end

    def _obey(self, run: bytes) -> None:
        for byte in run:
            self._pending.append(byte)
            command = self._commands[self._pending[0]]
            if len(self._pending) > command.arguments:
                command.act(self.registers, self._pending, self._complain)
                self._pending.clear()

    def _data(self, run: bytes) -> None:
        if not run:
            return
        if self._pending:
            self._complain(f"data while command {self._pending[0]:02X} waits for its arguments")
        self._store(np.frombuffer(run, np.uint8))
