"""What the arguments of a drawing call mean, and what is said of those that mean nothing."""

from __future__ import annotations

import math
import operator
from array import array
from typing import TYPE_CHECKING, Any

import cython
import numpy as np
from cython.cimports.cpython.buffer import PyObject_CheckBuffer
from cython.cimports.cpython.long import PyLong_AsLongLongAndOverflow
from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER
from cython.cimports.paneldraw.raster.floors import floored

from paneldraw.raster.clip import REACH
from paneldraw.raster.cone import ConeFilter
from paneldraw.raster.coverage import Supersample

if TYPE_CHECKING:
    from types import EllipsisType
    from typing import TypeAlias

    Antialias: TypeAlias = Supersample | ConeFilter | None
    AntialiasOrDefault: TypeAlias = Antialias | EllipsisType

LARGEST = 65536

# What stands for a number of pixels beyond +-REACH, which Python's integers are for.
FAR = cython.declare(cython.longlong, 1 << 62)
_REACH = cython.declare(cython.longlong, REACH)

# More pixels than a text or picture has.
BEYOND = cython.declare(cython.longlong, 1 << 40)

# Dashes longer than any path, in 256ths.
_ENDLESS = 1 << 100

if not cython.compiled:

    def is_word(value, word):
        """Whether a choice is a certain word, the one that most calls make."""
        return type(value) is str and value == word

    def quick(value):
        """The number, if it is an int within +-REACH, else FAR."""
        return value if type(value) is int and -REACH <= value <= REACH else FAR


def _quick(value, unit):
    """`value` in 1 / unit of a pixel, halves upward, if it is an int or a float within +-REACH, else FAR."""
    number: cython.longlong
    overflow: cython.int = 0
    if type(value) is int:
        number = quick(value)
        if number != FAR:
            return number * unit
        number = PyLong_AsLongLongAndOverflow(value, cython.address(overflow)) if cython.compiled else value
        return number * unit if overflow == 0 and -_REACH <= number <= _REACH else FAR
    if type(value) is float:
        exact: cython.double = value
        if -_REACH <= exact <= _REACH:
            # Not floor(exact + 0.5): that sum may itself be rounded.
            exact *= unit
            number = floored(exact)
            return number + (exact - number >= 0.5)
    return FAR


def near_pixel(name, value):
    """The pixel nearest to a coordinate, halves upward; of those beyond +-REACH that one."""
    number: cython.longlong = quick(value)
    return number if number != FAR else min(max(whole(name, value), -REACH), REACH)


def top_left(name, value):
    """As `near_pixel`, of a text or picture, which may reach into the square from afar: up to +-BEYOND."""
    number: cython.longlong = quick(value)
    return number if number != FAR else min(max(whole(name, value), -BEYOND), BEYOND)


def coordinate(name, value, unit):
    """The nearest number of 1 / unit of a pixel, halves upward; FAR if it is beyond +-REACH pixels."""
    number: cython.longlong = quick(value)
    if number != FAR:
        return number * unit
    number = _quick(value, unit)
    if number == FAR:
        exact: object = nearest(name, value, unit)
        if -REACH * unit <= exact <= REACH * unit:
            number = exact
    return number


def extent(name, value, unit):
    """As `coordinate`, of what may not be negative."""
    number: cython.longlong = quick(value)
    if 0 <= number != FAR:
        return number * unit
    if real(name, value) < 0:
        raise ValueError(f"{name} must not be negative, and is {value}")
    return coordinate(name, value, unit)


def level(surface, c):
    """The level that `c` means on a surface: the highest for None."""
    if c is None:
        return surface.max_level
    number: cython.longlong = _quick(c, 1) if type(c) is int else FAR
    if 0 <= number <= surface.max_level:
        return cython.cast(cython.int, number)
    return level_named("c", surface, c)


