"""A system monitor: how busy a machine is, in bars, and how busy it was, as a chart."""

from __future__ import annotations

import math

from .. import Font, Framebuffer
from ..widgets import Chart, Number, ProgressBar, Sparkline

HISTORY = 60
"""Seconds that the chart shows."""


def load(t: float) -> float:
    """How busy the processor is, 0 ... 1: here it is made up; psutil.cpu_percent() / 100 would measure it."""
    return 0.45 + 0.25 * math.sin(t / 9) + 0.12 * math.sin(t / 2.3) + 0.08 * math.sin(12.9898 * math.floor(t))


def draw(fb: Framebuffer, t: float) -> None:
    """Draw three bars with their names where there is room, and below them the chart."""
    fb.clear()
    row = Font.builtin().height + 1
    shares = {"CPU": load(t), "MEM": 0.61 + 0.02 * math.sin(t / 31), "SSD": 0.34}
    if fb.height < 2 * row:
        ProgressBar(shares["CPU"]).draw(fb, 0, 0, fb.width, fb.height)
        return
    shown = 3 if fb.height >= 6 * row else 1
    for number, (name, share) in enumerate(list(shares.items())[:shown]):
        y = number * row
        if fb.width < 60:
            ProgressBar(share).draw(fb, 0, y, fb.width, row - 2)
            continue
        fb.text(name, 0, y)
        ProgressBar(share).draw(fb, 22, y, fb.width - 22 - 27, row - 2)
        fb.text(f"{share:.0%}", fb.width - 1, y, anchor="rt")
    top = shown * row + 1
    loads = [100 * load(t - ago) for ago in range(HISTORY, -1, -1)]
    if fb.width < 100:
        Sparkline(loads, low=0, high=100, fill=True).draw(fb, 0, top)
    else:
        Chart(loads, xs=range(-HISTORY, 1), low=0, high=100, fill=True).draw(fb, 0, top, fb.width - 34)
        Number(48 + 14 * load(t - 5), "°C", form=".0f").draw(fb, fb.width - 32, top)
