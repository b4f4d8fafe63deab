"""CPU time that the plugin adds to a session of pytest that does not use it, and to a test: sessions side by side."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from importlib.metadata import entry_points
from pathlib import Path
from statistics import median

import measure

A_SESSION, A_TEST = 50.0, 5.0
"""Milliseconds that we want at most."""
TESTS = 100

EMPTY = "import pytest\n@pytest.mark.parametrize('k', range({}))\ndef test_it(k): pass\n"
BY_HAND = """
import pytest
from paneldraw import open_panel
@pytest.mark.parametrize("k", range({}))
def test_it(k):
    with open_panel("sim://ssd1306") as panel, panel.frame() as fb:
        fb.pixel(k, 0, 1)
    assert panel.simulated.pixels[0, k]
"""
BY_FIXTURE = """
import pytest
@pytest.mark.parametrize("k", range({}))
def test_it(k, sim_panel):
    with sim_panel.frame() as fb:
        fb.pixel(k, 0, 1)
    assert sim_panel.pixels[0, k]
"""
GOLDEN = """
import pytest
from paneldraw.testing import assert_frame
@pytest.mark.parametrize("k", range({}))
def test_it(k, sim_panel):
    with sim_panel.frame() as fb:
        fb.pixel(k, 0, 1)
    assert_frame(sim_panel, f"{{k}}.png")
"""


def session(folder: Path, code: str, tests: int, *options: str) -> float:
    """CPU milliseconds of a session of so many tests."""
    (folder / "test_it.py").write_text(code.format(tests))
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *options]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise RuntimeError(done.stdout)
    return 1000 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


def row(name: str, added: list[float], wanted: float) -> None:
    """Print what is added, and whether that is little enough."""
    taken = median(added)
    verdict = measure.VERDICTS.judge(name, f"at most {wanted:g} ms", wanted / max(taken, 1e-3), 1.0)
    print(f"  {name:<44}{taken:9.3f} ms   at most {wanted:g}: {verdict}", flush=True)


def run(rounds: int) -> None:
    """Print what the plugin adds."""
    if not any(entry.name == "paneldraw" for entry in entry_points(group="pytest11")):
        print("  not one ms measured: this install does not name the plugin; pip install -e . does")
        return
    tests = TESTS if measure.SAMPLE else 2
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        without = "-p", "no:paneldraw"
        session(folder, GOLDEN, tests, "--update-frames")  # and what is imported is compiled
        samples: dict[str, list[float]] = {"session": [], "unused": [], "fixture": [], "golden": []}
        for _ in range(rounds):
            samples["session"].append(session(folder, EMPTY, 1) - session(folder, EMPTY, 1, *without))
            many = session(folder, EMPTY, tests) - session(folder, EMPTY, tests, *without)
            samples["unused"].append((many - samples["session"][-1]) / tests)
            by_hand = session(folder, BY_HAND, tests)
            samples["fixture"].append((session(folder, BY_FIXTURE, tests) - by_hand) / tests)
            samples["golden"].append((session(folder, GOLDEN, tests) - by_hand) / tests)
    row("a session that does not use it", samples["session"], A_SESSION)
    row("a test that does not use it", samples["unused"], A_TEST)
    row("a test with sim_panel, beside open_panel", samples["fixture"], A_TEST)
    row("the same, with a golden picture", samples["golden"], A_TEST)
