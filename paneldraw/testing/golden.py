"""Golden pictures: what a panel shall show, as files beside the tests."""

from __future__ import annotations

import os
import re
import shlex
import tempfile
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any, Final, NoReturn

import numpy as np
import pytest

from paneldraw.testing import running
from paneldraw.testing.seeing import Levels, difference, levels_of

if TYPE_CHECKING:
    from PIL.Image import Image

_ACROSS: Final = 512
"""Columns that a picture may have in a picture of a failure, three side by side."""


_UPDATED: Final = pytest.StashKey[dict[Path, Levels]]()
"""The golden pictures of this session, as it updates them."""


class _Picture:
    """Levels as `levels_of` takes them."""

    def __init__(self, pixels: Levels, max_level: int) -> None:
        self.pixels, self.max_level = pixels, max_level


def assert_frame(source: Any, name: str) -> None:
    """Demand that a picture is, pixel by pixel, the golden picture of a file.

    Golden pictures are gray PNG files, a pixel a pixel: black is level 0 and white the highest. They are in the folder
    ``golden`` beside the test's file, or in that which the setting ``paneldraw_golden`` of pytest names.
    ``pytest --update-frames`` writes them.

    Parameters
    ----------
    source : Framebuffer, panel, chip, frame, bus or program
        What has the picture; of a panel, what is on its simulated glass.
    name : str
        The file in that folder, such as ``"hello.png"`` or ``"menu/first.png"``.

    Raises
    ------
    AssertionError
        The file is missing, damaged, of another size or another picture. The message says where pictures of what is
        there, of what was expected and of what differs are, and how to write the file.
    ValueError
        A name that is none of a PNG file in the folder.
    RuntimeError
        No test runs, as pytest does it, or its plugin is switched off.
    """
    __tracebackhide__ = True
    path, test = _place(name), _test()
    levels, max_level = levels_of(source)
    if test.config.getoption("--update-frames"):
        _update(test, path, levels, max_level)
        return
    golden, shown = _read(path, max_level), ("shown", levels, max_level)
    if isinstance(golden, str):
        _fail(test, name, golden, [shown])
    pictures = [("expected", golden, max_level), shown]
    if golden.shape != levels.shape:
        sizes = [f"{each.shape[1]}x{each.shape[0]}" for each in (golden, levels)]
        _fail(test, name, f"{path} has {sizes[0]} pixels, and {sizes[1]} were shown", pictures)
    if not np.array_equal(golden, levels):
        differs = difference(_Picture(golden, max_level), _Picture(levels, max_level), ("expected", "shown"))
        _fail(test, name, f"what was shown is not {path}\n{differs}", pictures)


def _fail(test: pytest.Item, name: str, reason: str, pictures: list[tuple[str, Levels, int]]) -> NoReturn:
    __tracebackhide__ = True
    advice = f"if what was shown is right: pytest --update-frames {shlex.quote(test.nodeid)}"
    raise AssertionError("\n".join((reason, _keep(test, name, pictures), advice)))


def _test() -> pytest.Item:
    if not running.tests:
        raise RuntimeError("assert_frame must be called in a test that pytest runs, with the plugin of paneldraw")
    return running.tests[-1]


def _place(name: str) -> Path:
    """The file of a golden picture."""
    parts = PurePosixPath(name).parts
    if not name.endswith(".png") or len(name) < 5 or ".." in parts or os.path.isabs(name):
        raise ValueError(f"name must be that of a .png file in the folder of golden pictures, not {name!r}")
    test = _test()
    folder = test.config.getini("paneldraw_golden")
    return (test.config.rootpath / folder if folder else test.path.parent / "golden").joinpath(*parts)


