"""Runs the wheels on emulated ARM machines and compares: `python tests/machines/compare.py [NAME ...]`, as root.

For each machine it unpacks a small Debian, and `tools/wheels.py` builds the wheel. Debian's compiler must not warn of
what `c_warnings.py` looks for. There, emulated, pip installs it, and there run those of `random_shapes.py`, whose
hashes have to be those of this machine, and those tests of drawing, planner, packing and simulator that compare with
patterns and golden pictures: what searches would take long, and the shapes have already been compared. Last it counts
instructions.

No Debian is for ARMv6 with functions that are given numbers in registers of their own. Its wheel runs on Debian's
ARMv7, and what proves that nothing in it is newer is the same code made for Debian's oldest ARM, which runs on an
ARM1176, the Pi Zero's, as does all that is there besides.

Ends with 1 if anything differs or fails. Where Debian's packages cannot be had it says which and why, and ends with 0;
a mirror that does not answer is a failure in CI.
"""

from __future__ import annotations

import functools
import http.client
import os
import re
import sys
import tempfile
import threading
import time
import urllib.error
import urllib.request
from collections import Counter
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import instructions
from c_warnings import warnings

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parent.parent
sys.path.insert(0, str(PROJECT / "tools"))

import wheels  # noqa: E402
from wheels import CommandError, run  # noqa: E402

SUITE, PYTHON = "bookworm", "3.11"
#: The project's oldest numpy and Pillow, as it happens.
PACKAGES = (
    *("python3-minimal", "libpython3-stdlib", "python3-pip"),
    *("python3-numpy", "python3-pil", "python3-serial", "python3-pytest", "python3-hypothesis"),
)
#: Of the tests of drawing, planner, packing and simulator those that take seconds, and a minute when emulated.
TESTS = [
    *(str(file.relative_to(PROJECT)) for file in sorted((PROJECT / "tests").glob("**/test_*patterns.py"))),
    *("tests/raster/test_half_pixels.py", "tests/raster/test_blit.py", "tests/test_framebuffer_parts.py"),
    *("tests/test_update_registers.py", "tests/test_update_ways.py", "tests/simulator/test_ssd1306.py"),
    *("tests/simulator/test_sh1106.py", "tests/simulator/test_ssd1322.py"),
    "tests/demos/test_demos.py::test_demos_look_as_they_did",
    "tests/demos/test_demos.py::test_a_demo_of_sixteen_shades_looks_as_it_did",
]
#: Of what is searched for the packing, which has no other tests.
PROPERTIES = ["tests/controllers/test_packing.py"]
#: Where the instructions are told.
PAGE = PROJECT / "docs/pi_zero.md"
#: One wheel at a time, as they share a folder.
BUILDING = threading.Lock()


class MissingError(Exception):
    """Packages of Debian's that cannot be had here; the argument says which and why."""


@dataclass(frozen=True)
class Machine:
    """Where a wheel runs: on which emulator, and whether pip finds it to be for that machine.

    One in `every` so many groups of shapes is drawn: where fractions are computed in software all would take long.
    """

    name: str
    wheel: wheels.Machine
    emulator: tuple[str, ...]
    fits: bool = True
    every: int = 1


X86_64, AARCH64, ARMV7L, ARMV6L = wheels.MACHINES
MACHINES = (
    Machine("aarch64", AARCH64, ("qemu-aarch64-static",)),
    Machine("armv7l", ARMV7L, ("qemu-arm-static",)),
    Machine("armv6l", ARMV6L, ("qemu-arm-static",), fits=False),
    Machine("arm1176", wheels.ARMEL, ("qemu-arm-static", "-cpu", "arm1176"), every=97),
)
#: The machine whose compiler is asked for warnings, and the one whose instructions are counted.
WARNED, COUNTED = "armv7l", "armv6l"


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


