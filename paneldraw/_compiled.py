"""Which modules Cython compiles, and whether it did."""

from __future__ import annotations

import importlib.machinery
from pathlib import Path

#: In the order in which they can be imported.
MODULES = (
    "paneldraw.raster.surface",
    "paneldraw.raster.paint",
    "paneldraw.raster.cone",
    "paneldraw.raster.coverage",
    "paneldraw.raster.blit",
    "paneldraw.raster.dither",
    "paneldraw.raster.glyphs",
    "paneldraw.raster.line",
    "paneldraw.raster.circle",
    "paneldraw.raster.thick_line",
    "paneldraw.raster.disc",
    "paneldraw.raster.polygon",
    "paneldraw.raster.stroke",
    "paneldraw.raster.bezier",
    "paneldraw.raster.flood",
    "paneldraw.framebuffer.arguments",
    "paneldraw.framebuffer.painter",
    "paneldraw.framebuffer.copying",
    "paneldraw.framebuffer.framebuffer",
    "paneldraw.compat.packed",
    "paneldraw.compat.framebuf",
    "paneldraw.controllers.packing",
    "paneldraw.update.order",
    "paneldraw.update.messages",
    "paneldraw.update.windows",
    "paneldraw.update.planner",
)

#: What Cython's code needs at run time, memoryviews above all: once, beside the modules that use it.
RUNTIME = "paneldraw._runtime"

PACKAGE = Path(__file__).parent


def _has_compiled_form(name: str) -> bool:
    stem = PACKAGE.joinpath(*name.split(".")[1:])
    return any(stem.with_name(stem.name + suffix).exists() for suffix in importlib.machinery.EXTENSION_SUFFIXES)


#: Whether this install runs compiled. One module without a compiled form, and all run as plain Python:
#: a compiled module calls the others in C.
COMPILED = all(map(_has_compiled_form, (RUNTIME, *MODULES)))
