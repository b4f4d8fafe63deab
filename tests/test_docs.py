"""The pages under docs/: every picture is what the code beside it draws, every excerpt and number what the code has."""

from __future__ import annotations

import functools
import itertools
import math
import os
import random
import re
import subprocess
import sys
import time
import warnings
from collections import Counter
from pathlib import Path

import examples as demo_page
import figures
import gallery
import greys_seen
import make_pictures
import numpy as np
import plain_loops as plain
import pytest
import screens
import specimens
import symptoms
import worked_examples as examples
from PIL import Image

from paneldraw import ConeFilter, Framebuffer, Supersample, pacing, simulator, urls, widgets
from paneldraw.cli import check, main
from paneldraw.controllers import CHIPS
from paneldraw.demos import DEMOS
from paneldraw.raster.stroke import CAPS, JOINS
from paneldraw.raster.surface import OPS
from paneldraw.simulator import LOOKS

DOCS = Path(__file__).parent.parent / "docs"
NOT_DRAWING = {"antialias", "depth", "height", "max_level", "pixels", "save", "to_image", "width"}


ENTRIES = list(gallery.entries())
CODE = "\n".join(code for _, _, code in ENTRIES)


@pytest.mark.parametrize(
    "package", ["compiled", pytest.param("interpreted", marks=pytest.mark.thorough)], indirect=["package"]
)
@pytest.mark.usefixtures("package")
def test_the_gallery_shows_what_its_code_draws():
    for name, draw in gallery.pictures().items():
        assert make_pictures.is_fresh(name, draw()), f"{name} is not what its code draws; run docs/make_pictures.py"


def test_each_picture_is_shown_once_and_there_are_no_others():
    names = [name for name, _, _ in ENTRIES]
    assert sorted(names) == sorted(f"pictures/{file.name}" for file in (DOCS / "pictures").iterdir())


@pytest.mark.parametrize(("name", "draw"), specimens.pictures().items())
def test_specimens_show_the_fonts_as_they_are(name, draw):
    with Image.open(DOCS / name) as file:
        shown = np.asarray(file.convert("RGB"))
    assert np.array_equal(np.asarray(draw().convert("RGB")), shown), "run docs/make_pictures.py"
    assert any(f"({name})" in page.read_text(encoding="utf-8") for page in gallery.PAGES)


def test_the_pictures_of_the_gallery_differ():
    pictures = {}
    for name, _, code in ENTRIES:
        fb = gallery.run(code)
        pictures.setdefault((fb.depth, fb.pixels.tobytes()), []).append(name)
    assert [names for names in pictures.values() if len(names) > 1] == []


@pytest.mark.parametrize("call", sorted(name for name in dir(Framebuffer(1, 1)) if not name.startswith("_")))
def test_every_drawing_call_is_in_the_gallery(call):
    assert call in NOT_DRAWING or re.search(rf"\b(fb|part)\.{call}\(", CODE)


WORDS = "even-odd nonzero covered shared dda bayer floyd-steinberg corner box gaussian radius closed dash key palette"


@pytest.mark.parametrize("word", [*OPS, *CAPS, *JOINS, *WORDS.split()])
def test_every_option_is_in_the_gallery(word):
    assert f'"{word}"' in CODE or f"{word}=" in CODE


@pytest.mark.parametrize("call", ["arc", "circle", "line", "poly", "polyline", "rect"])
def test_a_dash_of_every_call_that_takes_one_is_in_the_gallery(call):
    assert re.search(rf"\bfb\.{call}\(.*dash=", CODE)


@pytest.mark.parametrize("name", sorted(name for name in widgets.__all__ if name[0].isupper() and name != "Widget"))
def test_every_widget_is_in_the_gallery(name):
    assert re.search(rf"\b{name}\([^\n]*\.draw\(fb", CODE)


@pytest.mark.parametrize("page", gallery.PAGES)
def test_the_bytes_of_a_frame_are_what_the_code_costs(page):
    text = page.read_text(encoding="utf-8")
    assert gallery.counted(text) == text, "run docs/make_pictures.py"


def test_the_blocks_of_the_page_on_widgets_run(monkeypatch):
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    blocks = re.findall(r"^```python\n(.*?)^```$", gallery.PAGES[1].read_text(encoding="utf-8"), re.M | re.S)
    for block in (blocks[0], blocks[-1]):
        names = {}
        exec(block, names)
        assert names["fb"].pixels.any()


