"""A panel's D/C and reset lines, through gpiod or through what the caller gives."""

from __future__ import annotations

import errno
import glob
import importlib
import os
import sys
import time
from typing import Any, Final, Protocol

from paneldraw.errors import (
    PanelBusyError,
    PanelError,
    PanelNotFoundError,
    PanelPermissionError,
    TransportError,
)
from paneldraw.transports.base import join_group

Line = int | str
"""A line by its number on the header's GPIO chip, or by its name."""

HEADERS: Final = ("pinctrl-rp1", "pinctrl-bcm2711", "pinctrl-bcm2835")
"""Labels of the chips behind the header of a Raspberry Pi 5, a 4 and the earlier ones."""
RESET_LOW: Final = 0.001
RESET_WAIT: Final = 0.010
"""Seconds. The longest that sheets ask for are 0.1 ms (SSD1322, SSD1327) and 6 ms (UC1609, as U8g2 has it)."""


class Pins(Protocol):
    """What sets lines. Any object with this method will do."""

    def set(self, line: Any, value: bool) -> object:
        """Put a line high or low."""


class PanelLines:
    """The D/C and reset lines of one panel, of which it may have neither.

    Parameters
    ----------
    dc, reset : int, str or None
    pins : object or None
        What sets them. Default: GPIO lines of this machine, opened here.
    gpiochip : int, str or None
        Number or path of the GPIO chip that has them. Default: found.

    Raises
    ------
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        A line cannot be had.
    """

    def __init__(self, dc: Line | None, reset: Line | None, pins: Pins | None, gpiochip: int | str | None) -> None:
        for name, line in (("dc", dc), ("reset", reset)):
            _check(name, line)
        if dc is not None and dc == reset:
            raise ValueError(f"dc and reset must be two lines, not both {dc!r}")
        if pins is not None and not callable(getattr(pins, "set", None)):
            raise TypeError(f"pins must have a method set(line, value), not be {pins!r}")
        self._dc, self._reset = dc, reset
        self._owned: GPIO | None = None
        if pins is None and (dc, reset) != (None, None):
            pins = self._owned = GPIO(gpiochip)
        self._pins = pins
        self.data: bool | None = None
        """The level of D/C, as far as it is known."""
        self.fresh = False
        """Whether nothing was sent since the last reset."""
        try:
            if self._owned is not None:
                for line in (dc, reset):
                    if line is not None:
                        self._owned.claim(line, high=line == reset)
            self.reset()
        except BaseException:
            self.close()
            raise

    def set_data(self, data: bool) -> None:
        """Put D/C high for data, low for commands."""
        if self._dc is not None:
            self.data = None
            self._set(self._dc, data)
        self.data = data

    def reset(self) -> bool:
        """Pulse the reset line unless nothing was sent since the last time; return whether there is one."""
        if self._reset is None:
            return False
        if not self.fresh:
            self._set(self._reset, False)
            time.sleep(RESET_LOW)
            self._set(self._reset, True)
            time.sleep(RESET_WAIT)
            self.fresh = True
        return True

    def close(self) -> None:
        """Release the lines that were opened here."""
        if self._owned is not None:
            self._owned.close()

    def _set(self, line: Line, high: bool) -> None:
        try:
            self._pins.set(line, high)  # type: ignore[union-attr]
        except OSError as error:
            if isinstance(error, PanelError):
                raise
            advice = "is the GPIO chip still there, and the transport still open?"
            raise TransportError(error.errno, f"cannot set line {line}: {error.strerror or error}; {advice}") from error


