"""Panels live, in the terminal or on a web page, whoever drives them."""

from __future__ import annotations

import errno
from collections.abc import Sequence
from typing import Any, Final, Literal, Protocol

from .frames import Frame, Picture
from .looks import Look, find_look
from .recorder import Showing

Kind = Literal["terminal", "web"]

BEAT: Final = 1 / 30
"""Seconds between two looks at a chip."""
PORT: Final = 8306


class Sight:
    """What can be seen of a chip by looking at it now and then.

    Parameters
    ----------
    chip : chip
        A simulated one.
    title : str, optional
        Default: what chip it is.
    look : str or Look, optional
        Default: the chip's own.

    Attributes
    ----------
    picture : numpy.ndarray
        The last whole picture.
    seconds : float
        When that was, on the bus's clock.
    frames, wire_bytes : int
        How many pictures there were so far, and how many bytes they took.
    label : str
        The picture in words; empty where nobody said.
    """

    def __init__(self, chip: Showing, title: str = "", look: str | Look | None = None) -> None:
        self.chip = chip
        self.picture: Picture = chip.pixels
        self.max_level = chip.max_level
        height, width = self.picture.shape
        self.title = title or f"{type(chip).__name__} {width}x{height}"
        self.look = find_look(look or getattr(chip, "look", None))
        self.seconds = 0.0
        self.frames = self.wire_bytes = 0
        self.label = ""
        self._last: Frame | None = None
        self._before: Frame | None = None
        self.glance()

    def glance(self) -> bool:
        """Look; return whether there is another picture."""
        new: list[Frame] = []
        known = None
        try:
            for frame in reversed(self.chip.frames):
                if frame is self._last or frame is self._before:
                    known = frame
                    break
                new.append(frame)
        except RuntimeError:  # a frame was added meanwhile; it is seen the next time
            return False
        if not new:
            return False
        if self._last is not None and known is self._before:  # the last one had not ended, and has grown
            self.frames -= 1
            self.wire_bytes -= self._last.wire_bytes
        self._last, self._before = new[0], new[1] if len(new) > 1 else known
        self.frames += len(new)
        self.wire_bytes += sum(frame.wire_bytes for frame in new)
        self.picture, self.seconds = new[0].pixels, new[0].seconds
        return True

    @property
    def summary(self) -> str:
        """How many pictures there were, and what they took."""
        pictures = "1 frame" if self.frames == 1 else f"{self.frames} frames"
        return f"{pictures}, {self.wire_bytes} bytes on the wire"


class View(Protocol):
    """Shows panels while they live; a context manager that ends on leaving."""

    url: str
    """Where a browser finds the page; empty in a terminal."""

    def add(self, chip: Showing, title: str = "", look: str | Look | None = None) -> None:
        """Show one more chip, under a title."""

    def remove(self, chip: Showing) -> None:
        """Show a chip no longer."""

    def describe(self, chip: Showing, text: str) -> None:
        """Say in words what a chip shows."""

    def wait(self, timeout: float) -> bool:
        """Wait until somebody may have seen a picture, for so many seconds at most; return whether."""

    def close(self) -> None:
        """End the view; closing twice does nothing."""

    def __enter__(self) -> View: ...

    def __exit__(self, *exception: object) -> None: ...


def open_view(
    kind: Kind,
    chips: Sequence[Showing],
    names: Sequence[str] = (),
    look: str | Look | None = None,
    *,
    host: str = "127.0.0.1",
    port: int | None = None,
) -> View:
    """Show chips live, until the view is closed.

    Parameters
    ----------
    kind : {"terminal", "web"}
        In the terminal that standard output is, or on a web page.
    chips : sequence of chip
        Simulated chips; `View.add` takes more.
    names : sequence of str, optional
        Titles of the chips. Default: what chips they are.
    look : str or Look, optional
        Default: each chip's own.
    host : str, optional
        Address of the page. Default: this machine only; at another one the page's `url` has a secret token.
    port : int, optional
        Port of the page. Default: 8306, or any other where that is taken.

    Returns
    -------
    View
        Its ``url`` is where the page is.

    Raises
    ------
    ValueError
        For another kind, an unknown look or a port that there is none of.
    ImportError
        A web page without aiohttp.
    OSError
        A port that is taken, or an address that is not this machine's.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> with simulator.open_view("web", [simulator.SSD1306(128, 64)], port=0) as view:
    ...     view.url.startswith("http://127.0.0.1:")
    True
    """
    find_look(look)
    if kind == "terminal":
        from .terminal import LiveTerminal

        view: Any = LiveTerminal()
    elif kind == "web":
        view = _page(host, port)
    else:
        raise ValueError(f"kind: {kind!r} is neither terminal nor web")
    for number, chip in enumerate(chips):
        view.add(chip, names[number] if number < len(names) else "", look)
    opened: View = view
    return opened


def _page(host: str, port: int | None) -> Any:
    from .web import serve

    try:
        return serve((), host, PORT if port is None else port)
    except OSError as error:
        if port is not None or error.errno != errno.EADDRINUSE:
            raise
        return serve((), host, 0)
