# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""What the arguments of a drawing call mean, and what is said of those that mean nothing."""

from __future__ import annotations

import math
import operator
from array import array
from typing import TYPE_CHECKING, Any, SupportsFloat, SupportsIndex, TypeAlias

import cython
import numpy as np
from cython.cimports.cpython.long import PyLong_AsLongLongAndOverflow
from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER
from numpy.typing import NDArray

if cython.compiled:
    from cython.cimports.paneldraw.raster._floors import floored
else:  # classes cimported in the .pxd, which leaves a user's type checker these
    from paneldraw.raster._floors import floored
    from paneldraw.raster.cone import ConeFilter
    from paneldraw.raster.supersample import Supersample

if TYPE_CHECKING:
    from types import EllipsisType

    # Cython would take a plain `float` or `int` in a signature for a type of its own, and `str` for str alone.
    Real: TypeAlias = SupportsFloat | SupportsIndex
    Int: TypeAlias = int
    Str: TypeAlias = str
    Level: TypeAlias = SupportsIndex | None
    Antialias: TypeAlias = Supersample | ConeFilter | None
    AntialiasOrDefault: TypeAlias = Antialias | EllipsisType

LARGEST = 65536

# Numbers within +-NEAR are handled in 64-bit arithmetic, others in Python's; FAR stands for those.
NEAR = cython.declare(cython.longlong, 1 << 29)
FAR = cython.declare(cython.longlong, 1 << 62)

# Pixels that are handled in 256ths in 64-bit arithmetic.
FIXED_REACH = cython.declare(cython.longlong, 1 << 18)

# Dashes longer than any path, in 256ths.
_ENDLESS = 1 << 100

ALIASED = Supersample(1)


@cython.cfunc
@cython.exceptval(check=False)
def quick(value: Any) -> cython.longlong:
    """`value`, if it is an int within +-NEAR, else FAR."""
    if type(value) is not int:
        return FAR
    overflow: cython.int = 0
    number: cython.longlong = (
        PyLong_AsLongLongAndOverflow(value, cython.address(overflow)) if cython.compiled else value
    )
    if overflow == 0 and -NEAR <= number <= NEAR:
        return number
    return FAR


@cython.cfunc
@cython.exceptval(check=False)
def quick_256ths(value: Any) -> cython.longlong:
    """`value` in 256ths, if it is an int or a float within +-FIXED_REACH, else FAR."""
    if type(value) is float:
        exact: cython.double = value
        if not -FIXED_REACH <= exact <= FIXED_REACH:
            return FAR
        exact *= 256
        below: cython.longlong = floored(exact)
        return below + (exact - below >= 0.5)
    number: cython.longlong = quick(value)
    return number * 256 if -FIXED_REACH <= number <= FIXED_REACH else FAR


@cython.cfunc
def quick_rows(
    source: Any, columns: cython.Py_ssize_t, flat: cython.bint, unit: cython.longlong, reach: cython.longlong
) -> Any:
    """The rows of an array of numbers, as a bytearray of int64, in 1 / unit of a pixel to the nearest, halves upward.

    An array is what exports a buffer of machine numbers, of shape (n, columns) or, where that is allowed, `flat`, with
    one row behind the other. None if `source` is nothing of the kind or holds a number beyond +-reach: then others look
    what it is.
    """
    if not cython.compiled:
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
    to: cython.p_longlong = pointer_to_int64(numbers)
    row: cython.Py_ssize_t
    column: cython.Py_ssize_t
    for row in range(rows):
        for column in range(columns):
            if not _read(start + row * down + column * across, kind, unit, reach, to + row * columns + column):
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


