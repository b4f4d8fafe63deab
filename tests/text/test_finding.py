"""Installed fonts, found by name."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
import sample_fonts as sample
from PIL import ImageFont

from paneldraw import Font
from paneldraw.text import finding


@pytest.fixture
def here(tmp_path, monkeypatch):
    """A system with a folder of fonts and no other."""
    monkeypatch.setattr(finding, "folders", lambda: [tmp_path])
    return tmp_path


def put(folder, *names):
    data = ImageFont.load_default(10).font_bytes
    for name in names:
        content = sample.bdf() if name.endswith(".bdf") else sample.psf2() if name.endswith(".psf") else data
        (folder / name).write_bytes(content)


def chosen(monkeypatch, *args, **options):
    """The file that is read."""
    read = []
    real = finding.load
    monkeypatch.setattr(finding, "load", lambda path, *more: read.append(path.name) or real(path, *more))
    Font.find(*args, **options)
    return read[-1]


@pytest.mark.parametrize(
    ("name", "options", "file"),
    [
        ("Face", {}, "Face-Regular.ttf"),
        ("face", {"bold": True}, "Face-Bold.ttf"),
        ("FACE", {"italic": True}, "Face-Italic.ttf"),
        ("face", {"bold": True, "italic": True}, "Face-BoldItalic.ttf"),
        ("face bold", {}, "Face-Bold.ttf"),
        ("Face Condensed", {}, "FaceCondensed-Bold.ttf"),
        ("Fac", {}, "Face-Regular.ttf"),
        ("face-light.ttf", {}, "Face-Light.ttf"),
    ],
)
def test_families_and_styles(here, monkeypatch, name, options, file):
    put(here, "Face-Light.ttf", "Face-Bold.ttf", "Face-BoldItalic.ttf", "Face-Regular.ttf", "Face-Italic.ttf")
    put(here, "FaceCondensed-Bold.ttf")
    assert chosen(monkeypatch, name, 12, **options) == file


def test_what_cannot_be_read_is_passed_over(here, monkeypatch):
    put(here, "Face-Book.ttf")
    (here / "Face.ttf").write_bytes(b"broken")
    assert chosen(monkeypatch, "face", 12) == "Face-Book.ttf"
    (here / "Face-Book.ttf").unlink()
    with pytest.raises(OSError, match="cannot read font"):
        Font.find("face", 12)


def test_x11_says_more_than_a_files_name(here, monkeypatch):
    for name in ("a.bdf", "b.bdf", "c.bdf"):
        put(here, name)
    rows = [("a", "medium-r-normal--12", "iso10646-1"), ("b", "medium-r-normal--6", "iso8859-1")]
    rows += [("c", "medium-r-normal--6", "iso10646-1")]
    lines = [f"{file}.bdf -misc-tiny-{style}-60-75-75-p-50-{charset}" for file, style, charset in rows]
    (here / "fonts.dir").write_text("3\n" + "\n".join(lines), encoding="latin-1")
    assert chosen(monkeypatch, "tiny", 6) == "c.bdf"
    assert chosen(monkeypatch, "tiny") == "a.bdf"
    with pytest.raises(ValueError, match=r"not 12.*|not 13; .*installed under that name: 6, 12"):
        Font.find("tiny", 13)


def test_fonts_of_the_console_carry_set_and_size_in_their_names(here, monkeypatch):
    put(here, "Lat2-Tiny6.psf", "Uni2-Tiny6.psf", "Uni2-TinyBold6.psf")
    assert chosen(monkeypatch, "tiny", 6) == "Uni2-Tiny6.psf"
    assert chosen(monkeypatch, "tiny", 6, bold=True) == "Uni2-TinyBold6.psf"


def test_a_font_that_is_not_there_is_told_with_what_is(here):
    put(here, "Terminal.ttf", "Mono.ttf")
    with pytest.raises(FileNotFoundError, match=re.escape("no font 'terminla' is installed; did you mean Terminal?")):
        Font.find("terminla", 12)
    with pytest.raises(FileNotFoundError, match="there are Mono, Terminal; "):
        Font.find("xyz")
    with pytest.raises(FileNotFoundError, match="there are Mono, Terminal; "):
        Font.find("")
    shutil.rmtree(here)
    with pytest.raises(FileNotFoundError, match="nor any other"):
        Font.find("mono", 12)


def test_wrong_arguments(here):
    with pytest.raises(TypeError, match="name must be a string"):
        Font.find(None)
    with pytest.raises(ValueError, match="size must be positive"):
        Font.find("mono", 0)


def test_folders_of_every_system(tmp_path, monkeypatch):
    monkeypatch.setattr(Path, "home", lambda: tmp_path)
    monkeypatch.setenv("XDG_DATA_DIRS", str(tmp_path / "data"))
    monkeypatch.setenv("WINDIR", str(tmp_path / "windows"))
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    wanted = [".fonts", ".local/share/fonts", "data/fonts", "windows/Fonts", "Library/Fonts"]
    for folder in (*wanted, ".local/share/fonts/below"):
        (tmp_path / folder).mkdir(parents=True)
    found = finding.folders()
    assert set(wanted) <= {str(folder.relative_to(tmp_path)) for folder in found if tmp_path in folder.parents}
    settings = tmp_path / "fonts.conf"
    settings.write_text('<dir>/here</dir><dir prefix="xdg">fonts</dir><dir> /there </dir>', encoding="utf-8")
    assert finding._of_fontconfig(settings) == [Path("/here"), Path("/there")]


def test_fonts_of_debians_packages():
    for path in ("opentype/terminus/terminus-normal.otb", "truetype/dejavu/DejaVuSans.ttf", "X11/misc/6x13.pcf.gz"):
        sample.installed(Path("/usr/share/fonts", path))
    sample.installed(Path("/usr/share/unifont/unifont.hex"))
    assert Font.find("terminus", 16).name == "Terminus"
    assert Font.find("DejaVu Sans", 12).name == "DejaVu Sans Book"
    assert Font.find("DejaVu Sans Mono", 12, bold=True).name == "DejaVu Sans Mono Bold"
    assert Font.find("fixed", 13).advance in (6, 7, 8)
    assert Font.find("unifont.hex").advance == 8
    with pytest.raises(ValueError, match="12, 14, 16, 18, 20, 22, 24, 28, 32, not 13"):
        Font.find("terminus", 13)
