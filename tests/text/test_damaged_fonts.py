"""Damaged fonts, and files that are none: a sentence, or whatever can be read of them; never a crash."""

from __future__ import annotations

import gzip
import re
from pathlib import Path

import numpy as np
import pytest
import sample_fonts as sample
from hypothesis import given
from hypothesis import strategies as st
from PIL import ImageFont

from paneldraw import Font, Framebuffer
from paneldraw.text import outline, render
from paneldraw.text.outline import characters_of

WHOLE = {
    ".bdf": sample.bdf(),
    ".pcf": sample.pcf(),
    ".psf": sample.psf1(),
    ".psfu": sample.psf2(),
    ".hex": sample.hexadecimal(),
    ".c": sample.u8g2(),
    ".pcf.gz": gzip.compress(sample.pcf()),
    ".ttf": ImageFont.load_default(10).font_bytes[:3000],
}
DIGITS = re.compile(rb"\d+")


@st.composite
def damaged(draw):
    """A font cut short, with bytes changed, and with numbers that make no sense."""
    ending = draw(st.sampled_from(sorted(WHOLE)))
    data = bytearray(WHOLE[ending])
    for _ in range(draw(st.integers(0, 6))):
        data[draw(st.integers(0, len(data) - 1))] = draw(st.sampled_from((0, 1, 0x7F, 0x80, 0xFF, 0x2D, 0x39)))
    data = data[: draw(st.one_of(st.just(len(data)), st.integers(0, len(data))))]
    number = draw(st.none() | st.sampled_from((b"-1", b"0", b"99999", b"4294967295", b"9" * 30)))
    if number is not None and ending in (".bdf", ".hex", ".c"):
        at = draw(st.integers(0, 30))
        found = list(DIGITS.finditer(bytes(data)))[at : at + 1]
        for match in found:
            data[match.start() : match.end()] = number
    return ending, bytes(data)


def loaded_or_refused(path):
    """The font, or None where a sentence says what is wrong with it."""
    try:
        return Font.load(path, 10 if path.suffix == ".ttf" else None)
    except OSError as error:
        if not str(error).startswith(f"cannot read font {str(path)!r}: "):
            raise
    return None


@given(damaged())
def test_damage_is_said_or_survived(tmp_path_factory, font):
    ending, data = font
    path = tmp_path_factory.getbasetemp() / f"damaged{ending}"
    path.write_bytes(data)
    loaded = loaded_or_refused(path)
    if loaded is None:
        return
    fb = Framebuffer(64, 32)
    fb.text("A.A\u0100Å \U0001f600", 3, 3, font=loaded, anchor="ms")
    coverage, _, _ = render("A.A\u0100", loaded)
    assert coverage.size <= 1 << 22
    assert 0 < loaded.height <= 4096


@pytest.mark.parametrize("ending", sorted(WHOLE))
def test_every_beginning_of_a_font(tmp_path, ending):
    data = WHOLE[ending][:700]
    path = tmp_path / f"short{ending}"
    for length in range(0, len(data), 7):
        path.write_bytes(data[:length])
        loaded = loaded_or_refused(path)
        assert loaded is None or loaded.glyph("A").shape[0] >= loaded.height > 0


@pytest.mark.parametrize("data", [b"", b"\0" * 100, b"no font", b"\x1f\x8b", b"\x36\x04", b"%PDF-1.4", b"\xff" * 5000])
def test_files_that_are_no_fonts(tmp_path, data):
    path = tmp_path / "file"
    path.write_bytes(data)
    with pytest.raises(OSError, match="cannot read font"):
        Font.load(path)


def test_files_that_are_not_there(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"nowhere\.ttf.*Font\.find"):
        Font.load(tmp_path / "nowhere.ttf", 10)
    with pytest.raises(IsADirectoryError, match="cannot read font"):
        Font.load(tmp_path)


def test_a_bomb_is_not_unpacked(tmp_path):
    path = tmp_path / "bomb.bdf.gz"
    path.write_bytes(gzip.compress(b"STARTFONT 2.1\n" + b"\0" * (200 << 20)))
    with pytest.raises(OSError, match="more than 64 MB"):
        Font.load(path)


def test_characters_of_absurd_size_are_not_there(tmp_path):
    path = tmp_path / "huge.bdf"
    path.write_bytes(sample.bdf().replace(b"BBX 4 5 0 0", b"BBX 99999 99999 0 0"))
    font = Font.load(path)
    assert font.glyph("A").shape[0] < 20
    assert (font.glyph("A") == font.glyph("\u4e2d")).all()


@pytest.mark.parametrize("size", [0, -1, float("nan"), 1e9, float("inf")])
def test_sizes_that_are_none(tmp_path, size):
    path = tmp_path / "sample.bdf"
    path.write_bytes(sample.bdf())
    for call in (Font.load, Font.truetype):
        with pytest.raises(ValueError, match="size must be positive"):
            call(path, size)
    with pytest.raises(TypeError, match="size must be a number"):
        Font.load(path, "12")


@pytest.mark.parametrize("anchor", ["", "l", "tl", "la ", "xx", None, 5, [], ("l", "a"), b"la", np.array(["l"])])
def test_unknown_anchors_of_any_type(anchor):
    for font in (None, Font.from_pillow(ImageFont.load_default(12))):
        with pytest.raises(ValueError, match="anchor must be"):
            Framebuffer(8, 8).text("a", 0, 0, font=font, anchor=anchor)


