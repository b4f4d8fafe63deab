"""Panels on simulated buses, as the fixtures hand them out."""

from __future__ import annotations

import contextlib
from collections.abc import Iterable, Iterator
from typing import Any, Literal, overload

from paneldraw import urls
from paneldraw.panel import Panel
from paneldraw.simulator.bus import I2CBus
from paneldraw.simulator.chip import Chip
from paneldraw.simulator.frames import Picture
from paneldraw.simulator.port import SerialPort
from paneldraw.simulator.rig import Rig, RigPanel
from paneldraw.simulator.spi import SPIBus
from paneldraw.testing.seeing import assert_pattern
from paneldraw.transports import I2CTransport, SerialTransport, SPITransport, Transport


class SimPanel(Panel):
    """A panel on a simulated bus, whose glass, chip and bus a test can get at.

    Time is that of the wire alone, the same in every run: ``panel.bus.idle(0.5)`` is a pause.

    Parameters
    ----------
    url : str
        What `open_panel` takes: ``sim://ssd1306?size=128x32``, or ``i2c://…`` and ``spi://…``, where simulated buses
        stand for the real ones.

    Attributes
    ----------
    chip : paneldraw.simulator.chip.Chip
        The simulated chip: what it was sent, what it shows, and what is to be said of the driver.
    bus : I2CBus or SPIBus
        The simulated bus, with its faults on demand.

    Examples
    --------
    >>> with SimPanel("sim://ssd1306?size=128x32") as panel:
    ...     with panel.frame() as fb:
    ...         fb.line(0, 0, 3, 3)
    ...     panel.assert_pattern("#...\\n.#..", at=(0, 0))
    >>> panel.bus.messages > 0, panel.chip.violations
    (True, [])
    """

    chip: Chip
    bus: I2CBus | SPIBus

    def __init__(self, url: str = "sim://ssd1306") -> None:
        if getattr(urls.parse(url), "watch", None):
            raise ValueError(f"url must leave a test alone: paneldraw.simulator.save records its panel, not {url!r}")
        self._rig = _rig([url])
        try:
            self._place(self._rig.panels[0])
        except BaseException:
            self._rig.close()
            raise

    def _place(self, placed: RigPanel) -> None:
        wanted = urls.parse(placed.url)
        self.chip, self.bus = placed.chip, placed.bus
        transport, controller = _reach(placed, wanted)
        try:
            super().__init__(controller, transport, **wanted.panel)
        except BaseException:
            transport.close()
            raise
        self.simulated = placed.chip

    def close(self) -> None:
        """Close the panel; chip and bus stay as they are, to be looked at."""
        try:
            super().close()
        finally:
            self._rig.close()

    @property
    def pixels(self) -> Picture:
        """What an eye sees now: levels, uint8, shape (height, width) of the glass, read-only."""
        return self.chip.pixels

    def assert_pattern(self, pattern: str, at: tuple[int, int] | None = None) -> None:
        """Demand that the glass looks like a text; see `paneldraw.testing.assert_pattern`."""
        __tracebackhide__ = True
        assert_pattern(self.chip, pattern, at)

    def power_cycle(self) -> None:
        """Take the module's supply away and give it back, a while ago: the next show that can notice it does."""
        self.chip.power_cycle()
        self._driver.look_again()


class SerialPanel(SimPanel):
    """A panel behind a board on a simulated serial port, which is a pseudo-terminal; `bus` is the one behind the board.

    Parameters
    ----------
    url : str
        What `open_panel` takes, such as ``serial:///dev/ttyACM0?chip=ssd1306&size=128x32``.

    Attributes
    ----------
    port : paneldraw.simulator.port.SerialPort
        With `unplug` and `plug`.

    Raises
    ------
    OSError
        On systems without pseudo-terminals, such as Windows.

    Examples
    --------
    >>> with SerialPanel() as panel:
    ...     report = panel.clear()
    ...     panel.port.unplug()
    ...     panel.port.plugged
    False
    """

    port: SerialPort

    def __init__(self, url: str = "serial:///dev/ttyACM0?chip=ssd1306") -> None:
        if not isinstance(urls.parse(url), urls.SerialURL):
            raise ValueError(f"url must be like serial:///dev/ttyACM0?chip=ssd1306, not {url!r}")
        super().__init__(url)

    def _place(self, placed: RigPanel) -> None:
        if placed.port:
            self.port = placed.port
        super()._place(placed)


def _reach(placed: RigPanel, wanted: urls.PanelURL | urls.SerialURL) -> tuple[Transport, Any]:
    """Return the transport to a simulated panel, and the record of its chip."""
    bus = placed.bus
    if isinstance(wanted, urls.SerialURL):
        assert placed.port
        port = SerialTransport(placed.port.path, wanted.baudrate)
        return port, wanted.controller(port.device)
    settings = {name: value for name, value in wanted.transport.items() if name not in ("gpiochip", "device")}
    if isinstance(bus, SPIBus):
        bus.spi.cshigh = wanted.controller.synced
        settings = {"dc": bus.dc, "reset": bus.reset} | settings
        return SPITransport(spi=bus.spi, pins=bus.pins, **settings), wanted.controller
    settings.pop("reset", None)  # nobody is at that line
    return I2CTransport(bus, wanted.address, **settings), wanted.controller


@overload
def bus_of(where: str | Iterable[str], kind: Literal["i2c"]) -> contextlib.AbstractContextManager[I2CBus]: ...
@overload
def bus_of(where: str | Iterable[str], kind: Literal["spi"]) -> contextlib.AbstractContextManager[SPIBus]: ...
@contextlib.contextmanager
def bus_of(where: str | Iterable[str], kind: str) -> Iterator[Any]:
    """Make the one simulated bus that the panels of URLs sit on."""
    with _rig(where) as rig:
        buses: list[I2CBus | SPIBus] = list(rig.i2c.values() if kind == "i2c" else rig.spi.values())
        if len(buses) != 1 or rig.serial or (rig.spi if kind == "i2c" else rig.i2c):
            raise ValueError(f"{kind}_bus must be parametrized with panels of one {kind}:// bus, not with {where!r}")
        yield buses[0]


def _rig(where: str | Iterable[str]) -> Rig:
    """Make simulated panels whose time is that of the wire alone."""
    rig = Rig([where] if isinstance(where, str) else where)
    for panel in rig.panels:
        panel.bus.timer = None
    return rig
