"""A panel's frames as files: PNG, animated GIF and APNG, contact sheet."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Final, Protocol, runtime_checkable

import numpy as np

from .animation import FORMS, Animation
from .frames import Frame, History, Picture
from .looks import Look, drawing, find_look, image

if TYPE_CHECKING:
    from PIL.Image import Image

Progress = Callable[[int, int], object]

_SHEET_FRAMES: Final = 48
_HOLD: Final = 1000
"""Milliseconds that the last frame stays."""
_SHORTEST: Final = 20
"""Milliseconds below which viewers do not keep to the time."""
EXTENSIONS: Final = (*FORMS, ".png")
"""What `save` can write."""


@runtime_checkable
class Showing(Protocol):
    """A chip as the recorder sees it."""

    @property
    def pixels(self) -> Picture: ...

    @property
    def frames(self) -> Sequence[Frame]: ...

    @property
    def max_level(self) -> int: ...


def contact_sheet(
    frames: Iterable[Frame],
    *,
    columns: int | None = None,
    scale: int = 2,
    look: str | Look | None = None,
    progress: Progress | None = None,
) -> Image:
    """Lay frames out in rows on one picture, each with its time below.

    Parameters
    ----------
    frames : iterable of Frame
        Out of more than 48, 48 are taken at equal distances, the first and the last among them.
    columns : int, optional
        Frames a row. Default: what makes the sheet about as high as wide.
    scale, look
        As in `image`. Default scale: 2.
    progress : callable, optional
        Called with (frames done, frames in all).

    Returns
    -------
    PIL.Image.Image
        Mode RGB.

    Raises
    ------
    ValueError
        Without frames, or for `columns` below 1.
    """
    from PIL import Image, ImageDraw

    chosen = _some(_not_empty(frames), _SHEET_FRAMES)
    tiles = [image(chosen[0].pixels, scale=scale, max_level=chosen[0].max_level, look=look)]
    width, height = tiles[0].width + 8, tiles[0].height + 20
    if columns is None:
        columns = max(1, round((len(chosen) * height / width) ** 0.5))
    if columns < 1:
        raise ValueError(f"columns: {columns} is not at least 1")
    columns = min(columns, len(chosen))
    sheet = Image.new("RGB", (columns * width + 8, -(-len(chosen) // columns) * height + 8), "#30343a")
    draw = ImageDraw.Draw(sheet)
    for index, frame in enumerate(chosen):
        x, y = 8 + index % columns * width, 8 + index // columns * height
        sheet.paste(image(frame.pixels, scale=scale, max_level=frame.max_level, look=look), (x, y))
        draw.text((x, y + height - 19), f"{frame.seconds:.3f} s   {frame.wire_bytes} bytes", fill="#c8ccd0")
        if progress:
            progress(index + 1, len(chosen))
    return sheet


def save(
    source: Showing | Iterable[Frame],
    path: str | os.PathLike[str],
    *,
    scale: int = 4,
    look: str | Look | None = None,
    progress: Progress | None = None,
) -> None:
    """Write what a panel showed to a file, as the extension says.

    ``.gif`` and ``.apng`` are animations of all frames, with the time that each was seen; the last stays for a second.
    Frames that were seen for less than 20 ms, which no viewer shows, give way to the next. ``.png`` is one picture: for
    a chip what it shows now, for frames a contact sheet (for a single frame, that frame).

    Parameters
    ----------
    source : chip or iterable of Frame
        A simulated chip, or frames out of its ``frames``.
    path : str or path-like
        The file, ending in ``.gif``, ``.apng`` or ``.png``; it is overwritten.
    scale : int
        Image pixels a panel pixel. Default: 4.
    look : str or Look, optional
        A name of `LOOKS` or a look of your own. Default: that of the chip's panels; of frames, white.
    progress : callable, optional
        Called with (frames done, frames in all) as work goes on.

    Raises
    ------
    ValueError
        For another extension or an unknown look, or where there is nothing to save.
    OSError
        Where the file cannot be written.

    Warns
    -----
    UserWarning
        Where a chip showed more than its history keeps: the animation begins later than the panel did.
    """
    kind = os.path.splitext(os.fspath(path))[1].lower()
    if look is None:
        look = getattr(source, "look", None)
    if kind in FORMS:
        shown = source.frames if isinstance(source, Showing) else source
        frames = _not_empty(shown)
        if isinstance(shown, History) and shown.dropped:
            warnings.warn(_missing(shown, path), stacklevel=2)
        _animate(frames, path, kind, scale, look, progress)
    elif kind == ".png":
        _still(source, scale, look, progress).save(path, optimize=True)
    else:
        raise ValueError(f"path: {os.fspath(path)!r} ends in none of {', '.join(EXTENSIONS)}")


def _missing(frames: History, path: str | os.PathLike[str]) -> str:
    """What a history lacks, in words."""
    seconds = frames[0].seconds - (frames.began or 0.0)
    return (
        f"{os.fspath(path)} lacks the first {frames.dropped} frames, {seconds:.1f} seconds: the chip keeps the last "
        f"{frames.maxlen}; make it with history=None, or with a larger one, to keep more"
    )


def _still(source: Showing | Iterable[Frame], scale: int, look: str | Look | None, progress: Progress | None) -> Image:
    if isinstance(source, Showing):
        return image(source.pixels, scale=scale, max_level=source.max_level, look=look)
    frames = _not_empty(source)
    if len(frames) == 1:
        return image(frames[0].pixels, scale=scale, max_level=frames[0].max_level, look=look)
    return contact_sheet(frames, scale=scale, look=look, progress=progress)


def _animate(
    frames: list[Frame],
    path: str | os.PathLike[str],
    kind: str,
    scale: int,
    look: str | Look | None,
    progress: Progress | None,
) -> None:
    if len({(frame.pixels.shape, frame.max_level) for frame in frames}) > 1:
        raise ValueError("frames: they are of several panels; save each panel's by themselves")
    drawn = drawing(scale, frames[0].max_level, find_look(look))
    parts = list(_timed(frames, FORMS[kind].unit))
    height, width = drawn.colors(frames[0].pixels).shape
    with open(path, "wb") as file:
        animation: Animation = FORMS[kind](file, width, height, drawn.palette, len(parts))
        for done, (frame, (left, top, right, bottom), milliseconds) in enumerate(parts, 1):
            colors = drawn.colors(frame.pixels)[top * scale : bottom * scale, left * scale : right * scale]
            animation.add(colors, left * scale, top * scale, milliseconds)
            if progress:
                progress(done, len(parts))
        animation.close()


def _timed(frames: list[Frame], unit: int) -> Iterator[tuple[Frame, tuple[int, int, int, int], int]]:
    """The frames that are seen, what changes in each (left, top, right, bottom, with a margin of one) and its time."""
    seen = list(_visible(frames, unit))
    height, width = frames[0].pixels.shape
    begin, frame, box = seen[0][0], seen[0][1], (0, 0, width + 2, height + 2)
    for start, later in seen[1:]:
        changed = later.pixels != frame.pixels
        rows, columns = np.flatnonzero(changed.any(axis=1)), np.flatnonzero(changed.any(axis=0))
        if rows.size:
            yield frame, box, start - begin
            begin, frame = start, later
            box = int(columns[0]) + 1, int(rows[0]) + 1, int(columns[-1]) + 2, int(rows[-1]) + 2
    yield frame, box, seen[-1][0] - begin + _HOLD


def _visible(frames: list[Frame], unit: int) -> Iterator[tuple[int, Frame]]:
    """The frames that stay long enough to be seen, each with its start in milliseconds, whole units of time."""
    start, current = unit * round(1000 * frames[0].seconds / unit), frames[0]
    for frame in frames[1:]:
        moment = unit * round(1000 * frame.seconds / unit)
        if moment - start >= _SHORTEST:
            yield start, current
            start = moment
        current = frame
    yield start, current


def _not_empty(frames: Iterable[Frame]) -> list[Frame]:
    taken = list(frames)
    if not taken:
        raise ValueError("frames: nothing was shown yet, so there is nothing to save")
    return taken


def _some(frames: list[Frame], most: int) -> list[Frame]:
    if len(frames) <= most:
        return frames
    return [frames[round(index * (len(frames) - 1) / (most - 1))] for index in range(most)]
