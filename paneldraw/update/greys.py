"""Greys on a panel of one bit: a level is how many of the sub-pictures of a cycle a pixel is lit in.

The eye averages what follows fast enough. Each sub-picture has a weight, which is what it adds to the light. There are
three ways:

- All weigh the same. A pixel's are those that follow one another from its phase on, so that it changes twice a cycle at
  the most, and the phase is blue noise: neighbors do not blink together.
- Timed: one lasts as long as several of another, and a level is the sub-pictures that add up to it. They are fewer, for
  a slower wire, but all pixels of a level blink together.
- Weighted: the contrast makes one worth several of another. They are fewer and take less time, but white pixels change
  their brightness within a cycle, and a line that is scanned between the contrast and its data shows the wrong ones
  together.

Chips scan their lines all the time. A sub-picture is to be scanned as often as it weighs: so it lasts as long as some
scans, and each byte comes at the same time of its slot, as all that ever move in a cycle are sent in the same order.
Then it does not matter when the scan comes by, which nobody can tell.
"""

from __future__ import annotations

import functools
import itertools
import math
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
"""What sub-pictures add to the light, where time or contrast makes it differ."""
LEAST_RATE: Final = 40.0
"""Cycles a second below which the eye sees them."""
STEADY_RATE: Final = 50.0
"""Cycles a second from which on more are no better."""
SHORTEST: Final = 1 / 160
"""Seconds that a sub-picture lasts at least on a chip of which no pace is known: few scan faster."""
_GOLDEN: Final = (math.sqrt(5) - 1) / 2
TORN: Final = 1 / 8
"""By how much of a scan a sub-picture may last too long: so many lines show it once too often."""


class Pace(NamedTuple):
    """How fast a chip scans."""

    line_seconds: float
    """Seconds that it takes a line."""
    commands: tuple[bytes, ...]
    """What makes it so fast."""


def _paces() -> tuple[Pace, ...]:
    """Paces of the SSD1306 and its like: 50 clocks a line and 2 to 5 of precharge, at 16 speeds of the oscillator."""
    found = [
        Pace((51 + last) / (210_000 + 20_000 * code), (bytes((0xD9, last << 4 | 1)), bytes((0xD5, code << 4))))
        for code in range(16)
        for last in range(1, 5)
    ]
    return tuple(sorted(found))


