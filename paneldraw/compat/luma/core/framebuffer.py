"""How pictures are sent, under luma's names. Nothing needs them: only what changed travels anyway."""

from __future__ import annotations

from typing import Any

from paneldraw.panel import Updates

__all__ = ["diff_to_previous", "full_frame"]


class diff_to_previous:
    """Send what differs, in the fewest bytes.

    Examples
    --------
    >>> diff_to_previous().updates
    'least'
    """

    updates: Updates = "least"

    def __init__(self, num_segments: int = 4, debug: bool = False) -> None:
        self.num_segments = num_segments


class full_frame:
    """Send every picture that differs as a whole.

    Examples
    --------
    >>> full_frame().updates
    'whole'
    """

    updates: Updates = "whole"

    def __init__(self, **kwargs: Any) -> None:
        pass
