"""Running the command as a process, and reading what it printed."""

from __future__ import annotations

import os
import subprocess
import sys

ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PANELDRAW_PANEL"}


def run(*arguments, stdin="", **environment):
    return subprocess.run(
        [sys.executable, "-m", "paneldraw", *map(str, arguments)],
        input=stdin,
        capture_output=True,
        encoding="utf-8",
        env={**ENVIRONMENT, "PYTHONIOENCODING": "utf-8", **environment},
        timeout=120,
    )


def picture_of(output):
    """The lines between the borders of what the command printed."""
    return [line[1:-1] for line in output.splitlines() if line.startswith("│")]


def lit(output):
    return sum({"█": 2, "▀": 1, "▄": 1}.get(char, 0) for line in picture_of(output) for char in line)


def assert_one_line_of_advice(done, code):
    assert done.returncode == code, done.stderr
    lines = done.stderr.splitlines()
    assert len(lines) == 1, done.stderr
    assert lines[0].startswith("paneldraw")
    assert "Traceback" not in done.stdout + done.stderr
    assert "Errno" not in lines[0]
