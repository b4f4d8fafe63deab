"""What MicroPython scripts import besides, and how they run here unchanged.

Examples
--------
>>> from paneldraw.compat import micropython
>>> micropython.install()
>>> import framebuf, machine, time
>>> from micropython import const
>>> framebuf.MONO_HLSB, time.ticks_diff(time.ticks_add(0, 5), 0)
(3, 5)
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Final, TypeVar

__all__ = ["const", "install", "native", "viper"]

_T = TypeVar("_T")
_TICKS: Final = 1 << 30
"""Where ticks begin anew at 0, as on microcontrollers."""


def const(value: _T) -> _T:
    """Return the value: here it is no faster for being constant.

    Examples
    --------
    >>> from paneldraw.compat.micropython import const
    >>> const(0x3C)
    60
    """
    return value


def native(function: _T) -> _T:
    """Return the function as it is.

    Examples
    --------
    >>> from paneldraw.compat import micropython
    >>> @micropython.native
    ... def double(x):
    ...     return 2 * x
    >>> double(4)
    8
    """
    return function


viper = native


def install() -> None:
    """Let this process find MicroPython's modules by their own names.

    ``import framebuf``, ``machine``, ``micropython`` and ``utime`` find what is here, and ``time`` has MicroPython's
    `sleep_ms`, `sleep_us`, `ticks_ms`, `ticks_us`, `ticks_add` and `ticks_diff` as well. Call it before the driver or
    script is imported.

    Examples
    --------
    >>> from paneldraw.compat import micropython
    >>> micropython.install()
    >>> import framebuf
    >>> framebuf.__name__
    'paneldraw.compat.framebuf'
    """
    from paneldraw.compat import framebuf, machine

    sys.modules.update(framebuf=framebuf, machine=machine, micropython=sys.modules[__name__], utime=time)
    for name, function in _TIME.items():
        setattr(time, name, function)


def _ticks_diff(later: int, earlier: int) -> int:
    return (later - earlier + _TICKS // 2) % _TICKS - _TICKS // 2


_TIME: dict[str, Callable[..., object]] = {
    "sleep_ms": lambda ms: time.sleep(ms / 1000),
    "sleep_us": lambda us: time.sleep(us / 1_000_000),
    "ticks_ms": lambda: time.monotonic_ns() // 1_000_000 % _TICKS,
    "ticks_us": lambda: time.monotonic_ns() // 1000 % _TICKS,
    "ticks_add": lambda ticks, delta: (ticks + delta) % _TICKS,
    "ticks_diff": _ticks_diff,
}
