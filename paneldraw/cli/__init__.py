"""The ``paneldraw`` command: demos, pictures and text on a panel, and what there is to be found about one."""

from __future__ import annotations

import argparse
import contextlib
import io
import math
import os
import signal
import sys
import textwrap
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any, NoReturn

from paneldraw.errors import PanelError

if TYPE_CHECKING:
    from paneldraw.animation import Animation
    from paneldraw.framebuffer import Framebuffer
    from paneldraw.panel import Panel, Report
    from paneldraw.text import Font


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command.

    Parameters
    ----------
    argv : sequence of str, optional
        The arguments. Default: those that the process was started with.

    Returns
    -------
    int
        The exit code: 0, 1 for an error, 128 + n after signal n. Wrong usage leaves by ``SystemExit`` with code 2.
    """
    parser = _parser()
    options = parser.parse_args(argv)
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")
    try:
        with _signals_unwind():
            code: int = options.run(options)
            sys.stdout.flush()
            return code
    except _Interrupted as stop:
        if sys.stderr.isatty():
            print(file=sys.stderr)  # the terminal has written ^C where the prompt belongs
        return 128 + stop.number
    except BrokenPipeError:
        # Whoever read the output has left; nothing may be written at exit either.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (PanelError, OSError, ValueError, _UserError) as error:
        print(f"paneldraw: {_one_line(error)}", file=sys.stderr)
        return 1


class _UserError(Exception):
    """Something that the person at the keyboard can put right, in one line."""


class _Interrupted(BaseException):
    """A signal asks the command to stop; whatever is open closes on the way out."""

    def __init__(self, number: int) -> None:
        self.number = number


@contextlib.contextmanager
def _signals_unwind() -> Iterator[None]:
    """Make SIGINT, SIGTERM and SIGHUP unwind the stack, so that terminal and panel are left in order."""

    numbers = [getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]

    def stop(number: int, frame: FrameType | None) -> NoReturn:
        for each in numbers:
            signal.signal(each, signal.SIG_IGN)  # a second one would cut the way out short
        raise _Interrupted(number)

    before = {number: signal.signal(number, stop) for number in numbers}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _one_line(error: BaseException) -> str:
    if type(error) is FileNotFoundError and error.filename:
        return f"there is no file {error.filename}; check the path"
    text = str(error)
    if isinstance(error, OSError) and error.strerror:
        advice = f"{error.filename}: {error.strerror}; check the path and its permissions"
        text = advice if error.filename else error.strerror
    return " ".join(text.split()) or type(error).__name__


class _Parser(argparse.ArgumentParser):
    """Reads arguments; those behind a first word that `actions` has are another parser's."""

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.actions: dict[str, _Parser] = {}

    def parse_known_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Read the arguments that are known."""
        if args and args[0] in self.actions:
            return self.actions[args[0]].parse_known_args(args[1:], namespace)
        return super().parse_known_args(args, namespace)

    def error(self, message: str) -> NoReturn:
        """Say what is wrong in one line, and where help is."""
        self.exit(2, f"{self.prog}: {' '.join(message.split())}; see {self.prog} --help\n")


def _parser() -> argparse.ArgumentParser:
    parser = _Parser(prog="paneldraw", description="Draw on OLED, LCD and LED panels, real or simulated.")
    parser.add_argument("--version", action=_Version)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for add in (
        *(_add_demo, _add_show, _add_text, _add_clear, _add_off, _add_panels, _add_detect, _add_check, _add_info),
        *(_add_bench, _add_firmware, _add_sim, _add_view, _add_replay, _add_completion),
    ):
        add(commands)
    return parser


class _Version(argparse.Action):
    def __init__(self, option_strings: Sequence[str], dest: str) -> None:
        super().__init__(option_strings, dest, nargs=0, help="print the version and leave")

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        from paneldraw.cli import diagnostics

        print(f"paneldraw {diagnostics.version('paneldraw')}")
        parser.exit()


if TYPE_CHECKING:
    _Commands = argparse._SubParsersAction[_Parser]


def _command(
    commands: _Commands,
    name: str,
    run: Callable[[argparse.Namespace], int],
    help: str,
    epilog: str | None = None,
    chip: str = "SSD1306",
) -> argparse.ArgumentParser:
    """Add a command; every one takes ``--panel``, and without it simulates a chip."""
    parser = commands.add_parser(
        name, help=help, description=help, epilog=epilog, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--panel",
        metavar="URL",
        help=f"such as i2c://1/0x3c?size=128x32 or sim://ssd1306; default: $PANELDRAW_PANEL, else a simulated {chip}",
    )
    parser.set_defaults(run=run, otherwise=f"sim://{chip.lower()}")
    return parser


def _positive(kind: Callable[[str], float], most: float = math.inf) -> Callable[[str], float]:
    def convert(text: str) -> float:
        value = kind(text)
        if not 0 < value <= most:
            limit = f" and at most {most}" if math.isfinite(most) else ""
            raise argparse.ArgumentTypeError(f"{text} is not above 0{limit}")
        return value

    convert.__name__ = "number"
    return convert


# demo


def _add_demo(commands: _Commands) -> None:
    from paneldraw.demos import DEMOS

    about = "\n".join(f"  {name:8} {what}" for name, what in DEMOS.items())
    # Of 16 grays and the usual size: anti-aliasing looks as it should.
    parser = _command(commands, "demo", _demo, "run an animated demo", f"demos:\n{about}", chip="SSD1325")
    parser.add_argument("name", nargs="?", default="scene", choices=list(DEMOS), metavar="NAME", help="default: scene")
    parser.add_argument(
        "--save", type=_save_path, metavar="FILE", help="write a .gif or .apng, or a .png of one moment"
    )
    length = parser.add_mutually_exclusive_group()
    length.add_argument(
        "--seconds", type=_positive(float), metavar="N", help="how long, inf for ever; which moment of a .png (10)"
    )
    length.add_argument("--frames", type=_positive(int), metavar="N", help="how many frames, instead of --seconds")
    parser.add_argument("--fps", type=_positive(float, 1000), default=30.0, metavar="N", help="frames a second (30)")
    parser.add_argument(
        "--greys", type=int, choices=[3, 4, 5, 8, 16], metavar="N", help="as many greys on a panel of one bit (SSD1306)"
    )


def _with(url: str, greys: int) -> str:
    """A panel's URL, with so many greys."""
    return f"{url}{'&' if '?' in url else '?'}greys={greys}"


