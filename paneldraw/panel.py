"""The panel as a script holds it: pictures in, bytes on the wire out."""

from __future__ import annotations

import contextlib
import operator
import os
import sys
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from paneldraw import urls
from paneldraw.controllers import BUSES, Controller
from paneldraw.controllers.packing import PACK
from paneldraw.errors import PanelError, TransportError
from paneldraw.framebuffer import Framebuffer, pictures
from paneldraw.transports import I2CTransport, SerialTransport, Transport
from paneldraw.update import Planner

Levels = npt.NDArray[np.uint8]
T = TypeVar("T")
OnClose = Literal["keep", "clear", "off"]
Updates = Literal["least", "plain", "whole"]

_ON_CLOSE: Final = ("keep", "clear", "off")
_ROTATIONS: Final = (0, 90, 180, 270)
_WIRING: Final = ("column_offset", "first_com", "com_pins")
"""What a simulated module is wired with, beside a driver that believes it."""
_RETRIES: Final = 2
_PAUSE: Final = 0.002


class Report(NamedTuple):
    """What one `Panel.show` did."""

    wire_bytes: int
    """Bytes on the wire, addresses and control bytes included."""
    messages: int
    changed_bytes: int
    """Bytes of panel RAM that differ from the picture before."""
    seconds: float

    @property
    def unchanged(self) -> bool:
        """Whether the panel already showed this picture, so that nothing was sent."""
        return self.messages == 0


class Sent(NamedTuple):
    """What some commands took."""

    wire_bytes: int
    messages: int


@dataclass(slots=True)
class Stats:
    """Sums over all `Report`s of a panel, and what went wrong on the way."""

    frames: int = 0
    unchanged: int = 0
    wire_bytes: int = 0
    messages: int = 0
    changed_bytes: int = 0
    seconds: float = 0.0
    retries: int = 0
    """Transient faults after which the whole picture was sent again."""

    def add(self, report: Report) -> None:
        """Count one more show."""
        self.frames += 1
        self.unchanged += report.messages == 0
        self.wire_bytes += report.wire_bytes
        self.messages += report.messages
        self.changed_bytes += report.changed_bytes
        self.seconds += report.seconds


