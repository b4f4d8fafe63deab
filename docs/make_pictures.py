"""Draws the pictures of the README and of all pages, and refreshes what the pages have from the code.

``python docs/make_pictures.py``
"""

from __future__ import annotations

import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import chip_tables
import examples
import figures
import gallery
import greys_seen
import numpy as np
import screens
import specimens
import steps
import symptoms
import worked_examples
from PIL import Image, ImageSequence

from paneldraw import Framebuffer, Supersample, simulator

HERE = Path(__file__).parent
README = HERE.parent / "README.md"


def blocks(language: str, section: str = "") -> list[str]:
    """The README's fenced blocks of a language, of one section or of all."""
    text = README.read_text(encoding="utf-8")
    if section:
        text = re.split(r"^## ", text.partition(f"\n## {section}\n")[2], maxsplit=1, flags=re.M)[0]
    return re.findall(rf"^```{language}\n(.*?)^```$", text, re.M | re.S)


def hello() -> Image.Image:
    """What the README's script, run as it is printed, brings onto the simulated panel."""
    return simulator.image(glass_of(blocks("python")[0]), scale=4)


def glass_of(script: str) -> Any:
    """Run a script in an interpreter and a folder of its own; return the pixels of its simulated panel."""
    look = "import runpy; panel = runpy.run_path('script.py')['panel']; "
    look += "import numpy; numpy.save('glass', panel.simulated.pixels)"
    environment = {name: value for name, value in os.environ.items() if name != "PANELDRAW_PANEL"}
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "script.py").write_text(script, encoding="utf-8")
        subprocess.run([sys.executable, "-c", look], cwd=folder, env=environment, check=True)
        return np.load(Path(folder, "glass.npy"))


def looks() -> Image.Image:
    """One picture in all looks, their names within."""
    tiles = []
    for name in simulator.LOOKS:
        fb = Framebuffer(88, 40, depth=4)
        fb.text(name.replace("-", " "), 43, 3, anchor="mt")
        fb.circle(22, 26, 10, antialias=Supersample(4))
        fb.lines([(40 + 5 * k, 16, 48 + 4 * k, 36) for k in range(8)], antialias=Supersample(4))
        tiles.append(simulator.image(fb.pixels, scale=4, max_level=15, look=name))
    width, height = tiles[0].width + 8, tiles[0].height + 8
    sheet = Image.new("RGB", (2 * width - 8, -(-len(tiles) // 2) * height - 8), "white")
    for number, tile in enumerate(tiles):
        sheet.paste(tile, (number % 2 * width, number // 2 * height))
    return sheet


Drawn = Image.Image | list[Image.Image]
"""A picture, or those of an animation of ten a second."""

PICTURES: dict[str, Callable[[], Drawn]] = {
    "panel.gif": partial(examples.draw, "scene", frames=60, scale=4),
    "hello.png": hello,
    "looks.png": looks,
    **gallery.pictures(),
    **examples.pictures(),
    **figures.pictures(),
    **symptoms.pictures(),
    **specimens.pictures(),
    **greys_seen.PICTURES,
    **steps.pictures(),
}

#: Pages with excerpts or tables, and what makes the tables.
PAGES: dict[str, Mapping[str, Any]] = {
    "algorithms.md": vars(worked_examples),
    "chips.md": vars(chip_tables),
    "add_a_chip.md": {},
    "watching.md": vars(screens),
    "examples.md": vars(examples),
}


def save(drawn: Drawn, path: Path) -> None:
    """Write a picture, or an animation, as a file."""
    first, *others = drawn if isinstance(drawn, list) else [drawn]
    moving = {"save_all": True, "append_images": others, "duration": 100, "loop": 0} if path.suffix == ".gif" else {}
    path.parent.mkdir(exist_ok=True)
    first.save(path, optimize=True, **moving)


def is_fresh(name: str, drawn: Drawn) -> bool:
    """Whether a file shows what is drawn; of an animation each picture that differs from the one before."""
    frames = [np.asarray(frame.convert("RGB")) for frame in (drawn if isinstance(drawn, list) else [drawn])]
    wanted = [
        frame for before, frame in zip([None, *frames], frames, strict=False) if not np.array_equal(before, frame)
    ]
    with Image.open(HERE / name) as file:
        shown = [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(file)]
    return len(shown) == len(wanted) and all(map(np.array_equal, shown, wanted))


def main() -> None:
    """Write every picture beside this script, and the pages with excerpts and tables anew."""
    for name, draw in PICTURES.items():
        save(draw(), HERE / name)
    for name, tables in PAGES.items():
        page = HERE / name
        page.write_text(worked_examples.page(page.read_text(encoding="utf-8"), tables), encoding="utf-8")
    for name in steps.PAGES:
        (HERE / name).write_text(steps.printed(name), encoding="utf-8")
    for page in gallery.PAGES:
        page.write_text(gallery.counted(page.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
