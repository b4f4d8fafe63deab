"""What changed since the last frame, and the cheapest way found to send it."""

from __future__ import annotations

from paneldraw.update.planner import UPDATES, Planner

__all__ = ["UPDATES", "Planner"]