def test_texts_larger_than_a_picture_may_be():
    font = Font.from_pillow(ImageFont.load_default(3000))
    with pytest.raises(ValueError, match="Pillow's limit"):
        Framebuffer(8, 8).text("M" * 40, 0, 0, font=font)


@given(st.binary(max_size=400))
def test_a_table_of_characters_of_any_bytes(data):
    """What an outline font says of its characters, damaged, is looked at by drawing instead."""
    outline = ImageFont.load_default(10)
    whole = outline.font_bytes
    at = whole.index(b"cmap")
    offset = int.from_bytes(whole[at + 8 : at + 12], "big")
    outline.font_bytes = whole[:offset] + data + whole[offset + len(data) :]
    has = characters_of(outline)
    assert has(0x41) in (True, False)
    assert has(0x10FFFF) in (True, False)


@pytest.mark.parametrize("ascent", [-400, 30000])
def test_lines_that_cannot_be_that_high(tmp_path, ascent):
    data = bytearray(WHOLE[".ttf"])
    at = int.from_bytes(data[data.index(b"hhea") + 8 :][:4], "big") + 4
    data[at : at + 4] = (ascent & 0xFFFF).to_bytes(2, "big") + b"\0\0"
    path = tmp_path / "high.ttf"
    path.write_bytes(bytes(data))
    with pytest.raises(OSError, match=r"its lines would be -?\d+ rows high"):
        Font.load(path, 10)


def test_a_packed_font_that_is_cut_short_at_once(tmp_path):
    path = tmp_path / "short.pcf.gz"
    path.write_bytes(gzip.compress(sample.pcf())[:12])
    with pytest.raises(OSError, match=r"damaged gzip data \(cut short\)"):
        Font.load(path)


def test_of_bitmaps_without_a_table_of_characters_few_are_drawn_to_find_out(monkeypatch):
    """To try all of Unicode took minutes."""
    path = sample.installed(Path("/usr/share/fonts/opentype/terminus/terminus-normal.otb"))
    known = render("21.5 °Cж", Font.load(path, 16))
    asked, look = [], outline._drawn

    def counting(font):
        drawn = look(font)
        return lambda code: asked.append(code) or drawn(code)

    monkeypatch.setattr(outline, "_table_of", lambda _: outline._NONE)
    monkeypatch.setattr(outline, "_drawn", counting)
    assert np.array_equal(render("21.5 °Cж", Font.load(path, 16))[0], known[0])
    assert 95 <= len(asked) < 400


@pytest.mark.parametrize("load", [Font.load, Font.truetype])
def test_no_installed_font_of_the_same_name_stands_in_for_a_damaged_one(tmp_path, load):
    path = tmp_path / "DejaVuSans.ttf"
    path.write_bytes(sample.installed(Path("/usr/share/fonts/truetype/dejavu") / path.name).read_bytes()[:500])
    with pytest.raises(OSError, match="cannot read font"):
        load(path, 12)


@pytest.mark.parametrize("load", [Font.load, Font.truetype])
@pytest.mark.parametrize(("size", "kind"), [(0, ValueError), (float("nan"), ValueError), ("12", TypeError)])
def test_sizes_of_outlines_that_are_none(load, size, kind):
    with pytest.raises(kind, match=r"^size must be (positive|a number of pixels)"):
        load(sample.installed(Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")), size)


def test_an_outline_must_be_given_a_size():
    path = sample.installed(Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"))
    with pytest.raises(ValueError, match="size must be given"):
        Font.load(path)
    with pytest.raises(TypeError, match="size must be a number of pixels, not NoneType"):
        Font.truetype(path, None)


def damaged_outlines(path, letters):
    """Write Pillow's font with nonsense for the outlines of some letters."""
    whole = ImageFont.load_default(10)
    data = bytearray(whole.font_bytes)
    tables = {
        bytes(data[at : at + 4]): int.from_bytes(data[at + 8 : at + 12], "big")
        for at in range(12, 12 + 16 * data[5], 16)
    }
    wide = data[tables[b"head"] + 51]
    for letter in letters:
        entry = tables[b"loca"] + (4 if wide else 2) * outline._table_of(whole)[1](ord(letter))
        start = int.from_bytes(data[entry : entry + 4], "big") if wide else 2 * int.from_bytes(data[entry:][:2], "big")
        data[tables[b"glyf"] + start : tables[b"glyf"] + start + 20] = b"\x7f" * 20
    path.write_bytes(data)


def test_letters_that_are_damaged_are_said_to_be(tmp_path):
    damaged_outlines(tmp_path / "q.ttf", "Q")
    font = Font.load(tmp_path / "q.ttf", 12)
    fb = Framebuffer(40, 20)
    with pytest.raises(OSError, match=r"font '.+' is damaged and cannot draw 'A Q': "):
        fb.text("A Q", 0, 0, font=font)
    fb.text("AH", 0, 0, font=font)
    assert fb.pixels.any()
    damaged_outlines(tmp_path / "h.ttf", "H")
    with pytest.raises(OSError, match="cannot read font"):
        Font.load(tmp_path / "h.ttf", 12)
