"""A panel's frames as files: PNG, animated GIF, contact sheet."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Protocol, runtime_checkable

from .frames import Frame, Picture
from .looks import Look, image

if TYPE_CHECKING:
    from PIL.Image import Image

Progress = Callable[[int, int], object]

_SHEET_FRAMES = 48
_HOLD = 100
_SHORTEST = 2


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

    ``.gif`` is an animation of all frames, with the time that each was seen; the last stays for a second. Frames that
    were seen for less than 20 ms, which no viewer shows, give way to the next. ``.png`` is one picture: for a chip what
    it shows now, for frames a contact sheet (for a single frame, that frame).

    Parameters
    ----------
    source : chip or iterable of Frame
        A simulated chip, or frames out of its ``frames``.
    path : str or path-like
        The file, ending in ``.gif`` or ``.png``; it is overwritten.
    scale : int
        Image pixels a panel pixel. Default: 4.
    look : Look, optional
        Colors and gap.
    progress : callable, optional
        Called with (frames done, frames in all) as work goes on.

    Raises
    ------
    ValueError
        For another extension, or where there is nothing to save.
    OSError
        Where the file cannot be written.
    """
    kind = os.path.splitext(os.fspath(path))[1].lower()
    if kind == ".gif":
        frames = _not_empty(source.frames if isinstance(source, Showing) else source)
        _save_gif(frames, path, scale, look, progress)
    elif kind == ".png":
        _still(source, scale, look, progress).save(path, optimize=True)
    else:
        raise ValueError(f"path: {os.fspath(path)!r} ends neither in .gif nor in .png")


def _still(source: Showing | Iterable[Frame], scale: int, look: str | Look | None, progress: Progress | None) -> Image:
    if isinstance(source, Showing):
        return image(source.pixels, scale=scale, max_level=source.max_level, look=look)
    frames = _not_empty(source)
    if len(frames) == 1:
        return image(frames[0].pixels, scale=scale, max_level=frames[0].max_level, look=look)
    return contact_sheet(frames, scale=scale, look=look, progress=progress)


def _save_gif(
    frames: list[Frame], path: str | os.PathLike[str], scale: int, look: str | Look | None, progress: Progress | None
) -> None:
    shown = list(_visible(frames))
    durations = [10 * (later - start) for (start, _), (later, _) in pairwise(shown)] + [10 * _HOLD]

    def pictures() -> Iterator[Image]:
        for done, (_, frame) in enumerate(shown, 1):
            yield image(frame.pixels, scale=scale, max_level=frame.max_level, look=look)
            if progress:
                progress(done, len(shown))

    rest = pictures()
    next(rest).save(path, save_all=True, append_images=rest, duration=durations, loop=0, disposal=1, optimize=False)


def _visible(frames: list[Frame]) -> Iterator[tuple[int, Frame]]:
    """The frames that stay long enough to be seen, each with its start in hundredths of a second."""
    start, current = round(100 * frames[0].seconds), frames[0]
    for frame in frames[1:]:
        moment = round(100 * frame.seconds)
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
