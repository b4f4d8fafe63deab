"""The two speeds of the package: what is compiled is declared, complete and up to date, and what is not still runs."""

from __future__ import annotations

import importlib
import re
import runpy
import shutil
import subprocess
import sys
import types
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

import pytest

import paneldraw
from paneldraw import _compiled
from paneldraw.simulator import preload

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PACKAGE = Path(paneldraw.__file__).parent
PROJECT = Path(__file__).parent.parent


def test_this_install_is_compiled():
    assert _compiled.COMPILED, "the raster modules are not compiled: install a C compiler, then the package again"


@pytest.mark.skipif(sys.platform != "linux", reason="for Linux alone")
def test_this_install_has_the_library_for_other_programs_up_to_date():
    built, source = preload.library(), PACKAGE / "simulator/preload.c"
    assert built.stat().st_mtime > source.stat().st_mtime - 60, f"{source} changed: install the package again"


@pytest.mark.parametrize("name", _compiled.MODULES)
def test_the_compiled_form_is_the_one_that_runs(name):
    assert importlib.import_module(name).__file__.endswith(tuple(EXTENSION_SUFFIXES))


@pytest.mark.parametrize("name", _compiled.MODULES)
def test_the_compiled_form_is_up_to_date(name):
    source = PACKAGE.joinpath(*name.split(".")[1:]).with_suffix(".py")
    compiled = Path(importlib.import_module(name).__file__)
    # An installer may unpack the two a moment apart.
    assert compiled.stat().st_mtime > source.stat().st_mtime - 60, f"{source} changed: install the package again"


def test_the_build_compiles_what_the_package_expects(monkeypatch):
    asked = []
    setuptools = types.ModuleType("setuptools")
    setuptools.Extension = lambda name, sources, **options: (name, options)
    setuptools.setup = lambda **keywords: asked.append(keywords)
    command = types.ModuleType("setuptools.command.build_ext")
    command.build_ext = object
    for module in (setuptools, types.ModuleType("setuptools.command"), command):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.chdir(PROJECT)
    monkeypatch.delenv("PANELDRAW_PURE", raising=False)
    runpy.run_path("setup.py")
    (keywords,) = asked
    preloaded = ["paneldraw.simulator._preload"] if sys.platform == "linux" else []
    names = [name for name, _ in keywords["ext_modules"]]
    assert names == [_compiled.RUNTIME, *_compiled.MODULES, *preloaded]
    for _, options in keywords["ext_modules"]:
        assert options["optional"]
    for _, options in keywords["ext_modules"][: 1 + len(_compiled.MODULES)]:
        assert "-ffp-contract=off" in options["extra_compile_args"]
        assert not [flag for flag in options["extra_compile_args"] if flag.startswith(("-march", "-mcpu", "-ffast"))]


