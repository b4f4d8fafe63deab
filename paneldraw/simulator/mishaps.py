"""Faults that strike simulated panels at random, at a rate and from a seed: what long wires and loose plugs do."""

from __future__ import annotations

import errno as codes
import math
import random
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

from paneldraw.errors import did_you_mean

from .bus import I2CBus
from .wire import EREMOTEIO

if TYPE_CHECKING:
    from .rig import RigPanel
    from .spi import SPIBus

Noise = Callable[[bytes], bytes]

_REACH: Final = 64
"""Fewer bytes than that of a message arrive before what happens in the middle of it."""


@dataclass(frozen=True, slots=True)
class Kind:
    """One kind of fault: what it is, what a call on I2C and on SPI raises (None: the bus has no such), and more."""

    about: str
    i2c: int | None = None
    spi: int | None = None
    midway: bool = False
    power: bool = False


KINDS: Final = {
    "nack": Kind("nobody acknowledges (I2C)", i2c=EREMOTEIO),
    "timeout": Kind("the transfer does not end", i2c=codes.ETIMEDOUT, spi=codes.ETIMEDOUT),
    "busy": Kind("another master has the bus (I2C)", i2c=codes.EAGAIN),
    "short": Kind("the rest of a transfer is lost, without an error", i2c=0, spi=0, midway=True),
    "power": Kind("the module loses its supply for a moment", i2c=EREMOTEIO, spi=0, midway=True, power=True),
}
"""Faults of a message on the bus, by the name that ``--fail`` has for them."""
NOISE: Final = {
    "flip": "a bit of a byte on the serial line is wrong",
    "drop": "a byte on the serial line is lost",
}
"""Faults of a byte on a serial line."""


@dataclass
class Mishap:
    """One kind of fault that strikes now and then.

    Attributes
    ----------
    kind : str
        A key of `KINDS` or `NOISE`.
    rate : float
        How many of 100 messages, or of 100 bytes on a serial line, it strikes.
    struck : int
        How often it has struck.

    Examples
    --------
    >>> read_mishap("nack:0.5%")
    Mishap(kind='nack', rate=0.5, struck=0)
    """

    kind: str
    rate: float
    struck: int = 0

    def strike(self, panels: Iterable[RigPanel], seed: int = 0) -> None:
        """Let it strike panels from now on, the same messages for the same seed.

        Raises
        ------
        ValueError
            None of the panels is on a bus that has such a fault.
        """
        chance = random.Random(f"{seed} {self.kind}")
        able = 0
        for panel in panels:
            if self.kind in NOISE:
                if panel.port is not None:
                    panel.port.noise = self._noise(chance, panel.port.noise)
                    able += 1
            elif _errno(panel.bus, KINDS[self.kind]) is not None:
                _Recurring(self, panel, chance).wait()
                able += 1
        if not able:
            about = NOISE.get(self.kind) or KINDS[self.kind].about
            raise ValueError(f"{self.kind} strikes no panel here: {about}")

    def _noise(self, chance: random.Random, before: Noise | None) -> Noise:
        def noise(data: bytes) -> bytes:
            arrives = bytearray()
            for byte in before(data) if before else data:
                if 100 * chance.random() >= self.rate:
                    arrives.append(byte)
                    continue
                self.struck += 1
                if self.kind == "flip":
                    arrives.append(byte ^ 1 << chance.randrange(8))
            return bytes(arrives)

        return noise


class _Recurring:
    """A fault on a panel's bus that, once it has struck, waits for the next time."""

    def __init__(self, mishap: Mishap, panel: RigPanel, chance: random.Random) -> None:
        self._mishap, self._panel, self._chance = mishap, panel, chance

    def wait(self) -> None:
        """Wait for as many messages as chance has it."""
        kind, bus = KINDS[self._mishap.kind], self._panel.bus
        share = self._mishap.rate / 100
        gap = 0 if share == 1 else int(math.log(1 - self._chance.random()) / math.log(1 - share))
        options: dict[str, Any] = {"address": self._panel.address} if isinstance(bus, I2CBus) else {}
        at_byte = self._chance.randrange(_REACH) if kind.midway else None
        bus.fail(_errno(bus, kind) or 0, after=gap, at_byte=at_byte, then=self._strike, **options)

    def _strike(self) -> None:
        self._mishap.struck += 1
        if KINDS[self._mishap.kind].power:
            self._panel.chip.power_cycle()
        self.wait()


def _errno(bus: I2CBus | SPIBus, kind: Kind) -> int | None:
    return kind.i2c if isinstance(bus, I2CBus) else kind.spi


def read_mishap(text: str) -> Mishap:
    """Read what ``--fail`` takes: a kind and a rate, such as ``nack:1%``.

    Raises
    ------
    ValueError
        There is no such kind, or no such rate.

    Examples
    --------
    >>> read_mishap("nak:1%")
    Traceback (most recent call last):
    ValueError: fail must be one of nack, timeout, busy, short, power, flip, drop, not 'nak'; did you mean nack?
    """
    known = (*KINDS, *NOISE)
    kind, _, rate = text.partition(":")
    if kind not in known:
        raise ValueError(f"fail must be one of {', '.join(known)}, not {kind!r}{did_you_mean(kind, known)}")
    found = re.fullmatch(r"(\d+\.?\d*|\.\d+)%", rate)
    if not found or not 0 < float(found[1]) <= 100:
        raise ValueError(f"fail must have a rate above 0% and up to 100%, such as {kind}:1%, not {text!r}")
    return Mishap(kind, float(found[1]))
