"""Which test runs; imports nothing."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pytest

WRITTEN = "paneldraw_golden"
"""A test's property that names a golden picture it wrote."""

tests: list[pytest.Item] = []
"""The test that runs is the last one, within which the others run."""
