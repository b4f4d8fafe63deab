"""What the library for LD_PRELOAD adds to a call of the real smbus2, beside the same call with smbus2 patched."""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from statistics import median
from typing import Any

import measure
import smbus2

from paneldraw import simulator
from paneldraw.simulator.kernel.i2c_dev import I2CFile, Message
from paneldraw.simulator.preload import Preload, PreloadUnavailableError, library

WANTED = 30.0
"""Microseconds."""
CALLS = 200
ADDRESS = 0x3C

CHILD = f"""if True:
    import smbus2, time
    bus = smbus2.SMBus(1)
    messages = [smbus2.i2c_msg.write({ADDRESS}, bytes(2))], [smbus2.i2c_msg.write({ADDRESS}, bytes(1025))]
    for line in iter(input, ""):
        which, calls = map(int, line.split())
        started = time.perf_counter()
        for _ in range(calls):
            bus.i2c_rdwr(*messages[which])
        print((time.perf_counter() - started) / calls, flush=True)
"""


class Listener:
    """A device that takes everything and does nothing, so that the way there is what is timed."""

    def write(self, payload: bytes) -> None:
        """Take it."""

    def read(self, length: int) -> bytes:
        """Answer zeros."""
        return bytes(length)

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Nothing is seen."""


@contextmanager
def patched(file: I2CFile) -> Iterator[Any]:
    """A bus of smbus2's below which no system call happens."""

    def ioctl(descriptor: int, request: int, argument: Any) -> int:
        if request != 0x0707:
            return 0
        messages = [argument.msgs[index] for index in range(argument.nmsgs)]
        return file.rdwr([Message.of(m.addr, m.flags, m.len, m.buf[: m.len]) for m in messages])

    kept, smbus2.smbus2.ioctl = smbus2.smbus2.ioctl, ioctl
    try:
        bus = smbus2.SMBus()
        bus.fd = 0
        yield bus
    finally:
        smbus2.smbus2.ioctl = kept


def through_patch(bus: Any, length: int, calls: int) -> float:
    """Seconds a call."""
    message = smbus2.i2c_msg.write(ADDRESS, bytes(length))
    started = time.perf_counter()
    for _ in range(calls):
        bus.i2c_rdwr(message)
    return (time.perf_counter() - started) / calls


def run(rounds: int) -> None:
    """Print a row for a short message and one for a picture of an SSD1306, the two ways in turn."""
    calls = CALLS if measure.SAMPLE else 1
    file = I2CFile(simulator.I2CBus({ADDRESS: Listener()}, timer=None))
    try:
        library()
    except PreloadUnavailableError as error:
        print(f"  {error}")
        return
    with (
        Preload({1: file.bus}) as preload,
        preload.popen([sys.executable, "-c", CHILD], stdin=-1, stdout=-1, text=True) as child,
    ):

        def ask(line: str) -> str:
            child.stdin.write(f"{line}\n")  # type: ignore[union-attr]
            child.stdin.flush()  # type: ignore[union-attr]
            return str(child.stdout.readline())  # type: ignore[union-attr]

        for which, length in enumerate((2, 1025)):
            one, other = [], []
            for _ in range(rounds):
                one.append(float(ask(f"{which} {calls}")))
                with patched(file) as bus:
                    other.append(through_patch(bus, length, calls))
            report(f"a message of {length} bytes", 1e6 * median(one), 1e6 * median(other))
        child.communicate("\n")


def report(name: str, preloaded: float, patch: float) -> None:
    """Print a row."""
    added = max(preloaded - patch, 0.01)
    verdict = measure.VERDICTS.judge(name, f"at most {WANTED:.0f} us more", WANTED / added, 1.0)
    print(
        f"  {name:<30}preloaded {preloaded:7.1f} us, patched {patch:7.1f} us, {added:6.1f} more; "
        f"at most {WANTED:.0f}: {verdict}",
        flush=True,
    )
