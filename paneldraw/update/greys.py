"""Greys on a panel of one bit: a level is how many of the sub-pictures of a cycle a pixel is lit in.

The eye averages what follows fast enough. Sub-pictures are lit as long as each other; each has a weight, which is what
it adds to the light. Where all weigh the same, a pixel's are those that follow one another from its phase on, so that
it changes twice a cycle at the most, and the phase is blue noise: neighbors do not blink together. Where they do not,
the chip's contrast makes one worth several of another, and a level is the sub-pictures that add up to it: fewer
sub-pictures, but white pixels change their brightness within a cycle, and all pixels of a level do so at once.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from paneldraw.controllers.packing import packer
from paneldraw.raster.blue_noise import thresholds
from paneldraw.update import planner_for

if TYPE_CHECKING:
    from paneldraw.controllers import Controller
    from paneldraw.transports.base import Cost

Levels = NDArray[np.uint8]

GREYS: Final = (3, 4, 5, 8, 16)
"""How many greys there can be, black and white among them."""
_WEIGHTS: Final = {3: (1, 1), 4: (1, 2), 5: (1, 1, 2), 8: (1, 2, 4), 16: (1, 2, 4, 8)}
"""What sub-pictures add to the light, where the contrast makes it differ."""
PACES: Final = {
    name: tuple((bytes((0xD5, code << 4)), 54 / (210_000 + 20_000 * code)) for code in range(15, -1, -1))
    for name in ("ssd1306", "ssd1309", "ssd1315", "ssd1312")
}
"""Commands that set how fast a chip scans, and the seconds that it takes a line, by chip, the fastest first.

