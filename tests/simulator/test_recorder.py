"""Files are read back: every panel pixel has its color, every frame its time."""

from __future__ import annotations

import warnings
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from PIL import Image, ImageColor

from paneldraw import simulator

from .helpers import random_picture, send, started

LOOK = simulator.Look(lit="#ff8800", dark="#001122", glass="#444444")


def frames(*seconds: float) -> list[simulator.Frame]:
    return [simulator.Frame(random_picture(16, 8, index), time, 10 * index, 1) for index, time in enumerate(seconds, 1)]


def levels(picture: Image.Image, scale: int, look: simulator.Look) -> NDArray[np.uint8]:
    """The levels that an image of a panel shows, from the first image pixel of every cell."""
    colors = np.asarray(picture.convert("RGB"))[scale:-scale:scale, scale:-scale:scale]
    lit, dark = ((colors == ImageColor.getrgb(color)).all(axis=2) for color in (look.lit, look.dark))
    assert (lit ^ dark).all()
    return lit.astype(np.uint8)


@given(st.integers(1, 5), st.integers(1, 20), st.integers(1, 20), st.integers(0, 99))
def test_an_image_shows_every_pixel(scale: int, width: int, height: int, seed: int) -> None:
    picture = random_picture(width, height, seed)
    drawn = simulator.image(picture, scale=scale, look=LOOK)
    assert drawn.size == ((width + 2) * scale, (height + 2) * scale)
    assert np.array_equal(levels(drawn, scale, LOOK), picture)


@pytest.mark.parametrize(("scale", "gap", "between"), [(3, None, 0), (4, None, 1), (6, 2, 2), (4, 0, 0)])
def test_the_gap_between_pixels(scale: int, gap: int | None, between: int) -> None:
    look = simulator.Look(lit="#ffffff", dark="#ff0000", glass="#0000ff", gap=gap)
    colors = np.asarray(simulator.image(np.ones((3, 5), np.uint8), scale=scale, look=look).convert("RGB"))
    white = (colors == 255).all(axis=2)
    assert white.sum() == 15 * (scale - between) ** 2
    assert (colors[~white] == (0, 0, 255)).all()


@pytest.mark.parametrize("max_level", [3, 15, 255])
def test_gray_levels_lie_between_dark_and_lit(max_level: int) -> None:
    ramp = np.arange(max_level + 1, dtype=np.uint8)[None, :]
    look = simulator.Look(lit="#ffffff", dark="#000000", glass="#000000", gap=0)
    colors = np.asarray(simulator.image(ramp, scale=1, max_level=max_level, look=look).convert("L"))[1, 1:-1]
    assert np.abs(colors.astype(int) - np.rint(ramp[0] * (255 / max_level))).max() <= 1


def test_a_chip_as_png_is_what_it_shows(tmp_path: Path) -> None:
    chip, picture = started(128, 32), random_picture(128, 32, 1)
    send(chip, picture)
    done: list[tuple[int, int]] = []
    simulator.save(chip, tmp_path / "now.PNG", scale=3, look=LOOK, progress=lambda n, of: done.append((n, of)))
    assert np.array_equal(levels(Image.open(tmp_path / "now.PNG"), 3, LOOK), picture)


def test_one_frame_as_png_is_that_frame(tmp_path: Path) -> None:
    [frame] = frames(1.0)
    simulator.save([frame], str(tmp_path / "one.png"), look=LOOK)
    assert np.array_equal(levels(Image.open(tmp_path / "one.png"), 4, LOOK), frame.pixels)


def animated(path: Path) -> tuple[list[NDArray[np.uint8]], list[int]]:
    pictures, durations = [], []
    with Image.open(path) as animation:
        assert animation.format == {".gif": "GIF", ".apng": "PNG"}[path.suffix]
        assert animation.info["loop"] == 0
        for index in range(animation.n_frames):
            animation.seek(index)
            pictures.append(levels(animation, 4, LOOK))
            durations.append(int(animation.info["duration"]))
    return pictures, durations


@pytest.mark.parametrize(("name", "times"), [("a.gif", [40, 460, 1500, 1000]), ("a.apng", [43, 457, 1500, 1000])])
def test_an_animation_shows_every_frame_for_its_time(tmp_path: Path, name: str, times: list[int]) -> None:
    shown = frames(10.0, 10.043, 10.5, 12.0)
    done: list[tuple[int, int]] = []
    simulator.save(shown, tmp_path / name, look=LOOK, progress=lambda n, of: done.append((n, of)))
    pictures, durations = animated(tmp_path / name)
    assert durations == times
    assert all(np.array_equal(*pair) for pair in zip(pictures, [f.pixels for f in shown], strict=True))
    assert done[:4] == [(1, 4), (2, 4), (3, 4), (4, 4)]