def test_the_settings_name_no_module_again():
    settings = tomllib.loads((PROJECT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "ext-modules" not in settings["tool"]["setuptools"]


def test_every_module_that_uses_cython_is_compiled():
    names = {
        ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
        for file in PACKAGE.rglob("*.py")
        if "\nimport cython\n" in file.read_text(encoding="utf-8")
    }
    assert names == set(_compiled.MODULES)


def test_every_declaration_is_of_something_that_runs_without_a_compiler(sources):
    """What is declared in a .pxd, or written there to be inlined, stands in the .py beside it for both speeds."""
    declared = {
        ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts): re.findall(
            r"^cdef (?:inline )?[\w *]+?\**(\w+)\(", file.read_text(encoding="utf-8"), re.M
        )
        for file in PACKAGE.rglob("*.pxd")
    }
    assert sum(map(len, declared.values())) > 50
    with sources.in_place():
        for name, functions in declared.items():
            module = importlib.import_module(name)
            assert [function for function in functions if not hasattr(module, function)] == [], name


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


def test_compiled_text_keeps_its_own_fonts_beside_another_copy(sources):
    with sources.in_place():
        paneldraw.Framebuffer(8, 8).text("a", 0, 0)
    fb = paneldraw.Framebuffer(8, 8)
    fb.text("a", 0, 0, font=paneldraw.Font.builtin("8x8"))
    assert fb.pixels.any()


@pytest.mark.parametrize("first", ["paneldraw.raster.stroke", "paneldraw.controllers.packing", "paneldraw.panel"])
def test_the_sources_wait_until_one_is_needed(sources, first):
    code = f"""if True:
        import importlib, sys, paneldraw
        print("numpy" in sys.modules)
        import {first}
        specs = [importlib.import_module(name).__spec__ for name in paneldraw._compiled.MODULES]
        print(all(spec.origin.endswith(".py") and spec.loader.name == spec.name for spec in specs))
        print(len([finder for finder in sys.meta_path if type(finder).__module__.startswith("paneldraw")]))
    """
    assert run(sources.folder, code) == ["False", "True", "0"]


def test_the_stand_in_leaves_no_trace(sources):
    code = """if True:
        import sys, paneldraw
        paneldraw.Framebuffer(8, 8)
        print(paneldraw.__file__)
        print([name for name in sys.modules if "cython" in name.lower()])
    """
    file, names = run(sources.folder, code)
    assert Path(file).is_relative_to(sources.folder)
    assert names == "[]"


def warned(folder, code, *options):
    done = subprocess.run([sys.executable, *options, "-c", code], capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stderr
    return [line for line in done.stderr.splitlines() if "Warning" in line]


@pytest.mark.skipif(sys.platform != "linux", reason="where a compiler is a package away")
def test_sources_say_once_that_they_are_slow_and_what_mends_it(sources):
    draw = "from paneldraw import Framebuffer, Supersample; Framebuffer(8, 8).line(0, 0, 7, 7); import paneldraw.panel"
    (said,) = warned(sources.folder, draw)
    assert "RuntimeWarning: paneldraw draws interpreted, which is slow; install a C compiler, then run: " in said
    assert f"{sys.executable} -m pip install " in said
    assert warned(sources.folder, draw, "-W", "ignore:paneldraw draws interpreted") == []
    assert warned(sources.folder, "import paneldraw, paneldraw.testing.plugin") == []
    assert warned(sources.folder, "import sys; sys.platform = 'darwin'; " + draw) == []
    assert warned(PROJECT, draw) == []


@pytest.mark.skipif(sys.platform != "linux", reason="where a compiler is a package away")
def test_a_wheel_for_another_machine_says_so_and_what_mends_it(sources):
    foreign = sources.folder / "paneldraw/_runtime.cpython-39-riscv64-linux-gnu.so"
    foreign.touch()
    try:
        (said,) = warned(sources.folder, "import paneldraw.framebuffer")
        told = " ".join(run(sources.folder, "from paneldraw.cli.diagnostics import _speed; print(_speed())"))
    finally:
        foreign.unlink()
    reason = "what is compiled here is for another Python or machine (_runtime.cpython-39-riscv64-linux-gnu.so); run: "
    for line in (said, told):
        assert reason in line
        command = line.partition(reason)[2]
        assert command.startswith(f"{sys.executable} -m pip install --force-reinstall --no-deps --no-cache-dir ")
        assert "--no-binary" not in command


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
        (tmp_path / "paneldraw" / "raster" / f"line{suffix}").unlink(missing_ok=True)
    code = """if True:
        import paneldraw.framebuffer, paneldraw.raster.line
        print(paneldraw._compiled.COMPILED)
        print(paneldraw.framebuffer.__file__.endswith(".py"), paneldraw.raster.line.__file__.endswith(".py"))
        fb = paneldraw.Framebuffer(8, 8)
        fb.line(0, 0, 7, 7)
        print(int(fb.pixels.sum()))
    """
    assert run(tmp_path, code) == ["False", "True", "True", "8"]
