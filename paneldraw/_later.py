"""Names of a package that are imported where somebody asks for them, with what they need."""

from __future__ import annotations

from collections.abc import Callable, Mapping


def importer(package: str, places: Mapping[str, str]) -> Callable[[str], object]:
    """Return the ``__getattr__`` of a package, whose `places` say in which of its modules each name is."""

    def imported(name: str) -> object:
        if name not in places:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        import importlib

        return getattr(importlib.import_module(f"{package}.{places[name]}"), name)

    return imported
