"""A thread that shows pictures for a panel: the latest one wins; and what is done when none comes for a while."""

from __future__ import annotations

import threading
import time
import weakref
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from paneldraw.errors import PanelTimeoutError

if TYPE_CHECKING:
    from paneldraw.panel import Panel


class Sender:
    """One thread for one panel, started with the first picture; it ends with `stop`, or with the panel.

    Parameters
    ----------
    panel : Panel
        Who shows the pictures. The thread holds it only while it does.

    Attributes
    ----------
    error : BaseException or None
        What went wrong that nobody has heard of.
    """

    def __init__(self, panel: Panel) -> None:
        self._panel = weakref.ref(panel)
        self._lock = threading.RLock()  # a signal handler may hand over a picture in the middle of that
        self._change = threading.Condition(self._lock)
        # Rung for the thread; releasing a lock costs a third of notifying a condition.
        self._bell = threading.Lock()
        self._bell.acquire()
        self._waiting: tuple[npt.NDArray[np.uint8], int] | None = None
        self._busy = False
        self._stopped = False
        self.error: BaseException | None = None
        self._due: float | None = None
        self._thread: threading.Thread | None = None

    def put(self, pixels: npt.NDArray[np.uint8], max_level: int) -> bool:
        """Hand over a picture; return whether it takes the place of one that waited."""
        with self._lock:
            dropped = self._waiting is not None
            self._waiting = pixels, max_level
            if self._thread is None:
                self._start()
            try:  # not in a method: after a pause each call takes 2 us
                if self._bell.locked():
                    self._bell.release()
            except RuntimeError:
                pass  # a signal handler rang it between the two
        return dropped

    def wake_at(self, seconds: float | None) -> None:
        """Say when, on the monotonic clock, the panel has to be looked after; None is never."""
        with self._change:
            self._due = seconds
            if seconds is not None:
                self._start()
                self._ring()

    def flush(self, timeout: float | None = None) -> None:
        """Wait until nothing waits and nothing is under way; raise what went wrong since the last call."""
        with self._change:
            if not self._change.wait_for(lambda: self._waiting is None and not self._busy, timeout):
                raise PanelTimeoutError(None, f"the last picture was not shown within {timeout} s: is the bus stuck?")
        self.raise_error()

    def raise_error(self) -> None:
        """Raise what went wrong in the thread, once."""
        error, self.error = self.error, None
        if error is not None:
            raise error

    def stop(self, timeout: float = 2.0) -> None:
        """Forget what waits, let what is under way end, and end the thread."""
        with self._change:
            self._stopped, self._waiting = True, None
            self._ring()
            self._change.notify_all()
        if self._thread is not None and self._thread is not threading.current_thread():
            self._thread.join(timeout)

    def _start(self) -> None:
        if self._thread is None and not self._stopped:
            self._thread = threading.Thread(target=self._work, name="paneldraw sender", daemon=True)
            self._thread.start()

    def _ring(self) -> None:
        """Wake the thread; `_change` is held."""
        try:
            if self._bell.locked():
                self._bell.release()
        except RuntimeError:
            pass  # a signal handler rang it between the two

    def _work(self) -> None:
        while True:
            with self._change:
                if self._stopped:
                    return
                patience = -1.0 if self._due is None else max(0.0, self._due - time.monotonic())
                patience = min(patience, threading.TIMEOUT_MAX)
                busy = self._busy = self._waiting is not None or self._overdue()
                waiting, self._waiting = self._waiting, None
                if waiting is None and busy:
                    self._due = None
            if not busy:
                self._bell.acquire(timeout=patience)
                continue
            self._serve(waiting)
            with self._change:
                self._busy = False
                self._change.notify_all()

    def _overdue(self) -> bool:
        return self._due is not None and time.monotonic() >= self._due

    def _serve(self, waiting: tuple[npt.NDArray[np.uint8], int] | None) -> None:
        panel = self._panel()
        if panel is None:
            self._stopped = True
            return
        try:
            if waiting is None:
                panel._look_after()
            else:
                panel._show(*waiting)
        except BaseException as error:  # the caller's to hear, whatever it is
            self.error = error
