"""Comparing framebuffers with pictures: text in the test itself, or a PNG file in this folder."""

from __future__ import annotations

import inspect
from itertools import zip_longest
from pathlib import Path

import numpy as np
from PIL import Image

FOLDER = Path(__file__).parent


def assert_pattern(fb, pattern):
    """Demand that `fb` looks like `pattern`, a text in the alphabet of ``str(fb)``; its indentation does not count."""
    __tracebackhide__ = True
    drawn, wanted = str(fb), inspect.cleandoc(pattern)
    assert drawn == wanted, "the picture differs\n" + side_by_side(wanted, drawn)


def side_by_side(wanted, drawn):
    """Two pictures as text, and a third that marks with ^ where they differ."""
    rows = [("wanted", "drawn", "differs")]
    for left, right in zip_longest(wanted.split("\n"), drawn.split("\n"), fillvalue=""):
        marks = ("^" if a != b else "." for a, b in zip_longest(left, right))
        rows.append((left, right, "".join(marks)))
    width = max(len(part) for row in rows for part in row) + 3
    return "\n".join("".join(part.ljust(width) for part in row).rstrip() for row in rows)


def assert_golden(fb, name, scratch, update=False):
    """Demand that the levels of `fb` are those of the gray PNG file `name`; else leave what was drawn in `scratch`."""
    __tracebackhide__ = True
    path = FOLDER / name
    grays = fb.pixels * np.uint8(255 // fb.max_level)
    if update:
        Image.fromarray(grays).save(path, optimize=True)
        return
    assert path.exists(), f"there is no {path}: look at the picture and run pytest --update-golden"
    with Image.open(path) as file:
        wanted = np.asarray(file.convert("L"))
    assert wanted.shape == grays.shape
    differ = np.argwhere(wanted != grays)
    if len(differ):
        Image.fromarray(grays).save(scratch / name)
        y, x = differ[0]
        raise AssertionError(
            f"{len(differ)} pixels differ from {path}, the first at ({x}, {y}); what was drawn is in {scratch / name}"
        )
