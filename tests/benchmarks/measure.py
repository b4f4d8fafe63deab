"""Contests: a statement of ours beside statements of peers that do the same, timed in turn in one run."""

from __future__ import annotations

import time
import timeit
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median
from typing import Any

Names = dict[str, Any]

#: Seconds of CPU time that one sample takes at least; below, the clock's grain shows.
SAMPLE = 0.01


@dataclass(frozen=True)
class Against:
    """A peer's statement. `at_least` is the ratio of its time to ours that we want."""

    peer: str
    statement: str
    at_least: float | None = None


@dataclass(frozen=True)
class Row:
    """One contest: what it is called, how many calls a statement makes, our statement and the peers'."""

    name: str
    calls: int
    ours: str
    against: tuple[Against, ...] = ()


class Contest:
    """Runs rows. What a peer's statements need is made on first use by its function in `peers`.

    A peer that cannot be imported is reported, and its places in the rows stay empty.
    """

    def __init__(self, names: Names, peers: dict[str, Callable[[], Names]], rounds: int) -> None:
        self.names = names
        self.rounds = rounds
        self.peers: dict[str, Names | None] = {}
        for peer, names_of in peers.items():
            try:
                self.peers[peer] = names | names_of()
            except ImportError as error:
                self.peers[peer] = None
                print(f"  without {peer}: {error}; pip install -e '.[bench]' brings it")

    def run(self, row: Row) -> None:
        """Time a row and print it: our time a call, and for each peer its time in multiples of ours."""
        there = [rival for rival in row.against if self.peers[rival.peer] is not None]
        timers = [Timer(row.ours, self.names), *(Timer(r.statement, self.peers[r.peer] or {}) for r in there)]
        samples: list[list[float]] = [[] for _ in timers]
        for turn in range(self.rounds):
            for k in range(len(timers)):
                k = (k + turn) % len(timers)
                samples[k].append(timers[k].sample())
        ours = samples[0]
        cells = []
        for rival, theirs in zip(there, samples[1:], strict=True):
            ratio = median(their / our for our, their in zip(ours, theirs, strict=True))
            wanted = f" (wanted {rival.at_least:g})" if rival.at_least else ""
            cells.append(f"{rival.peer} {ratio:.3g}x{wanted}")
        print(f"  {row.name:<44}{1e6 * median(ours) / row.calls:9.3f} us   {'   '.join(cells)}", flush=True)


class Timer:
    """Samples of a statement's CPU time, long enough to be measured."""

    def __init__(self, statement: str, names: Names) -> None:
        self.timer = timeit.Timer(statement, timer=time.process_time, globals=names)
        once = max(self.timer.timeit(1), 1e-9)
        self.number = max(1, round(SAMPLE / once))

    def sample(self) -> float:
        return self.timer.timeit(self.number) / self.number
