"""What a panel's URL asks for."""

from __future__ import annotations

import contextlib
import functools
import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, Final
from urllib.parse import SplitResult, parse_qsl, unquote, urlencode, urlsplit

from paneldraw.controllers import BUSES, CHIPS, Controller
from paneldraw.errors import ProtocolError, did_you_mean

if TYPE_CHECKING:
    from firmware_protocol import HelloReply

_CHIP: Final = "ssd1306"
_FORMS: Final = {
    "i2c": "i2c://1/0x3c?chip=ssd1306&size=128x64&rotate=180",
    "serial": "serial:///dev/ttyACM0?baudrate=1000000",
    "spi": "spi://0.0?chip=ssd1322&dc=24&reset=25&speed=8000000",
    "sim": "sim://ssd1306?size=128x64",
}
_PYSERIAL: Final = ("rfc2217", "socket", "loop")
_PANEL: Final = {
    "rotate": "180",
    "contrast": "200",
    "on_close": "",
    "updates": "",
    **dict.fromkeys(("refresh", "dim_after", "off_after", "pixel_shift"), "60"),
    "greys": "4",
    "bus_clock": "400000",
    "bus_share": "0.8",
    "weighted": "1",
}
"""Settings of `Panel`, each with an example where it is a number."""
_FRACTIONS: Final = ("refresh", "dim_after", "off_after", "pixel_shift", "bus_clock", "bus_share")
"""Those that need not be whole."""
_SWITCHES: Final = ("mirror_x", "mirror_y", "mirror_blocks", "charge_pump", "internal_reference", "chained_control")
_TEXTS: Final = ("order", "first_block", "block_rotation", "board")
_YES: Final = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}
_WATCHING: Final = ("view", "save", "look", "listen")
_VIEWS: Final = ("terminal", "web", "browser")
_MODULE: Final = ("size", *dict.fromkeys(name for chip in CHIPS.values() for name in chip.parameters))
_SERIAL: Final = ("baudrate", "chip", *_MODULE, *_PANEL, *_WATCHING)


@dataclass(frozen=True, slots=True)
class Watch:
    """How a panel is watched while a script draws on it.

    Attributes
    ----------
    views : tuple of str
        ``"terminal"``, ``"web"``, or ``"browser"``, which is the web page, opened.
    save : str
        File that the frames go to in the end; empty for none.
    look : str, optional
        A name of `paneldraw.simulator.LOOKS`.
    realtime : bool
        Whether a simulated bus takes the time that a wire takes.
    listen : (str, int or None)
        Where the web page is: the address, and the port where it must be a certain one.
    """

    views: tuple[str, ...] = ()
    save: str = ""
    look: str | None = None
    realtime: bool = False
    listen: tuple[str, int | None] = ("127.0.0.1", None)

    def __bool__(self) -> bool:
        return bool(self.views or self.save or self.realtime)


@dataclass(frozen=True, slots=True)
class PanelURL:
    """A panel's URL, taken apart and checked.

    Attributes
    ----------
    scheme : str
        ``"i2c"``, ``"spi"`` or ``"sim"``.
    controller : Controller
    bus : int or str
        Number of the I2C bus or path of its device; number of the SPI bus.
    address : int
        Address on the bus.
    module : dict
        What the URL says of the module's wiring, by the names of the chip's parameters.
    transport, panel : dict
        Settings of the transport and of `Panel`, which check them, as the URL has them.
    watch : Watch
        How the panel is watched.
    place : str
        The URL without its parameters.
    """

    scheme: str
    controller: Controller
    bus: int | str = 1
    address: int = 0x3C
    module: dict[str, Any] = field(default_factory=dict)
    transport: dict[str, Any] = field(default_factory=dict)
    panel: dict[str, Any] = field(default_factory=dict)
    watch: Watch = field(default_factory=Watch)
    place: str = field(default="", compare=False)

    def twin(self, controller: Controller) -> PanelURL:
        """Return the URL of a simulated panel that is as this one."""
        return _simulated(controller, self.module)


