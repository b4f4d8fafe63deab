"""Simulated panels on simulated buses, as URLs or a TOML file name them: what a program finds instead of hardware."""

from __future__ import annotations

import contextlib
import importlib
import os
import re
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeVar, cast
from urllib.parse import parse_qsl, urlencode

from paneldraw import urls
from paneldraw.controllers import CHIPS, Controller
from paneldraw.errors import did_you_mean
from paneldraw.transports import I2CTransport

from .bus import I2CBus, Multiplexer
from .chip import Chip
from .kernel.gpio import LINES
from .looks import find_look
from .port import SerialPort
from .spi import SPIBus

if TYPE_CHECKING:
    from firmware_protocol import Device

    from .preload import Preload

_Bus = TypeVar("_Bus", I2CBus, SPIBus, I2CBus | SPIBus)

_WIRING: Final = (
    *("column_offset", "first_com", "com_pins", "duty"),
    *("order", "first_block", "block_rotation", "mirror_blocks", "board"),
)
"""What a simulated module is wired with, beside a driver that believes it."""
_CLOCK: Final = 400_000
_TABLES: Final = ("panel", "i2c")
_OF_A_BUS: Final = ("clock",)
_EXAMPLE: Final = "i2c://1/0x3c?chip=ssd1306"
_OTHER_PLACE: Final = "give one of the two another address, or put it behind a multiplexer, as in i2c://1/0x70:3/0x3c"
_WATCHED: Final = ("view", "save", "look", "listen", "realtime")
"""Parameters by which a script watches its own panel: in a rig, whoever has the rig watches."""
_FIRMWARE: Final = "paneldraw simulated"
_DATA: Final = 0x40
"""The control byte that says that data follows."""


def simulated_chip(controller: Controller, module: Mapping[str, Any], *, history: int | None = 1000) -> Chip:
    """Make the simulated chip of a module.

    Parameters
    ----------
    controller : Controller
        The record that a driver has of it.
    module : mapping
        What is said of the module's wiring, by the names of the record's parameters. What a driver believes of the
        glass, such as ``mirror_x``, is none of the chip's.
    history : int or None
        How many frames it keeps. Default: 1000.

    Examples
    --------
    >>> from paneldraw.controllers import SH1106
    >>> simulated_chip(SH1106(128, 64), {})
    <SH1106 128x64, off, 0 frames>
    """
    from paneldraw import simulator

    wiring: dict[str, Any] = {name: module[name] for name in _WIRING if name in module}
    if not module.get("charge_pump", True):
        wiring["external_vcc"] = True
    make = getattr(simulator, controller.name.upper())
    chip: Chip = make(controller.width, controller.height, history=history, **wiring)
    return chip


def simulated_bus(chip: Any, controller: Controller, address: int) -> I2CBus | SPIBus:
    """Put a simulated chip on a bus of its own: I2C where it can be on it, else SPI with the lines that it has.

    Parameters
    ----------
    chip : chip
        As `simulated_chip` makes it.
    controller : Controller
    address : int
        Its address on I2C.

    Examples
    --------
    >>> from paneldraw.controllers import PCD8544
    >>> bus = simulated_bus(simulated_chip(PCD8544(), {}), PCD8544(), 0)
    >>> bus.dc, bus.reset
    (24, 25)
    """
    if "i2c" in controller.buses:
        return I2CBus({address: chip})
    has_pins = not controller.registers
    bus = SPIBus(chip, 24 if has_pins and not controller.synced else None, 25 if has_pins else None)
    bus.spi.cshigh = controller.synced
    return bus


