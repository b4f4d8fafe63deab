"""Simulated panels on simulated buses, as URLs or a TOML file name them: what a program finds instead of hardware."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .bus import I2CBus
from .chip import Chip
from .spi import SPIBus

if TYPE_CHECKING:
    from .port import SerialPort
    from .preload import Preload


@dataclass(frozen=True, eq=False)
class RigPanel:
    """One simulated panel of a `Rig`."""

    name: str
    url: str
    chip: Any
    bus: I2CBus | SPIBus
    port: SerialPort | None = None
    look: str | None = None


class Rig:
    """Simulated panels where programs look for real ones; a context manager."""

    def __init__(self, urls: Iterable[str]) -> None:
        self.panels: list[RigPanel] = []
        self.i2c: dict[int, I2CBus] = {}
        self.spi: dict[tuple[int, int], SPIBus] = {}
        self.serial: dict[str, str] = {}

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Rig:
        """Read the panels from a TOML file."""
        raise NotImplementedError

    def preload(self) -> Preload:
        """Return what lets a child process reach the buses."""
        from .preload import Preload

        return Preload(self.i2c, self.spi, self.serial)

    def close(self) -> None:
        """Unplug everything. Closing twice does nothing."""

    def __enter__(self) -> Rig:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()


def simulated_chip(controller: Any, module: Any, **options: Any) -> Chip:
    """Make the simulated chip that a controller record describes, wired as a module is."""
    raise NotImplementedError
