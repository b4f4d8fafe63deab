"""The tests of test_i2c.py once more, through the library for LD_PRELOAD and through a real kernel's i2c-dev."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest
import user_mode_linux
from kernel_answers import rows

from paneldraw.simulator.preload import PreloadUnavailableError, library

TESTS = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", str(Path(__file__).with_name("test_i2c.py"))]


def passed(output):
    return int(re.search(r"(\d+) passed", output)[1])


def test_through_the_preloaded_library():
    try:
        preloaded = str(library())
    except PreloadUnavailableError as error:
        pytest.skip(str(error))
    with tempfile.TemporaryDirectory(prefix="lane-") as folder:
        settings = {"I2C_LANE": "preload", "LD_PRELOAD": preloaded, "PANELDRAW_PRELOAD": f"{folder}/served"}
        done = subprocess.run(TESTS, env=os.environ | settings, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert passed(done.stdout) > len(rows()) + 30


@pytest.mark.thorough
def test_through_a_real_kernel():
    if missing := user_mode_linux.missing():
        pytest.skip(f"user-mode Linux cannot be asked: {missing}")
    paths = os.pathsep.join(filter(None, sys.path))
    with tempfile.TemporaryDirectory(prefix="lane-") as folder:
        status, output = user_mode_linux.run(TESTS, Path(folder), I2C_LANE="uml", PYTHONPATH=paths)
    if status is None:
        pytest.skip(f"user-mode Linux does not start here: {output[-300:]}")
    assert status == 0, output
    assert passed(output) > len(rows()) + 30
