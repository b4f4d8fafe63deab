"""The two speeds of the package: what is compiled is declared, complete and up to date, and what is not still runs."""

from __future__ import annotations

import importlib
import re
import shutil
import subprocess
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

import paneldraw
from paneldraw import _compiled

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PACKAGE = Path(paneldraw.__file__).parent
PROJECT = Path(__file__).parent.parent


def test_this_install_is_compiled():
    assert _compiled.COMPILED, "the raster modules are not compiled: install a C compiler, then the package again"


@pytest.mark.parametrize("name", _compiled.MODULES)
def test_the_compiled_form_is_the_one_that_runs(name):
    assert importlib.import_module(name).__file__.endswith(tuple(EXTENSION_SUFFIXES))


@pytest.mark.parametrize("name", _compiled.MODULES)
def test_the_compiled_form_is_up_to_date(name):
    source = PACKAGE.joinpath(*name.split(".")[1:]).with_suffix(".py")
    compiled = Path(importlib.import_module(name).__file__)
    # An installer may unpack the two a moment apart.
    assert compiled.stat().st_mtime > source.stat().st_mtime - 60, f"{source} changed: install the package again"


def test_the_build_compiles_what_the_package_expects():
    extensions = tomllib.loads((PROJECT / "pyproject.toml").read_text())["tool"]["setuptools"]["ext-modules"]
    assert sorted(extension["name"] for extension in extensions) == sorted(_compiled.MODULES)
    for extension in extensions:
        assert extension["optional"]
        assert extension["sources"] == [extension["name"].replace(".", "/") + ".py"]


def test_every_module_that_uses_cython_is_compiled():
    names = {
        ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
        for file in PACKAGE.rglob("*.py")
        if "\nimport cython\n" in file.read_text(encoding="utf-8")
    }
    assert names == set(_compiled.MODULES)


def test_every_declaration_belongs_to_a_compiled_module():
    for file in PACKAGE.rglob("*.pxd"):
        name = ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
        inlined = re.findall(r"^cdef inline .*?(\w+)\(", file.read_text(encoding="utf-8"), re.M)
        if inlined:  # into the modules that use it; where nothing is compiled, they have it from the file beside it
            assert inlined == importlib.import_module(name).__all__
        else:
            assert name in _compiled.MODULES


def test_the_sources_run_without_a_compiler(sources):
    with sources.in_place() as interpreted:
        assert interpreted is not paneldraw
        assert interpreted._compiled.COMPILED is False
        for name in _compiled.MODULES:
            assert importlib.import_module(name).__file__.endswith(".py")
        assert "cython" not in sys.modules
    assert sys.modules["paneldraw"] is paneldraw


def run(folder, code):
    """What `code` prints, word by word, where the package of `folder` is the one imported."""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_the_stand_in_leaves_no_trace(sources):
    code = """if True:
        import sys, paneldraw
        print(paneldraw.__file__)
        print([name for name in sys.modules if "cython" in name.lower()])
    """
    file, names = run(sources.folder, code)
    assert Path(file).is_relative_to(sources.folder)
    assert names == "[]"


def test_a_cython_of_the_users_own_stays(sources):
    code = """if True:
        import sys, types
        own = sys.modules["cython"] = types.ModuleType("cython")
        shadow = sys.modules["cython.shadow"] = types.ModuleType("cython.shadow")
        finders = list(sys.meta_path)
        import paneldraw
        paneldraw.Framebuffer(8, 8).line(0, 0, 7, 7)
        print(sys.modules["cython"] is own, sys.modules["cython.shadow"] is shadow, sys.meta_path == finders)
        print([name for name in sys.modules if name.startswith("cython")] == ["cython", "cython.shadow"])
    """
    assert run(sources.folder, code) == ["True"] * 4


def test_one_module_without_a_compiled_form_and_all_run_as_sources(tmp_path):
    shutil.copytree(PACKAGE, tmp_path / "paneldraw")
    for suffix in EXTENSION_SUFFIXES:
        (tmp_path / "paneldraw" / "raster" / f"masks{suffix}").unlink(missing_ok=True)
    code = """if True:
        import paneldraw.framebuffer, paneldraw.raster.lines
        print(paneldraw._compiled.COMPILED)
        print(paneldraw.framebuffer.__file__.endswith(".py"), paneldraw.raster.lines.__file__.endswith(".py"))
        fb = paneldraw.Framebuffer(8, 8)
        fb.line(0, 0, 7, 7)
        print(int(fb.pixels.sum()))
    """
    assert run(tmp_path, code) == ["False", "True", "True", "8"]