@cython.cfunc
@cython.inline
@cython.exceptval(check=False)
def _read(
    at: cython.p_char, kind: cython.char, unit: cython.longlong, reach: cython.longlong, to: cython.p_longlong
) -> cython.bint:
    """Write the number at an address, of a kind that has a size; return whether that was possible."""
    number: cython.longlong
    if kind == b"q":
        number = cython.cast(cython.p_longlong, at)[0]
    elif kind == b"l":
        number = cython.cast(cython.p_long, at)[0]
    elif kind == b"i":
        number = cython.cast(cython.p_int, at)[0]
    elif kind == b"h":
        number = cython.cast(cython.p_short, at)[0]
    else:
        exact: cython.double = (
            cython.cast(cython.p_double, at)[0] if kind == b"d" else cython.cast(cython.p_float, at)[0]
        )
        if not -reach <= exact <= reach:
            return False
        exact *= unit
        number = floored(exact)
        to[0] = number + (exact - number >= 0.5)
        return True
    if not -reach <= number <= reach:
        return False
    to[0] = number * unit
    return True


@cython.cclass
class Points:
    """The points of a path as a call takes them, read into one array of numbers.

    Parameters
    ----------
    name : str
        What the call names them.
    source : array_like
        Pairs, shape (n, 2), or x and y in turn, as MicroPython's framebuf has them.
    fixed : bool
        Whether to read 256ths of a pixel or whole pixels.
    """

    def __init__(self, name: Any, source: Any, fixed: cython.bint) -> None:
        i: cython.Py_ssize_t
        number: cython.longlong
        self.exact = None
        self.kept = quick_rows(source, 2, True, 256 if fixed else 1, FIXED_REACH if fixed else NEAR)
        if self.kept is not None:
            self.values = pointer_to_int64(self.kept)
            self.count = len(self.kept) // 16
            return
        items = in_turn(name, source)
        self.count = len(items) // 2
        if cython.compiled:
            self.kept = bytearray(8 * len(items))
            self.values = pointer_to_int64(self.kept)
        else:
            self.values = [0] * len(items)
        for i in range(len(items)):
            number = quick_256ths(items[i]) if fixed else quick(items[i])
            if number == FAR:
                exact = to_256ths(name, items[i]) if fixed else whole(name, items[i])
                if abs(exact) > (FIXED_REACH * 256 if fixed else NEAR):
                    self.exact = [to_256ths(name, item) if fixed else whole(name, item) for item in items]
                    return
                number = exact
            self.values[i] = number


def in_turn(name: str, source: Any) -> list[Any]:
    """The points of an array_like as a list of x and y in turn."""
    items = source.tolist() if hasattr(source, "tolist") else source
    try:
        items = list(items)
        if items and isinstance(items[0], (list, tuple, np.ndarray)):
            items = [number for x, y in items for number in (x, y)]
        if items and isinstance(items[0], (list, tuple, np.ndarray)):
            raise ValueError
    except (TypeError, ValueError):
        raise ValueError(f"{name} must hold points (x, y), as an array of shape (n, 2) or x and y in turn") from None
    if len(items) % 2:
        raise ValueError(f"{name} must hold an x and a y for each point, and holds {len(items)} numbers")
    return items


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


def whole(name: str, value: Any) -> int:
    """The whole number nearest to `value`, halves upward."""
    number = real(name, value)
    return number if isinstance(number, int) else _nearest(number)


def to_256ths(name: str, value: Any) -> int:
    """The nearest number of 256ths of a pixel, halves upward."""
    number = real(name, value)
    if isinstance(number, int):
        return number * 256
    fraction, whole_pixels = math.modf(number)
    return int(whole_pixels) * 256 + _nearest(fraction * 256)


def _nearest(number: float) -> int:
    # Not floor(number + 0.5): that sum may itself be rounded.
    below = math.floor(number)
    return below + (number - below >= 0.5)


def size(name: str, value: Any) -> int:
    """`value` as an int, if it is whole by type."""
    try:
        return operator.index(value)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {type(value).__name__}") from None


def not_negative(name: str, number: int) -> int:
    if number < 0:
        raise ValueError(f"{name} must not be negative, and is {number}")
    return number


def as_samples(antialias: Any) -> Supersample:
    """A call's anti-aliasing as the samples to take: one a pixel for None and for a filter, which takes none."""
    if antialias is None or isinstance(antialias, ConeFilter):
        return ALIASED
    if not isinstance(antialias, Supersample):
        raise TypeError(
            f"antialias must be None, a Supersample, such as Supersample(4), or a ConeFilter, not {antialias!r}"
        )
    return antialias


