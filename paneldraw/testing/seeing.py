"""What panels and framebuffers show, as text to compare with; what frames cost."""

from __future__ import annotations

import inspect
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from paneldraw.framebuffer.pictures import to_text

if TYPE_CHECKING:
    from paneldraw.simulator.chip import Chip
    from paneldraw.simulator.frames import Frame

Levels = NDArray[np.uint8]
Characters = NDArray[np.str_]
Marks = NDArray[np.bool_]

_MARGIN = 2
"""Columns and rows shown around what differs."""
_WIDEST = 40
"""Columns that are shown a character a pixel, three pictures side by side; a character of braille has eight pixels."""


class Sent(Protocol):
    """What has a price: a simulated chip's `Frame`, the `Report` of a show, a panel's ``stats``."""

    @property
    def wire_bytes(self) -> int:
        """Bytes on the wire, address and control bytes included."""


def chip_of(source: Any) -> Chip:
    """Return the simulated chip of a panel, a program, or a bus that has but one.

    Raises
    ------
    TypeError
        It has none.
    ValueError
        It has several.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306(), 0x3D: simulator.SH1106()})
    >>> chip_of(bus.devices[0x3D])
    <SH1106 128x64, off, 0 frames>
    """
    from paneldraw.simulator.chip import Chip

    found = [chip for chip in _devices(source) if isinstance(chip, Chip)]
    if not found:
        raise TypeError(f"source must be simulated, or a framebuffer, not {source!r}")
    if len(found) > 1:
        raise ValueError(f"source must be one of {len(found)} chips, such as bus.devices[0x3C], not all of {source!r}")
    return found[0]


def _devices(source: Any) -> list[Any]:
    """What a source is, holds or reaches, each once."""
    from paneldraw.simulator.wire import Wire

    if isinstance(source, Wire):  # of a chip at two addresses, each leads to it
        return list({id(chip): chip for chip in (getattr(each, "chip", each) for each in source._chips())}.values())
    for holder in ("panel", "chip", "simulated"):  # of a program; of a panel there; of a panel here
        if (inside := getattr(source, holder, None)) is not None:
            return _devices(inside)
    transport = getattr(source, "transport", None)  # of a panel that somebody put on a simulated bus
    bus = getattr(transport, "bus", None) or getattr(getattr(transport, "spi", None), "_bus", None)
    if isinstance(bus, Wire):
        at = getattr(bus, "devices", {}).get(getattr(transport, "address", None))
        return _devices(bus) if at is None else [at]
    return [source]


def levels_of(source: Any) -> tuple[Levels, int]:
    """Return the levels that a source shows, and the highest there is."""
    if not (hasattr(source, "pixels") and hasattr(source, "max_level")):
        source = chip_of(source)
    return source.pixels, source.max_level


def frames_of(source: Any) -> list[Frame]:
    """Return the pictures that a simulated panel showed, the oldest first.

    Parameters
    ----------
    source : panel, chip, bus or program
        As in `chip_of`.

    Returns
    -------
    list of paneldraw.simulator.Frame
        Each with its `pixels`, `seconds`, and the `wire_bytes` that it took since the one before.

    Examples
    --------
    >>> from paneldraw import open_panel
    >>> with open_panel("sim://ssd1306") as panel:
    ...     for x in range(3):
    ...         with panel.frame() as fb:
    ...             fb.pixel(x, 0, 1)
    >>> [int(frame.pixels.sum()) for frame in frames_of(panel)]
    [1, 1, 1]
    """
    return list(chip_of(source).frames)


def assert_bytes(sent: Sent, *, at_most: int) -> None:
    """Demand that a frame took no more than so many bytes on the wire.

    Parameters
    ----------
    sent : Frame, Report or Stats
        A frame out of `frames_of`, what a show returned, or a panel's ``stats``, the sum of all.
    at_most : int

    Examples
    --------
    >>> from paneldraw import open_panel
    >>> with open_panel("sim://ssd1306") as panel:
    ...     fb = panel.framebuffer()
    ...     blank = panel.show(fb)
    ...     fb.pixel(5, 5, 1)
    ...     assert_bytes(panel.show(fb), at_most=8)
    """
    __tracebackhide__ = True
    if sent.wire_bytes > at_most:
        raise AssertionError(f"{sent.wire_bytes} bytes on the wire are {sent.wire_bytes - at_most} more than {at_most}")


