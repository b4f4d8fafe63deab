"""Pong: two players, a ball, and one who misses it in the end."""

from __future__ import annotations

import math

from .. import Font, Framebuffer, Supersample

CROSSING = 1.2
"""Seconds that the ball takes from one player to the other."""
RALLY = 6
"""Crossings a rally; the last one is missed, and every second rally is one crossing shorter."""


def draw(fb: Framebuffer, t: float) -> None:
    """Draw the court as it is at a moment: where the ball is follows from the time alone."""
    fb.clear()
    crossing = t / CROSSING
    pair, place = divmod(crossing, 2 * RALLY - 1)
    second = place >= RALLY
    leg = place - RALLY if second else place
    missed = leg >= RALLY - 1 - second
    rightward = int(leg) % 2 == 0
    size = max(min(fb.width, fb.height) // 16, 1)
    height = max(fb.height // 4, 2)
    reach = fb.width - 1 - 4 * size + (3 * size if missed else 0)
    x = 2 * size + reach * (leg % 1) if rightward else fb.width - 1 - 2 * size - reach * (leg % 1)
    y = _bounce(crossing * 0.71, fb.height - size) + (size - 1) / 2
    for is_right in (False, True):
        # Each goes after the ball; the one that misses it is ever later.
        late = 0.3 * (leg % 1) if missed and is_right == rightward else 0.0
        top = _bounce((crossing - late) * 0.71, fb.height - size) - (height - size) / 2
        top = min(max(top, 0), fb.height - height)
        fb.rect(fb.width - 1 - size if is_right else 1, round(top), size, height, fill=True)
    fb.line((fb.width - 1) / 2, 0, (fb.width - 1) / 2, fb.height - 1, max(fb.max_level // 3, 1), dash=(2, 4))
    fb.circle(x, y, size / 2, fill=True, antialias=Supersample(4) if fb.depth > 1 else None)
    if fb.width >= 64 and fb.height >= 32:
        font = Font.builtin().scaled(2 if fb.height >= 48 else 1)
        for score, side, anchor in ((int(pair) + second, -1, "rt"), (int(pair), 1, "lt")):
            fb.text(str(score % 10), fb.width // 2 + side * fb.width // 10, 1, font=font, anchor=anchor)


def _bounce(way: float, room: float) -> float:
    """Where something is that runs to and fro between 0 and `room`, once in two units of `way`."""
    return room * math.acos(math.cos(math.pi * way)) / math.pi
