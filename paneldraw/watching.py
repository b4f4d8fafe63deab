"""Panels that are watched while a script draws on them: live views, recordings, and time as the wire takes it."""

from __future__ import annotations

import contextlib
import errno
import os
import sys
import threading
import time
import warnings
import weakref
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from paneldraw import leaving, urls
from paneldraw.transports import Cost, Plan, Transport

if TYPE_CHECKING:
    from paneldraw.panel import Panel
    from paneldraw.simulator.views import Kind, View

VARIABLE: Final = "PANELDRAW_VIEW"
"""Environment variable that has what would stand behind ``view=``, for all panels whose URL says nothing of it."""
_RECORDED: Final = 100_000_000
"""Bytes of pixels that a recording may hold."""
_PATIENCE: Final = 60.0
"""Seconds that the page of a script that is over waits for its first browser."""
_GLANCE: Final = 0.1
"""Seconds between two looks at whether a signal ends that."""
_SOON: Final = 2.0
"""Seconds within which a browser that was opened usually comes."""

_lock = threading.RLock()
_shared: dict[str, _Shared] = {}
_files: set[str] = set()
_hinted = False
"""What a process has once: views, which its panels share, by their kinds; files that recordings will go to."""


def asked(url: urls.PanelURL | urls.SerialURL) -> urls.Watch:
    """Return how a panel is to be watched, by its URL and else by the environment."""
    said = os.environ.get(VARIABLE)
    if url.watch.views or url.watch.save or not said:
        return url.watch
    try:
        found = urls.watch(f"view={said}")
    except ValueError as error:
        raise ValueError(f"the environment variable {VARIABLE} is {said!r}: {error}") from None
    return replace(found, look=url.watch.look or found.look, realtime=url.watch.realtime)


def watched(panel: Panel) -> bool:
    """Whether somebody watches a panel already."""
    return isinstance(panel.transport, Watched)


def hint() -> None:
    """Say once to a person at a terminal how to see a simulated panel that nobody asked for."""
    global _hinted
    if _hinted or os.environ.get(VARIABLE) or sys.stderr is None or not sys.stderr.isatty():
        return
    _hinted = True
    print(
        "paneldraw: drawing on a simulated SSD1306, as PANELDRAW_PANEL is not set. To watch it, set\n"
        "  PANELDRAW_PANEL='sim://ssd1306?view=terminal'  (or view=web, or save=out.gif);\n"
        "  PANELDRAW_PANEL=sim://ssd1306  draws unseen, and says nothing.",
        file=sys.stderr,
    )