@pytest.mark.parametrize("name", ["burst.gif", "burst.apng"])
def test_a_burst_is_its_last_picture_and_time_does_not_drift(tmp_path: Path, name: str) -> None:
    shown = frames(*(1 + 0.007 * step for step in range(200)))
    simulator.save(shown, tmp_path / name, look=LOOK)
    pictures, durations = animated(tmp_path / name)
    assert min(durations) >= 20
    assert sum(durations) == pytest.approx(1000 * 0.007 * 199 + 1000, abs=30)
    assert np.array_equal(pictures[-1], shown[-1].pixels)


def test_a_gif_of_a_chip_is_all_it_showed(tmp_path: Path) -> None:
    chip = started(96, 16)
    for step in range(3):
        send(chip, random_picture(96, 16, step))
        chip.settle(step / 2, 200)
    simulator.save(chip, tmp_path / "chip.gif", look=LOOK)
    pictures, durations = animated(tmp_path / "chip.gif")
    assert durations == [500, 500, 1000]
    assert np.array_equal(pictures[1], chip.frames[1].pixels)


@pytest.mark.parametrize("name", ["a.gif", "a.apng"])
@given(data=st.data())
def test_any_frames_are_read_back(tmp_path: Path, name: str, data: st.DataObject) -> None:
    """Whatever changes from one to the next: nothing, one pixel at an edge, everything; in every look."""
    picture, shown = np.zeros((8, 16), np.uint8), []
    for number in range(data.draw(st.integers(1, 6))):
        for y, x in data.draw(st.lists(st.tuples(st.integers(0, 7), st.integers(0, 15)), max_size=4)):
            picture[y, x] ^= 1
        shown.append(simulator.Frame(picture.copy(), number / 2, 1))
    look = simulator.LOOKS[data.draw(st.sampled_from(sorted(simulator.LOOKS)))]
    simulator.save(shown, tmp_path / name, scale=3, look=look)
    different = [shown[0], *(b for a, b in pairwise(shown) if not np.array_equal(a.pixels, b.pixels))]
    with Image.open(tmp_path / name) as animation:
        assert getattr(animation, "n_frames", 1) == len(different)
        for number, frame in enumerate(different):
            animation.seek(number)
            assert np.array_equal(
                animation.convert("RGB"), simulator.image(frame.pixels, scale=3, look=look).convert("RGB")
            )


@pytest.mark.parametrize(("name", "parts"), [("a.gif", [655350, 344650, 1000]), ("a.apng", [1000000, 1000])])
def test_a_picture_that_stays_for_long(tmp_path: Path, name: str, parts: list[int]) -> None:
    """Longer than one frame of a GIF can, and longer than an APNG can tell in milliseconds."""
    simulator.save(frames(1.0, 1001.0), tmp_path / name, look=LOOK)
    assert animated(tmp_path / name)[1] == parts


def test_frames_of_several_panels_are_no_animation(tmp_path: Path) -> None:
    mixed = [*frames(1.0), simulator.Frame(random_picture(8, 8, 1), 2.0, 1)]
    with pytest.raises(ValueError, match="of several panels"):
        simulator.save(mixed, tmp_path / "a.gif")
    assert not (tmp_path / "a.gif").exists()


@pytest.mark.parametrize("whole", [True, False])
def test_what_the_history_no_longer_has_is_said(tmp_path: Path, whole: bool) -> None:
    """Of the chip itself and of its frames; not of those that somebody chose among them, nor of a still."""
    chip = started(96, 16, history=3)
    for step in range(8):
        send(chip, random_picture(96, 16, step))
        chip.settle(10 + step / 2, 200)
    with pytest.warns(UserWarning, match=r"a.gif lacks the first 5 frames, 2.5 seconds: the chip keeps the last 3"):
        simulator.save(chip if whole else chip.frames, tmp_path / "a.gif")
    with Image.open(tmp_path / "a.gif") as animation:
        assert getattr(animation, "n_frames", 1) == 3
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        simulator.save(list(chip.frames), tmp_path / "b.gif")
        simulator.save(chip, tmp_path / "c.png")


