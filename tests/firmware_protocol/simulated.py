"""A serial port in simulated time, with a device, a panel and a noisy line behind it."""

from __future__ import annotations

import heapq
import itertools
import random
from collections.abc import Callable
from dataclasses import dataclass

from firmware_protocol.device import UNO, Device
from firmware_protocol.messages import HelloReply
from firmware_protocol.runs import Run


@dataclass(frozen=True)
class Noise:
    """How often a byte is flipped, dropped, or followed by one that nobody sent."""

    flip: float = 0.0
    drop: float = 0.0
    insert: float = 0.0

    def __call__(self, data: bytes, rng: random.Random) -> bytes:
        out = bytearray()
        for byte in data:
            if rng.random() < self.drop:
                continue
            out.append(byte ^ rng.randrange(1, 256) if rng.random() < self.flip else byte)
            if rng.random() < self.insert:
                out.append(rng.randrange(256))
        return bytes(out)


class PagePanel:
    """A 128 x 64 panel with page pointers, as little of it as shows whether the bytes came right."""

    def __init__(self) -> None:
        self.ram = bytearray(1024)
        self.page = self.column = 0
        self.gone = False

    def __call__(self, content: bytes) -> None:
        if self.gone:
            raise OSError(121, "Remote I/O error")
        for byte in content[1:]:
            if content[0] == 0x40:
                self.ram[128 * self.page + self.column] = byte
                self.column = self.column + 1 & 127
            elif byte >= 0xB0:
                self.page = byte & 7
            elif byte >= 0x10:
                self.column = self.column & 0x0F | (byte & 7) << 4
            else:
                self.column = self.column & 0x70 | byte


def whole(ram: bytes) -> list[Run]:
    """Return the runs that write all of a `PagePanel`."""
    runs: list[Run] = []
    for page in range(8):
        runs += [(False, bytes((0xB0 + page, 0x00, 0x10))), (True, ram[128 * page : 128 * page + 128])]
    return runs


class SimulatedPort:
    """What `HostLink` needs of a pyserial port; `clock` is its time.

    A byte takes a character time on the line; one sent at another rate than the far end listens at arrives as another
    byte. Writing to the panel takes 22.5 us a byte, and what arrives meanwhile waits in 512 bytes or is lost.
    Answers take `late` seconds more.
    """

    name = "simulated"
    ring = 512
    bus_byte = 22.5e-6
    late: Callable[[], float] = staticmethod(lambda: 0.0)

    def __init__(self, *, profile: HelloReply = UNO, noise: Noise | None = None, seed: int = 0) -> None:
        self.rng = random.Random(seed)
        self.noise = noise or Noise()
        self.now = self.busy_until = 0.0
        self.baudrate, self.timeout, self.is_open = 115200, 0.02, True
        self.free_at = {"to device": 0.0, "to host": 0.0}
        self.carried = 0
        self.order = itertools.count()
        self.events: list[tuple[float, int, Callable[[], None]]] = []
        self.waiting: list[tuple[int, int]] = []
        self.received = bytearray()
        self.panel: Callable[[bytes], None] | PagePanel = PagePanel()
        self.mangle: Callable[[bytes], bytes] = lambda replies: replies
        self.device = Device(self._write_panel, profile=profile, clock=lambda: self.now)

    def clock(self) -> float:
        return self.now

    def at(self, when: float, action: Callable[[], None]) -> None:
        heapq.heappush(self.events, (when, next(self.order), action))

    # -- pyserial's side

    @property
    def in_waiting(self) -> int:
        return len(self.received)

    def open(self) -> None:
        self.is_open = True

    def close(self) -> None:
        self.is_open = False

    def flush(self) -> None:
        pass

    def write(self, data: bytes) -> int:
        self._carry("to device", data, self.now, self.baudrate, self._arrive)
        return len(data)

    def read(self, size: int = 1) -> bytes:
        until = self.now + self.timeout
        while not self.received and self.events and self.events[0][0] <= until:
            self.now, _, action = heapq.heappop(self.events)
            action()
        if not self.received:
            self.now = until
        data = bytes(self.received[:size])
        del self.received[:size]
        return data

    # -- the far side

    def reply(self, data: bytes, rate: int) -> None:
        now = max(self.now, self.busy_until) + self.late()
        self._carry("to host", self.mangle(data), now, rate, self._come_back)

    def _carry(self, way: str, data: bytes, now: float, rate: int, arrive: Callable[[int, int], None]) -> None:
        for byte in data:
            self.carried += 1
            self.free_at[way] = max(self.free_at[way], now) + 10 / rate
            for got in self.noise(bytes((byte,)), self.rng):
                self.at(self.free_at[way], lambda got=got: arrive(got, rate))

    def _come_back(self, byte: int, rate: int) -> None:
        self.received.append(byte if rate == self.baudrate else self.rng.randrange(256))

    def _arrive(self, byte: int, rate: int) -> None:
        if len(self.waiting) >= self.ring - 1:
            self.device.counters.overflows += 1
            return
        self.waiting.append((byte, rate))
        if len(self.waiting) == 1:
            self.at(max(self.now, self.busy_until), self._run_device)

    def _run_device(self) -> None:
        while self.waiting:
            if self.busy_until > self.now:
                self.at(self.busy_until, self._run_device)
                return
            byte, rate = self.waiting.pop(0)
            self.device.tick()
            before = self.device.baudrate
            if rate != before:
                self.device.line_error()
                byte = self.rng.randrange(256)
            self.reply(self.device.receive(bytes((byte,))), before)

    def _write_panel(self, content: bytes) -> None:
        self.busy_until = max(self.busy_until, self.now) + self.bus_byte * (len(content) + 1)
        self.panel(content)