With `STEADY` before them. Assumed: 370 kHz at code 8, as the sheet of the SSD1306 has it, and even steps to the others;
each chip's own oscillator is off by some percent.
"""
STEADY: Final = b"\xd9\x22"
"""A precharge of 4 of the 54 clocks a line."""
LEAST_RATE: Final = 40.0
"""Cycles a second below which the eye sees them."""


class Response(NamedTuple):
    """How bright a chip's pixels are at each contrast.

    Attributes
    ----------
    light : tuple of float
        Light of a lit pixel at contrast 0, 1, ... 255, rising; only their ratios matter.
    source : str
        Where the figures come from, and whether they were measured.
    """

    light: tuple[float, ...]
    source: str

    def contrasts(self, weights: Sequence[int], most: int) -> tuple[int, ...]:
        """Return the contrasts that give light in the ratio of weights, the heaviest at contrast `most`.

        Raises
        ------
        ValueError
            The table is no table of 256 rising figures.
        """
        if len(self.light) != 256 or any(a > b for a, b in itertools.pairwise(self.light)) or self.light[-1] <= 0:
            raise ValueError(f"light must be 256 figures that rise, one a contrast, not {len(self.light)}")
        unit = self.light[most] / max(weights)
        return tuple(int(np.abs(np.array(self.light) - unit * weight).argmin()) for weight in weights)


EVEN: Final = Response(
    tuple(contrast / 256 for contrast in range(256)),
    "assumed: the segment current of the SSD1306's data sheet, contrast / 256 x IREF x scale, and light like current",
)
"""Light as the contrast, for chips of which no panel was measured."""
RESPONSES: Final[dict[str, Response]] = dict.fromkeys(("ssd1306", "ssd1309", "ssd1315", "ssd1312", "ssd1316"), EVEN)
"""By chip; put a measured one in the place of an assumed one."""


class Cycle:
    """The sub-pictures that make some greys.

    Parameters
    ----------
    greys : int
        How many levels: 3, 4, 5, 8 or 16.
    weighted : bool, optional
        Whether the contrast makes sub-pictures worth more than others. Default: False.

    Attributes
    ----------
    weights : tuple of int
        What each sub-picture adds to a level, in order of their numbers; the sum is the highest level.

    Raises
    ------
    ValueError
        Any other number of greys.

    Examples
    --------
    >>> Cycle(4).weights, Cycle(4, weighted=True).weights
    ((1, 1, 1), (1, 2))
    >>> Cycle(4).pictures(np.array([[0, 1, 2, 3]], np.uint8)).sum(axis=0).tolist()
    [[0, 1, 2, 3]]
    """

    def __init__(self, greys: int, *, weighted: bool = False) -> None:
        if greys not in GREYS:
            raise ValueError(f"greys must be one of {', '.join(map(str, GREYS))}, not {greys!r}")
        self.greys, self.weighted = greys, weighted
        self.weights = _WEIGHTS[greys] if weighted else (1,) * (greys - 1)
        self._turns = 1 if weighted else greys - 1
        self._lit = _lit_by_weight(self.weights) if weighted else _lit_by_phase(greys)

    def steps(self, levels: Levels, max_level: int, gamma: float = 1.0) -> Levels:
        """Return which of the greys each level is nearest to, by its share of light, (level / max_level) ** gamma."""
        shares = (np.arange(max_level + 1) / max_level) ** gamma
        return np.floor(shares * (self.greys - 1) + 0.5).astype(np.uint8)[levels]

    def pictures(self, steps: Levels) -> Levels:
        """Return the sub-pictures, 0 and 1, shape (sub-pictures, height, width), in the order of `weights`."""
        height, width = steps.shape
        return self._lit[:, steps, phases(height, width, self._turns)]

    def order(self, packed: Sequence[NDArray[np.uint8]]) -> tuple[int, ...]:
        """Return the order of sub-pictures, round and round, in which the fewest packed bytes change."""
        if self._turns > 1 or len(packed) < 4:  # each pixel's follow one another; of three there is but one order
            return tuple(range(len(packed)))
        changed = [[np.count_nonzero(one != other) for other in packed] for one in packed]
        orders = ((0, *rest) for rest in itertools.permutations(range(1, len(packed))))
        return min(
            orders, key=lambda order: sum(changed[a][b] for a, b in zip(order, order[1:] + order[:1], strict=True))
        )


def _lit_by_phase(greys: int) -> Levels:
    """Which sub-pictures a pixel is lit in, by sub-picture, level and phase: the level's number from its phase on."""
    turns = greys - 1
    place, level, phase = np.ogrid[:turns, :greys, :turns]
    return ((place - phase) % turns < level).astype(np.uint8)


def _lit_by_weight(weights: tuple[int, ...]) -> Levels:
    """The same where they add up to the level, the heavy ones first."""
    lit = np.zeros((len(weights), sum(weights) + 1, 1), np.uint8)
    for level in range(lit.shape[1]):
        rest = level
        for place in sorted(range(len(weights)), key=lambda place: -weights[place]):
            lit[place, level] = weights[place] <= rest
            rest -= weights[place] * int(lit[place, level, 0])
    return lit


