"""What there is to be found: versions, buses, ports, and who answers on them."""

from __future__ import annotations

import contextlib
import errno
import importlib.metadata
import os
import platform
import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from paneldraw.errors import TransportError
from paneldraw.transports import I2CTransport
from paneldraw.transports.i2c import probe

if TYPE_CHECKING:
    from paneldraw.panel import Panel

PANELS = {
    0x3C: "as most OLED panels",
    0x3D: "as an OLED panel with its address jumper moved",
    0x70: "as an HT16K33 LED matrix or a multiplexer",
    0x74: "as an IS31FL3731 LED matrix",
}
OTHERS = {0x70: "ht16k33", 0x74: "is31fl3731"}
"""Chips that are known by their address alone."""
STATUS = {0x8: "sh1106", 0x3: "ssd1306", 0x6: "ssd1306", 0x7: "sh1107", 0xF: "sh1107"}
"""The lower four bits of the status byte, as modules seen so far answer them, and what chip they had."""
SYMPTOMS = (
    "what the picture looks like, and what to add to the URL:",
    "  noise along an edge, or a shift of two columns    chip=sh1106",
    "  half the lines, or lines twice as high            size=128x32",
    "  mirrored                                          mirror_x=1",
    "  right, but dim                                    internal_reference=1",
    "  nothing at all                                    reset= with its line, charge_pump=1; check the wiring",
)
NOBODY = (121, errno.ENXIO, errno.EIO)
"""EREMOTEIO, which only Linux has a name for, ENXIO or EIO, as the adapter's driver has it."""
NO_BUS = (
    "no I2C bus here; on a Raspberry Pi: sudo raspi-config, Interface Options, I2C, then reboot; "
    "without a panel: --panel sim://"
)
NO_PANEL = "no panel answered at 3c or 3d; check power, ground, SDA and SCL, or try a simulated one: --panel sim://"


@dataclass
class Found:
    """What a search found: lines to print, URLs of what may be panels, and what to do if there are none."""

    lines: list[str] = field(default_factory=list)
    panels: list[str] = field(default_factory=list)
    advice: str = NO_PANEL
    unknown: bool = False


def version(package: str) -> str:
    """Return the version of an installed package, or ``"not installed"``."""
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "not installed"


def info(url: str | None = None) -> Iterator[tuple[str, str]]:
    """Yield names and values of all that a bug report should tell; opens a panel only if its URL is given."""
    yield "paneldraw", version("paneldraw")
    yield "drawing", _speed()
    yield "Python", f"{platform.python_version()} ({platform.python_implementation()})"
    yield "platform", _machine()
    for package in ("numpy", "Pillow", "smbus2", "pyserial"):
        yield package, version(package)
    for extra, packages in {"spi": ("spidev", "gpiod"), "web": ("aiohttp",)}.items():
        yield f"extra {extra}", ", ".join(f"{package} {version(package)}" for package in packages)
    yield "I2C buses", ", ".join(f"{path} ({name})" for path, name in i2c_buses()) or "none"
    yield "serial ports", ", ".join(serial_ports()) or "none"
    if url is None:
        yield "panel", os.environ.get("PANELDRAW_PANEL") or "a simulated SSD1306 ($PANELDRAW_PANEL is not set)"
    else:
        from paneldraw.panel import open_panel

        with open_panel(url) as panel:
            yield "panel", describe(panel)


def describe(panel: Panel) -> str:
    """Say what a panel is, in a few words."""
    return f"{panel.controller.name} {panel.width}x{panel.height}"


def _speed() -> str:
    from paneldraw._compiled import COMPILED
    from paneldraw._interpreted import advice

    return "compiled" if COMPILED else f"interpreted, which is slow; {advice()}"


def _machine() -> str:
    model = Path("/proc/device-tree/model")
    name = platform.platform()
    return f"{model.read_text().rstrip(chr(0))}, {name}" if model.exists() else name


def i2c_buses() -> list[tuple[str, str]]:
    """Return path and adapter name of every I2C bus."""
    paths = sorted(Path("/dev").glob("i2c-*"), key=lambda path: [int(n) for n in re.findall(r"\d+", path.name)])
    return [(str(path), _adapter_name(path)) for path in paths]


