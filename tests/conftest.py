"""What all tests share: the package at both its speeds, and the command as a process."""

from __future__ import annotations

import gc
import importlib
import os
import shutil
import signal
import sys
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import HealthCheck, settings
from running import forked, started
from searching import leave_products

import paneldraw

# A run in the background or under nohup ignores these; the programs that tests start would ignore them too.
for name, usual in (("SIGINT", signal.default_int_handler), ("SIGHUP", signal.SIG_DFL)):
    number = getattr(signal, name, None)
    if number is not None and signal.getsignal(number) is signal.SIG_IGN:
        signal.signal(number, usual)

# No deadline: a test never times. The fixtures here hold nothing that an example could change.
# CI takes the same examples every time, so that a change is judged by what it changed; elsewhere they are always new.
COMMON = settings(
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
    derandomize=bool(os.environ.get("CI")),
)
settings.register_profile("quick", COMMON, max_examples=6)
settings.register_profile("thorough", COMMON, max_examples=50)
settings.load_profile("quick")  # unless --hypothesis-profile names another

# Elsewhere a copy of a process may find its libraries in disorder.
PROCESSES = [forked, pytest.param(started, marks=pytest.mark.thorough)] if sys.platform == "linux" else [started]


@pytest.hookimpl(hookwrapper=True)  # the emulated machines' pytest is old
def pytest_collection():
    """Look for garbage when all is there, and never again among what stays: it saves a quarter of the collection."""
    gc.disable()
    yield
    gc.collect()
    gc.freeze()
    gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """Keep a module's tests in one process, as far as none waits for work: what they share is made once."""
    from xdist.scheduler import WorkStealingScheduling

    return WorkStealingScheduling(config, log)


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    leave_products(items)


@pytest.fixture(params=PROCESSES, ids=lambda process: process.__name__)
def run(request):
    """Run the command: ``run("text", "Hello", stdin="", NAME="value")``, with what the environment shall hold."""
    return request.param


class Sources:
    """The package as an install without a compiler has it: a copy of its sources and drawings, its own modules."""

    def __init__(self, folder):
        original = Path(paneldraw.__file__).parent
        for file in (*original.rglob("*.py"), *original.rglob("*.txt")):
            copy = folder / "paneldraw" / file.relative_to(original)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(file, copy)
        self.folder = folder
        self.modules = {}
        # What compiled modules import late and keep, they have to find before another copy is in place.
        paneldraw.Framebuffer(8, 8).text("a", 0, 0)

    @contextmanager
    def in_place(self):
        """Let ``import paneldraw`` find the copy, here and in what the copy imports."""
        own = _take_out()
        sys.modules.update(self.modules)
        sys.path.insert(0, str(self.folder))
        try:
            yield importlib.import_module("paneldraw")
        finally:
            sys.path.remove(str(self.folder))
            self.modules = _take_out()
            sys.modules.update(own)


def _take_out():
    return {name: sys.modules.pop(name) for name in list(sys.modules) if name.partition(".")[0] == "paneldraw"}


@pytest.fixture
def micropython_names(monkeypatch):
    """The names that `micropython.install` gives are as they were after the test."""
    for name in ("framebuf", "machine", "micropython", "utime"):
        monkeypatch.setitem(sys.modules, name, None)
    for name in ("sleep_ms", "sleep_us", "ticks_ms", "ticks_us", "ticks_add", "ticks_diff"):
        monkeypatch.setattr(f"time.{name}", None, raising=False)


@pytest.fixture
def own_time(monkeypatch):
    """A time for panels that only their own pauses pass, so that no busy machine ends their patience."""
    pauses = [1000.0]
    now = partial(sum, pauses)
    clock = SimpleNamespace(sleep=pauses.append, perf_counter=now, monotonic=now)
    for module in ("panel", "driver"):
        monkeypatch.setattr(f"paneldraw.{module}.time", clock)


@pytest.fixture(scope="session")
def binaries():
    """The rig that emulates an ATmega328P, and the firmware for it; skips where they cannot be built."""
    from emulated import built

    return built()


@pytest.fixture(scope="session")
def sources(tmp_path_factory):
    return Sources(tmp_path_factory.mktemp("sources"))


@pytest.fixture(params=["compiled", "interpreted"])
def package(request, sources):
    """`paneldraw`, compiled and once more as plain Python: a test that draws with it holds for both."""
    if request.param == "compiled":
        yield paneldraw
    else:
        with sources.in_place() as interpreted:
            yield interpreted