@dataclass(frozen=True, eq=False)
class RigPanel:
    """One simulated panel of a `Rig`.

    Attributes
    ----------
    name : str
        No other panel of the rig has it.
    url : str
        What a script opens it with, where the rig's buses stand for the real ones.
    chip : object
        The simulated chip.
    bus : I2CBus or SPIBus
        The bus that it is on; of a panel on a serial port, the one behind the board.
    address : int or None
        Its address on an I2C bus.
    port : SerialPort or None
        The serial port that it is on.
    look : str or None
        The look that the file asks for. Default: None, the chip's own.

    Examples
    --------
    >>> with Rig(["sim://sh1106?size=128x32"]) as rig:
    ...     rig.panels[0].url, rig.panels[0].chip
    ('i2c://1/0x3c?chip=sh1106&size=128x32', <SH1106 128x32, off, 0 frames>)
    """

    name: str
    url: str
    chip: Any
    bus: I2CBus | SPIBus
    address: int | None = None
    port: SerialPort | None = None
    look: str | None = None


class Rig:
    """Simulated panels where programs look for real ones; a context manager.

    Parameters
    ----------
    urls : iterable of str
        What `open_panel` takes: ``i2c://1/0x3c?chip=ssd1306``, ``i2c://1/0x70:3/0x3d?chip=sh1106`` behind a
        multiplexer, ``spi://0.0?chip=ssd1322&dc=24&reset=25``, ``serial:///dev/ttyACM0?chip=ssd1306``. Panels of one
        bus share it. ``sim://ssd1306`` stands where such a panel usually is: at its address on bus 1, or on SPI 0.0.
    realtime : bool
        Whether calls take as long as they do on a real wire. Default: False, as fast as the machine.
    history : int or None
        How many frames each chip keeps. Default: 1000.

    Attributes
    ----------
    panels : list of RigPanel
    i2c : dict of int to I2CBus
        The buses by the number of their ``/dev/i2c-N``.
    spi : dict of (int, int) to SPIBus
        By bus and chip select of ``/dev/spidevB.D``.
    serial : dict of str to str
        By the path of the port that they stand for, the paths of pseudo-terminals.

    Raises
    ------
    ValueError
        A URL that `open_panel` would refuse, or that asks for a place that is taken.

    Examples
    --------
    >>> from paneldraw import Panel
    >>> from paneldraw.transports import I2CTransport
    >>> with Rig(["i2c://1/0x3c?chip=ssd1306", "i2c://1/0x3d?chip=sh1106"]) as rig:
    ...     report = Panel("sh1106", I2CTransport(rig.i2c[1], 0x3D)).clear()
    ...     [(panel.name, panel.chip.registers.on) for panel in rig.panels]
    [('ssd1306', False), ('sh1106', True)]
    """

    def __init__(self, urls: Iterable[str] = (), *, realtime: bool = False, history: int | None = 1000) -> None:
        self.panels: list[RigPanel] = []
        self.i2c: dict[int, I2CBus] = {}
        self.spi: dict[tuple[int, int], SPIBus] = {}
        self.serial: dict[str, str] = {}
        self._realtime = realtime
        self._history = history
        self._resets: list[tuple[int, Any]] = []  # lines that I2C modules have their reset pins on
        try:
            for url in urls:
                self.add(url)
        except BaseException:
            self.close()
            raise

    @classmethod
    def from_file(cls, path: str | os.PathLike[str], *, realtime: bool = False, history: int | None = 1000) -> Rig:
        """Read the panels from a TOML file.

        Each table ``[panel.NAME]`` is a panel. Its ``url`` says where it is and what; parameters may stand in the URL,
        or as keys of the table; ``look`` is how viewers show it. ``[i2c.1]`` may have the ``clock`` of a bus, in Hz.

        Raises
        ------
        ValueError
            It is no TOML, or has a table or key that does not exist, or a URL that `open_panel` would refuse.
        OSError
            It cannot be read; on Python 3.10 without the package tomli, too.
        """
        tables = _read(path)
        rig = cls(realtime=realtime, history=history)
        try:
            rig._read_tables(tables)
        except (ValueError, TypeError) as error:
            rig.close()
            raise ValueError(f"{os.fspath(path)}: {error}") from None
        except BaseException:
            rig.close()
            raise
        return rig

    def add(self, url: str, *, name: str | None = None, look: str | None = None) -> RigPanel:
        """Add a panel.

        Parameters
        ----------
        url : str
            As in `Rig`.
        name : str, optional
            Default: that of the chip, with a number where another panel has it.
        look : str, optional
            How viewers show it. Default: as its chip looks.
        """
        wanted = urls.parse(url)
        look = look or wanted.watch.look
        find_look(look)
        if isinstance(wanted, urls.PanelURL) and wanted.scheme == "sim":
            url = _usual_place(url, wanted.controller)
        url = _without(url, _WATCHED)
        wanted = urls.parse(url)
        if name is not None and any(panel.name == name for panel in self.panels):
            raise ValueError(f"name must be one that no other panel has, not {name!r}")
        module = _behind(wanted) if isinstance(wanted, urls.SerialURL) else wanted
        chip = simulated_chip(module.controller, module.module, history=self._history)
        bus: I2CBus | SPIBus
        port = None
        if isinstance(wanted, urls.SerialURL):
            bus = self._timed(simulated_bus(chip, module.controller, module.address))
            port = self._plug_in(wanted.port, chip, _board(module.controller, bus, module.address))
        else:
            bus = self._on_i2c(wanted, chip) if wanted.scheme == "i2c" else self._on_spi(wanted, chip)
        address = module.address if isinstance(bus, I2CBus) else None
        panel = RigPanel(name or self._name(module.controller.name), url, chip, bus, address, port, look)
        self.panels.append(panel)
        return panel

    def preload(self) -> Preload:
        """Return what lets child processes find the buses: a context manager, with subprocess's ``run`` and ``popen``.

        Raises
        ------
        OSError
            It cannot be had on this system.
        """
        from .preload import Preload

        preload = Preload(self.i2c, self.spi, self.serial)
        for line, chip in self._resets:
            preload.gpio.lines[line].wires.append(partial(_drive_reset, chip))
        return preload

    def close(self) -> None:
        """Unplug the serial ports; the chips keep their state. Closing twice does nothing."""
        for panel in self.panels:
            if panel.port:
                panel.port.close()

    def __enter__(self) -> Rig:
        return self

    def __exit__(self, *exception: object) -> None:
        self.close()

    # inside

    def _name(self, chip: str) -> str:
        taken = {panel.name for panel in self.panels}
        numbered = (f"{chip}-{number}" for number in range(2, len(taken) + 3))
        return next(name for name in (chip, *numbered) if name not in taken)

    def _timed(self, bus: _Bus) -> _Bus:
        bus.realtime = self._realtime
        return bus

    def _on_i2c(self, wanted: urls.PanelURL, chip: Any) -> I2CBus:
        found = re.fullmatch(r"(?:/dev/i2c-)?(\d+)", str(wanted.bus))
        if not found:
            raise ValueError(f"url must say the bus by its number, such as i2c://1/0x3c, not {wanted.bus!r}")
        number = int(found[1])
        bus = self.i2c.get(number) or self._timed(I2CBus())
        settings = {name: value for name, value in wanted.transport.items() if name not in ("reset", "gpiochip")}
        I2CTransport(bus, wanted.address, **settings)  # which refuses what no bus has
        devices = {wanted.address: chip}
        if "data_address" in settings:
            devices[settings["data_address"]] = chip.data
        reset = _line(wanted.transport, "reset", None)
        try:
            _put(bus, devices, settings.get("mux"))
        except ValueError as error:
            raise ValueError(f"bus {number}: {error}") from None
        self.i2c[number] = bus
        if reset is not None:
            self._resets.append((reset, chip))
        return bus

    def _on_spi(self, wanted: urls.PanelURL, chip: Any) -> SPIBus:
        place = int(wanted.bus), wanted.transport["device"]
        if place in self.spi:
            row = (
                "; modules in a row are one panel, of size=64x8 for two of 32x8" if wanted.controller.registers else ""
            )
            raise ValueError(f"SPI {place[0]}.{place[1]} has a panel: give each a chip select of its own{row}")
        dc, reset = (_line(wanted.transport, name, usual) for name, usual in (("dc", 24), ("reset", 25)))
        self.spi[place] = self._timed(SPIBus(chip, dc, reset))
        return self.spi[place]

    def _plug_in(self, place: str, chip: Any, board: Device) -> SerialPort:
        if place in self.serial:
            raise ValueError(f"{place} has a panel: give each a port of its own")
        name = re.split(r"[/\\]", place)[-1]
        port = SerialPort(board, name, power=chip.power_cycle, realtime=self._realtime)
        self.serial[place] = port.path
        return port

    def _read_tables(self, tables: Mapping[str, Any]) -> None:
        _check_keys(tables, _TABLES)
        for title, add in (("i2c", self._add_bus), ("panel", self._add_table)):
            for name, table in _table(tables.get(title, {}), title).items():
                where = f"{title}.{name}"
                try:
                    add(name, _table(table, where))
                except (ValueError, TypeError) as error:
                    raise ValueError(f"[{where}]: {error}") from None
        if not self.panels:
            raise ValueError(f'there is no panel: write [panel.clock] and below it url = "{_EXAMPLE}"')

    def _add_bus(self, number: str, table: Mapping[str, Any]) -> None:
        _check_keys(table, _OF_A_BUS)
        if not number.isdecimal():
            raise ValueError(f"i2c must have the number of a bus behind it, as in [i2c.1], not {number!r}")
        self.i2c[int(number)] = self._timed(I2CBus(clock=table.get("clock", _CLOCK)))

    def _add_table(self, name: str, table: Mapping[str, Any]) -> None:
        if not isinstance(table.get("url"), str):
            hint = "" if "url" in table else did_you_mean("url", table)
            raise ValueError(f'url must be text, such as "{_EXAMPLE}"{hint}')
        said = {key: _text(key, value) for key, value in table.items() if key not in ("url", "look")}
        url = table["url"]
        joint = "" if not said else "&" if "?" in url else "?"
        self.add(f"{url}{joint}{_query(said)}", name=name, look=table.get("look"))


