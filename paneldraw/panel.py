"""The panel as a script holds it: pictures in, bytes on the wire out."""

from __future__ import annotations

import contextlib
import functools
import operator
import os
import sys
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from paneldraw.care import Care
from paneldraw.controllers import BUSES, CHIPS, Controller, features
from paneldraw.controllers.packing import highest
from paneldraw.driver import Driver
from paneldraw.errors import PanelError, PanelTimeoutError, TransportError, did_you_mean
from paneldraw.framebuffer import Framebuffer, pictures
from paneldraw.framebuffer.pictures import Dither
from paneldraw.framebuffer.scaling import Fit
from paneldraw.leaving import arrange, follow
from paneldraw.sender import Sender
from paneldraw.transports import I2CTransport, Transport

if TYPE_CHECKING:
    from typing_extensions import Self  # part of mypy; of Python from 3.11 on

    from paneldraw import urls
    from paneldraw.cycling import Cycling
    from paneldraw.pacing import Frames

Levels = npt.NDArray[np.uint8]
OnClose = Literal["keep", "clear", "off"]
Updates = Literal["least", "plain", "whole"]

_ON_CLOSE: Final = ("keep", "clear", "off")
_ROTATIONS: Final = (0, 90, 180, 270)
_NAMED: Final = "the environment variable PANELDRAW_PANEL is {!r}: {}"


class Report(NamedTuple):
    """What one `Panel.show` did."""

    wire_bytes: int
    """Bytes on the wire, addresses and control bytes included."""
    messages: int
    changed_bytes: int
    """Bytes of panel RAM that differ from the picture before."""
    seconds: float

    queued: bool = False
    """Whether the picture was handed on, to be shown in a moment: by the sender, or by the call that this one
    interrupted."""

    @property
    def unchanged(self) -> bool:
        """Whether the panel already showed this picture, so that nothing was sent."""
        return self.changed_bytes == 0 and not self.queued


_report: Callable[[tuple[int, int, int, float, bool]], Report] = functools.partial(tuple.__new__, Report)
"""Makes a report of its fields; the constructor of a NamedTuple takes a twentieth of a small show longer."""

_QUEUED: Final = Report(0, 0, 0, 0.0, queued=True)


@dataclass(slots=True)
class Stats:
    """Sums over all reports of a panel, and what went wrong on the way."""

    frames: int = 0
    """Pictures, however many sub-pictures make their greys."""
    unchanged: int = 0
    wire_bytes: int = 0
    messages: int = 0
    changed_bytes: int = 0
    seconds: float = 0.0
    retries: int = 0
    """Faults after which the whole picture was sent again."""
    restarts: int = 0
    """How often the chip was started anew: after faults, lost power, `Panel.invalidate` and ``show(force=True)``."""
    dropped: int = 0
    """Pictures of ``show(wait=False)`` that a later one overtook."""
    sub_pictures: int = 0
    """What a panel with `greys` sent of its pictures, the first of each included."""
    fewer_greys: int = 0
    """Pictures of a panel with `greys` that the wire carries in fewer only."""
    cycled_by_host: int = 0
    """Pictures in greys of which a board that writes sub-pictures by itself cannot keep as many greys."""
    faults: dict[str, int] = field(default_factory=dict)
    """How many faults of each kind, by the system's name for them."""

    def add(self, report: Report, picture: bool = True) -> None:
        """Count one more show, which may be that of a sub-picture alone."""
        wire_bytes, messages, changed_bytes, seconds, _ = report
        self.frames += picture
        self.unchanged += picture and not changed_bytes
        self.wire_bytes += wire_bytes
        self.messages += messages
        self.changed_bytes += changed_bytes
        self.seconds += seconds


