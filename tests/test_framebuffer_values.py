"""Framebuffers as values: copies, pickles, references; their memory, their windows, what help says of their calls."""

from __future__ import annotations

import copy
import gc
import inspect
import pickle
import pydoc
import sys
import weakref

import numpy as np
import pytest

# -- Copies

WAYS = {
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
    "pickle": lambda fb: pickle.loads(pickle.dumps(fb)),
    "old pickle": lambda fb: pickle.loads(pickle.dumps(fb, 2)),
    "method": lambda fb: fb.copy(),
}


def drawn_on(fb):
    fb.line(0, 0, 9, 4, 9)
    fb.circle(6, 3, 2, 5)
    return fb


@pytest.fixture
def badge(package, monkeypatch):
    """A subclass that `pickle` finds."""

    class Badge(package.Framebuffer):
        def __init__(self, name):
            super().__init__(12, 7, 4, antialias=package.Supersample(3))
            self.name = name
            self.notes = ["new"]

    Badge.__qualname__ = "Badge"
    monkeypatch.setattr(sys.modules[__name__], "Badge", Badge, raising=False)
    return Badge


@pytest.mark.parametrize("way", WAYS)
def test_a_copy_is_equal_and_has_pixels_of_its_own(package, way):
    fb = drawn_on(package.Framebuffer(12, 7, 4, antialias=package.ConeFilter(1.5)))
    other = WAYS[way](fb)
    assert other == fb
    assert type(other) is type(fb)
    assert (other.width, other.height, other.depth, other.antialias) == (12, 7, 4, package.ConeFilter(1.5))
    before = fb.pixels.copy()
    other.fill(3)
    assert (other.pixels == 3).all()
    assert (fb.pixels == before).all()


@pytest.mark.parametrize("way", WAYS)
def test_a_copy_of_a_view_is_what_it_shows(package, way):
    fb = drawn_on(package.Framebuffer(12, 7, 4))
    view = fb.view(3, 1, 6, 4)
    other = WAYS[way](view)
    assert other == view
    before = fb.pixels.copy()
    other.fill(1)
    assert (fb.pixels == before).all()


@pytest.mark.parametrize("way", WAYS)
def test_a_copy_of_a_subclass_has_its_attributes(badge, way):
    fb = drawn_on(badge("one"))
    other = WAYS[way](fb)
    assert type(other) is badge
    assert (other.name, other.notes, other.antialias) == ("one", ["new"], fb.antialias)
    assert other == fb
    other.name = "two"
    other.clear()
    assert fb.name == "one"
    assert fb.pixels.any()
    if way in ("deepcopy", "pickle", "old pickle"):
        other.notes.append("old")
        assert fb.notes == ["new"]


def test_a_copy_is_not_confined(package):
    fb = package.Framebuffer(6, 1)
    with fb.clip(1, 0, 2, 1):
        other = fb.copy()
        other.fill(1)
    assert str(other) == "######"


def test_weak_references(package, badge):
    fb = package.Framebuffer(6, 2)
    for kept in (fb, fb.view(1, 0, 2, 2), badge("one")):
        reference = weakref.ref(kept)
        assert reference() is kept
    made = [package.Framebuffer(6, 2), badge("one")]
    made.append(made[0].view(0, 0, 1, 1))
    references = [weakref.ref(each) for each in made]
    made.clear()
    del kept
    gc.collect()
    assert [reference() for reference in references] == [None] * 3


# -- Memory


def test_the_memory_cannot_be_pulled_away(package):
    fb = package.Framebuffer(300, 200, 8)
    pixels = fb.pixels
    view = fb.view(10, 10, 50, 50)
    for array in (pixels, view.pixels, pixels.base):
        with pytest.raises((ValueError, AttributeError)):
            array.resize((1, 1), refcheck=False)
    memory = pixels
    while isinstance(memory, np.ndarray):
        memory = memory.base
    if isinstance(memory, memoryview):
        memory = memory.obj
    if isinstance(memory, bytearray):
        for change in (memory.clear, lambda: memory.extend(bytes(10**6))):
            with pytest.raises(BufferError):
                change()
    fb.fill(255)
    view.line(0, 0, 49, 49, 7, width=3, antialias=package.Supersample(4))
    assert pixels[0, 0] == 255
    assert (view.pixels == pixels[10:60, 10:60]).all()
    assert pixels[20, 20] == 7


# -- Windows


def test_a_clip_that_is_entered_twice(package):
    fb = package.Framebuffer(6, 1)
    clip = fb.clip(1, 0, 4, 1)
    with clip:
        with fb.clip(0, 0, 3, 1):
            with clip:
                fb.fill(1)
                assert str(fb) == ".##..."
            fb.clear()
            fb.fill(1)
            assert str(fb) == ".##..."
        fb.fill(1)
        assert str(fb) == ".####."
    fb.fill(1)
    assert str(fb) == "######"
    with clip:
        fb.clear()
    assert str(fb) == "#....#"


