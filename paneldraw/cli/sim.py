"""``paneldraw sim``: simulated panels for any program, seen and recorded."""

from __future__ import annotations

import argparse
import contextlib
import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, Final

if TYPE_CHECKING:
    from paneldraw.simulator.mishaps import Mishap
    from paneldraw.simulator.preload import Preload
    from paneldraw.simulator.rig import Rig, RigPanel

_HISTORY: Final = 10_000
"""Frames that a recording holds."""
_ABOUT: Final = "start simulated panels and show them until Ctrl-C; `paneldraw sim run` runs a program with them"
_ABOUT_RUN: Final = "run a program with simulated panels in place of /dev/i2c-N, /dev/spidevB.D and serial ports"
_CRASHES: Final = ("SIGSEGV", "SIGBUS", "SIGABRT", "SIGILL", "SIGFPE")
_FROM_KEYS: Final = ("SIGINT", "SIGQUIT")
"""Signals that a terminal sends to all of its programs at once."""
_PASSED_ON: Final = ("SIGINT", "SIGQUIT", "SIGTERM", "SIGHUP", "SIGUSR1", "SIGUSR2")
_NOT_FOUND: Final = 127
_NOT_RUN: Final = 126


def add(commands: Any, save_path: Callable[[str], Path]) -> None:
    """Add the command to a parser's; ``save_path`` reads the name of a recording."""
    parser = commands.add_parser("sim", help=_ABOUT, description=_ABOUT)
    parser.add_argument("file", nargs="?", metavar="FILE.toml", help="panels, each a table [panel.NAME] with its url")
    _add_options(parser, save_path)
    parser.set_defaults(run=_sim)
    run = type(parser)(prog="paneldraw sim run", description=_ABOUT_RUN)
    run.add_argument("--file", metavar="FILE.toml", help="panels, each a table [panel.NAME] with its url")
    _add_options(run, save_path)
    run.add_argument("--quiet", action="store_true", help="print no summary at the end")
    run.add_argument("command", nargs=argparse.PARSER, metavar="-- COMMAND", help="the program and its arguments")
    run.set_defaults(run=_run)
    parser.actions["run"] = run


def _add_options(parser: argparse.ArgumentParser, save_path: Callable[[str], Path]) -> None:
    parser.add_argument(
        "--panel",
        action="append",
        default=[],
        metavar="URL",
        help="such as i2c://1/0x3c?chip=ssd1306; may be given several times; default: $PANELDRAW_PANEL, else that one",
    )
    parser.add_argument("--view", choices=["terminal", "web", "browser"], help="show the panels live")
    parser.add_argument("--save", type=save_path, metavar="FILE", help="write a .gif, .apng or .png at the end")
    parser.add_argument("--log", type=Path, metavar="FILE", help="write down the bytes, for `paneldraw replay`")
    parser.add_argument("--look", metavar="NAME", help="how the glass looks, such as blue; default: as the chip's")
    parser.add_argument("--realtime", action="store_true", help="let bytes take as long as on a real wire")
    parser.add_argument(
        "--transcript", action="store_true", help="print what the chips make of each message, to stderr"
    )
    parser.add_argument(
        "--fail",
        action="append",
        type=_mishap,
        default=[],
        metavar="KIND:RATE%",
        help="such as nack:1%%; of messages: nack, timeout, busy, short, power; of bytes on serial lines: flip, drop",
    )
    parser.add_argument("--seed", type=int, default=0, metavar="N", help="other faults for another number (0)")


