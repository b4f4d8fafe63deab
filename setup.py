"""Compiles the modules that paneldraw/_compiled.py lists; what no C compiler is there for is installed as it is.

With PANELDRAW_PURE=1 in the environment nothing is compiled, and the wheel is one for all machines.
"""

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

LISTED = runpy.run_path("paneldraw/_compiled.py")
DIRECTIVES = (
    *("boundscheck=False", "wraparound=False", "initializedcheck=False", "cdivision=True"),
    *("infer_types=True", "auto_pickle=False"),
)
# Wheels travel, so nothing is made for this processor; no fused multiplications, so all processors round alike.
# -O3 takes a quarter more of the build and draws no faster, but for rows of bytes, which it takes eight times as fast.
FLAGS = ["-O2", "-g0", "-ffp-contract=off"]
if sys.platform == "linux":  # what only C++ and debuggers read: a twentieth
    FLAGS += ["-fno-asynchronous-unwind-tables", "-fno-unwind-tables"]
# Without the names of what only the module itself calls, it is an eighth smaller.
LINKED = ["-Wl,-s"][: sys.platform == "linux"]
# -O1 for what runs once a call.
FAST = ("paneldraw.raster.blit", "paneldraw.raster.dither", "paneldraw.controllers.packing")
# -Os halves the speed of a call, so it is for what is called rarely.
RARE = "paneldraw.framebuffer.copying"
LEVELS = {LISTED["RUNTIME"]: ["-O1"], RARE: ["-Os"], **{name: ["-O3"] for name in FAST}}
# No module, though it is built like one: simulator/preload.py gives it to other programs.
PRELOAD = [
    Extension(
        "paneldraw.simulator._preload",
        ["paneldraw/simulator/preload.c"],
        libraries=["dl", "pthread"],
        extra_compile_args=["-O2", "-g0", "-fvisibility=hidden"],
        extra_link_args=LINKED,
        optional=True,
    )
][: sys.platform == "linux"]


def path(module, ending):
    return module.replace(".", "/") + ending


def translated():
    """Whether all that Cython writes is newer than all that it reads: a declaration concerns many modules."""
    written = [Path(path(module, ".c")) for module in (LISTED["RUNTIME"], *LISTED["MODULES"])]
    read = [Path("setup.py"), *Path("paneldraw").glob("**/*.py"), *Path("paneldraw").glob("**/*.pxd")]
    newest = max(file.stat().st_mtime for file in read)
    return all(file.exists() and file.stat().st_mtime > newest for file in written)


class CythonThenC(build_ext):
    """All modules through one run of Cython, which has ended before the C compiler runs: a small Pi has 0.5 GB.

    That compiles two at a time, 300 MB at its height, hardly more than Cython.
    """

    def finalize_options(self):
        super().finalize_options()
        self.parallel = self.parallel or min(os.cpu_count() or 1, 2)

    def build_extensions(self):
        if not translated():
            cython = [sys.executable, "-m", "cython", "-3"]
            subprocess.run([*cython, "--generate-shared=" + path(LISTED["RUNTIME"], ".c")], check=True)
            sources = [path(module, ".py") for module in LISTED["MODULES"]]
            subprocess.run([*cython, "--shared=" + LISTED["RUNTIME"], "-X", ",".join(DIRECTIVES), *sources], check=True)
        for extension in self.extensions:
            extension.sources = extension.sources or [path(extension.name, ".c")]
        super().build_extensions()


def long_description():
    """The README with its links leading to this version's files where the project is at home."""
    settings = Path("pyproject.toml").read_text(encoding="utf-8")
    home, version = (re.search(rf'^{name} = "(.*)"$', settings, re.M)[1] for name in ("Source", "version"))
    readme = Path("README.md").read_text(encoding="utf-8")
    readme = re.sub(r"(!\[[^]]*\]\()(?!https:)", rf"\g<1>{home}/raw/v{version}/", readme)
    return re.sub(r"(\]\()(?!https:)", rf"\g<1>{home}/blob/v{version}/", readme)


COMPILED = [
    Extension(module, [], extra_compile_args=FLAGS + LEVELS.get(module, []), extra_link_args=LINKED, optional=True)
    for module in (LISTED["RUNTIME"], *LISTED["MODULES"])
]
setup(
    cmdclass={"build_ext": CythonThenC},
    ext_modules=[] if os.environ.get("PANELDRAW_PURE") else COMPILED + PRELOAD,
    long_description=long_description(),
    long_description_content_type="text/markdown",
)
