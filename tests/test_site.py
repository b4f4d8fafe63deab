"""The pages as a whole: their code runs, their links lead somewhere, and they leave out nothing that is public."""

from __future__ import annotations

import importlib
import pkgutil
import re
import shlex
import subprocess
from pathlib import Path
from urllib.parse import urlsplit

import make_pictures
import pytest
import steps
import symptoms

import paneldraw
from paneldraw import Panel, cli, open_panel, simulator, urls
from paneldraw.controllers import CHIPS, SSD1306
from paneldraw.pacing import Beat
from paneldraw.transports import i2c

PROJECT = Path(__file__).parent.parent
DOCS = PROJECT / "docs"
PAGES = sorted([*DOCS.rglob("*.md"), *PROJECT.glob("*.md"), *PROJECT.glob("firmware_protocol/**/*.md")])
NAMES = [str(page.relative_to(PROJECT)) for page in PAGES]
FENCED = re.compile(r"^```(\w*)[^\n]*\n(.*?)^```$", re.M | re.S)

#: Pages whose code needs more around it than `steps` gives, and the tests that run it.
TESTED = {
    "README.md": "test_readme.py::test_every_python_block_is_tested_here",
    "docs/add_a_chip.md": "test_docs.py::test_the_blocks_of_the_page_on_adding_a_chip_run",
    "docs/algorithms.md": "test_docs.py::test_every_block_and_table_of_the_algorithms_is_made",
    "docs/examples.md": "test_docs.py::test_the_script_of_the_page_of_examples_runs",
    "docs/fonts.md": "test_docs.py::test_the_blocks_of_the_page_on_fonts_run",
    "docs/gallery.md": "test_docs.py::test_the_gallery_shows_what_its_code_draws",
    "docs/recording.md": "test_docs.py::test_the_page_on_recording_runs_and_prints_what_it_says",
    "docs/simulator.md": "test_docs.py::test_the_page_on_the_simulator_runs_and_prints_what_it_says",
    "docs/testing.md": "testing/test_page.py::folder",
    "docs/watching.md": "test_docs.py::test_the_blocks_of_the_page_on_watching_run",
    "docs/widgets.md": "test_docs.py::test_the_blocks_of_the_page_on_widgets_run",
    "docs/they_asked.md": "test_they_asked.py::test_a_script_prints_what_the_page_says",
    "docs/howto": "test_howto.py::test_the_blocks_of_a_page_run_and_print_what_it_says",
    "docs/coming_from": "compat/test_pages.py::test_scripts_show_the_same_with_the_bytes_that_are_printed",
}


def text_of(page):
    return page.read_text(encoding="utf-8")


def blocks(page, *languages):
    return [code for language, code in FENCED.findall(text_of(page)) if language in languages]


def anchors(page):
    titles = re.findall(r"^#+ (.*)$", FENCED.sub("", text_of(page)), re.M)
    return {re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}


# -- Links


@pytest.mark.parametrize("name", NAMES)
def test_links_lead_somewhere(name):
    page = PROJECT / name
    for link in re.findall(r"\]\(([^)]*)\)", re.sub(r"`[^`\n]*`", "", FENCED.sub("", text_of(page)))):
        place, _, anchor = link.partition("#")
        if ":" in place:
            parts = urlsplit(place)
            assert parts.scheme == "https", link
            assert re.fullmatch(r"[a-z0-9-]+(\.[a-z0-9-]+)+", parts.hostname), link
        else:
            target = (page.parent / place).resolve() if place else page
            assert target.exists(), link
            assert target.is_relative_to(PROJECT), link
            assert not anchor or anchor in anchors(target), link


def test_the_first_page_leads_to_all_others():
    index = text_of(DOCS / "index.md")
    linked = {(DOCS / link).resolve() for link in re.findall(r"\]\(([^)#]*\.md)\)", index)}
    linked |= {DOCS / "api" / link for link in re.findall(r"\]\((\w+\.md)\)", text_of(DOCS / "api/index.md"))}
    assert [str(page.relative_to(PROJECT)) for page in PAGES if page not in linked] == ["docs/index.md"]


# -- Code


@pytest.mark.parametrize("name", [name for name, page in zip(NAMES, PAGES, strict=True) if blocks(page, "python")])
def test_all_code_runs_as_it_is_printed(name):
    tested = TESTED.get(name) or TESTED.get(str(Path(name).parent))
    if tested:
        file, _, function = tested.partition("::")
        assert f"def {function}(" in text_of(PROJECT / "tests" / file)
        return
    page = str(Path(name).relative_to("docs"))
    done = steps.run(page)
    assert len(done) == len(blocks(PROJECT / name, "python"))
    assert [step.printed for step in done if step.text is not None] == [
        step.text for step in done if step.text is not None
    ]


def test_each_step_of_the_tutorial_goes_in_place_of_the_last_block_before_it(tmp_path, monkeypatch):
    written, last = "", ""
    monkeypatch.setattr(Panel, "frames", lambda panel, fps: [Beat(number, number, 0) for number in range(12)])
    monkeypatch.setenv("PANELDRAW_PANEL", "sim://ssd1306")
    found = blocks(DOCS / "tutorial.md", "python")
    for code in found[:-1]:
        kept, begin, last = code.rpartition("\nwith ") if "\nwith " in code else ("", "", code)
        written += kept
        names = {}
        exec(written + begin + last, names)
        assert names["panel"].simulated.pixels.sum() > 40
    assert len(found) == 7


