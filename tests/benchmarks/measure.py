"""Contests: a statement of ours beside statements of peers that do the same, timed in turn in one run."""

from __future__ import annotations

import time
import timeit
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from statistics import median
from typing import Any, ClassVar

Names = dict[str, Any]

#: Seconds of CPU time that one sample takes at least; below, the clock's grain shows.
SAMPLE = 0.01


@dataclass(frozen=True)
class Against:
    """A peer's statement. `at_least` is the ratio of its time to ours that we want; `how` names one of several ways."""

    peer: str
    statement: str
    at_least: float | None = None
    how: str = ""

    def __str__(self) -> str:
        return f"{self.peer} ({self.how})" if self.how else self.peer


@dataclass(frozen=True)
class Row:
    """One contest: what it is called, how many calls a statement makes, our statement and the peers'.

    `fastest` is the ratio that we want to whichever peer is the fastest.

    Where a statement is a loop, everybody's is: ``for`` over arguments made beforehand, in the form that the call
    takes, with one call in its body and nothing else.
    """

    name: str
    calls: int
    ours: str
    against: tuple[Against, ...] = ()
    fastest: float | None = None


class Verdicts:
    """How many of the ratios that we want are met, over all contests of a run, and which are not."""

    def __init__(self) -> None:
        self.met = 0
        self.missed: list[str] = []

    def judge(self, row: str, peer: str, ratio: float, wanted: float) -> str:
        """Keep count of a ratio; the word for it."""
        if ratio >= wanted:
            self.met += 1
            return "met"
        self.missed.append(f"{row}: {peer} {ratio:.3g}x, wanted {wanted:.3g}")
        return "NOT met"


VERDICTS = Verdicts()


class Contest:
    """Runs rows. What a peer's statements need is made on first use by its function in `peers`.

    A peer that is not at hand is reported, once, and its places in the rows stay empty. What all need is in `shared`.
    """

    _reported: ClassVar[set[str]] = set()

    def __init__(
        self, names: Names, peers: dict[str, Callable[[], Names]], rounds: int, shared: Names | None = None
    ) -> None:
        self.shared = shared or {}
        self.names = self.shared | names
        self.peers = peers
        self.rounds = rounds
        self._made: dict[str, Names | None] = {}

    def peer(self, name: str) -> Names | None:
        """What a peer's statements need, or None if it is not at hand."""
        if name not in self._made:
            try:
                self._made[name] = self.shared | self.peers[name]()
            except ImportError as error:
                self._miss(name, f"{error}; pip install -e '.[bench]' brings it")
            except OSError as error:  # a library or a compiler that pip does not bring
                self._miss(name, str(error).splitlines()[0])
        return self._made[name]

    def _miss(self, name: str, reason: str) -> None:
        self._made[name] = None
        if name not in self._reported:
            self._reported.add(name)
            print(f"  without {name}: {reason}")

    def run_all(self, rows: Iterable[Row]) -> None:
        """Time rows and print them."""
        for row in rows:
            self.run(row)

    def run(self, row: Row) -> None:
        """Time a row and print it: our time a call, and for each peer its time in multiples of ours."""
        there = [(rival, names) for rival in row.against if (names := self.peer(rival.peer)) is not None]
        timers = [Timer(row.ours, self.names), *(Timer(rival.statement, names) for rival, names in there)]
        samples: list[list[float]] = [[] for _ in timers]
        for turn in range(self.rounds):
            for k in range(len(timers)):
                k = (k + turn) % len(timers)
                samples[k].append(timers[k].sample())
        ours = samples[0]
        ratios = {
            rival: median(their / our for our, their in zip(ours, theirs, strict=True))
            for (rival, _), theirs in zip(there, samples[1:], strict=True)
        }
        fastest = min(ratios, key=lambda rival: ratios[rival], default=None)
        cells = []
        for rival, ratio in ratios.items():
            wanted = max(rival.at_least or 0, row.fastest or 0) if rival is fastest else rival.at_least
            cell = f"{rival} {ratio:.3g}x"
            if wanted:
                cell += f" (wanted {wanted:.3g}: {VERDICTS.judge(row.name, str(rival), ratio, wanted)})"
            cells.append(cell)
        print(f"  {row.name:<44}{1e6 * median(ours) / row.calls:9.3f} us   {'   '.join(cells)}", flush=True)


class Timer:
    """Samples of a statement's CPU time, long enough to be measured."""

    def __init__(self, statement: str, names: Names) -> None:
        self.timer = timeit.Timer(statement, timer=time.process_time, globals=names)
        once = max(self.timer.timeit(1), 1e-9)
        self.number = max(1, round(SAMPLE / once))

    def sample(self) -> float:
        return self.timer.timeit(self.number) / self.number
