"""How long tests search: how many examples a property takes, and what waits for the thorough run."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator

import pytest
from hypothesis import settings

#: Of a test with more cases than these, at one speed, the quick run has each value of each parameter, not all products.
WHOLE = 12


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


def leave_products(items: Iterable[pytest.Item]) -> None:
    """Leave to the thorough run the cases of large matrices that show no value which a case before them has not."""
    matrices = defaultdict(list)
    for item in items:
        if isinstance(item, pytest.Function) and hasattr(item, "callspec") and not item.get_closest_marker("thorough"):
            matrices[item.parent, item.originalname, item.callspec.params.get("package")].append(item)
    for cases in matrices.values():
        seen: set[tuple[object, ...]] = set()
        for case in cases if len(cases) > WHOLE else ():
            values = set(_axes(case))
            if values <= seen:
                case.add_marker("thorough")
                case.add_marker("product")
            seen |= values


def _axes(item: pytest.Function) -> Iterator[tuple[object, ...]]:
    """The value that a case has of each ``parametrize``, of one with several names the row, and of each fixture."""
    values = {name: id(value) for name, value in item.callspec.params.items()}
    for mark in item.iter_markers("parametrize"):
        names = mark.args[0].replace(",", " ").split() if isinstance(mark.args[0], str) else mark.args[0]
        yield (*names, *(values.pop(name) for name in names))
    yield from values.items()
