"""Dithers against their definitions, and what a film that is dithered costs on the wire."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from PIL import Image, ImageFilter
from void_and_cluster import ranks, text

from paneldraw.raster import blue_noise

DITHERS = ["bayer", "floyd-steinberg", "blue-noise", "stable"]
grays = arrays.arrays(np.uint8, st.tuples(st.integers(1, 12), st.integers(1, 12)))
depths = st.sampled_from([1, 2, 4, 8])
gammas = st.sampled_from([1.0, 2.2, 0.45])


def painted(package, picture, depth=1, x=0, y=0, width=12, height=12, before=0, **options):
    fb = package.Framebuffer(width, height, depth)
    fb.pixels[...] = before
    fb.image(picture, x, y, **options)
    return fb.pixels.copy()


def value(gray, top, gamma, invert):
    """What a gray is in levels."""
    gray = 255 - gray if invert else gray
    return gray * top / 255 if gamma == 1 else (gray / 255) ** gamma * top


def diffused(gray, top, gamma=1.0, invert=False):
    """Floyd and Steinberg's: the error of each pixel goes on in sixteenths."""
    height, width = gray.shape
    levels = np.empty((height, width), np.uint8)
    below = [0.0] * (width + 2)
    for y in range(height):
        wanted, below = below, [0.0] * (width + 2)
        right = 0.0
        for x, shade in enumerate(gray[y].tolist(), 1):
            exact = value(shade, top, gamma, invert) + wanted[x] + right
            level = min(max(int(exact + 0.5), 0), top)
            error = (exact - level) / 16
            levels[y, x - 1] = level
            right = error * 7
            below[x - 1] += error * 3
            below[x] += error * 5
            below[x + 1] += error
    return levels


def by_thresholds(gray, top, matrix, gamma=1.0, invert=False):
    """The whole part of the value plus a threshold, in the middle of its share."""
    side, count = len(matrix), matrix.max() + 1
    return np.array(
        [
            [
                int(value(int(shade), top, gamma, invert) + (2 * int(matrix[y % side, x % side]) + 1) / (2 * count))
                for x, shade in enumerate(row)
            ]
            for y, row in enumerate(gray)
        ]
    )


BAYER = np.zeros((1, 1), int)
for _ in range(3):
    BAYER = np.block([[4 * BAYER, 4 * BAYER + 2], [4 * BAYER + 3, 4 * BAYER + 1]])


@given(grays, depths, gammas, st.booleans())
def test_errors_are_diffused(package, gray, depth, gamma, invert):
    options = {"dither": "floyd-steinberg", "gamma": gamma, "invert": invert}
    height, width = gray.shape
    found = painted(package, gray, depth, width=width, height=height, **options)
    assert (found == diffused(gray, 2**depth - 1, gamma, invert)).all()


@pytest.mark.parametrize(("name", "matrix"), [("bayer", BAYER), ("blue-noise", blue_noise.thresholds().astype(int))])
@given(grays, depths, st.booleans())
def test_thresholds_are_added(package, name, matrix, gray, depth, invert):
    height, width = gray.shape
    found = painted(package, gray, depth, width=width, height=height, dither=name, invert=invert)
    assert (found == by_thresholds(gray, 2**depth - 1, matrix, invert=invert)).all()


@pytest.mark.parametrize("dither", [None, *DITHERS])
@given(st.data())
def test_what_is_cut_off_does_not_matter(package, dither, data):
    """What is seen of a picture is that part of the whole."""
    gray = data.draw(arrays.arrays(np.uint8, st.tuples(st.integers(1, 30), st.integers(1, 30))))
    x, y = data.draw(st.integers(-25, 9)), data.draw(st.integers(-25, 9))
    picture = Image.fromarray(gray) if data.draw(st.booleans()) else gray
    page = np.zeros((70, 70), np.uint8)
    height, width = gray.shape
    page[30 + y : 30 + y + height, 30 + x : 30 + x + width] = painted(
        package, gray, width=width, height=height, dither=dither
    )
    assert (painted(package, picture, x=x, y=y, dither=dither) == page[30:42, 30:42]).all()


@pytest.mark.parametrize("dither", DITHERS)
@pytest.mark.parametrize("gamma", [1.0, 2.2])
@pytest.mark.parametrize("gray", [0, 20, 100, 128, 200, 255])
def test_an_area_keeps_its_brightness(package, dither, gamma, gray):
    levels = painted(package, np.full((64, 64), gray, np.uint8), 1, width=64, height=64, dither=dither, gamma=gamma)
    # 1/64 for Bayer's thresholds, 1/50 for what a stable one may hold on to; errors leave by the edges.
    assert abs(levels.mean() - (gray / 255) ** gamma) < 0.03


@given(grays, st.data())
def test_a_stable_level_stays_within_a_fiftieth(package, gray, data):
    height, width = gray.shape
    before = data.draw(arrays.arrays(np.uint8, gray.shape, elements=st.integers(0, 3)))
    found = painted(package, gray, 2, width=width, height=height, before=before, dither="stable")
    matrix = blue_noise.thresholds().astype(int)
    for y in range(height):
        for x in range(width):
            exact = int(gray[y, x]) * 3 / 255
            reach = min(0.02, exact % 1, 1 - exact % 1)
            placed = exact + (2 * int(matrix[y, x]) + 1) / 512
            held = before[y, x] - reach <= placed < before[y, x] + 1 + reach
            assert found[y, x] == (before[y, x] if held else int(placed))