def length(name: str, value: Any, unit: Any) -> int:
    """`value`, which may not be negative, to the nearest 1 / unit of a pixel, where unit is 1 or 256."""
    if real(name, value) < 0:
        raise ValueError(f"{name} must not be negative, and is {value}")
    return whole(name, value) if unit == 1 else to_256ths(name, value)


def choice(name: str, value: Any, choices: dict[str, Int]) -> Int:
    """The number by which the raster modules know one of a few words."""
    try:
        return choices[value]
    except (KeyError, TypeError):
        raise ValueError(f"{name} must be one of {', '.join(map(repr, choices))}, not {value!r}") from None


def dash_lengths(dash: Any) -> list[Int]:
    """The lengths of a dash pattern in 256ths of a pixel, an even number of them; none for no pattern."""
    if dash is None:
        return []
    try:
        lengths = [to_256ths("dash", length) for length in dash]
    except TypeError:
        raise TypeError(f"dash must be a sequence of lengths in pixels, such as (4, 2), not {dash!r}") from None
    if not lengths or min(lengths) < 256:
        raise ValueError(f"dash must hold lengths of 1 pixel or more, drawn and left out in turn, not {dash!r}")
    lengths = [min(length, _ENDLESS) for length in lengths]
    return lengths if len(lengths) % 2 == 0 else lengths + lengths


def dash_steps(lengths: list[Int]) -> bytearray:
    """The lengths of a pattern in whole pixels, as int64; those longer than any path that is near are cut."""
    longest = (1 << 62) // max(len(lengths), 1)
    return bytearray(array("q", [min((length + 128) >> 8, longest) for length in lengths]))


@cython.cfunc
def line_width(width: Any) -> Any:
    """A line's width in 256ths of a pixel."""
    if type(width) is int and width == 1:
        return 256
    fixed = to_256ths("width", width)
    if fixed <= 0:
        raise ValueError(f"width must be at least 1/256 of a pixel, not {width}")
    return fixed


def table(name: str, rows: Any, columns: int) -> NDArray[Any]:
    """`rows` as an array of numbers of shape (n, columns)."""
    try:
        table = np.asarray(rows)
    except ValueError:
        raise ValueError(f"{name} must have the shape (n, {columns}), and its rows differ in length") from None
    if table.size == 0:
        return np.zeros((0, columns), np.int64)
    if table.dtype.kind not in "biufO":
        raise TypeError(f"{name} must hold numbers, not {table.dtype}")
    if table.ndim != 2 or table.shape[1] != columns:
        raise ValueError(f"{name} must have the shape (n, {columns}), not {table.shape}")
    if table.dtype.kind == "f":
        if not np.isfinite(table).all():
            raise ValueError(f"{name} must be finite, and holds NaN or infinity")
        # Between negative numbers or fractions, numpy makes floats of whole numbers too large for them.
        if float(abs(table).max()) >= 1 << 53:
            return np.asarray(rows, object)
    return table


def integers(table: NDArray[Any], unit: int, limit: int) -> bytearray | None:
    """The numbers in 1 / unit pixels, to the nearest, as int64; None if one is beyond +-limit or of no C type."""
    if table.dtype.kind == "O":
        return None
    if table.dtype.kind == "f":
        table = table.astype(np.float64)
    if len(table) and (table.max() > limit // unit or table.min() < -(limit // unit)):
        return None
    if table.dtype.kind == "f":
        scaled = table * unit
        table = np.floor(scaled)
        table += scaled - table >= 0.5
        unit = 1
    return bytearray((table.astype(np.int64) * unit).tobytes())


@cython.cfunc
def pointer_to_int64(numbers: bytearray) -> cython.p_longlong:
    """The numbers that lie in a bytearray."""
    if cython.compiled:
        return cython.cast(cython.p_longlong, cython.cast(cython.p_char, numbers))
    return array("q", numbers)


@cython.cfunc
def pointer_to_bytes(array: Any) -> cython.p_uchar:
    """The bytes of a contiguous uint8 array."""
    if cython.compiled:
        address: cython.size_t = array.__array_interface__["data"][0]
        return cython.cast(cython.p_uchar, address)
    return array.tobytes()
