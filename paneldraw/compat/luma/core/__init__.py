"""What luma.core has: serial interfaces, the canvas, virtual devices, sprites, the command line."""

from __future__ import annotations

import importlib.metadata

try:
    __version__ = importlib.metadata.version("paneldraw")
except importlib.metadata.PackageNotFoundError:  # run from a checkout
    __version__ = "0"