@dataclass(frozen=True, slots=True)
class SerialURL:
    """The URL of a panel on a serial port, taken apart and checked.

    Attributes
    ----------
    port : str
        Name of the device or URL of pyserial's.
    baudrate : int, optional
        Bits a second. Default: what the board likes best.
    query : dict
        The parameters, as they stand in the URL.
    panel, watch, place
        As in `PanelURL`.
    """

    port: str
    baudrate: int | None
    query: dict[str, str]
    panel: dict[str, Any] = field(default_factory=dict)
    watch: Watch = field(default_factory=Watch)
    place: str = field(default="", compare=False)

    def twin(self, controller: Controller) -> PanelURL:
        """Return the URL of a simulated panel that is as this one."""
        return _simulated(controller, _module(self.query))

    def controller(self, device: HelloReply) -> Controller:
        """Return the controller that the URL names or, where it names none, that the board says it has."""
        chip = self.query.get("chip", device.controller)
        if not chip:
            raise ValueError(f"url must say which chip=, such as {_CHIP}: the board on {self.port} does not know it")
        if "chip" not in self.query and chip.lower() not in CHIPS:
            advice = f"update paneldraw, or add chip= to the URL with one of {', '.join(CHIPS)}"
            raise ProtocolError(f"the board on {self.port} has a panel of a chip {chip} that is not known: {advice}")
        size = {"size": f"{device.width}x{device.height}"} if device.width and device.height else {}
        return _controller(chip, size | self.query)


def parse(url: str) -> PanelURL | SerialURL:
    """Take a URL apart.

    Raises
    ------
    TypeError
        It is no str.
    ValueError
        A scheme, chip, size, address or parameter that does not exist; the message says what does.

    Examples
    --------
    >>> parse("i2c://1/0x3d?size=128x32").controller.height
    32
    >>> parse("serial://COM3?baudrate=500000").port
    'COM3'
    """
    if not isinstance(url, str):
        raise TypeError(f"url must be a str, not {type(url).__name__}")
    return replace(_parsed(url), place=url.partition("?")[0])


def _parsed(url: str) -> PanelURL | SerialURL:
    parts = urlsplit(url)
    if parts.scheme == "i2c":
        return _i2c(parts)
    if parts.scheme == "spi":
        return _spi(parts)
    if parts.scheme in ("serial", *_PYSERIAL):
        return _serial(parts)
    if parts.scheme == "sim":
        query = _query(parts, *_MODULE, *_PANEL, *_WATCHING, "realtime")
        if parts.path.strip("/"):
            raise ValueError(f"url must have the form {_FORMS['sim']}, not {url!r}")
        controller = _controller(parts.netloc or _CHIP, query)
        return replace(_simulated(controller, _module(query)), panel=_settings(query, _PANEL), watch=_watch(query))
    raise ValueError(f"url must have the form {' or '.join(_FORMS.values())}, not {url!r}")


def serial(port: str) -> SerialURL:
    """Take a serial port apart: the name of a device, a URL of pyserial's, or a panel's serial URL.

    Examples
    --------
    >>> serial("/dev/ttyACM0").port
    '/dev/ttyACM0'
    """
    parts = urlsplit(port)
    return _serial(parts) if parts.scheme in ("serial", *_PYSERIAL) else SerialURL(port, None, {})


def _simulated(controller: Controller, module: dict[str, Any]) -> PanelURL:
    return PanelURL("sim", controller, address=CHIPS[controller.name].address, module=module)


def _i2c(parts: SplitResult) -> PanelURL:
    lines = ("reset", "gpiochip")
    query = _query(parts, "chip", *_MODULE, "max_message", *lines, *_PANEL, *_WATCHING)
    if parts.netloc:  # 1, 1/0x3c or 1:0x3c
        place, colon, address = parts.netloc.partition(":")
        address = address if colon else parts.path.strip("/")
    else:  # /dev/i2c-1 or /dev/i2c-1/0x3c
        place, _, address = parts.path.rpartition("/")
        if address.startswith("i2c-"):
            place, address = parts.path, ""
    if ":" in address.partition("/")[0]:  # 1/0x70:3/0x3c
        through, _, address = address.partition("/")
        place = f"{place}/{through}"
    if not place or "/" in address:
        raise ValueError(f"url must have the form {_FORMS['i2c']}, not {parts.geturl()!r}")
    place, mux = _multiplexer(place)
    controller = _controller(query.get("chip", _CHIP), query)
    number = _address(address) if address else CHIPS[controller.name].address
    paired = {"data_address": number + 1} if "i2c-pair" in controller.buses else {}
    return PanelURL(
        "i2c",
        controller if paired else _on("i2c", controller),
        bus=int(place) if place.isdecimal() else place,
        address=number,
        module=_module(query),
        transport=mux | paired | _settings(query, {"max_message": "32"}) | _lines(query, *lines),
        panel=_settings(query, _PANEL),
        watch=_watch(query),
    )


