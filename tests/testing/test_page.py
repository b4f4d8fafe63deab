"""The page “Test your panel script”: its scripts and tests run as printed, fail as printed, and are typed."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest
from running import ENVIRONMENT, UTF_8

PROJECT = Path(__file__).parent.parent.parent
PAGE = (PROJECT / "docs" / "testing.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```$", PAGE, re.M | re.S)
FILES = {code.split("\n", 1)[0].removeprefix("# "): code for kind, code in BLOCKS if kind == "python"}

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="programs are lent devices by Linux's loader")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with what the page prints, and the golden pictures of it."""
    folder = tmp_path_factory.mktemp("page")
    for name, code in FILES.items():
        (folder / name).write_text(code, encoding="utf-8")
    written = run(folder, "pytest", "-p", "no:cacheprovider", "--update-frames")
    assert written.returncode == 0, written.stdout
    assert "golden pictures written: 3" in written.stdout
    return folder


def run(folder, *command, **environment):
    return subprocess.run(
        [sys.executable, "-m", *command],
        cwd=folder,
        env=ENVIRONMENT | UTF_8 | environment,
        capture_output=True,
        encoding="utf-8",
        timeout=250,
    )


def test_every_block_is_of_a_kind_that_is_tested_here():
    assert {kind for kind, _ in BLOCKS} == {"python", "sh", "text", "toml"}
    assert len(FILES) == sum(kind == "python" for kind, _ in BLOCKS) == 8
    assert all(re.fullmatch(r"\w+\.py", name) for name in FILES)


def test_the_tests_of_the_page_pass(folder):
    done = run(folder, "pytest", "-p", "no:cacheprovider")
    assert done.returncode == 0, done.stdout
    tests = sum(code.count("\ndef test_") for code in FILES.values()) + 1  # one is parametrized with two panels
    assert f"{tests} passed" in done.stdout


@pytest.mark.thorough
def test_the_first_run_has_no_golden_picture(tmp_path):
    for name in ("station.py", "test_station.py"):
        (tmp_path / name).write_text(FILES[name], encoding="utf-8")
    first = run(tmp_path, "pytest", "-p", "no:cacheprovider", "test_station.py")
    assert "there is no golden picture" in first.stdout


@pytest.mark.thorough
def test_a_changed_script_fails_as_the_page_says(folder, tmp_path):
    (tmp_path / "test_station.py").write_text(FILES["test_station.py"], encoding="utf-8")
    (tmp_path / "golden").symlink_to(folder / "golden")
    changed = FILES["station.py"].replace("58 - 2 * celsius,", "58 - 2 * celsius + (celsius == 19),")
    (tmp_path / "station.py").write_text(changed, encoding="utf-8")
    done = run(tmp_path, "pytest", "-p", "no:cacheprovider")
    said = [line[8:] for line in done.stdout.splitlines() if line.startswith("E  ")]
    (printed,) = (code.splitlines() for kind, code in BLOCKS if kind == "text")
    assert said[0] == f"AssertionError: what was shown is not {tmp_path / 'golden' / 'day.png'}"
    assert said[1 : len(printed)] == printed[1:]
    assert said[-1] == "if what was shown is right: pytest --update-frames test_station.py::test_the_day_is_shown"


@pytest.mark.thorough
def test_the_settings_are_known(folder, tmp_path):
    (settings,) = (code for kind, code in BLOCKS if kind == "toml")
    (tmp_path / "pyproject.toml").write_text(settings + 'addopts = ["--strict-config"]\n', encoding="utf-8")
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests" / "golden").symlink_to(folder / "golden")
    for name in ("gauge.py", "test_gauge.py"):
        (tmp_path / name).write_text(FILES[name], encoding="utf-8")
    done = run(tmp_path, "pytest", "-p", "no:cacheprovider", "-W", "error")
    assert done.returncode == 0, done.stdout + done.stderr


WRONG = """
from paneldraw.testing import SimPanel

def test_it(sim_panel: SimPanel) -> None:
    sim_panel.bus.fail(after="3")
"""


@pytest.mark.thorough
def test_the_page_is_typed(folder):
    pytest.importorskip("mypy")
    (folder / "wrong.py").write_text(WRONG, encoding="utf-8")
    typed = [*(name for name in FILES if name != "station.py"), "wrong.py"]
    strict = ("mypy", "--strict", "--config-file=", "--follow-imports=silent", "--cache-dir", ".mypy", *typed)
    done = run(folder, *strict, MYPYPATH=str(PROJECT))
    (folder / "wrong.py").unlink()
    errors = [line for line in done.stdout.splitlines() if ": error: " in line]
    assert {line.partition(":")[0] for line in errors} == {"wrong.py"}, done.stdout + done.stderr
    assert all('Argument "after" to "fail" of' in line for line in errors)
