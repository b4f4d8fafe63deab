"""How many instructions the commonest calls take: run where `count.c` counts them, on an emulated machine.

What a bus takes besides is the kernel's and the wire's: the one here takes every byte and does nothing.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator

TIMES = 20


class Bus:
    """A bus of smbus2's interface that takes every message at once."""

    def i2c_rdwr(self, *messages: object) -> None:
        """Take the messages."""

    def close(self) -> None:
        """Nothing is open."""


def calls() -> Iterator[tuple[str, Callable[[], object]]]:
    """Yield what is counted, with its name; the first does nothing, which is what counting takes itself."""
    from paneldraw import Framebuffer, Panel, Supersample
    from paneldraw.controllers import SSD1306
    from paneldraw.transports import I2CTransport

    panel = Panel(SSD1306(128, 64), I2CTransport(bus=Bus(), address=0x3C))
    fb, smooth = Framebuffer(128, 64), Supersample(4)
    yield "nothing", lambda: None
    yield "fb.line(0, 0, 127, 63)", lambda: fb.line(0, 0, 127, 63)
    yield (
        "fb.line(0, 0, 127, 63, width=2, antialias=Supersample(4))",
        (lambda: fb.line(0, 0, 127, 63, width=2, antialias=smooth)),
    )
    yield "fb.circle(64, 32, 20)", lambda: fb.circle(64, 32, 20)
    yield 'fb.text("Hello", 0, 0)', lambda: fb.text("Hello", 0, 0)

    def show_a_pixel() -> None:
        fb.pixels[32, 64] ^= 1
        panel.show(fb)

    def show_everything() -> None:
        fb.pixels[:] ^= 1
        panel.show(fb)

    yield "panel.show(fb), nothing changed", lambda: panel.show(fb)
    yield "panel.show(fb), one pixel changed", show_a_pixel
    yield "panel.show(fb), all 8,192 pixels changed", show_everything


def table(said: str) -> str:
    """Return what a run printed as the rows of a table: the call, its instructions, and their time at one a ns."""
    counted = [int(number) for number in re.findall(r"^counted (\d+)$", said, re.M)]
    names = re.findall(r"^call (.*)$", said, re.M)
    each = [taken / TIMES for taken in counted[1::2]]
    rows = [f"| `{name}` | {number - each[0]:,.0f} | {(number - each[0]) / 1e6:.3f} ms |"
            for name, number in list(zip(names, each, strict=True))[1:]]  # fmt: skip
    return "\n".join(["| call | instructions | at 1 GHz |", "|---|---:|---:|", *rows])


def strays(page: str, rows: str) -> list[str]:
    """Return the calls whose instructions are not those that a page tells, by more than a tenth."""
    told, found = (
        {call: int(number.replace(",", "")) for call, number in re.findall(r"^\| `(.*)` \| ([\d,]+) \|", text, re.M)}
        for text in (page, rows)
    )
    return [call for call in {**told, **found} if abs(told.get(call, 0) - found.get(call, 0)) * 10 > told.get(call, 0)]


def main() -> None:
    """Make every call, and have the counter told before and after."""
    for name, call in calls():
        print("call", name)
        for _ in range(3):
            call()
        os.getpriority(os.PRIO_PROCESS, 0)
        for _ in range(TIMES):
            call()
        os.getpriority(os.PRIO_PROCESS, 0)


if __name__ == "__main__":
    main()
