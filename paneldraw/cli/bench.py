"""What ten scenes cost on the wire, in a table and as a chart."""

from __future__ import annotations

from statistics import mean
from typing import Final, NamedTuple

from paneldraw import simulator
from paneldraw.cli import playback
from paneldraw.controllers import SSD1306
from paneldraw.demos.scenes import HEIGHT, SCENES, WIDTH, Scene
from paneldraw.framebuffer import Framebuffer
from paneldraw.panel import Panel
from paneldraw.transports import I2CTransport

CLOCKS: Final = {"100 kHz": 100_000, "400 kHz": 400_000, "1 MHz": 1_000_000}
"""Rates of an I2C bus, in Hz."""
FULL_FRAME: Final = 2 + 6 + 2 + WIDTH * HEIGHT // 8
"""Bytes on the wire of a driver that sends whole frames: a message that sets the window, and one of data."""


class Line(NamedTuple):
    """What a scene cost, on average over its frames."""

    name: str
    wire_bytes: float
    bits: float
    """Bit times of the bus, START and STOP included."""


_WHOLE: Final = Line("whole frame", FULL_FRAME, 9 * FULL_FRAME + 2 * 2)  # two calls, each with a START and a STOP


def measured(frames: int) -> list[Line]:
    """Run every scene for a number of frames and count; the last line is their mean."""
    lines = []
    with playback.Progress("measuring") as progress:
        for turn, (name, scene) in enumerate(SCENES.items()):
            lines.append(_measured(name, scene, frames))
            progress((turn + 1) * frames, len(SCENES) * frames)
    return [*lines, Line("mean", mean(line.wire_bytes for line in lines), mean(line.bits for line in lines))]


def _measured(name: str, scene: Scene, frames: int) -> Line:
    """Show a scene's frame 0 and count from there."""
    bus = simulator.I2CBus({0x3C: simulator.SSD1306(WIDTH, HEIGHT, history=1)}, clock=1, timer=None)
    fb = Framebuffer(WIDTH, HEIGHT)
    with Panel(SSD1306(WIDTH, HEIGHT), I2CTransport(bus)) as panel:
        scene(fb, 0)
        panel.show(fb)
        sent, seconds = bus.bytes, bus.seconds
        for frame in range(1, frames + 1):
            scene(fb, frame)
            panel.show(fb)
        return Line(name, (bus.bytes - sent) / frames, (bus.seconds - seconds) / frames)


def _rate(clock: int, bits: float) -> str:
    return f"{clock / bits:.0f}" if bits else "any"


def table(lines: list[Line]) -> list[str]:
    """Format the lines, a driver of whole frames below them."""
    rates = "".join(f"{name:>10}" for name in CLOCKS)
    rows = [f"{'':12}{'bytes a':>9}   frames a second at", f"{'scene':12}{'frame':>9}{rates}"]
    for line in (*lines, _WHOLE):
        speeds = "".join(f"{_rate(clock, line.bits):>10}" for clock in CLOCKS.values())
        rows.append(f"{line.name:12}{line.wire_bytes:9.1f}{speeds}")
    return rows


def chart(lines: list[Line]) -> Framebuffer:
    """Draw the lines as bars beside that of a driver of whole frames, the frame rates in columns to the right."""
    left, bars, pitch, top = 78, 260, 16, 44
    lines = [*lines, _WHOLE]
    fb = Framebuffer(left + bars + 200, top + pitch * len(lines) + 8, depth=8)
    fb.text("bytes a frame", left, 8)
    columns = [left + bars + 84 + 52 * k for k in range(len(CLOCKS))]
    fb.text("frames a second", columns[-1], 8, anchor="rt")
    for x, name in zip(columns, CLOCKS, strict=True):
        fb.text(name, x, 24, 160, anchor="rt")
    fb.hline(8, top - 8, fb.width - 16, 96)
    for row, line in enumerate(lines):
        y = top + pitch * row
        ours = row < len(lines) - 1
        length = round(bars * line.wire_bytes / FULL_FRAME)
        fb.text(line.name, left - 6, y + 5, anchor="rm")
        fb.rect(left, y, bars, 10, 48, fill=True)
        fb.rect(left, y, max(length, 1), 10, 230 if ours else 120, fill=True)
        inside = length > bars - 40
        x, anchor, level = (left + length - 4, "rm", 0) if inside else (left + length + 4, "lm", 255)
        fb.text(f"{line.wire_bytes:.0f}", x, y + 5, level, anchor=anchor)
        for x, clock in zip(columns, CLOCKS.values(), strict=True):
            fb.text(_rate(clock, line.bits), x, y + 5, anchor="rm")
    return fb
