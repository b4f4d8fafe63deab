"""What becomes of panels when their script ends, is ended, or forks."""

from __future__ import annotations

import atexit
import contextlib
import os
import signal
import threading
import weakref
from types import FrameType
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from paneldraw.panel import Panel

_ENDING: Final = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]
#: Panels that are to be left in some state, and all of them: a forked child has to know which are its parent's.
_left: weakref.WeakSet[Panel] = weakref.WeakSet()
_all: weakref.WeakSet[Panel] = weakref.WeakSet()
_installed = False
ending = 0
"""The signal that is ending the script: nothing may be waited for any more."""


def follow(panel: Panel) -> None:
    """Remember a panel while it lives: a child of a fork must not touch it."""
    _all.add(panel)


def arrange(panel: Panel) -> None:
    """See to it that a panel is closed at the end of the script, and at signals whose default action would end it.

    Handlers that somebody else installed, before or later, are left alone. Signals are seen to only where this is the
    main thread, as Python allows no other.
    """
    global _installed
    _left.add(panel)
    if not _installed:
        _installed = True
        atexit.register(_close_all)
    if threading.current_thread() is threading.main_thread():
        for number in _ENDING:
            if signal.getsignal(number) is signal.SIG_DFL:
                signal.signal(number, _end)


def _close_all() -> None:
    for panel in list(_left):
        with contextlib.suppress(Exception):  # the script's end is no place to raise
            panel.close()


def _end(number: int, frame: FrameType | None) -> None:
    """Close all panels, then let the signal do what it would have done."""
    global ending
    ending = number
    signal.signal(number, signal.SIG_DFL)
    for panel in list(_left):
        if panel._postponed(finish):  # the signal came in the middle of a call, which has to end first
            return
    finish()


def finish() -> None:
    """Close all panels, and end by the signal that came."""
    for panel in list(_left):
        with contextlib.suppress(Exception):
            panel._end() if panel._inside() else panel.close()
    os.kill(os.getpid(), ending)
    if os.getpid() == 1:  # the first process of a container: no signal ends it by default
        os._exit(128 + ending)


def _in_child() -> None:
    for panel in list(_all):
        panel._disown()
    _left.clear()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_in_child)