PACES: Final = dict.fromkeys(("ssd1306", "ssd1309", "ssd1315", "ssd1312"), _paces())
"""By chip, the fastest first.

Assumed: 370 kHz at code 8, as the sheet of the SSD1306 has it, and even steps to the others; each chip's own oscillator
is off by up to a tenth.
"""


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
        rising = all(a <= b for a, b in itertools.pairwise(self.light))  # which nothing is beside a NaN
        if len(self.light) != 256 or not rising or not 0 < self.light[-1] < math.inf:
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
    timed : bool, optional
        Whether some last longer than others. Default: False.

    Attributes
    ----------
    weights : tuple of int
        What each sub-picture adds to a level, in order of their numbers; the sum is the highest level.
    lasts : tuple of int
        How long each lasts, in scans.

    Raises
    ------
    ValueError
        Any other number of greys, or both ways at once.

    Examples
    --------
    >>> Cycle(4).weights, Cycle(4, weighted=True).weights
    ((1, 1, 1), (1, 2))
    >>> Cycle(4, timed=True).lasts
    (1, 2)
    >>> Cycle(4).pictures(np.array([[0, 1, 2, 3]], np.uint8)).sum(axis=0).tolist()
    [[0, 1, 2, 3]]
    """

    def __init__(self, greys: int, *, weighted: bool = False, timed: bool = False) -> None:
        if greys not in GREYS:
            raise ValueError(f"greys must be one of {', '.join(map(str, GREYS))}, not {greys!r}")
        if weighted and timed:
            raise ValueError("weighted and timed must not both be True")
        self.greys, self.weighted, self.timed = greys, weighted, timed
        together = weighted or timed
        self.weights = _WEIGHTS[greys] if together else (1,) * (greys - 1)
        self.lasts = self.weights if timed else (1,) * len(self.weights)
        self._turns = 1 if together else greys - 1
        self._lit = _lit_by_weight(self.weights) if together else _lit_by_phase(greys)

    def steps(self, levels: Levels, max_level: int, gamma: float = 1.0) -> Levels:
        """Return which of the greys each level is nearest to, by its share of light, (level / max_level) ** gamma."""
        shares = (np.arange(max_level + 1) / max_level) ** gamma
        return np.floor(shares * (self.greys - 1) + 0.5).astype(np.uint8)[levels]

    def pictures(self, steps: Levels) -> Levels:
        """Return the sub-pictures, 0 and 1, shape (sub-pictures, height, width), in the order of `weights`."""
        height, width = steps.shape
        return self._lit[:, steps, phases(height, width, self._turns)]


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


def in_greys(levels: Levels, max_level: int, greys: int) -> Levels:
    """Return which of the grays each level is, so that rows keep their light.

    A pixel takes what the levels so far in its row add up to, less what the pixels before it took. It is off by less
    than a gray, and black and white are kept; but a line of gray pixels is as bright as it was drawn, where the nearest
    grays made it darker at one angle than at another. Where each row begins to round is one golden section further, so
    that the rows of an upright line do not all round the same way.

    Examples
    --------
    >>> in_greys(np.array([[0, 64, 64, 64, 64, 255]], np.uint8), 255, 4).tolist()
    [[0, 0, 1, 1, 1, 3]]
    """
    begin = (np.arange(len(levels)) * _GOLDEN % 1 * max_level).astype(np.int32)
    light = np.cumsum(levels, axis=1, dtype=np.int32) * np.int32(greys - 1)
    return np.diff((light + begin[:, None]) // max_level, axis=1, prepend=0).astype(np.uint8)


@functools.lru_cache(8)
def phases(height: int, width: int, count: int) -> NDArray[np.intp]:
    """Return the sub-picture that each pixel's light begins with, 0 ... `count` - 1, in blue noise."""
    noise = thresholds().astype(np.intp) * count >> 8
    found = np.tile(noise, (-(-height // 64), -(-width // 64)))[:height, :width]
    found.flags.writeable = False
    return found


class Forecast(NamedTuple):
    """What each sub-picture of a cycle takes on the wire."""

    wire_bytes: int
    messages: int

    def seconds(self, clock: float) -> float:
        """Return how long it takes on an I2C bus of a clock in Hz; 0 where nothing changes.

        Examples
        --------
        >>> round(1000 * Forecast(299, 1).seconds(400_000), 2)
        6.73
        """
        return (9 * self.wire_bytes + self.messages + 1) / clock if self.messages else 0.0


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
        self._controller, self._pack = controller, packer(controller)
        contrast = () if controller.contrast is None else controller.contrast.commands(0)
        self._contrast = cost.command + sum(map(len, contrast))
        self._planner.plan()
        self._planner.sent()

    def packed(self, pictures: Levels) -> list[NDArray[np.uint8]]:
        """Return sub-pictures as the panel's RAM has them."""
        found = []
        for picture in pictures:
            out = np.zeros_like(self._planner.fresh)
            self._pack(self._controller.arranged(picture), 1, out)
            found.append(out)
        return found

    def forecast(self, cycle: Cycle, moving: NDArray[np.bool_]) -> Forecast:
        """Return what a sub-picture takes that sends all bytes that ever move in a cycle."""
        planner = self._planner
        for _ in range(2):  # twice: the first time the chip may have to be told how it is addressed
            np.invert(planner.fresh, out=planner.shadow, where=moving)
            planner.doubt()
            plan = planner.plan()
            size, count = (plan.cost, plan.count) if plan.count else (0, 0)
            planner.sent()
        return Forecast(size + self._contrast, count + 1) if count and cycle.weighted else Forecast(size, count)


class Choice(NamedTuple):
    """The cycle for a picture."""

    cycle: Cycle
    packed: list[NDArray[np.uint8]]
    """The sub-pictures, in the order in which they are sent."""
    moving: NDArray[np.bool_]
    """Which bytes ever change. All are sent each time, so that each comes at the same time of every slot.

    A line that is scanned before its byte comes in one slot, and behind it in the next, would show a sub-picture twice.
    """
    forecast: Forecast
    seconds: tuple[float, ...]
    """How long each sub-picture lasts; empty where there is no grey."""
    pace: Pace | None
    """A scan takes a slot then, so that each sub-picture is scanned just so often.

    Else some sub-pictures of a cycle would be scanned twice and others not at all.
    """

    @property
    def rate(self) -> float:
        """Cycles a second; infinite where nothing changes."""
        return 1 / sum(self.seconds) if self.seconds else float("inf")


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
    paces: Sequence[Pace] = (),
    lines: int = 64,
) -> Choice | None:
    """Return the cycle with the most greys, up to `greys`, that keeps to `LEAST_RATE`; None where there is none.

    `clock` is the bits a second of the wire; `paces` are rising, for a chip of so many `lines`.
    Of two ways that are steady the one is taken in which neighbors do not blink together.
    """
    for fewer in (grey for grey in reversed(GREYS) if grey <= greys):
        best: Choice | None = None
        for cycle in _ways(fewer, weighted):
            steps = cycle.steps(levels, max_level, gamma)
            choice = laid_out(forecaster, cycle, steps, clock, bus_share=bus_share, paces=paces, lines=lines)
            if best is None or choice.rate > best.rate:
                best = choice
            if best.rate >= STEADY_RATE:
                break
        if best is not None and best.rate >= LEAST_RATE:
            return best
    return None


def laid_out(
    forecaster: Forecaster,
    cycle: Cycle,
    steps: Levels,
    clock: float,
    *,
    bus_share: float = 0.8,
    paces: Sequence[Pace] = (),
    lines: int = 64,
) -> Choice:
    """Return a cycle for a picture in its greys, however long it takes; the rest is as in `choose`."""
    packed = forecaster.packed(cycle.pictures(steps))
    moving = functools.reduce(np.logical_or, (one != packed[0] for one in packed[1:]))
    forecast = forecaster.forecast(cycle, moving)
    seconds, pace = _slots(cycle, forecast.seconds(clock), bus_share, paces, lines)
    return Choice(cycle, packed, moving, forecast, seconds, pace)


def _ways(greys: int, weighted: bool) -> tuple[Cycle, ...]:
    if weighted:
        return (Cycle(greys, weighted=True),)
    return (Cycle(greys), Cycle(greys, timed=True)) if greys > 3 else (Cycle(greys),)


def _slots(
    cycle: Cycle, taken: float, bus_share: float, paces: Sequence[Pace], lines: int
) -> tuple[tuple[float, ...], Pace | None]:
    """Return how long each sub-picture lasts that takes so many seconds on the wire, and the pace of the scan."""
    if not taken:
        return (), None
    count, scans = len(cycle.lasts), sum(cycle.lasts)
    least = max(count * taken / (scans * bus_share), taken / (1 + TORN))
    wanted = max(least, min(taken, 1 / (STEADY_RATE * scans)))  # no more is torn than makes it steady
    able = [pace for pace in paces if lines * pace.line_seconds >= least]
    pace = next((pace for pace in reversed(able) if lines * pace.line_seconds <= wanted), able[0] if able else None)
    scan = lines * pace.line_seconds if pace else max(wanted, 0.0 if paces else SHORTEST)
    seconds = [max(scan * lasts, taken) for lasts in cycle.lasts]
    seconds[cycle.lasts.index(max(cycle.lasts))] -= sum(seconds) - scan * scans
    return tuple(seconds), pace