def _address(text: str) -> int:
    """Read an address, of which people write ``3c`` as well as ``0x3c``."""
    if re.fullmatch("[0-9]?[a-f]|[0-9a-f][a-f]|[0-9][a-f]", text.lower()):
        text = f"0x{text}"
    return _number(text, "address", "0x3c")


def _multiplexer(place: str) -> tuple[str, dict[str, Any]]:
    """Take a bus apart from the multiplexer and its channel on it, as in ``1/0x70:3``."""
    bus, _, through = place.rpartition("/")
    address, colon, channel = through.partition(":")
    if not colon:
        return place, {}
    return bus, {"mux": (_number(address, "mux", "0x70"), _number(channel, "channel", "3"))}


def _spi(parts: SplitResult) -> PanelURL:
    lines = ("dc", "reset", "gpiochip")
    query = _query(parts, "chip", *_MODULE, *lines, "speed", *_PANEL, *_WATCHING)
    bus, _, device = parts.netloc.partition(".")
    if not (bus.isdecimal() and device.isdecimal()) or parts.path.strip("/"):
        raise ValueError(f"url must have the form {_FORMS['spi']}, not {parts.geturl()!r}")
    controller = _on("spi", _controller(query.get("chip", _CHIP), query))
    of_chip: dict[str, Any] = {"speed": controller.speed}
    if controller.synced:
        of_chip |= {"dc": None, "cs_high": True}
    elif controller.registers:  # LED chips have no such pins
        of_chip |= {"dc": None, "reset": None}
    said = _settings(query, {"speed": "8000000"}) | _lines(query, *lines)
    return PanelURL(
        "spi",
        controller,
        bus=int(bus),
        module=_module(query),
        transport={"device": int(device)} | of_chip | said,
        panel=_settings(query, _PANEL),
        watch=_watch(query),
    )


def _lines(query: dict[str, str], *names: str) -> dict[str, int | str | None]:
    """GPIO lines, and their chip, by number or name; ``none`` is none."""
    said = {name: query[name] for name in names if name in query}
    return {name: None if text == "none" else int(text) if text.isdecimal() else text for name, text in said.items()}


def _serial(parts: SplitResult) -> SerialURL:
    place = parts.netloc + parts.path
    if parts.scheme != "serial":
        place = f"{parts.scheme}://{place}"
    if not place:
        raise ValueError(f"url must have the form {_FORMS['serial']}, not {parts.geturl()!r}")
    if "://" in place:
        if place.partition("://")[0] not in _PYSERIAL:
            kinds = ", ".join(f"{kind}://" for kind in _PYSERIAL)
            raise ValueError(f"port must be a device or one of {kinds}, not {place!r}")
        pairs = parse_qsl(parts.query, keep_blank_values=True)
        others = urlencode([pair for pair in pairs if pair[0] not in _SERIAL])  # they are pyserial's
        place += f"?{others}" if others else ""
        parts = parts._replace(query=urlencode([pair for pair in pairs if pair[0] in _SERIAL]))
    else:
        place = unquote(place)
    query = _query(parts, *_SERIAL)
    if "chip" in query:
        _controller(query["chip"], query)
    rate = _number(query["baudrate"], "baudrate", "115200") if "baudrate" in query else None
    return SerialURL(place, rate, query, _settings(query, _PANEL), _watch(query))


def watch(query: str) -> Watch:
    """Read how a panel is to be watched, as it stands in a URL's parameters.

    Examples
    --------
    >>> watch("view=terminal,web").views
    ('terminal', 'web')
    """
    return _watch(_query(SplitResult("", "", "", query, ""), *_WATCHING))


def query(**parameters: str) -> str:
    """Write parameters as they stand in a URL.

    Examples
    --------
    >>> query(view="web", listen="0.0.0.0:8306", save="out.gif")
    'view=web&listen=0.0.0.0:8306&save=out.gif'
    """
    return urlencode(parameters, safe=":/,[]")


def _views(text: str) -> tuple[str, ...]:
    kinds = tuple(dict.fromkeys(text.lower().split(",")))
    for kind in kinds:
        if kind not in _VIEWS:
            raise ValueError(f"view must be {' or '.join(_VIEWS)}, not {kind!r}{did_you_mean(kind, _VIEWS)}")
    return kinds