def look_for_packages(debian: str, source: str, said: str) -> None:
    """Raise MissingError if a mirror lacks packages for a machine of Debian's; `said` is what apt says of them."""
    release = read(f"{source}/dists/{SUITE}/Release")
    architectures = re.search(r"^Architectures:(.*)$", release, re.M)
    if architectures is None or debian not in architectures[1].split():
        raise MissingError(f"all packages: {source} has none of {SUITE} for {debian}")
    missing = re.findall(r"Unable to locate package (\S+)|Package '?([^' ]+)'? has no installation candidate", said)
    if missing:
        names = sorted({name for pair in missing for name in pair if name})
        raise MissingError(f"{', '.join(names)}: {source} does not have them in {SUITE} for {debian}")


def unpacked(debian: str, folder: Path) -> Path:
    """Unpack a Debian for one of its machines, without running anything of it, and return the folder."""
    source = wheels.mirror()
    if not source:
        raise MissingError("all packages: this machine has none of Debian's")
    root = folder / f"{debian}-root"
    options = ["--quiet", "--mode=root", "--variant=extract", f"--architectures={debian}"]
    options += ['--aptopt=Acquire::Retries "3"', f"--include={','.join(PACKAGES)}"]
    try:
        run(["mmdebstrap", *options, SUITE, root, f"deb {source} {SUITE} main"], folder)
    except CommandError as failure:
        look_for_packages(debian, source, str(failure))
        raise
    return root


@dataclass(frozen=True)
class Work:
    """One machine, its root, and the folder in which the wheel is installed, beside the tests."""

    machine: Machine
    root: Path
    folder: Path

    @functools.cached_property
    def python(self) -> Path:
        """The root's interpreter."""
        return self.root / f"usr/bin/python{PYTHON}"

    def install(self, wheel: Path) -> None:
        """Have the machine's own pip install a wheel beside the tests, which find no other package."""
        wheels.copy_of_the_project(self.folder, without=("paneldraw", "firmware_protocol"))
        command = ["-m", "pip", "install", "--no-compile", "--no-deps", "--no-index", "--target", str(self.folder)]
        if not self.machine.fits:
            command += ["--only-binary=:all:", f"--platform={self.machine.wheel.tag}"]
        self.emulate(*command, str(wheel))
        # It is Python alone, and Debian's is too old.
        run([sys.executable, "-m", "pip", "install", "-q", "--no-deps", "--target", self.folder, "smbus2"], self.folder)

    def emulate(self, *arguments: str, emulator: tuple[str, ...] = (), errors: bool = False) -> str:
        """Return what the machine's Python prints."""
        triple = self.machine.wheel.triple
        libraries = [Path("/usr/lib") / triple]
        libraries += [self.root / "usr/lib" / triple / part for part in ("", "blas", "lapack")]
        searched = f"LD_LIBRARY_PATH={':'.join(map(str, libraries))}"
        return run(
            [*(emulator or self.machine.emulator), "-L", self.root, "-E", searched, self.python, *arguments],
            self.folder,
            errors=errors,
            PYTHONHOME=str(self.root / "usr"),
            PYTHONPATH=f"{self.folder}:{self.root / 'usr/lib/python3/dist-packages'}",
        )

    def count(self) -> str:
        """Return what instructions.py says of the instructions that it takes."""
        plugin = self.folder / "count.so"
        run(["gcc", "-shared", "-fPIC", "-O2", "-o", plugin, HERE / "count.c"], self.folder)
        emulator = (self.machine.emulator[0].removesuffix("-static"), "-plugin", str(plugin))
        return instructions.table(self.emulate("tests/machines/instructions.py", emulator=emulator, errors=True))


def compiler_says(workshop: wheels.Workshop, machine: wheels.Machine) -> list[str]:
    """Return what Debian's compiler for a machine warns of in what was built."""
    headers = [workshop.headers(machine, PYTHON)]
    files = workshop.tree.glob("paneldraw/**/*.c")
    return list(dict.fromkeys(text for file in files for text in warnings(f"{machine.triple}-gcc", headers, file)))


def differences(expected: str, found: str) -> list[str]:
    """Return the names of the groups whose hashes differ, or that only one side has."""
    ours, theirs = (dict(line.split(" ", 1)[::-1] for line in text.splitlines()) for text in (expected, found))
    return [name for name in {**ours, **theirs} if ours.get(name) != theirs.get(name)]


