"""A line of text that runs through a window too narrow for it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from paneldraw.errors import did_you_mean
from paneldraw.text.font import Font, font_of

if TYPE_CHECKING:
    from typing import Literal

    from paneldraw.framebuffer import Framebuffer

_RUNS = ("loop", "bounce")


class Marquee:
    """A line of text that runs to the left where it is wider than its window, and else stands still.

    Nothing runs by itself: each `draw` shows where the text is by then. The text may be changed at any time.

    Parameters
    ----------
    text : str
        One line; ends of line in it are spaces.
    width : int
        Columns of the window, 1 or more.
    font : Font, optional
        Default: the built-in one.
    run : {"loop", "bounce"}, default "loop"
        Whether the text follows itself round and round, or turns back at its ends.
    speed : float, default 30
        Pixels a second.
    pause : float, default 1
        Seconds for which the text stands before it runs: at the start of a round, or at both ends.
    gap : int, optional
        Columns between the end of the text and its start behind it. Default: three times the height of the font.

    Raises
    ------
    TypeError
        If the text is not a string or a size is not a number.
    ValueError
        If the width or the speed is not positive, the pause or the gap is negative, or there is no such run.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> from paneldraw.text import Marquee
    >>> marquee = Marquee("Now playing: a long title", 64)
    >>> marquee.shift(1), marquee.shift(2)
    (0, 30)
    >>> marquee.draw(Framebuffer(128, 64), 32, 56, t=2.0)
    """

    def __init__(
        self,
        text: str,
        width: int,
        *,
        font: Font | None = None,
        run: Literal["loop", "bounce"] = "loop",
        speed: float = 30,
        pause: float = 1,
        gap: int | None = None,
    ) -> None:
        self.font = font_of(font)
        gap = 3 * self.font.height if gap is None else gap
        if not isinstance(width, int) or not isinstance(gap, int):
            raise TypeError("width and gap must be whole numbers of pixels")
        # Written so that NaN is refused too.
        if not (width >= 1 and 0 < speed < 1e9 and 0 <= pause < 1e9 and gap >= 0):
            raise ValueError(
                "width and speed must be positive, pause and gap not negative, "
                f"not width={width}, speed={speed}, pause={pause}, gap={gap}"
            )
        if run not in _RUNS:
            hint = did_you_mean(run, _RUNS) if isinstance(run, str) else ""
            raise ValueError(f"run must be one of 'loop', 'bounce', not {run!r}{hint}")
        self.width, self.run, self.speed, self.pause, self.gap = width, run, speed, pause, gap
        self._since: float | None = None
        self.text = text

    @property
    def text(self) -> str:
        """What runs; given another text, it starts anew where `draw` takes the time itself."""
        return self._text

    @text.setter
    def text(self, text: str) -> None:
        if not isinstance(text, str):
            raise TypeError(f"text must be a string, not {type(text).__name__}; str(...) makes one")
        line = " ".join(text.splitlines())
        if line != getattr(self, "_text", None):
            self._text, self._since = line, None
            self._length = self.font.measure(line)[0]

    @property
    def height(self) -> int:
        """Rows of the window, those of the font."""
        return self.font.height

    @property
    def runs(self) -> bool:
        """Whether the text is wider than the window, so that it has to be drawn again and again."""
        return self._length > self.width

    def shift(self, t: float) -> int:
        """Return how many columns the text stands to the left after `t` seconds."""
        if not self.runs:
            return 0
        distance = self._length + self.gap if self.run == "loop" else self._length - self.width
        way = distance / self.speed + self.pause
        if self.run == "bounce":
            there = int(t // way) % 2 == 0
            columns = int(max(t % way - self.pause, 0) * self.speed)
            return min(columns if there else distance - columns, distance)
        return min(int(max(t % way - self.pause, 0) * self.speed), distance)

    def draw(
        self,
        fb: Framebuffer,
        x: int = 0,
        y: int = 0,
        c: int | None = None,
        *,
        t: float | None = None,
        op: str = "over",
    ) -> None:
        """Draw what is in the window now, its top-left pixel at (x, y).

        Parameters
        ----------
        fb : Framebuffer
            Or a view.
        x, y : int, default 0
        c : int, optional
            The level of the text. Default: the highest.
        t : float, optional
            Seconds since the text started. Default: since the first drawing of this text, by the clock.
        op : {"over", "xor", "add", "max", "clear"}
        """
        if t is None:
            now = time.monotonic()
            self._since = now if self._since is None else self._since
            t = now - self._since
        shift = self.shift(t)
        with fb.clip(x, y, self.width, self.height):
            fb.text(self._text, x - shift, y, c, font=self.font, op=op)
            if self.runs and self.run == "loop":
                fb.text(self._text, x - shift + self._length + self.gap, y, c, font=self.font, op=op)