@functools.lru_cache(8)
def phases(height: int, width: int, count: int) -> NDArray[np.intp]:
    """Return the sub-picture that each pixel's light begins with, 0 ... `count` - 1, in blue noise."""
    noise = thresholds().astype(np.intp) * count >> 8
    found = np.tile(noise, (-(-height // 64), -(-width // 64)))[:height, :width]
    found.flags.writeable = False
    return found


class Forecast(NamedTuple):
    """What the cycles of a picture take on the wire.

    Attributes
    ----------
    wire_bytes : tuple of int
        Of each sub-picture, coming from the one before.
    messages : tuple of int
    """

    wire_bytes: tuple[int, ...]
    messages: tuple[int, ...]

    def slot(self, clock: float, bus_share: float = 1.0) -> float:
        """Return the seconds that each sub-picture gets: all as many as the largest takes on an I2C bus."""
        each = zip(self.wire_bytes, self.messages, strict=True)
        return max(9 * size + count + (size > 0) for size, count in each) / clock / bus_share

    def rate(self, clock: float, bus_share: float = 1.0) -> float:
        """Return cycles a second at a clock in Hz; infinite where nothing changes.

        Examples
        --------
        >>> round(Forecast((299, 299, 299), (1, 1, 1)).rate(400_000), 1)
        49.5
        """
        slot = self.slot(clock, bus_share)
        return 1 / (len(self.wire_bytes) * slot) if slot else float("inf")


class Forecaster:
    """Says what cycles take, by a planner of its own: nothing is sent.

    Parameters
    ----------
    controller : Controller
        Of one bit a pixel.
    cost : Cost
        What a message costs on the transport.
    updates : str, optional
        As `Panel` has it.
    """

    def __init__(self, controller: Controller, cost: Cost, updates: str = "least") -> None:
        self._planner = planner_for(controller, cost, updates)
        self._pack, self._bands = packer(controller), controller.bands
        self._contrast = 0 if controller.contrast is None else cost.command + len(controller.contrast.commands(0)[0])

    def packed(self, pictures: Levels) -> list[NDArray[np.uint8]]:
        """Return sub-pictures as the panel's RAM has them."""
        found = []
        for picture in pictures:
            out = np.zeros_like(self._planner.fresh)
            self._pack(np.hstack(np.split(picture, self._bands)), 1, out)
            found.append(out)
        return found

    def forecast(self, cycle: Cycle, packed: Sequence[NDArray[np.uint8]], order: Sequence[int]) -> Forecast:
        """Return what a cycle takes when it goes round and round."""
        sizes, counts = [], []
        for turn in (*order, *order):  # twice: the first time has to come to it
            np.copyto(self._planner.fresh, packed[turn])
            plan = self._planner.plan()
            sizes.append(plan.cost if plan.count else 0)
            counts.append(plan.count)
            if plan.count:
                self._planner.sent()
        sizes, counts = sizes[len(order) :], counts[len(order) :]
        if any(sizes) and len(set(cycle.weights)) > 1:
            sizes, counts = [size + self._contrast for size in sizes], [count + 1 for count in counts]
        return Forecast(tuple(sizes), tuple(counts))


class Choice(NamedTuple):
    """The cycle for a picture."""

    cycle: Cycle
    packed: list[NDArray[np.uint8]]
    """The sub-pictures, in the order in which they are sent."""
    weights: tuple[int, ...]
    forecast: Forecast
    slot: float
    """Seconds that each sub-picture gets; 0 where there is no grey."""
    pace: bytes
    """The command for a scan that takes as long, so that each sub-picture is scanned once; empty where there is none.

    Else some sub-pictures of a cycle would be scanned twice and others not at all.
    """

    @property
    def rate(self) -> float:
        """Cycles a second."""
        return 1 / (self.slot * len(self.packed)) if self.slot else float("inf")


def choose(
    forecaster: Forecaster,
    levels: Levels,
    max_level: int,
    greys: int,
    clock: float,
    *,
    weighted: bool = False,
    bus_share: float = 0.8,
    gamma: float = 1.0,
    paces: Sequence[tuple[bytes, float]] = (),
) -> Choice | None:
    """Return the cycle with the most greys, up to `greys`, that keeps to `LEAST_RATE`; None where there is none.

    `clock` is the bits a second of the wire, and `paces` are commands and the seconds that a scan takes then, rising.
    """
    for fewer in (grey for grey in reversed(GREYS) if grey <= greys):
        cycle = Cycle(fewer, weighted=weighted)
        packed = forecaster.packed(cycle.pictures(cycle.steps(levels, max_level, gamma)))
        order = cycle.order(packed)
        forecast = forecaster.forecast(cycle, packed, order)
        needed = forecast.slot(clock, bus_share)
        pace, slot = next(((pace, slot) for pace, slot in paces if slot >= needed > 0), (b"", needed))
        weights = tuple(cycle.weights[place] for place in order)
        choice = Choice(cycle, [packed[place] for place in order], weights, forecast, slot, pace)
        if choice.rate >= LEAST_RATE:
            return choice
    return None
