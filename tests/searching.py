"""How long a property test searches."""

from __future__ import annotations

from hypothesis import settings


def examples(times: float, **others: object) -> settings:
    """Return settings with so many times as many examples as most tests take, whatever the profile says that is."""
    return settings(max_examples=max(2, round(times * settings().max_examples)), **others)