def _save_path(text: str) -> Path:
    path = Path(text)
    if path.suffix.lower() not in (".gif", ".apng", ".png"):
        raise argparse.ArgumentTypeError(f"{text} ends in none of .gif, .apng, .png")
    return path


def _check_folder(path: Path | None) -> None:
    if path and not path.parent.is_dir():
        raise _UserError(f"there is no folder {path.parent}; make it first")


def _demo(options: argparse.Namespace) -> int:
    from paneldraw.cli import playback
    from paneldraw.demos import find

    frames = options.frames or max(1, (options.seconds or 10.0) * options.fps)
    if options.save and not math.isfinite(frames):
        raise _UserError("a file cannot hold an endless demo; give --seconds a number")
    _check_folder(options.save)
    if options.greys:
        options.panel = _with(options.panel or os.environ.get("PANELDRAW_PANEL") or "sim://ssd1306", options.greys)
    with _opened(options) as panel:
        url = options.panel or os.environ.get("PANELDRAW_PANEL") or ""
        if panel.simulated is None and "on_close=" not in url:
            panel.on_close = "clear"  # a demo's last picture is of no use
        playback.play(find(options.name), panel, options.name, frames=frames, fps=options.fps, save_to=options.save)
    return 0


# show and text


def _add_show(commands: _Commands) -> None:
    parser = _command(commands, "show", _show, "show a picture, as large as fits, or play one that moves")
    parser.add_argument("picture", type=Path, metavar="PICTURE", help="a file that Pillow reads: PNG, JPEG, GIF, ...")
    parser.add_argument(
        "--fit", choices=["contain", "cover", "stretch"], default="contain", help="how it meets the edges (contain)"
    )
    parser.add_argument(
        "--dither",
        choices=["none", "bayer", "floyd-steinberg", "blue-noise", "stable"],
        help="(floyd-steinberg; stable if it moves)",
    )
    parser.add_argument("--gamma", type=_positive(float, 100), default=1.0, help="2.2 for the light of the file (1)")
    parser.add_argument("--invert", action="store_true", help="swap light and dark")
    parser.add_argument(
        "--loops", type=_positive(int, 1 << 30), metavar="N", help="how often to play it (as it says; once in a pipe)"
    )


def _show(options: argparse.Namespace) -> int:
    from paneldraw.animation import Animation
    from paneldraw.framebuffer import pictures

    with _picture_errors(options.picture):
        animation = Animation(options.picture)
        moves = len(animation) > 1
        still = None if moves else pictures.opened(options.picture)
    dither = options.dither or ("stable" if moves else "floyd-steinberg")
    how = {"fit": options.fit, "dither": None if dither == "none" else dither}
    how |= {"gamma": options.gamma, "invert": options.invert}
    with _opened(options) as panel:
        if moves:
            with _picture_errors(options.picture):
                _play(panel, animation, options, how)
            return 0
        fb = panel.framebuffer()
        fb.image(still, fill=0, **how)
        _present(panel, fb, str(options.picture))
    return 0


