"""What drives the chip of a panel: its start, settings and plans, and its recovery from faults and power cuts."""

from __future__ import annotations

import contextlib
import errno
import time
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Final, NamedTuple, TypeVar

import numpy as np
import numpy.typing as npt

from paneldraw.controllers import Controller
from paneldraw.controllers.features import Box, beside
from paneldraw.controllers.packing import packer
from paneldraw.errors import TransportError
from paneldraw.transports import Transport
from paneldraw.transports.synced import SyncedTransport
from paneldraw.update import planner_for

if TYPE_CHECKING:
    from paneldraw.controllers.record import Effect
    from paneldraw.panel import Stats

Levels = npt.NDArray[np.uint8]
Commands = tuple[bytes, ...]
T = TypeVar("T")

_RETRIES: Final = 10
_PATIENCE: Final = 0.02
"""So many times, and about so many seconds without any success, a fault is answered by trying again."""
_BUSY: Final = (3, 0.25)
"""So many of these times have so many seconds: other processes may take the machine away meanwhile."""
_READS: Final = 3
"""So often a status is read that does not come: without one nobody would notice that the panel loses its power."""
_LOOK: Final = 1.0
"""Seconds between two looks at whether the panel lost its power."""


class Sent(NamedTuple):
    """What some commands took."""

    wire_bytes: int
    messages: int


_NOTHING: Final = Sent(0, 0)


