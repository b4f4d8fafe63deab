"""The framebuffer: the pixels and the drawing calls of a script. It checks arguments; `raster` finds pixels."""

from __future__ import annotations

from paneldraw.framebuffer.framebuffer import Framebuffer

__all__ = ["Framebuffer"]
