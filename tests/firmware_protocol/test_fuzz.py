"""The C core under libFuzzer with the address and undefined behavior sanitizers."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from c_core import FIRMWARE, made

CONVERSATIONS = FIRMWARE.parent / "vectors" / "conversations.txt"


def seeds(folder: Path) -> None:
    """Write the host's half of each golden conversation as what the fuzzer begins with."""
    folder.mkdir()
    for number, part in enumerate(CONVERSATIONS.read_text().split("# ")[1:]):
        chunks = [bytes.fromhex(line[2:])[:255] for line in part.splitlines() if line.startswith(">")]
        (folder / str(number)).write_bytes(b"".join(bytes((0x40, len(chunk))) + chunk for chunk in chunks))


def can_fuzz() -> bool:
    """Return whether there is a clang with libFuzzer and the sanitizers."""
    if not shutil.which("clang"):
        return False
    empty = "int LLVMFuzzerTestOneInput(const char *d, unsigned long n) { return 0; }"
    flags = ["-w", "-fsanitize=fuzzer,address,undefined", "-x", "c", "-", "-o", os.devnull]
    return subprocess.run(["clang", *flags], input=empty, capture_output=True, text=True, check=False).returncode == 0


@pytest.mark.parametrize("seconds", [1, pytest.param(60, marks=pytest.mark.thorough)])
def test_no_input_harms_the_core(tmp_path: Path, seconds: int) -> None:
    if not can_fuzz():
        pytest.skip("clang with libFuzzer and the sanitizers is not installed")
    fuzzer = made("fuzz", "fuzz/fuzz", tmp_path / "build", "clang")
    seeds(tmp_path / "corpus")
    limits = [f"-max_total_time={seconds}", "-timeout=10", "-max_len=2048", "-rss_limit_mb=512", "-verbosity=0"]
    done = subprocess.run(
        [str(fuzzer), *limits, f"-artifact_prefix={tmp_path}/", str(tmp_path / "corpus")],
        capture_output=True, text=True, check=False, timeout=seconds + 60,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr[-4000:]