# -- The demos


@pytest.mark.parametrize(("name", "draw"), demo_page.pictures().items())
def test_the_picture_of_a_demo_is_what_it_draws(name, draw):
    assert make_pictures.is_fresh(name, draw()), "run docs/make_pictures.py"


def test_each_demo_is_shown_once_with_its_code_and_there_are_no_other_pictures():
    page = (DOCS / "examples.md").read_text(encoding="utf-8")
    assert sorted(re.findall(r"\]\((demos/.*?)\)", page)) == sorted(demo_page.pictures())
    assert sorted(demo_page.pictures()) == sorted(f"demos/{file.name}" for file in (DOCS / "demos").iterdir())
    assert re.findall(r"\]\(\.\./paneldraw/demos/(\w+)\.py\)", page) == list(DEMOS)


def test_the_script_of_the_page_of_examples_runs(monkeypatch):
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    (script,) = re.findall(r"^```python\n(.*?)^```$", (DOCS / "examples.md").read_text(encoding="utf-8"), re.M | re.S)
    scope = {}
    exec(script.replace("panel.frames(fps=30)", "range(3)"), scope)
    assert scope["panel"].stats.frames == 3
    assert scope["fb"].pixels.any()


@pytest.mark.parametrize(("name", "tables"), make_pictures.PAGES.items())
def test_the_excerpts_and_tables_are_what_the_code_has(name, tables):
    page = (DOCS / name).read_text(encoding="utf-8")
    assert examples.page(page, tables) == page, "run docs/make_pictures.py"


def test_every_block_and_table_of_the_algorithms_is_made():
    page = examples.PAGE.read_text(encoding="utf-8")
    assert page.count("```python") == len(examples._EXCERPT.findall(page)), "an excerpt follows no link to its function"
    assert page.count("<!-- end -->") == len(examples._TABLE.findall(page)) > 8


# -- The figures


@pytest.mark.parametrize(("name", "draw"), figures.pictures().items())
def test_a_figure_is_what_its_script_draws(name, draw):
    with Image.open(DOCS / name) as file:
        shown = np.asarray(file.convert("RGB"))
    assert np.array_equal(np.asarray(draw()), shown), f"{name} is not what figures.py draws; run docs/make_pictures.py"


def test_each_figure_is_shown_once_with_its_description_and_there_are_no_others():
    shown = re.findall(r"^!\[(.*?)\]\((figures/.*?)\)$", examples.PAGE.read_text(encoding="utf-8"), re.M)
    assert sorted(name for _, name in shown) == sorted(figures.pictures())
    assert sorted(figures.pictures()) == sorted(f"figures/{file.name}" for file in (DOCS / "figures").iterdir())
    assert all(len(description) > 40 for description, _ in shown)


# -- Greys


def test_the_picture_of_greys_is_what_the_eye_sees_and_the_page_runs():
    with Image.open(DOCS / "greys.png") as file:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # no fewer greys than it says
            drawn = np.asarray(greys_seen.sheet())
        assert np.array_equal(drawn, np.asarray(file.convert("RGB")))
    names = {}
    for block in re.findall(r"^```python\n(.*?)^```$", (DOCS / "greys.md").read_text(encoding="utf-8"), re.M | re.S):
        exec(block, names)
    assert (names["panel"].depth, names["fb"].pixels.max()) == (2, 3)


# -- Chips


SYMPTOM_PAGES = "\n".join((DOCS / name).read_text(encoding="utf-8") for name in ("which_panel.md", "trouble.md"))


@pytest.mark.parametrize(("name", "symptom"), symptoms.SYMPTOMS.items())
def test_a_symptom_looks_as_shown_and_its_parameter_mends_it(name, symptom):
    with Image.open(DOCS / f"panels/{name}.png") as file:
        seen = np.asarray(file.convert("RGB"))
    assert np.array_equal(np.asarray(symptoms.draw(symptom).convert("RGB")), seen), "run docs/make_pictures.py"
    mended = symptoms.shown(symptom, mended=True)
    card = Framebuffer(mended.shape[1], mended.shape[0])
    check.card(card)
    assert np.array_equal(mended, card.pixels)
    assert np.array_equal(symptoms.shown(symptom), card.pixels) == (symptom.mend == "")


