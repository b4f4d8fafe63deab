"""Devices from the command line, or from a file of its options."""

from __future__ import annotations

import argparse
import contextlib
import importlib
import inspect
import os
from collections.abc import Callable
from typing import Any, Final

from paneldraw.compat.luma import core
from paneldraw.compat.luma.core import framebuffer
from paneldraw.compat.luma.core.interface.serial import i2c, noop, spi

_LIBRARIES: Final = ("oled", "lcd", "led_matrix")
_INTERFACES: Final = ("i2c", "spi", "noop")
_ABSTRACT: Final = ("backlit_device",)

_OPTIONS: Final[dict[str, list[tuple[str, dict[str, Any]]]]] = {
    "I2C": [
        ("--i2c-port", {"type": int, "default": 1, "help": "number of the bus"}),
        ("--i2c-address", {"default": "0x3C", "help": "address of the display"}),
    ],
    "SPI": [
        ("--spi-port", {"type": int, "default": 0, "help": "number of the bus"}),
        ("--spi-device", {"type": int, "default": 0, "help": "chip select"}),
        ("--spi-bus-speed", {"type": int, "default": 8_000_000, "help": "clock rate in Hz"}),
        ("--spi-transfer-size", {"type": int, "default": 4096, "help": "not needed"}),
        ("--spi-mode", {"type": int, "help": "clock polarity and phase: 0"}),
        ("--gpio", {"help": "module with RPi.GPIO's interface; default: gpiod"}),
        ("--gpio-mode", {"help": "how that module numbers lines, such as RPi.GPIO.BCM"}),
        ("--gpio-data-command", {"type": int, "default": 24, "help": "line of D/C"}),
        ("--gpio-reset", {"type": int, "default": 25, "help": "line of reset"}),
        ("--gpio-backlight", {"type": int, "default": 18, "help": "line of the backlight"}),
        ("--gpio-reset-hold-time", {"type": float, "default": 0, "help": "not needed"}),
        ("--gpio-reset-release-time", {"type": float, "default": 0, "help": "not needed"}),
    ],
    "Display": [
        ("--block-orientation", {"type": int, "default": 0, "choices": (0, 90, -90, 180), "help": "of matrices"}),
        ("--mode", {"default": "RGB", "choices": ("1", "RGB", "RGBA"), "help": "mode of images, of chips with grays"}),
        ("--framebuffer", {"default": framebuffer.__all__[0], "choices": framebuffer.__all__, "help": "what is sent"}),
        ("--num-segments", {"type": int, "default": 4, "help": "not needed"}),
        ("--bgr", {"action": "store_true", "help": "not needed"}),
        ("--inverse", {"action": "store_true", "help": "not needed"}),
        ("--h-offset", {"type": int, "default": 0, "help": "not needed"}),
        ("--v-offset", {"type": int, "default": 0, "help": "not needed"}),
        ("--backlight-active", {"default": "low", "choices": ("low", "high"), "help": "level that lights it"}),
        ("--debug", {"action": "store_true", "help": "not needed"}),
    ],
}


def get_choices(module_name: str) -> list[str]:
    """Return the public names of a module of luma's or of ours."""
    name = module_name if module_name.startswith("paneldraw.") else f"paneldraw.compat.{module_name}"
    return [each for each in importlib.import_module(name).__all__ if each not in _ABSTRACT]


def get_supported_libraries() -> list[str]:
    """Return which libraries there are."""
    return list(_LIBRARIES)


def get_display_types() -> dict[str, list[str]]:
    """Return the displays of each library."""
    displays = {library: get_choices(f"luma.{library}.device") for library in _LIBRARIES}
    return {**displays, "emulator": [], "core": []}


def get_library_for_display_type(display_type: str) -> str | None:
    """Return the library that a display is in."""
    return next((library for library, names in get_display_types().items() if display_type in names), None)


def get_library_version(module_name: str) -> str:
    """Return the version, which is paneldraw's for all of them."""
    return core.__version__


def get_interface_types() -> list[str]:
    """Return what displays can be on."""
    return list(_INTERFACES)


