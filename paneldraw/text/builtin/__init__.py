"""The fonts that are part of this package, drawn in ``#`` and ``.``, read when one is asked for."""

from __future__ import annotations

from paneldraw.text.strike import Strike

NAMES = ("6x8", "8x8", "numbers", "segments")

_MISSING = 0xFFFD


def strike(name: str) -> Strike:
    """Read the font of that name."""
    if name not in NAMES:
        raise ValueError(f"there is no built-in font {name!r}; there are {', '.join(NAMES)}")
    from paneldraw.text.builtin.cells import Bold, Cells, Regular

    if name in ("6x8", "8x8"):
        draw = Regular() if name == "6x8" else Bold()
        return Strike(name, 7, 1, Cells(draw), gap=1, cells=True, missing=_MISSING)
    from paneldraw.text.builtin.tall import Plain, Segments

    tall = Plain() if name == "numbers" else Segments()
    return Strike(name, 14, 2, Cells(tall), gap=2, cells=True, missing=_MISSING)