class GPIO:
    """Output lines of this machine, through gpiod."""

    def __init__(self, gpiochip: int | str | None) -> None:
        self._gpiod = package("gpiod")
        if not hasattr(self._gpiod, "LineSettings"):
            raise PanelError('gpiod is older than 2.0: pip install --upgrade "paneldraw[spi]"')
        self._chip = f"/dev/gpiochip{gpiochip}" if isinstance(gpiochip, int) else gpiochip
        self._requests: dict[Line, tuple[Any, int]] = {}
        self._values = self._gpiod.line.Value.INACTIVE, self._gpiod.line.Value.ACTIVE

    def claim(self, line: Line, *, high: bool) -> None:
        """Make a line an output at a level."""
        gpiod = self._gpiod
        path, offset = self._find(line)
        settings = gpiod.LineSettings(direction=gpiod.line.Direction.OUTPUT, output_value=self._values[high])
        with self._opened(path) as chip:
            try:
                request = chip.request_lines({offset: settings}, consumer="paneldraw")
            except OSError as error:
                if error.errno != errno.EBUSY:
                    raise _not_opened(error, path) from error
                holder = chip.get_line_info(offset).consumer or "the kernel"
                advice = "take another line, or end the program or the overlay in config.txt that holds it"
                complaint = f"line {line} of {path} is in use by {holder}: {advice}"
                raise PanelBusyError(error.errno, complaint) from error
        self._requests[line] = request, offset

    def set(self, line: Line, value: bool) -> None:
        """Put a line high or low."""
        if line not in self._requests:
            raise TransportError(errno.EBADF, f"line {line} is closed: open a new transport")
        request, offset = self._requests[line]
        request.set_value(offset, self._values[value])

    def close(self) -> None:
        """Release all lines. Closing twice does nothing."""
        while self._requests:
            self._requests.popitem()[1][0].release()

    def _find(self, line: Line) -> tuple[str, int]:
        """Find the path of a line's chip and the line's number there."""
        labels = {}
        for path in [self._chip] if self._chip is not None else _paths():
            with self._opened(path) as chip:
                offset = _offset(chip, line)
                labels[path] = chip.get_info().label
            if offset is not None and (self._chip is not None or isinstance(line, str) or labels[path] in HEADERS):
                return path, offset
        chips = ", ".join(f"{path} ({label})" for path, label in labels.items()) or "no /dev/gpiochip*"
        where = "on a Raspberry Pi's header" if self._chip is None else f"on {self._chip}"
        advice = "see `gpioinfo` for lines, and give the chip as gpiochip= or the line by its name"
        raise PanelNotFoundError(errno.ENOENT, f"found no line {line} {where}; there is {chips}: {advice}")

    def _opened(self, path: str) -> Any:
        try:
            return self._gpiod.Chip(path)
        except OSError as error:
            raise _not_opened(error, path) from error


def package(name: str) -> Any:
    """Import a package of the extra ``spi``.

    Raises
    ------
    PanelError
        It is not installed, or not for this system.
    """
    try:
        return importlib.import_module(name)
    except ImportError as error:
        where = 'pip install "paneldraw[spi]"' if sys.platform == "linux" else "it is for Linux alone"
        raise PanelError(f"the package {name} is missing, which panels on SPI and reset lines need: {where}") from error


def _check(name: str, line: Line | None) -> None:
    if isinstance(line, bool) or not isinstance(line, (int, str, type(None))):
        raise TypeError(f"{name} must be the number or name of a GPIO line, or None, not {line!r}")
    if isinstance(line, int) and line < 0:
        raise ValueError(f"{name} must be 0 or more, not {line}")


def _paths() -> list[str]:
    # Links, such as the gpiochip4 that a Raspberry Pi 5 keeps for old programs, lead to what is listed anyway.
    return sorted(path for path in glob.glob("/dev/gpiochip*") if not os.path.islink(path))


def _offset(chip: Any, line: Line) -> int | None:
    if isinstance(line, int):
        return line if line < chip.get_info().num_lines else None
    try:
        return int(chip.line_offset_from_id(line))
    except OSError:
        return None


def _not_opened(error: OSError, path: str) -> TransportError:
    if error.errno in (errno.EACCES, errno.EPERM):
        return PanelPermissionError(error.errno, f"no permission to open {path}: {join_group('gpio')}")
    if error.errno in (errno.ENOENT, errno.ENODEV, errno.ENXIO, errno.ENOTTY):
        there = ", ".join(_paths()) or "no other"
        return PanelNotFoundError(error.errno, f"{path} is no GPIO chip; there is {there}: see `gpiodetect`")
    return TransportError(error.errno, f"cannot open {path}: {error.strerror or error}")
