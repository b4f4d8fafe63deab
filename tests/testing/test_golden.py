"""Golden pictures: what passes, what fails and how that looks, and what is written where and when."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from paneldraw import Framebuffer
from paneldraw.testing import assert_frame, golden

TEST = """
from paneldraw import Framebuffer
from paneldraw.testing import assert_frame

def test_a_line():
    fb = Framebuffer({width}, {height}, depth={depth})
    fb.line(0, 0, 7, {end})
    assert_frame(fb, "{name}")
"""


@pytest.fixture
def session(pytester):
    """Run a session with one test, which draws a line: ``session("--update-frames", end=5)``."""

    def run(*arguments, width=16, height=8, depth=1, end=7, name="line.png"):
        pytester.makepyfile(TEST.format(width=width, height=height, depth=depth, end=end, name=name))
        return pytester.runpytest_inprocess("-p", "no:cacheprovider", *arguments)

    return run


@pytest.fixture
def line(pytester):
    """The golden picture of the line."""
    return pytester.path / "golden" / "line.png"


def said(result):
    """What the failure said, line by line."""
    return [text[8:] for text in result.stdout.lines if text.startswith("E ")]


def kept(result):
    """The picture of the failure."""
    found = re.search(r"^see (\S+\.png)$", "\n".join(said(result)), re.M)
    assert found, result.stdout.str()
    return Image.open(found[1])


def test_a_missing_picture_fails_and_nothing_is_written(session, line):
    result = session()
    result.assert_outcomes(failed=1)
    name = "test_a_missing_picture_fails_and_nothing_is_written.py::test_a_line"
    lines = said(result)
    assert lines[0] == f"AssertionError: there is no golden picture {line}"
    assert lines[1].startswith("see ")
    assert lines[2] == f"if what was shown is right: pytest --update-frames {name}"
    assert not line.parent.exists()
    assert kept(result).width > 16


def test_it_is_written_on_demand_and_then_compared(session, line):
    result = session("--update-frames")
    result.assert_outcomes(passed=1)
    result.stdout.fnmatch_lines(["golden pictures written: 1", f"  {line}"])
    with Image.open(line) as file:
        assert (file.mode, file.size) == ("L", (16, 8))
        assert np.array_equal(np.asarray(file)[:, :8], 255 * np.eye(8))
    session().assert_outcomes(passed=1)
    session(end=6).assert_outcomes(failed=1)


def test_what_is_right_is_not_written_again(session, line):
    session("--update-frames")
    before = line.stat().st_mtime_ns
    result = session("--update-frames")
    result.stdout.fnmatch_lines(["golden pictures written: 0"])
    assert line.stat().st_mtime_ns == before
    assert [file.name for file in line.parent.iterdir()] == ["line.png"]


def test_a_difference_is_shown_as_text_and_as_a_picture(session, line):
    session("--update-frames")
    result = session(end=6)
    result.assert_outcomes(failed=1)
    assert said(result)[:11] == [
        f"AssertionError: what was shown is not {line}",
        "8 of 128 pixels, x 4 to 7, y 3 to 7",
        "expected           shown              differs",
        "#...............   #...............   ................",
        ".#..............   .#..............   ................",
        "..#.............   ..#.............   ................",
        "...#............   ...##...........   ....^...........",
        "....#...........   .....#..........   ....^^..........",
        ".....#..........   ......#.........   .....^^.........",
        "......#.........   .......#........   ......^^........",
        ".......#........   ................   .......^........",
    ]


def test_of_a_large_picture_the_part_that_differs_is_shown(session):
    session("--update-frames", width=128, height=64)
    lines = said(session(width=128, height=64, end=6))
    assert lines[1:6] == [
        "8 of 8192 pixels, x 4 to 7, y 3 to 7",
        "expected   shown      differs",
        "........   ........   ........",
        "#.......   #.......   ........",
        ".#......   .##.....   ..^.....",
    ]


def test_of_a_large_difference_braille_is_shown(pytester):
    draw = "from paneldraw import Framebuffer\nfrom paneldraw.testing import assert_frame\ndef test_it():\n"
    draw += "    fb = Framebuffer(128, 64)\n    fb.{}\n    assert_frame(fb, 'it.png')\n"
    pytester.makepyfile(draw.format("hline(0, 0, 128, 1)"))
    pytester.runpytest_inprocess("--update-frames").assert_outcomes(passed=1)
    pytester.makepyfile(draw.format("hline(0, 63, 128, 1)"))
    lines = said(pytester.runpytest_inprocess())
    assert lines[1] == "256 of 8192 pixels, x 0 to 127, y 0 to 63"
    assert lines[2:4] == ["expected", "⠉" * 64]
    assert lines[19:21] == ["shown", "⠀" * 64]
    assert lines[35:38] == ["⣀" * 64, "differs", "⠉" * 64]


def test_the_picture_of_a_failure_has_three_parts(session):
    session("--update-frames", depth=4)
    with kept(session(depth=4, end=6)) as sheet:
        pixels = np.asarray(sheet.convert("RGB"))
    tile, scale = (16 + 2) * 8, 8
    assert pixels.shape == ((8 + 2) * scale + 28, 3 * (tile + 8) + 8, 3)

    def part(index, x, y):
        """A point in the middle of a panel's pixel."""
        return tuple(int(value) for value in pixels[20 + 8 * y + 12, 8 + index * (tile + 8) + 8 * x + 12])

    dark, lit = part(0, 15, 0), part(0, 0, 0)
    assert dark != lit
    assert (part(0, 4, 4), part(1, 4, 4)) == (lit, dark)
    assert (part(0, 4, 3), part(1, 4, 3)) == (dark, lit)
    assert (part(2, 4, 4), part(2, 4, 3)) == ((255, 64, 64), (63, 167, 255))  # too dark, too bright
    assert part(2, 0, 0)[0] == part(2, 1, 1)[0] == 88


