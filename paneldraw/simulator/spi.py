"""A simulated SPI bus with the interfaces of ``spidev``, of our pins and of ``RPi.GPIO``, and faults on demand."""

from __future__ import annotations

import errno as codes
import os
import time
from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar, Final, Protocol

from . import log
from .chip import Chip
from .wire import Fault, Wire, check_bus, os_error

_MOST_VALUES: Final = 4096
_BUFSIZ: Final = 4096
_CPHA_CPOL: Final = 3


class SPIDevice(Protocol):
    """What the bus asks of a chip."""

    def transfer(self, run: bytes, data: bool) -> bytes | None:
        """Take bytes, D/C being high for `data`; return what leaves the data output meanwhile, None without one."""

    def deselect(self) -> None:
        """Note that the chip select rose."""

    def reset(self) -> None:
        """Note that the reset pin is low."""

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Note that a chip select is over; it put `wire_bytes` bytes on the wire and ended at `seconds`."""


class SPIBus(Wire):
    """A simulated SPI bus with one panel at its chip select, or a row of chips each of which feeds the next.

    Parameters
    ----------
    chips : device or sequence of device
        The chip; or the row of them, the one at the data line first. `chips` may be changed while the bus is in use.
    dc, reset : int or None
        Lines that the pins D/C and reset are wired to. None is a pin that the chips do not have or that nobody drives.
    cs : int or None
        Line that the chip select is wired to, for drivers that drive it themselves. Default: None, the bus's own.
    clock : float
        Clock rate in Hz until a driver sets ``max_speed_hz``. Default: 8 000 000.
    bufsiz : int
        Bytes that the kernel takes a transfer. Default: 4096, its own default.
    timer : callable or None
        As in `I2CBus`.

    Attributes
    ----------
    spi : object
        The interface of an open ``spidev.SpiDev``.
    pins : object
        What `SPITransport` takes for `pins`: ``set(line, value)``.
    gpio : object
        The interface of the module ``RPi.GPIO``, in BCM mode already.
    chips : list
    bufsiz : int
        Bytes that the kernel takes a transfer.
    bytes : int
        Bytes on the wire since the bus was made.
    messages : int
        Chip selects.
    seconds : float
        Time that the wire was busy: 8 bit times a byte.
    realtime : bool
        As of `I2CBus`.

    Raises
    ------
    ValueError
        A chip that cannot sit on SPI.

    Notes
    -----
    Limits and errors are py-spidev's and Linux's: 4096 values at most in ``xfer``, ``xfer2`` and ``writebytes``, while
    ``xfer3`` and ``writebytes2`` take more in as many chip selects as it needs; errno 90 (Message too long) past
    `bufsiz`; 9 (Bad file descriptor) after ``close``. Nobody need listen: a wire that is off, a reset pin held low or
    a select of the wrong polarity lose what is sent, without an error.

    Examples
    --------
    >>> from paneldraw import simulator
    >>> chip = simulator.SSD1306(128, 64)
    >>> bus = simulator.SPIBus(chip)
    >>> bus.pins.set(24, 0)
    >>> bus.spi.writebytes2(b"\\x8d\\x14\\xa5\\xaf")
    >>> bus.bytes, bus.messages, int(chip.pixels.sum())
    (4, 1, 8192)
    """

    log_form = "seconds c<hex> d<hex>: a chip select, commands and data"

    def __init__(
        self,
        chips: SPIDevice | Sequence[SPIDevice] = (),
        dc: int | None = 24,
        reset: int | None = 25,
        *,
        cs: int | None = None,
        clock: float = 8_000_000,
        bufsiz: int = _BUFSIZ,
        timer: Callable[[], float] | None = time.monotonic,
    ) -> None:
        if not clock > 0:
            raise ValueError(f"clock: {clock!r} is not a rate in Hz above 0")
        if bufsiz < 1:
            raise ValueError(f"bufsiz: {bufsiz!r} is not 1 or more")
        super().__init__(timer)
        self.chips: list[SPIDevice] = list(chips) if isinstance(chips, Sequence) else [chips]
        for chip in self.chips:
            check_bus(chip, "spi")
        self.dc, self.reset, self.cs, self.bufsiz = dc, reset, cs, bufsiz
        self._high = {line: True for line in (reset, cs) if line is not None}  # until driven, modules pull them up
        self.spi = SpiDev(self, int(clock))
        self.pins = Pins(self)
        self.gpio = GPIO(self)

    def fail(
        self,
        errno: int = codes.ETIMEDOUT,
        *,
        after: int = 0,
        at_byte: int | None = None,
        times: int | None = 1,
        then: Callable[[], object] | None = None,
    ) -> Fault:
        """Make a coming chip select fail.

        Parameters
        ----------
        errno : int
            What the call raises: ``ETIMEDOUT`` (default), ``EIO``, any other; 0 loses the bytes without an error, as a
            loose wire does.
        after : int
            How many chip selects pass first. Default: 0, the next fails.
        at_byte : int or None
            How many bytes the chip receives before the fault. Default: None, not one.
        times : int or None
            How many chip selects in a row fail; None is for ever. Default: 1.
        then : callable or None
            Called at the moment of the fault, with the chip having received what it did: ``chip.power_cycle``, say.

        Returns
        -------
        Fault
            The fault, waiting; `clear_faults` takes all away.

        Examples
        --------
        >>> from paneldraw import simulator
        >>> bus = simulator.SPIBus(simulator.SSD1306())
        >>> fault = bus.fail(errno=5)
        >>> bus.spi.writebytes([0xAF])
        Traceback (most recent call last):
        OSError: [Errno 5] Input/output error
        """
        return self._await(Fault(errno, after, at_byte, times, then))

    # inside

    def _level(self, line: int) -> bool:
        return self._high.get(line, False)

    def _drive(self, line: int, high: bool) -> None:
        """Put a line at a level."""
        with self._lock:
            before, self._high[line] = self._level(line), high
            if before == high:
                return
            if line == self.reset and not high:
                for chip in self.chips:
                    chip.reset()
                self._settle(0, 0)
                if self.log:
                    self.log.write(log.Reset(self._now))
            elif line == self.cs and high:
                self._deselect()
                if self.log:
                    self.log.write(log.Select(self._now, ()))

    def select(self, run: Sequence[bytes], speed: int = 0, delay: int = 0) -> None:
        """Put the bytes of one chip select on the wire, as far as faults let them.

        `speed` in Hz stands for the bus's own, and `delay` in microseconds is waited at the end.
        """
        payload = b"".join(run)
        seconds = 8 * len(payload) / (speed or self.spi.max_speed_hz or self.spi.default_speed) + delay / 1e6
        with self._lock:
            self._pass_time()
            self.messages += 1
            fault = self._due() if self._faults else None
            got = len(payload) if fault is None else fault.reach(len(payload))
            sent = got if fault and fault.errno else len(payload)
            self.bytes += sent
            for chip in self.chips:
                if isinstance(chip, Chip) and chip.timeline:
                    chip.timeline.begin(0.0, seconds / max(len(payload), 1))
            self._shift(payload[:got])
            if self.cs is None and not self.spi.no_cs:
                self._deselect()
            if fault and fault.then:
                fault.then()
            self._settle(seconds * sent / len(payload) if payload else seconds, sent)
            if self.log:
                self.log.write(self._heard(payload[:sent], got))
        self._rest()
        if fault and fault.errno:
            raise os_error(fault.errno)

    @property
    def _listening(self) -> bool:
        """Whether a chip takes what is sent."""
        selected = self._level(self.cs) if self.cs is not None else self.spi.cshigh
        listening = selected == getattr(self.chips[0], "cs_high", False) if self.chips else False
        return listening and (self.reset is None or self._level(self.reset))

    def _shift(self, run: bytes | None) -> None:
        if not run or not self._listening:
            return
        data = self.dc is not None and self._level(self.dc)
        for chip in self.chips:
            if run is None:
                raise TypeError("chips: in a row of them each but the last must have a data output")
            run = chip.transfer(run, data)

    def _heard(self, sent: bytes, got: int) -> log.Select:
        """What was sent, for the log, of which so many bytes arrived, if anybody listens."""
        data = (self.dc is not None and self._level(self.dc)) if self._listening else None
        runs = ((data, sent[:got]), (None, sent[got:]))
        ends = self.cs is None and not self.spi.no_cs
        return log.Select(self._now, tuple(run for run in runs if run[1]), ends)

    def _chips(self) -> Iterable[object]:
        return self.chips

    def _deselect(self) -> None:
        for chip in self.chips:
            chip.deselect()

    def _settle(self, busy: float, wire_bytes: int) -> None:
        now = self._elapse(busy)
        for chip in self.chips:
            if isinstance(chip, Chip) and chip.timeline:
                chip.timeline.settle(now - busy)
            chip.settle(now, wire_bytes)


class Pins:
    """The lines of a bus as `SPITransport` sets them."""

    def __init__(self, bus: SPIBus) -> None:
        self._bus = bus

    def set(self, line: int, value: bool) -> None:
        """Put a line high or low."""
        self._bus._drive(line, bool(value))

    def get(self, line: int) -> bool:
        """Return the level of a line."""
        return self._bus._level(line)


class SpiDev:
    """The interface of ``spidev.SpiDev``, open already."""

    def __init__(self, bus: SPIBus, speed: int) -> None:
        self._bus = bus
        self.default_speed = speed
        self.read0 = False
        self.open(0, 0)

    def open(self, bus: int, device: int) -> None:
        """Open the bus again after `close`; any numbers will do."""
        self._open = True
        self._mode, self._speed = 0, self.default_speed
        self._cshigh = self._no_cs = False

    def open_path(self, path: str | os.PathLike[str]) -> None:
        """Open the bus again after `close`; any path will do."""
        self.open(0, 0)

    def close(self) -> None:
        """Close the bus. The chips keep their state."""
        self._open = False

    def fileno(self) -> int:
        """Return -1: there is no file."""
        return -1

    def __enter__(self) -> SpiDev:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # settings

    @property
    def max_speed_hz(self) -> int:
        """Clock rate."""
        return self._speed if self._open else 0

    @max_speed_hz.setter
    def max_speed_hz(self, speed: int) -> None:
        self._check(isinstance(speed, int), "The max_speed_hz attribute must be an integer", speed > 0)
        self._speed = speed

    @property
    def mode(self) -> int:
        """Clock polarity and phase, 0 to 3."""
        return self._mode

    @mode.setter
    def mode(self, mode: int) -> None:
        valid = isinstance(mode, int) and 0 <= mode <= _CPHA_CPOL
        self._check(valid, "The mode attribute must be an integerbetween 0 and 3.")
        self._mode = mode

    @property
    def bits_per_word(self) -> int:
        """Bits a word: 8, as most adapters have no other."""
        return 8 if self._open else 0

    @bits_per_word.setter
    def bits_per_word(self, bits: int) -> None:
        self._check(8 <= bits <= 32, "invalid bits_per_word (8 to 32)", bits == 8)

    @property
    def cshigh(self) -> bool:
        """Whether the chip select is active high, as the ST7920's is, and no other's."""
        return self._cshigh

    @cshigh.setter
    def cshigh(self, high: bool) -> None:
        self._check(isinstance(high, bool), "The cshigh attribute must be boolean")
        self._cshigh = high

    @property
    def no_cs(self) -> bool:
        """Whether the bus leaves its chip select alone; the panel's is then tied to ground, or to a line of its own."""
        return self._no_cs

    @no_cs.setter
    def no_cs(self, alone: bool) -> None:
        self._check(isinstance(alone, bool), "The no_cs attribute must be boolean")
        self._no_cs = alone

    @property
    def lsbfirst(self) -> bool:
        """Whether bits go lowest first: never, as on most adapters; so it is with `threewire` and `loop`."""
        return False

    @lsbfirst.setter
    def lsbfirst(self, wanted: bool) -> None:
        self._check(isinstance(wanted, bool), "The attribute must be boolean", not wanted)

    threewire = loop = lsbfirst

    # transfers

    def xfer(
        self, values: Sequence[int], speed_hz: int = 0, delay_usecs: int = 0, bits_per_word: int = 0
    ) -> Sequence[int]:
        """Transfer up to 4096 bytes in one chip select; what comes back is zeros, put into `values` if it is a list."""
        payload = _bytes(values, _MOST_VALUES)
        self._transfer(payload, speed_hz, delay_usecs)
        return _answer(values, len(payload))

    xfer2 = xfer

    def xfer3(
        self, values: Sequence[int], speed_hz: int = 0, delay_usecs: int = 0, bits_per_word: int = 0
    ) -> tuple[int, ...]:
        """Transfer any number of bytes, in as many chip selects as it needs."""
        payload = _bytes(values)
        self._in_blocks(payload, speed_hz, delay_usecs)
        return (0,) * len(payload)

    def writebytes(self, values: Sequence[int]) -> None:
        """Send up to 4096 bytes in one chip select."""
        self._transfer(_bytes(values, _MOST_VALUES))

    def writebytes2(self, values: Any) -> None:
        """Send a buffer or any sequence, in as many chip selects as it needs."""
        try:
            view = memoryview(values)
        except TypeError:
            self._in_blocks(_bytes(values))
        else:
            self._in_blocks(view.tobytes() if view.contiguous else _bytes(list(values)))

    def readbytes(self, length: int) -> list[int]:
        """Read 1 to 4096 bytes, during which the data line sends zeros."""
        length = min(max(length, 1), _MOST_VALUES)
        self._transfer(bytes(length))
        return [0] * length

    # inside

    def _check(self, right_type: bool, complaint: str, valid: bool = True) -> None:
        if not right_type:
            raise TypeError(complaint)
        if not self._open:
            raise os_error(codes.EBADF)
        if not valid:
            raise os_error(codes.EINVAL)

    def _in_blocks(self, payload: bytes, speed_hz: int = 0, delay_usecs: int = 0) -> None:
        for start in range(0, len(payload), self._bus.bufsiz):
            self._transfer(payload[start : start + self._bus.bufsiz], speed_hz, delay_usecs)

    def _transfer(self, payload: bytes, speed_hz: int = 0, delay_usecs: int = 0) -> None:
        if not self._open:
            raise os_error(codes.EBADF)
        if len(payload) > self._bus.bufsiz:
            raise os_error(codes.EMSGSIZE)
        self._bus.select([payload], speed_hz, delay_usecs)