def level_named(name, surface, value):
    """As `level`, of an argument of another name, which is a number."""
    if isinstance(value, float):
        raise TypeError(f"{name} must be a whole number, and is a float; round it first")
    number: cython.longlong = min(max(size(name, value), -1), 256)
    if not 0 <= number <= surface.max_level:
        raise ValueError(f"{name} must be a level from 0 to {surface.max_level}, not {value}")
    return cython.cast(cython.int, number)


def _quick_rows(source, columns, flat, unit):
    """The rows of an array of numbers, as a bytearray of int64, in 1 / unit of a pixel to the nearest, halves upward.

    An array is what exports a buffer of machine numbers, of shape (n, columns) or, where that is allowed, `flat`, with
    one row behind the other. None if `source` is nothing of the kind or holds a number beyond +-REACH: then others look
    what it is.
    """
    row: cython.Py_ssize_t
    if not cython.compiled or not PyObject_CheckBuffer(source):
        return None
    try:
        memory = memoryview(source)
    except (TypeError, ValueError, BufferError):
        return None
    view = PyMemoryView_GET_BUFFER(memory)
    flat = flat and view.ndim == 1 and view.shape[0] % columns == 0
    if not flat and (view.ndim != 2 or view.shape[1] != columns):
        return None
    rows: cython.Py_ssize_t = view.shape[0] // columns if flat else view.shape[0]
    across: cython.Py_ssize_t = view.strides[0] if flat else view.strides[1]
    down: cython.Py_ssize_t = columns * view.strides[0] if flat else view.strides[0]
    kind: cython.char = view.format[0]
    start: cython.p_char = cython.cast(cython.p_char, view.buf)
    # Behind suboffsets there are addresses; and not every processor reads numbers from odd ones.
    places: cython.size_t = cython.cast(cython.size_t, start) | across | down
    if _size_of(kind) != view.itemsize or kind == 0 or view.format[1] != 0:
        return None
    if view.suboffsets != cython.NULL or places & (view.itemsize - 1):
        return None
    # A repeated row takes no memory, and there may be more of them than memory holds.
    if rows > cython.cast(cython.Py_ssize_t, cython.cast(cython.size_t, -1) >> 1) // (8 * columns):
        raise MemoryError
    numbers = bytearray(8 * columns * rows)
    to: cython.p_longlong = int64s(numbers)
    if down == columns * across:
        # Rows that lie one behind the other are one.
        columns, rows = columns * rows, 1
    for row in range(rows):
        if not _read(start + row * down, across // view.itemsize, columns, kind, unit, to + row * columns):
            return None
    return numbers


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _size_of(kind: cython.char) -> cython.Py_ssize_t:
    """How large the numbers are here that a buffer's format names by a letter; 0 for all that are not read."""
    if kind == b"q":
        return cython.sizeof(cython.longlong)
    if kind == b"l":
        return cython.sizeof(cython.long)
    if kind == b"i":
        return cython.sizeof(cython.int)
    if kind == b"h":
        return cython.sizeof(cython.short)
    if kind == b"d":
        return cython.sizeof(cython.double)
    return cython.sizeof(cython.float) if kind == b"f" else 0


def _read(at, step, count, kind, unit, to):
    """Write `count` numbers, each `step` numbers after the one before, of a kind that has a size.

    Returns whether all are within +-REACH.
    """
    if kind == b"q":
        return _read_wholes(cython.cast(cython.p_longlong, at), step, count, unit, to)
    if kind == b"l":
        return _read_wholes(cython.cast(cython.p_long, at), step, count, unit, to)
    if kind == b"i":
        return _read_wholes(cython.cast(cython.p_int, at), step, count, unit, to)
    if kind == b"h":
        return _read_wholes(cython.cast(cython.p_short, at), step, count, unit, to)
    if kind == b"d":
        return _read_floats(cython.cast(cython.p_double, at), step, count, unit, to)
    return _read_floats(cython.cast(cython.p_float, at), step, count, unit, to)


_Whole = cython.fused_type(cython.longlong, cython.long, cython.int, cython.short)
_Float = cython.fused_type(cython.double, cython.float)


@cython.cfunc
@cython.exceptval(check=False)
def _read_wholes(
    at: cython.pointer[_Whole],
    step: cython.Py_ssize_t,
    count: cython.Py_ssize_t,
    unit: cython.longlong,
    to: cython.p_longlong,
) -> cython.bint:
    i: cython.Py_ssize_t
    number: cython.longlong
    reach: cython.longlong = _REACH
    for i in range(count):
        number = at[i * step]
        if not -reach <= number <= reach:
            return False
        to[i] = number * unit
    return True


@cython.cfunc
@cython.exceptval(check=False)
def _read_floats(
    at: cython.pointer[_Float],
    step: cython.Py_ssize_t,
    count: cython.Py_ssize_t,
    unit: cython.longlong,
    to: cython.p_longlong,
) -> cython.bint:
    i: cython.Py_ssize_t
    number: cython.longlong
    for i in range(count):
        exact: cython.double = at[i * step]
        if not -_REACH <= exact <= _REACH:
            return False
        exact *= unit
        number = floored(exact)
        to[i] = number + (exact - number >= 0.5)
    return True


@cython.final
@cython.cclass
class Numbers:
    """Rows of numbers as a call takes them, in one array: points or segments, in 1 / unit of a pixel.

    Attributes
    ----------
    values, count : pointer to int64, int
        The numbers and how many rows they make.
    exact : list of int or None
        The same as Python's integers, if one of them is beyond +-REACH pixels; then `values` are not filled.
    """

    def read(self, name, source, columns, unit, may_be_flat):
        """Read them."""
        i: cython.Py_ssize_t
        number: cython.longlong
        self.exact = None
        self.memory = _quick_rows(source, columns, may_be_flat and columns == 2, unit)
        if self.memory is not None:
            self.values = int64s(self.memory)
            self.count = len(self.memory) // (8 * columns)
            return
        items: list = in_turn(name, source) if may_be_flat and columns == 2 else _in_rows(name, source, columns)
        self.count = len(items) // columns
        if cython.compiled:
            self.memory = bytearray(8 * len(items))
            self.values = int64s(self.memory)
        else:
            self.values = [0] * len(items)
        for i in range(len(items)):
            number = _quick(items[i], unit)
            if number == FAR:
                exact: object = nearest(name, items[i], unit)
                if abs(exact) > REACH * unit:
                    self.exact = [nearest(name, item, unit) for item in items]
                    return
                number = exact
            self.values[i] = number


def points_of(name, source, unit):
    """An array_like of points, shape (n, 2) or with x and y in turn, as MicroPython's framebuf has them."""
    numbers: Numbers = Numbers.__new__(Numbers)
    numbers.read(name, source, 2, unit, True)
    return numbers


def rows_of(name, source, columns, unit):
    """An array_like of shape (n, columns)."""
    numbers: Numbers = Numbers.__new__(Numbers)
    numbers.read(name, source, columns, unit, False)
    return numbers


def in_turn(name, source):
    """The points of an array_like as a list of x and y in turn."""
    items = _listed(source)
    try:
        items = list(items)
        if items and _is_row(items[0]):
            items = [number for x, y in items for number in (x, y)]
        if items and _is_row(items[0]):
            raise ValueError
    except (TypeError, ValueError):
        raise ValueError(f"{name} must hold points (x, y), as an array of shape (n, 2) or x and y in turn") from None
    if len(items) % 2:
        raise ValueError(f"{name} must hold an x and a y for each point, and holds {len(items)} numbers")
    return items


def _in_rows(name, source, columns):
    """The numbers of an array_like of shape (n, columns), one row behind the other."""
    items = _listed(source)
    try:
        rows = [list(row) if _is_row(row) else None for row in items]
    except TypeError:
        rows = [None]
    if isinstance(source, str):
        raise TypeError(f"{name} must hold numbers, not a string")
    if not all(row is not None and len(row) == columns for row in rows):
        raise ValueError(f"{name} must have the shape (n, {columns}): rows of {columns} numbers")
    return [number for row in rows for number in row]


def _listed(source):
    """The items of an array as a list of Python's numbers; anything else as it is."""
    if isinstance(source, memoryview):
        source = np.asarray(source)
    return source.tolist() if hasattr(source, "tolist") else source


def _is_row(item):
    return isinstance(item, (list, tuple)) or (hasattr(item, "tolist") and getattr(item, "ndim", 0) > 0)


def real(name: str, value: Any) -> int | float:
    """`value` as an int of any size or a finite float."""
    try:
        return operator.index(value)
    except TypeError:
        pass
    try:
        if isinstance(value, (str, bytes)):
            raise TypeError
        number = float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number, not {type(value).__name__}") from None
    except OverflowError:
        raise ValueError(f"{name} must be an int or within the range of floats") from None
    if not math.isfinite(number):
        raise ValueError(f"{name} must be finite, not {number}")
    return number


def nearest(name: str, value: Any, unit: int) -> int:
    """The nearest number of 1 / unit of a pixel, halves upward, of any size."""
    number = real(name, value)
    if isinstance(number, int):
        return number * unit
    fraction, pixels = math.modf(number)
    fraction *= unit
    below = math.floor(fraction)
    return int(pixels) * unit + below + (fraction - below >= 0.5)


def whole(name: str, value: Any) -> int:
    """The whole number nearest to `value`, halves upward."""
    return nearest(name, value, 1)


def size(name: str, value: Any) -> int:
    """`value` as an int, if it is whole by type."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {type(value).__name__}") from None


def choice(name: str, value: Any, choices: dict[str, int]) -> int:
    """The number by which the raster modules know one of a few words."""
    try:
        return choices[value]
    except (KeyError, TypeError):
        raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}") from None


def check_antialias(antialias: Any) -> None:
    """Refuse what is no way to anti-alias."""
    if antialias is not None and not isinstance(antialias, (Supersample, ConeFilter)):
        raise TypeError(
            f"antialias must be None, a Supersample, such as Supersample(4), or a ConeFilter, not {antialias!r}"
        )


def dash_lengths(dash: Any) -> list[int]:
    """The lengths of a dash pattern in 256ths of a pixel, an even number of them; none for no pattern."""
    if dash is None:
        return []
    try:
        lengths = [nearest("dash", length, 256) for length in dash]
    except TypeError:
        raise TypeError(f"dash must be a sequence of lengths in pixels, such as (4, 2), not {dash!r}") from None
    if not lengths or min(lengths) < 256:
        raise ValueError(f"dash must hold lengths of 1 pixel or more, drawn and left out in turn, not {dash!r}")
    lengths = [min(length, _ENDLESS) for length in lengths]
    return lengths if len(lengths) % 2 == 0 else lengths + lengths


def dash_steps(lengths: list[int] | None) -> bytearray:
    """The lengths of a pattern in whole pixels, as int64; those longer than any path that is near are cut."""
    lengths = lengths or []
    longest = (1 << 60) // max(len(lengths), 1)
    return bytearray(array("q", [min((length + 128) >> 8, longest) for length in lengths]))


def line_width(width: Any) -> int:
    """A line's width in 256ths of a pixel."""
    fixed = nearest("width", width, 256)
    if fixed <= 0:
        raise ValueError(f"width must be at least 1/256 of a pixel, not {width}")
    return fixed


def int64s(memory):
    """The numbers that lie in a bytearray."""
    if cython.compiled:
        kept: bytearray = memory
        return cython.cast(cython.p_longlong, cython.cast(cython.p_char, kept))
    return array("q", memory)


def uint8s(memory):
    """The bytes that lie in a bytearray."""
    if cython.compiled:
        kept: bytearray = memory
        return cython.cast(cython.p_uchar, cython.cast(cython.p_char, kept))
    return memory
