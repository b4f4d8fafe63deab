"""How the modules that Cython compiles run as plain Python, where nothing was compiled.

A compiled module needs no ``cython`` at run time. The same file run as plain Python asks for one at import: it is
lent a stand-in of the few names that the modules use, for the length of that import and no longer.
"""

from __future__ import annotations

import importlib
import importlib.abc
import importlib.machinery
import importlib.util
import sys
import warnings
from collections.abc import Sequence
from types import ModuleType
from typing import Any

from paneldraw._compiled import MODULES, PACKAGE


class _Anything:
    """A type or a decorator of cython's: as annotation it says nothing, as decorator it changes nothing."""

    def __getattr__(self, name: str) -> _Anything:
        return self

    def __getitem__(self, item: Any) -> _Anything:
        return self

    def __call__(self, *args: Any, **kwargs: Any) -> Any:
        return args[0] if args else self


class _StandIn(ModuleType):
    """The names of cython's pure-Python mode, doing nothing."""

    compiled = False

    @staticmethod
    def cast(_type: Any, value: Any) -> Any:
        return value

    @staticmethod
    def declare(_type: Any, value: Any = None, visibility: str = "private") -> Any:
        return value

    @staticmethod
    def struct(**fields: Any) -> type:
        return type("struct", (), dict.fromkeys(fields, 0))

    @staticmethod
    def _decorator(*_choices: Any, **_more: Any) -> _Anything:
        return _Anything()

    annotation_typing = exceptval = freelist = auto_pickle = binding = _decorator

    def __getattr__(self, name: str) -> _Anything:
        if name.startswith("__"):
            raise AttributeError(name)
        return _Anything()


class _Lender(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Finds ``cython`` as the stand-in, ``cython.cimports.NAME`` as the module NAME, and `MODULES` as their sources."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if fullname.partition(".")[0] == "cython":
            return importlib.machinery.ModuleSpec(fullname, self, is_package=True)
        if fullname in MODULES:
            source = PACKAGE.joinpath(*fullname.split(".")[1:]).with_suffix(".py")
            return importlib.util.spec_from_file_location(fullname, source)
        return None

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        name = spec.name.removeprefix("cython.cimports.").removeprefix("libc.")
        if name == "math" or name.startswith("paneldraw."):
            alias = ModuleType(spec.name)
            # Only C's math has a rint.
            alias.__dict__.update(vars(importlib.import_module(name)), rint=round)
            return alias
        return _StandIn(spec.name)

    def exec_module(self, module: ModuleType) -> None:
        """Nothing to run: the stand-in is whole when made."""


def _take_back() -> dict[str, ModuleType]:
    return {name: sys.modules.pop(name) for name in list(sys.modules) if name.partition(".")[0] == "cython"}


def load_sources() -> None:
    """Import `MODULES` as plain Python, with the stand-in in ``cython``'s place meanwhile."""
    own = _take_back()
    lender = _Lender()
    sys.meta_path.insert(0, lender)
    try:
        for name in MODULES:
            importlib.import_module(name)
    finally:
        sys.meta_path.remove(lender)
        _take_back()
        sys.modules.update(own)


class _WhenNeeded(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Waits for the first import of one of `MODULES`, and loads them all."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> importlib.machinery.ModuleSpec | None:
        if fullname not in MODULES or getattr(sys.modules.get(__name__), "__dict__", None) is not globals():
            return None  # that of another copy of the package
        _warn()
        load_sources()
        sys.meta_path.remove(self)
        module = sys.modules[fullname]
        self._own = module.__spec__
        module.__spec__ = importlib.machinery.ModuleSpec(fullname, self)  # or else it would be loaded again
        return module.__spec__

    def create_module(self, spec: importlib.machinery.ModuleSpec) -> ModuleType:
        return sys.modules[spec.name]

    def exec_module(self, module: ModuleType) -> None:
        """Nothing to run: it is loaded."""
        module.__spec__ = self._own


def load_when_needed() -> None:
    """Have `MODULES` imported as plain Python where one of them is imported first."""
    sys.meta_path.insert(0, _WhenNeeded())


def advice() -> str:
    """Say why this install is not compiled, and which command mends it."""
    compiled = sorted(file.name for ending in ("so", "pyd") for file in PACKAGE.glob(f"_runtime.*.{ending}"))
    foreign = [name for name in compiled if name.removeprefix("_runtime") not in importlib.machinery.EXTENSION_SUFFIXES]
    if foreign:
        return f"what is compiled here is for another Python or machine ({foreign[0]}); run: {_reinstall()}"
    return f"install a C compiler, then run: {rebuild()}"


def rebuild() -> str:
    """Return the command that compiles this install where there is a C compiler now.

    What was built without one is in pip's cache, and pip would install that again; a wheel from elsewhere was not built
    here at all.
    """
    return _reinstall("--no-binary", "paneldraw")


def _reinstall(*options: str) -> str:
    """Return the command that installs what this install was installed from."""
    import shlex

    if importlib.util.find_spec("pip"):
        command = [sys.executable, "-m", "pip", "install", "--force-reinstall", "--no-deps", "--no-cache-dir"]
    else:  # uv made this environment
        command = ["uv", "pip", "install", "--python", sys.executable, "--reinstall", "--no-deps", "--no-cache"]
    return shlex.join([*command, *options, *_origin()])


def _origin() -> list[str]:
    """Return what pip was asked to install, as arguments for it."""
    import importlib.metadata
    import json

    try:
        recorded = importlib.metadata.distribution("paneldraw").read_text("direct_url.json")
    except importlib.metadata.PackageNotFoundError:
        return ["--editable", str(PACKAGE.parent)]
    if recorded is None:
        return ["paneldraw"]
    origin = json.loads(recorded)
    url = origin["url"]
    if "vcs_info" in origin:
        return [f"{origin['vcs_info']['vcs']}+{url}@{origin['vcs_info']['commit_id']}"]
    if origin.get("dir_info", {}).get("editable"):
        return ["--editable", url]
    return [url]


def _warn() -> None:
    """Say once that drawing is slow where it need not be, as a compiler is a package away."""
    if sys.platform == "linux":
        warnings.warn(
            f"paneldraw draws interpreted, which is slow; {advice()}",
            RuntimeWarning,
            stacklevel=2,
        )
