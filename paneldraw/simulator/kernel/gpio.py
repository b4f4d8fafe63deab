"""Open files of /dev/gpiochip0 and of /sys/class/gpio: lines that D/C, reset and chip select pins are wired to."""

from __future__ import annotations

import errno
import struct
import threading
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from typing import Final

from ..spi import SPIBus
from ..wire import os_error

LABEL: Final = "pinctrl-bcm2711"
"""As the chip behind the header of a Raspberry Pi 4 calls itself: drivers look for it."""
LINES: Final = 58
_MOST: Final = 64
_NAME: Final = 32

_CHIP_INFO: Final = 0x8044B401
_LINE_INFO_1: Final = 0xC048B402
_LINE_HANDLE: Final = 0xC16CB403
_LINE_EVENT: Final = 0xC030B404
_LINE_INFO: Final = 0xC100B405
_WATCH: Final = 0xC100B406
_LINE: Final = 0xC250B407
_GET_1, _SET_1, _CONFIGURE_1 = 0xC040B408, 0xC040B409, 0xC054B40A
_WATCH_1: Final = 0xC048B40B
_UNWATCH: Final = 0xC004B40C
_CONFIGURE, _GET, _SET = 0xC110B40D, 0xC010B40E, 0xC010B40F

_LOW, _INPUT, _OUTPUT = 2, 4, 8
CLAIMS: Final = (_LINE, _LINE_HANDLE, _LINE_EVENT)
"""Requests that make a file of its own: `GPIOChip.claim` does them."""
_OUTPUT_1, _LOW_1 = 2, 4
_HANDLE_INPUT, _HANDLE_OUTPUT, _HANDLE_LOW = 1, 2, 4
_FLAGS, _VALUES = 1, 2


@dataclass
class Line:
    """A line of the chip: its level, and who holds it."""

    high: bool = False
    output: bool = False
    low_active: bool = False
    consumer: bytes | None = None
    wires: list[Callable[[bool], object]] = field(default_factory=list)
    """Called with the level whenever it is driven."""

    @property
    def value(self) -> bool:
        """Whether it is active."""
        return self.high != self.low_active

    def drive(self, active: bool) -> None:
        """Make it active or inactive."""
        self.high = active != self.low_active
        for wire in self.wires:
            wire(self.high)


class GPIOChip:
    """An open file of the chip of this machine's lines.

    Parameters
    ----------
    buses : iterable of SPIBus
        Whose D/C, reset and chip select pins the lines drive, by the numbers that the buses know them by.

    Attributes
    ----------
    lines : list of Line
    """

    def __init__(self, buses: Iterable[SPIBus] = ()) -> None:
        self.lines = [Line() for _ in range(LINES)]
        self._lock = threading.RLock()
        for bus in buses:
            for number in {bus.dc, bus.reset, bus.cs} - {None}:
                if number is not None and number < LINES:
                    self.lines[number].high = bus.pins.get(number)
                    self.lines[number].wires.append(_wire(bus, number))

    def close(self) -> None:
        """Do nothing: lines belong to those who asked for them."""

    def read(self, length: int) -> bytes:
        """Refuse: nobody waits for changes here."""
        raise os_error(errno.EAGAIN)

    def write(self, payload: bytes) -> int:
        """Refuse."""
        raise os_error(errno.EINVAL)

    def ioctl(self, request: int, value: int, argument: bytes) -> tuple[int, bytes]:
        """Answer what is asked of chip and lines."""
        if request == _CHIP_INFO:
            return 0, struct.pack("=32s32sI", b"gpiochip0", LABEL.encode(), LINES)
        if request in (_LINE_INFO, _WATCH):
            (number,) = struct.unpack_from("=I", argument, 2 * _NAME)
            line = self._line(number)
            flags = (line.consumer is not None) | _LOW * line.low_active | (_OUTPUT if line.output else _INPUT)
            return 0, struct.pack("=32s32sIIQ176x", _name(number), line.consumer or b"", number, 0, flags)
        if request in (_LINE_INFO_1, _WATCH_1):
            (number,) = struct.unpack_from("=I", argument)
            line = self._line(number)
            flags = (line.consumer is not None) | _OUTPUT_1 * line.output | _LOW_1 * line.low_active
            return 0, struct.pack("=II32s32s", number, flags, _name(number), line.consumer or b"")
        if request == _UNWATCH:
            return 0, argument
        raise os_error(errno.ENOTTY)

    def claim(self, request: int, argument: bytes) -> GPIOLines:
        """Give lines to who asks for them: what makes a file of its own."""
        if request == _LINE:
            (count,) = struct.unpack_from("=I", argument, 560)
            numbers, consumer = self._numbers(argument, count), argument[256:288]
            settings = _settings(argument[288:560], len(numbers))
        elif request == _LINE_HANDLE:
            (count,) = struct.unpack_from("=I", argument, 356)
            numbers, consumer = self._numbers(argument, count), argument[324:356]
            settings = _settings_1(argument[256:324], len(numbers))
        elif request == _LINE_EVENT:
            numbers, consumer = self._numbers(argument, 1), argument[12:44]
            settings = [(_INPUT, None)]
        else:
            raise os_error(errno.ENOTTY)
        return self.hold(numbers, consumer.partition(b"\0")[0], settings)

    def hold(
        self, numbers: Sequence[int], consumer: bytes, settings: Sequence[tuple[int, bool | None]] = ()
    ) -> GPIOLines:
        """Give lines to a consumer, with the flags and values of each."""
        lines = [self._line(number) for number in numbers]
        with self._lock:
            if len(set(numbers)) < len(numbers) or any(line.consumer is not None for line in lines):
                raise os_error(errno.EBUSY)
            for line in lines:
                line.consumer = consumer
        held = GPIOLines(lines)
        held.configure(settings)
        return held

    def _line(self, number: int) -> Line:
        if number >= LINES:
            raise os_error(errno.EINVAL)
        return self.lines[number]

    def _numbers(self, argument: bytes, count: int) -> tuple[int, ...]:
        if not 1 <= count <= _MOST:
            raise os_error(errno.EINVAL)
        numbers = struct.unpack_from(f"={count}I", argument)
        for number in numbers:
            self._line(number)
        return numbers


