"""Between levels and pictures: Pillow images, gray arrays, files, and text."""

from __future__ import annotations

import contextlib
import functools
import io
import operator
import os
import struct
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from paneldraw.framebuffer.arguments import real, size
from paneldraw.raster.blue_noise import thresholds as blue_noise
from paneldraw.raster.dither import ONE, diffuse, ordered

if TYPE_CHECKING:
    from PIL import Image

Levels = NDArray[np.uint8]
Dither = Literal["bayer", "floyd-steinberg", "blue-noise", "stable"]
DITHERS: tuple[str, ...] = get_args(Dither)

#: Where Pillow keeps what a camera wrote.
_EXIF = {"exif", "xmp", "XML:com.adobe.xmp", "Raw profile type exif"}

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


@contextlib.contextmanager
def readable(what: str) -> Iterator[None]:
    """Say in one way what is wrong with a file: Pillow raises what its readers stumble over."""
    try:
        yield
    except (SyntaxError, ValueError, LookupError, EOFError, TypeError, struct.error) as error:
        raise OSError(f"{what} cannot be read: {error}") from error


def opened(path: str | os.PathLike[str]) -> Image.Image:
    """Read a picture's file, upright. An X bitmap may be one that only C compilers read."""
    from PIL import Image, UnidentifiedImageError

    try:
        with readable(f"picture {os.fspath(path)!r}"), Image.open(path) as file:
            file.load()
            return upright(file)
    except UnidentifiedImageError:
        if os.fspath(path).lower().endswith(".xbm"):
            from paneldraw.framebuffer.sprites import Sprite

            with open(path, encoding="latin-1") as text:
                return Image.fromarray(Sprite.xbm(text.read()).as_image())
        raise


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
    if picture.info and ("transparency" in picture.info or not is_upright(picture)):
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


def is_upright(image: Image.Image) -> bool:
    """Whether a Pillow image has no word from its camera that it is to be turned."""
    if not image.info.keys() & _EXIF and not hasattr(image, "tag_v2"):
        return True
    return image.getexif().get(0x0112, 1) == 1


def upright(image: Image.Image) -> Image.Image:
    """Turn a Pillow image as its camera says that it is to be seen."""
    if is_upright(image):
        return image
    from PIL import ImageOps

    return ImageOps.exif_transpose(image)


def to_gray(picture: Any, white: float | None = None) -> tuple[Levels, Levels | None]:
    """Return a picture's grays and, where it has one, its opacity, both 0 ... 255 and of shape (height, width).

    Parameters
    ----------
    picture : PIL.Image.Image, numpy.ndarray, Sprite, matplotlib figure or path
        An array of shape (height, width), bool or uint8 0 ... 255, or (height, width, 3 or 4) of RGB or RGBA. A path is
        that of a file that Pillow reads. An image is turned upright.
    white : float, optional
        What is white in an image of mode ``I`` or ``F``; see `white_of`. Default: found.

    Raises
    ------
    TypeError
        If it is neither, or the array holds something else.
    ValueError
        If the array has another shape.
    """
    picture = as_picture(picture)
    if isinstance(picture, np.ndarray):
        return picture, None
    return _image_to_gray(picture, white)


def as_picture(picture: Any) -> Levels | Image.Image:
    """Return any picture as an array of grays or as a Pillow image that stands upright."""
    if hasattr(picture, "getbands"):
        return upright(picture)
    if isinstance(picture, (str, os.PathLike)):
        return opened(picture)
    if hasattr(picture, "as_image"):
        return picture.as_image()
    if hasattr(picture, "canvas") and hasattr(picture, "savefig"):
        picture = _plotted(picture)
    if not isinstance(picture, np.ndarray):
        raise TypeError(f"picture must be a numpy array, a Pillow image or a path, not {type(picture).__name__}")
    if picture.dtype != bool and picture.dtype != np.uint8:
        raise TypeError(f"picture must hold uint8 grays 0 ... 255 or bool, not {picture.dtype}; convert it first")
    if picture.ndim == 3 and picture.shape[2] in (3, 4) and picture.dtype == np.uint8:
        from PIL import Image

        return Image.fromarray(picture)
    if picture.ndim != 2:
        raise ValueError(f"picture must have the shape (height, width) or (height, width, 3 or 4), not {picture.shape}")
    return np.where(picture, 255, 0).astype(np.uint8) if picture.dtype == bool else picture


