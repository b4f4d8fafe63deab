"""Builds wheels for Linux on x86-64 and ARM, on any of them: `python tools/wheels.py [--out DIR] [MACHINE ...]`.

Zig's C compiler, which comes as a Python package, makes code for all of them and links with the glibc of 2012. Debian's
packages have each machine's Python headers. Auditwheel then says which glibc a wheel really asks for, and gives it its
name. Abi3audit has nothing to say here, as the limited API draws half as fast.

No index knows a name of its own for ARMv6, which is the Pi Zero's and the first Pi's, so that wheel is for Linux in
general; pip and piwheels take it. Its instructions are looked up in what the compiler noted of them.
"""

from __future__ import annotations

import argparse
import functools
import os
import re
import shutil
import subprocess
import sys
import tempfile
import venv
import zipfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

PROJECT = Path(__file__).resolve().parent.parent
#: What is installed to build with, in an environment of its own.
TOOLS = ("setuptools>=77", "Cython>=3.2", "ziglang>=0.13", "auditwheel>=6.4", "wheel>=0.45")
GLIBC = "2.17"
#: Python's versions, and the Debian that has them.
PYTHONS = {"3.11": "bookworm", "3.13": "trixie", "3.14": "sid"}
#: Builds for the Python and with the compiler that its environment names.
BUILD = """
import os, sysconfig
from setuptools.build_meta import build_wheel
sysconfig.get_config_vars().update(
    CC=os.environ["CC"], CFLAGS="-DNDEBUG -fwrapv", OPT="", CCSHARED="-fPIC", LDFLAGS="",
    LDSHARED=os.environ["CC"] + " -shared -s -O2", EXT_SUFFIX=os.environ["SUFFIX"],
)
build_wheel(os.environ["OUT"])
"""


class CommandError(Exception):
    """A command failed, or what came of it is not what it should be; the argument is what it said."""


@dataclass(frozen=True)
class Machine:
    """A kind of processor: what Python, Debian and Zig call it, the compiler's options, and the bits of its addresses.

    `audited` is the name under which auditwheel knows it, if it is another, or None for a wheel
    that only tests use. `needs` is what the compiler notes in a file of the processor that it is for.
    """

    name: str
    debian: str
    triple: str
    options: tuple[str, ...] = ()
    audited: str | None = ""
    needs: tuple[str, ...] = ()

    @property
    def tag(self) -> str:
        """The platform that a wheel is for, where auditwheel does not name it."""
        return f"linux_{self.name}"


ARM6 = ("Tag_CPU_arch: v6", "Tag_FP_arch: VFPv2")
MACHINES = (
    Machine("x86_64", "amd64", "x86_64-linux-gnu"),
    Machine("aarch64", "arm64", "aarch64-linux-gnu"),
    Machine("armv7l", "armhf", "arm-linux-gnueabihf", ("-mcpu=generic+v7a-neon-d32+vfp3d16",)),
    Machine("armv6l", "armhf", "arm-linux-gnueabihf", ("-mcpu=arm1176jzf_s",), "armv7l", ARM6),
)
#: The code of armv6l's wheel but for how functions are given numbers with a fraction: as in Debian's armel, which is
#: all software that ARMv6 can run.
ARMEL = Machine("armv6l", "armel", "arm-linux-gnueabi", ("-mcpu=arm1176jzf_s", "-mfloat-abi=softfp"), None, ARM6)


def run(command: Iterable[str | Path], folder: Path, *, errors: bool = False, **environment: str) -> str:
    """Return what a command prints, as errors too if wanted; what it needs of the environment is given by name."""
    words = [str(word) for word in command]
    try:
        done = subprocess.run(
            words, cwd=folder, env=os.environ | environment, stdin=subprocess.DEVNULL, capture_output=True, text=True
        )
    except FileNotFoundError as missing:
        raise CommandError(f"{missing.filename}: not there; .ci/apt-packages says what it belongs to") from None
    if done.returncode:
        raise CommandError(f"{' '.join(words)}\n{done.stdout[-4000:]}{done.stderr[-4000:]}")
    return done.stdout + (done.stderr if errors else "")


