"""Levels, one byte a pixel, to the bytes that a panel's RAM takes. One function a packing, none a chip."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import cython
import numpy as np
from cython.cimports.cpython.memoryview import PyMemoryView_GET_BUFFER

if TYPE_CHECKING:
    from paneldraw.controllers.record import Controller

#: A rectangle of bytes in memory: that of row y and column x is ``start[y * down + x * across]``.
Rectangle = cython.struct(
    start=cython.p_uchar,
    height=cython.Py_ssize_t,
    width=cython.Py_ssize_t,
    down=cython.Py_ssize_t,
    across=cython.Py_ssize_t,
)


@cython.cfunc
def _rectangle(array: Any) -> Rectangle:  # type: ignore[valid-type]
    """Where the bytes of an array are, which the caller holds."""
    if cython.compiled:
        found = cython.declare(Rectangle)
        held = memoryview(array)
        view = PyMemoryView_GET_BUFFER(held)
        found.start = cython.cast(cython.p_uchar, view.buf)
        found.height, found.width = view.shape[0], view.shape[1]
        found.down, found.across = view.strides[0], view.strides[1]
    else:
        found = Rectangle()
        found.start = np.ascontiguousarray(array).reshape(-1).data
        found.height, found.width = array.shape
        found.down, found.across = found.width, 1
    return found


def pack_pages(levels: Any, max_level: cython.int, packed: Any) -> None:
    """Pack rows of levels into pages: a byte is eight rows of a column, the topmost in the lowest bit.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
    max_level : int
        The highest level; the upper half of the levels is lit.
    packed : (height / 8, rounded up, width) uint8, contiguous
        Where the pages go, from the top.
    """
    source, target = _rectangle(levels), _rectangle(packed)
    pixels, pages, width = source.start, target.start, target.width
    threshold = cython.cast(cython.uchar, max_level >> 1)
    for page in range(target.height):
        first = page * width
        for x in range(first, first + width):
            pages[x] = 0
        for row in range(min(8, source.height - 8 * page)):
            bit = cython.cast(cython.uchar, 1 << row)
            at = (8 * page + row) * source.down
            if source.across == 1:  # the same loop, apart: compilers make vectors of it
                for x in range(width):
                    pages[first + x] |= bit & -(pixels[at + x] > threshold)
            else:
                for x in range(width):
                    pages[first + x] |= bit & -(pixels[at] > threshold)
                    at += source.across


def pack_nibbles(levels: Any, max_level: cython.int, packed: Any) -> None:
    """Pack rows of levels two pixels a byte, the left one in the upper half.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
        The width even.
    max_level : int
        The highest level, 1, 3, 15 or 255; it becomes 15, and each below the nearest to its share.
    packed : (height, width / 2) uint8, contiguous
        Where the rows go, from the top.
    """
    source, target, nibbles = _rectangle(levels), _rectangle(packed), _rectangle(_NIBBLES[max_level]).start
    pixels, pairs, step, width = source.start, target.start, source.across, target.width
    for y in range(target.height):
        row, first = y * source.down, y * width
        for x in range(width):
            left, right = pixels[row + 2 * x * step], pixels[row + (2 * x + 1) * step]
            pairs[first + x] = nibbles[left] << 4 | nibbles[right]


def pack_rows(levels: Any, max_level: cython.int, packed: Any) -> None:
    """Pack rows of levels eight pixels a byte, the left one in the highest bit.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
        The width a multiple of 8.
    max_level : int
        The highest level; the upper half of the levels is lit.
    packed : (height, width / 8) uint8, contiguous
        Where the rows go, from the top.
    """
    source, target = _rectangle(levels), _rectangle(packed)
    pixels, rows, step, width = source.start, target.start, source.across, target.width
    threshold = cython.cast(cython.uchar, max_level >> 1)
    for y in range(target.height):
        at, first = y * source.down, y * width
        for x in range(first, first + width):
            byte: cython.int = 0
            for _ in range(8):
                byte = byte << 1 | (pixels[at] > threshold)
                at += step
            rows[x] = byte


def highest(levels: Any) -> int:
    """Return the highest level; numpy's `max` takes three times as long.

    Parameters
    ----------
    levels : (height, width) uint8, any strides
    """
    source = _rectangle(levels)
    pixels, width, step = source.start, source.width, source.across
    found = cython.declare(cython.uchar, 0)
    for y in range(source.height):
        at = y * source.down
        if step == 1:  # the same loop, apart: compilers make vectors of it
            for x in range(width):
                found = max(found, pixels[at + x])
        else:
            for x in range(width):
                found = max(found, pixels[at + x * step])
    return found


_NIBBLES = {
    highest: ((30 * np.arange(256) + highest) // (2 * highest)).clip(max=15).astype(np.uint8)[np.newaxis]
    for highest in (1, 3, 15, 255)
}
"""What a level becomes, by the highest level that there is."""


def pack_bits(places: Any, levels: Any, max_level: Any, packed: Any) -> None:
    """Pack levels a bit a pixel, each to a place of its own; the upper half of the levels is lit.

    Parameters
    ----------
    places : (height * width) int
        Of each pixel, row by row, eight times the number of its byte and the number of its bit, 0 being the lowest.
    levels, max_level
        As in `pack_pages`.
    packed : uint8, contiguous
        Bits that no pixel has become 0.
    """
    bits = np.zeros(8 * packed.size, np.bool_)
    bits[places] = levels.reshape(-1) > max_level >> 1
    packed.reshape(-1)[:] = np.packbits(bits, bitorder="little")


def pack_bytes(places: Any, levels: Any, max_level: Any, packed: Any) -> None:
    """Pack levels a byte a pixel, each to a place of its own; the highest level becomes 255."""
    packed.reshape(-1)[places] = levels.reshape(-1) * np.uint8(255 // max_level)


PACK = {"pages": pack_pages, "nibbles": pack_nibbles, "rows": pack_rows}
"""The functions by the packing that a controller names."""


def packer(controller: Controller) -> Callable[[Any, int, Any], None]:
    """Return what packs rows of levels as a controller has them."""
    if controller.registers is None:
        return PACK[controller.packing]
    pack = pack_bits if controller.packing == "bits" else pack_bytes
    return partial(pack, np.array(controller.registers.places))
