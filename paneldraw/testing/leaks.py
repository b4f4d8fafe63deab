"""What a test left behind of what panels, buses and viewers hold: threads, devices, sockets, temporary files."""

from __future__ import annotations

import contextlib
import gc
import os
import socket
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from typing import Final

_DEVICES: Final = ("/dev/pts/", "/dev/ptmx", "/dev/tty", "/dev/i2c", "/dev/spidev", "/dev/gpiochip")
_OURS: Final = ("paneldraw", "firmware_protocol")
_PATIENCE: Final = 1.0
"""Seconds that what is about to end has for it."""


@dataclass(frozen=True)
class Held:
    """What a process holds at a moment."""

    threads: frozenset[threading.Thread]
    handles: frozenset[tuple[int, str]]
    folders: frozenset[str]

    @classmethod
    def now(cls) -> Held:
        """Look."""
        return cls(frozenset(threading.enumerate()), frozenset(_handles()), frozenset(_folders()))

    def left(self) -> list[str]:
        """Return what of ours is held now beside this, and does not go within a second."""
        until = time.monotonic() + _PATIENCE
        while (left := self._left()) and time.monotonic() < until:
            gc.collect()
            time.sleep(0.01)
        return left

    def _left(self) -> list[str]:
        now = Held.now()
        threads = [f"thread {thread.name}" for thread in now.threads - self.threads if _is_ours(thread)]
        handles = [f"{place} ({handle})" for handle, place in now.handles - self.handles if _is_device(handle, place)]
        return sorted(threads + handles + list(now.folders - self.folders))


def _is_ours(thread: threading.Thread) -> bool:
    """Whether one of our modules is what a thread runs."""
    run = getattr(thread, "_target", None) or getattr(thread, "function", None) or type(thread)
    return (getattr(run, "__module__", None) or "").partition(".")[0] in _OURS


def _handles() -> list[tuple[int, str]]:
    """The open files of this process and what they are, where the system tells."""
    found = []
    with contextlib.suppress(OSError):
        for name in os.listdir("/proc/self/fd"):
            with contextlib.suppress(OSError):  # the listing's own
                found.append((int(name), os.readlink(f"/proc/self/fd/{name}")))
    return found


def _folders() -> list[str]:
    """The temporary folders of this process's ports and buses, whose names have its number."""
    where = tempfile.gettempdir()
    return [os.path.join(where, name) for name in os.listdir(where) if name.startswith(f"paneldraw-{os.getpid()}-")]


def _is_device(handle: int, place: str) -> bool:
    """Whether an open file is of the kind that panels, boards and viewers hold."""
    return place.startswith(_DEVICES) or (place.startswith("socket:") and _serves(handle))


def _serves(handle: int) -> bool:
    """Whether a socket waits for connections, or is none of the network's."""
    with contextlib.suppress(OSError):
        copy = socket.socket(fileno=os.dup(handle))
        with copy:
            local = sys.platform != "win32" and copy.family == socket.AF_UNIX
            return local or bool(copy.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN))
    return False
