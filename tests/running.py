"""Running the command as a process, and reading what it printed."""

from __future__ import annotations

import atexit
import contextlib
import os
import runpy
import subprocess
import sys
import tempfile
import traceback
import warnings
from pathlib import Path

import paneldraw

ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PANELDRAW_PANEL"}
UTF_8 = {"PYTHONIOENCODING": "utf-8"}


def started(*arguments, stdin="", **environment):
    """Run the command as a shell does."""
    return subprocess.run(
        [sys.executable, "-m", "paneldraw", *map(str, arguments)],
        input=stdin,
        capture_output=True,
        encoding="utf-8",
        env=ENVIRONMENT | UTF_8 | environment,
        timeout=120,
    )


def forked(*arguments, stdin="", **environment):
    """Run the command in a copy of this process: what takes long to import is there already."""
    with contextlib.ExitStack() as stack:
        files = [stack.enter_context(tempfile.TemporaryFile()) for _ in range(3)]
        files[0].write(stdin.encode())
        files[0].seek(0)
        with warnings.catch_warnings():  # of threads, of which the copy has none and waits for none
            warnings.simplefilter("ignore", DeprecationWarning)
            pid = os.fork()
        if not pid:
            _be_the_command([*map(str, arguments)], files, ENVIRONMENT | UTF_8 | environment)
        code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
        for file in files:
            file.seek(0)
        output, errors = (file.read().decode().replace("\r\n", "\n") for file in files[1:])
        return subprocess.CompletedProcess(arguments, code, output, errors)


def _be_the_command(arguments, files, environment):
    """Do as a new process that runs ``python -m paneldraw``, and end."""
    code = 1
    try:
        atexit._clear()
        for number, file in enumerate(files):
            os.dup2(file.fileno(), number)
        encoding = environment["PYTHONIOENCODING"]
        sys.stdin, sys.stdout, sys.stderr = (
            os.fdopen(number, mode, encoding=encoding, errors=errors, closefd=False)
            for number, mode, errors in ((0, "r", "strict"), (1, "w", "strict"), (2, "w", "backslashreplace"))
        )
        os.environ.clear()
        os.environ.update(environment)
        sys.argv[1:] = arguments
        runpy.run_path(str(Path(paneldraw.__file__).with_name("__main__.py")), run_name="__main__")
        code = 0
    except SystemExit as left:
        code = left.code or 0
    except BaseException:
        traceback.print_exc()
    finally:
        atexit._run_exitfuncs()
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(code)


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
