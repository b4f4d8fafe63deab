"""What is not an argument is refused, by its name and before anything is drawn."""

from __future__ import annotations

import copy
import enum
import pickle
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

from paneldraw import Framebuffer

NOT_NUMBERS = ["1", b"1", None, 1j, [1], (), {}, np.zeros(2), np.array([1.0]), ..., Decimal("sNaN")]
NOT_FINITE = [float("nan"), float("inf"), float("-inf"), np.float32("nan"), Decimal("Infinity"), Fraction(10**400)]
NOT_WHOLE = [1.0, 1.5, np.float32(1), "1", b"1", 1j, [1], float("nan"), Decimal(1), Fraction(1)]

ONE_PIXEL = np.full((1, 1), 255, np.uint8)

# Calls that take a number by each name, all else being well.
COORDINATES = {
    "pixel": {"x": 1, "y": 1, "c": 1},
    "hline": {"x": 1, "y": 1, "w": 2},
    "vline": {"x": 1, "y": 1, "h": 2},
    "line": {"x1": 0, "y1": 0, "x2": 3, "y2": 3},
    "rect": {"x": 0, "y": 0, "w": 3, "h": 3},
    "circle": {"x": 2, "y": 2, "r": 2},
    "text": {"s": "a", "x": 0, "y": 0},
    "image": {"picture": ONE_PIXEL, "x": 0, "y": 0},
}
NAMED = [(call, name) for call, good in COORDINATES.items() for name in good if name not in ("c", "s", "picture")]
SIZED = [("hline", "w"), ("vline", "h"), ("rect", "w"), ("rect", "h"), ("circle", "r")]
# Calls that take a level and an operation.
PAINTING = {
    **{call: good for call, good in COORDINATES.items() if call != "image"},
    "lines": {"segments": [(0, 0, 3, 3)]},
    "points": {"xy": [(0, 0)]},
}


@pytest.fixture
def fb(package):
    return package.Framebuffer(8, 8, depth=2)


def refused(fb, error, message, call, **arguments):
    with pytest.raises(error, match=message):
        getattr(fb, call)(**arguments)
    assert not fb.pixels.any()


@pytest.mark.parametrize("bad", NOT_NUMBERS, ids=repr)
@pytest.mark.parametrize(("call", "name"), NAMED)
def test_what_is_no_number_is_no_coordinate(fb, call, name, bad):
    refused(fb, TypeError, rf"^{name} must be a number, not ", call, **{**COORDINATES[call], name: bad})


@pytest.mark.parametrize("bad", NOT_FINITE, ids=str)
@pytest.mark.parametrize(("call", "name"), NAMED)
def test_coordinates_are_finite(fb, call, name, bad):
    refused(fb, ValueError, rf"^{name} must be ", call, **{**COORDINATES[call], name: bad})


@pytest.mark.parametrize("bad", [-1, -0.6, -(2**70)])
@pytest.mark.parametrize(("call", "name"), SIZED)
def test_sizes_are_not_negative(fb, call, name, bad):
    refused(fb, ValueError, rf"^{name} must not be negative", call, **{**COORDINATES[call], name: bad})


@pytest.mark.parametrize("bad", [-1, 4, 2**31, 2**64, -(2**70)])
@pytest.mark.parametrize("call", PAINTING)
def test_levels_are_in_range(fb, call, bad):
    refused(fb, ValueError, "^c must be a level from 0 to 3, not ", call, **{**PAINTING[call], "c": bad})


@pytest.mark.parametrize("bad", NOT_WHOLE, ids=repr)
@pytest.mark.parametrize("call", PAINTING)
def test_levels_are_whole(fb, call, bad):
    refused(fb, TypeError, "^c must be a whole number", call, **{**PAINTING[call], "c": bad})


@pytest.mark.parametrize("bad", ["and", "", "OVER", None, 1, [], {}])
@pytest.mark.parametrize("call", PAINTING)
def test_operations_are_known(fb, call, bad):
    message = "^op must be one of 'over', 'xor', 'add', 'max', 'clear', not "
    refused(fb, ValueError, message, call, **{"c": 1, **PAINTING[call], "op": bad})


