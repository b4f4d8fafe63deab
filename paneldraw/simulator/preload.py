"""Simulated buses for other programs, which find them where Linux has /dev/i2c-N and /dev/spidevB.D."""

from __future__ import annotations

import subprocess
from collections.abc import Mapping, Sequence
from typing import Any

from .bus import I2CBus
from .spi import SPIBus


class PreloadUnavailableError(OSError):
    """A program cannot be given simulated buses here."""


class Preload:
    """Buses that child processes find as devices; a context manager."""

    def __init__(
        self,
        i2c: Mapping[int, I2CBus] | None = None,
        spi: Mapping[tuple[int, int], SPIBus] | None = None,
        serial: Mapping[str, str] | None = None,
    ) -> None:
        self.i2c, self.spi, self.serial = dict(i2c or {}), dict(spi or {}), dict(serial or {})

    def __enter__(self) -> Preload:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    def environment(self) -> dict[str, str]:
        """Return what a child's environment needs beside ``os.environ``."""
        return {}

    def popen(self, command: Sequence[str], **options: Any) -> subprocess.Popen[Any]:
        """Start a program as ``subprocess.Popen`` does."""
        return subprocess.Popen(command, **options)

    def run(self, command: Sequence[str], **options: Any) -> subprocess.CompletedProcess[Any]:
        """Run a program as ``subprocess.run`` does."""
        return subprocess.run(command, **options)

    def close(self) -> None:
        """End serving."""
