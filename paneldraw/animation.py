"""Pictures that move: GIF, APNG and WebP files, each frame at its own pace."""

from __future__ import annotations

import bisect
import itertools
import os
import time
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from paneldraw.framebuffer.pictures import readable

if TYPE_CHECKING:
    from PIL import Image

    from paneldraw.panel import Panel

#: Seconds that a frame lasts which does not say how long, as in browsers.
DEFAULT_SECONDS = 0.1

#: Frames that are left out in a row at most, so that something is seen where reading them alone takes too long.
MOST_SKIPPED = 20


class Animation:
    """The frames of an animated picture, composed as Pillow does, and how long each is to be seen.

    Iterating yields pairs of an image of mode ``RGBA`` and the seconds that it lasts, once through.

    Parameters
    ----------
    source : path, binary file or PIL.Image.Image
        A GIF, PNG, WebP or other file that Pillow reads; one that does not move is one frame.

    Attributes
    ----------
    loops : int
        How often it is to be played; 0 for ever. A GIF that says n is played once and then n times more, as in
        browsers.
    size : tuple of int
        Width and height of a frame.

    Raises
    ------
    TypeError
        If `source` is none of these.
    OSError
        If the file, or later a frame of it, cannot be read. ``PIL.Image.DecompressionBombError`` if it is too large.

    Notes
    -----
    A frame is read when it is asked for and not kept, as a film of full size would not fit into a small Pi.

    Examples
    --------
    >>> from io import BytesIO
    >>> from PIL import Image
    >>> from paneldraw import Animation
    >>> frames = [Image.new("L", (8, 8), gray) for gray in (0, 90, 255)]
    >>> file = BytesIO()
    >>> frames[0].save(file, "GIF", save_all=True, append_images=frames[1:], duration=[40, 200, 60], loop=0)
    >>> animation = Animation(file)
    >>> len(animation), animation.loops, [round(seconds, 2) for _, seconds in animation]
    (3, 0, [0.04, 0.2, 0.06])
    >>> animation.at(0.1).getpixel((0, 0))
    (90, 90, 90, 255)
    """

    def __init__(self, source: Any) -> None:
        from PIL import Image

        if (
            not isinstance(source, (str, os.PathLike))
            and not hasattr(source, "getbands")
            and not hasattr(source, "read")
        ):
            raise TypeError(f"source must be a path, a file or a Pillow image, not {type(source).__name__}")
        self._file: Image.Image = source if hasattr(source, "getbands") else Image.open(source)
        self.size = self._file.size
        told = self._file.info.get("loop")
        self.loops = 1 if told is None else told + (told > 0 and self._file.format == "GIF")
        self._ends: list[float] = []

    def __len__(self) -> int:
        with readable("the number of frames of the picture"):
            return int(getattr(self._file, "n_frames", 1))

    def frame(self, number: int) -> tuple[Image.Image, float]:
        """Return a frame, the first one being 0, and the seconds that it lasts.

        Raises
        ------
        IndexError
            If there is none of this number.
        """
        if not 0 <= number < len(self):
            raise IndexError(f"the picture has no frame {number}")
        with readable(f"frame {number} of the picture"):
            if len(self) > 1:
                self._file.seek(number)
            self._file.load()
            seconds = float(self._file.info.get("duration", 0)) / 1000
            return self._file.convert("RGBA"), seconds if seconds > 0 else DEFAULT_SECONDS

    def __iter__(self) -> Iterator[tuple[Image.Image, float]]:
        for number in range(len(self)):
            yield self.frame(number)

    @property
    def seconds(self) -> float:
        """How long all frames last together."""
        return self._known_ends()[-1] / 1000

    def at(self, seconds: float) -> Image.Image:
        """Return the frame that is seen some seconds after the start, over and over, however often it is to be played.

        Parameters
        ----------
        seconds : float
        """
        ends = self._known_ends()
        number = bisect.bisect_right(ends, round(1000 * seconds, 6) % ends[-1])
        return self.frame(min(number, len(ends) - 1))[0]

    def _known_ends(self) -> list[float]:
        if not self._ends:
            self._ends = list(itertools.accumulate(_milliseconds(seconds) for _, seconds in self))
        return self._ends


def _milliseconds(seconds: float) -> float:
    """What files count in, without the errors of adding up tenths."""
    return round(1000 * seconds, 6)


def play(
    panel: Panel,
    source: Any,
    loops: int | None,
    options: dict[str, Any],
    shown: Callable[[Any], object] = lambda report: None,
    *,
    clock: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], object] = time.sleep,
) -> int:
    """Show frame after frame, each as long as it says; return how many. See `Panel.play`.

    `shown` is called with the report of each. A frame whose time is over before it can be shown is left out.
    """
    animation = source if isinstance(source, Animation) else Animation(source)
    times = animation.loops if loops is None else loops
    fb = panel.framebuffer()
    start = clock()
    due, count = 0.0, 0
    frames, skipped = len(animation), 0
    for turn in range(1, times + 1) if times else itertools.repeat(0):
        for number, (image, seconds) in enumerate(animation, 1):
            begin, due = due, due + _milliseconds(seconds)
            late = 1000 * (clock() - start) >= due
            if late and count and skipped < MOST_SKIPPED and (turn, number) != (times, frames):
                skipped += 1
                continue
            skipped = 0
            fb.image(image, fill=0, **options)
            sleep(max(begin / 1000 - (clock() - start), 0))
            shown(panel.show(fb))
            count += 1
        if frames == 1:
            return count
    sleep(max(due / 1000 - (clock() - start), 0))
    return count
