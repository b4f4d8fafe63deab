"""Between levels and pictures: Pillow images, gray arrays, files, and text."""

from __future__ import annotations

import functools
import io
import operator
import os
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from paneldraw.framebuffer.arguments import size

if TYPE_CHECKING:
    from PIL import Image

Levels = NDArray[np.uint8]
Dither = Literal["bayer", "floyd-steinberg"]

_DIGITS = {1: ".#", 2: ".123", 4: ".123456789abcdef"}


def to_image(levels: Levels, max_level: int, scale: int = 1) -> Image.Image:
    """Return a Pillow image: mode ``1`` for two levels, ``L`` from black to white for more."""
    from PIL import Image

    if size("scale", scale) < 1:
        raise ValueError(f"scale must be 1 or more pixels a pixel, not {scale}")
    if scale != 1:
        levels = levels.repeat(scale, axis=0).repeat(scale, axis=1)
    gray = np.minimum(levels, max_level).astype(np.uint16) * 255 // max_level
    image = Image.fromarray(gray.astype(np.uint8))
    return image.convert("1", dither=Image.Dither.NONE) if max_level == 1 else image


def opened(path: str | os.PathLike[str]) -> Image.Image:
    """Read a picture's file, upright."""
    from PIL import Image, ImageOps

    with Image.open(path) as file:
        return ImageOps.exif_transpose(file)


def to_png(levels: Levels, max_level: int, scale: int = 1) -> bytes:
    """Return the picture as the bytes of a PNG file."""
    file = io.BytesIO()
    to_image(levels, max_level, scale).save(file, "PNG")
    return file.getvalue()


def to_text(levels: Levels, depth: int) -> str:
    """Return a line of text a row, a character a pixel: ``.`` for level 0, ``#`` for 1, hexadecimal digits for more."""
    if depth == 8:
        # The leading digit of the two; what is not 0 must not look so.
        levels, depth = np.maximum(levels >> 4, levels > 0), 4
    digits = np.frombuffer(_DIGITS[depth].encode(), np.uint8)
    return "\n".join(row.tobytes().decode() for row in digits[np.minimum(levels, len(digits) - 1)])


def arrow(picture: Any) -> tuple[object, int, int, bool] | None:
    """Return the bytes of a Pillow image of grays or truths where they lie, which takes a tenth of copying them out.

    A capsule with the array as Apache Arrow has them, the width, the height, and whether they are truths; None for all
    that is no such image, or does not lie in one piece.
    """
    mode = getattr(picture, "mode", None)
    if (mode != "L" and mode != "1") or not hasattr(picture, "getbands") or not _pillow_lends():
        return None
    picture.load()
    if "transparency" in picture.info:
        return None
    try:
        return (picture.im.__arrow_c_array__(), *picture.size, mode == "1")
    except ValueError:
        return None


@functools.cache
def _pillow_lends() -> bool:
    """Whether Pillow tells apart which images lie in one piece; before 13 it did not."""
    import PIL

    return int(PIL.__version__.partition(".")[0]) >= 13


def to_gray(picture: Any) -> tuple[Levels, Levels | None]:
    """Return a picture's grays and, where it has one, its opacity, both 0 ... 255 and of shape (height, width).

    Parameters
    ----------
    picture : PIL.Image.Image, numpy.ndarray or path
        An array of shape (height, width), bool or uint8 0 ... 255, or (height, width, 3 or 4) of RGB or RGBA. A path is
        that of a file that Pillow reads.

    Raises
    ------
    TypeError
        If it is neither, or the array holds something else.
    ValueError
        If the array has another shape.
    """
    if isinstance(picture, (str, os.PathLike)):
        picture = opened(picture)
    if hasattr(picture, "getbands"):
        return _image_to_gray(picture)
    if not isinstance(picture, np.ndarray):
        raise TypeError(f"picture must be a numpy array, a Pillow image or a path, not {type(picture).__name__}")
    if picture.dtype != bool and picture.dtype != np.uint8:
        raise TypeError(f"picture must hold uint8 grays 0 ... 255 or bool, not {picture.dtype}; convert it first")
    if picture.ndim == 3 and picture.shape[2] in (3, 4) and picture.dtype == np.uint8:
        from PIL import Image

        return _image_to_gray(Image.fromarray(picture))
    if picture.ndim != 2:
        raise ValueError(f"picture must have the shape (height, width) or (height, width, 3 or 4), not {picture.shape}")
    return np.where(picture, 255, 0).astype(np.uint8) if picture.dtype == bool else picture, None


