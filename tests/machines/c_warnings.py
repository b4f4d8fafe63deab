"""What a C compiler warns of in the package's own lines: shifts, signs, narrowing.

Asked of a compiler for 32 bits, where the numbers that count memory are narrow.

Cython writes before each piece of C the line it stands for. Warnings of what has no such line, which is Cython's own
code, are left out.
"""

from __future__ import annotations

import os
import re
import subprocess
from collections.abc import Iterator
from pathlib import Path

FLAGS = (
    *("-fsyntax-only", "-O2", "-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion", "-Wfloat-conversion"),
    *("-Wshift-overflow=2", "-Wno-unused-function", "-Wno-unused-variable", "-Wno-unused-parameter"),
)
#: What is let pass, and why.
ALLOWED = {
    r"from '(long )*(unsigned )?int' to 'double'": "is rounded alike everywhere",
    r"from '.*' to '(short )?unsigned (char|int)'|from '.*' to 'short unsigned int'": "a level is a byte",
    r"^paneldraw/raster/(cone|coverage|disc|polygon|thick_line)\.py.*from 'long long int' to 'Py_ssize_t'": (
        "a place in the window, or a coordinate cut to what shapes may reach; elsewhere `surface.near` says so"
    ),
    r"to '(size_t|unsigned int)'.* from '(int|Py_ssize_t)'": "an amount of memory, which is not negative",
    r"to 'Py_ssize_t'.* from '(size_t|unsigned int)'": "an amount of memory, which is not half of all",
}
_WARNING = re.compile(r"^\S+?\.c:(\d+):\d+: (?:warning|error): (.*)$", re.M)
_SOURCE = re.compile(r'\s*/\* "(paneldraw/[^"]*)":(\d+)$')


def warnings(compiler: str, folders: list[Path], file: Path) -> Iterator[str]:
    """Yield what the compiler says of a C file, each with the line of Python that it is about."""
    command = [compiler, *FLAGS, *(f"-I{folder}" for folder in folders), str(file)]
    done = subprocess.run(command, env=os.environ | {"LC_ALL": "C"}, capture_output=True, text=True)
    lines = file.read_text(encoding="utf-8").split("\n")
    for number, said in _WARNING.findall(done.stderr):
        source = _source(lines, int(number) - 1)
        text = f"{source}: {said}"
        if source and not any(re.search(pattern, text) for pattern in ALLOWED):
            yield text
    if done.returncode:
        yield f"{file}: not compiled\n{done.stderr}"


def _source(lines: list[str], at: int) -> str | None:
    """Return which line of Python a line of C stands for, as file and number."""
    while at >= 0 and not lines[at].startswith(("}", "static ", "#")):
        found = _SOURCE.match(lines[at])
        if found:
            return ":".join(found.groups())
        at -= 1
    return None