def _grays(levels: Levels, max_level: int) -> Levels:
    return levels * np.uint8(255 // max_level)


def _read(path: Path, max_level: int) -> Levels | str:
    """Read the levels of a golden picture; return why not where there are none."""
    from PIL import Image

    try:
        with Image.open(path) as file:
            grays, mode = np.asarray(file.convert("L")), file.mode
    except FileNotFoundError:
        return f"there is no golden picture {path}"
    except Exception as error:  # Pillow raises much
        if isinstance(error, OSError) and error.errno is not None:
            return f"the golden picture {path} cannot be read: {error.strerror}"
        return f"the golden picture {path} is damaged: {error}"
    if mode not in ("L", "1"):
        return f"{path} is no golden picture, which is gray, a pixel a pixel: its mode is {mode}"
    step = 255 // max_level
    if (grays % step).any():
        return f"{path} is a golden picture of a panel with more grays than the {max_level + 1} of this"
    return grays // np.uint8(step)


def _update(test: pytest.Item, path: Path, levels: Levels, max_level: int) -> None:
    """Write a golden picture, unless it is there."""
    __tracebackhide__ = True
    from PIL import Image

    before = test.config.stash.setdefault(_UPDATED, {}).setdefault(path, levels.copy())
    if not np.array_equal(before, levels):
        raise AssertionError(f"two pictures cannot both be {path}: give them names of their own")
    there = _read(path, max_level)
    if not isinstance(there, str) and np.array_equal(there, levels):
        return
    if (reason := _save(Image.fromarray(_grays(levels, max_level)), path)) is not None:
        raise AssertionError(f"the golden picture {path} cannot be written: {reason}")
    test.user_properties.append((running.WRITTEN, str(path)))


def _save(picture: Image, path: Path) -> str | None:
    """Write a picture; whoever reads it meanwhile finds the one before. Return why not where it cannot be written."""
    draft = path.with_name(f".{path.name}.{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        try:
            picture.save(draft, "PNG", optimize=True)
            os.replace(draft, path)
        finally:
            draft.unlink(missing_ok=True)
    except OSError as error:
        return error.strerror or str(error)
    return None


# -- pictures of failures


def _keep(test: pytest.Item, name: str, pictures: list[tuple[str, Levels, int]]) -> str:
    """Write pictures side by side, and what differs in them, where the report is; say where, or why not."""
    unique = re.sub(r"[^\w.=-]+", "-", f"{test.nodeid}-{name}").strip("-")
    path = _failures(test) / (unique if len(unique) <= 120 else unique[-120:].lstrip("-."))
    reason = _save(_beside(pictures), path)
    return f"see {path}" if reason is None else f"no picture of it can be written to {path}: {reason}"


def _failures(test: pytest.Item) -> Path:
    """The folder for pictures of failures."""
    config = test.config
    if folder := config.getini("paneldraw_failures"):
        return config.rootpath / str(folder)
    for report in ("xmlpath", "htmlpath"):  # pytest's own, and that of pytest-html
        if path := config.getoption(report, None):
            return Path(os.path.abspath(path)).parent / "frames"
    factory = getattr(config, "_tmp_path_factory", None)
    return Path(factory.getbasetemp() if factory else tempfile.gettempdir()) / "frames"


def _beside(pictures: list[tuple[str, Levels, int]]) -> Image:
    from PIL import Image, ImageDraw

    from paneldraw.simulator import image

    scale = max(1, min(8, _ACROSS // max(levels.shape[1] for _, levels, _ in pictures)))
    tiles = [(name, image(levels, scale=scale, max_level=highest)) for name, levels, highest in pictures]
    if len(pictures) == 2 and pictures[0][1].shape == pictures[1][1].shape:
        tiles.append(("difference", _difference(pictures[0][1], pictures[1][1], scale)))
    width, height = (max(tile.size[axis] for _, tile in tiles) for axis in (0, 1))
    sheet = Image.new("RGB", (len(tiles) * (width + 8) + 8, height + 28), "#30343a")
    draw = ImageDraw.Draw(sheet)
    for index, (name, tile) in enumerate(tiles):
        x = 8 + index * (width + 8)
        draw.text((x, 6), name, fill="#c8ccd0")
        sheet.paste(tile, (x, 20))
    return sheet


def _difference(expected: Levels, shown: Levels, scale: int) -> Image:
    """What is the same, dimly; what is too dark in red, and what is too bright in blue."""
    from PIL import Image

    colors = np.where(expected[..., None] > 0, (88, 96, 105), (16, 22, 29)).astype(np.uint8)
    colors[shown < expected] = 255, 64, 64
    colors[shown > expected] = 63, 167, 255
    framed = np.pad(colors, ((1, 1), (1, 1), (0, 0)))
    return Image.fromarray(framed.repeat(scale, axis=0).repeat(scale, axis=1))