def _play(panel: Panel, animation: Animation, options: argparse.Namespace, how: dict[str, Any]) -> None:
    """Play a picture that moves: in real time where somebody watches, else once and as fast as it can be drawn."""
    from paneldraw.animation import play
    from paneldraw.cli import playback

    chip = playback.simulated(panel)
    watched = chip is None or sys.stdout.isatty()
    sent = 0
    with playback.view_of(chip) as show:

        def shown(report: Report) -> None:
            nonlocal sent
            sent += report.wire_bytes
            show(f"{options.picture}: {sent} bytes on the wire")

        if watched:
            play(panel, animation, options.loops, how, shown)
        else:
            play(panel, animation, options.loops or 1, how, shown, clock=lambda: 0.0, sleep=lambda seconds: None)
    if chip is None:
        print(f"{options.picture}: {sent} bytes on the wire")


@contextlib.contextmanager
def _picture_errors(path: Path) -> Iterator[None]:
    """Say in a line what is wrong with a picture's file."""
    from PIL import Image, UnidentifiedImageError

    try:
        yield
    except UnidentifiedImageError:
        raise _UserError(f"{path} is no picture that Pillow reads; convert it to PNG or JPEG") from None
    except PanelError:
        raise
    except (OSError, SyntaxError, ValueError, EOFError, Image.DecompressionBombError) as error:
        if isinstance(error, OSError) and error.errno:
            raise
        raise _UserError(f"cannot read {path}: {_one_line(error)}; is the file whole?") from error


def _add_text(commands: _Commands) -> None:
    parser = _command(commands, "text", _text, "show a text in the middle of the panel")
    parser.add_argument("text", nargs="+", metavar="TEXT", help="words, or - for standard input")
    parser.add_argument("--font", metavar="FILE", help="a TrueType or OpenType font; default: the built-in 6x8 font")
    size = parser.add_mutually_exclusive_group()
    size.add_argument(
        "--size", type=_positive(float, 500), metavar="N", help="pixels to the em, for outline fonts (16)"
    )
    size.add_argument(
        "--scale", type=_positive(int, 100), default=1, metavar="N", help="pixels to a pixel of the font (1)"
    )
    parser.add_argument("--invert", action="store_true", help="dark letters on a lit panel")


