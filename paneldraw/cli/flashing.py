"""``paneldraw firmware flash`` and ``sources``: the firmware in the package, onto a board or into a folder."""

from __future__ import annotations

import argparse
import errno
import shlex
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import firmware_protocol

PROTOCOL: Final = Path(firmware_protocol.__file__).parent
READY: Final = PROTOCOL / "firmware" / "hex"
#: What a board's boot loader listens at.
BOARDS: Final = {"uno": 115200, "nano": 115200, "old-nano": 57600}
NO_AVRDUDE: Final = (
    "avrdude is not installed; on Debian and Raspberry Pi OS: sudo apt install avrdude; on macOS: "
    "brew install avrdude; elsewhere: https://github.com/avrdudes/avrdude"
)


def add(actions: Any, default_port: Callable[[], str]) -> None:
    """Add both actions to those of ``paneldraw firmware``; `default_port` finds the port that is not named."""
    about = "write the ready firmware onto an Arduino Uno or Nano, with avrdude"
    flash = actions.add_parser("flash", help=about, description=about)
    flash.add_argument("port", nargs="?", metavar="PORT", help="such as /dev/ttyACM0; default: the only one")
    flash.add_argument("--board", choices=BOARDS, default="uno", help="old-nano has the old boot loader (uno)")
    names = sorted(file.stem.removeprefix("atmega328p-") for file in READY.glob("*.hex"))
    flash.add_argument("--panel-on", choices=names, default="i2c-3c", help="the panel's bus, and its address (i2c-3c)")
    flash.add_argument("--file", type=Path, metavar="FILE", help="a .hex file of your own instead")
    flash.add_argument("--dry-run", action="store_true", help="print what would be run")
    flash.set_defaults(run=_flash, default_port=default_port)
    about = "copy the firmware's sources, ready files and protocol into a new folder"
    sources = actions.add_parser("sources", help=about, description=about)
    sources.add_argument("folder", type=Path, metavar="DIR", help="which is made")
    sources.set_defaults(run=_sources)


def _flash(options: argparse.Namespace) -> int:
    file = options.file or READY / f"atmega328p-{options.panel_on}.hex"
    if not file.is_file():
        raise FileNotFoundError(errno.ENOENT, "", str(file))
    port = options.port or options.default_port()
    if "://" in port:
        raise ValueError(f"avrdude reaches the boot loader on a serial port of this machine, not on {port}")
    command = ["avrdude", "-c", "arduino", "-p", "m328p", "-P", port, "-b", str(BOARDS[options.board]), "-D"]
    command += ["-U", f"flash:w:{file}:i"]
    print(shlex.join(command), flush=True)
    if options.dry_run:
        return 0
    found = shutil.which("avrdude")
    if found is None:
        raise OSError(errno.ENOENT, NO_AVRDUDE)
    _check(port)
    code = subprocess.run([found, *command[1:]], check=False).returncode
    if code:
        other = "uno" if options.board == "old-nano" else "old-nano"
        raise OSError(errno.EIO, f"avrdude ended with {code}; check the board and its cable, or try --board {other}")
    print(f"flashed; who answers: paneldraw firmware info {port}")
    return 0


def _check(port: str) -> None:
    """Open a port once: what is wrong with it is said better here than by avrdude."""
    from paneldraw.transports.serial import open_port

    open_port(port, 1.0).close()


def _sources(options: argparse.Namespace) -> int:
    folder: Path = options.folder
    if folder.exists():
        raise OSError(errno.EEXIST, f"{folder} is there already; name a new folder")
    unwanted = shutil.ignore_patterns("*.py", "*.typed", "__pycache__", "build")
    shutil.copytree(PROTOCOL, folder, ignore=unwanted)
    print(f"read {folder / 'firmware' / 'README.md'}; build with: make -C {folder / 'firmware'} atmega328p")
    return 0
