"""Every kind of picture that Pillow has, and what else stands for one, shows what it holds."""

from __future__ import annotations

import io
import re
import struct
import zlib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image, ImageCms, ImageOps

RAMP = np.array([[0, 51, 128, 204, 255]], np.uint8)


def painted(package, picture, width=5, height=1, before=0, **options):
    fb = package.Framebuffer(width, height, 8)
    fb.fill(before)
    fb.image(picture, **options)
    return fb.pixels.tolist()


def in_mode(mode):
    """The ramp as an image of a mode."""
    gray = Image.fromarray(RAMP)
    if mode == "LAB":
        rgb, lab = ImageCms.createProfile("sRGB"), ImageCms.createProfile("LAB")
        return ImageCms.profileToProfile(gray.convert("RGB"), rgb, lab, outputMode="LAB")
    if mode.startswith("I;16"):
        return Image.frombytes(
            mode, (5, 1), (RAMP * np.uint16(257)).astype(">u2" if mode[-1] == "B" else "<u2").tobytes()
        )
    way = {"La": ("LA",), "RGBa": ("RGBA",), "PA": ("P",), "CMYK": ("RGB",), "HSV": ("RGB",), "YCbCr": ("RGB",)}
    for step in (*way.get(mode, ()), mode):
        gray = gray.convert(step)
    return gray


MODES = [
    "L",
    "RGB",
    "RGBA",
    "RGBX",
    "LA",
    "La",
    "RGBa",
    "CMYK",
    "YCbCr",
    "HSV",
    "LAB",
    "I",
    "F",
    "I;16",
    "I;16L",
    "I;16B",
]


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("options", [{}, {"crop": (0, 0, 5, 1)}, {"fit": "stretch"}, {"gamma": 1.0 + 1e-12}])
def test_a_mode_shows_its_shades(package, mode, options):
    image = in_mode(mode)
    assert image.mode == mode
    assert np.abs(np.subtract(painted(package, image, **options), RAMP.astype(int))).max() <= 1


@pytest.mark.parametrize("mode", MODES)
def test_a_part_of_a_mode_is_that_part(package, mode):
    """A darker part is not taken for a picture of less white."""
    whole = in_mode(mode)
    assert painted(package, whole, crop=(0, 0, 2, 1))[0][:2] == painted(package, whole)[0][:2]
    assert painted(package, whole, x=-3)[0][:2] == painted(package, whole)[0][3:]


@pytest.mark.parametrize("mode", ["PA", "P"])
def test_palettes(package, mode):
    image = in_mode("P")
    image.putpalette([10, 10, 10, 200, 200, 200])
    image.putdata([0, 1, 1, 0, 1])
    assert painted(package, image.convert(mode)) == [[10, 200, 200, 10, 200]]


def test_a_palette_with_opacity(package):
    image = Image.new("P", (5, 1), 1)
    image.putpalette([9, 9, 9, 255, 200, 200, 200, 0], "RGBA")
    image.putpixel((2, 0), 0)
    assert painted(package, image, before=70) == [[70, 70, 9, 70, 70]]


@pytest.mark.parametrize(
    ("values", "mode", "shades"),
    [
        ([[0.0, 0.2, 0.5, 0.8, 1.0]], "F", [0, 51, 128, 204, 255]),
        ([[-5.0, 51.0, np.nan, 204.0, 255.0]], "F", [0, 51, 0, 204, 255]),
        ([[0.0, 13107.0, np.inf, -np.inf, 65535.0]], "F", [0, 51, 255, 0, 255]),
        ([[0, 13107, 32896, 52428, 65535]], "I", [0, 51, 128, 204, 255]),
        ([[-1, 51, 128, 204, 255]], "I", [0, 51, 128, 204, 255]),
        ([[0, 2**30, 2**31 - 1, -(2**31), 2**29]], "I", [0, 128, 255, 0, 64]),
    ],
)
def test_white_is_what_nothing_is_above(package, values, mode, shades):
    image = Image.fromarray(np.array(values, np.float32 if mode == "F" else np.int32))
    assert image.mode == mode
    assert painted(package, image) == [shades]


def png_of_16_bits(color, rows, *chunks):
    """A PNG file by hand, as Pillow writes none of 16 bits with transparency."""

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    rows = np.asarray(rows, ">u2")
    head = struct.pack(">IIBBBBB", rows.shape[1], rows.shape[0], 16, color, 0, 0, 0)
    data = zlib.compress(b"".join(b"\0" + row.tobytes() for row in rows))
    parts = [chunk(b"IHDR", head), *(chunk(*one) for one in chunks), chunk(b"IDAT", data), chunk(b"IEND", b"")]
    return io.BytesIO(b"\x89PNG\r\n\x1a\n" + b"".join(parts))


def test_sixteen_bits_and_one_shade_that_is_transparent(package):
    file = png_of_16_bits(0, [[0, 13107, 0x8080, 52428, 65535]], (b"tRNS", struct.pack(">H", 0x8080)))
    assert painted(package, Image.open(file), before=77) == [[0, 51, 77, 204, 255]]


def test_sixteen_bits_with_opacity(package):
    file = png_of_16_bits(4, [[[0, 65535], [65535, 0], [65535, 65535], [65535, 32896], [0, 32896]]])
    assert painted(package, Image.open(file), before=100) == [[0, 100, 255, 178, 50]]


def test_sixteen_bits_of_a_dark_png(package):
    """Not brightened for being dark."""
    file = png_of_16_bits(0, [[0, 128, 200, 255, 100]])
    assert max(painted(package, Image.open(file))[0]) <= 1


