"""The blue noise of `paneldraw.raster.blue_noise`, found anew; prints the text that is stored there.

R. Ulichney, "The void-and-cluster method for dither array generation", Proc. SPIE 1913 (1993), 332-343.
"""

from __future__ import annotations

import base64

import numpy as np

SIDE = 64
SIGMA = 1.5


class Pattern:
    """Lit places on a square that repeats, and how crowded each place is: the sum of a bell over all lit ones."""

    def __init__(self, lit):
        distance = np.minimum(np.arange(SIDE), SIDE - np.arange(SIDE)) ** 2
        # Whole numbers add up alike on every machine, in every order.
        bell = np.rint(2**30 * np.exp(-(distance[:, np.newaxis] + distance) / (2 * SIGMA**2))).astype(np.int64)
        self.bells = np.tile(bell, (2, 2))
        self.lit = np.zeros((SIDE, SIDE), bool)
        self.crowd = np.zeros((SIDE, SIDE), np.int64)
        for y, x in np.argwhere(lit):
            self.turn((y, x))

    def turn(self, place):
        """Light a place, or let it go dark."""
        y, x = place
        bell = self.bells[SIDE - y : 2 * SIDE - y, SIDE - x : 2 * SIDE - x]
        self.crowd += -bell if self.lit[y, x] else bell
        self.lit[y, x] ^= True

    def cluster(self):
        """The lit place with the most others around it."""
        return np.unravel_index(np.where(self.lit, self.crowd, -1).argmax(), self.lit.shape)

    def void(self):
        """The dark place with the fewest lit ones around it."""
        return np.unravel_index(np.where(self.lit, 1 << 62, self.crowd).argmin(), self.lit.shape)


def even_pattern():
    """A tenth of the places, moved from clusters to voids until that changes nothing."""
    lit = np.zeros(SIDE * SIDE, bool)
    lit[np.random.RandomState(1993).permutation(SIDE * SIDE)[: SIDE * SIDE // 10]] = True
    pattern = Pattern(lit.reshape(SIDE, SIDE))
    while True:
        place = pattern.cluster()
        pattern.turn(place)
        void = pattern.void()
        pattern.turn(void)
        if void == place:
            return pattern.lit


def ranks():
    """The order in which places are lit: the start's, the last one first to come, then void after void."""
    start = even_pattern()
    rank = np.zeros((SIDE, SIDE), int)
    pattern = Pattern(start)
    for number in reversed(range(start.sum())):
        place = pattern.cluster()
        pattern.turn(place)
        rank[place] = number
    pattern = Pattern(start)
    for number in range(start.sum(), SIDE * SIDE):
        # The last half by the same rule: a dark place that is the most crowded by dark ones has the fewest lit ones.
        place = pattern.void()
        pattern.turn(place)
        rank[place] = number
    return rank


def text():
    """The thresholds 0 ... 255, row by row, as base 85."""
    return base64.b85encode((ranks() * 256 // SIDE**2).astype(np.uint8).tobytes()).decode()


if __name__ == "__main__":
    written = text()
    print("\n".join(f'    "{written[at : at + 110]}"' for at in range(0, len(written), 110)))