def _adapter_name(path: Path) -> str:
    try:
        return Path(f"/sys/class/i2c-dev/{path.name}/name").read_text().strip()
    except OSError:
        return "unnamed"


def serial_ports() -> list[str]:
    """Return the names of the serial ports that have something plugged in."""
    from serial.tools import list_ports

    return [f"{port.device} ({port.description})" for port in list_ports.comports() if port.hwid != "n/a"]


def detect(url: str | None = None) -> Found:
    """Look for panels.

    Parameters
    ----------
    url : str, optional
        A panel URL that says where to look: on one I2C bus or the simulated one. Default: on all I2C buses.

    Raises
    ------
    ValueError
        If it is a URL of something that cannot be searched.
    """
    found = Found()
    parts = urlsplit(url or "i2c://")
    if parts.scheme == "sim":
        from paneldraw.panel import open_panel

        with open_panel(url) as panel:
            if bus := getattr(panel.transport, "bus", None):  # it may be watched
                _search(found, bus, "the simulated bus", "sim://")
    elif parts.scheme == "i2c":
        asked = f"/dev/i2c-{parts.netloc}" if parts.netloc else re.sub("/[^-/]+$", "", parts.path)
        for path, name in [(asked, _adapter_name(Path(asked)))] if asked else i2c_buses():
            _search_device(found, path, name, asked=bool(asked))
        if not found.lines:
            found.advice = NO_BUS
    else:
        asks = f"paneldraw firmware info {url}" if parts.scheme == "serial" else "--panel i2c://1"
        raise ValueError(f"detect looks on I2C buses and on the simulated one, not on {url}; try {asks}")
    if found.unknown:
        found.lines += SYMPTOMS
    for port in serial_ports():
        name = port.partition(" ")[0]
        found.lines.append(f"serial port {port}: not asked; try: paneldraw firmware info {name}")
    return found


def _search_device(found: Found, path: str, name: str, *, asked: bool) -> None:
    number = path.rpartition("-")[2]
    title = f"bus {number} ({name})"
    if name.startswith("SMBus") and not asked:
        found.lines.append(f"{title}: left alone, it is the mainboard's own; --panel i2c://{number} searches it")
        return
    try:
        transport = I2CTransport(path)
    except TransportError as error:
        if asked:
            raise
        found.lines.append(f"{title}: {error.strerror}")
        return
    with contextlib.closing(transport):
        _search(found, transport.bus, title, f"i2c://{number}")


def _search(found: Found, bus: Any, title: str, url: str) -> None:
    answers = 0
    for address in range(0x08, 0x78):
        try:
            probe(bus, address)
        except OSError as error:
            if error.errno in NOBODY:
                continue
            if error.errno != errno.EBUSY:
                found.lines.append(f"{title}: {error.strerror}; is SDA or SCL stuck or not pulled up?")
                return
            found.lines.append(f"{title}: {address:02x} is in use by a driver of the kernel")
        else:
            found.lines.append(f"{title}: {address:02x} answers{_guess(bus, address, found, url)}")
        answers += 1
    if not answers:
        found.lines.append(f"{title}: nobody answers")


def _guess(bus: Any, address: int, found: Found, url: str) -> str:
    """Say what the device at an address may be, and how to try it."""
    if address not in PANELS:
        return ""
    panel = url if url == "sim://" else f"{url}/{address:#x}"
    chip = OTHERS.get(address) or _chip(bus, address)
    named = f"{panel}?chip={chip}" if chip and url != "sim://" else panel
    found.panels.append(named)
    found.unknown = found.unknown or chip is None
    guess = f"; its status is that of an {chip.upper()}, at a guess" if chip and address not in OTHERS else ""
    return f", {PANELS[address]}{guess}; try: paneldraw demo --panel {shlex.quote(named)}"


def _chip(bus: Any, address: int) -> str | None:
    try:
        return STATUS.get(bus.read_byte(address) & 0x0F)
    except OSError:
        return None
