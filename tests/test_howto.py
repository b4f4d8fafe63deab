"""The how-to pages: their blocks run as printed, their commands and URLs are understood, their links lead somewhere."""

from __future__ import annotations

import configparser
import itertools
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from paneldraw import Framebuffer, Panel, cli, urls

DOCS = Path(__file__).parent.parent / "docs"
PAGES = sorted((DOCS / "howto").glob("*.md"))
OTHERS = [*sorted((DOCS / "coming_from").glob("*.md")), DOCS / "they_asked.md"]
RUN = [page for page in PAGES if page.stem != "testing" and "```python" in page.read_text(encoding="utf-8")]
TEXTS = {page: page.read_text(encoding="utf-8") for page in [*PAGES, *OTHERS]}


def of(page):
    return f"{page.parent.name}/{page.stem}"


def blocks(page, kind):
    return re.findall(rf"^```{kind}\n(.*?)^```$", TEXTS[page], re.M | re.S)


def commands(page):
    """The commands of paneldraw's that a page names, in its blocks for a shell and in its sentences."""
    lines = [line for block in blocks(page, "sh") for line in block.splitlines()]
    prose = re.sub(r"^```.*?^```$", "", TEXTS[page], flags=re.M | re.S)
    lines += [" ".join(code.split()) for code in re.findall(r"`([^`]+)`", prose)]
    words = [shlex.split(line, comments=True) for line in lines if re.match(r"(\S+=\S+ )?paneldraw ", line)]
    return [line[line.index("paneldraw") + 1 :] for line in words if "…" not in "".join(line)]


@pytest.mark.parametrize("page", RUN, ids=of)
def test_the_blocks_of_a_page_run_and_print_what_it_says(page, monkeypatch, tmp_path, capsys):
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    monkeypatch.chdir(tmp_path)
    for_ever = Panel.frames
    monkeypatch.setattr(Panel, "frames", lambda panel, fps: itertools.islice(for_ever(panel, fps), 3))
    names = {}
    found = re.findall(r"^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```$)?", TEXTS[page], re.M | re.S)
    assert found
    for code, printed in found:
        if "Rig(" in code and sys.platform != "linux":
            continue  # its port is a pseudo-terminal of Linux
        exec(code, names)
        assert capsys.readouterr().out == printed


def test_the_tests_of_the_page_on_testing_pass(sim_panel):
    names = {}
    (code,) = blocks(DOCS / "howto" / "testing.md", "python")
    exec(code, names)
    names["test_a_third"](sim_panel)
    names["show"](sim_panel, 70)
    with pytest.raises(AssertionError, match="differs"):
        sim_panel.assert_pattern("############\n####.......#", at=(0, 0))


def test_its_test_of_noise_passes(sim_panel):
    names = {}
    exec(blocks(DOCS / "howto" / "testing.md", "python")[0], names)
    names["test_noise_on_the_wire"](sim_panel)
    assert sim_panel.stats.retries == 1


@pytest.mark.parametrize("page", TEXTS, ids=of)
def test_links_lead_somewhere(page):
    prose = re.sub(r"^```.*?^```$", "", TEXTS[page], flags=re.M | re.S)
    links = re.findall(r"\]\((.*?)\)", prose)
    here = [link.partition("#")[0] for link in links if not link.startswith("https://")]
    assert [link for link in here if not (page.parent / link).exists()] == []


@pytest.mark.parametrize("page", TEXTS, ids=of)
def test_urls_are_understood(page):
    for url in re.findall(r"(?:i2c|spi|sim|serial)://[\w./:?&=-]+(?!\S*[…{<])(?=[\s`'\"|)])", TEXTS[page]):
        assert urls.parse(url), url


@pytest.mark.parametrize("page", PAGES, ids=of)
def test_commands_are_understood(page):
    for words in commands(page):
        assert callable(cli._parser().parse_args(words).run), words


@pytest.mark.parametrize("page", TEXTS, ids=of)
def test_calls_exist(page):
    for name in re.findall(r"\bfb\.(\w+)\(", TEXTS[page]):
        assert hasattr(Framebuffer, name), name
    for name in re.findall(r"\bpanel\.(\w+)\(", TEXTS[page]):
        assert hasattr(Panel, name), name


@pytest.mark.skipif(sys.platform == "win32", reason="it has no bash")
@pytest.mark.parametrize("page", PAGES, ids=of)
def test_blocks_for_a_shell_are_sound(page):
    for block in blocks(page, "sh"):
        done = subprocess.run(["bash", "-n", "-c", block], stderr=subprocess.PIPE, text=True)
        assert done.stderr == ""


def test_the_unit_has_what_a_service_needs():
    unit = configparser.ConfigParser(interpolation=None)
    unit.optionxform = str
    unit.read_string(blocks(DOCS / "howto" / "systemd.md", "ini")[0])
    service = dict(unit["Service"])
    assert urls.parse(service["Environment"].removeprefix("PANELDRAW_PANEL=")).panel == {"on_close": "off"}
    for key in ("ExecStart", "ExecStopPost"):
        assert service[key].startswith("/home/pi/.venv/bin/")
    assert cli._parser().parse_args(shlex.split(service["ExecStopPost"])[1:])
    assert unit["Install"]["WantedBy"] == "multi-user.target"


def test_shops_call_panels_what_the_page_says():
    from paneldraw.controllers import CHIPS

    text = (DOCS / "which_panel.md").read_text(encoding="utf-8")
    named = re.findall(r"\b(SSD\d+|SH\d+|ST\d+|MAX\d+|PCD\d+|HT\d+K\d+|IS\d+FL\d+)\b", text)
    assert {name.lower() for name in named} <= set(CHIPS)
    sizes = re.findall(r"^\| [^|]+ \| (\w+)(?: or \w+)?, (\d+x\d+)", text, re.M)
    assert len(sizes) > 7
    for chip, size in sizes:
        assert tuple(map(int, size.split("x"))) in CHIPS[chip.lower()].sizes, chip
