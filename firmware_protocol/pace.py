"""How an update is cut into frames, how much of it may be under way, and how long an answer may take."""

from __future__ import annotations

import math
from collections.abc import Iterable

from firmware_protocol.frames import FRAME_OVERHEAD, payload_within, wire_size
from firmware_protocol.messages import HelloReply, Kind, PanelBus
from firmware_protocol.runs import LEAST_PAYLOAD, Run, bus_bytes, cut_runs, most_bus_bytes, pack_runs, unpack_runs

#: Payload that a bad line shrinks frames to: at 3 errors in 1000 bytes five of six still arrive.
BAD_LINE_PAYLOAD = 48
#: Bits a second above which the panel's bus takes longer than the wire.
FAST = 230_400
#: Seconds that a panel's bus takes for a byte: nine bits at 400 kHz. Where it takes others, updates only end later.
BUS_BYTE = 22.5e-6
#: The same at 100 kHz, and for a reset of the panel: what a device may need before it answers.
SLOW_BUS_BYTE = 90e-6
RESET_SECONDS = 0.02
#: Seconds that an answer may always take beside wire and bus; and how many deviations from the mean.
LEAST_PATIENCE = 0.01
DEVIATIONS = 4
#: Bytes that say where in the store a message puts its own.
STORE_HEAD = 2
#: Payloads up to here are not worth two frames.
WHOLE = 12

#: A sequenced message that has no number yet: its kind and its payload.
Work = tuple[Kind, bytes]


class Pace:
    """Cuts updates into frames for one device at one rate; frames and window shrink with losses and grow again.

    Parameters
    ----------
    device : HelloReply
        What the device takes.
    baudrate : int
        Bits a second.

    Attributes
    ----------
    payload : int
        Most bytes of a payload.
    window : int
        Most bytes on the wire that may be unacknowledged.
    """

    def __init__(self, device: HelloReply, baudrate: int) -> None:
        self._wire_byte = 10 / baudrate
        # A slow wire wants few large frames; a fast one wants the next frame there when the panel is done with one.
        self._fast = baudrate > FAST
        on_spi = device.bus == PanelBus.SPI  # which is faster than any wire
        parts = 3 if self._fast and not on_spi else 2
        self._repeats = device.repeats
        # On SPI a run is a chip select, and a chain of MAX7219 takes half of one for a whole one.
        self._whole = min(device.max_payload, payload_within(device.window)) if on_spi else 0
        self._best_window = device.window
        self._best_payload = max(LEAST_PAYLOAD, min(device.max_payload, payload_within(device.window // parts)))
        self.payload = self._best_payload
        self.window = self._best_window

    def writes(self, runs: Iterable[Run], end: bool) -> list[Work]:
        """Return runs as messages; ``end`` says that they complete a picture."""
        payloads = self._packed(runs)
        if payloads and not self._whole:
            # A fast wire waits for the panel's bus, which therefore starts early; a slow one has it end soon after.
            cut = 0 if self._fast else len(payloads) - 1
            payloads[cut : cut + 1] = self._overlapping(payloads[cut])
        return _messages(payloads, end)

    def stores(self, content: bytes, offset: int) -> list[Work]:
        """Return messages that put bytes into the store, from a place in it on."""
        room = self.payload - STORE_HEAD
        return [
            (Kind.STORE, (offset + at).to_bytes(STORE_HEAD, "little") + content[at : at + room])
            for at in range(0, len(content), room)
        ]

    def again(self, work: Work) -> list[Work]:
        """Return a message in pieces of the size that the line bears now."""
        kind, payload = work
        if kind == Kind.STORE:
            return self.stores(payload[STORE_HEAD:], int.from_bytes(payload[:STORE_HEAD], "little"))
        if kind not in (Kind.WRITE, Kind.WRITE_END) or len(payload) <= self.payload:
            return [work]
        return _messages(self._packed(unpack_runs(payload)), kind == Kind.WRITE_END)

    def on_bus(self, kind: Kind, payload: bytes) -> float:
        """Return the seconds that a device may need for a message when it has it: those of a panel's bus at 100 kHz."""
        if kind == Kind.RESET:
            return RESET_SECONDS
        return most_bus_bytes(payload) * SLOW_BUS_BYTE if kind in (Kind.WRITE, Kind.WRITE_END) else 0.0

    def slow_down(self) -> None:
        """Something was lost: send less at a time."""
        self.payload = min(self._best_payload, max(BAD_LINE_PAYLOAD, self.payload // 2))
        self.window = min(self._best_window, max(2 * wire_size(self.payload), self.window // 2))

    def speed_up(self, count: int) -> None:
        """So many frames have arrived."""
        self.payload = min(self._best_payload, self.payload + count)
        self.window = min(self._best_window, self.window + 4 * count)

    def _packed(self, runs: Iterable[Run]) -> list[bytes]:
        return pack_runs(runs, self.payload, repeats=self._repeats, whole=self._whole)

    def _overlapping(self, payload: bytes) -> list[bytes]:
        """Cut a payload in two so that the bus is done with the first part when the wire is with the second."""
        if len(payload) <= WHOLE:
            return [payload]
        runs = unpack_runs(payload)
        written = bus_bytes(runs)
        on_bus = written * BUS_BYTE
        on_wire, envelope = len(payload) * self._wire_byte, FRAME_OVERHEAD * self._wire_byte
        share = (on_wire + envelope) / (on_wire + on_bus)
        if share >= 1 or share * on_bus < 2 * envelope:  # nothing to gain, or hardly more than a frame costs
            return [payload]
        return [packed for part in cut_runs(runs, round(share * written)) for packed in self._packed(part)]


class RoundTrip:
    """How long acknowledgements take, as TCP reckons it (RFC 6298): smoothed mean and deviation of what was seen.

    Attributes
    ----------
    most : float
        Seconds after which one is overdue; endless until one has come.
    """

    def __init__(self) -> None:
        self.most = math.inf
        self._mean = self._deviation = 0.0

    def took(self, seconds: float) -> None:
        """Take in that one came after so many seconds, what wire and bus are known to need not counted."""
        seconds = max(0.0, seconds)
        if self.most == math.inf:
            self._mean, self._deviation = seconds, seconds / 2
        else:
            self._deviation += (abs(seconds - self._mean) - self._deviation) / 4
            self._mean += (seconds - self._mean) / 8
        self.most = max(LEAST_PATIENCE, self._mean + DEVIATIONS * self._deviation)


def _messages(payloads: list[bytes], end: bool) -> list[Work]:
    kinds = [Kind.WRITE] * (len(payloads) - 1) + [Kind.WRITE_END if end else Kind.WRITE]
    return list(zip(kinds, payloads, strict=False))