def _mishap(text: str) -> Mishap:
    from paneldraw.simulator.mishaps import read_mishap

    try:
        return read_mishap(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


# the panels


@contextlib.contextmanager
def _panels(options: argparse.Namespace) -> Iterator[Rig]:
    """Set up what was asked for; on leaving, whatever happened, write what is to be saved and unplug everything."""
    from paneldraw.simulator.looks import find_look

    find_look(options.look)
    with contextlib.ExitStack() as stack:
        rig = stack.enter_context(_rig(options))
        if options.save:
            _check_writable(options.save)
            stack.push(partial(_save_unless_failed, rig.panels, options))
        for mishap in options.fail:
            mishap.strike(rig.panels, options.seed)
        yield rig


def _rig(options: argparse.Namespace) -> Rig:
    from paneldraw.simulator.rig import Rig

    given = list(options.panel)
    if not given and not options.file:
        given = [os.environ.get("PANELDRAW_PANEL") or "sim://ssd1306"]
    for url in given:
        _heed(options, url)
    settings: dict[str, Any] = {"realtime": options.realtime}
    if options.save:
        settings["history"] = _HISTORY
    rig = Rig.from_file(options.file, **settings) if options.file else Rig(**settings)
    try:
        for url in given:
            rig.add(url)
    except BaseException:
        rig.close()
        raise
    return rig


def _heed(options: argparse.Namespace, url: str) -> None:
    """Do what a panel's URL asks for where the command does not: a view, a recording, real time."""
    from paneldraw import urls

    watch = urls.parse(url).watch
    options.view = options.view or next(iter(watch.views), None)
    options.save = options.save or (Path(watch.save) if watch.save else None)
    options.realtime = options.realtime or watch.realtime


def _check_writable(path: Path) -> None:
    if not path.parent.is_dir():
        raise ValueError(f"there is no folder {path.parent}; make it first")
    if path.is_dir() or not os.access(path if path.exists() else path.parent, os.W_OK):
        raise ValueError(f"{path} cannot be written; check its permissions")


def _save_unless_failed(
    panels: Sequence[RigPanel], options: argparse.Namespace, kind: object, error: BaseException | None, trace: object
) -> None:
    if not isinstance(error, Exception):  # a signal is none
        _save(panels, options.save, options.look)


def _save(panels: Sequence[RigPanel], path: Path, look: str | None) -> None:
    """Write a file for each panel; of several, each has the panel's name in its own."""
    from paneldraw.cli.playback import Progress
    from paneldraw.simulator import save

    for panel in panels:
        own = _own(path, panel.name, len(panels))
        frames = list(panel.chip.frames)
        if not frames:
            _say(f"{panel.name} showed nothing, so there is no {own}")
            continue
        if path.suffix.lower() == ".png":  # the last that shone: many programs leave the panel dark
            frames = [next((frame for frame in reversed(frames) if frame.pixels.any()), frames[-1])]
        with Progress("writing") as progress:
            save(frames, own, look=look or panel.look or panel.chip.look, progress=progress)
        _say(f"wrote {own}")


def _own(path: Path, name: str, count: int) -> Path:
    """The file of one of several panels."""
    if count == 1:
        return path
    plain = "".join(char if char.isalnum() or char in "-_." else "-" for char in name)
    return path.with_name(f"{path.stem}-{plain}{path.suffix}")


def _to_stderr(line: str) -> None:
    print(line, file=sys.stderr, flush=True)


def _say(line: str) -> None:
    _to_stderr(f"paneldraw: {line}")


@contextlib.contextmanager
def _watched(options: argparse.Namespace, panels: Sequence[RigPanel], view: Any) -> Iterator[None]:
    """Show the panels and write down what they make of what they are sent, as far as that was asked for."""
    from paneldraw.simulator.log import Log
    from paneldraw.simulator.transcript import Transcript

    with contextlib.ExitStack() as stack:
        if options.log:
            buses = {panel.bus: panel.name for panel in reversed(panels)}
            for bus, name in buses.items():
                stack.enter_context(Log(bus, _own(options.log, name, len(buses))))
        if options.transcript:
            for panel in panels:
                stack.enter_context(Transcript(panel.chip, _to_stderr, panel.name if len(panels) > 1 else ""))
        if view is not None:
            _show(stack, panels, view, options.look)
        yield


def _show(stack: contextlib.ExitStack, panels: Sequence[RigPanel], kind: Any, look: str | None) -> None:
    from paneldraw.simulator.views import open_view

    try:
        view = stack.enter_context(open_view(kind, ()))
    except ImportError as error:
        raise ValueError(f'a page needs aiohttp: pip install "paneldraw[web]" ({error})') from None
    for panel in panels:
        view.add(panel.chip, panel.name, look or panel.look)
    if view.url:
        _say(f"watch at {view.url}")


# sim


def _sim(options: argparse.Namespace) -> int:
    kind = options.view or ("terminal" if sys.stdout.isatty() else None)
    with _panels(options) as rig, contextlib.ExitStack() as stack:
        for line in _places(rig, stack):
            print(line, flush=True)
        stack.enter_context(_watched(options, rig.panels, kind))
        while True:  # a signal unwinds
            time.sleep(3600)


def _places(rig: Rig, stack: contextlib.ExitStack) -> Iterator[str]:
    """Say where programs find the panels."""
    for panel in rig.panels:
        if panel.port is None:
            yield f"{panel.name}: {panel.url}"
        else:
            query = panel.url.partition("?")[2]
            url = f"serial://{panel.port.path}{'?' if query else ''}{query}"
            yield f"{panel.name}: {panel.port.path}; a script finds it by PANELDRAW_PANEL={shlex.quote(url)}"
    if rig.i2c or rig.spi:
        try:
            preload = stack.enter_context(rig.preload())
        except OSError as error:
            yield f"buses cannot be reached from other programs: {error}"
            return
        yield "programs find the buses in a shell that was told:"
        for name, value in _environment(preload, rig.panels).items():
            yield f"  export {name}={shlex.quote(value)}"


def _environment(preload: Preload, panels: Sequence[RigPanel]) -> dict[str, str]:
    return {**preload.environment(), "PANELDRAW_PANEL": panels[0].url}


# sim run


class _NotStartedError(Exception):
    """The program cannot be run; the code is the one that shells have for that."""

    def __init__(self, code: int, message: str) -> None:
        super().__init__(message)
        self.code = code


def _run(options: argparse.Namespace) -> int:
    command = options.command[options.command[0] == "--" :]
    if not command:
        raise ValueError("say which program to run: paneldraw sim run [options] -- COMMAND")
    try:
        with _panels(options) as rig:
            with rig.preload() as preload, _watched(options, rig.panels, options.view), _Relay() as relay:
                code = relay.wait(_started(preload, command, rig.panels))
            if code < 0 and -code not in relay.passed:
                _say_how_it_ended(command[0], -code)
            if not options.quiet:
                _sum_up(rig.panels, options.fail)
    except _NotStartedError as error:
        _say(str(error))
        return error.code
    return code if code >= 0 else 128 - code


def _started(preload: Preload, command: list[str], panels: Sequence[RigPanel]) -> subprocess.Popen[Any]:
    from paneldraw.simulator.preload import PreloadUnavailableError

    try:
        return preload.popen(command, env={**os.environ, "PANELDRAW_PANEL": panels[0].url})
    except PreloadUnavailableError as error:
        raise _NotStartedError(_NOT_RUN, error.strerror or str(error)) from error
    except OSError as error:
        if error.filename != command[0]:
            raise
        missing = isinstance(error, FileNotFoundError)
        raise _NotStartedError(_NOT_FOUND if missing else _NOT_RUN, _no_command(command[0], error)) from error


def _no_command(name: str, error: OSError) -> str:
    if isinstance(error, PermissionError):
        return f"{name} may not be run: chmod +x {name}, or put its interpreter before it, as in `python {name}`"
    if not isinstance(error, FileNotFoundError):
        return f"{name} cannot be run ({error.strerror}): put its interpreter before it, as in `python {name}`"
    if os.path.exists(name) and os.path.dirname(name):
        return f"{name} cannot be run: the interpreter that its first line names is missing"
    return f"there is no command {name}: check its spelling and the PATH"


def _say_how_it_ended(name: str, number: int) -> None:
    title = signal.Signals(number).name
    if title == "SIGKILL":
        _say(f"{name} was killed (SIGKILL), by somebody or for want of memory: see `dmesg`")
    elif title in _CRASHES:
        _say(f"{name} crashed ({title}): put a debugger before it, as in `-- gdb --args {name}`")
    else:
        _say(f"{name} was ended by {title}")


class _Relay:
    """Passes signals on to a program; a context manager that gives them back their meaning on leaving.

    Ctrl-C reaches all programs of a terminal by itself, and is left to them.
    """

    def __init__(self) -> None:
        self.passed: set[int] = set()
        self._process: subprocess.Popen[Any] | None = None
        self._early: list[int] = []
        self._before: dict[int, Any] = {}

    def __enter__(self) -> _Relay:
        for number in (getattr(signal, name) for name in _PASSED_ON if hasattr(signal, name)):
            self._before[number] = signal.signal(number, self._pass_on)
        return self

    def __exit__(self, *exception: object) -> None:
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def wait(self, process: subprocess.Popen[Any]) -> int:
        """Wait for the end of a program; return its code, below 0 if a signal ended it."""
        self._process = process
        for number in self._early:
            process.send_signal(number)
        return process.wait()

    def _pass_on(self, number: int, frame: FrameType | None) -> None:
        self.passed.add(number)
        if signal.Signals(number).name in _FROM_KEYS and _in_foreground():
            return
        if self._process is None:
            self._early.append(number)
        else:
            self._process.send_signal(number)


def _in_foreground() -> bool:
    """Whether the keys of a terminal go to this process, and to those that it starts."""
    try:
        with open("/dev/tty", "rb", buffering=0) as terminal:
            return os.tcgetpgrp(terminal.fileno()) == os.getpgrp()
    except OSError:
        return False


def _sum_up(panels: Sequence[RigPanel], mishaps: Sequence[Mishap]) -> None:
    for panel in panels:
        chip = panel.chip
        counts = f"{_count(len(chip.frames), 'frame')}, {_count(chip.wire_bytes, 'byte')}"
        said = _count(len(chip.violations), "violation") if chip.violations else "no violations"
        _say(
            f"{panel.name}: {counts}, {said}" if chip.wire_bytes else f"{panel.name}: was sent nothing, at {panel.url}"
        )
        for violation in chip.violations:
            _to_stderr(f"  {violation}")
    for mishap in mishaps:
        _say(f"{mishap.kind}: {_count(mishap.struck, 'fault')}")


def _count(number: int, what: str) -> str:
    return f"{number:,} {what}" if number == 1 else f"{number:,} {what}s"
