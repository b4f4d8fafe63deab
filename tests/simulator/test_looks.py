"""Every look's colors, its split glass and its round pixels, wherever a panel is drawn."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageColor

from paneldraw import Framebuffer, controllers, simulator
from paneldraw.simulator import LOOKS, Look, find_look

from .helpers import random_picture


def rgb(color: str) -> tuple[int, ...]:
    return ImageColor.getrgb(color)[:3]


def centers(picture: Image.Image, scale: int) -> Any:
    """The color in the middle of every pixel of a panel's image, less the margin."""
    at = scale + (scale - 1) // 2
    return np.asarray(picture.convert("RGB"))[at:-scale:scale, at:-scale:scale]


def test_the_looks_have_their_names() -> None:
    assert list(LOOKS) == ["white", "blue", "yellow-blue", "green-led", "red-led", "lcd-green", "lcd-gray"]
    assert len(set(LOOKS.values())) == 7
    assert find_look(None) is LOOKS["white"]
    assert find_look(LOOKS["blue"]) is find_look("blue")


@pytest.mark.parametrize(
    ("wrong", "hint"), [("bleu", "; did you mean blue?"), ("yellow-blu", "; did you mean"), ("", "")]
)
def test_a_wrong_name_says_which_there_are(wrong: str, hint: str) -> None:
    with pytest.raises(ValueError, match=rf"look: {wrong!r} is none of white, blue, .*, lcd-gray{re.escape(hint)}"):
        find_look(wrong)
    with pytest.raises(ValueError, match="'bleu' is none of"):
        simulator.SSD1306().render(look="bleu")


@pytest.mark.parametrize("name", LOOKS)
@pytest.mark.parametrize("max_level", [1, 15, 255])
def test_pixels_have_their_colors(name: str, max_level: int) -> None:
    look = LOOKS[name]
    picture = np.random.default_rng(1).integers(0, max_level + 1, (64, 32), np.uint8)
    picture[0, :2] = picture[40, :2] = 0, max_level
    colors = look.colors(picture, max_level)
    assert colors.shape == (64, 32, 3)
    assert tuple(colors[0, 0]) == tuple(colors[40, 0]) == rgb(look.dark)
    assert tuple(colors[0, 1]) == rgb(look.top_lit or look.lit)
    assert tuple(colors[40, 1]) == rgb(look.lit)
    drawn = centers(simulator.image(picture, scale=5, max_level=max_level, look=name), 5)
    steps = 1 if max_level < 255 else 4  # a palette has 256 colors
    assert np.abs(drawn.astype(int) - colors).max() <= steps


def test_split_glass_is_yellow_in_its_first_16_rows() -> None:
    colors = LOOKS["yellow-blue"].colors(np.ones((64, 128), np.uint8))
    yellow = (colors == rgb("#ffd83a")).all(axis=2)
    assert yellow[:16].all()
    assert not yellow[16:].any()


def test_leds_are_round() -> None:
    """A disc with soft edges on dark glass, the same for every LED, and symmetric."""
    look = LOOKS["red-led"]
    picture = simulator.image(np.ones((2, 2), np.uint8), scale=12, look=look)
    cells = np.asarray(picture.convert("RGB"))[12:-12, 12:-12].reshape(2, 12, 2, 12, 3).swapaxes(1, 2)
    cell = cells[0, 0].astype(int)
    assert (cells == cell).all()
    disc = cell[:9, :9]
    assert (disc == disc[::-1]).all()
    assert (disc == disc.swapaxes(0, 1)).all()
    assert tuple(disc[4, 4]) == rgb(look.lit)
    assert tuple(disc[0, 0]) == tuple(cell[11, 11]) == rgb(look.glass)
    shades = {tuple(color) for color in disc.reshape(-1, 3)}
    assert 3 <= len(shades) <= 6
    share = (disc[:, :, 0] - rgb(look.glass)[0]).sum() / (rgb(look.lit)[0] - rgb(look.glass)[0]) / 81
    assert share == pytest.approx(np.pi / 4, abs=0.03)


@given(st.integers(1, 12), st.sampled_from(sorted(LOOKS)))
def test_every_scale_has_its_size(scale: int, name: str) -> None:
    assert simulator.image(random_picture(7, 20, 1), scale=scale, look=name).size == (9 * scale, 22 * scale)


def test_booleans_and_levels_that_are_too_high_are_drawn() -> None:
    picture = random_picture(16, 8, 1)
    drawn = [simulator.image(levels, look="blue").tobytes() for levels in (picture, picture.astype(bool), picture * 9)]
    assert drawn[0] == drawn[1] == drawn[2]


@pytest.mark.parametrize("name", sorted(controllers.CHIPS))
def test_a_chip_looks_as_its_modules_do(name: str) -> None:
    chip = getattr(simulator, name.upper())()
    leds, lcds = ("max7219", "ht16k33", "is31fl3731"), ("pcd8544", "st7565", "st7567", "uc1701", "uc1609", "st7920")
    kind = "red-led" if name in leds else ("lcd-green", "lcd-gray") if name in lcds else "white"
    assert chip.look in kind
    assert chip.look in LOOKS
    drawn, blue = chip.render(), chip.render(3, "blue")
    assert tuple(centers(drawn, 4)[0, 0]) == rgb(LOOKS[chip.look].dark)
    assert drawn.size == (4 * (chip.width + 2), 4 * (chip.height + 2))
    assert tuple(centers(blue, 3)[0, 0]) == rgb(LOOKS["blue"].dark)


@pytest.mark.parametrize("depth", [1, 4])
def test_a_framebuffer_is_saved_as_it_looks(tmp_path: Path, depth: int) -> None:
    fb = Framebuffer(32, 20, depth=depth)
    fb.circle(10, 10, 8, fill=True)
    fb.save(tmp_path / "a.png", scale=4, look="yellow-blue")
    with Image.open(tmp_path / "a.png") as file:
        assert np.array_equal(centers(file, 4), LOOKS["yellow-blue"].colors(fb.pixels, fb.max_level))
    fb.save(tmp_path / "b.png", look=Look(lit="#ff0000", dark="#0000ff"))
    with Image.open(tmp_path / "b.png") as file:
        assert np.asarray(file.convert("RGB"))[11, 11].tolist() == [255, 0, 0]
    with pytest.raises(ValueError, match="did you mean white"):
        fb.save(tmp_path / "c.png", look="whit")
    assert not (tmp_path / "c.png").exists()
