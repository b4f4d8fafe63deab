"""Bytes on the I2C wire a frame, in ten scenes of 120 frames; frame 0 is there before the count begins."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from statistics import mean
from typing import Any

import measure
import numpy as np
import numpy.typing as npt
import peers
import smbus2

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
Show = Callable[[Framebuffer, peers.Mask], object]


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


def full(changed: Packed) -> int:
    """Bytes of one window of all there is."""
    return WINDOW + changed.size


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


class Panels:
    """Pictures brought onto a simulated panel, which must show each; counts bytes from the second on."""

    def __init__(self) -> None:
        self.chip = simulator.SSD1306(WIDTH, HEIGHT, history=1)
        self.bus = simulator.I2CBus({peers.ADDRESS: self.chip}, timer=None)

    def write(self, address: int, data: Any) -> None:
        """Write as ``busio.I2C`` does."""
        self.bus.i2c_rdwr(smbus2.i2c_msg.write(address, bytes(data)))

    def count(self, show: Show, pictures: list[Framebuffer]) -> int:
        """Bytes that a driver sends; `show` takes a picture and which of its pixels differ from the one before."""
        shown = np.zeros((HEIGHT, WIDTH), np.uint8)
        start = 0
        for number, picture in enumerate(pictures):
            show(picture, picture.pixels != shown)
            shown = picture.pixels
            if not np.array_equal(self.chip.pixels, shown):
                raise RuntimeError(f"the panel shows something else than picture {number}")
            start = start or self.bus.bytes
        return self.bus.bytes - start


def ours(panel: Panels) -> Show:
    """paneldraw."""
    show = Panel(SSD1306(WIDTH, HEIGHT), I2CTransport(panel.bus)).show
    return lambda picture, changed: show(picture)


def luma(panel: Panels) -> Show:
    """luma.oled, whole frames."""
    device = peers.luma(panel.bus)
    return lambda picture, changed: device.display(picture.to_image().convert("1"))


def adafruit(panel: Panels) -> Show:
    """Adafruit's driver, whole frames."""
    device = peers.adafruit(panel.write)
    return lambda picture, changed: peers.draw(device, picture.pixels, changed)


def displayio(panel: Panels) -> Show:
    """displayio, rectangles around what the script set: here, no more than what changed."""
    device = peers.Displayio(panel.write)
    return lambda picture, changed: peers.draw(device, picture.pixels, changed)


DRIVERS = {"ours": ours, "luma.oled": luma, "Adafruit": adafruit, "displayio": displayio}
RULES = {"full frame": full, "box": box, "page runs": page_runs}


def there(name: str) -> bool:
    """Whether a driver can be imported; says so if not."""
    try:
        DRIVERS[name](Panels())
    except ImportError as error:
        print(f"  without {name}: {error}; pip install -e '.[bench]' brings it")
        return False
    return True


def run(rounds: int) -> None:
    """Print the table; bytes are the same in every round."""
    count = FRAMES if measure.SAMPLE else 4
    drivers = [name for name in DRIVERS if there(name)]
    names = [*drivers, *RULES]
    print(f"  {'':12}" + "".join(f"{name:>11}" for name in names))
    table = []
    above = []
    for scene, draw in SCENES.items():
        pictures = frames(draw, count)
        steps = [changes(*pair) for pair in itertools.pairwise(pictures)]
        sums = [panel.count(DRIVERS[name](panel), pictures) for name in drivers for panel in (Panels(),)]
        sums += [sum(map(rule, steps)) for rule in RULES.values()]
        above += [f"{name} in {scene}" for name, one in zip(names, sums, strict=True) if sums[0] > one]
        table.append([one / count for one in sums])
        print_row(scene, table[-1])
    means = [mean(column) for column in zip(*table, strict=True)]
    print_row("mean", means)
    verdict = "below" if means[0] < WANTED else "NOT below"
    share = means[0] / means[-1]
    print(f"  mean {verdict} {WANTED} bytes; {share:.3f} of page runs; above {', '.join(above) or 'no peer'}")


def print_row(name: str, values: list[float]) -> None:
    """Print a scene's bytes a frame."""
    print(f"  {name:12}" + "".join(f"{value:11.1f}" for value in values), flush=True)