@pytest.mark.parametrize("most", [255, 1000, 65535])
def test_pgm(package, most, tmp_path):
    values = [round(share * most / 5) for share in range(6)]
    (tmp_path / "ramp.pgm").write_text(f"P2 6 1 {most}\n{' '.join(map(str, values))}\n")
    shades = painted(package, tmp_path / "ramp.pgm", width=6)[0]
    assert np.abs(np.subtract(shades, [0, 51, 102, 153, 204, 255])).max() <= 1


def test_a_dark_pgm_stays_dark(package, tmp_path):
    (tmp_path / "dark.pgm").write_text("P2 2 1 65535\n0 255\n")
    assert painted(package, tmp_path / "dark.pgm", width=2)[0][1] <= 1


def test_pbm_and_xbm_files(package, tmp_path):
    (tmp_path / "a.pbm").write_text("P1 5 1\n1 0 0 1 0\n")
    assert painted(package, tmp_path / "a.pbm") == [[0, 255, 255, 0, 255]]
    (tmp_path / "a.xbm").write_text("#define a_width 5\n#define a_height 1\nstatic char a_bits[] = { 0x09 };\n")
    assert painted(package, tmp_path / "a.xbm") == [[255, 0, 0, 255, 0]]


def test_an_xbm_file_that_pillow_does_not_read(package, tmp_path):
    text = "#define a_width 5\n#define a_height 1\nconst uint8_t a_bits[] PROGMEM = { 0x09 };\n"
    (tmp_path / "a.xbm").write_text("// drawn by hand\n" + text)
    assert painted(package, tmp_path / "a.xbm") == [[255, 0, 0, 255, 0]]


@pytest.mark.parametrize("orientation", range(1, 9))
@pytest.mark.parametrize("ending", ["jpg", "png", "tif"])
@pytest.mark.parametrize("mode", ["L", "RGB"])
def test_cameras_say_which_side_is_up(package, orientation, ending, mode, tmp_path):
    gray = np.repeat(np.repeat(np.array([[0, 255, 120], [60, 30, 200]], np.uint8), 16, 0), 16, 1)
    image = Image.fromarray(gray).convert(mode)
    exif = Image.Exif()
    exif[0x0112] = orientation
    image.save(tmp_path / f"a.{ending}", exif=exif, **({"quality": 100} if ending == "jpg" else {}))
    upright = np.asarray(ImageOps.exif_transpose(Image.open(tmp_path / f"a.{ending}")).convert("L"))
    height, width = upright.shape
    for picture in (tmp_path / f"a.{ending}", Image.open(tmp_path / f"a.{ending}")):
        assert (np.array(painted(package, picture, width, height)) == upright).all()
        assert (np.array(painted(package, picture, width, height, dither="bayer")) == upright).all()


def test_a_figure(package):
    backend = pytest.importorskip("matplotlib.backends.backend_agg")
    figure = pytest.importorskip("matplotlib.figure").Figure(figsize=(0.64, 0.32), dpi=100, facecolor="white")
    own = figure.canvas
    figure.add_axes((0, 0, 0.5, 1), facecolor="black").set(xticks=[], yticks=[])
    shades = np.array(painted(package, figure, 64, 32))
    assert figure.canvas is own
    assert (shades[4:-4, 4:28].max(), shades[:, 40:].min()) == (0, 255)
    backend.FigureCanvasAgg(figure)
    assert painted(package, figure, 64, 32) == shades.tolist()


def test_what_looks_like_a_figure(package):
    """Without matplotlib: a canvas that hands out its pixels after it was drawn."""
    drawn = []
    pixels = np.full((1, 5, 4), 255, np.uint8)
    canvas = SimpleNamespace(draw=lambda: drawn.append(1), buffer_rgba=lambda: memoryview(pixels))
    assert painted(package, SimpleNamespace(canvas=canvas, savefig=None)) == [[255] * 5]
    assert drawn == [1]


@pytest.mark.parametrize("damage", ["cut", "chunk", "noise", "empty"])
def test_damaged_files(package, damage, tmp_path):
    file = io.BytesIO()
    Image.fromarray(np.random.default_rng(1).integers(0, 256, (40, 40), np.uint8)).save(file, "PNG")
    # The name of the second part, the picture's own, is none.
    chunk = file.getvalue().replace(b"IDAT", bytes(4))
    data = {"cut": file.getvalue()[:200], "chunk": chunk, "noise": bytes(range(200)), "empty": b""}[damage]
    (tmp_path / "a.png").write_bytes(data)
    with pytest.raises(OSError, match=r"image file|^picture .*a\.png"):
        package.Framebuffer(8, 8).image(tmp_path / "a.png")


def test_bombs_are_refused(package, tmp_path, monkeypatch):
    Image.new("1", (200, 200)).save(tmp_path / "a.png")
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 100)
    with pytest.raises(Image.DecompressionBombError):
        package.Framebuffer(8, 8).image(tmp_path / "a.png")


def test_the_page_on_pictures_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    page = (Path(__file__).parents[2] / "docs" / "pictures.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.M | re.S)
    assert len(blocks) == 6
    names = {}
    for block in blocks:
        exec(block, names)
    assert names["bytes_sent"]["stable"] < names["bytes_sent"]["blue-noise"] < names["bytes_sent"]["floyd-steinberg"]
    assert str(names["fb"].view(20, 40, 5, 5)).split() == ["#...#", ".#.#.", "..#..", ".#.#.", "#...#"]
    assert set(re.findall(r"`\"([a-z-]+)\"`", page)) >= {"bayer", "blue-noise", "floyd-steinberg", "stable"}
