"""What waits for the thorough run, and what does not."""

from __future__ import annotations

from searching import at_both_speeds, quick

CONFTEST = """
from searching import leave_products

def pytest_collection_modifyitems(items):
    leave_products(items)
"""

CASES = """
import pytest

@pytest.mark.parametrize("op", ["set", "xor", "add"])
@pytest.mark.parametrize(("x", "y"), [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)])
def test_large(x, y, op): ...

@pytest.mark.parametrize("op", ["set", "xor", "add"])
@pytest.mark.parametrize("x", [0, 1, 2, 3])
def test_small(x, op): ...
"""


def test_of_a_large_matrix_each_row_and_each_value_runs_quickly(pytester):
    pytester.makeconftest(CONFTEST)
    pytester.makepyfile(CASES)
    items, _ = pytester.inline_genitems("-p", "no:cacheprovider")
    late = {item.name for item in items if item.get_closest_marker("thorough")}
    assert late == {item.name for item in items if item.get_closest_marker("product")}
    assert late == {f"test_large[{row}-{op}]" for row in ("0-1", "1-0", "1-1", "2-2") for op in ("xor", "add")}
    assert len(items) == 15 + 12


def test_values_that_are_like_others_wait():
    first, second = quick(["a", "b"], ["a"])
    assert (first, second.values, [mark.name for mark in second.marks]) == ("a", ("b",), ["thorough"])
    rows = [(*row.values, len(row.marks)) for row in at_both_speeds(["a", "b"], ["b"])]
    assert rows == [("compiled", "a", 0), ("compiled", "b", 0), ("interpreted", "b", 0), ("interpreted", "a", 1)]