def _plotted(figure: Any) -> NDArray[np.uint8]:
    """Draw a matplotlib figure, with the canvas of its own if that draws into memory."""
    own = figure.canvas
    try:
        if not hasattr(own, "buffer_rgba"):
            from matplotlib.backends.backend_agg import FigureCanvasAgg  # type: ignore[import-not-found,unused-ignore]

            FigureCanvasAgg(figure)
        figure.canvas.draw()
        return np.array(figure.canvas.buffer_rgba())
    finally:
        if figure.canvas is not own:
            figure.set_canvas(own)


def is_transparent(image: Image.Image) -> bool:
    """Whether a Pillow image may let shine through what is there."""
    if image.mode in ("LA", "La", "PA", "RGBA", "RGBa") or "transparency" in image.info:
        return True
    return image.mode == "P" and image.palette is not None and image.palette.mode.endswith("A")


def white_of(image: Image.Image) -> float | None:
    """Return what white is in an image of mode ``I`` or ``F``, which does not say; None for other modes.

    65535 in a PNG or PGM file of 16 bits; else the first that no pixel is above of 1 (only ``F``), 255, 65535, and the
    highest number of 32 bits.
    """
    if image.mode not in ("I", "F"):
        return None
    if image.mode == "I" and image.format in ("PNG", "PPM"):
        return 65535
    values = np.asarray(image)
    values = values[np.isfinite(values)]
    highest = values.max() if values.size else 0
    known = (255, 65535, 2**31 - 1) if image.mode == "I" else (1, 255, 65535)
    return next((white for white in known if highest <= white), float(highest))


def _image_to_gray(image: Image.Image, white: float | None = None) -> tuple[Levels, Levels | None]:
    mode, clear = image.mode, image.info.get("transparency")
    if mode.startswith("I") or mode in ("F", "L", "1"):
        values = np.asarray(image)
        alpha = None
        if isinstance(clear, int):
            alpha = np.where(values == (bool(clear) if mode == "1" else clear), 0, 255).astype(np.uint8)
        return _shades(image, values, white), alpha
    if mode == "La" or mode == "LA":
        both = np.asarray(image.convert("LA"))
        return both[:, :, 0], both[:, :, 1]
    if is_transparent(image):
        both = np.asarray((image if mode == "RGBA" else image.convert("RGBA")).convert("LA"))
        return both[:, :, 0], both[:, :, 1]
    return np.asarray((from_lab(image) if mode == "LAB" else image).convert("L")), None


def _shades(image: Image.Image, values: NDArray[Any], white: float | None) -> Levels:
    """The grays 0 ... 255 of an image of one band."""
    if image.mode == "1":
        return values * np.uint8(255)
    if image.mode.startswith("I;16"):
        # Pillow's conversion would cut off at 255 what is brighter.
        return (values >> 8).astype(np.uint8)
    if image.mode == "L":
        return values
    share = np.nan_to_num(values.astype(float) / (white or white_of(image) or 1), nan=0.0)
    return np.rint(255 * np.clip(share, 0, 1)).astype(np.uint8)


def from_lab(image: Image.Image) -> Image.Image:
    """Return an image of mode ``LAB``, with the white of ICC profiles, in RGB."""
    from PIL import ImageCms

    lab, rgb = ImageCms.createProfile("LAB"), ImageCms.createProfile("sRGB")
    return ImageCms.profileToProfile(image, lab, rgb, outputMode="RGB")  # type: ignore[return-value]