def test_each_symptom_is_shown_and_there_are_no_other_pictures():
    shown = set(re.findall(r"\]\((panels/.*?)\)", SYMPTOM_PAGES))
    assert shown == set(symptoms.pictures())
    assert shown == {f"panels/{file.name}" for file in (DOCS / "panels").iterdir()}


def test_the_pages_name_every_symptom_of_check():
    for _, cure in check.SYMPTOMS.values():
        parameters = re.findall(r"\w+=", cure)
        assert parameters
        assert all(parameter in SYMPTOM_PAGES for parameter in parameters)


def test_the_table_of_chips_has_them_all():
    page = (DOCS / "chips.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| `(\w+)`", page, re.M) == list(CHIPS)


def test_the_script_of_the_page_on_running_runs(monkeypatch):
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    page = (DOCS / "running.md").read_text(encoding="utf-8")
    scripts = re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    assert len(scripts) == 1
    scope = {}
    exec(scripts[0], scope)
    assert scope["panel"].stats.frames == 6


def test_the_blocks_of_the_page_on_watching_run(monkeypatch, capsys):
    monkeypatch.setenv("PANELDRAW_PANEL", "sim://ssd1306?size=96x16&view=web")
    blocks = re.findall(r"^```python\n(.*?)^```$", screens.PAGE.read_text(encoding="utf-8"), re.M | re.S)
    assert len(blocks) == 3
    names = {}
    for block in blocks:
        exec(block, names)
    assert capsys.readouterr().out.startswith("http://127.0.0.1:")
    assert names["panel"].stats.frames == 1


