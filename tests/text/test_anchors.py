"""Anchors mean what Pillow's mean, of every font that Debian's packages install for these tests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageDraw, ImageFont
from sample_fonts import installed

from paneldraw import Font, Framebuffer

SHARE = Path("/usr/share/fonts")
ANCHORS = [side + row for side in "lmr" for row in "atmsbd"]
TEXTS = ("Ag", "ÖÜÉÈÑ", "fluffy jug", "'", "_", "-", "x", "21.5°C", " ", "jÅ")
WIDTH, HEIGHT = 220, 120
X, Y = 110, 60

OUTLINES = {
    "DejaVu Sans": SHARE / "truetype/dejavu/DejaVuSans.ttf",
    "DejaVu Sans Bold": SHARE / "truetype/dejavu/DejaVuSans-Bold.ttf",
    "DejaVu Sans Mono": SHARE / "truetype/dejavu/DejaVuSansMono.ttf",
    "DejaVu Serif": SHARE / "truetype/dejavu/DejaVuSerif.ttf",
}
BITMAPS = {
    "Terminus 12": (SHARE / "opentype/terminus/terminus-normal.otb", 12),
    "Terminus 32": (SHARE / "opentype/terminus/terminus-bold.otb", 32),
    "6x13": (SHARE / "X11/misc/6x13-ISO8859-1.pcf.gz", 13),
    "10x20": (SHARE / "X11/misc/10x20-ISO8859-1.pcf.gz", 20),
    "Clean": (SHARE / "X11/misc/clR6x12-ISO8859-1.pcf.gz", 12),
    "Terminus of X11": (SHARE / "X11/misc/ter-u16n_unicode.pcf.gz", 16),
}


def shift(anchor):
    """Pillow's lines lie between pixels; a coordinate here names the pixel before, but left and top the one behind."""
    return anchor[0] != "l", anchor[1] not in "at"


def same(font, pillow, mode):
    """Compare all anchors of all texts."""
    for anchor in ANCHORS:
        for text in TEXTS:
            fb = Framebuffer(WIDTH, HEIGHT, depth=8)
            fb.text(text, X, Y, font=font, anchor=anchor)
            page = Image.new("L", (WIDTH, HEIGHT))
            draw = ImageDraw.Draw(page)
            draw.fontmode = mode
            right, down = shift(anchor)
            draw.text((X + right, Y + down), text, 255, pillow, anchor=anchor)
            assert (fb.pixels == np.array(page)).all(), (anchor, text)


@pytest.mark.parametrize("antialias", [False, True])
@pytest.mark.parametrize("size", [7, 12, 17, 30.5])
@pytest.mark.parametrize("name", OUTLINES)
def test_outlines(name, size, antialias):
    path = installed(OUTLINES[name])
    same(Font.load(path, size, antialias=antialias), ImageFont.truetype(path, size), "L" if antialias else "1")


@pytest.mark.parametrize("name", BITMAPS)
def test_bitmaps(name):
    path, size = BITMAPS[name]
    same(Font.load(installed(path), size), ImageFont.truetype(path, size), "1")
