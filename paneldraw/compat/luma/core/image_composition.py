"""Pictures made of pictures that move."""

from __future__ import annotations

from PIL import Image

from paneldraw.compat.luma.core.mixin import capabilities

__all__ = ["ComposableImage", "ImageComposition"]

Point = tuple[int, int]


class ComposableImage:
    """An image, the place in a composition where it stands, and from where on it is seen.

    Parameters
    ----------
    image : PIL.Image.Image
    position : (int, int), optional
        Where it stands. Default: (0, 0).
    offset : (int, int), optional
        The pixel of the image that is there. Default: (0, 0).

    Examples
    --------
    >>> from PIL import Image
    >>> image = ComposableImage(Image.new("1", (40, 10)), position=(0, 20))
    >>> image.offset = (8, 0)
    >>> image.width
    40
    """

    def __init__(self, image: Image.Image, position: Point = (0, 0), offset: Point = (0, 0)) -> None:
        self._image = image
        self.position, self.offset = position, offset

    @property
    def width(self) -> int:
        """Width of the whole image."""
        return self._image.width

    @property
    def height(self) -> int:
        """Height of the whole image."""
        return self._image.height

    def image(self, size: Point) -> Image.Image:
        """Return what is seen of it in a composition of a size."""
        left, top = self.offset
        return self._image.crop((left, top, left + min(size[0], self.width), top + min(size[1], self.height)))


class ImageComposition:
    """Images on a black picture of a device's size and mode.

    Examples
    --------
    >>> from paneldraw.compat.luma.core.device import dummy
    >>> from PIL import Image
    >>> device = dummy(mode="1")
    >>> composition = ImageComposition(device)
    >>> composition.add_image(ComposableImage(Image.new("1", (40, 10), 1), position=(0, 20)))
    >>> composition.refresh()
    >>> device.display(composition())
    >>> device.image.getbbox()
    (0, 20, 40, 30)
    """

    def __init__(self, device: capabilities) -> None:
        self._device = device
        self._picture = Image.new(device.mode, device.size)
        self.composed_images: list[ComposableImage] = []

    def add_image(self, image: ComposableImage) -> None:
        """Put an image on top."""
        self.composed_images.append(image)

    def remove_image(self, image: ComposableImage) -> None:
        """Take an image away."""
        self.composed_images.remove(image)

    def __call__(self) -> Image.Image:
        """Return the picture as it was at the last `refresh`."""
        return self._picture

    def refresh(self) -> None:
        """Make the picture anew."""
        self._picture.paste("black", (0, 0, *self._picture.size))
        for each in self.composed_images:
            self._picture.paste(each.image(self._device.size), each.position)
