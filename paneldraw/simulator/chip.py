"""What every simulated chip has: power, the two ways that bytes reach it, frames, and what is said of the driver."""

from __future__ import annotations

import random
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from copy import copy
from types import MappingProxyType, SimpleNamespace
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

import numpy as np

from .frames import Frame, History, Picture, Progress
from .looks import Look, image

if TYPE_CHECKING:
    from PIL.Image import Image

    from .addressing import Place
    from .eye import Timeline

_STATUS_OFF = 0x40
_MOST_STEPS = 1000


def written(sent: Iterable[int]) -> str:
    """Bytes as violations and remarks spell them."""
    return " ".join(f"{byte:02X}" for byte in sent)


class Registers(SimpleNamespace):
    """The registers of a chip, by name; a chip's command table says which there are."""


class Listener(Protocol):
    """Who is told what a chip makes of the bytes that it is sent."""

    def told(self, kind: str, sent: bytes, meaning: str) -> None:
        """Note a ``"command"``, ``"violation"``, ``"remark"``, ``"read"`` or ``"power"``, with its bytes, in words."""

    def placed(self, count: int, places: Sequence[Place], down: bool) -> None:
        """Note data: so many bytes, and the lines and columns that they went to; columns and lines if `down`."""

    def seen(self, frame: Frame) -> None:
        """Note a frame."""

    def settled(self, seconds: float) -> None:
        """Note that a call of the bus is over."""