class GPIO:
    """The interface of the module ``RPi.GPIO``, as far as drivers of panels need it; lines by their BCM numbers."""

    BOARD: ClassVar[int] = 10
    BCM: ClassVar[int] = 11
    OUT: ClassVar[int] = 0
    IN: ClassVar[int] = 1
    LOW: ClassVar[int] = 0
    HIGH: ClassVar[int] = 1

    def __init__(self, bus: SPIBus) -> None:
        self._bus = bus
        self._outputs: set[int] = set()

    def setmode(self, mode: int) -> None:
        """Number lines as BCM does; nothing else is there."""
        if mode != self.BCM:
            raise ValueError("A different mode has already been set!")

    def getmode(self) -> int:
        """Return `BCM`."""
        return self.BCM

    def setwarnings(self, warn: bool) -> None:
        """There are no warnings."""

    def setup(self, channel: int | Iterable[int], direction: int, pull_up_down: int = 20, initial: int = -1) -> None:
        """Make lines outputs, with an initial level if one is given, or inputs."""
        for line in _lines(channel):
            if direction != self.OUT:
                self._outputs.discard(line)
                continue
            self._outputs.add(line)
            if initial >= 0:
                self._bus._drive(line, bool(initial))

    def output(self, channel: int | Iterable[int], value: int | Iterable[int]) -> None:
        """Put outputs high or low, each to its own level if there are as many."""
        lines = _lines(channel)
        levels = [value] * len(lines) if isinstance(value, int) else list(value)
        if len(levels) != len(lines):
            raise RuntimeError("Number of channels != number of values")
        for line, level in zip(lines, levels, strict=True):
            if line not in self._outputs:
                raise RuntimeError("The GPIO channel has not been set up as an OUTPUT")
            self._bus._drive(line, bool(level))

    def input(self, channel: int) -> int:
        """Return the level of a line."""
        return int(self._bus._level(channel))

    def cleanup(self, channel: int | Iterable[int] | None = None) -> None:
        """Make lines inputs again; a reset pin or chip select is then pulled up on the module."""
        for line in list(self._outputs) if channel is None else _lines(channel):
            self._outputs.discard(line)
            if line in (self._bus.reset, self._bus.cs):
                self._bus._drive(line, True)


def _lines(channel: int | Iterable[int]) -> list[int]:
    return [channel] if isinstance(channel, int) else list(channel)


def _bytes(values: Sequence[int], most: int | None = None) -> bytes:
    if len(values) == 0:
        raise TypeError("Empty argument list.")
    if most is not None and len(values) > most:
        raise OverflowError(f"Argument list size exceeds {most} bytes.")
    for value in values:
        if not isinstance(value, int):
            raise TypeError("Non-Int/Long value in arguments: 0.")
    return bytes(value & 0xFF for value in values)


def _answer(values: Sequence[int], length: int) -> Sequence[int]:
    zeros = [0] * length
    if isinstance(values, tuple):
        return tuple(zeros)
    if isinstance(values, list):
        values[:] = zeros
        return values
    return zeros