def test_a_stable_picture_shown_again_does_not_change(package):
    gray = np.random.default_rng(1).integers(0, 256, (12, 12), np.uint8)
    once = painted(package, gray, dither="stable")
    assert (painted(package, gray, before=once, dither="stable") == once).all()


def test_gamma_and_inversion_of_nearest_levels(package):
    ramp = np.arange(256, dtype=np.uint8)[np.newaxis]
    for gamma in (0.5, 1.0, 2.2):
        found = painted(package, ramp, 4, width=256, height=1, gamma=gamma)
        assert found.tolist() == [[round((k / 255) ** gamma * 15) for k in range(256)]]
    found = painted(package, ramp, 4, width=256, height=1, invert=True)
    assert (found == painted(package, ramp, 4, width=256, height=1)[:, ::-1]).all()


@pytest.mark.parametrize("bad", [0, -1, 101, float("nan"), float("inf")])
def test_gammas_are_positive(package, bad):
    with pytest.raises(ValueError, match=r"^gamma must be "):
        package.Framebuffer(4, 4).image(np.zeros((2, 2), np.uint8), gamma=bad)


def test_blue_noise_is_what_void_and_cluster_finds():
    assert text() == blue_noise._TEXT
    assert sorted(ranks().ravel().tolist()) == list(range(64 * 64))


def test_blue_noise_has_no_low_frequencies():
    """Power of a threshold's pattern below a tenth of the sampling rate: a small part of white noise's."""
    lit = (blue_noise.thresholds() < 128) - 0.5
    power = np.abs(np.fft.fft2(lit)) ** 2 / lit.size
    frequency = np.hypot(*np.meshgrid(np.fft.fftfreq(64), np.fft.fftfreq(64)))
    assert power[frequency < 0.1].mean() < 0.02 * power.mean()


# -- Films


def film(kind, frames=40):
    """A ball before shades that stand still; with a camera's noise; or in light that comes and goes."""
    random = np.random.default_rng(5)
    y, x = np.mgrid[0:64, 0:128]
    still = 60 + 60 * np.sin(x / 23) + 60 * np.cos(y / 17 + x / 40)
    for number in range(frames):
        distance = (x - 64 - 45 * np.cos(number / 15)) ** 2 + (y - 32 - 18 * np.sin(number / 11)) ** 2
        picture = np.where(distance < 144, 255 - distance, still)
        if kind == "noise":
            picture = picture + random.normal(0, 4, picture.shape)
        elif kind == "light":
            picture = picture * (0.8 + 0.2 * np.sin(number / 9))
        yield np.clip(picture, 0, 255).astype(np.uint8)


def cost(package, kind, dither):
    """Bytes of a film on the wire after its first picture, and how far what an eye sees is off at most."""
    panel = package.open_panel("sim://ssd1306?size=128x64")
    fb = panel.framebuffer()
    sent, off = [], []
    blurred = ImageFilter.GaussianBlur(3)
    for picture in film(kind):
        fb.image(picture, dither=dither)
        sent.append(panel.show(fb).wire_bytes)
        seen, wanted = (Image.fromarray(one).filter(blurred) for one in (fb.pixels * np.uint8(255), picture))
        off.append(np.abs(np.asarray(seen).astype(int) - np.asarray(wanted)).mean())
    panel.close()
    return sum(sent[1:]), max(off)


@pytest.mark.parametrize("kind", ["still", "noise", "light"])
def test_a_stable_film_costs_less_than_half(kind):
    import paneldraw

    stable, stable_off = cost(paneldraw, kind, "stable")
    diffused_bytes, _ = cost(paneldraw, kind, "floyd-steinberg")
    assert stable < diffused_bytes / 2
    assert stable_off < 8


def test_a_panel_shows_by_the_same_dithers(package):
    gray = np.tile(np.linspace(0, 255, 128).astype(np.uint8), (64, 1))
    for dither in (None, *DITHERS):
        panel = package.open_panel("sim://ssd1306?size=128x64")
        fb = panel.framebuffer()
        # At first there is nothing to keep.
        fb.image(gray, dither="blue-noise" if dither == "stable" else dither, gamma=2.2)
        for source in (Image.fromarray(gray), deep(package, gray)):
            panel.show(source, dither=dither, gamma=2.2)
            assert (panel.simulated.pixels == fb.pixels).all()
        panel.close()


def deep(package, gray):
    fb = package.Framebuffer(128, 64, 8)
    fb.image(gray)
    return fb


def test_a_panel_keeps_what_is_stable(package):
    sent = {}
    for dither in ("floyd-steinberg", "stable"):
        panel = package.open_panel("sim://ssd1306?size=128x64")
        sent[dither] = [panel.show(Image.fromarray(one), dither=dither).wire_bytes for one in film("noise", 6)]
        panel.close()
    assert sum(sent["stable"][1:]) < sum(sent["floyd-steinberg"][1:]) / 2


def test_a_panel_shows_transparent_as_dark(package):
    panel = package.open_panel("sim://ssd1306?size=128x64")
    image = Image.new("RGBA", (128, 64), (255, 255, 255, 0))
    image.putpixel((3, 4), (255, 255, 255, 255))
    panel.show(image)
    assert np.argwhere(panel.simulated.pixels).tolist() == [[4, 3]]
    panel.close()
