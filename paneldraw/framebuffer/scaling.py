"""Pictures cropped, scaled as light adds up, and cut to what is seen of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from paneldraw.framebuffer import pictures
from paneldraw.framebuffer.arguments import LARGEST
from paneldraw.framebuffer.arguments import size as whole_number
from paneldraw.framebuffer.pictures import Levels

if TYPE_CHECKING:
    from PIL import Image

Fit = Literal["contain", "cover", "stretch"]
_FITS = ("contain", "cover", "stretch")

# Pixels that a picture may be scaled to; of one that would have more, and more than it had, only what is seen is made.
_MOST = 1 << 22


class Seen(NamedTuple):
    """Part of a picture in its final size."""

    grays: Levels
    alpha: Levels | None
    left: int
    """Where its first pixel lies on the surface, as `top` does."""
    top: int
    first: tuple[int, int]
    """Which pixel of the picture that is."""


class _Plan(NamedTuple):
    """What part of a picture is scaled to which size, and where it lies in the rectangle that was asked for."""

    part: tuple[float, float, float, float]
    width: int
    height: int
    x: int = 0
    y: int = 0


def seen(
    picture: Any,
    place: tuple[int, int],
    window: tuple[int, int, int, int],
    *,
    size: Any = None,
    fit: Any = None,
    crop: Any = None,
    diffused: bool = False,
) -> Seen | None:
    """Return what of a picture is seen in a window, and with it what decides over that; None if nothing is.

    Parameters
    ----------
    picture : see `pictures.to_gray`
    place : tuple of int
        Where on the surface its top-left pixel lies, or that of the rectangle that it is to fit.
    window : tuple of int
        Left, top, right and bottom of what is seen of the surface.
    size : tuple of int, optional
        Width and height that it is to have. Default: its own, or with `fit` those that are given as `size` there.
    fit : {None, "contain", "cover", "stretch"}
    crop : tuple of int, optional
        x, y, width and height of the part to take.
    diffused : bool, default False
        Whether what lies above and at the left decides too, as it does where errors are diffused.
    """
    source = pictures.as_picture(picture)
    if isinstance(source, np.ndarray) and size is None and crop is None and not diffused:
        return _seen_of_array(source, place, window)
    white = None if isinstance(source, np.ndarray) else pictures.white_of(source)
    box = _crop_box(source, crop)
    if box[0] == box[2] or box[1] == box[3]:
        return None
    plan = _plan(box, size, fit)
    x, y = place[0] + plan.x, place[1] + plan.y
    left, top = max(window[0] - x, 0), max(window[1] - y, 0)
    right, bottom = min(window[2] - x, plan.width), min(window[3] - y, plan.height)
    if left >= right or top >= bottom:
        return None
    own_size = (plan.width, plan.height) == (plan.part[2] - plan.part[0], plan.part[3] - plan.part[1])
    many = not own_size and plan.width * plan.height > max(_MOST, (box[2] - box[0]) * (box[3] - box[1]))
    if diffused and not many:
        # An error goes right and down, and at most a pixel to the left for each one down.
        right = min(right + bottom - 1, plan.width)
        left = top = 0
    if own_size:
        taken = _cut(source, int(plan.part[0]) + left, int(plan.part[1]) + top, right - left, bottom - top)
        grays, alpha = pictures.to_gray(taken, white)
    elif many:
        grays, alpha = _scaled(source, _share(plan, left, top, right, bottom), (right - left, bottom - top), white)
    else:
        grays, alpha = _scaled(source, plan.part, (plan.width, plan.height), white)
        grays, alpha = grays[top:bottom, left:right], None if alpha is None else alpha[top:bottom, left:right]
    return Seen(grays, alpha, x + left, y + top, (left, top))


def _seen_of_array(grays: Levels, place: tuple[int, int], window: tuple[int, int, int, int]) -> Seen | None:
    """As `seen`, of grays as they are, which are dithered so often that the time counts."""
    height, width = grays.shape
    x, y = place
    left, top = max(window[0] - x, 0), max(window[1] - y, 0)
    right, bottom = min(window[2] - x, width), min(window[3] - y, height)
    if left >= right or top >= bottom:
        return None
    return Seen(grays[top:bottom, left:right], None, x + left, y + top, (left, top))


def _size_of(source: Levels | Image.Image) -> tuple[int, int]:
    return (source.shape[1], source.shape[0]) if isinstance(source, np.ndarray) else source.size


def _cut(source: Levels | Image.Image, x: int, y: int, width: int, height: int) -> Levels | Image.Image:
    if isinstance(source, np.ndarray):
        return source[y : y + height, x : x + width]
    return source if (x, y, width, height) == (0, 0, *source.size) else source.crop((x, y, x + width, y + height))


def _crop_box(source: Levels | Image.Image, crop: Any) -> tuple[int, int, int, int]:
    """Left, top, right and bottom of the part to take."""
    width, height = _size_of(source)
    if crop is None:
        return 0, 0, width, height
    x, y, w, h = _whole_numbers("crop", crop, "x, y, width and height")
    if w < 1 or h < 1 or x < 0 or y < 0 or x + w > width or y + h > height:
        raise ValueError(f"crop must be a part of the picture's {width} x {height} pixels, not {(x, y, w, h)}")
    return x, y, x + w, y + h


def checked_size(size: Any) -> tuple[int, int]:
    """Return a width and a height, if they are."""
    width, height = _whole_numbers("size", size, "width and height")
    if not (1 <= width <= LARGEST and 1 <= height <= LARGEST):
        raise ValueError(f"size must be 1 to {LARGEST} pixels wide and high, not {width} x {height}")
    return width, height


def _whole_numbers(name: str, numbers: Any, meaning: str) -> tuple[int, ...]:
    try:
        found = tuple(numbers)
    except TypeError:
        raise TypeError(f"{name} must be {meaning}, not {numbers!r}") from None
    if isinstance(numbers, (str, bytes)) or len(found) != len(meaning.replace(" and ", ", ").split(", ")):
        raise ValueError(f"{name} must be {meaning}, not {numbers!r}")
    return tuple(whole_number(name, number) for number in found)


def check_fit(fit: Any) -> None:
    """Refuse what is no way to fit."""
    if fit is not None and not (isinstance(fit, str) and fit in _FITS):
        raise ValueError(f'fit must be None, "contain", "cover" or "stretch", not {fit!r}')


def _plan(box: tuple[int, int, int, int], size: Any, fit: Any) -> _Plan:
    own_width, own_height = box[2] - box[0], box[3] - box[1]
    if size is None:
        return _Plan(box, own_width, own_height)
    width, height = size
    if fit == "contain":
        if own_width * height > own_height * width:
            high = max(1, round(own_height * width / own_width))
            return _Plan(box, width, high, 0, (height - high) // 2)
        wide = max(1, round(own_width * height / own_height))
        return _Plan(box, wide, height, (width - wide) // 2, 0)
    if fit == "cover":
        # The widest or highest part of the rectangle's proportions, from the middle.
        if own_width * height > own_height * width:
            margin = (own_width - own_height * width / height) / 2
            return _Plan((box[0] + margin, box[1], box[2] - margin, box[3]), width, height)
        margin = (own_height - own_width * height / width) / 2
        return _Plan((box[0], box[1] + margin, box[2], box[3] - margin), width, height)
    return _Plan(box, width, height)


def _share(plan: _Plan, left: int, top: int, right: int, bottom: int) -> tuple[float, float, float, float]:
    """What of the source becomes some of the pixels that it is scaled to."""
    x1, y1, x2, y2 = plan.part
    across, down = (x2 - x1) / plan.width, (y2 - y1) / plan.height
    return x1 + left * across, y1 + top * down, min(x1 + right * across, x2), min(y1 + bottom * down, y2)


# -- Scaling

_CODES = np.arange(256) / 255
# https://www.w3.org/TR/css-color-4/#predefined-sRGB: the light of each gray.
_LIGHT = np.where(_CODES <= 0.04045, _CODES / 12.92, ((_CODES + 0.055) / 1.055) ** 2.4).astype(np.float32)
_BORDERS = (_LIGHT[1:] + _LIGHT[:-1]) / 2


def _scaled(
    source: Levels | Image.Image, part: tuple[float, float, float, float], size: tuple[int, int], white: float | None
) -> tuple[Levels, Levels | None]:
    """Scale part of a picture: a pixel becomes as bright as the light of what it covers."""
    from PIL import Image

    planes, alpha = _planes(source, white)
    few = len(planes) == 1 and not (planes[0] - np.uint8(1) < 254).any()  # black and white alone stay so
    share = None if alpha is None else alpha.astype(np.float32) / np.float32(255)
    opacity = None if share is None else _resized(share, part, size, few)
    scaled = []
    for plane in planes:
        light = _LIGHT[plane] if share is None else _LIGHT[plane] * share
        light = _resized(light, part, size, few)
        if opacity is not None:
            light = np.divide(light, opacity, out=np.zeros_like(light), where=opacity > 0)
        scaled.append(np.searchsorted(_BORDERS, light).astype(np.uint8))
    if len(scaled) == 3:
        scaled = [np.asarray(Image.fromarray(np.dstack(scaled)).convert("L"))]
    return scaled[0], None if opacity is None else np.rint(opacity * 255).clip(0, 255).astype(np.uint8)


def _planes(source: Levels | Image.Image, white: float | None) -> tuple[list[Levels], Levels | None]:
    """Grays, or red, green and blue; and the opacity."""
    if isinstance(source, np.ndarray):
        return [source], None
    if source.mode in ("1", "L", "LA", "La", "I", "F") or source.mode.startswith("I;16"):
        grays, alpha = pictures.to_gray(source, white)
        return [grays], alpha
    if pictures.is_transparent(source):
        bands = np.asarray(source.convert("RGBA"))
        opaque = bands[:, :, 3].min() == 255
        return [bands[:, :, k] for k in range(3)], None if opaque else bands[:, :, 3]
    bands = np.asarray((pictures.from_lab(source) if source.mode == "LAB" else source).convert("RGB"))
    return [bands[:, :, k] for k in range(3)], None


def _resized(
    plane: NDArray[Any], part: tuple[float, float, float, float], size: tuple[int, int], few: bool
) -> NDArray[Any]:
    """Scale a plane: the mean of whole pixels where they fit, and for the rest a filter that does not ring."""
    from PIL import Image

    enlarged = size[0] >= part[2] - part[0] and size[1] >= part[3] - part[1]
    way = Image.Resampling.NEAREST if few and enlarged else Image.Resampling.HAMMING
    scaled = Image.fromarray(np.ascontiguousarray(plane)).resize(size, way, part, None if enlarged else 1.0)
    return np.asarray(scaled)