@pytest.mark.parametrize(("name", "draw"), steps.pictures().items())
def test_a_picture_is_what_the_code_above_it_leaves_on_the_panel(name, draw):
    assert make_pictures.is_fresh(name, draw()), "run docs/make_pictures.py"


@pytest.mark.parametrize("folder", ["tutorial", "trouble"])
def test_there_are_no_other_pictures(folder):
    shown = {name for name in steps.pictures() if name.startswith(f"{folder}/")}
    assert shown == {f"{folder}/{file.name}" for file in (DOCS / folder).iterdir()}


COMMANDS = sorted(
    {
        command.strip()
        for page in PAGES
        for block in blocks(page, "sh")
        for line in block.replace("\\\n", " ").splitlines()
        for command in re.findall(r"(?:^|&& |; )(?:\w+=\S+ )*(?:\.venv/bin/)?paneldraw (.*?)(?=&&|\||#|2>|$)", line)
    }
)


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_is_one_that_there_is(command, monkeypatch, tmp_path):
    monkeypatch.chdir(PROJECT)
    ours, program, _ = command.partition(" -- ")
    words = shlex.split(ours) + ["--", "program"][: 2 * bool(program)]
    if "--help" in words or "--version" in words:
        with pytest.raises(SystemExit) as left:
            cli._parser().parse_args(words)
        assert left.value.code == 0
    else:
        assert callable(cli._parser().parse_args(words).run)


@pytest.mark.parametrize("name", [name for name, page in zip(NAMES, PAGES, strict=True) if blocks(page, "sh")])
def test_shell_blocks_are_sound(name):
    for block in blocks(PROJECT / name, "sh"):
        done = subprocess.run(["bash", "-n", "-c", block], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr


# -- Trouble


TROUBLE = text_of(DOCS / "trouble.md")


@pytest.mark.parametrize("name", [name for name, symptom in symptoms.SYMPTOMS.items() if symptom.mend])
def test_a_symptom_is_told_with_its_picture_and_what_mends_it(name):
    sections = [part for part in re.split(r"^## ", TROUBLE, flags=re.M)[1:] if f"](panels/{name}.png)" in part]
    assert len(sections) == 1
    assert f"`{symptoms.SYMPTOMS[name].mend}`" in sections[0].partition(f"](panels/{name}.png)")[2]


def test_what_mends_a_clone_mends_it():
    said = next(step.code for step in steps.steps("trouble.md") if "class Clone" in step.code)
    names = {"simulator": simulator, "Panel": Panel, "SSD1306": SSD1306, "I2CTransport": i2c.I2CTransport}
    exec(said, names)
    with open_panel("sim://ssd1306") as right, right.frame() as fb:
        fb.round_rect(0, 0, 128, 64, 9)
        fb.text("102 km/h", 64, 32, anchor="mm")
    wanted = right.simulated.render(scale=3).tobytes()
    assert names["last_picture"]("plain").tobytes() == wanted != names["picture"].tobytes()


@pytest.mark.parametrize("errno", [2, 13])
def test_what_is_said_of_a_bus_that_does_not_open_is_what_the_page_says(errno, monkeypatch):
    monkeypatch.setattr("glob.glob", lambda pattern: [])
    said = str(i2c._not_opened(OSError(errno, ""), "/dev/i2c-1"))
    assert f"\n```text\n{said}\n```\n" in TROUBLE


# -- Reference


def test_every_parameter_of_a_url_is_told():
    told = set(re.findall(r"`(\w+)=", re.sub(r"\]\(.*?\)", "", text_of(DOCS / "urls.md"))))
    lines = {"dc", "reset", "gpiochip", "speed", "max_message", "baudrate", "chip", "realtime"}
    assert told == {*urls._MODULE, *urls._PANEL, *urls._WATCHING, *lines}


def test_a_parameter_that_only_some_chips_have_names_one_that_has_it():
    rows = dict(re.findall(r"^\| `(\w+)=\S*?`.*? \| (.*?) \|", text_of(DOCS / "urls.md"), re.M))
    for name in ("board", "order", "first_block", "block_rotation", "mirror_blocks", "duty", "resistor_ratio"):
        chips = [chip.name for chip in CHIPS.values() if name in chip.parameters]
        assert rows[name].split(", ") == chips


def public_modules():
    """Modules that say what is public in them, as far as users import them by name."""
    yield paneldraw
    for package in (paneldraw, importlib.import_module("paneldraw.compat")):
        for found in pkgutil.iter_modules(package.__path__, f"{package.__name__}."):
            if not found.name.rpartition(".")[2].startswith("_"):
                module = importlib.import_module(found.name)
                if hasattr(module, "__all__"):
                    yield module
    yield importlib.import_module("firmware_protocol")


def test_every_public_name_is_in_the_reference():
    pages = "\n".join(map(text_of, (DOCS / "api").glob("*.md")))
    told = set(re.findall(r"^\.\. public:: (\S+)$", pages, re.M))
    known = {
        id(getattr(importlib.import_module(name), each))
        for name in told
        for each in importlib.import_module(name).__all__
    }
    modules = list(public_modules())
    assert len(modules) > 12
    for module in modules:
        if module.__name__ not in ("paneldraw.compat.luma", "paneldraw.update"):  # luma's names; no script's affair
            missing = [name for name in module.__all__ if id(getattr(module, name)) not in known]
            assert missing == [], module.__name__