def report(name: str, groups: list[str], of: int) -> None:
    """Print how many groups differ, of which kinds, and a few of them in full."""
    print(f"{name}: {len(groups)} of {of} groups of shapes differ")
    for title, part in (("kind", 0), ("depth", 1), ("anti-aliasing", 2)):
        count = Counter(name.split(", ", 2)[part].split("(")[0] for name in groups)
        print(f"  by {title}: " + ", ".join(f"{key} {n}" for key, n in count.most_common()))
    for group in groups[:20]:
        print(f"  {group}")


def compare(machine: Machine, workshop: wheels.Workshop, root: Future[Path], expected: str) -> bool:
    """Return whether a machine draws what is expected and its tests pass; print what was done."""
    name = machine.name
    work = Work(machine, root.result(), workshop.folder / name)
    with BUILDING:
        times = [time.monotonic()]
        wheel = workshop.build(machine.wheel, PYTHON, workshop.folder / "wheels" / name)

    def lap() -> str:
        times.append(time.monotonic())
        return f"{times[-1] - times[-2]:.0f} s"

    print(f"{name}: {wheel.name}, {wheel.stat().st_size / 1e6:.2f} MB, {lap()}", flush=True)
    said = compiler_says(workshop, machine.wheel) if name == WARNED else []
    for text in said:
        print(f"{name}: {text}")
    work.install(wheel)
    if work.emulate("-c", "from paneldraw import _compiled; print(_compiled.COMPILED)").strip() != "True":
        raise CommandError(f"{name}: not all modules are compiled")
    print(f"{name}: installed, {lap()}", flush=True)
    found = work.emulate("tests/machines/random_shapes.py", str(machine.every))
    groups = differences("\n".join(expected.splitlines()[:: machine.every]), found)
    print(f"{name}: {len(found.splitlines())} groups of shapes, {lap()}", flush=True)
    if groups:
        report(name, groups, len(expected.splitlines()))
    marked = "(not thorough or product) and not hypothesis"
    for chosen in (["-m", marked, "-k", "not interpreted and not luma", *TESTS], PROPERTIES):
        tests = work.emulate("-m", "pytest", "-p", "no:cacheprovider", "-rf", *chosen)
        print(f"{name}: tests, {lap()}: {tests.strip().splitlines()[-1]}", flush=True)
    strays = []
    if name == COUNTED:
        rows = work.count()
        strays = instructions.strays(PAGE.read_text(encoding="utf-8"), rows)
        print(f"{rows}\n{name}: counted, {lap()}; otherwise than {PAGE.name} says: {strays or 'none'}", flush=True)
    return not (groups or said or strays)


def judged(name: str, answer: Future[bool]) -> bool:
    """Return whether all is well with a machine, and print why not. What cannot be had is no failure."""
    try:
        return answer.result()
    except MissingError as reason:
        print(f"SKIPPED {name}, for want of {reason}")
        return True
    except CommandError as failure:
        print(f"{name}: {failure}")
        return False


def main() -> int:
    """Compare all machines, or those that are named."""
    expected = run([sys.executable, "tests/machines/random_shapes.py"], PROJECT, PYTHONPATH=str(PROJECT))
    chosen = [machine for machine in MACHINES if machine.name in sys.argv[1:] or len(sys.argv) == 1]
    equal = bool(chosen)
    with tempfile.TemporaryDirectory() as name, ThreadPoolExecutor(2) as pool:
        folder = Path(name)
        workshop = wheels.Workshop(folder)
        debians = dict.fromkeys(machine.wheel.debian for machine in chosen)
        roots = {debian: pool.submit(unpacked, debian, folder) for debian in debians}
        answers = {
            machine.name: pool.submit(compare, machine, workshop, roots[machine.wheel.debian], expected)
            for machine in chosen
        }
        for known, answer in answers.items():
            equal = judged(known, answer) and equal
    return 0 if equal else 1


if __name__ == "__main__":
    sys.exit(main())
