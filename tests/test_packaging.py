"""A stranger's first line works, with no C compiler too; what is built holds what it should and nothing else."""

from __future__ import annotations

import email
import json
import os
import re
import shutil
import subprocess
import sys
import tarfile
import zipfile
from pathlib import Path

import make_pictures
import numpy as np
import pytest

import paneldraw

PROJECT = Path(__file__).parent.parent
VERSION = re.search(r'^version = "(.*)"$', (PROJECT / "pyproject.toml").read_text(encoding="utf-8"), re.M)[1]
INFO, DATA = f"paneldraw-{VERSION}.dist-info", f"paneldraw-{VERSION}.data"

#: The environment of someone for whom Python finds no package but those that are installed.
STRANGERS = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "PANELDRAW"))}

#: Pictures of every kind of call, as the bytes of their levels.
DRAW = """
import hashlib, json
from paneldraw import Framebuffer, Supersample, _compiled
fb = Framebuffer(96, 48, depth=4)
fb.line(-7, 3, 120, 41, 9)
fb.line(4.25, 40, 90.5, 2.75, width=3.5, antialias=Supersample(4), op="max")
fb.circle(50, 20, 15, 5, fill=True, op="xor")
fb.rect(1, 1, 94, 46, 3)
fb.text("Packed", 40, 30, op="add")
print(json.dumps([_compiled.COMPILED, fb.pixels.tolist()]))
"""