def _usual_place(url: str, controller: Controller) -> str:
    """Turn the URL of a simulated panel into that of the place where such a panel usually is."""
    place = f"i2c://1/{CHIPS[controller.name].address:#x}" if "i2c" in controller.buses else "spi://0.0"
    return f"{place}?{_query({'chip': controller.name, **dict(parse_qsl(url.partition('?')[2]))})}"


def _without(url: str, names: Collection[str]) -> str:
    """Take parameters out of a URL."""
    place, mark, query = url.partition("?")
    if not mark:
        return url
    kept = {name: text for name, text in parse_qsl(query, keep_blank_values=True) if name not in names}
    return f"{place}?{_query(kept)}" if kept else place


def _behind(wanted: urls.SerialURL) -> urls.PanelURL:
    """Take apart what panel the board on a port has."""
    if "://" in wanted.port:
        raise ValueError(f"url must have the name of a port, such as serial:///dev/ttyACM0, not {wanted.port}")
    module = {name: text for name, text in wanted.query.items() if name not in ("chip", "baudrate")}
    return cast(urls.PanelURL, urls.parse(f"sim://{wanted.query.get('chip', '')}?{_query(module)}"))


def _query(parameters: Mapping[str, str]) -> str:
    return urlencode(parameters, safe=",")


