"""The benchmarks run: each statement of ours and of the peers at hand, once; what is missing is said."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent / "benchmarks"
#: `link` takes a minute whatever its rounds; what it runs, the tests of the link run too.
NO_GROUPS = ("run", "measure", "peers", "canvases", "link")
GROUPS = sorted(file.stem for file in FOLDER.glob("*.py") if file.stem not in NO_GROUPS)


def run(*arguments):
    command = [sys.executable, str(FOLDER / "run.py"), *arguments]
    return subprocess.run(command, capture_output=True, text=True)


@pytest.mark.parametrize("group", GROUPS)
def test_a_group_runs(group):
    done = run("--rounds", "1", "--once", group)
    assert done.returncode == 0, done.stderr
    assert f"\n{group}: " in done.stdout
    assert any(unit in done.stdout for unit in (" us ", " ms ", " bytes; "))


def test_a_missing_peer_is_reported(tmp_path):
    (tmp_path / "cv2.py").write_text("raise ImportError('No module named cv2')")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); sys.argv[1:] = ['--rounds=1', '--once', 'lines']; "
    code += f"sys.path.insert(0, {str(FOLDER)!r}); import run; run.main()"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "without OpenCV: No module named cv2" in done.stdout
    assert "Pillow" in done.stdout


def test_an_unknown_group_is_refused():
    done = run("drawings")
    assert done.returncode == 2
    assert "no group is called 'drawings'; there are drawing, " in done.stderr
