"""Draws on emulated ARM machines what this machine draws, and compares: `python tests/machines/compare.py`, as root.

For each machine it unpacks a small Debian and builds the package with Debian's cross compiler, which must not warn of
what `c_warnings.py` looks for. There, emulated, run those of `random_shapes.py`, whose hashes have to be those of this
machine, and those tests of drawing that compare with patterns: what searches would take long, and the shapes have
already been compared. Ends with 1 if anything differs or fails. Where Debian's packages cannot be had it says which and
why, and ends with 0; a mirror that does not answer is a failure in CI.
"""

from __future__ import annotations

import functools
import http.client
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections import Counter
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from c_warnings import warnings

PROJECT = Path(__file__).parent.parent.parent
SUITE = "bookworm"
#: The project's oldest numpy and Pillow, as it happens.
PACKAGES = (
    *("python3-minimal", "libpython3-stdlib", "python3-dev", "libpython3-dev"),
    *("python3-numpy", "python3-pil", "python3-serial", "python3-pytest", "python3-hypothesis"),
)
#: Of the tests of drawing those that take seconds, and a minute when emulated.
TESTS = (
    *(str(file.relative_to(PROJECT)) for file in sorted((PROJECT / "tests").glob("**/test_*patterns.py"))),
    *("tests/raster/test_half_pixels.py", "tests/raster/test_blit.py", "tests/test_framebuffer_parts.py"),
)


class MissingError(Exception):
    """Packages of Debian's that cannot be had here; the argument says which and why."""


class CommandError(Exception):
    """A command failed; the argument is what it said."""


@dataclass(frozen=True)
class Machine:
    """A kind of processor as Debian, Python, the compiler and the emulator call it, and the bits of its addresses."""

    name: str
    bits: int
    platform: str
    triple: str
    emulator: str

    @property
    def compiler(self) -> str:
        return f"{self.triple}-gcc"


MACHINES = (
    Machine("arm64", 64, "linux-aarch64", "aarch64-linux-gnu", "qemu-aarch64-static"),
    Machine("armhf", 32, "linux-armv7l", "arm-linux-gnueabihf", "qemu-arm-static"),
)


