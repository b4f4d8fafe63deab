"""For tests of panel scripts: what a panel showed, compared with pictures; the plugin that pytest finds by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING

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

    def __getattr__(name: str) -> object:
        """Import a part where somebody asks for it: every pytest session imports this package."""
        if name not in _LATER:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        import importlib

        return getattr(importlib.import_module(f"{__name__}.{_LATER[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