def _text(options: argparse.Namespace) -> int:
    words = " ".join(options.text)
    text = sys.stdin.read().rstrip("\n") if words == "-" else words
    font = _font(options)
    with _opened(options) as panel:
        fb = panel.framebuffer()
        lines = _wrap(text, font, fb.width)
        fb.text(lines, (fb.width - 1) // 2, (fb.height - 1) // 2, font=font, anchor="mm")
        if options.invert:
            fb.pixels[:] = fb.max_level - fb.pixels
        _present(panel, fb, text)
    return 0


def _font(options: argparse.Namespace) -> Font:
    from paneldraw.text import Font

    if options.font:
        font = Font.truetype(options.font, options.size or 16)
    elif options.size:
        from PIL import ImageFont

        font = Font.from_pillow(ImageFont.load_default(options.size))
    else:
        font = Font.builtin()
    return font.scaled(options.scale) if options.scale > 1 else font


def _wrap(text: str, font: Font, width: int) -> str:
    """Break lines between words where they would be wider than the panel."""
    lines: list[str] = []
    for line in text.split("\n"):
        taken = ""
        for word in line.split(" "):
            longer = f"{taken} {word}" if taken else word
            if taken and font.measure(longer)[0] > width:
                lines.append(taken)
                longer = word
            taken = longer
        lines.append(taken)
    return "\n".join(lines)


def _opened(options: argparse.Namespace) -> Panel:
    from paneldraw.panel import open_panel

    return open_panel(options.panel or os.environ.get("PANELDRAW_PANEL") or options.otherwise)


def _present(panel: Panel, fb: Framebuffer, what: str) -> None:
    """Show one picture; a simulated panel appears in the terminal."""
    from paneldraw.cli import playback

    report = panel.show(fb)
    what = textwrap.shorten(" ".join(what.split()), 40)
    playback.print_panel(panel, f"{what}: {report.wire_bytes} bytes on the wire")


# clear and off


def _add_clear(commands: _Commands) -> None:
    _command(commands, "clear", _clear, "show a black picture, as the last act of a service (ExecStop=)")


def _clear(options: argparse.Namespace) -> int:
    with _opened(options) as panel:
        panel.clear()
    return 0


def _add_off(commands: _Commands) -> None:
    _command(commands, "off", _off, "turn the panel off, as the last act of a service (ExecStop=)")


def _off(options: argparse.Namespace) -> int:
    with _opened(options) as panel:
        panel.sleep()
    return 0


# panels, detect, check and info


def _add_panels(commands: _Commands) -> None:
    about = "list the chips that there are drivers for, or say what is known of one"
    parser = commands.add_parser("panels", help=about, description=about)
    parser.add_argument("chip", nargs="?", metavar="CHIP", help="such as ssd1306; default: all, a line each")
    parser.set_defaults(run=_panels)


def _panels(options: argparse.Namespace) -> int:
    from paneldraw.cli import catalog

    for line in catalog.describe(options.chip) if options.chip else catalog.table():
        print(line)
    return 0


def _add_check(commands: _Commands) -> None:
    about = "draw a test card in steps and ask what the glass shows: its wiring, and which tricks it obeys"
    parser = _command(commands, "check", _check, about)
    parser.add_argument(
        "--greys", action="store_true", help="try instead how many greys a panel of one bit shows steadily"
    )


def _check(options: argparse.Namespace) -> int:
    from paneldraw.cli import check, playback
    from paneldraw.panel import open_panel

    url = options.panel or os.environ.get("PANELDRAW_PANEL") or "sim://ssd1306"
    joint = "&" if "?" in url else "?"

    def show(panel: Panel, shows: str) -> None:
        playback.print_panel(panel, f"must show: {shows}")

    if options.greys:
        found = check.run_greys(lambda greys: open_panel(_with(url, greys)), show, check.ask)
    else:
        with open_panel(f"{url}{joint}updates=whole") as panel:
            found = check.run(panel, show, check.ask)
    for advice in found.advice:
        print(f"add to the URL: {advice}; then check again")
    if not found.advice:
        query = "&".join(found.parameters)
        print(f"use: {url}{joint if query else ''}{query}")
    return 0


def _add_detect(commands: _Commands) -> None:
    _command(commands, "detect", _detect, "look for panels: which addresses answer on which bus")


def _detect(options: argparse.Namespace) -> int:
    from paneldraw.cli import diagnostics

    found = diagnostics.detect(options.panel or os.environ.get("PANELDRAW_PANEL"))
    for line in found.lines:
        print(line)
    if not found.panels:
        raise _UserError(found.advice)
    return 0


def _add_info(commands: _Commands) -> None:
    _command(commands, "info", _info, "print versions, platform, buses and whether drawing runs compiled")


def _info(options: argparse.Namespace) -> int:
    from paneldraw.cli import diagnostics

    for name, value in diagnostics.info(options.panel):
        print(f"{name + ':':14}{value}")
    return 0


# bench and firmware


def _add_bench(commands: _Commands) -> None:
    about = "count what ten scenes cost on the wire, beside a driver that sends whole frames; it needs no panel"
    parser = commands.add_parser("bench", help=about, description=about)
    parser.add_argument("--save", type=_chart_path, metavar="FILE", help="draw the table as a chart, a .png")
    parser.add_argument("--frames", type=_positive(int), default=120, metavar="N", help="how many of each scene (120)")
    parser.set_defaults(run=_bench)


def _chart_path(text: str) -> Path:
    if Path(text).suffix.lower() != ".png":
        raise argparse.ArgumentTypeError(f"{text} does not end in .png")
    return Path(text)


def _bench(options: argparse.Namespace) -> int:
    from paneldraw.cli import bench

    _check_folder(options.save)
    lines = bench.measured(options.frames)
    print("\n".join(bench.table(lines)))
    if options.save:
        bench.chart(lines).save(options.save, scale=2)
        print(f"wrote {options.save}")
    return 0


def _add_firmware(commands: _Commands) -> None:
    from paneldraw.cli import firmware

    firmware.add(commands, _positive(int), _positive(float))


def _add_replay(commands: _Commands) -> None:
    from paneldraw.cli import replay

    replay.add(commands, _save_path, _positive(int), _positive(float))


def _add_view(commands: _Commands) -> None:
    from paneldraw.cli import view

    view.add(commands)


def _add_sim(commands: _Commands) -> None:
    from paneldraw.cli import sim

    sim.add(commands, _save_path)


def _add_completion(commands: _Commands) -> None:
    about = "print what lets a shell complete this command's words; its help says where to put it"
    where = "bash: ~/.local/share/bash-completion/completions/paneldraw\nzsh: _paneldraw in a folder of $fpath"
    parser = commands.add_parser(
        "completion", help=about, description=about, epilog=where, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("shell", choices=("bash", "zsh", "tcsh"))
    parser.set_defaults(run=_completion)


def _completion(options: argparse.Namespace) -> int:
    try:
        import shtab
    except ModuleNotFoundError:
        raise _UserError("shtab is not installed; run: pip install 'paneldraw[completion]'") from None
    print(shtab.complete(_parser(), options.shell))
    return 0
