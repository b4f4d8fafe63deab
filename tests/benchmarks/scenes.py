"""Bytes on the I2C wire a frame, in ten scenes of 120 frames; frame 0 is there before the count begins."""

from __future__ import annotations

import importlib.util
import itertools
from statistics import mean
from typing import Any

import measure
import numpy as np
import numpy.typing as npt

from paneldraw import Framebuffer, Panel, simulator
from paneldraw.controllers import SSD1306
from paneldraw.demos.scenes import HEIGHT, SCENES, WIDTH, Scene
from paneldraw.transports import I2CTransport

WANTED = 148
FRAMES = 120
FRAMING = 2  # address byte and control byte
WINDOW = FRAMING + 6 + FRAMING
RUN = FRAMING + 3 + FRAMING

Packed = npt.NDArray[np.bool_]


def frames(scene: Scene, count: int) -> list[Framebuffer]:
    """Frames 0 to `count`."""
    made = [Framebuffer(WIDTH, HEIGHT) for _ in range(count + 1)]
    for number, fb in enumerate(made):
        scene(fb, number)
    return made


def changes(before: Framebuffer, after: Framebuffer) -> Packed:
    """Which bytes of the panel's RAM differ: (pages, columns)."""
    differ: Packed = (before.pixels != after.pixels).reshape(HEIGHT // 8, 8, WIDTH).any(axis=1)
    return differ


def box(changed: Packed) -> int:
    """Bytes of one window around all that changed."""
    pages, columns = np.nonzero(changed)
    return WINDOW + int(np.ptp(pages) + 1) * int(np.ptp(columns) + 1) if len(pages) else 0


def page_runs(changed: Packed) -> int:
    """Bytes of runs that are addressed anew each; a gap is sent with its neighbors where that is no dearer."""
    total = 0
    for page in changed:
        columns = np.flatnonzero(page)
        if len(columns):
            gaps = np.diff(columns) - 1
            total += RUN + len(columns) + int(np.minimum(gaps, RUN).sum())
    return total


def bus() -> simulator.I2CBus:
    """A bus with a panel, which counts its bytes."""
    return simulator.I2CBus({0x3C: simulator.SSD1306(WIDTH, HEIGHT, history=1)}, timer=None)


def ours(pictures: list[Framebuffer]) -> int:
    """Bytes that paneldraw sends; the panel must show each picture."""
    wire = bus()
    with Panel(SSD1306(WIDTH, HEIGHT), I2CTransport(wire)) as panel:
        panel.show(pictures[0])
        start = wire.bytes
        for picture in pictures[1:]:
            panel.show(picture)
            if not np.array_equal(wire.devices[0x3C].pixels, picture.pixels):  # type: ignore[attr-defined]
                raise RuntimeError("the panel shows another picture")
        return wire.bytes - start


def luma(pictures: list[Framebuffer]) -> int:
    """Bytes that luma.oled sends; it writes whole messages only on a bus that it opened itself."""
    import smbus2
    from luma.core.interface.serial import i2c
    from luma.oled.device import ssd1306

    wire = bus()
    real: Any = smbus2.SMBus
    smbus2.SMBus = lambda number: wire
    try:
        device = ssd1306(i2c(port=1), WIDTH, HEIGHT)
    finally:
        smbus2.SMBus = real
    device.persist = True
    start = wire.bytes
    for picture in pictures[1:]:
        device.display(picture.to_image().convert("1"))
    return wire.bytes - start


def run(rounds: int) -> None:
    """Print the table; bytes are the same in every round."""
    count = FRAMES if measure.SAMPLE else 4
    there = importlib.util.find_spec("luma.oled") if importlib.util.find_spec("luma") else None
    if not there:
        print("  without luma.oled; pip install -e '.[bench]' brings it")
    peers = ["luma.oled", "box", "page runs"]
    print(f"  {'':12}{'ours':>9}" + "".join(f"{peer:>12}" for peer in peers))
    rows: list[list[float]] = []
    above = []
    for name, scene in SCENES.items():
        pictures = frames(scene, count)
        steps = [changes(*pair) for pair in itertools.pairwise(pictures)]
        full = luma(pictures) if there else float("nan")
        sums = [ours(pictures), full, sum(map(box, steps)), sum(map(page_runs, steps))]
        rows.append([one / count for one in sums])
        above += [f"{peer} in {name}" for peer, one in zip(peers, sums[1:], strict=True) if sums[0] > one]
        print_row(name, rows[-1])
    means = [mean(column) for column in zip(*rows, strict=True)]
    print_row("mean", means)
    verdict = "below" if means[0] < WANTED else "NOT below"
    share = means[0] / means[-1]
    print(f"  mean {verdict} {WANTED} bytes; {share:.3f} of page runs; above {', '.join(above) or 'no peer'}")


def print_row(name: str, values: list[float]) -> None:
    """Print a scene's bytes a frame."""
    print(f"  {name:12}{values[0]:9.1f}" + "".join(f"{value:12.1f}" for value in values[1:]), flush=True)
