"""Every call refuses what means nothing with a ValueError that begins with the argument's name, however it paints."""

from __future__ import annotations

from fractions import Fraction
from math import inf, nan

import numpy as np
import pytest

PATH = [(1, 1), (5, 5), (9, 2)]

# The arguments of a call that draws something, by name; and of these the ones that share what is wrong with them.
calls = {
    "line": {"x1": 1, "y1": 1, "x2": 5, "y2": 5},
    "lines": {"segments": [(1, 1, 5, 5)]},
    "polyline": {"points": PATH},
    "triangle": {"x1": 1, "y1": 1, "x2": 5, "y2": 5, "x3": 9, "y3": 1},
    "poly": {"x": 0, "y": 0, "coords": PATH},
    "rect": {"x": 1, "y": 1, "w": 5, "h": 5},
    "round_rect": {"x": 1, "y": 1, "w": 5, "h": 5, "r": 2},
    "circle": {"x": 5, "y": 5, "r": 3},
    "ellipse": {"x": 5, "y": 5, "xr": 3, "yr": 2},
    "arc": {"x": 5, "y": 5, "r": 3, "start": 0, "end": 90},
    "sector": {"x": 5, "y": 5, "r": 3, "start": 0, "end": 90},
}
filled = ["triangle", "poly", "rect", "round_rect", "circle", "ellipse", "sector"]
# What numpy compares element by element, and has no truth.
ARRAY, WORDS = np.array([1, 2, 3]), np.array(["over", "butt"])
wrong_everywhere = {
    "width": [0, -1, nan, inf, -inf, 1e-9],
    "op": ["plus", None, [], ARRAY, WORDS],
    "c": [16, -1, 2**70],
}
wrong_somewhere = {
    "cap": (["line", "lines", "polyline"], ["flat", None, ARRAY, WORDS]),
    "dash": (["line", "lines", "polyline"], [(), (0,), (0.5,), (-1, 2), (nan,), (inf, 1)]),
    "join": (["polyline", "triangle", "poly"], ["sharp", None, ARRAY, WORDS]),
    "algorithm": (["line", "lines"], ["wu", None, ARRAY, WORDS]),
    "rule": (["poly"], ["odd", None, ARRAY, WORDS]),
    "quadrants": (["ellipse"], [-1, 16, 2**70]),
    "segments": (["lines"], [[(1, 2, 3)], [1, 2, 3, 4], [(1, 2, 3, 4), (1, 2)], [(1, 1, nan, 2)]]),
    "points": (["polyline"], [[1], [1, 2, 3], [(1, 2, 3)], 5, [(1, 2), 3], [(1, nan)]]),
    "coords": (["poly"], [[1], [1, 2, 3], [(1, 2, 3)], 5, [(1, 2), 3], [(1, nan)]]),
}


def wrong(call):
    """Pairs of an argument's name and a value that it must not have."""
    yield from ((name, value) for name, values in wrong_everywhere.items() for value in values)
    yield from ((name, value) for name, (where, values) in wrong_somewhere.items() if call in where for value in values)
    for name, value in calls[call].items():
        if isinstance(value, int):
            yield from ((name, number) for number in (nan, inf, Fraction(10**400, 3)))
            if name in ("w", "h", "r", "xr", "yr"):
                yield from ((name, number) for number in (-1, -0.5, -(2**70)))


@pytest.fixture(params=["aliased", "supersampled", "filtered"])
def antialias(request, package):
    return {"aliased": None, "supersampled": package.Supersample(4), "filtered": package.ConeFilter()}[request.param]


@pytest.mark.parametrize("call", calls)
def test_what_means_nothing_is_refused_by_name(package, antialias, call):
    fb = package.Framebuffer(20, 10, 4)
    for fill in [False, True] if call in filled else [False]:
        style = {"antialias": antialias, **({"fill": True} if fill else {})}
        for name, value in wrong(call):
            arguments = {**calls[call], **style, name: value}
            with pytest.raises(ValueError, match=rf"^{name}\b"):
                getattr(fb, call)(**arguments)
        assert not fb.pixels.any()
        getattr(fb, call)(**calls[call], **style)
        assert fb.pixels.any()
        fb.clear()


@pytest.mark.parametrize("fill", [False, True])
@pytest.mark.parametrize("number", [Fraction(1, 3), Fraction(-(10**30), 7), 10**400, -(10**400), 1e308, -1e308])
def test_polygons_take_fractions_and_numbers_of_any_size(package, antialias, fill, number):
    """Sums of two floats beyond the range of floats are numbers too."""
    fb = package.Framebuffer(20, 10, 4)
    for x, y, coords in (
        (number, 0, PATH),
        (0, number, [(number, 1), (5, 5), (2, 9)]),
        (number, number, [(number, 1), (5, number), (2, 9)]),
    ):
        fb.poly(x, y, coords, fill=fill, antialias=antialias)
    fb.poly(
        number, 0, [(-number, 0), (20 - number, 0), (20 - number, 10), (-number, 10)], fill=fill, antialias=antialias
    )
    # What was moved there and back again stands where it was, as far as numbers tell.
    assert fb.pixels.any() or isinstance(number, float)


@pytest.mark.parametrize("width", [2**63, 2**1000, 1e300])
def test_dashes_of_enormous_length_and_width(package, antialias, width):
    fb = package.Framebuffer(20, 10, 4)
    for dash in ((width,), (1, width), (width, 1, 3)):
        fb.polyline(PATH, width=width, dash=dash, antialias=antialias)
        fb.line(-(2**63), 3, 2**63, 5, dash=dash, antialias=antialias)
        fb.line(0, 0, 9, 9, width=width, dash=(3, 3), antialias=antialias)
    assert fb.pixels.any()


@pytest.mark.parametrize("call", calls)
def test_arrays_are_no_numbers(package, antialias, call):
    fb = package.Framebuffer(20, 10, 4)
    numbers = [name for name, value in calls[call].items() if isinstance(value, int)]
    for name in [*numbers, "width"]:
        for value in (ARRAY, WORDS, [1, 2]):
            with pytest.raises(TypeError, match=rf"^{name} must be a number\b"):
                getattr(fb, call)(**{**calls[call], "antialias": antialias, name: value})
    assert not fb.pixels.any()


def test_samples_and_filters_take_numpys_numbers(package):
    assert package.Supersample(np.int64(4)) == package.Supersample(4)
    assert repr(package.ConeFilter(np.float32(1.5), resolution=np.int16(16))) == repr(
        package.ConeFilter(1.5, resolution=16)
    )
    for wrong_number in (True, 4.0, np.float64(4), "4", ARRAY):
        with pytest.raises(TypeError, match=r"^n must be a whole number"):
            package.Supersample(wrong_number)
    with pytest.raises(ValueError, match=r"^reference must be"):
        package.Supersample(4, WORDS)


@pytest.mark.parametrize("call", ["rect", "circle", "ellipse", "arc", "line"])
def test_a_width_is_one_if_its_nearest_256th_is(package, call):
    pictures = []
    for width in (1, 1.0, 1.001, np.float32(1), Fraction(999, 1000)):
        fb = package.Framebuffer(20, 10, 4)
        getattr(fb, call)(**calls[call], width=width)
        pictures.append(fb.pixels.tobytes())
    assert len(set(pictures)) == 1