def _put(bus: I2CBus, devices: Mapping[int, Any], mux: tuple[int, int] | None) -> None:
    """Put chips on a bus, or behind a multiplexer on it, at addresses that nobody else answers at."""
    room: dict[int, Any] = bus.devices
    if mux is None:
        muxes = (device for device in bus.devices.values() if isinstance(device, Multiplexer))
        taken = {*room, *(address for each in muxes for channel in each.channels.values() for address in channel)}
    else:
        multiplexer = _multiplexer(bus, mux[0])
        room = multiplexer.channels.get(mux[1], {})
        taken = {*room, *bus.devices}
    for address in taken.intersection(devices):
        raise ValueError(f"there is a device at {address:#x} already: {_OTHER_PLACE}")
    if mux is not None:
        bus.devices[mux[0]], multiplexer.channels[mux[1]] = multiplexer, room
    room.update(devices)


def _multiplexer(bus: I2CBus, address: int) -> Multiplexer:
    device = bus.devices.get(address)
    if device is None:
        return Multiplexer({})
    if not isinstance(device, Multiplexer):
        raise ValueError(f"there is a panel at {address:#x} already: give the multiplexer another address")
    return device


def _drive_reset(chip: Any, high: bool) -> None:
    if not high:
        chip.reset()


def _line(transport: Mapping[str, Any], name: str, usual: int | None) -> int | None:
    """The number of a GPIO line that a URL names."""
    line = transport.get(name, usual)
    if line is None:
        return None
    found = re.fullmatch(r"(?:GPIO)?(\d+)", str(line))
    if not found or int(found[1]) >= LINES:
        raise ValueError(f"{name} must be a line of a Raspberry Pi's chip, 0 to {LINES - 1}, not {line!r}")
    return int(found[1])