@pytest.mark.parametrize("call", ["line", "lines"])
def test_lines_have_a_style_that_exists(fb, call):
    good = PAINTING[call]
    for width in (0, -1, 0.001, -(2**70)):
        refused(fb, ValueError, "^width must be at least 1/256", call, **good, width=width)
    for width in NOT_FINITE:
        refused(fb, ValueError, "^width must be ", call, **good, width=width)
    for width in (None, "2", 1j, [1]):
        refused(fb, TypeError, "^width must be a number", call, **good, width=width)
    for cap in ("", "flat", None, 1, []):
        refused(fb, ValueError, r"^cap must be .*'butt', 'square', 'round', not ", call, **good, cap=cap)
    for antialias in (4, True, "4", 0, [], object()):
        refused(fb, TypeError, "^antialias must be None, a Supersample", call, **good, antialias=antialias)


@pytest.mark.parametrize("call", [*COORDINATES, "lines", "points", "fill", "clear"])
def test_unknown_keywords_are_refused(fb, call):
    good = {**COORDINATES, **PAINTING, "fill": {"c": 1}, "clear": {}}[call]
    refused(fb, TypeError, "colour", call, **good, colour=1)


@pytest.mark.parametrize("call", COORDINATES)
def test_missing_arguments_are_an_error(fb, call):
    with pytest.raises(TypeError):
        getattr(fb, call)()


def test_text_is_a_string_in_a_font_by_an_anchor(fb):
    for s in (5, b"a", None, ["a"]):
        refused(fb, TypeError, "string", "text", s=s, x=0, y=0)
    for font in ("6x8", 8, object()):
        refused(fb, TypeError, "^font must be ", "text", s="a", x=0, y=0, font=font)
    for anchor in ("", "x", "tl", None):
        refused(fb, ValueError, "^anchor must be ", "text", s="a", x=0, y=0, anchor=anchor)


@pytest.mark.parametrize("bad", NOT_WHOLE, ids=repr)
@pytest.mark.parametrize("name", ["width", "height", "depth"])
def test_sizes_are_whole(package, name, bad):
    with pytest.raises(TypeError, match=f"^{name} must be a whole number, not "):
        package.Framebuffer(**{"width": 8, "height": 8, name: bad})


@pytest.mark.parametrize("bad", [0, -1, 65537, 2**31, 2**64, -(2**70)])
@pytest.mark.parametrize("name", ["width", "height"])
def test_sizes_are_in_range(package, name, bad):
    with pytest.raises(ValueError, match=f"^{name} must be from 1 to 65536 pixels, not "):
        package.Framebuffer(**{"width": 8, "height": 8, name: bad})


@pytest.mark.parametrize("bad", [0, -1, 3, 5, 16, 2**70])
def test_depths_are_known(package, bad):
    with pytest.raises(ValueError, match=r"^depth must be 1, 2, 4 or 8 bits a pixel, not "):
        package.Framebuffer(8, 8, bad)


def test_framebuffers_take_no_other_arguments(package):
    with pytest.raises(TypeError, match="colours"):
        package.Framebuffer(8, 8, colours=2)
    with pytest.raises(TypeError):
        package.Framebuffer(8)
    with pytest.raises(TypeError):
        package.Framebuffer(8, 8, 1, None)
    for bad in (4, True, "4"):
        with pytest.raises(TypeError, match=r"^antialias must be None, a Supersample"):
            package.Framebuffer(8, 8, antialias=bad)


@pytest.mark.parametrize("bad", [0, 17, -1, 2**70])
def test_numbers_of_samples_are_in_range(package, bad):
    with pytest.raises(ValueError, match=r"^n must be from 1 to 16"):
        package.Supersample(bad)


@pytest.mark.parametrize("bad", [2.0, True, "4", None, 1j])
def test_numbers_of_samples_are_whole(package, bad):
    with pytest.raises(TypeError, match=r"^n must be a whole number"):
        package.Supersample(bad)