def load_config(path: str | os.PathLike[str]) -> list[str]:
    """Return the options in a file, one a line; empty lines and those after ``#`` are none."""
    with open(path, encoding="utf-8") as file:
        lines = [line.strip() for line in file]
    return [line for line in lines if line and not line.startswith("#")]


class make_interface:
    """Interfaces by their names, as the command line wants them."""

    def __init__(self, opts: Any, gpio: Any = None) -> None:
        self.opts, self.gpio = opts, gpio

    def noop(self) -> noop:
        """Return one that does nothing."""
        return noop()

    def i2c(self) -> i2c:
        """Return the place on an I2C bus."""
        return i2c(port=self.opts.i2c_port, address=self.opts.i2c_address)

    def spi(self) -> spi:
        """Return the place on an SPI bus."""
        return spi(
            port=self.opts.spi_port,
            device=self.opts.spi_device,
            bus_speed_hz=self.opts.spi_bus_speed,
            spi_mode=getattr(self.opts, "spi_mode", None),
            gpio_DC=self.opts.gpio_data_command,
            gpio_RST=self.opts.gpio_reset,
            gpio=self.gpio or self._module(),
        )

    def _module(self) -> Any:
        """The module for lines that was asked for."""
        if not getattr(self.opts, "gpio", None):
            return None
        gpio = importlib.import_module(self.opts.gpio)
        if self.opts.gpio_mode:
            package, _, name = self.opts.gpio_mode.rpartition(".")
            gpio.setmode(getattr(importlib.import_module(package), name))
        else:
            gpio.setmode(gpio.BCM)
        return gpio


def create_device(args: Any, display_types: dict[str, list[str]] | None = None) -> Any:
    """Make the device that the options of `create_parser` name.

    Raises
    ------
    Error
        It cannot be reached, or is not of this size.
    ValueError
        There is no such display.
    """
    library = get_library_for_display_type(args.display)
    if library is None:
        names = ", ".join(name for names in get_display_types().values() for name in names)
        raise ValueError(f"display must be one of {names}, not {args.display!r}")
    kind: Callable[..., Any] = getattr(importlib.import_module(f"paneldraw.compat.luma.{library}.device"), args.display)
    interface = getattr(make_interface(args), args.interface)()
    taken = inspect.signature(kind).parameters
    wanted = {name: value for name, value in vars(args).items() if name in taken and name != "framebuffer"}
    if library != "lcd":  # whose glass is of one size
        wanted |= {"width": args.width, "height": args.height}
    if library == "led_matrix":
        return kind(interface, **wanted)
    wanted["framebuffer"] = getattr(framebuffer, args.framebuffer)(num_segments=args.num_segments, debug=args.debug)
    wanted["mode"] = args.mode if args.mode in kind.modes else None  # type: ignore[attr-defined]
    if library == "lcd":
        wanted |= {"gpio": None, "gpio_LIGHT": args.gpio_backlight, "active_low": args.backlight_active == "low"}
    return kind(interface, **wanted)


def create_parser(
    description: str, parser: argparse.ArgumentParser | None = None, autocomplete: bool = True
) -> argparse.ArgumentParser:
    """Return a parser of luma's options, of which those that only emulators and colors need are not there."""
    if parser is None:
        formatter = argparse.ArgumentDefaultsHelpFormatter
        parser = argparse.ArgumentParser(description=description, formatter_class=formatter)
    displays = [name for names in get_display_types().values() for name in names]
    general = parser.add_argument_group("General")
    general.add_argument("--config", "-f", help="file of options")
    general.add_argument("--display", "-d", default="ssd1306", choices=displays, help="chip of the display")
    general.add_argument("--width", type=int, default=128, help="pixels across")
    general.add_argument("--height", type=int, default=64, help="pixels down")
    general.add_argument("--rotate", "-r", type=int, default=0, choices=range(4), help="quarter turns clockwise")
    general.add_argument("--interface", "-i", default=_INTERFACES[0], choices=_INTERFACES, help="what it is on")
    for title, options in _OPTIONS.items():
        group = parser.add_argument_group(title)
        for flag, settings in options:
            group.add_argument(flag, **settings)
    if autocomplete:
        with contextlib.suppress(ImportError):
            importlib.import_module("argcomplete").autocomplete(parser)
    return parser