def _board(controller: Controller, bus: I2CBus | SPIBus, address: int) -> Device:
    """Make the board that has a panel on a bus of its own, as paneldraw's firmware is on an Arduino."""
    from firmware_protocol.device import UNO, Device, SMBusWriter
    from firmware_protocol.messages import PanelBus

    if controller.registers and not controller.registers.chips:
        raise ValueError(f"chip must be one that takes control bytes or is on SPI, not {controller.name}: use i2c://")
    name, width, height = controller.name, controller.width, controller.height
    said = replace(UNO, firmware=_FIRMWARE, controller=name, width=width, height=height)
    if isinstance(bus, I2CBus):
        return Device(
            SMBusWriter(bus, address), read=lambda: bus.read_byte(address), profile=replace(said, address=address)
        )
    bus.spi.no_cs = bus.spi.cshigh  # the firmware's chip selects are low: one that must be high is tied to the supply
    profile = replace(said, bus=PanelBus.SPI, address=0, acknowledges=False, reset_line=bus.reset is not None)
    return Device(partial(_select, bus), reset_panel=partial(_pulse, bus), profile=profile)


def _select(bus: SPIBus, content: bytes) -> None:
    """Write one transaction to a panel on SPI: the control byte says how D/C is."""
    if content:
        if bus.dc is not None:
            bus.pins.set(bus.dc, content[0] == _DATA)
        bus.spi.writebytes2(content[1:])


def _pulse(bus: SPIBus) -> None:
    if bus.reset is not None:
        bus.pins.set(bus.reset, False)
        bus.pins.set(bus.reset, True)


def _read(path: str | os.PathLike[str]) -> dict[str, Any]:
    toml = _toml()
    with open(path, "rb") as file:
        try:
            tables: dict[str, Any] = toml.load(file)
        except ValueError as error:
            raise ValueError(f"{os.fspath(path)} is no TOML: {error}") from None
    return tables


def _toml() -> Any:
    for name in ("tomllib", "tomli"):
        with contextlib.suppress(ImportError):
            return importlib.import_module(name)
    raise OSError("Python 3.10 cannot read TOML by itself: pip install tomli, or give each panel by --panel")


def _check_keys(table: Mapping[str, Any], known: tuple[str, ...]) -> None:
    for key in table:
        if key not in known:
            raise ValueError(f"{key!r} must be one of {', '.join(known)}{did_you_mean(key, known)}")


def _table(value: Any, title: str) -> Mapping[str, Any]:
    if not isinstance(value, dict):
        raise ValueError(f"{title} must be a table, such as [{title}{'' if '.' in title else '.1'}], not {value!r}")
    return value


def _text(key: str, value: Any) -> str:
    """A value of a table as a URL has it."""
    if isinstance(value, bool):
        return str(int(value))
    if not isinstance(value, (str, int)):
        raise ValueError(f"{key} must be text, a whole number, true or false, not {value!r}")
    return str(value)