def _watch(query: dict[str, str]) -> Watch:
    if "save" in query:
        from paneldraw.simulator.recorder import EXTENSIONS

        if not query["save"].lower().endswith(EXTENSIONS):
            raise ValueError(f"save must end in {' or '.join(EXTENSIONS)}, not {query['save']!r}")
    if "look" in query:
        from paneldraw.simulator import find_look

        find_look(query["look"])
    return Watch(
        _views(query["view"]) if "view" in query else (),
        query.get("save", ""),
        query.get("look"),
        _switch(query, "realtime") if "realtime" in query else False,
        _listen(query["listen"]) if "listen" in query else Watch().listen,
    )


def _listen(text: str) -> tuple[str, int | None]:
    """Read an address and a port: ``0.0.0.0:8306``, ``0.0.0.0`` or ``:8306``."""
    host, colon, port = text.rpartition(":") if not text.endswith("]") else (text, "", "")
    if not colon:
        host, port = text, ""
    if port and not (port.isdecimal() and 0 <= int(port) <= 65535):
        raise ValueError(f"listen must be like 0.0.0.0:8306, with a port up to 65535, not {text!r}")
    return host.strip("[]") or "127.0.0.1", int(port) if port else None


def _query(parts: SplitResult, *known: str) -> dict[str, str]:
    pairs = parse_qsl(parts.query, keep_blank_values=True)
    for name, _ in pairs:
        if name not in known:
            hint = did_you_mean(name, known)
            raise ValueError(f"url must have no parameters but {', '.join(known)}, not {name!r}{hint}")
    query = dict(pairs)
    if len(query) < len(pairs):
        raise ValueError(f"url must have each parameter once, not {parts.query!r}")
    return query


def _controller(chip: str, query: dict[str, str]) -> Controller:
    make = CHIPS.get(chip.lower())
    if make is None:
        hint = did_you_mean(chip.lower(), CHIPS)
        raise ValueError(f"chip must be one of {', '.join(CHIPS)}, not {chip!r}{hint}")
    for name in query:
        if name in _MODULE and name not in ("size", *make.parameters):
            raise ValueError(f"{name} must not be given for the {make.name}, which has {', '.join(make.parameters)}")
    return make(*_size(query), **_module(query))


def _size(query: dict[str, str]) -> tuple[int, ...]:
    if "size" not in query:
        return ()
    width, _, height = query["size"].partition("x")
    if not (width.isdecimal() and height.isdecimal()):
        raise ValueError(f"size must be like 128x64, not {query['size']!r}")
    return int(width), int(height)


def _module(query: dict[str, str]) -> dict[str, Any]:
    """What is said of the module beside its size."""
    said = [name for name in query if name in _MODULE and name != "size"]
    texts = {name: query[name] for name in said if name in _TEXTS}
    switches = {name: _switch(query, name) for name in said if name in _SWITCHES}
    numbers = {name: _number(query[name], name, "2") for name in said if name not in (*_TEXTS, *_SWITCHES)}
    return texts | switches | numbers


def _on(bus: str, controller: Controller) -> Controller:
    if bus not in controller.buses:
        address = f"{CHIPS[controller.name].address:#x}"
        places = (_FORMS[bus.removesuffix("-pair")].partition("?")[0] for bus in controller.buses)
        forms = " or ".join(place.replace("0x3c", address) for place in places)
        buses = " and ".join(BUSES[bus] for bus in controller.buses)
        complaint = f"chip must be one that {BUSES[bus]} reaches, not {controller.name!r}: it is on {buses}"
        raise ValueError(f"{complaint}, such as {forms}?chip={controller.name}")
    return controller


def _settings(query: dict[str, str], names: dict[str, str]) -> dict[str, Any]:
    """Settings by name, as numbers of an example's kind where there is one."""
    said: dict[str, Any] = {name: query[name] for name in names if name in query}
    for name, text in said.items():
        if names[name]:
            said[name] = (_fraction if name in _FRACTIONS else _number)(text, name, names[name])
    return said


def _switch(query: dict[str, str], name: str) -> bool:
    if query[name].lower() not in _YES:
        raise ValueError(f"{name} must be 1 or 0, not {query[name]!r}")
    return _YES[query[name].lower()]


def _number(text: str, name: str, example: str) -> int:
    try:
        return int(text, 0)
    except ValueError:
        raise ValueError(f"{name} must be a whole number, such as {example}, not {text!r}") from None


def _fraction(text: str, name: str, example: str) -> float:
    for read in (functools.partial(int, base=0), float):
        with contextlib.suppress(ValueError):
            return read(text)
    raise ValueError(f"{name} must be a number, such as {example}, not {text!r}")