@pytest.mark.parametrize("bad", ["middle", "", None, 1])
def test_reference_points_are_known(package, bad):
    with pytest.raises(ValueError, match=r'^reference must be "center" or "corner", not '):
        package.Supersample(4, bad)


@pytest.mark.parametrize("bad", [0, -1])
def test_scales_are_positive(fb, tmp_path, bad):
    with pytest.raises(ValueError, match=r"^scale must be 1 or more"):
        fb.to_image(bad)
    with pytest.raises(ValueError, match=r"^scale must be 1 or more"):
        fb.save(tmp_path / "a.png", bad)


@pytest.mark.parametrize("bad", [1.5, "2", None])
def test_scales_are_whole(fb, bad):
    with pytest.raises(TypeError, match=r"^scale must be a whole number"):
        fb.to_image(bad)


class Op(str, enum.Enum):
    XOR = "xor"


@pytest.mark.parametrize("one", [True, np.int8(1), np.uint64(1), np.array(1), np.bool_(True)])
def test_whatever_is_a_whole_number_serves(package, one):
    fb = package.Framebuffer(3, 3)
    fb.rect(one, one, one, one, int(one))
    fb.line(one, 0, one, 0)
    assert fb.pixels.tolist() == [[0, 1, 0], [0, 1, 0], [0, 0, 0]]


@pytest.mark.parametrize("number", [1.2, np.float32(1.2), np.float16(1.2), Fraction(6, 5), Decimal("1.2")])
def test_whatever_is_a_number_serves(package, number):
    fb = package.Framebuffer(3, 3)
    fb.line(number, number, number, number)
    fb.circle(number, number, 0, op="xor")
    fb.pixel(number, number, 1, op="xor")
    assert fb.pixels.tolist() == [[0, 0, 0], [0, 1, 0], [0, 0, 0]]


def test_whatever_is_a_string_serves(package):
    fb = package.Framebuffer(8, 8)
    fb.text(np.str_("a"), 0, 0, anchor=np.str_("lt"))
    assert fb.pixels.any()
    fb.text("a", 0, 0, op=Op.XOR)
    assert not fb.pixels.any()


def test_a_framebuffer_that_was_never_made_is_an_error_not_a_crash(package):
    class Forgetful(package.Framebuffer):
        def __init__(self):
            """Without its parent's."""

    fb = Forgetful()
    for call, arguments in PAINTING.items():
        with pytest.raises(AttributeError):
            getattr(fb, call)(**arguments)
    for call in (
        lambda: fb.width,
        lambda: fb.fill(1),
        lambda: fb.pixel(0, 0),
        lambda: fb.image(ONE_PIXEL),
        lambda: fb.blit(ONE_PIXEL, 0, 0),
        lambda: fb.scroll(1, 1),
        lambda: package.Framebuffer(2, 2).blit(fb, 0, 0),
    ):
        with pytest.raises(AttributeError):
            call()


@pytest.mark.parametrize(
    ("name", "call"),
    [
        ("fill_rect", "fb.rect(1, 1, 2, 2, 1, fill=True)"),
        ("rectangle", "fb.rect(1, 1, 2, 2, 1)"),
        ("rounded_rect", "fb.round_rect(0, 0, 6, 6, 2, 1)"),
    ],
)
def test_calls_of_other_libraries_are_answered_with_ours(package, fb, name, call):
    ours = call.removeprefix("fb.").partition("(")[0]
    with pytest.raises(AttributeError, match=rf"a framebuffer has no {name}: write {ours}\("):
        getattr(fb, name)
    exec(call, {"fb": fb})
    assert fb.pixels.any()
    assert not hasattr(fb, name)
    assert name not in dir(fb)
    assert ours in dir(fb)
    assert copy.deepcopy(fb) == fb
    if type(fb) is Framebuffer:
        assert pickle.loads(pickle.dumps(fb)) == fb

    class Own(package.Framebuffer):
        pass

    setattr(Own, name, lambda self: "own")
    assert getattr(Own(2, 2), name)() == "own"
    assert name in dir(Own(2, 2))
