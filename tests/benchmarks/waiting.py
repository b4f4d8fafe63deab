"""How soon ``show(wait=False)`` returns, and how well ``frames`` keeps its beat."""

from __future__ import annotations

import threading
import time
from statistics import median

import measure
import numpy as np
from measure import VERDICTS
from show import Forgetful

from paneldraw import Panel
from paneldraw.controllers import SSD1306
from paneldraw.pacing import Frames
from paneldraw.transports import I2CTransport

FPS = 30
#: Microseconds, milliseconds, and a share of the CPU in per cent.
RETURN_WANTED, BEAT_WANTED, CPU_WANTED = 10.0, 1.0, 1.0
#: Seconds, in which the thread goes to sleep, and other programs take the processor's caches.
PAUSE = 0.0005


def run(rounds: int) -> None:
    """Print the figures."""
    handed_over(rounds)
    beat(rounds)


def judged(row: str, figure: float, wanted: float, unit: str) -> str:
    """A figure that is to be small, and whether it is."""
    return f"{figure:.2f} {unit} (wanted {wanted:g}: {VERDICTS.judge(row, unit, wanted / figure, 1)})"


def handed_over(rounds: int) -> None:
    """Hand over pictures; print the caller's CPU time, in which it may have to wake the sender's thread."""
    name = "show(wait=False) while it sends"
    print(f"  {name:<44}{judged(name, handing_over(rounds, 50, waits=False), RETURN_WANTED, 'us')}", flush=True)
    name = "show(wait=False) after a pause, while it waits"
    print(f"  {name:<48}{judged(name, handing_over(rounds, 1, waits=True), RETURN_WANTED, 'us')}", flush=True)
    print(f"  {'the same while it sends, with no thread to wake':<48}{handing_over(rounds, 1, waits=False):.2f} us")
    print(f"  {'waking a thread by itself':<48}{waking(20 * rounds):.2f} us", flush=True)


def handing_over(rounds: int, calls: int, *, waits: bool) -> float:
    """The caller's microseconds a picture, of so many in a row after a pause; `waits` is whether the thread sleeps."""
    bus, picture, seconds = Gated(), np.zeros((64, 128), np.uint8), []
    with Panel(SSD1306(128, 64), I2CTransport(bus)) as panel:
        panel.show(picture)
        bus.open = waits
        for number in range(20 * rounds if measure.SAMPLE else 2):
            picture[number % 64] ^= 1
            time.sleep(PAUSE)
            start = time.thread_time()
            for _ in range(calls):
                panel.show(picture, wait=False)
            seconds.append((time.thread_time() - start) / calls)
        bus.open = True
    return 1e6 * median(seconds)


class Gated(Forgetful):
    """A bus that takes a picture when it may."""

    open = True

    def i2c_rdwr(self, *messages: object) -> None:
        while not self.open:
            time.sleep(0.01)


def waking(times: int) -> float:
    """What waking a thread costs by itself: a lock that another thread waits for."""
    lock, left, seconds = threading.Lock(), [times], []
    lock.acquire()

    def wait() -> None:
        while left[0]:
            lock.acquire()

    thread = threading.Thread(target=wait)
    thread.start()
    while left[0]:
        time.sleep(0.0005)
        left[0] -= 1
        start = time.thread_time()
        if lock.locked():
            lock.release()
        seconds.append(time.thread_time() - start)
    thread.join()
    return median(seconds)


def beat(rounds: int) -> None:
    """Pace a loop that draws nothing; print how far from the beat it is, and what CPU the pacing takes.

    Beside it stands by how much the pauses themselves were too long, which is the machine's doing.
    """
    off, over = [], []

    def sleep(seconds: float) -> None:
        start = time.perf_counter()
        time.sleep(seconds)
        over.append(time.perf_counter() - start - seconds)

    begun, cpu = time.perf_counter(), time.process_time()
    for beat in Frames(FPS, sleep=sleep):
        off.append(abs(beat.seconds - beat.number / FPS))
        if beat.number >= (10 * rounds if measure.SAMPLE else 2):
            break
    share = (time.process_time() - cpu) / (time.perf_counter() - begun)
    off.sort()
    over.sort()
    name = f"frames({FPS})"
    print(
        f"  {name:<44}{judged(name, 1e3 * median(off), BEAT_WANTED, 'ms')} off the beat, 95 % within "
        f"{1e3 * off[int(0.95 * len(off))]:.2f} ms; {judged(name, 100 * share, CPU_WANTED, '% CPU')}\n"
        f"  {'of that, time.sleep too long by':<44}{1e3 * median(over):.2f} ms, 95 % within "
        f"{1e3 * over[int(0.95 * len(over))]:.2f} ms"
    )
