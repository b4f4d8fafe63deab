"""Pictures that move: composed as Pillow does, each frame at its own pace, again and again."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageSequence

from paneldraw import Animation, open_panel
from paneldraw.animation import play
from paneldraw.cli import main

DURATIONS = [40, 200, 60, 100]


def drawn(number, mode="L"):
    image = Image.new("L", (128, 64), 0)
    ImageDraw.Draw(image).rectangle((10 * number, 5, 10 * number + 30, 40), 255)
    return image.convert(mode)


@pytest.fixture
def gif(tmp_path):
    def save(name="film.gif", **options):
        frames = [drawn(number) for number in range(4)]
        options = {"duration": DURATIONS, "loop": 0} | options
        frames[0].save(tmp_path / name, save_all=True, append_images=frames[1:], **options)
        return tmp_path / name

    return save


class Time:
    """A clock that only pauses move, and what it showed at each of them."""

    def __init__(self, slow=0.0):
        self.now = 0.0
        self.slow = slow

    def clock(self):
        return self.now

    def sleep(self, seconds):
        assert seconds >= 0
        self.now += seconds


def played(source, loops=None, slow=0.0, **options):
    """Times and pictures of the frames shown, and the time at the end."""
    time, shown = Time(), []
    panel = open_panel("sim://ssd1306?size=128x64")
    options = {"fit": "contain", "dither": None} | options

    def note(report):
        shown.append((round(time.now, 3), panel.simulated.pixels.copy()))
        time.now += slow

    count = play(panel, source, loops, options, note, clock=time.clock, sleep=time.sleep)
    assert count == len(shown)
    panel.close()
    return [at for at, _ in shown], [pixels for _, pixels in shown], round(time.now, 3)


def test_each_frame_has_its_own_pace(gif):
    times, pictures, end = played(gif(), loops=2)
    starts = [sum(DURATIONS[:number]) / 1000 for number in range(4)]
    assert times == [round(start + turn * 0.4, 3) for turn in range(2) for start in starts]
    assert end == 0.8
    for number, pixels in enumerate(pictures):
        assert (pixels * 255 == np.asarray(drawn(number % 4))).all()


@pytest.mark.parametrize(("told", "times"), [({"loop": 2}, 3), ({"loop": None}, 1)])
def test_a_gif_is_played_as_often_as_it_says(gif, told, times):
    path = gif(**told) if told["loop"] is not None else gif(loop=None)
    animation = Animation(path)
    assert animation.loops == times
    assert len(played(animation)[0]) == 4 * times


def test_for_ever(gif):
    panel = open_panel("sim://ssd1306?size=128x64")
    stop = itertools.count()

    def note(report):
        if next(stop) == 10:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        play(
            panel, gif(), None, {"fit": "contain", "dither": None}, note, clock=lambda: 0.0, sleep=lambda seconds: None
        )
    assert panel.stats.frames == 11
    panel.close()


def test_frames_whose_time_is_over_are_left_out(gif):
    """A panel that takes 0.15 s a picture shows the second one, which is long, and then what is due."""
    times, pictures, _ = played(gif(), loops=1, slow=0.15)
    assert times == [0.0, 0.15, 0.3]
    assert [int(np.argwhere(pixels)[0, 1]) // 10 for pixels in pictures] == [0, 1, 3]


def test_the_last_frame_of_all_is_shown_however_late(gif):
    times, pictures, _ = played(gif(), loops=2, slow=5.0)
    assert times == [0.0, 5.0]
    assert (pictures[-1] * 255 == np.asarray(drawn(3))).all()


def test_something_is_seen_where_reading_alone_takes_too_long(gif, monkeypatch):
    monkeypatch.setattr("paneldraw.animation.MOST_SKIPPED", 2)
    times, pictures, _ = played(gif(), loops=3, slow=100.0)
    assert [int(np.argwhere(pixels)[0, 1]) // 10 for pixels in pictures] == [0, 3, 2, 1, 3]
    assert times == [0.0, 100.0, 200.0, 300.0, 400.0]


@pytest.mark.parametrize("name", ["film.gif", "film.png", "film.webp"])
@pytest.mark.parametrize("loop", [0, 3])
def test_kinds_of_files(gif, name, loop):
    animation = Animation(gif(name, loop=loop, **({"lossless": True} if name.endswith("webp") else {})))
    assert [round(seconds, 3) for _, seconds in animation] == [0.04, 0.2, 0.06, 0.1]
    assert (len(animation), round(animation.seconds, 3), animation.size) == (4, 0.4, (128, 64))
    assert animation.loops == (loop and loop + name.endswith("gif"))
    for number, (image, _) in enumerate(animation):
        assert (np.asarray(image.convert("L")) == np.asarray(drawn(number))).all()


@pytest.mark.parametrize("disposal", [0, 1, 2, 3])
def test_frames_are_composed_as_pillow_does(disposal, tmp_path):
    """Frames that hold a part, over what the one before left there, partly transparent."""
    random = np.random.default_rng(disposal)
    frames = []
    for _ in range(5):
        frame = Image.new("RGBA", (40, 30), (0, 0, 0, 0))
        x, y = (int(k) for k in random.integers(0, 20, 2))
        ImageDraw.Draw(frame).rectangle((x, y, x + 12, y + 8), (int(random.integers(50, 256)),) * 3 + (255,))
        frames.append(frame)
    path = tmp_path / "a.gif"
    frames[0].save(path, save_all=True, append_images=frames[1:], duration=50, disposal=disposal, optimize=False)
    with Image.open(path) as file:
        wanted = [frame.convert("RGBA") for frame in ImageSequence.Iterator(file)]
    found = [image for image, _ in Animation(path)]
    assert len(found) == len(wanted)
    assert all(np.array_equal(one, other) for one, other in zip(found, wanted, strict=True))


@pytest.mark.parametrize("at", [0, 0.039, 0.04, 0.2, 0.239, 0.24, 0.3, 0.399, 0.4, 1.23, -0.01])
def test_the_frame_of_a_moment(gif, at):
    animation = Animation(gif())
    ends = np.cumsum(DURATIONS) / 1000
    number = int(np.searchsorted(ends, at % ends[-1], "right"))
    assert (np.asarray(animation.at(at).convert("L")) == np.asarray(drawn(number))).all()


def test_a_frame_without_a_duration(gif):
    assert [seconds for _, seconds in Animation(gif(duration=0))] == [0.1] * 4


def test_a_picture_that_does_not_move(tmp_path):
    drawn(0).save(tmp_path / "a.png")
    for source in (tmp_path / "a.png", Image.open(tmp_path / "a.png"), drawn(0)):
        assert len(Animation(source)) == 1
        assert played(source, loops=0)[0] == [0.0]


def test_frames_are_numbered(gif):
    animation = Animation(gif())
    assert animation.frame(3)[1] == 0.1
    assert animation.frame(0)[1] == 0.04
    for bad in (4, 100, -1):
        with pytest.raises(IndexError):
            animation.frame(bad)


def test_a_file_that_is_cut_off(gif):
    path = gif()
    data = path.read_bytes()
    for end in range(20, len(data), 37):
        path.write_bytes(data[:end])
        try:
            frames = list(Animation(path))
        except OSError:
            continue
        assert 1 <= len(frames) <= 4


@pytest.mark.parametrize("bad", [-1, 1.5, "2"])
def test_loops_are_counted(gif, bad):
    panel = open_panel("sim://ssd1306?size=128x64")
    with pytest.raises((TypeError, ValueError)):
        panel.play(gif(), loops=bad)
    panel.close()


def test_a_panel_plays(gif):
    panel = open_panel("sim://ssd1306?size=128x64")
    assert panel.play(gif(duration=5), loops=1, dither=None) >= 2
    assert (panel.simulated.pixels * 255 == np.asarray(drawn(3))).all()
    panel.close()


def test_the_command_plays(gif, capsys):
    assert main(["show", str(gif()), "--panel", "sim://ssd1306?size=128x64"]) == 0
    shown = capsys.readouterr().out
    assert "bytes on the wire" in shown
    assert shown.count("█") > 200


def test_the_command_says_what_is_wrong(gif, capsys):
    path = gif()
    path.write_bytes(path.read_bytes()[:300])
    assert main(["show", str(path), "--panel", "sim://ssd1306?size=128x64"]) == 1
    assert capsys.readouterr().err.startswith(f"paneldraw: cannot read {path}: ")


@pytest.mark.parametrize("bad", [None, 5, [], b"GIF89a"])
def test_other_things_are_no_animations(bad):
    with pytest.raises(TypeError, match=r"^source must be a path, a file or a Pillow image, not "):
        Animation(bad)
