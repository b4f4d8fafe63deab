"""``paneldraw view``: run a program and watch its panels, or look at the page of one that runs already."""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import subprocess
import sys
import webbrowser
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit, urlunsplit

from paneldraw import urls
from paneldraw.errors import PanelNotFoundError
from paneldraw.watching import VARIABLE

if TYPE_CHECKING:
    from paneldraw.simulator.terminal import Shown

_ABOUT = "run a program and watch what it sends to its panels, real or simulated; or look at a page that is there"
_EXAMPLES = """examples:
  paneldraw view -- python clock.py                       in a browser
  paneldraw view --terminal -- python clock.py            in this terminal
  paneldraw view --web --listen 0.0.0.0 -- python clock.py    on a page that other machines can open
  paneldraw view --terminal http://pi:8306/?token=...     the page of a program elsewhere, in this terminal

The program may be any that opens its panels with paneldraw's open_panel; others are for `paneldraw sim run`."""


def add(commands: Any) -> None:
    """Add the command to a parser's."""
    parser = commands.add_parser(
        "view",
        help="run a program and watch its panels",
        description=_ABOUT,
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        usage="%(prog)s [options] [--] COMMAND ... | PAGE",
    )
    place = parser.add_mutually_exclusive_group()
    place.add_argument("--terminal", action="store_true", help="in the terminal; default: in a browser")
    place.add_argument("--web", action="store_true", help="on a page whose address is said, without opening a browser")
    parser.add_argument("--listen", metavar="HOST[:PORT]", help="where the page is (127.0.0.1:8306)")
    parser.add_argument("--panel", metavar="URL", help="the panel, where the program does not name one itself")
    parser.add_argument("--look", metavar="NAME", help="such as blue, yellow-blue or lcd-green")
    parser.add_argument("--save", metavar="FILE", help="write what was shown to a .gif, .apng or .png too")
    parser.add_argument("target", nargs=argparse.REMAINDER, metavar="COMMAND", help=argparse.SUPPRESS)
    parser.set_defaults(run=_run)


def _run(options: argparse.Namespace) -> int:
    target = options.target[1:] if options.target[:1] == ["--"] else options.target
    if not target:
        raise ValueError("COMMAND is missing: say what to run, as in: paneldraw view -- python clock.py")
    if urlsplit(target[0]).scheme in ("http", "https"):
        return _look(target[0], options.terminal, options.web)
    if not options.terminal and find_spec("aiohttp") is None:
        raise ValueError("a page needs aiohttp: pip install 'paneldraw[web]'; or use --terminal")
    environment = {VARIABLE: _asked(options)} | ({"PANELDRAW_PANEL": options.panel} if options.panel else {})
    return _become(target, os.environ | environment)


def _asked(options: argparse.Namespace) -> str:
    """What stands behind ``view=`` in a URL that asks for the same."""
    view = "terminal" if options.terminal else "web" if options.web else "browser"
    more = {name: getattr(options, name) for name in ("listen", "look", "save") if getattr(options, name)}
    asked = urls.query(view=view, **more)
    urls.watch(asked)  # what is wrong is said before anything runs
    if options.panel:
        urls.parse(options.panel)
    return asked.removeprefix("view=")


def _become(command: list[str], environment: dict[str, str]) -> int:
    """Run a command in place of this one, where the system can; return its exit code."""
    sys.stdout.flush()
    try:
        if os.name == "posix":
            os.execvpe(command[0], command, environment)
        return subprocess.run(command, env=environment).returncode
    except FileNotFoundError:
        raise ValueError(f"there is no command {command[0]}; check its name, or say python {command[0]}") from None


# -- A page that is there already


def _look(page: str, terminal: bool, web: bool) -> int:
    if not terminal:
        if web or not webbrowser.open(page):
            print(f"open {page} in a browser, or add --terminal")
        return 0
    asyncio.run(_follow(page))
    return 0


async def _follow(page: str) -> None:
    """Draw what a page shows in the terminal, until it ends."""
    import aiohttp

    from paneldraw.simulator import TerminalView
    from paneldraw.simulator.views import BEAT

    parts = urlsplit(page)
    feed = urlunsplit(parts._replace(path="/frames", fragment=""))
    panels: dict[int, _Panel] = {}
    with TerminalView() as view:
        try:
            async with aiohttp.ClientSession() as client, client.ws_connect(feed, heartbeat=20) as socket:
                reading = asyncio.create_task(_read(socket, panels))
                while not reading.done():
                    await asyncio.wait([reading], timeout=BEAT)
                    if any(panel.changed for panel in panels.values()):
                        view.draw([panel.shown() for panel in panels.values()])
                await reading
        except aiohttp.WSServerHandshakeError as error:
            raise ValueError(f"{page} lets nobody in ({error.status}): is its token in the address?") from None
        except aiohttp.ClientError as error:
            raise PanelNotFoundError(None, f"there is no page at {page} ({error}): does the program run?") from None


async def _read(socket: Any, panels: dict[int, _Panel]) -> None:
    from paneldraw.simulator.web import HEAD

    async for message in socket:
        if isinstance(message.data, bytes):
            number, _, frames, wire_bytes, _ = HEAD.unpack_from(message.data)
            if number in panels:
                panels[number].take(message.data[HEAD.size :], frames, wire_bytes)
        elif isinstance(message.data, str):
            there = {about["number"]: about for about in json.loads(message.data)["panels"]}
            for number in panels.keys() - there.keys():
                del panels[number]
            for number in there.keys() - panels.keys():
                panels[number] = _Panel(there[number])


class _Panel:
    """A panel of a page, as its feed describes it."""

    def __init__(self, about: dict[str, Any]) -> None:
        import numpy as np

        from paneldraw.simulator import Look

        self._title, self._bits = about["title"], about["bits"]
        self._shape = about["height"], about["width"]
        self._max_level = len(about["colors"]) - 1
        colors = {"dark": about["colors"][0], "lit": about["colors"][-1]}
        if about["topColors"]:
            colors["top_lit"] = about["topColors"][-1]
        named: dict[str, Any] = {name: "#{:02x}{:02x}{:02x}".format(*color) for name, color in colors.items()}
        self._look = Look(**named, top_rows=about["topRows"])
        self._pixels = np.zeros(self._shape, np.uint8)
        self._summary = ""
        self.changed = False

    def take(self, levels: bytes, frames: int, wire_bytes: float) -> None:
        """Take a picture."""
        import numpy as np

        count = self._shape[0] * self._shape[1]
        packed = np.frombuffer(levels, np.uint8)
        self._pixels = (np.unpackbits(packed, count=count) if self._bits == 1 else packed).reshape(self._shape)
        self._summary = f"{frames} frames, {wire_bytes:.0f} bytes on the wire"
        self.changed = True

    def shown(self) -> Shown:
        """The picture for a view."""
        from paneldraw.simulator.terminal import Shown

        self.changed = False
        return Shown(self._pixels, self._max_level, self._look, f"{self._title}: {self._summary}")
