"""What simulated buses have in common: counts, time on the wire, and faults on demand."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import ClassVar, Final

from .chip import Chip
from .log import Log

EREMOTEIO: Final = 121
_MESSAGE_OF_EREMOTEIO: Final = "Remote I/O error"


@dataclass
class Fault:
    """A fault waiting on a bus; the `fail` of the bus says what the fields mean."""

    errno: int
    after: int
    at_byte: int | None
    times: int | None
    then: Callable[[], object] | None
    address: int | None = None
    hold: float = 0
    """Seconds for which the clock is held; nothing else happens while the adapter waits that long."""

    def __post_init__(self) -> None:
        if self.after < 0 or (self.at_byte or 0) < 0 or (self.times is not None and self.times < 1):
            raise ValueError("after and at_byte are 0 or more, times is 1 or more")

    def reach(self, size: int) -> int:
        """How many of a message's bytes arrive."""
        return min(self.at_byte or 0, size)


class Wire:
    """Counts, time and faults of a bus; `I2CBus` says what the attributes are.

    Attributes
    ----------
    log : Log or None
        Who writes down what is carried.
    """

    log_form: ClassVar[str]

    def __init__(self, timer: Callable[[], float] | None) -> None:
        self.bytes = 0
        self.messages = 0
        self.seconds = 0.0
        self.realtime = False
        self.timer = timer
        self._now = 0.0
        self._faults: list[Fault] = []
        self._lock = threading.RLock()
        self.log: Log | None = None

    @property
    def timer(self) -> Callable[[], float] | None:
        """Where the time comes from; None is the wire's own."""
        return self._timer

    @timer.setter
    def timer(self, timer: Callable[[], float] | None) -> None:
        self._timer = timer
        self._started = timer() if timer else 0.0

    def idle(self, seconds: float) -> None:
        """Let time pass with the wire at rest, as a script's pause does; the next frame is stamped that much later."""
        if not seconds >= 0:
            raise ValueError(f"seconds: {seconds!r} is not 0 or more")
        with self._lock:
            self._now += seconds
            self._pass_time()

    def clear_faults(self) -> None:
        """Forget all faults that wait."""
        self._faults.clear()

    def _elapse(self, busy: float) -> float:
        """Count time that the wire was busy; return what time it is now."""
        self.seconds += busy
        passed = self._timer() - self._started if self._timer else 0.0
        self._now = max(self._now, passed) + busy if self.realtime else max(self._now + busy, passed)
        return self._now

    def _rest(self) -> None:
        """In real time, wait until the wire has carried what it was given; who holds the lock keeps viewers waiting."""
        if self.realtime and self._timer:
            time.sleep(max(0.0, self._now - (self._timer() - self._started)))

    def _pass_time(self) -> None:
        """Tell the chips what time it is."""
        with self._lock:
            now = max(self._now, self._timer() - self._started) if self._timer else self._now
            for chip in self._chips():
                if isinstance(chip, Chip):
                    chip.hold = self._hold
                    chip.wait(now)

    def _hold(self, look: Callable[[], object]) -> None:
        """Stand still while somebody looks at a chip."""
        with self._lock:
            self._pass_time()
            look()

    def _chips(self) -> Iterable[object]:
        """What sits on the bus."""
        return ()

    def _await(self, fault: Fault) -> Fault:
        self._faults.append(fault)
        return fault

    def _due(self, address: int | None = None) -> Fault | None:
        """Count one message against every waiting fault; the first that is due strikes."""
        due: Fault | None = None
        for fault in list(self._faults):
            if fault.address not in (None, address):
                continue
            if fault.after:
                fault.after -= 1
            elif due is None:
                due = fault
                if fault.times is not None:
                    fault.times -= 1
                    if not fault.times:
                        self._faults.remove(fault)
        return due


def os_error(code: int) -> OSError:
    """Make the error that Linux reports under a number, on any system."""
    return OSError(code, _MESSAGE_OF_EREMOTEIO if code == EREMOTEIO else os.strerror(code))


def check_bus(chip: object, bus: str) -> None:
    """Raise ValueError if a chip cannot sit on a kind of bus; what is no chip of ours may sit anywhere."""
    if isinstance(chip, Chip) and bus not in chip.buses:
        buses = " or ".join(map(str.upper, chip.buses))
        raise ValueError(f"{type(chip).__name__} cannot sit on {bus.upper()}, but on {buses}")
