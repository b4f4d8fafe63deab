"""How long tests search: how many examples a property takes, and what waits for the thorough run."""

from __future__ import annotations

from collections.abc import Collection, Iterable

import pytest
from hypothesis import settings


def examples(times: float, **others: object) -> settings:
    """Return settings with so many times as many examples as most tests take, whatever the profile says that is."""
    return settings(max_examples=max(2, round(times * settings().max_examples)), **others)


def quick(values: Iterable[object], wanted: Collection[object]) -> list[object]:
    """Return values for a ``parametrize``: those that are wanted always run, those that are like them thoroughly."""
    return [value if value in wanted else pytest.param(value, marks=pytest.mark.thorough) for value in values]


def at_both_speeds(values: Collection[object], interpreted: Collection[object]) -> list[object]:
    """Return rows for a ``parametrize`` of `package`, which is indirect, and a value.

    Each runs compiled; ``interpreted`` are those that always run as plain Python too, the others do so thoroughly.
    """
    rest = [value for value in values if value not in interpreted]
    return [
        *(pytest.param("compiled", value) for value in values),
        *(pytest.param("interpreted", value) for value in interpreted),
        *(pytest.param("interpreted", value, marks=pytest.mark.thorough) for value in rest),
    ]