def test_the_page_on_watching_names_all_that_a_url_can_ask_for():
    page = screens.PAGE.read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `(\w+)=", page, re.M)) == {*urls._WATCHING, "realtime"}
    assert all(f"`{look}`" in page for look in simulator.LOOKS)
    assert all(f"`view={kind}`" in page for kind in urls._VIEWS)
    with Image.open(screens.SCREEN) as picture:
        assert picture.size == screens._SIZE
    assert [file.name for file in screens.SCREEN.parent.iterdir()] == ["page.png"]


@pytest.mark.skipif(
    not (Path("/usr/share/fonts/opentype/terminus").exists() and Path("/usr/share/unifont/unifont.hex").exists()),
    reason="its fonts are not installed",
)
def test_the_blocks_of_the_page_on_fonts_run():
    page = (DOCS / "fonts.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    assert len(blocks) == 6
    names = {}
    for block in blocks:
        exec(block, names)
    assert names["fb"].pixels[48:].any(axis=1).sum() > 8


def test_the_blocks_of_the_page_on_text_run():
    blocks = re.findall(r"^```python\n(.*?)^```$", (DOCS / "text.md").read_text(encoding="utf-8"), re.M | re.S)
    assert len(blocks) == 5
    names = {}
    for block in blocks:
        exec(block, names)
    text = Framebuffer(128, 64)
    text.text("0.42", 30, 0)
    assert np.array_equal(names["fb"].pixels[:7, 30:60], text.pixels[:7, 30:60])


def test_the_blocks_of_the_page_on_adding_a_chip_run():
    page = (DOCS / "add_a_chip.md").read_text(encoding="utf-8")
    excerpts = {found["code"] for found in examples._EXCERPT.finditer(page)}
    blocks = [block for block in re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S) if block not in excerpts]
    assert (len(excerpts), len(blocks)) == (4, 3)
    names = {}
    for block in blocks:
        exec(block, names)
    text = Framebuffer(128, 64)
    text.text("SSD1308", 0, 0)
    assert np.array_equal(names["chip"].pixels, text.pixels)
    assert names["chip"].violations == []


@pytest.fixture
def no_beat_is_late(monkeypatch):
    """A clock for animations that only their own pauses pass, so that a busy machine leaves out no frame."""
    paused = [0.0]

    def pause(seconds):
        paused.append(seconds)
        time.sleep(seconds)  # the simulated panel's frames are timed by the wall

    frames = functools.partial(pacing.Frames, clock=lambda: math.fsum(paused), sleep=pause)
    monkeypatch.setattr("paneldraw.pacing.Frames", frames)


@pytest.mark.usefixtures("no_beat_is_late")
def test_the_page_on_recording_runs_and_prints_what_it_says(monkeypatch, tmp_path, capsys):
    page = (DOCS / "recording.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("PANELDRAW_PANEL", raising=False)
    names = {}
    for block in re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S):
        exec(block, names)
    log, transcript = re.findall(r"^```text\n(.*?)^```$", page, re.M | re.S)
    assert capsys.readouterr().out == transcript
    without_times = [re.sub(r"^[\d.]+ ", "", line) for line in (tmp_path / "panel.log").read_text().splitlines()]
    assert without_times[:3] == [re.sub(r"^[\d.]+ ", "", line) for line in log.splitlines()]
    for name, frames in (("now.png", 1), ("all.gif", 4), ("sheet.png", 1)):
        with Image.open(tmp_path / name) as picture:
            assert getattr(picture, "n_frames", 1) >= frames, name


def test_the_page_on_recording_names_every_look_and_option(capsys):
    page = (DOCS / "recording.md").read_text(encoding="utf-8")
    assert set(re.findall(r"`([\w-]+)`", page)) >= set(LOOKS)
    with Image.open(DOCS / "looks.png") as shown:
        assert np.array_equal(shown.convert("RGB"), make_pictures.looks()), "run docs/make_pictures.py"
    with pytest.raises(SystemExit):
        main(["replay", "--help"])
    offered = set(re.findall(r"--[a-z]+", capsys.readouterr().out))
    assert set(re.findall(r"(?<![\w-])--[a-z]+", page)) <= offered


# -- The plain loops: what the textbook draws is what the drawing calls draw


def lit(fb):
    return {(int(x), int(y)) for y, x in np.argwhere(fb.pixels)}


ENDS = [ends for ends in itertools.product(range(10), repeat=4) if ends[:2] != ends[2:]]


def test_the_plain_bresenham_draws_the_pixels_of_line():
    for ends in ENDS:
        fb = Framebuffer(10, 10)
        fb.line(*ends)
        assert lit(fb) == set(plain.any_direction(plain.bresenham, *ends)), ends


def test_the_plain_dda_draws_the_pixels_of_line_but_for_ties():
    ties = 0
    for ends in ENDS:
        fb = Framebuffer(10, 10)
        fb.line(*ends, algorithm="dda")
        loop = plain.any_direction(plain.dda, *ends)
        dx, dy = sorted((abs(ends[2] - ends[0]), abs(ends[3] - ends[1])), reverse=True)
        halfway = {k for k in range(dx + 1) if 2 * k * dy % (2 * dx) == dx}
        # The loop runs from the left or from the top, and step k is k pixels from there.
        for k, (theirs, ours) in enumerate(zip(loop, sorted(lit(fb), key=_along(ends)), strict=True)):
            assert theirs == ours or (k in halfway and math.dist(theirs, ours) == 1), ends
        ties += len(halfway)
    assert ties > 100


def _along(ends):
    x1, y1, x2, y2 = ends
    return (lambda pixel: pixel[1]) if abs(y2 - y1) > abs(x2 - x1) else (lambda pixel: pixel[0])


def test_the_plain_circle_draws_the_pixels_of_circle():
    for r in range(60):
        fb = Framebuffer(121, 121)
        fb.circle(60, 60, r)
        assert lit(fb) == plain.circle(60, 60, r), r


def _lines(seed, count, columns, rows):
    """Thick lines, with points on a lattice of quarters, so that many pixel centers lie on their edges."""
    rng = random.Random(seed)
    for _ in range(count):
        x1, y1, x2, y2 = (rng.randrange(4 * size) / 4 for size in (columns, rows, columns, rows))
        if (x1, y1) != (x2, y2):
            yield x1, y1, x2, y2, rng.choice([1, 1.5, 2, 3, 5])


def test_the_plain_thick_line_draws_the_pixels_of_line():
    for line in _lines(1, 400, 16, 12):
        fb = Framebuffer(16, 12)
        fb.line(*line[:4], width=line[4], cap="butt", antialias=Supersample(1))
        assert lit(fb) == set(plain.thick_line(line, 16, 12)), line


@pytest.mark.parametrize("n", [2, 3, 4])
def test_the_plain_supersampling_counts_what_line_paints(n):
    for line in _lines(n, 60, 8, 6):
        fb = Framebuffer(8, 6, depth=8)
        fb.line(*line[:4], width=line[4], cap="butt", antialias=Supersample(n))
        shares = [[plain.supersampled(x, y, line, n) for x in range(8)] for y in range(6)]
        assert np.array_equal(fb.pixels, np.floor(255 * np.array(shares) + 0.5)), line


def test_the_plain_cone_has_the_volume_that_line_paints():
    assert plain.cone_filtered(0, 0, (-9, 0, 9, 0, 9)) == pytest.approx(1, abs=1e-4)
    for line in _lines(5, 12, 6, 4):
        fb = Framebuffer(6, 4, depth=8)
        fb.line(*line[:4], width=line[4], cap="butt", antialias=ConeFilter())
        volumes = [[plain.cone_filtered(x, y, line, 32) for x in range(6)] for y in range(4)]
        # The painted level is within 2 of the volume and rounded; so coarse a sum of the volume may be another 1 off.
        assert np.abs(fb.pixels - 255 * np.array(volumes)).max() <= 3.5, line


def test_the_plain_polygon_draws_the_pixels_of_poly():
    rng = random.Random(7)
    for _ in range(400):
        corners = [(rng.randrange(16), rng.randrange(12)) for _ in range(rng.randrange(3, 8))]
        area = sum(x1 * y2 - x2 * y1 for (x1, y1), (x2, y2) in zip(corners, corners[1:] + corners[:1], strict=True))
        if area:
            fb = Framebuffer(16, 12)
            fb.poly(0, 0, corners, fill=True, antialias=Supersample(1))
            assert lit(fb) == set(plain.polygon(corners)), corners


@pytest.mark.parametrize("n", [1, 2, 4, 7])
def test_the_plain_counting_counts_sub_pixels(n):
    rng = random.Random(n)
    for _ in range(200):
        spans = [sorted(rng.randrange(8 * n + 1) for _ in range(2)) for _ in range(n)]
        counts = [sum(g // n == x for a, b in spans for g in range(a, b)) for x in range(8)]
        assert plain.counted(spans, n, 8) == counts


def test_the_plain_loops_run_on_their_own():
    script = [sys.executable, "-S", str(DOCS / "plain_loops.py")]
    out = subprocess.run(script, check=True, capture_output=True, text=True).stdout
    assert out.count("\n") == 7 * 11
    assert out.startswith("DDA\n  ................\n  ..@.............\n  ...@@...........\n")


# -- Programs on simulated panels


SIMULATOR = (DOCS / "simulator.md").read_text(encoding="utf-8")


@pytest.mark.skipif(sys.platform != "linux", reason="programs find simulated buses on Linux alone")
def test_the_page_on_the_simulator_runs_and_prints_what_it_says(tmp_path):
    blocks = re.findall(r"^```(\w+)\n(.*?)^```$", SIMULATOR, re.M | re.S)
    assert Counter(kind for kind, _ in blocks) == {"python": 2, "sh": 5, "text": 5, "toml": 1}
    (tmp_path / "hello.py").write_text(blocks[0][1])
    (tmp_path / "rig.toml").write_text(next(text for kind, text in blocks if kind == "toml"))
    paneldraw = tmp_path / "bin" / "paneldraw"
    paneldraw.parent.mkdir()
    paneldraw.write_text(f'#!/bin/sh\nexec {sys.executable} -m paneldraw "$@"\n')
    paneldraw.chmod(0o755)
    path = f"{paneldraw.parent}:{Path(sys.executable).parent}:{os.environ['PATH']}"
    environment = {name: text for name, text in os.environ.items() if name != "PANELDRAW_PANEL"} | {"PATH": path}
    for (kind, command), (_, printed) in itertools.pairwise(blocks):
        if kind == "sh":
            options = {"cwd": tmp_path, "env": environment, "stderr": subprocess.STDOUT, "text": True, "timeout": 120}
            done = subprocess.run(["bash", "-c", command], stdout=subprocess.PIPE, **options)
            assert without_times(done.stdout) == without_times(printed)
    with Image.open(tmp_path / "hello.png") as picture:
        assert np.asarray(picture.convert("L")).max() > 200
    exec(blocks[-1][1], {})


def without_times(text):
    return re.sub(r"^ +\d+\.\d{6}", "  (seconds)", text, flags=re.M)