class Panel:
    """A display: a controller chip behind a transport.

    The chip is initialized here, dark; the first `show` or `wake` lights it, so that no old RAM content flashes up.
    Threads may share a panel: each call is whole before the next begins.

    Parameters
    ----------
    controller : Controller, chip or str
        What the chip and its glass are, such as ``SSD1306(128, 64)``; a chip alone, or its name, is its usual module.
    transport : Transport, int or bus
        What carries the bytes, such as ``I2CTransport(bus=1)``. The panel closes it. The number of an I2C bus, or an
        object with the interface of `smbus2.SMBus`, stands for the panel at that bus's usual address.
    rotate : int, optional
        Degrees by which the picture is turned clockwise: 0 (default), 90, 180 or 270.
    contrast : int, optional
        Brightness of lit pixels to begin with, 0 to 255. Default: what suits the chip.
    on_close : str, optional
        What `close` leaves behind: ``"keep"`` the picture (default), ``"clear"`` a black one, or a panel that is
        ``"off"``.
    refresh : float, optional
        Start the chip anew with the first show after so many seconds, for a bus on which lost power cannot be noticed.
        On I2C most chips say whether they are still on, and are asked once a second. Default: None, never.
    dim_after, off_after : float, optional
        Seconds without another picture after which the panel is as dark as `dim` can make it, or off; the next picture
        wakes it. Default: None, never.
    pixel_shift : float, optional
        Move the picture by a pixel every so many seconds, around a square, so that no edge burns in. Default: None.
    updates : str, optional
        How pictures are sent: in the fewest bytes that the datasheet allows, ``"least"`` (default); ``"plain"``, every
        run addressed in full, with nothing assumed of the chip's pointers, for clones that do not keep to the
        datasheet and for panels that another program writes to as well; or ``"whole"``, every picture that differs as a
        whole, as plainly.
    greys : int, optional
        3, 4, 5, 8 or 16 greys on a panel of one bit, black and white among them, by sub-pictures that the eye averages:
        a thread sends them while a picture has grey. `show` hands the picture to it and returns at once. What is
        deeper is rounded so that rows keep their light. Default: 1, none but black and white.
    bus_share : float, optional
        How much of the wire the sub-pictures may take. Default: 0.8.
    bus_clock : float, optional
        Bits a second of the wire, by which it is known beforehand how many greys it carries. Default: what the
        transport says, else 400 000, that of a fast I2C bus.
    weighted : bool or sequence of float, optional
        Whether the contrast makes a sub-picture worth several of another, so that fewer make as many greys: more often,
        and less true, as lines that are scanned between contrast and data show the one with the other. Or how much
        light there is at contrast 0 to 255, where that was measured. Default: False.

    Attributes
    ----------
    simulated : object
        The simulated chip, where `open_panel` made one; else None.

    Raises
    ------
    ValueError
        An unknown `rotate`, `contrast`, `on_close`, `updates` or `refresh`, or a chip that cannot be on this bus.
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
        controller: Controller | Callable[[], Controller] | str,
        transport: Any,
        *,
        rotate: int = 0,
        contrast: int | None = None,
        on_close: OnClose = "keep",
        updates: Updates = "least",
        refresh: float | None = None,
        dim_after: float | None = None,
        off_after: float | None = None,
        pixel_shift: float | None = None,
        greys: int = 1,
        bus_share: float = 0.8,
        bus_clock: float | None = None,
        weighted: bool | Sequence[float] = False,
    ) -> None:
        record = _record(controller)
        transport = _carrier(transport, record)
        try:
            self._set_up(record, transport, contrast, updates, refresh)
            wire: dict[str, Any] = {"bus_share": bus_share, "bus_clock": bus_clock, "weighted": weighted}
            self._cycling: Cycling | None = None
            if greys != 1:
                from paneldraw.cycling import Cycling

                self._cycling = Cycling(self._driver, self.stats, greys, **wire, updates=updates)
            self._care = Care(dim_after, off_after, pixel_shift, time.monotonic())
            self.rotate = rotate
            _check_on_close(on_close)
            with self._lock:
                self._driver.restore()
        except BaseException:
            self._closed = True
            transport.close()
            raise
        follow(self)
        self.on_close = on_close
        if self._care.needed:
            self._own_sender().wake_at(self._care.due())

    def _set_up(
        self, controller: Controller, transport: Transport, contrast: int | None, updates: str, refresh: float | None
    ) -> None:
        """Check what was asked for, and begin with nothing known of the chip."""
        wire = getattr(transport, "wire", "")
        if wire in BUSES and wire not in controller.buses:
            buses = " or ".join(BUSES[bus] for bus in controller.buses)
            raise ValueError(f"controller must be one that {BUSES[wire]} reaches: the {controller.name} is on {buses}")
        verbatim = getattr(transport, "verbatim", False)
        if controller.registers is not None and not controller.registers.chips and not verbatim:
            advice = "which this one puts before all that it sends; use I2CTransport"
            raise ValueError(f"transport must send no control bytes to the {controller.name}, {advice}")
        if refresh is not None and not refresh > 0:
            raise ValueError(f"refresh must be seconds above 0, or None, not {refresh!r}")
        self.controller = controller
        self.transport = transport
        self.stats = Stats()
        self.simulated: Any = None
        self._lock = threading.RLock()
        self._later: list[Callable[[], object]] = []
        self._closed = False
        self._foreign = 0  # the process that the panel belongs to, in a forked child
        self._sender: Sender | None = None
        level = None if contrast is None else _checked_contrast(controller, contrast)
        self._driver: Driver = Driver(controller, transport, self.stats, updates, level, refresh)
        self._own: Framebuffer | None = None
        self._dithered = np.zeros((0, 0), np.uint8)  # the last picture that was dithered "stable"
        self._last: tuple[Levels, int] = (np.zeros((0, 0), np.uint8), 0)  # the last picture, where it needs care

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
    def on_close(self) -> OnClose:
        """What `close` leaves behind, as does the end of the script: ``"keep"``, ``"clear"`` or ``"off"``."""
        return self._on_close

    @on_close.setter
    def on_close(self, value: OnClose) -> None:
        _check_on_close(value)
        self._on_close: OnClose = value
        if value != "keep":
            arrange(self)

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
        return self.controller.depth if self._cycling is None else self._cycling.depth

    def framebuffer(self, depth: int | None = None) -> Framebuffer:
        """Make a blank framebuffer of this panel's size and depth, or of another depth.

        Lines that are drawn deeper than the panel is keep their brightness at every angle: by themselves in `greys`, on
        a chip that has its own with ``show(fb, dither="blue-noise")``.

        Parameters
        ----------
        depth : int, optional
            Bits a pixel: 1, 2, 4 or 8. Default: the panel's.

        Returns
        -------
        Framebuffer

        Examples
        --------
        >>> panel = open_panel("sim://ssd1327")
        >>> panel.framebuffer().depth, panel.framebuffer(8).depth
        (4, 8)
        """
        return Framebuffer(self.width, self.height, self.depth if depth is None else depth)

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
        self._own = picture
        self.show(picture)

    def show(
        self,
        source: Any = None,
        *,
        force: bool = False,
        wait: bool = True,
        dither: Dither | None = None,
        gamma: float = 1.0,
    ) -> Report:
        """Bring a picture onto the panel by sending what differs from the last one.

        Parameters
        ----------
        source : Framebuffer, numpy array, Pillow image or path, optional
            A picture of the panel's width and height; a path is that of a file that Pillow reads. An array is
            (height, width), bool or integer levels from 0 to the panel's highest. What is transparent is dark. What is
            deeper than the panel is reduced to its levels as `dither` and `gamma` say. Default: the picture of the last
            `frame`.
        force : bool, optional
            Start the chip anew and send everything, changed or not. Default: False.
        wait : bool, optional
            False hands a copy of the picture to a thread that shows it, and returns at once. Of pictures that wait
            there the latest wins; what goes wrong is raised by the next call, or by `flush`. Default: True.
        dither, gamma : optional
            How grays become levels, as in `Framebuffer.image`; with ``"stable"``, pixels keep the level of the last
            picture that was shown so. Default: the nearest level; in `greys` one that keeps the light of rows.

        Returns
        -------
        Report

        Raises
        ------
        TypeError, ValueError
            `source` is no picture, or not of this size or depth.
        TransportError
            The panel could not be reached. The next show sends everything.
        PanelError
            The panel is closed, or belongs to the process that this one was forked from.

        Notes
        -----
        A show from a signal handler, in the middle of a show of the same thread, is done when that one is, and then
        that one's picture is shown again: the report says `queued`.
        """
        if self._closed or self._foreign or (self._sender is not None and self._sender.error is not None):
            self._listen()
        pixels, max_level = self._levels(source, dither, gamma)
        if wait and self._sender is None and self._cycling is None:
            return self._show(pixels, max_level, force)
        if not wait or self._cycling is not None:
            if force:
                self.invalidate()
            if (self._sender or self._own_sender()).put(pixels.copy(), max_level):
                self.stats.dropped += 1
            return _QUEUED
        self.flush()
        return self._show(pixels, max_level, force)

    async def ashow(
        self, source: Any = None, *, force: bool = False, dither: Dither | None = None, gamma: float = 1.0
    ) -> Report:
        """Show a picture without holding up the event loop, as `show` does; `source` is copied at once."""
        import asyncio

        if self._cycling is not None:
            return self.show(source, force=force, dither=dither, gamma=gamma)
        self._listen()
        pixels, max_level = self._levels(source, dither, gamma)
        return await asyncio.to_thread(self._show, pixels.copy(), max_level, force)

    def flush(self, timeout: float | None = None) -> None:
        """Wait until what was handed over by ``show(wait=False)`` is on the panel.

        Parameters
        ----------
        timeout : float, optional
            Seconds to wait at most. Default: as long as it takes.

        Raises
        ------
        PanelTimeoutError
            It took longer.
        TransportError
            What went wrong with a picture that was handed over.
        """
        if self._sender is not None:
            self._sender.flush(timeout)

    def frames(self, fps: float = 30) -> Frames:
        """Make an iterator that keeps to a beat: the loop of an animation.

        Parameters
        ----------
        fps : float, optional
            Frames a second, up to 1000. Default: 30.

        Returns
        -------
        Frames
            Of `Beat`: the number of the frame, the seconds since the start, and how many frames were left out because
            the one before took too long. That more was asked for than can be is said once, as a RuntimeWarning.

        Examples
        --------
        >>> panel = open_panel("sim://ssd1306")
        >>> for beat in panel.frames(fps=100):
        ...     with panel.frame() as fb:
        ...         fb.hline(0, 0, beat.number)
        ...     if beat.number >= 3:
        ...         break
        """
        from paneldraw.pacing import Frames

        return Frames(fps)

    def play(
        self,
        source: Any,
        *,
        loops: int | None = None,
        fit: Fit = "contain",
        dither: Dither | None = "stable",
        gamma: float = 1.0,
        invert: bool = False,
    ) -> int:
        """Show an animated GIF, APNG or WebP, each frame as long as it says, and return how many frames were shown.

        Frames whose time is over before they can be shown are left out, but for the last one of all.

        Parameters
        ----------
        source : path, PIL.Image.Image or Animation
        loops : int, optional
            How often to play it, 0 for ever. Default: as it says itself.
        fit, dither, gamma, invert
            As in `Framebuffer.image`. Default: the whole of it in the middle, ``"stable"``.

        Raises
        ------
        ValueError
            If an option is none.
        OSError
            If the file cannot be read.
        TransportError
            The panel could not be reached.

        Examples
        --------
        >>> from PIL import Image
        >>> film = [Image.new("L", (128, 64), gray) for gray in (0, 128, 255)]
        >>> film[0].save("film.gif", save_all=True, append_images=film[1:], duration=20)
        >>> panel = open_panel("sim://ssd1306")
        >>> 1 <= panel.play("film.gif") <= 3
        True
        """
        from paneldraw.animation import play

        if loops is not None and operator.index(loops) < 0:
            raise ValueError(f"loops must be 0, for ever, or more, not {loops}")
        return play(self, source, loops, {"fit": fit, "dither": dither, "gamma": gamma, "invert": invert})

    def clear(self) -> Report:
        """Show a black picture."""
        return self.show(self.framebuffer())

    def contrast(self, level: int) -> None:
        """Set the brightness of lit pixels, 0 to 255."""
        self._driver.contrast = _checked_contrast(self.controller, level)
        self._change(self._driver.brightness)

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
        driver = self._driver
        driver.contrast = max(0, 2 * level - 255) if steps else level
        driver.drive = self.controller.drive[max(0, (127 - level) * len(steps) // 128 + 1)] if steps else ()
        self._change(driver.brightness)

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
        >>> panel.command(bytes((0xD9, 0x11)), keep=True)  # shorter precharge
        """
        if not isinstance(command, (bytes, bytearray)):
            raise TypeError(f"command must be bytes, not {type(command).__name__}")
        if not command:
            raise ValueError("command must not be empty")
        sent = bytes(command)
        if self.controller.registers is not None and len(sent) % self.controller.registers.command_bytes:
            size = self.controller.registers.command_bytes
            raise ValueError(f"command must be of {size} bytes, or several of them, not {sent.hex(' ').upper()}")
        if keep:
            self._driver.kept.append(sent)
        self._change(lambda: (sent,))

    def invert(self, inverted: bool = True) -> None:
        """Show lit pixels dark and dark ones lit, or with False as they are."""
        self._change(lambda: self._driver.invert(bool(inverted)))

    def all_on(self, on: bool = True) -> None:
        """Light every pixel, whatever the picture is, or with False show the picture again.

        Raises
        ------
        ValueError
            The chip has no command for it; the message names those that have.
        """
        if not self.controller.all_on:
            raise features.lacking(self.controller, "light every pixel by itself", lambda chip: chip.all_on)
        self._driver.all_on = bool(on)
        self._change(lambda: (*(() if on else self.controller.follow), *self._driver.mode()))

    def blink(self, speed: float | None = 1.0) -> None:
        """Let the chip blink by itself: fade to dark and back, or go off and on.

        Parameters
        ----------
        speed : float or None, optional
            From 0, the chip's slowest, to 1 (default), its fastest; the nearest that it has is taken. None ends it.

        Raises
        ------
        ValueError
            `speed` is out of range, or the chip cannot; the message names those that can.

        Examples
        --------
        >>> panel = open_panel("sim://ssd1306")
        >>> panel.blink()
        Traceback (most recent call last):
        ...
        ValueError: the SSD1306 cannot blink by itself; SSD1315, SSD1316, HT16K33 can
        """
        self._change(self._driver.affect(features.effect(self.controller, "blink"), speed))

    def fade(self, speed: float | None = 1.0) -> None:
        """Let the chip fade by itself until it is dark. It stays so until ``fade(None)``.

        Parameters and errors are those of `blink`, which ends fading, and the other way round.
        """
        self._change(self._driver.affect(features.effect(self.controller, "fade"), speed))

    def scroll(
        self,
        dx: int = -1,
        dy: int = 0,
        *,
        frames: float = 5,
        rows: tuple[int, int] | None = None,
        columns: tuple[int, int] | None = None,
        once: bool = False,
    ) -> None:
        """Let the chip move the picture by itself, round and round, until `stop_scroll` or the next picture.

        Parameters
        ----------
        dx, dy : int, optional
            By how many columns and rows a step moves it, as `Framebuffer.scroll` has them. Default: -1 and 0, to the
            left. Chips move by one column, and many only by rows and a column together.
        frames : float, optional
            How many of the panel's frames, of about 10 ms each, are from step to step; the nearest interval that the
            chip has is taken. Default: 5.
        rows, columns : (int, int), optional
            The first one that moves and the one behind the last. Default: all. Rows that move across are whole pages
            of eight on chips of one bit a pixel; some chips have no choice of columns.
        once : bool, optional
            Make one step of one column only, on chips that can: the next call waits two frames for it. What comes in at
            the edge is not to be relied on until the next `show`, which sends just what differs. Default: False.

        Raises
        ------
        ValueError
            The chip cannot do it, and which ones can; or rows, columns and steps that cannot be.

        Notes
        -----
        The chip moves its RAM, and takes no picture meanwhile: `show` ends the scroll and sends its picture whole, and
        so does recovery after a fault. Across the glass an SSD1306 or SSD1305 moves all columns of its RAM; those
        beside a narrower glass are blank.

        Examples
        --------
        >>> panel = open_panel("sim://ssd1306")
        >>> with panel.frame() as fb:
        ...     fb.text("news", 0, 0)
        >>> panel.scroll(frames=2, rows=(0, 8))
        """
        box = self._box(rows, columns)
        across, down = {0: (dx, dy), 90: (-dy, dx), 180: (-dx, -dy), 270: (dy, -dx)}[self._rotate]
        if once:
            commands = features.scroll_once(self.controller, across, down, box)
        else:
            commands = features.scroll(self.controller, across, down, frames, box)
        self._change(lambda: self._driver.set_in_motion(commands, across, box, once))

    def stop_scroll(self) -> None:
        """End a scroll; the picture stays where it is until the next `show`, which sends it whole."""
        if self.controller.scroll is None:
            raise features.lacking(self.controller, "scroll by itself", lambda chip: chip.scroll)
        self._change(self._driver.still)

    def sleep(self) -> None:
        """Turn the panel dark. It keeps its picture, takes new ones, and needs next to no power."""
        self._driver.asleep = True
        self._change(self._driver.power)

    def wake(self) -> None:
        """Light the panel again; one that was shown nothing yet lights with its first picture.

        A chip that is asked whether it lost its power is started anew: asleep it could not tell.
        """
        self._driver.wake()
        self._change(self._driver.power)
        if self._moving() is not None:
            self._wake_in_time()

    def invalidate(self) -> None:
        """Say that the panel's state is unknown, after a power cut for instance: the next show starts it anew."""
        self._driver.doubt()

    def close(self) -> None:
        """Leave the panel as `on_close` says and close the transport. Closing twice does nothing.

        What ``show(wait=False)`` was given is shown first.
        """
        if self._closed or self._foreign:
            self._closed = True
            return
        if self._postponed(self._end):
            return
        sender = self._sender
        if sender is not None:
            with contextlib.suppress(PanelTimeoutError):
                sender.flush(2.0)
            sender.stop()
        with self._lock:
            self._end()

    def _end(self) -> None:
        if self._closed:
            return
        if self._sender is not None:
            self._sender.stop(0.0)
        try:
            if self._cycling is not None and self._on_close == "keep":
                with contextlib.suppress(TransportError):  # a panel that is gone may be closed
                    self._cycling.settle()
            self._driver.leave(self._on_close)
        finally:
            self._closed = True
            self.transport.close()

    def __del__(self) -> None:
        if getattr(self, "_on_close", "keep") != "keep" and not self._closed:
            with contextlib.suppress(Exception):
                self.close()
        elif getattr(self, "_sender", None) is not None:
            self._sender.stop(0.0)  # type: ignore[union-attr]

    def __enter__(self) -> Self:
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

    def _check(self) -> None:
        if self._closed:
            raise PanelError("this panel is closed: open a new one")
        if self._foreign:
            raise PanelError(f"this panel is that of process {self._foreign}, which was forked: open a new one here")

    def _listen(self) -> None:
        """Check that the panel can be used; raise what went wrong with a picture that was handed over."""
        self._check()
        if self._sender is not None:
            self._sender.raise_error()

    def _disown(self) -> None:
        """Know, in a forked child, that the panel is the parent's."""
        self._foreign = self._foreign or os.getppid()
        self._lock = threading.RLock()  # another thread of the parent may hold the old one
        self._sender = None

    def _own_picture(self) -> Framebuffer:
        if self._own is None or (self._own.width, self._own.height) != self._size:
            self._own = self.framebuffer()
        return self._own

    def _levels(self, source: Any, dither: Dither | None = None, gamma: float = 1.0) -> tuple[Levels, int]:
        if source is None:
            source = self._own_picture()
        if isinstance(source, Framebuffer):
            pixels, max_level = source.pixels, source.max_level
        elif isinstance(source, np.ndarray):
            pixels, max_level = _array(source, self.depth)
        elif isinstance(source, (str, os.PathLike)) or (
            (pillow := sys.modules.get("PIL.Image")) is not None and isinstance(source, pillow.Image)
        ):
            pixels, max_level = _on_black(source), 255
        else:
            kind = type(source).__name__
            raise TypeError(f"source must be a Framebuffer, numpy array, Pillow image or file name, not {kind}")
        if pixels.shape != (self._size[1], self._size[0]):
            size = f"{pixels.shape[1]} x {pixels.shape[0]}" if pixels.ndim == 2 else f"an array of shape {pixels.shape}"
            raise ValueError(f"source must be {self.width} x {self.height} pixels like the panel, not {size}")
        if dither is not None or gamma != 1:
            top = 2**self.depth - 1
            if self._cycling is not None:
                top = self._cycling.greys - 1 if dither else 255  # which it rounds by itself
            before = self._dithered if self._dithered.shape == pixels.shape else None
            grays = pixels * np.uint8(255 // max_level)
            pixels, max_level = pictures.quantize(grays, top, dither, gamma=gamma, before=before), top
            if dither == "stable":
                self._dithered = pixels
        return pixels, max_level

    def _upright(self, pixels: Levels) -> Levels:
        """The picture as the unturned glass has it: a view."""
        if self._rotate == 0:
            return pixels
        if self._rotate == 180:
            return pixels[::-1, ::-1]
        return pixels[::-1].T if self._rotate == 90 else pixels[:, ::-1].T

    def _box(self, rows: tuple[int, int] | None, columns: tuple[int, int] | None) -> features.Box:
        """The part of the unturned glass that some rows and columns of the picture are."""
        marked = np.zeros((self.height, self.width), np.uint8)
        for name, chosen, size in (("rows", rows, self.height), ("columns", columns, self.width)):
            if chosen is not None and not 0 <= chosen[0] < chosen[1] <= size:
                raise ValueError(f"{name} must be a first one and the one behind the last, 0 to {size}, not {chosen}")
        marked[slice(*rows) if rows else slice(None), slice(*columns) if columns else slice(None)] = 1
        y, x = np.nonzero(self._upright(marked))
        return features.Box(int(x[0]), int(y[0]), int(x[-1]) + 1, int(y[-1]) + 1)

    # -- One call at a time

    def _postponed(self, operation: Callable[[], object]) -> bool:
        """Put an operation off if it comes in the middle of this thread's own call, as from a signal handler."""
        inside = self._inside()
        if inside:
            self._later.append(operation)
        return inside

    def _inside(self) -> bool:
        """Whether this thread is in the middle of a call."""
        return bool(self._lock._is_owned())  # type: ignore[attr-defined]

    def _own_sender(self) -> Sender:
        if self._sender is None:
            self._sender = Sender(self)
        return self._sender

    def _show(self, pixels: Levels, max_level: int, force: bool = False) -> Report:
        """Show checked levels."""
        if self._cycling is not None:
            return self._show_greys(pixels, max_level, force, self._cycling)
        started = time.perf_counter()
        if self._lock._is_owned():  # type: ignore[attr-defined]
            copy = pixels.copy()
            self._later.append(lambda: self._show_now(copy, max_level, force, time.perf_counter()))
            return _QUEUED
        report = None
        with self._lock:
            try:
                report = self._show_now(pixels, max_level, force, started)
            finally:
                if self._later and self._catch_up() and report is not None:
                    self._show_now(pixels, max_level, False, time.perf_counter())
        return report

    def _show_greys(self, pixels: Levels, max_level: int, force: bool, cycling: Cycling) -> Report:
        """End the cycle of the last picture and begin one of another."""
        if self._care.needed:
            with self._lock:
                pixels = self._cared_for(pixels, max_level)
        upright = np.ascontiguousarray(self._upright(pixels))
        choice, still = cycling.choose(upright, max_level)
        while cycling.going and not cycling.boarded:
            time.sleep(max(0.0, cycling.due - time.monotonic()))
            if not cycling.within:
                break
            self._take_turn(cycling)
        with self._lock:
            if self._closed or self._foreign:
                self._check()
            cycling.begin(choice, still)
        return self._take_turn(cycling, force, picture=True)

    def _take_turn(self, cycling: Cycling, force: bool = False, *, picture: bool = False) -> Report:
        """Show the next sub-picture, of another picture or the same, and see to the one after."""
        started = time.perf_counter()
        report = _QUEUED
        with self._lock:
            if self._closed or self._foreign:
                cycling.stop()
                return report
            try:
                report = _report((*cycling.turn(force), time.perf_counter() - started, False))
            except BaseException:
                cycling.stop()
                raise
            finally:
                self._catch_up()
            self.stats.add(report, picture)
            self.stats.sub_pictures += 1
            self._wake_in_time()
        return report

    def _catch_up(self) -> bool:
        """Do what was put off; return whether the panel is still open then."""
        while self._later:
            self._later.pop(0)()
        return not self._closed

    def _show_now(self, pixels: Levels, max_level: int, force: bool, started: float) -> Report:
        if self._closed or self._foreign:
            self._check()
        if self._care.needed:
            pixels = self._cared_for(pixels, max_level)
        driver = self._driver
        driver.pack(self._upright(pixels) if self._rotate else pixels, max_level)
        report = _report((*driver.show(force, started), time.perf_counter() - started, False))
        self.stats.add(report)
        return report

    def _change(self, commands: Callable[[], Iterable[bytes]]) -> None:
        """Send commands for a setting, now or when this thread's own call that it interrupts is done."""
        self._listen()
        if self._postponed(lambda: self._driver.change(commands)):
            return
        with self._lock:
            try:
                self._driver.change(commands)
                if self._cycling is not None:
                    self._cycling.resume()
            finally:
                self._catch_up()

    # -- Care for the glass

    def _cared_for(self, pixels: Levels, max_level: int) -> Levels:
        """Remember a picture, wake the panel if it is another one, and return it where it is to be now."""
        last, highest = self._last
        if highest != max_level or not np.array_equal(pixels, last):
            self._last = pixels.copy(), max_level
            self._driver.wake_from_rest()
            self._care.changed(time.monotonic())
            self._wake_in_time()
        return self._care.moved(pixels)

    def _wake_in_time(self) -> None:
        """Have the sender look after the panel when the next sub-picture or care is due."""
        due, cycling = self._care.due() if self._care.needed else None, self._moving()
        if cycling is not None:
            due = cycling.due if due is None else min(due, cycling.due)
        if due is not None or self._care.needed:
            self._own_sender().wake_at(due)

    def _moving(self) -> Cycling | None:
        """The sub-pictures, if there are some to send now."""
        cycling, driver = self._cycling, self._driver
        seen = not driver.asleep and driver.rest != "off"
        return cycling if cycling is not None and cycling.going and seen else None

    def _look_after(self) -> None:
        """Send the next sub-picture, and do what is due when no other picture came for a while."""
        if self._care.needed:
            self._take_care()
        cycling = self._moving()
        if cycling is not None and time.monotonic() >= cycling.due:
            self._take_turn(cycling)
        elif cycling is not None:
            self._wake_in_time()

    def _take_care(self) -> None:
        with self._lock:
            if self._closed or self._foreign:
                return
            before = self._care.rest
            moves = self._care.act(time.monotonic()) and self._driver.shown
            if self._care.rest != before:
                self._driver.go_to_rest(self._care.rest)
            if moves and self._cycling is None:
                self._show_now(*self._last, False, time.perf_counter())
            self._wake_in_time()
        if moves and self._cycling is not None:
            self._show_greys(*self._last, False, self._cycling)


def _record(controller: Any) -> Controller:
    """The record that is meant by what a script gives for it."""
    if isinstance(controller, Controller):
        return controller
    if isinstance(controller, str):
        chip = CHIPS.get(controller.lower())
        if chip is None:
            hint = did_you_mean(controller.lower(), CHIPS)
            raise ValueError(f"controller must be one of {', '.join(CHIPS)}, not {controller!r}{hint}")
        return chip()
    if controller in CHIPS.values():
        made: Controller = controller()
        return made
    raise TypeError(f"controller must be a Controller, such as SSD1306(128, 64), or a chip's name, not {controller!r}")


def _carrier(transport: Any, controller: Controller) -> Transport:
    """The transport that is meant by what a script gives for it."""
    if all(callable(getattr(transport, name, None)) for name in ("command", "data", "batch", "close")):
        return transport  # type: ignore[no-any-return]
    if callable(getattr(transport, "i2c_rdwr", None)) or (
        isinstance(transport, (int, str)) and not isinstance(transport, bool)
    ):
        if "://" in str(transport):
            raise ValueError(f"transport must be a transport or a bus, not a URL: write open_panel({transport!r})")
        chip = CHIPS.get(controller.name)
        return I2CTransport(transport, chip.address if chip else 0x3C)
    raise TypeError(f"transport must be a transport, such as I2CTransport(bus=1), or an I2C bus, not {transport!r}")


def _check_on_close(value: str) -> None:
    if value not in _ON_CLOSE:
        raise ValueError(f"on_close must be one of {', '.join(map(repr, _ON_CLOSE))}, not {value!r}")


def _checked_contrast(controller: Controller, level: int) -> int:
    if controller.contrast is None:
        able = ", ".join(name for name, chip in CHIPS.items() if chip.contrast)
        raise ValueError(f"contrast cannot be set: the {controller.name} has no command for it; there is one on {able}")
    level = operator.index(level)
    if not 0 <= level <= 255:
        raise ValueError(f"contrast must be 0 to 255, not {level!r}")
    return level


def _on_black(source: Any) -> Levels:
    """The grays of a picture, dark where it is transparent."""
    grays, alpha = pictures.to_gray(source)
    return grays if alpha is None else ((grays.astype(np.uint16) * alpha + 127) // 255).astype(np.uint8)


def _array(source: npt.NDArray[Any], depth: int) -> tuple[Levels, int]:
    max_level = 2**depth - 1
    kind = source.dtype.kind
    if kind == "b":
        return source.view(np.uint8), 1
    if kind not in "ui":
        raise TypeError(f"source must be an array of bool or of integer levels, not {source.dtype}")
    plain = kind == "u" and source.itemsize == 1 and source.ndim == 2
    if plain:
        wrong = max_level < 255 and highest(source) > max_level
    else:
        wrong = bool(source.size) and (source.max() > max_level or source.min() < 0)
    if wrong:
        raise ValueError(
            f"source must hold levels from 0 to {max_level}; greys to 255 go through Pillow or Framebuffer.image"
        )
    return source if plain else source.astype(np.uint8), max_level


@contextlib.contextmanager
def _source_named(url: str | None) -> Iterator[None]:
    """Have what goes wrong say that the environment names the panel, where it does."""
    named = None if url is not None else os.environ.get("PANELDRAW_PANEL")
    try:
        yield
    except TransportError as error:
        if named:
            error.strerror = _NAMED.format(named, error.strerror)
        raise
    except (ValueError, PanelError) as error:
        if named:
            error.args = (_NAMED.format(named, error),)
        raise


def open_panel(url: str | None = None) -> Panel:
    """Open the panel that a URL names.

    Parameters
    ----------
    url : str, optional
        ``i2c://1/0x3c?chip=ssd1306&size=128x64&rotate=180`` is a panel on bus 1 (or ``i2c:///dev/i2c-1/0x3c``);
        ``serial:///dev/ttyACM0?baudrate=1000000`` one behind a microcontroller, which says what it is; where a device's
        name stands, pyserial's ``socket://host:port``, ``rfc2217://host:port`` and the like may stand, without
        ``serial://`` too; ``spi://0.0?chip=ssd1322&dc=24&reset=25`` one on chip select 0 of SPI bus 0;
        ``sim://ssd1306?size=128x64`` a simulated one, whose chip is ``panel.simulated``. Parameters are ``chip`` (a key
        of `paneldraw.controllers.CHIPS`), ``size``, the chip's own ones such as ``column_offset=2``, ``com_pins=0x12``
        and ``mirror_x=1``, ``rotate``, ``contrast``, ``on_close`` and ``updates`` of `Panel`, ``max_message`` of i2c,
        ``dc`` and ``speed`` of spi, ``reset`` and ``gpiochip`` of both, and ``baudrate`` of serial. Any panel, real or
        simulated, can be watched: ``view=terminal``, ``view=web`` or ``view=browser``, at ``listen=0.0.0.0:8306``;
        ``save=out.gif``, ``.png`` or ``.apng`` records it, and ``look=blue`` is its color; with ``realtime=1`` a
        simulated one takes the time that a wire takes. Default: what the environment variable PANELDRAW_PANEL says,
        else ``sim://ssd1306``.

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
    from paneldraw import transports, urls, watching  # a script that makes a Panel does not pay for all of them

    wanted = _wanted(url)
    transport: Transport
    simulated = None
    with _source_named(url), contextlib.ExitStack() as unless_done:
        watch = watching.asked(wanted)
        if isinstance(wanted, urls.SerialURL):
            transport = port = transports.SerialTransport(wanted.port, wanted.baudrate)
            unless_done.callback(port.close)
            controller = wanted.controller(port.device)
        else:
            controller = wanted.controller
            if wanted.scheme == "sim":
                transport, simulated, bus = _simulated(wanted)
            elif wanted.scheme == "spi":
                transport = transports.SPITransport(int(wanted.bus), **wanted.transport)
            else:
                transport = transports.I2CTransport(wanted.bus, wanted.address, **wanted.transport)
            unless_done.callback(transport.close)
        if watch:
            twin, chip, bus = (None, simulated, bus) if simulated else _simulated(wanted.twin(controller))
            if wanted.panel.get("greys", 1) > 1:
                from paneldraw.simulator.averaged import Averaged

                chip = Averaged(chip)
            title = f"{controller.name} {controller.width}x{controller.height}, {wanted.place}"
            transport = watched = watching.Watched(transport, watch, chip, bus, twin, title)
            unless_done.callback(transport.close)
        panel = Panel(controller, transport, **wanted.panel)
        unless_done.pop_all()
    panel.simulated = simulated
    if simulated is not None and panel._cycling is not None:
        simulated.remembers = True
    if watch:
        watching.follow(panel, watched)
    return panel


def _wanted(url: str | None) -> urls.PanelURL | urls.SerialURL:
    """The URL that is meant, taken apart."""
    from paneldraw import urls, watching

    if url is not None:
        return urls.parse(url)
    named = os.environ.get("PANELDRAW_PANEL")
    if not named:
        watching.hint()
    try:
        return urls.parse(named or "sim://ssd1306")
    except ValueError as error:
        raise ValueError(_NAMED.format(named, error)) from None


def _simulated(wanted: urls.PanelURL) -> tuple[Transport, Any, Any]:
    """Make a simulated chip, on the first kind of bus that it can sit on; return transport, chip and bus."""
    from paneldraw import simulator, transports

    chip = simulator.simulated_chip(wanted.controller, wanted.module)
    bus = simulator.simulated_bus(chip, wanted.controller, wanted.address)
    if isinstance(bus, simulator.I2CBus):
        return transports.I2CTransport(bus, wanted.address), chip, bus
    return transports.SPITransport(spi=bus.spi, pins=bus.pins, dc=bus.dc, reset=bus.reset), chip, bus