class GPIOLines:
    """Lines that one consumer holds."""

    def __init__(self, lines: list[Line]) -> None:
        self.lines = lines

    def close(self) -> None:
        """Let the lines go; they keep their levels."""
        for line in self.lines:
            line.consumer = None

    def configure(self, settings: Sequence[tuple[int, bool | None]]) -> None:
        """Set direction and polarity of every line, and the value of outputs."""
        for line, (flags, value) in zip(self.lines, settings, strict=False):
            line.low_active = bool(flags & _LOW)
            if flags & (_INPUT | _OUTPUT):
                line.output = bool(flags & _OUTPUT)
            if line.output and flags & _OUTPUT:
                line.drive(bool(value))

    def read(self, length: int) -> bytes:
        """Refuse: lines here do not change by themselves."""
        raise os_error(errno.EAGAIN)

    def write(self, payload: bytes) -> int:
        """Refuse."""
        raise os_error(errno.EINVAL)

    def ioctl(self, request: int, value: int, argument: bytes) -> tuple[int, bytes]:
        """Get and set values, and configure."""
        if request in (_GET, _SET):
            bits, mask = struct.unpack("=QQ", argument)
            if not mask & ((1 << len(self.lines)) - 1):
                raise os_error(errno.EINVAL)
            if request == _SET:
                self._set({at: bool(bits >> at & 1) for at in range(len(self.lines)) if mask >> at & 1})
                return 0, argument
            return 0, struct.pack("=QQ", sum(line.value << at for at, line in enumerate(self.lines)) & mask, mask)
        if request == _SET_1:
            self._set({at: bool(argument[at]) for at in range(len(self.lines))})
            return 0, argument
        if request == _GET_1:
            return 0, bytes(line.value for line in self.lines).ljust(_MOST, b"\0")
        if request == _CONFIGURE:
            self.configure(_settings(argument, len(self.lines)))
        elif request == _CONFIGURE_1:
            self.configure(_settings_1(argument, len(self.lines)))
        else:
            raise os_error(errno.ENOTTY)
        return 0, argument

    def _set(self, values: dict[int, bool]) -> None:
        if not all(self.lines[at].output for at in values):
            raise os_error(errno.EPERM)
        for at, active in values.items():
            self.lines[at].drive(active)


