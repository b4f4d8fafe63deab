"""What the outside world does wrong. Wrong arguments are ``ValueError`` and ``TypeError``."""

from __future__ import annotations

from collections.abc import Callable, Iterable


class PanelError(Exception):
    """Root of all that can go wrong between a script and the glass."""


class TransportError(PanelError, OSError):
    """The bus, the port or the panel at its far end failed; ``errno`` says how where the system said so.

    Attributes
    ----------
    transient : bool
        Whether the same write may well succeed a moment later (a busy bus, lost arbitration, a timeout).
    """

    transient: bool = False
    more: Callable[[], str] | None = None
    """Finds out what to do; asks the bus perhaps, so only once nothing more is tried."""

    def final(self) -> TransportError:
        """Return the error for a script to hear, with all that can be said of it."""
        more, self.more = self.more, None
        if more is not None:
            self.strerror = f"{self.strerror}: {more()}"
        return self


class PanelNotFoundError(TransportError):
    """There is no such bus or port, or nobody answers at the address."""


class PanelPermissionError(TransportError):
    """The bus or port exists and this user may not open it."""


class PanelBusyError(TransportError):
    """Somebody else holds the bus or the port."""


class PanelTimeoutError(TransportError):
    """The panel or its bus took too long."""


class PanelDisconnectedError(TransportError):
    """The panel or its port was there and is gone."""


class ProtocolError(PanelError):
    """The far end of a serial link answered something that the protocol does not allow."""


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """Return what a message may end with: the known word that is most like a wrong one, or nothing.

    Examples
    --------
    >>> did_you_mean("colour", ["column_offset", "color"])
    '; did you mean color?'
    """
    import difflib

    near = difflib.get_close_matches(word, list(known), 1)
    return f"; did you mean {near[0]}?" if near else ""
