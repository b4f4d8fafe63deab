"""Every example in the documentation of a public object runs, compiled and not, and prints what it says."""

from __future__ import annotations

import doctest
import functools
import importlib
import inspect
import pkgutil
import re

import pytest
from searching import at_both_speeds

import paneldraw
from paneldraw import _compiled
from paneldraw.compat.luma.oled import device as compat_oled

#: Public objects that may do without an example.
WITHOUT_EXAMPLE = {
    "paneldraw.compat.adafruit.SH1106_SPI",  # as SSD1306_I2C, on pins that only Blinka has
    "paneldraw.compat.adafruit.SSD1306_SPI",
    "paneldraw.compat.luma.core",  # a module
    *(f"paneldraw.compat.luma.lcd.device.{chip}" for chip in ("backlit_device", "st7567", "uc1701x")),  # as pcd8544
    *(f"paneldraw.compat.luma.oled.device.{chip}" for chip in compat_oled.__all__ if chip != "ssd1306"),  # as that one
    "paneldraw.controllers.BUSES",
    "paneldraw.controllers.CHIPS",
    "paneldraw.controllers.Controller",
    "paneldraw.simulator.Frame",
    "paneldraw.simulator.LOOKS",
    "paneldraw.simulator.Preload",  # needs a compiled library; its tests run it
    "paneldraw.simulator.PreloadUnavailableError",
    "paneldraw.simulator.Replayed",
    "paneldraw.simulator.contact_sheet",
    "paneldraw.simulator.save",
    "paneldraw.simulator.serve",
    "paneldraw.testing.Program",
    "paneldraw.testing.SimRun",
    "paneldraw.testing.assert_frame",
    "paneldraw.transports.Cost",
    "paneldraw.transports.Plan",
    "paneldraw.transports.Transport",
    "paneldraw.update.Planner",
    "paneldraw.update.Plans",
    "paneldraw.update.UPDATES",
}


def public_modules():
    """All modules of the package that no part of the name keeps private, and that are no plug-in or entry point."""
    names = [info.name for info in pkgutil.walk_packages(paneldraw.__path__, "paneldraw.")]
    return ["paneldraw", *(name for name in names if not any(part.startswith("_") for part in name.split(".")))]


def exported():
    """What ``from module import *`` would give, by the name under which a script finds it."""
    for name in public_modules():
        for attribute in getattr(importlib.import_module(name), "__all__", ()):
            yield f"{name}.{attribute}"


def resolve(path):
    """The object that is found by that name now, and the module that it is in."""
    parts = path.split(".")
    for length in range(len(parts), 0, -1):
        try:
            module = importlib.import_module(".".join(parts[:length]))
            break
        except ModuleNotFoundError:
            pass
    return functools.reduce(getattr, parts[length:], module), module


def documented():
    """Names of modules, of the functions and classes that they define, and of the classes' public attributes."""
    for module_name in public_modules():
        yield module_name
        for name, thing in vars(importlib.import_module(module_name)).items():
            if name.startswith("_") or getattr(thing, "__module__", None) != module_name:
                continue
            yield f"{module_name}.{name}"
            if inspect.isclass(thing):
                yield from (f"{module_name}.{name}.{attribute}" for attribute in vars(thing) if attribute[0] != "_")


class Parser(doctest.DocTestParser):
    """Knows a picture's row of dark pixels, ``...#``, from a continued line, which has a blank after the dots."""

    _EXAMPLE_RE = re.compile(
        doctest.DocTestParser._EXAMPLE_RE.pattern.replace(r"\.\.\. .*", r"\.\.\. (?:[ ].*)?$"),
        re.MULTILINE | re.VERBOSE,
    )


def examples(path):
    thing, module = resolve(path)
    return Parser().get_doctest(inspect.getdoc(thing) or "", vars(module), path, None, 0)


WITH_EXAMPLE = sorted(path for path in documented() if examples(path).examples)


#: Where the examples are interpreted each time: in the modules that are usually compiled.
COMPILED = tuple(f"{name}." for name in _compiled.MODULES)


@pytest.mark.parametrize(
    ("package", "path"),
    at_both_speeds(WITH_EXAMPLE, [path for path in WITH_EXAMPLE if path.startswith(COMPILED)]),
    indirect=["package"],
)
def test_examples_run_as_printed(package, path, tmp_path, monkeypatch, micropython_names):
    monkeypatch.chdir(tmp_path)
    test = examples(path)
    assert test.examples
    report = []
    results = doctest.DocTestRunner().run(test, out=report.append)
    assert not results.failed, "".join(report)


@pytest.mark.parametrize("path", sorted(set(exported())))
def test_public_objects_have_an_example(path):
    has_example = bool(examples(path).examples)
    assert has_example != (path in WITHOUT_EXAMPLE), "give it an example, or say in WITHOUT_EXAMPLE why it has none"


def test_the_parser_reads_pictures():
    test = Parser().get_doctest(">>> for x in 1, 2:\n...     f(x)\n...\n...#\n....\n", {}, "", None, 0)
    assert [(e.source, e.want) for e in test.examples] == [("for x in 1, 2:\n    f(x)\n", "...#\n....\n")]


def test_exceptions_are_public_objects():
    assert set(exported()) >= WITHOUT_EXAMPLE


def test_the_main_objects_are_among_them():
    """The runner itself sees compiled classes and their methods."""
    assert {
        "paneldraw.framebuffer.framebuffer.Framebuffer",
        "paneldraw.framebuffer.framebuffer.Framebuffer.text",
        "paneldraw.framebuffer.framebuffer.Framebuffer.line",
        "paneldraw.raster.coverage.Supersample",
        "paneldraw.text.font.Font",
        "paneldraw.text.layout.render",
    } <= set(WITH_EXAMPLE)