class SysfsLines:
    """The lines as /sys/class/gpio has them, for programs of before 2016.

    Parameters
    ----------
    chip : GPIOChip
    changed : callable
        Told the number of a line, and whether it has a directory now.
    """

    def __init__(self, chip: GPIOChip, changed: Callable[[int, bool], object]) -> None:
        self.chip = chip
        self.exported: dict[int, GPIOLines] = {}
        self._changed = changed

    def open(self, path: str) -> SysfsFile:
        """Open a file by its path below /sys/class/gpio."""
        return SysfsFile(self, path)

    def export(self, number: int) -> None:
        """Make a line's directory."""
        self.exported[number] = self.chip.hold([number], b"sysfs")
        self._changed(number, True)

    def unexport(self, number: int) -> None:
        """Take a line's directory away."""
        if number not in self.exported:
            raise os_error(errno.EINVAL)
        self.exported.pop(number).close()
        self._changed(number, False)


class SysfsFile:
    """An open file below /sys/class/gpio."""

    def __init__(self, lines: SysfsLines, path: str) -> None:
        self._lines = lines
        directory, _, self._name = path.rpartition("/")
        number = directory.removeprefix("gpio")
        self._line: Line | None = None
        if number.isdecimal():
            if int(number) not in lines.exported:
                raise os_error(errno.ENOENT)
            (self._line,) = lines.exported[int(number)].lines
        self._read = False

    def close(self) -> None:
        """Do nothing."""

    def read(self, length: int) -> bytes:
        """Read the value, once; an end of file follows."""
        if self._line is None:
            raise os_error(errno.EIO)
        if self._read:
            return b""
        self._read = True
        text = {
            "value": str(int(self._line.value)),
            "direction": "out" if self._line.output else "in",
            "active_low": str(int(self._line.low_active)),
        }.get(self._name, "none")
        return f"{text}\n".encode()[:length]

    def write(self, payload: bytes) -> int:
        """Take a value as text."""
        word = payload.decode("ascii", "replace").strip()
        if self._line is None:
            if not word.isdecimal():
                raise os_error(errno.EINVAL)
            (self._lines.export if self._name == "export" else self._lines.unexport)(int(word))
        elif self._name == "direction":
            if word not in ("in", "out", "low", "high"):
                raise os_error(errno.EINVAL)
            self._line.output = word != "in"
            if self._line.output:
                self._line.high = False
                self._line.drive((word == "high") != self._line.low_active)
        elif self._name == "value":
            if not self._line.output:
                raise os_error(errno.EPERM)
            self._line.drive(word not in ("", "0"))
        elif self._name == "active_low":
            self._line.low_active = word not in ("", "0")
        return len(payload)

    def ioctl(self, request: int, value: int, argument: bytes) -> tuple[int, bytes]:
        """Refuse."""
        raise os_error(errno.ENOTTY)


def _wire(bus: SPIBus, number: int) -> Callable[[bool], object]:
    return lambda high: bus.pins.set(number, high)


def _name(number: int) -> bytes:
    return f"GPIO{number}".encode()


def _settings(config: bytes, count: int) -> list[tuple[int, bool | None]]:
    """Flags and value of every line, of the kernel's ``gpio_v2_line_config``."""
    common, attributes = struct.unpack_from("=QI", config)
    flags, values = [common] * count, [False] * count
    for index in range(min(attributes, 10)):
        kind, _, content, mask = struct.unpack_from("=IIQQ", config, 32 + 24 * index)
        for at in range(count):
            if mask >> at & 1:
                if kind == _FLAGS:
                    flags[at] = content
                elif kind == _VALUES:
                    values[at] = bool(content >> at & 1)
    if any(each & _INPUT and each & _OUTPUT for each in flags):
        raise os_error(errno.EINVAL)
    return list(zip(flags, values, strict=True))


def _settings_1(config: bytes, count: int) -> list[tuple[int, bool | None]]:
    """The same of the first version's flags and values."""
    (flags,) = struct.unpack_from("=I", config)
    if flags & _HANDLE_INPUT and flags & _HANDLE_OUTPUT:
        raise os_error(errno.EINVAL)
    translated = (_INPUT if flags & _HANDLE_INPUT else 0) | (_OUTPUT if flags & _HANDLE_OUTPUT else 0)
    translated |= _LOW if flags & _HANDLE_LOW else 0
    return [(translated, bool(config[4 + at])) for at in range(count)]