def copy_of_the_project(folder: Path, without: tuple[str, ...] = ()) -> Path:
    """Copy what is under version control, but for folders whose names are given, and return where to."""
    for name in run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], PROJECT).split("\0"):
        if name and name.partition("/")[0] not in without and (PROJECT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(PROJECT / name, folder / name)
    return folder


@dataclass(frozen=True)
class Workshop:
    """The folder in which wheels are built, with all that it takes."""

    folder: Path

    @functools.cached_property
    def python(self) -> Path:
        """The interpreter that has the tools."""
        venv.create(self.folder / "tools", with_pip=True)
        python = self.folder / "tools/bin/python"
        run([python, "-m", "pip", "install", "-q", *TOOLS], self.folder)
        return python

    @functools.cached_property
    def zig(self) -> str:
        """The compiler's path."""
        code = "import pathlib, ziglang; print(pathlib.Path(ziglang.__file__).with_name('zig'))"
        return run([self.python, "-c", code], self.folder).strip()

    @functools.cached_property
    def tree(self) -> Path:
        """A copy of the project, in which Cython has to run once."""
        return copy_of_the_project(self.folder / "tree")

    def headers(self, machine: Machine, version: str) -> Path:
        """Return the folder of a Python's headers for a machine, from Debian's package."""
        folder = self.folder / f"{machine.debian}-{version}"
        if not folder.exists():
            unpacked = _unpack(
                f"libpython{version}-dev", PYTHONS[version], machine.debian, folder.with_name(f"{folder.name}-deb")
            )
            include = unpacked / "usr/include"
            shutil.copytree(include / f"python{version}", folder)
            # What stands there in its place includes it.
            shutil.copyfile(include / machine.triple / f"python{version}/pyconfig.h", folder / "pyconfig.h")
        return folder

    def build(self, machine: Machine, version: str, out: Path) -> Path:
        """Build a machine's wheel for a version of Python, check it, and return its path in the folder `out`."""
        shutil.rmtree(self.tree / "build", ignore_errors=True)
        built = self.folder / f"{machine.debian}-{machine.name}-{version}-built"
        options = ["-target", f"{machine.triple}.{GLIBC}", *machine.options, f"-I{self.headers(machine, version)}"]
        tag = version.replace(".", "")
        run(
            [self.python, "-c", BUILD],
            self.tree,
            CC=" ".join([self.zig, "cc", *options]),
            SUFFIX=f".cpython-{tag}-{machine.triple}.so",
            _PYTHON_HOST_PLATFORM=f"linux-{machine.audited or machine.name}",
            OUT=str(built),
        )
        (wheel,) = built.glob("*.whl")
        _check(wheel, machine)
        named = self._named(wheel, f"cp{tag}", machine)
        out.mkdir(parents=True, exist_ok=True)
        return Path(shutil.copy2(named, out))

    def _named(self, wheel: Path, tag: str, machine: Machine) -> Path:
        """Give a wheel its right name and return it; auditwheel has to agree that it needs no newer glibc."""
        platform = machine.tag
        if machine.audited is not None:
            policy = f"manylinux_{GLIBC.replace('.', '_')}_{machine.audited or machine.name}"
            said = run([self.python, "-m", "auditwheel", "show", wheel], self.folder)
            if f'platform tag: "{policy}"' not in " ".join(said.split()):
                raise CommandError(f"{wheel.name}: auditwheel does not find it to be {policy}\n{said}")
            platform = platform if machine.audited else policy
        tags = [f"--python-tag={tag}", f"--abi-tag={tag}", f"--platform-tag={platform}"]
        return wheel.parent / run([self.python, "-m", "wheel", "tags", *tags, wheel], wheel.parent).split()[-1]


def _unpack(package: str, suite: str, architecture: str, folder: Path) -> Path:
    """Unpack one of Debian's packages, of any suite and machine, and return the folder; nothing is installed."""
    for part in ("lists/partial", "archives/partial"):
        (folder / part).mkdir(parents=True)
    (folder / "status").touch()
    (folder / "sources").write_text(f"deb {mirror()} {suite} main\n", encoding="utf-8")
    settings = {
        "Dir::Etc::SourceList": folder / "sources",
        "Dir::Etc::SourceParts": "/dev/null",
        "Dir::State::Lists": folder / "lists",
        "Dir::State::status": folder / "status",
        "Dir::Cache": folder,
        "APT::Architecture": architecture,
        "APT::Architectures": architecture,
        "APT::Sandbox::User": "root",
        "Acquire::Languages": "none",
        "Acquire::Retries": 3,
    }
    apt = ["apt-get", "-qq", *(f"-o{name}={value}" for name, value in settings.items())]
    run([*apt, "update"], folder)
    run([*apt, "download", package], folder)
    (file,) = folder.glob("*.deb")
    run(["dpkg-deb", "-x", file, folder / "root"], folder)
    return folder / "root"


def mirror() -> str:
    """Return where this machine has its packages from; "" if it is no Debian."""
    if shutil.which("apt-get") is None:
        return ""
    listed = ["apt-get", "indextargets", "--format", "$(REPO_URI)", "Label: Debian", "Component: main"]
    return (run(listed, PROJECT).split() or [""])[0].rstrip("/")


def _check(wheel: Path, machine: Machine) -> None:
    """Raise CommandError if a wheel lacks a module, or has one for another processor."""
    listed = {"__file__": str(PROJECT / "paneldraw/_compiled.py")}
    exec((PROJECT / "paneldraw/_compiled.py").read_text(encoding="utf-8"), listed)
    expected = {listed["RUNTIME"], *listed["MODULES"], "paneldraw.simulator._preload"}
    with zipfile.ZipFile(wheel) as file, tempfile.TemporaryDirectory() as folder:
        libraries = [name for name in file.namelist() if name.endswith(".so")]
        found = {name.partition(".")[0].replace("/", ".") for name in libraries}
        if found != expected:
            raise CommandError(f"{wheel.name}: not compiled: {', '.join(sorted(expected - found))}")
        for name in libraries if machine.needs else ():
            noted = run(["readelf", "-A", file.extract(name, folder)], PROJECT)
            for line in machine.needs:
                if not re.search(rf"^ *{line}$", noted, re.M):
                    raise CommandError(f"{wheel.name}: {name} is not for {line}")


def main() -> int:
    """Build the wheels of all machines, or of those that are named, for all versions of Python."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition(":")[0] + ".")
    parser.add_argument("machine", nargs="*", help=f"of {', '.join(machine.name for machine in MACHINES)}; else all")
    parser.add_argument("--out", type=Path, default=PROJECT / "dist", help="folder of the wheels (dist)")
    parser.add_argument("--python", action="append", choices=PYTHONS, help="a version of Python; else all of these")
    arguments = parser.parse_args()
    known = {machine.name: machine for machine in MACHINES}
    for name in arguments.machine:
        if name not in known:
            parser.error(f"no machine is called {name!r}; there are {', '.join(known)}")
    try:
        if not mirror():
            raise CommandError("no Debian, whose packages have the headers of Python: run this in a container of it")
        with tempfile.TemporaryDirectory() as folder:
            workshop = Workshop(Path(folder))
            for name in arguments.machine or known:
                for version in arguments.python or PYTHONS:
                    wheel = workshop.build(known[name], version, arguments.out)
                    print(f"{wheel} {wheel.stat().st_size / 1e6:.2f} MB", flush=True)
    except CommandError as failure:
        print(failure, file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