class Chip(ABC):
    """A chip with its glass.

    Attributes
    ----------
    frames : History of Frame
        A `collections.deque` of the whole pictures that were shown, whoever drives the chip; the last one may still be
        growing. A picture that comes in several calls is one frame, and a call that sets the pointer and writes data is
        one (`Progress` has the rule); so is a command that changes what is seen. What leaves the panel as it was is
        none.
    violations : list of str
        What the chip was sent against its datasheet and what changes the picture, or may: each rule once, with the
        bytes that broke it first. Clear it as you like.
    remarks : list of str
        What is merely not in the sheet, or a relative's command that the chip lets pass, in the same way.
    wire_bytes : int
        Bytes on the wire that were for the chip, address bytes included.
    registers : Registers
        All other state, by name.
    hold : callable or None
        Does something while the bus stands still, having told the chip what time it is; set by the bus.
    listener : Listener or None
        Who is told what the chip makes of its bytes: a `Transcript`.
    """

    buses: ClassVar[tuple[str, ...]] = ("i2c", "spi")
    """The buses that the chip can sit on."""
    has_dc: ClassVar[bool] = True
    """Whether a pin tells commands from data on SPI."""
    max_level: int = 1
    """The level of a fully lit pixel."""
    look: ClassVar[str] = "white"
    """How the chip's panels look in a picture, by its name in `LOOKS`."""
    reset_values: Mapping[str, Any] = MappingProxyType({})
    """The registers and what reset gives them."""

    registers: Registers
    timeline: Timeline | None = None
    """What the chip took lately, where it remembers."""

    def __init__(
        self, width: int, height: int, *, history: int | None, seed: int | None, cells: tuple[int, ...] = (0,)
    ) -> None:
        self.width, self.height = width, height
        self.hold: Callable[[Callable[[], object]], None] | None = None
        self.listener: Listener | None = None
        self._frames = History(history)
        self.violations: list[str] = []
        self.remarks: list[str] = []
        self._random = random.Random(seed)
        self._seen: Picture = np.zeros((height, width), np.uint8)
        self.wire_bytes = self._unframed_bytes = 0
        self._progress = Progress(cells)
        self._last: tuple[Frame | None, int] = (None, 0)
        self._growing: tuple[float, int, int] | None = None
        self.power_cycle()

    # power

    def power_cycle(self) -> None:
        """Lose power and get it back: registers at reset, RAM undefined (noise from `seed`)."""
        self._end_picture()
        if self.listener:
            self.listener.told("power", b"", "power lost and back; what the RAM holds is noise")
        self._lose_ram()
        self.reset()

    def reset(self) -> None:
        """Pull the reset pin: registers at reset, a half-sent command forgotten, RAM as it was."""
        self._end_picture()
        if self.listener:
            self.listener.told("power", b"", "reset")
        self.registers = Registers(**{name: copy(value) for name, value in self.reset_values.items()})
        self._picture: Picture | None = None
        self._next_step: float | None = None

    # the wire

    @abstractmethod
    def write(self, payload: bytes | bytearray | memoryview) -> None:
        """Take one I2C write: the bytes after the address byte."""

    @abstractmethod
    def transfer(self, run: bytes | bytearray | memoryview, data: bool) -> bytes | None:
        """Take bytes over SPI, with the D/C line low (`data` False: commands) or high.

        Return the bytes that leave the chip's data output meanwhile, None from one that has none.
        """

    def deselect(self) -> None:  # noqa: B027 - most chips do not care
        """Note that the chip select of the SPI rises."""

    def read(self, length: int) -> bytes:
        """Answer one I2C read: the status byte, `length` times. Bit 6 is set while the display is off."""
        return self._answer(bytes([self.status]) * length, "status")

    def _answer(self, answer: bytes, meaning: str) -> bytes:
        """Tell who listens what is read."""
        if self.listener:
            self.listener.told("read", answer, meaning)
        return answer

    def settle(self, seconds: float, wire_bytes: int) -> None:
        """Note that a bus call is over: record a frame if the eye sees another picture than before.

        Buses call this; call it yourself only where you call `write` or `transfer` without a bus.

        Parameters
        ----------
        seconds : float
            The time, for the frame.
        wire_bytes : int
            Bytes that this call put on the wire for this chip.
        """
        if self.listener:
            self.listener.settled(seconds)
        if self.timeline:
            self.timeline.settle(seconds)  # what no bus has timed
            self.timeline.wait(seconds)
        self.wire_bytes += wire_bytes
        self._unframed_bytes += wire_bytes
        progress = self._progress
        drew = progress.end_call(seconds, self._unfilled)
        if self._growing and self._growing[1] != progress.number:
            self._end_picture()
        if drew and progress.open:
            self._growing = seconds, drew, self._unframed_bytes + (self._growing[2] if self._growing else 0)
            self._unframed_bytes = 0
        elif self._picture is None and not self._growing:
            self._see(seconds, drew)
        if not (period := self._step_seconds):
            self._next_step = None
        elif self._next_step is None:
            self._next_step = seconds + period

    def wait(self, seconds: float) -> None:
        """Let time pass up to `seconds`: what the chip moves by itself moves on, a frame a step. Buses call this."""
        if self.timeline:
            self.timeline.wait(seconds)
        if self._next_step is None or seconds < self._next_step or not (period := self._step_seconds):
            return
        self._end_picture()
        steps = int((seconds - self._next_step) / period) + 1
        unseen = max(steps - (self._frames.maxlen or _MOST_STEPS), 0)
        if unseen:
            self._step(unseen)
        for number in range(unseen, steps):
            self._step(1)
            self._picture = None
            self._see(self._next_step + number * period, 0)
        self._next_step += steps * period

    def _end_picture(self) -> None:
        """Look at a picture that has grown by several calls, before anything else changes it, or when somebody asks."""
        if self._growing:
            seconds, number, wire_bytes = self._growing
            self._growing, later_bytes = None, self._unframed_bytes
            self._unframed_bytes = wire_bytes
            self._see(seconds, number)
            self._unframed_bytes += later_bytes

    def _see(self, seconds: float, number: int) -> None:
        """Record a frame if the eye sees another picture: in place of the last, if that was its beginning."""
        pixels = self._present()
        if pixels is not self._seen and not np.array_equal(pixels, self._seen):
            frame, last_number = self._last
            if frame and number and number == last_number and self._frames and self._frames[-1] is frame:
                self._unframed_bytes += frame.wire_bytes
                self._frames.pop()
            frame = Frame(pixels, seconds, self._unframed_bytes, self.max_level)
            self._frames.append(frame)
            self._last = frame, number
            self._unframed_bytes = 0
            if self.listener:
                self.listener.seen(frame)
        self._seen = pixels

    def _at_rest(self, look: Callable[[], object]) -> None:
        """Look at the chip while nobody writes to it: who looks may be another thread than who draws."""
        if self.hold:
            self.hold(look)
        else:
            look()

    def _present(self) -> Picture:
        if self._picture is None:
            self._picture = self._look()
            self._picture.flags.writeable = False
        return self._picture

    # what can be seen

    @property
    def pixels(self) -> Picture:
        """What an eye sees: levels from 0 to `max_level`, uint8, shape (height, width), read-only."""
        if self._picture is None or self._next_step is not None:
            self._at_rest(self._present)
        return self._present()

    @property
    def frames(self) -> History:
        """The whole pictures that were shown."""
        if self._growing or self._next_step is not None:
            self._at_rest(self._end_picture)
        return self._frames

    def render(self, scale: int = 4, look: str | Look | None = None) -> Image:
        """Draw what an eye sees as it looks on a panel.

        Parameters
        ----------
        scale : int
            Image pixels a panel pixel, at least 1. Default: 4.
        look : str or Look, optional
            A name of `LOOKS` or a look of your own. Default: that of the chip's panels.

        Returns
        -------
        PIL.Image.Image
            As `image` makes it.

        Examples
        --------
        >>> from paneldraw import simulator
        >>> simulator.SSD1306(128, 64).render(scale=2, look="yellow-blue").size
        (260, 132)
        """
        return image(self.pixels, scale=scale, max_level=self.max_level, look=look or self.look)

    @property
    def history(self) -> int | None:
        """How many frames `frames` keeps, the oldest dropped first; None keeps all. It can be set."""
        return self._frames.maxlen

    @history.setter
    def history(self, history: int | None) -> None:
        self._at_rest(lambda: setattr(self, "_frames", self._frames.resized(history)))

    @property
    def status(self) -> int:
        """The status byte."""
        return 0 if self.registers.on else _STATUS_OFF

    @property
    def contrast(self) -> int:
        """Contrast or brightness, in the chip's own steps."""
        return int(self.registers.contrast)

    def __repr__(self) -> str:
        power = "on" if self.registers.on else "off"
        return f"<{type(self).__name__} {self.width}x{self.height}, {power}, {len(self.frames)} frames>"

    # what is to be said of the driver

    def complain(self, rule: str, sent: Iterable[int] = ()) -> None:
        """Record a violation, unless its rule was spoken already; `sent` are the bytes that broke it."""
        self._say("violation", self.violations, rule, sent)

    def remark(self, rule: str, sent: Iterable[int] = ()) -> None:
        """Record a remark, unless it was made already."""
        self._say("remark", self.remarks, rule, sent)

    def _say(self, kind: str, texts: list[str], rule: str, sent: Iterable[int]) -> None:
        if self.listener:
            self.listener.told(kind, bytes(sent), rule)
        if not any(text.endswith(rule) for text in texts):
            texts.append(f"{spelled}: {rule}" if (spelled := written(sent)) else rule)

    def _tell(self, sent: Iterable[int], meaning: str) -> None:
        """Tell who listens what a command is."""
        if self.listener:
            self.listener.told("command", bytes(sent), meaning)

    # what a chip says

    @property
    def _unfilled(self) -> bool:
        """Whether the pointer stands within a window that it has not filled to the end."""
        return False

    @property
    def _step_seconds(self) -> float:
        """Seconds from step to step of what moves by itself; 0 while nothing does."""
        return 0

    def _step(self, count: int) -> None:  # noqa: B027 - most chips do not move
        """Move on by some steps."""

    @abstractmethod
    def _lose_ram(self) -> None:
        """Fill the RAM with noise."""

    @abstractmethod
    def _look(self) -> Picture:
        """Make a picture of what an eye sees."""