def test_another_size(session, line):
    session("--update-frames")
    result = session(width=24)
    result.assert_outcomes(failed=1)
    assert said(result)[0] == f"AssertionError: {line} has 16x8 pixels, and 24x8 were shown"
    assert kept(result).width == 2 * ((24 + 2) * 8 + 8) + 8


@pytest.mark.parametrize("content", [b"", b"no picture\n", "half", "flipped"], ids=str)
def test_a_damaged_picture(session, line, content):
    session("--update-frames")
    whole = line.read_bytes()
    flipped = bytes(byte ^ (at > 40) for at, byte in enumerate(whole))
    line.write_bytes({"half": whole[: len(whole) // 2], "flipped": flipped}.get(content, content))
    result = session()
    result.assert_outcomes(failed=1)
    assert said(result)[0].startswith(f"AssertionError: the golden picture {line} is damaged: ")
    assert said(result)[-1].startswith("if what was shown is right: pytest --update-frames ")
    session("--update-frames").assert_outcomes(passed=1)
    assert line.read_bytes() == whole


def test_a_picture_that_is_no_golden_one(session, line):
    line.parent.mkdir()
    fb = Framebuffer(16, 8)
    fb.to_image().convert("RGB").save(line)
    assert said(session())[0].endswith("is no golden picture, which is gray, a pixel a pixel: its mode is RGB")


def test_a_picture_of_a_panel_with_more_grays(session):
    session("--update-frames", depth=4)  # white alone: as good for a panel of two levels
    session().assert_outcomes(passed=1)


def test_a_picture_with_grays_that_the_panel_has_not(session, line):
    line.parent.mkdir()
    Image.fromarray(np.full((8, 16), 17, np.uint8)).save(line)
    assert said(session(depth=2))[0].endswith("is a golden picture of a panel with more grays than the 4 of this")
    assert said(session(depth=4))[0] == f"AssertionError: what was shown is not {line}"


def test_what_cannot_be_read(session, line):
    line.mkdir(parents=True)
    assert said(session())[0] == f"AssertionError: the golden picture {line} cannot be read: Is a directory"


def test_what_cannot_be_written(session, line):
    line.parent.write_text("a file where the folder should be")
    result = session("--update-frames")
    result.assert_outcomes(failed=1)
    assert said(result)[0].startswith(f"AssertionError: the golden picture {line} cannot be written: ")


def test_no_permission(tmp_path, monkeypatch):
    def denied(*_):
        raise PermissionError(13, "Permission denied")

    path = tmp_path / "it.png"
    levels = np.eye(8, dtype=np.uint8)
    assert golden._save(Image.fromarray(levels), path) is None
    before = path.read_bytes()
    with monkeypatch.context() as patch:
        patch.setattr("os.replace", denied)
        assert golden._save(Image.fromarray(1 - levels), path) == "Permission denied"
    assert [file.read_bytes() for file in tmp_path.iterdir()] == [before]
    monkeypatch.setattr("PIL.Image.open", denied)
    assert golden._read(path, 1) == f"the golden picture {path} cannot be read: Permission denied"


@pytest.mark.parametrize("name", ["", ".png", "line.gif", "../line.png", "menu/../../line.png", "/line.png"])
def test_a_name_out_of_the_folder(name):
    with pytest.raises(ValueError, match="name must be that of a"):
        assert_frame(Framebuffer(8, 8), name)


def test_a_folder_in_the_folder(session, line):
    session("--update-frames", name="menu/line.png").assert_outcomes(passed=1)
    assert (line.parent / "menu" / "line.png").exists()


def test_two_pictures_of_one_name_are_not_both_written(pytester):
    pytester.makepyfile(
        """
        import pytest
        from paneldraw import Framebuffer
        from paneldraw.testing import assert_frame

        @pytest.mark.parametrize("x", [0, 0, 1])
        def test_it(x):
            fb = Framebuffer(8, 8)
            fb.pixel(x, 0, 1)
            assert_frame(fb, "it.png")
        """
    )
    result = pytester.runpytest_inprocess("--update-frames")
    result.assert_outcomes(passed=2, failed=1)
    assert said(result)[0].startswith("AssertionError: two pictures cannot both be ")


def test_out_of_a_test(monkeypatch):
    monkeypatch.setattr(golden.running, "tests", [])
    with pytest.raises(RuntimeError, match="in a test that pytest runs, with the plugin of paneldraw"):
        assert_frame(Framebuffer(8, 8), "it.png")


def test_what_shows_nothing():
    with pytest.raises(TypeError, match="source must be simulated, or a framebuffer, not 'panel'"):
        assert_frame("panel", "it.png")


def test_other_folders(session, pytester):
    pytester.makeini("[pytest]\npaneldraw_golden = pictures/panel\npaneldraw_failures = artifacts\n")
    session("--update-frames").assert_outcomes(passed=1)
    assert (pytester.path / "pictures" / "panel" / "line.png").exists()
    session(end=6).assert_outcomes(failed=1)
    assert [file.suffix for file in (pytester.path / "artifacts").iterdir()] == [".png"]


def test_pictures_of_failures_are_beside_the_report(session, pytester):
    result = session("--junitxml=reports/results.xml")
    (picture,) = (pytester.path / "reports" / "frames").iterdir()
    assert Path(kept(result).filename) == picture
    assert str(picture) in (pytester.path / "reports" / "results.xml").read_text(encoding="utf-8")


def test_a_picture_of_a_failure_that_cannot_be_written_hides_no_failure(session, pytester):
    (pytester.path / "artifacts").write_text("a file")
    pytester.makeini("[pytest]\npaneldraw_failures = artifacts\n")
    result = session()
    result.assert_outcomes(failed=1)
    assert said(result)[1].startswith("no picture of it can be written to ")


@pytest.mark.thorough
def test_workers_write_golden_pictures_and_those_of_failures(pytester):
    pytest.importorskip("xdist", reason="pytest-xdist is not installed")
    pytester.makepyfile(
        """
        import pytest
        from paneldraw.testing import assert_frame

        @pytest.mark.parametrize("x", range(4))
        def test_it(x, sim_panel):
            with sim_panel.frame() as fb:
                fb.pixel(x, 0, 1)
            assert_frame(sim_panel, f"{x}.png")
        """
    )
    result = pytester.runpytest_subprocess("-n2")
    result.assert_outcomes(failed=4)
    assert len(set(re.findall(r"see (\S+\.png)", result.stdout.str()))) == 4
    result = pytester.runpytest_subprocess("-n2", "--update-frames")
    result.assert_outcomes(passed=4)
    result.stdout.fnmatch_lines(["golden pictures written: 4", *(f"*golden/{x}.png" for x in range(4))])
    assert sorted(file.name for file in (pytester.path / "golden").iterdir()) == [f"{x}.png" for x in range(4)]


@given(
    depth=st.sampled_from([1, 2, 4, 8]),
    width=st.integers(1, 40),
    height=st.integers(1, 40),
    seed=st.integers(0, 2**32 - 1),
)
def test_any_picture_reads_back_as_it_was_written(depth, width, height, seed, tmp_path):
    levels = np.random.default_rng(seed).integers(0, 2**depth, (height, width), np.uint8)
    path = tmp_path / "any.png"
    golden._save(Image.fromarray(golden._grays(levels, 2**depth - 1)), path)
    assert np.array_equal(golden._read(path, 2**depth - 1), levels)