def versioned():
    """The names of all files under version control, and of those that are about to be."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    done = subprocess.run(command, cwd=PROJECT, capture_output=True)
    if done.returncode:
        pytest.skip("this is no clone")
    return [name for name in done.stdout.decode().split("\0") if name and (PROJECT / name).is_file()]


@pytest.fixture(scope="module")
def clone(tmp_path_factory):
    """A fresh copy of the project."""
    folder = tmp_path_factory.mktemp("clone")
    for name in versioned():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(PROJECT / name, folder / name)
    return folder


@pytest.fixture(scope="module")
def without_compiler(clone):
    """A fresh copy of the project in which the README's first line was run where no C compiler works.

    Without compiling, that takes a quarter of a minute, and serves all tests here.
    """
    environment = STRANGERS | {"CC": "/bin/false"}

    def run(command):
        return subprocess.run(
            ["bash", "-c", command],
            cwd=clone,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )

    run.folder = clone
    run.first = run(make_pictures.blocks("sh", "Set-up")[0])
    assert run.first.returncode == 0, run.first.stdout + run.first.stderr
    return run


@pytest.fixture(scope="module")
def pure_wheel(clone):
    """The wheel for all machines, which needs no compiler and seconds."""
    command = [sys.executable, "-m", "pip", "wheel", "--no-deps", "--wheel-dir", "pure", "."]
    environment = STRANGERS | {"PANELDRAW_PURE": "1"}
    done = subprocess.run(command, cwd=clone, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    (built,) = (clone / "pure").iterdir()
    with zipfile.ZipFile(built) as file:
        yield file


@pytest.fixture(scope="module")
def plain_wheel(without_compiler):
    """The wheel that is built where no compiler works, beside what compiling left behind."""
    folder = without_compiler.folder
    assert list(folder.glob("paneldraw/**/*.c"))
    done = without_compiler(".venv/bin/pip wheel --no-deps --wheel-dir dist .")
    assert done.returncode == 0, done.stdout + done.stderr
    with zipfile.ZipFile(next((folder / "dist").glob("paneldraw-*.whl"))) as file:
        yield file


@pytest.fixture(params=["pure_wheel", pytest.param("plain_wheel", marks=pytest.mark.thorough)])
def wheel(request):
    return request.getfixturevalue(request.param)


@pytest.fixture(scope="module")
def sdist(without_compiler, tmp_path_factory):
    """What is built there for others to build from."""
    folder = tmp_path_factory.mktemp("sdist")
    tools = ".venv/bin/python -m venv build && build/bin/pip install 'setuptools>=77'"
    code = f"from setuptools.build_meta import build_sdist; build_sdist('{folder}')"
    done = without_compiler(f'{tools} && build/bin/python -c "{code}"')
    assert done.returncode == 0, done.stdout + done.stderr
    (built,) = folder.glob("paneldraw-*.tar.gz")
    return built


@pytest.mark.thorough
def test_the_first_line_runs_the_demo(without_compiler):
    picture = re.search(r"┌─+┐\n(?:│.{128}│\n)+└─+┘\n", without_compiler.first.stdout)
    assert picture, without_compiler.first.stdout[-3000:]
    assert picture.group().count("█") > 20


@pytest.mark.thorough
def test_without_a_compiler_it_runs_interpreted_and_says_so(without_compiler):
    assert not list(without_compiler.folder.glob("paneldraw/**/*.so"))
    info = without_compiler(".venv/bin/paneldraw info")
    assert info.returncode == 0, info.stderr
    assert re.search(r"^drawing: +interpreted.* run: \S+ -m pip install .*--editable file://", info.stdout, re.M)


@pytest.mark.thorough
def test_an_install_without_a_compiler_draws_the_same(without_compiler):
    assert_drawn_as_here(without_compiler(f".venv/bin/python -c '{DRAW}'"))


def test_the_wheel_for_all_machines_draws_the_same(pure_wheel, tmp_path):
    pure_wheel.extractall(tmp_path)
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    assert_drawn_as_here(
        subprocess.run([sys.executable, "-c", DRAW], cwd=tmp_path, env=environment, capture_output=True, text=True)
    )


def assert_drawn_as_here(interpreted):
    theirs, picture = json.loads(interpreted.stdout)
    ours, expected = json.loads(subprocess.run([sys.executable, "-c", DRAW], capture_output=True, check=True).stdout)
    assert (theirs, ours) == (False, True)
    assert np.any(expected)
    assert picture == expected


def test_the_wheel_holds_the_packages_and_nothing_else(wheel):
    names = wheel.namelist()
    assert {name.partition("/")[0] for name in names} == {"paneldraw", "firmware_protocol", INFO, DATA}
    assert [name for name in names if name.startswith(DATA)] == [f"{DATA}/data/share/man/man1/paneldraw.1"]
    kinds = {Path(name).suffix for name in names if ".dist-info/" not in name}
    assert kinds <= {".py", ".typed", ".md", ".txt", ".html", ".c", ".h", ".ld", ".hex", ".1", ""}
    expected = {
        str(file.relative_to(PROJECT))
        for package in ("paneldraw", "firmware_protocol")
        for pattern in ("**/*.py", "py.typed", "PROTOCOL.md", "**/*.txt", "simulator/page.html")
        for file in (PROJECT / package).glob(pattern)
    }
    expected.update(name for name in versioned() if name.startswith("firmware_protocol/firmware/"))
    assert {Path(name).name for name in expected} >= {"Makefile", "link.ld", "atmega328p-spi.hex", "bus.c", "bus.h"}
    assert not [name for name in names if name.endswith(".c") and not name.startswith("firmware_protocol/firmware/")]
    assert expected <= set(names)
    assert {"paneldraw/py.typed", "firmware_protocol/py.typed"} <= expected
    assert {"firmware_protocol/vectors/conversations.txt", "paneldraw/text/builtin/ascii.txt"} <= expected
    assert not [name for name in names if re.search(r"(^|/)(tests?|build|conftest)(/|\.|$)", name)]


def test_the_wheel_is_mit_alone(wheel):
    for name in wheel.namelist():
        assert b"GNU General Public" not in wheel.read(name), name
    assert wheel.read(f"{INFO}/licenses/LICENSE").startswith(b"MIT License")


def test_the_metadata(wheel):
    metadata = email.message_from_bytes(wheel.read(f"{INFO}/METADATA"))
    assert metadata["License-Expression"] == "MIT"
    assert metadata["Requires-Python"] == ">=3.10"
    assert {"test", "spi", "web", "bench", "dev"} <= set(metadata.get_all("Provides-Extra"))
    needed = {re.match(r"[\w-]+", line).group() for line in metadata.get_all("Requires-Dist") if "extra ==" not in line}
    assert {"numpy", "Pillow", "smbus2", "pyserial"} <= needed <= {"numpy", "Pillow", "smbus2", "pyserial", "cobs"}
    scripts = wheel.read(f"{INFO}/entry_points.txt").decode()
    assert "paneldraw = paneldraw.cli:main" in scripts
    assert "[pytest11]\npaneldraw = paneldraw.testing.plugin" in scripts
    assert metadata["Version"] == VERSION
    assert f"\n## {VERSION}" in (PROJECT / "CHANGELOG.md").read_text(encoding="utf-8")
    addresses = dict(line.split(", ") for line in metadata.get_all("Project-URL"))
    assert {"Source", "Documentation", "Issues", "Changelog"} == addresses.keys()


def test_the_readme_of_an_index_leads_to_the_files_of_its_version(wheel):
    """No link and no picture but with a whole address, which ends in the name of a file here."""
    metadata = email.message_from_bytes(wheel.read(f"{INFO}/METADATA"))
    assert metadata["Description-Content-Type"] == "text/markdown"
    text = metadata.get_payload()
    here = (PROJECT / "README.md").read_text(encoding="utf-8")
    links, own = (re.findall(r"(!?)\[[^]]*\]\(([^)]*)\)", page) for page in (text, here))
    assert len(links) == len(own) > 15
    home = dict(line.split(", ") for line in metadata.get_all("Project-URL"))["Source"]
    for (picture, address), (_, target) in zip(links, own, strict=True):
        kind = "raw" if picture else "blob"
        assert address == target if target.startswith("https:") else f"{home}/{kind}/v{VERSION}/{target}" == address


def test_the_wheel_for_all_machines_has_nothing_compiled(pure_wheel):
    assert Path(pure_wheel.filename).name == f"paneldraw-{VERSION}-py3-none-any.whl"
    assert b"Root-Is-Purelib: true" in pure_wheel.read(f"{INFO}/WHEEL")


@pytest.mark.thorough
def test_all_wheels_hold_the_same(pure_wheel, plain_wheel):
    assert sorted(pure_wheel.namelist()) == sorted(plain_wheel.namelist())


@pytest.mark.thorough
def test_the_source_distribution_is_whole(sdist):
    with tarfile.open(sdist) as file:
        names = {name.partition("/")[2] for name in file.getnames() if file.getmember(name).isfile()}
    made = {name for name in names if name in ("PKG-INFO", "setup.cfg") or ".egg-info/" in name}
    assert sorted(names - made) == sorted(set(versioned()) - {".gitignore"})


USER = """
from paneldraw import Framebuffer, Panel, Supersample, open_panel

