"""A byte-level SSD1306: takes what the wire carries, keeps the datasheet's state, shows what an eye would see."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Iterator

import numpy as np

from .frames import Frame, Picture
from .glass import MODULES, Glass, Module
from .ssd1306_commands import COLUMNS, COM_PINS, COMMANDS, HORIZONTAL, PAGES, ROWS, VERTICAL, Registers

_STATUS_OFF = 0x40
_MAX_VIOLATIONS = 1000


class SSD1306:
    """An SSD1306 with its glass: 128 x 64 bits of RAM behind a window of `width` x `height` pixels.

    Parameters
    ----------
    width, height : int
        Visible size in pixels: 128x64 (default), 128x32, 96x16, 72x40, 64x48, 64x32 or 48x64; any other size that the
        RAM holds needs `column_offset` and `com_pins`.
    column_offset : int, optional
        First visible RAM column under A1. Default: as modules of that size are wired (72x40: 28, 64x48 and 64x32: 32,
        48x64: 40, others 0).
    com_pins : int, optional
        The DA value that the glass is wired for: 0x02, 0x12, 0x22 or 0x32. Default: 0x02 (sequential) for 128x32 and
        96x16, 0x12 (alternative) for the others. Under another DA value the lines appear where the pads take them.
    external_vcc : bool
        The module has its own panel supply and lights up without the charge pump. Default: False.
    history : int or None
        How many frames `frames` keeps, the oldest dropped first; None keeps all. Default: 1000 (8 MB at 128x64).
    seed : int or None
        Seed of the noise that the RAM holds after power-up; None makes it differ from run to run. Default: 0.

    Attributes
    ----------
    frames : collections.deque of Frame
        One frame for every bus call (one ``i2c_rdwr`` or one SMBus call) that changed what the eye sees, unless the
        panel was dark before and after. A driver that sends a picture in several calls leaves several frames.
    violations : list of str
        What the datasheet forbids and the chip was sent, in order; each text once, at most 1000. Clear it as you like.
    registers : Registers
        All other state, by name.

    Raises
    ------
    ValueError
        For a size, offset or COM setting that the chip cannot have.

    Notes
    -----
    A command that the datasheet forbids is recorded and then acts as far as its bits reach; an unknown one is ignored.
    Hardware scrolling is state only: its commands are checked and kept, the picture stands still. Where the datasheet
    is silent: page mode runs through all 128 columns, whatever window was set; a pointer past the end of its window
    counts on to the end of the RAM; data in the middle of a command reaches the RAM and the command waits on; A5 lights
    an inverted display too; the status bits other than bit 6 are 0.

    Examples
    --------
    >>> chip = SSD1306(128, 32)
    >>> chip.write(bytes.fromhex("00 A8 1F DA 02 8D 14 20 00 A1 C8 A5 AF"))
    >>> chip.pixels.shape, int(chip.pixels.min())
    ((32, 128), 1)
    >>> chip.violations
    []
    """

    max_level = 1

    def __init__(
        self,
        width: int = 128,
        height: int = 64,
        *,
        column_offset: int | None = None,
        com_pins: int | None = None,
        external_vcc: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        self._glass = Glass(width, height, _module(width, height, column_offset, com_pins))
        self.width, self.height = width, height
        self.external_vcc = external_vcc
        self.frames: deque[Frame] = deque(maxlen=history)
        self.violations: list[str] = []
        self._random = random.Random(seed)
        self._ram = np.zeros((PAGES, COLUMNS), np.uint8)
        self._seen: Picture = np.zeros((height, width), np.uint8)
        self._unframed_bytes = 0
        self.power_cycle()

    # power

    def power_cycle(self) -> None:
        """Lose power and get it back: registers at reset, RAM undefined (noise from `seed`)."""
        noise = np.frombuffer(self._random.randbytes(self._ram.size), np.uint8)
        self._ram[:] = noise.reshape(self._ram.shape)
        self.reset()

    def reset(self) -> None:
        """Pull the reset pin: registers at reset, a half-sent command forgotten, RAM as it was."""
        self.registers = Registers(external_vcc=self.external_vcc)
        self._pending = bytearray()
        self._picture: Picture | None = None

    # the wire

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one I2C write: the bytes after the address byte, control bytes included.

        A command whose arguments do not fit in this write waits for them in the next, as the chip does.
        """
        self._picture = None
        for is_data, run in self._runs(bytes(payload)):
            if is_data:
                self._data(run)
            else:
                self._commands(run)

    def read(self, length: int) -> bytes:
        """Answer one I2C read: the status byte, `length` times. Bit 6 is set while the display is off."""
        return bytes([0 if self.registers.on else _STATUS_OFF]) * length

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Note that a bus call is over: record a frame if the eye sees another picture than before.

        Buses call this; call it yourself only where you call `write` without a bus.

        Parameters
        ----------
        seconds : float
            The time, for the frame.
        wire_bytes : int
            Bytes that this call put on the wire for this chip.
        """
        self._unframed_bytes += wire_bytes
        pixels = self.pixels
        if not np.array_equal(pixels, self._seen):
            self._seen = pixels
            self.frames.append(Frame(pixels, seconds, self._unframed_bytes, self.max_level))
            self._unframed_bytes = 0

    # what can be seen

    @property
    def pixels(self) -> Picture:
        """What an eye sees: levels 0 and 1, uint8, shape (height, width), read-only."""
        if self._picture is None:
            self._picture = self._glass.pixels(self._ram, self.registers)
            self._picture.flags.writeable = False
        return self._picture

    @property
    def ram(self) -> Picture:
        """A copy of the RAM, uint8, shape (8, 128): pages and segments. Under A1 column c is segment 127 - c."""
        return self._ram.copy()

    @property
    def contrast(self) -> int:
        """Contrast, 0 ... 255; 127 after reset."""
        return self.registers.contrast

    def __repr__(self) -> str:
        power = "on" if self.registers.on else "off"
        return f"<SSD1306 {self.width}x{self.height}, {power}, {len(self.frames)} frames>"

    # inside

    def _complain(self, violation: str) -> None:
        if violation not in self.violations and len(self.violations) < _MAX_VIOLATIONS:
            self.violations.append(violation)

    def _runs(self, payload: bytes) -> Iterator[tuple[bool, bytes]]:
        """Split a write at its control bytes into (is data, bytes)."""
        at = 0
        while at < len(payload):
            control = payload[at]
            if control & 0x3F:
                self._complain(f"control byte {control:02X}: the lower six bits are 0")
            one_byte = bool(control & 0x80)
            end = at + 2 if one_byte else len(payload)
            if end > len(payload):
                self._complain(f"control byte {control:02X}: a byte must follow, and the transaction ended")
            yield bool(control & 0x40), payload[at + 1 : end]
            at = end

    def _commands(self, run: bytes) -> None:
        for byte in run:
            self._pending.append(byte)
            command = COMMANDS[self._pending[0]]
            if len(self._pending) > command.arguments:
                command.act(self.registers, self._pending, self._complain)
                self._pending.clear()

    def _data(self, run: bytes) -> None:
        if not run:
            return
        registers = self.registers
        if self._pending:
            self._complain(f"data while command {self._pending[0]:02X} waits for its arguments")
        if registers.scroll.running:
            self._complain("data while a scroll is running; send 2E first")
        ram = self._ram[:, ::-1] if registers.segment_remap else self._ram
        levels = np.frombuffer(run, np.uint8)
        while levels.size:
            if registers.mode == VERTICAL:
                count = min(levels.size, _until(registers.page, registers.page_end, PAGES))
                ram[registers.page : registers.page + count, registers.column] = levels[:count]
            else:
                last = registers.column_end if registers.mode == HORIZONTAL else COLUMNS - 1
                count = min(levels.size, _until(registers.column, last, COLUMNS))
                ram[registers.page, registers.column : registers.column + count] = levels[:count]
            _advance(registers, count)
            levels = levels[count:]


def _until(position: int, last: int, size: int) -> int:
    """How many bytes fit before a pointer that counts up turns back: at the window's end, or past it at the RAM's."""
    return (last if position <= last else size - 1) - position + 1


def _advance(registers: Registers, count: int) -> None:
    """Move the pointers past `count` bytes that end no later than the next turn."""
    r = registers
    if r.mode == VERTICAL:
        r.page, turned = _step(r.page + count, r.page_start, r.page_end, PAGES)
        if turned:
            r.column, _ = _step(r.column + 1, r.column_start, r.column_end, COLUMNS)
    elif r.mode == HORIZONTAL:
        r.column, turned = _step(r.column + count, r.column_start, r.column_end, COLUMNS)
        if turned:
            r.page, _ = _step(r.page + 1, r.page_start, r.page_end, PAGES)
    else:
        r.column = (r.column + count) % COLUMNS


def _step(position: int, first: int, last: int, size: int) -> tuple[int, bool]:
    if position == last + 1:
        return first, True
    return position % size, False


def _module(width: int, height: int, column_offset: int | None, com_pins: int | None) -> Module:
    module = MODULES.get((width, height))
    offset = module.column_offset if column_offset is None and module else column_offset
    pins = module.com_pins if com_pins is None and module else com_pins
    if offset is None or pins is None:
        known = ", ".join(f"{w}x{h}" for w, h in MODULES)
        raise ValueError(
            f"width and height: {width}x{height} is no module known here ({known}); give column_offset and com_pins too"
        )
    if not 1 <= width <= COLUMNS or not 1 <= height <= ROWS:
        raise ValueError(f"width and height: {width}x{height} is not within 1x1 and {COLUMNS}x{ROWS}")
    if not 0 <= offset <= COLUMNS - width:
        raise ValueError(f"column_offset: {offset} is not 0 to {COLUMNS - width}, for {width} columns out of {COLUMNS}")
    if pins not in COM_PINS:
        raise ValueError(f"com_pins: {pins:#04x} is none of {', '.join(f'{p:#04x}' for p in COM_PINS)}")
    return Module(offset, pins)
