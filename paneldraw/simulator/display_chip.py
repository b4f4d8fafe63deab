"""A chip that commands and data reach apart: registers by a command table, a RAM behind a pointer, and a glass."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from .addressing import DOWN, PAGE, PAGES, Bytes, Counter, Packing, Place, levels, put, way
from .chip import Chip
from .commands import UNKNOWN, Command, Commands
from .eye import Timeline, flicker
from .frames import Picture
from .glass import Glass, Module, com_signals
from .scroll import Scroll

_PULSE = 50
"""Clocks that a line is lit."""
_OSCILLATOR, _OSCILLATOR_STEP = 210_000, 20_000


class DisplayChip(Chip):
    """A chip of which class attributes say all that is its own.

    Parameters
    ----------
    width, height : int, optional
        Visible size in pixels. Default: the first of `modules`.
    column_offset : int, optional
        First visible RAM column, upright and without a display offset. Default: as modules of that size are wired.
    com_pins : int, optional
        The setting of the COM pins that the glass is wired for: one of `com_pin_settings`. Default: as modules of that
        size are wired. Under another setting the lines appear where the pads take them.
    first_com : int, optional
        First COM signal that the glass uses. Default: as modules of that size are wired, else 0.
    external_vcc : bool
        The module has its own panel supply and lights up without the chip's. Default: False.
    history : int or None
        How many frames `frames` keeps, the oldest dropped first; None keeps all. Default: 1000.
    seed : int or None
        Seed of the noise that the RAM holds after power-up; None makes it differ from run to run. Default: 0.

    Raises
    ------
    ValueError
        For a size, offset or COM setting that the chip cannot have.
    """

    columns: int
    """Column addresses."""
    wide_columns: ClassVar[int] = 0
    """Those of look-alikes, where a column offset shows that it is one: the glass would not end within `columns`."""
    lines: ClassVar[int]
    """Line addresses: pages or rows."""
    last_rows: ClassVar[int] = 8
    """Rows of the last page."""
    line_name: ClassVar[str] = "page"
    """The register that points at one."""
    packing: ClassVar[Packing] = PAGES
    column_bytes: ClassVar[int] = 1
    """Bytes that share a column address."""
    commands: ClassVar[Commands]
    """The chip's commands and those of relatives, by opcode; all others are unknown to it."""
    modules: ClassVar[Mapping[tuple[int, int], Module]]
    """How modules are wired, by width and height."""
    com_pin_settings: ClassVar[tuple[int, ...]] = ()
    """The settings of the COM pins, if the chip has any, and which bits of them alternate pads and swap halves."""
    alternate_bit: ClassVar[int] = 0x10
    swap_bit: ClassVar[int] = 0x20
    upright: tuple[bool, bool] = (True, True)
    """The segment remap and the direction of the COM lines under which modules stand upright."""
    reversed_lines: int = 0
    """So many lines a reversed scan begins at the end of; 0 where they are as many as the multiplex ratio."""
    remaps_ram: ClassVar[bool] = True
    """Whether the segment remap mirrors what comes into the RAM, or else what comes out of it."""
    transposed: ClassVar[bool] = False
    """Whether COM lines are the columns of the RAM, and segments its rows."""
    last_column_wraps: ClassVar[bool] = True
    """Whether the page pointer returns to column 0, or else loses data past the last column."""
    supply: ClassVar[tuple[str, int]] = ("on", 1)
    """Register and bit that switch the panel's supply on. Default: it is on whenever the display is."""
    supply_command: ClassVar[str] = ""
    """What to send for it."""
    identity: ClassVar[int] = 0
    """The lower bits of the status byte."""
    highest_contrast: ClassVar[int] = 255
    arguments_are_data: ClassVar[bool] = False
    """Whether arguments come with D/C high, and data only after a command that says so (`registers.writing`)."""

    _table: ClassVar[tuple[Command, ...]]
    _has: ClassVar[frozenset[str]]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if hasattr(cls, "commands"):
            cls._table = tuple(cls.commands.get(opcode, UNKNOWN) for opcode in range(256))
            cls.reset_values = {name: value for command in cls._table for name, value in command.registers.items()}
            cls.max_level = 2**cls.packing.depth - 1
            cls._has = frozenset(cls.reset_values)

    def __init__(
        self,
        width: int | None = None,
        height: int | None = None,
        *,
        column_offset: int | None = None,
        com_pins: int | None = None,
        first_com: int | None = None,
        external_vcc: bool = False,
        history: int | None = 1000,
        seed: int | None = 0,
    ) -> None:
        usual = next(iter(self.modules))
        width, height = usual[0] if width is None else width, usual[1] if height is None else height
        if column_offset is not None and self.columns < column_offset + width <= self.wide_columns:
            self.columns = self.wide_columns
            self.reset_values = {**self.reset_values, "column_end": self.columns - 1}
        self._ram: Bytes = np.zeros((self.lines, self.columns, self.packing.elements * self.column_bytes), np.uint8)
        self.commons, self.segments = self._levels().shape[:: -1 if self.transposed else 1]
        self._glass = self._wired(width, height, self._module(width, height, column_offset, com_pins, first_com))
        self.external_vcc = external_vcc
        super().__init__(width, height, history=history, seed=seed, cells=self._ram.shape[:2])

    def reset(self) -> None:
        """Pull the reset pin: registers at reset, a half-sent command forgotten, RAM as it was."""
        super().reset()
        self._pending = b""
        self._half_cell = b""
        if self.timeline:
            self.timeline.changed()

    # the wire

    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one I2C write: the bytes after the address byte, control bytes included.

        A command whose arguments do not fit in this write waits for them in the next, as the chip does.
        """
        payload = bytes(payload)
        timeline, at = self.timeline, 1
        if payload and payload[0] in (0x00, 0x40):  # nearly always
            if timeline:
                timeline.at(at)
            self.transfer(payload[1:], payload[0] == 0x40)
        else:
            for data, run in self._runs(payload):
                if timeline:
                    timeline.at(at)
                self.transfer(run, data)
                at += len(run) + 1

    def transfer(self, run: bytes | bytearray | memoryview, data: bool) -> None:
        """Take bytes over SPI, with the D/C line low (`data` False: commands) or high."""
        if not run:
            return
        if self.arguments_are_data:
            self._take(bytes(run), data)
        elif not data:
            self._obey(bytes(run))
        else:
            if self._pending:
                self.complain("data while a command waits for its arguments", self._pending)
            self._store(np.frombuffer(run, np.uint8))

    # what can be seen

    @property
    def ram(self) -> Picture:
        """A copy of the RAM, uint8: bytes by page and segment where pixels are packed in pages, else levels."""
        return self._ram.reshape(self.lines, -1).copy()

    @property
    def status(self) -> int:
        """The status byte."""
        return super().status | self.identity

    @property
    def fed(self) -> bool:
        """Whether the panel has its supply."""
        register, bit = self.supply
        return bool(self.external_vcc or getattr(self.registers, register) & bit)

    @property
    def lit(self) -> bool:
        """Whether the panel is on and fed."""
        return bool(self.registers.on and self.fed)

    @property
    def mode(self) -> int:
        """The addressing mode: `ACROSS`, `DOWN` or `PAGE`."""
        return self.registers.mode if "mode" in self._has else PAGE

    @property
    def segment_remap(self) -> bool:
        """Whether column 0 is at the last segment."""
        return bool(self.registers.segment_remap)

    @property
    def high_first(self) -> bool:
        """Whether the first pixel of a cell is at its lower column, as seen from column 0."""
        return True

    @property
    def inverted(self) -> bool:
        """Whether levels are turned over."""
        return bool(self.registers.inverted)

    @property
    def all_on(self) -> bool:
        """Whether every pixel is at the highest level."""
        return bool(self.registers.all_on)

    @property
    def scan(self) -> tuple[int, int, int, bool, int]:
        """Multiplex ratio less 1, display offset, start line, whether COM lines are reversed, COM pins."""
        r = self.registers
        return r.multiplex, r.offset, r.start_line, r.com_reversed, r.com_pins if "com_pins" in self._has else 0

    def com_signals(self, setting: int) -> NDArray[np.intp]:
        """Which COM signal each pad carries under a setting of the COM pins."""
        alternate, swapped = bool(setting & self.alternate_bit), bool(setting & self.swap_bit)
        return com_signals(self.commons, alternate=alternate, swapped=swapped)

    @property
    def pages(self) -> Bytes:
        """The RAM as pages of bytes, or rows of cells, column 0 first; what is written to it is in the RAM."""
        return self._addressed[:, :, 0] if self.packing.rows == 8 else self._addressed

    def visible(self) -> tuple[range, range]:
        """Which column addresses and which lines the glass shows, in the present wiring and setting."""
        places = np.zeros((2, *self._ram.shape), np.uint8)  # no chip has more than 256
        places[0] = np.arange(self.columns)[:, None]
        places[1] = np.arange(self.lines)[:, None, None]
        if self.remaps_ram and self.segment_remap:
            places = places[:, :, ::-1]
        found = []
        for numbers in places:
            seen = self._spread(numbers.reshape(self.lines, -1))
            if not self.remaps_ram and self.segment_remap != self.upright[0]:
                seen = np.flip(seen, 0 if self.transposed else 1)
            shown, dark = self._glass.pixels(seen, self)
            if dark is not None:
                shown = np.moveaxis(shown, 1 if self.transposed else 0, 0)[~dark]
            found.append(range(int(shown.min()), int(shown.max()) + 1) if shown.size else range(0))
        return found[0], found[1]

    def _spread(self, cells: Bytes) -> Bytes:
        """Numbers of cells, rows and elements, as numbers of pixels."""
        if self.packing.rows == 1:
            return cells
        pixels = cells.repeat(self.packing.rows, axis=0)
        return pixels[: self.last_rows - self.packing.rows] if self.last_rows < self.packing.rows else pixels

    @property
    def frame_seconds(self) -> float:
        """How long the chip takes to show its RAM once: clocks a line and lines by the pace of the oscillator.

        The sheets give 370 kHz for its code 8 and a curve for the others, which is taken for even steps here.
        """
        r = self.registers
        clocks = (r.precharge & 0x0F) + (r.precharge >> 4) + _PULSE
        pace = _OSCILLATOR + _OSCILLATOR_STEP * (r.clock >> 4)
        return float(clocks * (r.multiplex + 1) * ((r.clock & 0x0F) + 1) / pace)

    @property
    def remembers(self) -> bool:
        """Whether the chip keeps what it takes for `seen` and `flicker`, which costs time. Default: False."""
        return self.timeline is not None

    @remembers.setter
    def remembers(self, remembers: bool) -> None:
        if remembers != self.remembers:
            self._at_rest(lambda: setattr(self, "timeline", Timeline(self) if remembers else None))
            self._at_rest(lambda: None)  # for the time

    def seen(self, seconds: float) -> NDArray[np.float64]:
        """Return the light that an eye saw of each pixel in the last seconds, on average.

        The chip scans its lines in its own time, `frame_seconds` a picture, and each shows what RAM and registers hold
        in that moment. Averaged are all the times that a line was scanned. `remembers` must have been set; what the
        chip held then counts for the time before.

        Parameters
        ----------
        seconds : float
            Up to 2, on the bus's clock, ending now.

        Returns
        -------
        numpy.ndarray
            Shape (height, width); 1 is a pixel of the highest level all the time at the highest contrast.

        Raises
        ------
        ValueError
            No scan is complete in that time, it is more than 2 seconds, or the chip does not remember.

        Examples
        --------
        >>> from paneldraw import simulator
        >>> chip = simulator.SSD1306()
        >>> chip.remembers = True
        >>> with simulator.I2CBus({0x3C: chip}, timer=None) as bus:
        ...     bus.write_i2c_block_data(0x3C, 0x00, [0x8D, 0x14, 0xA5, 0xAF])
        ...     bus.idle(0.2)
        >>> round(float(chip.seen(0.1).mean()), 3)  # contrast 7F of FF
        0.498
        """
        return self._remembered(lambda timeline: timeline.seen(seconds))

    def flicker(self, seconds: float) -> NDArray[np.float64]:
        """Return each pixel's strongest component below 50 Hz in the last seconds, relative to its light.

        `seconds` is as in `seen`, and the slowest flicker that is found takes as long.
        """
        return flicker(self._remembered(lambda timeline: timeline.scans(seconds)), self.frame_seconds)

    def _remembered(self, look: Callable[[Timeline], NDArray[np.float64]]) -> NDArray[np.float64]:
        """What a look at the timeline finds, while nothing comes."""
        found: list[NDArray[np.float64]] = []
        timeline = self.timeline
        if timeline is None:
            raise ValueError("remembers must be True before there is something to see over time")
        self._at_rest(lambda: found.append(look(timeline)))
        return found[0]

    # inside

    @property
    def _light(self) -> float:
        """Light of a lit pixel, as the contrast has it: the segment current of the SSD1306's sheet is in proportion."""
        return self.contrast / self.highest_contrast

    @property
    def _shares(self) -> NDArray[np.float64]:
        """Light of each level, of that of the highest."""
        return np.arange(self.max_level + 1) / self.max_level

    def _scan_order(self) -> NDArray[np.float64]:
        """When in a scan each visible line is lit, from 0 to 1."""
        multiplex = self.scan[0] + 1
        return (self._glass.turns(self) % multiplex + 0.5) / multiplex

    @property
    def _step_seconds(self) -> float:
        if "scroll" not in self._has or not self.registers.scrolling or not self.registers.scroll.opcode:
            return 0
        scroll: Scroll = self.registers.scroll
        return scroll.frames[scroll.interval] * self.frame_seconds

    def _step(self, count: int) -> None:
        self.registers.scroll.move(self.pages, count)
        if self.timeline:
            self.timeline.changed()

    def _lose_ram(self) -> None:
        noise = np.frombuffer(self._random.randbytes(self._ram.size), np.uint8).reshape(self._ram.shape)
        self._ram[:] = noise if self.packing.rows == 8 else noise & self.max_level

    def _runs(self, payload: bytes) -> Iterator[tuple[bool, bytes]]:
        """Split an I2C write at its control bytes into (is data, bytes)."""
        at = 0
        while at < len(payload):
            control = payload[at]
            if control & 0x3F:
                self.complain("the lower six bits of a control byte are 0", (control,))
            end = at + 2 if control & 0x80 else len(payload)
            if end > len(payload):
                self.complain("a byte must follow this control byte, and the transaction ended", (control,))
            yield bool(control & 0x40), payload[at + 1 : end]
            at = end

    def _command(self, opcode: int) -> Command:
        """The command of an opcode; chips that have several sets of commands choose here."""
        return self._table[opcode]

    def _obey(self, run: bytes) -> None:
        """Carry out the commands of a run; the last one may have to wait for its arguments."""
        run, at, end = self._pending + run, 0, 0
        while at < len(run) and (end := self._execute(run, at)) > at:
            at = end
        self._pending = run[at:]

    def _take(self, run: bytes, data: bool) -> None:
        """Take bytes where arguments come with D/C high, and data only behind the command for it."""
        for at, byte in enumerate(run):
            if data and not self._pending:
                if self.registers.writing:
                    self._store(np.frombuffer(run, np.uint8)[at:])
                else:
                    self.complain("data that no command waits for is lost")
                return
            if not data:
                if self._pending:
                    self.complain("a command is cut off before its arguments", self._pending)
                self._pending, self.registers.writing = b"", False
            self._pending += bytes((byte,))
            self._pending = self._pending[self._execute(self._pending) :]

    def _execute(self, run: bytes, at: int = 0) -> int:
        """Carry out the command there, if its arguments are; return where it ends, or where it began if it waits."""
        command = self._command(run[at])
        end = at + 1 + command.arguments
        if end > len(run):
            return at
        sent = run[at:end]
        if "locked" in self._has and self.registers.locked and sent[0] != 0xFD:
            self._tell(sent, "not obeyed")
            self.complain("commands are locked; send FD 12 first", sent)
            return end
        self._half_cell = b""
        if command.points:
            self._progress.pointed = True
        else:
            self._end_picture()
            self._picture = None
        command.act(self, sent)
        if self.timeline and not command.points:
            self.timeline.commanded(end)
        if self.listener:
            self._tell(sent, command.reading(self, sent))
        return end

    def _store(self, data: Bytes) -> None:
        """Take data into the RAM."""
        if self.supply_command and self.registers.on and not self.fed:
            self.complain(f"a picture for a panel that is on without a supply ({self.supply_command}) stays dark")
        if "scrolling" in self._has and self.registers.scrolling:
            self.complain("data while a scroll is running; send 2E first")
        if self.column_bytes > 1:
            data = np.frombuffer(self._half_cell + data.tobytes(), np.uint8)
            whole = data.size - data.size % self.column_bytes
            self._half_cell, data = data[whole:].tobytes(), data[:whole]
        self._place(self.packing.spread(data).reshape(-1, self._ram.shape[2]))

    @property
    def _addressed(self) -> Bytes:
        """The RAM's cells as addresses and bytes have them."""
        ram = self._ram
        if self.remaps_ram and self.segment_remap:
            ram = ram[:, ::-1, ::-1]
        return ram if self.high_first else ram[:, :, ::-1]

    def _place(self, cells: Bytes) -> None:
        """Put cells where the pointer stands, and move it on."""
        mode, ram = self.mode, self._addressed
        places, column, line = self._way(len(cells), mode)
        if self._progress.draw(places, down=mode == DOWN):
            self._end_picture()
        if self.listener:
            self.listener.placed(len(cells) * self.column_bytes, places, mode == DOWN)
        put(ram.swapaxes(0, 1) if mode == DOWN else ram, places, cells)
        if self.timeline:
            self.timeline.placed(places, cells, down=mode == DOWN, size=self.column_bytes)
        self._picture = None
        self.registers.column = column
        setattr(self.registers, self.line_name, line)

    def _way(self, count: int, mode: int) -> tuple[list[Place], int, int]:
        """Where so many cells go, in the order of the mode, and column and line of the pointer then."""
        if mode != PAGE:
            column, line = self._counters()
            if mode == DOWN:
                places, down, across = way(count, line, column)
                return places, across, down
            return way(count, column, line)
        at, page = self.registers.column, getattr(self.registers, self.line_name)
        end = at + count
        if end < self.columns:
            return [(page, slice(at, end))], end, page
        if self.last_column_wraps:
            last = self.columns - 1
            return way(count, Counter(at, 0, last, self.columns), Counter(page, page, page, self.lines))
        if end > self.columns:
            self.complain(f"data past column {self.columns - 1} is lost")
        return [(page, slice(at, self.columns))] if at < self.columns else [], self.columns, page

    def _counters(self) -> tuple[Counter, Counter]:
        """The pointer's two counters, in their windows."""
        registers, line = vars(self.registers), self.line_name
        first, last = registers.get("column_start", 0), registers.get("column_end", self.columns - 1)
        top, bottom = registers.get(f"{line}_start", 0), registers.get(f"{line}_end", self.lines - 1)
        return Counter(registers["column"], first, last, self.columns), Counter(
            registers[line], top, bottom, self.lines
        )

    @property
    def _unfilled(self) -> bool:
        """Whether the pointer stands within a window that it has not filled to the end."""
        if self.mode == PAGE:
            return False
        column, line = self._counters()
        return (column.at, line.at) != (column.first, line.first)

    def _look(self) -> Picture:
        if not self.lit:
            return np.zeros((self.height, self.width), np.uint8)
        seen, lines = self._levels(), 1 if self.transposed else 0
        if not self.remaps_ram and self.segment_remap != self.upright[0]:
            seen = np.flip(seen, 1 - lines)
        seen, dark = self._glass.pixels(seen, self)
        if self.all_on:
            seen = np.full_like(seen, self.max_level)
        elif self.inverted:
            seen = self.max_level - seen
        if dark is not None:
            np.moveaxis(seen, lines, 0)[dark] = 0
        return seen

    def _levels(self) -> Picture:
        """The RAM as levels: rows and columns."""
        seen = levels(self._ram, self.packing)
        if self.last_rows < self.packing.rows:
            seen = seen[: self.last_rows - self.packing.rows]
        return seen

    # the module

    def _module(
        self, width: int, height: int, column_offset: int | None, com_pins: int | None, first_com: int | None
    ) -> Module:
        """How a module is wired, after the table and what overrides it."""
        known = self.modules.get((width, height))
        if known is None:
            wirings = {module.com_pins for module in self.modules.values()}
            needed = {"column_offset": column_offset, **({"com_pins": com_pins} if len(wirings) > 1 else {})}
            missing = [name for name, value in needed.items() if value is None]
            if missing:
                sizes = ", ".join(f"{w}x{h}" for w, h in self.modules)
                raise ValueError(
                    f"width and height: {width}x{height} is no module known here ({sizes}); "
                    f"give {' and '.join(missing)} too"
                )
            known = Module(com_pins=wirings.pop())
        given: dict[str, Any] = {"column_offset": column_offset, "com_pins": com_pins, "first_com": first_com}
        return known._replace(**{name: value for name, value in given.items() if value is not None})

    def _wired(self, width: int, height: int, module: Module) -> Glass:
        """Join a glass to the chip, if it can be."""
        lines, dots = (width, height) if self.transposed else (height, width)
        wide, high = (self.commons, self.segments) if self.transposed else (self.segments, self.commons)
        if not 1 <= width <= wide or not 1 <= height <= high:
            raise ValueError(f"width and height: {width}x{height} is not within 1x1 and {wide}x{high}")
        most = self.commons - 1 if self.transposed else self.segments - width
        if not 0 <= module.column_offset <= most:
            raise ValueError(f"column_offset: {module.column_offset} is not 0 to {most}, for {width} columns of {wide}")
        if module.com_pins not in (self.com_pin_settings or (0,)):
            settings = ", ".join(f"{pins:#04x}" for pins in self.com_pin_settings) or "0: the chip has no such setting"
            raise ValueError(f"com_pins: {module.com_pins:#04x} is none of {settings}")
        if not 0 <= module.first_com < self.commons:
            raise ValueError(f"first_com: {module.first_com} is not 0 to {self.commons - 1}")
        first_line, first_dot = module.first_com, module.column_offset
        if self.transposed:
            first_line, first_dot = (first_line + first_dot) % self.commons, 0
        pads = np.roll(np.argsort(self.com_signals(module.com_pins)), -first_line)[:lines]
        return Glass(
            lines,
            dots,
            segments=self.segments,
            first_segment=first_dot,
            pads=pads,
            remapped=(module.upright or self.upright)[0],
            com_reversed=(module.upright or self.upright)[1],
            transposed=self.transposed,
        )