def assert_pattern(source: Any, pattern: str, at: tuple[int, int] | None = None) -> None:
    """Demand that a picture looks like a text.

    Parameters
    ----------
    source : Framebuffer, panel, chip, frame, bus or program
        What has the picture; of a panel, what is on its simulated glass.
    pattern : str
        A line a row, a character a pixel: ``.`` is dark and ``#`` lit; of more than two levels, hexadecimal digits, as
        ``str`` of a framebuffer has them. Its indentation does not count.
    at : (int, int), optional
        Compare the part of the picture whose top left pixel this is. Default: the whole.

    Raises
    ------
    AssertionError
        With both beside each other, and what differs.
    ValueError
        That part reaches out of the picture.

    Examples
    --------
    >>> from paneldraw import Framebuffer
    >>> fb = Framebuffer(4, 2)
    >>> fb.line(0, 0, 3, 1)
    >>> assert_pattern(fb, '''
    ...     ##..
    ...     ..##
    ... ''')
    """
    __tracebackhide__ = True
    levels, max_level = levels_of(source)
    wanted = _grid(inspect.cleandoc(pattern))
    if at is not None:
        levels = _part(levels, at, wanted.shape)
    drawn = _grid(to_text(levels, max_level.bit_length()))
    wanted, drawn = _same_size(wanted, drawn)
    if (marks := wanted != drawn).any():
        raise AssertionError("the picture differs\n" + _shown(wanted, drawn, marks, ("wanted", "drawn")))


def difference(left: Any, right: Any, titles: tuple[str, str]) -> str:
    """Show where two pictures differ."""
    (levels, highest), (others, others_highest) = levels_of(left), levels_of(right)
    grids = _grid(to_text(levels, highest.bit_length())), _grid(to_text(others, others_highest.bit_length()))
    first, second = _same_size(*grids)
    marks = first != second
    if levels.shape == others.shape and highest == others_highest:
        marks = levels != others  # of which text does not show all where there are 256
    return _shown(first, second, marks, titles)


def _part(levels: Levels, at: tuple[int, int], shape: tuple[int, ...]) -> Levels:
    (x, y), (height, width) = at, shape
    if x < 0 or y < 0 or x + width > levels.shape[1] or y + height > levels.shape[0]:
        size = f"{levels.shape[1]}x{levels.shape[0]}"
        raise ValueError(f"at must leave room for {width}x{height} pixels in {size}, not {at!r}")
    return levels[y : y + height, x : x + width]


def _grid(text: str) -> Characters:
    rows = text.split("\n")
    width = max(map(len, rows))
    return np.array([list(row.ljust(width)) for row in rows], "U1").reshape(len(rows), width)


def _same_size(*grids: Characters) -> list[Characters]:
    """Fill grids up to the size of the larger one."""
    height, width = (max(grid.shape[axis] for grid in grids) for axis in (0, 1))
    return [
        np.pad(grid, ((0, height - grid.shape[0]), (0, width - grid.shape[1])), constant_values=" ") for grid in grids
    ]


def _shown(left: Characters, right: Characters, marks: Marks, titles: tuple[str, str]) -> str:
    """Two pictures beside each other as far as they differ, and a third that marks where; large ones as braille."""
    rows, columns = np.nonzero(marks)
    if not len(rows):
        return "the same pixels"
    parts = [slice(max(each.min() - _MARGIN, 0), each.max() + _MARGIN + 1) for each in (rows, columns)]
    part = tuple(parts) if marks.size > _WIDEST**2 else (slice(None), slice(None))
    place = f"{_range('x', columns)}, {_range('y', rows)}"
    head = f"{len(rows)} of {marks.size} pixels, {place}"
    cut = [grid[part] for grid in (left, right, np.where(marks, "^", "."))]
    names = (*titles, "differs")
    if cut[0].shape[1] > _WIDEST:
        return "\n".join([head, *(f"{name}\n{_braille(grid)}" for name, grid in zip(names, cut, strict=True))])
    width = max(cut[0].shape[1], *map(len, names)) + 3
    lines = [names, *zip(*(["".join(row) for row in grid] for grid in cut), strict=True)]
    return "\n".join([head, *("".join(part.ljust(width) for part in line).rstrip() for line in lines)])


def _range(name: str, places: NDArray[np.intp]) -> str:
    first, last = places.min(), places.max()
    return f"{name} {first} to {last}" if first < last else f"{name} {first}"


def _braille(grid: Characters) -> str:
    from paneldraw.simulator import text

    return text(((grid != ".") & (grid != " ")).astype(np.uint8), "braille")
