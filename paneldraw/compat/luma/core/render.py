"""A picture to draw on with Pillow."""

from __future__ import annotations

from types import TracebackType

from PIL import Image, ImageDraw

from paneldraw.compat.luma.core.mixin import capabilities

__all__ = ["canvas"]


class canvas:
    """Draw with Pillow's ImageDraw; the picture is displayed on leaving, unless the block raised.

    Parameters
    ----------
    device : device or virtual device
    background : PIL.Image.Image, optional
        What to draw on, of the device's size; it is copied. Default: black.
    dither : bool, optional
        Draw in color and let Floyd and Steinberg's error diffusion make it the device's mode. Default: False.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> device = dummy(mode="1")
    >>> with canvas(device) as draw:
    ...     draw.text((0, 0), "Hello", fill="white")
    """

    def __init__(self, device: capabilities, background: Image.Image | None = None, dither: bool = False) -> None:
        if background is not None and background.size != device.size:
            raise ValueError(f"background must be of the device's size {device.size}, not {background.size}")
        mode = "RGB" if dither else device.mode
        self.image = Image.new(mode, device.size) if background is None else background.copy()
        self.device, self.dither = device, dither

    def __enter__(self) -> ImageDraw.ImageDraw:
        return ImageDraw.Draw(self.image)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if kind is None:
            self.device.display(self.image.convert(self.device.mode) if self.dither else self.image)