def quantize(
    gray: Levels,
    max_level: int,
    dither: Dither | None = None,
    *,
    gamma: float = 1.0,
    invert: bool = False,
    place: tuple[int, int] = (0, 0),
    before: Levels | None = None,
) -> Levels:
    """Return levels 0 ... `max_level` for grays 0 ... 255.

    Parameters
    ----------
    gray : ndarray of uint8, shape (height, width)
    max_level : int
    dither : {None, "bayer", "floyd-steinberg", "blue-noise", "stable"}
        None takes the nearest level; ``"bayer"`` the ordered dither of an 8 x 8 matrix, which keeps still pictures
        still; ``"blue-noise"`` an ordered dither of a 64 x 64 matrix without a visible pattern; ``"floyd-steinberg"``
        diffuses each pixel's error to its neighbors. ``"stable"`` is ``"blue-noise"`` in which a pixel keeps the level
        that it has `before` unless that is more than 1/50 of a level off, or less near a level itself: noise does
        not make it flicker, and white is white.
    gamma : float, default 1.0
        A gray g of 255 becomes the share (g / 255) ** gamma of the highest level: 2.2 where levels are shares of light.
    invert : bool, default False
        Whether black and white change places, before `gamma`.
    place : tuple of int, default (0, 0)
        Which pixel of the whole picture the first one is, for the matrix.
    before : ndarray of uint8, shape (height, width), optional
        The levels that are there. Default: none.

    Raises
    ------
    TypeError, ValueError
        If `dither` is none of these, or `gamma` no positive number.

    Notes
    -----
    R. W. Floyd and L. Steinberg, "An adaptive algorithm for spatial greyscale", Proc. SID 17 (1976), 75-77.
    R. Ulichney, "The void-and-cluster method for dither array generation", Proc. SPIE 1913 (1993), 332-343.
    """
    check_dither(dither)
    exact, parts = _values(max_level, check_gamma(gamma), bool(invert))
    if dither is None:
        return ((parts + ONE // 2) // ONE).astype(np.uint8)[gray]
    levels = np.empty(gray.shape, np.uint8)
    if dither == "floyd-steinberg":
        diffuse(gray, levels, exact, max_level)
        return levels
    hold = 0
    if dither == "stable" and before is not None:
        np.minimum(before, max_level, out=levels)
        hold = ONE // 50
    ordered(gray, levels, parts, _thresholds("bayer" if dither == "bayer" else "blue-noise"), place, hold)
    return levels


def check_dither(dither: Any) -> None:
    """Refuse what is no dither."""
    if dither is not None and not (isinstance(dither, str) and dither in DITHERS):
        raise ValueError(f'dither must be None, "bayer", "floyd-steinberg", "blue-noise" or "stable", not {dither!r}')


def check_gamma(gamma: Any) -> float:
    """Return an exponent, if it is one."""
    if not 0 < real("gamma", gamma) <= 100:
        raise ValueError(f"gamma must be above 0 and at most 100, not {gamma}")
    return float(gamma)


@functools.lru_cache(16)
def _values(max_level: int, gamma: float, invert: bool) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
    """What each gray is in levels; and in whole parts of a level, of which each has `ONE`."""
    grays = [255 - gray if invert else gray for gray in range(256)]
    exact = np.array([g * max_level / 255 if gamma == 1 else (g / 255) ** gamma * max_level for g in grays])
    return exact, np.rint(exact * ONE).astype(np.int32)


@functools.cache
def _thresholds(kind: str) -> NDArray[np.int32]:
    """A matrix of thresholds, each in the middle of its share of a level."""
    # As large as the other one: rows that start over every 8 pixels take half as long again.
    ranks = np.tile(_bayer_matrix(), (8, 8)) if kind == "bayer" else blue_noise().astype(np.int32)
    return (2 * ranks + 1) * np.int32(ONE // (2 * int(ranks.max() + 1)))


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