def test_clips_left_out_of_order(package):
    fb = package.Framebuffer(6, 1)
    first, second = fb.clip(0, 0, 4, 1), fb.clip(2, 0, 4, 1)
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    fb.fill(1)
    assert str(fb) == "..####"
    second.__exit__(None, None, None)
    fb.fill(1)
    assert str(fb) == "######"


def test_equal_clips_are_left_one_by_one(package):
    fb = package.Framebuffer(6, 1)
    first, second = fb.clip(1, 0, 2, 1), fb.clip(1, 0, 2, 1)
    with first:
        with second:
            pass
        fb.fill(1)
        assert str(fb) == ".##..."
    fb.fill(1)
    assert str(fb) == "######"


def test_a_view_taken_inside_a_clip_stays_inside_it(package):
    fb = package.Framebuffer(8, 3)
    with fb.clip(2, 0, 3, 2):
        view = fb.view(1, 1, 6, 2)
        outside = fb.view(6, 2, 2, 1)
    for part in (view, view.view(0, 0, 6, 2), outside):
        with part.clip(0, 0, 99, 99):
            part.fill(1)
        part.fill(1)
        part.line(-9, 0, 9, 0)
        part.circle(2, 0, 9, fill=True, antialias=package.Supersample(4))
    assert str(fb) == "........\n..###...\n........"


# -- What help says

CALLS = (
    *("fill", "clear", "pixel", "hline", "vline", "line", "lines", "points", "polyline", "rect", "round_rect"),
    *("circle", "ellipse", "arc", "sector", "triangle", "poly", "text", "image", "blit", "scroll", "clip", "view"),
    *("copy", "to_image", "save"),
)
LENGTHS = ("x", "y", "r", "w", "h", "x1", "y1", "x2", "y2", "x3", "y3", "xr", "yr", "start", "end", "width")
WORDS = ("op", "cap", "join", "rule", "edges", "anchor", "algorithm", "s")


@pytest.mark.parametrize("name", CALLS)
def test_signatures_are_pythons(package, name):
    signature = inspect.signature(getattr(package.Framebuffer, name))
    for parameter in list(signature.parameters.values())[1:]:
        said = inspect.formatannotation(parameter.annotation).strip("'")
        assert not any(word in said for word in ("_empty", "double", "long", "ssize_t", "bint", "unicode", "cython"))
        if parameter.name in LENGTHS and name != "view":
            assert said == ("int | float | None" if parameter.default is None else "int | float")
        if parameter.name in WORDS:
            assert said == "str"


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("Supersample", "(n: int = 4, reference: str = center)"),
        ("ConeFilter", "(radius: float = 1.0, filter: str = cone, resolution: int = 32)"),
        (
            "Framebuffer",
            "(width: SupportsIndex, height: SupportsIndex, depth: int = 1, *, antialias: Antialias = None)",
        ),
    ],
)
def test_signatures_of_classes_are_pythons(package, name, said):
    kind = getattr(package, name)

    class Kind(kind):
        pass

    class Other(kind):
        def __init__(self, size: int) -> None:
            pass

    for each, wanted in ((kind, said), (Kind, said), (Other, "(size: int) -> None")):
        assert str(inspect.signature(each)).replace("'", "") == wanted
    assert f"{name}{said}" in pydoc.plain(pydoc.render_doc(kind)).replace("'", "")


# -- Anti-aliasing made inside a call


@pytest.mark.parametrize(
    ("name", "arguments", "different"),
    [
        ("Supersample", (), (5,)),
        ("Supersample", (3, "corner"), (3, "center")),
        ("ConeFilter", (), (1.5,)),
        ("ConeFilter", (2.5, "gaussian", 16), (2.5, "gaussian", 17)),
    ],
)
def test_anti_aliasing_is_a_value(package, name, arguments, different):
    kind = getattr(package, name)
    kept, other = kind(*arguments), kind(*different)
    assert kind(*arguments) == kept != other
    assert hash(kind(*arguments)) == hash(kept)
    assert {kept: 1}[kind(*arguments)] == 1
    for same in (pickle.loads(pickle.dumps(kept)), copy.copy(kept), copy.deepcopy(kept)):
        assert same == kept
        assert type(same) is kind
    first, second, third = (package.Framebuffer(20, 15, 8) for _ in range(3))
    for _ in range(3):
        for fb, antialias in (
            (first, kept),
            (second, kind(*arguments)),
            (third, pickle.loads(pickle.dumps(kept))),
        ):
            fb.line(1, 2, 17, 11, 90, width=2.5, op="add", antialias=antialias)
            fb.circle(9, 7, 5.25, 90, width=2, op="add", antialias=antialias)
            fb.poly(0, 0, [(3, 1), (18, 4), (8, 14)], 90, fill=True, op="add", antialias=antialias)
    assert first == second == third
