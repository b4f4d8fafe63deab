"""What devices and virtual devices have in common."""

from __future__ import annotations

from typing import Any

from PIL import Image

from paneldraw.compat.luma.core.error import DeviceDisplayModeError

MODES = ("1", "RGB", "RGBA")
_QUARTERS = (None, Image.Transpose.ROTATE_270, Image.Transpose.ROTATE_180, Image.Transpose.ROTATE_90)


class capabilities:
    """Something of a size and a color mode that images can be displayed on.

    Attributes
    ----------
    width, height : int
        Pixels as `rotate` has them; `size` is both.
    bounding_box : tuple of int
        Left, top, right and bottom pixel, all inside.
    rotate : int
        Quarter turns clockwise.
    mode : str
        Pillow's mode of the images: ``"1"``, ``"RGB"`` or ``"RGBA"``.
    persist : bool
        Whether the picture stays when the script ends.
    """

    width: int
    height: int
    size: tuple[int, int]
    bounding_box: tuple[int, int, int, int]
    rotate: int
    mode: str
    persist: bool

    def capabilities(self, width: int, height: int, rotate: int, mode: str = "1") -> None:
        """Set size, rotation and mode; width and height are those of the glass before it is turned."""
        if mode not in MODES:
            raise DeviceDisplayModeError(f"mode must be one of {', '.join(MODES)}, not {mode!r}")
        if rotate not in (0, 1, 2, 3):
            raise DeviceDisplayModeError(f"rotate must be 0, 1, 2 or 3 quarter turns, not {rotate!r}")
        self.width, self.height = (width, height) if rotate % 2 == 0 else (height, width)
        self.size = self.width, self.height
        self.bounding_box = 0, 0, self.width - 1, self.height - 1
        self.rotate, self.mode = rotate, mode
        self.persist = False

    def clear(self) -> None:
        """Display a black picture."""
        self.display(Image.new(self.mode, self.size))

    def preprocess(self, image: Image.Image) -> Image.Image:
        """Turn an image to how the glass has it."""
        turn = _QUARTERS[self.rotate]
        return image if turn is None else image.transpose(turn)

    def display(self, image: Image.Image) -> None:
        """Show an image of this size and mode."""
        raise NotImplementedError("display must be defined by the device")

    def _check(self, image: Any) -> None:
        """Refuse what cannot be displayed here."""
        if getattr(image, "mode", None) != self.mode or image.size != self.size:
            wanted = f"{self.width}x{self.height} of mode {self.mode}"
            given = f"{image.width}x{image.height} of mode {image.mode}" if hasattr(image, "mode") else repr(image)
            advice = f": image.convert({self.mode!r})" if hasattr(image, "mode") and image.size == self.size else ""
            raise ValueError(f"image must be {wanted}, not {given}{advice}")