class Driver:
    """Keeps a chip as its settings say, with the picture that was packed last. It is for one thread at a time.

    Whatever ends an operation early leaves `ready` False: the next one starts the chip anew.

    Parameters
    ----------
    controller : Controller
    transport : Transport
    stats : Stats
        Where faults, retries and restarts are counted.
    updates : str
        As `Panel` has it.
    contrast : int or None
        The brightness to begin with.
    refresh : float or None
        Seconds after which a show starts the chip anew.

    Attributes
    ----------
    cost : Cost
        What a message costs on the wire.
    ready : bool
        Whether the chip took its init, and nothing went wrong since.
    shown : bool
        Whether it holds a picture.
    contrast, drive, all_on, inverted, asleep, rest, kept
        The settings: the brightness, the commands beside its own, whether every pixel is lit, and so on; the rest is
        ``"dim"``, ``"off"`` or nothing; and commands that a script wants after each start.
    moving : array of bool or None
        Bytes that are sent with every picture, changed or not, in the same order.
    """

    def __init__(
        self,
        controller: Controller,
        transport: Transport,
        stats: Stats,
        updates: str,
        contrast: int | None,
        refresh: float | None,
    ) -> None:
        self.controller, self.transport, self.stats = controller, transport, stats
        self._wire = SyncedTransport(transport) if controller.synced else transport
        self.cost = self._wire.cost
        self._planner = planner_for(controller, self.cost, updates)
        self._pack = packer(controller)
        self._plain = controller.bands == 1 and not (controller.mirror_x or controller.mirror_y)
        self.contrast = contrast
        self.drive: Commands = ()
        self.all_on = self.inverted = self.asleep = False
        self.rest = ""
        self.kept: list[bytes] = []
        self.moving: npt.NDArray[np.bool_] | None = None
        self._effect, self._effect_lights = b"", False
        self._stirred = self._scrolling = False  # whether the chip moved its RAM, and whether it still does
        self._unsure: npt.NDArray[np.bool_] | None = None  # bytes of RAM that single steps of a scroll brought in
        self._settled = 0.0  # when such a step is over
        self.ready = self.shown = False
        self._doubted = False  # what another thread says while this one ends with `ready`
        self._lit = False
        self._refresh = refresh
        self._watched = False  # whether the chip answers its status right
        self._looked = self._started = 0.0
        self._asked = _NOTHING  # what reads cost that no report has counted
        self._prepare_adjusting()

    # -- The picture

    def pack(self, pixels: Levels, max_level: int) -> None:
        """Take a picture, as the unturned glass has it."""
        if not self._plain:  # a chip that cannot mirror, or has bands of the picture beside each other
            pixels = self.controller.arranged(pixels)
        self._pack(pixels, max_level, self._picture)

    def take(self, packed: Levels) -> None:
        """Take a picture that is packed."""
        np.copyto(self._picture, packed)

    def _prepare_adjusting(self) -> None:
        """See what the chip has no command for: the picture is sent inverted, or dimmed, then."""
        chip = self.controller
        self._inverts = not chip.inverse
        self._dims = chip.contrast is not None and not chip.contrast.command
        self._adjusts = self._inverts or self._dims
        self._picture = self._planner.fresh
        if self._adjusts:
            self._picture = np.zeros_like(self._picture)
            self.pack(np.ones((chip.height, chip.width), np.uint8), 1)
            self._all_lit = self._picture.copy()
            self._picture[...] = 0

    def _adjust(self) -> None:
        """Make of the picture what is sent."""
        fresh = self._planner.fresh
        np.bitwise_xor(self._picture, self._all_lit if self._inverts and self.inverted else np.uint8(0), out=fresh)
        if self._dims and self.contrast is not None:
            fresh[:] = (fresh.astype(np.uint16) * self.contrast + 127) // 255

    # -- Operations, which try again after faults

    def show(self, force: bool, now: float) -> tuple[int, int, int]:
        """Bring the picture onto the panel; return bytes on the wire, messages, changed bytes."""
        if (
            force
            or self._doubted
            or (self._watched and now - self._looked > _LOOK and not self._alive(now))
            or (self._refresh is not None and now - self._started > self._refresh)
        ):
            self.ready = False
        return self.attempt(self._send)

    def restore(self) -> None:
        """Bring back all that the panel had."""
        self.attempt(self._restore)
        self._asked = _NOTHING

    def change(self, commands: Callable[[], Iterable[bytes]]) -> Sent:
        """Send commands for a setting; first bring back the picture where the panel may have lost it."""

        def operation() -> Sent:
            if self.ready:
                self.ready = False
            else:
                self._restore()  # which knows all settings
            sent = self.command(*commands())
            self.ready = True
            if self.shown and self._adjusts:
                self._send()
            return sent

        return self.attempt(operation)

    def leave_to(self, send: Callable[[], int]) -> int:
        """Let something else write to the chip, which leaves the picture as it is; return the bytes on the wire."""

        def operation() -> int:
            if not self.ready:
                self._restore()
            self.ready = False
            wire = send()
            self._planner.doubt()
            self.ready = True
            return wire

        return self.attempt(operation)

    def doubt(self) -> None:
        """Start the chip anew with the next picture, also where one is being sent just now."""
        self.ready, self._doubted = False, True

    def look_again(self) -> None:
        """Ask the chip with the next picture whether it still has its power, however lately it was asked."""
        self._looked = float("-inf")

    def go_to_rest(self, rest: str) -> None:
        """Dim the panel or turn it off until there is another picture."""
        self.rest = rest

        def operation() -> None:
            ready, self.ready = self.ready, False
            if not ready:
                self._restore()
            self.command(*self._rest())
            self._lit = self._lit and rest != "off"
            self.ready = True

        self.attempt(operation)

    def wake_from_rest(self) -> None:
        """Have the next picture bring back light and brightness."""
        if self.rest:
            self.rest, self.ready = "", False

    def wake(self) -> None:
        """End the sleep, in which a chip that says whether it is on says the same with and without its set-up."""
        if self.asleep and self._watched:
            self.doubt()
        self.asleep = False

    def leave(self, on_close: str) -> None:
        """Leave the panel as it is to be when nobody drives it."""
        if on_close == "clear":
            self.attempt(self._blacken)
        elif on_close == "off":
            self.attempt(self._darken)

    def attempt(self, operation: Callable[[], T]) -> T:
        """Try again after faults that may pass; each operation restores a chip of which it cannot be sure."""
        started, tries = -1.0, 0
        while True:
            try:
                return operation()
            except TransportError as error:
                self.ready = False
                self._count(error)
                now = time.perf_counter()
                if started < self._started:  # the chip took its init meanwhile, on a wire that may be slow
                    started = now
                patience = _BUSY[1] if tries < _BUSY[0] else _PATIENCE
                if tries == _RETRIES or not error.transient or now - started > patience:
                    raise error.final() from error.__cause__
            self.stats.retries += 1
            time.sleep(_PATIENCE / 2 ** (_RETRIES - tries))
            tries += 1

    def _count(self, error: TransportError) -> None:
        kind = errno.errorcode.get(error.errno or 0, type(error).__name__)
        self.stats.faults[kind] = self.stats.faults.get(kind, 0) + 1

    # -- What goes to the transport

    def _restore(self) -> None:
        if self.shown:
            self._send()
        else:
            self._start()
            self.ready = True

    def _blacken(self) -> None:
        if self.inverted:  # black is black; a start leaves the chip as its init has it
            self.inverted = self.ready = False
        self._picture[...] = 0
        self._send()

    def _darken(self) -> None:
        ready, self.ready = self.ready, False
        self.command(self.controller.power_off) if ready else self._start()

    def _start(self) -> Sent:
        """Bring the chip from any state to a dark, configured one."""
        chip = self.controller
        mode = self.mode() if self.inverted or self.all_on else ()
        effect = [self._effect] if self._effect and not self._effect_lights else []
        commands = [*chip.init, *mode, *self.brightness(), *effect, *self.kept, *self._rest()]
        if self._started:
            self.stats.restarts += 1
        self._doubted = False
        self._lit = self._watched = self._stirred = self._scrolling = False
        self._unsure, self._settled = None, 0.0
        self.transport.reset()
        sent = self.command(*([chip.resync] if chip.resync else ()), *commands)
        self._planner.restart()
        self._started = self._looked = time.perf_counter()
        self._watched = self._status() == chip.status_off != 0
        return sent

    def _send(self) -> tuple[int, int, int]:
        """Send the picture; return bytes on the wire, messages, changed bytes."""
        wire = messages = 0
        ready, self.ready = self.ready, False
        if not ready:
            wire, messages = self._start()
        if self._adjusts:
            self._adjust()
        if self._stirred:
            wire, messages = self._calm()
        if self.moving is not None:
            np.invert(self._planner.fresh, out=self._planner.shadow, where=self.moving)
            self._planner.doubt()
        plan = self._planner.plan()
        if plan.count:
            wire += self._wire.batch(plan)
            self._planner.sent()
            self.shown = True
        if not self._lit and not (self.asleep or self.rest == "off"):
            power_on = self.command(*self._light())
            wire, messages = wire + power_on.wire_bytes, messages + power_on.messages
            self._lit = True
            self._watched = self._watched and self._status() == 0
        self.ready = True
        if self._asked is not _NOTHING:
            wire, messages = wire + self._asked.wire_bytes, messages + self._asked.messages
            self._asked = _NOTHING
        return wire, messages + plan.count, plan.changed

    def command(self, *commands: bytes | float) -> Sent:
        """Send commands, each with its arguments, and make the pauses among them."""
        plan = self._planner.commands(*(command for command in commands if isinstance(command, bytes)))
        if plan is not None:
            return Sent(self._wire.batch(plan) if plan.count else 0, plan.count)
        wire = messages = 0
        waiting = b""
        for command in commands:
            if isinstance(command, float):
                if waiting:
                    wire, messages, waiting = wire + self._wire.command(waiting), messages + 1, b""
                time.sleep(command)
            elif self.controller.arguments_are_data:
                wire += self._wire.command(command[:1])
                if len(command) > 1:
                    wire += self._wire.data(command[1:])
                messages += 1 + (len(command) > 1)
            else:
                waiting += command
        if waiting:
            wire, messages = wire + self._wire.command(waiting), messages + 1
        return Sent(wire, messages)

    # -- Whether the chip still has its power

    def _status(self) -> int | None:
        """What the chip answers to a read, of the bit that says that the display is off; None if it cannot be read."""
        read = getattr(self.transport, "read_status", None)
        if read is None or not self.controller.status_off:
            return None
        for _ in range(_READS):
            with contextlib.suppress(TransportError):
                status, wire = read()
                self._asked = Sent(self._asked.wire_bytes + wire, self._asked.messages + 1)
                return int(status) & self.controller.status_off
        return None

    def _alive(self, now: float) -> bool:
        """Whether the chip is still as it was left, as far as it tells."""
        self._looked = now
        return self._status() == (0 if self._lit else self.controller.status_off)

    # -- The commands for the settings

    def brightness(self) -> Commands:
        """Commands for what was asked for; none where init's brightness is to stay."""
        if self.contrast is None or self.controller.contrast is None:
            return ()
        # What brackets the command may light the chip.
        dark = () if self._lit or not self.controller.contrast.after else (self.controller.power_off,)
        return *self.controller.contrast.commands(self.contrast), *dark, *self.drive

    def invert(self, inverted: bool) -> Commands:
        """Note which levels are lit; return the command for it, if the chip has one."""
        self.inverted = inverted
        return () if self._inverts else self.mode()

    def mode(self) -> Commands:
        """Commands for what the picture looks like: as it is, inverted, or not at all, as every pixel is lit."""
        shown = self.controller.inverse if self.inverted else self.controller.normal
        return tuple(filter(None, (shown, self.controller.all_on if self.all_on else b"")))

    def power(self) -> Commands:
        """The command for light or none; there is no light before the first picture."""
        self._lit = self.shown and not self.asleep
        return self._light() if self._lit else (self.controller.power_off,)

    def _light(self) -> Commands:
        """The command for light, which may be that of an effect, and may have ended that every pixel is lit."""
        power_on = self._effect if self._effect_lights else self.controller.power_on
        return (power_on, self.controller.all_on) if self.all_on else (power_on,)

    def _rest(self) -> Commands:
        """The commands for the rest that the panel takes; none while it does not."""
        chip = self.controller
        if self.rest == "dim" and chip.contrast is not None:
            return *chip.contrast.commands(0), *(chip.drive[-1] if chip.drive else ())
        return (chip.power_off,) if self.rest == "off" else ()

    # -- What the chip does by itself

    def affect(self, effect: Effect, speed: float | None) -> Callable[[], Commands]:
        """Begin or end an effect, of which there is one at a time; return what gives its command."""
        command = effect.off if speed is None else effect.command(speed)
        self._effect, self._effect_lights = (b"", False) if speed is None else (command, effect.lights)
        return lambda: (command,) if self._lit or not effect.lights else ()

    def set_in_motion(self, commands: Commands, across: int, box: Box, once: bool) -> Commands:
        """Send what must come before a scroll; return its commands."""
        self._wait_for_step()
        if self._scrolling:
            self.ready = self.shown  # a new scroll begins with the picture as it was
            self._send() if self.shown else self.command(self._still())
            self.ready = False
        self._stirred = True
        if not once:
            for place, count in beside(self.controller):
                self.command(place)
                self._wire.data(bytes(count))
            self._scrolling = True
            return commands
        self._step(across, box)
        self._settled = time.perf_counter() + (self.controller.scroll.pause if self.controller.scroll else 0.0)
        return commands

    def still(self) -> Commands:
        """Know that a scroll is over; return the command that ends it, if there was one."""
        return (self._still(),) if self._scrolling else ()

    def _step(self, across: int, box: Box) -> None:
        """Know that the chip moves a box by a column; of the column that comes in nothing is known."""
        wide, high = self.controller.cell
        part = (slice(box.top // high, -(-box.bottom // high)), slice(box.left // wide, box.right // wide))
        if self._unsure is None:
            self._unsure = np.zeros(self._planner.fresh.shape, np.bool_)
        for held in (self._planner.shadow[part], self._unsure[part]):
            held[...] = np.roll(held, across, axis=1)
        self._unsure[part][:, 0 if across > 0 else -1] = True

    def _wait_for_step(self) -> None:
        """Wait until a single step is over."""
        if self._settled:
            time.sleep(max(0.0, self._settled - time.perf_counter()))
            self._settled = 0.0

    def _calm(self) -> Sent:
        """Make sure that the RAM stays as it is, and that the next plan sends what of it is not known."""
        self._wait_for_step()
        if self._unsure is not None:
            np.invert(self._planner.fresh, out=self._planner.shadow, where=self._unsure)
            self._unsure = None
        self._stirred = False
        return self.command(self._still()) if self._scrolling else _NOTHING

    def _still(self) -> bytes:
        """Know that a scroll is over, which left the RAM moved; return the command that ends it."""
        self._scrolling = False
        self._planner.forget()
        return self.controller.scroll.stop if self.controller.scroll else b""
