"""The pages under docs/: every picture is what the code beside it draws, every excerpt and number what the code has."""

from __future__ import annotations

import re
from pathlib import Path

import gallery
import numpy as np
import pytest
import worked_examples as examples
from PIL import Image

from paneldraw import Framebuffer
from paneldraw.raster.strokes import CAPS, JOINS
from paneldraw.raster.surface import OPS

DOCS = Path(__file__).parent.parent / "docs"
NOT_DRAWING = {"antialias", "depth", "height", "max_level", "pixels", "save", "to_image", "width"}


ENTRIES = list(gallery.entries())
CODE = "\n".join(code for _, _, code in ENTRIES)


@pytest.mark.usefixtures("package")
def test_the_gallery_shows_what_its_code_draws():
    for name, caption, code in ENTRIES:
        drawn = gallery.draw(code, caption).convert("RGB")
        with Image.open(DOCS / name) as file:
            shown = file.convert("RGB")
        assert drawn.size == shown.size, name
        assert np.array_equal(drawn, shown), f"{name} is not what its code draws; run docs/make_pictures.py"


def test_each_picture_is_shown_once_and_there_are_no_others():
    names = [name for name, _, _ in ENTRIES]
    assert sorted(names) == sorted(f"pictures/{file.name}" for file in (DOCS / "pictures").iterdir())


def test_the_pictures_of_the_gallery_differ():
    pictures = {}
    for name, _, code in ENTRIES:
        fb = gallery.run(code)
        pictures.setdefault((fb.depth, fb.pixels.tobytes()), []).append(name)
    assert [names for names in pictures.values() if len(names) > 1] == []


@pytest.mark.parametrize("call", sorted(name for name in dir(Framebuffer) if not name.startswith("_")))
def test_every_drawing_call_is_in_the_gallery(call):
    assert call in NOT_DRAWING or re.search(rf"\bfb\.{call}\(", CODE)


WORDS = "even-odd nonzero dda bayer floyd-steinberg corner box gaussian radius closed dash key palette"


@pytest.mark.parametrize("word", [*OPS, *CAPS, *JOINS, *WORDS.split()])
def test_every_option_is_in_the_gallery(word):
    assert f'"{word}"' in CODE or f"{word}=" in CODE


@pytest.mark.parametrize("page", ["gallery.md", "algorithms.md"])
def test_links_lead_somewhere(page):
    text = (DOCS / page).read_text(encoding="utf-8")
    titles = re.findall(r"^#+ (.*)$", text, re.M)
    anchors = {re.sub(r"[^\w -]", "", title).lower().replace(" ", "-") for title in titles}
    prose = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    for link in re.findall(r"\]\((.*?)\)", prose):
        assert link[1:] in anchors if link.startswith("#") else (DOCS / link).exists(), link


def test_the_excerpts_and_tables_are_what_the_code_has():
    page = examples.PAGE.read_text(encoding="utf-8")
    assert examples.page(page) == page, "run docs/make_pictures.py"
    assert page.count("```python") == len(examples._EXCERPT.findall(page)), "an excerpt follows no link to its function"
    assert page.count("<!-- end -->") == len(examples._TABLE.findall(page)) > 8