class Panel:
    """A display: a controller chip behind a transport.

    The chip is initialized here, dark; the first `show` or `wake` lights it, so that no old RAM content flashes up.
    Threads may share a panel: each call is whole before the next begins.

    Parameters
    ----------
    controller : Controller
        What the chip and its glass are, such as ``SSD1306(128, 64)``.
    transport : Transport
        What carries the bytes, such as ``I2CTransport(bus=1)``. The panel closes it.
    rotate : int, optional
        Degrees by which the picture is turned clockwise: 0 (default), 90, 180 or 270.
    contrast : int, optional
        Brightness of lit pixels to begin with, 0 to 255. Default: what suits the chip.
    on_close : str, optional
        What `close` leaves behind: ``"keep"`` the picture (default), ``"clear"`` a black one, or a panel that is
        ``"off"``.
    updates : str, optional
        How pictures are sent: in the fewest bytes that the datasheet allows, ``"least"`` (default); ``"plain"``, every
        run addressed in full, with nothing assumed of the chip's pointers, for clones that do not keep to the
        datasheet; or ``"whole"``, every picture that differs as a whole, as plainly.

    Raises
    ------
    ValueError
        An unknown `rotate`, `contrast`, `on_close` or `updates`, or a chip that cannot be on this bus.
    TransportError
        The panel cannot be reached; the message says what to do.

    Examples
    --------
    >>> from paneldraw import Panel, simulator
    >>> from paneldraw.controllers import SSD1306
    >>> from paneldraw.transports import I2CTransport
    >>> bus = simulator.I2CBus({0x3C: simulator.SSD1306(128, 64)})
    >>> with Panel(SSD1306(128, 64), I2CTransport(bus)) as panel:
    ...     with panel.frame() as fb:
    ...         fb.line(0, 0, 127, 63)
    """

    def __init__(
        self,
        controller: Controller,
        transport: Transport,
        *,
        rotate: int = 0,
        contrast: int | None = None,
        on_close: OnClose = "keep",
        updates: Updates = "least",
    ) -> None:
        if on_close not in _ON_CLOSE:
            raise ValueError(f"on_close must be one of {', '.join(map(repr, _ON_CLOSE))}, not {on_close!r}")
        wire = getattr(transport, "wire", "")
        if wire in BUSES and wire not in controller.buses:
            buses = " or ".join(BUSES[bus] for bus in controller.buses)
            raise ValueError(f"controller must be one that {BUSES[wire]} reaches: the {controller.name} is on {buses}")
        self.controller = controller
        self.transport = transport
        self.stats = Stats()
        self.on_close: OnClose = on_close
        self._lock = threading.RLock()
        self._closed = False
        self._planner = Planner(controller, transport.cost, updates)
        self._pack = PACK[controller.packing]
        self._contrast = None if contrast is None else _checked_contrast(controller, contrast)
        self._drive: tuple[bytes, ...] = ()
        self._kept: list[bytes] = []
        self._inverted = False
        self._asleep = False
        self._ready = False  # the chip took its init, and nothing failed since
        self._lit = False
        self._shown = False
        self._own: Framebuffer | None = None
        self.rotate = rotate
        with self._lock:
            self._retrying(self._start)

    @property
    def rotate(self) -> int:
        """Degrees by which the picture is turned clockwise. A change takes effect with the next `show`."""
        return self._rotate

    @rotate.setter
    def rotate(self, degrees: int) -> None:
        if degrees not in _ROTATIONS:
            raise ValueError(f"rotate must be one of 0, 90, 180, 270, not {degrees!r}")
        with self._lock:
            self._rotate = degrees
            size = self.controller.width, self.controller.height
            self._size = size if degrees % 180 == 0 else size[::-1]

    @property
    def width(self) -> int:
        """Width of a picture in pixels, as `rotate` has it."""
        return self._size[0]

    @property
    def height(self) -> int:
        """Height of a picture in pixels, as `rotate` has it."""
        return self._size[1]

    @property
    def depth(self) -> int:
        """Bits a pixel."""
        return self.controller.depth

    def framebuffer(self) -> Framebuffer:
        """Make a blank framebuffer of this panel's size and depth."""
        return Framebuffer(self.width, self.height, self.depth)

    @contextlib.contextmanager
    def frame(self, *, clear: bool = True) -> Iterator[Framebuffer]:
        """Draw a picture and show it on leaving; nothing is shown if the block raises.

        Parameters
        ----------
        clear : bool, optional
            Start blank (default) or, if False, from the last frame's picture.

        Yields
        ------
        Framebuffer
        """
        picture = self.framebuffer()
        if not clear:
            with self._lock:
                picture.pixels[:] = self._own_picture().pixels
        yield picture
        with self._lock:
            self._own = picture
            self.show(picture)

    def show(self, source: Any = None, *, force: bool = False) -> Report:
        """Bring a picture onto the panel by sending what differs from the last one.

        Parameters
        ----------
        source : Framebuffer, numpy array or Pillow image, optional
            A picture of the panel's width and height. An array is (height, width), bool or integer levels from 0 to
            the panel's highest. What is deeper than the panel is reduced to its nearest levels. Default: the picture
            of the last `frame`.
        force : bool, optional
            Send everything, changed or not. Default: False.

        Returns
        -------
        Report

        Raises
        ------
        TypeError, ValueError
            `source` is no picture, or not of this size or depth.
        TransportError
            The panel could not be reached. The next show sends everything.
        """
        with self._lock:
            started = time.perf_counter()
            self._check_open()
            pixels, max_level = self._levels(source)
            self._pack(self._upright(pixels), max_level, self._planner.fresh)
            if force:
                self._planner.forget()
            report = Report(*self._retrying(self._send), time.perf_counter() - started)
            self.stats.add(report)
            return report

    def contrast(self, level: int) -> None:
        """Set the brightness of lit pixels, 0 to 255."""
        level = _checked_contrast(self.controller, level)
        with self._lock:
            self._contrast = level
            self._change(*self._brightness())

    def dim(self, level: int) -> None:
        """Set the brightness by contrast, precharge and COM voltage together: darker than contrast alone can.

        Parameters
        ----------
        level : int
            255 is as bright as contrast can make it. Down to 128 the contrast falls to 0; below, chips that have them
            lower precharge and COM voltage in steps, to the darkest at 0. Chips without go by contrast alone.

        Raises
        ------
        ValueError
            A level out of range, or a chip without contrast.
        """
        level = _checked_contrast(self.controller, level)
        steps = self.controller.drive[1:]
        with self._lock:
            self._contrast = max(0, 2 * level - 255) if steps else level
            self._drive = self.controller.drive[max(0, (127 - level) * len(steps) // 128 + 1)] if steps else ()
            self._change(*self._brightness())

    def command(self, command: bytes, *, keep: bool = False) -> None:
        """Send a command that the chip's record does not know, with its arguments.

        Parameters
        ----------
        command : bytes
            Opcode and arguments, as the datasheet has them. Nothing is known of them: a command that moves the chip's
            pointers or its mode of addressing spoils the pictures that follow, until ``show(force=True)``.
        keep : bool, optional
            Send it again whenever the chip is started anew, after a fault or a power cut. Default: False.

        Raises
        ------
        TypeError, ValueError
            It is no bytes, or empty.

        Examples
        --------
        >>> panel = open_panel("sim://ssd1306")
        >>> panel.command(b"\xd9\x11", keep=True)  # shorter precharge
        """
        if not isinstance(command, (bytes, bytearray)):
            raise TypeError(f"command must be bytes, not {type(command).__name__}")
        if not command:
            raise ValueError("command must not be empty")
        with self._lock:
            if keep:
                self._kept.append(bytes(command))
            self._change(bytes(command))

    def invert(self, inverted: bool = True) -> None:
        """Show lit pixels dark and dark ones lit, or with False as they are."""
        with self._lock:
            self._inverted = bool(inverted)
            self._change(self.controller.inverse if inverted else self.controller.normal)

    def sleep(self) -> None:
        """Turn the panel dark. It keeps its picture, takes new ones, and needs next to no power."""
        with self._lock:
            self._asleep, self._lit = True, False
            self._change(self.controller.power_off)

    def wake(self) -> None:
        """Light the panel again."""
        with self._lock:
            self._asleep = False
            self._change(self.controller.power_on)
            self._lit = True

    def invalidate(self) -> None:
        """Say that the panel's state is unknown, after a power cut for instance: the next show starts it anew."""
        with self._lock:
            self._ready = False

    def close(self) -> None:
        """Leave the panel as `on_close` says and close the transport. Closing twice does nothing."""
        with self._lock:
            if self._closed:
                return
            self._closed = True
            try:
                self._leave()
            finally:
                self.transport.close()

    def __enter__(self) -> Panel:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: object) -> None:
        if error is None:
            self.close()
        else:
            with contextlib.suppress(PanelError):  # what went wrong first is what the script must hear of
                self.close()

    def __repr__(self) -> str:
        state = "closed" if self._closed else f"rotate={self._rotate}"
        return f"<Panel {self.controller.name} {self.width}x{self.height}, {state}>"

    def _check_open(self) -> None:
        if self._closed:
            raise PanelError("this panel is closed: open a new one")

    def _own_picture(self) -> Framebuffer:
        if self._own is None or (self._own.width, self._own.height) != self._size:
            self._own = self.framebuffer()
        return self._own

    def _levels(self, source: Any) -> tuple[Levels, int]:
        if source is None:
            source = self._own_picture()
        if isinstance(source, Framebuffer):
            pixels, max_level = source.pixels, source.max_level
        elif isinstance(source, np.ndarray):
            pixels, max_level = _array(source, self.depth)
        elif (pillow := sys.modules.get("PIL.Image")) is not None and isinstance(source, pillow.Image):
            pixels, max_level = pictures.to_gray(source)[0], 255
        else:
            raise TypeError(f"source must be a Framebuffer, numpy array or Pillow image, not {type(source).__name__}")
        if pixels.shape != (self._size[1], self._size[0]):
            size = f"{pixels.shape[1]} x {pixels.shape[0]}" if pixels.ndim == 2 else f"an array of shape {pixels.shape}"
            raise ValueError(f"source must be {self.width} x {self.height} pixels like the panel, not {size}")
        return pixels, max_level

    def _upright(self, pixels: Levels) -> Levels:
        """The picture as the unturned glass has it: a view."""
        if self._rotate == 0:
            return pixels
        if self._rotate == 180:
            return pixels[::-1, ::-1]
        return pixels[::-1].T if self._rotate == 90 else pixels[:, ::-1].T

    def _retrying(self, operation: Callable[[], T]) -> T:
        """Try again after a transient fault; each operation restores a chip of which it cannot be sure."""
        for attempt in range(_RETRIES):
            try:
                return operation()
            except TransportError as error:
                if not error.transient:
                    raise
                self.stats.retries += 1
                time.sleep(_PAUSE * 2**attempt)
        return operation()

    def _start(self) -> Sent:
        """Bring the chip from any state to a dark, configured one."""
        chip = self.controller
        commands = [*chip.init, *([chip.inverse] if self._inverted else ()), *self._brightness(), *self._kept]
        self._lit = False
        sent = self._command(*([chip.resync] if chip.resync else ()), *commands)
        self._planner.restart()
        return sent

    def _send(self) -> tuple[int, int, int]:
        """Send the planner's fresh frame; return bytes on the wire, messages, changed bytes."""
        wire = messages = 0
        if not self._ready:
            wire, messages = self._start()
        self._ready = False  # the planner counts a plan as sent
        plan = self._planner.plan()
        if plan.count:
            wire += self.transport.batch(plan)
            self._planner.sent()
            self._shown = True
        self._ready = True
        if not (self._lit or self._asleep):
            power_on = self._command(self.controller.power_on)
            wire, messages = wire + power_on.wire_bytes, messages + power_on.messages
            self._lit = True
        return wire, messages + plan.count, plan.changed

    def _command(self, *commands: bytes) -> Sent:
        """Send commands, each with its arguments."""
        wire = messages = 0
        self._ready = False
        if self.controller.arguments_are_data:
            for command in commands:
                wire += self.transport.command(command[:1])
                if len(command) > 1:
                    wire += self.transport.data(command[1:])
                messages += 1 + (len(command) > 1)
        else:
            wire, messages = self.transport.command(b"".join(commands)), 1
        self._ready = True
        return Sent(wire, messages)

    def _change(self, *commands: bytes) -> None:
        """Send a setting, after the picture where the panel may have lost it."""
        self._check_open()

        def attempt() -> None:
            if not self._ready:
                self._restore()
            self._command(*commands)

        self._retrying(attempt)

    def _brightness(self) -> tuple[bytes, ...]:
        """Commands for what was asked for; none where init's brightness is to stay."""
        if self._contrast is None or self.controller.contrast is None:
            return ()
        return *self.controller.contrast.commands(self._contrast), *self._drive

    def _restore(self) -> None:
        if self._shown:
            self._send()
        else:
            self._start()

    def _leave(self) -> None:
        if self.on_close == "clear":
            self._planner.fresh[:] = 0
            self._retrying(self._send)
        elif self.on_close == "off":
            self._retrying(self._darken)

    def _darken(self) -> None:
        if self._ready:
            self._command(self.controller.power_off)
        else:
            self._start()


def _checked_contrast(controller: Controller, level: int) -> int:
    if controller.contrast is None:
        raise ValueError(f"contrast cannot be set: the {controller.name} has no command for it")
    level = operator.index(level)
    if not 0 <= level <= 255:
        raise ValueError(f"contrast must be 0 to 255, not {level!r}")
    return level


def _array(source: npt.NDArray[Any], depth: int) -> tuple[Levels, int]:
    max_level = 2**depth - 1
    if source.dtype == np.bool_:
        return source.view(np.uint8), 1
    if source.dtype.kind not in "ui":
        raise TypeError(f"source must be an array of bool or of integer levels, not {source.dtype}")
    if source.size and (source.max() > max_level or source.min() < 0):
        raise ValueError(
            f"source must hold levels from 0 to {max_level}; greys to 255 go through Pillow or Framebuffer.image"
        )
    return source.astype(np.uint8, copy=False), max_level


def open_panel(url: str | None = None) -> Panel:
    """Open the panel that a URL names.

    Parameters
    ----------
    url : str, optional
        ``i2c://1/0x3c?chip=ssd1306&size=128x64&rotate=180`` is a panel on bus 1 (or ``i2c:///dev/i2c-1/0x3c``);
        ``serial:///dev/ttyACM0?baudrate=1000000`` one behind a microcontroller, which says what it is; where a device's
        name stands, pyserial's ``socket://host:port``, ``rfc2217://host:port`` and the like may stand, without
        ``serial://`` too; ``sim://ssd1306?size=128x64`` a simulated one, whose chip is
        ``panel.transport.bus.devices[0x3C]``. Parameters are ``chip`` (of i2c and serial; a key of
        `paneldraw.controllers.CHIPS`), ``size``, the chip's own ones such as ``column_offset=2``, ``com_pins=0x12`` and
        ``mirror_x=1``, ``rotate``, ``contrast``, ``on_close`` and ``updates`` of `Panel`, ``max_message`` of i2c and
        ``baudrate`` of serial. Default: what the environment variable PANELDRAW_PANEL says, else ``sim://ssd1306``.

    Raises
    ------
    ValueError
        A scheme, chip, address or parameter that does not exist.
    PanelNotFoundError, PanelPermissionError, PanelBusyError
        The bus or port cannot be opened, or nobody answers there.
    ProtocolError
        The firmware behind the port is too old or too new, or has a panel of an unknown chip.

    Examples
    --------
    >>> with open_panel("sim://ssd1306?size=128x32") as panel:
    ...     panel
    <Panel ssd1306 128x32, rotate=0>
    """
    wanted = urls.parse(os.environ.get("PANELDRAW_PANEL") or "sim://ssd1306" if url is None else url)
    transport: Transport
    with contextlib.ExitStack() as unless_done:
        if isinstance(wanted, urls.SerialURL):
            transport = port = SerialTransport(wanted.port, wanted.baudrate)
            unless_done.callback(port.close)
            controller = wanted.controller(port.device)
        else:
            controller = wanted.controller
            if wanted.scheme == "sim":
                transport = _simulated(wanted)
            else:
                transport = I2CTransport(wanted.bus, wanted.address, **wanted.transport)
            unless_done.callback(transport.close)
        panel = Panel(controller, transport, **wanted.panel)
        unless_done.pop_all()
    return panel


def _simulated(wanted: urls.PanelURL) -> I2CTransport:
    from paneldraw import simulator  # a script with a real panel does not pay for it

    controller = wanted.controller
    wiring: dict[str, Any] = {name: wanted.module[name] for name in _WIRING if name in wanted.module}
    if not wanted.module.get("charge_pump", True):
        wiring["external_vcc"] = True
    chip = getattr(simulator, controller.name.upper())(controller.width, controller.height, **wiring)
    return I2CTransport(simulator.I2CBus({wanted.address: chip}), wanted.address)
