"""For tests of panel scripts: what a panel showed, compared with pictures; the plugin that pytest finds by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

from paneldraw._later import importer

if TYPE_CHECKING:
    from paneldraw.testing.golden import assert_frame
    from paneldraw.testing.panels import SerialPanel, SimPanel
    from paneldraw.testing.programs import Program, SimRun
    from paneldraw.testing.seeing import assert_bytes, assert_pattern, chip_of, frames_of

__all__ = [
    "Program",
    "SerialPanel",
    "SimPanel",
    "SimRun",
    "assert_bytes",
    "assert_frame",
    "assert_pattern",
    "chip_of",
    "frames_of",
]

_LATER = {
    "Program": "programs",
    "SerialPanel": "panels",
    "SimPanel": "panels",
    "SimRun": "programs",
    "assert_bytes": "seeing",
    "assert_frame": "golden",
    "assert_pattern": "seeing",
    "chip_of": "seeing",
    "frames_of": "seeing",
}

if not TYPE_CHECKING:
    # Every pytest session imports this package.
    __getattr__ = importer(__name__, _LATER)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