class Watched:
    """A transport to a panel that is watched: views and recordings end when it is closed.

    Parameters
    ----------
    transport : Transport
        To the panel.
    watch : Watch
        What is asked for.
    chip : chip
        The simulated chip that is looked at.
    bus : bus, optional
        The simulated bus that the chip is on, where it is to take the time that a wire takes.
    twin : Transport, optional
        To the chip, where the panel is a real one: it is sent what the panel was sent.
    title : str, optional
        What the panel is called.

    Attributes
    ----------
    chip : chip
    """

    store = 0
    """A board that is watched keeps no sub-pictures, or nobody would see them."""

    def __init__(
        self,
        transport: Transport,
        watch: urls.Watch,
        chip: Any,
        bus: Any = None,
        twin: Transport | None = None,
        title: str = "",
    ) -> None:
        self.chip = chip
        self._averages = hasattr(chip, "glance")
        self._transport, self._twin = transport, twin
        self._look = watch.look
        if watch.realtime:
            bus.realtime = True
        self._process = os.getpid()
        self._kinds: list[str] = []
        self._file = ""
        try:
            if watch.save:
                self._file = _reserved(watch.save)
                chip.history = max(chip.history or 0, _RECORDED // (chip.width * chip.height))
            for kind in watch.views:
                self._kinds.append(_join(kind, chip, title, watch))
        except BaseException:
            self._end()
            raise

    def __getattr__(self, name: str) -> Any:
        return getattr(self._transport, name)

    @property
    def cost(self) -> Cost:
        """What a message costs on the panel's transport."""
        return self._transport.cost

    def command(self, payload: bytes) -> int:
        """Send one command message; return the bytes on the wire."""
        wire = self._transport.command(payload)
        self._tell(lambda twin: twin.command(payload))
        self._glance()
        return wire

    def data(self, payload: bytes) -> int:
        """Send one data message; return the bytes on the wire."""
        wire = self._transport.data(payload)
        self._tell(lambda twin: twin.data(payload))
        self._glance()
        return wire

    def batch(self, plan: Plan) -> int:
        """Send all messages of a plan; return the bytes on the wire."""
        starts = list(plan.starts[: plan.count])
        kinds = plan.buffer[starts]
        wire = self._transport.batch(plan)
        plan.buffer[starts] = kinds  # where the transport put bytes of its own
        self._tell(lambda twin: twin.batch(plan))
        self._glance()
        return wire

    def reset(self) -> bool:
        """Pulse the panel's reset line; return whether there is one."""
        done = self._transport.reset()
        if done:
            self._tell(lambda _: self.chip.reset())
        return done

    def _glance(self) -> None:
        """Let an eye that averages see what is there, for a recording."""
        if self._file and self._averages:
            self.chip.glance()

    def _tell(self, tell: Callable[[Transport], object]) -> None:
        """Let the twin know what the panel got; what goes wrong with it is no concern of the panel's."""
        if self._twin is None:
            return
        try:
            tell(self._twin)
        except Exception as error:
            self._twin = None
            warnings.warn(f"the view of the panel stands still: {error!r}", RuntimeWarning, stacklevel=2)

    def close(self) -> None:
        """Close the transport, end the views and write the recording. Closing twice does nothing."""
        if os.getpid() != self._process:  # they are the parent's
            return
        before = leaving.ending
        try:
            self._transport.close()
        finally:
            self._end()
        if leaving.ending != before:  # a signal came meanwhile, and behind a panel's end nobody looks for it
            leaving.finish()

    def describe(self, text: str) -> None:
        """Say in words what the panel shows."""
        with _lock:
            for kind in self._kinds:
                _shared[kind].view.describe(self.chip, text)

    def _end(self) -> None:
        file, self._file = self._file, ""
        try:
            while self._kinds:
                _leave(self._kinds.pop(), self.chip)
        finally:
            if file:
                _files.discard(file)
                _write(self.chip, file, self._look)


class _Shared:
    """A view of this process, and whether each of its chips is still drawn on."""

    def __init__(self, view: View) -> None:
        self.view = view
        self.chips: dict[Any, tuple[str, bool]] = {}
        self.opened = False
        if view.url:
            print(f"paneldraw: watch at {view.url}", file=sys.stderr, flush=True)

    def open_browser(self) -> None:
        """Show the page in a browser, once."""
        import webbrowser

        screen = sys.platform in ("darwin", "win32") or "DISPLAY" in os.environ or "WAYLAND_DISPLAY" in os.environ
        if screen and not self.opened:  # without one, a browser in the terminal would stand in the script's way
            self.opened = webbrowser.open(self.view.url)

    def close(self) -> None:
        """End the view; a page waits first for a browser, if none came and a person is there who may open one."""
        waits = self.opened or (sys.stderr is not None and sys.stderr.isatty())
        failed = bool(leaving.ending) or sys.exc_info()[0] is not None or hasattr(sys, "last_type")
        if self.view.url and waits and not failed and not self.view.wait(_SOON if self.opened else 0):
            print(
                "paneldraw: the last picture waits there for a browser; Ctrl-C ends that", file=sys.stderr, flush=True
            )
            end = time.monotonic() + _PATIENCE
            with contextlib.suppress(KeyboardInterrupt):
                while not (leaving.ending or self.view.wait(_GLANCE)) and time.monotonic() < end:
                    pass
        self.view.close()


def _join(kind: str, chip: Any, title: str, watch: urls.Watch) -> str:
    """Show a chip in the view of this process; return what the view is filed under."""
    from paneldraw.simulator import open_view

    filed: Kind = "terminal" if kind == "terminal" else "web"
    with _lock:
        if filed not in _shared:
            host, port = watch.listen
            _shared[filed] = _Shared(open_view(filed, (), host=host, port=port))
        shared = _shared[filed]
        for other, (name, open_still) in list(shared.chips.items()):
            if name == title and not open_still:  # a panel that was closed is opened again
                shared.view.remove(other)
                del shared.chips[other]
        shared.view.add(chip, title, watch.look)
        shared.chips[chip] = (title, True)
        if kind == "browser":
            shared.open_browser()
    return filed


def _leave(filed: str, chip: Any) -> None:
    """Know that nobody draws on a chip any more; end the view behind the last. Till then all stay to be seen."""
    with _lock:
        shared = _shared[filed]
        shared.chips[chip] = (shared.chips[chip][0], False)
        if any(open_still for _, open_still in shared.chips.values()):
            return
        del _shared[filed]
    shared.close()


def _reserved(name: str) -> str:
    """Return the file for a recording, which no other one of this process goes to, or raise OSError."""
    from PIL import Image, ImageColor  # noqa: F401 - all that writes a file is there before an interpreter is ending

    Image.preinit()
    path = Path(name).absolute()
    if not os.access(path.parent, os.W_OK) or path.is_dir():
        code = errno.EACCES if path.parent.is_dir() else errno.ENOENT
        raise OSError(code, f"save={name}: cannot write there; check the folder", str(path))
    number = 1
    with _lock:
        while str(path) in _files:
            number += 1
            path = Path(name).absolute().with_stem(f"{Path(name).stem}-{number}")
        _files.add(str(path))
    return str(path)


def _write(chip: Any, file: str, look: str | None) -> None:
    from paneldraw.simulator import Frame, save

    frames = chip.frames or [Frame(chip.pixels, 0.0, 0, chip.max_level)]
    if file.lower().endswith(".png"):  # the last that shone: the end of a script may have left the panel dark
        frames = [next((frame for frame in reversed(frames) if frame.pixels.any()), frames[-1])]
    save(frames, file, look=look or chip.look)


def follow(panel: Panel, watched: Watched) -> None:
    """See to it that views and recordings end when the panel does, at the end of the script at the latest."""
    weakref.finalize(panel, watched.close)
    leaving.arrange(panel)


def describe(panel: Panel, text: str) -> None:
    """Say in words what a panel shows, for those who listen to the page instead of looking at it.

    Parameters
    ----------
    panel : Panel
        One that nobody watches is no error.
    text : str

    Examples
    --------
    >>> from paneldraw import open_panel
    >>> panel = open_panel("sim://ssd1306")
    >>> describe(panel, "21 °C, rising")
    """
    if isinstance(panel.transport, Watched):
        panel.transport.describe(text)


def _in_child() -> None:
    """Know, in a forked child, that all views are the parent's."""
    global _lock
    _lock = threading.RLock()
    _shared.clear()
    _files.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_in_child)
