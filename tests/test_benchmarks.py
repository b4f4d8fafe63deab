"""The benchmarks run: each statement of ours and of the peers at hand, once; what is missing is said."""

from __future__ import annotations

import importlib
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from searching import quick

FOLDER = Path(__file__).parent / "benchmarks"
#: `link` takes a minute whatever its rounds; what it runs, the tests of the link run too.
NO_GROUPS = ("run", "measure", "peers", "canvases", "link")
GROUPS = sorted(file.stem for file in FOLDER.glob("*.py") if file.stem not in NO_GROUPS)


DRAWING = ("lines", "shapes", "pixels", "text", "packed")
#: How much peers cover, where we cover 1. OpenCV's thick lines are thicker than it says.
LEAST, MOST = 0.7, 2


def run(*arguments):
    command = [sys.executable, str(FOLDER / "run.py"), *arguments]
    return subprocess.run(command, capture_output=True, text=True)


# Each session of the one is a process of its own; the other looks at light for as long as an eye does.
@pytest.mark.parametrize("group", quick(GROUPS, {*GROUPS} - {"plugin", "greys"}))
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


def some(names, calls, count):
    """The names that a statement needs, with so many of its calls left."""
    rows = {name: rows for name, rows in names.items() if isinstance(rows, (list, np.ndarray)) and len(rows)}
    cut = {name: rows[: count * len(rows) // calls] for name, rows in rows.items() if len(rows) % calls == 0}
    return names | cut | {"N": count}


def drawn(names, statement, calls):
    """How many pixels' worth a statement's first calls cover."""
    names["wipe"]()
    exec(statement, some(names, calls, 2))
    return sum(shown[:, :128].sum() / (255 if shown.max() > 1 else 1) for shown in names["shown"]())


@pytest.mark.parametrize("group", DRAWING)
def test_what_is_compared_is_the_same_picture(group, monkeypatch):
    """Each peer at hand lights about as many pixels as we do, so that no statement is fast because it draws nothing."""
    monkeypatch.syspath_prepend(FOLDER)
    module = importlib.import_module(group)
    contest = module.contest(rounds=1)
    for row in module.ROWS:
        ours = drawn(contest.names, row.ours, row.calls)
        assert ours > 0 or row.name in ("pixel, read", "scroll"), row.name
        for rival in row.against:
            names = contest.peer(rival.peer)
            if names is not None:
                theirs = drawn(names, rival.statement, row.calls)
                assert LEAST * ours <= theirs <= MOST * ours, f"{row.name}: {rival} {theirs:.1f}, we {ours:.1f}"
