"""Draw on serial OLED, LCD and LED panels; only what changed travels."""

from __future__ import annotations

from paneldraw import _compiled

if not _compiled.COMPILED:
    from paneldraw import _interpreted

    _interpreted.load_sources()

from paneldraw.framebuffer import Framebuffer
from paneldraw.raster.supersample import Supersample

__all__ = ["Framebuffer", "Supersample"]