def run(command: Iterable[str | Path], folder: Path, **environment: str) -> str:
    """Return what a command prints; what it needs of the environment is given by name."""
    try:
        done = subprocess.run(
            [str(word) for word in command],
            cwd=folder,
            env=os.environ | environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )
    except FileNotFoundError as missing:
        raise CommandError(f"{missing.filename}: not there; .ci/apt-packages says what it belongs to") from None
    if done.returncode:
        raise CommandError(f"{' '.join(map(str, command))}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout


def mirror() -> str:
    """Return where this machine has its packages from."""
    if shutil.which("apt-get") is None:
        raise MissingError("all packages: this machine has no apt-get")
    listed = ["apt-get", "indextargets", "--format", "$(REPO_URI)", "Label: Debian", "Component: main"]
    found = run(listed, PROJECT).split()
    if not found:
        raise MissingError("all packages: this machine has none of Debian's")
    return found[0].rstrip("/")


def read(url: str) -> str:
    """Return what a mirror has at an address; "" if it says that it has nothing there. Asks three times."""
    for pause in (5, 15, None):
        try:
            with urllib.request.urlopen(url, timeout=30) as answer:
                return str(answer.read().decode())
        except urllib.error.HTTPError as error:
            if error.code in (404, 410):
                return ""
            reason: object = error
        except (OSError, http.client.HTTPException) as error:
            reason = getattr(error, "reason", error)
        if pause is not None:
            time.sleep(pause)
    if os.environ.get("CI"):
        raise CommandError(f"no answer from {url}: {reason}")
    raise MissingError(f"all packages: no answer from {url}: {reason}")


def look_for_packages(machine: Machine, source: str, said: str) -> None:
    """Raise MissingError if a mirror has no packages for a machine, or not all; `said` is what apt says of them."""
    release = read(f"{source}/dists/{SUITE}/Release")
    architectures = re.search(r"^Architectures:(.*)$", release, re.M)
    if architectures is None or machine.name not in architectures[1].split():
        raise MissingError(f"all packages: {source} has none of {SUITE} for {machine.name}")
    missing = re.findall(r"Unable to locate package (\S+)|Package '?([^' ]+)'? has no installation candidate", said)
    if missing:
        names = sorted({name for pair in missing for name in pair if name})
        raise MissingError(f"{', '.join(names)}: {source} does not have them in {SUITE} for {machine.name}")


@dataclass(frozen=True)
class Work:
    """One machine, and the folder in which its root and its build lie."""

    machine: Machine
    folder: Path

    @property
    def root(self) -> Path:
        return self.folder / "root"

    @functools.cached_property
    def python(self) -> Path:
        """The root's interpreter."""
        (found,) = (file for file in self.root.glob("usr/bin/python3.*") if file.suffix[1:].isdigit())
        return found

    def unpack(self) -> None:
        """Unpack a Debian, without running anything of it."""
        source = mirror()
        options = ["--quiet", "--mode=root", "--variant=extract", f"--architectures={self.machine.name}"]
        options += ['--aptopt=Acquire::Retries "3"', f"--include={','.join(PACKAGES)}"]
        try:
            run(["mmdebstrap", *options, SUITE, self.root, f"deb {source} {SUITE} main"], self.folder)
        except CommandError as failure:
            look_for_packages(self.machine, source, str(failure))
            raise

    @functools.cached_property
    def headers(self) -> list[Path]:
        """The folders of the root's headers."""
        folder = self.root / "usr/include"
        return [folder / self.python.name, folder, folder / self.machine.triple]

    def build(self) -> Path:
        """Build a wheel for the machine and return a copy of the project with what was compiled beside its sources."""
        tree = self.folder / "tree"
        listed = run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], PROJECT)
        for name in filter(None, listed.split("\0")):
            if (PROJECT / name).is_file():
                (tree / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(PROJECT / name, tree / name)
        compiler = self.machine.compiler
        tag = f"cpython-{self.python.name.removeprefix('python').replace('.', '')}"
        run(
            [sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", self.folder, "."],
            tree,
            CC=compiler,
            LDSHARED=f"{compiler} -shared",
            CFLAGS=" ".join(["-fPIC", *(f"-I{folder}" for folder in self.headers)]),
            _PYTHON_HOST_PLATFORM=self.machine.platform,
            SETUPTOOLS_EXT_SUFFIX=f".{tag}-{self.machine.triple}.so",
        )
        (wheel,) = self.folder.glob("*.whl")
        shutil.unpack_archive(wheel, tree, "zip")
        return tree

    def warnings(self, tree: Path) -> list[str]:
        """Return what the compiler says of what was built."""
        files = tree.glob("paneldraw/**/*.c")
        return list(
            dict.fromkeys(text for file in files for text in warnings(self.machine.compiler, self.headers, file))
        )

    def emulate(self, folder: Path, *arguments: str) -> str:
        """Return what the machine's Python prints; `folder` holds the package."""
        libraries = Path("/usr/lib") / self.machine.triple
        searched = [libraries, *(self.root / "usr/lib" / self.machine.triple / part for part in ("", "blas", "lapack"))]
        return run(
            [
                *(self.machine.emulator, "-L", self.root, "-E", f"LD_LIBRARY_PATH={':'.join(map(str, searched))}"),
                *(self.python, *arguments),
            ],
            folder,
            PYTHONHOME=str(self.root / "usr"),
            PYTHONPATH=f"{folder}:{self.root / 'usr/lib/python3/dist-packages'}",
        )


def differences(expected: str, found: str) -> list[str]:
    """Return the names of the groups whose hashes differ, or that only one side has."""
    ours, theirs = (dict(line.split(" ", 1)[::-1] for line in text.splitlines()) for text in (expected, found))
    return [name for name in {**ours, **theirs} if ours.get(name) != theirs.get(name)]


def report(machine: Machine, groups: list[str], of: int) -> None:
    """Print how many groups differ, of which kinds, and a few of them in full."""
    print(f"{machine.name}: {len(groups)} of {of} groups of shapes differ")
    for title, part in (("kind", 0), ("depth", 1), ("anti-aliasing", 2)):
        count = Counter(name.split(", ", 2)[part].split("(")[0] for name in groups)
        print(f"  by {title}: " + ", ".join(f"{name} {n}" for name, n in count.most_common()))
    for name in groups[:20]:
        print(f"  {name}")


def compare(work: Work, expected: str) -> bool:
    """Return whether a machine draws what is expected and all else is well; print what was done."""
    times = [time.monotonic()]

    def lap() -> str:
        times.append(time.monotonic())
        return f"{times[-1] - times[-2]:.0f} s"

    name = work.machine.name
    work.unpack()
    print(f"{name}: a root with {work.python.name}, {lap()}", flush=True)
    tree = work.build()
    if work.emulate(tree, "-c", "from paneldraw import _compiled; print(_compiled.COMPILED)").strip() != "True":
        raise CommandError(f"{name}: not all modules were compiled")
    print(f"{name}: built, {lap()}", flush=True)
    said = work.warnings(tree) if work.machine.bits == 32 else []
    for text in said:
        print(f"{name}: {text}")
    found = work.emulate(tree, "tests/machines/random_shapes.py")
    groups = differences(expected, found)
    print(f"{name}: {len(found.splitlines())} groups of shapes, {lap()}", flush=True)
    if groups:
        report(work.machine, groups, len(expected.splitlines()))
    marked = "(not thorough or product) and not hypothesis"
    chosen = ["-p", "no:cacheprovider", "-m", marked, "-k", "not interpreted", "-rf"]
    try:
        tests = work.emulate(tree, "-m", "pytest", *chosen, *TESTS)
    except CommandError as failure:
        print(f"{name}: the tests of drawing fail\n{failure}", flush=True)
        return False
    print(f"{name}: the tests of drawing, {lap()}: {tests.strip().splitlines()[-1]}", flush=True)
    return not groups and not said


def main() -> int:
    """Compare all machines, or those that are named."""
    expected = run([sys.executable, "tests/machines/random_shapes.py"], PROJECT, PYTHONPATH=str(PROJECT))
    chosen = [machine for machine in MACHINES if machine.name in sys.argv[1:] or len(sys.argv) == 1]
    equal = bool(chosen)
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(len(chosen)) as pool:
        works = [Work(machine, Path(folder) / machine.name) for machine in chosen]
        for work in works:
            work.folder.mkdir()
        for work, done in [(work, pool.submit(compare, work, expected)) for work in works]:
            try:
                equal = done.result() and equal
            except MissingError as reason:
                print(f"SKIPPED {work.machine.name}, for want of {reason}")
            except CommandError as failure:
                print(f"{work.machine.name}: {failure}")
                equal = False
    return 0 if equal else 1


if __name__ == "__main__":
    sys.exit(main())
