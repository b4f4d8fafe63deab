"""Where the outline of a closed shape lies: half of its width on either side of the true one, or inside, or outside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from paneldraw.framebuffer.arguments import choice, line_width, real

if TYPE_CHECKING:
    from typing import TypeAlias

    Number: TypeAlias = int | float

ALIGNMENTS = {"center": 0, "inside": 1, "outside": 2}


def outward(align: Any, width: Any) -> Number:
    """How far the true outline moves outward, in pixels: the shape reaches half a pixel beyond it."""
    side = choice("align", align, ALIGNMENTS)
    thickness = line_width(width)
    off = (0, 256 - thickness, 256 + thickness)[side]
    return off // 512 if off % 512 == 0 else off / 512


def aligned_box(box: tuple[Any, Any, Any, Any], off: Number) -> tuple[Number, Number, Number, Number] | None:
    """The box (x, y, w, h) moved outward; None if nothing of it would be left."""
    x, y, w, h = (real(name, value) for name, value in zip("xywh", box, strict=True))
    if min(w, h) <= 0:
        return x, y, w, h
    return (x - off, y - off, w + 2 * off, h + 2 * off) if min(w, h) + 2 * off > 0 else None


def aligned_radius(name: str, r: Any, off: Number) -> Number | None:
    """The radius moved outward; None if nothing of it would be left."""
    radius = real(name, r)
    if radius < 0:
        return radius
    return radius + off if radius + off >= 0 else None
