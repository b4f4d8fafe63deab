"""``paneldraw firmware``: who answers on a serial port, how the line to it does, and what `flashing` adds."""

from __future__ import annotations

import argparse
import contextlib
import errno
import math
import os
import time
from collections.abc import Callable
from statistics import mean, median
from typing import TYPE_CHECKING, Any, Final

from paneldraw import urls
from paneldraw.cli import flashing
from paneldraw.errors import PanelNotFoundError, TransportError

if TYPE_CHECKING:
    from firmware_protocol import HelloReply, Status
    from paneldraw.transports import SerialTransport

_COLUMNS: Final = ("seconds", "trip ms", "damaged", "overflows", "line errors", "resent", "timeouts", "fault")


Number = Callable[[str], float]


def add(commands: Any, count: Number, seconds: Number) -> None:
    """Add the command to a parser's; ``count`` and ``seconds`` read positive numbers."""
    about = "look at the microcontroller that drives a panel on a serial port"
    parser = commands.add_parser("firmware", help=about, description=about)
    actions = parser.add_subparsers(title="actions", metavar="ACTION", required=True)
    ports = actions.add_parser("ports", help="list the serial ports", description="list the serial ports")
    ports.set_defaults(run=_ports)
    flashing.add(actions, lambda: _default().port)
    for name, run, help in (
        ("info", _info, "say what answers on a port"),
        ("monitor", _monitor, "print the board's counters, live, until Ctrl-C"),
        ("ping", _ping, "measure round-trip times"),
    ):
        action = actions.add_parser(name, help=help, description=help)
        action.add_argument(
            "port", nargs="?", metavar="PORT", help="such as /dev/ttyACM0 or socket://host:port; default: the only one"
        )
        action.add_argument("--baudrate", type=count, metavar="N", help="default: what the board likes best")
        action.set_defaults(run=run)
        if name == "monitor":
            action.add_argument("--seconds", type=seconds, default=math.inf, metavar="N", help="how long (inf)")
            action.add_argument("--interval", type=seconds, default=1.0, metavar="N", help="between lines (1)")
        if name == "ping":
            action.add_argument("--count", type=count, default=100, metavar="N", help="how many (100)")


def _ports(options: argparse.Namespace) -> int:
    from paneldraw.cli import diagnostics

    for line in diagnostics.serial_ports() or ["no serial port; plug a board in"]:
        print(line)
    return 0


def _info(options: argparse.Namespace) -> int:
    with contextlib.closing(_opened(options)) as transport:
        for name, value in _described(transport, transport.status()):
            print(f"{name + ':':14}{value}")
    return 0


def _monitor(options: argparse.Namespace) -> int:
    with contextlib.closing(_opened(options)) as transport:
        print("  ".join(_COLUMNS), flush=True)
        start = time.monotonic()
        while True:
            print(_row(transport, start), flush=True)
            if time.monotonic() - start + options.interval > options.seconds:
                return 0
            time.sleep(options.interval)


def _row(transport: SerialTransport, start: float) -> str:
    asked = time.monotonic()
    try:
        status = transport.status()
    except TransportError as error:
        if not error.transient:
            raise
        return f"{asked - start:{len(_COLUMNS[0])}.0f}  {error.strerror}"
    trip = time.monotonic() - asked
    stats = transport.link.stats
    values = (
        f"{asked - start:.0f}", f"{1000 * trip:.2f}", status.damaged, status.overflows, status.line_errors,
        stats.resent, stats.timeouts, status.fault.name.lower().replace("_", " "),
    )  # fmt: skip
    return "  ".join(f"{value!s:>{len(name)}}" for name, value in zip(_COLUMNS, values, strict=True))


def _ping(options: argparse.Namespace) -> int:
    with contextlib.closing(_opened(options)) as transport:
        trips = []
        for _ in range(options.count):
            start = time.perf_counter()
            transport.status()
            trips.append(1000 * (time.perf_counter() - start))
        print(
            f"{transport.name} at {transport.baudrate} baud: {len(trips)} round trips, least {min(trips):.2f} ms, "
            f"median {median(trips):.2f}, mean {mean(trips):.2f}, most {max(trips):.2f}"
        )
    return 0


def _opened(options: argparse.Namespace) -> SerialTransport:
    from paneldraw.transports import SerialTransport

    wanted = urls.serial(options.port) if options.port else _default()
    return SerialTransport(wanted.port, options.baudrate or wanted.baudrate)


def _default() -> urls.SerialURL:
    """The port that the environment names, or the only one there is."""
    from paneldraw.cli import diagnostics

    with contextlib.suppress(ValueError):
        wanted = urls.parse(os.environ.get("PANELDRAW_PANEL", ""))
        if isinstance(wanted, urls.SerialURL):
            return wanted
    there = [port.partition(" ")[0] for port in diagnostics.serial_ports()]
    if len(there) == 1:
        return urls.serial(there[0])
    if there:
        raise ValueError(f"say which port: {', '.join(there)}")
    raise PanelNotFoundError(errno.ENODEV, "there is no serial port here; plug a board in, or say which port")


def _described(transport: SerialTransport, status: Status) -> list[tuple[str, str]]:
    from firmware_protocol.messages import cause_text

    device = transport.device
    rates = f"; it offers {', '.join(map(str, device.bauds))}" if device.bauds else ", where the rate does not matter"
    return [
        ("port", f"{transport.name} at {transport.baudrate} baud{rates}"),
        ("firmware", device.firmware or "does not say"),
        ("protocol", f"version {device.version}; it speaks {device.oldest} to {device.newest}"),
        ("panel", _panel(device)),
        ("memory", f"{device.max_payload} bytes a message, {device.window} under way"),
        ("last start", cause_text(device.cause)),
        ("line", f"{status.damaged} damaged frames, {status.overflows} overflows, {status.line_errors} line errors"),
    ]


def _panel(device: HelloReply) -> str:
    size = f" {device.width}x{device.height}" if device.width else ""
    bus = device.bus.name.replace("NONE", "no bus")
    where = f"{bus} at 0x{device.address:02X}" if device.address else bus
    state = "answers" if device.present else "does not answer: check its wiring and address"
    return f"{device.controller or 'a chip it does not know'}{size} on {where}, {state}"