def test_a_history_can_be_made_longer_and_shorter() -> None:
    chip = started(96, 16, history=2)
    for step in range(7):
        if step == 4:
            assert (chip.history, len(chip.frames), chip.frames.dropped, chip.frames.began) == (2, 2, 2, 0.0)
            chip.history = None
        send(chip, random_picture(96, 16, step))
        chip.settle(float(step), 200)
    assert ([frame.seconds for frame in chip.frames], chip.frames.dropped) == ([2.0, 3.0, 4.0, 5.0, 6.0], 2)
    chip.history = 1
    assert ([frame.seconds for frame in chip.frames], chip.frames.dropped) == ([6.0], 6)


@pytest.mark.parametrize(("name", "look"), [("a.gif", None), ("b.apng", None), ("c.png", None), ("d.gif", "green-led")])
def test_a_chip_is_saved_in_its_own_look(tmp_path: Path, name: str, look: str | None) -> None:
    chip = simulator.MAX7219(8, 8)
    for sent in (b"\x0f\x00", b"\x0b\x07", b"\x0c\x01", b"\x01\xff"):
        chip.transfer(sent, data=False)
        chip.deselect()
        chip.settle(0.5, 2)
    simulator.save(chip, tmp_path / name, look=look)
    with Image.open(tmp_path / name) as file:
        file.seek(getattr(file, "n_frames", 1) - 1)
        assert file.convert("RGB").getpixel((5, 5)) == ImageColor.getrgb(simulator.LOOKS[look or "red-led"].lit)


def test_a_contact_sheet_has_all_frames_in_reading_order(tmp_path: Path) -> None:
    shown = frames(0.1, 0.2, 0.3, 0.4, 0.5)
    done: list[tuple[int, int]] = []
    sheet = simulator.contact_sheet(shown, columns=3, scale=2, look=LOOK, progress=lambda n, of: done.append((n, of)))
    width, height = (16 + 2) * 2 + 8, (8 + 2) * 2 + 20
    assert sheet.size == (3 * width + 8, 2 * height + 8)
    for index, frame in enumerate(shown):
        x, y = 8 + index % 3 * width, 8 + index // 3 * height
        assert np.array_equal(levels(sheet.crop((x, y, x + 36, y + 20)), 2, LOOK), frame.pixels)
    assert done[-1] == (5, 5)
    simulator.save(shown, tmp_path / "sheet.png", look=LOOK)
    assert Image.open(tmp_path / "sheet.png").size != sheet.size


def test_a_long_contact_sheet_takes_frames_at_equal_distances() -> None:
    shown = frames(*np.arange(500) / 10)
    done: list[tuple[int, int]] = []
    sheet = simulator.contact_sheet(shown, columns=1, scale=1, look=LOOK, progress=lambda n, of: done.append((n, of)))
    assert done[-1] == (48, 48)
    for index, taken in ((0, 0), (1, 11), (46, 488), (47, 499)):
        y = 8 + 30 * index
        assert np.array_equal(levels(sheet.crop((8, y, 26, y + 10)), 1, LOOK), shown[taken].pixels)
    sheet = simulator.contact_sheet(shown, scale=1)
    assert 0.5 < sheet.width / sheet.height < 2


@pytest.mark.parametrize("name", ["a.jpg", "a", "gif"])
def test_another_extension_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(ValueError, match=r"ends in none of \.gif, \.apng, \.png"):
        simulator.save(frames(1.0), tmp_path / name)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("name", ["a.gif", "a.apng", "a.png"])
def test_nothing_shown_is_nothing_saved(tmp_path: Path, name: str) -> None:
    with pytest.raises(ValueError, match="nothing was shown"):
        simulator.save([], tmp_path / name)


def test_impossible_sizes_are_refused() -> None:
    picture = random_picture(8, 8, 1)
    for scale, gap in ((0, None), (3, 3), (3, -1)):
        with pytest.raises(ValueError, match="scale"):
            simulator.image(picture, scale=scale, look=simulator.Look(gap=gap))
    with pytest.raises(ValueError, match="columns"):
        simulator.contact_sheet(frames(1.0), columns=0)


def test_a_file_that_cannot_be_written_is_an_os_error(tmp_path: Path) -> None:
    with pytest.raises(OSError, match="missing"):
        simulator.save(frames(1.0), tmp_path / "missing" / "a.gif")
