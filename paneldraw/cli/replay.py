"""``paneldraw replay``: what a recording of a wire shows on a panel, and what was wrong."""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from paneldraw import urls

if TYPE_CHECKING:
    from paneldraw.simulator import Replayed
    from paneldraw.simulator.chip import Chip

Number = Callable[[str], float]

_HISTORY: Final = 20_000
"""So many frames are kept: 160 MB of 128 x 64 pixels."""
_LINES: Final = {
    "scl": "I2C's clock",
    "sda": "I2C's data",
    "clk": "SPI's clock",
    "mosi": "SPI's data to the panel",
    "cs": "the panel's chip select",
    "dc": "the panel's D/C",
    "reset": "the panel's reset",
}


def add(commands: Any, save_path: Callable[[str], Path], count: Number, rate: Number) -> None:
    """Add the command to a parser's; the functions read a path to save to and positive numbers."""
    about = "show what a recording of a wire brings onto a panel, and what was wrong"
    parser = commands.add_parser(
        "replay",
        help=about,
        description=f"{about}. It reads logs of simulated buses, sigrok sessions (.sr) and CSV, annotations of "
        f"sigrok's I2C decoder, Saleae's CSV exports and the kernel's I2C traces, compressed by gzip or not.",
    )
    parser.add_argument("log", metavar="LOG", help="the recording")
    chosen = parser.add_mutually_exclusive_group()
    chosen.add_argument("--chip", metavar="NAME", help="the panel's chip, such as sh1106 (ssd1306)")
    chosen.add_argument(
        "--panel", metavar="URL", help="such as i2c://1/0x3d?chip=sh1106&size=128x32; default: $PANELDRAW_PANEL"
    )
    parser.add_argument("--transcript", action="store_true", help="print what every byte means")
    parser.add_argument("--frames", action="store_true", help="print when each picture was complete")
    parser.add_argument("--save", type=save_path, metavar="FILE", help="write a .gif, .apng, or a .png of the last")
    parser.add_argument("--scale", type=count, default=4, metavar="N", help="image pixels a pixel of that (4)")
    parser.add_argument("--look", metavar="NAME", help="its look: white, blue, yellow-blue, lcd-green, ...")
    parser.add_argument("--address", type=_hex, metavar="N", help="the panel's on I2C, such as 3c, if several answered")
    parser.add_argument("--bus", type=count, metavar="N", help="of a kernel's trace of several buses")
    parser.add_argument("--rate", type=rate, metavar="HZ", help="samples a second of a recording that does not tell")
    for name, what in _LINES.items():
        parser.add_argument(f"--{name}", metavar="CHANNEL", help=f"{what}: a channel's name, or its number from 0")
    parser.set_defaults(run=_replay)


def _replay(options: argparse.Namespace) -> int:
    from paneldraw.simulator import TerminalView, Transcript, find_look, replay, save, simulated_chip

    url = f"sim://{options.chip}" if options.chip else options.panel or os.environ.get("PANELDRAW_PANEL") or "sim://"
    wanted = urls.parse(url)
    if isinstance(wanted, urls.SerialURL):
        raise ValueError(
            "give the panel's own URL, such as i2c://1/0x3c?chip=ssd1306: nobody records serial links here"
        )
    find_look(options.look)
    chip = simulated_chip(wanted.controller, wanted.module, history=_HISTORY)
    transcript = Transcript(chip, print) if options.transcript else None
    told = replay(
        options.log,
        chip,
        address=_given(url, wanted) if options.address is None else options.address,
        usual=wanted.address,
        mux=wanted.transport.get("mux"),
        bus=options.bus,
        rate=options.rate,
        lines={name: channel for name in _LINES if (channel := getattr(options, name)) is not None},
    )
    if transcript:
        transcript.close()
    with TerminalView() as view:
        view.show(chip, _caption(chip, told))
    for line in [*(_pictures(chip) if options.frames else ()), *_said(chip, told)]:
        print(line)
    if options.save:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            save(chip, options.save, scale=options.scale, look=options.look)
        for warning in caught:
            print(f"paneldraw: {warning.message}", file=sys.stderr)
        print(f"wrote {options.save}")
    return 0


def _hex(text: str) -> int:
    try:
        return int(text, 16)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text} is no address such as 3c or 0x3c") from None


def _given(url: str, wanted: urls.PanelURL) -> int | None:
    """The address, if the URL names one."""
    return wanted.address if wanted.scheme == "i2c" and f"{wanted.address:x}" in url.partition("?")[0].lower() else None


def _caption(chip: Chip, told: Replayed) -> str:
    frames = chip.frames
    where = f" to {told.address:#04x}" if told.address is not None else ""
    seconds = f" in {frames[-1].seconds - frames[0].seconds:.3f} s" if len(frames) > 1 else ""
    count = frames.dropped + len(frames)
    pictures = f"{count} picture" if count == 1 else f"{count} pictures{seconds}"
    return f"{told.form}{where}: {pictures} on {type(chip).__name__}"


def _pictures(chip: Chip) -> Sequence[str]:
    return [
        f"picture {number} at {frame.seconds:.6f} s, {frame.wire_bytes} bytes"
        for number, frame in enumerate(chip.frames, 1 + chip.frames.dropped)
    ]


def _said(chip: Chip, told: Replayed) -> Sequence[str]:
    """What was wrong."""
    lines = [f"recording: {text}" for text in told.remarks]
    lines += [f"violation: {text}" for text in chip.violations]
    lines += [f"remark: {text}" for text in chip.remarks]
    return lines or ["nothing was wrong"]
