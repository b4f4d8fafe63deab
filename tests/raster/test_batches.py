"""Many lines or points in one call are as many calls of one."""

from __future__ import annotations

import sys
from array import array
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import paneldraw

WIDTH, HEIGHT = 24, 16

kinds = st.sampled_from(
    [
        np.int8,
        np.uint8,
        np.int16,
        np.int32,
        np.int64,
        np.uint64,
        np.float16,
        np.float32,
        np.float64,
        np.bool_,
        ">i4",
        ">f8",
    ]
)
antialias = st.sampled_from([None, (2, "center"), (3, "corner")])
styles = st.fixed_dictionaries({"width": st.sampled_from([1, 2, 3.25]), "cap": st.sampled_from(["square", "butt"])})


def tables(columns):
    """Arrays of any kind of numbers, mostly near the picture, some anywhere; in memory in any order."""

    def of_kind(kind):
        near = {"i": st.integers(-30, 50), "u": st.integers(0, 50), "f": st.floats(-30, 50, width=16)}
        elements = st.one_of(near.get(np.dtype(kind).kind, st.booleans()), arrays.from_dtype(np.dtype(kind), **finite))
        return arrays.arrays(kind, st.tuples(st.integers(0, 5), st.just(columns)), elements=elements)

    finite = {"allow_nan": False, "allow_infinity": False}
    return kinds.flatmap(of_kind)


def both(package, many, one, rows):
    """A picture drawn in one call and one drawn row by row."""
    together, apart = package.Framebuffer(WIDTH, HEIGHT, 4), package.Framebuffer(WIDTH, HEIGHT, 4)
    many(together, rows)
    for row in np.asarray(rows).tolist():
        one(apart, row)
    return together, apart


@given(tables(4), styles, antialias)
@example(np.array([[32768 + 1 / 256, 0, -32768, 3]], np.float32), {"width": 3, "cap": "butt"}, (2, "center"))
@example(np.array([[1025, 3, -1027, 4]], np.float16), {"width": 1, "cap": "square"}, None)
@example(np.array([[300, 3, -300, 4]], np.float16), {"width": 2, "cap": "square"}, None)
@example(np.array([[1e308, 3, -1e308, 4]]), {"width": 2, "cap": "square"}, None)
@pytest.mark.filterwarnings("error")
def test_lines_equal_the_single_calls(package, rows, style, antialias):
    samples = antialias and package.Supersample(*antialias)
    together, apart = both(
        package,
        lambda fb, rows: fb.lines(rows, 5, **style, antialias=samples, op="add"),
        lambda fb, row: fb.line(*row, 5, **style, antialias=samples, op="add"),
        rows,
    )
    assert together == apart


@given(tables(2))
@example(np.array([[2.0**23 + 1, 3]], np.float32))
@example(np.array([[1e308, 3]]))
@pytest.mark.filterwarnings("error")
def test_points_equal_the_single_calls(package, rows):
    together, apart = both(
        package, lambda fb, rows: fb.points(rows, 5, op="add"), lambda fb, row: fb.pixel(*row, 5, op="add"), rows
    )
    assert together == apart


huge = st.one_of(st.integers(-5, 30), st.integers(-(2**70), 2**70), st.fractions(-5, 30), st.floats(-5, 30))


@given(st.lists(st.tuples(*[huge] * 4), max_size=4), styles)
@example([(2**70, 3, -(2**70), 5), (0, 0, Fraction(7, 2), 3)], {"width": 1, "cap": "square"})
def test_objects_of_any_size_equal_the_single_calls(package, rows, style):
    together, apart = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    together.lines(np.array(rows, object).reshape(-1, 4), **style, op="xor")
    together.points(np.array([row[:2] for row in rows], object).reshape(-1, 2), op="xor")
    for row in rows:
        apart.line(*row, **style, op="xor")
        apart.pixel(*row[:2], 1, op="xor")
    assert together == apart


whole = st.one_of(st.integers(-30, 50), st.integers(-(2**65), 2**65))


@given(st.lists(st.tuples(*[st.one_of(whole, st.floats(-30, 50))] * 4), max_size=4))
@example([(-24, 2**64 - 3, 25, -(2**30))])
@example([(0.5, 2**60 + 1, 20, -(2**60))])
def test_whole_numbers_of_any_size_in_lists_equal_the_single_calls(package, rows):
    together, apart = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    together.lines(rows, dash=(4, 3), op="xor")
    for row in rows:
        apart.line(*row, dash=(4, 3), op="xor")
    assert together == apart


@given(st.lists(st.tuples(*[st.integers(-30, 50)] * 4), min_size=1, max_size=4))
def test_arrays_in_any_order_and_lists_are_the_same(package, rows):
    pictures = []
    array = np.array(rows)
    spread = np.zeros((2 * len(rows), 8), int)
    spread[::2, ::2] = rows
    for form in (
        rows,
        tuple(rows),
        array,
        np.asfortranarray(array),
        array[::-1],
        spread[::2, ::2],
        array.astype(">i2"),
    ):
        fb = package.Framebuffer(WIDTH, HEIGHT)
        fb.lines(form)
        pictures.append(fb)
    assert all(fb == pictures[0] for fb in pictures)


@pytest.mark.parametrize("nothing", [[], (), np.zeros((0, 4)), np.zeros((0, 4), object), np.zeros((0, 2))])
def test_nothing_draws_nothing(package, nothing):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    fb.lines(nothing)
    fb.points(nothing)
    assert not fb.pixels.any()


