"""Lines, a cube and a clock together: demos drawn into parts of a panel."""

from __future__ import annotations

from .. import Framebuffer
from . import clock, cube, lines


def draw(fb: Framebuffer, t: float) -> None:
    """Give one half to the lines and share the other between the cube and the clock."""
    fb.clear()
    upper, lower = _halves((0, 0, fb.width, fb.height), beside=fb.width >= 3 * fb.height)
    _, _, width, height = lower
    for demo, part in zip((lines, cube, clock), (upper, *_halves(lower, beside=width >= height)), strict=True):
        x, y, w, h = part
        piece = Framebuffer(w, h, fb.depth)
        demo.draw(piece, t)
        fb.pixels[y : y + h, x : x + w] = piece.pixels


def _halves(box: tuple[int, int, int, int], *, beside: bool) -> tuple[tuple[int, int, int, int], ...]:
    """Split (x, y, width, height) into two parts beside or above each other, a blank line between them."""
    x, y, w, h = box
    if beside:
        near = (w - 1) // 2
        return (x, y, near, h), (x + w - near, y, near, h)
    near = (h - 1) // 2
    return (x, y, w, near), (x, y + h - near, w, near)