fb = Framebuffer(8, 8, antialias=Supersample(4))
reveal_type(fb.pixels)
reveal_type(fb.depth)
reveal_type(fb.antialias)
reveal_type(open_panel)
fb.line(0, 0.5, 7, 7, 1, width=2)
fb.line("0", 0, 7, 7)
fb.line(0, 0, 7, 7, thickness=2)
fb.lien(0, 0, 7, 7)
"""


@pytest.mark.thorough
def test_a_users_type_checker_knows_the_types(wheel, tmp_path):
    pytest.importorskip("mypy")
    wheel.extractall(tmp_path / "installed")
    (tmp_path / "user.py").write_text(USER, encoding="utf-8")
    command = [sys.executable, "-m", "mypy", "--strict", "--config-file=", "--follow-imports=silent", "user.py"]
    environment = os.environ | {"MYPYPATH": str(tmp_path / "installed")}
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    said = dict(re.findall(r"^user\.py:(\d+): (error: .*|note: Revealed .*)$", done.stdout, re.M))
    assert said.keys() == {"5", "6", "7", "8", "10", "11", "12"}, done.stdout + done.stderr
    assert "ndarray" in said["5"]
    assert '"int"' in said["6"]
    assert re.search(r"Supersample \| \S+ConeFilter \| None", said["7"])
    assert "-> paneldraw.panel.Panel" in said["8"]
    assert "[arg-type]" in said["10"]
    assert "[call-arg]" in said["11"]
    assert "[attr-defined]" in said["12"]


def test_import_is_light_and_touches_nothing():
    names = "from paneldraw import ConeFilter, Framebuffer, Supersample"
    look = f"import json, sys, threading; {names}; print(json.dumps([threading.active_count(), sorted(sys.modules)]))"
    threads, modules = json.loads(subprocess.run([sys.executable, "-c", look], capture_output=True, check=True).stdout)
    assert threads == 1
    assert "numpy" in modules
    assert not {"PIL", "smbus2", "serial", "cobs", "spidev", "gpiod", "aiohttp", "asyncio"} & set(modules)


def test_public_names():
    assert set(paneldraw.__all__) <= set(dir(paneldraw))
    for name in paneldraw.__all__:
        assert getattr(paneldraw, name).__name__ == name
    with pytest.raises(AttributeError, match="no attribute 'panels'"):
        paneldraw.panels  # noqa: B018


@pytest.mark.thorough
def test_the_command_that_info_gives_compiles_what_pip_kept_interpreted(sdist, tmp_path):
    """As a user meets it: installed from an index, here a folder, where no compiler was, with one there later."""
    shutil.copy(sdist, tmp_path)

    def run(command, **names):
        environment = STRANGERS | {"PIP_FIND_LINKS": str(tmp_path), "PIP_CACHE_DIR": str(tmp_path / "cache")} | names
        done = subprocess.run(command, cwd=tmp_path, shell=True, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    run(f"'{sys.executable}' -m venv fresh && fresh/bin/pip install paneldraw", CC="/bin/false")
    assert list((tmp_path / "cache").rglob("paneldraw-*.whl"))
    run("fresh/bin/pip install --force-reinstall --no-deps paneldraw")
    told = re.search(r"^drawing: +interpreted.* run: (.*)$", run("fresh/bin/paneldraw info"), re.M)
    assert told, "pip does not keep what it built any more"
    run(told[1])
    assert re.search(r"^drawing: +compiled$", run("fresh/bin/paneldraw info"), re.M)