@pytest.mark.parametrize("call", ["lines", "points"])
def test_what_is_wrong_anywhere_is_refused(package, call):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    name = {"lines": "segments", "points": "xy"}[call]
    columns = {"lines": 4, "points": 2}[call]
    good = [1] * columns
    for rows, error in [
        ([good, [float("nan")] * columns], ValueError),
        ([good, [float("inf")] * columns], ValueError),
        (good, ValueError),
        ([[*good, 1]], ValueError),
        ([[good]], ValueError),
        ([["1"] * columns], TypeError),
        ([[1j] * columns], TypeError),
        (np.zeros((3, columns), "M8[s]"), TypeError),
        (5, ValueError),
        ("abc", TypeError),
    ]:
        with pytest.raises(error, match=rf"^{name} must "):
            getattr(fb, call)(rows)
    assert not fb.pixels.any()


@pytest.mark.parametrize("bad", [None, "1", float("nan"), 1j, [1]])
def test_objects_are_looked_at_one_by_one(package, bad):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    rows = np.empty((1, 4), object)
    rows[0] = [1, 2, 3, None]
    rows[0, 3] = bad
    with pytest.raises((TypeError, ValueError), match=r"^segments must be"):
        fb.lines(rows)
    with pytest.raises((TypeError, ValueError), match=r"^xy must be"):
        fb.points(rows[:, 2:])


def test_rows_of_unlike_length_are_refused(package):
    fb = package.Framebuffer(WIDTH, HEIGHT)
    with pytest.raises(ValueError, match="segments"):
        fb.lines([[1, 2, 3, 4], [1, 2, 3]])


@given(tables(2), st.sampled_from(["poly", "polyline"]), antialias)
@example(np.array([[1, 2], [9, 9], [3, 14]])[::-1, ::-1], "poly", None)
@example(np.asfortranarray([[1.5, 2], [9, 9.25], [3, 14]]), "polyline", (2, "center"))
@example(np.array([[2**30, 2], [9, 9], [-(2**40), 14]]), "poly", None)
def test_a_path_is_the_same_in_an_array_and_in_a_list(package, rows, call, samples):
    style = {"antialias": samples and package.Supersample(*samples)}
    pictures = []
    # As an array, as a list, and with x and y in turn, in an array and in a list.
    for points in (rows, rows.tolist(), rows.reshape(-1), rows.reshape(-1).tolist()):
        fb = package.Framebuffer(WIDTH, HEIGHT, 4)
        if call == "poly":
            fb.poly(0, 0, points, fill=True, **style)
        else:
            fb.polyline(points, **style)
        pictures.append(fb.pixels.tobytes())
    assert len(set(pictures)) == 1


def test_points_come_from_any_buffer(package):
    drawn = package.Framebuffer(WIDTH, HEIGHT)
    drawn.poly(0, 0, array("h", [1, 2, 20, 5, 7, 15]), fill=True)
    expected = package.Framebuffer(WIDTH, HEIGHT)
    expected.poly(0, 0, [(1, 2), (20, 5), (7, 15)], fill=True)
    assert drawn.pixels.any()
    assert (drawn.pixels == expected.pixels).all()


@pytest.mark.parametrize("kind", "bBhHiIlLqQ?efd")
def test_buffers_of_every_kind_of_number(package, kind):
    """Where a kind is of another size than elsewhere, as l is on small boards, or lies at odd addresses."""
    numbers = [1, 0, 1, 1] if kind == "?" else [1, 2, 20, 5]
    memory = np.array([numbers], kind)
    odd = np.frombuffer(b"?" + memory.tobytes(), kind, offset=1).reshape(1, 4)
    expected = package.Framebuffer(WIDTH, HEIGHT)
    expected.line(*numbers)
    for form in (memory, odd, memoryview(memory), memoryview(odd)):
        fb = package.Framebuffer(WIDTH, HEIGHT)
        fb.lines(form)
        assert fb == expected
        fb.clear()
        fb.points(np.asarray(form).reshape(2, 2))
        fb.polyline(np.asarray(form)[0])
        assert fb == expected


def test_buffers_of_pointers_are_no_numbers(package):
    """A buffer may hold addresses of its rows in their stead."""
    buffers = pytest.importorskip("_testbuffer", reason="a part of CPython's own tests")
    rows = buffers.ndarray([1, 2, 20, 5, 7, 15], shape=[3, 2], format="q", flags=buffers.ND_PIL)
    drawn, expected = package.Framebuffer(WIDTH, HEIGHT), package.Framebuffer(WIDTH, HEIGHT)
    drawn.polyline(rows)
    expected.polyline([(1, 2), (20, 5), (7, 15)])
    assert drawn == expected


@pytest.mark.parametrize(("call", "columns"), [("lines", 4), ("points", 2), ("polyline", 2)])
def test_more_rows_than_memory_holds_are_refused(call, columns):
    """One row repeated so often that the size of them all is 0, modulo a word. Interpreted, it would take forever."""
    fb = paneldraw.Framebuffer(WIDTH, HEIGHT)
    endless = np.broadcast_to(np.int16(0), ((sys.maxsize + 1) // 4 // columns, columns))
    with pytest.raises(MemoryError):
        getattr(fb, call)(endless)
    assert not fb.pixels.any()