def _image_to_gray(image: Image.Image) -> tuple[Levels, Levels | None]:
    if "A" in image.getbands() or "transparency" in image.info:
        both = np.asarray((image if image.mode == "RGBA" else image.convert("RGBA")).convert("LA"))
        return both[:, :, 0], both[:, :, 1]
    if image.mode.startswith("I;16"):
        # Pillow's conversion would cut off at 255 what is brighter.
        return (np.asarray(image) >> 8).astype(np.uint8), None
    return np.asarray(image if image.mode == "L" else image.convert("L")), None


def quantize(gray: Levels, max_level: int, dither: Dither | None = None) -> Levels:
    """Return levels 0 ... `max_level` for grays 0 ... 255.

    Parameters
    ----------
    gray : ndarray of uint8, shape (height, width)
    max_level : int
    dither : {None, "bayer", "floyd-steinberg"}
        None takes the nearest level; ``"bayer"`` the ordered dither of an 8 x 8 matrix, which keeps still pictures
        still; ``"floyd-steinberg"`` diffuses each pixel's error to its neighbors.

    Raises
    ------
    ValueError
        If `dither` is none of these.

    Notes
    -----
    R. W. Floyd and L. Steinberg, "An adaptive algorithm for spatial greyscale", Proc. SID 17 (1976), 75-77.
    """
    if dither is None:
        return ((gray.astype(np.int32) * (2 * max_level) + 255) // 510).astype(np.uint8)
    if dither == "bayer":
        height, width = gray.shape
        threshold = np.tile(_bayer_matrix(), (height // 8 + 1, width // 8 + 1))[:height, :width]
        # Level k + 1 takes over from k in 64 steps.
        return ((gray.astype(np.int32) * (max_level * 128) + threshold * 510 + 255) // (255 * 128)).astype(np.uint8)
    if dither == "floyd-steinberg":
        return _diffuse(gray, max_level)
    raise ValueError(f'dither must be None, "bayer" or "floyd-steinberg", not {dither!r}')


def palette_table(palette: Any, max_level: int) -> bytes:
    """Return the levels that a palette holds, a framebuffer or a sequence of whole numbers, a byte each.

    Raises
    ------
    ValueError
        If there are none, or one is not from 0 to `max_level`.
    """
    levels = getattr(palette, "pixels", palette)
    try:
        entries = levels.ravel().tolist() if isinstance(levels, np.ndarray) else levels
        table = bytes([operator.index(level) for level in entries])
    except (TypeError, ValueError):
        table = b""
    if not table or max(table) > max_level:
        raise ValueError(f"palette must hold levels from 0 to {max_level}")
    return table


def _bayer_matrix() -> NDArray[np.int32]:
    matrix = np.zeros((1, 1), np.int32)
    for _ in range(3):
        matrix = np.block([[4 * matrix, 4 * matrix + 2], [4 * matrix + 3, 4 * matrix + 1]])
    return matrix


def _diffuse(gray: Levels, max_level: int) -> Levels:
    """Floyd and Steinberg's error diffusion: 7/16 right, 3/16, 5/16 and 1/16 below."""
    height, width = gray.shape
    levels = np.empty((height, width), np.uint8)
    below = [0.0] * (width + 2)
    for y in range(height):
        wanted, below = below, [0.0] * (width + 2)
        right = 0.0
        for x, value in enumerate(gray[y].tolist(), 1):
            value = value * max_level / 255 + wanted[x] + right
            level = min(max(int(value + 0.5), 0), max_level)
            error = (value - level) / 16
            levels[y, x - 1] = level
            right = error * 7
            below[x - 1] += error * 3
            below[x] += error * 5
            below[x + 1] += error
    return levels
