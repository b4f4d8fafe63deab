"""Draw on serial OLED, LCD and LED panels; only what changed travels."""

from __future__ import annotations

from typing import TYPE_CHECKING

from paneldraw import _compiled
from paneldraw._later import importer

if not _compiled.COMPILED:
    from paneldraw import _interpreted

    _interpreted.load_when_needed()

if TYPE_CHECKING:
    from paneldraw.animation import Animation
    from paneldraw.framebuffer import Framebuffer
    from paneldraw.framebuffer.paints import Gradient, Pattern
    from paneldraw.framebuffer.sprites import Sprite
    from paneldraw.panel import Panel, open_panel
    from paneldraw.raster.cone import ConeFilter
    from paneldraw.raster.coverage import Supersample
    from paneldraw.text import Font

__all__ = ["Animation", "ConeFilter", "Font", "Framebuffer", "Gradient", "Panel", "Pattern", "Sprite", "Supersample"]
__all__ += ["open_panel"]

_LATER = {
    "Animation": "animation",
    "ConeFilter": "raster.cone",
    "Font": "text",
    "Framebuffer": "framebuffer",
    "Gradient": "framebuffer.paints",
    "Panel": "panel",
    "Pattern": "framebuffer.paints",
    "Sprite": "framebuffer.sprites",
    "Supersample": "raster.coverage",
    "open_panel": "panel",
}

if not TYPE_CHECKING:
    # With them comes numpy, and every pytest session imports this package.
    __getattr__ = importer(__name__, _LATER)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
