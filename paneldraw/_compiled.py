"""Which modules Cython compiles, and whether it did."""

from __future__ import annotations

import importlib.machinery
from pathlib import Path

#: In the order in which they can be imported.
MODULES = (
    "paneldraw.raster.surface",
    "paneldraw.raster.supersample",
    "paneldraw.raster.lines",
    "paneldraw.raster.thick",
    "paneldraw.raster.cone",
    "paneldraw.raster.boundaries",
    "paneldraw.raster.filtered",
    "paneldraw.raster.polygons",
    "paneldraw.raster.strokes",
    "paneldraw.raster.outlines",
    "paneldraw.raster.curves",
    "paneldraw.raster.chords",
    "paneldraw.raster.cuts",
    "paneldraw.raster.rounds",
    "paneldraw.raster.round_contours",
    "paneldraw.raster.masks",
    "paneldraw.framebuffer.arguments",
    "paneldraw.framebuffer.paths",
    "paneldraw.framebuffer.lines",
    "paneldraw.framebuffer.polygons",
    "paneldraw.framebuffer.rounds",
    "paneldraw.framebuffer.shapes",
    "paneldraw.framebuffer.framebuffer",
    "paneldraw.controllers.packing",
    "paneldraw.update.order",
    "paneldraw.update.messages",
    "paneldraw.update.windows",
    "paneldraw.update.planner",
)

PACKAGE = Path(__file__).parent


def _has_compiled_form(name: str) -> bool:
    stem = PACKAGE.joinpath(*name.split(".")[1:])
    return any(stem.with_name(stem.name + suffix).exists() for suffix in importlib.machinery.EXTENSION_SUFFIXES)


#: Whether this install runs compiled. One module without a compiled form, and all run as plain Python:
#: a compiled module calls the others in C.
COMPILED = all(map(_has_compiled_form, MODULES))
