"""Fonts from files: the same letter in every format, what real files get wrong, and what Debian's packages have."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
import sample_fonts as sample
from PIL import BdfFontFile, ImageFont

from paneldraw import Font
from paneldraw.text import render

X11 = Path("/usr/share/fonts/X11/misc")
CONSOLE = Path("/usr/share/consolefonts")
DEJAVU = Path("/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf")
UNIFONT = Path("/usr/share/unifont/unifont.hex")

FILES = {
    "sample.bdf": sample.bdf(),
    "sample.bdf.gz": gzip.compress(sample.bdf()),
    "sample.pcf": sample.pcf(),
    "big.pcf": sample.pcf(">", "big", 2, 2, compressed=False),
    "mixed.pcf": sample.pcf("<", "big", 0, 0),
    "swapped.pcf": sample.pcf(">", "little", 2, 2),
    "sample.pcf.gz": gzip.compress(sample.pcf()),
    "one.psf": sample.psf1(),
    "two.psf.gz": gzip.compress(sample.psf2()),
    "bare.psf": sample.psf2(table=False),
    "sample.hex": sample.hexadecimal(),
    "sample.c": sample.u8g2(),
    "braces.h": sample.u8g2(braces=True),
}


def load(folder, name, data, *args, **options):
    (folder / name).write_bytes(data)
    return Font.load(folder / name, *args, **options)


def letter(font, char):
    """What is lit of a character, cut to it, and where: its first column and the row above the baseline's next."""
    coverage, dx, dy = render(char, font, "ls")
    rows, columns = np.flatnonzero(coverage.any(axis=1)), np.flatnonzero(coverage.any(axis=0))
    if not len(rows):
        return None
    cut = coverage[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return "\n".join("".join("#" if value else "." for value in row) for row in cut), columns[0] + dx, rows[-1] + dy


A = (".##.\n#..#\n####\n#..#\n#..#", 0, 0)


@pytest.mark.parametrize("name", [name for name in FILES if name != "bare.psf"])
def test_every_format_has_the_same_letter(tmp_path, name):
    font = load(tmp_path, name, FILES[name])
    assert letter(font, "A") == A
    assert font.glyph("A").shape[0] == font.height


def test_sizes_and_names(tmp_path):
    font = load(tmp_path, "sample.bdf", sample.bdf())
    assert (font.name, font.height, font.baseline, font.width, font.advance) == ("Sample", 6, 4, 5, 0)
    assert font.measure("A.A") == (13, 6)
    assert load(tmp_path, "two.psf", sample.psf2()).advance == 9


def test_codes_of_two_bytes_and_sequences(tmp_path):
    assert letter(load(tmp_path, "sample.c", sample.u8g2()), "\u0100") == A
    assert letter(load(tmp_path, "one.psf", sample.psf1()), "Å") == A
    two = load(tmp_path, "two.psf", sample.psf2())
    assert letter(two, "Á") == letter(two, "A\u0301") == letter(two, "ß") == A
    assert letter(load(tmp_path, "a.hex", sample.hexadecimal()), "\U0001f600") == A


def test_a_console_font_without_a_table_has_the_codes_of_a_pc(tmp_path):
    data = bytearray(sample.psf1()[: 4 + 256 * 6])
    data[2] = 0
    data[4 + 6 * 0x81 : 4 + 6 * 0x82] = data[4:10]
    font = load(tmp_path, "bare.psf", bytes(data))
    assert letter(font, "ü")[0] == letter(font, "\uf081")[0] == A[0]
    assert letter(load(tmp_path, "bare.psf", bytes(data), encoding="cp1250"), "\uf000")[0] == A[0]


def test_pillows_own_fonts(tmp_path):
    characters = [(code, sample.A, 0, 0, 5) for code in range(65, 91)]
    (tmp_path / "own.bdf").write_bytes(sample.bdf(characters))
    with (tmp_path / "own.bdf").open("rb") as file:
        BdfFontFile.BdfFontFile(file).save(tmp_path / "own")
    font = Font.load(tmp_path / "own.pil")
    assert letter(font, "A") == A
    assert font.baseline == 4
    assert render("€", font)[0].any()


WRONG = {
    "no CHARS": sample.bdf().replace(b"CHARS 3\n", b""),
    "no ENDFONT": sample.bdf(end=""),
    "no ENDCHAR": sample.bdf().replace(b"ENDCHAR\n", b""),
    "no STARTFONT": sample.bdf()[sample.bdf().index(b"STARTCHAR") :],
    "no properties": sample.bdf().replace(b"STARTPROPERTIES 6\n", b"").replace(b"ENDPROPERTIES\n", b""),
    "quotes": sample.bdf().replace(b"FONTBOUNDINGBOX 4 6 0 -1", b'FONTBOUNDINGBOX "4" "6" "0" "-1"'),
    "CRLF": sample.bdf().replace(b"\n", b"\r\n"),
    "CR": sample.bdf().replace(b"\n", b"\r"),
    "8-bit comments": b"COMMENT \xa9 \xe9\xff\n" + sample.bdf(),
    "odd digits": sample.bdf().replace(b"\n60\n90\nF0\n90\n90\n", b"\n6\n9\nF\n9\n9\n"),
    "long rows": sample.bdf().replace(b"\n60\n90\nF0\n90\n90\n", b"\n6000\n9000\nF000\n9000\n900000\n"),
    "indented": sample.bdf().replace(b"\n", b"\n  "),
    "tabs": sample.bdf().replace(b" ", b"\t"),
    "no DWIDTH": sample.bdf().replace(b"DWIDTH 5 0\n", b""),
    "DWIDTH 0": sample.bdf().replace(b"DWIDTH 5 0\n", b"DWIDTH 0 0\n"),
    "code in the name": sample.bdf().replace(b"STARTCHAR c65\nENCODING 65", b"STARTCHAR uni0041\nENCODING -1"),
    "code behind": sample.bdf().replace(b"ENCODING 65", b"ENCODING -1 65"),
}


@pytest.mark.parametrize("fault", WRONG)
def test_what_real_bdf_files_get_wrong(tmp_path, fault):
    font = load(tmp_path, "wrong.bdf", WRONG[fault])
    shape, left, bottom = letter(font, "A")
    assert (shape, left) == A[:2]
    assert bottom == 0
    assert font.measure("AA")[0] >= 8


def test_codes_beyond_the_first_plane(tmp_path):
    assert letter(load(tmp_path, "a.bdf", sample.bdf([(0x1F600, sample.A, 0, 0, 5)])), "\U0001f600") == A


def test_missing_rows_are_empty(tmp_path):
    font = load(tmp_path, "a.bdf", sample.bdf().replace(b"F0\n90\n90\n", b""))
    assert letter(font, "A")[0] == ".##.\n#..#"


@pytest.mark.parametrize(
    ("charset", "code", "char"),
    [
        (("KOI8", "R"), 0xC1, "\u0430"),
        (("ISO8859", "5"), 0xD0, "\u0430"),
        (("ISO8859", "15"), 0xA4, "€"),
        (("TIS620.2529", "1"), 0xA1, "ก"),
        (("JISX0208.1983", "0"), 0x2422, "あ"),
        (("JISX0201.1976", "0"), 0xB1, "ｱ"),
        (("GB2312.1980", "0"), 0x3021, "啊"),
        (("KSC5601.1987", "0"), 0x3021, "가"),
        (("BIG5", "0"), 0xA440, "一"),
        (("MICROSOFT", "CP1251"), 0xE0, "\u0430"),
        (("IBM", "CP437"), 0x81, "ü"),
        (("ISO646.1991", "IRV"), 0x41, "A"),
        (("Adobe", "FontSpecific"), 0x41, "A"),
        (("SUN.CURSOR", "1"), 0x100, "\u0100"),
    ],
)
def test_character_sets_are_mapped_or_reached_by_code(tmp_path, charset, code, char):
    font = load(tmp_path, "set.bdf", sample.bdf([(code, sample.A, 0, 0, 5)], charset=charset))
    assert letter(font, char) == A
    raw = load(tmp_path, "set.bdf", sample.bdf([(code, sample.A, 0, 0, 5)], charset=charset), encoding="raw")
    assert letter(raw, chr(code)) == A


def test_an_encoding_can_be_named(tmp_path):
    font = load(tmp_path, "set.bdf", sample.bdf([(0xC1, sample.A, 0, 0, 5)]), encoding="koi8-r")
    assert letter(font, "\u0430") == A
    for wrong in ("klingon", "rot13", 7):
        with pytest.raises(ValueError, match="encoding must be"):
            load(tmp_path, "set.bdf", sample.bdf(), encoding=wrong)


def test_characters_without_codes_are_refused(tmp_path):
    with pytest.raises(OSError, match="without any character that has a code"):
        load(tmp_path, "none.bdf", sample.bdf([(-1, sample.A, 0, 0, 5)]))


def test_a_bitmap_font_has_its_own_size(tmp_path):
    assert load(tmp_path, "sample.bdf", sample.bdf(), 6).height == 6
    with pytest.raises(ValueError, match=r"sample\.bdf has the size 6, not 13; font\.scaled\(2\)"):
        load(tmp_path, "sample.bdf", sample.bdf(), 13)
    path = sample.installed(Path("/usr/share/fonts/opentype/terminus/terminus-normal.otb"))
    with pytest.raises(ValueError, match="sizes 12, 14, 16, 18, 20, 22, 24, 28, 32, not 13"):
        Font.load(path, 13)
    with pytest.raises(ValueError, match=r"one of those of terminus-normal\.otb: 12, 14"):
        Font.load(path)
    assert Font.load(path, 16).glyph("Ж").any()


def test_outlines_want_a_size(tmp_path):
    data = ImageFont.load_default(10).font_bytes
    with pytest.raises(ValueError, match="size must be given"):
        load(tmp_path, "face.ttf", data)
    font = load(tmp_path, "face.ttf", data, 10)
    assert (render("file", font)[0] == render("file", Font.truetype(tmp_path / "face.ttf", 10))[0]).all()


def test_fonts_of_symbols_are_reached_by_their_codes(tmp_path):
    """An outline font whose one table of characters is called that of symbols."""
    data = bytearray(sample.installed(DEJAVU).read_bytes())
    at = int.from_bytes(data[data.index(b"cmap") + 8 :][:4], "big")
    places = {bytes(data[k : k + 4]): data[k + 4 : k + 8] for k in range(at + 4, at + 4 + 8 * data[at + 3], 8)}
    data[at + 2 : at + 12] = b"\0\1" + b"\0\3\0\0" + places[b"\0\3\0\1"]
    font = load(tmp_path, "symbols.ttf", bytes(data), 12)
    assert (font.glyph("A") == Font.load(DEJAVU, 12).glyph("A")).all()
    assert (font.glyph("\ue000") == font.glyph("\ue001")).all()


def test_several_fonts_in_one_source(tmp_path):
    both = sample.u8g2("u8g2_font_one_tr") + sample.u8g2("u8g2_font_two_tr")
    with pytest.raises(OSError, match=r"2 fonts.*u8g2_font_one_tr, u8g2_font_two_tr"):
        load(tmp_path, "fonts.c", both)
    font = Font.load(f"{tmp_path / 'fonts.c'}#u8g2_font_two_tr")
    assert font.name == "u8g2_font_two_tr"
    assert letter(font, "A") == A


def freetype(path, size):
    return ImageFont.truetype(str(path), size, layout_engine=ImageFont.Layout.BASIC)


@pytest.mark.parametrize(
    ("path", "size"),
    [(X11 / name, size) for name, size in [("6x13.pcf.gz", 13), ("10x20.pcf.gz", 20)]]
    + [(X11 / "ter-u12n_unicode.pcf.gz", 12), (X11 / "clR6x12-ISO8859-1.pcf.gz", 12)],
)
def test_pcf_as_freetype_reads_it(path, size):
    """Some 150 characters of fonts of Debian's packages, their places and advances too."""
    font, theirs = Font.load(sample.installed(path)), freetype(path, size)
    ascent, descent = theirs.getmetrics()
    assert (font.baseline + 1, font.height) == (ascent, ascent + descent)
    pictures = font._face.strike.pictures
    codes = [code for code in pictures if code >= 0x20]
    for code in codes[:: len(codes) // 150 + 1]:
        picture = pictures[code]
        mask, (left, top) = theirs.getmask2(chr(code), "1", anchor="ls")
        cover = np.zeros((64, 64), np.uint8)
        cover[32 + top :, 16 + left :][: mask.size[1], : mask.size[0]] = np.reshape(list(bytes(mask)), mask.size[::-1])
        ours = np.zeros((64, 64), np.uint8)
        place = ours[32 + picture.top - ascent :, 16 + picture.left :]
        place[: picture.ink.shape[0], : picture.ink.shape[1]] = picture.ink
        assert ((ours > 0) == (cover > 0)).all(), hex(code)
        assert picture.advance == theirs.getlength(chr(code), "1"), hex(code)


def test_fonts_of_the_console():
    font = Font.load(sample.installed(CONSOLE / "Uni2-Terminus16.psf.gz"))
    x11 = Font.load(sample.installed(X11 / "ter-u16n_unicode.pcf.gz"))
    assert (font.height, font.advance, font.baseline) == (16, 8, x11.baseline)
    for char in "AgÄß№€Ж┼":
        assert (font.glyph(char) == x11.glyph(char)).all(), char


def test_unifont():
    font = Font.load(sample.installed(UNIFONT))
    assert (font.height, font.baseline, font.advance) == (16, 13, 8)
    assert font.measure("A中") == (24, 16)
    assert render("q\u0303", font)[0].shape == (16, 8)
